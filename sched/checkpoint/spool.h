/* A spool keeps the tiles of a sweep in a file, in the order in which they are handed out, and passes each tile on to
 * another sink. If the process dies, a resumed run passes all tiles to the receiver again.
 *
 *     | head | arrays of tile 1, each padded to 8 bytes | head | arrays of tile 2 | ...
 *
 * The file is only appended to. The head of a tile contains a hash of the whole tile. Corners take 32 bits, because
 * they are counted back from the last vertex of the tile; this allows distances up to 2^32 vertices. A triangle takes
 * about 26 bytes. */
#ifndef SCHED_CHECKPOINT_SPOOL_H
#define SCHED_CHECKPOINT_SPOOL_H

#include <stddef.h>

#include "ptriangle/tiles.h"
#include "triangle/base/status.h"
#include "triangle/base/system.h"

/* Used by the calling thread of a run. */
struct par_spool {
    tri_file file;             /* open for reading and writing; TRI_NO_FILE: not open */
    const char *path;          /* path of the file for messages; borrowed */
    const struct tri_sink *to; /* the sink that receives the tiles */
    int64_t length;            /* bytes of complete tiles in the file */
    int64_t sent;              /* the part of these bytes that the system has been asked to write to the disk */
    bool again;                /* `begin` hands out the tiles in the file again; the first tile appended afterwards is
                                  already in the file and is skipped */
    enum tri_status failed;    /* not TRI_OK: `to` has failed and receives no more tiles; tiles are still appended to
                                  the file */
    struct tri_error failure;  /* details of that failure */
    int32_t n_attributes;      /* attributes of a vertex */
};

/* Returns the spool as a sink. The spool must outlive it. The sink's functions return TRI_CANNOT_WRITE or
 * TRI_NO_MEMORY; with `again` also TRI_BAD_INPUT if the file does not hold complete tiles, and errors of `to`. */
struct tri_sink par_spool_sink(struct par_spool *spool);

#endif
