/* Files are those of the machine that wrote them: arrays as they lie in memory. A state goes to the disk past the
 * system's cache, where it can: two to five times as fast (measured), while somebody waits for the end of the run. */
#define _GNU_SOURCE /* O_DIRECT, O_TMPFILE */

#include "sched/checkpoint/checkpoint.h"

#include <assert.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "sched/checkpoint/spool.h"
#include "sched/tunables.h"
#include "triangle/base/at_place.h"
#include "triangle/base/clock.h"
#include "triangle/base/hash.h"

#ifndef O_DIRECT
#define O_DIRECT 0 /* the system has no such thing */
#endif

static const uint64_t MANIFEST = UINT64_C(0x366863697274706b); /* a version, too */

/* Files in a folder of one's own, by a descriptor of it: what others do with its name meanwhile, or put into it, leads
 * nowhere else. No link is followed, nothing but a file of the folder's owner is read or added to, and what is written
 * anew is a new file. Names hold no slash. The first functions return -1 or false where errno says why. */

/* Closes a file that is not to be used. */
static int refuse_file(int file, int why)
{
    close(file);
    errno = why;
    return -1;
}

/* A descriptor of the folder at this path, which may be a link to it. EPERM: it is another user's. */
static int open_own_folder(const char *path)
{
    struct stat folder;
    const int file = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (file < 0)
        return -1;
    if (fstat(file, &folder) != 0)
        return refuse_file(file, errno);
    return folder.st_uid == geteuid() ? file : refuse_file(file, EPERM);
}

/* A file with a second name is refused where it would be added to: that may be another's, which somebody has linked.
 * most_names: of the file, in whatever folders. Nobody waits for the other end of a pipe. */
static int open_own(int folder, const char *name, int flags, nlink_t most_names)
{
    struct stat at_folder, at_file;
    const int file = openat(folder, name, flags | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
    if (file < 0)
        return -1;
    if (fstat(folder, &at_folder) != 0 || fstat(file, &at_file) != 0)
        return refuse_file(file, errno);
    const bool is_own = S_ISREG(at_file.st_mode) && at_file.st_uid == at_folder.st_uid;
    return is_own && at_file.st_nlink <= most_names ? file : refuse_file(file, EPERM);
}

/* A file that is there, to read. */
static int open_to_read(int folder, const char *name) { return open_own(folder, name, O_RDONLY, (nlink_t)-1); }

/* A file to read and to add to, made unless it is there. */
static int open_to_extend(int folder, const char *name) { return open_own(folder, name, O_RDWR | O_CREAT, 1); }

/* A new and empty file, to write; a file of that name is removed from the folder. end_file gives the new one the
 * name once it is complete and on the disk: if the process dies before, nothing is left. Systems without files that
 * have no name (NFS) give it the name at once. */
static int create_file(int folder, const char *name)
{
    if (unlinkat(folder, name, 0) != 0 && errno != ENOENT)
        return -1;
#ifdef O_TMPFILE
    const int unnamed = access("/proc/self/fd", X_OK) == 0 ? openat(folder, ".", O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666)
                                                           : -1;
    if (unnamed >= 0)
        return unnamed;
#endif
    return openat(folder, name, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
}

static bool end_file(int folder, const char *name, int file)
{
    char path[64];
    struct stat at;
    snprintf(path, sizeof path, "/proc/self/fd/%d", file);
    return fsync(file) == 0 && fstat(file, &at) == 0 &&
           (at.st_nlink > 0 || linkat(AT_FDCWD, path, folder, name, AT_SYMLINK_FOLLOW) == 0);
}

/* What has got names in the folder, or lost them, is so after the machine has died, too. */
static bool sync_folder(int folder) { return fsync(folder) == 0 || errno == EINVAL; }

/* --- the manifest */

static const char *const state_name[2] = {"state-0", "state-1"};
static const char manifest_name[] = "manifest", fresh_name[] = "manifest-new", tiles_name[] = "tiles";

/* --- files in the directory */

static void path_of(char path[PAR_CHECKPOINT_PATH], const char *directory, const char *name)
{
    snprintf(path, PAR_CHECKPOINT_PATH, "%s/%s", directory, name);
}

static enum tri_status cannot_write(const char *directory, const char *name, struct tri_error *error)
{
    char path[PAR_CHECKPOINT_PATH];
    path_of(path, directory, name);
    return tri_fail(error, TRI_CANNOT_WRITE, path, 0, "cannot write: %s", strerror(errno));
}

bool par_checkpoint_end_piece(const char *directory, const char *path, int file)
{
    const int folder = open_own_folder(directory);
    const bool done = folder >= 0 && end_file(AT_FDCWD, path, file) && sync_folder(folder);
    if (folder >= 0)
        close(folder);
    return done;
}

/* --- manifest */

static uint64_t hash_of(const struct par_manifest *m)
{
    return tri_hash(0, &m->of, sizeof *m - offsetof(struct par_manifest, of));
}

static bool is_manifest(const struct par_manifest *m)
{
    return m->word == MANIFEST && m->hash == hash_of(m) && (m->which == 0 || m->which == 1) && m->state_bytes >= 0 &&
           m->tiles_bytes >= 0 && m->kind >= PAR_SWEPT_STATE && m->kind <= PAR_RANKS_STATE;
}

static enum tri_status read_manifest(struct par_manifest *m, const struct par_checkpoint *c, struct tri_error *error)
{
    const char *directory = c->directory;
    int file = open_to_read(c->folder, manifest_name);
    if (file < 0)
        return tri_fail(error, TRI_BAD_INPUT, directory, 0, "holds no checkpoint: %s", strerror(errno));
    bool whole = tri_read_again(file, m, sizeof *m, 0) && is_manifest(m);
    close(file);
    if (whole)
        return TRI_OK;
    return tri_fail(error, TRI_BAD_INPUT, directory, 0, "the checkpoint's manifest is damaged, or of another version");
}

static enum tri_status write_manifest(struct par_checkpoint *c, struct par_manifest m, struct tri_error *error)
{
    int file = create_file(c->folder, fresh_name);
    m.word = MANIFEST;
    m.hash = hash_of(&m);
    bool done = file >= 0 && tri_write_at(file, &m, sizeof m, 0) && end_file(c->folder, fresh_name, file);
    if (file >= 0)
        done = close(file) == 0 && done;
    if (!done || renameat(c->folder, fresh_name, c->folder, manifest_name) != 0 || !sync_folder(c->folder))
        return cannot_write(c->directory, manifest_name, error);
    c->manifest = m;
    if (c->told)
        c->told(c->told_user, m.state_bytes > 0 ? m.triangles : 0);
    return TRI_OK;
}

/* The same run's, without a state. */
static struct par_manifest manifest_of_none(const struct par_manifest *m, int64_t kind)
{
    return (struct par_manifest){.of = m->of, .run = m->run, .kind = kind, .made_directory = m->made_directory};
}

/* --- whose files they are */

/* "piece-0-12" */
static bool is_piece(const char *name)
{
    int n = 0;
    sscanf(name, "piece-%*1[01]-%*[0-9]%n", &n);
    return n > 0 && name[n] == 0;
}

/* A new manifest that has not got its name, or has been begun. */
static bool is_fresh_manifest(int folder)
{
    struct par_manifest m;
    int file = open_to_read(folder, fresh_name);
    off_t length = file >= 0 ? lseek(file, 0, SEEK_END) : -1;
    bool is = length == 0 || (length == sizeof m && tri_read_again(file, &m, sizeof m, 0) && is_manifest(&m));
    if (file >= 0)
        close(file);
    return is;
}

/* Would a file of that name, in a directory without a manifest, be written over or removed, though no run has made it?
 * Whatever runs make comes after the first manifest, and goes before the last one. */
static bool is_foreign(int folder, const char *name)
{
    if (strcmp(name, fresh_name) == 0)
        return !is_fresh_manifest(folder);
    return strcmp(name, tiles_name) == 0 || strcmp(name, state_name[0]) == 0 || strcmp(name, state_name[1]) == 0 ||
           is_piece(name);
}

/* Its own descriptor, which closedir closes; NULL: errno says why. */
static DIR *list_folder(int folder)
{
    const int again = openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    DIR *list = again >= 0 ? fdopendir(again) : NULL;
    if (again >= 0 && !list)
        close(again);
    return list;
}

static enum tri_status check_names(const struct par_checkpoint *c, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    DIR *list = list_folder(c->folder);
    if (!list)
        return tri_fail(error, TRI_CANNOT_WRITE, c->directory, 0, "cannot be used: %s", strerror(errno));
    for (const struct dirent *entry; !status && (entry = readdir(list));)
        if (is_foreign(c->folder, entry->d_name))
            status = tri_fail(error, TRI_BAD_INPUT, c->directory, 0,
                              "holds a file %s, but no checkpoint: choose another folder", entry->d_name);
    closedir(list);
    return status;
}

/* --- opening and closing */

bool par_checkpoint_is_there(const char *directory)
{
    char path[PAR_CHECKPOINT_PATH];
    path_of(path, directory, manifest_name);
    return access(path, F_OK) == 0;
}

/* One process at a time; where there are no locks, nobody is kept out. */
static bool lock_folder(struct par_checkpoint *c)
{
    struct flock whole = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    c->lock = open_to_extend(c->folder, tiles_name);
    return c->lock >= 0 && (fcntl(c->lock, F_SETLK, &whole) == 0 || (errno != EACCES && errno != EAGAIN));
}

static enum tri_status check_run(const struct par_checkpoint *c, bool resume, uint64_t of, struct tri_error *error)
{
    struct par_manifest m;
    if (!resume && faccessat(c->folder, manifest_name, F_OK, 0) == 0)
        return tri_fail(error, TRI_BAD_INPUT, c->directory, 0, "holds the checkpoint of a run already");
    enum tri_status status = resume ? read_manifest(&m, c, error) : check_names(c, error);
    if (!status && resume && m.of != of)
        return tri_fail(error, TRI_BAD_INPUT, c->directory, 0, "holds a checkpoint of another version of the program");
    return status;
}

/* `resume`: it is to be read before it is written. */
static enum tri_status open_folder(struct par_checkpoint *c, bool resume, struct tri_error *error)
{
    c->folder = open_own_folder(c->directory);
    if (c->folder >= 0)
        return TRI_OK;
    if (errno == EPERM)
        return tri_fail(error, TRI_BAD_INPUT, c->directory, 0, "belongs to another user: choose another folder");
    if (resume)
        return tri_fail(error, TRI_BAD_INPUT, c->directory, 0, "holds no checkpoint: %s", strerror(errno));
    return tri_fail(error, TRI_CANNOT_WRITE, c->directory, 0, "cannot be used: %s", strerror(errno));
}

enum tri_status par_checkpoint_look(const char *directory, uint64_t of, struct tri_error *error)
{
    struct par_checkpoint c = par_checkpoint_closed(directory);
    enum tri_status status = open_folder(&c, true, error);
    status = status ? status : check_run(&c, true, of, error);
    par_checkpoint_close(&c, false);
    return status;
}

/* The lock, and then, of a run that goes on, what no other process changes any more. */
static enum tri_status lock_and_read(struct par_checkpoint *c, bool resume, struct tri_error *error)
{
    if (lock_folder(c))
        return resume ? read_manifest(&c->manifest, c, error) : TRI_OK;
    if (c->lock >= 0)
        return tri_fail(error, TRI_BAD_INPUT, c->directory, 0, "another process works on this checkpoint");
    return cannot_write(c->directory, tiles_name, error);
}

enum tri_status par_checkpoint_open(struct par_checkpoint *c, const char *directory, bool resume, uint64_t of,
                                    struct tri_error *error)
{
    *c = par_checkpoint_closed(directory);
    if (strlen(directory) > PAR_CHECKPOINT_PATH - 32)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "the name of the directory for checkpoints is too long");
    bool made = !resume && mkdir(directory, 0777) == 0;
    if (!resume && !made && errno != EEXIST)
        return tri_fail(error, TRI_CANNOT_WRITE, directory, 0, "cannot be made: %s", strerror(errno));
    enum tri_status status = open_folder(c, resume, error);
    status = status ? status : check_run(c, resume, of, error);
    if (!status && !resume)
        status = write_manifest(c, (struct par_manifest){.of = of, .made_directory = made}, error);
    status = status ? status : lock_and_read(c, resume, error);
    path_of(c->tiles_path, directory, tiles_name);
    c->spool = (struct par_spool){.file = c->lock, .path = c->tiles_path, .length = c->manifest.tiles_bytes};
    if (status)
        par_checkpoint_close(c, false);
    return status;
}

int64_t par_checkpoint_next(const struct par_checkpoint *c)
{
    return par_checkpoint_has_state(c) ? 1 - c->manifest.which : 0;
}

int par_checkpoint_piece(char path[PAR_CHECKPOINT_PATH], const char *directory, int64_t which, int rank, bool fresh)
{
    char name[64];
    snprintf(name, sizeof name, "piece-%d-%d", (int)which, rank);
    path_of(path, directory, name);
    const int folder = open_own_folder(directory);
    if (folder < 0)
        return -1;
    const int file = fresh ? create_file(folder, name) : open_to_read(folder, name), fault = errno;
    close(folder);
    errno = fault;
    return file;
}

/* Of however many ranks there have been. */
static void remove_pieces(int folder)
{
    DIR *list = list_folder(folder);
    for (const struct dirent *entry; list && (entry = readdir(list));)
        if (is_piece(entry->d_name))
            unlinkat(folder, entry->d_name, 0);
    if (list)
        closedir(list);
}

/* The manifest says of all the others that they are a run's: it goes last, and names no state as soon as that goes. */
static void remove_all(struct par_checkpoint *c)
{
    const struct par_manifest m = c->manifest;
    (void)write_manifest(c, manifest_of_none(&m, m.kind), NULL);
    remove_pieces(c->folder);
    unlinkat(c->folder, state_name[0], 0);
    unlinkat(c->folder, state_name[1], 0);
    unlinkat(c->folder, tiles_name, 0);
    unlinkat(c->folder, fresh_name, 0);
    unlinkat(c->folder, manifest_name, 0);
    if (m.made_directory)
        rmdir(c->directory);
}

void par_checkpoint_close(struct par_checkpoint *c, bool remove)
{
    assert(!remove || c->lock >= 0);
    if (remove)
        remove_all(c);
    if (c->lock >= 0)
        close(c->lock);
    if (c->folder >= 0)
        close(c->folder);
    c->lock = c->folder = c->spool.file = -1;
}

/* --- what it is of */

enum tri_status par_checkpoint_take(struct par_checkpoint *c, uint64_t run, struct tri_error *error)
{
    if (par_checkpoint_has_state(c) && run != c->manifest.run)
        return tri_fail(error, TRI_BAD_INPUT, c->directory, 0,
                        "is the checkpoint of another run: of another input, or with other switches");
    c->manifest.run = run;
    assert(c->lock >= 0);
    if (ftruncate(c->spool.file, (off_t)c->spool.length) != 0)
        return cannot_write(c->directory, tiles_name, error);
    return TRI_OK;
}

enum tri_status par_checkpoint_forget(struct par_checkpoint *c, enum par_state_kind kind, struct tri_error *error)
{
    enum tri_status status = write_manifest(c, manifest_of_none(&c->manifest, kind), error);
    if (status)
        return status;
    c->spool.length = c->spool.sent = 0;
    return ftruncate(c->spool.file, 0) == 0 ? TRI_OK : cannot_write(c->directory, tiles_name, error);
}

/* --- a state's file */

static bool is_zero(const char *bytes, size_t n) { return bytes[0] == 0 && memcmp(bytes, bytes + 1, n - 1) == 0; }

/* Writes what waits, which ends at f->place. Room that blocks have not used yet, most of a mesh while its first phase
 * runs, is zero, and stays a hole. The last of it, which is no whole number of blocks, goes by way of the cache, and so
 * does all where the file system knows no other. */
static bool write_waiting(struct par_state_file *f, size_t n)
{
    const int64_t place = f->place - (int64_t)n;
    const int flags = fcntl(f->file, F_GETFL);
    f->hash = tri_hash(f->hash, f->waiting, n);
    if (n == PAR_STATE_WRITE && is_zero(f->waiting, n))
        return true;
    const double began = tri_seconds();
    bool done = n == PAR_STATE_WRITE && tri_write_at(f->file, f->waiting, n, place);
    if (!done && (n < PAR_STATE_WRITE || (flags & O_DIRECT)))
        done = fcntl(f->file, F_SETFL, flags & ~O_DIRECT) == 0 && tri_write_at(f->file, f->waiting, n, place);
    f->writing += tri_seconds() - began;
    return done;
}

static void put_bytes(struct par_state_file *f, const char *at, size_t n)
{
    while (n > 0 && !f->failed) {
        const size_t waits = (size_t)(f->place % PAR_STATE_WRITE), room = PAR_STATE_WRITE - waits;
        const size_t part = n < room ? n : room;
        memcpy(f->waiting + waits, at, part);
        f->place += (int64_t)part;
        f->failed = part == room && !write_waiting(f, PAR_STATE_WRITE);
        at += part;
        n -= part;
    }
}

void par_carry(struct par_state_file *f, void *bytes, size_t n)
{
    if (n == 0 || f->failed)
        return;
    if (!f->reads) {
        put_bytes(f, bytes, n);
        return;
    }
    f->failed = !tri_read_again(f->file, bytes, n, f->place);
    f->place += (int64_t)n;
}

/* The file of a state, with all of it, on the disk. */
static enum tri_status write_state(const struct par_checkpoint *c, const char *name, struct par_state_file *to,
                                   par_state_walk *walk, void *user, struct tri_error *error)
{
    *to = (struct par_state_file){.file = create_file(c->folder, name)};
    to->failed = to->file < 0;
    if (posix_memalign((void **)&to->waiting, 1 << 12, PAR_STATE_WRITE) != 0) {
        close(to->file);
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for a checkpoint");
    }
    if (!to->failed)
        (void)fcntl(to->file, F_SETFL, fcntl(to->file, F_GETFL) | O_DIRECT);
    enum tri_status status = walk(to, user, error);
    bool done = !to->failed && write_waiting(to, (size_t)(to->place % PAR_STATE_WRITE)) &&
                ftruncate(to->file, (off_t)to->place) == 0;
    const double began = tri_seconds();
    done = done && end_file(c->folder, name, to->file);
    const int fault = errno;
    to->writing += tri_seconds() - began;
    if (to->file >= 0)
        done = close(to->file) == 0 && done;
    free(to->waiting);
    errno = fault;
    return status || done ? status : cannot_write(c->directory, name, error);
}

enum tri_status par_checkpoint_write(struct par_checkpoint *c, enum par_state_kind kind, int64_t n_ranks,
                                     int64_t triangles, par_state_walk *walk, void *user, struct tri_error *error)
{
    struct par_manifest m = c->manifest;
    struct par_state_file to;
    m.which = par_checkpoint_next(c);
    enum tri_status status = write_state(c, state_name[m.which], &to, walk, user, error);
    if (status)
        return status;
    if (fsync(c->spool.file) != 0)
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

static enum tri_status damaged(const struct par_checkpoint *c, struct tri_error *error)
{
    return tri_fail(error, TRI_BAD_INPUT, c->directory, 0, "the checkpoint's file %s is damaged",
                    state_name[c->manifest.which]);
}

/* Is all of it what has been written? */
static enum tri_status check(const struct par_checkpoint *c, int file, struct tri_error *error)
{
    const int64_t all = c->manifest.state_bytes;
    const struct tri_stop *stop = par_checkpoint_has_ranks(c) ? NULL : c->stop; /* ranks stop together, after a step */
    char *bytes = malloc(PAR_STATE_WRITE);
    uint64_t hash = 0;
    bool sound = true, stopped = false;
    for (int64_t place = 0; bytes && sound && !stopped && place < all; place += PAR_STATE_WRITE) {
        const size_t n = all - place < PAR_STATE_WRITE ? (size_t)(all - place) : PAR_STATE_WRITE;
        sound = tri_read_again(file, bytes, n, place);
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
    struct par_state_file from = {.file = open_to_read(c->folder, state_name[c->manifest.which]), .reads = true};
    if (from.file < 0)
        return damaged(c, error);
    enum tri_status status = check(c, from.file, error);
    status = status ? status : walk(&from, user, error);
    if (!status && (from.failed || from.place != c->manifest.state_bytes))
        status = damaged(c, error);
    close(from.file);
    return status;
}
