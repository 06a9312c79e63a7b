/* --checkpoint and --resume: continues a long run after it was stopped or killed. */
#ifndef DRIVERS_MESH_RESTART_H
#define DRIVERS_MESH_RESTART_H

#include "drivers/mesh/arguments.h"
#include "drivers/mesh/long_options.h"
#include "sched/checkpoint/checkpoint.h"
#include "sched/ranks/carrier.h"

struct restart {
    bool wanted;
    bool follows; /* another task opens and closes the checkpoint */
    struct par_checkpoint checkpoint; /* open if `wanted` */
    char *go_on;  /* command that resumes the run; malloc'ed */
};

/* Opens the checkpoint folder of the options. --checkpoint starts a new run, --resume continues one. Both with the same
 * folder continue if it has a checkpoint, and otherwise start a new run. Collective if there are several tasks: the
 * first one opens the folder and reports what it keeps (interrupt_kept). carrier: NULL for a single task.
 * TRI_BAD_INPUT, and other errors of par_checkpoint_open. */
enum tri_status restart_open(struct restart *restart, const struct long_options *options, const char *program,
                             const struct arguments *arguments, struct par_carrier *carrier, struct tri_error *error);

/* Closes the checkpoint at the end of the run. Its files stay after a stop, and after an error if there is a state.
 * After an error this is reported here (interrupt_print_kept); after a stop it has been reported already. */
void restart_close(struct restart *restart, int code);

#endif
