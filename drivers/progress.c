/* INVARIANT: outside begin .. end the terminal shows no line of ours, so that others may print. */
#include "drivers/progress.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <unistd.h>

#include "drivers/resources.h"
#include "sched/schedule.h"
#include "triangle/clock.h"
#include "triangle/size_text.h"

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

void progress_begin(struct progress *progress, int64_t triangles, double estimate, int threads)
{
    progress->began = progress->told = tri_seconds();
    progress->first = triangles;
    progress->estimate = estimate;
    progress->round = -1;
    if (progress->mode == PROGRESS_LOG)
        fprintf(stderr, "%s: refining %" PRId64 " triangles on %d thread%s\n", progress->program, triangles, threads,
                threads == 1 ? "" : "s");
}

/* Triangles made in a second. */
static double rate(const struct progress *progress, double time, int64_t triangles)
{
    double seconds = time - progress->began;
    return seconds > 0 ? (double)(triangles - progress->first) / seconds : 0;
}

/* A time as people write it: 42 s, 12:07 min, 3:05 h. */
static int print_time(double seconds)
{
    if (seconds < 100)
        return fprintf(stderr, "%.0f s", seconds);
    long whole = seconds < 1e9 ? (long)seconds : 1000000000;
    if (seconds < 3600)
        return fprintf(stderr, "%ld:%02ld min", whole / 60, whole % 60);
    return fprintf(stderr, "%ld:%02ld h", whole / 3600, whole / 60 % 60);
}

/* How far, how long still, how much memory; where the estimate has been reached, how far is not known. */
static int print_outlook(const struct progress *p, double time, int64_t triangles)
{
    double made = (double)(triangles - p->first), all = p->estimate - (double)p->first;
    double memory = resources_memory_used();
    int width = 0;
    if (made > 0 && made < all) {
        width = fprintf(stderr, ", %.0f%%, ", floor(100 * made / all));
        width += print_time((time - p->began) * (all - made) / made) + fprintf(stderr, " to go");
    }
    return memory > 0 ? width + fprintf(stderr, ", %.0f MB", 1e-6 * memory) : width;
}

static int print_step(const struct progress *p, double time, int round, int phase, double done, int64_t triangles)
{
    char where[64] = "pre-refinement";
    if (phase == PAR_NUMBERING)
        return fprintf(stderr, "%s: numbering", p->program);
    if (phase > 0)
        snprintf(where, sizeof where, "round %d, phase %d of 4", round + 1, phase);
    if (done > 0)
        return fprintf(stderr, "%s: refining: %s, %.0f%% of it, %" PRId64 " triangles before", p->program, where,
                       floor(100 * done), p->triangles) +
               print_outlook(p, p->at, p->triangles);
    int width = fprintf(stderr, "%s: refining: %s, %" PRId64 " triangles, %s/s", p->program, where, triangles,
                        tri_count_text(rate(p, time, triangles)).text);
    return phase > 0 ? width + print_outlook(p, time, triangles) : width;
}

/* The rest of a longer line that was there is covered with blanks. */
static void rewrite(struct progress *p, double time, int round, int phase, double done, int64_t triangles)
{
    fputc('\r', stderr);
    int width = print_step(p, time, round, phase, done, triangles);
    if (width < p->width)
        fprintf(stderr, "%*s", p->width - width, "");
    p->width = width;
    fflush(stderr);
}

/* Is it worth a line in a log? */
static bool is_news(const struct progress *p, double time, int round, int phase)
{
    return phase == 0 || phase == PAR_NUMBERING || round != p->round || time - p->told >= PROGRESS_LOG_SECONDS;
}

void progress_step(void *user, int round, int phase, double done, int64_t triangles)
{
    struct progress *p = user;
    double time = tri_seconds();
    if (done == 0) {
        p->at = time;
        p->triangles = triangles;
    }
    bool soon = time - p->told < SECONDS_BETWEEN_LINES && phase != PAR_NUMBERING;
    if (p->mode == PROGRESS_LINE && !soon) {
        rewrite(p, time, round, phase, done, triangles);
    } else if (p->mode == PROGRESS_LOG && is_news(p, time, round, phase)) {
        print_step(p, time, round, phase, done, triangles);
        fputc('\n', stderr);
    } else {
        return;
    }
    p->told = time;
    p->round = phase == 0 ? -1 : round;
    p->phase = phase;
}

void progress_end(struct progress *p, int64_t triangles, double numbering)
{
    double time = tri_seconds() - numbering;
    if (p->mode == PROGRESS_LINE && p->width > 0) {
        fprintf(stderr, "\r%*s\r", p->width, "");
        fflush(stderr);
        p->width = 0;
    } else if (p->mode == PROGRESS_LOG) {
        fprintf(stderr, "%s: refined to %" PRId64 " triangles in %.2f s, %s/s\n", p->program, triangles,
                time - p->began, tri_count_text(rate(p, time, triangles)).text);
    }
}
