/* A mesh that is larger than memory may be: its arrays lie in a file, and what is not in use now leaves memory.
 *
 * The file is mapped, so that all that works on a mesh works on this one, and makes the same. Its disk space is taken
 * before it is used: a full disk is an error of the call that grows the mesh, not a signal. It has no name once it is
 * open: nothing is left of it, however the process ends. Beside the threads that work, one looks at how much the
 * process has in memory, and unmaps all pages of the file when that is too much; who touches one finds it again. The
 * system writes pages to disk and drops them as it needs memory. So the less work jumps about in the mesh, the quicker
 * it is.
 */
#ifndef SCHED_SWEEP_PARK_H
#define SCHED_SWEEP_PARK_H

#include <stdint.h>

#include "triangle/mesh.h"

struct par_park;

/* Opens a file in a directory, and moves the mesh there. memory: bytes that the process may have in memory, about; what
 * does not lie in the file counts, too, and stays. TRI_CANNOT_WRITE: the directory or the system does not allow it;
 * TRI_NO_MEMORY. */
enum tri_status par_park_open(struct par_park **park, struct tri_mesh *mesh, const char *scratch, int64_t memory,
                              struct tri_error *error);

/* Why there was no room: instead of the status, TRI_NO_MEMORY, that the mesh gave it. Any other status stays. */
enum tri_status par_park_status(const struct par_park *park, enum tri_status status, struct tri_error *error);

/* Bytes of disk so far. */
int64_t par_park_bytes(const struct par_park *park);

/* The file goes, and what the mesh had in it: it is no mesh then, to be freed and no more. NULL: nothing happens. */
void par_park_close(struct par_park *park, struct tri_mesh *mesh);

#endif
