/* Stars: the triangles around a vertex wind around it at most once, around an inner one exactly once.
 *
 * Counted is how often the triangles at a vertex sweep over the direction +x: an exact measure of their turning that
 * needs no arithmetic, since triangle v a b, counter-clockwise, covers it just if a is not above v and b is. (edges.c
 * counts, up to 15.) */
#include "triangle/check/internal.h"

static bool winds_wrongly(const struct checker *c, int64_t v)
{
    int state = c->state[v], turns = state & CHECK_TURNS;
    return (state & CHECK_USED) != 0 && turns != 1 && !((state & CHECK_BOUNDARY) != 0 && turns == 0);
}

static void tell_star(struct checker *c, int64_t v)
{
    tri_check_fault(c, TRI_CHECK_STARS, "the triangles around vertex %ld wind around it %ld times", check_number(c, v),
                    (long)(c->state[v] & CHECK_TURNS));
}

void tri_check_stars(struct checker *c)
{
    tri_check_each(c, TRI_CHECK_STARS, 0, c->n_points, winds_wrongly, tell_star);
}
