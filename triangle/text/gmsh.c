/* Writes Gmsh's mesh format 4.1, binary (.msh); see the Gmsh reference manual, "MSH file format".
 *
 * There is one surface for each value of the first attribute of triangles, and one curve for each marker of segments. A
 * value that is a whole number above 0 is also the physical tag, by which solvers identify regions and boundaries.
 * Other values get tags above these, because some readers require a tag for all or for none. The exact values are
 * stored as data of nodes and elements: "marker", "attribute_0" and so on. Nodes are numbered from 1 in their order,
 * elements from 1 in file order, since some readers rely on that. Sections are binary with text around them: sizes and
 * tags of nodes and elements are 64 bits wide, tags in data sections 32.
 *
 * The file of a part has the nodes and elements of the part, with their tags of the whole mesh. All entities of the
 * whole mesh are listed, followed by partitioned entities: surfaces and curves of the part, and for each interface
 * (nodes shared with the same other parts) a curve without elements, child of the surface to which the whole mesh
 * assigns its nodes. Their tags are the same in all parts. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "triangle/text/binary.h"
#include "triangle/text/decimal.h"
#include "triangle/text/formats.h"
#include "triangle/text/parts.h"

enum { GMSH_LINE = 1, GMSH_TRIANGLE = 2, GMSH_QUADRATIC_TRIANGLE = 9 };
enum { ENTITY_BYTES = 96 };

/* The groups of surfaces, or of curves. */
struct groups {
    struct tri_grouping all;
    int n;                               /* number of groups that are entities */
    int32_t dimension;
    int32_t physical[TRI_MOST_GROUPS];   /* tags; 0: none */
    int64_t first[TRI_MOST_GROUPS + 1];  /* ranges of the group members in this file, as indices into `place` */
    const int64_t *place;                /* positions in the grouping; NULL: the indices themselves */
};

struct gmsh {
    const struct tri_grid *grid;
    struct tri_output *output;
    const struct tri_executor *executor;
    struct tri_error *error;
    enum tri_status status;        /* of the first write that failed */
    struct groups surfaces, curves;
    double low[2], high[2];
    const struct tri_parts *parts; /* NULL: the mesh is not divided */
    int part;
    int64_t n_nodes;               /* number of nodes in the file */
    int64_t n_inner;               /* number of nodes that no other part has */
    int64_t *border;               /* [n_nodes - n_inner] the other nodes */
    int32_t k;                     /* column of a data section, or MARKER */
};

/* --- contents of the file */

static int64_t node_at(const struct gmsh *g, int64_t i)
{
    if (!g->parts)
        return i;
    tri_grid_evict_periodically(g->grid, i);
    return i < g->n_inner ? g->parts->inner[g->parts->first_inner[g->part] + i] : g->border[i - g->n_inner];
}

/* Returns the position of an element in its grouping. */
static int64_t place_at(const struct groups *groups, int64_t i) { return groups->place ? groups->place[i] : i; }

static int64_t size_of(const struct groups *groups, int k) { return groups->first[k + 1] - groups->first[k]; }
static int64_t count(const struct groups *groups) { return groups->first[groups->n] - groups->first[0]; }

static int count_blocks(const struct groups *groups)
{
    int n = 0;
    for (int k = 0; k < groups->n; k++)
        n += size_of(groups, k) > 0;
    return n;
}

/* Returns the first of the ascending positions at .. end - 1 that is not below the bound; end: none. place == NULL:
 * each position is its index. */
static int64_t place_from(const int64_t *place, int64_t at, int64_t end, int64_t bound)
{
    while (at < end) {
        const int64_t middle = at + (end - at) / 2;
        if ((place ? place[middle] : middle) < bound)
            at = middle + 1;
        else
            end = middle;
    }
    return at;
}

/* Selects entries begin .. end - 1 of a list of positions, or, if it is NULL, of all elements. They ascend, as do
 * groups. */
static void select_range(struct groups *groups, const int64_t *place, int64_t begin, int64_t end)
{
    groups->place = place;
    groups->first[0] = begin;
    for (int k = 0; k < groups->n; k++)
        groups->first[k + 1] = place_from(place, groups->first[k], end, groups->all.first[k + 1]);
}

static bool has_interface(const struct gmsh *g, int64_t i) { return tri_part_has_interface(g->parts, g->part, i); }

static int64_t interface_size(const struct gmsh *g, int64_t i)
{
    return g->parts->first_shared[i + 1] - g->parts->first_shared[i];
}

static enum tri_status select_nodes(struct gmsh *g)
{
    const struct tri_parts *p = g->parts;
    int64_t n = 0, at = 0;
    for (int64_t i = 0; i < p->n_interfaces; i++)
        n += has_interface(g, i) ? interface_size(g, i) : 0;
    g->n_inner = p->first_inner[g->part + 1] - p->first_inner[g->part];
    g->n_nodes = g->n_inner + n;
    g->border = malloc((size_t)n * sizeof *g->border + 1);
    if (!g->border)
        return tri_fail(g->error, TRI_NO_MEMORY, NULL, 0, "out of memory for a part of the mesh");
    for (int64_t i = 0; i < p->n_interfaces; i++)
        for (int64_t k = p->first_shared[i]; has_interface(g, i) && k < p->first_shared[i + 1]; k++)
            g->border[at++] = p->shared[k].point;
    return TRI_OK;
}

/* Writes bytes, unless an earlier write failed. */
static void put_bytes(struct gmsh *g, const char *bytes, const char *end)
{
    if (!g->status)
        g->status = tri_output_write(g->output, bytes, (size_t)(end - bytes), g->error);
}

static void put_text(struct gmsh *g, const char *text) { put_bytes(g, text, text + strlen(text)); }

static void put_rows(struct gmsh *g, int64_t first, int64_t n, size_t bytes, tri_row_call *row)
{
    if (!g->status)
        g->status = tri_write_table(g->output, first, n, bytes, row, g, g->executor, g->error);
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

static char *put_box(const struct gmsh *g, char *at)
{
    at = tri_put_f64(tri_put_f64(tri_put_f64(at, g->low[0]), g->low[1]), 0);
    return tri_put_f64(tri_put_f64(tri_put_f64(at, g->high[0]), g->high[1]), 0);
}

/* Stores the bounding box, the physical tag if any, and an empty list of boundary entities. */
static char *put_shape(const struct gmsh *g, char *at, int32_t physical)
{
    at = tri_put_u64(put_box(g, at), physical > 0);
    at = physical > 0 ? tri_put_i32(at, physical) : at;
    return tri_put_u64(at, 0);
}

static void choose_physical(struct groups *groups)
{
    int64_t next = 1;
    for (int k = 0; k < groups->n; k++) {
        int32_t own = tri_group_tag(groups->all.value[k]);
        next = own >= next ? (int64_t)own + 1 : next;
    }
    for (int k = 0; k < groups->n; k++) {
        int32_t own = tri_group_tag(groups->all.value[k]);
        int64_t physical = own > 0 ? own : next++;
        groups->physical[k] = physical <= INT32_MAX ? (int32_t)physical : 0;
    }
}

static void put_entities(struct gmsh *g, const struct groups *groups)
{
    for (int k = 0; k < groups->n; k++) {
        char bytes[ENTITY_BYTES], *at = put_shape(g, tri_put_i32(bytes, k + 1), groups->physical[k]);
        put_bytes(g, bytes, at);
    }
}

/* Writes the numbers of points, curves, surfaces and volumes. */
static void put_entity_counts(struct gmsh *g, int64_t curves, int64_t surfaces)
{
    char bytes[32], *at = tri_put_i64(tri_put_u64(bytes, 0), curves);
    put_bytes(g, bytes, tri_put_u64(tri_put_i64(at, surfaces), 0));
}

/* Writes dimension, tag and name of each group, such as "marker_1" or "region_2.5". Names have no blanks, which some
 * readers reject. */
static void put_names(struct gmsh *g, const struct groups *groups, const char *what)
{
    for (int k = 0; k < groups->n; k++) {
        char line[64 + TRI_REAL_ROOM], value[TRI_REAL_ROOM];
        *tri_print_real(value, groups->all.value[k]) = 0;
        snprintf(line, sizeof line, "%" PRId32 " %" PRId32 " \"%s_%s\"\n", groups->dimension, groups->physical[k], what,
                 value);
        put_text(g, line);
    }
}

/* Solvers find regions and boundaries by these names. */
static void write_names(struct gmsh *g)
{
    char head[48];
    snprintf(head, sizeof head, "$PhysicalNames\n%d\n", g->curves.n + g->surfaces.n);
    put_text(g, head);
    put_names(g, &g->curves, "marker");
    put_names(g, &g->surfaces, "region");
    put_text(g, "$EndPhysicalNames\n");
}

static void write_entities(struct gmsh *g)
{
    put_text(g, "$Entities\n");
    put_entity_counts(g, g->curves.n, g->surfaces.n);
    put_entities(g, &g->curves);
    put_entities(g, &g->surfaces);
    put_text(g, "\n$EndEntities\n");
}

/* --- partitioned entities */

/* Returns the tag of a group's entity, or of its part in this file. The latter follow those of the whole mesh. */
static int32_t tag_of(const struct gmsh *g, const struct groups *groups, int k)
{
    return (g->parts ? (g->part + 1) * groups->n : 0) + k + 1;
}

/* The tags of interfaces follow those of the curves. */
static int32_t interface_tag(const struct gmsh *g, int64_t i)
{
    return (int32_t)((g->parts->n + 1) * g->curves.n + i + 1);
}

/* Returns the first surface with triangles, to which the nodes are assigned; 0 if there is none. */
static int first_surface(const struct gmsh *g)
{
    for (int k = 0; k < g->surfaces.n; k++)
        if (size_of(&g->surfaces, k) > 0)
            return k;
    return 0;
}

static bool has_piece(const struct gmsh *g, const struct groups *groups, int k)
{
    return size_of(groups, k) > 0 || (groups == &g->surfaces && k == first_surface(g));
}

static int count_pieces(const struct gmsh *g, const struct groups *groups)
{
    int n = 0;
    for (int k = 0; k < groups->n; k++)
        n += has_piece(g, groups, k);
    return n;
}

static void put_pieces(struct gmsh *g, const struct groups *groups)
{
    for (int k = 0; k < groups->n; k++) {
        char bytes[ENTITY_BYTES + 32], *at = tri_put_i32(bytes, tag_of(g, groups, k));
        at = tri_put_i32(tri_put_i32(at, groups->dimension), k + 1);
        at = tri_put_i32(tri_put_u64(at, 1), g->part + 1);
        at = put_shape(g, at, groups->physical[k]);
        if (has_piece(g, groups, k))
            put_bytes(g, bytes, at);
    }
}

static void put_interface(struct gmsh *g, int64_t i)
{
    const struct tri_shared_point *point = &g->parts->shared[g->parts->first_shared[i]];
    char bytes[ENTITY_BYTES], *at = tri_put_i32(tri_put_i32(tri_put_i32(bytes, interface_tag(g, i)), 2), 1);
    put_bytes(g, bytes, tri_put_i64(at, point->n));
    for (int32_t k = 0; k < point->n; k++)
        put_bytes(g, bytes, tri_put_i32(bytes, point->part[k] + 1));
    put_bytes(g, bytes, put_shape(g, bytes, 0));
}

static int64_t count_interfaces(const struct gmsh *g)
{
    int64_t n = 0;
    for (int64_t i = 0; g->parts && i < g->parts->n_interfaces; i++)
        n += has_interface(g, i);
    return n;
}

/* Writes the partitioned entities; there are no ghost entities. */
static void write_pieces(struct gmsh *g)
{
    char bytes[16];
    if (!g->parts)
        return;
    put_text(g, "$PartitionedEntities\n");
    put_bytes(g, bytes, tri_put_u64(tri_put_i64(bytes, g->parts->n), 0));
    put_entity_counts(g, count_pieces(g, &g->curves) + count_interfaces(g), count_pieces(g, &g->surfaces));
    put_pieces(g, &g->curves);
    for (int64_t i = 0; i < g->parts->n_interfaces; i++)
        if (has_interface(g, i))
            put_interface(g, i);
    put_pieces(g, &g->surfaces);
    put_text(g, "\n$EndPartitionedEntities\n");
}

/* --- nodes: all on the first surface, except those of interfaces */

static char *tag_row(const void *user, int64_t i, char *at)
{
    const struct gmsh *g = user;
    return tri_put_i64(at, node_at(g, i) + 1);
}

static char *place_row(const void *user, int64_t i, char *at)
{
    const struct gmsh *g = user;
    struct tri_grid_point point;
    g->grid->point(g->grid->user, node_at(g, i), &point);
    return tri_put_f64(tri_put_f64(tri_put_f64(at, point.at[0]), point.at[1]), 0);
}

/* Writes the head of $Nodes or $Elements: number of blocks and items, least and greatest tag. */
static void put_totals(struct gmsh *g, int64_t blocks, int64_t n, int64_t least, int64_t greatest)
{
    char bytes[32], *at = tri_put_i64(tri_put_i64(bytes, blocks), n);
    put_bytes(g, bytes, tri_put_i64(tri_put_i64(at, least), greatest));
}

/* Writes the head of a block: dimension and tag of the entity, a number whose meaning depends on the section, number of
 * items. */
static void put_block(struct gmsh *g, int32_t dimension, int32_t tag, int32_t kind, int64_t n)
{
    char bytes[20], *at = tri_put_i32(tri_put_i32(tri_put_i32(bytes, dimension), tag), kind);
    put_bytes(g, bytes, tri_put_i64(at, n));
}

/* Writes nodes first .. first + n - 1 of the file, without parametric coordinates. */
static void write_node_block(struct gmsh *g, int32_t dimension, int32_t tag, int64_t first, int64_t n)
{
    put_block(g, dimension, tag, 0, n);
    put_rows(g, first, n, 8, tag_row);
    put_rows(g, first, n, 24, place_row);
}

static void write_node_blocks(struct gmsh *g)
{
    int64_t first = g->n_inner;
    write_node_block(g, 2, tag_of(g, &g->surfaces, first_surface(g)), 0, g->n_inner);
    for (int64_t i = 0; g->parts && i < g->parts->n_interfaces; i++) {
        if (!has_interface(g, i))
            continue;
        write_node_block(g, 1, interface_tag(g, i), first, interface_size(g, i));
        first += interface_size(g, i);
    }
}

/* Visits only the first and the last inner node, because inner nodes ascend. */
static void put_node_totals(struct gmsh *g)
{
    int64_t least = INT64_MAX, greatest = 0;
    for (int64_t i = 0; i < g->n_nodes; i = i < g->n_inner - 1 ? g->n_inner - 1 : i + 1) {
        const int64_t tag = node_at(g, i) + 1;
        least = tag < least ? tag : least;
        greatest = tag > greatest ? tag : greatest;
    }
    put_totals(g, 1 + count_interfaces(g), g->n_nodes, greatest > 0 ? least : -1, greatest);
}

static void write_nodes(struct gmsh *g)
{
    put_text(g, "$Nodes\n");
    put_node_totals(g);
    write_node_blocks(g);
    put_text(g, "\n$EndNodes\n");
}

/* --- elements */

static int64_t element_tag(const struct gmsh *g, const struct groups *groups, int64_t i)
{
    tri_grid_evict_periodically(g->grid, i);
    return (groups == &g->curves ? g->grid->n_triangles : 0) + place_at(groups, i) + 1;
}

static int64_t item_at(const struct groups *groups, int64_t i)
{
    return tri_grouped(&groups->all, place_at(groups, i));
}

/* Gmsh orders the midpoints of edges by edges: first to second corner, second to third, third to first. */
static char *triangle_row(const void *user, int64_t i, char *at)
{
    static const int order[6] = {0, 1, 2, 5, 3, 4};
    const struct gmsh *g = user;
    int64_t nodes[6];
    g->grid->triangle(g->grid->user, item_at(&g->surfaces, i), nodes);
    at = tri_put_i64(at, element_tag(g, &g->surfaces, i));
    for (int k = 0; k < g->grid->n_nodes; k++)
        at = tri_put_i64(at, nodes[order[k]] + 1);
    return at;
}

static char *segment_row(const void *user, int64_t i, char *at)
{
    const struct gmsh *g = user;
    struct tri_grid_edge segment;
    g->grid->segment(g->grid->user, item_at(&g->curves, i), &segment);
    at = tri_put_i64(at, element_tag(g, &g->curves, i));
    return tri_put_i64(tri_put_i64(at, segment.ends[0] + 1), segment.ends[1] + 1);
}

static void write_blocks(struct gmsh *g, const struct groups *groups, int32_t kind, size_t row_bytes, tri_row_call *row)
{
    for (int k = 0; k < groups->n; k++) {
        if (size_of(groups, k) == 0)
            continue;
        put_block(g, groups->dimension, tag_of(g, groups, k), kind, size_of(groups, k));
        put_rows(g, groups->first[k], size_of(groups, k), row_bytes, row);
    }
}

/* Tags ascend; triangles come before segments. */
static void put_element_totals(struct gmsh *g)
{
    const struct groups *both[] = {&g->surfaces, &g->curves};
    int64_t least = 0, greatest = 0;
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < both[i]->n; k++) {
            if (size_of(both[i], k) == 0)
                continue;
            least = least > 0 ? least : element_tag(g, both[i], both[i]->first[k]);
            greatest = element_tag(g, both[i], both[i]->first[k + 1] - 1);
        }
    put_totals(g, count_blocks(&g->surfaces) + count_blocks(&g->curves), count(&g->surfaces) + count(&g->curves),
               least, greatest);
}

static void write_elements(struct gmsh *g)
{
    const int32_t kind = g->grid->n_nodes == 6 ? GMSH_QUADRATIC_TRIANGLE : GMSH_TRIANGLE;
    put_text(g, "$Elements\n");
    put_element_totals(g);
    write_blocks(g, &g->surfaces, kind, 8 + 8 * (size_t)g->grid->n_nodes, triangle_row);
    write_blocks(g, &g->curves, GMSH_LINE, 24, segment_row);
    put_text(g, "\n$EndElements\n");
}

/* --- data: a tag and a number; markers of triangles and attributes of segments are 0 */

enum { MARKER = -1 };

static char *put_datum(char *at, int64_t tag, double value)
{
    return tri_put_f64(tri_put_i32(at, (int32_t)tag), value);
}

static char *node_datum(const void *user, int64_t i, char *at)
{
    const struct gmsh *g = user;
    const int64_t node = node_at(g, i);
    struct tri_grid_point point;
    if (g->k != MARKER)
        return put_datum(at, node + 1, g->grid->attribute(g->grid->user, node, g->k));
    g->grid->point(g->grid->user, node, &point);
    return put_datum(at, node + 1, point.marker);
}

static char *triangle_datum(const void *user, int64_t i, char *at)
{
    const struct gmsh *g = user;
    const int64_t tag = element_tag(g, &g->surfaces, i);
    const bool none = g->k == MARKER;
    return put_datum(at, tag, none ? 0 : g->grid->column(g->grid->user, item_at(&g->surfaces, i), g->k));
}

static char *segment_datum(const void *user, int64_t i, char *at)
{
    const struct gmsh *g = user;
    const int64_t tag = element_tag(g, &g->curves, i);
    return put_datum(at, tag, g->k == MARKER ? tri_segment_group(g->grid, item_at(&g->curves, i)) : 0);
}

/* Writes the head of a data section: one time step, one component. */
static void begin_data(struct gmsh *g, const char *section, int64_t n)
{
    char head[192], name[32] = "marker";
    if (g->k != MARKER)
        snprintf(name, sizeof name, "attribute_%" PRId32, g->k);
    snprintf(head, sizeof head, "$%s\n1\n\"%s\"\n1\n0\n3\n0\n1\n%" PRId64 "\n", section, name, n);
    put_text(g, head);
}

static void write_node_data(struct gmsh *g)
{
    begin_data(g, "NodeData", g->n_nodes);
    put_rows(g, 0, g->n_nodes, 12, node_datum);
    put_text(g, "\n$EndNodeData\n");
}

static void write_element_data(struct gmsh *g)
{
    begin_data(g, "ElementData", count(&g->surfaces) + count(&g->curves));
    put_rows(g, g->surfaces.first[0], count(&g->surfaces), 12, triangle_datum);
    put_rows(g, g->curves.first[0], count(&g->curves), 12, segment_datum);
    put_text(g, "\n$EndElementData\n");
}

static void write_all_data(struct gmsh *g)
{
    const struct tri_grid *grid = g->grid;
    if (grid->n_points > INT32_MAX || grid->n_triangles + grid->n_segments > INT32_MAX)
        return; /* the format uses 32-bit tags here */
    g->k = MARKER;
    if (grid->has_markers) {
        write_node_data(g);
        write_element_data(g);
    }
    for (g->k = 0; g->k < grid->n_attributes; g->k++)
        write_node_data(g);
    for (g->k = 0; g->k < grid->n_columns; g->k++)
        write_element_data(g);
}

/* --- the file */

static enum tri_status write_all(struct gmsh *g)
{
    char one[4];
    put_text(g, "$MeshFormat\n4.1 1 8\n");
    put_bytes(g, one, tri_put_i32(one, 1)); /* shows the byte order */
    put_text(g, "\n$EndMeshFormat\n");
    write_names(g);
    write_entities(g);
    write_pieces(g);
    write_nodes(g);
    write_elements(g);
    write_all_data(g);
    return g->status;
}

static enum tri_status begin_gmsh(struct gmsh *g)
{
    const struct tri_grid *grid = g->grid;
    enum tri_status status = tri_group(&g->surfaces.all, grid->n_triangles, tri_triangle_group, grid, g->error);
    status = status ? status : tri_group(&g->curves.all, grid->n_segments, tri_segment_group, grid, g->error);
    if (status)
        return status;
    g->surfaces.dimension = 2;
    g->surfaces.n = g->surfaces.all.n;
    g->curves.dimension = 1;
    g->curves.n = grid->n_segments > 0 ? g->curves.all.n : 0;
    choose_physical(&g->surfaces);
    choose_physical(&g->curves);
    find_bounds(g);
    return TRI_OK;
}

static void free_gmsh(struct gmsh *g)
{
    tri_grouping_free(&g->surfaces.all);
    tri_grouping_free(&g->curves.all);
}

enum tri_status tri_write_msh(struct tri_output *output, const struct tri_grid *grid,
                              const struct tri_executor *executor, struct tri_error *error)
{
    struct gmsh g = {.grid = grid, .output = output, .executor = executor, .error = error, .n_nodes = grid->n_points,
                     .n_inner = grid->n_points};
    enum tri_status status = begin_gmsh(&g);
    select_range(&g.surfaces, NULL, 0, grid->n_triangles);
    select_range(&g.curves, NULL, 0, grid->n_segments);
    status = status ? status : write_all(&g);
    free_gmsh(&g);
    return status;
}

static enum tri_status write_part(struct gmsh *g, int part, struct tri_output *output)
{
    const struct tri_parts *p = g->parts;
    g->part = part;
    g->output = output;
    select_range(&g->surfaces, p->triangle, p->first_triangle[part], p->first_triangle[part + 1]);
    select_range(&g->curves, p->segment, p->first_segment[part], p->first_segment[part + 1]);
    enum tri_status status = select_nodes(g);
    status = status ? status : write_all(g);
    free(g->border);
    return status;
}

enum tri_status tri_write_msh_parts(struct tri_output *const *outputs, int n, const struct tri_grid *grid,
                                    const struct tri_executor *executor, struct tri_error *error)
{
    struct tri_parts parts = {0};
    struct gmsh g = {.grid = grid, .executor = executor, .error = error, .parts = &parts};
    enum tri_status status = begin_gmsh(&g);
    status = status ? status : tri_parts_make(&parts, n, grid, &g.surfaces.all, &g.curves.all, error);
    for (int part = 0; part < n && !status; part++)
        status = write_part(&g, part, outputs[part]);
    tri_parts_free(&parts);
    free_gmsh(&g);
    return status;
}
