/* The report of a run of ptriangle as a JSON file: --report. */
#ifndef DRIVERS_REPORT_JSON_H
#define DRIVERS_REPORT_JSON_H

#include "drivers/run.h"
#include "sched/par.h"

/* Looks whether the file could be created; changes nothing. TRI_CANNOT_WRITE, TRI_NO_MEMORY; TRI_BAD_INPUT: this
 * program was built without reports. */
enum tri_status report_check(const char *path, struct tri_error *error);

/* Writes it; the file appears when complete. schedule: NULL, or what refined the mesh. Takes a pass or two over all
 * triangles. TRI_CANNOT_WRITE, TRI_NO_MEMORY. */
enum tri_status report_write(const char *path, const struct run *run, const struct par_report *schedule, int threads,
                             struct tri_error *error);

#endif
