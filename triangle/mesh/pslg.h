/* A planar straight line graph as the caller gives it: points, segments, holes, regions.
 *
 * Plain arrays, indices from 0. A PSLG may be of any kind: duplicate points, crossing or overlapping segments, points
 * on segments are legal input; the triangulator sorts them out. tri_pslg_check refuses what has no meaning. */
#ifndef TRIANGLE_MESH_PSLG_H
#define TRIANGLE_MESH_PSLG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "triangle/base/status.h"

struct tri_pslg {
    int32_t n_points;
    double *points;         /* [n_points][2]: x, y; finite */
    int32_t n_attributes;   /* per point, >= 0 */
    double *attributes;     /* [n_points][n_attributes], or NULL where n_attributes is 0 */
    int32_t *markers;       /* [n_points], or NULL: all 0 */
    int32_t n_segments;
    int32_t *segments;      /* [n_segments][2]: point indices; a segment with an index outside the points or two equal
                               ends is skipped */
    int32_t *segment_markers; /* [n_segments], or NULL: all 0 */
    int32_t n_holes;
    double *holes;          /* [n_holes][2] */
    int32_t n_regions;
    double *regions;        /* [n_regions][4]: x, y, attribute, area bound (<= 0: none) */
};

/* Fewer than three points, a negative count, a count without an array, a coordinate that is not finite:
 * TRI_BAD_INPUT; more than 2^28 of anything: TRI_TOO_LARGE. O(n). */
enum tri_status tri_pslg_check(const struct tri_pslg *pslg, struct tri_error *error);

/* The same, but any number of points will do: of a mesh nothing may be left. */
enum tri_status tri_pslg_check_values(const struct tri_pslg *pslg, struct tri_error *error);

/* Are there enough points, but all at one place? Triangle refuses those; tri_generate makes a mesh of no triangles, as
 * of collinear points. O(n). */
bool tri_pslg_is_one_place(const struct tri_pslg *pslg);

/* Frees the arrays (malloc'ed) and zeroes the struct. */
void tri_pslg_free(struct tri_pslg *pslg);

/* Triangles as a caller or an .ele file gives them. Anything may stand in them: what is no mesh is refused. */
struct tri_elements {
    int32_t n;
    int32_t *corners;     /* [n][3]: point indices; orientation and shape are not checked on reading */
    int32_t n_nodes;      /* nodes of a triangle in the file, >= 3 */
    int32_t n_attributes; /* per triangle, >= 0 */
    double *attributes;   /* [n][n_attributes], or NULL */
    double *areas;        /* [n] bounds of single triangles (<= 0: none), or NULL */
    int32_t *extra;       /* [n][n_nodes - 3]: the nodes behind the third, or TRI_NONE; NULL: not known */
};

/* Frees the arrays and zeroes the struct. */
void tri_elements_free(struct tri_elements *elements);

#endif
