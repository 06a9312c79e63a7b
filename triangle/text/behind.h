/* A large piece of a file that is written while its writer goes on.
 *
 * POSIX's asynchronous writing does it, past the system's cache where the file system allows that: what a mesh of many
 * gigabytes would push out of the cache stays there, processors copy nothing, and little is left to sync at the end. */
#ifndef TRIANGLE_TEXT_BEHIND_H
#define TRIANGLE_TEXT_BEHIND_H

#include <aio.h>

#include "triangle/text/output.h"

enum { TRI_BEHIND_BYTES = 4096 }; /* a place, a size and an address that are multiples of it may pass the cache */

/* At most one piece at a time. All 0: nothing is under way. May not move while something is. */
struct tri_behind {
    bool under_way;
    const char *data; /* lent */
    struct aiocb control;
};

/* Begins to write to a reserved place of an output that has places; nothing is under way. The data are lent until it is
 * waited for. Returns 0 or what tri_output_conclude makes an error of. */
int tri_behind_start(struct tri_behind *behind, struct tri_output *output, uint64_t place, const char *data,
                     size_t size);

/* Waits for what is under way, if anything is: then it is written. Returns the same. */
int tri_behind_wait(struct tri_behind *behind, const struct tri_output *output);

#endif
