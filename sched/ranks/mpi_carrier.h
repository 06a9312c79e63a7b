/* A carrier over a communicator of MPI, for those who know one; nothing here asks for MPI's header. */
#ifndef SCHED_RANKS_MPI_CARRIER_H
#define SCHED_RANKS_MPI_CARRIER_H

#include "sched/ranks/carrier.h"

/* Collective. *carrier: the ranks of a copy of the MPI_Comm at `comm`; par_mpi_carrier_free frees both. All ranks
 * return the same status: TRI_NO_MEMORY, if one of them has none; TRI_BAD_INPUT, if they are not of one group, or their
 * machines store numbers in different ways. */
enum tri_status par_mpi_carrier_new(struct par_carrier **carrier, const void *comm, struct tri_error *error);

/* Collective, after the same exchanges on all ranks, whatever came of them. Where the network has failed nothing
 * happens. */
void par_mpi_carrier_free(struct par_carrier *carrier);

#endif
