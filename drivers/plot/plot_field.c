/* Draws the mesh into its box of the picture, from bottom to top: triangles, edges, subsegments, a frame. Points are
 * drawn only if there are no triangles.
 *
 * On a pixel surface triangles are filled without antialiasing, which would leave a light seam along every edge. They
 * are filled into a layer of twice the resolution. Scaling it down gives smooth outlines, and mixes the colours of
 * triangles smaller than a pixel. Cairo's coordinates end at 2^23 pixels, so shapes that reach far beyond the picture
 * are cut first. */
#include "drivers/plot/plot.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LAYER_SCALE = 2, MAX_LAYER_PIXELS = 40000000, CHUNK = 4096, FADE_STEPS = 6 };

static const double far_out = 30000; /* pixels */

struct canvas {
    cairo_t *cr;
    const struct plot_mesh *mesh;
    struct plot_box field;
    double scale, x0, y1; /* pixel = ((x - x0) * scale, (y1 - y) * scale) */
};

struct pixel {
    double x, y;
};

/* Places the window in the middle of the box, as large as fits. */
static struct canvas fit(cairo_t *cr, const struct plot_mesh *mesh, const struct plot_box *window,
                         const struct plot_box *field)
{
    struct canvas c = {.cr = cr, .mesh = mesh, .field = *field};
    const double w = field->x1 - field->x0, h = field->y1 - field->y0;
    c.scale = fmin(w / (window->x1 - window->x0), h / (window->y1 - window->y0));
    c.x0 = (window->x0 + window->x1) / 2 - (field->x0 + w / 2) / c.scale;
    c.y1 = (window->y0 + window->y1) / 2 + (field->y0 + h / 2) / c.scale;
    return c;
}

static struct pixel place(const struct canvas *c, int32_t point)
{
    const double *p = c->mesh->points + 2 * (size_t)point;
    return (struct pixel){(p[0] - c->x0) * c->scale, (c->y1 - p[1]) * c->scale};
}

/* --- cutting */

static bool is_near(struct pixel p)
{
    return fabs(p.x) < far_out && fabs(p.y) < far_out;
}

/* Returns the signed distance to border `side` of the square of half width far_out; >= 0 inside. */
static double inside(struct pixel p, int side)
{
    const double along = side < 2 ? p.x : p.y;
    return side % 2 == 0 ? far_out + along : far_out - along;
}

static struct pixel cross(struct pixel p, struct pixel q, int side)
{
    const double a = inside(p, side), b = inside(q, side), s = a / (a - b);
    return (struct pixel){p.x + s * (q.x - p.x), p.y + s * (q.y - p.y)};
}

/* Cuts a convex polygon by one border. `out` has room for one more corner. Returns its number of corners. */
static int cut_polygon(const struct pixel *in, int n, int side, struct pixel *out)
{
    int m = 0;
    for (int i = 0; i < n; i++) {
        const struct pixel p = in[i], q = in[(i + 1) % n];
        const bool p_in = inside(p, side) >= 0, q_in = inside(q, side) >= 0;
        if (p_in)
            out[m++] = p;
        if (p_in != q_in)
            out[m++] = cross(p, q, side);
    }
    return m;
}

static void add_polygon(cairo_t *cr, struct pixel *corner, int n)
{
    struct pixel other[8];
    for (int side = 0; side < 4 && n > 0; side++) {
        n = cut_polygon(corner, n, side, other);
        memcpy(corner, other, (size_t)n * sizeof *corner);
    }
    for (int i = 0; i < n; i++)
        (i == 0 ? cairo_move_to : cairo_line_to)(cr, corner[i].x, corner[i].y);
    if (n > 0)
        cairo_close_path(cr);
}

static void add_line(cairo_t *cr, struct pixel p, struct pixel q)
{
    for (int side = 0; side < 4 && !(is_near(p) && is_near(q)); side++) {
        const bool p_in = inside(p, side) >= 0, q_in = inside(q, side) >= 0;
        if (!p_in && !q_in)
            return;
        if (!p_in)
            p = cross(p, q, side);
        else if (!q_in)
            q = cross(p, q, side);
    }
    cairo_move_to(cr, p.x, p.y);
    cairo_line_to(cr, q.x, q.y);
}

/* --- triangles */

static bool in_field(const struct plot_box *field, const struct pixel *p, int n)
{
    struct plot_box box = plot_box_empty;
    for (int i = 0; i < n; i++)
        plot_box_extend(&box, (double[2]){p[i].x, p[i].y});
    return plot_boxes_meet(&box, field);
}

/* Returns the triangles sorted by shade; malloc'ed. */
static int32_t *order_by_shade(const struct plot_mesh *mesh, const struct plot_shading *shading)
{
    int32_t *order = malloc(((size_t)mesh->n_triangles + 1) * sizeof *order);
    int64_t *next = malloc((size_t)shading->n_shades * sizeof *next), sum = 0;
    for (int s = 0; order && next && s < shading->n_shades; s++) {
        next[s] = sum;
        sum += shading->count[s];
    }
    for (int32_t t = 0; order && next && t < mesh->n_triangles; t++)
        order[next[shading->shade[t]]++] = t;
    if (next == NULL) {
        free(order);
        order = NULL;
    }
    free(next);
    return order;
}

/* On a vector surface each fill gets a thin outline of the same colour, which hides the seams. */
static void paint_fill(cairo_t *cr, bool vector)
{
    if (vector) {
        cairo_fill_preserve(cr);
        cairo_stroke(cr);
    } else {
        cairo_fill(cr);
    }
}

static void fill_triangles(const struct canvas *c, bool vector, const struct plot_shading *shading,
                           const int32_t *order)
{
    struct pixel corner[8];
    int in_path = 0, shade = -1;
    cairo_set_line_width(c->cr, 0.3);
    cairo_set_line_join(c->cr, CAIRO_LINE_JOIN_BEVEL);
    for (int32_t i = 0; i < c->mesh->n_triangles; i++) {
        const int32_t t = order[i];
        if (shading->shade[t] != shade || in_path == CHUNK) {
            paint_fill(c->cr, vector);
            in_path = 0;
            shade = shading->shade[t];
            plot_set_colour(c->cr, shading->shades[shade]);
        }
        for (int k = 0; k < 3; k++)
            corner[k] = place(c, c->mesh->corners[3 * (size_t)t + (size_t)k]);
        if (in_field(&c->field, corner, 3)) {
            add_polygon(c->cr, corner, 3);
            in_path++;
        }
    }
    paint_fill(c->cr, vector);
}

/* Fills into a finer layer, and draws that on the picture. Returns the status of the layer. */
static cairo_status_t fill_through_layer(const struct canvas *c, const struct plot_shading *shading,
                                         const int32_t *order)
{
    const struct plot_box *f = &c->field;
    const double pixels = f->x1 * f->y1 * LAYER_SCALE * LAYER_SCALE;
    const int scale = pixels <= MAX_LAYER_PIXELS ? LAYER_SCALE : 1;
    cairo_surface_t *layer = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, (int)ceil(f->x1) * scale,
                                                        (int)ceil(f->y1) * scale);
    struct canvas on_layer = *c;
    on_layer.cr = cairo_create(layer);
    cairo_scale(on_layer.cr, scale, scale);
    cairo_set_antialias(on_layer.cr, CAIRO_ANTIALIAS_NONE);
    fill_triangles(&on_layer, false, shading, order);
    const cairo_status_t status = cairo_status(on_layer.cr);
    cairo_destroy(on_layer.cr);
    cairo_save(c->cr);
    cairo_scale(c->cr, 1.0 / scale, 1.0 / scale);
    cairo_set_source_surface(c->cr, layer, 0, 0);
    cairo_pattern_set_filter(cairo_get_source(c->cr), CAIRO_FILTER_GOOD);
    cairo_paint(c->cr);
    cairo_restore(c->cr);
    cairo_surface_destroy(layer);
    return status;
}

static enum tri_status draw_triangles(const struct canvas *c, bool vector, const struct plot_shading *shading,
                                      struct tri_error *error)
{
    int32_t *order = order_by_shade(c->mesh, shading);
    cairo_status_t status = CAIRO_STATUS_SUCCESS;
    if (order == NULL)
        return plot_no_memory(error);
    if (vector)
        fill_triangles(c, true, shading, order);
    else
        status = fill_through_layer(c, shading, order);
    free(order);
    if (status != CAIRO_STATUS_SUCCESS)
        return tri_fail(error, TRI_INTERNAL, "", 0, "cairo: %s", cairo_status_to_string(status));
    return TRI_OK;
}

/* --- edges */

/* Edges stored at their lower end, once for each triangle. The other ends of edges at v are ends[start[v]] ..
 * ends[start[v + 1] - 1]. */
struct edge_list {
    size_t *start; /* [n_points + 1] */
    int32_t *ends;
};

static int32_t next_corner(const struct plot_mesh *mesh, size_t i)
{
    return mesh->corners[i % 3 == 2 ? i - 2 : i + 1];
}

static enum tri_status edge_list_make(struct edge_list *list, const struct plot_mesh *mesh, struct tri_error *error)
{
    const size_t n = 3 * (size_t)mesh->n_triangles;
    list->start = calloc((size_t)mesh->n_points + 1, sizeof *list->start);
    list->ends = malloc((n + 1) * sizeof *list->ends);
    if (list->start == NULL || list->ends == NULL)
        return plot_no_memory(error);
    for (size_t i = 0; i < n; i++)
        list->start[mesh->corners[i] < next_corner(mesh, i) ? mesh->corners[i] : next_corner(mesh, i)]++;
    for (int32_t v = 0; v < mesh->n_points; v++)
        list->start[v + 1] += list->start[v];
    for (size_t i = n; i-- > 0;) {
        const int32_t a = mesh->corners[i], b = next_corner(mesh, i);
        list->ends[--list->start[a < b ? a : b]] = a < b ? b : a;
    }
    return TRI_OK;
}

/* Returns true if the edge occurred before, with another triangle. */
static bool is_again(const struct edge_list *list, int32_t v, size_t i)
{
    size_t k = list->start[v];
    while (k < i && list->ends[k] != list->ends[i])
        k++;
    return k < i;
}

/* Returns how strongly an edge of this length in pixels is drawn: 0 (not) .. FADE_STEPS. */
static int strength(double length, enum plot_edges edges)
{
    if (edges == PLOT_EDGES_ON)
        return FADE_STEPS;
    return (int)fmin(fmax((length - 2) / 2, 0), FADE_STEPS);
}

/* Draws the collected lines from time to time, because a path must not become too long. */
static void draw_line(const struct canvas *c, struct pixel p, struct pixel q, int *in_path)
{
    add_line(c->cr, p, q);
    if (++*in_path % CHUNK == 0)
        cairo_stroke(c->cr);
}

static void draw_edges_of(const struct canvas *c, const struct edge_list *list, int wanted, enum plot_edges edges)
{
    int in_path = 0;
    for (int32_t v = 0; v < c->mesh->n_points; v++) {
        struct pixel end[2] = {place(c, v), {0, 0}};
        for (size_t i = list->start[v]; i < list->start[v + 1]; i++) {
            end[1] = place(c, list->ends[i]);
            if (in_field(&c->field, end, 2) &&
                strength(hypot(end[1].x - end[0].x, end[1].y - end[0].y), edges) == wanted && !is_again(list, v, i))
                draw_line(c, end[0], end[1], &in_path);
        }
    }
    cairo_stroke(c->cr);
}

static enum tri_status draw_edges(const struct canvas *c, const struct plot_style *style, struct tri_error *error)
{
    struct edge_list list = {0};
    const enum tri_status status = edge_list_make(&list, c->mesh, error);
    for (int step = 1; status == TRI_OK && step <= FADE_STEPS; step++) {
        const double share = (double)step / FADE_STEPS;
        cairo_set_line_width(c->cr, 0.4 + 0.4 * share);
        cairo_set_source_rgba(c->cr, 0.05, 0.08, 0.15, 0.15 + 0.45 * share);
        draw_edges_of(c, &list, step, style->edges);
    }
    free(list.start);
    free(list.ends);
    return status;
}

static void use_pen(const struct canvas *c, double width)
{
    cairo_set_line_width(c->cr, width);
    cairo_set_line_cap(c->cr, CAIRO_LINE_CAP_ROUND);
    cairo_set_source_rgb(c->cr, 0.05, 0.08, 0.15);
}

static void draw_segments(const struct canvas *c, double width)
{
    const struct plot_mesh *m = c->mesh;
    int in_path = 0;
    use_pen(c, width);
    for (int32_t s = 0; s < m->n_segments; s++) {
        const int32_t a = m->segments[2 * (size_t)s], b = m->segments[2 * (size_t)s + 1];
        if (a < 0 || b < 0 || a >= m->n_points || b >= m->n_points)
            continue;
        const struct pixel end[2] = {place(c, a), place(c, b)};
        if (in_field(&c->field, end, 2))
            draw_line(c, end[0], end[1], &in_path);
    }
    cairo_stroke(c->cr);
}

/* Draws points alone: a line of length 0 with round ends is a dot. */
static void draw_points(const struct canvas *c, double width)
{
    int in_path = 0;
    use_pen(c, width);
    for (int32_t v = 0; v < c->mesh->n_points; v++) {
        const struct pixel p = place(c, v);
        if (in_field(&c->field, &p, 1))
            draw_line(c, p, p, &in_path);
    }
    cairo_stroke(c->cr);
}

static void draw_mark(const struct canvas *c, const struct plot_box *mark, double width)
{
    struct pixel corner[8] = {
        {(mark->x0 - c->x0) * c->scale, (c->y1 - mark->y0) * c->scale},
        {(mark->x1 - c->x0) * c->scale, (c->y1 - mark->y0) * c->scale},
        {(mark->x1 - c->x0) * c->scale, (c->y1 - mark->y1) * c->scale},
        {(mark->x0 - c->x0) * c->scale, (c->y1 - mark->y1) * c->scale},
    };
    cairo_set_line_width(c->cr, width);
    cairo_set_line_join(c->cr, CAIRO_LINE_JOIN_MITER);
    cairo_set_source_rgb(c->cr, 0.85, 0.1, 0.15);
    add_polygon(c->cr, corner, 4);
    cairo_stroke(c->cr);
}

static uint32_t packed(struct plot_colour colour)
{
    return (uint32_t)lrint(255 * colour.red) << 16 | (uint32_t)lrint(255 * colour.green) << 8 |
           (uint32_t)lrint(255 * colour.blue);
}

/* Draws each pixel as part of an image. */
static enum tri_status draw_density(const struct canvas *c, const struct plot_shading *s, const struct plot_box *window,
                                    struct tri_error *error)
{
    const struct plot_density *d = s->density;
    cairo_surface_t *image = cairo_image_surface_create(CAIRO_FORMAT_RGB24, d->width, d->height);
    unsigned char *data = cairo_image_surface_get_data(image);
    if (data == NULL)
        return plot_no_memory(error);
    for (int y = 0; y < d->height; y++) {
        uint32_t *row = (uint32_t *)(void *)(data + (size_t)y * (size_t)cairo_image_surface_get_stride(image));
        for (int x = 0; x < d->width; x++) {
            const int shade = s->shade[(size_t)y * (size_t)d->width + (size_t)x];
            row[x] = shade < s->n_shades ? packed(s->shades[shade]) : 0xffffff;
        }
    }
    cairo_surface_mark_dirty(image);
    cairo_save(c->cr);
    cairo_translate(c->cr, (window->x0 - c->x0) * c->scale, (c->y1 - window->y1) * c->scale);
    cairo_scale(c->cr, (window->x1 - window->x0) * c->scale / d->width,
                (window->y1 - window->y0) * c->scale / d->height);
    cairo_set_source_surface(c->cr, image, 0, 0);
    cairo_pattern_set_filter(cairo_get_source(c->cr), CAIRO_FILTER_NEAREST);
    cairo_paint(c->cr);
    cairo_restore(c->cr);
    cairo_surface_destroy(image);
    return TRI_OK;
}

enum tri_status plot_field(cairo_t *cr, bool vector, const struct plot_mesh *mesh, const struct plot_shading *shading,
                           const struct plot_style *style, const struct plot_box *field, double pen,
                           struct tri_error *error)
{
    const struct canvas c = fit(cr, mesh, &style->window, field);
    cairo_save(cr);
    cairo_rectangle(cr, field->x0, field->y0, field->x1 - field->x0, field->y1 - field->y0);
    cairo_clip(cr);
    const bool density = shading->density != NULL;
    enum tri_status status = density ? draw_density(&c, shading, &style->window, error)
                                     : draw_triangles(&c, vector, shading, error);
    if (status == TRI_OK && !density && style->edges != PLOT_EDGES_OFF)
        status = draw_edges(&c, style, error);
    if (style->segments)
        draw_segments(&c, pen);
    if (mesh->n_triangles == 0 && !density)
        draw_points(&c, 3 * pen);
    if (style->has_mark)
        draw_mark(&c, &style->mark, 2.2 * pen);
    cairo_restore(cr);
    return status;
}
