/* Preloaded into a rank: MPI_Testall returns an error from the PTRIANGLE_LOST_AT-th call on. */
#include <mpi.h>
#include <stdlib.h>

int MPI_Testall(int count, MPI_Request requests[], int *flag, MPI_Status statuses[])
{
    static long n_probes; /* number of calls; only one thread of a rank communicates */
    const char *at = getenv("PTRIANGLE_LOST_AT");
    if (at && ++n_probes >= atol(at))
        return MPI_ERR_OTHER;
    return PMPI_Testall(count, requests, flag, statuses);
}
