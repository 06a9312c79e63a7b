/* Verifies meshes of any mesh generator. The checker changes nothing, and shares no data structure with the mesher.
 *
 * In exact arithmetic it verifies that all triangles are counter-clockwise. Two triangles share nothing, one corner, or
 * one whole edge. Each edge that is no segment is locally Delaunay. Segments are edges, and the boundary consists of
 * segments. Input points are corners, and holes are empty.
 *
 * Within 8 units in the last place of the coordinates it verifies that each input segment is a chain of edges, except
 * for parts outside the mesh or on its boundary. Within 16 units it verifies that the mesh fills the convex hull.
 * Angles and areas are computed in double precision. */
#ifndef PTRIANGLE_CHECK_H
#define PTRIANGLE_CHECK_H

#include "ptriangle/tri.h"

#ifdef __cplusplus
extern "C" {
#endif

enum tri_delaunay_kind {
    TRI_DELAUNAY_CONSTRAINED, /* at every edge that is no segment */
    TRI_DELAUNAY_CONFORMING,  /* at every edge, and no point lies in the diametral circle of a segment */
    TRI_DELAUNAY_NOT          /* not checked */
};

/* Additional properties to verify. Members left at 0 request nothing. */
struct tri_demands {
    size_t size;      /* sizeof(struct tri_demands) */
    double min_angle; /* degrees; smaller angles are faults unless a small angle of the input explains them */
    double max_area;  /* of a triangle, in squared units of the coordinates; larger triangles are faults */
    enum tri_delaunay_kind delaunay; /* which Delaunay property to verify */
    bool convex;       /* the triangles fill the convex hull */
    bool ignore_holes; /* holes of the input were not emptied */
    bool renumbered;   /* input points are identified by their coordinates, not by number */
    bool keep_hull;    /* the mesh may also end at the convex hull of the input's points (tri_settings.keep_hull); if
                          false, only at segments */
    bool any_holes;    /* faces may be empty without a hole point, because another rule selected the holes */
};

static inline struct tri_demands tri_no_demands(void)
{
    struct tri_demands demands;
    memset(&demands, 0, sizeof demands);
    demands.size = sizeof demands;
    return demands;
}

/* The result of a check. */
struct tri_verdict {
    int64_t n_faults; /* 0: the mesh passed */
    char text[256];   /* the first fault, with the numbers of its triangles, edges or points; "" if there is none */
    int64_t n_points; /* points that are corners of triangles */
    int64_t n_edges, n_boundary_edges;    /* edges of triangles; edges of one triangle only */
    double smallest_angle, largest_angle; /* degrees; 0 without triangles */
    double smallest_area, largest_area, total_area; /* of triangles, in squared units of the coordinates */
    int64_t n_small;           /* triangles with an angle below demands.min_angle */
    int64_t n_small_explained; /* those of n_small at, or across from, a small angle of the input */
};

/* Verifies the points, triangles and segments of `mesh`. If it has no segments, its boundary edges are used instead.
 * input: the figure that was meshed, to compare with; NULL if unknown. TRI_OK means that the check ran; the result is
 * in *verdict. Errors: TRI_NO_MEMORY; TRI_TOO_LARGE; TRI_BAD_INPUT if an array has the wrong shape, or a point, hole or
 * region of the input is not finite. Time: O(n + b log b) for n triangles and b boundary edges. Memory: about 60 bytes
 * per triangle. */
enum tri_status tri_check_figure(const struct tri_figure *mesh, const struct tri_figure *input,
                          const struct tri_demands *demands, struct tri_verdict *verdict, struct tri_error *error);

#ifdef __cplusplus
}
#endif

#endif
