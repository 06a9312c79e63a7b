/* What is borrowed, and what becomes of it. */
#include <assert.h>
#include <stdlib.h>

#include "sched/ranks/ranks.h"
#include "sched/tunables.h"

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

enum tri_status par_ask(struct par_ranks *r, const struct par_ids *vertices, struct tri_error *error)
{
    for (int32_t i = 0; i < vertices->n; i++) {
        assert(vertices->item[i] >= 0 && vertices->item[i] < r->run->mesh->n_vertices);
        int h = par_owner_at(&r->territory, r->run->mesh->xy[vertices->item[i]]);
        int32_t number = h == r->territory.rank ? 0 : par_map_get(&r->borrowed[h].vertex_at, vertices->item[i]);
        if (number == TRI_NONE)
            return tri_fail(error, TRI_INTERNAL, NULL, 0, "nobody knows what lies beyond an edge");
        if (h != r->territory.rank && !par_bytes_add(&r->out[h], &number, sizeof number))
            return par_ranks_no_memory(error);
    }
    return TRI_OK;
}

/* --- giving back */

/* A list becomes that of the set made of it: each once, in ascending order. */
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

/* Triangles that were made anew, and subsegments that were split, are no longer what was told. */
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

/* The other ranks that own corners of a triangle, each once; returns how many. The first is looked for at owner[0]. */
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

/* Triangles lie in the order of the list, their corners do not: these are fetched ahead. */
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

/* Was this left by a block at a border, in this phase? */
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
/* An own corner, or one of another rank's that knows the triangle: the others need not have its entry. */
static bool is_known_to_owner(const struct par_ranks *r, tri_triangle_id t, const int *owner, int n)
{
    bool is = par_own_corners(r, t) > 0;
    for (int k = 0; k < n; k++)
        is = is || par_talk_number(&r->borrowed[owner[k]], t) != TRI_NONE;
    return is;
}
#endif

/* What such a block left goes to those who own a corner of it and know it. A block may leave a triangle beside a
 * subsegment of which one corner lies outside its box: that one's owner may know nothing of the block. */
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

static bool give_all(struct par_ranks *r, const struct par_ids *changed, const struct par_triangle_set *set)
{
    struct par_message *message = par_messages_begin(r, r->borrowed);
    bool memory = message;
    for (int h = 0; memory && h < r->carrier->n_ranks; h++)
        memory = note_gone(r, &r->borrowed[h], set, &message[h]);
    memory = memory && add_new(r, changed) && par_messages_tell(r, r->borrowed, message) &&
             give_entries(r, message) && par_messages_send(r, r->borrowed, message);
    par_messages_free(r, message);
    return memory;
}

/* --- dropping */

static void mark(uint64_t *word, tri_vertex_id v, bool on)
{
    uint64_t bit = (uint64_t)1 << v % 64;
    word[v / 64] = on ? word[v / 64] | bit : word[v / 64] & ~bit;
}

/* The vertices of what goes go with it, unless a straddler has them. */
static bool remove_vertices(struct par_ranks *r, uint64_t *word)
{
    struct tri_mesh *mesh = r->run->mesh;
    bool memory = true;
    for (int32_t i = 0; i < r->straddlers.n; i++)
        for (int k = 0; k < 3; k++)
            mark(word, mesh->tri[r->straddlers.item[i]].v[k], false);
    for (int32_t w = 0; memory && w <= mesh->n_vertices / 64; w++)
        for (int bit = 0; memory && word[w] != 0 && bit < 64; bit++)
            if (word[w] >> bit & 1) {
                assert(64 * w + bit >= r->n_common); /* these all ranks keep */
                mesh->on[64 * w + bit] = TRI_VERTEX_NONE;
                memory = par_release(r->run, PAR_VERTICES, 64 * w + bit);
            }
    return memory;
}

static bool leave_sub(struct par_run *run, tri_sub_id s, tri_halfedge code)
{
    struct tri_subsegment *sub = &run->mesh->sub[s];
    for (int side = 0; side < 2; side++)
        if (sub->side[side] == code)
            sub->side[side] = TRI_BEYOND;
    return !par_is_lone(sub) || par_remove_sub(run, s);
}

/* Its neighbours are cut off afterwards, all at once. */
static bool drop_triangle(struct par_ranks *r, tri_triangle_id t, uint64_t *word)
{
    struct tri_triangle *triangle = &r->run->mesh->tri[t];
    bool memory = true;
    assert(tri_is_live(triangle) && par_own_corners(r, t) == 0);
    for (int k = 0; memory && k < 3; k++) {
        if (triangle->v[k] >= r->n_common)
            mark(word, triangle->v[k], true);
        if (triangle->n[k] < 0 && triangle->n[k] != TRI_BEYOND)
            memory = leave_sub(r->run, ~triangle->n[k], tri_code(t, k));
    }
    triangle->v[0] = TRI_NONE;
    return memory && par_release(r->run, PAR_TRIANGLES, t);
}

/* A triangle that stays beside one that has gone shares an edge without an own end with it: it is a straddler. */
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

/* A triangle goes, or stays, as a straddler if others have it, too. */
static bool put_in_place(struct par_ranks *r, tri_triangle_id t, uint64_t *word)
{
    int n = par_own_corners(r, t);
    if (n == 0)
        return drop_triangle(r, t, word);
    return n == 3 || par_ids_add(&r->straddlers, t);
}

/* What is borrowed, and has not changed. */
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

static bool drop_all(struct par_ranks *r, const struct par_ids *changed, const struct par_triangle_set *set)
{
    uint64_t *word = calloc((size_t)r->run->mesh->n_vertices / 64 + 1, sizeof *word);
    bool memory = word;
    par_forget_straddlers(r, set);
    for (int32_t i = 0; memory && i < changed->n; i++)
        memory = put_in_place(r, changed->item[i], word);
    for (int h = 0; memory && h < r->carrier->n_ranks; h++)
        memory = drop_borrowed(r, &r->borrowed[h].triangle, word);
    if (memory)
        cut_off(r);
    memory = memory && remove_vertices(r, word);
    free(word);
    return memory;
}

enum tri_status par_give_back(struct par_ranks *r, struct par_ids *changed, struct tri_error *error)
{
    struct par_triangle_set set;
    bool memory = par_triangle_set_of(&set, changed, r->run->mesh->n_triangles);
    if (memory)
        list_set(changed, &set, r->run->mesh->n_triangles);
    memory = memory && give_all(r, changed, &set) && drop_all(r, changed, &set);
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
            memory = put_in_place(r, t, word); /* all vertices stay: all ranks have them */
    if (memory)
        cut_off(r);
    free(word);
    return memory ? TRI_OK : par_ranks_no_memory(error);
}
