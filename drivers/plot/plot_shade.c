/* Chooses the colour of each triangle and the legend: by smallest angle, area, region, or block and phase.
 *
 * The colour of a triangle is an index into a short table of shades, so that the drawing can proceed shade by shade. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "drivers/plot/plot.h"

enum {
    SCALE_SHADES = 60,
    MAX_REGION_SHADES = 4096,
    MAX_KEYS = 24,
    MAX_PHASES = 24,
    TONES = 16, /* tones within one phase, so that neighbouring blocks differ */
    OUTSIDE = MAX_PHASES * TONES
};

static const double degrees = 57.29577951308232;

/* --- Colours, chosen in Oklch (B. Ottosson, "A perceptual color space for image processing", 2020), where equal steps
 * of lightness L, chroma C and hue look equally large; then brought to sRGB, less colourful where the screen
 * cannot. */

static const double pi = 3.14159265358979323846;

static double to_srgb(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
}

/* Linear light; components may lie outside 0 .. 1. */
static void oklch_to_linear(double L, double C, double hue, double rgb[3])
{
    const double a = C * cos(hue * pi / 180), b = C * sin(hue * pi / 180);
    const double l = pow(L + 0.3963377774 * a + 0.2158037573 * b, 3);
    const double m = pow(L - 0.1055613458 * a - 0.0638541728 * b, 3);
    const double s = pow(L - 0.0894841775 * a - 1.2914855480 * b, 3);
    rgb[0] = 4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s;
    rgb[1] = -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s;
    rgb[2] = -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s;
}

static bool on_screen(const double rgb[3])
{
    for (int k = 0; k < 3; k++) {
        if (rgb[k] < 0 || rgb[k] > 1)
            return false;
    }
    return true;
}

static double clamp(double x)
{
    return fmin(fmax(x, 0), 1);
}

static struct plot_colour from_oklch(double L, double C, double hue)
{
    double rgb[3];
    oklch_to_linear(L, C, hue, rgb);
    for (int tries = 0; tries < 60 && !on_screen(rgb); tries++) {
        C *= 0.95;
        oklch_to_linear(L, C, hue, rgb);
    }
    return (struct plot_colour){to_srgb(clamp(rgb[0])), to_srgb(clamp(rgb[1])), to_srgb(clamp(rgb[2]))};
}

/* Sequential scale for t in 0 .. 1, dark violet to light yellow. Lightness rises evenly, so the order is visible
 * without colour vision and in grey print. */
static struct plot_colour scale_colour(double t)
{
    t = clamp(t);
    return from_oklch(0.30 + 0.63 * t, 0.12 + 0.05 * t, 310 - 205 * t);
}

/* Returns one of any number of colours; up to a dozen are easy to distinguish. tone in 0 .. 1 selects a darker or
 * lighter shade. Hues follow the golden angle: each new one falls into the widest gap between earlier ones. */
static struct plot_colour category_colour(int category, double tone)
{
    static const double lightness[3] = {0, -0.17, 0.1};
    const double hue = fmod(250 + 137.50776405 * category, 360);
    return from_oklch(0.74 + lightness[category / 7 % 3] + 0.18 * (clamp(tone) - 0.5), 0.115, hue);
}

/* --- shades */

static enum tri_status begin(struct plot_shading *s, const struct plot_mesh *mesh, int n_shades,
                             struct tri_error *error)
{
    *s = (struct plot_shading){.n_shades = n_shades};
    s->shade = malloc(((size_t)mesh->n_triangles + 1) * sizeof *s->shade);
    s->shades = malloc((size_t)n_shades * sizeof *s->shades);
    s->count = calloc((size_t)n_shades, sizeof *s->count);
    s->keys = calloc(MAX_KEYS + 1, sizeof *s->keys);
    return s->shade && s->shades && s->count && s->keys ? TRI_OK : plot_no_memory(error);
}

void plot_shading_free(struct plot_shading *s)
{
    free(s->shade);
    free(s->shades);
    free(s->count);
    free(s->keys);
    *s = (struct plot_shading){0};
}

static void set(struct plot_shading *s, int32_t triangle, int shade)
{
    s->shade[triangle] = (uint16_t)shade;
    s->count[shade]++;
}

static void add_key(struct plot_shading *s, struct plot_colour colour, const char *word, double number)
{
    struct plot_key *key = &s->keys[s->n_keys++];
    key->colour = colour;
    (void)snprintf(key->label, sizeof key->label, "%s%.10g", word, number);
}

/* number * 10^power */
static void add_tick(struct plot_shading *s, double at, int number, int power)
{
    if (s->n_ticks == PLOT_MAX_TICKS)
        return;
    struct plot_tick *tick = &s->ticks[s->n_ticks++];
    tick->at = at;
    if (power >= -3 && power <= 3)
        (void)snprintf(tick->label, sizeof tick->label, "%.10g", number * pow(10, power));
    else
        (void)snprintf(tick->label, sizeof tick->label, "%de%d", number, power);
}

static int level(double fraction)
{
    return (int)fmin(fmax(fraction * SCALE_SHADES, 0), SCALE_SHADES - 1);
}

static void fill_scale(struct plot_shading *s)
{
    s->legend = PLOT_LEGEND_SCALE;
    for (int i = 0; i < SCALE_SHADES; i++)
        s->shades[i] = scale_colour((i + 0.5) / SCALE_SHADES);
}

/* --- geometry of a triangle */

/* Returns twice the area, and the sides as vectors from corner k to the next one. */
static double measure(const struct plot_mesh *mesh, int32_t t, double side[3][2])
{
    const int32_t *v = mesh->corners + 3 * (size_t)t;
    for (int k = 0; k < 3; k++) {
        const double *a = mesh->points + 2 * (size_t)v[k], *b = mesh->points + 2 * (size_t)v[(k + 1) % 3];
        side[k][0] = b[0] - a[0];
        side[k][1] = b[1] - a[1];
    }
    return side[0][0] * side[1][1] - side[0][1] * side[1][0];
}

/* Returns 0 for a flat or clockwise triangle. */
static double smallest_angle(const struct plot_mesh *mesh, int32_t t)
{
    double side[3][2], smallest = 180;
    const double area2 = measure(mesh, t, side);
    if (!(area2 > 0))
        return 0;
    for (int k = 0; k < 3; k++) {
        const double *out = side[k], *in = side[(k + 2) % 3];
        smallest = fmin(smallest, degrees * atan2(area2, -(out[0] * in[0] + out[1] * in[1])));
    }
    return smallest;
}

/* --- one colour, quality, area */

enum tri_status plot_shade_plain(struct plot_shading *s, const struct plot_mesh *mesh, struct tri_error *error)
{
    if (begin(s, mesh, 1, error) != TRI_OK)
        return TRI_NO_MEMORY;
    s->shades[0] = (struct plot_colour){0.93, 0.95, 0.98};
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        set(s, t, 0);
    return TRI_OK;
}

enum tri_status plot_shade_quality(struct plot_shading *s, const struct plot_mesh *mesh, struct tri_error *error)
{
    double least = 60, sum = 0;
    if (begin(s, mesh, SCALE_SHADES, error) != TRI_OK)
        return TRI_NO_MEMORY;
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        const double angle = smallest_angle(mesh, t);
        set(s, t, level(angle / 60));
        least = fmin(least, angle);
        sum += angle;
    }
    fill_scale(s);
    s->title = "smallest angle of each triangle, degrees";
    for (int a = 0; a <= 60; a += 10)
        add_tick(s, a / 60.0, a, 0);
    if (mesh->n_triangles > 0)
        (void)snprintf(s->fact, sizeof s->fact, "smallest angle %.3g\u00b0, average %.3g\u00b0", least,
                       sum / mesh->n_triangles);
    return TRI_OK;
}

/* Places ticks at powers of ten, or at 1, 2, 5 times them if the range is short. */
static void add_log_ticks(struct plot_shading *s, double low, double high)
{
    const int n_steps = high - low < 3 ? 3 : 1, stride = (int)fmax(1, ceil((high - low) / 8));
    static const int step[3] = {1, 2, 5};
    for (int power = (int)floor(low); power <= high; power++) {
        for (int k = 0; k < n_steps && power % stride == 0; k++) {
            const double at = power + log10(step[k]);
            if (at >= low && at <= high)
                add_tick(s, (at - low) / (high - low), step[k], power);
        }
    }
}

enum tri_status plot_shade_area(struct plot_shading *s, const struct plot_mesh *mesh, struct tri_error *error)
{
    const double to_caller = 2 * mesh->exponent * log10(2);
    double side[3][2], low = INFINITY, high = -INFINITY;
    if (begin(s, mesh, SCALE_SHADES, error) != TRI_OK)
        return TRI_NO_MEMORY;
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        const double area2 = measure(mesh, t, side);
        if (area2 > 0) {
            low = fmin(low, log10(area2 / 2) + to_caller);
            high = fmax(high, log10(area2 / 2) + to_caller);
        }
    }
    if (high < low)
        low = high = 0;
    if (high - low < 0.01) { /* all values are equal: use the middle of the scale */
        low -= 0.5;
        high += 0.5;
    }
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        const double area2 = measure(mesh, t, side);
        set(s, t, area2 > 0 ? level((log10(area2 / 2) + to_caller - low) / (high - low)) : 0);
    }
    fill_scale(s);
    s->title = "area of each triangle";
    add_log_ticks(s, low, high);
    return TRI_OK;
}

/* --- density */

/* Finds the logarithms of the smallest and largest density, at least a decade apart. */
static void density_range(const struct plot_density *d, double *low, double *high)
{
    double least = 1, most = 0;
    for (int32_t i = 0; i < d->width * d->height; i++) {
        least = d->count[i] > 0 && d->count[i] < least ? d->count[i] : least;
        most = d->count[i] > most ? d->count[i] : most;
    }
    *low = log10(least);
    *high = fmax(log10(most > 0 ? most : 1), *low + 1);
}

enum tri_status plot_shade_density(struct plot_shading *s, const struct plot_density *d, struct tri_error *error)
{
    const struct plot_mesh pixels = {.n_triangles = d->width * d->height};
    double low, high, most = 0;
    if (begin(s, &pixels, SCALE_SHADES, error) != TRI_OK)
        return TRI_NO_MEMORY;
    density_range(d, &low, &high);
    for (int32_t i = 0; i < pixels.n_triangles; i++) {
        if (d->count[i] > 0)
            set(s, i, level((log10(d->count[i]) - low) / (high - low)));
        else
            s->shade[i] = SCALE_SHADES;
        most = fmax(most, d->count[i]);
    }
    fill_scale(s);
    s->density = d;
    s->title = "triangles at each pixel";
    add_log_ticks(s, low, high);
    (void)snprintf(s->fact, sizeof s->fact, "at most %.3g at a pixel", most);
    return TRI_OK;
}

/* --- regions */

/* Sorts NaN last, which HDF5 files of other programs may contain. */
static int compare_reals(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y ? 1 : (isnan(x) != 0) - (isnan(y) != 0);
}

/* Sorts and removes duplicates. Returns the remaining number. */
static int32_t distinct_reals(double *value, int32_t n)
{
    int32_t kept = 0;
    qsort(value, (size_t)n, sizeof *value, compare_reals);
    for (int32_t i = 0; i < n; i++) {
        if (kept == 0 || compare_reals(&value[i], &value[kept - 1]) > 0)
            value[kept++] = value[i];
    }
    return kept;
}

static void set_regions(struct plot_shading *s, const double *known, int32_t n_known, const double *value,
                        int32_t stride, int32_t n)
{
    for (int i = 0; i < s->n_shades; i++)
        s->shades[i] = category_colour(i, 0.5);
    for (int32_t t = 0; t < n; t++) {
        const double *at = bsearch(value + (size_t)t * (size_t)stride, known, (size_t)n_known, sizeof *known,
                                   compare_reals);
        set(s, t, (int)((at - known) % s->n_shades));
    }
    s->legend = n_known <= MAX_KEYS ? PLOT_LEGEND_KEYS : PLOT_LEGEND_NONE;
    for (int i = 0; s->legend == PLOT_LEGEND_KEYS && i < n_known; i++)
        add_key(s, s->shades[i], "", known[i]);
    s->title = "region";
    (void)snprintf(s->fact, sizeof s->fact, "%ld region%s", (long)n_known, n_known == 1 ? "" : "s");
}

enum tri_status plot_shade_region(struct plot_shading *s, const struct plot_mesh *mesh, const double *value,
                                  int32_t stride, struct tri_error *error)
{
    const int32_t n = mesh->n_triangles;
    double *known = malloc(((size_t)n + 1) * sizeof *known);
    *s = (struct plot_shading){0};
    if (known == NULL)
        return plot_no_memory(error);
    for (int32_t t = 0; t < n; t++)
        known[t] = value[(size_t)t * (size_t)stride];
    const int32_t n_known = distinct_reals(known, n);
    const int n_shades = n_known < 1 ? 1 : n_known < MAX_REGION_SHADES ? (int)n_known : MAX_REGION_SHADES;
    const enum tri_status status = begin(s, mesh, n_shades, error);
    if (status == TRI_OK)
        set_regions(s, known, n_known, value, stride, n);
    free(known);
    return status;
}

/* --- blocks and phases */

/* Finds distinct (phase, block) pairs with phase >= 0. Returns < 0 if out of memory. */
static int64_t count_blocks(const int32_t *block_phase, int32_t n)
{
    int64_t *key = malloc(((size_t)n + 1) * sizeof *key), used = 0;
    if (key == NULL)
        return -1;
    for (int32_t t = 0; t < n; t++) {
        const int64_t block = block_phase[2 * (size_t)t], phase = block_phase[2 * (size_t)t + 1];
        if (phase >= 0)
            key[used++] = phase * ((int64_t)1 << 32) + block;
    }
    const int64_t different = plot_distinct(key, used);
    free(key);
    return different;
}

/* Consecutive blocks get tones that differ strongly. */
static int tone_of(int32_t block)
{
    const double turns = 0.61803398874989485 * block;
    return (int)(TONES * (turns - floor(turns)));
}

static void fill_phases(struct plot_shading *s)
{
    for (int i = 0; i < OUTSIDE; i++)
        s->shades[i] = category_colour(i / TONES, (i % TONES + 0.5) / TONES);
    s->shades[OUTSIDE] = (struct plot_colour){0.78, 0.78, 0.78};
}

static void add_phase_keys(struct plot_shading *s)
{
    for (int phase = 0; phase < MAX_PHASES; phase++) {
        bool seen = false;
        for (int tone = 0; tone < TONES; tone++)
            seen = seen || s->count[phase * TONES + tone] > 0;
        if (seen)
            add_key(s, category_colour(phase, 0.5), "phase ", phase);
    }
    if (s->count[OUTSIDE] > 0) {
        add_key(s, s->shades[OUTSIDE], "", 0);
        (void)snprintf(s->keys[s->n_keys - 1].label, PLOT_LABEL_BYTES, "in no block");
    }
}

enum tri_status plot_shade_block(struct plot_shading *s, const struct plot_mesh *mesh, const int32_t *block_phase,
                                 struct tri_error *error)
{
    if (begin(s, mesh, OUTSIDE + 1, error) != TRI_OK)
        return TRI_NO_MEMORY;
    const int64_t n_blocks = count_blocks(block_phase, mesh->n_triangles);
    if (n_blocks < 0)
        return plot_no_memory(error);
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        const int32_t block = block_phase[2 * (size_t)t], phase = block_phase[2 * (size_t)t + 1];
        set(s, t, phase < 0 ? OUTSIDE : phase % MAX_PHASES * TONES + tone_of(block));
    }
    fill_phases(s);
    s->legend = PLOT_LEGEND_KEYS;
    s->title = "phase of the schedule; tones: blocks";
    add_phase_keys(s);
    (void)snprintf(s->fact, sizeof s->fact, "%lld block%s", (long long)n_blocks, n_blocks == 1 ? "" : "s");
    return TRI_OK;
}
