/* Angles and areas.
 *
 * In floating point: squared sines are good to a relative error of about 1e-14 (coordinate differences are correctly
 * rounded, and the cross product of a triangle with a smallest angle of x radians cancels by a factor of 1/x at most).
 * A bound counts as missed from a relative 1e-12 on.
 *
 * What shares of the triangles and parts of the mesh say is put together in their order. The sum of areas carries the
 * rounding of each addition along: into how many parts the mesh is cut makes no difference that a double would show. */
#include <math.h>
#include <stdlib.h>

#include "triangle/check/apex.h"
#include "triangle/check/internal.h"

struct shape {
    double area;    /* signed */
    double sine2;   /* of the smallest angle, squared */
    double cosine2; /* of the largest angle, squared, with the sign of the cosine */
};

/* Of a triangle of the part. */
static struct shape shape_of(const struct checker *c, int32_t t)
{
    struct tri_point p[3];
    double d[3][2], l[3];
    for (int k = 0; k < 3; k++)
        p[k] = check_place(c, c->part.triangles[3 * (size_t)t + (size_t)k]);
    for (int k = 0; k < 3; k++) { /* edge opposite corner k */
        struct tri_point a = p[(k + 1) % 3], b = p[(k + 2) % 3];
        d[k][0] = b.x - a.x;
        d[k][1] = b.y - a.y;
        l[k] = d[k][0] * d[k][0] + d[k][1] * d[k][1];
    }
    int longest = l[0] > l[1] ? (l[0] > l[2] ? 0 : 2) : l[1] > l[2] ? 1 : 2;
    int shortest = l[0] < l[1] ? (l[0] < l[2] ? 0 : 2) : l[1] < l[2] ? 1 : 2;
    if (shortest == longest)
        shortest = (longest + 1) % 3; /* equilateral */
    int i = (longest + 1) % 3, j = (longest + 2) % 3, m = 3 - longest - shortest;
    double cross = d[i][0] * d[j][1] - d[i][1] * d[j][0], dot = -(d[i][0] * d[j][0] + d[i][1] * d[j][1]);
    return (struct shape){cross / 2, cross * cross / (l[longest] * l[m]), dot * fabs(dot) / (l[i] * l[j])};
}

/* Least or largest of something, and the first triangle that has it; -1: none yet. */
struct extreme {
    double value;
    int64_t at;
};

struct sum { /* Neumaier 1974 */
    double total, rest;
};

/* Of some triangles. */
struct findings {
    struct extreme sine2, cosine2, smallest, largest; /* as in struct shape; cosine2: the least, of the largest angle */
    struct sum area;
    int64_t n_small; /* below the bound of angles */
    int64_t n_large; /* above that of areas */
};

struct check_quality {
    double sine2; /* squared sine of the bound */
    struct findings all; /* of the parts so far */
    struct findings share[CHECK_MOST_SHARES];
};

static const struct findings empty = {.sine2 = {0, -1}, .cosine2 = {0, -1}, .smallest = {0, -1}, .largest = {0, -1}};

static void note(struct extreme *e, double value, int64_t t, bool larger)
{
    if (e->at < 0 || (larger ? value > e->value : value < e->value))
        *e = (struct extreme){value, t};
}

static void add(struct sum *s, double x)
{
    double total = s->total + x;
    s->rest += fabs(s->total) >= fabs(x) ? (s->total - total) + x : (x - total) + s->total;
    s->total = total;
}

static double given_area(const struct checker *c, double area)
{
    return c->exponent == 0 ? area : ldexp(area, -2 * c->exponent);
}

static double area_bound(const struct checker *c, int64_t t)
{
    const struct tri_check_options *o = c->options;
    double bound = o->max_area > 0 ? o->max_area : INFINITY;
    return o->max_areas != NULL && o->max_areas[t] > 0 ? fmin(bound, o->max_areas[t]) : bound;
}

static bool is_small(const struct check_quality *q, const struct shape *s)
{
    return q->sine2 > 0 && !(s->sine2 >= q->sine2 * (1 - TRI_CHECK_SLACK));
}

static bool is_large(const struct checker *c, int32_t t, double area)
{
    return !(given_area(c, area) <= area_bound(c, c->part.first + t) * (1 + TRI_CHECK_SLACK));
}

static void note_shape(const struct checker *c, struct findings *b, int32_t t)
{
    struct shape s = shape_of(c, t);
    int64_t number = c->part.first + t;
    note(&b->sine2, s.sine2, number, false);
    note(&b->cosine2, s.cosine2, number, false);
    note(&b->smallest, s.area, number, false);
    note(&b->largest, s.area, number, true);
    add(&b->area, s.area);
    b->n_small += is_small(c->quality, &s);
    b->n_large += is_large(c, t, s.area);
}

static void look(void *checker, const struct check_share *share)
{
    const struct checker *c = checker;
    struct findings found = empty;
    for (int64_t t = share->first; t < share->end; t++)
        note_shape(c, &found, (int32_t)t);
    c->quality->share[share->number] = found;
}

static void join(struct findings *all, const struct findings *b)
{
    if (b->sine2.at < 0)
        return;
    note(&all->sine2, b->sine2.value, b->sine2.at, false);
    note(&all->cosine2, b->cosine2.value, b->cosine2.at, false);
    note(&all->smallest, b->smallest.value, b->smallest.at, false);
    note(&all->largest, b->largest.value, b->largest.at, true);
    add(&all->area, b->area.total);
    all->area.rest += b->area.rest;
    all->n_large += b->n_large;
    all->n_small += b->n_small;
}

static double squared_sine(double degrees)
{
    if (degrees <= 0)
        return 0;
    double sine = sin(fmin(degrees, 90) * TRI_CHECK_RADIANS);
    return sine * sine;
}

static double degrees_of_sine2(double sine2)
{
    return asin(fmin(1, sqrt(sine2))) / TRI_CHECK_RADIANS;
}

static void summarize(struct checker *c, const struct findings *all)
{
    struct tri_check_report *r = c->report;
    r->smallest_angle_at = all->sine2.at;
    r->largest_angle_at = all->cosine2.at;
    r->smallest_area_at = all->smallest.at;
    r->largest_area_at = all->largest.at;
    r->total_area = given_area(c, all->area.total + all->area.rest);
    r->smallest_area = given_area(c, all->smallest.value);
    r->largest_area = given_area(c, all->largest.value);
    if (all->sine2.at < 0)
        return;
    double cosine = copysign(sqrt(fmin(1, fabs(all->cosine2.value))), all->cosine2.value);
    r->smallest_angle = degrees_of_sine2(all->sine2.value);
    r->largest_angle = acos(cosine) / TRI_CHECK_RADIANS;
}

/* Areas above their bound, in the part. */
static bool is_too_large(const struct checker *c, int64_t t)
{
    return is_large(c, (int32_t)t, shape_of(c, (int32_t)t).area);
}

static void tell_large(struct checker *c, int64_t t)
{
    tri_check_fault(c, TRI_CHECK_AREAS, "triangle %ld has an area of %.17g, above the bound of %.17g",
                    check_part_triangle(c, (int32_t)t), given_area(c, shape_of(c, (int32_t)t).area),
                    area_bound(c, c->part.first + t));
}

static void judge_areas(struct checker *c, int64_t n_large)
{
    if (!(c->options->max_area > 0) && c->options->max_areas == NULL)
        return;
    tri_check_begin(c, TRI_CHECK_AREAS);
    if (n_large > 0)
        tri_check_each(c, TRI_CHECK_AREAS, c->part.first, c->part.n_triangles, is_too_large, tell_large);
}

void tri_check_shapes(struct checker *c)
{
    struct check_quality *q = c->quality;
    int64_t before = q->all.n_large;
    for (int i = 0; i < CHECK_MOST_SHARES; i++)
        q->share[i] = empty;
    tri_check_in_shares(c, c->part.n_triangles, look, c);
    for (int i = 0; i < CHECK_MOST_SHARES; i++)
        join(&q->all, &q->share[i]);
    judge_areas(c, q->all.n_large - before);
}

enum tri_status tri_check_begin_quality(struct checker *c)
{
    c->quality = malloc(sizeof *c->quality);
    if (c->quality == NULL)
        return TRI_NO_MEMORY;
    c->quality->sine2 = squared_sine(c->options->min_angle);
    c->quality->all = empty;
    return TRI_OK;
}

static void judge_small(struct checker *c, struct apexes *apexes, int32_t t, const struct shape *s)
{
    int64_t v[3];
    for (int k = 0; k < 3; k++)
        v[k] = check_global(c, c->part.triangles[3 * (size_t)t + (size_t)k]);
    bool explained = tri_check_is_explained(apexes, v);
    c->report->n_small++;
    c->report->n_small_explained += explained;
    if (c->options->max_bad >= 0 ? c->report->n_small <= c->options->max_bad : explained)
        return;
    tri_check_fault(c, TRI_CHECK_ANGLES, "triangle %ld has an angle of %.6g degrees", check_part_triangle(c, t),
                    degrees_of_sine2(s->sine2));
}

/* The triangles below the bound; few, as a rule. */
static enum tri_status judge_angles(struct checker *c, struct apexes *apexes)
{
    enum tri_status status = tri_check_mark_near(apexes);
    bool good;
    for (int64_t first = 0; first < c->n_triangles && status == TRI_OK; first += c->part_triangles) {
        status = tri_check_load(c, first, &good);
        for (int32_t t = 0; t < c->part.n_triangles && status == TRI_OK; t++) {
            struct shape s = shape_of(c, t);
            if (is_small(c->quality, &s))
                judge_small(c, apexes, t, &s);
        }
    }
    return status;
}

enum tri_status tri_check_quality(struct checker *c)
{
    struct apexes apexes;
    const struct findings *all = &c->quality->all;
    summarize(c, all);
    enum tri_status status = tri_check_find_apexes(&apexes, c);
    if (c->options->min_angle > 0)
        tri_check_begin(c, TRI_CHECK_ANGLES);
    if (status == TRI_OK && all->n_small > 0)
        status = judge_angles(c, &apexes);
    tri_check_free_apexes(&apexes);
    return status;
}
