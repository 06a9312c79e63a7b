/* Points that lie on lines, rounded once: where two segments cross, where on a line a point belongs.
 *
 * Computed in doubled precision (about 100 bits) from exact differences and determinants, and rounded at the end.
 * LEMMA. However flat the lines cross and however long they are, the result lies within one resolution (below) of each
 * line that it is meant to lie on (of a foot, that lies 2^50 times as near to the origin as its point, 2^-52 of the
 * point's resolution shows). So rounding errors do not add up along a chain of such points. */
#ifndef TRIANGLE_CDT_CROSSING_H
#define TRIANGLE_CDT_CROSSING_H

#include "triangle/mesh/mesh.h"

/* One unit in the last place of the larger coordinate of p, or up to twice that; no coordinate is finer than 2^-268. */
static inline double tri_resolution(struct tri_point p)
{
    double larger = fabs(p.x) > fabs(p.y) ? fabs(p.x) : fabs(p.y);
    return 0x1p-52 * (larger > TRI_LEAST_COORDINATE ? larger : TRI_LEAST_COORDINATE);
}

enum { TRI_PLACES = 9 };

/* p itself (i = 0) and the places one step away from it in either coordinate or both: i < TRI_PLACES. */
static inline struct tri_point tri_place_beside(struct tri_point p, struct tri_point step, int i)
{
    static const int way[TRI_PLACES][2] = {{0, 0}, {1, 0},  {-1, 0}, {0, 1},  {0, -1},
                                           {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
    struct tri_point q = {tri_round_coordinate(p.x + way[i][0] * step.x),
                          tri_round_coordinate(p.y + way[i][1] * step.y)};
    return q;
}

/* Distance of q from the line through a and b, to a relative 2^-48 where it is not far below the resolution. */
double tri_line_distance(struct tri_point a, struct tri_point b, struct tri_point q);

/* *p: where the segments from a to b and from c to d cross. False where they do not, or only touch. */
bool tri_crossing(struct tri_point a, struct tri_point b, struct tri_point c, struct tri_point d, struct tri_point *p);

/* The point of the line through a and b that is nearest to q. */
struct tri_point tri_onto_line(struct tri_point a, struct tri_point b, struct tri_point q);

#endif
