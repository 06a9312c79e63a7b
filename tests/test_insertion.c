/* Insertion of a range of vertices (a stretch): a call inserts the vertices whose cavity it owns, and changes nothing
 * else. */
#include "support.h"

#include "triangle/cdt/delaunay.h"

/* A triangulation with ghost triangles, which at first contains only the first three corners. */
struct trial {
    struct tri_pslg pslg;
    struct tri_point *xy;
    struct tri_triangle *tri;
    int32_t n, first[3];
};

/* Returns true if an earlier vertex has the same place. Such a vertex must not be inserted. */
static bool is_twin(const struct trial *t, int32_t v)
{
    for (int32_t w = 0; w < v; w++)
        if (t->xy[w].x == t->xy[v].x && t->xy[w].y == t->xy[v].y)
            return true;
    return false;
}

static struct trial begin(enum support_kind kind, int32_t n, uint64_t seed)
{
    struct trial t = {.pslg = support_points(kind, n, seed), .n = n};
    t.xy = malloc((size_t)n * sizeof *t.xy);
    t.tri = calloc(2 * (size_t)n + 4, sizeof *t.tri);
    assert_true(t.xy && t.tri);
    for (int32_t v = 0; v < n; v++)
        t.xy[v] = (struct tri_point){t.pslg.points[2 * v], t.pslg.points[2 * v + 1]};
    int32_t found = 0;
    for (int32_t v = 0; found < 3 && v < n; v++)
        if (!is_twin(&t, v) && (found < 2 || tri_orient2d(t.xy[t.first[0]], t.xy[t.first[1]], t.xy[v]) != 0))
            t.first[found++] = v;
    assert_int_equal(found, 3);
    for (int32_t i = 0; i < 2 * n; i++)
        t.tri[i].v[0] = TRI_NONE;
    tri_insert_first(t.xy, t.tri, 2 * n, t.first);
    return t;
}

static void end(struct trial *t)
{
    free(t->xy);
    free(t->tri);
    tri_pslg_free(&t->pslg);
}

static bool is_free(const struct tri_triangle *t) { return t->v[0] == TRI_NONE; }

/* Asserts that every edge of every triangle, including ghosts, has a neighbour with the reversed edge. */
static void assert_linked(const struct trial *t)
{
    for (int32_t i = 0; i < 2 * t->n + 4; i++)
        for (int e = 0; !is_free(&t->tri[i]) && e < 3; e++) {
            int32_t link = t->tri[i].n[e];
            assert_true(link >= 0 && tri_of(link) < 2 * t->n + 4 && !is_free(&t->tri[tri_of(link)]));
            const struct tri_triangle *other = &t->tri[tri_of(link)];
            int f = tri_edge(link);
            assert_int_equal(other->n[f], tri_code(i, e));
            assert_int_equal(other->v[tri_next[f]], t->tri[i].v[tri_prev[e]]);
            assert_int_equal(other->v[tri_prev[f]], t->tri[i].v[tri_next[e]]);
        }
}

/* Asserts that no inserted vertex is in the disk of a triangle or beyond a hull edge. */
static void assert_delaunay(const struct trial *t, const bool *inserted)
{
    for (int32_t i = 0; i < 2 * t->n + 4; i++) {
        const int32_t *v = t->tri[i].v;
        if (is_free(&t->tri[i]))
            continue;
        int ghost = tri_ghost_corner(&t->tri[i]);
        for (int32_t q = 0; q < t->n; q++) {
            if (!inserted[q] || is_twin(t, q) || q == v[0] || q == v[1] || q == v[2])
                continue;
            if (ghost < 0)
                assert_false(tri_in_circle(t->xy[v[0]], t->xy[v[1]], t->xy[v[2]], t->xy[q]));
            else
                assert_true(tri_orient2d(t->xy[v[tri_next[ghost]]], t->xy[v[tri_prev[ghost]]], t->xy[q]) <= 0);
        }
    }
}

/* Inserts the vertices of the stretch that it owns, starting at triangle `entry`. Returns how many it did not own. */
static int32_t insert_stretch(struct trial *t, struct tri_range stretch, int32_t entry, bool *inserted)
{
    struct tri_inserter inserter = {.xy = t->xy, .tri = t->tri, .stretch = stretch, .last = entry};
    size_t bytes = (2 * (size_t)t->n + 4) * sizeof *t->tri;
    struct tri_triangle *before = malloc(bytes);
    int32_t not_owned = 0;
    assert_non_null(before);
    for (int32_t v = stretch.first; v < stretch.last; v++) {
        if (inserted[v])
            continue;
        memcpy(before, t->tri, bytes);
        enum tri_insertion done = tri_insert(&inserter, v, 2 * v);
        assert_true(done != TRI_INSERTION_NO_MEMORY);
        inserted[v] = done == TRI_INSERTED;
        not_owned += done == TRI_NOT_OWNED;
        for (int32_t i = 0; i < 2 * t->n + 4; i++) {
            if (done == TRI_NOT_OWNED)
                assert_memory_equal(&t->tri[i], &before[i], sizeof before[i]);
            else if (memcmp(t->tri[i].v, before[i].v, sizeof before[i].v) != 0)
                assert_true(tri_inserter_owns(&inserter, &t->tri[i])); /* and it was owned before, or free */
        }
    }
    free(before);
    tri_inserter_free(&inserter);
    return not_owned;
}

/* Returns a triangle that the stretch owns, or TRI_NONE. */
static int32_t any_owned(const struct trial *t, struct tri_range stretch)
{
    const struct tri_inserter inserter = {.xy = t->xy, .tri = t->tri, .stretch = stretch};
    for (int32_t i = 0; i < 2 * t->n + 4; i++)
        if (!is_free(&t->tri[i]) && tri_inserter_owns(&inserter, &t->tri[i]))
            return i;
    return TRI_NONE;
}

static void test_one_block_inserts_all(void **state)
{
    (void)state;
    static const enum support_kind kinds[] = {SUPPORT_RANDOM, SUPPORT_LATTICE, SUPPORT_RING, SUPPORT_LINE,
                                              SUPPORT_NEAR_LINE, SUPPORT_CLUSTER};
    for (int k = 0; k < 6; k++) {
        struct trial t = begin(kinds[k], 60, 7 + (uint64_t)k);
        bool inserted[60] = {false};
        for (int32_t v = 0; v < t.n; v++)
            inserted[v] = v == t.first[0] || v == t.first[1] || v == t.first[2] || is_twin(&t, v);
        assert_int_equal(insert_stretch(&t, (struct tri_range){0, t.n}, 2 * t.n, inserted), 0);
        assert_linked(&t);
        assert_delaunay(&t, inserted);
        end(&t);
    }
}

/* Points sorted by x, in two halves. Each half leaves exactly the vertices whose cavity crosses the border to a final
 * call that owns everything. */
static void test_two_blocks_and_the_rest(void **state)
{
    (void)state;
    enum { N = 80 };
    struct trial t = begin(SUPPORT_RANDOM, N, 3);
    for (int32_t i = 1; i < N; i++)
        for (int32_t k = i; k > 0 && t.xy[k].x < t.xy[k - 1].x; k--) {
            struct tri_point kept = t.xy[k];
            t.xy[k] = t.xy[k - 1];
            t.xy[k - 1] = kept;
        }
    bool inserted[N] = {false};
    for (int i = 0; i < 3; i++) {
        t.first[i] = i * (N - 1) / 2;
        inserted[t.first[i]] = true;
    }
    tri_insert_first(t.xy, t.tri, 2 * N, t.first);
    const struct tri_range all = {0, N}, half[2] = {{0, N / 2}, {N / 2, N}};
    for (int32_t v = 5; v < N; v += 5) { /* inserts a few first, so that each half owns triangles */
        struct tri_inserter inserter = {.xy = t.xy, .tri = t.tri, .stretch = all, .last = any_owned(&t, all)};
        if (!inserted[v])
            assert_int_equal(tri_insert(&inserter, v, 2 * v), TRI_INSERTED);
        inserted[v] = true;
        tri_inserter_free(&inserter);
    }
    int32_t left = 0, waiting = 0;
    for (int32_t v = 0; v < N; v++)
        waiting += !inserted[v];
    for (int k = 0; k < 2; k++)
        left += insert_stretch(&t, half[k], any_owned(&t, half[k]), inserted);
    assert_linked(&t);
    assert_delaunay(&t, inserted);
    assert_true(left > 0 && left < waiting);
    assert_int_equal(insert_stretch(&t, all, any_owned(&t, all), inserted), 0);
    assert_linked(&t);
    assert_delaunay(&t, inserted);
    end(&t);
}

static void test_the_first_triangle_turns_left(void **state)
{
    (void)state;
    const struct tri_point xy[] = {{0, 0}, {1, 0}, {0, 1}};
    static const int32_t order[2][3] = {{0, 1, 2}, {0, 2, 1}};
    for (int k = 0; k < 2; k++) {
        struct tri_triangle tri[4];
        tri_insert_first(xy, tri, 0, order[k]);
        assert_true(tri_orient2d(xy[tri[0].v[0]], xy[tri[0].v[1]], xy[tri[0].v[2]]) > 0);
        assert_int_equal(tri_ghost_corner(&tri[0]), -1);
        for (int g = 1; g < 4; g++)
            assert_int_equal(tri_ghost_corner(&tri[g]), 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_one_block_inserts_all),
        cmocka_unit_test(test_two_blocks_and_the_rest),
        cmocka_unit_test(test_the_first_triangle_turns_left),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
