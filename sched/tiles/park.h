/* A mesh that may be larger than the memory it is allowed: its arrays are in memory as long as they fit, then in files.
 *
 * Before arrays grow, the memory of the process is looked at. If the arrays and all else would no longer fit, all of
 * them move to files, one for each, which are mapped: whatever works on a mesh works on this one, too, and makes the
 * same. Disk space is taken before it is used: a full disk is an error of the
 * call that grows the mesh, not a signal. Files are as long as their arrays, and have no name once they are open:
 * nothing is left of them, however the process ends. From then on whoever works on the mesh, and one more thread, look
 * at how much the process has in memory, and unmap all pages of the files when that is too much; who touches one finds
 * it again. The system writes pages to disk and drops them as it needs memory. So the less work jumps about in the
 * mesh, the quicker it is. */
#ifndef SCHED_TILES_PARK_H
#define SCHED_TILES_PARK_H

#include <stdint.h>

#include "triangle/mesh/mesh.h"

struct par_park;

/* From here on the mesh is watched. folder: where the files will be; borrowed; NULL: a mesh that does not fit is
 * TRI_NO_MEMORY for whoever grows it. memory: bytes that the process may have in memory. TRI_NO_MEMORY. */
enum tri_status par_park_open(struct par_park **park, struct tri_mesh *mesh, const char *folder, int64_t memory,
                              struct tri_error *error);

/* Beside the arrays so many bytes will be needed, which the storage of the mesh may be asked for: if they do not fit,
 * the arrays move. TRI_CANNOT_WRITE, TRI_NO_MEMORY. NULL: nothing happens. */
enum tri_status par_park_expect(struct par_park *park, struct tri_mesh *mesh, size_t bytes, struct tri_error *error);

/* The same threads; before each task what has been touched of the mesh is let go, if that is too much. Lives as long as
 * the park and what `inner` names. */
struct tri_executor par_park_executor(struct par_park *park, struct tri_executor inner);

/* Why there was no room: instead of the status, TRI_NO_MEMORY, that the mesh gave it. Any other status stays. */
enum tri_status par_park_status(const struct par_park *park, enum tri_status status, struct tri_error *error);

/* The most bytes of disk so far; 0: the mesh never left memory. */
int64_t par_park_bytes(const struct par_park *park);

/* The files go, and what the mesh had in them: then it is no mesh, to be freed and no more. mesh NULL: it has been
 * freed. park NULL: nothing happens. */
void par_park_close(struct par_park *park, struct tri_mesh *mesh);

#endif
