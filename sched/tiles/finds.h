/* What shares of the mesh find of one kind in a column of tiles: lists of ids, ascending, that are dealt to the tiles
 * and in the end become ranges of free ids. Ids may come with notes. */
#ifndef SCHED_TILES_FINDS_H
#define SCHED_TILES_FINDS_H

#include "sched/schedule/room.h"
#include "sched/schedule/worklist.h"
#include "triangle/base/executor.h"
#include "triangle/base/grow.h"

enum { PAR_FIND_SHARES = TRI_MOST_SHARES };

/* Neighbours in a list are mostly of one row. */
struct par_span {
    int32_t row, n;
};

struct par_runs {
    struct par_span *item;
    int32_t n, capacity;
};

struct par_finds {
    struct par_ids found[PAR_FIND_SHARES]; /* by each share, in the order of ids */
    struct par_ids notes[PAR_FIND_SHARES]; /* the same of each; none, or of all of them */
    struct par_runs runs[PAR_FIND_SHARES]; /* the rows of these */
    int32_t n_rows;
    int32_t *count; /* [shares][n_rows] of what a share has found in a row; then where the next one goes */
    int32_t *item;  /* [n] row by row, each in the order of ids */
    int32_t *note;  /* [n] of these, where they have any */
    int32_t *start; /* [n_rows + 1] */
    int32_t n;
};

/* False: no memory. To be freed in any case. */
bool par_finds_begin(struct par_finds *finds, int32_t n_rows);
void par_finds_free(struct par_finds *finds);

/* What has been dealt goes, but for how much it was: n, n_rows, start. */
void par_finds_forget(struct par_finds *finds);

/* The ids that a share looks at. */
static inline struct tri_range par_finds_share(size_t share, int32_t n)
{
    return tri_share_of(share, PAR_FIND_SHARES, n);
}

/* One share at work, by itself: what it finds the others see at the end, so that no cache line goes to and fro. */
struct par_finder {
    struct par_finds *finds;
    size_t share;
    struct par_ids list, notes;
    struct par_runs runs;
    struct par_span last; /* the run of the last ones, which has not been counted */
    bool no_memory;
};

static inline struct par_finder par_finder_of(struct par_finds *finds, size_t share)
{
    return (struct par_finder){.finds = finds, .share = share};
}

/* The last run is over. */
static inline void par_finder_count(struct par_finder *f)
{
    if (f->last.n == 0)
        return;
    f->finds->count[f->share * (size_t)f->finds->n_rows + (size_t)f->last.row] += f->last.n;
    if (tri_grow(&f->runs.item, &f->runs.capacity, f->runs.n + 1, sizeof *f->runs.item))
        f->runs.item[f->runs.n++] = f->last;
    else
        f->no_memory = true;
    f->last.n = 0;
}

static inline void par_finder_add(struct par_finder *f, struct par_ids *list, int32_t item)
{
    if (list->n < list->capacity)
        list->item[list->n++] = item;
    else if (!par_ids_add(list, item))
        f->no_memory = true;
}

static inline void par_find(struct par_finder *f, int32_t item, int32_t row)
{
    if (row != f->last.row) {
        par_finder_count(f);
        f->last.row = row;
    }
    f->last.n++;
    par_finder_add(f, &f->list, item);
}

/* With a note; each has one then. */
static inline void par_find_noted(struct par_finder *f, int32_t item, int32_t row, int32_t note)
{
    par_find(f, item, row);
    par_finder_add(f, &f->notes, note);
}

/* False: no memory. */
static inline bool par_finder_end(struct par_finder *f)
{
    par_finder_count(f);
    f->finds->found[f->share] = f->list;
    f->finds->notes[f->share] = f->notes;
    f->finds->runs[f->share] = f->runs;
    return !f->no_memory;
}

/* Deals what has been found to the rows: item, note and start. False: no memory. */
bool par_finds_deal(struct par_finds *finds, const struct tri_executor *executor);

/* Replaces a list of ids, ascending, by its runs: first and end of one, then of the next. Short ones are left out, so
 * that the runs take no more room than the ids did: no memory is asked for, and each share does it by itself. */
void par_finds_to_runs(struct par_ids *list);

/* Adds runs, as par_finds_to_runs leaves them, to ranges; false: no memory. */
bool par_finds_add_runs(const struct par_ids *runs, struct par_ranges *to);

/* The same with those of all shares. */
bool par_finds_give(const struct par_finds *finds, struct par_ranges *to);

#endif
