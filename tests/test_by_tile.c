/* Sorting a worklist by tiles gives the same order for any initial order, and for any distribution of the tiles. */
#include "sched/schedule/worklist.h"

#include "tests/support.h"

static struct tri_quality bounds(void)
{
    struct tri_quality quality = tri_quality_defaults();
    quality.min_angle = 25;
    return quality;
}

struct world {
    struct tri_mesh mesh;
    struct tri_quality quality;
    struct par_partition tiles;
    struct par_ids worklist;
    struct par_keys key;
};

static void begin(struct world *w)
{
    struct tri_pslg pslg = support_square(1, 3000, 3);
    struct tri_options options = tri_defaults();
    struct tri_report report;
    *w = (struct world){.quality = bounds()};
    w->mesh = support_generate(&pslg, &options, &report);
    tri_pslg_free(&pslg);
    assert_int_equal(par_partition_make(&w->tiles, &w->mesh, &w->quality, 1e5, 2000, NULL, NULL), TRI_OK);
    for (int32_t t = 0; t < w->mesh.n_triangles; t++)
        assert_true(par_ids_add(&w->worklist, t));
}

static void end(struct world *w)
{
    free(w->worklist.item);
    free(w->key.item);
    par_partition_free(&w->tiles);
    tri_mesh_free(&w->mesh);
}

static bool order(struct world *w, int32_t first, int32_t end)
{
    return par_order_by_tile(&w->worklist, &w->key, &w->mesh, &w->tiles, first, end, &support_backwards);
}

static void shuffle(struct par_ids *list)
{
    struct support_random random = {5};
    for (int32_t i = list->n - 1; i > 0; i--) {
        int32_t k = support_below(&random, i + 1), item = list->item[i];
        list->item[i] = list->item[k];
        list->item[k] = item;
    }
}

static void test_initial_order_does_not_matter(void **state)
{
    (void)state;
    struct world w, other;
    begin(&w);
    begin(&other);
    shuffle(&other.worklist);
    assert_true(order(&w, 0, par_blocks(&w.tiles)));
    assert_true(order(&other, 0, par_blocks(&other.tiles)));
    assert_int_equal(w.worklist.n, w.mesh.n_triangles);
    assert_int_equal(other.worklist.n, w.mesh.n_triangles);
    assert_memory_equal(w.worklist.item, other.worklist.item, (size_t)w.mesh.n_triangles * sizeof(int32_t));
    assert_memory_equal(w.key.item, other.key.item, (size_t)w.mesh.n_triangles * sizeof(uint64_t));
    for (int32_t i = 1; i < w.mesh.n_triangles; i++)
        assert_true(w.key.item[i - 1] < w.key.item[i]);
    end(&w);
    end(&other);
}

/* A rank that has some of the tiles finds their triangles with the same keys as a rank that has all tiles. */
static void test_parts_get_the_keys_of_the_whole(void **state)
{
    (void)state;
    struct world w;
    int32_t at = 0;
    begin(&w);
    assert_true(order(&w, 0, par_blocks(&w.tiles)));
    const int32_t cut[] = {0, par_blocks(&w.tiles) / 3, par_blocks(&w.tiles) / 3, par_blocks(&w.tiles)};
    for (int p = 0; p < 3; p++) {
        struct world part;
        begin(&part);
        shuffle(&part.worklist);
        assert_true(order(&part, cut[p], cut[p + 1]));
        for (int32_t i = 0; i < part.worklist.n; i++, at++) {
            assert_int_equal(part.worklist.item[i], w.worklist.item[at]);
            assert_true(part.key.item[i] == w.key.item[at]);
        }
        end(&part);
    }
    assert_int_equal(at, w.mesh.n_triangles);
    end(&w);
}

/* Triangles with the same centre are ordered by their corners. */
static void test_equal_centres(void **state)
{
    (void)state;
    struct world w;
    begin(&w);
    for (int32_t v = 0; v < w.mesh.n_vertices; v++) /* only few different places */
        w.mesh.xy[v] = (struct tri_point){floor(4 * w.mesh.xy[v].x), floor(4 * w.mesh.xy[v].y)};
    shuffle(&w.worklist);
    assert_true(order(&w, 0, par_blocks(&w.tiles)));
    for (int32_t i = 1; i < w.worklist.n; i++) {
        const tri_triangle_id before = w.worklist.item[i - 1], here = w.worklist.item[i];
        const tri_vertex_id *v = w.mesh.tri[before].v, *u = w.mesh.tri[here].v;
        const struct tri_point *xy = w.mesh.xy, a = xy[v[0]], b = xy[u[0]];
        bool same_tile = w.key.item[i - 1] >> 32 == w.key.item[i] >> 32;
        bool same_centre = (a.x + xy[v[1]].x + xy[v[2]].x) / 3 == (b.x + xy[u[1]].x + xy[u[2]].x) / 3 &&
                           (a.y + xy[v[1]].y + xy[v[2]].y) / 3 == (b.y + xy[u[1]].y + xy[u[2]].y) / 3;
        assert_true(!same_tile || !same_centre || a.x < b.x || (a.x == b.x && a.y <= b.y));
    }
    end(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_initial_order_does_not_matter),
        cmocka_unit_test(test_parts_get_the_keys_of_the_whole),
        cmocka_unit_test(test_equal_centres),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
