/* Reads size fields from text files of Gmsh: meshes of version 2.2 and 4.1 with numbers at nodes (the first $NodeData
 * with one component), and parsed views (.pos) of scalar triangles, lines and points. Only x and y are used; z is
 * ignored. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/grow.h"
#include "triangle/text/size_file.h"

/* --- .msh */

struct gmsh {
    struct tri_words *words;
    bool blocks; /* version 4.1: nodes and elements are stored in blocks */
    struct tri_tags nodes;
    int64_t n_nodes, n_triangles; /* number read so far */
};

static bool read_int(struct gmsh *g, const char *what, int64_t *value)
{
    return tri_words_whole(g->words, what, INT64_MIN, INT64_MAX, value);
}

static bool read_position(struct gmsh *g, double *xy)
{
    double z;
    return tri_words_real(g->words, "a coordinate", true, &xy[0]) &&
           tri_words_real(g->words, "a coordinate", true, &xy[1]) &&
           tri_words_real(g->words, "a coordinate", true, &z);
}

/* Reads the number of blocks, the number of items, and their least and greatest tags; in version 2.2 only the number of
 * items. */
static bool read_totals(struct gmsh *g, const char *what, int64_t *blocks, int64_t *n)
{
    int64_t tag;
    *blocks = 1;
    if (g->blocks && !tri_words_count(g->words, "the number of blocks", 2, blocks))
        return false;
    return tri_words_count(g->words, what, 2, n) &&
           (!g->blocks || (read_int(g, "the least tag", &tag) && read_int(g, "the greatest tag", &tag)));
}

/* Reads the head of a block: its dimension, its tag, a kind, and the number of items. */
static bool read_block_head(struct gmsh *g, int64_t *kind, int64_t left, int64_t *n)
{
    int64_t entity;
    return read_int(g, "a dimension", &entity) && read_int(g, "the tag of a block", &entity) &&
           read_int(g, "the kind of a block", kind) && tri_words_whole(g->words, "the size of a block", 0, left, n);
}

static bool read_node_block(struct gmsh *g, int64_t n)
{
    double *xy = g->words->to.mesh->points + 2 * g->n_nodes;
    for (int64_t i = 0; i < n; i++)
        if (!read_int(g, "the tag of a node", &g->nodes.tag[g->n_nodes + i]) ||
            (!g->blocks && !read_position(g, xy + 2 * i)))
            return false;
    for (int64_t i = 0; i < n && g->blocks; i++)
        if (!read_position(g, xy + 2 * i))
            return false;
    g->n_nodes += n;
    return true;
}

static bool read_nodes(struct gmsh *g)
{
    int64_t blocks, n, parametric;
    if (g->nodes.tag)
        return TRI_WORDS_FAIL(g->words, "$Nodes occurs twice");
    if (!read_totals(g, "the number of nodes", &blocks, &n) || !tri_tags_begin_nodes(&g->nodes, n, &g->words->to))
        return false;
    for (int64_t b = 0; b < blocks; b++) {
        int64_t here = n;
        if (g->blocks && !read_block_head(g, &parametric, n - g->n_nodes, &here))
            return false;
        if (g->blocks && parametric != 0)
            return TRI_WORDS_FAIL(g->words, "nodes with parametric coordinates are not supported");
        if (!read_node_block(g, here))
            return false;
    }
    if (g->n_nodes < n)
        return TRI_WORDS_FAIL(g->words, "there are %" PRId64 " nodes instead of %" PRId64, g->n_nodes, n);
    return tri_tags_order(&g->nodes, "node", &g->words->to);
}

/* Returns the number of nodes of an element type; 0: not supported. */
static int nodes_of(int64_t kind)
{
    static const int nodes[] = {[1] = 2, [2] = 3, [8] = 3, [9] = 6, [15] = 1};
    return kind >= 0 && kind < (int64_t)(sizeof nodes / sizeof *nodes) ? nodes[kind] : 0;
}

/* Reads the nodes of an element; corners come first. Elements other than triangles are ignored. */
static bool read_element_nodes(struct gmsh *g, int64_t kind)
{
    const int n = nodes_of(kind);
    const bool is_triangle = kind == 2 || kind == 9;
    int32_t *corners = g->words->to.elements->corners + 3 * g->n_triangles;
    if (n == 0)
        return TRI_WORDS_FAIL(g->words, "an element of type %" PRId64 ": triangles, lines and points are read", kind);
    for (int k = 0; k < n; k++) {
        int64_t tag;
        if (!read_int(g, "a node of an element", &tag))
            return false;
        const int64_t place = tri_tags_place(&g->nodes, tag);
        if (place < 0)
            return TRI_WORDS_FAIL(g->words, "an element refers to node %" PRId64 ", which does not exist", tag);
        if (is_triangle && k < 3)
            corners[k] = (int32_t)place;
    }
    g->n_triangles += is_triangle;
    return true;
}

static bool read_element_block(struct gmsh *g, int64_t kind, int64_t n)
{
    for (int64_t i = 0; i < n; i++) {
        int64_t tag, n_tags = 0;
        if (!read_int(g, "the tag of an element", &tag))
            return false;
        if (!g->blocks && (!read_int(g, "the type of an element", &kind) ||
                           !tri_words_count(g->words, "the number of tags", 1, &n_tags)))
            return false;
        for (int64_t k = 0; k < n_tags; k++)
            if (!read_int(g, "a tag", &tag))
                return false;
        if (!read_element_nodes(g, kind))
            return false;
    }
    return true;
}

static bool read_elements(struct gmsh *g)
{
    int64_t blocks, n, kind = 0, done = 0;
    if (!g->nodes.tag || g->words->to.elements->corners)
        return TRI_WORDS_FAIL(g->words, "$Elements comes before $Nodes or occurs twice");
    if (!read_totals(g, "the number of elements", &blocks, &n) || !tri_reading_triangles(&g->words->to, n, 3))
        return false;
    for (int64_t b = 0; b < blocks; b++) {
        int64_t here = n;
        if (g->blocks && !read_block_head(g, &kind, n - done, &here))
            return false;
        if (!read_element_block(g, kind, here))
            return false;
        done += here;
    }
    g->words->to.elements->n = (int32_t)g->n_triangles;
    return true;
}

/* Reads the head of a data section: names, one per line, times, and integers, of which the second and third are the
 * numbers of components and nodes. */
static bool read_data_head(struct gmsh *g, int64_t *components, int64_t *n)
{
    int64_t count, other;
    double time;
    if (!tri_words_count(g->words, "the number of names", 1, &count))
        return false;
    tri_words_skip_lines(g->words, count);
    if (!tri_words_count(g->words, "the number of times", 1, &count))
        return false;
    for (int64_t i = 0; i < count; i++)
        if (!tri_words_real(g->words, "a time", false, &time))
            return false;
    if (!tri_words_whole(g->words, "the number of whole numbers", 3, 100, &count) || !read_int(g, "a step", &other) ||
        !read_int(g, "the number of components", components) ||
        !tri_words_count(g->words, "the number of nodes with data", 4, n))
        return false;
    for (int64_t i = 3; i < count; i++)
        if (!read_int(g, "a whole number", &other))
            return false;
    return true;
}

static bool read_data(struct gmsh *g)
{
    struct tri_pslg *mesh = g->words->to.mesh;
    int64_t components, n, tag;
    double value;
    if (!g->nodes.tag)
        return TRI_WORDS_FAIL(g->words, "$NodeData comes before $Nodes");
    if (!read_data_head(g, &components, &n))
        return false;
    if (components != 1 || mesh->attributes)
        return true;
    mesh->attributes = calloc((size_t)mesh->n_points + 1, sizeof *mesh->attributes);
    mesh->n_attributes = 1;
    if (!mesh->attributes)
        return tri_reading_no_memory(&g->words->to);
    for (int64_t i = 0; i < n; i++) {
        if (!read_int(g, "the tag of a node", &tag) || !tri_words_length(g->words, &value))
            return false;
        const int64_t place = tri_tags_place(&g->nodes, tag);
        if (place < 0)
            return TRI_WORDS_FAIL(g->words, "a value is given for node %" PRId64 ", which does not exist", tag);
        mesh->attributes[place] = value;
    }
    return true;
}

static bool read_format(struct gmsh *g)
{
    int64_t binary, bytes;
    double version;
    if (!tri_words_next(g->words) || !tri_words_is(g->words, "$meshformat"))
        return TRI_WORDS_FAIL(g->words, "not a .msh file");
    if (!tri_words_real(g->words, "a version", true, &version) || !read_int(g, "a kind of file", &binary) ||
        !read_int(g, "a size", &bytes))
        return false;
    g->blocks = version == 4.1;
    return ((g->blocks || version == 2.2) && binary == 0) ||
           TRI_WORDS_FAIL(g->words, "version %g%s is not supported; only 2.2 and 4.1 as text and 4.1 as binary are",
                          version, binary ? ", binary," : "");
}

/* Skips the rest of the section. */
static bool end_section(struct gmsh *g, const char *name, size_t n)
{
    char end[64];
    snprintf(end, sizeof end, "$End%.*s", (int)(n < 50 ? n : 50), name);
    while (tri_words_next(g->words))
        if (g->words->length == strlen(end) && memcmp(g->words->word, end, g->words->length) == 0)
            return true;
    return TRI_WORDS_FAIL(g->words, "the section $%.*s has no end", (int)(n < 50 ? n : 50), name);
}

static bool read_section(struct gmsh *g)
{
    const char *name = g->words->word + 1;
    const size_t n = g->words->length - 1;
    bool good = true;
    if (g->words->word[0] != '$')
        return TRI_WORDS_FAIL(g->words, "unexpected text between two sections");
    if (tri_words_is(g->words, "$nodes"))
        good = read_nodes(g);
    else if (tri_words_is(g->words, "$elements"))
        good = read_elements(g);
    else if (tri_words_is(g->words, "$nodedata"))
        good = read_data(g);
    return good && end_section(g, name, n);
}

bool tri_size_read_gmsh(struct tri_words *words)
{
    struct gmsh g = {.words = words};
    bool good = read_format(&g) && end_section(&g, "MeshFormat", strlen("MeshFormat"));
    while (good && tri_words_next(words))
        good = read_section(&g);
    tri_tags_free(&g.nodes);
    return good;
}

/* --- .pos: View "name" { ST(x,y,z,x,y,z,x,y,z){h,h,h}; SP(x,y,z){h}; }; */

struct view {
    struct tri_words *words;
    int64_t room_points, room_values, room_corners;
};

/* Reads a character; fails if it is not `sign`. */
static bool read_character(struct view *v, char sign)
{
    if (!tri_words_seek(v->words) || *v->words->at != sign)
        return TRI_WORDS_FAIL(v->words, "a \"%c\" is missing", sign);
    v->words->at++;
    return true;
}

/* Reads numbers between `open` and `close`, and keeps the first n. The others belong to later time steps. */
static bool read_list(struct view *v, char open, char close, double *to, int n)
{
    struct tri_words *w = v->words;
    if (!read_character(v, open))
        return false;
    for (int i = 0;; i++) {
        double value;
        const char *end = tri_words_seek(w) ? tri_scan_real(w->at, w->text.data + w->text.size, &value) : w->at;
        if (end == w->at || !isfinite(value))
            return TRI_WORDS_FAIL(w, "a number is missing, or not finite");
        if (i < n)
            to[i] = value;
        w->at = end;
        if (tri_words_seek(w) && *w->at == close && i + 1 >= n)
            return read_character(v, close);
        if (!read_character(v, ','))
            return false;
    }
}

/* Skips semicolons; after the last element there may be none. */
static void skip_semicolons(struct view *v)
{
    while (tri_words_seek(v->words) && *v->words->at == ';')
        v->words->at++;
}

static bool add_points(struct view *v, const double *xyz, const double *h, int n)
{
    struct tri_pslg *mesh = v->words->to.mesh;
    const int64_t first = mesh->n_points;
    if (first > INT32_MAX - n || !tri_grow_far(&mesh->points, &v->room_points, 2 * (first + n), sizeof *mesh->points) ||
        !tri_grow_far(&mesh->attributes, &v->room_values, first + n, sizeof *mesh->attributes))
        return tri_reading_no_memory(&v->words->to);
    for (int k = 0; k < n; k++) {
        mesh->points[2 * (first + k)] = xyz[3 * k];
        mesh->points[2 * (first + k) + 1] = xyz[3 * k + 1];
        mesh->attributes[first + k] = h[k];
    }
    mesh->n_points += n;
    mesh->n_attributes = 1;
    return true;
}

static bool add_triangle(struct view *v)
{
    struct tri_elements *e = v->words->to.elements;
    if (!tri_grow_far(&e->corners, &v->room_corners, 3 * ((int64_t)e->n + 1), sizeof *e->corners))
        return tri_reading_no_memory(&v->words->to);
    for (int k = 0; k < 3; k++)
        e->corners[3 * (int64_t)e->n + k] = v->words->to.mesh->n_points - 3 + k;
    e->n_nodes = 3;
    e->n++;
    return true;
}

/* Returns the number of nodes of an element name; 0: not supported. */
static int nodes_of_view(const char *name, size_t length)
{
    static const char kinds[] = "PLT";
    const char *found = length == 2 && name[0] == 'S' ? strchr(kinds, name[1]) : NULL;
    return found ? 1 + (int)(found - kinds) : 0;
}

/* Reads an element. Points and lines are used only if there are no triangles, since otherwise they lie at corners. */
static bool read_element(struct view *v)
{
    struct tri_words *w = v->words;
    double xyz[9], h[3];
    const char *kind = w->at;
    while (*w->at >= 'A' && *w->at <= 'Z')
        w->at++;
    const size_t length = (size_t)(w->at - kind);
    const int n = nodes_of_view(kind, length);
    if (n == 0)
        return TRI_WORDS_FAIL(w, "not a scalar triangle (ST), line (SL) or point (SP)");
    if (!read_list(v, '(', ')', xyz, 3 * n) || !read_list(v, '{', '}', h, n))
        return false;
    skip_semicolons(v);
    if (n == 3 && w->to.elements->n == 0)
        w->to.mesh->n_points = 0;
    if (n < 3)
        return w->to.elements->n > 0 || add_points(v, xyz, h, n);
    return add_points(v, xyz, h, n) && add_triangle(v);
}

static bool read_view_head(struct view *v)
{
    struct tri_words *w = v->words;
    if (!tri_words_next(w) || !tri_words_is(w, "view"))
        return TRI_WORDS_FAIL(w, "not a .pos file: it does not begin with View");
    if (!read_character(v, '"'))
        return false;
    const char *quote = memchr(w->at, '"', (size_t)(w->text.data + w->text.size - w->at));
    for (; quote && w->at <= quote; w->at++)
        w->line += *w->at == '\n';
    return quote ? read_character(v, '{') : TRI_WORDS_FAIL(w, "the name of the view has no end");
}

bool tri_size_read_pos(struct tri_words *words)
{
    struct view v = {.words = words};
    words->comment = "//";
    bool good = read_view_head(&v);
    while (good && tri_words_seek(words) && *words->at != '}')
        good = read_element(&v);
    return good && read_character(&v, '}');
}
