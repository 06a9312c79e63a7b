/* The numbers by which the schedule is fast or takes little memory. None changes a mesh; those that do are in
 * triangle/tunables.h. Each was measured, or guessed and not found wrong. docs/performance-history.md has the
 * measurements. */
#ifndef SCHED_TUNABLES_H
#define SCHED_TUNABLES_H

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
/* A state amid a phase is due once so many times as long has passed as the last one took: a tenth of the time goes into
 * states at most. Guess. */
#define PAR_STATE_REST 9
/* Bytes of tiles after which the system is told to write them. Guess. */
#define PAR_SPOOL_SHIP (1 << 23)

#endif
