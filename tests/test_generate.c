/* From a PSLG to a mesh: stages, units, attributes, markers, rejected inputs, and every allocation that can fail.
 *
 * This program is linked with --wrap for malloc, calloc, realloc and free: see allocations.h. */
#include "allocations.h"
#include "full.h"
#include "support.h"

#ifdef SUPPORT_WRAP
static void assert_legal_failure(enum tri_status status, struct tri_mesh *mesh, const struct tri_error *error)
{
    assert_int_equal(status, TRI_NO_MEMORY);
    assert_int_equal(error->status, TRI_NO_MEMORY);
    assert_true(error->text[0] != 0);
    if (mesh->n_triangles > 0) { /* memory ran out during refinement: the mesh is valid but unfinished */
        struct tri_error fault = {0};
        if (tri_mesh_validate(mesh, &fault) != TRI_OK)
            fail_msg("%s", fault.text);
        support_assert_cdt(mesh, false);
    }
}

/* Fails the k-th allocation for k = 1, 2, ... (only this one, or all from this one on) until a run needs fewer. */
static void fail_each(const struct tri_pslg *pslg, const struct tri_options *options, bool ever_after, int64_t step)
{
    enum tri_status status = TRI_NO_MEMORY;
    int64_t k = 1;
    for (; status != TRI_OK; k += step) {
        struct tri_mesh mesh;
        struct tri_report report;
        struct tri_error error = {0};
        int64_t before = support_held;
        assert_true(k < 100000);
        support_calls = 0;
        support_fail_at = k;
        support_fail_ever_after = ever_after;
        status = tri_generate(&mesh, pslg, options, &report, &error);
        bool failed = support_calls >= support_fail_at;
        support_fail_at = INT64_MAX;
        assert_true(failed || status == TRI_OK);
        if (status != TRI_OK)
            assert_legal_failure(status, &mesh, &error);
        assert_true(!failed || status != TRI_OK || !ever_after);
        tri_mesh_free(&mesh);
        assert_int_equal(support_held, before); /* no leak */
        if (status == TRI_OK && failed)
            status = TRI_NO_MEMORY; /* that allocation was optional; continue */
    }
    assert_true(k > 10);
}

static struct tri_pslg with_attributes(struct tri_pslg pslg, int32_t n)
{
    pslg.n_attributes = n;
    pslg.attributes = calloc((size_t)pslg.n_points * (size_t)n, sizeof *pslg.attributes);
    for (int32_t i = 0; i < n * pslg.n_points; i++)
        pslg.attributes[i] = i;
    return pslg;
}

static void test_every_allocation_may_fail(void **state)
{
    (void)state;
    for (int ever_after = 0; ever_after < 2; ever_after++)
        for (uint64_t seed = 0; seed < 3; seed++) {
            struct tri_pslg pslg = with_attributes(support_tangle(SUPPORT_RANDOM, 60, 40, seed), 2);
            struct tri_options options = support_quality(25, 0.05);
            pslg.n_regions = pslg.n_holes = 1;
            options.spread_regions = options.quality.region_areas = true;
            options.quality.conforming = seed == 1;
            options.keep_hull = seed == 2;
            fail_each(&pslg, &options, ever_after, every(4));
            tri_pslg_free(&pslg);
        }
}

static void test_every_allocation_may_fail_on_points(void **state)
{
    (void)state;
    for (int kind = 0; kind < SUPPORT_KINDS; kind++) {
        struct tri_pslg pslg = support_points((enum support_kind)kind, 3000, 1);
        struct tri_options options = tri_defaults();
        fail_each(&pslg, &options, kind % 2, every(4));
        tri_pslg_free(&pslg);
    }
}

/* The mesh is large enough that the queue's stack and lists grow. */
static void test_allocation_fails_in_a_large_refinement(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_square(1, 4000, 1);
    struct tri_options options = support_quality(30, 1e-4);
    fail_each(&pslg, &options, true, 3);
    tri_pslg_free(&pslg);
}

static void test_nothing_leaks_on_success(void **state)
{
    (void)state;
    int64_t before = support_held;
    struct tri_pslg pslg = support_tangle(SUPPORT_LATTICE, 100, 60, 1);
    struct tri_options options = support_quality(30, 0);
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
    assert_int_equal(support_held, before);
}
#endif

/* Users rely on the left and right side of a segment. If segments overlap, the direction of the first counts. */
static void test_pieces_have_the_direction_of_their_segment(void **state)
{
    (void)state;
    int32_t pieces = 0;
    for (uint64_t seed = 0; seed < 20; seed++) {
        struct tri_pslg pslg = support_tangle(seed % 2 ? SUPPORT_RANDOM : SUPPORT_LATTICE, 40, 30, seed);
        struct tri_options options = support_quality(seed % 4 < 2 ? 25 : 0, 0);
        struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
        for (tri_sub_id s = 0; s < mesh.n_subs; s++) {
            const int32_t segment = mesh.parents[mesh.sub[s].parent].segment;
            if (segment == TRI_NONE)
                continue;
            const int32_t *ends = &pslg.segments[2 * segment];
            const struct tri_point a = mesh.xy[ends[0]], b = mesh.xy[ends[1]], p = mesh.xy[mesh.sub[s].v[0]],
                                   q = mesh.xy[mesh.sub[s].v[1]];
            assert_true((b.x - a.x) * (q.x - p.x) + (b.y - a.y) * (q.y - p.y) > 0);
            pieces++;
        }
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
    assert_true(pieces > 1000);
}

static void test_bad_input_is_refused(void **state)
{
    (void)state;
    static const double odd[] = {NAN, INFINITY, -INFINITY};
    struct tri_options options = tri_defaults();
    struct tri_report report;
    struct tri_mesh mesh;
    for (int i = 0; i < 24; i++) {
        struct tri_error error = {0};
        struct tri_pslg pslg = support_square(1, 0, 1);
        pslg.points[i % 8] = odd[i / 8];
        assert_int_equal(tri_generate(&mesh, &pslg, &options, &report, &error), TRI_BAD_INPUT);
        assert_true(error.text[0] && error.status == TRI_BAD_INPUT);
        assert_true(mesh.n_triangles == 0 && !mesh.tri && !mesh.xy);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
    for (int n = 0; n < 3; n++) {
        struct tri_pslg pslg = support_square(1, 0, 1);
        pslg.n_points = n;
        assert_int_equal(tri_generate(&mesh, &pslg, &options, &report, NULL), TRI_BAD_INPUT);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

/* A linear function stays linear at all new vertices, including crossings. */
static void test_attributes_are_interpolated(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 10; seed++) {
        struct tri_pslg pslg = support_tangle(SUPPORT_RANDOM, 20, 12, seed);
        struct tri_options options = support_quality(20, 0.05);
        pslg.n_attributes = 2;
        pslg.attributes = calloc(2 * (size_t)pslg.n_points, sizeof *pslg.attributes);
        for (int32_t v = 0; v < pslg.n_points; v++) {
            pslg.attributes[2 * v] = 3 * pslg.points[2 * v] - 5 * pslg.points[2 * v + 1] + 1;
            pslg.attributes[2 * v + 1] = 7;
        }
        struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
        assert_true(mesh.n_vertices > pslg.n_points + 50);
        for (int32_t v = 0; v < mesh.n_vertices; v++) {
            assert_true(fabs(mesh.attributes[2 * v] - (3 * mesh.xy[v].x - 5 * mesh.xy[v].y + 1)) < 1e-8);
            assert_true(fabs(mesh.attributes[2 * v + 1] - 7) < 1e-8);
        }
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

/* New vertices on a segment get its marker. On the boundary they get 1 if it has none, and inside they get 0. */
static void test_markers_of_new_vertices(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_square(1, 0, 1);
    int32_t markers[4] = {5, 0, 7, 0};
    struct tri_options options = support_quality(30, 0.005);
    pslg.segment_markers = markers;
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    int seen[4] = {0};
    for (int32_t v = 4; v < mesh.n_vertices; v++) {
        struct tri_point q = mesh.xy[v];
        int side = q.y == 0 ? 0 : q.x == 1 ? 1 : q.y == 1 ? 2 : q.x == 0 ? 3 : 4;
        assert_int_equal(mesh.vertex_markers[v], side == 4 ? 0 : markers[side] ? markers[side] : 1);
        assert_int_equal(mesh.on[v] >= 0, side < 4);
        seen[side & 3] += side < 4;
    }
    for (int k = 0; k < 4; k++)
        assert_true(seen[k] > 3);
    for (int32_t s = 0; s < mesh.n_subs; s++)
        assert_in_set(mesh.sub[s].marker, ((LargestIntegralType[]){1, 5, 7}), 3);
    tri_mesh_free(&mesh);
    pslg.segment_markers = NULL;
    tri_pslg_free(&pslg);
}

static void scale(struct tri_pslg *pslg, double by)
{
    for (int32_t i = 0; i < 2 * pslg->n_points; i++)
        pslg->points[i] *= by;
    for (int32_t i = 0; i < 2 * pslg->n_holes; i++)
        pslg->holes[i] *= by;
    for (int32_t k = 0; k < pslg->n_regions; k++) {
        pslg->regions[4 * k] *= by;
        pslg->regions[4 * k + 1] *= by;
        pslg->regions[4 * k + 3] *= by * by;
    }
}

/* Scaling by a power of two scales the mesh, within the range of doubles: the same triangles, and vertices multiplied
 * by the factor. */
static void test_scaling_scales_the_mesh(void **state)
{
    (void)state;
    static const int exponents[] = {-50, -1, 3, 40, -450, 450, -95, 190};
    for (size_t i = 0; i < sizeof exponents / sizeof *exponents; i++) {
        struct tri_pslg plain, scaled;
        assert_true(support_read("box_hole.poly", &plain) && support_read("box_hole.poly", &scaled));
        double by = ldexp(1, exponents[i]);
        scale(&scaled, by);
        struct tri_options options = support_quality(28, 0.1);
        struct tri_mesh first = support_generate(&plain, &options, NULL);
        options.quality.max_area *= by * by;
        struct tri_mesh second = support_generate(&scaled, &options, NULL);
        struct support_set a = support_triangles(&first), b = support_triangles(&second);
        assert_true(support_same(&a, &b));
        assert_int_equal(first.n_vertices, second.n_vertices);
        for (int32_t v = 0; v < first.n_vertices; v++) {
            double at[2];
            tri_mesh_place(&second, v, at);
            assert_true(at[0] == first.xy[v].x * by && at[1] == first.xy[v].y * by);
        }
        support_set_free(&a);
        support_set_free(&b);
        tri_mesh_free(&first);
        tri_mesh_free(&second);
        tri_pslg_free(&plain);
        tri_pslg_free(&scaled);
    }
}

static bool in_caller_units(void *user, const double p[2])
{
    *(bool *)user |= fabs(p[0]) > 1e299;
    return true;
}

static double any_length(void *user, const double at[2])
{
    in_caller_units(user, at);
    return HUGE_VAL;
}

/* Gates and size functions get the caller's coordinates, regardless of the internal unit. */
static void test_gate_gets_callers_coordinates(void **state)
{
    (void)state;
    bool seen = false, passed = false;
    const struct tri_refine_hooks hooks = {.gate = in_caller_units, .gate_user = &passed};
    struct tri_refine_report report;
    struct tri_pslg pslg = support_square(1e300, 0, 1);
    struct tri_options options = support_quality(30, 0);
    options.quality.edge_length = any_length;
    options.quality.edge_length_user = &seen;
    support_add_segment(&pslg, 0, 2);
    pslg.points[5] = 1e298; /* a flat corner */
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    options.quality.min_angle = 33;
    assert_int_equal(tri_refine_with(&mesh, &options.quality, &hooks, &report, NULL), TRI_OK);
    assert_true(mesh.unit > 1 && mesh.unit < INFINITY && seen && passed);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

static void note_stage(void *user, enum tri_stage begins)
{
    int *last = user;
    assert_int_equal(*last + 1 + (begins == TRI_STAGE_QUALITY), (int)begins); /* no stage is repeated */
    *last = (int)begins;
}

static void test_stages_come_in_order(void **state)
{
    (void)state;
    int last = -1;
    struct tri_pslg pslg = support_square(1, 5, 1);
    struct tri_options options = support_quality(20, 0);
    options.stage = note_stage;
    options.stage_user = &last;
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    assert_int_equal(last, TRI_STAGE_DONE);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

static void test_report_counts(void **state)
{
    (void)state;
    struct tri_report report;
    struct tri_pslg pslg = support_points(SUPPORT_LATTICE, 200, 1);
    struct tri_options options = tri_defaults();
    struct tri_mesh mesh = support_generate(&pslg, &options, &report);
    int32_t places = 0;
    for (int32_t v = 0; v < 200; v++) {
        int32_t u = 0;
        while (mesh.xy[u].x != mesh.xy[v].x || mesh.xy[u].y != mesh.xy[v].y)
            u++;
        places += u == v;
    }
    assert_int_equal(report.duplicates, 200 - places);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* The first vertices of a mesh are those of the caller, bit for bit, in the caller's order. */
static void test_input_vertices_stay(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_tangle(SUPPORT_RANDOM, 50, 30, 3);
    struct tri_options options = support_quality(30, 0);
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    assert_int_equal(mesh.n_input, pslg.n_points);
    assert_memory_equal(mesh.xy, pslg.points, (size_t)pslg.n_points * sizeof *mesh.xy);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* If everything is carved, or the input is empty, the result is an empty mesh. */
static void test_empty_meshes(void **state)
{
    (void)state;
    static const char *const names[] = {"nasty/hole_eats_all.poly", "nasty/open_boundary.poly", "nasty/collinear.poly"};
    for (int i = 0; i < 3; i++) {
        struct tri_pslg pslg;
        struct tri_options options = support_quality(20, 0.1);
        assert_true(support_read(names[i], &pslg));
        struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
        assert_int_equal(mesh.n_triangles, 0);
        assert_true(mesh.n_vertices >= pslg.n_points);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#ifdef SUPPORT_WRAP
        cmocka_unit_test(test_every_allocation_may_fail),
        cmocka_unit_test(test_every_allocation_may_fail_on_points),
        cmocka_unit_test(test_allocation_fails_in_a_large_refinement),
        cmocka_unit_test(test_nothing_leaks_on_success),
#endif
        cmocka_unit_test(test_pieces_have_the_direction_of_their_segment),
        cmocka_unit_test(test_bad_input_is_refused),
        cmocka_unit_test(test_attributes_are_interpolated),
        cmocka_unit_test(test_markers_of_new_vertices),
        cmocka_unit_test(test_scaling_scales_the_mesh),
        cmocka_unit_test(test_gate_gets_callers_coordinates),
        cmocka_unit_test(test_stages_come_in_order),
        cmocka_unit_test(test_report_counts),
        cmocka_unit_test(test_input_vertices_stay),
        cmocka_unit_test(test_empty_meshes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
