/* Reads the text files of a mesh of any size into rows of numbers, in stretches. */
#ifndef DRIVERS_JUDGE_JUDGED_TEXT_H
#define DRIVERS_JUDGE_JUDGED_TEXT_H

#include <stdbool.h>

#include "triangle/base/system.h"
#include "triangle/check/check.h"

/* Rows of numbers in memory, or in a file without a name. They are written once from first to last, then read in
 * slices. */
struct scratch {
    tri_file file; /* TRI_NO_FILE: the rows are in memory */
    size_t width;  /* bytes of a row; 0: not open */
    int64_t n;     /* number of rows */
    char *bytes;   /* [room] the rows in memory; otherwise NULL */
    int64_t room;
};

struct judged_names { /* names of files; NULL: there is no such file */
    const char *node, *ele, *poly, *neigh;
};

struct judged_text {
    struct scratch array[TRI_CHECK_N_ARRAYS]; /* by enum tri_check_array */
    unsigned given;            /* bit 1 << array for each array that exists */
    int32_t base;
    int32_t n_attributes;      /* number of attributes of a point */
    int64_t n_points, n_nodes; /* points that may be corners; all points, with midpoints of edges */
    int64_t least_middle;      /* number of the first midpoint of an edge; INT64_MAX: there are none */
    bool stale_neighbors;      /* the .neigh file belongs to another mesh, and was not read */
};

/* Needs a few MB of memory, and scratch files in that folder (NULL: in memory): 20 bytes a point and 24 a triangle,
 * plus 8 for each attribute, 24 for six-node triangles, and 24 for neighbours. Errors: as for triangle/text/read.h, and
 * TRI_CANNOT_WRITE. */
enum tri_status judged_text_read(struct judged_text *text, const struct judged_names *names, const char *folder,
                                 const struct tri_executor *executor, struct tri_error *error);
void judged_text_close(struct judged_text *text);

struct tri_check_source judged_text_source(struct judged_text *text);

#endif
