/* Constants that make the schedule fast or save memory. Only those of the first section decide where blocks are, and so
 * influence meshes; more constants of that kind are in triangle/tunables.h. Each has been measured, or is a guess that
 * has caused no known problem. docs/performance-history.md has the measurements. */
#ifndef SCHED_TUNABLES_H
#define SCHED_TUNABLES_H

/* --- cells; these constants influence meshes */

/* Final triangles of a cell: those of the mesh divided by PAR_CELLS_WANTED, within the two bounds that follow.
 * Measured: small cells keep many threads busy, large cells make fewer seams. */
#define PAR_CELLS_WANTED 128.0
#define PAR_SMALLEST_CELL 8192.0
#define PAR_LARGEST_CELL 65536.0
/* Minimum number of cells for a schedule, and for refining the mesh coarsely first. Guess. */
#define PAR_FEWEST_CELLS 8
#define PAR_FEWEST_COARSE_CELLS 32
/* Share of the fewest triangles that are worth a schedule. One sequential call makes this share first, to see whether
 * the estimate is right. Guess. */
#define PAR_A_LITTLE 0.25
/* Coarse triangles in a cell after pre-refinement. Measured: enough for narrow seams, and few enough for pre-refinement
 * to take a few thousandths of the time. */
#define PAR_COARSE_PER_CELL 64.0

/* Samples of the work in each cell. Guess. */
#define PAR_SAMPLES_PER_CELL 32
/* Columns and rows are chosen again if the box of the work is this many times more elongated than the box of the
 * points. Guess. */
#define PAR_SKEW 8.0

/* --- room for blocks */

/* Share of its estimated triangles that a worklist makes in each phase. Measured: the rest is deferred at the seams. */
#define PAR_DONE_IN_PHASES {0.9, 0.38, 0.42, 0.35}
/* Minimum number of items in a range. Guess. */
#define PAR_LEAST_RANGE 64
/* Minimum share of the new points that lie on segments. Guess. */
#define PAR_LEAST_ON_SEGMENTS 0.125

/* --- memory */

/* A mesh whose estimate exceeds this share of TRI_MAX_TRIANGLES is swept, because the estimate may be too low.
 * Guess. */
#define PAR_SURELY_ONE_MESH 0.8
/* Memory kept free for growth between two enlargements of the arrays: a share of the memory bound, and at least this
 * many bytes, because a library that writes files brings code and buffers with the first file. Guess. */
#define PAR_TO_COME 0.1
#define PAR_TO_COME_BYTES 8e6
/* Share of the remaining memory bound that pages of parked arrays may fill before they are unmapped. Guess. */
#define PAR_TOUCHED 0.3
/* Bytes by which the file of a parked array grows, and nanoseconds between two checks of the memory in use. Guess. */
#define PAR_PARK_GROWTH (1 << 18)
#define PAR_LOOK_NANOSECONDS 1000000

/* --- memory and disk space of a run, for estimates; all measured */

/* Share of the triangles required by angles for which blocks reserve places that stay empty. */
#define PAR_EMPTY_PLACES 0.25
/* Bytes of a sweep. The first four are multiplied by sqrt(triangles * triangles in a cell): data in memory; data of the
 * mesh on disk, with room to grow; data for numbering and handing out columns; the two states of a checkpoint. The last
 * is for each expected triangle: the coarse mesh and the lists of blocks. */
#define PAR_SWEEP_HELD 260.0
#define PAR_SWEEP_AWAY 290.0
#define PAR_SWEEP_WORK 140.0
#define PAR_SWEEP_STATES 520.0
#define PAR_SWEEP_COARSE 0.4
/* Bytes for each triangle: of a parked mesh in memory, and on disk; of the two states of a mesh that stays whole; of
 * the tiles in a checkpoint. */
#define PAR_PARKED_WORK 6.0
#define PAR_PARKED_BYTES 90.0
#define PAR_WHOLE_STATES 120.0
#define PAR_TILES_BYTES 26.0
/* Triangles of the busiest rank over the average. Bytes for each of its triangles: in memory, and at most for numbering
 * and handing them out. Bytes for the latter multiplied by the square root as above. Bytes for each triangle of all
 * ranks: the coarse mesh, and the two states of a checkpoint. */
#define PAR_RANK_BUSIEST 1.15
#define PAR_RANK_BYTES 62.0
#define PAR_RANK_WORK 20.0
#define PAR_RANK_COLUMN 45.0
#define PAR_RANK_COARSE 0.1
#define PAR_RANK_STATES 32.0

/* --- tiles */

/* Items handed out at a time if the mesh has no tiles. Guess. */
#define PAR_ITEMS_AT_ONCE (1 << 16)
/* Triangles moved at a time when a mesh is numbered: at most PAR_MOST_MOVE, so that threads seldom wait for each other,
 * and in a small mesh 1 / PAR_FEWEST_BATCHES of all. Guess. */
#define PAR_MOST_MOVE (1 << 18)
#define PAR_FEWEST_BATCHES 16
/* Up to this many triangles that start at one corner are sorted by insertion or on the stack. Guess. */
#define PAR_FEW_IN_FAN 24
/* Number of fans of a tile after which the copied triangles are freed, while they are still in the cache. Guess. */
#define PAR_FANS_AT_ONCE 64
/* How many triangles ahead to prefetch, in the three loops that move triangles, hand them out, and find them. Guess. */
#define PAR_MOVED_AHEAD 32
#define PAR_HANDED_AHEAD 24
#define PAR_FOUND_AHEAD 16

/* --- ranks */

/* Number of ghost layers that are sent around the first triangles of a block. If they do not suffice, the number is
 * doubled. A new point seldom changes more than a few triangles around a bad one. Guess. */
#define PAR_GHOST_LAYERS 2
/* A phase has one step for this many blocks, and at most PAR_MOST_STEPS. A checkpoint may be written between two steps.
 * Guess. */
#define PAR_BLOCKS_A_STEP 16
#define PAR_MOST_STEPS 8
/* Ids in a page of a map from ids to numbers. Triangles at a border have ids close to each other. Guess. */
#define PAR_PAGE 1024
/* Prefetch distance, in triangles, for their corners. Guess. */
#define PAR_CORNERS_AHEAD 8
/* Minimum number of bytes by which a message grows. Guess. */
#define PAR_MESSAGE_GROWTH (1 << 12)
/* Bytes of tiles that rank 0 receives from another rank at a time, give or take a tile, unless memory is bounded.
 * Guess. */
#define PAR_RELAY_BYTES (1 << 25)
/* Bytes of buffers that a sink allocates at its start, if memory is bounded. Guess: the buffers of files. */
#define PAR_SINK_BYTES (1 << 25)
/* Nanoseconds that a rank sleeps between two checks for messages: the first time, doubled each time, and at most.
 * Guess. */
#define PAR_FIRST_NAP 1000
#define PAR_LONGEST_NAP 500000

/* --- checkpoints */

/* Bytes of a state that are written at a time; a multiple of the block size of any disk. Guess. */
#define PAR_STATE_WRITE (1 << 20)
/* A state written in fewer seconds is not used to measure the speed of the disk. Guess: ten times the time that a disk
 * takes for any file. */
#define PAR_STATE_MEASURES 0.2
/* During a phase, a state is due when this many times the duration of the last write has passed. States then take at
 * most a tenth of the time. Guess. */
#define PAR_STATE_REST 9
/* Bytes of tiles after which the system is asked to write them. Guess. */
#define PAR_SPOOL_SHIP (1 << 23)

#endif
