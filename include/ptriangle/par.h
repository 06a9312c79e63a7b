/* The functions of ptriangle/tri.h on all cores, in the library ptriangle.
 *
 * Refinement follows the four-phase schedule of Chernikov and Chrisochoides (ICS 2004), extended to any boundary and
 * any grading. The mesh depends on the figure and the settings alone, never on the number of threads; it is not the one
 * that tri_mesh_new makes, which inserts points in another order: same bounds, about the same size.
 *
 * A small mesh, settings with most_new_points, gate or fence, or callbacks that must not run in parallel make it one
 * sequential refinement. Calls from several threads, on different meshes, and from within parallel regions are fine.
 * In a child that was forked after a call there is one thread. */
#ifndef PTRIANGLE_PAR_H
#define PTRIANGLE_PAR_H

#include "ptriangle/tri.h"

#ifdef __cplusplus
extern "C" {
#endif

/* As tri_mesh_new and tri_mesh_refine; meshes made by the one may be refined by the other. */
enum tri_status par_mesh_new(struct tri_mesh **mesh, const struct tri_figure *figure,
                             const struct tri_settings *settings, struct tri_error *error);
enum tri_status par_mesh_refine(struct tri_mesh *mesh, const struct tri_settings *settings, struct tri_error *error);

#ifdef __cplusplus
}
#endif

#endif
