/* A face is a component of triangles between subsegments. Its code is OUTSIDE, 0 for no region, 1 + k for region k of
 * the PSLG, or 1 + n_regions + k for feature k. */
#include "triangle/api/region_polygons.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/grow.h"
#include "triangle/geometry/predicates.h"
#include "triangle/geometry/shape.h"

enum { OUTSIDE = -1, UNKNOWN = -2 };

static const double THIN = 16 * DBL_EPSILON; /* width of a face, as a share of the largest coordinate */

/* A face, seen from the centroid of its largest triangle. */
struct face {
    struct tri_point at;     /* the centroid */
    tri_triangle_id largest; /* the triangle */
    int32_t number;          /* number of the face */
    int32_t feature;         /* number of the last feature around it so far; -1: none */
    bool is_thin;            /* whether it is no wider than rounding */
    bool inside;             /* whether an odd number of rings of the current polygon enclose it so far */
};

struct dividing {
    struct tri_pslg *pslg;               /* the input, which is changed */
    const struct tri_polygons *polygons; /* the features and their rings */
    bool even_odd;                       /* of the options for the mesh */
    bool is_union;                       /* the polygons define the domain */
    int32_t n_points, n_segments, n_regions; /* numbers of the input as given */
    struct tri_mesh mesh;                /* triangulation of all segments and rings in the domain */
    double thin;                         /* largest width of a thin face, in units of the mesh */
    int32_t n_faces;                     /* number of faces */
    struct face *face;                   /* [n_faces] by height */
    int32_t *face_of;                    /* [n_triangles] number of the face of each triangle */
    int32_t *code;                       /* [n_faces + 1] code of the face with this number; the last is OUTSIDE */
};

void tri_polygons_free(struct tri_polygons *polygons)
{
    free(polygons->points);
    free(polygons->rings);
    free(polygons->features);
    *polygons = (struct tri_polygons){0};
}

static enum tri_status no_memory(struct tri_error *error)
{
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for regions by polygons");
}

/* Makes room for `more` items, which are 0, behind the first n. */
static bool extend(void *array, int32_t n, int64_t more, size_t item)
{
    char *items;
    if (!tri_resize(array, (size_t)(n + more + 1), item))
        return false;
    memcpy(&items, array, sizeof items);
    memset(items + (size_t)n * item, 0, (size_t)(more + 1) * item);
    return true;
}

/* --- triangulation */

/* Adds the rings to the PSLG, twice if parities count, which must not change. */
static enum tri_status add_rings(struct dividing *d, struct tri_error *error)
{
    struct tri_pslg *to = d->pslg;
    const struct tri_polygons *p = d->polygons;
    const int copies = d->even_odd ? 2 : 1;
    if (!extend(&to->points, to->n_points, p->n_points, 2 * sizeof *to->points) ||
        (to->markers && !extend(&to->markers, to->n_points, p->n_points, sizeof *to->markers)) ||
        !extend(&to->segments, to->n_segments, (int64_t)copies * p->n_points, 2 * sizeof *to->segments) ||
        !extend(&to->segment_markers, to->segment_markers ? to->n_segments : 0,
                (to->segment_markers ? 0 : to->n_segments) + (int64_t)copies * p->n_points,
                sizeof *to->segment_markers))
        return no_memory(error);
    memcpy(&to->points[2 * (size_t)to->n_points], p->points, 2 * (size_t)p->n_points * sizeof *p->points);
    to->n_points += p->n_points;
    for (int32_t r = 0; r < copies * p->n_rings; r++) {
        const struct tri_ring *ring = &p->rings[r / copies];
        for (int32_t k = ring->first; k < ring->end; k++) {
            int32_t *segment = &to->segments[2 * (size_t)to->n_segments++];
            segment[0] = d->n_points + k;
            segment[1] = d->n_points + (k + 1 < ring->end ? k + 1 : ring->first);
        }
    }
    return TRI_OK;
}

static enum tri_status triangulate(struct dividing *d, const struct tri_options *how, struct tri_error *error)
{
    struct tri_options options = tri_defaults();
    struct tri_report report;
    enum tri_status status = add_rings(d, error);
    options.use_segments = options.spread_regions = true;
    options.keep_hull = d->is_union || how->keep_hull;
    options.ignore_holes = how->ignore_holes;
    options.even_odd = !d->is_union && how->even_odd;
    options.n_open = d->pslg->n_segments - d->n_segments;
    options.executor = how->executor;
    options.stop = how->stop;
    status = status ? status : tri_generate(&d->mesh, d->pslg, &options, &report, error);
    double largest = 0; /* outside the domain there may be polygons far away */
    for (int64_t i = 0; i < 3 * (int64_t)d->mesh.n_triangles; i++) {
        const struct tri_point p = d->mesh.xy[d->mesh.tri[i / 3].v[i % 3]];
        largest = tri_larger(largest, tri_larger(fabs(p.x), fabs(p.y)));
    }
    d->thin = THIN * largest;
    return status;
}

/* --- faces */

static struct tri_shape shape_of(const struct dividing *d, tri_triangle_id t)
{
    return tri_shape_of(d->mesh.xy, d->mesh.tri[t].v);
}

static void add_face(struct dividing *d, tri_triangle_id start, tri_triangle_id *stack)
{
    const struct tri_triangle *tri = d->mesh.tri;
    const struct tri_point *xy = d->mesh.xy;
    int32_t n = 0;
    tri_triangle_id largest = stack[n++] = start;
    for (d->face_of[start] = d->n_faces; n > 0;) {
        const tri_triangle_id t = stack[--n];
        largest = shape_of(d, t).area2 > shape_of(d, largest).area2 ? t : largest;
        for (int e = 0; e < 3; e++)
            if (tri[t].n[e] >= 0 && d->face_of[tri_of(tri[t].n[e])] < 0) {
                d->face_of[tri_of(tri[t].n[e])] = d->n_faces;
                stack[n++] = tri_of(tri[t].n[e]);
            }
    }
    const struct tri_point a = xy[tri[largest].v[0]], b = xy[tri[largest].v[1]], c = xy[tri[largest].v[2]];
    const struct tri_point at = {tri_round_coordinate((a.x + b.x + c.x) / 3),
                                 tri_round_coordinate((a.y + b.y + c.y) / 3)};
    const struct tri_shape shape = shape_of(d, largest);
    const bool is_thin = shape.area2 <= d->thin * sqrt(tri_longest2(&shape));
    d->face[d->n_faces] = (struct face){at, largest, d->n_faces, -1, is_thin, false};
    d->n_faces++;
}

static int compare_heights(const void *left, const void *right)
{
    const struct face *a = left, *b = right;
    return a->at.y != b->at.y ? (a->at.y < b->at.y ? -1 : 1) : (a->number > b->number) - (a->number < b->number);
}

/* Lists the faces. All arrays have one entry for each triangle, since there is no more than one face for each. */
static enum tri_status list_faces(struct dividing *d, struct tri_error *error)
{
    const size_t n = (size_t)d->mesh.n_triangles + 1;
    tri_triangle_id *stack = malloc(n * sizeof *stack);
    d->face_of = malloc(n * sizeof *d->face_of);
    d->code = malloc(n * sizeof *d->code);
    d->face = malloc(n * sizeof *d->face);
    const bool ok = stack && d->face_of && d->code && d->face;
    for (tri_triangle_id t = 0; ok && t < d->mesh.n_triangles; t++)
        d->face_of[t] = -1;
    for (tri_triangle_id t = 0; ok && t < d->mesh.n_triangles; t++)
        if (d->face_of[t] < 0)
            add_face(d, t, stack);
    free(stack);
    if (!ok)
        return no_memory(error);
    qsort(d->face, (size_t)d->n_faces, sizeof *d->face, compare_heights);
    return TRI_OK;
}

/* --- features */

/* Changes the parity of faces on the left of a segment. Extends the range of numbers around those at its height. */
static void cross_segment(const struct dividing *d, struct tri_point a, struct tri_point b, int32_t range[2])
{
    const double low = tri_lesser(a.y, b.y), high = tri_larger(a.y, b.y);
    int32_t i = 0, end = d->n_faces;
    while (i < end) { /* finds the first that is not below */
        const int32_t middle = i + (end - i) / 2;
        if (d->face[middle].at.y < low)
            i = middle + 1;
        else
            end = middle;
    }
    range[0] = i < range[0] ? i : range[0];
    for (; i < d->n_faces && d->face[i].at.y < high; i++)
        if ((tri_orient2d(a, b, d->face[i].at) > 0) == (b.y > a.y))
            d->face[i].inside = !d->face[i].inside;
    range[1] = i > range[1] ? i : range[1];
}

static struct tri_point ring_point(const struct dividing *d, int32_t k)
{
    return tri_to_units(&d->mesh, d->polygons->points[2 * (size_t)k], d->polygons->points[2 * (size_t)k + 1]);
}

/* Finds the last feature around each face. */
static void find_features(struct dividing *d)
{
    const struct tri_polygons *p = d->polygons;
    int32_t range[2] = {d->n_faces, 0};
    for (int32_t r = 0; r < p->n_rings; r++) {
        const struct tri_ring *ring = &p->rings[r];
        for (int32_t k = ring->first; k < ring->end; k++)
            cross_segment(d, ring_point(d, k), ring_point(d, k + 1 < ring->end ? k + 1 : ring->first), range);
        if (r + 1 < p->n_rings && ring[1].polygon == ring->polygon)
            continue;
        for (int32_t i = range[0]; i < range[1]; i++) {
            d->face[i].feature = d->face[i].inside ? ring->feature : d->face[i].feature;
            d->face[i].inside = false;
        }
        range[0] = d->n_faces;
        range[1] = 0;
    }
}

/* --- codes */

static bool is_ring(const struct dividing *d, tri_sub_id s)
{
    return d->mesh.parents[d->mesh.sub[s].parent].segment >= d->n_segments;
}

/* Returns the number of the face on one side of a subsegment; n_faces: there is no triangle. */
static int32_t face_beside(const struct dividing *d, tri_sub_id s, int side)
{
    const tri_halfedge code = d->mesh.sub[s].side[side];
    return code == TRI_NONE ? d->n_faces : d->face_of[tri_of(code)];
}

/* Sets the codes. Thin faces join a neighbour across a ring, in the next pass a neighbour's neighbour, and so on. */
static void set_codes(const struct dividing *d)
{
    for (int32_t i = 0; i < d->n_faces; i++) {
        const struct face *face = &d->face[i];
        const int32_t own = d->is_union ? OUTSIDE : d->mesh.tri[face->largest].region;
        const int32_t code = face->feature < 0 ? own : 1 + d->n_regions + face->feature;
        d->code[face->number] = face->is_thin ? UNKNOWN : code;
    }
    d->code[d->n_faces] = OUTSIDE;
    for (tri_sub_id s = 0; s < d->mesh.n_subs; s++) /* no polygon is beyond an edge of the hull alone */
        if (d->is_union && d->mesh.parents[d->mesh.sub[s].parent].segment == TRI_NONE)
            d->code[face_beside(d, s, 0)] = d->code[face_beside(d, s, 1)] = OUTSIDE;
    for (bool changed = true; changed;) {
        changed = false;
        for (tri_sub_id s = 0; s < d->mesh.n_subs; s++) {
            int32_t *a = &d->code[face_beside(d, s, 0)], *b = &d->code[face_beside(d, s, 1)];
            if (!is_ring(d, s) || (*a == UNKNOWN) == (*b == UNKNOWN))
                continue;
            *(*a == UNKNOWN ? a : b) = *a == UNKNOWN ? *b : *a;
            changed = true;
        }
    }
}

/* --- the result */

/* Returns the number of a vertex in the result. New ones are added. end: [n_vertices], their numbers + 1; 0: not
 * added yet. */
static int32_t number_of(const struct dividing *d, tri_vertex_id v, int32_t *end)
{
    const struct tri_mesh *mesh = &d->mesh;
    const int32_t input = v < mesh->n_input ? tri_point_of(mesh, v) : d->n_points;
    if (input < d->n_points)
        return input;
    if (end[v] == 0) {
        tri_mesh_place(mesh, v, &d->pslg->points[2 * (size_t)d->pslg->n_points]);
        end[v] = ++d->pslg->n_points;
    }
    return end[v] - 1;
}

/* Adds the given subsegments, and those of rings between faces of different codes. If parities count, subsegments that
 * do not bound the domain are added twice. */
static void add_segments(const struct dividing *d, int32_t *end)
{
    struct tri_pslg *to = d->pslg;
    to->n_segments = 0;
    for (tri_sub_id s = 0; s < d->mesh.n_subs; s++) {
        const struct tri_subsegment *sub = &d->mesh.sub[s];
        const int32_t a = d->code[face_beside(d, s, 0)], b = d->code[face_beside(d, s, 1)];
        const bool is_border = (a == OUTSIDE) != (b == OUTSIDE);
        if (d->mesh.parents[sub->parent].segment == TRI_NONE || (is_ring(d, s) && a == b))
            continue;
        for (int copies = d->even_odd && !is_border ? 2 : 1; copies > 0; copies--, to->n_segments++) {
            to->segment_markers[to->n_segments] = sub->marker;
            for (int k = 0; k < 2; k++)
                to->segments[2 * (size_t)to->n_segments + (size_t)k] = number_of(d, sub->v[k], end);
        }
    }
}

/* Adds a region point to each face with a region, and a hole point to each face outside the union. */
static void add_seeds(const struct dividing *d)
{
    struct tri_pslg *to = d->pslg;
    for (int32_t i = 0; i < d->n_faces; i++) {
        const int32_t region = d->code[d->face[i].number] - 1, feature = region - d->n_regions;
        const double at[2] = {d->face[i].at.x * d->mesh.unit, d->face[i].at.y * d->mesh.unit};
        if (d->face[i].is_thin)
            continue;
        if (region == OUTSIDE - 1)
            memcpy(&to->holes[2 * (size_t)to->n_holes++], at, sizeof at);
        if (region < 0)
            continue;
        double *row = memcpy(&to->regions[4 * (size_t)to->n_regions++], at, sizeof at);
        const struct tri_feature *of = feature < 0 ? NULL : &d->polygons->features[feature];
        row[2] = of ? of->attribute : to->regions[4 * (size_t)region + 2];
        row[3] = of ? of->max_area : to->regions[4 * (size_t)region + 3];
    }
}

static enum tri_status make_result(struct dividing *d, struct tri_error *error)
{
    struct tri_pslg *to = d->pslg;
    const int32_t vertices = d->mesh.n_vertices, subs = d->mesh.n_subs;
    int32_t *end = calloc((size_t)vertices + 1, sizeof *end);
    const bool ok = end && extend(&to->points, d->n_points, vertices, 2 * sizeof *to->points) &&
                    (!to->markers || extend(&to->markers, d->n_points, vertices, sizeof *to->markers)) &&
                    extend(&to->segments, 0, 2 * (int64_t)subs, 2 * sizeof *to->segments) &&
                    extend(&to->segment_markers, 0, 2 * (int64_t)subs, sizeof *to->segment_markers) &&
                    extend(&to->holes, to->n_holes, d->n_faces, 2 * sizeof *to->holes) &&
                    extend(&to->regions, to->n_regions, d->n_faces, 4 * sizeof *to->regions);
    if (ok) {
        to->n_points = d->n_points;
        add_segments(d, end);
        add_seeds(d);
    }
    free(end);
    return ok ? TRI_OK : no_memory(error);
}

enum tri_status tri_divide_by_polygons(struct tri_pslg *pslg, const struct tri_polygons *polygons,
                                       const struct tri_options *how, struct tri_error *error)
{
    if (pslg->n_attributes > 0)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "regions by polygons: the points have attributes, and those of"
                        " new points are not known");
    struct dividing d = {.pslg = pslg, .polygons = polygons, .even_odd = how->even_odd,
                         .is_union = pslg->n_segments == 0, .n_points = pslg->n_points,
                         .n_segments = pslg->n_segments, .n_regions = pslg->n_regions};
    enum tri_status status = triangulate(&d, how, error);
    status = status ? status : list_faces(&d, error);
    if (!status) {
        find_features(&d);
        set_codes(&d);
        status = make_result(&d, error);
    }
    tri_mesh_free(&d.mesh);
    free(d.face);
    free(d.face_of);
    free(d.code);
    return status;
}
