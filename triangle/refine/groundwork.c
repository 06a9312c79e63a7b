/* What tri_refine_prepare finds in a mesh before the first point is inserted, in this order:
 *
 *   limits      the shortest edge that coordinates can carry
 *   features    how far each vertex is from what is around it (feature_size.h)
 *   acute       input vertices at which two subsegments meet at less than 60 degrees
 *   incidence   the parents that end at each vertex, in order of direction where they are many
 *   gaps        the dearest narrow space that will be filled, by all of the above (small_angle.h)
 *
 * INVARIANT. Refinement only reads these, but for the sizes of the vertices that it adds. */
#include "triangle/refine/groundwork.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/heap_sort.h"
#include "triangle/geometry/predicates.h"
#include "triangle/refine/small_angle.h"
#include "triangle/size/feature_size.h"
#include "triangle/tunables.h"

bool tri_turns_before(struct tri_point o, struct tri_point a, struct tri_point b)
{
    bool a_down = a.y < o.y || (a.y == o.y && a.x < o.x), b_down = b.y < o.y || (b.y == o.y && b.x < o.x);
    return a_down != b_down ? b_down : tri_orient2d(o, a, b) > 0;
}

struct tri_point tri_far_end(const struct tri_mesh *mesh, tri_parent_id parent, tri_vertex_id v)
{
    const int32_t *ends = mesh->parents[parent].v;
    return mesh->xy[ends[ends[0] == v]];
}

static bool is_input(int32_t on) { return on == TRI_VERTEX_INPUT || on == TRI_VERTEX_ACUTE; }

/* The subsegment that comes next counter-clockwise after subsegment s around its end k, inside the mesh; TRI_NONE where
 * the outside comes first. */
static tri_sub_id next_around(const struct tri_mesh *mesh, tri_sub_id s, int k)
{
    tri_halfedge code = mesh->sub[s].side[k];
    while (code != TRI_NONE) { /* edge `code` starts at the vertex, counter-clockwise in its triangle */
        tri_link link = mesh->tri[tri_of(code)].n[tri_prev[tri_edge(code)]];
        if (link < 0)
            return ~link;
        code = tri_code(tri_of(link), tri_edge(link));
    }
    return TRI_NONE;
}

static void find_acute(struct tri_mesh *mesh)
{
    for (tri_sub_id s = 0; s < mesh->n_subs; s++)
        for (int k = 0; k < 2; k++) {
            tri_vertex_id v = mesh->sub[s].v[k];
            tri_sub_id other = is_input(mesh->on[v]) ? next_around(mesh, s, k) : TRI_NONE;
            if (other == TRI_NONE || other == s)
                continue;
            struct tri_point o = mesh->xy[v], a = mesh->xy[mesh->sub[s].v[1 - k]];
            struct tri_point b = mesh->xy[mesh->sub[other].v[mesh->sub[other].v[0] == v]];
            double ax = a.x - o.x, ay = a.y - o.y, bx = b.x - o.x, by = b.y - o.y;
            double dot = ax * bx + ay * by, cross = ax * by - ay * bx;
            if (dot > 0 && cross > 0 && 4 * dot * dot > (ax * ax + ay * ay) * (bx * bx + by * by))
                mesh->on[v] = TRI_VERTEX_ACUTE;
        }
}

struct hub {
    const struct tri_mesh *mesh;
    tri_vertex_id vertex;
};

static bool is_before(const void *context, int32_t a, int32_t b)
{
    const struct hub *hub = context;
    return tri_turns_before(hub->mesh->xy[hub->vertex], tri_far_end(hub->mesh, a, hub->vertex),
                            tri_far_end(hub->mesh, b, hub->vertex));
}

static void sort_around(const struct tri_mesh *mesh, tri_vertex_id v, tri_parent_id *parent, int32_t n)
{
    struct hub hub = {mesh, v};
    if (n > TRI_MANY_PARENTS)
        tri_heap_sort(parent, n, is_before, &hub);
}

void tri_incidence_fill(struct tri_mesh *mesh)
{
    size_t n = (size_t)mesh->incidence.n_vertices;
    int32_t *fill = mesh->incidence.start + 1; /* shifted by one, so that filling leaves the starts in place */
    memset(mesh->incidence.start, 0, (n + 2) * sizeof *mesh->incidence.start);
    for (tri_parent_id p = 0; p < mesh->n_parents; p++)
        for (int k = 0; k < 2; k++)
            fill[mesh->parents[p].v[k] + 1]++;
    for (size_t v = 0; v < n; v++)
        fill[v + 1] += fill[v];
    for (tri_parent_id p = 0; p < mesh->n_parents; p++)
        for (int k = 0; k < 2; k++)
            mesh->incidence.parent[fill[mesh->parents[p].v[k]]++] = p;
    assert(mesh->incidence.start[n] == 2 * mesh->n_parents);
    for (tri_vertex_id v = 0; v < mesh->incidence.n_vertices; v++) {
        int32_t first = mesh->incidence.start[v];
        sort_around(mesh, v, mesh->incidence.parent + first, mesh->incidence.start[v + 1] - first);
    }
}

static enum tri_status list_parents(struct tri_mesh *mesh, struct tri_error *error)
{
    assert(!mesh->incidence.start && !mesh->incidence.parent);
    mesh->incidence.start = malloc(((size_t)mesh->n_vertices + 2) * sizeof *mesh->incidence.start);
    mesh->incidence.parent = malloc((2 * (size_t)mesh->n_parents + 1) * sizeof *mesh->incidence.parent);
    if (!mesh->incidence.start || !mesh->incidence.parent) {
        free(mesh->incidence.start);
        free(mesh->incidence.parent);
        mesh->incidence = (struct tri_incidence){0};
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for %d segments", (int)mesh->n_parents);
    }
    mesh->incidence.n_vertices = mesh->n_vertices;
    tri_incidence_fill(mesh);
    return TRI_OK;
}

double tri_shortest_edge2(const struct tri_mesh *mesh)
{
    double size = 0;
    for (tri_vertex_id v = 0; v < mesh->n_input; v++) {
        size = fabs(mesh->xy[v].x) > size ? fabs(mesh->xy[v].x) : size;
        size = fabs(mesh->xy[v].y) > size ? fabs(mesh->xy[v].y) : size;
    }
    return size * TRI_SHORTEST_EDGE * (size * TRI_SHORTEST_EDGE);
}

enum tri_status tri_refine_prepare(struct tri_mesh *mesh, const struct tri_executor *executor, struct tri_error *error)
{
    if (mesh->incidence.start)
        return TRI_OK;
    mesh->limits.shortest2 = tri_shortest_edge2(mesh);
    tri_estimate_features(mesh, executor);
    find_acute(mesh);
    enum tri_status status = list_parents(mesh, error);
    if (!status)
        tri_choose_gaps(mesh, executor);
    return status;
}
