/* Each edge is listed once, by a rule that looks at its two triangles only: the one with the lower number lists it. */
#include "triangle/mesh/topology.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/geometry/predicates.h"
#include "triangle/geometry/shape.h"

/* Edges of a triangle in the order of the list, by their opposite corners. */
static const int edge_order[3] = {2, 0, 1};

void tri_neighbors(const struct tri_mesh *mesh, tri_triangle_id t, tri_triangle_id neighbors[3])
{
    for (int e = 0; e < 3; e++) {
        tri_halfedge other = tri_across(mesh, tri_code(t, e));
        neighbors[e] = other == TRI_NONE ? TRI_NONE : tri_of(other);
    }
}

/* Does this half-edge list the edge? `other` is the half-edge on the other side. */
static bool is_first(tri_halfedge code, tri_halfedge other) { return other == TRI_NONE || other > code; }

static int32_t count_edges(const struct tri_mesh *mesh)
{
    int32_t n = 0;
    for (tri_triangle_id t = 0; t < mesh->n_triangles; t++) {
        assert(tri_is_live(&mesh->tri[t]));
        for (int e = 0; e < 3; e++)
            n += is_first(tri_code(t, e), tri_across(mesh, tri_code(t, e)));
    }
    return n;
}

static void list_edges(struct tri_edge_list *list, const struct tri_mesh *mesh)
{
    int32_t n = 0;
    for (tri_triangle_id t = 0; t < mesh->n_triangles; t++)
        for (int k = 0; k < 3; k++) {
            tri_halfedge code = tri_code(t, edge_order[k]), other = tri_across(mesh, code);
            if (!is_first(code, other))
                continue;
            if (list->number) {
                list->number[3 * (size_t)t + (size_t)tri_edge(code)] = n;
                if (other != TRI_NONE)
                    list->number[3 * (size_t)tri_of(other) + (size_t)tri_edge(other)] = n;
            }
            list->codes[n++] = code;
        }
    assert(n == list->n);
}

enum tri_status tri_edge_list_make(struct tri_edge_list *list, const struct tri_mesh *mesh, bool with_numbers,
                                   struct tri_error *error)
{
    *list = (struct tri_edge_list){.n = count_edges(mesh), .mesh = mesh};
    list->codes = tri_mesh_extra(mesh, ((size_t)list->n + 1) * sizeof *list->codes);
    if (with_numbers)
        list->number = tri_mesh_extra(mesh, 3 * ((size_t)mesh->n_triangles + 1) * sizeof *list->number);
    if (!list->codes || (with_numbers && !list->number)) {
        const int fault = errno;
        tri_edge_list_free(list);
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "no room for the edges of %d triangles: %s",
                        (int)mesh->n_triangles, strerror(fault));
    }
    list_edges(list, mesh);
    return TRI_OK;
}

void tri_edge_list_free(struct tri_edge_list *list)
{
    if (list->mesh) {
        tri_mesh_extra_free(list->mesh, list->codes);
        tri_mesh_extra_free(list->mesh, list->number);
    }
    *list = (struct tri_edge_list){0};
}

double tri_blend_attribute(const struct tri_mesh *mesh, const struct tri_blend *blend, int32_t attribute)
{
    double corner[3];
    for (int k = 0; k < 3; k++)
        corner[k] = mesh->attributes[(size_t)blend->v[k] * (size_t)mesh->n_attributes + (size_t)attribute];
    return corner[0] + blend->weight[0] * (corner[1] - corner[0]) + blend->weight[1] * (corner[2] - corner[0]);
}

struct tri_blend tri_edge_middle(const struct tri_mesh *mesh, tri_halfedge code)
{
    int32_t ends[2];
    tri_edge_ends(mesh, code, ends);
    struct tri_point p = tri_point_between(mesh->xy[ends[0]], mesh->xy[ends[1]], 0.5);
    return (struct tri_blend){{p.x * mesh->unit, p.y * mesh->unit}, {ends[0], ends[1], ends[0]}, {0.5, 0}};
}

/* Uses the orientation predicate for the area, because it stays accurate for nearly flat triangles. */
struct tri_blend tri_voronoi_vertex(const struct tri_mesh *mesh, tri_triangle_id t)
{
    const tri_vertex_id *v = mesh->tri[t].v;
    struct tri_point a = mesh->xy[v[0]], b = mesh->xy[v[1]], c = mesh->xy[v[2]];
    double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
    double b2 = bx * bx + by * by, c2 = cx * cx + cy * cy, area2 = tri_orient2d(a, b, c);
    double x = (cy * b2 - by * c2) / (2 * area2), y = (bx * c2 - cx * b2) / (2 * area2);
    struct tri_blend blend = {{(a.x + x) * mesh->unit, (a.y + y) * mesh->unit}, {v[0], v[1], v[2]}, {0, 0}};
    blend.weight[0] = (x * cy - y * cx) / area2;
    blend.weight[1] = (bx * y - by * x) / area2;
    return blend;
}

void tri_voronoi_edge(const struct tri_mesh *mesh, tri_halfedge code, tri_triangle_id ends[2], double direction[2])
{
    int32_t other = tri_across(mesh, code), edge[2];
    ends[0] = tri_of(code);
    ends[1] = other == TRI_NONE ? TRI_NONE : tri_of(other);
    direction[0] = direction[1] = 0;
    if (other != TRI_NONE)
        return;
    tri_edge_ends(mesh, code, edge);
    direction[0] = (mesh->xy[edge[1]].y - mesh->xy[edge[0]].y) * mesh->unit;
    direction[1] = (mesh->xy[edge[0]].x - mesh->xy[edge[1]].x) * mesh->unit;
}

enum tri_status tri_used_make(struct tri_used *used, const struct tri_mesh *mesh, struct tri_error *error)
{
    size_t size = (size_t)mesh->n_vertices + 1;
    *used = (struct tri_used){0, tri_mesh_extra(mesh, size * sizeof *used->vertex),
                              tri_mesh_extra(mesh, size * sizeof *used->number), mesh};
    if (!used->vertex || !used->number) {
        const int fault = errno;
        tri_used_free(used);
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "no room to number %d vertices: %s", (int)mesh->n_vertices,
                        strerror(fault));
    }
    for (tri_vertex_id v = 0; v < mesh->n_vertices; v++)
        used->number[v] = TRI_NONE;
    for (tri_triangle_id t = 0; t < mesh->n_triangles; t++)
        for (int k = 0; k < 3; k++)
            used->number[mesh->tri[t].v[k]] = 0;
    for (tri_vertex_id v = 0; v < mesh->n_vertices; v++)
        if (used->number[v] != TRI_NONE) {
            used->number[v] = used->n;
            used->vertex[used->n++] = v;
        }
    return TRI_OK;
}

enum tri_status tri_kept_make(struct tri_used *kept, const struct tri_mesh *mesh, const struct tri_elements *elements,
                              bool jettison, struct tri_error *error)
{
    enum { DROPPED = TRI_NONE - 1 };
    size_t n = elements->extra ? (size_t)elements->n * (size_t)(elements->n_nodes - 3) : 0;
    *kept = (struct tri_used){0};
    enum tri_status status = jettison || n > 0 ? tri_used_make(kept, mesh, error) : TRI_OK;
    if (status || jettison || n == 0)
        return status;
    for (size_t i = 0; i < n; i++) {
        tri_vertex_id v = elements->extra[i];
        if (v >= 0 && v < mesh->n_input && kept->number[v] == TRI_NONE)
            kept->number[v] = DROPPED;
    }
    kept->n = 0;
    for (tri_vertex_id v = 0; v < mesh->n_vertices; v++) {
        bool is_kept = kept->number[v] != DROPPED;
        kept->number[v] = is_kept ? kept->n : TRI_NONE;
        if (is_kept)
            kept->vertex[kept->n++] = v;
    }
    assert(kept->n <= mesh->n_vertices);
    return TRI_OK;
}

void tri_used_free(struct tri_used *used)
{
    if (used->mesh) {
        tri_mesh_extra_free(used->mesh, used->vertex);
        tri_mesh_extra_free(used->mesh, used->number);
    }
    *used = (struct tri_used){0};
}

/* Counts and shapes, each by one pass over the triangles.
 *
 * Extremes are kept as squares and cosines, and converted to lengths and degrees once at the end. The cosine falls as
 * the angle grows, so the smallest angle has the largest cosine. */

const double tri_aspect_limits[TRI_ASPECT_BINS] = {1.1547, 1.5, 2,  2.5, 3,   4,   6,    10,
                                                   15,     25,  50, 100, 300, 1000, 10000, 100000};

static const double DEGREES = 57.295779513082320877;

struct usage {
    const struct tri_mesh *mesh;
    _Atomic(bool) *used; /* [n_vertices] */
};

/* Several threads may store to one vertex; all store the same value. */
static void mark_corners(void *context, size_t share)
{
    const struct usage *u = context;
    struct tri_range range = tri_share(share, u->mesh->n_triangles);
    for (tri_triangle_id t = range.first; t < range.last; t++)
        for (int k = 0; k < 3; k++)
            atomic_store_explicit(&u->used[u->mesh->tri[t].v[k]], true, memory_order_relaxed);
}

static int64_t count_used(const struct usage *u, const struct tri_executor *executor)
{
    int64_t n = 0;
    tri_execute(executor, tri_shares(u->mesh->n_triangles), mark_corners, (void *)u);
    for (tri_vertex_id v = 0; v < u->mesh->n_vertices; v++)
        n += atomic_load_explicit(&u->used[v], memory_order_relaxed);
    return n;
}

enum tri_status tri_count_mesh(struct tri_counts *counts, const struct tri_mesh *mesh,
                               const struct tri_executor *executor, struct tri_error *error)
{
    struct usage u = {mesh, calloc((size_t)mesh->n_vertices + 1, sizeof *u.used)};
    *counts = (struct tri_counts){0};
    if (!u.used)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory to count %d vertices", (int)mesh->n_vertices);
    tri_count_refined(counts, mesh, mesh->n_vertices - count_used(&u, executor));
    free((void *)u.used);
    return TRI_OK;
}

void tri_count_refined(struct tri_counts *counts, const struct tri_mesh *mesh, int64_t unused)
{
    assert(unused >= 0 && unused <= mesh->n_vertices);
    *counts = (struct tri_counts){
        .vertices = mesh->n_vertices - unused, .triangles = mesh->n_triangles, .subsegments = mesh->n_subs};
    for (tri_sub_id s = 0; s < mesh->n_subs; s++) {
        bool boundary = tri_is_boundary(&mesh->sub[s]);
        *(boundary ? &counts->exterior : &counts->interior) += 1;
    }
    counts->edges = (3 * counts->triangles + counts->exterior) / 2; /* every boundary edge is a subsegment */
}

/* Extremes in the mesh's units: [0] least, [1] greatest. */
struct extremes {
    double area2[2], length2[2];
    double total_area2; /* sums of shares are added in order, so the result does not depend on the number of threads */
    double least_altitude2, greatest_aspect;
    double least_sine2;  /* squared sine of the smallest angle; unambiguous, since that angle is at most 60 degrees */
    double least_cosine; /* cosine of the largest angle, which is at least 60 degrees */
};

static void widen(double range[2], double value)
{
    range[0] = value < range[0] ? value : range[0];
    range[1] = value > range[1] ? value : range[1];
}

/* Limits are monotone, so the bin is the number of limits passed, counted without branches. */
static int aspect_bin(double aspect)
{
    int bin = 0;
    for (int k = 1; k < TRI_ASPECT_BINS; k++)
        bin += aspect > tri_aspect_limits[k];
    return bin;
}

static int angle_bin(double cosine, const double limits[TRI_ANGLE_BINS])
{
    int bin = 0;
    for (int k = 1; k < TRI_ANGLE_BINS; k++)
        bin += cosine < limits[k];
    return bin;
}

static void measure(struct tri_shapes *shapes, struct extremes *x, const struct tri_shape *s,
                    const double limits[TRI_ANGLE_BINS])
{
    const double root[3] = {sqrt(s->l[0]), sqrt(s->l[1]), sqrt(s->l[2])};
    double longest2 = tri_longest2(s), aspect = longest2 / s->area2;
    widen(x->area2, s->area2);
    x->total_area2 += s->area2;
    x->least_altitude2 = tri_lesser(x->least_altitude2, s->area2 / longest2 * s->area2);
    x->greatest_aspect = tri_larger(x->greatest_aspect, aspect);
    x->least_sine2 = tri_lesser(x->least_sine2, s->area2 / tri_longer_product(s->l[0], s->l[1], s->l[2]) * s->area2);
    shapes->aspects[aspect_bin(aspect)]++;
    for (int k = 0; k < 3; k++) {
        double a = s->l[tri_next[k]], b = s->l[tri_prev[k]];
        double cosine = (a + b - s->l[k]) / (2 * root[tri_next[k]] * root[tri_prev[k]]);
        widen(x->length2, s->l[k]);
        x->least_cosine = tri_lesser(x->least_cosine, cosine);
        shapes->angles[angle_bin(cosine, limits)]++;
    }
}

static void convert(struct tri_shapes *shapes, const struct extremes *x, double unit)
{
    shapes->smallest_area = 0.5 * x->area2[0] * unit * unit;
    shapes->total_area = 0.5 * x->total_area2 * unit * unit;
    shapes->largest_area = 0.5 * x->area2[1] * unit * unit;
    shapes->shortest_edge = sqrt(x->length2[0]) * unit;
    shapes->longest_edge = sqrt(x->length2[1]) * unit;
    shapes->shortest_altitude = sqrt(x->least_altitude2) * unit;
    shapes->largest_aspect = x->greatest_aspect;
    shapes->smallest_angle = DEGREES * asin(sqrt(fmin(x->least_sine2, 1)));
    shapes->largest_angle = DEGREES * acos(fmax(x->least_cosine, -1));
}

/* Results for one share of the triangles. */
struct tally {
    struct tri_shapes shapes;
    struct extremes extremes;
};

struct survey {
    const struct tri_mesh *mesh;
    double limits[TRI_ANGLE_BINS];
    struct tally tally[TRI_MOST_SHARES];
};

static void measure_share(void *context, size_t share)
{
    struct survey *s = context;
    struct tally *tally = &s->tally[share];
    struct tri_range range = tri_share(share, s->mesh->n_triangles);
    *tally = (struct tally){.extremes = {{HUGE_VAL, 0}, {HUGE_VAL, 0}, 0, HUGE_VAL, 0, 1, 1}};
    for (tri_triangle_id t = range.first; t < range.last; t++) {
        assert(tri_is_live(&s->mesh->tri[t]));
        struct tri_shape shape = tri_shape_of(s->mesh->xy, s->mesh->tri[t].v);
        measure(&tally->shapes, &tally->extremes, &shape, s->limits);
    }
}

static void add_tally(struct tally *sum, const struct tally *add)
{
    for (int k = 0; k < TRI_ASPECT_BINS; k++)
        sum->shapes.aspects[k] += add->shapes.aspects[k];
    for (int k = 0; k < TRI_ANGLE_BINS; k++)
        sum->shapes.angles[k] += add->shapes.angles[k];
    struct extremes *x = &sum->extremes;
    const struct extremes *y = &add->extremes;
    for (int k = 0; k < 2; k++) {
        widen(x->area2, y->area2[k]);
        widen(x->length2, y->length2[k]);
    }
    x->total_area2 += y->total_area2;
    x->least_altitude2 = tri_lesser(x->least_altitude2, y->least_altitude2);
    x->greatest_aspect = tri_larger(x->greatest_aspect, y->greatest_aspect);
    x->least_sine2 = tri_lesser(x->least_sine2, y->least_sine2);
    x->least_cosine = tri_lesser(x->least_cosine, y->least_cosine);
}

void tri_measure_shapes(struct tri_shapes *shapes, const struct tri_mesh *mesh, const struct tri_executor *executor)
{
    struct survey s = {.mesh = mesh};
    *shapes = (struct tri_shapes){0};
    if (mesh->n_triangles == 0)
        return;
    for (int k = 0; k < TRI_ANGLE_BINS; k++)
        s.limits[k] = k == 9 ? 0 : tri_cos_degrees(10 * k); /* right angles are common and must be exact */
    size_t shares = tri_shares(mesh->n_triangles);
    tri_execute(executor, shares, measure_share, &s);
    for (size_t i = 1; i < shares; i++)
        add_tally(&s.tally[0], &s.tally[i]);
    *shapes = s.tally[0].shapes;
    convert(shapes, &s.tally[0].extremes, mesh->unit);
}
