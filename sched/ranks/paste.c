/* Adds received vertices, triangles and subsegments to a rank's mesh, and removes them. Added items get unused ids
 * first, then new ones at the end of the arrays. No function here is collective. */
#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "sched/ranks/ranks.h"
#include "triangle/base/grow.h"
#include "triangle/base/hash.h"

int par_own_corners(const struct par_ranks *r, tri_triangle_id t)
{
    const tri_vertex_id *v = r->run->mesh->tri[t].v;
    const struct tri_point *xy = r->run->mesh->xy;
    return par_is_own(&r->territory, xy[v[0]]) + par_is_own(&r->territory, xy[v[1]]) +
           par_is_own(&r->territory, xy[v[2]]);
}

/* --- messages */

struct par_message *par_messages_begin(const struct par_ranks *r, const struct par_talk *talk)
{
    struct par_message *message = calloc((size_t)r->carrier->n_ranks, sizeof *message);
    for (int p = 0; message && p < r->carrier->n_ranks; p++)
        message[p].first = talk[p].triangle.n;
    return message;
}

bool par_messages_fill(const struct par_ranks *r, struct par_talk *talk, struct par_message *message)
{
    bool memory = true;
    for (int p = 0; memory && p < r->carrier->n_ranks; p++)
        memory = par_message_fill(&message[p], &talk[p], r->run->mesh, r->n_common);
    return memory;
}

bool par_messages_send(struct par_ranks *r, const struct par_talk *talk, struct par_message *message)
{
    bool memory = true;
    for (int p = 0; memory && p < r->carrier->n_ranks; p++) {
        struct par_message *m = &message[p];
        if (m->gone.n + m->gone_subs.n + m->n_entries + m->n_triangles > 0)
            memory = par_message_write(m, &talk[p], r->run->mesh, r->n_common, &r->out[p]);
    }
    return memory;
}

void par_messages_free(const struct par_ranks *r, struct par_message *message)
{
    for (int p = 0; message && p < r->carrier->n_ranks; p++)
        par_message_free(&message[p]);
    free(message);
}

/* --- the worklist */

/* If the message has no entries, the worklist is not reallocated: the last call reads it while it fetches triangles. */
bool par_merge_entries(struct par_run *run, const struct par_message *m, const struct par_talk *talk)
{
    if (m->n_entries == 0)
        return true;
    int32_t *item = malloc(((size_t)m->n_entries + 1) * sizeof *item);
    uint64_t *key = malloc(((size_t)m->n_entries + 1) * sizeof *key);
    bool memory = item && key;
    for (int32_t i = 0; memory && i < m->n_entries; i++) {
        item[i] = talk->triangle.item[m->entry[i].triangle];
        key[i] = m->entry[i].key;
    }
    memory = memory && par_merge_worklist(run, item, key, m->n_entries);
    free(item);
    free(key);
    return memory;
}

/* --- ids */

static int32_t *count_of(struct tri_mesh *mesh, enum par_kind kind)
{
    return kind == PAR_VERTICES ? &mesh->n_vertices : kind == PAR_TRIANGLES ? &mesh->n_triangles : &mesh->n_subs;
}

/* Returns an unused id, or a new one. The arrays must have room for it. */
static int32_t take_id(struct par_run *run, enum par_kind kind)
{
    struct par_ranges *spare = &run->spare.ranges[kind];
    if (spare->n > 0) {
        struct par_range *last = &spare->item[spare->n - 1];
        spare->n -= last->next + 1 == last->end;
        return last->next++;
    }
    return (*count_of(run->mesh, kind))++;
}

bool par_remove_triangle(struct par_run *run, tri_triangle_id t)
{
    struct tri_mesh *mesh = run->mesh;
    struct tri_triangle *triangle = &mesh->tri[t];
    assert(tri_is_live(triangle));
    for (int e = 0; e < 3; e++) {
        tri_link link = triangle->n[e];
        if (link >= 0 && *tri_link_at(mesh, link) == tri_code(t, e))
            *tri_link_at(mesh, link) = TRI_BEYOND;
        for (int side = 0; link < 0 && link != TRI_BEYOND && side < 2; side++)
            if (mesh->sub[~link].side[side] == tri_code(t, e))
                mesh->sub[~link].side[side] = TRI_BEYOND;
    }
    triangle->v[0] = TRI_NONE;
    return par_room_release(&run->spare, PAR_TRIANGLES, t);
}

bool par_remove_sub(struct par_run *run, tri_sub_id s)
{
    par_room_mark_sub(run->mesh, s);
    return par_room_release(&run->spare, PAR_SUBS, s);
}

/* --- indices of vertices and triangles */

/* Returns the key of an id: the coordinates of a vertex, or the corners of a triangle. */
static const void *key_of(const struct par_index *index, const struct tri_mesh *mesh, int32_t id)
{
    return index->is_of_places ? (const void *)&mesh->xy[id] : mesh->tri[id].v;
}

/* Returns the slot that contains the id with this key, or the free slot (TRI_NONE) for it. */
static int32_t *find_slot(const struct par_index *index, const struct tri_mesh *mesh, const void *key)
{
    const size_t width = index->is_of_places ? sizeof(struct tri_point) : 3 * sizeof(tri_vertex_id);
    uint32_t mask = (uint32_t)index->capacity - 1, at = (uint32_t)tri_hash(0, key, width) & mask;
    while (index->id[at] != TRI_NONE && memcmp(key_of(index, mesh, index->id[at]), key, width) != 0)
        at = (at + 1) & mask;
    return &index->id[at];
}

/* Makes room for `more` further ids. False: no memory. */
static bool reserve_index(struct par_index *index, const struct tri_mesh *mesh, int32_t more)
{
    struct par_index larger = {.is_of_places = index->is_of_places, .n = index->n, .capacity = 1024};
    if (index->n > (1 << 28) - more)
        return false;
    if (2 * (index->n + more) < index->capacity)
        return true;
    while (larger.capacity <= 2 * (index->n + more))
        larger.capacity *= 2;
    larger.id = malloc((size_t)larger.capacity * sizeof *larger.id);
    if (!larger.id)
        return false;
    for (int32_t i = 0; i < larger.capacity; i++)
        larger.id[i] = TRI_NONE;
    for (int32_t i = 0; i < index->capacity; i++)
        if (index->id[i] != TRI_NONE)
            *find_slot(&larger, mesh, key_of(&larger, mesh, index->id[i])) = index->id[i];
    free(index->id);
    *index = larger;
    return true;
}

/* Adds an id to the index; replaces another id with the same key. */
static void add_to_index(struct par_index *index, const struct tri_mesh *mesh, int32_t id)
{
    int32_t *at = find_slot(index, mesh, key_of(index, mesh, id));
    index->n += *at == TRI_NONE;
    *at = id;
}

bool par_index_straddlers(struct par_ranks *r)
{
    const struct tri_mesh *mesh = r->run->mesh;
    free(r->places.id);
    free(r->triangles.id);
    r->places = (struct par_index){.is_of_places = true};
    r->triangles = (struct par_index){0};
    if (!reserve_index(&r->places, mesh, 3 * r->straddlers.n) ||
        !reserve_index(&r->triangles, mesh, r->straddlers.n))
        return false;
    for (int32_t i = 0; i < r->straddlers.n; i++) {
        const tri_vertex_id *v = mesh->tri[r->straddlers.item[i]].v;
        add_to_index(&r->triangles, mesh, r->straddlers.item[i]);
        for (int k = 0; k < 3; k++)
            if (v[k] >= r->n_common)
                add_to_index(&r->places, mesh, v[k]);
    }
    return true;
}

void par_forget_straddlers(struct par_ranks *r, const struct par_triangle_set *changed)
{
    const tri_triangle_id *t = r->straddlers.item;
    int32_t kept = 0;
    for (int32_t i = 0; i < r->straddlers.n; i++)
        if (tri_is_live(&r->run->mesh->tri[t[i]]) && !(changed && par_is_in(changed, t[i])))
            r->straddlers.item[kept++] = t[i];
    r->straddlers.n = kept;
}

/* --- paste */

struct pasting {
    struct par_ranks *ranks;           /* this rank */
    struct tri_mesh *mesh;             /* its mesh, to which the message is added */
    struct par_talk *talk;             /* the talk with the sender */
    const struct par_message *message; /* the received message, which is valid */
    bool is_borrowed;                  /* as in par_paste: this rank may already hold some of the contents */
    int32_t first_vertex, first_triangle, first_sub; /* shared numbers of the first items of the message */
    bool *is_new;    /* [n_vertices] this rank did not hold the vertex */
    tri_sub_id *sub; /* [n_new_subs] ids of the message's new subsegments; TRI_NONE: not held yet */
};

/* Adds vertex i of the message to the mesh and returns its id. */
static int32_t append_vertex(struct pasting *p, int32_t i)
{
    struct tri_mesh *mesh = p->mesh;
    const struct par_told_vertex *told = &p->message->vertex[i];
    tri_vertex_id v = take_id(p->ranks->run, PAR_VERTICES);
    mesh->xy[v] = told->xy;
    mesh->feature[v] = told->feature;
    mesh->on[v] = told->on;
    if (mesh->has_lengths)
        mesh->length[v] = tri_lengths_at(p->ranks->run->asked.quality->lengths, told->xy);
    mesh->vertex_markers[v] = told->marker;
    p->is_new[i] = true;
    return v;
}

/* Adds the message's vertices to the talk, and those that this rank does not hold to the mesh. False: no memory. */
static bool paste_vertices(struct pasting *p)
{
    bool memory = true;
    for (int32_t i = 0; memory && i < p->message->n_vertices; i++) {
        const struct par_told_vertex *told = &p->message->vertex[i];
        tri_vertex_id v = told->common;
        /* A new vertex in changes that are given back is not added to the index, because only one rank sends it: it was
         * inserted by one block, and no other block of the phase changes its triangles (triangle/refine/refine.h). */
        if (v == TRI_NONE) {
            v = *find_slot(&p->ranks->places, p->mesh, &told->xy);
            v = v != TRI_NONE ? v : append_vertex(p, i);
            if (p->is_borrowed)
                add_to_index(&p->ranks->places, p->mesh, v);
        }
        memory = par_talk_add_vertex(p->talk, v);
    }
    return memory;
}

/* May this rank hold the triangle already? Not if one of its corners is new. */
static bool may_be_here(const struct pasting *p, const struct par_told_triangle *told)
{
    bool may = p->is_borrowed;
    for (int k = 0; k < 3; k++)
        may = may && (told->v[k] < p->first_vertex || !p->is_new[told->v[k] - p->first_vertex]);
    return may;
}

/* Returns the id of a triangle of the message. Adds it, without links, if this rank does not hold it. */
static int32_t paste_triangle(struct pasting *p, const struct par_told_triangle *told)
{
    const int32_t *id = p->talk->vertex.item, v[3] = {id[told->v[0]], id[told->v[1]], id[told->v[2]]};
    tri_triangle_id t = may_be_here(p, told) ? *find_slot(&p->ranks->triangles, p->mesh, v) : TRI_NONE;
    if (t != TRI_NONE)
        return t;
    t = take_id(p->ranks->run, PAR_TRIANGLES);
    p->mesh->tri[t] = (struct tri_triangle){{v[0], v[1], v[2]}, {TRI_BEYOND, TRI_BEYOND, TRI_BEYOND}, told->region, 0};
    if (p->is_borrowed)
        add_to_index(&p->ranks->triangles, p->mesh, t);
    return t;
}

/* Adds the message's triangles to the talk, and those that this rank does not hold to the mesh. False: no memory. */
static bool paste_triangles(struct pasting *p)
{
    bool memory = true;
    for (int32_t i = 0; memory && i < p->message->n_triangles; i++)
        memory = par_talk_add_triangle(p->talk, paste_triangle(p, &p->message->triangle[i]));
    return memory;
}

/* Links t across edge e with triangle `other`. False: they have no such common edge, or have other links there. */
static bool link(struct tri_mesh *mesh, tri_triangle_id t, int e, tri_triangle_id other)
{
    struct tri_triangle *a = &mesh->tri[t], *b = other == TRI_NONE ? NULL : &mesh->tri[other];
    int f = b ? par_edge_between(b->v, a->v[tri_prev[e]], a->v[tri_next[e]]) : -1;
    if (f < 0)
        return false;
    if (a->n[e] == TRI_BEYOND) {
        a->n[e] = tri_code(other, f);
        b->n[f] = tri_code(t, e);
    }
    return a->n[e] == tri_code(other, f) && b->n[f] == tri_code(t, e);
}

/* Sets the links of the message's triangles. False: the message does not fit the mesh. */
static bool paste_links(struct pasting *p)
{
    const int32_t *id = p->talk->triangle.item;
    bool good = true;
    for (int32_t i = 0; good && i < p->message->n_triangles; i++)
        for (int e = 0; good && e < 3; e++) {
            int32_t next = p->message->triangle[i].next[e];
            good = next == TRI_NONE || link(p->mesh, id[p->first_triangle + i], e, id[next]);
        }
    return good;
}

/* Finds the message's new subsegments that this rank already holds, because it held a triangle beside them. */
static void find_subs(struct pasting *p)
{
    for (int32_t i = 0; i < p->message->n_new_subs; i++)
        p->sub[i] = TRI_NONE;
    for (int32_t i = 0; i < p->message->n_sides; i++) {
        const struct par_told_side *s = &p->message->side[i];
        tri_triangle_id t = p->talk->triangle.item[s->triangle];
        int32_t here = t == TRI_NONE ? TRI_BEYOND : p->mesh->tri[t].n[s->edge];
        if (s->sub >= p->first_sub && here < 0 && here != TRI_BEYOND)
            p->sub[s->sub - p->first_sub] = ~here;
    }
}

/* Adds a subsegment to the mesh and returns its id. Its ends are those of the edge of the triangle beside it. */
static tri_sub_id append_sub(struct pasting *p, const struct par_told_side *told)
{
    const tri_vertex_id *v = p->mesh->tri[p->talk->triangle.item[told->triangle]].v;
    tri_vertex_id from = v[tri_next[told->edge]], to = v[tri_prev[told->edge]];
    tri_sub_id s = take_id(p->ranks->run, PAR_SUBS);
    struct tri_subsegment *sub = &p->mesh->sub[s];
    *sub = (struct tri_subsegment){{told->side == 0 ? from : to, told->side == 0 ? to : from},
                                   {TRI_BEYOND, TRI_BEYOND}, told->marker, told->parent};
    if (told->is_boundary)
        sub->side[1 - told->side] = TRI_NONE;
    return s;
}

/* Adds the message's subsegments and links them with the triangles beside them. False: the message does not fit the
 * mesh, or no memory. */
static bool paste_subs(struct pasting *p)
{
    bool good = true;
    find_subs(p);
    for (int32_t i = 0; good && i < p->message->n_sides; i++) {
        const struct par_told_side *told = &p->message->side[i];
        tri_triangle_id t = p->talk->triangle.item[told->triangle];
        if (t == TRI_NONE)
            return false;
        if (told->sub == p->talk->sub.n) {
            tri_sub_id *s = &p->sub[told->sub - p->first_sub];
            *s = *s == TRI_NONE ? append_sub(p, told) : *s;
            good = par_talk_add_sub(p->talk, p->mesh, *s);
        }
        tri_sub_id s = good ? p->talk->sub.item[told->sub] : TRI_NONE;
        if (s == TRI_NONE)
            return false;
        p->mesh->sub[s].side[told->side] = tri_code(t, told->edge);
        p->mesh->tri[t].n[told->edge] = ~s;
    }
    return good;
}

/* Makes room for the contents of the message. False: no memory, or *error. */
static bool reserve(struct pasting *p, struct tri_error *error)
{
    const struct par_message *m = p->message;
    p->is_new = calloc((size_t)m->n_vertices + 1, sizeof *p->is_new);
    p->sub = malloc(((size_t)m->n_new_subs + 1) * sizeof *p->sub);
    return p->is_new && p->sub && !tri_mesh_reserve_vertices(p->mesh, m->n_vertices, error) &&
           !tri_mesh_reserve_triangles(p->mesh, m->n_triangles, error) &&
           !tri_mesh_reserve_subs(p->mesh, m->n_new_subs, error) &&
           reserve_index(&p->ranks->places, p->mesh, p->is_borrowed ? m->n_vertices : 0) &&
           reserve_index(&p->ranks->triangles, p->mesh, p->is_borrowed ? m->n_triangles : 0);
}

enum tri_status par_paste(struct par_ranks *r, struct par_talk *talk, const struct par_message *message,
                          bool is_borrowed, struct tri_error *error)
{
    struct pasting p = {r, r->run->mesh, talk, message, is_borrowed, talk->vertex.n, talk->triangle.n, talk->sub.n,
                        NULL, NULL};
    struct tri_error own = {0};
    enum tri_status status = TRI_OK;
    error = error ? error : &own;
    error->status = TRI_OK;
    if (!reserve(&p, error))
        status = error->status ? error->status : par_ranks_no_memory(error);
    if (!status && !(paste_vertices(&p) && paste_triangles(&p)))
        status = par_ranks_no_memory(error);
    if (!status && !(paste_links(&p) && paste_subs(&p)))
        status = tri_fail(error, TRI_INTERNAL, NULL, 0, "a message of another rank does not fit the mesh");
    free(p.is_new);
    free(p.sub);
    return status;
}
