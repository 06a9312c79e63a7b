/* Parking: an out-of-core mode for a mesh larger than its memory limit. Arrays are in memory while they fit, then in
 * memory-mapped files.
 *
 * Before arrays grow, the memory use of the process is checked. If it would exceed the limit, each array moves to a
 * mapped file. All code works on the mapped arrays unchanged, with the same result. Disk space is allocated before it
 * is used, so a full disk is an error of the call that grows the mesh, not a signal. The files are unlinked once they
 * are open, so none is left behind if the process dies. From then on, tasks and one more thread check the memory use,
 * and evict all pages of the files if it is too large. A page is mapped again at its next access. The system writes
 * dirty pages to disk as it needs memory. Work with good locality is therefore much faster. */
#ifndef SCHED_TILES_PARK_H
#define SCHED_TILES_PARK_H

#include <stdint.h>

#include "triangle/mesh/mesh.h"

struct par_park;

/* Starts to limit the memory of a mesh. folder: the folder for files, borrowed; NULL: growing a mesh beyond the limit
 * fails with TRI_NO_MEMORY. memory: the limit of the process in bytes. TRI_NO_MEMORY. */
enum tri_status par_park_open(struct par_park **park, struct tri_mesh *mesh, const char *folder, int64_t memory,
                              struct tri_error *error);

/* Announces that `bytes` more will be needed besides the arrays, possibly from the mesh's storage. If they do not fit,
 * the arrays move to files. park NULL: does nothing. TRI_CANNOT_WRITE, TRI_NO_MEMORY. */
enum tri_status par_park_expect(struct par_park *park, struct tri_mesh *mesh, size_t bytes, struct tri_error *error);

/* Returns an executor on the threads of `inner` that evicts pages before a task if too many are in memory. Valid as
 * long as the park and the context of `inner`. */
struct tri_executor par_park_executor(struct par_park *park, struct tri_executor inner);

/* Replaces TRI_NO_MEMORY, reported by the mesh, by the error of the park that caused it. Keeps any other status. */
enum tri_status par_park_status(const struct par_park *park, enum tri_status status, struct tri_error *error);

/* Returns the largest use of disk so far in bytes; 0: the mesh never left memory. */
int64_t par_park_bytes(const struct par_park *park);

/* Removes the files and the arrays in them. Afterwards the mesh may only be freed. mesh NULL: it was freed already.
 * park NULL: does nothing. */
void par_park_close(struct par_park *park, struct tri_mesh *mesh);

#endif
