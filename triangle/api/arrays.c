/* A mesh as arrays. Most arrays are views of the mesh, with strides; the others are made on request. */
#include <stdlib.h>

#include "triangle/api/figure.h"
#include "triangle/api/opaque_mesh.h"
#include "triangle/mesh/topology.h"

static const struct tri_api_mesh *api(const struct tri_mesh *mesh) { return (const struct tri_api_mesh *)mesh; }

_Static_assert(sizeof(struct tri_point) == 2 * sizeof(double), "points lie without gaps");

enum {
    TRIANGLE_STRIDE = sizeof(struct tri_triangle) / sizeof(int32_t),
    SEGMENT_STRIDE = sizeof(struct tri_subsegment) / sizeof(int32_t)
};

struct tri_reals tri_mesh_points(const struct tri_mesh *mesh)
{
    return tri_reals_of(api(mesh)->places ? api(mesh)->places : &mesh->xy[0].x, mesh->n_vertices, 2);
}

struct tri_reals tri_mesh_point_attributes(const struct tri_mesh *mesh)
{
    return tri_reals_of(mesh->attributes, mesh->n_attributes > 0 ? mesh->n_vertices : 0, mesh->n_attributes);
}

struct tri_ints tri_mesh_point_markers(const struct tri_mesh *mesh)
{
    return tri_ints_of(mesh->vertex_markers, mesh->n_vertices, 1);
}

struct tri_ints tri_mesh_triangles(const struct tri_mesh *mesh)
{
    return (struct tri_ints){mesh->n_triangles > 0 ? mesh->tri[0].v : NULL, mesh->n_triangles, 3, TRIANGLE_STRIDE};
}

struct tri_reals tri_mesh_triangle_attributes(const struct tri_mesh *mesh)
{
    return tri_reals_of(api(mesh)->attributes, api(mesh)->attributes ? mesh->n_triangles : 0,
                        mesh->columns ? mesh->n_columns : 1);
}

struct tri_ints tri_mesh_segments(const struct tri_mesh *mesh)
{
    return (struct tri_ints){mesh->n_subs > 0 ? mesh->sub[0].v : NULL, mesh->n_subs, 2, SEGMENT_STRIDE};
}

struct tri_ints tri_mesh_segment_markers(const struct tri_mesh *mesh)
{
    return (struct tri_ints){mesh->n_subs > 0 ? &mesh->sub[0].marker : NULL, mesh->n_subs, 1, SEGMENT_STRIDE};
}

void tri_mesh_figure(const struct tri_mesh *mesh, struct tri_figure *figure)
{
    struct tri_figure own = tri_no_figure();
    own.points = tri_mesh_points(mesh);
    own.point_attributes = tri_mesh_point_attributes(mesh);
    own.point_markers = tri_mesh_point_markers(mesh);
    own.segments = tri_mesh_segments(mesh);
    own.segment_markers = tri_mesh_segment_markers(mesh);
    own.triangles = tri_mesh_triangles(mesh);
    own.triangle_attributes = tri_mesh_triangle_attributes(mesh);
    (void)tri_api_struct_give(figure, &own, sizeof own, "tri_figure", NULL); /* cannot fail, because the size is set */
}

enum tri_status tri_mesh_neighbors(struct tri_mesh *mesh, struct tri_ints *neighbors, struct tri_error *error)
{
    struct tri_api_mesh *m = (struct tri_api_mesh *)mesh;
    if (!m->neighbors) {
        m->neighbors = malloc(((size_t)mesh->n_triangles + 1) * 3 * sizeof *m->neighbors);
        if (!m->neighbors)
            return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for neighbours of %d triangles",
                            (int)mesh->n_triangles);
        for (tri_triangle_id t = 0; t < mesh->n_triangles; t++)
            tri_neighbors(mesh, t, &m->neighbors[3 * (size_t)t]);
    }
    *neighbors = tri_ints_of(m->neighbors, mesh->n_triangles, 3);
    return TRI_OK;
}

static enum tri_status make_edges(struct tri_api_mesh *m, struct tri_error *error)
{
    struct tri_edge_list list;
    enum tri_status status = tri_edge_list_make(&list, &m->mesh, false, error);
    if (status)
        return status;
    m->edges = malloc(((size_t)list.n + 1) * 2 * sizeof *m->edges);
    m->edge_markers = malloc(((size_t)list.n + 1) * sizeof *m->edge_markers);
    if (m->edges && m->edge_markers) {
        for (int32_t i = 0; i < list.n; i++) {
            tri_edge_ends(&m->mesh, list.codes[i], &m->edges[2 * (size_t)i]);
            m->edge_markers[i] = tri_edge_marker(&m->mesh, list.codes[i]);
        }
        m->n_edges = list.n;
    } else {
        free(m->edges);
        free(m->edge_markers);
        m->edges = m->edge_markers = NULL;
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for %d edges", (int)list.n);
    }
    tri_edge_list_free(&list);
    return status;
}

enum tri_status tri_mesh_edges(struct tri_mesh *mesh, struct tri_ints *edges, struct tri_ints *markers,
                               struct tri_error *error)
{
    struct tri_api_mesh *m = (struct tri_api_mesh *)mesh;
    enum tri_status status = m->edges ? TRI_OK : make_edges(m, error);
    if (status)
        return status;
    *edges = tri_ints_of(m->edges, m->n_edges, 2);
    if (markers)
        *markers = tri_ints_of(m->edge_markers, m->n_edges, 1);
    return TRI_OK;
}

const char *tri_version(void) { return PTRIANGLE_VERSION; }
