/* Angles and areas.
 *
 * In floating point: squared sines are good to a relative error of about 1e-14 (coordinate differences are correctly
 * rounded, and the cross product of a triangle with a smallest angle of x radians cancels by a factor of 1/x at most).
 * A bound counts as missed from a relative 1e-12 on.
 *
 * Triangles are looked at in blocks of a fixed size, what is found put together in their order: so sums are rounded in
 * the same way whatever the number of threads. */
#include <math.h>
#include <stdlib.h>

#include "triangle/check/apex.h"
#include "triangle/check/internal.h"

enum { BLOCK = 1 << 14 };

struct shape {
    double area;    /* signed */
    double sine2;   /* of the smallest angle, squared */
    double cosine2; /* of the largest angle, squared, with the sign of the cosine */
};

static struct shape shape_of(const struct checker *c, int32_t t)
{
    struct tri_point p[3];
    double d[3][2], l[3];
    for (int k = 0; k < 3; k++)
        p[k] = check_point(c, c->mesh->triangles[3 * (size_t)t + (size_t)k]);
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
    int32_t at;
};

struct sum { /* Neumaier 1974 */
    double total, rest;
};

struct block {
    struct extreme sine2, cosine2, smallest, largest; /* as in struct shape; cosine2: the least, of the largest angle */
    struct sum area;
    int32_t n_small, n_large, first_large; /* below the bound of angles, above that of areas */
};

struct quality {
    struct checker *c;
    double sine2; /* squared sine of the bound */
    int32_t n_blocks;
    struct block *block;
    int32_t *small; /* triangles below the bound, ascending */
    int32_t n_small;
};

static void note(struct extreme *e, double value, int32_t t, bool larger)
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

static double area_bound(const struct checker *c, int32_t t)
{
    const struct tri_check_options *o = c->options;
    double bound = o->max_area > 0 ? o->max_area : INFINITY;
    return o->max_areas != NULL && o->max_areas[t] > 0 ? fmin(bound, o->max_areas[t]) : bound;
}

static bool is_small(const struct quality *q, const struct shape *s)
{
    return q->sine2 > 0 && !(s->sine2 >= q->sine2 * (1 - TRI_CHECK_SLACK));
}

static void note_shape(const struct quality *q, struct block *b, int32_t t)
{
    struct shape s = shape_of(q->c, t);
    note(&b->sine2, s.sine2, t, false);
    note(&b->cosine2, s.cosine2, t, false);
    note(&b->smallest, s.area, t, false);
    note(&b->largest, s.area, t, true);
    add(&b->area, s.area);
    b->n_small += is_small(q, &s);
    if (!(given_area(q->c, s.area) <= area_bound(q->c, t) * (1 + TRI_CHECK_SLACK)) && b->n_large++ == 0)
        b->first_large = t;
}

static int32_t end_of_block(const struct quality *q, int32_t i)
{
    int32_t n = q->c->mesh->n_triangles;
    return n - i * BLOCK < BLOCK ? n : (i + 1) * BLOCK;
}

static void look(struct quality *q)
{
    static const struct extreme none = {0, -1};
#pragma omp parallel for schedule(dynamic)
    for (int32_t i = 0; i < q->n_blocks; i++) {
        q->block[i] = (struct block){.sine2 = none, .cosine2 = none, .smallest = none, .largest = none};
        for (int32_t t = i * BLOCK; t < end_of_block(q, i); t++)
            note_shape(q, &q->block[i], t);
    }
}

static void put_together(const struct quality *q, struct block *all)
{
    static const struct extreme none = {0, -1};
    *all = (struct block){.sine2 = none, .cosine2 = none, .smallest = none, .largest = none};
    for (int32_t i = 0; i < q->n_blocks; i++) {
        const struct block *b = &q->block[i];
        note(&all->sine2, b->sine2.value, b->sine2.at, false);
        note(&all->cosine2, b->cosine2.value, b->cosine2.at, false);
        note(&all->smallest, b->smallest.value, b->smallest.at, false);
        note(&all->largest, b->largest.value, b->largest.at, true);
        add(&all->area, b->area.total);
        all->area.rest += b->area.rest;
        if (b->n_large > 0 && all->n_large == 0)
            all->first_large = b->first_large;
        all->n_large += b->n_large;
        all->n_small += b->n_small;
    }
}

static double degrees_of_sine2(double sine2)
{
    return asin(fmin(1, sqrt(sine2))) / TRI_CHECK_RADIANS;
}

static void summarize(struct checker *c, const struct block *all)
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

static void judge_areas(struct checker *c, const struct block *all)
{
    if (!(c->options->max_area > 0) && c->options->max_areas == NULL)
        return;
    tri_check_begin(c, TRI_CHECK_AREAS);
    if (all->n_large == 0)
        return;
    int32_t t = all->first_large;
    tri_check_fault(c, TRI_CHECK_AREAS, "triangle %ld has an area of %.17g, above the bound of %.17g",
                    check_number(c, t), given_area(c, shape_of(c, t).area), area_bound(c, t));
    c->report->item[TRI_CHECK_AREAS].count = all->n_large;
}

/* The triangles below the bound; few, as a rule. */
static enum tri_status list_small(struct quality *q, int32_t n)
{
    q->small = tri_check_array(n, sizeof *q->small);
    if (q->small == NULL)
        return TRI_NO_MEMORY;
    for (int32_t i = 0; i < q->n_blocks; i++) {
        for (int32_t t = i * BLOCK; q->block[i].n_small > 0 && t < end_of_block(q, i); t++) {
            struct shape s = shape_of(q->c, t);
            if (is_small(q, &s))
                q->small[q->n_small++] = t;
        }
    }
    return TRI_OK;
}

static void judge_small(struct checker *c, struct apexes *apexes, int32_t t)
{
    bool explained = tri_check_is_explained(apexes, t);
    c->report->n_small++;
    c->report->n_small_explained += explained;
    if (c->options->max_bad >= 0 ? c->report->n_small <= c->options->max_bad : explained)
        return;
    tri_check_fault(c, TRI_CHECK_ANGLES, "triangle %ld has an angle of %.6g degrees", check_number(c, t),
                    degrees_of_sine2(shape_of(c, t).sine2));
}

static enum tri_status judge_angles(struct quality *q, int32_t n_small)
{
    struct apexes apexes;
    enum tri_status status = tri_check_find_apexes(&apexes, q->c);
    if (q->c->options->min_angle > 0)
        tri_check_begin(q->c, TRI_CHECK_ANGLES);
    if (status == TRI_OK)
        status = list_small(q, n_small);
    for (int32_t i = 0; status == TRI_OK && i < q->n_small; i++)
        judge_small(q->c, &apexes, q->small[i]);
    tri_check_free_apexes(&apexes);
    free(q->small);
    return status;
}

static double squared_sine(double degrees)
{
    if (degrees <= 0)
        return 0;
    double sine = sin(fmin(degrees, 90) * TRI_CHECK_RADIANS);
    return sine * sine;
}

enum tri_status tri_check_quality(struct checker *c)
{
    struct quality q = {.c = c, .sine2 = squared_sine(c->options->min_angle)};
    struct block all;
    q.n_blocks = c->mesh->n_triangles / BLOCK + (c->mesh->n_triangles % BLOCK > 0);
    q.block = tri_check_array(q.n_blocks, sizeof *q.block);
    if (q.block == NULL)
        return TRI_NO_MEMORY;
    look(&q);
    put_together(&q, &all);
    summarize(c, &all);
    judge_areas(c, &all);
    enum tri_status status = judge_angles(&q, all.n_small);
    free(q.block);
    return status;
}
