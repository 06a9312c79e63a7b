/* What readers of other programs' meshes share: where the mesh goes, and numbers by which a file knows its nodes or
 * elements, and their places in it. */
#ifndef TRIANGLE_TEXT_READING_H
#define TRIANGLE_TEXT_READING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "triangle/base/executor.h"
#include "triangle/mesh/pslg.h"
#include "triangle/text/binary.h"

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

/* --- a file in memory as bytes that are taken one after the other, for formats that are binary
 *
 * Little-endian numbers, and lines between them. What is not there is not taken: everyone who takes asks before. */

struct tri_bytes {
    char *data;           /* malloc'ed */
    const char *at, *end; /* what has not been taken */
};

/* Reads a file whole; a pipe or device is refused. To be freed in any case. TRI_CANNOT_READ, TRI_NO_MEMORY. */
enum tri_status tri_bytes_load(struct tri_bytes *bytes, const char *path, struct tri_error *error);
void tri_bytes_free(struct tri_bytes *bytes);

static inline uint64_t tri_bytes_left(const struct tri_bytes *bytes) { return (uint64_t)(bytes->end - bytes->at); }

/* Are there n items of that size? */
static inline bool tri_bytes_has(const struct tri_bytes *bytes, uint64_t n, uint64_t size)
{
    return n <= tri_bytes_left(bytes) / size;
}

/* The line that begins here, without its end, and moves behind it; false: there is none. */
bool tri_bytes_line(struct tri_bytes *bytes, const char **line, size_t *length);

/* Moves behind the text, wherever it is next; false: it does not come. */
bool tri_bytes_pass(struct tri_bytes *bytes, const char *text);

/* --- numbers that are taken: they are there */

static inline int32_t tri_take_i32(struct tri_bytes *bytes)
{
    bytes->at += 4;
    return tri_get_i32(bytes->at - 4);
}

static inline uint64_t tri_take_u64(struct tri_bytes *bytes)
{
    bytes->at += 8;
    return tri_get_u64(bytes->at - 8);
}

#endif
