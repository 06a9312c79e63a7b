/* Finds the chains of boundary edges.
 *
 * The sides of segments are listed with their markers and sorted by their first node; if segments have the same ends,
 * the last one counts. In every mesh all boundary edges are segments, so one pass over the triangles finds the sides
 * that have a triangle. A boundary edge has its triangle on the left.
 *
 * At every node as many boundary edges arrive as leave, so a walk along unused edges returns to its start and forms a
 * loop. At a node shared by several loops, the walk takes the first edge that leaves. A loop is cut at changes of the
 * marker. */
#include "triangle/text/boundary.h"

#include <assert.h>
#include <stdlib.h>

struct side {
    int64_t from, to, segment;
    int32_t marker;
    bool used;     /* has a triangle; later, used by a loop */
    bool boundary;
};

struct builder {
    const struct tri_grid *grid;
    struct side *sides; /* [n] sorted by from and to */
    int64_t n;
    int64_t *loop;      /* [n] the sides of the current loop */
    struct tri_boundary *boundary;
    int64_t n_nodes;
};

static int compare(const void *left, const void *right)
{
    const struct side *a = left, *b = right;
    if (a->from != b->from)
        return a->from < b->from ? -1 : 1;
    return a->to != b->to ? (a->to > b->to) - (a->to < b->to) : (a->segment < b->segment) - (a->segment > b->segment);
}

/* Returns the first side that is not before (from, to). */
static int64_t find_side(const struct builder *b, int64_t from, int64_t to)
{
    const struct side wanted = {.from = from, .to = to, .segment = INT64_MAX};
    int64_t low = 0, high = b->n;
    while (low < high) {
        int64_t middle = low + (high - low) / 2;
        if (compare(&b->sides[middle], &wanted) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static bool has_side(const struct builder *b, int64_t i, int64_t from, int64_t to)
{
    return i < b->n && b->sides[i].from == from && b->sides[i].to == to;
}

/* Sets `used` for sides of segments that have a triangle. on_segment: one byte per point. */
static void mark_used_sides(struct builder *b, const char *on_segment)
{
    for (int64_t t = 0; t < b->grid->n_triangles; t++) {
        int64_t nodes[6];
        b->grid->triangle(b->grid->user, t, nodes);
        for (int k = 0; k < 3; k++) {
            const int64_t from = nodes[(k + 1) % 3], to = nodes[(k + 2) % 3];
            const int64_t i = on_segment[from] && on_segment[to] ? find_side(b, from, to) : b->n;
            if (has_side(b, i, from, to))
                b->sides[i].used = true;
        }
    }
}

/* Keeps only the sides with a triangle whose other side has none. */
static void keep_boundary(struct builder *b)
{
    int64_t n = 0;
    for (int64_t i = 0; i < b->n; i++) {
        struct side *side = &b->sides[i];
        const int64_t other = find_side(b, side->to, side->from);
        side->boundary = side->used && !(has_side(b, other, side->to, side->from) && b->sides[other].used);
    }
    for (int64_t i = 0; i < b->n; i++)
        if (b->sides[i].boundary) {
            b->sides[n] = b->sides[i];
            b->sides[n++].used = false;
        }
    b->n = n;
}

/* Lists the boundary edges in b->sides. Returns false if out of memory. */
static bool list_sides(struct builder *b)
{
    char *on_segment = calloc((size_t)b->grid->n_points + 1, 1);
    int64_t n = 0;
    if (!on_segment)
        return false;
    for (int64_t s = 0; s < b->grid->n_segments; s++) {
        struct tri_grid_edge segment;
        b->grid->segment(b->grid->user, s, &segment);
        for (int k = 0; k < 2; k++) {
            b->sides[n++] = (struct side){segment.ends[k], segment.ends[1 - k], s, segment.marker, false, false};
            on_segment[segment.ends[k]] = 1;
        }
    }
    qsort(b->sides, (size_t)b->n, sizeof *b->sides, compare);
    mark_used_sides(b, on_segment);
    keep_boundary(b);
    free(on_segment);
    return true;
}

/* Returns an unused side that leaves the node; -1: none. */
static int64_t next_side(const struct builder *b, int64_t node)
{
    for (int64_t i = find_side(b, node, INT64_MIN); i < b->n && b->sides[i].from == node; i++)
        if (!b->sides[i].used)
            return i;
    return -1;
}

static int64_t walk(struct builder *b, int64_t side)
{
    int64_t n = 0;
    for (; side >= 0; side = next_side(b, b->sides[side].to)) {
        b->sides[side].used = true;
        b->loop[n++] = side;
    }
    assert(b->sides[b->loop[n - 1]].to == b->sides[b->loop[0]].from);
    return n;
}

/* Returns twice the area inside the loop. Coordinates are relative to its first node to avoid cancellation. */
static double area_of(const struct builder *b, int64_t n)
{
    struct tri_grid_point origin, p, q;
    double area2 = 0;
    b->grid->point(b->grid->user, b->sides[b->loop[0]].from, &origin);
    for (int64_t i = 0; i < n; i++) {
        b->grid->point(b->grid->user, b->sides[b->loop[i]].from, &p);
        b->grid->point(b->grid->user, b->sides[b->loop[i]].to, &q);
        area2 += (p.at[0] - origin.at[0]) * (q.at[1] - origin.at[1]) -
                 (q.at[0] - origin.at[0]) * (p.at[1] - origin.at[1]);
    }
    return area2;
}

/* Returns where a loop of n sides can be cut: after a side with a different marker; n: nowhere. */
static int64_t first_cut(const struct builder *b, int64_t n)
{
    for (int64_t i = 0; i < n; i++)
        if (b->sides[b->loop[i]].marker != b->sides[b->loop[(i + n - 1) % n]].marker)
            return i;
    return n;
}

static void add_piece(struct builder *b, bool outer, int32_t marker, bool closed)
{
    struct tri_boundary *boundary = b->boundary;
    boundary->pieces[boundary->n_pieces++] = (struct tri_boundary_piece){b->n_nodes, 0, marker, closed, outer};
}

static void add_node(struct builder *b, int64_t node)
{
    b->boundary->nodes[b->n_nodes++] = node;
    b->boundary->pieces[b->boundary->n_pieces - 1].n++;
}

static void add_loop(struct builder *b, int64_t n)
{
    int64_t cut = first_cut(b, n);
    bool closed = cut == n, outer = area_of(b, n) > 0;
    for (int64_t i = 0; i < n; i++) {
        const struct side *side = &b->sides[b->loop[(cut + i) % n]];
        const struct side *before = &b->sides[b->loop[(cut + i + n - 1) % n]];
        if (i == 0 || side->marker != before->marker) {
            if (i > 0)
                add_node(b, side->from);
            add_piece(b, outer, side->marker, closed);
        }
        add_node(b, side->from);
    }
    if (!closed)
        add_node(b, b->sides[b->loop[cut]].from);
}

enum tri_status tri_boundary_make(struct tri_boundary *boundary, const struct tri_grid *grid, struct tri_error *error)
{
    struct builder b = {.grid = grid, .n = 2 * grid->n_segments, .boundary = boundary};
    const size_t n = (size_t)b.n + 1;
    b.sides = malloc(n * sizeof *b.sides);
    b.loop = malloc(n * sizeof *b.loop);
    *boundary = (struct tri_boundary){0, malloc(n * sizeof *boundary->pieces), malloc(2 * n * sizeof *boundary->nodes)};
    const bool enough = b.sides && b.loop && boundary->pieces && boundary->nodes && list_sides(&b);
    for (int64_t i = 0; enough && i < b.n; i++)
        if (!b.sides[i].used)
            add_loop(&b, walk(&b, i));
    free(b.sides);
    free(b.loop);
    return enough ? TRI_OK : tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the boundary");
}

void tri_boundary_free(struct tri_boundary *boundary)
{
    free(boundary->pieces);
    free(boundary->nodes);
    *boundary = (struct tri_boundary){0};
}
