/* Conversion between numbers and text, compared with printf and strtod. */
#include "triangle/text/decimal.h"

#include <inttypes.h>
#include <locale.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "full.h"

#define LENGTH(array) (sizeof(array) / sizeof *(array))

static uint64_t random_bits(void)
{
    static uint64_t state = 0x9E3779B97F4A7C15;
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return state;
}

static double double_of(uint64_t bits)
{
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Prints the value, compares the text with printf, and reads back the same bits. */
static void check_real(double value)
{
    char text[TRI_REAL_ROOM + 1], expected[64];
    memset(text, '!', sizeof text);
    *tri_print_real(text, value) = 0;
    const int length = snprintf(expected, sizeof expected, "%.17g", value);
    assert_string_equal(text, expected);
    assert_in_range(length, 1, TRI_REAL_CHARS);
    assert_int_equal(text[TRI_REAL_ROOM], '!');
    double back;
    assert_ptr_equal(tri_scan_real(text, text + length, &back), text + length);
    if (!isnan(value))
        assert_memory_equal(&back, &value, sizeof value);
}

static void print_real_special(void **state)
{
    (void)state;
    const double values[] = {0, -0.0, 1, -1, 10, 0.5, 0.1, -0.1, 1e16, 1e17, 1.23456789012345678e17, 1e21, 1e22, 1e23,
                             1e-4, 1e-5, 9.9999999999999995e-05, 99999999999999984, 9007199254740991, 9007199254740992,
                             0x1p53 + 2, 0x1p-1074, 0x1p-1022, 0x1.fffffffffffffp-1023, 0x1.fffffffffffffp1023,
                             1e300, 1e-300, 1e100, 1e-100, 9.5e-7, 0x1p63, 0x1p64, 1.00000762939453125,
                             3.00000762939453125, 0.99999999999999994, 5e-324, INFINITY, -INFINITY, (double)NAN};
    for (size_t i = 0; i < LENGTH(values); i++)
        check_real(values[i]);
}

static void print_real_near_powers(void **state)
{
    (void)state;
    for (int ten = -323; ten <= 308; ten++) {
        char text[16];
        snprintf(text, sizeof text, "1e%d", ten);
        const double power = strtod(text, NULL);
        check_real(power);
        check_real(nextafter(power, 0));
        check_real(nextafter(power, INFINITY));
    }
    for (int two = -1074; two <= 1023; two++) {
        check_real(ldexp(1, two));
        check_real(-nextafter(ldexp(1, two), 0));
    }
}

/* Exact ties at the 17th digit, which round to even. Numbers such as k + 2^-17 have 18 digits, the last of which is a
 * 5. */
static void print_real_ties(void **state)
{
    (void)state;
    for (int k = 1; k < 10000; k++)
        for (int two = 15; two <= 20; two++)
            check_real(k + ldexp(2 * (k % 7) + 1, -two));
}

static void print_real_random(void **state)
{
    (void)state;
    for (int i = 0; i < 700000 / every(5); i++)
        check_real(double_of(random_bits()));
    for (int i = 0; i < 300000 / every(5); i++) { /* of ordinary size, and with few digits */
        const double value = (double)(random_bits() >> 11) * 0x1p-53;
        check_real(ldexp(value, (int)(random_bits() % 70) - 20));
        check_real((double)(int64_t)(random_bits() % 2000001 - 1000000) / 1000);
    }
}

static void check_integer(int64_t value, int width)
{
    char text[64], expected[64];
    memset(text, '!', sizeof text);
    char *const end = tri_print_integer(text, value, width);
    assert_int_equal(*end, '!');
    *end = 0;
    snprintf(expected, sizeof expected, "%*" PRId64, width, value);
    assert_string_equal(text, expected);
    int64_t back;
    const char *begin = text;
    while (*begin == ' ')
        begin++;
    assert_ptr_equal(tri_scan_integer(begin, end, &back), end);
    assert_int_equal(back, value);
}

static void print_integer_all_widths(void **state)
{
    (void)state;
    const int64_t values[] = {0, 1, -1, 9, 10, 99, 100, 999, 1000, 9999, 10000, -999, -1000, 123456, INT32_MAX,
                              INT32_MIN, INT64_MAX, INT64_MIN};
    for (size_t i = 0; i < LENGTH(values); i++)
        for (int width = 0; width < 25; width++)
            check_integer(values[i], width);
    for (int i = 0; i < 100000; i++)
        check_integer((int64_t)(random_bits() >> (random_bits() % 64)), 4);
}

struct real_case {
    const char *text;
    double value;
    int length; /* number of characters read */
};

static void scan_real_table(void **state)
{
    (void)state;
    static const struct real_case cases[] = {
        {"1", 1, 1}, {"-1.5x", -1.5, 4}, {"+2", 2, 2}, {".5", .5, 2}, {"5.", 5, 2}, {"-.5e1 ", -5, 5},
        {"1e3,", 1000, 3}, {"1E-3", .001, 4}, {"1e+3", 1000, 4}, {"1d0", 1, 1}, {"1e", 1, 1}, {"1e+", 1, 1},
        {"1e400", INFINITY, 5},
        {"-1e400", -INFINITY, 6}, {"1e-400", 0, 6}, {"0.0001e313", INFINITY, 10}, {"0.0001e312", 1e308, 10},
        {"0.0001e-400", 0, 11},
        {"1e99999999999999999999", INFINITY, 22}, {"1e-99999999999999999999", 0, 23}, {"0e999999999999", 0, 14},
        {"0x10", 16, 4}, {"-0x1.8p1", -3, 8}, {"0X8.8", 8.5, 5}, {"0x", 0, 1}, {"0xg", 0, 1}, {"0x-1", 0, 1},
        {"0x1p9999", INFINITY, 8}, {"0x1p-9999", 0, 9}, {"-", 0, 0}, {"+", 0, 0}, {".", 0, 0}, {"-.", 0, 0}, {"", 0, 0},
        {"+-1", 0, 0}, {"--1", 0, 0}, {"- 1", 0, 0}, {"-+1", 0, 0}, {"abc", 0, 0}, {"-inf", -INFINITY, 4},
        {"1,5", 1, 1}, {"010", 10, 3}, {"9007199254740993", 9007199254740992, 16},
        {"0.1000000000000000055511151231257827021181583404541015625", 0.1, 57},
    };
    for (size_t i = 0; i < LENGTH(cases); i++) {
        double value = 42;
        const char *const text = cases[i].text;
        const char *const stop = tri_scan_real(text, text + strlen(text), &value);
        if (stop - text != cases[i].length || value != cases[i].value)
            fail_msg("%s: read %d characters as %g", text, (int)(stop - text), value);
    }
}

/* Numbers out of range whose exponent has the other sign, because of their many digits. */
static void scan_real_of_many_digits(void **state)
{
    (void)state;
    char text[512] = "1";
    double value;
    memset(text + 1, '0', 400);
    strcpy(text + 401, "e-50");
    assert_ptr_equal(tri_scan_real(text, text + 405, &value), text + 405);
    assert_true(value == INFINITY);
    strcpy(text + 401, "e-390");
    tri_scan_real(text, text + 406, &value);
    assert_true(value == 1e10);
    memcpy(text, "0.", 2);
    strcpy(text + 401, "1e50");
    assert_ptr_equal(tri_scan_real(text, text + 405, &value), text + 405);
    assert_true(value == 0);
    strcpy(text + 401, "1e410");
    tri_scan_real(text, text + 406, &value);
    assert_true(value == 1e10);
}

static void scan_integer_table(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        int64_t value;
        int length;
    } cases[] = {
        {"0", 0, 1}, {"12 ", 12, 2}, {"-7", -7, 2}, {"+7", 7, 2}, {"010", 10, 3}, {"08", 8, 2}, {"0x1F", 31, 4},
        {"-0xa", -10, 4}, {"0x", 0, 1}, {"0xg", 0, 1}, {"3.9", 3, 1}, {"1e3", 1, 1},
        {"9223372036854775807", INT64_MAX, 19}, {"9223372036854775808", INT64_MAX, 19},
        {"-9223372036854775808", INT64_MIN, 20},
        {"-9223372036854775809", INT64_MIN, 20}, {"99999999999999999999999999", INT64_MAX, 26},
        {"0xffffffffffffffffffff", INT64_MAX, 22}, {"", 0, 0}, {"-", 0, 0}, {"+x", 0, 0}, {".5", 0, 0}, {"a", 0, 0},
    };
    for (size_t i = 0; i < LENGTH(cases); i++) {
        int64_t value = 42;
        const char *const text = cases[i].text;
        const char *const stop = tri_scan_integer(text, text + strlen(text), &value);
        if (stop - text != cases[i].length || value != cases[i].value)
            fail_msg("%s: read %d characters as %" PRId64, text, (int)(stop - text), value);
    }
}

/* Scanning stops at the given end, even if more digits follow. */
static void scan_stops_at_end(void **state)
{
    (void)state;
    const char text[] = "123456";
    double real;
    int64_t integer;
    assert_ptr_equal(tri_scan_real(text, text + 3, &real), text + 3);
    assert_true(real == 123);
    assert_ptr_equal(tri_scan_integer(text, text + 2, &integer), text + 2);
    assert_int_equal(integer, 12);
}

static void locale_does_not_matter(void **state)
{
    (void)state;
    if (!setlocale(LC_ALL, "de_DE.UTF-8") && !setlocale(LC_ALL, "fr_FR.UTF-8"))
        skip();
    char text[TRI_REAL_ROOM];
    const char number[] = "2.25";
    double value;
    *tri_print_real(text, 0.5) = 0;
    tri_scan_real(number, number + 4, &value);
    setlocale(LC_ALL, "C");
    assert_string_equal(text, "0.5");
    assert_true(value == 2.25);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(print_real_special), cmocka_unit_test(print_real_near_powers),
        cmocka_unit_test(print_real_ties), cmocka_unit_test(print_real_random),
        cmocka_unit_test(print_integer_all_widths), cmocka_unit_test(scan_real_table),
        cmocka_unit_test(scan_real_of_many_digits),
        cmocka_unit_test(scan_integer_table), cmocka_unit_test(scan_stops_at_end),
        cmocka_unit_test(locale_does_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
