/* What two ranks know of each other's meshes, by numbers that both count in the same way: the vertices, triangles and
 * subsegments of which one has told the other since the talk began. Nothing is told twice.
 *
 * A message is read as a whole and looked through before anything is done. Numbers in it are told as differences, which
 * are small since what lies side by side in the plane is told one after the other, and places as the bits in which they
 * differ from the last; two corners of a triangle beside one that has just been told are known. So a new vertex takes
 * about 20 bytes, and a triangle about 3. A vertex that all ranks have had from the start goes by its number there. */
#ifndef SCHED_RANKS_TALK_H
#define SCHED_RANKS_TALK_H

#include "sched/ranks/carrier.h"
#include "sched/schedule/worklist.h"
#include "sched/tunables.h"
#include "triangle/mesh/mesh.h"

/* From ids to numbers. What lies at a border has ids that lie together: so there are pages where there are any. */
struct par_map {
    int32_t **page;
    int32_t n, capacity;
};

bool par_map_put(struct par_map *map, int32_t key, int32_t value); /* false: no memory */
void par_map_free(struct par_map *map);

/* TRI_NONE: it is not there. */
static inline int32_t par_map_get(const struct par_map *map, int32_t key)
{
    const int32_t *page = key / PAR_PAGE < map->n ? map->page[key / PAR_PAGE] : NULL;
    return page ? page[key % PAR_PAGE] : TRI_NONE;
}

/* One side of a talk. */
struct par_talk {
    struct par_ids vertex, triangle, sub; /* ids here; of triangles and subsegments that are no more TRI_NONE */
    struct par_ids sub_end;               /* where each subsegment ended when it was told */
    struct par_map vertex_at, triangle_at, sub_at; /* their numbers */
    struct par_map surrounded; /* vertices of which all triangles have been told: with how many layers at once */
};

bool par_talk_add_vertex(struct par_talk *talk, tri_vertex_id v);
bool par_talk_add_triangle(struct par_talk *talk, tri_triangle_id t);
bool par_talk_add_sub(struct par_talk *talk, const struct tri_mesh *mesh, tri_sub_id s);

/* The number of a triangle that is as it was told; TRI_NONE: there is none. */
int32_t par_talk_number(const struct par_talk *talk, tri_triangle_id t);

void par_talk_free(struct par_talk *talk);

/* --- messages */

struct par_told_vertex {
    int32_t common; /* its number from the start; else TRI_NONE, and what follows */
    struct tri_point xy;
    double feature;
    int32_t on, marker;
};

struct par_told_triangle {
    int32_t v[3];   /* numbers of vertices */
    int32_t next[3]; /* of triangles across each edge that have been told before, or TRI_NONE: not told so far */
    int32_t region;
};

/* The edge of a triangle, by its corners, that runs from `from` to `to`; -1: none does. */
static inline int par_edge_between(const int32_t v[3], int32_t from, int32_t to)
{
    for (int e = 0; e < 3; e++)
        if (v[tri_next[e]] == from && v[tri_prev[e]] == to)
            return e;
    return -1;
}

struct par_told_side { /* a triangle beside a subsegment */
    int32_t triangle, edge, side, sub; /* numbers */
    int32_t marker, parent; /* of a subsegment that is new */
    bool is_boundary;       /* there is nothing on its other side */
};

struct par_told_entry { /* of the worklist */
    uint64_t key;
    int32_t triangle;
};

struct par_message {
    int32_t first;                  /* to tell of: the talk's triangles from this number on */
    struct par_ids gone, gone_subs; /* numbers of triangles and subsegments that are no more */
    struct par_told_vertex *vertex;
    struct par_told_triangle *triangle;
    struct par_told_side *side;
    struct par_told_entry *entry;
    int32_t n_vertices, n_triangles, n_sides, n_entries, n_new_subs;
    int32_t vertex_capacity, triangle_capacity, side_capacity, entry_capacity;
};

void par_message_free(struct par_message *message);

/* Tells of the talk's triangles from number message->first on, which have just been added, and numbers them anew: most
 * lie beside the one before then. False: no memory. n_common: so many vertices were there from the start. */
bool par_message_tell(struct par_message *message, struct par_talk *talk, const struct tri_mesh *mesh,
                      int32_t n_common);

bool par_message_add_entry(struct par_message *message, uint64_t key, int32_t triangle);

/* Appends a message, which the talk holds already. False: no memory. */
bool par_message_write(struct par_message *message, const struct par_talk *talk, const struct tri_mesh *mesh,
                       int32_t n_common, struct par_bytes *to);

/* Reads what another side has written; talk is as it was before it. TRI_INTERNAL: it is no message, TRI_NO_MEMORY. */
enum tri_status par_message_read(struct par_message *message, const struct par_talk *talk, const struct tri_mesh *mesh,
                                 int32_t n_common, const struct par_bytes *from, struct tri_error *error);

#endif
