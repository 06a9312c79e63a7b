/* Notes on probable mistakes in the input: why the mesh has no triangles, and which segments were skipped. */
#ifndef TRIANGLE_CDT_WHY_EMPTY_H
#define TRIANGLE_CDT_WHY_EMPTY_H

#include "triangle/mesh/mesh.h"

enum tri_empty_reason {
    TRI_EMPTY_NOT,
    TRI_EMPTY_LINE,      /* all points lie on one line */
    TRI_EMPTY_BARE,      /* there are no segments, or all were skipped */
    TRI_EMPTY_CANCELLED, /* an even number of segments runs along each edge, so by the even-odd rule none is a border */
    TRI_EMPTY_OPEN,      /* the outline, the largest connected set of segments, encloses nothing: n of its points have a
                            single segment; v[] are the first two. If n is 2, a segment between them closes the
                            outline */
    TRI_EMPTY_LOOSE,     /* no set of segments encloses anything, and the largest one is straight; n, v: as above, in
                            all */
    TRI_EMPTY_HOLE,      /* hole n lies in the only face */
    TRI_EMPTY_HOLES      /* a hole lies in each of the n faces */
};

struct tri_empty {
    enum tri_empty_reason reason; /* TRI_EMPTY_NOT: the mesh has triangles */
    int32_t n, v[2]; /* numbers of input points, from 0 */
};

/* Holes that have emptied a face: their number, and the first of them. */
struct tri_emptied {
    int32_t n, first;
};

/* Finds out why carving removes all triangles. The mesh must still be whole. even_odd and keep_hull: as for tri_carve.
 * O(vertices + subsegments). TRI_NO_MEMORY. */
enum tri_status tri_why_empty(struct tri_empty *why, const struct tri_mesh *mesh, bool even_odd, bool keep_hull,
                              const struct tri_emptied *holes, struct tri_error *error);

/* Notes for the user: one sentence each, without a final stop; "" if there is nothing to report. */
struct tri_notes {
    char skipped[200]; /* skipped segments; "" if `empty` mentions them */
    char empty[240];   /* why the mesh is empty */
};

/* Writes the notes. n_skipped: number of skipped segments of the PSLG. Numbers in the sentences count from base. */
void tri_notes_make(struct tri_notes *notes, const struct tri_empty *why, const struct tri_pslg *pslg,
                    int32_t n_skipped, int32_t base);

#endif
