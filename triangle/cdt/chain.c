/* Unites chains of subsegments that form one straight segment.
 *
 * A vertex is a joint if exactly two subsegments end there, with equal markers, both on the boundary or both inside,
 * and collinear within rounding. A chain connects two vertices that are not joints, through joints only, or is closed.
 *
 * RULE. A chain becomes one parent if all of its vertices lie within a tolerance of the line through its ends.
 * Otherwise it is cut, recursively, at the vertex with the largest distance from that line (Douglas & Peucker 1973).
 * Distances that differ by at most the tolerance, or by at most half of the largest one if that is less, count as
 * equal: then the lowest vertex number decides. Why: docs/theory.md, chains.
 *
 * INVARIANT. Split points and arranged vertices lie within the tolerance of their lines (split.c, constrain.c). So a
 * refined mesh gets its parents back, and with them its corners, narrow gaps and sizes.
 *
 * COST. Beyond DEEP nested cuts chains are halved, so n vertices cost at most n * (DEEP + log2(n)). */
#include "triangle/cdt/reconstruct.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/cdt/crossing.h"
#include "triangle/tunables.h"

enum { MANY = -2, DEEP = 32 };

struct chains {
    struct tri_mesh *mesh;
    tri_sub_id *at; /* [n_vertices][2] subsegments that end at each; TRI_NONE: none; [0] == MANY: more than two */
    bool *seen;     /* [n_subs] whether the subsegment has been added to a chain */
    /* The current chain: from vertex[0] by sub[0] to vertex[1], and so on to vertex[n]. */
    tri_vertex_id *vertex; /* [n_subs + 1] */
    tri_sub_id *sub;       /* [n_subs] */
    int32_t n;
};

static void list_ends(struct chains *c)
{
    const struct tri_mesh *mesh = c->mesh;
    for (size_t i = 0; i < 2 * (size_t)mesh->n_vertices; i++)
        c->at[i] = TRI_NONE;
    for (tri_sub_id s = 0; s < mesh->n_subs; s++)
        for (int k = 0; k < 2; k++) {
            tri_sub_id *at = &c->at[2 * (size_t)mesh->sub[s].v[k]];
            at[at[0] == TRI_NONE ? 0 : 1] = at[1] == TRI_NONE ? s : MANY;
        }
}

static tri_vertex_id other_end(const struct tri_mesh *mesh, tri_sub_id s, tri_vertex_id v)
{
    return mesh->sub[s].v[mesh->sub[s].v[0] == v];
}

/* Returns the distance of v from the segment between a and b. */
static double distance_from(const struct tri_mesh *mesh, tri_vertex_id a, tri_vertex_id b, tri_vertex_id v)
{
    struct tri_point p = mesh->xy[a], q = mesh->xy[b], at = mesh->xy[v];
    double dot = (p.x - at.x) * (q.x - at.x) + (p.y - at.y) * (q.y - at.y);
    return dot < 0 ? tri_line_distance(p, q, at) : sqrt(fmin(tri_distance2(p, at), tri_distance2(q, at)));
}

static double tolerance(const struct tri_mesh *mesh, tri_vertex_id v)
{
    return TRI_CHAIN_ASTRAY * tri_resolution(mesh->xy[v]);
}

/* Does v lie between a and b, within the tolerance of their line? */
static bool is_between(const struct tri_mesh *mesh, tri_vertex_id a, tri_vertex_id b, tri_vertex_id v)
{
    struct tri_point p = mesh->xy[a], q = mesh->xy[b], at = mesh->xy[v];
    double dot = (p.x - at.x) * (q.x - at.x) + (p.y - at.y) * (q.y - at.y);
    return dot < 0 && tri_line_distance(p, q, at) <= tolerance(mesh, v);
}

static bool is_joint(const struct chains *c, tri_vertex_id v)
{
    const tri_sub_id *at = &c->at[2 * (size_t)v];
    const struct tri_mesh *mesh = c->mesh;
    if (at[0] < 0 || at[1] < 0)
        return false;
    const struct tri_subsegment *a = &mesh->sub[at[0]], *b = &mesh->sub[at[1]];
    return a->marker == b->marker && tri_is_boundary(a) == tri_is_boundary(b) &&
           is_between(mesh, other_end(mesh, at[0], v), other_end(mesh, at[1], v), v);
}

/* Returns the other subsegment at joint v. */
static tri_sub_id other_sub(const struct chains *c, tri_vertex_id v, tri_sub_id s)
{
    const tri_sub_id *at = &c->at[2 * (size_t)v];
    assert((at[0] == s) != (at[1] == s));
    return at[at[0] == s];
}

static void append_sub(struct chains *c, tri_sub_id s)
{
    assert(c->n < c->mesh->n_subs && !c->seen[s]);
    c->seen[s] = true;
    c->sub[c->n] = s;
    c->vertex[c->n + 1] = other_end(c->mesh, s, c->vertex[c->n]);
    c->n++;
}

static void turn_chain(struct chains *c)
{
    for (int32_t i = 0, k = c->n; i < k; i++, k--) {
        tri_vertex_id v = c->vertex[i];
        c->vertex[i] = c->vertex[k];
        c->vertex[k] = v;
    }
    for (int32_t i = 0, k = c->n - 1; i < k; i++, k--) {
        tri_sub_id s = c->sub[i];
        c->sub[i] = c->sub[k];
        c->sub[k] = s;
    }
}

/* Stores the chain that begins at vertex `from` with subsegment s as the current chain, in the direction of s. A closed
 * chain ends at its start. */
static void follow_chain(struct chains *c, tri_sub_id s, tri_vertex_id from)
{
    c->n = 0;
    c->vertex[0] = from;
    append_sub(c, s);
    for (tri_vertex_id v = c->vertex[1]; v != from && is_joint(c, v); v = c->vertex[c->n])
        append_sub(c, other_sub(c, v, c->sub[c->n - 1]));
    if (c->mesh->sub[s].v[0] != from)
        turn_chain(c);
}

/* Returns the index at which the chain from vertex i to vertex k must be cut; 0: it is straight. */
static int32_t find_cut(const struct chains *c, int32_t i, int32_t k)
{
    const struct tri_mesh *mesh = c->mesh;
    const tri_vertex_id *v = c->vertex;
    bool straight = true;
    double most = 0;
    for (int32_t j = i + 1; j < k; j++) {
        straight = straight && is_between(mesh, v[i], v[k], v[j]);
        most = fmax(most, distance_from(mesh, v[i], v[k], v[j]));
    }
    int32_t cut = 0;
    for (int32_t j = i + 1; j < k && !straight; j++) {
        double distance = distance_from(mesh, v[i], v[k], v[j]);
        if (distance >= fmax(0.5 * most, most - tolerance(mesh, v[j])) && (cut == 0 || v[j] < v[cut]))
            cut = j;
    }
    assert(straight == (cut == 0));
    return cut;
}

/* Makes vertices i to k of the chain one parent. All its subsegments get its direction; `reversed` records the original
 * direction of the first one. */
static void unite(const struct chains *c, int32_t i, int32_t k)
{
    struct tri_mesh *mesh = c->mesh;
    tri_parent_id parent = mesh->sub[c->sub[i]].parent;
    mesh->parents[parent].v[0] = c->vertex[i];
    mesh->parents[parent].v[1] = c->vertex[k];
    mesh->parents[parent].guard = mesh->xy[c->vertex[i]];
    mesh->parents[parent].reversed = mesh->sub[c->sub[i]].v[0] != c->vertex[i];
    for (int32_t j = i; j < k; j++) {
        struct tri_subsegment *s = &mesh->sub[c->sub[j]];
        if (s->v[0] != c->vertex[j])
            tri_turn_sub(s);
        s->parent = parent;
        if (j > i)
            mesh->on[c->vertex[j]] = parent;
    }
}

static void unite_straight(const struct chains *c, int32_t i, int32_t k, int depth)
{
    if (k - i == 1)
        return;
    int32_t cut = find_cut(c, i, k);
    if (cut == 0) {
        unite(c, i, k);
        return;
    }
    cut = depth < DEEP ? cut : i + (k - i) / 2;
    unite_straight(c, i, cut, depth + 1);
    unite_straight(c, cut, k, depth + 1);
}

/* Removes parents without subsegments and renumbers the others. */
static void number_parents(struct tri_mesh *mesh, tri_parent_id *number)
{
    tri_parent_id n = 0;
    for (tri_parent_id p = 0; p < mesh->n_parents; p++)
        number[p] = TRI_NONE;
    for (tri_sub_id s = 0; s < mesh->n_subs; s++) {
        assert(mesh->sub[s].parent >= 0 && mesh->sub[s].parent < mesh->n_parents);
        number[mesh->sub[s].parent] = 0;
    }
    for (tri_parent_id p = 0; p < mesh->n_parents; p++)
        if (number[p] != TRI_NONE) {
            mesh->parents[n] = mesh->parents[p];
            number[p] = n++;
        }
    mesh->n_parents = n;
    for (tri_sub_id s = 0; s < mesh->n_subs; s++)
        mesh->sub[s].parent = number[mesh->sub[s].parent];
    for (tri_vertex_id v = 0; v < mesh->n_vertices; v++) {
        assert(mesh->on[v] < 0 || number[mesh->on[v]] != TRI_NONE);
        mesh->on[v] = mesh->on[v] >= 0 ? number[mesh->on[v]] : mesh->on[v];
    }
}

static void unite_all(struct chains *c)
{
    struct tri_mesh *mesh = c->mesh;
    for (tri_sub_id s = 0; s < mesh->n_subs; s++)
        for (int k = 0; k < 2; k++)
            if (!c->seen[s] && !is_joint(c, mesh->sub[s].v[k])) {
                follow_chain(c, s, mesh->sub[s].v[k]);
                unite_straight(c, 0, c->n, 0);
            }
    for (tri_sub_id s = 0; s < mesh->n_subs; s++)
        if (!c->seen[s]) { /* closed chain */
            follow_chain(c, s, mesh->sub[s].v[0]);
            unite_straight(c, 0, c->n, 0);
        }
}

enum tri_status tri_unite_chains(struct tri_mesh *mesh, struct tri_error *error)
{
    size_t n = (size_t)mesh->n_subs;
    struct chains c = {.mesh = mesh,
                       .at = malloc(2 * (size_t)mesh->n_vertices * sizeof *c.at + 1),
                       .seen = calloc(n + 1, sizeof *c.seen),
                       .vertex = malloc((n + 1) * sizeof *c.vertex),
                       .sub = malloc(n * sizeof *c.sub + 1)};
    tri_parent_id *number = malloc((size_t)mesh->n_parents * sizeof *number + 1);
    bool done = c.at && c.seen && c.vertex && c.sub && number;
    if (done) {
        list_ends(&c);
        unite_all(&c);
        number_parents(mesh, number);
    }
    free(number);
    free(c.sub);
    free(c.vertex);
    free(c.seen);
    free(c.at);
    return done ? TRI_OK : tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for %d segments", (int)mesh->n_subs);
}
