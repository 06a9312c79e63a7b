/* Refiners that are taken apart between two points, and go on elsewhere: the same mesh as without a pause. */
#include "support.h"

#include "triangle/refine/pause.h"

static bool always(void *user)
{
    (void)user;
    return true;
}

static const struct tri_stop at_once = {always, NULL};

/* What is left of a refiner in a file: a head, and arrays. */
struct kept {
    struct tri_pause head;
    void *array[TRI_PAUSE_ARRAYS];
};

static struct kept keep(const struct tri_refiner *refiner)
{
    struct kept kept;
    struct tri_pause pause;
    struct tri_pause_array from[TRI_PAUSE_ARRAYS];
    tri_refiner_show(refiner, &pause);
    tri_pause_head(&pause, &kept.head);
    tri_pause_arrays(&pause, from);
    for (int k = 0; k < TRI_PAUSE_ARRAYS; k++) {
        kept.array[k] = malloc(from[k].bytes + 1);
        if (from[k].bytes > 0)
            memcpy(kept.array[k], from[k].at, from[k].bytes);
    }
    return kept;
}

static void drop(struct kept *kept)
{
    for (int k = 0; k < TRI_PAUSE_ARRAYS; k++)
        free(kept->array[k]);
}

static struct tri_pause restored(const struct kept *kept, const struct tri_mesh *mesh)
{
    struct tri_pause pause = kept->head;
    struct tri_pause_array to[TRI_PAUSE_ARRAYS];
    assert_true(tri_pause_is_head(&pause, mesh->n_triangles, mesh->n_subs, mesh->n_triangles));
    assert_true(tri_pause_reserve(&pause));
    tri_pause_arrays(&pause, to);
    for (int k = 0; k < TRI_PAUSE_ARRAYS; k++) {
        if (to[k].bytes > 0)
            memcpy(to[k].at, kept->array[k], to[k].bytes);
    }
    return pause;
}

/* name: of a file, or NULL: random points, whose triangles are more than are looked at in one go. */
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

/* Does it show what has been kept? */
static void assert_shows(const struct tri_refiner *refiner, const struct kept *kept)
{
    struct kept again = keep(refiner);
    struct tri_pause_array bytes[TRI_PAUSE_ARRAYS];
    tri_pause_arrays(&kept->head, bytes);
    const struct tri_pause *head = &kept->head;
    again.head.queue.block_capacity = head->queue.block_capacity; /* of the arrays, which have been made anew */
    assert_memory_equal(&again.head, head, sizeof *head);
    for (int k = 0; k < TRI_PAUSE_ARRAYS; k++)
        assert_memory_equal(again.array[k], kept->array[k], bytes[k].bytes);
    drop(&again);
}

/* A new one in the place of the old. */
static struct tri_refiner *moved(struct tri_refiner *refiner, struct tri_mesh *mesh,
                                 const struct tri_refine_options *options, struct tri_refine_report *report)
{
    struct kept kept = keep(refiner);
    tri_refiner_free(refiner);
    memset(report, 0xff, sizeof *report);
    assert_int_equal(tri_refiner_new(&refiner, mesh, options, report, NULL), TRI_OK);
    struct tri_pause pause = restored(&kept, mesh);
    tri_refiner_go_on(refiner, &pause);
    tri_pause_free(&pause); /* nothing is left in it */
    assert_shows(refiner, &kept);
    drop(&kept);
    return refiner;
}

static void move_mesh(struct tri_mesh *mesh)
{
    struct tri_mesh copy;
    assert_int_equal(tri_mesh_copy(&copy, mesh, NULL), TRI_OK);
    tri_mesh_swap(mesh, &copy);
    tri_mesh_drop(&copy);
}

static void compare(const char *name, const struct tri_options *options)
{
    struct tri_pslg pslg, same;
    struct tri_mesh mesh = coarse(name, options, &pslg), twin = coarse(name, options, &same);
    struct tri_refine_report report, wanted;
    struct tri_refiner *refiner;
    enum tri_status status;
    int pauses = 0;
    assert_int_equal(tri_refine(&twin, &options->quality, &wanted, NULL), TRI_OK);
    assert_int_equal(tri_refiner_new(&refiner, &mesh, &options->quality, &report, NULL), TRI_OK);
    mesh.stop = &at_once;
    for (; (status = tri_refiner_run(refiner, NULL)) == TRI_STOPPED; pauses++)
        if (pauses % 2) { /* a new one asks at once, before it does anything */
            move_mesh(&mesh);
            refiner = moved(refiner, &mesh, &options->quality, &report);
        }
    tri_refiner_free(refiner);
    assert_int_equal(status, TRI_OK);
    assert_true(pauses >= 6);
    support_assert_same_bytes(&mesh, &twin);
    assert_memory_equal(&report, &wanted, sizeof report);
    tri_mesh_free(&mesh);
    tri_mesh_free(&twin);
    tri_pslg_free(&pslg);
    tri_pslg_free(&same);
}

static void test_goes_on_elsewhere(void **state)
{
    (void)state;
    struct tri_options options = support_quality(30, 0.006);
    compare("letter.poly", &options);
    options.quality.max_steiner = 6000; /* ends amid of it */
    compare("letter.poly", &options);
    options = support_quality(33, 0.008); /* two stages */
    compare("letter.poly", &options);
    options = support_quality(36, 0.5); /* four */
    compare("section.poly", &options);
    options = support_quality(28, 0.008);
    options.quality.conforming = true;
    compare("letter.poly", &options);
    options = support_quality(0, 0.006);
    compare("letter.poly", &options);
    options = support_quality(12, 0);
    compare(NULL, &options);
}

/* Counts and places of a head that are out of their ranges. */
static void test_heads_that_cannot_be(void **state)
{
    (void)state;
    struct tri_options options = support_quality(30, 0.006);
    struct tri_pslg pslg;
    struct tri_mesh mesh = coarse("letter.poly", &options, &pslg);
    struct tri_refine_report report;
    struct tri_refiner *refiner;
    assert_int_equal(tri_refiner_new(&refiner, &mesh, &options.quality, &report, NULL), TRI_OK);
    mesh.stop = &at_once;
    for (int i = 0; i < 3; i++)
        assert_int_equal(tri_refiner_run(refiner, NULL), TRI_STOPPED);
    struct tri_pause pause, head;
    tri_refiner_show(refiner, &pause);
    tri_pause_head(&pause, &head);
    assert_true(tri_pause_is_head(&head, mesh.n_triangles, mesh.n_subs, mesh.n_triangles));
    int32_t *const counts[] = {&head.queue.n_blocks, &head.queue.bucket[7].first, &head.queue.bucket[7].last,
                               &head.queue.bucket[7].begin, &head.queue.bucket[7].end, &head.queue.bucket[7].count,
                               &head.queue.next, &head.queue.n_batch, &head.queue.free_block, &head.n_encroached,
                               &head.next_listed, &head.limit, &head.stage, &head.step};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        const int32_t old = *counts[i];
        *counts[i] = -5;
        assert_false(tri_pause_is_head(&head, mesh.n_triangles, mesh.n_subs, mesh.n_triangles));
        *counts[i] = old;
    }
    const struct {
        int32_t *at, most;
    } most[] = {{&head.limit, TRI_BUCKETS},
                {&head.stage, TRI_PAUSE_LAST_STAGE},
                {&head.step, TRI_PAUSE_LAST_STEP},
                {&head.n_worklist, mesh.n_triangles},
                {&head.queue.bucket[7].begin, TRI_BLOCK - 1},
                {&head.queue.bucket[7].end, TRI_BLOCK}};
    for (size_t i = 0; i < sizeof most / sizeof *most; i++) {
        const int32_t old = *most[i].at;
        *most[i].at = most[i].most + 1;
        assert_false(tri_pause_is_head(&head, mesh.n_triangles, mesh.n_subs, mesh.n_triangles));
        *most[i].at = old;
    }
    assert_true(head.n_worklist > 0);
    assert_false(tri_pause_is_head(&head, mesh.n_triangles, mesh.n_subs, head.n_worklist - 1));
    head.queue.head = head.queue.tail - TRI_WINDOW - 1;
    assert_false(tri_pause_is_head(&head, mesh.n_triangles, mesh.n_subs, mesh.n_triangles));
    tri_refiner_free(refiner);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

static enum tri_status not_now(void *user, struct tri_mesh *mesh, struct tri_error *error)
{
    (void)user, (void)mesh, (void)error;
    return TRI_NO_ROOM;
}

/* Runs a refiner that finds no room before each point that needs some: so it pauses also behind the split of a
 * subsegment, with a triangle in hand, when others wait to be tested for encroachment. Goes on with a new one. */
static struct tri_refiner *step(struct tri_refiner *refiner, struct tri_mesh *mesh,
                                const struct tri_refine_options *options, struct tri_refine_report *report,
                                int *pauses)
{
    enum tri_status status;
    mesh->vertex_capacity = mesh->n_vertices;
    for (*pauses = 0; (status = tri_refiner_run(refiner, NULL)) == TRI_NO_ROOM; ++*pauses) {
        mesh->vertex_capacity = mesh->n_vertices;
        assert_int_equal(tri_mesh_reserve_vertices(mesh, 1, NULL), TRI_OK);
        mesh->vertex_capacity = mesh->n_vertices + 1;
        assert_int_equal(tri_mesh_reserve_triangles(mesh, 2, NULL), TRI_OK);
        assert_int_equal(tri_mesh_reserve_subs(mesh, 1, NULL), TRI_OK);
        refiner = moved(refiner, mesh, options, report);
    }
    assert_int_equal(status, TRI_OK);
    return refiner;
}

static void compare_step_by_step(const char *name, const struct tri_options *options)
{
    struct tri_pslg pslg, same;
    struct tri_mesh mesh = coarse(name, options, &pslg), twin = coarse(name, options, &same);
    struct tri_refine_options stepping = options->quality;
    struct tri_refine_report report;
    struct tri_refiner *refiner;
    int pauses;
    assert_int_equal(tri_refine(&twin, &options->quality, &report, NULL), TRI_OK);
    stepping.more_room = not_now;
    assert_int_equal(tri_refiner_new(&refiner, &mesh, &stepping, &report, NULL), TRI_OK);
    refiner = step(refiner, &mesh, &stepping, &report, &pauses);
    tri_refiner_free(refiner);
    support_assert_same_bytes(&mesh, &twin);
    tri_mesh_free(&mesh);
    tri_mesh_free(&twin);
    tri_pslg_free(&pslg);
    tri_pslg_free(&same);
}

static void test_step_by_step(void **state)
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

/* Points on a circle, whose centre has all of it for a cavity; and a strip beside it. */
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

/* A block of a phase. */
static void test_within_a_fence(void **state)
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
        options.quality.fence = &fence;
        options.quality.more_room = stepping ? not_now : NULL;
        options.quality.deferred = add_deferred;
        options.quality.deferred_user = &deferred[stepping];
        assert_int_equal(
            tri_refiner_new(&refiner, &mesh[stepping], &options.quality, &report[stepping], NULL), TRI_OK);
        if (stepping)
            refiner = step(refiner, &mesh[stepping], &options.quality, &report[stepping], &pauses);
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
        cmocka_unit_test(test_goes_on_elsewhere),
        cmocka_unit_test(test_step_by_step),
        cmocka_unit_test(test_within_a_fence),
        cmocka_unit_test(test_heads_that_cannot_be),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
