/* A carrier over a communicator of MPI, for those who know one; nothing here asks for MPI's header. */
#ifndef SCHED_RANKS_MPI_CARRIER_H
#define SCHED_RANKS_MPI_CARRIER_H

#include "sched/ranks/carrier.h"

/* comm points to an MPI_Comm, which is duplicated. Collective. NULL: no memory, or no communicator. */
struct par_carrier *par_mpi_carrier_new(const void *comm);

/* Collective. */
void par_mpi_carrier_free(struct par_carrier *carrier);

#endif
