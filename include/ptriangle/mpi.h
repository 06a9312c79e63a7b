/* Makes a mesh on all ranks of an MPI communicator. Each rank receives a part of it. Library ptriangle-mpi.
 *
 * The mesh has the same triangles and numbers as that of par_mesh_new with the same figure and settings, for any number
 * of ranks and threads. Each rank receives consecutive tiles (ptriangle/tiles.h), column by column. The tiles of rank
 * 0, 1, and so on form the whole mesh. Each rank also holds a coarse mesh of the whole figure. */
#ifndef PTRIANGLE_MPI_H
#define PTRIANGLE_MPI_H

#include <mpi.h>

#include "ptriangle/tiles.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { /* kinds of messages between ranks */
    PAR_EXCHANGE_BORDERS,   /* ghost layers, lent to the rank that refines a block */
    PAR_EXCHANGE_BACK,      /* changed ghost layers, returned to their owner */
    PAR_EXCHANGE_LEFT_OVER, /* both, for blocks of later rounds, which refine the remaining bad triangles */
    PAR_EXCHANGE_NUMBERS,   /* numbers of vertices at borders of ranks */
    PAR_EXCHANGE_TILES,     /* tiles that another rank hands out; 0 in par_stream_on */
    PAR_EXCHANGE_INPUT,     /* the input that one rank has read; 0 in par_stream_on */
    PAR_EXCHANGES           /* the number of kinds */
};

struct par_exchanges { /* traffic that this rank has sent */
    int64_t bytes[PAR_EXCHANGES], messages[PAR_EXCHANGES]; /* for each kind */
};

/* Makes a mesh and hands it to the sinks of all ranks. Collective over comm: all ranks call it with the same figure and
 * settings, and each with its own sink. The begin function of each sink receives the ranges of numbers that each rank
 * owns (struct tri_stream). Then the sink receives the tiles of this rank, on the calling thread. The sink of rank 0
 * also receives the vertices from before refinement. Corners of triangles may be vertices of other ranks, which are not
 * part of any tile here: cells have global numbers, and there are no ghost points.
 *
 * All ranks return the same status. If it is not TRI_OK, they also return the same *error, from the lowest rank that
 * failed, and all tiles so far are invalid. If settings->stop returns true on one rank, all ranks stop. If the mesh is
 * small, or par_mesh_new would refine it sequentially, each rank makes the whole mesh, and rank 0 hands it out.
 *
 * TRI_BAD_INPUT on all ranks: the input of one rank is invalid; figures or bounds differ between ranks (size tests are
 * not compared); machines store numbers in different ways; comm is an intercommunicator.
 *
 * If MPI itself fails, and the error handler of comm returns, this rank returns TRI_INTERNAL. Other ranks may then wait
 * for ever, and pending requests of MPI may refer to freed memory. The only safe reaction is MPI_Abort.
 *
 * The caller must have initialised MPI, with at least MPI_THREAD_FUNNELED if there is more than one thread. Several
 * calls may run at the same time on different communicators if MPI provides MPI_THREAD_MULTIPLE. The call uses a
 * duplicate of comm, with the same error handler. Each message has fewer than 2^31 elements, for meshes of any size.
 * exchanges: receives the traffic of this rank; may be NULL. */
enum tri_status par_stream_on(MPI_Comm comm, const struct tri_figure *figure, const struct tri_settings *settings,
                              const struct tri_sink *sink, struct par_exchanges *exchanges, struct tri_error *error);

/* Returns the rank that owns a vertex, triangle or segment, or -1 if there is none with this number. first: the list
 * first_vertex, first_triangle or first_segment of struct tri_stream. O(log n_ranks). */
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
