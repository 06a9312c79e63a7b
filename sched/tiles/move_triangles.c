/* Triangles move in place, batch by batch of their new places, down from the last: those of a batch are gathered in a
 * buffer; those that stand in their places, and belong to batches to come, are set aside; then the batch is put down.
 * So a triangle is set aside only if it moves down, or, where more of them do than up, and batches go up from the
 * first, only if it moves up: at most half of them. */
#include "sched/tiles/renumber.h"

#include <string.h>

#include "sched/tunables.h"

enum { BATCH_SHARES = 32 };

struct move {
    const struct par_numbering *n;
    struct tri_range batch;  /* of new places */
    bool down;               /* batches go down: what is below has not moved yet */
    int32_t n_aside;        /* before this batch */
    int32_t aside[BATCH_SHARES]; /* by each share */
};

static struct tri_range batch_share(const struct move *m, size_t share)
{
    struct tri_range range = tri_share_of(share, BATCH_SHARES, m->batch.last - m->batch.first);
    return (struct tri_range){m->batch.first + range.first, m->batch.first + range.last};
}

/* Of triangles in their new order: this one has been set aside, and the number is its place there. */
static const int32_t ASIDE = INT32_MIN;

static struct tri_triangle *aside_of(const struct par_numbering *n) { return n->scratch; }

static inline const struct tri_triangle *source_of(const struct par_numbering *n, int32_t turned)
{
    return (turned < 0 ? aside_of(n) : n->mesh->tri) + number_in(turned & ~ASIDE);
}

static inline tri_link new_link(const int32_t *place, const int32_t *sub_number, tri_link link)
{
    return link >= 0 ? new_code(place, link) : ~sub_number[~link];
}

static inline struct tri_triangle renamed(const struct par_numbering *n, const struct tri_triangle *t, int first)
{
    const int32_t *number = n->number, *place = n->place, *sub_number = n->sub_number;
    int second = tri_next[first], third = tri_prev[first];
    return (struct tri_triangle){{number[t->v[first]], number[t->v[second]], number[t->v[third]]},
                                 {new_link(place, sub_number, t->n[first]), new_link(place, sub_number, t->n[second]),
                                  new_link(place, sub_number, t->n[third])},
                                 t->region,
                                 0};
}

/* Something stands here that is to go to a batch to come. */
static bool stands_here(const struct move *m, tri_triangle_id t)
{
    int32_t place = m->n->place[t];
    return place != TRI_NONE && (m->down ? number_in(place) < m->batch.first : number_in(place) >= m->batch.last);
}

/* Those that come soon are fetched already, so that the memory works on many at once. */
static void gather_batch(void *context, size_t share)
{
    struct move *m = context;
    const struct par_numbering *n = m->n;
    struct tri_range range = batch_share(m, share);
    struct tri_triangle *to = n->buffer - m->batch.first;
    const int32_t *turned = n->dealt;
    int32_t aside = 0;
    for (tri_triangle_id t = range.first; t < range.last; t++) {
        aside += stands_here(m, t);
        if (t + PAR_MOVED_AHEAD < range.last)
            __builtin_prefetch(source_of(n, turned[t + PAR_MOVED_AHEAD]));
        to[t] = renamed(n, source_of(n, turned[t]), corner_in(turned[t]));
    }
    m->aside[share] = aside;
}

static void put_down(void *context, size_t share)
{
    const struct move *m = context;
    const struct par_numbering *n = m->n;
    struct tri_range range = batch_share(m, share);
    int32_t aside = m->aside[share];
    for (tri_triangle_id t = range.first; t < range.last; t++) {
        if (stands_here(m, t)) {
            aside_of(n)[aside] = n->mesh->tri[t];
            n->dealt[number_in(n->place[t])] = ASIDE | turn(aside++, corner_in(n->place[t]));
        }
        n->mesh->tri[t] = n->buffer[t - m->batch.first];
    }
}

static void move_batch(struct move *m)
{
    memset(m->aside, 0, sizeof m->aside);
    tri_execute(m->n->executor, BATCH_SHARES, gather_batch, m);
    for (int share = 0; share < BATCH_SHARES; share++) {
        int32_t count = m->aside[share];
        m->aside[share] = m->n_aside;
        m->n_aside += count;
    }
    tri_execute(m->n->executor, BATCH_SHARES, put_down, m);
}

void par_move_triangles(const struct par_numbering *n)
{
    int64_t down = 0;
    for (int32_t tile = 0; tile < n->n_tiles; tile++)
        down += n->triangles.at[tile];
    struct move m = {.n = n, .down = 2 * down <= n->n_tri};
    int32_t batches = n->n_tri / n->batch + 1;
    for (int32_t i = 0; i < batches; i++) {
        int32_t first = n->batch * (m.down ? batches - 1 - i : i), left = n->n_tri - first;
        m.batch = (struct tri_range){first, first + (left < n->batch ? left : n->batch)};
        move_batch(&m);
    }
    assert(m.n_aside <= n->mesh->n_triangles / 2);
}

int32_t par_move_batch(int32_t n_triangles)
{
    return n_triangles / PAR_FEWEST_BATCHES < PAR_MOST_MOVE ? n_triangles / PAR_FEWEST_BATCHES + 1 : PAR_MOST_MOVE;
}
