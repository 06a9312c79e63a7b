/* INVARIANT: outside begin .. end the terminal shows no line of ours, so that others may print. */
#include "drivers/progress.h"

#include <inttypes.h>
#include <stdio.h>
#include <unistd.h>

#include "triangle/clock.h"
#include "sched/schedule.h"

static const double SECONDS_BETWEEN_LINES = 0.1;

struct progress progress_start(const char *program, enum long_options_progress wanted, bool quiet)
{
    bool terminal = isatty(STDERR_FILENO);
    struct progress progress = {.program = program, .mode = PROGRESS_SILENT, .round = -1};
    if (!quiet && wanted != PROGRESS_NO)
        progress.mode = terminal ? PROGRESS_LINE : wanted == PROGRESS_YES ? PROGRESS_LOG : PROGRESS_SILENT;
    return progress;
}

void progress_stage(struct progress *progress, const char *what)
{
    if (progress->mode == PROGRESS_LOG)
        fprintf(stderr, "%s: %s\n", progress->program, what);
}

void progress_begin(struct progress *progress, int64_t triangles, int threads)
{
    progress->began = progress->told = tri_seconds();
    progress->first = triangles;
    progress->round = -1;
    if (progress->mode == PROGRESS_LOG)
        fprintf(stderr, "%s: refining %" PRId64 " triangles on %d thread%s\n", progress->program, triangles, threads,
                threads == 1 ? "" : "s");
}

/* Million triangles made in a second. */
static double rate(const struct progress *progress, double time, int64_t triangles)
{
    double seconds = time - progress->began;
    return seconds > 0 ? 1e-6 * (double)(triangles - progress->first) / seconds : 0;
}

static int print_step(const struct progress *p, double time, int round, int phase, int64_t triangles)
{
    char where[64] = "pre-refinement";
    if (phase == PAR_NUMBERING)
        return fprintf(stderr, "%s: numbering", p->program);
    if (phase > 0)
        snprintf(where, sizeof where, "round %d, phase %d of 4", round + 1, phase);
    return fprintf(stderr, "%s: refining: %s, %" PRId64 " triangles, %.2f million/s", p->program, where, triangles,
                   rate(p, time, triangles));
}

/* The rest of a longer line that was there is covered with blanks. */
static void rewrite(struct progress *p, double time, int round, int phase, int64_t triangles)
{
    fputc('\r', stderr);
    int width = print_step(p, time, round, phase, triangles);
    if (width < p->width)
        fprintf(stderr, "%*s", p->width - width, "");
    p->width = width;
    fflush(stderr);
}

void progress_step(void *user, int round, int phase, int64_t triangles)
{
    struct progress *p = user;
    double time = tri_seconds();
    bool phase_begins = round != p->round || phase != p->phase;
    if (p->mode == PROGRESS_LINE && (phase_begins || time - p->told >= SECONDS_BETWEEN_LINES)) {
        rewrite(p, time, round, phase, triangles);
        p->told = time;
        p->round = round;
        p->phase = phase;
    } else if (p->mode == PROGRESS_LOG && (phase == 0 || phase == PAR_NUMBERING || round != p->round)) {
        print_step(p, time, round, phase, triangles);
        fputc('\n', stderr);
        p->round = phase == 0 ? -1 : round;
    }
}

void progress_end(struct progress *p, int64_t triangles, double numbering)
{
    double time = tri_seconds() - numbering;
    if (p->mode == PROGRESS_LINE && p->width > 0) {
        fprintf(stderr, "\r%*s\r", p->width, "");
        fflush(stderr);
        p->width = 0;
    } else if (p->mode == PROGRESS_LOG) {
        fprintf(stderr, "%s: refined to %" PRId64 " triangles in %.2f s, %.2f million/s\n", p->program, triangles,
                time - p->began, rate(p, time, triangles));
    }
}
