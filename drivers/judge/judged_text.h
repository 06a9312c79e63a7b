/* The text files of a mesh on trial, of any size: turned into rows of numbers, stretch by stretch. */
#ifndef DRIVERS_JUDGE_JUDGED_TEXT_H
#define DRIVERS_JUDGE_JUDGED_TEXT_H

#include <stdbool.h>

#include "triangle/base/system.h"
#include "triangle/check/check.h"

/* Rows of numbers in memory, or in a nameless file: written once from the first to the last, then read in slices. */
struct scratch {
    tri_file file; /* TRI_NO_FILE: in memory */
    size_t width;  /* bytes of a row; 0: not open */
    int64_t n;     /* rows */
    char *bytes;   /* [room] in memory */
    int64_t room;
};

struct judged_names { /* of files; NULL: there is none */
    const char *node, *ele, *poly, *neigh;
};

struct judged_text {
    struct scratch array[TRI_CHECK_N_ARRAYS]; /* by enum tri_check_array */
    unsigned given;            /* 1 << array, of those that there are */
    int32_t base;
    int32_t n_attributes;      /* of a point */
    int64_t n_points, n_nodes; /* points that may be corners, all points; elsewhere the nodes amid edges */
    int64_t least_middle;      /* number of the first node amid an edge; INT64_MAX: there are none */
    bool stale_neighbors;      /* the .neigh file is of another mesh, and was not read */
};

/* A few MB of memory; and, in scratch files in that folder (NULL: in memory), 20 bytes a point and 24 a triangle, 8
 * more for each attribute, and 24 each where a triangle has six nodes, and neighbours. Errors: as triangle/text/read.h,
 * TRI_CANNOT_WRITE. */
enum tri_status judged_text_read(struct judged_text *text, const struct judged_names *names, const char *folder,
                                 const struct tri_executor *executor, struct tri_error *error);
void judged_text_close(struct judged_text *text);

struct tri_check_source judged_text_source(struct judged_text *text);

#endif
