/* The state of a sweep in a directory, so that the sweep can go on after the process has died.
 *
 *     tiles        all tiles that have been handed out (spool.h); only appended to
 *     state-0, state-1   what is in memory between two columns; the newer one counts
 *     manifest     which of them, how long each is, their hashes, and of what run they are
 *
 * INVARIANT: whenever the process dies, the manifest, if there is one, describes a state and a beginning of the tiles
 * that are whole on the disk. For a state is written into the file that the manifest does not name, tiles and state are
 * synced, and then a new manifest takes the name of the old one.
 *
 * THEOREM. A sweep that goes on ends with the tiles of one that was never stopped. For what the columns to come do
 * depends on the mesh, the lists of what is left and the counts alone, all of which are in the state, with the numbers
 * by which they refer to each other; and tiles that are in the file are handed out again as they were. So neither the
 * number of threads nor the memory need be the same. What the run is of is told by a hash over the mesh, the worklist,
 * the cells and the bounds with which the sweep begins; those are made anew by whoever goes on. */
#ifndef SCHED_SWEEP_CHECKPOINT_H
#define SCHED_SWEEP_CHECKPOINT_H

#include "sched/sweep/spool.h"
#include "triangle/stop.h"

struct par_partition;
struct par_state;
struct par_tiles;

enum { PAR_CHECKPOINT_PATH = 4096 };

struct par_manifest {
    uint64_t word, hash;   /* the second of all that follows */
    uint64_t of;           /* the program, as par_checkpoint_open was told */
    uint64_t run;          /* the mesh and the bounds */
    int64_t which;         /* the state's file: 0 or 1 */
    int64_t state_bytes;   /* 0: there is no state yet: whoever goes on starts over */
    uint64_t state_hash;
    int64_t tiles_bytes;
    int64_t triangles;     /* handed out so far; of a state of ranks: there are so many */
    int64_t n_ranks;       /* whose state this is (sched/ranks/pieces.h); 0: a sweep's */
};

struct par_checkpoint {
    double seconds;              /* between two states at least; 0: one after each column. To be set after opening */
    const char *directory;       /* borrowed */
    struct par_manifest manifest; /* as it is on the disk */
    int lock;                    /* the directory's, held by this process */
    int saved;                   /* states written by this process */
    double last;                 /* when the last was, or when the sweep began */
    struct par_spool spool;      /* the rest is the sweep's */
    char tiles_path[PAR_CHECKPOINT_PATH];
    struct tri_sink sink;
    const struct tri_stop *stop; /* asked between columns alone */
};

/* Makes the directory unless it is there, and takes it: for a new run, or, resume, for one that goes on with what is in
 * it. `of`: a hash of whatever else must be the same then. TRI_BAD_INPUT: there is a run in it already, or, resume,
 * there is none, it is another program's, or damaged; another process works on it. TRI_CANNOT_WRITE. */
enum tri_status par_checkpoint_open(struct par_checkpoint *checkpoint, const char *directory, bool resume, uint64_t of,
                                    struct tri_error *error);

/* Is there a run in the directory? */
bool par_checkpoint_is_there(const char *directory);

/* Is there a state, from which a run can go on? */
static inline bool par_checkpoint_has_state(const struct par_checkpoint *c) { return c->manifest.state_bytes > 0; }

/* What the run is of, before anything is done: a hash over the mesh, the bounds, the cells and the worklist. */
uint64_t par_checkpoint_run(const struct par_state *state, const struct par_partition *partition);

/* TRI_BAD_INPUT: there is a state, and it is another run's. */
enum tri_status par_checkpoint_check(const struct par_checkpoint *checkpoint, uint64_t run, struct tri_error *error);

/* A state of n bytes, whatever they are, becomes the one that counts; `next`: its manifest, but for what is said of the
 * file. TRI_CANNOT_WRITE: the last one counts on. */
enum tri_status par_checkpoint_put(struct par_checkpoint *checkpoint, const void *state, size_t n,
                                   struct par_manifest next, struct tri_error *error);

/* The state that counts, of manifest.state_bytes bytes. TRI_BAD_INPUT: it is damaged. */
enum tri_status par_checkpoint_get(const struct par_checkpoint *checkpoint, void *state, struct tri_error *error);

/* The path of rank `rank`'s piece of a state, see manifest.which; for that of the state to be written next,
 * par_checkpoint_next. */
void par_checkpoint_piece(char path[PAR_CHECKPOINT_PATH], const char *directory, int64_t which, int rank);
static inline int64_t par_checkpoint_next(const struct par_manifest *m)
{
    return m->state_bytes > 0 ? 1 - m->which : 0;
}

/* What has got names in a directory, or lost them, is so after the machine has died, too. */
bool par_checkpoint_sync(const char *directory);

/* Frees what it holds; with `remove` also the files, and the directory if nothing else is in it. */
void par_checkpoint_close(struct par_checkpoint *checkpoint, bool remove);

/* --- for the sweep */

/* When a sweep begins: the tiles' sink becomes the checkpoint's, which may hand out tiles again, and, once a
 * column is finished, the mesh is no longer stopped in the midst of one. Then par_tiles_begin; and where there is a
 * state, *odd becomes the column that is next, and the mesh, the lists and the tiles' counts what they were.
 * TRI_BAD_INPUT: the state is another run's, or damaged. TRI_NO_MEMORY, TRI_CANNOT_WRITE, or what the sink says. */
enum tri_status par_checkpoint_begin(struct par_checkpoint *checkpoint, struct par_state *state,
                                     struct par_tiles *tiles, int32_t *odd, struct tri_error *error);

/* Between two columns, `odd` being next: writes the state where it is time to, where somebody asks for the end, and
 * where the tiles' taker has failed; then returns TRI_STOPPED or that failure. Else TRI_OK, TRI_CANNOT_WRITE,
 * TRI_NO_MEMORY. */
enum tri_status par_checkpoint_border(struct par_checkpoint *checkpoint, struct par_state *state,
                                      const struct par_tiles *tiles, int32_t odd, struct tri_error *error);

/* The same after the last tile, where nobody is stopped any more. */
enum tri_status par_checkpoint_last(struct par_checkpoint *checkpoint, const struct par_state *state,
                                    const struct par_tiles *tiles, int32_t odd, struct tri_error *error);

/* The sweep has ended, in whatever way. forget: what it has done so far is worth nothing. TRI_CANNOT_WRITE. */
enum tri_status par_checkpoint_end(struct par_checkpoint *checkpoint, struct par_state *state, bool forget,
                                   struct tri_error *error);

#endif
