/* -C: the mesh before the judge. */
#ifndef DRIVERS_SELF_CHECK_H
#define DRIVERS_SELF_CHECK_H

#include "drivers/console.h"
#include "triangle/mesh.h"
#include "triangle/dropin/switches.h"

/* Checks the mesh with triangle/check/check.h and says two lines, or one per kind of fault and how many there are. A
 * copy of coordinates and corners is made: 36 bytes a triangle. TRI_NO_MEMORY, TRI_TOO_LARGE. */
enum tri_status self_check(const struct console *console, const struct tri_switches *switches,
                           const struct tri_mesh *mesh, int32_t base, struct tri_error *error);

#endif
