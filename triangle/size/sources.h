/* The kinds of size sources. lengths.c takes their minimum. Each source stores its data in units of the mesh and is
 * constant once made.
 *
 * GRADATION. A source h0 is limited to the slope g by h(x) = min over y of h0(y) + g |x - y|. This is the largest
 * field below h0 with that slope. The minimum of limited sources is limited as well, so each source is limited
 * separately. An infinite g means no limit. */
#ifndef TRIANGLE_SIZE_SOURCES_H
#define TRIANGLE_SIZE_SOURCES_H

#include "triangle/size/candidates.h"

/* Returns an upper limit for lengths. No edge of the mesh is longer. */
static inline double tri_size_cap(const struct tri_size_frame *frame)
{
    return 8 * tri_larger(frame->high.x - frame->low.x, frame->high.y - frame->low.y);
}

/* Converts a length of the caller to units of the mesh. Returns 0 if it is no data (not above 0). Longer lengths are
 * reduced to the upper limit. */
static inline double tri_size_of(const struct tri_size_frame *frame, double length)
{
    return length > 0 ? tri_lesser(length / frame->mesh->unit, tri_size_cap(frame)) : 0;
}

/* Returns a power of two by which lengths are divided to be stored as floats. tri_size_float converts a length for
 * storage; the result is never 0. */
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

/* --- near.c: segments, each with its own length and growth
 *
 * h is the minimum of length + growth * distance. */
struct tri_near_item {
    struct tri_point from, along; /* one end, and the vector to the other end; along is 0 for a point */
    double inverse;               /* 1 / |along|^2; 0 for a point */
    double length, growth;        /* h on the segment; increase of h per distance */
};

struct tri_near {
    struct tri_near_item *item; /* [n] */
    int32_t n, capacity;        /* segments; allocated */
    struct tri_candidates candidates; /* valid after tri_near_settle */
};

/* Adds the segment ab. Returns false if memory ran out. */
bool tri_near_add(struct tri_near *near, struct tri_point a, struct tri_point b, double length, double growth);

/* Call this after the last tri_near_add. The mesh is not needed afterwards. */
enum tri_status tri_near_settle(struct tri_near *near, const struct tri_size_frame *frame, struct tri_error *error);

/* Returns h at p; n must be at least 1. Exact inside the frame, except that if more than eight segments compete
 * within half of h, the result may be up to one percent too large. Outside the frame, only the segments that compete
 * at the nearest point of the frame count. */
double tri_near_at(const struct tri_near *near, struct tri_point p);

/* Returns the segment that determines h at p, and sets *away to the vector from p to its nearest point. */
int32_t tri_near_winner(const struct tri_near *near, struct tri_point p, struct tri_point *away);
uint64_t tri_near_hash(const struct tri_near *near, uint64_t hash);
void tri_near_clear(struct tri_near *near);

/* --- raster.c: values on a grid, bilinear between the nodes */
struct tri_raster {
    double origin[2], inverse[2]; /* position of the first node; 1 / grid step */
    int64_t n[2];                 /* columns, rows */
    double scale;                 /* factor for the values, a power of two */
    float *value;                 /* [n[1]][n[0]] lengths with limited gradient */
};

/* Returns TRI_BAD_INPUT if no node has data; also TRI_NO_MEMORY, TRI_TOO_LARGE or TRI_STOPPED. */
enum tri_status tri_raster_make(struct tri_raster *raster, const struct tri_size_field *field,
                                const struct tri_size_frame *frame, struct tri_error *error);
double tri_raster_at(const struct tri_raster *raster, struct tri_point p);
uint64_t tri_raster_hash(const struct tri_raster *raster, uint64_t hash);
void tri_raster_clear(struct tri_raster *raster);

/* --- spread.c: propagates lengths over nodes that share cells
 *
 * Sets least[v] to the minimum of base[w] + slope * |vw| over all nodes w reachable through cells, and from[v] to
 * the minimising w. A node with an infinite base does not propagate. */
struct tri_spreading {
    const struct tri_point *at; /* [n] positions of the nodes */
    int32_t n;                  /* number of nodes */
    const int32_t *cell;        /* [n_cells][corners] nodes of each cell */
    int32_t n_cells, corners;   /* number of cells; nodes per cell */
};

/* Returns TRI_OK, TRI_NO_MEMORY or TRI_STOPPED. */
enum tri_status tri_spread(const struct tri_spreading *cells, const double *base, double slope, double *least,
                           int32_t *from, const struct tri_stop *stop, struct tri_error *error);

/* Gives each node without data (length 0) the length of the nearest node with data, and limits the slope. Sets
 * *has_data to false if no node has data. Nodes that cannot be reached from a node with data keep 0. */
enum tri_status tri_spread_lengths(const struct tri_spreading *cells, double *length, double gradation, bool *has_data,
                                   const struct tri_stop *stop, struct tri_error *error);

/* --- sampled.c: a function of the caller, stored in a quadtree. It is called for at most this many points. */
enum { TRI_SAMPLES = 3000000 };

struct tri_sampled {
    struct tri_quadtree tree; /* leaves are numbered from 0 */
    double scale;             /* factor for the values, a power of two */
    float *value;             /* [n][9] values of each leaf at its 3 x 3 grid points, lowest row first */
    int32_t n;                /* number of leaves */
    bool is_coarse;           /* true: the function varies too much for the number of samples */
};

/* Calls the function, on this thread. Returns TRI_BAD_INPUT if it returned no length at any point; also
 * TRI_NO_MEMORY or TRI_STOPPED. */
enum tri_status tri_sampled_make(struct tri_sampled *sampled, const struct tri_size_field *field,
                                 const struct tri_size_frame *frame, struct tri_error *error);
double tri_sampled_at(const struct tri_sampled *sampled, struct tri_point p);
uint64_t tri_sampled_hash(const struct tri_sampled *sampled, uint64_t hash);
void tri_sampled_clear(struct tri_sampled *sampled);

/* --- background.c: values at the vertices of a background mesh. Without triangles, the value of the nearest point
 * counts, and gradients are not limited. */
struct tri_background {
    struct tri_point *at; /* [n] positions of the vertices */
    double *length;       /* [n] lengths with limited gradient */
    int32_t *corner;      /* [n_triangles][3] corners, counter-clockwise */
    int32_t n, n_triangles;           /* number of vertices; of triangles */
    struct tri_candidates candidates; /* candidate triangles for each place */
};

/* The field's indices must be in range. Returns TRI_BAD_INPUT if there are no data; also TRI_NO_MEMORY or
 * TRI_STOPPED. */
enum tri_status tri_background_make(struct tri_background *background, const struct tri_size_field *field,
                                    const struct tri_size_frame *frame, struct tri_error *error);
double tri_background_at(const struct tri_background *background, struct tri_point p);
uint64_t tri_background_hash(const struct tri_background *background, uint64_t hash);
void tri_background_clear(struct tri_background *background);

/* --- figure_sizes.c: lengths that follow from the shape of the input, added as items of near.c. If the gradient is
 * not limited, they grow by 0.2. The functions return TRI_OK, TRI_NO_MEMORY or TRI_STOPPED. */

/* On the border of each region with an area bound: the edge of an equilateral triangle with that area. */
enum tri_status tri_near_regions(struct tri_near *near, const struct tri_size_frame *frame, struct tri_error *error);

/* At vertices in smooth chains of segments (turning by at most 60 degrees): the circumference of the circle through
 * three consecutive vertices, divided by n. */
enum tri_status tri_near_curves(struct tri_near *near, const struct tri_size_frame *frame, double n,
                                struct tri_error *error);

/* Between facing walls (boundaries and borders of regions): their distance, divided by n. */
enum tri_status tri_near_channels(struct tri_near *near, const struct tri_size_frame *frame, double n,
                                  struct tri_error *error);

#endif
