/* Fragments: what is cut out of a refined mesh and pasted into the coarse one it came from makes them the same there;
 * what is no fragment changes nothing. This program is linked with --wrap, see allocations.h. */
#include "allocations.h"
#include "support.h"

#include "sched/ranks/fragment.h"

/* A mesh and a worklist, of which the refined one is a later state. */
struct pair {
    struct tri_pslg pslg;
    struct tri_mesh coarse, refined;
    struct par_state from, to;
    int32_t n_common;
};

static struct tri_mesh start_mesh(const struct tri_pslg *pslg)
{
    struct tri_options options = support_quality(25, 1e-2);
    return support_generate(pslg, &options, NULL);
}

/* Triangles whose number ends in this digit, as a worklist with keys. */
static void list_some(struct par_state *state, int32_t digit)
{
    for (int32_t t = digit; t < state->mesh->n_triangles; t += 10)
        assert_true(par_worklist_add(&state->worklist, t));
    assert_true(par_keys_tell(state));
}

static const struct tri_fence BOX = {0.25, -1, 0.625, 0.5};

static struct pair new_pair(const char *file)
{
    struct pair pair;
    struct tri_refine_report report;
    if (file)
        assert_true(support_read(file, &pair.pslg));
    else
        pair.pslg = support_tangle(SUPPORT_RANDOM, 60, 12, 11);
    pair.coarse = start_mesh(&pair.pslg);
    pair.refined = start_mesh(&pair.pslg);
    pair.n_common = pair.coarse.n_vertices;
    struct tri_refine_options quality = support_quality(25, 1e-4).quality;
    quality.fence = &BOX;
    assert_int_equal(tri_refine(&pair.refined, &quality, &report, NULL), TRI_OK);
    assert_true(report.inserted_free > 50);
    return pair;
}

static void list_both(struct pair *pair)
{
    pair->from = (struct par_state){.mesh = &pair->refined};
    pair->to = (struct par_state){.mesh = &pair->coarse};
    list_some(&pair->from, 3);
    list_some(&pair->to, 7);
}

static void free_state(struct par_state *state)
{
    free(state->worklist.item);
    free(state->key.item);
    par_room_free(&state->spare);
}

static void free_pair(struct pair *pair)
{
    free_state(&pair->from);
    free_state(&pair->to);
    tri_mesh_free(&pair->coarse);
    tri_mesh_free(&pair->refined);
    tri_pslg_free(&pair->pslg);
}

static bool touches(const struct tri_mesh *mesh, int32_t t, const struct tri_fence *box)
{
    const int32_t *v = mesh->tri[t].v;
    return tri_fence_holds(box, mesh->xy[v[0]]) || tri_fence_holds(box, mesh->xy[v[1]]) ||
           tri_fence_holds(box, mesh->xy[v[2]]);
}

static int32_t entries_in(const struct par_state *state, const struct tri_fence *box)
{
    int32_t n = 0;
    for (int32_t i = 0; i < state->worklist.n; i++)
        n += touches(state->mesh, state->worklist.item[i], box);
    return n;
}

static void assert_same_mesh(struct pair *pair)
{
    struct tri_error fault = {0};
    tri_mesh_compact(&pair->coarse);
    if (tri_mesh_validate(&pair->coarse, &fault) != TRI_OK)
        fail_msg("%s", fault.text);
    struct support_places a = support_places(&pair->coarse), b = support_places(&pair->refined);
    assert_true(support_same_places(&a, &b));
    support_places_free(&a);
    support_places_free(&b);
}

/* All in one piece, or the halves of the box, in either order: triangles across the cut are in both. */
static void test_what_is_pasted_is_what_was_cut(void **state)
{
    (void)state;
    for (int pieces = 0; pieces < 3; pieces++) {
        struct pair pair = new_pair(NULL);
        struct par_bytes bytes = {0};
        list_both(&pair);
        int32_t outside = pair.to.worklist.n - entries_in(&pair.to, &BOX), inside = entries_in(&pair.from, &BOX);
        struct tri_fence part[2] = {BOX, BOX};
        part[0].x_max = pieces == 0 ? BOX.x_max : 0.4;
        part[1].x_min = 0.4;
        for (int k = 0; k < (pieces > 0 ? 2 : 1); k++)
            assert_int_equal(par_fragment_cut(&bytes, &pair.from, pair.n_common, &part[pieces == 2 ? 1 - k : k], NULL),
                             TRI_OK);
        for (size_t at = 0, used = 0; at < bytes.n; at += used)
            assert_int_equal(par_fragment_paste(&pair.to, pair.n_common, bytes.at + at, bytes.n - at, &used, NULL),
                             TRI_OK);
        assert_int_equal(pair.to.worklist.n, outside + inside);
        assert_int_equal(entries_in(&pair.to, &BOX), inside);
        for (int32_t i = 1; i < pair.to.key.n; i++)
            assert_true(pair.to.key.item[i - 1] <= pair.to.key.item[i]);
        if (pieces == 0)
            print_message("  %d bytes for %d triangles\n", (int)bytes.n, (int)pair.refined.n_triangles);
        assert_same_mesh(&pair);
        free(bytes.at);
        free_pair(&pair);
    }
}

/* There and back again leaves no trace, and no room is lost. */
static void test_a_coarse_piece_takes_the_fine_one_back(void **state)
{
    (void)state;
    struct pair pair = new_pair(NULL);
    struct par_bytes fine = {0}, coarse = {0};
    list_both(&pair);
    struct support_places before = support_places(&pair.coarse);
    size_t used;
    assert_int_equal(par_fragment_cut(&fine, &pair.from, pair.n_common, &BOX, NULL), TRI_OK);
    assert_int_equal(par_fragment_cut(&coarse, &pair.to, pair.n_common, &BOX, NULL), TRI_OK);
    assert_int_equal(par_fragment_paste(&pair.to, pair.n_common, fine.at, fine.n, &used, NULL), TRI_OK);
    int32_t n = pair.coarse.n_triangles;
    assert_int_equal(par_fragment_paste(&pair.to, pair.n_common, coarse.at, coarse.n, &used, NULL), TRI_OK);
    assert_int_equal(pair.coarse.n_triangles, n);
    int32_t spare = 0, live = 0;
    for (int32_t i = 0; i < pair.to.spare.ranges[PAR_TRIANGLES].n; i++)
        spare += pair.to.spare.ranges[PAR_TRIANGLES].item[i].end - pair.to.spare.ranges[PAR_TRIANGLES].item[i].next;
    for (int32_t t = 0; t < n; t++)
        live += tri_is_live(&pair.coarse.tri[t]);
    assert_int_equal(live + spare, n);
    const struct par_ranges *gone = &pair.to.spare.ranges[PAR_VERTICES]; /* those that only the fine one had */
    int32_t vertices = pair.n_common;
    for (int32_t i = 0; i < gone->n; i++)
        vertices += gone->item[i].end - gone->item[i].next;
    assert_true(gone->n > 0 && vertices == pair.coarse.n_vertices);
    tri_mesh_compact(&pair.coarse);
    assert_int_equal(tri_mesh_validate(&pair.coarse, NULL), TRI_OK);
    struct support_places after = support_places(&pair.coarse);
    assert_true(support_same_places(&before, &after));
    support_places_free(&before);
    support_places_free(&after);
    free(fine.at);
    free(coarse.at);
    free_pair(&pair);
}

static void test_what_is_no_fragment_changes_nothing(void **state)
{
    (void)state;
    struct pair pair = new_pair(NULL);
    struct par_bytes bytes = {0};
    struct support_random random = {3};
    size_t used;
    list_both(&pair);
    struct tri_mesh untouched = start_mesh(&pair.pslg);
    assert_int_equal(par_fragment_cut(&bytes, &pair.from, pair.n_common, &BOX, NULL), TRI_OK);
    for (int k = 0; k < 200; k++) {
        size_t at = (size_t)support_below(&random, (int32_t)bytes.n);
        at = k % 2 ? at % 88 : at; /* in the header, often */
        char kept = bytes.at[at];
        bytes.at[at] = (char)(kept ^ (1 << support_below(&random, 8)));
        struct tri_error error = {0};
        if (par_fragment_paste(&pair.to, pair.n_common, bytes.at, bytes.n, &used, &error) != TRI_INTERNAL)
            fail_msg("byte %d may be anything", (int)at);
        assert_true(error.text[0] != 0);
        bytes.at[at] = kept;
    }
    for (size_t n = 0; n < bytes.n; n += 1 + bytes.n / 50)
        assert_int_equal(par_fragment_paste(&pair.to, pair.n_common, bytes.at, n, &used, NULL), TRI_INTERNAL);
    support_assert_same_bytes(&pair.coarse, &untouched);
    assert_int_equal(par_fragment_paste(&pair.to, pair.n_common, bytes.at, bytes.n, &used, NULL), TRI_OK);
    assert_same_mesh(&pair);
    free(bytes.at);
    tri_mesh_free(&untouched);
    free_pair(&pair);
}

#ifdef SUPPORT_WRAP
static void test_every_allocation_may_fail(void **state)
{
    (void)state;
    struct pair pair = new_pair(NULL);
    struct par_bytes bytes = {0}, second = {0};
    size_t used;
    list_both(&pair);
    enum tri_status status = TRI_NO_MEMORY;
    for (int64_t k = 1; status; k++) {
        support_calls = 0;
        support_fail_at = k;
        status = par_fragment_cut(&bytes, &pair.from, pair.n_common, &BOX, NULL);
        support_fail_at = INT64_MAX;
        assert_true(status == TRI_OK || (status == TRI_NO_MEMORY && bytes.n == 0));
    }
    int32_t entries = pair.to.worklist.n;
    status = TRI_NO_MEMORY;
    for (int64_t k = 1; status; k++) {
        support_calls = 0;
        support_fail_at = k;
        status = par_fragment_paste(&pair.to, pair.n_common, bytes.at, bytes.n, &used, NULL);
        support_fail_at = INT64_MAX;
        if (status) {
            assert_int_equal(status, TRI_NO_MEMORY);
            assert_int_equal(tri_mesh_validate(&pair.coarse, NULL), TRI_OK);
            assert_int_equal(pair.to.worklist.n, entries);
        }
    }
    assert_same_mesh(&pair);
    free(bytes.at);
    free(second.at);
    free_pair(&pair);
}
#endif

int main(void)
{
    const struct CMUnitTest tests[] = {
#ifdef SUPPORT_WRAP
        cmocka_unit_test(test_every_allocation_may_fail),
#endif
        cmocka_unit_test(test_what_is_pasted_is_what_was_cut),
        cmocka_unit_test(test_a_coarse_piece_takes_the_fine_one_back),
        cmocka_unit_test(test_what_is_no_fragment_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
