/* A function of the caller, sampled level by level into a quadtree.
 *
 * Each cell is sampled at nine points: corners, midpoints of sides, and centre. If the corners predict the other
 * five values within TOLERANCE, or if the cell is small compared with the lengths, it becomes a leaf, with bilinear
 * interpolation in each quarter. So the measured error is that of a cell twice as large as the interpolated
 * quarters. Cells of all levels share points, and each point is sampled once.
 *
 * INVARIANT. Leaves that share a point share its value. So lengths can be limited on the graph of all points, and
 * leaves of the same size join continuously. */
#include "triangle/size/sources.h"

#include "triangle/base/hash.h"

enum { FIRST = 5, DEEPEST = 28, NINE = 9, CENTRE = 4, NEW = 5, EACH = 12 };

static const double TOLERANCE = 0.03; /* largest relative error of a prediction */
static const double SMALL = 0.5;      /* cells with sides below this fraction of the length are not divided */

/* A sample point: its distance from the lower left corner, in steps of half a cell of depth DEEPEST. */
struct node {
    uint32_t x, y; /* column and row of the point */
};

struct part {
    struct tri_cell cell; /* the cell */
    int32_t at;         /* index in the tree; -1: has been divided */
    int32_t node[NINE]; /* its sample points, lowest row first; -1: not yet known */
    double error;       /* relative error of the prediction from its corners; 0: small enough */
};

struct sampling {
    struct tri_sampled *out; /* the result */
    const struct tri_size_field *field; /* the function */
    const struct tri_size_frame *frame; /* data common to all sources */
    struct node *node; /* [n] all sample points so far */
    double *length;    /* [n] sampled lengths in units of the mesh; 0: no data */
    int32_t n, capacity, asked;         /* points; allocated; points already sampled */
    int32_t *slot;     /* [n_slots] hash table of sample points; -1: free */
    uint32_t n_slots;  /* a power of two */
    struct part *part; /* [n_parts] the leaves of the tree by number, and divided cells */
    int32_t n_parts, part_capacity; /* entries of `part`; allocated */
    int32_t first;     /* parts from this one on have not been sampled */
};

static enum tri_status no_memory(struct tri_error *error)
{
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for sizes");
}

/* --- sample points */

static uint32_t slot_of(const struct sampling *s, struct node node)
{
    uint32_t k = (uint32_t)(tri_mix(0, (uint64_t)node.x << 32 | node.y) >> 32) & (s->n_slots - 1);
    while (s->slot[k] >= 0 && (s->node[s->slot[k]].x != node.x || s->node[s->slot[k]].y != node.y))
        k = (k + 1) & (s->n_slots - 1);
    return k;
}

/* Makes room for more sample points. Returns false if memory ran out. */
static bool reserve(struct sampling *s, int64_t more)
{
    const struct tri_growing arrays[] = {{&s->node, sizeof *s->node}, {&s->length, sizeof *s->length}};
    if (s->n + more > INT32_MAX / 4 || !tri_grow_together(arrays, 2, &s->capacity, s->n + (int32_t)more, 0))
        return false;
    uint32_t wanted = s->n_slots > 0 ? s->n_slots : 1024;
    while ((int64_t)wanted < 2 * (s->n + more))
        wanted *= 2;
    if (wanted == s->n_slots)
        return true;
    if (!tri_resize(&s->slot, wanted, sizeof *s->slot))
        return false;
    s->n_slots = wanted;
    memset(s->slot, -1, (size_t)wanted * sizeof *s->slot);
    for (int32_t v = 0; v < s->n; v++)
        s->slot[slot_of(s, s->node[v])] = v;
    return true;
}

/* Returns the number of a sample point; adds it if it is new. */
static int32_t number_of(struct sampling *s, struct node node)
{
    const uint32_t k = slot_of(s, node);
    if (s->slot[k] < 0) {
        s->node[s->n] = node;
        s->slot[k] = s->n++;
    }
    return s->slot[k];
}

static struct tri_point place_of(const struct sampling *s, int32_t v)
{
    const double step = tri_cell_side(&s->out->tree, DEEPEST) / 2;
    return (struct tri_point){s->out->tree.low.x + s->node[v].x * step, s->out->tree.low.y + s->node[v].y * step};
}

/* Calls the function for the points from `asked` on. Points outside the mesh's box are moved to its border. */
static enum tri_status sample_points(struct sampling *s, struct tri_error *error)
{
    const struct tri_size_frame *f = s->frame;
    const int32_t n = s->n - s->asked;
    double(*at)[2] = malloc(((size_t)n + 1) * sizeof *at), *length = s->length + s->asked;
    if (!at)
        return no_memory(error);
    for (int32_t i = 0; i < n; i++) {
        const struct tri_point p = place_of(s, s->asked + i);
        at[i][0] = tri_lesser(p.x, f->high.x) * f->mesh->unit;
        at[i][1] = tri_lesser(p.y, f->high.y) * f->mesh->unit;
        length[i] = 0;
    }
    if (n > 0)
        s->field->function(s->field->user, n, (const double(*)[2])at, length);
    free(at);
    for (int32_t i = 0; i < n; i++)
        length[i] = tri_size_of(f, length[i]);
    s->asked = s->n;
    return tri_stop_is_asked(f->mesh->stop) ? tri_fail_stopped(error) : TRI_OK;
}

/* --- cells */

static void find_places(struct sampling *s, struct part *a)
{
    const uint32_t half = UINT32_C(1) << (DEEPEST - a->cell.depth);
    for (uint32_t k = 0; k < NINE; k++) {
        const struct node node = {(2 * a->cell.x + k % 3) * half, (2 * a->cell.y + k / 3) * half};
        if (k == CENTRE) /* it belongs to this cell alone; later it becomes a corner of the quarters */
            s->node[a->node[k] = s->n++] = node;
        else if (a->node[k] < 0)
            a->node[k] = number_of(s, node);
    }
}

/* Returns the largest relative error of predicting the other points from the corners; 0 if the cell is small. */
static double error_of(const struct sampling *s, const struct part *a)
{
    double l[NINE], least = HUGE_VAL;
    int gaps = 0;
    for (int k = 0; k < NINE; k++) {
        l[k] = s->length[a->node[k]];
        gaps += l[k] == 0;
        least = l[k] > 0 ? tri_lesser(least, l[k]) : least;
    }
    if (gaps == NINE || a->cell.depth == DEEPEST || tri_cell_side(&s->out->tree, a->cell.depth) <= SMALL * least)
        return 0;
    if (gaps > 0)
        return HUGE_VAL;
    const double told[5] = {(l[0] + l[2]) / 2, (l[0] + l[6]) / 2, (l[0] + l[2] + l[6] + l[8]) / 4, (l[2] + l[8]) / 2,
                            (l[6] + l[8]) / 2};
    static const int other[5] = {1, 3, 4, 5, 7};
    double error = 0;
    for (int k = 0; k < 5; k++)
        error = tri_larger(error, fabs(told[k] / l[other[k]] - 1));
    return error;
}

/* Returns a tolerance that limits the number of divided cells to the allowed number of points. */
static double tolerance_for(struct sampling *s)
{
    for (double tolerance = TOLERANCE; tolerance < 1e30; tolerance *= 2) {
        int64_t cut = 0;
        for (int32_t i = s->first; i < s->n_parts; i++)
            cut += s->part[i].error > tolerance;
        if (s->n + EACH * cut <= TRI_SAMPLES)
            return tolerance;
        s->out->is_coarse = true;
    }
    return HUGE_VAL;
}

/* Returns quarter k of a cell. Four points of the cell are its corners. */
static struct part quarter_of(const struct part *p, uint32_t k, int32_t at)
{
    struct part quarter = {.cell = tri_cell_child(p->cell, k), .at = at};
    for (uint32_t i = 0; i < NINE; i++)
        quarter.node[i] = i % 2 == 0 && i != CENTRE ? p->node[3 * ((k >> 1) + i / 6) + (k & 1) + (i % 3) / 2] : -1;
    return quarter;
}

/* Divides a leaf into quarters. Returns false if memory ran out. */
static bool cut(struct sampling *s, int32_t i)
{
    struct tri_quadtree *tree = &s->out->tree;
    if (!tri_quadtree_grow(tree) || !tri_grow(&s->part, &s->part_capacity, s->n_parts + 4, sizeof *s->part))
        return false;
    tree->child[s->part[i].at] = tree->n;
    for (uint32_t k = 0; k < 4; k++) {
        tree->child[tree->n] = ~s->n_parts;
        s->part[s->n_parts++] = quarter_of(&s->part[i], k, tree->n++);
    }
    s->part[i].at = -1;
    return true;
}

/* Divides a leaf and first any larger neighbours, so that neighbours differ by a factor of two at most. So a
 * variation beside a large cell is also searched inside that cell. Returns false if memory ran out. */
static bool divide_evenly(struct sampling *s, int32_t i)
{
    const struct tri_cell cell = s->part[i].cell;
    const int shift = TRI_QUADTREE_DEEPEST - cell.depth;
    const int64_t most = (INT64_C(1) << cell.depth) - 1;
    for (int64_t k = 0; k < NINE; k++) {
        const int64_t x = cell.x + k % 3 - 1, y = cell.y + k / 3 - 1;
        struct tri_cell around;
        if (x < 0 || y < 0 || x > most || y > most)
            continue;
        const int32_t other = tri_quadtree_leaf(&s->out->tree, (uint32_t)x << shift, (uint32_t)y << shift, &around);
        if (around.depth < cell.depth && !divide_evenly(s, other))
            return false;
    }
    return cut(s, i);
}

/* Processes one level: samples its points and divides its cells where necessary. */
static enum tri_status go_deeper(struct sampling *s, struct tri_error *error)
{
    const int32_t first = s->first, n = s->n_parts;
    const bool is_asked = s->part[first].cell.depth >= FIRST;
    if (is_asked && !reserve(s, (int64_t)(s->n > 0 ? NEW : NINE) * (n - first)))
        return no_memory(error);
    for (int32_t i = first; is_asked && i < n; i++)
        find_places(s, &s->part[i]);
    const enum tri_status status = is_asked ? sample_points(s, error) : TRI_OK;
    for (int32_t i = first; !status && i < n; i++)
        s->part[i].error = is_asked ? error_of(s, &s->part[i]) : HUGE_VAL;
    const double tolerance = is_asked ? tolerance_for(s) : 0;
    s->first = n;
    for (int32_t i = first; !status && i < n; i++)
        if (s->part[i].at >= 0 && s->part[i].error > tolerance && !divide_evenly(s, i))
            return no_memory(error);
    return status;
}

/* Renumbers the leaves. Returns the points of each leaf, NINE per leaf, or NULL if memory ran out. */
static int32_t *list_leaves(struct sampling *s)
{
    struct tri_sampled *out = s->out;
    int32_t *leaf = malloc((size_t)s->n_parts * sizeof s->part->node);
    for (int32_t i = 0; leaf && i < s->n_parts; i++)
        if (s->part[i].at >= 0) {
            out->tree.child[s->part[i].at] = ~out->n;
            memcpy(leaf + (size_t)NINE * (size_t)out->n++, s->part[i].node, sizeof s->part->node);
        }
    free(s->part);
    s->part = NULL;
    return leaf;
}

/* --- storing */

/* Limits the gradient and stores the values of each leaf. */
static enum tri_status store_values(struct sampling *s, struct tri_error *error)
{
    struct tri_sampled *out = s->out;
    struct tri_point *at = malloc((size_t)s->n * sizeof *at);
    int32_t *leaf = list_leaves(s);
    bool has_data = false;
    out->value = malloc((size_t)out->n * NINE * sizeof *out->value);
    enum tri_status status = at && leaf && out->value ? TRI_OK : no_memory(error);
    for (int32_t v = 0; !status && v < s->n; v++)
        at[v] = place_of(s, v);
    const struct tri_spreading cells = {at, s->n, leaf, out->n, NINE};
    if (!status)
        status = tri_spread_lengths(&cells, s->length, s->frame->gradation, &has_data, s->frame->mesh->stop, error);
    free(at);
    if (!status && !has_data)
        status = tri_fail(error, TRI_BAD_INPUT, NULL, 0, "it returned no length above 0");
    double longest = 0;
    for (int32_t v = 0; v < s->n; v++)
        longest = tri_larger(longest, s->length[v]);
    out->scale = tri_size_scale(longest);
    for (int32_t k = 0; !status && k < NINE * out->n; k++)
        out->value[k] = tri_size_float(s->length[leaf[k]], out->scale);
    free(leaf);
    return status;
}

enum tri_status tri_sampled_make(struct tri_sampled *sampled, const struct tri_size_field *field,
                                 const struct tri_size_frame *frame, struct tri_error *error)
{
    struct sampling s = {.out = sampled, .field = field, .frame = frame};
    *sampled = (struct tri_sampled){.n = 0};
    enum tri_status status = TRI_OK;
    if (!tri_grow(&s.part, &s.part_capacity, 1, sizeof *s.part) ||
        !tri_quadtree_init(&sampled->tree, frame->low, frame->high))
        status = no_memory(error);
    else
        s.part[s.n_parts++] = (struct part){.node = {-1, -1, -1, -1, -1, -1, -1, -1, -1}};
    while (!status && s.first < s.n_parts)
        status = go_deeper(&s, error);
    status = status ? status : store_values(&s, error);
    free(s.part);
    free(s.node);
    free(s.length);
    free(s.slot);
    if (status)
        tri_sampled_clear(sampled);
    return status;
}

double tri_sampled_at(const struct tri_sampled *s, struct tri_point p)
{
    struct tri_cell cell;
    const float *leaf = s->value + (size_t)NINE * (size_t)tri_quadtree_find(&s->tree, p, &cell);
    const double quarters = s->tree.scale / (double)(UINT32_C(1) << (TRI_QUADTREE_DEEPEST - 1 - cell.depth));
    const double x = tri_lesser(tri_larger((p.x - s->tree.low.x) * quarters - 2.0 * cell.x, 0), 2);
    const double y = tri_lesser(tri_larger((p.y - s->tree.low.y) * quarters - 2.0 * cell.y, 0), 2);
    const int i = x >= 1, j = y >= 1;
    const float *v = leaf + 3 * j + i;
    const double right = x - i, up = y - j;
    const double low = (1 - right) * v[0] + right * v[1], high = (1 - right) * v[3] + right * v[4];
    return s->scale * ((1 - up) * low + up * high);
}

uint64_t tri_sampled_hash(const struct tri_sampled *s, uint64_t hash)
{
    hash = tri_hash(hash, &s->tree.low, sizeof s->tree.low);
    hash = tri_hash(hash, &s->tree.side, sizeof s->tree.side);
    hash = tri_hash(hash, s->tree.child, (size_t)s->tree.n * sizeof *s->tree.child);
    hash = tri_hash(hash, &s->scale, sizeof s->scale);
    return tri_hash(hash, s->value, (size_t)s->n * NINE * sizeof *s->value);
}

void tri_sampled_clear(struct tri_sampled *s)
{
    free(s->tree.child);
    free(s->value);
    *s = (struct tri_sampled){.n = 0};
}
