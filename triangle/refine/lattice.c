/* Finds lattice points, and tests their distance from vertices and subsegments. */
#include "triangle/refine/lattice.h"

#include "triangle/refine/place.h"
#include "triangle/tunables.h"

static const double RISE = 0.86602540378443864676; /* sqrt(3) / 2 */

struct tri_lattice tri_lattice_of(double edge)
{
    return (struct tri_lattice){edge, RISE * edge, TRI_LATTICE_FEATURE * edge};
}

struct tri_lattice tri_lattice_for(double area2) { return tri_lattice_of(sqrt(TRI_LATTICE_SHARE * area2 / RISE)); }

bool tri_lattice_point(const struct tri_lattice *lattice, const struct tri_point *xy, const tri_vertex_id v[3],
                       const struct tri_shape *shape, struct tri_point *p)
{
    const double apart = TRI_LATTICE_APART * lattice->edge, reach2 = TRI_LATTICE_REACH * tri_longest2(shape);
    double row, column;
    tri_lattice_near(lattice, tri_place(xy, v, shape, HUGE_VAL), &row, &column);
    *p = tri_lattice_at(lattice, row, column);
    if (!(fabs(row) < TRI_LATTICE_FARTHEST && fabs(column) < TRI_LATTICE_FARTHEST))
        return false;
    if (tri_distance2(xy[v[0]], *p) > reach2)
        return false;
    for (int k = 0; k < 3; k++)
        if (!(tri_distance2(xy[v[k]], *p) >= apart * apart))
            return false;
    return true;
}

bool tri_lattice_is_clear(const struct tri_cavity *cavity, const struct tri_lattice *lattice)
{
    const double apart = TRI_LATTICE_APART * lattice->edge, off_walls = TRI_LATTICE_OFF_WALLS * lattice->edge;
    for (int32_t i = 0; i < cavity->n_edges; i++)
        if (cavity->edge[i].a->r.l < apart * apart)
            return false;
    for (int32_t i = 0; i < cavity->n_wall; i++) {
        const struct tri_cavity_edge *wall = &cavity->edge[cavity->wall[i]];
        const double x = wall[1].a->r.x - wall->a->r.x, y = wall[1].a->r.y - wall->a->r.y;
        if (wall->area2 * wall->area2 < off_walls * off_walls * (x * x + y * y))
            return false;
    }
    return true;
}
