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

/* Do the caller's functions (tri_asks_caller) refuse a triangle of these corners, in the mesh's units? Where scale is
 * not 1 they are asked for a mesh `scale` times coarser: the test about the triangle shrunk about its centroid, to
 * 1 / scale of its area. */
bool tri_is_refused(const struct tri_asked *asked, struct tri_point a, struct tri_point b, struct tri_point c,
                    double scale);

/* The same for a triangle with these corners, at quality->area_scale. */
bool tri_is_unsuitable(const struct tri_asked *asked, const tri_vertex_id v[3]);

/* How long an edge the caller's functions let be about a place, in the mesh's units, at quality->area_scale. The size
 * test is probed with equilateral triangles about the place, to a factor of 1.5: from one with edges as long as
 * `longest` down to a 65,536th of it. Where it is content with the first, or with none, it asks for nothing: 1e100. */
double tri_asked_length(const struct tri_asked *asked, struct tri_point at, double longest);

/* Does the triangle break a bound on areas, or do the caller's functions refuse it? */
bool tri_is_too_large(const struct tri_asked *asked, const struct tri_triangle *t, const struct tri_shape *shape);

#endif
