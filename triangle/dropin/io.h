/* Converts struct triangulateio to a PSLG or a mesh, and a mesh back to it (call.h connects the two).
 *
 * The caller's structs are changed only after the last step that can fail: all arrays of the output are allocated
 * before the first one is filled. */
#ifndef TRIANGLE_DROPIN_IO_H
#define TRIANGLE_DROPIN_IO_H

#include "triangle/cdt/reconstruct.h"
#include "triangle/dropin/switches.h"
#include "triangle/dropin/triangle.h"
#include "triangle/mesh/mesh.h"
#include "triangle/mesh/pslg.h"

#define REAL TRI_REAL /* the name that clients of Triangle use */

enum { TRI_IO_MOST_COPIES = 10 };

/* The input with indices from 0, in double precision. Arrays that already have this form are borrowed from the
 * caller. */
struct tri_io_input {
    struct tri_pslg pslg;         /* points, segments, holes and regions */
    struct tri_elements elements; /* used with switch r */
    bool *is_edge; /* with r and p: [n_segments] buffer for tri_reconstruct_options.is_edge; otherwise NULL */
    void *copies[TRI_IO_MOST_COPIES]; /* arrays that are not borrowed */
    int n_copies;                     /* number of copies */
};

/* Reads what the switches select. Returns TRI_BAD_INPUT for a negative count of points, point attributes, segments
 * or triangles, for a count without an array and, with r, for a segment with an invalid end. *input is valid until
 * `in` changes. Free it in any case. O(input). */
enum tri_status tri_io_input_make(struct tri_io_input *input, const struct triangulateio *in,
                                  const struct tri_switches *switches, struct tri_error *error);
void tri_io_input_free(struct tri_io_input *input);

/* Writes what the switches select. The mesh must have no unused numbers. Returns TRI_OK or TRI_NO_MEMORY. O(output). */
enum tri_status tri_io_output(const struct tri_mesh *mesh, const struct tri_io_input *input,
                              const struct tri_switches *switches, const struct triangulateio *in,
                              struct triangulateio *out, struct triangulateio *vorout, struct tri_error *error);

#endif
