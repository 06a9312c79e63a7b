/* The convex hull: a simple closed boundary visits the corners of its hull in their order; between two of them it must
 * lie along the edge of the hull that joins them. Vertices on hull edges are rounded, to either side: hence the
 * tolerance, which is twice that of segments. */
#include <stdlib.h>

#include "triangle/check/internal.h"

enum { SEVERAL = -2 };

struct corner {
    struct tri_point at;
    int32_t place; /* in the loop */
};

/* The boundary as a loop of vertices. */
struct loop {
    struct checker *c;
    int32_t n;
    int32_t *from;         /* [n_frame] the boundary edge that leaves the vertex, -1: none, SEVERAL */
    int32_t *vertex;       /* [n] counter-clockwise */
    struct corner *sorted; /* [n] in order of x, then y */
    int32_t *chain;        /* [n] of these, corners of the hull */
    uint8_t *is_corner;    /* [n] by place */
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

static int compare_corners(const void *a, const void *b)
{
    const struct corner *p = a, *q = b;
    if (p->at.x != q->at.x)
        return p->at.x < q->at.x ? -1 : 1;
    return (p->at.y > q->at.y) - (p->at.y < q->at.y);
}

/* Marks the corners of the lower (+1) or upper (-1) chain (Andrew 1979). */
static void mark_chain(struct loop *l, int sign)
{
    const struct corner *s = l->sorted;
    int32_t k = 0;
    for (int32_t i = 0; i < l->n; i++) {
        while (k > 1 && sign * tri_orient2d(s[l->chain[k - 2]].at, s[l->chain[k - 1]].at, s[i].at) <= 0)
            k--;
        l->chain[k++] = i;
    }
    for (int32_t i = 0; i < k; i++)
        l->is_corner[s[l->chain[i]].place] = 1;
}

static void mark_corners(struct loop *l)
{
    for (int32_t i = 0; i < l->n; i++)
        l->sorted[i] = (struct corner){check_point(l->c, l->vertex[i]), i};
    qsort(l->sorted, (size_t)l->n, sizeof *l->sorted, compare_corners);
    mark_chain(l, 1);
    mark_chain(l, -1);
}

/* Are the vertices behind `place` up to the next corner of the hull near the edge to it? Returns that corner's place;
 * -1: no. */
static int32_t follow_edge(struct loop *l, int32_t place)
{
    int32_t next = (place + 1) % l->n;
    while (!l->is_corner[next])
        next = (next + 1) % l->n;
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

static void judge(struct loop *l)
{
    list_boundary(l);
    if (l->c->boundary.n == 0 || !walk(l))
        return;
    mark_corners(l);
    int32_t first = l->sorted[0].place, place = first;
    do
        place = follow_edge(l, place);
    while (place >= 0 && place != first);
}

enum tri_status tri_check_hull(struct checker *c)
{
    struct loop l = {.c = c, .from = tri_check_array(c->n_frame, sizeof *l.from),
                     .vertex = tri_check_array(c->boundary.n, sizeof *l.vertex),
                     .sorted = tri_check_array(c->boundary.n, sizeof *l.sorted),
                     .chain = tri_check_array(c->boundary.n, sizeof *l.chain),
                     .is_corner = calloc((size_t)c->boundary.n + 1, 1)};
    enum tri_status status = TRI_NO_MEMORY;
    if (l.from && l.vertex && l.sorted && l.chain && l.is_corner) {
        tri_check_begin(c, TRI_CHECK_HULL);
        judge(&l);
        status = TRI_OK;
    }
    free(l.from);
    free(l.vertex);
    free(l.sorted);
    free(l.chain);
    free(l.is_corner);
    return status;
}
