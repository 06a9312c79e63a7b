/* Growing arrays, and random numbers. */
#include "tests/torture/figure.h"

#include <stdio.h>

enum { POINTS, SEGMENTS, HOLES, REGIONS };

static void *grown(void *old, int32_t n, size_t item)
{
    void *array = realloc(old, (size_t)n * item);
    if (!array) {
        fprintf(stderr, "torture: out of memory\n");
        exit(EXIT_FAILURE);
    }
    return array;
}

/* Makes room for more than n items. Returns the new capacity. */
static bool must_grow(struct figure *f, int what, int32_t n)
{
    if (n < f->room[what])
        return false;
    f->room[what] = 2 * n + 16;
    return true;
}

struct figure figure_new(uint64_t seed)
{
    struct figure f = {.random = {seed * 0x9e3779b97f4a7c15u + 1}};
    f.with_markers = support_unit(&f.random) < 0.5;
    return f;
}

void figure_free(struct figure *figure)
{
    tri_pslg_free(&figure->pslg);
    *figure = (struct figure){0};
}

/* --- random numbers */

bool figure_chance(struct figure *f, double probability) { return support_unit(&f->random) < probability; }

double figure_real(struct figure *f, double low, double high) { return low + support_unit(&f->random) * (high - low); }

int32_t figure_whole(struct figure *f, int32_t low, int32_t high)
{
    return low + support_below(&f->random, high - low + 1);
}

int32_t figure_size(struct figure *f, int32_t low, int32_t high)
{
    double x = support_unit(&f->random);
    return low + (int32_t)(x * x * x * (double)(high - low + 1));
}

double figure_power(struct figure *f, int32_t low, int32_t high)
{
    int32_t exponent = figure_whole(f, low, high);
    return figure_ten_to(exponent) * figure_real(f, 1, 10);
}

struct tri_point figure_draw(struct figure *f, double low, double high)
{
    double x = figure_real(f, low, high), y = figure_real(f, low, high);
    return (struct tri_point){x, y};
}

int32_t figure_draw_point(struct figure *f, double low, double high)
{
    struct tri_point p = figure_draw(f, low, high);
    return figure_point(f, p.x, p.y);
}

void figure_draw_segment(struct figure *f, int32_t first, int32_t last)
{
    int32_t a = figure_whole(f, first, last), b = figure_whole(f, first, last);
    figure_segment(f, a, b);
}

/* --- numbers */

double figure_ten_to(int32_t exponent)
{
    double power = 1;
    for (int32_t i = 0; i < abs(exponent); i++)
        power *= 10;
    return exponent < 0 ? 1 / power : power;
}

/* Taylor series for at most an eighth of a turn, extended by symmetry. */
struct tri_point figure_on_circle(double turns)
{
    turns -= floor(turns);
    int octant = (int)(turns * 8) & 7;
    double x = (turns - 0.25 * ((octant + 1) / 2)) * 6.283185307179586, square = x * x;
    double s = 1, c = 1;
    for (int k = 18; k > 1; k -= 2) {
        s = 1 - s * square / (k * (k + 1));
        c = 1 - c * square / (k * (k - 1));
    }
    s *= x;
    switch ((octant + 1) / 2 % 4) {
    case 0: return (struct tri_point){c, s};
    case 1: return (struct tri_point){-s, c};
    case 2: return (struct tri_point){-c, -s};
    default: return (struct tri_point){s, -c};
    }
}

double figure_round(double x, double unit)
{
    double inverse = floor(1 / unit + 0.5);
    return unit < 1 ? floor(x * inverse + 0.5) / inverse : floor(x / unit + 0.5) * unit;
}

double figure_ulps(double x, int32_t ulps)
{
    for (int32_t i = 0; i < abs(ulps); i++)
        x = nextafter(x, ulps > 0 ? INFINITY : -INFINITY);
    return x;
}

/* --- building */

static int32_t marker(struct figure *f)
{
    return f->with_markers && figure_chance(f, 0.6) ? figure_whole(f, 1, 9) : 0;
}

int32_t figure_point(struct figure *f, double x, double y)
{
    struct tri_pslg *p = &f->pslg;
    int32_t v = p->n_points++;
    if (must_grow(f, POINTS, v)) {
        p->points = grown(p->points, f->room[POINTS], 2 * sizeof *p->points);
        p->markers = grown(p->markers, f->room[POINTS], sizeof *p->markers);
    }
    p->points[2 * (size_t)v] = x;
    p->points[2 * (size_t)v + 1] = y;
    p->markers[v] = figure_chance(f, 0.1) ? marker(f) : 0;
    return v;
}

void figure_segment(struct figure *f, int32_t a, int32_t b)
{
    struct tri_pslg *p = &f->pslg;
    int32_t s = p->n_segments++;
    if (must_grow(f, SEGMENTS, s)) {
        p->segments = grown(p->segments, f->room[SEGMENTS], 2 * sizeof *p->segments);
        p->segment_markers = grown(p->segment_markers, f->room[SEGMENTS], sizeof *p->segment_markers);
    }
    p->segments[2 * (size_t)s] = a;
    p->segments[2 * (size_t)s + 1] = b;
    p->segment_markers[s] = marker(f);
}

void figure_path(struct figure *f, int32_t first, int32_t n)
{
    for (int32_t i = 0; i + 1 < n; i++)
        figure_segment(f, first + i, first + i + 1);
}

void figure_loop(struct figure *f, int32_t first, int32_t n)
{
    figure_path(f, first, n);
    figure_segment(f, first + n - 1, first);
}

void figure_hole(struct figure *f, double x, double y)
{
    struct tri_pslg *p = &f->pslg;
    int32_t i = p->n_holes++;
    if (must_grow(f, HOLES, i))
        p->holes = grown(p->holes, f->room[HOLES], 2 * sizeof *p->holes);
    p->holes[2 * (size_t)i] = x;
    p->holes[2 * (size_t)i + 1] = y;
}

void figure_region(struct figure *f, double x, double y, double attribute, double max_area)
{
    struct tri_pslg *p = &f->pslg;
    int32_t i = p->n_regions++;
    if (must_grow(f, REGIONS, i))
        p->regions = grown(p->regions, f->room[REGIONS], 4 * sizeof *p->regions);
    double *region = p->regions + 4 * (size_t)i;
    region[0] = x;
    region[1] = y;
    region[2] = attribute;
    region[3] = max_area;
}

int32_t figure_box(struct figure *f, double x, double y, double width, double height)
{
    int32_t first = figure_point(f, x, y);
    figure_point(f, x + width, y);
    figure_point(f, x + width, y + height);
    figure_point(f, x, y + height);
    figure_loop(f, first, 4);
    return first;
}

int32_t figure_ring(struct figure *f, double x, double y, double radius, int32_t n)
{
    int32_t first = f->pslg.n_points;
    for (int32_t i = 0; i < n; i++) {
        struct tri_point p = figure_on_circle((double)i / n);
        figure_point(f, x + radius * p.x, y + radius * p.y);
    }
    figure_loop(f, first, n);
    return first;
}

struct tri_point figure_at(const struct figure *f, int32_t point)
{
    const double *p = f->pslg.points + 2 * (size_t)point;
    return (struct tri_point){p[0], p[1]};
}

struct tri_point figure_along(const struct figure *f, int32_t a, int32_t b, double fraction)
{
    struct tri_point p = figure_at(f, a), q = figure_at(f, b);
    return (struct tri_point){p.x + fraction * (q.x - p.x), p.y + fraction * (q.y - p.y)};
}

struct figure_bounds figure_bounds(const struct tri_pslg *pslg)
{
    struct figure_bounds b = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}, 0};
    for (int32_t v = 0; v < pslg->n_points; v++) {
        for (int k = 0; k < 2; k++) {
            double x = pslg->points[2 * (size_t)v + (size_t)k];
            b.low[k] = fmin(b.low[k], x);
            b.high[k] = fmax(b.high[k], x);
            b.largest = fmax(b.largest, fabs(x));
        }
    }
    return b;
}
