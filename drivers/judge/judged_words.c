/* getopt_long hands out the word that is no option where it stands, as the option WORD: it may stand anywhere, whatever
 * POSIXLY_CORRECT says. */
#include "drivers/judge/judged_words.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

#include "drivers/one_line.h"

enum { WORD = 1, SIGNS = 2 /* that letters begins with */ };

static enum judged_words_end misused(const struct judged_words *words)
{
    fputs(words->usage, stderr);
    return WORDS_MISUSED;
}

/* What getopt_long has returned '?' or ':' for; its own messages would print words as they are. */
static void complain(const struct judged_words *words, int option, char **argv)
{
    const bool short_one = optopt > 0 && optopt <= CHAR_MAX;
    const bool is_known = optopt > CHAR_MAX || (short_one && optopt != ':' && strchr(words->letters + SIGNS, optopt));
    const char *fault = is_known ? "takes no value" : "is not an option, or short for several";
    fprintf(stderr, "%s: ", words->program);
    one_line_put(stderr, short_one ? (char[]){'-', (char)optopt, 0} : argv[optind - 1]);
    fprintf(stderr, " %s\n", option == ':' ? "needs a value" : fault);
}

/* Help, the version, or one option. */
static enum judged_words_end take_option(const struct judged_words *words, int option, char **argv, void *settings)
{
    if (option == words->help_option || option == words->version_option) {
        bool help = option == words->help_option;
        fputs(help ? words->usage : words->version, stdout);
        fputs(help ? words->help : "", stdout);
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

enum judged_words_end judged_words_take(const struct judged_words *words, int argc, char **argv, void *settings,
                                        char **mesh)
{
    enum judged_words_end end = WORDS_TAKEN;
    int option, n = 0;
    while (end == WORDS_TAKEN && (option = getopt_long(argc, argv, words->letters, words->options, NULL)) != -1) {
        if (option != WORD)
            end = take_option(words, option, argv, settings);
        else if (n++ == 0)
            *mesh = optarg;
    }
    if (end != WORDS_TAKEN)
        return end;
    for (int i = optind; i < argc; i++) /* behind -- */
        if (n++ == 0)
            *mesh = argv[i];
    return n == 1 ? WORDS_TAKEN : misused(words);
}
