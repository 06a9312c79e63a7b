/* Rows one after the other, with nothing between. */
#include "drivers/judge/scratch.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

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
    size_t bytes = (size_t)n * s->width, done = 0;
    while (done < bytes) {
        ssize_t put = write(s->file, (const char *)rows + done, bytes - done);
        if (put < 0 && errno != EINTR)
            return tri_fail(error, TRI_CANNOT_WRITE, "", 0, "cannot write a scratch file: %s", strerror(errno));
        done += put > 0 ? (size_t)put : 0;
    }
    s->n += n;
    return TRI_OK;
}

enum tri_status scratch_read(const struct scratch *s, int64_t first, int64_t n, void *rows, struct tri_error *error)
{
    size_t bytes = (size_t)n * s->width, done = 0;
    while (done < bytes) {
        off_t at = (off_t)((uint64_t)first * s->width + done);
        ssize_t got = pread(s->file, (char *)rows + done, bytes - done, at);
        if (got == 0 || (got < 0 && errno != EINTR))
            return tri_fail(error, TRI_CANNOT_READ, "", 0, "cannot read a scratch file");
        done += got > 0 ? (size_t)got : 0;
    }
    return TRI_OK;
}

void scratch_close(struct scratch *s)
{
    if (s->width > 0 && s->file >= 0)
        (void)close(s->file);
    *s = (struct scratch){-1, 0, 0};
}
