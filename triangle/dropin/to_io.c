/* struct triangulateio as output.
 *
 * The structs are worked on as copies, and copied back when all arrays are there. INVARIANT: until then nothing that
 * the caller can see has changed, so that giving up means to free what was allocated. */
#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/dropin/io.h"
#include "triangle/mesh/grid.h"

enum { MOST_ARRAYS = 14 };

struct output {
    const struct tri_switches *switches;
    struct tri_grid grid, voronoi;
    struct triangulateio out, vorout;
    void *made[MOST_ARRAYS]; /* arrays that were allocated here */
    int n_made;
    bool failed;             /* one of them could not be */
};

/* --- arrays */

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
    if (tri_switches_show_segments(s) && !s->no_poly) {
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

/* --- items */

/* A number as the caller counts; -1: none. */
static int shown(const struct output *o, int64_t index) { return (int)(index < 0 ? index : index + o->grid.base); }

/* One point of the mesh or of the Voronoi diagram into these arrays, of which markers may be NULL. */
static void fill_point(const struct tri_grid *grid, int64_t i, REAL *points, REAL *attributes, int *markers)
{
    struct tri_grid_point point;
    grid->point(grid->user, i, &point);
    points[2 * i] = (REAL)point.at[0];
    points[2 * i + 1] = (REAL)point.at[1];
    for (int32_t k = 0; k < grid->n_attributes; k++)
        attributes[i * grid->n_attributes + k] = (REAL)grid->attribute(grid->user, i, k);
    if (markers)
        markers[i] = point.marker;
}

/* The arrays of the output may be those of the input. A point never moves to a higher place, so that none is read
 * after it has been written. */
static void fill_points(struct output *o)
{
    int *markers = o->switches->no_markers ? NULL : o->out.pointmarkerlist;
    for (int64_t i = 0; !o->switches->no_node && i < o->grid.n_points; i++)
        fill_point(&o->grid, i, o->out.pointlist, o->out.pointattributelist, markers);
}

static void fill_triangle(struct output *o, int64_t t)
{
    const struct tri_grid *grid = &o->grid;
    int64_t nodes[6];
    grid->triangle(grid->user, t, nodes);
    for (int k = 0; k < grid->n_nodes; k++)
        o->out.trianglelist[t * grid->n_nodes + k] = shown(o, nodes[k]);
    for (int32_t k = 0; k < grid->n_columns; k++)
        o->out.triangleattributelist[t * grid->n_columns + k] = (REAL)grid->column(grid->user, t, k);
}

static void fill_neighbors(struct output *o, int64_t t)
{
    int64_t neighbors[3];
    o->grid.neighbors(o->grid.user, t, neighbors);
    for (int k = 0; k < 3; k++)
        o->out.neighborlist[3 * t + k] = shown(o, neighbors[k]);
}

static void fill_triangles(struct output *o)
{
    for (int64_t t = 0; !o->switches->no_ele && t < o->grid.n_triangles; t++)
        fill_triangle(o, t);
    for (int64_t t = 0; o->switches->neighbors && t < o->grid.n_triangles; t++)
        fill_neighbors(o, t);
}

static void fill_edge(const struct output *o, const struct tri_grid_edge *edge, int64_t i, int *ends, int *markers)
{
    for (int k = 0; k < 2; k++)
        ends[2 * i + k] = shown(o, edge->ends[k]);
    if (markers)
        markers[i] = edge->marker;
}

static void fill_segments(struct output *o)
{
    int *markers = o->switches->no_markers ? NULL : o->out.segmentmarkerlist;
    for (int64_t i = 0; i < o->grid.n_segments; i++) {
        struct tri_grid_edge segment;
        o->grid.segment(o->grid.user, i, &segment);
        fill_edge(o, &segment, i, o->out.segmentlist, markers);
    }
}

static void fill_edges(struct output *o)
{
    int *markers = o->switches->no_markers ? NULL : o->out.edgemarkerlist;
    for (int64_t i = 0; i < o->grid.n_edges; i++) {
        struct tri_grid_edge edge;
        o->grid.edge(o->grid.user, i, &edge);
        fill_edge(o, &edge, i, o->out.edgelist, markers);
    }
}

static void fill_voronoi(struct output *o)
{
    struct triangulateio *v = &o->vorout;
    for (int64_t i = 0; i < o->voronoi.n_points; i++)
        fill_point(&o->voronoi, i, v->pointlist, v->pointattributelist, NULL);
    for (int64_t i = 0; i < o->voronoi.n_edges; i++) {
        struct tri_grid_edge edge;
        o->voronoi.edge(o->voronoi.user, i, &edge);
        fill_edge(o, &edge, i, v->edgelist, NULL);
        for (int k = 0; k < 2; k++)
            v->normlist[2 * i + k] = (REAL)edge.direction[k];
    }
}

/* --- all together */

/* All fit an int: there are at most 2^28 vertices, so less than 3 * 2^28 edges. */
static void set_counts(struct output *o)
{
    struct triangulateio *out = &o->out;
    const struct tri_grid *grid = &o->grid;
    out->numberofedges = (int)grid->n_edges;
    out->numberofpoints = (int)grid->n_points;
    out->numberofpointattributes = grid->n_attributes;
    out->numberoftriangles = (int)grid->n_triangles;
    out->numberofcorners = grid->n_nodes;
    out->numberoftriangleattributes = grid->n_columns;
    out->numberofsegments = (int)grid->n_segments;
    o->vorout.numberofpoints = (int)o->voronoi.n_points;
    o->vorout.numberofpointattributes = o->voronoi.n_attributes;
    o->vorout.numberofedges = (int)o->voronoi.n_edges;
}

static void pass_on_lists(struct output *o, const struct triangulateio *in)
{
    bool some = o->switches->segments;
    if (!tri_switches_show_segments(o->switches) || o->switches->no_poly)
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
    if (tri_switches_show_segments(o->switches) && !o->switches->no_poly)
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
    struct output o = {.switches = switches};
    struct tri_grid_options options = tri_switches_grid(switches, mesh, &input->pslg, &input->elements);
    options.is_edge = input->is_edge;
    options.base = !switches->from_zero;
    memcpy(&o.out, out, sizeof o.out); /* with the bytes between the fields */
    if (vorout)
        memcpy(&o.vorout, vorout, sizeof o.vorout);
    enum tri_status status = tri_grid_make(&o.grid, &options, error);
    if (!status) {
        o.voronoi = tri_grid_voronoi(&o.grid);
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
    tri_grid_free(&o.grid);
    return status;
}

void trifree(void *array) { free(array); }
