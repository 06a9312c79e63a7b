/* Cavities against a brute-force flood, and the two theorems of the header against naive geometry. */
#include "support.h"
#include "triangle/mesh/cavity.h"

static struct tri_mesh tangle(uint64_t seed)
{
    static const enum support_kind kinds[] = {SUPPORT_RANDOM, SUPPORT_LATTICE, SUPPORT_RING, SUPPORT_CLUSTER};
    struct tri_pslg pslg = support_tangle(kinds[seed % 4], 40, (int32_t)(seed % 10), seed);
    struct tri_options options = tri_defaults();
    options.use_segments = options.ignore_holes = true;
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    tri_pslg_free(&pslg);
    return mesh;
}

static bool in_disk(const struct tri_mesh *mesh, int32_t t, struct tri_point p)
{
    const int32_t *v = mesh->tri[t].v;
    return tri_in_circle(mesh->xy[v[0]], mesh->xy[v[1]], mesh->xy[v[2]], p);
}

static bool contains(const struct tri_mesh *mesh, int32_t t, struct tri_point p)
{
    const int32_t *v = mesh->tri[t].v;
    struct tri_point a = mesh->xy[v[0]], b = mesh->xy[v[1]], c = mesh->xy[v[2]];
    return tri_orient2d(a, b, p) >= 0 && tri_orient2d(b, c, p) >= 0 && tri_orient2d(c, a, p) >= 0;
}

static bool is_vertex(const struct tri_mesh *mesh, struct tri_point p)
{
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        if (mesh->xy[v].x == p.x && mesh->xy[v].y == p.y)
            return true;
    return false;
}

/* Adds triangles that share an edge without subsegment with the cavity and have p in their circumdisk, until nothing
 * changes. */
static int32_t naive_cavity(const struct tri_mesh *mesh, struct tri_point p, int32_t start, bool *in)
{
    int32_t n = 1;
    memset(in, 0, (size_t)mesh->n_triangles);
    in[start] = true;
    for (bool changed = true; changed;) {
        changed = false;
        for (int32_t t = 0; t < mesh->n_triangles; t++)
            for (int e = 0; e < 3; e++) {
                int32_t link = mesh->tri[t].n[e];
                if (!in[t] && link >= 0 && in[tri_of(link)] && in_disk(mesh, t, p)) {
                    in[t] = changed = true;
                    n++;
                }
            }
    }
    return n;
}

static void assert_same_set(const struct tri_cavity *cavity, const bool *in, int32_t n)
{
    assert_int_equal(cavity->n_tri, n);
    for (int32_t i = 0; i < n; i++) {
        assert_true(in[cavity->tri[i]]);
        for (int32_t k = 0; k < i; k++)
            assert_true(cavity->tri[i] != cavity->tri[k]);
    }
}

/* Checks that the boundary is closed, counter-clockwise as seen from p (except subsegments with p beyond them), and has
 * walls exactly at subsegments. */
static bool check_edges_seen(const struct tri_cavity *cavity, const struct tri_mesh *mesh)
{
    int32_t walls = 0;
    bool beyond = false;
    assert_int_equal(cavity->n_edges, cavity->n_tri + 2);
    assert_int_equal(cavity->edge[cavity->n_edges].a->v, cavity->edge[0].a->v);
    for (int32_t i = 0; i < cavity->n_edges; i++) {
        const struct tri_cavity_edge *edge = &cavity->edge[i];
        int32_t a = edge->a->v, b = edge[1].a->v;
        assert_true(edge->area2 == tri_cross(edge[0].a->r, edge[1].a->r));
        bool seen = tri_orient2d(cavity->p, mesh->xy[a], mesh->xy[b]) > 0;
        if (edge->outer < 0) {
            const struct tri_subsegment *s = &mesh->sub[~edge->outer];
            assert_true((s->v[0] == a && s->v[1] == b) || (s->v[0] == b && s->v[1] == a));
            assert_int_equal(cavity->wall[walls++], i);
            beyond |= !seen;
        } else {
            const struct tri_triangle *t = &mesh->tri[tri_of(edge->outer)];
            assert_int_equal(t->v[tri_next[tri_edge(edge->outer)]], b);
            assert_int_equal(t->v[tri_prev[tri_edge(edge->outer)]], a);
        }
    }
    assert_int_equal(walls, cavity->n_wall);
    return !beyond;
}

static void insert(struct tri_cavity *cavity, struct tri_mesh *mesh)
{
    struct tri_error error = {0};
    int32_t n = mesh->n_triangles;
    assert_int_equal(tri_mesh_reserve_vertices(mesh, 1, &error), TRI_OK);
    assert_int_equal(tri_mesh_reserve_triangles(mesh, 2, &error), TRI_OK);
    int32_t v = mesh->n_vertices++;
    mesh->xy[v] = cavity->p;
    mesh->on[v] = TRI_VERTEX_FREE;
    mesh->vertex_markers[v] = 0;
    tri_cavity_fill(cavity, mesh, v);
    if (tri_mesh_validate(mesh, &error) != TRI_OK)
        fail_msg("%s", error.text);
    assert_int_equal(mesh->n_triangles, n + 2);
    for (int32_t i = 0; i < cavity->n_edges; i++) {
        const struct tri_triangle *t = &mesh->tri[cavity->tri[i]];
        assert_true(t->v[0] == v && t->v[1] == cavity->edge[i].a->v);
        assert_true(t->region == cavity->edge[i].region);
    }
}

static void test_search_equals_flood_and_fill_is_delaunay(void **state)
{
    (void)state;
    struct tri_cavity cavity = {0};
    int inserted = 0;
    for (uint64_t seed = 0; seed < 60; seed++) {
        struct tri_mesh mesh = tangle(seed);
        struct support_random random = {seed};
        bool *in = calloc((size_t)mesh.n_triangles + 300, sizeof *in);
        for (int i = 0; i < 100; i++) {
            int32_t t = support_below(&random, mesh.n_triangles);
            const int32_t *v = mesh.tri[t].v;
            double f = support_unit(&random), g = 2 * support_unit(&random) - 0.5;
            struct tri_point p =
                tri_point_between(tri_point_between(mesh.xy[v[0]], mesh.xy[v[1]], f), mesh.xy[v[2]], g);
            enum tri_search found = tri_cavity_search(&cavity, &mesh, p, t);
            assert_int_equal(found,
                             in_disk(&mesh, t, p) && !is_vertex(&mesh, p) ? TRI_SEARCH_FOUND : TRI_SEARCH_OUTSIDE);
            if (found != TRI_SEARCH_FOUND)
                continue;
            assert_same_set(&cavity, in, naive_cavity(&mesh, p, t, in));
            if (!check_edges_seen(&cavity, &mesh) || mesh.n_vertices > 140)
                continue;
            insert(&cavity, &mesh);
            inserted++;
            if (i % 25 == 0)
                support_assert_cdt(&mesh, true);
        }
        support_assert_cdt(&mesh, false);
        free(in);
        tri_mesh_free(&mesh);
    }
    assert_true(inserted > 2000);
    tri_cavity_free(&cavity);
}

static bool in_diametral_disk(struct tri_point p, struct tri_point a, struct tri_point b)
{
    return (a.x - p.x) * (b.x - p.x) + (a.y - p.y) * (b.y - p.y) < 0;
}

/* Returns true if p encroaches s and sees it, while the apex on that side is outside the diametral disk. */
static bool is_encroached_in_sight(const struct tri_mesh *mesh, int32_t s, struct tri_point p)
{
    const struct tri_subsegment *sub = &mesh->sub[s];
    struct tri_point a = mesh->xy[sub->v[0]], b = mesh->xy[sub->v[1]];
    double side = tri_orient2d(a, b, p);
    int32_t code = sub->side[side > 0 ? 0 : 1];
    if (side == 0 || code == TRI_NONE || !in_diametral_disk(p, a, b))
        return false;
    struct tri_point apex = mesh->xy[mesh->tri[tri_of(code)].v[tri_edge(code)]];
    if (in_diametral_disk(apex, a, b))
        return false;
    for (int k = 1; k < 8; k++)
        if (!support_is_hidden(mesh, p, tri_point_between(a, b, k / 8.0), s))
            return true;
    return false;
}

static void test_encroached_subsegments_are_walls(void **state)
{
    (void)state;
    struct tri_cavity cavity = {0};
    int encroached = 0;
    for (uint64_t seed = 0; seed < 80; seed++) {
        struct tri_mesh mesh = tangle(seed);
        struct support_random random = {seed};
        for (int i = 0; i < 60; i++) {
            int32_t t = support_below(&random, mesh.n_triangles);
            const int32_t *v = mesh.tri[t].v;
            double f = support_unit(&random), g = support_unit(&random);
            struct tri_point p =
                tri_point_between(tri_point_between(mesh.xy[v[0]], mesh.xy[v[1]], f), mesh.xy[v[2]], g);
            if (!contains(&mesh, t, p) || tri_cavity_search(&cavity, &mesh, p, t) != TRI_SEARCH_FOUND)
                continue;
            for (int32_t s = 0; s < mesh.n_subs; s++) {
                if (!is_encroached_in_sight(&mesh, s, p))
                    continue;
                bool is_wall = false;
                for (int32_t w = 0; w < cavity.n_wall; w++)
                    is_wall |= ~cavity.edge[cavity.wall[w]].outer == s;
                assert_true(is_wall);
                encroached++;
            }
        }
        tri_mesh_free(&mesh);
    }
    assert_true(encroached > 200);
    tri_cavity_free(&cavity);
}

static void test_split_keeps_links_markers_and_parents(void **state)
{
    (void)state;
    struct tri_cavity cavity = {0};
    int splits = 0;
    for (uint64_t seed = 0; seed < 60; seed++) {
        struct tri_mesh mesh = tangle(seed);
        struct tri_error error = {0};
        struct support_random random = {seed};
        for (int i = 0; i < 25; i++) {
            int32_t s = support_below(&random, mesh.n_subs), n_left, n = mesh.n_subs;
            struct tri_subsegment old = mesh.sub[s];
            struct tri_point p =
                tri_point_between(mesh.xy[old.v[0]], mesh.xy[old.v[1]], 0.25 * (1 + support_below(&random, 3)));
            if (tri_cavity_search_split(&cavity, &mesh, p, s, &n_left) != TRI_SEARCH_FOUND)
                continue;
            assert_int_equal(n_left > 0, old.side[0] != TRI_NONE);
            assert_int_equal(n_left < cavity.n_edges, old.side[1] != TRI_NONE);
            assert_int_equal(tri_mesh_reserve_vertices(&mesh, 1, &error), TRI_OK);
            assert_int_equal(tri_mesh_reserve_triangles(&mesh, 2, &error), TRI_OK);
            assert_int_equal(tri_mesh_reserve_subs(&mesh, 1, &error), TRI_OK);
            int32_t v = mesh.n_vertices++;
            mesh.xy[v] = p;
            mesh.on[v] = old.parent;
            int32_t second = tri_cavity_fill_split(&cavity, &mesh, v, s, n_left);
            if (tri_mesh_validate(&mesh, &error) != TRI_OK)
                fail_msg("%s", error.text);
            assert_int_equal(mesh.n_subs, n + 1);
            assert_true(mesh.sub[s].v[0] == old.v[0] && mesh.sub[s].v[1] == v && mesh.sub[s].parent == old.parent);
            assert_true(mesh.sub[second].v[0] == v && mesh.sub[second].v[1] == old.v[1]);
            assert_true(mesh.sub[second].marker == old.marker && mesh.sub[second].parent == old.parent);
            splits++;
        }
        for (int32_t t = 0; t < mesh.n_triangles; t++) {
            const int32_t *v = mesh.tri[t].v;
            assert_true(tri_orient2d(mesh.xy[v[0]], mesh.xy[v[1]], mesh.xy[v[2]]) > 0);
        }
        tri_mesh_free(&mesh);
    }
    assert_true(splits > 1000);
    tri_cavity_free(&cavity);
}

/* If halving does not round, a split mesh is exactly constrained Delaunay. */
static void test_split_is_delaunay_without_rounding(void **state)
{
    (void)state;
    struct tri_cavity cavity = {0};
    for (uint64_t seed = 1; seed < 40; seed += 4) { /* the seeds of lattices */
        struct tri_mesh mesh = tangle(seed);
        for (int32_t s = 0, end = mesh.n_subs; s < end; s++) {
            int32_t n_left;
            struct tri_point a = mesh.xy[mesh.sub[s].v[0]], b = mesh.xy[mesh.sub[s].v[1]];
            struct tri_point p = tri_point_between(a, b, 0.5);
            if (tri_orient2d(a, b, p) != 0)
                continue; /* one of its ends is a crossing with rounded coordinates */
            assert_int_equal(tri_cavity_search_split(&cavity, &mesh, p, s, &n_left), TRI_SEARCH_FOUND);
            assert_int_equal(tri_mesh_reserve_vertices(&mesh, 1, NULL), TRI_OK);
            assert_int_equal(tri_mesh_reserve_triangles(&mesh, 2, NULL), TRI_OK);
            assert_int_equal(tri_mesh_reserve_subs(&mesh, 1, NULL), TRI_OK);
            mesh.xy[mesh.n_vertices] = p;
            mesh.on[mesh.n_vertices] = mesh.sub[s].parent;
            tri_cavity_fill_split(&cavity, &mesh, mesh.n_vertices++, s, n_left);
            support_assert_cdt(&mesh, false);
        }
        support_assert_cdt(&mesh, true);
        tri_mesh_free(&mesh);
    }
    tri_cavity_free(&cavity);
}

static bool owned(const struct tri_mesh *mesh, const struct tri_fence *f, int32_t t)
{
    for (int k = 0; k < 3; k++) {
        struct tri_point q = mesh->xy[mesh->tri[t].v[k]];
        if (q.x < f->x_min || q.x >= f->x_max || q.y < f->y_min || q.y >= f->y_max)
            return false;
    }
    return true;
}

static void test_fence_stops_exactly_searches_that_leave_it(void **state)
{
    (void)state;
    struct tri_cavity cavity = {0};
    int counts[2] = {0};
    struct tri_pslg pslg = support_square(8, 300, 3);
    struct tri_options options = tri_defaults();
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    bool *in = calloc((size_t)mesh.n_triangles, sizeof *in);
    struct support_random random = {9};
    for (int i = 0; i < 2000; i++) {
        double x = 8 * support_unit(&random), y = 8 * support_unit(&random);
        struct tri_fence fence = {x - 2, y - 2, x + 2, y + 2};
        int32_t t = support_below(&random, mesh.n_triangles);
        const int32_t *v = mesh.tri[t].v;
        struct tri_point p =
            tri_point_between(tri_point_between(mesh.xy[v[0]], mesh.xy[v[1]], 0.4), mesh.xy[v[2]], 0.4);
        bool all = true;
        naive_cavity(&mesh, p, t, in);
        for (int32_t u = 0; u < mesh.n_triangles; u++)
            all &= !in[u] || owned(&mesh, &fence, u);
        cavity.fence = &fence;
        assert_int_equal(tri_cavity_search(&cavity, &mesh, p, t), all ? TRI_SEARCH_FOUND : TRI_SEARCH_FENCED);
        counts[all]++;
    }
    assert_true(counts[0] > 100 && counts[1] > 100);
    free(in);
    tri_cavity_free(&cavity);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

static void test_a_vertex_is_refused(void **state)
{
    (void)state;
    struct tri_cavity cavity = {0};
    struct tri_mesh mesh = tangle(0);
    for (int32_t t = 0; t < mesh.n_triangles; t++)
        for (int k = 0; k < 3; k++)
            assert_int_equal(tri_cavity_search(&cavity, &mesh, mesh.xy[mesh.tri[t].v[k]], t), TRI_SEARCH_OUTSIDE);
    for (int32_t s = 0; s < mesh.n_subs; s++) {
        int32_t n_left;
        struct tri_point end = mesh.xy[mesh.sub[s].v[s % 2]];
        assert_int_equal(tri_cavity_search_split(&cavity, &mesh, end, s, &n_left), TRI_SEARCH_OUTSIDE);
    }
    tri_mesh_free(&mesh);
    tri_cavity_free(&cavity);
}

/* The circumcentre of a flat triangle may be anywhere, even too far away for the predicates. */
static void test_a_point_out_of_range_is_outside(void **state)
{
    (void)state;
    static const double far[] = {0x1.0000000000001p200, 1e300, INFINITY, NAN};
    struct tri_pslg pslg = support_square(1, 10, 1);
    struct tri_constrain_report report;
    struct tri_mesh mesh = support_constrained(&pslg, &report);
    struct tri_cavity cavity = {0};
    for (size_t i = 0; i < sizeof far / sizeof *far; i++) {
        assert_int_equal(tri_cavity_search(&cavity, &mesh, (struct tri_point){far[i], 0.5}, 0), TRI_SEARCH_OUTSIDE);
        assert_int_equal(tri_cavity_search(&cavity, &mesh, (struct tri_point){0.5, -far[i]}, 0), TRI_SEARCH_OUTSIDE);
    }
    tri_cavity_free(&cavity);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_search_equals_flood_and_fill_is_delaunay),
        cmocka_unit_test(test_encroached_subsegments_are_walls),
        cmocka_unit_test(test_split_keeps_links_markers_and_parents),
        cmocka_unit_test(test_split_is_delaunay_without_rounding),
        cmocka_unit_test(test_fence_stops_exactly_searches_that_leave_it),
        cmocka_unit_test(test_a_vertex_is_refused),
        cmocka_unit_test(test_a_point_out_of_range_is_outside),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
