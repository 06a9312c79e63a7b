/* Tubes: all that lies within rounding of one line, so that many input segments that overlap need not look for their
 * chains one by one.
 *
 *   1. The longest input segment that is in no tube yet gives a line; subsegments that can be reached from its ends are
 *      of its tube, up to its length beyond them. So what overlaps it, which is no longer, lies in that tube, too.
 *   2. Entries are sorted by their lower places. Beside each stands the next one that reaches higher, if no gap is
 *      before it: the way up from an entry is a path in a forest, climbed by jumps (Myers 1983). Its entries begin no
 *      lower than the first one; what reaches beyond the span's high end is passed over by a scan near it.
 *   3. THEOREM. Let the ends of an input segment be at most s off the tube's line, and what lies between them in the
 *      tube at most r. Then all of that is at most r + s off the input segment, which between its ends is no farther
 *      off the line than they are. */
#include "triangle/check/tube.h"

#include <stdlib.h>

#include "triangle/base/grow.h"

enum { HUB = 16, MOST_TUBES = 2 /* that a subsegment is in, on an average */ };

static const double WIDTH = 4, FORK = 2; /* tolerances off the line: of what is in a tube, of what is a way */

struct making {
    struct check_tubes *t;
    uint32_t *seen;    /* [n_frame] last tube that reached the vertex, from 1 */
    int32_t *stack;    /* [max(n_frame, n_segments) + 1] */
    int32_t *root;     /* [n_frame] of vertices of the last tube: one nearer to that of their piece, or themselves */
};

static double place(const struct check_tube *u, struct tri_point p)
{
    return ((p.x - u->from.x) * (u->to.x - u->from.x) + (p.y - u->from.y) * (u->to.y - u->from.y)) / u->length;
}

static double off(const struct check_tube *u, struct tri_point p)
{
    return fabs(tri_orient2d(u->from, u->to, p)) / u->length;
}

static void set_line(struct check_tube *u, struct tri_point from, struct tri_point to)
{
    u->from = from;
    u->to = to;
    u->length = hypot(to.x - from.x, to.y - from.y);
}

static int32_t degree(const struct checker *c, int32_t v)
{
    return c->fan_first[v + 1] - c->fan_first[v];
}

/* --- its subsegments */

static bool is_within(const struct checker *c, const struct check_tube *u, struct tri_point p, double beyond)
{
    double at = place(u, p);
    return at >= -beyond && at <= u->length + beyond && off(u, p) <= WIDTH * c->tolerance;
}

static enum tri_status reach_from(struct making *m, struct check_tube *u, int32_t v)
{
    struct check_tubes *t = m->t;
    const struct checker *c = t->c;
    const uint32_t number = (uint32_t)t->n_tubes;
    int32_t top = 0;
    if (m->seen[v] != number)
        m->stack[top++] = v;
    m->seen[v] = number;
    while (top > 0) {
        v = m->stack[--top];
        for (int32_t i = c->fan_first[v]; degree(c, v) <= HUB && i < c->fan_first[v + 1]; i++) {
            int32_t w = c->segments[c->fan[i] ^ 1];
            if (!is_within(c, u, check_point(c, w), u->length))
                continue;
            if (v < w || degree(c, w) > HUB) { /* once */
                if (!tri_grow(&t->entry, &t->entry_capacity, t->n_entries + 1, sizeof *t->entry))
                    return TRI_NO_MEMORY;
                t->entry[t->n_entries++].subsegment = c->fan[i] >> 1;
            }
            if (m->seen[w] != number)
                m->stack[top++] = w;
            m->seen[w] = number;
        }
    }
    return TRI_OK;
}

static int compare_entries(const void *a, const void *b)
{
    const struct check_tube_entry *e = a, *f = b;
    if (e->low != f->low)
        return e->low < f->low ? -1 : 1;
    if (e->high != f->high)
        return e->high < f->high ? -1 : 1;
    return (e->subsegment > f->subsegment) - (e->subsegment < f->subsegment);
}

/* The line from the lowest to the highest end of the entries. */
static void lay_line(const struct check_tubes *t, struct check_tube *u)
{
    const struct checker *c = t->c;
    struct tri_point lowest = u->from, highest = u->to;
    double low = 0, high = u->length;
    for (int32_t i = 2 * u->first; i < 2 * u->last; i++) {
        struct tri_point p = check_point(c, c->segments[2 * t->entry[i >> 1].subsegment + (i & 1)]);
        double at = place(u, p);
        if (at < low) {
            low = at;
            lowest = p;
        } else if (at > high) {
            high = at;
            highest = p;
        }
    }
    set_line(u, lowest, highest);
}

static void lay_entries(struct check_tubes *t, const struct check_tube *u)
{
    const struct checker *c = t->c;
    for (int32_t i = u->first; i < u->last; i++) {
        struct check_tube_entry *e = &t->entry[i];
        struct tri_point p = check_point(c, c->segments[2 * e->subsegment]);
        struct tri_point q = check_point(c, c->segments[2 * e->subsegment + 1]);
        e->low = fmin(place(u, p), place(u, q));
        e->high = fmax(place(u, p), place(u, q));
        e->off = fmax(off(u, p), off(u, q));
    }
    qsort(t->entry + u->first, (size_t)(u->last - u->first), sizeof *t->entry, compare_entries);
}

/* Step 2. */
static void find_next(struct making *m, const struct check_tube *u)
{
    struct check_tube_entry *entry = m->t->entry;
    int32_t top = 0;
    for (int32_t i = u->last - 1; i >= u->first; i--) {
        struct check_tube_entry *e = &entry[i];
        while (top > 0 && entry[m->stack[top - 1]].high <= e->high)
            top--;
        int32_t next = top > 0 ? m->stack[top - 1] : -1;
        m->stack[top++] = i;
        e->next = next >= 0 && entry[next].low <= e->high ? next : -1;
        e->jump = i;
        e->depth = 0;
        if (e->next < 0)
            continue;
        int32_t jump = entry[next].jump, twice = entry[jump].jump;
        bool even = entry[next].depth - entry[jump].depth == entry[jump].depth - entry[twice].depth;
        e->jump = even ? twice : next;
        e->depth = entry[next].depth + 1;
    }
}

/* The root of a vertex' piece; what was passed is shortened (Tarjan 1975, by halving). */
static int32_t root_of(struct making *m, int32_t v)
{
    while (m->root[v] != v)
        v = m->root[v] = m->root[m->root[v]];
    return v;
}

/* Which entries are connected with each other? */
static void find_pieces(struct making *m, const struct check_tube *u)
{
    struct check_tube_entry *entry = m->t->entry;
    const int32_t *segments = m->t->c->segments;
    for (int32_t i = u->first; i < u->last; i++)
        for (int end = 0; end < 2; end++)
            m->root[segments[2 * entry[i].subsegment + end]] = segments[2 * entry[i].subsegment + end];
    for (int32_t i = u->first; i < u->last; i++)
        m->root[root_of(m, segments[2 * entry[i].subsegment])] = root_of(m, segments[2 * entry[i].subsegment + 1]);
    for (int32_t i = u->first; i < u->last; i++)
        entry[i].piece = root_of(m, segments[2 * entry[i].subsegment]);
}

/* --- places */

/* The first entry that begins no lower than that. */
static int32_t find_low(const struct check_tubes *t, const struct check_tube *u, double at)
{
    int32_t low = u->first, high = u->last;
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (t->entry[middle].low < at)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static int32_t find_entry(const struct check_tubes *t, const struct check_tube *u, int32_t s)
{
    const struct checker *c = t->c;
    double low = fmin(place(u, check_point(c, c->segments[2 * s])), place(u, check_point(c, c->segments[2 * s + 1])));
    for (int32_t i = find_low(t, u, low); i < u->last && t->entry[i].low == low; i++)
        if (t->entry[i].subsegment == s)
            return i;
    return -1;
}

/* The piece that a vertex is of, -1: none, or too many subsegments end there. */
static int32_t piece_at(const struct check_tubes *t, const struct check_tube *u, int32_t v)
{
    const struct checker *c = t->c;
    int32_t entry = -1;
    for (int32_t i = c->fan_first[v]; degree(c, v) <= HUB && entry < 0 && i < c->fan_first[v + 1]; i++)
        entry = find_entry(t, u, c->fan[i] >> 1);
    return entry < 0 ? -1 : t->entry[entry].piece;
}

bool tri_check_tube_ascends(const struct check_tubes *t, int32_t tube, int32_t from, int32_t to)
{
    return place(&t->tube[tube], check_point(t->c, from)) < place(&t->tube[tube], check_point(t->c, to));
}

int32_t tri_check_tube_sole_way(const struct check_tubes *t, int32_t tube, int32_t v, int up)
{
    const struct checker *c = t->c;
    const struct check_tube *u = &t->tube[tube];
    const double at = place(u, check_point(c, v));
    int32_t ways = 0, found = -1;
    for (int32_t i = c->fan_first[v]; degree(c, v) <= HUB && i < c->fan_first[v + 1]; i++) {
        struct tri_point p = check_point(c, c->segments[c->fan[i] ^ 1]);
        double on = up ? place(u, p) - at : at - place(u, p);
        if (on <= -c->tolerance || off(u, p) > FORK * c->tolerance)
            continue;
        ways++;
        found = c->fan[i] >> 1;
    }
    return ways == 1 ? find_entry(t, u, found) : -1;
}

static void find_onward(struct check_tubes *t, int32_t tube)
{
    const struct checker *c = t->c;
    const struct check_tube *u = &t->tube[tube];
    for (int32_t i = u->first; i < u->last; i++) {
        const int32_t *ends = c->segments + 2 * (size_t)t->entry[i].subsegment;
        int ascends = place(u, check_point(c, ends[0])) <= place(u, check_point(c, ends[1]));
        for (int up = 0; up < 2; up++) {
            struct check_tube_entry *e = &t->entry[i];
            const int32_t way = tri_check_tube_sole_way(t, tube, ends[up == ascends], up);
            const bool on = way >= 0 && (up ? t->entry[way].high > e->high : t->entry[way].low < e->low);
            e->onward[up] = on ? way : -1; /* steps beneath the tolerance may lead to and fro */
        }
    }
}

/* --- all tubes */

struct candidate { /* an input segment */
    double length;
    int32_t id, ends[2]; /* vertices */
};

static int compare_candidates(const void *a, const void *b)
{
    const struct candidate *p = a, *q = b;
    if (p->length != q->length)
        return p->length > q->length ? -1 : 1;
    return (p->id > q->id) - (p->id < q->id);
}

static enum tri_status make_tube(struct making *m, const struct candidate *s)
{
    struct check_tubes *t = m->t;
    const struct checker *c = t->c;
    if (!tri_grow(&t->tube, &t->tube_capacity, t->n_tubes + 1, sizeof *t->tube))
        return TRI_NO_MEMORY;
    struct check_tube *u = &t->tube[t->n_tubes++];
    u->first = t->n_entries;
    set_line(u, check_point(c, s->ends[0]), check_point(c, s->ends[1]));
    enum tri_status status = reach_from(m, u, s->ends[0]);
    if (status == TRI_OK)
        status = reach_from(m, u, s->ends[1]);
    if (status != TRI_OK)
        return status;
    u->last = t->n_entries;
    lay_line(t, u);
    lay_entries(t, u);
    find_next(m, u);
    find_pieces(m, u);
    find_onward(t, t->n_tubes - 1);
    for (int32_t i = u->first; i < u->last; i++) {
        int32_t *of = &t->tube_of[t->entry[i].subsegment];
        *of = *of < 0 ? t->n_tubes - 1 : *of;
    }
    return TRI_OK;
}

/* A tube that holds both ends, -1: none. */
static int32_t find_tube(const struct check_tubes *t, const int32_t *ends)
{
    const struct checker *c = t->c;
    for (int k = 0; k < 2; k++) {
        int32_t v = ends[k];
        for (int32_t i = c->fan_first[v]; degree(c, v) <= HUB && i < c->fan_first[v + 1]; i++) {
            int32_t u = t->tube_of[c->fan[i] >> 1];
            if (u >= 0 && is_within(c, &t->tube[u], check_point(c, ends[0]), c->tolerance) &&
                is_within(c, &t->tube[u], check_point(c, ends[1]), c->tolerance))
                return u;
        }
    }
    return -1;
}

static int32_t list_candidates(const struct checker *c, int32_t first, struct candidate *out)
{
    int32_t n = 0;
    for (int32_t id = first; id < c->input->n_segments; id++) {
        const int32_t *ends = c->input->segments + 2 * (size_t)id;
        if (ends[0] < 0 || ends[0] >= c->input->n_points || ends[1] < 0 || ends[1] >= c->input->n_points)
            continue;
        struct candidate s = {0, id, {c->twin[ends[0]], c->twin[ends[1]]}};
        if (s.ends[0] < 0 || s.ends[1] < 0 || s.ends[0] == s.ends[1])
            continue;
        struct tri_point p = check_point(c, s.ends[0]), q = check_point(c, s.ends[1]);
        s.length = hypot(p.x - q.x, p.y - q.y);
        out[n++] = s;
    }
    qsort(out, (size_t)n, sizeof *out, compare_candidates);
    return n;
}

static enum tri_status make_all(struct making *m, const struct candidate *candidate, int32_t n)
{
    struct check_tubes *t = m->t;
    enum tri_status status = TRI_OK;
    for (int32_t i = 0; i < n && t->n_entries / MOST_TUBES <= t->c->n_segments && status == TRI_OK; i++) {
        int32_t *of = &t->of_line[candidate[i].id];
        *of = find_tube(t, candidate[i].ends);
        if (*of >= 0)
            continue;
        *of = t->n_tubes;
        status = make_tube(m, &candidate[i]);
    }
    return status;
}

static enum tri_status find_all(struct check_tubes *t, int32_t first)
{
    const struct checker *c = t->c;
    int32_t most = c->n_frame > c->n_segments ? c->n_frame : c->n_segments, n = c->input->n_segments - first;
    struct making m = {t, tri_check_zeros(c->n_frame, sizeof *m.seen), tri_check_array(most, sizeof *m.stack),
                       tri_check_array(c->n_frame, sizeof *m.root)};
    struct candidate *candidate = tri_check_array(n, sizeof *candidate);
    enum tri_status status = TRI_NO_MEMORY;
    if (m.seen != NULL && m.stack != NULL && m.root != NULL && candidate != NULL)
        status = make_all(&m, candidate, list_candidates(c, first, candidate));
    free(m.seen);
    free(m.stack);
    free(m.root);
    free(candidate);
    return status;
}

/* --- trees */

static int32_t marker_of(const struct check_tubes *t, int32_t entry)
{
    return t->c->segment_markers[t->entry[entry].subsegment];
}

struct keyed {
    int32_t tube, marker, entry;
};

static int compare_keyed(const void *a, const void *b)
{
    const struct keyed *p = a, *q = b;
    if (p->tube != q->tube)
        return p->tube < q->tube ? -1 : 1;
    if (p->marker != q->marker)
        return p->marker < q->marker ? -1 : 1;
    return (p->entry > q->entry) - (p->entry < q->entry);
}

static enum tri_status begin_taking(const struct check_tubes *t, struct check_taking *taking, bool by_marker)
{
    const int32_t n = t->n_entries;
    struct keyed *keyed = tri_check_array(n, sizeof *keyed);
    taking->order = tri_check_array(n, sizeof *taking->order);
    taking->least = tri_check_array(2 * (int64_t)t->size, sizeof *taking->least);
    const bool room = keyed != NULL && taking->order != NULL && taking->least != NULL;
    for (int32_t k = 0; room && k < t->n_tubes; k++)
        for (int32_t i = t->tube[k].first; i < t->tube[k].last; i++)
            keyed[i] = (struct keyed){k, by_marker ? marker_of(t, i) : 0, i};
    if (room)
        qsort(keyed, (size_t)n, sizeof *keyed, compare_keyed);
    for (int32_t i = 0; room && i < t->size; i++) {
        if (i < n)
            taking->order[i] = keyed[i].entry;
        taking->least[t->size + i] = i < n ? t->entry[taking->order[i]].high : INFINITY;
    }
    for (int32_t i = t->size - 1; room && i > 0; i--)
        taking->least[i] = fmin(taking->least[2 * i], taking->least[2 * i + 1]);
    free(keyed);
    return room ? TRI_OK : TRI_NO_MEMORY;
}

static enum tri_status make_trees(struct check_tubes *t)
{
    t->size = 1;
    while (t->size < t->n_entries)
        t->size *= 2;
    t->most_off = tri_check_zeros(2 * (int64_t)t->size, sizeof *t->most_off);
    if (t->most_off == NULL)
        return TRI_NO_MEMORY;
    for (int32_t i = 0; i < t->n_entries; i++)
        t->most_off[t->size + i] = t->entry[i].off;
    for (int32_t i = t->size - 1; i > 0; i--)
        t->most_off[i] = fmax(t->most_off[2 * i], t->most_off[2 * i + 1]);
    enum tri_status status = begin_taking(t, &t->any, false);
    return status == TRI_OK && t->c->segment_markers != NULL ? begin_taking(t, &t->marked, true) : status;
}

enum tri_status tri_check_tubes_make(struct check_tubes *t, const struct checker *c, int32_t first)
{
    *t = (struct check_tubes){.c = c};
    t->tube_of = tri_check_array(c->n_segments, sizeof *t->tube_of);
    t->of_line = tri_check_array(c->input->n_segments, sizeof *t->of_line);
    if (t->tube_of == NULL || t->of_line == NULL)
        return TRI_NO_MEMORY;
    for (int32_t s = 0; s < c->n_segments; s++)
        t->tube_of[s] = -1;
    for (int32_t id = 0; id < c->input->n_segments; id++)
        t->of_line[id] = -1;
    enum tri_status status = find_all(t, first);
    return status == TRI_OK ? make_trees(t) : status;
}

void tri_check_tubes_free(struct check_tubes *t)
{
    void *arrays[] = {t->tube, t->entry, t->tube_of, t->of_line, t->most_off, t->any.order, t->any.least,
                      t->marked.order, t->marked.least};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        free(arrays[i]);
}

/* --- questions */

static double most_off(const struct check_tubes *t, int32_t first, int32_t last)
{
    double most = 0;
    for (first += t->size, last += t->size; first < last; first /= 2, last /= 2) {
        if (first % 2 == 1)
            most = fmax(most, t->most_off[first++]);
        if (last % 2 == 1)
            most = fmax(most, t->most_off[--last]);
    }
    return most;
}

/* Step 2: is it covered from entry i, which begins at its low end, up to its high end? */
static bool is_covered(const struct check_tubes *t, int32_t i, int32_t last, double high)
{
    const struct check_tube_entry *entry = t->entry;
    while (entry[i].next >= 0 && entry[entry[i].next].high <= high)
        i = entry[entry[i].jump].high <= high ? entry[i].jump : entry[i].next;
    double covered = entry[i].high;
    for (i++; i < last && covered < high && entry[i].low <= covered; i++)
        covered = entry[i].high <= high ? fmax(covered, entry[i].high) : covered;
    return covered >= high;
}

bool tri_check_tube_span(const struct check_tubes *t, int32_t id, const int32_t *ends, double tolerance,
                         struct check_span *span)
{
    const int32_t tube = t->of_line != NULL ? t->of_line[id] : -1;
    if (tube < 0)
        return false;
    const struct check_tube *u = &t->tube[tube];
    const struct tri_point p = check_point(t->c, ends[0]), q = check_point(t->c, ends[1]);
    const double low = fmin(place(u, p), place(u, q)), high = fmax(place(u, p), place(u, q));
    *span = (struct check_span){tube, low, high, tolerance};
    const int32_t first = find_low(t, u, low), last = find_low(t, u, high);
    if (first == u->last || t->entry[first].low != low || t->entry[first].high > high)
        return false;
    const int32_t from = piece_at(t, u, ends[0]), to = piece_at(t, u, ends[1]);
    if (from >= 0 && to >= 0 && from != to) /* pieces beside each other */
        return false;
    const double most = most_off(t, find_low(t, u, low - tolerance), find_low(t, u, high + tolerance));
    return most + fmax(off(u, p), off(u, q)) <= tolerance && is_covered(t, first, last, high);
}

/* Where entries of the tube with the key begin, from a place on. */
static int32_t find_in_order(const struct check_tubes *t, const struct check_tube *u, const int32_t *marker, double at)
{
    if (marker == NULL)
        return find_low(t, u, at);
    int32_t low = u->first, high = u->last;
    while (low < high) {
        int32_t middle = low + (high - low) / 2, i = t->marked.order[middle];
        if (marker_of(t, i) < *marker || (marker_of(t, i) == *marker && t->entry[i].low < at))
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

struct wanted {
    struct check_tubes *t;
    struct check_taking *from;
    int32_t first, last; /* in its order */
    double high;
    void (*take)(void *user, int32_t subsegment);
    void *user;
};

/* What is wanted below a node of the tree, which stands for n places in the order from `at` on. */
static void take_below(const struct wanted *w, int32_t node, int32_t at, int32_t n)
{
    double *least = w->from->least;
    if (at >= w->last || at + n <= w->first || !(least[node] <= w->high))
        return;
    if (n == 1) {
        least[node] = INFINITY;
        w->take(w->user, w->t->entry[w->from->order[at]].subsegment);
        return;
    }
    take_below(w, 2 * node, at, n / 2);
    take_below(w, 2 * node + 1, at + n / 2, n / 2);
    least[node] = fmin(least[2 * node], least[2 * node + 1]);
}

void tri_check_tube_take(struct check_tubes *t, const struct check_span *span, const int32_t *marker,
                         void (*take)(void *user, int32_t subsegment), void *user)
{
    const struct check_tube *u = &t->tube[span->tube];
    struct wanted w = {t, marker != NULL ? &t->marked : &t->any,
                       find_in_order(t, u, marker, span->low - span->margin),
                       find_in_order(t, u, marker, span->high + span->margin), span->high + span->margin, take, user};
    take_below(&w, 1, 0, t->size);
}
