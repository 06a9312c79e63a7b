/* Blocks and tiles are counted as in sched/ranks/territory.h: columns first. Block (2 i + 1, 2 j + 1) is tile (i, j);
 * others lie over two tiles or four. Where copies of a mesh meet, what were two blocks at borders is one inside. */
#include "drivers/mesh/replay.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "drivers/mesh/prediction.h"

/* A block of the phase at hand, and who owns tiles of it: the first works on it. */
struct piece {
    double seconds;
    int owner[4];
    int owners;
};

struct player {
    const struct replay_how *how;
    int32_t columns, rows;            /* of tiles, of all copies */
    int32_t old_columns, old_rows;    /* of the measured mesh */
    double *measured;                 /* [blocks] seconds in the measured mesh, in the schedule at hand */
    const struct replay_pair *pair;   /* of the schedule at hand */
    struct piece *piece, *sorted;     /* [n_pieces] of the phase at hand; the same by worker */
    int32_t n_pieces;
    int32_t *begin;                   /* [n_ranks + 1] each worker's pieces in `sorted` */
    double *seconds;                  /* [n_pieces] scratch */
    double *load;                     /* [threads] scratch */
    int *met;                         /* [n_ranks] last worker that spoke with this rank */
    double *pairs, *messages;         /* [n_ranks] a block and another rank; in the phase at hand */
    double *busy, *sent;              /* [n_ranks] seconds of a processor, and bytes, in all phases */
    double later;                     /* seconds of blocks that are not replayed */
    struct replay *sum;
};

/* Measured: 15 million triangles on 2, 4 and 9 ranks, with bounds of 20 and of 33 degrees. */
static const double CELL = 65536;
static const struct replay_pair FIRST = {168e3, 0.0045, 3}, SECOND = {14e3, 0.0017, 6};

struct replay_how replay_usual(int n_ranks, int threads, int times, double cell)
{
    double share = cell / CELL;
    return (struct replay_how){.n_ranks = n_ranks, .threads = threads, .times = times, .latency = 2e-6,
                               .bandwidth = 1e10, .lateness = 2.5e-4,
                               .pair = {{FIRST.bytes * share, FIRST.seconds * share, FIRST.swaps}, SECOND}};
}

/* --- blocks */

/* Of a schedule on the cells of the report, the first of which is number 0. Those before it made the coarse mesh, whose
 * time is known as a whole. */
static void take_blocks(struct player *p, const struct par_report *report, int which)
{
    memset(p->measured, 0, (size_t)report->columns * (size_t)report->rows * sizeof *p->measured);
    for (int32_t i = 0; i < report->n_blocks; i++) {
        const struct par_block_report *b = &report->blocks[i];
        if (b->schedule != report->schedule + which)
            continue;
        if (b->round == 0 && b->block < report->columns * report->rows)
            p->measured[b->block] += b->seconds;
        else
            p->later += b->seconds;
    }
}

/* Up to two coordinates of measured blocks for one here; n: tiles of the measured mesh. */
static int coordinates(int32_t at, int32_t n, int32_t total, int32_t measured[2])
{
    measured[0] = at % (2 * n);
    if (measured[0] > 0 || at == 0)
        return 1;
    measured[0] = 2 * n;
    measured[1] = 0;
    return at == 2 * total ? 1 : 2;
}

static double seconds_of(const struct player *p, int32_t column, int32_t row)
{
    int32_t c[2], r[2];
    int n_c = coordinates(column, p->old_columns, p->columns, c), n_r = coordinates(row, p->old_rows, p->rows, r);
    double sum = 0;
    for (int i = 0; i < n_c; i++)
        for (int j = 0; j < n_r; j++)
            sum += p->measured[c[i] * (2 * p->old_rows + 1) + r[j]];
    return sum;
}

/* --- ranks */

static int64_t first_tile(const struct player *p, int rank)
{
    return (int64_t)rank * p->columns * p->rows / p->how->n_ranks;
}

static int owner_of(const struct player *p, int64_t tile)
{
    int64_t tiles = (int64_t)p->columns * p->rows;
    int rank = (int)(tile * p->how->n_ranks / tiles);
    while (first_tile(p, rank + 1) <= tile)
        rank++;
    while (first_tile(p, rank) > tile)
        rank--;
    return rank;
}

/* Who owns tiles of a block, each once, the first tile's owner first. */
static void find_owners(const struct player *p, int32_t column, int32_t row, struct piece *piece)
{
    piece->owners = 0;
    for (int32_t c = (column - 1) / 2; c <= column / 2 && c < p->columns; c++)
        for (int32_t r = (row - 1) / 2; r <= row / 2 && r < p->rows; r++) {
            int rank = owner_of(p, (int64_t)c * p->rows + r), k = 0;
            while (k < piece->owners && piece->owner[k] != rank)
                k++;
            piece->owner[k] = rank;
            piece->owners = k == piece->owners ? k + 1 : piece->owners;
        }
}

static double larger(double a, double b) { return a > b ? a : b; }

/* --- a phase */

static void find_pieces(struct player *p, int phase)
{
    p->n_pieces = 0;
    for (int32_t c = phase / 2 == 0; c <= 2 * p->columns; c += 2)
        for (int32_t r = phase % 2 == 0; r <= 2 * p->rows; r += 2) {
            struct piece *piece = &p->piece[p->n_pieces++];
            piece->seconds = seconds_of(p, c, r);
            find_owners(p, c, r, piece);
        }
}

/* Stable, by counting. */
static void sort_pieces(struct player *p)
{
    int n = p->how->n_ranks;
    memset(p->begin, 0, ((size_t)n + 1) * sizeof *p->begin);
    for (int32_t i = 0; i < p->n_pieces; i++)
        p->begin[p->piece[i].owner[0] + 1]++;
    for (int rank = 0; rank < n; rank++)
        p->begin[rank + 1] += p->begin[rank];
    for (int32_t i = 0; i < p->n_pieces; i++)
        p->sorted[p->begin[p->piece[i].owner[0]]++] = p->piece[i];
    memmove(p->begin + 1, p->begin, (size_t)n * sizeof *p->begin); /* each begins where the one before ends */
    p->begin[0] = 0;
}

/* What a worker has to say to others for one of its blocks. */
static void count_pairs(struct player *p, const struct piece *piece)
{
    int worker = piece->owner[0];
    for (int k = 1; k < piece->owners; k++) {
        int lender = piece->owner[k];
        p->pairs[worker]++;
        p->pairs[lender]++;
        if (p->met[lender] != worker) {
            p->messages[worker] += p->pair->swaps;
            p->messages[lender] += p->pair->swaps;
        }
        p->met[lender] = worker;
    }
}

/* Seconds of the one that is busy longest. */
static double refine(struct player *p)
{
    double longest = 0;
    for (int rank = 0; rank < p->how->n_ranks; rank++) {
        int32_t n = 0;
        for (int32_t i = p->begin[rank]; i < p->begin[rank + 1]; i++) {
            p->busy[rank] += p->sorted[i].seconds;
            p->seconds[n++] = p->sorted[i].seconds;
            count_pairs(p, &p->sorted[i]);
        }
        longest = larger(longest, prediction_makespan(p->seconds, n, p->load, p->how->threads));
    }
    return longest;
}

/* All ranks tell each other some bytes. */
static double gather_seconds(const struct replay_how *how, double bytes)
{
    return how->n_ranks == 1 ? 0 : ceil(log2(how->n_ranks)) * how->latency +
                                       (how->n_ranks - 1) * bytes / how->bandwidth + how->lateness;
}

/* Of a phase: at its beginning one bit for each block of the plane; in each swap whether there is anything to send, how
 * much, and whether there is memory for it; and whether there is another one. */
static double agreements(const struct player *p)
{
    double blocks = (2.0 * p->columns + 1) * (2.0 * p->rows + 1);
    return gather_seconds(p->how, blocks / 8) + 4 * p->pair->swaps * gather_seconds(p->how, 8);
}

static void play_phase(struct player *p, int phase)
{
    const struct replay_how *how = p->how;
    double under_way = 0, packing = 0;
    for (int rank = 0; rank < how->n_ranks; rank++) {
        p->pairs[rank] = p->messages[rank] = 0;
        p->met[rank] = -1;
    }
    find_pieces(p, phase);
    sort_pieces(p);
    p->sum->refine += refine(p);
    for (int rank = 0; rank < how->n_ranks; rank++) {
        double bytes = p->pairs[rank] * p->pair->bytes;
        under_way = larger(under_way, bytes / how->bandwidth + p->messages[rank] * how->latency);
        packing = larger(packing, p->pairs[rank] * p->pair->seconds / 2);
        p->busy[rank] += p->pairs[rank] * p->pair->seconds / 2;
        p->sent[rank] += bytes / 2; /* the other half comes */
        p->sum->bytes += bytes / 2;
        p->sum->messages += p->messages[rank] / 2;
    }
    p->sum->merge += packing;
    p->sum->communicate += under_way + agreements(p);
}

static void play_schedule(struct player *p, const struct par_report *report, int which)
{
    p->pair = &p->how->pair[which];
    take_blocks(p, report, which);
    for (int phase = 0; phase < PAR_PHASES; phase++)
        play_phase(p, phase);
}

/* On the cells of the report: the blocks of the last one come last. */
static int schedules_of(const struct par_report *report)
{
    int last = report->n_blocks > 0 ? report->blocks[report->n_blocks - 1].schedule : 0;
    return last > report->schedule ? last - report->schedule + 1 : 1;
}

/* --- all together */

/* What each rank does for its share of the mesh, of one thread: looking for bad triangles, numbers and tiles. */
static double shared_seconds(const struct par_report *r)
{
    return r->threads * (r->seconds_find + r->seconds_number) + r->seconds_deal + r->seconds_room + r->seconds_merge;
}

static void add_up(struct player *p, const struct par_report *report)
{
    struct replay *s = p->sum;
    const struct replay_how *how = p->how;
    double copies = (double)how->times * how->times, share = shared_seconds(report) * copies / how->n_ranks;
    s->alone = (report->seconds_prerefine + report->seconds_partition) * copies + p->later;
    s->hand_out = share / how->threads;
    s->total = s->alone + s->refine + s->merge + s->communicate + s->hand_out;
    for (int rank = 0; rank < how->n_ranks; rank++) {
        s->processor = larger(s->processor, s->alone + p->busy[rank] + share);
        s->most_bytes = larger(s->most_bytes, p->sent[rank]);
    }
}

static bool reserve(struct player *p, const struct par_report *report)
{
    size_t ranks = (size_t)p->how->n_ranks, pieces = (size_t)(p->columns + 1) * (size_t)(p->rows + 1);
    p->measured = calloc((size_t)report->columns * (size_t)report->rows, sizeof *p->measured);
    p->piece = malloc(pieces * sizeof *p->piece);
    p->sorted = malloc(pieces * sizeof *p->sorted);
    p->begin = malloc((ranks + 1) * sizeof *p->begin);
    p->seconds = malloc(pieces * sizeof *p->seconds);
    p->load = malloc((size_t)p->how->threads * sizeof *p->load);
    p->met = malloc(ranks * sizeof *p->met);
    p->pairs = malloc(ranks * sizeof *p->pairs);
    p->messages = malloc(ranks * sizeof *p->messages);
    p->busy = calloc(ranks, sizeof *p->busy);
    p->sent = calloc(ranks, sizeof *p->sent);
    return p->measured && p->piece && p->sorted && p->begin && p->seconds && p->load && p->met && p->pairs &&
           p->messages && p->busy && p->sent;
}

static void release(struct player *p)
{
    free(p->measured);
    free(p->piece);
    free(p->sorted);
    free(p->begin);
    free(p->seconds);
    free(p->load);
    free(p->met);
    free(p->pairs);
    free(p->messages);
    free(p->busy);
    free(p->sent);
}

bool replay_on_ranks(const struct par_report *report, const struct replay_how *how, struct replay *replay)
{
    int32_t columns = (report->columns - 1) / 2, rows = (report->rows - 1) / 2;
    struct player p = {.how = how, .old_columns = columns, .old_rows = rows, .columns = columns * how->times,
                       .rows = rows * how->times, .sum = replay};
    *replay = (struct replay){0};
    bool good = columns > 0 && rows > 0 && reserve(&p, report);
    if (good) {
        for (int which = 0; which < REPLAY_SCHEDULES && which < schedules_of(report); which++)
            play_schedule(&p, report, which);
        add_up(&p, report);
    }
    release(&p);
    return good;
}
