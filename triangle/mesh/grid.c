/* A grid made from a struct tri_mesh.
 *
 * Vertex v of the mesh is point number_of(v), which is v unless vertices are left out. The midpoints of the edges
 * follow the vertices, in the order of the edges. */
#include "triangle/mesh/grid.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/mesh/topology.h"

struct source {
    const struct tri_mesh *mesh;
    const struct tri_pslg *pslg;
    struct tri_edge_list edges; /* empty unless edges or midpoints are requested */
    struct tri_used used;       /* vertex and number are NULL if all vertices are points */
    int32_t n_vertices;         /* number of points that are vertices */
    int32_t *loose;             /* [n_loose] input segments that are not edges of the mesh */
    int32_t n_loose;
    int n_nodes;
};

static int32_t number_of(const struct source *s, tri_vertex_id v) { return s->used.number ? s->used.number[v] : v; }
static tri_vertex_id vertex_of(const struct source *s, int64_t i)
{
    return s->used.vertex ? s->used.vertex[i] : (int32_t)i;
}
static tri_halfedge middle_of(const struct source *s, int64_t i) { return s->edges.codes[i - s->n_vertices]; }

/* --- items */

static void point(const void *user, int64_t i, struct tri_grid_point *point)
{
    const struct source *s = user;
    if (i >= s->n_vertices) {
        struct tri_blend middle = tri_edge_middle(s->mesh, middle_of(s, i));
        *point = (struct tri_grid_point){{middle.at[0], middle.at[1]}, tri_edge_marker(s->mesh, middle_of(s, i))};
        return;
    }
    tri_vertex_id v = vertex_of(s, i);
    point->marker = s->mesh->vertex_markers[v];
    if (v < s->mesh->n_input)
        memcpy(point->at, &s->pslg->points[2 * (size_t)v], sizeof point->at);
    else
        tri_mesh_place(s->mesh, v, point->at);
}

static double attribute(const void *user, int64_t i, int32_t k)
{
    const struct source *s = user;
    if (i < s->n_vertices)
        return s->mesh->attributes[(size_t)vertex_of(s, i) * (size_t)s->mesh->n_attributes + (size_t)k];
    struct tri_blend middle = tri_edge_middle(s->mesh, middle_of(s, i));
    return tri_blend_attribute(s->mesh, &middle, k);
}

static void triangle(const void *user, int64_t i, int64_t nodes[6])
{
    const struct source *s = user;
    for (int k = 0; k < 3; k++)
        nodes[k] = number_of(s, s->mesh->tri[i].v[k]);
    for (int k = 0; s->n_nodes == 6 && k < 3; k++)
        nodes[3 + k] = (int64_t)s->n_vertices + s->edges.number[3 * i + k];
}

static double column(const void *user, int64_t i, int32_t k)
{
    const struct source *s = user;
    return tri_region_attributes(s->mesh, s->mesh->tri[i].region)[k];
}

static void neighbors(const void *user, int64_t i, int64_t neighbors[3])
{
    const struct source *s = user;
    int32_t across[3];
    tri_neighbors(s->mesh, (int32_t)i, across);
    for (int k = 0; k < 3; k++)
        neighbors[k] = across[k] == TRI_NONE ? -1 : across[k];
}

/* The subsegments of the mesh, then the loose segments. */
static void segment(const void *user, int64_t i, struct tri_grid_edge *segment)
{
    const struct source *s = user;
    const int32_t *ends;
    *segment = (struct tri_grid_edge){.marker = 0};
    if (i < s->mesh->n_subs) {
        ends = s->mesh->sub[i].v;
        segment->marker = s->mesh->sub[i].marker;
    } else {
        int32_t k = s->loose[i - s->mesh->n_subs];
        ends = &s->pslg->segments[2 * (size_t)k];
        segment->marker = s->pslg->segment_markers ? s->pslg->segment_markers[k] : 0;
    }
    segment->ends[0] = number_of(s, ends[0]);
    segment->ends[1] = number_of(s, ends[1]);
}

static void edge(const void *user, int64_t i, struct tri_grid_edge *edge)
{
    const struct source *s = user;
    int32_t code = s->edges.codes[i], ends[2];
    tri_edge_ends(s->mesh, code, ends);
    *edge = (struct tri_grid_edge){{number_of(s, ends[0]), number_of(s, ends[1])}, tri_edge_marker(s->mesh, code), {0}};
}

/* --- Voronoi diagram */

static void voronoi_point(const void *user, int64_t i, struct tri_grid_point *point)
{
    const struct source *s = user;
    struct tri_blend center = tri_voronoi_vertex(s->mesh, (int32_t)i);
    *point = (struct tri_grid_point){{center.at[0], center.at[1]}, 0};
}

static double voronoi_attribute(const void *user, int64_t i, int32_t k)
{
    const struct source *s = user;
    struct tri_blend center = tri_voronoi_vertex(s->mesh, (int32_t)i);
    return tri_blend_attribute(s->mesh, &center, k);
}

static void voronoi_edge(const void *user, int64_t i, struct tri_grid_edge *edge)
{
    const struct source *s = user;
    int32_t ends[2];
    tri_voronoi_edge(s->mesh, s->edges.codes[i], ends, edge->direction);
    edge->ends[0] = ends[0];
    edge->ends[1] = ends[1] == TRI_NONE ? -1 : ends[1];
    edge->marker = 0;
}

struct tri_grid tri_grid_voronoi(const struct tri_grid *grid)
{
    return (struct tri_grid){.user = grid->user, .base = grid->base, .n_points = grid->n_triangles,
                             .n_attributes = grid->n_attributes, .n_edges = grid->n_edges, .point = voronoi_point,
                             .attribute = voronoi_attribute, .edge = voronoi_edge};
}

/* --- the whole grid */

/* Every boundary edge is a subsegment. */
static int64_t count_edges(const struct tri_mesh *mesh)
{
    int64_t boundary = 0;
    for (tri_sub_id s = 0; s < mesh->n_subs; s++)
        boundary += tri_is_boundary(&mesh->sub[s]);
    return (3 * (int64_t)mesh->n_triangles + boundary) / 2;
}

/* Lists the input segments that are not edges of the mesh but whose ends are points of the grid. */
static enum tri_status list_loose(struct source *s, const bool *is_edge, struct tri_error *error)
{
    int32_t n = is_edge ? s->pslg->n_segments : 0;
    s->loose = malloc(((size_t)n + 1) * sizeof *s->loose);
    if (!s->loose)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for %d segments", (int)n);
    for (int32_t k = 0; k < n; k++) {
        const int32_t *ends = &s->pslg->segments[2 * (size_t)k];
        if (!is_edge[k] && number_of(s, ends[0]) != TRI_NONE && number_of(s, ends[1]) != TRI_NONE)
            s->loose[s->n_loose++] = k;
    }
    return TRI_OK;
}

static enum tri_status list_all(struct source *s, const struct tri_grid_options *options, struct tri_error *error)
{
    static const struct tri_elements none;
    const struct tri_elements *elements = options->elements ? options->elements : &none;
    enum tri_status status = tri_kept_make(&s->used, s->mesh, elements, options->jettison, error);
    if (!status && (options->edges || options->second_order))
        status = tri_edge_list_make(&s->edges, s->mesh, options->second_order, error);
    s->n_vertices = s->used.number ? s->used.n : s->mesh->n_vertices;
    return status ? status : list_loose(s, options->is_edge, error);
}

static void free_source(struct source *s)
{
    tri_edge_list_free(&s->edges);
    tri_used_free(&s->used);
    free(s->loose);
    free(s);
}

static struct tri_grid describe(const struct source *s, const struct tri_grid_options *options)
{
    const struct tri_mesh *mesh = options->mesh;
    struct tri_grid grid = {.user = s, .base = options->base, .has_markers = options->markers,
                            .n_triangles = mesh->n_triangles, .n_segments = (int64_t)mesh->n_subs + s->n_loose,
                            .n_edges = count_edges(mesh), .n_attributes = mesh->n_attributes, .n_nodes = s->n_nodes,
                            .figure = options->pslg, .storage = mesh->storage, .point = point,
                            .attribute = attribute, .triangle = triangle, .column = column,
                            .neighbors = neighbors, .segment = segment, .edge = edge};
    grid.n_points = s->n_vertices + (options->second_order ? grid.n_edges : 0);
    grid.n_columns = options->elements ? mesh->n_columns : options->regions;
    assert(!s->edges.codes || s->edges.n == grid.n_edges);
    return grid;
}

enum tri_status tri_grid_make(struct tri_grid *grid, const struct tri_grid_options *options, struct tri_error *error)
{
    struct source *s = calloc(1, sizeof *s);
    *grid = (struct tri_grid){0};
    if (!s)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory to output a mesh");
    s->mesh = options->mesh;
    s->pslg = options->pslg;
    s->n_nodes = options->second_order ? 6 : 3;
    enum tri_status status = list_all(s, options, error);
    if (status)
        free_source(s);
    else
        *grid = describe(s, options);
    return status;
}

void tri_grid_free(struct tri_grid *grid)
{
    if (grid->user)
        free_source((struct source *)grid->user); /* made by tri_grid_make */
    *grid = (struct tri_grid){0};
}
