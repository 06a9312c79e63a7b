#include "triangle/hdf5/rows.h"

#include "triangle/hdf5/layout.h"
#include "triangle/text/binary.h"

enum { REALS = 1 << TRI_H5_FLOAT64, NARROW = 1 << TRI_H5_INT32, NUMBERS = NARROW | 1 << TRI_H5_INT64 };

const struct tri_h5_form tri_h5_forms[TRI_H5_KINDS] = {
    {TRI_H5_POINTS, 2, true, TRI_H5_OF_POINTS, REALS},
    {TRI_H5_POINT_MARKERS, 0, false, TRI_H5_OF_POINTS, NARROW},
    {TRI_H5_POINT_ATTRIBUTES, -1, false, TRI_H5_OF_POINTS, REALS},
    {TRI_H5_TRIANGLES, 3, true, TRI_H5_OF_TRIANGLES, NUMBERS},
    {TRI_H5_TRIANGLE_ATTRIBUTES, -1, false, TRI_H5_OF_TRIANGLES, REALS | NARROW},
    {TRI_H5_SEGMENTS, 2, false, TRI_H5_OF_SEGMENTS, NUMBERS},
    {TRI_H5_SEGMENT_MARKERS, 0, false, TRI_H5_OF_SEGMENTS, NARROW},
};

static void put_points(const struct tri_h5_rows *rows, int32_t i, int32_t end, char *at)
{
    for (; i < end; i++)
        at = tri_put_f64(tri_put_f64(at, rows->tile->points[i][0]), rows->tile->points[i][1]);
}

static void put_point_markers(const struct tri_h5_rows *rows, int32_t i, int32_t end, char *at)
{
    for (; i < end; i++)
        at = tri_put_i32(at, rows->tile->point_markers[i]);
}

static void put_point_attributes(const struct tri_h5_rows *rows, int32_t i, int32_t end, char *at)
{
    const int64_t width = rows->n_attributes;
    for (int64_t k = i * width; k < end * width; k++)
        at = tri_put_f64(at, rows->tile->attributes[k]);
}

static void put_corners(const struct tri_h5_rows *rows, int32_t i, int32_t end, char *at)
{
    for (; i < end; i++)
        for (int k = 0; k < 3; k++)
            at = tri_put_i32(at, (int32_t)rows->tile->corners[i][k]);
}

static void put_wide_corners(const struct tri_h5_rows *rows, int32_t i, int32_t end, char *at)
{
    for (; i < end; i++)
        for (int k = 0; k < 3; k++)
            at = tri_put_i64(at, rows->tile->corners[i][k]);
}

static void put_columns(const struct tri_h5_rows *rows, int32_t i, int32_t end, char *at)
{
    for (; i < end; i++)
        for (int32_t k = 0; k < rows->n_columns; k++)
            at = tri_put_f64(at, rows->columns[(int64_t)rows->tile->regions[i] * rows->n_columns + k]);
}

static void put_whole_columns(const struct tri_h5_rows *rows, int32_t i, int32_t end, char *at)
{
    for (; i < end; i++)
        for (int32_t k = 0; k < rows->n_columns; k++)
            at = tri_put_i32(at, (int32_t)rows->columns[(int64_t)rows->tile->regions[i] * rows->n_columns + k]);
}

static void put_ends(const struct tri_h5_rows *rows, int32_t i, int32_t end, char *at)
{
    for (; i < end; i++)
        at = tri_put_i32(tri_put_i32(at, (int32_t)rows->tile->ends[i][0]), (int32_t)rows->tile->ends[i][1]);
}

static void put_wide_ends(const struct tri_h5_rows *rows, int32_t i, int32_t end, char *at)
{
    for (; i < end; i++)
        at = tri_put_i64(tri_put_i64(at, rows->tile->ends[i][0]), rows->tile->ends[i][1]);
}

static void put_segment_markers(const struct tri_h5_rows *rows, int32_t i, int32_t end, char *at)
{
    for (; i < end; i++)
        at = tri_put_i32(at, rows->tile->segment_markers[i]);
}

tri_h5_put_call *tri_h5_put_of(enum tri_h5_kind kind, enum tri_h5_type type)
{
    static tri_h5_put_call *const narrow[TRI_H5_KINDS] = {
        put_points, put_point_markers, put_point_attributes, put_corners, put_whole_columns, put_ends,
        put_segment_markers};
    static tri_h5_put_call *const wide[TRI_H5_KINDS] = {
        put_points, NULL, put_point_attributes, put_wide_corners, put_columns, put_wide_ends, NULL};
    return (type == TRI_H5_INT32 ? narrow : wide)[kind];
}

void tri_h5_extend_bounds(double bounds[4], const struct tri_tile *tile)
{
    for (int32_t i = 0; i < tile->n_vertices; i++) {
        const double *at = tile->points[i];
        bounds[0] = at[0] < bounds[0] ? at[0] : bounds[0];
        bounds[1] = at[1] < bounds[1] ? at[1] : bounds[1];
        bounds[2] = at[0] > bounds[2] ? at[0] : bounds[2];
        bounds[3] = at[1] > bounds[3] ? at[1] : bounds[3];
    }
}
