/* The sizes that are asked for, at a place and of a triangle. Nothing here changes the mesh. */
#ifndef TRIANGLE_SIZE_ASKED_H
#define TRIANGLE_SIZE_ASKED_H

#include "triangle/geometry/shape.h"
#include "triangle/mesh/mesh.h"
#include "triangle/size/quality.h"

/* Who asks for what, of which mesh. Both are borrowed. */
struct tri_asked {
    const struct tri_mesh *mesh;
    const struct tri_quality *quality;
    double area2; /* twice the bound for all areas, in the mesh's units; infinity: none */
};

struct tri_asked tri_asked_of(const struct tri_mesh *mesh, const struct tri_quality *quality);

/* The smaller of the bound for all areas and that of a region. */
double tri_area2_in_region(const struct tri_asked *asked, tri_region_id region);

/* Twice the largest area allowed in a region, in the mesh's units; infinity where there is no bound. */
static inline double tri_area2_bound(const struct tri_asked *asked, tri_region_id region)
{
    return asked->quality->region_areas ? tri_area2_in_region(asked, region) : asked->area2;
}

/* Do the caller's functions (tri_asks_caller) refuse a triangle of these corners, in the mesh's units? A
 * quality->area_scale above 1 asks on behalf of a coarser mesh: the size test sees the triangle shrunk about its
 * centroid, to 1 / area_scale of its area. */
bool tri_is_refused(const struct tri_asked *asked, struct tri_point a, struct tri_point b, struct tri_point c);

/* The same for a triangle with these corners. */
bool tri_is_unsuitable(const struct tri_asked *asked, const tri_vertex_id v[3]);

/* The longest edge that the caller's functions accept about a place in a triangle, in the mesh's units, at
 * quality->area_scale. The size test is asked about the triangle shrunk about the place, from the whole down to a
 * 65,536th of its lengths; an edge is that of an equilateral triangle of the same area, to a factor of 1.5. A test that
 * accepts the first, or refuses all, asks for nothing: 1e100. */
double tri_asked_length(const struct tri_asked *asked, const struct tri_point triangle[3], struct tri_point at);

/* Does the triangle break a bound on areas, or do the caller's functions refuse it? */
bool tri_is_too_large(const struct tri_asked *asked, const struct tri_triangle *t, const struct tri_shape *shape);

#endif
