/* A text file in memory as a sequence of records, and the fields of a record: the lexer of all input formats.
 *
 * A record is a line that has, before any '#', one of the characters 0-9 + - . ; all other lines are blank or comments.
 * A field starts at such a character and ends at a blank, a '#' or the end of the line. Text between fields (commas,
 * words, brackets) is skipped. But the words nan, inf and infinity are recorded, since skipping them would silently
 * shift all later values by one column.
 *
 * The text is divided into chunks of equal size; a line belongs to the chunk of its first byte. Lines and records of
 * each chunk are counted once, at loading. So the number of remaining records is known before memory is allocated for
 * them, a table of n records can be parsed by chunks in any order, and the line number of every record is known.
 * INVARIANT: data[size - 1] is '\n' (added if missing), so scans need not check for the end of the text. */
#ifndef TRIANGLE_TEXT_TEXT_H
#define TRIANGLE_TEXT_TEXT_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "triangle/base/executor.h"
#include "triangle/base/status.h"
#include "triangle/base/system.h"
#include "triangle/text/decimal.h"

struct tri_text_chunk {
    size_t begin;  /* offset of the first line that starts in this chunk or later */
    size_t line;   /* lines before `begin` */
    size_t record; /* records before `begin` */
    bool has_nul;  /* the chunk contains a NUL byte, so the file is not text */
};

struct tri_text {
    const char *name; /* the path, for errors; borrowed */
    char *data;       /* [size] */
    size_t size;      /* bytes, > 0 */
    const struct tri_stop *stop; /* polled while reading; NULL: never stop */
    size_t chunk_bytes;          /* size of a chunk */
    size_t n_chunks;             /* number of chunks */
    struct tri_text_chunk *chunks; /* [n_chunks + 1]; the last one is the end of the text */
    size_t lines_before; /* lines of the file before this text, if it is a window */
};

/* Reads a whole file and indexes it. chunk_bytes: 0 for the default. A pipe is read to its end, up to 1 GB. Free *text
 * in any case; `path` must live as long. TRI_CANNOT_READ, TRI_NO_MEMORY, TRI_STOPPED. O(size). */
enum tri_status tri_text_load(struct tri_text *text, const char *path, size_t chunk_bytes,
                              const struct tri_executor *executor, const struct tri_stop *stop,
                              struct tri_error *error);

void tri_text_free(struct tri_text *text);

/* --- fields of one record */

enum tri_field {
    TRI_FIELD_MISSING, /* the record has no more fields */
    TRI_FIELD_BAD,     /* the field is not a number or, for a real, not finite */
    TRI_FIELD_GOOD
};

struct tri_fields {
    const char *at;   /* start of the next field, or the '#' or '\n' that ends the record */
    const char *end;  /* end of the whole text */
    bool not_finite;  /* nan or inf was skipped just before `at` */
};

enum tri_character { TRI_IS_BLANK, TRI_IS_START, TRI_IS_JUNK, TRI_IS_HASH, TRI_IS_NEWLINE };

extern const uint8_t tri_character_kind[256]; /* enum tri_character of each byte */

static inline enum tri_character tri_kind_at(const char *at)
{
    return (enum tri_character)tri_character_kind[(unsigned char)*at];
}

/* The slow path of tri_fields_seek, for characters that are neither blank nor the start of a field. */
void tri_fields_skip_junk(struct tri_fields *fields);

/* Moves from between two fields to the next field, or to the end of the record. */
static inline void tri_fields_seek(struct tri_fields *fields)
{
    while (tri_kind_at(fields->at) == TRI_IS_BLANK)
        fields->at++;
    if (tri_kind_at(fields->at) == TRI_IS_JUNK)
        tri_fields_skip_junk(fields);
}

/* Opens the line at `line`; returns whether it is a record. */
static inline bool tri_fields_open(struct tri_fields *fields, const char *line, const char *end)
{
    *fields = (struct tri_fields){line, end, false};
    tri_fields_seek(fields);
    return tri_kind_at(fields->at) == TRI_IS_START;
}

/* Moves from inside a field to the next field. */
static inline void tri_fields_skip(struct tri_fields *fields)
{
    while (tri_kind_at(fields->at) == TRI_IS_START || tri_kind_at(fields->at) == TRI_IS_JUNK)
        fields->at++;
    fields->not_finite = false;
    tri_fields_seek(fields);
}

static inline enum tri_field tri_fields_real(struct tri_fields *fields, double *value)
{
    *value = 0;
    if (fields->not_finite)
        return TRI_FIELD_BAD;
    if (tri_kind_at(fields->at) != TRI_IS_START)
        return TRI_FIELD_MISSING;
    const char *const stop = tri_scan_real(fields->at, fields->end, value);
    if (stop == fields->at || !isfinite(*value))
        return TRI_FIELD_BAD;
    fields->at = stop;
    tri_fields_skip(fields);
    return TRI_FIELD_GOOD;
}

static inline enum tri_field tri_fields_integer(struct tri_fields *fields, int64_t *value)
{
    *value = 0;
    if (fields->not_finite)
        return TRI_FIELD_BAD;
    if (tri_kind_at(fields->at) != TRI_IS_START)
        return TRI_FIELD_MISSING;
    const char *const stop = tri_scan_integer(fields->at, fields->end, value);
    if (stop == fields->at)
        return TRI_FIELD_BAD;
    fields->at = stop;
    tri_fields_skip(fields);
    return TRI_FIELD_GOOD;
}

/* Reads a marker; values beyond int32_t wrap, as in Triangle. Returns NULL, or the text of the fault, to follow the
 * name of the record. */
const char *tri_fields_marker(struct tri_fields *fields, int32_t *marker);

/* Skips a number and reads two coordinates. Returns NULL, or the text of the fault. */
const char *tri_fields_point(struct tri_fields *fields, double xy[2]);

/* --- records in order */

struct tri_cursor {
    const struct tri_text *text;
    const char *at; /* start of the first line not read yet */
    size_t line;    /* lines before `at`, which is the number of the last line read */
    size_t record;  /* records before `at` */
};

struct tri_cursor tri_cursor_begin(const struct tri_text *text);

/* Reads the next record and opens it. Returns false if there is none. */
bool tri_cursor_next(struct tri_cursor *cursor, struct tri_fields *fields);

/* Returns the number of records not read yet. O(1). */
size_t tri_cursor_remaining(const struct tri_cursor *cursor);

/* A sequence of n records of the same kind. */
struct tri_table {
    const char *noun; /* kind of the records in errors: "vertex" */
    size_t n;
    int64_t base;     /* number of the first record in errors */
    /* Parses record i. Returns NULL, or a text of static storage that describes the fault and follows "vertex 4 ".
     * Records are parsed in any order, so row may write data of record i only. */
    const char *(*row)(void *user, size_t i, struct tri_fields *fields);
    void *user; /* passed to row */
};

/* Parses the next table->n records, which must exist, and moves past them. If several records are faulty, the first one
 * is reported, regardless of the number of threads. TRI_BAD_INPUT, TRI_NO_MEMORY. */
enum tri_status tri_cursor_table(struct tri_cursor *cursor, const struct tri_table *table,
                                 const struct tri_executor *executor, struct tri_error *error);

/* --- a text of any size, read in order with only a window of lines in memory
 *
 * Each window is indexed and parsed as a separate text, by as many threads as the executor has. */

struct tri_window {
    struct tri_text text;     /* the window: all of `data` up to the last complete line */
    struct tri_cursor cursor; /* the next record in the window */
    tri_file file;            /* TRI_NO_FILE: not open */
    char *data;               /* the buffer */
    size_t room, used;        /* bytes */
    bool at_end;              /* the end of the file has been reached */
    const struct tri_executor *executor;
};

/* Opens the file; path must live as long as the window. bytes: size of the window, > 0 (longer lines enlarge it). Free
 * *window in any case. Errors of all functions here: TRI_CANNOT_READ, TRI_NO_MEMORY, TRI_BAD_INPUT (a NUL byte). */
enum tri_status tri_window_open(struct tri_window *window, const char *path, size_t bytes,
                                const struct tri_executor *executor, struct tri_error *error);
void tri_window_free(struct tri_window *window);

/* Reads the next record and opens it; *found is false if there is none. */
enum tri_status tri_window_next(struct tri_window *window, struct tri_fields *fields, bool *found,
                                struct tri_error *error);

/* Opens the next record without moving past it. */
enum tri_status tri_window_peek(struct tri_window *window, struct tri_fields *fields, bool *found,
                                struct tri_error *error);

/* Parses the next table->n records, window by window. table->row counts from the start of each batch. After a batch of
 * n rows, at most `most`, flush(user, n) is called. If there are fewer records, reports TRI_BAD_INPUT at the line
 * before them, which announces `nouns`. */
enum tri_status tri_window_table(struct tri_window *window, const struct tri_table *table, const char *nouns,
                                 size_t most,
                                 enum tri_status (*flush)(void *user, size_t n, struct tri_error *error),
                                 struct tri_error *error);

#endif
