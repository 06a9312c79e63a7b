/* Rows one after the other, with nothing between. */
#include "drivers/judge/scratch.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "triangle/base/at_place.h"
#include "triangle/base/grow.h"
#include "triangle/base/scratch_file.h"

enum tri_status scratch_open(struct scratch *s, const char *folder, size_t width, struct tri_error *error)
{
    *s = (struct scratch){.file = folder ? tri_scratch_file(folder) : -1, .width = width};
    if (folder && s->file < 0)
        return tri_fail(error, TRI_CANNOT_WRITE, folder, 0, "cannot make a scratch file there: %s", strerror(errno));
    return TRI_OK;
}

enum tri_status scratch_append(struct scratch *s, const void *rows, int64_t n, struct tri_error *error)
{
    const int64_t at = s->n * (int64_t)s->width, size = n * (int64_t)s->width;
    if (s->file < 0 && !tri_grow_far(&s->bytes, &s->room, at + size, 1))
        return tri_fail(error, TRI_NO_MEMORY, "", 0, "out of memory");
    if (s->file < 0 && size > 0)
        memcpy(s->bytes + at, rows, (size_t)size);
    if (s->file >= 0 && !tri_write_at(s->file, rows, (size_t)size, (uint64_t)at))
        return tri_fail(error, TRI_CANNOT_WRITE, "", 0, "cannot write a scratch file: %s", strerror(errno));
    s->n += n;
    return TRI_OK;
}

enum tri_status scratch_read(const struct scratch *s, int64_t first, int64_t n, void *rows, struct tri_error *error)
{
    if (s->file < 0)
        memcpy(rows, s->bytes + first * (int64_t)s->width, (size_t)n * s->width);
    else if (!tri_read_again(s->file, rows, (size_t)n * s->width, (uint64_t)first * s->width))
        return tri_fail(error, TRI_CANNOT_READ, "", 0, "cannot read a scratch file");
    return TRI_OK;
}

void scratch_close(struct scratch *s)
{
    if (s->width > 0 && s->file >= 0)
        (void)close(s->file);
    free(s->bytes);
    *s = (struct scratch){.file = -1};
}
