/* Safe outputs: temporary files, locks, names.
 *
 * All or nothing: once every file is closed only renames can fail. Before the first of them each file that is going to
 * be replaced gets a second name, by which it can be put back. */
#define _GNU_SOURCE /* O_DIRECT, sync_file_range */

#include "triangle/text/output.h"

#include <assert.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "triangle/base/at_place.h"
#include "triangle/text/names.h"
#include "triangle/text/text.h"

#ifndef O_DIRECT
#define O_DIRECT 0 /* the system has no such thing */
#endif
#ifndef SYNC_FILE_RANGE_WRITE
#define SYNC_FILE_RANGE_WRITE 0
#define SYNC_FILE_RANGE_WAIT_AFTER 0
#define sync_file_range(file, place, bytes, how) 0
#endif

enum {
    MAX_LINKS = 40,
    MAX_PATH = 4096,
    MAX_NAMES = 1000, /* temporary names to try */
    HOST_BYTES = 100, /* of the host's name in a temporary name, at most */
    NAME_BYTES = 200  /* of a temporary name: file systems allow 255 */
};

void tri_outputs_begin(struct tri_output_set *set) { *set = (struct tri_output_set){0}; }

/* Length of the directory part, final slash included; 0: the working directory. */
static size_t directory_length(const char *path)
{
    const char *const slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

/* directory_of's directory followed by name; malloc'ed. */
static char *beside(const char *directory_of, const char *name)
{
    return tri_name(directory_of, directory_length(directory_of), name);
}

static bool stat_directory(const char *path, struct stat *status)
{
    char name[MAX_PATH];
    const size_t length = directory_length(path);
    if (length + 2 > sizeof name)
        return false;
    memcpy(name, path, length);
    strcpy(name + length, ".");
    return stat(name, status) == 0;
}

/* Made by this user, the administrator or who owns the directory? Anybody else's may lead to what only we can write. */
static bool is_trusted_link(const char *path)
{
    struct stat link, directory;
    return lstat(path, &link) == 0 && stat_directory(path, &directory) &&
           (link.st_uid == geteuid() || link.st_uid == 0 || link.st_uid == directory.st_uid);
}

/* What a symbolic link at path points to, malloc'ed; NULL and errno: no link (EINVAL, ENOENT), or trouble. */
static char *follow(const char *path)
{
    char target[MAX_PATH];
    const ssize_t length = readlink(path, target, sizeof target);
    if (length < 0)
        return NULL;
    if (!is_trusted_link(path)) {
        errno = EPERM;
        return NULL;
    }
    if ((size_t)length == sizeof target) {
        errno = ENAMETOOLONG;
        return NULL;
    }
    target[length] = 0;
    return beside(target[0] == '/' ? "" : path, target);
}

/* The path behind all symbolic links, existing or not, malloc'ed; NULL and errno on failure. Renaming onto it keeps the
 * links. */
static char *resolve(const char *path)
{
    char *resolved = beside("", path);
    for (int i = 0; resolved && i < MAX_LINKS; i++) {
        char *const next = follow(resolved);
        if (!next && (errno == EINVAL || errno == ENOENT))
            return resolved;
        const int reason = errno;
        free(resolved);
        errno = reason;
        resolved = next;
    }
    if (resolved)
        errno = ELOOP;
    free(resolved);
    return NULL;
}

static enum tri_status cannot_create(const struct tri_output *output, struct tri_error *error)
{
    const int reason = errno;
    if (reason == ENOMEM)
        return tri_fail(error, TRI_NO_MEMORY, output->path, 0, "no memory to create the file");
    return tri_fail_system(error, TRI_CANNOT_WRITE, output->path, "cannot create", reason);
}

/* --- temporary files */

/* ".tri-<host>-", with which the names of this host begin. */
static void put_prefix(char name[NAME_BYTES])
{
    char host[HOST_BYTES] = "";
    if (gethostname(host, sizeof host - 1) != 0) /* a longer name is cut, with or without an error */
        host[sizeof host - 1] = 0;
    for (char *at = host; *at; at++)
        if (*at == '/')
            *at = '_';
    snprintf(name, NAME_BYTES, ".tri-%s-", host);
}

/* A name for process and number i beside the path, malloc'ed. Short, since the path's own name may be as long as names
 * can be. */
static char *temporary_name(const char *path, int i)
{
    char name[NAME_BYTES];
    put_prefix(name);
    size_t length = strlen(name);
    snprintf(name + length, sizeof name - length, "%ld-%d.tmp", (long)getpid(), i);
    return beside(path, name);
}

/* The process in a name of this host; 0: another host's, or no name of a temporary file. */
static long process_of(const char *name, const char *prefix)
{
    size_t length = strlen(prefix);
    if (strncmp(name, prefix, length) != 0)
        return 0;
    const char *at = name + length;
    size_t process = strspn(at, "0123456789");
    if (process == 0 || process > 9 || at[process] != '-')
        return 0;
    size_t number = strspn(at + process + 1, "0123456789");
    return number > 0 && strcmp(at + process + 1 + number, ".tmp") == 0 ? strtol(at, NULL, 10) : 0;
}

enum lock { LOCKED, HELD_BY_ANOTHER, NO_LOCKS };

/* The lock goes when this process closes the file, by any descriptor, or dies. */
static enum lock try_lock(int file)
{
    struct flock whole = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    if (fcntl(file, F_SETLK, &whole) == 0)
        return LOCKED;
    return errno == EACCES || errno == EAGAIN ? HELD_BY_ANOTHER : NO_LOCKS;
}

/* Removes the file if nobody works on it. Who makes one looks, once he has the lock, whether it is still there. */
static void remove_if_left(int directory, const char *name)
{
    struct stat status;
    int file = openat(directory, name, O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (file < 0)
        return;
    if (fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == geteuid() && try_lock(file) == LOCKED)
        unlinkat(directory, name, 0);
    close(file);
}

/* Temporary files beside `path` whose processes are gone. A file of this process is never opened: to close it again
 * would drop its lock. */
static void remove_left(const char *path)
{
    char prefix[NAME_BYTES];
    char *name = beside(path, ".");
    DIR *directory = name ? opendir(name) : NULL;
    free(name);
    put_prefix(prefix);
    for (struct dirent *entry; directory && (entry = readdir(directory));) {
        long process = process_of(entry->d_name, prefix);
        if (process > 0 && process != (long)getpid() && kill((pid_t)process, 0) != 0 && errno == ESRCH)
            remove_if_left(dirfd(directory), entry->d_name);
    }
    if (directory)
        closedir(directory);
}

static bool is_same_directory(const char *a, const char *b)
{
    size_t length = directory_length(a);
    return directory_length(b) == length && memcmp(a, b, length) == 0;
}

static void tidy_up(const struct tri_output_set *set, const char *path)
{
    for (int i = 0; i < set->n; i++)
        if (is_same_directory(set->outputs[i].path, path)) /* done already */
            return;
    remove_left(path);
}

/* Is the file ours, and still there? Somebody who tidied up may have come between its making and its lock. */
static bool is_kept(int file)
{
    struct stat status;
    return try_lock(file) != HELD_BY_ANOTHER && fstat(file, &status) == 0 && status.st_nlink > 0;
}

/* O_EXCL decides between processes and threads that try the same name. The mode is that of any new file, so that the
 * process's mask applies. */
static enum tri_status create_temporary(struct tri_output_set *set, struct tri_output *output, struct tri_error *error)
{
    for (int i = 0; i < MAX_NAMES; i++) {
        char *const name = temporary_name(output->path, set->next_name++);
        if (!name)
            return tri_fail(error, TRI_NO_MEMORY, output->path, 0, "no memory to create the file");
        output->file = open(name, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (output->file >= 0 && is_kept(output->file)) {
            output->temporary = name;
            return TRI_OK;
        }
        const int reason = errno;
        free(name);
        if (output->file >= 0) {
            close(output->file);
            output->file = -1;
        } else if (reason != EEXIST && reason != EINTR) {
            errno = reason;
            return cannot_create(output, error);
        }
    }
    return tri_fail(error, TRI_CANNOT_WRITE, output->path, 0, "cannot create: no free name for a temporary file");
}

/* --- opening */

/* A device or a pipe: there is nothing to replace. */
static enum tri_status open_in_place(struct tri_output *output, struct tri_error *error)
{
    do
        output->file = open(output->path, O_WRONLY | O_CLOEXEC | O_NOCTTY);
    while (output->file < 0 && errno == EINTR && !tri_stop_is_asked(output->stop)); /* a pipe that nobody reads */
    if (output->file < 0)
        return errno == EINTR ? tri_fail_stopped(error) : cannot_create(output, error);
    struct stat now;
    const int known = fstat(output->file, &now);
    if (known == 0 && !S_ISREG(now.st_mode))
        return TRI_OK;
    close(output->file);
    output->file = -1;
    return tri_fail(error, TRI_CANNOT_WRITE, output->path, 0, "has become another file since it was looked at");
}

/* Refuses what cannot become a file. */
static enum tri_status check_target(const struct tri_output *output, const struct stat *old, struct tri_error *error)
{
    const bool has_name = output->path[directory_length(output->path)] != 0;
    if (!has_name || (old && S_ISDIR(old->st_mode))) {
        errno = EISDIR;
        return cannot_create(output, error);
    }
    return old && access(output->path, W_OK) != 0 ? cannot_create(output, error) : TRI_OK;
}

/* old: of the file at path; NULL: there is none. */
static struct tri_output_place place_of(const char *path, const struct stat *old)
{
    struct stat directory;
    const bool is_known = old ? S_ISREG(old->st_mode) : stat_directory(path, &directory);
    const struct stat *at = old ? old : &directory;
    return is_known ? (struct tri_output_place){true, old != NULL, (uint64_t)at->st_dev, (uint64_t)at->st_ino}
                    : (struct tri_output_place){0};
}

static bool is_same_place(const struct tri_output_place *a, const char *path_a, const struct tri_output_place *b,
                          const char *path_b)
{
    return a->known && b->known && a->exists == b->exists && a->device == b->device && a->node == b->node &&
           (a->exists || strcmp(path_a + directory_length(path_a), path_b + directory_length(path_b)) == 0);
}

bool tri_is_same_file(const char *a, const char *b)
{
    struct stat old;
    const struct tri_output_place of_a = place_of(a, stat(a, &old) == 0 ? &old : NULL);
    const struct tri_output_place of_b = place_of(b, stat(b, &old) == 0 ? &old : NULL);
    return is_same_place(&of_a, a, &of_b, b);
}

/* No two outputs are one file: the second would replace the first. The system is asked once for each, not for pairs. */
static enum tri_status check_others(const struct tri_output_set *set, const struct tri_output *output,
                                    struct tri_error *error)
{
    for (int i = 0; i < set->n; i++)
        if (is_same_place(&set->outputs[i].place, set->outputs[i].path, &output->place, output->path))
            return tri_fail(error, TRI_CANNOT_WRITE, output->path, 0, "would be written twice: %.300s is the same file",
                            set->outputs[i].path);
    return TRI_OK;
}

static enum tri_status open_output(struct tri_output_set *set, struct tri_output *output, const char *path,
                                   struct tri_error *error)
{
    struct stat old;
    const bool exists = stat(path, &old) == 0, replaces = exists && S_ISREG(old.st_mode);
    output->path = !exists || replaces ? resolve(path) : beside("", path); /* /dev/stdout must not be followed */
    if (!output->path && errno == EPERM)
        return tri_fail(error, TRI_CANNOT_WRITE, path, 0, "is a link that another user made, which is not followed");
    if (!output->path)
        return errno == ENOMEM ? tri_fail(error, TRI_NO_MEMORY, path, 0, "no memory to create the file")
                               : tri_fail_system(error, TRI_CANNOT_WRITE, path, "cannot create", errno);
    output->place = place_of(output->path, exists ? &old : NULL);
    enum tri_status status = check_target(output, exists ? &old : NULL, error);
    status = status ? status : check_others(set, output, error);
    if (status != TRI_OK)
        return status;
    if (exists && !replaces)
        return set->trial ? TRI_OK : open_in_place(output, error);
    tidy_up(set, output->path);
    status = create_temporary(set, output, error);
    output->replaces = replaces;
    if (status == TRI_OK && replaces && fchmod(output->file, old.st_mode & 0777) != 0)
        return cannot_create(output, error);
    return status;
}

/* Closing any descriptor of a file drops its lock: so this comes right before the other one is closed. */
static void close_direct(struct tri_output *output)
{
    if (output->direct >= 0)
        close(output->direct);
    output->direct = -1;
}

static void discard(struct tri_output *output)
{
    close_direct(output);
    if (output->file >= 0)
        close(output->file);
    if (output->temporary)
        unlink(output->temporary);
    if (output->old)
        unlink(output->old);
    free(output->old);
    free(output->temporary);
    free(output->path);
    *output = (struct tri_output){.file = -1, .direct = -1};
}

enum tri_status tri_output_open(struct tri_output_set *set, const char *path, struct tri_output **output,
                                struct tri_error *error)
{
    *output = NULL;
    if (set->n == TRI_MAX_OUTPUTS)
        return tri_fail(error, TRI_CANNOT_WRITE, path, 0, "more than %d files at a time", TRI_MAX_OUTPUTS);
    struct tri_output new = {.file = -1, .direct = -1, .stop = set->stop};
    const enum tri_status status = open_output(set, &new, path, error);
    if (status != TRI_OK) {
        discard(&new);
        return status;
    }
    set->outputs[set->n] = new;
    *output = &set->outputs[set->n++];
    return TRI_OK;
}

enum tri_status tri_output_restart(struct tri_output *output, struct tri_error *error)
{
    if (!tri_output_has_places(output) || ftruncate(output->file, 0) != 0)
        return tri_fail(error, TRI_CANNOT_WRITE, output->path, 0, "cannot be written a second time");
    output->size = 0;
    output->failed = false;
    return TRI_OK;
}

/* --- writing and closing */

/* write() or, for files, pwrite() of as much as the system takes at once. */
static ssize_t write_some(const struct tri_output *output, uint64_t place, const char *data, size_t size)
{
    return tri_output_has_places(output) ? pwrite(output->file, data, size, (off_t)place)
                                         : write(output->file, data, size);
}

int tri_output_write_at(const struct tri_output *output, uint64_t place, const char *data, size_t size)
{
    while (size > 0) {
        if (tri_stop_is_asked(output->stop))
            return TRI_OUTPUT_STOPPED;
        const ssize_t written = write_some(output, place, data, size);
        if (written < 0 && errno != EINTR)
            return errno;
        if (written > 0) {
            data += written;
            place += (uint64_t)written;
            size -= (size_t)written;
        }
    }
    return 0;
}

enum tri_status tri_output_conclude(struct tri_output *output, int result, struct tri_error *error)
{
    if (result == 0)
        return TRI_OK;
    if (result == TRI_OUTPUT_STOPPED)
        return tri_fail_stopped(error);
    output->failed = true;
    return tri_fail_system(error, TRI_CANNOT_WRITE, output->path, "cannot write", result);
}

int tri_output_direct(struct tri_output *output)
{
    char name[64];
    assert(tri_output_has_places(output));
    if (output->direct < 0 && !output->no_direct) {
        snprintf(name, sizeof name, "/proc/self/fd/%d", output->file);
        output->direct = O_DIRECT ? open(name, O_WRONLY | O_DIRECT | O_CLOEXEC) : -1;
        output->no_direct = output->direct < 0;
    }
    return output->direct >= 0 ? output->direct : output->file;
}

/* 0, or why not; systems that cannot be asked for it are not. */
static int sync_to_disk(int file)
{
    int result;
    do
        result = fsync(file);
    while (result != 0 && errno == EINTR);
    return result == 0 || errno == EINVAL || errno == EROFS ? 0 : errno;
}

enum tri_status tri_output_sync(struct tri_output *output, struct tri_error *error)
{
    return tri_output_conclude(output, sync_to_disk(output->file), error);
}

/* Starts the writing of an open file to the disk, if the system has a call for that. Returns its bytes; 0: it is not
 * open. */
static uint64_t send_off(const struct tri_output *output)
{
    struct stat status;
    if (!tri_output_has_places(output) || fstat(output->file, &status) != 0)
        return 0;
    (void)sync_file_range(output->file, 0, 0, SYNC_FILE_RANGE_WRITE);
    return (uint64_t)status.st_size;
}

/* In pieces, between which whoever asks for the end is heard. */
static enum tri_status sync_in_pieces(struct tri_output *output, struct tri_error *error)
{
    enum { PIECE = 1 << 24 };
    const uint64_t bytes = send_off(output);
    for (uint64_t place = 0; place < bytes; place += PIECE) {
        (void)sync_file_range(output->file, (off_t)place, PIECE, SYNC_FILE_RANGE_WRITE | SYNC_FILE_RANGE_WAIT_AFTER);
        if (tri_stop_is_asked(output->stop))
            return tri_fail_stopped(error);
    }
    return bytes > 0 ? tri_output_sync(output, error) : TRI_OK;
}

/* All are sent off before one is waited for: so a journal takes in all of them at once. */
enum tri_status tri_outputs_sync(struct tri_output_set *set, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    uint64_t bytes = 0;
    for (int i = 0; i < set->n; i++)
        bytes += send_off(&set->outputs[i]);
    set->waits = bytes >= TRI_WAITED_FOR;
    for (int i = 0; set->waits && !status && i < set->n; i++)
        status = sync_in_pieces(&set->outputs[i], error);
    return status;
}

uint64_t tri_output_reserve(struct tri_output *output, size_t size)
{
    const uint64_t place = output->size;
    output->size += size;
    return place;
}

enum tri_status tri_output_write(struct tri_output *output, const char *data, size_t size, struct tri_error *error)
{
    const uint64_t place = tri_output_reserve(output, size);
    return tri_output_conclude(output, tri_output_write_at(output, place, data, size), error);
}

enum { SHIFT_BYTES = 1 << 20 };

/* Forwards from the end, so that nothing is overwritten before it has been moved; backwards from the begin. */
static int move_all(struct tri_output *output, uint64_t from, int64_t by, char *buffer)
{
    const uint64_t end = output->size;
    int result = 0;
    for (uint64_t done = 0; from + done < end && !result;) {
        const uint64_t left = end - from - done;
        const size_t n = left < SHIFT_BYTES ? (size_t)left : SHIFT_BYTES;
        const uint64_t at = by > 0 ? end - done - n : from + done;
        result = tri_read_again(output->file, buffer, n, at)
                     ? tri_output_write_at(output, at + (uint64_t)by, buffer, n)
                     : errno;
        done += n;
    }
    output->size = end + (uint64_t)by;
    if (!result && by < 0 && ftruncate(output->file, (off_t)output->size) != 0)
        result = errno;
    return result;
}

enum tri_status tri_output_shift(struct tri_output *output, uint64_t from, int64_t by, struct tri_error *error)
{
    assert(tri_output_has_places(output) && from <= output->size && (by >= 0 || from >= (uint64_t)-by));
    char *buffer = malloc(SHIFT_BYTES);
    if (!buffer)
        return tri_fail(error, TRI_NO_MEMORY, output->path, 0, "no memory to write the file");
    const int result = by ? move_all(output, from, by, buffer) : 0;
    free(buffer);
    return tri_output_conclude(output, result, error);
}

/* Some file systems report only here that the data found no room. */
static enum tri_status close_output(struct tri_output *output, struct tri_error *error)
{
    if (output->failed)
        return tri_fail(error, TRI_CANNOT_WRITE, output->path, 0, "the file is not complete");
    close_direct(output);
    const int result = output->file < 0 ? 0 : close(output->file);
    output->file = -1;
    if (result != 0 && errno != EINTR) /* after EINTR the descriptor is closed all the same */
        return tri_fail_system(error, TRI_CANNOT_WRITE, output->path, "cannot write", errno);
    return TRI_OK;
}

/* --- final names */

/* A second name for the file that is going to be replaced, if there is one. */
static void keep_old(struct tri_output_set *set, struct tri_output *output)
{
    for (int i = 0; output->temporary && !output->old && i < MAX_NAMES; i++) {
        char *const name = temporary_name(output->path, set->next_name++);
        if (name && link(output->path, name) == 0) {
            output->old = name;
            return;
        }
        const bool taken = name && errno == EEXIST;
        free(name);
        if (!taken)
            return;
    }
}

static enum tri_status rename_output(struct tri_output *output, struct tri_error *error)
{
    if (!output->temporary)
        return TRI_OK;
    if (rename(output->temporary, output->path) != 0)
        return tri_fail_system(error, TRI_CANNOT_WRITE, output->path, "cannot create", errno);
    free(output->temporary);
    output->temporary = NULL;
    output->renamed = true;
    return TRI_OK;
}

/* What stood under the name before stands there again: the old file, or none. */
static void put_back(struct tri_output *output)
{
    if (output->renamed && output->old && rename(output->old, output->path) == 0) {
        free(output->old);
        output->old = NULL;
    } else if (output->renamed && !output->old && !output->replaces) {
        unlink(output->path);
    }
}

/* So the new name is on the disk. A folder that cannot be read is passed over. */
static enum tri_status sync_folder(const struct tri_output *output, struct tri_error *error)
{
    char *name = beside(output->path, ".");
    const int folder = name ? open(name, O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
    const int result = folder >= 0 ? sync_to_disk(folder) : 0;
    if (folder >= 0)
        close(folder);
    free(name);
    return result ? tri_fail_system(error, TRI_CANNOT_WRITE, output->path, "cannot create", result) : TRI_OK;
}

enum tri_status tri_outputs_commit(struct tri_output_set *set, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    for (int i = 0; status == TRI_OK && i < set->n; i++)
        status = close_output(&set->outputs[i], error);
    for (int i = 0; status == TRI_OK && i < set->n; i++)
        keep_old(set, &set->outputs[i]);
    for (int i = 0; status == TRI_OK && i < set->n; i++)
        status = rename_output(&set->outputs[i], error);
    for (int i = 0; set->waits && status == TRI_OK && i < set->n; i++)
        if (i == 0 || !is_same_directory(set->outputs[i - 1].path, set->outputs[i].path))
            status = sync_folder(&set->outputs[i], error);
    for (int i = 0; status != TRI_OK && i < set->n; i++)
        put_back(&set->outputs[i]);
    tri_outputs_abort(set);
    return status;
}

void tri_outputs_abort(struct tri_output_set *set)
{
    for (int i = 0; i < set->n; i++)
        discard(&set->outputs[i]);
    set->n = 0;
}

