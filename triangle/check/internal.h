/* What the files of the judge share: the trial in progress. Private to them.
 *
 * THE WAY. The mesh is looked at part by part: as many triangles at a time, in their order, as the memory holds (all of
 * them, where no bound is set). Vertices have numbers of their own in a part. What triangles of one part say by
 * themselves or as neighbours is judged there. Half-edges whose other side is not in the part are kept (store.c),
 * matched when all parts have been seen, and judged then. The boundary edges are left. These, the subsegments and the
 * input's points are the frame, in memory as a whole, on which all other checks work. Of vertices a byte is kept.
 *
 * THEOREM (docs/theory.md, the judge). No faulty mesh passes over the cut into parts; only which kind of fault is told
 * may depend on them, where three half-edges lie on one edge.
 *
 * A half-edge of the mesh is named 3 * t + k, 64 bits wide: the edge of triangle t opposite its corner k, directed so
 * that t lies on its left. A corner has the same name. In a part t counts from the part's first triangle. */
#ifndef TRIANGLE_CHECK_INTERNAL_H
#define TRIANGLE_CHECK_INTERNAL_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "triangle/check/check.h"
#include "triangle/geometry/predicates.h"

/* A point whose place, inside or outside the mesh, the sweep is to find out. */
struct check_query {
    struct tri_point at;
    enum tri_check_kind kind; /* fault to report if it is inside */
    int32_t id;               /* lost vertex, input segment or hole */
    double tolerance;         /* nearer to an edge of the boundary it does not count as inside */
    bool inside;              /* the sweep's answer: it is where it should not be */
};

/* Of an input segment: what lies between two places where the mesh has it, or its end. */
struct check_piece {
    struct tri_point from, to;
};

/* What lies on one side of a subsegment. */
struct check_side {
    int64_t half_edge; /* the first; -1: none */
    double attribute;  /* of its triangle */
};

/* A half-edge whose other side is not in its part. */
struct check_open {
    int64_t from, to, half_edge, apex; /* apex: the vertex of its triangle that is not on it */
    int64_t neighbor;                  /* triangle on the other side as it is given; -1: none, or nothing given */
    double attribute;                  /* of its triangle */
    struct tri_point at[3];            /* places of from, to, apex */
    bool constrained;
};

struct check_opens {
    int64_t n, room;
    struct check_open *at;
};

/* A half-edge that has no other side in any part: what is needed of it beside the frame. */
struct check_boundary_edge {
    int64_t from, to, half_edge;
    double attribute; /* of its triangle */
    bool constrained;
};

struct check_boundary {
    int64_t n, room;
    struct check_boundary_edge *at;
};

/* Triangles in a row. The first arrays lie in the part's room, which serves the next part again, as the others do. */
struct check_part {
    int64_t first; /* triangle */
    int32_t n_triangles, n_points, n_half_edges;
    const int32_t *triangles;     /* [n_triangles][3] corners */
    const double *points;         /* [n_points][2] */
    const int64_t *vertex;        /* [n_points] their numbers in the mesh, ascending */
    const int64_t *neighbors;     /* [n_triangles][3] as given; NULL: they are not */
    const double *attributes;     /* [n_triangles] the last of each; NULL: not given, or not looked at */

    /* edges.c */
    int32_t *entry_of;    /* [n_points + 1] into entry */
    union {
        uint64_t *entry;  /* [n_half_edges] see there */
        int64_t *corners; /* [n_half_edges] by their numbers in the mesh, while a part is read */
    };
    int32_t *link;        /* [n_half_edges] the same edge in the neighbour; -1: open */
    uint8_t *constrained; /* [n_half_edges] bits */

    struct check_room *room; /* shares.c */
};

enum { /* of each vertex of the mesh */
    CHECK_USED = 1,     /* it is a corner */
    CHECK_BOUNDARY = 2, /* of a boundary edge, an end */
    CHECK_APEX = 4,     /* see bounds.c */
    CHECK_NEAR = 8      /* in a triangle with an apex */
};

struct checker {
    const struct tri_check_source *source;
    const struct tri_pslg *input;       /* or NULL */
    const struct tri_check_options *options;
    struct tri_check_report *report;
    struct tri_error *error;
    int64_t n_points, n_triangles;

    /* check.c: the fault told of each kind is that with the least key; `at` is the key of what is looked at now */
    int64_t at, key[TRI_N_CHECKS];

    const struct check_rule *rule; /* pairs.c: asked now of the part */

    /* survey.c */
    int exponent;      /* the coordinates seen are the given ones times 2^exponent */
    bool rounded;      /* and rounded */
    double tolerance;  /* distance; see TRI_CHECK_ULPS */
    struct tri_pslg scaled_input;
    double *scaled[3]; /* its points, hole points and regions; NULL: not scaled */

    uint8_t *state; /* [n_points] */

    /* shares.c, store.c */
    int64_t part_triangles; /* in a part, at most */
    struct check_part part;
    struct check_store *store;
    struct check_boundary boundary; /* what is left at last, by half-edge */

    /* bounds.c */
    struct check_quality *quality;

    /* The frame: vertices */
    int32_t n_frame;
    double *points;  /* [n_frame][2] */
    int64_t *vertex; /* [n_frame] their numbers in the mesh, ascending */
    /* The frame: the listed subsegments, or where none are given the boundary edges */
    int32_t n_segments;
    int32_t *segments; /* [n_segments][2] vertices of the frame; -1, -1 where an end is no vertex or they equal */
    int32_t *segment_markers;           /* [n_segments] or NULL: not given */
    struct check_side (*sides)[2];      /* [n_segments] left of it, from its first end to the second, and right */
    int64_t *listed;                    /* [n_segments][2] as they are given; NULL once `segments` is there */
    int32_t (*border)[2];               /* [boundary.n] ends of the boundary edges, as vertices of the frame */
    int32_t *fan_first;                 /* [n_frame + 1] into fan */
    int32_t *fan; /* [2 * n_segments] 2 * s + end: subsegments, grouped by vertex, which is their given end */

    /* kept_input.c */
    int64_t *found;  /* [input->n_points] used vertex of the mesh at the place of an input point, -1: none */
    int32_t *twin;   /* [input->n_points] the same in the frame */
    int64_t *unused; /* vertices of the mesh that no triangle uses, where there is no input */
    double *unused_points;
    int32_t n_unused;

    /* segment_chains.c */
    uint8_t *is_along; /* [n_segments] does the subsegment lie along an input segment? */
    struct check_piece *missing; /* [n_missing] of input segments */
    int32_t n_missing, missing_capacity;

    struct check_query *queries; /* for the sweep */
    int32_t n_queries, query_capacity;
};

/* --- in the order of the trial */

/* Looks at all coordinates. Where they are out of the range of exact arithmetic, the mesh and the input are seen
 * multiplied by a power of two from here on. */
enum tri_status tri_check_survey(struct checker *c);
enum tri_status tri_check_list_segments(struct checker *c); /* reads c->listed and markers */

/* Vertices for each triangle, of some triangles in a row: about 0.5 where numbers are local, up to 3 if not. */
enum tri_status tri_check_sample(struct checker *c, double *vertices);

/* A part from triangle `first` on; its vertices are CHECK_USED. Corners that are no vertices are faults of ARRAYS; then
 * there is no part. */
enum tri_status tri_check_load(struct checker *c, int64_t first, bool *good);
void tri_check_release_part(struct checker *c);
int32_t tri_check_local(const struct checker *c, int64_t v); /* number of vertex v in the part, -1: not there. O(1) */

void tri_check_orientation(struct checker *c);      /* of the part */
/* Pairs the half-edges of the part, and constrains them. */
enum tri_status tri_check_pair(struct checker *c);
enum tri_status tri_check_keep_open(struct checker *c); /* puts half-edges without other side into the store */
struct check_open tri_check_open(const struct checker *c, int32_t h); /* half-edge h of the part, in full */
void tri_check_pairs(struct checker *c); /* neighbours given, Delaunay, circles of segments, attributes: in the part */
/* The same of two half-edges that have been matched across parts, or of one that has no other side (b is NULL). */
void tri_check_matched(struct checker *c, const struct check_open *a, const struct check_open *b);
enum tri_status tri_check_nodes(struct checker *c);      /* needs the number of edges, and subsegments listed */
enum tri_status tri_check_attributes(struct checker *c); /* of vertices */
enum tri_status tri_check_match(struct checker *c); /* when all parts have been seen: EDGES; fills boundary, counts */

enum tri_status tri_check_find_twins(struct checker *c); /* fills found, or unused */
enum tri_status tri_check_frame(struct checker *c);
int32_t tri_check_in_frame(const struct checker *c, int64_t v); /* -1: not there, or v is -1. O(log n) */
enum tri_status tri_check_subsegments(struct checker *c); /* fills the fan */
enum tri_status tri_check_input(struct checker *c);       /* adds queries */
/* Each segment of the input is a chain of subsegments, with its marker. Fills is_along, missing; adds queries. O(n) for
 * n input segments and subsegments, but n for each input segment that is not one chain from end to end. */
enum tri_status tri_check_chains(struct checker *c);
enum tri_status tri_check_border(struct checker *c);      /* needs chains */
enum tri_status tri_check_vertex_markers(struct checker *c); /* needs subsegments, twins */
enum tri_status tri_check_overlap(struct checker *c);     /* needs EDGES, ORIENTATION; answers the queries */
void tri_check_answers(struct checker *c);                /* where overlap has found nothing: judges the answers */
enum tri_status tri_check_hull(struct checker *c);        /* needs OVERLAP */

enum tri_status tri_check_begin_quality(struct checker *c);
void tri_check_shapes(struct checker *c); /* of the part */
enum tri_status tri_check_quality(struct checker *c); /* needs subsegments; looks at parts again */

/* --- tools */

/* Elements first .. first + n - 1 of an array of the mesh, points as they are to be seen. */
enum tri_status tri_check_read(struct checker *c, enum tri_check_array array, int64_t first, int64_t n, void *out);

/* All elements of such an array before `end`, of so many bytes each, in order, some at a time. */
typedef void check_take(void *user, int64_t first, int64_t n, const void *elements);
enum tri_status tri_check_each_slice(struct checker *c, enum tri_check_array array, int64_t end, size_t bytes,
                                     check_take *take, void *user);

/* Those elements alone whose numbers are given, ascending. */
enum tri_status tri_check_gather(struct checker *c, enum tri_check_array array, const int64_t *numbers, int64_t n,
                                 size_t bytes, void *out);

/* Sorts numbers and drops repetitions; returns how many remain. */
int64_t tri_check_distinct(int64_t *numbers, int64_t n);
int tri_check_compare_numbers(const void *left, const void *right); /* of qsort and bsearch */

/* Notes that the kind has been looked at; it stays good until a fault is reported. */
void tri_check_begin(struct checker *c, enum tri_check_kind kind);
/* Counts a fault and keeps the text of the one with the least key, of the first one among equals. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
void tri_check_fault(struct checker *c, enum tri_check_kind kind, const char *format, ...);
/* Items that may be worked on at the same time as those of other shares. */
enum { CHECK_MOST_SHARES = 64 };

struct check_share {
    size_t number;
    int64_t first, end;
};

typedef void check_work(void *user, const struct check_share *share);

/* Works on items 0 .. n - 1, in shares of a few thousand at least. */
void tri_check_in_shares(const struct checker *c, int64_t n, check_work *work, void *user);

/* How many of items 0 .. n - 1 are so, and the first of them, if there is one. */
int64_t tri_check_count(const struct checker *c, int64_t n, bool (*is_so)(const struct checker *c, int64_t i),
                        int64_t *first);
/* Looks at items 0 .. n - 1: all that is_bad says so of are faults of this kind, which begins here; the
 * first of them is told, with the key `first` + its number. The same report whatever the number of threads. */
void tri_check_each(struct checker *c, enum tri_check_kind kind, int64_t first, int64_t n,
                    bool (*is_bad)(const struct checker *c, int64_t i), void (*tell)(struct checker *c, int64_t i));
/* Asks the sweep whether the point, of any size, finite or not, lies inside the mesh. */
enum tri_status tri_check_ask(struct checker *c, struct tri_point at, enum tri_check_kind kind, int32_t id,
                              double tolerance);

/* n * size bytes, never a null pointer for n = 0. */
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

/* Is it known which segments there are? */
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
/* The last one of triangle t. */
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
/* Are the ends of subsegment s two vertices? */
static inline bool check_is_listed_well(const struct checker *c, int32_t s)
{
    return c->segments[2 * (size_t)s] >= 0;
}
/* Does the mesh lie on one side of it at most? */
static inline bool check_is_border(const struct checker *c, int32_t s)
{
    return c->sides[s][0].half_edge < 0 || c->sides[s][1].half_edge < 0;
}

/* --- names */

static inline bool check_is_used(const struct checker *c, int64_t v)
{
    return (c->state[v] & CHECK_USED) != 0;
}
static inline bool check_same_place(struct tri_point p, struct tri_point q)
{
    return p.x == q.x && p.y == q.y;
}
/* Is p an end of the segment a-b, or exactly on its line? Between that and the tolerance nobody can say whether the
 * segment meets it, or leaves a slit. */
static inline bool check_surely_meets(struct tri_point a, struct tri_point b, struct tri_point p)
{
    return check_same_place(p, a) || check_same_place(p, b) || tri_orient2d(a, b, p) == 0;
}

/* A coordinate as it was given. */
static inline double check_given(const struct checker *c, double x)
{
    return ldexp(x, -c->exponent);
}
/* Number that the report's texts use for vertex or triangle i of the mesh .. */
static inline long check_number(const struct checker *c, int64_t i)
{
    return (long)i + c->options->base;
}
/* .. for vertex or triangle i of the part .. */
static inline long check_part_vertex(const struct checker *c, int32_t v)
{
    return check_number(c, c->part.vertex[v]);
}
static inline long check_part_triangle(const struct checker *c, int32_t t)
{
    return check_number(c, c->part.first + t);
}
/* .. for a vertex of the frame. */
static inline long check_frame_vertex(const struct checker *c, int32_t v)
{
    return check_number(c, c->vertex[v]);
}

/* --- pieces of input segments that the mesh has no edges for */

struct check_pieces {
    int32_t n;
    struct check_piece *at; /* [n] to be freed */
};

/* Brings c->missing into order, from left to right, and drops pieces that are there already. */
void tri_check_sort_missing(struct checker *c);

/* c->missing, in order, cut wherever pieces meet: they share nothing then but end points, up to rounding. None where
 * that would take too long, or too much memory. About n sqrt(n) steps where they are short and apart. */
enum tri_status tri_check_split_missing(const struct checker *c, struct check_pieces *pieces);

/* --- half-edges that wait for their other side
 *
 * As many as the bound allows are in memory, the rest in nameless files, by a hash of their edge. */
enum tri_status tri_check_store_new(struct checker *c);
void tri_check_store_free(struct check_store *store);

/* TRI_NO_MEMORY, TRI_CANNOT_WRITE. */
enum tri_status tri_check_store_add(struct checker *c, struct check_open e);

#endif
