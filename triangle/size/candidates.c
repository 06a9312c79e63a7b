/* Candidate lists for the cells of a quadtree.
 *
 * INVARIANT. The list of a cell contains every item that wins anywhere in the cell. Keys are convex. So, from the
 * centre of a part of the cell, the gradient bounds each key from below, and gradient and bend bound the winner's
 * key from above. An item wins nowhere in the part if its lower bound exceeds the winner's upper bound everywhere,
 * or exceeds another item's largest key. The list of a cell is chosen from the list of its parent cell. A cell is
 * divided until its list is short. Where many items tie (at the centre of a circle, at the tips of a fan), lists
 * stay long. There a small cell keeps only the winners at nine points, if the keys of these items are nearly right
 * at 16 other points. */
#include "triangle/size/candidates.h"

enum { SHORT = 8, LONG = 32, PLACES = 9, QUARTERS = 4, CHECKS = 16 };

/* If there are many items, the cells of depth AHEAD are left to parallel tasks. */
enum { AHEAD = 3, PORTIONS = 64, MANY = 4096 };

/* Enlarges parts, so that rounding does not lose a candidate on the border of two cells. */
static const double CUSHION = 1 + 0x1p-20;

/* The key of an item, from the centre of a part of a cell. */
struct sight {
    double value; /* lower bound of the key is value + gradient * displacement */
    struct tri_point gradient;
};

/* A cell that is left to a task, with its candidates. */
struct portion {
    int32_t at; /* index in the tree */
    struct tri_cell cell;      /* the cell */
    int32_t *list; /* [n] */
    int64_t n;     /* number of candidates */
    struct tri_candidates out; /* its own result, in which child[0] stands for this cell */
    enum tri_status status;    /* of the task */
};

struct making {
    struct tri_candidates *out; /* the result */
    const struct tri_contest *contest; /* borrowed */
    const struct tri_stop *stop;       /* borrowed; NULL: cannot be stopped */
    int32_t *stack; /* lists of the cells on the path from the root to the current cell */
    int64_t n, capacity; /* entries of the stack: used; allocated */
    struct sight *sight; /* [QUARTERS] keys for each item of a list */
    struct portion *portion; /* [n_portions] cells left to tasks, in the order of the tree; NULL: no tasks */
    size_t n_portions;       /* number of cells left to tasks */
    uint32_t steps;          /* counter of tri_stop_is_due */
    enum tri_status status; /* the first failure */
};

/* Summary of a cell's list. */
struct verdict {
    int32_t winner;    /* the item with the smallest key at the centres of the parts */
    double key, slope; /* the smallest key; the steepest slope */
};

static bool reserve(struct making *m, int64_t more)
{
    if (!tri_grow_far(&m->stack, &m->capacity, m->n + more, sizeof *m->stack))
        m->status = TRI_NO_MEMORY;
    return !m->status;
}

/* Returns the item with the smallest key at p, and sets *least to the key. */
static int32_t winner_at(const struct making *m, const int32_t *list, int64_t n, struct tri_point p, double *least)
{
    int32_t winner = list[0];
    *least = HUGE_VAL;
    for (int64_t i = 0; i < n; i++) {
        const double key = m->contest->key(m->contest->user, list[i], p).value;
        winner = key < *least ? list[i] : winner;
        *least = tri_lesser(*least, key);
    }
    return winner;
}

/* Returns point k of a square grid with a_side points per side, whose first point lies at `from` steps. */
static struct tri_point lattice_place(struct tri_point low, double step, double from, int a_side, int k)
{
    const int x = k % a_side, y = k / a_side;
    return (struct tri_point){low.x + (from + x) * step, low.y + (from + y) * step};
}

/* Lists the winners at the corners, the midpoints of the sides and the centre of a cell, each once and in ascending
 * order. */
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

/* Shortens the list to these winners if they suffice; otherwise returns false. */
static bool keep_winners(const struct making *m, int32_t *list, int64_t *n, struct tri_cell cell, double allowed)
{
    const struct tri_point low = tri_cell_low(&m->out->tree, cell);
    const double side = tri_cell_side(&m->out->tree, cell.depth);
    int32_t kept[PLACES] = {0};
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

/* Is the list short enough for a leaf, or can it be shortened? */
static bool trim_list(const struct making *m, int32_t *list, int64_t *n, struct tri_cell cell, const struct verdict *v)
{
    if (*n <= SHORT)
        return true;
    const double side = tri_cell_side(&m->out->tree, cell.depth);
    const double allowed = m->contest->allowed(m->contest->user, v->winner, v->key, side);
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

/* A square part of a cell: the whole cell or a quarter. */
struct part {
    struct tri_point centre; /* centre of the part */
    struct tri_key winner; /* key of the winner at the centre; its value is infinite before there is one */
    double most;           /* upper bound on the smallest key anywhere in the part */
};

static struct verdict compute_keys(const struct making *m, int64_t from, int64_t to, struct part *parts, int n_parts,
                              double radius)
{
    struct verdict v = {m->stack[from], HUGE_VAL, 0};
    struct sight *sight = m->sight;
    for (int64_t i = from; i < to; i++)
        for (int k = 0; k < n_parts; k++) {
            struct part *part = &parts[k];
            const struct tri_key key = m->contest->key(m->contest->user, m->stack[i], part->centre);
            *sight++ = (struct sight){key.value, key.gradient};
            part->most = tri_lesser(part->most, key.value + key.slope * radius);
            v.slope = tri_larger(v.slope, key.slope);
            if (key.value < part->winner.value)
                part->winner = key;
            if (key.value < v.key)
                v = (struct verdict){m->stack[i], key.value, v.slope};
        }
    return v;
}

/* Can an item win in the part? half: distance of the sides from the centre. */
static inline bool can_win(const struct sight *s, const struct part *part, double half, double radius)
{
    const double x = s->gradient.x - part->winner.gradient.x, y = s->gradient.y - part->winner.gradient.y;
    return s->value - half * (fabs(s->gradient.x) + fabs(s->gradient.y)) <= part->most &&
           s->value - part->winner.value - half * (fabs(x) + fabs(y)) <= part->winner.bend * radius * radius;
}

/* Pushes the items of the list from .. to that can win in a part of the cell onto the stack, starting at index `at`.
 * a_side: 1 (the whole cell) or 2 (quarters). */
static struct verdict choose(struct making *m, int64_t from, int64_t to, int64_t at, struct tri_cell cell, int a_side)
{
    const struct tri_point low = tri_cell_low(&m->out->tree, cell);
    const double side = tri_cell_side(&m->out->tree, cell.depth) / a_side;
    const double half = side / 2 * CUSHION, radius = half * 1.4142135623730951;
    const int n_parts = a_side * a_side;
    struct part parts[QUARTERS];
    for (int k = 0; k < n_parts; k++)
        parts[k] = (struct part){lattice_place(low, side, 0.5, a_side, k), {.value = HUGE_VAL}, HUGE_VAL};
    const struct verdict v = compute_keys(m, from, to, parts, n_parts, radius);
    const struct sight *sight = m->sight;
    m->n = at;
    for (int64_t i = from; i < to; i++, sight += n_parts) {
        bool wins = false;
        for (int k = 0; k < n_parts && !wins; k++)
            wins = can_win(&sight[k], &parts[k], half, radius);
        if (wins)
            m->stack[m->n++] = m->stack[i];
    }
    return v;
}

/* Leaves a cell to a task. */
static void defer_cell(struct making *m, int32_t at, struct tri_cell cell, const int32_t *list, int64_t n)
{
    struct portion *portion = &m->portion[m->n_portions];
    *portion = (struct portion){.at = at, .cell = cell, .list = malloc((size_t)n * sizeof *list), .n = n};
    if (!portion->list) {
        m->status = TRI_NO_MEMORY;
        return;
    }
    memcpy(portion->list, list, (size_t)n * sizeof *list);
    m->n_portions++;
}

static void divide(struct making *m, int32_t at, struct tri_cell cell, int64_t from, int64_t to);

/* Makes the four children of the cell at child[at]. Its list is on the stack. */
static void quarter(struct making *m, int32_t at, struct tri_cell cell, int64_t from, int64_t to)
{
    struct tri_quadtree *tree = &m->out->tree;
    if (!tri_quadtree_grow(tree)) {
        m->status = TRI_NO_MEMORY;
        return;
    }
    const int32_t four = tree->n;
    tree->n += 4;
    tree->child[at] = four;
    for (uint32_t k = 0; k < 4; k++)
        divide(m, four + (int32_t)k, tri_cell_child(cell, k), from, to);
}

/* Makes the cell at child[at]. Its candidates are among the items of the list. */
static void divide(struct making *m, int32_t at, struct tri_cell cell, int64_t from, int64_t to)
{
    const int64_t first = m->n;
    if (tri_stop_is_due(m->stop, &m->steps))
        m->status = TRI_STOPPED;
    if (m->status || !reserve(m, to - from))
        return;
    struct verdict v = choose(m, from, to, first, cell, 1);
    if (m->n - first > SHORT && m->n - first <= LONG) /* its list may become short; longer lists are chosen again for
                                                         the quarters anyway */
        v = choose(m, first, m->n, first, cell, 2);
    int64_t n = m->n - first;
    if (trim_list(m, m->stack + first, &n, cell, &v))
        make_leaf(m, at, m->stack + first, n);
    else if (m->portion && cell.depth == AHEAD)
        defer_cell(m, at, cell, m->stack + first, n);
    else
        quarter(m, at, cell, first, first + n);
    m->n = first;
}

static void run_portion(void *making, size_t i)
{
    const struct making *all = making;
    struct portion *portion = &all->portion[i];
    struct making m = {.out = &portion->out, .contest = all->contest, .stop = all->stop, .stack = portion->list,
                       .n = portion->n, .capacity = portion->n};
    struct tri_quadtree *tree = &portion->out.tree;
    *tree = all->out->tree; /* the same root */
    tree->child = NULL;
    tree->n = tree->capacity = 0;
    if (!tri_quadtree_grow(tree) || !tri_resize(&m.sight, (size_t)m.n * QUARTERS, sizeof *m.sight)) {
        m.status = TRI_NO_MEMORY;
    } else {
        tree->n = 1;
        quarter(&m, 0, portion->cell, 0, portion->n);
    }
    portion->list = m.stack;
    portion->status = m.status;
    free(m.sight);
}

/* Appends the result of a task to the tree. */
static void append_portion(struct making *m, const struct portion *portion)
{
    struct tri_candidates *out = m->out;
    struct tri_quadtree *tree = &out->tree;
    const struct tri_candidates *own = &portion->out;
    m->status = m->status ? m->status : portion->status;
    if (!m->status && (own->n > INT32_MAX / 4 || out->n > INT32_MAX / 4 ||
                       !tri_grow(&out->list, &out->capacity, out->n + own->n, sizeof *out->list) ||
                       !tri_grow(&tree->child, &tree->capacity, tree->n + own->tree.n, sizeof *tree->child)))
        m->status = TRI_NO_MEMORY;
    if (m->status)
        return;
    for (int32_t i = 0; i < own->tree.n; i++) {
        const int32_t code = own->tree.child[i];
        tree->child[i == 0 ? portion->at : tree->n + i - 1] = code >= 0 ? code + tree->n - 1 : ~(~code + out->n);
    }
    memcpy(out->list + out->n, own->list, (size_t)own->n * sizeof *own->list);
    tree->n += own->tree.n - 1;
    out->n += own->n;
}

enum tri_status tri_candidates_make(struct tri_candidates *candidates, const struct tri_contest *contest, int32_t n,
                                    const struct tri_size_frame *frame, struct tri_error *error)
{
    struct portion portion[PORTIONS];
    struct making m = {.out = candidates, .contest = contest, .stop = frame->mesh->stop,
                       .portion = n > MANY ? portion : NULL};
    *candidates = (struct tri_candidates){0};
    if (!tri_quadtree_init(&candidates->tree, frame->low, frame->high) || !reserve(&m, n) ||
        !tri_resize(&m.sight, (size_t)n * QUARTERS, sizeof *m.sight))
        m.status = TRI_NO_MEMORY;
    if (!m.status) {
        for (int32_t i = 0; i < n; i++)
            m.stack[m.n++] = i;
        divide(&m, 0, (struct tri_cell){0, 0, 0}, 0, n);
    }
    free(m.stack);
    free(m.sight);
    tri_execute(frame->executor, m.status ? 0 : m.n_portions, run_portion, &m);
    for (size_t i = 0; i < m.n_portions; i++) {
        append_portion(&m, &portion[i]);
        free(portion[i].list);
        tri_candidates_clear(&portion[i].out);
    }
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
