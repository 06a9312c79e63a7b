/* Incremental Delaunay triangulation in biased randomised Hilbert order, parallel over stretches of the curve.
 *
 * Points are inserted in rounds of geometrically growing random samples, each along the Hilbert curve (Amenta, Choi &
 * Rote 2003). Consecutive points are near each other, so point location takes few steps, and no input order makes
 * cavities large on average.
 *
 * Vertices are numbered along the curve, which is divided into leaves of equal size. Within a round, stretches of
 * leaves insert points in parallel (insertion.c). Points whose cavity crosses a border wait for stretches of WIDER
 * times as many leaves; the last stretch is the whole curve. With m vertices per stretch, about n / sqrt(m) triangles
 * cross borders. So each step leaves half as many points as the one before, and about sqrt(n) are inserted
 * sequentially. The mesh depends on the set of points only, because cocircular ties are broken by coordinates, rounds
 * and stretches depend only on n, and triangles are sorted at the end. */
#include "triangle/cdt/delaunay.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/base/scatter.h"
#include "triangle/geometry/predicates.h"

enum {
    FIRST_ROUND = 512, /* points */
    ROUND_GROWTH = 8,
    MOST_ROUNDS = 8,
    LEAF = 1 << 15,    /* vertices */
    MOST_LEAVES = 256,
    WIDER = 4,
    LEAST_SHARE = 16   /* a stretch should insert at least (leaf size) / LEAST_SHARE points in a round */
};

_Static_assert(INT64_C(8) * 8 * 8 * 8 * 8 * 8 * 8 * FIRST_ROUND >= TRI_MAX_VERTICES && ROUND_GROWTH == 8,
               "the last round takes the rest");

struct leaf {
    struct tri_range range;
    int32_t round[MOST_ROUNDS + 1]; /* points of round r are waiting[round[r] .. round[r + 1]) */
    int32_t n_waiting;              /* number of points of the current round that remain, at the start of its range */
    int32_t n_inserted;             /* number of points inserted in the current round */
    int32_t near;                   /* a triangle near the leaf; valid between phases */
    int32_t entry;                  /* an owned triangle to start from; TRI_NONE: continue after the previous leaf */
    enum tri_status status;         /* result of the stretch that begins at this leaf */
};

struct builder {
    struct tri_mesh *mesh;
    const struct tri_executor *executor;
    struct tri_triangle *tri; /* [2 n_vertices + 4] two for each entry of `waiting`, and the first four */
    int32_t *waiting;         /* [n_vertices] points to insert */
    struct leaf *leaf;
    int32_t n_leaves, n_rounds;
    int32_t least;            /* minimum number of points that a stretch should insert in a round */
    int32_t first[3];         /* corners of the initial triangle */
    int32_t round, width;     /* current round; number of leaves in each stretch */
};

/* --- duplicates */

struct twins {
    struct tri_mesh *mesh;
    int32_t found[TRI_MOST_SHARES];
};

static void find_twins(void *context, size_t share)
{
    struct twins *twins = context;
    const struct tri_point *xy = twins->mesh->xy;
    struct tri_range range = tri_share(share, twins->mesh->n_vertices);
    for (tri_vertex_id v = range.first; v < range.last; v++) {
        bool again = v > 0 && xy[v].x == xy[v - 1].x && xy[v].y == xy[v - 1].y;
        twins->mesh->twin[v] = again ? v - 1 : v;
        twins->found[share] += again;
    }
}

/* Finds duplicates, which are neighbours along the curve. */
static enum tri_status list_twins(struct tri_mesh *mesh, int32_t *n_twins, const struct tri_executor *executor,
                                  struct tri_error *error)
{
    int32_t n = mesh->n_vertices, found = 0;
    struct twins twins = {.mesh = mesh};
    mesh->twin = malloc(((size_t)n + 1) * sizeof *mesh->twin);
    if (!mesh->twin)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for %d points", (int)n);
    tri_execute(executor, tri_shares(n), find_twins, &twins);
    for (size_t share = 0; share < tri_shares(n); share++)
        found += twins.found[share];
    for (tri_vertex_id v = 1; found > 0 && v < n; v++)
        if (mesh->twin[v] != v)
            mesh->twin[v] = mesh->twin[v - 1];
    if (found == 0) {
        free(mesh->twin);
        mesh->twin = NULL;
    }
    *n_twins = found;
    return TRI_OK;
}

static bool is_twin(const struct tri_mesh *mesh, tri_vertex_id v) { return mesh->twin && mesh->twin[v] != v; }

/* --- rounds */

/* Returns the round of vertex v. Round r of R holds one point in ROUND_GROWTH^(R - r), selected by a fixed hash. */
static int round_of(const struct builder *b, tri_vertex_id v)
{
    int round = b->n_rounds - 1;
    for (uint32_t draw = tri_scatter((uint32_t)v); round > 0 && draw % ROUND_GROWTH == 0; draw /= ROUND_GROWTH)
        round--;
    return round;
}

static bool needs_insertion(const struct builder *b, tri_vertex_id v)
{
    return !is_twin(b->mesh, v) && v != b->first[0] && v != b->first[1] && v != b->first[2];
}

/* Sorts the points of a leaf by round, and along the curve within a round. Marks triangles that no point will use as
 * free. */
static void arrange_leaf(void *context, size_t index)
{
    const struct builder *b = context;
    struct leaf *leaf = &b->leaf[index];
    int32_t at[MOST_ROUNDS + 1] = {0};
    leaf->range = tri_share_of(index, (size_t)b->n_leaves, b->mesh->n_vertices);
    for (tri_vertex_id v = leaf->range.first; v < leaf->range.last; v++)
        if (needs_insertion(b, v))
            at[round_of(b, v) + 1]++;
    at[0] = leaf->range.first;
    for (int r = 0; r < MOST_ROUNDS; r++)
        at[r + 1] += at[r];
    assert(at[MOST_ROUNDS] <= leaf->range.last);
    for (int r = 0; r <= MOST_ROUNDS; r++)
        leaf->round[r] = at[r];
    for (tri_vertex_id v = leaf->range.first; v < leaf->range.last; v++)
        if (needs_insertion(b, v))
            b->waiting[at[round_of(b, v)]++] = v;
    for (tri_triangle_id t = 2 * at[MOST_ROUNDS]; t < 2 * leaf->range.last; t++)
        b->tri[t].v[0] = TRI_NONE;
    leaf->near = 2 * b->mesh->n_vertices;
}

/* --- a phase: all stretches of one width */

static struct tri_range stretch_of(const struct builder *b, int32_t leaf)
{
    int32_t first = leaf - leaf % b->width, last = first + b->width < b->n_leaves ? first + b->width : b->n_leaves;
    return (struct tri_range){b->leaf[first].range.first, b->leaf[last - 1].range.last};
}

/* Finds a triangle at which the stretch can begin with the points of a leaf: that of the first point whose triangle the
 * stretch owns. Runs while nothing is inserted. A stretch that owns everything can begin anywhere. */
static void find_entry(void *context, size_t index)
{
    const struct builder *b = context;
    struct leaf *leaf = &b->leaf[index];
    struct tri_inserter all = {b->mesh->xy, b->tri, {0, b->mesh->n_vertices}, .last = leaf->near}, own = all;
    own.stretch = stretch_of(b, (int32_t)index);
    leaf->entry = TRI_NONE;
    if (b->width >= b->n_leaves) {
        leaf->entry = index == 0 ? leaf->near : TRI_NONE;
        return;
    }
    for (int32_t i = 0; leaf->entry == TRI_NONE && i < leaf->n_waiting; i++) {
        tri_triangle_id t = tri_inserter_locate(&all, b->mesh->xy[b->waiting[leaf->round[b->round] + i]]);
        leaf->entry = tri_inserter_owns(&own, &b->tri[t]) ? t : TRI_NONE;
    }
}

/* Inserts the points of a leaf. Points that cannot be inserted stay in the list. */
static enum tri_status insert_leaf(const struct builder *b, struct leaf *leaf, struct tri_inserter *inserter,
                                   uint32_t *step)
{
    int32_t *waiting = b->waiting + leaf->round[b->round], kept = 0;
    for (int32_t i = 0; i < leaf->n_waiting; i++) {
        if (tri_stop_is_due(b->mesh->stop, step))
            return TRI_STOPPED;
        tri_triangle_id triangle = 2 * (leaf->round[b->round] + leaf->n_inserted);
        enum tri_insertion done = tri_insert(inserter, waiting[i], triangle);
        if (done == TRI_INSERTION_NO_MEMORY)
            return TRI_NO_MEMORY;
        if (done == TRI_NOT_OWNED)
            waiting[kept++] = waiting[i];
        else
            leaf->n_inserted++;
    }
    leaf->n_waiting = kept;
    assert(kept + leaf->n_inserted == leaf->round[b->round + 1] - leaf->round[b->round]);
    leaf->near = inserter->last;
    return TRI_OK;
}

static void insert_stretch(void *context, size_t index)
{
    const struct builder *b = context;
    int32_t first = (int32_t)index * b->width;
    struct tri_inserter inserter = {b->mesh->xy, b->tri, stretch_of(b, first), .last = TRI_NONE};
    enum tri_status status = TRI_OK;
    uint32_t step = 0;
    for (int32_t i = first; !status && i < b->n_leaves && i < first + b->width; i++) {
        struct leaf *leaf = &b->leaf[i];
        inserter.last = leaf->entry != TRI_NONE ? leaf->entry : inserter.last;
        if (inserter.last != TRI_NONE)
            status = insert_leaf(b, leaf, &inserter, &step);
    }
    b->leaf[first].status = status;
    tri_inserter_free(&inserter);
}

static enum tri_status run_phase(struct builder *b, struct tri_error *error)
{
    size_t n_stretches = (size_t)((b->n_leaves + b->width - 1) / b->width);
    tri_execute(b->executor, (size_t)b->n_leaves, find_entry, b);
    tri_execute(b->executor, n_stretches, insert_stretch, b);
    for (int32_t i = 0; i < b->n_leaves; i += b->width) {
        if (b->leaf[i].status == TRI_STOPPED)
            return tri_fail_stopped(error);
        if (b->leaf[i].status)
            return tri_fail(error, b->leaf[i].status, NULL, 0, "out of memory for a cavity");
    }
    return TRI_OK;
}

static int64_t count_waiting(const struct builder *b)
{
    int64_t waiting = 0;
    for (int32_t i = 0; i < b->n_leaves; i++)
        waiting += b->leaf[i].n_waiting;
    return waiting;
}

static enum tri_status run_round(struct builder *b, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    for (int32_t i = 0; i < b->n_leaves; i++) {
        b->leaf[i].n_waiting = b->leaf[i].round[b->round + 1] - b->leaf[i].round[b->round];
        b->leaf[i].n_inserted = 0;
    }
    int64_t waiting = count_waiting(b);
    for (b->width = 1; b->width < b->n_leaves && waiting * b->width < (int64_t)b->least * b->n_leaves;)
        b->width *= WIDER;
    for (; !status && waiting > 0; b->width *= WIDER) {
        status = run_phase(b, error);
        assert(status || b->width < b->n_leaves || count_waiting(b) == 0);
        waiting = count_waiting(b);
    }
    return status;
}

/* --- the whole triangulation */

/* Finds the first three points that span a triangle. Returns false if all points are collinear. */
static bool find_first(struct builder *b)
{
    const struct tri_point *xy = b->mesh->xy;
    int32_t found = 0;
    for (tri_vertex_id v = 0; found < 3 && v < b->mesh->n_vertices; v++)
        if (!is_twin(b->mesh, v) && (found < 2 || tri_orient2d(xy[b->first[0]], xy[b->first[1]], xy[v]) != 0))
            b->first[found++] = v;
    return found == 3;
}

static enum tri_status build(struct builder *b, int32_t leaf_size, struct tri_error *error)
{
    int64_t n = b->mesh->n_vertices;
    for (b->n_leaves = 1; b->n_leaves < MOST_LEAVES && n / (b->n_leaves * WIDER) >= leaf_size;)
        b->n_leaves *= WIDER;
    b->least = leaf_size / LEAST_SHARE;
    b->n_rounds = 1;
    for (int64_t size = FIRST_ROUND; size < n; size *= ROUND_GROWTH)
        b->n_rounds++;
    assert(b->n_rounds <= MOST_ROUNDS);
    enum tri_status status = TRI_OK;
    b->leaf = calloc((size_t)b->n_leaves, sizeof *b->leaf);
    b->waiting = malloc((size_t)n * sizeof *b->waiting);
    if (!b->leaf || !b->waiting)
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for %d points", (int)n);
    if (!status) {
        tri_insert_first(b->mesh->xy, b->tri, 2 * b->mesh->n_vertices, b->first);
        tri_execute(b->executor, (size_t)b->n_leaves, arrange_leaf, b);
    }
    for (b->round = 0; !status && b->round < b->n_rounds; b->round++)
        status = run_round(b, error);
    free(b->leaf);
    free(b->waiting);
    return status;
}

enum tri_status tri_delaunay_in_leaves(struct tri_mesh *mesh, int32_t leaf_size, const struct tri_executor *executor,
                                       struct tri_error *error)
{
    struct builder b = {.mesh = mesh, .executor = executor};
    assert(mesh->origin && mesh->n_triangles == 0 && mesh->n_subs == 0 && leaf_size > 0);
    int32_t n_twins = 0, n_triangles = 2 * mesh->n_vertices + 4;
    enum tri_status status = list_twins(mesh, &n_twins, executor, error);
    if (status || !find_first(&b))
        return status;
    void *raw = malloc(((size_t)n_triangles + 2) * sizeof *b.tri);
    if (!raw)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for %d points", (int)mesh->n_vertices);
    b.tri = (struct tri_triangle *)((char *)raw + (-(uintptr_t)raw & 63)); /* two triangles per cache line */
    status = build(&b, leaf_size, error);
    int32_t n_live = n_triangles - 2 * n_twins - 6; /* the first three points make four triangles in total */
    status = status ? status : tri_curve_sort(mesh, b.tri, n_triangles, n_live, executor, error);
    free(raw);
    return status;
}

enum tri_status tri_delaunay(struct tri_mesh *mesh, const struct tri_executor *executor, struct tri_error *error)
{
    return tri_delaunay_in_leaves(mesh, LEAF, executor, error);
}
