/* A text file in memory as a sequence of records: loading, indexing, and parsing of tables by chunks.
 *
 * The file is read, not memory-mapped: reading is safe if another process truncates the file, and parallelises as
 * well. */
#include "triangle/text/text.h"

#include <assert.h>
#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/grow.h"
#include "triangle/base/system.h"

enum { DEFAULT_CHUNK = 1 << 18 };

static const size_t largest_pipe = 1000000000; /* limit for inputs without a size, which may be endless: /dev/zero */

#define J TRI_IS_JUNK
#define S TRI_IS_START
const uint8_t tri_character_kind[256] = {
    /* 00 */ J, J, J, J, J, J, J, J, J, TRI_IS_BLANK, TRI_IS_NEWLINE, J, J, TRI_IS_BLANK, J, J,
    /* 10 */ J, J, J, J, J, J, J, J, J, J, J, J, J, J, J, J,
    /* 20 */ TRI_IS_BLANK, J, J, TRI_IS_HASH, J, J, J, J, J, J, J, S, J, S, S, J,
    /* 30 */ S, S, S, S, S, S, S, S, S, S, J, J, J, J, J, J,
    /* 40 */ J, J, J, J, J, J, J, J, J, J, J, J, J, J, J, J,
    /* 50 */ J, J, J, J, J, J, J, J, J, J, J, J, J, J, J, J,
    /* 60 */ J, J, J, J, J, J, J, J, J, J, J, J, J, J, J, J,
    /* 70 */ J, J, J, J, J, J, J, J, J, J, J, J, J, J, J, J,
    /* 80 */ J, J, J, J, J, J, J, J, J, J, J, J, J, J, J, J,
    /* 90 */ J, J, J, J, J, J, J, J, J, J, J, J, J, J, J, J,
    /* a0 */ J, J, J, J, J, J, J, J, J, J, J, J, J, J, J, J,
    /* b0 */ J, J, J, J, J, J, J, J, J, J, J, J, J, J, J, J,
    /* c0 */ J, J, J, J, J, J, J, J, J, J, J, J, J, J, J, J,
    /* d0 */ J, J, J, J, J, J, J, J, J, J, J, J, J, J, J, J,
    /* e0 */ J, J, J, J, J, J, J, J, J, J, J, J, J, J, J, J,
    /* f0 */ J, J, J, J, J, J, J, J, J, J, J, J, J, J, J, J,
};
#undef J
#undef S

/* --- fields */

static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

static bool same_word(const char *word, size_t length, const char *lower)
{
    size_t i = 0;
    while (i < length && lower[i] && (word[i] | 0x20) == lower[i])
        i++;
    return i == length && !lower[i];
}

static bool is_not_finite(const char *word, size_t length)
{
    return same_word(word, length, "nan") || same_word(word, length, "inf") || same_word(word, length, "infinity");
}

void tri_fields_skip_junk(struct tri_fields *fields)
{
    const char *at = fields->at;
    while (tri_kind_at(at) == TRI_IS_JUNK || tri_kind_at(at) == TRI_IS_BLANK) {
        const char *const word = at;
        while (is_letter(*at))
            at++;
        const size_t length = (size_t)(at - word);
        if (length == 0)
            at++;
        else if (is_not_finite(word, length))
            fields->not_finite = true;
    }
    fields->at = at;
}

/* Returns the start of the line after the one that contains `at`. */
static const char *next_line(const char *at, const char *end)
{
    if (*at == '\n')
        return at + 1;
    const char *const newline = memchr(at, '\n', (size_t)(end - at));
    assert(newline);
    return newline + 1;
}

/* --- loading */

struct load {
    struct tri_text *text;
    tri_file file;
    size_t file_size;
    int *errors; /* [n_chunks] errno of each chunk's read; -1: the file has become shorter */
};

static void read_chunk(void *context, size_t i)
{
    struct load *const load = context;
    if (tri_stop_is_asked(load->text->stop)) /* the caller of the tasks checks this as well */
        return;
    const size_t begin = i * load->text->chunk_bytes;
    const size_t left = load->file_size - begin;
    const size_t n = left < load->text->chunk_bytes ? left : load->text->chunk_bytes;
    const int64_t got = tri_read_at(load->file, load->text->data + begin, n, begin);
    load->errors[i] = got < 0 ? errno : (size_t)got < n ? -1 : 0;
}

/* Reads a file of known size in parallel. */
static enum tri_status read_sized(struct load *load, const struct tri_executor *executor, struct tri_error *error)
{
    struct tri_text *const text = load->text;
    const size_t n_chunks = (load->file_size - 1) / text->chunk_bytes + 1;
    text->data = malloc(load->file_size + 1);
    load->errors = calloc(n_chunks, sizeof *load->errors);
    if (!text->data || !load->errors)
        return tri_fail(error, TRI_NO_MEMORY, text->name, 0, "no memory for %zu bytes of text", load->file_size);
    tri_execute(executor, n_chunks, read_chunk, load);
    if (tri_stop_is_asked(text->stop))
        return tri_fail_stopped(error);
    for (size_t i = 0; i < n_chunks; i++)
        if (load->errors[i] < 0)
            return tri_fail(error, TRI_CANNOT_READ, text->name, 0, "the file became shorter while it was read");
        else if (load->errors[i] > 0)
            return tri_fail_system(error, TRI_CANNOT_READ, text->name, "cannot read", load->errors[i]);
    text->size = load->file_size;
    return TRI_OK;
}

/* Reads a pipe, or a file that reports no size, to its end. */
static enum tri_status read_stream(struct tri_text *text, tri_file file, struct tri_error *error)
{
    enum { PIECE = 1 << 16 };
    int64_t room = 0;
    for (;;) {
        if (!tri_grow_far(&text->data, &room, (int64_t)text->size + PIECE, 1)) /* one byte is for a final newline */
            return tri_fail(error, TRI_NO_MEMORY, text->name, 0, "no memory for the file");
        if (tri_stop_is_asked(text->stop))
            return tri_fail_stopped(error);
        const int64_t got = tri_read_next(file, text->data + text->size, (size_t)room - 1 - text->size);
        if (got == 0)
            return TRI_OK;
        if (got < 0 && errno != EINTR)
            return tri_fail_system(error, TRI_CANNOT_READ, text->name, "cannot read", errno);
        if (got > 0)
            text->size += (size_t)got;
        if (text->size > largest_pipe)
            return tri_fail(error, TRI_CANNOT_READ, text->name, 0, "more than 1 GB from a file that is not regular");
    }
}

static enum tri_status read_open_file(struct tri_text *text, tri_file file, const struct tri_executor *executor,
                                      struct tri_error *error)
{
    struct tri_file_facts facts;
    if (!tri_file_get_facts(file, &facts))
        return tri_fail_system(error, TRI_CANNOT_READ, text->name, "cannot read", errno);
    if (facts.kind == TRI_FOLDER)
        return tri_fail(error, TRI_CANNOT_READ, text->name, 0, "cannot read: this is a directory");
    if (facts.kind != TRI_REGULAR || facts.size == 0)
        return read_stream(text, file, error);
    struct load load = {text, file, (size_t)facts.size, NULL};
    const enum tri_status result = read_sized(&load, executor, error);
    free(load.errors);
    return result;
}

static enum tri_status read_file(struct tri_text *text, const struct tri_executor *executor, struct tri_error *error)
{
    tri_file file;
    do
        file = tri_file_open(text->name, TRI_OPEN_READ);
    while (file == TRI_NO_FILE && errno == EINTR && !tri_stop_is_asked(text->stop));
    if (file == TRI_NO_FILE && errno == EINTR)
        return tri_fail_stopped(error);
    if (file == TRI_NO_FILE)
        return tri_fail_system(error, TRI_CANNOT_READ, text->name, "cannot open", errno);
    const enum tri_status result = read_open_file(text, file, executor, error);
    (void)tri_file_close(file);
    return result;
}

/* --- index */

/* Returns the start of the first line that starts in chunk i, or NULL. Looks only at the bytes of the chunk, so that a
 * single endless line does not make indexing quadratic. */
static const char *first_line(const struct tri_text *text, size_t i)
{
    const size_t begin = i * text->chunk_bytes;
    if (i == 0)
        return text->data;
    const size_t left = text->size - begin;
    const size_t n = left < text->chunk_bytes ? left : text->chunk_bytes;
    const char *const newline = memchr(text->data + begin - 1, '\n', n); /* lines start in [begin, begin + n) */
    return newline ? newline + 1 : NULL;
}

/* Sets the start of chunk i, and its own numbers of lines and records. */
static void count_chunk(void *context, size_t i)
{
    struct tri_text *const text = context;
    struct tri_text_chunk *const chunk = &text->chunks[i];
    const char *const own = text->data + i * text->chunk_bytes, *const end = text->data + text->size;
    const char *const stop = i + 1 < text->n_chunks ? own + text->chunk_bytes : end;
    if (tri_stop_is_asked(text->stop))
        return;
    chunk->has_nul = memchr(own, 0, (size_t)(stop - own)) != NULL;
    const char *line = first_line(text, i);
    chunk->begin = line ? (size_t)(line - text->data) : SIZE_MAX;
    while (line && line < stop) {
        struct tri_fields fields;
        chunk->record += tri_fields_open(&fields, line, end);
        chunk->line++;
        line = next_line(fields.at, end);
    }
}

/* Converts the numbers of lines and records in each chunk to numbers before it. Chunks in which no line starts get the
 * start of the next chunk. */
static void accumulate(struct tri_text *text)
{
    struct tri_text_chunk before = {.line = text->lines_before};
    for (size_t i = 0; i <= text->n_chunks; i++) {
        struct tri_text_chunk *const chunk = &text->chunks[i];
        const struct tri_text_chunk own = *chunk;
        chunk->line = before.line;
        chunk->record = before.record;
        before.line += own.line;
        before.record += own.record;
    }
    text->chunks[text->n_chunks].begin = text->size;
    for (size_t i = text->n_chunks; i-- > 0;)
        if (text->chunks[i].begin == SIZE_MAX)
            text->chunks[i].begin = text->chunks[i + 1].begin;
}

/* Returns the number of the line that contains `at`. */
static int64_t line_of(const char *begin, const char *at)
{
    int64_t line = 1;
    for (; begin < at; begin++)
        line += *begin == '\n';
    return line;
}

/* Rejects NUL bytes, at which numbers would end too early: the file is UTF-16, or not text at all. */
static enum tri_status check_nul(const struct tri_text *text, struct tri_error *error)
{
    for (size_t i = 0; i < text->n_chunks; i++)
        if (text->chunks[i].has_nul) {
            const char *const nul = memchr(text->data, 0, text->size);
            return tri_fail(error, TRI_BAD_INPUT, text->name, text->lines_before + line_of(text->data, nul),
                            "holds a NUL byte: this is not a text file");
        }
    return TRI_OK;
}

/* Builds the index of data[size], which ends in a newline. TRI_NO_MEMORY, TRI_STOPPED, TRI_BAD_INPUT. */
static enum tri_status index_text(struct tri_text *text, const struct tri_executor *executor, struct tri_error *error)
{
    free(text->chunks);
    text->n_chunks = (text->size - 1) / text->chunk_bytes + 1;
    text->chunks = calloc(text->n_chunks + 1, sizeof *text->chunks);
    if (!text->chunks)
        return tri_fail(error, TRI_NO_MEMORY, text->name, 0, "no memory for the index of the file");
    tri_execute(executor, text->n_chunks, count_chunk, text);
    if (tri_stop_is_asked(text->stop))
        return tri_fail_stopped(error);
    accumulate(text);
    return check_nul(text, error);
}

enum tri_status tri_text_load(struct tri_text *text, const char *path, size_t chunk_bytes,
                              const struct tri_executor *executor, const struct tri_stop *stop,
                              struct tri_error *error)
{
    *text = (struct tri_text){.name = path, .stop = stop, .chunk_bytes = chunk_bytes ? chunk_bytes : DEFAULT_CHUNK};
    const enum tri_status status = read_file(text, executor, error);
    if (status != TRI_OK)
        return status;
    if (text->size == 0 || text->data[text->size - 1] != '\n')
        text->data[text->size++] = '\n';
    return index_text(text, executor, error);
}

void tri_text_free(struct tri_text *text)
{
    free(text->data);
    free(text->chunks);
    *text = (struct tri_text){0};
}

/* --- records */

struct tri_cursor tri_cursor_begin(const struct tri_text *text)
{
    return (struct tri_cursor){text, text->data, text->lines_before, 0};
}

bool tri_cursor_next(struct tri_cursor *cursor, struct tri_fields *fields)
{
    const char *const end = cursor->text->data + cursor->text->size;
    while (cursor->at < end) {
        const bool is_record = tri_fields_open(fields, cursor->at, end);
        cursor->at = next_line(fields->at, end);
        cursor->line++;
        if (is_record) {
            cursor->record++;
            return true;
        }
    }
    return false;
}

size_t tri_cursor_remaining(const struct tri_cursor *cursor)
{
    return cursor->text->chunks[cursor->text->n_chunks].record - cursor->record;
}

/* Result of parsing the records of one chunk. */
struct outcome {
    struct tri_cursor cursor; /* position after the last record parsed; its text is NULL if there was none */
    const char *fault;        /* fault of that record, or NULL */
};

struct parse {
    const struct tri_table *table;
    struct tri_cursor begin;  /* start of the table */
    struct outcome *outcomes; /* [n_chunks] */
};

/* Parses the records of the table that start in chunk i. */
static void parse_chunk(void *context, size_t i)
{
    struct parse *const parse = context;
    const struct tri_text *const text = parse->begin.text;
    const struct tri_text_chunk *const chunk = &text->chunks[i];
    const char *const end = text->data + text->size, *const stop = text->data + chunk[1].begin;
    struct tri_cursor cursor = {text, text->data + chunk->begin, chunk->line, chunk->record};
    const char *fault = NULL;
    if (cursor.at <= parse->begin.at)
        cursor = parse->begin;
    size_t row = cursor.record - parse->begin.record;
    if (row >= parse->table->n || cursor.at >= stop || tri_stop_is_asked(text->stop))
        return;
    while (!fault && row < parse->table->n && cursor.at < stop) {
        struct tri_fields fields;
        const bool is_record = tri_fields_open(&fields, cursor.at, end);
        if (is_record)
            fault = parse->table->row(parse->table->user, row++, &fields);
        cursor.at = next_line(fields.at, end);
        cursor.line++;
        cursor.record += is_record;
    }
    parse->outcomes[i] = (struct outcome){cursor, fault};
}

/* Reports the fault of the first faulty record, or moves the cursor to the end of the table. */
static enum tri_status conclude(const struct parse *parse, struct tri_cursor *cursor, struct tri_error *error)
{
    const struct tri_text *text = parse->begin.text;
    for (size_t i = 0; i < text->n_chunks; i++) {
        const struct outcome *const outcome = &parse->outcomes[i];
        const int64_t row = (int64_t)(outcome->cursor.record - 1 - parse->begin.record);
        if (outcome->fault)
            return tri_fail(error, TRI_BAD_INPUT, text->name, outcome->cursor.line, "%s %lld %s",
                            parse->table->noun, (long long)(row + parse->table->base), outcome->fault);
        *cursor = outcome->cursor.text ? outcome->cursor : *cursor;
    }
    assert(cursor->record == parse->begin.record + parse->table->n);
    return TRI_OK;
}

enum tri_status tri_cursor_table(struct tri_cursor *cursor, const struct tri_table *table,
                                 const struct tri_executor *executor, struct tri_error *error)
{
    assert(table->n <= tri_cursor_remaining(cursor));
    if (table->n == 0)
        return TRI_OK;
    struct parse parse = {table, *cursor, calloc(cursor->text->n_chunks, sizeof *parse.outcomes)};
    if (!parse.outcomes)
        return tri_fail(error, TRI_NO_MEMORY, cursor->text->name, 0, "no memory to read a table");
    tri_execute(executor, cursor->text->n_chunks, parse_chunk, &parse);
    const enum tri_status status = tri_stop_is_asked(cursor->text->stop) ? tri_fail_stopped(error)
                                                                         : conclude(&parse, cursor, error);
    free(parse.outcomes);
    return status;
}

const char *tri_fields_marker(struct tri_fields *fields, int32_t *marker)
{
    int64_t value;
    if (tri_fields_integer(fields, &value) == TRI_FIELD_BAD)
        return "has a marker that is not a number";
    const uint32_t low = (uint32_t)((uint64_t)value & UINT32_MAX);
    memcpy(marker, &low, sizeof low);
    return NULL;
}

const char *tri_fields_point(struct tri_fields *fields, double xy[2])
{
    tri_fields_skip(fields);
    const enum tri_field x = tri_fields_real(fields, &xy[0]);
    if (x != TRI_FIELD_GOOD)
        return x == TRI_FIELD_MISSING ? "has no x coordinate" : "has an x coordinate that is not a finite number";
    const enum tri_field y = tri_fields_real(fields, &xy[1]);
    if (y != TRI_FIELD_GOOD)
        return y == TRI_FIELD_MISSING ? "has no y coordinate" : "has a y coordinate that is not a finite number";
    return NULL;
}

/* --- windows
 *
 * When the last record of the window has been read, the window moves on: the incomplete last line is moved to the
 * front, and the buffer is filled from the file. */

/* Fills the buffer from the file. */
static enum tri_status fill_room(struct tri_window *w, struct tri_error *error)
{
    while (!w->at_end && w->used + 1 < w->room) { /* one byte is for a final newline */
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

static enum tri_status grow_room(struct tri_window *w, struct tri_error *error)
{
    if (!tri_resize(&w->data, w->room, 2))
        return tri_fail(error, TRI_NO_MEMORY, w->text.name, 0, "no memory for a line of %zu bytes", w->used);
    w->room *= 2;
    return TRI_OK;
}

/* Moves the window on; its text is empty at the end of the file. */
static enum tri_status advance_window(struct tri_window *w, struct tri_error *error)
{
    size_t done = w->text.size;
    size_t lines = w->text.chunks ? w->text.chunks[w->text.n_chunks].line : 0;
    memmove(w->data, w->data + done, w->used - done);
    w->used -= done;
    w->text.size = 0;
    w->text.lines_before = lines;
    enum tri_status status = fill_room(w, error);
    while (!status && whole_lines(w) == 0 && !w->at_end) {
        status = grow_room(w, error);
        status = status ? status : fill_room(w, error);
    }
    if (status)
        return status;
    w->text.data = w->data;
    w->text.size = whole_lines(w);
    if (w->text.size > 0)
        status = index_text(&w->text, w->executor, error);
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
    return advance_window(w, error);
}

void tri_window_free(struct tri_window *w)
{
    if (w->data)
        (void)tri_file_close(w->file);
    free(w->data);
    free(w->text.chunks);
    *w = (struct tri_window){.file = TRI_NO_FILE};
}

/* Moves the window on until it contains a record. */
static enum tri_status seek_record(struct tri_window *w, bool *found, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    while (!status && w->text.size > 0 && tri_cursor_remaining(&w->cursor) == 0)
        status = advance_window(w, error);
    *found = !status && w->text.size > 0;
    return status;
}

enum tri_status tri_window_next(struct tri_window *w, struct tri_fields *fields, bool *found, struct tri_error *error)
{
    enum tri_status status = seek_record(w, found, error);
    if (*found)
        (void)tri_cursor_next(&w->cursor, fields);
    return status;
}

enum tri_status tri_window_peek(struct tri_window *w, struct tri_fields *fields, bool *found, struct tri_error *error)
{
    enum tri_status status = seek_record(w, found, error);
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
    const int64_t line = w->cursor.line;
    for (size_t done = 0, n; done < table->n && !status; done += n) {
        bool found;
        status = seek_record(w, &found, error);
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
