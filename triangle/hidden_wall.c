/* Where subsegments that are encroached stay as they are for a while.
 *
 * All subsegments that a point encroaches and sees are walls of its cavity if no vertex encroaches them (cavity.h). In
 * one call for the whole mesh those that vertices encroach are split first (refine.c, order). Within a fence those that
 * reach beyond it cannot be, and a pre-refinement leaves what is short: the triangle beside such a subsegment may be
 * flat, its disk is then hardly wider than itself, and a point comes to lie as near to the subsegment as rounding has
 * it. When that is split beside the point, the edge between them is the shortest of all around, and belongs to no
 * feature: angles there are given up as having run away (feature_size.h). So it is looked for.
 *
 * THEOREM. Call an edge wide if p sees it under more than 180 degrees - 2 b. Let p be R away from all vertices, and
 * less than R sin(b) from subsegment s, in whose lens it lies, with no other subsegment between. Then from one of the
 * edges of p's cavity a walk across wide edges leads to s. Proof. p sees s under an obtuse angle, so the foot q of the
 * perpendicular lies on s. Each edge that the way from p to q crosses has both ends no nearer than R, and passes p no
 * farther than |pq|: p sees it under at least 180 degrees - 2 asin(|pq| / R). And the edges behind an edge whose inner
 * sides p sees are seen under angles that together are that of the edge, below 180 degrees, or there is one alone: for
 * b up to 45 degrees one of them at most is wide, and the walk does not branch. Edges that pass farther away than
 * R sin(b) are not crossed: where points lie in a long row, one would otherwise walk along it.
 *
 * Subsegments farther away are no nearer than R sin(b), which is what splitting those that are seen keeps to, too. */
#include "triangle/hidden_wall.h"

#include <assert.h>
#include <math.h>

#include "triangle/criterion.h"

/* An edge seen from p, and what lies behind it. */
struct view {
    tri_link link;
    tri_vertex_id a, b; /* counter-clockwise around p */
    struct tri_relative ra, rb;
};

/* What the walk crosses. */
struct way {
    double lens_cos2; /* wider edges than this */
    double near2;     /* that pass p nearer than the root of this */
};

/* From the point of the cavity. */
static struct way way_from(const struct tri_cavity *c, double lens_cos2)
{
    double nearest = HUGE_VAL;
    for (int32_t i = 0; i < c->n_edges; i++)
        nearest = c->edge[i].ra.l < nearest ? c->edge[i].ra.l : nearest;
    return (struct way){lens_cos2, nearest * (1 - sqrt(lens_cos2)) / 2};
}

static bool is_wide(struct tri_relative a, struct tri_relative b, double lens_cos2)
{
    double dot = a.x * b.x + a.y * b.y;
    return dot < 0 && dot * dot > lens_cos2 * a.l * b.l;
}

static bool is_crossed(const struct way *way, struct tri_relative a, struct tri_relative b)
{
    if (!is_wide(a, b, way->lens_cos2))
        return false;
    double dot = a.x * b.x + a.y * b.y, cross = tri_cross(a, b);
    return cross > 0 && cross * cross < way->near2 * (a.l + b.l - 2 * dot);
}

/* From such an edge on across others: to a subsegment, or to where there is none. Triangles are entered that are
 * owned alone: of others the links may be changing. */
static enum tri_search walk(struct tri_cavity *c, const struct tri_mesh *mesh, struct view at, const struct way *way,
                            tri_sub_id *s)
{
    while (at.link >= 0) {
        const struct tri_triangle *t = &mesh->tri[tri_of(at.link)];
        int e = tri_edge(at.link);
        tri_vertex_id apex = t->v[e];
        assert(t->v[tri_next[e]] == at.b && t->v[tri_prev[e]] == at.a);
        struct tri_relative r = tri_relative(&mesh->xy[apex], c->p);
        bool left = is_crossed(way, at.ra, r);
        if (!left && !is_crossed(way, r, at.rb))
            return TRI_SEARCH_FOUND;
        if (c->fence && !tri_fence_holds(c->fence, mesh->xy[apex]))
            return TRI_SEARCH_FENCED;
        at = left ? (struct view){t->n[tri_next[e]], at.a, apex, at.ra, r}
                  : (struct view){t->n[tri_prev[e]], apex, at.b, r, at.rb};
    }
    if (at.link == TRI_BEYOND) {
        c->beyond[0] = at.a;
        c->beyond[1] = at.b;
        return TRI_SEARCH_BEYOND;
    }
    *s = ~at.link;
    return TRI_SEARCH_FOUND;
}

enum tri_search tri_find_hidden_wall(struct tri_cavity *c, const struct tri_mesh *mesh,
                                     const struct tri_refine_options *options, double lens_cos2, tri_sub_id *s)
{
    enum tri_search found = TRI_SEARCH_FOUND;
    *s = TRI_NONE;
    for (int32_t i = 0; i < c->n_edges && found == TRI_SEARCH_FOUND && *s == TRI_NONE; i++) {
        const struct tri_cavity_edge *edge = &c->edge[i], *next = edge + 1;
        if (edge->outer < 0 || !is_wide(edge->ra, next->ra, lens_cos2))
            continue; /* nearly always */
        const struct way way = way_from(c, lens_cos2);
        if (is_crossed(&way, edge->ra, next->ra))
            found = walk(c, mesh, (struct view){edge->outer, edge->a, next->a, edge->ra, next->ra}, &way, s);
        if (*s != TRI_NONE && tri_is_protected(options, &mesh->sub[*s]))
            *s = TRI_NONE;
    }
    return found;
}
