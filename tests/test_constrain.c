/* Segments against the naive definition of a constrained Delaunay triangulation, and against the input. */
#include "support.h"

static void test_tangles_are_naively_constrained_delaunay(void **state)
{
    (void)state;
    for (int kind = 0; kind < SUPPORT_KINDS; kind++)
        for (uint64_t seed = 0; seed < 30; seed++) {
            struct tri_constrain_report report;
            int32_t points = 3 + (int32_t)(seed % 20), segments = (int32_t)(seed % 12);
            struct tri_pslg pslg = support_tangle((enum support_kind)kind, points, segments, seed);
            struct tri_mesh mesh = support_constrained(&pslg, &report);
            support_assert_cdt(&mesh, true);
            support_judge_hull(&mesh, &pslg);
            tri_mesh_free(&mesh);
            tri_pslg_free(&pslg);
        }
}

static void test_large_tangles_pass_the_judge(void **state)
{
    (void)state;
    for (int kind = 0; kind < SUPPORT_KINDS; kind++) {
        struct tri_constrain_report report;
        struct tri_pslg pslg = support_tangle((enum support_kind)kind, 300, 100, 5);
        struct tri_mesh mesh = support_constrained(&pslg, &report);
        support_assert_cdt(&mesh, false);
        support_judge_hull(&mesh, &pslg);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

/* Without crossings, the result depends only on the set of segments. */
static void test_order_of_segments_does_not_matter(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 20; seed++) {
        struct tri_constrain_report report;
        struct support_random random = {seed};
        struct tri_pslg pslg = support_polygon(60, seed);
        struct tri_mesh mesh = support_constrained(&pslg, &report);
        struct support_set first = support_triangles(&mesh);
        assert_int_equal(report.crossings + report.bent + report.skipped, 0);
        tri_mesh_free(&mesh);
        for (int32_t i = 59; i > 0; i--) {
            int32_t k = support_below(&random, i + 1), from = pslg.segments[2 * i], to = pslg.segments[2 * i + 1];
            pslg.segments[2 * i] = pslg.segments[2 * k + 1]; /* also reversed */
            pslg.segments[2 * i + 1] = pslg.segments[2 * k];
            pslg.segments[2 * k] = from;
            pslg.segments[2 * k + 1] = to;
        }
        mesh = support_constrained(&pslg, &report);
        struct support_set second = support_triangles(&mesh);
        assert_true(support_same(&first, &second));
        support_set_free(&first);
        support_set_free(&second);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

/* n long parallels under a finely sampled curve, in the order of their heights, as in geological strata. Naive
 * insertion of each would cross all edges that the previous one has left on its far side. */
static void test_parallels_in_order_take_little_work(void **state)
{
    (void)state;
    enum { N = 1500 };
    struct tri_constrain_report report;
    struct tri_pslg pslg = support_pslg(3 * N, N, 0, 0);
    for (int i = 0; i < N; i++)
        support_add_point(&pslg, i / (double)N, 1 + 0.2 * sin(3.14159 * i / N));
    for (int i = 0; i < N; i++) {
        double y = (i + 1) / (N + 1.0), x = 1 + y * (1 - y);
        int32_t a = support_add_point(&pslg, -x, y);
        support_add_segment(&pslg, a, support_add_point(&pslg, 1 + x, y));
    }
    struct tri_mesh mesh = support_constrained(&pslg, &report);
    support_assert_cdt(&mesh, false);
    support_judge_hull(&mesh, &pslg);
    print_message("  %d parallels: %lld triangles looked at\n", (int)N, (long long)report.looked_at);
    assert_true(report.looked_at < 60 * INT64_C(3) * N);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

static int32_t count_subs(const struct tri_mesh *mesh, int32_t segment)
{
    int32_t n = 0;
    for (int32_t s = 0; s < mesh->n_subs; s++)
        n += mesh->parents[mesh->sub[s].parent].segment == segment;
    return n;
}

static void test_crossing_makes_a_vertex(void **state)
{
    (void)state;
    struct tri_constrain_report report;
    struct tri_pslg pslg = support_square(4, 0, 1);
    double attributes[4] = {1, 2, 3, 6};
    int32_t segments[12] = {0, 1, 1, 2, 2, 3, 3, 0, 0, 2, 1, 3}, markers[6] = {0, 0, 0, 0, 7, 8};
    pslg.n_attributes = 1;
    pslg.attributes = attributes;
    free(pslg.segments);
    pslg.segments = segments;
    pslg.segment_markers = markers;
    pslg.n_segments = 6;
    struct tri_mesh mesh = support_constrained(&pslg, &report);
    assert_int_equal(report.crossings, 1);
    assert_int_equal(mesh.n_vertices, 5);
    assert_int_equal(mesh.n_triangles, 4);
    assert_true(mesh.xy[4].x == 2 && mesh.xy[4].y == 2);
    assert_true(mesh.attributes[4] == 2);          /* along segment 0 - 2, which came first */
    assert_int_equal(mesh.vertex_markers[4], 7);
    assert_int_equal(mesh.on[4], TRI_VERTEX_INPUT);
    assert_int_equal(count_subs(&mesh, 4), 2);
    assert_int_equal(count_subs(&mesh, 5), 2);
    tri_mesh_free(&mesh);
    free(pslg.points);
    free(pslg.holes);
    free(pslg.regions);
}

static void test_vertices_on_a_segment_split_it(void **state)
{
    (void)state;
    struct tri_constrain_report report;
    struct tri_pslg pslg = support_pslg(20, 20, 0, 0);
    for (int i = 0; i < 7; i++)
        support_add_point(&pslg, 3 * i, i);
    support_add_point(&pslg, 0, 10);
    support_add_point(&pslg, 18, -10);
    support_add_segment(&pslg, 0, 6);
    struct tri_mesh mesh = support_constrained(&pslg, &report);
    assert_int_equal(report.crossings, 0);
    assert_int_equal(mesh.n_vertices, 9);
    assert_int_equal(count_subs(&mesh, 0), 6);
    support_judge_hull(&mesh, &pslg);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* If segments overlap, each piece is one subsegment, and the first non-zero marker wins. */
static void test_overlap_keeps_the_first_marker(void **state)
{
    (void)state;
    struct tri_constrain_report report;
    struct tri_pslg pslg = support_pslg(20, 20, 0, 0);
    int32_t markers[4] = {0, 5, 6, 0};
    for (int i = 0; i < 5; i++)
        support_add_point(&pslg, i, 0);
    support_add_point(&pslg, 2, 3);
    support_add_point(&pslg, 2, -3);
    support_add_segment(&pslg, 0, 3);
    support_add_segment(&pslg, 4, 1);
    support_add_segment(&pslg, 2, 4);
    support_add_segment(&pslg, 0, 4);
    pslg.segment_markers = markers;
    struct tri_mesh mesh = support_constrained(&pslg, &report);
    int32_t seen = 0;
    for (int32_t s = 0; s < mesh.n_subs; s++) {
        int32_t a = mesh.sub[s].v[0], b = mesh.sub[s].v[1], low = a < b ? a : b;
        if (a > 4 || b > 4)
            continue;
        assert_int_equal(abs(a - b), 1);
        assert_int_equal(mesh.sub[s].marker, low == 0 ? 0 : 5);
        seen |= 1 << low;
    }
    assert_int_equal(seen, 15);
    tri_mesh_free(&mesh);
    pslg.segment_markers = NULL;
    tri_pslg_free(&pslg);
}

static void test_meaningless_segments_are_skipped(void **state)
{
    (void)state;
    struct tri_constrain_report report;
    struct tri_pslg pslg = support_square(1, 3, 1);
    int32_t segments[14] = {0, 0, -1, 2, 3, 700, 0, 2, INT32_MIN, INT32_MAX, 0, 1, 1, 0};
    free(pslg.segments);
    pslg.segments = segments;
    pslg.n_segments = 7;
    struct tri_mesh mesh = support_constrained(&pslg, &report);
    assert_int_equal(report.skipped, 4);
    tri_mesh_free(&mesh);
    free(pslg.points);
    free(pslg.holes);
    free(pslg.regions);
}

/* Segments that name later copies of a point are moved to its first copy. */
static void test_segments_are_moved_to_the_lowest_copy(void **state)
{
    (void)state;
    struct tri_constrain_report report;
    struct tri_pslg pslg = support_pslg(20, 20, 0, 0);
    for (int copy = 0; copy < 3; copy++)
        for (int k = 0; k < 4; k++)
            support_add_point(&pslg, k == 1 || k == 2, k >= 2);
    support_add_segment(&pslg, 8, 6);
    support_add_segment(&pslg, 4, 8); /* both ends are equal after that */
    struct tri_mesh mesh = support_constrained(&pslg, &report);
    assert_int_equal(report.skipped, 1);
    assert_int_equal(count_subs(&mesh, 0), 1);
    for (int32_t s = 0; s < mesh.n_subs; s++)
        assert_true(mesh.sub[s].v[0] < 4 && mesh.sub[s].v[1] < 4);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* A fan of segments from one vertex, ordered by angle, with angles between them of about one ulp. */
static void test_many_spokes_and_long_gaps(void **state)
{
    (void)state;
    struct tri_constrain_report report;
    struct tri_pslg pslg = support_pslg(500, 500, 0, 0);
    support_add_point(&pslg, 0, 0);
    for (int i = 0; i < 200; i++)
        support_add_point(&pslg, 1000, i);
    for (int i = 0; i < 200; i++)
        support_add_point(&pslg, 1 + 4.9 * i, i % 2 ? 1.5 : -1.5); /* a zigzag gap around y = 0 */
    for (int i = 0; i < 200; i++)
        support_add_segment(&pslg, 0, 1 + i);
    struct tri_mesh mesh = support_constrained(&pslg, &report);
    support_assert_cdt(&mesh, false);
    support_judge_hull(&mesh, &pslg);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* Crossings that coordinates cannot separate from each other or from vertices: no endless loop, no lost segment, valid
 * links. */
static void test_crossings_below_resolution(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 60; seed++) {
        struct support_random random = {seed};
        struct tri_constrain_report report;
        struct tri_pslg pslg = support_pslg(100, 100, 0, 0);
        double offset = seed % 3 == 0 ? 0 : seed % 3 == 1 ? 1e6 : 0x1p44;
        for (int i = 0; i < 24; i++) {
            double x = support_unit(&random), y = 1e-9 * support_unit(&random);
            support_add_point(&pslg, offset + x, offset + (seed % 2 ? x + y : y));
        }
        for (int i = 0; i < 16; i++) {
            int32_t a = support_below(&random, 24), b = support_below(&random, 24);
            support_add_segment(&pslg, a, b);
        }
        struct tri_mesh mesh = support_constrained(&pslg, &report);
        for (int32_t t = 0; t < mesh.n_triangles; t++) {
            const int32_t *v = mesh.tri[t].v;
            assert_true(tri_orient2d(mesh.xy[v[0]], mesh.xy[v[1]], mesh.xy[v[2]]) > 0);
        }
        support_assert_cdt(&mesh, false);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

/* Inputs that broke earlier versions, each as points and then segments, with -1 at the end. */
static const struct {
    int32_t n_points;
    double points[12][2];
    int32_t segments[12];
} once_broken[] = {
    {5, {{2, -2}, {-2, 2}, {0.080822560905622898, 0.12424676827168687}, {0.41007450583208993, 0.22302235174962698},
         {0.018532072504777619, 0.1055596217514333}}, {2, 1, 3, 4, -1}},
    {5, {{2, -2}, {2, 2}, {0.66789838918469235, 0.30036951675540768}, {0.30642199449875906, 0.19192659834962772},
         {0.10943670572556674, 0.13283101171767003}}, {4, 2, 3, 0, -1}},
    {4, {{2, -2}, {0.55218035380493358, 0.26565410614148011}, {0.20188739828610669, 0.160566219485832},
         {0.85034868357247662, 0.35510460507174302}}, {2, 3, 1, 0, -1}},
    {4, {{-2, 2}, {0.080822560905622898, 0.12424676827168687}, {0.12958056095837189, 0.13887416828751156},
         {0.820600623277012, 0.3461801869831036}}, {2, 0, 3, 1, -1}},
    {8, {{4, 1}, {5, 1}, {5, 3}, {5, 0}, {5, 4}, {2, 4}, {1, 2}, {4, 1}}, {3, 5, 7, 2, 4, 0, 1, 6, -1}},
    {8, {{3, 1}, {4, 1}, {4, 4}, {3, 0}, {0, 0}, {5, 3}, {2, 0}, {2, 2}}, {6, 5, 4, 1, 7, 3, -1}},
    {7, {{43, 129}, {48, 144}, {26, 26}, {24, 134}, {31, 93}, {10, 30}, {4, 90}}, {2, 6, 5, 1, 3, 4, -1}},
    {6, {{1000000.431866538, 1000000.4318665389}, {1000000.3361478911, 1000000.3361478919},
         {1000000.2781062737, 1000000.2781062743}, {1000000.2726112449, 1000000.2726112459},
         {1000000.8105522027, 1000000.8105522029}, {1000000.8974924022, 1000000.8974924032}}, {0, 2, 4, 1, 5, 1, -1}},
    {11, {{1000000.5965786811, 1000000.5965786815}, {1000000.2745594719, 1000000.2745594726},
          {1000000.7922260674, 1000000.7922260676}, {1000000.652655847, 1000000.6526558471},
          {1000000.3442534442, 1000000.3442534443}, {1000000.1519995058, 1000000.1519995062},
          {1000000.5214544166, 1000000.5214544166}, {1000000.2423583759, 1000000.2423583762},
          {1000000.7360269239, 1000000.7360269246}, {1000000.6170406729, 1000000.617040673},
          {1000000.5610671287, 1000000.5610671291}}, {7, 2, 2, 4, 10, 3, 9, 10, 8, 6, -1}},
    {6, {{1000000.1817857648, 1000000.0000000006}, {1000000.6078538388, 1000000.0000000001},
         {1000000.6137097399, 1000000.0000000001}, {1000000.0026033765, 1000000.0000000002},
         {1000000.1617301517, 1000000.0000000005}, {1000000.9675408755, 1000000.0000000005}},
     {2, 4, 3, 5, 4, 2, 0, 1, -1}},
};

static void test_earlier_failures(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof once_broken / sizeof *once_broken; i++) {
        struct tri_constrain_report report;
        struct tri_pslg pslg = support_pslg(12, 12, 0, 0);
        for (int32_t k = 0; k < once_broken[i].n_points; k++)
            support_add_point(&pslg, once_broken[i].points[k][0], once_broken[i].points[k][1]);
        for (const int32_t *s = once_broken[i].segments; *s >= 0; s += 2)
            support_add_segment(&pslg, s[0], s[1]);
        print_message("  number %d\n", (int)i);
        struct tri_mesh mesh = support_constrained(&pslg, &report);
        support_assert_cdt(&mesh, true);
        support_judge_hull(&mesh, &pslg);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

/* --- features within rounding error of y = 0, where coordinates are finer than a resolution */

static const double ULP = 0x1p-52;

/* A segment from (1, 0) to (1.9, 0), and a point far above and far below. */
static struct tri_pslg lying_segment(void)
{
    struct tri_pslg pslg = support_pslg(60, 8, 0, 0);
    support_add_point(&pslg, 1, 0);
    support_add_point(&pslg, 1.9, 0);
    support_add_segment(&pslg, 0, 1);
    support_add_point(&pslg, 1.5, 1);
    support_add_point(&pslg, 1.5, -1);
    return pslg;
}

/* Returns true if an input segment runs through the vertex. */
static bool is_run_through(const struct tri_mesh *mesh, int32_t v)
{
    for (int32_t s = 0; s < mesh->n_subs; s++)
        if ((mesh->sub[s].v[0] == v || mesh->sub[s].v[1] == v) &&
            mesh->parents[mesh->sub[s].parent].segment != TRI_NONE)
            return true;
    return false;
}

/* Two vertices are on different sides of a segment, each within half a resolution. The nearer one is used, and the
 * other is then too far away, regardless of their order along the segment and of their sides. */
static void test_the_nearer_of_two_vertices_is_used(void **state)
{
    (void)state;
    for (int turn = 0; turn < 4; turn++) {
        struct tri_constrain_report report;
        struct tri_pslg pslg = lying_segment();
        double side = turn & 1 ? 1 : -1, before = turn & 2 ? 1.5 : 1.5625, behind = turn & 2 ? 1.5625 : 1.5;
        int32_t far = support_add_point(&pslg, before, 0.45 * side * before * ULP);
        int32_t near = support_add_point(&pslg, behind, -0.2 * side * behind * ULP);
        struct tri_mesh mesh = support_constrained(&pslg, &report);
        assert_int_equal(report.bent, 1);
        assert_true(is_run_through(&mesh, near) && !is_run_through(&mesh, far));
        support_judge_hull(&mesh, &pslg);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

/* Each vertex lies within half a resolution of the line from the previous vertex to the end. The chain follows them,
 * but stays within three resolutions (of the segment's larger end) of the segment. */
static void test_a_chain_does_not_drift(void **state)
{
    (void)state;
    enum { VERTICES = 40 };
    struct tri_constrain_report report;
    struct tri_pslg pslg = lying_segment();
    double x = 1, y = 0, height[VERTICES];
    for (int i = 0; i < VERTICES; i++) {
        double next = x + 0x1p-8;
        y = y * (1.9 - next) / (1.9 - x) + 0.45 * next * ULP;
        x = next;
        height[i] = y;
        support_add_point(&pslg, x, y);
    }
    assert_true(height[VERTICES - 1] > 1.5 * 3 * 1.9 * ULP);
    struct tri_mesh mesh = support_constrained(&pslg, &report);
    for (int i = 0; i < VERTICES; i++)
        assert_int_equal(is_run_through(&mesh, 4 + i), height[i] <= 3 * 1.9 * ULP);
    support_judge_hull(&mesh, &pslg);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* Two crossing segments share a vertex within two resolutions of their crossing, although it is on neither. They do not
 * share a vertex farther away. */
static void test_crossing_at_a_vertex_nearby(void **state)
{
    (void)state;
    for (int steps = 1; steps <= 3; steps++) {
        struct tri_constrain_report report;
        struct tri_pslg pslg = lying_segment();
        support_add_segment(&pslg, 2, 3);
        int32_t v = support_add_point(&pslg, 1.5 + steps * ULP, steps * ULP);
        struct tri_mesh mesh = support_constrained(&pslg, &report);
        bool shared = steps < 3; /* distances of 1.41, 2.83 and 4.24 ulps; a resolution is 1.5 ulps here */
        assert_int_equal(report.crossings, !shared);
        assert_int_equal(mesh.n_vertices, pslg.n_points + !shared);
        assert_int_equal(is_run_through(&mesh, v), shared);
        support_judge_hull(&mesh, &pslg);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

static void test_no_triangles_no_segments(void **state)
{
    (void)state;
    struct tri_constrain_report report;
    struct tri_pslg pslg = support_pslg(20, 20, 0, 0);
    for (int i = 0; i < 10; i++)
        support_add_point(&pslg, i, 2 * i);
    support_add_segment(&pslg, 0, 9);
    struct tri_mesh mesh = support_constrained(&pslg, &report);
    assert_int_equal(mesh.n_triangles, 0);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

static void test_all_segment_files(void **state)
{
    (void)state;
    static const char *const folders[] = {"", "nasty", "regress", "coast"};
    for (int f = 0; f < 4; f++) {
        char **names = support_names(folders[f]);
        for (char **name = names; *name; name++) {
            struct tri_pslg pslg;
            struct tri_constrain_report report;
            if (!support_read(*name, &pslg))
                continue;
            print_message("  %s\n", *name);
            struct tri_mesh mesh = support_constrained(&pslg, &report);
            support_assert_cdt(&mesh, false);
            support_judge_hull(&mesh, &pslg);
            tri_mesh_free(&mesh);
            tri_pslg_free(&pslg);
        }
        support_free_names(names);
    }
}

/* Segments of all lengths from one vertex along one line, some given twice. If they overlap, the first marker wins. */
static void test_overlaps_from_one_vertex(void **state)
{
    (void)state;
    enum { N = 40 };
    for (uint64_t seed = 0; seed < 20; seed++) {
        struct support_random random = {seed};
        struct tri_constrain_report report;
        struct tri_pslg pslg = support_pslg(N + 3, N, 0, 0);
        int32_t markers[N], expected[N] = {0};
        bool covered[N] = {false};
        for (int i = 0; i < N; i++)
            support_add_point(&pslg, 3 * i, i);
        support_add_point(&pslg, 0, N);
        support_add_point(&pslg, 3 * N, 0);
        for (int k = 0; k < N; k++) {
            int32_t end = 1 + support_below(&random, N - 1);
            support_add_segment(&pslg, k % 2 ? end : 0, k % 2 ? 0 : end);
            markers[k] = support_below(&random, 3) ? k + 1 : 0;
            for (int i = 0; i < end; i++) {
                covered[i] = true;
                expected[i] = expected[i] ? expected[i] : markers[k];
            }
        }
        pslg.segment_markers = markers;
        struct tri_mesh mesh = support_constrained(&pslg, &report);
        int32_t found = 0;
        for (int32_t s = 0; s < mesh.n_subs; s++) {
            int32_t a = mesh.sub[s].v[0], b = mesh.sub[s].v[1], low = a < b ? a : b;
            if (a >= N || b >= N || abs(a - b) != 1)
                continue;
            assert_true(covered[low]);
            assert_int_equal(mesh.sub[s].marker, expected[low]);
            found++;
        }
        for (int i = 0; i < N; i++)
            found -= covered[i];
        assert_int_equal(found, 0);
        support_assert_cdt(&mesh, true);
        pslg.segment_markers = NULL;
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tangles_are_naively_constrained_delaunay),
        cmocka_unit_test(test_large_tangles_pass_the_judge),
        cmocka_unit_test(test_order_of_segments_does_not_matter),
        cmocka_unit_test(test_parallels_in_order_take_little_work),
        cmocka_unit_test(test_crossing_makes_a_vertex),
        cmocka_unit_test(test_vertices_on_a_segment_split_it),
        cmocka_unit_test(test_overlap_keeps_the_first_marker),
        cmocka_unit_test(test_meaningless_segments_are_skipped),
        cmocka_unit_test(test_segments_are_moved_to_the_lowest_copy),
        cmocka_unit_test(test_many_spokes_and_long_gaps),
        cmocka_unit_test(test_crossings_below_resolution),
        cmocka_unit_test(test_earlier_failures),
        cmocka_unit_test(test_the_nearer_of_two_vertices_is_used),
        cmocka_unit_test(test_a_chain_does_not_drift),
        cmocka_unit_test(test_crossing_at_a_vertex_nearby),
        cmocka_unit_test(test_no_triangles_no_segments),
        cmocka_unit_test(test_all_segment_files),
        cmocka_unit_test(test_overlaps_from_one_vertex),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
