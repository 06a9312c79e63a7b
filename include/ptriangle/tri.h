/* ptriangle: triangle meshes of plane figures, with a guarantee on every angle. This header makes meshes from arrays on
 * one core. ptriangle/par.h does the same on all cores, ptriangle/files.h reads and writes files, and ptriangle/check.h
 * verifies meshes.
 *
 *     struct tri_figure figure = tri_no_figure();        points, segments, holes, regions
 *     struct tri_settings settings = tri_no_settings();  bounds on angles and sizes, and options
 *     struct tri_mesh *mesh;
 *     struct tri_error error;
 *     figure.points = tri_reals_of(xy, n, 2);
 *     settings.min_angle = 30;
 *     if (tri_mesh_new(&mesh, &figure, &settings, &error) == TRI_OK)
 *         use(tri_mesh_points(mesh), tri_mesh_triangles(mesh));
 *     tri_mesh_delete(mesh);
 *
 * For C11 and C++11 or later. No function prints, exits, or keeps global state. Calls on different meshes may run at
 * the same time, and so may calls that take the same mesh as const. The same input and settings give the same mesh, bit
 * for bit, with any compiler, machine, locale and number of threads.
 *
 * ABI: struct tri_figure and tri_settings begin with their size, which tri_no_figure and tri_no_settings set. If a
 * program was compiled with an older header, newer members have their default, 0. All other structs stay unchanged.
 *
 * Numbers of points, triangles and segments count from 0. One mesh holds up to 2^28 points and 2^29 triangles. */
#ifndef PTRIANGLE_TRI_H
#define PTRIANGLE_TRI_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#ifdef __cplusplus
extern "C" {
#endif

/* --- errors */

enum tri_status {
    TRI_OK = 0,
    TRI_NO_MEMORY,    /* an allocation failed; data that existed before the call are intact */
    TRI_TOO_LARGE,    /* the input has, or the bounds need, more triangles than one mesh can hold */
    TRI_BAD_INPUT,    /* the input is invalid; the text names the fault and its place */
    TRI_CANNOT_READ,  /* a file cannot be opened or read */
    TRI_CANNOT_WRITE, /* a file cannot be created, written or renamed */
    TRI_NO_ROOM,      /* never returned by functions of these headers */
    TRI_INTERNAL,     /* a broken invariant: a defect of this library */
    TRI_STOPPED       /* tri_settings.stop returned true */
};

/* Details of an error. The caller owns the struct, or passes NULL. A call writes to it only if it returns a status
 * other than TRI_OK. */
struct tri_error {
    enum tri_status status;
    char file[1024]; /* "" if the error concerns no file */
    int64_t line;    /* counts from 1; 0 if the error concerns no line */
    char text[512];  /* one sentence without file, line or final newline */
};

/* --- arrays: n rows of `width` numbers. Row i begins at at[i * stride]. `at` may be NULL if n is 0 */

struct tri_reals {
    const double *at;
    int64_t n, width, stride; /* stride: from row to row, in numbers; >= width */
};

struct tri_ints {
    const int32_t *at;
    int64_t n, width, stride;
};

/* Describes rows that follow each other without gaps. */
static inline struct tri_reals tri_reals_of(const double *at, int64_t n, int64_t width)
{
    struct tri_reals reals = {at, n, width, width};
    return reals;
}

static inline struct tri_ints tri_ints_of(const int32_t *at, int64_t n, int64_t width)
{
    struct tri_ints ints = {at, n, width, width};
    return ints;
}

/* --- input */

/* A planar straight line graph (PSLG), or a mesh to refine. The caller owns the arrays. Calls only read them, and do
 * not use them after they return. An array with n = 0 counts as not given. Every figure can be meshed: segments may
 * cross, overlap or touch, and points may coincide. Coordinates are finite, in any unit. */
struct tri_figure {
    size_t size; /* sizeof(struct tri_figure) */
    struct tri_reals points;           /* [n][2] x, y; at least 3 */
    struct tri_reals point_attributes; /* [points.n][any]; of new points: linear over the input's triangulation */
    struct tri_ints point_markers;     /* [points.n][1]; not given: 0 */
    struct tri_ints segments;          /* [n][2] points. A segment with a point that does not exist, or with equal
                                          ends, is skipped and noted. The mesh covers the area that the segments
                                          enclose, or the convex hull if there are no segments */
    struct tri_ints segment_markers;   /* [segments.n][1]; not given: 0 */
    struct tri_reals holes;            /* [n][2] x, y. The area around each of these places, up to the next segments,
                                          is left empty */
    struct tri_reals regions;          /* [n][4] x, y, attribute, largest area (<= 0: no bound). They apply around the
                                          place, up to the next segments. Of two regions in one area the last counts */
    struct tri_ints triangles;         /* [n][3] corners. If given, the figure is a mesh, which is kept and refined.
                                          Holes and regions are ignored; segments that are no edges are left out */
    struct tri_reals triangle_attributes; /* [triangles.n][any] copied to the triangles that replace each triangle */
    struct tri_reals triangle_areas;   /* [triangles.n][1] largest area for those triangles (<= 0: no bound) */
};

static inline struct tri_figure tri_no_figure(void)
{
    struct tri_figure figure;
    memset(&figure, 0, sizeof figure);
    figure.size = sizeof figure;
    return figure;
}

/* --- sizes: the desired length of edges at each place, in the unit of the coordinates. Edges have about that length.
 * Unlike a bound on areas, it is reached on average, not by every edge. */

enum tri_size_kind {
    TRI_SIZE_NUMBER = 1, /* `length` everywhere */
    TRI_SIZE_RASTER,     /* `values` at the nodes of a grid, bilinear between them; outside: nearest node */
    TRI_SIZE_MESH,       /* `values` at `points`, linear in each of the `triangles`; outside: nearest place */
    TRI_SIZE_FUNCTION,   /* `function` */
    TRI_SIZE_NEAR        /* `length` at the segments with this marker, growing by `growth` per unit of distance */
};

/* One source of lengths. The caller owns the arrays. Calls only read them, and do not use them after they return. A
 * length of 0, a negative length or NaN means "no data": the nearest data are used instead. An infinite length sets no
 * bound. */
struct tri_size_field {
    enum tri_size_kind kind;
    double length;           /* NUMBER, NEAR: above 0 */
    double growth;           /* NEAR: >= 0, at most tri_settings.gradation if that is given; < 0: use gradation */
    int32_t marker;          /* NEAR: marker of the segments */
    struct tri_reals values; /* RASTER: [rows][columns], the lowest row first; MESH: [points.n][1] */
    double origin[2];        /* RASTER: x, y of the first value */
    double step[2];          /* RASTER: distance between columns, and between rows; above 0 */
    struct tri_reals points; /* MESH: [n][2] */
    struct tri_ints triangles; /* MESH: [n][3] points; not given: the nearest point counts */
    /* FUNCTION: writes the lengths at n places. It is called before meshing, only on the calling thread, in a few dozen
     * calls with some million places in total. A quadtree keeps the values and interpolates them bilinearly. The error
     * is 0.1% on average, and up to 5% at the places of largest variation. */
    void (*function)(void *user, int64_t n, const double (*at)[2], double *length);
    void *user; /* FUNCTION: passed to it */
};

enum tri_placement {         /* where new points are inserted */
    TRI_PLACEMENT_LATTICE = 0, /* in a hexagonal lattice, if only bounds on areas set the sizes and min_angle is at most
                                  30. This needs a third fewer triangles, most of them equilateral. With a larger
                                  min_angle, edge_length, unsuitable, or a figure with triangles: like CLASSIC. With
                                  `sizes`: like FRONT, except that one constant length gives a lattice inside */
    TRI_PLACEMENT_CLASSIC,     /* at circumcentres, or at the places that are best for angles */
    TRI_PLACEMENT_FRONT        /* for `sizes`, with min_angle at most 30: an advancing front, which starts at the
                                  segments, makes nearly equilateral triangles. Otherwise like CLASSIC */
};

/* Bounds and options for the mesh. Members left at 0 or NULL request nothing. Without bounds on angles or sizes no
 * points are added, and the result is the constrained Delaunay triangulation. */
struct tri_settings {
    size_t size; /* sizeof(struct tri_settings) */
    double min_angle;   /* degrees: no smaller angle, except near small angles of the input. Of 133 real inputs, 101
                           (76%) reach 36 degrees and 31 (23%) reach 38. A larger bound is treated as 38, or as 36 with
                           `conforming`, and noted */
    double max_area;    /* of a triangle, in squared units of the coordinates */
    bool conforming;    /* every triangle is Delaunay, and the diametral circles of subsegments are empty */
    bool keep_hull;     /* mesh the whole convex hull except for the holes; segments need not enclose anything */
    int protect;        /* 1: insert no points on segments of the boundary; 2: on no segment */
    int64_t most_new_points; /* > 0: refinement stops after this number of new points */

    /* Returns the edge length at a place, which bounds areas. No triangle is larger than an equilateral one whose edges
     * have the least length at the triangle's corners and centroid. The median edge length is about 0.8 times this
     * length. Infinite: no bound there. 0, a negative number or NaN sets no bound either, and a note names one such
     * place. Before the first new point the function is called about ten thousand times. The number of calls is at
     * most 2^25, and at most 100 for each triangle of the mesh. The call fails with TRI_TOO_LARGE if the lengths
     * require more triangles than a mesh can hold. */
    double (*edge_length)(void *user, const double at[2]);
    void *edge_length_user;
    /* Returns nonzero if the triangle a, b, c (counter-clockwise) must be refined. Called for triangles that keep all
     * size bounds. In par_mesh_new and par_mesh_refine, with `progress` and with `protect`, it may also be called for
     * smaller temporary triangles inside these, which do not appear in the mesh. Segments that must not be split stay
     * regardless of the result, and so do flat triangles next to them. */
    int (*unsuitable)(void *user, const double a[2], const double b[2], const double c[2], double area);
    void *unsuitable_user;

    /* For schedules of your own. Called for each bad triangle with the point that would remove it. If it returns false,
     * the triangle is deferred, and a later tri_mesh_refine finds it again. An allowed point may also change triangles
     * and split segments that are one or two triangles away. */
    bool (*gate)(void *user, const double at[2]);
    void *gate_user;
    /* [4] x_min, y_min, x_max, y_max, half-open. Refinement changes only triangles whose corners all lie inside. With a
     * fence min_angle is at most 34. */
    const double *fence;

    /* Returns true to stop. The call then returns TRI_STOPPED soon. Called every few thousand steps and calls of other
     * functions, by several threads at once. After it has returned true it must keep returning true. */
    bool (*stop)(void *user);
    void *stop_user;

    /* ptriangle/par.h only */
    int threads;            /* <= 0: OMP_NUM_THREADS, otherwise one for each core */
    bool callbacks_in_parallel; /* several threads may call edge_length and unsuitable at the same time. If false, and
                                   one of them is set, only the calling thread refines. With edge_length the mesh is the
                                   same. With unsuitable it is that of one sequential refinement */
    bool numbered_by_block; /* number new points and triangles as blocks make them, which is faster. If false, they are
                               numbered along a space-filling curve, which makes solvers faster */

    /* Even-odd rule: segments define the domain, and places that an even number of segments separate from the outside
     * are left empty. Places listed in `holes` are emptied as well. Rings may lie in rings. A border that two polygons
     * share, and that both list, has no effect. The exact rule counts only subsegments along which an odd number of
     * segments run, on the path from outside that crosses the fewest. So dangling segments, and single segments across
     * a ring, change nothing. */
    bool even_odd;

    /* Receives the text of tri_mesh_notes, unless it is "", on the calling thread before the call returns. It is useful
     * if there is no struct tri_mesh (par_mesh_stream). */
    void (*note)(void *user, const char *notes);
    void *note_user;

    /* Called periodically during refinement, on the calling thread. done: the estimated share of the work that is done.
     * It starts at 0, never decreases and ends at 1. triangles: the current number of triangles. */
    void (*progress)(void *user, double done, int64_t triangles);
    void *progress_user;

    enum tri_placement placement; /* where new points are inserted */

    /* Desired edge lengths. At each place the least length of all fields counts. min_angle and bounds on areas hold as
     * well. TRI_BAD_INPUT: a field has no data, or no segment has the marker of a NEAR field. */
    const struct tri_size_field *sizes; /* [n_sizes] */
    int64_t n_sizes;    /* number of fields; 0: no lengths */
    double gradation;   /* largest growth of lengths per unit of distance; 0: 0.2; infinite: no limit */
    double min_size;    /* shorter lengths are raised to this; 0: no limit */
    double max_size;    /* > 0: longer lengths are reduced to this, also at places without a field */
    double elements_across; /* > 0: fit this number of edge lengths between boundaries, or borders of regions, that face
                               each other, such as channels and walls */
    double per_circle;  /* > 0: on curved boundaries, fit this number of lengths around a circle of that curvature */
    int optimise;       /* passes of smoothing, at most 1000, which move new points inside regions and, from the
                           second pass on, flip edges to improve the triangles. 0: one if
                           edge lengths are requested, otherwise none; < 0: none. Not with max_area, areas of regions,
                           unsuitable, conforming, most_new_points, a gate or a fence */
};

static inline struct tri_settings tri_no_settings(void)
{
    struct tri_settings settings;
    memset(&settings, 0, sizeof settings);
    settings.size = sizeof settings;
    return settings;
}

/* --- the mesh */

struct tri_mesh;

/* Makes *mesh, which the caller owns and frees with tri_mesh_delete. settings may be NULL. Errors: TRI_NO_MEMORY,
 * TRI_TOO_LARGE, TRI_BAD_INPUT, TRI_STOPPED. After an error *mesh is NULL, with one exception: if refinement ran out of
 * memory or was stopped, *mesh is the valid mesh at that moment. Time: O(n log n), in practice linear. Memory: about
 * 100 bytes per triangle. */
enum tri_status tri_mesh_new(struct tri_mesh **mesh, const struct tri_figure *figure,
                             const struct tri_settings *settings, struct tri_error *error);

/* Refines the mesh further. It may be called any number of times. Size bounds of the figure apply again; keep_hull has
 * no effect. Errors as for tri_mesh_new. After an error the mesh is valid, and refined as far as possible. Arrays that
 * the functions below have returned are no longer valid. */
enum tri_status tri_mesh_refine(struct tri_mesh *mesh, const struct tri_settings *settings, struct tri_error *error);

/* Frees the mesh; mesh may be NULL. */
void tri_mesh_delete(struct tri_mesh *mesh);

/* Return the arrays of the mesh. The mesh owns them, and they are valid until it is refined or deleted. Constant time.
 *   points             [n][2] first the points of the figure in their order, including those that no triangle uses
 *   point_attributes   [points][as given]
 *   point_markers      [points][1] as given, otherwise that of a segment at the point, otherwise 1 on the boundary
 *   triangles          [n][3] corners, counter-clockwise
 *   triangle_attributes [triangles][1] attributes of regions, 0 outside all regions. If the figure has triangles: as
 *                      given there. n is 0 if no attributes were given
 *   segments           [n][2] subsegments, each in the direction of its segment, and edges of the boundary
 *   segment_markers    [segments][1] as given, otherwise 1 on the boundary */
struct tri_reals tri_mesh_points(const struct tri_mesh *mesh);
struct tri_reals tri_mesh_point_attributes(const struct tri_mesh *mesh);
struct tri_ints tri_mesh_point_markers(const struct tri_mesh *mesh);
struct tri_ints tri_mesh_triangles(const struct tri_mesh *mesh);
struct tri_reals tri_mesh_triangle_attributes(const struct tri_mesh *mesh);
struct tri_ints tri_mesh_segments(const struct tri_mesh *mesh);
struct tri_ints tri_mesh_segment_markers(const struct tri_mesh *mesh);

/* Return further arrays, which the mesh owns as well. The first call computes them in O(triangles). TRI_NO_MEMORY.
 *   neighbors  [triangles][3] the triangle opposite each corner, or -1
 *   edges      [n][2] points
 *   markers    [edges][1] marker of the segment on this edge, otherwise 0; pass NULL to skip them */
enum tri_status tri_mesh_neighbors(struct tri_mesh *mesh, struct tri_ints *neighbors, struct tri_error *error);
enum tri_status tri_mesh_edges(struct tri_mesh *mesh, struct tri_ints *edges, struct tri_ints *markers,
                               struct tri_error *error);

/* Fills a figure with the arrays above, for ptriangle/files.h and ptriangle/check.h, or as the input of another mesh.
 * The caller initialises *figure with tri_no_figure. Only members within figure->size are written. */
void tri_mesh_figure(const struct tri_mesh *mesh, struct tri_figure *figure);

/* --- notes, counts, and triangles that violate the bounds */

/* Returns warnings about the input and settings, one per line. They say why the mesh is empty ("the mesh is empty: the
 * outline is open at points 3 and 17"), that segments were skipped, that edge_length returned an invalid length, or
 * that min_angle is above 38. Usually the text is "". The mesh owns it, and it is valid until the mesh is refined or
 * deleted. */
const char *tri_mesh_notes(const struct tri_mesh *mesh);

enum tri_count {
    TRI_COUNT_DUPLICATES,       /* unused points that coincide with a point of lower number */
    TRI_COUNT_CROSSINGS,        /* points inserted where segments cross */
    TRI_COUNT_SKIPPED_SEGMENTS, /* segments with a missing point or equal ends; for a mesh: that are no edges */
    TRI_COUNT_NEW_POINTS,       /* points that the last refinement inserted inside triangles */
    TRI_COUNT_NEW_POINTS_ON_SEGMENTS, /* points that the last refinement inserted on segments */
    TRI_COUNT_GATED,            /* how often the gate rejected a point in the last refinement */
    TRI_COUNT_FENCED            /* how often the fence rejected a point in the last refinement */
};

/* Returns one of these counts. */
int64_t tri_mesh_count(const struct tri_mesh *mesh, enum tri_count what);

enum tri_reason { /* why a triangle violates the bounds */
    TRI_REASON_INPUT_ANGLE, /* it lies at, or across from, a small angle between segments */
    TRI_REASON_NARROW_GAP,  /* it lies in a gap between two segments that is too narrow to fill at reasonable cost */
    TRI_REASON_PROTECTED,   /* settings.protect */
    TRI_REASON_LIMIT,       /* settings.most_new_points, or the angle bound would need an endless number of points */
    TRI_REASON_PRECISION,   /* points would be closer to each other than coordinates can resolve */
    TRI_REASON_DEFERRED,    /* gate, fence, or not refined with these settings yet */
    TRI_REASONS             /* the number of reasons */
};

/* Returns the number of triangles that violate the bounds of these settings, or -1 if the settings are invalid.
 * by_reason[n_reasons] receives the number for each reason, or is NULL. Its last element also counts reasons that do
 * not fit. O(triangles). Callbacks are called on this thread. */
int64_t tri_mesh_count_bad(const struct tri_mesh *mesh, const struct tri_settings *settings, int64_t *by_reason,
                           int n_reasons);

/* Returns the version of the library, such as "0.2.0". */
const char *tri_version(void);

#ifdef __cplusplus
}
#endif

#endif
