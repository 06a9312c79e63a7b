/* The input: its vertices, segments and holes are what they should be in the mesh.
 *
 * Points that coincide are one vertex of the mesh; which of them carries the triangles is the mesher's choice. So each
 * input point has a `twin`: the used vertex at its place. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/check/chain.h"
#include "triangle/check/internal.h"

/* The points that the mesh must do justice to: those of the input, or where it is unknown, all of the mesh. */
struct reference {
    int32_t n;
    const double *points;
    int32_t *table; /* [mask + 1] open addressing by coordinates: point numbers, -1: free */
    uint32_t mask;
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

/* Triangle that holds a point at the place of p, or the free one where it belongs. */
static uint32_t triangle_of(const struct reference *r, struct tri_point p)
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

/* Fills c->twin. Only points that are not used themselves need a search. */
static enum tri_status find_twins(struct checker *c, struct reference *r)
{
    c->twin = tri_check_array(r->n, sizeof *c->twin);
    if (c->twin == NULL)
        return TRI_NO_MEMORY;
    int32_t n_searched = 0;
    for (int32_t v = 0; v < r->n; v++) {
        bool itself =
            v < c->mesh->n_points && check_is_used(c, v) && check_same_place(check_point(c, v), point_of(r, v));
        c->twin[v] = itself ? v : -1;
        n_searched += !itself;
    }
    if (n_searched == 0)
        return TRI_OK;
    enum tri_status status = make_table(r, n_searched);
    if (status != TRI_OK)
        return status;
    for (int32_t v = 0; v < r->n; v++) {
        uint32_t i = c->twin[v] < 0 ? triangle_of(r, point_of(r, v)) : 0;
        if (c->twin[v] < 0 && r->table[i] < 0)
            r->table[i] = v;
    }
    for (int32_t v = 0; v < c->mesh->n_points; v++) {
        int32_t found = check_is_used(c, v) ? r->table[triangle_of(r, check_point(c, v))] : -1;
        if (found >= 0 && c->twin[found] < 0)
            c->twin[found] = v;
    }
    for (int32_t v = 0; v < r->n; v++) {
        if (c->twin[v] < 0)
            c->twin[v] = c->twin[r->table[triangle_of(r, point_of(r, v))]];
    }
    return TRI_OK;
}

static void check_vertices(struct checker *c, const struct reference *r)
{
    if (c->input == NULL || c->options->renumbered)
        return;
    tri_check_begin(c, TRI_CHECK_INPUT_VERTICES);
    if (c->mesh->n_points < r->n) {
        tri_check_fault(c, TRI_CHECK_INPUT_VERTICES, "the mesh has %ld vertices, the input %ld",
                        (long)c->mesh->n_points, (long)r->n);
    }
    for (int32_t v = 0; v < r->n && v < c->mesh->n_points; v++) {
        struct tri_point p = point_of(r, v), q = check_point(c, v);
        if (check_same_place(p, q))
            continue;
        tri_check_fault(c, TRI_CHECK_INPUT_VERTICES, "vertex %ld is at (%.17g, %.17g), in the input at (%.17g, %.17g)",
                        check_number(c, v), check_given(c, q.x), check_given(c, q.y), check_given(c, p.x),
                        check_given(c, p.y));
    }
}

/* Points without twin: lost if they lie inside the mesh, or anywhere if that is to be the hull of all. */
static enum tri_status ask_for_lost(struct checker *c, const struct reference *r)
{
    if (c->mesh->n_triangles == 0 || c->options->ignore_lost)
        return TRI_OK;
    enum tri_status status = TRI_OK;
    for (int32_t v = 0; v < r->n && status == TRI_OK; v++) {
        if (c->twin[v] >= 0)
            continue;
        if (c->options->convex) {
            tri_check_fault(c, TRI_CHECK_HULL, "no triangle uses vertex %ld", check_number(c, v));
        }
        struct tri_point p = point_of(r, v);
        status = tri_check_ask(c, p, TRI_CHECK_LOST_VERTICES, v, 0);
    }
    return status;
}

static enum tri_status ask_for_holes(struct checker *c)
{
    if (c->input == NULL || c->options->ignore_holes)
        return TRI_OK;
    enum tri_status status = TRI_OK;
    for (int32_t i = 0; i < c->input->n_holes && status == TRI_OK; i++) {
        struct tri_point p = {c->input->holes[2 * (size_t)i], c->input->holes[2 * (size_t)i + 1]};
        status = tri_check_ask(c, p, TRI_CHECK_HOLES, i, c->tolerance); /* beside a wall it means either side */
    }
    return status;
}

static void set_tolerance(struct checker *c)
{
    double largest = 0;
    for (size_t i = 0; i < 2 * (size_t)c->mesh->n_points; i++)
        largest = fmax(largest, fabs(c->mesh->points[i]));
    c->tolerance = TRI_CHECK_ULPS * 0x1p-52 * largest;
}

enum tri_status tri_check_input(struct checker *c)
{
    set_tolerance(c);
    struct reference r = {.n = c->mesh->n_points, .points = c->mesh->points};
    if (c->input != NULL) {
        r.n = c->input->n_points;
        r.points = c->input->points;
    }
    enum tri_status status = find_twins(c, &r);
    if (status == TRI_OK) {
        check_vertices(c, &r);
        status = ask_for_lost(c, &r);
    }
    free(r.table);
    if (status == TRI_OK)
        status = ask_for_holes(c);
    if (status == TRI_OK && c->input != NULL && c->mesh->segments != NULL)
        status = tri_check_chains(c);
    if (status == TRI_OK && c->input != NULL)
        status = tri_check_border(c);
    return status == TRI_OK ? tri_check_vertex_markers(c) : status;
}

static void report_inside(struct checker *c, const struct check_query *query)
{
    long id = check_number(c, query->id);
    struct tri_point p = {check_given(c, query->at.x), check_given(c, query->at.y)};
    if (query->kind == TRI_CHECK_LOST_VERTICES) {
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
    if (c->input != NULL && c->mesh->segments != NULL)
        tri_check_begin(c, TRI_CHECK_INPUT_SEGMENTS);
    for (int32_t i = 0; i < c->n_queries; i++) {
        const struct check_query *q = &c->queries[i], *before = i > 0 ? q - 1 : NULL;
        bool told = before != NULL && before->inside && before->kind == q->kind && before->id == q->id;
        if (q->inside && !told && q->kind != TRI_CHECK_REGIONS)
            report_inside(c, q);
    }
}
