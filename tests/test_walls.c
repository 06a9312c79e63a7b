/* Walls that refuse points without a search: a search would have found one that does. */
#include "support.h"

#include "triangle/refine/walls.h"

/* A comb: teeth over a long side, so low that points of the triangles between lie behind it, or so high that they lie
 * before it. All teeth together are nearly as wide as the side. */
static struct tri_pslg comb(int32_t teeth, double low)
{
    struct tri_pslg pslg = support_pslg(2 * teeth + 3, 2 * teeth + 3, 0, 0);
    support_add_point(&pslg, 0, 0);
    for (int32_t i = 0; i < teeth; i++) {
        support_add_point(&pslg, i + 0.1, 1);
        support_add_point(&pslg, i + 1, 0.01);
    }
    support_add_point(&pslg, teeth + 1, -low);
    support_add_point(&pslg, 0, -low);
    for (int32_t i = 0; i < pslg.n_points; i++)
        support_add_segment(&pslg, i, (i + 1) % pslg.n_points);
    return pslg;
}

/* What the head of walls.c says of a point, by a search. */
static bool is_refused(const struct tri_cavity *cavity, const struct tri_mesh *mesh, double lens_cos2, double shortest)
{
    for (int32_t i = 0; i < cavity->n_wall; i++) {
        const struct tri_cavity_edge *edge = &cavity->edge[cavity->wall[i]];
        const struct tri_relative a = edge[0].a->r, b = edge[1].a->r;
        if (tri_orient2d(cavity->p, mesh->xy[edge[0].a->v], mesh->xy[edge[1].a->v]) <= 0 ||
            (tri_is_in_lens(a, b, lens_cos2) && !tri_is_tolerated(a, b, edge->area2, shortest)))
            return true;
    }
    return false;
}

/* Points at any height over the shortest edges of all triangles; returns which share of the triangles that are searched
 * in vain need not be. */
static double compare(const struct tri_pslg *pslg, const struct tri_quality *quality, struct support_random *random)
{
    struct tri_options options = tri_defaults();
    options.use_segments = true;
    struct tri_mesh mesh = support_generate(pslg, &options, NULL);
    struct tri_criterion criterion = tri_criterion_for(&mesh, quality);
    struct tri_walls *walls = tri_walls_new(&criterion);
    struct tri_cavity cavity = {0};
    int64_t refused = 0, known = 0;
    criterion.bounds = tri_bounds_for(quality->min_angle, quality->conforming);
    assert_non_null(walls);
    for (int32_t i = 0; i < 20 * mesh.n_triangles; i++) {
        const tri_triangle_id t = i % mesh.n_triangles;
        const struct tri_shape shape = tri_shape_of(mesh.xy, mesh.tri[t].v);
        const double shortest = shape.l[shape.shortest], height = 4 * support_unit(random);
        const struct tri_point a = mesh.xy[mesh.tri[t].v[tri_next[shape.shortest]]];
        const struct tri_point b = mesh.xy[mesh.tri[t].v[tri_prev[shape.shortest]]];
        const struct tri_point p = {0.5 * (a.x + b.x) - height * (b.y - a.y), 0.5 * (a.y + b.y) + height * (b.x - a.x)};
        const tri_sub_id wall = tri_wall_before(walls, t, p, shortest);
        if (tri_cavity_search(&cavity, &mesh, p, t) != TRI_SEARCH_FOUND) {
            assert_int_equal(wall, TRI_NONE);
            continue;
        }
        const bool is_so = is_refused(&cavity, &mesh, criterion.bounds.lens_cos2, shortest);
        assert_true(wall == TRI_NONE || is_so);
        refused += is_so ? cavity.n_tri : 0;
        known += wall != TRI_NONE ? cavity.n_tri : 0;
    }
    tri_cavity_free(&cavity);
    tri_walls_free(walls);
    tri_mesh_free(&mesh);
    return refused > 0 ? (double)known / (double)refused : 1;
}

static void test_walls_of_combs(void **state)
{
    (void)state;
    struct support_random random = {3};
    struct tri_quality quality = tri_quality_defaults();
    quality.protect = 1;
    for (int k = 0; k < 6; k++) {
        struct tri_pslg pslg = comb(200, 0.5 + k);
        quality.min_angle = 20 + 3 * k;
        quality.conforming = k % 2;
        const double share = compare(&pslg, &quality, &random);
        print_message("  comb: %.4f of what is searched in vain\n", share);
        assert_true(share > 0.9);
        tri_pslg_free(&pslg);
    }
}

/* Segments that hide one another: what is known is right, whatever it is. */
static void test_walls_of_tangles(void **state)
{
    (void)state;
    struct support_random random = {5};
    struct tri_quality quality = tri_quality_defaults();
    quality.protect = 2;
    quality.min_angle = 25;
    double sum = 0;
    for (int k = 0; k < 40; k++) {
        struct tri_pslg pslg = support_tangle(SUPPORT_RANDOM, 60, 30, (uint32_t)k + 1);
        sum += compare(&pslg, &quality, &random);
        tri_pslg_free(&pslg);
    }
    print_message("  tangles: %.3f of what is searched in vain\n", sum / 40);
    assert_true(sum / 40 > 0.5);
}

/* One that may be split could come first. */
static void test_no_walls_where_some_split(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_tangle(SUPPORT_RANDOM, 60, 30, 1);
    struct tri_options options = tri_defaults();
    options.use_segments = true;
    options.quality.protect = 1;
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    const struct tri_criterion criterion = tri_criterion_for(&mesh, &options.quality);
    assert_null(tri_walls_new(&criterion));
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_walls_of_combs),
        cmocka_unit_test(test_walls_of_tangles),
        cmocka_unit_test(test_no_walls_where_some_split),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
