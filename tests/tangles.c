/* See the header. A generator receives a tangle with ROOM for points and segments, and fills it. */
#include "tangles.h"

enum { ROOM = 700 };

struct tangle {
    struct tri_pslg pslg;
    struct support_random random;
};

static double unit(struct tangle *t) { return support_unit(&t->random); }

static double between(struct tangle *t, double low, double high) { return low + (high - low) * unit(t); }

static int32_t below(struct tangle *t, int32_t n) { return support_below(&t->random, n); }

static int32_t add_point(struct tangle *t, double x, double y)
{
    assert_true(t->pslg.n_points < ROOM);
    return support_add_point(&t->pslg, x, y);
}

static void add_segment(struct tangle *t, int32_t a, int32_t b)
{
    assert_true(t->pslg.n_segments < ROOM);
    t->pslg.segment_markers[t->pslg.n_segments] = below(t, 3) ? 1 + below(t, 6) : 0;
    support_add_segment(&t->pslg, a, b);
}

static void add_random_segments(struct tangle *t, int32_t n)
{
    for (int32_t i = 0; i < n; i++) {
        int32_t a = below(t, t->pslg.n_points), b = below(t, t->pslg.n_points);
        add_segment(t, a, b);
    }
}

static void add_random_points(struct tangle *t, int32_t n, double low, double high)
{
    for (int32_t i = 0; i < n; i++) {
        double x = between(t, low, high), y = between(t, low, high);
        add_point(t, x, y);
    }
}

/* A rounded point of the unit circle. Rotations about it are exact up to rounding. */
static struct tri_point direction(struct tangle *t)
{
    double s = between(t, -1, 1), square = s * s, turn = below(t, 2) ? 1 : -1;
    return (struct tri_point){turn * (1 - square) / (1 + square), turn * 2 * s / (1 + square)};
}

/* The rounded point at the given fraction of the way from point a to point b. */
static struct tri_point part_way(const struct tangle *t, int32_t a, int32_t b, double fraction)
{
    const double *p = t->pslg.points + 2 * a, *q = t->pslg.points + 2 * b;
    return (struct tri_point){p[0] + fraction * (q[0] - p[0]), p[1] + fraction * (q[1] - p[1])};
}

static void decimals(struct tangle *t, double scale)
{
    int32_t n = 4 + below(t, 8), m = 2 + below(t, 10);
    for (int32_t i = 0; i < n; i++) {
        double x = floor(unit(t) * 3 * scale) / scale, y = floor(unit(t) * 3 * scale) / scale;
        add_point(t, x, y);
    }
    add_random_segments(t, m);
}

static void one_decimal(struct tangle *t) { decimals(t, 10); }

static void two_decimals(struct tangle *t) { decimals(t, 100); }

static void nearly_collinear(struct tangle *t)
{
    double x = unit(t), y = unit(t), dx = unit(t), dy = unit(t);
    for (int32_t n = 5 + below(t, 10); n > 0; n--) {
        double s = unit(t);
        add_point(t, x + s * dx, y + s * dy);
    }
    add_random_points(t, 3, 0, 2);
    add_random_segments(t, t->pslg.n_points);
}

static void turned_grid(struct tangle *t)
{
    struct tri_point d = direction(t);
    int32_t side = 3 + below(t, 4);
    double offset = below(t, 2) ? 0 : 100 * unit(t);
    for (int32_t i = 0; i < side; i++)
        for (int32_t j = 0; j < side; j++)
            add_point(t, offset + d.x * i - d.y * j, offset + d.y * i + d.x * j);
    add_random_segments(t, 3 * side);
}

/* Parts of one segment, up to rounding, and segments that cross them. */
static void overlaps(struct tangle *t)
{
    add_random_points(t, 2, 0, 10);
    for (int32_t n = 2 + below(t, 4); n > 0; n--) {
        struct tri_point p = part_way(t, 0, 1, unit(t));
        add_point(t, p.x, p.y);
    }
    int32_t on_line = t->pslg.n_points;
    add_segment(t, 0, 1);
    for (int32_t i = 2; i < on_line; i++)
        add_segment(t, i, below(t, on_line));
    for (int i = 0; i < 4; i++) {
        add_random_points(t, 2, 0, 10);
        add_segment(t, t->pslg.n_points - 2, t->pslg.n_points - 1);
    }
}

/* Coordinates from 2^10 to 2^52. At the upper end only a handful of positions exist. */
static void far_away(struct tangle *t)
{
    double offset = ldexp(1, 10 + below(t, 43));
    int32_t n = 6 + below(t, 10);
    add_random_points(t, n, offset, offset + 8);
    add_random_segments(t, n);
}

static void ulps_around_a_line(struct tangle *t)
{
    double slope = unit(t);
    for (int32_t n = 6 + below(t, 12); n > 0; n--) {
        double s = unit(t), y = 0.5 + s * slope;
        for (int32_t ulps = below(t, 7); ulps > 0; ulps--)
            y = nextafter(y, 9);
        add_point(t, 0.5 + s, y);
    }
    add_random_points(t, 4, 0, 2);
    add_random_segments(t, t->pslg.n_points);
}

/* Long segments that pass a small figure at the origin, where coordinates are much finer than at their ends. */
static void mixed_scales(struct tangle *t)
{
    double size = ldexp(1, -below(t, 60));
    add_point(t, -1000, -1000 * unit(t));
    add_point(t, 1000 * unit(t), 1000);
    add_point(t, -500, 700 * unit(t));
    add_point(t, 900, -800 * unit(t));
    add_random_points(t, 4 + below(t, 10), -0.5 * size, 0.5 * size);
    add_random_segments(t, t->pslg.n_points + 2);
}

static void star(struct tangle *t)
{
    double x = 5 * unit(t), y = 5 * unit(t);
    for (int32_t n = 3 + below(t, 8); n > 0; n--) {
        struct tri_point d = direction(t);
        double radius = between(t, 1, 4);
        int32_t from = add_point(t, x + radius * d.x, y + radius * d.y);
        add_segment(t, from, add_point(t, x - radius * d.x, y - radius * d.y));
    }
}

static void random_segments(struct tangle *t)
{
    add_random_points(t, 20 + below(t, 40), 0, 1);
    add_random_segments(t, t->pslg.n_points);
}

/* A polygon, and another with corners on the first one's sides, rounded to a grid: an overlay of two maps. */
static void rounded_copy(struct tangle *t)
{
    int32_t n = 5 + below(t, 15);
    double grid = ldexp(1, 20 + below(t, 30));
    for (int32_t i = 0; i < n; i++) {
        struct tri_point d = direction(t);
        double radius = between(t, 1, 2);
        add_point(t, 3 + radius * d.x, 3 + radius * d.y);
    }
    for (int32_t i = 0; i < n; i++) {
        struct tri_point p = part_way(t, i, (i + 1) % n, unit(t));
        add_point(t, floor(p.x * grid) / grid, floor(p.y * grid) / grid);
    }
    for (int32_t i = 0; i < n; i++) {
        add_segment(t, i, (i + 1) % n);
        add_segment(t, n + i, n + (i + 1) % n);
    }
}

/* A long segment crossed by hundreds of others, which rarely cross each other. */
static void many_across(struct tangle *t)
{
    add_point(t, -3, -1 - unit(t));
    add_point(t, 5, 1 + unit(t));
    add_segment(t, 0, 1);
    for (int32_t n = 20 + below(t, 300); n > 0; n--) {
        add_random_points(t, 2, -3, 5);
        double *last = t->pslg.points + 2 * (t->pslg.n_points - 2);
        last[2] = last[0] + between(t, -0.2, 0.2);
        last[1] = 1 + unit(t);
        last[3] = -1 - unit(t);
        add_segment(t, t->pslg.n_points - 2, t->pslg.n_points - 1);
    }
}

static const struct {
    const char *name;
    void (*fill)(struct tangle *);
} family[] = {
    {"one decimal", one_decimal},
    {"two decimals", two_decimals},
    {"nearly collinear", nearly_collinear},
    {"turned grid", turned_grid},
    {"overlaps", overlaps},
    {"far away", far_away},
    {"ulps around a line", ulps_around_a_line},
    {"mixed scales", mixed_scales},
    {"star", star},
    {"random segments", random_segments},
    {"rounded copy", rounded_copy},
    {"many across", many_across},
};

int tangles_families(void) { return (int)(sizeof family / sizeof *family); }

const char *tangles_name(int number) { return family[number].name; }

struct tri_pslg tangles_make(int number, uint64_t seed)
{
    struct tangle t = {support_pslg(ROOM, ROOM, 0, 0), {seed * (uint64_t)tangles_families() + (uint64_t)number}};
    t.pslg.segment_markers = calloc(ROOM, sizeof *t.pslg.segment_markers);
    assert_non_null(t.pslg.segment_markers);
    family[number].fill(&t);
    return t.pslg;
}
