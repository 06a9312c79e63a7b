#include "triangle/text/bytes.h"

#include <errno.h>
#include <stdlib.h>

#include "triangle/base/system.h"

static enum tri_status read_all(struct tri_bytes *bytes, tri_file file, size_t size, const char *path,
                                struct tri_error *error)
{
    bytes->data = malloc(size + 1);
    if (!bytes->data)
        return tri_fail(error, TRI_NO_MEMORY, path, 0, "out of memory for %zu bytes", size);
    const int64_t got = tri_read_at(file, bytes->data, size, 0);
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
    struct tri_file_facts facts;
    *bytes = (struct tri_bytes){0};
    const tri_file file = tri_file_open(path, TRI_OPEN_LOOK); /* a pipe that nobody writes would hang */
    if (file == TRI_NO_FILE)
        return tri_fail_system(error, TRI_CANNOT_READ, path, "cannot open", errno);
    enum tri_status status = TRI_OK;
    if (!tri_file_look(file, &facts) || facts.kind != TRI_REGULAR)
        status = tri_fail(error, TRI_CANNOT_READ, path, 0, "not a regular file");
    status = status ? status : read_all(bytes, file, (size_t)facts.size, path, error);
    (void)tri_file_close(file);
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
