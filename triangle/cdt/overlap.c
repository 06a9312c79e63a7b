/* Paint: in the order of the pieces each takes of its range what nobody has taken. A union-find structure leads over
 * what is taken, so each elementary piece is touched once, however many pieces run along it. */
#include "triangle/cdt/overlap.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/base/heap_sort.h"

struct sharing {
    const struct tri_piece *piece; /* [n] */
    const int32_t (*reach)[2];     /* [n] */
    int32_t n, n_stops;
    const tri_vertex_id *stop;     /* [n_stops] */
    int32_t *by_mark;              /* [n] by the first marked along them */
    int32_t *next;                 /* [n_stops] union-find: the next elementary piece that nobody has taken */
    int32_t *marked;               /* [n_stops] the first with a marker along each elementary piece */
    bool *odd;                     /* [n_stops] is the number of pieces along it odd? */
    struct tri_piece *result;      /* [n_stops] */
    int32_t n_results;
};

static void take_back(struct sharing *s)
{
    for (int32_t k = 0; k < s->n_stops; k++)
        s->next[k] = k;
}

/* The first from k on that nobody has taken. */
static int32_t find_free(const struct sharing *s, int32_t k)
{
    while (s->next[k] != k)
        k = s->next[k] = s->next[s->next[k]];
    return k;
}

static void take_marked(struct sharing *s, int32_t i)
{
    if (s->piece[i].course.marked == TRI_NONE)
        return;
    for (int32_t k = s->reach[i][0]; (k = find_free(s, k)) < s->reach[i][1]; s->next[k] = k + 1)
        s->marked[k] = s->piece[i].course.marked;
}

static void take(struct sharing *s, int32_t i)
{
    for (int32_t k = s->reach[i][0]; (k = find_free(s, k)) < s->reach[i][1]; s->next[k] = k + 1)
        s->result[s->n_results++] =
            (struct tri_piece){s->stop[k], s->stop[k + 1], {s->piece[i].course.first, s->marked[k], s->odd[k]}};
}

/* Each piece changes the parity from its start on, and again from its end on. */
static void find_odd(struct sharing *s)
{
    for (int32_t i = 0; i < s->n; i++) {
        s->odd[s->reach[i][0]] ^= s->piece[i].course.odd;
        s->odd[s->reach[i][1]] ^= s->piece[i].course.odd;
    }
    for (int32_t k = 1; k < s->n_stops; k++)
        s->odd[k] ^= s->odd[k - 1];
    assert(!s->odd[s->n_stops - 1]);
}

static bool is_marked_before(const void *context, int32_t a, int32_t b)
{
    const struct tri_piece *piece = context;
    return piece[a].course.marked != piece[b].course.marked ? piece[a].course.marked < piece[b].course.marked : a < b;
}

static void paint(struct sharing *s)
{
    for (int32_t i = 0; i < s->n; i++)
        s->by_mark[i] = i;
    tri_heap_sort(s->by_mark, s->n, is_marked_before, s->piece);
    for (int32_t k = 0; k < s->n_stops; k++)
        s->marked[k] = TRI_NONE;
    take_back(s);
    for (int32_t i = 0; i < s->n; i++)
        take_marked(s, s->by_mark[i]);
    find_odd(s);
    take_back(s);
    for (int32_t i = 0; i < s->n; i++)
        take(s, i);
}

bool tri_share_stops(const tri_vertex_id *stop, int32_t n_stops, int32_t (*reach)[2], struct tri_piece **piece,
                     int32_t *n)
{
    size_t stops = (size_t)n_stops;
    struct sharing s = {.piece = *piece, .reach = (const int32_t (*)[2])reach, .n = *n, .n_stops = n_stops,
                        .stop = stop,
                        .by_mark = malloc((size_t)*n * sizeof *s.by_mark),
                        .next = malloc(stops * sizeof *s.next),
                        .marked = malloc(stops * sizeof *s.marked),
                        .odd = calloc(stops, sizeof *s.odd),
                        .result = malloc(stops * sizeof *s.result)};
    bool room = s.by_mark && s.next && s.marked && s.odd && s.result;
    if (room) {
        paint(&s);
        free(*piece);
        *piece = s.result;
        *n = s.n_results;
    } else {
        free(s.result);
    }
    free(s.by_mark);
    free(s.next);
    free(s.marked);
    free(s.odd);
    return room;
}
