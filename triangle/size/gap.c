/* Narrow gaps between two segments, and the decision which of them are filled. */
#include "triangle/size/gap.h"

#include <assert.h>

#include "triangle/mesh/parents.h"
#include "triangle/tunables.h"

/* Approximates the integral of 1 / width along the shorter segment. If the width grows by at most itself, this is
 * about length / width. Otherwise each octave of width needs about length / spread. Unresolved widths are replaced
 * by the smallest resolved width. */
double tri_filling_cost(const struct tri_mesh *mesh, tri_parent_id first, tri_parent_id second, struct tri_point u,
                        struct tri_point v)
{
    assert(first != second);
    const struct tri_parent *p = &mesh->parents[first], *q = &mesh->parents[second];
    struct tri_point a = mesh->xy[p->v[0]], b = mesh->xy[p->v[1]], c = mesh->xy[q->v[0]], d = mesh->xy[q->v[1]];
    double px = b.x - a.x, py = b.y - a.y, qx = d.x - c.x, qy = d.y - c.y;
    double lp = px * px + py * py, lq = qx * qx + qy * qy, cross = fabs(px * qy - py * qx);
    double shorter = sqrt(lp < lq ? lp : lq), longer = sqrt(lp < lq ? lq : lp);
    double width = fabs(px * (v.y - u.y) - py * (v.x - u.x)) / sqrt(lp), spread = cross / longer;
    width = fmax(width, sqrt(mesh->limits.shortest2));
    return spread <= width ? shorter / width : shorter / spread * tri_rough_log2(1 + spread / width);
}

bool tri_is_filled(const struct tri_mesh *mesh, tri_parent_id first, tri_parent_id second, struct tri_point u,
                   struct tri_point v)
{
    if (first == second)
        return false;
    enum tri_corner corner = tri_corner_between(mesh, first, second);
    if (corner != TRI_APART)
        return corner == TRI_NARROW_CORNER;
    return tri_filling_cost(mesh, first, second, u, v) <= mesh->limits.costliest_gap;
}

/* Returns the cost of the most expensive gap between the parent, which passes through u, and a parent that bounds
 * triangle v, u, w at v. */
static double costliest_across(const struct tri_mesh *mesh, tri_parent_id parent, tri_vertex_id u, tri_vertex_id w,
                             tri_vertex_id v, bool apart)
{
    int32_t n;
    double cost = 0;
    tri_parent_id listed[8];
    const tri_parent_id *at = tri_parents_beside(mesh, v, u, w, listed, &n);
    for (int32_t i = 0; i < n; i++)
        if (at[i] != parent && (!apart || tri_corner_between(mesh, parent, at[i]) == TRI_APART))
            cost = fmax(cost, tri_filling_cost(mesh, parent, at[i], mesh->xy[u], mesh->xy[v]));
    return cost;
}

double tri_gap_across(const struct tri_mesh *mesh, tri_parent_id parent, tri_vertex_id u, tri_vertex_id v)
{
    const double cost = costliest_across(mesh, parent, u, u, v, true);
    return cost > mesh->limits.costliest_gap ? cost : 0;
}

bool tri_lines_gap(const struct tri_mesh *mesh, tri_parent_id p, tri_vertex_id v)
{
    const tri_vertex_id *end = mesh->parents[p].v;
    return costliest_across(mesh, p, end[0], end[1], v, false) > mesh->limits.costliest_gap;
}

static bool is_end(const struct tri_parent *p, tri_vertex_id v) { return p->v[0] == v || p->v[1] == v; }

/* Does q project onto the parent, rather than before its start or beyond its end? */
static bool is_beside(const struct tri_mesh *mesh, const struct tri_parent *p, tri_vertex_id q)
{
    struct tri_point a = mesh->xy[p->v[0]], b = mesh->xy[p->v[1]], at = mesh->xy[q];
    double x = b.x - a.x, y = b.y - a.y, along = x * (at.x - a.x) + y * (at.y - a.y);
    return along >= 0 && along <= x * x + y * y;
}

/* Does triangle u, v, w lie on one side of the parent through u? In the parent's interior it always does, since
 * triangles cross no segment. At the parent's end u, the triangle may lie beyond the end, or around it with v and w
 * on different sides, so that it only touches the gap with its corner. Points closer to the parent's line than the
 * shortest edge count as on it, because rounded split points lie beside it. w == u or w == v: no triangle is tested. */
static bool lies_aside(const struct tri_mesh *mesh, const struct tri_parent *p, tri_vertex_id u, tri_vertex_id v,
                       tri_vertex_id w)
{
    if (!is_end(p, u) || w == u || w == v)
        return true;
    struct tri_point o = mesh->xy[u], far = mesh->xy[p->v[p->v[0] == u]], a = mesh->xy[v], b = mesh->xy[w];
    double x = far.x - o.x, y = far.y - o.y, near2 = mesh->limits.shortest2 * (x * x + y * y);
    double left = x * (a.y - o.y) - y * (a.x - o.x), right = x * (b.y - o.y) - y * (b.x - o.x);
    bool goes_round = (left > 0) != (right > 0) && left * left > near2 && right * right > near2;
    return x * (b.x - o.x) + y * (b.y - o.y) > 0 && !goes_round;
}

/* What an edge bridges: the cost of the most expensive gap (0: none), and whether one of the gaps is a spike. */
struct gap {
    double cost; /* of the most expensive gap; 0: none */
    bool spike;  /* true: one of the gaps is a spike */
};

/* Does filling any gap between p and another parent that edge uv bridges cost less than this? If it returns true,
 * this is certain; false may be wrong. Uses the formula of tri_filling_cost with the shorter segment no longer than
 * p, and log2(1 + x) < 1.5 x. */
static bool is_cheaper(const struct tri_mesh *mesh, const struct tri_parent *p, tri_vertex_id u, tri_vertex_id v,
                       double cost)
{
    const struct tri_point a = mesh->xy[p->v[0]], b = mesh->xy[p->v[1]], from = mesh->xy[u], to = mesh->xy[v];
    double x = b.x - a.x, y = b.y - a.y;
    return 2 * (x * x + y * y) < cost * fabs(x * (to.y - from.y) - y * (to.x - from.x));
}

/* Returns the gaps between two parents that edge uv bridges and that contain the triangle with apex w, or (w == v)
 * all gaps that it bridges. Gaps with a cost below `least` may be omitted. */
static struct gap gap_between(const struct tri_mesh *mesh, tri_vertex_id u, tri_vertex_id v, tri_vertex_id w,
                              double least)
{
    int32_t nu, nv;
    tri_parent_id beside[2][8];
    struct gap gap = {0, false};
    const tri_parent_id *pu = tri_parents_beside(mesh, u, v, w, beside[0], &nu);
    if (nu == 0)
        return gap;
    const tri_parent_id *pv = tri_parents_beside(mesh, v, u, w, beside[1], &nv);
    for (int32_t i = 0; i < nu; i++) {
        const struct tri_parent *p = &mesh->parents[pu[i]];
        if (is_end(p, v) || is_cheaper(mesh, p, u, v, least))
            continue;
        for (int32_t k = 0; k < nv; k++) {
            const struct tri_parent *q = &mesh->parents[pv[k]];
            if (pu[i] == pv[k] || is_end(q, u) || !lies_aside(mesh, p, u, v, w) || !lies_aside(mesh, q, v, u, w))
                continue;
            if (!is_beside(mesh, p, v) && !is_beside(mesh, q, u))
                continue; /* one lies behind the other, as in a smooth curve */
            double cost = tri_filling_cost(mesh, pu[i], pv[k], mesh->xy[u], mesh->xy[v]);
            gap.cost = cost > gap.cost ? cost : gap.cost;
            gap.spike |= tri_corner_between(mesh, pu[i], pv[k]) == TRI_SPIKE;
        }
    }
    return gap;
}

static struct gap gap_at(const struct tri_mesh *mesh, tri_triangle_id triangle, const struct tri_shape *shape,
                         double least)
{
    const tri_vertex_id *v = mesh->tri[triangle].v;
    int k = shape->shortest;
    return gap_between(mesh, v[tri_next[k]], v[tri_prev[k]], v[k], least);
}

double tri_gap_cost(const struct tri_mesh *mesh, tri_triangle_id triangle, const struct tri_shape *shape)
{
    return gap_at(mesh, triangle, shape, 0).cost;
}

bool tri_bridges_spike(const struct tri_mesh *mesh, tri_triangle_id triangle, const struct tri_shape *shape)
{
    return gap_at(mesh, triangle, shape, 0).spike;
}

bool tri_spans_gap(const struct tri_mesh *mesh, tri_vertex_id u, tri_vertex_id v)
{
    return gap_between(mesh, u, v, v, mesh->limits.costliest_gap).cost > mesh->limits.costliest_gap;
}

bool tri_is_narrow_gap(const struct tri_mesh *mesh, tri_triangle_id triangle, const struct tri_shape *shape)
{
    const tri_vertex_id *v = mesh->tri[triangle].v;
    const int k = shape->shortest;
    return tri_spans_gap(mesh, v[tri_next[k]], v[tri_prev[k]]) || tri_bridges_spike(mesh, triangle, shape);
}

enum { OCTAVES = 64 };

/* Returns the approximate number of points needed to fill the gap that contains a triangle of the input, if it is
 * expensive. If other vertices lie between the gap's two sides, for example at its closed end, no edge bridges it.
 * Therefore the pairs of apexes on both sides of each edge are tested as well. */
static double demand_of(const struct tri_mesh *mesh, tri_triangle_id triangle)
{
    const double LEAST = 1 << TRI_CHEAP_GAP;
    const struct tri_triangle *t = &mesh->tri[triangle];
    if (!tri_is_on_parent(mesh, t->v[0]) && !tri_is_on_parent(mesh, t->v[1]) && !tri_is_on_parent(mesh, t->v[2]))
        return 0;
    struct tri_shape shape = tri_shape_of(mesh->xy, t->v);
    double demand = gap_at(mesh, triangle, &shape, LEAST).cost;
    for (int e = 0; e < 3; e++) {
        if (t->n[e] < 0 || !tri_is_on_parent(mesh, t->v[e]))
            continue;
        tri_vertex_id apex = tri_apex(mesh, t->n[e]);
        for (int end = 1; end < 3; end++)
            demand = tri_larger(demand, gap_between(mesh, t->v[e], apex, t->v[(e + end) % 3], LEAST).cost);
    }
    return demand;
}

/* Returns the octave with 2^(octave - 1) <= cost < 2^octave, limited to the last one. */
static int octave_of(double cost)
{
    int octave;
    frexp(cost, &octave);
    return octave < OCTAVES ? octave : OCTAVES - 1;
}

/* Sums over the expensive triangles in one share of the mesh, by octave of their cost. */
struct demand {
    double cost[OCTAVES], count[OCTAVES]; /* sum of costs; number of triangles */
};

struct demands {
    const struct tri_mesh *mesh;          /* borrowed */
    struct demand share[TRI_MOST_SHARES]; /* summed in this order, so the result does not depend on the number of
                                             threads */
};

static void demand_share(void *context, size_t index)
{
    struct demands *d = context;
    struct demand *sum = &d->share[index];
    struct tri_range range = tri_share(index, d->mesh->n_triangles);
    *sum = (struct demand){{0}, {0}};
    for (tri_triangle_id t = range.first; t < range.last; t++) {
        double cost = demand_of(d->mesh, t);
        int octave = octave_of(cost);
        if (octave > TRI_CHEAP_GAP) {
            sum->cost[octave] += cost;
            sum->count[octave]++;
        }
    }
}

static struct demand whole_demand(const struct tri_mesh *mesh, const struct tri_executor *executor)
{
    struct demands d; /* each task clears its own share, since clearing all would take too long for a small mesh */
    d.mesh = mesh;
    tri_execute(executor, tri_shares(mesh->n_triangles), demand_share, &d);
    for (size_t i = 1; i < tri_shares(mesh->n_triangles); i++)
        for (int octave = 0; octave < OCTAVES; octave++) {
            d.share[0].cost[octave] += d.share[i].cost[octave];
            d.share[0].count[octave] += d.share[i].count[octave];
        }
    return d.share[0];
}

/* Decides by cost which narrow gaps are filled.
 *
 * The demand counts a gap once for every triangle in it. If the total demand is at most TRI_ALL_GAPS, every gap is
 * filled: these are thin layers and slits of ordinary parts. Otherwise there are spikes of nearly zero width, or
 * lines a few ulps apart, and only cheap gaps are filled. The cost limit is the largest power of two, at least
 * 2^TRI_CHEAP_GAP, for which filling every gap up to this cost takes at most TRI_GAP_ALLOWANCE points plus
 * TRI_GAP_PER_VERTEX for each input vertex (or each segment end, if these are fewer). A more expensive gap is still
 * filled in its wide part. Vertices inside a gap may hide it from this estimate. In any case no gap takes more
 * points than limits.gap_points. */
void tri_choose_gaps(struct tri_mesh *mesh, const struct tri_executor *executor)
{
    const struct demand demand = whole_demand(mesh, executor);
    const double affordable = TRI_GAP_ALLOWANCE + TRI_GAP_PER_VERTEX * fmin(mesh->n_input, 2.0 * mesh->n_parents);
    double all = 0, costlier = 0, cheaper = 0;
    int limit = octave_of(affordable);
    for (int octave = TRI_CHEAP_GAP + 1; octave < OCTAVES; octave++) {
        all += demand.cost[octave];
        costlier += demand.count[octave];
        limit = demand.count[octave] > 0 && octave > limit ? octave : limit;
    }
    mesh->limits.gap_points = all <= TRI_ALL_GAPS ? all : affordable;
    limit = all <= TRI_ALL_GAPS ? limit : TRI_CHEAP_GAP;
    for (int octave = TRI_CHEAP_GAP + 1; octave < OCTAVES && all > TRI_ALL_GAPS; octave++) {
        cheaper += demand.cost[octave];
        costlier -= demand.count[octave];
        if (cheaper + ldexp(costlier, octave) > affordable)
            break;
        limit = octave;
    }
    assert(limit >= TRI_CHEAP_GAP && limit <= OCTAVES);
    mesh->limits.costliest_gap = ldexp(1, limit);
}
