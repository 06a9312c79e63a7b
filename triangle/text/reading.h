/* Common parts of the readers of other programs' meshes: the structs that receive the mesh, and the tags by which a
 * file identifies nodes or elements. */
#ifndef TRIANGLE_TEXT_READING_H
#define TRIANGLE_TEXT_READING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "triangle/base/executor.h"
#include "triangle/mesh/pslg.h"
#include "triangle/text/binary.h"

struct tri_reading {
    const char *path;              /* name of the file, for errors; borrowed */
    const struct tri_executor *executor;
    struct tri_pslg *mesh;         /* empty at first; the caller frees both, even after a failure */
    struct tri_elements *elements;
    struct tri_error *error;       /* receives the error */
    enum tri_status status;        /* TRI_OK until an error occurs */
};

/* Functions that read return false after they have recorded an error. line == 0: no line. */
#if defined(__GNUC__)
__attribute__((format(printf, 4, 5)))
#endif
bool tri_reading_fail(struct tri_reading *reading, enum tri_status status, size_t line, const char *format, ...);
bool tri_reading_no_memory(struct tri_reading *reading);

/* Allocate room for n triangles with n_nodes nodes each, and for n segments. */
bool tri_reading_triangles(struct tri_reading *reading, int64_t n, int n_nodes);
bool tri_reading_segments(struct tri_reading *reading, int64_t n);

struct tri_tags {
    int64_t n;       /* number of tags */
    int64_t *tag;    /* [n] tags in file order; from malloc */
    bool is_consecutive;   /* tags are consecutive, so no search is needed */
    int64_t *sorted; /* [n][2] otherwise: pairs of tag and position, sorted by tag */
};

/* Allocates room for n tags; the caller stores them and calls tri_tags_order. Free in any case. */
bool tri_tags_begin(struct tri_tags *tags, int64_t n, struct tri_reading *reading);

/* The same for tags of nodes; also allocates the points of the mesh. */
bool tri_tags_begin_nodes(struct tri_tags *tags, int64_t n, struct tri_reading *reading);

/* Prepares the search by tag. TRI_BAD_INPUT: a tag of a `what` occurs twice. O(n) if tags are consecutive, otherwise
 * O(n log n). */
bool tri_tags_order(struct tri_tags *tags, const char *what, struct tri_reading *reading);

/* Returns the position of a tag; -1: there is no such tag. O(1) or O(log n). */
int64_t tri_tags_place(const struct tri_tags *tags, int64_t tag);
void tri_tags_free(struct tri_tags *tags);

/* --- a file in memory that is read sequentially, for binary formats
 *
 * The bytes are little-endian numbers, with lines of text between them. Callers must check that bytes are left before
 * they read numbers. */

struct tri_bytes {
    char *data;           /* from malloc */
    const char *at, *end; /* the bytes not read yet */
};

/* Reads a whole file; rejects pipes and devices. Free in any case. TRI_CANNOT_READ, TRI_NO_MEMORY. */
enum tri_status tri_bytes_load(struct tri_bytes *bytes, const char *path, struct tri_error *error);
void tri_bytes_free(struct tri_bytes *bytes);

static inline uint64_t tri_bytes_left(const struct tri_bytes *bytes) { return (uint64_t)(bytes->end - bytes->at); }

/* Are at least n items of that size left? */
static inline bool tri_bytes_has(const struct tri_bytes *bytes, uint64_t n, uint64_t size)
{
    return n <= tri_bytes_left(bytes) / size;
}

/* Reads a line and removes its line break; returns false if there is none. */
bool tri_bytes_line(struct tri_bytes *bytes, const char **line, size_t *length);

/* Moves to the end of the next occurrence of the text; returns false if there is none. */
bool tri_bytes_pass(struct tri_bytes *bytes, const char *text);

/* --- numbers; the caller has checked that they are there */

static inline int32_t tri_bytes_i32(struct tri_bytes *bytes)
{
    bytes->at += 4;
    return tri_get_i32(bytes->at - 4);
}

static inline uint64_t tri_bytes_u64(struct tri_bytes *bytes)
{
    bytes->at += 8;
    return tri_get_u64(bytes->at - 8);
}

#endif
