/* Rows one after the other, with nothing between. */
#include "drivers/judge/scratch.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

#include "triangle/base/at_place.h"
#include "triangle/base/scratch_file.h"

enum tri_status scratch_open(struct scratch *s, const char *folder, size_t width, struct tri_error *error)
{
    *s = (struct scratch){tri_scratch_file(folder), width, 0};
    if (s->file < 0)
        return tri_fail(error, TRI_CANNOT_WRITE, folder, 0, "cannot make a scratch file there: %s", strerror(errno));
    return TRI_OK;
}

enum tri_status scratch_append(struct scratch *s, const void *rows, int64_t n, struct tri_error *error)
{
    if (!tri_write_at(s->file, rows, (size_t)n * s->width, (uint64_t)s->n * s->width))
        return tri_fail(error, TRI_CANNOT_WRITE, "", 0, "cannot write a scratch file: %s", strerror(errno));
    s->n += n;
    return TRI_OK;
}

enum tri_status scratch_read(const struct scratch *s, int64_t first, int64_t n, void *rows, struct tri_error *error)
{
    if (!tri_read_again(s->file, rows, (size_t)n * s->width, (uint64_t)first * s->width))
        return tri_fail(error, TRI_CANNOT_READ, "", 0, "cannot read a scratch file");
    return TRI_OK;
}

void scratch_close(struct scratch *s)
{
    if (s->width > 0 && s->file >= 0)
        (void)close(s->file);
    *s = (struct scratch){-1, 0, 0};
}
