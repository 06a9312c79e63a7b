/* Figures that are hard to mesh: small angles, thin gaps, many holes, very different sizes. */
#include "tests/torture/families.h"

/* An angle of 1e-12 to 10 degrees, as a wedge in a box or as a separate triangle. */
static void make_tiny_angle(struct figure *f)
{
    int32_t wedges = figure_size(f, 1, 4);
    for (int32_t i = 0; i < wedges; i++) {
        double angle = figure_power(f, -12, 0) / 360, turn = figure_real(f, 0, 1), length = figure_real(f, 0.2, 3);
        double x = figure_real(f, 0, 10), y = figure_real(f, 0, 10);
        struct tri_point p = figure_on_circle(turn), q = figure_on_circle(turn + angle);
        int32_t apex = figure_point(f, x, y);
        figure_point(f, x + length * p.x, y + length * p.y);
        length *= figure_chance(f, 0.5) ? 1 : figure_real(f, 0.5, 2);
        figure_point(f, x + length * q.x, y + length * q.y);
        figure_segment(f, apex, apex + 1);
        figure_segment(f, apex, apex + 2);
        if (figure_chance(f, 0.5))
            figure_segment(f, apex + 1, apex + 2);
    }
    if (wedges > 1 || figure_chance(f, 0.5))
        figure_box(f, -4, -4, 18, 18);
}

/* A polygon with thin spikes. */
static void make_needles(struct figure *f)
{
    int32_t n = figure_size(f, 1, 12), first = f->pslg.n_points;
    double width = figure_power(f, -9, -2);
    figure_point(f, 0, 0);
    for (int32_t i = 0; i < n; i++) {
        double x = 1 + i + figure_real(f, 0, 0.5), length = figure_real(f, 1, 20), slant = figure_real(f, -2, 2);
        figure_point(f, x, 0);
        figure_point(f, x + width / 2 + slant, -length);
        figure_point(f, x + width, 0);
    }
    figure_point(f, n + 2, 0);
    figure_point(f, n + 2, 3);
    figure_point(f, 0, 3);
    figure_loop(f, first, f->pslg.n_points - first);
    if (figure_chance(f, 0.5))
        figure_box(f, -30, -30, 60 + n, 60);
}

static void make_comb(struct figure *f)
{
    int32_t n = figure_size(f, 2, 60), first = f->pslg.n_points;
    double gap = figure_power(f, -6, -1) / 10, tooth = figure_real(f, 0.1, 2), length = figure_power(f, -1, 1);
    for (int32_t i = 0; i < n; i++) {
        double x = i * (tooth + gap);
        figure_point(f, x, 0);
        figure_point(f, x, length);
        figure_point(f, x + tooth, length);
        figure_point(f, x + tooth, 0);
    }
    figure_point(f, n * (tooth + gap), -1);
    figure_point(f, -gap, -1);
    figure_loop(f, first, f->pslg.n_points - first);
}

/* Segments from one point to many. */
static void make_hub(struct figure *f)
{
    int32_t hubs = figure_size(f, 1, 3);
    for (int32_t k = 0; k < hubs; k++) {
        int32_t n = figure_size(f, 3, 100);
        double x = figure_real(f, 0, 10), y = figure_real(f, 0, 10), span = figure_chance(f, 0.3) ? 0.01 : 1;
        int32_t hub = figure_point(f, x, y);
        for (int32_t i = 0; i < n; i++) {
            struct tri_point p = figure_on_circle(figure_real(f, 0, span));
            double length = figure_real(f, 0.5, 5);
            figure_segment(f, hub, figure_point(f, x + length * p.x, y + length * p.y));
        }
    }
    if (figure_chance(f, 0.5))
        figure_box(f, -6, -6, 22, 22);
}

static void make_star(struct figure *f)
{
    int32_t n = figure_size(f, 5, 120), first = f->pslg.n_points;
    double inner = figure_power(f, -3, -1) / 10;
    for (int32_t i = 0; i < 2 * n; i++) {
        struct tri_point p = figure_on_circle(0.5 * i / n);
        double r = i & 1 ? inner : figure_real(f, 0.5, 1);
        figure_point(f, r * p.x, r * p.y);
    }
    figure_loop(f, first, 2 * n);
    if (figure_chance(f, 0.3))
        figure_box(f, -2, -2, 4, 4);
}

/* A hub whose segments end on a chain. */
static void make_fan(struct figure *f)
{
    int32_t n = figure_size(f, 3, 60);
    double span = figure_power(f, -3, -1) / 10;
    int32_t hub = figure_point(f, 0, 0), first = f->pslg.n_points;
    for (int32_t i = 0; i <= n; i++) {
        struct tri_point p = figure_on_circle(span * i / n);
        double r = figure_chance(f, 0.2) ? figure_real(f, 0.5, 1.5) : 1;
        figure_point(f, r * p.x, r * p.y);
        figure_segment(f, hub, first + i);
    }
    if (figure_chance(f, 0.8))
        figure_path(f, first, n + 1);
}

static void make_nested_rings(struct figure *f)
{
    int32_t rings = figure_size(f, 2, 12), n = figure_whole(f, 3, 40);
    double r = 1, ratio = figure_chance(f, 0.5) ? figure_real(f, 0.5, 0.95) : 1 - figure_power(f, -6, -2);
    for (int32_t i = 0; i < rings; i++, r *= ratio) {
        figure_ring(f, 0, 0, r, figure_chance(f, 0.7) ? n : figure_whole(f, 3, 60));
        struct tri_point p = figure_on_circle(figure_real(f, 0, 1));
        if (figure_chance(f, 0.2))
            figure_hole(f, r * 0.999 * p.x, r * 0.999 * p.y);
        if (figure_chance(f, 0.3))
            figure_region(f, r * (1 + ratio) / 2 * p.x, r * (1 + ratio) / 2 * p.y, i, 0.01);
    }
    if (figure_chance(f, 0.3))
        figure_hole(f, 0, 0);
}

static void make_holes(struct figure *f)
{
    int32_t n = figure_chance(f, 0.05) ? figure_whole(f, 30, 55) : figure_size(f, 1, 12);
    int32_t corners = figure_whole(f, 3, 6);
    figure_box(f, -1, -1, n + 1, n + 1);
    for (int32_t j = 0; j < n; j++) {
        for (int32_t i = 0; i < n; i++) {
            double r = figure_chance(f, 0.9) ? figure_real(f, 0.1, 0.45) : 0.5 - figure_power(f, -12, -3);
            figure_ring(f, i, j, r, corners);
            if (figure_chance(f, 0.9))
                figure_hole(f, i + figure_real(f, -0.01, 0.01), j);
        }
    }
}

/* Two borders opposite each other across a tiny gap. */
static void make_thin_gap(struct figure *f)
{
    int32_t n = figure_size(f, 1, 25), first = f->pslg.n_points;
    double gap = figure_power(f, -12, -2), length = figure_power(f, 0, 1);
    for (int32_t i = 0; i <= n; i++)
        figure_point(f, length * i / n, figure_chance(f, 0.3) ? figure_real(f, 0, gap / 4) : 0);
    figure_path(f, first, n + 1);
    int32_t second = f->pslg.n_points;
    for (int32_t i = 0; i <= n; i++)
        figure_point(f, length * i / n + figure_real(f, 0, 0.1), gap);
    figure_path(f, second, n + 1);
    if (figure_chance(f, 0.5)) {
        figure_segment(f, first, second);
        figure_segment(f, first + n, second + n);
    }
    if (figure_chance(f, 0.7))
        figure_box(f, -1, -1, length + 2, 2 + gap);
}

static void make_zigzag(struct figure *f)
{
    int32_t n = figure_size(f, 3, 150), first = f->pslg.n_points;
    double height = figure_power(f, -3, 1), taper = figure_chance(f, 0.3) ? figure_real(f, 0.8, 1) : 1;
    for (int32_t i = 0; i < n; i++, height *= taper)
        figure_point(f, 0.1 * i, i & 1 ? height : 0);
    figure_path(f, first, n);
    if (figure_chance(f, 0.6))
        figure_box(f, -1, -1, 0.1 * n + 2, 14);
}

/* Midpoints that are displaced repeatedly. */
static void make_coast(struct figure *f)
{
    enum { MOST = 1 << 9 };
    double x[MOST], y[MOST], rough = figure_real(f, 0.2, 0.7);
    int32_t n = 4;
    x[0] = 0, y[0] = 0, x[1] = 1, y[1] = 0, x[2] = 1, y[2] = 1, x[3] = 0, y[3] = 1;
    for (int32_t times = figure_whole(f, 1, 6); times > 0; times--, n *= 2) {
        for (int32_t i = n - 1; i >= 0; i--) {
            int32_t next = i + 1 < n ? 2 * i + 2 : 0;
            x[2 * i] = x[i], y[2 * i] = y[i];
            double dx = x[next] - x[2 * i], dy = y[next] - y[2 * i], shift = figure_real(f, -rough, rough);
            x[2 * i + 1] = x[2 * i] + 0.5 * dx - shift * dy;
            y[2 * i + 1] = y[2 * i] + 0.5 * dy + shift * dx;
        }
    }
    int32_t first = f->pslg.n_points;
    for (int32_t i = 0; i < n; i++)
        figure_point(f, x[i], y[i]);
    figure_loop(f, first, n);
    if (figure_chance(f, 0.4))
        figure_box(f, -2, -2, 5, 5);
}

static void make_spiral(struct figure *f)
{
    int32_t n = figure_size(f, 10, 300), first = f->pslg.n_points;
    double turns = figure_real(f, 0.5, 8), decay = figure_chance(f, 0.5) ? 1 : figure_real(f, 0.95, 0.999), r = 1;
    for (int32_t i = 0; i < n; i++, r *= decay) {
        struct tri_point p = figure_on_circle(turns * i / n);
        double radius = decay < 1 ? r : 1 - (double)i / n;
        figure_point(f, radius * p.x, radius * p.y);
    }
    figure_path(f, first, n);
    if (figure_chance(f, 0.6))
        figure_box(f, -2, -2, 4, 4);
}

/* Fine details at the origin of a large figure, where coordinates have more digits than elsewhere. */
static void make_mixed_scales(struct figure *f)
{
    double large = figure_power(f, 2, 6), ratio = figure_power(f, -12, -3);
    figure_box(f, 0, 0, large, large * figure_real(f, 0.3, 1));
    for (int32_t i = figure_size(f, 1, 8); i > 0; i--) {
        double size = large * ratio * figure_power(f, 0, 2), r = size / 10;
        double x = figure_chance(f, 0.7) ? r * 2 : figure_real(f, 0, large / 4);
        double y = figure_chance(f, 0.7) ? r * 2 + size * i : figure_real(f, 0, large / 4);
        figure_ring(f, x, y, r, figure_whole(f, 3, 12));
        if (figure_chance(f, 0.5))
            figure_hole(f, x, y);
    }
}

/* Ordinary figures at the ends of the range of floating-point numbers. */
static void make_scale(struct figure *f)
{
    int32_t exponent = figure_chance(f, 0.5) ? figure_whole(f, -300, 300) : figure_chance(f, 0.5) ? 300 : -300;
    double scale = figure_power(f, exponent, exponent);
    int32_t n = figure_size(f, 3, 30), first = f->pslg.n_points;
    for (int32_t i = 0; i < n; i++) {
        struct tri_point p = figure_on_circle((double)i / n);
        double r = figure_real(f, 0.3, 1) * scale;
        figure_point(f, r * p.x, r * p.y);
    }
    figure_loop(f, first, n);
    if (figure_chance(f, 0.3))
        figure_point(f, figure_real(f, -0.2, 0.2) * scale, 3e-280);
    if (figure_chance(f, 0.4))
        figure_region(f, 0, 0, 3, 0);
    if (figure_chance(f, 0.2))
        figure_hole(f, 0.9 * scale, 0.9 * scale);
}

/* Hole and region points far outside and just outside. */
static void make_far_points(struct figure *f)
{
    double size = figure_power(f, figure_chance(f, 0.3) ? -200 : -3, 3);
    figure_box(f, 0, 0, size, size);
    figure_ring(f, size / 2, size / 2, size / 4, figure_whole(f, 3, 9));
    for (int32_t i = figure_size(f, 1, 5); i > 0; i--) {
        double x = figure_power(f, -20, 300), y = figure_power(f, -300, 300);
        x = figure_chance(f, 0.5) ? x : -x;
        y = figure_chance(f, 0.3) ? size / 2 : y;
        if (figure_chance(f, 0.5))
            figure_hole(f, size + x, y);
        else
            figure_region(f, size + x, y, i, figure_chance(f, 0.5) ? size * size / 100 : 0);
    }
    if (figure_chance(f, 0.5))
        figure_hole(f, size / 2, size / 2);
}

/* Two curves that bulge towards each other. */
static void make_parabolas(struct figure *f)
{
    int32_t n = figure_size(f, 5, 120);
    double gap = figure_power(f, -8, -1), bulge = figure_power(f, -4, 0);
    for (int k = 0; k < 2; k++) {
        int32_t first = f->pslg.n_points;
        for (int32_t i = 0; i <= n; i++) {
            double x = 2.0 * i / n - 1;
            figure_point(f, x, k == 0 ? -gap - bulge * x * x : gap + bulge * x * x);
        }
        figure_path(f, first, n + 1);
    }
    if (figure_chance(f, 0.5))
        figure_box(f, -2, -3 * bulge - 1, 4, 6 * bulge + 2);
}

/* Points that approach a corner in decreasing steps. */
static void make_graded(struct figure *f)
{
    int32_t n = figure_size(f, 4, 60);
    double ratio = figure_real(f, 0.3, 0.9), x = 1;
    figure_box(f, 0, 0, 1, 1);
    for (int32_t i = 0; i < n; i++, x *= ratio)
        figure_draw_point(f, x / 2, x);
    for (int32_t i = figure_size(f, 0, 8); i > 0; i--)
        figure_draw_segment(f, 4, 3 + n);
}

static void make_points(struct figure *f)
{
    int32_t n = figure_size(f, 3, 400);
    bool clustered = figure_chance(f, 0.5);
    for (int32_t i = 0; i < n; i++) {
        double r = clustered ? figure_power(f, -6, -1) : 1;
        figure_draw_point(f, -r, r);
    }
    if (figure_chance(f, 0.5))
        figure_box(f, -1.5, -1.5, 3, 3);
}

const struct family families_shape[] = {
    {"tiny_angle", make_tiny_angle, 1, false, false},
    {"needles", make_needles, 1, false, false},
    {"comb", make_comb, 1, false, false},
    {"hub", make_hub, 1, false, false},
    {"star", make_star, 1, false, false},
    {"fan", make_fan, 1, false, false},
    {"nested_rings", make_nested_rings, 1, false, false},
    {"holes", make_holes, 0.7, false, false},
    {"thin_gap", make_thin_gap, 1, false, false},
    {"zigzag", make_zigzag, 1, false, false},
    {"coast", make_coast, 1, false, false},
    {"spiral", make_spiral, 1, false, false},
    {"mixed_scales", make_mixed_scales, 1, false, false},
    {"scale", make_scale, 1, false, true},
    {"far_points", make_far_points, 0.7, false, true},
    {"parabolas", make_parabolas, 1, false, false},
    {"graded", make_graded, 1, false, false},
    {"points", make_points, 1, false, false},
    {0},
};
