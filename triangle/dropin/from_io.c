/* struct triangulateio as input.
 *
 * Only the fields that the switches select are looked at: the rest may be garbage. */
#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/dropin/io.h"

_Static_assert(sizeof(int) == sizeof(int32_t), "the library's int is the mesh's");

static enum tri_status check(const char *what, int n, const void *array, struct tri_error *error)
{
    if (n < 0)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "%d for the number of %s", n, what);
    if (n > 0 && !array)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "%d %s without an array", n, what);
    return TRI_OK;
}

/* Memory that lives as long as the input. */
static void *make_copy(struct tri_io_input *input, size_t n, size_t item, struct tri_error *error)
{
    assert(input->n_copies < TRI_IO_MOST_COPIES);
    void *copy = n < SIZE_MAX / item ? malloc((n + 1) * item) : NULL;
    if (!copy)
        tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for a copy of the input");
    else
        input->copies[input->n_copies++] = copy;
    return copy;
}

/* n rows of numbers, n >= 0, as double. */
static enum tri_status take_reals(struct tri_io_input *input, double **taken, REAL *given, int n, int width,
                                  struct tri_error *error)
{
#ifdef SINGLE
    size_t count = (size_t)n * (size_t)width;
    *taken = NULL;
    if (!given || count == 0)
        return TRI_OK;
    *taken = make_copy(input, count, sizeof **taken, error);
    for (size_t i = 0; *taken && i < count; i++)
        (*taken)[i] = given[i];
    return *taken ? TRI_OK : TRI_NO_MEMORY;
#else
    (void)input, (void)n, (void)width, (void)error;
    *taken = given;
    return TRI_OK;
#endif
}

/* An index from 0; what names no point becomes -1. */
static int32_t index_of(int number, int32_t base, int32_t n_points)
{
    return number >= base && number - base < n_points ? number - base : -1;
}

/* With r, segments that are no edges are passed on behind the others, where `out` may name arrays of `in`. */
static enum tri_status take_loose(struct tri_io_input *input, const struct triangulateio *in, struct tri_error *error)
{
    size_t n = (size_t)in->numberofsegments;
    input->is_edge = make_copy(input, n, sizeof *input->is_edge, error);
    if (input->is_edge && in->segmentmarkerlist) {
        input->pslg.segment_markers = make_copy(input, n, sizeof *input->pslg.segment_markers, error);
        if (input->pslg.segment_markers)
            memcpy(input->pslg.segment_markers, in->segmentmarkerlist, n * sizeof *input->pslg.segment_markers);
    }
    return input->is_edge && (input->pslg.segment_markers || !in->segmentmarkerlist) ? TRI_OK : TRI_NO_MEMORY;
}

/* Likewise, but goes on telling what it is, as far as that can be told. */
static int32_t end_of(int number, int32_t base) { return number > INT32_MIN ? number - base : number; }

/* Ends of segments. Without r those that name no point are skipped later. */
static enum tri_status take_segments(struct tri_io_input *input, const struct triangulateio *in,
                                     const struct tri_switches *switches, struct tri_error *error)
{
    int n = in->numberofsegments, base = !switches->from_zero;
    enum tri_status status = check("segments", n, in->segmentlist, error);
    if (status || n == 0)
        return status;
    int32_t *ends = make_copy(input, 2 * (size_t)n, sizeof *ends, error);
    if (!ends)
        return TRI_NO_MEMORY;
    for (size_t i = 0; i < 2 * (size_t)n; i++) {
        ends[i] = end_of(in->segmentlist[i], base);
        if ((ends[i] < 0 || ends[i] >= in->numberofpoints) && switches->mesh)
            return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "segment %d has end %d, of %d points",
                            (int)(i / 2) + base, in->segmentlist[i], in->numberofpoints);
    }
    input->pslg.n_segments = n;
    input->pslg.segments = ends;
    input->pslg.segment_markers = in->segmentmarkerlist;
    return switches->mesh ? take_loose(input, in, error) : TRI_OK;
}

static enum tri_status take_points(struct tri_io_input *input, const struct triangulateio *in, struct tri_error *error)
{
    int n = in->numberofpoints, attributes = in->numberofpointattributes;
    struct tri_pslg *pslg = &input->pslg;
    enum tri_status status = check("points", n, in->pointlist, error);
    if (!status)
        status = check("attributes of a point", attributes, in->pointattributelist, error);
    if (!status)
        status = take_reals(input, &pslg->points, in->pointlist, n, 2, error);
    if (!status && attributes > 0)
        status = take_reals(input, &pslg->attributes, in->pointattributelist, n, attributes, error);
    pslg->n_points = n;
    pslg->n_attributes = attributes;
    pslg->markers = in->pointmarkerlist;
    return status;
}

static enum tri_status take_holes(struct tri_io_input *input, const struct triangulateio *in, struct tri_error *error)
{
    enum tri_status status = check("holes", in->numberofholes, in->holelist, error);
    if (!status && in->numberofholes > 0)
        status = take_reals(input, &input->pslg.holes, in->holelist, in->numberofholes, 2, error);
    input->pslg.n_holes = in->numberofholes;
    return status;
}

static enum tri_status take_regions(struct tri_io_input *input, const struct triangulateio *in,
                                    struct tri_error *error)
{
    enum tri_status status = check("regions", in->numberofregions, in->regionlist, error);
    if (!status && in->numberofregions > 0)
        status = take_reals(input, &input->pslg.regions, in->regionlist, in->numberofregions, 4, error);
    input->pslg.n_regions = in->numberofregions;
    return status;
}

/* Corners, and the nodes amid edges apart from them. */
static enum tri_status take_nodes(struct tri_io_input *input, const struct triangulateio *in, int32_t base,
                                  struct tri_error *error)
{
    size_t n = (size_t)in->numberoftriangles, n_nodes = (size_t)in->numberofcorners;
    int32_t *corners = make_copy(input, 3 * n, sizeof *corners, error);
    int32_t *extra = corners && n_nodes > 3 ? make_copy(input, n * (n_nodes - 3), sizeof *extra, error) : NULL;
    if (!corners || (n_nodes > 3 && !extra))
        return TRI_NO_MEMORY;
    for (size_t t = 0; t < n; t++)
        for (size_t k = 0; k < n_nodes; k++)
            *(k < 3 ? &corners[3 * t + k] : &extra[(n_nodes - 3) * t + k - 3]) =
                index_of(in->trianglelist[n_nodes * t + k], base, in->numberofpoints);
    input->elements.corners = corners;
    input->elements.extra = extra;
    return TRI_OK;
}

static enum tri_status take_triangles(struct tri_io_input *input, const struct triangulateio *in,
                                      const struct tri_switches *switches, struct tri_error *error)
{
    struct tri_elements *elements = &input->elements;
    int n = in->numberoftriangles, attributes = in->numberoftriangleattributes;
    elements->n = n;
    elements->n_nodes = in->numberofcorners;
    elements->n_attributes = attributes;
    enum tri_status status = check("triangles", n, in->trianglelist, error);
    if (!status && in->numberofcorners != 3 && in->numberofcorners != 6)
        status = tri_fail(error, TRI_BAD_INPUT, NULL, 0, "triangles with %d corners", in->numberofcorners);
    if (!status)
        status = check("attributes of a triangle", attributes, in->triangleattributelist, error);
    if (!status && switches->area_lists)
        status = check("triangles, but area bounds", n, in->trianglearealist, error);
    if (!status)
        status = take_nodes(input, in, !switches->from_zero, error);
    if (!status && attributes > 0)
        status = take_reals(input, &elements->attributes, in->triangleattributelist, n, attributes, error);
    if (!status && switches->area_lists)
        status = take_reals(input, &elements->areas, in->trianglearealist, n, 1, error);
    return status;
}

enum tri_status tri_io_input_make(struct tri_io_input *input, const struct triangulateio *in,
                                  const struct tri_switches *switches, struct tri_error *error)
{
    memset(input, 0, sizeof *input);
    enum tri_status status = take_points(input, in, error);
    if (!status && switches->segments)
        status = take_segments(input, in, switches, error);
    if (!status && switches->segments && !switches->mesh)
        status = take_holes(input, in, error);
    if (!status && tri_switches_use_regions(switches))
        status = take_regions(input, in, error);
    if (!status && switches->mesh)
        status = take_triangles(input, in, switches, error);
    return status;
}

void tri_io_input_free(struct tri_io_input *input)
{
    for (int i = 0; i < input->n_copies; i++)
        free(input->copies[i]);
    memset(input, 0, sizeof *input);
}
