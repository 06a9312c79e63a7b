/* Reads .node, .poly, .ele and .area files: each is a sequence of headers and tables, read by triangle/text/text.h.
 *
 * Arrays are allocated only after the count in the header has been compared with the number of remaining records, so
 * that a header of a few bytes cannot request gigabytes. */
#include "triangle/text/read.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "triangle/mesh/mesh.h"
#include "triangle/text/text.h"

enum {
    MAX_SEGMENTS = TRI_MAX_TRIANGLES,
    FREE_ATTRIBUTES = 64 /* columns that a header may announce even if no record has them */
};

/* State of reading one file. */
struct reader {
    const struct tri_read_options *options;
    struct tri_pslg *pslg;         /* receives points, segments, holes and regions */
    struct tri_elements *elements; /* receives triangles and their area bounds */
    int32_t base, n_points;        /* first number in the file (0 or 1); number of points that may be referenced */
    struct tri_text text;
    struct tri_cursor cursor;
    enum tri_status status;        /* after a failure nothing more is read */
    struct tri_error *error;
};

/* Reports an error at the line that was read last. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
static void fail(struct reader *r, enum tri_status status, const char *format, ...)
{
    char text[sizeof r->error->text];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    r->status = tri_fail(r->error, status, r->text.name, r->cursor.line, "%s", text);
}

/* end_reading must be called in any case. */
static void begin_reading(struct reader *r, const char *path)
{
    const struct tri_read_options *o = r->options;
    r->status = tri_text_load(&r->text, path, o->chunk_bytes, o->executor, o->stop, r->error);
    if (!r->status)
        r->cursor = tri_cursor_begin(&r->text);
}

static enum tri_status end_reading(struct reader *r)
{
    tri_text_free(&r->text);
    if (r->status && r->pslg)
        tri_pslg_free(r->pslg);
    if (r->status && r->elements)
        tri_elements_free(r->elements);
    return r->status;
}

/* --- headers */

/* A section: its names in errors, and a limit. */
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

static void check_count(struct reader *r, const struct section *section, int64_t count)
{
    const size_t left = tri_cursor_remaining(&r->cursor);
    if (count < 0)
        fail(r, TRI_BAD_INPUT, "the number of %s is negative", section->nouns);
    else if ((uint64_t)count > left)
        fail(r, TRI_BAD_INPUT, "unexpected end of file: %lld %s are announced, but only %zu records follow",
             (long long)count, section->nouns, left);
    else if (count > section->limit)
        fail(r, TRI_TOO_LARGE, "%lld %s are more than the %lld that are possible", (long long)count, section->nouns,
             (long long)section->limit);
}

/* Reads the next record as a header. Checks and returns its count (0 after a failure), and reads up to n_more further
 * fields into more[], which the caller has initialised with the defaults of missing fields. */
static int64_t read_header(struct reader *r, const struct section *section, int64_t *more, int n_more)
{
    struct tri_fields fields;
    int64_t count = 0;
    if (r->status)
        return 0;
    if (!tri_cursor_next(&r->cursor, &fields))
        fail(r, TRI_BAD_INPUT, "unexpected end of file: the number of %s is missing", section->nouns);
    else if (tri_fields_integer(&fields, &count) != TRI_FIELD_GOOD)
        fail(r, TRI_BAD_INPUT, "the number of %s is not a number", section->nouns);
    for (int i = 0; i < n_more && !r->status; i++) {
        int64_t value;
        const enum tri_field field = tri_fields_integer(&fields, &value);
        if (field == TRI_FIELD_BAD)
            fail(r, TRI_BAD_INPUT, "field %d of the header of the %s is not a number", i + 2, section->nouns);
        more[i] = field == TRI_FIELD_GOOD ? value : more[i];
    }
    if (!r->status)
        check_count(r, section, count);
    return r->status ? 0 : count;
}

/* The number of attributes is limited by the file size, except for a few that may be missing in all records. */
static void check_attributes(struct reader *r, int64_t n_attributes, int64_t n_rows)
{
    const int64_t size = (int64_t)r->text.size;
    if (r->status)
        return;
    if (n_attributes < 0)
        fail(r, TRI_BAD_INPUT, "the number of attributes is negative");
    else if (n_attributes > INT32_MAX ||
             (n_attributes > FREE_ATTRIBUTES && n_rows > 0 && n_attributes > size / n_rows))
        fail(r, TRI_BAD_INPUT, "%lld attributes are announced, more than the file can hold", (long long)n_attributes);
}

/* --- arrays and tables */

/* Allocates room for n elements; returns NULL if n is 0. */
static void *allocate(struct reader *r, size_t n, size_t size)
{
    if (r->status || n == 0)
        return NULL;
    void *const memory = n <= SIZE_MAX / size ? malloc(n * size) : NULL;
    if (!memory)
        fail(r, TRI_NO_MEMORY, "no memory for %zu values", n);
    return memory;
}

static void read_table(struct reader *r, const struct section *section, int64_t n,
                       const char *(*row)(void *, size_t, struct tri_fields *), void *user)
{
    const struct tri_table table = {section->noun, (size_t)n, r->base, row, user};
    if (!r->status)
        r->status = tri_cursor_table(&r->cursor, &table, r->options->executor, r->error);
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

/* Returns the number of the next record if it is 0 or 1, otherwise the default. */
static int32_t detect_base(struct tri_cursor cursor, int32_t default_base)
{
    struct tri_fields fields;
    int64_t number;
    if (!tri_cursor_next(&cursor, &fields) || tri_fields_integer(&fields, &number) != TRI_FIELD_GOOD)
        return default_base;
    return number == 0 || number == 1 ? (int32_t)number : default_base;
}

/* Reads vertices, or, if this file has none, reads them from node_path (NULL: error). must_be_here: no vertices are an
 * error. Returns whether the vertices are in this file. */
static bool read_vertices(struct reader *r, const char *node_path, bool must_be_here)
{
    int64_t more[3] = {2, 0, 0};
    struct tri_pslg *out = r->pslg;
    const int64_t n = read_header(r, &vertices, more, 3);
    if (r->status)
        return true;
    if (n == 0 && !must_be_here) {
        if (node_path)
            r->status = tri_read_node(node_path, r->options, out, &r->base, r->error);
        else
            fail(r, TRI_BAD_INPUT, "the file has no vertices");
        return false;
    }
    if (n < 3 && !r->options->may_be_empty)
        fail(r, TRI_BAD_INPUT, "there are only %lld vertices; 3 are needed", (long long)n);
    else if (more[0] != 2)
        fail(r, TRI_BAD_INPUT, "the vertices have %lld coordinates instead of 2", (long long)more[0]);
    check_attributes(r, more[1], n);
    if (r->status)
        return true;
    out->n_points = (int32_t)n;
    out->n_attributes = (int32_t)more[1];
    out->points = allocate(r, 2 * (size_t)n, sizeof *out->points);
    out->attributes = allocate(r, (size_t)n * (size_t)out->n_attributes, sizeof *out->attributes);
    out->markers = more[2] > 0 ? allocate(r, (size_t)n, sizeof *out->markers) : NULL;
    r->base = detect_base(r->cursor, r->options->default_base);
    read_table(r, &vertices, n, parse_vertex, out);
    return true;
}

enum tri_status tri_read_node(const char *path, const struct tri_read_options *options, struct tri_pslg *out,
                              int32_t *base, struct tri_error *error)
{
    struct reader r = {.options = options, .pslg = out, .error = error};
    *out = (struct tri_pslg){0};
    begin_reading(&r, path);
    (void)read_vertices(&r, NULL, true);
    *base = r.base;
    return end_reading(&r);
}

/* --- segments */

/* Converts a number to an index from 0. Numbers beyond int32_t stay out of range. */
static int32_t index_from(int64_t number, int32_t base)
{
    if (number < INT32_MIN + 1)
        return INT32_MIN;
    return number > INT32_MAX ? INT32_MAX : (int32_t)(number - base);
}

static bool names_point(const struct tri_pslg *pslg, int32_t index) { return index >= 0 && index < pslg->n_points; }

static const char *parse_segment(void *user, size_t i, struct tri_fields *fields)
{
    const struct reader *const r = user;
    tri_fields_skip(fields); /* its number */
    for (size_t end = 0; end < 2; end++) {
        int64_t number;
        const enum tri_field field = tri_fields_integer(fields, &number);
        if (field == TRI_FIELD_BAD)
            return "has an endpoint that is not a number";
        if (field == TRI_FIELD_MISSING)
            return end == 0 ? "has no endpoints" : "has no second endpoint";
        const int32_t index = index_from(number, r->base);
        if (r->options->refining && !names_point(r->pslg, index))
            return "has an endpoint that is not the number of a vertex";
        r->pslg->segments[2 * i + end] = index;
    }
    return r->pslg->segment_markers ? tri_fields_marker(fields, &r->pslg->segment_markers[i]) : NULL;
}

/* Returns why the segment will be skipped, or NULL. */
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

/* Warns about each segment that will be skipped. The cursor, at the start of the segments, is used to find line
 * numbers. */
static void warn_of_segments(const struct reader *r, struct tri_cursor cursor)
{
    const struct tri_read_options *o = r->options;
    const size_t first = cursor.record;
    for (size_t i = 0; o->warn && i < (size_t)r->pslg->n_segments; i++) {
        const char *const reason = reason_to_skip(r->pslg, i);
        if (!reason)
            continue;
        struct tri_fields fields;
        while (cursor.record <= first + i && tri_cursor_next(&cursor, &fields))
            continue;
        struct tri_error warning; /* used as a buffer that formats and escapes text */
        tri_fail(&warning, TRI_BAD_INPUT, r->text.name, cursor.line, "segment %lld is ignored: %s",
                 (long long)i + r->base, reason);
        o->warn(o->warn_user, r->text.name, warning.line, warning.text);
    }
}

static void read_segments(struct reader *r)
{
    int64_t has_markers = 0;
    struct tri_pslg *out = r->pslg;
    const int64_t n = read_header(r, &segments, &has_markers, 1);
    const struct tri_cursor before = r->cursor;
    out->n_segments = (int32_t)n;
    out->segments = allocate(r, 2 * (size_t)n, sizeof *out->segments);
    out->segment_markers = has_markers > 0 ? allocate(r, (size_t)n, sizeof *out->segment_markers) : NULL;
    read_table(r, &segments, n, parse_segment, r);
    if (!r->status)
        warn_of_segments(r, before);
}

/* --- holes and regions */

static const char *parse_hole(void *user, size_t i, struct tri_fields *fields)
{
    double *const values = user;
    return tri_fields_point(fields, &values[2 * i]);
}

/* A single value is used both as attribute and as area bound. */
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

/* Reads a count, and that many records of n_values reals. */
static double *read_sites(struct reader *r, const struct section *section, size_t n_values,
                          const char *(*row)(void *, size_t, struct tri_fields *), int32_t *n)
{
    *n = (int32_t)read_header(r, section, NULL, 0);
    double *values = allocate(r, n_values * (size_t)*n, sizeof *values);
    read_table(r, section, *n, row, values);
    return values;
}

/* --- .poly */

enum tri_status tri_read_poly(const char *poly_path, const char *node_path, const struct tri_read_options *options,
                              struct tri_pslg *out, int32_t *base, bool *points_in_poly, struct tri_error *error)
{
    struct reader r = {.options = options, .pslg = out, .error = error};
    *out = (struct tri_pslg){0};
    begin_reading(&r, poly_path);
    *points_in_poly = read_vertices(&r, node_path, false);
    read_segments(&r);
    out->holes = read_sites(&r, &holes, 2, parse_hole, &out->n_holes);
    if (!r.status && (options->want_regions || (options->regions_if_any && tri_cursor_remaining(&r.cursor) > 0)))
        out->regions = read_sites(&r, &regions, 4, parse_region, &out->n_regions);
    *base = r.base;
    return end_reading(&r);
}

/* --- .ele */

/* Reads the nodes after the third. */
static void parse_extra(const struct reader *r, size_t i, struct tri_fields *fields)
{
    const int32_t n = r->elements->n_nodes - 3;
    int32_t *const extra = r->elements->extra ? r->elements->extra + i * (size_t)n : NULL;
    for (int32_t node = 0; node < n && (extra || tri_kind_at(fields->at) == TRI_IS_START); node++) {
        int64_t number;
        const bool good = tri_fields_integer(fields, &number) == TRI_FIELD_GOOD;
        const int32_t index = good ? index_from(number, r->base) : TRI_NONE;
        if (extra)
            extra[node] = index >= 0 && index < r->n_points ? index : TRI_NONE;
        if (!good)
            tri_fields_skip(fields);
    }
}

static const char *parse_element(void *user, size_t i, struct tri_fields *fields)
{
    const struct reader *const r = user;
    const struct tri_elements *const out = r->elements;
    tri_fields_skip(fields); /* its number */
    for (size_t corner = 0; corner < 3; corner++) {
        int64_t number;
        const enum tri_field field = tri_fields_integer(fields, &number);
        if (field != TRI_FIELD_GOOD)
            return field == TRI_FIELD_MISSING ? "has fewer than three corners" : "has a corner that is not a number";
        const int32_t index = index_from(number, r->base);
        if (index < 0 || index >= r->n_points)
            return "has a corner that is not the number of a vertex";
        out->corners[3 * i + corner] = index;
    }
    parse_extra(r, i, fields);
    return parse_attributes(fields, row_of(out->attributes, i, out->n_attributes), out->n_attributes);
}

static void read_elements(struct reader *r)
{
    int64_t more[] = {3, 0};
    struct tri_elements *const out = r->elements;
    const size_t n = (size_t)read_header(r, &triangles, more, 2);
    if (!r->status && (more[0] < 3 || more[0] > INT32_MAX))
        fail(r, TRI_BAD_INPUT, "the triangles have %lld nodes; 3 or more are needed", (long long)more[0]);
    check_attributes(r, more[1], (int64_t)n);
    if (r->status)
        return;
    const size_t extra = (size_t)more[0] - 3;
    out->n = (int32_t)n;
    out->n_nodes = (int32_t)more[0];
    out->n_attributes = (int32_t)more[1];
    out->corners = allocate(r, 3 * n, sizeof *out->corners);
    out->attributes = allocate(r, n * (size_t)out->n_attributes, sizeof *out->attributes);
    if (n > 0 && extra <= r->text.size / n)
        out->extra = allocate(r, n * extra, sizeof *out->extra);
    read_table(r, &triangles, out->n, parse_element, r);
}

enum tri_status tri_read_ele(const char *path, const struct tri_read_options *options, int32_t base, int32_t n_points,
                             struct tri_elements *out, struct tri_error *error)
{
    struct reader r = {.options = options, .elements = out, .base = base, .n_points = n_points, .error = error};
    *out = (struct tri_elements){0};
    begin_reading(&r, path);
    read_elements(&r);
    return end_reading(&r);
}

/* --- .area */

static const char *parse_bound(void *user, size_t i, struct tri_fields *fields)
{
    double *const areas = user;
    tri_fields_skip(fields); /* its number */
    return tri_fields_real(fields, &areas[i]) == TRI_FIELD_BAD ? "is not a finite number" : NULL;
}

enum tri_status tri_read_area(const char *path, const struct tri_read_options *options, int32_t base,
                              struct tri_elements *elements, struct tri_error *error)
{
    struct reader r = {.options = options, .base = base, .error = error};
    begin_reading(&r, path);
    const int64_t n = read_header(&r, &bounds, NULL, 0);
    if (!r.status && n != elements->n)
        fail(&r, TRI_BAD_INPUT, "there are %lld area bounds, but %ld triangles", (long long)n, (long)elements->n);
    elements->areas = allocate(&r, (size_t)n, sizeof *elements->areas);
    read_table(&r, &bounds, n, parse_bound, elements->areas);
    if (r.status) {
        free(elements->areas);
        elements->areas = NULL;
    }
    return end_reading(&r);
}
