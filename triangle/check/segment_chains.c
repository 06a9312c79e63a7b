/* Input segments as chains of subsegments.
 *
 *   1. From the first end of the input segment, depth first along subsegments whose far end lies on its line within
 *      the tolerance, not back and not beyond the end; the best aligned first. Each vertex is visited once per segment,
 *      for what can be reached from it does not depend on the way there. Where nearly coincident segments leave several
 *      ways, up to the first fork it is certain which subsegments the input segment runs along; the others it may run
 *      along, and their markers are right if some choice makes them so.
 *   2. Should the second end not be reached, pieces may have been carved. Then all subsegment vertices on the line are
 *      fetched from a grid and sorted along it; chains are followed from each that lies beyond what is covered so far.
 *   3. Whatever stays uncovered must lie outside the mesh: the sweep is asked about points of it. If nothing does, and
 *      no chain leads from end to end, a piece is missing beside others within rounding of it. It may have been carved
 *      where one of these bounds the mesh; else it should be there.
 *   4. Where input segments overlap so much that this would take too long, what lies along one line is put in order
 *      (tube.h). An input segment that is covered there by a way from end to end may run along all that lies
 *      between its ends within the tolerance, whether a search would have come there or not. */
#include "triangle/check/segment_chains.h"

#include <math.h>
#include <stdlib.h>

#include "triangle/base/grow.h"
#include "triangle/check/tube.h"
#include "triangle/geometry/predicates.h"

enum { MAX_GRID_SIDE = 2048, HUB = 16, MOST_PASSES = 16 };

struct line { /* the input segment in question */
    int32_t id, marker;
    struct tri_point a, b;
    double dx, dy, length, tolerance;
};

struct stop {  /* a vertex on the line */
    double at; /* distance from a, along the line */
    int32_t vertex;
};

struct grid { /* vertices of subsegments by place; made when first needed */
    struct tri_point low;
    double width, height; /* of a cell */
    int32_t side;         /* cells in a row, and in a column; 0: not made yet */
    int32_t *first, *vertex;
};

struct chains {
    struct checker *c;
    uint32_t search;   /* number of the current search */
    uint32_t *seen;    /* [n_points] last search that visited the vertex, 0: none */
    int32_t *via;      /* [n_points] fan entry by which it came there, -1: it began there */
    uint32_t *forked;  /* [n_points] last search that found several ways on from there */
    int32_t *stack;    /* [2 * n_segments + 1] each subsegment is pushed once from each end at most */
    int32_t *certain;  /* [n_segments] first input segment with a marker that runs along the subsegment, -1: none */
    int32_t *possible; /* [n_segments] first one with the subsegment's own marker that may run along it, -1: none */
    bool beside_border; /* does the mesh end at a subsegment along the input segment in question? */
    int64_t n_steps;   /* of searches */
    struct check_tubes tubes;
    struct stop *stop; /* [n_points at most] */
    int32_t n_stops, stop_capacity;
    struct grid grid;
};

struct line_in_chains {
    struct chains *k;
    const struct line *l;
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

/* Pushes the ways on from vertex u, the best aligned on top. Backwards by less than the tolerance counts as on. */
static int32_t push_ways(struct chains *k, const struct line *l, int32_t u, int32_t top)
{
    const struct checker *c = k->c;
    struct tri_point from = check_point(c, u);
    double best = INFINITY;
    int ways = 0;
    k->n_steps++;
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

/* Step 1: from vertex u towards `goal`, along all ways that there are; returns it, or the vertex furthest on if it is
 * out of reach. */
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

/* Exactly on the input segment? */
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

/* Does a step of the chain that leads to u lead no farther on than the tolerance? Then it may lead over to another
 * input segment's vertices, and past a piece that was carved. */
static bool has_side_step(const struct chains *k, const struct line *l, int32_t u)
{
    const struct checker *c = k->c;
    for (; k->via[u] >= 0; u = c->segments[k->via[u]])
        if (along(l, check_point(c, u)) - along(l, check_point(c, c->segments[k->via[u]])) <= l->tolerance)
            return true;
    return false;
}

/* The input segment runs along the chain by which the search came to u: for certain up to the first fork, or, where
 * that the chain is its own is a guess, where the chain is exactly on its line. */
static void mark(struct chains *k, const struct line *l, int32_t u, bool whole)
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

static int32_t cell_index(double x, double low, double width, int32_t side)
{
    double i = width > 0 ? floor((x - low) / width) : 0;
    return i < 0 ? 0 : i >= side ? side - 1 : (int32_t)i;
}

static size_t cell_of(const struct grid *g, struct tri_point p)
{
    return (size_t)cell_index(p.x, g->low.x, g->width, g->side) * (size_t)g->side +
           (size_t)cell_index(p.y, g->low.y, g->height, g->side);
}

static bool has_subsegment(const struct checker *c, int32_t v)
{
    return c->fan_first[v] < c->fan_first[v + 1];
}

/* Bounding box of the vertices of subsegments; returns how many there are. */
static int32_t measure(const struct checker *c, struct tri_point *low, struct tri_point *high)
{
    int32_t n = 0;
    *low = (struct tri_point){INFINITY, INFINITY};
    *high = (struct tri_point){-INFINITY, -INFINITY};
    for (int32_t v = 0; v < c->n_frame; v++) {
        if (!has_subsegment(c, v))
            continue;
        struct tri_point p = check_point(c, v);
        *low = (struct tri_point){fmin(low->x, p.x), fmin(low->y, p.y)};
        *high = (struct tri_point){fmax(high->x, p.x), fmax(high->y, p.y)};
        n++;
    }
    return n;
}

static enum tri_status make_grid(struct chains *k)
{
    const struct checker *c = k->c;
    struct grid *g = &k->grid;
    struct tri_point high;
    int32_t n = measure(c, &g->low, &high);
    g->side = 1 + (int32_t)fmin(MAX_GRID_SIDE - 1, sqrt(n));
    g->width = n > 0 ? (high.x - g->low.x) / g->side : 0;
    g->height = n > 0 ? (high.y - g->low.y) / g->side : 0;
    size_t n_cells = (size_t)g->side * (size_t)g->side;
    g->first = tri_check_zeros((int64_t)n_cells + 1, sizeof *g->first);
    g->vertex = tri_check_array(n, sizeof *g->vertex);
    if (g->first == NULL || g->vertex == NULL)
        return TRI_NO_MEMORY;
    for (int32_t v = 0; v < c->n_frame; v++) {
        if (has_subsegment(c, v))
            g->first[cell_of(g, check_point(c, v)) + 1]++;
    }
    for (size_t i = 0; i < n_cells; i++)
        g->first[i + 1] += g->first[i];
    for (int32_t v = 0; v < c->n_frame; v++) {
        if (has_subsegment(c, v))
            g->vertex[g->first[cell_of(g, check_point(c, v))]++] = v;
    }
    for (size_t i = n_cells; i > 0; i--)
        g->first[i] = g->first[i - 1];
    g->first[0] = 0;
    return TRI_OK;
}

static enum tri_status add_stop(struct chains *k, double at, int32_t v)
{
    if (!tri_grow(&k->stop, &k->stop_capacity, k->n_stops + 1, sizeof *k->stop))
        return TRI_NO_MEMORY;
    k->stop[k->n_stops++] = (struct stop){at, v};
    return TRI_OK;
}

static enum tri_status add_stops_of_cell(struct chains *k, const struct line *l, size_t cell)
{
    enum tri_status status = TRI_OK;
    for (int32_t i = k->grid.first[cell]; i < k->grid.first[cell + 1] && status == TRI_OK; i++) {
        struct tri_point p = check_point(k->c, k->grid.vertex[i]);
        if (is_on(l, p))
            status = add_stop(k, along(l, p), k->grid.vertex[i]);
    }
    return status;
}

static double clamp(double x, double low, double high)
{
    return x < low ? low : x > high ? high : x;
}

/* Rows that the line passes in a column of the grid, with a margin for rounding. */
static void rows_of(const struct chains *k, const struct line *l, int32_t column, int32_t *from, int32_t *to)
{
    const struct grid *g = &k->grid;
    double margin = l->tolerance + 1e-9 * g->height, slope = l->dy / l->dx, y[2] = {l->a.y, l->b.y};
    for (int i = 0; i < 2 && fabs(l->dx) > g->width * 1e-3; i++) {
        double x = g->low.x + (column + i) * g->width + (2 * i - 1) * (l->tolerance + 1e-9 * g->width);
        y[i] = clamp(l->a.y + (x - l->a.x) * slope, fmin(l->a.y, l->b.y), fmax(l->a.y, l->b.y));
    }
    *from = cell_index(fmin(y[0], y[1]) - margin, g->low.y, g->height, g->side);
    *to = cell_index(fmax(y[0], y[1]) + margin, g->low.y, g->height, g->side);
}

static int compare_stops(const void *a, const void *b)
{
    const struct stop *s = a, *t = b;
    if (s->at != t->at)
        return s->at < t->at ? -1 : 1;
    return (s->vertex > t->vertex) - (s->vertex < t->vertex);
}

/* Step 2, the vertices on the line. */
static enum tri_status find_stops(struct chains *k, const struct line *l)
{
    const struct grid *g = &k->grid;
    enum tri_status status = g->side == 0 ? make_grid(k) : TRI_OK;
    double margin = l->tolerance + 1e-9 * g->width;
    int32_t left = cell_index(fmin(l->a.x, l->b.x) - margin, g->low.x, g->width, g->side);
    int32_t right = cell_index(fmax(l->a.x, l->b.x) + margin, g->low.x, g->width, g->side);
    k->n_stops = 0;
    for (int32_t i = left; i <= right && status == TRI_OK; i++) {
        int32_t from, to;
        rows_of(k, l, i, &from, &to);
        for (int32_t j = from; j <= to && status == TRI_OK; j++) {
            status = add_stops_of_cell(k, l, (size_t)i * (size_t)g->side + (size_t)j);
        }
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

/* Step 3. Pieces as short as the tolerance are beneath notice; pieces whose ends are not surely on the segment close no
 * face (overlap.c). */
static enum tri_status ask_about(struct chains *k, const struct line *l, struct tri_point begin, struct tri_point end)
{
    double from = along(l, begin), to = along(l, end);
    bool sure = check_surely_meets(l->a, l->b, begin) && check_surely_meets(l->a, l->b, end);
    enum tri_status status = sure ? note_missing(k->c, begin, end) : TRI_OK;
    if (to - from <= 4 * l->tolerance)
        return status;
    for (int i = 1; i <= 3 && status == TRI_OK; i++) {
        double s = (from + (to - from) * i / 4) / l->length;
        struct tri_point p = {l->a.x + s * l->dx, l->a.y + s * l->dy};
        status = tri_check_ask(k->c, p, TRI_CHECK_INPUT_SEGMENTS, l->id, l->tolerance);
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
            status = ask_about(k, l, covered, check_point(k->c, s.vertex));
        int32_t end = follow(k, l, s.vertex, -1);
        mark(k, l, end, false);
        if (along(l, check_point(k->c, end)) >= along(l, covered))
            covered = check_point(k->c, end);
    }
    return status == TRI_OK ? ask_about(k, l, covered, l->b) : status;
}

static bool names_points(const struct tri_pslg *input, int32_t id)
{
    const int32_t *ends = input->segments + 2 * (size_t)id;
    return ends[0] >= 0 && ends[0] < input->n_points && ends[1] >= 0 && ends[1] < input->n_points;
}

/* Do many subsegments end at this input point? */
static bool is_hub(const struct checker *c, int32_t point)
{
    int32_t v = c->twin[point];
    return v >= 0 && c->fan_first[v + 1] - c->fan_first[v] > HUB;
}

static void take_any(void *chains, int32_t subsegment)
{
    struct chains *k = chains;
    k->c->is_along[subsegment] = 1;
}

static void take_own(void *line_in_chains, int32_t subsegment)
{
    struct line_in_chains *u = line_in_chains;
    may_run_along(u->k, u->l, subsegment);
}

/* Step 4: up (1) or down (0) from vertex v, as far as there is one way. What is certain already is passed over. */
static void mark_in_tube(struct chains *k, const struct line *l, const struct check_span *span, int32_t v, int up)
{
    struct check_tube_entry *entry = k->tubes.entry;
    int32_t i = tri_check_tube_sole_way(&k->tubes, span->tube, v, up);
    while (i >= 0 && entry[i].low >= span->low && entry[i].high <= span->high) {
        int32_t *certain = &k->certain[entry[i].subsegment], *onward = &entry[i].onward[up];
        *certain = *certain < 0 ? l->id : *certain;
        if (*onward >= 0 && k->certain[entry[*onward].subsegment] >= 0)
            *onward = entry[*onward].onward[up];
        i = *onward;
    }
}

static bool take_from_tube(struct chains *k, const struct line *l, int32_t from, int32_t to)
{
    const int32_t ends[2] = {from, to};
    struct line_in_chains in_chains = {k, l};
    struct check_span span;
    if (!tri_check_tube_span(&k->tubes, l->id, ends, l->tolerance, &span))
        return false;
    tri_check_tube_take(&k->tubes, &span, NULL, take_any, k);
    if (l->marker == 0)
        return true;
    if (k->c->segment_markers != NULL)
        tri_check_tube_take(&k->tubes, &span, &l->marker, take_own, &in_chains);
    mark_in_tube(k, l, &span, from, tri_check_tube_ascends(&k->tubes, span.tube, from, to));
    return true;
}

static enum tri_status check_line(struct chains *k, int32_t id)
{
    const struct tri_pslg *input = k->c->input;
    int32_t a = input->segments[2 * (size_t)id], b = input->segments[2 * (size_t)id + 1];
    if (!names_points(input, id))
        return TRI_OK; /* skipped by the mesher, too */
    if (is_hub(k->c, a) && !is_hub(k->c, b)) { /* at the end of a search, ways on are not looked at */
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
    if (from >= 0 && to >= 0 && take_from_tube(k, &l, from, to))
        return TRI_OK;
    k->search++;
    k->beside_border = false;
    int32_t reached = from >= 0 && to >= 0 ? follow(k, &l, from, to) : -1;
    if (reached >= 0 && reached == to) {
        mark(k, &l, to, true);
        return TRI_OK;
    }
    const int64_t n_asked = (int64_t)k->c->n_queries + k->c->n_missing;
    enum tri_status status = cover(k, &l);
    const bool covered = n_asked == (int64_t)k->c->n_queries + k->c->n_missing;
    if (status != TRI_OK || reached < 0 || !covered || k->beside_border)
        return status;
    return tri_check_ask(k->c, check_point(k->c, reached), TRI_CHECK_INPUT_SEGMENTS, id, l.tolerance);
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
    free(k->grid.first);
    free(k->grid.vertex);
    tri_check_tubes_free(&k->tubes);
}

/* Have searches passed the same places again and again? */
static bool is_slow(const struct chains *k)
{
    const struct checker *c = k->c;
    return k->n_steps / MOST_PASSES > (int64_t)c->n_frame + c->n_segments + c->input->n_segments;
}

static enum tri_status check_lines(struct chains *k)
{
    struct checker *c = k->c;
    enum tri_status status = TRI_OK;
    for (int32_t s = 0; s < c->n_segments; s++)
        k->certain[s] = k->possible[s] = -1;
    for (int32_t id = 0; id < c->input->n_segments && status == TRI_OK; id++) {
        if (k->tubes.of_line == NULL && is_slow(k))
            status = tri_check_tubes_make(&k->tubes, c, id);
        if (status == TRI_OK)
            status = check_line(k, id);
    }
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
