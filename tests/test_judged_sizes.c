/* The measures of lengths in trianglecheck, compared with a naive twin that knows the lengths as a formula. */
#include "drivers/judge/judged_sizes.h"

#include <stdio.h>

#include "support.h"

/* 0.1 at the left side of the square, growing by 0.3 for a distance of 1, at most 0.4. */
static double wanted(double x)
{
    return fmin(0.1 + 0.3 * x, 0.4);
}

static double side(const double *points, int32_t a, int32_t b)
{
    return hypot(points[2 * a] - points[2 * b], points[2 * a + 1] - points[2 * b + 1]);
}

/* Counts each edge once, by examining all triangles before. */
static struct judged_sizes naive_sizes(const struct tri_check_mesh *mesh)
{
    struct judged_sizes found = {0};
    double integral = 0, quality = 0;
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        const int32_t *v = &mesh->triangles[3 * t];
        const double *p = mesh->points, *a = &p[2 * v[0]], *b = &p[2 * v[1]], *c = &p[2 * v[2]];
        const double area = ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
        const double h = wanted((a[0] + b[0] + c[0]) / 3);
        integral += area / (sqrt(3) / 4 * h * h);
        double squares = 0;
        for (int k = 0; k < 3; k++) {
            const int32_t from = v[k], to = v[(k + 1) % 3];
            const double length = side(p, from, to), ratio = length / wanted((p[2 * from] + p[2 * to]) / 2);
            bool is_new = true;
            for (int32_t i = 0; i < 3 * t; i++) {
                const int32_t other = mesh->triangles[i], next = mesh->triangles[i - i % 3 + (i + 1) % 3];
                is_new = is_new && !(other == to && next == from);
            }
            squares += length * length;
            found.n_edges += is_new;
            found.n_fitting += is_new && ratio > 0.7 && ratio < 1.4;
        }
        quality += 4 * sqrt(3) * area / squares;
    }
    found.number = mesh->n_triangles / integral;
    found.quality = quality / mesh->n_triangles;
    return found;
}

/* A square with side 2, whose left side has the marker 7. */
static struct tri_pslg marked_square(void)
{
    struct tri_pslg pslg = support_square(2, 0, 1);
    pslg.segment_markers = calloc((size_t)pslg.n_segments, sizeof *pslg.segment_markers);
    assert_non_null(pslg.segment_markers);
    for (int32_t s = 0; s < pslg.n_segments; s++) {
        const int32_t *v = &pslg.segments[2 * s];
        pslg.segment_markers[s] = pslg.points[2 * v[0]] == 0 && pslg.points[2 * v[1]] == 0 ? 7 : 1;
    }
    return pslg;
}

static void take_option(struct size_options *options, const char *word)
{
    static char words[8][40];
    snprintf(words[options->n], sizeof words[0], "%s", word);
    char *argv[] = {words[options->n]};
    int at = 0;
    struct tri_error error = {0};
    assert_true(size_options_take(options, NULL, 1, argv, &at, &error) && !error.status);
}

/* Measures a mesh with this area bound, whose edges are about as long as wanted or not. */
static void check_mesh(double max_area, double least, double most)
{
    struct judged_files files = {.input = marked_square(), .base = 1};
    struct tri_options quality = support_quality(25, max_area);
    struct tri_mesh mesh = support_generate(&files.input, &quality, NULL);
    struct support_copy copy = support_copy(&mesh);
    files.source = tri_check_source_of(&copy.mesh);
    struct size_options options = {0};
    take_option(&options, "--size-near=7:0.1,0.3");
    take_option(&options, "--max-size=0.4");
    const struct tri_check_options check = {.max_bad = -1};
    struct judged_sizes sizes;
    struct tri_error error = {0};
    assert_int_equal(judged_sizes_measure(&sizes, &options, &files, &check, NULL, &error), TRI_OK);
    const struct judged_sizes naive = naive_sizes(&copy.mesh);
    assert_int_equal(sizes.n_edges, naive.n_edges);
    assert_int_equal(sizes.n_fitting, naive.n_fitting);
    assert_true(fabs(sizes.number - naive.number) < 1e-9 * naive.number);
    assert_true(fabs(sizes.quality - naive.quality) < 1e-9);
    assert_true(judged_sizes_fitting(&sizes) >= least && judged_sizes_fitting(&sizes) <= most);
    size_options_free(&options);
    support_copy_free(&copy);
    tri_mesh_free(&mesh);
    tri_pslg_free(&files.input);
}

static void test_measures_equal_those_of_a_naive_twin(void **state)
{
    (void)state;
    check_mesh(0.04, 0.2, 0.9);
    check_mesh(0.0005, 0, 0.1); /* edges are far too short */
    check_mesh(1, 0, 0.1);      /* edges are far too long */
}

static void test_without_lengths_there_is_an_error(void **state)
{
    (void)state;
    struct judged_files files = {.input = marked_square()};
    struct tri_options quality = support_quality(25, 0.5);
    struct tri_mesh mesh = support_generate(&files.input, &quality, NULL);
    struct support_copy copy = support_copy(&mesh);
    files.source = tri_check_source_of(&copy.mesh);
    struct size_options options = {.per_circle = 20}; /* the square has no curves */
    const struct tri_check_options check = {.max_bad = -1};
    struct judged_sizes sizes;
    struct tri_error error = {0};
    assert_int_equal(judged_sizes_measure(&sizes, &options, &files, &check, NULL, &error), TRI_BAD_INPUT);
    options = (struct size_options){0};
    take_option(&options, "--size-near=8:0.1");
    assert_int_equal(judged_sizes_measure(&sizes, &options, &files, &check, NULL, &error), TRI_BAD_INPUT);
    assert_non_null(strstr(error.text, "--size-near 8:0.1"));
    support_copy_free(&copy);
    tri_mesh_free(&mesh);
    tri_pslg_free(&files.input);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_measures_equal_those_of_a_naive_twin),
        cmocka_unit_test(test_without_lengths_there_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
