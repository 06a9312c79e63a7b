/* The judge of meshes: asks, never mends, and shares no form of a mesh with the mesher it judges.
 *
 * THEOREM (docs/theory.md, the judge). Triangles are a triangulation if and only if (1) each is strictly
 * counter-clockwise, (2) every directed edge belongs to at most one of them, and (3) the boundary edges, those of one
 * triangle only, meet nowhere but at common ends, two boundary vertices never lie at one place, and the boundary winds
 * 0 or 1 times around every point. These are decided by exact predicates and comparisons, and so is what the input asks
 * for: Delaunay, conforming, segments, border, holes, regions, nodes amid edges.
 *
 * TOLERANCE. Each input segment is a chain of subsegments whose vertices are at most TRI_CHECK_ULPS * 2^-52 * (the
 * segment's largest coordinate) off its line. Angles and areas may miss their bounds by a relative 1e-12 (of the
 * squared sine, of the area).
 *
 * Cost: O(n + b log b) time for n triangles and b boundary edges, subsegments and input points; about 90 bytes a
 * triangle beside the arrays given, or within a bound: see tri_check_source. */
#ifndef TRIANGLE_CHECK_H
#define TRIANGLE_CHECK_H

#include <stdbool.h>
#include <stdint.h>

#include "triangle/base/executor.h"
#include "triangle/base/status.h"
#include "triangle/mesh/pslg.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { TRI_CHECK_ULPS = 8 };

/* The mesh on trial. Indices from 0; nothing is owned. */
struct tri_check_mesh {
    int32_t n_points;
    const double *points; /* [n_points][2] x, y */
    int32_t n_triangles;
    const int32_t *triangles; /* [n_triangles][3] corners */
    const int32_t *neighbors; /* [n_triangles][3] triangle opposite each corner, -1: none; or NULL: not given */
    int32_t n_segments;
    const int32_t *segments; /* [n_segments][2] subsegments; NULL: not given, the boundary edges take their place */
    const int32_t *segment_markers; /* [n_segments] or NULL: not given */
    const int32_t *point_markers;   /* [n_points] or NULL: not given */
    int32_t n_attributes;
    const double *attributes; /* [n_triangles][n_attributes], the last is the region's; or NULL: not given */
    int32_t n_nodes;          /* rows of points and point_markers, if more than n_points: there are nodes amid edges */
    const int32_t *middles;   /* [n_triangles][3] node amid the edge opposite each corner; NULL: there are none */
    int32_t n_point_attributes;
    const double *point_attributes; /* [n_points, or n_nodes][n_point_attributes]; or NULL: not given */
};

/* A mesh of any size, as arrays that are read in slices. */
enum tri_check_array {
    TRI_CHECK_POINTS,          /* double[2] */
    TRI_CHECK_CORNERS,         /* int64_t[3] */
    TRI_CHECK_NEIGHBORS_GIVEN, /* int64_t[3]; -1: none */
    TRI_CHECK_ATTRIBUTES,      /* double: the last attribute of a triangle */
    TRI_CHECK_POINT_MARKERS,   /* int32_t */
    TRI_CHECK_SEGMENT_ENDS,    /* int64_t[2] */
    TRI_CHECK_SEGMENT_MARKERS, /* int32_t */
    TRI_CHECK_MIDDLES,         /* int64_t[3] */
    TRI_CHECK_POINT_ATTRIBUTES, /* double[n_point_attributes] */
    TRI_CHECK_N_ARRAYS
};

struct tri_check_source {
    int64_t n_points, n_triangles, n_segments;
    int64_t n_nodes; /* rows of points and what goes with them: behind n_points the nodes amid edges, if any */
    int32_t n_point_attributes;
    unsigned given; /* 1 << array, of each that there is; points and corners always are */
    /* Elements first .. first + n - 1 of the array into out. Called by one thread. */
    enum tri_status (*read)(void *user, enum tri_check_array array, int64_t first, int64_t n, void *out,
                            struct tri_error *error);
    void *user;
    /* Bytes that the trial may use on top of what is used already; 0: no bound. It takes a byte for each vertex, what
     * subsegments, boundary edges and the input need, and shares out the rest; with too little it takes what it must.
     * Half-edges that wait for their other side are kept in nameless files in the folder `scratch` (NULL: /tmp)
     * where they are too many: few, if numbers are local; up to 3 for each triangle, 112 bytes each, if not. */
    double memory;
    double beside; /* bytes that the program takes beside the trial, within that bound */
    const char *scratch;
};

/* The share of its bound that a trial reckons with. */
#define TRI_CHECK_SHARE 0.75

/* Bytes that it takes at the peak without a bound, for a triangle and for a subsegment. Measured. */
enum { TRI_CHECK_BYTES = 72, TRI_CHECK_SUB_BYTES = 400 };

/* That share of the bytes that it takes whatever its bound: a byte for each vertex, up to 370 for each subsegment, and
 * the input (NULL: none). Where no subsegments are listed the mesh is thought to have no holes; a trial that finds out
 * otherwise, and that its bound will not do, ends with TRI_NO_MEMORY and says so. */
double tri_check_least_bytes(const struct tri_check_source *source, const struct tri_pslg *input);

/* The bound that a trial should have which takes so many of them; 0: so little that any will do. */
double tri_check_bound(const struct tri_check_source *source, double least);

enum tri_check_delaunay { TRI_CHECK_CONSTRAINED, TRI_CHECK_CONFORMING, TRI_CHECK_NOT_DELAUNAY };

/* Where the mesh may end, beside along segments of the input. */
enum tri_check_border {
    TRI_CHECK_BORDER_SEGMENTS, /* nowhere; where the input has no segments, along the convex hull of its points */
    TRI_CHECK_BORDER_HULL,     /* along that hull (concavities stay, -c) */
    TRI_CHECK_BORDER_ANY       /* anywhere: a mesh was refined that ended there */
};

struct tri_check_options {
    double min_angle;         /* degrees; 0: no bound */
    double small_input_angle; /* degrees; what counts as a small input angle; 0: 60 */
    double max_area;          /* 0: no bound */
    const double *max_areas;  /* [n_triangles], <= 0: none; or NULL */
    enum tri_check_delaunay delaunay;
    /* >= 0: that many triangles may lie below the angle bound, for any reason; < 0: those, and only those, that a small
     * input angle explains (see tri_check_report) */
    int64_t max_bad;
    enum tri_check_border border;
    bool convex;       /* the mesh must fill the convex hull, within the tolerance above, and use every point */
    bool renumbered;   /* unused input vertices were dropped (-j): input vertices are known by coordinates alone */
    bool ignore_holes; /* hole points of the input were not carved */
    bool any_holes;    /* faces may be empty without a hole point: the mesher chose them by another rule */
    bool ignore_lost;  /* unused vertices may lie inside the mesh (a refined mesh keeps those it was given) */
    int32_t base;      /* number of the first vertex and triangle in the texts of the report */
    const struct tri_executor *executor; /* does what can be done in shares; NULL: nobody. The report is the same */
    int32_t n_threads; /* that it has, about; 0: one */
};

/* One kind of fault each, in the order in which a later kind leans on the earlier ones. */
enum tri_check_kind {
    TRI_CHECK_ARRAYS,      /* corners in range, coordinates in the range of predicates.h */
    TRI_CHECK_ORIENTATION, /* (1) */
    TRI_CHECK_EDGES,       /* (2) */
    TRI_CHECK_NEIGHBORS,   /* the neighbours given are those that the edges say */
    TRI_CHECK_OVERLAP,     /* (3); the sweep stops at the first fault, so the count is 0 or 1 */
    TRI_CHECK_HULL,        /* options.convex */
    TRI_CHECK_SUBSEGMENTS, /* each listed subsegment is an edge of the mesh, and listed once */
    TRI_CHECK_BOUNDARY,    /* each boundary edge is a listed subsegment */
    TRI_CHECK_LOCAL_DELAUNAY, /* (4) */
    TRI_CHECK_ENCROACHMENT,   /* (5), diametral circles */
    TRI_CHECK_INPUT_VERTICES, /* first vertices equal those of the input */
    TRI_CHECK_LOST_VERTICES,  /* input vertex (without input: any vertex) that no triangle uses, in the mesh's area */
    TRI_CHECK_INPUT_SEGMENTS,
    /* Subsegments carry the first non-zero marker of the input segments they lie on, else 1 on the boundary, else 0;
     * only where input and markers are given. Where nearly coincident chains leave it open which of them an input
     * segment runs along, any choice is good. */
    TRI_CHECK_MARKERS,
    TRI_CHECK_BORDER,         /* (7) */
    /* Vertices in use carry the marker of their input point, if that is not zero; else that of a subsegment or input
     * segment through them, or 1 on the boundary; else 0. */
    TRI_CHECK_VERTEX_MARKERS,
    TRI_CHECK_HOLES,
    TRI_CHECK_FACES, /* (8); not with any_holes, nor in refined meshes, which keep theirs (ignore_lost, BORDER_ANY) */
    TRI_CHECK_NODES,             /* (10); of markers where those of points and subsegments are given */
    TRI_CHECK_VERTEX_ATTRIBUTES, /* (11), and the range; where there are some, and an input or nodes amid edges */
    TRI_CHECK_REGIONS, /* (9); where attributes and input regions are given, not where border is BORDER_ANY */
    TRI_CHECK_ANGLES,
    TRI_CHECK_AREAS,
    TRI_N_CHECKS
};

enum tri_check_state { TRI_CHECK_SKIPPED, TRI_CHECK_OK, TRI_CHECK_FAILED };

struct tri_check_item {
    enum tri_check_state state; /* skipped: not asked for, or impossible because of an earlier kind of fault */
    int64_t count;              /* faults of this kind */
    char text[200];             /* the first one, with the numbers of what is concerned; "" if none */
};

struct tri_check_report {
    struct tri_check_item item[TRI_N_CHECKS];
    int64_t n_used_points; /* corners of some triangle */
    int64_t n_edges, n_boundary_edges;
    double smallest_angle, largest_angle; /* degrees; 0 without triangles */
    double smallest_area, largest_area, total_area;
    int64_t smallest_angle_at, largest_angle_at, smallest_area_at, largest_area_at; /* triangles from 0; -1: none */
    int64_t n_small;                                                                /* triangles below min_angle */
    /* Explained: a corner, or a vertex joined to a corner by an edge, is an apex: a vertex where two subsegments meet
     * at less than options.small_input_angle with the mesh between them; or two corners lie on the two legs of one
     * apex (straight chains from it). */
    int64_t n_small_explained;
    int64_t n_apexes;
};

/* Judges the mesh; the input (NULL: unknown) is compared where it is given. TRI_OK says that the judgement took place,
 * not how it came out: see tri_check_passed. TRI_NO_MEMORY, TRI_TOO_LARGE (more than 2^30 subsegments or boundary
 * edges), TRI_BAD_INPUT (a coordinate of the input is not finite). */
enum tri_status tri_check(const struct tri_check_mesh *mesh, const struct tri_pslg *input,
                          const struct tri_check_options *options, struct tri_check_report *report,
                          struct tri_error *error);

/* The same of a mesh of any size: of the arrays of a source. The memory decides nothing but, where three triangles lie
 * on one edge, which faults are told. Also
 * TRI_CANNOT_WRITE, and what source->read returns. */
enum tri_status tri_check_from(const struct tri_check_source *source, const struct tri_pslg *input,
                               const struct tri_check_options *options, struct tri_check_report *report,
                               struct tri_error *error);

/* Arrays in memory as a source. *mesh must live as long. */
struct tri_check_source tri_check_source_of(const struct tri_check_mesh *mesh);

/* No kind failed. */
bool tri_check_passed(const struct tri_check_report *report);

/* A few words for people, such as "orientation"; a constant string. */
const char *tri_check_name(enum tri_check_kind kind);

#ifdef __cplusplus
}
#endif

#endif
