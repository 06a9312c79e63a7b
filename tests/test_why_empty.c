/* Compares the sentences with a table and verifies them: following the advice gives a mesh. */
#include <stdio.h>

#include "full.h"
#include "support.h"
#include "triangle/cdt/why_empty.h"

/* Two squares, the second inside the first, and five points on a line beside them. */
static const double SPOTS[13][2] = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {1, 1}, {3, 1}, {3, 3}, {1, 3},
                                    {9, 0}, {9, 1}, {9, 2}, {9, 3}, {9, 0}};

struct figure {
    const char *empty, *skipped; /* expected text, counted from 0 */
    int32_t first, n_points;     /* in SPOTS */
    int32_t segments[20], n_segments;
    double holes[4];
    int32_t n_holes;
    bool keep_hull, even_odd;
};

#define OUTER 0, 1, 1, 2, 2, 3, 3, 0
#define INNER 4, 5, 5, 6, 6, 7, 7, 4
#define OPEN_OUTER 0, 1, 1, 2, 2, 3

static const struct figure FIGURES[] = {
    {"", "", 0, 4, {OUTER}, 4, {0}, 0, false, false},
    {"", "", 0, 8, {OUTER, INNER}, 8, {2, 2}, 1, false, false},
    {"", "", 0, 8, {OUTER, 4, 5}, 5, {0}, 0, false, false},
    {"", "", 0, 8, {OPEN_OUTER, INNER}, 7, {0}, 0, false, false}, /* the inner square is meshed */
    {"", "", 0, 4, {OPEN_OUTER}, 3, {0}, 0, true, false},
    {"the outline is open at points 0 and 3", "", 0, 4, {OPEN_OUTER}, 3, {0}, 0, false, false},
    {"the outline is open at points 0 and 3", "", 0, 4, {OPEN_OUTER}, 3, {0}, 0, false, true},
    {"the outline is open at points 0 and 3", "", 0, 8, {4, 5, OPEN_OUTER}, 4, {0}, 0, false, false},
    {"the outline is open at points 0 and 3", "", 0, 8, {OPEN_OUTER, INNER}, 7, {2, 2}, 1, false, false},
    {"the outline is open at points 0, 3 and 1 more", "", 0, 8, {OPEN_OUTER, 1, 4}, 4, {0}, 0, false, false},
    {"the segments enclose nothing: they are open at points 0 and 2", "", 0, 4, {0, 2}, 1, {0}, 0, false, false},
    {"the segments enclose nothing: they are open at points 0, 1 and 2 more", "", 0, 4, {0, 1, 3, 2}, 2, {0}, 0, false,
     false},
    {"hole 0 lies in the only face", "", 0, 4, {OUTER}, 4, {2, 2}, 1, false, false},
    {"hole 1 lies in the only face", "", 0, 4, {OUTER}, 4, {9, 9, 2, 2}, 2, false, false},
    {"hole 0 lies in the only face", "", 0, 4, {OUTER}, 4, {2, 2, 1, 3}, 2, false, true},
    {"hole 0 lies in the only face", "", 0, 4, {OPEN_OUTER}, 3, {2, 2}, 1, true, false},
    {"holes lie in all 2 faces", "", 0, 8, {OUTER, INNER}, 8, {2, 2, 0.5, 0.5}, 2, false, false},
    {"segment 0 names point 99 of 8: numbers count from 0 here; it is skipped", "", 0, 8, {0, 99}, 1, {0}, 0, false,
     false},
    {"segment 2 names point 4 of 4: numbers count from 0 here; 2 segments are skipped", "", 0, 4,
     {1, 2, 2, 3, 3, 4, 4, 1}, 4, {0}, 0, false, false},
    {"segment 1 names point -1 of 4: numbers count from 0 here; 2 segments are skipped", "", 0, 4, {0, 0, -1, 2}, 2,
     {0}, 0, false, false},
    {"", "segment 4 names point 8 of 8: numbers count from 0 here; it is skipped", 0, 8, {OUTER, 0, 8}, 5, {0}, 0,
     false, false},
    {"", "segment 0 begins and ends at the same place, at point 3; 2 segments are skipped", 0, 4,
     {3, 3, OUTER, 2, 2}, 6, {0}, 0, false, false},
    {"the outline is open at points 0 and 3",
     "segment 1 begins and ends at the same place, at point 1; it is skipped", 0, 4, {0, 1, 1, 1, 1, 2, 2, 3}, 4, {0},
     0, false, false},
    {"hole 0 lies in the only face", "segment 4 names point 7 of 4: numbers count from 0 here; it is skipped", 0, 4,
     {OUTER, 0, 7}, 5, {2, 2}, 1, false, false},
    {"there are no segments", "", 0, 4, {0}, 0, {0}, 0, false, false},
    {"all segments are skipped", "segment 0 begins and ends at the same place, at point 2; it is skipped", 0, 4, {2, 2},
     1, {0}, 0, false, false},
    {"segments lie on one another in pairs, and cancel by the even-odd rule", "", 0, 4, {OUTER, OUTER}, 8, {0}, 0,
     false, true},
    {"all points lie on one line", "", 8, 5, {0, 1, 1, 2}, 2, {0}, 0, false, false},
    {"all points lie on one line", "segment 0 begins and ends at the same place, at point 0; it is skipped", 8, 5,
     {0, 4}, 1, {0}, 0, true, false},
};

static struct tri_pslg pslg_of(const struct figure *f)
{
    struct tri_pslg pslg = support_pslg(13, 10, 2, 0);
    for (int32_t k = 0; k < f->n_points; k++)
        support_add_point(&pslg, SPOTS[f->first + k][0], SPOTS[f->first + k][1]);
    for (int32_t k = 0; k < f->n_segments; k++)
        support_add_segment(&pslg, f->segments[2 * k], f->segments[2 * k + 1]);
    memcpy(pslg.holes, f->holes, sizeof f->holes);
    pslg.n_holes = f->n_holes;
    return pslg;
}

/* Checks the text that is reported for the figure. Returns its number of triangles. */
static int32_t notes_of(const struct tri_pslg *pslg, bool keep_hull, bool even_odd, int32_t base,
                        struct tri_report *report)
{
    struct tri_options options = tri_defaults();
    options.use_segments = true;
    options.keep_hull = keep_hull;
    options.even_odd = even_odd;
    options.base = base;
    struct tri_mesh mesh = support_generate(pslg, &options, report);
    int32_t n = mesh.n_triangles;
    tri_mesh_free(&mesh);
    assert_true((n == 0) == (report->notes.empty[0] != 0));
    return n;
}

static void test_sentences_match_the_table(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof FIGURES / sizeof *FIGURES; i++) {
        const struct figure *f = &FIGURES[i];
        struct tri_pslg pslg = pslg_of(f);
        struct tri_report report;
        char wanted[300] = "";
        notes_of(&pslg, f->keep_hull, f->even_odd, 0, &report);
        if (f->empty[0])
            snprintf(wanted, sizeof wanted, "the mesh is empty: %s", f->empty);
        if (strcmp(report.notes.empty, wanted) != 0 || strcmp(report.notes.skipped, f->skipped) != 0)
            fail_msg("figure %zu: '%s', '%s'", i, report.notes.empty, report.notes.skipped);
        tri_pslg_free(&pslg);
    }
}

/* The same figure counted from 1: each number is one larger, except counts. */
static void test_numbers_from_one(void **state)
{
    (void)state;
    static const struct {
        int figure;
        const char *empty;
    } cases[] = {{5, "the mesh is empty: the outline is open at points 1 and 4"},
                 {9, "the mesh is empty: the outline is open at points 1, 4 and 1 more"},
                 {13, "the mesh is empty: hole 2 lies in the only face"},
                 {16, "the mesh is empty: holes lie in all 2 faces"},
                 {19, "the mesh is empty: segment 2 names point 0 of 4: numbers count from 1 here; "
                      "2 segments are skipped"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct figure *f = &FIGURES[cases[i].figure];
        struct tri_pslg pslg = pslg_of(f);
        struct tri_report report;
        notes_of(&pslg, f->keep_hull, f->even_odd, 1, &report);
        assert_string_equal(report.notes.empty, cases[i].empty);
        tri_pslg_free(&pslg);
    }
}

/* Numbers at the ends of their range. */
static void test_the_longest_sentences_fit(void **state)
{
    (void)state;
    struct tri_notes notes;
    int32_t ends[] = {INT32_MIN, INT32_MIN};
    const struct tri_pslg pslg = {.n_points = INT32_MAX, .n_segments = 1, .segments = ends};
    for (int reason = TRI_EMPTY_NOT; reason <= TRI_EMPTY_HOLES; reason++) {
        const struct tri_empty why = {(enum tri_empty_reason)reason, INT32_MAX - 1, {INT32_MAX - 1, INT32_MAX - 1}};
        for (int32_t skipped = 0; skipped < 2; skipped++) {
            tri_notes_make(&notes, &why, &pslg, skipped ? INT32_MAX : 0, 1);
            assert_true(strlen(notes.skipped) < sizeof notes.skipped - 20);
            assert_true(strlen(notes.empty) < sizeof notes.empty - 20);
        }
    }
}

/* --- advice is correct */

/* Random points, segments of which most form chains, and perhaps holes. On a lattice, segments overlap. */
static struct tri_pslg draw(struct support_random *random, bool lattice)
{
    int32_t n = 4 + support_below(random, 12), m = 1 + support_below(random, n + 2);
    struct tri_pslg pslg = support_pslg(n, m + 1, 4, 0);
    for (int32_t i = 0; i < n; i++)
        support_add_point(&pslg, lattice ? support_below(random, 5) : support_unit(random),
                          lattice ? support_below(random, 5) : support_unit(random));
    for (int32_t k = 0; k < m; k++) {
        int32_t a = support_below(random, 4) ? k % n : support_below(random, n);
        support_add_segment(&pslg, a, support_below(random, 4) ? (a + 1) % n : support_below(random, n));
    }
    pslg.n_holes = support_below(random, 5);
    for (int32_t i = 0; i < 2 * pslg.n_holes; i++)
        pslg.holes[i] = lattice ? 5 * support_unit(random) : support_unit(random);
    return pslg;
}

/* Does the figure have triangles without its holes? */
static bool fills(struct tri_pslg pslg, bool keep_hull, bool even_odd)
{
    struct tri_report report;
    pslg.n_holes = 0;
    return notes_of(&pslg, keep_hull, even_odd, 0, &report) > 0;
}

/* No face of the figure stays empty once the reported hole, or all of them, are removed. */
static void check_holes(const struct tri_pslg *pslg, const struct tri_empty *why, bool keep_hull, bool even_odd)
{
    struct tri_report report;
    assert_true(fills(*pslg, keep_hull, even_odd));
    for (int32_t k = 0; k < pslg->n_holes; k++) {
        struct tri_pslg alone = *pslg;
        alone.holes = &pslg->holes[2 * (size_t)k];
        alone.n_holes = 1;
        bool empties = notes_of(&alone, keep_hull, even_odd, 0, &report) == 0;
        if (why->reason == TRI_EMPTY_HOLES || k == why->n)
            assert_int_equal(empties, why->reason == TRI_EMPTY_HOLE);
    }
}

static void check(struct tri_pslg *pslg, bool keep_hull, bool even_odd, int32_t seen[TRI_EMPTY_HOLES + 1])
{
    struct tri_report report;
    notes_of(pslg, keep_hull, even_odd, 0, &report);
    const struct tri_empty why = report.carve.why;
    seen[why.reason]++;
    if (why.reason == TRI_EMPTY_OPEN && why.n == 2) {
        assert_false(!even_odd && fills(*pslg, keep_hull, even_odd) && pslg->n_holes == 0);
        support_add_segment(pslg, why.v[0], why.v[1]);
        assert_true(fills(*pslg, keep_hull, even_odd));
        pslg->n_segments--;
    } else if (why.reason == TRI_EMPTY_HOLE || why.reason == TRI_EMPTY_HOLES) {
        check_holes(pslg, &why, keep_hull, even_odd);
    } else if (why.reason == TRI_EMPTY_CANCELLED) {
        assert_true(even_odd);
    } else if (why.reason == TRI_EMPTY_LOOSE) {
        assert_false(fills(*pslg, false, even_odd));
    }
}

static void test_following_the_advice_gives_a_mesh(void **state)
{
    (void)state;
    struct support_random random = {17};
    int32_t seen[TRI_EMPTY_HOLES + 1] = {0};
    for (int i = 0; i < (is_full() ? 50000 : 4000); i++) {
        bool lattice = support_below(&random, 2) == 0; /* the even-odd rule may cancel the closing segment on a
                                                          lattice */
        struct tri_pslg pslg = draw(&random, lattice);
        check(&pslg, support_below(&random, 6) == 0, !lattice && support_below(&random, 3) == 0, seen);
        tri_pslg_free(&pslg);
    }
    for (int reason = TRI_EMPTY_NOT; reason <= TRI_EMPTY_HOLES; reason++)
        if (reason != TRI_EMPTY_LINE && reason != TRI_EMPTY_CANCELLED && reason != TRI_EMPTY_BARE)
            assert_true(seen[reason] > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sentences_match_the_table),
        cmocka_unit_test(test_numbers_from_one),
        cmocka_unit_test(test_the_longest_sentences_fit),
        cmocka_unit_test(test_following_the_advice_gives_a_mesh),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
