/* The interface through which ranks communicate. It hides the transport: MPI, or threads of one process in tests.
 *
 * All ranks make the same collective calls in the same order. Each collective call begins with an agreement, in which
 * the ranks exchange their status. If a rank has failed, all ranks return its error from that agreement, and later
 * calls send nothing. A rank that has failed may therefore skip calls: all agreements are the same exchange, so its
 * next agreement matches any agreement of the others. An agreement synchronises all ranks. To save synchronisations, it
 * also carries a few numbers, and no transfer follows if there is no data to send. */
#ifndef SCHED_RANKS_CARRIER_H
#define SCHED_RANKS_CARRIER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "triangle/base/status.h"

/* A growing array of bytes. */
struct par_bytes {
    char *at; /* aligned as malloc does */
    size_t n, capacity;
};

/* The purposes of messages, for which traffic is counted separately. */
enum par_move {
    PAR_MOVE_BORDERS,
    PAR_MOVE_BACK,
    PAR_MOVE_LEFT_OVER,
    PAR_MOVE_NUMBERS,
    PAR_MOVE_TILES,
    PAR_MOVE_INPUT,
    PAR_MOVES
};

struct tri_figure;
struct tri_settings;
struct tri_sink;

struct par_traffic {
    int64_t bytes, messages; /* sent by this rank */
};

enum { PAR_FEW = 7, PAR_ROOM = PAR_FEW + 1 }; /* numbers that fit into an agreement; with the status */

struct par_carrier {
    int rank, n_ranks;
    void *self;
    int64_t *of_each;        /* [n_ranks * PAR_ROOM] receive buffer of agreements, which must not need new memory */
    /* Collective: all[n_ranks][n] receives the n numbers of each rank. */
    bool (*gather)(void *self, const int64_t *mine, int32_t n, int64_t *all);
    /* Collective: from[p] receives to[rank] of rank p. This function and those below are used only if n_ranks > 1. */
    bool (*deal)(void *self, const int64_t *to, int64_t *from);
    /* Sends out[p] to rank p and receives in[p].n bytes from rank p at in[p].at, for all p except this rank if n > 0,
     * in any order. Returns when all messages have been sent and received. False: the network has failed, and the run
     * cannot continue on any rank. */
    bool (*transfer)(void *self, const struct par_bytes *out, const struct par_bytes *in);
    /* Collective: copies the n bytes of rank 0 to all ranks (broadcast). */
    bool (*spread)(void *self, void *bytes, size_t n);
    /* Not collective; called by the thread that communicates. If `why` > 0, notifies all other ranks once that this
     * rank was asked to stop for this reason. Returns the reason received from another rank, or 0. NULL: the transport
     * has no such notification. */
    int (*pass_on)(void *self, int why);
    const struct tri_stop *stop; /* polled while the rank waits for others; or NULL */
    const double *share;     /* for tests: [n_ranks + 1] ascending from 0 to 1: rank p owns the fraction share[p] to
                                share[p + 1] of the odd columns; NULL: equal parts */
    bool ended;              /* the ranks have agreed on an error; later calls send nothing */
    bool lost;               /* the network failed on this rank; others may still wait, so the caller must end them */
    enum tri_status status;  /* the agreed error, or TRI_OK */
    struct par_traffic traffic[PAR_MOVES];
    double seconds_waiting;  /* spent in agreements, waiting for other ranks */
    double seconds_moving;   /* spent in transfers, after all ranks have agreed */
};

/* Returns a carrier for a single rank. room[PAR_ROOM] is borrowed and must outlive it. */
struct par_carrier par_carrier_alone(int64_t *room);

enum tri_status par_ranks_no_memory(struct tri_error *error);

bool par_bytes_reserve(struct par_bytes *bytes, size_t more);
bool par_bytes_add(struct par_bytes *bytes, const void *item, size_t n);
void par_bytes_free(struct par_bytes *bytes, int n); /* frees the contents of n arrays; bytes may be NULL */

/* Collective. Returns the error of the lowest rank that has one, with its text, or TRI_OK if all ranks succeeded. After
 * an error, later calls do not communicate and return the same status. */
enum tri_status par_agree(struct par_carrier *carrier, enum tri_status status, struct tri_error *error);

/* Collective: an agreement, then sends out[p] to rank p and receives in[p] from rank p. out[rank] is moved to in[rank].
 * Always frees `out`; the caller always frees `in`. If the network fails, both are left empty, and buffers that the
 * network may still access are not freed. */
enum tri_status par_swap(struct par_carrier *carrier, enum par_move move, struct par_bytes *out, struct par_bytes *in,
                         enum tri_status status, struct tri_error *error);

/* Collective: an agreement, then copies the n bytes of rank 0 to all ranks. n is the same on all ranks. Rank 0 counts
 * the bytes as sent to each of the others. */
enum tri_status par_spread(struct par_carrier *carrier, enum par_move move, void *bytes, size_t n,
                           enum tri_status status, struct tri_error *error);

/* Collective: an agreement, and all[n_ranks][n] receives the n numbers of each rank. If n <= PAR_FEW, `all` may be
 * carrier->of_each. */
enum tri_status par_gather(struct par_carrier *carrier, const int64_t *mine, int32_t n, int64_t *all,
                           enum tri_status status, struct tri_error *error);

/* Collective: an agreement, then returns TRI_BAD_INPUT with the message `words` on all ranks unless `number` is the
 * same on all of them. */
enum tri_status par_expect_same(struct par_carrier *carrier, uint64_t number, const char *words, enum tri_status status,
                                struct tri_error *error);

/* Collective: an agreement, then sets sum[i] to the sum of value[i] over all ranks. */
enum tri_status par_sum(struct par_carrier *carrier, const int64_t *value, int32_t n, int64_t *sum,
                        enum tri_status status, struct tri_error *error);

/* --- mpi.c: a carrier over an MPI communicator; this header does not need mpi.h */

/* Collective. Sets *carrier to a new carrier over a duplicate of the MPI_Comm at `comm`. par_mpi_carrier_free frees
 * both. All ranks return the same status: TRI_NO_MEMORY if memory runs out on one rank; TRI_BAD_INPUT if `comm` is an
 * intercommunicator, or if the machines store numbers differently. */
enum tri_status par_mpi_carrier_new(struct par_carrier **carrier, const void *comm, struct tri_error *error);

/* Collective. Call it after the same exchanges on all ranks, whether or not they succeeded. Does nothing if the network
 * has failed. */
void par_mpi_carrier_free(struct par_carrier *carrier);

/* --- sched/schedule/library.c */

/* Collective: as par_stream_on (ptriangle/mpi.h), for ranks of any carrier. */
enum tri_status par_stream_over(struct par_carrier *carrier, const struct tri_figure *figure,
                                const struct tri_settings *settings, const struct tri_sink *sink,
                                struct tri_error *error);

#endif
