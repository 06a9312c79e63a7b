/* Reads the files of a mesh to check. */
#include "drivers/judge/judged_files.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/size_text.h"
#include "triangle/base/system.h"
#include "triangle/hdf5/h5_read.h"
#include "triangle/text/names.h"
#include "triangle/text/read.h"

/* Bytes of memory for each byte of text: the text, its arrays, and the memory of the checker. */
#define TEXT_SHARE 5.0
#define UNLISTED_SHARE 14.0 /* without a .poly file, if the mesh is full of holes */
#define BOUNDARY_SHARE 10.0 /* for a .poly file, if all subsegments bound the mesh */

static bool ends_in(const char *path, const char *suffix)
{
    const size_t n = strlen(path), m = strlen(suffix);
    return n > m && strcmp(path + n - m, suffix) == 0;
}

bool judged_cut_text_suffix(char *path)
{
    static const char *const suffixes[] = {".node", ".ele", ".poly"};
    for (size_t i = 0; i < sizeof suffixes / sizeof *suffixes; i++)
        if (ends_in(path, suffixes[i])) {
            path[strlen(path) - strlen(suffixes[i])] = '\0';
            return true;
        }
    return false;
}

static double size_of(const char *path)
{
    struct tri_file_facts facts;
    return path != NULL && tri_path_get_facts(path, &facts) ? (double)facts.size : 0;
}

/* Reads the text of the input into memory. */
static enum tri_status check_input_size(const struct judged_request *ask, struct tri_error *error)
{
    const double size = size_of(ask->input);
    if (size < JUDGED_WORTH_A_LOOK || size <= ask->memory)
        return TRI_OK;
    return tri_fail(error, TRI_NO_MEMORY, ask->input, 0,
                    "has %s of text, which is read into memory; %s may be used", tri_size_text(size).text,
                    tri_size_text(ask->memory).text);
}

static enum tri_status read_input(struct judged_files *f, const struct judged_request *ask, struct tri_error *error)
{
    const char *path = ask->input;
    enum tri_status fits = check_input_size(ask, error);
    if (fits != TRI_OK)
        return fits;
    struct tri_read_options options = {.default_base = f->base, .may_be_empty = true, .executor = ask->executor,
                                       .regions_if_any = (f->source.given >> TRI_CHECK_ATTRIBUTES & 1) != 0};
    int32_t base;
    bool points_in_poly;
    struct tri_names names;
    const bool is_node = ends_in(path, ".node");
    if (ends_in(path, ".geojson")) /* its polygons become the input (size_options_divide) */
        return TRI_OK;
    const size_t length = strlen(path) - (is_node || ends_in(path, ".poly") ? strlen(".poly") : 0);
    enum tri_status status = tri_names_make(&names, path, length, error);
    if (status == TRI_OK)
        status = is_node ? tri_read_node(path, &options, &f->input, &base, error)
                         : tri_read_poly(path, names.node, &options, &f->input, &base, &points_in_poly, error);
    tri_names_free(&names);
    return status;
}

static struct tri_check_source take_arrays(struct judged_files *f)
{
    static const int32_t none[2] = {0, 0};
    f->arrays = (struct tri_check_mesh){
        .n_points = f->mesh.n_points, .points = f->mesh.points,
        .n_triangles = f->elements.n, .triangles = f->elements.corners != NULL ? f->elements.corners : none,
        .n_segments = f->boundary_alone ? 0 : f->mesh.n_segments,
        .segments = f->boundary_alone ? NULL : f->mesh.segments != NULL ? f->mesh.segments : none,
        .segment_markers = f->mesh.segment_markers, .point_markers = f->mesh.markers,
        .n_attributes = f->elements.n_attributes, .attributes = f->elements.attributes,
        .n_nodes = f->mesh.n_points, .middles = f->elements.n_nodes == 6 ? f->elements.extra : NULL,
        .n_point_attributes = f->mesh.n_attributes, .point_attributes = f->mesh.attributes};
    return tri_check_source_of(&f->arrays);
}

static int64_t least_extra(const struct tri_elements *e)
{
    int64_t least = INT64_MAX;
    for (size_t i = 0; e->extra != NULL && i < (size_t)(e->n_nodes - 3) * (size_t)e->n; i++)
        least = e->extra[i] >= 0 && e->extra[i] < least ? e->extra[i] : least;
    return least;
}

/* Leaves out the midpoints of six-node triangles, which have the highest numbers. The remaining points can be corners.
 * There may be fewer than the input has (-j). */
static void leave_out_nodes(struct judged_files *f)
{
    const int64_t first_node = f->text.given != 0 ? f->text.least_middle : least_extra(&f->elements);
    int64_t n = f->input.n_points < f->n_nodes ? f->input.n_points : f->n_nodes;
    n = first_node < n ? first_node : n;
    if (f->elements.n_nodes > 3) {
        for (size_t i = 0; i < 3 * (size_t)f->elements.n; i++)
            n = f->elements.corners[i] >= n ? f->elements.corners[i] + 1 : n;
        f->arrays.n_points = (int32_t)n;
        f->source.n_points = n;
    } else if (f->source.n_points < n) { /* for points in scratch files */
        f->source.n_points = n;
    }
}

/* Returns true if the text files, with the memory for checking them, fit into this number of bytes. */
static bool fits(const char *base, double memory)
{
    enum { POLY, NODE, ELE, NEIGH, N_SUFFIXES };
    static const char *const suffixes[N_SUFFIXES] = {".poly", ".node", ".ele", ".neigh"};
    double size[N_SUFFIXES];
    for (int i = 0; i < N_SUFFIXES; i++) {
        char *path = tri_joined(base, suffixes[i]);
        size[i] = size_of(path);
        free(path);
    }
    const double share = size[POLY] > 0 ? TEXT_SHARE : UNLISTED_SHARE;
    return BOUNDARY_SHARE * size[POLY] + share * (size[NODE] + size[ELE] + size[NEIGH]) <= memory;
}

static enum tri_status read_texts(struct judged_files *f, const struct judged_request *ask,
                                  const struct judged_names *names, struct tri_error *error)
{
    const char *folder = fits(ask->base, ask->memory - TEXT_SHARE * size_of(ask->input)) ? NULL : ask->scratch;
    enum tri_status status = judged_text_read(&f->text, names, folder, ask->executor, error);
    f->source = judged_text_source(&f->text);
    f->source.memory = ask->memory;
    f->base = f->text.base;
    f->n_nodes = f->text.n_nodes;
    f->stale_neighbors = f->text.stale_neighbors;
    return status;
}

static enum tri_status read_mesh(struct judged_files *f, const struct judged_request *ask, struct tri_error *error)
{
    struct tri_names own;
    char *neigh = tri_joined(ask->base, ".neigh");
    enum tri_status status = neigh != NULL ? tri_names_make(&own, ask->base, strlen(ask->base), error)
                                           : tri_fail(error, TRI_NO_MEMORY, "", 0, "out of memory");
    if (status == TRI_OK) {
        struct judged_names names = {own.node,
                                     ask->may_lack_triangles && !tri_path_allows(own.ele, TRI_THERE) ? NULL : own.ele,
                                     tri_path_allows(own.poly, TRI_THERE) ? own.poly : NULL,
                                     tri_path_allows(neigh, TRI_THERE) ? neigh : NULL};
        status = read_texts(f, ask, &names, error);
        tri_names_free(&own);
    }
    free(neigh);
    return status;
}

/* --- an HDF5 file, in slices */

/* Reads the last attribute of each triangle. */
static enum tri_status read_attributes(const struct tri_h5 *h5, int64_t first, int64_t n, double *out,
                                       struct tri_error *error)
{
    const int64_t width = tri_h5_count(h5)->columns;
    double *rows = malloc(((size_t)n * (size_t)width + 1) * sizeof *rows);
    enum tri_status status = rows ? tri_h5_read(h5, TRI_H5_OF_TRIANGLE_ATTRIBUTES, first, n, rows, error)
                                  : tri_fail(error, TRI_NO_MEMORY, "", 0, "out of memory");
    for (int64_t i = 0; i < n && !status; i++)
        out[i] = rows[width * (i + 1) - 1];
    free(rows);
    return status;
}

static enum tri_status read_slice(void *user, enum tri_check_array array, int64_t first, int64_t n, void *out,
                                  struct tri_error *error)
{
    static const enum tri_h5_kind kinds[TRI_CHECK_N_ARRAYS] = {
        [TRI_CHECK_POINTS] = TRI_H5_OF_POINTS,
        [TRI_CHECK_CORNERS] = TRI_H5_OF_TRIANGLES,
        [TRI_CHECK_POINT_MARKERS] = TRI_H5_OF_POINT_MARKERS,
        [TRI_CHECK_SEGMENT_ENDS] = TRI_H5_OF_SEGMENTS,
        [TRI_CHECK_SEGMENT_MARKERS] = TRI_H5_OF_SEGMENT_MARKERS,
        [TRI_CHECK_POINT_ATTRIBUTES] = TRI_H5_OF_POINT_ATTRIBUTES,
    }; /* other formats have none */
    const struct tri_h5 *h5 = user;
    return array == TRI_CHECK_ATTRIBUTES ? read_attributes(h5, first, n, out, error)
                                         : tri_h5_read(h5, kinds[array], first, n, out, error);
}

static struct tri_check_source h5_source(struct tri_h5 *h5)
{
    const struct tri_h5_counts *n = tri_h5_count(h5);
    unsigned given = 1u << TRI_CHECK_POINTS | 1u << TRI_CHECK_CORNERS;
    given |= (n->columns > 0 ? 1u : 0u) << TRI_CHECK_ATTRIBUTES;
    given |= (n->point_markers ? 1u : 0u) << TRI_CHECK_POINT_MARKERS;
    given |= (n->attributes > 0 ? 1u : 0u) << TRI_CHECK_POINT_ATTRIBUTES;
    given |= (n->lists_segments ? 1u : 0u) << TRI_CHECK_SEGMENT_ENDS;
    given |= (n->lists_segments && n->segment_markers ? 1u : 0u) << TRI_CHECK_SEGMENT_MARKERS;
    return (struct tri_check_source){.n_points = n->points, .n_triangles = n->triangles, .n_segments = n->segments,
                                     .n_point_attributes = n->attributes, .given = given, .read = read_slice,
                                     .user = h5};
}

static enum tri_status open_h5(struct judged_files *f, const struct judged_request *ask, struct tri_error *error)
{
    enum tri_status status = tri_h5_open(ask->base, &f->h5, error);
    if (status != TRI_OK)
        return status;
    f->source = h5_source(f->h5);
    f->for_solvers = true;
    f->source.memory = ask->memory;
    f->n_nodes = f->source.n_points;
    return TRI_OK;
}

/* --- any format */

static bool is_h5(const struct judged_request *ask) { return !ask->is_base && tri_name_h5(ask->base) > 0; }

/* Returns the format of the file; NULL: the mesh is in HDF5 or in Triangle's files. A name such as mesh.14 is a base
 * name if mesh.14.node exists and mesh.14 does not. */
static const struct tri_format *format_of(const struct judged_request *ask)
{
    const struct tri_format *format = ask->is_base ? NULL : tri_format_of(ask->base);
    if (format == NULL || tri_path_allows(ask->base, TRI_THERE))
        return format;
    char *node = tri_joined(ask->base, ".node");
    const bool is_base = node != NULL && tri_path_allows(node, TRI_THERE);
    free(node);
    return is_base ? NULL : format;
}

/* Checks that a file that is read as a whole fits into memory, with the memory for checking it. */
static enum tri_status check_size(const char *path, double memory, struct tri_error *error)
{
    const double size = size_of(path);
    if (size < JUDGED_WORTH_A_LOOK || TEXT_SHARE * size <= memory)
        return TRI_OK;
    return tri_fail(error, TRI_NO_MEMORY, path, 0, "has %s, which are read into memory and take %s there; "
                    "%s may be used: a mesh of any size is read of .h5 and of .node, .ele and .poly",
                    tri_size_text(size).text, tri_size_text(TEXT_SHARE * size).text, tri_size_text(memory).text);
}

/* If a format stores only the boundary, the segments inside are not known. */
static enum tri_status read_format(struct judged_files *f, const struct judged_request *ask,
                                   const struct tri_format *format, struct tri_error *error)
{
    enum tri_status status = check_size(ask->base, ask->memory - TEXT_SHARE * size_of(ask->input), error);
    status = status ? status : format->read(ask->base, &f->mesh, &f->elements, ask->executor, error);
    if (status != TRI_OK)
        return status;
    f->boundary_alone = !format->inner_segments;
    f->for_solvers = true;
    f->base = format->base;
    f->n_nodes = f->mesh.n_points;
    f->source = take_arrays(f);
    return TRI_OK;
}

enum tri_status judged_read(struct judged_files *f, const struct judged_request *ask, struct tri_error *error)
{
    const struct tri_format *format = format_of(ask);
    enum tri_status status = is_h5(ask) ? open_h5(f, ask, error)
                             : format != NULL  ? read_format(f, ask, format, error)
                                               : read_mesh(f, ask, error);
    if (status == TRI_OK && ask->input != NULL)
        status = read_input(f, ask, error);
    if (status == TRI_OK)
        leave_out_nodes(f);
    f->source.scratch = ask->scratch;
    return status;
}

void judged_files_free(struct judged_files *f)
{
    tri_pslg_free(&f->mesh);
    tri_elements_free(&f->elements);
    tri_pslg_free(&f->input);
    judged_text_close(&f->text);
    tri_h5_free(f->h5);
}
