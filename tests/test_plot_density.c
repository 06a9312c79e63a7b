/* Densities of a picture. Each pixel whose centre lies in a large triangle gets its share, and no other pixel does.
   Small triangles are counted one by one. Triangles outside the picture and those without finite coordinates are
   omitted. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#include "drivers/plot/plot.h"

enum { WIDTH = 40, HEIGHT = 30 };

static double count[WIDTH * HEIGHT];

/* An empty picture of [0, 4] x [0, 3] with ten pixels per unit. */
static struct plot_density empty_picture(void)
{
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        count[i] = 0;
    return (struct plot_density){WIDTH, HEIGHT, {0, 0, 4, 3}, count};
}

static void add(struct plot_density *d, double ax, double ay, double bx, double by, double cx, double cy)
{
    const double a[2] = {ax, ay}, b[2] = {bx, by}, c[2] = {cx, cy};
    const double *const at[3] = {a, b, c};
    plot_density_add(d, at);
}

static double sum(void)
{
    double all = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        all += count[i];
    return all;
}

static void test_two_large_triangles_fill_the_picture(void **state)
{
    (void)state;
    struct plot_density d = empty_picture();
    add(&d, 0, 0, 4, 0, 4, 3);
    add(&d, 0, 0, 4, 3, 0, 3);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        assert_true(count[i] > 0.99 / 600 && count[i] < 1.01 / 600);
    d = empty_picture();
    add(&d, -100, -100, 100, -100, 0, 300); /* the picture lies inside the triangle */
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        assert_true(count[i] > 0 && count[i] == count[0]);
}

static void test_a_triangle_covers_the_right_pixels(void **state)
{
    (void)state;
    struct plot_density d = empty_picture();
    add(&d, 1, 1, 2, 1, 1, 2); /* rows count from the top: rows 10 to 19 */
    for (int row = 0; row < HEIGHT; row++)
        for (int column = 0; column < WIDTH; column++) {
            const double x = column + 0.5 - 10, y = HEIGHT - row - 0.5 - 10, edge = 10 - x - y;
            if (fabs(edge) > 1e-9)
                assert_true((count[row * WIDTH + column] > 0) == (x > 0 && y > 0 && edge > 0));
        }
}

static void test_small_triangles_are_counted(void **state)
{
    (void)state;
    struct plot_density d = empty_picture();
    for (int i = 0; i < 100; i++)
        add(&d, 2.01, 1.01, 2.02, 1.01, 2.01, 1.02);
    assert_true(count[19 * WIDTH + 20] == 100 && sum() == 100);
}

static void test_triangles_outside_are_omitted(void **state)
{
    (void)state;
    struct plot_density d = empty_picture();
    add(&d, 5, 1, 9, 1, 5, 8);
    add(&d, 1, NAN, 2, 1, 1, 2);
    add(&d, 1, 1, INFINITY, 1, 1, 2);
    add(&d, 1e308, -1e308, -1e308, 1e308, 1e308, 1e308);
    add(&d, -5, -5, -5.001, -5, -5, -5.001);
    assert_true(sum() == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_two_large_triangles_fill_the_picture),
        cmocka_unit_test(test_a_triangle_covers_the_right_pixels),
        cmocka_unit_test(test_small_triangles_are_counted),
        cmocka_unit_test(test_triangles_outside_are_omitted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
