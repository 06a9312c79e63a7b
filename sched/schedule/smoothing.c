#include "sched/schedule/smoothing.h"

#include <stdlib.h>

#include "sched/schedule/deal.h"
#include "sched/tiles/numbering.h"
#include "sched/tiles/park.h"
#include "triangle/refine/smooth.h"

/* A smoothing phase: vertices dealt to its blocks, each of which runs as a task. */
struct smoothing {
    const struct par_run *run; /* the run */
    struct tri_smooth *smooth; /* the smoother, shared by all blocks */
    enum tri_smooth_pass pass; /* what this pass does to vertices */
    int phase;                 /* 0 to 3 */
    tri_vertex_id *vertex;     /* [n] vertices not yet treated in this pass; ascending in the first phase */
    tri_vertex_id *dealt;      /* [n] the same, ordered by block */
    int32_t n;                 /* count of vertices left in this pass */
    struct par_deal deal;      /* counts and places, with blocks of the phase as tiles */
    struct tri_smooth_count *count; /* [blocks] how many vertices each block moved and left */
    enum tri_status *status;   /* [blocks] result of each block */
    int64_t moved;             /* vertices moved so far in this pass */
};

/* A task: sets the block of each vertex of one share. A vertex keeps its block during the phase, even if it moves. */
static void find_homes(void *context, size_t share)
{
    const struct smoothing *s = context;
    const struct tri_mesh *mesh = s->run->mesh;
    const struct tri_range range = tri_share(share, mesh->n_vertices);
    struct par_locator locator = PAR_LOST;
    for (tri_vertex_id v = range.first; v < range.last; v++)
        s->smooth->home[v] = par_locate(&locator, &s->run->cells, s->phase, mesh->xy[v]);
}

/* A task: counts the vertices of one share by block. */
static void count_share(void *context, size_t share)
{
    const struct smoothing *s = context;
    int32_t *count = par_deal_at(&s->deal, share);
    const struct tri_range range = par_deal_share(&s->deal, share);
    for (int32_t i = range.first; i < range.last; i++)
        count[s->smooth->home[s->vertex[i]]]++;
}

/* A task: writes the vertices of one share to their places in `dealt`. */
static void deal_share(void *context, size_t share)
{
    const struct smoothing *s = context;
    int32_t *at = par_deal_at(&s->deal, share);
    const struct tri_range range = par_deal_share(&s->deal, share);
    for (int32_t i = range.first; i < range.last; i++)
        s->dealt[at[s->smooth->home[s->vertex[i]]]++] = s->vertex[i];
}

/* A task: treats the vertices of one block. Moves the vertices that it could not treat to the front
 * of its part of `dealt`. */
static void smooth_block(void *context, size_t block)
{
    const struct smoothing *s = context;
    const int32_t *start = s->deal.start + block;
    s->status[block] = tri_smooth_some(s->smooth, s->pass, s->dealt + start[0], start[1] - start[0], (int32_t)block,
                                       &s->count[block], NULL);
}

/* Called after a phase. Gathers the counts, and the vertices that the blocks left, as the list of the next phase.
 * Returns the first error. */
static enum tri_status gather_left_vertices(struct smoothing *s, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    s->n = 0;
    for (int32_t block = 0; block < s->deal.n_tiles; block++) {
        for (int32_t i = 0; i < s->count[block].left; i++)
            s->vertex[s->n++] = s->dealt[s->deal.start[block] + i];
        s->moved += s->count[block].moved;
        status = status ? status : s->status[block];
    }
    return status == TRI_STOPPED ? tri_fail_stopped(error)
           : status ? tri_fail(error, status, NULL, 0, "out of memory for smoothing") : TRI_OK;
}

/* Deals the vertices to the blocks of the phase and runs the blocks. */
static enum tri_status smooth_phase(struct smoothing *s, struct tri_error *error)
{
    const struct tri_executor *executor = &s->run->asked.executor;
    enum tri_status status = TRI_OK;
    if (!par_deal_reserve(&s->deal, s->n, par_blocks(&s->run->cells)))
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for smoothing");
    if (!status) {
        tri_execute(executor, tri_shares(s->run->mesh->n_vertices), find_homes, s);
        tri_execute(executor, s->deal.shares, count_share, s);
        par_deal_add_up(&s->deal);
        tri_execute(executor, s->deal.shares, deal_share, s);
        tri_execute(executor, (size_t)s->deal.n_tiles, smooth_block, s);
        status = gather_left_vertices(s, error);
    }
    par_deal_free(&s->deal);
    return status;
}

/* Runs one pass: all movable vertices in four phases, then the vertices that no block could treat in one sequential
 * call. */
static enum tri_status smooth_pass(struct smoothing *s, enum tri_smooth_pass pass, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    struct tri_smooth_count last = {0};
    s->moved = 0;
    s->pass = pass;
    s->n = tri_list_movable(s->run->mesh, s->vertex); /* the mesh has been numbered: this order depends on it alone */
    for (s->phase = 0; !status && s->phase < PAR_PHASES; s->phase++)
        status = smooth_phase(s, error);
    status = status ? status : tri_smooth_some(s->smooth, pass, s->vertex, s->n, -1, &last, error);
    s->moved += last.moved;
    return status;
}

/* Runs all passes. Ends early if a pass moves no vertex. */
static enum tri_status smooth_by_blocks(struct par_run *run, struct tri_error *error)
{
    struct tri_mesh *mesh = run->mesh;
    const size_t list = ((size_t)mesh->n_vertices + 1) * sizeof(tri_vertex_id);
    const size_t blocks = (size_t)par_blocks(&run->cells);
    struct smoothing s = {.run = run, .vertex = tri_mesh_extra(mesh, list), .dealt = tri_mesh_extra(mesh, list),
                          .count = malloc(blocks * sizeof *s.count), .status = malloc(blocks * sizeof *s.status),
                          .moved = 1};
    /* The lists are as large as the mesh, so they are kept with it, in memory or in files. */
    int32_t *home = tri_mesh_extra(mesh, list);
    enum tri_status status = s.vertex && s.dealt && home && s.count && s.status
                                 ? tri_smooth_new(&s.smooth, mesh, run->asked.quality, error)
                                 : tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for smoothing");
    if (!status)
        s.smooth->home = home;
    for (int pass = 0; !status && s.moved > 0 && pass < run->asked.quality->passes; pass++) {
        if (pass > 0)
            status = smooth_pass(&s, TRI_SMOOTH_FLIP, error);
        status = status ? status : smooth_pass(&s, TRI_SMOOTH_MOVE, error);
    }
    status = status ? status : tri_smooth_end(s.smooth, &run->asked.executor, error);
    tri_smooth_free(s.smooth);
    tri_mesh_extra_free(mesh, s.vertex);
    tri_mesh_extra_free(mesh, s.dealt);
    tri_mesh_extra_free(mesh, home);
    free(s.count);
    free(s.status);
    return status;
}

/* Numbers the mesh by its tiles. If the memory limit does not allow this, the mesh first moves to files. */
static enum tri_status number_smoothed(struct par_run *run, struct tri_error *error)
{
    struct tri_mesh *mesh = run->mesh;
    const double bytes = par_number_bytes(mesh->n_triangles, mesh->n_vertices, mesh->n_subs);
    enum tri_status status = par_park_expect(run->park, mesh, (size_t)bytes, error);
    return status ? status : par_number(mesh, &run->cells, run->asked.n_kept, &run->asked.executor, error);
}

enum tri_status par_smooth(struct par_run *run, struct tri_error *error)
{
    if (!tri_wants_smoothing(run->asked.quality))
        return TRI_OK;
    if (!run->cells.x)
        return tri_smooth_all(run->mesh, run->asked.quality, error);
    /* With by_block, the mesh has not been numbered yet, but the order of smoothing depends on its numbers. Afterwards
     * it is numbered by the new positions. */
    enum tri_status status = run->asked.options->by_block ? number_smoothed(run, error) : TRI_OK;
    status = status ? status : smooth_by_blocks(run, error);
    return status ? status : number_smoothed(run, error);
}
