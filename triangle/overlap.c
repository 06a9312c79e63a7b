/* Pieces are grouped by the vertex at which they start, those of one vertex sorted by direction and length. */
#include "triangle/overlap.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/heap_sort.h"
#include "triangle/predicates.h"

struct star {
    const struct tri_mesh *mesh;
    struct tri_piece *piece;
};

/* Whichever end comes first in the order of x, then y: so pieces of one direction on one line share it. */
static int32_t start_of(const struct star *s, int32_t i)
{
    int32_t a = s->piece[i].from, b = s->piece[i].to;
    return tri_compare_places(s->mesh->xy[a], s->mesh->xy[b]) < 0 ? a : b;
}

static int32_t end_of(const struct star *s, int32_t i)
{
    return s->piece[i].from ^ s->piece[i].to ^ start_of(s, i);
}

/* All directions of a star lie in one half plane, so orientation orders them. */
static double turn(const struct star *s, int32_t a, int32_t b)
{
    const struct tri_point *xy = s->mesh->xy;
    return tri_orient2d(xy[start_of(s, a)], xy[end_of(s, a)], xy[end_of(s, b)]);
}

/* By direction, then length, then number. */
static bool is_before(const void *context, int32_t a, int32_t b)
{
    const struct star *s = context;
    double side = turn(s, a, b);
    if (side != 0)
        return side > 0;
    int order = tri_compare_places(s->mesh->xy[end_of(s, a)], s->mesh->xy[end_of(s, b)]);
    return order != 0 ? order < 0 : a < b;
}

/* Pieces of one direction, the shortest first. */
static void share(struct star *s, const int32_t *item, int32_t n)
{
    assert(n >= 2);
    for (int32_t k = n - 1; k > 0; k--) {
        struct tri_piece *longer = &s->piece[item[k]], *shorter = &s->piece[item[k - 1]];
        int32_t to = end_of(s, item[k]);
        shorter->course = tri_course_both(shorter->course, longer->course);
        longer->from = end_of(s, item[k - 1]);
        longer->to = to;
    }
}

static void share_star(struct star *s, int32_t *item, int32_t n)
{
    tri_heap_sort(item, n, is_before, s);
    for (int32_t first = 0, end; first < n; first = end) {
        for (end = first + 1; end < n && turn(s, item[first], item[end]) == 0;)
            end++;
        if (end - first > 1)
            share(s, item + first, end - first);
    }
}

bool tri_share_overlaps(const struct tri_mesh *mesh, struct tri_piece *piece, int32_t n)
{
    struct star s = {mesh, piece};
    int32_t *item = malloc(((size_t)n + 1) * sizeof *item);
    int32_t *start = calloc((size_t)mesh->n_vertices + 2, sizeof *start);
    if (item && start) {
        for (int32_t i = 0; i < n; i++)
            start[start_of(&s, i) + 2]++;
        for (int32_t v = 0; v < mesh->n_vertices; v++)
            start[v + 2] += start[v + 1];
        for (int32_t i = 0; i < n; i++)
            item[start[start_of(&s, i) + 1]++] = i;
        assert(start[mesh->n_vertices] == n);
        for (int32_t v = 0; v < mesh->n_vertices; v++)
            if (start[v + 1] - start[v] > 1)
                share_star(&s, item + start[v], start[v + 1] - start[v]);
    }
    bool room = item && start;
    free(item);
    free(start);
    return room;
}
