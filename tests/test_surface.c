/* Attributes of new vertices: their values are those of the input's surface at their positions. */
#include "triangle/mesh/surface.h"

#include "support.h"

/* --- a vertex in a mesh of one or two triangles */

/* A mesh of these points, with room for one more vertex. */
static struct tri_mesh mesh_of(const struct tri_point *at, int32_t n, const double *attributes, int32_t n_attributes)
{
    struct tri_pslg pslg = support_pslg(n, 0, 0, 0);
    struct tri_options options = support_quality(0, 0);
    for (int32_t v = 0; v < n; v++)
        support_add_point(&pslg, at[v].x, at[v].y);
    pslg.n_attributes = n_attributes;
    pslg.attributes = malloc((size_t)(n * n_attributes) * sizeof *attributes);
    assert_non_null(pslg.attributes);
    memcpy(pslg.attributes, attributes, (size_t)(n * n_attributes) * sizeof *attributes);
    options.refine = false;
    options.keep_hull = true;
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    assert_true(mesh.n_triangles > 0);
    assert_int_equal(tri_mesh_reserve_vertices(&mesh, 1, NULL), TRI_OK);
    tri_pslg_free(&pslg);
    return mesh;
}

/* The attributes of a new vertex at this position, which lies on no segment. */
static const double *made_at(struct tri_mesh *mesh, struct tri_point p)
{
    const tri_vertex_id v = mesh->n_vertices;
    mesh->xy[v] = p;
    mesh->on[v] = TRI_VERTEX_FREE;
    tri_surface_set(mesh, &v, 1);
    return mesh->attributes + (size_t)v * (size_t)mesh->n_attributes;
}

static void test_values_on_edges_are_interpolated_linearly(void **state)
{
    (void)state;
    struct tri_point xy[] = {{0, 0}, {4, 1}, {1, 3}};
    double attributes[] = {0.1, 7, 0.3, 7, 0.9, 7}, made[2];
    const struct tri_mesh mesh = {.xy = xy, .n_vertices = 3, .n_attributes = 2, .attributes = attributes};
    for (int i = -1; i <= 5; i++) {
        const struct tri_point p = {1 + 3 * i / 4.0, 3 - 2 * i / 4.0};
        const double expected = i <= 0 ? 0.9 : i >= 4 ? 0.3 : 0.9 + (0.3 - 0.9) * i / 4;
        tri_interpolate_edge(&mesh, 2, 1, p, made);
        assert_true(i <= 0 || i >= 4 ? made[0] == expected : fabs(made[0] - expected) < 1e-15);
        assert_true(made[1] == 7);
    }
}

/* Positions that lie outside because of rounding or larger errors, and a triangle of nearly zero area. */
static void test_values_stay_in_the_range_of_the_corners(void **state)
{
    (void)state;
    static const struct tri_point at[] = {{0.5, 1e-16}, {0.5, -1e-17}, {0.5, -1}, {7, 0}, {-7, 0}};
    static const struct tri_point xy[] = {{0, 0}, {1, 0}, {0.5, 3e-16}};
    static const double attributes[] = {0, 5, 1, 5, 0.25, 5};
    struct tri_mesh mesh = mesh_of(xy, 3, attributes, 2);
    for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
        const double *made = made_at(&mesh, at[i]);
        assert_true(made[0] >= 0 && made[0] <= 1 && made[1] == 5);
    }
    assert_true(fabs(made_at(&mesh, at[1])[0] - 0.5) < 1e-15); /* on the nearest edge */
    tri_mesh_free(&mesh);
}

/* Planes over triangles up to 10^12 times as long as high are evaluated as exactly as others. */
static void test_thin_triangles_are_evaluated_exactly(void **state)
{
    (void)state;
    struct support_random random = {5};
    int tried = 0;
    for (int i = 0; i < 2000; i++) {
        const double thin = pow(10, -12 * support_unit(&random)), far = i % 2 ? 1e6 : 0, x = support_unit(&random);
        const struct tri_point xy[] = {{far, far}, {far + 1, far + 0.25}, {far + x, far + 0.25 * x + thin}};
        const double f = support_unit(&random), g = (1 - f) * support_unit(&random);
        const struct tri_point p = {xy[0].x + f * (xy[1].x - xy[0].x) + g * (xy[2].x - xy[0].x),
                                    xy[0].y + f * (xy[1].y - xy[0].y) + g * (xy[2].y - xy[0].y)};
        if (!tri_is_inside(xy[0], xy[1], xy[2], p))
            continue;
        double attributes[6];
        for (int v = 0; v < 3; v++) {
            attributes[2 * v] = xy[v].x - far;
            attributes[2 * v + 1] = 3 + xy[v].y - far;
        }
        struct tri_mesh mesh = mesh_of(xy, 3, attributes, 2);
        const double *made = made_at(&mesh, p);
        assert_true(fabs(made[0] - (p.x - far)) <= 0x1p-48 + 0x1p-53);
        assert_true(fabs(made[1] - (3 + p.y - far)) <= 0x1p-48 + 4 * 0x1p-53);
        tri_mesh_free(&mesh);
        tried++;
    }
    assert_true(tried > 1000);
}

/* The values on the common edge of two triangles do not depend on which corner has the lower number. */
static void test_triangles_agree_on_their_common_edge(void **state)
{
    (void)state;
    struct support_random random = {6};
    for (int i = 0; i < 300; i++) {
        struct tri_point xy[4];
        double attributes[4];
        for (int v = 0; v < 4; v++) {
            xy[v] = (struct tri_point){8 * support_below(&random, 999), 8 * support_below(&random, 999)};
            attributes[v] = support_unit(&random);
        }
        const double x = xy[1].x - xy[0].x, y = xy[1].y - xy[0].y;
        if (x == 0 && y == 0)
            continue;
        const struct tri_point p = {xy[0].x + 0.75 * x, xy[0].y + 0.75 * y}; /* an exact product */
        double made[2];
        for (int side = 0; side < 2; side++) {
            xy[2] = (struct tri_point){xy[side].x + (side ? y : -y), xy[side].y + (side ? -x : x)};
            struct tri_mesh mesh = mesh_of(xy, 3, attributes, 1);
            made[side] = *made_at(&mesh, p);
            tri_mesh_free(&mesh);
        }
        assert_memory_equal(&made[0], &made[1], sizeof *made);
    }
}

/* --- refined meshes */

struct figure {
    const char *file;
    double angle, area;
    bool conforming, regions;
    int protect;
};

static const struct figure figures[] = {
    {"letter.poly", 33, 0.2, true, false, 0},   {"section.poly", 30, 0, false, true, 0},
    {"box_hole.poly", 20, 0.003, false, false, 0}, {"perforated.poly", 25, 0, false, false, 2},
    {"koch_lake.poly", 33, 0, true, false, 0},  {"nasty/crossing_random.poly", 20, 0, false, false, 0},
    {"gear.poly", 30, 0, false, false, 1},      {"square_random1000.poly", 30, 0, false, false, 0},
    {"nasty/fan_1e-3deg.poly", 20, 0, true, false, 0},
};

enum { FIGURES = sizeof figures / sizeof *figures };

static struct tri_options options_of(const struct figure *figure, const struct tri_pslg *pslg)
{
    struct tri_options options = support_quality(figure->angle, figure->area);
    options.keep_hull = pslg->n_segments == 0;
    options.spread_regions = options.quality.region_areas = figure->regions;
    options.quality.conforming = figure->conforming;
    options.quality.protect = figure->protect;
    return options;
}

static void test_refined_meshes_keep_the_surface(void **state)
{
    (void)state;
    for (int i = 0; i < FIGURES; i++) {
        struct tri_pslg pslg;
        assert_true(support_read(figures[i].file, &pslg));
        support_add_heights(&pslg, 1 + i % 3, 1);
        struct tri_options options = options_of(&figures[i], &pslg);
        struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
        options.refine = false;
        struct tri_mesh before = support_generate(&pslg, &options, NULL);
        print_message("  %s: %d vertices, %d before\n", figures[i].file, (int)mesh.n_vertices, (int)before.n_vertices);
        assert_true(mesh.n_vertices > before.n_vertices);
        support_assert_on_surface(&before, &mesh);
        tri_mesh_free(&mesh);
        tri_mesh_free(&before);
        tri_pslg_free(&pslg);
    }
}

/* A crease: the square's diagonal has value 1, two corners 0. Refinement in any order keeps the crease. */
static void test_a_crease_stays(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_square(1, 0, 0);
    struct tri_options options = support_quality(33, 0.001);
    pslg.n_attributes = 1;
    pslg.attributes = malloc(4 * sizeof *pslg.attributes);
    memcpy(pslg.attributes, (double[]){1, 0, 1, 0}, 4 * sizeof *pslg.attributes);
    support_add_segment(&pslg, 0, 2);
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    assert_true(mesh.n_vertices > 500);
    for (int32_t v = 0; v < mesh.n_vertices; v++)
        assert_true(fabs(mesh.attributes[v] - (1 - fabs(mesh.xy[v].x - mesh.xy[v].y))) < 1e-15);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* One vertex at a time, in any order, or all at once: the results have the same bits. */
static void test_the_order_of_evaluation_does_not_matter(void **state)
{
    (void)state;
    for (int i = 0; i < FIGURES; i++) {
        struct tri_pslg pslg;
        assert_true(support_read(figures[i].file, &pslg));
        support_add_heights(&pslg, 1, 2);
        const struct tri_options options = options_of(&figures[i], &pslg);
        struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
        const size_t bytes = (size_t)mesh.n_vertices * sizeof *mesh.attributes;
        double *first = malloc(bytes);
        assert_non_null(first);
        memcpy(first, mesh.attributes, bytes);
        struct support_random random = {7};
        for (int32_t k = 0; k < 2 * mesh.n_vertices; k++) {
            tri_vertex_id some[3];
            for (int j = 0; j < 3; j++)
                do
                    some[j] = support_below(&random, mesh.n_vertices);
                while (mesh.on[some[j]] < 0 && mesh.on[some[j]] != TRI_VERTEX_FREE && mesh.n_vertices > pslg.n_points);
            tri_surface_set(&mesh, some, 1 + k % 3);
        }
        assert_memory_equal(first, mesh.attributes, bytes);
        free(first);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

/* --- meshes that were read from files */

/* Refines a mesh of these triangles. */
static struct tri_mesh refine_read(const struct tri_pslg *pslg, int32_t *corners, int32_t n, double angle, double area,
                                   bool refine)
{
    const struct tri_elements elements = {.n = n, .corners = corners};
    struct tri_options options = support_quality(angle, area);
    options.elements = &elements;
    options.refine = refine;
    return support_generate(pslg, &options, NULL);
}

/* The triangles of a mesh, as input for another. */
static int32_t *corners_of(const struct tri_mesh *mesh)
{
    int32_t *corners = malloc(3 * ((size_t)mesh->n_triangles + 1) * sizeof *corners);
    assert_non_null(corners);
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        memcpy(corners + 3 * t, mesh->tri[t].v, sizeof mesh->tri[t].v);
    return corners;
}

static double area_of(const struct tri_mesh *mesh)
{
    double sum = 0;
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        sum += 0.5 * tri_shape_of(mesh->xy, mesh->tri[t].v).area2;
    return sum * mesh->unit * mesh->unit;
}

/* A mesh with straight sides of many pieces and with holes is read, gets different heights, and is refined. */
static void test_meshes_read_from_files_keep_the_surface(void **state)
{
    (void)state;
    for (int i = 0; i < FIGURES; i++) {
        struct tri_pslg pslg, read;
        assert_true(support_read(figures[i].file, &pslg));
        const struct tri_options options = options_of(&figures[i], &pslg);
        struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
        read = support_pslg(mesh.n_vertices, 0, 0, 0);
        for (int32_t v = 0; v < mesh.n_vertices; v++) {
            double at[2];
            tri_mesh_place(&mesh, v, at);
            support_add_point(&read, at[0], at[1]);
        }
        support_add_heights(&read, 2, 3);
        int32_t *corners = corners_of(&mesh);
        const double area = 0.3 * area_of(&mesh) / mesh.n_triangles;
        struct tri_mesh finer = refine_read(&read, corners, mesh.n_triangles, 25, area, true);
        struct tri_mesh before = refine_read(&read, corners, mesh.n_triangles, 25, area, false);
        assert_true(finer.n_vertices > before.n_vertices);
        support_assert_on_surface(&before, &finer);
        tri_mesh_free(&finer);
        tri_mesh_free(&before);
        tri_mesh_free(&mesh);
        tri_pslg_free(&read);
        tri_pslg_free(&pslg);
        free(corners);
    }
}

/* The surface is that of the triangles as read, including those that are flipped later. */
static void test_flips_do_not_change_the_surface(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_pslg(4, 0, 0, 0);
    support_add_point(&pslg, 0, 0);
    support_add_point(&pslg, 4, -1);
    support_add_point(&pslg, 8, 0);
    support_add_point(&pslg, 4, 1);
    support_add_heights(&pslg, 1, 4);
    struct tri_mesh mesh = refine_read(&pslg, (int32_t[]){0, 1, 2, 0, 2, 3}, 2, 30, 0.1, true);
    struct tri_mesh before = refine_read(&pslg, (int32_t[]){0, 1, 2, 0, 2, 3}, 2, 30, 0.1, false);
    assert_true(mesh.n_vertices > 40);
    support_assert_on_surface(&before, &mesh);
    tri_mesh_free(&mesh);
    tri_mesh_free(&before);
    tri_pslg_free(&pslg);
}

/* Two squares side by side that share no vertex, with value 0 in one and 1 in the other, also on the common side. The
   sides consist of several pieces. */
static void test_the_sides_of_a_crack_keep_their_values(void **state)
{
    (void)state;
    enum { N = 4 };
    struct tri_pslg pslg = support_pslg(4 * (N + 1), 0, 0, 0);
    int32_t corners[2 * 2 * N * 3], n = 0;
    for (int32_t v = 0; v < 4 * (N + 1); v++)
        support_add_point(&pslg, (v / (N + 1) + 1) / 2, (double)(v % (N + 1)) / N);
    for (int32_t side = 0; side < 2; side++)
        for (int32_t i = 0; i < N; i++) {
            const int32_t left = 2 * side * (N + 1) + i, right = left + N + 1;
            const int32_t v[] = {left, right, right + 1, left, right + 1, left + 1};
            memcpy(corners + n, v, sizeof v);
            n += 6;
        }
    support_add_heights(&pslg, 1, 0);
    for (int32_t v = 0; v < 4 * (N + 1); v++)
        pslg.attributes[v] = v / (2 * (N + 1));
    struct tri_mesh mesh = refine_read(&pslg, corners, n / 3, 30, 0.003, true);
    bool lips[2] = {false, false};
    for (int32_t t = 0; t < mesh.n_triangles; t++) {
        const double *a = mesh.attributes;
        const int32_t *v = mesh.tri[t].v;
        const double middle = (mesh.xy[v[0]].x + mesh.xy[v[1]].x + mesh.xy[v[2]].x) / 3;
        for (int k = 0; k < 3; k++) {
            assert_true(a[v[k]] == (middle > 1));
            lips[middle > 1] = lips[middle > 1] || (mesh.xy[v[k]].x == 1 && v[k] >= pslg.n_points);
        }
    }
    assert_true(lips[0] && lips[1]);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* Refining repeatedly, through a caller's gate, keeps the surface of the first call. */
static void test_later_calls_keep_the_first_surface(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_square(1, 30, 8);
    support_add_heights(&pslg, 2, 9);
    struct tri_options options = support_quality(20, 0);
    options.refine = false;
    struct tri_mesh before = support_generate(&pslg, &options, NULL);
    options.refine = true;
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    for (int i = 0; i < 5; i++) {
        struct tri_refine_report report;
        options.quality.max_area = 0.02 / (1 << i);
        assert_int_equal(tri_refine(&mesh, &options.quality, &report, NULL), TRI_OK);
        tri_surface_settle(&mesh, i % 2 ? &support_backwards : NULL);
        support_assert_on_surface(&before, &mesh);
    }
    assert_true(mesh.n_vertices > 500);
    tri_mesh_free(&mesh);
    tri_mesh_free(&before);
    tri_pslg_free(&pslg);
}

static void test_meshes_without_attributes_are_allowed(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_square(1, 30, 8);
    const struct tri_options options = support_quality(20, 0.01);
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    assert_null(mesh.surface);
    assert_null(mesh.attributes);
    tri_surface_settle(&mesh, NULL);
    tri_surface_free(NULL);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values_on_edges_are_interpolated_linearly),
        cmocka_unit_test(test_values_stay_in_the_range_of_the_corners),
        cmocka_unit_test(test_thin_triangles_are_evaluated_exactly),
        cmocka_unit_test(test_triangles_agree_on_their_common_edge),
        cmocka_unit_test(test_refined_meshes_keep_the_surface),
        cmocka_unit_test(test_a_crease_stays),
        cmocka_unit_test(test_the_order_of_evaluation_does_not_matter),
        cmocka_unit_test(test_meshes_read_from_files_keep_the_surface),
        cmocka_unit_test(test_flips_do_not_change_the_surface),
        cmocka_unit_test(test_the_sides_of_a_crack_keep_their_values),
        cmocka_unit_test(test_later_calls_keep_the_first_surface),
        cmocka_unit_test(test_meshes_without_attributes_are_allowed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
