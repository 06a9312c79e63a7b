/* Room for the vertices, triangles and subsegments that blocks add: ranges of indices in the shared arrays.
 *
 * A block works on a view of the mesh (struct par_view): the shared arrays, with counts and capacities of its own that
 * bound a range which no other block uses. If a range is full, the view moves on to the block's next range. If the
 * block has no other range, it pauses. When all other blocks have paused or ended, the arrays grow, and the block
 * continues.
 *
 *     array    | in use             | block 1 | block 4 | block 1 | spare |                  |
 *                                  next      end                        count            capacity
 *
 * Only the calling thread deals out ranges. It does so between phases and during pauses, in canonical order, so the ids
 * that a block uses do not depend on which thread runs it or when. Unused room of a block goes to the blocks of the
 * next phase. At the end the unused places are either filled with the last items of the arrays (par_room_close), or
 * marked so that par_number leaves them out (par_room_mark). */
#ifndef SCHED_SCHEDULE_ROOM_H
#define SCHED_SCHEDULE_ROOM_H

#include "triangle/mesh/mesh.h"

enum par_kind { PAR_VERTICES, PAR_TRIANGLES, PAR_SUBS, PAR_KINDS }; /* each kind has its own ranges */

struct par_range {
    int32_t next, end; /* unused indices: next .. end - 1 */
};

/* Ranges of one kind. */
struct par_ranges {
    struct par_range *item; /* the ranges, in no particular order */
    int32_t n, capacity;    /* number of ranges; allocated ranges */
    int32_t dealt;          /* of spare room: number of ranges that blocks hold and will return. The list always has
                               capacity for them, so returning cannot fail */
};

/* Makes the list large enough for `need` ranges in total; amortised O(1) a range. False: no memory. */
bool par_ranges_reserve(struct par_ranges *ranges, int32_t need);

/* Adds an index: extends the last range if the index follows it, otherwise appends a range. False: no memory. */
static inline bool par_ranges_add(struct par_ranges *ranges, int32_t id)
{
    if (ranges->n > 0 && ranges->item[ranges->n - 1].end == id && ranges->item[ranges->n - 1].next < id) {
        ranges->item[ranges->n - 1].end++;
        return true;
    }
    if (!par_ranges_reserve(ranges, ranges->n + ranges->dealt + 1))
        return false;
    ranges->item[ranges->n++] = (struct par_range){id, id + 1};
    return true;
}

/* Returns the number of unused items in all ranges. */
int64_t par_ranges_unused(const struct par_ranges *ranges);

/* The room of one block, or the spare room that no block holds. */
struct par_room {
    struct par_ranges ranges[PAR_KINDS]; /* ranges of each kind */
    int32_t current[PAR_KINDS]; /* of a block: index of the range in use */
    double on_segments;         /* of a block: share of its points that were inserted on segments, 0 to 1, as known at
                                   its last pause */
};

/* The mesh as one block sees it. Used by the one thread that runs the block. */
struct par_view {
    struct tri_mesh mesh; /* borrowed pointers to the shared arrays. While the block runs, counts and capacities are the
                             bounds of the room's current ranges */
    struct par_room room; /* the ranges of the block */
    int32_t points;       /* number of points for which there was no room the last time; 0: there was enough */
};

/* Called when the block begins or continues. Copies the pointers to the shared arrays, which may have moved while the
 * block was paused, and sets counts and capacities from the room's current ranges. */
void par_view_begin(struct par_view *view, const struct tri_mesh *shared);

/* A tri_more_room callback; user is the struct par_view. Moves on to the next range of each kind that is full.
 * TRI_NO_ROOM: the block has no range left and must pause. */
enum tri_status par_view_more_room(void *user, struct tri_mesh *mesh, int32_t points, struct tri_error *error);

/* Called when the block ends or pauses: writes the used counts back to the room's current ranges. */
void par_view_end(struct par_view *view);

/* Returns the number of unused items of a kind in a block's room, while the block does not run. Ranges too short for
 * one insertion do not count. */
int32_t par_room_left(const struct par_room *room, enum par_kind kind);

/* Extends the room until it has at least `triangles` unused triangles, with vertices and subsegments to match. Takes
 * ranges from `spare` first, then from the end of the shared arrays, which grow. Called on the calling thread while no
 * block runs. On TRI_NO_MEMORY or TRI_TOO_LARGE the room keeps the ranges that it has received so far. */
enum tri_status par_room_extend(struct par_room *room, struct par_room *spare, struct tri_mesh *shared,
                                int32_t triangles, struct tri_error *error);

/* Grows the shared arrays once to about the capacity for `triangles` more triangles, after `spare` is used up. Without
 * this the arrays would grow step by step and be copied each time. Does nothing if memory is bounded or if the arrays
 * use another storage. The number is an estimate: if memory does not suffice, the arrays stay as they are, and
 * par_room_extend fails later if blocks cannot get the room that they need. */
void par_room_reserve(const struct par_room *spare, struct tri_mesh *shared, int64_t triangles);

/* Moves the room's unused ranges to `spare`, and frees the room. Cannot fail. */
void par_room_return(struct par_room *room, struct par_room *spare);

/* Adds the index of a deleted item to `spare`. False: no memory. */
bool par_room_release(struct par_room *spare, enum par_kind kind, int32_t id);

/* Marks the places listed in `spare` as free in the shared arrays, as par_number expects. Does not change spare.
 * O(gaps). */
void par_room_mark(const struct par_room *spare, struct tri_mesh *shared, const struct tri_executor *executor);

/* Marks the place of one subsegment as free. */
void par_room_mark_sub(struct tri_mesh *shared, tri_sub_id s);

/* Fills the gaps that `spare` lists in the shared arrays with the last items of the arrays. Afterwards all places below
 * the mesh's counts are used, as before the first phase. O(gaps), and one parallel pass over the triangles. Frees
 * spare. Cannot fail. */
void par_room_close(struct par_room *spare, struct tri_mesh *shared, const struct tri_executor *executor);

/* Frees the lists of ranges, without returning the ranges. */
void par_room_free(struct par_room *room);

#endif
