/* Ending early, by a signal or a time limit, without leaving half of anything.
 *
 * The first signal asks: whoever works looks at interrupt_stop() and comes to an end that it can tell about. If that
 * takes too long (a stage that must not stop half way, a slow disk), or if another signal comes 0.8 seconds later or
 * more, the handler removes the temporary files and ends the program itself. What a checkpoint keeps by then stays. */
#ifndef DRIVERS_INTERRUPT_H
#define DRIVERS_INTERRUPT_H

#include <stdint.h>

#include "triangle/base/status.h"
#include "triangle/text/output.h"

enum { INTERRUPT_TIME_UP = 124 }; /* exit code after a time limit, as that of timeout(1) */

/* From now on every signal that would end the program (but those that its caller has it ignore, and SIGKILL) is taken
 * as said above; one that tells of a crash removes the temporary files first; a file that grows too large and a reader
 * of standard output that went away are errors of write() rather than signals. To be called once.
 * program: for messages. seconds: the time limit; 0: none. patience: seconds, from the first request, after which the
 * handler ends the program, 0.8 at least; HUGE_VAL: it does not. False: the system has no timer left. */
bool interrupt_start(const char *program, double seconds, double patience);

/* Has somebody asked for the end? */
const struct tri_stop *interrupt_stop(void);

/* Is the program to end as soon as files are no longer being opened or named? */
const struct tri_stop *interrupt_end(void);

/* What is done now, for the message of the handler: "reading". The text lives as long as the program. */
void interrupt_stage(const char *what);
const char *interrupt_stage_now(void);

/* How far the stage is, for that message: about n of these: " triangles"; less than was told before changes nothing.
 * The text lives as long as the program. The next stage begins at 0, which is what is not known. */
void interrupt_reached(int64_t n, const char *what);
int64_t interrupt_reached_now(const char **what);

/* A checkpoint keeps so many triangles; 0: there is none yet. go_on: the command that goes on, which lives as long as
 * the program. Until this is called nothing is said of checkpoints. */
void interrupt_kept(int64_t triangles, const char *go_on);

/* From now on the limit of time counts as over. */
void interrupt_time_up(void);

/* What a stop without a mesh says of files: "nothing was written". */
const char *interrupt_written(void);

/* A line on standard error that tells what is kept, if anything is, and how to go on. */
void interrupt_tell_kept(void);

/* From now on interrupt_stop() says no, though somebody has asked: what is left is to be done. */
void interrupt_go_on(void);

/* The program tells of the stop itself between these two: a handler that would end it meanwhile lets it, and one that
 * ends it afterwards is silent. The second may be called alone. */
void interrupt_tell(void);
void interrupt_told(void);

/* Where a run is several tasks, all end when one is asked to: interrupt_stop() calls this now and then, on no thread
 * but the one that calls here, with who has asked this task (0: nobody), and takes for a request what it returns (0:
 * none). NULL: there are no others any more. */
void interrupt_pass_on(int (*pass_on)(void *user, int who), void *user);

/* The exit code for whoever was stopped: 128 + number of the signal, or INTERRUPT_TIME_UP; 0: nobody has asked. */
int interrupt_code(void);

/* What has asked: "SIGTERM", "the time limit"; "another task", where nobody has asked this one. */
const char *interrupt_cause(void);

/* Begins an empty set and guards it; its names are known to the handlers until it is committed or dropped. */
void interrupt_begin(struct tri_output_set *set);

/* tri_output_open in the guarded set, while handlers wait. */
enum tri_status interrupt_open(struct tri_output_set *set, const char *path, struct tri_output **output,
                               struct tri_error *error);

/* Commits the guarded set, or aborts it, while handlers wait; sync: once its files are on the disk. */
enum tri_status interrupt_commit(struct tri_output_set *set, bool sync, struct tri_error *error);
void interrupt_drop(struct tri_output_set *set);

#endif
