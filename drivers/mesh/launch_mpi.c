/* Tasks that are ranks of an MPI. */
#include <mpi.h>
#include <stdlib.h>

#include "drivers/interrupt.h"
#include "drivers/mesh/launch.h"
#include "sched/ranks/carrier.h"

enum tri_status launch_ranks(struct launch *launch, int tasks, struct tri_error *error)
{
    int provided, n_ranks;
    MPI_Comm world = MPI_COMM_WORLD;
    MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_size(world, &n_ranks);
    MPI_Comm_rank(world, &launch->rank);
    if (n_ranks != tasks) {
        MPI_Finalize();
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0,
                        "started as %d tasks, which do not find each other: this program is built for another MPI than "
                        "that of the launcher", tasks);
    }
    enum tri_status status = par_mpi_carrier_new(&launch->carrier, &world, error);
    if (status) {
        MPI_Finalize();
        return status;
    }
    launch->carrier->stop = interrupt_stop();
    interrupt_pass_on(launch->carrier->pass_on, launch->carrier->self);
    return TRI_OK;
}

void launch_end(struct launch *launch)
{
    interrupt_pass_on(NULL, NULL);
    if (launch->carrier->lost) /* the others wait */
        MPI_Abort(MPI_COMM_WORLD, EXIT_FAILURE);
    par_mpi_carrier_free(launch->carrier);
    MPI_Finalize();
}
