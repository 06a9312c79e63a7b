/* Which writer a name asks for. */
#include "triangle/text/formats.h"

#include <stddef.h>

#include "triangle/text/names.h"

static const struct tri_format formats[] = {
    {".vtu", "VTK", true, tri_write_vtu, NULL},    {".msh", "Gmsh", true, tri_write_msh, tri_write_msh_parts},
    {".2dm", "SMS", true, tri_write_2dm, NULL},    {".14", "ADCIRC", false, tri_write_14, NULL},
    {".grd", "ADCIRC", false, tri_write_14, NULL},
};

const struct tri_format *tri_format_of(const char *name)
{
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
        if (tri_name_ends(name, formats[i].suffix))
            return &formats[i];
    return NULL;
}
