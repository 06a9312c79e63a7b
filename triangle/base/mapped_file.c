/* Scratch files, mapped as far as they have disk space. */
#define _DEFAULT_SOURCE /* madvise */
#include "triangle/base/mapped_file.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include "triangle/base/at_place.h"
#include "triangle/base/scratch_file.h"

static bool open_file(struct tri_mapped_file *f, const char *folder)
{
    if (f->file < 0)
        f->file = tri_scratch_file(folder);
    return f->file >= 0;
}

/* A file beyond the limit would bring a signal. */
static int check_limit(size_t size)
{
    struct rlimit limit;
    bool allowed = getrlimit(RLIMIT_FSIZE, &limit) || limit.rlim_cur == RLIM_INFINITY || size <= limit.rlim_cur;
    return allowed ? 0 : EFBIG;
}

static int reserve_space(struct tri_mapped_file *f, size_t size)
{
    int fault = check_limit(size);
    if (fault)
        return fault;
    do
        fault = posix_fallocate(f->file, (off_t)f->size, (off_t)(size - f->size));
    while (fault == EINTR);
    return fault;
}

static void *map_bytes(int file, size_t size)
{
    void *at = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    return at != MAP_FAILED ? at : NULL;
}

int tri_mapped_file_extend(struct tri_mapped_file *f, const char *folder, size_t size)
{
    assert(size > f->size);
    if (!open_file(f, folder))
        return errno;
    const int fault = reserve_space(f, size);
    if (fault)
        return fault;
    void *at = map_bytes(f->file, size);
    if (!at)
        return errno;
    if (f->at)
        munmap(f->at, f->size);
    f->at = at;
    f->size = size;
    return 0;
}

bool tri_mapped_file_append(struct tri_mapped_file *f, const char *folder, const void *bytes, size_t n)
{
    assert(!f->at);
    if (!open_file(f, folder) || !tri_write_at(f->file, bytes, n, f->size))
        return false;
    f->size += n;
    return true;
}

bool tri_mapped_file_map(struct tri_mapped_file *f)
{
    if (!f->at && f->size > 0)
        f->at = map_bytes(f->file, f->size);
    return f->at || f->size == 0;
}

void tri_mapped_file_release_pages(const struct tri_mapped_file *f)
{
    if (f->at)
        madvise(f->at, f->size, MADV_DONTNEED);
}

void tri_mapped_file_close(struct tri_mapped_file *f)
{
    const int fault = errno;
    if (f->at)
        munmap(f->at, f->size);
    if (f->file >= 0)
        close(f->file);
    *f = (struct tri_mapped_file){.file = -1};
    errno = fault;
}
