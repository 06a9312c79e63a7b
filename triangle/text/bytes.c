#include "triangle/text/bytes.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "triangle/base/at_place.h"
#include "triangle/text/text.h"

static enum tri_status read_all(struct tri_bytes *bytes, int file, size_t size, const char *path,
                                struct tri_error *error)
{
    bytes->data = malloc(size + 1);
    if (!bytes->data)
        return tri_fail(error, TRI_NO_MEMORY, path, 0, "out of memory for %zu bytes", size);
    const ssize_t got = tri_read_at(file, bytes->data, size, 0);
    if (got < 0)
        return tri_fail_system(error, TRI_CANNOT_READ, path, "cannot read", errno);
    if ((size_t)got < size)
        return tri_fail(error, TRI_CANNOT_READ, path, 0, "became shorter while it was read");
    bytes->at = bytes->data;
    bytes->end = bytes->data + size;
    return TRI_OK;
}

enum tri_status tri_bytes_load(struct tri_bytes *bytes, const char *path, struct tri_error *error)
{
    struct stat state;
    *bytes = (struct tri_bytes){0};
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK); /* a pipe that nobody writes would hang */
    if (file < 0)
        return tri_fail_system(error, TRI_CANNOT_READ, path, "cannot open", errno);
    enum tri_status status = TRI_OK;
    if (fstat(file, &state) != 0 || !S_ISREG(state.st_mode))
        status = tri_fail(error, TRI_CANNOT_READ, path, 0, "not a regular file");
    status = status ? status : read_all(bytes, file, (size_t)state.st_size, path, error);
    close(file);
    return status;
}

void tri_bytes_free(struct tri_bytes *bytes)
{
    free(bytes->data);
    *bytes = (struct tri_bytes){0};
}

bool tri_bytes_line(struct tri_bytes *bytes, const char **line, size_t *length)
{
    const char *end = bytes->at < bytes->end ? memchr(bytes->at, '\n', (size_t)(bytes->end - bytes->at)) : NULL;
    if (!end)
        return false;
    *line = bytes->at;
    *length = (size_t)(end - bytes->at);
    if (*length > 0 && end[-1] == '\r')
        --*length;
    bytes->at = end + 1;
    return true;
}

bool tri_bytes_pass(struct tri_bytes *bytes, const char *text)
{
    const size_t n = strlen(text);
    for (const char *at = bytes->at; (size_t)(bytes->end - at) >= n; at++) {
        at = memchr(at, text[0], (size_t)(bytes->end - at) - n + 1);
        if (!at)
            return false;
        if (memcmp(at, text, n) == 0) {
            bytes->at = at + n;
            return true;
        }
    }
    return false;
}
