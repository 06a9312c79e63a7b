/* struct triangulateio as output.
 *
 * The structs are worked on as copies, and copied back when all arrays are there. INVARIANT: until then nothing that
 * the caller can see has changed, so that giving up means to free what was allocated.
 *
 * Numbers: vertex v of the mesh is point number_of(v), v itself unless vertices are left out; the middle of edge i (o2)
 * comes behind all of them. */
#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/dropin/io.h"
#include "triangle/topology.h"

enum { MOST_ARRAYS = 14 };

struct output {
    const struct tri_mesh *mesh;
    const struct tri_io_input *input;
    const struct tri_switches *switches;
    struct triangulateio out, vorout;
    struct tri_edge_list edges; /* made where an array needs them */
    struct tri_used used;       /* vertex and number are NULL: all vertices are points */
    int32_t n_vertices;         /* points that are vertices of the mesh */
    int32_t base;
    void *made[MOST_ARRAYS];    /* arrays that were allocated here */
    int n_made;
    bool failed;                /* one of them could not be */
};

/* --- arrays */

static bool writes_segments(const struct tri_switches *s) { return (s->segments || s->keep_hull) && !s->no_poly; }

/* The caller's array, or a new one of n items; empty ones are allocated too. */
static void *provide(struct output *o, void *given, int n, int width, size_t item)
{
    if (given || o->failed)
        return given;
    size_t count = (size_t)n * (size_t)width;
    void *made = count <= SIZE_MAX / item ? malloc(count ? count * item : 1) : NULL;
    o->failed = !made;
    if (made) {
        assert(o->n_made < MOST_ARRAYS);
        o->made[o->n_made++] = made;
    }
    return made;
}

/* Provides a field of out or vorout. */
#define PROVIDE(o, field, n, width) ((field) = provide(o, field, n, width, sizeof *(field)))

static void provide_points(struct output *o)
{
    struct triangulateio *out = &o->out;
    if (o->switches->no_node)
        return;
    PROVIDE(o, out->pointlist, out->numberofpoints, 2);
    if (out->numberofpointattributes > 0)
        PROVIDE(o, out->pointattributelist, out->numberofpoints, out->numberofpointattributes);
    if (!o->switches->no_markers)
        PROVIDE(o, out->pointmarkerlist, out->numberofpoints, 1);
}

static void provide_triangles(struct output *o)
{
    struct triangulateio *out = &o->out;
    if (!o->switches->no_ele) {
        PROVIDE(o, out->trianglelist, out->numberoftriangles, out->numberofcorners);
        if (out->numberoftriangleattributes > 0)
            PROVIDE(o, out->triangleattributelist, out->numberoftriangles, out->numberoftriangleattributes);
    }
    if (o->switches->neighbors)
        PROVIDE(o, out->neighborlist, out->numberoftriangles, 3);
}

static void provide_edges(struct output *o)
{
    const struct tri_switches *s = o->switches;
    struct triangulateio *out = &o->out;
    if (writes_segments(s)) {
        PROVIDE(o, out->segmentlist, out->numberofsegments, 2);
        if (!s->no_markers)
            PROVIDE(o, out->segmentmarkerlist, out->numberofsegments, 1);
    }
    if (s->edges) {
        PROVIDE(o, out->edgelist, out->numberofedges, 2);
        if (!s->no_markers)
            PROVIDE(o, out->edgemarkerlist, out->numberofedges, 1);
    }
}

static void provide_voronoi(struct output *o)
{
    struct triangulateio *v = &o->vorout;
    if (!o->switches->voronoi)
        return;
    PROVIDE(o, v->pointlist, v->numberofpoints, 2);
    if (v->numberofpointattributes > 0)
        PROVIDE(o, v->pointattributelist, v->numberofpoints, v->numberofpointattributes);
    PROVIDE(o, v->edgelist, v->numberofedges, 2);
    PROVIDE(o, v->normlist, v->numberofedges, 2);
}

/* --- points */

static int number_of(const struct output *o, int32_t v) { return (o->used.number ? o->used.number[v] : v) + o->base; }

/* The arrays of the output may be those of the input. A point never moves to a higher place, so that none is read
 * after it has been written. */
static void fill_vertex(struct output *o, int32_t i)
{
    const struct tri_mesh *mesh = o->mesh;
    int32_t v = o->used.vertex ? o->used.vertex[i] : i;
    double at[2];
    assert(v >= i);
    if (v < mesh->n_input)
        memcpy(at, &o->input->pslg.points[2 * (size_t)v], sizeof at);
    else
        tri_mesh_place(mesh, v, at);
    o->out.pointlist[2 * (size_t)i] = (REAL)at[0];
    o->out.pointlist[2 * (size_t)i + 1] = (REAL)at[1];
    size_t width = (size_t)mesh->n_attributes;
    for (size_t k = 0; k < width; k++)
        o->out.pointattributelist[(size_t)i * width + k] = (REAL)mesh->attributes[(size_t)v * width + k];
    if (!o->switches->no_markers)
        o->out.pointmarkerlist[i] = mesh->vertex_markers[v];
}

static void fill_blend(const struct output *o, const struct tri_blend *blend, REAL *place, REAL *attributes)
{
    place[0] = (REAL)blend->at[0];
    place[1] = (REAL)blend->at[1];
    for (int32_t k = 0; k < o->mesh->n_attributes; k++)
        attributes[k] = (REAL)tri_blend_attribute(o->mesh, blend, k);
}

static REAL *attributes_at(const struct output *o, REAL *list, int32_t i)
{
    return o->mesh->n_attributes ? list + (size_t)i * (size_t)o->mesh->n_attributes : NULL;
}

static void fill_points(struct output *o)
{
    struct triangulateio *out = &o->out;
    if (o->switches->no_node)
        return;
    for (int32_t i = 0; i < o->n_vertices; i++)
        fill_vertex(o, i);
    for (int32_t i = o->n_vertices; i < out->numberofpoints; i++) {
        int32_t code = o->edges.codes[i - o->n_vertices];
        struct tri_blend middle = tri_edge_middle(o->mesh, code);
        fill_blend(o, &middle, &out->pointlist[2 * (size_t)i], attributes_at(o, out->pointattributelist, i));
        if (!o->switches->no_markers)
            out->pointmarkerlist[i] = tri_edge_marker(o->mesh, code);
    }
}

/* --- triangles and edges */

static void fill_triangle(struct output *o, int32_t t)
{
    struct triangulateio *out = &o->out;
    int *nodes = &out->trianglelist[(size_t)t * (size_t)out->numberofcorners];
    for (size_t k = 0; k < 3; k++) {
        nodes[k] = number_of(o, o->mesh->tri[t].v[k]);
        if (out->numberofcorners == 6)
            nodes[3 + k] = o->n_vertices + o->edges.number[3 * (size_t)t + k] + o->base;
    }
    const double *attributes = tri_region_attributes(o->mesh, o->mesh->tri[t].region);
    size_t width = (size_t)out->numberoftriangleattributes;
    for (size_t k = 0; k < width; k++)
        out->triangleattributelist[(size_t)t * width + k] = (REAL)attributes[k];
}

static void fill_neighbors(struct output *o, int32_t t)
{
    int32_t neighbors[3];
    tri_neighbors(o->mesh, t, neighbors);
    for (size_t k = 0; k < 3; k++)
        o->out.neighborlist[3 * (size_t)t + k] = neighbors[k] == TRI_NONE ? -1 : neighbors[k] + o->base;
}

static void fill_triangles(struct output *o)
{
    for (int32_t t = 0; !o->switches->no_ele && t < o->mesh->n_slots; t++)
        fill_triangle(o, t);
    for (int32_t t = 0; o->switches->neighbors && t < o->mesh->n_slots; t++)
        fill_neighbors(o, t);
}

static void fill_segment(struct output *o, int32_t s, const int32_t ends[2], int32_t marker)
{
    o->out.segmentlist[2 * (size_t)s] = number_of(o, ends[0]);
    o->out.segmentlist[2 * (size_t)s + 1] = number_of(o, ends[1]);
    if (!o->switches->no_markers)
        o->out.segmentmarkerlist[s] = marker;
}

/* A segment of the input that is no edge of the mesh (r and p): Triangle passes it on. */
static bool is_loose(const struct output *o, int32_t segment)
{
    const int32_t *ends = &o->input->pslg.segments[2 * (size_t)segment];
    bool has_ends = !o->used.number || (o->used.number[ends[0]] != TRI_NONE && o->used.number[ends[1]] != TRI_NONE);
    return !o->input->is_edge[segment] && has_ends;
}

static void fill_segments(struct output *o)
{
    const struct tri_pslg *pslg = &o->input->pslg;
    int32_t n = o->mesh->n_subs;
    for (int32_t s = 0; s < n; s++)
        fill_segment(o, s, o->mesh->sub[s].v, o->mesh->sub[s].marker);
    for (int32_t k = 0; o->input->is_edge && k < pslg->n_segments; k++)
        if (is_loose(o, k))
            fill_segment(o, n++, &pslg->segments[2 * (size_t)k], pslg->segment_markers ? pslg->segment_markers[k] : 0);
    assert(n == o->out.numberofsegments);
}

static void fill_edges(struct output *o)
{
    for (int32_t i = 0; i < o->edges.n; i++) {
        int32_t ends[2];
        tri_edge_ends(o->mesh, o->edges.codes[i], ends);
        o->out.edgelist[2 * (size_t)i] = number_of(o, ends[0]);
        o->out.edgelist[2 * (size_t)i + 1] = number_of(o, ends[1]);
        if (!o->switches->no_markers)
            o->out.edgemarkerlist[i] = tri_edge_marker(o->mesh, o->edges.codes[i]);
    }
}

static void fill_voronoi(struct output *o)
{
    struct triangulateio *v = &o->vorout;
    for (int32_t t = 0; t < o->mesh->n_slots; t++) {
        struct tri_blend center = tri_voronoi_vertex(o->mesh, t);
        fill_blend(o, &center, &v->pointlist[2 * (size_t)t], attributes_at(o, v->pointattributelist, t));
    }
    for (int32_t i = 0; i < o->edges.n; i++) {
        int32_t ends[2];
        double direction[2];
        tri_voronoi_edge(o->mesh, o->edges.codes[i], ends, direction);
        for (size_t k = 0; k < 2; k++) {
            v->edgelist[2 * (size_t)i + k] = ends[k] == TRI_NONE ? -1 : ends[k] + o->base;
            v->normlist[2 * (size_t)i + k] = (REAL)direction[k];
        }
    }
}

/* --- all together */

static enum tri_status list_what_is_needed(struct output *o, struct tri_error *error)
{
    const struct tri_switches *s = o->switches;
    enum tri_status status = tri_kept_make(&o->used, o->mesh, &o->input->elements, s->jettison, error);
    if (!status && (s->edges || s->voronoi || s->second_order))
        status = tri_edge_list_make(&o->edges, o->mesh, s->second_order, error);
    return status;
}

/* Every boundary edge is a subsegment. */
static int32_t count_edges(const struct tri_mesh *mesh)
{
    int64_t boundary = 0;
    for (int32_t s = 0; s < mesh->n_subs; s++)
        boundary += mesh->sub[s].side[0] == TRI_NONE || mesh->sub[s].side[1] == TRI_NONE;
    return (int32_t)((3 * (int64_t)mesh->n_slots + boundary) / 2);
}

static int32_t count_segments(const struct output *o)
{
    int32_t n = o->mesh->n_subs;
    for (int32_t k = 0; o->input->is_edge && k < o->input->pslg.n_segments; k++)
        n += is_loose(o, k);
    return n;
}

static int count_columns(const struct output *o)
{
    const struct tri_switches *s = o->switches;
    if (s->mesh)
        return o->input->elements.n_attributes;
    return s->segments && s->regions && o->input->pslg.n_regions > 0;
}

/* All fit an int: there are at most 2^28 vertices, so less than 3 * 2^28 edges. */
static void set_counts(struct output *o)
{
    struct triangulateio *out = &o->out;
    const struct tri_mesh *mesh = o->mesh;
    out->numberofedges = count_edges(mesh);
    assert(!o->edges.codes || o->edges.n == out->numberofedges);
    out->numberofpoints = o->n_vertices + (o->switches->second_order ? out->numberofedges : 0);
    out->numberofpointattributes = mesh->n_attributes;
    out->numberoftriangles = mesh->n_slots;
    out->numberofcorners = o->switches->second_order ? 6 : 3;
    out->numberoftriangleattributes = count_columns(o);
    out->numberofsegments = count_segments(o);
    o->vorout.numberofpoints = mesh->n_slots;
    o->vorout.numberofpointattributes = mesh->n_attributes;
    o->vorout.numberofedges = out->numberofedges;
}

static void pass_on_lists(struct output *o, const struct triangulateio *in)
{
    bool some = o->switches->segments;
    if (!writes_segments(o->switches))
        return;
    o->out.holelist = some ? in->holelist : NULL;
    o->out.numberofholes = some ? in->numberofholes : 0;
    o->out.regionlist = some ? in->regionlist : NULL;
    o->out.numberofregions = some ? in->numberofregions : 0;
}

static enum tri_status provide_all(struct output *o, struct tri_error *error)
{
    provide_points(o);
    provide_triangles(o);
    provide_edges(o);
    provide_voronoi(o);
    for (int i = 0; o->failed && i < o->n_made; i++)
        free(o->made[i]);
    return o->failed ? tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the output") : TRI_OK;
}

static void fill_all(struct output *o)
{
    fill_points(o);
    fill_triangles(o);
    if (writes_segments(o->switches))
        fill_segments(o);
    if (o->switches->edges)
        fill_edges(o);
    if (o->switches->voronoi)
        fill_voronoi(o);
}

enum tri_status tri_io_output(const struct tri_mesh *mesh, const struct tri_io_input *input,
                              const struct tri_switches *switches, const struct triangulateio *in,
                              struct triangulateio *out, struct triangulateio *vorout, struct tri_error *error)
{
    struct output o = {.mesh = mesh, .input = input, .switches = switches, .base = !switches->from_zero};
    memcpy(&o.out, out, sizeof o.out); /* with the bytes between the fields */
    if (vorout)
        memcpy(&o.vorout, vorout, sizeof o.vorout);
    enum tri_status status = list_what_is_needed(&o, error);
    if (!status) {
        o.n_vertices = o.used.vertex ? o.used.n : mesh->n_vertices;
        set_counts(&o);
        pass_on_lists(&o, in);
        status = provide_all(&o, error);
    }
    if (!status) {
        fill_all(&o);
        memcpy(out, &o.out, sizeof o.out);
        if (vorout)
            memcpy(vorout, &o.vorout, sizeof o.vorout);
    }
    tri_edge_list_free(&o.edges);
    tri_used_free(&o.used);
    return status;
}

void trifree(void *array) { free(array); }
