#include "drivers/restart.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char version[] = PTRIANGLE_VERSION;

static enum tri_status check_options(const struct long_options *o, struct tri_error *error)
{
    if (o->checkpoint && o->resume && strcmp(o->checkpoint, o->resume) != 0)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--checkpoint and --resume name two directories");
    if (o->has_every && !o->checkpoint && !o->resume)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--every needs --checkpoint or --resume");
    return TRI_OK;
}

static enum tri_status open_directory(struct restart *restart, const struct long_options *o, const char *directory,
                                      struct tri_error *error)
{
    bool resume = o->resume && (!o->checkpoint || par_checkpoint_is_there(directory));
    if (!restart->follows)
        return par_checkpoint_open(&restart->checkpoint, directory, resume, par_hash(0, version, sizeof version),
                                   error);
    restart->checkpoint = par_checkpoint_closed(directory);
    return TRI_OK;
}

enum tri_status restart_open(struct restart *restart, const struct long_options *o, struct par_carrier *carrier,
                             struct tri_error *error)
{
    static const double USUAL_MINUTES = 10;
    const char *directory = o->resume ? o->resume : o->checkpoint;
    *restart = (struct restart){.follows = carrier && carrier->rank > 0};
    enum tri_status status = check_options(o, error);
    if (!status && o->dry_run && o->resume && !o->checkpoint)
        status = par_checkpoint_look(directory, par_hash(0, version, sizeof version), error);
    bool wanted = !status && directory && !o->dry_run;
    status = wanted ? open_directory(restart, o, directory, error) : status;
    restart->wanted = wanted && !status;
    restart->checkpoint.seconds = 60 * (o->has_every ? o->every : USUAL_MINUTES);
    return carrier ? par_agree(carrier, status, error) : status;
}

/* A word as a shell would need it. */
static void print_word(const char *word)
{
    static const char plain[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+-_./=:,%@";
    if (*word && strspn(word, plain) == strlen(word)) {
        fprintf(stderr, " %s", word);
        return;
    }
    fputs(" '", stderr);
    for (; *word; word++)
        if (*word == '\'')
            fputs("'\\''", stderr);
        else
            fputc(*word, stderr);
    fputc('\'', stderr);
}

/* Is this the option, in a word of its own or with its value behind a "="? */
static bool is_option(const char *word, const char *option)
{
    size_t n = strlen(option);
    return strncmp(word, option, n) == 0 && (word[n] == 0 || word[n] == '=');
}

/* Is this one of the options, which all have a value, that the command that goes on has not? */
static bool is_left_out(const char *word)
{
    return is_option(word, "--checkpoint") || is_option(word, "--resume") || is_option(word, "--time-limit");
}

/* The command that goes on: the words that were given, but for those that name the directory, and the limit of time,
 * which was that of the run that is over. */
static void print_command(const struct restart *r, const struct arguments *arguments)
{
    for (int i = 1; i < arguments->argc; i++) {
        const char *word = arguments->argv[i];
        if (is_left_out(word))
            i += strchr(word, '=') == NULL;
        else
            print_word(word);
    }
    print_word("--resume");
    print_word(r->checkpoint.directory);
}

void restart_close(struct restart *r, const char *program, const struct arguments *arguments, int code)
{
    enum { FIRST_STOP = 124 };
    if (!r->wanted || r->follows)
        return;
    const struct par_manifest *m = &r->checkpoint.manifest;
    bool stopped = code >= FIRST_STOP, has_state = par_checkpoint_has_state(&r->checkpoint);
    if (code != EXIT_SUCCESS && has_state && (stopped || r->checkpoint.saved > 0)) {
        fprintf(stderr, "%s: %" PRId64 " triangles are kept; to go on: %s", program, m->triangles, program);
        print_command(r, arguments);
        fputc('\n', stderr);
    }
    par_checkpoint_close(&r->checkpoint, code == EXIT_SUCCESS || (!has_state && !stopped));
}
