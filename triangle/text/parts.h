/* Items grouped by a value, for formats that list what belongs together in one block; and a mesh cut into parts, for
 * formats that keep one file for each. */
#ifndef TRIANGLE_TEXT_PARTS_H
#define TRIANGLE_TEXT_PARTS_H

#include "triangle/text/formats.h"
#include "triangle/mesh/grid.h"

enum { TRI_MOST_GROUPS = 1024 };

struct tri_grouping {
    int n;                                /* groups, by ascending value */
    double value[TRI_MOST_GROUPS];
    int64_t first[TRI_MOST_GROUPS + 1];   /* where each begins in `order` */
    int64_t *order;                       /* the items; NULL: as they are, in one group */
    const struct tri_storage *storage;    /* of the grid: `order` is an extra of it; NULL: it is malloc'ed */
};

/* Groups n items; more than TRI_MOST_GROUPS values, or none that is a number, make one group of value 0. TRI_NO_MEMORY.
 * To be freed in any case. O(n log groups). */
enum tri_status tri_group(struct tri_grouping *grouping, int64_t n,
                          double (*value)(const struct tri_grid *grid, int64_t i), const struct tri_grid *grid,
                          struct tri_error *error);
void tri_grouping_free(struct tri_grouping *grouping);

/* The value as a number by which other programs know a group: 1 .. 2^31 - 1; 0 where it is no such number. */
int32_t tri_group_tag(double value);

/* Of triangle and segment i: the first attribute, and the marker; 0 where there is none. */
double tri_triangle_group(const struct tri_grid *grid, int64_t i);
double tri_segment_group(const struct tri_grid *grid, int64_t i);

static inline int64_t tri_grouped(const struct tri_grouping *grouping, int64_t place)
{
    return grouping->order ? grouping->order[place] : place;
}

/* --- parts
 *
 * The mesh is cut across its longer side into two of about as many
 * triangles for each part to come, and so on (recursive coordinate bisection: Berger & Bokhari, "A partitioning
 * strategy for nonuniform problems on multiprocessors", 1987). They depend on the mesh and the number of parts alone.
 *
 * A segment belongs to the first part that has a triangle with it; one that is no edge, to that of its ends. A point
 * that only one part uses is inner to it, one of no triangle to the first part; the others are shared, and points that
 * the same parts share make an interface. */

struct tri_shared_point {
    int64_t point;
    int32_t n;              /* parts that share it, */
    const int32_t *part;    /* [n] ascending; equal ones do not mean equal pointers */
};

struct tri_parts {
    int n;
    int64_t *triangle;      /* places in the grouping of triangles, by part, each part's ascending: */
    int64_t first_triangle[TRI_MOST_PARTS + 1];
    int64_t *segment;       /* the same of segments */
    int64_t first_segment[TRI_MOST_PARTS + 1];
    int64_t *inner;         /* points by part, each part's ascending: */
    int64_t first_inner[TRI_MOST_PARTS + 1];
    int64_t n_shared;
    struct tri_shared_point *shared; /* by their parts, then by point */
    int64_t n_interfaces;
    int64_t *first_shared;  /* [n_interfaces + 1] */

    int32_t *part_list;     /* what `shared` points to */
    const struct tri_storage *storage;
};

/* Parts 0 .. n - 1, n from 1 to TRI_MOST_PARTS, some without triangles where there are fewer of these; of more than
 * 262,144 triangles samples tell where to cut, so that parts differ by some per cent. surfaces, curves: triangles and
 * segments grouped. Memory beside the grid's storage: 6 MB and about 64 bytes a shared point. To be freed in any case.
 * TRI_NO_MEMORY. O((triangles + samples) log n + points + segments + shared log shared). */
enum tri_status tri_parts_make(struct tri_parts *parts, int n, const struct tri_grid *grid,
                               const struct tri_grouping *surfaces, const struct tri_grouping *curves,
                               struct tri_error *error);
void tri_parts_free(struct tri_parts *parts);

/* Is the part among those of the interface? */
bool tri_part_has_interface(const struct tri_parts *parts, int part, int64_t interface);

#endif
