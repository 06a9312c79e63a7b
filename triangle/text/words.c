#include "triangle/text/words.h"

#include <ctype.h>
#include <string.h>

static const char *end_of(const struct tri_words *w) { return w->text.data + w->text.size; }

static bool is_blank(const struct tri_words *w, char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r') || (*w->blanks && c && strchr(w->blanks, c));
}

static bool begins_comment(const struct tri_words *w)
{
    const size_t n = w->comment ? strlen(w->comment) : 0;
    return n > 0 && (size_t)(end_of(w) - w->at) >= n && memcmp(w->at, w->comment, n) == 0;
}

/* Skips the rest of the line. The text ends in a newline. */
static void skip_line(struct tri_words *w)
{
    const char *newline = memchr(w->at, '\n', (size_t)(end_of(w) - w->at));
    w->at = newline + 1;
    w->line++;
}

bool tri_words_seek(struct tri_words *w)
{
    while (w->at < end_of(w)) {
        if (begins_comment(w))
            skip_line(w);
        else if (is_blank(w, *w->at))
            w->line += *w->at++ == '\n';
        else
            return true;
    }
    return false;
}

bool tri_words_next(struct tri_words *w)
{
    if (!tri_words_seek(w))
        return false;
    w->word = w->at;
    while (!is_blank(w, *w->at))
        w->at++;
    w->length = (size_t)(w->at - w->word);
    return true;
}

bool tri_words_is(const struct tri_words *w, const char *text)
{
    if (strlen(text) != w->length)
        return false;
    for (size_t i = 0; i < w->length; i++)
        if (tolower((unsigned char)w->word[i]) != text[i])
            return false;
    return true;
}

/* Reports an error that quotes the last word. */
static bool fail_at_word(struct tri_words *w, const char *what, const char *wrong)
{
    return TRI_WORDS_FAIL(w, "%s: \"%.*s\" is %s", what, (int)(w->length < 40 ? w->length : 40), w->word, wrong);
}

static bool read_word(struct tri_words *w, const char *what)
{
    return tri_words_next(w) || TRI_WORDS_FAIL(w, "the file ends before %s", what);
}

bool tri_words_real(struct tri_words *w, const char *what, bool finite, double *value)
{
    if (!read_word(w, what))
        return false;
    if (tri_scan_real(w->word, w->at, value) != w->at)
        return fail_at_word(w, what, "not a number");
    return !finite || isfinite(*value) || fail_at_word(w, what, "not finite");
}

bool tri_words_length(struct tri_words *w, double *value)
{
    return tri_words_real(w, "a length", false, value) &&
           (!isnan(*value) || fail_at_word(w, "a length", "not a number"));
}

bool tri_words_whole(struct tri_words *w, const char *what, int64_t least, int64_t most, int64_t *value)
{
    if (!read_word(w, what))
        return false;
    if (tri_scan_integer(w->word, w->at, value) != w->at)
        return fail_at_word(w, what, "not an integer");
    return (*value >= least && *value <= most) || fail_at_word(w, what, "out of range");
}

bool tri_words_count(struct tri_words *w, const char *what, int64_t bytes, int64_t *n)
{
    return tri_words_whole(w, what, 0, INT32_MAX, n) &&
           (*n <= (end_of(w) - w->at) / bytes || fail_at_word(w, what, "more than the file holds"));
}

void tri_words_skip_lines(struct tri_words *w, int64_t n)
{
    for (int64_t i = 0; i <= n && w->at < end_of(w); i++)
        skip_line(w);
}
