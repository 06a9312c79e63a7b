/* Control characters are escaped in the complete text. getopt_long returns an argument that is no option as the option
 * WORD, so it may stand anywhere, regardless of POSIXLY_CORRECT. */
#include "drivers/words.h"

#include <float.h>
#include <inttypes.h>
#include <limits.h>
#include <string.h>

#include "triangle/text/decimal.h"

enum { LENGTH = 1 << 14, WORD = 1, SIGNS = 2 /* number of leading characters of letters that are signs */ };

/* --- printing */

void one_line_put(FILE *stream, const char *text)
{
    for (const char *at = text; *at; at++)
        if (*at == '\n')
            fputs("\\n", stream);
        else if ((unsigned char)*at < 0x20 || *at == 0x7f)
            fprintf(stream, "\\x%02x", (unsigned)*at);
        else
            fputc(*at, stream);
}

void one_line_print(FILE *stream, const char *format, va_list arguments)
{
    if (!strstr(format, "%s")) {
        vfprintf(stream, format, arguments);
        return;
    }
    const size_t length = strlen(format), before = strspn(format, "\n");
    size_t after = 0;
    while (after < length - before && format[length - after - 1] == '\n')
        after++;
    char text[LENGTH];
    vsnprintf(text, sizeof text, format, arguments);
    if (strlen(text) + 1 < sizeof text)
        text[strlen(text) - after] = 0;
    fprintf(stream, "%.*s", (int)before, format);
    one_line_put(stream, text + before);
    fputs(format + length - after, stream);
}

void one_line_error(FILE *stream, const char *before, const struct tri_error *error)
{
    fputs(before, stream);
    if (error->file[0])
        one_line_put(stream, error->file);
    if (error->file[0] && error->line > 0)
        fprintf(stream, ":%" PRId64 ": ", error->line);
    else if (error->file[0])
        fputs(": ", stream);
    one_line_put(stream, error->text);
    fputc('\n', stream);
}

/* --- reading */

bool words_take_real(const char *text, const char *letters, const double *factor, double low, double high,
                     double *value)
{
    double number;
    const char *end = tri_scan_real(text, text + strlen(text), &number);
    const char *letter = *end ? strchr(letters, *end) : NULL;
    if (end == text || (*end && (!letter || end[1])))
        return false;
    number *= letter ? factor[letter - letters] : 1;
    if (!(number >= low && number <= high))
        return false;
    *value = number;
    return true;
}

bool words_take_size(const char *text, double least, double *bytes, double *share)
{
    static const double thousands[] = {1e3, 1e6, 1e9, 1e12}, per_cent[] = {0.01};
    const bool is_share = strchr(text, '%') != NULL;
    if (is_share ? !words_take_real(text, "%", per_cent, DBL_TRUE_MIN, 1, share)
                 : !words_take_real(text, "KMGT", thousands, least, 0x1p60, bytes))
        return false;
    *(is_share ? bytes : share) = 0;
    return true;
}

/* --- programs that read one mesh */

static enum words_end misused(const struct program_words *words)
{
    fputs(words->usage, stderr);
    return WORDS_MISUSED;
}

/* Reports an error after getopt_long has returned '?' or ':'. The messages of getopt_long would print arguments
 * unescaped. */
static void complain(const struct program_words *words, int option, char **argv)
{
    const bool short_one = optopt > 0 && optopt <= CHAR_MAX;
    const bool is_known = optopt > CHAR_MAX || (short_one && optopt != ':' && strchr(words->letters + SIGNS, optopt));
    const char *fault = is_known ? "takes no value" : "is not an option, or short for several";
    fprintf(stderr, "%s: ", words->program);
    one_line_put(stderr, short_one ? (char[]){'-', (char)optopt, 0} : argv[optind - 1]);
    fprintf(stderr, " %s\n", option == ':' ? "needs a value" : fault);
}

/* Handles help, version, or one option. */
static enum words_end take_option(const struct program_words *words, int option, char **argv, void *settings)
{
    if (option == words->help_option || option == words->version_option) {
        bool help = option == words->help_option;
        fputs(help ? words->usage : words->version, stdout);
        fputs(help ? words->help : "", stdout);
        fputs(help && words->more ? words->more : "", stdout);
        return WORDS_ANSWERED;
    }
    if (option == '?' || option == ':') {
        complain(words, option, argv);
        return misused(words);
    }
    if (words->apply(settings, option))
        return WORDS_TAKEN;
    fprintf(stderr, "%s: not a value for this option: ", words->program);
    one_line_put(stderr, optarg);
    fputc('\n', stderr);
    return WORDS_MISUSED;
}

enum words_end words_take_all(const struct program_words *words, int argc, char **argv, void *settings,
                              char **mesh)
{
    enum words_end end = WORDS_TAKEN;
    int option, n = 0;
    while (end == WORDS_TAKEN && (option = getopt_long(argc, argv, words->letters, words->options, NULL)) != -1) {
        if (option != WORD)
            end = take_option(words, option, argv, settings);
        else if (n++ == 0)
            *mesh = optarg;
    }
    if (end != WORDS_TAKEN)
        return end;
    for (int i = optind; i < argc; i++) /* arguments after -- */
        if (n++ == 0)
            *mesh = argv[i];
    return n == 1 ? WORDS_TAKEN : misused(words);
}
