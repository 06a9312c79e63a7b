/* The order stays that of insertion, and the tree low. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "triangle/mesh/locate.h"

static int depth(const struct tri_sweep_line *order, int32_t s)
{
    int n = 0;
    for (; s >= 0; s = order->node[s].up)
        n++;
    return n;
}

static void order_is_kept_and_balanced(void **state)
{
    (void)state;
    enum { N = 5000 };
    struct tri_sweep_line order;
    assert_int_equal(tri_sweep_line_init(&order, N), TRI_OK);
    for (int32_t s = 0; s < N; s++)
        tri_sweep_line_insert(&order, s, s - 1); /* from bottom to top: the worst case of a plain tree */
    for (int32_t s = 0; s < N; s += 2)
        tri_sweep_line_remove(&order, s);
    int32_t above = -1;
    for (int32_t s = 1; s < N; s += 2) {
        above = tri_sweep_line_above(&order, above);
        assert_int_equal(above, s);
        assert_true(depth(&order, s) < 60);
    }
    assert_int_equal(tri_sweep_line_above(&order, above), -1);
    for (int32_t s = N - 1; s >= 0; s -= 2)
        tri_sweep_line_remove(&order, s);
    assert_int_equal(order.root, -1);
    tri_sweep_line_clear(&order);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(order_is_kept_and_balanced)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
