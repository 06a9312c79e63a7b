/* Tests of triangle/predicates and triangle/expansion. The oracle evaluates the same determinants with GMP integers. It
   breaks ties by raising the lifted points by actual amounts of widely different magnitude, not by case analysis. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>
#include <gmp.h>

#include "triangle/geometry/expansion.h"
#include "triangle/geometry/predicates.h"

/* random numbers and points */

static uint64_t random_state = 0x9e3779b97f4a7c15u;

static uint64_t random_bits(void) /* splitmix64 */
{
    uint64_t z = random_state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

static int random_int(int low, int high)
{
    return low + (int)(random_bits() % (uint64_t)(high - low + 1));
}
static double random_sign(void)
{
    return random_bits() & 1 ? 1 : -1;
}

/* 53 random bits in [1, 2). */
static double random_mantissa(void)
{
    return 1 + (double)(random_bits() >> 12) * 0x1p-52;
}

/* A random sign and a random exponent in [low, high]; sometimes with few significant bits. */
static double random_double(int low, int high)
{
    double m = random_bits() % 4 == 0 ? 1 + random_int(0, 7) / 8.0 : random_mantissa();
    return random_sign() * ldexp(m, random_int(low, high));
}

static double step(double x, int ulps)
{
    for (; ulps > 0; ulps--) {
        x = nextafter(x, INFINITY);
    }
    for (; ulps < 0; ulps++) {
        x = nextafter(x, -INFINITY);
    }
    return x;
}

static bool same(struct tri_point a, struct tri_point b)
{
    return a.x == b.x && a.y == b.y;
}

static bool distinct(const struct tri_point p[4])
{
    return !same(p[0], p[1]) && !same(p[0], p[2]) && !same(p[0], p[3]) && !same(p[1], p[2]) && !same(p[1], p[3]) &&
           !same(p[2], p[3]);
}

/* the oracle */

enum { N_TEMPORARIES = 24 };
static mpz_t px[4], py[4], lift[4], tmp[N_TEMPORARIES];

static int oracle_setup(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        mpz_inits(px[i], py[i], lift[i], NULL);
    }
    for (int i = 0; i < N_TEMPORARIES; i++) {
        mpz_init(tmp[i]);
    }
    return 0;
}

static int oracle_teardown(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        mpz_clears(px[i], py[i], lift[i], NULL);
    }
    for (int i = 0; i < N_TEMPORARIES; i++) {
        mpz_clear(tmp[i]);
    }
    return 0;
}

/* z = x / 2^unit, which must be an integer. */
static void set_scaled(mpz_t z, double x, int unit)
{
    int exponent;
    double mantissa = frexp(x, &exponent);
    mpz_set_d(z, ldexp(mantissa, 53));
    if (exponent - 53 >= unit) {
        mpz_mul_2exp(z, z, (mp_bitcnt_t)(exponent - 53 - unit));
    } else {
        assert_true(mpz_divisible_2exp_p(z, (mp_bitcnt_t)(unit - exponent + 53)));
        mpz_tdiv_q_2exp(z, z, (mp_bitcnt_t)(unit - exponent + 53));
    }
}

static int least_unit(int n, const struct tri_point *p)
{
    int unit = INT32_MAX;
    for (int i = 0; i < 2 * n; i++) {
        double x = i % 2 ? p[i / 2].y : p[i / 2].x;
        int exponent;
        (void)frexp(x, &exponent);
        if (x != 0 && exponent - 53 < unit) {
            unit = exponent - 53;
        }
    }
    return unit == INT32_MAX ? 0 : unit;
}

static void load(int n, const struct tri_point *p)
{
    int unit = least_unit(n, p);
    for (int i = 0; i < n; i++) {
        set_scaled(px[i], p[i].x, unit);
        set_scaled(py[i], p[i].y, unit);
    }
}

/* minor = (px[j] - px[i]) (py[k] - py[i]) - (py[j] - py[i]) (px[k] - px[i]). Uses tmp[16..19]. */
static void oracle_minor(mpz_t minor, int i, int j, int k)
{
    mpz_sub(tmp[16], px[j], px[i]);
    mpz_sub(tmp[17], py[k], py[i]);
    mpz_sub(tmp[18], py[j], py[i]);
    mpz_sub(tmp[19], px[k], px[i]);
    mpz_mul(minor, tmp[16], tmp[17]);
    mpz_submul(minor, tmp[18], tmp[19]);
}

static int oracle_orient(struct tri_point a, struct tri_point b, struct tri_point c)
{
    struct tri_point p[3] = {a, b, c};
    load(3, p);
    oracle_minor(tmp[0], 0, 1, 2);
    return mpz_sgn(tmp[0]);
}

/* The 4 x 4 determinant with rows x, y, lift, 1, expanded by the lifts. The coordinates must be loaded. Uses
   tmp[1..4]. */
static int determinant_of_lifts(void)
{
    oracle_minor(tmp[1], 1, 2, 3);
    oracle_minor(tmp[2], 0, 2, 3);
    oracle_minor(tmp[3], 0, 1, 3);
    oracle_minor(tmp[4], 0, 1, 2);
    mpz_mul(tmp[0], lift[0], tmp[1]);
    mpz_submul(tmp[0], lift[1], tmp[2]);
    mpz_addmul(tmp[0], lift[2], tmp[3]);
    mpz_submul(tmp[0], lift[3], tmp[4]);
    return mpz_sgn(tmp[0]);
}

static void set_lifts(void)
{
    for (int i = 0; i < 4; i++) {
        mpz_mul(lift[i], px[i], px[i]);
        mpz_addmul(lift[i], py[i], py[i]);
    }
}

static int oracle_incircle(const struct tri_point p[4])
{
    load(4, p);
    set_lifts();
    return determinant_of_lifts();
}

static int lexicographic_rank(const struct tri_point p[4], int i)
{
    int rank = 0;
    for (int k = 0; k < 4; k++) {
        rank += p[k].x < p[i].x || (p[k].x == p[i].x && p[k].y < p[i].y);
    }
    return rank;
}

/* With ties broken: lifts are raised by 2^(gap (rank - 4)) units, where 2^gap exceeds any ratio of minors. */
static bool oracle_in_circle(const struct tri_point p[4])
{
    int sign = oracle_incircle(p);
    if (sign != 0) {
        return sign > 0;
    }
    mp_bitcnt_t bits = 0;
    for (int i = 0; i < 4; i++) {
        mp_bitcnt_t n = mpz_sizeinbase(px[i], 2) + mpz_sizeinbase(py[i], 2);
        bits = n > bits ? n : bits;
    }
    mp_bitcnt_t gap = 2 * bits + 8;
    for (int i = 0; i < 4; i++) {
        mpz_mul_2exp(lift[i], lift[i], 4 * gap);
        mpz_setbit(lift[i], gap * (mp_bitcnt_t)lexicographic_rank(p, i));
    }
    return determinant_of_lifts() > 0;
}

static int sign_of(double x)
{
    return (x > 0) - (x < 0);
}

static void check_orient(struct tri_point a, struct tri_point b, struct tri_point c)
{
    int sign = oracle_orient(a, b, c);
    assert_int_equal(sign_of(tri_orient2d(a, b, c)), sign);
    assert_int_equal(sign_of(tri_orient2d_near(a, b, c)), sign);
    assert_int_equal(sign_of(tri_turn(c, a, c, b)), sign);
    assert_int_equal(sign_of(tri_turn_near(c, a, c, b)), sign);
}

static int oracle_dot(struct tri_point a, struct tri_point b, struct tri_point c)
{
    struct tri_point p[3] = {a, b, c};
    load(3, p);
    for (int k = 0; k < 2; k++) {
        mpz_sub(tmp[1 + 2 * k], px[k], px[2]);
        mpz_sub(tmp[2 + 2 * k], py[k], py[2]);
    }
    mpz_mul(tmp[0], tmp[1], tmp[3]);
    mpz_addmul(tmp[0], tmp[2], tmp[4]);
    return mpz_sgn(tmp[0]);
}

static void check_dot(struct tri_point a, struct tri_point b, struct tri_point c)
{
    int sign = oracle_dot(a, b, c);
    assert_int_equal(sign_of(tri_dot(a, b, c)), sign);
    assert_int_equal(sign_of(tri_dot_near(a, b, c)), sign);
}

static bool collinear(const struct tri_point p[4])
{
    return oracle_orient(p[0], p[1], p[2]) == 0 && oracle_orient(p[0], p[1], p[3]) == 0;
}

/* Returns the sign of the determinant. */
static int check_incircle(const struct tri_point p[4])
{
    int sign = oracle_incircle(p);
    assert_int_equal(sign_of(tri_incircle(p[0], p[1], p[2], p[3])), sign);
    assert_int_equal(sign_of(tri_incircle_near(p[0], p[1], p[2], p[3])), sign);
    if (distinct(p)) {
        bool inside = sign == 0 ? oracle_in_circle(p) : sign > 0;
        assert_int_equal(tri_in_circle(p[0], p[1], p[2], p[3]), inside);
        assert_int_equal(tri_in_circle_near(p[0], p[1], p[2], p[3]), inside);
    }
    return sign;
}

/* families of points */

static struct tri_point random_point(int low, int high)
{
    return (struct tri_point){random_double(low, high), random_double(low, high)};
}

static void shuffle(struct tri_point p[4])
{
    for (int i = 3; i > 0; i--) {
        int k = random_int(0, i);
        struct tri_point t = p[i];
        p[i] = p[k];
        p[k] = t;
    }
}

/* A random point with integer coordinates on the circle about 0 with radius 5 * 13 * 17 * ... (n_primes factors). The
   point is a Gaussian integer, a product of squares and norms of the primes' factors. */
static struct tri_point lattice_circle_point(int n_primes)
{
    static const int64_t factor[9][2] = {{2, 1}, {3, 2}, {4, 1}, {5, 2}, {6, 1}, {5, 4}, {7, 2}, {6, 5}, {8, 3}};
    int64_t x = 1, y = 0;
    for (int i = 0; i < n_primes; i++) {
        int64_t u = factor[i][0], v = factor[i][1];
        int kind = random_int(-1, 1);
        int64_t re = kind ? u * u - v * v : u * u + v * v, im = kind * 2 * u * v, next_x = x * re - y * im;
        y = x * im + y * re;
        x = next_x;
    }
    if (random_bits() & 1) {
        int64_t t = x;
        x = y;
        y = t;
    }
    return (struct tri_point){random_sign() * (double)x, random_sign() * (double)y};
}

/* One of the eight images of (x, y) under the symmetries of the square. All lie on one circle about 0. */
static struct tri_point symmetric_point(double x, double y)
{
    double u = random_sign() * x, v = random_sign() * y;
    return random_bits() & 1 ? (struct tri_point){u, v} : (struct tri_point){v, u};
}

static void transform(struct tri_point p[4], double scale, double dx, double dy)
{
    for (int i = 0; i < 4; i++) {
        p[i] = (struct tri_point){(p[i].x + dx) * scale, (p[i].y + dy) * scale};
    }
}

static void perturb(struct tri_point p[4], int ulps)
{
    for (int i = 0; i < 4; i++) {
        p[i] = (struct tri_point){step(p[i].x, random_int(-ulps, ulps)), step(p[i].y, random_int(-ulps, ulps))};
    }
}

/* Points that are exactly cocircular by construction, from small integers to coordinates that use the whole range. */
static void cocircular_points(struct tri_point p[4])
{
    int kind = random_int(0, 3), n_primes = random_int(1, 9);
    double x = random_double(-100, 100), y = random_double(-100, 100);
    double width = random_double(-3, 3), height = width * random_mantissa();
    for (int i = 0; i < 4; i++) {
        if (kind == 0) {
            p[i] = lattice_circle_point(n_primes);
        } else if (kind == 1) {
            p[i] = symmetric_point(x, y);
        } else if (kind == 2) {
            p[i] = symmetric_point(width, height);
        } else {
            p[i] = (struct tri_point){i & 1 ? x : width, i & 2 ? y : -x};
        }
    }
    if (kind == 0) {
        transform(p, ldexp(1, random_int(-200, 100)), random_int(-1000000, 1000000), random_int(-1000000, 1000000));
    }
    shuffle(p);
}

/* arithmetic */

static void test_doubles_are_ieee_without_contraction(void **state)
{
    (void)state;
    volatile double a = 1 + 0x1p-30, b = a * a, least = DBL_MIN, half = least / 2;
    assert_true(a * a - b == 0);
    assert_true(half > 0 && half * 2 == least);
    assert_true(1 + 0x1p-53 == 1 && (1 + 0x1p-52) + 0x1p-53 == 1 + 0x1p-51);
}

/* The sum of e in units of 2^-1074. */
static void exact_sum(mpz_t z, int n, const double *e)
{
    mpz_set_ui(z, 0);
    for (int i = 0; i < n; i++) {
        set_scaled(tmp[20], e[i], -1074);
        mpz_add(z, z, tmp[20]);
    }
}

static void test_two_sum_and_two_product_are_exact(void **state)
{
    (void)state;
    for (int i = 0; i < 20000; i++) {
        double a = random_double(-260, 200), b = random_double(-260, 200);
        struct tri_pair s = tri_two_sum(a, b), p = tri_two_product(a, b);
        double sum[2] = {s.tail, s.head}, product[2] = {p.tail, p.head}, terms[2] = {a, b};
        assert_true(s.head == a + b && p.head == a * b);
        exact_sum(tmp[0], 2, sum);
        exact_sum(tmp[1], 2, terms);
        assert_int_equal(mpz_cmp(tmp[0], tmp[1]), 0);
        set_scaled(tmp[0], a, -537);
        set_scaled(tmp[1], b, -537);
        mpz_mul(tmp[0], tmp[0], tmp[1]);
        exact_sum(tmp[1], 2, product);
        assert_int_equal(mpz_cmp(tmp[0], tmp[1]), 0);
    }
}

/* An expansion, compressed to at most max components. Returns its length. */
static int random_expansion(int max, double *e)
{
    double sum[2 * TRI_EXPANSION_FACTOR];
    int n = 0;
    for (int i = 0; i < max / 2; i++) {
        double pair[2];
        int m = tri_expansion_of_pair(tri_two_sum(random_double(-250, 150), random_double(-250, 150)), pair);
        n = tri_expansion_sum(n, e, m, pair, sum);
        memcpy(e, sum, (size_t)n * sizeof *e);
    }
    return tri_expansion_compress(n, e, e);
}

static void assert_dominated(int n, const double *e)
{
    assert_true(tri_expansion_is_increasing(n, e));
    if (n > 1) {
        exact_sum(tmp[0], n - 1, e);
        exact_sum(tmp[1], 1, e + n - 1);
        assert_true(mpz_cmpabs(tmp[0], tmp[1]) < 0);
    }
}

static void test_expansion_product_is_exact_and_ordered(void **state)
{
    (void)state;
    double e[16], f[16], h[512];
    for (int i = 0; i < 3000; i++) {
        int m = random_expansion(random_int(0, 16), e), n = random_expansion(random_int(0, 16), f);
        int k = tri_expansion_product(m, e, n, f, h);
        assert_dominated(k, h);
        exact_sum(tmp[0], m, e);
        exact_sum(tmp[1], n, f);
        mpz_mul(tmp[0], tmp[0], tmp[1]);
        exact_sum(tmp[1], k, h);
        mpz_mul_2exp(tmp[1], tmp[1], 1074);
        assert_int_equal(mpz_cmp(tmp[0], tmp[1]), 0);
        assert_int_equal(sign_of(tri_expansion_value(k, h)), mpz_sgn(tmp[0]));
    }
}

static void test_expansion_compress_keeps_the_value(void **state)
{
    (void)state;
    for (int i = 0; i < 5000; i++) {
        double e[4], f[4], sum[8], h[8];
        int m = random_expansion(4, e), n = random_expansion(4, f);
        int k = tri_expansion_sum(m, e, n, f, sum), length = tri_expansion_compress(k, sum, h);
        assert_dominated(k, sum);
        assert_dominated(length, h);
        assert_true(length <= k);
        exact_sum(tmp[2], k, sum);
        exact_sum(tmp[3], length, h);
        assert_int_equal(mpz_cmp(tmp[2], tmp[3]), 0);
    }
}

/* orientation */

static void test_orient2d_random(void **state)
{
    (void)state;
    for (int i = 0; i < 20000; i++) {
        int low = random_int(-216, 199), high = random_int(low, 199);
        check_orient(random_point(low, high), random_point(low, high), random_point(low, high));
    }
}

/* 256 x 256 neighbours, one ulp apart, of a point on the line through two other points. */
static void test_orient2d_grid_of_ulps(void **state)
{
    (void)state;
    struct tri_point b = {12, 12}, c = {24, 24};
    for (int i = 0; i < 256; i++) {
        for (int k = 0; k < 256; k++) {
            struct tri_point a = {0.5 + i * 0x1p-53, 0.5 + k * 0x1p-53};
            int sign = (k > i) - (k < i); /* above the diagonal, a lies to the left of b -> c */
            assert_int_equal(sign_of(tri_orient2d(a, b, c)), -sign_of(tri_orient2d(b, a, c)));
            assert_int_equal(sign_of(tri_orient2d(c, a, b)), sign_of(tri_orient2d(a, b, c)));
            check_orient(a, b, c);
            assert_int_equal(sign_of(tri_orient2d(a, b, c)), sign);
        }
    }
}

static void test_orient2d_near_a_line(void **state)
{
    (void)state;
    for (int i = 0; i < 40000; i++) {
        int exponent = random_int(-160, 140);
        struct tri_point a = random_point(exponent, exponent + 40), b = random_point(exponent, exponent + 40), c;
        double t = random_double(-10, 2);
        c = (struct tri_point){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
        check_orient(a, b, c);
        c.x = step(c.x, random_int(-2, 2));
        check_orient(c, a, b);
    }
}

/* Right angles with errors of a few ulps, and random vectors. */
static void test_dot(void **state)
{
    (void)state;
    for (int i = 0; i < 40000; i++) {
        int low = random_int(-216, 199), high = random_int(low, 199), exponent = random_int(-160, 140);
        check_dot(random_point(low, high), random_point(low, high), random_point(low, high));
        struct tri_point a = random_point(exponent, exponent + 40), c = random_point(exponent, exponent + 40), b;
        double t = random_double(-10, 2);
        b = (struct tri_point){c.x - t * (a.y - c.y), c.y + t * (a.x - c.x)};
        check_dot(a, b, c);
        b.x = step(b.x, random_int(-2, 2));
        check_dot(b, a, c);
    }
}

/* Multiples of one vector by powers of two, with all signs: collinear, with low parts that no filter resolves. */
static void test_orient2d_collinear_in_the_whole_range(void **state)
{
    (void)state;
    for (int i = 0; i < 20000; i++) {
        double x = random_double(-60, 60), y = random_double(-60, 60);
        struct tri_point p[3];
        for (int k = 0; k < 3; k++) {
            double scale = random_sign() * ldexp(1, random_int(-150, 130));
            p[k] = (struct tri_point){x * scale, y * scale};
        }
        assert_true(tri_orient2d(p[0], p[1], p[2]) == 0 && tri_orient2d_near(p[2], p[0], p[1]) == 0);
        p[0].y = step(p[0].y, random_int(-1, 1));
        check_orient(p[0], p[1], p[2]);
    }
}

static void test_orient2d_small_integers(void **state)
{
    (void)state;
    for (int i = 0; i < 729; i++) {
        struct tri_point a = {i % 3, i / 3 % 3}, b = {i / 9 % 3, i / 27 % 3}, c = {i / 81 % 3, i / 243};
        check_orient(a, b, c);
    }
}

/* in-circle */

static void test_incircle_random(void **state)
{
    (void)state;
    for (int i = 0; i < 30000; i++) {
        int low = random_int(-216, 199), high = random_int(low, 199);
        struct tri_point p[4] = {random_point(low, high), random_point(low, high), random_point(low, high),
                                 random_point(low, high)};
        check_incircle(p);
    }
}

static void test_incircle_grid_of_ulps(void **state)
{
    (void)state;
    for (int i = 0; i < 128; i++) {
        for (int k = 0; k < 256; k++) {
            struct tri_point p[4] = {{0.5 + i * 0x1p-53, 0.5 + k * 0x1p-53}, {12.5, 0.5}, {12.5, 12.5}, {0.5, 12.5}};
            check_incircle(p);
        }
    }
}

static void test_incircle_cocircular(void **state)
{
    (void)state;
    for (int i = 0; i < 40000; i++) {
        struct tri_point p[4];
        cocircular_points(p);
        assert_int_equal(check_incircle(p), 0);
    }
}

static void test_incircle_near_a_circle(void **state)
{
    (void)state;
    for (int i = 0; i < 40000; i++) {
        struct tri_point p[4];
        cocircular_points(p);
        perturb(p, random_int(1, 3));
        check_incircle(p);
    }
}

/* Rounded points of a circle, and of a grid with spacing 0.1: never exactly cocircular, always nearly so. */
static void test_incircle_rounded_circle_and_grid(void **state)
{
    (void)state;
    for (int i = 0; i < 30000; i++) {
        struct tri_point p[4];
        double radius = random_double(-5, 5), dx = random_double(-2, 8), dy = random_double(-2, 8);
        for (int k = 0; k < 4; k++) {
            double angle = random_int(0, 63) * 0.09817477042468103; /* pi / 32 */
            p[k] = i % 2 ? (struct tri_point){dx + radius * cos(angle), dy + radius * sin(angle)}
                         : (struct tri_point){random_int(0, 12) * 0.1, random_int(0, 12) * 0.1};
        }
        check_incircle(p);
    }
}

static void test_incircle_integers(void **state)
{
    (void)state;
    for (int i = 0; i < 40000; i++) {
        struct tri_point p[4];
        int bits = random_int(1, 27), size = bits < 12 ? 5 : 1 << bits; /* also around the limit of 25 bits */
        for (int k = 0; k < 4; k++) {
            p[k] = (struct tri_point){random_int(-size, size), random_int(-size, size)};
        }
        check_incircle(p);
    }
}

/* Nearly cocircular integers whose determinant is tiny compared with its terms: points of a lattice circle, moved by
   1. */
static void test_incircle_integers_off_a_circle_by_one(void **state)
{
    (void)state;
    for (int i = 0; i < 40000; i++) {
        struct tri_point p[4];
        int n_primes = random_int(3, 8);
        for (int k = 0; k < 4; k++) {
            p[k] = lattice_circle_point(n_primes);
        }
        p[random_int(0, 3)].x += random_int(-1, 1);
        transform(p, ldexp(1, random_int(-216, 100)), random_int(-9, 9), random_int(-9, 9));
        check_incircle(p);
    }
}

/* The ends of the range: smallest and largest coordinates, one ulp apart. */
static void test_incircle_ends_of_the_range(void **state)
{
    (void)state;
    for (int i = 0; i < 20000; i++) {
        struct tri_point p[4];
        double low = step(0x1p-216, random_int(0, 3)), high = step(0x1p200, -random_int(0, 3));
        for (int k = 0; k < 4; k++) {
            double x = random_bits() & 1 ? low : high, y = i % 3 == 0 ? x : i % 3 == 1 ? low : high;
            p[k] = symmetric_point(step(x, random_int(0, 1) * (x < 1 ? 1 : -1)), i % 5 ? y : 0);
            assert_true(tri_is_exact_coordinate(p[k].x) && tri_is_exact_coordinate(p[k].y));
        }
        check_incircle(p);
    }
    assert_false(tri_is_exact_coordinate(step(0x1p-216, -1)) || tri_is_exact_coordinate(-step(0x1p200, 1)));
    assert_false(tri_is_exact_coordinate(NAN));
    assert_true(TRI_LEAST_COORDINATE == 0x1p-216);
}

/* Products of the lowest bits reach 2^-1072. A filter in which they underflow would call these points cocircular. */
static void test_incircle_least_determinant(void **state)
{
    (void)state;
    double u = 0x1p-268, x = 0x1p-216 + 4 * u;
    struct tri_point unit[4] = {{x, x}, {x + u, x}, {x + u, x + u}, {x, x + u}};
    assert_int_equal(check_incircle(unit), 0);
    for (int i = 0; i < 4; i++) {
        struct tri_point p[4] = {unit[0], unit[1], unit[2], unit[3]};
        p[i].x += i == 0 || i == 3 ? u : -u;
        check_incircle(p);
        p[i].y += i < 2 ? 2 * u : -2 * u;
        assert_int_not_equal(check_incircle(p), 0);
    }
}

/* symmetry and ties */

static const int permutation[24][4] = {
    {0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 0, 3, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 0, 1, 3},
    {2, 1, 3, 0}, {2, 3, 0, 1}, {3, 0, 2, 1}, {3, 1, 0, 2}, {3, 2, 1, 0}, /* even permutations up to here, odd ones from
                                                                             here on */
    {0, 1, 3, 2}, {0, 2, 1, 3}, {0, 3, 2, 1}, {1, 0, 2, 3}, {1, 2, 3, 0}, {1, 3, 0, 2}, {2, 0, 3, 1},
    {2, 1, 0, 3}, {2, 3, 1, 0}, {3, 0, 1, 2}, {3, 1, 2, 0}, {3, 2, 0, 1}};

/* The points p are distinct and not all collinear, since for collinear points all answers are false and do not
   alternate. */
static void check_permutations(const struct tri_point p[4])
{
    double det = tri_incircle(p[0], p[1], p[2], p[3]);
    bool inside = tri_in_circle(p[0], p[1], p[2], p[3]);
    for (int i = 0; i < 24; i++) {
        const int *k = permutation[i];
        struct tri_point a = p[k[0]], b = p[k[1]], c = p[k[2]], d = p[k[3]];
        int parity = i < 12 ? 1 : -1;
        assert_int_equal(sign_of(tri_incircle(a, b, c, d)), parity * sign_of(det));
        assert_int_equal(tri_in_circle(a, b, c, d), (parity > 0) == inside);
        assert_int_equal(tri_in_circle_near(a, b, c, d), (parity > 0) == inside);
    }
}

static void test_in_circle_alternates_over_all_namings(void **state)
{
    (void)state;
    for (int i = 0; i < 4000; i++) {
        struct tri_point p[4];
        cocircular_points(p);
        if (i % 2) {
            perturb(p, 1);
        }
        if (distinct(p) && !collinear(p)) {
            check_permutations(p);
        }
    }
}

/* Is the diagonal from a to c Delaunay in the convex quadrilateral a, b, c, d? Both triangles must give the same answer
   for every order of their corners. */
static bool is_diagonal(struct tri_point a, struct tri_point b, struct tri_point c, struct tri_point d)
{
    bool valid = !tri_in_circle(a, b, c, d);
    assert_true(valid == !tri_in_circle(b, c, a, d) && valid == !tri_in_circle(c, a, b, d));
    assert_true(valid == !tri_in_circle(c, d, a, b) && valid == !tri_in_circle(d, a, c, b));
    assert_true(valid == !tri_in_circle(a, c, d, b) && valid == !tri_in_circle_near(a, c, d, b));
    return valid;
}

static void test_in_circle_gives_one_diagonal(void **state)
{
    (void)state;
    int n_convex = 0;
    for (int i = 0; i < 20000; i++) {
        struct tri_point p[4];
        cocircular_points(p);
        struct tri_point a = p[0], b = p[1], c = p[2], d = p[3];
        bool convex = tri_orient2d(a, b, c) > 0 && tri_orient2d(b, c, d) > 0 && tri_orient2d(c, d, a) > 0;
        if (convex && tri_orient2d(d, a, b) > 0) {
            assert_true(is_diagonal(a, b, c, d) != is_diagonal(b, c, d, a));
            n_convex++;
        }
    }
    assert_true(n_convex > 1000);
}

static void test_in_circle_of_a_unit_square(void **state)
{
    (void)state;
    struct tri_point a = {0, 0}, b = {1, 0}, c = {1, 1}, d = {0, 1};
    /* (1, 1) is the largest point, so its lift is raised most. The diagonal between its neighbours cuts it off. */
    assert_true(is_diagonal(b, c, d, a));
    assert_false(is_diagonal(a, b, c, d));
}

static void test_in_circle_of_collinear_points_is_false(void **state)
{
    (void)state;
    struct tri_point p[4] = {{0, 0}, {1, 2}, {2, 4}, {3, 6}};
    for (int i = 0; i < 24; i++) {
        const int *k = permutation[i];
        assert_true(tri_incircle(p[k[0]], p[k[1]], p[k[2]], p[k[3]]) == 0);
        assert_false(tri_in_circle(p[k[0]], p[k[1]], p[k[2]], p[k[3]]));
    }
}

static bool is_empty(int n, const struct tri_point *p, int i, int j, int k)
{
    for (int m = 0; m < n; m++) {
        if (m != i && m != j && m != k && tri_in_circle(p[i], p[j], p[k], p[m])) {
            return false;
        }
    }
    return true;
}

/* Lists triangles with empty circles, with ties broken. *twice_area: the sum of their doubled areas. */
static int count_delaunay(int n, const struct tri_point *p, double *twice_area)
{
    int count = 0;
    *twice_area = 0;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            for (int k = i + 1; j > i && k < n; k++) {
                double area = tri_orient2d(p[i], p[j], p[k]);
                if (k != j && area > 0 && is_empty(n, p, i, j, k)) {
                    count++;
                    *twice_area += area;
                }
            }
        }
    }
    return count;
}

/* n points, h of them on the border of the hull, give 2n - 2 - h triangles if ties never leave a gap or an overlap. */
static void test_in_circle_triangulates_an_integer_grid(void **state)
{
    (void)state;
    struct tri_point p[25];
    double twice_area;
    for (int i = 0; i < 25; i++) {
        p[i] = (struct tri_point){i * 7 % 25 % 5, i * 7 % 25 / 5};
    }
    assert_int_equal(count_delaunay(25, p, &twice_area), 2 * 25 - 2 - 16);
    assert_true(twice_area == 32);
}

static void test_in_circle_triangulates_a_cocircular_polygon(void **state)
{
    (void)state;
    struct tri_point p[12] = {{25, 0},  {24, 7},  {20, 15},  {15, 20},  {7, 24},  {0, 25},
                              {-7, 24}, {-25, 0}, {-24, -7}, {-7, -24}, {0, -25}, {15, -20}};
    double twice_area, twice_polygon = 0;
    for (int i = 0; i < 12; i++) {
        struct tri_point q = p[i], r = p[(i + 1) % 12];
        twice_polygon += q.x * r.y - q.y * r.x;
    }
    assert_int_equal(count_delaunay(12, p, &twice_area), 10);
    assert_true(twice_area == twice_polygon);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_doubles_are_ieee_without_contraction),
        cmocka_unit_test(test_two_sum_and_two_product_are_exact),
        cmocka_unit_test(test_expansion_product_is_exact_and_ordered),
        cmocka_unit_test(test_expansion_compress_keeps_the_value),
        cmocka_unit_test(test_orient2d_random),
        cmocka_unit_test(test_orient2d_grid_of_ulps),
        cmocka_unit_test(test_orient2d_near_a_line),
        cmocka_unit_test(test_dot),
        cmocka_unit_test(test_orient2d_collinear_in_the_whole_range),
        cmocka_unit_test(test_orient2d_small_integers),
        cmocka_unit_test(test_incircle_random),
        cmocka_unit_test(test_incircle_grid_of_ulps),
        cmocka_unit_test(test_incircle_cocircular),
        cmocka_unit_test(test_incircle_near_a_circle),
        cmocka_unit_test(test_incircle_rounded_circle_and_grid),
        cmocka_unit_test(test_incircle_integers),
        cmocka_unit_test(test_incircle_integers_off_a_circle_by_one),
        cmocka_unit_test(test_incircle_ends_of_the_range),
        cmocka_unit_test(test_incircle_least_determinant),
        cmocka_unit_test(test_in_circle_alternates_over_all_namings),
        cmocka_unit_test(test_in_circle_gives_one_diagonal),
        cmocka_unit_test(test_in_circle_of_a_unit_square),
        cmocka_unit_test(test_in_circle_of_collinear_points_is_false),
        cmocka_unit_test(test_in_circle_triangulates_an_integer_grid),
        cmocka_unit_test(test_in_circle_triangulates_a_cocircular_polygon),
    };
    return cmocka_run_group_tests(tests, oracle_setup, oracle_teardown);
}
