/* Selects a writer and reader by the ending of a file name. */
#include "triangle/text/formats.h"

#include <stddef.h>

#include "triangle/base/system.h"
#include "triangle/text/names.h"

static const struct tri_format formats[] = {
    {".vtu", "VTK", true, true, 0, tri_write_vtu, NULL, tri_read_vtu},
    {".msh", "Gmsh", true, true, 1, tri_write_msh, tri_write_msh_parts, tri_read_msh},
    {".2dm", "SMS", true, false, 1, tri_write_2dm, NULL, tri_read_2dm},
    {".14", "ADCIRC", false, false, 1, tri_write_14, NULL, tri_read_14},
    {".grd", "ADCIRC", false, false, 1, tri_write_14, NULL, tri_read_14},
};

const struct tri_format *tri_format_of(const char *name)
{
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
        if (tri_name_ends(name, formats[i].suffix))
            return &formats[i];
    return NULL;
}

/* --- names with other suffixes */

/* Returns the suffix of a name, including its dot; NULL: there is none. */
static const char *suffix_of(const char *name)
{
    const char *last = name + tri_path_folder_length(name), *dot = strrchr(last, '.');
    return dot && dot > last ? dot : NULL;
}

static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

const char *tri_format_missing(const char *name)
{
    static const char *const with_digits[] = {".h5", ".hdf5", ".gr3", ".su2", ".3dm"};
    const char *suffix = suffix_of(name), *at = suffix ? suffix + 1 : NULL;
    if (!suffix || tri_format_of(name))
        return NULL;
    for (size_t i = 0; i < sizeof with_digits / sizeof *with_digits; i++)
        if (tri_name_ends(suffix, with_digits[i]))
            return suffix;
    while (is_letter(*at))
        at++;
    return *at == 0 && at > suffix + 1 ? suffix : NULL;
}

size_t tri_format_base(const char *name)
{
    static const char *const own[] = {".node", ".ele", ".poly"};
    const char *suffix = suffix_of(name);
    for (size_t i = 0; suffix && i < sizeof own / sizeof *own; i++)
        if (strcmp(suffix, own[i]) == 0)
            return (size_t)(suffix - name);
    return strlen(name);
}
