/* triangulate(): which fields are read and written for which switches, numbering, arrays of the caller, and all kinds
   of failure.
   Structs are poisoned before use. Reading a field that must not be read would crash, and writing one that must not be
   written would be noticed. The program is built once for libtriangle.a and once for libptriangle.a, and linked with
   --wrap for malloc, calloc, realloc and free (allocations.h). */
#define REAL TRI_REAL
#include "triangle/dropin/triangle.h"

#include <locale.h>
#include <pthread.h>
#include <stdio.h>
#include <unistd.h>

#include "allocations.h"
#include "support.h"

enum { POISON = 0xa5 };

/* --- a figure to which most letters apply: a rectangle with a square hole and a region */

static REAL points[16] = {0, 0, 4, 0, 4, 3, 0, 3, 1, 1, 2, 1, 2, 2, 1, 2};
static REAL attributes[8] = {0, 4, 34, 30, 11, 12, 22, 21}; /* x + 10 y */
static int point_markers[8] = {0, 9, 0, 0, 0, 0, 0, 0};
static int segments0[16] = {0, 1, 1, 2, 2, 3, 3, 0, 4, 5, 5, 6, 6, 7, 7, 4};
static int segments1[16] = {1, 2, 2, 3, 3, 4, 4, 1, 5, 6, 6, 7, 7, 8, 8, 5};
static int segment_markers[8] = {2, 0, 2, 2, -5, -5, -5, -5};
static REAL holes[2] = {1.5, 1.5};
static REAL regions[4] = {3.5, 0.5, 7, 0.25};

static bool has(const char *switches, char letter) { return strchr(switches, letter) != NULL; }

static struct triangulateio poisoned(void)
{
    struct triangulateio io;
    memset(&io, POISON, sizeof io);
    return io;
}

/* Points alone. All other fields are garbage, as some clients leave them. */
static struct triangulateio points_only(REAL *xy, int n)
{
    struct triangulateio in = poisoned();
    in.pointlist = xy;
    in.numberofpoints = n;
    in.numberofpointattributes = 0;
    in.pointmarkerlist = NULL;
    return in;
}

/* The figure, for p without r. */
static struct triangulateio figure(const char *switches)
{
    struct triangulateio in = points_only(points, 8);
    in.pointattributelist = attributes;
    in.pointmarkerlist = point_markers;
    in.numberofpointattributes = 1;
    if (!has(switches, 'p'))
        return in;
    in.segmentlist = has(switches, 'z') ? segments0 : segments1;
    in.segmentmarkerlist = segment_markers;
    in.numberofsegments = 8;
    in.holelist = holes;
    in.numberofholes = 1;
    in.regionlist = regions;
    in.numberofregions = 1;
    return in;
}

/* A polygon of n corners, in order, without holes and regions. */
static struct triangulateio polygon(REAL *xy, int *ends, int n)
{
    struct triangulateio in = points_only(xy, n);
    for (int i = 0; i < n; i++) {
        ends[2 * i] = i;
        ends[2 * i + 1] = (i + 1) % n;
    }
    in.segmentlist = ends;
    in.segmentmarkerlist = NULL;
    in.numberofsegments = n;
    in.numberofholes = in.numberofregions = 0;
    return in;
}

/* --- fields that a call writes, by its letters: the table of triangle.h */

struct written {
    bool points, attributes, markers, triangles, triangle_attributes, neighbors, segments, segment_markers, lists,
        edges, edge_markers, voronoi, voronoi_attributes;
};

static struct written expected(const char *s)
{
    bool marks = !has(s, 'B'), poly = (has(s, 'p') || has(s, 'c')) && !has(s, 'P');
    bool columns = has(s, 'A') && has(s, 'p') && !has(s, 'r');
    return (struct written){!has(s, 'N'), !has(s, 'N'), !has(s, 'N') && marks, !has(s, 'E'), !has(s, 'E') && columns,
                            has(s, 'n'), poly, poly && marks, poly, has(s, 'e'), has(s, 'e') && marks, has(s, 'v'),
                            has(s, 'v')};
}

/* Fills a struct with poison. Fields that the library allocates are NULL. */
static void prepare(const char *switches, struct triangulateio *out, struct triangulateio *vorout)
{
    struct written w = expected(switches);
    *out = poisoned();
    *vorout = poisoned();
#define CLEAR(condition, field) if (condition) (field) = NULL
    CLEAR(w.points, out->pointlist);
    CLEAR(w.attributes, out->pointattributelist);
    CLEAR(w.markers, out->pointmarkerlist);
    CLEAR(w.triangles, out->trianglelist);
    CLEAR(w.triangle_attributes, out->triangleattributelist);
    CLEAR(w.neighbors, out->neighborlist);
    CLEAR(w.segments, out->segmentlist);
    CLEAR(w.segment_markers, out->segmentmarkerlist);
    CLEAR(w.edges, out->edgelist);
    CLEAR(w.edge_markers, out->edgemarkerlist);
    CLEAR(w.voronoi, vorout->pointlist);
    CLEAR(w.voronoi_attributes, vorout->pointattributelist);
    CLEAR(w.voronoi, vorout->edgelist);
    CLEAR(w.voronoi, vorout->normlist);
}

/* The value of a poisoned pointer. */
static bool is_poison(const void *pointer)
{
    void *poison;
    memset(&poison, POISON, sizeof poison);
    return pointer == poison;
}

/* Frees the arrays that the library allocated. Asserts that it allocated exactly the arrays that it should. */
static void release(const char *switches, struct triangulateio *out, struct triangulateio *vorout)
{
    struct written w = expected(switches);
    struct {
        bool written;
        void *array;
    } arrays[] = {{w.points, out->pointlist},
                  {w.attributes && out->numberofpointattributes, out->pointattributelist},
                  {w.markers, out->pointmarkerlist},
                  {w.triangles, out->trianglelist},
                  {w.triangle_attributes && out->numberoftriangleattributes, out->triangleattributelist},
                  {false, out->trianglearealist},
                  {w.neighbors, out->neighborlist},
                  {w.segments, out->segmentlist},
                  {w.segment_markers, out->segmentmarkerlist},
                  {w.edges, out->edgelist},
                  {w.edge_markers, out->edgemarkerlist},
                  {false, out->normlist},
                  {w.voronoi, vorout->pointlist},
                  {w.voronoi_attributes && vorout->numberofpointattributes, vorout->pointattributelist},
                  {false, vorout->pointmarkerlist},
                  {false, vorout->trianglelist},
                  {false, vorout->segmentlist},
                  {false, vorout->edgemarkerlist},
                  {w.voronoi, vorout->edgelist},
                  {w.voronoi, vorout->normlist}};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) {
        if (!arrays[i].written) {
            assert_true(is_poison(arrays[i].array) || !arrays[i].array);
            continue;
        }
        assert_true(arrays[i].array && !is_poison(arrays[i].array));
        if (i % 2)
            free(arrays[i].array); /* either function may free it */
        else
            trifree(arrays[i].array);
    }
}

static void run(const char *switches, struct triangulateio *in, struct triangulateio *out, struct triangulateio *vorout)
{
    prepare(switches, out, vorout);
    if (triangulate(switches, in, out, vorout) != TRIANGULATE_OK)
        fail_msg("%s failed", switches);
}

/* --- the judge */

static int32_t *from_zero(const int *list, int n, int base)
{
    int32_t *copy = malloc(((size_t)n + 1) * sizeof *copy);
    for (int i = 0; i < n; i++)
        copy[i] = list[i] == -1 ? -1 : list[i] - base;
    return copy;
}

/* options NULL: constrained Delaunay without bounds. `in` was read with the same base and with p. NULL: unknown. */
static void judge(const struct triangulateio *out, const struct triangulateio *in, int base, bool with_neighbors,
                  const struct tri_check_options *options)
{
    struct tri_check_options plain = {.max_bad = -1};
    int32_t *corners = from_zero(out->trianglelist, 3 * out->numberoftriangles, base), *ends = NULL;
    int32_t *neighbors = with_neighbors ? from_zero(out->neighborlist, 3 * out->numberoftriangles, base) : NULL;
    struct tri_check_mesh mesh = {.n_points = out->numberofpoints, .points = out->pointlist,
                                  .n_triangles = out->numberoftriangles, .triangles = corners, .neighbors = neighbors};
    struct tri_pslg pslg = {0};
    int32_t *subsegments = in ? from_zero(out->segmentlist, 2 * out->numberofsegments, base) : NULL;
    if (in) {
        mesh.n_segments = out->numberofsegments;
        mesh.segments = subsegments;
        mesh.segment_markers = out->segmentmarkerlist;
        ends = from_zero(in->segmentlist, 2 * in->numberofsegments, base);
        pslg = (struct tri_pslg){.n_points = in->numberofpoints, .points = in->pointlist,
                                 .n_segments = in->numberofsegments, .segments = ends,
                                 .segment_markers = in->segmentmarkerlist,
                                 .n_holes = in->numberofholes, .holes = in->holelist};
    }
    struct tri_check_report report;
    assert_int_equal(tri_check(&mesh, in ? &pslg : NULL, options ? options : &plain, &report, NULL), TRI_OK);
    for (int kind = 0; kind < TRI_N_CHECKS; kind++)
        if (report.item[kind].state == TRI_CHECK_FAILED)
            fail_msg("%s: %s", tri_check_name((enum tri_check_kind)kind), report.item[kind].text);
    free(corners);
    free(subsegments);
    free(ends);
    free(neighbors);
}

/* --- fields */

static void assert_counts(const char *s, const struct triangulateio *in, const struct triangulateio *out,
                          const struct triangulateio *vorout)
{
    int columns = has(s, 'A') && has(s, 'p') && !has(s, 'r');
    assert_int_equal(out->numberofpointattributes, in->numberofpointattributes);
    assert_int_equal(out->numberofcorners, strstr(s, "o2") ? 6 : 3);
    assert_int_equal(out->numberoftriangleattributes, columns);
    assert_true(out->numberofpoints >= 8 && out->numberoftriangles > 5 && out->numberofsegments >= 4);
    int middles = strstr(s, "o2") ? out->numberofedges : 0;
    bool hole = has(s, 'p') && !has(s, 'O'); /* Euler's formula: */
    assert_int_equal(out->numberofpoints - middles - out->numberofedges + out->numberoftriangles, hole ? 0 : 1);
    assert_int_equal(vorout->numberofpoints, out->numberoftriangles);
    assert_int_equal(vorout->numberofpointattributes, in->numberofpointattributes);
    assert_int_equal(vorout->numberofedges, out->numberofedges);
    if (!expected(s).lists) {
        assert_true(is_poison(out->holelist) && is_poison(out->regionlist));
        return;
    }
    assert_ptr_equal(out->holelist, has(s, 'p') ? in->holelist : NULL);
    assert_int_equal(out->numberofholes, has(s, 'p') ? in->numberofholes : 0);
    assert_ptr_equal(out->regionlist, has(s, 'p') ? in->regionlist : NULL);
    assert_int_equal(out->numberofregions, has(s, 'p') ? in->numberofregions : 0);
}

/* Every subset of the letters that choose arrays, on points, on a PSLG and on a hull. */
static void test_fields_by_switch(void **state)
{
    (void)state;
    static const char *const kinds[] = {"z", "pz", "cz", "", "p", "pcOq"};
    static const char *const letters[] = {"N", "E", "P", "B", "e", "n", "v", "o2", "A"};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        for (int set = 0; set < 1 << 9; set++) {
            char switches[32] = "Q";
            strcat(switches, kinds[k]);
            for (int i = 0; i < 9; i++)
                if (set >> i & 1)
                    strcat(switches, letters[i]);
            struct triangulateio in = figure(switches), out, vorout, zeroed = {0}, vorout_zeroed = {0};
            run(switches, &in, &out, &vorout);
            assert_counts(switches, &in, &out, &vorout);
            release(switches, &out, &vorout);
            assert_int_equal(triangulate(switches, &in, &zeroed, &vorout_zeroed), 0);
            release(switches, &zeroed, &vorout_zeroed); /* fields that are NULL and not written stay NULL */
        }
}

/* Without v, vorout may be NULL. */
static void test_vorout_may_be_null(void **state)
{
    (void)state;
    struct triangulateio in = figure("pz"), out, vorout;
    prepare("pz", &out, &vorout);
    assert_int_equal(triangulate("pz", &in, &out, NULL), 0);
    release("pz", &out, &vorout);
}

static void assert_shifted(const int *from_one, const int *zero, int n)
{
    for (int i = 0; i < n; i++)
        assert_int_equal(from_one[i], zero[i] == -1 ? -1 : zero[i] + 1);
}

static void test_numbers_from_one(void **state)
{
    (void)state;
    struct triangulateio in0 = figure("pz"), in1 = figure("p"), out0, out1, vor0, vor1;
    run("pq30envo2z", &in0, &out0, &vor0);
    run("pq30envo2", &in1, &out1, &vor1);
    assert_int_equal(out0.numberofpoints, out1.numberofpoints);
    assert_memory_equal(out0.pointlist, out1.pointlist, 2 * (size_t)out0.numberofpoints * sizeof(REAL));
    assert_shifted(out1.trianglelist, out0.trianglelist, 6 * out0.numberoftriangles);
    assert_shifted(out1.neighborlist, out0.neighborlist, 3 * out0.numberoftriangles);
    assert_shifted(out1.segmentlist, out0.segmentlist, 2 * out0.numberofsegments);
    assert_shifted(out1.edgelist, out0.edgelist, 2 * out0.numberofedges);
    assert_shifted(vor1.edgelist, vor0.edgelist, 2 * vor0.numberofedges);
    int lowest = out0.trianglelist[0], outside = 0;
    for (int i = 0; i < 6 * out0.numberoftriangles; i++)
        lowest = out0.trianglelist[i] < lowest ? out0.trianglelist[i] : lowest;
    for (int i = 0; i < 3 * out1.numberoftriangles; i++)
        outside += out1.neighborlist[i] == -1;
    assert_int_equal(lowest, 0);
    assert_true(outside > 0);
    release("penv", &out0, &vor0);
    release("penv", &out1, &vor1);
}

/* --- values */

static void test_the_mesh_is_correct(void **state)
{
    (void)state;
    static const char *const all[] = {"pnz", "pn", "pq30nz", "pqa.05n", "pcnz", "pq25Dnz"};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        struct triangulateio in = figure(all[i]), out, vorout;
        struct tri_check_options options = {.max_bad = -1};
        options.min_angle = has(all[i], 'q') ? (strstr(all[i], "30") ? 30 : strstr(all[i], "25") ? 25 : 20) : 0;
        options.max_area = has(all[i], 'a') ? 0.05 : 0;
        options.delaunay = has(all[i], 'D') ? TRI_CHECK_CONFORMING : TRI_CHECK_CONSTRAINED;
        run(all[i], &in, &out, &vorout);
        judge(&out, &in, !has(all[i], 'z'), true, &options);
        release(all[i], &out, &vorout);
    }
}

/* Input points come first, bit for bit. Attributes are linear, so they determine the position. Markers follow
   segments. */
static void test_values_of_points_are_correct(void **state)
{
    (void)state;
    struct triangulateio in = figure("pz"), out, vorout;
    run("pq30a.1o2z", &in, &out, &vorout);
    assert_memory_equal(out.pointlist, points, sizeof points);
    assert_true(out.numberofpoints > 50);
    int found[3] = {0};
    for (int i = 0; i < out.numberofpoints; i++) {
        double x = out.pointlist[2 * i], y = out.pointlist[2 * i + 1];
        assert_true(fabs(out.pointattributelist[i] - (x + 10 * y)) < 1e-12);
        bool inner = (x >= 1 && x <= 2 && (y == 1 || y == 2)) || (y >= 1 && y <= 2 && (x == 1 || x == 2));
        bool outer = x == 0 || y == 0 || y == 3;
        int marker = i == 1 ? 9 : inner ? -5 : outer || (x == 4 && y == 3) ? 2 : x == 4 ? 1 : 0;
        assert_int_equal(out.pointmarkerlist[i], marker);
        found[marker == 0 ? 0 : marker == 1 ? 1 : 2]++;
    }
    assert_true(found[0] > 0 && found[1] > 0 && found[2] > 0);
    release("p", &out, &vorout);
}

static void test_markers_of_edges_are_correct(void **state)
{
    (void)state;
    struct triangulateio in = figure("pz"), out, vorout;
    run("pqeaAz", &in, &out, &vorout);
    int of[4] = {0};
    for (int i = 0; i < out.numberofedges; i++) {
        int marker = out.edgemarkerlist[i];
        of[marker == 2 ? 0 : marker == -5 ? 1 : marker == 1 ? 2 : 3]++;
        assert_true(marker == 2 || marker == -5 || marker == 1 || marker == 0);
    }
    assert_true(of[0] >= 3 && of[1] >= 4 && of[2] >= 1 && of[3] >= 5);
    assert_int_equal(of[0] + of[1] + of[2], out.numberofsegments); /* all segments are boundary here */
    for (int i = 0; i < out.numberoftriangles; i++)
        assert_true(out.triangleattributelist[i] == 7);
    for (int i = 0; i < out.numberofsegments; i++)
        assert_true(out.segmentmarkerlist[i] == 2 || out.segmentmarkerlist[i] == -5 || out.segmentmarkerlist[i] == 1);
    judge(&out, &in, 0, false, &(struct tri_check_options){.min_angle = 20, .max_area = 0.25, .max_bad = -1});
    release("peA", &out, &vorout);
}

/* Nodes 4 to 6 lie on the edges opposite corners 1 to 3. Edge i corresponds to Voronoi edge i. */
static void test_midpoints_and_edges_correspond(void **state)
{
    (void)state;
    struct triangulateio in = figure("pz"), out, vor;
    run("pqo2evz", &in, &out, &vor);
    for (int t = 0; t < out.numberoftriangles; t++)
        for (int k = 0; k < 3; k++) {
            const int *nodes = &out.trianglelist[6 * t];
            const REAL *a = &out.pointlist[2 * nodes[(k + 1) % 3]], *b = &out.pointlist[2 * nodes[(k + 2) % 3]];
            const REAL *middle = &out.pointlist[2 * nodes[3 + k]];
            assert_true(middle[0] == (a[0] + b[0]) / 2 && middle[1] == (a[1] + b[1]) / 2);
        }
    int rays = 0;
    for (int i = 0; i < out.numberofedges; i++) {
        const int *edge = &out.edgelist[2 * i], *dual = &vor.edgelist[2 * i];
        for (int side = 0; side < 2; side++) {
            if (dual[side] == -1)
                continue;
            const int *nodes = &out.trianglelist[6 * dual[side]];
            int next = 0; /* the left triangle has the edge in its own direction */
            while (next < 3 && nodes[next] != edge[side])
                next++;
            assert_true(next < 3 && nodes[(next + 1) % 3] == edge[1 - side]);
        }
        const REAL *a = &out.pointlist[2 * edge[0]], *b = &out.pointlist[2 * edge[1]], *ray = &vor.normlist[2 * i];
        bool is_ray = dual[1] == -1;
        assert_true(ray[0] == (is_ray ? b[1] - a[1] : 0) && ray[1] == (is_ray ? a[0] - b[0] : 0));
        rays += is_ray;
    }
    assert_int_equal(rays, out.numberofsegments);
    for (int t = 0; t < out.numberoftriangles; t++) {
        double x = vor.pointlist[2 * t], y = vor.pointlist[2 * t + 1], square[3];
        for (int k = 0; k < 3; k++) {
            const REAL *at = &out.pointlist[2 * out.trianglelist[6 * t + k]];
            square[k] = (at[0] - x) * (at[0] - x) + (at[1] - y) * (at[1] - y);
        }
        assert_true(fabs(square[1] - square[0]) < 1e-12 && fabs(square[2] - square[0]) < 1e-12);
        assert_true(fabs(vor.pointattributelist[t] - (x + 10 * y)) < 1e-11);
    }
    release("pev", &out, &vor);
}

static void test_j_removes_unused_points(void **state)
{
    (void)state;
    static REAL xy[] = {9, 9, 0, 0, 5, 5, 1, 0, 1, 1, 0, 1}; /* 0 and 2 lie outside */
    static int ends[] = {1, 3, 3, 4, 4, 5, 5, 1};
    struct triangulateio in = points_only(xy, 6), out, vorout;
    in.segmentlist = ends;
    in.segmentmarkerlist = NULL;
    in.numberofsegments = 4;
    in.numberofholes = in.numberofregions = 0;
    run("pjzn", &in, &out, &vorout);
    static const REAL rest[] = {0, 0, 1, 0, 1, 1, 0, 1};
    assert_int_equal(out.numberofpoints, 4);
    assert_memory_equal(out.pointlist, rest, sizeof rest);
    judge(&out, NULL, 0, true, NULL);
    for (int i = 0; i < 8; i++)
        assert_in_range(out.segmentlist[i], 0, 3);
    release("pn", &out, &vorout);
    run("pz", &in, &out, &vorout);
    assert_int_equal(out.numberofpoints, 6);
    release("p", &out, &vorout);
    run("pjo2z", &in, &out, &vorout);
    assert_int_equal(out.numberofpoints, 4 + 5);
    for (int i = 0; i < 12; i++) {
        int node = out.trianglelist[i];
        assert_in_range(node, i % 6 < 3 ? 0 : 4, i % 6 < 3 ? 3 : 8);
    }
    release("p", &out, &vorout);
}

/* Coordinates beyond the range of exact arithmetic are returned unchanged. */
static void test_far_coordinates_are_unchanged(void **state)
{
    (void)state;
    REAL xy[] = {0, 0, 1.1e300, 0, 1.3e300, 1.7e300, 5e-324, 1e300};
    struct triangulateio in = points_only(xy, 4), out, vorout;
    run("z", &in, &out, &vorout);
    assert_memory_equal(out.pointlist, xy, sizeof xy);
    assert_true(out.numberoftriangles >= 2);
    release("", &out, &vorout);
}

/* With A but without regions, there is no column for them. */
static void test_without_regions_there_is_no_attribute(void **state)
{
    (void)state;
    struct triangulateio in = figure("pz"), out, vorout;
    in.numberofregions = 0;
    run("pAaz", &in, &out, &vorout);
    assert_int_equal(out.numberoftriangleattributes, 0);
    assert_null(out.triangleattributelist);
    release("p", &out, &vorout);
}

/* --- arrays of the caller */

static void test_arrays_of_the_caller_are_filled(void **state)
{
    (void)state;
    struct triangulateio in = figure("pz"), made, out = poisoned(), vormade, vorout = poisoned();
    run("pq30aAenvz", &in, &made, &vormade);
    static REAL xy[4000], at[2000], triangle_at[4000], vor_xy[8000], vor_at[4000], norm[8000];
    static int markers[2000], corners[12000], neighbors[12000], ends[4000], end_markers[2000], edges[8000],
        edge_markers[4000], vor_edges[8000];
    assert_true(made.numberofpoints < 2000 && made.numberoftriangles < 4000);
    out.pointlist = xy;
    out.pointattributelist = at;
    out.pointmarkerlist = markers;
    out.trianglelist = corners;
    out.triangleattributelist = triangle_at;
    out.neighborlist = neighbors;
    out.segmentlist = ends;
    out.segmentmarkerlist = end_markers;
    out.edgelist = edges;
    out.edgemarkerlist = edge_markers;
    vorout.pointlist = vor_xy;
    vorout.pointattributelist = vor_at;
    vorout.edgelist = vor_edges;
    vorout.normlist = norm;
    assert_int_equal(triangulate("pq30aAenvz", &in, &out, &vorout), 0);
    assert_true(out.pointlist == xy && out.edgelist == edges && vorout.normlist == norm);
#define SAME(array, other, n) assert_memory_equal(array, other, (size_t)(n) * sizeof *(array))
    SAME(xy, made.pointlist, 2 * made.numberofpoints);
    SAME(at, made.pointattributelist, made.numberofpoints);
    SAME(markers, made.pointmarkerlist, made.numberofpoints);
    SAME(corners, made.trianglelist, 3 * made.numberoftriangles);
    SAME(triangle_at, made.triangleattributelist, made.numberoftriangles);
    SAME(neighbors, made.neighborlist, 3 * made.numberoftriangles);
    SAME(ends, made.segmentlist, 2 * made.numberofsegments);
    SAME(end_markers, made.segmentmarkerlist, made.numberofsegments);
    SAME(edges, made.edgelist, 2 * made.numberofedges);
    SAME(edge_markers, made.edgemarkerlist, made.numberofedges);
    SAME(vor_xy, vormade.pointlist, 2 * vormade.numberofpoints);
    SAME(vor_at, vormade.pointattributelist, vormade.numberofpoints);
    SAME(vor_edges, vormade.edgelist, 2 * vormade.numberofedges);
    SAME(norm, vormade.normlist, 2 * vormade.numberofedges);
    release("peAnv", &made, &vormade);
}

/* The segments as well: those that are not edges of the mesh are read last. */
static void test_segments_may_be_replaced_in_place(void **state)
{
    (void)state;
    static REAL xy[] = {0, 0, 2, 0, 2, 2, 0, 2, 1, 1};
    static int corners[] = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4}, ends[32] = {0, 2, 1, 3}, markers[16] = {77, 88};
    struct triangulateio in = points_only(xy, 5), out, vorout;
    in.trianglelist = corners;
    in.numberoftriangles = 4;
    in.numberofcorners = 3;
    in.numberoftriangleattributes = 0;
    in.segmentlist = ends;
    in.segmentmarkerlist = markers;
    in.numberofsegments = 2;
    prepare("rpzNE", &out, &vorout);
    out.segmentlist = ends;
    out.segmentmarkerlist = markers;
    assert_int_equal(triangulate("rpzNEQ", &in, &out, &vorout), 0);
    assert_int_equal(out.numberofsegments, 6);
    SAME(ends + 8, ((int[]){0, 2, 1, 3}), 4);
    SAME(markers + 4, ((int[]){77, 88}), 2);
}

/* The points of `out` may be those of `in`, even if they are moved (j). */
static void test_points_may_be_replaced_in_place(void **state)
{
    (void)state;
    static const char *const all[] = {"pqz", "pqjz"};
    for (int k = 0; k < 2; k++) {
        static REAL xy[400] = {9, 9}, at[200] = {99};
        static int markers[200] = {4}, ends[16];
        memcpy(xy, (REAL[]){9, 9}, 2 * sizeof *xy);
        memcpy(xy + 2, points, sizeof points);
        memcpy(at, (REAL[]){99}, sizeof *at);
        memcpy(at + 1, attributes, sizeof attributes);
        memcpy(markers, (int[]){4}, sizeof *markers);
        memcpy(markers + 1, point_markers, sizeof point_markers);
        for (int i = 0; i < 16; i++)
            ends[i] = segments0[i] + 1;
        struct triangulateio in = figure("pz"), apart, out, vorout;
        in.pointlist = xy;
        in.pointattributelist = at;
        in.pointmarkerlist = markers;
        in.numberofpoints = 9;
        in.segmentlist = ends;
        run(all[k], &in, &apart, &vorout);
        assert_true(apart.numberofpoints < 200);
        prepare(all[k], &out, &vorout);
        out.pointlist = xy;
        out.pointattributelist = at;
        out.pointmarkerlist = markers;
        assert_int_equal(triangulate(all[k], &in, &out, &vorout), 0);
        assert_int_equal(out.numberofpoints, apart.numberofpoints);
        SAME(xy, apart.pointlist, 2 * out.numberofpoints);
        SAME(at, apart.pointattributelist, out.numberofpoints);
        SAME(markers, apart.pointmarkerlist, out.numberofpoints);
        SAME(out.trianglelist, apart.trianglelist, 3 * out.numberoftriangles);
        release("pN", &(struct triangulateio){.trianglelist = out.trianglelist, .segmentlist = out.segmentlist,
                                              .segmentmarkerlist = out.segmentmarkerlist}, &vorout);
        release("p", &apart, &vorout);
    }
}

/* --- nothing to triangulate */

static void test_inputs_without_triangles_give_empty_meshes(void **state)
{
    (void)state;
    static REAL line[] = {0, 0, 1, 1, 2, 2, 3, 3}, square[] = {0, 0, 1, 0, 1, 1, 0, 1};
    int ends[8];
    static const char *const all[] = {"zenv", "pzenv", "cenvz", "pqa.1zenvo2", "Dzenv"};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        struct triangulateio in = polygon(line, ends, 4), out, vorout;
        run(all[k], &in, &out, &vorout);
        assert_int_equal(out.numberoftriangles, 0);
        assert_int_equal(out.numberofedges, 0);
        assert_int_equal(out.numberofsegments, 0);
        assert_int_equal(out.numberofpoints, 4);
        release(all[k], &out, &vorout);
    }
    struct triangulateio in = polygon(square, ends, 4), out, vorout;
    in.numberofsegments = 3; /* not closed, so all triangles are outside */
    run("pzn", &in, &out, &vorout);
    assert_int_equal(out.numberoftriangles, 0);
    release("pn", &out, &vorout);
}

/* --- errors */

struct told {
    int errors, remarks;
    char text[600];
};

static void listen(void *user, int is_error, const char *text)
{
    struct told *told = user;
    (is_error ? &told->errors : &told->remarks)[0]++;
    assert_true(strlen(text) > 10 && !strchr(text, '\n'));
    snprintf(told->text, sizeof told->text, "%s", text);
}

/* The state of a struct after an error: unchanged except for the counts. */
static void clear_counts(struct triangulateio *io)
{
    io->numberofpoints = io->numberofpointattributes = io->numberoftriangles = io->numberofcorners = 0;
    io->numberoftriangleattributes = io->numberofsegments = io->numberofholes = io->numberofregions = 0;
    io->numberofedges = 0;
}

/* The call fails with one message. It changes nothing but counts, which become 0. */
static void assert_fails(const char *switches, const struct triangulateio *in, bool with_vorout, int code,
                         const char *word)
{
    struct told told = {0};
    struct triangulate_options options = {.message = listen, .message_user = &told};
    struct triangulateio out, vorout, out_before, vorout_before;
    prepare(switches, &out, &vorout);
    memcpy(&out_before, &out, sizeof out);
    memcpy(&vorout_before, &vorout, sizeof vorout);
    clear_counts(&out_before);
    if (with_vorout)
        clear_counts(&vorout_before);
    long long held = support_held;
    int got = triangulate_with(switches, in, &out, with_vorout ? &vorout : NULL, &options);
    if (got != code || !strstr(told.text, word))
        fail_msg("%s: %d, %s", switches, got, told.text);
    assert_int_equal(told.errors, 1);
    assert_int_equal(support_held, held);
    assert_memory_equal(&out, &out_before, sizeof out);
    assert_memory_equal(&vorout, &vorout_before, sizeof vorout);
    struct triangulateio copy = *in;
    assert_int_equal(triangulate(switches, &copy, &out, with_vorout ? &vorout : NULL), code);
    assert_memory_equal(&out, &out_before, sizeof out);
}

static void test_invalid_points_are_refused(void **state)
{
    (void)state;
    static const REAL odd[] = {NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 6; i++) {
        REAL xy[] = {0, 0, 1, 0, 1, 1, 0, 1};
        int ends[8];
        xy[3 + i % 2] = odd[i / 2];
        struct triangulateio in = polygon(xy, ends, 4);
        assert_fails("z", &in, true, TRIANGULATE_BAD_INPUT, "finite");
        assert_fails("pqz", &in, true, TRIANGULATE_BAD_INPUT, "finite");
    }
    static REAL same[] = {2, 3, 2, 3, 2, 3, 2, 3};
    int ends[8];
    struct triangulateio in = polygon(same, ends, 4);
    assert_fails("z", &in, true, TRIANGULATE_BAD_INPUT, "same place");
    assert_fails("pz", &in, true, TRIANGULATE_BAD_INPUT, "same place");
    in = figure("z");
    for (int n = -1; n < 3; n++) {
        in.numberofpoints = n;
        assert_fails("z", &in, true, TRIANGULATE_BAD_INPUT, n < 0 ? "number of points" : "three");
    }
    in.numberofpoints = 0;
    in.pointlist = NULL;
    assert_fails("z", &in, true, TRIANGULATE_BAD_INPUT, "three");
}

static void test_invalid_counts_are_refused(void **state)
{
    (void)state;
    struct triangulateio in = figure("pz");
    in.numberofpointattributes = -1;
    assert_fails("z", &in, true, TRIANGULATE_BAD_INPUT, "attributes");
    in = figure("pz");
    in.pointattributelist = NULL;
    assert_fails("z", &in, true, TRIANGULATE_BAD_INPUT, "attributes");
    in = figure("pz");
    in.numberofsegments = -2;
    assert_fails("pz", &in, true, TRIANGULATE_BAD_INPUT, "segments");
    in.numberofsegments = 2;
    in.segmentlist = NULL;
    assert_fails("pz", &in, true, TRIANGULATE_BAD_INPUT, "segments without");
    in = figure("pz");
    in.holelist = NULL;
    assert_fails("pz", &in, true, TRIANGULATE_BAD_INPUT, "holes without");
    in = figure("pz");
    in.regionlist = NULL;
    assert_fails("paz", &in, true, TRIANGULATE_BAD_INPUT, "regions without");
    in = figure("pz");
    in.numberofpoints = INT32_MAX;
    assert_fails("z", &in, true, TRIANGULATE_TOO_LARGE, "mesh can hold");
}

static void test_invalid_calls_are_refused(void **state)
{
    (void)state;
    struct triangulateio in = figure("pz"), out = poisoned(), before = poisoned();
    assert_fails("pa0z", &in, true, TRIANGULATE_BAD_INPUT, "area");
    assert_fails("pa.zQ", &in, true, TRIANGULATE_BAD_INPUT, "area");
    assert_fails("puz", &in, true, TRIANGULATE_BAD_INPUT, "triunsuitable");
    assert_fails("pa0.000000000000001z", &in, true, TRIANGULATE_TOO_LARGE, "triangles");
    assert_int_equal(triangulate(NULL, &in, &out, NULL), TRIANGULATE_BAD_INPUT);
    assert_int_equal(triangulate("z", NULL, &out, NULL), TRIANGULATE_BAD_INPUT);
    assert_int_equal(triangulate("z", &in, NULL, NULL), TRIANGULATE_BAD_INPUT);
    clear_counts(&before);
    assert_memory_equal(&out, &before, sizeof out);
    struct triangulateio both = figure("pz");
    memcpy(&before, &both, sizeof both);
    assert_int_equal(triangulate("pa0z", &both, &both, NULL), TRIANGULATE_BAD_INPUT);
    assert_memory_equal(&both, &before, sizeof both); /* the input is unchanged */
    trifree(NULL);
}

/* Unusual but valid input is reported, unless Q is given. */
static void test_unusual_input_is_reported(void **state)
{
    (void)state;
    static REAL xy[] = {0, 0, 4, 0, 4, 4, 0, 4, 4, 4};
    static int ends[] = {0, 1, 1, 2, 4, 3, 3, 0, 1, 1, 7, 2, -1, 0};
    struct triangulateio in = points_only(xy, 5), out, vorout;
    in.segmentlist = ends;
    in.segmentmarkerlist = NULL;
    in.numberofsegments = 7;
    in.numberofholes = in.numberofregions = 0;
    for (int quiet = 0; quiet < 2; quiet++) {
        struct told told = {0};
        struct triangulate_options options = {.message = listen, .message_user = &told};
        const char *switches = quiet ? "pzwQ" : "pzw";
        prepare(switches, &out, &vorout);
        assert_int_equal(triangulate_with(switches, &in, &out, NULL, &options), 0);
        assert_int_equal(out.numberoftriangles, 2);
        assert_int_equal(told.errors, 0);
        assert_int_equal(told.remarks, quiet ? 0 : 3); /* w, one duplicate, dropped segments */
        release(switches, &out, &vorout);
    }
    struct told told = {0};
    struct triangulate_options options = {.message = listen, .message_user = &told};
    prepare("pez", &out, &vorout); /* the e of 1e-2 is a switch, which is what the remark says */
    assert_int_equal(triangulate_with("pq40a1e-2z", &in, &out, NULL, &options), 0);
    assert_int_equal(told.remarks, 4);
    release("pe", &out, &vorout);
    told = (struct told){0};
    prepare("pez", &out, &vorout);
    assert_int_equal(triangulate_with("pa1e-05zQ", &in, &out, NULL, &options), 0);
    assert_true(told.remarks == 1 && strstr(told.text, "-a1e-05: numbers of switches have no exponent"));
    release("pe", &out, &vorout);
}

/* Triangle's library treats negative counts as 0. */
static void test_negative_counts_mean_none(void **state)
{
    (void)state;
    struct triangulateio in = figure("pz"), out, vorout;
    in.numberofholes = INT32_MIN;
    in.numberofregions = -1;
    run("pAaz", &in, &out, &vorout);
    assert_int_equal(out.numberoftriangles, 10); /* 8 points, 4 of them on the hull: the hole is filled */
    assert_int_equal(out.numberoftriangleattributes, 0);
    release("p", &out, &vorout);
}

/* Without a struct for the diagram, none is made. */
static void test_without_vorout_there_is_no_diagram(void **state)
{
    (void)state;
    struct told told = {0};
    struct triangulate_options options = {.message = listen, .message_user = &told};
    struct triangulateio in = figure("pz"), out, vorout;
    prepare("pz", &out, &vorout);
    assert_int_equal(triangulate_with("pvzQ", &in, &out, NULL, &options), 0);
    assert_true(out.numberoftriangles == 8 && told.remarks == 1 && strstr(told.text, "switch v"));
    release("p", &out, &vorout);
}

/* --- messages without options */

/* The text that triangulate(), or triangulate_with() without options, writes to standard error. */
static void listen_to_stderr(const char *switches, struct triangulateio *in, bool with, char text[600])
{
    struct triangulateio out = {0};
    FILE *file = tmpfile();
    assert_non_null(file);
    fflush(stderr);
    const int kept = dup(STDERR_FILENO);
    assert_true(kept >= 0 && dup2(fileno(file), STDERR_FILENO) >= 0);
    if (with)
        triangulate_with(switches, in, &out, NULL, NULL);
    else
        triangulate(switches, in, &out, NULL);
    fflush(stderr);
    assert_true(dup2(kept, STDERR_FILENO) >= 0);
    close(kept);
    rewind(file);
    text[fread(text, 1, 599, file)] = 0;
    fclose(file);
    trifree(out.pointlist);
    trifree(out.pointmarkerlist);
    trifree(out.trianglelist);
    trifree(out.segmentlist);
    trifree(out.segmentmarkerlist);
    trifree(out.edgelist);
    trifree(out.edgemarkerlist);
}

static void test_messages_without_options_go_to_stderr(void **state)
{
    (void)state;
    static REAL one_place[] = {1, 1, 1, 1, 1, 1}, xy[] = {0, 0, 1, 0, 1, 1, 0, 1, 0, 1};
    static int fine[] = {1, 2, 2, 3, 3, 4, 4, 1}, open[] = {1, 2, 2, 3, 3, 4}, far[] = {1, 2, 2, 3, 3, 4, 4, 1, 4, 6};
    const struct {
        REAL *xy;
        int n_points, *ends, n_segments;
        const char *switches, *wanted;
    } cases[] = {
        {one_place, 3, fine, 0, "", "triangulate: all points are at the same place\n"},
        {xy, 4, fine, 4, "pa0", "triangulate: "},
        {xy, 4, open, 3, "p", "triangulate: the mesh is empty: the outline is open at points 1 and 4\n"},
        {xy, 4, open, 3, "pz", "triangulate: the mesh is empty: segment 2 names point 4 of 4: numbers count from 0"},
        {xy, 4, far, 5, "p", "triangulate: segment 5 names point 6 of 4: numbers count from 1 here; it is skipped\n"},
        {xy, 4, fine, 4, "pa1e-05", "triangulate: -a1e-05: numbers of switches have no exponent"},
        {xy, 4, fine, 4, "p", ""},
        {xy, 5, fine, 4, "p", ""}, /* unusual but harmless: a duplicate */
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[600], quiet[16];
        struct triangulateio in = points_only(cases[i].xy, cases[i].n_points);
        in.segmentlist = cases[i].ends;
        in.segmentmarkerlist = NULL;
        in.numberofsegments = cases[i].n_segments;
        in.numberofholes = in.numberofregions = 0;
        snprintf(quiet, sizeof quiet, "%sQ", cases[i].switches);
        listen_to_stderr(cases[i].switches, &in, false, text);
        if (strncmp(text, cases[i].wanted, strlen(cases[i].wanted) + !*cases[i].wanted) != 0)
            fail_msg("case %zu: %s", i, text);
        listen_to_stderr(quiet, &in, false, text); /* errors only */
        assert_true(!*text == (i > 1) && !strncmp(text, cases[i].wanted, strlen(text) ? strlen(cases[i].wanted) : 0));
        listen_to_stderr(cases[i].switches, &in, true, text);
        assert_string_equal(text, "");
    }
}

/* The reason why a mesh is empty is passed to a message function even with Q. */
static void test_the_reason_for_an_empty_mesh_is_reported(void **state)
{
    (void)state;
    static int open[] = {0, 1, 1, 2, 2, 3};
    struct triangulateio in = figure("pz"), out, vorout;
    in.segmentlist = open;
    in.segmentmarkerlist = NULL;
    in.numberofsegments = 3;
    in.numberofholes = in.numberofregions = 0;
    for (int quiet = 0; quiet < 2; quiet++) {
        struct told told = {0};
        struct triangulate_options options = {.message = listen, .message_user = &told};
        const char *switches = quiet ? "pzQ" : "pz";
        prepare(switches, &out, &vorout);
        assert_int_equal(triangulate_with(switches, &in, &out, NULL, &options), 0);
        assert_true(out.numberoftriangles == 0 && told.errors == 0 && told.remarks == 1);
        assert_string_equal(told.text, "the mesh is empty: the outline is open at points 0 and 3");
        release(switches, &out, &vorout);
    }
}

/* Segments refer to points at the ends of the range of int, counted from 1. */
static void test_segments_with_extreme_indices_are_skipped(void **state)
{
    (void)state;
    static int ends[] = {1, 2, 2, 3, 3, 4, 4, 1, INT32_MIN, 1, 1, INT32_MAX, 0, 2, 9, 1};
    struct triangulateio in = figure("p"), out, vorout;
    in.segmentlist = ends;
    in.numberofholes = in.numberofregions = 0;
    run("p", &in, &out, &vorout);
    assert_int_equal(out.numberofsegments, 4);
    release("p", &out, &vorout);
}

#ifdef SUPPORT_WRAP
/* Each allocation fails once, alone or with all later ones. */
static void test_every_allocation_may_fail(void **state)
{
    (void)state;
    static const char *const all[] = {"pq30a.05Aenvo2j", "zenv", "pcaz"};
    for (size_t s = 0; s < sizeof all / sizeof *all; s++)
        for (int ever_after = 0; ever_after < 2; ever_after++) {
            struct triangulateio in = figure(all[s]), out, vorout, out_before, vorout_before;
            int code = TRIANGULATE_NO_MEMORY;
            for (int k = 1; code; k++) {
                prepare(all[s], &out, &vorout);
                memcpy(&out_before, &out, sizeof out);
                memcpy(&vorout_before, &vorout, sizeof vorout);
                clear_counts(&out_before);
                clear_counts(&vorout_before);
                long long held = support_held;
                support_calls = 0;
                support_fail_at = k;
                support_fail_ever_after = ever_after;
                code = triangulate(all[s], &in, &out, &vorout);
                bool failed = support_calls >= k;
                support_fail_at = INT64_MAX;
                if (code) {
                    assert_int_equal(code, TRIANGULATE_NO_MEMORY);
                    assert_int_equal(support_held, held);
                    assert_memory_equal(&out, &out_before, sizeof out);
                    assert_memory_equal(&vorout, &vorout_before, sizeof vorout);
                } else {
                    assert_true(!failed || !ever_after);
                    release(all[s], &out, &vorout);
                    assert_int_equal(support_held, held);
                    code = failed; /* the allocation was optional: continue */
                }
            }
        }
}
#endif

/* --- inputs from public bug reports */

static void test_hole_outside(void **state)
{
    (void)state;
    static REAL xy[] = {2.1948854485272875, 0.2233940429716767,  2.210334747734508,  0.2045690176995104,
                        2.23101526067872,   0.19170904853717624, 2.2547319630849922, 0.18617908927292653,
                        2.2789675703171275, 0.18856608834740984, 2.301149721315429,  0.1986166902985606,
                        2.3189240083317504, 0.21526412684456825, 2.3304038731566465, 0.23674144339235967,
                        2.334370845917945,  0.2607690431393805,  2.333798685834391,  0.27,
                        2.1854430073431304, 0.27,                2.184870847259575,  0.26076904313938054,
                        2.1874178917967892, 0.24142231941101294};
    static REAL hole[] = {2.194746831368343, 0.22198663923314035};
    static const char *const all[] = {"pz", "piz", "pFz"};
    int ends[26];
    for (int k = 0; k < 3; k++) {
        struct triangulateio in = polygon(xy, ends, 13), out, vorout;
        in.holelist = hole;
        in.numberofholes = 1;
        run(all[k], &in, &out, &vorout);
        assert_int_equal(out.numberoftriangles, 11);
        judge(&out, &in, 0, false, NULL);
        release(all[k], &out, &vorout);
    }
}

static void test_input_that_hung_triangle_is_meshed(void **state)
{
    (void)state;
    static REAL xy[] = {6.899643741648033,  10.556739733611963, 6.8743893086546723, 10.577559204153792,
                        6.8990280198173055, 10.557055643048765, 6.8994694525740767, 10.556817827203695,
                        6.8996252478389311, 10.556759464230709, 6.899537086138448,  10.5566972172105};
    static int ends[] = {1, 2, 3, 4, 4, 5, 5, 4};
    static const char *const all[] = {"p", "pc", "pq", "pcq30"};
    for (int k = 0; k < 4; k++) {
        struct triangulateio in = points_only(xy, 6), out, vorout;
        in.segmentlist = ends;
        in.segmentmarkerlist = NULL;
        in.numberofsegments = 4;
        in.numberofholes = in.numberofregions = 0;
        run(all[k], &in, &out, &vorout);
        judge(&out, &in, 1, false, &(struct tri_check_options){
            .max_bad = -1, .border = has(all[k], 'c') ? TRI_CHECK_BORDER_HULL : TRI_CHECK_BORDER_SEGMENTS});
        assert_true(has(all[k], 'c') ? out.numberoftriangles > 3 : out.numberoftriangles == 0);
        release(all[k], &out, &vorout);
    }
}

static void test_duplicates_used_by_segments(void **state)
{
    (void)state;
    static REAL squares[] = {0, 0, 10, 0, 10, 10, 0, 10, 10, 10, 15, 10, 15, 15, 10, 15};
    static int ends[] = {0, 1, 1, 2, 2, 3, 3, 0, 4, 5, 5, 6, 6, 7, 7, 4};
    struct triangulateio in = points_only(squares, 8), out, vorout;
    in.segmentlist = ends;
    in.segmentmarkerlist = NULL;
    in.numberofsegments = 8;
    in.numberofholes = in.numberofregions = 0;
    run("pze", &in, &out, &vorout);
    assert_int_equal(out.numberofpoints, 8);
    assert_int_equal(out.numberoftriangles, 4);
    assert_int_equal(out.numberofedges, 10);
    assert_int_equal(out.numberofsegments, 8);
    for (int i = 0; i < 12; i++)
        assert_true(out.trianglelist[i] != 4); /* the lower number represents both */
    judge(&out, &in, 0, false, NULL);
    release("pe", &out, &vorout);
    run("pzj", &in, &out, &vorout);
    assert_int_equal(out.numberofpoints, 7);
    release("p", &out, &vorout);

    static REAL pentagon[] = {5, -5, 5, 0, 0, 0, 0, -2, 0, -2};
    int around[10];
    in = polygon(pentagon, around, 5);
    run("pz", &in, &out, &vorout);
    assert_int_equal(out.numberoftriangles, 2);
    assert_int_equal(out.numberofsegments, 4);
    release("p", &out, &vorout);
}

/* Refinement ends even if the bound cannot be reached. */
static void test_unreachable_angle(void **state)
{
    (void)state;
    struct triangulateio in = figure("pz"), out, vorout;
    run("pq45z", &in, &out, &vorout);
    judge(&out, &in, 0, false, NULL);
    release("p", &out, &vorout);
    run("pq36YYz", &in, &out, &vorout);
    judge(&out, &in, 0, false, NULL);
    release("p", &out, &vorout);
}

static void test_comma_locale(void **state)
{
    (void)state;
    static const char *const commas[] = {"de_DE.UTF-8", "de_DE", "fr_FR.UTF-8", "fr_FR"};
    const char *found = NULL;
    struct triangulateio in = figure("pz"), out[2], vorout;
    run("pq20.5a0.1z", &in, &out[0], &vorout);
    for (size_t i = 0; i < sizeof commas / sizeof *commas && !found; i++)
        found = setlocale(LC_ALL, commas[i]);
    run("pq20.5a0.1z", &in, &out[1], &vorout);
    setlocale(LC_ALL, "C");
    assert_int_equal(out[0].numberofpoints, out[1].numberofpoints);
    SAME(out[0].pointlist, out[1].pointlist, 2 * out[0].numberofpoints);
    release("p", &out[0], &vorout);
    release("p", &out[1], &vorout);
    if (!found)
        skip();
}

/* --- refining a mesh (r) */

/* The mesh of `out` as input. The fields that r must not read remain garbage. */
static struct triangulateio as_input(const struct triangulateio *out)
{
    struct triangulateio in = points_only(out->pointlist, out->numberofpoints);
    in.pointmarkerlist = out->pointmarkerlist;
    in.trianglelist = out->trianglelist;
    in.numberoftriangles = out->numberoftriangles;
    in.numberofcorners = out->numberofcorners;
    in.numberoftriangleattributes = 0;
    return in;
}

static void test_refine_a_mesh(void **state)
{
    (void)state;
    struct triangulateio in = figure("pz"), coarse, fine, vorout;
    run("pqAz", &in, &coarse, &vorout);
    struct triangulateio again = as_input(&coarse);
    again.triangleattributelist = coarse.triangleattributelist;
    again.numberoftriangleattributes = 1;
    again.segmentlist = coarse.segmentlist;
    again.segmentmarkerlist = coarse.segmentmarkerlist;
    again.numberofsegments = coarse.numberofsegments;
    prepare("prz", &fine, &vorout);
    fine.triangleattributelist = NULL;
    assert_int_equal(triangulate("prq30a.02z", &again, &fine, &vorout), 0);
    assert_true(is_poison(fine.holelist) && is_poison(fine.regionlist)); /* copied without being read */
    assert_true(fine.numberoftriangles > 4 * coarse.numberoftriangles);
    assert_int_equal(fine.numberoftriangleattributes, 1);
    SAME(fine.pointlist, coarse.pointlist, 2 * coarse.numberofpoints);
    for (int t = 0; t < fine.numberoftriangles; t++)
        assert_true(fine.triangleattributelist[t] == 7);
    judge(&fine, &in, 0, false, &(struct tri_check_options){.min_angle = 30, .max_area = 0.02, .max_bad = -1});
    trifree(fine.triangleattributelist);
    fine.triangleattributelist = NULL;
    release("pr", &fine, &vorout);
    release("pA", &coarse, &vorout);
}

/* A segment that is not an edge of the mesh is copied after the others, unless one of its ends is removed. */
static void test_segments_that_are_no_edges_are_copied(void **state)
{
    (void)state;
    static REAL xy[] = {0, 0, 2, 0, 2, 2, 0, 2, 5, 5};
    static int corners[] = {1, 2, 3, 1, 3, 4}, ends[] = {2, 4, 1, 2, 1, 3, 5, 1}, marks[] = {5, 7, 8, 9};
    struct triangulateio mesh = points_only(xy, 5), out, vorout;
    mesh.trianglelist = corners;
    mesh.numberoftriangles = 2;
    mesh.numberofcorners = 3;
    mesh.numberoftriangleattributes = 0;
    mesh.segmentlist = ends;
    mesh.segmentmarkerlist = marks;
    mesh.numberofsegments = 4;
    for (int jettison = 0; jettison < 2; jettison++) {
        const char *switches = jettison ? "rpj" : "rp";
        run(switches, &mesh, &out, &vorout);
        assert_int_equal(out.numberofsegments, jettison ? 6 : 7);
        assert_int_equal(out.segmentlist[10] + out.segmentlist[11], 6);
        assert_int_equal(out.segmentmarkerlist[5], 5);
        if (!jettison)
            assert_int_equal(out.segmentmarkerlist[6], 9);
        int sum = 0;
        for (int s = 0; s < 5; s++)
            sum += out.segmentmarkerlist[s];
        assert_int_equal(sum, 7 + 8 + 3); /* the other sides have marker 1 */
        release(switches, &out, &vorout);
    }
    struct told told = {0};
    struct triangulate_options options = {.message = listen, .message_user = &told};
    prepare("rp", &out, &vorout);
    assert_int_equal(triangulate_with("rp", &mesh, &out, NULL, &options), 0);
    assert_int_equal(told.remarks, 1);
    assert_non_null(strstr(told.text, "2 segments"));
    release("rp", &out, &vorout);
}

/* A lattice needs fewer triangles. */
static void test_placement_of_triangle(void **state)
{
    (void)state;
    static REAL xy[] = {0, 0, 4, (REAL)0.3, 5, 4, 1, 3};
    struct triangulateio in = points_only(xy, 4), out, vorout;
    int n[2];
    for (int classic = 0; classic < 2; classic++) {
        struct triangulate_options options = {.classic = classic};
        prepare("q30a", &out, &vorout);
        assert_int_equal(triangulate_with("q30a0.01z", &in, &out, NULL, &options), 0);
        n[classic] = out.numberoftriangles;
        release("q30a", &out, &vorout);
    }
    assert_true(n[0] < 0.8 * n[1]);
}

/* Triangles have three corners, or three corners and the midpoints of their edges. */
static void test_invalid_numbers_of_corners_are_refused(void **state)
{
    (void)state;
    static REAL xy[] = {0, 0, 1, 0, 1, 1, 0, 1};
    static int corners[] = {0, 1, 2, 0, 1, 2};
    static const int odd[] = {INT32_MIN, -1, 0, 2, 4, 5, 7, INT32_MAX};
    struct triangulateio mesh = points_only(xy, 4);
    mesh.trianglelist = corners;
    mesh.numberoftriangles = 1;
    mesh.numberoftriangleattributes = 0;
    for (size_t i = 0; i < sizeof odd / sizeof *odd; i++) {
        mesh.numberofcorners = odd[i];
        assert_fails("rz", &mesh, true, TRIANGULATE_BAD_INPUT, "corners");
    }
}

/* A mesh that is not Delaunay is left unchanged. If refinement is requested, it is made Delaunay first, even if no
   triangle is bad. */
static void test_meshes_are_made_delaunay_before_refinement(void **state)
{
    (void)state;
    static REAL xy[] = {0, 0, 3, -1, 2, 2, -1, 3, 100, 0, 130, -10, 120, 20, 90, 30};
    static int corners[] = {1, 2, 3, 0, 1, 3, 4, 5, 6, 4, 6, 7};
    struct triangulateio mesh = points_only(xy, 8), out, vorout;
    mesh.trianglelist = corners;
    mesh.numberoftriangles = 4;
    mesh.numberofcorners = 3;
    mesh.numberoftriangleattributes = 0;
    run("rz", &mesh, &out, &vorout);
    SAME(out.trianglelist, corners, 12);
    release("r", &out, &vorout);
    run("ra50z", &mesh, &out, &vorout);
    judge(&out, NULL, 0, false, &(struct tri_check_options){.max_area = 50});
    release("r", &out, &vorout);
}

/* Bounds of single triangles: below the diagonal y = x of a rhombus there are bounds, above it there are none. */
static void test_areas_of_triangles_are_bounds(void **state)
{
    (void)state;
    static REAL xy[] = {0, 0, 3, -1, 2, 2, -1, 3}, areas[] = {0.01, -1};
    static int corners[] = {1, 2, 3, 1, 3, 4};
    struct triangulateio mesh = points_only(xy, 4), out, vorout;
    mesh.trianglelist = corners;
    mesh.trianglearealist = areas;
    mesh.numberoftriangles = 2;
    mesh.numberofcorners = 3;
    mesh.numberoftriangleattributes = 0;
    run("raq", &mesh, &out, &vorout);
    int on_bounded = 0, on_free = 0;
    for (int t = 0; t < out.numberoftriangles; t++) {
        const int *v = &out.trianglelist[3 * t];
        const REAL *a = &out.pointlist[2 * v[0] - 2], *b = &out.pointlist[2 * v[1] - 2];
        const REAL *c = &out.pointlist[2 * v[2] - 2];
        double x = (a[0] + b[0] + c[0]) / 3, y = (a[1] + b[1] + c[1]) / 3;
        double area = ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])) / 2;
        on_bounded += x > y + 0.2 && area > 0.01; /* no segment keeps the border in place */
        on_free += x < y && area > 0.1;
    }
    assert_int_equal(on_bounded, 0);
    assert_true(on_free > 0);
    release("r", &out, &vorout);
}

/* Gives every triangle of `mesh` two attributes: the number of its component between segments, and its own number. */
static void number_components(struct triangulateio *mesh)
{
    int n = mesh->numberoftriangles, *stack = malloc(((size_t)n + 1) * sizeof *stack), components = 0;
    mesh->numberoftriangleattributes = 2;
    mesh->triangleattributelist = calloc(2 * (size_t)n + 1, sizeof(REAL));
    REAL *component = mesh->triangleattributelist; /* the component of every second triangle */
    for (int first = 0; first < n; first++) {
        component[2 * first + 1] = first;
        if (component[2 * first] != 0)
            continue;
        int waiting = 1;
        stack[0] = first;
        component[2 * first] = ++components;
        while (waiting > 0) {
            int t = stack[--waiting];
            for (int k = 0; k < 3; k++) {
                int other = mesh->neighborlist[3 * t + k];
                int a = mesh->trianglelist[3 * t + (k + 1) % 3], b = mesh->trianglelist[3 * t + (k + 2) % 3];
                for (int s = 0; other >= 0 && s < mesh->numberofsegments; s++) {
                    const int *ends = &mesh->segmentlist[2 * s];
                    if ((ends[0] == a && ends[1] == b) || (ends[0] == b && ends[1] == a))
                        other = -1;
                }
                if (other >= 0 && component[2 * other] == 0) {
                    component[2 * other] = components;
                    stack[waiting++] = other;
                }
            }
        }
    }
    free(stack);
}

static void free_arrays(struct triangulateio *mesh)
{
    free(mesh->pointlist);
    free(mesh->pointmarkerlist);
    free(mesh->trianglelist);
    free(mesh->triangleattributelist);
    free(mesh->neighborlist);
    free(mesh->segmentlist);
    free(mesh->segmentmarkerlist);
}

/* Attributes do not cross segments, even if triangles are so flat and so far from the origin that the position of a
   centroid is lost to rounding. */
static void test_attributes_keep_their_side(void **state)
{
    (void)state;
    static REAL x[] = {0.019479877, 0.6555741561, 0.7898612974, 0.4394699812, 0.3434728748, 0.2030327488, 0.2228246209,
                       0.9991590935, 0.9176901327, 0.3941536966, 0.2647444814, 0.3258692246, 0.7552931232, 0.4037777329,
                       0.091462998},
                y[] = {1.0696, 4.9419, 3.9656, 1.1405, 2.1131, 7.0501, 3.2873, 3.6779, 6.4806, 6.7897, 6.1183, 5.1366,
                       8.3599, 8.6826, 6.2122};
    static int segments[] = {3, 8, 3, 5, 10, 2, 1, 6, 3, 9, 7, 13, 10, 2};
    REAL xy[30];
    for (int i = 0; i < 15; i++) {
        xy[2 * i] = 1e6 + x[i];
        xy[2 * i + 1] = 1e6 + 1e-6 * y[i];
    }
    struct triangulateio in = {.pointlist = xy, .numberofpoints = 15, .segmentlist = segments, .numberofsegments = 7};
    struct triangulateio mesh = {0}, out = {0};
    assert_int_equal(triangulate("pcznQ", &in, &mesh, NULL), 0);
    number_components(&mesh);
    assert_int_equal(triangulate("rpznQq30", &mesh, &out, NULL), 0);
    REAL *kept = out.triangleattributelist;
    number_components(&out);
    for (int t = 0; t < out.numberoftriangles; t++)
        for (int u = 0; u < t; u++)
            if (out.triangleattributelist[2 * t] == out.triangleattributelist[2 * u])
                assert_true(kept[2 * t] == kept[2 * u]);
    free(kept);
    free_arrays(&mesh);
    free_arrays(&out);
}

struct asked {
    int calls;
    double largest;
};

static int is_longer_than_bound(void *user, const REAL *a, const REAL *b, const REAL *c, REAL area)
{
    struct asked *asked = user;
    double twice = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    assert_true(twice > 0 && fabs(area - twice / 2) <= 1e-12 * twice);
    asked->calls++;
    asked->largest = fmax(asked->largest, area);
    return (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) > 0.25;
}

static void test_invalid_meshes_are_refused(void **state)
{
    (void)state;
    static REAL xy[] = {0, 0, 2, 0, 2, 2, 0, 2};
    static int good[] = {0, 1, 2, 0, 2, 3}, far[] = {0, 1, 4, 0, 2, 3}, low[] = {0, 1, 2, INT32_MIN, 2, 3};
    static int ends[] = {0, 4};
    struct triangulateio mesh = points_only(xy, 4);
    mesh.trianglelist = far;
    mesh.numberoftriangles = 2;
    mesh.numberofcorners = 3;
    mesh.numberoftriangleattributes = 0;
    assert_fails("rz", &mesh, true, TRIANGULATE_BAD_INPUT, "triangle 0");
    mesh.trianglelist = low;
    assert_fails("rz", &mesh, true, TRIANGULATE_BAD_INPUT, "triangle 1");
    assert_fails("r", &mesh, true, TRIANGULATE_BAD_INPUT, "triangle 1"); /* counted from 1, vertex 0 does not exist */
    mesh.trianglelist = good;
    mesh.numberofcorners = 2;
    assert_fails("rz", &mesh, true, TRIANGULATE_BAD_INPUT, "2 corners");
    mesh.numberofcorners = 3;
    mesh.numberoftriangles = -1;
    assert_fails("rz", &mesh, true, TRIANGULATE_BAD_INPUT, "triangles");
    mesh.numberoftriangles = 2;
    mesh.segmentlist = ends;
    mesh.segmentmarkerlist = NULL;
    mesh.numberofsegments = 1;
    assert_fails("rpz", &mesh, true, TRIANGULATE_BAD_INPUT, "segment 0");
}

/* As MeshPy refines: `a` without a list of areas means no bounds. */
static void test_meshes_without_areas_have_no_bounds(void **state)
{
    (void)state;
    static REAL xy[] = {0, 0, 2, 0, 2, 2, 0, 2};
    static int nodes[] = {0, 1, 2, 0, 2, 3};
    struct asked asked = {0};
    struct triangulate_options options = {.unsuitable = is_longer_than_bound, .unsuitable_user = &asked};
    struct triangulateio mesh = points_only(xy, 4), out, vorout;
    mesh.trianglelist = nodes;
    mesh.numberoftriangles = 2;
    mesh.numberofcorners = 3;
    mesh.numberoftriangleattributes = -1;
    mesh.trianglearealist = NULL;
    prepare("rzn", &out, &vorout);
    assert_int_equal(triangulate_with("razjqQun", &mesh, &out, NULL, &options), 0);
    assert_true(out.numberoftriangles > 20 && asked.calls > out.numberoftriangles);
    judge(&out, NULL, 0, true, NULL);
    release("rzn", &out, &vorout);
}

/* Nodes at midpoints of edges are removed. Other points that no triangle uses are kept. */
static void test_midpoints_of_edges_are_removed(void **state)
{
    (void)state;
    static REAL xy[] = {0, 0, 1, 0, 1, 1, 0, 1, .5, 0, 1, .5, .5, .5, .5, 1, 0, .5, 9, 9};
    static int nodes[] = {0, 1, 2, 5, 6, 4, 0, 2, 3, 7, 8, 6};
    struct triangulateio mesh = points_only(xy, 10), out, vorout;
    mesh.trianglelist = nodes;
    mesh.numberoftriangles = 2;
    mesh.numberofcorners = 6;
    mesh.numberoftriangleattributes = 0;
    run("rz", &mesh, &out, &vorout);
    assert_int_equal(out.numberofpoints, 5);
    assert_int_equal(out.numberofcorners, 3);
    assert_true(out.pointlist[8] == 9 && out.pointlist[9] == 9);
    release("r", &out, &vorout);
    run("rzo2", &mesh, &out, &vorout);
    assert_int_equal(out.numberofpoints, 10);
    const int *t = out.trianglelist;
    int corners_alone[] = {t[0], t[1], t[2], t[6], t[7], t[8]};
    struct triangulateio plain = {0};
    plain.pointlist = out.pointlist;
    plain.numberofpoints = 5;
    plain.trianglelist = corners_alone;
    plain.numberoftriangles = 2;
    judge(&plain, NULL, 0, false, &(struct tri_check_options){.max_bad = -1, .ignore_lost = true});
    release("r", &out, &vorout);
}

/* --- size test */

static void test_the_size_test_of_the_options_is_called(void **state)
{
    (void)state;
    struct asked asked = {0};
    struct triangulate_options options = {.unsuitable = is_longer_than_bound, .unsuitable_user = &asked};
    struct triangulateio in = figure("pz"), out, vorout;
    prepare("pz", &out, &vorout);
    assert_int_equal(triangulate_with("pqa.5uz", &in, &out, NULL, &options), 0);
    assert_true(asked.calls >= out.numberoftriangles && asked.largest <= 0.5);
    for (int t = 0; t < out.numberoftriangles; t++) {
        const int *v = &out.trianglelist[3 * t];
        assert_false(is_longer_than_bound(
                              &asked, &out.pointlist[2 * v[0]], &out.pointlist[2 * v[1]], &out.pointlist[2 * v[2]],
                              0.5 * ((out.pointlist[2 * v[1]] - out.pointlist[2 * v[0]]) *
                                         (out.pointlist[2 * v[2] + 1] - out.pointlist[2 * v[0] + 1]) -
                                     (out.pointlist[2 * v[2]] - out.pointlist[2 * v[0]]) *
                                         (out.pointlist[2 * v[1] + 1] - out.pointlist[2 * v[0] + 1]))));
    }
    release("p", &out, &vorout);
    int before = asked.calls;
    prepare("pz", &out, &vorout);
    assert_int_equal(triangulate_with("pqz", &in, &out, NULL, &options), 0);
    assert_int_equal(asked.calls, before); /* without u the test is not called */
    release("p", &out, &vorout);
}

/* --- clients, with the switches that they pass */

static void test_switches_of_clients_are_accepted(void **state)
{
    (void)state;
    static const char *const all[] = {
        "Qz{pq30}", "Qzc", "Qzv", "QzpAo2", "Qzpq30.0Aao2", "pzjqQAa.10000000000000000000uneYY", "pqezQ", "zQPevcAa",
        "a0.005qpz", "qYYQpz", "cQpz", "Qzn", "Qznp", "Qze", "pQzDq30ia0.100000", "-Qpc", "-Qpc-e-v",
        "-Q-Y-q30.0-D-a0.1p", "pzq28.0nAa             0.10000000000000000000aj", "pzeAa.1q30Q", "-zeY", "-YpzeAfaq33",
        "pYYQenv", "pevnc", "zIQB", "zIQBvDj", "znepXFi", "Qq30pjza0.1A", "eznCQp", "-pA -a -a0.1 -q30 -YY -Y",
        "pzA[Q][o2][Y]a0.1q20.0", "pzenqQYY", "pzNn", "pzDQ", "pznjQ", "pqczeQ", "-z -i -q", "pqa..DBPzQ",
        "pecnzqvDV a.1"};
    struct asked asked = {0};
    struct triangulate_options options = {.unsuitable = is_longer_than_bound, .unsuitable_user = &asked};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        bool area = strstr(all[i], "a..") != NULL; /* an area of 0 is an error, as in Triangle */
        struct triangulateio in = figure(all[i]), out, vorout;
        prepare(all[i], &out, &vorout);
        int code = triangulate_with(all[i], &in, &out, &vorout, &options);
        if (code != (area ? TRIANGULATE_BAD_INPUT : TRIANGULATE_OK))
            fail_msg("%s: %d", all[i], code);
        if (!code)
            release(all[i], &out, &vorout);
    }
}

/* --- the same call again, and concurrent calls */

static void *mesh_repeatedly(void *user)
{
    const int *kind = user;
    const char *switches = *kind ? "pq30a.01z" : "pqa.02Dz";
    struct triangulateio first, out, vorout, in = figure("pz");
    void *good = user;
    prepare("pz", &first, &vorout);
    if (triangulate(switches, &in, &first, NULL))
        return NULL;
    for (int i = 0; i < 8; i++) {
        prepare("pz", &out, &vorout);
        if (triangulate(switches, &in, &out, NULL))
            return NULL;
        if (out.numberofpoints != first.numberofpoints || out.numberoftriangles != first.numberoftriangles ||
            memcmp(out.pointlist, first.pointlist, 2 * (size_t)out.numberofpoints * sizeof(REAL)) ||
            memcmp(out.trianglelist, first.trianglelist, 3 * (size_t)out.numberoftriangles * sizeof(int)))
            good = NULL;
        release("p", &out, &vorout);
    }
    release("p", &first, &vorout);
    return good;
}

static void test_concurrent_calls_give_the_same_mesh(void **state)
{
    (void)state;
    pthread_t threads[4];
    static int kinds[4] = {0, 1, 0, 1};
    for (int i = 0; i < 4; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, mesh_repeatedly, &kinds[i]), 0);
    for (int i = 0; i < 4; i++) {
        void *good;
        assert_int_equal(pthread_join(threads[i], &good), 0);
        assert_ptr_equal(good, &kinds[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fields_by_switch),
        cmocka_unit_test(test_vorout_may_be_null),
        cmocka_unit_test(test_placement_of_triangle),
        cmocka_unit_test(test_numbers_from_one),
        cmocka_unit_test(test_the_mesh_is_correct),
        cmocka_unit_test(test_values_of_points_are_correct),
        cmocka_unit_test(test_markers_of_edges_are_correct),
        cmocka_unit_test(test_midpoints_and_edges_correspond),
        cmocka_unit_test(test_j_removes_unused_points),
        cmocka_unit_test(test_far_coordinates_are_unchanged),
        cmocka_unit_test(test_without_regions_there_is_no_attribute),
        cmocka_unit_test(test_arrays_of_the_caller_are_filled),
        cmocka_unit_test(test_points_may_be_replaced_in_place),
        cmocka_unit_test(test_segments_may_be_replaced_in_place),
        cmocka_unit_test(test_inputs_without_triangles_give_empty_meshes),
        cmocka_unit_test(test_invalid_points_are_refused),
        cmocka_unit_test(test_invalid_counts_are_refused),
        cmocka_unit_test(test_invalid_calls_are_refused),
        cmocka_unit_test(test_unusual_input_is_reported),
        cmocka_unit_test(test_negative_counts_mean_none),
        cmocka_unit_test(test_without_vorout_there_is_no_diagram),
        cmocka_unit_test(test_segments_with_extreme_indices_are_skipped),
        cmocka_unit_test(test_messages_without_options_go_to_stderr),
        cmocka_unit_test(test_the_reason_for_an_empty_mesh_is_reported),
#ifdef SUPPORT_WRAP
        cmocka_unit_test(test_every_allocation_may_fail),
#endif
        cmocka_unit_test(test_hole_outside),
        cmocka_unit_test(test_input_that_hung_triangle_is_meshed),
        cmocka_unit_test(test_duplicates_used_by_segments),
        cmocka_unit_test(test_unreachable_angle),
        cmocka_unit_test(test_comma_locale),
        cmocka_unit_test(test_refine_a_mesh),
        cmocka_unit_test(test_segments_that_are_no_edges_are_copied),
        cmocka_unit_test(test_invalid_numbers_of_corners_are_refused),
        cmocka_unit_test(test_meshes_are_made_delaunay_before_refinement),
        cmocka_unit_test(test_areas_of_triangles_are_bounds),
        cmocka_unit_test(test_attributes_keep_their_side),
        cmocka_unit_test(test_invalid_meshes_are_refused),
        cmocka_unit_test(test_meshes_without_areas_have_no_bounds),
        cmocka_unit_test(test_midpoints_of_edges_are_removed),
        cmocka_unit_test(test_the_size_test_of_the_options_is_called),
        cmocka_unit_test(test_switches_of_clients_are_accepted),
        cmocka_unit_test(test_concurrent_calls_give_the_same_mesh),
    };
    return cmocka_run_group_tests_name("triangulate", tests, NULL, NULL);
}
