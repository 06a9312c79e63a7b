/* Ending early without leaving half of anything: what a signal that ends the program removes first. */
#ifndef DRIVERS_INTERRUPT_H
#define DRIVERS_INTERRUPT_H

#include "triangle/write.h"

/* From now on SIGINT, SIGTERM and SIGHUP (unless ignored already) remove the temporary files of the set, then end
 * the program as they would have; a file that grows too large and a reader of standard output that went away are
 * errors of write() rather than signals. The set lives as long as the program. */
void interrupt_guard(const struct tri_output_set *set);

/* Between these two the set is being changed: a signal waits. They do not nest. */
void interrupt_hold(void);
void interrupt_release(void);

/* Commits the guarded set, or aborts it where status is an error already, while signals wait. Returns what became of
 * it. */
enum tri_status interrupt_finish(struct tri_output_set *set, enum tri_status status, struct tri_error *error);

#endif
