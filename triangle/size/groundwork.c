/* What tri_refine_prepare finds in a mesh before the first point is inserted, in this order:
 *
 *   surface     of the attributes of vertices (surface.h)
 *   acute       input vertices at which two subsegments meet at less than 60 degrees
 *   incidence   the parents that end at each vertex, in order of direction where they are many
 *   limits      the shortest edge that coordinates can carry
 *   gaps        the dearest narrow space that will be filled, by all of the above (gap.h)
 *   features    how far each vertex is from what is around it, by all of the above (feature_size.h)
 *
 * RULE (rounding). Distances of 32 to 256 resolutions are features if at most TRI_FEW_BLURRED vertices are so near to
 * another one or to a segment. If more are, lines were computed twice, or points that belong on them: then such
 * distances are rounding. Each that counts as a feature takes some 100 to 400 triangles.
 *
 * INVARIANT. Refinement only reads these, but for the sizes of the vertices that it adds. */
#include "triangle/size/groundwork.h"

#include "triangle/mesh/parents.h"
#include "triangle/mesh/surface.h"
#include "triangle/size/feature_size.h"
#include "triangle/size/gap.h"
#include "triangle/tunables.h"

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

static double largest_coordinate(const struct tri_mesh *mesh)
{
    double size = 0;
    for (tri_vertex_id v = 0; v < mesh->n_input; v++)
        size = tri_larger(size, tri_larger(fabs(mesh->xy[v].x), fabs(mesh->xy[v].y)));
    return size;
}

/* Gaps and sizes, if what is nearer than this is no feature. Returns how many vertices have features up to TRI_BLUR
 * times as far (what no triangle uses has the least size). */
static int32_t find_features(struct tri_mesh *mesh, double rounding, const struct tri_executor *executor)
{
    int32_t n = 0;
    mesh->limits.shortest2 = rounding * rounding;
    tri_choose_gaps(mesh, executor);
    tri_estimate_features(mesh, executor);
    for (tri_vertex_id v = 0; v < mesh->n_vertices; v++)
        n += mesh->feature[v] > rounding && mesh->feature[v] < TRI_BLUR * rounding;
    return n;
}

enum tri_status tri_refine_prepare(struct tri_mesh *mesh, const struct tri_executor *executor, struct tri_error *error)
{
    if (mesh->incidence.start)
        return TRI_OK;
    enum tri_status status = tri_surface_keep(mesh, executor, error);
    find_acute(mesh);
    status = status ? status : tri_incidence_list(mesh, error);
    if (status)
        return status;
    const double shortest = TRI_SHORTEST_EDGE * largest_coordinate(mesh);
    mesh->limits.finest2 = shortest * shortest;
    if (find_features(mesh, shortest, executor) > TRI_FEW_BLURRED)
        find_features(mesh, TRI_BLUR * shortest, executor);
    return TRI_OK;
}
