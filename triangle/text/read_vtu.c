/* Reads VTK XML, unstructured grid (.vtu), as triangle/text/vtu.c writes it, and the same with arrays as text: one
 * piece, cells that are triangles or lines, z = 0.
 *
 * Of the XML head only the tags are needed: they are scanned once, and the arrays of interest are recorded. All arrays
 * are converted to doubles, which represent point numbers up to 2^31 exactly. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "triangle/text/decimal.h"
#include "triangle/text/formats.h"
#include "triangle/text/reading.h"

enum { VTK_LINE = 3, VTK_TRIANGLE = 5, VTK_QUADRATIC_TRIANGLE = 22, MOST_COMPONENTS = 1000 };

enum which {
    POINT_MARKER, POINT_ATTRIBUTES, CELL_MARKER, CELL_ATTRIBUTES, PLACES, CONNECTIVITY, OFFSETS, TYPES, ARRAYS
};

static const struct kind {
    const char *section, *name; /* NULL: any name */
    int components;             /* 0: any number */
} kinds[ARRAYS] = {
    {"PointData", "marker", 1},    {"PointData", "attributes", 0}, {"CellData", "marker", 1},
    {"CellData", "attributes", 0}, {"Points", NULL, 3},            {"Cells", "connectivity", 1},
    {"Cells", "offsets", 1},       {"Cells", "types", 1},
};

static const char *name_of(int k) { return kinds[k].name ? kinds[k].name : "of points"; }

static const struct type {
    const char *name;
    int bytes;
    bool is_real, is_signed;
} types[] = {
    {"Float64", 8, true, true},  {"Float32", 4, true, true},  {"Int64", 8, false, true}, {"UInt64", 8, false, false},
    {"Int32", 4, false, true},   {"UInt32", 4, false, false}, {"Int16", 2, false, true}, {"UInt16", 2, false, false},
    {"Int8", 1, false, true},    {"UInt8", 1, false, false},
};

/* A range of the file: a tag without its brackets, a value, or the text of an array. */
struct span {
    const char *at, *end;
};

struct array {
    bool there, appended;
    const struct type *type;
    int64_t components;
    uint64_t offset;  /* offset in the appended data */
    struct span text; /* text of an array that is not appended */
};

struct reading {
    struct tri_reading to;
    struct tri_bytes file;
    bool is_vtk;
    bool wide_sizes; /* sizes of appended arrays have 8 bytes; false: 4 */
    const char *data; /* start of the appended data; NULL: none */
    char section[16];
    int n_pieces;
    int64_t n_points, n_cells;
    struct array array[ARRAYS];
};

#define FAIL(r, ...) tri_reading_fail(&(r)->to, TRI_BAD_INPUT, 0, __VA_ARGS__)

/* --- tags */

/* Finds the next tag; skips comments and declarations. */
static bool next_tag(struct tri_bytes *file, struct span *tag)
{
    while (tri_bytes_pass(file, "<")) {
        const bool comment = tri_bytes_left(file) >= 3 && memcmp(file->at, "!--", 3) == 0;
        tag->at = file->at;
        if (!tri_bytes_pass(file, comment ? "-->" : ">"))
            return false;
        tag->end = file->at - 1;
        if (!comment && *tag->at != '?' && *tag->at != '!')
            return true;
    }
    return false;
}

static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

static bool is_tag(struct span tag, const char *name)
{
    const size_t n = strlen(name), m = (size_t)(tag.end - tag.at);
    return m >= n && memcmp(tag.at, name, n) == 0 && (m == n || is_blank(tag.at[n]) || tag.at[n] == '/');
}

/* Returns the value of name="value", or an empty span. */
static struct span value_of(struct span tag, const char *name)
{
    const size_t n = strlen(name);
    for (const char *at = tag.at; at < tag.end && (size_t)(tag.end - at) > n + 2; at++) {
        const char quote = at[n + 2];
        if (!is_blank(*at) || memcmp(at + 1, name, n) != 0 || at[n + 1] != '=' || (quote != '"' && quote != '\''))
            continue;
        const char *begin = at + n + 3, *end = memchr(begin, quote, (size_t)(tag.end - begin));
        return end ? (struct span){begin, end} : (struct span){NULL, NULL};
    }
    return (struct span){NULL, NULL};
}

static bool is_value(struct span value, const char *text)
{
    return value.at && strlen(text) == (size_t)(value.end - value.at) &&
           memcmp(value.at, text, strlen(text)) == 0;
}

/* Returns the value as a count; -1: it is not a count. */
static int64_t count_of(struct span tag, const char *name, int64_t missing)
{
    const struct span value = value_of(tag, name);
    int64_t n;
    if (!value.at)
        return missing;
    return tri_scan_integer(value.at, value.end, &n) == value.end && n >= 0 ? n : -1;
}

/* --- the head */

static bool parse_file_tag(struct reading *r, struct span tag)
{
    r->is_vtk = true;
    if (!is_value(value_of(tag, "type"), "UnstructuredGrid"))
        return FAIL(r, "not an unstructured grid");
    if (is_value(value_of(tag, "byte_order"), "BigEndian"))
        return FAIL(r, "the file is big-endian; only little-endian data are supported");
    if (value_of(tag, "compressor").at)
        return FAIL(r, "its data are compressed; only raw appended data and text are supported (meshio: binary=False)");
    r->wide_sizes = is_value(value_of(tag, "header_type"), "UInt64");
    return true;
}

static bool parse_piece_tag(struct reading *r, struct span tag)
{
    r->n_points = count_of(tag, "NumberOfPoints", -1);
    r->n_cells = count_of(tag, "NumberOfCells", -1);
    if (r->n_pieces++ > 0)
        return FAIL(r, "more than one piece is not supported");
    if (r->n_points < 0 || r->n_cells < 0)
        return FAIL(r, "the numbers of points and cells are missing");
    if (r->n_points > INT32_MAX || r->n_cells > INT32_MAX)
        return tri_reading_fail(&r->to, TRI_TOO_LARGE, 0, "too many points or cells");
    return true;
}

static const struct type *type_of(struct span tag)
{
    const struct span value = value_of(tag, "type");
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (is_value(value, types[i].name))
            return &types[i];
    return NULL;
}

/* Returns the array that the tag describes; ARRAYS: none of interest. */
static int which_array(const struct reading *r, struct span tag)
{
    int k = 0;
    while (k < ARRAYS && (strcmp(r->section, kinds[k].section) != 0 ||
                          (kinds[k].name && !is_value(value_of(tag, "Name"), kinds[k].name))))
        k++;
    return k;
}

static bool parse_array_tag(struct reading *r, struct span tag)
{
    const int k = which_array(r, tag);
    struct array array = {.there = true, .type = type_of(tag), .components = count_of(tag, "NumberOfComponents", 1)};
    const struct span format = value_of(tag, "format");
    array.appended = is_value(format, "appended");
    if (tag.end[-1] != '/') { /* its text follows */
        array.text.at = r->file.at;
        if (!tri_bytes_pass(&r->file, "<"))
            return FAIL(r, "the file ends within an array");
        array.text.end = --r->file.at;
    }
    if (k == ARRAYS)
        return true;
    if (!array.appended && !is_value(format, "ascii"))
        return FAIL(r, "its data are base64; only raw appended data and text are supported (meshio: binary=False)");
    const int64_t offset = count_of(tag, "offset", 0);
    if (!array.type || offset < 0 || array.components < 1 || array.components > MOST_COMPONENTS ||
        (kinds[k].components > 0 && array.components != kinds[k].components) || (!array.appended && !array.text.at))
        return FAIL(r, "an array has an unexpected type or size");
    array.offset = (uint64_t)offset;
    r->array[k] = array;
    return true;
}

static bool parse_data_tag(struct reading *r, struct span tag)
{
    if (!is_value(value_of(tag, "encoding"), "raw"))
        return FAIL(r, "its data are base64; only raw appended data and text are supported (meshio: binary=False)");
    if (!tri_bytes_pass(&r->file, "_"))
        return FAIL(r, "there are no data");
    r->data = r->file.at;
    return true;
}

/* Records the current section. */
static void note_section(struct reading *r, struct span tag)
{
    static const char *const sections[] = {"PointData", "CellData", "Points", "Cells"};
    const bool closing = tag.at < tag.end && *tag.at == '/';
    const struct span name = {tag.at + closing, tag.end};
    for (int i = 0; i < 4; i++)
        if (is_tag(name, sections[i]))
            snprintf(r->section, sizeof r->section, "%s", closing ? "" : sections[i]);
}

static bool parse_tag(struct reading *r, struct span tag)
{
    note_section(r, tag);
    if (is_tag(tag, "VTKFile"))
        return parse_file_tag(r, tag);
    if (is_tag(tag, "Piece"))
        return parse_piece_tag(r, tag);
    if (is_tag(tag, "DataArray"))
        return parse_array_tag(r, tag);
    return !is_tag(tag, "AppendedData") || parse_data_tag(r, tag);
}

static bool read_head(struct reading *r)
{
    struct span tag;
    while (!r->data && next_tag(&r->file, &tag))
        if (!parse_tag(r, tag))
            return false;
    if (!r->is_vtk || r->n_pieces == 0)
        return FAIL(r, "not a VTK file of an unstructured grid (.vtu)");
    for (int k = PLACES; k < ARRAYS; k++)
        if (!r->array[k].there)
            return FAIL(r, "the array %s is missing", name_of(k));
    return true;
}

/* --- arrays */

static double number_at(const struct type *type, const char *at)
{
    uint64_t bits = 0;
    for (int k = 0; k < type->bytes; k++)
        bits |= (uint64_t)(unsigned char)at[k] << (8 * k);
    if (type->is_real && type->bytes == 8)
        return tri_get_f64(at);
    if (type->is_real) {
        float value;
        const uint32_t half = (uint32_t)bits;
        memcpy(&value, &half, sizeof value);
        return value;
    }
    const int unused = 64 - 8 * type->bytes;
    if (!type->is_signed || !(bits >> (8 * type->bytes - 1) & 1))
        return (double)bits;
    return -(double)(((~bits << unused) >> unused) + 1);
}

/* Reads n numbers of appended data. Returns false if they are missing. */
static bool read_appended(const struct reading *r, const struct array *a, uint64_t n, double *out)
{
    const uint64_t head = r->wide_sizes ? 8 : 4;
    struct tri_bytes data = {NULL, r->data, r->file.end};
    if (!r->data || a->offset > tri_bytes_left(&data) || tri_bytes_left(&data) - a->offset < head)
        return false;
    data.at += a->offset;
    const uint64_t size = r->wide_sizes ? tri_get_u64(data.at) : tri_get_u32(data.at);
    data.at += head;
    if (!tri_bytes_has(&data, n, (uint64_t)a->type->bytes) || size != n * (uint64_t)a->type->bytes)
        return false;
    for (uint64_t i = 0; i < n; i++)
        out[i] = number_at(a->type, data.at + i * (uint64_t)a->type->bytes);
    return true;
}

/* The same for text. */
static bool parse_text(const struct array *a, uint64_t n, double *out)
{
    const char *at = a->text.at;
    for (uint64_t i = 0; i < n; i++) {
        while (at < a->text.end && is_blank(*at))
            at++;
        const char *behind = tri_scan_real(at, a->text.end, &out[i]);
        if (behind == at)
            return false;
        at = behind;
    }
    while (at < a->text.end && is_blank(*at))
        at++;
    return at == a->text.end;
}

static bool are_finite(const double *at, uint64_t n)
{
    uint64_t i = 0;
    while (i < n && isfinite(at[i]))
        i++;
    return i == n;
}

/* Reads the numbers of `rows` rows into an array from malloc, which belongs to the caller even after a failure. A file
 * cannot hold more numbers than bytes. */
static bool read_array(struct reading *r, enum which k, int64_t rows, double **out)
{
    const struct array *a = &r->array[k];
    const uint64_t n = (uint64_t)rows * (uint64_t)a->components;
    if (n > (uint64_t)(r->file.end - r->file.data))
        return FAIL(r, "the file is too small for its array %s", name_of(k));
    *out = malloc((n + 1) * sizeof **out);
    if (!*out)
        return tri_reading_no_memory(&r->to);
    if ((a->appended ? read_appended(r, a, n, *out) : parse_text(a, n, *out)) && are_finite(*out, n))
        return true;
    return FAIL(r, "the array %s does not have %" PRIu64 " finite numbers", name_of(k), n);
}

/* --- points */

static bool read_points(struct reading *r)
{
    if (!read_array(r, PLACES, r->n_points, &r->to.mesh->points))
        return false;
    double *places = r->to.mesh->points;
    for (int64_t i = 0; i < r->n_points; i++) {
        if (places[3 * i + 2] != 0)
            return FAIL(r, "point %" PRId64 " is not at z = 0", i);
        places[2 * i] = places[3 * i];
        places[2 * i + 1] = places[3 * i + 1];
    }
    r->to.mesh->n_points = (int32_t)r->n_points;
    return true;
}

/* Reads an array of 32-bit integers. */
static bool read_markers(struct reading *r, enum which k, int64_t rows, int32_t **out)
{
    double *values = NULL;
    bool good = read_array(r, k, rows, &values);
    *out = malloc(((size_t)rows + 1) * sizeof **out);
    good = good && (*out || tri_reading_no_memory(&r->to));
    for (int64_t i = 0; i < rows && good; i++) {
        good = values[i] >= INT32_MIN && values[i] <= INT32_MAX;
        if (good)
            (*out)[i] = (int32_t)values[i];
        else
            (void)FAIL(r, "a marker does not fit into 32 bits");
    }
    free(values);
    return good;
}

static bool read_point_data(struct reading *r)
{
    if (r->array[POINT_MARKER].there && !read_markers(r, POINT_MARKER, r->n_points, &r->to.mesh->markers))
        return false;
    if (!r->array[POINT_ATTRIBUTES].there)
        return true;
    r->to.mesh->n_attributes = (int32_t)r->array[POINT_ATTRIBUTES].components;
    return read_array(r, POINT_ATTRIBUTES, r->n_points, &r->to.mesh->attributes);
}

/* --- cells: all arrays are converted to doubles */

struct cells {
    double *type, *end, *node;
    int64_t n_nodes;     /* total number */
    int n_of_a_triangle; /* nodes of each triangle: 3 or 6 */
};

static int nodes_of(double type)
{
    return type == VTK_LINE ? 2 : type == VTK_TRIANGLE ? 3 : type == VTK_QUADRATIC_TRIANGLE ? 6 : 0;
}

static bool check_cells(struct reading *r, struct cells *c, int64_t *triangles)
{
    double end = 0;
    for (int64_t i = 0; i < r->n_cells; i++) {
        const int n = nodes_of(c->type[i]);
        end += n;
        if (n == 0)
            return FAIL(r, "cell %" PRId64 " is of type %g: neither triangle nor line", i, c->type[i]);
        if (c->end[i] != end)
            return FAIL(r, "cell %" PRId64 " does not have %d points", i, n);
        if (n > 2 && c->n_of_a_triangle != n && *triangles > 0)
            return FAIL(r, "the mesh has triangles of three nodes and of six nodes");
        c->n_of_a_triangle = n > 2 ? n : c->n_of_a_triangle;
        *triangles += n > 2;
    }
    c->n_nodes = (int64_t)end;
    return true;
}

static bool check_nodes(struct reading *r, const struct cells *c)
{
    for (int64_t i = 0; i < c->n_nodes; i++)
        if (!(c->node[i] >= 0 && c->node[i] < (double)r->n_points))
            return FAIL(r, "a cell refers to point %g of %" PRId64, c->node[i], r->n_points);
    return true;
}

/* VTK orders the midpoints of edges along the boundary of the triangle; Triangle orders them by opposite corners. */
static void put_cells(struct reading *r, const struct cells *c)
{
    static const int opposite[] = {2, 0, 1};
    struct tri_elements *e = r->to.elements;
    const double *node = c->node;
    size_t t = 0, s = 0;
    for (int64_t i = 0; i < r->n_cells; i++) {
        const int n = nodes_of(c->type[i]);
        for (int k = 0; k < 3 && n > 2; k++) {
            e->corners[3 * t + (size_t)k] = (int32_t)node[k];
            if (n == 6)
                e->extra[3 * t + (size_t)opposite[k]] = (int32_t)node[3 + k];
        }
        for (size_t k = 0; k < 2 && n == 2; k++)
            r->to.mesh->segments[2 * s + k] = (int32_t)node[k];
        t += n > 2;
        s += n == 2;
        node += n;
    }
}

/* Moves the rows of triangles to the front, in place. */
static bool read_cell_attributes(struct reading *r, const struct cells *c)
{
    const size_t width = (size_t)r->array[CELL_ATTRIBUTES].components;
    size_t t = 0;
    if (!read_array(r, CELL_ATTRIBUTES, r->n_cells, &r->to.elements->attributes))
        return false;
    for (int64_t i = 0; i < r->n_cells; i++)
        if (nodes_of(c->type[i]) > 2)
            memmove(r->to.elements->attributes + width * t++, r->to.elements->attributes + width * (size_t)i,
                    width * sizeof(double));
    r->to.elements->n_attributes = (int32_t)width;
    return true;
}

static bool read_segment_markers(struct reading *r, const struct cells *c)
{
    size_t s = 0;
    if (!read_markers(r, CELL_MARKER, r->n_cells, &r->to.mesh->segment_markers))
        return false;
    for (int64_t i = 0; i < r->n_cells; i++)
        if (nodes_of(c->type[i]) == 2)
            r->to.mesh->segment_markers[s++] = r->to.mesh->segment_markers[i];
    return true;
}

static bool read_cells(struct reading *r)
{
    struct cells c = {.n_of_a_triangle = 3};
    int64_t triangles = 0;
    bool good = read_array(r, TYPES, r->n_cells, &c.type) && read_array(r, OFFSETS, r->n_cells, &c.end) &&
                check_cells(r, &c, &triangles) && read_array(r, CONNECTIVITY, c.n_nodes, &c.node) &&
                check_nodes(r, &c) && tri_reading_triangles(&r->to, triangles, c.n_of_a_triangle) &&
                tri_reading_segments(&r->to, r->n_cells - triangles);
    if (good)
        put_cells(r, &c);
    good = good && (!r->array[CELL_ATTRIBUTES].there || read_cell_attributes(r, &c)) &&
           (!r->array[CELL_MARKER].there || read_segment_markers(r, &c));
    free(c.type);
    free(c.end);
    free(c.node);
    return good;
}

enum tri_status tri_read_vtu(const char *path, struct tri_pslg *mesh, struct tri_elements *elements,
                             const struct tri_executor *executor, struct tri_error *error)
{
    struct reading r = {.to = {path, executor, mesh, elements, error, TRI_OK}};
    r.to.status = tri_bytes_load(&r.file, path, error);
    (void)(!r.to.status && read_head(&r) && read_points(&r) && read_point_data(&r) && read_cells(&r));
    tri_bytes_free(&r.file);
    return r.to.status;
}
