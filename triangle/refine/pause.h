/* A refiner between two runs: all that the next run depends on, beside the mesh and the options. Who keeps it in a file
 * keeps the struct and then the arrays; who reads it gives it to a new refiner. */
#ifndef TRIANGLE_REFINE_PAUSE_H
#define TRIANGLE_REFINE_PAUSE_H

#include <stdbool.h>

#include "triangle/refine/bad_queue.h"
#include "triangle/refine/quality.h"
#include "triangle/refine/refine.h"

struct tri_pause {
    struct tri_refine_report report;
    struct tri_bounds bounds; /* for the angle that is worked for now */
    int32_t stage, step, limit, next_listed, n_worklist, in_hand; /* see refine.c */
    struct tri_entry hand;
    struct tri_bad_queue queue;
    tri_sub_id *encroached;
    int32_t n_encroached, encroached_capacity;
};

/* The refiner's arrays are borrowed, until it runs again or is freed. */
void tri_refiner_show(const struct tri_refiner *refiner, struct tri_pause *pause);

/* The same with arrays of the pause's own: the refiner can be freed and nothing else. */
void tri_refiner_leave(struct tri_refiner *refiner, struct tri_pause *pause);

/* What a new refiner of the same options, on the mesh as it was, goes on with: the arrays are its own then. The report
 * becomes what it was. */
void tri_refiner_go_on(struct tri_refiner *refiner, struct tri_pause *pause);

enum { TRI_PAUSE_ARRAYS = 4, TRI_PAUSE_LAST_STAGE = 2, TRI_PAUSE_LAST_STEP = 2 }; /* as refine.c has them */

struct tri_pause_array {
    void *at;
    size_t bytes; /* in use */
};

void tri_pause_arrays(const struct tri_pause *pause, struct tri_pause_array array[TRI_PAUSE_ARRAYS]);

/* The same without the arrays, every byte of it set: as it can be written and compared. */
void tri_pause_head(const struct tri_pause *pause, struct tri_pause *head);

/* Could this be such a head of a refiner on a mesh with so many triangles and subsegments, with so many in its worklist
 * (all triangles, where there is none)? */
bool tri_pause_is_head(const struct tri_pause *head, int64_t n_triangles, int64_t n_subs, int64_t n_worklist);

/* Gives a head arrays of its own, to be filled. False: no memory, and it has none. */
bool tri_pause_reserve(struct tri_pause *head);

void tri_pause_free(struct tri_pause *pause);

/* Frees one that lies in memory of its own, too; NULL afterwards, or before. */
void tri_pause_drop(struct tri_pause **pause);

#endif
