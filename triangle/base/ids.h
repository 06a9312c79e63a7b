/* Types of ids, so that a declaration shows which ids a function takes. All are int32_t: the compiler treats them as
 * one type, so the names are for the reader. */
#ifndef TRIANGLE_BASE_IDS_H
#define TRIANGLE_BASE_IDS_H

#include <stdint.h>

typedef int32_t tri_vertex_id;   /* index into tri_mesh.xy and the arrays parallel to it; TRI_NONE: none */
typedef int32_t tri_triangle_id; /* index into tri_mesh.tri; TRI_NONE: none */
typedef int32_t tri_halfedge;    /* an edge as one of its triangles sees it: 4 * triangle + 0, 1 or 2; TRI_NONE: none */
typedef int32_t tri_sub_id;      /* index into tri_mesh.sub; TRI_NONE: none */
typedef int32_t tri_link;        /* the neighbour across an edge: a tri_halfedge, or ~ of a tri_sub_id */
typedef int32_t tri_parent_id;   /* index into tri_mesh.parents; TRI_NONE: none */
typedef int32_t tri_region_id;   /* index into tri_mesh.regions; 0: no region */

enum { TRI_MAX_VERTICES = 1 << 28, TRI_MAX_TRIANGLES = 1 << 29 };

#endif
