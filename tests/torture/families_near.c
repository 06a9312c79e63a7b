/* Near-degenerate figures: points within a few ulps of a segment, segments that overlap up to rounding, crossings close
 * to each other, circles through many points. */
#include "tests/torture/families.h"

/* Random points in a box of the given size. */
static void scatter(struct figure *f, int32_t n, double size)
{
    for (int32_t i = 0; i < n; i++)
        figure_draw_point(f, 0, size);
}

static void connect(struct figure *f, int32_t segments)
{
    for (int32_t i = 0; i < segments; i++)
        figure_draw_segment(f, 0, f->pslg.n_points - 1);
}

/* Sometimes adds a box around the figure. */
static void enclose(struct figure *f)
{
    struct figure_bounds b = figure_bounds(&f->pslg);
    double width = b.high[0] - b.low[0], height = b.high[1] - b.low[1], margin = 0.1 * (width + height);
    if (figure_chance(f, 0.5))
        figure_box(f, b.low[0] - margin, b.low[1] - margin, width + 2 * margin, height + 2 * margin);
}

static void make_cocircular(struct figure *f)
{
    static const double legs[][2] = {{65, 0},  {63, 16}, {60, 25}, {56, 33}, {52, 39},
                                     {39, 52}, {33, 56}, {25, 60}, {16, 63}};
    int32_t rings = figure_size(f, 1, 3), n = figure_whole(f, 4, 36);
    for (int32_t r = 1; r <= rings; r++) {
        for (int32_t i = 0; i < n; i++) {
            const double *leg = legs[figure_whole(f, 0, 8)];
            double x = leg[0] * r, y = leg[1] * r;
            int32_t quarter = figure_whole(f, 0, 3);
            figure_point(f, quarter & 1 ? -x : x, quarter & 2 ? -y : y);
        }
    }
    if (figure_chance(f, 0.3))
        figure_point(f, 0, 0);
    connect(f, figure_size(f, 0, 15));
    enclose(f);
}

static void make_lattice(struct figure *f)
{
    int32_t n = figure_size(f, 4, 60), m = figure_whole(f, 2, 8);
    for (int32_t i = 0; i < n; i++) {
        struct tri_point p = figure_draw(f, 0, m);
        figure_point(f, figure_round(p.x, 1), figure_round(p.y, 1));
    }
    connect(f, figure_size(f, 0, 30));
}

/* Points a few ulps away from segments. */
static void make_near_segment(struct figure *f)
{
    int32_t lines = figure_size(f, 1, 8), n = figure_size(f, 1, 30);
    scatter(f, 2 * lines, figure_power(f, -2, 4));
    for (int32_t i = 0; i < lines; i++)
        figure_segment(f, 2 * i, 2 * i + 1);
    for (int32_t i = 0; i < n; i++) {
        int32_t line = figure_whole(f, 0, lines - 1);
        struct tri_point p = figure_along(f, 2 * line, 2 * line + 1, figure_real(f, 0, 1));
        int32_t right = figure_whole(f, -3, 3), up = figure_whole(f, -3, 3);
        figure_point(f, figure_ulps(p.x, right), figure_ulps(p.y, up));
    }
    if (figure_chance(f, 0.5))
        connect(f, figure_size(f, 1, 10));
    enclose(f);
}

/* Segments on one line, as exactly as rounding allows, and others that cross them. */
static void make_overlaps(struct figure *f)
{
    int32_t lines = figure_size(f, 1, 4);
    double size = figure_power(f, -1, 2), unit = figure_chance(f, 0.5) ? figure_ten_to(figure_whole(f, -3, -1)) : 0;
    for (int32_t k = 0; k < lines; k++) {
        int32_t first = f->pslg.n_points, n = figure_whole(f, 3, 8);
        scatter(f, 2, size);
        for (int32_t i = 2; i < n; i++) {
            struct tri_point p = figure_along(f, first, first + 1, figure_real(f, -0.2, 1.2));
            figure_point(f, unit > 0 ? figure_round(p.x, unit) : p.x, unit > 0 ? figure_round(p.y, unit) : p.y);
        }
        for (int32_t i = figure_whole(f, 2, 6); i > 0; i--)
            figure_draw_segment(f, first, first + n - 1);
    }
    int32_t first = f->pslg.n_points, crossing = figure_size(f, 1, 6);
    scatter(f, 2 * crossing, size);
    for (int32_t i = 0; i < crossing; i++)
        figure_segment(f, first + 2 * i, first + 2 * i + 1);
    enclose(f);
}

static void make_collinear(struct figure *f)
{
    int32_t n = figure_size(f, 4, 60), noise = figure_size(f, 0, 20);
    double slope = figure_real(f, -3, 3), shift = figure_real(f, -1, 1), size = figure_power(f, -1, 3);
    for (int32_t i = 0; i < n; i++) {
        double x = figure_real(f, 0, size);
        figure_point(f, x, figure_ulps(slope * x + shift, figure_whole(f, -noise, noise)));
    }
    scatter(f, figure_size(f, 0, 4), size);
    connect(f, figure_size(f, 1, 30));
    enclose(f);
}

static void make_decimals(struct figure *f, double unit)
{
    int32_t n = figure_size(f, 5, 50);
    double size = figure_chance(f, 0.5) ? 10 : 100;
    for (int32_t i = 0; i < n; i++) {
        struct tri_point p = figure_draw(f, 0, size);
        figure_point(f, figure_round(p.x, unit), figure_round(p.y, unit));
    }
    connect(f, figure_size(f, 2, 60));
    enclose(f);
}

static void make_one_decimal(struct figure *f) { make_decimals(f, 0.1); }
static void make_two_decimals(struct figure *f) { make_decimals(f, 0.01); }

static void make_rotated_grid(struct figure *f)
{
    int32_t n = figure_whole(f, 2, 9), m = figure_whole(f, 2, 9);
    struct tri_point turn = figure_on_circle(figure_real(f, 0, 1));
    double step = figure_chance(f, 0.5) ? 1 : figure_real(f, 0.1, 3);
    for (int32_t j = 0; j <= m; j++)
        for (int32_t i = 0; i <= n; i++)
            figure_point(f, step * (turn.x * i - turn.y * j), step * (turn.y * i + turn.x * j));
    for (int32_t k = figure_whole(f, 1, 20); k > 0; k--) {
        int32_t row = figure_whole(f, 0, m), from = figure_whole(f, 0, n), to = figure_whole(f, 0, n);
        figure_segment(f, row * (n + 1) + from, row * (n + 1) + to);
        int32_t column = figure_whole(f, 0, n), low = figure_whole(f, 0, m), high = figure_whole(f, 0, m);
        figure_segment(f, low * (n + 1) + column, high * (n + 1) + column);
    }
    if (figure_chance(f, 0.5)) /* diagonals pass through many points */
        connect(f, figure_size(f, 1, 12));
    enclose(f);
}

static void make_crossings(struct figure *f)
{
    int32_t n = figure_size(f, 3, 40);
    scatter(f, 2 * n, figure_power(f, -1, 3));
    for (int32_t i = 0; i < n; i++)
        figure_segment(f, 2 * i, 2 * i + 1);
    enclose(f);
}

/* Bars across bars, without vertices at their crossings. Sometimes several crossings fall onto one place. */
static void make_crossing_grid(struct figure *f)
{
    int32_t n = figure_size(f, 2, 15), m = figure_size(f, 2, 15);
    struct tri_point turn = figure_on_circle(figure_chance(f, 0.3) ? 0 : figure_real(f, 0, 1));
    double step = figure_chance(f, 0.3) ? figure_ten_to(figure_whole(f, -16, -3)) : 1;
    for (int32_t i = 0; i < n + m; i++) {
        double along = step * (i < n ? i : i - n) + 0.5, from = -1, to = 20 * fmax(step, 0.1);
        struct tri_point a = i < n ? (struct tri_point){along, from} : (struct tri_point){from, along};
        struct tri_point b = i < n ? (struct tri_point){along, to} : (struct tri_point){to, along};
        int32_t first = figure_point(f, turn.x * a.x - turn.y * a.y, turn.y * a.x + turn.x * a.y);
        figure_point(f, turn.x * b.x - turn.y * b.y, turn.y * b.x + turn.x * b.y);
        figure_segment(f, first, first + 1);
    }
}

/* Ends of segments that lie on other segments, up to rounding. */
static void make_t_junctions(struct figure *f)
{
    int32_t n = figure_size(f, 2, 30);
    double size = figure_power(f, -1, 3);
    figure_box(f, 0, 0, size, size * figure_real(f, 0.2, 2));
    for (int32_t i = 0; i < n; i++) {
        int32_t ends[2];
        for (int k = 0; k < 2; k++) {
            int32_t s = figure_whole(f, 0, f->pslg.n_segments - 1);
            const int32_t *v = f->pslg.segments + 2 * (size_t)s;
            struct tri_point p = figure_along(f, v[0], v[1], figure_real(f, 0, 1));
            ends[k] = figure_point(f, p.x, p.y);
        }
        figure_segment(f, ends[0], ends[1]);
    }
}

static void make_duplicates(struct figure *f)
{
    int32_t n = figure_size(f, 4, 30);
    scatter(f, n, 10);
    for (int32_t i = figure_whole(f, 1, n); i > 0; i--) {
        struct tri_point p = figure_at(f, figure_whole(f, 0, f->pslg.n_points - 1));
        bool same = figure_chance(f, 0.7);
        figure_point(f, same ? p.x : figure_ulps(p.x, 1), same ? p.y : figure_ulps(p.y, figure_whole(f, -1, 1)));
    }
    connect(f, figure_size(f, 3, 30));
    for (int32_t i = figure_whole(f, 0, 5); i > 0; i--) { /* duplicated, reversed, of length zero */
        const int32_t *v = f->pslg.segments + 2 * (size_t)figure_whole(f, 0, f->pslg.n_segments - 1);
        int32_t a = v[0], b = v[1];
        figure_segment(f, b, figure_chance(f, 0.8) ? a : b);
    }
    enclose(f);
}

/* Lines through one point, as exactly as rounding allows. */
static void make_concurrent(struct figure *f)
{
    int32_t n = figure_size(f, 3, 25);
    double x = figure_real(f, 0, 10), y = figure_real(f, 0, 10), near = figure_chance(f, 0.5) ? 0 : 1e-15;
    if (figure_chance(f, 0.3))
        figure_point(f, x, y);
    for (int32_t i = 0; i < n; i++) {
        struct tri_point p = figure_on_circle(figure_real(f, 0, 1));
        double a = figure_real(f, 0.5, 5), b = figure_real(f, 0.5, 5), off = figure_real(f, -near, near);
        int32_t first = figure_point(f, x + a * p.x + off, y + a * p.y);
        figure_point(f, x - b * p.x + off, y - b * p.y);
        figure_segment(f, first, first + 1);
    }
    enclose(f);
}

/* A bundle of segments whose ends nearly coincide on each side. */
static void make_bundle(struct figure *f)
{
    int32_t n = figure_size(f, 2, 20);
    double width = figure_ten_to(figure_whole(f, -17, -6)), length = figure_power(f, -1, 2);
    for (int32_t i = 0; i < n; i++) {
        int32_t first = figure_draw_point(f, 1, 1 + width);
        struct tri_point end = figure_draw(f, 0, width);
        figure_point(f, 1 + length + end.x, 2 + end.y);
        figure_segment(f, first, first + 1);
    }
    if (figure_chance(f, 0.5))
        connect(f, figure_size(f, 1, 6));
    figure_box(f, -length, -length, 4 * length, 4 * length);
}

/* A large offset, which leaves few digits for the figure. */
static void make_offset(struct figure *f)
{
    int32_t n = figure_size(f, 4, 30), exponent = figure_whole(f, 10, 15);
    double x = figure_power(f, exponent, exponent), y = figure_power(f, exponent - figure_whole(f, 0, 3), exponent);
    double size = figure_power(f, exponent - 15, exponent - 12);
    for (int32_t i = 0; i < n; i++)
        figure_draw_point(f, 0, size);
    for (int32_t i = 0; i < n; i++) {
        f->pslg.points[2 * (size_t)i] += x;
        f->pslg.points[2 * (size_t)i + 1] += y;
    }
    connect(f, figure_size(f, 2, 20));
    enclose(f);
}

/* A subdivided chain, and the straight segment between its ends. */
static void make_chords(struct figure *f)
{
    int32_t chains = figure_size(f, 1, 5);
    double size = figure_power(f, -1, 3);
    for (int32_t k = 0; k < chains; k++) {
        int32_t first = f->pslg.n_points, n = figure_size(f, 2, 12);
        scatter(f, 2, size);
        for (int32_t i = 1; i < n; i++) {
            struct tri_point p = figure_along(f, first, first + 1, (double)i / n);
            figure_point(f, p.x, figure_ulps(p.y, figure_whole(f, -2, 2)));
        }
        figure_segment(f, first, first + 1);
        int32_t from = first;
        for (int32_t i = 2; i <= n; from = first + i, i++)
            figure_segment(f, from, first + i);
        figure_segment(f, from, first + 1);
    }
    connect(f, figure_size(f, 0, 4));
    enclose(f);
}

const struct family families_near[] = {
    {"cocircular", make_cocircular, 1, true, false},
    {"lattice", make_lattice, 1, true, false},
    {"near_segment", make_near_segment, 1, true, false},
    {"overlaps", make_overlaps, 1.5, true, false},
    {"collinear", make_collinear, 1, true, false},
    {"one_decimal", make_one_decimal, 1, true, true},
    {"two_decimals", make_two_decimals, 1, true, true},
    {"rotated_grid", make_rotated_grid, 1, true, false},
    {"crossings", make_crossings, 1, true, false},
    {"crossing_grid", make_crossing_grid, 1, true, false},
    {"t_junctions", make_t_junctions, 1, true, false},
    {"duplicates", make_duplicates, 1, true, false},
    {"concurrent", make_concurrent, 1, true, false},
    {"bundle", make_bundle, 1, true, false},
    {"offset", make_offset, 1, true, true},
    {"chords", make_chords, 1, true, false},
    {0},
};
