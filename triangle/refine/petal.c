/* Walks through the connected part of the Voronoi diagram inside the petal that contains the triangle's
 * circumcentre. This part is a tree: a cycle would surround a vertex inside the petal, and there is none. */
#include "triangle/refine/petal.h"

#include <assert.h>

#include "triangle/mesh/cavity.h"
#include "triangle/tunables.h"

/* Limits on the waiting edges of the diagram and on the triangles visited. Larger trees are searched only in part;
 * trees of a hundred triangles have not been observed. If vertices around a corner are only a few ulps apart,
 * rounding can turn the tree into a ring of circumcentres; MOST_WALKED guarantees that the walk ends. */
enum { MOST_PENDING = 64, MOST_WALKED = 1024 };

/* The circumcentres of flatter triangles are unreliable. Flatness: twice the area over the longest squared edge. */
static const double FLAT = 1e-12;

struct petal {
    const struct tri_mesh *mesh; /* borrowed */
    struct tri_point a;     /* one end of the shortest edge; the coordinates below are relative to it */
    struct tri_point b;     /* the other end of the edge */
    struct tri_point o;     /* centre of the petal's disk */
    double r2;              /* squared radius of the disk */
    struct tri_point best;  /* best point so far */
    double best2;           /* squared distance from `best` to its nearest vertices */
};

/* A half-edge of the diagram: starts at the circumcentre c of a triangle and crosses the edge `code` of that
 * triangle. */
struct pending {
    tri_halfedge code; /* the edge of the triangle that is crossed */
    struct tri_point c; /* circumcentre at which the half-edge starts */
};

static struct tri_point relative(const struct petal *petal, tri_vertex_id v)
{
    struct tri_point q = petal->mesh->xy[v];
    return (struct tri_point){q.x - petal->a.x, q.y - petal->a.y};
}

static bool circumcentre(const struct petal *petal, tri_triangle_id t, struct tri_point *c)
{
    const tri_vertex_id *v = petal->mesh->tri[t].v;
    struct tri_point q = relative(petal, v[0]), r = relative(petal, v[1]), s = relative(petal, v[2]);
    double rx = r.x - q.x, ry = r.y - q.y, sx = s.x - q.x, sy = s.y - q.y;
    double area2 = rx * sy - ry * sx, lr = rx * rx + ry * ry, ls = sx * sx + sy * sy;
    if (!(area2 > FLAT * tri_larger(lr, ls)))
        return false;
    c->x = q.x + (sy * lr - ry * ls) * (0.5 / area2);
    c->y = q.y + (rx * ls - sx * lr) * (0.5 / area2);
    return true;
}

/* Is q on the triangle's side of the edge? */
static bool is_above(const struct petal *petal, struct tri_point q)
{
    return petal->b.x * q.y - petal->b.y * q.x > 0;
}

static bool is_in_disk(const struct petal *petal, struct tri_point q) { return tri_distance2(petal->o, q) < petal->r2; }

/* Makes q the best point if it is better. q lies on the boundary of the Voronoi cell of v. */
static void consider_point(struct petal *petal, struct tri_point q, tri_vertex_id v)
{
    double distance2 = tri_distance2(q, relative(petal, v));
    if (!is_above(petal, q) || !(distance2 > petal->best2))
        return;
    petal->best2 = distance2;
    petal->best = q;
}

/* Finds the point where the path from c, inside the disk, to d leaves the disk. Returns false if it does not. */
static bool leave_disk(const struct petal *petal, struct tri_point c, struct tri_point d, struct tri_point *at)
{
    double x = d.x - c.x, y = d.y - c.y, cx = c.x - petal->o.x, cy = c.y - petal->o.y;
    double l = x * x + y * y, half = cx * x + cy * y, inside = cx * cx + cy * cy - petal->r2;
    double root = half * half - l * inside;
    if (!(l > 0 && root >= 0))
        return false;
    double share = (sqrt(root) - half) / l;
    *at = (struct tri_point){c.x + share * x, c.y + share * y};
    return share >= 0 && share <= 1;
}

/* Sets the disk whose boundary passes through a and b. height: of its top over ab, in units of the length of ab. */
static void set_disk(struct petal *petal, double height)
{
    double centre = 0.5 * (height - 0.25 / height);
    petal->o.x = 0.5 * petal->b.x - centre * petal->b.y;
    petal->o.y = 0.5 * petal->b.y + centre * petal->b.x;
    petal->r2 = petal->o.x * petal->o.x + petal->o.y * petal->o.y;
}

/* Follows an edge of the diagram to the next triangle. Returns that triangle if it lies inside the fence and its
 * circumcentre *d inside the petal; otherwise TRI_NONE. */
static tri_triangle_id follow_voronoi(struct petal *petal, const struct tri_fence *fence, const struct pending *edge,
                              struct tri_point *d)
{
    const struct tri_mesh *mesh = petal->mesh;
    tri_halfedge across = *tri_link_at(mesh, edge->code);
    tri_vertex_id apex = tri_apex(mesh, across), beside = mesh->tri[tri_of(across)].v[tri_next[tri_edge(across)]];
    if ((fence && !tri_fence_holds(fence, mesh->xy[apex])) || !circumcentre(petal, tri_of(across), d))
        return TRI_NONE;
    struct tri_point at = *d;
    bool inside = is_in_disk(petal, *d);
    if (inside || leave_disk(petal, edge->c, *d, &at))
        consider_point(petal, at, beside);
    return inside && is_above(petal, *d) ? tri_of(across) : TRI_NONE;
}

/* Searches the diagram from triangle t, whose circumcentre c lies in the petal. The edge `from` is not crossed.
 * Returns false if the search reached TRI_BEYOND at the edge `beyond`. */
static bool walk_diagram(struct petal *petal, const struct tri_fence *fence, tri_triangle_id t, int from,
                         struct tri_point c, tri_vertex_id beyond[2])
{
    struct pending pending[MOST_PENDING];
    int n = 0;
    for (int walked = 0; t != TRI_NONE && walked < MOST_WALKED; walked++) {
        for (int e = 0; e < 3; e++)
            if (e != from && n < MOST_PENDING)
                pending[n++] = (struct pending){tri_code(t, e), c};
        for (t = TRI_NONE; t == TRI_NONE && n > 0;) {
            const struct pending edge = pending[--n]; /* cppcheck-suppress uninitvar ; n entries are */
            const struct tri_triangle *near = &petal->mesh->tri[tri_of(edge.code)];
            const int e = tri_edge(edge.code);
            if (near->n[e] == TRI_BEYOND) {
                beyond[0] = near->v[tri_next[e]];
                beyond[1] = near->v[tri_prev[e]];
                return false;
            }
            t = near->n[e] >= 0 ? follow_voronoi(petal, fence, &edge, &c) : TRI_NONE;
            from = t == TRI_NONE ? from : tri_edge(near->n[e]);
        }
    }
    return true;
}

enum tri_petal tri_petal_point(const struct tri_mesh *mesh, const struct tri_fence *fence, tri_triangle_id triangle,
                               const struct tri_shape *shape, double height, struct tri_point *p,
                               tri_vertex_id beyond[2])
{
    const struct tri_triangle *t = &mesh->tri[triangle];
    const int s = shape->shortest;
    struct petal petal = {.mesh = mesh, .a = mesh->xy[t->v[tri_next[s]]]};
    struct tri_point c;
    assert(triangle >= 0 && tri_is_live(t) && height > 0.5);
    petal.b = relative(&petal, t->v[tri_prev[s]]);
    set_disk(&petal, height);
    if (!tri_fence_owns(fence, mesh, triangle) || !circumcentre(&petal, triangle, &c) || !is_in_disk(&petal, c))
        return TRI_PETAL_USUAL;
    const double usual2 = c.x * c.x + c.y * c.y;
    petal.best2 = usual2 * TRI_PETAL_GAIN;
    if (!walk_diagram(&petal, fence, triangle, s, c, beyond))
        return TRI_PETAL_BEYOND;
    if (!(petal.best2 > usual2 * TRI_PETAL_GAIN))
        return TRI_PETAL_USUAL;
    *p = (struct tri_point){tri_round_coordinate(petal.a.x + petal.best.x),
                            tri_round_coordinate(petal.a.y + petal.best.y)};
    return TRI_PETAL_BETTER;
}
