/* Headers and tables, as in triangle/text/read.c, with numbers of 64 bits. */
#include "drivers/judge/judged_text.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/grow.h"
#include "triangle/base/system.h"
#include "triangle/text/text.h"

enum { STRETCH = 1 << 22, ROWS = 1 << 17, N_FIELDS = 4 }; /* bytes of text in a stretch; most rows in it */

/* --- rows of numbers, one after the other without gaps */

/* Opens rows in a file of that folder; NULL: in memory. */
static enum tri_status open_rows(struct scratch *s, const char *folder, size_t width, struct tri_error *error)
{
    *s = (struct scratch){.file = folder ? tri_scratch_file(folder) : TRI_NO_FILE, .width = width};
    if (folder && s->file == TRI_NO_FILE)
        return tri_fail_system(error, TRI_CANNOT_WRITE, folder, "cannot make a scratch file there", errno);
    return TRI_OK;
}

/* Appends rows, any number of times; then they are read. */
static enum tri_status append_rows(struct scratch *s, const void *rows, int64_t n, struct tri_error *error)
{
    const int64_t at = s->n * (int64_t)s->width, size = n * (int64_t)s->width;
    if (s->file == TRI_NO_FILE && !tri_grow_far(&s->bytes, &s->room, at + size, 1))
        return tri_fail(error, TRI_NO_MEMORY, "", 0, "out of memory");
    if (s->file == TRI_NO_FILE && size > 0)
        memcpy(s->bytes + at, rows, (size_t)size);
    if (s->file != TRI_NO_FILE && !tri_write_at(s->file, rows, (size_t)size, (uint64_t)at))
        return tri_fail_system(error, TRI_CANNOT_WRITE, "", "cannot write a scratch file", errno);
    s->n += n;
    return TRI_OK;
}

static enum tri_status read_rows(const struct scratch *s, int64_t first, int64_t n, void *rows, struct tri_error *error)
{
    if (s->file == TRI_NO_FILE)
        memcpy(rows, s->bytes + first * (int64_t)s->width, (size_t)n * s->width);
    else if (!tri_read_back(s->file, rows, (size_t)n * s->width, (uint64_t)first * s->width))
        return tri_fail(error, TRI_CANNOT_READ, "", 0, "cannot read a scratch file");
    return TRI_OK;
}

static void close_rows(struct scratch *s)
{
    if (s->width > 0)
        (void)tri_file_close(s->file);
    free(s->bytes);
    *s = (struct scratch){.file = TRI_NO_FILE};
}

/* --- text */

/* Rows of one table in the current stretch of text, in the arrays that the table has. */
struct rows {
    struct judged_text *text;
    struct tri_window *window;
    const struct tri_executor *executor;
    double *reals;    /* points, or attributes */
    double *further;  /* attributes of points */
    int64_t *numbers; /* corners, neighbours or ends */
    int64_t *middles; /* midpoints of edges */
    int32_t *markers;
    int64_t fields[N_FIELDS]; /* numbers of the header */
    int64_t largest;  /* largest corner so far */
    enum tri_check_array array;
};

static enum tri_status read_header(struct rows *r, int n, const char *nouns, struct tri_error *error)
{
    struct tri_fields fields;
    bool found;
    enum tri_status status = tri_window_next(r->window, &fields, &found, error);
    const char *name = r->window->text.name;
    int64_t line = r->window->cursor.line;
    if (!status && !found) /* errors have a line number, also in an empty file */
        return tri_fail(error, TRI_BAD_INPUT, name, line > 0 ? line : 1,
                        "unexpected end of file: the number of %s is missing", nouns);
    for (int i = 0; i < n && !status; i++) {
        int64_t value;
        enum tri_field field = tri_fields_integer(&fields, &value);
        if (i == 0 && field != TRI_FIELD_GOOD)
            return tri_fail(error, TRI_BAD_INPUT, name, line, "the number of %s is not a number", nouns);
        if (field == TRI_FIELD_BAD)
            return tri_fail(error, TRI_BAD_INPUT, name, line, "field %d of the header of the %s is not a number", i + 1,
                            nouns);
        r->fields[i] = field == TRI_FIELD_GOOD ? value : r->fields[i];
    }
    if (!status && r->fields[0] < 0)
        return tri_fail(error, TRI_BAD_INPUT, name, line, "the number of %s is negative", nouns);
    if (!status && r->fields[0] > INT64_MAX / 64)
        return tri_fail(error, TRI_BAD_INPUT, name, line, "%lld %s cannot be", (long long)r->fields[0], nouns);
    return status;
}

/* --- rows */

/* Keeps the last field, or all of them, in n places. */
static const char *parse_attributes(struct tri_fields *fields, int64_t n, double *last, bool all)
{
    for (int64_t i = 0; i < n; i++)
        if (tri_fields_real(fields, all ? last + i : last) == TRI_FIELD_BAD)
            return "has an attribute that is not a finite number";
    return NULL;
}

static const char *parse_vertex(void *user, size_t i, struct tri_fields *fields)
{
    struct rows *r = user;
    const char *fault = tri_fields_point(fields, &r->reals[2 * i]);
    if (!fault)
        fault = parse_attributes(fields, r->fields[2], r->further + r->fields[2] * (int64_t)i, true);
    return fault || r->fields[3] <= 0 ? fault : tri_fields_marker(fields, &r->markers[i]);
}

/* Reads a number that counts from the base. A number beyond the vertices is kept. */
static enum tri_field parse_number(struct tri_fields *fields, int64_t base, int64_t *out)
{
    const enum tri_field field = tri_fields_integer(fields, out);
    *out = *out < 0 ? -1 : *out - base;
    return field;
}

static const char *parse_element(void *user, size_t i, struct tri_fields *fields)
{
    struct rows *r = user;
    int64_t *corner = r->numbers + 3 * i, *middle = r->middles + 3 * i, extra;
    tri_fields_skip(fields); /* the row's own number */
    for (int k = 0; k < 3; k++) {
        const enum tri_field field = parse_number(fields, r->text->base, &corner[k]);
        if (field != TRI_FIELD_GOOD)
            return field == TRI_FIELD_MISSING ? "has fewer than three corners" : "has a corner that is not a number";
        if (corner[k] < 0 || corner[k] >= r->text->n_nodes)
            return "has a corner that is not the number of a vertex";
    }
    for (int64_t k = 3; k < r->fields[1]; k++) {
        const bool good = parse_number(fields, r->text->base, &extra) == TRI_FIELD_GOOD;
        if (!good)
            tri_fields_skip(fields);
        if (k < 6)
            middle[k - 3] = good ? extra : -1;
    }
    for (int64_t k = r->fields[1]; k < 6; k++)
        middle[k - 3] = -1;
    return parse_attributes(fields, r->fields[2], &r->reals[i], false);
}

static const char *parse_segment(void *user, size_t i, struct tri_fields *fields)
{
    struct rows *r = user;
    tri_fields_skip(fields); /* the row's own number */
    for (size_t end = 0; end < 2; end++) {
        const enum tri_field field = parse_number(fields, r->text->base, &r->numbers[2 * i + end]);
        if (field == TRI_FIELD_BAD)
            return "has an endpoint that is not a number";
        if (field == TRI_FIELD_MISSING)
            return end == 0 ? "has no endpoints" : "has no second endpoint";
    }
    return r->fields[1] > 0 ? tri_fields_marker(fields, &r->markers[i]) : NULL;
}

static const char *parse_neighbors(void *user, size_t i, struct tri_fields *fields)
{
    struct rows *r = user;
    int64_t value;
    tri_fields_skip(fields); /* the row's own number */
    for (size_t k = 0; k < 3; k++) {
        if (tri_fields_integer(fields, &value) != TRI_FIELD_GOOD)
            return "lacks a neighbor";
        if (value < -1)
            return "has a neighbor that is no triangle";
        r->numbers[3 * i + k] = value < 0 ? -1 : value - r->text->base;
    }
    return NULL;
}

/* --- tables */

static enum tri_status append(struct rows *r, enum tri_check_array array, const void *rows, size_t n,
                              struct tri_error *error)
{
    bool given = (r->text->given >> array & 1) != 0;
    return given ? append_rows(&r->text->array[array], rows, (int64_t)n, error) : TRI_OK;
}

static enum tri_status append_middles(struct rows *r, size_t n, struct tri_error *error)
{
    int64_t least = r->text->least_middle;
    for (size_t i = 0; i < 3 * n; i++)
        least = r->middles[i] >= 0 && r->middles[i] < least ? r->middles[i] : least;
    r->text->least_middle = least;
    return append(r, TRI_CHECK_MIDDLES, r->middles, n, error);
}

static enum tri_status flush(void *user, size_t n, struct tri_error *error)
{
    struct rows *r = user;
    bool points = r->array == TRI_CHECK_POINTS, corners = r->array == TRI_CHECK_CORNERS;
    enum tri_status status = append(r, r->array, points ? (void *)r->reals : (void *)r->numbers, n, error);
    for (size_t i = 0; corners && i < 3 * n; i++)
        r->largest = r->numbers[i] > r->largest ? r->numbers[i] : r->largest;
    if (!status && corners)
        status = append(r, TRI_CHECK_ATTRIBUTES, r->reals, n, error);
    if (!status && corners && r->fields[1] > 3)
        status = append_middles(r, n, error);
    if (!status && points)
        status = append(r, TRI_CHECK_POINT_ATTRIBUTES, r->further, n, error);
    if (!status && points)
        status = append(r, TRI_CHECK_POINT_MARKERS, r->markers, n, error);
    if (!status && r->array == TRI_CHECK_SEGMENT_ENDS)
        status = append(r, TRI_CHECK_SEGMENT_MARKERS, r->markers, n, error);
    return status;
}

static enum tri_status read_table(struct rows *r, enum tri_check_array array, const char *noun, const char *nouns,
                                  const char *(*row)(void *, size_t, struct tri_fields *), struct tri_error *error)
{
    struct tri_table table = {noun, (size_t)r->fields[0], r->text->base, row, r};
    r->array = array;
    return tri_window_table(r->window, &table, nouns, ROWS, flush, error);
}

/* Marks the array as given, and opens its file. */
static enum tri_status open_array(struct judged_text *t, enum tri_check_array array, size_t width, const char *folder,
                                  struct tri_error *error)
{
    t->given |= 1u << array;
    return open_rows(&t->array[array], folder, width, error);
}

/* --- files */

static enum tri_status detect_base(struct rows *r, struct tri_error *error)
{
    struct tri_fields fields;
    bool found;
    int64_t number;
    enum tri_status status = tri_window_peek(r->window, &fields, &found, error);
    bool good = !status && found && tri_fields_integer(&fields, &number) == TRI_FIELD_GOOD;
    r->text->base = good && number == 0 ? 0 : 1;
    return status;
}

/* A few fields may be missing in every record. */
static enum tri_status check_attributes(const struct rows *r, struct tri_error *error)
{
    enum { FREE_ATTRIBUTES = 64 };
    const int64_t n = r->fields[2];
    const char *name = r->window->text.name;
    const int64_t line = r->window->cursor.line;
    struct tri_file_facts facts;
    if (n < 0)
        return tri_fail(error, TRI_BAD_INPUT, name, line, "the number of attributes is negative");
    if (n > FREE_ATTRIBUTES && r->fields[0] > 0 && tri_file_get_facts(r->window->file, &facts) &&
        (n > INT32_MAX || n > (int64_t)facts.size / r->fields[0]))
        return tri_fail(error, TRI_BAD_INPUT, name, line, "%lld attributes are announced, more than the file can hold",
                        (long long)n);
    return TRI_OK;
}

/* Makes room for the points of the current stretch. */
static enum tri_status open_attributes(struct rows *r, const char *folder, struct tri_error *error)
{
    const int64_t n = r->fields[2], rows = r->fields[0] < ROWS ? r->fields[0] : ROWS;
    enum tri_status status = check_attributes(r, error);
    if (status)
        return status;
    r->text->n_attributes = n < INT32_MAX ? (int32_t)n : INT32_MAX;
    free(r->further);
    r->further = n <= INT32_MAX ? malloc((size_t)(n * rows + 1) * sizeof *r->further) : NULL;
    if (!r->further)
        return tri_fail(error, TRI_NO_MEMORY, r->window->text.name, r->window->cursor.line,
                        "no memory for %lld attributes", (long long)n);
    return n == 0 ? TRI_OK : open_array(r->text, TRI_CHECK_POINT_ATTRIBUTES, (size_t)n * sizeof(double), folder, error);
}

/* Handles the header of points: count, dimension, attributes, markers. */
static enum tri_status read_vertices(struct rows *r, const char *folder, struct tri_error *error)
{
    struct judged_text *t = r->text;
    if (r->fields[1] != 2)
        return tri_fail(error, TRI_BAD_INPUT, r->window->text.name, r->window->cursor.line,
                        "the vertices have %lld coordinates instead of 2", (long long)r->fields[1]);
    t->n_points = t->n_nodes = r->fields[0];
    enum tri_status status = detect_base(r, error);
    if (!status)
        status = open_array(t, TRI_CHECK_POINTS, 2 * sizeof(double), folder, error);
    if (!status && r->fields[3] > 0)
        status = open_array(t, TRI_CHECK_POINT_MARKERS, sizeof(int32_t), folder, error);
    if (!status)
        status = open_attributes(r, folder, error);
    return status ? status : read_table(r, TRI_CHECK_POINTS, "vertex", "vertices", parse_vertex, error);
}

static enum tri_status read_segments(struct rows *r, const char *folder, struct tri_error *error)
{
    r->fields[1] = 0;
    enum tri_status status = read_header(r, 2, "segments", error);
    if (!status)
        status = open_array(r->text, TRI_CHECK_SEGMENT_ENDS, 2 * sizeof(int64_t), folder, error);
    if (!status && r->fields[1] > 0)
        status = open_array(r->text, TRI_CHECK_SEGMENT_MARKERS, sizeof(int32_t), folder, error);
    return status ? status : read_table(r, TRI_CHECK_SEGMENT_ENDS, "segment", "segments", parse_segment, error);
}

static enum tri_status read_node(struct rows *r, const char *folder, struct tri_error *error)
{
    memcpy(r->fields, (int64_t[N_FIELDS]){0, 2, 0, 0}, sizeof r->fields);
    enum tri_status status = read_header(r, N_FIELDS, "vertices", error);
    return status ? status : read_vertices(r, folder, error);
}

static enum tri_status read_ele(struct rows *r, const char *folder, struct tri_error *error)
{
    struct judged_text *t = r->text;
    memcpy(r->fields, (int64_t[N_FIELDS]){0, 3, 0, 0}, sizeof r->fields);
    enum tri_status status = read_header(r, 3, "triangles", error);
    if (!status && r->fields[1] < 3)
        return tri_fail(error, TRI_BAD_INPUT, r->window->text.name, r->window->cursor.line,
                        "the triangles have %lld nodes; 3 or more are needed", (long long)r->fields[1]);
    if (!status)
        status = check_attributes(r, error);
    if (!status)
        status = open_array(t, TRI_CHECK_CORNERS, 3 * sizeof(int64_t), folder, error);
    if (!status && r->fields[2] > 0)
        status = open_array(t, TRI_CHECK_ATTRIBUTES, sizeof(double), folder, error);
    if (!status && r->fields[1] == 6)
        status = open_array(t, TRI_CHECK_MIDDLES, 3 * sizeof(int64_t), folder, error);
    if (!status)
        status = read_table(r, TRI_CHECK_CORNERS, "triangle", "triangles", parse_element, error);
    if (r->fields[1] > 3) /* midpoints of edges have the highest numbers */
        t->n_points = r->largest + 1;
    return status;
}

static enum tri_status read_neigh(struct rows *r, const char *folder, struct tri_error *error)
{
    struct judged_text *t = r->text;
    enum tri_status status = read_header(r, 1, "triangles", error);
    t->stale_neighbors = !status && r->fields[0] != t->array[TRI_CHECK_CORNERS].n; /* the file remains from an
                                                                                      earlier run */
    if (status || t->stale_neighbors)
        return status;
    status = open_array(t, TRI_CHECK_NEIGHBORS_GIVEN, 3 * sizeof(int64_t), folder, error);
    return status ? status : read_table(r, TRI_CHECK_NEIGHBORS_GIVEN, "triangle", "triangles", parse_neighbors, error);
}

/* Reads one file, if it exists. */
static enum tri_status read_file(struct rows *r, const char *path, const char *folder,
                                 enum tri_status (*take)(struct rows *r, const char *folder, struct tri_error *error),
                                 struct tri_error *error)
{
    struct tri_window window;
    if (path == NULL)
        return TRI_OK;
    enum tri_status status = tri_window_open(&window, path, STRETCH, r->executor, error);
    r->window = &window;
    if (!status)
        status = take(r, folder, error);
    r->window = NULL;
    tri_window_free(&window);
    return status;
}

/* Reads a .poly file up to its segments, with its own vertices if it has any. */
static enum tri_status read_poly(struct rows *r, const char *folder, struct tri_error *error)
{
    memcpy(r->fields, (int64_t[N_FIELDS]){0, 2, 0, 0}, sizeof r->fields);
    enum tri_status status = read_header(r, N_FIELDS, "vertices", error);
    if (!status && r->fields[0] > 0)
        status = read_vertices(r, folder, error);
    else if (!status && r->text->given == 0)
        return TRI_OK; /* the points are in the .node file; this file is read again after it */
    return status ? status : read_segments(r, folder, error);
}

static enum tri_status read_all(struct rows *r, const struct judged_names *names, const char *folder,
                                struct tri_error *error)
{
    enum tri_status status = read_file(r, names->poly, folder, read_poly, error);
    if (!status && r->text->given == 0) {
        status = read_file(r, names->node, folder, read_node, error);
        status = status ? status : read_file(r, names->poly, folder, read_poly, error);
    }
    if (!status)
        status = read_file(r, names->ele, folder, read_ele, error);
    return status ? status : read_file(r, names->neigh, folder, read_neigh, error);
}

enum tri_status judged_text_read(struct judged_text *t, const struct judged_names *names, const char *folder,
                                 const struct tri_executor *executor, struct tri_error *error)
{
    *t = (struct judged_text){.base = 1, .least_middle = INT64_MAX};
    struct rows r = {.text = t, .executor = executor, .largest = -1};
    r.reals = malloc(2 * ROWS * sizeof *r.reals);
    r.numbers = malloc(3 * ROWS * sizeof *r.numbers);
    r.middles = malloc(3 * ROWS * sizeof *r.middles);
    r.markers = malloc(ROWS * sizeof *r.markers);
    enum tri_status status = r.reals && r.numbers && r.middles && r.markers
                                 ? read_all(&r, names, folder, error)
                                 : tri_fail(error, TRI_NO_MEMORY, "", 0, "out of memory");
    free(r.reals);
    free(r.further);
    free(r.numbers);
    free(r.middles);
    free(r.markers);
    return status;
}

void judged_text_close(struct judged_text *t)
{
    for (int k = 0; k < TRI_CHECK_N_ARRAYS; k++)
        close_rows(&t->array[k]);
}

static enum tri_status read_slice(void *user, enum tri_check_array array, int64_t first, int64_t n, void *out,
                                  struct tri_error *error)
{
    const struct judged_text *t = user;
    return read_rows(&t->array[array], first, n, out, error);
}

struct tri_check_source judged_text_source(struct judged_text *t)
{
    return (struct tri_check_source){.n_points = t->n_points, .n_triangles = t->array[TRI_CHECK_CORNERS].n,
                                     .n_segments = t->array[TRI_CHECK_SEGMENT_ENDS].n, .n_nodes = t->n_nodes,
                                     .n_point_attributes = t->n_attributes, .given = t->given, .read = read_slice,
                                     .user = t};
}
