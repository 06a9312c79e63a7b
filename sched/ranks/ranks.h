/* The schedule's last level on several ranks, each in an address space of its own: the same mesh, tile for tile, as
 * one process makes.
 *
 * Every rank has made the coarse mesh, and owns some odd columns of blocks that lie side by side: these are its
 * tiles.
 *
 * INVARIANT. Between steps a rank's mesh holds the true triangles with a corner in its columns, and the worklist's
 * entries among them; what else is in its arrays is coarse, or old, and never looked at.
 *
 * A block may be refined wherever the invariant is brought about for its box: blocks change triangles inside their
 * box alone, and read those that share an edge with one, which have two corners there. So before a block over the
 * columns of several ranks has its turn, the others send what they hold in its box (fragment.h) to the one who does
 * it, and get that back afterwards. Blocks of odd columns, and of even ones between two columns of one rank, ask for
 * nothing. An even column on the border of two ranks is done by the left one. Blocks of later rounds, which are
 * larger and have work only where something is left over, are all done by rank 0, phase by phase; boxes without work
 * stay where they are. By the theorem on the order of columns (phase.h) the mesh is that of one process: worklists
 * are kept in the order of their keys, which do not depend on who left what. */
#ifndef SCHED_RANKS_RANKS_H
#define SCHED_RANKS_RANKS_H

#include "sched/phase.h"
#include "sched/ranks/carrier.h"
#include "sched/sweep/tiles.h"

struct par_ranks {
    struct par_state *state;
    struct par_carrier *carrier;
    const struct par_partition *partition;
    int32_t n_odd;     /* odd columns: number i is column 2 i + 1 */
    int32_t *start;    /* [n_ranks + 1] rank p owns odd columns start[p] .. start[p + 1] - 1 */
    int32_t n_common;  /* vertices that all ranks have by the same numbers */
    struct par_bytes *out, *in; /* [n_ranks] */
};

/* Collective. Refines what is in the state's worklist, the same on all ranks, and hands each rank its own tiles: the
 * sink of rank 0 gets the vertices that there were before, too. *tiles is as par_tiles_begin takes it. Afterwards the
 * state's mesh is to be freed and no more. All ranks return the same status: TRI_NO_MEMORY, TRI_TOO_LARGE, TRI_STOPPED,
 * or what a sink says. */
enum tri_status par_refine_on_ranks(struct par_state *state, const struct par_partition *partition,
                                    struct par_tiles *tiles, struct tri_error *error);

/* The box of what rank p owns; nothing lies in that of a rank without columns. */
struct tri_fence par_box_of(const struct par_ranks *ranks, int p);

/* Who owns odd column number i. */
int par_owner_of_column(const struct par_ranks *ranks, int32_t i);

/* What the others will get: appends to out[to] what lies in the box. */
enum tri_status par_ranks_cut(struct par_ranks *ranks, int to, const struct tri_fence *box, struct tri_error *error);

/* Collective: sends all that, and puts what comes in its place. */
enum tri_status par_ranks_swap(struct par_ranks *ranks, enum par_move move, enum tri_status status,
                               struct tri_error *error);

/* Both phases of a column. */
enum tri_status par_ranks_column(struct par_ranks *ranks, int32_t column, struct tri_error *error);

/* Collective: the even columns at the borders of ranks: borders.c. */
enum tri_status par_ranks_borders(struct par_ranks *ranks, enum tri_status status, struct tri_error *error);

/* Collective. Numbers the tiles, and hands them out: hand_out.c. */
enum tri_status par_hand_out_on_ranks(struct par_ranks *ranks, struct par_tiles *tiles, enum tri_status status,
                                      struct tri_error *error);

/* Hands out a mesh that each rank has as a whole: the sink of rank 0 gets all tiles. */
enum tri_status par_whole_on_ranks(const struct par_carrier *carrier, struct par_tiles *tiles, struct tri_error *error);

#endif
