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

static bool lists_segments(const struct output *o)
{
    return tri_switches_show_segments(o->switches) && !o->switches->no_poly;
}

/* --- arrays */

/* The caller's array, or a new one of n rows; empty ones are allocated too. */
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

/* Provides a field of out or vorout, if it is wanted. */
#define PROVIDE(o, wanted, field, n, width) \
    ((field) = (wanted) ? provide(o, field, n, width, sizeof *(field)) : (field))

static void provide_arrays(struct output *o)
{
    const struct tri_switches *s = o->switches;
    struct triangulateio *out = &o->out, *v = &o->vorout;
    const int n = out->numberofpoints, n_attributes = out->numberofpointattributes, m = out->numberoftriangles;
    const int n_columns = out->numberoftriangleattributes, n_segments = out->numberofsegments;
    const bool markers = !s->no_markers;
    PROVIDE(o, !s->no_node, out->pointlist, n, 2);
    PROVIDE(o, !s->no_node && n_attributes > 0, out->pointattributelist, n, n_attributes);
    PROVIDE(o, !s->no_node && markers, out->pointmarkerlist, n, 1);
    PROVIDE(o, !s->no_ele, out->trianglelist, m, out->numberofcorners);
    PROVIDE(o, !s->no_ele && n_columns > 0, out->triangleattributelist, m, n_columns);
    PROVIDE(o, s->neighbors, out->neighborlist, m, 3);
    PROVIDE(o, lists_segments(o), out->segmentlist, n_segments, 2);
    PROVIDE(o, lists_segments(o) && markers, out->segmentmarkerlist, n_segments, 1);
    PROVIDE(o, s->edges, out->edgelist, out->numberofedges, 2);
    PROVIDE(o, s->edges && markers, out->edgemarkerlist, out->numberofedges, 1);
    PROVIDE(o, s->voronoi, v->pointlist, v->numberofpoints, 2);
    PROVIDE(o, s->voronoi && v->numberofpointattributes > 0, v->pointattributelist, v->numberofpoints,
            v->numberofpointattributes);
    PROVIDE(o, s->voronoi, v->edgelist, v->numberofedges, 2);
    PROVIDE(o, s->voronoi, v->normlist, v->numberofedges, 2);
}

/* --- items */

/* A number as the caller counts; -1: none. */
static int shown(const struct output *o, int64_t index) { return (int)(index < 0 ? index : index + o->grid.base); }

/* The points of the mesh or of the Voronoi diagram into these arrays, of which markers may be NULL. They may be the
 * arrays of the input: a point never moves to a higher place, so that none is read after it has been written. */
static void fill_points(const struct tri_grid *grid, REAL *points, REAL *attributes, int *markers)
{
    for (int64_t i = 0; i < grid->n_points; i++) {
        struct tri_grid_point point;
        grid->point(grid->user, i, &point);
        points[2 * i] = (REAL)point.at[0];
        points[2 * i + 1] = (REAL)point.at[1];
        for (int32_t k = 0; k < grid->n_attributes; k++)
            attributes[i * grid->n_attributes + k] = (REAL)grid->attribute(grid->user, i, k);
        if (markers)
            markers[i] = point.marker;
    }
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

/* n edges or segments of a grid into these arrays, of which markers and directions may be NULL. */
static void fill_edges(const struct output *o, const struct tri_grid *grid, int64_t n,
                       void (*edge_at)(const void *user, int64_t i, struct tri_grid_edge *edge), int *ends,
                       int *markers, REAL *directions)
{
    for (int64_t i = 0; i < n; i++) {
        struct tri_grid_edge edge;
        edge_at(grid->user, i, &edge);
        for (int k = 0; k < 2; k++) {
            ends[2 * i + k] = shown(o, edge.ends[k]);
            if (directions)
                directions[2 * i + k] = (REAL)edge.direction[k];
        }
        if (markers)
            markers[i] = edge.marker;
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
    if (!lists_segments(o))
        return;
    o->out.holelist = some ? in->holelist : NULL;
    o->out.numberofholes = some ? in->numberofholes : 0;
    o->out.regionlist = some ? in->regionlist : NULL;
    o->out.numberofregions = some ? in->numberofregions : 0;
}

static enum tri_status provide_all(struct output *o, struct tri_error *error)
{
    provide_arrays(o);
    for (int i = 0; o->failed && i < o->n_made; i++)
        free(o->made[i]);
    return o->failed ? tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the output") : TRI_OK;
}

static void fill_all(struct output *o)
{
    const bool markers = !o->switches->no_markers;
    const struct tri_grid *g = &o->grid, *voronoi = &o->voronoi;
    struct triangulateio *out = &o->out, *v = &o->vorout;
    if (!o->switches->no_node)
        fill_points(g, out->pointlist, out->pointattributelist, markers ? out->pointmarkerlist : NULL);
    fill_triangles(o);
    if (lists_segments(o))
        fill_edges(o, g, g->n_segments, g->segment, out->segmentlist, markers ? out->segmentmarkerlist : NULL, NULL);
    if (o->switches->edges)
        fill_edges(o, g, g->n_edges, g->edge, out->edgelist, markers ? out->edgemarkerlist : NULL, NULL);
    if (o->switches->voronoi) {
        fill_points(voronoi, v->pointlist, v->pointattributelist, NULL);
        fill_edges(o, voronoi, voronoi->n_edges, voronoi->edge, v->edgelist, NULL, v->normlist);
    }
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
