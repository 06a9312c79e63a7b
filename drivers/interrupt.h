/* Ends the program early, after a signal or a time limit, without incomplete files.
 *
 * The first signal is a request: the main thread checks interrupt_stop() regularly and ends in an orderly way. If that
 * takes too long (a stage that must not stop half way, a slow disk), or if another signal arrives at least 0.8 seconds
 * later, the signal handler removes the temporary files and ends the program itself. Checkpoints written by then
 * remain. */
#ifndef DRIVERS_INTERRUPT_H
#define DRIVERS_INTERRUPT_H

#include <stdint.h>

#include "triangle/base/status.h"
#include "triangle/text/output.h"

enum { INTERRUPT_TIME_UP = 124 }; /* exit code after a time limit, the same as that of timeout(1) */

/* Installs the handlers; to be called once. From then on every signal that would end the program is handled as
 * described above, except SIGKILL and signals that the caller ignores. A signal for a crash first removes the temporary
 * files. If a file grows too large, or the reader of standard output has gone, write() returns an error instead of a
 * signal. program: name for messages. seconds: the time limit; 0: none. patience: time in seconds from the first
 * request until the handler ends the program, at least 0.8; HUGE_VAL: the handler does not end it. Returns false if the
 * system has no timer left. */
bool interrupt_start(const char *program, double seconds, double patience);

/* Returns true if a signal, the time limit or another task has requested the end. */
const struct tri_stop *interrupt_stop(void);

/* Returns true if the program must end as soon as no file is being opened or renamed. */
const struct tri_stop *interrupt_end(void);

/* Sets the current stage, such as "reading", for the message of the handler. The text must live as long as the
 * program. */
void interrupt_stage(const char *what);
const char *interrupt_stage_now(void);

/* Sets how far the stage has come, for the same message: about n of reached_what, such as " triangles". A smaller n
 * than before has no effect. The text must live as long as the program. Each stage begins at 0, which means unknown. */
void interrupt_reached(int64_t n, const char *what);
int64_t interrupt_reached_now(const char **what);

/* Sets the number of triangles in the checkpoint; 0: there is none yet. go_on: the command that resumes the run; it
 * must live as long as the program. Before the first call messages do not mention checkpoints. */
void interrupt_kept(int64_t triangles, const char *go_on);

/* Treats the time limit as over from now on. */
void interrupt_time_up(void);

/* Returns the statement about files for a stop without a mesh: "nothing was written". */
const char *interrupt_written(void);

/* Prints a line on standard error that says what is kept, if anything, and how to resume the run. */
void interrupt_print_kept(void);

/* Makes interrupt_stop() return false from now on, so that the remaining work is done in spite of the request. */
void interrupt_go_on(void);

/* The program reports the stop between these two calls. A handler that would end the program in between waits for the
 * second call, and a handler that ends it afterwards prints nothing. The second may be called alone. */
void interrupt_tell(void);
void interrupt_told(void);

/* If a run has several tasks, all end when one is asked to end. interrupt_stop() calls this function from time to time,
 * always on the thread that calls here, with the request to this task (0: none). The function returns the request to
 * use (0: none). NULL: there are no other tasks any more. */
void interrupt_pass_on(int (*pass_on)(void *user, int who), void *user);

/* Returns the exit code of a stopped program: 128 + the number of the signal, or INTERRUPT_TIME_UP; 0: no request. */
int interrupt_code(void);

/* Returns the cause of the stop: "SIGTERM", "the time limit", or "another task" if this task received no request. */
const char *interrupt_cause(void);

/* Begins an empty set of output files and guards it: handlers remove its files until it is committed or dropped. */
void interrupt_begin(struct tri_output_set *set);

/* Calls tri_output_open in the guarded set. Handlers wait meanwhile. */
enum tri_status interrupt_open(struct tri_output_set *set, const char *path, struct tri_output **output,
                               struct tri_error *error);

/* Commits the guarded set, or drops it. Handlers wait meanwhile. sync: wait until the files are on the disk. */
enum tri_status interrupt_commit(struct tri_output_set *set, bool sync, struct tri_error *error);
void interrupt_drop(struct tri_output_set *set);

#endif
