/* Reading .node, .poly, .ele and .area files: each is a sequence of headers and tables over triangle/text/text.h.
 *
 * No array is allocated before the count in the header has been compared with the records that remain, so that a header
 * of a few bytes cannot ask for gigabytes. */
#include "triangle/text/read.h"

#include <stdlib.h>
#include <string.h>

#include "triangle/mesh/mesh.h"
#include "triangle/text/text.h"

enum {
    MAX_SEGMENTS = TRI_MAX_TRIANGLES,
    FREE_ATTRIBUTES = 64 /* columns that a header may announce although no record has them */
};

/* --- headers */

/* The count of a section and what else its header may say. */
struct header {
    int64_t count;
    int64_t more[3]; /* in: what a missing field means */
};

/* Names of a section in errors. */
struct section {
    const char *noun, *nouns;
    int64_t limit; /* largest count */
};

static const struct section vertices = {"vertex", "vertices", TRI_MAX_VERTICES};
static const struct section triangles = {"triangle", "triangles", TRI_MAX_TRIANGLES};
static const struct section bounds = {"area bound", "area bounds", TRI_MAX_TRIANGLES};
static const struct section segments = {"segment", "segments", MAX_SEGMENTS};
static const struct section holes = {"hole", "holes", TRI_MAX_VERTICES};
static const struct section regions = {"region", "regions", TRI_MAX_VERTICES};

static const char *name_of(const struct tri_cursor *cursor) { return cursor->text->name; }

static enum tri_status check_count(const struct tri_cursor *cursor, const struct section *section, int64_t count,
                                   struct tri_error *error)
{
    const long line = (long)cursor->line;
    if (count < 0)
        return tri_fail(error, TRI_BAD_INPUT, name_of(cursor), line, "the number of %s is negative", section->nouns);
    if ((uint64_t)count > tri_cursor_remaining(cursor))
        return tri_fail(error, TRI_BAD_INPUT, name_of(cursor), line,
                        "unexpected end of file: %lld %s are announced, but only %zu records follow", (long long)count,
                        section->nouns, tri_cursor_remaining(cursor));
    if (count > section->limit)
        return tri_fail(error, TRI_TOO_LARGE, name_of(cursor), line, "%lld %s are more than the %lld that are possible",
                        (long long)count, section->nouns, (long long)section->limit);
    return TRI_OK;
}

/* Reads the next record as a header of at most 1 + n_more fields. The count is checked. */
static enum tri_status read_header(struct tri_cursor *cursor, const struct section *section, struct header *header,
                                   int n_more, struct tri_error *error)
{
    struct tri_fields fields;
    if (!tri_cursor_next(cursor, &fields))
        return tri_fail(error, TRI_BAD_INPUT, name_of(cursor), (long)cursor->line,
                        "unexpected end of file: the number of %s is missing", section->nouns);
    if (tri_fields_integer(&fields, &header->count) != TRI_FIELD_GOOD)
        return tri_fail(error, TRI_BAD_INPUT, name_of(cursor), (long)cursor->line, "the number of %s is not a number",
                        section->nouns);
    for (int i = 0; i < n_more; i++) {
        int64_t value;
        const enum tri_field field = tri_fields_integer(&fields, &value);
        if (field == TRI_FIELD_BAD)
            return tri_fail(error, TRI_BAD_INPUT, name_of(cursor), (long)cursor->line,
                            "field %d of the header of the %s is not a number", i + 2, section->nouns);
        if (field == TRI_FIELD_GOOD)
            header->more[i] = value;
    }
    return check_count(cursor, section, header->count, error);
}

/* Attributes are bounded by what the file could hold, except for a few that may be missing from every record. */
static enum tri_status check_attributes(const struct tri_cursor *cursor, int64_t n_attributes, int64_t n_rows,
                                        struct tri_error *error)
{
    if (n_attributes < 0)
        return tri_fail(error, TRI_BAD_INPUT, name_of(cursor), (long)cursor->line,
                        "the number of attributes is negative");
    const int64_t size = (int64_t)cursor->text->size;
    if (n_attributes > INT32_MAX || (n_attributes > FREE_ATTRIBUTES && n_rows > 0 && n_attributes > size / n_rows))
        return tri_fail(error, TRI_BAD_INPUT, name_of(cursor), (long)cursor->line,
                        "%lld attributes are announced, more than the file can hold", (long long)n_attributes);
    return TRI_OK;
}

/* --- arrays and tables */

/* Room for n elements, or NULL for none or where *status already tells of a failure, as it does after this one's. */
static void *allocate(enum tri_status *status, size_t n, size_t size, const struct tri_cursor *cursor,
                      struct tri_error *error)
{
    if (*status != TRI_OK || n == 0)
        return NULL;
    void *const memory = n <= SIZE_MAX / size ? malloc(n * size) : NULL;
    if (!memory)
        *status = tri_fail(error, TRI_NO_MEMORY, name_of(cursor), (long)cursor->line, "no memory for %zu values", n);
    return memory;
}

static enum tri_status read_table(struct tri_cursor *cursor, const struct section *section, int32_t n, int32_t base,
                                  const char *(*row)(void *, size_t, struct tri_fields *), void *user,
                                  const struct tri_read_options *options, struct tri_error *error)
{
    const struct tri_table table = {section->noun, (size_t)n, base, row, user};
    return tri_cursor_table(cursor, &table, options->executor, error);
}

static const char *parse_attributes(struct tri_fields *fields, double *attributes, int32_t n)
{
    for (int32_t i = 0; i < n; i++)
        if (tri_fields_real(fields, &attributes[i]) == TRI_FIELD_BAD)
            return "has an attribute that is not a finite number";
    return NULL;
}

static double *row_of(double *values, size_t i, int32_t n) { return values ? values + i * (size_t)n : NULL; }

/* --- points */

static const char *parse_vertex(void *user, size_t i, struct tri_fields *fields)
{
    const struct tri_pslg *const out = user;
    const char *fault = tri_fields_point(fields, &out->points[2 * i]);
    if (!fault)
        fault = parse_attributes(fields, row_of(out->attributes, i, out->n_attributes), out->n_attributes);
    if (!fault && out->markers)
        fault = tri_fields_marker(fields, &out->markers[i]);
    return fault;
}

/* The number of the record that comes next decides, if it is 0 or 1. */
static int32_t detect_base(struct tri_cursor cursor, int32_t default_base)
{
    struct tri_fields fields;
    int64_t number;
    if (!tri_cursor_next(&cursor, &fields) || tri_fields_integer(&fields, &number) != TRI_FIELD_GOOD)
        return default_base;
    return number == 0 || number == 1 ? (int32_t)number : default_base;
}

static enum tri_status check_vertices(const struct tri_cursor *cursor, const struct header *header,
                                      const struct tri_read_options *options, struct tri_error *error)
{
    const long line = (long)cursor->line;
    if (header->count < 3 && !options->may_be_empty)
        return tri_fail(error, TRI_BAD_INPUT, name_of(cursor), line, "there are only %lld vertices; 3 are needed",
                        (long long)header->count);
    if (header->more[0] != 2)
        return tri_fail(error, TRI_BAD_INPUT, name_of(cursor), line, "the vertices have %lld coordinates instead of 2",
                        (long long)header->more[0]);
    return check_attributes(cursor, header->more[1], header->count, error);
}

/* The vertices that the header announces. */
static enum tri_status read_vertices(struct tri_cursor *cursor, const struct header *header,
                                     const struct tri_read_options *options, struct tri_pslg *out, int32_t *base,
                                     struct tri_error *error)
{
    enum tri_status status = check_vertices(cursor, header, options, error);
    if (status != TRI_OK)
        return status;
    const size_t n = (size_t)header->count;
    out->n_points = (int32_t)header->count;
    out->n_attributes = (int32_t)header->more[1];
    out->points = allocate(&status, 2 * n, sizeof *out->points, cursor, error);
    out->attributes = allocate(&status, n * (size_t)out->n_attributes, sizeof *out->attributes, cursor, error);
    if (header->more[2] > 0)
        out->markers = allocate(&status, n, sizeof *out->markers, cursor, error);
    if (status != TRI_OK)
        return status;
    *base = detect_base(*cursor, options->default_base);
    return read_table(cursor, &vertices, out->n_points, *base, parse_vertex, out, options, error);
}

static struct header vertex_header(void) { return (struct header){0, {2, 0, 0}}; }

static enum tri_status read_node_text(const struct tri_text *text, const struct tri_read_options *options,
                                      struct tri_pslg *out, int32_t *base, struct tri_error *error)
{
    struct tri_cursor cursor = tri_cursor_begin(text);
    struct header header = vertex_header();
    const enum tri_status status = read_header(&cursor, &vertices, &header, 3, error);
    return status == TRI_OK ? read_vertices(&cursor, &header, options, out, base, error) : status;
}

enum tri_status tri_read_node(const char *path, const struct tri_read_options *options, struct tri_pslg *out,
                              int32_t *base, struct tri_error *error)
{
    *out = (struct tri_pslg){0};
    struct tri_text text;
    enum tri_status status = tri_text_load(&text, path, options->chunk_bytes, options->executor, options->stop, error);
    if (status == TRI_OK)
        status = read_node_text(&text, options, out, base, error);
    tri_text_free(&text);
    if (status != TRI_OK)
        tri_pslg_free(out);
    return status;
}

/* --- segments */

struct segment_rows {
    struct tri_pslg *out;
    int32_t base;
    bool refining;
};

/* An index that no int32_t holds stays out of range. */
static int32_t index_from(int64_t number, int32_t base)
{
    if (number < INT32_MIN + 1)
        return INT32_MIN;
    return number > INT32_MAX ? INT32_MAX : (int32_t)(number - base);
}

static bool names_point(const struct tri_pslg *pslg, int32_t index) { return index >= 0 && index < pslg->n_points; }

static const char *parse_segment(void *user, size_t i, struct tri_fields *fields)
{
    const struct segment_rows *const rows = user;
    tri_fields_skip(fields); /* its number */
    for (size_t end = 0; end < 2; end++) {
        int64_t number;
        const enum tri_field field = tri_fields_integer(fields, &number);
        if (field == TRI_FIELD_BAD)
            return "has an endpoint that is not a number";
        if (field == TRI_FIELD_MISSING)
            return end == 0 ? "has no endpoints" : "has no second endpoint";
        const int32_t index = index_from(number, rows->base);
        if (rows->refining && !names_point(rows->out, index))
            return "has an endpoint that is not the number of a vertex";
        rows->out->segments[2 * i + end] = index;
    }
    return rows->out->segment_markers ? tri_fields_marker(fields, &rows->out->segment_markers[i]) : NULL;
}

/* Why the segment will be skipped, or NULL. */
static const char *reason_to_skip(const struct tri_pslg *pslg, size_t i)
{
    const int32_t *const v = &pslg->segments[2 * i];
    if (!names_point(pslg, v[0]))
        return "its first endpoint is not the number of a vertex";
    if (!names_point(pslg, v[1]))
        return "its second endpoint is not the number of a vertex";
    if (v[0] == v[1])
        return "its endpoints are the same vertex";
    const double *const a = &pslg->points[2 * (size_t)v[0]], *const b = &pslg->points[2 * (size_t)v[1]];
    return a[0] == b[0] && a[1] == b[1] ? "its endpoints are at the same place" : NULL;
}

/* One warning for each segment to skip. The cursor, which stands before the segments, only follows for the line. */
static void warn_of_segments(struct tri_cursor cursor, const struct tri_pslg *pslg, int32_t base,
                             const struct tri_read_options *options)
{
    const size_t first = cursor.record;
    for (size_t i = 0; options->warn && i < (size_t)pslg->n_segments; i++) {
        const char *const reason = reason_to_skip(pslg, i);
        if (!reason)
            continue;
        struct tri_fields fields;
        while (cursor.record <= first + i && tri_cursor_next(&cursor, &fields))
            continue;
        struct tri_error warning; /* as a buffer that prints */
        tri_fail(&warning, TRI_BAD_INPUT, name_of(&cursor), (long)cursor.line, "segment %lld is ignored: %s",
                 (long long)i + base, reason);
        options->warn(options->warn_user, name_of(&cursor), warning.line, warning.text);
    }
}

static enum tri_status read_segments(struct tri_cursor *cursor, const struct tri_read_options *options,
                                     struct tri_pslg *out, int32_t base, struct tri_error *error)
{
    struct header header = {0, {0}};
    enum tri_status status = read_header(cursor, &segments, &header, 1, error);
    if (status != TRI_OK)
        return status;
    const size_t n = (size_t)header.count;
    out->n_segments = (int32_t)header.count;
    out->segments = allocate(&status, 2 * n, sizeof *out->segments, cursor, error);
    if (header.more[0] > 0)
        out->segment_markers = allocate(&status, n, sizeof *out->segment_markers, cursor, error);
    if (status != TRI_OK)
        return status;
    struct segment_rows rows = {out, base, options->refining};
    const struct tri_cursor begin = *cursor;
    status = read_table(cursor, &segments, out->n_segments, base, parse_segment, &rows, options, error);
    if (status == TRI_OK)
        warn_of_segments(begin, out, base, options);
    return status;
}

/* --- holes and regions */

static const char *parse_hole(void *user, size_t i, struct tri_fields *fields)
{
    double *const values = user;
    return tri_fields_point(fields, &values[2 * i]);
}

/* One value serves as both. */
static const char *parse_region(void *user, size_t i, struct tri_fields *fields)
{
    double *const values = (double *)user + 4 * i;
    const char *const fault = tri_fields_point(fields, values);
    if (fault)
        return fault;
    const enum tri_field attribute = tri_fields_real(fields, &values[2]);
    if (attribute != TRI_FIELD_GOOD)
        return attribute == TRI_FIELD_MISSING ? "has neither attribute nor area bound"
                                              : "has an attribute that is not a finite number";
    const enum tri_field bound = tri_fields_real(fields, &values[3]);
    if (bound == TRI_FIELD_MISSING)
        values[3] = values[2];
    return bound == TRI_FIELD_BAD ? "has an area bound that is not a finite number" : NULL;
}

/* A count, and as many records of n_values reals. */
static enum tri_status read_sites(struct tri_cursor *cursor, const struct section *section, size_t n_values,
                                  const char *(*row)(void *, size_t, struct tri_fields *), int32_t base,
                                  const struct tri_read_options *options, int32_t *n, double **values,
                                  struct tri_error *error)
{
    struct header header = {0, {0}};
    enum tri_status status = read_header(cursor, section, &header, 0, error);
    *values = allocate(&status, n_values * (size_t)header.count, sizeof **values, cursor, error);
    if (status != TRI_OK)
        return status;
    *n = (int32_t)header.count;
    return read_table(cursor, section, *n, base, row, *values, options, error);
}

/* --- .poly */

static enum tri_status read_poly_vertices(struct tri_cursor *cursor, const char *node_path,
                                          const struct tri_read_options *options, struct tri_pslg *out, int32_t *base,
                                          bool *points_in_poly, struct tri_error *error)
{
    struct header header = vertex_header();
    const enum tri_status status = read_header(cursor, &vertices, &header, 3, error);
    if (status != TRI_OK)
        return status;
    *points_in_poly = header.count > 0;
    if (*points_in_poly)
        return read_vertices(cursor, &header, options, out, base, error);
    if (!node_path)
        return tri_fail(error, TRI_BAD_INPUT, name_of(cursor), (long)cursor->line, "the file has no vertices");
    return tri_read_node(node_path, options, out, base, error);
}

static enum tri_status read_poly_text(const struct tri_text *text, const char *node_path,
                                      const struct tri_read_options *options, struct tri_pslg *out, int32_t *base,
                                      bool *points_in_poly, struct tri_error *error)
{
    struct tri_cursor cursor = tri_cursor_begin(text);
    enum tri_status status = read_poly_vertices(&cursor, node_path, options, out, base, points_in_poly, error);
    if (status == TRI_OK)
        status = read_segments(&cursor, options, out, *base, error);
    if (status == TRI_OK)
        status = read_sites(&cursor, &holes, 2, parse_hole, *base, options, &out->n_holes, &out->holes, error);
    bool has_more = tri_cursor_remaining(&cursor) > 0;
    if (status == TRI_OK && (options->want_regions || (options->regions_if_any && has_more)))
        status = read_sites(&cursor, &regions, 4, parse_region, *base, options, &out->n_regions, &out->regions, error);
    return status;
}

enum tri_status tri_read_poly(const char *poly_path, const char *node_path, const struct tri_read_options *options,
                              struct tri_pslg *out, int32_t *base, bool *points_in_poly, struct tri_error *error)
{
    *out = (struct tri_pslg){0};
    struct tri_text text;
    enum tri_status status = tri_text_load(&text, poly_path, options->chunk_bytes, options->executor,
                                           options->stop, error);
    if (status == TRI_OK)
        status = read_poly_text(&text, node_path, options, out, base, points_in_poly, error);
    tri_text_free(&text);
    if (status != TRI_OK)
        tri_pslg_free(out);
    return status;
}

/* --- .ele */

struct element_rows {
    struct tri_elements *out;
    int32_t base, n_points;
};

/* The nodes behind the third. */
static void parse_extra(const struct element_rows *rows, size_t i, struct tri_fields *fields)
{
    const int32_t n = rows->out->n_nodes - 3;
    int32_t *const extra = rows->out->extra ? rows->out->extra + i * (size_t)n : NULL;
    for (int32_t node = 0; node < n && (extra || tri_kind_at(fields->at) == TRI_IS_START); node++) {
        int64_t number;
        const bool good = tri_fields_integer(fields, &number) == TRI_FIELD_GOOD;
        const int32_t index = good ? index_from(number, rows->base) : TRI_NONE;
        if (extra)
            extra[node] = index >= 0 && index < rows->n_points ? index : TRI_NONE;
        if (!good)
            tri_fields_skip(fields);
    }
}

static const char *parse_element(void *user, size_t i, struct tri_fields *fields)
{
    const struct element_rows *const rows = user;
    tri_fields_skip(fields); /* its number */
    for (size_t corner = 0; corner < 3; corner++) {
        int64_t number;
        const enum tri_field field = tri_fields_integer(fields, &number);
        if (field != TRI_FIELD_GOOD)
            return field == TRI_FIELD_MISSING ? "has fewer than three corners" : "has a corner that is not a number";
        const int64_t index = index_from(number, rows->base);
        if (index < 0 || index >= rows->n_points)
            return "has a corner that is not the number of a vertex";
        rows->out->corners[3 * i + corner] = (int32_t)index;
    }
    parse_extra(rows, i, fields);
    return parse_attributes(fields, row_of(rows->out->attributes, i, rows->out->n_attributes), rows->out->n_attributes);
}

static enum tri_status read_ele_header(struct tri_cursor *cursor, struct tri_elements *out, struct tri_error *error)
{
    struct header header = {0, {3, 0}};
    enum tri_status status = read_header(cursor, &triangles, &header, 2, error);
    if (status == TRI_OK && (header.more[0] < 3 || header.more[0] > INT32_MAX))
        status = tri_fail(error, TRI_BAD_INPUT, name_of(cursor), (long)cursor->line,
                          "the triangles have %lld nodes; 3 or more are needed", (long long)header.more[0]);
    if (status == TRI_OK)
        status = check_attributes(cursor, header.more[1], header.count, error);
    if (status != TRI_OK)
        return status;
    out->n = (int32_t)header.count;
    out->n_nodes = (int32_t)header.more[0];
    out->n_attributes = (int32_t)header.more[1];
    return TRI_OK;
}

static enum tri_status read_ele_text(const struct tri_text *text, const struct tri_read_options *options,
                                     const struct element_rows *rows, struct tri_error *error)
{
    struct tri_elements *const out = rows->out;
    struct tri_cursor cursor = tri_cursor_begin(text);
    enum tri_status status = read_ele_header(&cursor, out, error);
    if (status != TRI_OK)
        return status;
    const size_t n = (size_t)out->n;
    out->corners = allocate(&status, 3 * n, sizeof *out->corners, &cursor, error);
    out->attributes = allocate(&status, n * (size_t)out->n_attributes, sizeof *out->attributes, &cursor, error);
    const size_t extra = (size_t)out->n_nodes - 3;
    if (n > 0 && extra <= text->size / n)
        out->extra = allocate(&status, n * extra, sizeof *out->extra, &cursor, error);
    if (status != TRI_OK)
        return status;
    return read_table(&cursor, &triangles, out->n, rows->base, parse_element, (void *)rows, options, error);
}

enum tri_status tri_read_ele(const char *path, const struct tri_read_options *options, int32_t base, int32_t n_points,
                             struct tri_elements *out, struct tri_error *error)
{
    *out = (struct tri_elements){0};
    const struct element_rows rows = {out, base, n_points};
    struct tri_text text;
    enum tri_status status = tri_text_load(&text, path, options->chunk_bytes, options->executor, options->stop, error);
    if (status == TRI_OK)
        status = read_ele_text(&text, options, &rows, error);
    tri_text_free(&text);
    if (status != TRI_OK)
        tri_elements_free(out);
    return status;
}

/* --- .area */

static const char *parse_bound(void *user, size_t i, struct tri_fields *fields)
{
    double *const areas = user;
    tri_fields_skip(fields); /* its number */
    return tri_fields_real(fields, &areas[i]) == TRI_FIELD_BAD ? "is not a finite number" : NULL;
}

static enum tri_status read_area_text(const struct tri_text *text, const struct tri_read_options *options, int32_t base,
                                      struct tri_elements *elements, struct tri_error *error)
{
    struct tri_cursor cursor = tri_cursor_begin(text);
    struct header header = {0, {0}};
    enum tri_status status = read_header(&cursor, &bounds, &header, 0, error);
    if (status == TRI_OK && header.count != elements->n)
        status = tri_fail(error, TRI_BAD_INPUT, text->name, (long)cursor.line,
                          "there are %lld area bounds, but %ld triangles", (long long)header.count, (long)elements->n);
    elements->areas = allocate(&status, (size_t)header.count, sizeof *elements->areas, &cursor, error);
    if (status != TRI_OK)
        return status;
    return read_table(&cursor, &bounds, elements->n, base, parse_bound, elements->areas, options, error);
}

enum tri_status tri_read_area(const char *path, const struct tri_read_options *options, int32_t base,
                              struct tri_elements *elements, struct tri_error *error)
{
    elements->areas = NULL;
    struct tri_text text;
    enum tri_status status = tri_text_load(&text, path, options->chunk_bytes, options->executor, options->stop, error);
    if (status == TRI_OK)
        status = read_area_text(&text, options, base, elements, error);
    tri_text_free(&text);
    if (status != TRI_OK) {
        free(elements->areas);
        elements->areas = NULL;
    }
    return status;
}
