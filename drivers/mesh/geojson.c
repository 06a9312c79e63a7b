/* The library jansson reads the whole file. A missing key gives NULL, which all functions of jansson accept. */
#include "drivers/mesh/geojson.h"

#include <errno.h>
#include <jansson.h>
#include <stdio.h>
#include <string.h>

#include "triangle/base/grow.h"

struct reading {
    struct tri_polygons *to; /* the last feature is the current one */
    const char *path;        /* for errors */
    int32_t n_polygons;      /* number of polygons so far */
    struct tri_error *error; /* receives details of a failure */
};

/* Reports a fault of the current feature: a name and what is wrong with it. */
static enum tri_status refuse(const struct reading *r, const char *name, const char *fault)
{
    return tri_fail(r->error, TRI_BAD_INPUT, r->path, 0, "feature %d: %.80s %s", (int)r->to->n_features, name, fault);
}

static enum tri_status no_memory(const struct reading *r)
{
    return tri_fail(r->error, TRI_NO_MEMORY, r->path, 0, "out of memory for polygons");
}

static enum tri_status read_ring(const struct reading *r, const json_t *places)
{
    struct tri_polygons *to = r->to;
    struct tri_ring ring = {to->n_points, to->n_points, r->n_polygons, to->n_features - 1};
    const size_t n = json_array_size(places);
    if (n > INT32_MAX / 4 ||
        !tri_grow(&to->points, &to->point_capacity, ring.first + (int32_t)n, 2 * sizeof *to->points) ||
        !tri_grow(&to->rings, &to->ring_capacity, to->n_rings + 1, sizeof *to->rings))
        return no_memory(r);
    for (size_t i = 0; i < n; i++, to->n_points++)
        for (size_t k = 0; k < 2; k++) {
            const json_t *number = json_array_get(json_array_get(places, i), k);
            if (!json_is_number(number))
                return refuse(r, "a position", "is not two numbers");
            to->points[2 * (size_t)to->n_points + k] = json_number_value(number);
        }
    const double *begin = to->points + 2 * (size_t)ring.first, *end = to->points + 2 * (size_t)to->n_points;
    if (n > 1 && begin[0] == end[-2] && begin[1] == end[-1])
        to->n_points--; /* the first point again */
    ring.end = to->n_points;
    if (ring.end > ring.first)
        to->rings[to->n_rings++] = ring;
    return TRI_OK;
}

/* Reads a list of polygons (depth 2), a polygon (1) or a ring (0). */
static enum tri_status read_places(struct reading *r, const json_t *places, int depth)
{
    enum tri_status status = json_is_array(places) ? TRI_OK : refuse(r, "coordinates", "are not nested arrays");
    if (status || depth == 0)
        return status ? status : read_ring(r, places);
    for (size_t i = 0; !status && i < json_array_size(places); i++)
        status = read_places(r, json_array_get(places, i), depth - 1);
    r->n_polygons += depth == 1;
    return status;
}

static enum tri_status read_geometry(struct reading *r, const json_t *geometry)
{
    const char *given = json_string_value(json_object_get(geometry, "type")), *type = given ? given : "";
    const json_t *parts = json_object_get(geometry, "geometries");
    enum tri_status status = TRI_OK;
    if (json_is_null(geometry))
        return TRI_OK;
    if (strcmp(type, "Polygon") == 0 || strcmp(type, "MultiPolygon") == 0)
        return read_places(r, json_object_get(geometry, "coordinates"), *type == 'P' ? 1 : 2);
    if (!json_is_array(parts))
        return refuse(r, given ? given : "a geometry without type", "is no polygon");
    for (size_t i = 0; !status && i < json_array_size(parts); i++)
        status = read_geometry(r, json_array_get(parts, i));
    return status;
}

/* Reads a property that is a number. Does nothing if it is missing or null. */
static enum tri_status read_property(const struct reading *r, const json_t *feature, const char *name, double *value)
{
    const json_t *number = json_object_get(json_object_get(feature, "properties"), name);
    if (number && !json_is_null(number) && !json_is_number(number))
        return refuse(r, name, "is no number");
    *value = json_is_number(number) ? json_number_value(number) : *value;
    return TRI_OK;
}

static enum tri_status read_feature(struct reading *r, const json_t *feature)
{
    struct tri_polygons *to = r->to;
    const json_t *geometry = json_object_get(feature, "geometry");
    if (!tri_grow(&to->features, &to->feature_capacity, to->n_features + 1, sizeof *to->features))
        return no_memory(r);
    struct tri_feature *own = &to->features[to->n_features++];
    *own = (struct tri_feature){to->n_features, 0};
    enum tri_status status = read_property(r, feature, "attribute", &own->attribute);
    status = status ? status : read_property(r, feature, "area", &own->max_area);
    return status ? status : read_geometry(r, geometry ? geometry : feature);
}

enum tri_status geojson_read(struct tri_polygons *polygons, const char *path, struct tri_error *error)
{
    struct reading r = {polygons, path, 0, error};
    json_error_t fault;
    FILE *file = fopen(path, "rb");
    if (!file)
        return tri_fail_system(error, TRI_CANNOT_READ, path, "cannot open", errno);
    errno = 0;
    json_t *all = json_loadf(file, JSON_DECODE_INT_AS_REAL, &fault);
    const int reason = ferror(file) ? errno : 0;
    fclose(file);
    if (reason != 0) {
        json_decref(all);
        return tri_fail_system(error, TRI_CANNOT_READ, path, "cannot read", reason);
    }
    if (!all)
        return tri_fail(error, TRI_BAD_INPUT, path, fault.line, "%s", fault.text);
    const json_t *features = json_object_get(all, "features"), *parts = json_object_get(all, "geometries");
    const json_t *list = json_is_array(features) ? features : parts;
    enum tri_status status = json_is_array(list) ? TRI_OK : read_feature(&r, all);
    for (size_t i = 0; !status && i < json_array_size(list); i++)
        status = read_feature(&r, json_array_get(list, i));
    json_decref(all);
    return status;
}
