/* Hilbert keys, and sorting by them.
 *
 * The key is computed by descending the quadtree from the largest cell. One of four orientations describes the order of
 * the curve in the four quadrants (table below). */
#include "triangle/geometry/hilbert.h"

#include <assert.h>

#include "triangle/base/ids.h"
#include "triangle/base/radix.h"

/* An item to sort is the cell of a point and its id. Points of one cell are sorted along a curve over their own
 * bounding box or, if there are at most FEW, by coordinates. */
enum { BITS = 18, ID_BITS = 28, FEW = 16 };

_Static_assert(2 * BITS + ID_BITS == 64 && INT64_C(1) << ID_BITS == TRI_MAX_VERTICES, "cell and id fill an item");

/* Two levels in one step: [orientation][4 * two bits of x + two bits of y] is 4 * (ranks of the two quadrants on the
 * curve, 2 bits each) + the orientation inside. Derived from single levels: in orientations 0 to 3 the quadrants 2 * x
 * bit + y bit have ranks 0132, 0312, 2310, 2130 and orientations 1030, 0211, 2123, 3302. */
static const uint8_t two_levels[4][16] = {
    {0, 14, 17, 20, 5, 9, 31, 24, 59, 55, 33, 36, 60, 50, 47, 40},
    {1, 4, 58, 61, 15, 8, 54, 51, 16, 30, 32, 46, 21, 25, 37, 41},
    {42, 45, 48, 62, 38, 35, 53, 57, 26, 29, 11, 7, 22, 19, 12, 2},
    {43, 39, 27, 23, 44, 34, 28, 18, 49, 52, 10, 13, 63, 56, 6, 3}};

/* Returns the rank of cell x, y on the curve through 2^bits x 2^bits cells; bits is even. */
static uint64_t hilbert_of(uint32_t x, uint32_t y, int bits)
{
    assert(x >> bits == 0 && y >> bits == 0);
    uint64_t key = 0;
    unsigned orientation = 0;
    for (int bit = bits - 2; bit >= 0; bit -= 2) {
        unsigned step = two_levels[orientation][4 * (x >> bit & 3) + (y >> bit & 3)];
        key = key << 4 | step >> 2;
        orientation = step & 3;
    }
    return key;
}

/* Four levels in one step: the same with four bits of x and y, and ranks of 8 bits. Made only if many points share the
 * cost. */
enum { MANY = 1024 };
typedef uint16_t four_levels[4][256];

static void make_four_levels(four_levels table)
{
    for (unsigned orientation = 0; orientation < 4; orientation++)
        for (unsigned x = 0; x < 16; x++)
            for (unsigned y = 0; y < 16; y++) {
                unsigned outer = two_levels[orientation][4 * (x >> 2) + (y >> 2)];
                unsigned inner = two_levels[outer & 3][4 * (x & 3) + (y & 3)];
                table[orientation][16 * x + y] = (uint16_t)((outer >> 2) << 6 | inner);
            }
}

/* The same as hilbert_of, by the table of four levels. */
static inline uint64_t hilbert_by_four(uint32_t x, uint32_t y, int bits, four_levels table)
{
    uint64_t key = 0;
    unsigned orientation = 0;
    for (; bits >= 4; bits -= 4) {
        unsigned step = table[orientation][16 * (x >> (bits - 4) & 15) + (y >> (bits - 4) & 15)];
        key = key << 8 | step >> 2;
        orientation = step & 3;
    }
    return bits ? key << 4 | two_levels[orientation][4 * (x & 3) + (y & 3)] >> 2 : key;
}

struct ordering {
    const struct tri_point *xy;
    int32_t *order;
    int32_t n;
    int bits;             /* 2^bits x 2^bits cells */
    struct tri_point low; /* lower left corner of the bounding box */
    double scale;         /* cells per unit of length */
    uint16_t (*table)[256]; /* four levels per step; NULL: too few points */
    uint64_t *item;
};

static void key_share(void *context, size_t share)
{
    const struct ordering *k = context;
    struct tri_range range = tri_share(share, k->n);
    for (int32_t i = range.first; i < range.last; i++) {
        struct tri_point p = k->xy[k->order[i]];
        uint32_t x = (uint32_t)((p.x - k->low.x) * k->scale), y = (uint32_t)((p.y - k->low.y) * k->scale);
        uint64_t key = k->table ? hilbert_by_four(x, y, k->bits, k->table) : hilbert_of(x, y, k->bits);
        k->item[i] = key << ID_BITS | (uint32_t)k->order[i];
    }
}

struct box {
    struct tri_point low, high;
};

static struct box box_around(struct box a, struct box b)
{
    return (struct box){{a.low.x < b.low.x ? a.low.x : b.low.x, a.low.y < b.low.y ? a.low.y : b.low.y},
                        {a.high.x > b.high.x ? a.high.x : b.high.x, a.high.y > b.high.y ? a.high.y : b.high.y}};
}

struct boxing {
    const struct tri_point *xy;
    const int32_t *order;
    int32_t n;
    struct box box[TRI_MOST_SHARES];
};

static void box_share(void *context, size_t share)
{
    struct boxing *b = context;
    struct tri_range range = tri_share(share, b->n);
    struct tri_point first = b->xy[b->order[range.first]];
    struct box box = {first, first};
    for (int32_t i = range.first + 1; i < range.last; i++) {
        struct tri_point p = b->xy[b->order[i]];
        box = box_around(box, (struct box){p, p});
    }
    b->box[share] = box;
}

static struct box box_of(const struct tri_point *xy, const int32_t *order, int32_t n,
                         const struct tri_executor *executor)
{
    struct boxing boxing = {xy, order, n, {{{0, 0}, {0, 0}}}};
    tri_execute(executor, tri_shares(n), box_share, &boxing);
    struct box box = boxing.box[0];
    for (size_t share = 1; share < tri_shares(n); share++)
        box = box_around(box, boxing.box[share]);
    return box;
}

/* A point with its id, to sort the points of one cell. */
struct placed {
    struct tri_point q;
    int32_t id;
};

static bool is_before(const struct placed *a, const struct placed *b)
{
    if (a->q.x != b->q.x)
        return a->q.x < b->q.x;
    return a->q.y != b->q.y ? a->q.y < b->q.y : a->id < b->id;
}

static void order_few(const struct tri_point *xy, int32_t *order, int32_t n)
{
    struct placed cell[FEW];
    assert(n <= FEW);
    for (int32_t i = 0; i < n; i++) {
        struct placed p = {xy[order[i]], order[i]};
        int32_t at = i;
        for (; at > 0 && is_before(&p, &cell[at - 1]); at--)
            cell[at] = cell[at - 1];
        cell[at] = p;
    }
    for (int32_t i = 0; i < n; i++)
        order[i] = cell[i].id;
}

static void order_points(const struct tri_point *xy, int32_t *order, int32_t n, bool coarse, uint64_t *item,
                         uint64_t *scratch, uint16_t (*table)[256], const struct tri_executor *executor);

/* Sorts cells with several points: by coordinates, or along a curve of their own. */
static void order_cells(const struct tri_point *xy, int32_t *order, int32_t n, bool coarse, uint64_t *item,
                        uint64_t *scratch, uint16_t (*table)[256], const struct tri_executor *executor)
{
    for (int32_t first = 0, end; first < n; first = end) {
        for (end = first + 1; end < n && item[end] >> ID_BITS == item[first] >> ID_BITS;)
            end++;
        if (end - first > FEW)
            order_points(xy, order + first, end - first, coarse, item + first, scratch + first, table,
                         executor);
        else if (end - first > 1)
            order_few(xy, order + first, end - first);
    }
}

/* Chooses at least two cells per point. */
static int coarse_bits(int32_t n)
{
    int bits = 2;
    while (bits < BITS && INT64_C(1) << 2 * bits < 2 * (int64_t)n)
        bits += 2;
    return bits;
}

static void emit_share(void *context, size_t share)
{
    const struct ordering *e = context;
    struct tri_range range = tri_share(share, e->n);
    for (int32_t i = range.first; i < range.last; i++)
        e->order[i] = (int32_t)(e->item[i] & ((UINT64_C(1) << ID_BITS) - 1));
}

static void order_points(const struct tri_point *xy, int32_t *order, int32_t n, bool coarse, uint64_t *item,
                         uint64_t *scratch, uint16_t (*table)[256], const struct tri_executor *executor)
{
    struct box box = box_of(xy, order, n, executor);
    double width = box.high.x - box.low.x, height = box.high.y - box.low.y, side = width > height ? width : height;
    int bits = coarse ? coarse_bits(n) : BITS;
    struct ordering ordering = {xy, order, n, bits, box.low, side > 0 ? ((1 << bits) - 1) / side : 0,
                                n < MANY ? NULL : table, item};
    tri_execute(executor, tri_shares(n), key_share, &ordering);
    tri_radix_sort(item, scratch, n, side > 0 ? ID_BITS : 0, side > 0 ? ID_BITS + 2 * bits : ID_BITS,
                   executor); /* all points equal: by id */
    tri_execute(executor, tri_shares(n), emit_share, &ordering);
    if (side > 0)
        order_cells(xy, order, n, coarse, item, scratch, table, executor);
}

static void order_all(const struct tri_point *xy, int32_t *order, int32_t n, bool coarse, uint64_t *scratch,
                      const struct tri_executor *executor)
{
    four_levels table;
    if (n >= MANY)
        make_four_levels(table);
    if (n > 0)
        order_points(xy, order, n, coarse, scratch, scratch + n, table, executor);
}

void tri_hilbert_order(const struct tri_point *xy, int32_t *order, int32_t n, uint64_t *scratch,
                       const struct tri_executor *executor)
{
    order_all(xy, order, n, false, scratch, executor);
}

void tri_hilbert_order_coarse(const struct tri_point *xy, int32_t *order, int32_t n, uint64_t *scratch)
{
    order_all(xy, order, n, true, scratch, NULL);
}
