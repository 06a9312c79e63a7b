/* Names of files that belong together. */
#ifndef TRIANGLE_TEXT_NAMES_H
#define TRIANGLE_TEXT_NAMES_H

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#include "triangle/base/status.h"

/* Returns the first `length` bytes of a name, followed by an ending; from malloc, NULL: out of memory. */
char *tri_name(const char *stem, size_t length, const char *ending);

static inline char *tri_joined(const char *first, const char *second) { return tri_name(first, strlen(first), second); }

/* Does the name end in `ending`, which is in lower case? The case of letters in the name is ignored, since files may
 * come from systems that ignore it. (The endings of Triangle's own files must be in lower case.) */
bool tri_name_ends(const char *name, const char *ending);

/* Returns the length of a name without its HDF5 ending .h5 or .vtkhdf; 0: it has neither. */
static inline size_t tri_name_h5(const char *name)
{
    const size_t ending = tri_name_ends(name, ".h5") ? 3 : tri_name_ends(name, ".vtkhdf") ? 7 : strlen(name);
    return strlen(name) - ending;
}

/* The input files of a mesh: stem.node, and so on. */
struct tri_names {
    char *node, *poly, *ele, *area;
};

/* Makes the names. Call tri_names_free in any case. */
enum tri_status tri_names_make(struct tri_names *names, const char *stem, size_t length, struct tri_error *error);
void tri_names_free(struct tri_names *names);

#endif
