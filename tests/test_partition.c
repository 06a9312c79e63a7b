/* Blocks: fences are compared with a search over all blocks, and shares of work with the refined mesh. */
#include "support.h"

#include "sched/schedule/partition.h"
#include "triangle/size/estimate.h"
#include "triangle/refine/place.h"

/* Inputs and bounds of many kinds, including degenerate ones. */
struct trial {
    const char *file; /* name of the input file; NULL: random points */
    enum support_kind kind;
    int32_t points;
    double angle, max_area, block;
};

static const struct trial trials[] = {
    {NULL, SUPPORT_RANDOM, 300, 20, 1e-5, 2000},
    {NULL, SUPPORT_RANDOM, 3000, 20, 0, 300},
    {NULL, SUPPORT_LATTICE, 60, 20, 1e-4, 1000},
    {NULL, SUPPORT_RING, 200, 30, 0.05, 1000},
    {NULL, SUPPORT_LINE, 100, 30, 0.05, 700},
    {NULL, SUPPORT_NEAR_LINE, 300, 20, 0, 10},
    {NULL, SUPPORT_CLUSTER, 5000, 20, 0, 100}, /* most of the work lies in a tiny area */
    {NULL, SUPPORT_CLUSTER, 200, 20, 1e-6, 3000},
    {"letter.poly", 0, 0, 30, 0.001, 1000},
    {"section.poly", 0, 0, 20, 0, 50},
    {"koch_lake.poly", 0, 0, 30, 0, 500},
    {"coast/borders.poly", 0, 0, 25, 0, 1000},
    {"coast/islands.poly", 0, 0, 20, 1e7, 300},
    {"nasty/aspect_1e8.poly", 0, 0, 20, 1000, 1000},
    {"nasty/collinear.poly", 0, 0, 20, 0.1, 100}, /* no triangles */
    {"nasty/hole_eats_all.poly", 0, 0, 20, 0.001, 100},
};

enum { N_TRIALS = sizeof trials / sizeof *trials };

static struct tri_mesh start_of(const struct trial *trial, struct tri_options *options)
{
    struct tri_pslg pslg;
    *options = support_quality(trial->angle, trial->max_area);
    if (!trial->file)
        pslg = support_points(trial->kind, trial->points, 3);
    else if (!support_read(trial->file, &pslg))
        fail_msg("cannot read %s", trial->file);
    options->use_segments = trial->file;
    options->refine = false;
    struct tri_mesh mesh = support_generate(&pslg, options, NULL);
    tri_pslg_free(&pslg);
    return mesh;
}

static struct par_partition cut(const struct tri_mesh *mesh, const struct tri_quality *quality, double cell)
{
    struct par_partition partition;
    struct tri_error error;
    assert_int_equal(par_partition_make(&partition, mesh, quality,
                                        support_estimate(mesh, quality), cell, NULL, &error), TRI_OK);
    return partition;
}

static const double *rows_of(const struct par_partition *p, int32_t column)
{
    return p->y + (size_t)column * (size_t)p->n_rows;
}

static bool holds(const struct tri_fence *f, struct tri_point q)
{
    return q.x >= f->x_min && q.x < f->x_max && q.y >= f->y_min && q.y < f->y_max;
}

static int phase_of(int32_t column, int32_t row) { return 1 - row % 2 + 2 * (1 - column % 2); }

static void assert_boundaries_ascend(const struct par_partition *p)
{
    assert_true(p->n_columns >= 3 && p->n_rows >= 3 && p->n_columns % 2 == 1 && p->n_rows % 2 == 1);
    assert_true(p->x[0] == p->low.x && p->x[p->n_columns - 1] == p->high.x);
    for (int32_t c = 0; c < p->n_columns; c++) {
        const double *y = rows_of(p, c);
        assert_true(c == 0 || p->x[c - 1] <= p->x[c]);
        assert_true(y[0] == p->low.y && y[p->n_rows - 1] == p->high.y);
        for (int32_t r = 1; r < p->n_rows; r++)
            assert_true(y[r - 1] <= y[r]);
    }
}

static bool fences_overlap(const struct tri_fence *a, const struct tri_fence *b)
{
    return fmax(a->x_min, b->x_min) < fmin(a->x_max, b->x_max) && fmax(a->y_min, b->y_min) < fmin(a->y_max, b->y_max);
}

/* Half-open boxes of one phase are disjoint. */
static void assert_phases_are_disjoint(const struct par_partition *p)
{
    for (int32_t i = 0; i < par_blocks(p); i++) {
        struct tri_fence a = par_fence(p, i / p->n_rows, i % p->n_rows);
        assert_true(a.x_min <= a.x_max && a.y_min <= a.y_max);
        for (int32_t k = 0; k < i; k++) {
            struct tri_fence b = par_fence(p, k / p->n_rows, k % p->n_rows);
            if (phase_of(i / p->n_rows, i % p->n_rows) == phase_of(k / p->n_rows, k % p->n_rows))
                assert_false(fences_overlap(&a, &b));
        }
    }
}

static double depth(double low, double q, double high) { return fmin(q - low, high - q); }

/* The cell, out of n - 1, that contains q, by linear search. */
static int32_t cell_at(const double *bounds, int32_t n, double q)
{
    int32_t k = n - 2;
    while (k > 0 && bounds[k] > q)
        k--;
    return k;
}

static double width_at(const double *bounds, int32_t n, double q)
{
    int32_t k = cell_at(bounds, n, q);
    return bounds[k + 1] - bounds[k];
}

/* The narrowest of the cell that contains q and its neighbours. */
static double least_width_at(const double *bounds, int32_t n, double q)
{
    int32_t at = cell_at(bounds, n, q);
    double least = HUGE_VAL;
    for (int32_t k = at > 0 ? at - 1 : 0; k <= at + 1 && k < n - 1; k++)
        least = fmin(least, bounds[k + 1] - bounds[k]);
    return least;
}

/* In every phase exactly one block contains q, and par_block_at finds it. Some block contains q together with its
   surroundings, for half the width of the cells there. So no seam is left open by all four phases. */
static void assert_point_is_served(const struct par_partition *p, struct tri_point q)
{
    int32_t found[PAR_PHASES] = {TRI_NONE, TRI_NONE, TRI_NONE, TRI_NONE};
    bool deep = false;
    for (int32_t c = 0; c < p->n_columns; c++)
        for (int32_t r = 0; r < p->n_rows; r++) {
            struct tri_fence f = par_fence(p, c, r);
            if (!holds(&f, q))
                continue;
            assert_int_equal(found[phase_of(c, r)], TRI_NONE);
            found[phase_of(c, r)] = c * p->n_rows + r;
            deep |= depth(f.x_min, q.x, f.x_max) >= 0.4999 * least_width_at(p->x, p->n_columns, q.x) &&
                    depth(f.y_min, q.y, f.y_max) >= 0.4999 * least_width_at(rows_of(p, c), p->n_rows, q.y);
        }
    for (int phase = 0; phase < PAR_PHASES; phase++) {
        assert_int_not_equal(found[phase], TRI_NONE);
        assert_int_equal(par_block_at(p, phase, q), found[phase]);
    }
    assert_true(deep);
}

/* Random points in and around the box, vertices of the mesh, and points exactly on boundaries. */
static void assert_plane_is_served(const struct par_partition *p, const struct tri_mesh *mesh)
{
    struct support_random random = {11};
    double width = p->high.x - p->low.x, height = p->high.y - p->low.y;
    for (int i = 0; i < 300; i++) {
        struct tri_point q = {p->low.x + (1.2 * support_unit(&random) - 0.1) * width,
                              p->low.y + (1.2 * support_unit(&random) - 0.1) * height};
        assert_point_is_served(p, q);
        if (mesh->n_vertices > 0)
            assert_point_is_served(p, mesh->xy[support_below(&random, mesh->n_vertices)]);
        int32_t column = support_below(&random, p->n_columns), row = support_below(&random, p->n_rows);
        struct tri_point on = {p->x[column], rows_of(p, column)[row]};
        assert_point_is_served(p, on);
        on.x = column ? 0.5 * (p->x[column - 1] + p->x[column]) : p->low.x;
        assert_point_is_served(p, on);
    }
}

static void test_fences_serve_every_point_and_phases_are_disjoint(void **state)
{
    (void)state;
    for (int i = 0; i < N_TRIALS; i++) {
        struct tri_options options;
        struct tri_mesh mesh = start_of(&trials[i], &options);
        struct par_partition p = cut(&mesh, &options.quality, trials[i].block);
        for (;;) {
            assert_boundaries_ascend(&p);
            assert_phases_are_disjoint(&p);
            assert_plane_is_served(&p, &mesh);
            if (par_cells(&p) == 4)
                break;
            par_partition_coarsen(&p);
        }
        par_partition_free(&p);
        tri_mesh_free(&mesh);
    }
}

/* Each coarser level keeps every other boundary, down to one block that covers the whole plane. */
static void test_coarsening_halves_the_number_of_cells(void **state)
{
    (void)state;
    struct tri_options options;
    struct tri_mesh mesh = start_of(&trials[0], &options);
    struct par_partition p = cut(&mesh, &options.quality, 500), fine = cut(&mesh, &options.quality, 500);
    par_partition_coarsen(&p);
    assert_int_equal(p.n_columns, 2 * ((fine.n_columns + 2) / 4) + 1);
    assert_int_equal(p.n_rows, 2 * ((fine.n_rows + 2) / 4) + 1);
    for (int32_t c = 0; 2 * c < fine.n_columns; c++) {
        assert_true(p.x[c] == fine.x[2 * c]);
        for (int32_t r = 0; 2 * r < fine.n_rows; r++)
            assert_true(rows_of(&p, c)[r] == rows_of(&fine, 2 * c)[2 * r]);
    }
    while (par_cells(&p) > 4)
        par_partition_coarsen(&p);
    struct tri_fence all = par_fence(&p, 1, 1);
    assert_true(all.x_min == -HUGE_VAL && all.y_min == -HUGE_VAL && all.x_max == HUGE_VAL && all.y_max == HUGE_VAL);
    par_partition_free(&p);
    par_partition_free(&fine);
    tri_mesh_free(&mesh);
}

static void test_cell_size(void **state)
{
    (void)state;
    struct support_random random = {1};
    for (int i = 0; i < N_TRIALS; i++) {
        struct tri_options options;
        struct tri_mesh mesh = start_of(&trials[i], &options);
        struct par_partition p = cut(&mesh, &options.quality, trials[i].block);
        for (int k = 0; k < 200; k++) {
            struct tri_point q = {p.low.x + support_unit(&random) * (p.high.x - p.low.x),
                                  p.low.y + support_unit(&random) * (p.high.y - p.low.y)};
            int32_t column = cell_at(p.x, p.n_columns, q.x), block = column % 2 ? column : column + 1;
            double width = p.x[column + 1] - p.x[column], height = width_at(rows_of(&p, block), p.n_rows, q.y);
            assert_true(par_cell_size(&p, q) == fmin(width, height));
        }
        par_partition_free(&p);
        tri_mesh_free(&mesh);
    }
}

/* Compares the triangles of the refined mesh in the fullest block of the first phase with the mean. *ratio: the total
   number of triangles divided by the estimate. */
static double imbalance(const struct trial *trial, double *ratio)
{
    struct tri_options options;
    struct tri_report report;
    struct tri_error error;
    struct tri_mesh mesh = start_of(trial, &options);
    struct par_partition p = cut(&mesh, &options.quality, trial->block);
    int32_t n = par_cells(&p) / 4, *count = calloc((size_t)par_blocks(&p), sizeof *count), most = 0;
    assert_non_null(count);
    assert_int_equal(tri_refine(&mesh, &options.quality, &report.quality, &error), TRI_OK);
    for (int32_t t = 0; t < mesh.n_triangles; t++) {
        const int32_t *v = mesh.tri[t].v;
        struct tri_point q = {(mesh.xy[v[0]].x + mesh.xy[v[1]].x + mesh.xy[v[2]].x) / 3,
                              (mesh.xy[v[0]].y + mesh.xy[v[1]].y + mesh.xy[v[2]].y) / 3};
        count[par_block_at(&p, 0, q)]++;
    }
    for (int32_t i = 0; i < par_blocks(&p); i++)
        most = count[i] > most ? count[i] : most;
    *ratio = mesh.n_triangles / p.estimate;
    double over_mean = most * (double)n / mesh.n_triangles;
    print_message("  %-20s %d blocks, %d triangles for %.0f estimated, fullest block %.2f of the mean\n",
                  trial->file ? trial->file : "points", (int)n, (int)mesh.n_triangles, p.estimate, over_mean);
    assert_true(n >= 6);
    free(count);
    par_partition_free(&p);
    tri_mesh_free(&mesh);
    return over_mean;
}

static void test_blocks_have_equal_shares_of_the_work(void **state)
{
    (void)state;
    static const struct {
        struct trial trial;
        double fullest; /* upper bound of fullest block divided by mean */
    } cases[] = {
        {{NULL, SUPPORT_RANDOM, 300, 20, 1e-5, 2000}, 1.1},          /* uniform area bound */
        {{"letter.poly", 0, 0, 30, 0.002, 1500}, 1.1},                /* with holes */
        {{NULL, SUPPORT_RANDOM, 10000, 20, 0, 1000}, 1.2},            /* uniform points */
        {{"koch_lake.poly", 0, 0, 30, 0, 300}, 1.5},                  /* sizes graded by features */
        {{"coast/islands.poly", 0, 0, 25, 0, 100}, 1.8},
        {{"coast/norway_sea.poly", 0, 0, 25, 0, 500}, 1.8},
        {{"coast/borders.poly", 0, 0, 25, 3e8, 1500}, 1.8},          /* features and an area bound */
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double ratio;
        assert_true(imbalance(&cases[i].trial, &ratio) < cases[i].fullest);
        assert_true(ratio > 0.4 && ratio < 2.2);
    }
}

/* The estimate is the sum of its parts. The smaller of the region's bound and the global bound applies. */
static void test_work_follows_the_bounds(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_square(1, 0, 1);
    struct tri_options options = support_quality(0, 0);
    options.refine = false;
    options.spread_regions = true;
    pslg.regions = realloc(pslg.regions, 4 * sizeof *pslg.regions);
    assert_non_null(pslg.regions);
    pslg.n_regions = 1;
    pslg.regions[0] = pslg.regions[1] = 0.4;
    pslg.regions[2] = 1;
    pslg.regions[3] = 1e-3;
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    options.quality.region_areas = true;
    double fine = support_estimate(&mesh, &options.quality);
    options.quality.max_area = 1e-2;
    assert_true(support_estimate(&mesh, &options.quality) == fine);
    options.quality.region_areas = false;
    double coarse = support_estimate(&mesh, &options.quality);
    assert_true(fabs(fine / coarse - 10) < 1e-9);
    options.quality.area_scale = 10;
    assert_true(fabs(coarse / support_estimate(&mesh, &options.quality) - 10) < 1e-9);
    assert_true(tri_work_of(&mesh, &options.quality, 0) > 1);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* Fine at one place in the square, far from the centroid of every input triangle. */
static int is_too_large(void *user, const double a[2], const double b[2], const double c[2], double area)
{
    double x = (a[0] + b[0] + c[0]) / 3 - 0.97, y = (a[1] + b[1] + c[1]) / 3 - 0.96;
    (void)user;
    return area > 1e-7 + 1e-3 * (x * x + y * y);
}

static int always_unsuitable(void *user, const double a[2], const double b[2], const double c[2], double area)
{
    (void)user, (void)a, (void)b, (void)c;
    return area > 0;
}

/* Probing a size test estimates how many triangles it will request, and where. Probing a function that does not test
   size changes nothing. */
static void test_size_tests_are_probed(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_square(1, 0, 1);
    struct tri_options options = support_quality(25, 0);
    options.refine = false;
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    options.quality.unsuitable = always_unsuitable;
    assert_true(support_estimate(&mesh, &options.quality) < 100);
    options.quality.unsuitable = is_too_large;
    double estimate = support_estimate(&mesh, &options.quality);
    struct par_partition p = cut(&mesh, &options.quality, estimate / 64);
    struct tri_refine_report report;
    assert_int_equal(tri_refine(&mesh, &options.quality, &report, NULL), TRI_OK);
    int32_t *count = calloc((size_t)par_blocks(&p), sizeof *count), most = 0, n = par_cells(&p) / 4;
    assert_non_null(count);
    for (int32_t t = 0; t < mesh.n_triangles; t++)
        count[par_block_at(&p, 0, mesh.xy[mesh.tri[t].v[0]])]++;
    for (int32_t i = 0; i < par_blocks(&p); i++)
        most = count[i] > most ? count[i] : most;
    print_message("  %d triangles for %.0f estimated, fullest of %d blocks %.2f of the mean\n", (int)mesh.n_triangles,
                  estimate, (int)n, most * (double)n / mesh.n_triangles);
    assert_true(mesh.n_triangles > 0.4 * estimate && mesh.n_triangles < 2.2 * estimate);
    assert_true(n >= 9 && most * (double)n < 2.2 * mesh.n_triangles);
    free(count);
    par_partition_free(&p);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* Inputs without vertices, and estimates that no number of blocks can match. */
static void test_extreme_estimates_are_handled(void **state)
{
    (void)state;
    struct tri_mesh mesh;
    struct tri_error error;
    struct tri_quality quality = tri_quality_defaults();
    assert_int_equal(tri_mesh_init(&mesh, &error), TRI_OK);
    struct par_partition p = cut(&mesh, &quality, 1000);
    assert_int_equal(par_cells(&p), 4);
    par_partition_free(&p);
    tri_mesh_free(&mesh);
    struct tri_pslg pslg = support_square(1, 10, 1);
    struct tri_options options = support_quality(20, 1e-300);
    options.refine = false;
    mesh = support_generate(&pslg, &options, NULL);
    for (double area = 1e-300; area > 0; area /= 1e12) {
        options.quality.max_area = area;
        p = cut(&mesh, &options.quality, 1e290);
        assert_true(par_cells(&p) >= 4 && par_cells(&p) <= 2000000);
        par_partition_free(&p);
    }
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* --- columns found by sorting all samples at once */

struct sampled {
    double at[3]; /* x, y and work */
};

struct sampling {
    struct sampled *item;
    size_t n;
};

static bool note_sample(void *user, struct tri_point q, double work)
{
    struct sampling *s = user;
    s->item = realloc(s->item, (s->n + 1) * sizeof *s->item);
    s->item[s->n++] = (struct sampled){{q.x, q.y, work}};
    return s->item;
}

static int compare_sampled(const void *left, const void *right)
{
    const double *a = ((const struct sampled *)left)->at, *b = ((const struct sampled *)right)->at;
    int k = a[0] != b[0] ? 0 : a[1] != b[1] ? 1 : 2;
    return (a[k] > b[k]) - (a[k] < b[k]);
}

static void assert_columns_are_quantiles(const struct par_partition *p, const struct sampling *s)
{
    double total = 0, sum = 0;
    int32_t column = 1;
    for (size_t i = 0; i < s->n; i++)
        total += s->item[i].at[2];
    for (size_t i = 0; i + 1 < s->n && column < p->n_columns - 1; i++) {
        sum += s->item[i].at[2];
        for (; column < p->n_columns - 1 && sum >= total * column / (p->n_columns - 1); column++)
            assert_true(p->x[column] == 0.5 * (s->item[i].at[0] + s->item[i + 1].at[0]));
    }
}

/* In lattices, many samples share a coordinate. */
static void test_columns_are_those_of_sorted_samples(void **state)
{
    (void)state;
    for (size_t k = 0; k < 3; k++) {
        struct tri_options options;
        struct tri_mesh mesh = start_of(&trials[k], &options);
        struct tri_quality quality = options.quality;
        struct par_partition p = cut(&mesh, &quality, trials[k].block);
        struct sampling s = {0};
        assert_true(tri_sample_work(&mesh, &quality, p.estimate / par_cells(&p) / 32, NULL, note_sample, &s));
        qsort(s.item, s.n, sizeof *s.item, compare_sampled);
        assert_columns_are_quantiles(&p, &s);
        free(s.item);
        par_partition_free(&p);
        tri_mesh_free(&mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fences_serve_every_point_and_phases_are_disjoint),
        cmocka_unit_test(test_columns_are_those_of_sorted_samples),
        cmocka_unit_test(test_coarsening_halves_the_number_of_cells),
        cmocka_unit_test(test_cell_size),
        cmocka_unit_test(test_blocks_have_equal_shares_of_the_work),
        cmocka_unit_test(test_work_follows_the_bounds),
        cmocka_unit_test(test_size_tests_are_probed),
        cmocka_unit_test(test_extreme_estimates_are_handled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
