/* How far the work is, on standard error: one line that is rewritten on a terminal, plain lines in the log of a batch
 * job. */
#ifndef DRIVERS_PROGRESS_H
#define DRIVERS_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

#include "drivers/long_options.h"

enum progress_mode { PROGRESS_SILENT, PROGRESS_LINE, PROGRESS_LOG };

struct progress {
    enum progress_mode mode;
    const char *program;
    double began, told;   /* seconds of some clock: when refinement began, when the line was last written */
    int64_t first;        /* triangles when refinement began */
    double estimate;      /* of them at the end */
    int round, phase;     /* last ones told */
    double at;            /* when the phase began, */
    int64_t triangles;    /* and with so many */
    int width;            /* characters of the line on the terminal */
};

/* What is wanted, and whether standard error is a terminal, decide the mode. */
struct progress progress_start(const char *program, enum long_options_progress wanted, bool quiet);

/* A stage begins: a line in a log; nothing on a terminal, where standard output tells it. */
void progress_stage(struct progress *progress, const char *what);

/* Refinement begins, goes on, ends. step has the shape of par_options.progress, user is the struct; it may be called
 * as often as wanted: a terminal sees at most ten lines a second, a log one line for each round, and one for each
 * PROGRESS_LOG_SECONDS. estimate: triangles at the end; for percents and the time to go. numbering: seconds since begin
 * that do not count. */
enum { PROGRESS_LOG_SECONDS = 30 };
void progress_begin(struct progress *progress, int64_t triangles, double estimate, int threads);
void progress_step(void *user, int round, int phase, double done, int64_t triangles);
void progress_end(struct progress *progress, int64_t triangles, double numbering);

#endif
