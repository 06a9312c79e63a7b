/* Reads Gmsh's format 4.1, binary (.msh), as triangle/text/gmsh.c writes it, including parts: nodes, triangles, lines,
 * and the data that gmsh.c writes, "marker", "attribute_0" and so on. Other sections are skipped. Nodes and elements
 * keep the order of the file. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "triangle/text/decimal.h"
#include "triangle/text/formats.h"
#include "triangle/text/reading.h"

enum { GMSH_LINE = 1, GMSH_TRIANGLE = 2, GMSH_QUADRATIC_TRIANGLE = 9, GMSH_POINT = 15 };
enum { DATUM_BYTES = 12, MOST_NAME = 32, MOST_ATTRIBUTES = 1000 };

struct reading {
    struct tri_reading to;
    struct tri_bytes file;
    bool has_format, has_nodes, has_elements;
    bool any_data; /* use the first data at nodes as an attribute, regardless of their name */
    struct tri_tags nodes, triangles, segments;
    int64_t n_elements;      /* number of elements of any type */
    int64_t n_triangles, n_segments; /* number read so far */
};

/* A data section: a tag and a number for each node or each element. */
struct data {
    char name[MOST_NAME];
    bool of_nodes;
    int64_t n;
    const char *at; /* [n] of DATUM_BYTES */
};

#define FAIL(r, ...) tri_reading_fail(&(r)->to, TRI_BAD_INPUT, 0, __VA_ARGS__)

static bool ends_early(struct reading *r, const char *section)
{
    return FAIL(r, "the section $%s is not complete", section);
}

static bool is_line(const char *line, size_t length, const char *text)
{
    return strlen(text) == length && memcmp(line, text, length) == 0;
}

/* --- heads */

static bool read_format(struct reading *r)
{
    const char *line;
    size_t n;
    if (!tri_bytes_line(&r->file, &line, &n) || !is_line(line, n, "4.1 1 8"))
        return FAIL(r, "not a binary file of version 4.1; Gmsh writes these with -format msh41 -bin");
    if (!tri_bytes_has(&r->file, 1, 4) || tri_bytes_i32(&r->file) != 1)
        return FAIL(r, "the file is big-endian; only little-endian files are supported");
    r->has_format = true;
    return true;
}

/* Reads the numbers of blocks and items of a section. Returns false if they are missing, or exceed what the file can
 * hold for this item size. */
static bool read_totals(struct reading *r, uint64_t *blocks, uint64_t *n, uint64_t item)
{
    if (!tri_bytes_has(&r->file, 4, 8))
        return false;
    *blocks = tri_bytes_u64(&r->file);
    *n = tri_bytes_u64(&r->file);
    r->file.at += 16; /* skip least and greatest tag */
    return tri_bytes_has(&r->file, *n, item) && *n <= INT32_MAX;
}

struct block {
    int32_t kind;
    uint64_t n;
};

static bool read_block_head(struct reading *r, struct block *block)
{
    if (!tri_bytes_has(&r->file, 1, 20))
        return false;
    r->file.at += 8; /* skip dimension and tag of the entity */
    block->kind = tri_bytes_i32(&r->file);
    block->n = tri_bytes_u64(&r->file);
    return true;
}

/* --- nodes */

static bool read_node(struct reading *r, int64_t i, const char *tag, const char *place)
{
    const double x = tri_get_f64(place), y = tri_get_f64(place + 8), z = tri_get_f64(place + 16);
    r->nodes.tag[i] = tri_get_i64(tag);
    r->to.mesh->points[2 * i] = x;
    r->to.mesh->points[2 * i + 1] = y;
    return (isfinite(x) && isfinite(y) && z == 0) ||
           FAIL(r, "node %" PRId64 " has a coordinate that is not finite, or z is not 0", r->nodes.tag[i]);
}

static bool read_nodes(struct reading *r)
{
    uint64_t blocks, n, done = 0;
    if (r->has_nodes || !read_totals(r, &blocks, &n, 32))
        return ends_early(r, "Nodes");
    r->has_nodes = true;
    if (!tri_tags_begin_nodes(&r->nodes, (int64_t)n, &r->to))
        return false;
    for (uint64_t b = 0; b < blocks; b++) {
        struct block block;
        if (!read_block_head(r, &block) || block.n > n - done || !tri_bytes_has(&r->file, block.n, 32))
            return ends_early(r, "Nodes");
        if (block.kind != 0)
            return FAIL(r, "nodes with parametric coordinates are not supported");
        const char *tags = r->file.at, *places = tags + 8 * block.n;
        for (uint64_t i = 0; i < block.n; i++)
            if (!read_node(r, (int64_t)done++, tags + 8 * i, places + 24 * i))
                return false;
        r->file.at += 32 * block.n;
    }
    return done < n ? ends_early(r, "Nodes") : tri_tags_order(&r->nodes, "node", &r->to);
}

/* --- elements */

static int nodes_of(int32_t kind)
{
    switch (kind) {
    case GMSH_POINT: return 1;
    case GMSH_LINE: return 2;
    case GMSH_TRIANGLE: return 3;
    case GMSH_QUADRATIC_TRIANGLE: return 6;
    default: return 0;
    }
}

/* Reads a node tag and converts it to a node number. */
static bool read_node_number(struct reading *r, const char *at, int32_t *place)
{
    *place = (int32_t)tri_tags_place(&r->nodes, tri_get_i64(at));
    return *place >= 0 || FAIL(r, "an element refers to node %" PRId64 ", which does not exist", tri_get_i64(at));
}

/* Gmsh orders the midpoints of edges along the boundary of the triangle; Triangle orders them by opposite corners. */
static bool read_triangle(struct reading *r, const char *at, int n_nodes)
{
    static const int opposite[] = {2, 0, 1};
    const int64_t i = r->n_triangles++;
    r->triangles.tag[i] = tri_get_i64(at);
    for (int k = 0; k < n_nodes; k++) {
        int32_t *to = k < 3 ? &r->to.elements->corners[3 * i + k] : &r->to.elements->extra[3 * i + opposite[k - 3]];
        if (!read_node_number(r, at + 8 * (k + 1), to))
            return false;
    }
    return true;
}

static bool read_segment(struct reading *r, const char *at)
{
    const int64_t i = r->n_segments++;
    r->segments.tag[i] = tri_get_i64(at);
    int32_t *to = &r->to.mesh->segments[2 * i];
    return read_node_number(r, at + 8, &to[0]) && read_node_number(r, at + 16, &to[1]);
}

static bool read_element_block(struct reading *r, const struct block *block)
{
    const int n = nodes_of(block->kind);
    const size_t bytes = 8 * (size_t)(n + 1);
    if (n >= 3 && r->n_triangles > 0 && r->to.elements->n_nodes != n)
        return FAIL(r, "the mesh has triangles of three nodes and of six nodes");
    if (n >= 3)
        r->to.elements->n_nodes = n;
    for (uint64_t i = 0; i < block->n; i++, r->file.at += bytes)
        if ((n >= 3 && !read_triangle(r, r->file.at, n)) || (n == 2 && !read_segment(r, r->file.at)))
            return false;
    return true;
}

/* Allocates room for n elements of each kind, because their kinds are not known yet. */
static bool begin_elements(struct reading *r, int64_t n)
{
    const bool room = tri_reading_triangles(&r->to, n, 6) && tri_reading_segments(&r->to, n) &&
                      tri_tags_begin(&r->triangles, n, &r->to) && tri_tags_begin(&r->segments, n, &r->to);
    r->to.elements->n_nodes = 3;
    return room;
}

static bool end_elements(struct reading *r)
{
    r->to.elements->n = (int32_t)r->n_triangles;
    r->to.mesh->n_segments = (int32_t)r->n_segments;
    r->triangles.n = r->n_triangles;
    r->segments.n = r->n_segments;
    if (r->to.elements->n_nodes == 3) {
        free(r->to.elements->extra);
        r->to.elements->extra = NULL;
    }
    return tri_tags_order(&r->triangles, "element", &r->to) && tri_tags_order(&r->segments, "element", &r->to);
}

static bool read_elements(struct reading *r)
{
    uint64_t blocks, n, done = 0;
    if (!r->has_nodes || r->has_elements || !read_totals(r, &blocks, &n, 16))
        return ends_early(r, r->has_nodes ? "Elements" : "Nodes");
    r->has_elements = true;
    if (!begin_elements(r, (int64_t)n))
        return false;
    for (uint64_t b = 0; b < blocks; b++) {
        struct block block;
        if (!read_block_head(r, &block) || block.n > n - done)
            return ends_early(r, "Elements");
        if (nodes_of(block.kind) == 0)
            return FAIL(r, "an element is of type %" PRId32 "; only triangles, lines and points are supported",
                        block.kind);
        if (!tri_bytes_has(&r->file, block.n, 8 * (uint64_t)(nodes_of(block.kind) + 1)))
            return ends_early(r, "Elements");
        if (!read_element_block(r, &block))
            return false;
        done += block.n;
    }
    r->n_elements = (int64_t)n;
    return done < n ? ends_early(r, "Elements") : end_elements(r);
}

/* --- data */

static bool read_count(struct reading *r, int64_t *n)
{
    const char *line;
    size_t length;
    return tri_bytes_line(&r->file, &line, &length) && tri_scan_integer(line, line + length, n) == line + length &&
           *n >= 0;
}

static bool skip_lines(struct reading *r, int64_t n)
{
    const char *line;
    size_t length;
    while (n > 0 && tri_bytes_line(&r->file, &line, &length))
        n--;
    return n == 0;
}

/* Reads the head of a data section: names, reals (times), and numbers, among them the number of components, which must
 * be 1, and of items. Returns false for other forms. */
static bool read_data_head(struct reading *r, struct data *data)
{
    const char *line;
    size_t length;
    int64_t names, reals, numbers, components;
    if (!read_count(r, &names) || names < 1 || !tri_bytes_line(&r->file, &line, &length))
        return false;
    snprintf(data->name, sizeof data->name, "%.*s", length < MOST_NAME ? (int)length : 0, line);
    for (char *blank = data->name; (blank = strchr(blank, ' ')) != NULL;) /* older files have blanks */
        *blank = '_';
    return skip_lines(r, names - 1) && read_count(r, &reals) && skip_lines(r, reals) && read_count(r, &numbers) &&
           numbers >= 3 && skip_lines(r, 1) && read_count(r, &components) && components == 1 &&
           read_count(r, &data->n) && skip_lines(r, numbers - 3);
}

/* Appends a column to `*width` existing ones; missing values are 0. tags: of nodes, or of triangles. */
static bool add_column(struct reading *r, const struct data *data, const struct tri_tags *tags,
                                  double **columns, int32_t *width)
{
    const size_t n = (size_t)tags->n, old = (size_t)*width, new = old + 1;
    double *all = calloc(n * new + 1, sizeof *all);
    if (!all)
        return tri_reading_no_memory(&r->to);
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < old; k++)
            all[new * i + k] = (*columns)[old * i + k];
    free(*columns);
    *columns = all;
    *width = (int32_t)new;
    for (int64_t i = 0; i < data->n; i++) {
        const int64_t place = tri_tags_place(tags, tri_get_i32(data->at + DATUM_BYTES * i));
        const double value = tri_get_f64(data->at + DATUM_BYTES * i + 4);
        if (!isfinite(value))
            return FAIL(r, "an attribute is not finite");
        if (place >= 0)
            all[new * (size_t)place + old] = value;
    }
    return true;
}

/* Reads markers of nodes, or of segments. */
static bool read_markers(struct reading *r, const struct data *data, const struct tri_tags *tags,
                                    int32_t **markers)
{
    free(*markers);
    *markers = calloc((size_t)tags->n + 1, sizeof **markers);
    if (!*markers)
        return tri_reading_no_memory(&r->to);
    for (int64_t i = 0; i < data->n; i++) {
        const int64_t place = tri_tags_place(tags, tri_get_i32(data->at + DATUM_BYTES * i));
        const double value = tri_get_f64(data->at + DATUM_BYTES * i + 4);
        if (!(value >= INT32_MIN && value <= INT32_MAX))
            return FAIL(r, "a marker does not fit into 32 bits");
        if (place >= 0)
            (*markers)[place] = (int32_t)value;
    }
    return true;
}

static bool store_data(struct reading *r, const struct data *data)
{
    char next[MOST_NAME];
    int32_t *width = data->of_nodes ? &r->to.mesh->n_attributes : &r->to.elements->n_attributes;
    snprintf(next, sizeof next, "\"attribute_%" PRId32 "\"", *width);
    if (strcmp(data->name, "\"marker\"") == 0)
        return read_markers(r, data, data->of_nodes ? &r->nodes : &r->segments,
                            data->of_nodes ? &r->to.mesh->markers : &r->to.mesh->segment_markers);
    if ((strcmp(data->name, next) == 0 && *width < MOST_ATTRIBUTES) || (r->any_data && data->of_nodes && *width == 0))
        return add_column(r, data, data->of_nodes ? &r->nodes : &r->triangles,
                          data->of_nodes ? &r->to.mesh->attributes : &r->to.elements->attributes, width);
    return true;
}

static bool read_data(struct reading *r, bool of_nodes)
{
    struct data data = {.of_nodes = of_nodes};
    if (!r->has_elements)
        return FAIL(r, "a data section comes before the elements");
    if (!read_data_head(r, &data))
        return true; /* data of another form are ignored */
    const int64_t items = of_nodes ? r->nodes.n : r->n_elements;
    if (data.n != items || !tri_bytes_has(&r->file, (uint64_t)data.n, DATUM_BYTES))
        return FAIL(r, "%.*s does not have one number for each of the %" PRId64 " %s", MOST_NAME, data.name, items,
                    of_nodes ? "nodes" : "elements");
    data.at = r->file.at;
    r->file.at += (uint64_t)data.n * DATUM_BYTES;
    return store_data(r, &data);
}

/* --- the file */

static bool read_section(struct reading *r, const char *name, size_t n)
{
    if (is_line(name, n, "MeshFormat"))
        return read_format(r);
    if (!r->has_format)
        return FAIL(r, "not a .msh file");
    if (is_line(name, n, "Nodes"))
        return read_nodes(r);
    if (is_line(name, n, "Elements"))
        return read_elements(r);
    if (is_line(name, n, "NodeData") || is_line(name, n, "ElementData"))
        return read_data(r, *name == 'N');
    return true;
}

static bool read_sections(struct reading *r)
{
    const char *line;
    size_t n;
    while (tri_bytes_line(&r->file, &line, &n)) {
        char end[64];
        if (n == 0)
            continue;
        if (*line != '$' || n > 40)
            return FAIL(r, r->has_format ? "unexpected text between two sections" : "not a .msh file");
        if (!read_section(r, line + 1, n - 1))
            return false;
        snprintf(end, sizeof end, "\n$End%.*s", (int)n - 1, line + 1);
        r->file.at--; /* include the line break before the end tag if the section is empty */
        if (!tri_bytes_pass(&r->file, end))
            return FAIL(r, "the section %.*s has no end", (int)n, line);
        (void)tri_bytes_line(&r->file, &line, &n);
    }
    return r->has_elements || FAIL(r, "not a .msh file, or one without elements");
}

static enum tri_status read_msh(const char *path, struct tri_pslg *mesh, struct tri_elements *elements,
                                const struct tri_executor *executor, bool any_data, struct tri_error *error)
{
    struct reading r = {.to = {path, executor, mesh, elements, error, TRI_OK}, .any_data = any_data};
    r.to.status = tri_bytes_load(&r.file, path, error);
    (void)(!r.to.status && read_sections(&r));
    tri_bytes_free(&r.file);
    tri_tags_free(&r.nodes);
    tri_tags_free(&r.triangles);
    tri_tags_free(&r.segments);
    return r.to.status;
}

enum tri_status tri_read_msh(const char *path, struct tri_pslg *mesh, struct tri_elements *elements,
                             const struct tri_executor *executor, struct tri_error *error)
{
    return read_msh(path, mesh, elements, executor, false, error);
}

enum tri_status tri_read_msh_data(const char *path, struct tri_pslg *mesh, struct tri_elements *elements,
                                  const struct tri_executor *executor, struct tri_error *error)
{
    return read_msh(path, mesh, elements, executor, true, error);
}
