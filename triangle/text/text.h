/* A text file in memory as a sequence of records, and the fields of a record: the lexer of all input formats.
 *
 * A record is a line that holds, before any '#', one of the characters 0-9 + - . ; all other lines are blank or
 * comment. A field begins at such a character and ends at a blank, a '#' or the end of the line. What stands between
 * fields and cannot begin one (commas, words, brackets) is skipped; but the words nan, inf and infinity are remembered,
 * since skipping them would shift all later values by one column without a word.
 *
 * The text is cut into chunks of equal size; a line belongs to the chunk that its first byte lies in. Records and lines
 * of each chunk are counted once, when the file is loaded. So the number of records that remain is known before
 * anything is allocated for them, a table of n records is parsed chunk by chunk in any order, and every record knows
 * its line.
 * INVARIANT: data[size - 1] is '\n' (added where missing), so no scan needs to look for the end of the text. */
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
    size_t begin;  /* offset of the first line that begins here or later */
    size_t line;   /* lines before `begin` */
    size_t record; /* records before `begin` */
    bool has_nul;  /* there is a NUL among the chunk's bytes: no text */
};

struct tri_text {
    const char *name; /* the path, for errors; borrowed */
    char *data;       /* [size] */
    size_t size;      /* bytes, > 0 */
    const struct tri_stop *stop; /* asked whether to go on */
    size_t chunk_bytes;
    size_t n_chunks;
    struct tri_text_chunk *chunks; /* [n_chunks + 1]; the last is the end of the text */
    size_t lines_before; /* of a text that is a stretch of a file */
};

/* Reads the file whole and indexes it. chunk_bytes > 0, or 0 for the default. A pipe is read to its end, up to 1 GB.
 * *text is to be freed in any case; `path` must live as long. Errors: TRI_CANNOT_READ, TRI_NO_MEMORY,
 * TRI_STOPPED. O(size). */
enum tri_status tri_text_load(struct tri_text *text, const char *path, size_t chunk_bytes,
                              const struct tri_executor *executor, const struct tri_stop *stop,
                              struct tri_error *error);

void tri_text_free(struct tri_text *text);

/* --- fields of one record */

enum tri_field {
    TRI_FIELD_MISSING, /* the record has no further field */
    TRI_FIELD_BAD,     /* a field that is no number; for a real also: not finite */
    TRI_FIELD_GOOD
};

struct tri_fields {
    const char *at;   /* begin of the next field, or the '#' or '\n' that ends the record */
    const char *end;  /* end of the whole text */
    bool not_finite;  /* nan or inf was skipped right before `at` */
};

enum tri_character { TRI_IS_BLANK, TRI_IS_START, TRI_IS_JUNK, TRI_IS_HASH, TRI_IS_NEWLINE };

extern const uint8_t tri_character_kind[256]; /* enum tri_character of each byte */

static inline enum tri_character tri_kind_at(const char *at)
{
    return (enum tri_character)tri_character_kind[(unsigned char)*at];
}

/* The slow half of tri_fields_seek: at something that is neither blank nor the begin of a field. */
void tri_fields_skip_junk(struct tri_fields *fields);

/* From anywhere between fields to the next one, or to the end of the record. */
static inline void tri_fields_seek(struct tri_fields *fields)
{
    while (tri_kind_at(fields->at) == TRI_IS_BLANK)
        fields->at++;
    if (tri_kind_at(fields->at) == TRI_IS_JUNK)
        tri_fields_skip_junk(fields);
}

/* Opens the line that begins at `line`; returns whether it is a record. */
static inline bool tri_fields_open(struct tri_fields *fields, const char *line, const char *end)
{
    *fields = (struct tri_fields){line, end, false};
    tri_fields_seek(fields);
    return tri_kind_at(fields->at) == TRI_IS_START;
}

/* From inside a field to the next one. */
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

/* A marker; beyond int32_t it wraps, as in Triangle. NULL, or what is wrong with the field: words to follow the line's
 * name. */
const char *tri_fields_marker(struct tri_fields *fields, int32_t *marker);

/* A number, which is left out, and two coordinates. The same. */
const char *tri_fields_point(struct tri_fields *fields, double xy[2]);

/* --- records in order */

struct tri_cursor {
    const struct tri_text *text;
    const char *at; /* begin of the first line not yet read */
    size_t line;    /* lines before `at`: the number of the line read last */
    size_t record;  /* records before `at` */
};

struct tri_cursor tri_cursor_begin(const struct tri_text *text);

/* Moves past the next record and opens it; false: the text has no more. */
bool tri_cursor_next(struct tri_cursor *cursor, struct tri_fields *fields);

/* Records not yet read. O(1). */
size_t tri_cursor_remaining(const struct tri_cursor *cursor);

/* A run of n records of the same kind. */
struct tri_table {
    const char *noun; /* what a record describes, for errors: "vertex" */
    size_t n;
    int64_t base;     /* number of the first, for errors */
    /* Parses record i. Returns NULL, or what is wrong with it, to stand behind "vertex 4 ": a text that outlives the
     * call. Records are parsed in no particular order, so row may write only what belongs to record i. */
    const char *(*row)(void *user, size_t i, struct tri_fields *fields);
    void *user;
};

/* Parses the next table->n records, which must remain, and moves past them. Of several faulty records the first is
 * reported, however many threads ran. Errors: TRI_BAD_INPUT, TRI_NO_MEMORY. */
enum tri_status tri_cursor_table(struct tri_cursor *cursor, const struct tri_table *table,
                                 const struct tri_executor *executor, struct tri_error *error);

/* --- a text of any size, a stretch of lines in memory at a time: records in order
 *
 * Each stretch is indexed and parsed as a text of its own, by as many threads as the executor has. */

struct tri_window {
    struct tri_text text;     /* the stretch; its data are all of `data` up to the last whole line */
    struct tri_cursor cursor;
    tri_file file;            /* TRI_NO_FILE: not open */
    char *data;
    size_t room, used;        /* bytes */
    bool at_end;              /* nothing is left to be read */
    const struct tri_executor *executor;
};

/* Opens the file; path must live as long. bytes: of a stretch, > 0 (longer lines get more). *window is to be freed in
 * any case. TRI_CANNOT_READ, TRI_NO_MEMORY, TRI_BAD_INPUT (a NUL), as of all functions here. */
enum tri_status tri_window_open(struct tri_window *window, const char *path, size_t bytes,
                                const struct tri_executor *executor, struct tri_error *error);
void tri_window_free(struct tri_window *window);

/* Opens the next record, and moves past it; *found false: there is none. */
enum tri_status tri_window_next(struct tri_window *window, struct tri_fields *fields, bool *found,
                                struct tri_error *error);

/* Looks at the next record without moving. */
enum tri_status tri_window_peek(struct tri_window *window, struct tri_fields *fields, bool *found,
                                struct tri_error *error);

/* Parses the next table->n records, stretch by stretch: table->row counts from the begin of each, and behind each
 * flush(user, n) takes its n rows, at most `most`. Fewer records: TRI_BAD_INPUT, told of the line before them, where
 * nouns are announced. */
enum tri_status tri_window_table(struct tri_window *window, const struct tri_table *table, const char *nouns,
                                 size_t most,
                                 enum tri_status (*flush)(void *user, size_t n, struct tri_error *error),
                                 struct tri_error *error);

#endif
