/* What is told about a finished mesh: the lines that scripts search for, and what people want to know. */
#ifndef DRIVERS_MESH_SUMMARY_H
#define DRIVERS_MESH_SUMMARY_H

#include "drivers/mesh/stages.h"

/* What was odd about the input: points where another one lies already, crossings, bent segments, hole points that empty
 * nothing; and the notes. */
void summary_input(const struct run *run);

/* On standard error: why the mesh is empty, also if quiet; that segments are skipped. */
void summary_notes(const struct run *run);

/* One line: how many triangles stay below the bounds, and why. They are counted unless the mesh is gone, or nobody will
 * read the line. */
void summary_bounds(struct run *run);

/* Triangles, of all reasons. */
int64_t summary_sum(const int64_t count[TRI_EXCUSES]);

/* The block "Statistics:". */
void summary_counts(const struct run *run);

/* The blocks of -V: shapes, memory, work done; also if quiet. */
void summary_shapes(const struct run *run);

/* --- -C: the mesh before the judge. */

/* What it takes whatever its bound, in parts that are not too small. */
double self_check_least_bytes(const struct tri_mesh *mesh);

/* Checks the mesh with triangle/check/check.h, which reads it part by part, and says two lines, or one per kind of
 * fault and how many there are. memory: bytes that it may use; where that is less, self_check_least_bytes; 0: no bound.
 * TRI_NO_MEMORY, TRI_TOO_LARGE, TRI_CANNOT_WRITE. */
enum tri_status self_check(const struct run *run, double memory);

#endif
