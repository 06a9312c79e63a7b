/* Maps: polygons that cover the plane, with borders that are stored more than once. */
#include "tests/torture/families.h"

enum { MOST_CELLS = 8 };

static void add_layer(struct figure *f, double y, int32_t attribute)
{
    double x = figure_real(f, 1, 9), area = figure_chance(f, 0.6) ? figure_power(f, -2, 0) : 0;
    figure_region(f, x, y, attribute, area);
}

/* Layers of soil between wavy lines, each a region with its own area bound. */
static void make_layers(struct figure *f)
{
    int32_t layers = figure_size(f, 2, 8), n = figure_whole(f, 1, 12), before = -1;
    double thinnest = figure_power(f, -4, -1), y = 0;
    for (int32_t k = 0; k <= layers; k++) {
        int32_t first = f->pslg.n_points;
        double wave = k == 0 || k == layers ? 0 : thinnest / 3, height = fmax(thinnest, figure_real(f, 0, 1));
        for (int32_t i = 0; i <= n; i++)
            figure_point(f, 10.0 * i / n, y + figure_real(f, -wave, wave));
        figure_path(f, first, n + 1);
        if (before >= 0) {
            figure_segment(f, before, first);
            figure_segment(f, before + n, first + n);
        }
        if (k < layers)
            add_layer(f, y + height / 2, k + 1);
        before = first;
        y += height;
    }
}

/* A map of n by n cells with displaced corners. */
struct map {
    int32_t n;
    struct tri_point corner[MOST_CELLS + 1][MOST_CELLS + 1];
};

static struct map draw_map(struct figure *f, double size, double jitter)
{
    struct map map = {.n = figure_size(f, 1, MOST_CELLS - 1)};
    double step = size / map.n;
    for (int32_t j = 0; j <= map.n; j++)
        for (int32_t i = 0; i <= map.n; i++) {
            struct tri_point off = figure_draw(f, -jitter, jitter);
            map.corner[j][i] = (struct tri_point){step * (i + off.x), step * (j + off.y)};
        }
    return map;
}

/* One side of a cell: its first corner, and sometimes points that the neighbour may not have on this side. */
static void draw_side(struct figure *f, struct tri_point a, struct tri_point b, double unit, double detail)
{
    int32_t n = figure_chance(f, detail) ? figure_whole(f, 2, 5) : 1;
    for (int32_t i = 0; i < n; i++) {
        double x = a.x + (double)i / n * (b.x - a.x), y = a.y + (double)i / n * (b.y - a.y);
        figure_point(f, unit > 0 ? figure_round(x, unit) : x, unit > 0 ? figure_round(y, unit) : y);
    }
}

/* Makes every cell a polygon of its own. */
static void draw_cells(struct figure *f, const struct map *map, double unit, double detail)
{
    for (int32_t j = 0; j < map->n; j++) {
        for (int32_t i = 0; i < map->n; i++) {
            struct tri_point p[4] = {map->corner[j][i], map->corner[j][i + 1], map->corner[j + 1][i + 1],
                                     map->corner[j + 1][i]};
            int32_t first = f->pslg.n_points;
            for (int k = 0; k < 4; k++)
                draw_side(f, p[k], p[(k + 1) % 4], unit, detail);
            figure_loop(f, first, f->pslg.n_points - first);
        }
    }
}

/* Slivers between borders that each neighbour has rounded separately. */
static void make_slivers(struct figure *f)
{
    double size = figure_power(f, 0, 3);
    struct map map = draw_map(f, size, 0.35);
    double unit = figure_chance(f, 0.3) ? 0 : figure_ten_to(figure_whole(f, -8, -1));
    draw_cells(f, &map, unit, 0.4);
}

static void make_overlay(struct figure *f)
{
    double size = figure_power(f, 0, 2), unit = figure_chance(f, 0.4) ? 0 : figure_ten_to(figure_whole(f, -6, -1));
    for (int k = 0; k < 2; k++) {
        struct map map = draw_map(f, size, figure_chance(f, 0.3) ? 0 : 0.35);
        draw_cells(f, &map, unit, 0.2);
    }
}

/* The same map twice, the second time slightly displaced. */
static void make_shifted_copy(struct figure *f)
{
    double size = figure_power(f, 0, 2), shift = size * figure_ten_to(figure_whole(f, -17, -6));
    struct map map = draw_map(f, size, 0.35);
    draw_cells(f, &map, 0, 0);
    for (int32_t j = 0; j <= map.n; j++)
        for (int32_t i = 0; i <= map.n; i++) {
            struct tri_point off = figure_draw(f, -shift, shift);
            map.corner[j][i].x += off.x;
            map.corner[j][i].y += off.y;
        }
    draw_cells(f, &map, 0, 0.2);
}

/* Lines side by side, each drawn several times, slightly displaced. In a grid every second line crosses the others. */
static void draw_hatching(struct figure *f, bool grid, int32_t copies, double shift)
{
    struct tri_point turn = figure_on_circle(figure_chance(f, 0.3) ? 0 : figure_real(f, 0, 1));
    int32_t n = figure_size(f, 3, 24);
    for (int32_t i = 0; i < n * copies; i++) {
        double beside = 2.0 * (i / copies) / n - 1 + (i % copies > 0 ? figure_real(f, -shift, shift) : 0);
        double along[2] = {figure_real(f, -1.3, -0.2), figure_real(f, 0.2, 1.3)};
        for (int k = 0; k < 2; k++) {
            bool across = grid && i / copies % 2 > 0;
            double x = across ? -beside : along[k], y = across ? along[k] : beside;
            figure_point(f, turn.x * x - turn.y * y, turn.y * x + turn.x * y);
        }
        figure_segment(f, f->pslg.n_points - 2, f->pslg.n_points - 1);
    }
    if (figure_chance(f, 0.7))
        figure_box(f, -2, -2, 4, 4);
}

/* Borders that were computed two or three times: hatchings, grids, maps. */
static void make_doubled(struct figure *f)
{
    int32_t kind = figure_whole(f, 0, 2), copies = figure_whole(f, 2, 3);
    double shift = figure_power(f, -16, -11);
    if (kind < 2) {
        draw_hatching(f, kind == 1, copies, shift);
        return;
    }
    const struct map map = draw_map(f, 1, 0.3);
    for (int32_t k = 0; k < copies; k++) {
        struct map copy = map;
        for (int32_t i = 0; k > 0 && i < (map.n + 1) * (map.n + 1); i++) {
            struct tri_point off = figure_draw(f, -shift, shift);
            copy.corner[i / (map.n + 1)][i % (map.n + 1)].x += off.x;
            copy.corner[i / (map.n + 1)][i % (map.n + 1)].y += off.y;
        }
        draw_cells(f, &copy, 0, 0);
    }
}

/* Polygons that touch themselves: corners on sides, borders traversed twice, figures of eight. */
static void make_self_touching(struct figure *f)
{
    int32_t n = figure_size(f, 4, 30), first = f->pslg.n_points;
    for (int32_t i = 0; i < n; i++) {
        struct tri_point p = figure_on_circle((double)i / n);
        double r = figure_real(f, 0.5, 1);
        figure_point(f, r * p.x, r * p.y);
    }
    figure_loop(f, first, n);
    for (int32_t k = figure_size(f, 1, 6); k > 0; k--) { /* inwards to a side or a corner, and back */
        int32_t side = figure_whole(f, first, first + n - 2), other = figure_whole(f, first, first + n - 2);
        struct tri_point p = figure_along(f, side, side + 1, figure_real(f, 0, 1));
        struct tri_point q = figure_along(f, other, other + 1, figure_real(f, 0, 1));
        int32_t a = figure_point(f, p.x, p.y), b = figure_point(f, q.x, q.y);
        figure_segment(f, side, a);
        bool twice = figure_chance(f, 0.5);
        figure_segment(f, a, twice ? b : other);
        figure_segment(f, b, a);
        figure_segment(f, other, b);
    }
}

static void draw_label(struct figure *f, int32_t i, bool hole)
{
    struct tri_point p = figure_draw(f, 0, 10);
    if (hole)
        figure_hole(f, p.x, p.y);
    else
        figure_region(f, p.x, p.y, i, figure_chance(f, 0.5) ? 1 : 0);
}

/* A random closed walk. */
static void make_tangle(struct figure *f)
{
    int32_t n = figure_size(f, 4, 40), first = f->pslg.n_points;
    double unit = figure_chance(f, 0.5) ? 1 : 0;
    for (int32_t i = 0; i < n; i++) {
        struct tri_point p = figure_draw(f, 0, 10);
        figure_point(f, unit > 0 ? figure_round(p.x, unit) : p.x, unit > 0 ? figure_round(p.y, unit) : p.y);
    }
    figure_loop(f, first, n);
    for (int32_t i = figure_whole(f, 0, 3); i > 0; i--)
        draw_label(f, i, true);
    for (int32_t i = figure_whole(f, 0, 3); i > 0; i--)
        draw_label(f, i, false);
}

const struct family families_map[] = {
    {"layers", make_layers, 1, false, false},
    {"slivers", make_slivers, 1, true, false},
    {"overlay", make_overlay, 1, true, false},
    {"shifted_copy", make_shifted_copy, 1, true, false},
    {"doubled", make_doubled, 1, true, false},
    {"self_touching", make_self_touching, 1, true, false},
    {"tangle", make_tangle, 1, true, false},
    {0},
};
