/* Room for what blocks add: ranges of vertices, triangles and subsegments in the shared arrays.
 *
 * A block works on a view of the mesh (struct par_view): the shared arrays, with counts and capacities of its own that
 * point into a range that nobody else uses. When a range is full the view moves to the block's next one; when there is
 * none the block pauses until all others have paused or ended, and goes on after the arrays have grown. Ranges are
 * dealt out between phases, by one thread and in canonical order: so the ids that a block uses do not depend on who
 * runs when. What a block leaves unused goes to the blocks of the next phase; what is unused at the end is filled with
 * the last items of the arrays (par_room_close), or marked for par_number, which leaves it out (par_room_mark). */
#ifndef SCHED_SCHEDULE_ROOM_H
#define SCHED_SCHEDULE_ROOM_H

#include "triangle/mesh/mesh.h"

enum par_kind { PAR_VERTICES, PAR_TRIANGLES, PAR_SUBS, PAR_KINDS };

struct par_range {
    int32_t next, end; /* unused: next .. end - 1 */
};

struct par_ranges {
    struct par_range *item;
    int32_t n, capacity;
    int32_t dealt; /* of spare: ranges that blocks have and will return; there is always room for them here */
};

/* Room for `need` ranges in all; amortised O(1) a range. False: no memory. */
bool par_ranges_reserve(struct par_ranges *ranges, int32_t need);

/* Items in them. */
int64_t par_ranges_unused(const struct par_ranges *ranges);

/* What one block has, or what nobody has. */
struct par_room {
    struct par_ranges ranges[PAR_KINDS];
    int32_t current[PAR_KINDS]; /* of a block: the range that it uses */
    double on_segments;         /* of a block: share of its points that went there, as far as is known */
};

/* The mesh as one block sees it. */
struct par_view {
    struct tri_mesh mesh; /* the shared arrays, which are not its own; counts and capacities: those of the room's
                             current ranges, while the block runs */
    struct par_room room;
    int32_t points; /* for which there was no room the last time; 0: there has been */
};

/* Where the block begins, or goes on: the shared arrays may have moved since. */
void par_view_begin(struct par_view *view, const struct tri_mesh *shared);

/* A tri_more_room: user is the struct par_view. */
enum tri_status par_view_more_room(void *user, struct tri_mesh *mesh, int32_t points, struct tri_error *error);

/* Where the block ends, or pauses: its room learns how far it has been used. */
void par_view_end(struct par_view *view);

/* Unused items of a kind in the hands of a block that does not run: ranges too short for an insertion count nothing. */
int32_t par_room_left(const struct par_room *room, enum par_kind kind);

/* Sees to it that the room has at least `triangles` unused triangles, and vertices and subsegments to match: from
 * `spare` first, else from the end of the shared arrays, which grow. TRI_NO_MEMORY, TRI_TOO_LARGE: what it got so
 * far it keeps. */
enum tri_status par_room_extend(struct par_room *room, struct par_room *spare, struct tri_mesh *shared,
                                int32_t triangles, struct tri_error *error);

/* Gives the shared arrays about the capacity for so many more triangles at once, `spare` used up: what grows step by
 * step is copied again and again. Does nothing where memory is bounded or arrays are elsewhere. The number is a guess.
 * If there is not so much memory, the arrays stay as they are; par_room_extend fails if blocks do not get what they
 * need. */
void par_room_reserve(const struct par_room *spare, struct tri_mesh *shared, int64_t triangles);

/* Moves what is unused to `spare`, and frees the room. Cannot fail. */
void par_room_return(struct par_room *room, struct par_room *spare);

/* An item that is no more is unused from now on. False: no memory. */
bool par_room_release(struct par_room *spare, enum par_kind kind, int32_t id);

/* Marks what `spare` lists as free in the shared arrays, as par_number wants it; spare is as before. O(gaps). */
void par_room_mark(const struct par_room *spare, struct tri_mesh *shared, const struct tri_executor *executor);

/* The same for one subsegment. */
void par_room_mark_sub(struct tri_mesh *shared, tri_sub_id s);

/* Closes the gaps that `spare` lists in the shared arrays with the last items there; afterwards every vertex and
 * triangle below the mesh's counts is used, as before the first phase. O(gaps), and one parallel pass over the
 * triangles. Frees spare. Cannot fail. */
void par_room_close(struct par_room *spare, struct tri_mesh *shared, const struct tri_executor *executor);

void par_room_free(struct par_room *room);

#endif
