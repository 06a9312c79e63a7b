/* The queue against a naive twin: a list that is searched for the first entry in the lowest bucket. */
#include "support.h"
#include "triangle/refine/bad_queue.h"

/* Triangle t has generation 3 t, unless a test changes it. */
enum { SLOTS = 100000 };
static struct tri_triangle triangles[SLOTS];
static struct tri_point corner;
static double feature;
static const struct tri_mesh mesh = {.tri = triangles, .xy = &corner, .feature = &feature};

static int set_up(void **state)
{
    (void)state;
    for (int32_t t = 0; t < SLOTS; t++)
        triangles[t].generation = (uint32_t)t * 3;
    return 0;
}

static void push_angle(struct tri_bad_queue *queue, int32_t t, int bucket)
{
    assert_true(tri_bad_queue_push_angle(queue, (struct tri_entry){t, (uint32_t)t * 3}, bucket));
}

static void push_size(struct tri_bad_queue *queue, int32_t t)
{
    assert_true(tri_bad_queue_push_size(queue, (struct tri_entry){t, (uint32_t)t * 3}, true));
}

static int32_t pop(struct tri_bad_queue *queue)
{
    struct tri_entry entry;
    if (!tri_bad_queue_pop(queue, &mesh, &entry))
        return TRI_NONE;
    assert_int_equal(entry.generation, (uint32_t)entry.t * 3);
    return entry.t;
}

struct waiting {
    int32_t t;  /* triangle */
    int bucket; /* TRI_BUCKETS: the entry is for size */
};

/* First in, first out within the lowest bucket; entries for size come last. */
static int32_t naive_pop(struct waiting *list, int *n)
{
    int best = 0;
    if (*n == 0)
        return TRI_NONE;
    for (int i = 1; i < *n; i++)
        if (list[i].bucket < list[best].bucket)
            best = i;
    int32_t t = list[best].t;
    memmove(&list[best], &list[best + 1], (size_t)(*n - best - 1) * sizeof *list);
    --*n;
    return t;
}

static void test_equals_naive_twin(void **state)
{
    (void)state;
    static struct waiting list[5000];
    static const int few[6] = {0, 1, 63, 64, 65, TRI_BUCKETS - 1};
    for (uint64_t seed = 0; seed < 40; seed++) {
        struct tri_bad_queue queue = {0};
        struct support_random random = {seed};
        int n = 0;
        assert_true(tri_bad_queue_init(&queue));
        for (int32_t i = 0; i < 3000; i++) {
            int draw = support_below(&random, 5 + (int)(seed % 3));
            if (draw < 2) {
                int bucket = seed % 2 ? few[support_below(&random, 6)] : support_below(&random, TRI_BUCKETS);
                push_angle(&queue, i, bucket);
                list[n++] = (struct waiting){i, bucket};
            } else if (draw == 2) {
                push_size(&queue, i);
                list[n++] = (struct waiting){i, TRI_BUCKETS};
            } else {
                assert_int_equal(pop(&queue), naive_pop(list, &n));
            }
        }
        while (n > 0)
            assert_int_equal(pop(&queue), naive_pop(list, &n));
        assert_int_equal(pop(&queue), TRI_NONE);
        tri_bad_queue_free(&queue);
    }
}

/* With more entries for size than the window holds, each entry comes back once. The entries pushed last before the
 * window overflowed come first. */
static void test_sizes_beyond_the_window(void **state)
{
    (void)state;
    enum { N = 5 * TRI_WINDOW + 77 };
    struct tri_bad_queue queue = {0};
    struct support_random random = {1};
    bool *seen = calloc(N, sizeof *seen);
    int32_t popped = 0;
    assert_true(tri_bad_queue_init(&queue));
    for (int32_t i = 0; i < N; i++) {
        push_size(&queue, i);
        for (int k = support_below(&random, 6) == 0; k > 0; k--) {
            int32_t t = pop(&queue);
            assert_true(t <= i && !seen[t]);
            seen[t] = true;
            popped++;
        }
    }
    for (int32_t t; (t = pop(&queue)) != TRI_NONE; popped++) {
        assert_false(seen[t]);
        seen[t] = true;
    }
    assert_int_equal(popped, N);
    free(seen);
    tri_bad_queue_free(&queue);
}

/* The window keeps recent entries. When it overflows, the older half waits until all other entries are served. */
static void test_a_full_window_moves_its_older_half(void **state)
{
    (void)state;
    struct tri_bad_queue queue = {0};
    assert_true(tri_bad_queue_init(&queue));
    for (int32_t i = 0; i <= TRI_WINDOW; i++)
        push_size(&queue, i);
    for (int32_t i = TRI_WINDOW / 2; i <= TRI_WINDOW; i++)
        assert_int_equal(pop(&queue), i);
    for (int32_t i = 0; i < TRI_WINDOW / 2; i++)
        assert_int_equal(pop(&queue), i);
    assert_int_equal(pop(&queue), TRI_NONE);
    tri_bad_queue_free(&queue);
}

/* An entry for size whose triangle has changed when its batch is filtered is dropped. Triangles that are not bad are
 * not queued. The order of the other entries stays. */
static void test_outdated_entries_are_dropped(void **state)
{
    (void)state;
    enum { N = 1000 };
    struct tri_bad_queue queue = {0};
    struct support_random random = {3};
    bool kept[N];
    assert_true(tri_bad_queue_init(&queue));
    for (int32_t t = 0; t < N; t++) {
        bool bad = support_below(&random, 3) > 0;
        triangles[t].generation += support_below(&random, 2) == 0;
        kept[t] = bad && triangles[t].generation == (uint32_t)t * 3;
        assert_true(tri_bad_queue_push_size(&queue, (struct tri_entry){t, (uint32_t)t * 3}, bad));
    }
    for (int32_t t = 0; t < N; t++)
        if (kept[t])
            assert_int_equal(pop(&queue), t);
    assert_int_equal(pop(&queue), TRI_NONE);
    tri_bad_queue_free(&queue);
}

/* Blocks of the pool are reused, so constant traffic does not enlarge the pool. */
static void test_worklist_is_reused(void **state)
{
    (void)state;
    struct tri_bad_queue queue = {0};
    assert_true(tri_bad_queue_init(&queue));
    for (int32_t i = 0; i < 100000; i++) {
        push_angle(&queue, i, i % TRI_BUCKETS);
        if (i >= 100)
            assert_true(pop(&queue) != TRI_NONE);
    }
    assert_in_range(queue.block_capacity, 100, 1024);
    tri_bad_queue_free(&queue);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_equals_naive_twin, set_up),
        cmocka_unit_test_setup(test_sizes_beyond_the_window, set_up),
        cmocka_unit_test_setup(test_a_full_window_moves_its_older_half, set_up),
        cmocka_unit_test_setup(test_outdated_entries_are_dropped, set_up),
        cmocka_unit_test_setup(test_worklist_is_reused, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
