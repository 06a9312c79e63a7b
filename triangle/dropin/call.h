/* The implementation of triangulate() for any refinement: that of libtriangle.a (triangle/dropin/triangulate.c) and
 * that of libptriangle.a (sched/schedule/par_triangulate.c). */
#ifndef TRIANGLE_DROPIN_CALL_H
#define TRIANGLE_DROPIN_CALL_H

#include "triangle/api/generate.h"
#include "triangle/dropin/triangle.h"

/* Implements triangulate_with. refine: the refinement to use, whose user pointer is the options and never NULL;
 * NULL: tri_refine. executor: runs parallel tasks; may be NULL. aloud: true for triangulate(); errors, the reason
 * why the mesh is empty, and skipped segments are then printed on standard error, one line each. With Q only errors
 * are printed. */
int tri_io_triangulate(const char *switches, const struct triangulateio *in, struct triangulateio *out,
                       struct triangulateio *vorout, const struct triangulate_options *options, bool aloud,
                       tri_refine_call *refine, const struct tri_executor *executor);

/* Prints a line on standard error. */
void tri_io_print(const char *text);

#endif
