/* The library jansson reads the whole file. A missing key gives NULL, which every function of jansson accepts. */
#include "drivers/mesh/geojson.h"

#include <errno.h>
#include <jansson.h>
#include <stdio.h>
#include <string.h>

#include "triangle/base/grow.h"

struct reading {
    struct tri_polygons *to;
    const char *path;
    int32_t polygon; /* number of polygons so far */
    struct tri_error *error;
};

/* Reports a fault of the current feature. */
static enum tri_status refuse(const struct reading *r, const char *format, const char *text)
{
    char fault[200];
    snprintf(fault, sizeof fault, format, text);
    return tri_fail(r->error, TRI_BAD_INPUT, r->path, 0, "feature %d: %s", (int)r->to->n_features, fault);
}

static enum tri_status no_memory(const struct reading *r)
{
    return tri_fail(r->error, TRI_NO_MEMORY, r->path, 0, "out of memory for polygons");
}

static enum tri_status read_ring(const struct reading *r, const json_t *ring)
{
    struct tri_polygons *to = r->to;
    const int32_t first = to->n_points;
    if (!json_is_array(ring))
        return refuse(r, "a ring is no %s of positions", "array");
    if (json_array_size(ring) == 0)
        return TRI_OK;
    if (json_array_size(ring) > INT32_MAX / 4 ||
        !tri_grow(&to->points, &to->point_capacity, first + (int32_t)json_array_size(ring), 2 * sizeof *to->points) ||
        !tri_grow(&to->rings, &to->ring_capacity, to->n_rings + 1, sizeof *to->rings))
        return no_memory(r);
    for (size_t i = 0; i < json_array_size(ring); i++, to->n_points++)
        for (size_t k = 0; k < 2; k++) {
            const json_t *number = json_array_get(json_array_get(ring, i), k);
            if (!json_is_number(number))
                return refuse(r, "a position is no %s of two numbers", "array");
            to->points[2 * (size_t)to->n_points + k] = json_number_value(number);
        }
    const double *begin = &to->points[2 * (size_t)first], *last = &to->points[2 * (size_t)to->n_points - 2];
    to->n_points -= last > begin && memcmp(begin, last, 2 * sizeof *begin) == 0; /* the first point again */
    to->rings[to->n_rings++] = (struct tri_ring){first, r->polygon, to->n_features - 1};
    return TRI_OK;
}

static enum tri_status read_polygon(struct reading *r, const json_t *rings)
{
    enum tri_status status = json_is_array(rings) ? TRI_OK : refuse(r, "a polygon is no %s of rings", "array");
    for (size_t i = 0; !status && i < json_array_size(rings); i++)
        status = read_ring(r, json_array_get(rings, i));
    r->polygon++;
    return status;
}

static enum tri_status read_geometry(struct reading *r, const json_t *geometry)
{
    const char *type = json_string_value(json_object_get(geometry, "type"));
    const json_t *places = json_object_get(geometry, "coordinates"), *parts = json_object_get(geometry, "geometries");
    enum tri_status status = TRI_OK;
    if (json_is_null(geometry))
        return TRI_OK;
    if (type && strcmp(type, "Polygon") == 0)
        return read_polygon(r, places);
    if (type && strcmp(type, "MultiPolygon") == 0 && json_is_array(places))
        for (size_t i = 0; !status && i < json_array_size(places); i++)
            status = read_polygon(r, json_array_get(places, i));
    else if (type && strcmp(type, "GeometryCollection") == 0 && json_is_array(parts))
        for (size_t i = 0; !status && i < json_array_size(parts); i++)
            status = read_geometry(r, json_array_get(parts, i));
    else
        status = refuse(r, "%.80s is no polygon", type ? type : "an object without type");
    return status;
}

/* Reads a property that is a number. Does nothing if it is missing or null. */
static enum tri_status read_property(const struct reading *r, const json_t *feature, const char *name, double *value)
{
    const json_t *number = json_object_get(json_object_get(feature, "properties"), name);
    if (number && !json_is_null(number) && !json_is_number(number))
        return refuse(r, "its property \"%s\" is no number", name);
    *value = json_is_number(number) ? json_number_value(number) : *value;
    return TRI_OK;
}

static enum tri_status read_feature(struct reading *r, const json_t *feature)
{
    struct tri_polygons *to = r->to;
    const char *type = json_string_value(json_object_get(feature, "type"));
    const bool is_feature = type && strcmp(type, "Feature") == 0;
    if (!tri_grow(&to->features, &to->feature_capacity, to->n_features + 1, sizeof *to->features))
        return no_memory(r);
    struct tri_feature *own = &to->features[to->n_features++];
    *own = (struct tri_feature){to->n_features, 0};
    enum tri_status status = read_property(r, feature, "attribute", &own->attribute);
    status = status ? status : read_property(r, feature, "area", &own->max_area);
    return status ? status : read_geometry(r, is_feature ? json_object_get(feature, "geometry") : feature);
}

static enum tri_status read_all(struct reading *r, const json_t *all)
{
    const json_t *features = json_object_get(all, "features"), *parts = json_object_get(all, "geometries");
    const json_t *list = json_is_array(features) ? features : json_is_array(parts) ? parts : NULL;
    enum tri_status status = list ? TRI_OK : read_feature(r, all);
    for (size_t i = 0; !status && i < json_array_size(list); i++)
        status = read_feature(r, json_array_get(list, i));
    return status;
}

enum tri_status geojson_read(struct tri_polygons *polygons, const char *path, struct tri_error *error)
{
    struct reading r = {polygons, path, 0, error};
    json_error_t fault;
    FILE *file = fopen(path, "rb");
    if (!file)
        return tri_fail_system(error, TRI_CANNOT_READ, path, "cannot open", errno);
    json_t *all = json_loadf(file, JSON_DECODE_INT_AS_REAL, &fault);
    fclose(file);
    if (!all)
        return tri_fail(error, TRI_BAD_INPUT, path, fault.line, "%s", fault.text);
    const enum tri_status status = read_all(&r, all);
    json_decref(all);
    return status;
}
