/* Converts figures. Only the shapes of arrays are checked here; contents are checked where they are used
 * (triangle/mesh/pslg.c, triangle/cdt/reconstruct.c). */
#include "triangle/api/figure.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ROWS = 1 << 29, MOST_COLUMNS = 1 << 20 };

enum { ANY = -1 };

/* A conversion in progress. After a failure, the remaining arrays are skipped. */
struct taking {
    struct tri_api_figure *taken; /* the result */
    enum tri_status status;       /* first failure */
    struct tri_error *error;      /* its description */
};

/* An array of any element type. */
struct rows {
    const void *at; /* first element */
    int64_t n, width, stride; /* rows; elements per row; elements from row to row */
    size_t item; /* bytes per element */
};

/* Checks that the array has n rows of this width. ANY: any number. */
static enum tri_status check_shape(const struct rows *a, const char *what, int64_t n, int64_t width,
                                   struct tri_error *error)
{
    if (a->n == 0)
        return TRI_OK;
    if (a->n < 0 || !a->at)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "%s: %lld rows without an array", what, (long long)a->n);
    if (a->width < 1 || a->stride < a->width || (width != ANY && a->width != width))
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "%s: width %lld and stride %lld are invalid", what,
                        (long long)a->width, (long long)a->stride);
    if (n != ANY && a->n != n)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "%s: %lld rows instead of %lld", what, (long long)a->n,
                        (long long)n);
    if (a->n > MOST_ROWS || a->width > MOST_COLUMNS)
        return tri_fail(error, TRI_TOO_LARGE, NULL, 0, "%s: %lld x %lld numbers are more than one mesh can hold", what,
                        (long long)a->n, (long long)a->width);
    return TRI_OK;
}

/* Checks the shape of an array and returns its rows without gaps, for reading only: the array itself or a copy. NULL
 * if there are no rows or after a failure. */
static void *pack(struct taking *t, struct rows a, const char *what, int64_t n, int64_t width)
{
    const size_t row = (size_t)a.width * a.item;
    t->status = t->status ? t->status : check_shape(&a, what, n, width, t->error);
    if (t->status || a.n == 0 || a.stride == a.width)
        return t->status || a.n == 0 ? NULL : (void *)a.at;
    assert(t->taken->n_copies < TRI_API_MOST_COPIES);
    char *copy = malloc((size_t)a.n * row);
    if (!copy)
        t->status = tri_fail(t->error, TRI_NO_MEMORY, NULL, 0, "out of memory for a copy of the input");
    for (size_t i = 0; copy && i < (size_t)a.n; i++)
        memcpy(copy + i * row, (const char *)a.at + i * (size_t)a.stride * a.item, row);
    if (copy)
        t->taken->copies[t->taken->n_copies++] = copy;
    return copy;
}

static double *take_reals(struct taking *t, struct tri_reals a, const char *what, int64_t n, int64_t width)
{
    return pack(t, (struct rows){a.at, a.n, a.width, a.stride, sizeof *a.at}, what, n, width);
}

static int32_t *take_ints(struct taking *t, struct tri_ints a, const char *what, int64_t n, int64_t width)
{
    return pack(t, (struct rows){a.at, a.n, a.width, a.stride, sizeof *a.at}, what, n, width);
}

static void convert_pslg(struct taking *t, const struct tri_figure *f)
{
    struct tri_pslg *pslg = &t->taken->pslg;
    const int64_t n = f->points.n, m = f->segments.n;
    pslg->points = take_reals(t, f->points, "points", ANY, 2);
    pslg->attributes = take_reals(t, f->point_attributes, "attributes of points", n, ANY);
    pslg->markers = take_ints(t, f->point_markers, "markers of points", n, 1);
    pslg->segments = take_ints(t, f->segments, "segments", ANY, 2);
    pslg->segment_markers = take_ints(t, f->segment_markers, "markers of segments", m, 1);
    pslg->holes = take_reals(t, f->holes, "holes", ANY, 2);
    pslg->regions = take_reals(t, f->regions, "regions", ANY, 4);
    pslg->n_points = (int32_t)n;
    pslg->n_attributes = f->point_attributes.n > 0 ? (int32_t)f->point_attributes.width : 0;
    pslg->n_segments = (int32_t)m;
    pslg->n_holes = (int32_t)f->holes.n;
    pslg->n_regions = (int32_t)f->regions.n;
}

static void convert_elements(struct taking *t, const struct tri_figure *f)
{
    struct tri_elements *elements = &t->taken->elements;
    const int64_t n = f->triangles.n;
    elements->corners = take_ints(t, f->triangles, "triangles", ANY, 3);
    elements->attributes = take_reals(t, f->triangle_attributes, "attributes of triangles", n, ANY);
    elements->areas = take_reals(t, f->triangle_areas, "areas of triangles", n, 1);
    elements->n = (int32_t)n;
    elements->n_nodes = 3;
    elements->n_attributes = f->triangle_attributes.n > 0 ? (int32_t)f->triangle_attributes.width : 0;
}

enum tri_status tri_api_figure_take(struct tri_api_figure *taken, const struct tri_figure *figure,
                                    struct tri_error *error)
{
    struct tri_figure own;
    struct taking t = {taken, TRI_OK, error};
    *taken = (struct tri_api_figure){0};
    if (!figure)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "there is no figure");
    t.status = tri_api_struct_take(&own, sizeof own, figure, "tri_figure", error);
    convert_pslg(&t, &own);
    convert_elements(&t, &own);
    return t.status;
}

void tri_api_figure_free(struct tri_api_figure *taken)
{
    for (int i = 0; i < taken->n_copies; i++)
        free(taken->copies[i]);
    *taken = (struct tri_api_figure){0};
}

/* --- structs that begin with their size */

static enum tri_status check_size(const void *given, const char *name, size_t *size, struct tri_error *error)
{
    memcpy(size, given, sizeof *size);
    if (*size < sizeof *size || *size > 1 << 16)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "struct %s: its member size is not set", name);
    return TRI_OK;
}

enum tri_status tri_api_struct_take(void *own, size_t own_size, const void *given, const char *name,
                                    struct tri_error *error)
{
    size_t size = 0;
    memset(own, 0, own_size);
    enum tri_status status = given ? check_size(given, name, &size, error) : TRI_OK;
    for (size_t i = own_size; !status && i < size; i++)
        if (((const char *)given)[i] != 0)
            status = tri_fail(error, TRI_BAD_INPUT, NULL, 0, "struct %s: has members that this library does not know",
                              name);
    if (!status && given)
        memcpy(own, given, size < own_size ? size : own_size);
    return status;
}

enum tri_status tri_api_struct_give(void *given, const void *own, size_t own_size, const char *name,
                                    struct tri_error *error)
{
    size_t size, head = sizeof size;
    enum tri_status status = check_size(given, name, &size, error);
    if (status)
        return status;
    memset((char *)given + head, 0, size - head);
    memcpy((char *)given + head, (const char *)own + head, (size < own_size ? size : own_size) - head);
    return TRI_OK;
}
