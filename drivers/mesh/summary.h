/* Reports about a finished mesh: lines that scripts search for, and lines for people. */
#ifndef DRIVERS_MESH_SUMMARY_H
#define DRIVERS_MESH_SUMMARY_H

#include "drivers/mesh/stages.h"

/* Prints warnings about the input: duplicate points, crossings, bent segments, and hole points that empty nothing; and
 * the notes. */
void summary_input(const struct run *run);

/* Prints on standard error why the mesh is empty (also if quiet), and that segments were skipped. */
void summary_notes(const struct run *run);

/* Prints one line with the number of triangles that violate the bounds, by reason. They are counted here, except
 * after a sweep and in quiet runs. */
void summary_bounds(struct run *run);

/* Returns the number of triangles, for all reasons. */
int64_t summary_sum(const int64_t count[TRI_EXCUSES]);

/* Prints the block "Statistics:". */
void summary_counts(const struct run *run);

/* Prints the blocks of -V (shapes, memory, work), also if quiet. */
void summary_shapes(const struct run *run);

/* --- -C: checks the mesh. */

/* Returns the memory that the check needs at least, in parts of useful size. */
double self_check_least_bytes(const struct tri_mesh *mesh);

/* Checks the mesh part by part with triangle/check/check.h. Prints two lines, or one for each kind of fault with its
 * number. memory: bytes that it may use, at least self_check_least_bytes; 0: no bound. TRI_NO_MEMORY, TRI_TOO_LARGE,
 * TRI_CANNOT_WRITE. */
enum tri_status self_check(const struct run *run, double memory);

#endif
