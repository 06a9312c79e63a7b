/* Reads polygons from GeoJSON (RFC 7946). */
#ifndef DRIVERS_MESH_GEOJSON_H
#define DRIVERS_MESH_GEOJSON_H

#include "triangle/api/region_polygons.h"

/* Appends the polygons of a file to *polygons, which the caller frees in any case. The features of a FeatureCollection,
 * the members of a GeometryCollection, or a single object are numbered from 1. A feature consists of Polygons,
 * MultiPolygons, and GeometryCollections of them; a feature without geometry has no polygon. Its property "attribute"
 * is its attribute (default: its number), "area" its area bound (default: none). Further numbers of a position are
 * ignored. TRI_CANNOT_READ, TRI_NO_MEMORY, TRI_BAD_INPUT: no valid JSON, or another geometry; also for any file if the
 * program was built without the library jansson. */
enum tri_status geojson_read(struct tri_polygons *polygons, const char *path, struct tri_error *error);

#endif
