/* Segments on their way to the end of the file: how many there will be is not known before, and they may come sooner or
 * later than points do. Few are kept in memory; more in a file that is needed only later. */
#ifndef TRIANGLE_HDF5_SEGMENT_SPOOL_H
#define TRIANGLE_HDF5_SEGMENT_SPOOL_H

#include "ptriangle/tiles.h"
#include "triangle/text/output.h"

enum { TRI_H5_KEPT_SEGMENTS = 1 << 16 };

struct tri_h5_segments {
    struct tri_output *spool; /* borrowed; empty before and afterwards */
    int64_t n, n_read;        /* in all; handed out again */
    int64_t (*ends)[2];       /* [TRI_H5_KEPT_SEGMENTS] */
    int32_t *markers;         /* the same; both behind those in the spool, or those that were read last */
};

/* TRI_NO_MEMORY. To be freed in any case. */
enum tri_status tri_h5_segments_begin(struct tri_h5_segments *segments, struct tri_output *spool,
                                      struct tri_error *error);

/* Keeps those of a tile. */
enum tri_status tri_h5_segments_add(struct tri_h5_segments *segments, const struct tri_tile *tile,
                                    struct tri_error *error);

/* Once all are there: the next of them, in their order, as a tile that has nothing else; none are left: n_segments is
 * 0, and the spool is empty. TRI_CANNOT_WRITE where the spool cannot be read. */
enum tri_status tri_h5_segments_next(struct tri_h5_segments *segments, struct tri_tile *tile, struct tri_error *error);

void tri_h5_segments_free(struct tri_h5_segments *segments);

#endif
