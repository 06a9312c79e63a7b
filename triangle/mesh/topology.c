/* Edges are told once by a rule that looks at two triangles alone: the one with the lower number tells. */
#include "triangle/mesh/topology.h"

#include <assert.h>
#include <errno.h>
#include <string.h>

#include "triangle/geometry/predicates.h"

/* Edges of a triangle in the order of the list, by their opposite corners. */
static const int edge_order[3] = {2, 0, 1};

void tri_neighbors(const struct tri_mesh *mesh, tri_triangle_id t, tri_triangle_id neighbors[3])
{
    for (int e = 0; e < 3; e++) {
        tri_halfedge other = tri_across(mesh, tri_code(t, e));
        neighbors[e] = other == TRI_NONE ? TRI_NONE : tri_of(other);
    }
}

/* Does this triangle come first at the edge? `other` is the edge seen from beyond. */
static bool is_first(tri_halfedge code, tri_halfedge other) { return other == TRI_NONE || other > code; }

static int32_t count_edges(const struct tri_mesh *mesh)
{
    int32_t n = 0;
    for (tri_triangle_id t = 0; t < mesh->n_triangles; t++) {
        assert(tri_is_live(&mesh->tri[t]));
        for (int e = 0; e < 3; e++)
            n += is_first(tri_code(t, e), tri_across(mesh, tri_code(t, e)));
    }
    return n;
}

static void list_edges(struct tri_edge_list *list, const struct tri_mesh *mesh)
{
    int32_t n = 0;
    for (tri_triangle_id t = 0; t < mesh->n_triangles; t++)
        for (int k = 0; k < 3; k++) {
            tri_halfedge code = tri_code(t, edge_order[k]), other = tri_across(mesh, code);
            if (!is_first(code, other))
                continue;
            if (list->number) {
                list->number[3 * (size_t)t + (size_t)tri_edge(code)] = n;
                if (other != TRI_NONE)
                    list->number[3 * (size_t)tri_of(other) + (size_t)tri_edge(other)] = n;
            }
            list->codes[n++] = code;
        }
    assert(n == list->n);
}

enum tri_status tri_edge_list_make(struct tri_edge_list *list, const struct tri_mesh *mesh, bool with_numbers,
                                   struct tri_error *error)
{
    *list = (struct tri_edge_list){.n = count_edges(mesh), .mesh = mesh};
    list->codes = tri_mesh_extra(mesh, ((size_t)list->n + 1) * sizeof *list->codes);
    if (with_numbers)
        list->number = tri_mesh_extra(mesh, 3 * ((size_t)mesh->n_triangles + 1) * sizeof *list->number);
    if (!list->codes || (with_numbers && !list->number)) {
        const int fault = errno;
        tri_edge_list_free(list);
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "no room for the edges of %d triangles: %s",
                        (int)mesh->n_triangles, strerror(fault));
    }
    list_edges(list, mesh);
    return TRI_OK;
}

void tri_edge_list_free(struct tri_edge_list *list)
{
    if (list->mesh) {
        tri_mesh_extra_free(list->mesh, list->codes);
        tri_mesh_extra_free(list->mesh, list->number);
    }
    *list = (struct tri_edge_list){0};
}

double tri_blend_attribute(const struct tri_mesh *mesh, const struct tri_blend *blend, int32_t attribute)
{
    double corner[3];
    for (int k = 0; k < 3; k++)
        corner[k] = mesh->attributes[(size_t)blend->v[k] * (size_t)mesh->n_attributes + (size_t)attribute];
    return corner[0] + blend->weight[0] * (corner[1] - corner[0]) + blend->weight[1] * (corner[2] - corner[0]);
}

struct tri_blend tri_edge_middle(const struct tri_mesh *mesh, tri_halfedge code)
{
    int32_t ends[2];
    tri_edge_ends(mesh, code, ends);
    struct tri_point p = tri_point_between(mesh->xy[ends[0]], mesh->xy[ends[1]], 0.5);
    return (struct tri_blend){{p.x * mesh->unit, p.y * mesh->unit}, {ends[0], ends[1], ends[0]}, {0.5, 0}};
}

/* The orientation predicate approximates the area well even where plain arithmetic has lost it. */
struct tri_blend tri_voronoi_vertex(const struct tri_mesh *mesh, tri_triangle_id t)
{
    const tri_vertex_id *v = mesh->tri[t].v;
    struct tri_point a = mesh->xy[v[0]], b = mesh->xy[v[1]], c = mesh->xy[v[2]];
    double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
    double b2 = bx * bx + by * by, c2 = cx * cx + cy * cy, area2 = tri_orient2d(a, b, c);
    double x = (cy * b2 - by * c2) / (2 * area2), y = (bx * c2 - cx * b2) / (2 * area2);
    struct tri_blend blend = {{(a.x + x) * mesh->unit, (a.y + y) * mesh->unit}, {v[0], v[1], v[2]}, {0, 0}};
    blend.weight[0] = (x * cy - y * cx) / area2;
    blend.weight[1] = (bx * y - by * x) / area2;
    return blend;
}

void tri_voronoi_edge(const struct tri_mesh *mesh, tri_halfedge code, tri_triangle_id ends[2], double direction[2])
{
    int32_t other = tri_across(mesh, code), edge[2];
    ends[0] = tri_of(code);
    ends[1] = other == TRI_NONE ? TRI_NONE : tri_of(other);
    direction[0] = direction[1] = 0;
    if (other != TRI_NONE)
        return;
    tri_edge_ends(mesh, code, edge);
    direction[0] = (mesh->xy[edge[1]].y - mesh->xy[edge[0]].y) * mesh->unit;
    direction[1] = (mesh->xy[edge[0]].x - mesh->xy[edge[1]].x) * mesh->unit;
}

enum tri_status tri_used_make(struct tri_used *used, const struct tri_mesh *mesh, struct tri_error *error)
{
    size_t size = (size_t)mesh->n_vertices + 1;
    *used = (struct tri_used){0, tri_mesh_extra(mesh, size * sizeof *used->vertex),
                              tri_mesh_extra(mesh, size * sizeof *used->number), mesh};
    if (!used->vertex || !used->number) {
        const int fault = errno;
        tri_used_free(used);
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "no room to number %d vertices: %s", (int)mesh->n_vertices,
                        strerror(fault));
    }
    for (tri_vertex_id v = 0; v < mesh->n_vertices; v++)
        used->number[v] = TRI_NONE;
    for (tri_triangle_id t = 0; t < mesh->n_triangles; t++)
        for (int k = 0; k < 3; k++)
            used->number[mesh->tri[t].v[k]] = 0;
    for (tri_vertex_id v = 0; v < mesh->n_vertices; v++)
        if (used->number[v] != TRI_NONE) {
            used->number[v] = used->n;
            used->vertex[used->n++] = v;
        }
    return TRI_OK;
}

enum tri_status tri_kept_make(struct tri_used *kept, const struct tri_mesh *mesh, const struct tri_elements *elements,
                              bool jettison, struct tri_error *error)
{
    enum { DROPPED = TRI_NONE - 1 };
    size_t n = elements->extra ? (size_t)elements->n * (size_t)(elements->n_nodes - 3) : 0;
    *kept = (struct tri_used){0};
    enum tri_status status = jettison || n > 0 ? tri_used_make(kept, mesh, error) : TRI_OK;
    if (status || jettison || n == 0)
        return status;
    for (size_t i = 0; i < n; i++) {
        tri_vertex_id v = elements->extra[i];
        if (v >= 0 && v < mesh->n_input && kept->number[v] == TRI_NONE)
            kept->number[v] = DROPPED;
    }
    kept->n = 0;
    for (tri_vertex_id v = 0; v < mesh->n_vertices; v++) {
        bool is_kept = kept->number[v] != DROPPED;
        kept->number[v] = is_kept ? kept->n : TRI_NONE;
        if (is_kept)
            kept->vertex[kept->n++] = v;
    }
    assert(kept->n <= mesh->n_vertices);
    return TRI_OK;
}

void tri_used_free(struct tri_used *used)
{
    if (used->mesh) {
        tri_mesh_extra_free(used->mesh, used->vertex);
        tri_mesh_extra_free(used->mesh, used->number);
    }
    *used = (struct tri_used){0};
}
