/* Implements triangle/base/system.h without an operating system: files with names are kept in memory.
 *
 * A name that does not exist yet looks like a device, so the library's writers append to it in place: they make no
 * temporary file, rename nothing and lock nothing. The functions that would do so fail here. Every file has one user at
 * a time: `at` is the only cursor. */
#include "web/c/system_memory.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/grow.h"
#include "triangle/base/system.h"

enum { MOST_FILES = 16 };

static struct memory_file {
    char *name;   /* NULL: this entry is free */
    char *bytes;  /* [room] */
    int64_t size; /* bytes used */
    int64_t room; /* bytes allocated */
    int64_t at;   /* the next byte for tri_read_next */
    bool is_open_to_write;
} files[MOST_FILES];

static int number_of(const char *name)
{
    for (int i = 0; i < MOST_FILES; i++)
        if (files[i].name && strcmp(files[i].name, name) == 0)
            return i;
    return -1;
}

/* Adds an empty file. -1: no memory, or too many files. */
static int add_file(const char *name)
{
    for (int i = 0; i < MOST_FILES; i++)
        if (!files[i].name) {
            char *own = malloc(strlen(name) + 1);
            files[i] = (struct memory_file){.name = own ? strcpy(own, name) : NULL};
            return own ? i : -1;
        }
    return -1;
}

void *tri_memory_file(const char *name, size_t size)
{
    (void)tri_path_remove(name);
    const int i = add_file(name);
    if (i < 0)
        return NULL;
    files[i].bytes = malloc(size + 1);
    files[i].size = files[i].room = files[i].bytes ? (int64_t)size : 0;
    return files[i].bytes;
}

const void *tri_memory_file_bytes(const char *name, size_t *size)
{
    const int i = number_of(name);
    *size = i < 0 ? 0 : (size_t)files[i].size;
    return i < 0 ? NULL : files[i].bytes;
}

/* --- files */

tri_file tri_file_open(const char *path, enum tri_opening opening)
{
    int i = number_of(path);
    if (i < 0 && opening == TRI_OPEN_DEVICE)
        i = add_file(path);
    if (i < 0) {
        errno = opening == TRI_OPEN_DEVICE ? ENOMEM : ENOENT;
        return TRI_NO_FILE;
    }
    files[i].at = 0;
    files[i].is_open_to_write = opening == TRI_OPEN_DEVICE;
    return i;
}

bool tri_file_close(tri_file file)
{
    if (file != TRI_NO_FILE)
        files[file].is_open_to_write = false;
    return true;
}

bool tri_file_get_facts(tri_file file, struct tri_file_facts *facts)
{
    const struct memory_file *f = &files[file];
    *facts = (struct tri_file_facts){.kind = f->is_open_to_write ? TRI_OTHER_FILE : TRI_REGULAR,
                                     .size = (uint64_t)f->size, .node = (uint64_t)file + 1, .names = 1};
    return true;
}

bool tri_path_get_facts(const char *path, struct tri_file_facts *facts)
{
    const int i = number_of(path);
    *facts = (struct tri_file_facts){.kind = TRI_OTHER_FILE};
    return i < 0 || tri_file_get_facts(i, facts);
}

int64_t tri_read_at(tri_file file, void *at, size_t n, uint64_t place)
{
    const uint64_t size = (uint64_t)files[file].size, left = place < size ? size - place : 0;
    const size_t got = n < left ? n : (size_t)left;
    if (got > 0)
        memcpy(at, files[file].bytes + place, got);
    return (int64_t)got;
}

int64_t tri_read_next(tri_file file, void *at, size_t n)
{
    const int64_t got = tri_read_at(file, at, n, (uint64_t)files[file].at);
    files[file].at += got;
    return got;
}

int64_t tri_write_next(tri_file file, const void *at, size_t n)
{
    struct memory_file *f = &files[file];
    if (!tri_grow_far(&f->bytes, &f->room, f->size + (int64_t)n, 1)) {
        errno = ENOSPC;
        return -1;
    }
    memcpy(f->bytes + f->size, at, n);
    f->size += (int64_t)n;
    return (int64_t)n;
}

/* --- names */

bool tri_path_allows(const char *path, enum tri_access access)
{
    errno = ENOENT;
    return access == TRI_ACCEPTS_FILES || access == TRI_WRITABLE || number_of(path) >= 0;
}

bool tri_path_remove(const char *path)
{
    const int i = number_of(path);
    if (i < 0)
        return false;
    free(files[i].name);
    free(files[i].bytes);
    files[i] = (struct memory_file){0};
    return true;
}

size_t tri_path_folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

/* --- folders, locks, disks, other processes: nothing in the module calls these */

static bool refuse(void)
{
    errno = ENOSYS;
    return false;
}

bool tri_file_set_permissions(tri_file file, const struct tri_file_facts *as) { return (void)file, (void)as, refuse(); }
bool tri_file_sync(tri_file file) { return (void)file, true; }
void tri_file_start_sync(tri_file file, uint64_t place, uint64_t n) { (void)file, (void)place, (void)n; }
void tri_file_finish_sync(tri_file file, uint64_t place, uint64_t n) { (void)file, (void)place, (void)n; }
enum tri_lock tri_file_lock(tri_file file) { return (void)file, TRI_NO_LOCKS; }

int64_t tri_write_some(tri_file file, const void *at, size_t n, uint64_t place)
{
    return (void)file, (void)at, (void)n, (void)place, refuse(), -1;
}

bool tri_path_rename(const char *from, const char *to) { return (void)from, (void)to, refuse(); }
bool tri_path_link(const char *path, const char *second) { return (void)path, (void)second, refuse(); }
char *tri_path_resolve(const char *path) { return (void)path, refuse(), NULL; }

tri_file tri_folder_open(const char *path, bool make) { return (void)path, (void)make, refuse(), TRI_NO_FILE; }
bool tri_folder_unlink(tri_file folder, const char *name) { return (void)folder, (void)name, refuse(); }

tri_file tri_folder_file(tri_file folder, const char *name, enum tri_folder_opening opening)
{
    return (void)folder, (void)name, (void)opening, refuse(), TRI_NO_FILE;
}

bool tri_folder_list(tri_file folder, bool (*each)(void *user, const char *name), void *user)
{
    return (void)folder, (void)each, (void)user, refuse();
}

long tri_process(void) { return 1; }
bool tri_process_is_gone(long process) { return (void)process, false; }
bool tri_host_name(char *name, size_t room) { return (void)name, (void)room, refuse(); }
