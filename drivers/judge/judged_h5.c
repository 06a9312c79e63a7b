#include "drivers/judge/judged_h5.h"

#include <stdlib.h>

#include "triangle/hdf5/h5_read.h"

struct judged_h5 {
    struct tri_h5 *file;
    int32_t columns;
};

enum tri_status judged_h5_open(struct judged_h5 **h5, const char *path, struct tri_error *error)
{
    *h5 = calloc(1, sizeof **h5);
    enum tri_status status = *h5 ? tri_h5_open(path, &(*h5)->file, error)
                                 : tri_fail(error, TRI_NO_MEMORY, path, 0, "out of memory");
    if (status) {
        free(*h5);
        *h5 = NULL;
    } else {
        (*h5)->columns = tri_h5_count((*h5)->file)->columns;
    }
    return status;
}

void judged_h5_close(struct judged_h5 *h5)
{
    if (h5)
        tri_h5_free(h5->file);
    free(h5);
}

/* The last one of each triangle. */
static enum tri_status read_attributes(struct judged_h5 *h5, int64_t first, int64_t n, double *out,
                                       struct tri_error *error)
{
    int64_t width = h5->columns;
    double *rows = malloc(((size_t)n * (size_t)width + 1) * sizeof *rows);
    enum tri_status status = rows ? tri_h5_read(h5->file, TRI_H5_OF_TRIANGLE_ATTRIBUTES, first, n, rows, error)
                                  : tri_fail(error, TRI_NO_MEMORY, "", 0, "out of memory");
    for (int64_t i = 0; i < n && !status; i++)
        out[i] = rows[width * (i + 1) - 1];
    free(rows);
    return status;
}

static enum tri_status read_slice(void *user, enum tri_check_array array, int64_t first, int64_t n, void *out,
                                  struct tri_error *error)
{
    static const enum tri_h5_kind kinds[TRI_CHECK_N_ARRAYS] = {
        [TRI_CHECK_POINTS] = TRI_H5_OF_POINTS,
        [TRI_CHECK_CORNERS] = TRI_H5_OF_TRIANGLES,
        [TRI_CHECK_POINT_MARKERS] = TRI_H5_OF_POINT_MARKERS,
        [TRI_CHECK_SEGMENT_ENDS] = TRI_H5_OF_SEGMENTS,
        [TRI_CHECK_SEGMENT_MARKERS] = TRI_H5_OF_SEGMENT_MARKERS,
        [TRI_CHECK_POINT_ATTRIBUTES] = TRI_H5_OF_POINT_ATTRIBUTES,
    }; /* of others there are none */
    struct judged_h5 *h5 = user;
    return array == TRI_CHECK_ATTRIBUTES ? read_attributes(h5, first, n, out, error)
                                         : tri_h5_read(h5->file, kinds[array], first, n, out, error);
}

struct tri_check_source judged_h5_source(struct judged_h5 *h5)
{
    const struct tri_h5_counts *n = tri_h5_count(h5->file);
    unsigned given = 1u << TRI_CHECK_POINTS | 1u << TRI_CHECK_CORNERS;
    given |= (n->columns > 0 ? 1u : 0u) << TRI_CHECK_ATTRIBUTES;
    given |= (n->point_markers ? 1u : 0u) << TRI_CHECK_POINT_MARKERS;
    given |= (n->attributes > 0 ? 1u : 0u) << TRI_CHECK_POINT_ATTRIBUTES;
    given |= (n->lists_segments ? 1u : 0u) << TRI_CHECK_SEGMENT_ENDS;
    given |= (n->lists_segments && n->segment_markers ? 1u : 0u) << TRI_CHECK_SEGMENT_MARKERS;
    return (struct tri_check_source){.n_points = n->points, .n_triangles = n->triangles, .n_segments = n->segments,
                                     .n_point_attributes = n->attributes, .given = given, .read = read_slice,
                                     .user = h5};
}
