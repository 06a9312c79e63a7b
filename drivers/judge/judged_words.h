/* The command line of a program that takes a mesh: options, as getopt_long knows them, and one word, the mesh. */
#ifndef DRIVERS_JUDGE_JUDGED_WORDS_H
#define DRIVERS_JUDGE_JUDGED_WORDS_H

#include <getopt.h>
#include <stdbool.h>

struct judged_words {
    const char *program;                   /* its name, for errors */
    const char *version;                   /* a line */
    const char *usage, *help;              /* lines; what --help prints below usage */
    const char *letters;                   /* options of one letter behind "-:", and .. */
    const struct option *options;          /* .. of a word: both as getopt_long takes them */
    int version_option, help_option;
    bool (*apply)(void *settings, int option); /* with optarg; false: that is no value for it */
};

enum judged_words_end {
    WORDS_TAKEN,
    WORDS_ANSWERED, /* help or version, on standard output */
    WORDS_MISUSED   /* and what is wrong, and usage unless it is a value, has been printed on standard error */
};

/* *mesh becomes the one word that is no option, borrowed from argv. */
enum judged_words_end judged_words_take(const struct judged_words *words, int argc, char **argv, void *settings,
                                        char **mesh);

#endif
