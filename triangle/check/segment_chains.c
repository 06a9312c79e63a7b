/* Input segments as chains of subsegments.
 *
 * 1. Depth-first search from the first end of the input segment, along subsegments whose far end lies on its line
 *    within the tolerance, not backwards and not beyond the end; the best aligned first. Each vertex is visited once
 *    per segment, because what can be reached from it does not depend on the path to it. If nearly coincident
 *    segments leave several paths, the input segment certainly runs along the subsegments up to the first fork, and
 *    possibly along the others. Their markers are correct if some choice of paths makes them so.
 * 2. If the second end is not reached, pieces may have been carved. Then all subsegment vertices on the line are
 *    sorted along it, and chains are followed from each one beyond the covered part.
 * 3. Uncovered parts must lie outside the mesh; the sweep tests some of their points. If no part is uncovered but no
 *    chain leads from end to end, a piece beside others within rounding is missing. It may have been carved if one
 *    of the others bounds the mesh. */
#include "triangle/check/internal.h"

#include <math.h>
#include <stdlib.h>

#include "triangle/base/grow.h"
#include "triangle/geometry/predicates.h"

enum { HUB = 16 };

struct line { /* the current input segment */
    int32_t id, marker;
    struct tri_point a, b;
    double dx, dy, length, tolerance;
};

struct stop {  /* a vertex on the line */
    double at; /* distance from a, along the line */
    int32_t vertex;
};

struct place { /* position of a subsegment vertex */
    struct tri_point at;
    int32_t vertex;
};

struct chains {
    struct checker *c;
    uint32_t search;   /* number of the current search */
    uint32_t *seen;    /* [n_points] last search that visited the vertex, 0: none */
    int32_t *via;      /* [n_points] fan entry from which it was reached, -1: start of the search */
    uint32_t *forked;  /* [n_points] last search that found several paths from the vertex */
    int32_t *stack;    /* [2 * n_segments + 1] each subsegment is pushed at most once from each end */
    int32_t *certain;  /* [n_segments] first input segment with a marker that runs along the subsegment, -1: none */
    int32_t *possible; /* [n_segments] first one with the subsegment's own marker that may run along it, -1: none */
    bool beside_border; /* true: the mesh ends at a subsegment along the current input segment */
    struct stop *stop; /* [at most n_points] */
    int32_t n_stops, stop_capacity; /* vertices on the line; allocated */
    struct place *place; /* [n_places] sorted from left to right; made when first needed */
    int32_t n_places;    /* number of subsegment vertices */
};

static double along(const struct line *l, struct tri_point p)
{
    return ((p.x - l->a.x) * l->dx + (p.y - l->a.y) * l->dy) / l->length;
}

static double away(const struct line *l, struct tri_point p)
{
    return fabs((p.x - l->a.x) * l->dy - (p.y - l->a.y) * l->dx) / l->length;
}

static bool is_on(const struct line *l, struct tri_point p)
{
    double at = along(l, p);
    return away(l, p) <= l->tolerance && at >= -l->tolerance && at <= l->length + l->tolerance;
}

static int32_t other_end(const struct chains *k, int32_t fan_entry)
{
    return k->c->segments[fan_entry ^ 1];
}

static void may_run_along(struct chains *k, const struct line *l, int32_t subsegment)
{
    const int32_t *given = k->c->segment_markers;
    if (given != NULL && l->marker != 0 && l->marker == given[subsegment] && k->possible[subsegment] < 0)
        k->possible[subsegment] = l->id;
}

/* Pushes the paths that continue from vertex u, the best aligned on top. A step backwards by less than the tolerance
 * is allowed. */
static int32_t push_ways(struct chains *k, const struct line *l, int32_t u, int32_t top)
{
    const struct checker *c = k->c;
    struct tri_point from = check_point(c, u);
    double best = INFINITY;
    int ways = 0;
    for (int32_t i = c->fan_first[u]; i < c->fan_first[u + 1]; i++) {
        int32_t w = other_end(k, c->fan[i]);
        struct tri_point to = check_point(c, w);
        if (c->fan[i] == (k->via[u] ^ 1) || along(l, to) - along(l, from) <= -l->tolerance || !is_on(l, to))
            continue;
        may_run_along(k, l, c->fan[i] >> 1);
        k->beside_border |= check_is_border(c, c->fan[i] >> 1);
        c->is_along[c->fan[i] >> 1] = 1;
        ways++;
        if (k->seen[w] == k->search)
            continue;
        k->stack[top++] = c->fan[i];
        double off = away(l, to);
        if (off < best) {
            best = off;
        } else { /* keep the best on top */
            int32_t other = k->stack[top - 2];
            k->stack[top - 2] = k->stack[top - 1];
            k->stack[top - 1] = other;
        }
    }
    if (ways > 1)
        k->forked[u] = k->search;
    return top;
}

/* Step 1: searches from vertex u towards `goal` along all paths. Returns the goal, or the farthest vertex if the
 * goal is not reached. */
static int32_t follow(struct chains *k, const struct line *l, int32_t u, int32_t goal)
{
    int32_t top = 0, furthest = u;
    bool arrived = false;
    k->seen[u] = k->search;
    k->via[u] = -1;
    for (;;) {
        if (u == goal)
            arrived = true;
        else
            top = push_ways(k, l, u, top);
        do {
            if (top == 0)
                return arrived ? goal : furthest;
            u = other_end(k, k->stack[--top]);
        } while (k->seen[u] == k->search);
        k->seen[u] = k->search;
        k->via[u] = k->stack[top];
        if (along(l, check_point(k->c, u)) > along(l, check_point(k->c, furthest)))
            furthest = u;
    }
}

/* Does p lie exactly on the input segment? */
static bool holds(const struct line *l, struct tri_point p)
{
    return p.x >= fmin(l->a.x, l->b.x) && p.x <= fmax(l->a.x, l->b.x) && p.y >= fmin(l->a.y, l->b.y) &&
           p.y <= fmax(l->a.y, l->b.y) && tri_orient2d(l->a, l->b, p) == 0;
}

static bool is_exactly_on(const struct chains *k, const struct line *l, int32_t subsegment)
{
    const int32_t *ends = k->c->segments + 2 * (size_t)subsegment;
    return holds(l, check_point(k->c, ends[0])) && holds(l, check_point(k->c, ends[1]));
}

/* Does the chain to u contain a step that advances by at most the tolerance? Such a step may lead to vertices of
 * another input segment, and past a carved piece. */
static bool has_side_step(const struct chains *k, const struct line *l, int32_t u)
{
    const struct checker *c = k->c;
    for (; k->via[u] >= 0; u = c->segments[k->via[u]])
        if (along(l, check_point(c, u)) - along(l, check_point(c, c->segments[k->via[u]])) <= l->tolerance)
            return true;
    return false;
}

/* Marks the chain by which the search reached u as certain for the input segment, up to the first fork. If it is
 * only assumed that the chain belongs to the segment, marks the subsegments exactly on its line. */
static void mark_chain(struct chains *k, const struct line *l, int32_t u, bool whole)
{
    const struct checker *c = k->c;
    int32_t end = u;
    if (l->marker == 0)
        return;
    whole = whole && !has_side_step(k, l, u);
    for (; k->via[u] >= 0; u = c->segments[k->via[u]])
        if (k->forked[c->segments[k->via[u]]] == k->search)
            end = c->segments[k->via[u]];
    for (u = end; k->via[u] >= 0; u = c->segments[k->via[u]])
        if (k->certain[k->via[u] >> 1] < 0 && (whole || is_exactly_on(k, l, k->via[u] >> 1)))
            k->certain[k->via[u] >> 1] = l->id;
}

static int compare_places(const void *a, const void *b)
{
    const struct place *p = a, *q = b;
    int order = tri_compare_places(p->at, q->at);
    return order != 0 ? order : (p->vertex > q->vertex) - (p->vertex < q->vertex);
}

static enum tri_status list_places(struct chains *k)
{
    const struct checker *c = k->c;
    k->place = tri_check_array(c->n_frame, sizeof *k->place);
    if (k->place == NULL)
        return TRI_NO_MEMORY;
    for (int32_t v = 0; v < c->n_frame; v++)
        if (c->fan_first[v] < c->fan_first[v + 1])
            k->place[k->n_places++] = (struct place){check_point(c, v), v};
    qsort(k->place, (size_t)k->n_places, sizeof *k->place, compare_places);
    return TRI_OK;
}

static enum tri_status add_stop(struct chains *k, double at, int32_t v)
{
    if (!tri_grow(&k->stop, &k->stop_capacity, k->n_stops + 1, sizeof *k->stop))
        return TRI_NO_MEMORY;
    k->stop[k->n_stops++] = (struct stop){at, v};
    return TRI_OK;
}

static int compare_stops(const void *a, const void *b)
{
    const struct stop *s = a, *t = b;
    if (s->at != t->at)
        return s->at < t->at ? -1 : 1;
    return (s->vertex > t->vertex) - (s->vertex < t->vertex);
}

/* Returns the first place with an x coordinate of at least x. */
static int32_t find_place(const struct chains *k, double x)
{
    int32_t low = 0, high = k->n_places;
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (k->place[middle].at.x < x)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Step 2: lists the vertices on the line. */
static enum tri_status find_stops(struct chains *k, const struct line *l)
{
    enum tri_status status = k->place == NULL ? list_places(k) : TRI_OK;
    const double left = fmin(l->a.x, l->b.x) - 2 * l->tolerance, right = fmax(l->a.x, l->b.x) + 2 * l->tolerance;
    k->n_stops = 0;
    for (int32_t i = find_place(k, left); i < k->n_places && k->place[i].at.x <= right && status == TRI_OK; i++) {
        if (is_on(l, k->place[i].at))
            status = add_stop(k, along(l, k->place[i].at), k->place[i].vertex);
    }
    if (status == TRI_OK && k->n_stops > 1)
        qsort(k->stop, (size_t)k->n_stops, sizeof *k->stop, compare_stops);
    return status;
}

static enum tri_status note_missing(struct checker *c, struct tri_point from, struct tri_point to)
{
    if (!tri_grow(&c->missing, &c->missing_capacity, c->n_missing + 1, sizeof *c->missing))
        return TRI_NO_MEMORY;
    if (!check_same_place(from, to))
        c->missing[c->n_missing++] = (struct check_piece){from, to};
    return TRI_OK;
}

/* Step 3: adds queries for an uncovered part. Parts not much longer than the tolerance are ignored. Parts whose ends
 * are not certainly on the segment do not bound a face (winding.c). */
static enum tri_status query_gap(struct chains *k, const struct line *l, struct tri_point begin, struct tri_point end)
{
    double from = along(l, begin), to = along(l, end);
    bool sure = check_surely_meets(l->a, l->b, begin) && check_surely_meets(l->a, l->b, end);
    enum tri_status status = sure ? note_missing(k->c, begin, end) : TRI_OK;
    if (to - from <= 4 * l->tolerance)
        return status;
    for (int i = 1; i <= 3 && status == TRI_OK; i++) {
        double s = (from + (to - from) * i / 4) / l->length;
        struct tri_point p = {l->a.x + s * l->dx, l->a.y + s * l->dy};
        status = tri_check_query(k->c, p, TRI_CHECK_INPUT_SEGMENTS, l->id, l->tolerance);
    }
    return status;
}

/* Steps 2 and 3. */
static enum tri_status cover(struct chains *k, const struct line *l)
{
    enum tri_status status = find_stops(k, l);
    struct tri_point covered = l->a;
    k->search++;
    for (int32_t i = 0; i < k->n_stops && status == TRI_OK; i++) {
        struct stop s = k->stop[i];
        if (k->seen[s.vertex] == k->search)
            continue;
        if (s.at > along(l, covered))
            status = query_gap(k, l, covered, check_point(k->c, s.vertex));
        int32_t end = follow(k, l, s.vertex, -1);
        mark_chain(k, l, end, false);
        if (along(l, check_point(k->c, end)) >= along(l, covered))
            covered = check_point(k->c, end);
    }
    return status == TRI_OK ? query_gap(k, l, covered, l->b) : status;
}

static bool names_points(const struct tri_pslg *input, int32_t id)
{
    const int32_t *ends = input->segments + 2 * (size_t)id;
    return ends[0] >= 0 && ends[0] < input->n_points && ends[1] >= 0 && ends[1] < input->n_points;
}

/* Do more than HUB subsegments end at this input point? */
static bool is_hub(const struct checker *c, int32_t point)
{
    int32_t v = c->twin[point];
    return v >= 0 && c->fan_first[v + 1] - c->fan_first[v] > HUB;
}

static enum tri_status check_line(struct chains *k, int32_t id)
{
    const struct tri_pslg *input = k->c->input;
    int32_t a = input->segments[2 * (size_t)id], b = input->segments[2 * (size_t)id + 1];
    if (!names_points(input, id))
        return TRI_OK; /* the mesher skips it as well */
    if (is_hub(k->c, a) && !is_hub(k->c, b)) { /* ending the search at the hub avoids pushing its many subsegments */
        int32_t hub = a;
        a = b;
        b = hub;
    }
    const double *p = input->points + 2 * (size_t)a, *q = input->points + 2 * (size_t)b;
    double largest = fmax(fmax(fabs(p[0]), fabs(p[1])), fmax(fabs(q[0]), fabs(q[1])));
    largest = fmax(largest, TRI_LEAST_COORDINATE);
    struct line l = {id, input->segment_markers != NULL ? input->segment_markers[id] : 0, {p[0], p[1]}, {q[0], q[1]},
                     q[0] - p[0], q[1] - p[1], hypot(q[0] - p[0], q[1] - p[1]), TRI_CHECK_ULPS * 0x1p-52 * largest};
    if (!(l.length > 0) || !isfinite(l.length))
        return TRI_OK;
    int32_t from = k->c->twin[a], to = k->c->twin[b];
    k->search++;
    k->beside_border = false;
    int32_t reached = from >= 0 && to >= 0 ? follow(k, &l, from, to) : -1;
    if (reached >= 0 && reached == to) {
        mark_chain(k, &l, to, true);
        return TRI_OK;
    }
    const int64_t n_asked = (int64_t)k->c->n_queries + k->c->n_missing;
    enum tri_status status = cover(k, &l);
    const bool covered = n_asked == (int64_t)k->c->n_queries + k->c->n_missing;
    if (status != TRI_OK || reached < 0 || !covered || k->beside_border)
        return status;
    return tri_check_query(k->c, check_point(k->c, reached), TRI_CHECK_INPUT_SEGMENTS, id, l.tolerance);
}

static void check_markers(struct chains *k)
{
    struct checker *c = k->c;
    tri_check_begin(c, TRI_CHECK_MARKERS);
    for (int32_t s = 0; s < c->n_segments; s++) {
        if (!check_is_listed_well(c, s))
            continue;
        bool boundary = check_is_border(c, s);
        int32_t given = c->segment_markers[s], first = k->certain[s], own = k->possible[s];
        int32_t expected = first >= 0 ? c->input->segment_markers[first] : boundary;
        if (given == expected || (own >= 0 && (first < 0 || own < first)))
            continue;
        tri_check_fault(c, TRI_CHECK_MARKERS, "subsegment %ld (%ld-%ld) has marker %ld, expected %ld",
                        check_number(c, s), check_frame_vertex(c, c->segments[2 * s]),
                        check_frame_vertex(c, c->segments[2 * s + 1]), (long)given, (long)expected);
    }
}

static enum tri_status allocate(struct chains *k)
{
    struct checker *c = k->c;
    int32_t n = c->n_frame, n_segments = c->n_segments;
    k->seen = tri_check_zeros(n, sizeof *k->seen);
    k->via = tri_check_array(n, sizeof *k->via);
    k->stack = tri_check_array(2 * (int64_t)n_segments, sizeof *k->stack);
    k->forked = tri_check_zeros(n, sizeof *k->forked);
    k->certain = tri_check_array(n_segments, sizeof *k->certain);
    k->possible = tri_check_array(n_segments, sizeof *k->possible);
    c->is_along = tri_check_zeros(n_segments, 1);
    bool room = k->seen && k->via && k->stack && k->forked && k->certain && k->possible && c->is_along;
    return room ? TRI_OK : TRI_NO_MEMORY;
}

static void release(struct chains *k)
{
    free(k->seen);
    free(k->via);
    free(k->stack);
    free(k->forked);
    free(k->certain);
    free(k->possible);
    free(k->stop);
    free(k->place);
}

static enum tri_status check_lines(struct chains *k)
{
    struct checker *c = k->c;
    enum tri_status status = TRI_OK;
    for (int32_t s = 0; s < c->n_segments; s++)
        k->certain[s] = k->possible[s] = -1;
    for (int32_t id = 0; id < c->input->n_segments && status == TRI_OK; id++)
        status = check_line(k, id);
    return status;
}

enum tri_status tri_check_chains(struct checker *c)
{
    struct chains k = {.c = c};
    enum tri_status status = allocate(&k);
    if (status == TRI_OK)
        status = check_lines(&k);
    if (status == TRI_OK && c->segment_markers != NULL)
        check_markers(&k);
    release(&k);
    return status;
}
