/* Checks that the vertices, segments and holes of the input appear correctly in the mesh.
 *
 * Points that coincide are one vertex of the mesh. The mesher may choose which of them is used by triangles. So each
 * input point has a twin: the used vertex at its position. */
#include <stdlib.h>
#include <string.h>

#include "triangle/check/internal.h"

/* The points that the mesh must account for: the points of the input or, if it is unknown, the unused points of the
 * mesh. */
struct reference {
    struct checker *c;
    int32_t n;      /* number of points */
    const double *points; /* [n][2] positions */
    int64_t *found; /* [n] used vertex of the mesh at each point, -1: none */
    int32_t *table; /* [mask + 1] hash table with open addressing by coordinates: point numbers, -1: free */
    uint32_t mask;  /* size of the table - 1 */
};

static struct tri_point point_of(const struct reference *r, int32_t v)
{
    return (struct tri_point){r->points[2 * (size_t)v], r->points[2 * (size_t)v + 1]};
}

static uint32_t hash(struct tri_point p)
{
    double xy[2] = {p.x + 0.0, p.y + 0.0}; /* -0 becomes 0 */
    uint64_t bits[2];
    memcpy(bits, xy, sizeof bits);
    uint64_t h = (bits[0] * 0x9e3779b97f4a7c15u ^ (bits[1] >> 32 | bits[1] << 32)) * 0xbf58476d1ce4e5b9u;
    return (uint32_t)(h >> 32);
}

/* Returns the slot of the point at p, or the free slot in which it belongs. */
static uint32_t slot_of(const struct reference *r, struct tri_point p)
{
    uint32_t i = hash(p) & r->mask;
    while (r->table[i] >= 0 && !check_same_place(point_of(r, r->table[i]), p))
        i = (i + 1) & r->mask;
    return i;
}

static enum tri_status make_table(struct reference *r, int32_t n)
{
    uint64_t size = 16;
    while (size < 2 * (uint64_t)n)
        size *= 2;
    r->mask = (uint32_t)(size - 1);
    r->table = tri_check_array((int64_t)size, sizeof *r->table);
    if (r->table == NULL)
        return TRI_NO_MEMORY;
    memset(r->table, -1, (size_t)size * sizeof *r->table);
    return TRI_OK;
}

/* Calls `look` for the points of the mesh before `end`. */
static enum tri_status each_point(struct reference *r, int64_t end, check_take *look)
{
    return tri_check_each_slice(r->c, TRI_CHECK_POINTS, end, 2 * sizeof(double), look, r);
}

/* Finds input points that are used under their own number. */
static void find_same(void *reference, int64_t first, int64_t n, const void *elements)
{
    struct reference *r = reference;
    const double *points = elements;
    for (int64_t i = 0; i < n; i++) {
        int32_t v = (int32_t)(first + i);
        struct tri_point p = {points[2 * i], points[2 * i + 1]};
        if (check_is_used(r->c, v) && check_same_place(p, point_of(r, v)))
            r->found[v] = v;
    }
}

/* Finds used vertices at the positions of points in the table. The first vertex of each position counts. */
static void find_elsewhere(void *reference, int64_t first, int64_t n, const void *elements)
{
    struct reference *r = reference;
    const double *points = elements;
    for (int64_t i = 0; i < n; i++) {
        if (!check_is_used(r->c, first + i))
            continue;
        int32_t v = r->table[slot_of(r, (struct tri_point){points[2 * i], points[2 * i + 1]})];
        if (v >= 0 && r->found[v] < 0)
            r->found[v] = first + i;
    }
}

/* Searches for the remaining points by their positions. */
static enum tri_status search(struct reference *r)
{
    int32_t n_searched = 0;
    for (int32_t v = 0; v < r->n; v++)
        n_searched += r->found[v] < 0;
    enum tri_status status = n_searched == 0 ? TRI_OK : make_table(r, n_searched);
    if (status != TRI_OK || n_searched == 0)
        return status;
    for (int32_t v = 0; v < r->n; v++) {
        uint32_t i = r->found[v] < 0 ? slot_of(r, point_of(r, v)) : 0;
        if (r->found[v] < 0 && r->table[i] < 0)
            r->table[i] = v;
    }
    status = each_point(r, r->c->n_points, find_elsewhere);
    for (int32_t v = 0; v < r->n; v++) {
        if (r->found[v] < 0)
            r->found[v] = r->found[r->table[slot_of(r, point_of(r, v))]];
    }
    free(r->table);
    return status;
}

/* Lists the unused points, if the input is unknown. */
static void list_unused_slice(void *reference, int64_t first, int64_t n, const void *elements)
{
    struct reference *r = reference;
    const double *points = elements;
    for (int64_t i = 0; i < n; i++) {
        if (check_is_used(r->c, first + i))
            continue;
        r->c->unused[r->n] = first + i;
        memcpy(r->c->unused_points + 2 * (size_t)r->n++, points + 2 * i, 2 * sizeof *points);
    }
}

static enum tri_status list_unused(struct checker *c, struct reference *r)
{
    int64_t n = c->n_points - c->report->n_used_points;
    if (n > INT32_MAX / 2)
        return TRI_TOO_LARGE;
    c->unused = tri_check_array(n, sizeof *c->unused);
    c->unused_points = tri_check_array(n, 2 * sizeof *c->unused_points);
    if (c->unused == NULL || c->unused_points == NULL)
        return TRI_NO_MEMORY;
    enum tri_status status = n > 0 ? each_point(r, c->n_points, list_unused_slice) : TRI_OK;
    c->n_unused = r->n;
    r->points = c->unused_points;
    return status;
}

enum tri_status tri_check_find_twins(struct checker *c)
{
    struct reference r = {.c = c};
    enum tri_status status = TRI_OK;
    if (c->input == NULL)
        status = list_unused(c, &r);
    else
        r = (struct reference){.c = c, .n = c->input->n_points, .points = c->input->points};
    c->found = r.found = tri_check_array(r.n, sizeof *r.found);
    if (r.found == NULL)
        return TRI_NO_MEMORY;
    memset(r.found, -1, (size_t)r.n * sizeof *r.found);
    if (status == TRI_OK && c->input != NULL)
        status = each_point(&r, r.n < c->n_points ? r.n : c->n_points, find_same);
    return status == TRI_OK ? search(&r) : status;
}

static void compare(void *reference, int64_t first, int64_t n, const void *elements)
{
    struct reference *r = reference;
    struct checker *c = r->c;
    const double *points = elements;
    for (int64_t i = 0; i < n; i++) {
        struct tri_point p = point_of(r, (int32_t)(first + i)), q = {points[2 * i], points[2 * i + 1]};
        if (check_same_place(p, q))
            continue;
        tri_check_fault(c, TRI_CHECK_INPUT_VERTICES, "vertex %ld is at (%.17g, %.17g), in the input at (%.17g, %.17g)",
                        check_number(c, first + i), check_given(c, q.x), check_given(c, q.y), check_given(c, p.x),
                        check_given(c, p.y));
    }
}

static enum tri_status check_vertices(struct checker *c)
{
    if (c->input == NULL || c->options->renumbered)
        return TRI_OK;
    struct reference r = {.c = c, .n = c->input->n_points, .points = c->input->points};
    tri_check_begin(c, TRI_CHECK_INPUT_VERTICES);
    if (c->n_points < r.n) {
        tri_check_fault(c, TRI_CHECK_INPUT_VERTICES, "the mesh has %ld vertices, the input %ld", (long)c->n_points,
                        (long)r.n);
    }
    return each_point(&r, r.n < c->n_points ? r.n : c->n_points, compare);
}

static int64_t number_of(const struct checker *c, int32_t i)
{
    return c->input != NULL ? i : c->unused[i];
}

/* Adds queries for points without a twin: they are lost if they lie inside the mesh. If the mesh must fill the hull
 * of all points, they are lost anywhere. */
static enum tri_status query_lost(struct checker *c)
{
    if (c->n_triangles == 0 || c->options->ignore_lost)
        return TRI_OK;
    enum tri_status status = TRI_OK;
    const double *points = c->input != NULL ? c->input->points : c->unused_points;
    int32_t n = c->input != NULL ? c->input->n_points : c->n_unused;
    for (int32_t v = 0; v < n && status == TRI_OK; v++) {
        if (c->found[v] >= 0)
            continue;
        if (c->options->convex) {
            tri_check_fault(c, TRI_CHECK_HULL, "no triangle uses vertex %ld", check_number(c, number_of(c, v)));
        }
        struct tri_point p = {points[2 * (size_t)v], points[2 * (size_t)v + 1]};
        status = tri_check_query(c, p, TRI_CHECK_LOST_VERTICES, v, 0);
    }
    return status;
}

static enum tri_status query_holes(struct checker *c)
{
    if (c->input == NULL || c->options->ignore_holes)
        return TRI_OK;
    enum tri_status status = TRI_OK;
    for (int32_t i = 0; i < c->input->n_holes && status == TRI_OK; i++) {
        struct tri_point p = {c->input->holes[2 * (size_t)i], c->input->holes[2 * (size_t)i + 1]};
        status = tri_check_query(c, p, TRI_CHECK_HOLES, i, c->tolerance); /* within the tolerance of a wall, the point
                                                                           may mean either side */
    }
    return status;
}

static enum tri_status query_regions(struct checker *c)
{
    enum tri_status status = TRI_OK;
    for (int32_t k = 0; check_wants_regions(c) && k < c->input->n_regions && status == TRI_OK; k++) {
        const double *r = c->input->regions + 4 * (size_t)k;
        status = tri_check_query(c, (struct tri_point){r[0], r[1]}, TRI_CHECK_REGIONS, k, c->tolerance);
    }
    return status;
}

enum tri_status tri_check_input(struct checker *c)
{
    enum tri_status status = check_vertices(c);
    status = status ? status : query_lost(c);
    status = status ? status : query_holes(c);
    status = status ? status : query_regions(c);
    if (status == TRI_OK && c->input != NULL && check_is_listed(c))
        status = tri_check_chains(c);
    if (status == TRI_OK && c->input != NULL)
        status = tri_check_border(c);
    return status == TRI_OK ? tri_check_vertex_markers(c) : status;
}

static void report_inside(struct checker *c, const struct check_query *query)
{
    bool lost = query->kind == TRI_CHECK_LOST_VERTICES;
    long id = check_number(c, lost ? number_of(c, query->id) : query->id);
    struct tri_point p = {check_given(c, query->at.x), check_given(c, query->at.y)};
    if (lost) {
        tri_check_fault(c, query->kind, "vertex %ld lies in the mesh's area, but no triangle uses it", id);
    } else if (query->kind == TRI_CHECK_HOLES) {
        tri_check_fault(c, query->kind, "hole %ld at (%.17g, %.17g) lies inside the mesh", id, p.x, p.y);
    } else {
        const int32_t *ends = c->input->segments + 2 * (size_t)query->id;
        tri_check_fault(c, query->kind, "input segment %ld (%ld-%ld) is missing near (%.17g, %.17g), inside the mesh",
                        id, check_number(c, ends[0]), check_number(c, ends[1]), p.x, p.y);
    }
}

void tri_check_answers(struct checker *c)
{
    if (!c->options->ignore_lost)
        tri_check_begin(c, TRI_CHECK_LOST_VERTICES);
    if (c->input != NULL && !c->options->ignore_holes)
        tri_check_begin(c, TRI_CHECK_HOLES);
    if (c->input != NULL && check_is_listed(c))
        tri_check_begin(c, TRI_CHECK_INPUT_SEGMENTS);
    for (int32_t i = 0; i < c->n_queries; i++) {
        const struct check_query *q = &c->queries[i], *before = i > 0 ? q - 1 : NULL;
        bool told = before != NULL && before->inside && before->kind == q->kind && before->id == q->id;
        if (q->inside && !told && q->kind != TRI_CHECK_REGIONS)
            report_inside(c, q);
    }
}
