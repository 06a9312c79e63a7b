/* What is lent: ghost layers around vertices, as far as these are own ones in the boxes of another's blocks. */
#include <assert.h>
#include <stdlib.h>

#include "sched/ranks/ranks.h"
#include "sched/tunables.h"

/* The rank that works in a box at a place, this one holding a part; -1: none. */
static int worker_at(const struct par_ranks *r, struct tri_point q)
{
    const struct par_shift *s = &r->shift;
    return s->worker[s->partition ? par_block_at(s->partition, s->phase, q) : 0];
}

static bool tell_of(struct par_talk *talk, tri_triangle_id t)
{
    return par_talk_number(talk, t) != TRI_NONE || par_talk_add_triangle(talk, t);
}

/* A telling of so many layers to rank w. A layer is own vertices around which it has to know all, as corners: each by a
 * triangle there and which of its corners it is, as a half-edge is by its edge. */
struct telling {
    const struct par_ranks *ranks;
    int w;
    int32_t layers;
};

static tri_vertex_id vertex_at(const struct tri_mesh *mesh, tri_halfedge corner)
{
    return mesh->tri[tri_of(corner)].v[tri_edge(corner)];
}

/* A vertex joins a layer, unless all around it has been told, or is not this rank's to tell. */
static bool join(const struct telling *telling, struct par_ids *layer, tri_halfedge corner)
{
    const struct par_ranks *r = telling->ranks;
    struct par_map *surrounded = &r->lent[telling->w].surrounded;
    tri_vertex_id v = vertex_at(r->run->mesh, corner);
    struct tri_point q = r->run->mesh->xy[v];
    if (par_map_get(surrounded, v) != TRI_NONE || !par_is_own(&r->territory, q) || worker_at(r, q) != telling->w)
        return true;
    return par_map_put(surrounded, v, telling->layers) && par_ids_add(layer, corner);
}

static bool join_corners(const struct telling *telling, struct par_ids *layer, tri_triangle_id t)
{
    assert(tri_is_live(&telling->ranks->run->mesh->tri[t]));
    return join(telling, layer, tri_code(t, 0)) && join(telling, layer, tri_code(t, 1)) &&
           join(telling, layer, tri_code(t, 2));
}

/* The same vertex as a corner of the next triangle around it, to one side or the other; TRI_NONE: there is none. */
static tri_halfedge turn(const struct tri_mesh *mesh, tri_halfedge corner, bool left)
{
    const int *ahead = left ? tri_next : tri_prev;
    tri_halfedge edge = tri_code(tri_of(corner), ahead[tri_edge(corner)]);
    assert(*tri_link_at(mesh, edge) != TRI_BEYOND);
    tri_halfedge across = tri_across(mesh, edge);
    return across < 0 ? TRI_NONE : tri_code(tri_of(across), ahead[tri_edge(across)]);
}

/* Tells of all triangles around an own vertex; their corners join the next layer. */
static bool tell_around(const struct telling *telling, tri_halfedge corner, struct par_ids *next)
{
    const struct par_ranks *r = telling->ranks;
    const struct tri_mesh *mesh = r->run->mesh;
    struct par_talk *talk = &r->lent[telling->w];
    tri_halfedge at = corner;
    bool memory = true;
    assert(par_is_own(&r->territory, mesh->xy[vertex_at(mesh, corner)])); /* so all triangles around it are here */
    do {
        memory = memory && tell_of(talk, tri_of(at)) && join_corners(telling, next, tri_of(at));
        at = turn(mesh, at, true);
    } while (memory && at != TRI_NONE && at != corner);
    if (at == corner)
        return memory;
    for (at = turn(mesh, corner, false); memory && at != TRI_NONE; at = turn(mesh, at, false))
        memory = tell_of(talk, tri_of(at)) && join_corners(telling, next, tri_of(at));
    return memory;
}

/* Its layers, the first of which is given. Frees that. */
static bool tell_layers(const struct telling *telling, struct par_ids *layer)
{
    const struct par_ranks *r = telling->ranks;
    bool memory = true;
    for (int32_t n = 0; memory && n < telling->layers && layer->n > 0; n++) {
        struct par_ids next = {0};
        for (int32_t i = 0; memory && i < layer->n; i++)
            memory = tell_around(telling, layer->item[i], &next);
        free(layer->item);
        *layer = next;
    }
    for (int32_t i = 0; memory && i < layer->n; i++) /* around these not all has been told */
        memory = par_map_put(&r->lent[telling->w].surrounded, vertex_at(r->run->mesh, layer->item[i]), TRI_NONE);
    free(layer->item);
    return memory;
}

/* Whom a straddler concerns: everybody who works in a box that has a corner of it. */
static bool tell_straddlers(const struct par_ranks *r)
{
    const struct tri_mesh *mesh = r->run->mesh;
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
    return block != TRI_NONE ? r->shift.worker[block] : -1;
}

static bool tell_surroundings(const struct par_ranks *r)
{
    struct par_ids *layer = calloc((size_t)r->carrier->n_ranks, sizeof *layer);
    bool memory = layer;
    for (int32_t i = 0; memory && i < r->run->worklist.n; i++) {
        const struct telling telling = {r, taker_of(r, i), PAR_GHOST_LAYERS};
        memory = telling.w < 0 || join_corners(&telling, &layer[telling.w], r->run->worklist.item[i]);
    }
    for (int w = 0; layer && w < r->carrier->n_ranks; w++) {
        const struct telling telling = {r, w, memory ? PAR_GHOST_LAYERS : 0};
        memory = tell_layers(&telling, &layer[w]) && memory;
    }
    free(layer);
    return memory;
}

/* Whether the taker has an entry already is not known here: it finds the same key. */
static bool lend_entries(struct par_ranks *r, struct par_message *message)
{
    struct par_run *run = r->run;
    bool memory = true;
    int32_t kept = 0;
    for (int32_t i = 0; i < run->worklist.n; i++) {
        int w = taker_of(r, i);
        if (w < 0) {
            par_keep_entry(run, i, &kept);
            continue;
        }
        int32_t number = par_talk_number(&r->lent[w], run->worklist.item[i]);
        assert(number != TRI_NONE);
        memory = memory && par_message_add_entry(&message[w], run->key.item[i], number);
    }
    run->worklist.n = run->key.n = kept;
    return memory;
}

enum tri_status par_lend(struct par_ranks *r, struct tri_error *error)
{
    struct par_message *message = par_messages_begin(r, r->lent);
    bool memory = message && tell_straddlers(r) && tell_surroundings(r) && par_messages_tell(r, r->lent, message) &&
                  lend_entries(r, message) && par_messages_send(r, r->lent, message);
    par_messages_free(r, message);
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

/* What is asked for: a vertex, as a corner of a triangle that has been told, and the most layers of a telling that told
 * all around one of its neighbours. */
struct wish {
    tri_halfedge corner;
    int32_t layers;
};

static void look_at(struct wish *wish, const struct par_talk *talk, const struct tri_mesh *mesh, tri_halfedge corner)
{
    wish->corner = corner;
    for (int k = 0; k < 3; k++) {
        int32_t layers = par_map_get(&talk->surrounded, mesh->tri[tri_of(corner)].v[k]);
        wish->layers = layers > wish->layers ? layers : wish->layers;
    }
}

/* Returns how many there are; TRI_NONE: no memory. */
static int32_t read_wishes(const struct par_ranks *r, int w, struct wish *wish)
{
    const int32_t *number = (const int32_t *)(const void *)r->in[w].at;
    const struct par_talk *talk = &r->lent[w];
    struct par_map at = {0};
    int32_t n = 0;
    bool memory = true;
    for (size_t i = 0; memory && i < r->in[w].n / sizeof *number; i++) {
        tri_vertex_id v = talk->vertex.item[number[i]];
        if (par_map_get(&at, v) != TRI_NONE)
            continue;
        memory = par_map_put(&at, v, n);
        wish[n++] = (struct wish){TRI_NONE, 0};
    }
    for (int32_t i = 0; memory && i < talk->triangle.n; i++)
        for (int k = 0; k < 3; k++) {
            tri_halfedge corner = tri_code(talk->triangle.item[i], k);
            int32_t which = par_map_get(&at, vertex_at(r->run->mesh, corner));
            if (which != TRI_NONE)
                look_at(&wish[which], talk, r->run->mesh, corner);
        }
    par_map_free(&at);
    return memory ? n : TRI_NONE;
}

/* Where what has been told was not enough, twice as many layers are told of: so a block that eats its way into another
 * rank's part asks seldom, and one that asks a little here and there does not get that much everywhere. */
static bool fulfil(const struct par_ranks *r, int w)
{
    struct wish *wish = malloc(r->in[w].n / sizeof(int32_t) * sizeof *wish + 1);
    const int32_t n = wish ? read_wishes(r, w, wish) : TRI_NONE;
    bool memory = n != TRI_NONE;
    for (int32_t i = 0; memory && i < n; i++) {
        assert(wish[i].corner != TRI_NONE); /* vertices are told as corners */
        const struct telling telling = {r, w, wish[i].layers > 0 ? 2 * wish[i].layers : PAR_GHOST_LAYERS};
        struct par_ids layer = {0};
        memory = join(&telling, &layer, wish[i].corner);
        memory = tell_layers(&telling, &layer) && memory;
    }
    free(wish);
    return memory;
}

enum tri_status par_lend_more(struct par_ranks *r, struct tri_error *error)
{
    struct par_message *message = par_messages_begin(r, r->lent);
    bool memory = message, bad = false;
    for (int w = 0; memory && w < r->carrier->n_ranks; w++) {
        bad = bad || is_bad_list(&r->in[w], &r->lent[w]);
        memory = bad || r->in[w].n == 0 || fulfil(r, w);
    }
    memory = memory && par_messages_tell(r, r->lent, message) && par_messages_send(r, r->lent, message);
    par_messages_free(r, message);
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
        memory = par_remove_triangle(r->run, *t);
        *t = TRI_NONE;
    }
    for (int32_t i = 0; memory && i < message->gone_subs.n; i++) {
        tri_sub_id *s = &talk->sub.item[message->gone_subs.item[i]];
        memory = par_remove_sub(r->run, *s);
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
        if (talk->sub.item[i] != TRI_NONE && is_left_alone(&r->run->mesh->sub[talk->sub.item[i]]))
            memory = par_remove_sub(r->run, talk->sub.item[i]);
    return memory;
}

static enum tri_status take_back(struct par_ranks *r, int w, struct tri_error *error)
{
    struct par_talk *talk = &r->lent[w];
    struct par_message message;
    int32_t first = talk->triangle.n;
    enum tri_status status = par_message_read(&message, talk, r->run->mesh, r->n_common, &r->in[w], error);
    bool memory = status || remove_gone(r, talk, &message);
    par_forget_straddlers(r, NULL);
    if (!status && memory)
        status = par_paste(r, talk, &message, false, error);
    for (int32_t i = first; !status && memory && i < talk->triangle.n; i++)
        memory = par_own_corners(r, talk->triangle.item[i]) == 3 ||
                 par_ids_add(&r->straddlers, talk->triangle.item[i]);
    memory = memory && (status || (remove_lone_subs(r, talk) && par_merge_entries(r->run, &message, talk)));
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
