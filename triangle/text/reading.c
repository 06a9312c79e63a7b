#include "triangle/text/reading.h"

#include <stdlib.h>

enum tri_status tri_reading_fail(const struct tri_reading *reading, size_t line, const char *text)
{
    return tri_fail(reading->error, TRI_BAD_INPUT, reading->path, (long)line, "%s", text);
}

enum tri_status tri_reading_no_memory(const struct tri_reading *reading)
{
    return tri_fail(reading->error, TRI_NO_MEMORY, reading->path, 0, "out of memory");
}

bool tri_reading_triangles(const struct tri_reading *reading, int64_t n, int n_nodes)
{
    struct tri_elements *e = reading->elements;
    const size_t three = ((size_t)n + 1) * 3;
    e->n = (int32_t)n;
    e->n_nodes = n_nodes;
    e->corners = malloc(three * sizeof *e->corners);
    e->extra = n_nodes > 3 ? malloc(three * sizeof *e->extra) : NULL;
    return e->corners && (n_nodes == 3 || e->extra);
}

bool tri_reading_segments(const struct tri_reading *reading, int64_t n)
{
    reading->mesh->n_segments = (int32_t)n;
    reading->mesh->segments = malloc(((size_t)n + 1) * 2 * sizeof *reading->mesh->segments);
    return reading->mesh->segments;
}

/* --- tags */

bool tri_tags_begin(struct tri_tags *tags, int64_t n)
{
    *tags = (struct tri_tags){.n = n, .tag = malloc(((size_t)n + 1) * sizeof *tags->tag)};
    return tags->tag;
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

enum tri_status tri_tags_order(struct tri_tags *tags, const char *what, const struct tri_reading *reading)
{
    tags->in_a_row = are_in_a_row(tags);
    if (tags->in_a_row)
        return TRI_OK;
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
            return tri_fail(reading->error, TRI_BAD_INPUT, reading->path, 0, "%s %lld is there twice", what,
                            (long long)tags->sorted[2 * i]);
    return TRI_OK;
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
