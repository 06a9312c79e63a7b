/* The size h(x) is the minimum of
 *   - s(v) + TRI_CROWD_SLOPE * |xv| for the corners v of the triangle, with the feature size s (feature_size.h),
 *     since the corners are about the nearest vertices to x in a Delaunay triangulation;
 *   - the sum of the distances from x to two subsegments, one an edge of the triangle, the other ending at the
 *     opposite corner. This is the width of a gap, which the vertices at its ends alone would not show. */
#include "triangle/size/crowd.h"

#include "triangle/geometry/shape.h"
#include "triangle/size/gap.h"
#include "triangle/size/hopeless.h"
#include "triangle/tunables.h"

enum { STRIPS = 6, MOST_TURNS = 32 };

/* A subsegment on its line. */
struct wall {
    struct tri_point from, direction; /* start of the subsegment; unit vector along it */
    double length;                    /* length of the subsegment */
};

/* The data that determine h in a triangle. */
struct field {
    struct tri_point corner[3];   /* corners of the triangle */
    double size[3];               /* feature sizes at the corners */
    struct wall strip[STRIPS][2]; /* the two sides of each gap */
    int n_strips;                 /* number of gaps */
    double least; /* lower limit on h, which keeps the integral finite where walls meet */
};

static struct wall wall_of(const struct tri_mesh *mesh, const struct tri_subsegment *sub)
{
    struct tri_point a = mesh->xy[sub->v[0]], b = mesh->xy[sub->v[1]];
    double x = b.x - a.x, y = b.y - a.y, length = sqrt(x * x + y * y);
    return (struct wall){a, {x / length, y / length}, length};
}

/* Returns the distance of q from the wall; infinity if q does not project onto it. */
static double distance_from(const struct wall *wall, struct tri_point q)
{
    double x = q.x - wall->from.x, y = q.y - wall->from.y;
    double along = x * wall->direction.x + y * wall->direction.y;
    return along >= 0 && along <= wall->length ? fabs(x * wall->direction.y - y * wall->direction.x) : HUGE_VAL;
}

static double size_at(const void *field, struct tri_point q)
{
    const struct field *f = field;
    double h = HUGE_VAL;
    for (int k = 0; k < 3; k++)
        h = tri_lesser(h, f->size[k] + TRI_CROWD_SLOPE * sqrt(tri_distance2(q, f->corner[k])));
    for (int i = 0; i < f->n_strips; i++)
        h = tri_lesser(h, distance_from(&f->strip[i][0], q) + distance_from(&f->strip[i][1], q));
    return tri_larger(h, f->least);
}

/* Returns the first subsegment found by turning around corner k of the triangle in one direction; TRI_NONE if that
 * takes too long or the mesh ends. */
static tri_sub_id wall_around(const struct tri_mesh *mesh, tri_triangle_id t, int k, const int way[3])
{
    for (int i = 0; i < MOST_TURNS; i++) {
        tri_link link = mesh->tri[t].n[way[k]];
        if (link < 0)
            return link == TRI_BEYOND ? TRI_NONE : ~link;
        t = tri_of(link);
        k = way[tri_edge(link)];
    }
    return TRI_NONE;
}

static void find_strips(struct field *f, const struct tri_mesh *mesh, tri_triangle_id triangle)
{
    const struct tri_triangle *t = &mesh->tri[triangle];
    f->n_strips = 0;
    for (int k = 0; k < 3; k++) {
        if (t->n[k] >= 0 || t->n[k] == TRI_BEYOND)
            continue;
        const struct tri_subsegment *base = &mesh->sub[~t->n[k]];
        for (int side = 0; side < 2; side++) {
            tri_sub_id other = wall_around(mesh, triangle, k, side ? tri_prev : tri_next);
            if (other == TRI_NONE || !tri_is_filled(mesh, base->parent, mesh->sub[other].parent,
                                                    mesh->xy[t->v[tri_next[k]]], mesh->xy[t->v[k]]))
                continue;
            f->strip[f->n_strips][0] = wall_of(mesh, base);
            f->strip[f->n_strips++][1] = wall_of(mesh, &mesh->sub[other]);
        }
    }
}

/* Returns the integral of 1 / h^2 - 1 / most^2 over the points with h below `most`. */
static double crowd_in(const struct tri_mesh *mesh, tri_triangle_id triangle, double most)
{
    const double LEAST = 0.05, FEW = 0.3;
    const int DEEPEST = 128; /* sufficient, since h is smooth and bounded from below */
    const tri_vertex_id *v = mesh->tri[triangle].v;
    struct field f = {.least = HUGE_VAL};
    const struct tri_integrand field = {.at = size_at, .user = &f, .over = 1 / (most * most), .large = HUGE_VAL,
                                         .few = FEW, .deepest = DEEPEST};
    for (int k = 0; k < 3; k++) {
        f.corner[k] = mesh->xy[v[k]];
        f.size[k] = tri_larger(mesh->feature[v[k]], sqrt(mesh->limits.shortest2)); /* shorter edges are not refined */
        f.least = tri_lesser(f.least, LEAST * f.size[k]);
    }
    find_strips(&f, mesh, triangle);
    return tri_integral(&field, f.corner, NULL);
}

/* Returns how many times the shortest edge must be doubled to reach the longest edge or `most`. */
static double octaves_of(const struct tri_shape *shape, double most)
{
    double ratio2 = fmin(tri_longest2(shape), most * most) / shape->l[shape->shortest];
    return ratio2 > 1 ? 0.5 * tri_rough_log2(ratio2) : 0;
}

/* Returns the ratio of length to width of the gap between segments that the shortest edge of the triangle bridges,
 * within the triangle; 0 if there is none or it is wider than `most`. */
static double gap_of(const struct tri_mesh *mesh, tri_triangle_id t, const struct tri_shape *shape, double most)
{
    double longest2 = tri_longest2(shape), width2 = shape->l[shape->shortest];
    return width2 < most * most ? fmin(tri_gap_cost(mesh, t, shape), sqrt(longest2 / width2)) : 0;
}

struct tri_crowd tri_crowd_for(const struct tri_mesh *mesh, const struct tri_quality *quality)
{
    const double angle = tri_worked_angle(quality);
    return (struct tri_crowd){mesh, tri_bounds_for(angle, false).sin2,
                              angle > 0 ? TRI_FINENESS / (TRI_NEVER - angle) : 0};
}

/* Counts the squares of the feature size that fill the triangle, where features need smaller triangles than sizes
 * do. A bad triangle adds a few for each octave between its shortest and longest edge, regardless of its size.
 * Between two walls it adds more, since sizes cannot grow there. A good triangle adds nothing unless surrounding
 * sizes require it, and a hopeless triangle adds nothing. */
double tri_crowd_work(const struct tri_crowd *c, tri_triangle_id t, double asked)
{
    const struct tri_mesh *mesh = c->mesh;
    const struct tri_shape shape = tri_shape_of(mesh->xy, mesh->tri[t].v);
    if (!(c->fineness > 0) || tri_is_hopeless(mesh, t, &shape))
        return 0;
    const double most = asked > 0 ? sqrt(0.5 * shape.area2 * c->fineness / asked) : HUGE_VAL;
    double crowd = crowd_in(mesh, t, most), product = tri_longer_product(shape.l[0], shape.l[1], shape.l[2]);
    if (shape.area2 * shape.area2 >= c->sin2 * product)
        return fmax(c->fineness * crowd - 1, 0);
    double grown = crowd + TRI_AN_OCTAVE * octaves_of(&shape, most), filled = TRI_A_GAP * gap_of(mesh, t, &shape, most);
    return fmin(c->fineness * fmax(grown, filled), 1e15);
}

/* A part is halved across its longest edge until h is nearly linear in it. For linear h, the mean of 1 / h^2 between
 * two points is 1 over the product of both values of h. So a part is integrated from its corners. */

struct place {
    struct tri_point at; /* position */
    double h;            /* size there */
};

/* Returns the index of the corner opposite the longest edge. */
static int opposite_longest(const struct place p[3])
{
    double a = tri_distance2(p[1].at, p[2].at), b = tri_distance2(p[2].at, p[0].at);
    double c = tri_distance2(p[0].at, p[1].at);
    return a >= b && a >= c ? 0 : b >= c ? 1 : 2;
}

static double count_by_corners(const struct tri_integrand *f, const struct place p[3], double area, bool simple)
{
    double mean = (p[0].h + p[1].h + p[2].h) / (3 * p[0].h * p[1].h * p[2].h);
    if (f->at_least && !simple) {
        const double high = tri_larger(p[0].h, tri_larger(p[1].h, p[2].h));
        mean = 1 / (high * high);
    }
    return mean > f->over ? area * (mean - f->over) : 0;
}

/* Is h nearly linear between these points, or is the part negligible? */
static bool is_simple(const struct tri_integrand *f, const struct place p[3], int k, const struct place *middle,
                      double area)
{
    const double RATIO = 4, BENT = 0.4;
    double low = tri_lesser(p[0].h, tri_lesser(p[1].h, p[2].h)), high = tri_larger(p[0].h, tri_larger(p[1].h, p[2].h));
    low = tri_lesser(low, middle->h);
    double bend = fabs(middle->h - 0.5 * (p[tri_next[k]].h + p[tri_prev[k]].h));
    return area <= f->large && (area < f->few * low * low || (high < RATIO * low && bend < BENT * middle->h));
}

static double count_in(const struct tri_integrand *f, const struct place p[3], int depth)
{
    double area = fabs(tri_area_of(p[0].at, p[1].at, p[2].at));
    if (depth == 0 || (f->left && *f->left <= 0))
        return count_by_corners(f, p, area, false);
    int k = opposite_longest(p);
    const struct place *a = &p[tri_next[k]], *b = &p[tri_prev[k]];
    struct place middle = {{0.5 * (a->at.x + b->at.x), 0.5 * (a->at.y + b->at.y)}, 0};
    middle.h = f->at(f->user, middle.at);
    if (is_simple(f, p, k, &middle, area))
        return count_by_corners(f, p, area, true);
    const struct place first[3] = {p[k], *a, middle}, second[3] = {p[k], middle, *b};
    return count_in(f, first, depth - 1) + count_in(f, second, depth - 1);
}

double tri_integral(const struct tri_integrand *field, const struct tri_point corner[3], const double *h)
{
    struct place p[3];
    for (int k = 0; k < 3; k++)
        p[k] = (struct place){corner[k], h ? h[k] : field->at(field->user, corner[k])};
    return count_in(field, p, field->deepest);
}
