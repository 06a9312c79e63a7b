/* --size and related options: the meaning of each value, and values that are refused. */
#include "drivers/mesh/size_options.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

struct parsed_options {
    struct size_options options;
    struct tri_switches switches;
    struct tri_error error;
    int at;
};

/* Parses the option at word 1. value NULL: no word follows it. */
static bool parse_option(struct parsed_options *t, const char *word, const char *value)
{
    char program[] = "triangle", first[120], second[120];
    char *argv[] = {program, first, second};
    strcpy(first, word);
    strcpy(second, value ? value : "");
    t->at = 1;
    t->error.status = TRI_OK;
    return size_options_take(&t->options, &t->switches, value ? 3 : 2, argv, &t->at, &t->error);
}

static struct parsed_options no_options(void) { return (struct parsed_options){.switches = tri_switches_none()}; }

static void test_valid_values_are_parsed(void **state)
{
    (void)state;
    struct parsed_options t = no_options();
    assert_true(parse_option(&t, "--size", "5e2") && !t.error.status && t.at == 2);
    assert_true(t.options.source[0].field.kind == TRI_SIZE_NUMBER && t.options.source[0].field.length == 500);
    assert_true(parse_option(&t, "--size=coast.asc", "x") && !t.error.status && t.at == 1);
    assert_string_equal(t.options.source[1].path, "coast.asc");
    assert_true(parse_option(&t, "--size", "a@b.npy@0,-1,2e3,1") && !t.error.status);
    assert_string_equal(t.options.source[2].path, "a@b.npy");
    assert_true(t.options.source[2].has_extent && t.options.source[2].extent[1] == -1);
    assert_true(t.options.source[2].extent[2] == 2000 && t.options.source[2].extent[3] == 1);
    assert_true(parse_option(&t, "--size-near", "-2:500") && !t.error.status);
    const struct tri_size_field *near = &t.options.source[3].field;
    assert_true(near->kind == TRI_SIZE_NEAR && near->marker == -2 && near->length == 500 && near->growth < 0);
    assert_true(parse_option(&t, "--size-near=7:1.5,0.15", NULL) && !t.error.status);
    near = &t.options.source[4].field;
    assert_true(near->marker == 7 && near->length == 1.5 && near->growth == 0.15);
    assert_true(parse_option(&t, "--gradation", "inf") && t.options.gradation == HUGE_VAL);
    assert_true(parse_option(&t, "--min-size", "3") && t.options.min_size == 3);
    assert_true(parse_option(&t, "--max-size", "30") && t.options.max_size == 30);
    assert_true(parse_option(&t, "--elements-across", "2.5") && t.options.elements_across == 2.5);
    assert_true(parse_option(&t, "--per-circle=40", NULL) && t.options.per_circle == 40);
    assert_true(parse_option(&t, "--min-edge", "1e3") && t.options.min_edge == 1000);
    assert_true(parse_option(&t, "--placement", "classic") && t.switches.placement == TRI_PLACEMENT_CLASSIC);
    assert_true(parse_option(&t, "--placement=front", NULL) && t.switches.placement == TRI_PLACEMENT_FRONT);
    assert_true(parse_option(&t, "--placement=lattice", NULL) && t.switches.placement == TRI_PLACEMENT_LATTICE);
    assert_false(parse_option(&t, "--sizes", "3") || parse_option(&t, "--siz", "3") || parse_option(&t, "-size", "3"));
    char text[SIZE_OPTIONS_TEXT];
    size_options_print(&t.options, text);
    assert_string_equal(text, "500, coast.asc, a@b.npy, 500 at segments with marker -2, 1.5 at segments with marker 7 "
                              "growing by 0.15, 2.5 across channels, 40 around a circle; at least 3; at most 30; "
                              "gradation inf");
    size_options_free(&t.options);
}

static void test_invalid_values_are_refused(void **state)
{
    static const char *const wrong[][2] = {
        {"--size", "0"}, {"--size", "-3"}, {"--size", "inf"}, {"--size", "nan"}, {"--size", ""}, {"--size", "500m"},
        {"--size", "coast.tif"}, {"--size", "a.npy@1,2,3"}, {"--size", "a.npy@1,2,3,4,5"}, {"--size", "a.npy@1,2,3,x"},
        {"--size", "a.asc@0,0,1,1"}, {"--size-near", "500"}, {"--size-near", "2:"}, {"--size-near", "2:0"},
        {"--size-near", "2:5,"}, {"--size-near", "2:5,-1"}, {"--size-near", "2:5,0.1,3"}, {"--size-near", "x:5"},
        {"--size-near", "99999999999:5"}, {"--min-edge", "0"}, {"--min-edge", "5m"}, {"--gradation", "0"},
        {"--gradation", "-1"}, {"--gradation", "nan"},
        {"--min-size", "0"}, {"--max-size", "inf"}, {"--max-size", "x"}, {"--placement", "Classic"},
        {"--elements-across", "0"}, {"--per-circle", "2"}, {"--per-circle", "nan"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct parsed_options t = no_options();
        assert_true(parse_option(&t, wrong[i][0], wrong[i][1]));
        assert_int_equal(t.error.status, TRI_BAD_INPUT);
        assert_non_null(strstr(t.error.text, wrong[i][0]));
        size_options_free(&t.options);
    }
    struct parsed_options t = no_options();
    assert_true(parse_option(&t, "--size", NULL) && t.error.status == TRI_BAD_INPUT);
    for (int i = 0; i < SIZE_OPTIONS_MOST; i++)
        assert_true(parse_option(&t, i % 2 ? "--size" : "--size-near", i % 2 ? "1" : "1:1") && !t.error.status);
    assert_true(parse_option(&t, "--size", "1") && t.error.status == TRI_BAD_INPUT);
}

/* Lengths set -q. Limits without lengths are an error. */
static void test_limits_need_lengths(void **state)
{
    (void)state;
    struct parsed_options t = no_options();
    assert_int_equal(size_options_end(&t.options, &t.switches, &t.error), TRI_OK);
    assert_false(t.switches.angle);
    parse_option(&t, "--gradation", "0.3");
    assert_int_equal(size_options_end(&t.options, &t.switches, &t.error), TRI_BAD_INPUT);
    parse_option(&t, "--max-size", "3");
    assert_int_equal(size_options_end(&t.options, &t.switches, &t.error), TRI_OK);
    assert_true(t.switches.angle && t.switches.min_angle == 20);
    parse_option(&t, "--min-size", "4");
    assert_int_equal(size_options_end(&t.options, &t.switches, &t.error), TRI_BAD_INPUT);
    t = no_options();
    tri_switches_add(&t.switches, "q30");
    parse_option(&t, "--size", "3");
    assert_int_equal(size_options_end(&t.options, &t.switches, &t.error), TRI_OK);
    assert_true(t.switches.min_angle == 30);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_valid_values_are_parsed),
        cmocka_unit_test(test_invalid_values_are_refused),
        cmocka_unit_test(test_limits_need_lengths),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
