/* Tests of the checker: valid meshes of every kind pass, and each kind of fault is found and named.
 *
 * Meshes are written by hand, or are a patch of slanted rows: point (i, j) is at (i + 0.5 * (j odd), 0.8 * j), and
 * every edge is strictly Delaunay. The overlap check is compared with a naive twin on random sets of triangles. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "both_ways.h"
#include "full.h"

enum { ROOM = 4096 };

/* A mesh with room for changes, its input, and the report. */
struct trial {
    double points[2 * ROOM];
    int32_t triangles[3 * ROOM], neighbors[3 * ROOM], segments[2 * ROOM], markers[ROOM];
    int32_t point_markers[ROOM];
    double max_areas[ROOM];
    struct tri_check_mesh mesh;
    struct tri_pslg input;
    bool has_input;
    struct tri_check_options options;
    struct tri_check_report report;
};

static struct trial trial; /* too large for the stack; begin() empties it */

static void begin(void)
{
    memset(&trial, 0, sizeof trial);
    trial.mesh.points = trial.points;
    trial.mesh.triangles = trial.triangles;
    trial.options.max_bad = -1;
}

static int32_t add_point(double x, double y)
{
    int32_t v = trial.mesh.n_points++;
    assert_true(v < ROOM);
    trial.points[2 * v] = x;
    trial.points[2 * v + 1] = y;
    return v;
}

static int32_t add_triangle(int32_t a, int32_t b, int32_t c)
{
    int32_t t = trial.mesh.n_triangles++;
    assert_true(t < ROOM);
    trial.triangles[3 * t] = a;
    trial.triangles[3 * t + 1] = b;
    trial.triangles[3 * t + 2] = c;
    return t;
}

static int32_t add_segment(int32_t a, int32_t b)
{
    int32_t s = trial.mesh.n_segments++;
    assert_true(s < ROOM);
    trial.mesh.segments = trial.segments;
    trial.segments[2 * s] = a;
    trial.segments[2 * s + 1] = b;
    return s;
}

static void remove_triangle(int32_t t)
{
    int32_t last = --trial.mesh.n_triangles;
    memmove(&trial.triangles[3 * t], &trial.triangles[3 * last], 3 * sizeof(int32_t));
}

static void remove_segment(int32_t s)
{
    int32_t last = --trial.mesh.n_segments;
    memmove(&trial.segments[2 * s], &trial.segments[2 * last], 2 * sizeof(int32_t));
}

/* Returns the triangle with the directed edge a b, or -1. *corner: the corner opposite the edge. */
static int32_t find_edge(int32_t a, int32_t b, int *corner)
{
    for (int32_t t = 0; t < trial.mesh.n_triangles; t++) {
        for (int k = 0; k < 3; k++) {
            if (trial.triangles[3 * t + (k + 1) % 3] != a || trial.triangles[3 * t + (k + 2) % 3] != b)
                continue;
            if (corner != NULL)
                *corner = k;
            return t;
        }
    }
    return -1;
}

static void list_boundary(void)
{
    for (int32_t t = 0; t < trial.mesh.n_triangles; t++) {
        for (int k = 0; k < 3; k++) {
            int32_t a = trial.triangles[3 * t + (k + 1) % 3], b = trial.triangles[3 * t + (k + 2) % 3];
            if (find_edge(b, a, NULL) < 0)
                add_segment(a, b);
        }
    }
}

static void list_neighbors(void)
{
    trial.mesh.neighbors = trial.neighbors;
    for (int32_t t = 0; t < trial.mesh.n_triangles; t++) {
        for (int k = 0; k < 3; k++) {
            int32_t a = trial.triangles[3 * t + (k + 1) % 3], b = trial.triangles[3 * t + (k + 2) % 3];
            trial.neighbors[3 * t + k] = find_edge(b, a, NULL);
        }
    }
}

/* Replaces edge a b by the other diagonal. */
static void flip(int32_t a, int32_t b)
{
    int p = 0, q = 0;
    int32_t t = find_edge(a, b, &p), u = find_edge(b, a, &q);
    int32_t c = trial.triangles[3 * t + p], d = trial.triangles[3 * u + q];
    memcpy(&trial.triangles[3 * t], (int32_t[3]){c, a, d}, 3 * sizeof(int32_t));
    memcpy(&trial.triangles[3 * u], (int32_t[3]){d, b, c}, 3 * sizeof(int32_t));
}

enum { COLUMNS = 6, ROWS = 5 };

static int32_t at(int32_t i, int32_t j)
{
    return j * COLUMNS + i;
}

static void add_patch_triangles(int32_t first, int32_t columns, int32_t rows)
{
    for (int32_t j = 0; j + 1 < rows; j++) {
        for (int32_t i = 0; i + 1 < columns; i++) {
            int32_t a = first + j * columns + i, b = a + 1, c = a + columns, d = c + 1;
            if (j % 2 == 0) {
                add_triangle(a, b, c);
                add_triangle(b, d, c);
            } else {
                add_triangle(a, b, d);
                add_triangle(a, d, c);
            }
        }
    }
}

static void add_patch_points(int32_t columns, int32_t rows, double x, double y, double scale)
{
    for (int32_t j = 0; j < rows; j++) {
        for (int32_t i = 0; i < columns; i++)
            add_point(x + scale * (i + 0.5 * (j % 2)), y + scale * 0.8 * j);
    }
}

/* Makes a patch with neighbours and boundary subsegments, which is also the input. */
static void begin_patch(void)
{
    begin();
    add_patch_points(COLUMNS, ROWS, 0, 0, 1);
    add_patch_triangles(0, COLUMNS, ROWS);
    list_boundary();
    list_neighbors();
}

/* Copies the current points and subsegments into the input. */
static void copy_as_input(void)
{
    static double points[2 * ROOM];
    static int32_t segments[2 * ROOM], markers[ROOM];
    memcpy(points, trial.points, sizeof points);
    memcpy(segments, trial.segments, sizeof segments);
    memcpy(markers, trial.markers, sizeof markers);
    trial.input = (struct tri_pslg){.n_points = trial.mesh.n_points,
                                    .points = points,
                                    .n_segments = trial.mesh.n_segments,
                                    .segments = segments,
                                    .segment_markers = markers};
    trial.has_input = true;
}

/* Gives each point the last non-zero marker of a subsegment at it. */
static void mark_points(void)
{
    trial.mesh.point_markers = trial.point_markers;
    for (int32_t i = 0; i < 2 * trial.mesh.n_segments; i++)
        if (trial.markers[i / 2] != 0)
            trial.point_markers[trial.segments[i]] = trial.markers[i / 2];
}

static void judge(void)
{
    struct tri_error error = {0};
    const struct tri_pslg *input = trial.has_input ? &trial.input : NULL;
    assert_int_equal(check_both_ways(&trial.mesh, input, &trial.options, &trial.report, &error), TRI_OK);
}

static void expect_good(void)
{
    judge();
    for (int k = 0; k < TRI_N_CHECKS; k++) {
        if (trial.report.item[k].state == TRI_CHECK_FAILED) {
            fail_msg("%s: %s", tri_check_name((enum tri_check_kind)k), trial.report.item[k].text);
        }
    }
    assert_true(tri_check_passed(&trial.report));
}

/* Asserts that this kind has `count` faults and a witness, and that other kinds except `also` (-1: no exception) have
 * none. */
static void expect(enum tri_check_kind kind, int64_t count, int also)
{
    judge();
    for (int k = 0; k < TRI_N_CHECKS; k++) {
        const struct tri_check_item *item = &trial.report.item[k];
        if (k != (int)kind && k != also && item->state == TRI_CHECK_FAILED) {
            fail_msg("also %s: %s", tri_check_name((enum tri_check_kind)k), item->text);
        }
    }
    assert_int_equal(trial.report.item[kind].state, TRI_CHECK_FAILED);
    assert_int_equal(trial.report.item[kind].count, count);
    assert_true(trial.report.item[kind].text[0] != '\0');
    assert_false(tri_check_passed(&trial.report));
}

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.17g is not %.17g", value, expected);
}

static bool failed(enum tri_check_kind kind)
{
    return trial.report.item[kind].state == TRI_CHECK_FAILED;
}

/* --- valid meshes */

static void good_patch(void **state)
{
    (void)state;
    begin_patch();
    trial.mesh.segment_markers = trial.markers;
    copy_as_input();
    for (int32_t s = 0; s < trial.mesh.n_segments; s++)
        trial.markers[s] = 1;
    mark_points();
    trial.options.min_angle = 50;
    trial.options.max_area = 0.4;
    trial.options.delaunay = TRI_CHECK_CONFORMING;
    expect_good();
    const struct tri_check_report *r = &trial.report;
    for (int k = 0; k < TRI_N_CHECKS; k++) {
        if (k != TRI_CHECK_HULL && k != TRI_CHECK_REGIONS && k != TRI_CHECK_NODES &&
            k != TRI_CHECK_VERTEX_ATTRIBUTES)
            assert_int_equal(r->item[k].state, TRI_CHECK_OK);
    }
    assert_int_equal(r->n_used_points, 30);
    assert_int_equal(r->n_edges, 69);
    assert_int_equal(r->n_boundary_edges, 18);
    assert_near(r->smallest_area, 0.4, 1e-12);
    assert_near(r->largest_area, 0.4, 1e-12);
    assert_near(r->total_area, 16, 1e-12);
    double base = atan2(0.8, 0.5) * 180 / acos(-1);
    assert_near(r->smallest_angle, base, 1e-9);
    assert_near(r->largest_angle, 180 - 2 * base, 1e-9);
}

static void good_nothing(void **state)
{
    (void)state;
    begin();
    expect_good();
    add_point(0, 0), add_point(1, 1), add_point(2, 2);
    trial.mesh.segments = trial.segments;
    trial.mesh.neighbors = trial.neighbors;
    trial.input.segments = NULL;
    copy_as_input();
    trial.input.n_segments = 1;
    trial.input.segments[0] = 0, trial.input.segments[1] = 2;
    trial.options.min_angle = 20;
    trial.options.convex = true;
    expect_good(); /* a PSLG that is not closed encloses nothing */
    assert_near(trial.report.smallest_angle, 0, 0);
}

static void good_hole_and_island(void **state)
{
    (void)state;
    begin_patch();
    trial.mesh.n_segments = 0;
    int32_t t = find_edge(at(2, 2), at(3, 2), NULL);
    double hole[2] = {2.5, 1.8};
    remove_triangle(t);
    int32_t a = add_point(2.4, 1.7), b = add_point(2.6, 1.7), c = add_point(2.5, 1.8); /* an island in the hole */
    add_triangle(a, b, c);
    list_boundary();
    list_neighbors();
    copy_as_input();
    expect(TRI_CHECK_FACES, 1, -1);
    trial.options.border = TRI_CHECK_BORDER_ANY;
    expect_good();
    trial.options.border = TRI_CHECK_BORDER_SEGMENTS;
    trial.input.n_holes = 1;
    trial.input.holes = hole;
    hole[0] = 9; /* outside the mesh */
    expect(TRI_CHECK_FACES, 1, -1);
    hole[0] = 2.5;
    hole[1] = 1.65;
    expect_good();
    hole[1] = 1.7; /* on the island's edge */
    expect_good();
    hole[1] = 1.7 + 0x1p-48; /* beside it: rounding may have put an edge there */
    expect_good();
    hole[1] = 1.75; /* in the island */
    expect(TRI_CHECK_HOLES, 1, TRI_CHECK_FACES);
    trial.options.ignore_holes = true;
    expect(TRI_CHECK_FACES, 1, -1);
    hole[1] = 1.65; /* now nothing must be empty */
    expect(TRI_CHECK_FACES, 1, -1);
}

/* A mesh without triangles for an input with many segments that meet at one point and three segments that enclose a
 * face elsewhere. There are more segments than the checker compares pairwise. */
static void lost_face_beside_a_hub(void **state)
{
    (void)state;
    enum { N = 17000 };
    double(*points)[2] = calloc(N + 4, sizeof *points);
    int32_t(*ends)[2] = calloc(N + 3, sizeof *ends);
    assert_true(points && ends);
    for (int32_t i = 1; i <= N; i++) {
        points[i][0] = 1e5;
        points[i][1] = i;
        ends[i - 1][1] = i;
    }
    for (int32_t k = 0; k < 3; k++) {
        points[N + 1 + k][0] = k < 2 ? 2e5 : 3e5;
        points[N + 1 + k][1] = k % 2;
        ends[N + k][0] = N + 1 + k;
        ends[N + k][1] = N + 1 + (k + 1) % 3;
    }
    const struct tri_check_mesh mesh = {.n_points = N + 4, .points = points[0], .segments = ends[0]};
    struct tri_pslg input = {.n_points = N + 4, .points = points[0], .n_segments = N + 3, .segments = ends[0]};
    const struct tri_check_options options = {.max_bad = -1};
    struct tri_check_report report;
    assert_int_equal(tri_check(&mesh, &input, &options, &report, NULL), TRI_OK);
    assert_int_equal(report.item[TRI_CHECK_FACES].state, TRI_CHECK_FAILED);
    input.n_segments = N; /* these segments enclose nothing */
    assert_int_equal(tri_check(&mesh, &input, &options, &report, NULL), TRI_OK);
    assert_int_equal(report.item[TRI_CHECK_FACES].state, TRI_CHECK_OK);
    free(points);
    free(ends);
}

/* Two holes that touch at a corner are two faces. A hole point at that corner is in both. */
static void faces_that_touch(void **state)
{
    (void)state;
    begin_patch();
    trial.mesh.n_segments = 0;
    remove_triangle(find_edge(at(1, 1), at(2, 1), NULL));
    remove_triangle(find_edge(at(2, 1), at(3, 1), NULL));
    list_boundary();
    list_neighbors();
    copy_as_input();
    expect(TRI_CHECK_FACES, 2, -1);
    double hole[2] = {trial.points[2 * at(2, 1)] + 0.5, trial.points[2 * at(2, 1) + 1] + 0.1};
    trial.input.n_holes = 1;
    trial.input.holes = hole;
    expect(TRI_CHECK_FACES, 1, -1);
    hole[0] -= 0.5;
    hole[1] -= 0.1;
    expect_good();
}

static void good_dangling_segment(void **state)
{
    (void)state;
    begin_patch();
    add_segment(at(1, 1), at(2, 1));
    add_segment(at(2, 1), at(3, 1));
    copy_as_input();
    expect_good();
}

static void good_components_that_touch(void **state)
{
    (void)state;
    begin();
    int32_t o = add_point(0, 0), a = add_point(1, 0), b = add_point(1, 1), c = add_point(-1, 0), d = add_point(-1, -1);
    add_triangle(o, a, b);
    add_triangle(o, c, d);
    list_boundary();
    list_neighbors();
    copy_as_input();
    expect_good();
    int32_t e = add_point(0, 1), f = add_point(0, 2), g = add_point(-1, 2); /* a separate vertical edge */
    add_triangle(e, f, g);
    trial.mesh.n_segments = 0;
    list_boundary();
    list_neighbors();
    copy_as_input();
    expect_good();
    trial.options.convex = true;
    expect(TRI_CHECK_HULL, 1, -1);
}

static void good_rounded_chain(void **state)
{
    (void)state;
    begin();
    double m = 1.0 / 3; /* not exactly on either line */
    int32_t a = add_point(0.1, 0.1), b = add_point(1.3, 0.7), c = add_point(0, 2);
    add_segment(a, b), add_segment(b, c), add_segment(c, a);
    copy_as_input();
    int32_t p = add_point(0.1 + (1.3 - 0.1) * m, 0.1 + (0.7 - 0.1) * m);
    add_triangle(a, p, c);
    add_triangle(p, b, c);
    trial.mesh.n_segments = 0;
    list_boundary();
    trial.options.delaunay = TRI_CHECK_NOT_DELAUNAY;
    expect_good();
    trial.points[2 * p] += 1e-9;
    expect(TRI_CHECK_INPUT_SEGMENTS, 1, TRI_CHECK_BORDER);
}

static void good_any_scale(void **state)
{
    (void)state;
    const int exponents[] = {600, -900, 150};
    for (int i = 0; i < 3; i++) {
        begin_patch();
        for (int32_t v = 0; v < 2 * trial.mesh.n_points; v++)
            trial.points[v] = ldexp(trial.points[v], exponents[i]);
        copy_as_input();
        trial.options.max_area = i == 2 ? ldexp(0.4, 300) : 0;
        trial.options.min_angle = 50;
        expect_good();
        trial.options.max_area *= 0.99;
        if (i == 2)
            expect(TRI_CHECK_AREAS, 40, -1);
    }
}

/* --- the mesh itself */

static void broken_arrays(void **state)
{
    (void)state;
    begin_patch();
    trial.triangles[5] = trial.mesh.n_points;
    trial.triangles[9] = -1;
    trial.options.base = 1;
    expect(TRI_CHECK_ARRAYS, 2, -1);
    assert_string_equal(trial.report.item[TRI_CHECK_ARRAYS].text, "triangle 2 has corner 31, which is not a vertex");
    assert_int_equal(trial.report.item[TRI_CHECK_EDGES].state, TRI_CHECK_SKIPPED);
    begin_patch();
    trial.points[7] = NAN;
    expect(TRI_CHECK_ARRAYS, 1, -1);
}

static void broken_orientation(void **state)
{
    (void)state;
    begin_patch();
    int32_t a = trial.triangles[21];
    trial.triangles[21] = trial.triangles[22];
    trial.triangles[22] = a;
    judge();
    assert_int_equal(trial.report.item[TRI_CHECK_ORIENTATION].count, 1);
    assert_non_null(strstr(trial.report.item[TRI_CHECK_ORIENTATION].text, "triangle 7 "));
    assert_true(failed(TRI_CHECK_EDGES));
    begin();
    add_point(0, 0), add_point(1, 1), add_point(3, 3);
    add_triangle(0, 1, 2);
    judge();
    assert_string_equal(trial.report.item[TRI_CHECK_ORIENTATION].text, "triangle 0 (0 1 2) is flat");
    trial.points[5] = nextafter(3, 4); /* counter-clockwise by the smallest amount */
    expect_good();
}

static void broken_edges(void **state)
{
    (void)state;
    begin_patch();
    add_triangle(trial.triangles[30], trial.triangles[31], trial.triangles[32]); /* a triangle given twice */
    trial.mesh.neighbors = NULL;
    judge();
    assert_true(failed(TRI_CHECK_EDGES));
    begin_patch();
    int32_t v = add_point(2.5, -1); /* a second triangle on an inner edge */
    add_triangle(at(2, 1), at(2, 2), v);
    trial.mesh.neighbors = NULL;
    judge();
    assert_true(failed(TRI_CHECK_EDGES) || failed(TRI_CHECK_ORIENTATION));
    begin();
    add_point(0, 0), add_point(4, 0), add_point(1, 3), add_point(2, 2), add_point(3, 3), add_point(2, -2);
    add_triangle(0, 1, 2), add_triangle(0, 1, 4); /* two triangles on one side of an edge, a third on the other */
    add_triangle(1, 0, 5);
    expect(TRI_CHECK_EDGES, 3, -1);
}

static void broken_neighbors(void **state)
{
    (void)state;
    begin_patch();
    assert_true(trial.neighbors[16] != 3);
    trial.neighbors[16] = 3;
    expect(TRI_CHECK_NEIGHBORS, 1, -1);
    begin_patch();
    for (int32_t i = 0; i < 3 * trial.mesh.n_triangles; i++) {
        if (trial.neighbors[i] < 0)
            trial.neighbors[i] = 0;
    }
    expect(TRI_CHECK_NEIGHBORS, 18, -1);
}

/* Eight points around a ninth, each a quarter turn after the previous one, so that the star winds twice. */
static void broken_star(void **state)
{
    (void)state;
    begin();
    const double x[] = {1, 0, -1, 0, 2, 0, -2, 0}, y[] = {0, 1, 0, -1, 0, 2, 0, -2};
    for (int i = 0; i < 8; i++)
        add_point(x[i], y[i]);
    int32_t o = add_point(0, 0);
    for (int32_t i = 0; i < 8; i++)
        add_triangle(o, i, (i + 1) % 8);
    expect(TRI_CHECK_OVERLAP, 1, -1);
    remove_triangle(5); /* the star is open, but still winds more than once */
    judge();
    assert_true(failed(TRI_CHECK_OVERLAP));
}

static void broken_overlap(void **state)
{
    (void)state;
    begin_patch(); /* a second patch on top, with a separate boundary */
    trial.mesh.n_segments = 0;
    trial.mesh.neighbors = NULL;
    add_patch_points(3, 3, 1.01, 0.81, 0.5);
    add_patch_triangles(COLUMNS * ROWS, 3, 3);
    list_boundary();
    expect(TRI_CHECK_OVERLAP, 1, -1);
    begin(); /* two triangles that cross */
    add_point(0, 0), add_point(4, 0), add_point(2, 4), add_point(0, 3), add_point(2, -1), add_point(4, 3);
    add_triangle(0, 1, 2), add_triangle(3, 4, 5);
    expect(TRI_CHECK_OVERLAP, 1, -1);
    begin(); /* the same without a vertex inside the other triangle, and with a vertical edge */
    add_point(0, 0), add_point(4, 0), add_point(2, 4), add_point(2, -1), add_point(6, 0), add_point(2, 9);
    add_triangle(0, 1, 2), add_triangle(3, 4, 5);
    expect(TRI_CHECK_OVERLAP, 1, -1);
}

static void broken_overlap_by_a_moved_vertex(void **state)
{
    (void)state;
    begin_patch();
    trial.points[2 * at(2, 2)] += 2; /* outside its star */
    judge();
    assert_true(failed(TRI_CHECK_ORIENTATION));
}

static void broken_hanging_vertex(void **state)
{
    (void)state;
    begin();
    int32_t a = add_point(0, 0), b = add_point(4, 0), c = add_point(2, 3), d = add_point(2, -3), m = add_point(2, 0);
    add_triangle(a, b, c);
    add_triangle(m, a, d);
    add_triangle(b, m, d);
    expect(TRI_CHECK_OVERLAP, 1, -1);
    assert_non_null(strstr(trial.report.item[TRI_CHECK_OVERLAP].text, "one runs along the other"));
    begin(); /* the vertex just touches an edge */
    add_point(0, 0), add_point(4, 0), add_point(2, 3), add_point(2, 0), add_point(3, -3), add_point(4, -3);
    add_triangle(0, 1, 2), add_triangle(3, 4, 5);
    expect(TRI_CHECK_OVERLAP, 1, -1);
    assert_non_null(strstr(trial.report.item[TRI_CHECK_OVERLAP].text, "a vertex of one lies inside the other"));
    trial.points[2 * 3 + 1] = -1e-300; /* a gap that is tiny, which counts as 0 */
    expect(TRI_CHECK_OVERLAP, 1, -1);
    trial.points[2 * 3 + 1] = -1e-60;
    expect_good();
}

static void broken_coinciding_vertices(void **state)
{
    (void)state;
    begin();
    add_point(0, 0), add_point(1, 0), add_point(0, 1), add_point(0, 0), add_point(-1, 0), add_point(0, -1);
    add_triangle(0, 1, 2), add_triangle(3, 4, 5);
    expect(TRI_CHECK_OVERLAP, 1, -1);
    assert_non_null(strstr(trial.report.item[TRI_CHECK_OVERLAP].text, "same place"));
}

/* --- naive twin of the overlap check: random sets of triangles on a small grid of points */

/* Exact, because the coordinates are small integers. */
static double turn(const double *p, const double *q, const double *r)
{
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
}

static const double *corner(int32_t t, int k)
{
    return &trial.points[2 * trial.triangles[3 * t + k]];
}

/* Returns true if all of u lies beyond the line of an edge of t. */
static bool separates(int32_t t, int32_t u)
{
    for (int k = 0; k < 3; k++) {
        int n = 0;
        for (int m = 0; m < 3; m++)
            n += turn(corner(t, k), corner(t, (k + 1) % 3), corner(u, m)) <= 0;
        if (n == 3)
            return true;
    }
    return false;
}

/* Returns true if a corner of u lies in t and is not a corner of t. */
static bool intrudes(int32_t t, int32_t u)
{
    for (int m = 0; m < 3; m++) {
        int inside = 0, same = 0;
        for (int k = 0; k < 3; k++) {
            inside += turn(corner(t, k), corner(t, (k + 1) % 3), corner(u, m)) >= 0;
            same += trial.triangles[3 * t + k] == trial.triangles[3 * u + m];
        }
        if (inside == 3 && same == 0)
            return true;
    }
    return false;
}

static bool naive_is_triangulation(void)
{
    for (int32_t t = 0; t < trial.mesh.n_triangles; t++) {
        if (turn(corner(t, 0), corner(t, 1), corner(t, 2)) <= 0)
            return false;
        for (int32_t u = 0; u < t; u++) {
            if (!(separates(t, u) || separates(u, t)) || intrudes(t, u) || intrudes(u, t))
                return false;
        }
    }
    return true;
}

static uint32_t random_below(uint32_t n)
{
    static uint32_t x = 12345;
    x ^= x << 13, x ^= x >> 17, x ^= x << 5;
    return x % n;
}

/* Random corners, usually made counter-clockwise. */
static void add_random_triangle(int32_t n_points)
{
    int32_t v[3];
    for (int k = 0; k < 3; k++)
        v[k] = (int32_t)random_below((uint32_t)n_points);
    bool turned = turn(&trial.points[2 * v[0]], &trial.points[2 * v[1]], &trial.points[2 * v[2]]) < 0;
    if (turned && random_below(50) > 0) {
        add_triangle(v[0], v[2], v[1]);
    } else if (turned || v[0] != v[1]) {
        add_triangle(v[0], v[1], v[2]);
    }
}

static void twin_of_overlap(void **state)
{
    (void)state;
    int count[5][2] = {{0}};
    for (int i = 0; i < 60000; i += every(10)) {
        begin();
        int32_t n = 4 + (int32_t)random_below(6), wanted = 1 + (int32_t)random_below(5);
        uint32_t side = 3 + random_below(4);
        for (int32_t v = 0; v < n; v++)
            add_point(random_below(side), random_below(side));
        for (int32_t k = 0; k < 60 && trial.mesh.n_triangles < wanted; k++) {
            add_random_triangle(n);
            /* random sets are seldom valid, so most triangles that make a fault are removed again */
            if (trial.mesh.n_triangles > 0 && random_below(12) > 0 && !naive_is_triangulation())
                trial.mesh.n_triangles--;
        }
        if (trial.mesh.n_triangles == 0)
            continue;
        bool good = naive_is_triangulation();
        count[trial.mesh.n_triangles - 1][good]++;
        trial.options.delaunay = TRI_CHECK_NOT_DELAUNAY;
        trial.options.ignore_lost = true;
        judge();
        if (tri_check_passed(&trial.report) != good)
            fail_msg("heap %d: %s", i, good ? "good" : "bad");
    }
    for (int k = 0; k < 5; k++)
        assert_true(count[k][0] > 50 / every(10) && count[k][1] > 50 / every(10));
}

/* --- Delaunay */

static void broken_delaunay(void **state)
{
    (void)state;
    begin_patch();
    flip(at(2, 2), at(3, 2));
    list_neighbors();
    expect(TRI_CHECK_LOCAL_DELAUNAY, 1, -1);
    trial.options.delaunay = TRI_CHECK_NOT_DELAUNAY;
    expect_good();
    trial.options.delaunay = TRI_CHECK_CONSTRAINED;
    int p;
    (void)find_edge(at(2, 1), at(2, 3), &p);
    add_segment(at(2, 1), at(2, 3));
    expect_good(); /* as a constrained edge it is allowed */
    trial.options.delaunay = TRI_CHECK_CONFORMING;
    expect(TRI_CHECK_LOCAL_DELAUNAY, 1, TRI_CHECK_ENCROACHMENT);
    assert_int_equal(trial.report.item[TRI_CHECK_ENCROACHMENT].count, 1); /* both sides see it at a flat angle */
}

static void broken_diametral_circle(void **state)
{
    (void)state;
    begin();
    add_point(0, 0), add_point(2, 0), add_point(1, 1); /* a right angle: the vertex is on the circle */
    add_triangle(0, 1, 2);
    trial.options.delaunay = TRI_CHECK_CONFORMING;
    expect_good();
    trial.points[5] = 1 - 0x1p-53;
    expect(TRI_CHECK_ENCROACHMENT, 1, -1);
    trial.points[5] = 1 + 0x1p-52;
    expect_good();
    begin(); /* the two products are 2^54 - 1 and -2^54, which are equal after rounding */
    add_point(0x1p27 + 1, -0x1p27), add_point(0x1p27 - 1, 0x1p27), add_point(0, 0);
    add_triangle(0, 1, 2);
    trial.options.delaunay = TRI_CHECK_CONFORMING;
    expect(TRI_CHECK_ENCROACHMENT, 1, -1);
}

/* --- segments */

static void broken_boundary(void **state)
{
    (void)state;
    begin_patch();
    copy_as_input();
    remove_segment(4);
    judge();
    assert_int_equal(trial.report.item[TRI_CHECK_BOUNDARY].count, 1);
    begin_patch();
    remove_triangle(find_edge(at(2, 2), at(3, 2), NULL)); /* a missing triangle is a hole without segments */
    list_neighbors();
    expect(TRI_CHECK_BOUNDARY, 3, -1);
}

static void broken_subsegments(void **state)
{
    (void)state;
    begin_patch();
    add_segment(at(0, 0), at(3, 3));
    expect(TRI_CHECK_SUBSEGMENTS, 1, -1);
    begin_patch();
    add_segment(trial.segments[1], trial.segments[0]);
    expect(TRI_CHECK_SUBSEGMENTS, 1, -1);
    begin_patch();
    add_segment(3, 3);
    add_segment(0, 1000);
    add_segment(-1, 0);
    expect(TRI_CHECK_SUBSEGMENTS, 3, -1);
}

static void broken_input_segments(void **state)
{
    (void)state;
    begin_patch();
    add_segment(at(1, 1), at(2, 1));
    copy_as_input();
    remove_segment(trial.mesh.n_segments - 1);
    expect(TRI_CHECK_INPUT_SEGMENTS, 1, -1);
    assert_non_null(strstr(trial.report.item[TRI_CHECK_INPUT_SEGMENTS].text, "segment 18 (7-8)"));
    begin_patch(); /* one subsegment of a long segment is missing */
    copy_as_input();
    int32_t *ends = &trial.input.segments[2 * trial.input.n_segments++];
    ends[0] = at(0, 2), ends[1] = at(5, 2);
    for (int32_t i = 0; i < 5; i++)
        add_segment(at(i, 2), at(i + 1, 2));
    expect_good();
    remove_segment(trial.mesh.n_segments - 3);
    expect(TRI_CHECK_INPUT_SEGMENTS, 1, -1);
    ends[0] = -5; /* not a valid segment */
    expect_good();
}

/* A strip of unit squares 0 .. 6. Squares 1 and 4 are carved, and one input segment runs along the middle line. */
static void begin_strip(void)
{
    begin();
    for (int32_t i = 0; i <= 7; i++) {
        for (int32_t j = 0; j < 3; j++)
            add_point(i, j - 1);
    }
    for (int32_t i = 0; i < 7; i++) {
        if (i == 1 || i == 4)
            continue;
        for (int32_t j = 0; j < 2; j++) {
            int32_t a = 3 * i + j, b = a + 3, c = a + 4, d = a + 1;
            add_triangle(a, b, c);
            add_triangle(a, c, d);
        }
    }
    list_boundary();
    copy_as_input();
    int32_t last = trial.input.n_segments++;
    trial.input.segments[2 * last] = 1;
    trial.input.segments[2 * last + 1] = 22;
}

static void carved_pieces_are_good(void **state)
{
    (void)state;
    begin_strip();
    const int32_t inside[] = {0, 2, 3, 5, 6};
    int32_t first = trial.mesh.n_segments;
    for (int k = 0; k < 5; k++)
        add_segment(3 * inside[k] + 1, 3 * inside[k] + 4);
    expect_good();
    for (int32_t k = 0; k < 5; k++) { /* each of the five is needed */
        int32_t a = trial.segments[2 * (first + k)], b = trial.segments[2 * (first + k) + 1];
        remove_segment(first + k);
        expect(TRI_CHECK_INPUT_SEGMENTS, 1, -1);
        (void)add_segment(a, b);
        int32_t *moved = &trial.segments[2 * (first + k)], *end = &trial.segments[2 * (trial.mesh.n_segments - 1)];
        end[0] = moved[0], end[1] = moved[1];
        moved[0] = a, moved[1] = b;
    }
    int32_t far = trial.input.n_points++; /* an end of the segment is outside the mesh */
    trial.input.points[2 * far] = 30, trial.input.points[2 * far + 1] = 0;
    trial.points[2 * far] = 30, trial.points[2 * far + 1] = 0;
    trial.mesh.n_points++;
    trial.input.segments[2 * trial.input.n_segments - 1] = far;
    expect_good();
}

static void broken_markers(void **state)
{
    (void)state;
    begin_patch();
    int32_t s = add_segment(at(1, 1), at(2, 1));
    add_segment(at(2, 1), at(3, 1));
    trial.mesh.segment_markers = trial.markers;
    trial.markers[2] = 7;
    trial.markers[s] = -4;
    copy_as_input();
    for (int32_t i = 0; i < s; i++)
        trial.markers[i] = i == 2 ? 7 : 1;
    expect_good();
    trial.markers[s + 1] = 1;
    expect(TRI_CHECK_MARKERS, 1, -1);
    trial.markers[2] = 1;
    expect(TRI_CHECK_MARKERS, 2, -1);
    begin_patch(); /* overlapping input segments: the first non-zero marker wins */
    s = add_segment(at(1, 1), at(2, 1));
    add_segment(at(1, 1), at(3, 1));
    add_segment(at(2, 1), at(3, 1));
    trial.markers[s + 1] = 5;
    trial.markers[s + 2] = 6;
    copy_as_input();
    trial.segments[2 * (s + 1)] = at(2, 1); /* the mesh has two subsegments instead */
    remove_segment(s + 2);
    trial.mesh.segment_markers = trial.markers;
    for (int32_t k = 0; k < s; k++)
        trial.markers[k] = 1;
    trial.markers[s] = 5;
    expect_good();
}

static void broken_vertex_markers(void **state)
{
    (void)state;
    begin_patch();
    int32_t inside = at(2, 2), rim = at(2, 0);
    trial.markers[add_segment(at(1, 1), at(2, 1))] = 9;
    trial.mesh.segment_markers = trial.markers;
    copy_as_input();
    for (int32_t s = 0; s + 1 < trial.mesh.n_segments; s++)
        trial.markers[s] = 1;
    mark_points();
    expect_good();
    trial.point_markers[inside] = 1; /* the marker of no input segment */
    expect(TRI_CHECK_VERTEX_MARKERS, 1, -1);
    trial.point_markers[inside] = 0;
    trial.point_markers[rim] = 0; /* on the boundary */
    expect(TRI_CHECK_VERTEX_MARKERS, 1, -1);
    trial.point_markers[rim] = 9; /* the marker of a segment at another place */
    expect(TRI_CHECK_VERTEX_MARKERS, 1, -1);
    trial.point_markers[rim] = 1;
    trial.point_markers[at(1, 1)] = 0; /* on a segment with a marker */
    expect(TRI_CHECK_VERTEX_MARKERS, 1, -1);
    int32_t own[ROOM] = {0};
    own[rim] = 4; /* a marker of its own, which must be kept */
    trial.input.markers = own;
    trial.point_markers[at(1, 1)] = 9;
    expect(TRI_CHECK_VERTEX_MARKERS, 1, -1);
    trial.point_markers[rim] = 4;
    expect_good();
}

/* Triangles are removed at the rim. The mesh then lacks area inside, and its new rim is reported. */
static void broken_border(void **state)
{
    (void)state;
    for (int32_t t = 0; t < 40; t++) {
        begin_patch();
        copy_as_input();
        remove_triangle(t);
        trial.mesh.n_segments = 0;
        list_boundary();
        list_neighbors();
        judge();
        assert_true(failed(TRI_CHECK_BORDER));
        trial.options.border = TRI_CHECK_BORDER_HULL;
        judge();
        assert_true(failed(TRI_CHECK_BORDER));
        trial.options.border = TRI_CHECK_BORDER_ANY;
        judge();
        assert_false(failed(TRI_CHECK_BORDER));
    }
}

/* Without segments the mesh must end at the hull. */
static void border_of_points(void **state)
{
    (void)state;
    begin();
    add_point(0, 0), add_point(3, 0), add_point(3, 2), add_point(0, 2), add_point(1, 1);
    add_triangle(0, 1, 4), add_triangle(1, 2, 4), add_triangle(2, 3, 4), add_triangle(3, 0, 4);
    copy_as_input();
    trial.input.n_segments = 0;
    expect_good();
    remove_triangle(3);
    judge();
    assert_int_equal(trial.report.item[TRI_CHECK_BORDER].count, 2);
    begin(); /* a new point on the hull is rounded */
    add_point(0.1, 0.1), add_point(1.3, 0.7), add_point(0, 2);
    copy_as_input();
    add_point(0.1 + (1.3 - 0.1) / 3, 0.1 + (0.7 - 0.1) / 3);
    add_triangle(0, 3, 2), add_triangle(3, 1, 2);
    list_boundary();
    trial.options.delaunay = TRI_CHECK_NOT_DELAUNAY;
    expect_good();
}

/* Two chains lead from vertex 1 to 4, over 2 and over 3. They are so close that the input segment from 0 to 4 may run
 * along either; from 0 to 1 there is only one way. That segment has marker 5 and comes first with long_one_first. The
 * segment from 1 to 2 has marker 3. */
static void begin_lens(bool long_one_first)
{
    static const int32_t chains[5][2] = {{0, 1}, {1, 2}, {2, 4}, {1, 3}, {3, 4}};
    static const int32_t rim[4][2] = {{0, 5}, {5, 4}, {4, 6}, {6, 0}};
    begin();
    add_point(-4, 0), add_point(0, 0), add_point(1.5, 0x1p-50), add_point(2.5, -0x1p-50), add_point(4, 0);
    add_point(2, -1), add_point(2, 1);
    add_triangle(1, 3, 2), add_triangle(3, 4, 2);
    add_triangle(0, 1, 6), add_triangle(1, 2, 6), add_triangle(2, 4, 6);
    add_triangle(0, 5, 1), add_triangle(1, 5, 3), add_triangle(3, 5, 4);
    trial.options.delaunay = TRI_CHECK_NOT_DELAUNAY;
    for (int k = 0; k < 5; k++)
        add_segment(chains[k][0], chains[k][1]);
    for (int k = 0; k < 4; k++)
        trial.markers[add_segment(rim[k][0], rim[k][1])] = 1;
    copy_as_input();
    int32_t first = long_one_first ? 0 : 1, second = 1 - first;
    trial.input.segments[2 * first] = 0, trial.input.segments[2 * first + 1] = 4;
    trial.input.segments[2 * second] = 1, trial.input.segments[2 * second + 1] = 2;
    trial.input.segment_markers[first] = 5;
    trial.input.segment_markers[second] = 3;
    trial.mesh.segment_markers = trial.markers;
    trial.markers[0] = 5; /* 0 to 1, certainly on the long segment */
    trial.markers[1] = 3;
}

static void markers_at_forks(void **state)
{
    (void)state;
    begin_lens(true);
    expect_good();
    trial.markers[1] = 5, trial.markers[2] = 5; /* on one way */
    expect_good();
    trial.markers[1] = 3, trial.markers[2] = 0, trial.markers[3] = 5, trial.markers[4] = 5; /* on the other way */
    expect_good();
    trial.markers[3] = 6; /* the marker of no input segment */
    expect(TRI_CHECK_MARKERS, 1, -1);
    trial.markers[3] = 3; /* the marker of a segment elsewhere */
    expect(TRI_CHECK_MARKERS, 1, -1);
    for (int32_t marker = 0; marker < 4; marker++) { /* before the fork only one way is possible */
        begin_lens(true);
        trial.markers[0] = marker;
        expect(TRI_CHECK_MARKERS, 1, -1);
    }
    begin_lens(false); /* the first input segment certainly runs from 1 to 2, so its marker is required there */
    expect_good();
    trial.markers[1] = 5;
    expect(TRI_CHECK_MARKERS, 1, -1);
}

/* A different half of each chain of the lens is missing. All places of the long segment are near some subsegment, but
 * no path leads from one half to the other. */
static void halves_beside_each_other(void **state)
{
    (void)state;
    begin_lens(true);
    trial.mesh.segment_markers = NULL;
    remove_segment(4); /* the subsegment 3 to 4 */
    remove_segment(1); /* the subsegment 1 to 2 */
    for (int s = 0; s < 5; s++) { /* input segments 1 to 3 and 2 to 4 are fine */
        trial.input.segments[2 * s] = s % 2 == 1 ? 1 : 2;
        trial.input.segments[2 * s + 1] = s % 2 == 1 ? 3 : 4;
    }
    expect_good();
    trial.input.segments[0] = 0;
    expect(TRI_CHECK_INPUT_SEGMENTS, 1, -1);
}

/* A chain whose inner vertex is this many units in the last place of its larger coordinate off the line. */
static void begin_bend(double ulps)
{
    begin();
    add_point(1, 1), add_point(3, 1), add_point(2, 1 + ulps * 3 * 0x1p-52), add_point(2, 3), add_point(2, -1);
    add_triangle(0, 2, 3), add_triangle(2, 1, 3), add_triangle(0, 4, 2), add_triangle(2, 4, 1);
    trial.options.delaunay = TRI_CHECK_NOT_DELAUNAY;
    list_boundary();
    add_segment(0, 1);
    copy_as_input();
    remove_segment(trial.mesh.n_segments - 1);
    add_segment(0, 2), add_segment(2, 1);
}

static void bent_segments(void **state)
{
    (void)state;
    begin_bend(0);
    expect_good();
    begin_bend(-TRI_CHECK_ULPS + 0.5);
    expect_good();
    begin_bend(TRI_CHECK_ULPS + 1);
    expect(TRI_CHECK_INPUT_SEGMENTS, 1, -1);
    begin_bend(20);
    expect(TRI_CHECK_INPUT_SEGMENTS, 1, -1);
    begin_bend(3);
    trial.segments[2 * (trial.mesh.n_segments - 1)] = 3; /* one half is missing */
    judge();
    assert_int_equal(trial.report.item[TRI_CHECK_INPUT_SEGMENTS].count, 1);
}

/* The side is shorter than the tolerance at its place. An input segment ends at its corner, on its exact line, and the
 * rest of that segment is carved. The side does not belong to the segment. */
static void marker_beyond_the_end(void **state)
{
    (void)state;
    double far = 0x1p50;
    begin();
    add_point(far, far), add_point(far + 1, far), add_point(far + 1, far + 9), add_point(far, far + 9);
    add_point(far - 10, far);
    add_triangle(0, 1, 2), add_triangle(0, 2, 3);
    list_boundary();
    trial.mesh.segment_markers = trial.markers;
    copy_as_input();
    int32_t n = trial.input.n_segments++;
    trial.input.segments[2 * n] = 4, trial.input.segments[2 * n + 1] = 0;
    trial.input.segment_markers[n] = 9;
    for (int32_t s = 0; s < n; s++)
        trial.markers[s] = 1;
    expect_good();
}

/* The unit square, and an input segment from below its lower side to beyond its right side. It reaches into the square
 * by `depth`, and the mesh lacks it. */
static void begin_grazed(double depth)
{
    begin();
    add_point(0, 0), add_point(1, 0), add_point(1, 1), add_point(0, 1);
    add_triangle(0, 1, 2), add_triangle(0, 2, 3);
    add_point(0.25, -depth / 2), add_point(1.5, 2 * depth);
    list_boundary();
    copy_as_input();
    int32_t last = trial.input.n_segments++;
    trial.input.segments[2 * last] = 4;
    trial.input.segments[2 * last + 1] = 5;
}

static void missing_segment_near_the_boundary(void **state)
{
    (void)state;
    begin_grazed(0x1p-50);
    expect_good();
    begin_grazed(0x1p-45);
    expect(TRI_CHECK_INPUT_SEGMENTS, 1, -1);
    begin_grazed(0.125);
    expect(TRI_CHECK_INPUT_SEGMENTS, 1, -1);
}

/* --- input vertices */

static void broken_input_vertices(void **state)
{
    (void)state;
    begin_patch();
    copy_as_input();
    trial.points[2 * at(3, 1)] = nextafter(trial.points[2 * at(3, 1)], 10);
    expect(TRI_CHECK_INPUT_VERTICES, 1, TRI_CHECK_LOST_VERTICES); /* no vertex is at its place any more */
    begin_patch();
    copy_as_input();
    trial.input.points[2 * trial.input.n_points] = 100; /* outside, and missing in the mesh */
    trial.input.n_points++;
    expect(TRI_CHECK_INPUT_VERTICES, 1, -1);
}

static void broken_lost_vertex(void **state)
{
    (void)state;
    begin_patch();
    add_point(2.5, 1.8);
    copy_as_input();
    expect(TRI_CHECK_LOST_VERTICES, 1, -1);
    trial.options.ignore_lost = true;
    expect_good();
    trial.options.ignore_lost = false;
    trial.points[2 * 30] = trial.input.points[2 * 30] = 2.25; /* on a boundary edge, which it should have split */
    trial.points[2 * 30 + 1] = trial.input.points[2 * 30 + 1] = 0;
    expect(TRI_CHECK_LOST_VERTICES, 1, -1);
    trial.points[2 * 30] = trial.input.points[2 * 30] = 1.5; /* at the place of another vertex */
    trial.points[2 * 30 + 1] = trial.input.points[2 * 30 + 1] = trial.points[2 * at(1, 1) + 1];
    expect_good();
    trial.points[2 * 30] = trial.input.points[2 * 30] = 150; /* outside the mesh */
    expect_good();
    trial.options.convex = true;
    judge();
    assert_true(failed(TRI_CHECK_HULL));
}

static void duplicates_stand_for_each_other(void **state)
{
    (void)state;
    begin_patch();
    add_segment(at(1, 1), at(2, 1));
    int32_t twin = add_point(trial.points[2 * at(1, 1)], trial.points[2 * at(1, 1) + 1]);
    copy_as_input();
    trial.input.segments[2 * 18] = twin;
    expect_good();
    trial.mesh.n_points--; /* not in the output */
    expect(TRI_CHECK_INPUT_VERTICES, 1, -1);
    trial.options.renumbered = true;
    expect_good();
    memmove(trial.input.points + 2, trial.input.points, (size_t)trial.input.n_points * 2 * sizeof(double));
    for (int32_t i = 0; i < 2 * trial.input.n_segments; i++)
        trial.input.segments[i]++;
    trial.input.n_points++;
    trial.input.points[0] = -50;
    expect_good();
}

/* --- quality */

static void broken_angles(void **state)
{
    (void)state;
    begin_patch();
    trial.options.min_angle = 64.02;
    trial.options.small_input_angle = 20;
    expect(TRI_CHECK_ANGLES, 40, -1);
    trial.options.max_bad = 40;
    expect_good();
    trial.options.max_bad = 39;
    expect(TRI_CHECK_ANGLES, 1, -1);
    begin();
    add_point(0, 0), add_point(1, 0), add_point(0, 1);
    add_triangle(0, 1, 2);
    trial.options.min_angle = 45; /* satisfied exactly, regardless of rounding */
    trial.options.small_input_angle = 20;
    expect_good();
    assert_near(trial.report.largest_angle, 90, 1e-9);
    trial.options.min_angle = 45.000001;
    expect(TRI_CHECK_ANGLES, 1, -1);
    trial.options.small_input_angle = 0; /* caused by corners of the input */
    expect_good();
    assert_int_equal(trial.report.n_small_explained, 1);
    assert_int_equal(trial.report.n_apexes, 2);
}

/* Equilateral triangles, rotated by any angle, satisfy the bound regardless of rounding. */
static void rounding_does_not_violate_bounds(void **state)
{
    (void)state;
    for (int i = 0; i < 100; i++) {
        begin();
        for (int k = 0; k < 3; k++) {
            double angle = i + k * 2 * acos(-1) / 3;
            add_point(cos(angle), sin(angle));
        }
        add_triangle(0, 1, 2);
        trial.options.min_angle = 60;
        trial.options.small_input_angle = 20;
        trial.options.max_area = 0.75 * sqrt(3);
        expect_good();
    }
}

/* A wedge of ten degrees whose triangles have corners on both legs, also far from the apex. */
static void small_input_angles_explain(void **state)
{
    (void)state;
    begin();
    double x = cos(10 * acos(-1) / 180), y = sin(10 * acos(-1) / 180);
    int32_t o = add_point(0, 0), before[2] = {o, o};
    for (int i = 0; i < 6; i++) {
        double r = ldexp(1, i);
        int32_t a = add_point(r, 0), b = add_point(r * x, r * y);
        if (i == 0) {
            add_triangle(o, a, b);
        } else {
            add_triangle(before[0], a, b);
            add_triangle(before[0], b, before[1]);
        }
        before[0] = a, before[1] = b;
    }
    int32_t p = add_point(40, -1), q = add_point(60, 1);
    add_triangle(before[0], q, before[1]);
    add_triangle(before[0], p, q); /* thin, and not explained by the input */
    list_boundary();
    trial.options.delaunay = TRI_CHECK_NOT_DELAUNAY;
    trial.options.min_angle = 20;
    trial.options.small_input_angle = 11; /* the ends of the wedge are not apexes */
    expect(TRI_CHECK_ANGLES, 1, -1);
    assert_int_equal(trial.report.n_small - trial.report.n_small_explained, 1);
    assert_true(trial.report.n_small_explained >= 11);
    assert_true(trial.report.largest_area > 100 * trial.report.smallest_area);
    assert_non_null(strstr(trial.report.item[TRI_CHECK_ANGLES].text, "triangle 12 "));
}

static void broken_areas(void **state)
{
    (void)state;
    begin_patch();
    trial.options.max_area = 0.4; /* the area of each triangle, except for rounding */
    expect_good();
    trial.options.max_area = 0.39999;
    expect(TRI_CHECK_AREAS, 40, -1);
    trial.options.max_area = 0;
    trial.options.max_areas = trial.max_areas;
    expect_good();
    trial.max_areas[3] = 0.1;
    trial.max_areas[4] = 0.5;
    trial.max_areas[5] = -1;
    expect(TRI_CHECK_AREAS, 1, -1);
    assert_non_null(strstr(trial.report.item[TRI_CHECK_AREAS].text, "triangle 3 "));
}

static void broken_hull(void **state)
{
    (void)state;
    begin();
    add_point(0, 0), add_point(2, 0), add_point(2, 2), add_point(0, 2), add_point(1, 0);
    add_triangle(0, 4, 3), add_triangle(4, 1, 2), add_triangle(4, 2, 3);
    trial.options.convex = true;
    expect_good();
    remove_triangle(2);
    expect(TRI_CHECK_HULL, 1, -1);
    begin(); /* two hulls are not convex */
    add_point(0, 0), add_point(1, 0), add_point(0, 1), add_point(5, 0), add_point(6, 0), add_point(5, 1);
    add_triangle(0, 1, 2), add_triangle(3, 4, 5);
    trial.options.convex = true;
    expect(TRI_CHECK_HULL, 1, -1);
}

/* Vertices on an edge of the hull may lie on either side of it within the tolerance, but not farther inside. */
static void rounded_hull(void **state)
{
    (void)state;
    static const struct {
        int32_t ulps;
        bool good;
    } cases[] = {{0, true}, {1, true}, {-1, true}, {14, true}, {-14, true}, {17, false}, {1000, false}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        begin();
        add_point(0, 0), add_point(4, 0), add_point(4, 4), add_point(0, 4), add_point(2, cases[i].ulps * 4 * 0x1p-52);
        add_triangle(0, 4, 3), add_triangle(4, 1, 2), add_triangle(4, 2, 3);
        trial.options.convex = true;
        if (cases[i].good)
            expect_good();
        else
            expect(TRI_CHECK_HULL, 1, -1);
    }
}

/* A boundary that turns right within rounding at each vertex, but is concave as a whole. */
static void hollow_hull(void **state)
{
    (void)state;
    enum { N = 64 };
    begin();
    for (int k = 0; k <= N; k++)
        add_point(k, k * (N - k) * 0x1p-50);
    int32_t top = add_point(N / 2, N);
    for (int k = 0; k < N; k++)
        add_triangle(k, k + 1, top);
    trial.options.convex = true;
    trial.options.delaunay = TRI_CHECK_NOT_DELAUNAY;
    expect(TRI_CHECK_HULL, 1, -1);
}

/* --- six nodes, attributes of vertices */

static int32_t middles[3 * ROOM];
static double attributes[2 * ROOM], input_attributes[2 * ROOM];

static void put_node(int32_t m, int32_t a, int32_t b, bool is_subsegment)
{
    for (int k = 0; k < 2; k++) {
        trial.points[2 * m + k] = (trial.points[2 * a + k] + trial.points[2 * b + k]) / 2;
        attributes[2 * m + k] = (attributes[2 * a + k] + attributes[2 * b + k]) / 2;
    }
    trial.point_markers[m] = is_subsegment ? 4 : 0;
}

/* The patch with a node in the middle of each edge and two attributes. Nodes on subsegments have markers. Without these
 * nodes it is also the input. */
static void begin_six(void)
{
    begin_patch();
    trial.mesh.segment_markers = trial.markers;
    for (int32_t s = 0; s < trial.mesh.n_segments; s++)
        trial.markers[s] = 4;
    mark_points();
    for (int32_t i = 0; i < 2 * trial.mesh.n_points; i++)
        input_attributes[i] = attributes[i] = i % 7 - 3;
    copy_as_input();
    trial.input.attributes = input_attributes;
    trial.input.n_attributes = trial.mesh.n_point_attributes = 2;
    trial.mesh.point_attributes = attributes;
    trial.mesh.middles = middles;
    trial.mesh.n_nodes = trial.mesh.n_points;
    for (int32_t i = 0; i < 3 * trial.mesh.n_triangles; i++) {
        int32_t t = i / 3, k = i % 3;
        int32_t a = trial.triangles[3 * t + (k + 1) % 3], b = trial.triangles[3 * t + (k + 2) % 3];
        int corner;
        int32_t u = find_edge(b, a, &corner);
        middles[i] = u >= 0 && u < t ? middles[3 * u + corner] : trial.mesh.n_nodes++;
        put_node(middles[i], a, b, u < 0);
    }
    assert_true(trial.mesh.n_nodes == 30 + 69 && trial.mesh.n_nodes <= ROOM);
}

/* The middle node of an inner edge, in the first of its triangles. */
static int32_t *inner_middle(void)
{
    for (int32_t i = 0; i < 3 * trial.mesh.n_triangles; i++)
        if (trial.neighbors[i] >= 0)
            return &middles[i];
    return NULL;
}

static void good_nodes(void **state)
{
    (void)state;
    begin_six();
    expect_good();
    assert_int_equal(trial.report.item[TRI_CHECK_NODES].state, TRI_CHECK_OK);
    assert_int_equal(trial.report.item[TRI_CHECK_VERTEX_ATTRIBUTES].state, TRI_CHECK_OK);
    assert_int_equal(trial.report.item[TRI_CHECK_VERTEX_MARKERS].state, TRI_CHECK_OK);
}

static void broken_nodes(void **state)
{
    (void)state;
    begin_six();
    double *x = &trial.points[2 * *inner_middle()];
    *x = nextafter(*x, 9);
    expect(TRI_CHECK_NODES, 2, -1); /* reported by both triangles */
    begin_six();
    int32_t own = trial.mesh.n_nodes++;
    memcpy(&trial.points[2 * own], &trial.points[2 * *inner_middle()], 2 * sizeof(double));
    memcpy(&attributes[2 * own], &attributes[2 * *inner_middle()], 2 * sizeof(double));
    *inner_middle() = own;
    expect(TRI_CHECK_NODES, 1, -1); /* one node more than there are edges */
    begin_six();
    *inner_middle() = -1;
    expect(TRI_CHECK_NODES, 1, -1);
    *inner_middle() = trial.mesh.n_nodes;
    expect(TRI_CHECK_NODES, 1, -1);
    *inner_middle() = 0; /* a corner */
    expect(TRI_CHECK_NODES, 1, -1);
    begin_six();
    trial.point_markers[*inner_middle()] = 4;
    expect(TRI_CHECK_NODES, 2, -1);
    begin_six();
    for (int32_t m = trial.mesh.n_points; m < trial.mesh.n_nodes; m++)
        trial.point_markers[m] = 0;
    expect(TRI_CHECK_NODES, 18, -1);
    trial.mesh.point_markers = NULL;
    expect_good();
}

static void broken_vertex_attributes(void **state)
{
    (void)state;
    begin_six();
    attributes[2 * *inner_middle() + 1] += 1;
    expect(TRI_CHECK_VERTEX_ATTRIBUTES, 2, -1);
    begin_six();
    trial.mesh.middles = NULL;
    attributes[7] += 0.5;
    expect(TRI_CHECK_VERTEX_ATTRIBUTES, 1, -1);
    trial.options.renumbered = true; /* in range, and renumbering hides which node it is */
    expect_good();
    attributes[7] = 3.5;
    expect(TRI_CHECK_VERTEX_ATTRIBUTES, 1, -1);
    attributes[7] = NAN;
    expect(TRI_CHECK_VERTEX_ATTRIBUTES, 1, -1);
    begin_six();
    trial.input.n_attributes = 1;
    expect(TRI_CHECK_VERTEX_ATTRIBUTES, 1, -1);
    trial.mesh.point_attributes = NULL;
    expect_good();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(good_patch),
        cmocka_unit_test(good_nothing),
        cmocka_unit_test(good_hole_and_island),
        cmocka_unit_test(lost_face_beside_a_hub),
        cmocka_unit_test(faces_that_touch),
        cmocka_unit_test(good_dangling_segment),
        cmocka_unit_test(good_components_that_touch),
        cmocka_unit_test(good_rounded_chain),
        cmocka_unit_test(good_any_scale),
        cmocka_unit_test(broken_arrays),
        cmocka_unit_test(broken_orientation),
        cmocka_unit_test(broken_edges),
        cmocka_unit_test(broken_neighbors),
        cmocka_unit_test(broken_star),
        cmocka_unit_test(broken_overlap),
        cmocka_unit_test(broken_overlap_by_a_moved_vertex),
        cmocka_unit_test(broken_hanging_vertex),
        cmocka_unit_test(broken_coinciding_vertices),
        cmocka_unit_test(twin_of_overlap),
        cmocka_unit_test(broken_delaunay),
        cmocka_unit_test(broken_diametral_circle),
        cmocka_unit_test(broken_boundary),
        cmocka_unit_test(broken_subsegments),
        cmocka_unit_test(broken_input_segments),
        cmocka_unit_test(carved_pieces_are_good),
        cmocka_unit_test(broken_markers),
        cmocka_unit_test(broken_vertex_markers),
        cmocka_unit_test(broken_border),
        cmocka_unit_test(border_of_points),
        cmocka_unit_test(markers_at_forks),
        cmocka_unit_test(halves_beside_each_other),
        cmocka_unit_test(bent_segments),
        cmocka_unit_test(marker_beyond_the_end),
        cmocka_unit_test(missing_segment_near_the_boundary),
        cmocka_unit_test(broken_input_vertices),
        cmocka_unit_test(broken_lost_vertex),
        cmocka_unit_test(duplicates_stand_for_each_other),
        cmocka_unit_test(broken_angles),
        cmocka_unit_test(rounding_does_not_violate_bounds),
        cmocka_unit_test(small_input_angles_explain),
        cmocka_unit_test(broken_areas),
        cmocka_unit_test(broken_hull),
        cmocka_unit_test(rounded_hull),
        cmocka_unit_test(hollow_hull),
        cmocka_unit_test(good_nodes),
        cmocka_unit_test(broken_nodes),
        cmocka_unit_test(broken_vertex_attributes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
