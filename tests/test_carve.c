/* Carving and regions against a naive twin that paints components of the mesh minus its segments. */
#include "support.h"
#include "triangle/cdt/carve.h"

/* paint[t]: the lowest number of a triangle that can be reached from t without crossing a subsegment. Repeats sweeps
 * until nothing changes. */
static int32_t *paint_components(const struct tri_mesh *mesh)
{
    int32_t *paint = calloc((size_t)mesh->n_triangles + 1, sizeof *paint);
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        paint[t] = t;
    for (bool changed = true; changed;) {
        changed = false;
        for (int32_t t = 0; t < mesh->n_triangles; t++)
            for (int e = 0; e < 3; e++) {
                int32_t link = mesh->tri[t].n[e];
                if (link >= 0 && paint[tri_of(link)] < paint[t]) {
                    paint[t] = paint[tri_of(link)];
                    changed = true;
                }
            }
    }
    return paint;
}

static bool holds(const struct tri_mesh *mesh, int32_t t, double x, double y)
{
    const int32_t *v = mesh->tri[t].v;
    struct tri_point a = mesh->xy[v[0]], b = mesh->xy[v[1]], c = mesh->xy[v[2]], q = {x, y};
    return tri_orient2d(a, b, q) > 0 && tri_orient2d(b, c, q) > 0 && tri_orient2d(c, a, q) > 0;
}

static void mark_component(const struct tri_mesh *mesh, const int32_t *paint, int32_t of, int32_t value, int32_t *out)
{
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        if (paint[t] == paint[of])
            out[t] = value;
}

/* region[t] becomes TRI_NONE if t is carved, otherwise the number of its region. */
static int32_t *naive_regions(const struct tri_mesh *mesh, const struct tri_pslg *pslg,
                              const struct tri_carve_options *options)
{
    int32_t *paint = paint_components(mesh), *region = calloc((size_t)mesh->n_triangles + 1, sizeof *region);
    for (int32_t k = 0; options->spread_regions && k < pslg->n_regions; k++)
        for (int32_t t = 0; t < mesh->n_triangles; t++)
            if (holds(mesh, t, pslg->regions[4 * k], pslg->regions[4 * k + 1]))
                mark_component(mesh, paint, t, k + 1, region);
    for (int32_t k = 0; !options->ignore_holes && k < pslg->n_holes; k++)
        for (int32_t t = 0; t < mesh->n_triangles; t++)
            if (holds(mesh, t, pslg->holes[2 * k], pslg->holes[2 * k + 1]))
                mark_component(mesh, paint, t, TRI_NONE, region);
    for (int32_t s = 0; !options->keep_hull && s < mesh->n_subs; s++)
        for (int side = 0; side < 2; side++)
            if (mesh->parents[mesh->sub[s].parent].segment == TRI_NONE && mesh->sub[s].side[side] != TRI_NONE)
                mark_component(mesh, paint, tri_of(mesh->sub[s].side[side]), TRI_NONE, region);
    free(paint);
    return region;
}

/* The triangles that the naive twin keeps; their regions are in a parallel array by position in the sorted set. */
static struct support_set survivors(const struct tri_mesh *mesh, const int32_t *region, int32_t wanted)
{
    struct support_set set = {0, calloc((size_t)mesh->n_triangles + 1, sizeof *set.v)};
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        if (region[t] != TRI_NONE && (wanted == TRI_NONE || region[t] == wanted))
            memcpy(set.v[set.n++], mesh->tri[t].v, sizeof *set.v);
    support_sort(&set);
    return set;
}

static void assert_same_triangles(const struct tri_mesh *before, const int32_t *wanted, const struct tri_mesh *after,
                                  int32_t region)
{
    int32_t *found = calloc((size_t)after->n_triangles + 1, sizeof *found);
    for (int32_t t = 0; t < after->n_triangles; t++)
        found[t] = after->tri[t].region;
    struct support_set a = survivors(before, wanted, region), b = survivors(after, found, region);
    assert_int_equal(a.n, b.n);
    assert_true(support_same(&a, &b));
    support_set_free(&a);
    support_set_free(&b);
    free(found);
}

static void assert_compact(const struct tri_mesh *mesh, int32_t n_segments)
{
    int32_t last = -1;
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        assert_true(tri_is_live(&mesh->tri[t]));
    assert_int_equal(mesh->n_parents, mesh->n_subs);
    for (int32_t s = 0; s < mesh->n_subs; s++) {
        int32_t segment = mesh->parents[mesh->sub[s].parent].segment;
        assert_int_equal(mesh->sub[s].parent, s);
        assert_true(mesh->sub[s].side[0] != TRI_NONE || mesh->sub[s].side[1] != TRI_NONE);
        assert_memory_equal(mesh->parents[s].v, mesh->sub[s].v, sizeof mesh->sub[s].v);
        segment = segment == TRI_NONE ? n_segments : segment;
        assert_true(segment >= last); /* hull edges come last */
        last = segment;
    }
}

static void compare_with_twin(struct tri_pslg *pslg, const struct tri_carve_options *options)
{
    struct tri_constrain_report report;
    struct tri_error error = {0};
    struct tri_mesh before = support_constrained(pslg, &report), mesh = support_constrained(pslg, &report);
    int32_t *wanted = naive_regions(&before, pslg, options);
    assert_int_equal(tri_carve(&mesh, pslg, options, &error), TRI_OK);
    if (tri_mesh_validate(&mesh, &error) != TRI_OK)
        fail_msg("%s", error.text);
    assert_compact(&mesh, pslg->n_segments);
    assert_same_triangles(&before, wanted, &mesh, TRI_NONE);
    for (int32_t k = 0; options->spread_regions && k <= pslg->n_regions; k++) {
        assert_same_triangles(&before, wanted, &mesh, k);
        assert_true(k == 0 || mesh.regions[k].attribute == pslg->regions[4 * k - 2]);
        assert_true(k == 0 || mesh.regions[k].max_area == pslg->regions[4 * k - 1]);
    }
    free(wanted);
    tri_mesh_free(&before);
    tri_mesh_free(&mesh);
}

static void add_places(struct tri_pslg *pslg, int32_t n, uint64_t seed, double size)
{
    struct support_random random = {seed};
    pslg->n_holes = pslg->n_regions = n;
    for (int32_t i = 0; i < 2 * n; i++)
        pslg->holes[i] = size * (2.4 * support_unit(&random) - 1.2); /* some of them outside */
    for (int32_t i = 0; i < 4 * n; i++)
        pslg->regions[i] = i % 4 < 2 ? size * (2.4 * support_unit(&random) - 1.2) : i;
}

static void test_tangles_equal_naive_twin(void **state)
{
    (void)state;
    for (int which = 0; which < 8; which++)
        for (uint64_t seed = 0; seed < 25; seed++) {
            struct tri_carve_options options = {which & 1, which & 2, which & 4, false, 0, NULL};
            struct tri_pslg pslg = support_tangle(seed % 2 ? SUPPORT_RANDOM : SUPPORT_LATTICE, 25, 30, seed);
            if (seed % 3)
                memmove(pslg.segments, pslg.segments + 8, (size_t)(pslg.n_segments -= 4) * 8); /* makes an open hull */
            add_places(&pslg, 4, seed, seed % 2 ? 2 : 12);
            compare_with_twin(&pslg, &options);
            tri_pslg_free(&pslg);
        }
}

static void test_polygons_equal_naive_twin(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 30; seed++) {
        struct tri_carve_options options = {.spread_regions = true};
        struct tri_pslg pslg = support_polygon(40, seed);
        pslg.n_holes = 0;
        compare_with_twin(&pslg, &options);
        add_places(&pslg, 1, seed, 1);
        pslg.n_holes = 0;
        compare_with_twin(&pslg, &options);
        tri_pslg_free(&pslg);
    }
}

/* In nested squares, the last region wins, holes stop at rings, and a hole point outside is ignored. */
static void test_nested_rings(void **state)
{
    (void)state;
    struct tri_carve_options options = {.spread_regions = true};
    struct tri_pslg pslg = support_pslg(20, 20, 5, 5);
    struct tri_constrain_report report;
    for (int ring = 0; ring < 3; ring++) {
        double r = 1 << ring;
        int32_t first = pslg.n_points;
        support_add_point(&pslg, -r, -r);
        support_add_point(&pslg, r, -r);
        support_add_point(&pslg, r, r);
        support_add_point(&pslg, -r, r);
        for (int k = 0; k < 4; k++)
            support_add_segment(&pslg, first + k, first + (k + 1) % 4);
    }
    double holes[4] = {1.5, 0, 50, 50}, regions[12] = {0, 0, 1, 0, 3, 0.5, 2, 0, 0, 0.5, 3, 0.25};
    memcpy(pslg.holes, holes, sizeof holes);
    memcpy(pslg.regions, regions, sizeof regions);
    pslg.n_holes = 2;
    pslg.n_regions = 3;
    compare_with_twin(&pslg, &options);
    struct tri_mesh mesh = support_constrained(&pslg, &report);
    assert_int_equal(tri_carve(&mesh, &pslg, &options, NULL), TRI_OK);
    assert_int_equal(mesh.n_triangles, 2 + 8);
    int count[4] = {0};
    for (int32_t t = 0; t < mesh.n_triangles; t++)
        count[mesh.tri[t].region]++;
    assert_true(count[0] == 0 && count[1] == 0 && count[2] == 8 && count[3] == 2);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* A hole point on a vertex, on a segment, or on an edge without segment breaks nothing. The hull stays convex or
 * becomes empty. */
static void test_hole_points_in_odd_places(void **state)
{
    (void)state;
    static const double at[][2] = {{0, 0},   {0.5, 0},     {0.5, 0.5}, {1, 1},
                                   {1.5, 1}, {-0.0, 0.25}, {1e300, 0}, {0.25, 1e-300}};
    for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
        struct tri_pslg pslg = support_square(1, 0, 1);
        struct tri_options options = tri_defaults();
        pslg.n_holes = 1;
        free(pslg.holes);
        pslg.holes = calloc(2, sizeof *pslg.holes);
        memcpy(pslg.holes, at[i], sizeof at[i]);
        options.use_segments = true;
        struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
        assert_true(mesh.n_triangles == 0 || mesh.n_triangles == 2);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

/* Points outside the figure have no effect as holes or regions, regardless of their distance and of the figure's
 * size. */
static void test_far_places_are_outside(void **state)
{
    (void)state;
    const struct tri_carve_options options = {.spread_regions = true};
    const struct tri_check_options judged = {0};
    for (int size = -300; size <= 300; size += 50)
        for (int far = size + 1; far <= 308; far += 7) {
            struct tri_pslg pslg = support_square(1, 5, 3);
            double scale = pow(10, size), x = pow(10, far);
            for (int32_t i = 0; i < 2 * pslg.n_points; i++)
                pslg.points[i] *= scale;
            const double holes[] = {x, 1.7 * x, -x, 0}, regions[] = {x, x, 7, -1, 0, -x, 7, -1};
            memcpy(pslg.holes, holes, sizeof holes);
            memcpy(pslg.regions, regions, sizeof regions);
            pslg.n_holes = pslg.n_regions = 2;
            struct tri_constrain_report report;
            struct tri_mesh mesh = support_constrained(&pslg, &report);
            int32_t n = mesh.n_triangles;
            assert_int_equal(tri_carve(&mesh, &pslg, &options, NULL), TRI_OK);
            assert_int_equal(mesh.n_triangles, n);
            for (int32_t t = 0; t < n; t++)
                assert_int_equal(mesh.tri[t].region, 0);
            tri_mark_vertices(&mesh);
            tri_mark_boundary(&mesh);
            support_judge(&mesh, &pslg, &judged, false, NULL);
            tri_mesh_free(&mesh);
            tri_pslg_free(&pslg);
        }
}

/* A hole point exactly on a segment, at its end, or at a vertex through which it is routed selects no face. */
static void test_holes_between_faces_empty_nothing(void **state)
{
    (void)state;
    static const struct {
        double x, y;
        int32_t between, triangles;
    } cases[] = {{0, 2, 1, 6}, {4, 4, 1, 6}, {2, 1, 1, 6}, {2, 4, 1, 6}, {1, 2, 0, 2}, {3, 3, 0, 4}, {1, 1, 0, 2}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct tri_pslg pslg = support_pslg(7, 5, 1, 0);
        static const double points[7][2] = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {2, 0}, {2, 4}, {1, 2}};
        for (int k = 0; k < 7; k++) /* two rooms; no segment ends at the last point */
            support_add_point(&pslg, points[k][0], points[k][1]);
        for (int k = 0; k < 4; k++)
            support_add_segment(&pslg, k, (k + 1) % 4);
        support_add_segment(&pslg, 4, 5);
        memcpy(pslg.holes, (double[]){cases[i].x, cases[i].y}, 2 * sizeof(double));
        pslg.n_holes = 1;
        struct tri_carve_report carved;
        const struct tri_carve_options options = {.report = &carved};
        struct tri_constrain_report report;
        struct tri_mesh mesh = support_constrained(&pslg, &report);
        assert_int_equal(tri_carve(&mesh, &pslg, &options, NULL), TRI_OK);
        assert_int_equal(carved.between, cases[i].between);
        assert_int_equal(mesh.n_triangles, cases[i].triangles);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

static void test_boundary_markers(void **state)
{
    (void)state;
    struct tri_carve_options options = {0};
    struct tri_constrain_report report;
    struct tri_pslg pslg = support_square(4, 0, 1);
    int32_t markers[8] = {0, 7, 0, 0}, vertex_markers[5] = {0, 0, 3, 0, 0};
    free(pslg.points);
    pslg.points = calloc(10, sizeof(double));
    pslg.n_points = 0;
    support_add_point(&pslg, 0, 0);
    support_add_point(&pslg, 4, 0);
    support_add_point(&pslg, 4, 4);
    support_add_point(&pslg, 0, 4);
    support_add_point(&pslg, 2, 2);
    pslg.segment_markers = markers;
    pslg.markers = vertex_markers;
    struct tri_mesh mesh = support_constrained(&pslg, &report);
    assert_int_equal(tri_carve(&mesh, &pslg, &options, NULL), TRI_OK);
    tri_mark_vertices(&mesh);
    tri_mark_boundary(&mesh);
    static const int32_t want_vertex[5] = {1, 7, 3, 1, 0}, want_sub[4] = {1, 7, 1, 1};
    for (int k = 0; k < 5; k++)
        assert_int_equal(mesh.vertex_markers[k], want_vertex[k]);
    assert_int_equal(mesh.n_subs, 4);
    for (int k = 0; k < 4; k++)
        assert_int_equal(mesh.sub[k].marker, want_sub[k]);
    tri_mesh_free(&mesh);
    pslg.markers = pslg.segment_markers = NULL;
    tri_pslg_free(&pslg);
}

/* --- even_odd */

/* Returns the number of segments that a ray to the right of (x, y) crosses, which defines the even-odd rule. */
static int crossings(const struct tri_pslg *pslg, double x, double y)
{
    int n = 0;
    for (int32_t k = 0; k < pslg->n_segments; k++) {
        const double *a = &pslg->points[2 * pslg->segments[2 * k]], *b = &pslg->points[2 * pslg->segments[2 * k + 1]];
        if ((a[1] > y) != (b[1] > y))
            n += a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) > x;
    }
    return n;
}

static double area_of(const struct tri_mesh *mesh, int32_t t, double centroid[2])
{
    struct tri_point a = mesh->xy[mesh->tri[t].v[0]], b = mesh->xy[mesh->tri[t].v[1]], c = mesh->xy[mesh->tri[t].v[2]];
    centroid[0] = (a.x + b.x + c.x) / 3;
    centroid[1] = (a.y + b.y + c.y) / 3;
    return ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
}

/* Area of the triangles with an odd number of crossings. `stays`: set to true if all triangles are of this kind. */
static double odd_area(const struct tri_mesh *mesh, const struct tri_pslg *pslg, bool *stays)
{
    double sum = 0, at[2];
    *stays = true;
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        double area = area_of(mesh, t, at);
        bool odd = crossings(pslg, at[0], at[1]) % 2;
        sum += odd ? area : 0;
        *stays = *stays && (odd || area < 1e-9); /* for thinner triangles rounding decides */
    }
    return sum;
}

static void add_ring(struct tri_pslg *pslg, int32_t n, struct support_random *random, bool lattice)
{
    int32_t first = pslg->n_points;
    for (int32_t k = 0; k < n; k++) {
        double x = support_unit(random), y = support_unit(random);
        support_add_point(pslg, lattice ? floor(6 * x) : 6 * x, lattice ? floor(6 * y) : 6 * y);
    }
    for (int32_t k = 0; k < n; k++)
        support_add_segment(pslg, first + k, first + (k + 1) % n);
}

static struct tri_mesh carved(const struct tri_pslg *pslg, const struct tri_carve_options *options)
{
    struct tri_constrain_report report;
    struct tri_error error = {0};
    struct tri_mesh mesh = support_constrained(pslg, &report);
    assert_int_equal(tri_carve(&mesh, pslg, options, &error), TRI_OK);
    if (tri_mesh_validate(&mesh, &error) != TRI_OK)
        fail_msg("%s", error.text);
    return mesh;
}

/* Rings that cross themselves and each other, and overlap on a lattice: the remaining area follows the even-odd
 * rule. */
static void test_rings_keep_the_even_odd_rule(void **state)
{
    (void)state;
    const struct tri_carve_options options = {.even_odd = true};
    for (uint64_t seed = 0; seed < 120; seed++) {
        struct support_random random = {seed};
        struct tri_pslg pslg = support_pslg(64, 64, 1, 1);
        struct tri_constrain_report report;
        bool stays, all;
        for (int ring = 0; ring < 4; ring++)
            add_ring(&pslg, 3 + support_below(&random, 8), &random, seed % 2);
        struct tri_mesh whole = support_constrained(&pslg, &report), mesh = carved(&pslg, &options);
        double wanted = odd_area(&whole, &pslg, &all), found = odd_area(&mesh, &pslg, &stays);
        assert_true(stays && !all && wanted > 0.1 && fabs(found - wanted) < 1e-8);
        assert_compact(&mesh, pslg.n_segments);
        tri_mesh_free(&whole);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

/* The lowest number of odd subsegments on a path from outside, by sweeps until nothing changes. */
static int32_t *naive_depths(const struct tri_mesh *mesh, bool keep_hull)
{
    int32_t *depth = calloc((size_t)mesh->n_triangles + 1, sizeof *depth);
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        depth[t] = INT32_MAX / 2;
    for (bool changed = true; changed;) {
        changed = false;
        for (int32_t t = 0; t < mesh->n_triangles; t++)
            for (int e = 0; e < 3; e++) {
                int32_t link = mesh->tri[t].n[e], other = tri_across(mesh, tri_code(t, e));
                const struct tri_parent *parent = link < 0 ? &mesh->parents[mesh->sub[~link].parent] : NULL;
                bool wall = parent && (parent->odd || (keep_hull && parent->segment == TRI_NONE));
                int32_t there = other == TRI_NONE ? 0 : depth[tri_of(other)];
                if (there + wall < depth[t]) {
                    depth[t] = there + wall;
                    changed = true;
                }
            }
    }
    return depth;
}

/* Rings with arbitrary other segments. */
static void test_depths_equal_naive_twin(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 80; seed++) {
        const struct tri_carve_options options = {.even_odd = true, .keep_hull = seed % 4 == 3};
        struct support_random random = {seed};
        struct tri_pslg pslg = support_pslg(64, 80, 1, 1);
        struct tri_constrain_report report;
        for (int ring = 0; ring < 3; ring++)
            add_ring(&pslg, 3 + support_below(&random, 8), &random, seed % 2);
        for (int k = 0; k < 12; k++)
            support_add_segment(&pslg, support_below(&random, pslg.n_points), support_below(&random, pslg.n_points));
        struct tri_mesh before = support_constrained(&pslg, &report), mesh = carved(&pslg, &options);
        int32_t *depth = naive_depths(&before, options.keep_hull);
        for (int32_t t = 0; t < before.n_triangles; t++)
            depth[t] = depth[t] % 2 ? 0 : TRI_NONE;
        assert_same_triangles(&before, depth, &mesh, TRI_NONE);
        free(depth);
        tri_mesh_free(&before);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

static void add_box(struct tri_pslg *pslg, double x, double y, double width, double height)
{
    int32_t first = support_add_point(pslg, x, y);
    support_add_point(pslg, x + width, y);
    support_add_point(pslg, x + width, y + height);
    support_add_point(pslg, x, y + height);
    for (int32_t k = 0; k < 4; k++)
        support_add_segment(pslg, first + k, first + (k + 1) % 4);
}

static double area_left(const struct tri_pslg *pslg, bool keep_hull)
{
    const struct tri_carve_options options = {.even_odd = true, .keep_hull = keep_hull};
    struct tri_mesh mesh = carved(pslg, &options);
    double sum = 0, at[2];
    for (int32_t t = 0; t < mesh.n_triangles; t++)
        sum += area_of(&mesh, t, at);
    tri_mesh_free(&mesh);
    return sum;
}

/* Boxes inside, beside and along each other. Each step adds a box to the previous ones. */
static void test_boxes(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_pslg(64, 64, 1, 1);
    add_box(&pslg, 0, 0, 8, 8);
    add_box(&pslg, 1, 1, 4, 4); /* a hole */
    assert_true(area_left(&pslg, false) == 48);
    add_box(&pslg, 2, 2, 1, 1); /* an island */
    assert_true(area_left(&pslg, false) == 49);
    add_box(&pslg, 8, 0, 2, 4); /* a neighbour that shares a part of the border */
    assert_true(area_left(&pslg, false) == 57);
    add_box(&pslg, 0, 6, 2, 2); /* a hole along the border */
    assert_true(area_left(&pslg, false) == 53);
    support_add_segment(&pslg, 0, 4); /* a segment that leads across to the hole and into it */
    support_add_segment(&pslg, 0, 8);
    assert_true(area_left(&pslg, false) == 53);
    assert_true(area_left(&pslg, true) == 53 + 4); /* the hull is a ring: the pocket at the corner stays */
    add_box(&pslg, 2, 2, 1, 1); /* the island again: a ring given twice does not count */
    assert_true(area_left(&pslg, false) == 52);
    tri_pslg_free(&pslg);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tangles_equal_naive_twin),
        cmocka_unit_test(test_polygons_equal_naive_twin),
        cmocka_unit_test(test_nested_rings),
        cmocka_unit_test(test_hole_points_in_odd_places),
        cmocka_unit_test(test_far_places_are_outside),
        cmocka_unit_test(test_holes_between_faces_empty_nothing),
        cmocka_unit_test(test_boundary_markers),
        cmocka_unit_test(test_rings_keep_the_even_odd_rule),
        cmocka_unit_test(test_depths_equal_naive_twin),
        cmocka_unit_test(test_boxes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
