/* The lengths are made of the input, as the mesher makes them: of the constrained triangulation before refinement. */
#include "drivers/judge/judged_sizes.h"

#include <stdio.h>
#include <stdlib.h>

#include "triangle/api/generate.h"
#include "triangle/base/radix.h"
#include "triangle/geometry/shape.h"

enum { SLICE = 1 << 14 }; /* triangles that are read at a time */

struct measuring {
    const struct tri_check_source *source; /* the mesh */
    const struct tri_lengths *lengths;     /* the wanted lengths */
    double unit;          /* of the mesh of the input, in which the lengths are defined */
    struct tri_point *xy; /* [source->n_points], in this unit */
    uint64_t *edge;       /* [n] smaller end << bits | larger end, for each side of each triangle */
    int64_t n;            /* number of sides */
    int bits;             /* of a vertex number */
    double wanted;        /* integral of 1 / (sqrt(3)/4 h^2) */
    double quality;       /* sum over all triangles */
};

static enum tri_status no_memory(struct tri_error *error)
{
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory to compare lengths");
}

static enum tri_status read_points(struct measuring *m, struct tri_error *error)
{
    const int64_t n = m->source->n_points;
    m->xy = malloc(((size_t)n + 1) * sizeof *m->xy);
    if (!m->xy)
        return no_memory(error);
    const enum tri_status status = m->source->read(m->source->user, TRI_CHECK_POINTS, 0, n, m->xy, error);
    for (int64_t v = 0; v < n && !status; v++)
        m->xy[v] = (struct tri_point){m->xy[v].x / m->unit, m->xy[v].y / m->unit};
    return status;
}

static void add_triangle(struct measuring *m, const int64_t v[3])
{
    const struct tri_point a = m->xy[v[0]], b = m->xy[v[1]], c = m->xy[v[2]];
    const double area = tri_area_of(a, b, c);
    const double h = tri_lengths_at(m->lengths, (struct tri_point){(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3});
    m->wanted += area / (TRI_EQUILATERAL * h * h);
    m->quality += 16 * TRI_EQUILATERAL * area / (tri_distance2(a, b) + tri_distance2(b, c) + tri_distance2(c, a));
    for (int k = 0; k < 3; k++) {
        const int64_t from = v[k], to = v[tri_next[k]];
        m->edge[m->n++] = (uint64_t)(from < to ? from : to) << m->bits | (uint64_t)(from < to ? to : from);
    }
}

static enum tri_status add_triangles(struct measuring *m, struct tri_error *error)
{
    int64_t(*corner)[3] = malloc(SLICE * sizeof *corner);
    enum tri_status status = corner ? TRI_OK : no_memory(error);
    for (int64_t first = 0; first < m->source->n_triangles && !status; first += SLICE) {
        const int64_t left = m->source->n_triangles - first, n = left < SLICE ? left : SLICE;
        status = m->source->read(m->source->user, TRI_CHECK_CORNERS, first, n, corner, error);
        for (int64_t t = 0; t < n && !status; t++)
            add_triangle(m, corner[t]);
    }
    free(corner);
    return status;
}

static bool fits(const struct measuring *m, uint64_t edge)
{
    const struct tri_point a = m->xy[edge >> m->bits], b = m->xy[edge & (((uint64_t)1 << m->bits) - 1)];
    const double h = tri_lengths_at(m->lengths, (struct tri_point){(a.x + b.x) / 2, (a.y + b.y) / 2});
    const double ratio = sqrt(tri_distance2(a, b)) / h;
    return ratio > JUDGED_SHORTEST && ratio < JUDGED_LONGEST;
}

static enum tri_status measure(struct measuring *m, struct judged_sizes *sizes, const struct tri_executor *executor,
                               struct tri_error *error)
{
    const int64_t n = 3 * m->source->n_triangles;
    if (m->source->n_points > INT32_MAX || n > INT32_MAX)
        return tri_fail(error, TRI_TOO_LARGE, NULL, 0, "the mesh is too large to compare lengths");
    m->bits = tri_bits_of((int32_t)m->source->n_points);
    m->edge = malloc(((size_t)n + 1) * sizeof *m->edge);
    uint64_t *scratch = malloc(((size_t)n + 1) * sizeof *scratch);
    enum tri_status status = m->edge && scratch ? read_points(m, error) : no_memory(error);
    status = status ? status : add_triangles(m, error);
    if (!status)
        tri_radix_sort(m->edge, scratch, (int32_t)n, 0, 2 * m->bits, executor);
    for (int64_t i = 0; i < n && !status; i++)
        if (i == 0 || m->edge[i] != m->edge[i - 1]) {
            sizes->n_edges++;
            sizes->n_fitting += fits(m, m->edge[i]);
        }
    sizes->number = (double)m->source->n_triangles / m->wanted;
    sizes->quality = m->quality / (double)m->source->n_triangles;
    free(scratch);
    free(m->edge);
    free(m->xy);
    return status;
}

enum tri_status judged_sizes_measure(struct judged_sizes *sizes, const struct size_options *options,
                                     const struct judged_files *files, const struct tri_check_options *check,
                                     const struct tri_executor *executor, struct tri_error *error)
{
    struct tri_options how = tri_defaults();
    how.use_segments = files->input.n_segments > 0;
    how.keep_hull = check->convex || check->border == TRI_CHECK_BORDER_HULL;
    how.ignore_holes = check->ignore_holes;
    how.even_odd = check->any_holes;
    how.base = files->base;
    how.executor = executor;
    *sizes = (struct judged_sizes){0};
    struct tri_mesh mesh = {0};
    struct tri_report report;
    struct size_fields fields = {0};
    enum tri_status status = size_fields_read(&fields, options, executor, error);
    status = status ? status : tri_generate(&mesh, &files->input, &how, &report, error);
    status = status ? status : size_fields_make(&fields, options, false, &mesh, executor, error);
    if (!status && (!fields.lengths || files->source.n_triangles == 0))
        status = tri_fail(error, TRI_BAD_INPUT, NULL, 0, "there are no edges with a wanted length");
    size_options_name(options, tri_lengths_note(fields.lengths), sizes->note);
    struct measuring m = {.source = &files->source, .lengths = fields.lengths, .unit = mesh.unit};
    tri_mesh_free(&mesh);
    status = status ? status : measure(&m, sizes, executor, error);
    size_fields_free(&fields);
    return status;
}
