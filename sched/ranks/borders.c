/* Even columns at the borders of ranks. What is left to do there lies close to the border, where odd columns meet; so
 * only a strip around it moves: as wide as the entries of the worklist reach, and a little more. The left rank refines
 * it as if the strip were all of the column. Where a cavity would have reached beyond the strip, but not beyond its
 * block, that was wrong: then everything is put back as it was, and done again with a strip twice as wide. */
#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "sched/ranks/fragment.h"
#include "sched/ranks/ranks.h"

/* So much wider than what is to be refined. */
static const double SLACK = 1.25;

enum side { LEFT, RIGHT };

struct borders {
    struct par_ranks *ranks;
    int neighbour[2];       /* the rank beyond, or -1 */
    int32_t column[2];      /* the even column there */
    double width[2];        /* of the strip, to either side of the border; < 0: nothing is to be done there any more */
    struct tri_fence *known; /* [blocks] */
    struct par_bytes backup;
    struct tri_refine_report before;
    int32_t blocks_before;
    int64_t *all;           /* [n_ranks][2] what ranks tell each other */
};

static double place_of(const struct borders *b, enum side side)
{
    return par_fence(b->ranks->partition, b->column[side] + 1, 0).x_min;
}

static struct tri_fence strip_of(const struct borders *b, enum side side)
{
    struct tri_fence strip = par_fence(b->ranks->partition, b->column[side], 0);
    double x = place_of(b, side), low = x - b->width[side], high = x + b->width[side];
    strip.x_min = low > strip.x_min ? low : strip.x_min;
    strip.x_max = high < strip.x_max ? high : strip.x_max;
    strip.y_min = -HUGE_VAL;
    strip.y_max = HUGE_VAL;
    return strip;
}

/* What the right rank has of it. */
static struct tri_fence right_half(const struct borders *b, enum side side)
{
    struct tri_fence half = strip_of(b, side);
    half.x_min = place_of(b, side);
    return half;
}

/* --- how wide */

static bool is_of_column(const struct par_ranks *r, int32_t column, int32_t t)
{
    for (int phase = 2; phase < PAR_PHASES; phase++) {
        int32_t block = par_owner_of(r->partition, phase, r->state->mesh, t);
        if (block != TRI_NONE && block / r->partition->n_rows == column)
            return true;
    }
    return false;
}

/* How far from a border the entries reach that its column will take; < 0: there are none. */
static double reach_of(const struct borders *b, enum side side)
{
    const struct par_ranks *r = b->ranks;
    const struct tri_mesh *mesh = r->state->mesh;
    double reach = -1, x = b->neighbour[side] >= 0 ? place_of(b, side) : 0;
    for (int32_t i = 0; b->neighbour[side] >= 0 && i < r->state->worklist.n; i++) {
        int32_t t = r->state->worklist.item[i];
        if (!is_of_column(r, b->column[side], t))
            continue;
        for (int k = 0; k < 3; k++)
            reach = fmax(reach, fabs(mesh->xy[mesh->tri[t].v[k]].x - x));
    }
    return reach;
}

/* Both ranks at a border take the larger of their widths. Collective. */
static enum tri_status agree_on_widths(struct borders *b, enum tri_status status, struct tri_error *error)
{
    int64_t mine[2];
    for (enum side side = LEFT; side <= RIGHT; side++)
        b->width[side] = reach_of(b, side);
    memcpy(mine, b->width, sizeof mine);
    status = par_gather(b->ranks->carrier, mine, 2, b->all, status, error);
    for (enum side side = LEFT; !status && side <= RIGHT; side++) {
        double theirs = -1;
        if (b->neighbour[side] >= 0)
            memcpy(&theirs, &b->all[2 * b->neighbour[side] + (1 - side)], sizeof theirs);
        b->width[side] = SLACK * fmax(b->width[side], theirs);
    }
    return status;
}

/* --- one attempt */

static void know_strip(struct borders *b)
{
    const struct par_partition *p = b->ranks->partition;
    const struct tri_fence strip = strip_of(b, RIGHT);
    for (int32_t row = 0; row < p->n_rows; row++) {
        struct tri_fence box = par_fence(p, b->column[RIGHT], row);
        box.x_min = strip.x_min;
        box.x_max = strip.x_max;
        b->known[b->column[RIGHT] * p->n_rows + row] = box;
    }
}

static enum tri_status attempt(struct borders *b, struct tri_error *error)
{
    struct par_state *state = b->ranks->state;
    const struct tri_fence strip = strip_of(b, RIGHT);
    b->before = state->report->total;
    b->blocks_before = state->report->n_blocks;
    enum tri_status status = par_fragment_cut(&b->backup, state, b->ranks->n_common, &strip, error);
    know_strip(b);
    state->known = b->known;
    status = status ? status : par_ranks_column(b->ranks, b->column[RIGHT], error);
    state->known = NULL;
    return status;
}

static bool was_short(const struct borders *b)
{
    return b->ranks->state->report->total.short_of > b->before.short_of;
}

static enum tri_status put_back(struct borders *b, struct tri_error *error)
{
    size_t used;
    struct par_report *report = b->ranks->state->report;
    report->total = b->before;
    report->n_blocks = b->blocks_before;
    return par_fragment_paste(b->ranks->state, b->ranks->n_common, b->backup.at, b->backup.n, &used, error);
}

/* Ends it on the left rank: what was right goes back to the right rank. */
static enum tri_status conclude(struct borders *b, bool is_short, struct tri_error *error)
{
    const struct tri_fence half = right_half(b, RIGHT);
    enum tri_status status = TRI_OK;
    if (is_short)
        status = put_back(b, error);
    else
        status = par_ranks_cut(b->ranks, b->neighbour[RIGHT], &half, error);
    b->backup.n = 0;
    b->width[RIGHT] = is_short ? 2 * b->width[RIGHT] : -1;
    return status;
}

/* Every border that is not done yet, once; *again: one must be done again. Collective. */
static enum tri_status try_all(struct borders *b, bool *again, struct tri_error *error)
{
    struct par_ranks *r = b->ranks;
    bool sends = b->width[LEFT] >= 0, works = b->width[RIGHT] >= 0;
    enum tri_status status = TRI_OK;
    if (sends) {
        const struct tri_fence half = right_half(b, LEFT);
        status = par_ranks_cut(r, b->neighbour[LEFT], &half, error);
    }
    status = par_ranks_swap(r, PAR_MOVE_STRIPS, status, error);
    if (!status && works)
        status = attempt(b, error);
    int64_t mine = !status && works && was_short(b);
    status = par_gather(r->carrier, &mine, 1, b->all, status, error);
    *again = false;
    for (int p = 0; !status && p < r->carrier->n_ranks; p++)
        *again |= b->all[p] != 0;
    if (!status && sends)
        b->width[LEFT] = b->all[b->neighbour[LEFT]] ? 2 * b->width[LEFT] : -1;
    if (!status && works)
        status = conclude(b, mine, error);
    return par_ranks_swap(r, PAR_MOVE_BACK, status, error);
}

static void find_neighbours(struct borders *b)
{
    const struct par_ranks *r = b->ranks;
    int32_t first = r->start[r->carrier->rank], end = r->start[r->carrier->rank + 1];
    b->neighbour[LEFT] = first < end && first > 0 ? par_owner_of_column(r, first - 1) : -1;
    b->neighbour[RIGHT] = first < end && end < r->n_odd ? par_owner_of_column(r, end) : -1;
    b->column[LEFT] = 2 * first;
    b->column[RIGHT] = 2 * end;
}

enum tri_status par_ranks_borders(struct par_ranks *r, enum tri_status status, struct tri_error *error)
{
    struct borders b = {.ranks = r};
    bool again = true;
    find_neighbours(&b);
    b.known = malloc((size_t)par_blocks(r->partition) * sizeof *b.known);
    b.all = malloc(2 * (size_t)r->carrier->n_ranks * sizeof *b.all);
    if (!status && !(b.known && b.all))
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the borders of a rank");
    status = agree_on_widths(&b, status, error);
    while (!status && again)
        status = try_all(&b, &again, error);
    free(b.known);
    free(b.all);
    free(b.backup.at);
    return status;
}
