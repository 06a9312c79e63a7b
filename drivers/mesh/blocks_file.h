/* Which block of the schedule made each triangle, as text for pictures. */
#ifndef DRIVERS_MESH_BLOCKS_FILE_H
#define DRIVERS_MESH_BLOCKS_FILE_H

#include "sched/schedule/schedule.h"
#include "triangle/text/output.h"

/* Writes a line "block phase" for each triangle in the order of the .ele file: par_block_of, phases from 0; -1 -1 where
 * none. The file becomes part of the guarded set (drivers/interrupt.h). */
enum tri_status blocks_write(const char *path, struct tri_output_set *set, const struct par_report *report,
                             const struct tri_mesh *mesh, struct tri_error *error);

#endif
