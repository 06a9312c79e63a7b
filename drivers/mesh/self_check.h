/* -C: the mesh before the judge. */
#ifndef DRIVERS_MESH_SELF_CHECK_H
#define DRIVERS_MESH_SELF_CHECK_H

#include "drivers/mesh/stages.h"

/* Measured: bytes of memory that it takes at the peak where nobody bounds it, for a triangle and for a subsegment. */
enum { SELF_CHECK_BYTES = 72, SELF_CHECK_SUB_BYTES = 400 };

/* What it takes whatever its bound, in parts that are not too small. */
double self_check_least_bytes(const struct tri_mesh *mesh);

/* Checks the mesh with triangle/check/check.h, which reads it part by part, and says two lines, or one per kind of
 * fault and how many there are. memory: bytes that it may use; where that is less, self_check_least_bytes; 0: no bound.
 * TRI_NO_MEMORY, TRI_TOO_LARGE, TRI_CANNOT_WRITE. */
enum tri_status self_check(const struct run *run, double memory);

#endif
