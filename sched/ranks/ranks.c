/* The steps of the schedule on ranks: phases, rounds, the last call. */
#include "sched/ranks/ranks.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "sched/checkpoint/state.h"
#include "sched/schedule/by_tile.h"
#include "sched/tiles/park.h"
#include "sched/tunables.h"
#include "triangle/base/grow.h"

/* --- who works where */

static int32_t blocks_of(const struct par_shift *shift)
{
    return shift->partition ? par_blocks(shift->partition) : 1;
}

static const struct tri_fence PLANE = {-HUGE_VAL, -HUGE_VAL, HUGE_VAL, HUGE_VAL};

static struct tri_fence box_of(const struct par_shift *shift, int32_t block)
{
    const struct par_partition *p = shift->partition;
    return p ? par_fence(p, block / p->n_rows, block % p->n_rows) : PLANE;
}

static bool has_its_turn(const struct par_shift *shift, int32_t block)
{
    const struct par_partition *p = shift->partition;
    if (!p)
        return true;
    int32_t column = block / p->n_rows, row = block % p->n_rows;
    return column % 2 == 1 - shift->phase / 2 && row % 2 == 1 - shift->phase % 2 &&
           (column / 2 * ((p->n_rows + 1) / 2) + row / 2) % shift->n_steps == shift->step;
}

static bool init_shift(struct par_ranks *r)
{
    struct par_shift *s = &r->shift;
    size_t n = (size_t)blocks_of(s);
    assert(!s->worker && !s->block_of);
    s->worker = malloc(n * sizeof *s->worker);
    s->is_mine = calloc(n, sizeof *s->is_mine);
    s->is_border = calloc(n, sizeof *s->is_border);
    s->block_of = malloc(((size_t)r->state->worklist.n + 1) * sizeof *s->block_of);
    return s->worker && s->is_mine && s->is_border && s->block_of;
}

static void free_shift(struct par_shift *s)
{
    free(s->worker);
    free(s->is_mine);
    free(s->is_border);
    free(s->block_of);
    free(s->changed.item);
    *s = (struct par_shift){0};
}

/* Blocks over the tiles of several ranks: worker[b] is whoever would work on it; returns whether there are any. */
static bool find_borders(struct par_ranks *r)
{
    struct par_shift *s = &r->shift;
    bool any = false;
    for (int32_t b = 0; b < blocks_of(s); b++) {
        int first, last;
        const struct tri_fence box = box_of(s, b);
        s->worker[b] = -1;
        if (has_its_turn(s, b) && par_owners_in(&r->territory, &box, &first, &last) && first < last)
            s->worker[b] = first;
        any = any || s->worker[b] >= 0;
    }
    return any;
}

/* One bit for each block at a border that has something to do. */
static void find_work(struct par_ranks *r, int64_t *word)
{
    const struct par_run *state = r->state;
    struct par_shift *s = &r->shift;
    struct par_locator locator = PAR_LOST;
    for (int32_t i = 0; i < state->worklist.n; i++) {
        tri_triangle_id t = state->worklist.item[i];
        assert(tri_is_live(&state->mesh->tri[t]));
        int32_t b = s->partition ? par_locate_owner(&locator, s->partition, s->phase, state->mesh, t) : 0;
        s->block_of[i] = b;
        if (b != TRI_NONE && s->worker[b] >= 0)
            word[b / 64] |= (int64_t)((uint64_t)1 << b % 64);
    }
}

static bool is_in(const int64_t *word, int32_t b) { return (uint64_t)word[b / 64] >> b % 64 & 1; }

static void assign(struct par_ranks *r, const int64_t *word)
{
    struct par_shift *s = &r->shift;
    int rank = r->carrier->rank;
    for (int32_t b = 0; b < blocks_of(s); b++) {
        const struct tri_fence box = box_of(s, b);
        s->worker[b] = s->worker[b] >= 0 && is_in(word, b) ? s->worker[b] : -1;
        s->is_mine[b] = (s->worker[b] < 0 || s->worker[b] == rank) && has_its_turn(s, b);
        s->is_border[b] = s->worker[b] == rank;
        if (s->worker[b] == rank || (s->worker[b] >= 0 && !par_has_part(&r->territory, &box, rank)))
            s->worker[b] = -1;
    }
}

/* *any: somebody has to ask somebody else. Collective. */
static enum tri_status share_blocks(struct par_ranks *r, bool *any, struct tri_error *error)
{
    size_t n_words = (size_t)blocks_of(&r->shift) / 64 + 1, n_ranks = (size_t)r->carrier->n_ranks;
    int64_t *mine = calloc(n_words, sizeof *mine), *all = calloc(n_ranks * n_words, sizeof *all);
    enum tri_status status = mine && all && init_shift(r) ? TRI_OK : par_ranks_no_memory(error);
    bool borders = !status && find_borders(r);
    if (!status)
        find_work(r, mine);
    *any = false;
    if (status || borders)
        status = par_gather(r->carrier, mine, (int32_t)n_words, all, status, error);
    for (size_t i = 0; !status && i < n_ranks * n_words; i++) {
        mine[i % n_words] |= all[i];
        *any = *any || all[i] != 0;
    }
    if (!status)
        assign(r, mine);
    free(mine);
    free(all);
    return status;
}

/* --- what moves */

static enum tri_status swap(struct par_ranks *r, enum par_move move, enum tri_status status, struct tri_error *error)
{
    return par_swap(r->carrier, r->state->round > 0 || !r->shift.partition ? PAR_MOVE_LEFT_OVER : move, r->out, r->in,
                    status, error);
}

static void free_in(struct par_ranks *r) { par_bytes_free(r->in, r->carrier->n_ranks); }

/* *any: somebody has asked for more, and has got it. Collective. */
static enum tri_status lend_more(struct par_ranks *r, const struct par_ids *asked, bool *any,
                                 enum tri_status status, struct tri_error *error)
{
    int64_t n = asked->n, sum;
    status = par_sum(r->carrier, &n, 1, &sum, status, error);
    *any = !status && sum > 0;
    if (!*any)
        return status;
    status = par_ask(r, asked, error);
    status = swap(r, PAR_MOVE_BORDERS, status, error);
    status = status ? status : par_lend_more(r, error);
    free_in(r);
    status = swap(r, PAR_MOVE_BORDERS, status, error);
    bool came = n == 0;
    for (int p = 0; p < r->carrier->n_ranks; p++)
        came = came || r->in[p].n > 0;
    if (!status && !came)
        status = tri_fail(error, TRI_INTERNAL, NULL, 0, "nobody knows what lies beyond an edge");
    status = status ? status : par_borrow(r, error);
    free_in(r);
    return status;
}

/* Does a block at a border that is done here take the triangle? */
static bool is_taken(const struct par_ranks *r, tri_triangle_id t)
{
    const struct par_shift *s = &r->shift;
    int32_t block = s->partition ? par_owner_of(s->partition, s->phase, r->state->mesh, t) : 0;
    return block != TRI_NONE && s->is_border[block];
}

/* Across which edges of what such blocks begin with is the unknown? *asked receives their ends. Who lends an entry need
 * not own all of its corners, and who owns the others need not know of the entry. */
static bool find_unknown(const struct par_ranks *r, struct par_ids *asked)
{
    const struct par_ids *list = &r->state->worklist;
    bool memory = true;
    for (int32_t i = 0; i < list->n; i++) {
        const struct tri_triangle *t = &r->state->mesh->tri[list->item[i]];
        for (int e = 0; memory && e < 3; e++)
            if (t->n[e] == TRI_BEYOND && is_taken(r, list->item[i]))
                memory = par_ids_add(asked, t->v[tri_next[e]]) && par_ids_add(asked, t->v[tri_prev[e]]);
    }
    return memory;
}

static enum tri_status lend(struct par_ranks *r, struct tri_error *error)
{
    struct par_ids asked = {0};
    bool any;
    enum tri_status status = par_index_straddlers(r) ? TRI_OK : par_ranks_no_memory(error);
    status = status ? status : par_lend(r, error);
    status = swap(r, PAR_MOVE_BORDERS, status, error);
    status = status ? status : par_borrow(r, error);
    free_in(r);
    if (!status && !find_unknown(r, &asked))
        status = par_ranks_no_memory(error);
    status = lend_more(r, &asked, &any, status, error);
    free(asked.item);
    return status;
}

/* What blocks at borders wait for, as struct par_share has it. */
static enum tri_status fetch(void *user, const struct par_ids *asked, struct tri_error *error)
{
    bool any;
    return lend_more(user, asked, &any, TRI_OK, error);
}

/* Until nobody asks for more. Collective. */
static enum tri_status serve(struct par_ranks *r, enum tri_status status, struct tri_error *error)
{
    static const struct par_ids nothing;
    bool any = true;
    while (any)
        status = lend_more(r, &nothing, &any, status, error);
    return status;
}

static enum tri_status give_back(struct par_ranks *r, enum tri_status status, struct tri_error *error)
{
    status = status ? status : par_give_back(r, &r->shift.changed, error);
    status = swap(r, PAR_MOVE_BACK, status, error);
    status = status ? status : par_take_back(r, error);
    free_in(r);
    for (int p = 0; p < r->carrier->n_ranks; p++) {
        par_talk_free(&r->lent[p]);
        par_talk_free(&r->borrowed[p]);
    }
    return status;
}

/* The blocks of a shift, with what they borrow, which is given back then. Collective. */
static enum tri_status work(struct par_ranks *r, struct par_shift shift,
                            enum tri_status (*refine)(struct par_ranks *r, struct tri_error *error),
                            struct tri_error *error)
{
    bool any;
    r->shift = shift;
    enum tri_status status = share_blocks(r, &any, error);
    if (!status && any)
        status = lend(r, error);
    status = status ? status : refine(r, error);
    if (any) {
        status = serve(r, status, error);
        status = give_back(r, status, error);
    }
    free_shift(&r->shift);
    return status;
}

/* --- phases */

/* Steps of a phase, between which there may be a checkpoint: as many for any number of ranks. */
static int32_t steps_of(const struct par_ranks *r, const struct par_partition *partition)
{
    int32_t steps = par_blocks(partition) / PAR_PHASES / PAR_BLOCKS_A_STEP;
    if (!r->state->options->checkpoint || steps < 1)
        return 1;
    return steps < PAR_MOST_STEPS ? steps : PAR_MOST_STEPS;
}

static enum tri_status refine_step(struct par_ranks *r, struct tri_error *error)
{
    struct par_run *state = r->state;
    struct par_share share = {.is_mine = r->shift.is_mine, .is_border = r->shift.is_border, .more = fetch, .user = r};
    assert(!state->share && state->phase >= 0 && state->phase < PAR_PHASES);
    par_tell(state, state->phase + 1);
    state->share = &share;
    enum tri_status status = par_phase(state, r->shift.partition, state->phase, TRI_NONE, error);
    state->share = NULL;
    r->shift.changed = share.changed;
    return status;
}

static void go_on(struct par_run *state, int32_t n_steps)
{
    if (++state->step < n_steps)
        return;
    state->step = 0;
    state->phase++;
}

/* From where it stands on. How many entries all ranks have in the end: who shares one counts it, too. Collective. */
static enum tri_status refine_round(struct par_ranks *r, const struct par_partition *partition, int64_t *left,
                                    struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    r->state->report->rounds++;
    while (!status && r->state->phase < PAR_PHASES) {
        const struct par_shift shift = {.partition = partition, .phase = r->state->phase, .step = r->state->step,
                                        .n_steps = steps_of(r, partition)};
        status = work(r, shift, refine_step, error);
        go_on(r->state, shift.n_steps);
        status = par_keep(r, status, error);
    }
    int64_t mine = r->state->worklist.n;
    return par_sum(r->carrier, &mine, 1, left, status, error);
}

/* --- the last call */

struct last_call {
    struct par_ranks *ranks;
    struct par_ids asked;
    bool lost;
};

static void note_changes(void *user, const tri_triangle_id *triangle, int32_t n)
{
    struct last_call *call = user;
    for (int32_t i = 0; i < n; i++)
        call->lost = !par_ids_add(&call->ranks->shift.changed, triangle[i]) || call->lost;
}

static void ask_for(void *user, const tri_vertex_id edge[2])
{
    struct last_call *call = user;
    for (int k = 0; k < 2; k++)
        call->lost = !par_ids_add(&call->asked, edge[k]) || call->lost;
}

/* Goes on whenever there is more of the mesh. */
static enum tri_status run_last_call(struct last_call *call, struct tri_refiner *refiner, struct tri_error *error)
{
    enum tri_status status = TRI_NO_ROOM;
    while (status == TRI_NO_ROOM) {
        call->asked.n = 0;
        status = tri_refiner_run(refiner, error);
        if (call->lost)
            status = par_ranks_no_memory(error);
        if (status == TRI_NO_ROOM) {
            enum tri_status fetched = fetch(call->ranks, &call->asked, error);
            status = fetched ? fetched : status;
        }
    }
    return status;
}

/* One call without fences, as of one process, for what the worklist holds: by the first rank that owns anything. */
static enum tri_status refine_rest(struct par_ranks *r, struct tri_error *error)
{
    struct par_run *state = r->state;
    struct last_call call = {.ranks = r};
    const struct tri_part part = {note_changes, ask_for, &call};
    struct tri_refine_report report = {0};
    const struct tri_refine_hooks hooks = {
        .worklist = state->worklist.item, .n_worklist = state->worklist.n, .part = &part};
    struct tri_refiner *refiner = NULL;
    if (state->worklist.n == 0)
        return TRI_OK;
    enum tri_status status = tri_refiner_new(&refiner, state->mesh, state->quality, &hooks, &report, error);
    status = status ? status : run_last_call(&call, refiner, error);
    assert(state->worklist.item == hooks.worklist); /* entries come with what is lent first, not with more of it */
    tri_refiner_free(refiner);
    free(call.asked.item);
    par_add_up(&state->report->total, &report);
    state->worklist.n = state->key.n = 0;
    return status;
}

/* Rounds on blocks four times as large each, until nothing is left or they cannot be larger. */
static enum tri_status refine_rounds(struct par_ranks *r, int64_t *left, struct tri_error *error)
{
    struct par_partition partition;
    struct par_run *state = r->state;
    enum tri_status status = par_partition_copy(&partition, r->territory.partition, error);
    status = par_agree(r->carrier, status, error);
    for (int32_t round = 0; !status && round < state->round; round++)
        par_partition_coarsen(&partition);
    status = status ? status : refine_round(r, &partition, left, error);
    while (!status && *left > 0 && par_can_coarsen(&partition)) {
        par_partition_coarsen(&partition);
        state->round++;
        state->phase = 0;
        status = refine_round(r, &partition, left, error);
    }
    par_partition_free(&partition);
    return status;
}

/* --- all together */

/* Writes out the keys of a worklist that no block has had. False: no memory. */
static bool tell_keys(struct par_run *state)
{
    struct par_keys *key = &state->key;
    if (key->n == state->worklist.n)
        return true;
    assert(key->n == 0);
    if (!tri_grow(&key->item, &key->capacity, state->worklist.n, sizeof *key->item))
        return false;
    for (; key->n < state->worklist.n; key->n++)
        key->item[key->n] = (uint64_t)key->n;
    return true;
}

void par_count_done(const struct par_ranks *r, int64_t done[PAR_DONE])
{
    const struct tri_refine_report *total = &r->state->report->total, *before = &r->before;
    done[0] = total->inserted_free - before->inserted_free;
    done[1] = total->inserted_on_segments - before->inserted_on_segments;
    done[2] = total->fenced - before->fenced;
    for (int k = 0; k < TRI_EXCUSES; k++)
        done[3 + k] = total->given_up[k] - before->given_up[k];
}

void par_add_done(struct par_ranks *r, const int64_t done[PAR_DONE])
{
    struct tri_refine_report *total = &r->state->report->total;
    total->inserted_free += done[0];
    total->inserted_on_segments += done[1];
    total->fenced += done[2];
    for (int k = 0; k < TRI_EXCUSES; k++)
        total->given_up[k] += done[3 + k];
}

/* What all ranks have done since, everywhere. */
static enum tri_status add_up(struct par_ranks *r, enum tri_status status, struct tri_error *error)
{
    struct par_report *report = r->state->report;
    int64_t mine[PAR_DONE], sum[PAR_DONE];
    par_count_done(r, mine);
    status = par_sum(r->carrier, mine, PAR_DONE, sum, status, error);
    if (status)
        return status;
    report->total = r->before;
    par_add_done(r, sum);
    report->deferred += sum[3];
    par_forget_deferred(report);
    return TRI_OK;
}

/* What a rank begins with: its part of the coarse mesh, or of what has been kept. */
static enum tri_status begin(struct par_ranks *r, struct tri_error *error)
{
    bool again;
    const char *words = "the ranks have not been given the same figure and settings";
    enum tri_status status = par_expect_same(r->carrier, r->run, words, TRI_OK, error);
    status = status ? status : par_take_up(r, &again, error);
    status = status || again ? status : par_keep_own(r, error);
    return par_agree(r->carrier, status, error);
}

/* Rounds, and what they leave over. Collective. */
static enum tri_status run_schedule(struct par_ranks *r, struct tri_error *error)
{
    int64_t left = 0;
    enum tri_status status = refine_rounds(r, &left, error);
    r->state->report->left_over += status ? 0 : left;
    if (status || left == 0)
        return status;
    return par_keep(r, work(r, (struct par_shift){.n_steps = 1}, refine_rest, error), error);
}

/* What is bad now among the triangles of the own tiles. All of these are here, as they are in the mesh of one process;
 * of the others some are. */
static enum tri_status find_own_work(struct par_ranks *r, struct tri_error *error)
{
    struct par_run *state = r->state;
    const struct par_territory *t = &r->territory;
    par_room_mark(&state->spare, state->mesh, &state->executor);
    enum tri_status status = par_worklist_fill(&state->worklist, state->mesh, state->quality, false, &state->executor,
                                               &state->radius, error);
    if (!status)
        status = par_park_expect(state->park, state->mesh, par_order_bytes(&state->worklist), error);
    bool memory = status || par_order_by_tile(state, t->partition, par_first_block(t, t->rank),
                                              par_first_block(t, t->rank + 1));
    return memory ? status : par_ranks_no_memory(error);
}

/* The schedule for what the state asks for then, from its beginning, or from where it stands on. Collective. */
static enum tri_status run_second(struct par_ranks *r, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    r->state->quality = r->state->then;
    r->state->n_schedules++;
    if (r->state->next == PAR_SIZES_PHASE) {
        r->state->next = PAR_BOUNDS_PHASE;
        r->state->round = r->state->phase = 0;
        status = par_agree(r->carrier, find_own_work(r, error), error);
    }
    return status ? status : run_schedule(r, error);
}

/* Collective, from an agreement to another. */
static enum tri_status refine_all(struct par_ranks *r, struct par_tiles *tiles, struct tri_error *error)
{
    enum tri_status status = begin(r, error);
    const bool is_second = r->state->then && r->state->next == PAR_BOUNDS_PHASE;
    if (!status && !is_second)
        status = run_schedule(r, error);
    if (!status && r->state->then)
        status = run_second(r, error);
    status = add_up(r, status, error);
    return par_hand_out_on_ranks(r, tiles, status, error);
}

static bool init(struct par_ranks *r, const struct par_partition *partition)
{
    size_t n = (size_t)r->carrier->n_ranks;
    r->lent = calloc(n, sizeof *r->lent);
    r->borrowed = calloc(n, sizeof *r->borrowed);
    r->out = calloc(n, sizeof *r->out);
    r->in = calloc(n, sizeof *r->in);
    return par_territory_init(&r->territory, partition, r->carrier) && r->lent && r->borrowed && r->out && r->in &&
           tell_keys(r->state);
}

static void clean_up(struct par_ranks *r)
{
    par_bytes_free(r->out, r->carrier->n_ranks);
    par_bytes_free(r->in, r->carrier->n_ranks);
    par_territory_free(&r->territory);
    free(r->straddlers.item);
    free(r->places.id);
    free(r->triangles.id);
    free(r->lent);
    free(r->borrowed);
    free(r->out);
    free(r->in);
}

enum tri_status par_refine_on_ranks(struct par_run *state, const struct par_partition *partition,
                                    struct par_tiles *tiles, struct tri_error *error)
{
    struct par_carrier *carrier = state->options->carrier;
    struct par_ranks r = {.state = state, .carrier = carrier, .n_common = state->mesh->n_vertices};
    state->next = state->then ? PAR_SIZES_PHASE : PAR_BOUNDS_PHASE;
    state->round = state->phase = state->step = 0;
    state->n_schedules++;
    bool memory = init(&r, partition);
    r.before = state->report->total;
    r.left_before = state->report->left_over;
    r.rounds_before = state->report->rounds;
    r.run = par_state_run(state);
    enum tri_status status = par_agree(carrier, memory ? TRI_OK : par_ranks_no_memory(error), error);
    if (!status)
        status = refine_all(&r, tiles, error);
    if (state->options->checkpoint)
        state->mesh->stop = state->options->checkpoint->stop;
    clean_up(&r);
    return status;
}
