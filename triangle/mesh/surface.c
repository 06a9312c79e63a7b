/* Each vertex is located by a walk from the triangle that held the previous one. If the walk meets the boundary, a tree
 * of bounding boxes is searched instead. The triangles are sorted along a Hilbert curve, and the two children of a box
 * hold the two halves of its range of triangles.
 *
 * INVARIANT. The result does not depend on the method: triangles share only edges, on which both sides compute
 * identical bits, and only the box search decides for vertices that rounding has placed outside. */
#include "triangle/mesh/surface.h"

#include <stdlib.h>

#include "triangle/geometry/expansion.h"
#include "triangle/geometry/hilbert.h"
#include "triangle/geometry/predicates.h"
#include "triangle/mesh/locate.h"

enum { FEW = 8, BLOCK_VERTICES = 4096, SIDES = 4 };

struct box {
    double most[SIDES]; /* upper bounds of x, y, -x, -y of its triangles, enlarged by the rounding of vertices */
};

struct tri_surface {
    struct tri_mesh mesh;   /* only its growing arrays are set */
    tri_triangle_id *order; /* [mesh.n_triangles] triangles sorted along the curve */
    struct box *box;        /* [1] is the root, [2 i] and [2 i + 1] the children of [i]; leaves hold at most FEW
                               triangles */
    bool has_chains;        /* parents may consist of several subsegments */
    int32_t n_settled;      /* number of leading vertices whose attributes are set */
};

static double clamp_to(double value, double least, double most) { return tri_larger(tri_lesser(value, most), least); }

static double *attributes_of(const struct tri_mesh *mesh, tri_vertex_id v)
{
    return mesh->attributes + (size_t)v * (size_t)mesh->n_attributes;
}

void tri_interpolate_edge(const struct tri_mesh *mesh, tri_vertex_id a, tri_vertex_id b, struct tri_point p, double *to)
{
    const struct tri_point from = mesh->xy[a], end = mesh->xy[b];
    const double x = end.x - from.x, y = end.y - from.y;
    const double fraction = ((p.x - from.x) * x + (p.y - from.y) * y) / (x * x + y * y);
    for (int32_t k = 0; k < mesh->n_attributes; k++) {
        const double at_a = attributes_of(mesh, a)[k], at_b = attributes_of(mesh, b)[k];
        to[k] = clamp_to(at_a + fraction * (at_b - at_a), tri_lesser(at_a, at_b), tri_larger(at_a, at_b));
    }
}

/* Computes twice the area of the triangle that p forms with each edge. The rounding error is at most 2^-50 of *all, the
 * sum of the absolute values of the products. */
static void areas_by_products(const struct tri_mesh *mesh, const tri_vertex_id v[3], struct tri_point p, double area[3],
                              double *all)
{
    *all = 0;
    for (int e = 0; e < 3; e++) {
        const struct tri_point a = mesh->xy[v[tri_next[e]]], b = mesh->xy[v[tri_prev[e]]];
        const double left = (a.x - p.x) * (b.y - p.y), right = (a.y - p.y) * (b.x - p.x);
        area[e] = left - right;
        *all += fabs(left) + fabs(right);
    }
}

/* Evaluates at p the linear function through the corners of a triangle. The weights are areas. In thin triangles and
 * near edges each weight is accurate to its last places, however small it is. On an edge, the triangles on both sides
 * compute the same value. */
static void interpolate(const struct tri_mesh *mesh, const tri_vertex_id corners[3], struct tri_point p, double *to)
{
    const int first = corners[1] < corners[0] && corners[1] < corners[2] ? 1 : corners[2] < corners[0] ? 2 : 0;
    const tri_vertex_id v[3] = {corners[first], corners[tri_next[first]], corners[tri_prev[first]]};
    double area[3], all;
    areas_by_products(mesh, v, p, area, &all);
    const double least = tri_lesser(area[0], tri_lesser(area[1], area[2]));
    bool thin = !(least > 0x1p-50 * all) || all > 3 * (area[0] + area[1] + area[2]);
    for (int e = 0; thin && e < 3; e++) {
        const tri_vertex_id a = v[tri_next[e]], b = v[tri_prev[e]];
        area[e] = tri_orient2d_pair(mesh->xy[a], mesh->xy[b], p).head;
        if (!(area[e] > 0)) {
            tri_interpolate_edge(mesh, a < b ? a : b, a < b ? b : a, p, to);
            return;
        }
    }
    const double sum = area[0] + area[1] + area[2];
    for (int32_t k = 0; k < mesh->n_attributes; k++) {
        const double a = attributes_of(mesh, v[0])[k];
        const double b = attributes_of(mesh, v[1])[k], c = attributes_of(mesh, v[2])[k];
        const double value = a + (area[1] / sum * (b - a) + area[2] / sum * (c - a));
        to[k] = clamp_to(value, tri_lesser(a, tri_lesser(b, c)), tri_larger(a, tri_larger(b, c)));
    }
}

/* The bounds are enlarged because a vertex may lie off its segment by 2^-49 of its coordinates (docs/guarantees.md). */
static void make_box(const struct tri_surface *s, size_t i, int32_t first, int32_t end)
{
    double *most = s->box[i].most;
    for (int side = 0; side < SIDES; side++)
        most[side] = -HUGE_VAL;
    if (end - first > FEW) {
        make_box(s, 2 * i, first, first + (end - first) / 2);
        make_box(s, 2 * i + 1, first + (end - first) / 2, end);
        for (int side = 0; side < SIDES; side++)
            most[side] = tri_larger(s->box[2 * i].most[side], s->box[2 * i + 1].most[side]);
        return;
    }
    for (int32_t k = 3 * first; k < 3 * end; k++) {
        const struct tri_point p = s->mesh.xy[s->mesh.tri[s->order[k / 3]].v[k % 3]];
        const double at[SIDES] = {p.x, p.y, -p.x, -p.y}, more = 0x1p-48 * tri_larger(fabs(p.x), fabs(p.y));
        for (int side = 0; side < SIDES; side++)
            most[side] = tri_larger(most[side], at[side] + more);
    }
}

/* The array of boxes serves as scratch space for the sort before the boxes are made. */
enum tri_status tri_surface_keep(struct tri_mesh *mesh, const struct tri_executor *executor, struct tri_error *error)
{
    if (mesh->n_attributes == 0 || mesh->surface || mesh->n_triangles == 0)
        return TRI_OK;
    const size_t n = (size_t)mesh->n_triangles;
    struct tri_point *center = malloc(n * sizeof *center);
    struct tri_surface *s = mesh->surface = calloc(1, sizeof *s);
    if (s && !tri_mesh_copy(&s->mesh, mesh, error))
        *s = (struct tri_surface){s->mesh, malloc(n * sizeof *s->order), malloc((n / 2 + 2) * sizeof *s->box),
                                  mesh->n_parents < mesh->n_subs, mesh->n_vertices};
    const bool memory = center && s && s->order && s->box;
    for (tri_triangle_id t = 0; memory && t < mesh->n_triangles; t++) {
        const tri_vertex_id *v = mesh->tri[t].v;
        const struct tri_point a = mesh->xy[v[0]], b = mesh->xy[v[1]], c = mesh->xy[v[2]];
        center[t] = (struct tri_point){a.x + b.x + c.x, a.y + b.y + c.y};
        s->order[t] = t;
    }
    if (memory) {
        tri_hilbert_order(center, s->order, mesh->n_triangles, (uint64_t *)(void *)s->box, executor);
        make_box(s, 1, 0, mesh->n_triangles);
    } else {
        tri_surface_free(s);
        mesh->surface = NULL;
    }
    free(center);
    return memory ? TRI_OK : tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the attributes' surface");
}

void tri_surface_free(struct tri_surface *s)
{
    if (!s)
        return;
    tri_mesh_drop(&s->mesh);
    free(s->order);
    free(s->box);
    free(s);
}

/* --- point location */

struct search {
    const struct tri_surface *surface;
    struct tri_point p;
    tri_parent_id parent; /* >= 0: consider only triangles with an edge on this parent */
    tri_triangle_id best; /* the triangle that holds p or is nearest to it */
    double depth;         /* minus the distance of p outside `best`; HUGE_VAL: p is inside */
};

static void try_triangle(struct search *search, tri_triangle_id t)
{
    const struct tri_mesh *mesh = &search->surface->mesh;
    const struct tri_triangle *at = &mesh->tri[t];
    bool counts = search->parent < 0;
    double depth = HUGE_VAL;
    for (int e = 0; e < 3; e++) {
        const struct tri_point a = mesh->xy[at->v[tri_next[e]]], b = mesh->xy[at->v[tri_prev[e]]];
        const double side = tri_orient2d(a, b, search->p);
        if (side < 0)
            depth = tri_lesser(depth, side / sqrt(tri_distance2(a, b)));
        counts = counts || (at->n[e] < 0 && mesh->sub[~at->n[e]].parent == search->parent);
    }
    if (counts && depth > search->depth) {
        search->best = t;
        search->depth = depth;
    }
}

static void search_box(struct search *search, size_t i, int32_t first, int32_t end)
{
    const double *most = search->surface->box[i].most;
    const struct tri_point p = search->p;
    if (p.x > most[0] || p.y > most[1] || -p.x > most[2] || -p.y > most[3] || search->depth > 0)
        return;
    if (end - first > FEW) {
        search_box(search, 2 * i, first, first + (end - first) / 2);
        search_box(search, 2 * i + 1, first + (end - first) / 2, end);
        return;
    }
    for (int32_t k = first; k < end; k++)
        try_triangle(search, search->surface->order[k]);
}

void tri_surface_set(const struct tri_mesh *mesh, const tri_vertex_id *vertices, int32_t n)
{
    const struct tri_surface *s = mesh->surface;
    tri_triangle_id at = TRI_NONE;
    for (int32_t i = 0; s && i < n; i++) {
        const tri_vertex_id v = vertices[i];
        const tri_parent_id parent = mesh->on[v];
        assert(parent >= 0 || parent == TRI_VERTEX_FREE);
        if (parent >= 0 && !s->has_chains) {
            const tri_vertex_id *end = mesh->parents[parent].v;
            tri_interpolate_edge(mesh, end[0], end[1], mesh->xy[v], attributes_of(mesh, v));
            continue;
        }
        at = parent >= 0 || at == TRI_NONE ? TRI_NONE : tri_walk_to(&s->mesh, at, mesh->xy[v]);
        if (at == TRI_NONE) {
            struct search search = {s, mesh->xy[v], parent, s->order[0], -HUGE_VAL};
            search_box(&search, 1, 0, s->mesh.n_triangles);
            at = search.best;
        }
        interpolate(&s->mesh, s->mesh.tri[at].v, mesh->xy[v], attributes_of(mesh, v));
    }
}

/* Is the path through consecutive vertices about as short as it would be along a curve or in rows? */
static bool is_short_path(const struct tri_point *xy, int32_t n)
{
    struct tri_point low = xy[0], high = xy[0];
    double path = 0;
    for (int32_t i = 1; i < n; i++) {
        path += fabs(xy[i].x - xy[i - 1].x) + fabs(xy[i].y - xy[i - 1].y);
        low = (struct tri_point){tri_lesser(low.x, xy[i].x), tri_lesser(low.y, xy[i].y)};
        high = (struct tri_point){tri_larger(high.x, xy[i].x), tri_larger(high.y, xy[i].y)};
    }
    const double width = high.x - low.x, height = high.y - low.y;
    return path <= 4 * (width + height + sqrt(n * width * height));
}

/* Processes blocks of vertices. A block that jumps to and fro is sorted along a curve first. */
static void settle_share(void *context, size_t share)
{
    const struct tri_mesh *mesh = context;
    const tri_vertex_id first = mesh->surface->n_settled;
    const struct tri_range range = tri_share(share, mesh->n_vertices - first);
    tri_vertex_id part[BLOCK_VERTICES];
    uint64_t scratch[2 * BLOCK_VERTICES];
    for (int32_t i = range.first, n; i < range.last; i += n) {
        for (n = 0; n < BLOCK_VERTICES && i + n < range.last; n++)
            part[n] = first + i + n;
        if (!is_short_path(mesh->xy + part[0], n))
            tri_hilbert_order_coarse(mesh->xy, part, n, scratch);
        tri_surface_set(mesh, part, n);
    }
}

void tri_surface_settle(struct tri_mesh *mesh, const struct tri_executor *executor)
{
    if (!mesh->surface || mesh->n_vertices <= mesh->surface->n_settled)
        return;
    tri_execute(executor, tri_shares(mesh->n_vertices - mesh->surface->n_settled), settle_share, mesh);
    mesh->surface->n_settled = mesh->n_vertices;
}
