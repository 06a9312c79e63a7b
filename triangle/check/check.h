/* The mesh checker: tests a mesh, never repairs it, and shares no mesh data structure with the mesher.
 *
 * THEOREM (docs/theory.md, the judge). Triangles form a triangulation if and only if (1) each is strictly
 * counter-clockwise, (2) every directed edge belongs to at most one of them, and (3) the boundary edges (those of
 * one triangle only) meet only at common ends, no two boundary vertices coincide, and the boundary winds 0 or 1
 * times around every point. These conditions are decided by exact predicates and comparisons. So are the demands of
 * the input: Delaunay, conforming, segments, border, holes, regions, midside nodes.
 * TOLERANCE. Each input segment is a chain of subsegments whose vertices are off its line by at most TRI_CHECK_ULPS
 * * 2^-52 * (the segment's largest coordinate). Angles and areas may miss their bounds by a relative 1e-12 (of the
 * squared sine, of the area).
 * COST. O(n + b log b) time for n triangles and b boundary edges, subsegments and input points. About 90 bytes per
 * triangle in addition to the given arrays, or a fixed amount of memory: see tri_check_source. */
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

/* The mesh to check. Indices start at 0; all arrays are borrowed. */
struct tri_check_mesh {
    int32_t n_points;     /* vertices */
    const double *points; /* [n_points][2] x, y */
    int32_t n_triangles;  /* triangles */
    const int32_t *triangles; /* [n_triangles][3] corners */
    const int32_t *neighbors; /* [n_triangles][3] triangle opposite each corner, -1: none; NULL: not given */
    int32_t n_segments;       /* subsegments */
    const int32_t *segments; /* [n_segments][2] ends of the subsegments; NULL: not given, boundary edges are used
                                instead */
    const int32_t *segment_markers; /* [n_segments]; NULL: not given */
    const int32_t *point_markers;   /* [n_points]; NULL: not given */
    int32_t n_attributes;           /* attributes per triangle */
    const double *attributes; /* [n_triangles][n_attributes], the last is the region's; NULL: not given */
    int32_t n_nodes;          /* rows of points and point_markers; more than n_points if there are midside nodes */
    const int32_t *middles;   /* [n_triangles][3] midside node of the edge opposite each corner; NULL: none */
    int32_t n_point_attributes;     /* attributes per vertex */
    const double *point_attributes; /* [n_points or n_nodes][n_point_attributes]; NULL: not given */
};

/* The arrays of a mesh of any size, which are read in slices. */
enum tri_check_array {
    TRI_CHECK_POINTS,          /* double[2] */
    TRI_CHECK_CORNERS,         /* int64_t[3] */
    TRI_CHECK_NEIGHBORS_GIVEN, /* int64_t[3]; -1: none */
    TRI_CHECK_ATTRIBUTES,      /* double: the last attribute of each triangle */
    TRI_CHECK_POINT_MARKERS,   /* int32_t */
    TRI_CHECK_SEGMENT_ENDS,    /* int64_t[2] */
    TRI_CHECK_SEGMENT_MARKERS, /* int32_t */
    TRI_CHECK_MIDDLES,         /* int64_t[3] */
    TRI_CHECK_POINT_ATTRIBUTES, /* double[n_point_attributes] */
    TRI_CHECK_N_ARRAYS
};

struct tri_check_source {
    int64_t n_points, n_triangles, n_segments; /* vertices, triangles, subsegments */
    int64_t n_nodes; /* rows of points; those after the first n_points are midside nodes */
    int32_t n_point_attributes;                /* attributes per vertex */
    unsigned given; /* bit mask: 1 << array for each array that exists; points and corners always exist */
    /* Reads elements first .. first + n - 1 of the array into out. Called by one thread. */
    enum tri_status (*read)(void *user, enum tri_check_array array, int64_t first, int64_t n, void *out,
                            struct tri_error *error);
    void *user; /* passed to read */
    /* Bytes that the check may use in addition to what is already used; 0: no limit. It needs one byte per vertex
     * and the memory for subsegments, boundary edges and the input, and divides the rest; if the limit is too small,
     * it uses the minimum it needs. Unpaired half-edges that do not fit are stored in anonymous files in the folder
     * `scratch` (NULL: /tmp). There are few of them if vertex numbers are local, otherwise up to 3 per triangle, 112
     * bytes each. */
    double memory;
    double beside; /* bytes of that limit that the program uses for other purposes */
    const char *scratch; /* folder for temporary files; NULL: /tmp */
};

/* The fraction of its memory limit that a check plans to use. */
#define TRI_CHECK_SHARE 0.75

/* Measured peak memory without a limit, in bytes per triangle and per subsegment. */
enum { TRI_CHECK_BYTES = 72, TRI_CHECK_SUB_BYTES = 400 };

/* Returns the memory in bytes that the check needs under any limit: one byte per vertex, up to 370 per subsegment, and
 * the input (NULL: none). If no subsegments are listed, the mesh is assumed to have no holes. If that is wrong and the
 * limit does not suffice, the check returns TRI_NO_MEMORY with a message. */
double tri_check_least_bytes(const struct tri_check_source *source, const struct tri_pslg *input);

/* Returns the memory limit to use if tri_check_least_bytes returned `least`; 0: none, since little memory is needed. */
double tri_check_bound(const struct tri_check_source *source, double least);

enum tri_check_delaunay { TRI_CHECK_CONSTRAINED, TRI_CHECK_CONFORMING, TRI_CHECK_NOT_DELAUNAY };

/* Where the mesh may end, in addition to input segments. */
enum tri_check_border {
    TRI_CHECK_BORDER_SEGMENTS, /* nowhere else; if the input has no segments, at the convex hull of its points */
    TRI_CHECK_BORDER_HULL,     /* at the convex hull as well (concavities are kept, -c) */
    TRI_CHECK_BORDER_ANY       /* anywhere: the mesh is a refinement of a mesh that ended there */
};

struct tri_check_options {
    double min_angle;         /* degrees; 0: no bound */
    double small_input_angle; /* degrees; input angles below this are small; 0: 60 */
    double max_area;          /* 0: no bound */
    const double *max_areas;  /* [n_triangles] bound for each triangle, <= 0: none; NULL: none at all */
    enum tri_check_delaunay delaunay; /* which Delaunay property to check */
    /* >= 0: this many triangles may violate the angle bound, for any reason; < 0: only triangles explained by a
     * small input angle may violate it (see tri_check_report) */
    int64_t max_bad;
    enum tri_check_border border; /* where the mesh may end */
    bool convex;       /* the mesh must fill its convex hull, within the tolerance above, and use every point */
    bool renumbered;   /* unused input vertices were removed (-j): input vertices are found by their coordinates */
    bool ignore_holes; /* hole points of the input were not carved */
    bool any_holes;    /* faces may be empty without a hole point: the mesher uses another rule */
    bool ignore_lost;  /* unused vertices may lie inside the mesh (refined meshes keep the vertices of their input) */
    int32_t base;      /* number of the first vertex and triangle in the report's texts */
    const struct tri_executor *executor; /* runs parallel tasks; NULL: none. The report does not depend on it */
    int32_t n_threads; /* approximate number of its threads; 0: one */
};

/* The kinds of faults. Each kind depends on earlier kinds only. */
enum tri_check_kind {
    TRI_CHECK_ARRAYS,      /* corners are vertices, coordinates are in the range of predicates.h */
    TRI_CHECK_ORIENTATION, /* condition (1) */
    TRI_CHECK_EDGES,       /* condition (2) */
    TRI_CHECK_NEIGHBORS,   /* the given neighbours agree with the edges */
    TRI_CHECK_OVERLAP,     /* condition (3); the sweep stops at the first fault, so the count is 0 or 1 */
    TRI_CHECK_HULL,        /* options.convex */
    TRI_CHECK_SUBSEGMENTS, /* each listed subsegment is an edge of the mesh and is listed once */
    TRI_CHECK_BOUNDARY,    /* each boundary edge is a listed subsegment */
    TRI_CHECK_LOCAL_DELAUNAY, /* empty circumcircles */
    TRI_CHECK_ENCROACHMENT,   /* empty diametral circles */
    TRI_CHECK_INPUT_VERTICES, /* the first vertices equal those of the input */
    TRI_CHECK_LOST_VERTICES,  /* an input vertex (without input: any vertex) inside the mesh is not used by a
                                 triangle */
    TRI_CHECK_INPUT_SEGMENTS,
    /* Subsegments have the first non-zero marker of the input segments they lie on; otherwise 1 on the boundary and
     * 0 inside. Only checked if input and markers are given. If nearly coincident chains make it unclear which
     * subsegments an input segment runs along, any choice is accepted. */
    TRI_CHECK_MARKERS,
    TRI_CHECK_BORDER,         /* the mesh ends only where options.border allows */
    /* A used vertex has the marker of its input point if that is not zero; otherwise that of a subsegment or input
     * segment through it, or 1 on the boundary; otherwise 0. */
    TRI_CHECK_VERTEX_MARKERS,
    TRI_CHECK_HOLES,
    TRI_CHECK_FACES, /* every empty face has a hole point; not checked with any_holes, nor in refined meshes
                        (ignore_lost, BORDER_ANY) */
    TRI_CHECK_NODES,             /* midside nodes; their markers if those of points and subsegments are given */
    TRI_CHECK_VERTEX_ATTRIBUTES, /* values and range; checked if there are attributes, and an input or midside nodes */
    TRI_CHECK_REGIONS, /* region attributes; checked if attributes and input regions are given, and border is not
                          BORDER_ANY */
    TRI_CHECK_ANGLES,
    TRI_CHECK_AREAS,
    TRI_N_CHECKS
};

enum tri_check_state { TRI_CHECK_SKIPPED, TRI_CHECK_OK, TRI_CHECK_FAILED };

struct tri_check_item {
    enum tri_check_state state; /* skipped: not requested, or impossible because of an earlier fault */
    int64_t count;              /* number of faults of this kind */
    char text[200];             /* the first fault, with the numbers of the vertices or triangles; "" if none */
};

struct tri_check_report {
    struct tri_check_item item[TRI_N_CHECKS]; /* result of each kind */
    int64_t n_used_points; /* vertices used by triangles */
    int64_t n_edges, n_boundary_edges;    /* edges; edges of one triangle only */
    double smallest_angle, largest_angle; /* degrees; 0 if there are no triangles */
    double smallest_area, largest_area, total_area;                                 /* 0 if there are no triangles */
    int64_t smallest_angle_at, largest_angle_at, smallest_area_at, largest_area_at; /* triangle numbers from 0; -1:
                                                                                       none */
    int64_t n_small;                                                                /* triangles below min_angle */
    /* Triangles below min_angle that a small input angle explains. An apex is a vertex at which two subsegments meet
     * at less than options.small_input_angle with the mesh between them. A triangle is explained if one of its
     * corners, or a vertex joined to a corner by an edge, is an apex, or if two corners lie on the two legs
     * (straight chains) of one apex. */
    int64_t n_small_explained;
    int64_t n_apexes; /* vertices with a small input angle */
};

/* Checks the mesh, and compares it with the input (NULL: unknown). TRI_OK means that the check was completed, not
 * that the mesh passed: see tri_check_passed. Also returns TRI_NO_MEMORY, TRI_TOO_LARGE (more than 2^30 subsegments
 * or boundary edges) or TRI_BAD_INPUT (a coordinate of the input is not finite). */
enum tri_status tri_check(const struct tri_check_mesh *mesh, const struct tri_pslg *input,
                          const struct tri_check_options *options, struct tri_check_report *report,
                          struct tri_error *error);

/* The same for a mesh of any size, given as a source. The memory limit does not affect the result, with one
 * exception: if three triangles share an edge, it may affect which faults are reported. Also returns
 * TRI_CANNOT_WRITE and the errors of source->read. */
enum tri_status tri_check_from(const struct tri_check_source *source, const struct tri_pslg *input,
                               const struct tri_check_options *options, struct tri_check_report *report,
                               struct tri_error *error);

/* Wraps arrays in memory as a source. *mesh must stay valid as long as the source is used. */
struct tri_check_source tri_check_source_of(const struct tri_check_mesh *mesh);

/* Returns true if no kind failed. */
bool tri_check_passed(const struct tri_check_report *report);

/* Returns a short name for users, such as "orientation"; a constant string. */
const char *tri_check_name(enum tri_check_kind kind);

#ifdef __cplusplus
}
#endif

#endif
