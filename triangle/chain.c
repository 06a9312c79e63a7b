/* Subsegments that are one straight segment.
 *
 * A vertex is a joint where exactly two subsegments end, of one marker and both on the boundary or both inside, and run
 * on as far as rounding tells. Between two vertices that are none lies a chain of joints. It becomes one parent where
 * all of it keeps to the line between its ends: one joint after the other might go round a curve.
 *
 * The tolerance is what split points and arranged vertices may be off their lines (split.c, constrain.c), so the
 * parents of a refined mesh come back: with them its corners (small_angle.h), narrow spaces and sizes are what they
 * were when it was made, and whatever was given up then is given up again. */
#include "triangle/chain.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/crossing.h"

/* In resolutions. */
static const double ASTRAY = 8;

enum { MANY = -2 };

struct chains {
    struct tri_mesh *mesh;
    tri_sub_id *at; /* [n_vertices][2] the subsegments that end at each; TRI_NONE: none; first MANY: more than two */
};

/* One of them: from a vertex to another, the subsegments at these. */
struct chain {
    tri_sub_id first, last;
    tri_vertex_id from, to;
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

/* Does v lie between a and b on their line? */
static bool is_between(const struct tri_mesh *mesh, tri_vertex_id a, tri_vertex_id b, tri_vertex_id v)
{
    struct tri_point p = mesh->xy[a], q = mesh->xy[b], at = mesh->xy[v];
    double dot = (p.x - at.x) * (q.x - at.x) + (p.y - at.y) * (q.y - at.y);
    return dot < 0 && tri_line_distance(p, q, at) <= ASTRAY * tri_resolution(at);
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

/* The subsegment behind joint v for who comes by s. */
static tri_sub_id beyond(const struct chains *c, tri_vertex_id v, tri_sub_id s)
{
    const tri_sub_id *at = &c->at[2 * (size_t)v];
    assert((at[0] == s) != (at[1] == s));
    return at[at[0] == s];
}

/* The chain that starts or ends with subsegment s at a vertex, and runs its way. */
static struct chain follow(const struct chains *c, tri_sub_id s, tri_vertex_id from)
{
    struct chain chain = {s, s, from, other_end(c->mesh, s, from)};
    while (is_joint(c, chain.to)) {
        chain.last = beyond(c, chain.to, chain.last);
        chain.to = other_end(c->mesh, chain.last, chain.to);
    }
    if (c->mesh->sub[s].v[0] == from)
        return chain;
    return (struct chain){chain.last, chain.first, chain.to, chain.from};
}

static bool is_straight(const struct chains *c, const struct chain *chain)
{
    tri_sub_id s = chain->first;
    tri_vertex_id v = other_end(c->mesh, s, chain->from);
    for (; v != chain->to; v = other_end(c->mesh, s, v)) {
        if (!is_between(c->mesh, chain->from, chain->to, v))
            return false;
        s = beyond(c, v, s);
    }
    return true;
}

/* All subsegments of a parent run its way. */
static void turn(struct tri_subsegment *s)
{
    tri_vertex_id v = s->v[0];
    tri_halfedge side = s->side[0];
    s->v[0] = s->v[1];
    s->v[1] = v;
    s->side[0] = s->side[1];
    s->side[1] = side;
}

static void unite(const struct chains *c, const struct chain *chain)
{
    struct tri_mesh *mesh = c->mesh;
    tri_sub_id s = chain->first;
    tri_vertex_id v = chain->from;
    tri_parent_id parent = mesh->sub[s].parent;
    mesh->parents[parent].v[0] = chain->from;
    mesh->parents[parent].v[1] = chain->to;
    mesh->parents[parent].guard = mesh->xy[chain->from];
    for (;;) {
        if (mesh->sub[s].v[0] != v)
            turn(&mesh->sub[s]);
        mesh->sub[s].parent = parent;
        v = mesh->sub[s].v[1];
        if (v == chain->to)
            return;
        mesh->on[v] = parent;
        s = beyond(c, v, s);
    }
}

/* Parents without a subsegment go. */
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
        for (int k = 0; k < 2; k++) {
            tri_vertex_id from = mesh->sub[s].v[k], next = mesh->sub[s].v[1 - k];
            if (is_joint(c, from) || !is_joint(c, next) || mesh->on[next] >= 0)
                continue; /* in the middle of a chain, none, or done */
            struct chain chain = follow(c, s, from);
            if (is_straight(c, &chain))
                unite(c, &chain);
        }
}

enum tri_status tri_unite_chains(struct tri_mesh *mesh, struct tri_error *error)
{
    size_t n = 2 * (size_t)mesh->n_vertices;
    struct chains c = {mesh, malloc(n * sizeof *c.at + 1)};
    tri_parent_id *number = malloc((size_t)mesh->n_parents * sizeof *number + 1);
    if (c.at && number) {
        list_ends(&c);
        unite_all(&c);
        number_parents(mesh, number);
    }
    bool done = c.at && number;
    free(number);
    free(c.at);
    return done ? TRI_OK : tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for %d segments", (int)mesh->n_subs);
}
