/* ptriangle: triangle meshes of plane figures, with a guarantee on every angle. From arrays to arrays, on one core;
 * ptriangle/par.h has the same on all cores, ptriangle/files.h reads and writes, ptriangle/check.h judges.
 *
 *     struct tri_figure figure = tri_no_figure();        points, segments, holes, regions
 *     struct tri_settings settings = tri_no_settings();  what is wanted
 *     struct tri_mesh *mesh;
 *     struct tri_error error;
 *     figure.points = tri_reals_of(xy, n, 2);
 *     settings.min_angle = 30;
 *     if (tri_mesh_new(&mesh, &figure, &settings, &error) == TRI_OK)
 *         use(tri_mesh_points(mesh), tri_mesh_triangles(mesh));
 *     tri_mesh_delete(mesh);
 *
 * C11 and later, C++11 and later. No call prints, ends the process or keeps anything beside the mesh; calls on
 * different meshes may run at the same time, and so may calls on one mesh that take it const. The same input and
 * settings give the same mesh, bit for bit, with any compiler, machine, locale and number of threads.
 *
 * ABI. struct tri_figure and tri_settings begin with their size, which tri_no_figure and tri_no_settings set: a program
 * compiled with an older header gets 0, the default, for members that came later. All other structs stay as they are.
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
    TRI_NO_MEMORY,    /* an allocation failed; what existed before the call is intact */
    TRI_TOO_LARGE,    /* more than one mesh can hold, also where bounds ask for it */
    TRI_BAD_INPUT,    /* the input's content is at fault; the text says what and where */
    TRI_CANNOT_READ,  /* a file cannot be opened or read */
    TRI_CANNOT_WRITE, /* a file cannot be created, written or renamed */
    TRI_NO_ROOM,      /* never returned by functions of these headers */
    TRI_INTERNAL,     /* an invariant does not hold: a defect of this library */
    TRI_STOPPED       /* somebody asked for it, see tri_settings.stop */
};

/* The caller's; NULL where he does not care. Filled where a call returns another status than TRI_OK, else untouched. */
struct tri_error {
    enum tri_status status;
    char file[1024]; /* "" where no file is concerned */
    int64_t line;    /* 1-based; 0 where no line is concerned */
    char text[512];  /* one sentence without file, line or final newline */
};

/* --- arrays: n rows of `width` numbers, row i begins at at[i * stride]. NULL where n is 0 */

struct tri_reals {
    const double *at;
    int64_t n, width, stride; /* stride >= width, in numbers */
};

struct tri_ints {
    const int32_t *at;
    int64_t n, width, stride;
};

/* Rows that lie behind one another. */
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

/* --- what is given */

/* A planar straight line graph, or a mesh that is to be refined. Arrays are the caller's, are only read, and not looked
 * at after the call; those left empty (n is 0) are not given. Any figure may be meshed: segments may cross, overlap
 * or touch, points may coincide. Coordinates are finite, in any unit. */
struct tri_figure {
    size_t size; /* sizeof(struct tri_figure) */
    struct tri_reals points;           /* [n][2] x, y; at least 3 */
    struct tri_reals point_attributes; /* [points.n][any]; new points: linear over the input's triangulation */
    struct tri_ints point_markers;     /* [points.n][1]; not given: 0 */
    struct tri_ints segments;          /* [n][2] points; one that names no point, or the same twice, is skipped, and
                                          noted. Without segments the convex hull is meshed, else what they enclose */
    struct tri_ints segment_markers;   /* [segments.n][1]; not given: 0 */
    struct tri_reals holes;            /* [n][2] x, y: what can be reached from there without crossing a segment goes */
    struct tri_reals regions;          /* [n][4] x, y, attribute, largest area (<= 0: any): of what can be reached from
                                          there likewise. Where two reach, the last counts */
    struct tri_ints triangles;         /* [n][3] corners. Given: the figure is a mesh, which is kept and refined; holes
                                          and regions are not looked at, segments are edges of it or left out */
    struct tri_reals triangle_attributes; /* [triangles.n][any]: copied to the triangles that take the place of each */
    struct tri_reals triangle_areas;   /* [triangles.n][1] largest area of what takes the place of each (<= 0: any) */
};

static inline struct tri_figure tri_no_figure(void)
{
    struct tri_figure figure;
    memset(&figure, 0, sizeof figure);
    figure.size = sizeof figure;
    return figure;
}

/* --- sizes: how long edges shall be, place by place. A field gives a length h, in the unit of the coordinates, and the
 * mesh has edges of about that length: unlike a bound on areas, it is met on the average. */

enum tri_size_kind {
    TRI_SIZE_NUMBER = 1, /* `length` everywhere */
    TRI_SIZE_RASTER,     /* `values` at the nodes of a grid, bilinear between them; outside that of the nearest node */
    TRI_SIZE_MESH,       /* `values` at `points`, linear in each of the `triangles`; else that of the nearest place */
    TRI_SIZE_FUNCTION,   /* `function` */
    TRI_SIZE_NEAR        /* `length` at the segments with this marker, growing by `growth` for a distance of 1 */
};

/* One source of lengths. Arrays are the caller's, are only read, and not looked at after the call. A length that is not
 * above 0, or no number, is no data: the nearest data count in its place. An infinite one is no bound. */
struct tri_size_field {
    enum tri_size_kind kind;
    double length;           /* NUMBER, NEAR: above 0 */
    double growth;           /* NEAR: 0 or more, and at most tri_settings.gradation if that is given; below 0: that */
    int32_t marker;          /* NEAR: of the segments */
    struct tri_reals values; /* RASTER: [rows][columns], the lowest row first; MESH: [points.n][1] */
    double origin[2];        /* RASTER: the place of the first value .. */
    double step[2];          /* .. and the distance of columns and of rows, above 0 */
    struct tri_reals points; /* MESH: [n][2] */
    struct tri_ints triangles; /* MESH: [n][3] points; not given: the nearest point counts */
    /* FUNCTION: writes the lengths at n places. Asked by the calling thread alone, for some million places in a few
     * dozen calls, before anything is meshed: what it says is kept in a quadtree, bilinear: to 0.1% on the
     * average, to 5% where it varies most. */
    void (*function)(void *user, int64_t n, const double (*at)[2], double *length);
    void *user;
};

enum tri_placement {         /* of new points */
    TRI_PLACEMENT_LATTICE = 0, /* in a hexagonal lattice, if bounds on areas alone set the sizes and min_angle is at
                                  most 30: a third fewer triangles, most of them equilateral. With a larger
                                  min_angle, edge_length, unsuitable, or a figure with triangles: as CLASSIC; with
                                  `sizes` as FRONT, but for a lattice inside if they are one length */
    TRI_PLACEMENT_CLASSIC,     /* at circumcentres, or the places that are best for angles */
    TRI_PLACEMENT_FRONT        /* for `sizes`, with a min_angle of at most 30: near-equilateral triangles over a front
                                  that begins at the segments. Without these as CLASSIC */
};

/* What is wanted of the mesh. 0 and NULL: nothing. Without bounds on angles or sizes no points are added: the result is
 * the constrained Delaunay triangulation. */
struct tri_settings {
    size_t size; /* sizeof(struct tri_settings) */
    double min_angle;   /* degrees: no smaller angle, except at small angles of the input. Of 133 real inputs 101 (76%)
                           keep 36 degrees, 31 (23%) keep 38. A bound above 38 is treated as 38, if conforming above
                           36 as 36, and noted */
    double max_area;    /* of a triangle, in squared units of the coordinates */
    bool conforming;    /* each triangle is Delaunay, no point lies in the diametral circle of a segment's piece */
    bool keep_hull;     /* segments that enclose nothing are fine: the convex hull is meshed, but for the holes */
    int protect;        /* 1: segments at the boundary get no points; 2: no segment does */
    int64_t most_new_points; /* > 0: then refinement ends */

    /* Length of edges around a place, as a bound on areas: no triangle is larger than an equilateral one with edges of
     * the least length at its corners and centroid. The median edge length is about 0.8 of it. Infinite: no bound
     * there. 0, a negative number or NaN is no bound either, and a note names one such place. Before the first point
     * the function is called some ten thousand times, at most 2^25 times and 100 for each triangle of the mesh. The
     * call fails with TRI_TOO_LARGE if the lengths ask for more triangles than a mesh can hold. */
    double (*edge_length)(void *user, const double at[2]);
    void *edge_length_user;
    /* Must the triangle a, b, c (counter-clockwise) be refined? Asked about triangles that keep all bounds of size;
     * by par_mesh_new and par_mesh_refine, with `progress`, and with `protect`, also about smaller ones inside these
     * that never are made: edges of segments that must not be split stay, whatever it says, and so do flat triangles
     * beside them. 0: no. */
    int (*unsuitable)(void *user, const double a[2], const double b[2], const double c[2], double area);
    void *unsuitable_user;

    /* The hook for schedules of your own: asked for each bad triangle, with the point that would remove it. false: it
     * stays as it is now; a later tri_mesh_refine finds it again. A point may change triangles, and split segments, a
     * triangle or two beyond the place that the gate allows; a fence allows changes only of triangles whose
     * corners lie in it. */
    bool (*gate)(void *user, const double at[2]);
    void *gate_user;
    const double *fence; /* [4] x_min, y_min, x_max, y_max, half-open; with it min_angle is at most 34 */

    /* true: the call ends soon, with TRI_STOPPED. Asked every few thousand steps and calls of functions, by several
     * threads at once; once it has said so, it must go on saying so. */
    bool (*stop)(void *user);
    void *stop_user;

    /* ptriangle/par.h only */
    int threads;            /* <= 0: OMP_NUM_THREADS, else one for each core */
    bool callbacks_in_parallel; /* edge_length and unsuitable may be called by several threads at once. Otherwise the
                                   calling thread refines alone if they are set. With edge_length the mesh is the same,
                                   with unsuitable it is that of one sequential refinement */
    bool numbered_by_block; /* new points and triangles lie as they were made: quicker. Else along a curve, as the
                               cache of a solver wants it */

    /* Segments tell what is inside, without holes (which are emptied all the same): what lies behind an even number of
     * them goes. Rings may lie in rings; where polygons share a border that both have listed, it is none. More exactly:
     * the least number of segments' pieces on a way from outside counts, of those pieces along which an odd number of
     * segments run. So dangling segments, and single ones across a ring, change nothing. */
    bool even_odd;

    /* Told what tri_mesh_notes will say, unless that is "", before a call with these settings returns, by its thread:
     * for meshes that are handed out meanwhile (par_mesh_stream). */
    void (*note)(void *user, const char *notes);
    void *note_user;

    /* Told every so often while triangles are refined, by the calling thread: which share of the work is done, by an
     * estimate, from 0 on and never less than before, at last 1; and how many triangles there are. */
    void (*progress)(void *user, double done, int64_t triangles);
    void *progress_user;

    enum tri_placement placement; /* of new points */

    /* Lengths of edges that are asked for: at each place the least that a field gives. min_angle, and bounds on areas,
     * hold beside them. TRI_BAD_INPUT: a field that has no data, a NEAR whose marker no segment has. */
    const struct tri_size_field *sizes; /* [n_sizes] */
    int64_t n_sizes;
    double gradation;   /* lengths grow by no more than this for a distance of 1; 0: 0.2; infinite: no limit */
    double min_size;    /* shorter lengths count as this; 0: none is too short */
    double max_size;    /* > 0: no length is longer, also where no field says anything */
    double elements_across; /* > 0: between boundaries, or borders of regions, that face each other there is room for so
                               many lengths: channels and walls */
    double per_circle;  /* > 0: where segments follow a curve, so many lengths go around a circle of its curvature */
    int optimise;       /* passes of smoothing, at most 1000, which move new points inside regions; 0: one if lengths
                           are asked for, otherwise none; below 0: none. Not with max_area, areas of regions,
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

/* Makes *mesh; settings may be NULL. Errors: TRI_NO_MEMORY, TRI_TOO_LARGE, TRI_BAD_INPUT, TRI_STOPPED; *mesh is NULL
 * then, except that what refinement had done when it ran out of memory or was stopped is a valid mesh. It belongs to
 * the caller, until tri_mesh_delete. Time: n log n, in practice linear; about 100 bytes a triangle. */
enum tri_status tri_mesh_new(struct tri_mesh **mesh, const struct tri_figure *figure,
                             const struct tri_settings *settings, struct tri_error *error);

/* Refines further, wholly or where a gate lets it, as often as wanted: bounds on sizes that came with the figure count
 * again, keep_hull does not. Errors as above; the mesh is valid after any, and as far as it got. What the functions
 * below returned before is no longer valid. */
enum tri_status tri_mesh_refine(struct tri_mesh *mesh, const struct tri_settings *settings, struct tri_error *error);

/* NULL is fine. */
void tri_mesh_delete(struct tri_mesh *mesh);

/* What the mesh consists of. Arrays belong to the mesh, and are valid until it is refined or deleted. Constant time.
 *   points             [n][2] those of the figure first, in their order, also where no triangle uses them
 *   point_attributes   [points][as given]
 *   point_markers      [points][1] as given, else that of a segment there, else 1 on the boundary
 *   triangles          [n][3] corners, counter-clockwise
 *   triangle_attributes [triangles][1] those of regions, 0 where there is none; of a figure with triangles as given; n
 *                      is 0 where none were given
 *   segments           [n][2] pieces of segments, each the way of its segment, and of the boundary
 *   segment_markers    [segments][1] as given, else 1 on the boundary */
struct tri_reals tri_mesh_points(const struct tri_mesh *mesh);
struct tri_reals tri_mesh_point_attributes(const struct tri_mesh *mesh);
struct tri_ints tri_mesh_point_markers(const struct tri_mesh *mesh);
struct tri_ints tri_mesh_triangles(const struct tri_mesh *mesh);
struct tri_reals tri_mesh_triangle_attributes(const struct tri_mesh *mesh);
struct tri_ints tri_mesh_segments(const struct tri_mesh *mesh);
struct tri_ints tri_mesh_segment_markers(const struct tri_mesh *mesh);

/* The same, but made when they are first asked for. O(triangles). TRI_NO_MEMORY.
 *   neighbors  [triangles][3] the triangle opposite each corner, or -1
 *   edges      [n][2]
 *   markers    [edges][1] that of the segment which the edge is, else 0; NULL: not wanted */
enum tri_status tri_mesh_neighbors(struct tri_mesh *mesh, struct tri_ints *neighbors, struct tri_error *error);
enum tri_status tri_mesh_edges(struct tri_mesh *mesh, struct tri_ints *edges, struct tri_ints *markers,
                               struct tri_error *error);

/* The arrays above as a figure, for ptriangle/files.h and ptriangle/check.h, or to begin again. *figure comes
 * from tri_no_figure: its size tells how much of it may be filled. */
void tri_mesh_figure(const struct tri_mesh *mesh, struct tri_figure *figure);

/* --- what was odd, and what could not be reached */

/* What was hardly meant so, a line each: why the mesh is empty ("the mesh is empty: the outline is open at points 3 and
 * 17"), that segments are skipped, that edge_length returned what is no length, that min_angle is above 38. "" where
 * there is nothing to say, which is the rule. The mesh's, valid until it is refined or deleted. */
const char *tri_mesh_notes(const struct tri_mesh *mesh);

enum tri_count {
    TRI_COUNT_DUPLICATES,       /* points that lie where a point of lower number lies, and are not used */
    TRI_COUNT_CROSSINGS,        /* points made where segments cross */
    TRI_COUNT_SKIPPED_SEGMENTS, /* that name no point, or the same twice; of a mesh: that are no edges of it */
    TRI_COUNT_NEW_POINTS,       /* by the last refinement, in triangles .. */
    TRI_COUNT_NEW_POINTS_ON_SEGMENTS, /* .. and on segments */
    TRI_COUNT_GATED,            /* by the last refinement: times the gate said no .. */
    TRI_COUNT_FENCED            /* .. and the fence did */
};
int64_t tri_mesh_count(const struct tri_mesh *mesh, enum tri_count what);

enum tri_reason { /* why a triangle does not keep the bounds */
    TRI_REASON_INPUT_ANGLE, /* at, or across from, a small angle between segments */
    TRI_REASON_NARROW_GAP,  /* between two segments so near to each other that filling the space would cost too much */
    TRI_REASON_PROTECTED,   /* settings.protect */
    TRI_REASON_LIMIT,       /* settings.most_new_points, or points for angles would have run away */
    TRI_REASON_PRECISION,   /* nearer to each other than coordinates can resolve */
    TRI_REASON_DEFERRED,    /* gate, fence, or not refined by these settings yet */
    TRI_REASONS
};

/* Triangles that do not keep the bounds of these settings. by_reason[n_reasons] receives how many for each reason, or
 * is NULL; what has a reason beyond is counted in its last. -1: settings that have no meaning. O(triangles); callbacks
 * are called by this thread. */
int64_t tri_mesh_count_bad(const struct tri_mesh *mesh, const struct tri_settings *settings, int64_t *by_reason,
                           int n_reasons);

/* Version of the library, such as "0.2.0". */
const char *tri_version(void);

#ifdef __cplusplus
}
#endif

#endif
