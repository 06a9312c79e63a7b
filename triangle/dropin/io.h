/* From struct triangulateio to a PSLG or a mesh, and from a mesh back (call.h has what lies between).
 *
 * Everything that can fail comes before the first change of the caller's structs: the arrays of the output are all
 * allocated before the first of them is filled. */
#ifndef TRIANGLE_DROPIN_IO_H
#define TRIANGLE_DROPIN_IO_H

#include "triangle/cdt/reconstruct.h"
#include "triangle/dropin/switches.h"
#include "triangle/dropin/triangle.h"
#include "triangle/mesh/mesh.h"
#include "triangle/mesh/pslg.h"

#define REAL TRI_REAL /* as clients of Triangle have it */

enum { TRI_IO_MOST_COPIES = 10 };

/* The input, from 0 and in double precision. Arrays that have this form are the caller's own. */
struct tri_io_input {
    struct tri_pslg pslg;
    struct tri_elements elements; /* with r */
    bool *is_edge; /* with r and p: [n_segments] room for tri_reconstruct_options.is_edge; else NULL */
    void *copies[TRI_IO_MOST_COPIES]; /* what is not the caller's own */
    int n_copies;
};

/* Reads what the switches select. TRI_BAD_INPUT: a negative count of points, of their attributes, of segments or of
 * triangles; a count without an array; with r, a segment that names no point. *input is valid until `in` changes. Free
 * it in any case. O(input). */
enum tri_status tri_io_input_make(struct tri_io_input *input, const struct triangulateio *in,
                                  const struct tri_switches *switches, struct tri_error *error);
void tri_io_input_free(struct tri_io_input *input);

/* Writes what the switches select; no number is free in the mesh. TRI_NO_MEMORY. O(output). */
enum tri_status tri_io_output(const struct tri_mesh *mesh, const struct tri_io_input *input,
                              const struct tri_switches *switches, const struct triangulateio *in,
                              struct triangulateio *out, struct triangulateio *vorout, struct tri_error *error);

#endif
