/* Which small angles the input is to blame for.
 *
 * An apex is a vertex where two subsegments meet at less than 60 degrees (or what the options say) with the mesh
 * between them. Near it no mesher can keep a bound: triangles at the apex, those that touch one at it, and those that
 * span its legs further out (across two concentric shells; Miller, Pav & Walkington 2003) are explained by it. */
#include "triangle/check/apex.h"

#include <math.h>
#include <stdlib.h>

enum {
    MAX_LEGS = 24, /* legs of apexes that one corner is tried for */
    NO_APEX = -1,
    UNKNOWN = -2,
    UNDER_WAY = -3
};

/* Is there a triangle on the left of the subsegment, seen from its end that the fan entry names? */
static bool is_meshed(const struct checker *c, int32_t fan_entry)
{
    return c->sides[fan_entry >> 1][fan_entry & 1].half_edge >= 0;
}

/* Between two fan entries at v. */
static bool is_wedge(const struct apexes *w, int32_t v, int32_t i, int32_t j)
{
    const struct checker *c = w->c;
    struct tri_point o = check_point(c, v);
    struct tri_point p = check_point(c, c->segments[i ^ 1]), q = check_point(c, c->segments[j ^ 1]);
    double ax = p.x - o.x, ay = p.y - o.y, bx = q.x - o.x, by = q.y - o.y, dot = ax * bx + ay * by;
    if (dot * fabs(dot) <= (w->apex_cosine + TRI_CHECK_SLACK) * (ax * ax + ay * ay) * (bx * bx + by * by))
        return false;
    bool left = ax * by - ay * bx > 0;
    return is_meshed(c, left ? i : j); /* a triangle between them? */
}

/* More than 24 subsegments enclose an angle of 15 degrees at most: no need to compare them all. */
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

bool tri_check_is_explained(struct apexes *q, const int64_t *v)
{
    return has_state(q->c, v, CHECK_NEAR) || spans_legs(q, v);
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
            c->state[check_vertex(c, v)] |= CHECK_APEX;
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

enum tri_status tri_check_mark_near(struct apexes *q)
{
    struct checker *c = q->c;
    int64_t n = c->report->n_apexes > 0 ? c->n_triangles : 0;
    return tri_check_each_slice(c, TRI_CHECK_CORNERS, n, 3 * sizeof(int64_t), mark_near, c);
}

enum tri_status tri_check_find_apexes(struct apexes *q, struct checker *c)
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

void tri_check_free_apexes(struct apexes *q)
{
    free(q->is_apex);
    free(q->apex_of);
}
