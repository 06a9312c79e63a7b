/* A text file of any size, a stretch of lines in memory at a time: records in order, as those of triangle/text/text.h.
 * Each stretch is indexed and parsed as a text of its own, by as many threads as the executor has. */
#ifndef TRIANGLE_TEXT_WINDOW_H
#define TRIANGLE_TEXT_WINDOW_H

#include "triangle/base/system.h"
#include "triangle/text/text.h"

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
