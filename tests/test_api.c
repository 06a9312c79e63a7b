/* Tests of the public headers from the view of a user. The only internal feature used makes allocations fail.
 *
 * Linked with --wrap for malloc, calloc, realloc and free: see allocations.h. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "allocations.h"
#include "full.h"
#include "ptriangle/check.h"
#include "ptriangle/files.h"
#include "ptriangle/par.h"
#include "triangle/size/feature_size.h"

/* A square with a square hole, two regions on the two sides of a wall, attributes, and markers. */
static const double points[][2] = {{0, 0}, {4, 0}, {4, 3}, {0, 3}, {1, 1}, {2, 1}, {2, 2}, {1, 2}, {3, 0}, {3, 3}};
static const int32_t segments[][2] = {{0, 8}, {8, 1}, {1, 2}, {2, 9}, {9, 3}, {3, 0},
                                      {4, 5}, {5, 6}, {6, 7}, {7, 4}, {8, 9}};
static const int32_t markers[] = {5, 5, 6, 7, 7, 8, 9, 9, 9, 9, 10};
static const double hole[2] = {1.5, 1.5}, regions[2][4] = {{0.5, 0.5, 11, 0}, {3.5, 0.5, 12, 0.01}};

static struct tri_figure plate(void)
{
    struct tri_figure figure = tri_no_figure();
    figure.points = tri_reals_of(points[0], 10, 2);
    figure.segments = tri_ints_of(segments[0], 11, 2);
    figure.segment_markers = tri_ints_of(markers, 11, 1);
    figure.holes = tri_reals_of(hole, 1, 2);
    figure.regions = tri_reals_of(regions[0], 2, 4);
    return figure;
}

static struct tri_settings fine(void)
{
    struct tri_settings settings = tri_no_settings();
    settings.min_angle = 30;
    settings.max_area = 0.05;
    return settings;
}

static struct tri_mesh *mesh_of(const struct tri_figure *figure, const struct tri_settings *settings)
{
    struct tri_mesh *mesh;
    struct tri_error error = {0};
    if (tri_mesh_new(&mesh, figure, settings, &error) != TRI_OK)
        fail_msg("%s", error.text);
    return mesh;
}

static void assert_sound(const struct tri_mesh *mesh, const struct tri_figure *input, double max_area)
{
    struct tri_figure made = tri_no_figure();
    struct tri_demands demands = tri_no_demands();
    struct tri_verdict verdict;
    demands.min_angle = 30;
    demands.max_area = max_area;
    tri_mesh_figure(mesh, &made);
    assert_int_equal(tri_check_figure(&made, input, &demands, &verdict, NULL), TRI_OK);
    if (verdict.n_faults != 0)
        fail_msg("%s", verdict.text);
    assert_true(verdict.smallest_angle >= 30 - 1e-10 && verdict.n_small == 0);
}

static const double *place(struct tri_reals xy, int64_t v) { return xy.at + v * xy.stride; }
static const int32_t *row(struct tri_ints ints, int64_t i) { return ints.at + i * ints.stride; }

static bool same_ints(struct tri_ints a, struct tri_ints b)
{
    bool same = a.n == b.n && a.width == b.width;
    for (int64_t i = 0; same && i < a.n; i++)
        same = memcmp(row(a, i), row(b, i), (size_t)a.width * sizeof *a.at) == 0;
    return same;
}

static bool same_reals(struct tri_reals a, struct tri_reals b)
{
    bool same = a.n == b.n && a.width == b.width;
    for (int64_t i = 0; same && i < a.n; i++)
        same = memcmp(place(a, i), place(b, i), (size_t)a.width * sizeof *a.at) == 0;
    return same;
}

static bool same_meshes(const struct tri_mesh *a, const struct tri_mesh *b)
{
    return same_reals(tri_mesh_points(a), tri_mesh_points(b)) &&
           same_ints(tri_mesh_triangles(a), tri_mesh_triangles(b)) &&
           same_ints(tri_mesh_segments(a), tri_mesh_segments(b)) &&
           same_ints(tri_mesh_segment_markers(a), tri_mesh_segment_markers(b)) &&
           same_ints(tri_mesh_point_markers(a), tri_mesh_point_markers(b)) &&
           same_reals(tri_mesh_triangle_attributes(a), tri_mesh_triangle_attributes(b));
}

/* --- meshes */

static double area_of(struct tri_reals xy, const int32_t *v)
{
    const double *a = place(xy, v[0]), *b = place(xy, v[1]), *c = place(xy, v[2]);
    return ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
}

static void test_a_mesh_satisfies_its_settings(void **state)
{
    (void)state;
    const struct tri_figure figure = plate();
    const struct tri_settings settings = fine();
    struct tri_mesh *mesh = mesh_of(&figure, &settings);
    struct tri_ints triangles = tri_mesh_triangles(mesh);
    struct tri_reals xy = tri_mesh_points(mesh), attributes = tri_mesh_triangle_attributes(mesh);
    double total = 0;
    assert_sound(mesh, &figure, 0.05);
    assert_true(attributes.n == triangles.n && attributes.width == 1 && triangles.n > 300);
    for (int64_t t = 0; t < triangles.n; t++) {
        const int32_t *v = row(triangles, t);
        double x = (place(xy, v[0])[0] + place(xy, v[1])[0] + place(xy, v[2])[0]) / 3, area = area_of(xy, v);
        assert_true(attributes.at[t] == (x < 3 ? 11 : 12));
        assert_true(area > 0 && area <= (x < 3 ? 0.05 : 0.01) * (1 + 1e-12));
        total += area;
    }
    assert_true(fabs(total - 11) < 1e-9);
    assert_int_equal(tri_mesh_count_bad(mesh, &settings, NULL, 0), 0);
    int64_t free_points = tri_mesh_count(mesh, TRI_COUNT_NEW_POINTS);
    assert_int_equal(free_points + tri_mesh_count(mesh, TRI_COUNT_NEW_POINTS_ON_SEGMENTS), xy.n - 10);
    assert_true(same_reals(tri_reals_of(xy.at, 10, 2), figure.points));
    tri_mesh_delete(mesh);
}

static void test_neighbors_and_edges(void **state)
{
    (void)state;
    const struct tri_figure figure = plate();
    const struct tri_settings settings = fine();
    struct tri_mesh *mesh = mesh_of(&figure, &settings);
    struct tri_ints neighbors, edges, edge_markers, triangles = tri_mesh_triangles(mesh);
    int64_t boundary = 0, marked = 0;
    assert_int_equal(tri_mesh_neighbors(mesh, &neighbors, NULL), TRI_OK);
    assert_int_equal(tri_mesh_edges(mesh, &edges, &edge_markers, NULL), TRI_OK);
    assert_true(neighbors.n == triangles.n && neighbors.width == 3 && edges.n == edge_markers.n);
    for (int64_t t = 0; t < triangles.n; t++)
        for (int k = 0; k < 3; k++) {
            int32_t other = row(neighbors, t)[k];
            const int32_t *back = other < 0 ? NULL : row(neighbors, other);
            boundary += other < 0;
            assert_true(other < 0 || back[0] == t || back[1] == t || back[2] == t);
        }
    for (int64_t i = 0; i < edges.n; i++)
        marked += edge_markers.at[i] != 0;
    assert_int_equal(marked, tri_mesh_segments(mesh).n);
    assert_int_equal(2 * edges.n, 3 * triangles.n + boundary);
    assert_int_equal(tri_mesh_points(mesh).n - edges.n + triangles.n, 0); /* Euler's formula with one hole */
    tri_mesh_delete(mesh);
}

static void test_points_without_segments(void **state)
{
    (void)state;
    struct tri_figure figure = tri_no_figure();
    figure.points = tri_reals_of(points[0], 10, 2);
    struct tri_mesh *mesh = mesh_of(&figure, NULL);
    assert_int_equal(tri_mesh_points(mesh).n, 10);
    assert_int_equal(tri_mesh_triangles(mesh).n, 2 * 10 - 2 - 6); /* six vertices are on the hull */
    assert_int_equal(tri_mesh_triangle_attributes(mesh).n, 0);
    assert_int_equal(tri_mesh_point_attributes(mesh).n, 0);
    tri_mesh_delete(mesh);
    tri_mesh_delete(NULL);
}

/* Rows with gaps, and attributes that are linear in the plane. */
static void test_strides_and_attributes(void **state)
{
    (void)state;
    double wide[10][5], linear[10][2];
    for (int v = 0; v < 10; v++) {
        wide[v][1] = points[v][0];
        wide[v][2] = points[v][1];
        linear[v][0] = wide[v][3] = 2 * points[v][0] - points[v][1];
        linear[v][1] = wide[v][4] = 1;
        wide[v][0] = NAN;
    }
    struct tri_figure tight = plate(), gaps = plate();
    const struct tri_settings settings = fine();
    tight.point_attributes = tri_reals_of(linear[0], 10, 2);
    gaps.points = (struct tri_reals){&wide[0][1], 10, 2, 5};
    gaps.point_attributes = (struct tri_reals){&wide[0][3], 10, 2, 5};
    struct tri_mesh *a = mesh_of(&tight, &settings), *b = mesh_of(&gaps, &settings);
    struct tri_reals xy = tri_mesh_points(b), values = tri_mesh_point_attributes(b);
    assert_true(same_meshes(a, b));
    assert_true(values.n == xy.n && values.width == 2);
    for (int64_t v = 0; v < xy.n; v++) {
        assert_true(fabs(place(values, v)[0] - (2 * place(xy, v)[0] - place(xy, v)[1])) < 1e-12);
        assert_true(fabs(place(values, v)[1] - 1) < 1e-12);
    }
    tri_mesh_delete(a);
    tri_mesh_delete(b);
}

/* A mesh is a valid figure: meshing it again gives the same triangles, and the result can be refined. */
static void test_a_mesh_as_figure(void **state)
{
    (void)state;
    const struct tri_figure figure = plate();
    struct tri_settings settings = fine();
    struct tri_mesh *mesh = mesh_of(&figure, &settings);
    struct tri_figure made = tri_no_figure();
    tri_mesh_figure(mesh, &made);
    struct tri_mesh *again = mesh_of(&made, NULL);
    assert_int_equal(tri_mesh_triangles(again).n, tri_mesh_triangles(mesh).n);
    assert_true(same_reals(tri_mesh_points(again), tri_mesh_points(mesh)));
    settings.max_area = 0.02;
    struct tri_mesh *finer = mesh_of(&made, &settings);
    struct tri_reals attributes = tri_mesh_triangle_attributes(finer);
    assert_sound(finer, NULL, 0.02);
    assert_int_equal(attributes.n, tri_mesh_triangles(finer).n);
    for (int64_t t = 0; t < attributes.n; t++)
        assert_true(attributes.at[t] == 11 || attributes.at[t] == 12);
    tri_mesh_delete(finer);
    tri_mesh_delete(again);
    tri_mesh_delete(mesh);
}

/* Coordinates far beyond the range of the predicates. Regions with area bounds must also work in refinement. */
static void test_coordinates_of_any_magnitude(void **state)
{
    (void)state;
    double large[10][2], there[2] = {ldexp(1.5, 700), ldexp(1.5, 700)};
    struct tri_figure figure = plate();
    struct tri_settings settings = tri_no_settings();
    settings.min_angle = 30;
    for (int i = 0; i < 20; i++)
        large[i / 2][i % 2] = ldexp(points[i / 2][i % 2], 700);
    figure.regions = tri_reals_of(NULL, 0, 0);
    struct tri_mesh *mesh = mesh_of(&figure, &settings);
    figure.points = tri_reals_of(large[0], 10, 2);
    figure.holes = tri_reals_of(there, 1, 2);
    struct tri_mesh *huge = mesh_of(&figure, &settings);
    struct tri_reals xy = tri_mesh_points(mesh), at = tri_mesh_points(huge);
    assert_true(same_ints(tri_mesh_triangles(mesh), tri_mesh_triangles(huge)) && xy.n == at.n);
    for (int64_t i = 0; i < 2 * xy.n; i++)
        assert_true(at.at[i] == ldexp(xy.at[i], 700));
    tri_mesh_delete(mesh);
    tri_mesh_delete(huge);
}

/* The ring of the hole makes the hole without a hole point. The wall between the regions is not a ring and has no
 * effect. */
static void test_even_odd(void **state)
{
    (void)state;
    struct tri_figure figure = plate();
    struct tri_settings settings = fine();
    struct tri_mesh *wanted = mesh_of(&figure, &settings);
    figure.holes.n = 0;
    settings.even_odd = true;
    struct tri_mesh *mesh = mesh_of(&figure, &settings);
    assert_true(same_meshes(mesh, wanted));
    tri_mesh_delete(mesh);
    tri_mesh_delete(wanted);
}

/* The lattice makes a third fewer triangles, unless the angle bound is large or the figure is a mesh. */
static void test_placement(void **state)
{
    (void)state;
    struct tri_figure figure = plate();
    static const double angles[] = {0, 20, 30, 30.5, 33};
    figure.regions = tri_reals_of(NULL, 0, 0); /* with regions, the coarse mesh would have bounds and new vertices */
    for (size_t i = 0; i < sizeof angles / sizeof *angles; i++) {
        struct tri_settings settings = fine();
        settings.min_angle = angles[i];
        settings.max_area = 0.001;
        struct tri_mesh *lattice = mesh_of(&figure, &settings), *coarse = mesh_of(&figure, NULL);
        settings.placement = TRI_PLACEMENT_CLASSIC;
        struct tri_mesh *classic = mesh_of(&figure, &settings);
        const double n = (double)tri_mesh_triangles(lattice).n, of = (double)tri_mesh_triangles(classic).n;
        assert_true(angles[i] <= 30 ? n > 0.6 * of && n < 0.8 * of : same_meshes(lattice, classic));
        if (angles[i] == 30) {
            assert_sound(lattice, &figure, 0.001);
            assert_sound(classic, &figure, 0.001);
        }
        settings.placement = TRI_PLACEMENT_LATTICE;
        assert_int_equal(tri_mesh_refine(coarse, &settings, NULL), TRI_OK);
        const double further = (double)tri_mesh_triangles(coarse).n;
        assert_true(angles[i] > 30 || fabs(further - n) < 0.05 * n);
        tri_mesh_delete(lattice);
        tri_mesh_delete(coarse);
        tri_mesh_delete(classic);
    }
}

static void test_placement_in_a_given_mesh(void **state)
{
    (void)state;
    const struct tri_figure figure = plate();
    struct tri_settings settings = fine();
    struct tri_figure given = tri_no_figure();
    struct tri_mesh *coarse = mesh_of(&figure, &settings);
    tri_mesh_figure(coarse, &given);
    settings.max_area = 0.001;
    struct tri_mesh *lattice = mesh_of(&given, &settings);
    settings.placement = TRI_PLACEMENT_CLASSIC;
    struct tri_mesh *classic = mesh_of(&given, &settings);
    assert_true(same_meshes(lattice, classic));
    tri_mesh_delete(lattice);
    tri_mesh_delete(classic);
    tri_mesh_delete(coarse);
}

/* --- callbacks */

static double length_at(void *user, const double at[2])
{
    ++*(int64_t *)user;
    return 0.05 + 0.2 * at[0];
}

static void test_edge_length(void **state)
{
    (void)state;
    int64_t asked = 0;
    struct tri_figure figure = plate();
    struct tri_settings settings = tri_no_settings();
    settings.min_angle = 30;
    settings.edge_length = length_at;
    settings.edge_length_user = &asked;
    struct tri_mesh *mesh = mesh_of(&figure, &settings);
    struct tri_ints triangles = tri_mesh_triangles(mesh);
    struct tri_reals xy = tri_mesh_points(mesh);
    double largest[4] = {0};
    assert_sound(mesh, &figure, 0);
    for (int64_t t = 0; t < triangles.n; t++) {
        const int32_t *v = row(triangles, t);
        double area = area_of(xy, v), x = fmin(place(xy, v[0])[0], fmin(place(xy, v[1])[0], place(xy, v[2])[0]));
        double length = 0.05 + 0.2 * x;
        int column = (int)x;
        assert_true(area <= sqrt(3) / 4 * length * length * (1 + 1e-12));
        largest[column] = fmax(largest[column], area);
    }
    assert_true(asked > triangles.n && largest[2] > 2 * largest[0]);
    tri_mesh_delete(mesh);
}

static double same_everywhere(void *user, const double at[2])
{
    (void)at;
    return *(const double *)user;
}

static void test_invalid_edge_lengths_are_refused(void **state)
{
    (void)state;
    double odd[] = {0, -0.01, NAN, INFINITY, -INFINITY};
    static const char *const odd_notes[] = {"edge_length returned 0 at (", "edge_length returned -0.01 at (",
                                            "edge_length returned nan at (", "", "edge_length returned -inf at ("};
    const struct tri_settings none = tri_no_settings();
    struct tri_figure figure = plate();
    struct tri_settings settings = tri_no_settings();
    settings.min_angle = 30;
    settings.placement = TRI_PLACEMENT_CLASSIC; /* edge_length requires this placement */
    struct tri_mesh *plain = mesh_of(&figure, &settings);
    settings.edge_length = same_everywhere;
    settings.most_new_points = 10000;
    for (size_t i = 0; i < sizeof odd / sizeof *odd; i++) {
        settings.edge_length_user = &odd[i];
        struct tri_mesh *mesh = mesh_of(&figure, &settings);
        assert_true(same_meshes(plain, mesh));
        assert_int_equal(strncmp(tri_mesh_notes(mesh), odd_notes[i], strlen(odd_notes[i]) + !*odd_notes[i]), 0);
        assert_null(strchr(tri_mesh_notes(mesh), '\n'));
        assert_int_equal(tri_mesh_refine(mesh, &none, NULL), TRI_OK);
        assert_string_equal(tri_mesh_notes(mesh), "");
        tri_mesh_delete(mesh);
    }
    tri_mesh_delete(plain);
}

/* An edge length function that counts its calls. */
struct lengths {
    double length;
    double slope;   /* lengths decrease by this much per unit of x */
    double octaves; /* lengths vary by this many octaves, at random by place */
    atomic_llong asked;
    long long most; /* number of calls after which `stop` returns true */
};

static double length_asked(void *user, const double at[2])
{
    struct lengths *lengths = user;
    const double part = fmod(7919.7 * at[0] + 6173.3 * at[1], 1);
    atomic_fetch_add(&lengths->asked, 1);
    return lengths->length / (1 + lengths->slope * at[0]) * exp2(-lengths->octaves * part);
}

static bool is_asked_enough(void *user)
{
    struct lengths *lengths = user;
    return atomic_load(&lengths->asked) >= lengths->most;
}

static void ignore_progress(void *user, double done, int64_t triangles) { (void)user, (void)done, (void)triangles; }

/* Lengths that need more triangles than a mesh can hold, by far or slightly, everywhere or at one side, are rejected
 * after few calls. */
static void test_lengths_that_are_too_small(void **state)
{
    (void)state;
    const struct tri_figure figure = plate();
    for (int i = 0; i < 12; i++) {
        const int way = i % 4;
        struct lengths lengths = {.length = i < 4 ? 1e-12 : i < 8 ? 1e-4 : 1, .slope = i < 8 ? 0 : 1e5};
        struct tri_settings settings = tri_no_settings();
        struct tri_mesh *mesh;
        settings.edge_length = length_asked;
        settings.edge_length_user = &lengths;
        settings.callbacks_in_parallel = way == 2;
        settings.progress = way == 3 ? ignore_progress : NULL;
        assert_int_equal(way % 3 == 0 ? tri_mesh_new(&mesh, &figure, &settings, NULL)
                                      : par_mesh_new(&mesh, &figure, &settings, NULL), TRI_TOO_LARGE);
        assert_null(mesh);
        assert_true(lengths.asked > 0 && lengths.asked < 100000);
    }
}

/* Lengths without a recognisable pattern are evaluated as often as the header says. A request to stop is obeyed
 * meanwhile. */
static void test_lengths_that_vary_wildly(void **state)
{
    (void)state;
    const struct tri_figure figure = plate();
    for (int i = 0; i < 4; i++) {
        struct lengths lengths = {.length = 1, .octaves = 30, .most = i < 2 ? 5000 : 1 << 25};
        struct tri_settings settings = tri_no_settings();
        struct tri_mesh *mesh;
        settings.edge_length = length_asked;
        settings.edge_length_user = &lengths;
        settings.progress = ignore_progress;
        settings.stop = is_asked_enough;
        settings.stop_user = &lengths;
        enum tri_status status = i % 2 ? tri_mesh_new(&mesh, &figure, &settings, NULL)
                                       : par_mesh_new(&mesh, &figure, &settings, NULL);
        assert_int_equal(status, i < 2 ? TRI_STOPPED : TRI_TOO_LARGE);
        assert_true(lengths.asked < lengths.most + 5000);
        tri_mesh_delete(mesh);
    }
}

/* The mesh is the same whether one thread or several evaluate the size. */
static void test_threads_do_not_change_a_mesh_with_sizes(void **state)
{
    (void)state;
    const struct tri_figure figure = plate();
    struct lengths lengths = {.length = 0.02};
    struct tri_settings settings = tri_no_settings();
    struct tri_mesh *mesh[2];
    settings.min_angle = 25;
    settings.edge_length = length_asked;
    settings.edge_length_user = &lengths;
    settings.threads = 2;
    for (int k = 0; k < 2; k++) {
        settings.callbacks_in_parallel = k;
        assert_int_equal(par_mesh_new(&mesh[k], &figure, &settings, NULL), TRI_OK);
    }
    assert_true(tri_mesh_triangles(mesh[0]).n > 80000 && same_meshes(mesh[0], mesh[1]));
    tri_mesh_delete(mesh[0]);
    tri_mesh_delete(mesh[1]);
}

/* There is no length beyond x = 2. The error names the place. */
static double length_to_two(void *user, const double at[2])
{
    (void)user;
    return at[0] < 2 ? 0.5 : -0.25;
}

static void keep_note(void *user, const char *notes) { snprintf(user, 600, "%s", notes); }

static void test_error_names_the_place_of_an_invalid_length(void **state)
{
    (void)state;
    char note[600] = "";
    struct tri_figure figure = plate();
    struct tri_settings settings = tri_no_settings();
    struct tri_mesh *mesh;
    settings.edge_length = length_to_two;
    settings.note = keep_note;
    settings.note_user = note;
    for (int way = 0; way < 3; way++) { /* sequential; parallel, callbacks on one thread or on all */
        double x = 0, y = 0, length = 0;
        settings.callbacks_in_parallel = way == 2;
        enum tri_status status = way == 0 ? tri_mesh_new(&mesh, &figure, &settings, NULL)
                                          : par_mesh_new(&mesh, &figure, &settings, NULL);
        assert_int_equal(status, TRI_OK);
        assert_int_equal(sscanf(tri_mesh_notes(mesh), "edge_length returned %lf at (%lf, %lf)", &length, &x, &y), 3);
        assert_true(length == -0.25 && x >= 2 && x <= 4 && y >= 0 && y <= 3);
        assert_string_equal(note, tri_mesh_notes(mesh));
        tri_mesh_delete(mesh);
    }
}

/* --- notes */

static enum tri_status take_no_triangles(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    (void)user, (void)error;
    assert_int_equal(tile->n_triangles, 0);
    return TRI_OK;
}

static void test_notes_of_an_empty_mesh(void **state)
{
    (void)state;
    static const int32_t open[] = {0, 1, 1, 2, 2, 3, 7, 99};
    static const char *const wanted[] = {"the mesh is empty: the outline is open at points 0 and 3",
                                         "the mesh is empty: segment 3 names point 99 of 10: numbers count from 0"
                                         " here; it is skipped"};
    struct tri_figure figure = plate();
    struct tri_settings settings = tri_no_settings();
    char note[600];
    figure.holes.n = figure.regions.n = 0;
    figure.segment_markers = tri_ints_of(NULL, 0, 1);
    settings.min_angle = 20;
    settings.note = keep_note;
    settings.note_user = note;
    for (int n = 3; n <= 4; n++) {
        figure.segments = tri_ints_of(open, n, 2);
        struct tri_mesh *mesh = mesh_of(&figure, &settings);
        assert_int_equal(tri_mesh_triangles(mesh).n, 0);
        assert_string_equal(tri_mesh_notes(mesh), wanted[n - 3]);
        assert_string_equal(note, wanted[n - 3]);
        assert_int_equal(tri_mesh_refine(mesh, &settings, NULL), TRI_OK); /* the mesh stays empty */
        assert_string_equal(tri_mesh_notes(mesh), wanted[n - 3]);
        tri_mesh_delete(mesh);
        const struct tri_sink sink = {.take = take_no_triangles};
        note[0] = 0;
        assert_int_equal(par_mesh_stream(&figure, &settings, 0, NULL, &sink, NULL), TRI_OK);
        assert_string_equal(note, wanted[n - 3]);
    }
}

static void test_notes_of_skipped_segments(void **state)
{
    (void)state;
    static const int32_t ends[] = {0, 1, 1, 2, 2, 3, 3, 0, 4, 4, -1, 2};
    struct tri_figure figure = plate();
    struct tri_mesh *mesh = mesh_of(&figure, NULL);
    assert_string_equal(tri_mesh_notes(mesh), "");
    tri_mesh_delete(mesh);
    figure.segment_markers = tri_ints_of(NULL, 0, 1);
    figure.segments = tri_ints_of(ends, 6, 2);
    figure.holes.n = 0;
    mesh = mesh_of(&figure, NULL);
    assert_true(tri_mesh_triangles(mesh).n > 0);
    assert_string_equal(tri_mesh_notes(mesh),
                        "segment 5 names point -1 of 10: numbers count from 0 here; 2 segments are skipped");
    tri_mesh_delete(mesh);
}

/* A bound above the largest supported angle is noted. */
static void test_note_of_a_lowered_angle(void **state)
{
    (void)state;
    struct tri_figure figure = plate();
    struct tri_settings settings = tri_no_settings();
    settings.min_angle = 38;
    struct tri_mesh *mesh = mesh_of(&figure, &settings);
    assert_string_equal(tri_mesh_notes(mesh), "");
    settings.min_angle = 40.5;
    assert_int_equal(tri_mesh_refine(mesh, &settings, NULL), TRI_OK);
    assert_string_equal(tri_mesh_notes(mesh),
                        "an angle bound of 40.5 degrees is above 38: triangles are made for 38");
    tri_mesh_delete(mesh);
}

static void test_too_large_leaves_no_mesh(void **state)
{
    (void)state;
    struct tri_figure figure = plate();
    struct tri_settings settings = fine();
    struct tri_mesh *mesh;
    settings.max_area = 1e-15;
    assert_int_equal(tri_mesh_new(&mesh, &figure, &settings, NULL), TRI_TOO_LARGE);
    assert_null(mesh);
    assert_int_equal(par_mesh_new(&mesh, &figure, &settings, NULL), TRI_TOO_LARGE);
    assert_null(mesh);
}

static void test_input_that_is_not_finite_is_refused(void **state)
{
    (void)state;
    const double odd[] = {NAN, INFINITY, -INFINITY};
    const struct tri_figure figure = plate();
    const struct tri_settings settings = fine();
    struct tri_mesh *mesh = mesh_of(&figure, &settings);
    struct tri_figure made = tri_no_figure();
    tri_mesh_figure(mesh, &made);
    for (int i = 0; i < 9; i++) {
        double xy[10][2], empty[2], region[2][4];
        double *const one[] = {&xy[1][0], &empty[1], &region[1][0]};
        struct tri_figure input = figure;
        struct tri_verdict verdict;
        struct tri_error error = {0};
        memcpy(xy, figure.points.at, sizeof xy);
        memcpy(empty, figure.holes.at, sizeof empty);
        memcpy(region, figure.regions.at, sizeof region);
        *one[i / 3] = odd[i % 3];
        input.points = tri_reals_of(xy[0], 10, 2);
        input.holes = tri_reals_of(empty, 1, 2);
        input.regions = tri_reals_of(region[0], 2, 4);
        assert_int_equal(tri_check_figure(&made, &input, NULL, &verdict, &error), TRI_BAD_INPUT);
        assert_non_null(strstr(error.text, "finite"));
    }
    tri_mesh_delete(mesh);
}

struct fence_test {
    bool open;     /* the gate accepts points with x < 1; false: none */
    int64_t asked; /* number of calls */
};

static bool is_left(void *user, const double at[2])
{
    struct fence_test *test = user;
    test->asked++;
    return test->open && at[0] < 1;
}

static void test_gate_and_fence(void **state)
{
    (void)state;
    const struct tri_figure figure = plate();
    struct fence_test test = {false, 0};
    struct tri_settings settings = fine();
    int64_t by_reason[TRI_REASONS], first[2];
    settings.gate = is_left;
    settings.gate_user = &test;
    struct tri_mesh *mesh = mesh_of(&figure, &settings);
    assert_int_equal(tri_mesh_points(mesh).n, 10);
    assert_true(test.asked > 0 && tri_mesh_count(mesh, TRI_COUNT_GATED) > 0);
    int64_t bad = tri_mesh_count_bad(mesh, &settings, by_reason, TRI_REASONS);
    assert_true(bad > 0 && by_reason[TRI_REASON_DEFERRED] == bad);
    assert_int_equal(tri_mesh_count_bad(mesh, &settings, first, 2), bad);
    assert_true(first[0] == 0 && first[1] == bad);
    test.open = true;
    assert_int_equal(tri_mesh_refine(mesh, &settings, NULL), TRI_OK);
    int64_t n = tri_mesh_points(mesh).n;
    assert_true(n > 12 && tri_mesh_count_bad(mesh, &settings, NULL, 0) > 0);
    const double nowhere[4] = {9, 9, 10, 10};
    settings.gate = NULL;
    settings.fence = nowhere;
    assert_int_equal(tri_mesh_refine(mesh, &settings, NULL), TRI_OK);
    assert_true(tri_mesh_points(mesh).n == n && tri_mesh_count(mesh, TRI_COUNT_FENCED) > 0);
    settings.fence = NULL;
    assert_int_equal(tri_mesh_refine(mesh, &settings, NULL), TRI_OK);
    assert_int_equal(tri_mesh_count_bad(mesh, &settings, NULL, 0), 0);
    assert_sound(mesh, &figure, 0.05);
    tri_mesh_delete(mesh);
}

/* Random points in a square; the caller frees points.at. */
static struct tri_figure scattered(int n)
{
    struct tri_figure figure = tri_no_figure();
    uint32_t bits = 7;
    double *at = malloc(2 * (size_t)n * sizeof *at);
    for (int i = 0; i < 2 * n; i++)
        at[i] = (bits = bits * 1664525 + 1013904223) / 4294967296.0; /* the generator of Numerical Recipes */
    figure.points = tri_reals_of(at, n, 2);
    return figure;
}

/* Bad triangles count as deferred if no refinement had these bounds. With the bounds of the last refinement they have
 * other reasons. */
static void test_bounds_of_no_refinement_are_deferred(void **state)
{
    (void)state;
    const struct tri_figure figure = scattered(500);
    struct tri_settings angle = tri_no_settings(), area = tri_no_settings();
    struct tri_mesh *mesh = mesh_of(&figure, NULL);
    int64_t by_reason[TRI_REASONS];
    angle.min_angle = 28;
    area.max_area = 1e-4;
    int64_t bad = tri_mesh_count_bad(mesh, &angle, by_reason, TRI_REASONS);
    assert_true(bad > 0 && by_reason[TRI_REASON_DEFERRED] == bad);
    assert_int_equal(tri_mesh_refine(mesh, &angle, NULL), TRI_OK);
    assert_int_equal(tri_mesh_count_bad(mesh, &angle, NULL, 0), 0);
    bad = tri_mesh_count_bad(mesh, &area, by_reason, TRI_REASONS);
    assert_true(bad > 0 && by_reason[TRI_REASON_DEFERRED] == bad);
    angle.min_angle = 32;
    bad = tri_mesh_count_bad(mesh, &angle, by_reason, TRI_REASONS);
    assert_true(bad > 0 && by_reason[TRI_REASON_DEFERRED] == bad);
    tri_mesh_delete(mesh);
    free((void *)figure.points.at);
}

static bool after_some(void *user) { return ++*(int *)user > 3; }

static void test_stop(void **state)
{
    (void)state;
    const struct tri_figure figure = plate();
    struct tri_settings settings = fine();
    struct tri_mesh *mesh = NULL;
    struct tri_error error;
    int asked = 0;
    settings.max_area = 1e-5;
    settings.stop = after_some;
    settings.stop_user = &asked;
    assert_int_equal(tri_mesh_new(&mesh, &figure, &settings, &error), TRI_STOPPED);
    assert_int_equal(error.status, TRI_STOPPED);
    if (!mesh) { /* before the first mesh was made */
        settings.stop = NULL;
        mesh = mesh_of(&figure, NULL);
        asked = 0;
        settings.stop = after_some;
        assert_int_equal(tri_mesh_refine(mesh, &settings, &error), TRI_STOPPED);
    }
    assert_true(tri_mesh_triangles(mesh).n > 0);
    settings = fine();
    assert_int_equal(tri_mesh_refine(mesh, &settings, NULL), TRI_OK);
    assert_sound(mesh, &figure, 0.05);
    tri_mesh_delete(mesh);
}

/* --- refusals */

struct told {
    double done;       /* last reported fraction */
    int64_t triangles; /* last reported number */
    int times;         /* number of reports */
};

static void record_progress(void *user, double done, int64_t triangles)
{
    struct told *told = user;
    assert_true(done >= told->done && done <= 1 && triangles > 0 && told->done < 1);
    *told = (struct told){done, triangles, told->times + 1};
}

/* By one sequential call and by the schedule: the fraction never decreases and ends with 1, and the mesh is the
 * same. */
static void test_progress(void **state)
{
    (void)state;
    struct tri_figure figure = plate();
    struct tri_settings settings = tri_no_settings();
    for (int parallel = 0; parallel < 2; parallel++) {
        struct told told = {0};
        struct tri_mesh *mesh, *silent;
        enum tri_status (*make)(struct tri_mesh **, const struct tri_figure *, const struct tri_settings *,
                                struct tri_error *) = parallel ? par_mesh_new : tri_mesh_new;
        settings.min_angle = 30;
        settings.max_area = 1e-4;
        settings.progress = NULL;
        assert_int_equal(make(&silent, &figure, &settings, NULL), TRI_OK);
        settings.progress = record_progress;
        settings.progress_user = &told;
        assert_int_equal(make(&mesh, &figure, &settings, NULL), TRI_OK);
        assert_true(told.done == 1 && told.times > 5 && told.triangles == tri_mesh_triangles(mesh).n);
        assert_true(same_meshes(mesh, silent));
        tri_mesh_delete(mesh);
        tri_mesh_delete(silent);
    }
}

/* The reported progress. */
struct heard {
    double done[10000], triangles[10000]; /* [n] reported fractions and numbers of triangles */
    int n;
};

static void note(void *user, double done, int64_t triangles)
{
    struct heard *heard = user;
    assert_true(heard->n < 10000);
    heard->done[heard->n] = done;
    heard->triangles[heard->n++] = (double)triangles;
}

/* Refinement of a mesh that was made without bounds: the number of triangles for angles is estimated as well as for a
 * new mesh. */
static void test_progress_of_angles(void **state)
{
    (void)state;
    static struct heard heard;
    const struct tri_figure figure = scattered(2000);
    struct tri_settings settings = tri_no_settings();
    struct tri_mesh *mesh = mesh_of(&figure, NULL);
    settings.min_angle = 30;
    settings.progress = note;
    settings.progress_user = &heard;
    const double first = (double)tri_mesh_triangles(mesh).n;
    assert_int_equal(tri_mesh_refine(mesh, &settings, NULL), TRI_OK);
    const double last = (double)tri_mesh_triangles(mesh).n;
    for (int i = 0; i < heard.n; i++)
        assert_true(fabs(heard.done[i] - (heard.triangles[i] - first) / (last - first)) < 0.3);
    assert_true(heard.n > 5);
    tri_mesh_delete(mesh);
    free((void *)figure.points.at);
}

static void assert_refused(const struct tri_figure *figure, const struct tri_settings *settings)
{
    struct tri_mesh *mesh = (struct tri_mesh *)&mesh;
    struct tri_error error = {0};
    assert_int_equal(tri_mesh_new(&mesh, figure, settings, &error), TRI_BAD_INPUT);
    assert_true(!mesh && error.status == TRI_BAD_INPUT && error.text[0]);
}

static void test_invalid_figures_are_refused(void **state)
{
    (void)state;
    struct tri_figure figures[10];
    for (int i = 0; i < 10; i++)
        figures[i] = plate();
    figures[0].points.width = 3;
    figures[1].points.n = -1;
    figures[2].points.at = NULL;
    figures[3].segments.stride = 1;
    figures[4].segment_markers.n = 10;
    figures[5].regions.width = figures[5].regions.stride = 3;
    figures[6].size = 0;
    figures[7].size = sizeof(size_t) - 1;
    figures[8].point_markers = tri_ints_of(markers, 9, 1);
    figures[9].points.n = 2;
    for (int i = 0; i < 10; i++)
        assert_refused(&figures[i], NULL);
    assert_refused(NULL, NULL);
}

static void test_invalid_settings_are_refused(void **state)
{
    (void)state;
    const struct tri_figure figure = plate();
    struct tri_settings settings[8];
    for (int i = 0; i < 8; i++)
        settings[i] = fine();
    settings[0].min_angle = NAN;
    settings[1].min_angle = -1;
    settings[2].max_area = NAN;
    settings[3].max_area = -1;
    settings[4].protect = 3;
    settings[5].size = 1;
    settings[6].placement = (enum tri_placement)3;
    settings[7].placement = (enum tri_placement)-1;
    for (int i = 0; i < 8; i++)
        assert_refused(&figure, &settings[i]);
}

/* Structs of an older header have fewer members. Those of a newer header have more, which must be 0. */
static void test_headers_of_other_versions(void **state)
{
    (void)state;
    struct {
        struct tri_settings settings;
        double later;
    } newer = {fine(), 0};
    const struct tri_figure figure = plate();
    struct tri_settings older = fine();
    older.size = offsetof(struct tri_settings, threads);
    older.threads = -77;
    newer.settings.size = sizeof newer;
    struct tri_mesh *a = mesh_of(&figure, &older), *b = mesh_of(&figure, &newer.settings);
    assert_true(same_meshes(a, b));
    struct tri_figure small = tri_no_figure();
    small.size = offsetof(struct tri_figure, segments);
    small.segments.n = 77;
    tri_mesh_figure(a, &small);
    assert_true(small.points.n == tri_mesh_points(a).n && small.segments.n == 77);
    newer.later = 1;
    assert_refused(&figure, &newer.settings);
    tri_mesh_delete(a);
    tri_mesh_delete(b);
}

/* --- files, threads, memory */

static void test_files(void **state)
{
    (void)state;
    const struct tri_figure figure = plate();
    const struct tri_settings settings = fine();
    struct tri_mesh *mesh = mesh_of(&figure, &settings);
    struct tri_figure made = tri_no_figure(), read = tri_no_figure();
    struct tri_error error;
    tri_mesh_figure(mesh, &made);
    assert_int_equal(tri_file_write("plate", &made, 1, NULL), TRI_OK);
    assert_int_equal(tri_file_read("plate.ele", &read, NULL), TRI_OK);
    assert_true(same_reals(read.points, made.points) && same_ints(read.triangles, made.triangles));
    assert_true(same_ints(read.segments, made.segments) && same_ints(read.segment_markers, made.segment_markers));
    assert_true(same_reals(read.triangle_attributes, made.triangle_attributes));
    tri_file_free(&read);
    tri_file_free(&read);
    assert_int_equal(tri_file_write("input", &figure, 0, NULL), TRI_OK);
    assert_int_equal(tri_file_read("input.poly", &read, NULL), TRI_OK);
    assert_true(same_reals(read.points, figure.points) && same_reals(read.regions, figure.regions));
    assert_true(same_reals(read.holes, figure.holes) && same_ints(read.segments, figure.segments));
    tri_file_free(&read);
    assert_int_equal(tri_file_read("nowhere.poly", &read, &error), TRI_CANNOT_READ);
    assert_int_equal(tri_file_read("input", &read, &error), TRI_CANNOT_READ);
    assert_int_equal(tri_file_write("nowhere/x", &figure, 0, &error), TRI_CANNOT_WRITE);
    assert_true(read.points.n == 0 && error.file[0]);
    assert_int_equal(tri_file_write("from_two", &figure, 2, &error), TRI_BAD_INPUT);
    assert_int_equal(tri_file_write("x.shp", &figure, 1, &error), TRI_BAD_INPUT);
    assert_non_null(strstr(error.text, "no format .shp: there are .node"));
    assert_int_equal(tri_file_read("x.shp.node", &read, NULL), TRI_CANNOT_READ);
    assert_int_equal(tri_file_read("from_two.poly", &read, NULL), TRI_CANNOT_READ);
    tri_mesh_delete(mesh);
}

static void test_threads(void **state)
{
    (void)state;
    const struct tri_figure figure = plate();
    struct tri_settings settings = fine();
    struct tri_mesh *first = NULL;
    settings.max_area = 1e-4;
    for (int threads = 1; threads < 4; threads++) {
        struct tri_mesh *mesh;
        settings.threads = threads;
        assert_int_equal(par_mesh_new(&mesh, &figure, &settings, NULL), TRI_OK);
        assert_sound(mesh, &figure, 1e-4);
        if (first) {
            assert_true(same_meshes(first, mesh));
            tri_mesh_delete(mesh);
        } else {
            first = mesh;
        }
    }
    settings.max_area = 5e-5;
    assert_int_equal(par_mesh_refine(first, &settings, NULL), TRI_OK);
    assert_sound(first, &figure, 5e-5);
    tri_mesh_delete(first);
}

struct taken {
    int64_t n_points, n_triangles; /* numbers handed out so far */
    const struct tri_mesh *mesh;   /* the mesh to compare with */
};

static enum tri_status begin_again(void *user, const struct tri_stream *stream, struct tri_error *error)
{
    struct taken *taken = user;
    (void)error;
    assert_int_equal(stream->n_attributes, 0);
    taken->n_points = taken->n_triangles = 0;
    return TRI_OK;
}

/* Checks that tiles contain the items of the mesh, in its order. */
static enum tri_status compare(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    struct taken *taken = user;
    const struct tri_reals at = tri_mesh_points(taken->mesh);
    const struct tri_ints corner = tri_mesh_triangles(taken->mesh);
    (void)error;
    assert_true(tile->first_vertex == taken->n_points && tile->first_triangle == taken->n_triangles);
    for (int32_t i = 0; i < tile->n_vertices; i++)
        assert_memory_equal(tile->points[i], at.at + (tile->first_vertex + i) * at.stride, sizeof tile->points[i]);
    for (int32_t i = 0; i < 3 * tile->n_triangles; i++)
        assert_true(tile->corners[i / 3][i % 3] ==
                    corner.at[(tile->first_triangle + i / 3) * corner.stride + i % 3]);
    taken->n_points += tile->n_vertices;
    taken->n_triangles += tile->n_triangles;
    return TRI_OK;
}

static void test_streams(void **state)
{
    (void)state;
    static const double angles[] = {0, 30, 33};
    static const int64_t memory[] = {0, 1000000};
    const struct tri_figure figure = plate();
    for (int i = 0; i < 6; i += every(5)) {
        struct tri_settings settings = fine();
        struct tri_mesh *mesh;
        settings.min_angle = angles[i / 2];
        settings.max_area = 1e-4;
        assert_int_equal(par_mesh_new(&mesh, &figure, &settings, NULL), TRI_OK);
        struct taken taken = {.mesh = mesh};
        const struct tri_sink sink = {&taken, begin_again, compare, NULL};
        assert_int_equal(par_mesh_stream(&figure, &settings, memory[i % 2], ".", &sink, NULL), TRI_OK);
        assert_true(taken.n_points == tri_mesh_points(mesh).n && taken.n_triangles == tri_mesh_triangles(mesh).n);
        tri_mesh_delete(mesh);
    }
    const struct tri_sink nobody = {0};
    assert_int_equal(par_mesh_stream(&figure, NULL, 0, NULL, &nobody, NULL), TRI_BAD_INPUT);
    assert_int_equal(par_mesh_stream(&figure, NULL, 0, NULL, NULL, NULL), TRI_BAD_INPUT);
}

static void test_every_allocation_may_fail(void **state)
{
    (void)state;
    double wide[10][3], linear[10] = {0}, region[4] = {ldexp(0.5, 250), ldexp(0.5, 250), 11, 0};
    struct tri_figure figure = plate(), made = tri_no_figure();
    struct tri_settings settings = fine();
    for (int i = 0; i < 20; i++)
        wide[i / 2][i % 2] = ldexp(points[i / 2][i % 2], 250);
    settings.max_area = ldexp(0.05, 500);
    figure.regions = tri_reals_of(region, 1, 4);
    figure.points = (struct tri_reals){wide[0], 10, 2, 3};
    figure.point_attributes = tri_reals_of(linear, 10, 1);
    enum tri_status status = TRI_NO_MEMORY;
    for (int64_t k = 1; status != TRI_OK; k++) {
        struct tri_mesh *mesh, *again = NULL;
        struct tri_ints list;
        int64_t before = support_held;
        assert_true(k < 10000);
        support_calls = 0;
        support_fail_at = k;
        support_fail_ever_after = true;
        status = tri_mesh_new(&mesh, &figure, &settings, NULL);
        status = status ? status : tri_mesh_neighbors(mesh, &list, NULL);
        status = status ? status : tri_mesh_edges(mesh, &list, NULL, NULL);
        if (!status) {
            tri_mesh_figure(mesh, &made);
            status = tri_mesh_new(&again, &made, NULL, NULL);
        }
        support_fail_at = INT64_MAX;
        assert_true(status == TRI_OK || status == TRI_NO_MEMORY);
        tri_mesh_delete(again);
        tri_mesh_delete(mesh);
        assert_int_equal(support_held, before);
    }
}

static void test_version(void **state)
{
    (void)state;
    assert_string_equal(tri_version(), PTRIANGLE_VERSION);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_mesh_satisfies_its_settings),
        cmocka_unit_test(test_neighbors_and_edges),
        cmocka_unit_test(test_points_without_segments),
        cmocka_unit_test(test_strides_and_attributes),
        cmocka_unit_test(test_a_mesh_as_figure),
        cmocka_unit_test(test_coordinates_of_any_magnitude),
        cmocka_unit_test(test_even_odd),
        cmocka_unit_test(test_placement),
        cmocka_unit_test(test_placement_in_a_given_mesh),
        cmocka_unit_test(test_edge_length),
        cmocka_unit_test(test_invalid_edge_lengths_are_refused),
        cmocka_unit_test(test_lengths_that_are_too_small),
        cmocka_unit_test(test_lengths_that_vary_wildly),
        cmocka_unit_test(test_threads_do_not_change_a_mesh_with_sizes),
        cmocka_unit_test(test_error_names_the_place_of_an_invalid_length),
        cmocka_unit_test(test_notes_of_an_empty_mesh),
        cmocka_unit_test(test_notes_of_skipped_segments),
        cmocka_unit_test(test_note_of_a_lowered_angle),
        cmocka_unit_test(test_too_large_leaves_no_mesh),
        cmocka_unit_test(test_input_that_is_not_finite_is_refused),
        cmocka_unit_test(test_gate_and_fence),
        cmocka_unit_test(test_stop),
        cmocka_unit_test(test_bounds_of_no_refinement_are_deferred),
        cmocka_unit_test(test_progress),
        cmocka_unit_test(test_progress_of_angles),
        cmocka_unit_test(test_invalid_figures_are_refused),
        cmocka_unit_test(test_invalid_settings_are_refused),
        cmocka_unit_test(test_headers_of_other_versions),
        cmocka_unit_test(test_files),
        cmocka_unit_test(test_threads),
        cmocka_unit_test(test_streams),
        cmocka_unit_test(test_every_allocation_may_fail),
        cmocka_unit_test(test_version),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
