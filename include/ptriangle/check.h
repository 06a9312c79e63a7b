/* The judge of meshes: asks, never mends, and shares no data structure with the mesher. Any mesher's meshes may be
 * judged.
 *
 * Decided by exact arithmetic: all triangles are counter-clockwise; two of them share nothing, one corner or one whole
 * edge; each edge that is no segment is locally Delaunay; segments are edges, the boundary consists of segments; input
 * points are corners, holes are empty. Within 8 units in the last place of the coordinates: each input segment is a
 * chain of edges, but for pieces outside the mesh or on its boundary; within 16: the convex hull is filled. In double
 * precision: angles and areas. */
#ifndef PTRIANGLE_CHECK_H
#define PTRIANGLE_CHECK_H

#include "ptriangle/tri.h"

#ifdef __cplusplus
extern "C" {
#endif

enum tri_delaunay_kind {
    TRI_DELAUNAY_CONSTRAINED, /* at every edge that is no segment */
    TRI_DELAUNAY_CONFORMING,  /* at every edge, and no point lies in the diametral circle of a segment */
    TRI_DELAUNAY_NOT
};

/* What a mesh must fulfil beside being one. 0: nothing more. */
struct tri_demands {
    size_t size;      /* sizeof(struct tri_demands) */
    double min_angle; /* degrees; triangles below are faults unless a small angle of the input explains them */
    double max_area;
    enum tri_delaunay_kind delaunay;
    bool convex;       /* the triangles fill the convex hull */
    bool ignore_holes; /* holes of the input were not emptied */
    bool renumbered;   /* input points are known by their coordinates, not by number */
    bool keep_hull;    /* the mesh may end along the convex hull of the input's points, too, as tri_settings.keep_hull
                          makes it; else along segments alone */
    bool any_holes;    /* faces may be empty without a hole point: they were chosen by another rule */
};

static inline struct tri_demands tri_no_demands(void)
{
    struct tri_demands demands;
    memset(&demands, 0, sizeof demands);
    demands.size = sizeof demands;
    return demands;
}

struct tri_verdict {
    int64_t n_faults; /* 0: the mesh is as it should be */
    char text[256];   /* the first of them, with the numbers of what is concerned; "" if none */
    int64_t n_points; /* that are corners of triangles */
    int64_t n_edges, n_boundary_edges;
    double smallest_angle, largest_angle; /* degrees; 0 without triangles */
    double smallest_area, largest_area, total_area;
    int64_t n_small;           /* triangles below demands.min_angle .. */
    int64_t n_small_explained; /* .. of these, at, or across from, a small angle of the input */
};

/* Judges points, triangles and segments of `mesh` (its segments not given: the boundary edges take their place). input
 * is what it was made of, compared where it is given; NULL: unknown. TRI_OK says that the judgement took place, not
 * how it came out. TRI_NO_MEMORY, TRI_TOO_LARGE, TRI_BAD_INPUT: an array has not the shape it should have, or
 * a point, hole or region of the input is not finite. O(n + b log b) for n triangles and b boundary edges; about 60
 * bytes a triangle. */
enum tri_status tri_check_figure(const struct tri_figure *mesh, const struct tri_figure *input,
                          const struct tri_demands *demands, struct tri_verdict *verdict, struct tri_error *error);

#ifdef __cplusplus
}
#endif

#endif
