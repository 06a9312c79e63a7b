/* A carrier over MPI. No other file of this folder uses MPI. All calls use a duplicate of the caller's communicator,
 * and none uses MPI_COMM_WORLD. */
#include "ptriangle/mpi.h"

#include <stdlib.h>
#include <string.h>

#include "sched/ranks/carrier.h"
#include "sched/tunables.h"
#include "triangle/base/system.h"

/* Maximum size of one MPI message, whose size is an int. */
enum { MOST_BYTES = 1 << 30 };

enum { TAG_BYTES, TAG_STOP }; /* tags of messages: data; a request to stop */

struct messenger {
    struct par_carrier carrier; /* must be first: par_mpi_carrier_new returns its address */
    MPI_Comm comm;              /* the duplicate of the caller's communicator */
    MPI_Request *request;       /* [2 * n_ranks] requests of the transfer in progress */
    MPI_Status *state;          /* [2 * n_ranks] their statuses, which are not read */
    int32_t why;                /* reason to stop that this rank has sent to all others; 0: none */
    MPI_Request *telling;       /* [n_ranks] requests of these messages */
    int heard;                  /* number of messages with TAG_STOP received from other ranks */
};

/* Waits for n requests. Sleeps between tests, because there may be more ranks than cores, and a rank that spins would
 * slow down the ranks for which it waits. False: MPI has failed. */
static bool wait_for(const struct messenger *m, MPI_Request *request, int n)
{
    double nap = 1e-9 * PAR_FIRST_NAP;
    int done = 0;
    while (MPI_Testall(n, request, &done, m->state) == MPI_SUCCESS && !done) {
        (void)tri_stop_is_asked(m->carrier.stop); /* may call pass_on, so that the other ranks stop, too */
        (void)tri_pause(nap);
        nap = nap < 1e-9 * PAR_LONGEST_NAP ? 2 * nap : nap;
    }
    return done;
}

/* --- the functions of struct par_carrier */

static bool gather(void *self, const int64_t *mine, int32_t n, int64_t *all)
{
    const struct messenger *m = self;
    MPI_Request request;
    return MPI_Iallgather(mine, n, MPI_INT64_T, all, n, MPI_INT64_T, m->comm, &request) == MPI_SUCCESS &&
           wait_for(m, &request, 1);
}

static bool deal(void *self, const int64_t *to, int64_t *from)
{
    const struct messenger *m = self;
    MPI_Request request;
    return MPI_Ialltoall(to, 1, MPI_INT64_T, from, 1, MPI_INT64_T, m->comm, &request) == MPI_SUCCESS &&
           wait_for(m, &request, 1);
}

/* Returns the size of the batch that begins at byte `at` of a message of n bytes; 0 if the message ends before. */
static int batch_of(size_t n, size_t at)
{
    size_t left = at < n ? n - at : 0;
    return (int)(left < MOST_BYTES ? left : MOST_BYTES);
}

/* Sends and receives the batches of all messages that begin at byte `at`. All requests are posted before the rank
 * waits, so it never waits for one rank before it receives from another. Each rank begins with a different partner. */
static bool exchange(const struct messenger *m, const struct par_bytes *out, const struct par_bytes *in, size_t at)
{
    int rank = m->carrier.rank, n = m->carrier.n_ranks, posted = 0;
    bool good = true;
    for (int k = 1; good && k < n; k++) {
        int p = (rank - k + n) % n;
        if (at < in[p].n)
            good = MPI_Irecv(in[p].at + at, batch_of(in[p].n, at), MPI_BYTE, p, TAG_BYTES, m->comm,
                             &m->request[posted++]) == MPI_SUCCESS;
    }
    for (int k = 1; good && k < n; k++) {
        int p = (rank + k) % n;
        if (at < out[p].n)
            good = MPI_Isend(out[p].at + at, batch_of(out[p].n, at), MPI_BYTE, p, TAG_BYTES, m->comm,
                             &m->request[posted++]) == MPI_SUCCESS;
    }
    return good && wait_for(m, m->request, posted);
}

static bool transfer(void *self, const struct par_bytes *out, const struct par_bytes *in)
{
    const struct messenger *m = self;
    size_t most = 0;
    bool good = true;
    for (int p = 0; p < m->carrier.n_ranks; p++) {
        size_t n = p == m->carrier.rank ? 0 : in[p].n > out[p].n ? in[p].n : out[p].n;
        most = n > most ? n : most;
    }
    for (size_t at = 0; good && at < most; at += MOST_BYTES)
        good = exchange(m, out, in, at);
    return good;
}

static bool spread(void *self, void *bytes, size_t n)
{
    const struct messenger *m = self;
    bool good = true;
    for (size_t at = 0; good && at < n; at += MOST_BYTES) {
        MPI_Request request;
        good = MPI_Ibcast((char *)bytes + at, batch_of(n, at), MPI_BYTE, 0, m->comm, &request) == MPI_SUCCESS &&
               wait_for(m, &request, 1);
    }
    return good;
}

/* --- requests to stop */

/* Sends the reason to all other ranks. Not collective. */
static void send_reason(struct messenger *m, int why)
{
    m->why = why;
    for (int p = 0; p < m->carrier.n_ranks; p++)
        if (p != m->carrier.rank)
            MPI_Isend(&m->why, 1, MPI_INT32_T, p, TAG_STOP, m->comm, &m->telling[p]);
}

/* Receives a reason. Not collective. */
static int receive_reason(struct messenger *m, int from)
{
    int32_t why = 0;
    MPI_Recv(&why, 1, MPI_INT32_T, from, TAG_STOP, m->comm, MPI_STATUS_IGNORE);
    m->heard++;
    return why;
}

static int pass_on(void *self, int why)
{
    struct messenger *m = self;
    MPI_Status status;
    int there = 0;
    if (why != 0 && m->why == 0 && m->heard == 0) /* a rank that has notified this one has notified all others */
        send_reason(m, why);
    if (MPI_Iprobe(MPI_ANY_SOURCE, TAG_STOP, m->comm, &there, &status) != MPI_SUCCESS || !there)
        return 0;
    return receive_reason(m, status.MPI_SOURCE);
}

/* Collective: receives all messages with TAG_STOP that are still under way. */
static void hear_all(struct messenger *m)
{
    int tells = m->why != 0, all = 0;
    if (MPI_Allreduce(&tells, &all, 1, MPI_INT, MPI_SUM, m->comm) != MPI_SUCCESS)
        return;
    while (m->heard < all - tells)
        receive_reason(m, MPI_ANY_SOURCE);
    for (int p = 0; p < m->carrier.n_ranks; p++)
        MPI_Wait(&m->telling[p], MPI_STATUS_IGNORE);
}

/* --- beginning and end */

static bool is_running(void)
{
    int begun = 0, ended = 0;
    MPI_Initialized(&begun);
    MPI_Finalized(&ended);
    return begun && !ended;
}

/* Copies this rank's traffic counters to the caller's struct, unless that is NULL. */
static void copy_traffic(const struct par_carrier *carrier, struct par_exchanges *exchanges)
{
    _Static_assert((int)PAR_MOVES == (int)PAR_EXCHANGES, "mpi.h has a counter for each purpose of messages");
    for (int k = 0; exchanges && k < PAR_EXCHANGES; k++) {
        exchanges->bytes[k] = carrier->traffic[k].bytes;
        exchanges->messages[k] = carrier->traffic[k].messages;
    }
}

/* Returns a hash of how this machine represents numbers. Messages contain numbers as they are in memory, so it must be
 * equal on all ranks. The hash itself is sent as an MPI_INT64_T, which MPI converts if machines differ. */
static int64_t layout(void)
{
    const struct {
        double real;
        int64_t whole;
        int32_t sizes[4];
    } probe = {1.0 / 3, INT64_C(0x0102030405060708),
               {sizeof(size_t), sizeof(bool), sizeof(struct tri_tile), sizeof(struct tri_error)}};
    unsigned char byte[sizeof probe];
    uint64_t hash = 0;
    memcpy(byte, &probe, sizeof probe);
    for (size_t i = 0; i < sizeof byte; i++)
        hash = 31 * hash + byte[i];
    return (int64_t)(hash >> 1);
}

/* Collective: fails on all ranks if `memory` is NULL on one of them, or if machines represent numbers differently. A
 * rank without memory must take part, because the others wait for it. */
static enum tri_status check_all(MPI_Comm comm, const void *memory, struct tri_error *error)
{
    int64_t mine[3] = {memory != NULL, layout(), -layout()}, least[3] = {0};
    if (MPI_Allreduce(mine, least, 3, MPI_INT64_T, MPI_MIN, comm) != MPI_SUCCESS)
        return tri_fail(error, TRI_INTERNAL, NULL, 0, "the ranks cannot reach each other");
    if (!least[0])
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the other ranks");
    if (least[1] != -least[2])
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "the machines of the ranks store numbers in different ways");
    return TRI_OK;
}

static void free_messenger(struct messenger *m)
{
    if (m) {
        free(m->carrier.of_each);
        free(m->request);
        free(m->state);
        free(m->telling);
    }
    free(m);
}

/* Returns a carrier over comm; NULL: no memory. Not collective. */
static struct messenger *messenger_on(MPI_Comm comm)
{
    struct messenger *m = calloc(1, sizeof *m);
    if (!m)
        return NULL;
    m->comm = comm;
    m->carrier = (struct par_carrier){.self = m, .gather = gather, .deal = deal, .transfer = transfer,
                                      .spread = spread, .pass_on = pass_on};
    MPI_Comm_rank(comm, &m->carrier.rank);
    MPI_Comm_size(comm, &m->carrier.n_ranks);
    const size_t n = (size_t)m->carrier.n_ranks;
    m->carrier.of_each = malloc(n * PAR_ROOM * sizeof *m->carrier.of_each);
    m->request = malloc(2 * n * sizeof *m->request);
    m->state = malloc(2 * n * sizeof *m->state);
    m->telling = malloc(n * sizeof *m->telling);
    for (size_t p = 0; m->telling && p < n; p++)
        m->telling[p] = MPI_REQUEST_NULL;
    if (m->carrier.of_each && m->request && m->state && m->telling)
        return m;
    free_messenger(m);
    return NULL;
}

enum tri_status par_mpi_carrier_new(struct par_carrier **carrier, const void *comm, struct tri_error *error)
{
    MPI_Comm copy;
    int inter = 0;
    *carrier = NULL;
    if (MPI_Comm_test_inter(*(const MPI_Comm *)comm, &inter) == MPI_SUCCESS && inter)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "the communicator is an intercommunicator, with two groups");
    if (MPI_Comm_dup(*(const MPI_Comm *)comm, &copy) != MPI_SUCCESS)
        return tri_fail(error, TRI_INTERNAL, NULL, 0, "the communicator cannot be duplicated");
    struct messenger *m = messenger_on(copy);
    enum tri_status status = check_all(copy, m, error);
    if (!status) {
        *carrier = &m->carrier;
        return TRI_OK;
    }
    if (status != TRI_INTERNAL)
        MPI_Comm_free(&copy);
    free_messenger(m);
    return status;
}

void par_mpi_carrier_free(struct par_carrier *carrier)
{
    struct messenger *m = carrier->self;
    if (carrier->lost) /* other ranks may not call this function, and MPI may still access the buffers */
        return;
    hear_all(m);
    MPI_Comm_free(&m->comm);
    free_messenger(m);
}

enum tri_status par_stream_on(MPI_Comm comm, const struct tri_figure *figure, const struct tri_settings *settings,
                              const struct tri_sink *sink, struct par_exchanges *exchanges, struct tri_error *error)
{
    if (!is_running())
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "MPI has not been initialised, or has ended");
    struct par_carrier *carrier;
    enum tri_status status = par_mpi_carrier_new(&carrier, &comm, error);
    if (status)
        return status;
    status = par_stream_over(carrier, figure, settings, sink, error);
    copy_traffic(carrier, exchanges);
    par_mpi_carrier_free(carrier);
    return status;
}
