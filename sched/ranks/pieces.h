/* What a rank has, in a file, so that other ranks, of another number, can go on with it.
 *
 * For each of its tiles a rank writes all triangles with a corner there, and their entries of the worklist, as one
 * message (talk.h). Whoever owns a tile afterwards pastes that as if it had borrowed it.
 *
 * THEOREM. Then it has what the invariant of ranks.h asks for, whoever wrote what. Its triangles are those with a
 * corner in its tiles, which is what the pieces of these tiles tell of; those that several tell of are known by their
 * corners. Two triangles with a common edge know of each other, and of the subsegment there, if an end of the edge lies
 * in one of its tiles, since both are in the piece of that. Across other edges nobody looks here: a block that may
 * change one of the two has both ends in its box, and asks the owners of these. */
#ifndef SCHED_RANKS_PIECES_H
#define SCHED_RANKS_PIECES_H

#include "sched/checkpoint/checkpoint.h"
#include "sched/ranks/ranks.h"

/* Of the two states of a checkpoint this one's file of one rank. */
struct par_piece_file {
    int64_t which;
    int writer;
    int32_t first, end; /* its tiles: first .. end - 1 */
    uint64_t hash;      /* as it was told when the file was written */
};

/* Writes what this rank owns to its file, on the disk; *hash of that. TRI_CANNOT_WRITE, TRI_NO_MEMORY. */
enum tri_status par_pieces_write(const struct par_ranks *ranks, int64_t which, uint64_t *hash, struct tri_error *error);

/* Pastes the pieces of those tiles in a file that this rank owns now. TRI_BAD_INPUT: they are not what was written,
 * TRI_NO_MEMORY. */
enum tri_status par_pieces_read(struct par_ranks *ranks, const struct par_piece_file *of, struct tri_error *error);

#endif
