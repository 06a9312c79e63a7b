/* Names of the files that belong together. */
#ifndef TRIANGLE_TEXT_NAMES_H
#define TRIANGLE_TEXT_NAMES_H

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#include "triangle/base/status.h"

/* The first `length` bytes of a name, and an ending; from malloc, NULL: no memory. */
char *tri_name(const char *stem, size_t length, const char *ending);

static inline char *tri_joined(const char *first, const char *second) { return tri_name(first, strlen(first), second); }

/* Does the name end in this, given in small letters? In the name capitals are as good: systems that tell files apart by
 * their letters get names from such as do not. (The endings of Triangle's own files are in small letters alone.) */
bool tri_name_ends(const char *name, const char *ending);

/* How long a name is without its ending .h5 or .vtkhdf, of HDF5; 0: it has neither. */
static inline size_t tri_name_h5(const char *name)
{
    const size_t ending = tri_name_ends(name, ".h5") ? 3 : tri_name_ends(name, ".vtkhdf") ? 7 : strlen(name);
    return strlen(name) - ending;
}

/* The input files of a mesh: stem.node, and so on. */
struct tri_names {
    char *node, *poly, *ele, *area;
};

/* To be freed in any case. */
enum tri_status tri_names_make(struct tri_names *names, const char *stem, size_t length, struct tri_error *error);
void tri_names_free(struct tri_names *names);

#endif
