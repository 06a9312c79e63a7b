/* Flips that bring the degrees of vertices near six: mesh relaxation (Frey & Field 1991).
 *
 * The degree of a vertex is the number of its triangles. Its excess is (degree - ideal)^2; the ideal is 6, or, at a
 * fixed vertex, the angle around it over 60 degrees. A flip changes the degrees of the four corners of a quadrilateral.
 * It is made if it lowers the sum of their excesses; then the corners move to better places.
 *
 * INVARIANT. The flip and the moves are undone unless the energy of the corners' stars (star.h) has decreased, no
 * triangle in them violates the angle bound, and the smallest q has not decreased or is good. All triangles stay
 * counter-clockwise (exactly). Fixed vertices stay; no subsegment and no border of regions is crossed. */
#include "triangle/refine/degrees.h"

#include <string.h>

#include "triangle/geometry/predicates.h"
#include "triangle/tunables.h"

/* The angle between two directions over 60 degrees, to 0.0001 (Abramowitz & Stegun 1964, 4.4.45). The same on every
 * machine, unlike acos(). */
static double sixths_between(struct tri_point a, struct tri_point b)
{
    const double PER_RADIAN = 0.9549296585513721, PI = 3.141592653589793;
    const double c = (a.x * b.x + a.y * b.y) / sqrt((a.x * a.x + a.y * a.y) * (b.x * b.x + b.y * b.y));
    const double x = fabs(tri_larger(tri_lesser(c, 1), -1));
    const double angle = sqrt(1 - x) * (1.5707288 + x * (-0.2121144 + x * (0.0742610 - 0.0187293 * x)));
    return PER_RADIAN * (c < 0 ? PI - angle : angle);
}

/* Adds a triangle to the degrees of its corners, and to the angles around fixed ones. */
static void add_angles(const struct tri_smooth *s, double *angle, tri_triangle_id t)
{
    const struct tri_mesh *mesh = s->mesh;
    const tri_vertex_id *v = mesh->tri[t].v;
    for (int k = 0; k < 3; k++) {
        const struct tri_point at = mesh->xy[v[k]], l = mesh->xy[v[tri_next[k]]], r = mesh->xy[v[tri_prev[k]]];
        s->degree[v[k]]++;
        if (mesh->on[v[k]] != TRI_VERTEX_FREE)
            angle[v[k]] +=
                sixths_between((struct tri_point){l.x - at.x, l.y - at.y}, (struct tri_point){r.x - at.x, r.y - at.y});
    }
}

bool tri_degrees_count(struct tri_smooth *s)
{
    const struct tri_mesh *mesh = s->mesh;
    double *angle = tri_mesh_extra(mesh, ((size_t)mesh->n_vertices + 1) * sizeof *angle);
    if (!angle)
        return false;
    for (tri_vertex_id v = 0; v < mesh->n_vertices; v++) {
        s->degree[v] = 0;
        angle[v] = 0;
    }
    for (tri_triangle_id t = 0; t < mesh->n_triangles; t++)
        if (tri_is_live(&mesh->tri[t]))
            add_angles(s, angle, t);
    for (tri_vertex_id v = 0; v < mesh->n_vertices; v++)
        s->ideal[v] = angle[v] > 0 ? (int32_t)(angle[v] + 0.5) : 6;
    tri_mesh_extra_free(mesh, angle);
    return true;
}

static int64_t excess(const struct tri_smooth *s, tri_vertex_id v, int more)
{
    const int64_t off = s->degree[v] + more - s->ideal[v];
    return off * off;
}

/* How much the sum of excesses falls if two vertices lose a triangle each, and two others get one. */
static int64_t gain_of(const struct tri_smooth *s, const tri_vertex_id less[2], const tri_vertex_id more[2])
{
    int64_t gain = 0;
    for (int k = 0; k < 2; k++)
        gain += excess(s, less[k], 0) - excess(s, less[k], -1) + excess(s, more[k], 0) - excess(s, more[k], 1);
    return gain;
}

/* The corners of a quadrilateral. */
struct patch {
    tri_vertex_id v[4];       /* the ends of the old diagonal, then those of the new one */
    struct tri_point kept[4]; /* their places before the flip */
    bool moves[4];            /* it is free, and its star is complete in the block */
    double energy;            /* of the stars of those that move, less that of equilateral triangles */
    double least;             /* smallest q in these stars */
    int n_bad;                /* triangles in them that break the bound on angles, once for each star */
};

static void judge(const struct tri_smooth *s, int32_t block, struct patch *p)
{
    p->energy = 0, p->least = 2, p->n_bad = 0;
    for (int k = 0; k < 4; k++) {
        struct tri_star star;
        bool is_here;
        p->moves[k] = s->mesh->on[p->v[k]] == TRI_VERTEX_FREE && tri_star_find(s, p->v[k], block, &star, &is_here);
        if (!p->moves[k])
            continue;
        const struct tri_worth w = tri_star_worth(s, &star, s->mesh->xy[p->v[k]]);
        p->energy += w.sum - star.n;
        p->least = tri_lesser(p->least, w.least);
        p->n_bad += w.n_bad;
    }
}

/* Moves the corners to better places, in turns. */
static void settle(const struct tri_smooth *s, int32_t block, struct patch *p)
{
    for (int round = 0; round < 2; round++)
        for (int k = 0; k < 4; k++) {
            struct tri_point x = s->mesh->xy[p->v[k]];
            struct tri_star star;
            bool is_here;
            if (p->moves[k] && tri_star_find(s, p->v[k], block, &star, &is_here) &&
                tri_star_find_place(s, &star, TRI_MOST_RIM, &x) && tri_star_is_oriented(&star, x))
                s->mesh->xy[p->v[k]] = x;
        }
}

/* Flips edge e of t, the old diagonal of the patch, and moves the corners. Takes both back unless the patch is better
 * afterwards. */
static bool flips_well(const struct tri_smooth *s, struct tri_flips *flips, tri_triangle_id t, int e, struct patch *p)
{
    struct tri_point *xy = s->mesh->xy;
    judge(s, flips->block, p);
    struct patch now = *p;
    if (!(p->moves[1] || p->moves[2] || p->moves[3])) /* otherwise each new triangle is in a star that is judged */
        return false;
    for (int k = 0; k < 4; k++)
        p->kept[k] = xy[p->v[k]];
    tri_flip_edge(flips, t, e);
    settle(s, flips->block, &now);
    judge(s, flips->block, &now);
    if (memcmp(now.moves, p->moves, sizeof now.moves) == 0 && now.energy < p->energy && now.n_bad == 0 &&
        (now.least >= p->least || now.least > TRI_SMOOTH_GOOD))
        return true;
    for (int k = 0; k < 4; k++)
        xy[p->v[k]] = p->kept[k];
    for (int k = 0; k < 3; k++) /* four flips lead back: each triangle is where it was */
        tri_flip_edge(flips, t, 1);
    return false;
}

/* Flips the first edge at the vertex for which that is better; *p is its patch. Returns false if there is none. */
static bool flip_one(const struct tri_smooth *s, struct tri_flips *flips, tri_vertex_id v, const struct tri_star *star,
                     struct patch *p)
{
    const struct tri_point at = s->mesh->xy[v];
    for (int i = 0; i < star->n; i++) {
        const int l = (i + star->n - 1) % star->n, r = (i + 1) % star->n;
        const tri_triangle_id t = star->triangle[i];
        *p = (struct patch){.v = {v, star->id[i], star->id[l], star->id[r]}};
        if (gain_of(s, p->v, p->v + 2) > 0 && tri_orient2d(star->rim[r], at, star->rim[l]) > 0 &&
            tri_orient2d(star->rim[r], star->rim[l], star->rim[i]) > 0 &&
            flips_well(s, flips, t, tri_corner_of(&s->mesh->tri[t], star->id[r]), p))
            return true;
    }
    return false;
}

/* Pushes the triangles around the corners of the patch, which may have moved, for Lawson's flips. */
static bool touch_around(const struct tri_smooth *s, struct tri_flips *flips, const struct patch *p)
{
    struct tri_star star;
    bool is_here;
    for (int k = 0; k < 4; k++)
        if (p->moves[k] && tri_star_find(s, p->v[k], flips->block, &star, &is_here) && !tri_star_touch(&star, flips))
            return false;
    return true;
}

bool tri_degrees_improve(const struct tri_smooth *s, struct tri_flips *flips, tri_vertex_id v,
                         const struct tri_star *star)
{
    struct patch patch;
    const bool changed = star->n > s->ideal[v] && flip_one(s, flips, v, star, &patch);
    return !changed || (touch_around(s, flips, &patch) && tri_flip_legalise(flips));
}
