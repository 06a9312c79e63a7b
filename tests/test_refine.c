/* Refinement: bounds are met on every input, and options, gates and fences keep their guarantees. Every mesh is
   checked. */
#include "full.h"
#include "support.h"

#include <time.h>

enum { PROTECT_ALL = 2 };

static double total_area(const struct tri_mesh *mesh)
{
    double area2 = 0;
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        const int32_t *v = mesh->tri[t].v;
        area2 += tri_orient2d(mesh->xy[v[0]], mesh->xy[v[1]], mesh->xy[v[2]]);
    }
    return 0.5 * area2 * mesh->unit * mesh->unit;
}

static int64_t count_bad(const struct tri_mesh *mesh, const struct tri_options *options,
                         const struct tri_report *report)
{
    int64_t count[TRI_EXCUSES], sum = 0;
    tri_count_bad(mesh, &options->quality, &report->quality, NULL, count);
    for (int k = 0; k < TRI_EXCUSES; k++)
        sum += count[k];
    return sum;
}

/* Makes the mesh for the options and checks it. max_bad as in tri_check_options. */
static struct tri_mesh refine_and_judge(const struct tri_pslg *pslg, const struct tri_options *options, int64_t max_bad,
                                        struct tri_report *report)
{
    struct tri_mesh mesh = support_generate(pslg, options, report);
    struct tri_check_options check = {.max_bad = max_bad, .min_angle = options->quality.min_angle, .ignore_lost = true};
    check.max_area = options->quality.max_area;
    check.delaunay = options->quality.conforming ? TRI_CHECK_CONFORMING : TRI_CHECK_CONSTRAINED;
    support_judge(&mesh, pslg, &check, options->quality.region_areas, NULL);
    return mesh;
}

static const char *const valid[] = {"base0.poly",       "base1.poly",   "box_hole.poly",           "cracked_plate.poly",
                                    "gear.poly",        "letter.poly",  "koch_lake.poly",          "lexical.poly",
                                    "naca2412_box.poly", "square.poly", "perforated.poly",         "section.poly",
                                    "square_random1000.poly", "thin_channel.poly"};

enum { N_VALID = sizeof valid / sizeof *valid };

static struct tri_pslg load(const char *name)
{
    struct tri_pslg pslg;
    if (!support_read(name, &pslg))
        fail_msg("cannot read %s", name);
    return pslg;
}

/* No input angle is below 45 degrees, so no bad triangle is excused. */
static void test_angle_bounds_are_met(void **state)
{
    (void)state;
    static const double angles[] = {0, 20, 28, 30, 33};
    for (int i = 0; i < N_VALID; i++) {
        struct tri_pslg pslg = load(valid[i]);
        for (int k = 0; k < 5; k++) {
            struct tri_report report;
            struct tri_options options = support_quality(angles[k], 0);
            print_message("  %s %g\n", valid[i], angles[k]);
            struct tri_mesh mesh = refine_and_judge(&pslg, &options, 0, &report);
            assert_int_equal(count_bad(&mesh, &options, &report), 0);
            tri_mesh_free(&mesh);
        }
        tri_pslg_free(&pslg);
    }
}

static void test_area_bounds_are_met(void **state)
{
    (void)state;
    for (int i = 0; i < N_VALID; i++) {
        struct tri_pslg pslg = load(valid[i]);
        struct tri_options plain = support_quality(0, 0);
        struct tri_mesh coarse = support_generate(&pslg, &plain, NULL);
        double area = total_area(&coarse);
        tri_mesh_free(&coarse);
        for (int k = 0; k < 4; k++) {
            struct tri_report report;
            struct tri_options options = support_quality(k % 2 ? 30 : 0, area / (k < 2 ? 37 : 3000));
            struct tri_mesh mesh = refine_and_judge(&pslg, &options, 0, &report);
            assert_true(mesh.n_triangles >= (k < 2 ? 37 : 3000));
            assert_int_equal(count_bad(&mesh, &options, &report), 0);
            assert_true(fabs(total_area(&mesh) - area) <= 1e-9 * area);
            tri_mesh_free(&mesh);
        }
        tri_pslg_free(&pslg);
    }
}

/* Small angles, crossings, overlaps: every bad triangle is one that the checker excuses, or that is counted by
   reason. */
static void test_tangles_are_refined(void **state)
{
    (void)state;
    static const enum support_kind kinds[] = {SUPPORT_RANDOM, SUPPORT_LATTICE, SUPPORT_RING};
    for (int kind = 0; kind < 3; kind++)
        for (uint64_t seed = 0; seed < 16; seed += (uint64_t)every(3)) {
            struct tri_report report;
            struct tri_options options = support_quality(seed % 2 ? 20 : 33, seed % 4 ? 0 : 0.05);
            struct tri_pslg pslg = support_tangle(kinds[kind], 12, (int32_t)(seed % 8), seed);
            struct tri_mesh mesh = support_generate(&pslg, &options, &report);
            struct tri_check_options check = {.max_bad = count_bad(&mesh, &options, &report),
                                              .min_angle = options.quality.min_angle, .ignore_lost = true};
            check.max_area = options.quality.max_area;
            support_judge(&mesh, &pslg, &check, false, NULL);
            tri_mesh_free(&mesh);
            tri_pslg_free(&pslg);
        }
}

/* -Y and -YY protect segments. Sizes are still met, by points inside the domain. */
static void test_sizes_are_met_with_protected_segments(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        struct tri_pslg pslg = load("letter.poly");
        struct tri_options options = support_quality(i % 2 ? 30 : 0, 0.01);
        options.quality.protect = 1 + i / 2;
        struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
        struct tri_check_options check = {.max_area = 0.01, .min_angle = 0, .max_bad = -1};
        support_judge(&mesh, &pslg, &check, false, NULL);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

/* Points beside a wall that must not be split, so that the circumdisks of all their triangles extend beyond it. Each of
   1,000 triangles must be given up and counted, without searching all the others first. */
static void test_triangles_beside_a_protected_wall_are_given_up(void **state)
{
    (void)state;
    enum { N = 1000 };
    for (int protect = 1; protect <= PROTECT_ALL; protect++) {
        struct tri_report report;
        struct tri_pslg pslg = support_square(4e5, N, 3);
        for (int32_t i = 4; i < pslg.n_points; i++) {
            pslg.points[2 * i] = 4e5 * (i - 3) / (N + 1);
            pslg.points[2 * i + 1] = 1e-5 * (1 + i * i % 97 / 97.0);
        }
        struct tri_options options = support_quality(20, 0);
        options.quality.protect = protect;
        struct tri_mesh mesh = support_generate(&pslg, &options, &report);
        struct tri_check_options check = {.max_bad = mesh.n_triangles, .min_angle = 20};
        support_judge(&mesh, &pslg, &check, false, NULL);
        assert_true(report.quality.given_up[TRI_EXCUSE_PROTECTED] > N / 2);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

/* A protected wall must not keep all triangles in sight of it coarse. Giving them up takes no long search. */
static void test_triangles_in_sight_of_a_protected_wall_are_refined(void **state)
{
    (void)state;
    struct tri_report report;
    struct tri_pslg pslg = load("regress/walls_stay.poly");
    struct tri_options options = support_quality(30, 0);
    options.quality.protect = 1;
    struct tri_mesh mesh = support_generate(&pslg, &options, &report);
    struct tri_check_options check = {.max_bad = 60, .min_angle = 30};
    support_judge(&mesh, &pslg, &check, false, NULL);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

static void test_coasts_are_refined(void **state)
{
    (void)state;
    static const char *const coasts[] = {"coast/islands.poly", "coast/borders.poly", "coast/norway_sea.poly"};
    for (int i = 0; i < 3; i++) {
        struct tri_pslg pslg = load(coasts[i]);
        struct tri_report report;
        struct tri_options options = support_quality(i ? 25 : 33, 0);
        options.spread_regions = options.quality.region_areas = true;
        struct tri_mesh mesh = refine_and_judge(&pslg, &options, -1, &report);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

static void test_region_areas(void **state)
{
    (void)state;
    for (int angle = 0; angle <= 30; angle += 15) {
        struct tri_report report;
        struct tri_pslg pslg = load("section.poly");
        struct tri_options options = support_quality(angle, angle ? 5 : 0);
        assert_true(pslg.n_regions >= 9);
        options.spread_regions = options.quality.region_areas = true;
        struct tri_mesh mesh = refine_and_judge(&pslg, &options, 0, &report);
        bool seen[32] = {false};
        for (int32_t t = 0; t < mesh.n_triangles; t++)
            seen[mesh.tri[t].region] = true;
        for (int k = 1; k <= pslg.n_regions; k++)
            assert_true(seen[k]);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

struct wish {
    double x, y, finest;
    int asked;
};

/* Small near a point, and four times as large for each unit of distance. */
static int wants_smaller(void *user, const double a[2], const double b[2], const double c[2], double area)
{
    struct wish *wish = user;
    double x = (a[0] + b[0] + c[0]) / 3 - wish->x, y = (a[1] + b[1] + c[1]) / 3 - wish->y;
    double area2 = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    assert_true(fabs(0.5 * area2 - area) <= 1e-9 * area && area > 0);
    wish->asked++;
    return area > wish->finest * (1 + 100 * (x * x + y * y));
}

static void test_sizes_of_a_user_function_are_met(void **state)
{
    (void)state;
    struct wish wish = {0.3, 0.7, 1e-5, 0};
    struct tri_pslg pslg = load("square.poly");
    for (int angle = 0; angle <= 30; angle += 30) {
        struct tri_report report;
        struct tri_options options = support_quality(angle, 0.1);
        options.quality.unsuitable = wants_smaller;
        options.quality.unsuitable_user = &wish;
        struct tri_mesh mesh = refine_and_judge(&pslg, &options, 0, &report);
        for (int32_t t = 0; t < mesh.n_triangles; t++) {
            double at[3][2];
            for (int k = 0; k < 3; k++)
                tri_mesh_place(&mesh, mesh.tri[t].v[k], at[k]);
            double area =
                0.5 * ((at[1][0] - at[0][0]) * (at[2][1] - at[0][1]) - (at[1][1] - at[0][1]) * (at[2][0] - at[0][0]));
            assert_false(wants_smaller(&wish, at[0], at[1], at[2], area));
        }
        assert_in_range(mesh.n_triangles, 2000, 20000);
        tri_mesh_free(&mesh);
    }
    assert_true(wish.asked > 0);
    tri_pslg_free(&pslg);
}

static int is_boundary(const struct tri_subsegment *s) { return s->side[0] == TRI_NONE || s->side[1] == TRI_NONE; }

static void test_protected_subsegments_stay(void **state)
{
    (void)state;
    for (int i = 0; i < N_VALID; i++)
        for (int protect = 1; protect <= PROTECT_ALL; protect++) {
            struct tri_report report;
            struct tri_pslg pslg = load(valid[i]);
            struct tri_options options = support_quality(25, 0);
            struct tri_mesh coarse = support_generate(&pslg, &options, &report);
            double area = total_area(&coarse) / 400;
            tri_mesh_free(&coarse);
            options.quality.max_area = area;
            options.quality.protect = protect;
            struct tri_mesh mesh = support_generate(&pslg, &options, &report);
            struct tri_check_options check = {.max_bad = mesh.n_triangles, .min_angle = 25, .ignore_lost = true};
            check.max_area = area;
            support_judge(&mesh, &pslg, &check, false, NULL);
            for (int32_t s = 0; s < mesh.n_subs; s++) {
                const struct tri_parent *parent = &mesh.parents[mesh.sub[s].parent];
                const int32_t *v = mesh.sub[s].v; /* has the direction of the input segment */
                bool whole = (v[0] == parent->v[0] && v[1] == parent->v[1]) ||
                             (v[1] == parent->v[0] && v[0] == parent->v[1]);
                assert_true(whole || (protect == 1 && !is_boundary(&mesh.sub[s])));
            }
            assert_true(protect == 1 || report.quality.inserted_on_segments == 0);
            assert_true(mesh.n_vertices ==
                        pslg.n_points + report.quality.inserted_free + report.quality.inserted_on_segments);
            tri_mesh_free(&mesh);
            tri_pslg_free(&pslg);
        }
}

static void test_limit_on_points_is_exact(void **state)
{
    (void)state;
    static const int limits[] = {0, 1, 2, 3, 7, 50, 311};
    for (int conforming = 0; conforming < 2; conforming++)
        for (int i = 0; i < N_VALID; i += 3)
            for (int k = 0; k < 7; k++) {
                struct tri_report report, free_report;
                struct tri_pslg pslg = load(valid[i]);
                struct tri_options options = support_quality(30, 0);
                options.quality.conforming = conforming;
                struct tri_mesh mesh = support_generate(&pslg, &options, &free_report);
                int64_t need = mesh.n_vertices - pslg.n_points, want = limits[k] < need ? limits[k] : need;
                tri_mesh_free(&mesh);
                options.quality.max_steiner = limits[k];
                mesh = support_generate(&pslg, &options, &report);
                struct tri_check_options check = {.max_bad = mesh.n_triangles, .min_angle = 30, .ignore_lost = true};
                support_judge(&mesh, &pslg, &check, false, NULL);
                assert_int_equal(mesh.n_vertices - pslg.n_points, want);
                assert_int_equal(report.quality.inserted_free + report.quality.inserted_on_segments, want);
                assert_int_equal(report.quality.hit_limit, want < need);
                tri_mesh_free(&mesh);
                tri_pslg_free(&pslg);
            }
}

static void test_conforming_meshes_are_delaunay(void **state)
{
    (void)state;
    for (int i = 0; i < N_VALID; i++)
        for (int angle = 0; angle <= 30; angle += 30) {
            struct tri_report report;
            struct tri_pslg pslg = load(valid[i]);
            struct tri_options options = support_quality(angle, 0);
            options.quality.conforming = true;
            struct tri_mesh mesh = refine_and_judge(&pslg, &options, 0, &report);
            tri_mesh_free(&mesh);
            tri_pslg_free(&pslg);
        }
}

static void test_same_input_same_mesh(void **state)
{
    (void)state;
    for (int i = 0; i < N_VALID; i += 2) {
        struct tri_report report;
        struct tri_pslg pslg = load(valid[i]);
        struct tri_options options = support_quality(30, 0);
        struct tri_mesh first = support_generate(&pslg, &options, &report),
                        second = support_generate(&pslg, &options, &report);
        support_assert_same_bytes(&first, &second);
        tri_mesh_free(&first);
        tri_mesh_free(&second);
        tri_pslg_free(&pslg);
    }
}

/* A second call finds nothing to do. */
static void test_second_call_changes_nothing(void **state)
{
    (void)state;
    struct tri_report report;
    struct tri_refine_report again;
    struct tri_pslg pslg = load("letter.poly");
    struct tri_options options = support_quality(30, 0.05);
    struct tri_mesh mesh = support_generate(&pslg, &options, &report),
                    twin = support_generate(&pslg, &options, &report);
    assert_int_equal(tri_refine(&mesh, &options.quality, &again, NULL), TRI_OK);
    assert_int_equal(again.inserted_free + again.inserted_on_segments, 0);
    support_assert_same_bytes(&mesh, &twin);
    tri_mesh_free(&mesh);
    tri_mesh_free(&twin);
    tri_pslg_free(&pslg);
}

struct gate {
    double x_max;
    int64_t asked, refused;
};

static bool left_of(void *user, const double p[2])
{
    struct gate *gate = user;
    bool open = p[0] < gate->x_max;
    gate->asked++;
    gate->refused += !open;
    return open;
}

static struct tri_mesh coarse_square(struct tri_pslg *pslg)
{
    *pslg = support_square(8, 60, 3);
    struct tri_options options = support_quality(25, 0.5);
    return support_generate(pslg, &options, NULL);
}

static void test_a_closed_gate_prevents_every_point(void **state)
{
    (void)state;
    struct tri_pslg pslg, same;
    struct tri_mesh mesh = coarse_square(&pslg), twin = coarse_square(&same);
    struct gate gate = {-1, 0, 0};
    struct tri_refine_report report;
    struct tri_quality options = support_quality(33, 0.05).quality;
    struct tri_refine_hooks hooks = {0};
    hooks.gate = left_of;
    hooks.gate_user = &gate;
    assert_int_equal(tri_refine_with(&mesh, &options, &hooks, &report, NULL), TRI_OK);
    support_assert_same_bytes(&mesh, &twin);
    assert_true(gate.asked > 0 && gate.asked == gate.refused && report.gated == gate.refused);
    assert_int_equal(report.inserted_free + report.inserted_on_segments, 0);
    tri_mesh_free(&mesh);
    tri_mesh_free(&twin);
    tri_pslg_free(&pslg);
    tri_pslg_free(&same);
}

static void test_an_open_gate_changes_nothing(void **state)
{
    (void)state;
    struct tri_pslg pslg, same;
    struct tri_mesh mesh = coarse_square(&pslg), twin = coarse_square(&same);
    struct gate gate = {1e9, 0, 0};
    struct tri_refine_report report;
    struct tri_quality options = support_quality(33, 0.05).quality;
    struct tri_refine_hooks hooks = {0};
    assert_int_equal(tri_refine(&twin, &options, &report, NULL), TRI_OK);
    hooks.gate = left_of;
    hooks.gate_user = &gate;
    assert_int_equal(tri_refine_with(&mesh, &options, &hooks, &report, NULL), TRI_OK);
    support_assert_same_bytes(&mesh, &twin);
    assert_true(gate.asked > 0);
    tri_mesh_free(&mesh);
    tri_mesh_free(&twin);
    tri_pslg_free(&pslg);
    tri_pslg_free(&same);
}

/* A gate that is open on one side, then on the other, then everywhere. Points appear only where it is open, and no bad
   triangle remains. */
static void test_points_appear_only_where_the_gate_is_open(void **state)
{
    (void)state;
    struct tri_pslg pslg;
    struct tri_mesh mesh = coarse_square(&pslg);
    struct gate gate = {3, 0, 0};
    struct tri_refine_report report;
    struct tri_quality options = support_quality(30, 0.02).quality;
    struct tri_refine_hooks hooks = {0};
    int32_t before = mesh.n_vertices;
    hooks.gate = left_of;
    hooks.gate_user = &gate;
    assert_int_equal(tri_refine_with(&mesh, &options, &hooks, &report, NULL), TRI_OK);
    assert_true(report.gated > 0 && report.inserted_free > 100);
    for (int32_t v = before; v < mesh.n_vertices; v++)
        assert_true(mesh.on[v] != TRI_VERTEX_FREE || mesh.xy[v].x < 3);
    hooks.gate = NULL;
    assert_int_equal(tri_refine_with(&mesh, &options, &hooks, &report, NULL), TRI_OK);
    struct tri_check_options check = {.max_bad = 0, .min_angle = 30, .max_area = 0.02};
    support_judge(&mesh, &pslg, &check, false, NULL);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

static bool is_owned(const struct tri_fence *f, const double at[6])
{
    for (int k = 0; k < 3; k++)
        if (at[2 * k] < f->x_min || at[2 * k] >= f->x_max || at[2 * k + 1] < f->y_min || at[2 * k + 1] >= f->y_max)
            return false;
    return true;
}

static void refine_within(struct tri_mesh *mesh, const struct tri_fence *fence, double angle, double area)
{
    struct tri_refine_report report;
    struct tri_quality options = support_quality(angle, area).quality;
    struct tri_refine_hooks hooks = {0};
    hooks.fence = fence;
    assert_int_equal(tri_refine_with(mesh, &options, &hooks, &report, NULL), TRI_OK);
    assert_true(report.inserted_free > 50 && report.fenced > 0);
}

/* Each triangle with a corner outside the box exists before and after. */
static void test_fence_protects_the_outside(void **state)
{
    (void)state;
    static const struct tri_fence fences[] = {{1, 1, 5, 6}, {-1, -1, 4, 9}, {2.5, -1, 9, 3.25}};
    for (int f = 0; f < 3; f++) {
        struct tri_pslg pslg;
        struct tri_mesh mesh = coarse_square(&pslg);
        struct support_places before = support_places(&mesh);
        refine_within(&mesh, &fences[f], 30, 0.01);
        struct support_places after = support_places(&mesh);
        for (int32_t i = 0; i < before.n; i++)
            assert_true(is_owned(&fences[f], before.at[i]) || support_has_place(&after, before.at[i]));
        for (int32_t i = 0; i < after.n; i++)
            assert_true(is_owned(&fences[f], after.at[i]) || support_has_place(&before, after.at[i]));
        struct tri_check_options check = {.max_bad = mesh.n_triangles, .min_angle = 30};
        support_judge(&mesh, &pslg, &check, false, NULL);
        support_places_free(&before);
        support_places_free(&after);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

/* Disjoint boxes are independent: any order gives the same set of triangles. */
static void test_disjoint_fences_commute(void **state)
{
    (void)state;
    static const struct tri_fence fences[3] = {{-1, -1, 4, 9}, {4, -1, 9, 4}, {4, 4, 9, 9}};
    static const double angles[] = {20, 30, 33, 34, 36};
    static const int orders[3][3] = {{0, 1, 2}, {2, 1, 0}, {1, 0, 2}};
    for (int a = 0; a < 5; a++) {
        struct support_places first = {0};
        for (int o = 0; o < 3; o++) {
            struct tri_pslg pslg;
            struct tri_mesh mesh = coarse_square(&pslg);
            for (int k = 0; k < 3; k++)
                refine_within(&mesh, &fences[orders[o][k]], angles[a], orders[o][k] == 1 ? 0.002 : 0.01);
            assert_int_equal(tri_mesh_validate(&mesh, NULL), TRI_OK);
            struct support_places places = support_places(&mesh);
            if (o > 0 && !support_same_places(&first, &places))
                fail_msg("angle %g: order %d gives another mesh", angles[a], o);
            if (o > 0)
                support_places_free(&places);
            else
                first = places;
            tri_mesh_free(&mesh);
            tri_pslg_free(&pslg);
        }
        support_places_free(&first);
    }
}

static enum tri_status grant_room(void *user, struct tri_mesh *mesh, int32_t points, struct tri_error *error)
{
    int *left = user;
    assert_int_equal(points, 1);
    if (--*left < 0)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "the view is full");
    enum tri_status status = tri_mesh_reserve_vertices(mesh, 10, error);
    status = status ? status : tri_mesh_reserve_triangles(mesh, 20, error);
    return status ? status : tri_mesh_reserve_subs(mesh, 10, error);
}

static void test_a_failed_request_for_room_is_returned(void **state)
{
    (void)state;
    for (int grants = 0; grants <= 100; grants += 4) {
        struct tri_pslg pslg;
        struct tri_mesh mesh = coarse_square(&pslg);
        struct tri_error error = {0};
        struct tri_refine_report report;
        struct tri_quality options = support_quality(30, 0.02).quality;
        struct tri_refine_hooks hooks = {0};
        int left = grants;
        hooks.more_room = grant_room;
        hooks.more_room_user = &left;
        enum tri_status status = tri_refine_with(&mesh, &options, &hooks, &report, &error);
        assert_int_equal(status, left < 0 ? TRI_NO_MEMORY : TRI_OK);
        assert_true(status == TRI_OK || strcmp(error.text, "the view is full") == 0);
        assert_true(grants < 100 || status == TRI_OK);
        struct tri_check_options check = {.max_bad = mesh.n_triangles, .min_angle = 30};
        support_judge(&mesh, &pslg, &check, false, NULL); /* valid as far as it was refined */
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

static enum tri_status refuse_room(void *user, struct tri_mesh *mesh, int32_t points, struct tri_error *error)
{
    (void)user, (void)mesh, (void)points, (void)error;
    return TRI_NO_ROOM;
}

/* A refiner that pauses whenever there is no room makes the same mesh as one that never pauses. */
static void test_pauses_change_nothing(void **state)
{
    (void)state;
    for (int conforming = 0; conforming < 2; conforming++) {
        struct tri_pslg pslg, same;
        struct tri_mesh mesh = coarse_square(&pslg), twin = coarse_square(&same);
        struct tri_refine_report report, twin_report;
        struct tri_quality options = support_quality(31, 0.02).quality;
        struct tri_refine_hooks hooks = {0};
        struct tri_refiner *refiner;
        enum tri_status status;
        int pauses = 0;
        options.conforming = conforming;
        assert_int_equal(tri_refine(&twin, &options, &twin_report, NULL), TRI_OK);
        hooks.more_room = refuse_room;
        assert_int_equal(tri_refiner_new(&refiner, &mesh, &options, &hooks, &report, NULL), TRI_OK);
        while ((status = tri_refiner_run(refiner, NULL)) == TRI_NO_ROOM) {
            struct tri_error fault = {0};
            if (tri_mesh_validate(&mesh, &fault) != TRI_OK)
                fail_msg("%s", fault.text);
            mesh.vertex_capacity = mesh.n_vertices; /* the smallest possible steps */
            assert_int_equal(tri_mesh_reserve_vertices(&mesh, 1, NULL), TRI_OK);
            assert_int_equal(tri_mesh_reserve_triangles(&mesh, 2, NULL), TRI_OK);
            assert_int_equal(tri_mesh_reserve_subs(&mesh, 1, NULL), TRI_OK);
            pauses++;
        }
        tri_refiner_free(refiner);
        assert_int_equal(status, TRI_OK);
        assert_true(pauses > 3);
        support_assert_same_bytes(&mesh, &twin);
        assert_memory_equal(&report, &twin_report, sizeof report);
        tri_mesh_free(&mesh);
        tri_mesh_free(&twin);
        tri_pslg_free(&pslg);
        tri_pslg_free(&same);
    }
}

static void count_left(void *user, int32_t triangle)
{
    assert_true(triangle >= 0);
    ++*(int64_t *)user;
}

static void test_remaining_bad_triangles_are_reported(void **state)
{
    (void)state;
    static const struct tri_fence fence = {1, 1, 5, 6};
    struct tri_pslg pslg;
    struct tri_mesh mesh = coarse_square(&pslg);
    struct gate gate = {3, 0, 0};
    struct tri_refine_report report;
    struct tri_quality options = support_quality(30, 0.02).quality;
    struct tri_refine_hooks hooks = {0};
    int64_t left = 0;
    hooks.gate = left_of;
    hooks.gate_user = &gate;
    hooks.fence = &fence;
    hooks.deferred = count_left;
    hooks.deferred_user = &left;
    assert_int_equal(tri_refine_with(&mesh, &options, &hooks, &report, NULL), TRI_OK);
    assert_true(report.gated > 0 && report.fenced > 0);
    assert_int_equal(left, report.gated + report.fenced);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* All bad triangles are found in order, for any slices. Refining them leaves none. */
static void test_all_bad_triangles_are_found(void **state)
{
    (void)state;
    struct tri_pslg pslg;
    struct tri_mesh mesh = coarse_square(&pslg);
    struct tri_report report = {0};
    struct tri_options options = support_quality(30, 0.2);
    int32_t *found = calloc((size_t)mesh.n_triangles, sizeof *found);
    int32_t *piece = calloc((size_t)mesh.n_triangles, sizeof *piece);
    int32_t n = tri_find_work(&mesh, &options.quality, 0, mesh.n_triangles, found), sum = 0;
    assert_true(n > 10);
    assert_int_equal(n, count_bad(&mesh, &options, &report));
    for (int32_t first = 0, last; first < mesh.n_triangles; first = last) {
        last = first + 7 < mesh.n_triangles ? first + 7 : mesh.n_triangles;
        int32_t got = tri_find_work(&mesh, &options.quality, first, last, piece);
        assert_memory_equal(piece, found + sum, (size_t)got * sizeof *piece);
        sum += got;
    }
    assert_int_equal(sum, n);
    free(found);
    assert_int_equal(tri_refine(&mesh, &options.quality, &report.quality, NULL), TRI_OK);
    found = calloc((size_t)mesh.n_triangles, sizeof *found);
    assert_int_equal(tri_find_work(&mesh, &options.quality, 0, mesh.n_triangles, found), 0);
    free(found);
    free(piece);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* Only the neighbourhood of the worklist is changed. If it lists all bad triangles, none remains. */
static void test_only_the_neighbourhood_of_the_worklist_changes(void **state)
{
    (void)state;
    struct tri_pslg pslg;
    struct tri_mesh mesh = coarse_square(&pslg);
    struct tri_refine_report report;
    struct tri_quality options = support_quality(30, 0.02).quality;
    struct tri_refine_hooks hooks = {0};
    int32_t *listed = calloc((size_t)mesh.n_triangles, sizeof *listed), n = 0;
    hooks.worklist = listed;
    hooks.n_worklist = 0;
    assert_int_equal(tri_refine_with(&mesh, &options, &hooks, &report, NULL), TRI_OK);
    assert_int_equal(report.inserted_free + report.inserted_on_segments, 0);
    for (int32_t t = mesh.n_triangles - 1; t >= 0; t--)
        listed[n++] = t;
    hooks.n_worklist = n;
    assert_int_equal(tri_refine_with(&mesh, &options, &hooks, &report, NULL), TRI_OK);
    struct tri_check_options check = {.max_bad = 0, .min_angle = 30, .max_area = 0.02};
    support_judge(&mesh, &pslg, &check, false, NULL);
    free(listed);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

static double largest_circumradius(const struct tri_mesh *mesh)
{
    double largest2 = 0;
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        double l[3], product = 1;
        for (int k = 0; k < 3; k++) {
            struct tri_point a = mesh->xy[mesh->tri[t].v[tri_next[k]]], b = mesh->xy[mesh->tri[t].v[tri_prev[k]]];
            l[k] = (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y);
            product *= l[k];
        }
        const int32_t *v = mesh->tri[t].v;
        double area2 = tri_orient2d(mesh->xy[v[0]], mesh->xy[v[1]], mesh->xy[v[2]]);
        double r2 = product / (4 * area2 * area2);
        largest2 = r2 > largest2 ? r2 : largest2;
    }
    return sqrt(largest2);
}

static bool is_encroached(const struct tri_mesh *mesh)
{
    for (int32_t s = 0; s < mesh->n_subs; s++)
        for (int side = 0; side < 2; side++) {
            int32_t code = mesh->sub[s].side[side];
            if (code == TRI_NONE)
                continue;
            struct tri_point q = mesh->xy[mesh->tri[tri_of(code)].v[tri_edge(code)]];
            struct tri_point a = mesh->xy[mesh->sub[s].v[0]], b = mesh->xy[mesh->sub[s].v[1]];
            if ((a.x - q.x) * (b.x - q.x) + (a.y - q.y) * (b.y - q.y) < 0)
                return true;
        }
    return false;
}

/* Where no subsegment is encroached, all circumcentres lie inside, and no insertion increases the largest
   circumradius. */
static void test_largest_circumradius_never_grows(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 4; seed++) {
        struct tri_pslg pslg = support_square(1, 8 * (int32_t)seed, seed);
        struct tri_options options = support_quality(0, 0);
        struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
        double last = HUGE_VAL;
        int steps = 0;
        options.quality.conforming = true;
        options.quality.max_area = 0.002;
        options.quality.max_steiner = 1;
        for (struct tri_refine_report report = {.inserted_free = 1};
             report.inserted_free + report.inserted_on_segments > 0 && steps < 1500; steps++) {
            assert_int_equal(tri_refine(&mesh, &options.quality, &report, NULL), TRI_OK);
            if (is_encroached(&mesh))
                continue; /* in a chain of splits */
            double now = largest_circumradius(&mesh);
            assert_true(now <= last * (1 + 1e-9));
            last = now;
        }
        assert_true(steps > 300);
        assert_true(last < 0.1);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

/* For every readable input and any bound, refinement ends within seconds with a valid mesh. */
static void test_refinement_ends_on_every_input(void **state)
{
    (void)state;
    static const char *const folders[] = {"nasty", "regress"};
    static const double angles[] = {20, 33, 36, 60};
    for (int f = 0, tried = 0; f < 2; f++) {
        char **names = support_names(folders[f]);
        for (char **name = names; *name; name++) {
            struct tri_pslg pslg;
            if (tried++ % every(4) || !support_read(*name, &pslg))
                continue;
            for (int k = 0; k < 4; k++) {
                struct tri_report report;
                struct tri_options options = support_quality(angles[k], 0);
                options.use_segments = strstr(*name, ".poly");
                options.quality.conforming = k == 2;
                clock_t start = clock();
                struct tri_mesh mesh = support_generate(&pslg, &options, &report);
                double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
                print_message("  %s %g: %d triangles, %d input vertices, %lld bad, %.2f s\n", *name, angles[k],
                              (int)mesh.n_triangles, (int)pslg.n_points, (long long)count_bad(&mesh, &options, &report),
                              seconds);
                assert_true(seconds < 20);
                struct tri_check_options check = {
                    .max_bad = mesh.n_triangles, .min_angle = angles[k], .ignore_lost = true};
                support_judge(&mesh, &pslg, &check, false, NULL);
                tri_mesh_free(&mesh);
            }
            tri_pslg_free(&pslg);
        }
        support_free_names(names);
    }
}

/* Bounds that cannot be met are given up after a while, and the mesh contains no large number of slivers. */
static void test_refinement_ends_with_unreachable_bounds(void **state)
{
    (void)state;
    static const double angles[] = {36, 40, 50, 60};
    for (int k = 0; k < 4; k++) {
        struct tri_report report;
        struct tri_pslg pslg = load("letter.poly");
        struct tri_options options = support_quality(angles[k], 0);
        struct tri_mesh mesh = support_generate(&pslg, &options, &report);
        struct tri_check_options check = {.max_bad = 0, .min_angle = 10, .ignore_lost = true};
        support_judge(&mesh, &pslg, &check, false, NULL);
        assert_in_range(mesh.n_triangles, 57, 100000);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_angle_bounds_are_met),
        cmocka_unit_test(test_area_bounds_are_met),
        cmocka_unit_test(test_tangles_are_refined),
        cmocka_unit_test(test_sizes_are_met_with_protected_segments),
        cmocka_unit_test(test_triangles_beside_a_protected_wall_are_given_up),
        cmocka_unit_test(test_triangles_in_sight_of_a_protected_wall_are_refined),
        cmocka_unit_test(test_coasts_are_refined),
        cmocka_unit_test(test_region_areas),
        cmocka_unit_test(test_sizes_of_a_user_function_are_met),
        cmocka_unit_test(test_protected_subsegments_stay),
        cmocka_unit_test(test_limit_on_points_is_exact),
        cmocka_unit_test(test_conforming_meshes_are_delaunay),
        cmocka_unit_test(test_same_input_same_mesh),
        cmocka_unit_test(test_second_call_changes_nothing),
        cmocka_unit_test(test_a_closed_gate_prevents_every_point),
        cmocka_unit_test(test_an_open_gate_changes_nothing),
        cmocka_unit_test(test_points_appear_only_where_the_gate_is_open),
        cmocka_unit_test(test_fence_protects_the_outside),
        cmocka_unit_test(test_disjoint_fences_commute),
        cmocka_unit_test(test_a_failed_request_for_room_is_returned),
        cmocka_unit_test(test_pauses_change_nothing),
        cmocka_unit_test(test_remaining_bad_triangles_are_reported),
        cmocka_unit_test(test_all_bad_triangles_are_found),
        cmocka_unit_test(test_only_the_neighbourhood_of_the_worklist_changes),
        cmocka_unit_test(test_largest_circumradius_never_grows),
        cmocka_unit_test(test_refinement_ends_on_every_input),
        cmocka_unit_test(test_refinement_ends_with_unreachable_bounds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
