/* A mesh handed out item by item, compared with the mesh itself. */
#include "support.h"
#include "triangle/mesh/grid.h"
#include "triangle/mesh/topology.h"

/* A refined square with attributes and one corner cut off. Vertex 4, which is outside, is no corner of a triangle. */
static struct tri_mesh cut_square(struct tri_pslg *pslg)
{
    *pslg = support_pslg(5, 4, 0, 0);
    static const double at[5][2] = {{0.1, 0}, {1, 0}, {1, 0.7}, {0, 0.3}, {3, 3}};
    for (int i = 0; i < 5; i++)
        support_add_point(pslg, at[i][0], at[i][1]);
    for (int32_t i = 0; i < 4; i++)
        support_add_segment(pslg, i, (i + 1) % 4);
    support_add_attributes(pslg);
    struct tri_options options = support_quality(25, 0.01);
    struct tri_mesh mesh = support_generate(pslg, &options, NULL);
    assert_true(mesh.n_triangles > 50 && mesh.n_vertices > 30);
    return mesh;
}

static struct tri_grid grid_of(const struct tri_mesh *mesh, const struct tri_pslg *pslg, struct tri_grid_options with)
{
    struct tri_grid grid;
    with.mesh = mesh;
    with.pslg = pslg;
    assert_int_equal(tri_grid_make(&grid, &with, NULL), TRI_OK);
    return grid;
}

static void test_points(void **state)
{
    (void)state;
    struct tri_pslg pslg;
    struct tri_mesh mesh = cut_square(&pslg);
    struct tri_grid grid = grid_of(&mesh, &pslg, (struct tri_grid_options){.markers = true, .base = 1});
    assert_true(grid.n_points == mesh.n_vertices && grid.base == 1 && grid.has_markers && grid.n_attributes == 2);
    for (int32_t v = 0; v < mesh.n_vertices; v++) {
        struct tri_grid_point point;
        double at[2];
        grid.point(grid.user, v, &point);
        tri_mesh_place(&mesh, v, at);
        assert_true(point.at[0] == at[0] && point.at[1] == at[1]);
        assert_int_equal(point.marker, mesh.vertex_markers[v]);
        for (int k = 0; k < 2; k++)
            assert_true(grid.attribute(grid.user, v, k) == mesh.attributes[2 * v + k]);
    }
    tri_grid_free(&grid);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* If vertices are left out, all numbers in a triangle still refer to the same points. */
static void test_vertices_left_out(void **state)
{
    (void)state;
    struct tri_pslg pslg;
    struct tri_mesh mesh = cut_square(&pslg);
    struct tri_grid grid = grid_of(&mesh, &pslg, (struct tri_grid_options){.jettison = true, .edges = true});
    assert_int_equal(grid.n_points, mesh.n_vertices - 1);
    assert_int_equal(grid.n_triangles, mesh.n_triangles);
    for (int32_t t = 0; t < mesh.n_triangles; t++) {
        int64_t nodes[6], beside[3];
        int32_t naive[3];
        grid.triangle(grid.user, t, nodes);
        for (int k = 0; k < 3; k++) {
            int32_t v = mesh.tri[t].v[k];
            assert_int_equal(nodes[k], v < 4 ? v : v - 1);
        }
        grid.neighbors(grid.user, t, beside);
        tri_neighbors(&mesh, t, naive);
        for (int k = 0; k < 3; k++)
            assert_int_equal(beside[k], naive[k] == TRI_NONE ? -1 : naive[k]);
    }
    for (int64_t i = 0; i < grid.n_edges; i++) {
        struct tri_grid_edge edge;
        grid.edge(grid.user, i, &edge);
        assert_true(0 <= edge.ends[0] && edge.ends[0] < grid.n_points && edge.ends[0] != edge.ends[1]);
        assert_true(0 <= edge.ends[1] && edge.ends[1] < grid.n_points);
    }
    tri_grid_free(&grid);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* First the segments of the mesh, then those of the input that are reported as not being edges. */
static void test_segments(void **state)
{
    (void)state;
    struct tri_pslg pslg;
    struct tri_mesh mesh = cut_square(&pslg);
    const bool is_edge[4] = {true, false, true, true};
    struct tri_grid grid = grid_of(&mesh, &pslg, (struct tri_grid_options){.is_edge = is_edge});
    assert_int_equal(grid.n_segments, mesh.n_subs + 1);
    for (int64_t i = 0; i < grid.n_segments; i++) {
        struct tri_grid_edge segment;
        const int32_t *ends = i < mesh.n_subs ? mesh.sub[i].v : &pslg.segments[2];
        grid.segment(grid.user, i, &segment);
        assert_true(segment.ends[0] == ends[0] && segment.ends[1] == ends[1]);
        assert_int_equal(segment.marker, i < mesh.n_subs ? mesh.sub[i].marker : 0);
    }
    tri_grid_free(&grid);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* The nodes after the corners of a triangle are the midpoints of the opposite edges, and have interpolated
 * attributes. */
static void test_second_order(void **state)
{
    (void)state;
    struct tri_pslg pslg;
    struct tri_mesh mesh = cut_square(&pslg);
    struct tri_grid grid = grid_of(&mesh, &pslg, (struct tri_grid_options){.jettison = true, .second_order = true});
    assert_int_equal(grid.n_nodes, 6);
    assert_int_equal(grid.n_points, mesh.n_vertices - 1 + grid.n_edges);
    for (int32_t t = 0; t < mesh.n_triangles; t++) {
        int64_t nodes[6];
        struct tri_grid_point point[6];
        grid.triangle(grid.user, t, nodes);
        for (int k = 0; k < 6; k++)
            grid.point(grid.user, nodes[k], &point[k]);
        for (int k = 0; k < 3; k++) {
            const struct tri_grid_point *a = &point[tri_next[k]], *b = &point[tri_prev[k]], *middle = &point[3 + k];
            for (int c = 0; c < 2; c++) {
                assert_true(fabs(middle->at[c] - (a->at[c] + b->at[c]) / 2) < 1e-15);
                double mean = (grid.attribute(grid.user, nodes[tri_next[k]], c) +
                               grid.attribute(grid.user, nodes[tri_prev[k]], c)) / 2;
                assert_true(fabs(grid.attribute(grid.user, nodes[3 + k], c) - mean) < 1e-12);
            }
        }
    }
    tri_grid_free(&grid);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* Voronoi vertices have the same distance from all corners of their triangles. Their edges lead to the vertices of
 * neighbouring triangles. */
static void test_voronoi(void **state)
{
    (void)state;
    struct tri_pslg pslg;
    struct tri_mesh mesh = cut_square(&pslg);
    struct tri_grid grid = grid_of(&mesh, &pslg, (struct tri_grid_options){.edges = true});
    struct tri_grid dual = tri_grid_voronoi(&grid);
    assert_true(dual.n_points == grid.n_triangles && dual.n_edges == grid.n_edges && !dual.has_markers);
    for (int64_t t = 0; t < dual.n_points; t++) {
        struct tri_grid_point centre, corner;
        int64_t nodes[6];
        double distance[3];
        dual.point(dual.user, t, &centre);
        grid.triangle(grid.user, t, nodes);
        for (int k = 0; k < 3; k++) {
            grid.point(grid.user, nodes[k], &corner);
            distance[k] = hypot(corner.at[0] - centre.at[0], corner.at[1] - centre.at[1]);
        }
        assert_true(fabs(distance[0] - distance[1]) < 1e-12 && fabs(distance[0] - distance[2]) < 1e-12);
    }
    int64_t rays = 0;
    for (int64_t i = 0; i < dual.n_edges; i++) {
        struct tri_grid_edge edge;
        dual.edge(dual.user, i, &edge);
        assert_true(edge.ends[0] >= 0 && edge.ends[0] < dual.n_points && edge.ends[1] < dual.n_points);
        assert_int_equal(edge.ends[1] < 0, edge.direction[0] != 0 || edge.direction[1] != 0);
        rays += edge.ends[1] < 0;
    }
    assert_int_equal(rays, 2 * grid.n_edges - 3 * grid.n_triangles);
    tri_grid_free(&grid);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_points),
        cmocka_unit_test(test_vertices_left_out),
        cmocka_unit_test(test_segments),
        cmocka_unit_test(test_second_order),
        cmocka_unit_test(test_voronoi),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
