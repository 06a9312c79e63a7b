/* A build without MPI: one task. */
#include "drivers/mesh/launch.h"

enum tri_status launch_ranks(struct launch *launch, int tasks, struct tri_error *error)
{
    (void)launch;
    return tri_fail(error, TRI_BAD_INPUT, NULL, 0,
                    "started as %d tasks, but built without MPI: start one, with --threads", tasks);
}

void launch_end(struct launch *launch) { (void)launch; }
