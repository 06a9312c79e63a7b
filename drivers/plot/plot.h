/* The parts of meshplot: colours, the colour of each triangle (shading), and the drawing.
 *
 * Data flow: struct plot_mesh -> plot_shade_* -> struct plot_shading -> plot_draw -> any cairo surface. These functions
 * do not read files, print or exit. Ordinary floating point and libm are accurate enough for pictures. */
#ifndef DRIVERS_PLOT_PLOT_H
#define DRIVERS_PLOT_PLOT_H

#include <cairo.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "drivers/plot/plot.h"
#include "triangle/base/status.h"
#include "triangle/cdt/reconstruct.h"
#include "triangle/check/check.h"
#include "triangle/mesh/pslg.h"

/* --- colours */

struct plot_colour {
    double red, green, blue; /* sRGB, 0 .. 1 */
};

static inline void plot_set_colour(cairo_t *cr, struct plot_colour colour)
{
    cairo_set_source_rgb(cr, colour.red, colour.green, colour.blue);
}

/* --- a mesh, borrowed */

struct plot_mesh {
    int32_t n_points;
    const double *points; /* [n_points][2] scaled to |x|, |y| <= 1 by a power of two */
    int exponent;         /* the caller's coordinates are points * 2^exponent */
    int32_t n_triangles;
    const int32_t *corners; /* [n_triangles][3] */
    int32_t n_segments;
    const int32_t *segments; /* [n_segments][2]; they may refer to points that do not exist */
    int64_t all_points, all_triangles; /* numbers of the whole mesh, for the texts */
};

struct plot_box {
    double x0, y0, x1, y1; /* x0 < x1, y0 < y1 */
};

static const struct plot_box plot_box_empty = {INFINITY, INFINITY, -INFINITY, -INFINITY};

static inline void plot_box_extend(struct plot_box *box, const double *p)
{
    *box = (struct plot_box){fmin(box->x0, p[0]), fmin(box->y0, p[1]), fmax(box->x1, p[0]), fmax(box->y1, p[1])};
}

/* Returns a slightly wider box, which is never flat. */
static inline struct plot_box plot_box_widened(struct plot_box box)
{
    if (!(box.x0 <= box.x1))
        box = (struct plot_box){0, 0, 0, 0};
    const double longer = fmax(box.x1 - box.x0, box.y1 - box.y0), margin = longer > 0 ? 0.01 * longer : 0.5;
    return (struct plot_box){box.x0 - margin, box.y0 - margin, box.x1 + margin, box.y1 + margin};
}

static inline bool plot_boxes_meet(const struct plot_box *a, const struct plot_box *b)
{
    return a->x0 <= b->x1 && a->x1 >= b->x0 && a->y0 <= b->y1 && a->y1 >= b->y0;
}

static inline enum tri_status plot_no_memory(struct tri_error *error)
{
    return tri_fail(error, TRI_NO_MEMORY, "", 0, "out of memory");
}

/* Sorts numbers and removes duplicates. Returns the remaining number. */
int64_t plot_distinct(int64_t *number, int64_t n);

/* Number of triangles at each pixel, for meshes with too many triangles to draw. */
struct plot_density {
    int width, height;   /* size in pixels */
    struct plot_box box; /* area of the picture in the caller's coordinates */
    double *count;       /* [height][width] from the top; below 1 if triangles are larger than pixels */
};

/* Adds one triangle, in the caller's coordinates. O(covered pixels). */
void plot_density_add(struct plot_density *density, const double *const at[3]);

/* --- shading */

enum plot_legend {
    PLOT_LEGEND_NONE,
    PLOT_LEGEND_SCALE, /* shades in order, with a histogram */
    PLOT_LEGEND_KEYS   /* named colours */
};

enum { PLOT_MAX_TICKS = 16, PLOT_LABEL_BYTES = 32, PLOT_FACT_BYTES = 128 };

struct plot_key {
    struct plot_colour colour;
    char label[PLOT_LABEL_BYTES];
};

struct plot_tick {
    double at; /* position on the scale, 0 .. 1 */
    char label[PLOT_LABEL_BYTES];
};

struct plot_shading {
    uint16_t *shade; /* [n_triangles] index into shades; with density: of each pixel, n_shades is white */
    const struct plot_density *density;
    int n_shades;
    struct plot_colour *shades;
    int64_t *count; /* [n_shades] number of triangles of each shade */
    enum plot_legend legend;
    const char *title; /* title of the legend; static */
    int n_ticks;
    struct plot_tick ticks[PLOT_MAX_TICKS]; /* labels of a scale */
    int n_keys;
    struct plot_key *keys;
    char fact[PLOT_FACT_BYTES]; /* one line about the whole mesh, or "" */
};

/* Each function fills *shading, which must be freed in any case. Errors: TRI_NO_MEMORY. O(n log n). */
enum tri_status plot_shade_plain(struct plot_shading *shading, const struct plot_mesh *mesh, struct tri_error *error);
enum tri_status plot_shade_quality(struct plot_shading *shading, const struct plot_mesh *mesh, struct tri_error *error);
enum tri_status plot_shade_area(struct plot_shading *shading, const struct plot_mesh *mesh, struct tri_error *error);
/* value[n_triangles * stride]: the region of each triangle. */
enum tri_status plot_shade_region(struct plot_shading *shading, const struct plot_mesh *mesh, const double *value,
                                  int32_t stride, struct tri_error *error);
/* block_phase[n_triangles][2]; phase < 0: made outside the schedule. */
enum tri_status plot_shade_block(struct plot_shading *shading, const struct plot_mesh *mesh, const int32_t *block_phase,
                                 struct tri_error *error);
enum tri_status plot_shade_density(struct plot_shading *shading, const struct plot_density *density,
                                   struct tri_error *error);
void plot_shading_free(struct plot_shading *shading);

/* --- drawing */

enum plot_edges {
    PLOT_EDGES_AUTO, /* short edges fade, so that fine parts show their colour instead of black */
    PLOT_EDGES_ON,
    PLOT_EDGES_OFF
};

struct plot_style {
    double width;           /* width of the picture, pixels */
    struct plot_box window; /* part of the plane to show, in units of plot_mesh.points */
    bool has_mark;
    struct plot_box mark;   /* frame around another part */
    enum plot_edges edges;
    bool segments, legend;
    const char *title;      /* title; NULL: none */
};

/* Draws the mesh into a box of the surface, in pixels with y down. The window is as large as fits. pen: line width of
 * subsegments. vector: the surface stores outlines, not pixels. Errors: TRI_NO_MEMORY. O(n). */
enum tri_status plot_field(cairo_t *cr, bool vector, const struct plot_mesh *mesh, const struct plot_shading *shading,
                           const struct plot_style *style, const struct plot_box *field, double pen,
                           struct tri_error *error);

/* Returns the size of the window in the picture, in pixels. */
void plot_window_pixels(const struct plot_style *style, int *width, int *height);

/* Returns the height of the picture in pixels: that of the window, within limits, and of the texts. */
double plot_height(const struct plot_style *style, const struct plot_shading *shading);

/* Draws the whole picture with its upper left corner at the origin of `cr`. Errors: TRI_NO_MEMORY; TRI_INTERNAL with
 * the message of cairo. O(n). */
enum tri_status plot_draw(cairo_t *cr, bool vector, const struct plot_mesh *mesh, const struct plot_shading *shading,
                          const struct plot_style *style, struct tri_error *error);

/* --- Data of a mesh of any size, collected in one pass over its triangles: the triangles in a part of the plane, or
 * the number of triangles at each pixel. */

/* Returns the largest number of triangles that a picture shows one by one: 2^24. Builds with tests read
 * PTRIANGLE_TEST_TRIANGLES from the environment. */
int32_t plot_most_triangles(void);

/* Finds the box around all points, slightly wider, and never flat. */
enum tri_status plot_part_box(const struct tri_check_source *source, struct plot_box *box, struct tri_error *error);

/* Collects triangles (with their last attribute) and segments that may be visible in the window, and their points.
 * TRI_TOO_LARGE: more triangles than can be drawn. */
enum tri_status plot_part_take(const struct tri_check_source *source, const struct plot_box *window,
                               struct tri_pslg *mesh, struct tri_elements *elements, struct tri_error *error);

/* Counts the triangles at each pixel of density->box, and collects segments as above. */
enum tri_status plot_part_count(const struct tri_check_source *source, struct plot_density *density,
                                struct tri_pslg *mesh, struct tri_error *error);

#endif
