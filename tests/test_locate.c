/* Faces of points, compared with a naive twin: all triangles that contain a point, and a flood from them. */
#include "support.h"
#include "triangle/mesh/locate.h"

static int32_t face_of(int32_t *root, int32_t t)
{
    while (root[t] != t)
        t = root[t] = root[root[t]];
    return t;
}

/* face[t]: one triangle that represents all triangles reachable from t without crossing a subsegment. */
static int32_t *faces_of(const struct tri_mesh *mesh)
{
    int32_t *root = malloc(((size_t)mesh->n_triangles + 1) * sizeof *root);
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        root[t] = t;
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        for (int e = 0; e < 3; e++)
            if (mesh->tri[t].n[e] >= 0)
                root[face_of(root, t)] = face_of(root, tri_of(mesh->tri[t].n[e]));
    return root;
}

/* Returns true if the closed triangle contains q. */
static bool holds(const struct tri_mesh *mesh, int32_t t, struct tri_point q)
{
    const int32_t *v = mesh->tri[t].v;
    struct tri_point a = mesh->xy[v[0]], b = mesh->xy[v[1]], c = mesh->xy[v[2]];
    return tri_orient2d(a, b, q) >= 0 && tri_orient2d(b, c, q) >= 0 && tri_orient2d(c, a, q) >= 0;
}

static void assert_faces(const struct tri_mesh *mesh, const struct tri_point *points, int32_t n)
{
    struct tri_error error = {0};
    int32_t *root = faces_of(mesh), *faces = malloc((size_t)n * sizeof *faces);
    assert_int_equal(tri_locate_faces(mesh, points, n, faces, &error), TRI_OK);
    for (int32_t i = 0; i < n; i++) {
        bool inside = false, found = false;
        for (int32_t t = 0; t < mesh->n_triangles; t++)
            if (tri_is_in_range(points[i]) && holds(mesh, t, points[i])) {
                inside = true;
                found = found || (faces[i] != TRI_NONE && face_of(root, t) == face_of(root, faces[i]));
            }
        assert_true(inside ? found : faces[i] == TRI_NONE);
    }
    free(root);
    free(faces);
}

/* Random points everywhere: in the figure, on vertices, on segments, outside, and out of range. */
static void fill(const struct tri_mesh *mesh, struct tri_point *points, int32_t n, uint64_t seed)
{
    struct support_random random = {seed};
    struct tri_point low = mesh->xy[0], high = low;
    for (int32_t v = 1; v < mesh->n_vertices; v++) {
        low = (struct tri_point){fmin(low.x, mesh->xy[v].x), fmin(low.y, mesh->xy[v].y)};
        high = (struct tri_point){fmax(high.x, mesh->xy[v].x), fmax(high.y, mesh->xy[v].y)};
    }
    for (int32_t i = 0; i < n; i++) {
        struct tri_point u = mesh->xy[support_below(&random, mesh->n_vertices)];
        double x = 1.2 * support_unit(&random) - 0.1, y = 1.2 * support_unit(&random) - 0.1;
        points[i] = (struct tri_point){low.x + x * (high.x - low.x), low.y + y * (high.y - low.y)};
        if (i % 7 == 0)
            points[i] = u;
        if (i % 11 == 0)
            points[i].x = u.x;
        if (i % 97 == 0)
            points[i].y = 1e250;
    }
}

static void test_tangles(void **state)
{
    (void)state;
    struct tri_point points[1000];
    for (int kind = 0; kind < SUPPORT_KINDS; kind++)
        for (uint64_t seed = 0; seed < 20; seed++) {
            struct tri_constrain_report report;
            struct tri_pslg pslg = support_tangle((enum support_kind)kind, 30, 15, seed);
            struct tri_mesh mesh = support_constrained(&pslg, &report);
            int32_t n = seed % 2 ? 1000 : 5; /* with many points the sweep is used */
            fill(&mesh, points, n, seed);
            assert_faces(&mesh, points, n);
            tri_mesh_free(&mesh);
            tri_pslg_free(&pslg);
        }
}

/* k high and narrow rooms side by side, optionally turned by a quarter. There is a point in each, in any order. */
static void test_narrow_rooms(void **state)
{
    (void)state;
    enum { K = 300 };
    for (int turned = 0; turned < 2; turned++) {
        struct support_random random = {7};
        struct tri_constrain_report report;
        struct tri_pslg pslg = support_pslg(2 * K, K, 0, 0);
        struct tri_point points[K - 1];
        for (int32_t i = 0; i < 2 * K; i++) {
            double x = i / 2, y = i % 2 * K;
            support_add_point(&pslg, turned ? y : x, turned ? -x : y);
        }
        for (int32_t i = 0; i < K; i++)
            support_add_segment(&pslg, 2 * i, 2 * i + 1);
        for (int32_t i = 0; i < K - 1; i++) {
            double x = (i * 77) % (K - 1) + 0.5, y = K * support_unit(&random);
            points[i] = (struct tri_point){turned ? y : x, turned ? -x : y};
        }
        struct tri_mesh mesh = support_constrained(&pslg, &report);
        assert_faces(&mesh, points, K - 1);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tangles),
        cmocka_unit_test(test_narrow_rooms),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
