/* Runs the checks in the order in which they depend on each other, and fills the report. Each check has its own
 * file. If a check fails, checks that depend on it are skipped, because their results would be meaningless. */
#include "triangle/check/check.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/grow.h"
#include "triangle/check/internal.h"

static const char *const names[TRI_N_CHECKS] = {
    [TRI_CHECK_ARRAYS] = "indices and coordinates",
    [TRI_CHECK_ORIENTATION] = "orientation",
    [TRI_CHECK_EDGES] = "edges in pairs",
    [TRI_CHECK_NEIGHBORS] = "neighbors",
    [TRI_CHECK_OVERLAP] = "no overlap",
    [TRI_CHECK_HULL] = "convex hull",
    [TRI_CHECK_SUBSEGMENTS] = "subsegments are edges",
    [TRI_CHECK_BOUNDARY] = "boundary is subsegments",
    [TRI_CHECK_LOCAL_DELAUNAY] = "Delaunay",
    [TRI_CHECK_ENCROACHMENT] = "diametral circles",
    [TRI_CHECK_INPUT_VERTICES] = "input vertices",
    [TRI_CHECK_LOST_VERTICES] = "no lost vertices",
    [TRI_CHECK_INPUT_SEGMENTS] = "input segments",
    [TRI_CHECK_MARKERS] = "segment markers",
    [TRI_CHECK_BORDER] = "boundary along the input",
    [TRI_CHECK_VERTEX_MARKERS] = "vertex markers",
    [TRI_CHECK_HOLES] = "holes",
    [TRI_CHECK_FACES] = "no unexpected holes",
    [TRI_CHECK_NODES] = "midside nodes",
    [TRI_CHECK_VERTEX_ATTRIBUTES] = "vertex attributes",
    [TRI_CHECK_REGIONS] = "regions",
    [TRI_CHECK_ANGLES] = "angles",
    [TRI_CHECK_AREAS] = "areas",
};

const char *tri_check_name(enum tri_check_kind kind)
{
    assert(kind >= 0 && kind < TRI_N_CHECKS);
    return names[kind];
}

bool tri_check_passed(const struct tri_check_report *report)
{
    for (int k = 0; k < TRI_N_CHECKS; k++) {
        if (report->item[k].state == TRI_CHECK_FAILED)
            return false;
    }
    return true;
}

void tri_check_begin(struct checker *c, enum tri_check_kind kind)
{
    struct tri_check_item *item = &c->report->item[kind];
    if (item->state == TRI_CHECK_SKIPPED)
        item->state = TRI_CHECK_OK;
}

/* Resets a kind to skipped. */
static void reset_kind(struct checker *c, enum tri_check_kind kind)
{
    memset(&c->report->item[kind], 0, sizeof c->report->item[kind]);
}

void tri_check_fault(struct checker *c, enum tri_check_kind kind, const char *format, ...)
{
    struct tri_check_item *item = &c->report->item[kind];
    item->state = TRI_CHECK_FAILED;
    if (item->count++ > 0 && c->at >= c->key[kind])
        return;
    c->key[kind] = c->at;
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(item->text, sizeof item->text, format, arguments);
    va_end(arguments);
}

struct sharing {
    int64_t n; /* number of items */
    size_t n_shares; /* number of shares */
    check_work *work; /* called for each share */
    void *user;       /* passed to work */
};

static void run_check_share(void *context, size_t i)
{
    const struct sharing *s = context;
    int64_t k = (int64_t)i, of = (int64_t)s->n_shares;
    s->work(s->user, &(struct check_share){i, s->n / of * k + s->n % of * k / of,
                                           s->n / of * (k + 1) + s->n % of * (k + 1) / of});
}

void tri_check_in_shares(const struct checker *c, int64_t n, check_work *work, void *user)
{
    enum { WORTH_A_SHARE = 1 << 12 };
    int64_t shares = n / WORTH_A_SHARE + 1;
    struct sharing sharing = {n, (size_t)(shares < CHECK_MOST_SHARES ? shares : CHECK_MOST_SHARES), work, user};
    assert(n >= 0);
    tri_execute(c->options->executor, sharing.n_shares, run_check_share, &sharing);
}

/* The result of each share: the number of items, and the first one. */
struct counting {
    const struct checker *c;
    bool (*is_so)(const struct checker *c, int64_t i); /* the test */
    int64_t n[CHECK_MOST_SHARES], first[CHECK_MOST_SHARES]; /* results of each share */
};

static void count_share(void *counting, const struct check_share *share)
{
    struct counting *k = counting;
    int64_t n = 0;
    for (int64_t i = share->first; i < share->end; i++)
        if (k->is_so(k->c, i) && n++ == 0)
            k->first[share->number] = i;
    k->n[share->number] = n;
}

int64_t tri_check_count(const struct checker *c, int64_t n, bool (*is_so)(const struct checker *c, int64_t i),
                        int64_t *first)
{
    struct counting counting = {.c = c, .is_so = is_so};
    int64_t sum = 0;
    tri_check_in_shares(c, n, count_share, &counting);
    for (int i = 0; i < CHECK_MOST_SHARES; i++) {
        if (sum == 0)
            *first = counting.first[i];
        sum += counting.n[i];
    }
    return sum;
}

void tri_check_each(struct checker *c, enum tri_check_kind kind, int64_t first, int64_t n,
                    bool (*is_bad)(const struct checker *c, int64_t i), void (*tell)(struct checker *c, int64_t i))
{
    int64_t before = c->report->item[kind].count, least;
    tri_check_begin(c, kind);
    int64_t n_bad = tri_check_count(c, n, is_bad, &least);
    if (n_bad == 0)
        return;
    c->at = first + least;
    tell(c, least);
    c->at = 0;
    c->report->item[kind].count = before + n_bad;
}

enum tri_status tri_check_read(struct checker *c, enum tri_check_array array, int64_t first, int64_t n, void *out)
{
    enum tri_status status = n > 0 ? c->source->read(c->source->user, array, first, n, out, c->error) : TRI_OK;
    double *values = out;
    for (int64_t i = 0; array == TRI_CHECK_POINTS && c->rounded && i < 2 * n; i++)
        values[i] = tri_round_coordinate(ldexp(values[i], c->exponent));
    return status;
}

enum tri_status tri_check_each_slice(struct checker *c, enum tri_check_array array, int64_t end, size_t bytes,
                                     check_take *take, void *user)
{
    enum { SLICE = 1 << 19 }; /* bytes */
    int64_t most = bytes < SLICE ? (int64_t)(SLICE / bytes) : 1;
    void *elements = tri_check_array(most, bytes);
    enum tri_status status = elements == NULL ? TRI_NO_MEMORY : TRI_OK;
    for (int64_t i = 0; i < end && status == TRI_OK; i += most) {
        int64_t n = end - i < most ? end - i : most;
        status = tri_check_read(c, array, i, n, elements);
        if (status == TRI_OK)
            take(user, i, n, elements);
    }
    free(elements);
    return status;
}

enum tri_status tri_check_gather(struct checker *c, enum tri_check_array array, const int64_t *numbers, int64_t n,
                                 size_t bytes, void *out)
{
    enum { NEAR_ENOUGH = 1 << 11, WINDOW = 1 << 14 }; /* elements */
    char *window = tri_check_array(WINDOW, bytes);
    enum tri_status status = window == NULL ? TRI_NO_MEMORY : TRI_OK;
    for (int64_t i = 0, j; i < n && status == TRI_OK; i = j) {
        int64_t first = numbers[i];
        for (j = i + 1; j < n && numbers[j] - numbers[j - 1] < NEAR_ENOUGH && numbers[j] - first < WINDOW; j++) {
        }
        status = tri_check_read(c, array, first, numbers[j - 1] + 1 - first, window);
        for (int64_t k = i; k < j; k++)
            memcpy((char *)out + bytes * (size_t)k, window + bytes * (size_t)(numbers[k] - first), bytes);
    }
    free(window);
    return status;
}

int tri_check_compare_numbers(const void *left, const void *right)
{
    int64_t a = *(const int64_t *)left, b = *(const int64_t *)right;
    return (a > b) - (a < b);
}

int64_t tri_check_distinct(int64_t *numbers, int64_t n)
{
    int64_t kept = 0;
    qsort(numbers, (size_t)n, sizeof *numbers, tri_check_compare_numbers);
    for (int64_t i = 0; i < n; i++) {
        if (i == 0 || numbers[i] != numbers[kept - 1])
            numbers[kept++] = numbers[i];
    }
    return kept;
}

void *tri_check_array(int64_t n, size_t size)
{
    assert(n >= 0 && size > 0);
    if ((uint64_t)n >= SIZE_MAX / size)
        return NULL;
    return malloc(((size_t)n + 1) * size);
}

void *tri_check_zeros(int64_t n, size_t size)
{
    assert(n >= 0 && size > 0);
    return (uint64_t)n >= SIZE_MAX / size ? NULL : calloc((size_t)n + 1, size);
}

enum tri_status tri_check_query(struct checker *c, struct tri_point at, enum tri_check_kind kind, int32_t id,
                              double tolerance)
{
    at = (struct tri_point){tri_round_coordinate(at.x), tri_round_coordinate(at.y)};
    if (!tri_is_in_range(at))
        return TRI_OK; /* it is outside the mesh, whose coordinates are all in range */
    if (!tri_grow(&c->queries, &c->query_capacity, c->n_queries + 1, sizeof *c->queries))
        return TRI_NO_MEMORY;
    c->queries[c->n_queries++] = (struct check_query){at, kind, id, tolerance, false};
    return TRI_OK;
}

/* --- arrays as a source */

static void widen(int64_t *out, const int32_t *values, int64_t n)
{
    for (int64_t i = 0; i < n; i++)
        out[i] = values[i];
}

static enum tri_status read_arrays(void *user, enum tri_check_array array, int64_t first, int64_t n, void *out,
                                   struct tri_error *error)
{
    const struct tri_check_mesh *m = user;
    (void)error;
    switch (array) {
    case TRI_CHECK_POINTS:
        memcpy(out, m->points + 2 * first, (size_t)n * 2 * sizeof(double));
        break;
    case TRI_CHECK_CORNERS:
        widen(out, m->triangles + 3 * first, 3 * n);
        break;
    case TRI_CHECK_NEIGHBORS_GIVEN:
        widen(out, m->neighbors + 3 * first, 3 * n);
        break;
    case TRI_CHECK_ATTRIBUTES:
        for (int64_t i = 0; i < n; i++)
            ((double *)out)[i] = m->attributes[m->n_attributes * (first + i + 1) - 1];
        break;
    case TRI_CHECK_SEGMENT_ENDS:
        widen(out, m->segments + 2 * first, 2 * n);
        break;
    case TRI_CHECK_MIDDLES:
        widen(out, m->middles + 3 * first, 3 * n);
        break;
    case TRI_CHECK_POINT_ATTRIBUTES:
        memcpy(out, m->point_attributes + m->n_point_attributes * first,
               (size_t)(m->n_point_attributes * n) * sizeof(double));
        break;
    case TRI_CHECK_N_ARRAYS:
        break;
    case TRI_CHECK_POINT_MARKERS:
    case TRI_CHECK_SEGMENT_MARKERS:
        memcpy(out, (array == TRI_CHECK_POINT_MARKERS ? m->point_markers : m->segment_markers) + first,
               (size_t)n * sizeof(int32_t));
        break;
    }
    return TRI_OK;
}

struct tri_check_source tri_check_source_of(const struct tri_check_mesh *m)
{
    unsigned given = 1u << TRI_CHECK_POINTS | 1u << TRI_CHECK_CORNERS;
    given |= (m->neighbors != NULL ? 1u : 0u) << TRI_CHECK_NEIGHBORS_GIVEN;
    given |= (m->attributes != NULL && m->n_attributes > 0 ? 1u : 0u) << TRI_CHECK_ATTRIBUTES;
    given |= (m->point_markers != NULL ? 1u : 0u) << TRI_CHECK_POINT_MARKERS;
    given |= (m->segments != NULL ? 1u : 0u) << TRI_CHECK_SEGMENT_ENDS;
    given |= (m->segments != NULL && m->segment_markers != NULL ? 1u : 0u) << TRI_CHECK_SEGMENT_MARKERS;
    given |= (m->middles != NULL ? 1u : 0u) << TRI_CHECK_MIDDLES;
    given |= (m->point_attributes != NULL && m->n_point_attributes > 0 ? 1u : 0u) << TRI_CHECK_POINT_ATTRIBUTES;
    return (struct tri_check_source){.n_points = m->n_points, .n_triangles = m->n_triangles,
                                     .n_segments = m->n_segments, .n_nodes = m->n_nodes,
                                     .n_point_attributes = m->n_point_attributes, .given = given, .read = read_arrays,
                                     .user = (void *)m};
}

/* --- memory */

/* Returns the bytes per triangle of a part: corners twice (edges.c reuses the array that they are read into), links,
 * vertices, and the other given arrays. */
static double bytes_of_triangle(const struct tri_check_source *source, double vertices)
{
    return 24 + 12 + 12 + 1.1 * vertices * (16 + 8 + 4) +
           (source->given >> TRI_CHECK_NEIGHBORS_GIVEN & 1) * 24 + (source->given >> TRI_CHECK_ATTRIBUTES & 1) * 8;
}

/* Measured bytes: per subsegment of the frame, additionally per boundary edge, per edge of the sweep in winding.c
 * (which runs after the parts are released), and per point and segment of the input. */
static const double SUBSEGMENT_BYTES = 126, BOUNDARY_BYTES = 48, SWEEP_BYTES = 196, INPUT_BYTES = 40;

/* Estimates the number of boundary edges. By Euler's formula, a connected mesh without holes has 2 * vertices -
 * triangles - 2 of them. With holes there are fewer than three times as many. If subsegments are listed, their
 * number is also a limit. */
static double likely_boundary_edges(const struct tri_check_source *source)
{
    const double simple = fmax(0, 2 * (double)source->n_points - (double)source->n_triangles);
    return source->given >> TRI_CHECK_SEGMENT_ENDS & 1 ? fmin(3 * simple, (double)source->n_segments) : simple;
}

static double least_bytes(const struct tri_check_source *source, const struct tri_pslg *input, double boundary)
{
    const double items = input != NULL ? (double)input->n_points + input->n_segments : 0;
    const double amid = source->n_nodes > source->n_points ? (double)(source->n_nodes - source->n_points) : 0;
    const double subsegments = fmax(boundary, (double)source->n_segments);
    const double beside = amid + 1.25 * (double)source->n_points + SUBSEGMENT_BYTES * subsegments +
                          BOUNDARY_BYTES * boundary + INPUT_BYTES * items;
    const double swept = beside + SWEEP_BYTES * (input != NULL ? subsegments : boundary); /* with regions, the sweep
                                                                                             contains all subsegments */
    return fmax(beside, TRI_CHECK_SHARE * swept);
}

double tri_check_least_bytes(const struct tri_check_source *source, const struct tri_pslg *input)
{
    return least_bytes(source, input, likely_boundary_edges(source));
}

double tri_check_bound(const struct tri_check_source *source, double least)
{
    static const double MOST_SHARE = 0.7, WORTH_A_LOOK = 1e7; /* the parts need memory as well */
    const double bound = fmax(least / MOST_SHARE, least + source->beside);
    return least / MOST_SHARE < WORTH_A_LOOK ? 0 : bound;
}

/* Chooses the size of parts: as many triangles as the limit allows in addition to `least` bytes, but at least a few;
 * all triangles if there is no limit. */
static enum tri_status choose_part(struct checker *c, double least)
{
    enum { LEAST = 16 };
    const struct tri_check_source *source = c->source;
    double vertices = 1, most = INT32_MAX / 3 - 1;
    enum tri_status status = source->memory > 0 ? tri_check_sample(c, &vertices) : TRI_OK;
    if (source->memory > 0) {
        double rest = source->memory * TRI_CHECK_SHARE - least;
        most = fmax(LEAST, fmin(most, rest / bytes_of_triangle(source, vertices)));
    }
    bool all = (double)c->n_triangles <= most;
    c->part_triangles = all ? (c->n_triangles > 0 ? c->n_triangles : 1) : (int64_t)most;
    return status;
}

/* Chooses again if there are more boundary edges than estimated. Parts are only read again later, if at all. */
static enum tri_status choose_part_again(struct checker *c)
{
    const struct tri_check_source *source = c->source;
    const double n = (double)c->boundary.n, least = least_bytes(source, c->input, n);
    if (source->memory <= 0 || n <= likely_boundary_edges(source))
        return TRI_OK;
    if (tri_check_bound(source, least) <= source->memory)
        return choose_part(c, least);
    return tri_fail(c->error, TRI_NO_MEMORY, "", 0,
                    "to judge a mesh with %.0f boundary edges takes about %.3g MB of memory; %.3g MB may be used", n,
                    1e-6 * tri_check_bound(source, least), 1e-6 * source->memory);
}

/* --- the check */

/* Checks triangles and pairs of triangles, part by part. *good: corners and coordinates are valid. */
static enum tri_status look_at_parts(struct checker *c, bool *good)
{
    enum tri_status status = TRI_OK;
    for (int64_t t = 0; (t < c->n_triangles || t == 0) && status == TRI_OK; t += c->part_triangles) {
        bool loaded;
        status = tri_check_load(c, t, &loaded);
        *good = *good && loaded;
        if (status != TRI_OK || !*good)
            continue;
        tri_check_orientation(c);
        status = tri_check_pair(c);
        status = status == TRI_OK ? tri_check_keep_open(c) : status;
        if (status != TRI_OK)
            continue;
        tri_check_shapes(c);
        tri_check_pairs(c);
    }
    return status;
}

/* Returns whether edges and orientations are good. If not, resets the checks of pairs, whose results would be
 * meaningless. */
static bool pairs_are_good(struct checker *c)
{
    bool edges = check_good(c, TRI_CHECK_EDGES);
    if (!edges)
        reset_kind(c, TRI_CHECK_NEIGHBORS);
    if (edges && check_good(c, TRI_CHECK_ORIENTATION))
        return true;
    reset_kind(c, TRI_CHECK_LOCAL_DELAUNAY);
    reset_kind(c, TRI_CHECK_ENCROACHMENT);
    reset_kind(c, TRI_CHECK_REGIONS);
    return false;
}

static enum tri_status judge_frame(struct checker *c)
{
    enum tri_status status = tri_check_find_twins(c);
    status = status ? status : tri_check_frame(c);
    status = status ? status : tri_check_subsegments(c);
    status = status ? status : tri_check_input(c);
    status = status ? status : tri_check_quality(c);
    if (status != TRI_OK || !pairs_are_good(c))
        return status;
    tri_check_release_part(c); /* makes room for the sweep */
    status = tri_check_overlap(c);
    if (status != TRI_OK || !check_good(c, TRI_CHECK_OVERLAP))
        return status;
    tri_check_answers(c);
    return c->options->convex ? tri_check_hull(c) : TRI_OK;
}

/* Runs all checks, in the order in which they depend on each other. */
static enum tri_status run(struct checker *c)
{
    bool good = true;
    enum tri_status status = tri_check_survey(c);
    status = status ? status : tri_check_list_segments(c);
    if (status != TRI_OK)
        return status;
    good = check_good(c, TRI_CHECK_ARRAYS);
    status = look_at_parts(c, &good);
    if (status != TRI_OK)
        return status;
    if (!good) {
        struct tri_check_item arrays = c->report->item[TRI_CHECK_ARRAYS];
        memset(c->report, 0, sizeof *c->report);
        c->report->item[TRI_CHECK_ARRAYS] = arrays;
        return TRI_OK;
    }
    status = tri_check_match(c);
    status = status ? status : choose_part_again(c);
    status = status ? status : tri_check_attributes(c);
    status = status ? status : tri_check_nodes(c);
    return status == TRI_OK ? judge_frame(c) : status;
}

static void release(struct checker *c)
{
    void *arrays[] = {c->scaled[0], c->scaled[1], c->scaled[2], c->state, c->boundary.at, c->points,
                      c->vertex, c->sides, c->listed, c->segments, c->segment_markers, c->border, c->fan_first,
                      c->fan, c->found, c->twin, c->unused, c->unused_points, c->is_along, c->missing, c->queries};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        free(arrays[i]);
    tri_check_release_part(c);
    tri_check_store_free(c->store);
    free(c->quality);
}

static enum tri_status check_finite(const char *what, int32_t n, const double *values, int width,
                                    struct tri_error *error)
{
    for (int32_t i = 0; i < n; i++) {
        const double *at = values + (size_t)i * (size_t)width;
        if (!isfinite(at[0]) || !isfinite(at[1]))
            return tri_fail(error, TRI_BAD_INPUT, "", 0, "the input's %s %d (from 0) is not finite", what, (int)i);
    }
    return TRI_OK;
}

/* Coordinates must be finite: NaN differs from itself, so it cannot be looked up. */
static enum tri_status check_input(const struct tri_pslg *input, struct tri_error *error)
{
    enum tri_status status = check_finite("vertex", input->n_points, input->points, 2, error);
    status = status != TRI_OK ? status : check_finite("hole", input->n_holes, input->holes, 2, error);
    return status != TRI_OK ? status : check_finite("region", input->n_regions, input->regions, 4, error);
}

enum tri_status tri_check_from(const struct tri_check_source *source, const struct tri_pslg *input,
                               const struct tri_check_options *options, struct tri_check_report *report,
                               struct tri_error *error)
{
    struct tri_error own = {0};
    assert(source->n_points >= 0 && source->n_triangles >= 0 && source->n_segments >= 0);
    const enum tri_status fault = input != NULL ? check_input(input, error) : TRI_OK;
    if (fault != TRI_OK)
        return fault;
    if (source->n_triangles > INT64_MAX / 8 || source->n_segments > INT32_MAX / 2)
        return tri_fail(error, TRI_TOO_LARGE, "", 0, "the mesh is too large to be checked");
    memset(report, 0, sizeof *report);
    struct checker c = {.source = source, .input = input, .options = options, .report = report, .error = &own,
                        .n_points = source->n_points, .n_triangles = source->n_triangles};
    c.state = tri_check_zeros(c.n_points, 1);
    enum tri_status status = c.state == NULL ? TRI_NO_MEMORY : choose_part(&c, tri_check_least_bytes(source, input));
    status = status ? status : tri_check_store_new(&c);
    status = status ? status : tri_check_begin_quality(&c);
    status = status ? status : run(&c);
    release(&c);
    if (status == TRI_OK)
        return TRI_OK;
    if (own.text[0] != '\0')
        return tri_fail(error, status, own.file, own.line, "%s", own.text);
    return tri_fail(error, status, "", 0, status == TRI_NO_MEMORY ? "out of memory" : "the mesh is too large");
}

enum tri_status tri_check(const struct tri_check_mesh *mesh, const struct tri_pslg *input,
                          const struct tri_check_options *options, struct tri_check_report *report,
                          struct tri_error *error)
{
    struct tri_check_source source = tri_check_source_of(mesh);
    return tri_check_from(&source, input, options, report, error);
}
