/* Which triangles are bad and which subsegments are encroached, on triangles with known answers. */
#include "triangle/size/quality.h"
#include "triangle/refine/split.h"

#include "tests/support.h"

/* One triangle in region 1, which has its own area bound. */
struct setting {
    struct tri_point xy[3];
    struct tri_triangle triangle;
    struct tri_region regions[2];
    struct tri_mesh mesh;
    struct tri_quality options;
};

static void set_up(struct setting *s, struct tri_point a, struct tri_point b, struct tri_point c)
{
    *s = (struct setting){.xy = {a, b, c}, .triangle = {.v = {0, 1, 2}, .region = 1}, .regions = {{0, 0}, {7, 0.25}},
                          .options = tri_quality_defaults()};
    s->mesh = (struct tri_mesh){.xy = s->xy, .n_vertices = 3, .tri = &s->triangle, .n_triangles = 1,
                                .regions = s->regions, .n_regions = 2, .unit = 1};
}

static enum tri_badness judge(const struct setting *s)
{
    struct tri_criterion c = tri_criterion_for(&s->mesh, &s->options);
    struct tri_shape shape = tri_shape_of(s->xy, s->triangle.v);
    return tri_judge(&c, &s->triangle, &shape);
}

static void test_angles_before_sizes(void **state)
{
    (void)state;
    struct setting s;
    set_up(&s, (struct tri_point){0, 0}, (struct tri_point){2, 0}, (struct tri_point){0, 2}); /* 45 degrees, area 2 */
    s.options.min_angle = 44.9;
    assert_int_equal(judge(&s), TRI_GOOD);
    s.options.min_angle = 45.1;
    s.options.max_area = 1;
    assert_int_equal(judge(&s), TRI_BAD_ANGLE);
    s.options.min_angle = 0;
    assert_int_equal(judge(&s), TRI_BAD_SIZE);
    s.options.max_area = 2;
    assert_int_equal(judge(&s), TRI_GOOD);
}

static double area2_bound(const struct setting *s, int32_t region)
{
    struct tri_asked asked = tri_asked_of(&s->mesh, &s->options);
    return tri_area2_bound(&asked, region);
}

/* The smaller of the two bounds counts, in the caller's units and multiplied by the scale. */
static void test_area_bounds(void **state)
{
    (void)state;
    struct setting s;
    set_up(&s, (struct tri_point){0, 0}, (struct tri_point){1, 0}, (struct tri_point){0, 1});
    assert_true(area2_bound(&s, 1) == HUGE_VAL);
    assert_false(tri_has_sizes(&s.options));
    s.options.max_area = 1;
    assert_true(tri_has_sizes(&s.options));
    assert_true(area2_bound(&s, 1) == 2);
    s.options.region_areas = true;
    assert_true(area2_bound(&s, 1) == 0.5);
    assert_true(area2_bound(&s, 0) == 2);
    s.options.area_scale = 8;
    assert_true(area2_bound(&s, 1) == 4);
    s.mesh.unit = 2;
    assert_true(area2_bound(&s, 1) == 1);
}

/* Stores the area and first corner of the last call; rejects areas above 1. */
static int record_call(void *user, const double a[2], const double b[2], const double c[2], double area)
{
    double *told = user;
    (void)b, (void)c;
    told[0] = a[0];
    told[1] = area;
    return area > 1;
}

/* A size test is called in the caller's units. With an area scale, it receives a smaller triangle, of 1 / area_scale of
 * the area. */
static void test_size_tests(void **state)
{
    (void)state;
    struct setting s;
    double told[2];
    set_up(&s, (struct tri_point){0, 0}, (struct tri_point){3, 0}, (struct tri_point){0, 3});
    s.mesh.unit = 2;
    s.options.unsuitable = record_call;
    s.options.unsuitable_user = told;
    assert_int_equal(judge(&s), TRI_BAD_SIZE);
    assert_true(told[0] == 0 && told[1] == 18);
    s.options.area_scale = 36;
    assert_int_equal(judge(&s), TRI_GOOD);
    assert_true(fabs(told[0] - 2 * (1 - 1 / 6.0)) < 1e-14 && told[1] == 0.5);
}

static void test_protection(void **state)
{
    (void)state;
    struct tri_subsegment boundary = {.side = {4, TRI_NONE}}, inner = {.side = {4, 9}};
    struct tri_quality options = tri_quality_defaults();
    assert_false(tri_is_protected(&options, &boundary));
    options.protect = 1;
    assert_true(tri_is_protected(&options, &boundary));
    assert_false(tri_is_protected(&options, &inner));
    options.protect = 2;
    assert_true(tri_is_protected(&options, &inner));
}

static void test_flat(void **state)
{
    (void)state;
    struct setting s;
    set_up(&s, (struct tri_point){0, 0}, (struct tri_point){1, 0}, (struct tri_point){0.5, 1e-6});
    struct tri_shape shape = tri_shape_of(s.xy, s.triangle.v);
    s.mesh.limits.shortest2 = 1e-14;
    assert_false(tri_is_flat(&s.mesh, &shape));
    s.mesh.limits.shortest2 = 1e-10;
    assert_true(tri_is_flat(&s.mesh, &shape));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_angles_before_sizes),
        cmocka_unit_test(test_area_bounds),
        cmocka_unit_test(test_size_tests),
        cmocka_unit_test(test_protection),
        cmocka_unit_test(test_flat),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
