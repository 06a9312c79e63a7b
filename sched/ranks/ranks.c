/* The steps of the schedule on ranks: columns, borders, later rounds. */
#include "sched/ranks/ranks.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "sched/ranks/fragment.h"

/* --- who has what */

static const struct tri_fence NOTHING = {HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL};

struct tri_fence par_box_of(const struct par_ranks *r, int p)
{
    int32_t first = r->start[p], end = r->start[p + 1];
    if (first == end)
        return NOTHING;
    return (struct tri_fence){par_fence(r->partition, 2 * first + 1, 0).x_min, -HUGE_VAL,
                              par_fence(r->partition, 2 * end - 1, 0).x_max, HUGE_VAL};
}

int par_owner_of_column(const struct par_ranks *r, int32_t i)
{
    int p = 0;
    while (i >= r->start[p + 1])
        p++;
    return p;
}

static double larger(double a, double b) { return a > b ? a : b; }
static double smaller(double a, double b) { return a < b ? a : b; }

/* What rank p owns of a box. */
static struct tri_fence share_of(const struct par_ranks *r, const struct tri_fence *box, int p)
{
    const struct tri_fence own = par_box_of(r, p);
    return (struct tri_fence){larger(box->x_min, own.x_min), larger(box->y_min, own.y_min),
                              smaller(box->x_max, own.x_max), smaller(box->y_max, own.y_max)};
}

/* Contiguous, as many as fit: columns hold equal shares of the estimated work. */
static int32_t *share_columns(int32_t n_odd, const struct par_carrier *carrier)
{
    int n = carrier->n_ranks;
    int32_t *start = malloc(((size_t)n + 1) * sizeof *start);
    for (int p = 0; start && p <= n; p++)
        start[p] = carrier->share ? (int32_t)(carrier->share[p] * n_odd) : (int32_t)((int64_t)p * n_odd / n);
    return start;
}

/* --- what moves */

enum tri_status par_ranks_cut(struct par_ranks *r, int to, const struct tri_fence *box, struct tri_error *error)
{
    if (!(box->x_min < box->x_max && box->y_min < box->y_max))
        return TRI_OK;
    return par_fragment_cut(&r->out[to], r->state, r->n_common, box, error);
}

/* Sends what has been cut, and puts what has come in its place. */
enum tri_status par_ranks_swap(struct par_ranks *r, enum par_move move, enum tri_status status,
                               struct tri_error *error)
{
    status = par_swap(r->carrier, move, r->out, r->in, status, error);
    for (int p = 0; p < r->carrier->n_ranks; p++) {
        for (size_t at = 0, used = 0; !status && at < r->in[p].n; at += used)
            status = par_fragment_paste(r->state, r->n_common, r->in[p].at + at, r->in[p].n - at, &used, error);
        free(r->in[p].at);
        r->in[p] = (struct par_bytes){0};
    }
    return status;
}

/* --- the first round */

enum tri_status par_ranks_column(struct par_ranks *r, int32_t column, struct tri_error *error)
{
    int first = column % 2 == 1 ? 0 : 2;
    enum tri_status status = par_phase(r->state, r->partition, first, column, error);
    return status ? status : par_phase(r->state, r->partition, first + 1, column, error);
}

/* The own columns, and the even ones between them; where there is no other rank beyond, those at the rim, too. */
static enum tri_status refine_own(struct par_ranks *r, struct tri_error *error)
{
    int32_t first = r->start[r->carrier->rank], end = r->start[r->carrier->rank + 1];
    enum tri_status status = TRI_OK;
    for (int32_t i = first; !status && i < end; i++) {
        status = par_ranks_column(r, 2 * i + 1, error);
        if (!status && (i > first || i == 0))
            status = par_ranks_column(r, 2 * i, error);
    }
    if (!status && first < end && end == r->n_odd)
        status = par_ranks_column(r, 2 * end, error);
    return status;
}

/* --- later rounds, on rank 0 */

/* A list of 32-bit numbers in ascending order, each once. */
static void sort_unique(struct par_bytes *list)
{
    int32_t *item = (int32_t *)(void *)list->at;
    list->n = (size_t)par_sort_unique(item, (int32_t)(list->n / sizeof *item)) * sizeof *item;
}

static enum tri_status no_memory(struct tri_error *error)
{
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for what is left over");
}

/* The blocks of a phase that have something to do, of all ranks: *blocks receives them. */
static enum tri_status find_blocks(struct par_ranks *r, const struct par_partition *partition, int phase,
                                   struct par_bytes *blocks, struct tri_error *error)
{
    const struct par_state *state = r->state;
    int n_ranks = r->carrier->n_ranks;
    bool memory = true;
    for (int32_t i = 0; memory && i < state->worklist.n; i++) {
        int32_t block = par_owner_of(partition, phase, state->mesh, state->worklist.item[i]);
        memory = block == TRI_NONE || par_bytes_add(&r->out[0], &block, sizeof block);
    }
    sort_unique(&r->out[0]);
    enum tri_status status = par_swap(r->carrier, PAR_MOVE_LEFT_OVER, r->out, r->in, memory ? TRI_OK : no_memory(error),
                                      error);
    for (int p = 0; p < n_ranks; p++) {
        memory = memory && par_bytes_add(blocks, r->in[p].at, r->in[p].n);
        free(r->in[p].at);
        r->in[p] = (struct par_bytes){0};
    }
    sort_unique(blocks);
    for (int p = 0; memory && r->carrier->rank == 0 && p < n_ranks; p++)
        memory = par_bytes_add(&r->out[p], blocks->at, blocks->n);
    status = status ? status : memory ? TRI_OK : no_memory(error);
    status = par_swap(r->carrier, PAR_MOVE_LEFT_OVER, r->out, r->in, status, error);
    free(blocks->at);
    *blocks = r->in[0];
    r->in[0] = (struct par_bytes){0};
    return status;
}

/* Rank 0 gets what others hold in the boxes, or (back) gives it back to them. */
static enum tri_status move_boxes(struct par_ranks *r, const struct tri_fence *box, size_t n, bool back,
                                  enum tri_status status, struct tri_error *error)
{
    int rank = r->carrier->rank;
    for (size_t i = 0; !status && i < n; i++)
        for (int p = 1; !status && p < r->carrier->n_ranks; p++) {
            const struct tri_fence share = share_of(r, &box[i], p);
            if (back ? rank == 0 : rank == p)
                status = par_ranks_cut(r, back ? p : 0, &share, error);
        }
    return par_ranks_swap(r, PAR_MOVE_LEFT_OVER, status, error);
}

static void keep_own(struct par_ranks *r)
{
    const struct tri_fence own = par_box_of(r, r->carrier->rank);
    par_worklist_keep(r->state, &own);
}

static enum tri_status refine_blocks(struct par_ranks *r, const struct par_partition *partition, int phase,
                                     const struct par_bytes *blocks, struct tri_error *error)
{
    const int32_t *block = (const int32_t *)(const void *)blocks->at;
    size_t n = blocks->n / sizeof *block;
    struct tri_fence *box = malloc((n + 1) * sizeof *box);
    enum tri_status status = box ? TRI_OK : no_memory(error);
    for (size_t i = 0; box && i < n; i++)
        box[i] = par_fence(partition, block[i] / partition->n_rows, block[i] % partition->n_rows);
    status = move_boxes(r, box, box ? n : 0, false, status, error);
    if (!status && r->carrier->rank == 0)
        status = par_phase(r->state, partition, phase, TRI_NONE, error);
    status = move_boxes(r, box, status ? 0 : n, true, status, error);
    free(box);
    keep_own(r);
    return status;
}

static enum tri_status refine_phase(struct par_ranks *r, const struct par_partition *partition, int phase,
                                    struct tri_error *error)
{
    struct par_bytes blocks = {0};
    enum tri_status status = find_blocks(r, partition, phase, &blocks, error);
    if (!status && blocks.n > 0)
        status = refine_blocks(r, partition, phase, &blocks, error);
    free(blocks.at);
    return status;
}

/* The rest without fences, as one call. */
static enum tri_status refine_rest(struct par_ranks *r, struct tri_error *error)
{
    const struct tri_fence plane = {-HUGE_VAL, -HUGE_VAL, HUGE_VAL, HUGE_VAL};
    struct par_state *state = r->state;
    enum tri_status status = move_boxes(r, &plane, 1, false, TRI_OK, error);
    if (!status && r->carrier->rank == 0) {
        struct tri_refine_options options = *state->quality;
        struct tri_refine_report report;
        options.worklist = state->worklist.item;
        options.n_worklist = state->worklist.n;
        par_room_mark(&state->spare, state->mesh);
        status = tri_refine(state->mesh, &options, &report, error);
        par_add_up(&state->report->total, &report);
        state->worklist.n = state->key.n = 0;
    }
    return move_boxes(r, &plane, 1, true, status, error);
}

static enum tri_status count_rest(struct par_ranks *r, int64_t *left, enum tri_status status, struct tri_error *error)
{
    int64_t mine = r->state->worklist.n;
    return par_sum(r->carrier, &mine, 1, left, status, error);
}

static enum tri_status refine_later(struct par_ranks *r, enum tri_status status, struct tri_error *error)
{
    struct par_partition partition;
    int64_t left = 0;
    status = count_rest(r, &left, status, error);
    if (status || left == 0)
        return status;
    status = par_partition_copy(&partition, r->partition, error);
    r->state->report->left_over += left;
    while (left > 0 && par_can_coarsen(&partition)) {
        par_partition_coarsen(&partition);
        r->state->round++;
        r->state->report->rounds++;
        for (int phase = 0; !status && phase < PAR_PHASES; phase++)
            status = refine_phase(r, &partition, phase, error);
        status = count_rest(r, &left, status, error);
        if (status)
            break;
    }
    par_partition_free(&partition);
    return status || left == 0 ? status : refine_rest(r, error);
}

/* --- all together */

/* What all ranks have done since, everywhere. */
static enum tri_status add_up(struct par_ranks *r, const struct tri_refine_report *before, enum tri_status status,
                              struct tri_error *error)
{
    struct tri_refine_report *total = &r->state->report->total;
    int64_t mine[4 + TRI_EXCUSES] = {total->inserted_free - before->inserted_free,
                                     total->inserted_on_segments - before->inserted_on_segments,
                                     total->hit_cap && !before->hit_cap,
                                     total->fenced - before->fenced};
    int64_t sum[4 + TRI_EXCUSES];
    for (int k = 0; k < TRI_EXCUSES; k++)
        mine[4 + k] = total->given_up[k] - before->given_up[k];
    status = par_sum(r->carrier, mine, 4 + TRI_EXCUSES, sum, status, error);
    if (status)
        return status;
    *total = *before;
    total->inserted_free += sum[0];
    total->inserted_on_segments += sum[1];
    total->hit_cap = total->hit_cap || sum[2] > 0;
    r->state->report->deferred += sum[3];
    for (int k = 0; k < TRI_EXCUSES; k++)
        total->given_up[k] += sum[4 + k];
    total->gated = total->fenced = 0;
    return TRI_OK;
}

static uint64_t mix(uint64_t hash, uint64_t word)
{
    hash = (hash ^ word) * 0x9e3779b97f4a7c15ull;
    return hash ^ hash >> 29;
}

/* Of what all ranks must have alike. */
static int64_t fingerprint(const struct par_ranks *r)
{
    const struct tri_mesh *mesh = r->state->mesh;
    uint64_t hash = mix(mix((uint64_t)r->partition->n_columns, (uint64_t)r->partition->n_rows),
                        (uint64_t)r->state->worklist.n), bits[2];
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        memcpy(bits, &mesh->xy[v], sizeof bits);
        hash = mix(mix(hash, bits[0]), bits[1]);
    }
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        for (int k = 0; k < 3; k++)
            hash = mix(hash, (uint64_t)mesh->tri[t].v[k]);
    return (int64_t)hash;
}

static enum tri_status compare_meshes(struct par_ranks *r, enum tri_status status, struct tri_error *error)
{
    int64_t mine = fingerprint(r), *all = malloc((size_t)r->carrier->n_ranks * sizeof *all);
    status = par_gather(r->carrier, &mine, 1, all, status ? status : all ? TRI_OK : no_memory(error), error);
    for (int p = 0; !status && p < r->carrier->n_ranks; p++)
        if (all[p] != all[0])
            status = tri_fail(error, TRI_BAD_INPUT, NULL, 0,
                              "the ranks have not been given the same figure and settings: see rank %d", p);
    free(all);
    return status;
}

static enum tri_status refine_all(struct par_ranks *r, struct par_tiles *tiles, enum tri_status status,
                                  struct tri_error *error)
{
    const struct tri_refine_report before = r->state->report->total;
    status = compare_meshes(r, status, error);
    if (!status) {
        keep_own(r);
        status = refine_own(r, error);
    }
    status = par_ranks_borders(r, status, error);
    if (!status)
        keep_own(r);
    status = refine_later(r, status, error);
    status = add_up(r, &before, status, error);
    return par_hand_out_on_ranks(r, tiles, status, error);
}

enum tri_status par_refine_on_ranks(struct par_state *state, const struct par_partition *partition,
                                    struct par_tiles *tiles, struct tri_error *error)
{
    struct par_carrier *carrier = state->options->carrier;
    size_t n = (size_t)carrier->n_ranks;
    struct par_ranks r = {.state = state, .carrier = carrier, .partition = partition,
                          .n_odd = (partition->n_columns - 1) / 2, .n_common = state->mesh->n_vertices};
    r.start = share_columns(r.n_odd, carrier);
    r.out = calloc(n, sizeof *r.out);
    r.in = calloc(n, sizeof *r.in);
    state->round = 0;
    state->n_schedules++;
    state->report->rounds++;
    bool memory = r.start && r.out && r.in && par_keys_tell(state);
    enum tri_status status = memory ? TRI_OK : no_memory(error);
    if (!memory)
        status = par_agree(carrier, status, error);
    else
        status = refine_all(&r, tiles, status, error);
    for (size_t p = 0; memory && p < n; p++) {
        free(r.out[p].at);
        free(r.in[p].at);
    }
    free(r.out);
    free(r.in);
    free(r.start);
    return status;
}
