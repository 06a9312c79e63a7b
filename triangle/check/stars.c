/* Stars: the triangles around a vertex wind around it at most once, around an inner one exactly once.
 *
 * Counted is how often the triangles at a vertex sweep over the direction +x: an exact measure of their turning that
 * needs no arithmetic, since triangle v a b, counter-clockwise, covers it just if a is not above v and b is. */
#include <stdlib.h>

#include "triangle/check/internal.h"

static void count_turns(struct checker *c)
{
#pragma omp parallel for schedule(static)
    for (int32_t h = 0; h < c->n_half_edges; h++) {
        int32_t a = check_org(c, h), b = check_dest(c, h), v = check_apex(c, h);
        double y = check_point(c, v).y;
        if (check_point(c, a).y <= y && y < check_point(c, b).y) {
#pragma omp atomic
            c->turns[v]++;
        }
        if (c->link[h] < 0) {
#pragma omp atomic write
            c->on_boundary[a] = 1;
#pragma omp atomic write
            c->on_boundary[b] = 1;
        }
    }
}

static bool winds_wrongly(const struct checker *c, int32_t v)
{
    return check_is_used(c, v) && c->turns[v] != 1 && !(c->on_boundary[v] && c->turns[v] == 0);
}

static void tell_star(struct checker *c, int32_t v)
{
    tri_check_fault(c, TRI_CHECK_STARS, "the triangles around vertex %ld wind around it %ld times", check_number(c, v),
                    (long)c->turns[v]);
}

enum tri_status tri_check_stars(struct checker *c)
{
    c->turns = tri_check_zeros(c->mesh->n_points, sizeof *c->turns);
    c->on_boundary = tri_check_zeros(c->mesh->n_points, 1);
    if (c->turns == NULL || c->on_boundary == NULL)
        return TRI_NO_MEMORY;
    count_turns(c);
    tri_check_each(c, TRI_CHECK_STARS, c->mesh->n_points, winds_wrongly, tell_star);
    return TRI_OK;
}
