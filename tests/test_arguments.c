/* File names: suffixes, iteration numbers. */
#include "drivers/mesh/arguments.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void test_iterations(void **state)
{
    (void)state;
    static const char *const names[][2] = {
        {"foo", "foo.1"},         {"foo.1", "foo.2"},       {"foo.9", "foo.10"},      {"foo.12", "foo.13"},
        {"foo.0", "foo.1"},       {"foo.01", "foo.2"},      {"foo.000", "foo.1"},     {"foo.1.2", "foo.1.3"},
        {"foo.-1", "foo.-1.1"},   {"foo.1a", "foo.1a.1"},   {"foo.a1", "foo.a1.1"},   {"foo.", "foo..1"},
        {"1", "1.1"},             {"d.1/foo", "d.1/foo.1"}, {"d.1/foo.5", "d.1/foo.6"}, {"", ".1"},
        {"foo.99", "foo.100"},    {"foo.099", "foo.100"},   {"x.1.", "x.1..1"},       {".7", ".8"},
        {"foo.99999999999999999999999", "foo.100000000000000000000000"},
    };
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char *next = next_iteration(names[i][0]);
        assert_string_equal(next, names[i][1]);
        free(next);
    }
}

static void test_suffixes(void **state)
{
    (void)state;
    static const struct {
        const char *word, *input, *output;
        bool segments, mesh, area_lists;
    } cases[] = {
        {"foo", "foo", "foo.1", false, false, false},         {"foo.node", "foo", "foo.1", false, false, false},
        {"foo.poly", "foo", "foo.1", true, false, false},     {"foo.1.ele", "foo.1", "foo.2", false, true, false},
        {"foo.area", "foo", "foo.1", false, true, true},
        {"foo.edge", "foo.edge", "foo.edge.1", false, false, false},
        {"foo.POLY", "foo.POLY", "foo.POLY.1", false, false, false},
        {"x.poly.poly", "x.poly", "x.poly.1", true, false, false},
        {"a/b.c/x.node.poly", "a/b.c/x.node", "a/b.c/x.node.1", true, false, false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct arguments a = arguments_begin(0, NULL);
        arguments_word(&a, cases[i].word);
        assert_int_equal(arguments_end(&a, NULL), TRI_OK);
        assert_string_equal(a.input, cases[i].input);
        assert_string_equal(a.output, cases[i].output);
        assert_int_equal(a.switches.segments, cases[i].segments);
        assert_int_equal(a.switches.mesh, cases[i].mesh);
        assert_int_equal(a.switches.area_lists, cases[i].area_lists);
        arguments_free(&a);
    }
}

static void test_words(void **state)
{
    (void)state;
    struct arguments a = arguments_begin(0, NULL);
    static const char *const words[] = {"-q", "-", "-I", "second.3", "-a2"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        arguments_word(&a, words[i]);
    assert_int_equal(arguments_end(&a, NULL), TRI_OK);
    assert_string_equal(a.input, "second.3");
    assert_string_equal(a.output, "second.3");
    assert_true(a.switches.angle && a.switches.area && !a.switches.segments);
    arguments_free(&a);
    a = arguments_begin(0, NULL);
    arguments_word(&a, "-pc");
    assert_int_equal(arguments_end(&a, NULL), TRI_OK);
    assert_null(a.file);
    arguments_free(&a);
}

/* A second file is an error. The message says how numbers are written. */
static void test_a_second_file_is_refused(void **state)
{
    (void)state;
    static const char *const cases[][4] = {{"-p", "-q", "30", "a.poly"}, {"a.poly", "-pq", ".5", "-Q"},
                                           {"a", "-p", "b.poly", "-q"}};
    static const char *const both[] = {"not both 30 and a.poly;", "not both a.poly and .5;", "not both a and b.poly;"};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct tri_error error = {0};
        struct arguments a = arguments_begin(0, NULL);
        for (int k = 0; k < 4; k++)
            arguments_word(&a, cases[i][k]);
        assert_int_equal(arguments_end(&a, &error), TRI_BAD_INPUT);
        assert_non_null(strstr(error.text, both[i]));
        assert_non_null(strstr(error.text, "-q30"));
        arguments_free(&a);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_iterations), cmocka_unit_test(test_suffixes),
                                       cmocka_unit_test(test_words), cmocka_unit_test(test_a_second_file_is_refused)};
    return cmocka_run_group_tests_name("arguments", tests, NULL, NULL);
}
