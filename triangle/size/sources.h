/* The kinds of sources that lengths.c takes the least of. Each keeps what it needs, in units of the mesh, and does not
 * change any more.
 *
 * GRADATION. A source h0 is limited to the slope g by h(x) = min over y of h0(y) + g |x - y|: the largest field below
 * h0 of that slope. The least of several is limited if each is, so each sees to its own. An infinite g is no limit. */
#ifndef TRIANGLE_SIZE_SOURCES_H
#define TRIANGLE_SIZE_SOURCES_H

#include "triangle/size/candidates.h"

/* No length is longer than this: no edge of the mesh is. */
static inline double tri_size_cap(const struct tri_size_frame *frame)
{
    return 8 * tri_larger(frame->high.x - frame->low.x, frame->high.y - frame->low.y);
}

/* A length of a caller in units of the mesh; 0: it is no data. Infinite: the cap. */
static inline double tri_size_of(const struct tri_size_frame *frame, double length)
{
    return length > 0 ? tri_lesser(length / frame->mesh->unit, tri_size_cap(frame)) : 0;
}

/* A power of two by which lengths are divided to be kept as floats, and a length as it is kept: never 0. */
static inline double tri_size_scale(double longest)
{
    int exponent;
    frexp(longest, &exponent);
    return ldexp(1, exponent);
}

static inline float tri_size_float(double length, double scale)
{
    return (float)tri_larger(length / scale, 0x1p-120);
}

/* --- near.c: segments, each with a length and a growth of its own
 *
 * h is the least of length + growth * distance. */
struct tri_near_item {
    struct tri_point from, along; /* the other end is from + along; along may be 0 */
    double inverse;               /* 1 / |along|^2; 0 of a point */
    double length, growth;
};

struct tri_near {
    struct tri_near_item *item; /* [n] */
    int32_t n, capacity;
    struct tri_candidates candidates; /* once settled */
};

/* Adds one; false: no memory. */
bool tri_near_add(struct tri_near *near, struct tri_point a, struct tri_point b, double length, double growth);

/* To be called when all have been added. Nothing more is needed of the mesh. */
enum tri_status tri_near_settle(struct tri_near *near, const struct tri_size_frame *frame, struct tri_error *error);

/* n >= 1. Exact within the frame, but where more than eight segments compete within half of h: a percent more at most.
 * Beyond the frame: of those that compete at the nearest place in it. */
double tri_near_at(const struct tri_near *near, struct tri_point p);

/* Who has that length, and how far its nearest place is away. */
int32_t tri_near_winner(const struct tri_near *near, struct tri_point p, struct tri_point *away);
uint64_t tri_near_hash(const struct tri_near *near, uint64_t hash);
void tri_near_clear(struct tri_near *near);

/* --- raster.c: values on a grid, bilinear between its nodes */
struct tri_raster {
    double origin[2], inverse[2]; /* the first node; 1 / the step */
    int64_t n[2];                 /* columns, rows */
    double scale;                 /* of the values, a power of two */
    float *value;                 /* [n[1]][n[0]], limited */
};

/* No node has data: TRI_BAD_INPUT. Else TRI_NO_MEMORY, TRI_TOO_LARGE, TRI_STOPPED. */
enum tri_status tri_raster_make(struct tri_raster *raster, const struct tri_size_field *field,
                                const struct tri_size_frame *frame, struct tri_error *error);
double tri_raster_at(const struct tri_raster *raster, struct tri_point p);
uint64_t tri_raster_hash(const struct tri_raster *raster, uint64_t hash);
void tri_raster_clear(struct tri_raster *raster);

/* --- spread.c: what spreads over nodes that are in cells together
 *
 * least[v] becomes the least of base[w] + slope * |vw| over all nodes w that can be reached, and from[v] that w; an
 * infinite base spreads nothing. */
struct tri_spreading {
    const struct tri_point *at; /* [n] places of the nodes */
    int32_t n;
    const int32_t *cell;        /* [n_cells][corners] nodes */
    int32_t n_cells, corners;
};

/* TRI_NO_MEMORY, TRI_STOPPED. */
enum tri_status tri_spread(const struct tri_spreading *cells, const double *base, double slope, double *least,
                           int32_t *from, const struct tri_stop *stop, struct tri_error *error);

/* Gives nodes whose length is 0, no data, that of the nearest with data, and limits the slope. False in *has_data:
 * there are no data at all; lengths that cannot be reached from any stay 0. */
enum tri_status tri_spread_lengths(const struct tri_spreading *cells, double *length, double gradation, bool *has_data,
                                   const struct tri_stop *stop, struct tri_error *error);

/* --- sampled.c: a function of the caller, kept in a quadtree: asked for about so many places at most */
enum { TRI_SAMPLES = 3000000 };

struct tri_sampled {
    struct tri_quadtree tree; /* leaves are numbered from 0 */
    double scale;             /* of the values, a power of two */
    float *value;             /* [n][9] of a leaf, at the corners of its quarters, the lowest row first */
    int32_t n;
    bool is_coarse;           /* it varies too much for what is kept of it */
};

/* Asks the function, by this thread. It says nowhere how long: TRI_BAD_INPUT. Else TRI_NO_MEMORY, TRI_STOPPED. */
enum tri_status tri_sampled_make(struct tri_sampled *sampled, const struct tri_size_field *field,
                                 const struct tri_size_frame *frame, struct tri_error *error);
double tri_sampled_at(const struct tri_sampled *sampled, struct tri_point p);
uint64_t tri_sampled_hash(const struct tri_sampled *sampled, uint64_t hash);
void tri_sampled_clear(struct tri_sampled *sampled);

/* --- background.c: values at the vertices of a background mesh; without triangles at points, of which the nearest
 * counts, and which are not limited */
struct tri_background {
    struct tri_point *at; /* [n] vertices */
    double *length;       /* [n] limited */
    int32_t *corner;      /* [n_triangles][3] counter-clockwise */
    int32_t n, n_triangles;
    struct tri_candidates candidates; /* triangles */
};

/* The field's numbers are in range. No data: TRI_BAD_INPUT. Else TRI_NO_MEMORY, TRI_STOPPED. */
enum tri_status tri_background_make(struct tri_background *background, const struct tri_size_field *field,
                                    const struct tri_size_frame *frame, struct tri_error *error);
double tri_background_at(const struct tri_background *background, struct tri_point p);
uint64_t tri_background_hash(const struct tri_background *background, uint64_t hash);
void tri_background_clear(struct tri_background *background);

/* --- figure_sizes.c: lengths that the figure itself asks for, as items of near.c. If there is no limit on the slope,
 * they grow by 0.2. TRI_NO_MEMORY, TRI_STOPPED. */

/* At the border of each region with a bound on areas: the edge of an equilateral triangle of that area. */
enum tri_status tri_near_regions(struct tri_near *near, const struct tri_size_frame *frame, struct tri_error *error);

/* At vertices where curves of segments go on by at most 60 degrees: the circumference of the circle through three of
 * them in a row, over n. */
enum tri_status tri_near_curves(struct tri_near *near, const struct tri_size_frame *frame, double n,
                                struct tri_error *error);

/* Between walls - boundaries, and borders of regions - that face each other: how far they are apart, over n. */
enum tri_status tri_near_channels(struct tri_near *near, const struct tri_size_frame *frame, double n,
                                  struct tri_error *error);

#endif
