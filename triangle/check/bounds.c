/* Angles and areas, in floating point.
 *
 * Squared sines have a relative error of about 1e-14: coordinate differences are correctly rounded, and the cross
 * product of a triangle with a smallest angle of x radians loses at most a factor of 1/x to cancellation. A bound
 * counts as violated from a relative 1e-12 on.
 *
 * Results of shares and parts are combined in order. The sum of areas carries the rounding error of each addition
 * along, so the division into parts makes no difference that a double can show. */
#include <math.h>
#include <stdlib.h>

#include "triangle/check/internal.h"

#define TRI_CHECK_SLACK   1e-12 /* relative violation from which a bound counts as missed */
#define TRI_CHECK_RADIANS (3.14159265358979323846 / 180)

struct apexes {
    struct checker *c;
    double apex_cosine; /* signed squared cosine of the largest small input angle */
    uint8_t *is_apex;   /* [n_frame] 1: the vertex is an apex */
    int32_t *apex_of;   /* [2 n_segments] apex reached by the chain from each fan entry, or NO_APEX, UNKNOWN,
                           UNDER_WAY */
};

/* --- small angles caused by the input
 *
 * An apex is a vertex at which two subsegments meet at less than 60 degrees (or options.small_input_angle) with the
 * mesh between them. Near an apex no mesher can meet the bound. These triangles are explained by it: triangles at
 * the apex, triangles that share a vertex with one of those, and triangles that span its legs farther out (across
 * two concentric shells; Miller, Pav & Walkington 2003). */

enum {
    MAX_LEGS = 24, /* maximum number of legs tried for one corner */
    NO_APEX = -1,
    UNKNOWN = -2,
    UNDER_WAY = -3
};

/* Is there a triangle to the left of the subsegment, looking from the end that the fan entry names? */
static bool is_meshed(const struct checker *c, int32_t fan_entry)
{
    return c->sides[fan_entry >> 1][fan_entry & 1].half_edge >= 0;
}

/* Do two fan entries at v enclose a small angle with the mesh between them? */
static bool is_wedge(const struct apexes *w, int32_t v, int32_t i, int32_t j)
{
    const struct checker *c = w->c;
    struct tri_point o = check_point(c, v);
    struct tri_point p = check_point(c, c->segments[i ^ 1]), q = check_point(c, c->segments[j ^ 1]);
    double ax = p.x - o.x, ay = p.y - o.y, bx = q.x - o.x, by = q.y - o.y, dot = ax * bx + ay * by;
    if (dot * fabs(dot) <= (w->apex_cosine + TRI_CHECK_SLACK) * (ax * ax + ay * ay) * (bx * bx + by * by))
        return false;
    bool left = ax * by - ay * bx > 0;
    return is_meshed(c, left ? i : j); /* is a triangle between them? */
}

/* More than 24 subsegments enclose an angle of at most 15 degrees, so they need not be compared. */
static bool is_apex(const struct apexes *q, int32_t v)
{
    const struct checker *c = q->c;
    const int32_t *fan = c->fan + c->fan_first[v];
    int32_t n = c->fan_first[v + 1] - c->fan_first[v];
    if (n > 24)
        return true;
    for (int32_t i = 0; i < n; i++) {
        for (int32_t j = i + 1; j < n; j++) {
            if (is_wedge(q, v, fan[i], fan[j]))
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

/* Returns the fan entry at v of the subsegment that continues straight on from u to v; -1: none. */
static int32_t straight_on(const struct checker *c, int32_t u, int32_t v)
{
    for (int32_t i = c->fan_first[v]; i < c->fan_first[v + 1]; i++) {
        if (is_straight(c, u, v, c->segments[c->fan[i] ^ 1]))
            return c->fan[i];
    }
    return -1;
}

/* Returns the apex that the chain from fan entry i reaches. The result holds for all entries on the way, so each
 * entry is visited only twice in total. A closed chain reaches no apex. */
static int32_t apex_along(struct apexes *q, int32_t i)
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

static int apexes_of(struct apexes *q, int32_t v, int32_t *apex)
{
    int n = 0;
    for (int32_t i = q->c->fan_first[v]; i < q->c->fan_first[v + 1] && n < MAX_LEGS; i++) {
        int32_t found = apex_along(q, q->c->fan[i]);
        if (found >= 0)
            apex[n++] = found;
    }
    return n;
}

static bool spans_legs(struct apexes *q, const int64_t *corners)
{
    int32_t apex[3][MAX_LEGS];
    int n[3];
    for (int k = 0; k < 3; k++) {
        int32_t v = tri_check_in_frame(q->c, corners[k]);
        n[k] = v < 0 ? 0 : apexes_of(q, v, apex[k]);
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

static bool has_state(const struct checker *c, const int64_t *v, int state)
{
    return ((c->state[v[0]] | c->state[v[1]] | c->state[v[2]]) & state) != 0;
}

static double signed_squared_cosine(double degrees)
{
    double cosine = cos(degrees * TRI_CHECK_RADIANS);
    return cosine * fabs(cosine);
}

static void look_for_apexes(void *apexes, const struct check_share *share)
{
    struct apexes *q = apexes;
    for (int32_t v = (int32_t)share->first; v < share->end; v++)
        q->is_apex[v] = is_apex(q, v);
}

static void find_apexes(struct apexes *q)
{
    struct checker *c = q->c;
    tri_check_in_shares(c, c->n_frame, look_for_apexes, q);
    for (int32_t v = 0; v < c->n_frame; v++) {
        c->report->n_apexes += q->is_apex[v];
        if (q->is_apex[v])
            c->state[c->vertex[v]] |= CHECK_APEX;
    }
    for (int32_t i = 0; i < 2 * c->n_segments; i++)
        q->apex_of[i] = UNKNOWN;
}

static void mark_near(void *checker, int64_t first, int64_t n, const void *corners)
{
    struct checker *c = checker;
    (void)first;
    for (int64_t t = 0; t < n; t++) {
        const int64_t *v = (const int64_t *)corners + 3 * t;
        for (int k = 0; k < 3 && has_state(c, v, CHECK_APEX); k++)
            c->state[v[k]] |= CHECK_NEAR;
    }
}

static enum tri_status mark_all_near(struct apexes *q)
{
    struct checker *c = q->c;
    int64_t n = c->report->n_apexes > 0 ? c->n_triangles : 0;
    return tri_check_each_slice(c, TRI_CHECK_CORNERS, n, 3 * sizeof(int64_t), mark_near, c);
}

static enum tri_status find_apexes_of(struct apexes *q, struct checker *c)
{
    double small = c->options->small_input_angle;
    *q = (struct apexes){.c = c, .apex_cosine = signed_squared_cosine(small > 0 ? fmin(small, 180) : 60)};
    q->is_apex = tri_check_zeros(c->n_frame, 1);
    q->apex_of = tri_check_zeros(2 * (int64_t)c->n_segments, sizeof *q->apex_of);
    if (q->is_apex == NULL || q->apex_of == NULL)
        return TRI_NO_MEMORY;
    find_apexes(q);
    return TRI_OK;
}

static void free_apexes(struct apexes *q)
{
    free(q->is_apex);
    free(q->apex_of);
}

/* --- bounds */

struct shape {
    double area;    /* signed */
    double sine2;   /* squared sine of the smallest angle */
    double cosine2; /* squared cosine of the largest angle, with the sign of the cosine */
};

/* Returns the shape of a triangle of the part. */
static struct shape shape_of(const struct checker *c, int32_t t)
{
    struct tri_point p[3];
    double d[3][2], l[3];
    for (int k = 0; k < 3; k++)
        p[k] = check_place(c, c->part.triangles[3 * (size_t)t + (size_t)k]);
    for (int k = 0; k < 3; k++) { /* d[k]: edge opposite corner k */
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

/* A minimum or maximum, and the first triangle that attains it; -1: none yet. */
struct extreme {
    double value; /* the extreme value */
    int64_t at;   /* the triangle */
};

struct sum { /* a compensated sum (Neumaier 1974) */
    double total, rest;
};

/* The results for some triangles. */
struct findings {
    struct extreme sine2, cosine2, smallest, largest; /* as in struct shape; cosine2: the minimum, which belongs to
                                                         the largest angle */
    struct sum area; /* total area */
    int64_t n_small; /* triangles below the angle bound */
    int64_t n_large; /* triangles above the area bound */
};

struct check_quality {
    double sine2; /* squared sine of the angle bound */
    struct findings all; /* results for the parts read so far */
    struct findings share[CHECK_MOST_SHARES]; /* results of each share of the part */
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

/* Is the area of triangle t of the part above its bound? */
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
        v[k] = c->part.vertex[c->part.triangles[3 * (size_t)t + (size_t)k]];
    bool explained = has_state(c, v, CHECK_NEAR) || spans_legs(apexes, v);
    c->report->n_small++;
    c->report->n_small_explained += explained;
    if (c->options->max_bad >= 0 ? c->report->n_small <= c->options->max_bad : explained)
        return;
    tri_check_fault(c, TRI_CHECK_ANGLES, "triangle %ld has an angle of %.6g degrees", check_part_triangle(c, t),
                    degrees_of_sine2(s->sine2));
}

/* Explains the triangles below the angle bound. There are usually few. */
static enum tri_status judge_angles(struct checker *c, struct apexes *apexes)
{
    enum tri_status status = mark_all_near(apexes);
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
    enum tri_status status = find_apexes_of(&apexes, c);
    if (c->options->min_angle > 0)
        tri_check_begin(c, TRI_CHECK_ANGLES);
    if (status == TRI_OK && all->n_small > 0)
        status = judge_angles(c, &apexes);
    free_apexes(&apexes);
    return status;
}
