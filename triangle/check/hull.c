/* The convex hull: a simple closed boundary that never turns right is convex; two of them are two hulls. */
#include <stdlib.h>

#include "triangle/check/internal.h"

enum { SEVERAL = -2 };

/* from[v]: the boundary edge that leaves v, -1: none, SEVERAL. */
static void list_boundary(const struct checker *c, int32_t *from)
{
    for (int32_t v = 0; v < c->n_frame; v++)
        from[v] = -1;
    for (int32_t e = 0; e < c->boundary.n; e++) {
        int32_t v = c->border[e][0];
        from[v] = from[v] == -1 ? e : SEVERAL;
    }
}

static bool turns_right(const struct checker *c, int32_t e, int32_t next)
{
    return tri_orient2d(check_point(c, c->border[e][0]), check_point(c, c->border[e][1]),
                        check_point(c, c->border[next][1])) < 0;
}

static void walk(struct checker *c, const int32_t *from)
{
    int64_t n = 0;
    int32_t e = 0;
    do {
        int32_t next = from[c->border[e][1]];
        if (next < 0 || turns_right(c, e, next)) {
            tri_check_fault(c, TRI_CHECK_HULL, "the boundary is not convex at vertex %ld",
                            check_frame_vertex(c, c->border[e][1]));
            return;
        }
        e = next;
        n++;
    } while (e != 0);
    if (n == c->boundary.n)
        return;
    tri_check_fault(c, TRI_CHECK_HULL, "the boundary has %lld edges, but its loop through vertex %ld only %lld",
                    (long long)c->boundary.n, check_frame_vertex(c, c->border[0][0]), (long long)n);
}

enum tri_status tri_check_hull(struct checker *c)
{
    int32_t *from = tri_check_array(c->n_frame, sizeof *from);
    if (from == NULL)
        return TRI_NO_MEMORY;
    tri_check_begin(c, TRI_CHECK_HULL);
    list_boundary(c, from);
    if (c->boundary.n > 0)
        walk(c, from);
    free(from);
    return TRI_OK;
}
