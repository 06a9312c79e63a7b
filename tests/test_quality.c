/* Compares bounds, shapes and placement with elementary geometry in long double. */
#include "support.h"
#include "triangle/refine/place.h"

static const double RADIANS = 0.017453292519943295769;

static void test_bounds_match_their_angles(void **state)
{
    (void)state;
    for (double angle = 1; angle <= 60; angle++) {
        struct tri_bounds b = tri_bounds_for(angle, false);
        double sine = sin(angle * RADIANS), wide = cos((180 - 2 * angle) * RADIANS);
        assert_true(fabs(b.sin2 - sine * sine) < 1e-14);
        assert_true(fabs(b.lens_cos2 - (angle < 45 ? wide * wide : 0)) < 1e-14);
        assert_true(tri_bounds_for(angle, true).lens_cos2 == 0);
        assert_true(b.off_centre > 0 && b.off_centre <= 0.5 / tan(angle / 2 * RADIANS));
    }
    struct tri_bounds none = tri_bounds_for(0, false);
    assert_true(none.sin2 == 0 && none.off_centre == 0);
    assert_true(none.lens_cos2 == tri_bounds_for(20, false).lens_cos2); /* points keep their distance from subsegments
                                                                           even then */
    assert_true(tri_bounds_for(0, true).lens_cos2 == 0);
    assert_true(tri_bounds_for(-5, false).sin2 == 0);
}

static double smallest_angle(const struct tri_point *q)
{
    double least = 180;
    for (int k = 0; k < 3; k++) {
        struct tri_point o = q[k], a = q[tri_next[k]], b = q[tri_prev[k]];
        double ax = a.x - o.x, ay = a.y - o.y, bx = b.x - o.x, by = b.y - o.y;
        double angle = atan2(fabs(ax * by - ay * bx), ax * bx + ay * by) / RADIANS;
        least = angle < least ? angle : least;
    }
    return least;
}

static bool draw_triangle(struct support_random *random, struct tri_point q[3])
{
    for (int k = 0; k < 3; k++) {
        q[k].x = support_unit(random);
        q[k].y = support_unit(random) * (support_below(random, 2) ? 1 : 0.05);
    }
    double area2 = tri_orient2d(q[0], q[1], q[2]);
    if (area2 < 0) {
        struct tri_point swap = q[0];
        q[0] = q[1];
        q[1] = swap;
    }
    return fabs(area2) > 1e-6;
}

static const int32_t corners[3] = {0, 1, 2};

static void test_shape_and_angle_test(void **state)
{
    (void)state;
    struct support_random random = {2};
    struct tri_point q[3];
    for (int i = 0; i < 20000; i++) {
        if (!draw_triangle(&random, q))
            continue;
        struct tri_shape s = tri_shape_of(q, corners);
        for (int k = 0; k < 3; k++) {
            double x = q[tri_next[k]].x - q[tri_prev[k]].x, y = q[tri_next[k]].y - q[tri_prev[k]].y;
            assert_true(fabs(s.l[k] - (x * x + y * y)) <= 1e-15);
            assert_true(s.l[s.shortest] <= s.l[k]);
        }
        assert_true(fabs(s.area2 - tri_orient2d(q[0], q[1], q[2])) <= 1e-15);
        double sine = sin(smallest_angle(q) * RADIANS), product = tri_longer_product(s.l[0], s.l[1], s.l[2]);
        assert_true(fabs(s.area2 * s.area2 / product - sine * sine) < 1e-9);
    }
}

static void test_longer_product_takes_the_two_longer(void **state)
{
    (void)state;
    static const double permutations[6][3] = {{2, 3, 5}, {2, 5, 3}, {3, 2, 5}, {3, 5, 2}, {5, 2, 3}, {5, 3, 2}};
    for (int i = 0; i < 6; i++)
        assert_true(tri_longer_product(permutations[i][0], permutations[i][1], permutations[i][2]) == 15);
    assert_true(tri_longer_product(2, 2, 7) == 14);
    assert_true(tri_longer_product(7, 7, 2) == 49);
}

static void test_circumcentre_is_equidistant(void **state)
{
    (void)state;
    struct support_random random = {3};
    struct tri_point q[3];
    for (int i = 0; i < 20000; i++) {
        if (!draw_triangle(&random, q) || smallest_angle(q) < 5)
            continue;
        struct tri_shape s = tri_shape_of(q, corners);
        struct tri_point c = tri_place(q, corners, &s, HUGE_VAL);
        double r0 = hypot(c.x - q[0].x, c.y - q[0].y);
        for (int k = 1; k < 3; k++)
            assert_true(fabs(hypot(c.x - q[k].x, c.y - q[k].y) - r0) < 1e-9 * (1 + r0));
    }
}

/* An off-centre lies on the bisector of the shortest edge, on the side of the third corner, at the requested height. */
static void test_off_centre_has_the_requested_height(void **state)
{
    (void)state;
    struct support_random random = {4};
    struct tri_point q[3];
    int moved = 0;
    for (int i = 0; i < 20000; i++) {
        if (!draw_triangle(&random, q))
            continue;
        struct tri_shape s = tri_shape_of(q, corners);
        int k = s.shortest;
        struct tri_point a = q[tri_next[k]], b = q[tri_prev[k]];
        double edge = sqrt(s.l[k]), reach = edge * (0.5 + support_unit(&random));
        struct tri_point far = tri_place(q, corners, &s, HUGE_VAL), p = tri_place(q, corners, &s, reach);
        double mx = (a.x + b.x) / 2, my = (a.y + b.y) / 2, height = hypot(p.x - mx, p.y - my);
        if (hypot(far.x - mx, far.y - my) <= reach * (1 - 1e-9)) {
            assert_true(p.x == far.x && p.y == far.y);
            continue;
        }
        assert_true(fabs(height - reach) < 1e-9 * (1 + reach));
        assert_true(fabs((p.x - mx) * (b.x - a.x) + (p.y - my) * (b.y - a.y)) < 1e-9 * (1 + reach));
        assert_true(tri_orient2d(a, b, p) > 0);
        moved++;
    }
    assert_true(moved > 1000);
}

/* The new triangle on the shortest edge meets the bound for which the off-centre was computed. */
static void test_off_centre_keeps_the_bound(void **state)
{
    (void)state;
    for (double angle = 5; angle <= 34; angle++) {
        struct tri_bounds b = tri_bounds_for(angle, false);
        struct tri_point q[3] = {{0, 0}, {1, 0}, {0.5, 1e6}};
        struct tri_shape s = tri_shape_of(q, corners);
        q[2] = tri_place(q, corners, &s, b.off_centre * sqrt(s.l[s.shortest]));
        assert_true(smallest_angle(q) >= angle);
        assert_true(smallest_angle(q) < angle * 1.06);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bounds_match_their_angles),           cmocka_unit_test(test_shape_and_angle_test),
        cmocka_unit_test(test_longer_product_takes_the_two_longer), cmocka_unit_test(test_circumcentre_is_equidistant),
        cmocka_unit_test(test_off_centre_has_the_requested_height), cmocka_unit_test(test_off_centre_keeps_the_bound),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
