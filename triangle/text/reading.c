#include "triangle/text/reading.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

bool tri_reading_fail(struct tri_reading *reading, enum tri_status status, size_t line, const char *format, ...)
{
    char text[sizeof reading->error->text];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    reading->status = tri_fail(reading->error, status, reading->path, (long)line, "%s", text);
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

static bool are_in_a_row(const struct tri_tags *tags)
{
    for (int64_t i = 1; i < tags->n; i++)
        if (tags->tag[i - 1] == INT64_MAX || tags->tag[i] != tags->tag[i - 1] + 1)
            return false;
    return true;
}

bool tri_tags_order(struct tri_tags *tags, const char *what, struct tri_reading *reading)
{
    tags->in_a_row = are_in_a_row(tags);
    if (tags->in_a_row)
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
            return tri_reading_fail(reading, TRI_BAD_INPUT, 0, "%s %lld is there twice", what,
                                    (long long)tags->sorted[2 * i]);
    return true;
}

int64_t tri_tags_place(const struct tri_tags *tags, int64_t tag)
{
    if (tags->n == 0)
        return -1;
    if (tags->in_a_row) /* no difference below overflows */
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
