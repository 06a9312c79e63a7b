/* The ordered list keeps the order of insertion, and searches take logarithmic time. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "triangle/base/order.h"

static uint64_t state_of_random = 1;

static uint32_t random_below(uint32_t n)
{
    state_of_random = state_of_random * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (uint32_t)(state_of_random >> 33) % n;
}

static bool is_below_limit(const void *user, int32_t s)
{
    return s < *(const int32_t *)user;
}

/* In list order the items are 0, 1, 2, ...; `in` marks the items in the list. */
static void assert_order(const struct tri_order *order, const bool *in, int32_t n)
{
    int32_t at = -1;
    for (int32_t s = 0; s < n; s++) {
        assert_int_equal(tri_order_find(order, is_below_limit, &s), at);
        if (!in[s])
            continue;
        assert_int_equal(tri_order_above(order, at), s);
        at = s;
    }
    assert_int_equal(tri_order_above(order, at), -1);
}

static void order_is_kept(void **state)
{
    (void)state;
    enum { N = 300 };
    struct tri_order order;
    bool in[N] = {false};
    assert_int_equal(tri_order_init(&order, N), TRI_OK);
    for (int i = 0; i < 20000; i++) {
        int32_t s = (int32_t)random_below(N), below = s - 1;
        while (below >= 0 && !in[below])
            below--;
        if (in[s])
            tri_order_remove(&order, s);
        else
            tri_order_insert(&order, s, below);
        in[s] = !in[s];
        if (i % 100 == 0)
            assert_order(&order, in, N);
    }
    tri_order_clear(&order);
}

static int asked;

static bool count_and_compare(const void *user, int32_t s)
{
    asked++;
    return is_below_limit(user, s);
}

static void order_is_searched_in_logarithmic_time(void **state)
{
    (void)state;
    enum { N = 1 << 16 };
    struct tri_order order;
    assert_int_equal(tri_order_init(&order, N), TRI_OK);
    for (int32_t s = 0; s < N; s++)
        tri_order_insert(&order, s, s - 1); /* from bottom to top, the worst case for an unbalanced tree */
    for (int32_t s = 0; s < N; s++)
        assert_int_equal(tri_order_find(&order, count_and_compare, &s), s - 1);
    assert_true(asked < 40 * N);
    tri_order_clear(&order);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(order_is_kept),
        cmocka_unit_test(order_is_searched_in_logarithmic_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
