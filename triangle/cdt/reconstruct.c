/* Makes a mesh from triangles: matches their edges, makes boundary edges and segments subsegments, and groups
 * attributes into regions.
 *
 * Every triangle contributes three half-edges. They are distributed to ranges of vertices by their lower end, and
 * sorted within a range by lower end, then upper end, so the two sides of an edge become neighbours. Both sides of an
 * edge are in the same range, since they have the same lower end. So ranges can be matched in parallel. O(triangles),
 * regardless of vertex degrees.
 *
 * Until the other side of an edge is found, its link is LOOSE, which differs from all codes and subsegments. Of several
 * faults the first is reported: by triangle while triangles are copied; by lower end, then by half-edge, while edges
 * are matched. */
#include "triangle/cdt/reconstruct.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/grow.h"
#include "triangle/base/radix.h"
#include "triangle/cdt/carve.h"
#include "triangle/cdt/flip.h"
#include "triangle/geometry/predicates.h"
#include "triangle/mesh/surface.h"
#include "triangle/mesh/topology.h"

enum { LOOSE = INT32_MAX };

/* A half-edge as an item to sort: its code in the low bits; above it, first the offset of its lower end in the range,
 * later its upper end and a bit that is set if it runs downwards. */
enum { CODE_BITS = 31, HIGH_SHIFT = CODE_BITS + 1, FEW = 24 };

_Static_assert(4 * INT64_C(1) * TRI_MAX_TRIANGLES == INT64_C(1) << CODE_BITS, "codes fill their bits");

/* An invalid triangle. */
struct fault {
    tri_halfedge code;     /* code of the triangle and of the invalid edge */
    const char *what; /* text for the error message; NULL: no fault */
};

struct matcher {
    struct tri_mesh *mesh;
    const struct tri_pslg *pslg;
    const struct tri_elements *elements;
    const struct tri_reconstruct_options *options;
    uint64_t *half;    /* [3 n] half-edges, by range */
    int32_t width;     /* number of vertices in a range */
    int width_bits;    /* width < 2^width_bits */
    int32_t at[TRI_MOST_SHARES][TRI_MOST_SHARES]; /* [share][range] position of the next half-edge */
    int32_t end[TRI_MOST_SHARES];                 /* end of each range in half[] */
    struct fault fault[TRI_MOST_SHARES];          /* first fault in each share of triangles, or in each range */
    bool no_room[TRI_MOST_SHARES];
    int32_t *head;     /* [n_vertices] first segment with this lower end; the others follow by next[n_segments] */
    int32_t *next;
    int32_t *edge_of;  /* [n_segments] code of the edge equal to the segment, or TRI_NONE */
    int32_t n_segments;
    int32_t *loose;    /* [n_loose] codes of edges with one side only, in order */
    int32_t n_loose;
    int32_t loose_at[TRI_MOST_SHARES + 1]; /* start of each share in loose[] */
    struct tri_error *error;
};

static enum tri_status no_memory(struct tri_error *error, int32_t n)
{
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for a mesh of %d triangles", (int)n);
}

static size_t n_shares(const struct matcher *m) { return tri_shares(m->elements->n); }

/* Returns the fault of the lowest share as an error. */
static enum tri_status first_fault(const struct matcher *m)
{
    for (size_t i = 0; i < n_shares(m); i++) {
        if (m->no_room[i])
            return no_memory(m->error, m->elements->n);
        if (m->fault[i].what)
            return tri_fail(m->error, TRI_BAD_INPUT, NULL, 0, "triangle %lld %s",
                            (long long)tri_of(m->fault[i].code) + m->options->base, m->fault[i].what);
    }
    return TRI_OK;
}

/* --- triangles */

/* Makes the triangle counter-clockwise. Returns NULL, or the text of the fault. */
static const char *orient(const struct tri_mesh *mesh, tri_vertex_id v[3])
{
    for (int k = 0; k < 3; k++)
        if (v[k] < 0 || v[k] >= mesh->n_vertices)
            return "has a corner that is no vertex";
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0])
        return "has two equal corners";
    double area = tri_orient2d(mesh->xy[v[0]], mesh->xy[v[1]], mesh->xy[v[2]]);
    if (area == 0)
        return "has no area";
    if (area < 0) {
        int32_t second = v[1];
        v[1] = v[2];
        v[2] = second;
    }
    return NULL;
}

static tri_vertex_id low_of(const struct tri_triangle *t, int e)
{
    tri_vertex_id from = t->v[tri_next[e]], to = t->v[tri_prev[e]];
    return from < to ? from : to;
}

static void copy_share(void *context, size_t share)
{
    struct matcher *m = context;
    struct tri_range range = tri_share(share, m->elements->n);
    for (tri_triangle_id t = range.first; t < range.last; t++) {
        struct tri_triangle *at = &m->mesh->tri[t];
        *at = (struct tri_triangle){.n = {LOOSE, LOOSE, LOOSE}};
        memcpy(at->v, &m->elements->corners[3 * (size_t)t], sizeof at->v);
        m->fault[share] = (struct fault){tri_code(t, 0), orient(m->mesh, at->v)};
        if (m->fault[share].what)
            return;
        for (int e = 0; e < 3; e++)
            m->at[share][low_of(at, e) / m->width]++;
    }
}

static enum tri_status copy_triangles(struct matcher *m)
{
    int32_t n = m->elements->n;
    enum tri_status status = tri_mesh_reserve_triangles(m->mesh, n, m->error);
    if (status)
        return status;
    m->width = m->mesh->n_vertices / (int32_t)n_shares(m) + 1;
    m->width_bits = tri_bits_of(m->width);
    tri_execute(m->options->executor, n_shares(m), copy_share, m);
    status = first_fault(m);
    m->mesh->n_triangles = status ? 0 : n;
    return status;
}

/* --- matching */

/* Converts counts to positions: range by range, and within a range by share. */
static void divide_ranges(struct matcher *m)
{
    int32_t sum = 0;
    for (size_t range = 0; range < n_shares(m); range++) {
        for (size_t share = 0; share < n_shares(m); share++) {
            int32_t count = m->at[share][range];
            m->at[share][range] = sum;
            sum += count;
        }
        m->end[range] = sum;
    }
    assert(sum == 3 * m->mesh->n_triangles);
}

static void distribute_share(void *context, size_t share)
{
    struct matcher *m = context;
    struct tri_range range = tri_share(share, m->mesh->n_triangles);
    for (tri_triangle_id t = range.first; t < range.last; t++)
        for (int e = 0; e < 3; e++) {
            int32_t low = low_of(&m->mesh->tri[t], e), to = low / m->width;
            assert(to < (int32_t)n_shares(m) && m->at[share][to] < m->end[to]);
            m->half[m->at[share][to]++] = (uint64_t)(low - to * m->width) << CODE_BITS | (uint64_t)tri_code(t, e);
        }
}

static tri_halfedge code_of(uint64_t half) { return (int32_t)(half & ((UINT64_C(1) << CODE_BITS) - 1)); }
static tri_vertex_id high_of(uint64_t half) { return (int32_t)(half >> HIGH_SHIFT); }
static bool runs_down(uint64_t half) { return half >> CODE_BITS & 1; }

/* Sorts the half-edges at one lower end by their upper ends; equal ones stay in the order of their triangles. */
static void sort_bucket(const struct tri_mesh *mesh, uint64_t *half, int32_t n, uint64_t *scratch)
{
    for (int32_t i = 0; i < n; i++) {
        tri_halfedge code = code_of(half[i]);
        const struct tri_triangle *t = &mesh->tri[tri_of(code)];
        tri_vertex_id from = t->v[tri_next[tri_edge(code)]], to = t->v[tri_prev[tri_edge(code)]];
        uint64_t next = (uint64_t)(from < to ? to : from) << HIGH_SHIFT | (uint64_t)(from > to) << CODE_BITS |
                        (uint64_t)code;
        int32_t at = i;
        for (; n <= FEW && at > 0 && high_of(half[at - 1]) > high_of(next); at--)
            half[at] = half[at - 1];
        half[at] = next;
    }
    if (n > FEW)
        tri_radix_sort(half, scratch, n, HIGH_SHIFT, 64, NULL);
}

/* Links the two sides of an edge. Returns a fault if there is a third side, or if both are on the same side. */
static struct fault join(const struct tri_mesh *mesh, const uint64_t *half, int32_t n)
{
    assert(n > 0 && *tri_link_at(mesh, code_of(half[0])) == LOOSE);
    if (n > 1 && runs_down(half[0]) == runs_down(half[1]))
        return (struct fault){code_of(half[1]), "lies on the same side of an edge as another triangle"};
    if (n > 2)
        return (struct fault){code_of(half[2]), "has an edge that two other triangles have, too"};
    if (n == 2) {
        *tri_link_at(mesh, code_of(half[0])) = code_of(half[1]);
        *tri_link_at(mesh, code_of(half[1])) = code_of(half[0]);
    }
    return (struct fault){0, NULL};
}

static struct fault match_bucket(const struct tri_mesh *mesh, const uint64_t *half, int32_t n)
{
    struct fault first = {0, NULL};
    for (int32_t i = 0, end; i < n; i = end) {
        for (end = i + 1; end < n && high_of(half[end]) == high_of(half[i]);)
            end++;
        struct fault fault = join(mesh, half + i, end - i);
        if (fault.what && (!first.what || fault.code < first.code))
            first = fault;
    }
    return first;
}

static bool names_edge(const struct matcher *m, int32_t k)
{
    const tri_vertex_id *v = &m->pslg->segments[2 * (size_t)k];
    return v[0] >= 0 && v[0] < m->mesh->n_vertices && v[1] >= 0 && v[1] < m->mesh->n_vertices && v[0] != v[1];
}

static void list_segments(struct matcher *m)
{
    for (tri_vertex_id v = 0; v < m->mesh->n_vertices; v++)
        m->head[v] = TRI_NONE;
    for (int32_t k = 0; k < m->n_segments; k++) {
        const tri_vertex_id *v = &m->pslg->segments[2 * (size_t)k];
        m->edge_of[k] = TRI_NONE;
        if (!names_edge(m, k))
            continue;
        tri_vertex_id low = v[0] < v[1] ? v[0] : v[1];
        m->next[k] = m->head[low];
        m->head[low] = k;
    }
}

/* Finds the segments with this lower end among its edges. */
static void find_segments(const struct matcher *m, tri_vertex_id low, const uint64_t *half, int32_t n)
{
    for (int32_t k = m->head[low]; k != TRI_NONE; k = m->next[k]) {
        const tri_vertex_id *v = &m->pslg->segments[2 * (size_t)k];
        int32_t high = v[0] == low ? v[1] : v[0], first = 0, last = n;
        while (first < last) {
            int32_t middle = first + (last - first) / 2;
            if (high_of(half[middle]) < high)
                first = middle + 1;
            else
                last = middle;
        }
        assert(first == n || high_of(half[first]) >= high);
        if (first < n && high_of(half[first]) == high)
            m->edge_of[k] = code_of(half[first]);
    }
}

static void match_range(void *context, size_t range)
{
    struct matcher *m = context;
    int32_t first = range > 0 ? m->end[range - 1] : 0, n = m->end[range] - first;
    uint64_t *half = m->half + first, *scratch = malloc(((size_t)n + 1) * sizeof *scratch);
    assert(n >= 0 && m->at[n_shares(m) - 1][range] == m->end[range]); /* all have been distributed */
    m->no_room[range] = !scratch;
    m->fault[range].what = NULL;
    if (scratch)
        tri_radix_sort(half, scratch, n, CODE_BITS, CODE_BITS + m->width_bits, NULL);
    for (int32_t i = 0, end; scratch && !m->fault[range].what && i < n; i = end) {
        uint64_t low = half[i] >> CODE_BITS;
        for (end = i + 1; end < n && half[end] >> CODE_BITS == low;)
            end++;
        sort_bucket(m->mesh, half + i, end - i, scratch);
        m->fault[range] = match_bucket(m->mesh, half + i, end - i);
        if (m->n_segments > 0)
            find_segments(m, (int32_t)range * m->width + (int32_t)low, half + i, end - i);
    }
    free(scratch);
}

static enum tri_status match(struct matcher *m)
{
    if (m->n_segments > 0)
        list_segments(m);
    divide_ranges(m);
    tri_execute(m->options->executor, n_shares(m), distribute_share, m);
    tri_execute(m->options->executor, n_shares(m), match_range, m);
    return first_fault(m);
}

static enum tri_status allocate_and_match(struct matcher *m)
{
    size_t n = (size_t)m->mesh->n_vertices, n_segments = (size_t)m->n_segments;
    size_t n_half = 3 * (size_t)m->mesh->n_triangles;
    m->half = malloc((n_half + 1) * sizeof *m->half);
    m->edge_of = malloc((n_segments + 1) * sizeof *m->edge_of);
    m->next = malloc((n_segments + 1) * sizeof *m->next);
    m->head = malloc((n_segments > 0 ? n + 1 : 1) * sizeof *m->head);
    bool room = m->half && m->edge_of && m->next && m->head;
    enum tri_status status = room ? match(m) : no_memory(m->error, m->elements->n);
    free(m->half);
    free(m->next);
    free(m->head);
    return status;
}

/* --- subsegments */

/* Makes the edge with this code a subsegment with the given ends. */
static void add_sub(struct tri_mesh *mesh, tri_halfedge code, tri_vertex_id from, tri_vertex_id to, int32_t marker,
                    int32_t segment)
{
    int32_t s = tri_mesh_add_sub(mesh, from, to, marker, segment), other = *tri_link_at(mesh, code);
    int side = tri_side(&mesh->sub[s], mesh->tri[tri_of(code)].v[tri_next[tri_edge(code)]]);
    assert(other >= 0 && mesh->sub[s].v[side] == mesh->tri[tri_of(code)].v[tri_next[tri_edge(code)]]);
    mesh->parents[mesh->sub[s].parent].guard = mesh->xy[from]; /* outside unknown: no part of it is reserved */
    mesh->sub[s].side[side] = code;
    *tri_link_at(mesh, code) = ~s;
    if (other == LOOSE)
        return;
    mesh->sub[s].side[1 - side] = other;
    *tri_link_at(mesh, other) = ~s;
}

static void add_segments(const struct matcher *m)
{
    struct tri_mesh *mesh = m->mesh;
    for (int32_t k = 0; k < m->n_segments; k++) {
        const tri_vertex_id *v = &m->pslg->segments[2 * (size_t)k];
        int32_t code = m->edge_of[k], marker = m->pslg->segment_markers ? m->pslg->segment_markers[k] : 0;
        if (code == TRI_NONE)
            continue;
        tri_link link = *tri_link_at(mesh, code);
        if (link >= 0)
            add_sub(mesh, code, v[0], v[1], marker, k);
        else if (mesh->sub[~link].marker == 0)
            mesh->sub[~link].marker = marker;
        tri_mark_ends(mesh, v, marker);
    }
}

static void add_boundary(const struct matcher *m)
{
    struct tri_mesh *mesh = m->mesh;
    for (int32_t i = 0; i < m->n_loose; i++) {
        tri_halfedge code = m->loose[i];
        const tri_vertex_id *v = mesh->tri[tri_of(code)].v;
        if (*tri_link_at(mesh, code) == LOOSE)
            add_sub(mesh, code, v[tri_next[tri_edge(code)]], v[tri_prev[tri_edge(code)]], 0, TRI_NONE);
    }
}

static void count_loose(void *context, size_t share)
{
    struct matcher *m = context;
    struct tri_range range = tri_share(share, m->mesh->n_triangles);
    int32_t n = 0;
    for (tri_triangle_id t = range.first; t < range.last; t++)
        for (int e = 0; e < 3; e++)
            n += m->mesh->tri[t].n[e] == LOOSE;
    m->loose_at[share + 1] = n;
}

static void list_loose(void *context, size_t share)
{
    struct matcher *m = context;
    struct tri_range range = tri_share(share, m->mesh->n_triangles);
    int32_t *next = m->loose + m->loose_at[share], *end = m->loose + m->loose_at[share + 1];
    for (tri_triangle_id t = range.first; next < end && t < range.last; t++)
        for (int e = 0; e < 3; e++)
            if (m->mesh->tri[t].n[e] == LOOSE)
                *next++ = tri_code(t, e);
    assert(next == end);
}

static enum tri_status find_loose(struct matcher *m)
{
    tri_execute(m->options->executor, n_shares(m), count_loose, m);
    for (size_t share = 0; share < n_shares(m); share++)
        m->loose_at[share + 1] += m->loose_at[share];
    m->n_loose = m->loose_at[n_shares(m)];
    m->loose = malloc(((size_t)m->n_loose + 1) * sizeof *m->loose);
    if (!m->loose)
        return no_memory(m->error, m->elements->n);
    tri_execute(m->options->executor, n_shares(m), list_loose, m);
    return TRI_OK;
}

static enum tri_status add_subsegments(struct matcher *m)
{
    enum tri_status status = find_loose(m);
    int64_t n = m->n_loose;
    for (int32_t k = 0; k < m->n_segments; k++)
        n += m->edge_of[k] != TRI_NONE;
    if (!status && n > TRI_MAX_TRIANGLES)
        status = tri_fail(m->error, TRI_TOO_LARGE, NULL, 0, "too many subsegments for one mesh");
    status = status ? status : tri_mesh_reserve_subs(m->mesh, (int32_t)n, m->error);
    if (!status) {
        add_segments(m);
        add_boundary(m);
    }
    free(m->loose);
    return status;
}

/* --- attributes and area bounds as regions */

/* Maps pairs of attributes and area bound to regions other than 0, by an open hash table with at least twice as many
 * slots as triangles. */
struct values {
    struct tri_mesh *mesh;
    const struct tri_elements *elements;
    int32_t *place; /* region, or TRI_NONE */
    size_t mask;
};

static uint64_t mix(uint64_t hash, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    hash = (hash ^ bits) * UINT64_C(0x9E3779B97F4A7C15);
    return hash ^ hash >> 29;
}

static bool is_region(const struct tri_mesh *mesh, tri_region_id region, const double *attributes, double bound)
{
    size_t n = (size_t)mesh->n_columns;
    return mesh->regions[region].max_area == bound &&
           (n == 0 || memcmp(mesh->columns + (size_t)region * n, attributes, n * sizeof *attributes) == 0);
}

static void add_region(struct tri_mesh *mesh, const double *attributes, double bound)
{
    size_t n = (size_t)mesh->n_columns;
    tri_region_id region = mesh->n_regions++;
    assert(region <= mesh->n_triangles); /* at most one region per triangle, and "no region" */
    mesh->regions[region] = (struct tri_region){n > 0 ? attributes[0] : 0, bound};
    if (n > 0)
        memcpy(mesh->columns + (size_t)region * n, attributes, n * sizeof *attributes);
}

static int32_t find_region(struct values *values, const double *attributes, double bound)
{
    struct tri_mesh *mesh = values->mesh;
    if (is_region(mesh, 0, attributes, bound))
        return 0;
    uint64_t hash = mix(0, bound);
    for (int32_t i = 0; i < mesh->n_columns; i++)
        hash = mix(hash, attributes[i]);
    assert(((values->mask + 1) & values->mask) == 0 && values->mask + 1 > 2 * (size_t)mesh->n_triangles);
    size_t at = (size_t)(hash >> 32) & values->mask;
    while (values->place[at] != TRI_NONE && !is_region(mesh, values->place[at], attributes, bound))
        at = (at + 1) & values->mask;
    if (values->place[at] == TRI_NONE) {
        values->place[at] = mesh->n_regions;
        add_region(mesh, attributes, bound);
    }
    return values->place[at];
}

static void assign_regions(struct values *values)
{
    const struct tri_elements *elements = values->elements;
    struct tri_mesh *mesh = values->mesh;
    int32_t last = 0; /* most triangles have the values of the previous one */
    for (tri_triangle_id t = 0; t < mesh->n_triangles; t++) {
        const double *attributes =
            elements->attributes ? elements->attributes + (size_t)t * (size_t)elements->n_attributes : NULL;
        double bound = elements->areas && elements->areas[t] > 0 ? elements->areas[t] : 0;
        if (!is_region(mesh, last, attributes, bound))
            last = find_region(values, attributes, bound);
        mesh->tri[t].region = last;
    }
}

/* Groups the triangles into regions. The arrays have room for one region per triangle; unused memory is never
 * touched. */
static enum tri_status make_regions(struct tri_mesh *mesh, const struct tri_elements *elements, struct tri_error *error)
{
    size_t n = (size_t)mesh->n_triangles + 1, size = 2;
    while (size < 2 * n)
        size *= 2;
    mesh->n_columns = elements->attributes ? elements->n_attributes : 0;
    bool memory = tri_resize(&mesh->regions, n, sizeof *mesh->regions);
    if (mesh->n_columns > 0)
        mesh->columns = calloc(n, (size_t)mesh->n_columns * sizeof *mesh->columns);
    struct values values = {mesh, elements, malloc(size * sizeof *values.place), size - 1};
    enum tri_status status = TRI_OK;
    if (!memory || (mesh->n_columns > 0 && !mesh->columns) || !values.place) {
        status = no_memory(error, mesh->n_triangles);
    } else {
        memset(values.place, 0xff, size * sizeof *values.place); /* TRI_NONE */
        assign_regions(&values);
    }
    free(values.place);
    return status;
}

/* --- the whole reconstruction */

static enum tri_status check_elements(const struct tri_elements *elements, struct tri_error *error)
{
    if (elements->n < 0 || elements->n_attributes < 0)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "the number of triangles or of their attributes is negative");
    if (elements->n > 0 && !elements->corners)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "there are %d triangles, but no corners", (int)elements->n);
    if (elements->n > TRI_MAX_TRIANGLES)
        return tri_fail(error, TRI_TOO_LARGE, NULL, 0, "%d triangles are too many for one mesh", (int)elements->n);
    return TRI_OK;
}

static enum tri_status build(struct matcher *m)
{
    struct tri_mesh *mesh = m->mesh;
    enum tri_status status = tri_mesh_take_points(mesh, m->pslg, m->options->executor, m->error);
    status = status ? status : tri_stop_is_asked(mesh->stop) ? tri_fail_stopped(m->error) : copy_triangles(m);
    status = status ? status : allocate_and_match(m);
    status = status ? status : add_subsegments(m);
    if (!status && (m->elements->areas || m->elements->attributes))
        status = make_regions(mesh, m->elements, m->error);
    if (status)
        return status;
    tri_mark_boundary(mesh);
    if (!m->options->refine)
        return TRI_OK;
    status = tri_unite_chains(mesh, m->error);
    status = status ? status : tri_surface_keep(mesh, m->options->executor, m->error); /* before edges are flipped */
    return status ? status : tri_flip_to_delaunay(mesh, m->options->executor, m->error);
}

static void report_edges(const struct matcher *m)
{
    int32_t loose = 0;
    for (int32_t k = 0; k < m->pslg->n_segments; k++) {
        const bool is_edge = k < m->n_segments && (m->edge_of[k] != TRI_NONE || !names_edge(m, k));
        loose += k < m->n_segments && !is_edge;
        if (m->options->is_edge)
            m->options->is_edge[k] = is_edge;
    }
    if (m->options->loose)
        *m->options->loose = loose;
}

enum tri_status tri_reconstruct(struct tri_mesh *mesh, const struct tri_pslg *pslg, const struct tri_elements *elements,
                                const struct tri_reconstruct_options *options, struct tri_error *error)
{
    struct matcher m = {.mesh = mesh, .pslg = pslg, .elements = elements, .options = options, .error = error};
    *mesh = (struct tri_mesh){0};
    m.n_segments = options->use_segments ? pslg->n_segments : 0;
    enum tri_status status = elements->n > 0 ? tri_pslg_check(pslg, error) : tri_pslg_check_values(pslg, error);
    status = status ? status : check_elements(elements, error);
    status = status ? status : tri_mesh_init(mesh, error);
    mesh->stop = options->stop;
    status = status ? status : build(&m);
    if (!status)
        report_edges(&m);
    free(m.edge_of);
    if (status)
        tri_mesh_free(mesh);
    return status;
}
