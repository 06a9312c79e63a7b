/* Writes VTK XML, unstructured grid (.vtu): an XML head that describes arrays, followed by their bytes.
 *
 * The data are appended raw: each array is its size in bytes (UInt64) and then the bytes; the head gives the offset of
 * each. All sizes follow from the numbers of points and cells, so the head is written first, and the rest in pieces of
 * any size. Cells are the triangles, followed by the segments as lines. (VTK User's Guide; "VTK XML formats",
 * docs.vtk.org.) */
#include <assert.h>
#include <inttypes.h>
#include <stdio.h>

#include "triangle/text/binary.h"
#include "triangle/text/formats.h"

enum { VTK_LINE = 3, VTK_TRIANGLE = 5, VTK_QUADRATIC_TRIANGLE = 22 };
enum { MOST_ARRAYS = 8, HEAD_BYTES = 4096 };

/* An array describes points or cells. Arrays of cells list the triangles first, then the segments. Rows of segments are
 * not longer than rows of triangles. */
struct array {
    const char *section, *type, *name;
    int32_t components;
    int64_t n[2];    /* number of rows: [0] of points or triangles, [1] of segments */
    size_t bytes[2]; /* bytes of a row of each kind */
    tri_row_call *row;
};

struct vtu {
    const struct tri_grid *grid;
    bool wide; /* 64-bit indices */
    int n_arrays;
    struct array arrays[MOST_ARRAYS]; /* grouped by section */
};

/* --- rows of points */

static struct tri_grid_point point_at(const struct vtu *v, int64_t i)
{
    struct tri_grid_point point;
    v->grid->point(v->grid->user, i, &point);
    return point;
}

static char *marker_row(const void *user, int64_t i, char *at) { return tri_put_i32(at, point_at(user, i).marker); }

static char *attributes_row(const void *user, int64_t i, char *at)
{
    const struct vtu *v = user;
    for (int32_t k = 0; k < v->grid->n_attributes; k++)
        at = tri_put_f64(at, v->grid->attribute(v->grid->user, i, k));
    return at;
}

static char *place_row(const void *user, int64_t i, char *at)
{
    const struct tri_grid_point point = point_at(user, i);
    return tri_put_f64(tri_put_f64(tri_put_f64(at, point.at[0]), point.at[1]), 0);
}

/* --- rows of cells */

/* Is cell i a segment? If so, reads it. */
static bool get_segment(const struct vtu *v, int64_t i, struct tri_grid_edge *segment)
{
    const bool is_segment = i >= v->grid->n_triangles;
    if (is_segment)
        v->grid->segment(v->grid->user, i - v->grid->n_triangles, segment);
    return is_segment;
}

static char *cell_marker_row(const void *user, int64_t i, char *at)
{
    struct tri_grid_edge segment;
    return tri_put_i32(at, get_segment(user, i, &segment) ? segment.marker : 0);
}

static char *columns_row(const void *user, int64_t i, char *at)
{
    const struct tri_grid *g = ((const struct vtu *)user)->grid;
    for (int32_t k = 0; k < g->n_columns; k++)
        at = tri_put_f64(at, i < g->n_triangles ? g->column(g->user, i, k) : 0);
    return at;
}

static char *put_index(char *at, const struct vtu *v, int64_t index)
{
    return v->wide ? tri_put_i64(at, index) : tri_put_i32(at, (int32_t)index);
}

/* VTK orders the midpoints of edges by edges: first to second corner, second to third, third to first. */
static char *nodes_row(const void *user, int64_t i, char *at)
{
    static const int order[6] = {0, 1, 2, 5, 3, 4};
    const struct vtu *v = user;
    struct tri_grid_edge segment;
    int64_t nodes[6];
    if (get_segment(v, i, &segment))
        return put_index(put_index(at, v, segment.ends[0]), v, segment.ends[1]);
    v->grid->triangle(v->grid->user, i, nodes);
    for (int k = 0; k < v->grid->n_nodes; k++)
        at = put_index(at, v, nodes[order[k]]);
    return at;
}

/* Stores the end of the cell's nodes in the connectivity array. */
static char *end_row(const void *user, int64_t i, char *at)
{
    const struct vtu *v = user;
    const int64_t m = v->grid->n_triangles, n_nodes = v->grid->n_nodes;
    return put_index(at, v, i < m ? n_nodes * (i + 1) : n_nodes * m + 2 * (i - m + 1));
}

static char *type_row(const void *user, int64_t i, char *at)
{
    const struct tri_grid *g = ((const struct vtu *)user)->grid;
    *at = i >= g->n_triangles ? VTK_LINE : g->n_nodes == 6 ? VTK_QUADRATIC_TRIANGLE : VTK_TRIANGLE;
    return at + 1;
}

/* --- arrays */

static void add_array(struct vtu *v, struct array array)
{
    assert(v->n_arrays < MOST_ARRAYS);
    v->arrays[v->n_arrays++] = array;
}

static void list_arrays(struct vtu *v)
{
    const struct tri_grid *g = v->grid;
    const int64_t n = g->n_points, m = g->n_triangles, s = g->n_segments;
    const char *index = v->wide ? "Int64" : "Int32";
    const size_t wide = v->wide ? 8 : 4, attributes = 8 * (size_t)g->n_attributes, columns = 8 * (size_t)g->n_columns;
    if (g->has_markers)
        add_array(v, (struct array){"PointData", "Int32", "marker", 1, {n}, {4}, marker_row});
    if (g->n_attributes > 0)
        add_array(v, (struct array){"PointData", "Float64", "attributes", g->n_attributes, {n}, {attributes},
                                    attributes_row});
    if (g->has_markers)
        add_array(v, (struct array){"CellData", "Int32", "marker", 1, {m, s}, {4, 4}, cell_marker_row});
    if (g->n_columns > 0)
        add_array(v, (struct array){"CellData", "Float64", "attributes", g->n_columns, {m, s}, {columns, columns},
                                    columns_row});
    add_array(v, (struct array){"Points", "Float64", "points", 3, {n}, {24}, place_row});
    add_array(v, (struct array){"Cells", index, "connectivity", 1, {m, s}, {wide * (size_t)g->n_nodes, 2 * wide},
                                nodes_row});
    add_array(v, (struct array){"Cells", index, "offsets", 1, {m, s}, {wide, wide}, end_row});
    add_array(v, (struct array){"Cells", "UInt8", "types", 1, {m, s}, {1, 1}, type_row});
}

static uint64_t bytes_of(const struct array *array)
{
    return (uint64_t)array->n[0] * array->bytes[0] + (uint64_t)array->n[1] * array->bytes[1];
}

/* --- the file */

static enum tri_status write_head(struct tri_output *output, const struct vtu *v, struct tri_error *error)
{
    char head[HEAD_BYTES];
    uint64_t offset = 0;
    const char *section = "";
    int n = snprintf(head, sizeof head,
                     "<?xml version=\"1.0\"?>\n"
                     "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\""
                     " header_type=\"UInt64\">\n<UnstructuredGrid>\n"
                     "<Piece NumberOfPoints=\"%" PRId64 "\" NumberOfCells=\"%" PRId64 "\">\n",
                     v->grid->n_points, v->grid->n_triangles + v->grid->n_segments);
    for (int i = 0; i < v->n_arrays; i++) {
        const struct array *a = &v->arrays[i];
        if (strcmp(section, a->section) != 0)
            n += snprintf(head + n, sizeof head - (size_t)n, *section ? "</%s>\n<%s>\n" : "%s<%s>\n", section,
                          a->section);
        section = a->section;
        n += snprintf(head + n, sizeof head - (size_t)n,
                      "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%" PRId32
                      "\" format=\"appended\" offset=\"%" PRIu64 "\"/>\n",
                      a->type, a->name, a->components, offset);
        offset += 8 + bytes_of(a);
    }
    n += snprintf(head + n, sizeof head - (size_t)n,
                  "</%s>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_", section);
    assert((size_t)n < sizeof head);
    return tri_output_write(output, head, (size_t)n, error);
}

static enum tri_status write_array(struct tri_output *output, const struct vtu *v, const struct array *array,
                                   const struct tri_executor *executor, struct tri_error *error)
{
    char size[8], *end = tri_put_u64(size, bytes_of(array));
    enum tri_status status = tri_output_write(output, size, (size_t)(end - size), error);
    const int64_t n = array->n[0] + array->n[1];
    return status ? status : tri_write_table(output, 0, n, array->bytes[0], array->row, v, executor, error);
}

enum tri_status tri_write_vtu(struct tri_output *output, const struct tri_grid *grid,
                              const struct tri_executor *executor, struct tri_error *error)
{
    static const char tail[] = "\n</AppendedData>\n</VTKFile>\n";
    struct vtu v = {.grid = grid};
    v.wide = grid->n_nodes * grid->n_triangles + 2 * grid->n_segments > INT32_MAX || grid->n_points > INT32_MAX;
    list_arrays(&v);
    enum tri_status status = write_head(output, &v, error);
    for (int i = 0; i < v.n_arrays && !status; i++)
        status = write_array(output, &v, &v.arrays[i], executor, error);
    return status ? status : tri_output_write(output, tail, sizeof tail - 1, error);
}
