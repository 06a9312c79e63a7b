/* The report of a run of ptriangle as a JSON file: --report. */
#ifndef DRIVERS_MESH_REPORT_JSON_H
#define DRIVERS_MESH_REPORT_JSON_H

#include "drivers/mesh/launch.h"
#include "drivers/mesh/stages.h"
#include "sched/schedule/schedule.h"
#include "triangle/text/output.h"

/* TRI_BAD_INPUT: this program was built without reports. */
enum tri_status report_check(struct tri_error *error);

/* Writes it into run->outputs. schedule: NULL, or what refined the mesh; of several ranks that of the first. Takes a
 * pass or two over all triangles. TRI_CANNOT_WRITE, TRI_NO_MEMORY. */
enum tri_status report_write(const struct run *run, const struct par_report *schedule, const struct rank_report *ranks);

#endif
