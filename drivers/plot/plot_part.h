/* What a picture needs of a mesh of any size, gathered in one pass over its triangles: those in a part of the plane, or
 * how many there are at each pixel. */
#ifndef DRIVERS_PLOT_PLOT_PART_H
#define DRIVERS_PLOT_PLOT_PART_H

#include "drivers/plot/plot.h"
#include "triangle/cdt/reconstruct.h"
#include "triangle/check/check.h"
#include "triangle/mesh/pslg.h"

/* In a picture that shows each: 2^24. In a build with tests PTRIANGLE_TEST_TRIANGLES of the environment. */
int32_t plot_most_triangles(void);

/* The box around all points, a little wider, and never flat. */
enum tri_status plot_part_box(const struct tri_check_source *source, struct plot_box *box, struct tri_error *error);

/* Triangles (with their last attribute) and segments that may show in the window, and their points. TRI_TOO_LARGE: more
 * triangles than can be drawn. */
enum tri_status plot_part_take(const struct tri_check_source *source, const struct plot_box *window,
                               struct tri_pslg *mesh, struct tri_elements *elements, struct tri_error *error);

/* Counts the triangles at each pixel of density->box, and takes segments as above. */
enum tri_status plot_part_count(const struct tri_check_source *source, struct plot_density *density,
                                struct tri_pslg *mesh, struct tri_error *error);

#endif
