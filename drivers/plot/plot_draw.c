/* Draws the whole picture: places the mesh and the texts, and draws the texts. */
#include "drivers/plot/plot.h"

#include <math.h>
#include <stdio.h>

/* Positions in pixels, y down. */
struct layout {
    double font; /* size of the texts */
    double margin;
    struct plot_box field; /* box of the mesh */
    double legend;         /* top of the texts below the mesh, or 0 */
};

/* --- layout */

/* Number of columns for the names of colours. */
static int key_columns(double width, double font)
{
    return (int)fmax(1, fmin(6, 0.68 * width / (6 * font)));
}

/* Returns the height of the texts below, in units of their font size. */
static double legend_lines(const struct plot_shading *shading, double width, double font)
{
    const int columns = key_columns(width, font);
    switch (shading->legend) {
    case PLOT_LEGEND_SCALE:
        return 5.6;
    case PLOT_LEGEND_KEYS:
        return fmax(3.9, 1.6 + 1.05 * ((shading->n_keys + columns - 1) / columns));
    default:
        return 1.5;
    }
}

static struct layout lay_out(const struct plot_style *style)
{
    struct layout l = {.font = fmax(10, style->width / 58)};
    const double aspect = (style->window.y1 - style->window.y0) / (style->window.x1 - style->window.x0);
    l.margin = 0.7 * l.font;
    l.field.x0 = l.margin;
    l.field.x1 = style->width - l.margin;
    l.field.y0 = l.margin + (style->title != NULL ? 2 * l.font : 0);
    l.field.y1 = floor(l.field.y0 + (l.field.x1 - l.field.x0) * fmin(fmax(aspect, 0.2), 2.5));
    if (style->legend)
        l.legend = l.field.y1 + 0.8 * l.font;
    return l;
}

void plot_window_pixels(const struct plot_style *style, int *width, int *height)
{
    const struct plot_box field = lay_out(style).field, *window = &style->window;
    const double x = window->x1 - window->x0, y = window->y1 - window->y0;
    const double scale = fmin((field.x1 - field.x0) / x, (field.y1 - field.y0) / y);
    *width = (int)fmax(1, floor(x * scale));
    *height = (int)fmax(1, floor(y * scale));
}

double plot_height(const struct plot_style *style, const struct plot_shading *shading)
{
    const struct layout l = lay_out(style);
    if (!style->legend)
        return ceil(l.field.y1 + l.margin);
    return ceil(l.legend + legend_lines(shading, style->width - 2 * l.margin, l.font) * l.font);
}

/* --- texts */

enum { LEFT, CENTRE, RIGHT };

static void write_text(cairo_t *cr, double x, double y, const char *text, int side)
{
    cairo_text_extents_t extents;
    cairo_text_extents(cr, text, &extents);
    cairo_move_to(cr, x - (side == LEFT ? 0 : side == CENTRE ? extents.x_advance / 2 : extents.x_advance), y);
    cairo_show_text(cr, text);
}

static void use_font(cairo_t *cr, double size, bool bold)
{
    cairo_select_font_face(cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cr, size);
    cairo_set_source_rgb(cr, 0.15, 0.17, 0.2);
}

/* Formats 1234567 as "1,234,567". */
static void print_grouped(char out[32], int64_t n)
{
    char digits[24];
    const int length = snprintf(digits, sizeof digits, "%lld", (long long)n);
    int at = 0;
    for (int i = 0; i < length; i++) {
        if (i > 0 && (length - i) % 3 == 0)
            out[at++] = ',';
        out[at++] = digits[i];
    }
    out[at] = '\0';
}

/* Draws a histogram above a bar of the shades, with ticks below. (x, y) is the upper left corner. */
static void draw_scale(cairo_t *cr, const struct plot_shading *s, double x, double y, double width, double font)
{
    const double step = width / s->n_shades, high = 2.6 * font, bar = 0.45 * font;
    int64_t most = 1;
    for (int i = 0; i < s->n_shades; i++)
        most = s->count[i] > most ? s->count[i] : most;
    for (int i = 0; i < s->n_shades; i++) {
        const double share = high * (double)s->count[i] / (double)most;
        plot_set_colour(cr, s->shades[i]);
        cairo_rectangle(cr, x + i * step, y + high - share, step + 0.2, share + bar);
        cairo_fill(cr);
    }
    use_font(cr, 0.75 * font, false);
    for (int i = 0; i < s->n_ticks; i++)
        write_text(cr, x + s->ticks[i].at * width, y + high + bar + 0.85 * font, s->ticks[i].label, CENTRE);
    write_text(cr, x, y + high + bar + 1.85 * font, s->title, LEFT);
}

static void draw_keys(cairo_t *cr, const struct plot_shading *s, double x, double y, double width, double font)
{
    const int columns = key_columns(width, font);
    use_font(cr, 0.75 * font, false);
    write_text(cr, x, y + 0.7 * font, s->title, LEFT);
    for (int i = 0; i < s->n_keys; i++) {
        const double left = x + 0.68 * width * (i % columns) / columns, top = y + (1.1 + 1.05 * (i / columns)) * font;
        plot_set_colour(cr, s->keys[i].colour);
        cairo_rectangle(cr, left, top, 1.2 * font, 0.75 * font);
        cairo_fill(cr);
        use_font(cr, 0.75 * font, false);
        write_text(cr, left + 1.5 * font, top + 0.65 * font, s->keys[i].label, LEFT);
    }
}

static void draw_facts(cairo_t *cr, const struct plot_mesh *mesh, const struct plot_shading *s, double x, double y,
                       double font)
{
    char vertices[32], triangles[32], line[256];
    print_grouped(vertices, mesh->all_points);
    print_grouped(triangles, mesh->all_triangles);
    use_font(cr, 0.75 * font, false);
    if (s->legend == PLOT_LEGEND_NONE) {
        (void)snprintf(line, sizeof line, "%s triangles, %s vertices%s%s", triangles, vertices,
                       s->fact[0] ? ", " : "", s->fact);
        write_text(cr, x, y + 0.7 * font, line, RIGHT);
        return;
    }
    (void)snprintf(line, sizeof line, "%s triangles", triangles);
    write_text(cr, x, y + 0.7 * font, line, RIGHT);
    (void)snprintf(line, sizeof line, "%s vertices", vertices);
    write_text(cr, x, y + 1.9 * font, line, RIGHT);
    write_text(cr, x, y + 3.1 * font, s->fact, RIGHT);
}

static void draw_texts(cairo_t *cr, const struct layout *l, const struct plot_mesh *mesh,
                       const struct plot_shading *shading, const struct plot_style *style)
{
    const double width = style->width - 2 * l->margin, scale_width = 0.55 * width, inset = 0.5 * l->font;
    if (style->title != NULL) {
        use_font(cr, 1.1 * l->font, true);
        write_text(cr, l->margin, l->margin + 1.1 * l->font, style->title, LEFT);
    }
    if (!style->legend)
        return;
    if (shading->legend == PLOT_LEGEND_SCALE)
        draw_scale(cr, shading, l->margin + inset, l->legend, scale_width, l->font);
    if (shading->legend == PLOT_LEGEND_KEYS)
        draw_keys(cr, shading, l->margin, l->legend, width, l->font);
    draw_facts(cr, mesh, shading, style->width - l->margin, l->legend, l->font);
}

enum tri_status plot_draw(cairo_t *cr, bool vector, const struct plot_mesh *mesh, const struct plot_shading *shading,
                          const struct plot_style *style, struct tri_error *error)
{
    const struct layout l = lay_out(style);
    cairo_set_source_rgb(cr, 1, 1, 1);
    cairo_paint(cr);
    const enum tri_status status = plot_field(cr, vector, mesh, shading, style, &l.field, l.font / 18, error);
    if (status == TRI_OK)
        draw_texts(cr, &l, mesh, shading, style);
    if (status == TRI_OK && cairo_status(cr) != CAIRO_STATUS_SUCCESS)
        return tri_fail(error, TRI_INTERNAL, "", 0, "cairo: %s", cairo_status_to_string(cairo_status(cr)));
    return status;
}
