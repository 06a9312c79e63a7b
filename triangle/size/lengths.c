/* Sources of lengths. */
#include "triangle/size/lengths.h"

#include <math.h>
#include <stdlib.h>

struct raster {
    double origin[2], step[2];
    int64_t n[2];
    double *value; /* [n[1]][n[0]] */
};

struct tri_lengths {
    struct tri_sizes sizes;
    double number; /* the least of those that hold everywhere; infinity: none */
    struct raster *raster;
    int64_t n_rasters;
};

static double raster_at(const struct raster *r, struct tri_point p)
{
    const double at[2] = {p.x, p.y};
    int64_t i[2];
    double f[2];
    for (int k = 0; k < 2; k++) {
        const double x = fmin(fmax((at[k] - r->origin[k]) / r->step[k], 0), (double)(r->n[k] - 1));
        i[k] = (int64_t)x < r->n[k] - 2 ? (int64_t)x : r->n[k] > 1 ? r->n[k] - 2 : 0;
        f[k] = x - (double)i[k];
    }
    const double *v = r->value + i[1] * r->n[0] + i[0];
    const int64_t right = r->n[0] > 1, up = r->n[1] > 1 ? r->n[0] : 0;
    const double low = v[0] + f[0] * (v[right] - v[0]), high = v[up] + f[0] * (v[up + right] - v[up]);
    return low + f[1] * (high - low);
}

double tri_lengths_at(const struct tri_lengths *l, struct tri_point p)
{
    double h = l->number;
    for (int64_t k = 0; k < l->n_rasters; k++)
        h = fmin(h, raster_at(&l->raster[k], p));
    return fmax(h, l->sizes.min_size);
}

double tri_lengths_uniform(const struct tri_lengths *l)
{
    return l->n_rasters == 0 && l->number < HUGE_VAL ? fmax(l->number, l->sizes.min_size) : 0;
}

static bool take_raster(struct raster *r, const struct tri_size_field *f, double unit)
{
    *r = (struct raster){{f->origin[0] / unit, f->origin[1] / unit}, {f->step[0] / unit, f->step[1] / unit},
                         {f->values.width, f->values.n},
                         malloc((size_t)(f->values.n * f->values.width) * sizeof *r->value)};
    for (int64_t j = 0; r->value && j < f->values.n; j++)
        for (int64_t i = 0; i < f->values.width; i++)
            r->value[j * f->values.width + i] = f->values.at[j * f->values.stride + i] / unit;
    return r->value;
}

enum tri_status tri_lengths_new(struct tri_lengths **lengths, const struct tri_sizes *sizes,
                                const struct tri_mesh *mesh, const struct tri_executor *executor,
                                struct tri_error *error)
{
    (void)executor;
    *lengths = NULL;
    if (sizes->n == 0 && !(sizes->max_size > 0))
        return TRI_OK;
    struct tri_lengths *l = calloc(1, sizeof *l);
    if (!l || !(l->raster = calloc((size_t)sizes->n + 1, sizeof *l->raster))) {
        free(l);
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for sizes");
    }
    l->sizes = *sizes;
    l->sizes.min_size = sizes->min_size / mesh->unit;
    l->number = sizes->max_size > 0 ? sizes->max_size / mesh->unit : HUGE_VAL;
    for (int64_t k = 0; k < sizes->n; k++) {
        const struct tri_size_field *f = &sizes->fields[k];
        if (f->kind == TRI_SIZE_NUMBER)
            l->number = fmin(l->number, f->length / mesh->unit);
        else if (f->kind == TRI_SIZE_RASTER && take_raster(&l->raster[l->n_rasters], f, mesh->unit))
            l->n_rasters++;
    }
    l->sizes.fields = NULL;
    *lengths = l;
    return TRI_OK;
}

void tri_lengths_free(struct tri_lengths *l)
{
    for (int64_t k = 0; l && k < l->n_rasters; k++)
        free(l->raster[k].value);
    if (l)
        free(l->raster);
    free(l);
}

uint64_t tri_lengths_hash(const struct tri_lengths *l) { return l ? (uint64_t)l->n_rasters : 0; }
