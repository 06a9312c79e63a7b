/* The last level of the schedule on several ranks with separate address spaces. The mesh is the same, tile by tile, as
 * that of one process. Each rank has made the coarse mesh and owns some tiles (territory.h).
 *
 * INVARIANT. Between phases, a rank holds exactly the triangles of the global mesh that have a corner in its tiles.
 * Links to other triangles are TRI_BEYOND. A triangle with corners in tiles of several ranks (a straddler) is held by
 * each of them. Each entry of the global worklist is held by at least one owner of a corner of its triangle.
 *
 * RULE. A block inside the tiles of one rank needs no communication. A block that overlaps tiles of several ranks is
 * refined by the owner of the first of them, which borrows ghost layers from the others. It pauses if a cavity may
 * reach beyond these layers (refine.h, struct tri_part). After the phase, changes are sent back and borrowed triangles
 * are dropped. The number of layers affects only the running time.
 *
 * THEOREM (docs/theory.md, ranks). The mesh equals that of one process. The data sent is proportional to the seams
 * between blocks of several ranks, not to the size of the mesh. */
#ifndef SCHED_RANKS_RANKS_H
#define SCHED_RANKS_RANKS_H

#include "sched/ranks/carrier.h"
#include "sched/ranks/talk.h"
#include "sched/ranks/territory.h"
#include "sched/schedule/phase.h"
#include "sched/tiles/tiles.h"

/* The assignment of the current phase's blocks to ranks. */
struct par_shift {
    const struct par_partition *partition; /* NULL: the whole plane is one block */
    int phase;
    int32_t step, n_steps; /* only every n_steps-th block, starting at block `step` */
    int *worker;     /* [blocks] the other rank that refines a block of which this rank owns a part; -1: none */
    bool *is_mine;   /* [blocks] as in struct par_share */
    bool *is_border; /* [blocks] this rank refines it, and others own a part */
    int32_t *block_of; /* [worklist.n] the block of each entry; TRI_NONE: no block of this phase */
    struct par_ids changed; /* triangles made by border blocks; may contain duplicates */
};

/* A hash table with open addressing: vertex ids by coordinates, or triangle ids by corners. */
struct par_index {
    bool is_of_places;
    int32_t *id;
    int32_t n, capacity;
};

enum { PAR_DONE = 3 + TRI_EXCUSES }; /* counters of the work done */

struct par_ranks {
    struct par_run *run;
    struct par_carrier *carrier;
    struct par_territory territory;
    struct par_ids straddlers;
    int32_t n_common;  /* vertices of the coarse mesh: the same ids on all ranks */
    struct par_shift shift;
    struct par_talk *lent, *borrowed; /* [n_ranks] */
    struct par_index places, triangles; /* index of straddlers and borrowed triangles */
    struct par_bytes *out, *in; /* [n_ranks] */
    uint64_t of_run;              /* hash of input and settings */
    struct tri_refine_report before; /* the report before the ranks began .. */
    int64_t left_before;       /* .. its left_over .. */
    int rounds_before;         /* .. and its rounds */
};

/* Collective, at the start of the schedule of the whole mesh. Cells, worklist and place must be the same on all ranks;
 * the number of threads may differ. Creates run->ranks and reduces the mesh to this rank's part, or restores part and
 * place from a checkpoint. TRI_NO_MEMORY, or as par_resume. */
enum tri_status par_ranks_begin(struct par_run *run, struct tri_error *error);

/* Collective: the rounds of a struct par_schedule, and the final call for triangles that they left over, which also
 * advances the place. All ranks return the same status. */
extern const struct par_steps par_steps_on_ranks;
enum tri_status par_refine_rest_on_ranks(struct par_run *run, struct tri_error *error);

/* Sets *first .. *end - 1 to the blocks of the first phase whose triangles this rank lists as work. It holds all
 * triangles of these blocks, and only some of other blocks. */
void par_ranks_own_blocks(const struct par_ranks *ranks, int32_t *first, int32_t *end);

/* Collective. Hands each rank's tiles to its sink. The sink of rank 0 also receives the coarse vertices. status: this
 * rank's status so far. All ranks return the same: TRI_NO_MEMORY, TRI_TOO_LARGE, TRI_STOPPED, or a sink's error. */
enum tri_status par_ranks_hand_out(struct par_run *run, enum tri_status status, struct tri_error *error);

/* Frees run->ranks. True: it existed, and the mesh must not be used any more. */
bool par_ranks_end(struct par_run *run);

/* Gets this rank's counters since par_ranks_begin; adds such counters to this rank's report. */
void par_count_done(const struct par_ranks *ranks, int64_t done[PAR_DONE]);
void par_add_done(struct par_ranks *ranks, const int64_t done[PAR_DONE]);

/* --- keep.c: checkpoints, if requested (sched/checkpoint/checkpoint.h) */

/* Collective. If a checkpoint exists, sets *again and replaces mesh, worklist, report and place by the saved ones.
 * TRI_BAD_INPUT: it belongs to another run, or is damaged. */
enum tri_status par_resume(struct par_ranks *ranks, bool *again, struct tri_error *error);

/* Collective, between two steps: writes a checkpoint if one is due or if a stop was requested; after a stop request,
 * returns TRI_STOPPED. After the first step, runs stop only between steps. status: the status of the step.
 * TRI_CANNOT_WRITE, TRI_NO_MEMORY. */
enum tri_status par_offer_checkpoint(struct par_ranks *ranks, enum tri_status status, struct tri_error *error);

/* --- borders.c: blocks that other ranks refine. Not collective: each fills `out` for the next exchange or reads `in`
 * of the last one. TRI_NO_MEMORY. */

/* out[w]: the ghost layers that rank w needs for its blocks. The entries of these blocks leave the worklist. */
enum tri_status par_lend(struct par_ranks *ranks, struct tri_error *error);

/* in[w]: vertices around which rank w needs more layers; out[w]: these layers. */
enum tri_status par_lend_more(struct par_ranks *ranks, struct tri_error *error);

/* in[w]: the changes that rank w has made to lent triangles. */
enum tri_status par_take_back(struct par_ranks *ranks, struct tri_error *error);

/* --- borders.c: blocks that this rank refines; not collective */

/* Inserts the triangles that a lender has sent into the mesh. */
enum tri_status par_borrow_from(struct par_ranks *ranks, struct par_talk *talk, const struct par_bytes *told,
                                struct tri_error *error);

/* in[h]: the triangles that rank h lends. */
enum tri_status par_borrow(struct par_ranks *ranks, struct tri_error *error);

/* out[h]: those of the vertices that rank h owns, to request more layers around them. */
enum tri_status par_request_layers(struct par_ranks *ranks, const struct par_ids *vertices, struct tri_error *error);

/* out[h]: the changes to what rank h lent, given the triangles made. Then drops the borrowed triangles. */
enum tri_status par_give_back(struct par_ranks *ranks, struct par_ids *changed, struct tri_error *error);

/* Drops all triangles without a corner in this rank's tiles. Called first, on the coarse mesh. */
enum tri_status par_keep_own(struct par_ranks *ranks, struct tri_error *error);

/* --- paste.c: shared by lenders and borrowers; not collective */

/* Returns [n_ranks] messages, to be filled with the items that the talks gain after this call. NULL: no memory. */
struct par_message *par_messages_begin(const struct par_ranks *ranks, const struct par_talk *talk);
/* Calls par_message_fill for each message. False: no memory. */
bool par_messages_fill(const struct par_ranks *ranks, struct par_talk *talk, struct par_message *message);
/* out[p]: the encoded message to rank p, unless it is empty. False: no memory. */
bool par_messages_send(struct par_ranks *ranks, const struct par_talk *talk, struct par_message *message);
void par_messages_free(const struct par_ranks *ranks, struct par_message *message);

/* Applies a message to the mesh and adds its contents to the talk. is_borrowed: some of them may be in the mesh
 * already, because several ranks lend the same straddlers. */
enum tri_status par_paste(struct par_ranks *ranks, struct par_talk *talk, const struct par_message *message,
                          bool is_borrowed, struct tri_error *error);

/* Removes deleted triangles, and those in `changed` (NULL: none), from the list of straddlers. */
void par_forget_straddlers(struct par_ranks *ranks, const struct par_triangle_set *changed);

/* Rebuilds the indices from the straddlers alone. False: no memory. */
bool par_index_straddlers(struct par_ranks *ranks);

/* Merges a message's entries into the worklist. False: no memory. */
bool par_merge_entries(struct par_run *run, const struct par_message *message, const struct par_talk *talk);

/* Removes a triangle, whose neighbours' links become TRI_BEYOND, or a subsegment without triangles. False: no
 * memory. */
bool par_remove_triangle(struct par_run *run, tri_triangle_id t);
bool par_remove_sub(struct par_run *run, tri_sub_id s);

static inline bool par_is_lone(const struct tri_subsegment *s) { return s->side[0] < 0 && s->side[1] < 0; }

/* While a worklist is filtered in place: keeps entry i by moving it to position *kept, which is incremented. */
static inline void par_keep_entry(struct par_run *run, int32_t i, int32_t *kept)
{
    run->key.item[*kept] = run->key.item[i];
    run->worklist.item[(*kept)++] = run->worklist.item[i];
}

/* Returns how many corners of t lie in this rank's tiles. */
int par_own_corners(const struct par_ranks *ranks, tri_triangle_id t);

/* --- hand_out.c */

/* Collective. Numbers the tiles of all ranks and hands each rank's tiles to its sink. */
enum tri_status par_hand_out_on_ranks(struct par_ranks *ranks, struct par_tiles *tiles, enum tri_status status,
                                      struct tri_error *error);

/* Hands out a mesh that each rank holds completely: the sink of rank 0 receives all tiles. */
enum tri_status par_whole_on_ranks(const struct par_carrier *carrier, struct par_tiles *tiles, struct tri_error *error);

#endif
