#include "triangle/text/reading.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/system.h"

bool tri_reading_fail(struct tri_reading *reading, enum tri_status status, size_t line, const char *format, ...)
{
    char text[sizeof reading->error->text];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    reading->status = tri_fail(reading->error, status, reading->path, line, "%s", text);
    return false;
}

bool tri_reading_no_memory(struct tri_reading *reading)
{
    return tri_reading_fail(reading, TRI_NO_MEMORY, 0, "out of memory");
}

bool tri_reading_triangles(struct tri_reading *reading, int64_t n, int n_nodes)
{
    struct tri_elements *e = reading->elements;
    const size_t three = ((size_t)n + 1) * 3;
    e->n = (int32_t)n;
    e->n_nodes = n_nodes;
    e->corners = malloc(three * sizeof *e->corners);
    e->extra = n_nodes > 3 ? malloc(three * sizeof *e->extra) : NULL;
    return (e->corners && (n_nodes == 3 || e->extra)) || tri_reading_no_memory(reading);
}

bool tri_reading_segments(struct tri_reading *reading, int64_t n)
{
    reading->mesh->n_segments = (int32_t)n;
    reading->mesh->segments = malloc(((size_t)n + 1) * 2 * sizeof *reading->mesh->segments);
    return reading->mesh->segments || tri_reading_no_memory(reading);
}

/* --- tags */

bool tri_tags_begin(struct tri_tags *tags, int64_t n, struct tri_reading *reading)
{
    *tags = (struct tri_tags){.n = n, .tag = malloc(((size_t)n + 1) * sizeof *tags->tag)};
    return tags->tag || tri_reading_no_memory(reading);
}

bool tri_tags_begin_nodes(struct tri_tags *tags, int64_t n, struct tri_reading *reading)
{
    reading->mesh->n_points = (int32_t)n;
    reading->mesh->points = malloc(((size_t)n + 1) * 2 * sizeof *reading->mesh->points);
    return tri_tags_begin(tags, n, reading) && (reading->mesh->points || tri_reading_no_memory(reading));
}

static int compare(const void *left, const void *right)
{
    const int64_t a = *(const int64_t *)left, b = *(const int64_t *)right;
    return (a > b) - (a < b);
}

static bool are_consecutive(const struct tri_tags *tags)
{
    for (int64_t i = 1; i < tags->n; i++)
        if (tags->tag[i - 1] == INT64_MAX || tags->tag[i] != tags->tag[i - 1] + 1)
            return false;
    return true;
}

bool tri_tags_order(struct tri_tags *tags, const char *what, struct tri_reading *reading)
{
    tags->is_consecutive = are_consecutive(tags);
    if (tags->is_consecutive)
        return true;
    tags->sorted = malloc((size_t)tags->n * 2 * sizeof *tags->sorted);
    if (!tags->sorted)
        return tri_reading_no_memory(reading);
    for (int64_t i = 0; i < tags->n; i++) {
        tags->sorted[2 * i] = tags->tag[i];
        tags->sorted[2 * i + 1] = i;
    }
    qsort(tags->sorted, (size_t)tags->n, 2 * sizeof *tags->sorted, compare);
    for (int64_t i = 1; i < tags->n; i++)
        if (tags->sorted[2 * i] == tags->sorted[2 * i - 2])
            return tri_reading_fail(reading, TRI_BAD_INPUT, 0, "%s %lld occurs twice", what,
                                    (long long)tags->sorted[2 * i]);
    return true;
}

int64_t tri_tags_place(const struct tri_tags *tags, int64_t tag)
{
    if (tags->n == 0)
        return -1;
    if (tags->is_consecutive) /* the differences below cannot overflow */
        return tag >= tags->tag[0] && tag <= tags->tag[tags->n - 1] ? tag - tags->tag[0] : -1;
    const int64_t *found = bsearch(&tag, tags->sorted, (size_t)tags->n, 2 * sizeof *tags->sorted, compare);
    return found ? found[1] : -1;
}

void tri_tags_free(struct tri_tags *tags)
{
    free(tags->tag);
    free(tags->sorted);
    *tags = (struct tri_tags){0};
}

/* --- bytes */

static enum tri_status read_all(struct tri_bytes *bytes, tri_file file, size_t size, const char *path,
                                struct tri_error *error)
{
    bytes->data = malloc(size + 1);
    if (!bytes->data)
        return tri_fail(error, TRI_NO_MEMORY, path, 0, "out of memory for %zu bytes", size);
    const int64_t got = tri_read_at(file, bytes->data, size, 0);
    if (got < 0)
        return tri_fail_system(error, TRI_CANNOT_READ, path, "cannot read", errno);
    if ((size_t)got < size)
        return tri_fail(error, TRI_CANNOT_READ, path, 0, "became shorter while it was read");
    bytes->at = bytes->data;
    bytes->end = bytes->data + size;
    return TRI_OK;
}

enum tri_status tri_bytes_load(struct tri_bytes *bytes, const char *path, struct tri_error *error)
{
    struct tri_file_facts facts;
    *bytes = (struct tri_bytes){0};
    const tri_file file = tri_file_open(path, TRI_OPEN_NO_WAIT); /* opening a pipe without a writer would block */
    if (file == TRI_NO_FILE)
        return tri_fail_system(error, TRI_CANNOT_READ, path, "cannot open", errno);
    enum tri_status status = TRI_OK;
    if (!tri_file_get_facts(file, &facts) || facts.kind != TRI_REGULAR)
        status = tri_fail(error, TRI_CANNOT_READ, path, 0, "not a regular file");
    status = status ? status : read_all(bytes, file, (size_t)facts.size, path, error);
    (void)tri_file_close(file);
    return status;
}

void tri_bytes_free(struct tri_bytes *bytes)
{
    free(bytes->data);
    *bytes = (struct tri_bytes){0};
}

bool tri_bytes_line(struct tri_bytes *bytes, const char **line, size_t *length)
{
    const char *end = bytes->at < bytes->end ? memchr(bytes->at, '\n', (size_t)(bytes->end - bytes->at)) : NULL;
    if (!end)
        return false;
    *line = bytes->at;
    *length = (size_t)(end - bytes->at);
    if (*length > 0 && end[-1] == '\r')
        --*length;
    bytes->at = end + 1;
    return true;
}

bool tri_bytes_pass(struct tri_bytes *bytes, const char *text)
{
    const size_t n = strlen(text);
    for (const char *at = bytes->at; (size_t)(bytes->end - at) >= n; at++) {
        at = memchr(at, text[0], (size_t)(bytes->end - at) - n + 1);
        if (!at)
            return false;
        if (memcmp(at, text, n) == 0) {
            bytes->at = at + n;
            return true;
        }
    }
    return false;
}
