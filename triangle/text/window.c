/* The stretch moves on when its last record has been read: what is left behind its last whole line comes to the front,
 * and the room is filled up from the file. */
#include "triangle/text/window.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/grow.h"

/* Fills the room. */
static enum tri_status fill(struct tri_window *w, struct tri_error *error)
{
    while (!w->at_end && w->used + 1 < w->room) { /* a byte is kept for a final newline */
        const int64_t got = tri_read_next(w->file, w->data + w->used, w->room - 1 - w->used);
        if (got < 0 && errno != EINTR)
            return tri_fail_system(error, TRI_CANNOT_READ, w->text.name, "cannot read", errno);
        w->at_end = got == 0;
        w->used += got > 0 ? (size_t)got : 0;
    }
    if (w->at_end && w->used > 0 && w->data[w->used - 1] != '\n')
        w->data[w->used++] = '\n';
    return TRI_OK;
}

static size_t whole_lines(const struct tri_window *w)
{
    size_t n = w->used;
    while (n > 0 && w->data[n - 1] != '\n')
        n--;
    return n;
}

static enum tri_status grow(struct tri_window *w, struct tri_error *error)
{
    if (!tri_resize(&w->data, w->room, 2))
        return tri_fail(error, TRI_NO_MEMORY, w->text.name, 0, "no memory for a line of %zu bytes", w->used);
    w->room *= 2;
    return TRI_OK;
}

/* To the next stretch; its text is empty at the end of the file. */
static enum tri_status move_on(struct tri_window *w, struct tri_error *error)
{
    size_t done = w->text.size;
    size_t lines = w->text.chunks ? w->text.chunks[w->text.n_chunks].line : 0;
    memmove(w->data, w->data + done, w->used - done);
    w->used -= done;
    w->text.size = 0;
    w->text.lines_before = lines;
    enum tri_status status = fill(w, error);
    while (!status && whole_lines(w) == 0 && !w->at_end) {
        status = grow(w, error);
        status = status ? status : fill(w, error);
    }
    if (status)
        return status;
    w->text.data = w->data;
    w->text.size = whole_lines(w);
    if (w->text.size > 0)
        status = tri_text_index(&w->text, w->executor, error);
    w->cursor = tri_cursor_begin(&w->text);
    return status;
}

enum tri_status tri_window_open(struct tri_window *w, const char *path, size_t bytes,
                                const struct tri_executor *executor, struct tri_error *error)
{
    *w = (struct tri_window){.text = {.name = path, .chunk_bytes = 1 << 18}, .executor = executor};
    w->room = bytes + 1;
    w->data = malloc(w->room);
    w->file = w->data ? tri_file_open(path, TRI_OPEN_READ) : TRI_NO_FILE;
    if (!w->data)
        return tri_fail(error, TRI_NO_MEMORY, path, 0, "no memory for %zu bytes of text", bytes);
    if (w->file == TRI_NO_FILE)
        return tri_fail_system(error, TRI_CANNOT_READ, path, "cannot open", errno);
    return move_on(w, error);
}

void tri_window_free(struct tri_window *w)
{
    if (w->data)
        (void)tri_file_close(w->file);
    free(w->data);
    free(w->text.chunks);
    *w = (struct tri_window){.file = TRI_NO_FILE};
}

/* Until there is a record in the stretch. */
static enum tri_status seek(struct tri_window *w, bool *found, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    while (!status && w->text.size > 0 && tri_cursor_remaining(&w->cursor) == 0)
        status = move_on(w, error);
    *found = !status && w->text.size > 0;
    return status;
}

enum tri_status tri_window_next(struct tri_window *w, struct tri_fields *fields, bool *found, struct tri_error *error)
{
    enum tri_status status = seek(w, found, error);
    if (*found)
        (void)tri_cursor_next(&w->cursor, fields);
    return status;
}

enum tri_status tri_window_peek(struct tri_window *w, struct tri_fields *fields, bool *found, struct tri_error *error)
{
    enum tri_status status = seek(w, found, error);
    struct tri_cursor cursor = w->cursor;
    if (*found)
        (void)tri_cursor_next(&cursor, fields);
    return status;
}

enum tri_status tri_window_table(struct tri_window *w, const struct tri_table *table, const char *nouns,
                                 size_t most,
                                 enum tri_status (*flush)(void *user, size_t n, struct tri_error *error),
                                 struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    const long line = (long)w->cursor.line;
    for (size_t done = 0, n; done < table->n && !status; done += n) {
        bool found;
        status = seek(w, &found, error);
        if (!status && !found)
            return tri_fail(error, TRI_BAD_INPUT, w->text.name, line,
                            "unexpected end of file: %zu %s are announced, but only %zu records follow", table->n,
                            nouns, done);
        if (status)
            return status;
        n = tri_cursor_remaining(&w->cursor);
        n = n < most ? n : most;
        n = n < table->n - done ? n : table->n - done;
        struct tri_table part = *table;
        part.n = n;
        part.base += (int64_t)done;
        status = tri_cursor_table(&w->cursor, &part, w->executor, error);
        status = status ? status : flush(table->user, n, error);
    }
    return status;
}
