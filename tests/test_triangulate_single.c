/* triangulate() with float coordinates (SINGLE), as used by a client of such a library. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "triangle/dropin/triangle.h"

static float xy[] = {0, 0, 4, 0, 4, 3, 0, 3, 1, 1, 2, 1, 2, 2, 1, 2}, attributes[] = {0, 4, 34, 30, 11, 12, 22, 21};
static float hole[] = {1.5f, 1.5f}, region[] = {3.5f, 0.5f, 7.5f, 0.25f};
static int ends[] = {0, 1, 1, 2, 2, 3, 3, 0, 4, 5, 5, 6, 6, 7, 7, 4};

static struct triangulateio figure(void)
{
    return (struct triangulateio){.pointlist = xy, .pointattributelist = attributes, .numberofpoints = 8,
                                  .numberofpointattributes = 1, .segmentlist = ends, .numberofsegments = 8,
                                  .holelist = hole, .numberofholes = 1, .regionlist = region, .numberofregions = 1};
}

static void release(struct triangulateio *io)
{
    trifree(io->pointlist);
    trifree(io->pointattributelist);
    trifree(io->pointmarkerlist);
    trifree(io->trianglelist);
    trifree(io->triangleattributelist);
    trifree(io->segmentlist);
    trifree(io->segmentmarkerlist);
    trifree(io->edgelist);
    trifree(io->edgemarkerlist);
    trifree(io->normlist);
}

static double area_of(const struct triangulateio *io, int t)
{
    const int *v = &io->trianglelist[3 * t];
    const float *a = &io->pointlist[2 * v[0]], *b = &io->pointlist[2 * v[1]], *c = &io->pointlist[2 * v[2]];
    return (((double)b[0] - a[0]) * ((double)c[1] - a[1]) - ((double)c[0] - a[0]) * ((double)b[1] - a[1])) / 2;
}

static void test_mesh(void **state)
{
    (void)state;
    struct triangulateio in = figure(), out = {0}, vorout = {0};
    assert_int_equal(triangulate("pq30aAvzQ", &in, &out, &vorout), TRIANGULATE_OK);
    assert_int_equal(out.numberoftriangleattributes, 1);
    assert_memory_equal(out.pointlist, xy, sizeof xy);
    double sum = 0;
    for (int t = 0; t < out.numberoftriangles; t++) {
        double area = area_of(&out, t);
        assert_true(area > 0 && area <= 0.25 * (1 + 1e-5));
        assert_true(out.triangleattributelist[t] == 7.5f);
        sum += area;
    }
    assert_true(fabs(sum - 11) < 1e-5);
    for (int i = 0; i < out.numberofpoints; i++)
        assert_true(fabs(out.pointattributelist[i] - (out.pointlist[2 * i] + 10 * out.pointlist[2 * i + 1])) < 1e-4);
    assert_int_equal(vorout.numberofpoints, out.numberoftriangles);
    assert_true(vorout.pointlist && vorout.normlist && vorout.pointattributelist);
    release(&out);
    release(&vorout);
}

static void test_refined_again(void **state)
{
    (void)state;
    static float areas[] = {0.01f, -1};
    static int corners[] = {0, 1, 2, 0, 2, 3};
    struct triangulateio mesh = {.pointlist = xy, .numberofpoints = 4, .trianglelist = corners, .numberoftriangles = 2,
                                 .numberofcorners = 3, .numberoftriangleattributes = 1, .trianglearealist = areas,
                                 .triangleattributelist = attributes + 2}, out = {0};
    assert_int_equal(triangulate("raqzQ", &mesh, &out, NULL), TRIANGULATE_OK);
    assert_true(out.numberoftriangles > 600);
    for (int t = 0; t < out.numberoftriangles; t++)
        assert_true(out.triangleattributelist[t] == 30 || area_of(&out, t) <= 0.01 * (1 + 1e-5));
    release(&out);
}

static int is_large(void *user, const float *a, const float *b, const float *c, float area)
{
    (void)a, (void)b, (void)c;
    ++*(int *)user;
    return area > 0.05f;
}

static void test_size_test(void **state)
{
    (void)state;
    int asked = 0;
    struct triangulate_options options = {.unsuitable = is_large, .unsuitable_user = &asked};
    struct triangulateio in = figure(), out = {0};
    assert_int_equal(triangulate_with("puzQ", &in, &out, NULL, &options), TRIANGULATE_OK);
    assert_true(asked > out.numberoftriangles && out.numberoftriangles > 11 / 0.05);
    release(&out);
    in.pointlist = NULL;
    assert_int_equal(triangulate_with("puzQ", &in, &out, NULL, &options), TRIANGULATE_BAD_INPUT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mesh),
        cmocka_unit_test(test_refined_again),
        cmocka_unit_test(test_size_test),
    };
    return cmocka_run_group_tests_name("triangulate_single", tests, NULL, NULL);
}
