/* Shapes are checked here, contents where they matter (triangle/mesh/pslg.c, triangle/cdt/reconstruct.c). */
#include "triangle/api/figure.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ROWS = 1 << 29, MOST_COLUMNS = 1 << 20 };

/* What an array has to be: n rows (ANY), this wide (ANY). */
struct shape {
    const char *what;
    int64_t n, width;
};

enum { ANY = -1 };

static enum tri_status check_shape(const void *at, int64_t n, int64_t width, int64_t stride, const struct shape *shape,
                                   struct tri_error *error)
{
    if (n == 0)
        return TRI_OK;
    if (n < 0 || !at)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "%s: %lld rows without an array", shape->what, (long long)n);
    if (width < 1 || stride < width || (shape->width != ANY && width != shape->width))
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "%s: width %lld and stride %lld have no meaning", shape->what,
                        (long long)width, (long long)stride);
    if (shape->n != ANY && n != shape->n)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "%s: %lld rows instead of %lld", shape->what, (long long)n,
                        (long long)shape->n);
    if (n > MOST_ROWS || width > MOST_COLUMNS)
        return tri_fail(error, TRI_TOO_LARGE, NULL, 0, "%s: %lld x %lld numbers are more than one mesh can hold",
                        shape->what, (long long)n, (long long)width);
    return TRI_OK;
}

/* The rows of an array that has its shape, without gaps; only read. NULL where there are none. */
static enum tri_status pack(struct tri_api_figure *taken, void **packed, const void *at, int64_t n, int64_t width,
                            int64_t stride, size_t item, const struct shape *shape, struct tri_error *error)
{
    size_t row = (size_t)width * item;
    enum tri_status status = check_shape(at, n, width, stride, shape, error);
    *packed = status || n == 0 ? NULL : (void *)at;
    if (!*packed || stride == width)
        return status;
    assert(taken->n_copies < TRI_API_MOST_COPIES);
    char *copy = malloc((size_t)n * row);
    if (!copy) {
        *packed = NULL;
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for a copy of the input");
    }
    for (size_t i = 0; i < (size_t)n; i++)
        memcpy(copy + i * row, (const char *)at + i * (size_t)stride * item, row);
    taken->copies[taken->n_copies++] = copy;
    *packed = copy;
    return TRI_OK;
}

static enum tri_status take_reals(struct tri_api_figure *taken, double **to, struct tri_reals given, struct shape shape,
                                  struct tri_error *error)
{
    void *packed;
    enum tri_status status = pack(taken, &packed, given.at, given.n, given.width, given.stride, sizeof *given.at,
                                  &shape, error);
    *to = packed;
    return status;
}

static enum tri_status take_ints(struct tri_api_figure *taken, int32_t **to, struct tri_ints given, struct shape shape,
                                 struct tri_error *error)
{
    void *packed;
    enum tri_status status = pack(taken, &packed, given.at, given.n, given.width, given.stride, sizeof *given.at,
                                  &shape, error);
    *to = packed;
    return status;
}

static enum tri_status take_pslg(struct tri_api_figure *taken, const struct tri_figure *f, struct tri_error *error)
{
    struct tri_pslg *pslg = &taken->pslg;
    int64_t n = f->points.n, m = f->segments.n;
    enum tri_status status = take_reals(taken, &pslg->points, f->points, (struct shape){"points", ANY, 2}, error);
    status = status ? status : take_reals(taken, &pslg->attributes, f->point_attributes,
                                          (struct shape){"attributes of points", n, ANY}, error);
    status = status ? status : take_ints(taken, &pslg->markers, f->point_markers,
                                         (struct shape){"markers of points", n, 1}, error);
    status = status ? status : take_ints(taken, &pslg->segments, f->segments,
                                         (struct shape){"segments", ANY, 2}, error);
    status = status ? status : take_ints(taken, &pslg->segment_markers, f->segment_markers,
                                         (struct shape){"markers of segments", m, 1}, error);
    status = status ? status : take_reals(taken, &pslg->holes, f->holes, (struct shape){"holes", ANY, 2}, error);
    status = status ? status : take_reals(taken, &pslg->regions, f->regions, (struct shape){"regions", ANY, 4}, error);
    if (status)
        return status;
    pslg->n_points = (int32_t)n;
    pslg->n_attributes = f->point_attributes.n > 0 ? (int32_t)f->point_attributes.width : 0;
    pslg->n_segments = (int32_t)m;
    pslg->n_holes = (int32_t)f->holes.n;
    pslg->n_regions = (int32_t)f->regions.n;
    return TRI_OK;
}

static enum tri_status take_elements(struct tri_api_figure *taken, const struct tri_figure *f, struct tri_error *error)
{
    struct tri_elements *elements = &taken->elements;
    int64_t n = f->triangles.n;
    enum tri_status status = take_ints(taken, &elements->corners, f->triangles,
                                       (struct shape){"triangles", ANY, 3}, error);
    status = status ? status : take_reals(taken, &elements->attributes, f->triangle_attributes,
                                          (struct shape){"attributes of triangles", n, ANY}, error);
    status = status ? status : take_reals(taken, &elements->areas, f->triangle_areas,
                                          (struct shape){"areas of triangles", n, 1}, error);
    if (status)
        return status;
    elements->n = (int32_t)n;
    elements->n_nodes = 3;
    elements->n_attributes = f->triangle_attributes.n > 0 ? (int32_t)f->triangle_attributes.width : 0;
    return TRI_OK;
}

enum tri_status tri_api_figure_take(struct tri_api_figure *taken, const struct tri_figure *figure,
                                    struct tri_error *error)
{
    struct tri_figure own;
    *taken = (struct tri_api_figure){0};
    if (!figure)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "there is no figure");
    enum tri_status status = tri_api_struct_take(&own, sizeof own, figure, "tri_figure", error);
    status = status ? status : take_pslg(taken, &own, error);
    return status ? status : take_elements(taken, &own, error);
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
