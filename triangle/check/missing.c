/* Cuts missing pieces where they meet.
 *
 * 1. The pieces are sorted by their left ends. Each is compared with the pieces that start before it ends. If an end
 *    of one certainly lies on the other, the other is cut there. If there is no such end but the two cross (decided
 *    exactly), both are cut at the rounded crossing.
 * 2. The results are the parts of each piece between successive cuts. Of equal parts one is kept, so overlapping
 *    pieces become one. */
#include "triangle/check/internal.h"

#include <stdlib.h>

#include "triangle/base/grow.h"

enum { MOST_TRIALS = 1 << 27, MOST_CUTS = 1 << 20 };

struct cut {
    int32_t piece; /* index of the piece */
    double at; /* distance from the piece's first end; computed in step 2 */
    struct tri_point point; /* position */
};

struct cutting {
    double tolerance;          /* of the mesh */
    int32_t n;                 /* number of pieces */
    struct check_piece *piece; /* [n] sorted from left to right */
    int64_t n_trials;          /* pairs of pieces compared so far */
    int32_t n_cuts, capacity;  /* cuts; allocated */
    struct cut *cut;           /* [n_cuts] */
};

static int compare_pieces(const void *a, const void *b)
{
    const struct check_piece *p = a, *q = b;
    int order = tri_compare_places(p->from, q->from);
    return order != 0 ? order : tri_compare_places(p->to, q->to);
}

static int compare_cuts(const void *a, const void *b)
{
    const struct cut *p = a, *q = b;
    if (p->piece != q->piece)
        return p->piece < q->piece ? -1 : 1;
    if (p->at != q->at)
        return p->at < q->at ? -1 : 1;
    return tri_compare_places(p->point, q->point);
}

/* Sorts the pieces from left to right and removes duplicates; returns how many remain. */
static int32_t sort(struct check_piece *piece, int32_t n)
{
    int32_t kept = 0;
    for (int32_t i = 0; i < n; i++) {
        if (tri_compare_places(piece[i].from, piece[i].to) > 0)
            piece[i] = (struct check_piece){piece[i].to, piece[i].from};
    }
    if (n > 1)
        qsort(piece, (size_t)n, sizeof *piece, compare_pieces);
    for (int32_t i = 0; i < n; i++) {
        if (kept == 0 || compare_pieces(&piece[kept - 1], &piece[i]) != 0)
            piece[kept++] = piece[i];
    }
    return kept;
}

static enum tri_status add_cut(struct cutting *k, int32_t i, struct tri_point p)
{
    if (!tri_grow(&k->cut, &k->capacity, k->n_cuts + 1, sizeof *k->cut))
        return TRI_NO_MEMORY;
    k->cut[k->n_cuts++] = (struct cut){i, 0, p};
    return TRI_OK;
}

static bool is_too_long(const struct cutting *k)
{
    return k->n_trials > MOST_TRIALS || k->n_cuts > MOST_CUTS;
}

/* Does p certainly lie on the piece, strictly between its ends? */
static bool is_inside(const struct check_piece *s, struct tri_point p)
{
    double x = s->to.x - s->from.x, y = s->to.y - s->from.y;
    double along = (p.x - s->from.x) * x + (p.y - s->from.y) * y;
    return along > 0 && along < x * x + y * y && !check_same_place(p, s->from) && !check_same_place(p, s->to) &&
           check_surely_meets(s->from, s->to, p);
}

static bool separates(const struct check_piece *s, const struct check_piece *r)
{
    double p = tri_orient2d(s->from, s->to, r->from), q = tri_orient2d(s->from, s->to, r->to);
    return (p > 0 && q < 0) || (p < 0 && q > 0);
}

static struct tri_point crossing_of(const struct check_piece *s, const struct check_piece *r)
{
    double x = s->to.x - s->from.x, y = s->to.y - s->from.y, u = r->to.x - r->from.x, v = r->to.y - r->from.y;
    double at = ((r->from.x - s->from.x) * v - (r->from.y - s->from.y) * u) / (x * v - y * u);
    return (struct tri_point){tri_round_coordinate(s->from.x + at * x), tri_round_coordinate(s->from.y + at * y)};
}

/* Step 1 for two pieces. */
static enum tri_status meet(struct cutting *k, int32_t i, int32_t j)
{
    const struct check_piece *s = &k->piece[i], *r = &k->piece[j];
    struct tri_point ends[4] = {r->from, r->to, s->from, s->to};
    int n = 0;
    enum tri_status status = TRI_OK;
    for (int end = 0; end < 4 && status == TRI_OK; end++) {
        if (!is_inside(end < 2 ? s : r, ends[end]))
            continue;
        status = add_cut(k, end < 2 ? i : j, ends[end]);
        n++;
    }
    if (status != TRI_OK || n > 0 || !separates(s, r) || !separates(r, s))
        return status;
    struct tri_point p = crossing_of(s, r);
    status = tri_is_exact_point(p) ? add_cut(k, i, p) : TRI_OK;
    return status == TRI_OK && tri_is_exact_point(p) ? add_cut(k, j, p) : status;
}

/* Step 1 for piece i and the pieces after it. */
static enum tri_status cut_others(struct cutting *k, int32_t i)
{
    const struct check_piece *s = &k->piece[i];
    enum tri_status status = TRI_OK;
    for (int32_t j = i + 1; j < k->n && k->piece[j].from.x <= s->to.x + k->tolerance; j++) {
        const struct check_piece *r = &k->piece[j];
        if (status != TRI_OK || is_too_long(k))
            break;
        k->n_trials++;
        if (fmax(r->from.y, r->to.y) >= fmin(s->from.y, s->to.y) - k->tolerance &&
            fmin(r->from.y, r->to.y) <= fmax(s->from.y, s->to.y) + k->tolerance)
            status = meet(k, i, j);
    }
    return status;
}

/* Cuts pieces at their own ends and where they meet. */
static enum tri_status find_cuts(struct cutting *k)
{
    enum tri_status status = TRI_OK;
    for (int32_t i = 0; i < k->n && status == TRI_OK; i++) {
        status = add_cut(k, i, k->piece[i].from);
        status = status == TRI_OK ? add_cut(k, i, k->piece[i].to) : status;
        status = status == TRI_OK ? cut_others(k, i) : status;
    }
    return status;
}

static void measure(struct cutting *k)
{
    for (int32_t i = 0; i < k->n_cuts; i++) {
        struct cut *cut = &k->cut[i];
        const struct check_piece *s = &k->piece[cut->piece];
        double x = s->to.x - s->from.x, y = s->to.y - s->from.y, length = sqrt(x * x + y * y);
        cut->at = length > 0 ? ((cut->point.x - s->from.x) * x + (cut->point.y - s->from.y) * y) / length : 0;
    }
}

/* Step 2. */
static enum tri_status list_parts(struct cutting *k, struct check_pieces *out)
{
    out->at = tri_check_array(k->n_cuts, sizeof *out->at);
    if (out->at == NULL)
        return TRI_NO_MEMORY;
    measure(k);
    qsort(k->cut, (size_t)k->n_cuts, sizeof *k->cut, compare_cuts);
    int32_t n = 0;
    for (int32_t i = 1; i < k->n_cuts; i++) {
        if (k->cut[i].piece == k->cut[i - 1].piece && !check_same_place(k->cut[i].point, k->cut[i - 1].point))
            out->at[n++] = (struct check_piece){k->cut[i - 1].point, k->cut[i].point};
    }
    out->n = sort(out->at, n);
    return TRI_OK;
}

void tri_check_sort_missing(struct checker *c) { c->n_missing = sort(c->missing, c->n_missing); }

enum tri_status tri_check_split_missing(const struct checker *c, struct check_pieces *pieces)
{
    *pieces = (struct check_pieces){0};
    struct cutting k = {.tolerance = c->tolerance, .n = c->n_missing, .piece = c->missing};
    enum tri_status status = find_cuts(&k);
    if (status == TRI_OK && k.n > 0 && !is_too_long(&k))
        status = list_parts(&k, pieces);
    free(k.cut);
    return status;
}
