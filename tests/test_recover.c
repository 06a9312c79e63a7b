/* Edges are recovered one after another. After each, the mesh is the constrained Delaunay triangulation of the edges so
   far. By Lee & Lin's lemma it is enough that every edge without a subsegment is Delaunay. */
#include "full.h"
#include "support.h"
#include "triangle/cdt/recover.h"

struct crossing {
    int32_t t;     /* triangle at a through which the segment leaves; TRI_NONE: none, or ambiguous */
    int32_t edges; /* number of edges crossed */
};

static bool is_corner(const struct tri_triangle *t, int32_t v) { return t->v[0] == v || t->v[1] == v || t->v[2] == v; }

/* A naive search over all triangles. */
static struct crossing find_crossing(const struct tri_mesh *mesh, int32_t a, int32_t b)
{
    struct crossing found = {TRI_NONE, 0};
    struct tri_point pa = mesh->xy[a], pb = mesh->xy[b];
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        for (int e = 0; e < 3; e++) {
            const struct tri_triangle *at = &mesh->tri[t];
            int32_t from = at->v[tri_next[e]], to = at->v[tri_prev[e]], link = at->n[e];
            if (from == a || from == b || to == a || to == b)
                continue;
            double p = tri_orient2d(pa, pb, mesh->xy[from]), q = tri_orient2d(pa, pb, mesh->xy[to]);
            struct tri_point pf = mesh->xy[from], pt = mesh->xy[to];
            double r = tri_orient2d(pf, pt, pa), s = tri_orient2d(pf, pt, pb);
            bool apart = (p > 0 && q > 0) || (p < 0 && q < 0) || (r > 0 && s > 0) || (r < 0 && s < 0);
            if (apart || (p == 0 && q == 0))
                continue;
            if (link < 0 || p == 0 || q == 0)
                return (struct crossing){TRI_NONE, 0};
            found.edges += tri_code(t, e) < link;
            found.t = is_corner(at, a) ? t : found.t;
        }
    return found;
}

static void mark(struct tri_mesh *mesh, int32_t code)
{
    struct tri_error error = {0};
    assert_int_equal(tri_mesh_reserve_subs(mesh, 1, &error), TRI_OK);
    int32_t t = tri_of(code), link = mesh->tri[t].n[tri_edge(code)];
    int32_t s = tri_mesh_add_sub(mesh, mesh->tri[t].v[tri_next[tri_edge(code)]],
                                 mesh->tri[t].v[tri_prev[tri_edge(code)]], 0, 0);
    mesh->sub[s].side[0] = code;
    mesh->sub[s].side[1] = link;
    mesh->tri[t].n[tri_edge(code)] = mesh->tri[tri_of(link)].n[tri_edge(link)] = ~s;
}

/* Recovers ab if nothing blocks it. Returns how many edges it crossed. */
static int32_t recover(struct tri_recovery *r, struct tri_mesh *mesh, int32_t a, int32_t b)
{
    struct tri_error error = {0};
    struct crossing crossing = find_crossing(mesh, a, b);
    int32_t code;
    if (crossing.t == TRI_NONE)
        return 0;
    assert_int_equal(tri_recover_edge(r, mesh, crossing.t, a, b, &code, &error), TRI_OK);
    assert_int_equal(r->n_crossed, crossing.edges + 1);
    assert_int_equal(mesh->tri[tri_of(code)].v[tri_next[tri_edge(code)]], a);
    assert_int_equal(mesh->tri[tri_of(code)].v[tri_prev[tri_edge(code)]], b);
    mark(mesh, code);
    if (tri_mesh_validate(mesh, &error) != TRI_OK)
        fail_msg("%s", error.text);
    support_assert_cdt(mesh, false);
    return crossing.edges;
}

static struct tri_mesh delaunay_of(struct tri_pslg *pslg)
{
    struct tri_constrain_report report;
    pslg->n_segments = 0;
    return support_constrained(pslg, &report);
}

/* Inserts segments between random points as long as they cross no earlier segment. The polygons then have walls, and
   edges with both sides in one polygon. */
static void test_random_segments(void **state)
{
    (void)state;
    struct tri_recovery r = {0};
    int32_t crossed = 0;
    for (int kind = 0; kind < SUPPORT_KINDS; kind++)
        for (uint64_t seed = 0; seed < 60; seed++) {
            struct support_random random = {seed};
            int32_t n = 5 + (int32_t)seed;
            struct tri_pslg pslg = support_points((enum support_kind)kind, n, seed);
            struct tri_mesh mesh = delaunay_of(&pslg);
            for (int i = 0; i < 60; i++) {
                int32_t a = support_below(&random, n), b = support_below(&random, n);
                if (!mesh.twin || (mesh.twin[a] == a && mesh.twin[b] == b))
                    crossed += a == b ? 0 : recover(&r, &mesh, a, b);
            }
            tri_mesh_free(&mesh);
            tri_pslg_free(&pslg);
        }
    assert_true(crossed > 10000);
    tri_recovery_free(&r);
}

/* Points around the segment from (-2, 0) to (2, 0), whose ends come first. Then short segments that reach into the
   strip around it or stand across it, without crossing the line. They give walls, and edges with both sides in one
   polygon. */
static struct tri_pslg strip(int32_t n, uint64_t seed, double height, double reach)
{
    struct support_random random = {seed};
    struct tri_pslg pslg = support_pslg(n + 2, n, 0, 0);
    support_add_point(&pslg, -2, 0);
    support_add_point(&pslg, 2, 0);
    for (int32_t i = 0; i < n; i++) {
        double y = height * support_unit(&random) * support_unit(&random) + 1e-3;
        support_add_point(&pslg, 4 * support_unit(&random) - 2, i % 2 ? y : -y);
    }
    for (int32_t i = 0; i < n; i++) {
        int32_t a = 2 + support_below(&random, n), b = 2 + support_below(&random, n);
        if (a % 2 == b % 2 && a != b && fabs(pslg.points[2 * a] - pslg.points[2 * b]) < reach)
            support_add_segment(&pslg, a, b);
    }
    return pslg;
}

static void test_walls_beside_the_edge(void **state)
{
    (void)state;
    struct tri_recovery r = {0};
    int32_t crossed = 0;
    for (uint64_t seed = 0; seed < 400; seed++) {
        struct tri_pslg pslg = strip(10 + (int32_t)seed % 60, seed, seed % 3 ? 4 : 0.3, seed % 4 ? 0.5 : 3);
        int32_t n = pslg.n_segments;
        struct tri_mesh mesh = delaunay_of(&pslg);
        for (int32_t i = 0; i < n; i++)
            recover(&r, &mesh, pslg.segments[2 * i], pslg.segments[2 * i + 1]);
        crossed += recover(&r, &mesh, (int32_t)(seed % 2), 1 - (int32_t)(seed % 2));
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
    assert_true(crossed > 4000);
    tri_recovery_free(&r);
}

/* Shapes on which flips take quadratic time, first small enough for a complete check, then large. k points lie above, k
   below. */
enum shape { PARABOLAS, LENS, ZIGZAG, FAN, SHAPES };

static struct tri_pslg shape(enum shape which, int32_t k)
{
    struct tri_pslg pslg = support_pslg(2 * k + 2, 1, 0, 0);
    support_add_point(&pslg, -2, 0);
    support_add_point(&pslg, 2, 0);
    for (int32_t i = 0; i < k; i++) {
        double x = 2.0 * i / (k - 1) - 1, tooth = 0.01 + (i % 3) * 0.2;
        double y = which == ZIGZAG ? tooth : which == LENS ? 1.1 - x * x : 1e-3 + (which == FAN ? 1e-3 : 1) * x * x;
        support_add_point(&pslg, x, y);
        if (which != FAN)
            support_add_point(&pslg, x + (which == ZIGZAG ? 0.3 / k : 0), -y);
        else if (i == 0)
            support_add_point(&pslg, 0, -50);
    }
    return pslg;
}

static void recover_shape(enum shape which, int32_t k)
{
    struct tri_recovery r = {0};
    struct tri_pslg pslg = shape(which, k);
    struct tri_mesh mesh = delaunay_of(&pslg);
    recover(&r, &mesh, 0, 1);
    assert_true(r.n_crossed > k / 4);
    tri_recovery_free(&r);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

static void test_shapes_that_need_many_flips(void **state)
{
    (void)state;
    for (int which = 0; which < SHAPES; which++) {
        for (int32_t k = 3; k < 60; k += 7)
            recover_shape((enum shape)which, k);
        recover_shape((enum shape)which, 100000 / every(10));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random_segments),
        cmocka_unit_test(test_walls_beside_the_edge),
        cmocka_unit_test(test_shapes_that_need_many_flips),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
