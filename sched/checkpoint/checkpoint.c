/* The checkpoint directory. Arrays in files have the same layout as in memory, so they can be read only on the same
 * kind of machine. If possible, a state is written to the disk without the system's cache, which is two to five times
 * as fast (measured). This matters because a batch system may be waiting for the process to end. */
#include "sched/checkpoint/checkpoint.h"

#include <assert.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "sched/checkpoint/spool.h"
#include "sched/tunables.h"
#include "triangle/base/hash.h"
#include "triangle/base/system.h"

static const uint64_t MANIFEST = UINT64_C(0x366863697274706b); /* "kptrich6": file type and version */

static const char *const state_name[2] = {"state-0", "state-1"};
static const char manifest_name[] = "manifest", fresh_name[] = "manifest-new", tiles_name[] = "tiles";


/* Makes the path of a file in the directory, for messages. */
static void path_of(char path[PAR_CHECKPOINT_PATH], const char *directory, const char *name)
{
    snprintf(path, PAR_CHECKPOINT_PATH, "%s/%s", directory, name);
}

/* Fails with TRI_CANNOT_WRITE and the reason in errno. */
static enum tri_status cannot_write(const char *directory, const char *name, struct tri_error *error)
{
    char path[PAR_CHECKPOINT_PATH];
    path_of(path, directory, name);
    return tri_fail_system(error, TRI_CANNOT_WRITE, path, "cannot write", errno);
}

bool par_checkpoint_end_piece(const char *directory, const char *path, tri_file file)
{
    const tri_file folder = tri_folder_open(directory, true);
    const bool done = folder != TRI_NO_FILE && tri_folder_commit(folder, path + tri_path_folder_length(path), file) &&
                      tri_file_sync(folder);
    (void)tri_file_close(folder);
    return done;
}

/* --- manifest */

/* Returns the hash of a manifest: of all members after `hash`. */
static uint64_t hash_of(const struct par_manifest *m)
{
    return tri_hash(0, &m->of, sizeof *m - offsetof(struct par_manifest, of));
}

/* Returns whether a manifest has the right version and hash, and plausible members. */
static bool is_manifest(const struct par_manifest *m)
{
    return m->word == MANIFEST && m->hash == hash_of(m) && (m->which == 0 || m->which == 1) && m->state_bytes >= 0 &&
           m->tiles_bytes >= 0 && m->kind >= PAR_SWEPT_STATE && m->kind <= PAR_RANKS_STATE;
}

/* Reads and checks the manifest. TRI_BAD_INPUT: there is none, or it is damaged. */
static enum tri_status read_manifest(struct par_manifest *m, const struct par_checkpoint *c, struct tri_error *error)
{
    const char *directory = c->directory;
    const tri_file file = tri_folder_file(c->folder, manifest_name, TRI_FOLDER_READ);
    if (file == TRI_NO_FILE)
        return tri_fail_system(error, TRI_BAD_INPUT, directory, "holds no checkpoint", errno);
    bool whole = tri_read_back(file, m, sizeof *m, 0) && is_manifest(m);
    (void)tri_file_close(file);
    if (whole)
        return TRI_OK;
    return tri_fail(error, TRI_BAD_INPUT, directory, 0, "the checkpoint's manifest is damaged, or of another version");
}

/* Writes a new manifest, syncs it, and renames it over the old one, in this order. So there is always one complete
 * manifest on the disk. If it succeeds, c->manifest is the new one, and the caller's callback is called. */
static enum tri_status write_manifest(struct par_checkpoint *c, struct par_manifest m, struct tri_error *error)
{
    const tri_file file = tri_folder_create(c->folder, fresh_name);
    m.word = MANIFEST;
    m.hash = hash_of(&m);
    bool done = file != TRI_NO_FILE && tri_write_at(file, &m, sizeof m, 0) &&
                tri_folder_commit(c->folder, fresh_name, file);
    done = tri_file_close(file) && done;
    if (!done || !tri_folder_rename(c->folder, fresh_name, manifest_name) || !tri_file_sync(c->folder))
        return cannot_write(c->directory, manifest_name, error);
    c->manifest = m;
    if (c->told)
        c->told(c->told_user, m.state_bytes > 0 ? m.triangles : 0);
    return TRI_OK;
}

/* Returns a manifest of the same run, without a state. */
static struct par_manifest manifest_of_none(const struct par_manifest *m, int64_t kind)
{
    return (struct par_manifest){.of = m->of, .run = m->run, .kind = kind, .made_directory = m->made_directory};
}

/* --- distinguishing a run's files from other files */

/* Returns whether this is the name of a piece, such as "piece-0-12". */
static bool is_piece(const char *name)
{
    int n = 0;
    sscanf(name, "piece-%*1[01]-%*[0-9]%n", &n);
    return n > 0 && name[n] == 0;
}

/* Returns whether the file `manifest-new` is empty or a manifest that has not been renamed yet. The process may have
 * died while it was writing one. */
static bool is_fresh_manifest(tri_file folder)
{
    struct par_manifest m;
    struct tri_file_facts facts;
    const tri_file file = tri_folder_file(folder, fresh_name, TRI_FOLDER_READ);
    const bool known = file != TRI_NO_FILE && tri_file_get_facts(file, &facts);
    const bool is = known && (facts.size == 0 || (facts.size == sizeof m && tri_read_back(file, &m, sizeof m, 0) &&
                                                  is_manifest(&m)));
    (void)tri_file_close(file);
    return is;
}

/* For a directory without a manifest: returns whether a run would overwrite or remove this file, although no run has
 * made it. A run creates its files after its first manifest and removes them before its last one, so without a manifest
 * they are not a run's. */
static bool is_foreign(tri_file folder, const char *name)
{
    if (strcmp(name, fresh_name) == 0)
        return !is_fresh_manifest(folder);
    return strcmp(name, tiles_name) == 0 || strcmp(name, state_name[0]) == 0 || strcmp(name, state_name[1]) == 0 ||
           is_piece(name);
}

/* The search for a foreign file in the directory. */
struct finding {
    tri_file folder;                /* the open directory */
    char name[PAR_CHECKPOINT_PATH]; /* name of the first foreign file; empty: none found */
};

/* A callback of tri_folder_list: stores the first foreign name. Returns false to end the listing. */
static bool find_foreign(void *user, const char *name)
{
    struct finding *finding = user;
    const bool found = is_foreign(finding->folder, name);
    if (found)
        snprintf(finding->name, sizeof finding->name, "%s", name);
    return !found;
}

/* Refuses a directory without a manifest that holds files with the names of a run's files. */
static enum tri_status check_names(const struct par_checkpoint *c, struct tri_error *error)
{
    struct finding finding = {.folder = c->folder};
    if (!tri_folder_list(c->folder, find_foreign, &finding))
        return tri_fail_system(error, TRI_CANNOT_WRITE, c->directory, "cannot be used", errno);
    return finding.name[0] ? tri_fail(error, TRI_BAD_INPUT, c->directory, 0,
                                      "holds a file %s, but no checkpoint: choose another folder", finding.name)
                           : TRI_OK;
}

/* --- opening and closing */

bool par_checkpoint_is_there(const char *directory)
{
    char path[PAR_CHECKPOINT_PATH];
    path_of(path, directory, manifest_name);
    return tri_path_allows(path, TRI_THERE);
}

/* Locks the directory, so that only one process uses it. On file systems without locks this always succeeds. */
static bool lock_folder(struct par_checkpoint *c)
{
    c->lock = tri_folder_file(c->folder, tiles_name, TRI_FOLDER_EXTEND);
    return c->lock != TRI_NO_FILE && tri_file_lock(c->lock) != TRI_LOCKED_BY_ANOTHER;
}

/* Checks without the lock that the directory can be used: for a new run, it holds no run and no foreign files; with
 * resume, it holds a run of this program version. */
static enum tri_status check_run(const struct par_checkpoint *c, bool resume, uint64_t of, struct tri_error *error)
{
    struct par_manifest m;
    if (!resume && tri_folder_has(c->folder, manifest_name))
        return tri_fail(error, TRI_BAD_INPUT, c->directory, 0, "holds the checkpoint of a run already");
    enum tri_status status = resume ? read_manifest(&m, c, error) : check_names(c, error);
    if (!status && resume && m.of != of)
        return tri_fail(error, TRI_BAD_INPUT, c->directory, 0, "holds a checkpoint of another version of the program");
    return status;
}

/* Opens the directory. resume decides which error a missing directory is. */
static enum tri_status open_folder(struct par_checkpoint *c, bool resume, struct tri_error *error)
{
    c->folder = tri_folder_open(c->directory, true);
    if (c->folder != TRI_NO_FILE)
        return TRI_OK;
    if (errno == EPERM)
        return tri_fail(error, TRI_BAD_INPUT, c->directory, 0, "belongs to another user: choose another folder");
    if (resume)
        return tri_fail_system(error, TRI_BAD_INPUT, c->directory, "holds no checkpoint", errno);
    return tri_fail_system(error, TRI_CANNOT_WRITE, c->directory, "cannot be used", errno);
}

enum tri_status par_checkpoint_look(const char *directory, uint64_t of, struct tri_error *error)
{
    struct par_checkpoint c = par_checkpoint_closed(directory);
    enum tri_status status = open_folder(&c, true, error);
    status = status ? status : check_run(&c, true, of, error);
    par_checkpoint_close(&c, false);
    return status;
}

/* Takes the lock. With resume, then reads the manifest again, since another process may have changed it before the lock
 * was held. */
static enum tri_status lock_and_read(struct par_checkpoint *c, bool resume, struct tri_error *error)
{
    if (lock_folder(c))
        return resume ? read_manifest(&c->manifest, c, error) : TRI_OK;
    if (c->lock != TRI_NO_FILE)
        return tri_fail(error, TRI_BAD_INPUT, c->directory, 0, "is in use by another process");
    return cannot_write(c->directory, tiles_name, error);
}

/* The manifest of a new run is written before the lock is taken, because the lock is on the file `tiles`, and every
 * file of a run must be created after its manifest. */
enum tri_status par_checkpoint_open(struct par_checkpoint *c, const char *directory, bool resume, uint64_t of,
                                    struct tri_error *error)
{
    *c = par_checkpoint_closed(directory);
    if (strlen(directory) > PAR_CHECKPOINT_PATH - 32)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "the name of the directory for checkpoints is too long");
    /* A directory that existed before is not removed at the end. */
    bool made = !resume && tri_folder_make(directory);
    if (!resume && !made && errno != EEXIST)
        return tri_fail_system(error, TRI_CANNOT_WRITE, directory, "cannot be made", errno);
    /* All files are opened relative to the open directory, so other processes cannot divert later calls by changing its
     * path. */
    enum tri_status status = open_folder(c, resume, error);
    status = status ? status : check_run(c, resume, of, error);
    if (!status && !resume)
        status = write_manifest(c, (struct par_manifest){.of = of, .made_directory = made}, error);
    status = status ? status : lock_and_read(c, resume, error);
    path_of(c->tiles_path, directory, tiles_name);
    /* The spool continues after the tiles that the manifest counts. */
    c->spool = (struct par_spool){.file = c->lock, .path = c->tiles_path, .length = c->manifest.tiles_bytes};
    if (status)
        par_checkpoint_close(c, false);
    return status;
}

int64_t par_checkpoint_next(const struct par_checkpoint *c)
{
    return par_checkpoint_has_state(c) ? 1 - c->manifest.which : 0;
}

tri_file par_checkpoint_piece(char path[PAR_CHECKPOINT_PATH], const char *directory, int64_t which, int rank,
                              bool fresh)
{
    char name[64];
    snprintf(name, sizeof name, "piece-%d-%d", (int)which, rank);
    path_of(path, directory, name);
    const tri_file folder = tri_folder_open(directory, true);
    if (folder == TRI_NO_FILE)
        return TRI_NO_FILE;
    /* A fresh piece gets its name only in par_checkpoint_end_piece, so an unfinished one is never read. */
    const tri_file file = fresh ? tri_folder_create(folder, name) : tri_folder_file(folder, name, TRI_FOLDER_READ);
    const int fault = errno;
    (void)tri_file_close(folder);
    errno = fault;
    return file;
}

/* A callback of tri_folder_list: deletes the file if it is a piece. */
static bool remove_piece(void *user, const char *name)
{
    const struct par_checkpoint *c = user;
    if (is_piece(name))
        (void)tri_folder_unlink(c->folder, name);
    return true;
}

/* Deletes all files of the run. The manifest marks the others as the run's, so it is deleted last. Before that it is
 * replaced by one without a state, because the state is deleted before it. */
static void remove_all(struct par_checkpoint *c)
{
    (void)write_manifest(c, manifest_of_none(&c->manifest, c->manifest.kind), NULL);
    (void)tri_folder_list(c->folder, remove_piece, c); /* the pieces of all ranks */
    (void)tri_folder_unlink(c->folder, state_name[0]);
    (void)tri_folder_unlink(c->folder, state_name[1]);
    (void)tri_folder_unlink(c->folder, tiles_name);
    (void)tri_folder_unlink(c->folder, fresh_name);
    (void)tri_folder_unlink(c->folder, manifest_name);
}

void par_checkpoint_close(struct par_checkpoint *c, bool remove)
{
    const bool made_directory = c->manifest.made_directory;
    assert(!remove || c->lock != TRI_NO_FILE);
    if (remove)
        remove_all(c);
    (void)tri_file_close(c->lock);
    (void)tri_file_close(c->folder);
    if (remove && made_directory) /* on Windows, open files stay in the directory until they are closed */
        (void)tri_folder_remove(c->directory);
    c->lock = c->folder = c->spool.file = TRI_NO_FILE;
}

/* --- binding the checkpoint to a run */

enum tri_status par_checkpoint_take(struct par_checkpoint *c, uint64_t run, struct tri_error *error)
{
    if (par_checkpoint_has_state(c) && run != c->manifest.run)
        return tri_fail(error, TRI_BAD_INPUT, c->directory, 0,
                        "is the checkpoint of another run: of another input, or with other switches");
    /* The hash is written with the next manifest. */
    c->manifest.run = run;
    assert(c->lock != TRI_NO_FILE);
    if (!tri_file_set_size(c->spool.file, (uint64_t)c->spool.length))
        return cannot_write(c->directory, tiles_name, error);
    return TRI_OK;
}

enum tri_status par_checkpoint_forget(struct par_checkpoint *c, enum par_state_kind kind, struct tri_error *error)
{
    enum tri_status status = write_manifest(c, manifest_of_none(&c->manifest, kind), error);
    if (status)
        return status;
    /* The new manifest counts no tiles, so they can be cut off now. */
    c->spool.length = c->spool.sent = 0;
    return tri_file_set_size(c->spool.file, 0) ? TRI_OK : cannot_write(c->directory, tiles_name, error);
}

/* --- state files */

/* Returns whether all bytes are 0, n >= 1. Compares the bytes with themselves, shifted by one. */
static bool is_zero(const char *bytes, size_t n) { return bytes[0] == 0 && memcmp(bytes, bytes + 1, n - 1) == 0; }

/* Writes the n bytes in the buffer; they end at position f->place. A full buffer of zeros is skipped and leaves a hole
 * in the file, because unused room of blocks, most of a mesh during its first phase, is zero. Full buffers bypass the
 * system's cache if possible. The last, partial buffer goes through the cache, since direct writing needs whole
 * blocks. */
static bool write_buffer(struct par_state_file *f, size_t n)
{
    const uint64_t place = (uint64_t)f->place - n;
    f->hash = tri_hash(f->hash, f->waiting, n);
    if (n == PAR_STATE_WRITE && is_zero(f->waiting, n))
        return true;
    const double began = tri_seconds();
    const bool passes = n == PAR_STATE_WRITE && f->direct != TRI_NO_FILE;
    const bool done = (passes && tri_write_at(f->direct, f->waiting, n, place)) ||
                      tri_write_at(f->file, f->waiting, n, place);
    f->writing += tri_seconds() - began;
    return done;
}

/* Appends bytes to the buffer, and writes it each time that it is full. */
static void append_bytes(struct par_state_file *f, const char *at, size_t n)
{
    while (n > 0 && !f->failed) {
        const size_t waits = (size_t)(f->place % PAR_STATE_WRITE), room = PAR_STATE_WRITE - waits;
        const size_t part = n < room ? n : room;
        memcpy(f->waiting + waits, at, part);
        f->place += (int64_t)part;
        f->failed = part == room && !write_buffer(f, PAR_STATE_WRITE);
        at += part;
        n -= part;
    }
}

void par_carry(struct par_state_file *f, void *bytes, size_t n)
{
    if (n == 0 || f->failed)
        return;
    if (!f->reads) {
        append_bytes(f, bytes, n);
        return;
    }
    f->failed = !tri_read_back(f->file, bytes, n, (uint64_t)f->place);
    f->place += (int64_t)n;
}

/* Writes a complete state file, syncs it, and gives it its name. *to: position, hash and times at the end. After an
 * error the file may be incomplete, but no manifest refers to it. */
static enum tri_status write_state(const struct par_checkpoint *c, const char *name, struct par_state_file *to,
                                   par_state_walk *walk, void *user, struct tri_error *error)
{
    *to = (struct par_state_file){.file = tri_folder_create(c->folder, name), .direct = TRI_NO_FILE,
                                  .waiting = tri_page_alloc(PAR_STATE_WRITE)};
    to->failed = to->file == TRI_NO_FILE;
    if (!to->waiting) {
        (void)tri_file_close(to->file);
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for a checkpoint");
    }
    if (!to->failed)
        to->direct = tri_file_direct(to->file);
    /* Collect and write the state through par_carry. */
    enum tri_status status = walk(to, user, error);
    /* Write the rest of the buffer; cutting sets the length if the state ends with a hole. */
    bool done = !to->failed && write_buffer(to, (size_t)(to->place % PAR_STATE_WRITE)) &&
                tri_file_set_size(to->file, (uint64_t)to->place);
    const double began = tri_seconds();
    done = done && tri_folder_commit(c->folder, name, to->file);
    const int fault = errno;
    to->writing += tri_seconds() - began;
    done = tri_file_close(to->direct) && done;
    done = tri_file_close(to->file) && done;
    free(to->waiting);
    errno = fault;
    return status || done ? status : cannot_write(c->directory, name, error);
}

/* The order matters for the invariant in checkpoint.h: first state and tiles are synced to the disk, then the manifest
 * that names them replaces the old one. */
enum tri_status par_checkpoint_write(struct par_checkpoint *c, enum par_state_kind kind, int64_t n_ranks,
                                     int64_t triangles, par_state_walk *walk, void *user, struct tri_error *error)
{
    struct par_manifest m = c->manifest;
    struct par_state_file to;
    /* Use the file name that the current manifest does not refer to. */
    m.which = par_checkpoint_next(c);
    enum tri_status status = write_state(c, state_name[m.which], &to, walk, user, error);
    if (status)
        return status;
    /* The tiles that the state refers to must be on the disk, too. */
    if (!tri_file_sync(c->spool.file))
        return cannot_write(c->directory, tiles_name, error);
    m.kind = kind;
    m.state_bytes = to.place;
    m.state_hash = to.hash;
    m.tiles_bytes = c->spool.length;
    m.n_ranks = n_ranks;
    m.triangles = triangles;
    c->writing = to.writing;
    status = write_manifest(c, m, error);
    c->saved += !status;
    return status;
}

/* Fails with TRI_BAD_INPUT and the name of the state file. */
static enum tri_status damaged(const struct par_checkpoint *c, struct tri_error *error)
{
    return tri_fail(error, TRI_BAD_INPUT, c->directory, 0, "the checkpoint's file %s is damaged",
                    state_name[c->manifest.which]);
}

/* Reads the whole state file and compares its hash with that in the manifest. */
static enum tri_status check(const struct par_checkpoint *c, tri_file file, struct tri_error *error)
{
    const int64_t all = c->manifest.state_bytes;
    const struct tri_stop *stop = par_checkpoint_has_ranks(c) ? NULL : c->stop; /* ranks stop only together, after a
                                                                                   step */
    char *bytes = malloc(PAR_STATE_WRITE);
    uint64_t hash = 0;
    bool sound = true, stopped = false;
    /* Read in pieces of the size in which the state was written, because the hash is computed piece by piece. */
    for (int64_t place = 0; bytes && sound && !stopped && place < all; place += PAR_STATE_WRITE) {
        const size_t n = all - place < PAR_STATE_WRITE ? (size_t)(all - place) : PAR_STATE_WRITE;
        sound = tri_read_back(file, bytes, n, (uint64_t)place);
        hash = sound ? tri_hash(hash, bytes, n) : hash;
        stopped = tri_stop_is_asked(stop);
    }
    const bool memory = bytes;
    free(bytes);
    if (!memory)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for a checkpoint");
    if (stopped)
        return tri_fail_stopped(error);
    return sound && hash == c->manifest.state_hash ? TRI_OK : damaged(c, error);
}

enum tri_status par_checkpoint_read(const struct par_checkpoint *c, par_state_walk *walk, void *user,
                                    struct tri_error *error)
{
    const char *name = state_name[c->manifest.which];
    struct par_state_file from = {.file = tri_folder_file(c->folder, name, TRI_FOLDER_READ), .reads = true};
    if (from.file == TRI_NO_FILE)
        return damaged(c, error);
    enum tri_status status = check(c, from.file, error);
    status = status ? status : walk(&from, user, error);
    /* The hash is right, so a wrong length means that the walk expects another format. */
    if (!status && (from.failed || from.place != c->manifest.state_bytes))
        status = damaged(c, error);
    (void)tri_file_close(from.file);
    return status;
}
