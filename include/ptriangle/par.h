/* The functions of ptriangle/tri.h on all cores, in the library ptriangle.
 *
 * Refinement follows the four-phase schedule of Chernikov and Chrisochoides (ICS 2004), extended to any boundary and
 * any grading. The mesh depends on the figure and the settings alone, never on the number of threads; it is not the one
 * that tri_mesh_new makes, which inserts points in another order: same bounds, about the same size.
 *
 * A small mesh, or settings with most_new_points, gate, fence, or a size test (unsuitable) that must not run in
 * parallel make it one sequential refinement. A size function (edge_length) leaves one thread to follow the schedule.
 * Calls from several threads, on different meshes, and from within parallel regions are fine.
 * In a child that was forked after a call there is one thread. */
#ifndef PTRIANGLE_PAR_H
#define PTRIANGLE_PAR_H

#include "ptriangle/tiles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* As tri_mesh_new and tri_mesh_refine; meshes made by the one may be refined by the other. */
enum tri_status par_mesh_new(struct tri_mesh **mesh, const struct tri_figure *figure,
                             const struct tri_settings *settings, struct tri_error *error);
enum tri_status par_mesh_refine(struct tri_mesh *mesh, const struct tri_settings *settings, struct tri_error *error);

/* The mesh of par_mesh_new, handed to a sink tile by tile (ptriangle/tiles.h): points, triangles and segments with the
 * same numbers and in the same order, whatever memory there is and however many threads.
 *
 * memory: bytes that the process may have resident; 0: no bound. A mesh that would need more, or be larger than one
 * struct tri_mesh can be, is swept from left to right where min_angle is at most 31: tiles are handed out as they
 * become final, and go; it may have any number of triangles. The figure's own triangulation, a few columns of tiles
 * and what the sink holds are in memory then. Where that cannot be done (above 31 degrees, settings that make it one
 * sequential refinement, or where triangles are left over that are large against the tiles around them) the mesh, of
 * at most 2^29 triangles, is there as a whole. What of this does not fit in memory lies in files in the directory
 * scratch, up to 90 bytes a triangle, which have no names and are gone with the process; a full disk is
 * TRI_CANNOT_WRITE. Without scratch (NULL) the bound decides alone whether the mesh is swept, and one that cannot be is
 * TRI_TOO_LARGE. The bound holds as far as there is room beside the mesh: some 40 MB, 50 MB a thread, and a third of
 * what a sweep has in memory.
 *
 * Figure, settings and sink are the caller's and only read. The calling thread calls the sink. Any status other than
 * TRI_OK: what has been taken is worth nothing. */
enum tri_status par_mesh_stream(const struct tri_figure *figure, const struct tri_settings *settings, int64_t memory,
                                const char *scratch, const struct tri_sink *sink, struct tri_error *error);

#ifdef __cplusplus
}
#endif

#endif
