#include "drivers/judged_words.h"

#include <stdio.h>

static enum judged_words_end misused(const struct judged_words *words)
{
    fputs(words->usage, stderr);
    return WORDS_MISUSED;
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
        if (option == '?')
            return misused(words);
        if (!words->apply(settings, option))
            return WORDS_BAD_VALUE;
    }
    if (optind + 1 != argc)
        return misused(words);
    *mesh = argv[optind];
    return WORDS_TAKEN;
}
