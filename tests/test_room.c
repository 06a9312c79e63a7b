/* Ranges of the shared arrays are dealt out, used, returned and closed up. A table that records the owner of each item
   is the reference. */
#include "support.h"

#include "sched/schedule/room.h"
#include "sched/tiles/numbering.h"
#include "sched/schedule/threads.h"
#include "sched/tunables.h"
#include "triangle/mesh/surface.h"

enum { ROOMS = 6, NOBODY = -1, SPARE = -2, USED = -3 };

/* The owner of each item of each kind. */
struct table {
    int32_t *owner[PAR_KINDS];
    int32_t n[PAR_KINDS], capacity[PAR_KINDS];
};

static int32_t count_of(const struct tri_mesh *mesh, int kind)
{
    return kind == PAR_VERTICES ? mesh->n_vertices : kind == PAR_TRIANGLES ? mesh->n_triangles : mesh->n_subs;
}

static void table_grow(struct table *table, const struct tri_mesh *shared)
{
    for (int kind = 0; kind < PAR_KINDS; kind++) {
        int32_t n = count_of(shared, kind);
        assert_true(n >= table->n[kind]);
        if (n > table->capacity[kind]) {
            table->capacity[kind] = 2 * n;
            table->owner[kind] = realloc(table->owner[kind], (size_t)table->capacity[kind] * sizeof(int32_t));
            assert_non_null(table->owner[kind]);
        }
        while (table->n[kind] < n)
            table->owner[kind][table->n[kind]++] = NOBODY;
    }
}

/* Marks all items that a room lists as its own. Each must have been its own before, or free. */
static void table_claim(struct table *table, const struct par_room *room, int32_t who)
{
    for (int kind = 0; kind < PAR_KINDS; kind++)
        for (int32_t i = 0; i < room->ranges[kind].n; i++) {
            struct par_range range = room->ranges[kind].item[i];
            assert_true(range.next <= range.end && range.end <= table->n[kind]);
            for (int32_t at = range.next; at < range.end; at++) {
                int32_t *owner = &table->owner[kind][at];
                assert_true(*owner == who || *owner == NOBODY || *owner == SPARE);
                *owner = who;
            }
        }
}

static int32_t table_count(const struct table *table, int kind, int32_t who)
{
    int32_t n = 0;
    for (int32_t i = 0; i < table->n[kind]; i++)
        n += table->owner[kind][i] == who;
    return n;
}

static int32_t room_left(const struct par_room *room, int kind)
{
    int32_t n = 0;
    for (int32_t i = 0; i < room->ranges[kind].n; i++)
        n += room->ranges[kind].item[i].end - room->ranges[kind].item[i].next;
    return n;
}

/* How many insertions the free items allow: each insertion uses two triangles. */
static int32_t room_usable(const struct par_room *room)
{
    int32_t n = 0;
    for (int32_t i = 0; i < room->ranges[PAR_TRIANGLES].n; i++) {
        int32_t here = room->ranges[PAR_TRIANGLES].item[i].end - room->ranges[PAR_TRIANGLES].item[i].next;
        n += here >= 2 ? here : 0;
    }
    return n;
}

static void table_free(struct table *table)
{
    for (int kind = 0; kind < PAR_KINDS; kind++)
        free(table->owner[kind]);
}

/* Uses up to n points' worth of room, like the refinement loop. Returns false if the room was full before. */
static bool use_room(struct table *table, struct par_view *view, const struct tri_mesh *shared, int32_t who, int32_t n,
                     struct support_random *random)
{
    struct tri_mesh *mesh = &view->mesh;
    bool enough = true;
    par_view_begin(view, shared);
    for (int32_t i = 0; i < n && enough; i++) {
        bool need = mesh->vertex_capacity - mesh->n_vertices < 1 || mesh->triangle_capacity - mesh->n_triangles < 2 ||
                    mesh->sub_capacity - mesh->n_subs < 1;
        enum tri_status status = need ? par_view_more_room(view, mesh, 1, NULL) : TRI_OK;
        assert_true(status == TRI_OK || status == TRI_NO_ROOM);
        enough = status == TRI_OK;
        if (!enough)
            break;
        int32_t taken[4][2] = {
            {PAR_VERTICES, mesh->n_vertices++}, {PAR_TRIANGLES, mesh->n_triangles++},
            {PAR_TRIANGLES, mesh->n_triangles++}};
        int n_taken = 3;
        if (support_below(random, 4) == 0) {
            taken[3][0] = PAR_SUBS;
            taken[3][1] = mesh->n_subs++;
            n_taken = 4;
        }
        for (int k = 0; k < n_taken; k++) {
            int32_t *owner = &table->owner[taken[k][0]][taken[k][1]];
            assert_int_equal(*owner, who);
            *owner = USED;
        }
    }
    par_view_end(view);
    return enough;
}

static void give_back(struct table *table, struct par_room *room, struct par_room *spare)
{
    par_room_return(room, spare);
    assert_true(!room->ranges[PAR_TRIANGLES].item && !room->ranges[PAR_VERTICES].item && !room->ranges[PAR_SUBS].item);
    for (int kind = 0; kind < PAR_KINDS; kind++)
        for (int32_t i = 0; i < spare->ranges[kind].n; i++)
            for (int32_t at = spare->ranges[kind].item[i].next; at < spare->ranges[kind].item[i].end; at++)
                table->owner[kind][at] = SPARE;
}

/* No item belongs to two rooms, none is lost, and each request is satisfied. */
static void test_random_requests_are_satisfied(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 40; seed++) {
        struct support_random random = {seed};
        struct tri_mesh shared;
        struct table table = {0};
        struct par_view view[ROOMS] = {0};
        struct par_room spare = {0};
        assert_int_equal(tri_mesh_init(&shared, NULL), TRI_OK);
        for (int step = 0; step < 300; step++) {
            int32_t who = support_below(&random, ROOMS), action = support_below(&random, 8);
            if (action == 0) {
                give_back(&table, &view[who].room, &spare);
                assert_int_equal(table_count(&table, PAR_TRIANGLES, who), 0);
                assert_int_equal(table_count(&table, PAR_TRIANGLES, SPARE), room_left(&spare, PAR_TRIANGLES));
            } else if (action < 3) {
                int32_t more = support_below(&random, seed % 2 ? 12 : 400) + 1;
                assert_int_equal(par_room_extend(&view[who].room, &spare, &shared, more, NULL), TRI_OK);
                assert_true(room_usable(&view[who].room) >= more);
                assert_true(room_left(&view[who].room, PAR_VERTICES) >= more / 2);
                table_grow(&table, &shared);
                table_claim(&table, &view[who].room, who);
            } else {
                use_room(&table, &view[who], &shared, who, support_below(&random, seed % 2 ? 8 : 150), &random);
            }
            for (int kind = 0; kind < PAR_KINDS; kind++)
                assert_int_equal(table_count(&table, kind, who), room_left(&view[who].room, kind));
        }
        for (int32_t who = 0; who < ROOMS; who++)
            give_back(&table, &view[who].room, &spare);
        for (int kind = 0; kind < PAR_KINDS; kind++) { /* each item is either used or spare */
            assert_int_equal(table_count(&table, kind, NOBODY), 0);
            assert_int_equal(table_count(&table, kind, USED) + room_left(&spare, kind), count_of(&shared, kind));
        }
        par_room_free(&spare);
        table_free(&table);
        tri_mesh_free(&shared);
    }
}

/* Attributes that are linear in the plane, so that interpolated values can be checked. */
static struct tri_mesh mesh_with_attributes(void)
{
    struct tri_pslg pslg = support_square(1, 30, 1);
    struct tri_options options = support_quality(0, 0);
    options.refine = false;
    support_add_segment(&pslg, 0, 2);
    support_add_attributes(&pslg);
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    tri_pslg_free(&pslg);
    return mesh;
}

/* Refines on a view until it is done, reaches its limit, or has no more room. */
static int64_t refine_in_view(struct tri_mesh *shared, struct par_view *view, int64_t limit, double max_area)
{
    struct tri_quality options = tri_quality_defaults();
    struct tri_refine_hooks hooks = {.more_room = par_view_more_room, .more_room_user = view};
    struct tri_refine_report report;
    int32_t n = shared->n_triangles, *worklist = malloc((size_t)n * sizeof *worklist);
    assert_non_null(worklist);
    options.min_angle = 30;
    options.max_area = max_area;
    options.max_steiner = limit;
    hooks.worklist = worklist;
    for (int32_t i = 0; i < n; i++)
        if (tri_is_live(&shared->tri[i]))
            worklist[hooks.n_worklist++] = i;
    par_view_begin(view, shared);
    enum tri_status status = tri_refine_with(&view->mesh, &options, &hooks, &report, NULL);
    assert_true(status == TRI_OK || status == TRI_NO_ROOM);
    par_view_end(view);
    free(worklist);
    return report.inserted_free + report.inserted_on_segments;
}

/* After closing there is no gap, links are valid, the same triangles lie at the same places, and the data of a vertex
   has moved with it. */
static void assert_closed(struct tri_mesh *mesh, const struct support_places *before, int64_t vertices)
{
    struct tri_error error = {0};
    struct support_places after = support_places(mesh);
    assert_int_equal(mesh->n_vertices, vertices);
    assert_int_equal(mesh->n_triangles, before->n);
    assert_true(support_same_places(before, &after));
    support_places_free(&after);
    if (tri_mesh_validate(mesh, &error) != TRI_OK)
        fail_msg("%s", error.text);
    support_assert_cdt(mesh, false);
    tri_surface_settle(mesh, NULL);
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        assert_true(support_has_its_attributes(mesh, v));
        if (mesh->on[v] < 0)
            continue;
        const struct tri_parent *parent = &mesh->parents[mesh->on[v]];
        assert_true(fabs(tri_orient2d(mesh->xy[parent->v[0]], mesh->xy[parent->v[1]], mesh->xy[v])) < 1e-12);
        bool edge = mesh->xy[v].x == 0 || mesh->xy[v].x == 1 || mesh->xy[v].y == 0 || mesh->xy[v].y == 1;
        assert_int_equal(mesh->vertex_markers[v], edge);
    }
    for (int32_t s = 0; s < mesh->n_subs; s++)
        for (int side = 0; side < 2; side++)
            if (mesh->sub[s].side[side] != TRI_NONE)
                assert_int_equal(mesh->tri[tri_of(mesh->sub[s].side[side])].n[tri_edge(mesh->sub[s].side[side])], ~s);
}

/* Views take turns in random order, with more or less room than they need. */
static void test_closing_keeps_the_mesh(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 30; seed++) {
        struct support_random random = {seed};
        struct tri_mesh mesh = mesh_with_attributes();
        struct par_view view[ROOMS] = {0};
        struct par_room spare = {0};
        int64_t vertices = mesh.n_vertices;
        for (int step = 0; step < 40; step++) {
            int32_t who = support_below(&random, ROOMS), action = support_below(&random, 4);
            if (action == 0) {
                par_room_return(&view[who].room, &spare);
            } else if (action == 1) {
                assert_int_equal(par_room_extend(&view[who].room, &spare, &mesh, 1 + support_below(&random, 300), NULL),
                                 TRI_OK);
                par_room_mark(&view[who].room, &mesh, NULL); /* so that the mesh can be checked */
            } else {
                vertices += refine_in_view(&mesh, &view[who], support_below(&random, 60), 2e-4);
            }
        }
        for (int32_t who = 0; who < ROOMS; who++)
            par_room_return(&view[who].room, &spare);
        par_room_mark(&spare, &mesh, NULL);
        struct support_places places = support_places(&mesh);
        assert_true(vertices > mesh.n_input || seed > 0);
        if (seed % 2) {
            struct par_team team = {.threads = 1 + (int)(seed % 3)};
            struct tri_executor executor = par_executor(&team);
            par_room_close(&spare, &mesh, &executor);
            par_team_end(&team);
        } else {
            /* omits marked items */
            struct par_partition tiles;
            const struct tri_quality none = tri_quality_defaults();
            assert_int_equal(par_partition_make(&tiles, &mesh, &none, mesh.n_triangles, 100, NULL, NULL), TRI_OK);
            assert_int_equal(par_number(&mesh, &tiles, mesh.incidence.n_vertices, NULL, NULL), TRI_OK);
            par_partition_free(&tiles);
            par_room_free(&spare);
        }
        assert_closed(&mesh, &places, vertices);
        support_places_free(&places);
        tri_mesh_free(&mesh);
    }
}

/* If nothing was used, the counts are those of before. If everything was used, nothing moves. */
static void test_closing_unused_and_full_rooms(void **state)
{
    (void)state;
    struct tri_mesh mesh = mesh_with_attributes();
    struct par_room room = {0}, spare = {0};
    struct support_places places = support_places(&mesh);
    int32_t vertices = mesh.n_vertices, subs = mesh.n_subs;
    par_room_close(&spare, &mesh, NULL); /* there are no gaps */
    assert_closed(&mesh, &places, vertices);
    for (int i = 0; i < 5; i++) {
        assert_int_equal(par_room_extend(&room, &spare, &mesh, 1000, NULL), TRI_OK);
        par_room_return(&room, &spare);
    }
    assert_true(mesh.n_triangles >= 1000 && mesh.n_triangles < 3000); /* returned items are dealt out again */
    par_room_close(&spare, &mesh, NULL);
    assert_closed(&mesh, &places, vertices);
    assert_int_equal(mesh.n_subs, subs);
    support_places_free(&places);
    tri_mesh_free(&mesh);
}

/* If all points of a block lie on segments, it gets room for one subsegment with each point. It gets no more triangles
   than it requests, and these are still available at its next request. */
static void test_blocks_on_segments_get_room_for_subsegments(void **state)
{
    (void)state;
    struct tri_mesh mesh = mesh_with_attributes();
    struct par_room room = {.on_segments = 1}, spare = {0};
    assert_int_equal(par_room_extend(&room, &spare, &mesh, 10000, NULL), TRI_OK);
    const int32_t triangles = par_room_left(&room, PAR_TRIANGLES), n_triangles = mesh.n_triangles;
    assert_true(triangles >= 10000 && triangles < 10100);
    assert_true(par_room_left(&room, PAR_SUBS) >= 5000);
    assert_int_equal(par_room_extend(&room, &spare, &mesh, triangles, NULL), TRI_OK);
    assert_int_equal(mesh.n_triangles, n_triangles);
    par_room_return(&room, &spare);
    assert_int_equal(par_room_extend(&room, &spare, &mesh, 10, NULL), TRI_OK); /* takes a part of the long range */
    assert_true(par_room_left(&room, PAR_TRIANGLES) <= 2 * PAR_LEAST_RANGE);
    assert_int_equal(mesh.n_triangles, n_triangles);
    par_room_return(&room, &spare);
    par_room_close(&spare, &mesh, NULL);
    tri_mesh_free(&mesh);
}

/* The expected need of blocks is an estimate. If that much memory is not available, blocks still get what they
   request. */
static void test_an_excessive_estimate_does_not_fail(void **state)
{
    (void)state;
    struct tri_mesh mesh = {0};
    struct par_room spare = {0}, room = {0};
    par_room_reserve(&spare, &mesh, INT64_MAX / 4);
    assert_int_equal(mesh.n_triangles, 0);
    assert_int_equal(par_room_extend(&room, &spare, &mesh, 100, NULL), TRI_OK);
    assert_true(par_room_left(&room, PAR_TRIANGLES) >= 100);
    par_room_return(&room, &spare);
    par_room_free(&spare);
    tri_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_blocks_on_segments_get_room_for_subsegments),
        cmocka_unit_test(test_an_excessive_estimate_does_not_fail),
        cmocka_unit_test(test_random_requests_are_satisfied),
        cmocka_unit_test(test_closing_keeps_the_mesh),
        cmocka_unit_test(test_closing_unused_and_full_rooms),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
