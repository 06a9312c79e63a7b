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
    enum tri_status status;        /* TRI_OK until something fails */
};

/* Functions that read return false once they have noted why they have failed. line: 0: none. */
#if defined(__GNUC__)
__attribute__((format(printf, 4, 5)))
#endif
bool tri_reading_fail(struct tri_reading *reading, enum tri_status status, size_t line, const char *format, ...);
bool tri_reading_no_memory(struct tri_reading *reading);

/* Room for n triangles of so many nodes, and for segments. */
bool tri_reading_triangles(struct tri_reading *reading, int64_t n, int n_nodes);
bool tri_reading_segments(struct tri_reading *reading, int64_t n);

struct tri_tags {
    int64_t n;
    int64_t *tag;    /* [n] by place; malloc'ed */
    bool in_a_row;   /* each is one more than that before: no search */
    int64_t *sorted; /* [n][2] else: tag and place, by tag */
};

/* Room for n of them, to be filled, then ordered. To be freed in any case. */
bool tri_tags_begin(struct tri_tags *tags, int64_t n, struct tri_reading *reading);

/* Those of nodes, and room for their places in the mesh. */
bool tri_tags_begin_nodes(struct tri_tags *tags, int64_t n, struct tri_reading *reading);

/* TRI_BAD_INPUT: one, of `what`, occurs twice. O(n), or O(n log n) where they are not in a row. */
bool tri_tags_order(struct tri_tags *tags, const char *what, struct tri_reading *reading);

/* The place of a tag; -1: there is none. O(1) or O(log n). */
int64_t tri_tags_place(const struct tri_tags *tags, int64_t tag);
void tri_tags_free(struct tri_tags *tags);

#endif
