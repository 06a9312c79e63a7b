/* Writes two text formats of hydrodynamic models, which number from 1 and store the boundary as strings of nodes: SMS
 * (.2dm) and ADCIRC (fort.14).
 *
 * In both, the first attribute of a point is its elevation or depth. In .2dm the material of a triangle is its first
 * attribute if that is a whole number above 0, otherwise 1; a node string ends with its marker. In fort.14, boundary
 * pieces with the marker TRI_OPEN_BOUNDARY are open boundaries, and all others are land: mainland on loops around the
 * mesh, islands around holes. A marker from 10 to 29 selects the type. (xmswiki.com, "2D Mesh Files *.2dm"; adcirc.org,
 * "ADCIRC Grid and Boundary Information File".) */
#include <string.h>

#include "triangle/text/boundary.h"
#include "triangle/text/decimal.h"
#include "triangle/text/formats.h"
#include "triangle/text/parts.h"

enum { INTEGER_BYTES = TRI_INTEGER_CHARS + 4, REAL_BYTES = TRI_REAL_CHARS + 4, NODES_A_LINE = 10 };

struct hydro {
    const struct tri_grid *grid;
    struct tri_output *output;
    const struct tri_executor *executor;
    struct tri_error *error;
    struct tri_boundary boundary;
    const char *card;                       /* first word of a node line */
    const struct tri_boundary_piece *piece; /* the piece being written */
};

static char *put_words(char *at, const char *text)
{
    const size_t n = strlen(text);
    memcpy(at, text, n);
    return at + n;
}

static char *put_integer(char *at, int64_t value) { return tri_print_integer(put_words(at, " "), value, 0); }
static char *put_real(char *at, double value) { return tri_print_real(put_words(at, " "), value); }

static enum tri_status put_text(const struct hydro *h, const char *text)
{
    return tri_output_write(h->output, text, strlen(text), h->error);
}

static enum tri_status put_rows(struct hydro *h, int64_t n, size_t bytes, tri_row_call *row)
{
    return tri_write_table(h->output, 0, n, bytes, row, h, h->executor, h->error);
}

/* Number, coordinates, and the first attribute. */
static char *node_row(const void *user, int64_t i, char *at)
{
    const struct hydro *h = user;
    const struct tri_grid *grid = h->grid;
    struct tri_grid_point point;
    grid->point(grid->user, i, &point);
    at = put_integer(put_words(at, h->card), i + 1);
    at = put_real(put_real(at, point.at[0]), point.at[1]);
    return put_words(put_real(at, grid->n_attributes > 0 ? grid->attribute(grid->user, i, 0) : 0), "\n");
}

static enum tri_status write_all(enum tri_status (*write)(struct hydro *h), const char *card,
                                 struct tri_output *output, const struct tri_grid *grid,
                                 const struct tri_executor *executor, struct tri_error *error)
{
    struct hydro h = {.grid = grid, .output = output, .executor = executor, .error = error, .card = card};
    enum tri_status status = tri_boundary_make(&h.boundary, grid, error);
    status = status ? status : write(&h);
    tri_boundary_free(&h.boundary);
    return status;
}

/* --- .2dm */

/* The nodes of second-order triangles go around the triangle, starting at a corner. */
static char *element_card(const void *user, int64_t i, char *at)
{
    static const int order[6] = {0, 5, 1, 3, 2, 4};
    const struct hydro *h = user;
    int64_t nodes[6];
    h->grid->triangle(h->grid->user, i, nodes);
    at = put_integer(put_words(at, h->grid->n_nodes == 6 ? "E6T" : "E3T"), i + 1);
    for (int k = 0; k < h->grid->n_nodes; k++)
        at = put_integer(at, nodes[h->grid->n_nodes == 6 ? order[k] : k] + 1);
    int32_t material = tri_group_tag(tri_triangle_group(h->grid, i));
    return put_words(put_integer(at, material > 0 ? material : 1), "\n");
}

/* Ten nodes per line; the last node is negative. */
static char *string_card(const void *user, int64_t i, char *at)
{
    const struct hydro *h = user;
    const struct tri_boundary_piece *piece = h->piece;
    const int64_t n = piece->n + piece->closed, begin = i * NODES_A_LINE;
    at = put_words(at, "NS");
    for (int64_t k = begin; k < n && k < begin + NODES_A_LINE; k++) {
        int64_t node = h->boundary.nodes[piece->first + k % piece->n] + 1;
        at = put_integer(at, k == n - 1 ? -node : node);
    }
    return put_words(begin + NODES_A_LINE < n ? at : put_integer(at, piece->marker), "\n");
}

static enum tri_status write_2dm(struct hydro *h)
{
    const size_t element_bytes = 3 + 8 * INTEGER_BYTES + 1, node_bytes = 2 + INTEGER_BYTES + 3 * REAL_BYTES + 1;
    enum tri_status status = put_text(h, "MESH2D\nNUM_MATERIALS_PER_ELEM 1\n");
    status = status ? status : put_rows(h, h->grid->n_triangles, element_bytes, element_card);
    status = status ? status : put_rows(h, h->grid->n_points, node_bytes, node_row);
    for (int64_t p = 0; p < h->boundary.n_pieces && !status; p++) {
        h->piece = &h->boundary.pieces[p];
        const int64_t lines = (h->piece->n + h->piece->closed - 1) / NODES_A_LINE + 1;
        status = put_rows(h, lines, (NODES_A_LINE + 1) * INTEGER_BYTES + 3, string_card);
    }
    return status;
}

enum tri_status tri_write_2dm(struct tri_output *output, const struct tri_grid *grid,
                              const struct tri_executor *executor, struct tri_error *error)
{
    return write_all(write_2dm, "ND", output, grid, executor, error);
}

/* --- fort.14 */

static char *element_line(const void *user, int64_t i, char *at)
{
    const struct hydro *h = user;
    int64_t nodes[6];
    h->grid->triangle(h->grid->user, i, nodes);
    at = put_integer(put_integer(at, i + 1), 3);
    for (int k = 0; k < 3; k++)
        at = put_integer(at, nodes[k] + 1);
    return put_words(at, "\n");
}

/* Returns the type of a land boundary: 0 for mainland, 1 for an island. Markers from 10 to 29 add 10 or 20; marker 12
 * or 22, a river, is the type itself. */
static int64_t land_type(const struct tri_boundary_piece *piece)
{
    const int64_t tens = piece->marker >= 10 && piece->marker < 30 ? piece->marker / 10 * 10 : 0;
    return tens + (tens > 0 && piece->outer && piece->marker == tens + 2 ? 2 : !piece->outer);
}

static bool is_open(const struct tri_boundary_piece *piece)
{
    return piece->outer && piece->marker == TRI_OPEN_BOUNDARY;
}

/* Number of nodes to write. A closed loop around the mesh repeats its first node; islands are closed by their type. */
static int64_t shown_nodes(const struct tri_boundary_piece *piece)
{
    return piece->n + (piece->closed && piece->outer);
}

static char *boundary_line(const void *user, int64_t i, char *at)
{
    const struct hydro *h = user;
    return put_words(put_integer(at, h->boundary.nodes[h->piece->first + i % h->piece->n] + 1), "\n");
}

static enum tri_status put_numbers(const struct hydro *h, int64_t a, int64_t b, const char *what)
{
    char line[2 * INTEGER_BYTES + 64], *at = put_integer(line, a);
    at = put_words(put_words(b < 0 ? at : put_integer(at, b), what), "\n");
    return tri_output_write(h->output, line, (size_t)(at - line), h->error);
}

static enum tri_status write_pieces(struct hydro *h, bool open)
{
    int64_t n = 0, nodes = 0;
    for (int64_t p = 0; p < h->boundary.n_pieces; p++)
        if (is_open(&h->boundary.pieces[p]) == open) {
            n++;
            nodes += shown_nodes(&h->boundary.pieces[p]);
        }
    enum tri_status status = put_numbers(h, n, -1, open ? " = open boundaries" : " = land boundaries");
    status = status ? status : put_numbers(h, nodes, -1, " = nodes of them all");
    for (int64_t p = 0; p < h->boundary.n_pieces && !status; p++) {
        h->piece = &h->boundary.pieces[p];
        if (is_open(h->piece) != open)
            continue;
        status = put_numbers(h, shown_nodes(h->piece), open ? 0 : land_type(h->piece), "");
        status = status ? status : put_rows(h, shown_nodes(h->piece), INTEGER_BYTES + 1, boundary_line);
    }
    return status;
}

static enum tri_status write_14(struct hydro *h)
{
    enum tri_status status = put_text(h, "ptriangle\n");
    status = status ? status : put_numbers(h, h->grid->n_triangles, h->grid->n_points, "");
    status = status ? status : put_rows(h, h->grid->n_points, INTEGER_BYTES + 3 * REAL_BYTES + 1, node_row);
    status = status ? status : put_rows(h, h->grid->n_triangles, 5 * INTEGER_BYTES + 1, element_line);
    status = status ? status : write_pieces(h, true);
    return status ? status : write_pieces(h, false);
}

enum tri_status tri_write_14(struct tri_output *output, const struct tri_grid *grid,
                             const struct tri_executor *executor, struct tri_error *error)
{
    if (grid->n_nodes == 6)
        return tri_fail(error, TRI_BAD_INPUT, output->path, 0, "the format has no second-order triangles (-o2)");
    return write_all(write_14, "", output, grid, executor, error);
}
