/* VTK XML, unstructured grid (.vtu): an XML head that names arrays, and behind it their bytes.
 *
 * The data are appended raw: each array is its size in bytes (UInt64) and then the bytes; the head gives the place of
 * each. All sizes follow from the numbers of points and cells, so that the head is written first and the rest in any
 * pieces. Cells are the triangles and then the segments, as lines. (VTK User's Guide; "VTK XML formats",
 * docs.vtk.org.) */
#include <assert.h>
#include <inttypes.h>
#include <stdio.h>

#include "triangle/text/binary.h"
#include "triangle/text/formats.h"

enum { VTK_LINE = 3, VTK_TRIANGLE = 5, VTK_QUADRATIC_TRIANGLE = 22 };
enum { MOST_ARRAYS = 8, HEAD_BYTES = 4096 };

typedef char *row_call(void *user, size_t i, char *at);

/* Rows of the same size; cells have two kinds of them. */
struct rows {
    int64_t n;
    size_t bytes;
    row_call *row;
};

struct array {
    const char *section, *type, *name;
    int32_t components;
    struct rows rows[2]; /* one after the other */
};

struct vtu {
    const struct tri_grid *grid;
    bool wide; /* indices of 64 bits */
    size_t row_bytes; /* of what is written */
    int n_arrays;
    struct array arrays[MOST_ARRAYS]; /* those of a section together */
};

/* --- rows */

static char *marker_row(void *user, size_t i, char *at)
{
    const struct vtu *v = user;
    struct tri_grid_point point;
    v->grid->point(v->grid->user, (int64_t)i, &point);
    return tri_put_i32(at, point.marker);
}

static char *attributes_row(void *user, size_t i, char *at)
{
    const struct vtu *v = user;
    for (int32_t k = 0; k < v->grid->n_attributes; k++)
        at = tri_put_f64(at, v->grid->attribute(v->grid->user, (int64_t)i, k));
    return at;
}

static char *segment_marker_row(void *user, size_t i, char *at)
{
    const struct vtu *v = user;
    struct tri_grid_edge segment;
    v->grid->segment(v->grid->user, (int64_t)i, &segment);
    return tri_put_i32(at, segment.marker);
}

static char *columns_row(void *user, size_t i, char *at)
{
    const struct vtu *v = user;
    for (int32_t k = 0; k < v->grid->n_columns; k++)
        at = tri_put_f64(at, v->grid->column(v->grid->user, (int64_t)i, k));
    return at;
}

static char *zero_row(void *user, size_t i, char *at)
{
    const struct vtu *v = user;
    (void)i;
    memset(at, 0, v->row_bytes);
    return at + v->row_bytes;
}

static char *place_row(void *user, size_t i, char *at)
{
    const struct vtu *v = user;
    struct tri_grid_point point;
    v->grid->point(v->grid->user, (int64_t)i, &point);
    return tri_put_f64(tri_put_f64(tri_put_f64(at, point.at[0]), point.at[1]), 0);
}

static char *put_index(char *at, const struct vtu *v, int64_t index)
{
    return v->wide ? tri_put_i64(at, index) : tri_put_i32(at, (int32_t)index);
}

/* VTK has the nodes amid edges in the order of the edges from corner to corner. */
static char *triangle_row(void *user, size_t i, char *at)
{
    static const int order[6] = {0, 1, 2, 5, 3, 4};
    const struct vtu *v = user;
    int64_t nodes[6];
    v->grid->triangle(v->grid->user, (int64_t)i, nodes);
    for (int k = 0; k < v->grid->n_nodes; k++)
        at = put_index(at, v, nodes[order[k]]);
    return at;
}

static char *segment_row(void *user, size_t i, char *at)
{
    const struct vtu *v = user;
    struct tri_grid_edge segment;
    v->grid->segment(v->grid->user, (int64_t)i, &segment);
    return put_index(put_index(at, v, segment.ends[0]), v, segment.ends[1]);
}

/* Where the list of a cell's nodes ends. */
static char *triangle_end_row(void *user, size_t i, char *at)
{
    const struct vtu *v = user;
    return put_index(at, v, v->grid->n_nodes * ((int64_t)i + 1));
}

static char *segment_end_row(void *user, size_t i, char *at)
{
    const struct vtu *v = user;
    return put_index(at, v, v->grid->n_nodes * v->grid->n_triangles + 2 * ((int64_t)i + 1));
}

static char *triangle_type_row(void *user, size_t i, char *at)
{
    const struct vtu *v = user;
    (void)i;
    *at = v->grid->n_nodes == 6 ? VTK_QUADRATIC_TRIANGLE : VTK_TRIANGLE;
    return at + 1;
}

static char *segment_type_row(void *user, size_t i, char *at)
{
    (void)user, (void)i;
    *at = VTK_LINE;
    return at + 1;
}

/* --- arrays */

static void add(struct vtu *v, const char *section, const char *type, const char *name, int32_t components,
                struct rows first, struct rows second)
{
    assert(v->n_arrays < MOST_ARRAYS);
    v->arrays[v->n_arrays++] = (struct array){section, type, name, components, {first, second}};
}

static void list_arrays(struct vtu *v)
{
    const struct tri_grid *g = v->grid;
    const int64_t points = g->n_points, triangles = g->n_triangles, segments = g->n_segments;
    const char *index = v->wide ? "Int64" : "Int32";
    const struct rows none = {0, 1, NULL};
    const size_t index_bytes = v->wide ? 8 : 4, attributes = 8 * (size_t)g->n_attributes,
                 columns = 8 * (size_t)g->n_columns;
    if (g->has_markers)
        add(v, "PointData", "Int32", "marker", 1, (struct rows){points, 4, marker_row}, none);
    if (g->n_attributes > 0)
        add(v, "PointData", "Float64", "attributes", g->n_attributes,
            (struct rows){points, attributes, attributes_row}, none);
    if (g->has_markers)
        add(v, "CellData", "Int32", "marker", 1, (struct rows){triangles, 4, zero_row},
            (struct rows){segments, 4, segment_marker_row});
    if (g->n_columns > 0)
        add(v, "CellData", "Float64", "attributes", g->n_columns, (struct rows){triangles, columns, columns_row},
            (struct rows){segments, columns, zero_row});
    add(v, "Points", "Float64", "points", 3, (struct rows){points, 24, place_row}, none);
    add(v, "Cells", index, "connectivity", 1,
        (struct rows){triangles, index_bytes * (size_t)g->n_nodes, triangle_row},
        (struct rows){segments, 2 * index_bytes, segment_row});
    add(v, "Cells", index, "offsets", 1, (struct rows){triangles, index_bytes, triangle_end_row},
        (struct rows){segments, index_bytes, segment_end_row});
    add(v, "Cells", "UInt8", "types", 1, (struct rows){triangles, 1, triangle_type_row},
        (struct rows){segments, 1, segment_type_row});
}

static uint64_t bytes_of(const struct array *array)
{
    return (uint64_t)array->rows[0].n * array->rows[0].bytes + (uint64_t)array->rows[1].n * array->rows[1].bytes;
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

static enum tri_status write_array(struct tri_output *output, struct vtu *v, const struct array *array,
                                   const struct tri_executor *executor, struct tri_error *error)
{
    char size[8];
    enum tri_status status = tri_output_write(output, size, (size_t)(tri_put_u64(size, bytes_of(array)) - size), error);
    for (int k = 0; k < 2 && !status; k++) {
        const struct rows *rows = &array->rows[k];
        v->row_bytes = rows->bytes;
        status = tri_write_table(output, (size_t)rows->n, rows->bytes, rows->row, v, executor, error);
    }
    return status;
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
