/* What is lent: rings of triangles around vertices, as far as these are own ones in the boxes of another's blocks. */
#include <assert.h>
#include <stdlib.h>

#include "sched/ranks/ranks.h"

/* Rings around what a block begins with; a new point seldom changes more than some triangles around a bad one. */
enum { RINGS = 3 };

/* The rank that works in a box at a place, this one holding a part; -1: none. */
static int worker_at(const struct par_ranks *r, struct tri_point q)
{
    int32_t block = par_block_here(r, q);
    return r->shift.is_held[block] ? r->shift.worker[block] : -1;
}

static bool tell_of(struct par_talk *talk, tri_triangle_id t)
{
    return par_talk_number(talk, t) != TRI_NONE || par_talk_add_triangle(talk, t);
}

/* An own vertex around which rank w has to know all, with a triangle there, joins the ring. */
static bool join(const struct par_ranks *r, int w, struct par_ids *ring, tri_vertex_id v, tri_triangle_id t)
{
    struct par_map *surrounded = &r->lent[w].surrounded;
    struct tri_point q = r->state->mesh->xy[v];
    if (par_map_get(surrounded, v) != TRI_NONE || !par_is_own(&r->territory, q) || worker_at(r, q) != w)
        return true;
    return par_map_put(surrounded, v, t) && par_ids_add(ring, v);
}

static bool join_corners(const struct par_ranks *r, int w, struct par_ids *ring, tri_triangle_id t)
{
    const tri_vertex_id *v = r->state->mesh->tri[t].v;
    assert(tri_is_live(&r->state->mesh->tri[t]));
    return join(r, w, ring, v[0], t) && join(r, w, ring, v[1], t) && join(r, w, ring, v[2], t);
}

static int corner_at(const struct tri_triangle *t, tri_vertex_id v) { return t->v[0] == v ? 0 : t->v[1] == v ? 1 : 2; }

/* The next triangle around a vertex, to one side or the other; TRI_NONE: there is none. */
static tri_triangle_id turn(const struct tri_mesh *mesh, tri_triangle_id t, tri_vertex_id v, bool left)
{
    int k = corner_at(&mesh->tri[t], v), e = left ? tri_next[k] : tri_prev[k];
    assert(mesh->tri[t].v[k] == v && mesh->tri[t].n[e] != TRI_BEYOND);
    tri_halfedge across = tri_across(mesh, tri_code(t, e));
    return across < 0 ? TRI_NONE : tri_of(across);
}

/* Tells of all triangles around an own vertex, of which `t` is one; their corners join the next ring. */
static bool tell_around(const struct par_ranks *r, int w, tri_vertex_id v, tri_triangle_id t,
                        struct par_ids *next)
{
    const struct tri_mesh *mesh = r->state->mesh;
    tri_triangle_id at = t;
    bool memory = true;
    assert(t != TRI_NONE && par_is_own(&r->territory, mesh->xy[v])); /* so all triangles around it are here */
    do {
        memory = memory && tell_of(&r->lent[w], at) && join_corners(r, w, next, at);
        at = turn(mesh, at, v, true);
    } while (memory && at != TRI_NONE && at != t);
    if (at == t)
        return memory;
    for (at = turn(mesh, t, v, false); memory && at != TRI_NONE; at = turn(mesh, at, v, false))
        memory = tell_of(&r->lent[w], at) && join_corners(r, w, next, at);
    return memory;
}

/* So many rings, the first of which is given. Frees it. */
static bool tell_rings(const struct par_ranks *r, int w, struct par_ids *ring, int32_t rings)
{
    const struct par_map *surrounded = &r->lent[w].surrounded;
    bool memory = true;
    for (int32_t n = 0; memory && n < rings && ring->n > 0; n++) {
        struct par_ids next = {0};
        for (int32_t i = 0; memory && i < ring->n; i++)
            memory = tell_around(r, w, ring->item[i], par_map_get(surrounded, ring->item[i]), &next);
        free(ring->item);
        *ring = next;
    }
    for (int32_t i = 0; memory && i < ring->n; i++) /* around these not all has been told */
        memory = par_map_put(&r->lent[w].surrounded, ring->item[i], TRI_NONE);
    free(ring->item);
    *ring = (struct par_ids){0};
    return memory;
}

/* Whom a straddler concerns: everybody who works in a box that has a corner of it. */
static bool tell_straddlers(const struct par_ranks *r)
{
    const struct tri_mesh *mesh = r->state->mesh;
    bool memory = true;
    for (int32_t i = 0; memory && i < r->straddlers.n; i++)
        for (int k = 0; memory && k < 3; k++) {
            int w = worker_at(r, mesh->xy[mesh->tri[r->straddlers.item[i]].v[k]]);
            memory = w < 0 || tell_of(&r->lent[w], r->straddlers.item[i]);
        }
    return memory;
}

/* The rank that is lent an entry of the worklist, or -1. */
static int taker_of(const struct par_ranks *r, int32_t i)
{
    int32_t block = r->shift.block_of[i];
    return block != TRI_NONE && r->shift.is_held[block] ? r->shift.worker[block] : -1;
}

static bool tell_surroundings(const struct par_ranks *r)
{
    struct par_ids *ring = calloc((size_t)r->carrier->n_ranks, sizeof *ring);
    bool memory = ring;
    for (int32_t i = 0; memory && i < r->state->worklist.n; i++) {
        int w = taker_of(r, i);
        memory = w < 0 || join_corners(r, w, &ring[w], r->state->worklist.item[i]);
    }
    for (int w = 0; ring && w < r->carrier->n_ranks; w++)
        memory = tell_rings(r, w, &ring[w], memory ? RINGS : 0) && memory;
    free(ring);
    return memory;
}

static bool has_corner_of(const struct par_ranks *r, tri_triangle_id t, int rank)
{
    const struct tri_mesh *mesh = r->state->mesh;
    bool has = false;
    for (int k = 0; k < 3; k++)
        has = has || par_owner_at(&r->territory, mesh->xy[mesh->tri[t].v[k]]) == rank;
    return has;
}

/* Who has a corner of its own there has the entry, too. */
static bool lend_entries(struct par_ranks *r, struct par_message *message)
{
    struct par_state *state = r->state;
    bool memory = true, *keep = malloc((size_t)state->worklist.n + 1);
    assert(state->key.n == state->worklist.n);
    for (int32_t i = 0; keep && i < state->worklist.n; i++) {
        int w = taker_of(r, i);
        keep[i] = w < 0;
        if (w >= 0 && !has_corner_of(r, state->worklist.item[i], w))
            memory = memory && par_message_add_entry(&message[w], state->key.item[i],
                                                     par_talk_number(&r->lent[w], state->worklist.item[i]));
    }
    if (keep)
        par_worklist_keep(state, keep);
    memory = memory && keep;
    free(keep);
    return memory;
}

static bool tell_all(struct par_ranks *r, struct par_message *message, const int32_t *first)
{
    bool memory = true;
    for (int w = 0; memory && w < r->carrier->n_ranks; w++)
        memory = par_message_tell(&message[w], &r->lent[w], r->state->mesh, r->n_common, first[w]);
    return memory;
}

static bool write_messages(struct par_ranks *r, struct par_message *message, const int32_t *first)
{
    bool memory = true;
    for (int w = 0; memory && w < r->carrier->n_ranks; w++)
        if (r->lent[w].triangle.n > first[w])
            memory = par_message_write(&message[w], &r->lent[w], r->state->mesh->n_attributes, &r->out[w]);
    return memory;
}

static void free_messages(struct par_message *message, int n)
{
    for (int p = 0; message && p < n; p++)
        par_message_free(&message[p]);
    free(message);
}

enum tri_status par_lend(struct par_ranks *r, struct tri_error *error)
{
    size_t n = (size_t)r->carrier->n_ranks;
    struct par_message *message = calloc(n, sizeof *message);
    int32_t *first = calloc(n, sizeof *first);
    r->rings = RINGS;
    bool memory = message && first && tell_straddlers(r) && tell_surroundings(r) &&
                  tell_all(r, message, first) && lend_entries(r, message) && write_messages(r, message, first);
    free_messages(message, r->carrier->n_ranks);
    free(first);
    return memory ? TRI_OK : par_ranks_no_memory(error);
}

/* --- more */

static bool is_bad_list(const struct par_bytes *bytes, const struct par_talk *talk)
{
    const int32_t *number = (const int32_t *)(const void *)bytes->at;
    bool bad = bytes->n % sizeof *number != 0;
    for (size_t i = 0; !bad && i < bytes->n / sizeof *number; i++)
        bad = number[i] < 0 || number[i] >= talk->vertex.n;
    return bad;
}

/* The vertices that rank w has asked for, with a triangle at each, are the first ring. */
static bool begin_ring(struct par_ranks *r, int w, struct par_ids *ring)
{
    const int32_t *number = (const int32_t *)(const void *)r->in[w].at;
    const struct tri_mesh *mesh = r->state->mesh;
    struct par_talk *talk = &r->lent[w];
    struct par_map wanted = {0};
    bool memory = true;
    for (size_t i = 0; memory && i < r->in[w].n / sizeof *number; i++)
        memory = par_map_put(&wanted, talk->vertex.item[number[i]], 0);
    for (int32_t i = 0, n = talk->triangle.n; memory && i < n; i++) {
        const tri_vertex_id *v = mesh->tri[talk->triangle.item[i]].v;
        for (int k = 0; memory && k < 3; k++)
            if (par_map_get(&wanted, v[k]) != TRI_NONE)
                memory = join(r, w, ring, v[k], talk->triangle.item[i]);
    }
    par_map_free(&wanted);
    return memory;
}

enum tri_status par_lend_more(struct par_ranks *r, struct tri_error *error)
{
    size_t n = (size_t)r->carrier->n_ranks;
    struct par_message *message = calloc(n, sizeof *message);
    int32_t *first = calloc(n, sizeof *first);
    bool memory = message && first, bad = false;
    r->rings *= 2;
    for (int w = 0; memory && w < r->carrier->n_ranks; w++) {
        struct par_ids ring = {0};
        first[w] = r->lent[w].triangle.n;
        bad = bad || is_bad_list(&r->in[w], &r->lent[w]);
        memory = bad || begin_ring(r, w, &ring);
        memory = tell_rings(r, w, &ring, memory ? r->rings : 0) && memory;
    }
    memory = memory && tell_all(r, message, first) && write_messages(r, message, first);
    free_messages(message, r->carrier->n_ranks);
    free(first);
    if (bad)
        return tri_fail(error, TRI_INTERNAL, NULL, 0, "another rank asks for what is not here");
    return memory ? TRI_OK : par_ranks_no_memory(error);
}

/* --- what comes back */

static bool remove_gone(struct par_ranks *r, struct par_talk *talk, const struct par_message *message)
{
    bool memory = true;
    for (int32_t i = 0; memory && i < message->gone.n; i++) {
        tri_triangle_id *t = &talk->triangle.item[message->gone.item[i]];
        memory = par_remove_triangle(r->state, *t);
        *t = TRI_NONE;
    }
    for (int32_t i = 0; memory && i < message->gone_subs.n; i++) {
        tri_sub_id *s = &talk->sub.item[message->gone_subs.item[i]];
        memory = par_remove_sub(r->state, *s);
        *s = TRI_NONE;
    }
    return memory;
}

static bool is_left_alone(const struct tri_subsegment *s) { return s->v[0] != TRI_NONE && par_is_lone(s); }

/* Subsegments beside which others have put what is all theirs. */
static bool remove_lone_subs(struct par_ranks *r, const struct par_talk *talk)
{
    bool memory = true;
    for (int32_t i = 0; memory && i < talk->sub.n; i++)
        if (talk->sub.item[i] != TRI_NONE && is_left_alone(&r->state->mesh->sub[talk->sub.item[i]]))
            memory = par_remove_sub(r->state, talk->sub.item[i]);
    return memory;
}

static void keep_live_straddlers(struct par_ranks *r)
{
    int32_t kept = 0;
    for (int32_t i = 0; i < r->straddlers.n; i++)
        if (tri_is_live(&r->state->mesh->tri[r->straddlers.item[i]]))
            r->straddlers.item[kept++] = r->straddlers.item[i];
    r->straddlers.n = kept;
}

static enum tri_status take_back(struct par_ranks *r, int w, struct tri_error *error)
{
    struct par_talk *talk = &r->lent[w];
    struct par_message message;
    int32_t first = talk->triangle.n;
    enum tri_status status = par_message_read(&message, talk, r->state->mesh, r->n_common, &r->in[w], error);
    bool memory = status || remove_gone(r, talk, &message);
    keep_live_straddlers(r);
    if (!status && memory)
        status = par_paste(r, talk, &message, false, error);
    for (int32_t i = first; !status && memory && i < talk->triangle.n; i++)
        memory = !par_has_foreign(r, talk->triangle.item[i]) ||
                 par_ids_add(&r->straddlers, talk->triangle.item[i]);
    memory = memory && (status || (remove_lone_subs(r, talk) && par_merge_entries(r->state, &message, talk)));
    par_message_free(&message);
    return status || memory ? status : par_ranks_no_memory(error);
}

enum tri_status par_take_back(struct par_ranks *r, struct tri_error *error)
{
    enum tri_status status = par_index_straddlers(r) ? TRI_OK : par_ranks_no_memory(error);
    for (int w = 0; !status && w < r->carrier->n_ranks; w++)
        if (r->in[w].n > 0)
            status = take_back(r, w, error);
    return status;
}
