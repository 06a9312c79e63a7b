/* Refiners that pause between two points and continue make the same mesh as without a pause. */
#include "support.h"

#include "triangle/mesh/surface.h"
#include "triangle/refine/refine.h"

static bool always(void *user)
{
    (void)user;
    return true;
}

static const struct tri_stop at_once = {always, NULL};

/* name: an input file, or NULL for random points, whose triangles are too many to be searched in one pass. */
static struct tri_mesh coarse(const char *name, const struct tri_options *options, struct tri_pslg *pslg)
{
    struct tri_options coarse = *options;
    struct tri_report report;
    coarse.refine = false;
    if (name)
        assert_true(support_read(name, pslg));
    else
        *pslg = support_square(1, 36000, 5);
    return support_generate(pslg, &coarse, &report);
}

static const struct tri_refine_hooks no_hooks;

static void compare(const char *name, const struct tri_options *options)
{
    struct tri_pslg pslg, same;
    struct tri_mesh mesh = coarse(name, options, &pslg), twin = coarse(name, options, &same);
    struct tri_refine_report report, wanted;
    struct tri_refiner *refiner;
    enum tri_status status;
    int pauses = 0;
    assert_int_equal(tri_refine(&twin, &options->quality, &wanted, NULL), TRI_OK);
    assert_int_equal(tri_refiner_new(&refiner, &mesh, &options->quality, &no_hooks, &report, NULL), TRI_OK);
    mesh.stop = &at_once;
    for (; (status = tri_refiner_run(refiner, NULL)) == TRI_STOPPED; pauses++)
        ;
    tri_refiner_free(refiner);
    assert_int_equal(status, TRI_OK);
    assert_true(pauses >= 6);
    tri_surface_settle(&mesh, NULL);
    tri_surface_settle(&twin, NULL);
    support_assert_same_bytes(&mesh, &twin);
    assert_memory_equal(&report, &wanted, sizeof report);
    tri_mesh_free(&mesh);
    tri_mesh_free(&twin);
    tri_pslg_free(&pslg);
    tri_pslg_free(&same);
}

static void test_paused_refinement_gives_the_same_mesh(void **state)
{
    (void)state;
    struct tri_options options = support_quality(30, 0.006);
    compare("letter.poly", &options);
    options.quality.max_steiner = 6000; /* refinement ends in between, at the limit on points */
    compare("letter.poly", &options);
    options = support_quality(33, 0.008); /* two schedules in turn */
    compare("letter.poly", &options);
    options = support_quality(36, 0.5); /* four schedules in turn */
    compare("section.poly", &options);
    options = support_quality(28, 0.008);
    options.quality.conforming = true;
    compare("letter.poly", &options);
    options = support_quality(0, 0.006);
    compare("letter.poly", &options);
    options = support_quality(12, 0);
    compare(NULL, &options);
}

static enum tri_status refuse_room(void *user, struct tri_mesh *mesh, int32_t points, struct tri_error *error)
{
    (void)user, (void)mesh, (void)points, (void)error;
    return TRI_NO_ROOM;
}

/* Runs a refiner that finds no room before each point that needs room. It then also pauses after the split of a
   subsegment, while it treats a triangle and others wait for the test for encroachment. Returns the number of
   pauses. */
static int step(struct tri_refiner *refiner, struct tri_mesh *mesh)
{
    enum tri_status status;
    int pauses = 0;
    mesh->vertex_capacity = mesh->n_vertices;
    for (; (status = tri_refiner_run(refiner, NULL)) == TRI_NO_ROOM; pauses++) {
        mesh->vertex_capacity = mesh->n_vertices;
        assert_int_equal(tri_mesh_reserve_vertices(mesh, 1, NULL), TRI_OK);
        mesh->vertex_capacity = mesh->n_vertices + 1;
        assert_int_equal(tri_mesh_reserve_triangles(mesh, 2, NULL), TRI_OK);
        assert_int_equal(tri_mesh_reserve_subs(mesh, 1, NULL), TRI_OK);
    }
    assert_int_equal(status, TRI_OK);
    return pauses;
}

static void compare_step_by_step(const char *name, const struct tri_options *options)
{
    struct tri_pslg pslg, same;
    struct tri_mesh mesh = coarse(name, options, &pslg), twin = coarse(name, options, &same);
    const struct tri_refine_hooks stepping = {.more_room = refuse_room};
    struct tri_refine_report report;
    struct tri_refiner *refiner;
    assert_int_equal(tri_refine(&twin, &options->quality, &report, NULL), TRI_OK);
    assert_int_equal(tri_refiner_new(&refiner, &mesh, &options->quality, &stepping, &report, NULL), TRI_OK);
    step(refiner, &mesh);
    tri_refiner_free(refiner);
    tri_surface_settle(&mesh, NULL);
    tri_surface_settle(&twin, NULL);
    support_assert_same_bytes(&mesh, &twin);
    tri_mesh_free(&mesh);
    tri_mesh_free(&twin);
    tri_pslg_free(&pslg);
    tri_pslg_free(&same);
}

static void test_pause_before_each_point_gives_the_same_mesh(void **state)
{
    (void)state;
    static const char *const names[] = {"cracked_plate.poly", "thin_channel.poly", "gear.poly", "letter.poly"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        for (double angle = 0; angle < 34; angle += 10) {
            struct tri_options options = support_quality(angle, angle == 0 ? 0.1 : 0);
            options.quality.conforming = true;
            compare_step_by_step(names[i], &options);
        }
}

/* Points on a circle, so that the cavity of its centre is the whole disk, and a strip beside it. */
static struct tri_pslg disk(void)
{
    enum { CORNERS = 200 };
    struct tri_pslg pslg = support_pslg(CORNERS + 4, CORNERS + 4, 0, 0);
    for (int32_t i = 0; i < CORNERS; i++) {
        const double angle = 2 * 3.14159265358979324 * i / CORNERS;
        support_add_point(&pslg, cos(angle), sin(angle));
        support_add_segment(&pslg, i, (i + 1) % CORNERS);
    }
    for (int32_t i = 0; i < 4; i++) {
        support_add_point(&pslg, i % 3 == 0 ? -3 : -2, i < 2 ? -2 : -1.9);
        support_add_segment(&pslg, CORNERS + i, CORNERS + (i + 1) % 4);
    }
    return pslg;
}

static void add_deferred(void *user, tri_triangle_id triangle)
{
    int64_t *sum = user;
    *sum += triangle + 1;
}

/* A block of one phase. */
static void test_pauses_within_a_fence_give_the_same_mesh(void **state)
{
    (void)state;
    int64_t deferred[2] = {0, 0};
    struct tri_refine_report report[2];
    struct tri_mesh mesh[2];
    for (int stepping = 0; stepping < 2; stepping++) {
        struct tri_options options = support_quality(33, 0);
        struct tri_report made;
        struct tri_pslg pslg = disk();
        struct tri_refiner *refiner;
        int pauses = 0;
        options.refine = false;
        mesh[stepping] = support_generate(&pslg, &options, &made);
        assert_int_equal(tri_refine_prepare(&mesh[stepping], NULL, NULL), TRI_OK);
        const double unit = mesh[stepping].unit;
        const struct tri_fence fence = {-9 / unit, -9 / unit, 0.7 / unit, 0.7 / unit};
        const struct tri_refine_hooks hooks = {.fence = &fence,
                                               .more_room = stepping ? refuse_room : NULL,
                                               .deferred = add_deferred,
                                               .deferred_user = &deferred[stepping]};
        assert_int_equal(
            tri_refiner_new(&refiner, &mesh[stepping], &options.quality, &hooks, &report[stepping], NULL), TRI_OK);
        if (stepping)
            pauses = step(refiner, &mesh[stepping]);
        assert_int_equal(tri_refiner_run(refiner, NULL), TRI_OK);
        assert_int_equal(pauses > 5, stepping);
        tri_refiner_free(refiner);
        tri_pslg_free(&pslg);
    }
    support_assert_same_bytes(&mesh[0], &mesh[1]);
    assert_memory_equal(&report[0], &report[1], sizeof *report);
    assert_int_equal(deferred[0], deferred[1]);
    tri_mesh_free(&mesh[0]);
    tri_mesh_free(&mesh[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_paused_refinement_gives_the_same_mesh),
        cmocka_unit_test(test_pause_before_each_point_gives_the_same_mesh),
        cmocka_unit_test(test_pauses_within_a_fence_give_the_same_mesh),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
