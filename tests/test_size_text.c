/* Sizes in messages have three digits and a suitable unit. */
#include "support.h"
#include "triangle/base/size_text.h"

static void test_units_fit(void **state)
{
    static const struct {
        double bytes;
        const char *text;
    } cases[] = {{0, "0 B"},          {62, "62 B"},         {999.4, "999 B"},     {999.6, "1 kB"},
                 {2250, "2.25 kB"},   {151e3, "151 kB"},    {9e7, "90 MB"},       {1.874e9, "1.87 GB"},
                 {999.4e9, "999 GB"}, {5.25e12, "5.25 TB"}, {3e15, "3 PB"},
                 {2e18, "2 EB"},      {1e21, "over 1000 EB"}, {HUGE_VAL, "over 1000 EB"}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_string_equal(tri_size_text(cases[i].bytes).text, cases[i].text);
}

static void test_counts_are_readable(void **state)
{
    static const struct {
        double n;
        const char *text;
    } cases[] = {{0, "0"}, {57, "57"}, {9999, "9999"}, {45200, "45.2 thousand"}, {999600, "1 million"},
                 {1.874e6, "1.87 million"}, {4.5e9, "4.5 billion"}, {9.994e14, "999 trillion"},
                 {1e15, "over 1000 trillion"}, {HUGE_VAL, "over 1000 trillion"}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_string_equal(tri_count_text(cases[i].n).text, cases[i].text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_units_fit), cmocka_unit_test(test_counts_are_readable)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
