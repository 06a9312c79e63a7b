/* Points on lines, rounded once: the crossing of two segments, and the projection of a point on a line.
 *
 * Computed in doubled precision (about 100 bits) from exact differences and determinants, and rounded at the end.
 *
 * LEMMA. Regardless of the length of the lines and of the angle between them, the result lies within one resolution
 * (see below) of each line that it should lie on. (Exception: for a projection 2^50 times as near to the origin as its
 * point, an error of 2^-52 of the point's resolution is visible.) So rounding errors do not accumulate along a chain of
 * such points. */
#ifndef TRIANGLE_CDT_CROSSING_H
#define TRIANGLE_CDT_CROSSING_H

#include "triangle/mesh/mesh.h"

/* Returns the unit in the last place of the larger coordinate of p, or up to twice that; at least 2^-268. */
static inline double tri_resolution(struct tri_point p)
{
    double larger = fabs(p.x) > fabs(p.y) ? fabs(p.x) : fabs(p.y);
    return 0x1p-52 * (larger > TRI_LEAST_COORDINATE ? larger : TRI_LEAST_COORDINATE);
}

enum { TRI_PLACES = 9 };

/* Returns p itself (i = 0), or p moved by one step in one or both coordinates (0 < i < TRI_PLACES). */
static inline struct tri_point tri_place_beside(struct tri_point p, struct tri_point step, int i)
{
    static const int way[TRI_PLACES][2] = {{0, 0}, {1, 0},  {-1, 0}, {0, 1},  {0, -1},
                                           {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
    struct tri_point q = {tri_round_coordinate(p.x + way[i][0] * step.x),
                          tri_round_coordinate(p.y + way[i][1] * step.y)};
    return q;
}

/* Returns the distance of q from the line through a and b, with a relative error of 2^-48 unless it is far below the
 * resolution. */
double tri_line_distance(struct tri_point a, struct tri_point b, struct tri_point q);

/* Sets *p to the point where the segments from a to b and from c to d cross. Returns false if they only touch or do not
 * meet. */
bool tri_crossing(struct tri_point a, struct tri_point b, struct tri_point c, struct tri_point d, struct tri_point *p);

/* Returns the point nearest to q on the line through a and b. */
struct tri_point tri_onto_line(struct tri_point a, struct tri_point b, struct tri_point q);

#endif
