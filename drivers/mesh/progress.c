/* INVARIANT: outside begin .. end the terminal shows no line of progress, so that other code may print. */
#include "drivers/mesh/progress.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "triangle/base/system.h"
#include "triangle/base/size_text.h"

static const double SECONDS_BETWEEN_LINES = 0.1;

struct progress progress_start(const char *program, enum long_options_progress wanted, bool quiet)
{
    bool terminal = tri_standard_is_terminal();
    struct progress progress = {.program = program, .mode = PROGRESS_SILENT};
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
    progress->first = progress->triangles = triangles;
    progress->estimate = estimate;
    if (progress->mode == PROGRESS_LOG)
        fprintf(stderr, "%s: refining %" PRId64 " triangles on %d thread%s\n", progress->program, triangles, threads,
                threads == 1 ? "" : "s");
}

/* Returns triangles per second. */
static double rate(const struct progress *progress, double time, int64_t triangles)
{
    double seconds = time - progress->began;
    return seconds > 0 ? (double)(triangles - progress->first) / seconds : 0;
}

/* Formats a time: 42 s, 12:07 min, 3:05 h. */
static int print_time(double seconds)
{
    if (seconds < 100)
        return fprintf(stderr, "%.0f s", seconds);
    long whole = seconds < 1e9 ? (long)seconds : 1000000000;
    if (seconds < 3600)
        return fprintf(stderr, "%ld:%02ld min", whole / 60, whole % 60);
    return fprintf(stderr, "%ld:%02ld h", whole / 3600, whole / 60 % 60);
}

/* Prints the remaining time and the memory. If the estimate has been reached, the remaining time is unknown. */
static int print_outlook(const struct progress *p, double time)
{
    const double made = (double)(p->triangles - p->first), left = p->estimate - (double)p->triangles;
    const double memory = tri_memory_used(NULL);
    int width = 0;
    if (made > 0 && left > 0) {
        width = fprintf(stderr, ", %.0f%%, ", floor(100 * (double)p->triangles / p->estimate));
        width += print_time((time - p->began) * left / made) + fprintf(stderr, " to go");
    }
    return memory > 0 ? width + fprintf(stderr, ", %.0f MB", 1e-6 * memory) : width;
}

static bool is_before_phases(const struct par_place *place) { return place->level > 0 || place->phase == 0; }

static void name_place(const struct progress *p, const struct par_place *place, char *text, size_t size)
{
    const char *what = !p->has_sizes ? "" : place->sizes ? "sizes, " : "angles, ";
    if (is_before_phases(place))
        snprintf(text, size, "pre-refinement");
    else if (place->n_columns > 0)
        snprintf(text, size, "column %d of %d", (int)place->column, (int)place->n_columns);
    else
        snprintf(text, size, "%sround %d, phase %d of %d", what, place->round + 1, place->phase, PAR_PHASES);
}

static int print_step(const struct progress *p, double time, const struct par_place *place)
{
    char where[64];
    if (place->phase == PAR_NUMBERING)
        return fprintf(stderr, "%s: numbering", p->program);
    name_place(p, place, where, sizeof where);
    int width = fprintf(stderr, "%s: refining: %s, %" PRId64 " triangles, %s/s", p->program, where, p->triangles,
                        tri_count_text(rate(p, time, p->triangles)).text);
    return is_before_phases(place) ? width : width + print_outlook(p, time);
}

/* Blanks cover the rest of a longer previous line. */
static void rewrite(struct progress *p, double time, const struct par_place *place)
{
    fputc('\r', stderr);
    int width = print_step(p, time, place);
    if (width < p->width)
        fprintf(stderr, "%*s", p->width - width, "");
    p->width = width;
    fflush(stderr);
}

/* Returns true if a log gets a line: for each round of a whole mesh, for the first place before or in the phases, for
 * the first column of a sweep, and every PROGRESS_LOG_SECONDS. */
static bool is_new_line(const struct progress *p, double time, const struct par_place *place)
{
    const struct par_place *last = &p->last;
    return !p->is_told || place->phase == PAR_NUMBERING || is_before_phases(place) != is_before_phases(last) ||
           place->sizes != last->sizes || place->round != last->round || place->n_columns != last->n_columns ||
           time - p->told >= PROGRESS_LOG_SECONDS;
}

void progress_drop(struct progress *p)
{
    if (p->mode == PROGRESS_LINE && p->width > 0)
        fprintf(stderr, "\r%*s\r", p->width, "");
    p->width = 0;
}

/* The sweep was abandoned, and its triangles are gone. */
static void begin_again(struct progress *p)
{
    progress_drop(p);
    if (p->mode != PROGRESS_SILENT)
        fprintf(stderr, "%s: the mesh cannot be swept: refining begins again, with the mesh as a whole\n", p->program);
    p->triangles = p->first;
}

/* A resumed run has not made the triangles of the checkpoint. */
static void note_place(struct progress *p, const struct par_place *place)
{
    if (!p->in_phases && !is_before_phases(place))
        p->first = place->triangles;
    p->in_phases = p->in_phases || !is_before_phases(place);
    if (p->was_swept && place->n_columns == 0)
        begin_again(p);
    p->was_swept = place->n_columns > 0;
    p->has_sizes = p->has_sizes || place->sizes;
    p->triangles = place->triangles > p->triangles ? place->triangles : p->triangles;
}

void progress_step(void *user, const struct par_place *place)
{
    struct progress *p = user;
    const double time = tri_seconds();
    note_place(p, place);
    const bool soon = time - p->told < SECONDS_BETWEEN_LINES && place->phase != PAR_NUMBERING;
    if (p->mode == PROGRESS_LINE && !soon) {
        rewrite(p, time, place);
    } else if (p->mode == PROGRESS_LOG && is_new_line(p, time, place)) {
        print_step(p, time, place);
        fputc('\n', stderr);
    } else {
        p->is_told = true;
        return;
    }
    p->is_told = true;
    p->told = time;
    p->last = *place;
}

void progress_end(struct progress *p, int64_t triangles, double numbering)
{
    double time = tri_seconds() - numbering;
    progress_drop(p);
    if (p->mode == PROGRESS_LOG)
        fprintf(stderr, "%s: refined to %" PRId64 " triangles in %.2f s, %s/s\n", p->program, triangles,
                time - p->began, tri_count_text(rate(p, time, triangles)).text);
}
