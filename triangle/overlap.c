/* Pieces are sorted by line and along it; those that overlap are painted over the elementary pieces between their ends.
 *
 * 1. Suspects: only pieces whose line may be another's, too, are sorted. A line has a direction and an offset, computed
 *    with rounding, and a piece is entered in each cell of a grid of both that the line may lie in. LEMMA: with u =
 *    2^-53 the direction is off by less than 16 u, the offset by less than 16 u of the largest coordinate (a quotient
 *    errs by 3 u of itself, and neither is above 1), far less than SLACK cells; the same line is in the same cell.
 *    Of what is on one line only what is no edge of the mesh yet is sorted: the others are laid at once anyway, and
 *    grids are full of them.
 * 2. Order: by direction, then side, both exact; on one line by start. So a line's pieces are a run of the sorted
 *    suspects, and those that overlap, directly or by way of others, a run of that: a cluster.
 * 3. Stops: the ends of a cluster's m pieces in their order, at most 2 m; each piece covers a range of the elementary
 *    pieces between them.
 * 4. Paint: in the order of the pieces each takes of its range what nobody has taken. A union-find structure leads over
 *    what is taken, so each elementary piece is touched once, however many pieces run along it. */
#include "triangle/overlap.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/heap_sort.h"
#include "triangle/predicates.h"

/* A range of stops. */
struct reach {
    int32_t first, last; /* equal: the piece overlaps no other */
};

struct sharing {
    const struct tri_point *xy;
    const struct tri_piece *piece;
    int32_t n;
    int32_t *by_mark;             /* [n] by the first marked along them, or NULL: they are in that order */
    int32_t *suspect, n_suspects; /* [n] */
    int32_t *stop, n_stops;       /* [2 n_suspects] vertices, cluster by cluster */
    struct reach *reach;          /* [n] */
    int32_t *next;                /* [n_stops + 1] union-find: the next elementary piece that nobody has taken */
    int32_t *marked;              /* [n_stops] the first with a marker along each elementary piece */
    bool *odd;                    /* [n_stops] is the number of pieces along it odd? */
    struct tri_piece *result;
    int32_t n_results;
};

/* --- lines */

static bool precedes(struct tri_point p, struct tri_point q)
{
    return tri_compare_places(p, q) < 0;
}

/* Pieces of one line have one direction from start to end. */
static int32_t start_of(const struct sharing *s, int32_t i)
{
    int32_t a = s->piece[i].from, b = s->piece[i].to;
    return precedes(s->xy[a], s->xy[b]) ? a : b;
}

static int32_t end_of(const struct sharing *s, int32_t i)
{
    return s->piece[i].from ^ s->piece[i].to ^ start_of(s, i);
}

/* > 0: the line of a comes before that of b; 0: they are the same. Directions are in one half plane, so turns order
 * them. */
static double compare_lines(const struct sharing *s, int32_t a, int32_t b)
{
    struct tri_point p = s->xy[start_of(s, a)], q = s->xy[end_of(s, a)];
    struct tri_point r = s->xy[start_of(s, b)], t = s->xy[end_of(s, b)];
    double turn = tri_turn(p, q, r, t);
    return turn != 0 ? turn : tri_orient2d(p, q, r);
}

static bool is_before(const void *context, int32_t a, int32_t b)
{
    const struct sharing *s = context;
    double side = compare_lines(s, a, b);
    int32_t p = start_of(s, a), q = start_of(s, b);
    return side != 0 ? side > 0 : p != q ? precedes(s->xy[p], s->xy[q]) : a < b;
}

/* --- suspects */

static const double CELLS = 0x1p32, SLACK = 0x1p-12; /* of a unit, of a cell */

struct cells {
    int64_t direction[2], offset[2]; /* from, to */
};

static void cells_around(double at, int64_t cell[2])
{
    double middle = at * CELLS + (4 * CELLS + 0.5); /* 0, 1 and 2 in the middle of a cell; positive */
    cell[0] = (int64_t)(middle - SLACK);
    cell[1] = (int64_t)(middle + SLACK);
}

static double larger(double a, double b) { return fabs(a) > fabs(b) ? fabs(a) : fabs(b); }

/* The direction is as an angle is, from -2 to 2; the offset is a multiple of the distance from the origin. Both are
 * continuous. */
static struct cells cells_of(const struct sharing *s, int32_t i, double largest)
{
    struct tri_point p = s->xy[start_of(s, i)], q = s->xy[end_of(s, i)];
    double x = q.x - p.x, y = q.y - p.y, longer = larger(x, y);
    x /= longer;
    y /= longer;
    struct cells cells;
    cells_around(y * (2 - x), cells.direction);
    cells_around((p.y * x - p.x * y) / largest, cells.offset);
    return cells;
}

static size_t entry_of(int64_t direction, int64_t offset, int bits)
{
    uint64_t mixed = (uint64_t)direction * 0x9E3779B97F4A7C15u + (uint64_t)offset;
    return (size_t)(mixed * 0xD6E8FEB86659FD93u >> (64 - bits));
}

/* Enters piece i in its cells, or tells whether anybody else is in one of them. */
static bool visit(const struct sharing *s, int32_t i, double largest, unsigned char *entries, int bits, bool enter)
{
    struct cells c = cells_of(s, i, largest);
    bool shared = false;
    for (int64_t d = c.direction[0]; d <= c.direction[1]; d++)
        for (int64_t o = c.offset[0]; o <= c.offset[1]; o++) {
            unsigned char *entry = &entries[entry_of(d, o, bits)];
            if (enter && *entry < 2)
                ++*entry;
            shared |= *entry > 1;
        }
    return shared;
}

static double largest_coordinate(const struct sharing *s)
{
    double largest = 0;
    for (int32_t i = 0; i < s->n; i++) {
        struct tri_point p = s->xy[s->piece[i].from], q = s->xy[s->piece[i].to];
        largest = larger(larger(largest, larger(p.x, p.y)), larger(q.x, q.y));
    }
    return largest;
}

static bool list_suspects(struct sharing *s, tri_is_edge *is_edge, void *context)
{
    double largest = largest_coordinate(s);
    int bits = 4;
    while (bits < 32 && ((int64_t)1 << bits) < 4 * (int64_t)s->n)
        bits++;
    unsigned char *entries = calloc((size_t)1 << bits, 1);
    s->suspect = malloc(((size_t)s->n + 1) * sizeof *s->suspect);
    bool room = entries && s->suspect;
    for (int32_t i = 0; room && i < s->n; i++)
        visit(s, i, largest, entries, bits, true);
    for (int32_t i = 0; room && i < s->n; i++)
        if (visit(s, i, largest, entries, bits, false) && !is_edge(context, &s->piece[i]))
            s->suspect[s->n_suspects++] = i;
    free(entries);
    return room;
}

/* --- clusters */

static bool is_left(const void *context, int32_t a, int32_t b)
{
    const struct tri_point *xy = context;
    return precedes(xy[a], xy[b]);
}

/* The ends of the pieces in their order, each once. */
static int32_t list_stops(const struct sharing *s, const int32_t *item, int32_t n, int32_t *stop)
{
    for (int32_t k = 0; k < n; k++) {
        stop[2 * k] = s->piece[item[k]].from;
        stop[2 * k + 1] = s->piece[item[k]].to;
    }
    tri_heap_sort(stop, 2 * n, is_left, s->xy);
    int32_t kept = 1;
    for (int32_t k = 1; k < 2 * n; k++)
        if (stop[k] != stop[kept - 1])
            stop[kept++] = stop[k];
    return kept;
}

static int32_t find_stop(const struct sharing *s, const int32_t *stop, int32_t n, int32_t v)
{
    int32_t low = 0;
    while (n > 1) {
        int32_t half = n / 2;
        low += precedes(s->xy[v], s->xy[stop[low + half]]) ? 0 : half;
        n = stop[low] == v ? 1 : n - half;
    }
    assert(stop[low] == v);
    return low;
}

static void cut_cluster(struct sharing *s, const int32_t *item, int32_t n)
{
    int32_t *stop = s->stop + s->n_stops, n_stops = list_stops(s, item, n, stop);
    for (int32_t k = 0; k < n; k++) {
        struct reach *reach = &s->reach[item[k]];
        reach->first = s->n_stops + find_stop(s, stop, n_stops, start_of(s, item[k]));
        reach->last = s->n_stops + find_stop(s, stop, n_stops, end_of(s, item[k]));
        assert(reach->first < reach->last);
    }
    s->n_stops += n_stops;
}

/* The end of the cluster that begins with suspect number `first`. */
static int32_t end_of_cluster(const struct sharing *s, int32_t first)
{
    const int32_t *item = s->suspect;
    int32_t furthest = end_of(s, item[first]), next = first + 1;
    for (; next < s->n_suspects && compare_lines(s, item[first], item[next]) == 0; next++) {
        int32_t end = end_of(s, item[next]);
        if (!precedes(s->xy[start_of(s, item[next])], s->xy[furthest]))
            break;
        if (precedes(s->xy[furthest], s->xy[end]))
            furthest = end;
    }
    return next;
}

static bool cut_clusters(struct sharing *s)
{
    s->stop = malloc((2 * (size_t)s->n_suspects + 1) * sizeof *s->stop);
    s->reach = calloc((size_t)s->n + 1, sizeof *s->reach);
    if (!s->stop || !s->reach)
        return false;
    tri_heap_sort(s->suspect, s->n_suspects, is_before, s);
    for (int32_t first = 0, end; first < s->n_suspects; first = end) {
        end = end_of_cluster(s, first);
        if (end - first > 1)
            cut_cluster(s, s->suspect + first, end - first);
    }
    return true;
}

/* --- paint */

static void take_back(struct sharing *s)
{
    for (int32_t k = 0; k <= s->n_stops; k++)
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
    for (int32_t k = s->reach[i].first; (k = find_free(s, k)) < s->reach[i].last; s->next[k] = k + 1)
        s->marked[k] = s->piece[i].course.marked;
}

static void take(struct sharing *s, int32_t i)
{
    if (s->reach[i].first == s->reach[i].last)
        s->result[s->n_results++] = s->piece[i];
    for (int32_t k = s->reach[i].first; (k = find_free(s, k)) < s->reach[i].last; s->next[k] = k + 1)
        s->result[s->n_results++] =
            (struct tri_piece){s->stop[k], s->stop[k + 1], {s->piece[i].course.first, s->marked[k], s->odd[k]}};
}

/* Each piece changes the parity from its start on, and again from its end on. */
static void find_odd(struct sharing *s)
{
    for (int32_t i = 0; i < s->n; i++) {
        bool odd = s->piece[i].course.odd && s->reach[i].first < s->reach[i].last;
        s->odd[s->reach[i].first] ^= odd;
        s->odd[s->reach[i].last] ^= odd;
    }
    for (int32_t k = 1; k < s->n_stops; k++)
        s->odd[k] ^= s->odd[k - 1];
    assert(!s->odd[s->n_stops - 1]);
}

static bool paint(struct sharing *s)
{
    s->next = malloc(((size_t)s->n_stops + 1) * sizeof *s->next);
    s->marked = malloc((size_t)s->n_stops * sizeof *s->marked);
    s->odd = calloc((size_t)s->n_stops, sizeof *s->odd);
    s->result = malloc(((size_t)s->n + (size_t)s->n_stops) * sizeof *s->result);
    if (!s->next || !s->marked || !s->odd || !s->result)
        return false;
    for (int32_t k = 0; k < s->n_stops; k++)
        s->marked[k] = TRI_NONE;
    take_back(s);
    for (int32_t i = 0; i < s->n; i++)
        take_marked(s, s->by_mark ? s->by_mark[i] : i);
    find_odd(s);
    take_back(s);
    for (int32_t i = 0; i < s->n; i++)
        take(s, i);
    return true;
}

static void free_sharing(struct sharing *s)
{
    free(s->by_mark);
    free(s->suspect);
    free(s->stop);
    free(s->reach);
    free(s->next);
    free(s->marked);
    free(s->odd);
    free(s->result);
}

/* What has been painted takes the place of the pieces. */
static void exchange(struct sharing *s, struct tri_piece **piece, int32_t *n)
{
    struct tri_piece *old = *piece;
    *piece = s->result;
    *n = s->n_results;
    s->result = old;
}

bool tri_share_overlaps(const struct tri_mesh *mesh, struct tri_piece **piece, int32_t *n, tri_is_edge *is_edge,
                        void *context)
{
    struct sharing s = {.xy = mesh->xy, .piece = *piece, .n = *n};
    bool room = *n < 2 || (list_suspects(&s, is_edge, context) && (s.n_suspects < 2 || cut_clusters(&s)));
    if (room && s.n_stops > 0 && (room = paint(&s)))
        exchange(&s, piece, n);
    free_sharing(&s);
    return room;
}

static bool is_marked_before(const void *context, int32_t a, int32_t b)
{
    const struct tri_piece *piece = context;
    return piece[a].course.marked != piece[b].course.marked ? piece[a].course.marked < piece[b].course.marked : a < b;
}

bool tri_share_stops(const tri_vertex_id *stop, int32_t n_stops, int32_t (*reach)[2], struct tri_piece **piece,
                     int32_t *n)
{
    struct sharing s = {.piece = *piece, .n = *n, .n_stops = n_stops};
    s.stop = malloc((size_t)n_stops * sizeof *s.stop);
    s.reach = malloc((size_t)*n * sizeof *s.reach);
    s.by_mark = malloc((size_t)*n * sizeof *s.by_mark);
    bool room = s.stop && s.reach && s.by_mark;
    if (room)
        memcpy(s.stop, stop, (size_t)n_stops * sizeof *s.stop);
    for (int32_t i = 0; room && i < *n; i++) {
        assert(0 <= reach[i][0] && reach[i][0] < reach[i][1] && reach[i][1] < n_stops);
        s.reach[i] = (struct reach){reach[i][0], reach[i][1]};
        s.by_mark[i] = i;
    }
    if (room)
        tri_heap_sort(s.by_mark, *n, is_marked_before, *piece);
    if (room && (room = paint(&s)))
        exchange(&s, piece, n);
    free_sharing(&s);
    return room;
}
