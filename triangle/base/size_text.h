/* Sizes and counts as text for messages. */
#ifndef TRIANGLE_BASE_SIZE_TEXT_H
#define TRIANGLE_BASE_SIZE_TEXT_H

/* A size in bytes with three digits: "62 B", "151 kB", "90 MB", "1.87 GB". */
struct tri_size_text {
    char text[24];
};

/* bytes >= 0, or +oo; sizes that are too large become "over 1000 EB". */
struct tri_size_text tri_size_text(double bytes);

/* A count n >= 0, or +oo: "57", "45.2 thousand", "1.87 million", "over 1000 trillion". */
struct tri_size_text tri_count_text(double n);

#endif
