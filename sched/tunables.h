/* The numbers by which the schedule is fast or takes little memory. Only those of the first section decide where blocks
 * are, and so what a mesh looks like; more of that kind are in triangle/tunables.h. Each was measured, or guessed and
 * not found wrong. docs/performance-history.md has the measurements. */
#ifndef SCHED_TUNABLES_H
#define SCHED_TUNABLES_H

/* --- cells, which decide on meshes */

/* Final triangles of a cell: those of the mesh over the first, within the others. Measured: small cells keep many
 * threads busy, large ones make fewer seams. */
#define PAR_CELLS_WANTED 128.0
#define PAR_SMALLEST_CELL 8192.0
#define PAR_LARGEST_CELL 65536.0
/* Cells that are worth a schedule; and one for a coarse mesh. Guess. */
#define PAR_FEWEST_CELLS 8
#define PAR_FEWEST_COARSE_CELLS 32
/* Of the fewest triangles that are worth a schedule, a share that one call makes at once to see whether they come.
 * Guess. */
#define PAR_A_LITTLE 0.25
/* Coarse triangles that a cell has after pre-refinement. Measured: enough for seams to be narrow, few enough for
 * pre-refinement to take a few thousandths of the time. */
#define PAR_COARSE_PER_CELL 64.0

/* Samples of the work for each cell. Guess. */
#define PAR_SAMPLES_PER_CELL 32
/* Columns and rows are chosen anew where the work is so many times more drawn out than the box of the points. Guess. */
#define PAR_SKEW 8.0

/* --- room for blocks */

/* Triangles that a worklist becomes in each phase, over those that its work says. Measured: the rest is left at the
 * seams. */
#define PAR_DONE_IN_PHASES {0.9, 0.38, 0.42, 0.35}
/* Items of a range at least. Guess. */
#define PAR_LEAST_RANGE 64
/* Share of the points to come that lie on segments, at least. Guess. */
#define PAR_LEAST_ON_SEGMENTS 0.125
/* Free ids in a column that has gone are forgotten in runs shorter than this: a run takes the room of two ids.
 * Guess. */
#define PAR_SHORTEST_RUN 8

/* --- memory */

/* Share of the triangles that one mesh may have up to which an estimate does not ask for more than it has. Guess. */
#define PAR_SURELY_ONE_MESH 0.8
/* Of a bound on memory, what grows between two growths of the arrays: a share, and bytes at least, since a library that
 * writes files brings code and buffers with the first one. Guess. */
#define PAR_TO_COME 0.1
#define PAR_TO_COME_BYTES 8e6
/* Share of what all else leaves of the bound for pages of parked arrays before they are unmapped. Guess. */
#define PAR_TOUCHED 0.3
/* Bytes by which a file of a parked array grows, and nanoseconds between two looks at the memory in use. Guess. */
#define PAR_PARK_GROWTH (1 << 18)
#define PAR_LOOK_NANOSECONDS 1000000

/* --- what a run takes, by which others plan; all of it measured */

/* Share of the triangles which angles ask for that blocks get places for and leave empty. */
#define PAR_EMPTY_PLACES 0.25
/* Bytes of a sweep: for each root of (triangles * triangles in a cell), all that it has in memory; those of the mesh on
 * disk, with room to grow; what numbers and hands out columns; the two states of a checkpoint. And, for each triangle
 * to come, the coarse mesh and the lists of blocks. */
#define PAR_SWEEP_HELD 260.0
#define PAR_SWEEP_AWAY 290.0
#define PAR_SWEEP_WORK 140.0
#define PAR_SWEEP_STATES 520.0
#define PAR_SWEEP_COARSE 1.3
/* Bytes for each triangle: of a parked mesh in memory, and on disk; of the two states of a mesh that stays as a whole;
 * of the tiles in a checkpoint. */
#define PAR_PARKED_WORK 6.0
#define PAR_PARKED_BYTES 90.0
#define PAR_WHOLE_STATES 120.0
#define PAR_TILES_BYTES 26.0
/* The busiest rank has so many times the average. Bytes for each of its triangles: all that it has in memory; what
 * numbers and hands them out at most. What that takes for each root as above; and, for each triangle of all ranks, the
 * coarse mesh, and the two states of a checkpoint. */
#define PAR_RANK_BUSIEST 1.15
#define PAR_RANK_BYTES 62.0
#define PAR_RANK_WORK 20.0
#define PAR_RANK_COLUMN 45.0
#define PAR_RANK_COARSE 0.1
#define PAR_RANK_STATES 32.0

/* --- tiles */

/* Items of a mesh without tiles that are handed out at a time. Guess. */
#define PAR_ITEMS_AT_ONCE (1 << 16)
/* Triangles that move at once when a mesh is numbered: in a large one, so many that threads wait for each other seldom;
 * one in so many of a small one. Guess. */
#define PAR_MOST_MOVE (1 << 18)
#define PAR_FEWEST_BATCHES 16
/* Triangles that start at one corner are sorted by insertion, or on the stack, up to so many. Guess. */
#define PAR_FEW_IN_FAN 24
/* Fans of a tile after which the triangles are let go that have been handed out: they are in the cache still. Guess. */
#define PAR_FANS_AT_ONCE 64
/* Triangles ahead of the one at hand that are fetched: when they move, are handed out, are found. Guess. */
#define PAR_MOVED_AHEAD 32
#define PAR_HANDED_AHEAD 24
#define PAR_FOUND_AHEAD 16

/* --- ranks */

/* Ghost layers that are lent around what a block begins with; where they do not suffice, twice as many. A new point
 * seldom changes more than some triangles around a bad one. Guess. */
#define PAR_GHOST_LAYERS 2
/* Steps of a phase, between which there may be a checkpoint: one for so many blocks, and so many at most. Guess. */
#define PAR_BLOCKS_A_STEP 16
#define PAR_MOST_STEPS 8
/* Ids in a page of a map from ids to numbers: what lies at a border has ids that lie together. Guess. */
#define PAR_PAGE 1024
/* Triangles ahead of the one at hand whose corners are fetched. Guess. */
#define PAR_CORNERS_AHEAD 8
/* Bytes by which a message grows at least. Guess. */
#define PAR_MESSAGE_GROWTH (1 << 12)
/* Bytes of tiles that rank 0 gets from another at a time, to a tile's size, unless memory is bounded. Guess. */
#define PAR_RELAY_BYTES (1 << 25)
/* Bytes of buffers that a sink makes when it begins, where memory is bounded. Guess: those of files. */
#define PAR_SINK_BYTES (1 << 25)
/* Nanoseconds that a rank sleeps between two looks at whether others have come: at first, and at most, doubling from
 * one to the other. Guess. */
#define PAR_FIRST_NAP 1000
#define PAR_LONGEST_NAP 500000

/* --- checkpoints */

/* Bytes of a state that are written at a time; a multiple of any block of a disk. Guess. */
#define PAR_STATE_WRITE (1 << 20)
/* A state that is on the disk in fewer seconds does not measure how fast the disk is. Guess: ten times what a disk takes
 * for any file. */
#define PAR_STATE_MEASURES 0.2
/* A state amid a phase is due once so many times as long has passed as the last one took: a tenth of the time goes into
 * states at most. Guess. */
#define PAR_STATE_REST 9
/* Bytes of tiles after which the system is told to write them. Guess. */
#define PAR_SPOOL_SHIP (1 << 23)

#endif
