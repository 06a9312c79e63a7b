/* A text as a sequence of words, for formats that consist of keywords and numbers in any layout of lines. */
#ifndef TRIANGLE_TEXT_WORDS_H
#define TRIANGLE_TEXT_WORDS_H

#include "triangle/text/reading.h"
#include "triangle/text/text.h"

struct tri_words {
    struct tri_reading to; /* receives the mesh, if any; path, error and status */
    struct tri_text text;  /* the whole file */
    const char *at;        /* the text not read yet */
    size_t line;           /* line of `at`, from 1 */
    const char *blanks;    /* additional characters that separate words, besides white space */
    const char *comment;   /* starts a comment to the end of the line; NULL: no comments */
    const char *word;      /* the last word read */
    size_t length;         /* length of `word` */
};

/* Moves to the next word. Returns false if there is none. */
bool tri_words_seek(struct tri_words *words);

/* Reads the next word. Returns false if there is none. */
bool tri_words_next(struct tri_words *words);

/* Is the last word equal to `text`, which is in lower case? Ignores case. */
bool tri_words_is(const struct tri_words *words, const char *text);

/* Read a number. If the next word is not such a number, they fail with an error that names `what`. Real: may be
 * infinite or NaN unless `finite`. Length: may be infinite. Whole: an integer from `least` to `most`. */
bool tri_words_real(struct tri_words *words, const char *what, bool finite, double *value);
bool tri_words_length(struct tri_words *words, double *value);
bool tri_words_whole(struct tri_words *words, const char *what, int64_t least, int64_t most, int64_t *value);

/* Reads a number of items. Fails if it exceeds INT32_MAX, or what the rest of the text can hold at `bytes` or more per
 * item. */
bool tri_words_count(struct tri_words *words, const char *what, int64_t bytes, int64_t *n);

/* Skips the rest of this line, and n more lines. */
void tri_words_skip_lines(struct tri_words *words, int64_t n);

/* Fails with an error at the current line. */
#define TRI_WORDS_FAIL(words, ...) tri_reading_fail(&(words)->to, TRI_BAD_INPUT, (words)->line, __VA_ARGS__)

#endif
