/* Lengths on a grid.
 *
 * Two things propagate over the nodes: data to nodes without data, and short lengths to their surroundings. Both
 * compute min over y of base(y) + slope |x - y|. Each node stores its best y so far and tries those of its eight
 * neighbours. As in Danielsson's distance transform (Euclidean distance mapping, Computer Graphics and Image
 * Processing 14, 1980), two sweeps go down and up; they repeat until nothing changes. Distances are exact. In rare
 * cases the best y is missed, with an error of up to 1 in 1,000. */
#include "triangle/size/sources.h"

#include "triangle/base/hash.h"

enum { MOST_SWEEPS = 8 };

/* A propagation over the grid. */
struct spreading {
    int32_t width, height; /* columns and rows */
    double step[2], slope; /* distances of columns and of rows; slope of the propagation */
    const float *base;     /* [height][width] start values; infinite: does not propagate */
    float *least;          /* [height][width] result, at most base */
    int32_t *from;         /* [height][width] the node y that gives the result */
    bool changed;          /* true: a node has changed in this sweep */
};

/* Tries the y of a neighbour for the node in column i and row j. offset: from the node to the neighbour. */
static inline void try_neighbour(struct spreading *s, int32_t i, int32_t j, int32_t offset)
{
    const int32_t node = j * s->width + i, from = s->from[node + offset];
    if (from == s->from[node])
        return;
    const double x = (i - from % s->width) * s->step[0], y = (j - from / s->width) * s->step[1];
    const float least = (float)(s->base[from] + s->slope * sqrt(x * x + y * y));
    if (least < s->least[node]) {
        s->least[node] = least;
        s->from[node] = from;
        s->changed = true;
    }
}

/* Updates a row from the previous row (`way` rows back), and along itself in both directions. */
static void sweep_row(struct spreading *s, int32_t j, int way)
{
    const int32_t w = s->width, before = j - way;
    const int32_t up = before >= 0 && before < s->height ? -way * w : 0;
    for (int32_t i = 0; i < w; i++) {
        if (i > 0)
            try_neighbour(s, i, j, -1);
        if (up && i > 0)
            try_neighbour(s, i, j, up - 1);
        if (up)
            try_neighbour(s, i, j, up);
        if (up && i + 1 < w)
            try_neighbour(s, i, j, up + 1);
    }
    for (int32_t i = w - 2; i >= 0; i--)
        try_neighbour(s, i, j, 1);
}

static enum tri_status spread(struct spreading *s, const struct tri_stop *stop, struct tri_error *error)
{
    const int32_t n = s->width * s->height;
    memcpy(s->least, s->base, (size_t)n * sizeof *s->least);
    for (int32_t k = 0; k < n; k++)
        s->from[k] = k;
    s->changed = true;
    for (int sweep = 0; s->changed && sweep < MOST_SWEEPS; sweep++) {
        s->changed = false;
        for (int32_t j = 0; j < s->height; j++)
            sweep_row(s, j, 1);
        if (tri_stop_is_asked(stop))
            return tri_fail_stopped(error);
        for (int32_t j = s->height - 1; j >= 0; j--)
            sweep_row(s, j, -1);
    }
    return TRI_OK;
}

/* Gives each node without data the value of the nearest node with data. The result is in *value; base and s are work
 * space. */
static enum tri_status fill_gaps(struct spreading *s, float *value, float *base, const struct tri_stop *stop,
                                 struct tri_error *error)
{
    const int32_t n = s->width * s->height;
    for (int32_t k = 0; k < n; k++)
        base[k] = value[k] > 0 ? 0 : HUGE_VALF;
    s->base = base;
    s->slope = 1 / tri_larger(s->step[0], s->step[1]); /* in grid steps, which floats can represent */
    const enum tri_status status = spread(s, stop, error);
    for (int32_t k = 0; !status && k < n; k++)
        base[k] = value[s->from[k]];
    if (!status)
        memcpy(value, base, (size_t)n * sizeof *value);
    return status;
}

/* Converts the field's values for storage, with 0 for no data. Returns the number of nodes without data. */
static int64_t copy_values(struct tri_raster *r, const struct tri_size_field *f, const struct tri_size_frame *frame)
{
    int64_t gaps = 0;
    double longest = 0;
    for (int64_t j = 0; j < r->n[1]; j++)
        for (int64_t i = 0; i < r->n[0]; i++)
            longest = tri_larger(longest, tri_size_of(frame, f->values.at[j * f->values.stride + i]));
    r->scale = tri_size_scale(longest);
    for (int64_t j = 0; j < r->n[1]; j++)
        for (int64_t i = 0; i < r->n[0]; i++) {
            const double length = tri_size_of(frame, f->values.at[j * f->values.stride + i]);
            r->value[j * r->n[0] + i] = length > 0 ? tri_size_float(length, r->scale) : 0;
            gaps += !(length > 0);
        }
    return gaps;
}

static enum tri_status limit(struct tri_raster *r, int64_t gaps, const struct tri_size_frame *frame,
                             struct tri_error *error)
{
    const size_t n = (size_t)(r->n[0] * r->n[1]);
    const struct tri_stop *stop = frame->mesh->stop;
    struct spreading s = {.width = (int32_t)r->n[0], .height = (int32_t)r->n[1],
                          .step = {1 / r->inverse[0], 1 / r->inverse[1]}};
    float *scratch = gaps > 0 ? malloc(n * sizeof *scratch) : NULL;
    s.least = malloc(n * sizeof *s.least);
    s.from = malloc(n * sizeof *s.from);
    enum tri_status status = s.least && s.from && (scratch || gaps == 0)
                                 ? TRI_OK : tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for sizes");
    if (!status && gaps > 0)
        status = fill_gaps(&s, r->value, scratch, stop, error);
    s.base = r->value;
    s.slope = frame->gradation / r->scale;
    if (!status && frame->gradation < HUGE_VAL)
        status = spread(&s, stop, error);
    if (!status && frame->gradation < HUGE_VAL) {
        float *limited = s.least;
        s.least = r->value;
        r->value = limited;
    }
    free(scratch);
    free(s.least);
    free(s.from);
    return status;
}

enum tri_status tri_raster_make(struct tri_raster *raster, const struct tri_size_field *f,
                                const struct tri_size_frame *frame, struct tri_error *error)
{
    const double unit = frame->mesh->unit;
    const int64_t n = f->values.n * f->values.width;
    struct tri_raster r = {{f->origin[0] / unit, f->origin[1] / unit}, {unit / f->step[0], unit / f->step[1]},
                           {f->values.width, f->values.n}, 1, malloc((size_t)n * sizeof *r.value)};
    if (!r.value)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for sizes");
    const int64_t gaps = copy_values(&r, f, frame);
    const enum tri_status status = gaps < n ? limit(&r, gaps, frame, error)
                                            : tri_fail(error, TRI_BAD_INPUT, NULL, 0, "no value is above 0");
    if (status)
        tri_raster_clear(&r);
    *raster = r;
    return status;
}

double tri_raster_at(const struct tri_raster *r, struct tri_point p)
{
    const double at[2] = {p.x, p.y};
    int64_t i[2];
    double f[2];
    for (int k = 0; k < 2; k++) {
        const double last = (double)(r->n[k] - 1);
        const double x = tri_lesser(tri_larger((at[k] - r->origin[k]) * r->inverse[k], 0), last);
        i[k] = (int64_t)x - (x == last && last > 0);
        f[k] = x - (double)i[k];
    }
    const float *v = r->value + i[1] * r->n[0] + i[0];
    const int64_t right = r->n[0] > 1, up = r->n[1] > 1 ? r->n[0] : 0;
    const double low = (1 - f[0]) * v[0] + f[0] * v[right]; /* above 0 in spite of rounding */
    const double high = (1 - f[0]) * v[up] + f[0] * v[up + right];
    return r->scale * ((1 - f[1]) * low + f[1] * high);
}

uint64_t tri_raster_hash(const struct tri_raster *r, uint64_t hash)
{
    hash = tri_hash(hash, r->origin, sizeof r->origin);
    hash = tri_hash(hash, r->inverse, sizeof r->inverse);
    hash = tri_hash(hash, r->n, sizeof r->n);
    hash = tri_hash(hash, &r->scale, sizeof r->scale);
    return tri_hash(hash, r->value, (size_t)(r->n[0] * r->n[1]) * sizeof *r->value);
}

void tri_raster_clear(struct tri_raster *r)
{
    free(r->value);
    *r = (struct tri_raster){0};
}
