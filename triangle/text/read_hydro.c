/* Reads SMS (.2dm) and ADCIRC (fort.14), as triangle/text/hydro.c writes them. In both formats node numbers are
 * arbitrary.
 *
 * Default values are ignored: if all elevations are 0, or all materials are 1, there is no attribute. In fort.14 the
 * marker of a segment is 2 on open boundaries, the type on land boundaries of type 10 or above, and otherwise 1; the
 * mesh that was written may have had other markers. All segments are on the boundary, because neither format stores
 * inner ones. */
#include <stdlib.h>
#include <string.h>

#include "triangle/base/grow.h"
#include "triangle/text/formats.h"
#include "triangle/text/reading.h"
#include "triangle/text/text.h"

struct reading {
    struct tri_reading to;
    struct tri_text text;
    struct tri_tags nodes;
    double *z;                   /* [n_points] */
    int64_t most_ends, most_markers; /* capacity of the arrays of segments */
};

#define FAIL(r, line, ...) tri_reading_fail(&(r)->to, TRI_BAD_INPUT, line, __VA_ARGS__)

/* --- common parts */

static bool begin_nodes(struct reading *r, int64_t n)
{
    r->z = malloc(((size_t)n + 1) * sizeof *r->z);
    return tri_tags_begin_nodes(&r->nodes, n, &r->to) && (r->z || tri_reading_no_memory(&r->to));
}

/* Reads number, position and elevation of a node. */
static const char *parse_node(void *user, size_t i, struct tri_fields *fields)
{
    struct reading *r = user;
    if (tri_fields_integer(fields, &r->nodes.tag[i]) != TRI_FIELD_GOOD)
        return "has no number";
    for (size_t c = 0; c < 2; c++)
        if (tri_fields_real(fields, &r->to.mesh->points[2 * i + c]) != TRI_FIELD_GOOD)
            return "has a coordinate that is missing or not finite";
    return tri_fields_real(fields, &r->z[i]) == TRI_FIELD_BAD ? "has an elevation that is not finite" : NULL;
}

/* Reads a node tag and returns the node number; -1: there is no such node. */
static int32_t parse_node_number(const struct reading *r, struct tri_fields *fields)
{
    int64_t tag;
    return tri_fields_integer(fields, &tag) == TRI_FIELD_GOOD ? (int32_t)tri_tags_place(&r->nodes, tag) : -1;
}

static bool add_segment(struct reading *r, int32_t from, int32_t to, int32_t marker)
{
    struct tri_pslg *m = r->to.mesh;
    const int64_t n = m->n_segments;
    if (n == INT32_MAX || !tri_grow_far(&m->segments, &r->most_ends, 2 * (n + 1), sizeof *m->segments) ||
        !tri_grow_far(&m->segment_markers, &r->most_markers, n + 1, sizeof *m->segment_markers))
        return tri_reading_no_memory(&r->to);
    m->segments[2 * n] = from;
    m->segments[2 * n + 1] = to;
    m->segment_markers[n] = marker;
    m->n_segments++;
    return true;
}

/* Stores the elevations as the attribute of the points, unless all are 0. */
static void store_elevations(struct reading *r)
{
    bool any = false;
    for (int32_t i = 0; i < r->to.mesh->n_points; i++)
        any = any || r->z[i] != 0;
    r->to.mesh->n_attributes = any;
    r->to.mesh->attributes = any ? r->z : NULL;
    if (any)
        r->z = NULL;
}

static enum tri_status read_with(bool (*read)(struct reading *r), const char *path, struct tri_pslg *mesh,
                                 struct tri_elements *elements, const struct tri_executor *executor,
                                 struct tri_error *error)
{
    struct reading r = {.to = {path, executor, mesh, elements, error, TRI_OK}};
    r.to.status = tri_text_load(&r.text, path, 0, executor, NULL, error);
    if (!r.to.status && read(&r))
        store_elevations(&r);
    tri_text_free(&r.text);
    tri_tags_free(&r.nodes);
    free(r.z);
    return r.to.status;
}

/* --- fort.14: title, numbers of elements and nodes, nodes, elements, open boundaries, land boundaries */

static const char *parse_element(void *user, size_t i, struct tri_fields *fields)
{
    struct reading *r = user;
    int64_t n;
    tri_fields_skip(fields);
    if (tri_fields_integer(fields, &n) != TRI_FIELD_GOOD || n != 3)
        return "is not a triangle";
    for (size_t k = 0; k < 3; k++)
        if ((r->to.elements->corners[3 * i + k] = parse_node_number(r, fields)) < 0)
            return "has a corner that is not a node";
    return NULL;
}

/* Reads the first one or two numbers of the next record. Returns false if they are missing or negative. */
static bool read_counts(struct tri_cursor *cursor, int64_t *a, int64_t *b)
{
    struct tri_fields fields;
    bool good = tri_cursor_next(cursor, &fields) && tri_fields_integer(&fields, a) == TRI_FIELD_GOOD && *a >= 0;
    return good && (!b || (tri_fields_integer(&fields, b) == TRI_FIELD_GOOD && *b >= 0));
}

static bool is_closed_type(int64_t type) { return type == 1 || type == 11 || type == 21; }

/* Reads n nodes, one per line. */
static bool read_string(struct reading *r, struct tri_cursor *cursor, int64_t n, bool closed, int32_t marker)
{
    int32_t first = -1, last = -1;
    for (int64_t i = 0; i < n; i++) {
        struct tri_fields fields;
        const int32_t node = tri_cursor_next(cursor, &fields) ? parse_node_number(r, &fields) : -1;
        if (node < 0)
            return FAIL(r, cursor->line, "a node of a boundary is missing or does not exist");
        if (i > 0 && !add_segment(r, last, node, marker))
            return false;
        first = i == 0 ? node : first;
        last = node;
    }
    return !closed || first == last || add_segment(r, last, first, marker);
}

/* Reads the number of boundaries, the number of their nodes, and each boundary. */
static bool read_boundaries(struct reading *r, struct tri_cursor *cursor, bool open)
{
    int64_t n, n_nodes;
    if (!read_counts(cursor, &n, NULL) || !read_counts(cursor, &n_nodes, NULL))
        return FAIL(r, cursor->line, "the numbers of boundaries and of their nodes are missing");
    for (int64_t i = 0; i < n; i++) {
        int64_t type = 0;
        if (!read_counts(cursor, &n_nodes, open ? NULL : &type))
            return FAIL(r, cursor->line, "the number of nodes of a boundary, or its type, is missing");
        const int32_t marker = open ? TRI_OPEN_BOUNDARY : type >= 10 && type < 100 ? (int32_t)type : 1;
        if (!read_string(r, cursor, n_nodes, !open && is_closed_type(type), marker))
            return false;
    }
    return true;
}

static bool read_table(struct reading *r, struct tri_cursor *cursor, struct tri_table table)
{
    r->to.status = tri_cursor_table(cursor, &table, r->to.executor, r->to.error);
    return !r->to.status;
}

static bool read_14(struct reading *r)
{
    struct tri_cursor cursor = tri_cursor_begin(&r->text);
    struct tri_fields fields;
    int64_t n_elements, n_nodes;
    if (tri_fields_open(&fields, r->text.data, r->text.data + r->text.size)) /* skip a title with a number */
        (void)tri_cursor_next(&cursor, &fields);
    if (!read_counts(&cursor, &n_elements, &n_nodes))
        return FAIL(r, cursor.line, "the numbers of elements and nodes are missing");
    const size_t left = tri_cursor_remaining(&cursor);
    if ((uint64_t)n_nodes > left || (uint64_t)n_elements > left - (size_t)n_nodes || n_nodes > INT32_MAX ||
        n_elements > INT32_MAX)
        return FAIL(r, cursor.line, "%lld nodes and %lld elements are announced, but only %zu records follow",
                    (long long)n_nodes, (long long)n_elements, left);
    return begin_nodes(r, n_nodes) && tri_reading_triangles(&r->to, n_elements, 3) &&
           read_table(r, &cursor, (struct tri_table){"node", (size_t)n_nodes, 1, parse_node, r}) &&
           tri_tags_order(&r->nodes, "node", &r->to) &&
           read_table(r, &cursor, (struct tri_table){"element", (size_t)n_elements, 1, parse_element, r}) &&
           read_boundaries(r, &cursor, true) && read_boundaries(r, &cursor, false);
}

enum tri_status tri_read_14(const char *path, struct tri_pslg *mesh, struct tri_elements *elements,
                            const struct tri_executor *executor, struct tri_error *error)
{
    return read_with(read_14, path, mesh, elements, executor, error);
}

/* --- .2dm: cards in any order, each starting with a word */

enum card { CARD_NODE, CARD_TRIANGLE, CARD_SIX_NODES, CARD_STRING, CARD_UNKNOWN, CARDS, CARD_NONE };

struct cards {
    const char *at, *end;
    size_t line;
    enum card card; /* card of the current line */
    struct tri_fields fields; /* the fields after its word */
};

static bool is_word(const char *at, const char *word, size_t n)
{
    return strlen(word) == n && memcmp(at, word, n) == 0;
}

/* Other elements, such as quadrilaterals, are CARD_UNKNOWN; other cards are ignored. */
static enum card card_of(const char *word, size_t n)
{
    if (is_word(word, "ND", n))
        return CARD_NODE;
    if (is_word(word, "E3T", n))
        return CARD_TRIANGLE;
    if (is_word(word, "E6T", n))
        return CARD_SIX_NODES;
    if (is_word(word, "NS", n))
        return CARD_STRING;
    return n == 3 && word[0] == 'E' && word[1] >= '2' && word[1] <= '9' ? CARD_UNKNOWN : CARD_NONE;
}

static bool next_card(struct cards *c)
{
    if (c->at == c->end)
        return false;
    const char *word = c->at, *newline = memchr(c->at, '\n', (size_t)(c->end - c->at));
    while (*word == ' ' || *word == '\t')
        word++;
    const char *behind = word;
    while (*behind != '\n' && *behind != '\r' && *behind != ' ' && *behind != '\t')
        behind++;
    c->card = card_of(word, (size_t)(behind - word));
    c->fields = (struct tri_fields){behind, c->end, false};
    tri_fields_seek(&c->fields);
    c->at = newline + 1;
    c->line++;
    return true;
}

static struct cards all_cards(const struct reading *r)
{
    return (struct cards){.at = r->text.data, .end = r->text.data + r->text.size};
}

static bool count_cards(struct reading *r, int64_t count[CARDS])
{
    for (struct cards c = all_cards(r); next_card(&c);) {
        if (c.card == CARD_UNKNOWN)
            return FAIL(r, c.line, "an element is not a triangle");
        if (c.card != CARD_NONE)
            count[c.card]++;
    }
    if (count[CARD_TRIANGLE] > 0 && count[CARD_SIX_NODES] > 0)
        return FAIL(r, 0, "the mesh has triangles of three nodes and of six nodes");
    if (count[CARD_NODE] > INT32_MAX || count[CARD_TRIANGLE] + count[CARD_SIX_NODES] > INT32_MAX)
        return tri_reading_fail(&r->to, TRI_TOO_LARGE, 0, "too many nodes or triangles");
    return true;
}

static bool read_nodes(struct reading *r)
{
    size_t i = 0;
    for (struct cards c = all_cards(r); next_card(&c);) {
        const char *wrong = c.card == CARD_NODE ? parse_node(r, i++, &c.fields) : NULL;
        if (wrong)
            return FAIL(r, c.line, "node %zu %s", i, wrong);
    }
    return tri_tags_order(&r->nodes, "node", &r->to);
}

/* In the file, nodes go around the triangle, starting at a corner. Here, the corners come first, then the midpoints
 * opposite each. */
static bool parse_corners(struct reading *r, int64_t i, struct tri_fields *fields)
{
    static const int place_of_three[] = {0, 1, 2}, place_of_six[] = {0, 5, 1, 3, 2, 4};
    struct tri_elements *e = r->to.elements;
    tri_fields_skip(fields);
    for (int k = 0; k < e->n_nodes; k++) {
        const int place = e->n_nodes == 3 ? place_of_three[k] : place_of_six[k];
        const int32_t node = parse_node_number(r, fields);
        if (node < 0)
            return false;
        if (place < 3)
            e->corners[3 * i + place] = node;
        else
            e->extra[3 * i + place - 3] = node;
    }
    return true;
}

static bool read_triangles(struct reading *r)
{
    struct tri_elements *e = r->to.elements;
    double *material = malloc(((size_t)e->n + 1) * sizeof *material);
    int64_t i = 0;
    bool any = false;
    if (!material)
        return tri_reading_no_memory(&r->to);
    e->attributes = material;
    for (struct cards c = all_cards(r); next_card(&c);) {
        if (c.card != CARD_TRIANGLE && c.card != CARD_SIX_NODES)
            continue;
        if (!parse_corners(r, i, &c.fields))
            return FAIL(r, c.line, "a triangle has a node that is missing or does not exist");
        if (tri_fields_real(&c.fields, &material[i]) != TRI_FIELD_GOOD)
            material[i] = 1;
        any = any || material[i] != 1;
        i++;
    }
    e->n_attributes = any;
    if (!any) {
        free(material);
        e->attributes = NULL;
    }
    return true;
}

/* A string may extend over several lines. It ends with a negative number, which is followed by its marker. */
static bool read_strings(struct reading *r)
{
    int32_t last = -1;
    int64_t first = 0; /* first segment of the string */
    for (struct cards c = all_cards(r); next_card(&c);) {
        int64_t tag, marker = 0;
        bool ends = false;
        while (c.card == CARD_STRING && !ends && tri_fields_integer(&c.fields, &tag) == TRI_FIELD_GOOD) {
            ends = tag < 0 && tag > INT64_MIN;
            const int32_t node = (int32_t)tri_tags_place(&r->nodes, ends ? -tag : tag);
            if (node < 0)
                return FAIL(r, c.line, "a node string has a node that does not exist");
            if (last >= 0 && !add_segment(r, last, node, 0))
                return false;
            last = node;
        }
        if (!ends)
            continue;
        if (tri_fields_integer(&c.fields, &marker) != TRI_FIELD_GOOD || marker < INT32_MIN || marker > INT32_MAX)
            marker = 0;
        for (; first < r->to.mesh->n_segments; first++)
            r->to.mesh->segment_markers[first] = (int32_t)marker;
        last = -1;
    }
    return last < 0 || FAIL(r, 0, "a node string has no end");
}

static bool read_2dm(struct reading *r)
{
    int64_t count[CARDS] = {0};
    if (!count_cards(r, count))
        return false;
    if (count[CARD_NODE] == 0)
        return FAIL(r, 0, "no mesh: the file has no nodes (ND)");
    const int n_nodes = count[CARD_SIX_NODES] > 0 ? 6 : 3;
    return begin_nodes(r, count[CARD_NODE]) &&
           tri_reading_triangles(&r->to, count[CARD_TRIANGLE] + count[CARD_SIX_NODES], n_nodes) && read_nodes(r) &&
           read_triangles(r) && read_strings(r);
}

enum tri_status tri_read_2dm(const char *path, struct tri_pslg *mesh, struct tri_elements *elements,
                             const struct tri_executor *executor, struct tri_error *error)
{
    return read_with(read_2dm, path, mesh, elements, executor, error);
}
