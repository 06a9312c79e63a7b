/* A piece of a mesh on its way from one address space to another: all triangles with a corner in a box, with their
 * vertices, their subsegments, and the entries of the worklist among them. One flat record that describes itself, the
 * same for whatever carries it; about 32 bytes a triangle.
 *
 * A vertex that both sides have had from the start goes by its number; the others go as they are, and are known again
 * by their place. Links do not travel: they follow from the corners.
 *
 * THEOREM. A mesh in which a fragment has been pasted agrees in the box with the mesh from which it was cut: the same
 * triangles have a corner there, and every edge with an end there is linked. For all triangles around a vertex in the
 * box have a corner there, so all of them are in the fragment; those that were there before go. An edge with no end in
 * the box belongs to the fragment's rim: it is linked if the triangle behind it is there, else it is PAR_BEYOND. */
#ifndef SCHED_RANKS_FRAGMENT_H
#define SCHED_RANKS_FRAGMENT_H

#include "sched/phase.h"
#include "sched/ranks/carrier.h"

enum { PAR_BEYOND = INT32_MIN }; /* a link to what is in another address space, never followed */


/* Appends what the state's mesh and worklist hold in the box. All keys of the worklist are told (par_keys_tell).
 * n_common: so many vertices were there from the start. TRI_NO_MEMORY: *to is as before. O(mesh). */
enum tri_status par_fragment_cut(struct par_bytes *to, const struct par_state *state, int32_t n_common,
                                 const struct tri_fence *box, struct tri_error *error);

/* Puts in place of what the state holds in a box what the fragment at the beginning of n bytes does; *used receives its
 * size. TRI_INTERNAL: these bytes are no fragment; TRI_NO_MEMORY, TRI_TOO_LARGE: nothing has changed. O(mesh). */
enum tri_status par_fragment_paste(struct par_state *state, int32_t n_common, const char *bytes, size_t n,
                                   size_t *used, struct tri_error *error);

/* Writes out the keys of a worklist that no block has had. False: no memory. */
bool par_keys_tell(struct par_state *state);

/* The worklist keeps the entries that have a corner in the box. */
void par_worklist_keep(struct par_state *state, const struct tri_fence *box);

#endif
