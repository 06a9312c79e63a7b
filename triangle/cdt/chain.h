/* The segments that the subsegments of a refined mesh are pieces of. */
#ifndef TRIANGLE_CDT_CHAIN_H
#define TRIANGLE_CDT_CHAIN_H

#include "triangle/mesh/mesh.h"
#include "triangle/tunables.h"

/* Subsegments that continue each other on one straight line, as far as rounding tells, get one parent; the vertices
 * between them lie on it (mesh->on). Each subsegment has a parent of its own before. Subsegments keep their order; some
 * turn round. O(vertices + subsegments), n log n for n in a row that run round a bend. TRI_NO_MEMORY: nothing has
 * changed. */
enum tri_status tri_unite_chains(struct tri_mesh *mesh, struct tri_error *error);

#endif
