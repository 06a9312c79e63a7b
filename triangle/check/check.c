/* The judge: runs the checks in the order in which they lean on each other, and keeps the report.
 *
 * Each check lives in a file of its own. A check that needs the outcome of another is skipped when that one
 * failed: what it would say has no meaning then. */
#include "triangle/check/check.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/check/internal.h"

static const char *const names[TRI_N_CHECKS] = {
    [TRI_CHECK_ARRAYS] = "indices and coordinates",
    [TRI_CHECK_ORIENTATION] = "orientation",
    [TRI_CHECK_EDGES] = "edges in pairs",
    [TRI_CHECK_NEIGHBORS] = "neighbors",
    [TRI_CHECK_STARS] = "vertex stars",
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
    [TRI_CHECK_FACES] = "no face carved in vain",
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

void tri_check_fault(struct checker *c, enum tri_check_kind kind, const char *format, ...)
{
    struct tri_check_item *item = &c->report->item[kind];
    item->state = TRI_CHECK_FAILED;
    if (item->count++ > 0)
        return;
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(item->text, sizeof item->text, format, arguments);
    va_end(arguments);
}

void tri_check_each(struct checker *c, enum tri_check_kind kind, int32_t n,
                    bool (*is_bad)(const struct checker *c, int32_t i), void (*tell)(struct checker *c, int32_t i))
{
    int64_t n_bad = 0, before = c->report->item[kind].count;
    int32_t first = n;
    tri_check_begin(c, kind);
#pragma omp parallel for schedule(static) reduction(+ : n_bad) reduction(min : first)
    for (int32_t i = 0; i < n; i++) {
        if (is_bad(c, i)) {
            n_bad++;
            first = i < first ? i : first;
        }
    }
    if (n_bad == 0)
        return;
    tell(c, first);
    c->report->item[kind].count = before + n_bad;
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

enum tri_status tri_check_ask(struct checker *c, struct tri_point at, enum tri_check_kind kind, int32_t id,
                              double tolerance)
{
    at = (struct tri_point){tri_round_coordinate(at.x), tri_round_coordinate(at.y)};
    if (!tri_is_in_range(at))
        return TRI_OK; /* outside the mesh, all of which is in range */
    if (c->n_queries == c->query_capacity) {
        if (c->query_capacity > INT32_MAX / 2 - 16)
            return TRI_TOO_LARGE;
        int32_t capacity = 2 * c->query_capacity + 16;
        struct check_query *queries = realloc(c->queries, (size_t)capacity * sizeof *queries);
        if (queries == NULL)
            return TRI_NO_MEMORY;
        c->queries = queries;
        c->query_capacity = capacity;
    }
    c->queries[c->n_queries++] = (struct check_query){at, kind, id, tolerance, false};
    return TRI_OK;
}

/* The checks proper, each on what the earlier ones allow. */
static enum tri_status run(struct checker *c)
{
    tri_check_arrays(c);
    if (!check_good(c, TRI_CHECK_ARRAYS))
        return TRI_OK;
    tri_check_orientation(c);
    enum tri_status status = tri_check_edges(c);
    if (status == TRI_OK)
        status = tri_check_subsegments(c);
    if (status == TRI_OK)
        status = tri_check_input(c);
    if (status == TRI_OK)
        status = tri_check_quality(c);
    if (status != TRI_OK || !check_good(c, TRI_CHECK_ORIENTATION) || !check_good(c, TRI_CHECK_EDGES))
        return status;
    tri_check_delaunay(c);
    status = tri_check_regions(c);
    if (status == TRI_OK)
        status = tri_check_stars(c);
    if (status == TRI_OK)
        status = tri_check_overlap(c);
    if (status != TRI_OK || !check_good(c, TRI_CHECK_OVERLAP))
        return status;
    tri_check_answers(c);
    return c->options->convex ? tri_check_hull(c) : TRI_OK;
}

static void release(struct checker *c)
{
    for (int i = 0; i < 4; i++)
        free(c->scaled[i]);
    free(c->first);
    free(c->entry);
    free(c->link);
    free(c->used);
    free(c->turns);
    free(c->on_boundary);
    free(c->own_segments);
    free(c->constrained);
    free(c->fan_first);
    free(c->fan);
    free(c->twin);
    free(c->is_along);
    free(c->missing);
    free(c->queries);
}

enum tri_status tri_check(const struct tri_check_mesh *mesh, const struct tri_pslg *input,
                          const struct tri_check_options *options, struct tri_check_report *report,
                          struct tri_error *error)
{
    assert(mesh->n_points >= 0 && mesh->n_triangles >= 0 && mesh->n_segments >= 0);
    if (mesh->n_triangles > INT32_MAX / 3 || mesh->n_segments > INT32_MAX / 2) {
        return tri_fail(error, TRI_TOO_LARGE, "", 0, "the mesh is too large to be checked");
    }
    memset(report, 0, sizeof *report);
    struct checker c = {.mesh = mesh, .input = input, .options = options, .report = report};
    c.n_half_edges = 3 * mesh->n_triangles;
    enum tri_status status = tri_check_scale(&c);
    if (status == TRI_OK)
        status = run(&c);
    release(&c);
    if (status == TRI_OK)
        return TRI_OK;
    return tri_fail(error, status, "", 0, status == TRI_NO_MEMORY ? "out of memory" : "the mesh is too large");
}
