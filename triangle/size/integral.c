/* A part is halved across its longest edge until h is about linear in it. Of a linear h the mean of 1 / h^2 between two
 * places is 1 over the product of both: so a part counts by its corners. */
#include "triangle/size/integral.h"

#include "triangle/geometry/shape.h"

struct place {
    struct tri_point at;
    double h;
};

static double area_of(const struct place p[3])
{
    double bx = p[1].at.x - p[0].at.x, by = p[1].at.y - p[0].at.y;
    return 0.5 * fabs(bx * (p[2].at.y - p[0].at.y) - by * (p[2].at.x - p[0].at.x));
}

/* Index of the corner opposite the longest edge. */
static int opposite_longest(const struct place p[3])
{
    double a = tri_distance2(p[1].at, p[2].at), b = tri_distance2(p[2].at, p[0].at);
    double c = tri_distance2(p[0].at, p[1].at);
    return a >= b && a >= c ? 0 : b >= c ? 1 : 2;
}

static double count_by_corners(const struct tri_size_field *f, const struct place p[3], double area, bool simple)
{
    double mean = (p[0].h + p[1].h + p[2].h) / (3 * p[0].h * p[1].h * p[2].h);
    if (f->at_least && !simple) {
        const double high = tri_larger(p[0].h, tri_larger(p[1].h, p[2].h));
        mean = 1 / (high * high);
    }
    return mean > f->over ? area * (mean - f->over) : 0;
}

/* Is h nearly linear between these, or is the part worth nothing? */
static bool is_simple(const struct tri_size_field *f, const struct place p[3], int k, const struct place *middle,
                      double area)
{
    const double RATIO = 4, BENT = 0.4;
    double low = tri_lesser(p[0].h, tri_lesser(p[1].h, p[2].h)), high = tri_larger(p[0].h, tri_larger(p[1].h, p[2].h));
    low = tri_lesser(low, middle->h);
    double bend = fabs(middle->h - 0.5 * (p[tri_next[k]].h + p[tri_prev[k]].h));
    return area <= f->large && (area < f->few * low * low || (high < RATIO * low && bend < BENT * middle->h));
}

static double count_in(const struct tri_size_field *f, const struct place p[3], int depth)
{
    double area = area_of(p);
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

double tri_integral(const struct tri_size_field *field, const struct tri_point corner[3])
{
    struct place p[3];
    for (int k = 0; k < 3; k++)
        p[k] = (struct place){corner[k], field->at(field->user, corner[k])};
    return count_in(field, p, field->deepest);
}
