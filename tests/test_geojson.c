/* Polygons from GeoJSON: all forms, and one line for each fault. */
#include "drivers/mesh/geojson.h"

#include <locale.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static enum tri_status read_text(struct tri_polygons *p, const char *text, struct tri_error *error)
{
    FILE *file = fopen("polygons.geojson", "wb");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
    return geojson_read(p, "polygons.geojson", error);
}

#define SQUARE "[[0, 0], [1, 0, 9], [1, 1], [0, 1], [0, 0]]"
#define OPEN "[[2, 0.1], [3e0, -0.0], [25e-1, 1.7976931348623157e308]]"
#define FEATURE(properties, geometry) \
    "{\"type\": \"Feature\", \"properties\": " properties ", \"geometry\": " geometry "}"
#define POLYGON(rings) "{\"type\": \"Polygon\", \"coordinates\": [" rings "]}"
#define MULTI(polygons) "{\"type\": \"MultiPolygon\", \"coordinates\": [" polygons "]}"
#define FEATURES(list) "{\"type\": \"FeatureCollection\", \"features\": [" list "]}"
#define GEOMETRIES(list) "{\"type\": \"GeometryCollection\", \"geometries\": [" list "]}"

static void test_all_forms(void **state)
{
    (void)state;
    struct tri_polygons p = {0};
    struct tri_error error = {0};
    setlocale(LC_ALL, "de_DE.UTF-8"); /* with a decimal comma, if it is installed */
    assert_int_equal(read_text(&p, FEATURES(FEATURE("{\"attribute\": -2.5, \"area\": 3}", POLYGON(SQUARE ", " OPEN)) ","
                                            FEATURE("{\"attribute\": null}", "null") ","
                                            FEATURE("null", MULTI("[" OPEN "], [" SQUARE ", []], []")) ","
                                            FEATURE("{}", GEOMETRIES(POLYGON(OPEN) "," MULTI("")))), &error), TRI_OK);
    setlocale(LC_ALL, "C");
    static const double attributes[] = {-2.5, 2, 3, 4}, open[] = {2, 0.1, 3, -0.0, 2.5, 1.7976931348623157e308};
    static const struct tri_ring rings[] = {{0, 4, 0, 0}, {4, 7, 0, 0}, {7, 10, 1, 2}, {10, 14, 2, 2}, {14, 17, 4, 3}};
    assert_int_equal(p.n_features, 4);
    for (int k = 0; k < 4; k++)
        assert_true(p.features[k].attribute == attributes[k] && p.features[k].max_area == (k ? 0 : 3));
    assert_int_equal(p.n_rings, 5);
    assert_memory_equal(p.rings, rings, sizeof rings);
    assert_int_equal(p.n_points, 17);
    static const int32_t first[] = {4, 7, 14};
    for (int k = 0; k < 3; k++)
        assert_memory_equal(&p.points[2 * first[k]], open, sizeof open);
    tri_polygons_free(&p);
}

static void test_single_objects(void **state)
{
    (void)state;
    static const char *const texts[] = {POLYGON(SQUARE), MULTI("[" SQUARE "]"), FEATURE("null", POLYGON(SQUARE)),
                                        GEOMETRIES(POLYGON(SQUARE)), FEATURES(FEATURE("{}", POLYGON(SQUARE)))};
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        struct tri_polygons p = {0};
        assert_int_equal(read_text(&p, texts[k], NULL), TRI_OK);
        assert_true(p.n_features == 1 && p.n_rings == 1 && p.n_points == 4 && p.features[0].attribute == 1);
        tri_polygons_free(&p);
    }
}

static void test_faults(void **state)
{
    (void)state;
    static const struct {
        const char *text, *said;
    } faults[] = {
        {"{\n\"type\": \"Polygon\",,", "string or '}' expected"},
        {"", "'[' or '{' expected"},
        {"[1]", "feature 1: a geometry without type is no polygon"},
        {"{\"type\": \"Point\", \"coordinates\": [1, 2]}", "feature 1: Point is no polygon"},
        {FEATURES(FEATURE("{}", "null") "," FEATURE("{}", "{\"type\": \"LineString\"}")), "feature 2: LineString is"},
        {FEATURES("7"), "feature 1: a geometry without type"},
        {GEOMETRIES(GEOMETRIES("{}")), "feature 1: a geometry without type"},
        {POLYGON("[[0, 0], [1]]"), "feature 1: a position is not two numbers"},
        {POLYGON("[[0, 0], [1, \"2\"]]"), "feature 1: a position is not two numbers"},
        {POLYGON("[0, 0, 1, 1]"), "feature 1: a position is not two numbers"},
        {POLYGON("3"), "feature 1: coordinates are not nested arrays"},
        {"{\"type\": \"Polygon\"}", "feature 1: coordinates are not nested arrays"},
        {POLYGON("[[0, 0], [1e999, 0]]"), "overflow"},
        {FEATURE("{\"attribute\": \"7\"}", POLYGON(SQUARE)), "feature 1: attribute is no number"},
        {FEATURE("{\"area\": []}", POLYGON(SQUARE)), "feature 1: area is no number"},
    };
    for (size_t k = 0; k < sizeof faults / sizeof *faults; k++) {
        struct tri_polygons p = {0};
        struct tri_error error = {0};
        assert_int_equal(read_text(&p, faults[k].text, &error), TRI_BAD_INPUT);
        if (!strstr(error.text, faults[k].said))
            fail_msg("%s: %s", faults[k].text, error.text);
        assert_string_equal(error.file, "polygons.geojson");
        assert_true(k > 0 || error.line == 2);
        tri_polygons_free(&p);
    }
    struct tri_polygons p = {0};
    assert_int_equal(geojson_read(&p, "missing.geojson", NULL), TRI_CANNOT_READ);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_all_forms),
        cmocka_unit_test(test_single_objects),
        cmocka_unit_test(test_faults),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
