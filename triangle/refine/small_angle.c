/* Rules that make refinement end on any PSLG, beside the order of the loop (refine.c).
 *
 * THEOREM (Chew 1993; Shewchuk 2002; Rand 2011). Refinement with bounds up to 28.6 degrees ends where segments meet at
 * 60 degrees or more. RULE. A triangle stays if its shortest edge is of one of these kinds (docs/theory.md, the rule):
 *   - it joins two segments that meet at an acute vertex, on one of the circles on which they are split (concentric
 *     shells: Ruppert 1995; Miller, Pav & Walkington 2003): the angle of the input dictates its length;
 *   - it joins the sides of a spike, two segments that meet at less than 1 / TRI_SHARP;
 *   - it bridges a space between two segments that would take more points to fill than the mesh can afford, at length /
 *     width each (tri_choose_gaps);
 *   - it, or the triangle's height, is shorter than limits.shortest2 says: rounding;
 *   - it has run away (feature_size.c): above 28.6 degrees points may beget points in ever smaller triangles.
 * Triangles that stay are counted by reason (tri_count_bad). */
#include "triangle/refine/small_angle.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/geometry/predicates.h"
#include "triangle/size/feature_size.h"
#include "triangle/tunables.h"

static bool is_acute(const struct tri_mesh *mesh, tri_vertex_id v) { return mesh->on[v] == TRI_VERTEX_ACUTE; }

double tri_split_fraction(const struct tri_mesh *mesh, const struct tri_subsegment *s)
{
    bool at_start = is_acute(mesh, s->v[0]), at_end = is_acute(mesh, s->v[1]);
    if (!at_start && !at_end)
        return 0.5;
    double length = sqrt(tri_distance2(mesh->xy[s->v[0]], mesh->xy[s->v[1]]));
    int exponent; /* half the length is mantissa * 2^exponent, mantissa in [0.5, 1) */
    double mantissa = frexp(0.5 * length, &exponent);
    double shell = ldexp(mantissa < 0.70710678118654752 ? 0.5 : 1, exponent);
    assert(shell > 0.35 * length && shell < 0.71 * length);
    return at_start ? shell / length : 1 - shell / length;
}

bool tri_can_split(const struct tri_mesh *mesh, struct tri_point a, struct tri_point b)
{
    return tri_distance2(a, b) > 4 * mesh->limits.shortest2;
}

/* The vertex where the parents on which u and v lie meet; TRI_NONE where they do not, or are the same. */
static tri_vertex_id apex_between(const struct tri_mesh *mesh, tri_vertex_id u, tri_vertex_id v)
{
    tri_parent_id pu = mesh->on[u], pv = mesh->on[v];
    for (int i = 0; pu >= 0 && pv >= 0 && pu != pv && i < 2; i++)
        for (int k = 0; k < 2; k++)
            if (mesh->parents[pu].v[i] == mesh->parents[pv].v[k])
                return mesh->parents[pu].v[i];
    return TRI_NONE;
}

/* Do u and v lie on two segments that meet at a vertex, at the same distance from it? Then the angle there dictates how
 * far apart they are (Miller, Pav & Walkington 2003). */
static bool on_one_shell(const struct tri_mesh *mesh, tri_vertex_id u, tri_vertex_id v, double uv2)
{
    tri_vertex_id apex = apex_between(mesh, u, v);
    if (apex == TRI_NONE)
        return false;
    double du = tri_distance2(mesh->xy[apex], mesh->xy[u]), dv = tri_distance2(mesh->xy[apex], mesh->xy[v]);
    return du < 1.002 * dv && dv < 1.002 * du && uv2 < 0.99 * du;
}

/* The angle between the legs oa and ob. */
static enum tri_corner corner_at(struct tri_point o, struct tri_point a, struct tri_point b)
{
    double ax = a.x - o.x, ay = a.y - o.y, bx = b.x - o.x, by = b.y - o.y;
    double dot = ax * bx + ay * by, sine = fabs(ax * by - ay * bx);
    if (!(dot > 0 && 3 * dot * dot > sine * sine))
        return TRI_WIDE_CORNER;
    return TRI_SHARP * sine > dot ? TRI_NARROW_CORNER : TRI_SPIKE;
}

enum tri_corner tri_corner_between(const struct tri_mesh *mesh, tri_parent_id p, tri_parent_id q)
{
    const tri_vertex_id *a = mesh->parents[p].v, *b = mesh->parents[q].v;
    for (int i = 0; p != q && i < 2; i++)
        for (int k = 0; k < 2; k++)
            if (a[i] == b[k])
                return corner_at(mesh->xy[a[i]], mesh->xy[a[1 - i]], mesh->xy[b[1 - k]]);
    return TRI_APART;
}

/* The parents that vertex v lies on: its own, or those that end there. */
static const tri_parent_id *parents_of(const struct tri_mesh *mesh, tri_vertex_id v, int32_t *n)
{
    *n = 0;
    if (mesh->on[v] >= 0) {
        *n = 1;
        return &mesh->on[v];
    }
    if (v >= mesh->incidence.n_vertices)
        return NULL;
    *n = mesh->incidence.start[v + 1] - mesh->incidence.start[v];
    return mesh->incidence.parent + mesh->incidence.start[v];
}

/* Of the n parents at a hub, in order of direction, the two before the direction to q, and the two that come next: one
 * on which q lies, up to rounding, is among them, and those on either side of it. */
static int list_neighbours(const struct tri_mesh *mesh, tri_vertex_id hub, const tri_parent_id *incident, int32_t n,
                           struct tri_point q, tri_parent_id *beside)
{
    assert(n > TRI_MANY_PARENTS);
    int32_t low = 0, high = n;
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (tri_turns_before(mesh->xy[hub], tri_far_end(mesh, incident[middle], hub), q))
            low = middle + 1;
        else
            high = middle;
    }
    for (int k = 0; k < 4; k++)
        beside[k] = incident[(low + n + k - 2) % n];
    return 4;
}

/* The parents at u that bound spaces in which triangle u, v, w may lie: at a hub the next ones around it, else all. */
static const tri_parent_id *parents_beside(const struct tri_mesh *mesh, tri_vertex_id u, tri_vertex_id v,
                                           tri_vertex_id w, tri_parent_id beside[8], int32_t *n)
{
    const tri_parent_id *incident = parents_of(mesh, u, n);
    if (*n <= TRI_MANY_PARENTS)
        return incident;
    int32_t all = *n;
    *n = list_neighbours(mesh, u, incident, all, mesh->xy[v], beside);
    *n += list_neighbours(mesh, u, incident, all, mesh->xy[w], beside + *n);
    return beside;
}

bool tri_is_on_parent(const struct tri_mesh *mesh, tri_vertex_id v)
{
    int32_t n;
    parents_of(mesh, v, &n);
    return n > 0;
}

/* Is there a parent from one vertex to the other? Looks at the shorter of their lists: one may be the hub of a
 * wheel. */
static bool are_joined(const struct tri_mesh *mesh, tri_vertex_id u, tri_vertex_id v)
{
    int32_t nu, nv;
    const tri_parent_id *pu = parents_of(mesh, u, &nu), *pv = parents_of(mesh, v, &nv);
    for (int32_t i = 0; i < (nu < nv ? nu : nv); i++) {
        const tri_vertex_id *ends = mesh->parents[(nu < nv ? pu : pv)[i]].v;
        if ((ends[0] == u && ends[1] == v) || (ends[0] == v && ends[1] == u))
            return true;
    }
    return false;
}

tri_vertex_id tri_common_end(const struct tri_mesh *mesh, tri_parent_id parent, tri_vertex_id v)
{
    const tri_vertex_id *ends = mesh->parents[parent].v;
    const int32_t on = mesh->on[v];
    for (int k = 0; k < 2; k++) {
        const tri_vertex_id *others = on >= 0 ? mesh->parents[on].v : NULL;
        if (others ? others[0] == ends[k] || others[1] == ends[k] : are_joined(mesh, ends[k], v))
            return ends[k];
    }
    return TRI_NONE;
}

/* The integral of 1 / width along the shorter one. If they spread by no more than the width they have, that is about
 * length / width; else each octave of width takes about length / spread. Widths that coordinates do not resolve count
 * as the least one that they do. */
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

bool tri_touches(const struct tri_mesh *mesh, tri_parent_id parent, tri_vertex_id v)
{
    const struct tri_parent *p = &mesh->parents[parent];
    struct tri_relative a = tri_relative(&mesh->xy[p->v[0]], mesh->xy[v]);
    struct tri_relative b = tri_relative(&mesh->xy[p->v[1]], mesh->xy[v]);
    double x = b.x - a.x, y = b.y - a.y, l = x * x + y * y, cross = tri_cross(a, b);
    if (a.l > b.l + l || b.l > a.l + l)
        return tri_lesser(a.l, b.l) < mesh->limits.shortest2;
    return cross * cross < mesh->limits.shortest2 * l;
}

static bool do_touch(const struct tri_mesh *mesh, tri_parent_id p, tri_parent_id q)
{
    const tri_vertex_id *a = mesh->parents[p].v, *b = mesh->parents[q].v;
    return tri_touches(mesh, p, b[0]) || tri_touches(mesh, p, b[1]) || tri_touches(mesh, q, a[0]) ||
           tri_touches(mesh, q, a[1]);
}

/* Do the lines of two parents meet at 60 degrees or more? */
static bool is_wide(const struct tri_mesh *mesh, tri_parent_id p, tri_parent_id q)
{
    const struct tri_point a = mesh->xy[mesh->parents[p].v[0]], b = mesh->xy[mesh->parents[p].v[1]];
    const struct tri_point c = mesh->xy[mesh->parents[q].v[0]], d = mesh->xy[mesh->parents[q].v[1]];
    double px = b.x - a.x, py = b.y - a.y, qx = d.x - c.x, qy = d.y - c.y;
    double dot = px * qx + py * qy, cross = px * qy - py * qx;
    return 3 * dot * dot <= cross * cross;
}

bool tri_is_filled(const struct tri_mesh *mesh, tri_parent_id first, tri_parent_id second, struct tri_point u,
                   struct tri_point v)
{
    if (first == second)
        return false;
    enum tri_corner corner = tri_corner_between(mesh, first, second);
    if (corner != TRI_APART)
        return corner == TRI_NARROW_CORNER;
    if (tri_filling_cost(mesh, first, second, u, v) > mesh->limits.dearest_gap)
        return false;
    return !is_wide(mesh, first, second) || !do_touch(mesh, first, second);
}

static bool is_end(const struct tri_parent *p, tri_vertex_id v) { return p->v[0] == v || p->v[1] == v; }

/* Does q lie beside the parent, rather than before its start or beyond its end? */
static bool is_beside(const struct tri_mesh *mesh, const struct tri_parent *p, tri_vertex_id q)
{
    struct tri_point a = mesh->xy[p->v[0]], b = mesh->xy[p->v[1]], at = mesh->xy[q];
    double x = b.x - a.x, y = b.y - a.y, along = x * (at.x - a.x) + y * (at.y - a.y);
    return along >= 0 && along <= x * x + y * y;
}

/* Does triangle u, v, w lie on one side of the parent through u? Amid the parent it does, since triangles cross none.
 * At an end it may lie behind that end, or go round it with v and w on different sides, so that no more than its corner
 * touches the space on either. What is nearer to the parent's line than an edge may be short counts as on it: split
 * points lie beside it by rounding. */
static bool lies_aside(const struct tri_mesh *mesh, const struct tri_parent *p, tri_vertex_id u, tri_vertex_id v,
                       tri_vertex_id w)
{
    if (!is_end(p, u))
        return true;
    struct tri_point o = mesh->xy[u], far = mesh->xy[p->v[p->v[0] == u]], a = mesh->xy[v], b = mesh->xy[w];
    double x = far.x - o.x, y = far.y - o.y, near2 = mesh->limits.shortest2 * (x * x + y * y);
    double left = x * (a.y - o.y) - y * (a.x - o.x), right = x * (b.y - o.y) - y * (b.x - o.x);
    bool goes_round = (left > 0) != (right > 0) && left * left > near2 && right * right > near2;
    return x * (b.x - o.x) + y * (b.y - o.y) > 0 && !goes_round;
}

/* What an edge bridges: the cost of filling the dearest space, 0 where there is none; is there a spike among them? */
struct gap {
    double cost;
    bool spike;
};

/* Does filling the space between p and another parent, which an edge uv bridges, cost less than this? True only where
 * that is sure at a glance: see tri_filling_cost, where the shorter one is no longer than p and log2(1 + x) < 1.5 x. */
static bool is_cheaper(const struct tri_mesh *mesh, const struct tri_parent *p, tri_vertex_id u, tri_vertex_id v,
                       double cost)
{
    const struct tri_point a = mesh->xy[p->v[0]], b = mesh->xy[p->v[1]], from = mesh->xy[u], to = mesh->xy[v];
    double x = b.x - a.x, y = b.y - a.y;
    return 2 * (x * x + y * y) < cost * fabs(x * (to.y - from.y) - y * (to.x - from.x));
}

/* The spaces between two parents that the edge uv bridges and the triangle with apex w lies in; what costs less than
 * `least` need not be among them. */
static struct gap gap_between(const struct tri_mesh *mesh, tri_vertex_id u, tri_vertex_id v, tri_vertex_id w,
                              double least)
{
    int32_t nu, nv;
    tri_parent_id beside[2][8];
    struct gap gap = {0, false};
    const tri_parent_id *pu = parents_beside(mesh, u, v, w, beside[0], &nu);
    if (nu == 0)
        return gap;
    const tri_parent_id *pv = parents_beside(mesh, v, u, w, beside[1], &nv);
    for (int32_t i = 0; i < nu; i++) {
        const struct tri_parent *p = &mesh->parents[pu[i]];
        if (is_end(p, v) || is_cheaper(mesh, p, u, v, least))
            continue;
        for (int32_t k = 0; k < nv; k++) {
            const struct tri_parent *q = &mesh->parents[pv[k]];
            if (pu[i] == pv[k] || is_end(q, u) || !lies_aside(mesh, p, u, v, w) || !lies_aside(mesh, q, v, u, w))
                continue;
            if (!is_beside(mesh, p, v) && !is_beside(mesh, q, u))
                continue; /* one behind the other, as in a smooth curve */
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

bool tri_is_narrow_gap(const struct tri_mesh *mesh, tri_triangle_id triangle, const struct tri_shape *shape)
{
    struct gap gap = gap_at(mesh, triangle, shape, 0);
    return gap.spike || gap.cost > mesh->limits.dearest_gap;
}

bool tri_crosses_angle(const struct tri_mesh *mesh, tri_triangle_id triangle, const struct tri_shape *shape)
{
    const tri_vertex_id *v = mesh->tri[triangle].v;
    return apex_between(mesh, v[tri_next[shape->shortest]], v[tri_prev[shape->shortest]]) != TRI_NONE;
}

bool tri_is_hopeless(const struct tri_mesh *mesh, tri_triangle_id triangle, const struct tri_shape *shape)
{
    const struct tri_triangle *t = &mesh->tri[triangle];
    int k = shape->shortest;
    tri_vertex_id u = t->v[tri_next[k]], v = t->v[tri_prev[k]];
    return shape->l[k] < mesh->limits.shortest2 || tri_has_run_away(mesh, u, v, shape->l[k]) ||
           on_one_shell(mesh, u, v, shape->l[k]) || tri_is_narrow_gap(mesh, triangle, shape);
}

enum { OCTAVES = 64 };

/* About so many points it takes to fill the space that a triangle of the input lies in, where it is dear. Where other
 * vertices lie between its two sides, as on the one that closes its end, no edge bridges it: so the apexes on the two
 * sides of each edge count, too. */
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

/* 2^(octave - 1) <= cost < 2^octave; beyond the last one, the last one. */
static int octave_of(double cost)
{
    int octave;
    frexp(cost, &octave);
    return octave < OCTAVES ? octave : OCTAVES - 1;
}

/* Costs and numbers of the triangles that are not cheap, by octave of their cost, in a share of the mesh. */
struct demand {
    double cost[OCTAVES], count[OCTAVES];
};

struct demands {
    const struct tri_mesh *mesh;
    struct demand share[TRI_MOST_SHARES]; /* added up in their order: the same for any number of threads */
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
    struct demands d; /* each task clears its own share: all would take longer than a small mesh */
    d.mesh = mesh;
    tri_execute(executor, tri_shares(mesh->n_triangles), demand_share, &d);
    for (size_t i = 1; i < tri_shares(mesh->n_triangles); i++)
        for (int octave = 0; octave < OCTAVES; octave++) {
            d.share[0].cost[octave] += d.share[i].cost[octave];
            d.share[0].count[octave] += d.share[i].count[octave];
        }
    return d.share[0];
}

/* Chooses the narrow spaces that are filled, by their cost.
 *
 * The demand counts a space once for every triangle in it. If all demands come to at most TRI_ALL_GAPS, every space
 * is filled: thin layers and slits of ordinary parts. Else there are spikes of no width, or lines a few units in the
 * last place apart, and the cheap spaces are filled: those up to the largest power of two, 2^TRI_CHEAP_GAP or more,
 * for which filling every space as far as this cost goes takes at most TRI_GAP_ALLOWANCE points and
 * TRI_GAP_PER_VERTEX for each vertex of the input (or each end of a segment if these are fewer). A dearer space is
 * still filled where it is wide. Vertices in a space may hide it here; whether hidden or not, no space takes more
 * points than limits.gap_points. */
void tri_choose_gaps(struct tri_mesh *mesh, const struct tri_executor *executor)
{
    const struct demand demand = whole_demand(mesh, executor);
    const double affordable = TRI_GAP_ALLOWANCE + TRI_GAP_PER_VERTEX * fmin(mesh->n_input, 2.0 * mesh->n_parents);
    double all = 0, dearer = 0, cheaper = 0;
    int limit = octave_of(affordable);
    for (int octave = TRI_CHEAP_GAP + 1; octave < OCTAVES; octave++) {
        all += demand.cost[octave];
        dearer += demand.count[octave];
        limit = demand.count[octave] > 0 && octave > limit ? octave : limit;
    }
    mesh->limits.gap_points = all <= TRI_ALL_GAPS ? all : affordable;
    limit = all <= TRI_ALL_GAPS ? limit : TRI_CHEAP_GAP;
    for (int octave = TRI_CHEAP_GAP + 1; octave < OCTAVES && all > TRI_ALL_GAPS; octave++) {
        cheaper += demand.cost[octave];
        dearer -= demand.count[octave];
        if (cheaper + ldexp(dearer, octave) > affordable)
            break;
        limit = octave;
    }
    assert(limit >= TRI_CHEAP_GAP && limit <= OCTAVES);
    mesh->limits.dearest_gap = ldexp(1, limit);
}
