/* No overlap: boundary edges meet only at common end points, and wind 0 or 1 times around every point.
 *
 * A plane sweep (Shamos & Hoey 1976) with exact orientations. Events are the end points in lexicographic order:
 *   1. the edges in the sweep order that pass through the event point are found by search; each must end there;
 *   2. they are removed, and the edges that start there are inserted, sorted by direction;
 *   3. edges that have become neighbours must not meet before the earlier of their right ends;
 *   4. from bottom to top, edges must alternate (mesh above, mesh below, mesh above, ...), so winding numbers are 0
 *      or 1.
 * THEOREM. At the leftmost wrong meeting point, two of the edges were neighbours just before, so step 1 or 3 finds
 * it. Queries (is this point inside the mesh?) are additional events. O(b log b).
 * FACES (docs/theory.md, the judge). Each face outside the mesh, except the outer one, must contain a hole point. A
 * second sweep includes missing pieces of segments and inner subsegments. It is skipped if rounding of the pieces
 * makes it fail. */
#include <assert.h>
#include <stdlib.h>

#include "triangle/base/order.h"
#include "triangle/check/internal.h"

struct sweep_edge {
    struct tri_point left, right;
    int32_t vertex[2]; /* vertices at the left and right end; -1: a point where missing pieces meet */
    int64_t side[2];   /* half-edge of the triangle below and above; -1: no mesh there */
    double attribute[2]; /* region attributes of these triangles */
};

enum { LEFT_END = 0, RIGHT_END = 1, BELOW = 0, ABOVE = 1 };

struct event {
    struct tri_point at;
    int32_t code; /* 2 * edge + end, or ~number of a query */
};

struct start { /* an edge that starts at the event point */
    struct tri_point left, right;
    int32_t edge;
};

struct sweep {
    struct checker *c;
    bool again;               /* true: this is the second sweep, for faces */
    struct sweep_edge *edge;  /* [n_edges] */
    struct event *event;      /* [2 * n_edges + n_queries] */
    struct start *start;      /* [n_edges] work space */
    int32_t n_edges, n_events;
    struct tri_order order;
    /* For each side (2 * edge + BELOW or ABOVE) and, at index 2 * n_edges, for the outer face: */
    int32_t *face;    /* union-find forest: another side of the same face */
    uint8_t *emptied; /* 1: there is a hole point in the face */
    uint8_t *vague;   /* 1: a region point may be in the face, within rounding */
    int32_t *region;  /* last region whose point is in the face, -1: none */
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

static bool is_meshed(const struct sweep *w, int32_t s, int side)
{
    return s >= 0 && w->edge[s].side[side] >= 0;
}

/* The half-edge and triangle of an edge that is not a missing piece, for messages. */
struct named {
    long from, to, triangle;
};

static struct named name(const struct sweep *w, int32_t s)
{
    const struct sweep_edge *e = &w->edge[s];
    int side = e->side[ABOVE] >= 0 ? ABOVE : BELOW, from = side == ABOVE ? LEFT_END : RIGHT_END;
    return (struct named){check_frame_vertex(w->c, e->vertex[from]), check_frame_vertex(w->c, e->vertex[1 - from]),
                          check_number(w->c, e->side[side] / 3)};
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

/* Returns the edge just below p, or -1. */
static int32_t find_below(const struct sweep *w, struct tri_point p)
{
    struct place place = {w, p};
    return tri_order_find(&w->order, is_below, &place);
}

static bool fault(struct sweep *w, const char *what, int32_t s, int32_t r)
{
    struct checker *c = w->c;
    if (w->again)
        return false;
    struct named n = name(w, s), m = name(w, r);
    tri_check_fault(c, TRI_CHECK_OVERLAP, "boundary edges %ld-%ld of triangle %ld and %ld-%ld of triangle %ld: %s",
                    n.from, n.to, n.triangle, m.from, m.to, m.triangle, what);
    return false;
}

/* Returns the face on a side of edge s (-1: the outer face), by union-find with path halving (Tarjan 1975). */
static int32_t face_of(struct sweep *w, int32_t s, int side)
{
    int32_t f = s < 0 ? 2 * w->n_edges : 2 * s + side;
    for (; w->face[f] != f; f = w->face[f])
        w->face[f] = w->face[w->face[f]];
    return f;
}

/* Joins the face above a with the face below b. The smaller number becomes the root, except that the outer face is
 * always a root. */
static void join_faces(struct sweep *w, int32_t a, int32_t b)
{
    int32_t f = face_of(w, a, ABOVE), g = face_of(w, b, BELOW), last = f > g ? f : g, first = f + g - last;
    if (last == 2 * w->n_edges)
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
    if (is_meshed(w, a, ABOVE) == is_meshed(w, b, BELOW)) {
        join_faces(w, a, b);
        return true;
    }
    return fault(w, "the mesh covers itself between them", a >= 0 ? a : b, b >= 0 ? b : a);
}

/* Steps 1 and 2 for the edges that end at p. Sets *below to the edge below p. */
static bool remove_ending(struct sweep *w, struct tri_point p, int32_t n_ending, int32_t witness, int32_t *below)
{
    *below = find_below(w, p);
    int32_t s = tri_order_above(&w->order, *below), n = 0;
    while (s >= 0 && side(w, s, p) == 0) {
        int32_t next = tri_order_above(&w->order, s);
        if (!check_same_place(w->edge[s].right, p))
            return fault(w, "a vertex of one lies inside the other", s, witness);
        tri_order_remove(&w->order, s);
        s = next;
        n++;
    }
    /* An edge that should end here but is not in its place crosses another edge farther left. */
    return n == n_ending || fault(w, "they meet, or one of them meets a third", witness, s >= 0 ? s : witness);
}

static int compare_directions(const void *a, const void *b)
{
    const struct start *e = a, *f = b;
    double turn = tri_orient2d(e->left, e->right, f->right);
    return (turn < 0) - (turn > 0);
}

/* Step 2 for the edges that start at p, then steps 3 and 4. */
static bool insert_starting(struct sweep *w, int32_t n, int32_t below)
{
    qsort(w->start, (size_t)n, sizeof *w->start, compare_directions);
    int32_t top = below;
    for (int32_t i = 0; i < n; i++) {
        int32_t s = w->start[i].edge;
        if (i > 0 && compare_directions(&w->start[i - 1], &w->start[i]) == 0) {
            return fault(w, "one runs along the other", top, s);
        }
        tri_order_insert(&w->order, s, top);
        top = s;
    }
    int32_t a = below;
    for (int32_t i = 0; i <= n; i++) {
        int32_t b = tri_order_above(&w->order, a);
        if (!neighbors_are_good(w, a, b))
            return false;
        a = b;
    }
    return true;
}

/* Is p within this distance of the line of edge s? False if s is -1. */
static bool is_near(const struct sweep *w, int32_t s, struct tri_point p, double distance)
{
    if (s < 0 || !(distance > 0))
        return false;
    struct tri_point a = w->edge[s].left, b = w->edge[s].right;
    double x = b.x - a.x, y = b.y - a.y, det = x * (p.y - a.y) - y * (p.x - a.x);
    return det * det <= distance * distance * (x * x + y * y);
}

/* Notes that the point of a hole or region is on this side of edge s (-1: in the outer face). A hole point on an
 * inner subsegment need not empty a face. */
static void note_point(struct sweep *w, struct check_query *q, int32_t s, int side, bool vague)
{
    int32_t f = s < 0 ? 2 * w->n_edges : 2 * s + side;
    if (q->kind == TRI_CHECK_HOLES) {
        w->emptied[f] = 1;
        q->inside = q->inside && !vague;
    } else if (q->kind == TRI_CHECK_REGIONS && vague) {
        w->vague[f] = 1;
    } else if (q->kind == TRI_CHECK_REGIONS && q->id > w->region[f]) {
        w->region[f] = q->id;
    }
}

/* Answers a query. On an edge, a lost vertex counts as inside, but a hole point or a point of a missing piece does
 * not. Within rounding of an edge, a point may be on either side. */
static void answer(struct sweep *w, int32_t number)
{
    struct check_query *q = &w->c->queries[number];
    int32_t below = find_below(w, q->at), s = tri_order_above(&w->order, below);
    bool on_edge = s >= 0 && side(w, s, q->at) == 0;
    bool near_below = is_near(w, below, q->at, q->tolerance), near_above = is_near(w, s, q->at, q->tolerance);
    bool inside = on_edge ? q->kind == TRI_CHECK_LOST_VERTICES : is_meshed(w, below, ABOVE);
    if (!w->again)
        q->inside = inside && !near_below && !near_above;
    bool vague = on_edge || near_below || near_above;
    note_point(w, q, below, ABOVE, vague);
    if (near_below)
        note_point(w, q, below, BELOW, vague);
    if (on_edge || near_above)
        note_point(w, q, s, ABOVE, vague);
}

/* Notes queries at a vertex: such a point is in every face there and, within rounding of edges that pass it, beyond
 * these edges. The edges that end at the vertex have already left the sweep order, and those that start there are
 * not yet in it. */
static void note_all(struct sweep *w, const struct event *event, int32_t n, int32_t below)
{
    int32_t above = tri_order_above(&w->order, below);
    for (int32_t i = 0; i < n; i++) {
        if (event[i].code >= 0)
            continue;
        struct check_query *q = &w->c->queries[~event[i].code];
        for (int32_t j = 0; j < n; j++) {
            for (int side = 0; event[j].code >= 0 && side < 2; side++)
                note_point(w, q, event[j].code >> 1, side, true);
        }
        if (is_near(w, below, q->at, q->tolerance))
            note_point(w, q, below, BELOW, true);
        if (is_near(w, above, q->at, q->tolerance))
            note_point(w, q, above, ABOVE, true);
    }
}

static bool coincide(struct sweep *w, int32_t v, int32_t u)
{
    if (w->again)
        return false;
    tri_check_fault(w->c, TRI_CHECK_OVERLAP, "vertices %ld and %ld lie at the same place of the boundary",
                    check_frame_vertex(w->c, v), check_frame_vertex(w->c, u));
    return false;
}

/* Processes all events at one point. */
static bool process(struct sweep *w, const struct event *event, int32_t n)
{
    int32_t n_ending = 0, n_starting = 0, vertex = -1, witness = -1;
    for (int32_t i = 0; i < n; i++) {
        if (event[i].code < 0)
            continue;
        int32_t s = event[i].code >> 1;
        int end = event[i].code & 1;
        int32_t v = w->edge[s].vertex[end];
        if (vertex >= 0 && v >= 0 && v != vertex)
            return coincide(w, vertex, v);
        vertex = v >= 0 ? v : vertex;
        witness = s;
        if (end == RIGHT_END)
            n_ending++;
        else
            w->start[n_starting++] = (struct start){w->edge[s].left, w->edge[s].right, s};
    }
    if (witness >= 0) { /* queries at a boundary vertex are not inside */
        int32_t below;
        if (!remove_ending(w, event->at, n_ending, witness, &below))
            return false;
        note_all(w, event, n, below);
        return insert_starting(w, n_starting, below);
    }
    for (int32_t i = 0; i < n; i++)
        answer(w, ~event[i].code);
    return true;
}

/* Adds the edge from a to b, with the data on its left and right. */
static void add_edge(struct sweep *w, struct tri_point a, struct tri_point b, int32_t u, int32_t v,
                     struct check_side left, struct check_side right)
{
    int32_t s = w->n_edges++;
    bool ascends = tri_compare_places(a, b) < 0; /* then the left side is above */
    struct check_side below = ascends ? right : left, above = ascends ? left : right;
    w->edge[s] = (struct sweep_edge){ascends ? a : b, ascends ? b : a, {ascends ? u : v, ascends ? v : u},
                                     {below.half_edge, above.half_edge}, {below.attribute, above.attribute}};
    w->event[w->n_events++] = (struct event){w->edge[s].left, 2 * s + LEFT_END};
    w->event[w->n_events++] = (struct event){w->edge[s].right, 2 * s + RIGHT_END};
}

static void add_between(struct sweep *w, const int32_t *ends, struct check_side left, struct check_side right)
{
    add_edge(w, check_point(w->c, ends[0]), check_point(w->c, ends[1]), ends[0], ends[1], left, right);
}

static void collect(struct sweep *w, const struct check_pieces *missing)
{
    static const struct check_side none = {-1, 0};
    const struct checker *c = w->c;
    for (int32_t i = 0; i < c->boundary.n; i++)
        add_between(w, c->border[i],
                    (struct check_side){c->boundary.at[i].half_edge, c->boundary.at[i].attribute}, none);
    for (int32_t s = 0; w->again && s < c->n_segments; s++) {
        if (c->sides[s][0].half_edge >= 0 && c->sides[s][1].half_edge >= 0)
            add_between(w, c->segments + 2 * s, c->sides[s][0], c->sides[s][1]);
    }
    for (int32_t i = 0; i < missing->n; i++)
        add_edge(w, missing->at[i].from, missing->at[i].to, -1, -1, none, none);
    for (int32_t i = 0; i < c->n_queries; i++)
        w->event[w->n_events++] = (struct event){c->queries[i].at, ~i};
    for (int32_t f = 0; f <= 2 * w->n_edges; f++) {
        w->face[f] = f;
        w->region[f] = -1;
    }
}

static enum tri_status init(struct sweep *w, int64_t n)
{
    int64_t n_events = 2 * n + w->c->n_queries;
    if (n_events >= INT32_MAX)
        return TRI_TOO_LARGE;
    w->edge = tri_check_array(n, sizeof *w->edge);
    w->start = tri_check_array(n, sizeof *w->start);
    w->event = tri_check_array(n_events, sizeof *w->event);
    w->face = tri_check_array(2 * n + 1, sizeof *w->face);
    w->emptied = tri_check_zeros(2 * n + 1, 1);
    w->vague = tri_check_zeros(2 * n + 1, 1);
    w->region = tri_check_array(2 * n + 1, sizeof *w->region);
    bool room = w->edge && w->start && w->event && w->face && w->emptied && w->vague && w->region;
    return room ? tri_order_init(&w->order, (int32_t)n) : TRI_NO_MEMORY;
}

static void clear(struct sweep *w)
{
    free(w->edge);
    free(w->start);
    free(w->event);
    free(w->face);
    free(w->emptied);
    free(w->vague);
    free(w->region);
    tri_order_clear(&w->order);
}

/* Runs the sweep. Returns false if it found a fault. */
static bool run(struct sweep *w)
{
    qsort(w->event, (size_t)w->n_events, sizeof *w->event, compare_events);
    for (int32_t i = 0, j; i < w->n_events; i = j) {
        for (j = i + 1; j < w->n_events && check_same_place(w->event[i].at, w->event[j].at); j++) {
        }
        if (!process(w, w->event + i, j - i))
            return false;
    }
    assert(tri_order_above(&w->order, -1) == -1);
    return true;
}

/* Combines the marks of all sides of a face. */
static void gather_marks(struct sweep *w)
{
    for (int32_t f = 0; f < 2 * w->n_edges; f++) {
        int32_t root = face_of(w, f / 2, f % 2);
        w->emptied[root] |= w->emptied[f];
        w->vague[root] |= w->vague[f];
        w->region[root] = w->region[f] > w->region[root] ? w->region[f] : w->region[root];
    }
}

/* Computes twice the area of each face, with root f in area[f], minus TOLERANCES times its perimeter. Thinner faces
 * may be caused by rounding, between missing pieces that nearly coincide. */
static void measure_faces(struct sweep *w, double *area)
{
    const double TOLERANCES = 16;
    for (int32_t f = 0; f < 2 * w->n_edges; f++) {
        struct tri_point a = w->edge[f / 2].left, b = w->edge[f / 2].right, o = w->edge[0].left;
        double width = b.x - a.x, twice = width * (a.y - o.y + (b.y - o.y)); /* twice the area between the edge and
                                                                                the height of o */
        area[face_of(w, f / 2, f % 2)] +=
            (f % 2 == BELOW ? twice : -twice) - TOLERANCES * w->c->tolerance * hypot(width, b.y - a.y);
    }
}

/* Reports faces bounded only by missing pieces: whole parts of the mesh that are missing. */
static enum tri_status check_lost_faces(struct sweep *w)
{
    struct checker *c = w->c;
    double *area = tri_check_zeros(2 * (int64_t)w->n_edges + 1, sizeof *area);
    if (area == NULL)
        return TRI_NO_MEMORY;
    measure_faces(w, area);
    for (int32_t f = 0; f < 2 * w->n_edges; f++) {
        const struct sweep_edge *e = &w->edge[f / 2];
        int32_t root = face_of(w, f / 2, f % 2);
        if (w->emptied[root] || root == 2 * w->n_edges || is_meshed(w, f / 2, f % 2) || !(area[root] > 0))
            continue;
        w->emptied[root] = 1;
        tri_check_fault(c, TRI_CHECK_FACES,
                        "beside the input's segment from (%.17g, %.17g) to (%.17g, %.17g) a face is empty without a "
                        "hole point", check_given(c, e->left.x), check_given(c, e->left.y),
                        check_given(c, e->right.x), check_given(c, e->right.y));
    }
    free(area);
    return TRI_OK;
}

/* Every face outside the mesh must contain a hole point or be the outer one. */
static enum tri_status check_faces(struct sweep *w)
{
    struct checker *c = w->c;
    tri_check_begin(c, TRI_CHECK_FACES);
    for (int32_t f = 0; f < 2 * w->n_edges; f++) { /* reported at an edge with mesh on its other side */
        int32_t s = f / 2, root = face_of(w, s, f % 2);
        if (w->emptied[root] || root == 2 * w->n_edges || is_meshed(w, s, f % 2) || !is_meshed(w, s, 1 - f % 2))
            continue;
        struct named n = name(w, s);
        w->emptied[root] = 1;
        tri_check_fault(c, TRI_CHECK_FACES, "beside edge %ld-%ld of triangle %ld a face is empty without a hole point",
                        n.from, n.to, n.triangle);
    }
    return check_lost_faces(w);
}

/* The triangles of each face must have the attribute of the last region whose point lies in the face. That all
 * triangles of a face have the same attribute is tested in pairs.c. */
static void check_regions(struct sweep *w)
{
    struct checker *c = w->c;
    for (int32_t f = 0; f < 2 * w->n_edges; f++) {
        int32_t s = f / 2, root = face_of(w, s, f % 2);
        if (!is_meshed(w, s, f % 2) || w->vague[root])
            continue;
        int64_t t = w->edge[s].side[f % 2] / 3;
        int32_t k = w->region[root];
        double given = w->edge[s].attribute[f % 2], expected = k < 0 ? 0 : c->input->regions[4 * (size_t)k + 2];
        w->vague[root] = 1;
        if (given != expected)
            tri_check_fault(c, TRI_CHECK_REGIONS, "triangle %ld has attribute %.17g, expected %.17g",
                            check_number(c, t), given, expected);
    }
}

static bool faces_count(const struct checker *c)
{
    const struct tri_check_options *o = c->options;
    return c->input != NULL && !o->any_holes && !o->ignore_lost && o->border != TRI_CHECK_BORDER_ANY;
}

/* Runs one sweep and, if it is the last one, checks the faces. *good: it found no fault. */
static enum tri_status sweep(struct checker *c, const struct check_pieces *missing, bool again, bool last, bool *good)
{
    struct sweep w = {.c = c, .again = again};
    enum tri_status status =
        init(&w, c->boundary.n + missing->n + (again ? (int64_t)c->n_segments : 0));
    if (status == TRI_OK) {
        collect(&w, missing);
        *good = run(&w);
        gather_marks(&w);
        if (*good && last && faces_count(c))
            status = check_faces(&w);
        if (status == TRI_OK && *good && again && check_good(c, TRI_CHECK_REGIONS))
            check_regions(&w);
    }
    clear(&w);
    return status;
}

static bool has_hole_inside(const struct checker *c)
{
    bool found = false;
    for (int32_t i = 0; i < c->n_queries; i++)
        found = found || (c->queries[i].kind == TRI_CHECK_HOLES && c->queries[i].inside);
    return found;
}

/* Lists the missing pieces, cut where they meet. First sweeps them alone. If they meet only at their ends, as they
 * usually do, they need no cuts. */
static enum tri_status list_missing(struct checker *c, struct check_pieces *missing)
{
    struct checker alone = *c;
    bool good = false;
    alone.boundary.n = alone.n_segments = alone.n_queries = 0;
    tri_check_sort_missing(c);
    const struct check_pieces whole = {c->n_missing, c->missing};
    enum tri_status status = whole.n > 0 ? sweep(&alone, &whole, true, false, &good) : TRI_OK;
    if (status == TRI_OK && !good)
        return tri_check_split_missing(c, missing);
    if (status == TRI_OK) { /* *missing takes ownership of the array */
        *missing = whole;
        c->missing = NULL;
    }
    return status;
}

enum tri_status tri_check_overlap(struct checker *c)
{
    static const struct check_pieces none;
    struct check_pieces missing = {0};
    bool regions = check_good(c, TRI_CHECK_REGIONS), good = false;
    enum tri_status status = TRI_OK;
    if (faces_count(c))
        status = list_missing(c, &missing);
    bool again = regions || missing.n > 0;
    if (status == TRI_OK) {
        tri_check_begin(c, TRI_CHECK_OVERLAP);
        status = sweep(c, &none, false, !again, &good);
    }
    if (status == TRI_OK && good && !again && has_hole_inside(c))
        status = sweep(c, &none, true, false, &good);
    again = again && good;
    if (status == TRI_OK && again)
        status = sweep(c, &missing, true, true, &good);
    if (status == TRI_OK && again && !good)
        status = sweep(c, &none, true, true, &good);
    free(missing.at);
    return status;
}
