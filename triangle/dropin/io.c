/* Reads struct triangulateio. Only the fields that the switches select are read; the others may be uninitialised. */
#include "triangle/dropin/io.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/mesh/grid.h"

_Static_assert(sizeof(int) == sizeof(int32_t), "the library's int is the mesh's");

/* A conversion in progress. After a failure, the remaining fields are skipped. */
struct taking {
    struct tri_io_input *input; /* the result */
    const struct triangulateio *in; /* the caller's struct */
    bool is_mesh; /* true: switch r */
    int32_t base; /* number of the first point: 0 or 1 */
    enum tri_status status;         /* first failure */
    struct tri_error *error;        /* its description */
};

static void check(struct taking *t, const char *what, int n, const void *array)
{
    if (!t->status && n < 0)
        t->status = tri_fail(t->error, TRI_BAD_INPUT, NULL, 0, "the number of %s is %d", what, n);
    if (!t->status && n > 0 && !array)
        t->status = tri_fail(t->error, TRI_BAD_INPUT, NULL, 0, "%d %s without an array", n, what);
}

/* Allocates memory that lives as long as the input. Returns NULL on failure. */
static void *make_copy(struct taking *t, size_t n, size_t item)
{
    if (t->status)
        return NULL;
    assert(t->input->n_copies < TRI_IO_MOST_COPIES);
    void *copy = n < SIZE_MAX / item ? malloc((n + 1) * item) : NULL;
    if (copy)
        t->input->copies[t->input->n_copies++] = copy;
    else
        t->status = tri_fail(t->error, TRI_NO_MEMORY, NULL, 0, "out of memory for a copy of the input");
    return copy;
}

/* Returns n rows of numbers as double, or NULL if there are none or after a failure. */
static double *take_reals(struct taking *t, REAL *given, int n, int width)
{
    if (t->status || !given || n == 0 || width == 0)
        return NULL;
#ifdef SINGLE
    const size_t count = (size_t)n * (size_t)width;
    double *taken = make_copy(t, count, sizeof *taken);
    for (size_t i = 0; taken && i < count; i++)
        taken[i] = given[i];
    return taken;
#else
    return given;
#endif
}

/* Converts a number to an index from 0, or to -1 if there is no such point. */
static int32_t index_of(int number, int32_t base, int32_t n_points)
{
    return number >= base && number - base < n_points ? number - base : -1;
}

/* With r, segments that are no edges are passed to the output after the others. Copies their data, since `out` may
 * use arrays of `in`. */
static void take_loose(struct taking *t)
{
    const size_t n = (size_t)t->in->numberofsegments;
    int32_t *markers = t->in->segmentmarkerlist ? make_copy(t, n, sizeof *markers) : NULL;
    if (markers)
        memcpy(markers, t->in->segmentmarkerlist, n * sizeof *markers);
    t->input->pslg.segment_markers = markers;
    t->input->is_edge = make_copy(t, n, sizeof *t->input->is_edge);
}

/* Converts a number to an index from 0, but keeps invalid numbers distinguishable as far as possible. */
static int32_t end_of(int number, int32_t base) { return number > INT32_MIN ? number - base : number; }

/* Reads the ends of segments. Without r, segments with an invalid end are skipped later. */
static void take_segments(struct taking *t)
{
    const struct triangulateio *in = t->in;
    const int n = in->numberofsegments, n_points = in->numberofpoints;
    check(t, "segments", n, in->segmentlist);
    int32_t *ends = t->status || n == 0 ? NULL : make_copy(t, 2 * (size_t)n, sizeof *ends);
    if (!ends)
        return;
    for (size_t i = 0; i < 2 * (size_t)n && !t->status; i++) {
        ends[i] = end_of(in->segmentlist[i], t->base);
        if ((ends[i] < 0 || ends[i] >= n_points) && t->is_mesh)
            t->status = tri_fail(t->error, TRI_BAD_INPUT, NULL, 0, "segment %d has end %d, of %d points",
                                 (int)(i / 2) + t->base, in->segmentlist[i], n_points);
    }
    t->input->pslg.n_segments = n;
    t->input->pslg.segments = ends;
    t->input->pslg.segment_markers = in->segmentmarkerlist;
    if (t->is_mesh)
        take_loose(t);
}

static void take_points(struct taking *t)
{
    const struct triangulateio *in = t->in;
    struct tri_pslg *pslg = &t->input->pslg;
    check(t, "points", in->numberofpoints, in->pointlist);
    check(t, "attributes of a point", in->numberofpointattributes, in->pointattributelist);
    pslg->n_points = in->numberofpoints;
    pslg->n_attributes = in->numberofpointattributes;
    pslg->points = take_reals(t, in->pointlist, pslg->n_points, 2);
    pslg->attributes = take_reals(t, in->pointattributelist, pslg->n_points, pslg->n_attributes);
    pslg->markers = in->pointmarkerlist;
}

/* Returns a count. Clients of Triangle may leave some counts negative, which means 0. */
static int count_of(int given) { return given > 0 ? given : 0; }

/* Reads holes or regions. */
static double *take_places(struct taking *t, const char *what, REAL *list, int given, int width, int32_t *n)
{
    *n = count_of(given);
    check(t, what, *n, list);
    return take_reals(t, list, *n, width);
}

/* Reads corners, and separately the midside nodes. */
static void take_nodes(struct taking *t)
{
    const struct triangulateio *in = t->in;
    const size_t n = t->status ? 0 : (size_t)in->numberoftriangles, n_nodes = (size_t)in->numberofcorners;
    int32_t *corners = make_copy(t, 3 * n, sizeof *corners);
    int32_t *extra = n_nodes > 3 ? make_copy(t, n * (n_nodes - 3), sizeof *extra) : NULL;
    for (size_t i = 0; i < n * n_nodes && !t->status; i++) {
        const size_t k = i % n_nodes;
        *(k < 3 ? &corners[3 * (i / n_nodes) + k] : &extra[(n_nodes - 3) * (i / n_nodes) + k - 3]) =
            index_of(in->trianglelist[i], t->base, in->numberofpoints);
    }
    t->input->elements.corners = corners;
    t->input->elements.extra = extra;
}

static void take_triangles(struct taking *t, bool with_areas)
{
    const struct triangulateio *in = t->in;
    struct tri_elements *elements = &t->input->elements;
    const int n = in->numberoftriangles;
    elements->n = n;
    elements->n_nodes = in->numberofcorners;
    elements->n_attributes = count_of(in->numberoftriangleattributes);
    check(t, "triangles", n, in->trianglelist);
    if (!t->status && elements->n_nodes != 3 && elements->n_nodes != 6)
        t->status = tri_fail(t->error, TRI_BAD_INPUT, NULL, 0, "triangles with %d corners", in->numberofcorners);
    check(t, "attributes of a triangle", elements->n_attributes, in->triangleattributelist);
    take_nodes(t);
    elements->attributes = take_reals(t, in->triangleattributelist, n, elements->n_attributes);
    elements->areas = with_areas ? take_reals(t, in->trianglearealist, n, 1) : NULL;
}

enum tri_status tri_io_input_make(struct tri_io_input *input, const struct triangulateio *in,
                                  const struct tri_switches *switches, struct tri_error *error)
{
    struct taking t = {input, in, switches->mesh, !switches->from_zero, TRI_OK, error};
    memset(input, 0, sizeof *input);
    take_points(&t);
    if (switches->segments)
        take_segments(&t);
    if (switches->segments && !switches->mesh)
        input->pslg.holes = take_places(&t, "holes", in->holelist, in->numberofholes, 2, &input->pslg.n_holes);
    if (tri_switches_use_regions(switches))
        input->pslg.regions = take_places(&t, "regions", in->regionlist, in->numberofregions, 4,
                                          &input->pslg.n_regions);
    if (switches->mesh)
        take_triangles(&t, switches->area_lists);
    return t.status;
}

void tri_io_input_free(struct tri_io_input *input)
{
    for (int i = 0; i < input->n_copies; i++)
        free(input->copies[i]);
    memset(input, 0, sizeof *input);
}

/* Writes struct triangulateio.
 *
 * The structs are changed in copies, which are copied back when all arrays have been allocated. INVARIANT. Before
 * that, nothing visible to the caller has changed, so on failure it suffices to free the new arrays. */

enum { MOST_ARRAYS = 14 };

struct output {
    const struct tri_switches *switches; /* select what is written */
    struct tri_grid grid, voronoi;       /* the mesh and its Voronoi diagram */
    struct triangulateio out, vorout;    /* copies of the caller's structs */
    void *made[MOST_ARRAYS]; /* arrays allocated here */
    int n_made;              /* number of new arrays */
    bool failed;             /* true: an allocation failed */
};

static bool lists_segments(const struct output *o)
{
    return tri_switches_show_segments(o->switches) && !o->switches->no_poly;
}

/* --- arrays */

/* Returns the caller's array, or a new one with n rows. Empty arrays are allocated as well. */
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

/* Provides the array of a field of out or vorout if it is wanted. */
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

/* --- filling */

/* Converts an index to the caller's numbering; -1: none. */
static int out_number(const struct output *o, int64_t index) { return (int)(index < 0 ? index : index + o->grid.base); }

/* Writes the points of the mesh or of the Voronoi diagram into these arrays; `markers` may be NULL. The arrays may
 * be those of the input: a point never moves to a higher index, so each is read before it is overwritten. */
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
        o->out.trianglelist[t * grid->n_nodes + k] = out_number(o, nodes[k]);
    for (int32_t k = 0; k < grid->n_columns; k++)
        o->out.triangleattributelist[t * grid->n_columns + k] = (REAL)grid->column(grid->user, t, k);
}

static void fill_neighbors(struct output *o, int64_t t)
{
    int64_t neighbors[3];
    o->grid.neighbors(o->grid.user, t, neighbors);
    for (int k = 0; k < 3; k++)
        o->out.neighborlist[3 * t + k] = out_number(o, neighbors[k]);
}

static void fill_triangles(struct output *o)
{
    for (int64_t t = 0; !o->switches->no_ele && t < o->grid.n_triangles; t++)
        fill_triangle(o, t);
    for (int64_t t = 0; o->switches->neighbors && t < o->grid.n_triangles; t++)
        fill_neighbors(o, t);
}

/* Writes n edges or segments of a grid into these arrays; `markers` and `directions` may be NULL. */
static void fill_edges(const struct output *o, const struct tri_grid *grid, int64_t n,
                       void (*edge_at)(const void *user, int64_t i, struct tri_grid_edge *edge), int *ends,
                       int *markers, REAL *directions)
{
    for (int64_t i = 0; i < n; i++) {
        struct tri_grid_edge edge;
        edge_at(grid->user, i, &edge);
        for (int k = 0; k < 2; k++) {
            ends[2 * i + k] = out_number(o, edge.ends[k]);
            if (directions)
                directions[2 * i + k] = (REAL)edge.direction[k];
        }
        if (markers)
            markers[i] = edge.marker;
    }
}

/* --- all steps */

/* All counts fit an int: with at most 2^28 vertices there are fewer than 3 * 2^28 edges. */
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
    memcpy(&o.out, out, sizeof o.out); /* includes the padding bytes */
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
