/* The layouts of Triangle's files, row by row.
 *
 * A row begins with the number of its item, four characters wide. Widths and blanks are those of Triangle, byte for
 * byte. */
#include <string.h>

#include "triangle/text/decimal.h"
#include "triangle/text/write.h"

_Static_assert((int)TRI_ROW_SLACK >= (int)TRI_REAL_ROOM, "a row may end with a real");

/* Longest texts of an integer and of a real, including the blanks before them. */
enum { INTEGER_BYTES = TRI_INTEGER_CHARS + 4, REAL_BYTES = TRI_REAL_CHARS + 4 };

enum { MOST_BLANKS = 4 };

/* Stores MOST_BLANKS blanks, of which n are kept: a copy of fixed length needs no call. */
static char *put_blanks(char *at, int n)
{
    memset(at, ' ', MOST_BLANKS);
    return at + n;
}

static char *put_real(char *at, int blanks, double value) { return tri_print_real(put_blanks(at, blanks), value); }

static char *put_integer(char *at, int blanks, int64_t value, int width)
{
    return tri_print_integer(put_blanks(at, blanks), value, width);
}

static char *put_marker(char *at, const struct tri_grid *grid, int blanks, int32_t marker, int width)
{
    return grid->has_markers ? put_integer(at, blanks, marker, width) : at;
}

static char *put_end(char *at)
{
    *at = '\n';
    return at + 1;
}

/* -1 means "none" for every base. */
static int64_t shown(const struct tri_grid *grid, int64_t index) { return index < 0 ? index : index + grid->base; }

static char *put_number(char *at, const struct tri_grid *grid, int64_t i)
{
    return tri_print_integer(at, i + grid->base, 4);
}

/* Writes a line of counts, the first of which is the number of rows, and then the rows. */
static enum tri_status write_table(struct tri_output *output, const struct tri_grid *grid, const int64_t *counts,
                                   int n_counts, size_t max_row_bytes, tri_row_call *row,
                                   const struct tri_executor *executor, struct tri_error *error)
{
    enum tri_status status = tri_write_counts(output, counts, n_counts, error);
    return status ? status : tri_write_table(output, 0, counts[0], max_row_bytes, row, grid, executor, error);
}

/* --- .node */

static size_t node_bytes(const struct tri_grid *grid)
{
    return 2 * INTEGER_BYTES + (2 + (size_t)grid->n_attributes) * REAL_BYTES + 1;
}

static char *node_row(const void *user, int64_t i, char *at)
{
    const struct tri_grid *grid = user;
    struct tri_grid_point point;
    grid->point(grid->user, i, &point);
    at = put_number(at, grid, i);
    at = put_real(at, 4, point.at[0]);
    at = put_real(at, 2, point.at[1]);
    for (int32_t k = 0; k < grid->n_attributes; k++)
        at = put_real(at, 2, grid->attribute(grid->user, i, k));
    return put_end(put_marker(at, grid, 4, point.marker, 0));
}

enum tri_status tri_write_node_rows(struct tri_output *output, const struct tri_grid *grid, int64_t first, int64_t n,
                                    const struct tri_executor *executor, struct tri_error *error)
{
    return tri_write_table(output, first, n, node_bytes(grid), node_row, grid, executor, error);
}

enum tri_status tri_write_node(struct tri_output *output, const struct tri_grid *grid,
                               const struct tri_executor *executor, struct tri_error *error)
{
    const int64_t counts[] = {grid->n_points, 2, grid->n_attributes, grid->has_markers};
    return write_table(output, grid, counts, 4, node_bytes(grid), node_row, executor, error);
}

/* --- .ele */

static char *ele_row(const void *user, int64_t i, char *at)
{
    const struct tri_grid *grid = user;
    int64_t nodes[6];
    grid->triangle(grid->user, i, nodes);
    at = put_blanks(put_number(at, grid, i), 2);
    for (int k = 0; k < grid->n_nodes; k++)
        at = put_integer(at, 2, nodes[k] + grid->base, 4);
    for (int32_t k = 0; k < grid->n_columns; k++)
        at = put_real(at, 2, grid->column(grid->user, i, k));
    return put_end(at);
}

static size_t ele_bytes(const struct tri_grid *grid)
{
    return (2 + (size_t)grid->n_nodes) * INTEGER_BYTES + (size_t)grid->n_columns * REAL_BYTES + 1;
}

enum tri_status tri_write_ele_rows(struct tri_output *output, const struct tri_grid *grid, int64_t first, int64_t n,
                                   const struct tri_executor *executor, struct tri_error *error)
{
    return tri_write_table(output, first, n, ele_bytes(grid), ele_row, grid, executor, error);
}

enum tri_status tri_write_ele(struct tri_output *output, const struct tri_grid *grid,
                              const struct tri_executor *executor, struct tri_error *error)
{
    const int64_t counts[] = {grid->n_triangles, grid->n_nodes, grid->n_columns};
    return write_table(output, grid, counts, 3, ele_bytes(grid), ele_row, executor, error);
}

/* --- .poly without vertices: segments, holes, regions */

static char *segment_row(const void *user, int64_t i, char *at)
{
    const struct tri_grid *grid = user;
    struct tri_grid_edge segment;
    grid->segment(grid->user, i, &segment);
    at = put_number(at, grid, i);
    at = put_integer(at, 4, segment.ends[0] + grid->base, 4);
    at = put_integer(at, 2, segment.ends[1] + grid->base, 4);
    return put_end(put_marker(at, grid, 4, segment.marker, 4));
}

enum { SEGMENT_BYTES = 4 * INTEGER_BYTES + 1 };

enum tri_status tri_write_segment_rows(struct tri_output *output, const struct tri_grid *grid, int64_t first,
                                       int64_t n, const struct tri_executor *executor, struct tri_error *error)
{
    return tri_write_table(output, first, n, SEGMENT_BYTES, segment_row, grid, executor, error);
}

/* Holes or regions: n_reals numbers per row. */
struct sites {
    int32_t base;
    int64_t n_reals;
    const double *reals;
};

static char *site_row(const void *user, int64_t i, char *at)
{
    const struct sites *sites = user;
    at = tri_print_integer(at, i + sites->base, 4);
    at = put_real(at, 3, sites->reals[i * sites->n_reals]);
    for (int64_t k = 1; k < sites->n_reals; k++)
        at = put_real(at, 2, sites->reals[i * sites->n_reals + k]);
    return put_end(at);
}

static enum tri_status write_sites(struct tri_output *output, struct sites sites, int32_t n, struct tri_error *error)
{
    enum tri_status status = tri_write_counts(output, (int64_t[]){n}, 1, error);
    const size_t row_bytes = INTEGER_BYTES + (size_t)sites.n_reals * REAL_BYTES + 1;
    return status ? status : tri_write_table(output, 0, n, row_bytes, site_row, &sites, NULL, error);
}

enum tri_status tri_write_sites(struct tri_output *output, const struct tri_grid *grid,
                                const struct tri_executor *executor, struct tri_error *error)
{
    static const struct tri_pslg none;
    const struct tri_pslg *figure = grid->figure ? grid->figure : &none;
    const struct sites holes = {grid->base, 2, figure->holes}, regions = {grid->base, 4, figure->regions};
    enum tri_status status = write_sites(output, holes, figure->n_holes, error);
    (void)executor;
    return status || figure->n_regions == 0 ? status : write_sites(output, regions, figure->n_regions, error);
}

enum tri_status tri_write_poly(struct tri_output *output, const struct tri_grid *grid,
                               const struct tri_executor *executor, struct tri_error *error)
{
    const int64_t points[] = {0, 2, grid->n_attributes, grid->has_markers};
    const int64_t segments[] = {grid->n_segments, grid->has_markers};
    enum tri_status status = tri_write_counts(output, points, 4, error);
    status = status ? status
                    : write_table(output, grid, segments, 2, SEGMENT_BYTES, segment_row, executor, error);
    return status ? status : tri_write_sites(output, grid, executor, error);
}

/* --- .edge, .v.edge, .neigh */

static char *put_ends(char *at, const struct tri_grid *grid, int64_t i, const int64_t ends[2])
{
    at = put_integer(put_number(at, grid, i), 3, ends[0] + grid->base, 0);
    return put_integer(at, 2, shown(grid, ends[1]), 0);
}

static char *edge_row(const void *user, int64_t i, char *at)
{
    const struct tri_grid *grid = user;
    struct tri_grid_edge edge;
    grid->edge(grid->user, i, &edge);
    return put_end(put_marker(put_ends(at, grid, i, edge.ends), grid, 2, edge.marker, 0));
}

enum tri_status tri_write_edge(struct tri_output *output, const struct tri_grid *grid,
                               const struct tri_executor *executor, struct tri_error *error)
{
    const int64_t counts[] = {grid->n_edges, grid->has_markers};
    return write_table(output, grid, counts, 2, 4 * INTEGER_BYTES + 1, edge_row, executor, error);
}

static char *v_edge_row(const void *user, int64_t i, char *at)
{
    const struct tri_grid *grid = user;
    struct tri_grid_edge edge;
    grid->edge(grid->user, i, &edge);
    at = put_ends(at, grid, i, edge.ends);
    if (edge.ends[1] < 0) {
        at = put_real(at, 3, edge.direction[0]);
        at = put_real(at, 2, edge.direction[1]);
    }
    return put_end(at);
}

enum tri_status tri_write_v_edge(struct tri_output *output, const struct tri_grid *grid,
                                 const struct tri_executor *executor, struct tri_error *error)
{
    const size_t row_bytes = 3 * INTEGER_BYTES + 2 * REAL_BYTES + 1;
    return write_table(output, grid, (int64_t[]){grid->n_edges, 0}, 2, row_bytes, v_edge_row, executor, error);
}

static char *neigh_row(const void *user, int64_t i, char *at)
{
    const struct tri_grid *grid = user;
    int64_t neighbors[3];
    grid->neighbors(grid->user, i, neighbors);
    at = put_integer(put_number(at, grid, i), 4, shown(grid, neighbors[0]), 0);
    at = put_integer(at, 2, shown(grid, neighbors[1]), 0);
    return put_end(put_integer(at, 2, shown(grid, neighbors[2]), 0));
}

enum tri_status tri_write_neigh(struct tri_output *output, const struct tri_grid *grid,
                                const struct tri_executor *executor, struct tri_error *error)
{
    const int64_t counts[] = {grid->n_triangles, 3};
    return write_table(output, grid, counts, 2, 4 * INTEGER_BYTES + 1, neigh_row, executor, error);
}

/* --- .off: always counts from 0, has corners only, and z = 0 */

static char *off_vertex_row(const void *user, int64_t i, char *at)
{
    const struct tri_grid *grid = user;
    struct tri_grid_point point;
    grid->point(grid->user, i, &point);
    at = put_real(at, 1, point.at[0]);
    at = put_real(at, 2, point.at[1]);
    memcpy(at, "  0\n", 4);
    return at + 4;
}

static char *off_face_row(const void *user, int64_t i, char *at)
{
    const struct tri_grid *grid = user;
    int64_t nodes[6];
    grid->triangle(grid->user, i, nodes);
    memcpy(at, " 3   ", 5);
    at = tri_print_integer(at + 5, nodes[0], 4);
    at = put_integer(at, 2, nodes[1], 4);
    return put_end(put_integer(at, 2, nodes[2], 4));
}

static enum tri_status write_off_header(struct tri_output *output, const struct tri_grid *grid,
                                        struct tri_error *error)
{
    char line[4 + 3 * INTEGER_BYTES + MOST_BLANKS + 1] = "OFF\n", *at = tri_print_integer(line + 4, grid->n_points, 0);
    at = put_integer(at, 1, grid->n_triangles, 0);
    at = put_end(put_integer(at, 1, grid->n_edges, 0));
    return tri_output_write(output, line, (size_t)(at - line), error);
}

enum tri_status tri_write_off(struct tri_output *output, const struct tri_grid *grid,
                              const struct tri_executor *executor, struct tri_error *error)
{
    enum tri_status status = write_off_header(output, grid, error);
    const size_t vertex_bytes = 2 * REAL_BYTES + 8, face_bytes = 4 * INTEGER_BYTES;
    if (!status)
        status = tri_write_table(output, 0, grid->n_points, vertex_bytes, off_vertex_row, grid, executor, error);
    return status ? status
                  : tri_write_table(output, 0, grid->n_triangles, face_bytes, off_face_row, grid, executor, error);
}
