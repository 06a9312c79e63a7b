/* Reading the input files of Triangle: .node, .poly, .ele, .area.
 *
 * Numbers of records in the files are counted, not checked, except that the number of the first vertex decides whether
 * all files count from 0 or from 1. Indices in the structs made here always count from 0. Strict where the format has
 * no meaning: a count that the rest of the file cannot hold, a missing or unreadable or infinite coordinate, a missing
 * section are one TRI_BAD_INPUT with file and line. Lenient where it has one: comments, blank lines, words between
 * numbers, extra fields and records, missing trailing attributes and markers (0).
 *
 * Every function sets its output to empty first, and leaves it empty when it fails. Further errors of all:
 * TRI_CANNOT_READ, TRI_NO_MEMORY, TRI_TOO_LARGE. Cost: linear, about 250 MB of text a second on each thread. */
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
    int32_t default_base; /* number of the first vertex where the file says neither 0 nor 1: 1, or 0 with -z */
    bool want_regions;    /* the .poly file must have its section of regions; else that is not looked at */
    bool regions_if_any;  /* that section is read where it is there */
    bool refining;        /* a segment that names no vertex is an error; else a warning */
    bool may_be_empty;    /* fewer than three points are no error: it is a mesh, of which nothing may be left */
    size_t chunk_bytes;   /* of text for each task; 0: the default. The result does not depend on it */
    const struct tri_executor *executor; /* NULL: one task after another */
    const struct tri_stop *stop;         /* asked whether to go on; NULL: nobody */
    /* Told of what is skipped, in the order of the lines, by the calling thread; text is one sentence. NULL: nobody. */
    void (*warn)(void *user, const char *file, int64_t line, const char *text);
    void *warn_user;
};

/* Reads points, attributes and markers (NULL where the header announces none). *base becomes 0 or 1. */
enum tri_status tri_read_node(const char *path, const struct tri_read_options *options, struct tri_pslg *out,
                              int32_t *base, struct tri_error *error);

/* Reads a PSLG. Where the .poly file has 0 vertices they come from node_path, and *points_in_poly becomes false; a NULL
 * node_path then is an error. A segment with a missing index is an error. One that names no vertex (kept as it is,
 * moved to counting from 0 and limited to int32_t), has equal ends or ends at equal points gives a warning. Of a region
 * with one value that is attribute and bound. */
enum tri_status tri_read_poly(const char *poly_path, const char *node_path, const struct tri_read_options *options,
                              struct tri_pslg *out, int32_t *base, bool *points_in_poly, struct tri_error *error);

/* Reads triangles whose corners count from base and are below n_points. A node behind the third that is missing or no
 * point becomes TRI_NONE; where the file is too small for so many nodes, out->extra stays NULL. */
enum tri_status tri_read_ele(const char *path, const struct tri_read_options *options, int32_t base, int32_t n_points,
                             struct tri_elements *out, struct tri_error *error);

/* Reads area bounds of the triangles, which must be as many as the file has, into elements->areas (malloc'ed); <= 0:
 * none, as where the file has no value. Errors count triangles from base, as tri_read_ele does. */
enum tri_status tri_read_area(const char *path, const struct tri_read_options *options, int32_t base,
                              struct tri_elements *elements, struct tri_error *error);

#endif
