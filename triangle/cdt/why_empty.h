/* What a caller may have meant otherwise: why the mesh has no triangles, and which segments are skipped. */
#ifndef TRIANGLE_CDT_WHY_EMPTY_H
#define TRIANGLE_CDT_WHY_EMPTY_H

#include "triangle/mesh/mesh.h"

enum tri_empty_reason {
    TRI_EMPTY_NOT,
    TRI_EMPTY_LINE,      /* all points lie on one line */
    TRI_EMPTY_BARE,      /* there are no segments, or none that is not skipped */
    TRI_EMPTY_CANCELLED, /* by the even-odd rule the segments are no border: an even number runs along each */
    TRI_EMPTY_OPEN,      /* the outline, the largest connected set of segments, encloses nothing: n of its points have
                            one segment alone, the first of which are v[0] and v[1]. Where n is 2, a segment between
                            the two closes it */
    TRI_EMPTY_LOOSE,     /* nor does any other set, but the largest is straight: likewise of all segments */
    TRI_EMPTY_HOLE,      /* hole n lies in the only face */
    TRI_EMPTY_HOLES      /* a hole lies in each of the n faces */
};

struct tri_empty {
    enum tri_empty_reason reason;
    int32_t n, v[2]; /* points by the caller's numbers, from 0 */
};

/* Holes that emptied a face which was still there: how many did, and the first. */
struct tri_emptied {
    int32_t n, first;
};

/* Why will nothing be left of a constrained triangulation that has triangles? It is still whole. even_odd and keep_hull
 * are those of tri_carve. O(vertices + subsegments). TRI_NO_MEMORY. */
enum tri_status tri_why_empty(struct tri_empty *why, const struct tri_mesh *mesh, bool even_odd, bool keep_hull,
                              const struct tri_emptied *holes, struct tri_error *error);

/* A sentence each, without final stop; "" where there is nothing to tell. */
struct tri_notes {
    char skipped[200]; /* segments that are skipped; not where that is why the mesh is empty */
    char empty[240];   /* why it is */
};

/* The PSLG is the caller's, of whose segments so many are skipped; numbers in the sentences count from base. */
void tri_notes_make(struct tri_notes *notes, const struct tri_empty *why, const struct tri_pslg *pslg,
                    int32_t n_skipped, int32_t base);

#endif
