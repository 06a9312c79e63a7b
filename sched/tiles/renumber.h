/* What the files of the numbering share: numbering.c (all but triangles), sort_triangles.c, move_triangles.c.
 *
 * A triangle is *turned* when it starts at another of its corners: then it is told by 31 bits, a number with the corner
 * that will be the first. An item is what is sorted, in the lower 31 bits, with the key that it is sorted by above.
 * A tile has an index here, in the order of tiles. */
#ifndef SCHED_TILES_RENUMBER_H
#define SCHED_TILES_RENUMBER_H

#include <assert.h>

#include "sched/schedule/partition.h"
#include "sched/tiles/deal.h"
#include "triangle/mesh/mesh.h"

enum { CORNER_BITS = 2, VALUE_BITS = 31 };

_Static_assert(INT64_C(1) << VALUE_BITS == (int64_t)TRI_MAX_TRIANGLES << CORNER_BITS, "turned triangles fill the bits");

static inline uint64_t item_of(int32_t key, int32_t value) { return (uint64_t)key << VALUE_BITS | (uint64_t)value; }
static inline int32_t key_of(uint64_t item) { return (int32_t)(item >> VALUE_BITS); }
static inline int32_t value_of(uint64_t item) { return (int32_t)(item & ((UINT64_C(1) << VALUE_BITS) - 1)); }

static inline int32_t turn(int32_t number, int corner) { return number << CORNER_BITS | corner; }
static inline int32_t number_in(int32_t turned) { return turned >> CORNER_BITS; }
static inline int corner_in(int32_t turned) { return turned & 3; }

struct par_numbering {
    struct tri_mesh *mesh;
    const struct par_partition *partition;
    const struct tri_executor *executor;
    int32_t n_kept;     /* the vertices that keep their numbers */
    int32_t n_tiles;
    int32_t *kept_tile; /* [n_kept] */
    struct par_deal vertices, triangles; /* new vertices; all triangles */
    int32_t n_new, n_tri, n_subs; /* new vertices, triangles and subsegments that are not free */
    /* Memory that serves several times, by several names: each until the next is needed. */
    union {
        int32_t *order;   /* [n_vertices - n_kept] the new vertices, one after the other */
        int32_t *fan_end; /* of the triangles that start at each */
        struct tri_triangle *buffer; /* [batch] */
    };
    union {
        int32_t *tile_of; /* [n_vertices] of a new vertex; TRI_NONE: the id is free */
        int32_t *number;  /* the new one of each */
    };
    union {
        int32_t *key;     /* [n_triangles] see sort_triangles.c */
        int32_t *place;   /* turned: where it goes; TRI_NONE: the id is free */
    };
    int32_t *dealt;      /* [n_triangles] turned, tile by tile, in the end in their new order */
    int32_t *sub_number; /* [n_subs] */
    struct tri_subsegment *sub; /* [n_subs] */
    void *scratch;       /* what is sorted, vertices on their way, triangles set aside */
    int32_t batch;       /* triangles that move at once */
};

/* The tile of a new number. */
static inline int32_t tile_of_number(const struct par_numbering *n, int32_t number)
{
    if (number < n->n_kept)
        return n->kept_tile[number];
    return par_holder_of(n->vertices.start, n->n_tiles, number - n->n_kept);
}

/* A half-edge where all triangles have their places. */
static inline tri_halfedge new_code(const int32_t *place_of_triangle, tri_halfedge code)
{
    static const uint8_t edge_of[4][4] = {{0, 1, 2}, {2, 0, 1}, {1, 2, 0}};
    int32_t place = place_of_triangle[tri_of(code)];
    return tri_code(number_in(place), edge_of[corner_in(place)][tri_edge(code)]);
}

/* The new order of triangles (sort_triangles.c), where the numbers of vertices are known: n->dealt, n->place and
 * n->n_tri; n->triangles.at begins with how many triangles of each tile move down. Of n->scratch it takes so many
 * bytes. Cannot fail. */
void par_sort_triangles(struct par_numbering *n);
size_t par_sort_triangles_scratch(const struct tri_mesh *mesh);

/* Triangles go to their places, and refer to new numbers (move_triangles.c). n->buffer holds n->batch triangles,
 * n->scratch half of all. Cannot fail. */
void par_move_triangles(const struct par_numbering *n);

/* How many triangles are to move at once. */
int32_t par_move_batch(int32_t n_triangles);

#endif
