/* Quantiles of the estimated work, first along x, then along y in each column.
 *
 * The work is sampled: vertices stand for the triangles that an angle bound will ask for around them, triangles for
 * those that an area bound will ask for inside them; large triangles are cut into small ones first, so that their work
 * lies where it is. There are some 32 samples for a block: enough for shares equal within a sixth, few enough to sort
 * in no time. */
#include "sched/partition.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/quality.h"

enum { SAMPLES_PER_BLOCK = 32, DEEPEST_CUT = 12 };

/* Measured: mean area over bound, and triangles around each vertex of the input for bounds of 20 to 34 degrees. */
static const double MEAN_OVER_BOUND = 0.655, TRIANGLES_PER_VERTEX = 5;

struct sample {
    struct tri_point q;
    double work;
};

struct samples {
    struct sample *item;
    size_t n, capacity;
};

/* Triangles that the bounds ask for on one unit of area in this region; 0 without bound. */
static double density(const struct tri_mesh *mesh, const struct tri_refine_options *options, int32_t region)
{
    double bound = options->max_area > 0 ? options->max_area : HUGE_VAL;
    double own = options->region_areas ? mesh->regions[region].max_area : 0;
    bound = own > 0 && own < bound ? own : bound;
    bound *= options->area_scale > 0 ? options->area_scale : 1;
    return bound < HUGE_VAL ? mesh->unit / (MEAN_OVER_BOUND * bound) * mesh->unit : 0;
}

static bool has_areas(const struct tri_refine_options *options)
{
    return options->max_area > 0 || options->region_areas;
}

static double area_work(const struct tri_mesh *mesh, const struct tri_refine_options *options, int32_t t)
{
    const int32_t *v = mesh->tri[t].v;
    double work = 0.5 * tri_shape_of(mesh->xy, v).area2 * density(mesh, options, mesh->tri[t].region);
    return work < TRI_MAX_TRIANGLES ? work : TRI_MAX_TRIANGLES;
}

static double vertex_work(const struct tri_refine_options *options)
{
    return options->min_angle > 0 || options->conforming ? TRIANGLES_PER_VERTEX : 2;
}

double par_work_of(const struct tri_mesh *mesh, const struct tri_refine_options *options, int32_t t)
{
    double around = (has_areas(options) ? 0.5 : 0.65) * vertex_work(options); /* slots, beside those that become free */
    return tri_is_live(&mesh->tri[t]) ? area_work(mesh, options, t) + around : 0;
}

/* As the bounds ask for, be it more than any mesh can hold. */
static double whole_work(const struct tri_mesh *mesh, const struct tri_refine_options *options)
{
    double sum = vertex_work(options) * mesh->n_vertices;
    for (int32_t t = 0; has_areas(options) && t < mesh->n_slots; t++)
        if (tri_is_live(&mesh->tri[t]))
            sum += area_work(mesh, options, t);
    return sum;
}

double par_estimate(const struct tri_mesh *mesh, const struct tri_refine_options *options)
{
    double work = whole_work(mesh, options);
    return work < TRI_MAX_TRIANGLES ? work : TRI_MAX_TRIANGLES;
}

static bool add_sample(struct samples *s, struct tri_point q, double work)
{
    if (s->n == s->capacity) {
        size_t capacity = s->capacity ? 2 * s->capacity : 4096;
        struct sample *fresh = realloc(s->item, capacity * sizeof *fresh);
        if (!fresh)
            return false;
        s->item = fresh;
        s->capacity = capacity;
    }
    s->item[s->n++] = (struct sample){q, work};
    return true;
}

static struct tri_point middle(struct tri_point a, struct tri_point b)
{
    return (struct tri_point){0.5 * (a.x + b.x), 0.5 * (a.y + b.y)};
}

/* Samples a triangle's work, cut into four as long as a piece holds more than `grain`; depth bounds the recursion. */
static bool sample_triangle(struct samples *s, struct tri_point a, struct tri_point b, struct tri_point c, double work,
                            double grain, int depth)
{
    if (work <= grain || depth == 0) {
        struct tri_point q = {(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3};
        return add_sample(s, q, work);
    }
    struct tri_point ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    return sample_triangle(s, a, ab, ca, work / 4, grain, depth - 1) &&
           sample_triangle(s, ab, b, bc, work / 4, grain, depth - 1) &&
           sample_triangle(s, ca, bc, c, work / 4, grain, depth - 1) &&
           sample_triangle(s, ab, bc, ca, work / 4, grain, depth - 1);
}

/* Small pieces of work are gathered until they are worth a sample. */
static bool take_samples(struct samples *s, const struct tri_mesh *mesh, const struct tri_refine_options *options,
                         double grain)
{
    double waiting = 0, each = vertex_work(options);
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        waiting += each;
        if (waiting < grain)
            continue;
        if (!add_sample(s, mesh->xy[v], waiting))
            return false;
        waiting = 0;
    }
    for (int32_t t = 0; has_areas(options) && t < mesh->n_slots; t++) {
        const int32_t *v = mesh->tri[t].v;
        double work = tri_is_live(&mesh->tri[t]) ? area_work(mesh, options, t) : 0;
        waiting += work < grain ? work : 0;
        if (work < grain && waiting < grain)
            continue;
        if (!sample_triangle(s, mesh->xy[v[0]], mesh->xy[v[1]], mesh->xy[v[2]], work < grain ? waiting : work, grain,
                             DEEPEST_CUT))
            return false;
        waiting = work < grain ? 0 : waiting;
    }
    return true;
}

/* So that equal samples alone have no order: qsort is not stable everywhere, and sums depend on it. */
static int by_work(const struct sample *a, const struct sample *b) { return (a->work > b->work) - (a->work < b->work); }

static int by_x(const void *left, const void *right)
{
    const struct sample *a = left, *b = right;
    if (a->q.x != b->q.x)
        return a->q.x < b->q.x ? -1 : 1;
    return a->q.y != b->q.y ? (a->q.y < b->q.y ? -1 : 1) : by_work(a, b);
}

static int by_y(const void *left, const void *right)
{
    const struct sample *a = left, *b = right;
    if (a->q.y != b->q.y)
        return a->q.y < b->q.y ? -1 : 1;
    return a->q.x != b->q.x ? (a->q.x < b->q.x ? -1 : 1) : by_work(a, b);
}

/* Sorted samples first .. end - 1 into n shares of equal work; cut[k] receives the index at which share k begins. */
static void cut_shares(const struct sample *item, size_t first, size_t end, int32_t n, size_t *cut)
{
    double total = 0, sum = 0;
    int32_t k = 1;
    for (size_t i = first; i < end; i++)
        total += item[i].work;
    cut[0] = first;
    for (size_t i = first; i < end && k < n; i++) {
        sum += item[i].work;
        while (k < n && sum >= total * k / n)
            cut[k++] = i + 1;
    }
    while (k <= n)
        cut[k++] = end;
    cut[n] = end;
    assert(k == n + 1);
}

static double boundary(double before, double after) { return 0.5 * (before + after); }

static void cut_rows(struct par_partition *p, struct samples *s, size_t first, size_t end, int32_t column, size_t *cut)
{
    double *y = p->y + (size_t)column * ((size_t)p->n_rows + 1);
    if (end > first)
        qsort(s->item + first, end - first, sizeof *s->item, by_y);
    cut_shares(s->item, first, end, p->n_rows, cut);
    y[0] = p->low.y;
    y[p->n_rows] = p->high.y;
    for (int32_t k = 1; k < p->n_rows; k++) {
        size_t i = cut[k];
        double at = i > first && i < end ? boundary(s->item[i - 1].q.y, s->item[i].q.y) : y[k - 1];
        y[k] = at > y[k - 1] ? at : y[k - 1]; /* equal boundaries: an empty block */
    }
}

static bool cut_plane(struct par_partition *p, struct samples *s)
{
    size_t longest = (size_t)(p->n_columns > p->n_rows ? p->n_columns : p->n_rows) + 2;
    size_t *columns = malloc(longest * sizeof *columns), *rows = malloc(longest * sizeof *rows);
    if (columns && rows) {
        if (s->n > 0)
            qsort(s->item, s->n, sizeof *s->item, by_x);
        cut_shares(s->item, 0, s->n, p->n_columns, columns);
        p->x[0] = p->low.x;
        p->x[p->n_columns] = p->high.x;
        for (int32_t k = 1; k < p->n_columns; k++) {
            size_t i = columns[k];
            double at = i > 0 && i < s->n ? boundary(s->item[i - 1].q.x, s->item[i].q.x) : p->x[k - 1];
            p->x[k] = at > p->x[k - 1] ? at : p->x[k - 1];
        }
        for (int32_t k = 0; k < p->n_columns; k++)
            cut_rows(p, s, columns[k], columns[k + 1], k, rows);
    }
    bool done = columns && rows;
    free(columns);
    free(rows);
    return done;
}

static void find_box(struct par_partition *p, const struct tri_mesh *mesh)
{
    p->low = p->high = mesh->xy[0];
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        struct tri_point q = mesh->xy[v];
        p->low.x = q.x < p->low.x ? q.x : p->low.x;
        p->low.y = q.y < p->low.y ? q.y : p->low.y;
        p->high.x = q.x > p->high.x ? q.x : p->high.x;
        p->high.y = q.y > p->high.y ? q.y : p->high.y;
    }
}

/* As many columns as make blocks about square on average. */
static void choose_numbers(struct par_partition *p, double block_triangles)
{
    double width = p->high.x - p->low.x, height = p->high.y - p->low.y, blocks = p->estimate / block_triangles;
    blocks = blocks < 1 ? 1 : blocks > 1e6 ? 1e6 : blocks;
    double columns = width > 0 && height > 0 ? sqrt(blocks * (width / height)) : 1;
    columns = columns < 1 ? 1 : columns > blocks ? blocks : columns;
    p->n_columns = (int32_t)(columns + 0.5);
    p->n_rows = (int32_t)(blocks / p->n_columns + 0.5);
    p->n_rows = p->n_rows < 1 ? 1 : p->n_rows;
    assert(p->n_columns >= 1);
}

enum tri_status par_partition_make(struct par_partition *p, const struct tri_mesh *mesh,
                                   const struct tri_refine_options *options, double block_triangles,
                                   struct tri_error *error)
{
    struct samples s = {0};
    *p = (struct par_partition){.n_columns = 1, .n_rows = 1};
    p->estimate = par_estimate(mesh, options);
    if (mesh->n_vertices > 0) {
        find_box(p, mesh);
        choose_numbers(p, block_triangles);
    }
    p->x = malloc(((size_t)p->n_columns + 1) * sizeof *p->x);
    p->y = malloc((size_t)p->n_columns * ((size_t)p->n_rows + 1) * sizeof *p->y);
    double grain = whole_work(mesh, options) / par_blocks(p) / SAMPLES_PER_BLOCK;
    bool done = p->x && p->y && take_samples(&s, mesh, options, grain) && cut_plane(p, &s);
    free(s.item);
    if (done)
        return TRI_OK;
    par_partition_free(p);
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the partition into blocks");
}

enum tri_status par_partition_copy(struct par_partition *copy, const struct par_partition *p, struct tri_error *error)
{
    size_t n_x = (size_t)p->n_columns + 1, n_y = (size_t)p->n_columns * ((size_t)p->n_rows + 1);
    *copy = *p;
    copy->x = malloc(n_x * sizeof *copy->x);
    copy->y = malloc(n_y * sizeof *copy->y);
    if (!copy->x || !copy->y) {
        par_partition_free(copy);
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for a copy of the partition");
    }
    memcpy(copy->x, p->x, n_x * sizeof *copy->x);
    memcpy(copy->y, p->y, n_y * sizeof *copy->y);
    return TRI_OK;
}

void par_partition_coarsen(struct par_partition *p)
{
    int32_t columns = (p->n_columns + 1) / 2, rows = (p->n_rows + 1) / 2;
    for (int32_t c = 0; c < columns; c++) {
        const double *from = p->y + (size_t)(2 * c) * ((size_t)p->n_rows + 1);
        double *to = p->y + (size_t)c * ((size_t)rows + 1);
        for (int32_t k = 0; k < rows; k++)
            to[k] = from[2 * k];
        to[rows] = p->high.y;
    }
    for (int32_t c = 0; c < columns; c++)
        p->x[c] = p->x[2 * c];
    p->x[columns] = p->high.x;
    p->n_columns = columns;
    p->n_rows = rows;
}

void par_partition_free(struct par_partition *p)
{
    free(p->x);
    free(p->y);
    *p = (struct par_partition){0};
}

/* From the middle of the interval before to the middle of the one after; to infinity where no interval of the same
 * parity follows, so that those of each parity tile the line. */
static void span(const double *bounds, int32_t k, int32_t n, double *low, double *high)
{
    *low = k < 2 ? -HUGE_VAL : 0.5 * (bounds[k - 1] + bounds[k]);
    *high = k >= n - 2 ? HUGE_VAL : 0.5 * (bounds[k + 1] + bounds[k + 2]);
}

static const double *rows_of(const struct par_partition *p, int32_t column)
{
    return p->y + (size_t)column * ((size_t)p->n_rows + 1);
}

struct tri_fence par_fence(const struct par_partition *p, int32_t column, int32_t row)
{
    struct tri_fence fence;
    assert(column >= 0 && column < p->n_columns && row >= 0 && row < p->n_rows);
    span(p->x, column, p->n_columns, &fence.x_min, &fence.x_max);
    span(rows_of(p, column), row, p->n_rows, &fence.y_min, &fence.y_max);
    return fence;
}

/* The interval that holds q. */
static int32_t interval_at(const double *bounds, int32_t n, double q)
{
    int32_t low = 0, high = n; /* bounds[low] <= q < bounds[high] */
    while (high - low > 1) {
        int32_t mid = low + (high - low) / 2;
        if (bounds[mid] <= q)
            low = mid;
        else
            high = mid;
    }
    return low;
}

/* The interval of the given parity whose span holds q, or TRI_NONE: it is the one that holds q or a neighbour of it. */
static int32_t spanning_interval(const double *bounds, int32_t n, int parity, double q)
{
    int32_t at = interval_at(bounds, n, q);
    for (int32_t k = at - 1; k <= at + 1; k++) {
        double low, high;
        if (k < 0 || k >= n || k % 2 != parity)
            continue;
        span(bounds, k, n, &low, &high);
        if (low <= q && q < high)
            return k;
    }
    return TRI_NONE;
}

int32_t par_block_at(const struct par_partition *p, int colour, struct tri_point q)
{
    assert(colour >= 0 && colour < PAR_COLOURS);
    int32_t column = spanning_interval(p->x, p->n_columns, colour & 1, q.x);
    if (column == TRI_NONE)
        return TRI_NONE;
    int32_t row = spanning_interval(rows_of(p, column), p->n_rows, colour >> 1, q.y);
    return row == TRI_NONE ? TRI_NONE : column * p->n_rows + row;
}

int32_t par_owner_of(const struct par_partition *p, int colour, const struct tri_mesh *mesh, int32_t t)
{
    const int32_t *v = mesh->tri[t].v;
    int32_t block = par_block_at(p, colour, mesh->xy[v[0]]);
    for (int k = 1; k < 3 && block != TRI_NONE; k++)
        if (par_block_at(p, colour, mesh->xy[v[k]]) != block)
            block = TRI_NONE;
    return block;
}

double par_cell_size(const struct par_partition *p, struct tri_point q)
{
    int32_t column = interval_at(p->x, p->n_columns, q.x);
    const double *y = rows_of(p, column);
    int32_t row = interval_at(y, p->n_rows, q.y);
    double width = p->x[column + 1] - p->x[column], height = y[row + 1] - y[row];
    return width < height ? width : height;
}
