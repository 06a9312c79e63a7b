/* What the files of the judge share: the trial in progress. Private to them.
 *
 * A half-edge is named 3 * t + k: the edge of triangle t opposite its corner k, directed so that t lies on its left. A
 * corner has the same name. */
#ifndef TRIANGLE_CHECK_INTERNAL_H
#define TRIANGLE_CHECK_INTERNAL_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "triangle/check/check.h"
#include "triangle/predicates.h"

/* A point whose place, inside or outside the mesh, the sweep is to find out. */
struct check_query {
    struct tri_point at;
    enum tri_check_kind kind; /* fault to report if it is inside */
    int32_t id;               /* vertex, input segment or hole */
    double tolerance;         /* nearer to an edge of the boundary it does not count as inside */
    bool inside;              /* the sweep's answer: it is where it should not be */
};

/* Of an input segment: what lies between two places where the mesh has it, or its end. */
struct check_piece {
    struct tri_point from, to;
};

/* The half-edges between two vertices a and b. */
struct check_edge {
    int32_t there, back;     /* the first from a to b, and from b to a; -1: none */
    int32_t n_there, n_back; /* how many there are */
};

struct checker {
    const struct tri_check_mesh *mesh;
    const struct tri_pslg *input; /* or NULL */
    const struct tri_check_options *options;
    struct tri_check_report *report;
    int32_t n_half_edges; /* 3 * n_triangles */

    /* scale.c */
    int exponent; /* the coordinates seen are the given ones times 2^exponent */
    struct tri_check_mesh scaled_mesh;
    struct tri_pslg scaled_input;
    double *scaled[4]; /* their points, the input's, its hole points, its regions; NULL: not scaled */

    /* edges.c */
    int32_t *first;  /* [n_points + 1] into entry */
    uint64_t *entry; /* [n_half_edges] see there */
    int32_t *link;   /* [n_half_edges] the same edge in the neighbour; -1: boundary */
    uint8_t *used;   /* [n_points] is it a corner? */

    /* stars.c */
    int32_t *turns;       /* [n_points] */
    uint8_t *on_boundary; /* [n_points] */

    /* segments.c; these are the listed subsegments, or where none are given the boundary edges */
    int32_t n_segments;
    const int32_t *segments; /* [n_segments][2] */
    int32_t *own_segments;   /* segments, if made here */
    uint8_t *constrained;    /* [n_half_edges] bits */
    int32_t *fan_first;      /* [n_points + 1] into fan */
    int32_t *fan; /* [2 * n_segments] 2 * s + end: subsegments, grouped by vertex, which is their given end */

    /* input.c */
    int32_t *twin;    /* [input->n_points] used vertex at the place of an input point, -1: none */
    double tolerance; /* distance; see TRI_CHECK_ULPS */

    /* chain.c */
    uint8_t *is_along; /* [n_segments] does the subsegment lie along an input segment? */
    struct check_piece *missing; /* [n_missing] of input segments */
    int32_t n_missing, missing_capacity;

    struct check_query *queries; /* for the sweep */
    int32_t n_queries, query_capacity;
};

void tri_check_arrays(struct checker *c);
void tri_check_orientation(struct checker *c);            /* needs ARRAYS */
enum tri_status tri_check_edges(struct checker *c);       /* needs ARRAYS: pairs the half-edges, compares neighbours */
enum tri_status tri_check_stars(struct checker *c);       /* needs EDGES, ORIENTATION */
enum tri_status tri_check_overlap(struct checker *c);     /* needs the same; answers the queries */
enum tri_status tri_check_hull(struct checker *c);        /* needs OVERLAP */
enum tri_status tri_check_subsegments(struct checker *c); /* needs EDGES; fills the fields above */
void tri_check_delaunay(struct checker *c);               /* needs EDGES, ORIENTATION, subsegments */
enum tri_status tri_check_input(struct checker *c);       /* needs ARRAYS, subsegments; adds queries */
enum tri_status tri_check_regions(struct checker *c);     /* needs EDGES, subsegments; adds queries */
enum tri_status tri_check_border(struct checker *c);      /* needs chains */
enum tri_status tri_check_vertex_markers(struct checker *c); /* needs EDGES, subsegments, twins */
void tri_check_answers(struct checker *c);                /* where overlap has found nothing: judges the answers */
enum tri_status tri_check_quality(struct checker *c);     /* needs EDGES, subsegments */

/* Where the mesh is out of the range of exact arithmetic, puts copies of mesh and input in its place whose coordinates
 * are multiplied by a power of two; nothing else sees the originals. */
enum tri_status tri_check_scale(struct checker *c);

/* Notes that the kind has been looked at; it stays good until a fault is reported. */
void tri_check_begin(struct checker *c, enum tri_check_kind kind);
/* Counts a fault and keeps the text of the first one. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
void tri_check_fault(struct checker *c, enum tri_check_kind kind, const char *format, ...);
/* Looks at items 0 .. n - 1, on all cores: all that is_bad says so of are faults of this kind, which begins here; the
 * first of them is told. The same report whatever the number of threads. */
void tri_check_each(struct checker *c, enum tri_check_kind kind, int32_t n,
                    bool (*is_bad)(const struct checker *c, int32_t i), void (*tell)(struct checker *c, int32_t i));
/* Asks the sweep whether the point, of any size, finite or not, lies inside the mesh. */
enum tri_status tri_check_ask(struct checker *c, struct tri_point at, enum tri_check_kind kind, int32_t id,
                              double tolerance);

/* O(log n). */
struct check_edge tri_check_find_edge(const struct checker *c, int32_t a, int32_t b);

/* n * size bytes, never a null pointer for n = 0. */
void *tri_check_array(int64_t n, size_t size);
void *tri_check_zeros(int64_t n, size_t size);

static inline bool check_good(const struct checker *c, enum tri_check_kind kind)
{
    return c->report->item[kind].state == TRI_CHECK_OK;
}

static inline int32_t check_next(int32_t corner)
{
    return corner % 3 == 2 ? corner - 2 : corner + 1;
}
static inline int32_t check_prev(int32_t corner)
{
    return corner % 3 == 0 ? corner + 2 : corner - 1;
}
static inline int32_t check_org(const struct checker *c, int32_t half_edge)
{
    return c->mesh->triangles[check_next(half_edge)];
}
static inline int32_t check_dest(const struct checker *c, int32_t half_edge)
{
    return c->mesh->triangles[check_prev(half_edge)];
}
static inline int32_t check_apex(const struct checker *c, int32_t half_edge)
{
    return c->mesh->triangles[half_edge];
}

static inline struct tri_point check_point(const struct checker *c, int32_t v)
{
    const double *p = c->mesh->points + 2 * (size_t)v;
    return (struct tri_point){p[0], p[1]};
}
/* The last one of triangle t. */
static inline double check_attribute(const struct checker *c, int32_t t)
{
    int32_t n = c->mesh->n_attributes;
    return c->mesh->attributes[(size_t)n * (size_t)t + (size_t)n - 1];
}
static inline bool check_is_used(const struct checker *c, int32_t v)
{
    return c->used[v] != 0;
}
static inline bool check_same_place(struct tri_point p, struct tri_point q)
{
    return p.x == q.x && p.y == q.y;
}

/* Are the ends of subsegment s two vertices? */
static inline bool check_is_listed_well(const struct checker *c, int32_t s)
{
    int32_t a = c->segments[2 * (size_t)s], b = c->segments[2 * (size_t)s + 1], n = c->mesh->n_points;
    return a >= 0 && a < n && b >= 0 && b < n && a != b;
}

static inline bool check_is_constrained(const struct checker *c, int32_t half_edge)
{
    return c->constrained[half_edge >> 3] >> (half_edge & 7) & 1;
}

/* A coordinate as it was given. */
static inline double check_given(const struct checker *c, double x)
{
    return ldexp(x, -c->exponent);
}

/* Number that the report's texts use for vertex or triangle i. */
static inline long check_number(const struct checker *c, int32_t i)
{
    return (long)i + c->options->base;
}

#endif
