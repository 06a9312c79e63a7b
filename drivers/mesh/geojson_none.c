/* Replaces geojson.c if the library jansson was missing during the build. */
#include "drivers/mesh/geojson.h"

enum tri_status geojson_read(struct tri_polygons *polygons, const char *path, struct tri_error *error)
{
    (void)polygons;
    return tri_fail(error, TRI_BAD_INPUT, path, 0, "this program was built without the library jansson, which reads "
                    "GeoJSON");
}
