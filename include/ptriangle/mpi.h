/* A mesh made by all ranks of an MPI, each of which gets a part of it: the library ptriangle-mpi.
 *
 * The mesh is that of par_mesh_new with the same figure and settings, triangle by triangle and number by number,
 * whatever the number of ranks and of their threads. Rank p gets a column of tiles after the other (ptriangle/tiles.h),
 * those of all ranks side by side being the whole. Beside its part each rank holds a coarse mesh of all. */
#ifndef PTRIANGLE_MPI_H
#define PTRIANGLE_MPI_H

#include <mpi.h>

#include "ptriangle/tiles.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { /* why something moves */
    PAR_EXCHANGE_BORDERS,   /* what blocks at the borders of ranks borrow .. */
    PAR_EXCHANGE_BACK,      /* .. and back */
    PAR_EXCHANGE_LEFT_OVER, /* both, for what small blocks have left over */
    PAR_EXCHANGE_NUMBERS,   /* numbers of vertices at borders */
    PAR_EXCHANGE_TILES,     /* tiles that another rank takes; 0 here */
    PAR_EXCHANGE_INPUT,     /* the input that one rank has read; 0 here */
    PAR_EXCHANGES
};

struct par_exchanges { /* sent by this rank */
    int64_t bytes[PAR_EXCHANGES], messages[PAR_EXCHANGES];
};

/* Collective over comm: all its ranks call with the same figure and settings, and each with a sink of its own. Each
 * sink is told first who owns which numbers (struct tri_stream); then it takes this rank's tiles, from the calling
 * thread; that of rank 0 also the vertices that there were before. Corners may be vertices of other ranks, which come
 * with no tile here: cells with global numbers, points without ghosts.
 *
 * All ranks return the same status, and where it is not TRI_OK the same *error: that of the lowest rank that failed.
 * Tiles that have been taken are worth nothing then. settings->stop, where one rank's says true, stops all. In
 * settings that par_mesh_new refines as one sequential call, and for a small mesh, each rank makes the whole mesh, and
 * rank 0 hands it out.
 *
 * Where MPI itself fails, and the error handler of comm returns, this rank returns TRI_INTERNAL. The others may wait
 * for it for ever, and requests that MPI does not let go of may be pending on memory that has gone: MPI_Abort is all
 * that is safe then.
 *
 * TRI_BAD_INPUT on all ranks: what one has been given is wrong; they do not begin with the same figure and bounds
 * (size tests are not compared); machines that store numbers in different ways; an intercommunicator. Several calls at
 * a time, on communicators of their own, are fine where MPI allows that to threads (MPI_THREAD_MULTIPLE).
 *
 * MPI must run, with MPI_THREAD_FUNNELED where there is more than one thread. comm is duplicated for the time of the
 * call; the copy has its error handler. Counts of messages stay below 2^31 however much is sent. exchanges: NULL where
 * nobody asks. */
enum tri_status par_stream_on(MPI_Comm comm, const struct tri_figure *figure, const struct tri_settings *settings,
                              const struct tri_sink *sink, struct par_exchanges *exchanges, struct tri_error *error);

/* The rank that owns a vertex (triangle, segment), by a list first[n_ranks + 1] of struct tri_stream; -1: nobody, there
 * is none of that number. O(log n_ranks). */
static inline int32_t par_rank_of(const int64_t *first, int32_t n_ranks, int64_t number)
{
    int32_t low = 0, high = n_ranks;
    while (high - low > 1) {
        int32_t middle = low + (high - low) / 2;
        if (first[middle] <= number)
            low = middle;
        else
            high = middle;
    }
    return first[low] <= number && number < first[low + 1] ? low : -1;
}

#ifdef __cplusplus
}
#endif

#endif
