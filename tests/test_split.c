/* Split points lie near the lines of their parents, and the boundary never intersects itself, even where much of it
   lies within a few units in the last place. The checker confirms the mesh: no overlap, no lost vertex, every segment
   kept. */
#include "support.h"

#include "triangle/cdt/crossing.h"
#include "triangle/refine/split.h"

enum { ROOM = 200 };

/* In resolutions: half a unit in the last place in each coordinate, and one more unit in the rare cases that need
   it. */
static const double ROUNDING = 0.7072, BESIDE = 2.1214;

static struct support_random random_numbers;

static double between(double low, double high) { return low + (high - low) * support_unit(&random_numbers); }

static int32_t below(int32_t n) { return support_below(&random_numbers, n); }

/* Moves a point by up to the given number of units in the last place. */
static double moved_by_ulps(double x, int32_t ulps)
{
    for (int32_t n = below(2 * ulps + 1) - ulps; n != 0; n += n < 0 ? 1 : -1)
        x = nextafter(x, n < 0 ? -INFINITY : INFINITY);
    return x;
}

/* A figure, rotated and moved away from the origin. p has the coordinates of the drawing. */
struct frame {
    double c, s, offset;
};

static struct frame random_frame(void)
{
    double t = between(0, 1), offset = below(2) ? 0.1 : ldexp(between(1, 2), below(24));
    return (struct frame){(1 - t * t) / (1 + t * t), 2 * t / (1 + t * t), offset};
}

static int32_t add(struct tri_pslg *pslg, const struct frame *f, double x, double y)
{
    return support_add_point(pslg, f->offset + f->c * x - f->s * y, f->offset + f->s * x + f->c * y);
}

static int32_t add_copy(struct tri_pslg *pslg, int32_t v, int32_t ulps)
{
    return support_add_point(pslg, moved_by_ulps(pslg->points[2 * v], ulps),
                             moved_by_ulps(pslg->points[2 * v + 1], ulps));
}

static void add_hole(struct tri_pslg *pslg, const struct frame *f, double x, double y)
{
    double *hole = pslg->holes + 2 * pslg->n_holes++;
    hole[0] = f->offset + f->c * x - f->s * y;
    hole[1] = f->offset + f->s * x + f->c * y;
}

/* Closes the ring of the vertices from `first` on. */
static void close_ring(struct tri_pslg *pslg, int32_t first)
{
    for (int32_t v = first; v < pslg->n_points; v++)
        support_add_segment(pslg, v, v + 1 < pslg->n_points ? v + 1 : first);
}

/* Two figures on the two sides of a shore that they share up to rounding. */
static struct tri_pslg shores(void)
{
    struct tri_pslg pslg = support_pslg(ROOM, ROOM, 0, 0);
    struct frame f = random_frame();
    int32_t n = 3 + below(12), ulps = 1 + below(4);
    add(&pslg, &f, 0, -1);
    for (int32_t i = 0; i < n; i++)
        add(&pslg, &f, i, between(0, 0.3));
    add(&pslg, &f, n - 1, -1);
    close_ring(&pslg, 0);
    int32_t first = add(&pslg, &f, 0, 2);
    for (int32_t i = 1; i <= n; i++)
        add_copy(&pslg, i, ulps);
    add(&pslg, &f, n - 1, 2);
    close_ring(&pslg, first);
    return pslg;
}

/* Holes in a square, side by side, as thin as rounding allows. */
static struct tri_pslg thin_holes(void)
{
    struct tri_pslg pslg = support_pslg(ROOM, ROOM, 20, 0);
    struct frame f = random_frame();
    int32_t n = 1 + below(6), tip = -1, ulps = 1 + below(6);
    add(&pslg, &f, -2, -2), add(&pslg, &f, 12, -2), add(&pslg, &f, 12, 12), add(&pslg, &f, -2, 12);
    close_ring(&pslg, 0);
    for (int32_t i = 0; i < n; i++) {
        double y = i, width = between(0.01, 0.9);
        int32_t first = add(&pslg, &f, 0, y);
        add(&pslg, &f, 0, y + width);
        tip = tip < 0 ? add(&pslg, &f, 9, between(0, n)) : add_copy(&pslg, tip, ulps);
        add_copy(&pslg, tip, ulps);
        close_ring(&pslg, first);
        add_hole(&pslg, &f, 0.01, y + width / 2);
    }
    return pslg;
}

/* A ring with spikes: each goes out and returns to nearly the same place. */
static struct tri_pslg spikes(void)
{
    struct tri_pslg pslg = support_pslg(ROOM, ROOM, 0, 0);
    struct frame f = random_frame();
    int32_t n = 5 + below(20), ulps = 1 + below(5);
    for (int32_t i = 0; i < n; i++) {
        double angle = 6.283185307179586 * i / n, far = between(1.5, 4);
        int32_t root = add(&pslg, &f, cos(angle), sin(angle));
        if (below(3) == 0)
            continue;
        if (below(2)) /* a spike inwards or outwards */
            far = 1 / far;
        add(&pslg, &f, far * cos(angle), far * sin(angle));
        add_copy(&pslg, root, ulps);
    }
    close_ring(&pslg, 0);
    return pslg;
}

/* A polygon with holes. Each hole fills a part of a grid cell up to a few units in the last place. */
static struct tri_pslg holes_wall_to_wall(void)
{
    struct tri_pslg pslg = support_pslg(ROOM, ROOM, 30, 0);
    struct frame f = random_frame();
    int32_t n = 2 + below(3), ulps = 1 + below(4);
    add(&pslg, &f, 0, 0), add(&pslg, &f, n, 0), add(&pslg, &f, n, n), add(&pslg, &f, 0, n);
    close_ring(&pslg, 0);
    for (int32_t i = 0; i < n; i++)
        for (int32_t j = 0; j < n; j++) {
            if (below(3) == 0)
                continue;
            int32_t first = add(&pslg, &f, i, j);
            add(&pslg, &f, i + 1, j), add(&pslg, &f, i + 1, j + 1), add(&pslg, &f, i, j + 1);
            for (int32_t k = 0; k < 8; k++)
                pslg.points[2 * first + k] = moved_by_ulps(pslg.points[2 * first + k], ulps);
            close_ring(&pslg, first);
            add_hole(&pslg, &f, i + 0.5, j + 0.5);
        }
    return pslg;
}

static struct tri_pslg (*const make[])(void) = {shores, thin_holes, spikes, holes_wall_to_wall};

enum { KINDS = sizeof make / sizeof *make };

static struct tri_pslg make_figure(int kind, uint64_t seed)
{
    random_numbers.state = seed * KINDS + (uint64_t)kind;
    return make[kind]();
}

static bool is_boundary(const struct tri_subsegment *s) { return s->side[0] == TRI_NONE || s->side[1] == TRI_NONE; }

/* Ends of the parent, in the order in which the mesh lies to the left of the way from *a to *b. */
static void ends(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_point *a, struct tri_point *b)
{
    const struct tri_parent *parent = &mesh->parents[s->parent];
    struct tri_point from = mesh->xy[s->v[0]], to = mesh->xy[s->v[1]];
    *a = mesh->xy[parent->v[0]];
    *b = mesh->xy[parent->v[1]];
    bool along = (b->x - a->x) * (to.x - from.x) + (b->y - a->y) * (to.y - from.y) > 0;
    if (along != (s->side[0] != TRI_NONE)) {
        struct tri_point swap = *a;
        *a = *b;
        *b = swap;
    }
}

/* How far the ends of subsegments lie off the lines of their parents, in resolutions. */
struct deviation {
    int64_t n, n_beyond_one, n_beyond_two;
    double inner, boundary; /* largest distance inside the domain and on the boundary */
};

static void measure(const struct tri_mesh *mesh, struct deviation *d)
{
    for (int32_t i = 0; i < 2 * mesh->n_subs; i++) {
        const struct tri_subsegment *s = &mesh->sub[i / 2];
        const struct tri_parent *parent = &mesh->parents[s->parent];
        int32_t v = s->v[i % 2];
        if (v == parent->v[0] || v == parent->v[1])
            continue;
        double off = tri_line_distance(mesh->xy[parent->v[0]], mesh->xy[parent->v[1]], mesh->xy[v]) /
                     tri_resolution(mesh->xy[v]);
        double *largest = is_boundary(s) ? &d->boundary : &d->inner;
        *largest = fmax(*largest, off);
        d->n++;
        d->n_beyond_one += off > 1;
        d->n_beyond_two += off > 2;
    }
}

static struct tri_options refined(double min_angle, double max_area, bool conforming)
{
    struct tri_options options = support_quality(min_angle, max_area);
    options.quality.conforming = conforming;
    options.quality.max_steiner = 600;
    return options;
}

static void expect_good(const struct tri_mesh *mesh, const struct tri_pslg *pslg, int kind, int seed)
{
    struct tri_check_options asked = {.max_bad = INT64_MAX};
    struct tri_check_report report;
    char text[SUPPORT_TEXT];
    if (mesh->n_triangles > 0 && !support_passes(mesh, pslg, &asked, false, &report, text))
        fail_msg("kind %d, seed %d: %s", kind, seed, text);
}

static void test_refined_boundaries_do_not_intersect(void **state)
{
    (void)state;
    const struct tri_options options[] = {refined(20, 0, false), refined(30, 0, false), refined(0, 0.05, false),
                                          refined(25, 0, true)};
    struct deviation d = {0};
    for (int kind = 0; kind < KINDS; kind++)
        for (int seed = 0; seed < 100; seed++) {
            struct tri_pslg pslg = make_figure(kind, (uint64_t)seed);
            struct tri_mesh mesh = support_generate(&pslg, &options[seed % 4], NULL);
            expect_good(&mesh, &pslg, kind, seed);
            measure(&mesh, &d);
            tri_mesh_free(&mesh);
            tri_pslg_free(&pslg);
        }
    print_message("  %lld ends, %lld more than one resolution off, %lld more than two; inner %g, boundary %g at most\n",
                  (long long)d.n, (long long)d.n_beyond_one, (long long)d.n_beyond_two, d.inner, d.boundary);
    assert_true(d.n > 10000);
    assert_true(d.inner <= BESIDE);
    assert_true(d.n_beyond_one <= d.n / 5 && d.n_beyond_two <= d.n / 20);
}

/* Errors do not accumulate, regardless of how often a segment is split. */
static void test_chains_stay_on_their_lines(void **state)
{
    (void)state;
    struct tri_options options = support_quality(20, 0.002);
    struct deviation d = {0};
    for (uint64_t seed = 0; seed < 10; seed++) {
        struct tri_pslg pslg = support_square(3, 6, seed), all = support_pslg(10, 7, 0, 0);
        for (int32_t v = 0; v < 10; v++)
            support_add_point(&all, pslg.points[2 * v] + 0.1, pslg.points[2 * v + 1] + 0.3);
        for (int32_t k = 0; k < 4; k++)
            support_add_segment(&all, k, (k + 1) % 4);
        for (int32_t k = 4; k < 7; k++)
            support_add_segment(&all, k, k + 3);
        struct tri_mesh mesh = support_generate(&all, &options, NULL);
        measure(&mesh, &d);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
        tri_pslg_free(&all);
    }
    assert_true(d.n > 1000 && d.inner > 0 && d.inner <= ROUNDING);
}

/* --- guards */

/* Does the other triangle lie to the right of an edge's line, or on it? Both are counter-clockwise. */
static bool separates(const struct tri_point t[3], const struct tri_point u[3])
{
    for (int e = 0; e < 3; e++) {
        bool apart = true;
        for (int k = 0; k < 3; k++)
            apart = apart && tri_orient2d(t[e], t[(e + 1) % 3], u[k]) <= 0;
        if (apart)
            return true;
    }
    return false;
}

static bool disjoint(const struct tri_point t[3], const struct tri_point u[3])
{
    return separates(t, u) || separates(u, t);
}

/* The triangles of the boundary's parents, counter-clockwise. Returns their number. */
static int32_t list_guarded(const struct tri_mesh *mesh, struct tri_point (*own)[3])
{
    int32_t n = 0;
    for (int32_t i = 0; i < mesh->n_subs; i++) {
        const struct tri_subsegment *s = &mesh->sub[i];
        struct tri_point guard = mesh->parents[s->parent].guard, a, b;
        if (!is_boundary(s))
            continue;
        ends(mesh, s, &a, &b);
        if (isnan(guard.x)) { /* no triangle lies beyond the parent */
            for (int32_t v = 0; v < mesh->n_vertices; v++)
                assert_true(tri_orient2d(a, b, mesh->xy[v]) >= 0);
        } else if (tri_orient2d(a, b, guard) != 0) {
            struct tri_point t[3] = {b, a, guard};
            assert_true(tri_orient2d(b, a, guard) > 0);
            memcpy(own[n++], t, sizeof t);
        }
    }
    return n;
}

static void expect_guarded(const struct tri_mesh *mesh, const struct tri_point (*own)[3], int32_t n)
{
    for (int32_t i = 0; i < n; i++) {
        for (int32_t j = 0; j < i; j++)
            assert_true(disjoint(own[i], own[j]));
        for (int32_t t = 0; t < mesh->n_triangles; t++) {
            const int32_t *v = mesh->tri[t].v;
            struct tri_point u[3] = {mesh->xy[v[0]], mesh->xy[v[1]], mesh->xy[v[2]]};
            assert_true(disjoint(own[i], u));
        }
    }
}

static void test_guards_do_not_overlap(void **state)
{
    (void)state;
    int32_t guarded = 0;
    struct tri_options options = support_quality(0, 0);
    options.refine = false;
    for (int kind = 0; kind < KINDS; kind++)
        for (int seed = 0; seed < 40; seed++) {
            struct tri_pslg pslg = make_figure(kind, (uint64_t)seed);
            struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
            struct tri_point (*own)[3] = malloc(((size_t)mesh.n_subs + 1) * sizeof *own);
            assert_non_null(own);
            int32_t n = list_guarded(&mesh, own);
            expect_guarded(&mesh, (const struct tri_point(*)[3])own, n);
            guarded += n;
            free(own);
            tri_mesh_free(&mesh);
            tri_pslg_free(&pslg);
        }
    assert_true(guarded > 1000);
}

/* --- without guards, as in a mesh that was read, split points of a boundary only move inwards */

static void take_guards(struct tri_mesh *mesh)
{
    for (int32_t p = 0; p < mesh->n_parents; p++)
        mesh->parents[p].guard = mesh->xy[mesh->parents[p].v[0]];
}

static void test_without_guards_boundaries_move_inwards(void **state)
{
    (void)state;
    struct tri_options options = support_quality(0, 0);
    int32_t inside = 0;
    options.refine = false;
    for (int kind = 0; kind < KINDS; kind++)
        for (int seed = 0; seed < 60; seed++) {
            struct tri_quality how = refined(seed % 2 ? 20 : 30, 0, false).quality;
            struct tri_refine_report report;
            struct tri_error error;
            struct tri_pslg pslg = make_figure(kind, (uint64_t)seed);
            struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
            take_guards(&mesh);
            assert_int_equal(tri_refine(&mesh, &how, &report, &error), TRI_OK);
            expect_good(&mesh, &pslg, kind, seed);
            for (int32_t i = 0; i < 2 * mesh.n_subs; i++) {
                const struct tri_subsegment *s = &mesh.sub[i / 2];
                struct tri_point a, b;
                if (!is_boundary(s))
                    continue;
                ends(&mesh, s, &a, &b);
                double side = tri_orient2d(a, b, mesh.xy[s->v[i % 2]]);
                assert_true(side >= 0);
                inside += side > 0;
            }
            tri_mesh_free(&mesh);
            tri_pslg_free(&pslg);
        }
    assert_true(inside > 1000);
}

/* --- single split points */

static void test_split_points_lie_at_the_fraction(void **state)
{
    (void)state;
    struct tri_options options = support_quality(0, 0);
    options.refine = false;
    for (int seed = 0; seed < 50; seed++) {
        struct tri_pslg pslg = support_polygon(12, (uint64_t)seed);
        struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
        for (int32_t i = 0; i < mesh.n_subs; i++) {
            double fraction = (1 + seed % 7) / 8.0;
            struct tri_point a = mesh.xy[mesh.sub[i].v[0]], b = mesh.xy[mesh.sub[i].v[1]], p;
            struct tri_split_base base = tri_split_base(&mesh, &mesh.sub[i], fraction);
            int choice = 0;
            while (choice < TRI_PLACES && !tri_place_split(&mesh, &mesh.sub[i], &base, choice, &p))
                choice++;
            assert_true(choice < TRI_PLACES);
            struct tri_point straight = tri_point_between(a, b, fraction);
            double resolution = fmax(tri_resolution(a), tri_resolution(b));
            assert_true(tri_line_distance(a, b, p) <= 3 * resolution);
            assert_true(hypot(p.x - straight.x, p.y - straight.y) <= 5 * resolution);
        }
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

/* A strip that is 10^6 wide and a few units in the last place high, with area bounds. Split points must lie at
   multiples of the finer coordinate's unit. With units of the larger coordinate, points would gather near the
   boundary endlessly. */
static void test_refinement_of_strips_of_a_few_ulps_ends(void **state)
{
    (void)state;
    const double wide = 1e6, ulp = 0x1p-52;
    const double corner[][2] = {{0, 1}, {wide, 1}, {wide, 1 + ulp}, {0.7 * wide, 1 + 4 * ulp}, {0, 1 + 2 * ulp}};
    enum { CORNERS = sizeof corner / sizeof *corner };
    struct tri_pslg pslg = support_pslg(CORNERS, CORNERS, 0, 0);
    for (int32_t i = 0; i < CORNERS; i++) {
        support_add_point(&pslg, corner[i][0], corner[i][1]);
        support_add_segment(&pslg, i, (i + 1) % CORNERS);
    }
    struct tri_options options = support_quality(0, wide * ulp / 100);
    struct tri_report report;
    options.quality.max_steiner = 2000; /* ten times as many as needed */
    struct tri_mesh mesh = support_generate(&pslg, &options, &report);
    assert_false(report.quality.hit_limit);
    assert_true(mesh.n_triangles < 200);
    support_judge(&mesh, &pslg, &(struct tri_check_options){.max_bad = INT64_MAX}, false, NULL);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* Subsegments at an acute vertex are split at distances that are powers of two, others in the middle. */
static void test_shells_are_powers_of_two(void **state)
{
    (void)state;
    struct tri_point xy[] = {{0, 0}, {3, 0}, {7, 0}};
    int32_t on[] = {TRI_VERTEX_ACUTE, TRI_VERTEX_INPUT, TRI_VERTEX_INPUT};
    struct tri_mesh mesh = {.xy = xy, .on = on, .n_vertices = 3};
    struct tri_subsegment from_acute = {.v = {0, 1}}, to_acute = {.v = {2, 0}}, plain = {.v = {1, 2}};
    assert_true(3 * tri_split_fraction(&mesh, &from_acute) == 2 || 3 * tri_split_fraction(&mesh, &from_acute) == 1);
    assert_true(fabs(7 * (1 - tri_split_fraction(&mesh, &to_acute)) - 4) < 1e-14);
    assert_true(tri_split_fraction(&mesh, &plain) == 0.5);
}

/* Each length is split at a fraction between 0.35 and 0.71. */
static void test_shells_are_near_the_middle(void **state)
{
    (void)state;
    struct support_random random = {1};
    for (int i = 0; i < 1000; i++) {
        struct tri_point xy[] = {{0, 0}, {ldexp(0.5 + support_unit(&random), i % 80 - 40), 0}};
        int32_t on[] = {TRI_VERTEX_ACUTE, TRI_VERTEX_INPUT};
        struct tri_mesh mesh = {.xy = xy, .on = on, .n_vertices = 2};
        struct tri_subsegment s = {.v = {0, 1}};
        double fraction = tri_split_fraction(&mesh, &s);
        int exponent;
        assert_true(fraction > 0.35 && fraction < 0.71);
        double mantissa = frexp(fraction * xy[1].x, &exponent);
        assert_true(mantissa - 0.5 < 1e-15 || 1 - mantissa < 1e-15);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shells_are_powers_of_two),
        cmocka_unit_test(test_shells_are_near_the_middle),
        cmocka_unit_test(test_refined_boundaries_do_not_intersect),
        cmocka_unit_test(test_chains_stay_on_their_lines),
        cmocka_unit_test(test_guards_do_not_overlap),
        cmocka_unit_test(test_without_guards_boundaries_move_inwards),
        cmocka_unit_test(test_split_points_lie_at_the_fraction),
        cmocka_unit_test(test_refinement_of_strips_of_a_few_ulps_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
