/* The exchange of triangles between ranks. A rank lends ghost layers around its own vertices in boxes of blocks that
 * another rank refines. The other rank borrows them and gives them back after the phase. No function here is
 * collective: each fills the messages of the next exchange or reads those of the last one. */
#include <assert.h>
#include <stdlib.h>

#include "sched/ranks/ranks.h"
#include "sched/tunables.h"

/* --- lending */

/* Returns the other rank that refines the block containing q, of which this rank owns a part; -1: none. */
static int worker_at(const struct par_ranks *r, struct tri_point q)
{
    const struct par_shift *s = &r->shift;
    return s->worker[s->partition ? par_block_at(s->partition, s->phase, q) : 0];
}

/* Adds a triangle to the talk, unless it is there already. False: no memory. */
static bool add_to_talk(struct par_talk *talk, tri_triangle_id t)
{
    return par_talk_number(talk, t) != TRI_NONE || par_talk_add_triangle(talk, t);
}

/* The sending of ghost layers to rank w. A layer is a list of own vertices, all triangles around which are sent. Each
 * vertex is given as a corner: a triangle and one of its corners, encoded like a half-edge. */
struct telling {
    const struct par_ranks *ranks; /* this rank */
    int w;                         /* the rank that receives the layers */
    int32_t layers;                /* number of layers to send */
};

/* Returns the vertex at a corner. */
static tri_vertex_id vertex_at(const struct tri_mesh *mesh, tri_halfedge corner)
{
    return mesh->tri[tri_of(corner)].v[tri_edge(corner)];
}

/* Adds a vertex to a layer, unless all triangles around it have been sent or this rank must not send them. */
static bool join_layer(const struct telling *telling, struct par_ids *layer, tri_halfedge corner)
{
    const struct par_ranks *r = telling->ranks;
    struct par_map *surrounded = &r->lent[telling->w].surrounded;
    tri_vertex_id v = vertex_at(r->run->mesh, corner);
    struct tri_point q = r->run->mesh->xy[v];
    if (par_map_get(surrounded, v) != TRI_NONE || !par_is_own(&r->territory, q) || worker_at(r, q) != telling->w)
        return true;
    return par_map_put(surrounded, v, telling->layers) && par_ids_add(layer, corner);
}

/* Adds the corners of t to a layer, as join_layer does. False: no memory. */
static bool join_corners(const struct telling *telling, struct par_ids *layer, tri_triangle_id t)
{
    assert(tri_is_live(&telling->ranks->run->mesh->tri[t]));
    return join_layer(telling, layer, tri_code(t, 0)) && join_layer(telling, layer, tri_code(t, 1)) &&
           join_layer(telling, layer, tri_code(t, 2));
}

/* Returns the same vertex as a corner of the next triangle around it, to the left or right; TRI_NONE: no triangle. */
static tri_halfedge turn_corner(const struct tri_mesh *mesh, tri_halfedge corner, bool left)
{
    const int *ahead = left ? tri_next : tri_prev;
    tri_halfedge edge = tri_code(tri_of(corner), ahead[tri_edge(corner)]);
    assert(*tri_link_at(mesh, edge) != TRI_BEYOND);
    tri_halfedge across = tri_across(mesh, edge);
    return across < 0 ? TRI_NONE : tri_code(tri_of(across), ahead[tri_edge(across)]);
}

/* Sends all triangles around an own vertex and adds their corners to the next layer. False: no memory. */
static bool tell_around(const struct telling *telling, tri_halfedge corner, struct par_ids *next)
{
    const struct par_ranks *r = telling->ranks;
    const struct tri_mesh *mesh = r->run->mesh;
    struct par_talk *talk = &r->lent[telling->w];
    tri_halfedge at = corner;
    bool memory = true;
    assert(par_is_own(&r->territory, mesh->xy[vertex_at(mesh, corner)])); /* so this rank holds all its triangles */
    do {
        memory = memory && add_to_talk(talk, tri_of(at)) && join_corners(telling, next, tri_of(at));
        at = turn_corner(mesh, at, true);
    } while (memory && at != TRI_NONE && at != corner);
    if (at == corner)
        return memory;
    for (at = turn_corner(mesh, corner, false); memory && at != TRI_NONE; at = turn_corner(mesh, at, false))
        memory = add_to_talk(talk, tri_of(at)) && join_corners(telling, next, tri_of(at));
    return memory;
}

/* Sends layer after layer, starting with the given one, which is freed. False: no memory. */
static bool send_layers(const struct telling *telling, struct par_ids *layer)
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
    for (int32_t i = 0; memory && i < layer->n; i++) /* not all triangles around these were sent */
        memory = par_map_put(&r->lent[telling->w].surrounded, vertex_at(r->run->mesh, layer->item[i]), TRI_NONE);
    free(layer->item);
    return memory;
}

/* Sends each straddler to all ranks that refine a block containing one of its corners. */
static bool tell_straddlers(const struct par_ranks *r)
{
    const struct tri_mesh *mesh = r->run->mesh;
    bool memory = true;
    for (int32_t i = 0; memory && i < r->straddlers.n; i++)
        for (int k = 0; memory && k < 3; k++) {
            int w = worker_at(r, mesh->xy[mesh->tri[r->straddlers.item[i]].v[k]]);
            memory = w < 0 || add_to_talk(&r->lent[w], r->straddlers.item[i]);
        }
    return memory;
}

/* Returns the rank that is lent entry i of the worklist, or -1. */
static int borrower_of(const struct par_ranks *r, int32_t i)
{
    int32_t block = r->shift.block_of[i];
    return block != TRI_NONE ? r->shift.worker[block] : -1;
}

/* Sends the ghost layers around all worklist entries in blocks of other ranks. False: no memory. */
static bool tell_surroundings(const struct par_ranks *r)
{
    struct par_ids *layer = calloc((size_t)r->carrier->n_ranks, sizeof *layer);
    bool memory = layer;
    for (int32_t i = 0; memory && i < r->run->worklist.n; i++) {
        const struct telling telling = {r, borrower_of(r, i), PAR_GHOST_LAYERS};
        memory = telling.w < 0 || join_corners(&telling, &layer[telling.w], r->run->worklist.item[i]);
    }
    for (int w = 0; layer && w < r->carrier->n_ranks; w++) {
        const struct telling telling = {r, w, memory ? PAR_GHOST_LAYERS : 0};
        memory = send_layers(&telling, &layer[w]) && memory;
    }
    free(layer);
    return memory;
}

/* Moves the entries in blocks of other ranks from the worklist to the messages. The borrower may already have an entry;
 * it detects duplicates by their equal keys. False: no memory. */
static bool lend_entries(struct par_ranks *r, struct par_message *message)
{
    struct par_run *run = r->run;
    bool memory = true;
    int32_t kept = 0;
    for (int32_t i = 0; i < run->worklist.n; i++) {
        int w = borrower_of(r, i);
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
    bool memory = message && tell_straddlers(r) && tell_surroundings(r) && par_messages_fill(r, r->lent, message) &&
                  lend_entries(r, message) && par_messages_send(r, r->lent, message);
    par_messages_free(r, message);
    return memory ? TRI_OK : par_ranks_no_memory(error);
}

/* --- requests for more layers */

/* Is a received request invalid, because it contains other numbers than those of vertices in the talk? */
static bool is_bad_list(const struct par_bytes *bytes, const struct par_talk *talk)
{
    const int32_t *number = (const int32_t *)(const void *)bytes->at;
    bool bad = bytes->n % sizeof *number != 0;
    for (size_t i = 0; !bad && i < bytes->n / sizeof *number; i++)
        bad = number[i] < 0 || number[i] >= talk->vertex.n;
    return bad;
}

/* A request for all triangles around a vertex. The vertex is given as a corner of a triangle that was sent. `layers` is
 * the largest number of layers that were sent at once around one of its neighbours. */
struct request {
    tri_halfedge corner; /* TRI_NONE: not found yet */
    int32_t layers;      /* 0: none of the neighbours has a layer around it */
};

/* Updates a request for the vertex at a corner with the triangle of this corner. */
static void look_at(struct request *request, const struct par_talk *talk, const struct tri_mesh *mesh,
                    tri_halfedge corner)
{
    request->corner = corner;
    for (int k = 0; k < 3; k++) {
        int32_t layers = par_map_get(&talk->surrounded, mesh->tri[tri_of(corner)].v[k]);
        request->layers = layers > request->layers ? layers : request->layers;
    }
}

/* Reads the requests of rank w. Returns their number; TRI_NONE: no memory. */
static int32_t read_requests(const struct par_ranks *r, int w, struct request *request)
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
        request[n++] = (struct request){TRI_NONE, 0};
    }
    for (int32_t i = 0; memory && i < talk->triangle.n; i++)
        for (int k = 0; k < 3; k++) {
            tri_halfedge corner = tri_code(talk->triangle.item[i], k);
            int32_t which = par_map_get(&at, vertex_at(r->run->mesh, corner));
            if (which != TRI_NONE)
                look_at(&request[which], talk, r->run->mesh, corner);
        }
    par_map_free(&at);
    return memory ? n : TRI_NONE;
}

/* Each repeated request at a place is answered with twice as many layers. A block that advances far into another rank's
 * part thus needs few requests, and single requests elsewhere do not cause large answers. */
static bool answer_requests(const struct par_ranks *r, int w)
{
    struct request *request = malloc(r->in[w].n / sizeof(int32_t) * sizeof *request + 1);
    const int32_t n = request ? read_requests(r, w, request) : TRI_NONE;
    bool memory = n != TRI_NONE;
    for (int32_t i = 0; memory && i < n; i++) {
        assert(request[i].corner != TRI_NONE); /* each sent vertex is a corner of a sent triangle */
        const struct telling telling = {r, w, request[i].layers > 0 ? 2 * request[i].layers : PAR_GHOST_LAYERS};
        struct par_ids layer = {0};
        memory = join_layer(&telling, &layer, request[i].corner);
        memory = send_layers(&telling, &layer) && memory;
    }
    free(request);
    return memory;
}

enum tri_status par_lend_more(struct par_ranks *r, struct tri_error *error)
{
    struct par_message *message = par_messages_begin(r, r->lent);
    bool memory = message, bad = false;
    for (int w = 0; memory && w < r->carrier->n_ranks; w++) {
        bad = bad || is_bad_list(&r->in[w], &r->lent[w]);
        memory = bad || r->in[w].n == 0 || answer_requests(r, w);
    }
    memory = memory && par_messages_fill(r, r->lent, message) && par_messages_send(r, r->lent, message);
    par_messages_free(r, message);
    if (bad)
        return tri_fail(error, TRI_INTERNAL, NULL, 0, "another rank requests vertices that were not sent to it");
    return memory ? TRI_OK : par_ranks_no_memory(error);
}

/* --- receiving changes to lent triangles */

/* Removes the triangles and subsegments that a message lists as deleted. False: no memory. */
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

/* Does the subsegment exist, without a triangle on either side? */
static bool is_left_alone(const struct tri_subsegment *s) { return s->v[0] != TRI_NONE && par_is_lone(s); }

/* Removes subsegments beside which other ranks have made triangles that only they hold. */
static bool remove_lone_subs(struct par_ranks *r, const struct par_talk *talk)
{
    bool memory = true;
    for (int32_t i = 0; memory && i < talk->sub.n; i++)
        if (talk->sub.item[i] != TRI_NONE && is_left_alone(&r->run->mesh->sub[talk->sub.item[i]]))
            memory = par_remove_sub(r->run, talk->sub.item[i]);
    return memory;
}

/* Applies the changes that rank w has made. */
static enum tri_status take_back_from(struct par_ranks *r, int w, struct tri_error *error)
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
            status = take_back_from(r, w, error);
    return status;
}

/* --- borrowing */

enum tri_status par_borrow_from(struct par_ranks *r, struct par_talk *talk, const struct par_bytes *told,
                                struct tri_error *error)
{
    struct par_message message;
    enum tri_status status = par_message_read(&message, talk, r->run->mesh, r->n_common, told, error);
    status = status ? status : par_paste(r, talk, &message, true, error);
    if (!status && !par_merge_entries(r->run, &message, talk))
        status = par_ranks_no_memory(error);
    par_message_free(&message);
    return status;
}

enum tri_status par_borrow(struct par_ranks *r, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    for (int h = 0; !status && h < r->carrier->n_ranks; h++)
        if (r->in[h].n > 0)
            status = par_borrow_from(r, &r->borrowed[h], &r->in[h], error);
    return status;
}

enum tri_status par_request_layers(struct par_ranks *r, const struct par_ids *vertices, struct tri_error *error)
{
    for (int32_t i = 0; i < vertices->n; i++) {
        assert(vertices->item[i] >= 0 && vertices->item[i] < r->run->mesh->n_vertices);
        int h = par_owner_at(&r->territory, r->run->mesh->xy[vertices->item[i]]);
        int32_t number = h == r->territory.rank ? 0 : par_map_get(&r->borrowed[h].vertex_at, vertices->item[i]);
        if (number == TRI_NONE)
            return tri_fail(error, TRI_INTERNAL, NULL, 0, "no rank holds the neighbour of an edge");
        if (h != r->territory.rank && !par_bytes_add(&r->out[h], &number, sizeof number))
            return par_ranks_no_memory(error);
    }
    return TRI_OK;
}

/* --- giving back */

/* Replaces a list by the members of the set made from it: each once, in ascending order. */
static void list_set(struct par_ids *list, const struct par_triangle_set *set, int32_t n_triangles)
{
    int32_t n = 0;
    for (int32_t w = 0; w <= (n_triangles - 1) / 64; w++)
        for (int bit = 0; set->word[w] != 0 && bit < 64; bit++)
            if (set->word[w] >> bit & 1)
                list->item[n++] = 64 * w + bit;
    assert(n <= list->n);
    list->n = n;
}

/* Lists remade triangles and split subsegments as deleted in the message: they differ from those that were sent. */
static bool note_gone(const struct par_ranks *r, struct par_talk *talk, const struct par_triangle_set *changed,
                      struct par_message *message)
{
    const struct tri_mesh *mesh = r->run->mesh;
    bool memory = true;
    for (int32_t i = 0; memory && i < talk->triangle.n; i++)
        if (par_is_in(changed, talk->triangle.item[i])) {
            memory = par_ids_add(&message->gone, i);
            talk->triangle.item[i] = TRI_NONE;
        }
    for (int32_t i = 0; memory && i < talk->sub.n; i++)
        if (mesh->sub[talk->sub.item[i]].v[1] != talk->sub_end.item[i]) {
            memory = par_ids_add(&message->gone_subs, i);
            talk->sub.item[i] = TRI_NONE;
        }
    return memory;
}

/* Lists the other ranks that own corners of t, each once. Returns their number. On entry owner[0] is a first guess. */
static int owners_of(const struct par_ranks *r, tri_triangle_id t, int owner[3])
{
    const struct tri_mesh *mesh = r->run->mesh;
    int n = 0, guess = owner[0];
    assert(tri_is_live(&mesh->tri[t]));
    for (int k = 0; k < 3; k++) {
        struct tri_point q = mesh->xy[mesh->tri[t].v[k]];
        if (par_is_own(&r->territory, q))
            continue;
        int p = par_owns(&r->territory, guess, q) ? guess : par_owner_at(&r->territory, q);
        bool is_told = false;
        for (int i = 0; i < n; i++)
            is_told = is_told || owner[i] == p;
        if (!is_told)
            owner[n++] = p;
    }
    return n;
}

/* Adds the live triangles of the list to the talks with the owners of their corners. The vertices are scattered in
 * memory, so they are prefetched. False: no memory. */
static bool add_new(struct par_ranks *r, const struct par_ids *changed)
{
    const struct tri_mesh *mesh = r->run->mesh;
    bool memory = true;
    int owner[3] = {0};
    for (int32_t i = 0; memory && i < changed->n; i++) {
        for (int k = 0; i + PAR_CORNERS_AHEAD < changed->n && k < 3; k++)
            __builtin_prefetch(&mesh->xy[mesh->tri[changed->item[i + PAR_CORNERS_AHEAD]].v[k]]);
        int n = owners_of(r, changed->item[i], owner);
        for (int k = 0; memory && k < n; k++)
            memory = par_talk_add_triangle(&r->borrowed[owner[k]], changed->item[i]);
    }
    return memory;
}

/* Was the entry with this key left over by a border block of this phase? */
static bool is_of_border(const struct par_ranks *r, uint64_t key)
{
    const struct par_partition *p = r->shift.partition;
    int32_t place = (int32_t)(key >> 32 & 0xffffff) - 1;
    if (!p || place < 0)
        return false;
    int32_t block = place / p->n_rows / 2 * p->n_rows + place % p->n_rows;
    return par_key_of(p, r->run->place.round, r->shift.phase, block) == (key & ~(uint64_t)UINT32_MAX) &&
           r->shift.is_border[block];
}

#ifndef NDEBUG
/* Does this rank own a corner of t, or does another owner of a corner hold t? Then one of them can keep its entry. */
static bool is_known_to_owner(const struct par_ranks *r, tri_triangle_id t, const int *owner, int n)
{
    bool is = par_own_corners(r, t) > 0;
    for (int k = 0; k < n; k++)
        is = is || par_talk_number(&r->borrowed[owner[k]], t) != TRI_NONE;
    return is;
}
#endif

/* Sends entries that border blocks left over to the owners of the triangle's corners that hold the triangle. A block
 * may leave over a triangle beside a subsegment with one corner outside its box. The owner of that corner may have no
 * part of the block. */
static bool give_entries(struct par_ranks *r, struct par_message *message)
{
    struct par_run *run = r->run;
    bool memory = true;
    int32_t kept = 0;
    int owner[3] = {0};
    for (int32_t i = 0; i < run->worklist.n; i++) {
        tri_triangle_id t = run->worklist.item[i];
        const uint64_t key = run->key.item[i];
        if (par_own_corners(r, t) > 0)
            par_keep_entry(run, i, &kept);
        if (!is_of_border(r, key))
            continue;
        int n = owners_of(r, t, owner);
        assert(is_known_to_owner(r, t, owner, n));
        for (int k = 0; k < n; k++) {
            int32_t number = par_talk_number(&r->borrowed[owner[k]], t);
            if (number != TRI_NONE)
                memory = memory && par_message_add_entry(&message[owner[k]], key, number);
        }
    }
    run->worklist.n = run->key.n = kept;
    return memory;
}

/* Fills the messages to all lenders. changed: the live triangles that were made; set: those and erased ones. */
static bool give_all(struct par_ranks *r, const struct par_ids *changed, const struct par_triangle_set *set)
{
    struct par_message *message = par_messages_begin(r, r->borrowed);
    bool memory = message;
    for (int h = 0; memory && h < r->carrier->n_ranks; h++)
        memory = note_gone(r, &r->borrowed[h], set, &message[h]);
    memory = memory && add_new(r, changed) && par_messages_fill(r, r->borrowed, message) &&
             give_entries(r, message) && par_messages_send(r, r->borrowed, message);
    par_messages_free(r, message);
    return memory;
}

/* --- dropping */

/* Sets or clears the bit of v. */
static void mark_vertex(uint64_t *word, tri_vertex_id v, bool on)
{
    uint64_t bit = (uint64_t)1 << v % 64;
    word[v / 64] = on ? word[v / 64] | bit : word[v / 64] & ~bit;
}

/* Removes the vertices of dropped triangles, except corners of straddlers. */
static bool remove_vertices(struct par_ranks *r, uint64_t *word)
{
    struct tri_mesh *mesh = r->run->mesh;
    bool memory = true;
    for (int32_t i = 0; i < r->straddlers.n; i++)
        for (int k = 0; k < 3; k++)
            mark_vertex(word, mesh->tri[r->straddlers.item[i]].v[k], false);
    for (int32_t w = 0; memory && w <= mesh->n_vertices / 64; w++)
        for (int bit = 0; memory && word[w] != 0 && bit < 64; bit++)
            if (word[w] >> bit & 1) {
                assert(64 * w + bit >= r->n_common); /* all ranks keep the coarse vertices */
                mesh->on[64 * w + bit] = TRI_VERTEX_NONE;
                memory = par_room_release(&r->run->spare, PAR_VERTICES, 64 * w + bit);
            }
    return memory;
}

/* Removes the link of a subsegment to a dropped triangle, and the subsegment if it has no other. False: no memory. */
static bool leave_sub(struct par_run *run, tri_sub_id s, tri_halfedge code)
{
    struct tri_subsegment *sub = &run->mesh->sub[s];
    for (int side = 0; side < 2; side++)
        if (sub->side[side] == code)
            sub->side[side] = TRI_BEYOND;
    return !par_is_lone(sub) || par_remove_sub(run, s);
}

/* Drops a triangle. cut_off resets the links of its neighbours later, for all dropped triangles at once. */
static bool drop_triangle(struct par_ranks *r, tri_triangle_id t, uint64_t *word)
{
    struct tri_triangle *triangle = &r->run->mesh->tri[t];
    bool memory = true;
    assert(tri_is_live(triangle) && par_own_corners(r, t) == 0);
    for (int k = 0; memory && k < 3; k++) {
        if (triangle->v[k] >= r->n_common)
            mark_vertex(word, triangle->v[k], true);
        if (triangle->n[k] < 0 && triangle->n[k] != TRI_BEYOND)
            memory = leave_sub(r->run, ~triangle->n[k], tri_code(t, k));
    }
    triangle->v[0] = TRI_NONE;
    return memory && par_room_release(&r->run->spare, PAR_TRIANGLES, t);
}

/* Resets links to dropped triangles. A remaining triangle beside a dropped one is a straddler, because neither end of
 * their common edge is an own vertex. Hence only straddlers are visited. */
static void cut_off(struct par_ranks *r)
{
    struct tri_mesh *mesh = r->run->mesh;
    for (int32_t i = 0; i < r->straddlers.n; i++) {
        tri_link *link = mesh->tri[r->straddlers.item[i]].n;
        assert(tri_is_live(&mesh->tri[r->straddlers.item[i]]));
        for (int e = 0; e < 3; e++)
            if (link[e] >= 0 && !tri_is_live(&mesh->tri[tri_of(link[e])]))
                link[e] = TRI_BEYOND;
    }
}

/* Drops t if it has no own corner. Otherwise keeps it, as a straddler if other ranks hold it as well. */
static bool keep_or_drop(struct par_ranks *r, tri_triangle_id t, uint64_t *word)
{
    int n = par_own_corners(r, t);
    if (n == 0)
        return drop_triangle(r, t, word);
    return n == 3 || par_ids_add(&r->straddlers, t);
}

/* Drops borrowed triangles that have not changed. */
static bool drop_borrowed(struct par_ranks *r, const struct par_ids *triangles, uint64_t *word)
{
    bool memory = true;
    for (int32_t i = 0; memory && i < triangles->n; i++) {
        tri_triangle_id t = triangles->item[i];
        if (t != TRI_NONE && tri_is_live(&r->run->mesh->tri[t]) && par_own_corners(r, t) == 0)
            memory = drop_triangle(r, t, word);
    }
    return memory;
}

/* Drops all borrowed and changed triangles without an own corner, with their vertices. False: no memory. */
static bool drop_all(struct par_ranks *r, const struct par_ids *changed, const struct par_triangle_set *set)
{
    uint64_t *word = calloc((size_t)r->run->mesh->n_vertices / 64 + 1, sizeof *word);
    bool memory = word;
    par_forget_straddlers(r, set);
    for (int32_t i = 0; memory && i < changed->n; i++)
        memory = keep_or_drop(r, changed->item[i], word);
    for (int h = 0; memory && h < r->carrier->n_ranks; h++)
        memory = drop_borrowed(r, &r->borrowed[h].triangle, word);
    if (memory)
        cut_off(r);
    memory = memory && remove_vertices(r, word);
    free(word);
    return memory;
}

/* Moves live triangles to the front of `changed` and returns their number. The others were erased. */
static int32_t sort_erased(const struct tri_mesh *mesh, struct par_ids *changed)
{
    int32_t n = 0;
    for (int32_t i = 0; i < changed->n; i++) {
        const tri_triangle_id t = changed->item[i];
        changed->item[i] = changed->item[n];
        changed->item[n] = t;
        n += tri_is_live(&mesh->tri[t]);
    }
    return n;
}

enum tri_status par_give_back(struct par_ranks *r, struct par_ids *changed, struct tri_error *error)
{
    struct par_triangle_set set;
    bool memory = par_triangle_set_of(&set, changed, r->run->mesh->n_triangles);
    if (memory)
        list_set(changed, &set, r->run->mesh->n_triangles);
    const int32_t all = changed->n;
    changed->n = sort_erased(r->run->mesh, changed);
    memory = memory && give_all(r, changed, &set) && drop_all(r, changed, &set);
    for (int32_t i = changed->n; memory && i < all; i++)
        memory = par_room_release(&r->run->spare, PAR_TRIANGLES, changed->item[i]);
    free(set.word);
    return memory ? TRI_OK : par_ranks_no_memory(error);
}

static void keep_own_entries(struct par_ranks *r)
{
    struct par_run *run = r->run;
    int32_t kept = 0;
    for (int32_t i = 0; i < run->worklist.n; i++)
        if (par_own_corners(r, run->worklist.item[i]) > 0)
            par_keep_entry(run, i, &kept);
    run->worklist.n = run->key.n = kept;
}

enum tri_status par_keep_own(struct par_ranks *r, struct tri_error *error)
{
    const struct tri_mesh *mesh = r->run->mesh;
    assert(r->straddlers.n == 0);
    uint64_t *word = calloc((size_t)mesh->n_vertices / 64 + 1, sizeof *word);
    bool memory = word;
    keep_own_entries(r);
    for (tri_triangle_id t = 0; memory && t < mesh->n_triangles; t++)
        if (tri_is_live(&mesh->tri[t]))
            memory = keep_or_drop(r, t, word); /* all ranks keep the coarse vertices */
    if (memory)
        cut_off(r);
    free(word);
    return memory ? TRI_OK : par_ranks_no_memory(error);
}
