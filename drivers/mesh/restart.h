/* --checkpoint and --resume: a long run that goes on after it was stopped or killed. */
#ifndef DRIVERS_MESH_RESTART_H
#define DRIVERS_MESH_RESTART_H

#include "drivers/mesh/arguments.h"
#include "drivers/mesh/long_options.h"
#include "sched/checkpoint/checkpoint.h"
#include "sched/ranks/carrier.h"

struct restart {
    bool wanted;
    bool follows; /* another task has opened it, and closes it */
    struct par_checkpoint checkpoint; /* open, if wanted */
    char *go_on;  /* the command that does; malloc'ed */
};

/* Opens what the options ask for. --checkpoint begins anew, --resume goes on; both with the same directory: goes on if
 * there is something to go on from. Of several tasks, for which this is collective, the first one opens it, and tells
 * what it keeps (interrupt_kept). carrier: NULL where there is one. TRI_BAD_INPUT and others of par_checkpoint_open. */
enum tri_status restart_open(struct restart *restart, const struct long_options *options, const char *program,
                             const struct arguments *arguments, struct par_carrier *carrier, struct tri_error *error);

/* The run is over. What is needed to go on stays after a stop, and after an error once there is a state, which then is
 * told (interrupt_tell_kept); after a stop it has been. */
void restart_close(struct restart *restart, int code);

#endif
