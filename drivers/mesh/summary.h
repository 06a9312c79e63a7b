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

/* The block "Statistics:". */
void summary_counts(const struct run *run);

/* The blocks of -V: shapes, memory, work done; also if quiet. */
void summary_shapes(const struct run *run);

#endif
