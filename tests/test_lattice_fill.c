/* Insertion of whole lattice cells. The mesh keeps all guarantees, wherever the call pauses, fails or stops, and with
 * any fence. The checker verifies every mesh. */
#include "allocations.h"
#include "full.h"
#include "support.h"

#include "triangle/mesh/surface.h"
#include "triangle/refine/lattice.h"
#include "triangle/refine/refine.h"
#include "triangle/tunables.h"

static double total_area(const struct tri_mesh *mesh)
{
    double area2 = 0;
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        const int32_t *v = mesh->tri[t].v;
        area2 += tri_orient2d(mesh->xy[v[0]], mesh->xy[v[1]], mesh->xy[v[2]]);
    }
    return 0.5 * area2 * mesh->unit * mesh->unit;
}

static struct tri_pslg load(const char *name)
{
    struct tri_pslg pslg;
    if (!support_read(name, &pslg))
        fail_msg("cannot read %s", name);
    return pslg;
}

/* The mesh before refinement. */
static struct tri_mesh coarse_mesh(const struct tri_pslg *pslg, const struct tri_options *options)
{
    struct tri_options coarse = *options;
    coarse.refine = false;
    return support_generate(pslg, &coarse, NULL);
}

static struct tri_options in_lattice(double min_angle, double max_area)
{
    struct tri_options options = support_quality(min_angle, max_area);
    options.quality.lattice = true;
    return options;
}

/* Checks a mesh for these options; max_bad as in tri_check_options. */
static void judge(const struct tri_mesh *mesh, const struct tri_pslg *pslg, const struct tri_options *options,
                  int64_t max_bad)
{
    struct tri_check_options check = {.max_bad = max_bad, .min_angle = options->quality.min_angle, .ignore_lost = true};
    check.max_area = options->quality.max_area;
    check.delaunay = options->quality.conforming ? TRI_CHECK_CONFORMING : TRI_CHECK_CONSTRAINED;
    support_judge(mesh, pslg, &check, options->quality.region_areas, NULL);
}

/* Number of bad triangles, for any reason. If segments meet at small angles inside a fence, some may stay bad. */
static int64_t count_bad(const struct tri_mesh *mesh, const struct tri_options *options,
                         const struct tri_refine_report *report)
{
    int64_t count[TRI_EXCUSES], sum = 0;
    tri_count_bad(mesh, &options->quality, report, NULL, count);
    for (int k = 0; k < TRI_EXCUSES; k++)
        sum += count[k];
    return sum;
}

/* Checks that a mesh is valid, although it may be unfinished. */
static void judge_as_far_as_it_got(const struct tri_mesh *mesh, const struct tri_pslg *pslg)
{
    support_judge(mesh, pslg, &(struct tri_check_options){.max_bad = mesh->n_triangles, .min_angle = 30}, false, NULL);
}

/* --- bounds */

/* With the lattice the mesh satisfies all bounds and has hardly more triangles than without it. */
static void compare_with_classic(const struct tri_pslg *pslg, struct tri_options options, int64_t max_bad)
{
    options.quality.lattice = false;
    struct tri_mesh classic = support_generate(pslg, &options, NULL);
    const int32_t n = classic.n_triangles;
    tri_mesh_free(&classic);
    options.quality.lattice = true;
    struct tri_mesh mesh = support_generate(pslg, &options, NULL);
    print_message("  angle %g, -D %d, -Y %d: %d triangles, classic %d\n", options.quality.min_angle,
                  options.quality.conforming, options.quality.protect, mesh.n_triangles, n);
    judge(&mesh, pslg, &options, max_bad);
    assert_true(n <= 2000 || mesh.n_triangles <= 1.02 * n);
    tri_mesh_free(&mesh);
}

/* The area bound for about this many triangles. */
static double bound_for(const struct tri_pslg *pslg, int32_t triangles)
{
    const struct tri_options plain = support_quality(0, 0);
    struct tri_mesh coarse = coarse_mesh(pslg, &plain);
    const double area = total_area(&coarse);
    tri_mesh_free(&coarse);
    return area / triangles;
}

static void test_figures(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        int32_t triangles;
    } figures[] = {{"letter.poly", 2500}, {"perforated.poly", 3500}, {"square_random1000.poly", 6000},
                   {"gear.poly", 1500},   {"koch_lake.poly", 2000},  {"naca2412_box.poly", 1500},
                   {"box_hole.poly", 1200}};
    for (size_t i = 0; i < sizeof figures / sizeof *figures; i++) {
        struct tri_pslg pslg = load(figures[i].name);
        const double bound = bound_for(&pslg, figures[i].triangles);
        print_message("%s\n", figures[i].name);
        for (int k = 0; k < 3; k++) {
            struct tri_options options = support_quality(k == 0 ? 0 : k == 1 ? 20 : 30, bound);
            options.quality.conforming = k == 1;
            compare_with_classic(&pslg, options, 0);
        }
        tri_pslg_free(&pslg);
    }
}

static void test_coasts(void **state)
{
    (void)state;
    static const char *const coasts[] = {"coast/islands.poly", "coast/norway_sea.poly"};
    for (int i = 0; i < 2; i++) {
        struct tri_pslg pslg = load(coasts[i]);
        print_message("%s\n", coasts[i]);
        compare_with_classic(&pslg, support_quality(25, bound_for(&pslg, 4000)), -1);
        tri_pslg_free(&pslg);
    }
}

/* Segments that must not be split. Size bounds hold nevertheless. */
static void test_protected_segments(void **state)
{
    (void)state;
    static const char *const names[] = {"letter.poly", "perforated.poly"};
    for (int i = 0; i < 4; i++) {
        struct tri_pslg pslg = load(names[i / 2]);
        struct tri_options options = support_quality(20, bound_for(&pslg, 2500));
        options.quality.protect = 1 + i % 2;
        compare_with_classic(&pslg, options, 2500);
        tri_pslg_free(&pslg);
    }
}

/* Segments that cross, overlap, and meet at small angles. */
static void test_tangles(void **state)
{
    (void)state;
    static const enum support_kind kinds[] = {SUPPORT_RANDOM, SUPPORT_LATTICE, SUPPORT_RING};
    for (int kind = 0; kind < 3; kind++)
        for (uint64_t seed = 0; seed < 60; seed += (uint64_t)every(5)) {
            struct tri_pslg pslg = support_tangle(kinds[kind], 9, (int32_t)(seed % 8), seed);
            struct tri_options options = in_lattice(seed % 2 ? 25 : 0, bound_for(&pslg, 1500));
            options.quality.conforming = seed % 3 == 0;
            struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
            judge(&mesh, &pslg, &options, -1);
            tri_mesh_free(&mesh);
            tri_pslg_free(&pslg);
        }
}

/* A square of side 3 with n points and three columns. Each column is a region with its own bound; 0: no bound. */
static struct tri_pslg columns(double first, double second, double third, int32_t n)
{
    struct support_random random = {11};
    const double bounds[3] = {first, second, third};
    struct tri_pslg pslg = support_pslg(8 + n, 10, 0, 3);
    for (int32_t i = 0; i < 4; i++) {
        support_add_point(&pslg, i, 0);
        support_add_point(&pslg, i, 3);
        support_add_segment(&pslg, 2 * i, 2 * i + 1);
        for (int32_t k = 0; k < 2 && i < 3; k++)
            support_add_segment(&pslg, 2 * i + k, 2 * i + 2 + k);
    }
    for (int32_t i = 0; i < n; i++)
        support_add_point(&pslg, 3 * support_unit(&random), 3 * support_unit(&random));
    for (int k = 0; k < 3; k++) {
        const double region[4] = {k + 0.5, 1.5, k + 1, bounds[k]};
        memcpy(&pslg.regions[4 * pslg.n_regions++], region, sizeof region);
    }
    return pslg;
}

static void test_regions(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        struct tri_pslg pslg = i % 2 == 0 ? columns(0.002, 0, 0.0031, 40) : load("section.poly");
        struct tri_options options = support_quality(28, i < 2 ? 0 : i == 2 ? 0.002 : bound_for(&pslg, 3000));
        options.spread_regions = options.quality.region_areas = true;
        compare_with_classic(&pslg, options, 0);
        tri_pslg_free(&pslg);
    }
}

/* Regions that meet along edges without a subsegment. */
static void test_regions_without_walls(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 6; seed++) {
        struct support_random random = {seed};
        struct tri_pslg pslg = columns(0.004, 0.004, seed % 2 ? 0.001 : 0.004, 0);
        struct tri_options options = in_lattice(seed % 3 ? 25 : 0, 0);
        struct tri_refine_report report;
        options.spread_regions = options.quality.region_areas = true;
        options.quality.conforming = seed == 2;
        struct tri_mesh mesh = coarse_mesh(&pslg, &options);
        assert_int_equal(mesh.n_regions, 4);
        for (int32_t t = 0; t < mesh.n_triangles; t++)
            mesh.tri[t].region = 1 + support_below(&random, 3);
        assert_int_equal(tri_refine(&mesh, &options.quality, &report, NULL), TRI_OK);
        assert_int_equal(tri_mesh_validate(&mesh, NULL), TRI_OK);
        support_assert_cdt(&mesh, false);
        for (int32_t t = 0; t < mesh.n_triangles; t++) {
            const struct tri_triangle *at = &mesh.tri[t];
            const double area2 = tri_orient2d(mesh.xy[at->v[0]], mesh.xy[at->v[1]], mesh.xy[at->v[2]]);
            assert_in_range(at->region, 1, 3);
            assert_true(0.5 * area2 <= mesh.regions[at->region].max_area);
        }
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

/* Far from the sides of a square there are only lattice points and equilateral triangles. */
static void test_middle_of_a_square(void **state)
{
    (void)state;
    const double side = 8, bound = 0.02, rise = sqrt(3) / 2, edge = sqrt(TRI_LATTICE_SHARE * bound / (rise / 2));
    struct tri_pslg pslg = support_square(side, 0, 1);
    for (int angle = 0; angle <= 30; angle += 30) {
        const struct tri_options options = in_lattice(angle, bound);
        struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
        int32_t n = 0;
        judge(&mesh, &pslg, &options, 0);
        assert_true(mesh.unit == 1);
        for (int32_t t = 0; t < mesh.n_triangles; t++) {
            const struct tri_point *p[3];
            bool far = true;
            for (int k = 0; k < 3; k++) {
                p[k] = &mesh.xy[mesh.tri[t].v[k]];
                far = far && fmin(fmin(p[k]->x, p[k]->y), side - fmax(p[k]->x, p[k]->y)) > 3 * edge;
            }
            n += far;
            for (int k = 0; far && k < 3; k++) {
                const double feature = mesh.feature[mesh.tri[t].v[k]];
                const double row = round(p[k]->y / (rise * edge)), shift = fmod(row, 2) != 0 ? 0.5 : 0;
                const double column = round(p[k]->x / edge - shift);
                assert_true(fabs(p[k]->y - row * rise * edge) < 1e-12);
                assert_true(fabs(p[k]->x - (column + shift) * edge) < 1e-12);
                assert_true(feature > 0 && feature < TRI_LATTICE_FEATURE * edge * (1 + 1e-12));
                assert_true(fabs(sqrt(tri_distance2(*p[k], *p[(k + 1) % 3])) - edge) < 1e-12);
            }
        }
        const double inner = side - 8 * edge;
        assert_true(n > inner * inner / bound);
        tri_mesh_free(&mesh);
    }
    tri_pslg_free(&pslg);
}

/* A figure scaled by a power of two has the same mesh, scaled by that factor. */
static void test_scaled(void **state)
{
    (void)state;
    for (int power = -30; power <= 40; power += 14) {
        struct tri_pslg pslg = load("letter.poly"), scaled = load("letter.poly");
        const double bound = bound_for(&pslg, 2000);
        for (int32_t i = 0; i < 2 * pslg.n_points; i++)
            scaled.points[i] = ldexp(scaled.points[i], power);
        for (int32_t i = 0; i < 2 * pslg.n_holes; i++)
            scaled.holes[i] = ldexp(scaled.holes[i], power);
        const struct tri_options options = in_lattice(25, bound), large = in_lattice(25, ldexp(bound, 2 * power));
        struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
        struct tri_mesh twin = support_generate(&scaled, &large, NULL);
        assert_int_equal(mesh.n_vertices, twin.n_vertices);
        for (int32_t v = 0; v < mesh.n_vertices; v++) {
            double at[2], expected[2];
            tri_mesh_place(&twin, v, at);
            tri_mesh_place(&mesh, v, expected);
            assert_true(at[0] == ldexp(expected[0], power) && at[1] == ldexp(expected[1], power));
        }
        judge(&twin, &scaled, &large, 0);
        tri_mesh_free(&mesh);
        tri_mesh_free(&twin);
        tri_pslg_free(&pslg);
        tri_pslg_free(&scaled);
    }
}

/* --- pauses */

static const struct tri_refine_hooks no_hooks;

enum { MANY = 100 };

/* A caller that has no room at first. */
struct host {
    int32_t asked;  /* number of points of the last request for room */
    int32_t most;   /* maximum over all requests */
    int32_t cells;  /* triangles inserted in batches of more than MANY */
    int32_t calls;
    struct tri_part part; /* receives the list of new triangles */
    int32_t grants; /* this many requests succeed */
    enum tri_status refusal; /* status of the later requests */
    int32_t vertices, triangles, subs; /* room in the mesh's arrays; the limits in the mesh are lower */
};

/* Gives the mesh room for exactly this number of points, of which one may be on a subsegment. */
static void make_room(struct host *host, struct tri_mesh *mesh, int32_t points)
{
    mesh->vertex_capacity = host->vertices;
    mesh->triangle_capacity = host->triangles;
    mesh->sub_capacity = host->subs;
    assert_int_equal(tri_mesh_reserve_vertices(mesh, points, NULL), TRI_OK);
    assert_int_equal(tri_mesh_reserve_triangles(mesh, 2 * points, NULL), TRI_OK);
    assert_int_equal(tri_mesh_reserve_subs(mesh, 1, NULL), TRI_OK);
    host->vertices = mesh->vertex_capacity;
    host->triangles = mesh->triangle_capacity;
    host->subs = mesh->sub_capacity;
    mesh->vertex_capacity = mesh->n_vertices + points;
    mesh->triangle_capacity = mesh->n_triangles + 2 * points;
    mesh->sub_capacity = mesh->n_subs + 1;
}

static void note_changes(void *user, const tri_triangle_id *triangle, int32_t n)
{
    struct host *host = user;
    assert_true(n > 0 && triangle[0] >= 0);
    host->cells += n > MANY ? n : 0;
}

static void lacks_nothing(void *user, const tri_vertex_id edge[2])
{
    (void)user, (void)edge;
    fail_msg("the whole mesh is there");
}

static enum tri_status ask_host(void *user, struct tri_mesh *mesh, int32_t points, struct tri_error *error)
{
    struct host *host = user;
    assert_true(points > 0);
    host->asked = points;
    host->most = points > host->most ? points : host->most;
    if (++host->calls > host->grants)
        return tri_fail(error, host->refusal, NULL, 0, "the host refuses");
    make_room(host, mesh, points);
    return TRI_OK;
}

static struct host host_for(struct tri_mesh *mesh, int32_t grants, enum tri_status refusal)
{
    struct host host = {.grants = grants, .refusal = refusal};
    host.vertices = mesh->vertex_capacity;
    host.triangles = mesh->triangle_capacity;
    host.subs = mesh->sub_capacity;
    make_room(&host, mesh, 1);
    return host;
}

/* Returns the hooks with those to the host added. */
static struct tri_refine_hooks hooks_to(struct host *host, struct tri_refine_hooks hooks)
{
    host->part = (struct tri_part){note_changes, lacks_nothing, host};
    hooks.part = &host->part;
    hooks.more_room = ask_host;
    hooks.more_room_user = host;
    return hooks;
}

static bool always(void *user)
{
    (void)user;
    return true;
}

static const struct tri_stop at_once = {always, NULL};

static void assert_valid(const struct tri_mesh *mesh)
{
    struct tri_error fault = {0};
    if (tri_mesh_validate(mesh, &fault) != TRI_OK)
        fail_msg("%s", fault.text);
}

/* Refines with a pause before each point that needs room, and at each question whether to stop. Returns the number of
 * triangles inserted in batches. */
static int32_t refine_with_pauses(struct tri_mesh *mesh, const struct tri_options *options,
                                  struct tri_refine_hooks hooks, struct tri_refine_report *report)
{
    struct host host = host_for(mesh, 0, TRI_NO_ROOM);
    struct tri_refiner *refiner;
    enum tri_status status;
    int pauses = 0, stops = 0;
    hooks = hooks_to(&host, hooks);
    assert_int_equal(tri_refiner_new(&refiner, mesh, &options->quality, &hooks, report, NULL), TRI_OK);
    mesh->stop = &at_once;
    while ((status = tri_refiner_run(refiner, NULL)) == TRI_NO_ROOM || status == TRI_STOPPED) {
        if (status == TRI_NO_ROOM)
            make_room(&host, mesh, host.asked);
        if (pauses % 16 == 0 || host.asked > 1)
            assert_valid(mesh);
        host.asked = 0;
        pauses += status == TRI_NO_ROOM;
        stops += status == TRI_STOPPED;
    }
    mesh->stop = NULL;
    tri_refiner_free(refiner);
    assert_int_equal(status, TRI_OK);
    assert_true(stops > 0 && pauses > 0);
    return host.cells;
}

/* Makes two meshes of the same input, one with pauses, and compares them. Returns the number of triangles inserted in
 * batches. */
static int32_t compare_pauses(const struct tri_pslg *pslg, const struct tri_options *options,
                           const struct tri_refine_hooks *hooks)
{
    struct tri_mesh mesh = coarse_mesh(pslg, options), twin = coarse_mesh(pslg, options);
    struct tri_refine_report report, wanted;
    assert_int_equal(tri_refine_with(&twin, &options->quality, hooks, &wanted, NULL), TRI_OK);
    const int32_t n = mesh.n_vertices, cells = refine_with_pauses(&mesh, options, *hooks, &report);
    tri_surface_settle(&mesh, NULL);
    tri_surface_settle(&twin, NULL);
    support_assert_same_bytes(&mesh, &twin);
    assert_memory_equal(&report, &wanted, sizeof report);
    assert_int_equal(mesh.n_vertices, n + report.inserted_free + report.inserted_on_segments);
    tri_mesh_free(&mesh);
    tri_mesh_free(&twin);
    return cells;
}

static void test_pauses_change_nothing(void **state)
{
    (void)state;
    static const char *const names[] = {"letter.poly", "box_hole.poly", "square.poly"};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            struct tri_pslg pslg = load(names[i]);
            struct tri_options options = in_lattice(k == 0 ? 0 : 28, bound_for(&pslg, 8000));
            options.quality.conforming = k == 2;
            assert_true(compare_pauses(&pslg, &options, &no_hooks) > 800);
            tri_pslg_free(&pslg);
        }
}

/* Points on edges, with splits in between. */
static void test_pauses_in_tangles(void **state)
{
    (void)state;
    static const enum support_kind kinds[] = {SUPPORT_RANDOM, SUPPORT_LATTICE, SUPPORT_RING};
    int32_t cells = 0;
    for (int kind = 0; kind < 3; kind++)
        for (uint64_t seed = 100; seed < 200; seed += (uint64_t)every(7)) {
            struct tri_pslg pslg = support_tangle(kinds[kind], 3 + (int32_t)(seed % 7), (int32_t)(seed % 4), seed);
            struct tri_options options = in_lattice(seed % 2 ? 25 : 0, bound_for(&pslg, 1500));
            options.quality.conforming = seed % 3 == 0;
            cells += compare_pauses(&pslg, &options, &no_hooks);
            tri_pslg_free(&pslg);
        }
    assert_true(cells > 20000);
}

/* Two regions get cells, one after the other. */
static void test_pauses_between_bounds(void **state)
{
    (void)state;
    struct tri_pslg pslg = columns(0.0005, 0, 0.0008, 150);
    struct tri_options options = in_lattice(28, 0);
    options.spread_regions = options.quality.region_areas = true;
    assert_true(compare_pauses(&pslg, &options, &no_hooks) > 1200);
    tri_pslg_free(&pslg);
}

static void test_pauses_within_a_fence(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_square(8, 150, 3);
    const struct tri_options options = in_lattice(25, 0.004);
    const struct tri_fence fence = {-1, -1, 7.03, 9};
    assert_true(compare_pauses(&pslg, &options, &(struct tri_refine_hooks){.fence = &fence}) > 1500);
    tri_pslg_free(&pslg);
}

/* --- failures */

static void test_room_may_fail(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_square(8, 6, 3);
    const struct tri_options options = in_lattice(28, 0.015);
    int32_t most = 0;
    bool is_ready = false;
    for (int32_t grants = 0; !is_ready; grants += every(7)) {
        struct tri_mesh mesh = coarse_mesh(&pslg, &options);
        struct host host = host_for(&mesh, grants, TRI_NO_MEMORY);
        const struct tri_refine_hooks hooks = hooks_to(&host, no_hooks);
        struct tri_refine_report report;
        struct tri_error error = {0};
        const enum tri_status status = tri_refine_with(&mesh, &options.quality, &hooks, &report, &error);
        is_ready = status == TRI_OK;
        assert_int_equal(status, host.calls > grants ? TRI_NO_MEMORY : TRI_OK);
        assert_true(is_ready || strcmp(error.text, "the host refuses") == 0);
        most = host.most > most ? host.most : most;
        assert_true(!is_ready || host.cells > 400);
        judge_as_far_as_it_got(&mesh, &pslg);
        if (is_ready)
            judge(&mesh, &pslg, &options, 0);
        tri_mesh_free(&mesh);
    }
    assert_true(most > 200);
    tri_pslg_free(&pslg);
}

/* After a failed allocation the mesh is valid, and another call completes it. */
static void test_allocations_may_fail(void **state)
{
    (void)state;
    struct tri_pslg pslg = columns(0.004, 0, 0.0045, 0);
    struct tri_options options = in_lattice(25, 0);
    options.spread_regions = options.quality.region_areas = true;
    for (int ever_after = 0; ever_after < 2; ever_after++) {
        int k = 0, failures = 0;
        for (bool failed = true; failed; failures += failed) {
            const int64_t before = support_held;
            struct tri_mesh mesh = coarse_mesh(&pslg, &options);
            struct tri_refine_report report;
            struct tri_error error = {0};
            support_calls = 0;
            support_fail_ever_after = ever_after;
            support_fail_at = ++k;
            const enum tri_status status = tri_refine(&mesh, &options.quality, &report, &error);
            failed = support_calls >= k;
            support_fail_at = INT64_MAX;
            assert_int_equal(status, failed ? TRI_NO_MEMORY : TRI_OK);
            judge_as_far_as_it_got(&mesh, &pslg);
            assert_int_equal(tri_refine(&mesh, &options.quality, &report, &error), TRI_OK);
            judge(&mesh, &pslg, &options, 0);
            tri_mesh_free(&mesh);
            assert_int_equal(support_held, before);
        }
        print_message("  %d allocations\n", failures);
        assert_true(failures > 20);
    }
    tri_pslg_free(&pslg);
}

/* Must not be called again after it has returned true. */
static bool counts_down(void *user)
{
    int *bad_list = user;
    assert_true(*bad_list > 0);
    return --*bad_list == 0;
}

/* After a stop at any time the mesh is valid, and another call completes it. */
static void test_stops(void **state)
{
    (void)state;
    struct tri_pslg pslg = load("letter.poly");
    const struct tri_options options = in_lattice(25, bound_for(&pslg, 10000));
    int32_t before = 0;
    int stops = 0;
    bool is_ready = false;
    for (int asked = 1; !is_ready; asked++) {
        struct tri_mesh mesh = coarse_mesh(&pslg, &options);
        struct tri_refine_report report;
        int bad_list = asked;
        const struct tri_stop stop = {counts_down, &bad_list};
        mesh.stop = &stop;
        const enum tri_status status = tri_refine(&mesh, &options.quality, &report, NULL);
        mesh.stop = NULL;
        is_ready = status == TRI_OK;
        stops += !is_ready;
        assert_int_equal(status, bad_list > 0 ? TRI_OK : TRI_STOPPED);
        judge_as_far_as_it_got(&mesh, &pslg);
        assert_true(mesh.n_vertices >= before);
        before = mesh.n_vertices;
        if (asked % every(3) == 0) {
            assert_int_equal(tri_refine(&mesh, &options.quality, &report, NULL), TRI_OK);
            judge(&mesh, &pslg, &options, 0);
        }
        tri_mesh_free(&mesh);
    }
    print_message("  %d stops\n", stops);
    assert_true(stops > 3);
    tri_pslg_free(&pslg);
}

/* --- parts of the mesh that a call must not change */

static struct tri_mesh coarse_square(struct tri_pslg *pslg)
{
    *pslg = support_square(8, 60, 3);
    const struct tri_options options = support_quality(25, 0.5);
    return support_generate(pslg, &options, NULL);
}

static bool is_owned(const struct tri_fence *f, const double at[6])
{
    for (int k = 0; k < 3; k++)
        if (at[2 * k] < f->x_min || at[2 * k] >= f->x_max || at[2 * k + 1] < f->y_min || at[2 * k + 1] >= f->y_max)
            return false;
    return true;
}

/* Returns the number of triangles inserted in batches. */
static int32_t refine_within(struct tri_mesh *mesh, const struct tri_fence *fence, const struct tri_options *options,
                             struct tri_refine_report *report)
{
    struct host host = host_for(mesh, INT32_MAX, TRI_OK);
    const struct tri_refine_hooks hooks = hooks_to(&host, (struct tri_refine_hooks){.fence = fence});
    const int32_t n = mesh->n_vertices;
    assert_int_equal(tri_refine_with(mesh, &options->quality, &hooks, report, NULL), TRI_OK);
    assert_int_equal(mesh->n_vertices, n + report->inserted_free + report->inserted_on_segments);
    return host.cells;
}

/* Each triangle with a corner outside the box is unchanged. */
static void test_fence_protects_the_outside(void **state)
{
    (void)state;
    static const struct tri_fence fences[] = {{1, 1, 5, 6}, {-1, -1, 4, 9}, {2.5, -1, 9, 3.25}};
    for (int f = 0; f < 3; f++) {
        struct tri_pslg pslg;
        struct tri_mesh mesh = coarse_square(&pslg);
        struct support_places before = support_places(&mesh);
        const struct tri_options options = in_lattice(30, 0.0015);
        struct tri_refine_report report;
        assert_true(refine_within(&mesh, &fences[f], &options, &report) > 1200);
        assert_true(report.fenced > 0);
        struct support_places after = support_places(&mesh);
        for (int32_t i = 0; i < before.n; i++)
            assert_true(is_owned(&fences[f], before.at[i]) || support_has_place(&after, before.at[i]));
        for (int32_t i = 0; i < after.n; i++)
            assert_true(is_owned(&fences[f], after.at[i]) || support_has_place(&before, after.at[i]));
        judge_as_far_as_it_got(&mesh, &pslg);
        support_places_free(&before);
        support_places_free(&after);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

/* Disjoint boxes are independent: any order gives the same set of triangles. */
static void test_disjoint_fences_commute(void **state)
{
    (void)state;
    static const struct tri_fence fences[3] = {{-1, -1, 4, 9}, {4, -1, 9, 4}, {4, 4, 9, 9}};
    static const double angles[] = {0, 20, 30};
    static const int orders[3][3] = {{0, 1, 2}, {2, 1, 0}, {1, 0, 2}};
    for (int a = 0; a < 3; a++) {
        struct support_places first = {0};
        for (int o = 0; o < 3; o++) {
            struct tri_pslg pslg;
            struct tri_mesh mesh = coarse_square(&pslg);
            int32_t cells = 0;
            for (int k = 0; k < 3; k++) {
                const struct tri_options options = in_lattice(angles[a], orders[o][k] == 1 ? 0.001 : 0.0025);
                struct tri_refine_report report;
                cells += refine_within(&mesh, &fences[orders[o][k]], &options, &report);
                assert_true(report.fenced > 0);
            }
            assert_true(cells > 4000);
            judge_as_far_as_it_got(&mesh, &pslg);
            struct support_places places = support_places(&mesh);
            if (o > 0 && !support_same_places(&first, &places))
                fail_msg("angle %g: order %d gives another mesh", angles[a], o);
            if (o > 0)
                support_places_free(&places);
            else
                first = places;
            tri_mesh_free(&mesh);
            tri_pslg_free(&pslg);
        }
        support_places_free(&first);
    }
}

/* One of the four quarters around a point. */
static struct tri_fence quarter(struct tri_point at, int k)
{
    return (struct tri_fence){k % 2 ? at.x : -HUGE_VAL, k / 2 ? at.y : -HUGE_VAL, k % 2 ? HUGE_VAL : at.x,
                              k / 2 ? HUGE_VAL : at.y};
}

/* Fences through tangles, some through vertices and along rows. */
static void test_quarters_commute(void **state)
{
    (void)state;
    static const enum support_kind kinds[] = {SUPPORT_RANDOM, SUPPORT_LATTICE, SUPPORT_RING};
    static const int orders[3][4] = {{0, 1, 2, 3}, {3, 2, 1, 0}, {2, 0, 3, 1}};
    int32_t cells = 0;
    for (uint64_t seed = 0; seed < 150; seed += (uint64_t)every(5)) {
        struct tri_pslg pslg = support_tangle(kinds[seed % 3], 4 + (int32_t)(seed % 9), (int32_t)(seed % 4), seed);
        struct support_random random = {seed};
        struct support_places first = {0};
        const double bound = bound_for(&pslg, 12000);
        struct tri_options options = in_lattice(seed % 2 ? 25 : 0, bound);
        struct tri_options coarse = in_lattice(20, 300 * bound);
        options.quality.conforming = seed % 5 == 0;
        for (int o = 0; o < 3; o++) {
            struct tri_mesh mesh = support_generate(&pslg, &coarse, NULL);
            struct tri_refine_report report;
            const struct tri_lattice lattice = tri_lattice_for(2 * bound / mesh.unit / mesh.unit);
            random.state = seed;
            struct tri_point at = mesh.xy[support_below(&random, mesh.n_vertices)];
            if (seed % 4 > 0)
                at = tri_point_between(at, mesh.xy[support_below(&random, mesh.n_vertices)], 0.4);
            if (seed % 4 > 1)
                at.y = round(at.y / lattice.rise) * lattice.rise;
            for (int k = 0; k < 4; k++) {
                const struct tri_fence fence = quarter(at, orders[o][k]);
                cells += refine_within(&mesh, &fence, &options, &report);
            }
            judge_as_far_as_it_got(&mesh, &pslg);
            struct support_places places = support_places(&mesh);
            if (o > 0 && !support_same_places(&first, &places))
                fail_msg("seed %d: order %d gives another mesh", (int)seed, o);
            if (o > 0)
                support_places_free(&places);
            else
                first = places;
            if (o == 2) {
                assert_int_equal(tri_refine(&mesh, &options.quality, &report, NULL), TRI_OK);
                judge(&mesh, &pslg, &options, count_bad(&mesh, &options, &report));
            }
            tri_mesh_free(&mesh);
        }
        support_places_free(&first);
        tri_pslg_free(&pslg);
    }
    assert_true(cells > 2000);
}

struct bad_list {
    bool *is_listed; /* [n] */
    int32_t n;
    int64_t calls;
};

static void record_deferred(void *user, tri_triangle_id triangle)
{
    struct bad_list *bad_list = user;
    assert_true(triangle >= 0 && triangle < bad_list->n);
    bad_list->is_listed[triangle] = true;
    bad_list->calls++;
}

/* Every triangle that is still bad has been reported to the caller, who refines it later. */
static void test_remaining_bad_triangles_are_reported(void **state)
{
    (void)state;
    static const struct tri_fence fences[] = {{1, 1, 5, 6}, {-1, -1, 4, 9}, {2.5, -1, 9, 3.25}, {-1, -1, 9, 9}};
    enum { MOST = 100000 };
    for (int f = 0; f < 4; f++) {
        struct tri_pslg pslg;
        struct tri_mesh mesh = coarse_square(&pslg);
        const struct tri_options options = in_lattice(28, 0.006);
        struct bad_list bad_list = {calloc(MOST, sizeof *bad_list.is_listed), MOST, 0};
        int32_t *listed = calloc((size_t)mesh.n_triangles, sizeof *listed), n = 0;
        for (int32_t t = 0; t < mesh.n_triangles; t++) {
            double at[6];
            for (int k = 0; k < 6; k++)
                at[k] = k % 2 ? mesh.xy[mesh.tri[t].v[k / 2]].y : mesh.xy[mesh.tri[t].v[k / 2]].x;
            if (is_owned(&fences[f], at))
                listed[n++] = t;
        }
        const struct tri_refine_hooks hooks = {.fence = &fences[f], .worklist = listed, .n_worklist = n,
                                               .deferred = record_deferred, .deferred_user = &bad_list};
        struct tri_refine_report report;
        assert_int_equal(tri_refine_with(&mesh, &options.quality, &hooks, &report, NULL), TRI_OK);
        assert_int_equal(bad_list.calls, report.fenced);
        assert_true(mesh.n_triangles <= MOST);
        int32_t *found = calloc((size_t)mesh.n_triangles, sizeof *found);
        const int32_t n_found = tri_find_work(&mesh, &options.quality, 0, mesh.n_triangles, found);
        assert_true((n_found > 0) == (f < 3));
        for (int32_t i = 0; i < n_found; i++) {
            double at[6];
            for (int k = 0; k < 6; k++)
                at[k] = k % 2 ? mesh.xy[mesh.tri[found[i]].v[k / 2]].y : mesh.xy[mesh.tri[found[i]].v[k / 2]].x;
            assert_true(bad_list.is_listed[found[i]] || !is_owned(&fences[f], at));
        }
        free(found);
        free(listed);
        free(bad_list.is_listed);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

static void add_lattice_point(struct tri_pslg *pslg, const struct tri_lattice *lattice, double row, double column)
{
    const struct tri_point p = tri_lattice_at(lattice, row, column);
    support_add_point(pslg, p.x, p.y);
}

/* A vertex in the middle of a cell whose corners exist already, with triangles small enough to stay. */
static void test_vertex_in_a_cell(void **state)
{
    (void)state;
    enum { ROW = 20, COLUMN = 17 };
    const struct tri_options options = in_lattice(20, 0.02);
    const struct tri_lattice lattice = tri_lattice_for(2 * 0.02);
    struct tri_pslg pslg = support_square(8, 4, 1);
    struct tri_refine_report report;
    pslg.n_points = 4;
    add_lattice_point(&pslg, &lattice, ROW, COLUMN);
    add_lattice_point(&pslg, &lattice, ROW, COLUMN + 1);
    add_lattice_point(&pslg, &lattice, ROW + 1, COLUMN);
    support_add_point(&pslg, (COLUMN + 0.5) * lattice.edge, (ROW + 1 / 3.0) * lattice.rise);
    struct tri_mesh mesh = coarse_mesh(&pslg, &options);
    assert_true(mesh.unit == 1);
    assert_int_equal(tri_refine(&mesh, &options.quality, &report, NULL), TRI_OK);
    judge(&mesh, &pslg, &options, 0);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* Worklists of some triangles of a coarser lattice, whose vertices are points of the finer one. Then all triangles. */
static void test_worklists(void **state)
{
    (void)state;
    int32_t cells = 0;
    for (uint64_t seed = 0; seed < 100; seed += (uint64_t)every(5)) {
        struct tri_pslg pslg = support_square(8, (int32_t)(seed % 8), seed);
        const struct tri_options coarse = in_lattice(seed % 2 ? 25 : 0, 0.04);
        const struct tri_options fine = in_lattice(seed % 2 ? 25 : 0, seed % 3 ? 0.01 : 0.0125);
        struct tri_mesh mesh = support_generate(&pslg, &coarse, NULL);
        struct tri_refine_report report;
        struct support_random random = {seed};
        const int32_t before = mesh.n_triangles;
        struct tri_triangle *old = calloc((size_t)before, sizeof *old);
        int32_t *listed = calloc((size_t)before, sizeof *listed), n = 0;
        for (int32_t t = 0; t < before; t++) {
            old[t] = mesh.tri[t];
            if (support_below(&random, 8) <= (int32_t)(seed % 8)) {
                const int32_t other = support_below(&random, n + 1);
                listed[n++] = listed[other];
                listed[other] = t;
            }
        }
        struct host host = host_for(&mesh, INT32_MAX, TRI_OK);
        const struct tri_refine_hooks hooks =
            hooks_to(&host, (struct tri_refine_hooks){.worklist = listed, .n_worklist = n});
        assert_int_equal(tri_refine_with(&mesh, &fine.quality, &hooks, &report, NULL), TRI_OK);
        cells += host.cells;
        judge_as_far_as_it_got(&mesh, &pslg);
        for (int32_t t = 0; t < before; t++) /* a changed triangle has another generation */
            assert_true(memcmp(old[t].v, mesh.tri[t].v, sizeof old[t].v) == 0 ||
                        mesh.tri[t].generation != old[t].generation);
        assert_int_equal(tri_refine(&mesh, &fine.quality, &report, NULL), TRI_OK);
        judge(&mesh, &pslg, &fine, 0);
        assert_int_equal(tri_refine(&mesh, &fine.quality, &report, NULL), TRI_OK);
        assert_int_equal(report.inserted_free + report.inserted_on_segments, 0);
        free(old);
        free(listed);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
    assert_true(cells > 4000);
}

static bool left_of(void *user, const double p[2]) { return p[0] < *(double *)user; }

/* If points are limited or must pass a gate, no cells are inserted. */
static void test_limits_and_gates(void **state)
{
    (void)state;
    struct tri_pslg pslg;
    struct tri_mesh mesh = coarse_square(&pslg);
    struct tri_options options = in_lattice(28, 0.01);
    struct tri_refine_report report;
    double x_max = 3;
    options.quality.max_steiner = 100;
    int32_t before = mesh.n_vertices;
    assert_int_equal(tri_refine(&mesh, &options.quality, &report, NULL), TRI_OK);
    assert_int_equal(mesh.n_vertices, before + 100);
    options.quality.max_steiner = -1;
    before = mesh.n_vertices;
    const struct tri_refine_hooks hooks = {.gate = left_of, .gate_user = &x_max};
    assert_int_equal(tri_refine_with(&mesh, &options.quality, &hooks, &report, NULL), TRI_OK);
    assert_true(report.gated > 0 && report.inserted_free > 500);
    for (int32_t v = before; v < mesh.n_vertices; v++)
        assert_true(mesh.on[v] != TRI_VERTEX_FREE || mesh.xy[v].x < 3);
    judge_as_far_as_it_got(&mesh, &pslg);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_figures),
        cmocka_unit_test(test_coasts),
        cmocka_unit_test(test_protected_segments),
        cmocka_unit_test(test_tangles),
        cmocka_unit_test(test_regions),
        cmocka_unit_test(test_regions_without_walls),
        cmocka_unit_test(test_middle_of_a_square),
        cmocka_unit_test(test_scaled),
        cmocka_unit_test(test_pauses_change_nothing),
        cmocka_unit_test(test_pauses_in_tangles),
        cmocka_unit_test(test_pauses_between_bounds),
        cmocka_unit_test(test_pauses_within_a_fence),
        cmocka_unit_test(test_room_may_fail),
        cmocka_unit_test(test_allocations_may_fail),
        cmocka_unit_test(test_stops),
        cmocka_unit_test(test_fence_protects_the_outside),
        cmocka_unit_test(test_disjoint_fences_commute),
        cmocka_unit_test(test_quarters_commute),
        cmocka_unit_test(test_remaining_bad_triangles_are_reported),
        cmocka_unit_test(test_vertex_in_a_cell),
        cmocka_unit_test(test_worklists),
        cmocka_unit_test(test_limits_and_gates),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
