/* A tree over the boxes of the walls' diametral circles, leaves in the order of first ends, which lie along a curve.
 *
 * RULE. A point is refused (a) if a wall cuts the way to it from the corner of t that has it behind the opposite edge,
 * and (b) if it is before walls that do not tolerate it, and in the disk of the triangle beside each of them. THEOREM.
 * So it would be after a search, since no subsegment may be split: docs/theory.md, protected walls. */
#include "triangle/refine/walls.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/base/radix.h"
#include "triangle/geometry/predicates.h"
#include "triangle/mesh/cavity.h"
#include "triangle/tunables.h"

struct box {
    struct tri_point low, high;
};

struct tri_walls {
    const struct tri_criterion *criterion;
    int32_t n;
    uint64_t *wall;  /* [2 * n] the first half: in the low bits their numbers, in order */
    struct box *box; /* [2 * n] of node i; its parts are nodes 2 i and 2 i + 1; from n on each is of one wall */
};

/* What is known of a point so far. */
struct view {
    const struct tri_walls *walls;
    struct tri_point p, from; /* the second: a corner of t that has p behind the opposite edge, or p itself */
    double shortest;          /* edge of t, squared */
    tri_sub_id found;         /* the last wall that refuses p; TRI_NONE: none does, or only a search can tell */
    int left;                 /* so many walls may be looked at before a search is as good */
};

void tri_walls_free(struct tri_walls *w)
{
    if (w) {
        free(w->wall);
        free(w->box);
    }
    free(w);
}

/* About the circle, and a little more. */
static struct box box_of(struct tri_point a, struct tri_point b)
{
    const double r = 0.5000001 * sqrt(tri_distance2(a, b)), x = 0.5 * (a.x + b.x), y = 0.5 * (a.y + b.y);
    return (struct box){{x - r, y - r}, {x + r, y + r}};
}

static void fill(struct tri_walls *w)
{
    const struct tri_mesh *m = w->criterion->asked.mesh;
    for (int32_t i = 0; i < w->n; i++)
        w->wall[i] = (uint64_t)m->sub[i].v[0] << 32 | (uint32_t)i;
    tri_radix_sort(w->wall, w->wall + w->n, w->n, 32, 64, NULL);
    for (int32_t i = 0; i < w->n; i++) {
        const tri_vertex_id *v = m->sub[w->wall[i] & UINT32_MAX].v;
        w->box[w->n + i] = box_of(m->xy[v[0]], m->xy[v[1]]);
    }
    for (int32_t i = w->n - 1; i > 0; i--) {
        const struct box a = w->box[2 * i], b = w->box[2 * i + 1];
        w->box[i] = (struct box){{tri_lesser(a.low.x, b.low.x), tri_lesser(a.low.y, b.low.y)},
                                 {tri_larger(a.high.x, b.high.x), tri_larger(a.high.y, b.high.y)}};
    }
}

struct tri_walls *tri_walls_new(const struct tri_criterion *criterion)
{
    const struct tri_mesh *m = criterion->asked.mesh;
    for (tri_sub_id s = 0; s < m->n_subs; s++)
        if (!tri_is_protected(criterion->asked.quality, &m->sub[s]))
            return NULL;
    struct tri_walls *w = malloc(sizeof *w);
    if (!w)
        return NULL;
    *w = (struct tri_walls){criterion, m->n_subs, malloc(2 * (size_t)m->n_subs * sizeof *w->wall),
                            malloc(2 * (size_t)m->n_subs * sizeof *w->box)};
    if (m->n_subs > 0 && w->wall && w->box) {
        fill(w);
        return w;
    }
    tri_walls_free(w);
    return NULL;
}

/* Does the open line segment from a to b cross the one from c to d? */
static bool cross(struct tri_point a, struct tri_point b, struct tri_point c, struct tri_point d)
{
    const double p = tri_orient2d(c, d, a), q = tri_orient2d(c, d, b);
    if (!((p > 0 && q < 0) || (p < 0 && q > 0)))
        return false;
    const double r = tri_orient2d(a, b, c), s = tri_orient2d(a, b, d);
    return (r > 0 && s < 0) || (r < 0 && s > 0);
}

/* Is p in there beyond doubt, and no corner? */
static bool is_in_disk(const struct tri_mesh *m, tri_triangle_id t, struct tri_point p)
{
    const tri_vertex_id *v = m->tri[t].v;
    return tri_incircle(m->xy[v[0]], m->xy[v[1]], m->xy[v[2]], p) > 0;
}

/* False: the answer is there, view->found. */
static bool look_at(struct view *view, tri_sub_id s)
{
    const struct tri_criterion *criterion = view->walls->criterion;
    const struct tri_mesh *m = criterion->asked.mesh;
    const struct tri_subsegment *sub = &m->sub[s];
    const struct tri_point p = view->p, *a = &m->xy[sub->v[0]], *b = &m->xy[sub->v[1]];
    const bool left = tri_orient2d(*a, *b, p) > 0;
    const struct tri_relative u = tri_relative(left ? a : b, p), v = tri_relative(left ? b : a, p);
    const tri_halfedge side = sub->side[left ? 0 : 1];
    const bool cuts = cross(view->from, p, *a, *b);
    if (!cuts && (side == TRI_NONE || !tri_is_in_lens(u, v, criterion->bounds.lens_cos2) ||
                  tri_is_tolerated(u, v, tri_cross(u, v), view->shortest)))
        return true;
    view->found = cuts || is_in_disk(m, tri_of(side), p) ? s : TRI_NONE;
    return !cuts && view->found != TRI_NONE;
}

/* The same for the walls below a node. */
static bool look_below(struct view *view, int32_t node)
{
    const struct tri_walls *w = view->walls;
    const struct box *box = &w->box[node];
    const struct tri_point p = view->p;
    if (!(p.x >= box->low.x && p.x <= box->high.x && p.y >= box->low.y && p.y <= box->high.y))
        return true;
    if (node < w->n)
        return look_below(view, 2 * node) && look_below(view, 2 * node + 1);
    if (view->left-- > 0)
        return look_at(view, (tri_sub_id)(w->wall[node - w->n] & UINT32_MAX));
    view->found = TRI_NONE;
    return false;
}

tri_sub_id tri_wall_before(const struct tri_walls *w, tri_triangle_id t, struct tri_point p, double shortest)
{
    enum { MOST_WALLS = 256 };
    const struct tri_mesh *m = w->criterion->asked.mesh;
    struct view view = {w, p, p, shortest, TRI_NONE, MOST_WALLS};
    if (!tri_is_in_range(p) || !is_in_disk(m, t, p))
        return TRI_NONE;
    for (int k = 0; k < 3; k++) {
        const tri_vertex_id *v = m->tri[t].v;
        const struct tri_point a = m->xy[v[k]], b = m->xy[v[tri_next[k]]], c = m->xy[v[tri_prev[k]]];
        if (tri_orient2d(b, c, p) < 0 && tri_orient2d(a, b, p) > 0 && tri_orient2d(c, a, p) > 0)
            view.from = a;
    }
    look_below(&view, 1);
    return view.found;
}
