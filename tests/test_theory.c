/* The lemmas of the paper, tested as formulas and on random meshes. */
#include "support.h"

#include "sched/schedule/prerefine.h"
#include "triangle/mesh/cavity.h"
#include "triangle/refine/place.h"

static const double RADIAN = 3.14159265358979324 / 180;

/* Equation (2): the area bound of a pre-refinement that leaves no circumradius above r. */
static double area_for_radius(double radius, double rho) { return radius * radius / (4 * rho * rho * rho); }

/* Lemma 2: circumcentres at a distance of at least 4 r have cavities without a common triangle or edge. */
static bool are_independent(struct tri_point p, struct tri_point q, double radius)
{
    return tri_distance2(p, q) >= 16 * radius * radius;
}

/* Definition 3: the buffer zone of p consists of the triangles whose circumcentre c is closer to p than 2 r. The cavity
   of p lies within it. */
static bool in_buffer_zone(struct tri_point p, struct tri_point c, double radius)
{
    return (p.x - c.x) * (p.x - c.x) + (p.y - c.y) * (p.y - c.y) < 4 * radius * radius;
}

static void assert_near(double a, double b) { assert_true(fabs(a - b) <= 1e-12 * fabs(b)); }

static void test_rho_is_the_inverse_of_the_angle(void **state)
{
    (void)state;
    assert_near(par_rho(30), 1);
    assert_near(par_rho(60), 1 / sqrt(3));
    for (double angle = 0.5; angle <= 60; angle += 0.5)
        assert_near(1 / (2 * par_rho(angle)), sin(angle * RADIAN));
}

static void test_circumradius_of_known_triangles(void **state)
{
    (void)state;
    struct tri_point a = {1, 1}, b = {4, 1}, c = {1, 5};
    assert_near(par_radius2(a, b, c), 6.25);
    assert_near(par_radius2(b, c, a), 6.25);
    assert_near(par_radius2(a, c, b), 6.25); /* for any orientation */
}

/* A triangle with these two angles (degrees) and this area. */
static void make_triangle(double alpha, double beta, double area, struct tri_point v[3])
{
    double ta = tan(alpha * RADIAN), tb = tan(beta * RADIAN), x = tb / (ta + tb), y = x * ta;
    double scale = sqrt(2 * area / y);
    v[0] = (struct tri_point){0, 0};
    v[1] = (struct tri_point){scale, 0};
    v[2] = (struct tri_point){scale * x, scale * y};
}

static double radius_of(const struct tri_point v[3]) { return sqrt(par_radius2(v[0], v[1], v[2])); }

/* Lemma 7 and the tight bound: no triangle whose angles and area meet their bounds has a larger circumradius. */
static void test_radius_bounds_hold(void **state)
{
    (void)state;
    struct support_random random = {7};
    for (int i = 0; i < 20000; i++) {
        double least = 1 + 59 * support_unit(&random),
               bound = ldexp(0.5 + support_unit(&random), support_below(&random, 40) - 20);
        double alpha = least + (180 - 3 * least) * support_unit(&random);
        double beta = least + (180 - 2 * least - alpha) * support_unit(&random);
        struct tri_point v[3];
        if (fabs(alpha - 90) < 1e-3 || fabs(beta - 90) < 1e-3) /* the tangent is undefined or inaccurate here */
            continue;
        make_triangle(alpha, beta, bound * support_unit(&random) + 1e-300, v);
        double tight = par_radius_tight(bound, least);
        assert_true(radius_of(v) <= tight * (1 + 1e-9));
        assert_true(tight <= par_radius_lemma7(bound, par_rho(least)) * (1 + 1e-12));
    }
}

/* The extremal triangle has two angles at the bound and the whole area. Its circumradius equals the tight bound. */
static void test_tight_bound_is_attained(void **state)
{
    (void)state;
    for (double angle = 1; angle <= 60; angle++) {
        struct tri_point v[3];
        make_triangle(angle, angle, 3, v);
        assert_true(fabs(radius_of(v) - par_radius_tight(3, angle)) < 1e-9 * radius_of(v));
        /* One per cent more area, or a slightly smaller angle, exceeds the bound, so the bound depends on both. */
        assert_true(par_radius_tight(3.03, angle) > radius_of(v) && par_radius_tight(3, 0.99 * angle) > radius_of(v));
    }
    assert_true(fabs(par_radius_tight(1, 20) - 2.58) < 0.005 && fabs(par_radius_lemma7(1, par_rho(20)) - 3.54) < 0.005);
    assert_near(par_radius_tight(1, 60), par_radius_lemma7(1, par_rho(60))); /* both bounds agree for the equilateral
                                                                                triangle */
}

static void test_area_for_radius_is_the_inverse_of_lemma_7(void **state)
{
    (void)state;
    for (double angle = 1; angle <= 34; angle++)
        for (double radius = 1e-6; radius < 1e6; radius *= 7) {
            double area = area_for_radius(radius, par_rho(angle));
            assert_near(par_radius_lemma7(area, par_rho(angle)), radius);
            assert_true(par_radius_tight(area, angle) <= radius); /* so a mesh within this area has smaller radii */
        }
}

static void test_distances_decide_independence(void **state)
{
    (void)state;
    struct tri_point o = {0, 0}, four = {0, 4}, less = {0, 3.9999}, two = {2, 0}, within = {1.9999, 0};
    assert_true(are_independent(o, four, 1) && are_independent(four, o, 1));
    assert_false(are_independent(o, less, 1));
    assert_false(are_independent(o, four, 1.0001));
    assert_true(in_buffer_zone(o, within, 1));
    assert_false(in_buffer_zone(o, two, 1));
}

/* A mesh whose radii are about equal or (graded) differ. */
static struct tri_mesh make_mesh(bool graded, uint64_t seed)
{
    struct tri_pslg pslg = support_square(1, graded ? 60 : 10, seed);
    for (int32_t i = 8; graded && i < 2 * pslg.n_points; i++)
        pslg.points[i] *= pslg.points[i]; /* denser towards a corner */
    struct tri_options options = support_quality(25, graded ? 4e-3 : 8e-4);
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    tri_pslg_free(&pslg);
    return mesh;
}

static struct tri_mesh copy_of(const struct tri_mesh *mesh)
{
    struct tri_mesh copy;
    struct tri_error error;
    assert_int_equal(tri_mesh_init(&copy, &error), TRI_OK);
    assert_int_equal(tri_mesh_reserve_vertices(&copy, mesh->n_vertices + 8, &error), TRI_OK);
    assert_int_equal(tri_mesh_reserve_triangles(&copy, mesh->n_triangles + 16, &error), TRI_OK);
    assert_int_equal(tri_mesh_reserve_subs(&copy, mesh->n_subs, &error), TRI_OK);
    memcpy(copy.xy, mesh->xy, (size_t)mesh->n_vertices * sizeof *mesh->xy);
    memcpy(copy.on, mesh->on, (size_t)mesh->n_vertices * sizeof *mesh->on);
    memcpy(copy.tri, mesh->tri, (size_t)mesh->n_triangles * sizeof *mesh->tri);
    memcpy(copy.sub, mesh->sub, (size_t)mesh->n_subs * sizeof *mesh->sub);
    copy.n_vertices = mesh->n_vertices;
    copy.n_triangles = mesh->n_triangles;
    copy.n_subs = mesh->n_subs;
    copy.unit = mesh->unit;
    return copy;
}

static struct tri_point centre_of(const struct tri_mesh *mesh, int32_t t)
{
    struct tri_shape shape = tri_shape_of(mesh->xy, mesh->tri[t].v);
    return tri_place(mesh->xy, mesh->tri[t].v, &shape, HUGE_VAL);
}

static double radius2_at(const struct tri_mesh *mesh, int32_t t)
{
    const int32_t *v = mesh->tri[t].v;
    return par_radius2(mesh->xy[v[0]], mesh->xy[v[1]], mesh->xy[v[2]]);
}

static double largest_radius(const struct tri_mesh *mesh)
{
    double largest2 = 0;
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        largest2 = fmax(largest2, radius2_at(mesh, t));
    return sqrt(largest2);
}

static bool has(const struct tri_cavity *cavity, int32_t t)
{
    for (int32_t i = 0; i < cavity->n_tri; i++)
        if (cavity->tri[i] == t)
            return true;
    return false;
}

/* Do two cavities share a triangle, or contain the two triangles at one edge? */
static bool are_apart(const struct tri_mesh *mesh, const struct tri_cavity *a, const struct tri_cavity *b)
{
    for (int32_t i = 0; i < a->n_tri; i++) {
        if (has(b, a->tri[i]))
            return false;
        for (int e = 0; e < 3; e++)
            if (mesh->tri[a->tri[i]].n[e] >= 0 && has(b, tri_of(mesh->tri[a->tri[i]].n[e])))
                return false;
    }
    return true;
}

/* The cavity of the circumcentre of a random triangle. Cavities bounded by subsegments are skipped. */
static bool find_cavity(struct tri_cavity *cavity, const struct tri_mesh *mesh, struct support_random *random,
                        int32_t *t)
{
    *t = support_below(random, mesh->n_triangles);
    return tri_cavity_search(cavity, mesh, centre_of(mesh, *t), *t) == TRI_SEARCH_FOUND && cavity->n_wall == 0;
}

static void fill(struct tri_mesh *mesh, struct tri_cavity *cavity)
{
    int32_t v = mesh->n_vertices++;
    mesh->xy[v] = cavity->p;
    mesh->on[v] = TRI_VERTEX_FREE;
    tri_cavity_fill(cavity, mesh, v);
}

static void insert(struct tri_mesh *mesh, struct tri_point p, int32_t t)
{
    struct tri_cavity cavity = {0};
    assert_int_equal(tri_cavity_search(&cavity, mesh, p, t), TRI_SEARCH_FOUND);
    fill(mesh, &cavity);
    tri_cavity_free(&cavity);
}

static void assert_same_mesh(const struct tri_mesh *a, const struct tri_mesh *b)
{
    struct support_places here = support_places(a), there = support_places(b);
    assert_true(support_same_places(&here, &there));
    support_places_free(&here);
    support_places_free(&there);
}

/* Lemma 1: inserting p then q, q then p, or both at once gives the same mesh. In the last case both cavities are found
   before either is filled. */
static void assert_order_does_not_matter(const struct tri_mesh *mesh, struct tri_cavity *p, int32_t tp,
                                         struct tri_cavity *q, int32_t tq)
{
    struct tri_mesh first = copy_of(mesh), second = copy_of(mesh), both = copy_of(mesh);
    struct tri_error error = {0};
    insert(&first, p->p, tp);
    insert(&first, q->p, tq);
    insert(&second, q->p, tq);
    insert(&second, p->p, tp);
    fill(&both, p);
    fill(&both, q);
    assert_int_equal(tri_mesh_validate(&both, &error), TRI_OK);
    support_assert_cdt(&both, false);
    assert_same_mesh(&first, &second);
    assert_same_mesh(&first, &both);
    tri_mesh_free(&first);
    tri_mesh_free(&second);
    tri_mesh_free(&both);
}

/* Lemma 2: points that are_independent accepts are independent. The test is not vacuous: closer pairs do interfere. */
static void test_independent_points_have_cavities_apart(void **state)
{
    (void)state;
    struct tri_cavity p = {0}, q = {0};
    for (uint64_t seed = 0; seed < 6; seed++) {
        struct support_random random = {seed};
        struct tri_mesh mesh = make_mesh(seed % 2, seed);
        double radius = largest_radius(&mesh);
        int independent = 0, in_the_way = 0, tp, tq;
        for (int i = 0; i < 20000; i++) {
            if (!find_cavity(&p, &mesh, &random, &tp) || !find_cavity(&q, &mesh, &random, &tq) || tp == tq)
                continue;
            bool apart = are_apart(&mesh, &p, &q);
            assert_true(apart == are_apart(&mesh, &q, &p));
            in_the_way += !apart;
            if (!are_independent(p.p, q.p, radius))
                continue;
            assert_true(apart);
            if (independent++ < 30)
                assert_order_does_not_matter(&mesh, &p, tp, &q, tq);
        }
        assert_true(independent > 100 && in_the_way > 10);
        tri_mesh_free(&mesh);
    }
    tri_cavity_free(&p);
    tri_cavity_free(&q);
}

/* Definition 3: the cavity lies in the buffer zone. The whole cavity including its corners lies within 2 r of the
   point; the margin of a fence relies on this. */
static void test_cavities_lie_in_the_buffer_zone(void **state)
{
    (void)state;
    struct tri_cavity p = {0};
    for (uint64_t seed = 10; seed < 14; seed++) {
        struct support_random random = {seed};
        struct tri_mesh mesh = make_mesh(seed % 2, seed);
        double radius = largest_radius(&mesh);
        int32_t t;
        for (int i = 0; i < 3000; i++) {
            if (!find_cavity(&p, &mesh, &random, &t))
                continue;
            for (int32_t k = 0; k < p.n_tri; k++) {
                assert_true(in_buffer_zone(p.p, centre_of(&mesh, p.tri[k]), radius));
                for (int c = 0; c < 3; c++)
                    assert_true(tri_relative(&mesh.xy[mesh.tri[p.tri[k]].v[c]], p.p).l < 4 * radius * radius);
            }
        }
        tri_mesh_free(&mesh);
    }
    tri_cavity_free(&p);
}

/* Lemmas 3 and 4: each new triangle has a smaller circumradius than one of the two old triangles at its edge. Hence the
   largest circumradius never grows. */
static void test_radius_never_grows(void **state)
{
    (void)state;
    struct tri_cavity p = {0};
    for (uint64_t seed = 20; seed < 24; seed++) {
        struct support_random random = {seed};
        struct tri_mesh mesh = make_mesh(seed % 2, seed);
        struct tri_error error;
        double bound = largest_radius(&mesh);
        int32_t t;
        for (int i = 0; i < 4000; i++) {
            if (!find_cavity(&p, &mesh, &random, &t))
                continue;
            double before2 = 0; /* largest squared radius of the cavity and the triangles around it */
            for (int32_t k = 0; k < p.n_tri; k++)
                before2 = fmax(before2, radius2_at(&mesh, p.tri[k]));
            for (int32_t k = 0; k < p.n_edges; k++)
                before2 = fmax(before2, radius2_at(&mesh, tri_of(p.edge[k].outer)));
            assert_int_equal(tri_mesh_reserve_vertices(&mesh, 1, &error), TRI_OK);
            assert_int_equal(tri_mesh_reserve_triangles(&mesh, 2, &error), TRI_OK);
            fill(&mesh, &p);
            for (int32_t k = 0; k < p.n_edges; k++)
                assert_true(radius2_at(&mesh, p.tri[k]) <= before2 * (1 + 1e-9));
        }
        assert_true(largest_radius(&mesh) <= bound * (1 + 1e-9));
        tri_mesh_free(&mesh);
    }
    tri_cavity_free(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rho_is_the_inverse_of_the_angle),
        cmocka_unit_test(test_circumradius_of_known_triangles),
        cmocka_unit_test(test_radius_bounds_hold),
        cmocka_unit_test(test_tight_bound_is_attained),
        cmocka_unit_test(test_area_for_radius_is_the_inverse_of_lemma_7),
        cmocka_unit_test(test_distances_decide_independence),
        cmocka_unit_test(test_independent_points_have_cavities_apart),
        cmocka_unit_test(test_cavities_lie_in_the_buffer_zone),
        cmocka_unit_test(test_radius_never_grows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
