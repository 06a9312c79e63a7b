/* Reads the input files of Triangle: .node, .poly, .ele, .area.
 *
 * Records are counted in file order and their numbers are ignored, except that the number of the first vertex decides
 * whether all files count from 0 or from 1. Indices in the resulting structs always count from 0. Meaningless input is
 * rejected by TRI_BAD_INPUT with file and line: counts that the rest of the file cannot hold, missing, unreadable or
 * infinite coordinates, missing sections. Harmless deviations are accepted: comments, blank lines, words between
 * numbers, extra fields and records, missing trailing attributes and markers (0).
 *
 * Every function first sets its output to empty, and leaves it empty on failure. All may also return TRI_CANNOT_READ,
 * TRI_NO_MEMORY, TRI_TOO_LARGE. Cost: linear, about 250 MB of text per second on each thread. */
#ifndef TRIANGLE_TEXT_READ_H
#define TRIANGLE_TEXT_READ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "triangle/base/executor.h"
#include "triangle/base/status.h"
#include "triangle/cdt/reconstruct.h"
#include "triangle/mesh/pslg.h"

struct tri_read_options {
    int32_t default_base; /* first vertex number if the file starts with neither 0 nor 1: 1, or 0 with -z */
    bool want_regions;    /* the .poly file must have a section of regions; false: it is ignored */
    bool regions_if_any;  /* read the section of regions if there is one */
    bool refining;        /* a segment with an invalid vertex number is an error; false: a warning */
    bool may_be_empty;    /* accept fewer than three points: the file is a mesh, which may be empty */
    size_t chunk_bytes;   /* bytes of text per task; 0: the default; does not affect the result */
    const struct tri_executor *executor; /* NULL: sequential */
    const struct tri_stop *stop;         /* polled during reading; NULL: never stop */
    /* Called for each skipped item, in order of lines, on the calling thread; text is one sentence. NULL: no
     * warnings. */
    void (*warn)(void *user, const char *file, int64_t line, const char *text);
    void *warn_user; /* passed to warn */
};

/* Reads points, attributes and markers (NULL if the header announces none). *base becomes 0 or 1. */
enum tri_status tri_read_node(const char *path, const struct tri_read_options *options, struct tri_pslg *out,
                              int32_t *base, struct tri_error *error);

/* Reads a PSLG. If the .poly file has 0 vertices they are read from node_path (NULL: an error), and *points_in_poly
 * becomes false. A segment with a missing index is an error. A segment with an invalid vertex number (kept, relative to
 * 0 and limited to int32_t), equal ends, or ends at equal points gives a warning. A single value of a region is both
 * its attribute and its area bound. */
enum tri_status tri_read_poly(const char *poly_path, const char *node_path, const struct tri_read_options *options,
                              struct tri_pslg *out, int32_t *base, bool *points_in_poly, struct tri_error *error);

/* Reads triangles whose corners count from base and are below n_points. A node after the third that is missing or
 * invalid becomes TRI_NONE. If the file is too small for the announced nodes, out->extra stays NULL. */
enum tri_status tri_read_ele(const char *path, const struct tri_read_options *options, int32_t base, int32_t n_points,
                             struct tri_elements *out, struct tri_error *error);

/* Reads area bounds into elements->areas (from malloc). Their number must be that of the triangles. <= 0: no bound;
 * also used for missing values. Errors number triangles from base, as for tri_read_ele. */
enum tri_status tri_read_area(const char *path, const struct tri_read_options *options, int32_t base,
                              struct tri_elements *elements, struct tri_error *error);

#endif
