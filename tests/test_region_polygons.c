/* Regions by polygons: each triangle is compared with the last polygon around its centroid, by naive means, and the
 * domain and the other regions with a mesh of the input alone. */
#include "triangle/api/region_polygons.h"

#include "allocations.h"
#include "support.h"
#include "triangle/base/grow.h"

static void add_feature(struct tri_polygons *p, double attribute, double max_area)
{
    assert_true(tri_grow(&p->features, &p->feature_capacity, p->n_features + 1, sizeof *p->features));
    p->features[p->n_features++] = (struct tri_feature){attribute, max_area};
}

/* Adds a ring to the last feature. fresh: it begins a polygon. */
static void add_ring(struct tri_polygons *p, bool fresh, const double (*at)[2], int32_t n)
{
    const int32_t polygon = p->n_rings > 0 ? p->rings[p->n_rings - 1].polygon + fresh : 0;
    assert_true(tri_grow(&p->points, &p->point_capacity, p->n_points + n, 2 * sizeof *p->points));
    assert_true(tri_grow(&p->rings, &p->ring_capacity, p->n_rings + 1, sizeof *p->rings));
    p->rings[p->n_rings++] = (struct tri_ring){p->n_points, p->n_points + n, polygon, p->n_features - 1};
    memcpy(&p->points[2 * p->n_points], at, 2 * (size_t)n * sizeof(double));
    p->n_points += n;
}

static void add_box(struct tri_polygons *p, bool fresh, double x, double y, double width, double height)
{
    const double at[][2] = {{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}};
    add_ring(p, fresh, at, 4);
}

/* Returns the last feature around a place; -1: none. *near: the square of the least distance from a ring. */
static int32_t feature_at(const struct tri_polygons *p, struct tri_point at, double *near)
{
    int32_t found = -1;
    bool inside = false;
    *near = HUGE_VAL;
    for (int32_t r = 0; r < p->n_rings; r++) {
        const int32_t first = p->rings[r].first, end = p->rings[r].end;
        for (int32_t k = first; k < end; k++) {
            const double *u = &p->points[2 * k], *v = &p->points[2 * (k + 1 < end ? k + 1 : first)];
            const struct tri_point a = {u[0], u[1]}, b = {v[0], v[1]};
            *near = fmin(*near, tri_segment_distance2(a, b, at));
            if ((a.y > at.y) != (b.y > at.y) && at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x))
                inside = !inside;
        }
        if (r + 1 < p->n_rings && p->rings[r + 1].polygon == p->rings[r].polygon)
            continue;
        found = inside ? p->rings[r].feature : found;
        inside = false;
    }
    return found;
}

/* Returns the triangle of a mesh that contains a place in the caller's coordinates; TRI_NONE: none. */
static tri_triangle_id triangle_at(const struct tri_mesh *mesh, struct tri_point at)
{
    const struct tri_point p = tri_to_units(mesh, at.x, at.y);
    for (tri_triangle_id t = 0; t < mesh->n_triangles; t++) {
        const tri_vertex_id *v = mesh->tri[t].v;
        const struct tri_point *xy = mesh->xy;
        if (tri_orient2d(xy[v[0]], xy[v[1]], p) >= 0 && tri_orient2d(xy[v[1]], xy[v[2]], p) >= 0 &&
            tri_orient2d(xy[v[2]], xy[v[0]], p) >= 0)
            return t;
    }
    return TRI_NONE;
}

static double area_of(const struct tri_mesh *mesh)
{
    double sum = 0;
    for (tri_triangle_id t = 0; t < mesh->n_triangles; t++) {
        const tri_vertex_id *v = mesh->tri[t].v;
        sum += tri_area_of(mesh->xy[v[0]], mesh->xy[v[1]], mesh->xy[v[2]]) * mesh->unit * mesh->unit;
    }
    return sum;
}

static struct tri_pslg copy_of(const struct tri_pslg *p)
{
    struct tri_pslg copy = support_pslg(p->n_points, p->n_segments, p->n_holes, p->n_regions);
    copy.n_points = p->n_points, copy.n_segments = p->n_segments;
    copy.n_holes = p->n_holes, copy.n_regions = p->n_regions;
    for (int32_t i = 0; i < 2 * p->n_points; i++)
        copy.points[i] = p->points[i];
    for (int32_t i = 0; i < 2 * p->n_segments; i++)
        copy.segments[i] = p->segments[i];
    for (int32_t i = 0; i < 2 * p->n_holes; i++)
        copy.holes[i] = p->holes[i];
    for (int32_t i = 0; i < 4 * p->n_regions; i++)
        copy.regions[i] = p->regions[i];
    return copy;
}

/* Divides a copy, meshes it, and compares. Returns the number of triangles that were compared. */
static int32_t check_divided(const struct tri_pslg *given, const struct tri_polygons *p, struct tri_options how)
{
    const double NEAR2 = 1e-20;
    struct tri_pslg divided = copy_of(given);
    how.use_segments = how.spread_regions = true;
    struct tri_mesh alone = {0};
    const bool is_union = given->n_segments == 0;
    if (!is_union)
        alone = support_generate(given, &how, NULL);
    assert_int_equal(tri_divide_by_polygons(&divided, p, &how, NULL), TRI_OK);
    assert_memory_equal(divided.points, given->points, 2 * (size_t)given->n_points * sizeof(double));
    struct tri_mesh mesh = support_generate(&divided, &how, NULL);
    int32_t compared = 0;
    for (tri_triangle_id t = 0; t < mesh.n_triangles; t++) {
        const tri_vertex_id *v = mesh.tri[t].v;
        const struct tri_point a = mesh.xy[v[0]], b = mesh.xy[v[1]], c = mesh.xy[v[2]];
        const struct tri_point at = {(a.x + b.x + c.x) / 3 * mesh.unit, (a.y + b.y + c.y) / 3 * mesh.unit};
        double near;
        const int32_t feature = feature_at(p, at, &near);
        if (near < NEAR2 || tri_area_of(a, b, c) * mesh.unit * mesh.unit < 1e-12)
            continue;
        const tri_triangle_id whole = is_union ? TRI_NONE : triangle_at(&alone, at);
        assert_true(is_union ? feature >= 0 : whole != TRI_NONE);
        const struct tri_region none = {0, 0}, *own = &mesh.regions[mesh.tri[t].region];
        const struct tri_region *outside = whole == TRI_NONE ? &none : &alone.regions[alone.tri[whole].region];
        assert_true(own->attribute == (feature < 0 ? outside->attribute : p->features[feature].attribute));
        assert_true(own->max_area == (feature < 0 ? outside->max_area : p->features[feature].max_area));
        compared++;
    }
    for (int32_t k = 0; is_union && k < p->n_points; k++) { /* places between points of rings */
        const double *u = &p->points[2 * k], *v = &p->points[2 * (k * 7 % p->n_points)];
        double near;
        const struct tri_point at = {0.45 * u[0] + 0.55 * v[0], 0.45 * u[1] + 0.55 * v[1]};
        const bool inside = feature_at(p, at, &near) >= 0;
        assert_true(near < NEAR2 || (triangle_at(&mesh, at) != TRI_NONE) == inside);
    }
    if (!is_union)
        assert_true(fabs(area_of(&mesh) - area_of(&alone)) <= 1e-9 * (1 + area_of(&alone)));
    tri_mesh_free(&alone);
    tri_mesh_free(&mesh);
    tri_pslg_free(&divided);
    return compared;
}

/* Random polygons, some with a hole ring, on a lattice if coarse: then many of their segments overlap. */
static struct tri_polygons random_polygons(int32_t n, bool coarse, double low, double size,
                                           struct support_random *random)
{
    struct tri_polygons p = {0};
    for (int32_t k = 0; k < n; k++) {
        add_feature(&p, 100 + k, 1 + support_unit(random));
        for (int32_t r = 0; r < 1 + k % 3; r++) {
            double at[9][2];
            const int32_t corners = 3 + support_below(random, 7);
            for (int32_t i = 0; i < corners; i++)
                for (int c = 0; c < 2; c++) {
                    const double x = low + size * support_unit(random);
                    at[i][c] = coarse ? floor(4 * x) / 4 : x;
                }
            add_ring(&p, r != 1, (const double (*)[2])at, corners);
        }
    }
    return p;
}

static void test_tangles_with_polygons(void **state)
{
    (void)state;
    int32_t compared = 0;
    for (uint64_t seed = 0; seed < 120; seed++) {
        struct support_random random = {seed};
        const bool coarse = seed % 2;
        struct tri_pslg pslg = support_tangle(coarse ? SUPPORT_LATTICE : SUPPORT_RANDOM, 12, 8, seed);
        const double low = pslg.points[0], size = -2 * low; /* the square around it */
        struct tri_polygons p = random_polygons(6, coarse, 1.2 * low, 1.2 * size, &random);
        for (int32_t k = 0; k < 2; k++) {
            pslg.holes[2 * k] = low + size * support_unit(&random);
            pslg.holes[2 * k + 1] = low + size * support_unit(&random);
            for (int32_t c = 0; c < 4; c++)
                pslg.regions[4 * k + c] = c < 2 ? low + size * support_unit(&random) : 1 + k;
        }
        pslg.n_holes = pslg.n_regions = seed % 3 ? 2 : 0;
        struct tri_options how = tri_defaults();
        how.even_odd = seed % 5 == 0;
        how.ignore_holes = seed % 7 == 0;
        compared += check_divided(&pslg, &p, how);
        pslg.n_segments = pslg.n_holes = pslg.n_regions = 0;
        how.even_odd = seed % 4 == 0;
        how.ignore_holes = false;
        compared += check_divided(&pslg, &p, how);
        tri_pslg_free(&pslg);
        tri_polygons_free(&p);
    }
    assert_true(compared > 5000);
}

static int32_t count_marked(const struct tri_pslg *p, int32_t marker)
{
    int32_t n = 0;
    for (int32_t i = 0; i < p->n_segments; i++)
        n += p->segment_markers[i] == marker;
    return n;
}

/* A square with a hole. Rings run along its border, through the hole point, and outside. The border of a feature's
 * overlapping polygons is one ring, and segments outside are left out. */
static void test_segments_that_remain(void **state)
{
    (void)state;
    struct tri_pslg p = support_square(8, 0, 1);
    struct tri_polygons q = {0};
    struct tri_options how = tri_defaults();
    p.segment_markers = malloc(8 * sizeof *p.segment_markers);
    p.markers = malloc(8 * sizeof *p.markers);
    assert_true(p.segment_markers && p.markers && p.n_points == 4 && p.n_segments == 4);
    assert_true(tri_resize(&p.points, 8, 2 * sizeof *p.points) && tri_resize(&p.segments, 8, 2 * sizeof *p.segments));
    assert_true(tri_resize(&p.holes, 2, sizeof *p.holes));
    for (int32_t k = 0; k < 4; k++) {
        support_add_point(&p, k == 1 || k == 2 ? 6 : 5, k > 1 ? 6 : 5);
        support_add_segment(&p, 4 + k, 4 + (k + 1) % 4);
    }
    for (int32_t k = 0; k < 8; k++)
        p.segment_markers[k] = p.markers[k] = 1 + k;
    p.holes[0] = p.holes[1] = 5.5;
    p.n_holes = 1;
    add_feature(&q, 10, 0);
    add_box(&q, true, -3, -3, 6, 6);  /* the quarter (0, 0) .. (3, 3) */
    add_box(&q, true, 2, 0, 2, 4);    /* overlaps it, and ends on the border */
    add_feature(&q, 11, 0);
    add_box(&q, true, 5.5, 4.5, 1, 2); /* through the hole point */
    add_feature(&q, 12, 0);
    add_box(&q, true, 9, 9, 1e16, 1e16); /* outside, and far away */
    check_divided(&p, &q, how);
    assert_int_equal(tri_divide_by_polygons(&p, &q, &how, NULL), TRI_OK);
    for (int32_t i = 0; i < p.n_points; i++)
        assert_int_equal(p.markers[i], i < 8 ? 1 + i : 0);
    for (int32_t marker = 1; marker <= 8; marker++) { /* pieces of the given segments */
        static const int32_t pieces[] = {4, 1, 1, 2, 2, 1, 2, 1};
        assert_int_equal(count_marked(&p, marker), pieces[marker - 1]);
    }
    /* (0, 3) (2, 3) (2, 4) (4, 4) (4, 0); (5.5, 5) (5.5, 4.5) (6.5, 4.5) (6.5, 6.5) (5.5, 6.5) (5.5, 6) */
    assert_int_equal(count_marked(&p, 0), 4 + 5);
    tri_polygons_free(&q);
    tri_pslg_free(&p);
}

/* A row of boxes whose common borders differ in the last bits has no gaps, and one border between two boxes. */
static void test_slivers_join_a_neighbour(void **state)
{
    (void)state;
    struct support_random random = {7};
    for (int round = 0; round < 20; round++) {
        struct tri_polygons q = {0};
        struct tri_pslg p = {0};
        struct tri_options how = tri_defaults();
        for (int32_t k = 0; k < 6; k++) {
            double at[8][2];
            for (int32_t i = 0; i < 8; i++) { /* four points on each side, up and down */
                const int32_t row = i < 4 ? i : 7 - i;
                at[i][0] = 0.1 * (i < 4 ? k + 1 : k) + row / 30.0 + ldexp(support_unit(&random), -52);
                at[i][1] = row / 3.0;
            }
            add_feature(&q, k, 0);
            add_ring(&q, true, (const double (*)[2])at, 8);
        }
        assert_int_equal(tri_divide_by_polygons(&p, &q, &how, NULL), TRI_OK);
        how.use_segments = how.spread_regions = true;
        struct tri_mesh mesh = support_generate(&p, &how, NULL);
        double areas[6] = {0};
        for (tri_triangle_id t = 0; t < mesh.n_triangles; t++) {
            const tri_vertex_id *v = mesh.tri[t].v;
            assert_true(mesh.tri[t].region > 0);
            areas[(int)mesh.regions[mesh.tri[t].region].attribute] +=
                tri_area_of(mesh.xy[v[0]], mesh.xy[v[1]], mesh.xy[v[2]]) * mesh.unit * mesh.unit;
        }
        for (int32_t k = 0; k < 6; k++)
            assert_true(fabs(areas[k] - 0.1) < 1e-14);
        tri_mesh_free(&mesh);
        tri_pslg_free(&p);
        tri_polygons_free(&q);
    }
}

static void test_refusals(void **state)
{
    (void)state;
    struct tri_pslg p = support_square(1, 3, 1);
    struct tri_polygons q = {0};
    const struct tri_options how = tri_defaults();
    struct tri_error error;
    add_feature(&q, 1, 0);
    add_box(&q, true, 0, 0, 0.5, 0.5);
    support_add_attributes(&p);
    assert_int_equal(tri_divide_by_polygons(&p, &q, &how, &error), TRI_BAD_INPUT);
    assert_non_null(strstr(error.text, "attributes"));
    tri_polygons_free(&q);
    tri_pslg_free(&p);
}

#ifdef SUPPORT_WRAP
static void test_failing_allocations(void **state)
{
    (void)state;
    struct support_random random = {1};
    const struct tri_options how = tri_defaults();
    int failures = 0;
    for (bool failed = true; failed; failures += failed) {
        const int64_t before = support_held;
        struct tri_pslg p = support_square(1, 3, 1);
        struct tri_polygons q = random_polygons(3, false, 0, 1, &random);
        support_calls = 0;
        support_fail_at = failures + 1;
        const enum tri_status status = tri_divide_by_polygons(&p, &q, &how, NULL);
        failed = support_calls > failures;
        support_fail_at = INT64_MAX;
        assert_int_equal(status, failed ? TRI_NO_MEMORY : TRI_OK);
        tri_polygons_free(&q);
        tri_pslg_free(&p);
        assert_int_equal(support_held, before);
    }
    assert_true(failures > 20);
}
#endif

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tangles_with_polygons),
        cmocka_unit_test(test_segments_that_remain),
        cmocka_unit_test(test_slivers_join_a_neighbour),
        cmocka_unit_test(test_refusals),
#ifdef SUPPORT_WRAP
        cmocka_unit_test(test_failing_allocations),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
