/* Messages between ranks: the receiver reads what the sender wrote, in one message or several. Invalid bytes are
   refused.
   This program is linked with --wrap, see allocations.h. */
#include "allocations.h"
#include "full.h"
#include "support.h"

#include "sched/ranks/talk.h"

/* Two sides with the same mesh, so that ids on both are equal. */
struct pair {
    struct tri_pslg pslg;
    struct tri_mesh mesh;
    struct par_talk teller, listener;
    int32_t n_common;
};

static struct pair new_pair(void)
{
    struct pair pair = {.pslg = support_tangle(SUPPORT_RANDOM, 60, 12, 11)};
    struct tri_options options = support_quality(25, 1e-3);
    pair.mesh = support_generate(&pair.pslg, &options, NULL);
    pair.n_common = pair.mesh.n_vertices / 4;
    for (int32_t v = 0; v < pair.mesh.n_vertices; v += 5)
        pair.mesh.vertex_markers[v] = v % 2 ? v : -v;
    return pair;
}

static void free_pair(struct pair *pair)
{
    par_talk_free(&pair->teller);
    par_talk_free(&pair->listener);
    tri_mesh_free(&pair->mesh);
    tri_pslg_free(&pair->pslg);
}

/* Sends triangles from..end - 1 in the given step, in any order. Returns false if memory ran out. */
static bool write_triangles(struct pair *pair, int32_t from, int32_t end, struct par_message *m,
                            struct par_bytes *bytes)
{
    int32_t first = pair->teller.triangle.n;
    bool memory = true;
    m->first = first;
    for (int32_t t = from; memory && t < end; t++)
        memory = par_talk_add_triangle(&pair->teller, t);
    memory = memory && par_message_fill(m, &pair->teller, &pair->mesh, pair->n_common);
    for (int32_t i = first; memory && i < pair->teller.triangle.n; i += 7)
        memory = par_message_add_entry(m, (uint64_t)i << 32, pair->teller.triangle.n - 1 - (i - first));
    return memory && par_message_write(m, &pair->teller, &pair->mesh, pair->n_common, bytes);
}

/* Adds the same triangles on the receiving side. */
static void catch_up(struct pair *pair)
{
    const struct par_talk *from = &pair->teller;
    struct par_talk *to = &pair->listener;
    while (to->vertex.n < from->vertex.n)
        assert_true(par_talk_add_vertex(to, from->vertex.item[to->vertex.n]));
    while (to->triangle.n < from->triangle.n)
        assert_true(par_talk_add_triangle(to, from->triangle.item[to->triangle.n]));
    while (to->sub.n < from->sub.n)
        assert_true(par_talk_add_sub(to, &pair->mesh, from->sub.item[to->sub.n]));
}

static void assert_same_vertex(const struct par_told_vertex *a, const struct par_told_vertex *b)
{
    assert_int_equal(a->common, b->common);
    if (a->common != TRI_NONE)
        return;
    assert_true(a->xy.x == b->xy.x && a->xy.y == b->xy.y && a->feature == b->feature);
    assert_true(a->on == b->on && a->marker == b->marker);
}

static void assert_same_side(const struct par_told_side *a, const struct par_told_side *b, bool is_new)
{
    assert_true(a->triangle == b->triangle && a->edge == b->edge && a->side == b->side && a->sub == b->sub);
    assert_int_equal(a->is_boundary, b->is_boundary);
    assert_true(!is_new || (a->marker == b->marker && a->parent == b->parent));
}

static void assert_same_message(const struct par_message *a, const struct par_message *b, int32_t subs)
{
    assert_true(a->n_vertices == b->n_vertices && a->n_triangles == b->n_triangles && a->n_sides == b->n_sides);
    assert_true(a->n_entries == b->n_entries && a->n_new_subs == b->n_new_subs);
    assert_true(a->gone.n == b->gone.n && a->gone_subs.n == b->gone_subs.n);
    for (int32_t i = 0; i < a->gone.n; i++)
        assert_int_equal(a->gone.item[i], b->gone.item[i]);
    for (int32_t i = 0; i < a->n_vertices; i++)
        assert_same_vertex(&a->vertex[i], &b->vertex[i]);
    assert_memory_equal(a->triangle, b->triangle, (size_t)a->n_triangles * sizeof *a->triangle);
    for (int32_t i = 0; i < a->n_sides; subs += a->side[i++].sub == subs)
        assert_same_side(&a->side[i], &b->side[i], a->side[i].sub == subs);
    for (int32_t i = 0; i < a->n_entries; i++)
        assert_true(a->entry[i].key == b->entry[i].key && a->entry[i].triangle == b->entry[i].triangle);
}

static enum tri_status read_message(const struct pair *pair, const struct par_bytes *bytes, struct par_message *m)
{
    struct tri_error error = {0};
    enum tri_status status = par_message_read(m, &pair->listener, &pair->mesh, pair->n_common, bytes, &error);
    assert_true(!status || error.text[0] != 0);
    return status;
}

static void test_messages_are_read_as_written(void **state)
{
    (void)state;
    struct pair pair = new_pair();
    int32_t n = pair.mesh.n_triangles, parts = 3;
    for (int32_t part = 0; part < parts; part++) {
        struct par_message told = {0}, heard;
        struct par_bytes bytes = {0};
        for (int32_t i = 0; part == 2 && i < 40; i += 1 + i % 3) { /* as if these triangles no longer existed */
            assert_true(par_ids_add(&told.gone, i));
            pair.teller.triangle.item[i] = TRI_NONE;
        }
        assert_true(write_triangles(&pair, part * (n / parts), part < parts - 1 ? (part + 1) * (n / parts) : n, &told,
                                    &bytes));
        assert_int_equal(read_message(&pair, &bytes, &heard), TRI_OK);
        assert_same_message(&told, &heard, pair.listener.sub.n);
        assert_true(part == 0 || told.triangle[told.n_triangles - 1].next[0] != 0);
        print_message("  %d bytes for %d triangles and %d vertices\n", (int)bytes.n, (int)told.n_triangles,
                      (int)told.n_vertices);
        catch_up(&pair);
        par_message_free(&told);
        par_message_free(&heard);
        free(bytes.at);
    }
    assert_int_equal(pair.teller.sub.n, pair.mesh.n_subs);
    free_pair(&pair);
}

static void test_invalid_messages_are_refused(void **state)
{
    (void)state;
    struct pair pair = new_pair();
    struct par_message told = {0}, heard;
    struct par_bytes bytes = {0};
    struct support_random random = {3};
    assert_true(write_triangles(&pair, 0, pair.mesh.n_triangles / 3, &told, &bytes));
    for (int k = 0; k < 300; k++) {
        size_t at = (size_t)support_below(&random, (int32_t)bytes.n);
        char kept = bytes.at[at];
        bytes.at[at] = (char)(kept ^ (1 << support_below(&random, 8)));
        assert_int_equal(read_message(&pair, &bytes, &heard), TRI_INTERNAL);
        par_message_free(&heard);
        bytes.at[at] = kept;
    }
    for (struct par_bytes cut = {bytes.at, 0, 0}; cut.n < bytes.n; cut.n += 1 + bytes.n / 50) {
        assert_int_equal(read_message(&pair, &cut, &heard), TRI_INTERNAL);
        par_message_free(&heard);
    }
    catch_up(&pair); /* triangles that were sent are not sent again */
    assert_int_equal(read_message(&pair, &bytes, &heard), TRI_OK);
    par_message_free(&heard);
    par_message_free(&told);
    free(bytes.at);
    free_pair(&pair);
}

#ifdef SUPPORT_WRAP
static void test_every_allocation_may_fail(void **state)
{
    (void)state;
    bool done = false;
    for (int64_t k = 1; !done; k += every(5)) {
        struct pair pair = new_pair();
        struct par_message told = {0}, heard = {0};
        struct par_bytes bytes = {0};
        support_calls = 0;
        support_fail_at = k;
        done = write_triangles(&pair, 0, pair.mesh.n_triangles / 3, &told, &bytes);
        enum tri_status status = done ? read_message(&pair, &bytes, &heard) : TRI_OK;
        support_fail_at = INT64_MAX;
        assert_true(status == TRI_OK || status == TRI_NO_MEMORY);
        done = done && !status;
        par_message_free(&told);
        par_message_free(&heard);
        free(bytes.at);
        free_pair(&pair);
    }
}
#endif

int main(void)
{
    const struct CMUnitTest tests[] = {
#ifdef SUPPORT_WRAP
        cmocka_unit_test(test_every_allocation_may_fail),
#endif
        cmocka_unit_test(test_messages_are_read_as_written),
        cmocka_unit_test(test_invalid_messages_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
