/* The checkpoint directory of a run. A run whose process has died can be resumed from it.
 *
 *     tiles        all tiles that a sweep has handed out (spool.h); only appended to
 *     state-0, state-1   the contents of memory between two steps (state.h); the manifest names the valid one
 *     piece-0-P, piece-1-P   the part of such a state that rank P holds (sched/ranks/keep.c)
 *     manifest     which state is valid, the lengths of the files, their hashes, and which run they belong to
 *
 * INVARIANT: if the process dies at any moment and there is a manifest, it describes a state and a beginning of `tiles`
 * that are complete on the disk. par_checkpoint_write ensures this.
 *
 * OWNERSHIP: the directory may hold other files. The manifest is created before any of the files above and removed
 * after them. If there is a manifest, files with these names belong to a run. If there are such files without a
 * manifest, they do not belong to a run, and the directory is refused. */
#ifndef SCHED_CHECKPOINT_CHECKPOINT_H
#define SCHED_CHECKPOINT_CHECKPOINT_H

#include "sched/checkpoint/spool.h"
#include "triangle/base/status.h"

enum { PAR_CHECKPOINT_PATH = 4096 };

enum par_state_kind {
    PAR_SWEPT_STATE, /* a sweep, in the middle of a column or between two columns; finished tiles are in the file
                        `tiles` */
    PAR_WHOLE_STATE, /* the whole mesh; it will not be swept */
    PAR_RANKS_STATE  /* the common position of several ranks (sched/ranks/keep.c); the data of each rank is in its piece
                        files */
};

/* The contents of the file `manifest`. */
struct par_manifest {
    uint64_t word, hash;    /* file type and version; hash of all members from `of` on */
    uint64_t of;            /* identifies the program, as passed to par_checkpoint_open */
    uint64_t run;           /* identifies the run: a hash of the input mesh, bounds and options */
    int64_t kind;           /* enum par_state_kind */
    int64_t which;          /* number of the valid state file: 0 or 1 */
    int64_t state_bytes;    /* length of the state file; 0: there is no state yet, and a resumed run starts again from
                               the input */
    uint64_t state_hash;    /* hash of the state file */
    int64_t tiles_bytes;    /* length of the valid beginning of `tiles` */
    int64_t triangles;      /* triangles in the mesh so far, including those handed out */
    int64_t n_ranks;        /* number of ranks, for a state of ranks; otherwise 0 */
    int64_t made_directory; /* 1: the run created the directory, and removes it at the end; 0: it existed before */
};

/* An open checkpoint directory and the schedule by which states are written. Used by the calling thread of a run;
 * blocks read it to decide whether a halt is due. */
struct par_checkpoint {
    double seconds;               /* least time between two states, in seconds; 0: a state after each step. Set it after
                                     opening */
    const char *directory;        /* its path; borrowed */
    struct par_manifest manifest; /* the manifest as it is on the disk */
    tri_file folder;              /* the open directory; TRI_NO_FILE: not open */
    tri_file lock;                /* the open file `tiles`, which carries the lock on the directory; TRI_NO_FILE: this
                                     process does not hold the lock */
    int saved;                    /* number of states that this process has written */
    double last;                  /* time of the last state, or of the beginning of the run, by tri_seconds() */
    double cost, writing;         /* seconds that the last state took; the part of them spent on writing to the disk */
    double size;                  /* number of triangles in the last state */
    double limit;                 /* time at which the run will be stopped, by tri_seconds(); 0: unknown. Set it after
                                     opening */
    double last_check;                /* time at which ranks last checked whether a state is due */
    struct par_spool spool;       /* the tiles of a sweep */
    char tiles_path[PAR_CHECKPOINT_PATH]; /* path of the file `tiles`, for messages */
    struct tri_sink sink;         /* the sink of a sweep, which appends to the spool */
    const struct tri_stop *stop;  /* asks for the end of the run; checked only between steps. NULL: the run cannot be
                                     stopped */
    void (*told)(void *user, int64_t triangles); /* called when a new manifest is on the disk, with the number of
                                                    triangles in the state; 0: there is no state. NULL: not called */
    void *told_user;              /* passed to told */
    void (*time_up)(void);        /* called when the last state before the limit has been written; from then on `stop`
                                     returns true. NULL: not called */
};

/* Returns a checkpoint that is not open. */
static inline struct par_checkpoint par_checkpoint_closed(const char *directory)
{
    return (struct par_checkpoint){.directory = directory, .folder = TRI_NO_FILE, .lock = TRI_NO_FILE,
                                   .spool = {.file = TRI_NO_FILE}};
}

/* Opens a checkpoint directory, creates it if necessary, and locks it. resume: false for a new run, true to continue
 * the run in the directory. of: a hash of everything besides the run itself that must be the same when a run is
 * resumed.
 *
 * TRI_BAD_INPUT: without resume, the directory holds a run or files with the names of a run's files; with resume, it
 * holds no run, one of another program, or a damaged one; another process uses it; or it belongs to another user.
 * Nothing in it has changed then. TRI_CANNOT_WRITE. */
enum tri_status par_checkpoint_open(struct par_checkpoint *checkpoint, const char *directory, bool resume, uint64_t of,
                                    struct tri_error *error);

/* Checks without the lock whether a run with this `of` could be resumed from the directory. Errors as
 * par_checkpoint_open with resume. */
enum tri_status par_checkpoint_look(const char *directory, uint64_t of, struct tri_error *error);

/* Returns whether the directory holds a run. */
bool par_checkpoint_is_there(const char *directory);

/* Returns whether there is a state from which the run can be resumed. */
static inline bool par_checkpoint_has_state(const struct par_checkpoint *c) { return c->manifest.state_bytes > 0; }

/* Returns whether there is a state of a sweep. */
static inline bool par_checkpoint_has_sweep(const struct par_checkpoint *c)
{
    return par_checkpoint_has_state(c) && c->manifest.kind == PAR_SWEPT_STATE;
}

/* Returns whether there is a state of several ranks. */
static inline bool par_checkpoint_has_ranks(const struct par_checkpoint *c)
{
    return par_checkpoint_has_state(c) && c->manifest.kind == PAR_RANKS_STATE;
}

/* Closes the checkpoint and releases the lock. With `remove`, which requires an open checkpoint, also deletes the run's
 * files, and the directory if the run created it and it is empty. */
void par_checkpoint_close(struct par_checkpoint *checkpoint, bool remove);

/* --- reading and writing states */

/* Binds the checkpoint to this run. run: a hash of everything on which the run's mesh depends. Cuts off tiles that were
 * appended after the last state. TRI_BAD_INPUT: the state belongs to another run. TRI_CANNOT_WRITE. */
enum tri_status par_checkpoint_take(struct par_checkpoint *checkpoint, uint64_t run, struct tri_error *error);

/* Discards the state and the tiles; later states are of this kind. Called if a sweep is given up. TRI_CANNOT_WRITE. */
enum tri_status par_checkpoint_forget(struct par_checkpoint *checkpoint, enum par_state_kind kind,
                                      struct tri_error *error);

/* A state file that is being written or read. The same walk function does both, so that the two cannot differ in
 * format. */
struct par_state_file {
    tri_file file;   /* the open file */
    tri_file direct; /* the same file, opened to bypass the system's cache; TRI_NO_FILE: not available */
    bool reads;      /* true: reading; false: writing */
    bool failed;     /* reading or writing failed; later calls of par_carry do nothing, so the walk need not check it */
    int64_t place;   /* position in the file, in bytes */
    uint64_t hash;   /* hash of the bytes written so far */
    double writing;  /* seconds spent on writing, without hashing */
    char *waiting;   /* buffer of PAR_STATE_WRITE bytes that collects bytes to write; NULL when reading */
};

/* Writes the next n bytes to the file, or reads them from it. */
void par_carry(struct par_state_file *file, void *bytes, size_t n);

/* Writes or reads a whole state by calls of par_carry. If one of them fails, file->failed is set and the others do
 * nothing. */
typedef enum tri_status par_state_walk(struct par_state_file *file, void *user, struct tri_error *error);

/* Writes a state and makes it the valid one. Afterwards it and all tiles so far are on the disk. On TRI_CANNOT_WRITE or
 * an error of the walk, the previous state stays valid, since everything happens in this order:
 *
 *   1. write and sync a new file without a name; give it the one of the two names that the manifest does not use
 *   2. sync `tiles`
 *   3. write and sync a new manifest, `manifest-new`
 *   4. rename it to `manifest`, and sync the directory */
enum tri_status par_checkpoint_write(struct par_checkpoint *checkpoint, enum par_state_kind kind, int64_t n_ranks,
                                     int64_t triangles, par_state_walk *walk, void *user, struct tri_error *error);

/* Checks the hash of the whole state file, then reads it. TRI_BAD_INPUT: it is damaged. TRI_STOPPED: the end was
 * requested before any of it was read. Otherwise the result of the walk. */
enum tri_status par_checkpoint_read(const struct par_checkpoint *checkpoint, par_state_walk *walk, void *user,
                                    struct tri_error *error);

/* For states of ranks. par_checkpoint_next returns which of the two states is to be written next. par_checkpoint_piece
 * opens the piece of one rank, to read it, or, with fresh, to write a new one; path receives its path for messages.
 * TRI_NO_FILE: it cannot be opened, and errno has the reason. */
int64_t par_checkpoint_next(const struct par_checkpoint *checkpoint);
tri_file par_checkpoint_piece(char path[PAR_CHECKPOINT_PATH], const char *directory, int64_t which, int rank,
                              bool fresh);

/* Completes a new piece file: syncs it to the disk and gives it its name. False: errno has the reason. */
bool par_checkpoint_end_piece(const char *directory, const char *path, tri_file file);

#endif
