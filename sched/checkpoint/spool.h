/* Tiles in a file, in the order in which they are handed out: so that whoever takes them can be given all of them again
 * after the process has died. A sink that passes on to another one.
 *
 * The file is only appended to. A tile is a head, with a hash over all of the tile, and its arrays; corners take 32
 * bits, since they are counted back from the last vertex of the tile: up to 2^32 vertices. About 26 bytes a
 * triangle. */
#ifndef SCHED_CHECKPOINT_SPOOL_H
#define SCHED_CHECKPOINT_SPOOL_H

#include <stddef.h>

#include "ptriangle/tiles.h"
#include "triangle/base/status.h"
#include "triangle/base/system.h"

struct par_spool {
    tri_file file;          /* open for reading and writing; TRI_NO_FILE: none */
    const char *path;       /* for messages; borrowed */
    const struct tri_sink *to;
    int64_t length;         /* bytes of whole tiles in the file */
    int64_t sent;           /* of these are on their way to the disk */
    bool again;             /* `begin` hands out what is in the file, and the first tile that comes is one of those */
    enum tri_status failed; /* `to` has failed, and is told no more; tiles are kept all the same */
    struct tri_error failure;
    int32_t n_attributes;
};

/* As a sink; the spool lives as long as that. TRI_CANNOT_WRITE, TRI_NO_MEMORY; with `again` also TRI_BAD_INPUT, where
 * the file does not hold whole tiles, and what `to` says. */
struct tri_sink par_spool_sink(struct par_spool *spool);

#endif
