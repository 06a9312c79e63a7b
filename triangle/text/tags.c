#include "triangle/text/tags.h"

#include <stdlib.h>

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

enum tri_tags_order tri_tags_order(struct tri_tags *tags, int64_t *twice)
{
    tags->in_a_row = are_in_a_row(tags);
    if (tags->in_a_row)
        return TRI_TAGS_GOOD;
    tags->sorted = malloc((size_t)tags->n * 2 * sizeof *tags->sorted);
    if (!tags->sorted)
        return TRI_TAGS_NO_MEMORY;
    for (int64_t i = 0; i < tags->n; i++) {
        tags->sorted[2 * i] = tags->tag[i];
        tags->sorted[2 * i + 1] = i;
    }
    qsort(tags->sorted, (size_t)tags->n, 2 * sizeof *tags->sorted, compare);
    for (int64_t i = 1; i < tags->n; i++)
        if (tags->sorted[2 * i] == tags->sorted[2 * i - 2]) {
            *twice = tags->sorted[2 * i];
            return TRI_TAGS_TWICE;
        }
    return TRI_TAGS_GOOD;
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
