/* How ranks speak with each other: what a rank sees of the others, whatever lies between (threads of one process for
 * tests, MPI).
 *
 * All ranks make the same calls in the same order. Each exchange begins with an agreement: where a rank has failed, all
 * learn it there, return the same error, and nobody waits for anything afterwards. So who has failed may leave calls
 * out: all agreements are the same exchange, whatever begins with them. Whoever comes first waits for the last in each:
 * so a few numbers go with them, and nothing follows where there is nothing to send. */
#ifndef SCHED_RANKS_CARRIER_H
#define SCHED_RANKS_CARRIER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "triangle/base/status.h"

/* Bytes that grow. */
struct par_bytes {
    char *at; /* aligned as malloc does */
    size_t n, capacity;
};

/* What moves for what reason. */
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

enum { PAR_FEW = 7, PAR_ROOM = PAR_FEW + 1 }; /* so many numbers go with an agreement, which itself is one */

struct par_carrier {
    int rank, n_ranks;
    void *self;
    int64_t *of_each;        /* [n_ranks * PAR_ROOM] for agreements: these must not fail for want of memory */
    /* Collective: all[n_ranks][n] receives everybody's n numbers. */
    bool (*gather)(void *self, const int64_t *mine, int32_t n, int64_t *all);
    /* Collective: from[p] receives what rank p has in to[rank]. This and what follows: of several ranks alone. */
    bool (*deal)(void *self, const int64_t *to, int64_t *from);
    /* Sends out[p] to rank p and fills in[p].n bytes at in[p].at from there, for all p but the own rank where n > 0, in
     * any order. Returns when everything has gone and come. False: the network has failed, which nobody may survive. */
    bool (*transfer)(void *self, const struct par_bytes *out, const struct par_bytes *in);
    /* Collective: the n bytes of all become those of rank 0. */
    bool (*spread)(void *self, void *bytes, size_t n);
    /* Not collective, by the thread that exchanges: tells all others, once, that this rank has been asked to end, by
     * `why` > 0. Returns what another has told, or 0. NULL: there is no such way. */
    int (*pass_on)(void *self, int why);
    const struct tri_stop *stop; /* asked while the rank waits for others, and has nothing else to do; or NULL */
    const double *share;     /* for tests: [n_ranks + 1] ascending from 0 to 1: rank p owns the part share[p] to
                                share[p + 1] of the odd columns; NULL: equal parts */
    bool ended;              /* the ranks have agreed on an error: nothing is sent any more */
    bool lost;               /* .. or this one cannot reach the others, which may wait for it: somebody must end them */
    enum tri_status status;  /* that error */
    struct par_traffic traffic[PAR_MOVES];
    double seconds_waiting;  /* for each other, in agreements */
    double seconds_moving;   /* what is sent and comes, once all are ready for it */
};

/* A rank that is alone, with nobody to wait for. room[PAR_ROOM] lives as long. */
struct par_carrier par_carrier_alone(int64_t *room);

enum tri_status par_ranks_no_memory(struct tri_error *error);

bool par_bytes_reserve(struct par_bytes *bytes, size_t more);
bool par_bytes_add(struct par_bytes *bytes, const void *item, size_t n);
void par_bytes_free(struct par_bytes *bytes, int n); /* what each of n holds; NULL: there is none */

/* Collective: the error of the lowest rank that has one, with its text; TRI_OK where nobody has. After that no call
 * speaks with anybody: it returns the same status. */
enum tri_status par_agree(struct par_carrier *carrier, enum tri_status status, struct tri_error *error);

/* Collective: an agreement, then out[p] goes to rank p, and in[p] becomes what comes from there; what goes to the own
 * rank is in[rank] afterwards. Frees `out` in any case; `in` is the caller's to free, in any case.
 * Where the network fails both are empty then: what it may still read or write is left to it. */
enum tri_status par_swap(struct par_carrier *carrier, enum par_move move, struct par_bytes *out, struct par_bytes *in,
                         enum tri_status status, struct tri_error *error);

/* Collective: an agreement, then the n bytes of all, as many on each, become those of rank 0, which counts them as sent
 * to each. */
enum tri_status par_spread(struct par_carrier *carrier, enum par_move move, void *bytes, size_t n,
                           enum tri_status status, struct tri_error *error);

/* Collective: an agreement, and all[n_ranks][n] receives everybody's n numbers; for a few, it may be of_each. */
enum tri_status par_gather(struct par_carrier *carrier, const int64_t *mine, int32_t n, int64_t *all,
                           enum tri_status status, struct tri_error *error);

/* Collective: an agreement, then TRI_BAD_INPUT on all ranks, by these words, unless all come with the same number. */
enum tri_status par_expect_same(struct par_carrier *carrier, uint64_t number, const char *words, enum tri_status status,
                                struct tri_error *error);

/* Collective: an agreement, then sum[i] becomes the sum of value[i] over all ranks. */
enum tri_status par_sum(struct par_carrier *carrier, const int64_t *value, int32_t n, int64_t *sum,
                        enum tri_status status, struct tri_error *error);

/* --- mpi.c: over a communicator of MPI, for callers that know one; nothing here asks for MPI's header */

/* Collective. *carrier: the ranks of a copy of the MPI_Comm at `comm`; par_mpi_carrier_free frees both. All ranks
 * return the same status: TRI_NO_MEMORY, if one of them has none; TRI_BAD_INPUT, if they are not of one group, or their
 * machines store numbers in different ways. */
enum tri_status par_mpi_carrier_new(struct par_carrier **carrier, const void *comm, struct tri_error *error);

/* Collective, after the same exchanges on all ranks, whatever came of them. Where the network has failed nothing
 * happens. */
void par_mpi_carrier_free(struct par_carrier *carrier);

/* --- sched/schedule/library.c */

/* Collective: as par_stream_on (ptriangle/mpi.h), for ranks of any carrier. */
enum tri_status par_stream_over(struct par_carrier *carrier, const struct tri_figure *figure,
                                const struct tri_settings *settings, const struct tri_sink *sink,
                                struct tri_error *error);

#endif
