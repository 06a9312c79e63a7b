/* Rules that make refinement terminate on any PSLG, in addition to the order of the loop (refine.c).
 *
 * THEOREM (Chew 1993; Shewchuk 2002; Rand 2011). Refinement for bounds up to 28.6 degrees terminates if segments
 * meet at 60 degrees or more. RULE. A triangle is not refined for its angle if its shortest edge (docs/theory.md,
 * the rule)
 *   - joins two segments that meet at an acute vertex, on one of the circles on which they are split (concentric
 *     shells: Ruppert 1995; Miller, Pav & Walkington 2003): the input angle dictates its length;
 *   - joins the sides of a spike, two segments that meet at less than 1 / TRI_SHARP;
 *   - bridges a gap between two segments, or the end of a gap, and filling it (about length / width points) would
 *     take more points than the mesh can afford (tri_choose_gaps);
 *   - is below limits.shortest2 and may be a rounding error;
 *   - has run away (feature_size.c): above 28.6 degrees, new points may create ever smaller bad triangles.
 * Such triangles are counted by reason (tri_count_bad). */
#include "triangle/size/hopeless.h"

#include "triangle/size/feature_size.h"
#include "triangle/size/gap.h"

/* Returns the common vertex of the parents on which u and v lie; TRI_NONE if they do not meet or are the same. */
static tri_vertex_id apex_between(const struct tri_mesh *mesh, tri_vertex_id u, tri_vertex_id v)
{
    tri_parent_id pu = mesh->on[u], pv = mesh->on[v];
    for (int i = 0; pu >= 0 && pv >= 0 && pu != pv && i < 2; i++)
        for (int k = 0; k < 2; k++)
            if (mesh->parents[pu].v[i] == mesh->parents[pv].v[k])
                return mesh->parents[pu].v[i];
    return TRI_NONE;
}

/* Do u and v lie at the same distance from the common vertex of two segments? Then the angle there dictates their
 * distance (Miller, Pav & Walkington 2003). */
static bool on_one_shell(const struct tri_mesh *mesh, tri_vertex_id u, tri_vertex_id v, double uv2)
{
    tri_vertex_id apex = apex_between(mesh, u, v);
    if (apex == TRI_NONE)
        return false;
    double du = tri_distance2(mesh->xy[apex], mesh->xy[u]), dv = tri_distance2(mesh->xy[apex], mesh->xy[v]);
    return du < 1.002 * dv && dv < 1.002 * du && uv2 < 0.99 * du;
}

bool tri_crosses_angle(const struct tri_mesh *mesh, tri_triangle_id triangle, const struct tri_shape *shape)
{
    const tri_vertex_id *v = mesh->tri[triangle].v;
    return apex_between(mesh, v[tri_next[shape->shortest]], v[tri_prev[shape->shortest]]) != TRI_NONE;
}

bool tri_is_hopeless(const struct tri_mesh *mesh, tri_triangle_id triangle, const struct tri_shape *shape)
{
    const struct tri_triangle *t = &mesh->tri[triangle];
    int k = shape->shortest;
    tri_vertex_id u = t->v[tri_next[k]], v = t->v[tri_prev[k]];
    return shape->l[k] < mesh->limits.shortest2 || tri_has_run_away(mesh, u, v, shape->l[k]) ||
           on_one_shell(mesh, u, v, shape->l[k]) || tri_is_narrow_gap(mesh, triangle, shape);
}
