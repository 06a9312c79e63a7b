/* Subsegments that a new point encroaches although they are no walls of its cavity. */
#ifndef TRIANGLE_HIDDEN_WALL_H
#define TRIANGLE_HIDDEN_WALL_H

#include "triangle/cavity.h"
#include "triangle/refine.h"

/* Looks behind the edges of the cavity of a new point, which tri_cavity_search has found, for a subsegment that the
 * point would see under too wide an angle (lens_cos2, see quality.h) if a triangle between them did not keep it out
 * of the cavity. Those that must not be split (-Y) are passed over. *s receives it, or TRI_NONE. TRI_SEARCH_FENCED:
 * where there may be one is not owned; TRI_SEARCH_BEYOND: it is not here (cavity->beyond). Reads the mesh only, and
 * of it what a cavity search may read. O(edges), and the way. */
enum tri_search tri_find_hidden_wall(struct tri_cavity *cavity, const struct tri_mesh *mesh,
                                     const struct tri_refine_options *options, double lens_cos2, tri_sub_id *s);

#endif
