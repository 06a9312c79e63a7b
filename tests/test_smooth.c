/* Smoothing (smooth.c), by one call and by blocks (smoothing.c): which vertices move, which stay, and which measures
   improve. */
#include "support.h"

#include "sched/schedule/schedule.h"
#include "triangle/base/hash.h"
#include "triangle/refine/refine.h"
#include "triangle/refine/smooth.h"
#include "trials.h"

static const double ANGLE = 25;

/* Mean of q = 4 sqrt(3) area / sum of squared edges. */
static double mean_quality(const struct tri_mesh *m)
{
    double sum = 0;
    for (tri_triangle_id t = 0; t < m->n_triangles; t++) {
        const struct tri_shape s = tri_shape_of(m->xy, m->tri[t].v);
        sum += 3.4641016151377544 * s.area2 / (s.l[0] + s.l[1] + s.l[2]);
    }
    return sum / m->n_triangles;
}

/* The sum of 1 / q over the triangles at vertex v, with v moved to p. */
static double sum_at(struct tri_mesh *m, tri_vertex_id v, struct tri_point p)
{
    const struct tri_point kept = m->xy[v];
    double sum = 0;
    m->xy[v] = p;
    for (tri_triangle_id t = 0; t < m->n_triangles; t++) {
        const tri_vertex_id *c = m->tri[t].v;
        if (c[0] != v && c[1] != v && c[2] != v)
            continue;
        const struct tri_shape s = tri_shape_of(m->xy, c);
        sum += s.area2 > 0 ? (s.l[0] + s.l[1] + s.l[2]) / (3.4641016151377544 * s.area2) : HUGE_VAL;
    }
    m->xy[v] = kept;
    return sum;
}

/* A square with one inner vertex, inserted by refinement. Up to a small tolerance, it moves to the best place of a fine
   grid. */
static void test_a_vertex_moves_to_the_best_place(void **state)
{
    (void)state;
    enum { GRID = 200 };
    for (int k = 0; k < 20; k++) {
        struct tri_pslg pslg = support_square(1, 1, (uint32_t)k + 1);
        for (int c = 8; c < 10; c++)
            pslg.points[c] = 0.3 + 0.4 * pslg.points[c]; /* all triangles are thick enough for a step to stay inside */
        struct tri_mesh mesh = support_generate(&pslg, &(struct tri_options){.quality = tri_quality_defaults()}, NULL);
        struct tri_quality quality = tri_quality_defaults();
        tri_vertex_id v = 4;
        assert_int_equal(mesh.n_vertices, 5);
        while (v > 0 && (mesh.xy[v].x <= 0 || mesh.xy[v].x >= 1 || mesh.xy[v].y <= 0 || mesh.xy[v].y >= 1))
            v--;
        mesh.on[v] = TRI_VERTEX_FREE;
        quality.passes = 40;
        assert_int_equal(tri_smooth_all(&mesh, &quality, NULL), TRI_OK);
        double least = HUGE_VAL;
        for (int i = 1; i < GRID; i++)
            for (int j = 1; j < GRID; j++)
                least = fmin(least, sum_at(&mesh, v, (struct tri_point){(double)i / GRID, (double)j / GRID}));
        assert_true(sum_at(&mesh, v, mesh.xy[v]) <= least + 1e-3);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

/* The mesh of a trial after the given number of passes with the given number of threads. The mesh is checked. */
static struct tri_mesh smoothed(const struct start *start, double block, int passes, int threads)
{
    struct tri_quality quality = start->options.quality;
    struct par_options options = {.threads = threads, .cell_triangles = block};
    struct par_report report;
    const struct tri_check_options check = {.min_angle = ANGLE, .max_bad = -1};
    struct tri_mesh mesh = trials_coarse_mesh(start);
    quality.passes = passes;
    assert_int_equal(par_refine(&mesh, &quality, &options, &report, NULL), TRI_OK);
    par_report_free(&report);
    support_judge(&mesh, &start->pslg, &check, false, NULL);
    return mesh;
}

static int64_t count_bad(const struct tri_mesh *mesh)
{
    const struct tri_bounds bounds = tri_bounds_for(ANGLE, false);
    int64_t n = 0;
    for (tri_triangle_id t = 0; t < mesh->n_triangles; t++) {
        const struct tri_shape s = tri_shape_of(mesh->xy, mesh->tri[t].v);
        n += s.area2 * s.area2 < bounds.sin2 * tri_longer_product(s.l[0], s.l[1], s.l[2]);
    }
    return n;
}

/* Checksum of vertices and segments on the boundary, independent of numbering. */
static uint64_t boundary_checksum(const struct tri_mesh *mesh)
{
    uint64_t sum = 0;
    for (tri_sub_id s = 0; s < mesh->n_subs; s++)
        for (int k = 0; k < 2; k++)
            sum += tri_hash(0, &mesh->xy[mesh->sub[s].v[k]], sizeof *mesh->xy);
    return sum;
}

/* The fraction of free vertices that have six triangles. */
static double share_of_six(const struct tri_mesh *mesh)
{
    int *degree = calloc((size_t)mesh->n_vertices, sizeof *degree), n = 0, six = 0;
    for (tri_triangle_id t = 0; t < mesh->n_triangles; t++)
        for (int k = 0; k < 3; k++)
            degree[mesh->tri[t].v[k]]++;
    for (tri_vertex_id v = 0; v < mesh->n_vertices; v++) {
        n += mesh->on[v] == TRI_VERTEX_FREE;
        six += mesh->on[v] == TRI_VERTEX_FREE && degree[v] == 6;
    }
    free(degree);
    return (double)six / n;
}

/* Triangles improve with each pass, none violates a bound that it met before, and segments do not move. With blocks,
   the mesh is the same for any number of threads. Later passes bring degrees closer to six. */
static void test_smoothing_improves_meshes(void **state)
{
    (void)state;
    const struct trial trials[] = {{"letter.poly", ANGLE, -100000, 60, false, false, 0},
                                   {"letter.poly", ANGLE, -3000, 1e9, false, false, 0},
                                   {"coast/norway_sea.poly", ANGLE, -60000, 400, false, false, 0}};
    for (size_t i = 0; i < sizeof trials / sizeof *trials; i++) {
        struct start start = trials_start_of(&trials[i]);
        struct tri_mesh before = smoothed(&start, trials[i].block, 0, 1);
        double quality = mean_quality(&before), six = 0;
        for (int passes = 1; passes <= 3; passes++) {
            struct tri_mesh one = smoothed(&start, trials[i].block, passes, 1);
            struct tri_mesh three = smoothed(&start, trials[i].block, passes, 3);
            print_message("  %s, %d passes: q %.4f, was %.4f\n", trials[i].file, passes, mean_quality(&one), quality);
            support_assert_same_bytes(&one, &three);
            assert_int_equal(one.n_vertices, before.n_vertices);
            assert_int_equal(one.n_triangles, before.n_triangles);
            if (passes == 1)
                six = share_of_six(&one);
            else
                assert_true(1 - share_of_six(&one) < 0.9 * (1 - six));
            assert_true(mean_quality(&one) > quality && count_bad(&one) <= count_bad(&before));
            assert_true(boundary_checksum(&one) == boundary_checksum(&before));
            quality = mean_quality(&one);
            tri_mesh_free(&one);
            tri_mesh_free(&three);
        }
        tri_mesh_free(&before);
        trials_free(&start);
    }
}

/* Bounds that depend on the positions of vertices. */
static void test_other_bounds_are_not_smoothed(void **state)
{
    (void)state;
    struct tri_quality quality = tri_quality_defaults();
    assert_false(tri_wants_smoothing(&quality));
    quality.passes = 1;
    assert_true(tri_wants_smoothing(&quality));
    quality.max_area = 1;
    assert_false(tri_wants_smoothing(&quality));
    quality = tri_quality_defaults();
    quality.passes = 1;
    quality.conforming = true;
    assert_false(tri_wants_smoothing(&quality));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_vertex_moves_to_the_best_place),
        cmocka_unit_test(test_smoothing_improves_meshes),
        cmocka_unit_test(test_other_bounds_are_not_smoothed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
