/* The schedule as the library's own way to refine. */
#ifndef SCHED_SCHEDULE_LIBRARY_H
#define SCHED_SCHEDULE_LIBRARY_H

#include "triangle/api/opaque_mesh.h"

/* A refine of struct tri_api_way: par_refine with the struct par_options that way->user points to, and with threads,
 * size test, figure and column of regions as settings and way say. */
enum tri_status par_refine_as(const struct tri_api_way *way, struct tri_mesh *mesh,
                              const struct tri_quality *quality, const struct tri_refine_hooks *hooks,
                              const struct tri_settings *settings, struct tri_refine_report *report,
                              struct tri_error *error);

#endif
