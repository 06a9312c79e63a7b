/* Items grouped by a value, for formats that store each group in one block; and a mesh divided into parts, for formats
 * that have one file for each part. */
#ifndef TRIANGLE_TEXT_PARTS_H
#define TRIANGLE_TEXT_PARTS_H

#include "triangle/text/formats.h"
#include "triangle/mesh/grid.h"

enum { TRI_MOST_GROUPS = 1024 };

struct tri_grouping {
    int n;                                /* number of groups, sorted by value */
    double value[TRI_MOST_GROUPS];        /* value of each group, ascending */
    int64_t first[TRI_MOST_GROUPS + 1];   /* start of each group in `order` */
    int64_t *order;                       /* the items by group; NULL: one group, in their order */
    const struct tri_storage *storage;    /* storage of the grid, from which `order` is allocated; NULL: malloc */
};

/* Groups n items. If there are more than TRI_MOST_GROUPS values, or a NaN, makes one group of value 0. TRI_NO_MEMORY.
 * Free in any case. O(n log groups). */
enum tri_status tri_group(struct tri_grouping *grouping, int64_t n,
                          double (*value)(const struct tri_grid *grid, int64_t i), const struct tri_grid *grid,
                          struct tri_error *error);
void tri_grouping_free(struct tri_grouping *grouping);

/* Returns the value as a group number for other programs, 1 .. 2^31 - 1; 0 if it is not such a number. */
int32_t tri_group_tag(double value);

/* The value by which triangle or segment i is grouped: the first attribute, or the marker; 0 if there is none. */
double tri_triangle_group(const struct tri_grid *grid, int64_t i);
double tri_segment_group(const struct tri_grid *grid, int64_t i);

static inline int64_t tri_grouped(const struct tri_grouping *grouping, int64_t place)
{
    return grouping->order ? grouping->order[place] : place;
}

/* --- parts
 *
 * The mesh is divided recursively, across its longer side, into two halves with triangle counts proportional to their
 * numbers of parts (recursive coordinate bisection: Berger & Bokhari, "A partitioning strategy for nonuniform problems
 * on multiprocessors", 1987). The result depends on the mesh and the number of parts only.
 *
 * A segment belongs to the first part with a triangle at it; one that is not an edge, to a part of its ends. A point
 * used by one part only is inner to it; points without triangles are inner to the first part. Other points are shared;
 * points shared by the same parts form an interface. */

struct tri_shared_point {
    int64_t point;          /* number of the point */
    int32_t n;              /* number of parts that share it */
    const int32_t *part;    /* [n] ascending part numbers; equal lists may be at different addresses */
};

struct tri_parts {
    int n;
    int64_t *triangle;      /* positions in the grouping of triangles, by part, ascending within each */
    int64_t first_triangle[TRI_MOST_PARTS + 1]; /* start of each part in `triangle` */
    int64_t *segment;       /* the same for segments */
    int64_t first_segment[TRI_MOST_PARTS + 1];  /* start of each part in `segment` */
    int64_t *inner;         /* points by part, ascending within each */
    int64_t first_inner[TRI_MOST_PARTS + 1];    /* start of each part in `inner` */
    int64_t n_shared;
    struct tri_shared_point *shared; /* sorted by their parts, then by point */
    int64_t n_interfaces;
    int64_t *first_shared;  /* [n_interfaces + 1] start of each interface in `shared` */

    int32_t *part_list;     /* storage of the lists in `shared` */
    const struct tri_storage *storage; /* from which the lists are allocated; NULL: malloc */
};

/* Divides the mesh into parts 0 .. n - 1, for n from 1 to TRI_MOST_PARTS; some are empty if there are fewer triangles.
 * For more than 262,144 triangles the cuts are determined from samples, so parts differ in size by a few per cent.
 * surfaces, curves: triangles and segments grouped. Memory beside the grid's storage: 6 MB and about 64 bytes per
 * shared point. Free in any case. TRI_NO_MEMORY. O((triangles + samples) log n + points + segments + shared log
 * shared). */
enum tri_status tri_parts_make(struct tri_parts *parts, int n, const struct tri_grid *grid,
                               const struct tri_grouping *surfaces, const struct tri_grouping *curves,
                               struct tri_error *error);
void tri_parts_free(struct tri_parts *parts);

/* Does the part share the points of the interface? */
bool tri_part_has_interface(const struct tri_parts *parts, int part, int64_t interface);

#endif
