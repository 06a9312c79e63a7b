/* The order of a triangulation's triangles, and that this order does not depend on how they were made. */
#include "support.h"
#include "triangle/cdt/delaunay.h"

/* A triangulation with ghost triangles of all vertices of a mesh, whose numbers have gaps. */
struct loose {
    struct tri_triangle *tri;
    int32_t n, n_live; /* entries of tri; those that are triangles */
};

static struct loose insert_all(const struct tri_mesh *mesh)
{
    int32_t n = mesh->n_vertices;
    struct loose loose = {.tri = malloc((2 * (size_t)n + 8) * sizeof *loose.tri), .n = 2 * n + 8, .n_live = 4};
    struct tri_inserter inserter = {.xy = mesh->xy, .tri = loose.tri, .stretch = {0, n}, .last = 0};
    assert_non_null(loose.tri);
    for (int32_t t = 0; t < loose.n; t++)
        loose.tri[t] = (struct tri_triangle){.v = {TRI_NONE}};
    tri_insert_first(mesh->xy, loose.tri, 0, (const int32_t[]){0, 1, 2});
    for (int32_t v = 3; v < n; v++, loose.n_live += 2)
        assert_int_equal(tri_insert(&inserter, v, loose.n_live), TRI_INSERTED);
    tri_inserter_free(&inserter);
    return loose;
}

/* The same triangles with other numbers, each starting at another corner. */
static void scramble(struct loose *loose, uint64_t seed)
{
    struct support_random random = {seed};
    int32_t *code = malloc((size_t)loose->n * sizeof *code); /* number of the triangle, and its first corner */
    struct tri_triangle *fresh = malloc((size_t)loose->n * sizeof *fresh);
    assert_true(code && fresh);
    for (int32_t t = 0; t < loose->n; t++)
        code[t] = tri_code(t, support_below(&random, 3));
    for (int32_t t = loose->n - 1; t > 0; t--) {
        int32_t other = support_below(&random, t + 1), swap = code[t];
        code[t] = code[other];
        code[other] = swap;
    }
    for (int32_t t = 0; t < loose->n; t++) {
        const struct tri_triangle *from = &loose->tri[t];
        struct tri_triangle *to = &fresh[tri_of(code[t])];
        *to = *from;
        for (int k = 0; from->v[0] != TRI_NONE && k < 3; k++) {
            int old = (k + tri_edge(code[t])) % 3, across = tri_edge(from->n[old]);
            int32_t beyond = code[tri_of(from->n[old])];
            to->v[k] = from->v[old];
            to->n[k] = tri_code(tri_of(beyond), (across - tri_edge(beyond) + 3) % 3);
        }
    }
    free(code);
    free(loose->tri);
    loose->tri = fresh;
}

static struct tri_mesh points_of(enum support_kind kind, int32_t n, uint64_t seed)
{
    struct tri_pslg pslg = support_points(kind, n, seed);
    struct tri_mesh mesh;
    assert_int_equal(tri_mesh_init(&mesh, NULL), TRI_OK);
    assert_int_equal(tri_mesh_take_points(&mesh, &pslg, NULL, NULL), TRI_OK);
    tri_pslg_free(&pslg);
    return mesh;
}

static struct tri_mesh sorted(int32_t n, uint64_t seed, bool scrambled, const struct tri_executor *executor)
{
    struct tri_mesh mesh = points_of(SUPPORT_RANDOM, n, seed);
    struct loose loose = insert_all(&mesh);
    if (scrambled)
        scramble(&loose, seed);
    assert_int_equal(tri_curve_sort(&mesh, loose.tri, loose.n, loose.n_live, executor, NULL), TRI_OK);
    free(loose.tri);
    return mesh;
}

static double length2(const struct tri_mesh *mesh, int32_t a, int32_t b)
{
    double x = mesh->xy[a].x - mesh->xy[b].x, y = mesh->xy[a].y - mesh->xy[b].y;
    return x * x + y * y;
}

/* The lower end of the shortest edge; of several shortest edges, the lowest. */
static int32_t naive_first(const struct tri_mesh *mesh, const int32_t v[3])
{
    double least = HUGE_VAL;
    int32_t first = TRI_NONE;
    for (int e = 0; e < 3; e++) {
        int32_t a = v[tri_next[e]], b = v[tri_prev[e]], low = a < b ? a : b;
        double l = length2(mesh, a, b);
        if (l < least || (l == least && low < first)) {
            least = l;
            first = low;
        }
    }
    return first;
}

static void test_order(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 5; seed++) {
        struct tri_mesh mesh = sorted(400, seed, true, NULL);
        assert_int_equal(tri_mesh_validate(&mesh, NULL), TRI_OK);
        assert_int_equal(mesh.n_triangles, 2 * mesh.n_vertices - 2 - mesh.n_subs);
        support_assert_cdt(&mesh, true);
        for (int32_t t = 0; t < mesh.n_triangles; t++) {
            const int32_t *v = mesh.tri[t].v, *before = t > 0 ? mesh.tri[t - 1].v : NULL;
            assert_int_equal(v[0], naive_first(&mesh, v));
            assert_true(!before || before[0] < v[0] || (before[0] == v[0] && before[1] < v[1]));
        }
        tri_mesh_free(&mesh);
    }
}

/* Counter-clockwise from the lowest vertex. */
static void test_hull(void **state)
{
    (void)state;
    struct tri_mesh mesh = sorted(300, 7, true, NULL);
    assert_true(mesh.n_subs > 5);
    for (int32_t s = 0; s < mesh.n_subs; s++) {
        const struct tri_subsegment *sub = &mesh.sub[s], *next = &mesh.sub[(s + 1) % mesh.n_subs];
        assert_true(sub->side[0] != TRI_NONE && sub->side[1] == TRI_NONE && sub->v[1] == next->v[0]);
        assert_true(mesh.sub[0].v[0] <= sub->v[0]);
        for (int32_t v = 0; v < mesh.n_vertices; v++)
            assert_true(tri_orient2d(mesh.xy[sub->v[0]], mesh.xy[sub->v[1]], mesh.xy[v]) >= 0);
    }
    tri_mesh_free(&mesh);
}

/* Numbers, first corners and the order of tasks do not influence the result, including fans so large that they are
 * sorted by another method. */
static void test_order_does_not_depend_on_numbers(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 4; seed++) {
        struct tri_mesh one = sorted(2000, seed, false, NULL), other = sorted(2000, seed, true, &support_backwards);
        support_assert_same_bytes(&one, &other);
        tri_mesh_free(&one);
        tri_mesh_free(&other);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_order),
        cmocka_unit_test(test_hull),
        cmocka_unit_test(test_order_does_not_depend_on_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
