/* Reads figures from files and writes them to files. */
#include "ptriangle/files.h"

#include <stdlib.h>
#include <string.h>

#include "triangle/api/figure.h"
#include "triangle/base/system.h"
#include "triangle/text/formats.h"
#include "triangle/text/names.h"
#include "triangle/text/read.h"
#include "triangle/text/write.h"

/* --- reading */

static enum tri_status read_mesh(const struct tri_names *names, struct tri_read_options *options, struct tri_pslg *pslg,
                                 struct tri_elements *elements, struct tri_error *error)
{
    bool has_poly = tri_path_allows(names->poly, TRI_READABLE), points_in_poly;
    int32_t base;
    options->refining = true;
    enum tri_status status = has_poly ? tri_read_poly(names->poly, names->node, options, pslg, &base, &points_in_poly,
                                                      error)
                                      : tri_read_node(names->node, options, pslg, &base, error);
    status = status ? status : tri_read_ele(names->ele, options, base, pslg->n_points, elements, error);
    if (!status && tri_path_allows(names->area, TRI_READABLE))
        status = tri_read_area(names->area, options, base, elements, error);
    return status;
}

static enum tri_status read_by_ending(const char *ending, const struct tri_names *names, struct tri_pslg *pslg,
                                      struct tri_elements *elements, struct tri_error *error)
{
    struct tri_read_options options = {.default_base = 1, .regions_if_any = true};
    bool points_in_poly;
    int32_t base;
    if (strcmp(ending, ".node") == 0)
        return tri_read_node(names->node, &options, pslg, &base, error);
    if (strcmp(ending, ".ele") == 0)
        return read_mesh(names, &options, pslg, elements, error);
    return tri_read_poly(names->poly, names->node, &options, pslg, &base, &points_in_poly, error);
}

/* Moves the arrays into the figure. */
static void move_arrays(struct tri_figure *figure, struct tri_pslg *pslg, struct tri_elements *elements)
{
    struct tri_figure own = tri_no_figure();
    int32_t n = pslg->n_points, m = pslg->n_segments;
    own.points = tri_reals_of(pslg->points, n, 2);
    own.point_attributes = tri_reals_of(pslg->attributes, pslg->n_attributes > 0 ? n : 0, pslg->n_attributes);
    own.point_markers = tri_ints_of(pslg->markers, pslg->markers ? n : 0, 1);
    own.segments = tri_ints_of(pslg->segments, m, 2);
    own.segment_markers = tri_ints_of(pslg->segment_markers, pslg->segment_markers ? m : 0, 1);
    own.holes = tri_reals_of(pslg->holes, pslg->n_holes, 2);
    own.regions = tri_reals_of(pslg->regions, pslg->n_regions, 4);
    own.triangles = tri_ints_of(elements->corners, elements->n, 3);
    own.triangle_attributes = tri_reals_of(elements->attributes, elements->n_attributes > 0 ? elements->n : 0,
                                           elements->n_attributes);
    own.triangle_areas = tri_reals_of(elements->areas, elements->areas ? elements->n : 0, 1);
    free(elements->extra); /* midside nodes */
    (void)tri_api_struct_give(figure, &own, sizeof own, "tri_figure", NULL);
}

static enum tri_status read_own(const char *path, struct tri_pslg *pslg, struct tri_elements *elements,
                                struct tri_error *error)
{
    const size_t length = tri_format_base(path);
    struct tri_names names;
    if (path[length] == 0)
        return tri_fail(error, TRI_CANNOT_READ, path, 0,
                        "the file type is unknown; known types are .poly, .node, .ele, " TRI_FORMAT_SUFFIXES);
    enum tri_status status = tri_names_make(&names, path, length, error);
    status = status ? status : read_by_ending(path + length, &names, pslg, elements, error);
    tri_names_free(&names);
    return status;
}

enum tri_status tri_file_read(const char *path, struct tri_figure *figure, struct tri_error *error)
{
    const struct tri_format *format = tri_format_of(path);
    const struct tri_figure none = tri_no_figure();
    struct tri_pslg pslg = {0};
    struct tri_elements elements = {0};
    enum tri_status status = tri_api_struct_give(figure, &none, sizeof none, "tri_figure", error);
    if (status)
        return status;
    status = format ? format->read(path, &pslg, &elements, NULL, error) : read_own(path, &pslg, &elements, error);
    if (status) {
        tri_pslg_free(&pslg);
        tri_elements_free(&elements);
        return status;
    }
    move_arrays(figure, &pslg, &elements);
    return TRI_OK;
}

void tri_file_free(struct tri_figure *figure)
{
    struct tri_figure own;
    const struct tri_figure none = tri_no_figure();
    if (tri_api_struct_take(&own, sizeof own, figure, "tri_figure", NULL))
        return;
    const void *arrays[] = {own.points.at, own.point_attributes.at, own.point_markers.at, own.segments.at,
                            own.segment_markers.at, own.holes.at, own.regions.at, own.triangles.at,
                            own.triangle_attributes.at, own.triangle_areas.at};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        free((void *)arrays[i]); /* allocated by tri_file_read */
    (void)tri_api_struct_give(figure, &none, sizeof none, "tri_figure", NULL);
}

/* --- writing */

/* A figure to write and its file name. */
struct writing {
    const struct tri_api_figure *figure; /* the figure */
    const char *name;                    /* file name */
    int first;                           /* number of the first point and triangle: 0 or 1 */
    struct tri_ints middles; /* [triangles][3] midside nodes of the edges opposite each corner; n is 0 if there are
                                none */
    struct tri_output_set *set;          /* the files that are written together */
    struct tri_error *error;             /* description of a failure */
};

static enum tri_status open_file(const struct writing *w, const char *ending, struct tri_output **output)
{
    char *path = tri_name(w->name, tri_format_base(w->name), ending);
    enum tri_status status = path ? tri_output_open(w->set, path, output, w->error)
                                  : tri_fail(w->error, TRI_NO_MEMORY, w->name, 0, "out of memory for file names");
    free(path);
    return status;
}

/* Callbacks of the grid: they read the figure. */
static const struct tri_pslg *pslg_of(const void *user) { return &((const struct writing *)user)->figure->pslg; }

static const struct tri_elements *elements_of(const void *user)
{
    return &((const struct writing *)user)->figure->elements;
}

static void point(const void *user, int64_t i, struct tri_grid_point *point)
{
    const struct tri_pslg *pslg = pslg_of(user);
    *point = (struct tri_grid_point){{pslg->points[2 * i], pslg->points[2 * i + 1]},
                                     pslg->markers ? pslg->markers[i] : 0};
}

static double attribute(const void *user, int64_t i, int32_t k)
{
    const struct tri_pslg *pslg = pslg_of(user);
    return pslg->attributes[i * pslg->n_attributes + k];
}

static void triangle(const void *user, int64_t i, int64_t nodes[6])
{
    const struct tri_ints *middles = &((const struct writing *)user)->middles;
    const struct tri_elements *elements = elements_of(user);
    for (int k = 0; k < 3; k++)
        nodes[k] = elements->corners[3 * i + k];
    for (int k = 0; k < 3 && middles->n > 0; k++)
        nodes[3 + k] = middles->at[i * middles->stride + k];
}

static double column(const void *user, int64_t i, int32_t k)
{
    const struct tri_elements *elements = elements_of(user);
    return elements->attributes[i * elements->n_attributes + k];
}

static void segment(const void *user, int64_t i, struct tri_grid_edge *segment)
{
    const struct tri_pslg *pslg = pslg_of(user);
    *segment = (struct tri_grid_edge){{pslg->segments[2 * i], pslg->segments[2 * i + 1]},
                                      pslg->segment_markers ? pslg->segment_markers[i] : 0, {0}};
}

static struct tri_grid grid_of(const struct writing *w, int first)
{
    const struct tri_pslg *pslg = &w->figure->pslg;
    const struct tri_elements *elements = &w->figure->elements;
    return (struct tri_grid){.user = w, .base = first, .n_points = pslg->n_points,
                             .n_attributes = pslg->n_attributes, .n_triangles = elements->n,
                             .n_nodes = w->middles.n > 0 ? 6 : 3,
                             .n_columns = elements->n_attributes, .n_segments = pslg->n_segments, .figure = pslg,
                             .point = point, .attribute = attribute, .triangle = triangle, .column = column,
                             .segment = segment};
}

static enum tri_status write_own(const struct writing *w)
{
    struct tri_grid grid = grid_of(w, w->first);
    struct tri_output *output;
    enum tri_status status = open_file(w, ".node", &output);
    grid.has_markers = w->figure->pslg.markers != NULL;
    status = status ? status : tri_write_node(output, &grid, NULL, w->error);
    if (grid.n_triangles > 0) {
        status = status ? status : open_file(w, ".ele", &output);
        status = status ? status : tri_write_ele(output, &grid, NULL, w->error);
    }
    if (grid.n_segments > 0) {
        grid.has_markers = w->figure->pslg.segment_markers != NULL;
        status = status ? status : open_file(w, ".poly", &output);
        status = status ? status : tri_write_poly(output, &grid, NULL, w->error);
    }
    return status;
}

static enum tri_status check_numbers(const struct writing *w, const char *what, struct tri_ints rows)
{
    const int32_t n_points = w->figure->pslg.n_points;
    for (int64_t i = 0; i < rows.n; i++)
        for (int64_t k = 0; k < rows.width; k++) {
            int32_t v = rows.at[i * rows.stride + k];
            if (v < 0 || v >= n_points)
                return tri_fail(w->error, TRI_BAD_INPUT, w->name, 0,
                                "%s %lld names point %ld of %ld: numbers count from 0", what, (long long)i, (long)v,
                                (long)n_points);
        }
    return TRI_OK;
}

static enum tri_status write_export(const struct writing *w, const struct tri_format *format)
{
    const struct tri_api_figure *f = w->figure;
    struct tri_grid grid = grid_of(w, 0);
    struct tri_output *output;
    enum tri_status status = check_numbers(w, "triangle", tri_ints_of(f->elements.corners, f->elements.n, 3));
    if (w->middles.n > 0 && !format->second_order)
        return tri_fail(w->error, TRI_BAD_INPUT, w->name, 0, "%s files hold no second-order triangles", format->suffix);
    status = status ? status : check_numbers(w, "triangle", w->middles);
    status = status ? status : check_numbers(w, "segment", tri_ints_of(f->pslg.segments, f->pslg.n_segments, 2));
    status = status ? status : tri_output_open(w->set, w->name, &output, w->error);
    grid.has_markers = f->pslg.markers || f->pslg.segment_markers;
    return status ? status : format->write(output, &grid, NULL, w->error);
}

/* Checks the file name before anything else. */
static enum tri_status check_name(const char *name, struct tri_error *error)
{
    const char *missing = name[tri_format_base(name)] ? NULL : tri_format_missing(name);
    if (!missing)
        return TRI_OK;
    return tri_fail(error, TRI_BAD_INPUT, name, 0, "there is no format %.20s: there are .node, .ele and .poly, and "
                    TRI_FORMAT_SUFFIXES "; for a name with a dot add .node", missing);
}

static enum tri_status write_all(const struct writing *w)
{
    const struct tri_format *format = tri_format_of(w->name);
    tri_outputs_begin(w->set);
    enum tri_status status = format ? write_export(w, format) : write_own(w);
    status = status ? status : tri_outputs_sync(w->set, w->error);
    status = status ? status : tri_outputs_commit(w->set, w->error);
    tri_outputs_abort(w->set);
    return status;
}

/* Separates second-order triangles into corners and *middles. */
static enum tri_status split_middles(struct tri_figure *own, const struct tri_figure *figure, struct tri_ints *middles,
                                  struct tri_error *error)
{
    enum tri_status status = tri_api_struct_take(own, sizeof *own, figure, "tri_figure", error);
    *middles = (struct tri_ints){0};
    if (status || own->triangles.width != 6 || own->triangles.n <= 0 || !own->triangles.at)
        return status;
    *middles = (struct tri_ints){own->triangles.at + 3, own->triangles.n, 3, own->triangles.stride};
    own->triangles.width = 3;
    return TRI_OK;
}

enum tri_status tri_file_write(const char *name, const struct tri_figure *figure, int first, struct tri_error *error)
{
    struct tri_api_figure taken;
    struct tri_figure own;
    struct tri_ints middles;
    struct tri_output_set set;
    if (first != 0 && first != 1)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "files count from 0 or from 1, not from %d", first);
    enum tri_status status = check_name(name, error);
    if (status)
        return status;
    status = split_middles(&own, figure, &middles, error);
    if (status)
        return status;
    status = tri_api_figure_take(&taken, &own, error);
    const struct writing writing = {&taken, name, first, middles, &set, error};
    status = status ? status : write_all(&writing);
    tri_api_figure_free(&taken);
    return status;
}
