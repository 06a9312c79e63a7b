/* A client that defines its own triunsuitable, which the linker gives to the library. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define EXTERNAL_TEST
#define REAL TRI_REAL
#include "triangle/dropin/triangle.h"

static struct {
    int calls;
    REAL bound; /* maximum length of edges */
} test;

static REAL length2(const REAL *a, const REAL *b)
{
    REAL x = a[0] - b[0], y = a[1] - b[1];
    return x * x + y * y;
}

/* Clients may write into the corners, since Triangle does not declare them const. */
int triunsuitable(REAL *origin, REAL *destination, REAL *apex, REAL area)
{
    REAL longest2 = fmax(length2(origin, destination), fmax(length2(destination, apex), length2(apex, origin)));
    test.calls++;
    assert_true(area > 0);
    origin[0] = destination[1] = apex[0] = NAN;
    return longest2 > test.bound * test.bound;
}

static void mesh_square(const char *switches, const struct triangulate_options *options, struct triangulateio *out)
{
    static REAL xy[] = {0, 0, 1, 0, 1, 1, 0, 1};
    static int ends[] = {0, 1, 1, 2, 2, 3, 3, 0};
    struct triangulateio in = {.pointlist = xy, .numberofpoints = 4, .segmentlist = ends, .numberofsegments = 4};
    *out = (struct triangulateio){0};
    assert_int_equal(triangulate_with(switches, &in, out, NULL, options), TRIANGULATE_OK);
}

static void release(struct triangulateio *out)
{
    trifree(out->pointlist);
    trifree(out->pointmarkerlist);
    trifree(out->trianglelist);
    trifree(out->segmentlist);
    trifree(out->segmentmarkerlist);
}

static void test_triunsuitable_is_called(void **state)
{
    (void)state;
    struct triangulateio out;
    test.calls = 0;
    test.bound = (REAL)0.1;
    mesh_square("pquzQ", NULL, &out);
    assert_true(test.calls >= out.numberoftriangles && out.numberoftriangles > 200);
    for (int i = 0; i < 3 * out.numberoftriangles; i++) {
        const int *v = &out.trianglelist[i - i % 3];
        const REAL *from = &out.pointlist[2 * v[i % 3]], *to = &out.pointlist[2 * v[(i + 1) % 3]];
        assert_true(length2(from, to) <= test.bound * test.bound);
    }
    release(&out);
}

static void test_triunsuitable_is_called_only_with_u(void **state)
{
    (void)state;
    struct triangulateio out;
    test.calls = 0;
    mesh_square("pqzQ", NULL, &out);
    assert_int_equal(test.calls, 0);
    assert_true(out.numberoftriangles < 20);
    release(&out);
}

static int is_large(void *user, const REAL *a, const REAL *b, const REAL *c, REAL area)
{
    (void)a, (void)b, (void)c;
    ++*(int *)user;
    return area > 0.2;
}

static void test_a_size_test_of_the_options_comes_first(void **state)
{
    (void)state;
    struct triangulateio out;
    int asked = 0;
    struct triangulate_options options = {.unsuitable = is_large, .unsuitable_user = &asked};
    test.calls = 0;
    mesh_square("puzQ", &options, &out);
    assert_int_equal(test.calls, 0);
    assert_true(asked > 0 && out.numberoftriangles >= 5);
    release(&out);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_triunsuitable_is_called),
        cmocka_unit_test(test_triunsuitable_is_called_only_with_u),
        cmocka_unit_test(test_a_size_test_of_the_options_comes_first),
    };
    return cmocka_run_group_tests_name("triunsuitable", tests, NULL, NULL);
}
