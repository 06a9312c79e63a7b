/* The target lengths of edges, compared with naive twins that examine all segments, nodes or vertices. */
#include <stdio.h>

#include "support.h"
#include "triangle/size/lengths.h"
#include "triangle/size/sources.h"

/* A triangulation of a square of this side, with n random points and segments with markers 2 and 3 between them. */
static struct tri_mesh square_mesh(double side, int32_t n, uint64_t seed)
{
    struct support_random random = {seed};
    struct tri_pslg pslg = support_pslg(4 + n, 4 + n, 0, 0);
    pslg.segment_markers = calloc((size_t)n + 4, sizeof *pslg.segment_markers);
    assert_non_null(pslg.segment_markers);
    for (int k = 0; k < 4; k++)
        support_add_point(&pslg, k == 1 || k == 2 ? side : 0, k >= 2 ? side : 0);
    for (int32_t i = 0; i < n; i++)
        support_add_point(&pslg, side * support_unit(&random), side * support_unit(&random));
    for (int32_t k = 0; k < 4; k++)
        support_add_segment(&pslg, k, (k + 1) % 4);
    for (int32_t i = 0; i < n / 2; i++) {
        pslg.segment_markers[pslg.n_segments] = 2 + support_below(&random, 2);
        support_add_segment(&pslg, 4 + 2 * i, 4 + 2 * i + 1);
    }
    struct tri_options options = tri_defaults();
    options.use_segments = true;
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    tri_pslg_free(&pslg);
    return mesh;
}

static struct tri_point place(struct support_random *random, double side)
{
    return (struct tri_point){side * support_unit(random), side * support_unit(random)};
}

static struct tri_lengths *lengths_of(const struct tri_mesh *mesh, const struct tri_sizes *sizes)
{
    struct tri_lengths *lengths;
    struct tri_error error = {.text = ""};
    const enum tri_status status = tri_lengths_new(&lengths, sizes, mesh, NULL, &error);
    if (status)
        print_message("%s\n", error.text);
    assert_int_equal(status, TRI_OK);
    return lengths;
}

/* --- near */

static double distance(struct tri_point a, struct tri_point b, struct tri_point p)
{
    const double x = b.x - a.x, y = b.y - a.y, l2 = x * x + y * y;
    const double t = l2 > 0 ? fmin(fmax(((p.x - a.x) * x + (p.y - a.y) * y) / l2, 0), 1) : 0;
    return hypot(p.x - a.x - t * x, p.y - a.y - t * y);
}

/* Random segments, some of length 0, and n_equal copies of the last one. */
static void check_items(int32_t n, int32_t n_equal, double length, double growth, bool same, uint64_t seed)
{
    struct support_random random = {seed};
    struct tri_near near = {0};
    struct tri_mesh mesh = {.unit = 1};
    const struct tri_size_frame frame = {&mesh, {0, 0}, {3, 1}, 0.2, NULL};
    const double reach = n > 100 ? 0.1 : 1;
    for (int32_t i = 0; i < n; i++) {
        struct tri_point a = {3 * support_unit(&random), support_unit(&random)}, b = a;
        if (i % 5) {
            b.x += reach * support_unit(&random);
            b.y += reach * support_unit(&random);
        }
        const double l = same ? length : length * (1 + 4 * support_unit(&random));
        const double g = same ? growth : growth * support_unit(&random);
        for (int32_t k = 0; k < (i == n - 1 ? n_equal : 1); k++)
            assert_true(tri_near_add(&near, a, b, l, g));
    }
    assert_int_equal(tri_near_settle(&near, &frame, NULL), TRI_OK);
    int32_t exact = 0, all = 4000;
    double worst = 0;
    for (int32_t k = 0; k < all; k++) {
        const struct tri_point p = {3 * support_unit(&random), support_unit(&random)};
        double naive = HUGE_VAL;
        for (int32_t i = 0; i < near.n; i++) {
            const struct tri_near_item *s = &near.item[i];
            const struct tri_point b = {s->from.x + s->along.x, s->from.y + s->along.y};
            naive = fmin(naive, s->length + s->growth * distance(s->from, b, p));
        }
        const double h = tri_near_at(&near, p);
        exact += fabs(h / naive - 1) < 1e-12;
        worst = fmax(worst, h / naive - 1);
        assert_true(h > naive * (1 - 1e-12) && h < naive * 1.02);
    }
    print_message("  %d items: %.4f exact, else within %.4f, %d numbers in lists\n", near.n, (double)exact / all, worst,
                  near.candidates.n);

    tri_near_clear(&near);
}

static void test_near_items_equal_naive_twin(void **state)
{
    (void)state;
    check_items(1, 1, 0.01, 0.2, true, 1);
    check_items(20, 1, 0.01, 0.2, false, 2);
    check_items(20, 12, 0.01, 0.2, true, 3);
    check_items(2000, 1, 0.001, 0.15, true, 4);
    check_items(2000, 40, 0.1, 0.15, true, 5);
    check_items(2000, 1, 0.02, 0.3, false, 6);
    check_items(300, 10, 0.02, 0, false, 7);
}

/* The centre of a circle has the same distance from all its segments, and a fan has many segments at one point. The
 * search must end. */
static void test_ties_end(void **state)
{
    (void)state;
    for (int fan = 0; fan < 2; fan++) {
        struct tri_near near = {0};
        struct tri_mesh mesh = {.unit = 1};
        const struct tri_size_frame frame = {&mesh, {-1, -1}, {1, 1}, 0.2, NULL};
        const int n = 500;
        for (int i = 0; i < n; i++) {
            const double angle = 6.283185307179586 * i / n, next = 6.283185307179586 * (i + 1) / n;
            struct tri_point a = {cos(angle), sin(angle)}, b = {cos(next), sin(next)};
            assert_true(tri_near_add(&near, a, fan ? (struct tri_point){0, 0} : b, 1e-3, 0.2));
        }
        assert_int_equal(tri_near_settle(&near, &frame, NULL), TRI_OK);
        assert_true(near.candidates.n < 1000000);
        print_message("  %s: %d numbers in lists\n", fan ? "fan" : "circle", near.candidates.n);
        for (int i = 0; i <= 100; i++) {
            const struct tri_point p = {1e-4 * i, 1e-5 * i};
            const double h = fan ? 1e-3 : 1e-3 + 0.2 * (1 - hypot(p.x, p.y));
            assert_true(fabs(tri_near_at(&near, p) / h - 1) < 0.02);
        }
        tri_near_clear(&near);
    }
}

/* Many items are divided into tasks. Their order does not change the result. */
static void test_tasks_make_the_same_lists(void **state)
{
    (void)state;
    enum { MANY = 10000 };
    struct tri_near near[2] = {{.n = 0}, {.n = 0}};
    struct tri_mesh mesh = {.unit = 1};
    for (int which = 0; which < 2; which++) {
        struct support_random random = {11};
        const struct tri_size_frame frame = {&mesh, {0, 0}, {1, 1}, 0.2, which ? &support_backwards : NULL};
        for (int i = 0; i < MANY; i++) {
            const struct tri_point p = place(&random, 1);
            assert_true(tri_near_add(&near[which], p, p, 0.001 + 0.01 * support_unit(&random), 0.2));
        }
        assert_int_equal(tri_near_settle(&near[which], &frame, NULL), TRI_OK);
    }
    const struct tri_candidates *a = &near[0].candidates, *b = &near[1].candidates;
    assert_true(a->n == b->n && a->tree.n == b->tree.n);
    assert_memory_equal(a->list, b->list, (size_t)a->n * sizeof *a->list);
    assert_memory_equal(a->tree.child, b->tree.child, (size_t)a->tree.n * sizeof *a->tree.child);
    struct support_random random = {12};
    for (int k = 0; k < 500; k++) {
        const struct tri_point p = place(&random, 1);
        double naive = HUGE_VAL;
        for (int i = 0; i < MANY; i++)
            naive = fmin(naive, near[0].item[i].length + 0.2 * sqrt(tri_distance2(near[0].item[i].from, p)));
        assert_true(fabs(tri_near_at(&near[0], p) / naive - 1) < 0.02);
    }
    tri_near_clear(&near[0]);
    tri_near_clear(&near[1]);
}

static void test_segments_with_a_marker(void **state)
{
    (void)state;
    struct tri_mesh mesh = square_mesh(4, 60, 8);
    static const double growth[4] = {0, -1, 0.05, 3}; /* the last value is limited */
    for (int32_t marker = 1; marker <= 3; marker++) {
        const struct tri_size_field fields[] = {
            {.kind = TRI_SIZE_NEAR, .length = 0.01 * marker, .growth = growth[marker], .marker = marker},
            {.kind = TRI_SIZE_NUMBER, .length = 0.2}};
        const struct tri_sizes sizes = {.fields = fields, .n = 2, .gradation = 0.1, .min_size = 0.015};
        struct tri_lengths *lengths = lengths_of(&mesh, &sizes);
        struct support_random random = {9};
        assert_true(tri_lengths_uniform(lengths) == 0);
        for (int k = 0; k < 1000; k++) {
            const struct tri_point p = place(&random, 4);
            double nearest = HUGE_VAL;
            for (int32_t s = 0; s < mesh.n_subs; s++) {
                const struct tri_point a = mesh.xy[mesh.sub[s].v[0]], b = mesh.xy[mesh.sub[s].v[1]];
                if (mesh.sub[s].marker == marker || (marker == 1 && tri_is_boundary(&mesh.sub[s])))
                    nearest = fmin(nearest, distance(a, b, p));
            }
            const double grown = 0.01 * marker + (marker == 2 ? 0.05 : 0.1) * nearest;
            const double h = fmax(fmin(grown, 0.2), 0.015);
            const double got = tri_lengths_at(lengths, p);
            assert_true(got > h * (1 - 1e-12) && got < h * 1.02);
        }
        tri_lengths_free(lengths);
    }
    const struct tri_size_field absent = {.kind = TRI_SIZE_NEAR, .length = 0.01, .growth = 0, .marker = 77};
    struct tri_error error;
    struct tri_lengths *none;
    assert_int_equal(tri_lengths_new(&none, &(struct tri_sizes){.fields = &absent, .n = 1}, &mesh, NULL, &error),
                     TRI_BAD_INPUT);
    assert_null(none);
    assert_string_equal(error.text, "sizes[0], near segments: no segment has the marker 77");
    tri_mesh_free(&mesh);
}

/* --- rasters */

/* The limited values, from all nodes for each node. Gaps get the value of the nearest node. */
static void limit_naively(const struct tri_size_field *f, double gradation, double *out)
{
    const int64_t w = f->values.width, n = w * f->values.n;
    double *full = malloc((size_t)n * sizeof *full);
    assert_non_null(full);
    for (int pass = 0; pass < 2; pass++)
        for (int64_t k = 0; k < n; k++) {
            double least = HUGE_VAL;
            for (int64_t i = 0; i < n; i++) {
                const double d = hypot((double)(k % w - i % w) * f->step[0], (double)(k / w - i / w) * f->step[1]);
                const double value = pass ? full[i] : f->values.at[i];
                if (pass)
                    least = fmin(least, i == k ? value : value + gradation * d);
                else if (value > 0 && d < least) {
                    least = d;
                    full[k] = value;
                }
            }
            if (pass)
                out[k] = least;
        }
    free(full);
}

static double bilinear(const struct tri_size_field *f, const double *value, struct tri_point p)
{
    const int64_t w = f->values.width, h = f->values.n;
    const double x = fmin(fmax((p.x - f->origin[0]) / f->step[0], 0), (double)(w - 1));
    const double y = fmin(fmax((p.y - f->origin[1]) / f->step[1], 0), (double)(h - 1));
    const int64_t i = (int64_t)x, j = (int64_t)y, i1 = i + (i + 1 < w), j1 = j + (j + 1 < h);
    const double u = x - (double)i, v = y - (double)j;
    return (1 - v) * ((1 - u) * value[j * w + i] + u * value[j * w + i1]) +
           v * ((1 - u) * value[j1 * w + i] + u * value[j1 * w + i1]);
}

static void check_raster(int64_t w, int64_t h, double gaps, double gradation, uint64_t seed)
{
    struct support_random random = {seed};
    struct tri_mesh mesh = square_mesh(1000, 10, 1);
    double *values = malloc((size_t)(w * h) * sizeof *values), *limited = malloc((size_t)(w * h) * sizeof *limited);
    const double none[] = {NAN, 0, -9999};
    assert_true(values && limited);
    for (int64_t k = 0; k < w * h; k++) {
        const bool is_gap = k > 0 && support_unit(&random) < gaps;
        const double length = support_below(&random, 20) ? 100 : 1 + 50 * support_unit(&random);
        values[k] = is_gap ? none[support_below(&random, 3)] : length;
    }
    const struct tri_size_field f = {.kind = TRI_SIZE_RASTER, .values = tri_reals_of(values, h, w),
                                     .origin = {100, -50}, .step = {700 / (double)w, 1100 / (double)h}};
    struct tri_lengths *lengths = lengths_of(&mesh, &(struct tri_sizes){.fields = &f, .n = 1, .gradation = gradation});
    limit_naively(&f, gradation, limited);
    double worst = 0;
    for (int k = 0; k < 4000; k++) {
        const struct tri_point p = place(&random, 1000), q = {p.x / mesh.unit, p.y / mesh.unit};
        worst = fmax(worst, fabs(tri_lengths_at(lengths, q) * mesh.unit / bilinear(&f, limited, p) - 1));
    }
    print_message("  %d x %d: %g\n", (int)w, (int)h, worst);
    assert_true(worst < 3e-3);
    assert_non_null(strstr(tri_lengths_note(lengths), "sizes[0] covers ("));
    tri_lengths_free(lengths);
    free(values);
    free(limited);
    tri_mesh_free(&mesh);
}

static void test_rasters_equal_naive_twin(void **state)
{
    (void)state;
    check_raster(1, 1, 0, 0.2, 1);
    check_raster(40, 1, 0, 0.2, 2);
    check_raster(1, 40, 0.3, 0.2, 3);
    check_raster(50, 40, 0, 0.2, 4);
    check_raster(30, 70, 0.5, 0.1, 5);
    check_raster(60, 30, 0.9, HUGE_VAL, 6);
    check_raster(60, 60, 0.01, 1, 7);
}

/* --- background meshes */

/* The value at the nearest point of all triangles, found naively. */
static double linear_naively(const struct tri_size_field *f, const double *value, struct tri_point p)
{
    double nearest = HUGE_VAL, found = 0;
    for (int64_t t = 0; t < f->triangles.n; t++) {
        const int32_t *v = f->triangles.at + 3 * t;
        struct tri_point c[3];
        double w[3], sum = 0;
        for (int k = 0; k < 3; k++)
            c[k] = (struct tri_point){f->points.at[2 * v[k]], f->points.at[2 * v[k] + 1]};
        for (int k = 0; k < 3; k++) {
            w[k] = tri_area_of(p, c[tri_next[k]], c[tri_prev[k]]);
            sum += w[k];
        }
        const bool inside = sum != 0 && w[0] / sum >= 0 && w[1] / sum >= 0 && w[2] / sum >= 0;
        if (inside && nearest > 0) {
            nearest = 0;
            found = (w[0] * value[v[0]] + w[1] * value[v[1]] + w[2] * value[v[2]]) / sum;
        }
        for (int k = 0; k < 3; k++) {
            const struct tri_point a = c[k], b = c[tri_next[k]];
            const double l2 = tri_distance2(a, b), d = distance(a, b, p);
            const double dot = (p.x - a.x) * (b.x - a.x) + (p.y - a.y) * (b.y - a.y);
            if (d < nearest) {
                nearest = d;
                found = value[v[k]] + (l2 > 0 ? fmin(fmax(dot / l2, 0), 1) : 0) * (value[v[tri_next[k]]] - value[v[k]]);
            }
        }
    }
    return found;
}

/* Points given twice are corners once. */
static bool is_corner(const struct tri_size_field *f, int32_t v)
{
    for (int64_t i = 0; i < 3 * f->triangles.n; i++)
        if (f->triangles.at[i] == v)
            return true;
    return false;
}

/* Checks n points in a part of the mesh with their triangulation. Some have no data, and each length is limited by all
 * others. */
static void check_background(int32_t n, double gaps, double gradation, enum support_kind kind, uint64_t seed)
{
    struct support_random random = {seed};
    struct tri_mesh mesh = square_mesh(4, 10, 1);
    struct tri_pslg pslg = support_points(kind, n, seed);
    struct tri_mesh own = support_delaunay(&pslg, 0, NULL);
    const size_t n_own = (size_t)own.n_vertices;
    double *at = malloc(2 * n_own * sizeof *at), *value = malloc(n_own * sizeof *value);
    double *limited = malloc(n_own * sizeof *limited);
    int32_t *corner = malloc(3 * (size_t)own.n_triangles * sizeof *corner);
    double reach = 1;
    assert_true(at && value && limited && corner);
    for (int32_t v = 0; v < own.n_vertices; v++)
        reach = fmax(reach, fmax(fabs(own.xy[v].x), fabs(own.xy[v].y)) * own.unit);
    for (int32_t v = 0; v < own.n_vertices; v++) {
        at[2 * v] = 1 + own.xy[v].x * own.unit / reach;
        at[2 * v + 1] = 1 + own.xy[v].y * own.unit / reach;
        value[v] = support_below(&random, 10) ? 0.3 : 0.01 + 0.1 * support_unit(&random);
        if (v > 0 && support_unit(&random) < gaps)
            value[v] = NAN;
    }
    int32_t n_triangles = 0;
    for (int32_t t = 0; t < own.n_triangles; t++)
        for (int k = 0; k < 3; k++) /* every other triangle is reversed */
            corner[3 * n_triangles + (t % 2 ? k : 2 - k)] = own.tri[t].v[k], n_triangles += k == 2;
    const struct tri_size_field f = {.kind = TRI_SIZE_MESH, .points = tri_reals_of(at, own.n_vertices, 2),
                                     .values = tri_reals_of(value, own.n_vertices, 1),
                                     .triangles = tri_ints_of(corner, n_triangles, 3)};
    struct tri_lengths *lengths = lengths_of(&mesh, &(struct tri_sizes){.fields = &f, .n = 1, .gradation = gradation});
    for (int32_t v = 0; v < own.n_vertices; v++) {
        limited[v] = HUGE_VAL;
        for (int32_t w = 0; w < own.n_vertices; w++) {
            const double d = hypot(at[2 * v] - at[2 * w], at[2 * v + 1] - at[2 * w + 1]);
            if (w != v && gaps == 0 && is_corner(&f, w))
                limited[v] = fmin(limited[v], value[w] + gradation * d);
        }
        limited[v] = fmin(limited[v], value[v]);
    }
    double worst = 0;
    for (int k = 0; k < 3000 && gaps == 0; k++) {
        const struct tri_point p = place(&random, 4), q = {p.x / mesh.unit, p.y / mesh.unit};
        worst = fmax(worst, fabs(tri_lengths_at(lengths, q) * mesh.unit / linear_naively(&f, limited, p) - 1));
    }
    for (int32_t v = 0; kind == SUPPORT_RANDOM && v < own.n_vertices; v++) { /* gaps get the value of another point */
        const struct tri_point q = {at[2 * v] / mesh.unit, at[2 * v + 1] / mesh.unit};
        const double h = tri_lengths_at(lengths, q) * mesh.unit;
        assert_true(h > 0.0099 && h < 0.3001 && (isnan(value[v]) || h < value[v] * (1 + 1e-6)));
    }
    print_message("  %d triangles: %g\n", n_triangles, worst);
    assert_true(worst < 0.01 || kind == SUPPORT_NEAR_LINE); /* nearly flat: any edge may be nearest */
    tri_lengths_free(lengths);
    free(at);
    free(value);
    free(limited);
    free(corner);
    tri_pslg_free(&pslg);
    tri_mesh_free(&own);
    tri_mesh_free(&mesh);
}

static void test_meshes_equal_naive_twin(void **state)
{
    (void)state;
    check_background(3, 0, 0.2, SUPPORT_RANDOM, 1);
    check_background(300, 0, 0.2, SUPPORT_RANDOM, 2);
    check_background(300, 0, HUGE_VAL, SUPPORT_RANDOM, 3);
    check_background(300, 0.5, 0.2, SUPPORT_RANDOM, 4);
    check_background(200, 0, 0.2, SUPPORT_LATTICE, 5);
    check_background(200, 0, 0.2, SUPPORT_RING, 6);
    check_background(60, 0, 0.2, SUPPORT_NEAR_LINE, 7);
}

/* Points without triangles, and triangles without common corners. */
static void test_loose_points_and_triangles(void **state)
{
    (void)state;
    enum { POINTS = 50 };
    struct tri_mesh mesh = square_mesh(4, 10, 1);
    struct support_random random = {3};
    double at[2 * POINTS], value[POINTS];
    for (int k = 0; k < POINTS; k++) {
        at[2 * k] = 4 * support_unit(&random);
        at[2 * k + 1] = 4 * support_unit(&random);
        value[k] = 0.01 + support_unit(&random);
    }
    struct tri_size_field f = {.kind = TRI_SIZE_MESH, .points = tri_reals_of(at, POINTS, 2),
                               .values = tri_reals_of(value, POINTS, 1)};
    struct tri_lengths *lengths = lengths_of(&mesh, &(struct tri_sizes){.fields = &f, .n = 1, .gradation = 0.2});
    for (int i = 0; i < 1000; i++) {
        const struct tri_point p = place(&random, 4);
        double nearest = HUGE_VAL, h = HUGE_VAL, least = HUGE_VAL;
        for (int k = 0; k < POINTS; k++) {
            const double d = hypot(p.x - at[2 * k], p.y - at[2 * k + 1]);
            h = d < nearest ? value[k] : h;
            nearest = fmin(nearest, d);
            least = fmin(least, value[k] + 0.2 * d);
        }
        assert_true(fabs(tri_lengths_at(lengths, (struct tri_point){p.x / mesh.unit, p.y / mesh.unit}) * mesh.unit /
                             fmin(h, least) - 1) < 0.02);
    }
    tri_lengths_free(lengths);
    /* Two triangles cover the square. The short length at a corner of one reaches the far corner of the other. */
    const double square[] = {0, 0, 4, 0, 0, 4, 4, 4, 4, 0, 0, 4}, given[] = {0.1, 9, 9, 9, 9, 9};
    const int32_t corners[] = {0, 1, 2, 3, 4, 5};
    f = (struct tri_size_field){.kind = TRI_SIZE_MESH, .points = tri_reals_of(square, 6, 2),
                                .values = tri_reals_of(given, 6, 1), .triangles = tri_ints_of(corners, 2, 3)};
    lengths = lengths_of(&mesh, &(struct tri_sizes){.fields = &f, .n = 1, .gradation = 0.2});
    const double far = tri_lengths_at(lengths, (struct tri_point){4 / mesh.unit, 4 / mesh.unit}) * mesh.unit;
    assert_true(fabs(far - (0.1 + 0.2 * sqrt(32))) < 1e-9);
    tri_lengths_free(lengths);
    /* Values of very different size: interpolated values stay above 0. */
    const double apart[] = {5.5e-17, 9.6e8, 1.8e31, 5.5e-17, 1, 2};
    f = (struct tri_size_field){.kind = TRI_SIZE_RASTER, .values = tri_reals_of(apart, 3, 2), .step = {4, 2}};
    lengths = lengths_of(&mesh, &(struct tri_sizes){.fields = &f, .n = 1, .gradation = HUGE_VAL});
    for (int i = 0; i < 1000; i++) {
        struct tri_point p = place(&random, 4);
        p = (struct tri_point){i % 2 ? 4 : p.x, i % 3 ? 2 : p.y};
        assert_true(tri_lengths_at(lengths, (struct tri_point){p.x / mesh.unit, p.y / mesh.unit}) > 0);
    }
    tri_lengths_free(lengths);
    tri_mesh_free(&mesh);
}

/* --- functions */

struct asked {
    int which;        /* which function, 0 .. 3 */
    int calls;        /* number of calls */
    int64_t places;   /* number of points in all calls */
    double at[20][3]; /* points and lengths from which other lengths grow */
};

static double function_at(const struct asked *a, double x, double y)
{
    double h = HUGE_VAL;
    for (int k = 0; k < 20; k++)
        h = fmin(h, a->at[k][2] + 0.2 * hypot(x - a->at[k][0], y - a->at[k][1]));
    switch (a->which) {
    case 0: return h;
    case 1: return 0.05 + 0.04 * sin(3 * x) * cos(5 * y);
    case 2: return x < 2 ? 0.02 : HUGE_VAL; /* will be limited */
    case 3: return x < 2 ? 0.02 + 0.01 * y : NAN;
    default: return -1;
    }
}

static void ask_function(void *user, int64_t n, const double (*at)[2], double *length)
{
    struct asked *a = user;
    a->calls++;
    a->places += n;
    for (int64_t i = 0; i < n; i++) {
        assert_true(at[i][0] >= 0 && at[i][0] <= 4 && at[i][1] >= 0 && at[i][1] <= 4);
        length[i] = function_at(a, at[i][0], at[i][1]);
    }
}

/* The value after limiting. */
static double limited_function(const struct asked *a, double x, double y)
{
    if (a->which == 2)
        return 0.02 + 0.2 * fmax(x - 2, 0);
    return a->which == 3 ? 0.02 + 0.01 * y : function_at(a, x, y);
}

static bool is_asked_thrice(void *user) { return ((struct asked *)user)->calls >= 3; }

static void test_sampled_functions_are_accurate(void **state)
{
    (void)state;
    struct tri_mesh mesh = square_mesh(4, 10, 1);
    struct support_random random = {5};
    struct asked a = {0};
    const struct tri_size_field f = {.kind = TRI_SIZE_FUNCTION, .function = ask_function, .user = &a};
    const struct tri_sizes sizes = {.fields = &f, .n = 1, .gradation = 0.2};
    struct tri_lengths *lengths;
    for (int k = 0; k < 20; k++)
        for (int i = 0; i < 3; i++)
            a.at[k][i] = i < 2 ? 4 * support_unit(&random) : 0.002 + 0.01 * support_unit(&random);
    for (a.which = 0; a.which < 4; a.which++) {
        double worst = 0, mean = 0;
        a.calls = 0;
        a.places = 0;
        lengths = lengths_of(&mesh, &sizes);
        for (int k = 0; k < 20000; k++) {
            const struct tri_point p = place(&random, 4), q = {p.x / mesh.unit, p.y / mesh.unit};
            const double h = limited_function(&a, p.x, p.y);
            const double error = fabs(tri_lengths_at(lengths, q) * mesh.unit / h - 1);
            worst = fmax(worst, error);
            mean += error / 20000;
        }
        print_message("  %d: %d calls, %d places: mean %.4f, largest %.4f\n", a.which, a.calls, (int)a.places, mean,
                      worst);
        assert_true(worst < 0.05 && mean < 0.005 && a.calls < 60 && a.places < 3500000);
        assert_string_equal(tri_lengths_note(lengths), "");
        tri_lengths_free(lengths);
    }
    struct tri_error error;
    assert_int_equal(tri_lengths_new(&lengths, &sizes, &mesh, NULL, &error), TRI_BAD_INPUT);
    assert_string_equal(error.text, "sizes[0], a function: it returned no length above 0");
    a = (struct asked){.which = 0};
    const struct tri_stop stop = {is_asked_thrice, &a};
    mesh.stop = &stop;
    assert_int_equal(tri_lengths_new(&lengths, &sizes, &mesh, NULL, &error), TRI_STOPPED);
    assert_int_equal(a.calls, 3);
    tri_mesh_free(&mesh);
}

/* --- lengths derived from the figure */

static struct tri_mesh mesh_of(struct tri_pslg *pslg, bool spread_regions)
{
    struct tri_options options = tri_defaults();
    options.use_segments = true;
    options.spread_regions = spread_regions;
    struct tri_mesh mesh = support_generate(pslg, &options, NULL);
    tri_pslg_free(pslg);
    return mesh;
}

static double at_place(const struct tri_lengths *lengths, const struct tri_mesh *mesh, double x, double y)
{
    return tri_lengths_at(lengths, (struct tri_point){x / mesh->unit, y / mesh->unit}) * mesh->unit;
}

static void add_ring(struct tri_pslg *pslg, int n, double radius, double roughness)
{
    struct support_random random = {7};
    const int32_t first = pslg->n_points;
    for (int i = 0; i < n; i++) {
        const double angle = 6.283185307179586 * i / n, r = radius * (1 + roughness * (support_unit(&random) - 0.5));
        support_add_point(pslg, r * cos(angle), r * sin(angle));
        support_add_segment(pslg, first + i, first + (i + 1) % n);
    }
}

static void test_lengths_grow_from_regions(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_pslg(6, 7, 0, 2);
    static const double xy[6][2] = {{0, 0}, {1, 0}, {4, 0}, {4, 2}, {1, 2}, {0, 2}};
    const double regions[] = {0.5, 1, 1, 0.001, 3, 1, 2, 0.5};
    for (int k = 0; k < 6; k++) {
        support_add_point(&pslg, xy[k][0], xy[k][1]);
        support_add_segment(&pslg, k, (k + 1) % 6);
    }
    support_add_segment(&pslg, 1, 4);
    memcpy(pslg.regions, regions, sizeof regions);
    pslg.n_regions = 2;
    struct tri_mesh mesh = mesh_of(&pslg, true);
    struct tri_sizes sizes = {.max_size = 0.4, .gradation = 0.1, .region_areas = true};
    struct tri_lengths *lengths = lengths_of(&mesh, &sizes);
    const double border = sqrt(0.001 / (sqrt(3) / 4));
    for (double x = 0; x <= 4; x += 0.25) {
        const double h = fmin(border + 0.1 * fabs(x - 1), 0.4);
        assert_true(fabs(at_place(lengths, &mesh, x, 0.7) / h - 1) < 1e-9);
    }
    tri_lengths_free(lengths);
    sizes.region_areas = false;
    lengths = lengths_of(&mesh, &sizes);
    assert_true(tri_lengths_uniform(lengths) * mesh.unit == 0.4);
    tri_lengths_free(lengths);
    tri_mesh_free(&mesh);
}

static void test_circles_have_the_given_number_of_edges(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_pslg(68, 68, 0, 0);
    add_ring(&pslg, 64, 3, 0);
    for (int k = 0; k < 4; k++) { /* corners are not curves */
        support_add_point(&pslg, k == 0 || k == 3 ? -1 : 1, k < 2 ? -1 : 1);
        support_add_segment(&pslg, 64 + k, 64 + (k + 1) % 4);
    }
    struct tri_mesh mesh = mesh_of(&pslg, false);
    struct tri_lengths *lengths = lengths_of(&mesh, &(struct tri_sizes){.per_circle = 100, .gradation = 0.2});
    const double around = 6.283185307179586 * 3 / 100;
    for (int32_t k = 0; k < 64; k++)
        assert_true(fabs(at_place(lengths, &mesh, 3 * cos(0.1 * k), 3 * sin(0.1 * k)) / around - 1) < 0.17);
    assert_true(fabs(at_place(lengths, &mesh, 0, 0) / (around + 0.6) - 1) < 0.02);
    tri_lengths_free(lengths);
    tri_mesh_free(&mesh);
}

/* Compares the computed lengths with the expected ones, at points that `across` returns together with the width
 * there. */
static void check_channel(struct tri_pslg *pslg, void (*across)(double s, double t, double out[3]), double least,
                          double most)
{
    struct tri_mesh mesh = mesh_of(pslg, false);
    struct tri_lengths *lengths = lengths_of(&mesh, &(struct tri_sizes){.elements_across = 4, .gradation = 0.2});
    double low = HUGE_VAL, high = 0;
    for (double s = 0.005; s < 1; s += 0.01)
        for (double t = 0; t <= 1; t += 0.125) {
            double out[3];
            across(s, t, out);
            const double ratio = at_place(lengths, &mesh, out[0], out[1]) * 4 / out[2];
            low = fmin(low, ratio);
            high = fmax(high, ratio);
        }
    print_message("  h over width / 4: %.3f to %.3f\n", low, high);
    assert_true(low >= least && high <= most);
    tri_lengths_free(lengths);
    tri_mesh_free(&mesh);
}

static void in_rectangle(double s, double t, double out[3])
{
    out[0] = 1 + 18 * s;
    out[1] = t;
    out[2] = 1;
}

static void in_annulus(double s, double t, double out[3])
{
    out[0] = (2 + t) * cos(6.283185307179586 * s);
    out[1] = (2 + t) * sin(6.283185307179586 * s);
    out[2] = 1;
}

/* Between lines that meet at 20 degrees, at 1 to 10 from their intersection. The circle that touches both at distance s
 * has the diameter 2 s tan(10 degrees). */
static void in_funnel(double s, double t, double out[3])
{
    const double from = 1.4 + 8 * s, angle = (20 * t - 10) * 3.141592653589793 / 180;
    out[0] = from * cos(angle);
    out[1] = from * sin(angle);
    out[2] = 2 * from * tan(10 * 3.141592653589793 / 180);
}

static void test_channels_have_the_given_number_of_edges_across(void **state)
{
    (void)state;
    static const double corners[2][4][2] = {{{0, 0}, {20, 0}, {20, 1}, {0, 1}},
                                            {{0.98480775, -0.17364818}, {9.8480775, -1.7364818}, {9.8480775, 1.7364818},
                                             {0.98480775, 0.17364818}}};
    for (int which = 0; which < 2; which++) {
        struct tri_pslg pslg = support_pslg(4, 4, 0, 0);
        for (int k = 0; k < 4; k++) {
            support_add_point(&pslg, corners[which][k][0], corners[which][k][1]);
            support_add_segment(&pslg, k, (k + 1) % 4);
        }
        check_channel(&pslg, which ? in_funnel : in_rectangle, which ? 0.9 : 0.999, 1.2);
    }
    for (int rough = 0; rough < 2; rough++) {
        struct tri_pslg pslg = support_pslg(1000, 1000, 1, 0);
        add_ring(&pslg, 600, 3, rough ? 0.01 : 0);
        add_ring(&pslg, 400, 2, rough ? 0.01 : 0);
        pslg.n_holes = 1; /* the hole point is the origin */
        check_channel(&pslg, in_annulus, rough ? 0.85 : 0.99, rough ? 1.15 : 1.05);
    }
    /* In a square no walls face each other at less than its side. */
    struct tri_mesh mesh = square_mesh(2, 0, 1);
    struct tri_lengths *lengths = lengths_of(&mesh, &(struct tri_sizes){.elements_across = 4});
    assert_true(at_place(lengths, &mesh, 0, 0) >= 0.49);
    tri_lengths_free(lengths);
    tri_mesh_free(&mesh);
}

/* --- hashes that identify fields */

static void ask_constant(void *user, int64_t n, const double (*at)[2], double *length)
{
    (void)at;
    for (int64_t i = 0; i < n; i++)
        length[i] = *(const double *)user;
}

static void test_different_fields_have_different_hashes(void **state)
{
    (void)state;
    struct tri_mesh mesh = square_mesh(4, 10, 1);
    double values[2][4] = {{1, 2, 3, 4}, {1, 2, 3, 4.0000005}}, constant[2] = {0.1, 0.1000001};
    const double at[] = {0, 0, 4, 0, 0, 4};
    const int32_t corners[] = {0, 1, 2};
    uint64_t hash[12];
    for (int k = 0; k < 12; k++) {
        const double *v = values[k % 2];
        const struct tri_size_field of[6] = {
            {.kind = TRI_SIZE_NUMBER, .length = v[3]},
            {.kind = TRI_SIZE_NEAR, .length = v[3], .marker = 1},
            {.kind = TRI_SIZE_RASTER, .values = tri_reals_of(v, 2, 2), .step = {4, 4}},
            {.kind = TRI_SIZE_MESH, .points = tri_reals_of(at, 3, 2), .values = tri_reals_of(v + 1, 3, 1),
             .triangles = tri_ints_of(corners, 1, 3)},
            {.kind = TRI_SIZE_FUNCTION, .function = ask_constant, .user = &constant[k % 2]},
            {.kind = TRI_SIZE_NUMBER, .length = 1}};
        const struct tri_sizes sizes = {.fields = &of[k / 2], .n = 1, .gradation = HUGE_VAL,
                                        .min_size = k / 2 == 5 ? 0.001 * (1 + k) : 0};
        const struct tri_sizes near_sizes = {.fields = &of[k / 2], .n = 1};
        struct tri_lengths *one = lengths_of(&mesh, k / 2 == 1 ? &near_sizes : &sizes);
        struct tri_lengths *same = lengths_of(&mesh, k / 2 == 1 ? &near_sizes : &sizes);
        hash[k] = tri_lengths_hash(one);
        assert_true(hash[k] == tri_lengths_hash(same) && hash[k] != 0);
        for (int i = 0; i < k; i++)
            assert_true(hash[i] != hash[k]);
        tri_lengths_free(one);
        tri_lengths_free(same);
    }
    tri_mesh_free(&mesh);
}

/* --- rejected inputs */

static void refuse(const struct tri_mesh *mesh, const struct tri_sizes *sizes, const char *text)
{
    struct tri_error error;
    struct tri_lengths *lengths;
    assert_int_equal(tri_lengths_new(&lengths, sizes, mesh, NULL, &error), TRI_BAD_INPUT);
    assert_null(lengths);
    assert_string_equal(error.text, text);
}

static void test_invalid_fields_are_refused(void **state)
{
    (void)state;
    struct tri_mesh mesh = square_mesh(1, 10, 1);
    const double values[4] = {NAN, 0, -1, -HUGE_VAL}, odd[6] = {0, 0, 1, HUGE_VAL, 0, 1}, xy[6] = {0, 0, 1, 0, 0, 1};
    const int32_t corners[3] = {0, 1, 2}, wrong[3] = {0, 1, 3};
    const struct tri_reals three = tri_reals_of(values, 3, 1);
    const struct tri_size_field fields[] = {
        {.kind = TRI_SIZE_NUMBER, .length = 0},
        {.kind = TRI_SIZE_NEAR, .length = NAN, .growth = 1},
        {.kind = TRI_SIZE_RASTER, .step = {1, 1}},
        {.kind = TRI_SIZE_RASTER, .values = tri_reals_of(values, 2, 2), .step = {1, 0}},
        {.kind = TRI_SIZE_RASTER, .values = tri_reals_of(values, 2, 2), .step = {1, 1}},
        {.kind = TRI_SIZE_MESH},
        {.kind = TRI_SIZE_MESH, .points = {values, 2, 2, 2}, .triangles = {corners, 1, 3, 3}, .values = three},
        {.kind = TRI_SIZE_MESH, .points = {odd, 3, 2, 2}, .triangles = {corners, 1, 3, 3}, .values = three},
        {.kind = TRI_SIZE_MESH, .points = {xy, 3, 2, 2}, .triangles = {wrong, 1, 3, 3}, .values = three},
        {.kind = TRI_SIZE_MESH, .points = {xy, 3, 2, 2}, .triangles = {corners, 1, 3, 3}, .values = three},
        {.kind = TRI_SIZE_FUNCTION},
        {.kind = (enum tri_size_kind)99}};
    static const char *const texts[] = {"sizes[0], a number: its length is 0",
                                        "sizes[0], near segments: its length is nan, its growth 1",
                                        "sizes[0], a raster: it has no values",
                                        "sizes[0], a raster: its origin is (0, 0), its step (1, 0)",
                                        "sizes[0], a raster: no value is above 0",
                                        "sizes[0], a mesh: it has no points",
                                        "sizes[0], a mesh: it has 2 points and 3 values",
                                        "sizes[0], a mesh: its point 1 is (1, inf)",
                                        "sizes[0], a mesh: its triangle 0 has the corner 3, of 3 points",
                                        "sizes[0], a mesh: no vertex of a triangle has a length above 0",
                                        "sizes[0], a function: it is NULL", "sizes[0]: its kind is 99"};
    for (size_t k = 0; k < sizeof fields / sizeof *fields; k++)
        refuse(&mesh, &(struct tri_sizes){.fields = &fields[k], .n = 1}, texts[k]);
    refuse(&mesh, &(struct tri_sizes){.gradation = -1}, "gradation is -1");
    refuse(&mesh, &(struct tri_sizes){.gradation = NAN}, "gradation is nan");
    refuse(&mesh, &(struct tri_sizes){.min_size = 2, .max_size = 1}, "min_size 2 is above max_size 1");
    refuse(&mesh, &(struct tri_sizes){.n = 1}, "sizes is NULL, and n_sizes 1");
    struct tri_lengths *lengths = lengths_of(&mesh, &(struct tri_sizes){.max_size = 0.25});
    assert_true(tri_lengths_uniform(lengths) * mesh.unit == 0.25);
    tri_lengths_free(lengths);
    lengths = lengths_of(&mesh, &(struct tri_sizes){.min_size = 1});
    assert_null(lengths);
    tri_mesh_free(&mesh);
}

/* --- through the public header */

static void test_settings_accept_fields(void **state)
{
    (void)state;
    const double xy[] = {0, 0, 1, 0, 1, 1, 0, 1}, values[] = {0.1, 0.2};
    const int32_t ends[] = {0, 1, 1, 2, 2, 3, 3, 0};
    struct tri_size_field f = {.kind = TRI_SIZE_RASTER, .values = tri_reals_of(values, 1, 2), .step = {1, 1}};
    struct tri_figure figure = tri_no_figure();
    struct tri_settings settings = tri_no_settings();
    struct tri_mesh *mesh;
    struct tri_error error;
    figure.points = tri_reals_of(xy, 4, 2);
    figure.segments = tri_ints_of(ends, 4, 2);
    settings.min_angle = 20;
    settings.sizes = &f;
    settings.n_sizes = 1;
    assert_int_equal(tri_mesh_new(&mesh, &figure, &settings, &error), TRI_OK);
    assert_string_equal(tri_mesh_notes(mesh), "sizes[0] covers (-0.5, -0.5) to (1.5, 0.5), the mesh (0, 0) to (1, 1):"
                                              " outside, the nearest lengths count");
    f.values.n = 0;
    assert_int_equal(tri_mesh_refine(mesh, &settings, &error), TRI_BAD_INPUT);
    assert_string_equal(error.text, "sizes[0], a raster: it has no values");
    tri_mesh_delete(mesh);
    settings.n_sizes = 0;
    settings.gradation = NAN;
    assert_int_equal(tri_mesh_new(&mesh, &figure, &settings, &error), TRI_BAD_INPUT);
    assert_null(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_near_items_equal_naive_twin), cmocka_unit_test(test_ties_end),
        cmocka_unit_test(test_tasks_make_the_same_lists),
        cmocka_unit_test(test_segments_with_a_marker), cmocka_unit_test(test_rasters_equal_naive_twin),
        cmocka_unit_test(test_meshes_equal_naive_twin), cmocka_unit_test(test_loose_points_and_triangles),
        cmocka_unit_test(test_sampled_functions_are_accurate),
        cmocka_unit_test(test_lengths_grow_from_regions), cmocka_unit_test(test_circles_have_the_given_number_of_edges),
        cmocka_unit_test(test_channels_have_the_given_number_of_edges_across),
        cmocka_unit_test(test_different_fields_have_different_hashes),
        cmocka_unit_test(test_invalid_fields_are_refused), cmocka_unit_test(test_settings_accept_fields)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
