/* Crossings, feet of perpendiculars, and distances, compared with rational arithmetic (GMP). */
#include "support.h"

#include <gmp.h>

#include "triangle/cdt/crossing.h"
#include "triangle/geometry/expansion.h"

/* A point with rational coordinates, for exact determinants. */
struct exact {
    mpq_t x, y;
};

static struct exact a, b, c, d, q;
static mpq_t det, other, length2, first, second;

static void init(struct exact *p) { mpq_inits(p->x, p->y, NULL); }

static int setup(void **state)
{
    (void)state;
    init(&a), init(&b), init(&c), init(&d), init(&q);
    mpq_inits(det, other, length2, first, second, NULL);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    mpq_clears(a.x, a.y, b.x, b.y, c.x, c.y, d.x, d.y, q.x, q.y, det, other, length2, first, second, NULL);
    return 0;
}

static void set_exact(struct exact *e, struct tri_point p)
{
    mpq_set_d(e->x, p.x);
    mpq_set_d(e->y, p.y);
}

/* z = (v - u) x (w - u), the cross product. */
static void cross(mpq_t z, const struct exact *u, const struct exact *v, const struct exact *w)
{
    mpq_sub(first, v->x, u->x);
    mpq_sub(second, w->y, u->y);
    mpq_mul(z, first, second);
    mpq_sub(first, v->y, u->y);
    mpq_sub(second, w->x, u->x);
    mpq_mul(first, first, second);
    mpq_sub(z, z, first);
}

static void square_of_length(mpq_t z, const struct exact *u, const struct exact *v)
{
    mpq_sub(first, v->x, u->x);
    mpq_mul(first, first, first);
    mpq_sub(second, v->y, u->y);
    mpq_mul(second, second, second);
    mpq_add(z, first, second);
}

/* The distance of p from the line through u and v, with one or two roundings. */
static double distance(struct tri_point u, struct tri_point v, struct tri_point p)
{
    set_exact(&a, u), set_exact(&b, v), set_exact(&q, p);
    cross(det, &a, &b, &q);
    square_of_length(length2, &a, &b);
    mpq_mul(det, det, det);
    mpq_div(det, det, length2);
    return sqrt(mpq_get_d(det));
}

/* The distance from p to r along the line through u and v, with one or two roundings. */
static double way_along(struct tri_point u, struct tri_point v, struct tri_point p, struct tri_point r)
{
    set_exact(&a, u), set_exact(&b, v), set_exact(&c, p), set_exact(&q, r);
    mpq_sub(first, b.x, a.x);
    mpq_sub(second, q.x, c.x);
    mpq_mul(det, first, second);
    mpq_sub(first, b.y, a.y);
    mpq_sub(second, q.y, c.y);
    mpq_mul(first, first, second);
    mpq_add(det, det, first);
    square_of_length(length2, &a, &b);
    mpq_mul(det, det, det);
    mpq_div(det, det, length2);
    return sqrt(mpq_get_d(det));
}

/* --- random places */

static struct support_random random_numbers;

static double between(double low, double high) { return low + (high - low) * support_unit(&random_numbers); }

static struct tri_point random_point(double offset, double size)
{
    double x = offset + between(-size, size);
    return (struct tri_point){x, offset + between(-size, size)};
}

static double step(double x)
{
    for (int32_t ulps = support_below(&random_numbers, 9) - 4; ulps != 0; ulps += ulps < 0 ? 1 : -1)
        x = nextafter(x, ulps < 0 ? -INFINITY : INFINITY);
    return x;
}

static struct tri_point near_line(struct tri_point u, struct tri_point v, double fraction)
{
    double x = step(u.x + fraction * (v.x - u.x));
    return (struct tri_point){x, step(u.y + fraction * (v.y - u.y))};
}

/* Two segments, p[0] p[1] and p[2] p[3]. */
static void random_segments(struct tri_point p[4])
{
    for (int i = 0; i < 4; i++)
        p[i] = random_point(0, 1);
}

static void nearly_parallel(struct tri_point p[4])
{
    double offset = support_below(&random_numbers, 2) ? 0 : ldexp(1, support_below(&random_numbers, 40));
    p[0] = random_point(offset, 1);
    p[1] = random_point(offset, 1);
    p[2] = near_line(p[0], p[1], between(-1, 0.5));
    p[3] = near_line(p[0], p[1], between(0.5, 2));
}

static void beside_each_other(struct tri_point p[4])
{
    double size = ldexp(1, -support_below(&random_numbers, 60));
    p[0] = random_point(0, size);
    p[1] = random_point(0, size);
    p[2] = random_point(0, 1000);
    p[3] = (struct tri_point){between(0, size) - p[2].x, between(0, size) - p[2].y};
}

static void far_away(struct tri_point p[4])
{
    double offset = ldexp(1, support_below(&random_numbers, 52));
    for (int i = 0; i < 4; i++)
        p[i] = random_point(offset, 8);
}

static void through_a_place(struct tri_point p[4])
{
    struct tri_point place = random_point(between(-5, 5), 1);
    for (int i = 0; i < 4; i += 2) {
        struct tri_point way = random_point(0, ldexp(1, support_below(&random_numbers, 30) - 15));
        p[i] = (struct tri_point){place.x + way.x, place.y + way.y};
        p[i + 1] = (struct tri_point){step(place.x - way.x), step(place.y - way.y)};
    }
}

static void (*const make[])(struct tri_point p[4]) = {random_segments, nearly_parallel, beside_each_other, far_away,
                                                      through_a_place};

enum { KINDS = sizeof make / sizeof *make, RUNS = 4000 };

static bool same(struct tri_point p, struct tri_point r) { return p.x == r.x && p.y == r.y; }

static double larger(double x, double y) { return x > y ? x : y; }

static bool opposite(int s, int t) { return (s < 0 && t > 0) || (s > 0 && t < 0); }

static bool naively_cross(const struct tri_point p[4])
{
    set_exact(&a, p[0]), set_exact(&b, p[1]), set_exact(&c, p[2]), set_exact(&d, p[3]);
    int side[4];
    cross(det, &a, &b, &c), side[0] = mpq_sgn(det);
    cross(det, &a, &b, &d), side[1] = mpq_sgn(det);
    cross(det, &c, &d, &a), side[2] = mpq_sgn(det);
    cross(det, &c, &d, &b), side[3] = mpq_sgn(det);
    return opposite(side[0], side[1]) && opposite(side[2], side[3]);
}

static void test_crossings_lie_on_both_lines(void **state)
{
    (void)state;
    int32_t crossings[KINDS] = {0};
    for (int kind = 0; kind < KINDS; kind++)
        for (int i = 0; i < RUNS; i++) {
            struct tri_point p[4], at;
            make[kind](p);
            bool crosses = naively_cross(p);
            assert_int_equal(tri_crossing(p[0], p[1], p[2], p[3], &at), crosses);
            if (!crosses)
                continue;
            crossings[kind]++;
            double resolution = tri_resolution(at);
            if (distance(p[0], p[1], at) > resolution || distance(p[2], p[3], at) > resolution)
                fail_msg("kind %d, run %d: %g and %g resolutions off", kind, i,
                         distance(p[0], p[1], at) / resolution, distance(p[2], p[3], at) / resolution);
        }
    for (int kind = 0; kind < KINDS; kind++)
        assert_true(crossings[kind] > RUNS / 40);
}

static void test_touching_is_no_crossing(void **state)
{
    (void)state;
    struct tri_point o = {0, 0}, e = {1, 0}, n = {0, 1}, m = {0.5, 0}, s = {0.5, -1}, at;
    assert_false(tri_crossing(o, e, o, n, &at));  /* an end inside the other segment */
    assert_false(tri_crossing(o, e, m, n, &at));  /* one within the other */
    assert_false(tri_crossing(m, s, o, e, &at));
    assert_false(tri_crossing(o, e, m, e, &at));  /* one in the other */
    assert_false(tri_crossing(o, n, m, s, &at));
    assert_true(tri_crossing(o, e, n, s, &at));
    assert_true(same(at, (struct tri_point){0.25, 0}));
}

/* The foot lies on the line and on the perpendicular through the point. Coordinates multiplied by 2^50 show the
 * remaining error. */
static void test_feet_lie_on_the_line(void **state)
{
    (void)state;
    for (int kind = 0; kind < KINDS; kind++)
        for (int i = 0; i < RUNS; i++) {
            struct tri_point p[4];
            make[kind](p);
            if (same(p[0], p[1]))
                continue;
            struct tri_point at = tri_onto_line(p[0], p[1], p[2]);
            double resolution = larger(tri_resolution(at), 0x1p-52 * tri_resolution(p[2]));
            if (distance(p[0], p[1], at) > resolution)
                fail_msg("kind %d, run %d: %g resolutions off", kind, i, distance(p[0], p[1], at) / resolution);
            if (way_along(p[0], p[1], p[2], at) > resolution)
                fail_msg("kind %d, run %d: %g resolutions along", kind, i,
                         way_along(p[0], p[1], p[2], at) / resolution);
        }
}

static void test_distances(void **state)
{
    (void)state;
    for (int kind = 0; kind < KINDS; kind++)
        for (int i = 0; i < RUNS; i++) {
            struct tri_point p[4];
            make[kind](p);
            if (same(p[0], p[1]))
                continue;
            double is = tri_line_distance(p[0], p[1], p[2]), expected = distance(p[0], p[1], p[2]);
            assert_true(fabs(is - expected) <= 0x1p-48 * expected);
        }
}

/* |pair - det| <= 2^-80 |det|, and the sign is that of the first number of the pair. */
static void test_determinants(void **state)
{
    (void)state;
    for (int kind = 0; kind < KINDS; kind++)
        for (int i = 0; i < RUNS; i++) {
            struct tri_point p[4];
            make[kind](p);
            struct tri_pair pair = tri_orient2d_pair(p[0], p[1], p[2]);
            set_exact(&a, p[0]), set_exact(&b, p[1]), set_exact(&c, p[2]);
            cross(det, &a, &b, &c);
            assert_int_equal((pair.head > 0) - (pair.head < 0), mpq_sgn(det));
            mpq_set_d(first, pair.head);
            mpq_set_d(second, pair.tail);
            mpq_add(other, first, second);
            mpq_sub(other, other, det);
            mpq_mul_2exp(other, other, 80);
            mpq_abs(other, other);
            mpq_abs(det, det);
            assert_true(mpq_cmp(other, det) <= 0);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_crossings_lie_on_both_lines),
        cmocka_unit_test(test_touching_is_no_crossing),
        cmocka_unit_test(test_feet_lie_on_the_line),
        cmocka_unit_test(test_distances),
        cmocka_unit_test(test_determinants),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
