/* The functions that the WebAssembly module exports. Figures are read from files in memory; meshes are returned as
 * arrays or as files.
 *
 * One figure, one mesh and one error exist at a time; each call replaces them. web/src/mesher.ts is the only caller. No
 * caller depends on the layout of structs, because each number has its own function. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ptriangle/files.h"
#include "ptriangle/tri.h"
#include "triangle/base/status.h"
#include "triangle/base/system.h"
#include "web/c/system_memory.h"

#define EXPORT(name) __attribute__((export_name(#name))) name

/* Defined by the host: receives the progress of a run, 0 to 1, and the number of triangles. */
__attribute__((import_module("host"), import_name("progress"))) void web_progress(double done, double triangles);

static struct tri_figure figure;
static struct tri_mesh *mesh;
static struct tri_error error;

/* --- files */

void *EXPORT(web_file)(const char *name, size_t size) { return tri_memory_file(name, size); }

const void *EXPORT(web_file_bytes)(const char *name)
{
    size_t size;
    return tri_memory_file_bytes(name, &size);
}

size_t EXPORT(web_file_size)(const char *name)
{
    size_t size;
    (void)tri_memory_file_bytes(name, &size);
    return size;
}

void EXPORT(web_file_remove)(const char *name) { (void)tri_path_remove(name); }

/* --- the figure and the mesh */

/* Reads the figure from a file in memory. The ending of its name selects the format. */
int EXPORT(web_read)(const char *name)
{
    if (figure.size)
        tri_file_free(&figure);
    tri_mesh_delete(mesh);
    mesh = NULL;
    error = (struct tri_error){0};
    figure = tri_no_figure();
    return tri_file_read(name, &figure, &error);
}

static int compare_markers(const void *a, const void *b)
{
    const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

/* Returns the markers of segments, with 0 replaced by 1, the marker of boundary segments, because a size field cannot
 * refer to marker 0. NULL: no memory. */
static int32_t *named_markers(void)
{
    int32_t *markers = malloc(((size_t)figure.segments.n + 1) * sizeof *markers);
    for (int64_t i = 0; markers && i < figure.segments.n; i++) {
        const struct tri_ints *given = &figure.segment_markers;
        markers[i] = i < given->n && given->at[i * given->stride] != 0 ? given->at[i * given->stride] : 1;
    }
    return markers;
}

/* Returns one size field with this length for each of the markers. NULL: no memory. */
static struct tri_size_field *fields_near(const int32_t *markers, double length, double growth, int64_t *n)
{
    const size_t n_segments = (size_t)figure.segments.n;
    int32_t *sorted = malloc((n_segments + 1) * sizeof *sorted);
    struct tri_size_field *fields = calloc(n_segments + 1, sizeof *fields);
    *n = 0;
    if (sorted && fields) {
        memcpy(sorted, markers, n_segments * sizeof *sorted);
        qsort(sorted, n_segments, sizeof *sorted, compare_markers);
        for (size_t i = 0; i < n_segments; i++)
            if (i == 0 || sorted[i] != sorted[i - 1])
                fields[(*n)++] = (struct tri_size_field){.kind = TRI_SIZE_NEAR, .length = length, .growth = growth,
                                                         .marker = sorted[i]};
    }
    free(sorted);
    return fields;
}

static void tell_progress(void *user, double done, int64_t triangles)
{
    (void)user;
    web_progress(done, (double)triangles);
}

enum { CONFORMING = 1, PROTECT = 2, EVEN_ODD = 4, REGION_AREAS = 8 };

/* markers: of the segments; NULL: those of the figure */
static int make_mesh(const struct tri_settings *settings, const int32_t *markers, int flags)
{
    struct tri_figure given = figure;
    double *regions = NULL;
    if (markers)
        given.segment_markers = tri_ints_of(markers, figure.segments.n, 1);
    if (!(flags & REGION_AREAS) && figure.regions.n > 0) { /* area bounds of regions do not apply */
        regions = malloc((size_t)figure.regions.n * 4 * sizeof *regions);
        for (int64_t i = 0; regions && i < figure.regions.n; i++) {
            memcpy(regions + 4 * i, figure.regions.at + i * figure.regions.stride, 3 * sizeof *regions);
            regions[4 * i + 3] = 0;
        }
        given.regions = tri_reals_of(regions, regions ? figure.regions.n : 0, 4);
    }
    const int status = tri_mesh_new(&mesh, &given, settings, &error);
    free(regions);
    return status;
}

/* Meshes the figure. A bound of 0 means no bound. size: the edge length; it applies everywhere if growth is 0.
 * Otherwise it applies on all segments, and grows by `growth` per unit of distance from them. */
int EXPORT(web_mesh)(double min_angle, double max_area, double size, double growth, int flags)
{
    struct tri_settings settings = tri_no_settings();
    struct tri_size_field everywhere = {.kind = TRI_SIZE_NUMBER, .length = size}, *near = NULL;
    int32_t *markers = NULL;
    tri_mesh_delete(mesh);
    mesh = NULL;
    error = (struct tri_error){0};
    settings.min_angle = min_angle;
    settings.max_area = max_area;
    settings.conforming = flags & CONFORMING;
    settings.protect = flags & PROTECT ? 1 : 0;
    settings.even_odd = flags & EVEN_ODD;
    settings.progress = tell_progress;
    if (size > 0 && growth > 0 && figure.segments.n > 0) {
        settings.gradation = growth;
        markers = named_markers();
        settings.sizes = near = markers ? fields_near(markers, size, growth, &settings.n_sizes) : NULL;
    } else if (size > 0) {
        settings.sizes = &everywhere;
        settings.n_sizes = 1;
    }
    const int status = make_mesh(&settings, markers, flags);
    free(near);
    free(markers);
    return status;
}

/* Returns the number of triangles that violate this angle bound for this reason (enum tri_reason). */
int EXPORT(web_unmet)(double min_angle, int flags, int reason)
{
    struct tri_settings settings = tri_no_settings();
    int64_t by_reason[TRI_REASONS] = {0};
    settings.min_angle = min_angle;
    settings.conforming = flags & CONFORMING;
    settings.protect = flags & PROTECT ? 1 : 0;
    return mesh && tri_mesh_count_bad(mesh, &settings, by_reason, TRI_REASONS) > 0 ? (int)by_reason[reason] : 0;
}

/* Writes the mesh, with the holes and regions of the figure, into files in memory, like tri_file_write. */
int EXPORT(web_write)(const char *name, int first)
{
    struct tri_figure out = tri_no_figure();
    if (!mesh)
        return tri_fail(&error, TRI_BAD_INPUT, NULL, 0, "there is no mesh to write");
    tri_mesh_figure(mesh, &out);
    out.holes = figure.holes;
    out.regions = figure.regions;
    error = (struct tri_error){0};
    return tri_file_write(name, &out, first, &error);
}

const char *EXPORT(web_error_text)(void) { return error.text; }
long EXPORT(web_error_line)(void) { return error.line; }
const char *EXPORT(web_notes)(void) { return mesh ? tri_mesh_notes(mesh) : ""; }
const char *EXPORT(web_version)(void) { return tri_version(); }

/* --- arrays: row i begins at web_rows(what) + i * web_rows_stride(what) numbers */

enum {
    POINTS,
    POINT_MARKERS,
    TRIANGLES,
    TRIANGLE_ATTRIBUTES,
    SEGMENTS,
    SEGMENT_MARKERS,
    FIGURE_POINTS,
    FIGURE_SEGMENTS
};

struct rows {
    const void *at;        /* NULL if n is 0 */
    int64_t n;
    int64_t width, stride; /* numbers */
};

static struct rows of_reals(struct tri_reals r) { return (struct rows){r.at, r.n, r.width, r.stride}; }
static struct rows of_ints(struct tri_ints r) { return (struct rows){r.at, r.n, r.width, r.stride}; }

static struct rows rows_of(int what)
{
    if (!mesh && what < FIGURE_POINTS)
        return (struct rows){0};
    switch (what) {
    case POINTS: return of_reals(tri_mesh_points(mesh));
    case POINT_MARKERS: return of_ints(tri_mesh_point_markers(mesh));
    case TRIANGLES: return of_ints(tri_mesh_triangles(mesh));
    case TRIANGLE_ATTRIBUTES: return of_reals(tri_mesh_triangle_attributes(mesh));
    case SEGMENTS: return of_ints(tri_mesh_segments(mesh));
    case SEGMENT_MARKERS: return of_ints(tri_mesh_segment_markers(mesh));
    case FIGURE_POINTS: return of_reals(figure.points);
    default: return of_ints(figure.segments);
    }
}

const void *EXPORT(web_rows)(int what) { return rows_of(what).at; }
int EXPORT(web_rows_n)(int what) { return (int)rows_of(what).n; }
int EXPORT(web_rows_width)(int what) { return (int)rows_of(what).width; }
int EXPORT(web_rows_stride)(int what) { return (int)rows_of(what).stride; }
