/* The cells are quantiles of the estimated work (triangle/size/estimate.h), first along x, then along y in each column.
 * About 32 samples for a cell are enough for shares that are equal within a sixth. All samples are sorted along x in
 * runs, which are then merged in pairs; each column is sorted along y, and then merged with its neighbour. All of this
 * runs as tasks. Samples that compare equal are identical, so the result does not depend on the sorting algorithm.
 *
 * SHAPE. Averaged over the bounding box of the mesh, cells are about square. This choice is bad if nearly all of the
 * work lies along a line, such as a long narrow gap: cells then become long strips inside the gap. A block that covers
 * one side of the gap's wall cannot split the wall, and refines only up to it. The other side is refined later, step by
 * step, from triangles that are already good. In such a mesh, sizes grow several times as slowly. (Measured at 32
 * degrees: up to 2.3 times the triangles of one sequential call; with cells across the gap, 1.06 times.) Therefore the
 * box of the middle half of the work is compared with the bounding box of the mesh. If it is PAR_SKEW times more
 * elongated, the numbers of columns and rows are chosen from this box, so that the cells with most of the work are
 * square up to this factor. */
#include "sched/schedule/partition.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "sched/tunables.h"
#include "triangle/base/grow.h"
#include "triangle/base/radix.h"
#include "triangle/size/estimate.h"

enum {
    RUNS = 16, /* number of runs, a power of two; each is sorted by a task */
    FEW = 1024 /* fewer samples are sorted as one run */
};

/* A place of estimated work. */
struct sample {
    struct tri_point q; /* the place */
    double work;        /* estimated number of triangles around it */
};

/* A growing list of samples. */
struct samples {
    struct sample *item;  /* [n] the samples */
    int64_t n, capacity;  /* number of samples; allocated samples */
};

/* A tri_take_work callback: appends a sample. user is a struct samples. False: no memory. */
static bool add_sample(void *user, struct tri_point q, double work)
{
    struct samples *s = user;
    if (!tri_grow_far(&s->item, &s->capacity, s->n + 1, sizeof *s->item))
        return false;
    s->item[s->n++] = (struct sample){q, work};
    return true;
}

/* Both orders end with this comparison, so that only identical samples compare equal. Otherwise the result could differ
 * between machines, because qsort is not stable everywhere and the rounding of sums depends on the order. */
static int by_work(const struct sample *a, const struct sample *b) { return (a->work > b->work) - (a->work < b->work); }

/* Order by x, then y, then work. */
static int by_x(const void *left, const void *right)
{
    const struct sample *a = left, *b = right;
    if (a->q.x != b->q.x)
        return a->q.x < b->q.x ? -1 : 1;
    return a->q.y != b->q.y ? (a->q.y < b->q.y ? -1 : 1) : by_work(a, b);
}

/* Order by y, then x, then work. */
static int by_y(const void *left, const void *right)
{
    const struct sample *a = left, *b = right;
    if (a->q.y != b->q.y)
        return a->q.y < b->q.y ? -1 : 1;
    return a->q.x != b->q.x ? (a->q.x < b->q.x ? -1 : 1) : by_work(a, b);
}

typedef int compare_samples(const void *left, const void *right);

/* Makes a sorting key for each sample: its position in the width or height of the plane in the upper 32 bits, its index
 * in the lower. The position is monotonic, so only samples with equal positions need to be compared exactly. */
static void make_keys(const struct sample *item, int32_t n, bool along_x, uint64_t *key)
{
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int32_t i = 0; i < n; i++) {
        const double at = along_x ? item[i].q.x : item[i].q.y;
        low = at < low ? at : low;
        high = at > high ? at : high;
    }
    /* Use halves, because the width itself may overflow. */
    const double scale = UINT32_MAX / (high / 2 - low / 2), finite = scale < HUGE_VAL ? scale : 0;
    for (int32_t i = 0; i < n; i++)
        key[i] = (uint64_t)(((along_x ? item[i].q.x : item[i].q.y) / 2 - low / 2) * finite) << 32 | (uint32_t)i;
}

/* Sorts samples along an axis: by radix sort of their keys, then exactly within equal keys. room: scratch memory for
 * twice as many samples. */
static void sort_along(struct sample *item, int64_t n, bool along_x, struct sample *room)
{
    compare_samples *const compare = along_x ? by_x : by_y;
    uint64_t *key = (uint64_t *)(void *)room;
    struct sample *sorted = room + n;
    _Static_assert(sizeof(struct sample) >= 2 * sizeof(uint64_t), "keys and their scratch fit where samples do");
    if (n > INT32_MAX) {
        qsort(item, (size_t)n, sizeof *item, compare);
        return;
    }
    make_keys(item, (int32_t)n, along_x, key);
    /* Sort by the upper half of the keys; the lower half then says which sample goes where. */
    tri_radix_sort(key, key + n, (int32_t)n, 32, 64, NULL);
    for (int64_t i = 0; i < n; i++)
        sorted[i] = item[key[i] & UINT32_MAX];
    for (int64_t i = 0, end; i < n; i = end) {
        for (end = i + 1; end < n && key[end] >> 32 == key[i] >> 32;)
            end++;
        /* Samples with equal upper halves: compare exactly. */
        if (end - i > 1)
            qsort(sorted + i, (size_t)(end - i), sizeof *sorted, compare);
    }
    memcpy(item, sorted, (size_t)n * sizeof *item);
}

/* Samples in runs that are to be sorted or merged. */
struct runs {
    struct sample *from, *to; /* the samples; scratch memory for twice as many */
    int64_t n, runs;          /* number of samples; number of runs */
};

/* The first sample of a run. */
static int64_t run_begin(const struct runs *r, size_t run) { return r->n * (int64_t)run / r->runs; }

/* A task: sorts one run along x. */
static void sort_run(void *context, size_t run)
{
    const struct runs *r = context;
    int64_t begin = run_begin(r, run), end = run_begin(r, run + 1);
    if (begin < end)
        sort_along(r->from + begin, end - begin, true, r->to + 2 * begin);
}

/* Merges two sorted lists into one. */
static void merge(const struct sample *a, int64_t n_a, const struct sample *b, int64_t n_b, compare_samples *compare,
                  struct sample *to)
{
    for (int64_t i = 0, k = 0; i + k < n_a + n_b;) {
        bool first = k == n_b || (i < n_a && compare(&a[i], &b[k]) <= 0);
        to[i + k] = first ? a[i] : b[k];
        i += first;
        k += !first;
    }
}

/* A task: merges two neighbouring runs. */
static void merge_runs(void *context, size_t pair)
{
    const struct runs *r = context;
    int64_t a = run_begin(r, 2 * pair), middle = run_begin(r, 2 * pair + 1), end = run_begin(r, 2 * pair + 2);
    merge(r->from + a, middle - a, r->from + middle, end - middle, by_x, r->to + a);
}

/* Sorts all samples along x. scratch: memory for twice as many samples. */
static void sort_by_x(struct samples *s, struct sample *scratch, const struct tri_executor *executor)
{
    struct runs r = {s->item, scratch, s->n, s->n < FEW ? 1 : RUNS};
    tri_execute(executor, (size_t)r.runs, sort_run, &r);
    for (; r.runs > 1; r.runs /= 2) {
        tri_execute(executor, (size_t)r.runs / 2, merge_runs, &r);
        /* Each round of merging swaps the two arrays. */
        struct sample *merged = r.to;
        r.to = r.from;
        r.from = merged;
    }
    if (r.from != s->item && s->n > 0)
        memcpy(s->item, r.from, (size_t)s->n * sizeof *s->item);
}

/* Cuts sorted samples into n shares of equal work. cut[k] receives the index of the first sample of share k, and cut[n]
 * the number of samples. */
static void cut_shares(const struct samples *s, int32_t n, int64_t *cut)
{
    double total = 0, sum = 0;
    int32_t k = 1;
    for (int64_t i = 0; i < s->n; i++)
        total += s->item[i].work;
    cut[0] = 0;
    for (int64_t i = 0; i < s->n && k < n; i++) {
        sum += s->item[i].work;
        /* One sample may end several shares, some of which are then empty. */
        while (k < n && sum >= total * k / n)
            cut[k++] = i + 1;
    }
    while (k <= n)
        cut[k++] = s->n;
    assert(k == n + 1);
}

/* Places the boundaries halfway between the last sample of a share and the first of the next. The boundaries of an
 * empty share are equal: an empty cell. */
static void place_bounds(double *bounds, int32_t n_shares, const struct samples *s, const int64_t *cut, bool along_x,
                         double low, double high)
{
    bounds[0] = low;
    bounds[n_shares] = high;
    for (int32_t k = 1; k < n_shares; k++) {
        int64_t i = cut[k];
        bounds[k] = bounds[k - 1];
        if (i == 0 || i >= s->n)
            continue;
        struct tri_point a = s->item[i - 1].q, b = s->item[i].q;
        double here = along_x ? 0.5 * (a.x + b.x) : 0.5 * (a.y + b.y);
        bounds[k] = here > bounds[k] ? here : bounds[k];
    }
}

/* Cutting columns into rows: the common data of its tasks. */
struct cutting {
    struct par_partition *p; /* the result */
    struct samples *s;       /* all samples, ordered by column */
    const int64_t *column;   /* [n_columns] the first sample of each column of cells; the last entry is the number of
                                samples */
    struct sample *scratch;  /* [2 * s->n] scratch memory */
    int64_t *cut;            /* [n_columns][n_rows] the first sample of each row, for each column of blocks */
};

/* A task: sorts the samples of one column of cells along y. */
static void sort_column(void *context, size_t k)
{
    const struct cutting *c = context;
    const int64_t first = c->column[k], n = c->column[k + 1] - first;
    if (n > 0)
        sort_along(c->s->item + first, n, false, c->scratch + 2 * first);
}

/* A task: places the row boundaries of one column of blocks, which covers one or two columns of cells. Their sorted
 * samples are merged into a part of the scratch memory that no other task uses. */
static void cut_rows(void *context, size_t k)
{
    const struct cutting *c = context;
    const size_t before = k > 0 ? k - 1 : 0, after = k + 1 < (size_t)c->p->n_columns ? k + 1 : k;
    const size_t rows = (size_t)c->p->n_rows;
    const int64_t first = c->column[before], middle = c->column[k], end = c->column[after], n = end - first;
    /* Column k writes to places first + middle .. middle + end - 1 of the scratch memory; the next column begins
     * there. */
    struct samples inside = {c->scratch + (k > 0 ? first + middle : 0), n, n};
    merge(c->s->item + first, middle - first, c->s->item + middle, end - middle, by_y, inside.item);
    cut_shares(&inside, c->p->n_rows - 1, c->cut + k * rows);
    place_bounds(c->p->y + k * rows, c->p->n_rows - 1, &inside, c->cut + k * rows, false, c->p->low.y, c->p->high.y);
}

/* Places all boundaries of columns and rows. False: no memory. */
static bool cut_plane(struct par_partition *p, struct samples *s, const struct tri_executor *executor)
{
    const size_t n_columns = (size_t)p->n_columns;
    int64_t *columns = malloc(n_columns * sizeof *columns);
    int64_t *rows = malloc(n_columns * (size_t)p->n_rows * sizeof *rows);
    struct sample *scratch = malloc((2 * (size_t)s->n + 1) * sizeof *scratch);
    if (columns && rows && scratch) {
        struct cutting cutting = {p, s, columns, scratch, rows};
        sort_by_x(s, scratch, executor);
        cut_shares(s, p->n_columns - 1, columns);
        place_bounds(p->x, p->n_columns - 1, s, columns, true, p->low.x, p->high.x);
        tri_execute(executor, n_columns - 1, sort_column, &cutting);
        tri_execute(executor, n_columns, cut_rows, &cutting);
    }
    bool done = columns && rows && scratch;
    free(columns);
    free(rows);
    free(scratch);
    return done;
}

/* Finding the bounding box: the common data of its tasks. */
struct boxing {
    const struct tri_mesh *mesh; /* the mesh */
    struct tri_point low[TRI_MOST_SHARES], high[TRI_MOST_SHARES]; /* box of each share's vertices */
};

/* Extends a box by another one. */
static void extend_box(struct tri_point *low, struct tri_point *high, struct tri_point from, struct tri_point to)
{
    low->x = from.x < low->x ? from.x : low->x;
    low->y = from.y < low->y ? from.y : low->y;
    high->x = to.x > high->x ? to.x : high->x;
    high->y = to.y > high->y ? to.y : high->y;
}

/* A task: finds the box of the vertices of one share. */
static void box_share(void *context, size_t share)
{
    struct boxing *b = context;
    const struct tri_range range = tri_share(share, b->mesh->n_vertices);
    struct tri_point low = b->mesh->xy[range.first], high = low;
    for (tri_vertex_id v = range.first; v < range.last; v++)
        extend_box(&low, &high, b->mesh->xy[v], b->mesh->xy[v]);
    b->low[share] = low;
    b->high[share] = high;
}

/* Finds the bounding box of the mesh, which has at least one vertex. */
static void find_box(struct par_partition *p, const struct tri_mesh *mesh, const struct tri_executor *executor)
{
    struct boxing boxing = {.mesh = mesh};
    tri_execute(executor, tri_shares(mesh->n_vertices), box_share, &boxing);
    p->low = boxing.low[0];
    p->high = boxing.high[0];
    for (size_t share = 1; share < tri_shares(mesh->n_vertices); share++)
        extend_box(&p->low, &p->high, boxing.low[share], boxing.high[share]);
}

/* Chooses the numbers of columns and rows so that cells are about square on average in a box of this shape. Both
 * numbers are even, so that cells form pairs. */
static void choose_numbers(struct par_partition *p, double cell_triangles, double width, double height)
{
    double cells = p->estimate / cell_triangles;
    /* At least two by two cells; far more than a million would cost more than they are worth. */
    cells = cells < 4 ? 4 : cells > 1e6 ? 1e6 : cells;
    double columns = height > 0 ? sqrt(cells * (width / height)) : width > 0 ? cells : 1;
    columns = columns < 2 ? 2 : columns > cells / 2 ? cells / 2 : columns;
    int32_t pairs = (int32_t)(columns / 2 + 0.5);
    double rows = cells / (2 * pairs);
    p->n_columns = 2 * pairs + 1;
    p->n_rows = 2 * (int32_t)(rows < 2 ? 1 : rows / 2 + 0.5) + 1;
    assert(p->n_columns >= 3 && p->n_rows >= 3);
}

/* Returns the width of the middle half of n - 1 shares, at least two of them. */
static double middle_half(const double *bounds, int32_t n)
{
    int32_t quarter = (n - 1) / 4;
    return bounds[n - 1 - quarter] - bounds[quarter];
}

/* Chooses the numbers again if the work is much more elongated than the box for which they were chosen. Returns whether
 * they have changed. */
static bool choose_for_work(struct par_partition *p, double cell_triangles)
{
    int32_t columns = p->n_columns, rows = p->n_rows;
    double width = p->high.x - p->low.x, height = p->high.y - p->low.y, middle = middle_half(p->x, columns);
    /* The height is measured in the middle column. */
    double middle_height = middle_half(p->y + (size_t)(columns / 2) * (size_t)rows, rows);
    if (PAR_SKEW * middle * height < middle_height * width)
        choose_numbers(p, cell_triangles, PAR_SKEW * middle, middle_height);
    else if (PAR_SKEW * middle_height * width < middle * height)
        choose_numbers(p, cell_triangles, middle, PAR_SKEW * middle_height);
    return p->n_columns != columns || p->n_rows != rows;
}

/* Cuts the plane with the current numbers of columns and rows. False: no memory. */
static bool cut_again(struct par_partition *p, struct samples *s, const struct tri_executor *executor)
{
    free(p->x);
    free(p->y);
    p->x = malloc((size_t)p->n_columns * sizeof *p->x);
    p->y = malloc((size_t)p->n_columns * (size_t)p->n_rows * sizeof *p->y);
    return p->x && p->y && cut_plane(p, s, executor);
}

enum tri_status par_partition_make(struct par_partition *p, const struct tri_mesh *mesh,
                                   const struct tri_quality *quality, double estimate, double cell_triangles,
                                   const struct tri_executor *executor, struct tri_error *error)
{
    struct samples s = {0};
    *p = (struct par_partition){.n_columns = 3, .n_rows = 3, .estimate = estimate};
    if (mesh->n_vertices > 0) {
        find_box(p, mesh, executor);
        choose_numbers(p, cell_triangles, p->high.x - p->low.x, p->high.y - p->low.y);
    }
    /* Each sample stands for about this much work. */
    double grain = estimate / par_cells(p) / PAR_SAMPLES_PER_CELL;
    bool done = tri_sample_work(mesh, quality, grain, executor, add_sample, &s) && cut_again(p, &s, executor);
    /* If the first cut shows that the work is very elongated, cut again. */
    if (done && choose_for_work(p, cell_triangles))
        done = cut_again(p, &s, executor);
    free(s.item);
    if (done)
        return TRI_OK;
    par_partition_free(p);
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the partition into blocks");
}

enum tri_status par_partition_copy(struct par_partition *copy, const struct par_partition *p, struct tri_error *error)
{
    size_t n_x = (size_t)p->n_columns, n_y = n_x * (size_t)p->n_rows;
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

/* Returns the number of boundaries after n - 1 cells have been merged in pairs. If n - 1 is not a multiple of four, the
 * last cell becomes empty. */
static int32_t coarser(int32_t n) { return 2 * ((n + 2) / 4) + 1; }

/* Keeps every second boundary. from and to may overlap. */
static void merge_cells(const double *from, int32_t n, double *to)
{
    for (int32_t k = 0; k < coarser(n); k++)
        to[k] = from[2 * k < n - 1 ? 2 * k : n - 1];
}

void par_partition_coarsen(struct par_partition *p)
{
    int32_t columns = coarser(p->n_columns), rows = coarser(p->n_rows);
    for (int32_t c = 0; c < columns; c++) { /* in place: each entry is read before it is overwritten */
        int32_t from = 2 * c < p->n_columns - 1 ? 2 * c : p->n_columns - 1;
        merge_cells(p->y + (size_t)from * (size_t)p->n_rows, p->n_rows, p->y + (size_t)c * (size_t)rows);
    }
    merge_cells(p->x, p->n_columns, p->x);
    p->n_columns = columns;
    p->n_rows = rows;
    assert(columns >= 3 && columns % 2 == 1 && rows >= 3 && rows % 2 == 1);
}

void par_partition_free(struct par_partition *p)
{
    free(p->x);
    free(p->y);
    *p = (struct par_partition){0};
}

/* The interval of block k along one axis; outer blocks reach to infinity. */
static void block_interval(const double *bounds, int32_t k, int32_t n, double *low, double *high)
{
    *low = k < 2 ? -HUGE_VAL : bounds[k - 1];
    *high = k >= n - 2 ? HUGE_VAL : bounds[k + 1];
}

/* The boundaries of rows in a column of blocks. */
static const double *rows_of(const struct par_partition *p, int32_t column)
{
    return p->y + (size_t)column * (size_t)p->n_rows;
}

struct tri_fence par_fence(const struct par_partition *p, int32_t column, int32_t row)
{
    struct tri_fence fence;
    assert(column >= 0 && column < p->n_columns && row >= 0 && row < p->n_rows);
    block_interval(p->x, column, p->n_columns, &fence.x_min, &fence.x_max);
    block_interval(rows_of(p, column), row, p->n_rows, &fence.y_min, &fence.y_max);
    return fence;
}

/* Returns the cell that holds q, or the first or last cell if q lies outside. There is no branch, since a branch could
 * not be predicted. */
static int32_t cell_at(const double *bounds, int32_t n, double q)
{
    int32_t low = 0; /* invariant: the cell is one of low .. low + left - 1 */
    for (int32_t left = n - 1, half; left > 1; left -= half) {
        half = left / 2;
        low += half & -(int32_t)(bounds[low + half] <= q);
    }
    return low;
}

/* Of the two blocks that cover a cell, returns the one whose number has this parity. */
static int32_t block_over(int32_t cell, int parity) { return cell % 2 == parity ? cell : cell + 1; }

int32_t par_block_at(const struct par_partition *p, int phase, struct tri_point q)
{
    assert(phase >= 0 && phase < PAR_PHASES);
    int32_t column = block_over(cell_at(p->x, p->n_columns, q.x), 1 - (phase >> 1));
    int32_t row = block_over(cell_at(rows_of(p, column), p->n_rows, q.y), 1 - (phase & 1));
    assert(column < p->n_columns && row < p->n_rows);
    return column * p->n_rows + row;
}

int32_t par_last_tile(const struct par_partition *p, const struct tri_mesh *mesh, const tri_vertex_id *v, int n)
{
    int32_t last = -1;
    for (int k = 0; k < n; k++) {
        int32_t tile = par_block_at(p, 0, mesh->xy[v[k]]);
        last = tile > last ? tile : last;
    }
    return last;
}

int32_t par_owner_of(const struct par_partition *p, int phase, const struct tri_mesh *mesh, tri_triangle_id t)
{
    struct par_locator locator = PAR_LOST;
    return par_locate_owner(&locator, p, phase, mesh, t);
}

int32_t par_locate_owner(struct par_locator *locator, const struct par_partition *p, int phase,
                         const struct tri_mesh *mesh, tri_triangle_id t)
{
    const tri_vertex_id *v = mesh->tri[t].v;
    assert(tri_is_live(&mesh->tri[t]));
    /* Find the block of the first corner. It owns the triangle if its fence holds the other two corners as well. */
    int32_t block = par_locate(locator, p, phase, mesh->xy[v[0]]);
    bool owns = tri_fence_holds(&locator->fence, mesh->xy[v[1]]) && tri_fence_holds(&locator->fence, mesh->xy[v[2]]);
    return owns ? block : TRI_NONE;
}

double par_cell_size(const struct par_partition *p, struct tri_point q)
{
    int32_t column = cell_at(p->x, p->n_columns, q.x);
    const double *y = rows_of(p, block_over(column, 1));
    int32_t row = cell_at(y, p->n_rows, q.y);
    double width = p->x[column + 1] - p->x[column], height = y[row + 1] - y[row];
    return width < height ? width : height;
}
