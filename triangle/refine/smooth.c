/* One smoothing pass moves each vertex to the point that minimises the sum of 1 / q over its triangles, and flips
 * edges until they are Delaunay. The quality q = 4 sqrt(3) area / (sum of the squared edges) is 1 for an equilateral
 * triangle.
 *
 * POSITION. Let e be the edge opposite the vertex x in one of its triangles, l its length, t the height of x over
 * it, and x* the apex of the equilateral triangle over e. Then 1 / q = 1 + |x - x*|^2 / (sqrt(3) l t). For constant
 * t the sum is smallest at the mean of all x* with weights 1 / (l t). The gradient with respect to t shifts each x*
 * along the normal of e. Two such steps are made. No size field is needed: graded rims keep their grading.
 *
 * INVARIANT. Input vertices and vertices on segments do not move. A move is made only if all triangles keep their
 * orientation (tested exactly), none violates the angle bound, the sum decreases, and the smallest q does not
 * decrease or stays good. Delaunay flips increase the smallest angle of two triangles (Lawson 1977), so angle bounds
 * stay satisfied. */
#include "triangle/refine/smooth.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/base/grow.h"
#include "triangle/cdt/flip.h"
#include "triangle/geometry/predicates.h"
#include "triangle/tunables.h"

struct tri_smooth {
    struct tri_mesh *mesh;   /* borrowed */
    double sin2;             /* squared sine of the angle bound */
    tri_triangle_id *corner; /* [n_vertices] a triangle that has the vertex as a corner; TRI_NONE: none */
};

enum { MOST_RIM = 32 }; /* a vertex with more triangles does not move */

/* The triangles around a vertex. Triangle i has the rim vertices i and i + 1. */
struct star {
    int n;                              /* number of triangles */
    tri_triangle_id triangle[MOST_RIM]; /* [n] in counter-clockwise order */
    struct tri_point rim[MOST_RIM + 1]; /* [n + 1] the last repeats the first */
};

/* The quality of a star, for a given position of its vertex. */
struct worth {
    double sum;   /* sum of 1 / q over the triangles */
    double least; /* smallest q */
    int n_bad;    /* triangles with an angle below the bound */
};

bool tri_wants_smoothing(const struct tri_quality *quality)
{
    return quality->passes > 0 && quality->max_area <= 0 && !quality->region_areas && !quality->unsuitable &&
           !quality->conforming && quality->max_steiner < 0;
}

enum tri_status tri_smooth_new(struct tri_smooth **smooth, struct tri_mesh *mesh, const struct tri_quality *quality,
                              struct tri_error *error)
{
    struct tri_smooth *r = malloc(sizeof *r);
    *smooth = NULL;
    if (r)
        *r = (struct tri_smooth){mesh, tri_bounds_of(quality, tri_worked_angle(quality)).sin2,
                                tri_mesh_extra(mesh, ((size_t)mesh->n_vertices + 1) * sizeof *r->corner)};
    if (!r || !r->corner) {
        free(r);
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for smoothing");
    }
    for (tri_vertex_id v = 0; v < mesh->n_vertices; v++)
        r->corner[v] = TRI_NONE;
    for (tri_triangle_id t = 0; t < mesh->n_triangles; t++)
        for (int k = 0; k < 3 && tri_is_live(&mesh->tri[t]); k++)
            r->corner[mesh->tri[t].v[k]] = t;
    *smooth = r;
    return TRI_OK;
}

void tri_smooth_free(struct tri_smooth *smooth)
{
    if (smooth)
        tri_mesh_extra_free(smooth->mesh, smooth->corner);
    free(smooth);
}

/* Collects the star of a vertex. Returns false if the vertex must not move: it touches a subsegment, another region,
 * or too many triangles. Also returns false, with *is_here false, if not all of its triangles lie in the fence. */
static bool take_star(const struct tri_smooth *r, tri_vertex_id v, const struct tri_fence *fence, struct star *s,
                      bool *is_here)
{
    const struct tri_mesh *mesh = r->mesh;
    const tri_triangle_id first = r->corner[v];
    *is_here = !fence || tri_fence_holds(fence, mesh->xy[v]);
    s->n = 0;
    if (first == TRI_NONE || !*is_here)
        return false;
    tri_triangle_id t = first;
    do {
        const struct tri_triangle *at = &mesh->tri[t];
        const int k = tri_corner_of(at, v);
        const struct tri_point q = mesh->xy[at->v[tri_next[k]]];
        const tri_link out = at->n[k], on = at->n[tri_next[k]];
        *is_here = !fence || tri_fence_holds(fence, q);
        if (!*is_here || s->n == MOST_RIM || on < 0 || (out >= 0 && mesh->tri[tri_of(out)].region != at->region))
            return false;
        s->triangle[s->n] = t;
        s->rim[s->n++] = q;
        t = tri_of(on);
    } while (t != first);
    s->rim[s->n] = s->rim[0];
    return true;
}

static struct worth worth_at(const struct tri_smooth *r, const struct star *s, struct tri_point x)
{
    const double TWO_ROOT_3 = 3.4641016151377544;
    struct worth w = {0, 2, 0};
    for (int i = 0; i < s->n; i++) {
        const struct tri_point a = {s->rim[i].x - x.x, s->rim[i].y - x.y};
        const struct tri_point b = {s->rim[i + 1].x - x.x, s->rim[i + 1].y - x.y}, c = {b.x - a.x, b.y - a.y};
        const double area2 = a.x * b.y - a.y * b.x, la = a.x * a.x + a.y * a.y, lb = b.x * b.x + b.y * b.y;
        const double lc = c.x * c.x + c.y * c.y, q = TWO_ROOT_3 * area2 / (la + lb + lc);
        w.sum += 1 / q;
        w.least = tri_lesser(w.least, q);
        w.n_bad += area2 * area2 < r->sin2 * tri_longer_product(la, lb, lc);
    }
    return w;
}

/* Returns the weighted mean of the ideal apexes over the rim edges, for a vertex at x. */
static struct tri_point better_place(const struct star *s, struct tri_point x)
{
    const double HALF_ROOT_3 = 0.8660254037844386;
    double sum_x = 0, sum_y = 0, sum = 0;
    for (int i = 0; i < s->n; i++) {
        const struct tri_point a = s->rim[i], e = {s->rim[i + 1].x - a.x, s->rim[i + 1].y - a.y};
        const double weight = 1 / (e.x * (x.y - a.y) - e.y * (x.x - a.x)); /* 1 / (l t) */
        struct tri_point apex = {a.x + 0.5 * e.x - HALF_ROOT_3 * e.y, a.y + 0.5 * e.y + HALF_ROOT_3 * e.x};
        const double dx = x.x - apex.x, dy = x.y - apex.y, shift = 0.5 * weight * (dx * dx + dy * dy);
        sum_x += weight * (apex.x + shift * e.y); /* gradient with respect to t: along the normal, away from the edge */
        sum_y += weight * (apex.y - shift * e.x);
        sum += weight;
    }
    return (struct tri_point){sum_x / sum, sum_y / sum};
}

static bool is_better(const struct worth *now, const struct worth *then)
{
    return then->least > TRI_SMOOTH_LEAST && then->sum < now->sum - TRI_SMOOTH_GAIN && then->n_bad == 0 &&
           (then->least >= now->least || then->least > TRI_SMOOTH_GOOD);
}

/* Sets *x to a better position. Returns false if there is none. */
static bool find_place(const struct tri_smooth *r, const struct star *s, struct tri_point *x)
{
    struct worth now = worth_at(r, s, *x);
    bool found = false, again = now.least <= TRI_SMOOTH_FINE;
    for (int round = 0; again && round < 2; round++) {
        const struct tri_point there = better_place(s, *x);
        again = false;
        for (double step = 1; !again && step > 0.2; step /= 2) {
            const struct tri_point p = tri_point_between(*x, there, step);
            const struct worth then = worth_at(r, s, p);
            again = is_better(&now, &then);
            if (again) {
                *x = p;
                now = then;
                found = true;
            }
        }
    }
    return found;
}

static bool keeps_orientation(const struct star *s, struct tri_point x)
{
    for (int i = 0; i < s->n; i++)
        if (tri_orient2d(x, s->rim[i], s->rim[i + 1]) <= 0)
            return false;
    return true;
}

/* Smooths one vertex and counts the outcome. Returns false if memory ran out. */
static bool smooth_one(const struct tri_smooth *r, struct tri_flips *flips, tri_vertex_id v, bool *is_here,
                       struct tri_smooth_count *count)
{
    struct star s;
    if (!take_star(r, v, flips->fence, &s, is_here))
        return true;
    struct tri_point x = r->mesh->xy[v];
    if (!find_place(r, &s, &x) || (flips->fence && !tri_fence_holds(flips->fence, x)) || !keeps_orientation(&s, x))
        return true;
    r->mesh->xy[v] = x;
    count->moved++;
    for (int i = 0; i < s.n; i++)
        if (!tri_flip_touch(flips, s.triangle[i]))
            return false;
    return tri_flip_legalise(flips);
}

enum tri_status tri_smooth_some(struct tri_smooth *r, tri_vertex_id *vertex, int32_t n, const struct tri_fence *fence,
                                struct tri_smooth_count *count, struct tri_error *error)
{
    struct tri_flips flips = {.mesh = r->mesh, .corner = r->corner, .ties_stay = true, .fence = fence};
    enum tri_status status = TRI_OK;
    uint32_t step = 0;
    *count = (struct tri_smooth_count){0};
    for (int32_t i = 0; !status && i < n; i++) {
        bool is_here;
        assert(tri_is_movable(r->mesh, vertex[i]));
        if (tri_stop_is_due(r->mesh->stop, &step))
            status = tri_fail_stopped(error);
        else if (!smooth_one(r, &flips, vertex[i], &is_here, count))
            status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for flips");
        else if (!is_here)
            vertex[count->left++] = vertex[i];
    }
    tri_flips_free(&flips);
    return status;
}

enum tri_status tri_smooth_end(struct tri_smooth *r, const struct tri_executor *executor, struct tri_error *error)
{
    return tri_flip_to_delaunay(r->mesh, executor, error);
}

enum tri_status tri_smooth_all(struct tri_mesh *mesh, const struct tri_quality *quality, struct tri_error *error)
{
    struct tri_smooth *r = NULL;
    tri_vertex_id *vertex = malloc(((size_t)mesh->n_vertices + 1) * sizeof *vertex);
    enum tri_status status = vertex ? tri_smooth_new(&r, mesh, quality, error)
                                    : tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for smoothing");
    struct tri_smooth_count count = {.moved = 1};
    for (int pass = 0; !status && count.moved > 0 && pass < quality->passes; pass++) {
        int32_t n = 0;
        for (tri_vertex_id v = 0; v < mesh->n_vertices; v++)
            if (tri_is_movable(mesh, v))
                vertex[n++] = v;
        status = tri_smooth_some(r, vertex, n, NULL, &count, error);
    }
    status = status ? status : tri_smooth_end(r, NULL, error);
    tri_smooth_free(r);
    free(vertex);
    return status;
}
