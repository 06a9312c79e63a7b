/* The schedule's last level on several ranks, each in an address space of its own: the same mesh, tile for tile, as one
 * process makes. Every rank has made the coarse mesh, and owns some tiles (territory.h).
 *
 * INVARIANT. Between phases a rank's mesh is the triangles of the true one that have a corner in its tiles, and no
 * others; links to others are TRI_BEYOND. Triangles that have corners of other ranks, too (straddlers), are in the mesh
 * of each of these. Each entry of the true worklist is with at least one of the ranks that own a corner of its
 * triangle.
 *
 * RULE. A block in the tiles of one rank asks for nothing. A block over the tiles of several is done by the owner of
 * the first of these tiles, who borrows from the others, and pauses where a cavity may reach behind what it has
 * (refine.h, struct tri_part). After the phase the others are told what has changed, and borrowed triangles are
 * dropped. So how much is lent decides nothing but the time it takes.
 *
 * THEOREM (docs/theory.md, ranks). The mesh is that of one process. What moves is in proportion to the seams between
 * blocks of several ranks, not to the mesh. */
#ifndef SCHED_RANKS_RANKS_H
#define SCHED_RANKS_RANKS_H

#include "sched/ranks/carrier.h"
#include "sched/ranks/talk.h"
#include "sched/ranks/territory.h"
#include "sched/schedule/phase.h"
#include "sched/tiles/tiles.h"

/* Who does the blocks of the phase at hand. */
struct par_shift {
    const struct par_partition *partition; /* NULL: there is one block, the plane */
    int phase;
    int32_t step, n_steps; /* only every n_steps-th block, from the step-th on */
    int *worker;     /* [blocks] the other rank that works on it, of those of which this one holds a part; else -1 */
    bool *is_mine;   /* [blocks] as struct par_share has it */
    bool *is_border; /* [blocks] this rank works on it, and others hold a part */
    int32_t *block_of; /* [worklist.n] of each entry; TRI_NONE: none of this phase takes it */
    struct par_ids changed; /* triangles made by blocks at a border, some of them several times */
};

/* Ids by what they stand for, open addressing: vertices by their places, or triangles by their corners. */
struct par_index {
    bool is_of_places;
    int32_t *id;
    int32_t n, capacity;
};

enum { PAR_DONE = 3 + TRI_EXCUSES }; /* numbers that tell what has been done */

struct par_ranks {
    struct par_run *run;
    struct par_carrier *carrier;
    struct par_territory territory;
    struct par_ids straddlers;
    int32_t n_common;  /* vertices that all ranks have by the same numbers */
    struct par_shift shift;
    struct par_talk *lent, *borrowed; /* [n_ranks] */
    struct par_index places, triangles; /* of the straddlers and of what is borrowed */
    struct par_bytes *out, *in; /* [n_ranks] */
    uint64_t of_run;              /* a hash of what all ranks began with */
    struct tri_refine_report before; /* the report of what came before that .. */
    int64_t left_before;       /* .. its left_over .. */
    int rounds_before;         /* .. and its rounds */
};

/* Collective. When the schedule of the whole mesh begins: cells, worklist and place are the same on all ranks, the
 * executor's threads need not be. Then run->ranks is there, and the mesh is this rank's part of it, or that and the
 * place are what has been kept. TRI_NO_MEMORY, or as par_take_up. */
enum tri_status par_ranks_begin(struct par_run *run, struct tri_error *error);

/* Collective: the rounds of a struct par_schedule, and the call for what they leave, after which the place is what
 * follows. All ranks return the same status. */
extern const struct par_steps par_steps_on_ranks;
enum tri_status par_refine_rest_on_ranks(struct par_run *run, struct tri_error *error);

/* The blocks of the first phase whose triangles this rank lists as work: from *first to *end - 1. All of them are here,
 * as they are in the mesh of one process; of the others some are. */
void par_ranks_own_blocks(const struct par_ranks *ranks, int32_t *first, int32_t *end);

/* Collective. Hands each rank its own tiles: the sink of rank 0 gets the vertices that there were before, too. status:
 * how this rank has fared. All return the same: TRI_NO_MEMORY, TRI_TOO_LARGE, TRI_STOPPED, or what a sink says. */
enum tri_status par_ranks_hand_out(struct par_run *run, enum tri_status status, struct tri_error *error);

/* Frees run->ranks; was there any? Then the mesh is of no use any more. */
bool par_ranks_end(struct par_run *run);

/* What this rank has done since its ranks began; the same of others joins its report. */
void par_count_done(const struct par_ranks *ranks, int64_t done[PAR_DONE]);
void par_add_done(struct par_ranks *ranks, const int64_t done[PAR_DONE]);

/* --- keep.c: checkpoints, where they are wanted (sched/checkpoint/checkpoint.h) */

/* Collective. Where there is a state, *again: mesh, worklist, report and place are what they were; what there is now
 * goes. TRI_BAD_INPUT: it is another run's, or damaged. */
enum tri_status par_take_up(struct par_ranks *ranks, bool *again, struct tri_error *error);

/* Collective, between two steps: keeps all that where it is time to, or somebody asks for the end; then returns
 * TRI_STOPPED. Once there has been a step, nobody is stopped in the midst of one. status: how the step has ended.
 * TRI_CANNOT_WRITE, TRI_NO_MEMORY. */
enum tri_status par_keep(struct par_ranks *ranks, enum tri_status status, struct tri_error *error);

/* --- borders.c: what others work on. Every one fills or reads what is exchanged next; no memory: TRI_NO_MEMORY. */

/* out[w]: what rank w has to know for its blocks. Their entries leave the worklist. */
enum tri_status par_lend(struct par_ranks *ranks, struct tri_error *error);

/* in[w]: vertices around which rank w has to know more; out[w]: that. */
enum tri_status par_lend_more(struct par_ranks *ranks, struct tri_error *error);

/* in[w]: what has become of it. */
enum tri_status par_take_back(struct par_ranks *ranks, struct tri_error *error);

/* --- borders.c: what this rank works on */

/* What somebody has told of to lend it: from then on it is here. */
enum tri_status par_borrow_from(struct par_ranks *ranks, struct par_talk *talk, const struct par_bytes *told,
                                struct tri_error *error);

/* in[h]: what rank h lends. */
enum tri_status par_borrow(struct par_ranks *ranks, struct tri_error *error);

/* out[h]: of rank h's vertices those around which more has to be known. */
enum tri_status par_ask(struct par_ranks *ranks, const struct par_ids *vertices, struct tri_error *error);

/* out[h]: what has become of it, given the triangles made. It is dropped here. */
enum tri_status par_give_back(struct par_ranks *ranks, struct par_ids *changed, struct tri_error *error);

/* Drops all triangles without an own corner: the first thing to do. */
enum tri_status par_keep_own(struct par_ranks *ranks, struct tri_error *error);

/* --- paste.c: what both have in common */

/* A message to each rank that tells of what joins the talks from here on; NULL: no memory. */
struct par_message *par_messages_begin(const struct par_ranks *ranks, const struct par_talk *talk);
/* par_message_tell for each. False: no memory. */
bool par_messages_tell(const struct par_ranks *ranks, struct par_talk *talk, struct par_message *message);
/* out[p]: what the message to rank p says, if it says anything. False: no memory. */
bool par_messages_send(struct par_ranks *ranks, const struct par_talk *talk, struct par_message *message);
void par_messages_free(const struct par_ranks *ranks, struct par_message *message);

/* All that a message tells of is put into the mesh, and counted in the talk. is_borrowed: some of it may be here
 * already, and more of it may come from others. */
enum tri_status par_paste(struct par_ranks *ranks, struct par_talk *talk, const struct par_message *message,
                          bool is_borrowed, struct tri_error *error);

/* Those that are no more, or (NULL: none) are in a set, leave the list of straddlers. */
void par_forget_straddlers(struct par_ranks *ranks, const struct par_triangle_set *changed);

/* The straddlers, and nothing else. False: no memory. */
bool par_index_straddlers(struct par_ranks *ranks);

/* A message's entries join the worklist. False: no memory. */
bool par_merge_entries(struct par_run *run, const struct par_message *message, const struct par_talk *talk);

/* A triangle goes, or a subsegment that has no triangle any more: what leads to it leads beyond. */
bool par_remove_triangle(struct par_run *run, tri_triangle_id t);
bool par_remove_sub(struct par_run *run, tri_sub_id s);

static inline bool par_is_lone(const struct tri_subsegment *s) { return s->side[0] < 0 && s->side[1] < 0; }

/* Of a worklist that is gone through entry i stays: as the next one, of *kept so far. */
static inline void par_keep_entry(struct par_run *run, int32_t i, int32_t *kept)
{
    run->key.item[*kept] = run->key.item[i];
    run->worklist.item[(*kept)++] = run->worklist.item[i];
}

/* How many corners of a triangle are this rank's own? */
int par_own_corners(const struct par_ranks *ranks, tri_triangle_id t);

/* --- hand_out.c */

/* Collective. Numbers the tiles, and hands them out. */
enum tri_status par_hand_out_on_ranks(struct par_ranks *ranks, struct par_tiles *tiles, enum tri_status status,
                                      struct tri_error *error);

/* Hands out a mesh that each rank has as a whole: the sink of rank 0 gets all tiles. */
enum tri_status par_whole_on_ranks(const struct par_carrier *carrier, struct par_tiles *tiles, struct tri_error *error);

#endif
