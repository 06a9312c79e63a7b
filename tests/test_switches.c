/* Strings of switches: the grammar of numbers, ignored characters, and options derived from the switches. */
#include "triangle/dropin/switches.h"

#include <locale.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static struct tri_switches parsed(const char *text)
{
    struct tri_switches s = tri_switches_none();
    tri_switches_add(&s, text);
    return s;
}

static void test_unknown_characters_are_ignored(void **state)
{
    (void)state;
    static const char *const empty[] = {"", "-", "{}", "R k%^&}{0123456789", "Xil", "o", "o3", "oo", "tmbdf"};
    const struct tri_switches none = tri_switches_none();
    for (size_t i = 0; i < sizeof empty / sizeof *empty; i++) {
        struct tri_switches s = parsed(empty[i]);
        assert_memory_equal(&s, &none, sizeof s);
    }
    assert_int_equal(none.max_steiner, -1);
    assert_false(tri_switches_refine(&none));
}

/* Every letter sets its own flag and no other. */
static void test_each_letter_sets_its_own_flag(void **state)
{
    (void)state;
    static const struct {
        const char *letter;
        size_t at;
    } flags[] = {
        {"p", offsetof(struct tri_switches, segments)},    {"r", offsetof(struct tri_switches, mesh)},
        {"a", offsetof(struct tri_switches, area_lists)},  {"u", offsetof(struct tri_switches, user_test)},
        {"A", offsetof(struct tri_switches, regions)},     {"c", offsetof(struct tri_switches, keep_hull)},
        {"D", offsetof(struct tri_switches, conforming)},  {"j", offsetof(struct tri_switches, jettison)},
        {"e", offsetof(struct tri_switches, edges)},       {"v", offsetof(struct tri_switches, voronoi)},
        {"n", offsetof(struct tri_switches, neighbors)},   {"g", offsetof(struct tri_switches, off)},
        {"B", offsetof(struct tri_switches, no_markers)},  {"P", offsetof(struct tri_switches, no_poly)},
        {"N", offsetof(struct tri_switches, no_node)},     {"E", offsetof(struct tri_switches, no_ele)},
        {"I", offsetof(struct tri_switches, no_iteration)}, {"O", offsetof(struct tri_switches, ignore_holes)},
        {"z", offsetof(struct tri_switches, from_zero)},   {"o2", offsetof(struct tri_switches, second_order)},
        {"s", offsetof(struct tri_switches, split_recovery)}, {"w", offsetof(struct tri_switches, weighted)},
        {"W", offsetof(struct tri_switches, weighted)},    {"C", offsetof(struct tri_switches, check)},
        {"Q", offsetof(struct tri_switches, quiet)},       {"h", offsetof(struct tri_switches, help)},
        {"H", offsetof(struct tri_switches, help)},        {"?", offsetof(struct tri_switches, help)},
    };
    for (size_t i = 0; i < sizeof flags / sizeof *flags; i++) {
        struct tri_switches expected = tri_switches_none(), found = parsed(flags[i].letter);
        memset((char *)&expected + flags[i].at, 1, 1);
        assert_memory_equal(&found, &expected, sizeof found);
    }
}

static void test_numbers_are_parsed(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double angle, area;
    } cases[] = {
        {"q", 20, 0},        {"q30", 30, 0},      {"q20.", 20, 0},         {"q.5", 0.5, 0},     {"q.", 0, 0},
        {"q-5", 20, 0},      {"q30e1", 30, 0},    {"q 30", 20, 0},         {"q1q2", 2, 0},      {"q1q", 20, 0},
        {"a.1.2", 0, 0.1},   {"a1..2", 0, 1},     {"a.5a.1", 0, 0.1},      {"aa6.2", 0, 6.2},   {"a6.2a", 0, 6.2},
        {"a1e-3", 0, 1},     {"a007", 0, 7},      {"a0.0000000250", 0, 2.5e-8}, {"qa2", 20, 2}, {"a1,5", 0, 1},
        {"a9007199254740993", 0, 9007199254740992.0}, {"a0.1000000000000000055511151231257827", 0, 0.1},
        {"a123456789012345678901234567890.5", 0, 123456789012345678901234567890.5},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct tri_switches s = parsed(cases[i].text);
        assert_true(s.min_angle == cases[i].angle);
        assert_true(s.max_area == cases[i].area);
        assert_false(s.bad_area);
    }
    assert_true(parsed("aa6.2").area_lists && parsed("aa6.2").area);
    assert_true(parsed("a6.2a").area_lists && parsed("a-1").area_lists);
    assert_false(parsed("a-1").area);
    assert_true(parsed("a1e-3").edges);
}

static void test_invalid_areas_are_refused(void **state)
{
    (void)state;
    assert_true(parsed("a0").bad_area);
    assert_true(parsed("a.").bad_area);
    assert_true(parsed("a0.000").bad_area);
    assert_true(parsed("a0a1").bad_area);
    assert_false(parsed("a-0").bad_area);
}

/* Numbers of any length, compared with strtod of the same text (in the C locale). */
static void test_long_numbers_are_rounded_correctly(void **state)
{
    (void)state;
    char text[3000], number[2900];
    unsigned seed = 1;
    for (int round = 0; round < 300; round++) {
        int n = 1 + round * 9, dot = (int)(seed % (unsigned)(n + 1));
        for (int i = 0; i < n; i++) {
            seed = seed * 1103515245u + 12345u;
            number[i] = i == dot ? '.' : (char)('0' + (seed >> 16) % 10);
        }
        number[n] = 0;
        if (strcmp(number, ".") == 0)
            continue;
        text[0] = 'q';
        strcpy(text + 1, number);
        assert_true(parsed(text).min_angle == strtod(number, NULL));
    }
    /* Nearly a tie, decided by the last of many digits: 2^53 + 1 and a small amount. */
    strcpy(text, "q9007199254740993.");
    memset(text + strlen(text), '0', 900);
    text[18 + 900] = 0;
    assert_true(parsed(text).min_angle == 9007199254740992.0);
    strcat(text, "1");
    assert_true(parsed(text).min_angle == 9007199254740994.0);
}

static void test_the_limit_on_points_is_parsed(void **state)
{
    (void)state;
    assert_int_equal(parsed("S").max_steiner, 0);
    assert_int_equal(parsed("S100").max_steiner, 100);
    assert_int_equal(parsed("S-3").max_steiner, 0);
    assert_int_equal(parsed("S5S").max_steiner, 0);
    assert_int_equal(parsed("S1e3").max_steiner, 1);
    assert_true(parsed("S1e3").edges);
    assert_true(parsed("S99999999999999999999999999").max_steiner > INT64_MAX / 20);
}

static void test_repeated_letters_are_counted(void **state)
{
    (void)state;
    assert_int_equal(parsed("Y").protect, 1);
    assert_int_equal(parsed("YpY").protect, 2);
    assert_int_equal(parsed("YYYY").protect, 2);
    assert_int_equal(parsed("VVV").verbosity, 3);
    struct tri_switches s = parsed("Y");
    tri_switches_add(&s, "-Y");
    assert_int_equal(s.protect, 2);
}

static void test_ambiguous_exponents_are_noted(void **state)
{
    (void)state;
    struct tri_switches s = parsed("pq30a1e-6Q");
    assert_int_equal(s.n_notes, 1);
    assert_string_equal(s.notes[0], "a1e-6");
    assert_int_equal(parsed("q20e").n_notes, 0);
    assert_int_equal(parsed("pe1").n_notes, 0);
    assert_int_equal(parsed("a0.1e-n").n_notes, 0);
    assert_string_equal(parsed("a.5E3").notes[0], "a.5E3");
    assert_int_equal(parsed("a1e1a1e1a1e1a1e1a1e1a1e1").n_notes, TRI_SWITCH_NOTES);
    s = parsed("a0.0000000000000000000000000000000000000000000000000000001e5");
    assert_int_equal(strlen(s.notes[0]), TRI_SWITCH_NOTE_CHARS - 1);
}

/* Strings that clients of Triangle pass. */
static void test_strings_of_clients_are_parsed(void **state)
{
    (void)state;
    struct tri_switches s = parsed("Qz{pq30}");
    assert_true(s.quiet && s.from_zero && s.segments && s.min_angle == 30);
    s = parsed("-Q-Y-q30.0-D-a100.250000");
    assert_true(s.quiet && s.protect == 1 && s.min_angle == 30 && s.conforming && s.max_area == 100.25);
    s = parsed("-pq32.5a0.01AYS100ezCV");
    assert_true(s.segments && s.min_angle == 32.5 && s.max_area == 0.01 && s.regions && s.protect == 1);
    assert_true(s.max_steiner == 100 && s.edges && s.from_zero && s.check && s.verbosity == 1 && !s.area_lists);
    s = parsed("-pA -a -a0.1 -q30 -YY");
    assert_true(s.segments && s.regions && s.area_lists && s.max_area == 0.1 && s.min_angle == 30 && s.protect == 2);
}

static void test_switches_become_options(void **state)
{
    (void)state;
    struct tri_switches s = parsed("pq28.6aAa0.5DYOcS7");
    struct tri_options o = tri_switches_options(&s);
    assert_true(o.use_segments && o.keep_hull && o.ignore_holes && o.spread_regions && o.refine);
    assert_true(o.quality.min_angle == 28.6 && o.quality.max_area == 0.5 && o.quality.region_areas);
    assert_true(o.quality.conforming && o.quality.protect == 1 && o.quality.max_steiner == 7);
    assert_true(o.quality.lattice);
    s.placement = TRI_PLACEMENT_CLASSIC;
    assert_false(tri_switches_options(&s).quality.lattice);
    s = parsed("A"); /* regions need segments */
    assert_false(tri_switches_options(&s).spread_regions);
    s = parsed("rpAa");
    assert_false(tri_switches_options(&s).spread_regions);
    assert_true(tri_switches_options(&s).quality.region_areas); /* the bounds are those of the triangles */
    assert_false(tri_switches_options(&s).quality.lattice);     /* the input's vertices keep their positions */
    s = parsed("q180");
    assert_true(tri_switches_options(&s).refine && tri_switches_options(&s).quality.min_angle == 0);
    static const char *const refining[] = {"q", "q0", "a", "a1", "u", "D"};
    for (size_t i = 0; i < sizeof refining / sizeof *refining; i++) {
        s = parsed(refining[i]);
        assert_true(tri_switches_refine(&s));
    }
    s = parsed("pAcYYS9s");
    assert_false(tri_switches_refine(&s));
}

static void test_the_locale_does_not_matter(void **state)
{
    (void)state;
    static const char *const commas[] = {"de_DE.UTF-8", "de_DE", "fr_FR.UTF-8", "fr_FR"};
    const char *found = NULL;
    for (size_t i = 0; i < sizeof commas / sizeof *commas && !found; i++)
        found = setlocale(LC_ALL, commas[i]);
    if (!found)
        skip();
    assert_true(parsed("q20.5").min_angle == 20.5);
    assert_true(parsed("a0.1").max_area == 0.1);
    setlocale(LC_ALL, "C");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_unknown_characters_are_ignored),
        cmocka_unit_test(test_each_letter_sets_its_own_flag),
        cmocka_unit_test(test_numbers_are_parsed),
        cmocka_unit_test(test_invalid_areas_are_refused),
        cmocka_unit_test(test_long_numbers_are_rounded_correctly),
        cmocka_unit_test(test_the_limit_on_points_is_parsed),
        cmocka_unit_test(test_repeated_letters_are_counted),
        cmocka_unit_test(test_ambiguous_exponents_are_noted),
        cmocka_unit_test(test_strings_of_clients_are_parsed),
        cmocka_unit_test(test_switches_become_options),
        cmocka_unit_test(test_the_locale_does_not_matter),
    };
    return cmocka_run_group_tests_name("switches", tests, NULL, NULL);
}
