/* A text as a sequence of words, for formats that consist of keywords and numbers in any layout of lines. */
#ifndef TRIANGLE_TEXT_WORDS_H
#define TRIANGLE_TEXT_WORDS_H

#include "triangle/text/reading.h"
#include "triangle/text/text.h"

struct tri_words {
    struct tri_reading to; /* the mesh, if it is one; the path, the error and the status */
    struct tri_text text;
    const char *at;        /* what has not been taken */
    size_t line;           /* that `at` is in, from 1 */
    const char *blanks;    /* characters between words, beside white space */
    const char *comment;   /* begins one, to the end of the line; NULL: there are none */
    const char *word;      /* the last one taken */
    size_t length;         /* of it */
};

/* Moves to the next word; false: there is none. */
bool tri_words_seek(struct tri_words *words);

/* Takes the next word; false: there is none. */
bool tri_words_next(struct tri_words *words);

/* Is the last word this one, given in small letters, whatever its case? */
bool tri_words_is(const struct tri_words *words, const char *text);

/* The next word is a number; otherwise these fail, and name `what` it should have been. A real may be infinite or NaN,
 * unless `finite`; a length may be infinite. A whole number is from least to most. */
bool tri_words_real(struct tri_words *words, const char *what, bool finite, double *value);
bool tri_words_length(struct tri_words *words, double *value);
bool tri_words_whole(struct tri_words *words, const char *what, int64_t least, int64_t most, int64_t *value);

/* The next word says how many items follow, each of `bytes` at least: no more than the rest of the text holds, and no
 * more than INT32_MAX. */
bool tri_words_count(struct tri_words *words, const char *what, int64_t bytes, int64_t *n);

/* Leaves out the rest of this line, and n more. */
void tri_words_skip_lines(struct tri_words *words, int64_t n);

/* Fails in this line. */
#define TRI_WORDS_FAIL(words, ...) tri_reading_fail(&(words)->to, TRI_BAD_INPUT, (words)->line, __VA_ARGS__)

#endif
