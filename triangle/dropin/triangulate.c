/* triangulate() of libtriangle.a, which uses one thread.
 *
 * libptriangle.a defines the same functions (sched/schedule/par_triangulate.c). This file defines nothing else, so a
 * linker that sees libptriangle.a first does not use it. */
#include "triangle/dropin/triangle.h"

#include <stddef.h>

#include "triangle/dropin/call.h"

/* Clients in other languages, and objects compiled with Triangle's own header, depend on this layout. */
#define AT(field, offset) _Static_assert(offsetof(struct triangulateio, field) == (offset), #field " has moved")
#if defined(__LP64__)
AT(pointlist, 0);
AT(pointattributelist, 8);
AT(pointmarkerlist, 16);
AT(numberofpoints, 24);
AT(numberofpointattributes, 28);
AT(trianglelist, 32);
AT(triangleattributelist, 40);
AT(trianglearealist, 48);
AT(neighborlist, 56);
AT(numberoftriangles, 64);
AT(numberofcorners, 68);
AT(numberoftriangleattributes, 72);
AT(segmentlist, 80);
AT(segmentmarkerlist, 88);
AT(numberofsegments, 96);
AT(holelist, 104);
AT(numberofholes, 112);
AT(regionlist, 120);
AT(numberofregions, 128);
AT(edgelist, 136);
AT(edgemarkerlist, 144);
AT(normlist, 152);
AT(numberofedges, 160);
_Static_assert(sizeof(struct triangulateio) == 168, "the size has changed");
#endif

_Static_assert((int)TRIANGULATE_OK == (int)TRI_OK && (int)TRIANGULATE_NO_MEMORY == (int)TRI_NO_MEMORY &&
                   (int)TRIANGULATE_TOO_LARGE == (int)TRI_TOO_LARGE &&
                   (int)TRIANGULATE_BAD_INPUT == (int)TRI_BAD_INPUT && (int)TRIANGULATE_INTERNAL == (int)TRI_INTERNAL,
               "the codes of the header are those of the library");

int triangulate_with(const char *switches, const struct triangulateio *in, struct triangulateio *out,
                     struct triangulateio *vorout, const struct triangulate_options *options)
{
    return tri_io_triangulate(switches, in, out, vorout, options, false, NULL, NULL);
}

int triangulate(const char *switches, struct triangulateio *in, struct triangulateio *out,
                struct triangulateio *vorout)
{
    return tri_io_triangulate(switches, in, out, vorout, NULL, true, NULL, NULL);
}
