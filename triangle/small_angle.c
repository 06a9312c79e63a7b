/* Rules that make refinement end on any PSLG.
 *
 * 1. Input angle: the smallest angle lies between two subsegments, and the other two satisfy the bound or ... */
#include "triangle/small_angle.h"

#include <stdlib.h>

#include "triangle/predicates.h"
#include "triangle/refine.h"

static const double NARROW = 1e4;

struct tri_resolution tri_resolution_of(const struct tri_mesh *mesh)
{
    double size = 0;
    for (int32_t v = 0; v < mesh->n_input; v++) {
        size = fabs(mesh->xy[v].x) > size ? fabs(mesh->xy[v].x) : size;
        size = fabs(mesh->xy[v].y) > size ? fabs(mesh->xy[v].y) : size;
    }
    double shortest = size * 0x1p-45;
    return (struct tri_resolution){shortest * shortest};
}

static bool is_acute(const struct tri_mesh *mesh, int32_t v) { return mesh->on[v] == TRI_VERTEX_ACUTE; }

static double squared(struct tri_point a, struct tri_point b)
{
    double x = b.x - a.x, y = b.y - a.y;
    return x * x + y * y;
}

double tri_split_fraction(const struct tri_mesh *mesh, const struct tri_subsegment *s)
{
    bool at_start = is_acute(mesh, s->v[0]), at_end = is_acute(mesh, s->v[1]);
    if (!at_start && !at_end)
        return 0.5;
    double length = sqrt(squared(mesh->xy[s->v[0]], mesh->xy[s->v[1]]));
    int exponent;
    double mantissa = frexp(0.5 * length, &exponent); /* half the length is mantissa * 2^exponent, mantissa in [0.5, 1) */
    double shell = ldexp(mantissa < 0.70710678118654752 ? 0.5 : 1, exponent);
    return at_start ? shell / length : 1 - shell / length;
}

bool tri_can_split(const struct tri_resolution *resolution, struct tri_point a, struct tri_point b)
{
    return squared(a, b) > 4 * resolution->shortest2;
}

/* Both on subsegments of segments that meet at a common vertex, at the same distance from it? Then their distance is
 * dictated by the angle there (Miller, Pav & Walkington 2003). */
static bool on_one_shell(const struct tri_mesh *mesh, int32_t u, int32_t v)
{
    int32_t pu = mesh->on[u], pv = mesh->on[v];
    if (pu < 0 || pv < 0 || pu == pv)
        return false;
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 2; k++)
            if (mesh->parents[pu].v[i] == mesh->parents[pv].v[k]) {
                struct tri_point o = mesh->xy[mesh->parents[pu].v[i]];
                double du = squared(o, mesh->xy[u]), dv = squared(o, mesh->xy[v]);
                if (du < 1.001 * dv && dv < 1.001 * du)
                    return true;
            }
    return false;
}

/* The parents that vertex v lies on: its own, or those that end there. */
static const int32_t *parents_of(const struct tri_mesh *mesh, int32_t v, int32_t *n)
{
    *n = 0;
    if (mesh->on[v] >= 0) {
        *n = 1;
        return &mesh->on[v];
    }
    if (v >= mesh->n_hubs)
        return NULL;
    *n = mesh->spoke_start[v + 1] - mesh->spoke_start[v];
    return mesh->spokes + mesh->spoke_start[v];
}

/* Do the two parents run within 1 in 50 of the same direction, and are both longer than `long2` squared? */
static bool is_channel(const struct tri_mesh *mesh, const struct tri_parent *p, const struct tri_parent *q, double long2)
{
    struct tri_point a = mesh->xy[p->v[0]], b = mesh->xy[p->v[1]], c = mesh->xy[q->v[0]], d = mesh->xy[q->v[1]];
    double px = b.x - a.x, py = b.y - a.y, qx = d.x - c.x, qy = d.y - c.y;
    double lp = px * px + py * py, lq = qx * qx + qy * qy, cross = px * qy - py * qx;
    return lp > long2 && lq > long2 && cross * cross < 4e-4 * lp * lq;
}

/* Does the edge uv bridge a channel: two parents of nearly one direction, NARROW times as long as it or more? */
static bool bridges_channel(const struct tri_mesh *mesh, int32_t u, int32_t v, double uv2)
{
    int32_t nu, nv;
    const int32_t *pu = parents_of(mesh, u, &nu), *pv = parents_of(mesh, v, &nv);
    for (int32_t i = 0; i < nu; i++)
        for (int32_t k = 0; k < nv; k++)
            if (pu[i] != pv[k] && is_channel(mesh, &mesh->parents[pu[i]], &mesh->parents[pv[k]], NARROW * NARROW * uv2))
                return true;
    return false;
}

bool tri_is_hopeless(const struct tri_mesh *mesh, const struct tri_resolution *resolution, int32_t slot,
                     const struct tri_shape *shape)
{
    const struct tri_triangle *t = &mesh->tri[slot];
    int k = shape->shortest;
    int32_t u = t->v[tri_next[k]], v = t->v[tri_prev[k]];
    if (shape->l[k] < resolution->shortest2)
        return true;
    return on_one_shell(mesh, u, v) || bridges_channel(mesh, u, v, shape->l[k]);
}

static bool is_input(int32_t on) { return on == TRI_VERTEX_INPUT || on == TRI_VERTEX_ACUTE; }

/* The subsegment that comes next counter-clockwise after subsegment s around its end k, inside the mesh; TRI_NONE where the
 * outside comes first. */
static int32_t next_around(const struct tri_mesh *mesh, int32_t s, int k)
{
    int32_t code = mesh->sub[s].side[k];
    while (code != TRI_NONE) { /* edge `code` starts at the vertex, counter-clockwise in its triangle */
        int32_t link = mesh->tri[tri_of(code)].n[tri_prev[tri_edge(code)]];
        if (link < 0)
            return ~link;
        code = tri_code(tri_of(link), tri_edge(link));
    }
    return TRI_NONE;
}

static void find_acute(struct tri_mesh *mesh)
{
    for (int32_t s = 0; s < mesh->n_subs; s++)
        for (int k = 0; k < 2; k++) {
            int32_t v = mesh->sub[s].v[k];
            int32_t other = is_input(mesh->on[v]) ? next_around(mesh, s, k) : TRI_NONE;
            if (other == TRI_NONE || other == s)
                continue;
            struct tri_point o = mesh->xy[v], a = mesh->xy[mesh->sub[s].v[1 - k]];
            struct tri_point b = mesh->xy[mesh->sub[other].v[mesh->sub[other].v[0] == v]];
            double ax = a.x - o.x, ay = a.y - o.y, bx = b.x - o.x, by = b.y - o.y;
            double dot = ax * bx + ay * by, cross = ax * by - ay * bx;
            if (dot > 0 && cross > 0 && 4 * dot * dot > (ax * ax + ay * ay) * (bx * bx + by * by))
                mesh->on[v] = TRI_VERTEX_ACUTE;
        }
}

static enum tri_status list_spokes(struct tri_mesh *mesh, struct tri_error *error)
{
    size_t n = (size_t)mesh->n_vertices;
    mesh->spoke_start = calloc(n + 2, sizeof *mesh->spoke_start);
    mesh->spokes = malloc((2 * (size_t)mesh->n_parents + 1) * sizeof *mesh->spokes);
    if (!mesh->spoke_start || !mesh->spokes)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for %d segments", (int)mesh->n_parents);
    int32_t *fill = mesh->spoke_start + 1; /* shifted by one, so that filling leaves the starts in place */
    for (int32_t p = 0; p < mesh->n_parents; p++)
        for (int k = 0; k < 2; k++)
            fill[mesh->parents[p].v[k] + 1]++;
    for (size_t v = 0; v < n; v++)
        fill[v + 1] += fill[v];
    for (int32_t p = 0; p < mesh->n_parents; p++)
        for (int k = 0; k < 2; k++)
            mesh->spokes[fill[mesh->parents[p].v[k]]++] = p;
    mesh->n_hubs = mesh->n_vertices;
    return TRI_OK;
}

enum tri_status tri_refine_prepare(struct tri_mesh *mesh, struct tri_error *error)
{
    find_acute(mesh);
    return list_spokes(mesh, error);
}
