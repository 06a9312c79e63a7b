/* A planar straight line graph as given by the caller: points, segments, holes, regions.
 *
 * Plain arrays with indices from 0. Duplicate points, crossing or overlapping segments, and points on segments are
 * legal input; the triangulator resolves them. tri_pslg_check rejects meaningless input. */
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
    double *attributes;     /* [n_points][n_attributes], or NULL if n_attributes is 0 */
    int32_t *markers;       /* [n_points], or NULL if all are 0 */
    int32_t n_segments;
    int32_t *segments;      /* [n_segments][2]: point indices; a segment with an index out of range or two equal ends is
                               skipped */
    int32_t *segment_markers; /* [n_segments], or NULL if all are 0 */
    int32_t n_holes;
    double *holes;          /* [n_holes][2] */
    int32_t n_regions;
    double *regions;        /* [n_regions][4]: x, y, attribute, area bound (<= 0: none) */
};

/* Returns TRI_BAD_INPUT for fewer than three points, a negative count, a count without an array, or a coordinate that
 * is not finite, and TRI_TOO_LARGE for more than 2^28 items of a kind. O(n). */
enum tri_status tri_pslg_check(const struct tri_pslg *pslg, struct tri_error *error);

/* The same, but any number of points is accepted: a mesh to be read may be empty. */
enum tri_status tri_pslg_check_values(const struct tri_pslg *pslg, struct tri_error *error);

/* Are there at least three points, all at the same place? Triangle rejects such input; tri_generate makes a mesh
 * without triangles, as for collinear points. O(n). */
bool tri_pslg_is_one_place(const struct tri_pslg *pslg);

/* Frees the arrays (malloc'ed) and zeroes the struct. */
void tri_pslg_free(struct tri_pslg *pslg);

/* Triangles as given by a caller or an .ele file. They may be arbitrary; reconstruction rejects those that are not a
 * mesh. */
struct tri_elements {
    int32_t n;
    int32_t *corners;     /* [n][3]: point indices; orientation and shape are not checked on reading */
    int32_t n_nodes;      /* nodes of each triangle in the file, >= 3 */
    int32_t n_attributes; /* per triangle, >= 0 */
    double *attributes;   /* [n][n_attributes], or NULL */
    double *areas;        /* [n] area bounds of single triangles (<= 0: none), or NULL */
    int32_t *extra;       /* [n][n_nodes - 3]: the nodes after the third, or TRI_NONE; NULL: not known */
};

/* Frees the arrays and zeroes the struct. */
void tri_elements_free(struct tri_elements *elements);

#endif
