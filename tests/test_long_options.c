/* Options that begin with two dashes. */
#include "drivers/mesh/long_options.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

struct taken {
    struct long_options options;
    struct tri_switches switches;
    struct tri_error error;
    int at; /* number of the word that follows */
};

/* Parses one option, which is word 1. second NULL: there is no other word. */
static enum tri_status parse_option(struct taken *t, char *first, char *second)
{
    char program[] = "ptriangle";
    char *argv[] = {program, first, second};
    t->at = 1;
    return long_options_take(&t->options, &t->switches, second ? 3 : 2, argv, &t->at, &t->error);
}

#define TAKE(t, first, second) parse_option(t, (char[]){first}, (char[]){second})
#define TAKE_ALONE(t, first) parse_option(t, (char[]){first}, NULL)

static struct taken nothing(void) { return (struct taken){.switches = tri_switches_none()}; }

static void test_both_forms(void **state)
{
    (void)state;
    struct taken t = nothing();
    assert_int_equal(TAKE(&t, "--threads", "7"), TRI_OK);
    assert_int_equal(t.options.threads, 7);
    assert_int_equal(t.at, 2);
    assert_int_equal(TAKE(&t, "--threads=8", "9"), TRI_OK);
    assert_int_equal(t.options.threads, 8);
    assert_int_equal(t.at, 1);
    char name[] = "--output=a=b";
    assert_int_equal(parse_option(&t, name, NULL), TRI_OK);
    assert_string_equal(t.options.output, "a=b");
    assert_false(t.options.no_sync);
    assert_int_equal(TAKE_ALONE(&t, "--no-sync"), TRI_OK);
    assert_true(t.options.no_sync);
    assert_int_equal(TAKE_ALONE(&t, "--no-progress"), TRI_OK);
    assert_int_equal(t.options.progress, PROGRESS_NO);
    assert_int_equal(TAKE(&t, "--progress", "letter"), TRI_OK);
    assert_int_equal(t.options.progress, PROGRESS_YES);
    assert_int_equal(t.at, 1);
    assert_int_equal(TAKE(&t, "--holes", "auto"), TRI_OK);
    assert_true(t.switches.even_odd);
    assert_int_equal(TAKE_ALONE(&t, "--holes=points"), TRI_OK);
    assert_false(t.switches.even_odd);
    assert_int_equal(TAKE(&t, "--numbering", "blocks"), TRI_OK);
    assert_true(t.options.by_block);
    assert_int_equal(TAKE_ALONE(&t, "--numbering=curve"), TRI_OK);
    assert_false(t.options.by_block || t.options.help || t.options.version);
}

static void test_memory(void **state)
{
    (void)state;
    struct taken t = nothing();
    assert_int_equal(TAKE(&t, "--memory", "4G"), TRI_OK);
    assert_true(t.options.memory == 4e9 && t.options.memory_share == 0);
    assert_int_equal(TAKE(&t, "--memory", "60%"), TRI_OK);
    assert_true(t.options.memory == 0 && t.options.memory_share == 0.6);
    assert_int_equal(TAKE(&t, "--memory", "1.5e3K"), TRI_OK);
    assert_true(t.options.memory == 1500000 && t.options.memory_share == 0);
    assert_int_equal(TAKE(&t, "--memory", "2097152"), TRI_OK);
    assert_true(t.options.memory == 0x1p21);
    char *const wrong[] = {"", "G", "0", "-1G", "1g", "4GB", "0%", "101%", "nan", "1e99T", "1K", "4 G"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_int_equal(parse_option(&t, (char[]){"--memory"}, wrong[i]), TRI_BAD_INPUT);
    assert_true(t.options.memory == 0x1p21);
    assert_int_equal(TAKE(&t, "--scratch", "/tmp"), TRI_OK);
    assert_string_equal(t.options.scratch, "/tmp");
}

/* The number of threads of a batch system is used unless the user gives a number. */
static void test_threads_of_a_batch_system(void **state)
{
    (void)state;
    struct long_options none = {0}, three = {.threads = 3};
    unsetenv("OMP_NUM_THREADS");
    unsetenv("SLURM_CPUS_PER_TASK");
    assert_int_equal(long_options_threads(&none), 0);
    setenv("SLURM_CPUS_PER_TASK", "5", 1);
    assert_int_equal(long_options_threads(&none), 5);
    assert_int_equal(long_options_threads(&three), 3);
    setenv("OMP_NUM_THREADS", "", 1);
    assert_int_equal(long_options_threads(&none), 5);
    setenv("OMP_NUM_THREADS", "7", 1);
    assert_int_equal(long_options_threads(&none), 0);
    assert_int_equal(long_options_threads(&three), 3);
    unsetenv("OMP_NUM_THREADS");
    setenv("SLURM_CPUS_PER_TASK", "many", 1);
    assert_int_equal(long_options_threads(&none), 0);
    setenv("SLURM_CPUS_PER_TASK", "0", 1);
    assert_int_equal(long_options_threads(&none), 0);
    unsetenv("SLURM_CPUS_PER_TASK");
}

/* Bounds become switches, also if they have exponents. */
static void test_bounds(void **state)
{
    (void)state;
    struct taken t = nothing();
    tri_switches_add(&t.switches, "pq20a5");
    assert_int_equal(TAKE(&t, "--max-area", "1e-6"), TRI_OK);
    assert_int_equal(TAKE_ALONE(&t, "--min-angle=2.85e1"), TRI_OK);
    assert_true(t.switches.area && t.switches.max_area == 1e-6);
    assert_true(t.switches.angle && t.switches.min_angle == 28.5);
    assert_int_equal(t.switches.n_notes, 0);
    tri_switches_add(&t.switches, "a3");
    assert_true(t.switches.max_area == 3);
}

static void test_refused(void **state)
{
    (void)state;
    static const char *const words[][2] = {
        {"--threads", "0"},       {"--threads", "1025"},    {"--threads", "2x"},      {"--threads", ""},
        {"--threads", NULL},      {"--threads=", NULL},     {"--max-area", "0"},      {"--max-area", "-1"},
        {"--max-area", "inf"},    {"--max-area", "nan"},    {"--max-area", "1e999"},  {"--max-area=", NULL},
        {"--max-area", "1 "},     {"--min-angle", "60.1"},  {"--min-angle", "-0.1"},  {"--min-angle", "nan"},
        {"--output", ""},         {"--report", NULL},       {"--progress=1", NULL},   {"--help=", NULL},
        {"--numbering", "block"}, {"--numbering=", NULL},   {"--numbering", NULL},    {"--numbers", "curve"},
        {"--holes", "none"},      {"--holes", NULL},        {"--holes=", NULL},       {"--hole", "auto"},
        {"--output", "/"},        {"--output", "a/"},       {"--output", "."},        {"--output", "a/.."},
        {"--output=.h5", NULL},   {"--output=.H5", NULL},   {"--thread", "2"},        {"--threadss", "2"},
        {"--", "letter"},         {"--=1", NULL},           {"--placement", "Classic"}, {"--placement=", NULL},
        {"--placement", NULL},    {"--placements", "classic"},
    };
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        struct taken t = nothing(), before = nothing();
        char first[32], second[32];
        strcpy(first, words[i][0]);
        strcpy(second, words[i][1] ? words[i][1] : "");
        assert_int_equal(parse_option(&t, first, words[i][1] ? second : NULL), TRI_BAD_INPUT);
        assert_true(strlen(t.error.text) > 10 && !strchr(t.error.text, '\n'));
        assert_int_equal(t.options.threads, 0);
        assert_null(t.options.output);
        assert_memory_equal(&t.switches, &before.switches, sizeof t.switches);
    }
}

static void test_parts(void **state)
{
    (void)state;
    struct taken t = nothing();
    assert_int_equal(long_options_check(&t.options, &t.error), TRI_OK);
    assert_int_equal(TAKE(&t, "--parts", "512"), TRI_OK);
    assert_int_equal(t.options.n_parts, 512);
    assert_int_equal(long_options_check(&t.options, &t.error), TRI_BAD_INPUT);
    char vtu[] = "--output=a.vtu", msh[] = "--output=a.msh";
    assert_int_equal(parse_option(&t, vtu, NULL), TRI_OK);
    assert_int_equal(long_options_check(&t.options, &t.error), TRI_BAD_INPUT);
    assert_int_equal(parse_option(&t, msh, NULL), TRI_OK);
    assert_int_equal(long_options_check(&t.options, &t.error), TRI_OK);
    assert_int_equal(TAKE(&t, "--parts", "0"), TRI_BAD_INPUT);
    assert_int_equal(TAKE(&t, "--parts", "513"), TRI_BAD_INPUT);
    assert_int_equal(TAKE(&t, "--parts", "2.5"), TRI_BAD_INPUT);
    assert_int_equal(TAKE_ALONE(&t, "--parts"), TRI_BAD_INPUT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_both_forms),
        cmocka_unit_test(test_memory), cmocka_unit_test(test_threads_of_a_batch_system),
        cmocka_unit_test(test_bounds),
        cmocka_unit_test(test_parts),
        cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
