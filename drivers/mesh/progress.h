/* How far the work is, on standard error: one line that is rewritten on a terminal, plain lines in the log of a batch
 * job. What has been told once is not taken back: numbers never become smaller, unless a sweep begins again as a whole
 * mesh, which is told. */
#ifndef DRIVERS_MESH_PROGRESS_H
#define DRIVERS_MESH_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

#include "drivers/mesh/long_options.h"
#include "sched/schedule/schedule.h"

enum progress_mode { PROGRESS_SILENT, PROGRESS_LINE, PROGRESS_LOG };

struct progress {
    enum progress_mode mode;
    const char *program;
    double began, told;   /* seconds of some clock: when refinement began, when the line was last written */
    int64_t first;        /* triangles when its phases began, or went on from a checkpoint */
    double estimate;      /* of them at the end */
    bool is_told, in_phases, was_swept; /* a place has been told; one of a phase; the last was of a sweep */
    bool has_sizes;       /* there was a schedule for sizes */
    struct par_place last; /* that was written */
    int64_t triangles;    /* the most that have been told */
    int width;            /* characters of the line on the terminal */
};

/* What is wanted, and whether standard error is a terminal, decide the mode. */
struct progress progress_start(const char *program, enum long_options_progress wanted, bool quiet);

/* A stage begins: a line in a log; nothing on a terminal, where standard output tells it. */
void progress_stage(struct progress *progress, const char *what);

/* Refinement begins, goes on, ends. step has the shape of par_options.progress, user is the struct; it may be called
 * as often as wanted: a terminal sees at most ten lines a second, a log one line for each round, and one for each
 * PROGRESS_LOG_SECONDS. estimate: triangles at the end; for percents and the time to go. numbering: seconds since begin
 * that do not count. A refinement that has been stopped, or has failed, is dropped instead. */
enum { PROGRESS_LOG_SECONDS = 30 };
void progress_begin(struct progress *progress, int64_t triangles, double estimate, int threads);
void progress_step(void *user, const struct par_place *place);
void progress_end(struct progress *progress, int64_t triangles, double numbering);
void progress_drop(struct progress *progress);

#endif
