/* The lattice point for a bad triangle, compared with a search of the lattice points around the circumcentre. */
#include "support.h"

#include "triangle/refine/lattice.h"
#include "triangle/tunables.h"

enum { TRIALS = 20000, AROUND = 3 };

static const double ROW = 0.86602540378443864676; /* sqrt(3) / 2, the height of an equilateral triangle with edges 1 */

/* A point of the lattice of equilateral triangles with edges of length `edge` and a point at the origin. */
static struct tri_point lattice_point(double edge, int64_t column, int64_t row)
{
    const double shift = row % 2 != 0 ? 0.5 : 0;
    return (struct tri_point){((double)column + shift) * edge, (double)row * ROW * edge};
}

/* Calls the tested function for a triangle and an area bound. Returns the length of the lattice's edges, or 0. */
static double chosen(const struct tri_point corner[3], double bound, struct tri_point *p)
{
    static const tri_vertex_id v[3] = {0, 1, 2};
    const struct tri_shape shape = tri_shape_of(corner, v);
    const struct tri_lattice lattice = tri_lattice_for(2 * bound);
    return tri_lattice_point(&lattice, corner, v, &shape, p) ? lattice.edge : 0;
}

/* The point with the same distance from all three corners, from the equations of two bisectors. */
static struct tri_point circumcentre(const struct tri_point c[3])
{
    const long double x = c[1].x - c[0].x, y = c[1].y - c[0].y, u = c[2].x - c[0].x, w = c[2].y - c[0].y;
    const long double l = x * x + y * y, m = u * u + w * w, twice = 2 * (x * w - y * u);
    return (struct tri_point){(double)(c[0].x + (l * w - m * y) / twice), (double)(c[0].y + (m * x - l * u) / twice)};
}

/* The nearest lattice point in the row nearest to `at`. */
static struct tri_point nearest_in_row(double edge, struct tri_point at)
{
    const int64_t row = llround(at.y / (ROW * edge)), column = llround(at.x / edge);
    struct tri_point best = {HUGE_VAL, HUGE_VAL};
    for (int64_t j = row - AROUND; j <= row + AROUND; j++)
        for (int64_t i = column - AROUND; i <= column + AROUND; i++) {
            const struct tri_point q = lattice_point(edge, i, j);
            const double up = fabs(q.y - at.y) - fabs(best.y - at.y);
            if (up < -1e-9 * edge || (up < 1e-9 * edge && fabs(q.x - at.x) < fabs(best.x - at.x)))
                best = q;
        }
    return best;
}

static bool is_lattice_point(double edge, struct tri_point p)
{
    const int64_t row = llround(p.y / (ROW * edge));
    const int64_t column = llround(p.x / edge - (row % 2 != 0 ? 0.5 : 0));
    return tri_distance2(p, lattice_point(edge, column, row)) < 1e-20 * edge * edge;
}

static double least_distance(const struct tri_point corner[3], struct tri_point p)
{
    double least = HUGE_VAL;
    for (int k = 0; k < 3; k++)
        least = fmin(least, sqrt(tri_distance2(corner[k], p)));
    return least;
}

/* A random triangle of about this size that is not flat, with corners in counter-clockwise order. */
static void draw_triangle(struct support_random *random, double size, struct tri_point corner[3])
{
    const struct tri_point at = {20 * support_unit(random) - 10, 20 * support_unit(random) - 10};
    do {
        for (int k = 0; k < 3; k++)
            corner[k] = (struct tri_point){at.x + size * support_unit(random), at.y + size * support_unit(random)};
    } while (tri_area_of(corner[0], corner[1], corner[2]) < 0.01 * size * size);
}

/* Lattice triangles are nearly as large as the bound allows, and not larger. */
static double edge_for(double bound)
{
    const double most = sqrt(bound / TRI_EQUILATERAL);
    return most * sqrt(TRI_LATTICE_SHARE);
}

static void test_nearest(void **state)
{
    (void)state;
    const double farthest = sqrt(7) / 4; /* half an edge along the row, half a row across it */
    struct support_random random = {1};
    int n_found = 0;
    for (int i = 0; i < TRIALS; i++) {
        struct tri_point corner[3], p;
        const double bound = exp2(8 * support_unit(&random) - 6);
        draw_triangle(&random, sqrt(bound) * (1 + 5 * support_unit(&random)), corner);
        const double edge = chosen(corner, bound, &p), expected = edge_for(bound);
        const struct tri_point centre = circumcentre(corner), wanted = nearest_in_row(expected, centre);
        const double from_corners = least_distance(corner, wanted) / expected;
        if (fabs(from_corners - TRI_LATTICE_APART) < 1e-6 || sqrt(tri_distance2(centre, corner[0])) > 100 * expected)
            continue; /* rounding may give either result */
        const struct tri_shape shape = tri_shape_of(corner, (const tri_vertex_id[]){0, 1, 2});
        const double reach2 = TRI_LATTICE_REACH * tri_longest2(&shape), far2 = tri_distance2(corner[0], wanted);
        if (fabs(far2 - reach2) < 1e-6 * reach2)
            continue;
        assert_true((edge > 0) == (from_corners > TRI_LATTICE_APART && far2 < reach2));
        if (edge == 0)
            continue;
        n_found++;
        assert_true(fabs(edge - expected) < 1e-12 * expected && TRI_EQUILATERAL * edge * edge < bound);
        assert_true(is_lattice_point(edge, p));
        assert_true(sqrt(tri_distance2(p, centre)) < farthest * edge * (1 + 1e-9));
        /* in the middle between two points, either point is fine */
        assert_true(fabs(tri_distance2(p, centre) - tri_distance2(wanted, centre)) < 1e-7 * edge * edge);
    }
    assert_in_range(n_found, TRIALS / 4, TRIALS * 9 / 10);
}

/* Two triangles whose corners are lattice points, and one that is shifted until a corner is too close to a lattice
 * point. */
static void test_corners_too_near(void **state)
{
    (void)state;
    const double bound = 0.3, edge = edge_for(bound);
    const struct tri_point small[3] = {lattice_point(edge, 0, 0), lattice_point(edge, 1, 0), lattice_point(edge, 0, 1)};
    const struct tri_point large[3] = {lattice_point(edge, 0, 0), lattice_point(edge, 2, 0), lattice_point(edge, 1, 2)};
    struct tri_point p;
    assert_true(chosen(small, bound, &p) == 0); /* its corners are the nearest lattice points */
    assert_true(chosen(large, bound, &p) > 0);  /* the middle of its longest edge, or as far away */
    for (int k = 0; k < 2; k++) {
        const double away = TRI_LATTICE_APART + (k == 0 ? -1e-3 : 1e-3);
        const struct tri_point centre = lattice_point(edge, 3, 5);
        struct tri_point corner[3] = {{centre.x + away * edge, centre.y}, {centre.x, centre.y + away * edge},
                                      {centre.x - away * edge, centre.y}};
        assert_true((chosen(corner, bound, &p) > 0) == (k == 1));
        assert_true(sqrt(tri_distance2(p, centre)) < 1e-9 * edge);
    }
}

static void test_no_bound(void **state)
{
    (void)state;
    const struct tri_point corner[3] = {{0, 0}, {9, 0}, {0, 9}};
    struct tri_point p;
    assert_true(chosen(corner, HUGE_VAL, &p) == 0);
    assert_true(chosen(corner, 0.1, &p) > 0);
}

/* The lattice is the same far from the origin, on both sides of it, and in any unit of length. */
static void test_same_lattice_everywhere(void **state)
{
    (void)state;
    const double bound = 1 / TRI_LATTICE_SHARE;
    const double edge = edge_for(bound);
    for (int scale = -40; scale <= 40; scale += 40)
        for (int64_t row = -5; row <= 5; row++)
            for (int64_t column = -5; column <= 5; column++) {
                const struct tri_point centre = lattice_point(edge, column, row);
                struct tri_point corner[3] = {{2, -1}, {-1, 2}, {-2, -1}}, p; /* on a circle around 0 */
                for (int k = 0; k < 3; k++) {
                    corner[k].x = ldexp(corner[k].x + centre.x, scale);
                    corner[k].y = ldexp(corner[k].y + centre.y, scale);
                }
                const double found = chosen(corner, ldexp(bound, 2 * scale), &p);
                assert_true(fabs(found - ldexp(edge, scale)) < 1e-12 * found);
                assert_true(fabs(p.x - ldexp(centre.x, scale)) < 1e-12 * found);
                assert_true(fabs(p.y - ldexp(centre.y, scale)) < 1e-12 * found);
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nearest),
        cmocka_unit_test(test_corners_too_near),
        cmocka_unit_test(test_no_bound),
        cmocka_unit_test(test_same_lattice_everywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
