/* What readers of other programs' meshes share: where the mesh goes, and numbers by which a file knows its nodes or
 * elements, and their places in it. */
#ifndef TRIANGLE_TEXT_READING_H
#define TRIANGLE_TEXT_READING_H

#include <stdbool.h>
#include <stdint.h>

#include "triangle/base/executor.h"
#include "triangle/mesh/pslg.h"

struct tri_reading {
    const char *path;
    const struct tri_executor *executor;
    struct tri_pslg *mesh;         /* empty to begin with; whoever calls frees them, also after a failure */
    struct tri_elements *elements;
    struct tri_error *error;
};

/* TRI_BAD_INPUT and TRI_NO_MEMORY. line: 0: none. */
enum tri_status tri_reading_fail(const struct tri_reading *reading, size_t line, const char *text);
enum tri_status tri_reading_no_memory(const struct tri_reading *reading);

/* Room for n triangles of so many nodes, and for segments; false: no memory. */
bool tri_reading_triangles(const struct tri_reading *reading, int64_t n, int n_nodes);
bool tri_reading_segments(const struct tri_reading *reading, int64_t n);

struct tri_tags {
    int64_t n;
    int64_t *tag;    /* [n] by place; malloc'ed */
    bool in_a_row;   /* each is one more than that before: no search */
    int64_t *sorted; /* [n][2] else: tag and place, by tag */
};

/* Room for n of them, to be filled, then ordered. False: no memory. To be freed in any case. */
bool tri_tags_begin(struct tri_tags *tags, int64_t n);

/* TRI_BAD_INPUT: one, of `what`, occurs twice; TRI_NO_MEMORY. O(n), or O(n log n) where they are not in a row. */
enum tri_status tri_tags_order(struct tri_tags *tags, const char *what, const struct tri_reading *reading);

/* The place of a tag; -1: there is none. O(1) or O(log n). */
int64_t tri_tags_place(const struct tri_tags *tags, int64_t tag);
void tri_tags_free(struct tri_tags *tags);

#endif
