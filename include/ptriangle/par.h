/* The functions of ptriangle/tri.h on all cores, in the library ptriangle.
 *
 * Refinement follows the four-phase schedule of Chernikov and Chrisochoides (ICS 2004), extended to any boundary and
 * any grading. The mesh depends only on the figure and the settings, not on the number of threads. It differs from the
 * mesh of tri_mesh_new, which inserts points in another order. Both keep the same bounds and have about the same size.
 *
 * Small meshes are refined sequentially. So are meshes with most_new_points, with a gate or a fence, or with a size
 * test (unsuitable) that must not run in parallel. With a size function (edge_length) that must not run in parallel,
 * one thread follows the schedule. Several threads may call these functions at the same time for different meshes, also
 * inside parallel regions. In a process that was forked after a call, they use one thread. */
#ifndef PTRIANGLE_PAR_H
#define PTRIANGLE_PAR_H

#include "ptriangle/tiles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Like tri_mesh_new and tri_mesh_refine, on all cores. Each refine function also refines meshes of the other library.
 * */
enum tri_status par_mesh_new(struct tri_mesh **mesh, const struct tri_figure *figure,
                             const struct tri_settings *settings, struct tri_error *error);
enum tri_status par_mesh_refine(struct tri_mesh *mesh, const struct tri_settings *settings, struct tri_error *error);

/* Makes the mesh of par_mesh_new and hands it to a sink tile by tile (ptriangle/tiles.h). Points, triangles and
 * segments have the same numbers and order, regardless of the memory and the number of threads.
 *
 * memory: largest resident memory of the process in bytes; 0: no bound. A mesh that needs more, or that is larger than
 * a struct tri_mesh can be, is swept from left to right if min_angle is at most 31. A sweep hands out tiles as they
 * become final, and frees them. So the mesh may have any number of triangles. In memory are the triangulation of the
 * figure, a few columns of tiles, and the data of the sink.
 *
 * Some meshes cannot be swept: those with min_angle above 31, those with sequential refinement, and those in which
 * triangles remain that are large compared with the tiles around them. Such a mesh has at most 2^29 triangles and is
 * kept as a whole. The part that does not fit in memory is kept in files in the directory scratch, up to 90 bytes per
 * triangle. These files have no names, and vanish with the process. If the disk is full, the call returns
 * TRI_CANNOT_WRITE. If scratch is NULL, the mesh is swept if it exceeds the bound, and a mesh that cannot be swept
 * gives TRI_TOO_LARGE. To keep the bound, the process needs some memory beside the mesh: about 40 MB, 50 MB per thread,
 * and a third of the data of a sweep.
 *
 * The caller owns figure, settings and sink, which are only read. The sink is called on the calling thread. If the
 * status is not TRI_OK, the tiles handed out so far are invalid. */
enum tri_status par_mesh_stream(const struct tri_figure *figure, const struct tri_settings *settings, int64_t memory,
                                const char *scratch, const struct tri_sink *sink, struct tri_error *error);

#ifdef __cplusplus
}
#endif

#endif
