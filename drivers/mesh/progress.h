/* Reports progress on standard error: one line that is rewritten on a terminal, or plain lines in a log. Printed
 * numbers never decrease. The exception is a sweep that starts again as a whole mesh, which is reported. */
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
    double began, told;   /* seconds of a clock: when refinement began, and when the line was last printed */
    int64_t first;        /* triangles when the phases began, or when the run was resumed from a checkpoint */
    double estimate;      /* estimated number of triangles at the end */
    bool is_told, in_phases, was_swept; /* a place was printed; it was in a phase; the last one was in a sweep */
    bool has_sizes;       /* there was a schedule for sizes */
    struct par_place last; /* the last place that was printed */
    int64_t triangles;    /* largest number of triangles that was printed */
    int width;            /* characters of the line on the terminal */
};

/* Selects the mode by the options, and by whether standard error is a terminal. */
struct progress progress_start(const char *program, enum long_options_progress wanted, bool quiet);

/* Reports the begin of a stage: a line in a log. A terminal shows nothing, because standard output already names the
 * stage. */
void progress_stage(struct progress *progress, const char *what);

/* Report the begin, the progress and the end of refinement. step has the type of par_options.progress, with the struct
 * as user. It may be called any number of times: a terminal shows at most ten lines a second, a log one line for each
 * round, and one every PROGRESS_LOG_SECONDS. estimate: triangles at the end, for percentages and the remaining time.
 * numbering: seconds since begin to leave out. progress_drop replaces progress_end if refinement was stopped or has
 * failed. */
enum { PROGRESS_LOG_SECONDS = 30 };
void progress_begin(struct progress *progress, int64_t triangles, double estimate, int threads);
void progress_step(void *user, const struct par_place *place);
void progress_end(struct progress *progress, int64_t triangles, double numbering);
void progress_drop(struct progress *progress);

#endif
