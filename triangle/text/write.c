/* Writing output files: tables.
 *
 * Why a table is written as it is: rows are formatted in chunks that fit a second-level cache, a wave of chunks at a
 * time; while one wave is formatted, the previous one is written by one more task of the same run. So the order of the
 * bytes is fixed, nobody waits for the disk, and memory is bounded. */
#include "triangle/text/write.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/text/decimal.h"
#include "triangle/text/text.h"

enum {
    CHUNK_BYTES = 1 << 18,
    WAVE_CHUNKS = 64 /* at a time, where there is an executor */
};

static char *put(char *at, const char *text, size_t length)
{
    memcpy(at, text, length);
    return at + length;
}

/* --- tables */

/* Chunks that are formatted together, and then written together. */
struct wave {
    size_t n;
    char *buffers; /* [WAVE_CHUNKS][buffer_bytes] */
    size_t lengths[WAVE_CHUNKS];
};

struct table {
    struct tri_output *output;
    char *(*format_row)(void *user, size_t i, char *at);
    void *user;
    size_t n_rows, max_row_bytes;
    size_t chunk_rows, buffer_bytes;
    size_t begin; /* first row of the wave that is formatted */
    struct wave *formatted, *written;
    enum tri_status status; /* of writing */
    struct tri_error *error;
};

static void format_chunk(struct table *table, size_t chunk)
{
    char *const buffer = table->formatted->buffers + chunk * table->buffer_bytes, *at = buffer;
    const size_t begin = table->begin + chunk * table->chunk_rows, left = table->n_rows - begin;
    const size_t n = left < table->chunk_rows ? left : table->chunk_rows;
    for (size_t i = begin; i < begin + n; i++) {
        char *const end = table->format_row(table->user, i, at);
        assert((size_t)(end - at) <= table->max_row_bytes);
        at = end;
    }
    table->formatted->lengths[chunk] = (size_t)(at - buffer);
}

static void write_wave(struct table *table)
{
    const struct wave *const wave = table->written;
    for (size_t i = 0; i < wave->n && table->status == TRI_OK; i++)
        table->status =
            tri_output_write(table->output, wave->buffers + i * table->buffer_bytes, wave->lengths[i], table->error);
}

static void table_task(void *context, size_t i)
{
    struct table *const table = context;
    if (i == 0)
        write_wave(table);
    else
        format_chunk(table, i - 1);
}

static void swap_waves(struct table *table)
{
    struct wave *const formatted = table->formatted;
    table->formatted = table->written;
    table->written = formatted;
}

static void run_table(struct table *table, size_t wave_chunks, const struct tri_executor *executor)
{
    while (table->begin < table->n_rows && table->status == TRI_OK) {
        const size_t chunks_left = (table->n_rows - table->begin - 1) / table->chunk_rows + 1;
        const size_t n = chunks_left < wave_chunks ? chunks_left : wave_chunks;
        table->formatted->n = n;
        tri_execute(executor, n + 1, table_task, table);
        table->begin += n == chunks_left ? table->n_rows - table->begin : n * table->chunk_rows;
        swap_waves(table);
    }
    write_wave(table);
}

enum tri_status tri_write_table(struct tri_output *output, size_t n_rows, size_t max_row_bytes,
                                char *(*format_row)(void *user, size_t i, char *at), void *user,
                                const struct tri_executor *executor, struct tri_error *error)
{
    assert(max_row_bytes > 0);
    if (n_rows == 0)
        return TRI_OK;
    const size_t chunk_rows = max_row_bytes < CHUNK_BYTES ? CHUNK_BYTES / max_row_bytes : 1;
    const size_t buffer_bytes = chunk_rows * max_row_bytes + TRI_ROW_SLACK;
    const size_t all_chunks = (n_rows - 1) / chunk_rows + 1, most = executor ? WAVE_CHUNKS : 1;
    const size_t wave_chunks = all_chunks < most ? all_chunks : most;
    const int n_waves = all_chunks > wave_chunks ? 2 : 1;
    char *const buffers = malloc((size_t)n_waves * wave_chunks * buffer_bytes);
    if (!buffers)
        return tri_fail(error, TRI_NO_MEMORY, output->path, 0, "no memory to write a table");
    struct wave waves[2] = {{.buffers = buffers}, {.buffers = buffers}};
    if (n_waves == 2)
        waves[1].buffers += wave_chunks * buffer_bytes;
    struct table table = {output, format_row, user, n_rows, max_row_bytes, chunk_rows, buffer_bytes, 0, &waves[0],
                          &waves[1], TRI_OK, error};
    run_table(&table, wave_chunks, executor);
    free(buffers);
    return table.status;
}

enum tri_status tri_write_counts(struct tri_output *output, const int64_t *counts, int n, struct tri_error *error)
{
    enum { MAX_COUNTS = 8 };
    assert(n >= 1 && n <= MAX_COUNTS);
    char line[MAX_COUNTS * (TRI_INTEGER_CHARS + 2)], *at = line;
    for (int i = 0; i < n; i++)
        at = tri_print_integer(i ? put(at, "  ", 2) : at, counts[i], 0);
    at = put(at, "\n", 1);
    return tri_output_write(output, line, (size_t)(at - line), error);
}

/* A word with a line break in it must not become a record of the file. */
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
    char *at = put(line, begin, sizeof begin - 1);
    for (int i = 0; i < argc; i++)
        at = put_word(at, argv[i]);
    at = put(at, "\n", 1);
    const enum tri_status status = tri_output_write(output, line, (size_t)(at - line), error);
    free(line);
    return status;
}
