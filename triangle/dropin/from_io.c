/* struct triangulateio as input.
 *
 * Only the fields that the switches select are looked at: the rest may be garbage. */
#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/dropin/io.h"

_Static_assert(sizeof(int) == sizeof(int32_t), "the library's int is the mesh's");

/* The input on its way; after a failure nothing more is taken. */
struct taking {
    struct tri_io_input *input;
    const struct triangulateio *in;
    bool is_mesh; /* switch r */
    int32_t base;
    enum tri_status status;
    struct tri_error *error;
};

static void check(struct taking *t, const char *what, int n, const void *array)
{
    if (!t->status && n < 0)
        t->status = tri_fail(t->error, TRI_BAD_INPUT, NULL, 0, "%d for the number of %s", n, what);
    if (!t->status && n > 0 && !array)
        t->status = tri_fail(t->error, TRI_BAD_INPUT, NULL, 0, "%d %s without an array", n, what);
}

/* Memory that lives as long as the input; NULL: a failure. */
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

/* n rows of numbers as double; NULL: none, or a failure. */
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

/* An index from 0; what names no point becomes -1. */
static int32_t index_of(int number, int32_t base, int32_t n_points)
{
    return number >= base && number - base < n_points ? number - base : -1;
}

/* With r, segments that are no edges are passed on behind the others, where `out` may name arrays of `in`. */
static void take_loose(struct taking *t)
{
    const size_t n = (size_t)t->in->numberofsegments;
    int32_t *markers = t->in->segmentmarkerlist ? make_copy(t, n, sizeof *markers) : NULL;
    if (markers)
        memcpy(markers, t->in->segmentmarkerlist, n * sizeof *markers);
    t->input->pslg.segment_markers = markers;
    t->input->is_edge = make_copy(t, n, sizeof *t->input->is_edge);
}

/* Likewise, but goes on telling what it is, as far as that can be told. */
static int32_t end_of(int number, int32_t base) { return number > INT32_MIN ? number - base : number; }

/* Ends of segments. Without r those that name no point are skipped later. */
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

/* A count that clients of Triangle may leave negative: no items. */
static int count_of(int given) { return given > 0 ? given : 0; }

static void take_holes(struct taking *t)
{
    const int n = count_of(t->in->numberofholes);
    check(t, "holes", n, t->in->holelist);
    t->input->pslg.n_holes = n;
    t->input->pslg.holes = take_reals(t, t->in->holelist, n, 2);
}

static void take_regions(struct taking *t)
{
    const int n = count_of(t->in->numberofregions);
    check(t, "regions", n, t->in->regionlist);
    t->input->pslg.n_regions = n;
    t->input->pslg.regions = take_reals(t, t->in->regionlist, n, 4);
}

/* Corners, and the nodes amid edges apart from them. */
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
        take_holes(&t);
    if (tri_switches_use_regions(switches))
        take_regions(&t);
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
