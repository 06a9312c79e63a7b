/* Angles and areas, and which small angles the input is to blame for.
 *
 * In floating point: squared sines are good to a relative error of about 1e-14 (coordinate differences are correctly
 * rounded, and the cross product of a triangle with a smallest angle of x radians cancels by a factor of 1/x at most).
 * A bound counts as missed from a relative 1e-12 on.
 *
 * An apex is a vertex where two subsegments meet at less than 60 degrees (or what the options say) with the mesh
 * between them. Near it no mesher can keep a bound: triangles at the apex, those that touch one at it, and those that
 * span its legs further out (across two concentric shells; Miller, Pav & Walkington 2003) are explained by it. */
#include <math.h>
#include <stdlib.h>

#include "triangle/check/internal.h"

#define SLACK   1e-12
#define DEGREES (180 / 3.14159265358979323846)

enum {
    MAX_LEGS = 24, /* legs of apexes that one corner is tried for */
    NO_APEX = -1,
    UNKNOWN = -2,
    UNDER_WAY = -3
};

struct quality {
    struct checker *c;
    double sine2;       /* squared sine of the bound */
    double apex_cosine; /* signed square of the cosine of the largest small input angle */
    uint8_t *is_apex;   /* [n_points] */
    uint8_t *is_near;   /* [n_points]: in a triangle with an apex */
    int32_t *apex_of;   /* [2 n_segments], for each fan entry: the apex that its chain reaches, NO_APEX, UNKNOWN.. */
    double least_sine2;  /* so far; of the smallest angle, which is below 90 degrees */
    double least_cosine; /* so far; signed square of the cosine of the largest angle */
    double sum, rest;    /* of the areas; rest: what rounding took from sum (Neumaier 1974) */
};

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

static bool is_wedge(const struct quality *w, int32_t v, int32_t a, int32_t b)
{
    const struct checker *c = w->c;
    struct tri_point o = check_point(c, v), p = check_point(c, a), q = check_point(c, b);
    double ax = p.x - o.x, ay = p.y - o.y, bx = q.x - o.x, by = q.y - o.y, dot = ax * bx + ay * by;
    if (dot * fabs(dot) <= (w->apex_cosine + SLACK) * (ax * ax + ay * ay) * (bx * bx + by * by))
        return false;
    bool left = ax * by - ay * bx > 0;
    return tri_check_find_edge(c, v, left ? a : b).there >= 0; /* a triangle between them? */
}

/* More than 24 subsegments enclose an angle of 15 degrees at most: no need to compare them all. */
static bool is_apex(const struct quality *q, int32_t v)
{
    const struct checker *c = q->c;
    const int32_t *fan = c->fan + c->fan_first[v];
    int32_t n = c->fan_first[v + 1] - c->fan_first[v];
    if (n > 24)
        return true;
    for (int32_t i = 0; i < n; i++) {
        for (int32_t j = i + 1; j < n; j++) {
            if (is_wedge(q, v, c->segments[fan[i] ^ 1], c->segments[fan[j] ^ 1]))
                return true;
        }
    }
    return false;
}

static bool is_straight(const struct checker *c, int32_t from, int32_t by, int32_t to)
{
    struct tri_point p = check_point(c, from), q = check_point(c, by), r = check_point(c, to);
    double ax = q.x - p.x, ay = q.y - p.y, bx = r.x - q.x, cy = r.y - q.y, dot = ax * bx + ay * cy;
    double length = sqrt(ax * ax + ay * ay) + sqrt(bx * bx + cy * cy);
    return dot > 0 && fabs(ax * cy - ay * bx) <= 1e-9 * dot + c->tolerance * length;
}

/* The subsegment that goes straight on from u to v and beyond; its fan entry at v, -1: none. */
static int32_t straight_on(const struct checker *c, int32_t u, int32_t v)
{
    for (int32_t i = c->fan_first[v]; i < c->fan_first[v + 1]; i++) {
        if (is_straight(c, u, v, c->segments[c->fan[i] ^ 1]))
            return c->fan[i];
    }
    return -1;
}

/* Apex that the chain reaches which begins with fan entry i. What is found holds for all entries on the way, so that
 * each is passed twice in all. A chain that comes back to itself reaches none. */
static int32_t apex_along(struct quality *q, int32_t i)
{
    const struct checker *c = q->c;
    int32_t at = i;
    while (at >= 0 && q->apex_of[at] == UNKNOWN) {
        int32_t end = c->segments[at ^ 1];
        q->apex_of[at] = q->is_apex[end] ? end : UNDER_WAY;
        at = q->is_apex[end] ? at : straight_on(c, c->segments[at], end);
    }
    int32_t found = at >= 0 && q->apex_of[at] != UNDER_WAY ? q->apex_of[at] : NO_APEX;
    for (at = i; at >= 0 && q->apex_of[at] == UNDER_WAY; at = straight_on(c, c->segments[at], c->segments[at ^ 1]))
        q->apex_of[at] = found;
    return found;
}

static int apexes_of(struct quality *q, int32_t v, int32_t *apex)
{
    int n = 0;
    for (int32_t i = q->c->fan_first[v]; i < q->c->fan_first[v + 1] && n < MAX_LEGS; i++) {
        int32_t found = apex_along(q, q->c->fan[i]);
        if (found >= 0)
            apex[n++] = found;
    }
    return n;
}

static bool spans_legs(struct quality *q, const int32_t *corners)
{
    int32_t apex[3][MAX_LEGS];
    int n[3];
    for (int k = 0; k < 3; k++) {
        n[k] = apexes_of(q, corners[k], apex[k]);
        for (int m = 0; m < k; m++) {
            for (int i = 0; i < n[k]; i++) {
                for (int j = 0; j < n[m]; j++) {
                    if (apex[k][i] == apex[m][j])
                        return true;
                }
            }
        }
    }
    return false;
}

static bool is_explained(struct quality *q, int32_t t)
{
    const int32_t *v = q->c->mesh->triangles + 3 * (size_t)t;
    return q->is_near[v[0]] || q->is_near[v[1]] || q->is_near[v[2]] || spans_legs(q, v);
}

static void note_small(struct quality *q, int32_t t, const struct shape *s)
{
    struct checker *c = q->c;
    c->report->n_small++;
    bool explained = is_explained(q, t);
    c->report->n_small_explained += explained;
    if (c->options->max_bad >= 0 ? c->report->n_small <= c->options->max_bad : explained)
        return;
    tri_check_fault(c, TRI_CHECK_ANGLES, "triangle %ld has an angle of %.6g degrees", check_number(c, t),
                    asin(fmin(1, sqrt(s->sine2))) * DEGREES);
}

static double given_area(const struct checker *c, double area)
{
    return c->exponent == 0 ? area : ldexp(area, -2 * c->exponent);
}

static void note_area(struct quality *q, int32_t t, double area)
{
    struct tri_check_report *r = q->c->report;
    if (r->smallest_area_at < 0 || area < r->smallest_area)
        r->smallest_area = area, r->smallest_area_at = t;
    if (r->largest_area_at < 0 || area > r->largest_area)
        r->largest_area = area, r->largest_area_at = t;
    double sum = q->sum + area;
    q->rest += fabs(q->sum) >= fabs(area) ? (q->sum - sum) + area : (area - sum) + q->sum;
    q->sum = sum;
    const struct tri_check_options *o = q->c->options;
    double bound = o->max_area > 0 ? o->max_area : INFINITY;
    if (o->max_areas != NULL && o->max_areas[t] > 0)
        bound = fmin(bound, o->max_areas[t]);
    if (given_area(q->c, area) <= bound * (1 + SLACK))
        return;
    tri_check_fault(q->c, TRI_CHECK_AREAS, "triangle %ld has an area of %.17g, above the bound of %.17g",
                    check_number(q->c, t), given_area(q->c, area), bound);
}

static void note_shape(struct quality *q, int32_t t)
{
    struct tri_check_report *r = q->c->report;
    struct shape s = shape_of(q->c, t);
    note_area(q, t, s.area);
    if (s.sine2 < q->least_sine2 || r->smallest_angle_at < 0)
        q->least_sine2 = s.sine2, r->smallest_angle_at = t;
    if (s.cosine2 < q->least_cosine || r->largest_angle_at < 0)
        q->least_cosine = s.cosine2, r->largest_angle_at = t;
    if (q->sine2 > 0 && !(s.sine2 >= q->sine2 * (1 - SLACK)))
        note_small(q, t, &s);
}

static void summarize(struct quality *q)
{
    struct tri_check_report *r = q->c->report;
    r->total_area = given_area(q->c, q->sum + q->rest);
    r->smallest_area = given_area(q->c, r->smallest_area);
    r->largest_area = given_area(q->c, r->largest_area);
    if (r->smallest_angle_at >= 0)
        r->smallest_angle = asin(fmin(1, sqrt(q->least_sine2))) * DEGREES;
    double cosine = copysign(sqrt(fmin(1, fabs(q->least_cosine))), q->least_cosine);
    if (r->largest_angle_at >= 0)
        r->largest_angle = acos(cosine) * DEGREES;
}

static double squared_sine(double degrees)
{
    if (degrees <= 0)
        return 0;
    double sine = sin(fmin(degrees, 90) / DEGREES);
    return sine * sine;
}

static double signed_squared_cosine(double degrees)
{
    double cosine = cos(degrees / DEGREES);
    return cosine * fabs(cosine);
}

static void find_apexes(struct quality *q)
{
    const struct checker *c = q->c;
    for (int32_t v = 0; v < c->mesh->n_points; v++) {
        q->is_apex[v] = is_apex(q, v);
        c->report->n_apexes += q->is_apex[v];
    }
    for (int32_t t = 0; t < c->mesh->n_triangles; t++) {
        const int32_t *v = c->mesh->triangles + 3 * (size_t)t;
        if (q->is_apex[v[0]] || q->is_apex[v[1]] || q->is_apex[v[2]])
            q->is_near[v[0]] = q->is_near[v[1]] = q->is_near[v[2]] = true;
    }
    for (int32_t i = 0; i < 2 * c->n_segments; i++)
        q->apex_of[i] = UNKNOWN;
}

static void note_all(struct quality *q)
{
    const struct tri_check_options *o = q->c->options;
    struct tri_check_report *r = q->c->report;
    find_apexes(q);
    r->smallest_angle_at = r->largest_angle_at = r->smallest_area_at = r->largest_area_at = -1;
    if (o->min_angle > 0)
        tri_check_begin(q->c, TRI_CHECK_ANGLES);
    if (o->max_area > 0 || o->max_areas != NULL)
        tri_check_begin(q->c, TRI_CHECK_AREAS);
    for (int32_t t = 0; t < q->c->mesh->n_triangles; t++)
        note_shape(q, t);
    summarize(q);
}

enum tri_status tri_check_quality(struct checker *c)
{
    const struct tri_check_options *o = c->options;
    struct quality q = {.c = c, .sine2 = squared_sine(o->min_angle)};
    q.is_apex = tri_check_zeros(c->mesh->n_points, 1);
    q.is_near = tri_check_zeros(c->mesh->n_points, 1);
    q.apex_of = tri_check_zeros(2 * c->n_segments, sizeof *q.apex_of);
    q.apex_cosine = signed_squared_cosine(o->small_input_angle > 0 ? fmin(o->small_input_angle, 180) : 60);
    bool room = q.is_apex && q.is_near && q.apex_of;
    if (room)
        note_all(&q);
    free(q.is_apex);
    free(q.is_near);
    free(q.apex_of);
    return room ? TRI_OK : TRI_NO_MEMORY;
}
