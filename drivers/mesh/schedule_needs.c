/* Estimates what a run of the schedule needs, from the needs that sched/ and the writers state. */
#include <math.h>

#include "drivers/mesh/needs.h"
#include "sched/schedule/partition.h"
#include "sched/tiles/numbering.h"
#include "sched/tunables.h"
#include "triangle/text/stream.h"

/* Measured bytes: buffers and libraries; pages of files being written, per thread; and pieces of files that pass
 * through the first of several tasks. */
static const double BUFFERS = 3e7, PAGES = 3e7, PIECES = 3.5e7;

/* Returns the approximate number of triangles in a column of cells. The memory of a sweep grows with this number. */
static double column_of(double triangles) { return sqrt(triangles * par_triangles_in_cell(triangles)); }

/* Returns the peak memory of a mesh that grows by `grown` triangles, of which areas require `demand`. */
static double bytes_whole(const struct run *run, double grown, double demand)
{
    const double places = grown + PAR_EMPTY_PLACES * fmax(grown - demand, 0), all = run->mesh.n_triangles + places;
    const double each = estimate_bytes_each(run);
    const double refined = places * each + par_number_bytes(all, all / 2, run->mesh.n_subs);
    return fmax(refined, grown * each + estimate_bytes_beside(run, grown));
}

/* Returns the least memory, if data can be moved to files. */
static double floor_of(const struct run *run, double held, double work)
{
    return estimate_can_park(run, held) ? fmin(held, BUFFERS + work + PAGES * run->settings.threads) : held;
}

/* Finds the needs of the rank that needs most. */
static void find_needs_of_rank(const struct run *run, double grown, struct needs *n)
{
    const double own = fmin(PAR_RANK_BUSIEST * grown / run->settings.n_ranks, grown);
    const double columns = fmin(PAR_RANK_COLUMN * column_of(grown), PAR_RANK_WORK * own);
    n->whole = own * PAR_RANK_BYTES;
    n->held = n->whole + BUFFERS;
    n->floor = floor_of(run, n->held, PIECES + columns + PAR_RANK_COARSE * grown);
    n->away = PAR_PARKED_BYTES * own;
    n->checkpoint = n->states = PAR_RANK_STATES * grown;
}

static void find_needs_of_sweep(const struct run *run, double grown, struct needs *n)
{
    const double column = column_of(grown), coarse = PAR_SWEEP_COARSE * grown;
    n->held = BUFFERS + PAR_SWEEP_HELD * column + coarse;
    n->floor = floor_of(run, n->held, PAR_SWEEP_WORK * column + coarse);
    n->away = PAR_SWEEP_AWAY * column;
    n->checkpoint = PAR_TILES_BYTES * grown + PAR_SWEEP_STATES * column;
}

void schedule_needs(const struct run *run, bool sweeps, double grown, double demand, struct needs *n)
{
    const struct long_options *o = run->settings.options;
    if (run->settings.n_ranks > 0 && sweeps) {
        find_needs_of_rank(run, grown, n);
        return;
    }
    if (demand >= 0 && run->options.refine)
        n->whole = bytes_whole(run, grown, demand);
    n->held = n->whole;
    n->floor = floor_of(run, n->held, PAR_PARKED_WORK * grown);
    n->away = PAR_PARKED_BYTES * grown;
    n->filed = floor_of(run, n->whole, PAR_PARKED_WORK * grown + estimate_bytes_beside(run, grown));
    n->filed_away = (PAR_PARKED_BYTES + TRI_EDGE_LIST_BYTES + TRI_EDGE_NUMBERS_BYTES) * grown;
    n->kept = o->n_exports > 0 ? (TRI_TILE_STORE_BYTES + (o->n_parts > 0 ? TRI_TILE_STORE_PART_BYTES : 0)) * grown : 0;
    n->checkpoint = n->states = PAR_WHOLE_STATES * grown;
    if (sweeps)
        find_needs_of_sweep(run, grown, n);
}
