/* Back through the flips: before a flip, a point of its quadrilateral lay in the one of its two triangles that is on
 * the point's side of the former diagonal. So a walk from the triangle that a point lies in now, from flip to earlier
 * flip, ends at the number of the triangle that it lay in at first. The side is decided exactly; where rounding has
 * moved a centroid out of its triangle, the walk ends at a triangle nearby that no subsegment parts from it, since no
 * flip has crossed one. */
#include "triangle/cdt/flip_history.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/base/grow.h"
#include "triangle/geometry/predicates.h"

struct tri_flip_record {
    tri_triangle_id left, right; /* the triangles on either side of the old diagonal, in both of which the flip ended */
    tri_vertex_id from, to;      /* that diagonal */
    int32_t left_before, right_before; /* the last flips of these triangles before this one, or TRI_NONE */
};

bool tri_flip_history_begin(struct tri_flip_history *h, const struct tri_mesh *mesh)
{
    *h = (struct tri_flip_history){.last = malloc(((size_t)mesh->n_triangles + 1) * sizeof *h->last)};
    for (tri_triangle_id t = 0; h->last && t < mesh->n_triangles; t++)
        h->last[t] = TRI_NONE;
    return h->last;
}

void tri_flip_history_free(struct tri_flip_history *h)
{
    free(h->last);
    free(h->flip);
}

/* Flips may be quadratically many: their history may not. Where it is cut short regions move a little, as they do where
 * refinement follows refinement. */
static bool is_long(const struct tri_flip_history *h, const struct tri_mesh *mesh)
{
    enum { MOST = 4, FEW = 1 << 20 };
    return h->n > FEW && h->n / MOST >= mesh->n_triangles;
}

bool tri_flip_history_add(struct tri_flip_history *h, struct tri_mesh *mesh, tri_triangle_id t, int e)
{
    const tri_triangle_id u = tri_of(mesh->tri[t].n[e]);
    assert(mesh->tri[t].n[e] >= 0 && t != u);
    if (is_long(h, mesh))
        tri_flip_history_settle(h, mesh);
    if (!tri_grow(&h->flip, &h->capacity, h->n + 1, sizeof *h->flip))
        return false;
    const tri_vertex_id *v = mesh->tri[t].v;
    h->flip[h->n] = (struct tri_flip_record){t, u, v[tri_next[e]], v[tri_prev[e]], h->last[t], h->last[u]};
    h->last[t] = h->last[u] = h->n++;
    return true;
}

static tri_region_id region_before(const struct tri_flip_history *h, const struct tri_mesh *mesh, tri_triangle_id t)
{
    const tri_vertex_id *v = mesh->tri[t].v;
    const struct tri_point a = mesh->xy[v[0]], b = mesh->xy[v[1]], c = mesh->xy[v[2]];
    const struct tri_point centroid = {tri_round_coordinate((a.x + b.x + c.x) / 3),
                                       tri_round_coordinate((a.y + b.y + c.y) / 3)};
    for (int32_t at = h->last[t]; at != TRI_NONE;) {
        const struct tri_flip_record *flip = &h->flip[at];
        const bool left = tri_orient2d(mesh->xy[flip->from], mesh->xy[flip->to], centroid) >= 0;
        const int32_t before = left ? flip->left_before : flip->right_before;
        assert(before < at);
        t = left ? flip->left : flip->right;
        at = before;
    }
    return mesh->tri[t].region;
}

void tri_flip_history_settle(struct tri_flip_history *h, struct tri_mesh *mesh)
{
    /* No walk looks at `last` beyond its first step: the region can wait there until all walks are done. */
    for (tri_triangle_id t = 0; h->n > 0 && t < mesh->n_triangles; t++)
        if (h->last[t] != TRI_NONE)
            h->last[t] = region_before(h, mesh, t);
    for (tri_triangle_id t = 0; h->n > 0 && t < mesh->n_triangles; t++)
        if (h->last[t] != TRI_NONE) {
            mesh->tri[t].region = h->last[t];
            h->last[t] = TRI_NONE;
        }
    h->n = 0;
}
