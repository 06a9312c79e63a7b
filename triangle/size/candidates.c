/* Lists of candidates for the cells of a quadtree.
 *
 * INVARIANT. The list of a cell holds every item that wins anywhere in it. For let r be the distance of the corners of
 * a quarter from its centre c: an item whose key at c, less r times its slope, is above what another's can be at most,
 * wins nowhere in the quarter. What is no candidate in a cell is none in its parts, so that a list is chosen from that
 * of the cell around. A cell is cut until its list is short. Where many items tie - inside a circle, at the tips of a
 * fan - it is not for long: there a small cell keeps those who win at nine places, if with these keys are nearly right
 * at 16 other places too. */
#include "triangle/size/candidates.h"

enum { SHORT = 8, PLACES = 9, QUARTERS = 4, CHECKS = 16 };

/* Rounding must not lose a candidate at the border of two cells. */
static const double CUSHION = 1 + 0x1p-20;

struct making {
    struct tri_candidates *out;
    const struct tri_contest *contest;
    const struct tri_stop *stop;
    int32_t *stack; /* the lists of the cells around the one that is worked on, the outermost first */
    int64_t n, capacity;
    double *bound;  /* [QUARTERS] for each in a list: the least that its key can be in the quarters of a cell */
    uint32_t steps;
    enum tri_status status; /* the first failure */
};

/* What is known of a cell's list at its centre. */
struct verdict {
    struct tri_point centre;
    int32_t winner;
    double key, slope; /* the winner's key; the steepest slope */
};

static bool reserve(struct making *m, int64_t more)
{
    if (!tri_grow_far(&m->stack, &m->capacity, m->n + more, sizeof *m->stack))
        m->status = TRI_NO_MEMORY;
    return !m->status;
}

/* Who has the least key at a place, and that. */
static int32_t winner_at(const struct making *m, const int32_t *list, int64_t n, struct tri_point p, double *least)
{
    double slope;
    int32_t winner = list[0];
    *least = HUGE_VAL;
    for (int64_t i = 0; i < n; i++) {
        const double key = m->contest->key(m->contest->user, list[i], p, &slope);
        winner = key < *least ? list[i] : winner;
        *least = tri_lesser(*least, key);
    }
    return winner;
}

/* Place number k of a lattice of so many a side, which begins at `from` times its step. */
static struct tri_point lattice_place(struct tri_point low, double step, double from, int a_side, int k)
{
    const int x = k % a_side, y = k / a_side;
    return (struct tri_point){low.x + (from + x) * step, low.y + (from + y) * step};
}

/* Those who win at the corners of a cell, amid its sides and at its centre: each once, in their order. */
static int winners_of(const struct making *m, const int32_t *list, int64_t n, struct tri_point low, double side,
                      int32_t kept[PLACES])
{
    int n_kept = 0;
    for (int k = 0; k < PLACES; k++) {
        double least;
        const int32_t winner = winner_at(m, list, n, lattice_place(low, side / 2, 0, 3, k), &least);
        int i = n_kept;
        while (i > 0 && kept[i - 1] > winner)
            i--;
        if (i > 0 && kept[i - 1] == winner)
            continue;
        memmove(&kept[i + 1], &kept[i], (size_t)(n_kept - i) * sizeof *kept);
        kept[i] = winner;
        n_kept++;
    }
    return n_kept;
}

/* Shortens the list to the winners, if these will do; false: they do not. */
static bool keep_winners(const struct making *m, int32_t *list, int64_t *n, struct tri_cell cell, double allowed)
{
    const struct tri_point low = tri_cell_low(&m->out->tree, cell);
    const double side = tri_cell_side(&m->out->tree, cell.depth);
    int32_t kept[PLACES];
    const int n_kept = winners_of(m, list, *n, low, side, kept);
    for (int k = 0; k < CHECKS; k++) {
        const struct tri_point p = lattice_place(low, side / 4, 0.5, 4, k);
        double least, with_kept;
        winner_at(m, list, *n, p, &least);
        winner_at(m, kept, n_kept, p, &with_kept);
        if (with_kept > least + allowed)
            return false;
    }
    memcpy(list, kept, (size_t)n_kept * sizeof *kept);
    *n = n_kept;
    return true;
}

/* Is the list short enough for a leaf, or can it be made so? */
static bool settle(const struct making *m, int32_t *list, int64_t *n, struct tri_cell cell, const struct verdict *v)
{
    if (*n <= SHORT)
        return true;
    const double side = tri_cell_side(&m->out->tree, cell.depth);
    const double allowed = m->contest->allowed(m->contest->user, v->winner, v->centre, v->key, side);
    const bool is_last = cell.depth == TRI_QUADTREE_DEEPEST || v->slope * side < allowed;
    return (allowed > 0 || is_last) && keep_winners(m, list, n, cell, is_last ? HUGE_VAL : allowed);
}

static void make_leaf(struct making *m, int32_t at, const int32_t *list, int64_t n)
{
    struct tri_candidates *out = m->out;
    if (n > INT32_MAX / 4 || out->n > INT32_MAX / 4 ||
        !tri_grow(&out->list, &out->capacity, out->n + (int32_t)n + 1, sizeof *out->list)) {
        m->status = TRI_NO_MEMORY;
        return;
    }
    out->tree.child[at] = ~out->n;
    out->list[out->n++] = (int32_t)n;
    memcpy(out->list + out->n, list, (size_t)n * sizeof *list);
    out->n += (int32_t)n;
}

/* Puts onto the stack those of a list, `from` to `to` in the stack, that can win in one of the quarters of a cell. */
static struct verdict choose(struct making *m, int64_t from, int64_t to, struct tri_point low, double side)
{
    const double radius = side * 0.35355339059327379 * CUSHION;
    struct verdict v = {{low.x + side / 2, low.y + side / 2}, m->stack[from], HUGE_VAL, 0};
    double most[QUARTERS], *bound = m->bound;
    for (int k = 0; k < QUARTERS; k++)
        most[k] = HUGE_VAL;
    for (int64_t i = from; i < to; i++)
        for (int k = 0; k < QUARTERS; k++) {
            const struct tri_point p = lattice_place(low, side / 2, 0.5, 2, k);
            double slope, key = m->contest->key(m->contest->user, m->stack[i], p, &slope);
            *bound++ = key - slope * radius;
            most[k] = tri_lesser(most[k], key + slope * radius);
            v.winner = key < v.key ? m->stack[i] : v.winner;
            v.key = tri_lesser(v.key, key);
            v.slope = tri_larger(v.slope, slope);
        }
    bound = m->bound;
    int64_t kept = m->n;
    for (int64_t i = from; i < to; i++, bound += QUARTERS)
        if (bound[0] <= most[0] || bound[1] <= most[1] || bound[2] <= most[2] || bound[3] <= most[3])
            m->stack[kept++] = m->stack[i];
    m->n = kept;
    return v;
}

/* Makes the cell that child[at] stands for; its candidates are among those of the list. */
static void divide(struct making *m, int32_t at, struct tri_cell cell, int64_t from, int64_t to)
{
    struct tri_quadtree *tree = &m->out->tree;
    const double side = tri_cell_side(tree, cell.depth);
    const struct tri_point low = tri_cell_low(tree, cell);
    const int64_t first = m->n;
    if (tri_stop_is_due(m->stop, &m->steps))
        m->status = TRI_STOPPED;
    if (m->status || !reserve(m, to - from))
        return;
    const struct verdict v = choose(m, from, to, low, side);
    int64_t n = m->n - first;
    if (settle(m, m->stack + first, &n, cell, &v)) {
        make_leaf(m, at, m->stack + first, n);
    } else if (!tri_quadtree_grow(tree)) {
        m->status = TRI_NO_MEMORY;
    } else {
        const int32_t four = tree->n;
        tree->n += 4;
        tree->child[at] = four;
        for (uint32_t k = 0; k < 4; k++)
            divide(m, four + (int32_t)k, tri_cell_child(cell, k), first, first + n);
    }
    m->n = first;
}

enum tri_status tri_candidates_make(struct tri_candidates *candidates, const struct tri_contest *contest, int32_t n,
                                    struct tri_point low, struct tri_point high, const struct tri_stop *stop,
                                    struct tri_error *error)
{
    struct making m = {.out = candidates, .contest = contest, .stop = stop};
    *candidates = (struct tri_candidates){0};
    if (!tri_quadtree_init(&candidates->tree, low, high) || !reserve(&m, n) ||
        !tri_resize(&m.bound, (size_t)n * QUARTERS, sizeof *m.bound))
        m.status = TRI_NO_MEMORY;
    if (!m.status) {
        for (int32_t i = 0; i < n; i++)
            m.stack[m.n++] = i;
        divide(&m, 0, (struct tri_cell){0, 0, 0}, 0, n);
    }
    free(m.stack);
    free(m.bound);
    if (m.status)
        tri_candidates_clear(candidates);
    return m.status == TRI_STOPPED ? tri_fail_stopped(error)
           : m.status ? tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for sizes") : TRI_OK;
}

void tri_candidates_clear(struct tri_candidates *candidates)
{
    free(candidates->tree.child);
    free(candidates->list);
    *candidates = (struct tri_candidates){0};
}
