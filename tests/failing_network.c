/* Preloaded into a rank: its MPI fails at the PTRIANGLE_LOST_AT-th look whether something has come, as where the error
 * handler returns. */
#include <mpi.h>
#include <stdlib.h>

int MPI_Testall(int count, MPI_Request requests[], int *flag, MPI_Status statuses[])
{
    static long looks; /* one thread of a rank speaks with others */
    const char *at = getenv("PTRIANGLE_LOST_AT");
    if (at && ++looks >= atol(at))
        return MPI_ERR_OTHER;
    return PMPI_Testall(count, requests, flag, statuses);
}
