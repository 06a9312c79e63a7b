/* The lexer of the text formats returns the records and fields of known texts, for any division into chunks. */
#include "triangle/text/text.h"

#include <stdio.h>

#include "tests/support.h"

static struct tri_text load(const char *content, size_t chunk_bytes)
{
    struct tri_text text;
    struct tri_error error = {0};
    FILE *file = fopen("text.txt", "w");
    assert_non_null(file);
    assert_int_equal(fwrite(content, 1, strlen(content), file), strlen(content));
    assert_int_equal(fclose(file), 0);
    assert_int_equal(tri_text_load(&text, "text.txt", chunk_bytes, NULL, NULL, &error), TRI_OK);
    return text;
}

static void test_records_and_lines(void **state)
{
    (void)state;
    static const char content[] = "# a comment\n\n  3 4.5\nwords only\n, -7e2 x 8 # 9\n.5";
    for (size_t chunk = 1; chunk < 40; chunk++) {
        struct tri_text text = load(content, chunk);
        struct tri_cursor cursor = tri_cursor_begin(&text);
        struct tri_fields fields;
        double a, b, c;
        assert_int_equal(tri_cursor_remaining(&cursor), 3);
        assert_true(tri_cursor_next(&cursor, &fields));
        assert_int_equal(cursor.line, 3);
        assert_int_equal(tri_fields_real(&fields, &a), TRI_FIELD_GOOD);
        assert_int_equal(tri_fields_real(&fields, &b), TRI_FIELD_GOOD);
        assert_int_equal(tri_fields_real(&fields, &c), TRI_FIELD_MISSING);
        assert_true(a == 3 && b == 4.5 && c == 0);
        assert_true(tri_cursor_next(&cursor, &fields));
        assert_int_equal(cursor.line, 5);
        assert_int_equal(tri_fields_real(&fields, &a), TRI_FIELD_GOOD);
        assert_int_equal(tri_fields_real(&fields, &b), TRI_FIELD_GOOD);
        assert_int_equal(tri_fields_real(&fields, &c), TRI_FIELD_MISSING);
        assert_true(a == -700 && b == 8);
        assert_true(tri_cursor_next(&cursor, &fields));
        assert_int_equal(tri_fields_real(&fields, &a), TRI_FIELD_GOOD);
        assert_true(a == 0.5);
        assert_int_equal(tri_cursor_remaining(&cursor), 0);
        assert_false(tri_cursor_next(&cursor, &fields));
        tri_text_free(&text);
    }
}

/* The words nan and inf are values that a coordinate cannot have. Numbers too large for a double are refused as
   well. */
static void test_texts_that_are_no_numbers_are_refused(void **state)
{
    (void)state;
    static const char *const bad[] = {"nan\n", "1 inf", "1 -Infinity 2", "1 NaN", "1 1e999", "1 +-3", "1 -"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char content[64];
        snprintf(content, sizeof content, "0 %s\n", bad[i]);
        struct tri_text text = load(content, 0);
        struct tri_cursor cursor = tri_cursor_begin(&text);
        struct tri_fields fields;
        double value;
        enum tri_field field = TRI_FIELD_GOOD;
        assert_true(tri_cursor_next(&cursor, &fields));
        for (int k = 0; k < 4 && field == TRI_FIELD_GOOD; k++)
            field = tri_fields_real(&fields, &value);
        assert_int_equal(field, TRI_FIELD_BAD);
        tri_text_free(&text);
    }
}

static void test_integers_are_parsed(void **state)
{
    (void)state;
    struct tri_text text = load("12 -3 +4 5.75 99999999999999999999", 0);
    struct tri_cursor cursor = tri_cursor_begin(&text);
    struct tri_fields fields;
    int64_t value;
    assert_true(tri_cursor_next(&cursor, &fields));
    static const int64_t expected[] = {12, -3, 4, 5};
    for (size_t i = 0; i < 4; i++) {
        assert_int_equal(tri_fields_integer(&fields, &value), TRI_FIELD_GOOD);
        assert_true(value == expected[i]);
    }
    tri_text_free(&text);
}

static const char *double_it(void *user, size_t i, struct tri_fields *fields)
{
    double *values = user;
    if (tri_fields_real(fields, &values[i]) != TRI_FIELD_GOOD)
        return "has no number";
    values[i] *= 2;
    return values[i] < 0 ? "is negative" : NULL;
}

/* Rows may come in any order. Of several faults the first is reported, with its line. */
static void test_tables_are_read_in_any_order(void **state)
{
    (void)state;
    for (size_t chunk = 1; chunk < 20; chunk++) {
        double values[6] = {0};
        struct tri_table table = {"number", 4, 1, double_it, values};
        struct tri_error error = {0};
        struct tri_text text = load("1\n#\n2\n\n3\n4\n5\n", chunk);
        struct tri_cursor cursor = tri_cursor_begin(&text);
        assert_int_equal(tri_cursor_table(&cursor, &table, &support_backwards, &error), TRI_OK);
        assert_true(values[0] == 2 && values[3] == 8 && values[4] == 0);
        assert_int_equal(tri_cursor_remaining(&cursor), 1);
        tri_text_free(&text);
        text = load("1\n\n-2\n3\n-4\n", chunk);
        cursor = tri_cursor_begin(&text);
        assert_int_equal(tri_cursor_table(&cursor, &table, &support_backwards, &error), TRI_BAD_INPUT);
        assert_int_equal(error.line, 3);
        assert_string_equal(error.text, "number 2 is negative");
        tri_text_free(&text);
    }
}

static void test_an_unreadable_file_is_an_error(void **state)
{
    (void)state;
    struct tri_text text;
    struct tri_error error = {0};
    assert_int_equal(tri_text_load(&text, "no_such_file", 0, NULL, NULL, &error), TRI_CANNOT_READ);
    assert_string_equal(error.file, "no_such_file");
    tri_text_free(&text);
    assert_int_equal(tri_text_load(&text, ".", 0, NULL, NULL, &error), TRI_CANNOT_READ);
    tri_text_free(&text);
}

static void test_an_empty_file_has_no_records(void **state)
{
    (void)state;
    struct tri_text text = load("", 0);
    struct tri_cursor cursor = tri_cursor_begin(&text);
    struct tri_fields fields;
    assert_int_equal(tri_cursor_remaining(&cursor), 0);
    assert_false(tri_cursor_next(&cursor, &fields));
    tri_text_free(&text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_records_and_lines),
        cmocka_unit_test(test_texts_that_are_no_numbers_are_refused),
        cmocka_unit_test(test_integers_are_parsed),
        cmocka_unit_test(test_tables_are_read_in_any_order),
        cmocka_unit_test(test_an_unreadable_file_is_an_error),
        cmocka_unit_test(test_an_empty_file_has_no_records),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
