/* Definitions shared by the files of the checker. Private to them.
 *
 * METHOD. The mesh is read in parts: as many consecutive triangles as fit into memory (all of them without a limit).
 * In a part, vertices have local numbers. Everything about single triangles and pairs of neighbours in one part is
 * checked there. A half-edge whose twin is in another part is stored (store.c); after the last part these are
 * matched and checked. The half-edges left over are the boundary edges. Boundary edges, subsegments and input points
 * form the frame, which is completely in memory and on which all other checks work. For each vertex of the mesh, one
 * byte is stored.
 * THEOREM (docs/theory.md, the judge). Every faulty mesh is detected regardless of the division into parts. Only the
 * reported kind of fault may depend on it, if three half-edges lie on one edge.
 *
 * Half-edge 3 * t + k (64 bits) is the edge of triangle t opposite its corner k, directed so that t lies on its
 * left. A corner has the same number. In a part, t counts from the part's first triangle. */
#ifndef TRIANGLE_CHECK_INTERNAL_H
#define TRIANGLE_CHECK_INTERNAL_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "triangle/check/check.h"
#include "triangle/geometry/predicates.h"

/* A point for which the sweep determines whether it lies inside the mesh. */
struct check_query {
    struct tri_point at;      /* the point */
    enum tri_check_kind kind; /* kind of fault to report if it is inside */
    int32_t id;               /* number of the lost vertex, input segment, hole or region */
    double tolerance;         /* a point closer than this to a boundary edge does not count as inside */
    bool inside;              /* result: true if the point lies inside the mesh */
};

/* A missing piece of an input segment: a part of it for which the mesh has no edges. */
struct check_piece {
    struct tri_point from, to; /* ends of the piece */
};

/* One side of a subsegment. */
struct check_side {
    int64_t half_edge; /* the first half-edge there; -1: none */
    double attribute;  /* region attribute of its triangle */
};

/* A half-edge whose twin is not in its part. */
struct check_open {
    int64_t from, to, half_edge, apex; /* apex: the third vertex of its triangle */
    int64_t neighbor;                  /* given neighbour across this edge; -1: none, or neighbours are not given */
    double attribute;                  /* region attribute of its triangle */
    struct tri_point at[3];            /* positions of from, to and apex */
    bool constrained;                  /* true: lies on a subsegment */
};

struct check_opens {
    int64_t n, room; /* half-edges; allocated */
    struct check_open *at; /* [n] */
};

/* A half-edge without a twin in any part, with the data that the frame does not contain. */
struct check_boundary_edge {
    int64_t from, to, half_edge; /* end vertices; the half-edge */
    double attribute; /* region attribute of its triangle */
    bool constrained; /* true: lies on a subsegment */
};

struct check_boundary {
    int64_t n, room; /* edges; allocated */
    struct check_boundary_edge *at; /* [n] */
};

/* Consecutive triangles. The memory of all arrays is reused for the next part. */
struct check_part {
    int64_t first; /* first triangle */
    int32_t n_triangles, n_points, n_half_edges; /* half-edges: 3 per triangle */
    const int32_t *triangles;     /* [n_triangles][3] corners */
    const double *points;         /* [n_points][2] */
    const int64_t *vertex;        /* [n_points] numbers in the mesh, ascending */
    const int64_t *neighbors;     /* [n_triangles][3] given neighbours; NULL: not given */
    const double *attributes;     /* [n_triangles] last attribute; NULL: not given or not checked */

    /* Set in edges.c: */
    int32_t *entry_of;    /* [n_points + 1] index into entry */
    union {
        uint64_t *entry;  /* [n_half_edges] sorted half-edges, see edges.c */
        int64_t *corners; /* [n_half_edges] vertices as numbered in the mesh, while a part is read */
    };
    int32_t *link;        /* [n_half_edges] the twin; -1: not in this part */
    uint8_t *constrained; /* [n_half_edges] bit set: lies on a subsegment */

    struct check_room *room; /* buffers, see shares.c */
};

enum { /* flags of each vertex of the mesh */
    CHECK_USED = 1,     /* is used by a triangle */
    CHECK_BOUNDARY = 2, /* is an end of a boundary edge */
    CHECK_APEX = 4,     /* is an apex, see bounds.c */
    CHECK_NEAR = 8      /* is a corner of a triangle with an apex */
};

struct checker {
    const struct tri_check_source *source; /* the mesh to check */
    const struct tri_pslg *input;       /* NULL: unknown */
    const struct tri_check_options *options; /* what to check */
    struct tri_check_report *report;         /* the result */
    struct tri_error *error;                 /* details if a step fails */
    int64_t n_points, n_triangles;           /* of the whole mesh */

    /* check.c: of each kind, the fault with the smallest key is reported. `at` is the key of the current item. */
    int64_t at, key[TRI_N_CHECKS];

    const struct check_rule *rule; /* current rule for the part (pairs.c) */

    /* Set in survey.c: */
    int exponent;      /* coordinates are the given ones times 2^exponent */
    bool rounded;      /* true: scaled coordinates are also rounded */
    double tolerance;  /* distance; see TRI_CHECK_ULPS */
    struct tri_pslg scaled_input; /* the scaled input, to which `input` then points */
    double *scaled[3]; /* the input's scaled points, hole points and regions; NULL: not scaled */

    uint8_t *state; /* [n_points] flags, see CHECK_USED */

    /* Used in shares.c and store.c: */
    int64_t part_triangles; /* maximum number of triangles in a part */
    struct check_part part; /* current part */
    struct check_store *store;      /* half-edges without a twin so far */
    struct check_boundary boundary; /* boundary edges, sorted by half-edge */

    /* Used in bounds.c: */
    struct check_quality *quality;  /* results for angles and areas */

    /* The frame: vertices. */
    int32_t n_frame; /* number of frame vertices */
    double *points;  /* [n_frame][2] */
    int64_t *vertex; /* [n_frame] numbers in the mesh, ascending */
    /* The frame: the listed subsegments or, if none are given, the boundary edges. */
    int32_t n_segments;                 /* number of subsegments */
    int32_t *segments; /* [n_segments][2] frame vertices; -1, -1 if an end is no vertex or both are equal */
    int32_t *segment_markers;           /* [n_segments]; NULL: not given */
    struct check_side (*sides)[2];      /* [n_segments] left and right side, looking from the first end to the second */
    int64_t *listed;                    /* [n_segments][2] ends as given; NULL once `segments` exists */
    int32_t (*border)[2];               /* [boundary.n] ends of the boundary edges, as frame vertices */
    int32_t *fan_first;                 /* [n_frame + 1] index into fan */
    int32_t *fan; /* [2 * n_segments] fan entries 2 * s + end: subsegments grouped by the vertex at that end */

    /* Set in kept_input.c: */
    int64_t *found;  /* [input->n_points] used vertex of the mesh at each input point, -1: none */
    int32_t *twin;   /* [input->n_points] the same as a frame vertex */
    int64_t *unused; /* without an input: vertices of the mesh that no triangle uses */
    double *unused_points; /* [n_unused][2] their positions */
    int32_t n_unused;      /* number of unused vertices */

    /* Set in segment_chains.c: */
    uint8_t *is_along; /* [n_segments] 1: the subsegment lies along an input segment */
    struct check_piece *missing; /* [n_missing] missing pieces of input segments */
    int32_t n_missing, missing_capacity; /* missing pieces; allocated */

    struct check_query *queries; /* queries for the sweep */
    int32_t n_queries, query_capacity;   /* queries; allocated */
};

/* --- the steps of a check, in this order */

/* Reads all coordinates. If they are outside the range of exact arithmetic, all later steps see the mesh and the
 * input multiplied by a power of two. */
enum tri_status tri_check_survey(struct checker *c);
enum tri_status tri_check_list_segments(struct checker *c); /* reads c->listed and the markers */

/* Estimates the number of vertices per triangle from some consecutive triangles: about 0.5 if numbers are local, up
 * to 3 otherwise. */
enum tri_status tri_check_sample(struct checker *c, double *vertices);

/* Reads the part that starts at triangle `first`, and sets CHECK_USED for its vertices. A corner that is no vertex
 * is a fault of kind ARRAYS; then *good is false and there is no part. */
enum tri_status tri_check_load(struct checker *c, int64_t first, bool *good);
void tri_check_release_part(struct checker *c);
int32_t tri_check_local(const struct checker *c, int64_t v); /* returns the local number of vertex v, -1: not in the
                                                                part. O(1) */

void tri_check_orientation(struct checker *c);      /* of the triangles of the part */
/* Pairs the half-edges of the part, and marks those on subsegments. */
enum tri_status tri_check_pair(struct checker *c);
enum tri_status tri_check_keep_open(struct checker *c); /* stores half-edges without a twin */
struct check_open tri_check_open(const struct checker *c, int32_t h); /* returns all data of half-edge h of the part */
void tri_check_pairs(struct checker *c); /* checks the rules of pairs.c in the part */
/* The same for two half-edges matched across parts, or for a boundary edge (b is NULL). */
void tri_check_matched(struct checker *c, const struct check_open *a, const struct check_open *b);
enum tri_status tri_check_nodes(struct checker *c);      /* needs the number of edges and the listed subsegments */
enum tri_status tri_check_attributes(struct checker *c); /* attributes of vertices */
enum tri_status tri_check_match(struct checker *c); /* after the last part: checks EDGES, fills boundary and counts */

enum tri_status tri_check_find_twins(struct checker *c); /* fills found, or unused */
enum tri_status tri_check_frame(struct checker *c);
int32_t tri_check_in_frame(const struct checker *c, int64_t v); /* returns -1 if v is not in the frame or is -1.
                                                                   O(log n) */
enum tri_status tri_check_subsegments(struct checker *c); /* fills the fan */
enum tri_status tri_check_input(struct checker *c);       /* adds queries */
/* Checks that each input segment is a chain of subsegments, with its marker. Fills is_along and missing; adds
 * queries. O(n) for n input segments and subsegments, but O(n) for each input segment that is not one chain from end
 * to end. */
enum tri_status tri_check_chains(struct checker *c);
enum tri_status tri_check_border(struct checker *c);      /* needs chains */
enum tri_status tri_check_vertex_markers(struct checker *c); /* needs subsegments, twins */
enum tri_status tri_check_overlap(struct checker *c);     /* needs EDGES and ORIENTATION; answers the queries */
void tri_check_answers(struct checker *c);                /* evaluates the answers, if overlap found no fault */
enum tri_status tri_check_hull(struct checker *c);        /* needs OVERLAP */

enum tri_status tri_check_begin_quality(struct checker *c);
void tri_check_shapes(struct checker *c); /* of the triangles of the part */
enum tri_status tri_check_quality(struct checker *c); /* needs subsegments; reads parts again */

/* --- tools */

/* Reads elements first .. first + n - 1 of an array of the mesh. Points are scaled if necessary. */
enum tri_status tri_check_read(struct checker *c, enum tri_check_array array, int64_t first, int64_t n, void *out);

/* Calls `take` for all elements of an array before `end`, in order and several at a time. bytes: size of an element. */
typedef void check_take(void *user, int64_t first, int64_t n, const void *elements);
enum tri_status tri_check_each_slice(struct checker *c, enum tri_check_array array, int64_t end, size_t bytes,
                                     check_take *take, void *user);

/* Reads only the elements with the given numbers, which must be ascending. */
enum tri_status tri_check_gather(struct checker *c, enum tri_check_array array, const int64_t *numbers, int64_t n,
                                 size_t bytes, void *out);

/* Sorts numbers and removes duplicates; returns how many remain. */
int64_t tri_check_distinct(int64_t *numbers, int64_t n);
int tri_check_compare_numbers(const void *left, const void *right); /* for qsort and bsearch */

/* Marks a kind as checked. It counts as passed until a fault is reported. */
void tri_check_begin(struct checker *c, enum tri_check_kind kind);
/* Counts a fault. Keeps the text of the fault with the smallest key; among equal keys, of the first one. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
void tri_check_fault(struct checker *c, enum tri_check_kind kind, const char *format, ...);
/* A share: a range of items. Shares are processed in parallel. */
enum { CHECK_MOST_SHARES = 64 };

struct check_share {
    size_t number; /* number of the share */
    int64_t first, end; /* items first .. end - 1 */
};

typedef void check_work(void *user, const struct check_share *share);

/* Processes items 0 .. n - 1 in parallel shares of at least a few thousand items. */
void tri_check_in_shares(const struct checker *c, int64_t n, check_work *work, void *user);

/* Counts the items 0 .. n - 1 for which is_so returns true, and sets *first to the first of them if there is one. */
int64_t tri_check_count(const struct checker *c, int64_t n, bool (*is_so)(const struct checker *c, int64_t i),
                        int64_t *first);
/* Checks items 0 .. n - 1 for faults of one kind, and begins that kind. Every item for which is_bad returns true is
 * a fault; the first one is reported, with the key `first` + its number. The report does not depend on the number of
 * threads. */
void tri_check_each(struct checker *c, enum tri_check_kind kind, int64_t first, int64_t n,
                    bool (*is_bad)(const struct checker *c, int64_t i), void (*tell)(struct checker *c, int64_t i));
/* Adds a query: does the point lie inside the mesh? The point may have any coordinates, also infinite ones or NaN. */
enum tri_status tri_check_query(struct checker *c, struct tri_point at, enum tri_check_kind kind, int32_t id,
                              double tolerance);

/* Allocate n * size bytes, the second zeroed. The result is not NULL for n = 0. */
void *tri_check_array(int64_t n, size_t size);
void *tri_check_zeros(int64_t n, size_t size);

static inline bool check_good(const struct checker *c, enum tri_check_kind kind)
{
    return c->report->item[kind].state == TRI_CHECK_OK;
}

static inline bool check_is_given(const struct checker *c, enum tri_check_array array)
{
    return c->source->given >> array & 1;
}

/* Are the subsegments known? */
static inline bool check_is_listed(const struct checker *c)
{
    return check_is_given(c, TRI_CHECK_SEGMENT_ENDS);
}

static inline bool check_wants_regions(const struct checker *c)
{
    return c->input != NULL && check_is_given(c, TRI_CHECK_ATTRIBUTES) && check_is_listed(c) &&
           c->input->n_regions > 0 && c->options->border != TRI_CHECK_BORDER_ANY;
}

/* --- the part */

static inline int32_t check_org(const struct checker *c, int32_t half_edge)
{
    return c->part.triangles[half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1];
}
static inline int32_t check_dest(const struct checker *c, int32_t half_edge)
{
    return c->part.triangles[half_edge % 3 == 0 ? half_edge + 2 : half_edge - 1];
}
static inline int32_t check_apex(const struct checker *c, int32_t half_edge)
{
    return c->part.triangles[half_edge];
}
static inline struct tri_point check_place(const struct checker *c, int32_t v)
{
    const double *p = c->part.points + 2 * (size_t)v;
    return (struct tri_point){p[0], p[1]};
}
static inline bool check_is_constrained(const struct checker *c, int32_t half_edge)
{
    return c->part.constrained[half_edge >> 3] >> (half_edge & 7) & 1;
}
/* Returns the last attribute of triangle t. */
static inline double check_attribute(const struct checker *c, int32_t t)
{
    return c->part.attributes == NULL ? 0 : c->part.attributes[t];
}

/* --- the frame */

static inline struct tri_point check_point(const struct checker *c, int32_t v)
{
    const double *p = c->points + 2 * (size_t)v;
    return (struct tri_point){p[0], p[1]};
}
/* Are the ends of subsegment s two different vertices? */
static inline bool check_is_listed_well(const struct checker *c, int32_t s)
{
    return c->segments[2 * (size_t)s] >= 0;
}
/* Does the mesh lie on at most one side of subsegment s? */
static inline bool check_is_border(const struct checker *c, int32_t s)
{
    return c->sides[s][0].half_edge < 0 || c->sides[s][1].half_edge < 0;
}

/* --- numbers and positions */

static inline bool check_is_used(const struct checker *c, int64_t v)
{
    return (c->state[v] & CHECK_USED) != 0;
}
static inline bool check_same_place(struct tri_point p, struct tri_point q)
{
    return p.x == q.x && p.y == q.y;
}
/* Is p an end of the segment ab, or exactly on its line? If p is only within the tolerance, it is undecidable
 * whether the segment meets p or leaves a gap. */
static inline bool check_surely_meets(struct tri_point a, struct tri_point b, struct tri_point p)
{
    return check_same_place(p, a) || check_same_place(p, b) || tri_orient2d(a, b, p) == 0;
}

/* Returns a coordinate as it was given, before scaling. */
static inline double check_given(const struct checker *c, double x)
{
    return ldexp(x, -c->exponent);
}
/* Return the number used in the report's texts: for vertex or triangle i of the mesh, */
static inline long check_number(const struct checker *c, int64_t i)
{
    return (long)i + c->options->base;
}
/* for a vertex or triangle of the part, */
static inline long check_part_vertex(const struct checker *c, int32_t v)
{
    return check_number(c, c->part.vertex[v]);
}
static inline long check_part_triangle(const struct checker *c, int32_t t)
{
    return check_number(c, c->part.first + t);
}
/* and for a vertex of the frame. */
static inline long check_frame_vertex(const struct checker *c, int32_t v)
{
    return check_number(c, c->vertex[v]);
}

/* --- missing pieces: parts of input segments for which the mesh has no edges */

struct check_pieces {
    int32_t n;              /* number of pieces */
    struct check_piece *at; /* [n] owned by the receiver */
};

/* Sorts c->missing from left to right and removes duplicates. */
void tri_check_sort_missing(struct checker *c);

/* Returns c->missing (sorted), cut where pieces meet, so that they share only end points, up to rounding. Returns no
 * pieces if this would take too much time or memory. Takes about n sqrt(n) steps if pieces are short and separate. */
enum tri_status tri_check_split_missing(const struct checker *c, struct check_pieces *pieces);

/* --- store of half-edges whose twin is in another part
 *
 * As many as the limit allows are in memory, the rest in anonymous files chosen by a hash of the edge. */
enum tri_status tri_check_store_new(struct checker *c);
void tri_check_store_free(struct check_store *store);

/* Returns TRI_OK, TRI_NO_MEMORY or TRI_CANNOT_WRITE. */
enum tri_status tri_check_store_add(struct checker *c, struct check_open e);

#endif
