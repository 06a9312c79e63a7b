/* The one line that is printed below drivers/: old callers of triangulate() know a function that returned nothing. */
#include <stdio.h>

#include "triangle/dropin/call.h"

void tri_io_print(const char *text) { fprintf(stderr, "triangulate: %s\n", text); }
