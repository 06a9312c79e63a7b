/* What lies behind triangulate(), whoever refines: that of libtriangle.a (triangle/dropin/triangulate.c) and that of
 * libptriangle.a (sched/schedule/par_triangulate.c). */
#ifndef TRIANGLE_DROPIN_CALL_H
#define TRIANGLE_DROPIN_CALL_H

#include "triangle/api/generate.h"
#include "triangle/dropin/triangle.h"

/* triangulate_with, with the refinement that is given (its user is the options, never NULL; NULL: tri_refine); the
 * executor (or NULL) runs what comes in pieces. aloud: for triangulate(). Errors, why the mesh is empty, and that
 * segments are skipped, are then a line each on standard error, unless the switches have Q. */
int tri_io_triangulate(const char *switches, const struct triangulateio *in, struct triangulateio *out,
                       struct triangulateio *vorout, const struct triangulate_options *options, bool aloud,
                       tri_refine_call *refine, const struct tri_executor *executor);

/* A line on standard error. */
void tri_io_print(const char *text);

#endif
