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

static char *put_number(char *at, enum tri_h5_type type, int64_t number)
{
    return type == TRI_H5_INT32 ? tri_put_i32(at, (int32_t)number) : tri_put_i64(at, number);
}

static void put_markers(const int32_t *markers, int32_t i, int32_t end, char *at)
{
    for (; i < end; i++)
        at = tri_put_i32(at, markers[i]);
}

static void put_reals(const double *reals, int64_t width, int32_t i, int32_t end, char *at)
{
    for (int64_t k = i * width; k < end * width; k++)
        at = tri_put_f64(at, reals[k]);
}

static void put_corners(const struct tri_h5_rows *rows, enum tri_h5_type type, int32_t i, int32_t end, char *at)
{
    for (; i < end; i++)
        for (int k = 0; k < 3; k++)
            at = put_number(at, type, rows->tile->corners[i][k]);
}

static void put_ends(const struct tri_h5_rows *rows, enum tri_h5_type type, int32_t i, int32_t end, char *at)
{
    for (; i < end; i++)
        for (int k = 0; k < 2; k++)
            at = put_number(at, type, rows->tile->ends[i][k]);
}

static void put_columns(const struct tri_h5_rows *rows, enum tri_h5_type type, int32_t i, int32_t end, char *at)
{
    for (; i < end; i++) {
        const double *columns = rows->columns + (int64_t)rows->tile->regions[i] * rows->n_columns;
        for (int32_t k = 0; k < rows->n_columns; k++)
            at = type == TRI_H5_INT32 ? tri_put_i32(at, (int32_t)columns[k]) : tri_put_f64(at, columns[k]);
    }
}

void tri_h5_put(const struct tri_h5_rows *rows, enum tri_h5_kind kind, enum tri_h5_type type, int32_t i, int32_t end,
                char *at)
{
    const struct tri_tile *tile = rows->tile;
    switch (kind) {
    case TRI_H5_OF_POINTS: put_reals(tile->points[0], 2, i, end, at); break;
    case TRI_H5_OF_POINT_MARKERS: put_markers(tile->point_markers, i, end, at); break;
    case TRI_H5_OF_POINT_ATTRIBUTES: put_reals(tile->attributes, rows->n_attributes, i, end, at); break;
    case TRI_H5_OF_TRIANGLES: put_corners(rows, type, i, end, at); break;
    case TRI_H5_OF_TRIANGLE_ATTRIBUTES: put_columns(rows, type, i, end, at); break;
    case TRI_H5_OF_SEGMENTS: put_ends(rows, type, i, end, at); break;
    case TRI_H5_OF_SEGMENT_MARKERS: put_markers(tile->segment_markers, i, end, at); break;
    case TRI_H5_KINDS: break;
    }
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
