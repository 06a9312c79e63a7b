/* The steps of the schedule that differ on ranks. The rounds are those of sched/schedule/schedule.c.
 *
 * ALGORITHM. Before a step of a phase, all ranks agree which rank refines each border block (a block over the tiles of
 * several ranks). This assignment is a shift. The other owners lend the triangles that the block needs. The worker
 * refines the block, requests more ghost layers if a cavity reaches beyond them, and gives back the changed triangles.
 * The last call is a shift of one block, the whole plane. Chernikov and Chrisochoides (ICS 2004, section 3) move strips
 * between neighbours at the same points of the schedule.
 *
 * INVARIANT. The invariant of ranks.h holds before and after each shift. */
#include "sched/ranks/ranks.h"

#include <assert.h>
#include <stdlib.h>

#include "sched/checkpoint/state.h"
#include "sched/tiles/sweep.h"
#include "sched/tunables.h"
#include "triangle/base/grow.h"

/* --- the assignment of blocks to ranks */

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

/* Does the block belong to the shift's step of its phase? */
static bool has_its_turn(const struct par_shift *shift, int32_t block)
{
    const struct par_partition *p = shift->partition;
    if (!p)
        return true;
    int32_t column = block / p->n_rows, row = block % p->n_rows;
    return column % 2 == 1 - shift->phase / 2 && row % 2 == 1 - shift->phase % 2 &&
           (column / 2 * ((p->n_rows + 1) / 2) + row / 2) % shift->n_steps == shift->step;
}

/* Allocates the arrays of r->shift, whose other members are set. False: no memory. */
static bool init_shift(struct par_ranks *r)
{
    struct par_shift *s = &r->shift;
    size_t n = (size_t)blocks_of(s);
    assert(!s->worker && !s->block_of);
    s->worker = malloc(n * sizeof *s->worker);
    s->is_mine = calloc(n, sizeof *s->is_mine);
    s->is_border = calloc(n, sizeof *s->is_border);
    s->block_of = malloc(((size_t)r->run->worklist.n + 1) * sizeof *s->block_of);
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

/* Sets worker[b] to the lowest rank that owns a part of block b, if several ranks do; otherwise to -1. Returns whether
 * there is such a block. All ranks compute the same. */
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

/* Sets block_of[], and the bit of each border block that contains an entry of this rank's worklist. */
static void find_work(struct par_ranks *r, int64_t *word)
{
    const struct par_run *run = r->run;
    struct par_shift *s = &r->shift;
    struct par_locator locator = PAR_LOST;
    for (int32_t i = 0; i < run->worklist.n; i++) {
        tri_triangle_id t = run->worklist.item[i];
        assert(tri_is_live(&run->mesh->tri[t]));
        int32_t b = s->partition ? par_locate_owner(&locator, s->partition, s->phase, run->mesh, t) : 0;
        s->block_of[i] = b;
        if (b != TRI_NONE && s->worker[b] >= 0)
            word[b / 64] |= (int64_t)((uint64_t)1 << b % 64);
    }
}

/* Is bit b set? */
static bool is_in(const int64_t *word, int32_t b) { return (uint64_t)word[b / 64] >> b % 64 & 1; }

/* Completes the shift. word: the border blocks that contain an entry of any rank's worklist. A border block
 * without entries needs no worker. */
static void assign_blocks(struct par_ranks *r, const int64_t *word)
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

/* Collective: makes the shift. *any: some border block has work, so ranks must lend triangles. */
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
        assign_blocks(r, mine);
    free(mine);
    free(all);
    return status;
}

/* --- exchanges */

/* Collective: an exchange of messages. Later rounds and the last call are counted under PAR_MOVE_LEFT_OVER. */
static enum tri_status swap_bytes(struct par_ranks *r, enum par_move move, enum tri_status status,
                                  struct tri_error *error)
{
    const bool is_left_over = r->run->place.round > 0 || !r->shift.partition;
    return par_swap(r->carrier, is_left_over ? PAR_MOVE_LEFT_OVER : move, r->out, r->in, status, error);
}

/* Frees the received messages. */
static void free_in(struct par_ranks *r) { par_bytes_free(r->in, r->carrier->n_ranks); }

/* Collective: each rank requests the triangles around some vertices, and answers the requests of other ranks. *any: a
 * rank has requested some, and has received them. */
static enum tri_status lend_more(struct par_ranks *r, const struct par_ids *asked, bool *any,
                                 enum tri_status status, struct tri_error *error)
{
    int64_t n = asked->n, sum;
    status = par_sum(r->carrier, &n, 1, &sum, status, error);
    *any = !status && sum > 0;
    if (!*any)
        return status;
    status = par_request_layers(r, asked, error);
    status = swap_bytes(r, PAR_MOVE_BORDERS, status, error);
    status = status ? status : par_lend_more(r, error);
    free_in(r);
    status = swap_bytes(r, PAR_MOVE_BORDERS, status, error);
    bool came = n == 0;
    for (int p = 0; p < r->carrier->n_ranks; p++)
        came = came || r->in[p].n > 0;
    if (!status && !came)
        status = tri_fail(error, TRI_INTERNAL, NULL, 0, "no rank holds the neighbour of an edge");
    status = status ? status : par_borrow(r, error);
    free_in(r);
    return status;
}

/* Is the triangle in a border block that this rank refines? */
static bool is_in_own_border_block(const struct par_ranks *r, tri_triangle_id t)
{
    const struct par_shift *s = &r->shift;
    int32_t block = s->partition ? par_owner_of(s->partition, s->phase, r->run->mesh, t) : 0;
    return block != TRI_NONE && s->is_border[block];
}

/* Adds to *asked the ends of edges of worklist triangles in this rank's border blocks whose neighbours are missing.
 * This happens if the lender of an entry does not own all corners of its triangle: the owners of the other corners may
 * not have the entry, and then send no layers around it. False: no memory. */
static bool find_unknown(const struct par_ranks *r, struct par_ids *asked)
{
    const struct par_ids *list = &r->run->worklist;
    bool memory = true;
    for (int32_t i = 0; i < list->n; i++) {
        const struct tri_triangle *t = &r->run->mesh->tri[list->item[i]];
        for (int e = 0; memory && e < 3; e++)
            if (t->n[e] == TRI_BEYOND && is_in_own_border_block(r, list->item[i]))
                memory = par_ids_add(asked, t->v[tri_next[e]]) && par_ids_add(asked, t->v[tri_prev[e]]);
    }
    return memory;
}

/* Collective: lends the triangles around the entries of border blocks to the workers. */
static enum tri_status lend(struct par_ranks *r, struct tri_error *error)
{
    struct par_ids asked = {0};
    bool any;
    enum tri_status status = par_index_straddlers(r) ? TRI_OK : par_ranks_no_memory(error);
    status = status ? status : par_lend(r, error);
    status = swap_bytes(r, PAR_MOVE_BORDERS, status, error);
    status = status ? status : par_borrow(r, error);
    free_in(r);
    if (!status && !find_unknown(r, &asked))
        status = par_ranks_no_memory(error);
    status = lend_more(r, &asked, &any, status, error);
    free(asked.item);
    return status;
}

/* The function `more` of struct par_share: fetches the triangles for which border blocks pause. Collective: ranks
 * without such blocks take part from serve_others. */
static enum tri_status fetch_more(void *user, const struct par_ids *asked, struct tri_error *error)
{
    bool any;
    return lend_more(user, asked, &any, TRI_OK, error);
}

/* Collective: answers requests of other ranks until no rank has any. status: this rank's status so far. */
static enum tri_status serve_others(struct par_ranks *r, enum tri_status status, struct tri_error *error)
{
    static const struct par_ids nothing;
    bool any = true;
    while (any)
        status = lend_more(r, &nothing, &any, status, error);
    return status;
}

/* Collective: returns the changes to the owners and drops the borrowed triangles. */
static enum tri_status give_back(struct par_ranks *r, enum tri_status status, struct tri_error *error)
{
    status = status ? status : par_give_back(r, &r->shift.changed, error);
    status = swap_bytes(r, PAR_MOVE_BACK, status, error);
    status = status ? status : par_take_back(r, error);
    free_in(r);
    for (int p = 0; p < r->carrier->n_ranks; p++) {
        par_talk_free(&r->lent[p]);
        par_talk_free(&r->borrowed[p]);
    }
    return status;
}

/* Collective: borrows, refines the blocks of a shift on this rank, and gives back. refine: not collective, except for
 * calls of fetch_more. */
static enum tri_status work_shift(struct par_ranks *r, struct par_shift shift,
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
        status = serve_others(r, status, error);
        status = give_back(r, status, error);
    }
    free_shift(&r->shift);
    return status;
}

/* --- phases */

/* Returns the number of steps of a phase; a checkpoint can be written after each. Independent of the number of ranks.
 * */
static int32_t steps_of(const struct par_ranks *r, const struct par_partition *partition)
{
    int32_t steps = par_blocks(partition) / PAR_PHASES / PAR_BLOCKS_A_STEP;
    if (!r->run->asked.options->checkpoint || steps < 1)
        return 1;
    return steps < PAR_MOST_STEPS ? steps : PAR_MOST_STEPS;
}

/* Refines this rank's blocks of the shift: inner blocks, and border blocks with borrowed triangles. */
static enum tri_status refine_step(struct par_ranks *r, struct tri_error *error)
{
    struct par_share share = {.is_mine = r->shift.is_mine, .is_border = r->shift.is_border, .more = fetch_more,
                              .user = r};
    const struct par_turn turn = {.partition = r->shift.partition, .only = TRI_NONE, .share = &share};
    par_report_phase(r->run, r->run->place.phase + 1);
    enum tri_status status = par_phase(r->run, &turn, error);
    r->shift.changed = share.changed;
    return status;
}

/* Collective: runs the current phase from the step of run->place to its end. */
static enum tri_status run_phase(void *self, struct tri_error *error)
{
    const struct par_schedule *s = self;
    struct par_ranks *r = s->run->ranks;
    struct par_position *place = &s->run->place;
    const int32_t n_steps = steps_of(r, &s->partition);
    enum tri_status status = TRI_OK;
    do {
        const struct par_shift shift = {.partition = &s->partition, .phase = place->phase, .step = place->step,
                                        .n_steps = n_steps};
        status = work_shift(r, shift, refine_step, error);
        place->step = (place->step + 1) % n_steps;
        place->phase += place->step == 0;
        status = par_offer_checkpoint(r, status, error);
    } while (!status && place->step > 0);
    return status;
}

/* Collective: adds up the worklist entries of all ranks. An entry that several ranks hold is counted several times. */
static enum tri_status end_round(void *self, bool *again, struct tri_error *error)
{
    struct par_schedule *s = self;
    int64_t mine = s->run->worklist.n;
    enum tri_status status = par_sum(s->run->asked.options->carrier, &mine, 1, &s->left, TRI_OK, error);
    *again = !status && par_next_round(s);
    return status;
}

const struct par_steps par_steps_on_ranks = {run_phase, end_round};

/* --- the last call */

struct last_call {
    struct par_ranks *ranks; /* this rank */
    struct par_ids asked;    /* ends of edges whose neighbours the call needs */
    bool lost;               /* out of memory in a callback: a list is incomplete */
};

/* Callbacks of struct tri_part, for the last call. */
static void note_changes(void *user, const tri_triangle_id *triangle, int32_t n)
{
    struct last_call *call = user;
    call->lost |= !par_ids_add_all(&call->ranks->shift.changed, triangle, n);
}

static void ask_for(void *user, const tri_vertex_id edge[2])
{
    struct last_call *call = user;
    call->lost |= !par_ids_add_all(&call->asked, edge, 2);
}

/* The callback `more` of par_refine_rest. */
static enum tri_status fetch_asked(void *user, struct tri_error *error)
{
    struct last_call *call = user;
    if (call->lost)
        return par_ranks_no_memory(error);
    enum tri_status status = fetch_more(call->ranks, &call->asked, error);
    call->asked.n = 0;
    return status;
}

/* Refines the remaining worklist by one call without fences, as one process does. The lowest rank that owns a
 * tile does this, since it has borrowed the entries of the others, whose worklists are now empty. */
static enum tri_status refine_left(struct par_ranks *r, struct tri_error *error)
{
    struct par_run *run = r->run;
    struct last_call call = {.ranks = r};
    const struct tri_part part = {note_changes, ask_for, &call};
    const struct tri_refine_hooks hooks = {
        .worklist = run->worklist.item, .n_worklist = run->worklist.n, .part = &part};
    if (run->worklist.n == 0)
        return TRI_OK;
    enum tri_status status = par_refine_rest(run, &hooks, fetch_asked, &call, error);
    assert(run->worklist.item == hooks.worklist); /* only the first exchange of a shift brings entries */
    free(call.asked.item);
    run->worklist.n = run->key.n = 0;
    return status || !call.lost ? status : par_ranks_no_memory(error);
}

enum tri_status par_refine_rest_on_ranks(struct par_run *run, struct tri_error *error)
{
    struct par_ranks *r = run->ranks;
    enum tri_status status = work_shift(r, (struct par_shift){.n_steps = 1}, refine_left, error);
    par_go(run, par_is_of_sizes(run->place.next) ? PAR_BOUNDS_WHOLE : PAR_HAND_OUT);
    return par_offer_checkpoint(r, status, error);
}

/* --- beginning and end */

/* Sets the keys of a worklist without keys, which no phase has processed: entry i gets key i. False: no memory. */
static bool write_keys(struct par_run *run)
{
    struct par_keys *key = &run->key;
    if (key->n == run->worklist.n)
        return true;
    assert(key->n == 0);
    if (!tri_grow(&key->item, &key->capacity, run->worklist.n, sizeof *key->item))
        return false;
    for (; key->n < run->worklist.n; key->n++)
        key->item[key->n] = (uint64_t)key->n;
    return true;
}

void par_count_done(const struct par_ranks *r, int64_t done[PAR_DONE])
{
    const struct tri_refine_report *total = &r->run->report->total, *before = &r->before;
    done[0] = total->inserted_free - before->inserted_free;
    done[1] = total->inserted_on_segments - before->inserted_on_segments;
    done[2] = total->fenced - before->fenced;
    for (int k = 0; k < TRI_EXCUSES; k++)
        done[3 + k] = total->given_up[k] - before->given_up[k];
}

void par_add_done(struct par_ranks *r, const int64_t done[PAR_DONE])
{
    struct tri_refine_report *total = &r->run->report->total;
    total->inserted_free += done[0];
    total->inserted_on_segments += done[1];
    total->fenced += done[2];
    for (int k = 0; k < TRI_EXCUSES; k++)
        total->given_up[k] += done[3 + k];
}

/* Collective: adds the counters of all ranks since par_ranks_begin to the report of each. */
static enum tri_status add_up(struct par_ranks *r, enum tri_status status, struct tri_error *error)
{
    struct par_report *report = r->run->report;
    int64_t mine[PAR_DONE], sum[PAR_DONE];
    par_count_done(r, mine);
    status = par_sum(r->carrier, mine, PAR_DONE, sum, status, error);
    if (status)
        return status;
    report->total = r->before;
    par_add_done(r, sum);
    report->deferred += sum[2];
    par_forget_deferred(report);
    return TRI_OK;
}

/* Collective: reduces the coarse mesh to this rank's part, or restores that part from a checkpoint. */
static enum tri_status make_own_part(struct par_ranks *r, struct tri_error *error)
{
    bool again;
    const char *words = "the ranks were given different inputs or settings";
    const bool is_of_sizes = par_is_of_sizes(r->run->place.next);
    enum tri_status status = par_expect_same(r->carrier, r->of_run, words, TRI_OK, error);
    status = status ? status : par_resume(r, &again, error);
    status = status || again ? status : par_keep_own(r, error);
    r->run->n_schedules += is_of_sizes && r->run->place.next > PAR_BOUNDS_WHOLE; /* the second schedule has begun */
    return par_agree(r->carrier, status, error);
}

/* Allocates the arrays. False: no memory. */
static bool init_ranks(struct par_ranks *r)
{
    size_t n = (size_t)r->carrier->n_ranks;
    r->lent = calloc(n, sizeof *r->lent);
    r->borrowed = calloc(n, sizeof *r->borrowed);
    r->out = calloc(n, sizeof *r->out);
    r->in = calloc(n, sizeof *r->in);
    return par_territory_init(&r->territory, &r->run->cells, r->carrier) && r->lent && r->borrowed && r->out && r->in &&
           write_keys(r->run);
}

enum tri_status par_ranks_begin(struct par_run *run, struct tri_error *error)
{
    struct par_carrier *carrier = run->asked.options->carrier;
    struct par_ranks *r = calloc(1, sizeof *r);
    if (r) {
        *r = (struct par_ranks){.run = run, .carrier = carrier, .n_common = run->mesh->n_vertices,
                                .of_run = par_state_run(run), .before = run->report->total,
                                .left_before = run->report->left_over, .rounds_before = run->report->rounds};
        run->ranks = r;
    }
    enum tri_status status = par_agree(carrier, r && init_ranks(r) ? TRI_OK : par_ranks_no_memory(error), error);
    return status ? status : make_own_part(r, error);
}

enum tri_status par_ranks_hand_out(struct par_run *run, enum tri_status status, struct tri_error *error)
{
    struct par_tiles tiles = par_tiles_of(run, &run->cells);
    status = add_up(run->ranks, status, error);
    status = par_hand_out_on_ranks(run->ranks, &tiles, status, error);
    par_tiles_free(&tiles);
    return status;
}

void par_ranks_own_blocks(const struct par_ranks *r, int32_t *first, int32_t *end)
{
    *first = par_first_block(&r->territory, r->territory.rank);
    *end = par_first_block(&r->territory, r->territory.rank + 1);
}

bool par_ranks_end(struct par_run *run)
{
    struct par_ranks *r = run->ranks;
    if (!r)
        return false;
    if (run->asked.options->checkpoint)
        run->mesh->stop = run->asked.options->checkpoint->stop;
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
    free(r);
    run->ranks = NULL;
    return true;
}
