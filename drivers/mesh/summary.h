/* What is told about a finished mesh: the lines that scripts search for, and what people want to know. */
#ifndef DRIVERS_MESH_SUMMARY_H
#define DRIVERS_MESH_SUMMARY_H

#include "drivers/mesh/console.h"
#include "triangle/dropin/switches.h"
#include "triangle/mesh/pslg.h"
#include "triangle/refine/generate.h"
#include "triangle/refine/stats.h"

/* What went otherwise than the input asks: crossings, segments bent. */
void summary_segments(const struct console *console, const struct tri_constrain_report *report);

/* A warning of hole points that empty nothing. */
void summary_holes(const struct console *console, const struct tri_report *report);

/* On standard error: why the mesh is empty, also if quiet; that segments are skipped. */
void summary_notes(const struct console *console, const struct tri_notes *notes);

/* A warning for each point that has a twin of lower index: twin[n_points] is the first one at its place; NULL: there
 * are none. */
void summary_duplicates(const struct console *console, const int32_t *twin, const struct tri_pslg *pslg);

/* One line: how many triangles stay below the bounds, and why. They are counted into remain. */
void summary_bounds(const struct console *console, const struct tri_mesh *mesh,
                    const struct tri_quality *options, const struct tri_refine_report *report,
                    const struct tri_executor *executor, int64_t remain[TRI_EXCUSES]);

/* The same of triangles that have been counted. */
void summary_remaining(const struct console *console, const int64_t count[TRI_EXCUSES],
                       const struct tri_quality *options, const struct tri_refine_report *report);

/* The block "Statistics:". n_input_triangles is told with -r. */
void summary_counts(const struct console *console, const struct tri_switches *switches, const struct tri_pslg *pslg,
                    int32_t n_input_triangles, const struct tri_counts *counts);

/* The blocks of -V: shapes, memory, work done; also if quiet. */
void summary_shapes(const struct tri_mesh *mesh, const struct tri_report *report, const struct tri_executor *executor);

#endif
