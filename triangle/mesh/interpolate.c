/* Linear interpolation of vertex attributes along an edge and over a triangle. Where that is a few units in the last
 * place long or high, rounding may put a vertex beyond the ends of its edge or outside its triangle by far more than
 * its size: what comes out keeps to the range of what goes in. */
#include "triangle/mesh/interpolate.h"

#include <assert.h>

#include "triangle/geometry/point.h"

static double within(double value, double least, double most) { return tri_larger(tri_lesser(value, most), least); }

static double *attributes_of(const struct tri_mesh *mesh, tri_vertex_id v)
{
    return mesh->attributes + (size_t)v * (size_t)mesh->n_attributes;
}

void tri_interpolate_edge(struct tri_mesh *mesh, tri_vertex_id a, tri_vertex_id b, double fraction,
                          tri_vertex_id to_vertex)
{
    assert(to_vertex < mesh->n_vertices && to_vertex != a && to_vertex != b);
    for (int32_t k = 0; k < mesh->n_attributes; k++) {
        double from = attributes_of(mesh, a)[k], to = attributes_of(mesh, b)[k];
        double value = from + fraction * (to - from);
        attributes_of(mesh, to_vertex)[k] = within(value, tri_lesser(from, to), tri_larger(from, to));
    }
}

void tri_interpolate_triangle(struct tri_mesh *mesh, const tri_vertex_id corners[3], tri_vertex_id v)
{
    if (mesh->n_attributes == 0)
        return;
    struct tri_point a = mesh->xy[corners[0]], b = mesh->xy[corners[1]], c = mesh->xy[corners[2]], p = mesh->xy[v];
    double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y, px = p.x - a.x, py = p.y - a.y;
    double area = bx * cy - by * cx;
    double to_b = (px * cy - py * cx) / area, to_c = (bx * py - by * px) / area;
    for (int32_t k = 0; k < mesh->n_attributes; k++) {
        double at_a = attributes_of(mesh, corners[0])[k];
        double at_b = attributes_of(mesh, corners[1])[k], at_c = attributes_of(mesh, corners[2])[k];
        double value = at_a + to_b * (at_b - at_a) + to_c * (at_c - at_a);
        double least = tri_lesser(at_a, tri_lesser(at_b, at_c)), most = tri_larger(at_a, tri_larger(at_b, at_c));
        attributes_of(mesh, v)[k] = within(value, least, most);
    }
}
