/* Edges made by an advancing front (front.c), compared with the given lengths, in one call and by the schedule. */
#include "support.h"

#include "sched/schedule/schedule.h"
#include "triangle/refine/refine.h"
#include "trials.h"

static const double ANGLE = 25;

/* The lengths of a mesh compared with the given ones. Each edge counts once for each of its sides. */
struct found {
    double quality; /* mean of 4 sqrt(3) area / sum of squared edges */
    double share;   /* share of edges that have 0.7 to 1.4 times the length at their middle */
    double over;    /* number of triangles over the integral of 1 / (sqrt(3) / 4 h^2) */
    double shortest, widest; /* shortest edge over h at its middle; largest circumradius over the mean h of the
                              * corners */
};

static struct found measure_mesh(const struct tri_mesh *m, const struct tri_lengths *lengths)
{
    struct found f = {.shortest = HUGE_VAL};
    double wanted = 0;
    for (tri_triangle_id t = 0; t < m->n_triangles; t++) {
        const tri_vertex_id *v = m->tri[t].v;
        const struct tri_shape s = tri_shape_of(m->xy, v);
        double mean = 0;
        for (int k = 0; k < 3; k++) {
            const struct tri_point a = m->xy[v[tri_next[k]]], b = m->xy[v[tri_prev[k]]];
            const double h = tri_lengths_at(lengths, tri_point_between(a, b, 0.5)), over = sqrt(s.l[k]) / h;
            f.share += over > 0.7 && over < 1.4;
            f.shortest = fmin(f.shortest, over);
            mean += tri_lengths_at(lengths, m->xy[v[k]]) / 3;
        }
        f.quality += 3.4641016151377544 * s.area2 / (s.l[0] + s.l[1] + s.l[2]);
        f.widest = fmax(f.widest, sqrt(s.l[0] * s.l[1] * s.l[2]) / (2 * s.area2) / mean);
        wanted += 0.5 * s.area2 / (TRI_EQUILATERAL * mean * mean);
    }
    f.quality /= m->n_triangles;
    f.share /= 3.0 * m->n_triangles;
    f.over = m->n_triangles / wanted;
    return f;
}

static struct tri_check_options kept(void) { return (struct tri_check_options){.min_angle = ANGLE, .max_bad = -1}; }

/* A square of side 1 with this field, refined by one call. way 0: classic placement, 1: with a front, 2: with a front
 * and the lattice. */
static struct tri_mesh square_of(const struct tri_size_field *field, int way, struct tri_lengths **lengths)
{
    struct tri_pslg pslg = support_square(1, 0, 1);
    struct tri_options options = support_quality(ANGLE, 0);
    options.refine = false;
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    const struct tri_sizes sizes = {.fields = field, .n = 1, .gradation = HUGE_VAL};
    assert_int_equal(tri_lengths_new(lengths, &sizes, &mesh, NULL, NULL), TRI_OK);
    options.quality.lengths = *lengths;
    options.quality.front = way > 0;
    options.quality.lattice = way > 1;
    struct tri_refine_report report;
    assert_int_equal(tri_refine(&mesh, &options.quality, &report, NULL), TRI_OK);
    const struct tri_check_options check = kept();
    support_judge(&mesh, &pslg, &check, false, NULL);
    tri_pslg_free(&pslg);
    return mesh;
}

static void test_edges_have_the_given_lengths(void **state)
{
    (void)state;
    for (int way = 0; way < 3; way++) {
        const struct tri_size_field field = {.kind = TRI_SIZE_NUMBER, .length = 0.017};
        struct tri_lengths *lengths;
        struct tri_mesh mesh = square_of(&field, way, &lengths);
        const struct found f = measure_mesh(&mesh, lengths);
        print_message("  way %d: %d triangles, q %.4f, %.4f of the edges, n/want %.3f, shortest %.3f, widest"
                      " %.3f\n", way,
                      (int)mesh.n_triangles, f.quality, f.share, f.over, f.shortest, f.widest);
        assert_true(f.widest <= 0.8 && f.shortest > 0.45);
        assert_true(f.quality > (way ? 0.985 : 0.85) && f.share > (way ? 0.98 : 0.9));
        assert_true(f.over > (way ? 0.98 : 0.9) && f.over < 1.03);
        tri_mesh_free(&mesh);
        tri_lengths_free(lengths);
    }
}

/* With h = 0.01 + 0.1 x the integral of dx / h is a logarithm. */
static void test_sides_are_divided_by_the_integral(void **state)
{
    (void)state;
    const double value[] = {0.01, 0.11, 0.01, 0.11};
    const struct tri_size_field field = {.kind = TRI_SIZE_RASTER, .values = {value, 2, 2, 2}, .step = {1, 1}};
    struct tri_lengths *lengths;
    struct tri_mesh mesh = square_of(&field, 1, &lengths);
    const double all = log(11) / 0.1, each = all / floor(all + 0.5);
    int parts = 0;
    for (tri_sub_id s = 0; s < mesh.n_subs; s++) {
        double a[2], b[2];
        tri_mesh_place(&mesh, mesh.sub[s].v[0], a);
        tri_mesh_place(&mesh, mesh.sub[s].v[1], b);
        if (a[1] != b[1])
            continue;
        parts++;
        assert_true(fabs(fabs(log((0.01 + 0.1 * a[0]) / (0.01 + 0.1 * b[0])) / 0.1) - each) < 0.03 * each);
    }
    assert_int_equal(parts, 2 * (int)floor(all + 0.5));
    const struct found f = measure_mesh(&mesh, lengths);
    print_message("  %d triangles, q %.4f, %.4f of the edges, n/want %.3f\n", (int)mesh.n_triangles, f.quality, f.share,
                  f.over);
    assert_true(f.quality > 0.955 && f.share > 0.97 && f.over < 1.05 && f.widest <= 0.8);
    tri_mesh_free(&mesh);
    tri_lengths_free(lengths);
}

/* Makes the mesh with 1 and with 3 threads, and checks it. */
static struct found measure_blocks(struct trial trial)
{
    struct start start = trials_start_of(&trial);
    struct tri_mesh mesh[2];
    for (int i = 0; i < 2; i++) {
        struct par_options options = {.threads = 1 + 2 * i, .cell_triangles = trial.block};
        struct par_report report;
        mesh[i] = trials_coarse_mesh(&start);
        assert_int_equal(par_refine(&mesh[i], &start.options.quality, &options, &report, NULL), TRI_OK);
        assert_true(report.rounds > 0);
        assert_int_equal(mesh[i].n_vertices, mesh[i].n_input + report.total.inserted_free +
                                                 report.total.inserted_on_segments);
        par_report_free(&report);
    }
    const struct found f = measure_mesh(&mesh[0], start.options.quality.lengths);
    print_message("  %d triangles, q %.4f, %.4f of the edges, n/want %.3f\n", (int)mesh[0].n_triangles, f.quality,
                  f.share, f.over);
    const struct tri_check_options check = kept();
    support_judge(&mesh[0], &start.pslg, &check, false, NULL);
    support_assert_same_bytes(&mesh[0], &mesh[1]);
    tri_mesh_free(&mesh[0]);
    tri_mesh_free(&mesh[1]);
    trials_free(&start);
    return f;
}

/* Except at seams, the mesh is as good as that of one call: coarse vertices have been removed, and no triangle of their
 * stars was forgotten. */
static void test_blocks_are_as_good_as_one_call(void **state)
{
    (void)state;
    const struct found letter = measure_blocks((struct trial){"letter.poly", 25, -100000, 60, false, false, 0});
    assert_true(letter.quality > 0.982 && letter.share > 0.98 && letter.over > 0.97 && letter.over < 1.03);
    const struct found coast =
        measure_blocks((struct trial){"coast/norway_sea.poly", 25, -60000, 400, false, false, 0});
    assert_true(coast.quality > 0.9);
}

/* A mesh refined again without lengths stores none. */
static void test_refining_without_lengths_removes_them(void **state)
{
    (void)state;
    const struct tri_size_field field = {.kind = TRI_SIZE_NUMBER, .length = 0.3};
    struct tri_lengths *lengths;
    struct tri_mesh mesh = square_of(&field, 1, &lengths);
    struct tri_quality quality = support_quality(ANGLE, 0.001).quality;
    struct tri_refine_report report;
    assert_true(mesh.length && mesh.has_lengths);
    const size_t bytes = tri_mesh_bytes_used(&mesh);
    tri_lengths_free(lengths);
    assert_int_equal(tri_ask_lengths(&mesh, NULL, NULL, NULL), TRI_OK);
    assert_int_equal(bytes - tri_mesh_bytes_used(&mesh), (size_t)mesh.n_vertices * sizeof(double));
    assert_int_equal(tri_refine(&mesh, &quality, &report, NULL), TRI_OK);
    assert_true(!mesh.length && !mesh.has_lengths);
    tri_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_edges_have_the_given_lengths),
        cmocka_unit_test(test_sides_are_divided_by_the_integral),
        cmocka_unit_test(test_blocks_are_as_good_as_one_call),
        cmocka_unit_test(test_refining_without_lengths_removes_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
