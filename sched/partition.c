/* Quantiles of the estimated work, first along x, then along y in each column.
 *
 * The work of a triangle has two parts: what an area bound asks for inside it, and what an angle bound asks for to
 * grade from its shortest edge to its longest. The work is sampled: for the first part, large triangles are cut into
 * small ones first, so that their work lies where it is; the second lies at the shortest edge. There are some 32
 * samples for a cell: enough for shares equal within a sixth, few enough to sort in no time. */
#include "sched/partition.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/criterion.h"
#include "triangle/quality.h"
#include "triangle/small_angle.h"

enum { SAMPLES_PER_CELL = 32, DEEPEST_CUT = 12, SURVEY = 1 << 17 };

/* Measured: mean area over bound. */
static const double MEAN_OVER_BOUND = 0.655;

struct corners {
    struct tri_point a, b, c;
};

/* What work is estimated from. */
struct estimator {
    const struct tri_mesh *mesh;
    const struct tri_refine_options *options;
    double large; /* a size test is probed in pieces no larger than this */
    struct tri_criterion criterion;
};

struct sample {
    struct tri_point q;
    double work;
};

struct samples {
    struct sample *item;
    size_t n, capacity;
};

/* Triangles that the bounds ask for on one unit of area in this region; 0 without bound. */
static double density(const struct estimator *e, int32_t region)
{
    return 2 / (MEAN_OVER_BOUND * tri_area2_bound(&e->criterion, region));
}

/* Triangles that the caller's size test asks for in this one, by probing: it is asked about the triangle shrunk to a
 * quarter, a sixteenth and so on of its area, until it says yes; 0 where it does at once, and also where it never does,
 * since then it is no test of size. */
static double probe_size(const struct estimator *e, const struct corners *t)
{
    enum { DEEPEST_PROBE = 16 };
    double scale = tri_area_scale(e->options), pieces = 1;
    for (int k = 0; k <= DEEPEST_PROBE; k++, pieces *= 4)
        if (!tri_is_refused(e->options, e->mesh->unit, t->a, t->b, t->c, scale * pieces))
            return k > 0 ? pieces : 0;
    return 0;
}

static struct tri_point middle(struct tri_point a, struct tri_point b)
{
    return (struct tri_point){0.5 * (a.x + b.x), 0.5 * (a.y + b.y)};
}

/* A triangle in four. */
static void quarter(const struct corners *t, struct corners part[4])
{
    struct tri_point ab = middle(t->a, t->b), bc = middle(t->b, t->c), ca = middle(t->c, t->a);
    part[0] = (struct corners){t->a, ab, ca};
    part[1] = (struct corners){ab, t->b, bc};
    part[2] = (struct corners){ca, bc, t->c};
    part[3] = (struct corners){ab, bc, ca};
}

static double area_of(const struct corners *t)
{
    double bx = t->b.x - t->a.x, by = t->b.y - t->a.y, cx = t->c.x - t->a.x, cy = t->c.y - t->a.y;
    return 0.5 * (bx * cy - by * cx);
}

/* The same where sizes vary inside: in a large triangle, or where a probe says many, its quarters are probed. */
static double size_work(const struct estimator *e, const struct corners *t, int depth)
{
    enum { MANY = 1024 };
    double work = probe_size(e, t), sum = 0;
    if (depth == 0 || (work <= MANY && area_of(t) <= e->large))
        return work;
    struct corners part[4];
    quarter(t, part);
    for (int i = 0; i < 4; i++)
        sum += size_work(e, &part[i], depth - 1);
    return work <= MANY ? fmax(work, sum) : sum;
}

/* Triangles that areas and size test ask for in a piece of a triangle of this region. */
static double work_inside(const struct estimator *e, int32_t region, const struct corners *t)
{
    double work = area_of(t) * density(e, region);
    if (e->options->unsuitable)
        work = fmax(work, size_work(e, t, DEEPEST_CUT));
    return work < TRI_MAX_TRIANGLES ? work : TRI_MAX_TRIANGLES;
}

static struct corners corners_of(const struct tri_mesh *mesh, int32_t t)
{
    const int32_t *v = mesh->tri[t].v;
    return (struct corners){mesh->xy[v[0]], mesh->xy[v[1]], mesh->xy[v[2]]};
}

static double area_work(const struct estimator *e, int32_t t)
{
    struct corners corners = corners_of(e->mesh, t);
    return tri_has_sizes(e->options) ? work_inside(e, e->mesh->tri[t].region, &corners) : 0;
}

/* log2(x) for x >= 1, within 0.09: the exponent, and the mantissa for the rest. */
static double rough_log2(double x)
{
    int exponent;
    double mantissa = frexp(x, &exponent);
    return exponent + 2 * mantissa - 2;
}

/* Triangles that an angle bound makes of one. Sizes grow by a factor from row to row, so that an octave between the
 * shortest edge and the longest takes a number of triangles that the bound alone decides; a narrow space between
 * segments takes as many as it is times longer than wide, and the triangle bridges as much of it as it is long. A
 * hopeless triangle stays one.
 * Fitted to 14 coasts, parts and point sets at 20 to 34 degrees: 0.8 to 1.25 times what comes out, with few
 * exceptions (docs/performance.md). */
static double angle_work(const struct tri_mesh *mesh, const struct tri_refine_options *options, int32_t t)
{
    struct tri_shape shape = tri_shape_of(mesh->xy, mesh->tri[t].v);
    double longest2 = fmax(shape.l[0], fmax(shape.l[1], shape.l[2]));
    double octaves = 0.5 * rough_log2(longest2 / shape.l[shape.shortest]);
    double channel = tri_channel_cost(mesh, t, &shape), angle = fmin(options->min_angle, TRI_USUAL_ANGLE);
    if (tri_is_hopeless(mesh, t, &shape))
        return 1;
    channel = fmin(channel, sqrt(longest2 / shape.l[shape.shortest]));
    double work = angle > 0 ? 17 / (40 - angle) * (octaves + 2 * channel) : 0;
    return work < 1 ? 1 : work < TRI_MAX_TRIANGLES ? work : TRI_MAX_TRIANGLES;
}

/* A bad triangle becomes more than triangles do on average. */
static const double BAD = 1.25;

double par_work_of(const struct tri_mesh *mesh, const struct tri_refine_options *options, int32_t t)
{
    const struct estimator here = {mesh, options, HUGE_VAL, tri_criterion_of_areas(mesh, options)};
    return tri_is_live(&mesh->tri[t]) ? area_work(&here, t) + BAD * angle_work(mesh, options, t) : 0;
}

/* Of a large mesh the angle's work is taken from every n-th triangle; triangles lie along a curve, so that is fair. */
static int32_t survey_step(const struct tri_mesh *mesh) { return mesh->n_slots / SURVEY + 1; }

static struct estimator estimator_for(const struct tri_mesh *mesh, const struct tri_refine_options *options)
{
    enum { PIECES = 1 << 14 }; /* of the whole mesh */
    struct estimator e = {mesh, options, HUGE_VAL, tri_criterion_of_areas(mesh, options)};
    double all = 0;
    for (int32_t t = 0; options->unsuitable && t < mesh->n_slots; t++)
        if (tri_is_live(&mesh->tri[t])) {
            struct corners corners = corners_of(mesh, t);
            all += area_of(&corners);
        }
    if (options->unsuitable)
        e.large = all / PIECES;
    return e;
}

double par_sure_work(const struct tri_mesh *mesh, const struct tri_refine_options *options)
{
    const struct estimator e = estimator_for(mesh, options);
    double sum = mesh->n_slots;
    for (int32_t t = 0; tri_has_sizes(options) && t < mesh->n_slots; t++)
        if (tri_is_live(&mesh->tri[t]))
            sum += area_work(&e, t);
    return sum;
}

/* As the bounds ask for, be it more than any mesh can hold. */
static double whole_work(const struct tri_mesh *mesh, const struct tri_refine_options *options)
{
    int32_t step = survey_step(mesh);
    double sum = par_sure_work(mesh, options) - mesh->n_slots;
    for (int32_t t = 0; t < mesh->n_slots; t += step)
        if (tri_is_live(&mesh->tri[t]))
            sum += step * angle_work(mesh, options, t);
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

/* Samples a triangle's work, cut into four as long as a piece holds more than `grain`; depth bounds the recursion. */
static bool sample_triangle(struct samples *s, const struct estimator *e, int32_t region, const struct corners *t,
                            double work, double grain, int depth)
{
    if (work <= grain || depth == 0) {
        struct tri_point q = {(t->a.x + t->b.x + t->c.x) / 3, (t->a.y + t->b.y + t->c.y) / 3};
        return add_sample(s, q, work);
    }
    struct corners part[4];
    quarter(t, part);
    for (int i = 0; i < 4; i++) {
        double inside = e->options->unsuitable ? work_inside(e, region, &part[i]) : work / 4;
        if (!sample_triangle(s, e, region, &part[i], inside, grain, depth - 1))
            return false;
    }
    return true;
}

/* Small pieces of work are gathered until they are worth a sample. */
static bool take_angle_samples(struct samples *s, const struct tri_mesh *mesh,
                               const struct tri_refine_options *options, double grain)
{
    int32_t step = survey_step(mesh);
    double waiting = 0;
    for (int32_t t = 0; t < mesh->n_slots; t += step) {
        const int32_t *v = mesh->tri[t].v;
        if (!tri_is_live(&mesh->tri[t]))
            continue;
        waiting += step * angle_work(mesh, options, t);
        if (waiting < grain)
            continue;
        int k = tri_shape_of(mesh->xy, v).shortest;
        if (!add_sample(s, middle(mesh->xy[v[tri_next[k]]], mesh->xy[v[tri_prev[k]]]), waiting))
            return false;
        waiting = 0;
    }
    return true;
}

static bool take_area_samples(struct samples *s, const struct tri_mesh *mesh,
                              const struct tri_refine_options *options, double grain)
{
    const struct estimator e = estimator_for(mesh, options);
    double waiting = 0;
    for (int32_t t = 0; t < mesh->n_slots; t++) {
        double work = tri_is_live(&mesh->tri[t]) ? area_work(&e, t) : 0;
        waiting += work < grain ? work : 0;
        if (work < grain && waiting < grain)
            continue;
        struct corners corners = corners_of(mesh, t);
        if (!sample_triangle(s, &e, mesh->tri[t].region, &corners, work < grain ? waiting : work,
                             work < grain ? waiting : grain, DEEPEST_CUT))
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

/* Sorted samples into n shares of equal work; cut[k] receives the index at which share k begins, cut[n] that of the
 * end. */
static void cut_shares(const struct samples *s, int32_t n, size_t *cut)
{
    double total = 0, sum = 0;
    int32_t k = 1;
    for (size_t i = 0; i < s->n; i++)
        total += s->item[i].work;
    cut[0] = 0;
    for (size_t i = 0; i < s->n && k < n; i++) {
        sum += s->item[i].work;
        while (k < n && sum >= total * k / n)
            cut[k++] = i + 1;
    }
    while (k <= n)
        cut[k++] = s->n;
    assert(k == n + 1);
}

/* Boundaries half way between the last sample of a share and the first of the next. Where a share is empty they are
 * equal: an empty cell. */
static void place_bounds(double *bounds, int32_t n_shares, const struct samples *s, const size_t *cut, bool along_x,
                         double low, double high)
{
    bounds[0] = low;
    bounds[n_shares] = high;
    for (int32_t k = 1; k < n_shares; k++) {
        size_t i = cut[k];
        bounds[k] = bounds[k - 1];
        if (i == 0 || i >= s->n)
            continue;
        struct tri_point at = middle(s->item[i - 1].q, s->item[i].q);
        double here = along_x ? at.x : at.y;
        bounds[k] = here > bounds[k] ? here : bounds[k];
    }
}

/* Rows of a block column from the samples first .. end - 1, which lie in it. */
static void cut_rows(struct par_partition *p, const struct samples *s, size_t first, size_t end, int32_t column,
                     struct sample *scratch, size_t *cut)
{
    struct samples inside = {scratch, end - first, end - first};
    for (size_t i = 0; i < inside.n; i++)
        scratch[i] = s->item[first + i];
    if (inside.n > 0)
        qsort(scratch, inside.n, sizeof *scratch, by_y);
    cut_shares(&inside, p->n_rows - 1, cut);
    place_bounds(p->y + (size_t)column * (size_t)p->n_rows, p->n_rows - 1, &inside, cut, false, p->low.y, p->high.y);
}

static bool cut_plane(struct par_partition *p, struct samples *s)
{
    size_t *columns = malloc((size_t)p->n_columns * sizeof *columns), *rows = malloc((size_t)p->n_rows * sizeof *rows);
    struct sample *scratch = malloc((s->n + 1) * sizeof *scratch);
    int32_t last = p->n_columns - 1;
    if (columns && rows && scratch) {
        if (s->n > 0)
            qsort(s->item, s->n, sizeof *s->item, by_x);
        cut_shares(s, last, columns);
        place_bounds(p->x, last, s, columns, true, p->low.x, p->high.x);
        for (int32_t k = 0; k <= last; k++)
            cut_rows(p, s, columns[k > 0 ? k - 1 : 0], columns[k < last ? k + 1 : last], k, scratch, rows);
    }
    bool done = columns && rows && scratch;
    free(columns);
    free(rows);
    free(scratch);
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

/* As many columns as make cells about square on average, in pairs. */
static void choose_numbers(struct par_partition *p, double cell_triangles)
{
    double width = p->high.x - p->low.x, height = p->high.y - p->low.y, cells = p->estimate / cell_triangles;
    cells = cells < 4 ? 4 : cells > 1e6 ? 1e6 : cells;
    double columns = width > 0 && height > 0 ? sqrt(cells * (width / height)) : 1;
    columns = columns < 2 ? 2 : columns > cells / 2 ? cells / 2 : columns;
    int32_t pairs = (int32_t)(columns / 2 + 0.5);
    double rows = cells / (2 * pairs);
    p->n_columns = 2 * pairs + 1;
    p->n_rows = 2 * (int32_t)(rows < 2 ? 1 : rows / 2 + 0.5) + 1;
    assert(p->n_columns >= 3 && p->n_rows >= 3);
}

enum tri_status par_partition_make(struct par_partition *p, const struct tri_mesh *mesh,
                                   const struct tri_refine_options *options, double estimate, double cell_triangles,
                                   struct tri_error *error)
{
    struct samples s = {0};
    *p = (struct par_partition){.n_columns = 3, .n_rows = 3, .estimate = estimate};
    if (mesh->n_vertices > 0) {
        find_box(p, mesh);
        choose_numbers(p, cell_triangles);
    }
    p->x = malloc((size_t)p->n_columns * sizeof *p->x);
    p->y = malloc((size_t)p->n_columns * (size_t)p->n_rows * sizeof *p->y);
    double grain = estimate / par_cells(p) / SAMPLES_PER_CELL;
    bool done = p->x && p->y && take_angle_samples(&s, mesh, options, grain) &&
                (!tri_has_sizes(options) || take_area_samples(&s, mesh, options, grain)) && cut_plane(p, &s);
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

/* Two cells become one, from n - 1 cells; where they are no multiple of four the last one becomes empty. */
static int32_t coarser(int32_t n) { return 2 * ((n + 2) / 4) + 1; }

static void merge_cells(const double *from, int32_t n, double *to)
{
    for (int32_t k = 0; k < coarser(n); k++)
        to[k] = from[2 * k < n - 1 ? 2 * k : n - 1];
}

void par_partition_coarsen(struct par_partition *p)
{
    int32_t columns = coarser(p->n_columns), rows = coarser(p->n_rows);
    for (int32_t c = 0; c < columns; c++) { /* in place: what is written has been read */
        int32_t from = 2 * c < p->n_columns - 1 ? 2 * c : p->n_columns - 1;
        merge_cells(p->y + (size_t)from * (size_t)p->n_rows, p->n_rows, p->y + (size_t)c * (size_t)rows);
    }
    merge_cells(p->x, p->n_columns, p->x);
    p->n_columns = columns;
    p->n_rows = rows;
}

void par_partition_free(struct par_partition *p)
{
    free(p->x);
    free(p->y);
    *p = (struct par_partition){0};
}

static void span(const double *bounds, int32_t k, int32_t n, double *low, double *high)
{
    *low = k < 2 ? -HUGE_VAL : bounds[k - 1];
    *high = k >= n - 2 ? HUGE_VAL : bounds[k + 1];
}

static const double *rows_of(const struct par_partition *p, int32_t column)
{
    return p->y + (size_t)column * (size_t)p->n_rows;
}

struct tri_fence par_fence(const struct par_partition *p, int32_t column, int32_t row)
{
    struct tri_fence fence;
    assert(column >= 0 && column < p->n_columns && row >= 0 && row < p->n_rows);
    span(p->x, column, p->n_columns, &fence.x_min, &fence.x_max);
    span(rows_of(p, column), row, p->n_rows, &fence.y_min, &fence.y_max);
    return fence;
}

/* The cell that holds q, the first or last one for what lies outside. */
static int32_t cell_at(const double *bounds, int32_t n, double q)
{
    int32_t low = 0, high = n - 1; /* bounds[low] <= q < bounds[high] */
    while (high - low > 1) {
        int32_t mid = low + (high - low) / 2;
        if (bounds[mid] <= q)
            low = mid;
        else
            high = mid;
    }
    return low;
}

/* Of the two blocks over a cell, the one of this parity. */
static int32_t block_over(int32_t cell, int parity) { return cell % 2 == parity ? cell : cell + 1; }

int32_t par_block_at(const struct par_partition *p, int colour, struct tri_point q)
{
    assert(colour >= 0 && colour < PAR_COLOURS);
    int32_t column = block_over(cell_at(p->x, p->n_columns, q.x), 1 - (colour >> 1));
    int32_t row = block_over(cell_at(rows_of(p, column), p->n_rows, q.y), 1 - (colour & 1));
    return column * p->n_rows + row;
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
    int32_t column = cell_at(p->x, p->n_columns, q.x);
    const double *y = rows_of(p, block_over(column, 1));
    int32_t row = cell_at(y, p->n_rows, q.y);
    double width = p->x[column + 1] - p->x[column], height = y[row + 1] - y[row];
    return width < height ? width : height;
}
