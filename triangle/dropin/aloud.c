/* The only printing function outside drivers/. Programs written for Triangle's triangulate(), which returns nothing,
 * do not check a status. */
#include <stdio.h>

#include "triangle/dropin/call.h"

void tri_io_print(const char *text) { fprintf(stderr, "triangulate: %s\n", text); }
