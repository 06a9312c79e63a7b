/* Ending early without leaving half of anything: what a signal that ends the program removes first. */
#ifndef DRIVERS_INTERRUPT_H
#define DRIVERS_INTERRUPT_H

#include "triangle/write.h"

/* Begins an empty set and guards it. From now on SIGINT, SIGTERM and SIGHUP (unless ignored already) remove the
 * temporary files of the set, then end the program as they would have; a file that grows too large and a reader of
 * standard output that went away are errors of write() rather than signals. The set lives as long as the program. */
void interrupt_begin(struct tri_output_set *set);

/* tri_output_open in the guarded set, while signals wait. */
enum tri_status interrupt_open(struct tri_output_set *set, const char *path, struct tri_output **output,
                               struct tri_error *error);

/* Commits the guarded set, or aborts it where status is an error already, while signals wait. Returns what became of
 * it. */
enum tri_status interrupt_finish(struct tri_output_set *set, enum tri_status status, struct tri_error *error);

#endif
