/* Subsegments behind a flat triangle, against a search through all of them; fences and parts; and a mesh that had
 * edges of 1e-5 where nothing is as small. */
#include "support.h"

#include "triangle/hidden_wall.h"
#include "triangle/quality.h"

static const double ANGLE = 20, SINE = 0.34202014332566873;

static const struct tri_refine_options free_sides = {0};

static double lens(void) { return tri_bounds_for(ANGLE, false).lens_cos2; }

/* A square with points close to its sides and to two segments inside. */
static struct tri_mesh flat_triangles(uint64_t seed)
{
    struct support_random random = {seed};
    struct tri_pslg pslg = support_pslg(60, 6, 0, 0);
    static const double end[8][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.2, 0.3}, {0.7, 0.4}, {0.3, 0.8}, {0.8, 0.7}};
    for (int i = 0; i < 8; i++)
        support_add_point(&pslg, end[i][0], end[i][1]);
    for (int32_t i = 0; i < 4; i++)
        support_add_segment(&pslg, i, (i + 1) % 4);
    support_add_segment(&pslg, 4, 5);
    support_add_segment(&pslg, 6, 7);
    for (int i = 0; i < 12; i++) {
        const int32_t *s = pslg.segments + 2 * support_below(&random, 6);
        double f = support_unit(&random), height = 1e-2;
        for (int32_t k = support_below(&random, 6); k > 0; k--)
            height /= 10;
        double ax = end[s[0]][0], ay = end[s[0]][1], x = end[s[1]][0] - ax, y = end[s[1]][1] - ay;
        support_add_point(&pslg, ax + f * x - height * y, ay + f * y + height * x);
    }
    for (int i = 0; i < 10; i++)
        support_add_point(&pslg, support_unit(&random), support_unit(&random));
    struct tri_options options = tri_defaults();
    options.use_segments = true;
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    tri_pslg_free(&pslg);
    return mesh;
}

static double distance(struct tri_point p, struct tri_point q) { return hypot(p.x - q.x, p.y - q.y); }

static bool is_seen_wide(const struct tri_mesh *mesh, int32_t s, struct tri_point p)
{
    struct tri_relative a = tri_relative(&mesh->xy[mesh->sub[s].v[0]], p);
    struct tri_relative b = tri_relative(&mesh->xy[mesh->sub[s].v[1]], p);
    double dot = a.x * b.x + a.y * b.y;
    return dot < 0 && dot * dot > lens() * a.l * b.l;
}

static bool is_wall(const struct tri_cavity *cavity, int32_t s)
{
    for (int32_t w = 0; w < cavity->n_wall; w++)
        if (~cavity->edge[cavity->wall[w]].outer == s)
            return true;
    return false;
}

/* Is s as near to p, against the vertices, as the theorem has it, and is there no other subsegment between? */
static bool is_near(const struct tri_mesh *mesh, int32_t s, struct tri_point p)
{
    struct tri_point a = mesh->xy[mesh->sub[s].v[0]], b = mesh->xy[mesh->sub[s].v[1]];
    double x = b.x - a.x, y = b.y - a.y, f = ((p.x - a.x) * x + (p.y - a.y) * y) / (x * x + y * y), clear = HUGE_VAL;
    struct tri_point foot = tri_point_between(a, b, f);
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        clear = fmin(clear, distance(mesh->xy[v], p));
    return distance(p, foot) < 0.999 * clear * SINE && !support_is_hidden(mesh, p, foot, s);
}

/* The circumcentre of a triangle that would be inserted: its cavity is found, and no wall of that is in its way. */
static bool has_free_point(struct tri_cavity *cavity, const struct tri_mesh *mesh, int32_t t)
{
    struct tri_shape shape = tri_shape_of(mesh->xy, mesh->tri[t].v);
    struct tri_point p = tri_place(mesh->xy, mesh->tri[t].v, &shape, HUGE_VAL);
    if (!(fabs(p.x) < 2 && fabs(p.y) < 2) || tri_cavity_search(cavity, mesh, p, t) != TRI_SEARCH_FOUND)
        return false;
    for (int32_t w = 0; w < cavity->n_wall; w++) {
        const struct tri_cavity_edge *edge = &cavity->edge[cavity->wall[w]];
        if (is_seen_wide(mesh, ~edge->outer, p) || edge->area2 <= 0)
            return false;
    }
    return true;
}

static void test_finds_what_is_near(void **state)
{
    (void)state;
    struct tri_cavity cavity = {0};
    int near = 0, none = 0;
    for (uint64_t seed = 0; seed < 400; seed++) {
        struct tri_mesh mesh = flat_triangles(seed);
        for (int32_t t = 0; t < mesh.n_triangles; t++) {
            int32_t found;
            bool is_there = false;
            if (!has_free_point(&cavity, &mesh, t))
                continue;
            assert_int_equal(tri_find_hidden_wall(&cavity, &mesh, &free_sides, lens(), &found), TRI_SEARCH_FOUND);
            assert_true(found == TRI_NONE || (is_seen_wide(&mesh, found, cavity.p) && !is_wall(&cavity, found)));
            for (int32_t s = 0; s < mesh.n_subs; s++)
                is_there |= is_seen_wide(&mesh, s, cavity.p) && is_near(&mesh, s, cavity.p);
            assert_true(!is_there || found != TRI_NONE);
            near += is_there;
            none += found == TRI_NONE;
        }
        tri_mesh_free(&mesh);
    }
    assert_true(near > 100 && none > 1000);
    tri_cavity_free(&cavity);
}

/* A vertex 1e-6 above the middle of a long side hides it from the circumcentre of a triangle whose angle is nearly a
 * right one. */
static struct tri_mesh half_hidden(struct tri_pslg *pslg)
{
    static const double xy[5][2] = {{0, 0}, {8, 0}, {6, 2}, {2, 2.0001}, {4, 1e-6}};
    *pslg = support_pslg(5, 4, 0, 0);
    for (int32_t i = 0; i < 5; i++)
        support_add_point(pslg, xy[i][0], xy[i][1]);
    for (int32_t i = 0; i < 4; i++)
        support_add_segment(pslg, i, (i + 1) % 4);
    struct tri_options options = tri_defaults();
    options.use_segments = true;
    return support_generate(pslg, &options, NULL);
}

/* The triangle with all vertices left of this. */
static int32_t triangle_left_of(const struct tri_mesh *mesh, double x)
{
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        const int32_t *v = mesh->tri[t].v;
        if (mesh->xy[v[0]].x < x && mesh->xy[v[1]].x < x && mesh->xy[v[2]].x < x)
            return t;
    }
    fail_msg("no triangle left of %g", x);
    return TRI_NONE;
}

static void test_fence_and_part(void **state)
{
    (void)state;
    struct tri_pslg pslg;
    struct tri_mesh mesh = half_hidden(&pslg);
    struct tri_cavity cavity = {0};
    const struct tri_fence left = {-1, -1, 5, 3}, all = {-1, -1, 9, 3};
    int32_t s, t = triangle_left_of(&mesh, 5 / mesh.unit);
    struct tri_fence fence = {left.x_min / mesh.unit, left.y_min / mesh.unit, left.x_max / mesh.unit,
                              left.y_max / mesh.unit};
    cavity.fence = &fence;
    assert_true(has_free_point(&cavity, &mesh, t));
    assert_int_equal(tri_find_hidden_wall(&cavity, &mesh, &free_sides, lens(), &s), TRI_SEARCH_FENCED);
    fence.x_max = all.x_max / mesh.unit;
    assert_true(has_free_point(&cavity, &mesh, t));
    assert_int_equal(tri_find_hidden_wall(&cavity, &mesh, &free_sides, lens(), &s), TRI_SEARCH_FOUND);
    assert_true(s >= 0);
    const struct tri_subsegment side = mesh.sub[s];
    assert_true(fabs(mesh.xy[side.v[0]].x - mesh.xy[side.v[1]].x) * mesh.unit == 8);
    tri_link *link = &mesh.tri[tri_of(side.side[side.side[0] == TRI_NONE])]
                          .n[tri_edge(side.side[side.side[0] == TRI_NONE])];
    assert_int_equal(*link, ~s);
    *link = TRI_BEYOND; /* as if a triangle beyond it were not here */
    assert_int_equal(tri_find_hidden_wall(&cavity, &mesh, &free_sides, lens(), &s), TRI_SEARCH_BEYOND);
    assert_true((cavity.beyond[0] == side.v[0] && cavity.beyond[1] == side.v[1]) ||
                (cavity.beyond[0] == side.v[1] && cavity.beyond[1] == side.v[0]));
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
    tri_cavity_free(&cavity);
}

/* Sizes are refined within a fence that the long side crosses. */
static void test_keeps_away_from_hidden_side(void **state)
{
    (void)state;
    struct tri_pslg pslg;
    struct tri_mesh mesh = half_hidden(&pslg);
    struct tri_refine_options quality = tri_refine_defaults();
    struct tri_refine_report report;
    struct tri_fence fence = {-1 / mesh.unit, -1 / mesh.unit, 5 / mesh.unit, 3 / mesh.unit};
    int32_t n = mesh.n_vertices;
    quality.min_angle = ANGLE;
    quality.max_area = 0.1;
    quality.fence = &fence;
    assert_int_equal(tri_refine(&mesh, &quality, &report, NULL), TRI_OK);
    assert_true(report.fenced > 0);
    for (int32_t v = n; v < mesh.n_vertices; v++)
        assert_true(mesh.xy[v].y * mesh.unit > 0.01);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_finds_what_is_near),
        cmocka_unit_test(test_fence_and_part),
        cmocka_unit_test(test_keeps_away_from_hidden_side),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
