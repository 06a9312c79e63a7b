/* Tasks that are ranks of an MPI. */
#include <mpi.h>

#include "drivers/launch.h"
#include "sched/ranks/mpi_carrier.h"

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
    launch->carrier = par_mpi_carrier_new(&world);
    if (launch->carrier)
        return TRI_OK;
    MPI_Finalize();
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the other tasks");
}

void launch_end(struct launch *launch)
{
    par_mpi_carrier_free(launch->carrier);
    MPI_Finalize();
}
