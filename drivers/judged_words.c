#include "drivers/judged_words.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

#include "drivers/one_line.h"

static enum judged_words_end misused(const struct judged_words *words)
{
    fputs(words->usage, stderr);
    return WORDS_MISUSED;
}

/* What getopt_long has returned '?' or ':' for; its own messages would print words as they are. */
static void complain(const struct judged_words *words, int option, char **argv)
{
    const bool short_one = optopt > 0 && optopt <= CHAR_MAX;
    const bool is_known = optopt > CHAR_MAX || (short_one && optopt != ':' && strchr(words->letters, optopt));
    const char *fault = is_known ? "takes no value" : "is not an option, or short for several";
    fprintf(stderr, "%s: ", words->program);
    one_line_put(stderr, short_one ? (char[]){'-', (char)optopt, 0} : argv[optind - 1]);
    fprintf(stderr, " %s\n", option == ':' ? "needs a value" : fault);
}

enum judged_words_end judged_words_take(const struct judged_words *words, int argc, char **argv, void *settings,
                                        char **mesh)
{
    int option;
    while ((option = getopt_long(argc, argv, words->letters, words->options, NULL)) != -1) {
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
        if (!words->apply(settings, option)) {
            fprintf(stderr, "%s: not a value for this option: ", words->program);
            one_line_put(stderr, optarg);
            fputc('\n', stderr);
            return WORDS_MISUSED;
        }
    }
    if (optind + 1 != argc)
        return misused(words);
    *mesh = argv[optind];
    return WORDS_TAKEN;
}
