/* Edges, neighbours, Voronoi diagram and nodes at midpoints of edges, compared with brute-force results and with their
   definitions. */
#include "triangle/mesh/topology.h"

#include "tests/support.h"

static struct tri_mesh tangled(uint64_t seed)
{
    struct tri_pslg pslg = support_tangle(SUPPORT_RANDOM, 60, 12, seed);
    struct tri_options options = tri_defaults();
    options.use_segments = true;
    struct tri_report report;
    struct tri_mesh mesh = support_generate(&pslg, &options, &report);
    tri_pslg_free(&pslg);
    return mesh;
}

/* Two triangles of the unit square, with markers 0 7 0 0 on its sides and one attribute. */
static struct tri_mesh square(void)
{
    struct tri_pslg pslg = support_pslg(4, 4, 0, 0);
    double attributes[4] = {0, 10, 30, 20}; /* 10 x + 20 y */
    int32_t markers[4] = {0, 7, 0, 0};
    support_add_point(&pslg, 0, 0);
    support_add_point(&pslg, 1, 0);
    support_add_point(&pslg, 1, 1);
    support_add_point(&pslg, 0, 1);
    for (int32_t i = 0; i < 4; i++)
        support_add_segment(&pslg, i, (i + 1) % 4);
    pslg.n_attributes = 1;
    pslg.attributes = attributes;
    pslg.segment_markers = markers;
    struct tri_options options = tri_defaults();
    options.use_segments = true;
    struct tri_report report;
    struct tri_mesh mesh = support_generate(&pslg, &options, &report);
    pslg.attributes = NULL;
    pslg.segment_markers = NULL;
    tri_pslg_free(&pslg);
    return mesh;
}

/* The triangle other than t that has both vertices, or TRI_NONE. */
static int32_t naive_neighbor(const struct tri_mesh *mesh, int32_t t, int32_t a, int32_t b)
{
    for (int32_t u = 0; u < mesh->n_triangles; u++) {
        int shared = 0;
        for (int k = 0; k < 3; k++)
            shared += mesh->tri[u].v[k] == a || mesh->tri[u].v[k] == b;
        if (u != t && shared == 2)
            return u;
    }
    return TRI_NONE;
}

static void test_neighbors(void **state)
{
    (void)state;
    struct tri_mesh mesh = tangled(1);
    int32_t inner = 0;
    assert_true(mesh.n_triangles > 100);
    for (int32_t t = 0; t < mesh.n_triangles; t++) {
        int32_t found[3];
        const int32_t *v = mesh.tri[t].v;
        tri_neighbors(&mesh, t, found);
        for (int e = 0; e < 3; e++) {
            assert_int_equal(found[e], naive_neighbor(&mesh, t, v[tri_next[e]], v[tri_prev[e]]));
            inner += found[e] != TRI_NONE && mesh.tri[t].n[e] < 0;
        }
    }
    assert_true(inner > 0); /* some neighbours lie across subsegments */
    tri_mesh_free(&mesh);
}

/* The list by its definition: for each triangle in order, the edges v0v1, v1v2, v2v0 that no earlier triangle has. */
static void test_edge_order(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed < 4; seed++) {
        struct tri_mesh mesh = tangled(seed);
        struct tri_edge_list list;
        assert_int_equal(tri_edge_list_make(&list, &mesh, true, NULL), TRI_OK);
        int32_t n = 0;
        for (int32_t t = 0; t < mesh.n_triangles; t++)
            for (int k = 0; k < 3; k++) {
                int32_t from = mesh.tri[t].v[k], to = mesh.tri[t].v[tri_next[k]], ends[2];
                int32_t other = naive_neighbor(&mesh, t, from, to), number = list.number[3 * t + tri_prev[k]];
                if (other != TRI_NONE && other < t) {
                    assert_true(number < n);
                    assert_int_equal(tri_of(list.codes[number]), other);
                    continue;
                }
                assert_int_equal(number, n);
                tri_edge_ends(&mesh, list.codes[n], ends);
                assert_int_equal(ends[0], from);
                assert_int_equal(ends[1], to);
                n++;
            }
        assert_int_equal(list.n, n);
        tri_edge_list_free(&list);
        tri_mesh_free(&mesh);
    }
}

static void test_edge_markers(void **state)
{
    (void)state;
    struct tri_mesh mesh = square();
    struct tri_edge_list list;
    assert_int_equal(tri_edge_list_make(&list, &mesh, false, NULL), TRI_OK);
    assert_null(list.number);
    int of[8] = {0};
    for (int32_t i = 0; i < list.n; i++)
        of[tri_edge_marker(&mesh, list.codes[i])]++;
    assert_int_equal(list.n, 5);
    assert_int_equal(of[0], 1);
    assert_int_equal(of[1], 3);
    assert_int_equal(of[7], 1);
    tri_edge_list_free(&list);
    tri_mesh_free(&mesh);
}

static void test_voronoi_vertices(void **state)
{
    (void)state;
    struct tri_mesh mesh = tangled(5);
    for (int32_t t = 0; t < mesh.n_triangles; t++) {
        struct tri_blend center = tri_voronoi_vertex(&mesh, t);
        double squared[3];
        for (int k = 0; k < 3; k++) {
            double at[2];
            tri_mesh_place(&mesh, mesh.tri[t].v[k], at);
            double x = at[0] - center.at[0], y = at[1] - center.at[1];
            squared[k] = x * x + y * y;
        }
        assert_true(fabs(squared[1] - squared[0]) <= 1e-6 * squared[0]);
        assert_true(fabs(squared[2] - squared[0]) <= 1e-6 * squared[0]);
    }
    tri_mesh_free(&mesh);
}

static void test_voronoi_edges(void **state)
{
    (void)state;
    struct tri_mesh mesh = tangled(6);
    struct tri_edge_list list;
    int32_t rays = 0;
    assert_int_equal(tri_edge_list_make(&list, &mesh, false, NULL), TRI_OK);
    for (int32_t i = 0; i < list.n; i++) {
        int32_t ends[2], edge[2];
        double direction[2], a[2], b[2];
        tri_voronoi_edge(&mesh, list.codes[i], ends, direction);
        tri_edge_ends(&mesh, list.codes[i], edge);
        assert_int_equal(ends[0], tri_of(list.codes[i]));
        assert_int_equal(ends[1], naive_neighbor(&mesh, ends[0], edge[0], edge[1]));
        tri_mesh_place(&mesh, edge[0], a);
        tri_mesh_place(&mesh, edge[1], b);
        bool ray = ends[1] == TRI_NONE;
        assert_true(direction[0] == (ray ? b[1] - a[1] : 0));
        assert_true(direction[1] == (ray ? a[0] - b[0] : 0));
        rays += ray;
    }
    assert_true(rays >= 3);
    tri_edge_list_free(&list);
    tri_mesh_free(&mesh);
}

/* A linear function is reproduced, inside and outside the triangle. */
static void test_blends_reproduce_linear_functions(void **state)
{
    (void)state;
    struct tri_mesh mesh = square();
    struct tri_edge_list list;
    assert_int_equal(tri_edge_list_make(&list, &mesh, true, NULL), TRI_OK);
    for (int32_t i = 0; i < list.n; i++) {
        struct tri_blend middle = tri_edge_middle(&mesh, list.codes[i]);
        assert_true(tri_blend_attribute(&mesh, &middle, 0) == 10 * middle.at[0] + 20 * middle.at[1]);
    }
    for (int32_t t = 0; t < mesh.n_triangles; t++) {
        struct tri_blend center = tri_voronoi_vertex(&mesh, t);
        assert_true(fabs(tri_blend_attribute(&mesh, &center, 0) - 15) < 1e-14);
        for (int e = 0; e < 3; e++) { /* opposite corner e */
            struct tri_blend middle = tri_edge_middle(&mesh, list.codes[list.number[3 * t + e]]);
            double a[2], b[2];
            tri_mesh_place(&mesh, mesh.tri[t].v[tri_next[e]], a);
            tri_mesh_place(&mesh, mesh.tri[t].v[tri_prev[e]], b);
            assert_true(middle.at[0] == (a[0] + b[0]) / 2 && middle.at[1] == (a[1] + b[1]) / 2);
        }
    }
    mesh.xy[0] = (struct tri_point){0.25, 0.5}; /* an obtuse triangle, whose circumcentre lies outside */
    mesh.attributes[0] = 12.5;
    for (int32_t t = 0; t < mesh.n_triangles; t++) {
        struct tri_blend center = tri_voronoi_vertex(&mesh, t);
        double expected = 10 * center.at[0] + 20 * center.at[1];
        assert_true(fabs(tri_blend_attribute(&mesh, &center, 0) - expected) < 1e-12);
    }
    tri_edge_list_free(&list);
    tri_mesh_free(&mesh);
}

static void test_only_used_vertices_are_listed(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_square(1, 6, 3);
    memcpy(&pslg.points[2 * 7], &pslg.points[2 * 5], 2 * sizeof(double)); /* vertex 7 repeats vertex 5 */
    struct tri_options options = tri_defaults();
    struct tri_report report;
    struct tri_mesh mesh = support_generate(&pslg, &options, &report);
    struct tri_used used;
    assert_int_equal(tri_used_make(&used, &mesh, NULL), TRI_OK);
    assert_int_equal(used.n, mesh.n_vertices - 1);
    for (int32_t v = 0; v < mesh.n_vertices; v++)
        assert_int_equal(used.number[v], v < 7 ? v : v == 7 ? TRI_NONE : v - 1);
    for (int32_t i = 0; i < used.n; i++)
        assert_int_equal(used.number[used.vertex[i]], i);
    tri_used_free(&used);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_neighbors),
        cmocka_unit_test(test_edge_order),
        cmocka_unit_test(test_edge_markers),
        cmocka_unit_test(test_voronoi_vertices),
        cmocka_unit_test(test_voronoi_edges),
        cmocka_unit_test(test_blends_reproduce_linear_functions),
        cmocka_unit_test(test_only_used_vertices_are_listed),
    };
    return cmocka_run_group_tests_name("topology", tests, NULL, NULL);
}
