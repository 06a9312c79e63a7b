/* Safe output: temporary files, locks, final names.
 *
 * All or nothing: after every file has been closed, only renames can fail. Before the first rename, each file to be
 * replaced gets a second name, from which it can be restored. */
#include "triangle/text/output.h"

#include <assert.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/system.h"
#include "triangle/text/names.h"

enum {
    MAX_NAMES = 1000, /* temporary names to try */
    HOST_BYTES = 100, /* longest host name in a temporary name */
    NAME_BYTES = 200  /* longest temporary name; file systems allow 255 bytes */
};

void tri_outputs_begin(struct tri_output_set *set) { *set = (struct tri_output_set){0}; }

/* Returns the folder of the path directory_of followed by name; from malloc. */
static char *path_beside(const char *directory_of, const char *name)
{
    return tri_name(directory_of, tri_path_folder_length(directory_of), name);
}

static enum tri_status cannot_create(const struct tri_output *output, struct tri_error *error)
{
    const int reason = errno;
    if (reason == ENOMEM)
        return tri_fail(error, TRI_NO_MEMORY, output->path, 0, "no memory to create the file");
    return tri_fail_system(error, TRI_CANNOT_WRITE, output->path, "cannot create", reason);
}

/* --- temporary files */

/* Stores ".tri-<host>-", the prefix of temporary names of this host. */
static void put_prefix(char name[NAME_BYTES])
{
    char host[HOST_BYTES];
    (void)tri_host_name(host, sizeof host);
    for (char *at = host; *at; at++)
        if (*at == '/')
            *at = '_';
    snprintf(name, NAME_BYTES, ".tri-%s-", host);
}

/* Returns a temporary name for this process and number i, in the folder of the path; from malloc. Does not contain the
 * path's own name, which may have the maximum length already. */
static char *temporary_name(const char *path, int i)
{
    char name[NAME_BYTES];
    put_prefix(name);
    size_t length = strlen(name);
    snprintf(name + length, sizeof name - length, "%ld-%d.tmp", tri_process(), i);
    return path_beside(path, name);
}

/* Returns the number of the process that made a temporary file of this host; 0: the name is not of this kind. */
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

/* State while leftover temporary files in one folder are removed. */
struct leftovers {
    tri_file folder;
    char prefix[NAME_BYTES]; /* prefix of temporary names of this host */
};

/* Removes the file if its process no longer exists and no process holds its lock. (A process that creates a file
 * checks, after locking it, that it still exists.) Files of this process are never opened, because closing one would
 * drop its lock. */
static bool remove_if_left(void *user, const char *name)
{
    const struct leftovers *left = user;
    const long process = process_of(name, left->prefix);
    if (process <= 0 || process == tri_process() || !tri_process_is_gone(process))
        return true;
    const tri_file file = tri_folder_file(left->folder, name, TRI_FOLDER_CHANGE);
    if (file != TRI_NO_FILE && tri_file_lock(file) == TRI_LOCKED)
        (void)tri_folder_unlink(left->folder, name);
    (void)tri_file_close(file);
    return true;
}

static tri_file open_folder_of(const char *path)
{
    char *name = path_beside(path, ".");
    const tri_file folder = name ? tri_folder_open(name, false) : TRI_NO_FILE;
    free(name);
    return folder;
}

/* Removes temporary files in the folder of `path` whose processes no longer exist. */
static void remove_leftovers(const char *path)
{
    struct leftovers left = {.folder = open_folder_of(path)};
    put_prefix(left.prefix);
    if (left.folder != TRI_NO_FILE)
        (void)tri_folder_list(left.folder, remove_if_left, &left);
    (void)tri_file_close(left.folder);
}

static bool is_same_directory(const char *a, const char *b)
{
    size_t length = tri_path_folder_length(a);
    return tri_path_folder_length(b) == length && memcmp(a, b, length) == 0;
}

static void remove_leftovers_once(const struct tri_output_set *set, const char *path)
{
    for (int i = 0; i < set->n; i++)
        if (is_same_directory(set->outputs[i].path, path)) /* done before */
            return;
    remove_leftovers(path);
}

/* Locks a new file. Returns false if another process has locked or removed it since it was created. */
static bool lock_new(tri_file file)
{
    struct tri_file_facts facts;
    return tri_file_lock(file) != TRI_LOCKED_BY_ANOTHER && tri_file_get_facts(file, &facts) && facts.names > 0;
}

/* If several processes or threads try the same name, the system lets only one of them create it. */
static enum tri_status create_temporary(struct tri_output_set *set, struct tri_output *output, struct tri_error *error)
{
    for (int i = 0; i < MAX_NAMES; i++) {
        char *const name = temporary_name(output->path, set->next_name++);
        if (!name)
            return tri_fail(error, TRI_NO_MEMORY, output->path, 0, "no memory to create the file");
        output->file = tri_file_open(name, TRI_OPEN_NEW);
        if (output->file != TRI_NO_FILE && lock_new(output->file)) {
            output->temporary = name;
            return TRI_OK;
        }
        const int reason = errno;
        free(name);
        if (output->file != TRI_NO_FILE) {
            (void)tri_file_close(output->file);
            output->file = TRI_NO_FILE;
        } else if (reason != EEXIST && reason != EINTR) {
            errno = reason;
            return cannot_create(output, error);
        }
    }
    return tri_fail(error, TRI_CANNOT_WRITE, output->path, 0, "cannot create: no free name for a temporary file");
}

/* --- opening */

/* Opens a device or pipe, which is written directly. */
static enum tri_status open_in_place(struct tri_output *output, struct tri_error *error)
{
    do
        output->file = tri_file_open(output->path, TRI_OPEN_DEVICE);
    while (output->file == TRI_NO_FILE && errno == EINTR && !tri_stop_is_asked(output->stop));
    if (output->file == TRI_NO_FILE)
        return errno == EINTR ? tri_fail_stopped(error) : cannot_create(output, error);
    struct tri_file_facts now;
    if (tri_file_get_facts(output->file, &now) && now.kind != TRI_REGULAR)
        return TRI_OK;
    (void)tri_file_close(output->file);
    output->file = TRI_NO_FILE;
    return tri_fail(error, TRI_CANNOT_WRITE, output->path, 0, "was replaced by another file in the meantime");
}

/* Rejects paths that cannot become a file. */
static enum tri_status check_target(const struct tri_output *output, const struct tri_file_facts *old,
                                    struct tri_error *error)
{
    const bool has_name = output->path[tri_path_folder_length(output->path)] != 0;
    if (!has_name || (old && old->kind == TRI_FOLDER)) {
        errno = EISDIR;
        return cannot_create(output, error);
    }
    return old && !tri_path_allows(output->path, TRI_WRITABLE) ? cannot_create(output, error) : TRI_OK;
}

/* old: facts about the file at path; NULL: there is none. */
static struct tri_output_place place_of(const char *path, const struct tri_file_facts *old)
{
    char folder[TRI_PATH];
    struct tri_file_facts at;
    const int length = snprintf(folder, sizeof folder, "%.*s.", (int)tri_path_folder_length(path), path);
    const bool is_whole = length >= 0 && (size_t)length < sizeof folder;
    const bool is_known = old ? old->kind == TRI_REGULAR : is_whole && tri_path_get_facts(folder, &at);
    if (!is_known)
        return (struct tri_output_place){0};
    at = old ? *old : at;
    return (struct tri_output_place){true, old != NULL, at.device, at.node};
}

static bool is_same_place(const struct tri_output_place *a, const char *path_a, const struct tri_output_place *b,
                          const char *path_b)
{
    return a->known && b->known && a->exists == b->exists && a->device == b->device && a->node == b->node &&
           (a->exists || strcmp(path_a + tri_path_folder_length(path_a), path_b + tri_path_folder_length(path_b)) == 0);
}

bool tri_is_same_file(const char *a, const char *b)
{
    struct tri_file_facts old;
    const struct tri_output_place of_a = place_of(a, tri_path_get_facts(a, &old) ? &old : NULL);
    const struct tri_output_place of_b = place_of(b, tri_path_get_facts(b, &old) ? &old : NULL);
    return is_same_place(&of_a, a, &of_b, b);
}

/* Checks that no other output is the same file: the second would replace the first. Needs one system call per output,
 * not per pair. */
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
    struct tri_file_facts old;
    const bool exists = tri_path_get_facts(path, &old), replaces = exists && old.kind == TRI_REGULAR;
    output->path = !exists || replaces ? tri_path_resolve(path)
                                       : path_beside("", path); /* /dev/stdout must not be resolved */
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
    remove_leftovers_once(set, output->path);
    status = create_temporary(set, output, error);
    output->replaces = replaces;
    if (status == TRI_OK && replaces && !tri_file_set_permissions(output->file, &old))
        return cannot_create(output, error);
    return status;
}

/* Closing any descriptor of a file drops the lock, so this is called just before the other one is closed. */
static void close_direct(struct tri_output *output)
{
    (void)tri_file_close(output->direct);
    output->direct = TRI_NO_FILE;
}

static void discard(struct tri_output *output)
{
    close_direct(output);
    (void)tri_file_close(output->file);
    if (output->temporary)
        (void)tri_path_remove(output->temporary);
    if (output->old)
        (void)tri_path_remove(output->old);
    free(output->old);
    free(output->temporary);
    free(output->path);
    *output = (struct tri_output){.file = TRI_NO_FILE, .direct = TRI_NO_FILE};
}

enum tri_status tri_output_open(struct tri_output_set *set, const char *path, struct tri_output **output,
                                struct tri_error *error)
{
    *output = NULL;
    if (set->n == TRI_MAX_OUTPUTS)
        return tri_fail(error, TRI_CANNOT_WRITE, path, 0, "more than %d files at a time", TRI_MAX_OUTPUTS);
    struct tri_output new = {.file = TRI_NO_FILE, .direct = TRI_NO_FILE, .stop = set->stop};
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
    if (!tri_output_has_offsets(output) || !tri_file_set_size(output->file, 0))
        return tri_fail(error, TRI_CANNOT_WRITE, output->path, 0, "cannot be written a second time");
    output->size = 0;
    output->failed = false;
    return TRI_OK;
}

/* --- writing and closing */

static int64_t write_some(const struct tri_output *output, uint64_t place, const char *data, size_t size)
{
    return tri_output_has_offsets(output) ? tri_write_some(output->file, data, size, place)
                                         : tri_write_next(output->file, data, size);
}

int tri_output_write_at(const struct tri_output *output, uint64_t place, const char *data, size_t size)
{
    while (size > 0) {
        if (tri_stop_is_asked(output->stop))
            return TRI_OUTPUT_STOPPED;
        const int64_t written = write_some(output, place, data, size);
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

tri_file tri_output_direct(struct tri_output *output)
{
    assert(tri_output_has_offsets(output));
    if (output->direct == TRI_NO_FILE && !output->no_direct) {
        output->direct = tri_file_direct(output->file);
        output->no_direct = output->direct == TRI_NO_FILE;
    }
    return output->no_direct ? output->file : output->direct;
}

/* Waits until everything written is on the disk. Does nothing if the system cannot sync this file. */
static enum tri_status sync_output(struct tri_output *output, struct tri_error *error)
{
    return tri_output_conclude(output, tri_file_sync(output->file) ? 0 : errno, error);
}

/* Starts writing an open file to the disk, if the system has a call for that. Returns its size; 0: it is not open. */
static uint64_t start_sync(const struct tri_output *output)
{
    struct tri_file_facts facts;
    if (!tri_output_has_offsets(output) || !tri_file_get_facts(output->file, &facts))
        return 0;
    tri_file_start_sync(output->file, 0, 0);
    return facts.size;
}

/* Syncs in pieces, and checks between them for a request to stop. */
static enum tri_status sync_in_pieces(struct tri_output *output, struct tri_error *error)
{
    enum { PIECE = 1 << 24 };
    const uint64_t bytes = start_sync(output);
    for (uint64_t place = 0; place < bytes; place += PIECE) {
        tri_file_finish_sync(output->file, place, PIECE);
        if (tri_stop_is_asked(output->stop))
            return tri_fail_stopped(error);
    }
    return bytes > 0 ? sync_output(output, error) : TRI_OK;
}

/* Starts writing all files before waiting for one, so that a journaling file system commits all of them together. */
enum tri_status tri_outputs_sync(struct tri_output_set *set, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    uint64_t bytes = 0;
    for (int i = 0; i < set->n; i++)
        bytes += start_sync(&set->outputs[i]);
    set->waits = bytes >= TRI_SYNC_BYTES;
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

/* Moves bytes forwards starting from the end, or backwards starting from the beginning, so that nothing is overwritten
 * before it has been moved. */
static int move_bytes(struct tri_output *output, uint64_t from, int64_t by, char *buffer)
{
    const uint64_t end = output->size;
    int result = 0;
    for (uint64_t done = 0; from + done < end && !result;) {
        const uint64_t left = end - from - done;
        const size_t n = left < SHIFT_BYTES ? (size_t)left : SHIFT_BYTES;
        const uint64_t at = by > 0 ? end - done - n : from + done;
        result = tri_read_back(output->file, buffer, n, at)
                     ? tri_output_write_at(output, at + (uint64_t)by, buffer, n)
                     : errno;
        done += n;
    }
    output->size = end + (uint64_t)by;
    if (!result && by < 0 && !tri_file_set_size(output->file, output->size))
        result = errno;
    return result;
}

enum tri_status tri_output_shift(struct tri_output *output, uint64_t from, int64_t by, struct tri_error *error)
{
    assert(tri_output_has_offsets(output) && from <= output->size && (by >= 0 || from >= (uint64_t)-by));
    char *buffer = malloc(SHIFT_BYTES);
    if (!buffer)
        return tri_fail(error, TRI_NO_MEMORY, output->path, 0, "no memory to write the file");
    const int result = by ? move_bytes(output, from, by, buffer) : 0;
    free(buffer);
    return tri_output_conclude(output, result, error);
}

/* Closes the file, if it is open. */
static enum tri_status close_file(struct tri_output *output, struct tri_error *error)
{
    const bool closed = tri_file_close(output->file);
    output->file = TRI_NO_FILE;
    return closed ? TRI_OK : tri_fail_system(error, TRI_CANNOT_WRITE, output->path, "cannot write", errno);
}

static enum tri_status close_output(struct tri_output *output, struct tri_error *error)
{
    if (output->failed)
        return tri_fail(error, TRI_CANNOT_WRITE, output->path, 0, "the file is not complete");
    close_direct(output);
    return close_file(output, error);
}

/* --- renaming */

/* Gives the file to be replaced, if there is one, a second name. */
static void link_old(struct tri_output_set *set, struct tri_output *output)
{
    for (int i = 0; output->temporary && !output->old && i < MAX_NAMES; i++) {
        char *const name = temporary_name(output->path, set->next_name++);
        if (name && tri_path_link(output->path, name)) {
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
    if (!tri_path_rename(output->temporary, output->path))
        return tri_fail_system(error, TRI_CANNOT_WRITE, output->path, "cannot create", errno);
    free(output->temporary);
    output->temporary = NULL;
    output->renamed = true;
    return TRI_OK;
}

/* Restores what was under the name before: the old file, or none. */
static void restore_old(struct tri_output *output)
{
    if (output->renamed && output->old && tri_path_rename(output->old, output->path)) {
        free(output->old);
        output->old = NULL;
    } else if (output->renamed && !output->old && !output->replaces) {
        (void)tri_path_remove(output->path);
    }
}

/* Makes sure that the new name is on the disk. Ignores folders that cannot be opened. */
static enum tri_status sync_folder(const struct tri_output *output, struct tri_error *error)
{
    const tri_file folder = open_folder_of(output->path);
    const int result = folder == TRI_NO_FILE || tri_file_sync(folder) ? 0 : errno;
    (void)tri_file_close(folder);
    return result ? tri_fail_system(error, TRI_CANNOT_WRITE, output->path, "cannot create", result) : TRI_OK;
}

enum tri_status tri_outputs_commit(struct tri_output_set *set, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    for (int i = 0; status == TRI_OK && i < set->n; i++)
        status = close_output(&set->outputs[i], error);
    for (int i = 0; status == TRI_OK && i < set->n; i++)
        link_old(set, &set->outputs[i]);
    for (int i = 0; status == TRI_OK && i < set->n; i++)
        status = rename_output(&set->outputs[i], error);
    for (int i = 0; set->waits && status == TRI_OK && i < set->n; i++)
        if (i == 0 || !is_same_directory(set->outputs[i - 1].path, set->outputs[i].path))
            status = sync_folder(&set->outputs[i], error);
    for (int i = 0; status != TRI_OK && i < set->n; i++)
        restore_old(&set->outputs[i]);
    tri_outputs_abort(set);
    return status;
}

void tri_outputs_abort(struct tri_output_set *set)
{
    for (int i = 0; i < set->n; i++)
        discard(&set->outputs[i]);
    set->n = 0;
}

/* --- files written by several processes */

static bool put_words(char *at, size_t room, const char *text)
{
    const size_t n = text ? strlen(text) + 1 : room + 1;
    if (n <= room)
        memcpy(at, text, n);
    return n <= room;
}

bool tri_ticket_make(struct tri_ticket *ticket, struct tri_output *output)
{
    enum { MOST = 1 << 16 };
    struct tri_file_facts facts;
    char *temporary = output->temporary ? tri_path_from_root(output->temporary) : NULL;
    bool made = put_words(ticket->temporary, TRI_TICKET_PATH, temporary) &&
                put_words(ticket->path, TRI_TICKET_PATH, output->path) &&
                tri_host_name(ticket->host, TRI_TICKET_HOST);
    free(temporary);
    ticket->length = made ? 1 + ((uint64_t)(1e9 * tri_seconds()) / 16 + (uint64_t)tri_process()) % MOST : 0;
    made = made && tri_file_set_size(output->file, ticket->length) && tri_file_get_facts(output->file, &facts);
    ticket->inode = made ? facts.node : 0;
    if (!made)
        ticket->path[0] = 0;
    return made;
}

bool tri_output_join(struct tri_output *output, struct tri_ticket *ticket, const struct tri_stop *stop)
{
    struct tri_file_facts facts;
    *output = (struct tri_output){.path = ticket->path, .temporary = ticket->temporary, .direct = TRI_NO_FILE,
                                  .stop = stop, .file = tri_file_open(ticket->temporary, TRI_OPEN_WRITE_SHARED)};
    if (output->file == TRI_NO_FILE)
        return false;
    if (tri_file_get_facts(output->file, &facts) && facts.node == ticket->inode && facts.size == ticket->length &&
        tri_file_allows_shared_pages(output->file, ticket->host))
        return true;
    (void)tri_file_close(output->file);
    output->file = TRI_NO_FILE;
    return false;
}

enum tri_status tri_output_leave(struct tri_output *output, bool on_disk, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    if (on_disk && output->file != TRI_NO_FILE)
        status = sync_output(output, error);
    const enum tri_status closed = close_file(output, status ? NULL : error);
    return status ? status : closed;
}

enum tri_status tri_output_copy(const struct tri_output *from, struct tri_output *to, uint64_t place, uint64_t n,
                                struct tri_error *error)
{
    enum { PIECE = 1 << 20 };
    int result = 0;
    char *buffer = malloc(PIECE);
    if (!buffer)
        return tri_fail(error, TRI_NO_MEMORY, to->path, 0, "no memory to write the file");
    for (uint64_t done = 0; done < n && !result; done += PIECE) {
        const size_t piece = n - done < PIECE ? (size_t)(n - done) : PIECE;
        if (!tri_read_back(from->file, buffer, piece, done)) {
            const int reason = errno;
            free(buffer);
            return tri_fail_system(error, TRI_CANNOT_WRITE, from->path, "cannot read again", reason);
        }
        result = tri_output_write_at(to, place + done, buffer, piece);
    }
    free(buffer);
    return tri_output_conclude(to, result, error);
}
