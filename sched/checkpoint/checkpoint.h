/* The state of a run in a directory, so that the run can go on after the process has died.
 *
 *     tiles        all tiles that a sweep has handed out (spool.h); only appended to
 *     state-0, state-1   what is in memory between two steps (state.h); the newer one counts
 *     piece-0-P, piece-1-P   of a state of ranks what rank P has (sched/ranks/keep.c)
 *     manifest     which of them, how long each is, their hashes, and of what run they are
 *
 * INVARIANT: whenever the process dies, the manifest, if there is one, describes a state and a beginning of the tiles
 * that are whole on the disk. For a state is written into a new file, which then gets the name that the manifest does
 * not name; tiles and state are synced, and then a new manifest takes the name of the old one.
 *
 * WHOSE FILES: the directory may hold other files. A manifest is made before any of the files above, and removed after
 * them: with one, files of these names are a run's; where there are some without one they are somebody else's, and the
 * directory is refused. */
#ifndef SCHED_CHECKPOINT_CHECKPOINT_H
#define SCHED_CHECKPOINT_CHECKPOINT_H

#include "sched/checkpoint/spool.h"
#include "triangle/base/status.h"

enum { PAR_CHECKPOINT_PATH = 4096 };

enum par_state_kind {
    PAR_SWEPT_STATE, /* a sweep, amid a column or between two; what is finished is in the tiles */
    PAR_WHOLE_STATE, /* the mesh as a whole; it is swept no more */
    PAR_RANKS_STATE  /* how far ranks are (sched/ranks/keep.c); what each has is in pieces beside it */
};

struct par_manifest {
    uint64_t word, hash;   /* the second of all that follows */
    uint64_t of;           /* the program, as par_checkpoint_open was told */
    uint64_t run;          /* the mesh and the bounds */
    int64_t kind;          /* enum par_state_kind */
    int64_t which;         /* the state's file: 0 or 1 */
    int64_t state_bytes;   /* 0: there is no state yet: whoever goes on starts over */
    uint64_t state_hash;
    int64_t tiles_bytes;
    int64_t triangles;     /* so far */
    int64_t n_ranks;       /* of a state of ranks */
    int64_t made_directory; /* by the run: it goes with it */
};

struct par_checkpoint {
    double seconds;              /* between two states at least; 0: one after each step. To be set after opening */
    const char *directory;       /* borrowed */
    struct par_manifest manifest; /* as it is on the disk */
    tri_file folder;             /* the directory, open; TRI_NO_FILE: it is not */
    tri_file lock;               /* the tiles, open, with the directory's lock; TRI_NO_FILE: this process has it not */
    int saved;                   /* states written by this process */
    double last;                 /* when the last was, or when the run began */
    double cost, writing;        /* seconds that it took; those until what was written of it was on the disk */
    double size;                 /* triangles in it */
    double limit;                /* when the run will be stopped, by tri_seconds(); 0: not known. To be set likewise */
    double looked;               /* when the last border was */
    struct par_spool spool;
    char tiles_path[PAR_CHECKPOINT_PATH];
    struct tri_sink sink;        /* of a sweep: the spool */
    const struct tri_stop *stop; /* asked between steps alone */
    void (*told)(void *user, int64_t triangles); /* called with what is kept from then on; 0: nothing. NULL: nobody */
    void *told_user;
    void (*time_up)(void);       /* called when the last state before the limit is kept: `stop` says yes from then on */
};

/* One that is not open. */
static inline struct par_checkpoint par_checkpoint_closed(const char *directory)
{
    return (struct par_checkpoint){.directory = directory, .folder = TRI_NO_FILE, .lock = TRI_NO_FILE,
                                   .spool = {.file = TRI_NO_FILE}};
}

/* Makes the directory unless it is there, and takes it: for a new run, or, resume, for one that goes on with what is in
 * it. `of`: a hash of whatever else must be the same then. TRI_BAD_INPUT: there is a run in it already, or files
 * that are named as a run's are, or, resume, there is none, it is another program's, or damaged; another process works
 * on it; it belongs to another user. Then nothing in it has changed. TRI_CANNOT_WRITE. */
enum tri_status par_checkpoint_open(struct par_checkpoint *checkpoint, const char *directory, bool resume, uint64_t of,
                                    struct tri_error *error);

/* Could a run of this `of` go on from the directory, as far as can be told without its lock? Errors as when it is
 * opened for that. */
enum tri_status par_checkpoint_look(const char *directory, uint64_t of, struct tri_error *error);

/* Is there a run in the directory? */
bool par_checkpoint_is_there(const char *directory);

/* Is there a state, from which a run can go on? */
static inline bool par_checkpoint_has_state(const struct par_checkpoint *c) { return c->manifest.state_bytes > 0; }

/* Is that one of a sweep? */
static inline bool par_checkpoint_has_sweep(const struct par_checkpoint *c)
{
    return par_checkpoint_has_state(c) && c->manifest.kind == PAR_SWEPT_STATE;
}

/* Is that one of ranks? */
static inline bool par_checkpoint_has_ranks(const struct par_checkpoint *c)
{
    return par_checkpoint_has_state(c) && c->manifest.kind == PAR_RANKS_STATE;
}

/* Frees what it holds; with `remove`, which wants an open one, also the run's files, and the directory if the run has
 * made it and nothing else is in it. */
void par_checkpoint_close(struct par_checkpoint *checkpoint, bool remove);

/* --- for who writes states */

/* It is to be of this run: a hash over all that the run's mesh depends on. Takes back tiles behind those of the last
 * state. TRI_BAD_INPUT: the state is another run's. TRI_CANNOT_WRITE. */
enum tri_status par_checkpoint_take(struct par_checkpoint *checkpoint, uint64_t run, struct tri_error *error);

/* What has been done so far is worth nothing; states to come are of this kind. TRI_CANNOT_WRITE. */
enum tri_status par_checkpoint_forget(struct par_checkpoint *checkpoint, enum par_state_kind kind,
                                      struct tri_error *error);

/* A state's file on its way: the same walk writes it and reads it. */
struct par_state_file {
    tri_file file;
    tri_file direct; /* the same, past the system's cache; TRI_NO_FILE: there is no such way */
    bool reads;
    bool failed;   /* it could not be written or read; whoever walks need not ask */
    int64_t place;
    uint64_t hash; /* of what has been written */
    double writing; /* seconds that it took to write, hashing left out */
    char *waiting; /* what is on its way to be */
};

/* The next bytes of it. */
void par_carry(struct par_state_file *file, void *bytes, size_t n);

/* Carries all of a state. file->failed may be set: then nothing more is carried. */
typedef enum tri_status par_state_walk(struct par_state_file *file, void *user, struct tri_error *error);

/* The state is on disk afterwards, and the tiles so far. TRI_CANNOT_WRITE, or what the walk says: then the last state
 * counts. */
enum tri_status par_checkpoint_write(struct par_checkpoint *checkpoint, enum par_state_kind kind, int64_t n_ranks,
                                     int64_t triangles, par_state_walk *walk, void *user, struct tri_error *error);

/* Checks all of the state, then reads it. TRI_BAD_INPUT: it is damaged, TRI_STOPPED: somebody asks for the end, before
 * anything has been read; or what the walk says. */
enum tri_status par_checkpoint_read(const struct par_checkpoint *checkpoint, par_state_walk *walk, void *user,
                                    struct tri_error *error);

/* Of a state of ranks: which of the two is to be written next, and a rank's piece of one: its path, for messages, and
 * the file, to read, or a new one to write; TRI_NO_FILE: errno says why. */
int64_t par_checkpoint_next(const struct par_checkpoint *checkpoint);
tri_file par_checkpoint_piece(char path[PAR_CHECKPOINT_PATH], const char *directory, int64_t which, int rank,
                              bool fresh);

/* The new one is complete: it is on the disk, and has its name. */
bool par_checkpoint_end_piece(const char *directory, const char *path, tri_file file);

#endif
