/* The convex hull: a simple closed boundary visits the corners of its hull in their order; between two of them it must
 * lie along the edge of the hull that joins them. Vertices on hull edges are rounded, to either side: hence the
 * tolerance, which is twice that of segments. */
#include <stdlib.h>

#include "triangle/check/internal.h"

enum { SEVERAL = -2 };

/* The boundary as a loop of vertices. */
struct loop {
    struct checker *c;
    int32_t n;
    int32_t *from;         /* [n_frame] the boundary edge that leaves the vertex, -1: none, SEVERAL */
    int32_t *vertex;       /* [n] counter-clockwise */
    struct check_hull hull; /* of these */
};

static void list_boundary(struct loop *l)
{
    const struct checker *c = l->c;
    for (int32_t v = 0; v < c->n_frame; v++)
        l->from[v] = -1;
    for (int32_t e = 0; e < c->boundary.n; e++) {
        int32_t v = c->border[e][0];
        l->from[v] = l->from[v] == -1 ? e : SEVERAL;
    }
}

static void fault_at(struct loop *l, int32_t v)
{
    tri_check_fault(l->c, TRI_CHECK_HULL, "the boundary is not convex at vertex %ld", check_frame_vertex(l->c, v));
}

/* True: the boundary is one loop. */
static bool walk(struct loop *l)
{
    const struct checker *c = l->c;
    int32_t e = 0;
    do {
        l->vertex[l->n++] = c->border[e][0];
        int32_t next = l->from[c->border[e][1]];
        if (next < 0) {
            fault_at(l, c->border[e][1]);
            return false;
        }
        e = next;
    } while (e != 0 && l->n < c->boundary.n);
    if (e == 0 && l->n == c->boundary.n)
        return true;
    tri_check_fault(l->c, TRI_CHECK_HULL, "the boundary has %lld edges, but its loop through vertex %ld only %ld",
                    (long long)c->boundary.n, check_frame_vertex(c, c->border[0][0]), (long)l->n);
    return false;
}

static enum tri_status find_hull(struct loop *l)
{
    struct tri_point *points = tri_check_array(l->n, sizeof *points);
    for (int32_t i = 0; points != NULL && i < l->n; i++)
        points[i] = check_point(l->c, l->vertex[i]);
    enum tri_status status = points != NULL ? tri_check_hull_of(points, l->n, &l->hull) : TRI_NO_MEMORY;
    free(points);
    return status;
}

static bool is_corner(const struct loop *l, int32_t place)
{
    const struct tri_point p = check_point(l->c, l->vertex[place]);
    const struct check_hull *h = &l->hull;
    return bsearch(&p, h->chain[0], (size_t)h->n[0], sizeof p, tri_check_compare_points) != NULL ||
           bsearch(&p, h->chain[1], (size_t)h->n[1], sizeof p, tri_check_compare_points) != NULL;
}

static int32_t next_corner(const struct loop *l, int32_t place)
{
    do
        place = (place + 1) % l->n;
    while (!is_corner(l, place));
    return place;
}

/* Are the vertices behind `place` up to the next corner of the hull near the edge to it? Returns that corner's place;
 * -1: no. */
static int32_t follow_edge(struct loop *l, int32_t place)
{
    int32_t next = next_corner(l, place);
    struct tri_point a = check_point(l->c, l->vertex[place]), b = check_point(l->c, l->vertex[next]);
    double x = b.x - a.x, y = b.y - a.y, most = 2 * l->c->tolerance * sqrt(x * x + y * y);
    for (int32_t i = (place + 1) % l->n; i != next; i = (i + 1) % l->n) {
        struct tri_point p = check_point(l->c, l->vertex[i]);
        if (fabs(x * (p.y - a.y) - y * (p.x - a.x)) > most) {
            fault_at(l, l->vertex[i]);
            return -1;
        }
    }
    return next;
}

static enum tri_status judge(struct loop *l)
{
    tri_check_begin(l->c, TRI_CHECK_HULL);
    list_boundary(l);
    if (l->c->boundary.n == 0 || !walk(l))
        return TRI_OK;
    enum tri_status status = find_hull(l);
    int32_t first = status == TRI_OK ? next_corner(l, 0) : -1, place = first;
    while (place >= 0 && (place = follow_edge(l, place)) != first) {
    }
    return status;
}

enum tri_status tri_check_hull(struct checker *c)
{
    struct loop l = {.c = c, .from = tri_check_array(c->n_frame, sizeof *l.from),
                     .vertex = tri_check_array(c->boundary.n, sizeof *l.vertex)};
    enum tri_status status = l.from != NULL && l.vertex != NULL ? judge(&l) : TRI_NO_MEMORY;
    tri_check_hull_free(&l.hull);
    free(l.from);
    free(l.vertex);
    return status;
}
