/* Lines: subsegments that follow each other exactly straight on.
 *
 * Of three points on a line that share a subsegment with three others all are on that line: so each subsegment belongs
 * to one line, and an input segment with both ends on it runs along all that lies between them, however many others do,
 * too. It is certain that it runs there if no other subsegment leaves a vertex on the way within the tolerance. Lines
 * end at vertices of very many subsegments. */
#include "triangle/check/line.h"

#include <stdlib.h>

enum { HUB = 16 };

static bool is_before(struct tri_point p, struct tri_point q)
{
    return p.x != q.x ? p.x < q.x : p.y < q.y;
}

/* Fan entry of the subsegment at its lower (0) or upper (1) end. */
static int32_t entry_at(const struct checker *c, int32_t s, int upper)
{
    const int32_t *ends = c->segments + 2 * (size_t)s;
    return 2 * s + (is_before(check_point(c, ends[0]), check_point(c, ends[1])) == upper);
}

static int32_t end_of(const struct checker *c, int32_t s, int upper)
{
    return c->segments[entry_at(c, s, upper)];
}

static int32_t degree(const struct checker *c, int32_t v)
{
    return c->fan_first[v + 1] - c->fan_first[v];
}

/* The subsegment that goes on straight beyond an end of s; -1: none. */
static int32_t straight_on(const struct checker *c, int32_t s, int upper)
{
    int32_t v = end_of(c, s, upper), from = end_of(c, s, !upper);
    for (int32_t i = c->fan_first[v]; degree(c, v) <= HUB && i < c->fan_first[v + 1]; i++) {
        int32_t r = c->fan[i] >> 1, to = c->segments[c->fan[i] ^ 1];
        if (end_of(c, r, !upper) == v && tri_orient2d(check_point(c, from), check_point(c, v), check_point(c, to)) == 0)
            return r;
    }
    return -1;
}

static double distance_from(const struct checker *c, int32_t s, int32_t v)
{
    struct tri_point a = check_point(c, end_of(c, s, 0)), b = check_point(c, end_of(c, s, 1)), p = check_point(c, v);
    double x = b.x - a.x, y = b.y - a.y;
    return fabs((p.x - a.x) * y - (p.y - a.y) * x) / sqrt(x * x + y * y);
}

/* Does another subsegment leave that end of s within the tolerance of its line, and not on it? */
static bool forks_at(const struct checker *c, int32_t s, int upper)
{
    int32_t v = end_of(c, s, upper), from = end_of(c, s, !upper), next = straight_on(c, s, upper);
    for (int32_t i = c->fan_first[v]; degree(c, v) <= HUB && i < c->fan_first[v + 1]; i++) {
        int32_t r = c->fan[i] >> 1, to = c->segments[c->fan[i] ^ 1];
        if (r != s && r != next && (to == from || distance_from(c, s, to) <= 2 * c->tolerance))
            return true;
    }
    return false;
}

static void lay_line(struct check_lines *l, int32_t s, int32_t *n)
{
    const struct checker *c = l->c;
    int32_t below = straight_on(c, s, 0);
    for (int32_t steps = 0; below >= 0 && l->place[below] < 0 && steps < c->n_segments; steps++) {
        s = below;
        below = straight_on(c, s, 0);
    }
    for (; s >= 0 && l->place[s] < 0; s = straight_on(c, s, 1)) {
        l->place[s] = *n;
        l->line_of[*n] = l->n_lines;
        l->at[(*n)++] = s;
    }
    l->begin[++l->n_lines] = *n;
}

static void find_forks(void *lines, const struct check_share *share)
{
    struct check_lines *l = lines;
    for (int64_t i = share->first; i < share->end; i++)
        l->forks[i + 1] = forks_at(l->c, l->at[i], 0) || forks_at(l->c, l->at[i], 1);
}

static void lay_lines(struct check_lines *l)
{
    const struct checker *c = l->c;
    int32_t n = 0;
    for (int32_t s = 0; s < c->n_segments; s++)
        l->place[s] = -1;
    l->begin[0] = 0;
    for (int32_t s = 0; s < c->n_segments; s++) {
        if (l->place[s] < 0 && check_is_listed_well(c, s))
            lay_line(l, s, &n);
    }
    tri_check_in_shares(c, n, find_forks, l);
    l->forks[0] = 0;
    for (int32_t i = 0; i < n; i++)
        l->forks[i + 1] += l->forks[i];
}

enum tri_status tri_check_lines_make(struct check_lines *l, const struct checker *c)
{
    *l = (struct check_lines){.c = c};
    l->place = tri_check_array(c->n_segments, sizeof *l->place);
    l->at = tri_check_array(c->n_segments, sizeof *l->at);
    l->line_of = tri_check_array(c->n_segments, sizeof *l->line_of);
    l->begin = tri_check_array(c->n_segments, sizeof *l->begin);
    l->forks = tri_check_array(c->n_segments, sizeof *l->forks);
    if (l->place == NULL || l->at == NULL || l->line_of == NULL || l->begin == NULL || l->forks == NULL)
        return TRI_NO_MEMORY;
    lay_lines(l);
    return TRI_OK;
}

void tri_check_lines_free(struct check_lines *l)
{
    free(l->place);
    free(l->at);
    free(l->line_of);
    free(l->begin);
    free(l->forks);
}

/* The subsegment at an end (0: the lower one) of the segment from low to high that lies on it; -1: none. */
static int32_t find_on(const struct checker *c, int32_t low, int32_t high, int upper)
{
    int32_t v = upper ? high : low, beyond = upper ? low : high;
    for (int32_t i = c->fan_first[v]; degree(c, v) <= HUB && i < c->fan_first[v + 1]; i++) {
        int32_t s = c->fan[i] >> 1, to = c->segments[c->fan[i] ^ 1];
        if (end_of(c, s, upper) == v && (to == beyond || tri_orient2d(check_point(c, low), check_point(c, high),
                                                                      check_point(c, to)) == 0))
            return s;
    }
    return -1;
}

/* First place of the line whose subsegment does not end below vertex v. */
static int32_t find_end(const struct check_lines *l, int32_t line, int32_t v)
{
    const struct checker *c = l->c;
    int32_t low = l->begin[line], high = l->begin[line + 1];
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (is_before(check_point(c, end_of(c, l->at[middle], 1)), check_point(c, v)))
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

struct check_stretch tri_check_stretch(const struct check_lines *l, int32_t a, int32_t b)
{
    const struct checker *c = l->c;
    const struct check_stretch none = {-1, -1};
    bool ascends = is_before(check_point(c, a), check_point(c, b));
    int32_t low = ascends ? a : b, high = ascends ? b : a, s = find_on(c, low, high, 0);
    if (s < 0)
        s = find_on(c, low, high, 1);
    if (s < 0)
        return none;
    int32_t line = l->line_of[l->place[s]], last = find_end(l, line, high), first = last;
    if (last >= l->begin[line + 1] || end_of(c, l->at[last], 1) != high)
        return none;
    if (end_of(c, l->at[l->begin[line]], 0) == low)
        first = l->begin[line];
    else
        first = find_end(l, line, low) + 1;
    bool there = first < l->begin[line + 1] && end_of(c, l->at[first], 0) == low;
    return there && l->forks[last + 1] == l->forks[first] ? (struct check_stretch){first, last + 1} : none;
}
