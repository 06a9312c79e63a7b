/* No overlap: the boundary edges meet only at common end points, and wind 0 or 1 times around every point.
 *
 * A plane sweep after Shamos & Hoey 1976, by exact orientations. Events are the end points in lexicographic order:
 *   1. the edges of the order that pass through the event point are found by search; each must end there;
 *   2. they are removed, and the edges that start there inserted, sorted by direction;
 *   3. edges that have become neighbours must not meet before the earlier of their right ends;
 *   4. from bottom to top, edges must alternate: mesh above, mesh below, mesh above ... which says that the winding
 *      number is 0, 1, 0, 1 ... everywhere.
 * The leftmost point where two edges meet wrongly has two of them as neighbours just before, so 1 or 3 finds it.
 * Queries (is this point inside the mesh?) ride along as events. O(b log b).
 *
 * Faces outside the mesh: two edges with no mesh between them that become neighbours bound the same face, and so do the
 * lowest and the highest edge with the outer one. Faces are the classes of what that joins: between two events a face
 * is cut into gaps between neighbours, and a gap that goes on beyond an event, on either side of what starts or ends
 * there, keeps the edge below or above it, which has one side without mesh only. Each face but the outer one must have
 * been emptied for a hole point. */
#include <assert.h>
#include <stdlib.h>

#include "triangle/check/internal.h"
#include "triangle/check/order.h"

struct sweep_edge {
    struct tri_point left, right;
    int32_t half_edge;
    bool above; /* the mesh lies above */
};

enum { LEFT_END = 0, RIGHT_END = 1 };

struct event {
    struct tri_point at;
    int32_t code; /* 2 * edge + end, or ~number of a query */
};

struct sweep {
    struct checker *c;
    struct sweep_edge *edge;  /* [n_edges] */
    struct event *event;      /* [2 * n_edges + n_queries] */
    struct sweep_edge *start; /* [n_edges] work space: the edges that start at one event point ... */
    int32_t n_edges, n_events;
    struct check_order order;
    int32_t *face;    /* [n_edges + 1] a forest: an edge of the same face outside the mesh; n_edges: the outer face */
    uint8_t *emptied; /* [n_edges + 1] is there a hole point in the face? */
};

static int compare_events(const void *a, const void *b)
{
    const struct event *e = a, *f = b;
    int order = tri_compare_places(e->at, f->at);
    return order != 0 ? order : (e->code > f->code) - (e->code < f->code);
}

static double side(const struct sweep *w, int32_t s, struct tri_point p)
{
    return tri_orient2d(w->edge[s].left, w->edge[s].right, p);
}

/* Vertex at the given end of an edge. */
static int32_t vertex_at(const struct sweep *w, int32_t s, int end)
{
    int32_t h = w->edge[s].half_edge;
    return w->edge[s].above == (end == LEFT_END) ? check_org(w->c, h) : check_dest(w->c, h);
}

struct place {
    const struct sweep *sweep;
    struct tri_point at;
};

static bool is_below(const void *user, int32_t s)
{
    const struct place *place = user;
    return side(place->sweep, s, place->at) > 0;
}

/* The edge just below p, -1: none. */
static int32_t find_below(const struct sweep *w, struct tri_point p)
{
    struct place place = {w, p};
    return tri_check_order_find(&w->order, is_below, &place);
}

static bool fault(struct sweep *w, const char *what, int32_t s, int32_t r)
{
    struct checker *c = w->c;
    int32_t h = w->edge[s].half_edge, g = w->edge[r].half_edge;
    tri_check_fault(c, TRI_CHECK_OVERLAP, "boundary edges %ld-%ld of triangle %ld and %ld-%ld of triangle %ld: %s",
                    check_number(c, check_org(c, h)), check_number(c, check_dest(c, h)), check_number(c, h / 3),
                    check_number(c, check_org(c, g)), check_number(c, check_dest(c, g)), check_number(c, g / 3), what);
    return false;
}

/* The face outside the mesh beside edge s, -1: the outer one (Tarjan 1975, by halving). */
static int32_t face_of(struct sweep *w, int32_t s)
{
    for (s = s < 0 ? w->n_edges : s; w->face[s] != s; s = w->face[s])
        w->face[s] = w->face[w->face[s]];
    return s;
}

/* The lesser number is the root, but for the outer face. */
static void join_faces(struct sweep *w, int32_t a, int32_t b)
{
    int32_t f = face_of(w, a), g = face_of(w, b), last = f > g ? f : g, first = f + g - last;
    if (last == w->n_edges)
        w->face[first] = last;
    else
        w->face[last] = first;
}

/* Steps 3 and 4 for two neighbours, a below b; either may be -1. */
static bool neighbors_are_good(struct sweep *w, int32_t a, int32_t b)
{
    if (a >= 0 && b >= 0) {
        struct tri_point p = w->edge[a].right, q = w->edge[b].right;
        int order = tri_compare_places(p, q);
        if (order < 0 ? side(w, b, p) >= 0 : order > 0 && side(w, a, q) <= 0)
            return fault(w, "they meet", a, b);
    }
    bool meshed = a >= 0 && w->edge[a].above, wanted = b >= 0 && !w->edge[b].above;
    if (meshed == wanted) {
        if (!meshed)
            join_faces(w, a, b);
        return true;
    }
    return fault(w, "the mesh covers itself between them", a >= 0 ? a : b, b >= 0 ? b : a);
}

/* Steps 1 and 2, the edges that end at p. Leaves in *below the edge under p. */
static bool remove_ending(struct sweep *w, struct tri_point p, int32_t n_ending, int32_t witness, int32_t *below)
{
    *below = find_below(w, p);
    int32_t s = tri_check_order_above(&w->order, *below), n = 0;
    while (s >= 0 && side(w, s, p) == 0) {
        int32_t next = tri_check_order_above(&w->order, s);
        if (!check_same_place(w->edge[s].right, p))
            return fault(w, "a vertex of one lies inside the other", s, witness);
        tri_check_order_remove(&w->order, s);
        s = next;
        n++;
    }
    /* An edge that ends here but is not in its place crosses another one further left. */
    return n == n_ending || fault(w, "they meet, or one of them meets a third", witness, s >= 0 ? s : witness);
}

static int compare_directions(const void *a, const void *b)
{
    const struct sweep_edge *e = a, *f = b;
    double turn = tri_orient2d(e->left, e->right, f->right);
    return (turn < 0) - (turn > 0);
}

/* Steps 2, the edges that start at p, and 3 and 4. start[i].half_edge names an edge of the sweep here. */
static bool insert_starting(struct sweep *w, int32_t n, int32_t below)
{
    qsort(w->start, (size_t)n, sizeof *w->start, compare_directions);
    int32_t top = below;
    for (int32_t i = 0; i < n; i++) {
        int32_t s = w->start[i].half_edge;
        if (i > 0 && compare_directions(&w->start[i - 1], &w->start[i]) == 0) {
            return fault(w, "one runs along the other", top, s);
        }
        tri_check_order_insert(&w->order, s, top);
        top = s;
    }
    int32_t a = below;
    for (int32_t i = 0; i <= n; i++) {
        int32_t b = tri_check_order_above(&w->order, a);
        if (!neighbors_are_good(w, a, b))
            return false;
        a = b;
    }
    return true;
}

/* Within a distance of an edge's line? Not of edge -1. */
static bool is_near(const struct sweep *w, int32_t s, struct tri_point p, double distance)
{
    if (s < 0 || !(distance > 0))
        return false;
    struct tri_point a = w->edge[s].left, b = w->edge[s].right;
    double x = b.x - a.x, y = b.y - a.y, det = x * (p.y - a.y) - y * (p.x - a.x);
    return det * det <= distance * distance * (x * x + y * y);
}

/* On an edge, a lost vertex is as lost as inside; a hole or what is missing of a segment is where it should be. */
static void answer(struct sweep *w, int32_t number)
{
    struct check_query *q = &w->c->queries[number];
    int32_t below = find_below(w, q->at), s = tri_check_order_above(&w->order, below);
    bool on_edge = s >= 0 && side(w, s, q->at) == 0;
    q->inside = on_edge ? q->kind == TRI_CHECK_LOST_VERTICES : below >= 0 && w->edge[below].above;
    q->inside = q->inside && !is_near(w, below, q->at, q->tolerance) &&
                !is_near(w, s, q->at, q->tolerance);
    if (q->kind == TRI_CHECK_HOLES && !q->inside)
        w->emptied[below < 0 ? w->n_edges : below] = w->emptied[s < 0 ? w->n_edges : s] = 1;
}

/* A hole point at a vertex of the boundary is in every face there. */
static void empty_all(struct sweep *w, const struct event *event, int32_t n)
{
    bool is_hole = false;
    for (int32_t i = 0; i < n; i++)
        is_hole = is_hole || (event[i].code < 0 && w->c->queries[~event[i].code].kind == TRI_CHECK_HOLES);
    for (int32_t i = 0; is_hole && i < n; i++)
        if (event[i].code >= 0)
            w->emptied[event[i].code >> 1] = 1;
}

static bool coincide(struct sweep *w, int32_t v, int32_t u)
{
    tri_check_fault(w->c, TRI_CHECK_OVERLAP, "vertices %ld and %ld lie at the same place of the boundary",
                    check_number(w->c, v), check_number(w->c, u));
    return false;
}

/* One event point with everything that happens there. */
static bool process(struct sweep *w, const struct event *event, int32_t n)
{
    int32_t n_ending = 0, n_starting = 0, vertex = -1, witness = -1;
    for (int32_t i = 0; i < n; i++) {
        if (event[i].code < 0)
            continue;
        int32_t s = event[i].code >> 1;
        int end = event[i].code & 1;
        if (vertex >= 0 && vertex_at(w, s, end) != vertex)
            return coincide(w, vertex, vertex_at(w, s, end));
        vertex = vertex_at(w, s, end);
        witness = s;
        if (end == RIGHT_END) {
            n_ending++;
        } else {
            w->start[n_starting] = w->edge[s];
            w->start[n_starting++].half_edge = s;
        }
    }
    if (witness >= 0) { /* queries at a vertex of the boundary are not inside */
        int32_t below;
        empty_all(w, event, n);
        return remove_ending(w, event->at, n_ending, witness, &below) && insert_starting(w, n_starting, below);
    }
    for (int32_t i = 0; i < n; i++)
        answer(w, ~event[i].code);
    return true;
}

static void collect(struct sweep *w)
{
    struct checker *c = w->c;
    for (int32_t h = 0; h < c->n_half_edges; h++) {
        if (c->link[h] >= 0)
            continue;
        struct tri_point a = check_point(c, check_org(c, h)), b = check_point(c, check_dest(c, h));
        bool above = tri_compare_places(a, b) < 0; /* the mesh is on the left of the edge */
        int32_t s = w->n_edges++;
        w->edge[s] = above ? (struct sweep_edge){a, b, h, true} : (struct sweep_edge){b, a, h, false};
        w->event[w->n_events++] = (struct event){w->edge[s].left, 2 * s + LEFT_END};
        w->event[w->n_events++] = (struct event){w->edge[s].right, 2 * s + RIGHT_END};
    }
    for (int32_t i = 0; i < c->n_queries; i++) {
        w->event[w->n_events++] = (struct event){c->queries[i].at, ~i};
    }
}

/* Every face outside the mesh was emptied for a hole point, or is the outer one. */
static void check_faces(struct sweep *w)
{
    struct checker *c = w->c;
    tri_check_begin(c, TRI_CHECK_FACES);
    for (int32_t s = 0; s < w->n_edges; s++)
        if (w->emptied[s])
            w->emptied[face_of(w, s)] = 1;
    for (int32_t s = 0; s < w->n_edges; s++) {
        if (face_of(w, s) != s || w->emptied[s])
            continue;
        int32_t h = w->edge[s].half_edge;
        tri_check_fault(c, TRI_CHECK_FACES, "beside edge %ld-%ld of triangle %ld a face is empty without a hole point",
                        check_number(c, check_org(c, h)), check_number(c, check_dest(c, h)), check_number(c, h / 3));
    }
}

static void sweep(struct sweep *w)
{
    collect(w);
    for (int32_t s = 0; s <= w->n_edges; s++)
        w->face[s] = s;
    qsort(w->event, (size_t)w->n_events, sizeof *w->event, compare_events);
    for (int32_t i = 0, j; i < w->n_events; i = j) {
        for (j = i + 1; j < w->n_events && check_same_place(w->event[i].at, w->event[j].at); j++) {
        }
        if (!process(w, w->event + i, j - i))
            return;
    }
    assert(tri_check_order_above(&w->order, -1) == -1);
    const struct tri_check_options *o = w->c->options;
    if (w->c->input != NULL && !o->any_holes && !o->ignore_lost && o->border != TRI_CHECK_BORDER_ANY)
        check_faces(w);
}

enum tri_status tri_check_overlap(struct checker *c)
{
    int64_t n = c->report->n_boundary_edges, n_events = 2 * n + c->n_queries;
    if (n_events > INT32_MAX)
        return TRI_TOO_LARGE;
    struct sweep w = {.c = c};
    w.edge = tri_check_array(n, sizeof *w.edge);
    w.start = tri_check_array(n, sizeof *w.start);
    w.event = tri_check_array(n_events, sizeof *w.event);
    w.face = tri_check_array(n + 1, sizeof *w.face);
    w.emptied = tri_check_zeros(n + 1, 1);
    enum tri_status status = tri_check_order_init(&w.order, (int32_t)n);
    if (w.edge == NULL || w.start == NULL || w.event == NULL || w.face == NULL || w.emptied == NULL)
        status = TRI_NO_MEMORY;
    if (status == TRI_OK) {
        tri_check_begin(c, TRI_CHECK_OVERLAP);
        sweep(&w);
    }
    free(w.edge);
    free(w.start);
    free(w.event);
    free(w.face);
    free(w.emptied);
    tri_check_order_clear(&w.order);
    return status;
}
