/* A figure meshed by several ranks, whatever lies between them: what ptriangle/mpi.h does, without MPI. */
#ifndef SCHED_RANKS_RANK_STREAM_H
#define SCHED_RANKS_RANK_STREAM_H

#include "ptriangle/tiles.h"
#include "sched/ranks/carrier.h"

/* Collective: as par_stream_on (ptriangle/mpi.h). */
enum tri_status par_stream_over(struct par_carrier *carrier, const struct tri_figure *figure,
                                const struct tri_settings *settings, const struct tri_sink *sink,
                                struct tri_error *error);

#endif
