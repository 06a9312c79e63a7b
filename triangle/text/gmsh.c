/* Gmsh's mesh format 4.1, binary (.msh).
 *
 * Triangles lie on a surface for each value of their first attribute, segments on a curve for each marker; where
 * that value is a whole number above 0 it is also the physical tag, by which solvers know regions and boundaries.
 * Others get tags above these, since some readers want a tag for each or for none. The exact values are data of
 * their own: "marker" and "attribute 0" and so on, of nodes and elements. Nodes are numbered from 1 as they are,
 * elements from 1 as they stand in the file, since some readers rely on that. Sections have text around them and
 * numbers in bytes in them: sizes and tags of nodes and elements are 64 bits wide, those in data 32. (Gmsh reference
 * manual, "MSH file format".) */
#include <assert.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "triangle/text/binary.h"
#include "triangle/text/grouping.h"
#include "triangle/text/formats.h"

enum { GMSH_LINE = 1, GMSH_TRIANGLE = 2, GMSH_QUADRATIC_TRIANGLE = 9 };
enum { ENTITY_BYTES = 96 };

struct gmsh {
    const struct tri_grid *grid;
    struct tri_output *output;
    const struct tri_executor *executor;
    struct tri_error *error;
    struct tri_grouping surfaces, curves;
    double low[2], high[2];
    int64_t first; /* of the rows of a block */
    int32_t k;     /* column of a data section */
};

static enum tri_status put_text(const struct gmsh *g, const char *text)
{
    return tri_output_write(g->output, text, strlen(text), g->error);
}

static enum tri_status put_bytes(const struct gmsh *g, const char *bytes, const char *end)
{
    return tri_output_write(g->output, bytes, (size_t)(end - bytes), g->error);
}

static enum tri_status put_rows(struct gmsh *g, int64_t n, size_t bytes, char *(*row)(void *, size_t, char *))
{
    return tri_write_table(g->output, (size_t)n, bytes, row, g, g->executor, g->error);
}

/* --- entities */

static void find_bounds(struct gmsh *g)
{
    for (int c = 0; c < 2; c++) {
        g->low[c] = g->grid->n_points > 0 ? HUGE_VAL : 0;
        g->high[c] = g->grid->n_points > 0 ? -HUGE_VAL : 0;
    }
    for (int64_t i = 0; i < g->grid->n_points; i++) {
        struct tri_grid_point point;
        g->grid->point(g->grid->user, i, &point);
        for (int c = 0; c < 2; c++) {
            g->low[c] = point.at[c] < g->low[c] ? point.at[c] : g->low[c];
            g->high[c] = point.at[c] > g->high[c] ? point.at[c] : g->high[c];
        }
    }
}

/* Its tag, its box, its physical tag if any, and no parts of a boundary. */
static enum tri_status put_entity(const struct gmsh *g, int32_t tag, int64_t physical)
{
    char bytes[ENTITY_BYTES], *at = tri_put_i32(bytes, tag);
    at = tri_put_f64(tri_put_f64(tri_put_f64(at, g->low[0]), g->low[1]), 0);
    at = tri_put_f64(tri_put_f64(tri_put_f64(at, g->high[0]), g->high[1]), 0);
    at = tri_put_u64(at, physical > 0);
    at = physical > 0 ? tri_put_i32(at, (int32_t)physical) : at;
    return put_bytes(g, bytes, tri_put_u64(at, 0));
}

static enum tri_status put_entities(const struct gmsh *g, const struct tri_grouping *groups, int n)
{
    enum tri_status status = TRI_OK;
    int64_t next = 1;
    for (int k = 0; k < n; k++) {
        int32_t own = tri_group_tag(groups->value[k]);
        next = own >= next ? (int64_t)own + 1 : next;
    }
    for (int k = 0; k < n && !status; k++) {
        int32_t own = tri_group_tag(groups->value[k]);
        int64_t physical = own > 0 ? own : next++;
        status = put_entity(g, k + 1, physical <= INT32_MAX ? physical : 0);
    }
    return status;
}

static int count_curves(const struct gmsh *g) { return g->grid->n_segments > 0 ? g->curves.n : 0; }

static enum tri_status write_entities(struct gmsh *g)
{
    char bytes[32], *at = tri_put_u64(tri_put_u64(bytes, 0), (uint64_t)count_curves(g));
    find_bounds(g);
    enum tri_status status = put_text(g, "$Entities\n");
    status = status ? status : put_bytes(g, bytes, tri_put_u64(tri_put_u64(at, (uint64_t)g->surfaces.n), 0));
    status = status ? status : put_entities(g, &g->curves, count_curves(g));
    status = status ? status : put_entities(g, &g->surfaces, g->surfaces.n);
    return status ? status : put_text(g, "\n$EndEntities\n");
}

/* --- nodes: all on the first surface */

static char *tag_row(void *user, size_t i, char *at)
{
    (void)user;
    return tri_put_u64(at, (uint64_t)i + 1);
}

static char *place_row(void *user, size_t i, char *at)
{
    const struct gmsh *g = user;
    struct tri_grid_point point;
    g->grid->point(g->grid->user, (int64_t)i, &point);
    return tri_put_f64(tri_put_f64(tri_put_f64(at, point.at[0]), point.at[1]), 0);
}

/* The head of $Nodes and $Elements: blocks, items, least and greatest tag. */
static enum tri_status put_totals(const struct gmsh *g, int64_t blocks, int64_t n)
{
    char bytes[32], *at = tri_put_i64(tri_put_i64(bytes, blocks), n);
    return put_bytes(g, bytes, tri_put_i64(tri_put_i64(at, n > 0), n));
}

/* The head of a block: dimension and tag of the entity, a number that means something else in each section, items. */
static enum tri_status put_block(const struct gmsh *g, int32_t dimension, int32_t tag, int32_t kind, int64_t n)
{
    char bytes[20], *at = tri_put_i32(tri_put_i32(tri_put_i32(bytes, dimension), tag), kind);
    return put_bytes(g, bytes, tri_put_i64(at, n));
}

static enum tri_status write_nodes(struct gmsh *g)
{
    const int64_t n = g->grid->n_points;
    enum tri_status status = put_text(g, "$Nodes\n");
    status = status ? status : put_totals(g, 1, n);
    status = status ? status : put_block(g, 2, 1, 0, n); /* without parameters */
    status = status ? status : put_rows(g, n, 8, tag_row);
    status = status ? status : put_rows(g, n, 24, place_row);
    return status ? status : put_text(g, "\n$EndNodes\n");
}

/* --- elements */

/* Gmsh has the nodes amid edges in the order of the edges from corner to corner. */
static char *triangle_row(void *user, size_t i, char *at)
{
    static const int order[6] = {0, 1, 2, 5, 3, 4};
    const struct gmsh *g = user;
    int64_t t = tri_grouped(&g->surfaces, g->first + (int64_t)i), nodes[6];
    g->grid->triangle(g->grid->user, t, nodes);
    at = tri_put_i64(at, g->first + (int64_t)i + 1);
    for (int k = 0; k < g->grid->n_nodes; k++)
        at = tri_put_i64(at, nodes[order[k]] + 1);
    return at;
}

static char *segment_row(void *user, size_t i, char *at)
{
    const struct gmsh *g = user;
    int64_t s = tri_grouped(&g->curves, g->first + (int64_t)i);
    struct tri_grid_edge segment;
    g->grid->segment(g->grid->user, s, &segment);
    at = tri_put_i64(at, g->grid->n_triangles + g->first + (int64_t)i + 1);
    return tri_put_i64(tri_put_i64(at, segment.ends[0] + 1), segment.ends[1] + 1);
}

static enum tri_status write_blocks(struct gmsh *g, const struct tri_grouping *groups, int n, int32_t dimension,
                                    int32_t kind, size_t row_bytes, char *(*row)(void *, size_t, char *))
{
    enum tri_status status = TRI_OK;
    for (int k = 0; k < n && !status; k++) {
        int64_t size = groups->first[k + 1] - groups->first[k];
        g->first = groups->first[k];
        status = put_block(g, dimension, k + 1, kind, size);
        status = status ? status : put_rows(g, size, row_bytes, row);
    }
    return status;
}

static enum tri_status write_elements(struct gmsh *g)
{
    const int n_surfaces = g->grid->n_triangles > 0 ? g->surfaces.n : 0, n_curves = count_curves(g);
    const int32_t kind = g->grid->n_nodes == 6 ? GMSH_QUADRATIC_TRIANGLE : GMSH_TRIANGLE;
    enum tri_status status = put_text(g, "$Elements\n");
    status = status ? status : put_totals(g, n_surfaces + n_curves, g->grid->n_triangles + g->grid->n_segments);
    status = status ? status : write_blocks(g, &g->surfaces, n_surfaces, 2, kind,
                                            8 + 8 * (size_t)g->grid->n_nodes, triangle_row);
    status = status ? status : write_blocks(g, &g->curves, n_curves, 1, GMSH_LINE, 24, segment_row);
    return status ? status : put_text(g, "\n$EndElements\n");
}

/* --- data */

static char *put_datum(char *at, size_t i, double value) { return tri_put_f64(tri_put_i32(at, (int32_t)i + 1), value); }

static char *node_marker_row(void *user, size_t i, char *at)
{
    const struct gmsh *g = user;
    struct tri_grid_point point;
    g->grid->point(g->grid->user, (int64_t)i, &point);
    return put_datum(at, i, point.marker);
}

static char *node_attribute_row(void *user, size_t i, char *at)
{
    const struct gmsh *g = user;
    return put_datum(at, i, g->grid->attribute(g->grid->user, (int64_t)i, g->k));
}

/* Which triangle, or segment behind all of them, is element i of the file. */
static int64_t element_at(const struct gmsh *g, size_t place)
{
    const int64_t n = g->grid->n_triangles, i = (int64_t)place;
    return i < n ? tri_grouped(&g->surfaces, i) : n + tri_grouped(&g->curves, i - n);
}

/* Of triangles 0. */
static char *element_marker_row(void *user, size_t i, char *at)
{
    const struct gmsh *g = user;
    int64_t element = element_at(g, i), s = element - g->grid->n_triangles;
    return put_datum(at, i, s < 0 ? 0 : tri_segment_group(g->grid, s));
}

/* Of segments 0. */
static char *element_attribute_row(void *user, size_t i, char *at)
{
    const struct gmsh *g = user;
    int64_t element = element_at(g, i);
    bool is_triangle = element < g->grid->n_triangles;
    return put_datum(at, i, is_triangle ? g->grid->column(g->grid->user, element, g->k) : 0);
}

/* Without time: one step, one component. */
static enum tri_status write_data(struct gmsh *g, const char *section, const char *name, int64_t n,
                                  char *(*row)(void *, size_t, char *))
{
    char head[192];
    snprintf(head, sizeof head, "$%s\n1\n\"%s\"\n1\n0\n3\n0\n1\n%" PRId64 "\n", section, name, n);
    enum tri_status status = put_text(g, head);
    status = status ? status : put_rows(g, n, 12, row);
    snprintf(head, sizeof head, "\n$End%s\n", section);
    return status ? status : put_text(g, head);
}

static enum tri_status write_columns(struct gmsh *g, const char *section, int32_t n_columns, int64_t n,
                                     char *(*row)(void *, size_t, char *))
{
    enum tri_status status = TRI_OK;
    for (g->k = 0; g->k < n_columns && !status; g->k++) {
        char name[32];
        snprintf(name, sizeof name, "attribute %" PRId32, g->k);
        status = write_data(g, section, name, n, row);
    }
    return status;
}

static enum tri_status write_all_data(struct gmsh *g)
{
    const struct tri_grid *grid = g->grid;
    const int64_t points = grid->n_points, elements = grid->n_triangles + grid->n_segments;
    enum tri_status status = TRI_OK;
    if (points > INT32_MAX || elements > INT32_MAX) /* the format has no room for their numbers */
        return TRI_OK;
    if (grid->has_markers) {
        status = write_data(g, "NodeData", "marker", points, node_marker_row);
        status = status ? status : write_data(g, "ElementData", "marker", elements, element_marker_row);
    }
    status = status ? status : write_columns(g, "NodeData", grid->n_attributes, points, node_attribute_row);
    return status ? status : write_columns(g, "ElementData", grid->n_columns, elements, element_attribute_row);
}

/* --- the file */

static enum tri_status write_all(struct gmsh *g)
{
    char one[4];
    enum tri_status status = put_text(g, "$MeshFormat\n4.1 1 8\n");
    status = status ? status : put_bytes(g, one, tri_put_i32(one, 1)); /* tells the order of bytes */
    status = status ? status : put_text(g, "\n$EndMeshFormat\n");
    status = status ? status : write_entities(g);
    status = status ? status : write_nodes(g);
    status = status ? status : write_elements(g);
    return status ? status : write_all_data(g);
}

enum tri_status tri_write_msh(struct tri_output *output, const struct tri_grid *grid,
                              const struct tri_executor *executor, struct tri_error *error)
{
    struct gmsh g = {.grid = grid, .output = output, .executor = executor, .error = error};
    enum tri_status status = tri_group(&g.surfaces, grid->n_triangles, tri_triangle_group, grid, error);
    status = status ? status : tri_group(&g.curves, grid->n_segments, tri_segment_group, grid, error);
    status = status ? status : write_all(&g);
    tri_grouping_free(&g.surfaces);
    tri_grouping_free(&g.curves);
    return status;
}
