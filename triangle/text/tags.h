/* Numbers by which a file knows its nodes or elements, and their places in it. */
#ifndef TRIANGLE_TEXT_TAGS_H
#define TRIANGLE_TEXT_TAGS_H

#include <stdbool.h>
#include <stdint.h>

struct tri_tags {
    int64_t n;
    int64_t *tag;    /* [n] by place; malloc'ed */
    bool in_a_row;   /* each is one more than that before: no search */
    int64_t *sorted; /* [n][2] else: tag and place, by tag */
};

/* Room for n of them, to be filled, then ordered. False: no memory. To be freed in any case. */
bool tri_tags_begin(struct tri_tags *tags, int64_t n);

enum tri_tags_order { TRI_TAGS_GOOD, TRI_TAGS_TWICE, TRI_TAGS_NO_MEMORY };

/* twice: where it is TRI_TAGS_TWICE, a tag that occurs twice. O(n), or O(n log n) where they are not in a row. */
enum tri_tags_order tri_tags_order(struct tri_tags *tags, int64_t *twice);

/* The place of a tag; -1: there is none. O(1) or O(log n). */
int64_t tri_tags_place(const struct tri_tags *tags, int64_t tag);
void tri_tags_free(struct tri_tags *tags);

#endif
