/* The functions of system.h that are the same on all systems and use those that differ. */
#include "triangle/base/system.h"

#include <assert.h>
#include <errno.h>
#include <stdio.h>

bool tri_read_back(tri_file file, void *at, size_t n, uint64_t place)
{
    const int64_t got = tri_read_at(file, at, n, place);
    if (got >= 0 && (uint64_t)got < n)
        errno = EIO;
    return got >= 0 && (uint64_t)got == n;
}

void tri_path_folder(const char *path, char folder[TRI_PATH])
{
    struct tri_file_facts facts;
    const size_t length = tri_path_folder_length(path);
    if (tri_path_get_facts(path, &facts) && facts.kind == TRI_FOLDER)
        snprintf(folder, TRI_PATH, "%s", path);
    else
        snprintf(folder, TRI_PATH, "%.*s", length > 0 ? (int)length : 1, length > 0 ? path : ".");
}

/* --- mapped files */

static bool ensure_file(struct tri_mapped_file *f, const char *folder)
{
    if (f->file == TRI_NO_FILE)
        f->file = tri_scratch_file(folder);
    return f->file != TRI_NO_FILE;
}

int tri_mapped_file_extend(struct tri_mapped_file *f, const char *folder, size_t size)
{
    assert(size > f->size);
    if (!ensure_file(f, folder))
        return errno;
    const int fault = tri_file_reserve(f->file, f->size, size);
    if (fault)
        return fault;
    void *at = tri_file_map(f->file, size);
    if (!at)
        return errno;
    if (f->at)
        tri_file_unmap(f->at, f->size);
    f->at = at;
    f->size = size;
    return 0;
}

bool tri_mapped_file_append(struct tri_mapped_file *f, const char *folder, const void *bytes, size_t n)
{
    assert(!f->at);
    if (!ensure_file(f, folder) || !tri_write_at(f->file, bytes, n, f->size))
        return false;
    f->size += n;
    return true;
}

bool tri_mapped_file_map(struct tri_mapped_file *f)
{
    if (!f->at && f->size > 0)
        f->at = tri_file_map(f->file, f->size);
    return f->at || f->size == 0;
}

void tri_mapped_file_release_pages(const struct tri_mapped_file *f)
{
    if (f->at)
        tri_file_release_pages(f->at, f->size);
}

void tri_mapped_file_close(struct tri_mapped_file *f)
{
    const int fault = errno;
    if (f->at)
        tri_file_unmap(f->at, f->size);
    (void)tri_file_close(f->file);
    *f = (struct tri_mapped_file){.file = TRI_NO_FILE};
    errno = fault;
}
