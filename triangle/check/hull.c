/* The convex hull: a simple closed boundary that never turns right is convex; two of them are two hulls. */
#include <stdlib.h>

#include "triangle/check/internal.h"

enum { SEVERAL = -2 };

/* from[v]: the boundary edge that leaves v, -1: none, SEVERAL. Returns one of them all, -1: none. */
static int32_t list_boundary(const struct checker *c, int32_t *from)
{
    int32_t start = -1;
    for (int32_t v = 0; v < c->mesh->n_points; v++)
        from[v] = -1;
    for (int32_t h = c->n_half_edges - 1; h >= 0; h--) {
        if (c->link[h] >= 0)
            continue;
        int32_t v = check_org(c, h);
        from[v] = from[v] == -1 ? h : SEVERAL;
        start = h;
    }
    return start;
}

static bool turns_right(const struct checker *c, int32_t h, int32_t next)
{
    return tri_orient2d(check_point(c, check_org(c, h)), check_point(c, check_dest(c, h)),
                        check_point(c, check_dest(c, next))) < 0;
}

static void walk(struct checker *c, const int32_t *from, int32_t start)
{
    int64_t n = 0;
    int32_t h = start;
    do {
        int32_t next = from[check_dest(c, h)];
        if (next < 0 || turns_right(c, h, next)) {
            tri_check_fault(c, TRI_CHECK_HULL, "the boundary is not convex at vertex %ld",
                            check_number(c, check_dest(c, h)));
            return;
        }
        h = next;
        n++;
    } while (h != start);
    if (n == c->report->n_boundary_edges)
        return;
    tri_check_fault(c, TRI_CHECK_HULL, "the boundary has %lld edges, but its loop through vertex %ld only %lld",
                    (long long)c->report->n_boundary_edges, check_number(c, check_org(c, start)), (long long)n);
}

enum tri_status tri_check_hull(struct checker *c)
{
    int32_t *from = tri_check_array(c->mesh->n_points, sizeof *from);
    if (from == NULL)
        return TRI_NO_MEMORY;
    tri_check_begin(c, TRI_CHECK_HULL);
    int32_t start = list_boundary(c, from);
    if (start >= 0)
        walk(c, from, start);
    free(from);
    return TRI_OK;
}
