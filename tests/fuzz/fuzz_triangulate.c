/* Fuzz target: triangulate() with any switches and any arrays that its contract allows. For any content it returns.
 * After an error nothing has changed. Otherwise the output is a mesh, unless the input was a mesh, which may overlap
 * itself. */
#include <stdio.h>
#include <stdlib.h>

#include "tests/fuzz/bytes.h"
#include "triangle.h"
#include "triangle/check/check.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { MOST_POINTS = 24, MOST_SEGMENTS = 24, MOST_TRIANGLES = 24, MOST_HOLES = 3, MOST_LETTERS = 16 };

struct arrays {
    struct triangulateio in;
    double points[2 * MOST_POINTS], attributes[2 * MOST_POINTS], holes[2 * MOST_HOLES], regions[4 * MOST_HOLES];
    double triangle_attributes[MOST_TRIANGLES], areas[MOST_TRIANGLES];
    int markers[MOST_POINTS], segments[2 * MOST_SEGMENTS], segment_markers[MOST_SEGMENTS];
    int triangles[6 * MOST_TRIANGLES];
};

static void take_reals(struct bytes *b, double *to, int n, int32_t mode)
{
    for (int i = 0; i < n; i++)
        to[i] = bytes_coordinate(b, mode);
}

static void take_indices(struct bytes *b, int *to, int n, int points)
{
    for (int i = 0; i < n; i++)
        to[i] = bytes_below(b, points + 3) - 1; /* some ends refer to no point */
}

static void take_arrays(struct bytes *b, struct arrays *a)
{
    struct triangulateio *in = &a->in;
    int32_t mode = bytes_below(b, 4);
    in->numberofpoints = bytes_below(b, MOST_POINTS + 1);
    in->numberofpointattributes = bytes_below(b, 3);
    in->numberofsegments = bytes_below(b, MOST_SEGMENTS + 1);
    in->numberofholes = bytes_below(b, MOST_HOLES + 1);
    in->numberofregions = bytes_below(b, MOST_HOLES + 1);
    in->numberoftriangles = bytes_below(b, MOST_TRIANGLES + 1);
    in->numberofcorners = bytes_one(b) & 1 ? 6 : 3;
    in->numberoftriangleattributes = bytes_below(b, 2);
    take_reals(b, a->points, 2 * in->numberofpoints, mode);
    take_indices(b, a->segments, 2 * in->numberofsegments, in->numberofpoints);
    take_indices(b, a->triangles, in->numberofcorners * in->numberoftriangles, in->numberofpoints);
    take_reals(b, a->holes, 2 * in->numberofholes, mode);
    take_reals(b, a->regions, 4 * in->numberofregions, mode);
    take_reals(b, a->areas, in->numberoftriangles, mode);
    take_reals(b, a->attributes, in->numberofpointattributes * in->numberofpoints, 1);
    take_reals(b, a->triangle_attributes, in->numberoftriangleattributes * in->numberoftriangles, 1);
    take_indices(b, a->segment_markers, in->numberofsegments, 9);
    in->pointlist = a->points;
    in->pointattributelist = a->attributes;
    in->pointmarkerlist = bytes_one(b) & 1 ? a->markers : NULL;
    in->trianglelist = a->triangles;
    in->triangleattributelist = a->triangle_attributes;
    in->trianglearealist = a->areas;
    in->segmentlist = a->segments;
    in->segmentmarkerlist = bytes_one(b) & 1 ? a->segment_markers : NULL;
    in->holelist = a->holes;
    in->regionlist = a->regions;
}

/* Letters, numbers and noise, followed by a limit on points, so that each run is short. */
static void take_switches(struct bytes *b, char *to, size_t size)
{
    static const char *const words[] = {"p", "r", "q", "q20", "q30", "q33.5", "a", "a1", "a0.01", "u", "A", "c",
                                        "D", "j", "e", "v", "n", "B", "P", "N", "E", "I", "O", "z", "o2", "Y", "YY",
                                        "S7", "i", "F", "l", "s", "C", "V", "w", "W", "q.", "a-1", "q99",
                                        "-", "Q", "0"};
    *to = 0;
    for (int n = bytes_below(b, MOST_LETTERS); n > 0; n--) {
        size_t length = strlen(to);
        snprintf(to + length, size - length, "%s", words[bytes_below(b, sizeof words / sizeof *words)]);
    }
    size_t length = strlen(to);
    snprintf(to + length, size - length, "S%d", bytes_one(b));
}

static int is_large(void *user, const double *a, const double *b, const double *c, double area)
{
    (void)user, (void)a, (void)b, (void)c;
    return area > 1;
}

static void require(bool condition, const char *what, const char *switches)
{
    if (condition)
        return;
    fprintf(stderr, "fuzz_triangulate: %s; -%s\n", what, switches);
    abort();
}

static bool is_mesh_fault(int kind) { return kind <= TRI_CHECK_OVERLAP; }

/* Do all nonzero coordinates have about the same magnitude? If not, the smallest count as 0, but are returned
 * unchanged. */
static bool is_even(const struct triangulateio *out)
{
    double least = INFINITY, largest = 0;
    for (int i = 0; i < 2 * out->numberofpoints; i++) {
        double x = fabs(out->pointlist[i]);
        largest = fmax(largest, x);
        least = x > 0 ? fmin(least, x) : least;
    }
    return least >= largest * 0x1p-200;
}

/* Checks that the triangles are a mesh of the points. */
static void judge(const struct triangulateio *out, const char *switches)
{
    int32_t base = strchr(switches, 'z') ? 0 : 1, n = out->numberoftriangles;
    int32_t *corners = malloc((3 * (size_t)n + 1) * sizeof *corners);
    struct tri_check_report report;
    struct tri_error error;
    require(corners != NULL, "out of memory", switches);
    for (int32_t t = 0; t < n; t++)
        for (int k = 0; k < 3; k++)
            corners[3 * t + k] = out->trianglelist[t * out->numberofcorners + k] - base;
    struct tri_check_mesh mesh = {
        .n_points = out->numberofpoints, .points = out->pointlist, .n_triangles = n, .triangles = corners};
    struct tri_check_options options = {.delaunay = TRI_CHECK_NOT_DELAUNAY, .ignore_lost = true};
    require(tri_check(&mesh, NULL, &options, &report, &error) == TRI_OK, "the checker fails", switches);
    for (int kind = 0; kind < TRI_N_CHECKS; kind++)
        if (is_mesh_fault(kind) && report.item[kind].state == TRI_CHECK_FAILED)
            require(false, report.item[kind].text, switches);
    free(corners);
}

static void free_all(struct triangulateio *io)
{
    void *arrays[] = {io->pointlist, io->pointattributelist, io->pointmarkerlist, io->trianglelist,
                      io->triangleattributelist, io->trianglearealist, io->neighborlist, io->segmentlist,
                      io->segmentmarkerlist, io->edgelist, io->edgemarkerlist, io->normlist};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        trifree(arrays[i]); /* holes and regions belong to the input */
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct bytes b = {data, data + size};
    struct arrays a = {.markers = {0}};
    struct triangulateio out = {0}, voronoi = {0}, nothing = {0};
    char switches[160];
    take_switches(&b, switches, sizeof switches);
    struct triangulate_options options = {.unsuitable = bytes_one(&b) & 1 ? is_large : NULL, .threads = 1};
    take_arrays(&b, &a);
    int status = triangulate_with(switches, &a.in, &out, strchr(switches, 'v') ? &voronoi : NULL, &options);
    if (status != TRIANGULATE_OK) {
        require(status != TRIANGULATE_INTERNAL, "an invariant does not hold", switches);
        require(memcmp(&out, &nothing, sizeof out) == 0, "a failure leaves something", switches);
    } else if (out.pointlist && out.trianglelist && !strchr(switches, 'r') && is_even(&out)) {
        judge(&out, switches);
    }
    free_all(&out);
    free_all(&voronoi);
    return 0;
}
