/* Triangles to a mesh: their edges are matched, boundary and segments become subsegments, attributes regions.
 *
 * Every triangle contributes three half-edges. They are sorted into buckets by their lower end (counting sort); within
 * a bucket an array over all vertices, `seen`, tells which half-edge was the first to reach the upper end. So each is
 * matched in O(1), whatever the degrees.
 *
 * INVARIANT: behind a bucket with first half-edge `first`, seen[v] >= first says that the edge from its vertex to v
 * exists; entries of earlier buckets are smaller and never have to be cleared. Until an edge has found its other side
 * its link is LOOSE, which no code and no subsegment equals. */
#include "triangle/reconstruct.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/carve.h"
#include "triangle/chain.h"
#include "triangle/flip.h"
#include "triangle/predicates.h"
#include "triangle/refine.h"
#include "triangle/topology.h"

enum { LOOSE = INT32_MAX };

struct half {
    int32_t high; /* the upper end, ~ of it where the half-edge runs from there down */
    int32_t code;
};

struct matcher {
    struct tri_mesh *mesh;
    const struct tri_pslg *pslg;
    const struct tri_elements *elements;
    const struct tri_reconstruct_options *options;
    struct half *half; /* [3 n] by lower end */
    int32_t *start;    /* [n_vertices + 1] buckets in it */
    int32_t *seen;     /* [n_vertices] */
    int32_t *head;     /* [n_vertices] first segment with this lower end; then on by next[n_segments] */
    int32_t *next;
    int32_t *edge_of;  /* [n_segments] code of the edge that is the segment, or TRI_NONE */
    int32_t n_segments;
    struct tri_error *error;
};

static enum tri_status no_memory(struct tri_error *error, int32_t n)
{
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for a mesh of %d triangles", (int)n);
}

static enum tri_status bad_triangle(const struct matcher *m, int32_t t, const char *fault)
{
    return tri_fail(m->error, TRI_BAD_INPUT, NULL, 0, "triangle %lld %s", (long long)t + m->options->base, fault);
}

/* --- triangles */

/* Turns the triangle counter-clockwise. */
static enum tri_status orient(const struct matcher *m, int32_t t, int32_t v[3])
{
    const struct tri_mesh *mesh = m->mesh;
    for (int k = 0; k < 3; k++)
        if (v[k] < 0 || v[k] >= mesh->n_vertices)
            return bad_triangle(m, t, "has a corner that is no vertex");
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0])
        return bad_triangle(m, t, "has two equal corners");
    double area = tri_orient2d(mesh->xy[v[0]], mesh->xy[v[1]], mesh->xy[v[2]]);
    if (area == 0)
        return bad_triangle(m, t, "has no area");
    if (area < 0) {
        int32_t second = v[1];
        v[1] = v[2];
        v[2] = second;
    }
    return TRI_OK;
}

static enum tri_status take_triangles(struct matcher *m)
{
    struct tri_mesh *mesh = m->mesh;
    int32_t n = m->elements->n;
    enum tri_status status = tri_mesh_reserve_triangles(mesh, n, m->error);
    for (int32_t t = 0; !status && t < n; t++) {
        struct tri_triangle *at = &mesh->tri[t];
        *at = (struct tri_triangle){.n = {LOOSE, LOOSE, LOOSE}};
        memcpy(at->v, &m->elements->corners[3 * (size_t)t], sizeof at->v);
        status = orient(m, t, at->v);
    }
    mesh->n_slots = status ? 0 : n;
    return status;
}

/* --- matching */

static struct half half_of(const struct tri_triangle *t, int32_t code, int32_t *low)
{
    int32_t from = t->v[tri_next[tri_edge(code)]], to = t->v[tri_prev[tri_edge(code)]];
    *low = from < to ? from : to;
    return (struct half){from < to ? to : ~from, code};
}

static void fill_buckets(struct matcher *m)
{
    const struct tri_mesh *mesh = m->mesh;
    int32_t *fill = m->start + 1, low; /* shifted by one, so that filling leaves the starts in place */
    for (int32_t t = 0; t < mesh->n_slots; t++)
        for (int e = 0; e < 3; e++) {
            half_of(&mesh->tri[t], tri_code(t, e), &low);
            fill[low + 1]++;
        }
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        fill[v + 1] += fill[v];
    for (int32_t t = 0; t < mesh->n_slots; t++)
        for (int e = 0; e < 3; e++) {
            struct half half = half_of(&mesh->tri[t], tri_code(t, e), &low);
            m->half[fill[low]++] = half;
        }
    assert(m->start[0] == 0 && m->start[mesh->n_vertices] == 3 * mesh->n_slots);
}

static int32_t *link_of(const struct tri_mesh *mesh, int32_t code)
{
    return &mesh->tri[tri_of(code)].n[tri_edge(code)];
}

static enum tri_status join(const struct matcher *m, struct half a, struct half b)
{
    int32_t *link_a = link_of(m->mesh, a.code), *link_b = link_of(m->mesh, b.code);
    if (*link_a != LOOSE)
        return bad_triangle(m, tri_of(b.code), "has an edge that two other triangles have, too");
    if ((a.high < 0) == (b.high < 0))
        return bad_triangle(m, tri_of(b.code), "lies on the same side of an edge as another triangle");
    *link_a = b.code;
    *link_b = a.code;
    return TRI_OK;
}

static bool names_edge(const struct matcher *m, int32_t k)
{
    const int32_t *v = &m->pslg->segments[2 * (size_t)k];
    return v[0] >= 0 && v[0] < m->mesh->n_vertices && v[1] >= 0 && v[1] < m->mesh->n_vertices && v[0] != v[1];
}

static void list_segments(struct matcher *m)
{
    for (int32_t v = 0; v < m->mesh->n_vertices; v++)
        m->head[v] = TRI_NONE;
    for (int32_t k = 0; k < m->n_segments; k++) {
        const int32_t *v = &m->pslg->segments[2 * (size_t)k];
        m->edge_of[k] = TRI_NONE;
        if (!names_edge(m, k))
            continue;
        int32_t low = v[0] < v[1] ? v[0] : v[1];
        m->next[k] = m->head[low];
        m->head[low] = k;
    }
}

/* Looks the segments of a bucket's vertex up among its edges. */
static void find_segments(struct matcher *m, int32_t low, int32_t first)
{
    for (int32_t k = m->head[low]; k != TRI_NONE; k = m->next[k]) {
        const int32_t *v = &m->pslg->segments[2 * (size_t)k];
        int32_t at = m->seen[v[0] == low ? v[1] : v[0]];
        if (at >= first)
            m->edge_of[k] = m->half[at].code;
    }
}

static enum tri_status match_bucket(struct matcher *m, int32_t low)
{
    int32_t first = m->start[low], end = m->start[low + 1];
    for (int32_t i = first; i < end; i++) {
        struct half half = m->half[i];
        int32_t *seen = &m->seen[half.high < 0 ? ~half.high : half.high];
        assert(half.high < 0 ? ~half.high > low : half.high > low);
        if (*seen < first) {
            *seen = i;
            continue;
        }
        enum tri_status status = join(m, m->half[*seen], half);
        if (status)
            return status;
    }
    if (m->n_segments > 0)
        find_segments(m, low, first);
    return TRI_OK;
}

static enum tri_status match(struct matcher *m)
{
    enum tri_status status = TRI_OK;
    for (int32_t v = 0; v < m->mesh->n_vertices; v++)
        m->seen[v] = TRI_NONE;
    if (m->n_segments > 0)
        list_segments(m);
    fill_buckets(m);
    for (int32_t v = 0; !status && v < m->mesh->n_vertices; v++)
        status = match_bucket(m, v);
    return status;
}

static enum tri_status allocate_and_match(struct matcher *m)
{
    size_t n = (size_t)m->mesh->n_vertices, n_segments = (size_t)m->n_segments, n_half = 3 * (size_t)m->mesh->n_slots;
    m->half = malloc((n_half + 1) * sizeof *m->half);
    m->start = calloc(n + 2, sizeof *m->start);
    m->seen = malloc((n + 1) * sizeof *m->seen);
    m->edge_of = malloc((n_segments + 1) * sizeof *m->edge_of);
    m->next = malloc((n_segments + 1) * sizeof *m->next);
    m->head = malloc((n_segments > 0 ? n + 1 : 1) * sizeof *m->head);
    bool room = m->half && m->start && m->seen && m->edge_of && m->next && m->head;
    enum tri_status status = room ? match(m) : no_memory(m->error, m->elements->n);
    free(m->half);
    free(m->start);
    free(m->seen);
    free(m->next);
    free(m->head);
    return status;
}

/* --- subsegments */

/* The edge of this code becomes a subsegment between the same ends. */
static void add_sub(struct tri_mesh *mesh, int32_t code, int32_t from, int32_t to, int32_t marker, int32_t segment)
{
    int32_t s = tri_mesh_add_sub(mesh, from, to, marker, segment), other = *link_of(mesh, code);
    int side = tri_side(&mesh->sub[s], mesh->tri[tri_of(code)].v[tri_next[tri_edge(code)]]);
    mesh->parents[mesh->sub[s].parent].guard = mesh->xy[from]; /* what is outside is not known: nothing is its own */
    mesh->sub[s].side[side] = code;
    *link_of(mesh, code) = ~s;
    if (other == LOOSE)
        return;
    mesh->sub[s].side[1 - side] = other;
    *link_of(mesh, other) = ~s;
}

static void mark_ends(struct tri_mesh *mesh, const int32_t v[2], int32_t marker)
{
    for (int k = 0; k < 2; k++)
        if (mesh->vertex_markers[v[k]] == 0)
            mesh->vertex_markers[v[k]] = marker;
}

static void add_segments(const struct matcher *m)
{
    struct tri_mesh *mesh = m->mesh;
    for (int32_t k = 0; k < m->n_segments; k++) {
        const int32_t *v = &m->pslg->segments[2 * (size_t)k];
        int32_t code = m->edge_of[k], marker = m->pslg->segment_markers ? m->pslg->segment_markers[k] : 0;
        if (code == TRI_NONE)
            continue;
        int32_t link = *link_of(mesh, code);
        if (link >= 0)
            add_sub(mesh, code, v[0], v[1], marker, k);
        else if (mesh->sub[~link].marker == 0)
            mesh->sub[~link].marker = marker;
        mark_ends(mesh, v, marker);
    }
}

static void add_boundary(struct tri_mesh *mesh)
{
    for (int32_t t = 0; t < mesh->n_slots; t++)
        for (int e = 0; e < 3; e++) {
            const struct tri_triangle *at = &mesh->tri[t];
            if (at->n[e] == LOOSE)
                add_sub(mesh, tri_code(t, e), at->v[tri_next[e]], at->v[tri_prev[e]], 0, TRI_NONE);
        }
}

static enum tri_status add_subsegments(const struct matcher *m)
{
    int64_t n = 0;
    for (int32_t k = 0; k < m->n_segments; k++)
        n += m->edge_of[k] != TRI_NONE;
    for (int32_t t = 0; t < m->mesh->n_slots; t++)
        for (int e = 0; e < 3; e++)
            n += m->mesh->tri[t].n[e] == LOOSE;
    if (n > TRI_MAX_TRIANGLES)
        return tri_fail(m->error, TRI_TOO_LARGE, NULL, 0, "too many subsegments for one mesh");
    enum tri_status status = tri_mesh_reserve_subs(m->mesh, (int32_t)n, m->error);
    if (status)
        return status;
    add_segments(m);
    add_boundary(m->mesh);
    return TRI_OK;
}

/* --- attributes and area bounds as regions */

/* Regions other than 0 by the values they stand for, in an open hash table of twice as many places as triangles. */
struct values {
    struct tri_mesh *mesh;
    const struct tri_elements *elements;
    int32_t *place; /* region, or TRI_NONE */
    size_t mask;
};

static const double *attributes_of(const struct tri_elements *elements, int32_t t)
{
    return elements->attributes ? elements->attributes + (size_t)t * (size_t)elements->n_attributes : NULL;
}

static double bound_of(const struct tri_elements *elements, int32_t t)
{
    return elements->areas && elements->areas[t] > 0 ? elements->areas[t] : 0;
}

static uint64_t mix(uint64_t hash, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    hash = (hash ^ bits) * UINT64_C(0x9E3779B97F4A7C15);
    return hash ^ hash >> 29;
}

static bool is_region(const struct tri_mesh *mesh, int32_t region, const double *attributes, double bound)
{
    size_t n = (size_t)mesh->n_columns;
    return mesh->regions[region].max_area == bound &&
           (n == 0 || memcmp(mesh->columns + (size_t)region * n, attributes, n * sizeof *attributes) == 0);
}

static void add_region(struct tri_mesh *mesh, const double *attributes, double bound)
{
    size_t n = (size_t)mesh->n_columns;
    int32_t region = mesh->n_regions++;
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
    int32_t last = 0; /* most triangles have the values of the one before */
    for (int32_t t = 0; t < mesh->n_slots; t++) {
        const double *attributes = attributes_of(elements, t);
        double bound = bound_of(elements, t);
        if (!is_region(mesh, last, attributes, bound))
            last = find_region(values, attributes, bound);
        mesh->tri[t].region = last;
    }
}

/* Arrays for as many regions as triangles, of which only what is used is ever touched. */
static enum tri_status make_regions(struct tri_mesh *mesh, const struct tri_elements *elements, struct tri_error *error)
{
    size_t n = (size_t)mesh->n_slots + 1, size = 2;
    while (size < 2 * n)
        size *= 2;
    mesh->n_columns = elements->attributes ? elements->n_attributes : 0;
    struct tri_region *regions = realloc(mesh->regions, n * sizeof *regions);
    mesh->regions = regions ? regions : mesh->regions;
    if (mesh->n_columns > 0)
        mesh->columns = calloc(n, (size_t)mesh->n_columns * sizeof *mesh->columns);
    struct values values = {mesh, elements, malloc(size * sizeof *values.place), size - 1};
    enum tri_status status = TRI_OK;
    if (!regions || (mesh->n_columns > 0 && !mesh->columns) || !values.place) {
        status = no_memory(error, mesh->n_slots);
    } else {
        memset(values.place, 0xff, size * sizeof *values.place); /* TRI_NONE */
        assign_regions(&values);
    }
    free(values.place);
    return status;
}

/* --- all together */

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
    enum tri_status status = tri_mesh_take_points(mesh, m->pslg, m->error);
    status = status ? status : tri_stop_is_asked(mesh->stop) ? tri_fail_stopped(m->error) : take_triangles(m);
    status = status ? status : allocate_and_match(m);
    status = status ? status : add_subsegments(m);
    if (!status && (m->elements->areas || m->elements->attributes))
        status = make_regions(mesh, m->elements, m->error);
    if (status)
        return status;
    tri_mark_boundary(mesh);
    if (m->options->refine)
        status = tri_flip_to_delaunay(mesh, m->error);
    if (!status && m->options->refine)
        status = tri_unite_chains(mesh, m->error);
    return status ? status : tri_refine_prepare(mesh, m->error);
}

enum tri_status tri_reconstruct(struct tri_mesh *mesh, const struct tri_pslg *pslg, const struct tri_elements *elements,
                                const struct tri_reconstruct_options *options, struct tri_error *error)
{
    struct matcher m = {.mesh = mesh, .pslg = pslg, .elements = elements, .options = options, .error = error};
    *mesh = (struct tri_mesh){0};
    m.n_segments = options->use_segments ? pslg->n_segments : 0;
    enum tri_status status = tri_pslg_check(pslg, error);
    status = status ? status : check_elements(elements, error);
    status = status ? status : tri_mesh_init(mesh, error);
    mesh->stop = options->stop;
    status = status ? status : build(&m);
    for (int32_t k = 0; !status && options->is_edge && k < pslg->n_segments; k++)
        options->is_edge[k] = k < m.n_segments && (m.edge_of[k] != TRI_NONE || !names_edge(&m, k));
    free(m.edge_of);
    if (status)
        tri_mesh_free(mesh);
    return status;
}

/* --- what surrounds it */

enum tri_status tri_kept_make(struct tri_used *kept, const struct tri_mesh *mesh, const struct tri_elements *elements,
                              bool jettison, struct tri_error *error)
{
    enum { DROPPED = TRI_NONE - 1 };
    size_t n = elements->extra ? (size_t)elements->n * (size_t)(elements->n_nodes - 3) : 0;
    *kept = (struct tri_used){0};
    enum tri_status status = jettison || n > 0 ? tri_used_make(kept, mesh, error) : TRI_OK;
    if (status || jettison || n == 0)
        return status;
    for (size_t i = 0; i < n; i++) {
        int32_t v = elements->extra[i];
        if (v >= 0 && v < mesh->n_input && kept->number[v] == TRI_NONE)
            kept->number[v] = DROPPED;
    }
    kept->n = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        bool is_kept = kept->number[v] != DROPPED;
        kept->number[v] = is_kept ? kept->n : TRI_NONE;
        if (is_kept)
            kept->vertex[kept->n++] = v;
    }
    return TRI_OK;
}
