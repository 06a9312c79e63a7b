/* Writes tables to output files.
 *
 * Rows are formatted in chunks, a wave of chunks at a time. When a wave is complete, the lengths of its chunks give
 * their offsets in the file. Before a thread formats a chunk of the next wave, it writes the chunk in that buffer. So
 * the output does not depend on the order of threads, writing and formatting overlap, and the data are still in a cache
 * when they are written. (Linux lets one thread at a time write to a file. Formatting between writes keeps threads from
 * contending. Small writes cost more per byte, hence the size of a chunk, of which rows fill a third to a half.) A
 * device or pipe has no offsets: each wave is written in order.
 *
 * A table of few chunks takes a few milliseconds, but threads woken for it spin for longer afterwards. So it is written
 * chunk by chunk, without the executor. */
#include "triangle/text/write.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/text/decimal.h"
#include "triangle/text/text.h"

enum {
    CHUNK_BYTES = 1 << 18,
    WORTH_THREADS = 16, /* a table of fewer chunks is written by one thread */
    WAVE_CHUNKS = 64    /* chunks per wave, with an executor */
};

static char *put_bytes(char *at, const char *text, size_t length)
{
    memcpy(at, text, length);
    return at + length;
}

/* --- tables */

/* A chunk that has been formatted but not written yet. */
struct chunk {
    size_t length;
    uint64_t place;
    int result; /* result of writing it */
};

struct table {
    struct tri_output *output;
    tri_row_call *row;
    const void *user;
    size_t max_row_bytes, buffer_bytes;
    int64_t chunk_rows;
    int64_t begin, end; /* rows from the current wave on */
    size_t n_new;     /* chunks of the current wave */
    size_t n_waiting; /* chunks of the previous wave, being written */
    struct chunk chunks[WAVE_CHUNKS];
    char *buffers;    /* [WAVE_CHUNKS][buffer_bytes] */
};

static void write_chunk(struct table *table, size_t i)
{
    struct chunk *const chunk = &table->chunks[i];
    chunk->result =
        tri_output_write_at(table->output, chunk->place, table->buffers + i * table->buffer_bytes, chunk->length);
}

static void format_chunk(struct table *table, size_t i)
{
    char *const buffer = table->buffers + i * table->buffer_bytes, *at = buffer;
    const int64_t begin = table->begin + (int64_t)i * table->chunk_rows, left = table->end - begin;
    const int64_t n = left < table->chunk_rows ? left : table->chunk_rows;
    for (int64_t k = begin; k < begin + n; k++) {
        char *const end = table->row(table->user, k, at);
        assert((size_t)(end - at) <= table->max_row_bytes);
        at = end;
    }
    table->chunks[i].length = (size_t)(at - buffer);
}

static void table_task(void *context, size_t i)
{
    struct table *const table = context;
    if (i < table->n_waiting && tri_output_has_offsets(table->output))
        write_chunk(table, i);
    if (i < table->n_new)
        format_chunk(table, i);
}

/* Returns the first error among the chunks written. */
static enum tri_status conclude_wave(struct table *table, struct tri_error *error)
{
    for (size_t i = 0; i < table->n_waiting; i++)
        if (table->chunks[i].result != 0)
            return tri_output_conclude(table->output, table->chunks[i].result, error);
    return TRI_OK;
}

/* Assigns offsets to the chunks just formatted. Without offsets, writes them now, until one fails. */
static void place_wave(struct table *table)
{
    int result = 0;
    for (size_t i = 0; i < table->n_new; i++) {
        table->chunks[i].place = tri_output_reserve(table->output, table->chunks[i].length);
        if (!tri_output_has_offsets(table->output) && result == 0) {
            write_chunk(table, i);
            result = table->chunks[i].result;
        }
    }
    table->n_waiting = table->n_new;
}

static enum tri_status run_table(struct table *table, size_t wave_chunks, const struct tri_executor *executor,
                                 struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    while (!status && (table->begin < table->end || table->n_waiting > 0)) {
        const size_t left = (size_t)((table->end - table->begin + table->chunk_rows - 1) / table->chunk_rows);
        table->n_new = left < wave_chunks ? left : wave_chunks;
        tri_execute(executor, table->n_new > table->n_waiting ? table->n_new : table->n_waiting, table_task, table);
        status = conclude_wave(table, error);
        if (!status)
            place_wave(table);
        table->begin = table->n_new == left ? table->end : table->begin + (int64_t)table->n_new * table->chunk_rows;
    }
    return status;
}

enum tri_status tri_write_table(struct tri_output *output, int64_t first, int64_t n, size_t max_row_bytes,
                                tri_row_call *row, const void *user, const struct tri_executor *executor,
                                struct tri_error *error)
{
    assert(max_row_bytes > 0);
    if (n == 0)
        return TRI_OK;
    const size_t chunk_rows = max_row_bytes < CHUNK_BYTES ? CHUNK_BYTES / max_row_bytes : 1;
    const size_t all_chunks = ((size_t)n - 1) / chunk_rows + 1;
    executor = all_chunks < WORTH_THREADS ? NULL : executor;
    const size_t most = executor ? WAVE_CHUNKS : 1;
    const size_t wave_chunks = all_chunks < most ? all_chunks : most;
    struct table table = {.output = output, .row = row, .user = user, .begin = first, .end = first + n,
                          .max_row_bytes = max_row_bytes, .chunk_rows = (int64_t)chunk_rows,
                          .buffer_bytes = chunk_rows * max_row_bytes + TRI_ROW_SLACK};
    table.buffers = malloc(wave_chunks * table.buffer_bytes);
    if (!table.buffers)
        return tri_fail(error, TRI_NO_MEMORY, output->path, 0, "no memory to write a table");
    const enum tri_status status = run_table(&table, wave_chunks, executor, error);
    free(table.buffers);
    return status;
}

_Static_assert(TRI_COUNTS_ROOM >= TRI_MOST_COUNTS * (TRI_INTEGER_CHARS + 2), "a header fits");

char *tri_put_counts(char at[TRI_COUNTS_ROOM], const int64_t *counts, int n)
{
    assert(n >= 1 && n <= TRI_MOST_COUNTS);
    for (int i = 0; i < n; i++)
        at = tri_print_integer(i ? put_bytes(at, "  ", 2) : at, counts[i], 0);
    return put_bytes(at, "\n", 1);
}

enum tri_status tri_write_counts(struct tri_output *output, const int64_t *counts, int n, struct tri_error *error)
{
    char line[TRI_COUNTS_ROOM];
    return tri_output_write(output, line, (size_t)(tri_put_counts(line, counts, n) - line), error);
}

/* Replaces line breaks in a word, so that the comment stays on one line. */
static char *put_word(char *at, const char *word)
{
    *at++ = ' ';
    for (; *word; word++)
        *at++ = *word == '\n' || *word == '\r' ? ' ' : *word;
    return at;
}

enum tri_status tri_write_comment(struct tri_output *output, int argc, char *const *argv, struct tri_error *error)
{
    static const char begin[] = "# Generated by";
    size_t size = sizeof begin + 1;
    for (int i = 0; i < argc; i++)
        size += strlen(argv[i]) + 1;
    char *const line = malloc(size);
    if (!line)
        return tri_fail(error, TRI_NO_MEMORY, output->path, 0, "no memory to write a comment");
    char *at = put_bytes(line, begin, sizeof begin - 1);
    for (int i = 0; i < argc; i++)
        at = put_word(at, argv[i]);
    at = put_bytes(at, "\n", 1);
    const enum tri_status status = tri_output_write(output, line, (size_t)(at - line), error);
    free(line);
    return status;
}
