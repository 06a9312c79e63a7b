#include "drivers/mesh/restart.h"

#include <stdlib.h>
#include <string.h>

#include "drivers/interrupt.h"
#include "triangle/base/grow.h"
#include "triangle/base/system.h"
#include "triangle/base/hash.h"

static const char version[] = PTRIANGLE_VERSION;

static enum tri_status check_options(const struct long_options *o, struct tri_error *error)
{
    if (o->checkpoint && o->resume && strcmp(o->checkpoint, o->resume) != 0)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--checkpoint and --resume name two directories");
    if (o->has_every && !o->checkpoint && !o->resume)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--every needs --checkpoint or --resume");
    return TRI_OK;
}

/* A line of text that grows. */
struct line {
    char *text; /* malloc'ed; ends in a zero if not NULL */
    int64_t n, room;
    bool no_memory;
};

static void add(struct line *line, const char *text)
{
    const int64_t n = (int64_t)strlen(text);
    line->no_memory = line->no_memory || !tri_grow_far(&line->text, &line->room, line->n + n + 1, 1);
    if (line->no_memory)
        return;
    memcpy(line->text + line->n, text, (size_t)n + 1);
    line->n += n;
}

/* Adds an argument, quoted for a shell. */
static void add_word(struct line *to, const char *word)
{
    static const char plain[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+-_./=:,%@";
    const char *quote = strspn(word, plain) == strlen(word) && *word ? "" : tri_word_quote();
    add(to, " ");
    add(to, quote);
    for (; *word; word++)
        add(to, *word == '\'' && *quote == '\'' ? "'\\''" : (char[]){*word, 0});
    add(to, quote);
}

/* Returns true if the argument is this option, with or without "=value". */
static bool is_option(const char *word, const char *option)
{
    size_t n = strlen(option);
    return strncmp(word, option, n) == 0 && (word[n] == 0 || word[n] == '=');
}

/* Returns true for options that the resuming command leaves out. All of them have a value. */
static bool is_left_out(const char *word)
{
    return is_option(word, "--checkpoint") || is_option(word, "--resume") || is_option(word, "--time-limit");
}

/* Builds the resuming command: the original arguments, without the folder, which --resume names, and without the time
 * limit, which applied to this run only. */
static void add_command(struct line *to, const struct restart *r, const char *program,
                        const struct arguments *arguments)
{
    add(to, program);
    for (int i = 1; i < arguments->argc; i++) {
        const char *word = arguments->argv[i];
        if (is_left_out(word))
            i += strchr(word, '=') == NULL;
        else
            add_word(to, word);
    }
    add_word(to, "--resume");
    add_word(to, r->checkpoint.directory);
}

static void report_kept(void *user, int64_t triangles)
{
    const struct restart *restart = user;
    interrupt_kept(triangles, restart->go_on);
}

/* From now on a stop reports what is kept. */
static enum tri_status report_checkpoints(struct restart *r, const char *program, const struct arguments *arguments,
                              struct tri_error *error)
{
    struct line line = {0};
    add_command(&line, r, program, arguments);
    r->go_on = line.text;
    if (line.no_memory)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the command that goes on");
    r->checkpoint.told = report_kept;
    r->checkpoint.told_user = r;
    report_kept(r, par_checkpoint_has_state(&r->checkpoint) ? r->checkpoint.manifest.triangles : 0);
    return TRI_OK;
}

static enum tri_status open_directory(struct restart *restart, const struct long_options *o, const char *directory,
                                      struct tri_error *error)
{
    bool resume = o->resume && (!o->checkpoint || par_checkpoint_is_there(directory));
    if (!restart->follows)
        return par_checkpoint_open(&restart->checkpoint, directory, resume, tri_hash(0, version, sizeof version),
                                   error);
    restart->checkpoint = par_checkpoint_closed(directory);
    return TRI_OK;
}

enum tri_status restart_open(struct restart *restart, const struct long_options *o, const char *program,
                             const struct arguments *arguments, struct par_carrier *carrier, struct tri_error *error)
{
    static const double USUAL_MINUTES = 10;
    const char *directory = o->resume ? o->resume : o->checkpoint;
    *restart = (struct restart){.follows = carrier && carrier->rank > 0};
    enum tri_status status = check_options(o, error);
    if (!status && o->dry_run && o->resume && !o->checkpoint)
        status = par_checkpoint_look(directory, tri_hash(0, version, sizeof version), error);
    bool wanted = !status && directory && !o->dry_run;
    status = wanted ? open_directory(restart, o, directory, error) : status;
    if (wanted && !status && !restart->follows)
        status = report_checkpoints(restart, program, arguments, error);
    if (wanted && status && restart->checkpoint.lock >= 0)
        par_checkpoint_close(&restart->checkpoint, !par_checkpoint_has_state(&restart->checkpoint));
    restart->wanted = wanted && !status;
    restart->checkpoint.seconds = 60 * (o->has_every ? o->every : USUAL_MINUTES);
    restart->checkpoint.limit = o->time_limit > 0 ? tri_seconds() + o->time_limit : 0;
    restart->checkpoint.time_up = interrupt_time_up;
    return carrier ? par_agree(carrier, status, error) : status;
}

void restart_close(struct restart *r, int code)
{
    enum { FIRST_STOP = 124 };
    if (!r->wanted || r->follows)
        return;
    const bool stopped = code >= FIRST_STOP, has_state = par_checkpoint_has_state(&r->checkpoint);
    if (code != EXIT_SUCCESS && !stopped && has_state && r->checkpoint.saved > 0)
        interrupt_print_kept();
    r->checkpoint.told = NULL;
    par_checkpoint_close(&r->checkpoint, code == EXIT_SUCCESS || (!has_state && !stopped));
}
