/* The shared numbers of a talk, and the filling of messages. wire.c encodes messages. No function is collective. */
#include "sched/ranks/talk.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/grow.h"

/* --- maps */

bool par_map_put(struct par_map *map, int32_t key, int32_t value)
{
    int32_t page = key / PAR_PAGE;
    assert(key >= 0);
    if (page >= map->n) {
        if (!tri_grow(&map->page, &map->capacity, page + 1, sizeof *map->page))
            return false;
        while (map->n <= page)
            map->page[map->n++] = NULL;
    }
    if (!map->page[page]) {
        map->page[page] = malloc(PAR_PAGE * sizeof **map->page);
        for (int32_t i = 0; map->page[page] && i < PAR_PAGE; i++)
            map->page[page][i] = TRI_NONE;
    }
    if (map->page[page])
        map->page[page][key % PAR_PAGE] = value;
    return map->page[page];
}

void par_map_free(struct par_map *map)
{
    for (int32_t i = 0; i < map->n; i++)
        free(map->page[i]);
    free(map->page);
    *map = (struct par_map){0};
}

/* --- numbers */

bool par_talk_add_vertex(struct par_talk *talk, tri_vertex_id v)
{
    return par_map_put(&talk->vertex_at, v, talk->vertex.n) && par_ids_add(&talk->vertex, v);
}

bool par_talk_add_triangle(struct par_talk *talk, tri_triangle_id t)
{
    return par_map_put(&talk->triangle_at, t, talk->triangle.n) && par_ids_add(&talk->triangle, t);
}

bool par_talk_add_sub(struct par_talk *talk, const struct tri_mesh *mesh, tri_sub_id s)
{
    return par_map_put(&talk->sub_at, s, talk->sub.n) && par_ids_add(&talk->sub, s) &&
           par_ids_add(&talk->sub_end, mesh->sub[s].v[1]);
}

/* Returns the shared number of an id. TRI_NONE: it has none, or the item with this number has been deleted. */
static int32_t number_of(const struct par_map *map, const struct par_ids *list, int32_t id)
{
    int32_t number = par_map_get(map, id);
    return number != TRI_NONE && list->item[number] == id ? number : TRI_NONE;
}

int32_t par_talk_number(const struct par_talk *talk, tri_triangle_id t)
{
    return number_of(&talk->triangle_at, &talk->triangle, t);
}

void par_talk_free(struct par_talk *talk)
{
    free(talk->vertex.item);
    free(talk->triangle.item);
    free(talk->sub.item);
    free(talk->sub_end.item);
    par_map_free(&talk->vertex_at);
    par_map_free(&talk->triangle_at);
    par_map_free(&talk->sub_at);
    par_map_free(&talk->surrounded);
    *talk = (struct par_talk){0};
}

/* --- messages */

void par_message_free(struct par_message *m)
{
    free(m->gone.item);
    free(m->gone_subs.item);
    free(m->vertex);
    free(m->triangle);
    free(m->side);
    free(m->entry);
    *m = (struct par_message){0};
}

/* Gives a vertex the next shared number and adds it to the message. False: no memory. */
static bool tell_vertex(struct par_message *m, struct par_talk *talk, const struct tri_mesh *mesh, int32_t n_common,
                        tri_vertex_id v)
{
    if (!tri_grow(&m->vertex, &m->vertex_capacity, m->n_vertices + 1, sizeof *m->vertex) ||
        !par_talk_add_vertex(talk, v))
        return false;
    m->vertex[m->n_vertices++] = (struct par_told_vertex){v < n_common ? v : TRI_NONE, mesh->xy[v], mesh->feature[v],
                                                          mesh->on[v], mesh->vertex_markers[v]};
    return true;
}

/* Adds the subsegment at edge e of triangle t to the message, with t as the triangle on one of its sides. Gives the
 * subsegment a shared number if it has none. t has its number already. False: no memory. */
static bool tell_side(struct par_message *m, struct par_talk *talk, const struct tri_mesh *mesh, tri_triangle_id t,
                      int e)
{
    tri_sub_id s = ~mesh->tri[t].n[e];
    const struct tri_subsegment *sub = &mesh->sub[s];
    int side = sub->side[1] == tri_code(t, e);
    int32_t number = number_of(&talk->sub_at, &talk->sub, s);
    assert(sub->side[side] == tri_code(t, e));
    if (number == TRI_NONE) {
        number = talk->sub.n;
        m->n_new_subs++;
        if (!par_talk_add_sub(talk, mesh, s))
            return false;
    }
    if (!tri_grow(&m->side, &m->side_capacity, m->n_sides + 1, sizeof *m->side))
        return false;
    m->side[m->n_sides++] = (struct par_told_side){par_talk_number(talk, t), e, side, number, sub->marker,
                                                   sub->parent, sub->side[1 - side] == TRI_NONE};
    return true;
}

/* The renumbering of the talk's triangles from number `first` on, while they are added to a message. */
struct telling {
    struct par_message *message;
    struct par_talk *talk;
    const struct tri_mesh *mesh;
    int32_t n_common;         /* vertices of the coarse mesh */
    tri_triangle_id *waiting; /* [n] triangles by old number - first; TRI_NONE: has been added to the message */
    int32_t n, first;         /* number of triangles; their lowest number */
    struct par_ids stack;     /* triangles to visit, the next one last; may contain some that have been added */
};

/* Has t still to be added to the message? number: its old or its new number. */
static bool is_waiting(const struct telling *telling, tri_triangle_id t, int32_t number)
{
    int32_t place = number - telling->first;
    return place >= 0 && place < telling->n && telling->waiting[place] == t;
}

/* Returns the shared number of a neighbour t; TRI_NONE: t has not been sent or added before. If t has still to be added
 * to the message, pushes it on the stack. Sets *memory to false if memory runs out. */
static int32_t look_across(struct telling *telling, tri_triangle_id t, bool *memory)
{
    const struct par_talk *talk = telling->talk;
    int32_t number = par_map_get(&talk->triangle_at, t);
    if (number == TRI_NONE)
        return TRI_NONE;
    if (is_waiting(telling, t, number)) {
        __builtin_prefetch(&telling->mesh->tri[t]);
        *memory = par_ids_add(&telling->stack, t) && *memory;
        return TRI_NONE;
    }
    return number < talk->triangle.n && talk->triangle.item[number] == t ? number : TRI_NONE;
}

/* Adds t, which has the latest shared number, to the message with its new vertices and its subsegments. False: no
 * memory. */
static bool tell_triangle(struct telling *telling, tri_triangle_id t)
{
    struct par_message *m = telling->message;
    struct par_talk *talk = telling->talk;
    const struct tri_triangle *triangle = &telling->mesh->tri[t];
    struct par_told_triangle told = {.region = triangle->region};
    bool memory = true;
    for (int k = 0; memory && k < 3; k++) {
        told.v[k] = par_map_get(&talk->vertex_at, triangle->v[k]);
        if (told.v[k] == TRI_NONE) {
            told.v[k] = talk->vertex.n;
            memory = tell_vertex(m, talk, telling->mesh, telling->n_common, triangle->v[k]);
        }
        tri_link link = triangle->n[k];
        told.next[k] = link >= 0 ? look_across(telling, tri_of(link), &memory) : TRI_NONE;
        if (memory && link < 0 && link != TRI_BEYOND)
            memory = tell_side(m, talk, telling->mesh, t, k);
    }
    m->triangle[m->n_triangles++] = told;
    return memory;
}

/* Adds the waiting triangles that are connected with the seed, in depth-first order: most triangles are a neighbour of
 * their predecessor. False: no memory. */
static bool add_connected(struct telling *telling, tri_triangle_id seed)
{
    bool memory = par_ids_add(&telling->stack, seed);
    while (memory && telling->stack.n > 0) {
        tri_triangle_id t = telling->stack.item[--telling->stack.n];
        int32_t number = par_map_get(&telling->talk->triangle_at, t);
        if (!is_waiting(telling, t, number))
            continue;
        telling->waiting[number - telling->first] = TRI_NONE;
        memory = par_talk_add_triangle(telling->talk, t) && tell_triangle(telling, t);
    }
    return memory;
}

bool par_message_fill(struct par_message *m, struct par_talk *talk, const struct tri_mesh *mesh, int32_t n_common)
{
    const int32_t first = m->first;
    struct telling telling = {.message = m, .talk = talk, .mesh = mesh, .n_common = n_common,
                              .n = talk->triangle.n - first, .first = first};
    assert(m->n_triangles == 0 && telling.n >= 0);
    if (telling.n == 0)
        return true;
    telling.waiting = malloc((size_t)telling.n * sizeof *telling.waiting);
    bool memory = telling.waiting && tri_grow(&m->triangle, &m->triangle_capacity, telling.n, sizeof *m->triangle);
    if (memory)
        memcpy(telling.waiting, talk->triangle.item + first, (size_t)telling.n * sizeof *telling.waiting);
    talk->triangle.n = first;
    for (int32_t i = 0; memory && i < telling.n; i++)
        memory = telling.waiting[i] == TRI_NONE || add_connected(&telling, telling.waiting[i]);
    assert(!memory || talk->triangle.n == first + telling.n);
    free(telling.waiting);
    free(telling.stack.item);
    return memory;
}

bool par_message_add_entry(struct par_message *m, uint64_t key, int32_t triangle)
{
    if (!tri_grow(&m->entry, &m->entry_capacity, m->n_entries + 1, sizeof *m->entry))
        return false;
    m->entry[m->n_entries++] = (struct par_told_entry){key, triangle};
    return true;
}
