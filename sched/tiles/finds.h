/* Finds the vertices, triangles or subsegments of a column of tiles in parallel.
 *
 * Each task searches one share of the mesh and collects ids in ascending order, optionally with a number (a note) for
 * each. The ids are then sorted by tile. After their tiles have been handed out, they become ranges of free ids. The
 * task also lists the free ids that it meets, so that free ids of several columns join into long ranges. */
#ifndef SCHED_TILES_FINDS_H
#define SCHED_TILES_FINDS_H

#include "sched/schedule/room.h"
#include "sched/schedule/worklist.h"
#include "triangle/base/executor.h"
#include "triangle/base/grow.h"

enum { PAR_FIND_SHARES = TRI_MOST_SHARES };

/* Consecutive ids of a list that belong to one row of tiles. Neighbours in a list mostly do. */
struct par_span {
    int32_t row; /* row of the tile in its column */
    int32_t n;   /* number of ids */
};

struct par_runs {
    struct par_span *item; /* [n] in the order of the list */
    int32_t n, capacity;   /* spans used and allocated */
};

struct par_finds {
    struct par_ids found[PAR_FIND_SHARES]; /* ids found by each share, ascending */
    struct par_ids notes[PAR_FIND_SHARES]; /* the note of each id in `found`; empty: the ids have no notes */
    struct par_runs runs[PAR_FIND_SHARES]; /* the rows of the ids in `found` */
    struct par_ranges gaps[PAR_FIND_SHARES]; /* ranges of free ids that each share met */
    int32_t n_rows; /* tiles of the column */
    int32_t *count; /* [shares][n_rows] ids that a share found in a row; in par_finds_deal: the next index in `item` */
    int32_t *item;  /* [n] all ids, row by row, ascending in each row; NULL: not sorted yet */
    int32_t *note;  /* [n] the note of each id in `item`; unused if the ids have no notes */
    int32_t *start; /* [n_rows + 1] index in `item` of the first id of each row */
    int32_t n;      /* ids in `item` */
};

/* Initialises *finds. False: no memory. Call par_finds_free in any case. */
bool par_finds_begin(struct par_finds *finds, int32_t n_rows);
void par_finds_free(struct par_finds *finds);

/* Frees all lists. Keeps n, n_rows and start. */
void par_finds_forget(struct par_finds *finds);

/* Returns the range of ids that a share searches. n: ids in the mesh. */
static inline struct tri_range par_finds_share(size_t share, int32_t n)
{
    return tri_share_of(share, PAR_FIND_SHARES, n);
}

/* The search of one share. Its lists are copied to *finds only at the end, so that threads do not share cache lines. */
struct par_finder {
    struct par_finds *finds; /* receives the lists */
    size_t share;            /* index of the share */
    struct par_ids list;     /* ids found so far */
    struct par_ids notes;    /* the note of each id; empty: the ids have no notes */
    struct par_runs runs;    /* completed spans of `list` */
    struct par_span last;    /* the current span, which is not yet in `runs`; n 0: there is none */
    struct par_ranges gaps;  /* ranges of free ids met so far */
    bool no_memory;          /* an allocation has failed */
};

static inline struct par_finder par_finder_of(struct par_finds *finds, size_t share)
{
    return (struct par_finder){.finds = finds, .share = share};
}

/* Completes the current span. */
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

/* Appends an item to `list`, which is f->list or f->notes. */
static inline void par_finder_add(struct par_finder *f, struct par_ids *list, int32_t item)
{
    if (list->n < list->capacity)
        list->item[list->n++] = item;
    else if (!par_ids_add(list, item))
        f->no_memory = true;
}

/* Adds an id that belongs to a row. */
static inline void par_find(struct par_finder *f, int32_t item, int32_t row)
{
    if (row != f->last.row) {
        par_finder_count(f);
        f->last.row = row;
    }
    f->last.n++;
    par_finder_add(f, &f->list, item);
}

/* Adds an id with a note. All ids of a share must then have notes. */
static inline void par_find_noted(struct par_finder *f, int32_t item, int32_t row, int32_t note)
{
    par_find(f, item, row);
    par_finder_add(f, &f->notes, note);
}

/* Adds a free id. */
static inline void par_find_gap(struct par_finder *f, int32_t item)
{
    f->no_memory |= !par_ranges_add(&f->gaps, item);
}

/* Ends the search and moves the lists to f->finds. False: no memory. */
static inline bool par_finder_end(struct par_finder *f)
{
    par_finder_count(f);
    f->finds->gaps[f->share] = f->gaps;
    f->finds->found[f->share] = f->list;
    f->finds->notes[f->share] = f->notes;
    f->finds->runs[f->share] = f->runs;
    return !f->no_memory;
}

/* Sorts all ids that were found by row: sets item, note, start and n. False: no memory. */
bool par_finds_deal(struct par_finds *finds, const struct tri_executor *executor);

/* Adds the ids of an ascending list to the gaps of a share. False: no memory. */
bool par_finds_add_gaps(struct par_finds *finds, size_t share, const struct par_ids *list);

/* Replaces the ranges by the gaps of all shares. No range is dealt out. False: no memory. */
bool par_finds_give(const struct par_finds *finds, struct par_ranges *to);

#endif
