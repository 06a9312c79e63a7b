/* The report of a run of ptriangle as a JSON file: --report. */
#ifndef DRIVERS_MESH_REPORT_JSON_H
#define DRIVERS_MESH_REPORT_JSON_H

#include "drivers/mesh/launch.h"
#include "drivers/mesh/stages.h"
#include "sched/schedule/schedule.h"
#include "triangle/text/output.h"

/* Checks that this program was built with reports. TRI_BAD_INPUT if not. */
enum tri_status report_check(struct tri_error *error);

/* Writes the report into run->outputs. schedule: the report of refinement, of the first of several ranks; or NULL.
 * Takes one or two passes over all triangles. TRI_CANNOT_WRITE, TRI_NO_MEMORY. */
enum tri_status report_write(const struct run *run, const struct par_report *schedule, const struct rank_report *ranks);

#endif
