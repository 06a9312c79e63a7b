/* Compares the best point of a petal with the whole Voronoi diagram, and with the edges that the point would get. */
#include "support.h"

#include "triangle/mesh/cavity.h"
#include "triangle/refine/petal.h"
#include "triangle/refine/place.h"
#include "triangle/size/quality.h"

enum { PETALS = 4000 };

/* A petal by its definition: the disk from whose border ab is seen under the bound. */
struct petal {
    struct tri_point a, b, o;
    double r2, usual2; /* squared radius of the disk; of the triangle's circumdisk */
};

static struct tri_point centre_of(const struct tri_mesh *mesh, tri_triangle_id t)
{
    const tri_vertex_id *v = mesh->tri[t].v;
    struct tri_shape shape = tri_shape_of(mesh->xy, v);
    return tri_place(mesh->xy, v, &shape, HUGE_VAL);
}

static struct petal petal_of(const struct tri_mesh *mesh, tri_triangle_id t, const struct tri_shape *shape,
                             double angle)
{
    const tri_vertex_id *v = mesh->tri[t].v;
    struct petal p = {.a = mesh->xy[v[tri_next[shape->shortest]]], .b = mesh->xy[v[tri_prev[shape->shortest]]]};
    double cotangent = 1 / tan(angle * 0.017453292519943295769), x = p.b.x - p.a.x, y = p.b.y - p.a.y;
    p.o = (struct tri_point){0.5 * (p.a.x + p.b.x - cotangent * y), 0.5 * (p.a.y + p.b.y + cotangent * x)};
    p.r2 = tri_distance2(p.o, p.a);
    p.usual2 = tri_distance2(centre_of(mesh, t), p.a);
    return p;
}

static bool holds(const struct petal *p, struct tri_point q)
{
    return tri_orient2d(p->a, p->b, q) > 0 && tri_distance2(p->o, q) <= p->r2 * (1 + 1e-9);
}

/* The smallest squared distance of q from a vertex. */
static double nearest2(const struct tri_mesh *mesh, struct tri_point q)
{
    double least = HUGE_VAL;
    for (tri_vertex_id v = 0; v < mesh->n_vertices; v++)
        least = fmin(least, tri_distance2(q, mesh->xy[v]));
    return least;
}

/* The smallest squared length of the edges that p would get if it were inserted for triangle t. Infinite if p lies
   behind a segment, which would be split instead. */
static double shortest2(const struct tri_mesh *mesh, tri_triangle_id t, struct tri_point p)
{
    struct tri_cavity cavity = {0};
    double least = HUGE_VAL;
    bool behind = tri_cavity_search(&cavity, mesh, p, t) != TRI_SEARCH_FOUND;
    for (int32_t i = 0; i < cavity.n_edges; i++) {
        behind = behind || tri_orient2d(p, mesh->xy[cavity.edge[i].a->v], mesh->xy[cavity.edge[i + 1].a->v]) <= 0;
        least = fmin(least, cavity.edge[i].a->r.l);
    }
    tri_cavity_free(&cavity);
    return behind ? HUGE_VAL : least;
}

/* The best of the diagram's vertices in the petal and of the points where its edges leave the petal, found by
   bisection. */
static double best2(const struct tri_mesh *mesh, const struct petal *p)
{
    double best = 0;
    for (tri_halfedge code = 0; code < 4 * mesh->n_triangles; code++) {
        if (tri_edge(code) == 3 || *tri_link_at(mesh, code) < 0)
            continue;
        struct tri_point c = centre_of(mesh, tri_of(code)), d = centre_of(mesh, tri_of(*tri_link_at(mesh, code)));
        if (!holds(p, c))
            continue;
        best = fmax(best, nearest2(mesh, c));
        for (int i = 0; i < 60 && !holds(p, d); i++) {
            struct tri_point middle = {0.5 * (c.x + d.x), 0.5 * (c.y + d.y)};
            *(holds(p, middle) ? &c : &d) = middle;
        }
        if (tri_distance2(p->o, c) > p->r2 * 0.999999) /* not through ab */
            best = fmax(best, nearest2(mesh, c));
    }
    return best;
}

static bool is_bad(const struct tri_shape *shape, double angle)
{
    double sine = sin(angle * 0.017453292519943295769);
    return shape->area2 * shape->area2 < sine * sine * tri_longer_product(shape->l[0], shape->l[1], shape->l[2]);
}

/* For each bad triangle, the point lies in the petal and its edges are no shorter than those of the circumcentre.
   Without segments, no other point of the diagram is better. */
static void judge_points(const struct tri_mesh *mesh, double angle, bool open, int *better, int *petals)
{
    double height = tri_bounds_for(angle, false).off_centre;
    for (tri_triangle_id t = 0; t < mesh->n_triangles && *petals < PETALS; t++) {
        struct tri_shape shape = tri_shape_of(mesh->xy, mesh->tri[t].v);
        struct tri_point p;
        tri_vertex_id beyond[2];
        if (!is_bad(&shape, angle) || shape.area2 < 1e-9)
            continue;
        struct petal petal = petal_of(mesh, t, &shape, angle);
        enum tri_petal found = tri_petal_point(mesh, NULL, t, &shape, height, &p, beyond);
        assert_true(found == TRI_PETAL_USUAL || found == TRI_PETAL_BETTER);
        ++*petals;
        if (found == TRI_PETAL_BETTER) {
            ++*better;
            assert_true(holds(&petal, p));
            assert_true(shortest2(mesh, t, p) > petal.usual2 * (1 - 1e-9));
            assert_true(!open || nearest2(mesh, p) > petal.usual2 * (1 - 1e-9));
        }
        if (open && holds(&petal, centre_of(mesh, t)))
            assert_true((found == TRI_PETAL_BETTER ? nearest2(mesh, p) : petal.usual2) > 0.99 * best2(mesh, &petal));
    }
}

static void test_the_point_is_the_best_of_the_diagram(void **state)
{
    (void)state;
    static const double angles[] = {20, 30, 34, 38};
    int better = 0, petals = 0;
    for (uint64_t seed = 0; seed < 24; seed++) {
        struct tri_pslg pslg = support_points(seed % 3 ? SUPPORT_RANDOM : SUPPORT_CLUSTER, 90, seed);
        struct tri_mesh mesh = support_delaunay(&pslg, 0, NULL);
        judge_points(&mesh, angles[seed % 4], true, &better, &petals);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
    assert_true(better > petals / 10 && petals > 1000);
}

static void test_segments_hide_vertices_behind_them(void **state)
{
    (void)state;
    int better = 0, petals = 0;
    for (uint64_t seed = 0; seed < 12; seed++) {
        struct tri_pslg pslg = support_tangle(SUPPORT_RANDOM, 40, 12, seed);
        struct tri_constrain_report report;
        struct tri_mesh mesh = support_constrained(&pslg, &report);
        judge_points(&mesh, 30, false, &better, &petals);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
    assert_true(better > petals / 20 && petals > 300);
}

/* Triangles outside the fence, or held by other ranks, are not read. The point does not depend on their content. */
static void test_triangles_outside_the_fence_are_not_read(void **state)
{
    (void)state;
    const double height = tri_bounds_for(30, false).off_centre;
    const struct tri_fence fence = {0.2, 0.2, 0.8, 0.8};
    int waits = 0, moved = 0;
    struct tri_pslg pslg = support_points(SUPPORT_RANDOM, 400, 7);
    struct tri_mesh whole = support_delaunay(&pslg, 0, NULL), part = support_delaunay(&pslg, 0, NULL);
    for (tri_triangle_id t = 0; t < part.n_triangles; t++)
        for (int e = 0; e < 3; e++) {
            const struct tri_point q = part.xy[part.tri[t].v[e]];
            if (part.tri[t].n[e] >= 0 && !tri_fence_holds(&fence, q))
                part.tri[tri_of(part.tri[t].n[e])].n[tri_edge(part.tri[t].n[e])] = TRI_BEYOND;
        }
    for (tri_triangle_id t = 0; t < whole.n_triangles; t++) {
        struct tri_shape shape = tri_shape_of(whole.xy, whole.tri[t].v);
        struct tri_point p = {0, 0}, q = {0, 0};
        tri_vertex_id beyond[2];
        if (!is_bad(&shape, 30))
            continue;
        enum tri_petal here = tri_petal_point(&whole, &fence, t, &shape, height, &p, beyond);
        enum tri_petal there = tri_petal_point(&part, &fence, t, &shape, height, &q, beyond);
        moved += here == TRI_PETAL_BETTER;
        waits += there == TRI_PETAL_BEYOND;
        if (there != TRI_PETAL_BEYOND)
            assert_true(here == there && p.x == q.x && p.y == q.y);
        else
            assert_true(tri_fence_holds(&fence, part.xy[beyond[0]]) && tri_fence_holds(&fence, part.xy[beyond[1]]));
    }
    assert_true(waits > 0 && moved > 0);
    tri_mesh_free(&whole);
    tri_mesh_free(&part);
    tri_pslg_free(&pslg);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_point_is_the_best_of_the_diagram),
        cmocka_unit_test(test_segments_hide_vertices_behind_them),
        cmocka_unit_test(test_triangles_outside_the_fence_are_not_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
