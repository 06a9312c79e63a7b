/* A talk: the vertices, triangles and subsegments that two ranks have sent each other, each exactly once. Both ranks
 * number them alike, in the order of sending, so later messages refer to them by these shared numbers.
 *
 * A message is read and validated as a whole before the mesh is changed. Numbers are encoded as differences, which are
 * small because neighbours in the plane are sent one after the other. Coordinates are encoded as the bits in which they
 * differ from those of the previous vertex. A triangle beside the previous one shares two corners with it, which are
 * not sent again. A new vertex takes about 20 bytes and a triangle about 3. A vertex of the coarse mesh, which all
 * ranks hold from the start, is sent as its number there. */
#ifndef SCHED_RANKS_TALK_H
#define SCHED_RANKS_TALK_H

#include "sched/ranks/carrier.h"
#include "sched/schedule/worklist.h"
#include "sched/tunables.h"
#include "triangle/mesh/mesh.h"

/* A map from ids to shared numbers. Ids near a border are clustered, so pages are allocated only where used. */
struct par_map {
    int32_t **page;      /* [n] PAR_PAGE values each; NULL: no id of this page is in the map */
    int32_t n, capacity; /* pages */
};

bool par_map_put(struct par_map *map, int32_t key, int32_t value); /* false: no memory */
void par_map_free(struct par_map *map);

/* Returns the number of an id; TRI_NONE: it is not in the map. */
static inline int32_t par_map_get(const struct par_map *map, int32_t key)
{
    const int32_t *page = key / PAR_PAGE < map->n ? map->page[key / PAR_PAGE] : NULL;
    return page ? page[key % PAR_PAGE] : TRI_NONE;
}

/* One side of a talk. Both sides hold the same shared numbers, each with its own ids. */
struct par_talk {
    struct par_ids vertex, triangle, sub; /* ids by shared number; TRI_NONE: deleted (not vertices) */
    struct par_ids sub_end;               /* end vertex of each subsegment when it was sent */
    struct par_map vertex_at, triangle_at, sub_at; /* shared numbers by id */
    struct par_map surrounded; /* vertices all of whose triangles have been sent: number of layers sent at once */
};

/* Each gives the next shared number to an id. False: no memory. */
bool par_talk_add_vertex(struct par_talk *talk, tri_vertex_id v);
bool par_talk_add_triangle(struct par_talk *talk, tri_triangle_id t);
bool par_talk_add_sub(struct par_talk *talk, const struct tri_mesh *mesh, tri_sub_id s);

/* Returns the number of a triangle that has not changed since it was sent; TRI_NONE: it has none. */
int32_t par_talk_number(const struct par_talk *talk, tri_triangle_id t);

void par_talk_free(struct par_talk *talk);

/* --- messages */

struct par_told_vertex {
    int32_t common; /* its number in the coarse mesh; TRI_NONE: a newer vertex, given by the fields below */
    struct tri_point xy;
    double feature;
    int32_t on, marker;
};

struct par_told_triangle {
    int32_t v[3];   /* numbers of vertices */
    int32_t next[3]; /* numbers of the neighbours; TRI_NONE: not sent before this triangle */
    int32_t region;
};

/* Returns the edge of the triangle with corners v that runs from `from` to `to`; -1: no edge does. */
static inline int par_edge_between(const int32_t v[3], int32_t from, int32_t to)
{
    for (int e = 0; e < 3; e++)
        if (v[tri_next[e]] == from && v[tri_prev[e]] == to)
            return e;
    return -1;
}

struct par_told_side { /* a triangle beside a subsegment */
    int32_t triangle, edge, side, sub; /* numbers */
    int32_t marker, parent; /* only for a new subsegment */
    bool is_boundary;       /* no triangle on its other side */
};

struct par_told_entry { /* an entry of the worklist */
    uint64_t key;
    int32_t triangle;
};

struct par_message {
    int32_t first;                  /* triangles with this shared number or a later one are sent */
    struct par_ids gone, gone_subs; /* shared numbers of deleted triangles and subsegments */
    struct par_told_vertex *vertex;
    struct par_told_triangle *triangle;
    struct par_told_side *side;
    struct par_told_entry *entry;
    int32_t n_vertices, n_triangles, n_sides, n_entries, n_new_subs;
    int32_t vertex_capacity, triangle_capacity, side_capacity, entry_capacity;
};

void par_message_free(struct par_message *message);

/* Adds the talk's triangles from number message->first on, which were just added to it, to the message. Renumbers them
 * so that most are adjacent to their predecessor. n_common: number of vertices of the coarse mesh. False: no memory. */
bool par_message_fill(struct par_message *message, struct par_talk *talk, const struct tri_mesh *mesh,
                      int32_t n_common);

bool par_message_add_entry(struct par_message *message, uint64_t key, int32_t triangle);

/* Appends the encoded message to `to`. Its contents must be in the talk already. False: no memory. */
bool par_message_write(struct par_message *message, const struct par_talk *talk, const struct tri_mesh *mesh,
                       int32_t n_common, struct par_bytes *to);

/* Decodes and validates a message of the other rank. The talk is not changed. TRI_INTERNAL: the message is invalid;
 * TRI_NO_MEMORY. */
enum tri_status par_message_read(struct par_message *message, const struct par_talk *talk, const struct tri_mesh *mesh,
                                 int32_t n_common, const struct par_bytes *from, struct tri_error *error);

#endif
