/* Simplified input, compared by naive means with the input as given: crossings of all pairs of segments, and for each
 * chain which hole and region points it encloses. */
#include "triangle/api/simplify.h"

#include "support.h"

static struct tri_point point_of(const double *at) { return (struct tri_point){at[0], at[1]}; }

static struct tri_point end_of(const struct tri_pslg *p, int32_t segment, int k)
{
    return point_of(&p->points[2 * (size_t)p->segments[2 * segment + k]]);
}

static int sign(double x) { return (x > 0) - (x < 0); }

/* Do the segments have a common point, other than a common end? */
static bool do_meet(const struct tri_pslg *p, int32_t i, int32_t j)
{
    const struct tri_point a = end_of(p, i, 0), b = end_of(p, i, 1), c = end_of(p, j, 0), d = end_of(p, j, 1);
    if (tri_compare_places(a, b) == 0 || tri_compare_places(c, d) == 0)
        return false;
    const int abc = sign(tri_orient2d(a, b, c)), abd = sign(tri_orient2d(a, b, d));
    const int cda = sign(tri_orient2d(c, d, a)), cdb = sign(tri_orient2d(c, d, b));
    if (abc * abd < 0 && cda * cdb < 0)
        return true;
    const struct tri_point at[4] = {c, d, a, b}, from[4] = {a, a, c, c}, to[4] = {b, b, d, d};
    const int side[4] = {abc, abd, cda, cdb};
    for (int k = 0; k < 4; k++) /* an end inside the other segment */
        if (side[k] == 0 && tri_dot(from[k], to[k], at[k]) < 0)
            return true;
    return false;
}

static int64_t count_meetings(const struct tri_pslg *p)
{
    int64_t n = 0;
    for (int32_t i = 0; i < p->n_segments; i++)
        for (int32_t j = 0; j < i; j++)
            n += do_meet(p, i, j);
    return n;
}

static int32_t count_shorter(const struct tri_pslg *p, double least)
{
    int32_t n = 0;
    for (int32_t i = 0; i < p->n_segments; i++)
        n += tri_distance2(end_of(p, i, 0), end_of(p, i, 1)) < least * least;
    return n;
}

/* Is the place inside the closed chain with this marker? *width: that of the chain; 0: there is none. */
static bool is_inside_chain(const struct tri_pslg *p, int32_t marker, struct tri_point at, double *width)
{
    bool inside = false;
    double left = HUGE_VAL, right = -HUGE_VAL;
    for (int32_t i = 0; i < p->n_segments; i++) {
        const struct tri_point a = end_of(p, i, 0), b = end_of(p, i, 1);
        if (p->segment_markers[i] != marker)
            continue;
        left = fmin(left, a.x);
        right = fmax(right, a.x);
        if ((a.y > at.y) != (b.y > at.y) && at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x))
            inside = !inside;
    }
    *width = fmax(0, right - left);
    return inside;
}

static struct tri_pslg copy_of(const struct tri_pslg *p)
{
    struct tri_pslg copy = support_pslg(p->n_points, p->n_segments, p->n_holes, p->n_regions);
    copy.n_points = p->n_points, copy.n_segments = p->n_segments, copy.n_holes = p->n_holes;
    copy.n_regions = p->n_regions;
    memcpy(copy.points, p->points, 2 * (size_t)p->n_points * sizeof *p->points);
    memcpy(copy.segments, p->segments, 2 * (size_t)p->n_segments * sizeof *p->segments);
    if (p->n_holes > 0)
        memcpy(copy.holes, p->holes, 2 * (size_t)p->n_holes * sizeof *p->holes);
    if (p->n_regions > 0)
        memcpy(copy.regions, p->regions, 4 * (size_t)p->n_regions * sizeof *p->regions);
    copy.segment_markers = malloc((size_t)p->n_segments * sizeof *copy.segment_markers);
    assert_non_null(copy.segment_markers);
    if (p->markers) {
        copy.markers = malloc((size_t)p->n_points * sizeof *copy.markers);
        assert_non_null(copy.markers);
        memcpy(copy.markers, p->markers, (size_t)p->n_points * sizeof *p->markers);
    }
    for (int32_t i = 0; i < p->n_segments; i++)
        copy.segment_markers[i] = p->segment_markers ? p->segment_markers[i] : 0;
    return copy;
}

/* Compares the hole points (width 2) or region points (4) with those before. A point is gone if the innermost
 * chain around it is. All others are enclosed by the same chains. Markers 1 .. n_chains name the chains. */
static void check_seeds(const struct tri_pslg *before, const struct tri_pslg *after, int32_t n_chains, bool holes)
{
    const int width = holes ? 2 : 4;
    const double *old = holes ? before->holes : before->regions, *new = holes ? after->holes : after->regions;
    const int32_t n_old = holes ? before->n_holes : before->n_regions;
    const int32_t n_new = holes ? after->n_holes : after->n_regions;
    int32_t k = 0;
    for (int32_t i = 0; i < n_old; i++) {
        const double *at = &old[width * i];
        const bool is_kept = k < n_new && memcmp(at, &new[width * k], (size_t)width * sizeof *at) == 0;
        bool is_lost = false;
        double least = HUGE_VAL;
        for (int32_t marker = 1; marker <= n_chains; marker++) {
            double span, left;
            const bool was = is_inside_chain(before, marker, point_of(at), &span);
            const bool is = is_inside_chain(after, marker, point_of(at), &left);
            is_lost = was && span < least ? left == 0 : is_lost;
            least = was ? fmin(span, least) : least;
            if (is_kept && left > 0)
                assert_int_equal(was, is);
        }
        assert_int_equal(is_kept, !is_lost);
        k += is_kept;
    }
    assert_int_equal(k, n_new);
}

/* Simplifies a copy. Markers 1 .. n_chains name closed chains; 0: the segments are no closed chains. */
static struct tri_simplify_report check_simplified(const struct tri_pslg *given, double least, int32_t n_chains)
{
    struct tri_pslg p = copy_of(given);
    struct tri_simplify_report report;
    assert_int_equal(tri_simplify(&p, least, NULL, NULL, &report, NULL), TRI_OK);
    assert_int_equal(count_meetings(&p), count_meetings(given));
    assert_int_equal(report.shorter, count_shorter(&p, least));
    assert_int_equal(p.n_points, given->n_points - report.corners - report.island_points);
    int32_t skipped = 0;
    for (int32_t i = 0; i < given->n_segments; i++)
        skipped += given->segments[2 * i] == given->segments[2 * i + 1];
    assert_int_equal(p.n_segments, given->n_segments - skipped - report.corners - report.island_points);
    assert_int_equal(p.n_holes, given->n_holes - report.holes);
    assert_int_equal(p.n_regions, given->n_regions - report.regions);
    if (n_chains > 0) {
        check_seeds(given, &p, n_chains, true);
        check_seeds(given, &p, n_chains, false);
    }
    tri_pslg_free(&p);
    return report;
}

/* Adds a ring of n points at random distances from its centre, from low to 1 times the radius. */
static void add_ring(struct tri_pslg *p, struct support_random *random, struct tri_point centre, double radius,
                     double low, int32_t n, int32_t marker)
{
    const int32_t first = p->n_points;
    for (int32_t k = 0; k < n; k++) {
        const double angle = 6.283185307179586 * k / n, r = radius * (low + (1 - low) * support_unit(random));
        support_add_point(p, centre.x + r * cos(angle), centre.y + r * sin(angle));
    }
    for (int32_t k = 0; k < n; k++) {
        p->segment_markers[p->n_segments] = marker;
        support_add_segment(p, first + k, first + (k + 1) % n);
    }
}

enum { ISLANDS = 30, AROUND = 40 };

/* A rough ring with rough islands on a lattice in it. Some are nested, and have hole or region points. Some of those
 * inside others have markers of their own at each point, and stay. */
static struct tri_pslg archipelago(uint64_t seed)
{
    struct support_random random = {seed};
    const int32_t points = 400 + 2 * ISLANDS * AROUND;
    struct tri_pslg p = support_pslg(points, points, 2 * ISLANDS, 2 * ISLANDS);
    p.segment_markers = calloc((size_t)points, sizeof *p.segment_markers);
    p.markers = calloc((size_t)points, sizeof *p.markers);
    assert_true(p.segment_markers && p.markers);
    add_ring(&p, &random, (struct tri_point){3, 3}, 5.5, 0.9, 400, 1);
    for (int32_t k = 0; k < ISLANDS; k++) {
        const struct tri_point centre = {k % 6 + 0.5, k / 6 + 0.5};
        const double radius = 0.48 * support_unit(&random) + 0.01;
        add_ring(&p, &random, centre, radius, 0.6, AROUND, 2 + 2 * k);
        if (k % 2)
            add_ring(&p, &random, centre, 0.5 * radius, 0.5, AROUND, 3 + 2 * k);
        for (int32_t v = p.n_points - AROUND; k % 10 == 3 && v < p.n_points; v++)
            p.markers[v] = 1000 + v;
        double *at = k % 3 ? &p.holes[2 * p.n_holes++] : &p.regions[4 * p.n_regions++];
        at[0] = centre.x + (k % 4 == 1 ? 0.55 * radius : 0);
        at[1] = centre.y;
    }
    return p;
}

static void test_chains_keep_their_places(void **state)
{
    (void)state;
    int32_t islands = 0, corners = 0, regions = 0;
    for (uint64_t seed = 1; seed <= 6; seed++) {
        struct tri_pslg p = archipelago(seed);
        for (double least = 0.01; least < 3; least *= 2.3) {
            const struct tri_simplify_report r = check_simplified(&p, least, 1 + 2 * ISLANDS);
            islands += r.islands, corners += r.corners, regions += r.regions;
        }
        tri_pslg_free(&p);
    }
    assert_true(islands > 100 && corners > 1000 && regions > 10);
}

/* In a circle, with a hole point far outside, nothing is in the way. It becomes a polygon whose sides have about the
 * length L. */
static void test_a_circle_has_no_short_segments(void **state)
{
    (void)state;
    struct support_random random = {1};
    struct tri_pslg p = support_pslg(2000, 2000, 1, 0);
    p.n_holes = 1;
    p.holes[0] = p.holes[1] = 1e300; /* too far away for exact arithmetic */
    p.segment_markers = calloc(2000, sizeof *p.segment_markers);
    assert_non_null(p.segment_markers);
    add_ring(&p, &random, (struct tri_point){5, -7}, 1, 1, 2000, 1);
    const struct tri_simplify_report r = check_simplified(&p, 0.2, 1);
    assert_int_equal(r.shorter, 0);
    assert_in_range(2000 - r.corners, 5, 31);
    tri_pslg_free(&p);
}

/* Paths of short steps in random directions, which cross themselves and each other, with isolated points between. */
static struct tri_pslg random_walks(uint64_t seed)
{
    enum { STEPS = 300 };
    struct support_random random = {seed};
    struct tri_pslg p = support_pslg(2 * STEPS, 2 * STEPS, 0, 0);
    double x = 0, y = 0, angle = 0;
    for (int32_t k = 0; k < STEPS; k++) {
        angle += 2 * support_unit(&random) - 1;
        x += 0.05 * cos(angle);
        y += 0.05 * sin(angle);
        const int32_t v = support_add_point(&p, seed % 2 ? x : floor(30 * x), seed % 2 ? y : floor(30 * y));
        if (k % 100)
            support_add_segment(&p, v - 1 - (k % 7 == 1), v);
        if (k % 7 == 0)
            support_add_point(&p, x + 0.1, y);
    }
    return p;
}

/* A step in a long wall goes, although its corners are large. A narrow strip stays: it would become a needle. */
static void test_short_steps_go(void **state)
{
    (void)state;
    static const double step[][2] = {{0, 0}, {10, 0}, {10, 5}, {5, 5}, {5, 5.3}, {0, 5.3}};
    static const double strip[][2] = {{0, 0}, {10, 0}, {10, 0.3}, {0, 0.3}};
    struct tri_pslg p = support_pslg(6, 6, 0, 0), q = support_pslg(4, 4, 0, 0);
    for (int32_t k = 0; k < 6; k++) {
        support_add_point(&p, step[k][0], step[k][1]);
        support_add_segment(&p, k, (k + 1) % 6);
    }
    for (int32_t k = 0; k < 4; k++) {
        support_add_point(&q, strip[k][0], strip[k][1]);
        support_add_segment(&q, k, (k + 1) % 4);
    }
    const struct tri_simplify_report r = check_simplified(&p, 0.5, 0), s = check_simplified(&q, 0.5, 0);
    assert_true(r.corners == 1 && r.shorter == 0);
    assert_true(s.corners == 0 && s.shorter == 2);
    tri_pslg_free(&p);
    tri_pslg_free(&q);
}

/* Crossing, overlapping and touching segments: no meeting comes or goes. */
static void test_tangles_meet_as_before(void **state)
{
    (void)state;
    int32_t corners = 0;
    int64_t meetings = 0;
    for (uint64_t seed = 1; seed <= 60; seed++) {
        struct tri_pslg p = seed % 3 ? random_walks(seed) : support_tangle(SUPPORT_LATTICE, 60, 40, seed);
        meetings += count_meetings(&p);
        corners += check_simplified(&p, seed % 2 ? 0.2 : 3, 0).corners;
        tri_pslg_free(&p);
    }
    assert_true(corners > 1000 && meetings > 100);
}

/* A square of fine segments, one side with a marker of its own, and a spur: their ends stay. */
static void test_ends_of_chains_stay(void **state)
{
    (void)state;
    struct tri_pslg p = support_pslg(44, 44, 0, 0);
    p.segment_markers = calloc(44, sizeof *p.segment_markers);
    assert_non_null(p.segment_markers);
    for (int32_t k = 0; k < 40; k++) {
        const double along = k % 10 / 10.0;
        const int32_t side = k / 10;
        support_add_point(&p, side == 0 ? along : side == 1 ? 1 : side == 2 ? 1 - along : 0,
                          side == 0 ? 0 : side == 1 ? along : side == 2 ? 1 : 1 - along);
    }
    for (int32_t k = 0; k < 40; k++) {
        p.segment_markers[k] = k >= 13 && k < 17 ? 2 : 1;
        support_add_segment(&p, k, (k + 1) % 40);
    }
    for (int32_t k = 0; k < 4; k++) { /* from the middle of the lowest side */
        support_add_point(&p, 0.5, 0.1 * (k + 1));
        p.segment_markers[40 + k] = 1;
        support_add_segment(&p, k ? 39 + k : 5, 40 + k);
    }
    struct tri_pslg after = copy_of(&p);
    struct tri_simplify_report report;
    assert_int_equal(tri_simplify(&after, 0.5, NULL, NULL, &report, NULL), TRI_OK);
    static const double stay[][2] = {{0.5, 0}, {1, 0.3}, {1, 0.7}, {0.5, 0.4}};
    for (size_t k = 0; k < sizeof stay / sizeof *stay; k++) {
        bool found = false;
        for (int32_t v = 0; v < after.n_points; v++)
            found = found || memcmp(&after.points[2 * v], stay[k], sizeof stay[k]) == 0;
        assert_true(found);
    }
    int32_t second = 0;
    for (int32_t i = 0; i < after.n_segments; i++)
        second += after.segment_markers[i] == 2;
    assert_int_equal(second, 1);
    assert_true(report.corners > 25 && report.shorter > 0);
    tri_pslg_free(&after);
    tri_pslg_free(&p);
}

/* A real coast. Its chains become closed chains with a marker each. */
static void test_a_coast(void **state)
{
    (void)state;
    struct tri_pslg p;
    assert_true(support_read("coast/islands.poly", &p));
    int32_t *chain = calloc((size_t)p.n_points, sizeof *chain), n = 0;
    assert_non_null(chain);
    for (int32_t v = 0; v < p.n_points; v++) {
        if (chain[v])
            continue;
        chain[v] = ++n;
        for (bool changed = true; changed;) {
            changed = false;
            for (int32_t i = 0; i < p.n_segments; i++) {
                int32_t *a = &chain[p.segments[2 * i]], *b = &chain[p.segments[2 * i + 1]];
                changed = changed || (*a != *b && (*a == n || *b == n));
                *a = *b == n ? n : *a;
                *b = *a == n ? n : *b;
            }
        }
    }
    for (int32_t i = 0; i < p.n_segments; i++)
        p.segment_markers[i] = chain[p.segments[2 * i]];
    free(chain);
    assert_in_range(n, 10, 1000);
    const struct tri_simplify_report r = check_simplified(&p, 10000, n);
    assert_true(r.islands > 3 && r.holes > 3 && r.corners > 300);
    tri_pslg_free(&p);
}

static void test_nothing_is_left(void **state)
{
    (void)state;
    struct tri_pslg p = archipelago(1);
    memset(p.markers, 0, (size_t)p.n_points * sizeof *p.markers);
    struct tri_pslg copy = copy_of(&p);
    struct tri_simplify_report report;
    struct tri_error error = {0};
    assert_int_equal(tri_simplify(&p, 100, NULL, NULL, &report, &error), TRI_BAD_INPUT);
    assert_non_null(strstr(error.text, "no segment remains"));
    copy.n_segments = 0; /* there is nothing to do */
    assert_int_equal(tri_simplify(&copy, 100, NULL, NULL, &report, NULL), TRI_OK);
    assert_int_equal(report.corners + report.islands, 0);
    tri_pslg_free(&copy);
    tri_pslg_free(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_chains_keep_their_places), cmocka_unit_test(test_a_circle_has_no_short_segments),
        cmocka_unit_test(test_tangles_meet_as_before),   cmocka_unit_test(test_ends_of_chains_stay),
        cmocka_unit_test(test_a_coast),                  cmocka_unit_test(test_nothing_is_left),
        cmocka_unit_test(test_short_steps_go),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
