#include "triangle/text/names.h"

#include <stdlib.h>

char *tri_name(const char *stem, size_t length, const char *ending)
{
    const size_t n = strlen(ending) + 1;
    char *name = malloc(length + n);
    if (!name)
        return NULL;
    memcpy(name, stem, length);
    memcpy(name + length, ending, n);
    return name;
}

/* Lower case, independent of the locale. */
static char to_lower(char c) { return (char)(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c); }

bool tri_name_ends(const char *name, const char *ending)
{
    const size_t n = strlen(name), m = strlen(ending);
    bool ends = n >= m;
    for (size_t i = 0; ends && i < m; i++)
        ends = to_lower(name[n - m + i]) == ending[i];
    return ends;
}

enum tri_status tri_names_make(struct tri_names *names, const char *stem, size_t length, struct tri_error *error)
{
    *names = (struct tri_names){tri_name(stem, length, ".node"), tri_name(stem, length, ".poly"),
                                tri_name(stem, length, ".ele"), tri_name(stem, length, ".area")};
    if (names->node && names->poly && names->ele && names->area)
        return TRI_OK;
    return tri_fail(error, TRI_NO_MEMORY, stem, 0, "out of memory for file names");
}

void tri_names_free(struct tri_names *names)
{
    free(names->node);
    free(names->poly);
    free(names->ele);
    free(names->area);
    *names = (struct tri_names){0};
}
