/* The set of triangles as they are, against an array. */
#include "support.h"
#include "triangle/entry_set.h"

enum { TRIANGLES = 3000 };

static void test_holds_what_was_added_last(void **state)
{
    (void)state;
    static bool added[TRIANGLES];
    static uint32_t states[TRIANGLES];
    struct support_random random = {5};
    struct tri_entry_set set = {0};
    for (int32_t k = 0; k < 20000; k++) {
        int32_t t = support_below(&random, TRIANGLES);
        uint32_t now = (uint32_t)support_below(&random, 3);
        assert_int_equal(tri_entry_set_holds(&set, (struct tri_entry){t, now}), added[t] && states[t] == now);
        if (support_below(&random, 4) > 0)
            continue;
        assert_true(tri_entry_set_add(&set, (struct tri_entry){t, now}));
        added[t] = true;
        states[t] = now;
    }
    tri_entry_set_free(&set);
    assert_false(tri_entry_set_holds(&set, (struct tri_entry){0, 0}));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_holds_what_was_added_last),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
