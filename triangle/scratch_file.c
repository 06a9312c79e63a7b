/* A name that nobody has, taken back at once. */
#include "triangle/scratch_file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int tri_scratch_file(const char *folder)
{
    static const char name[] = "/ptriangle-XXXXXX";
    const size_t n = strlen(folder);
    char *path = malloc(n + sizeof name);
    if (!path) {
        errno = ENOMEM;
        return -1;
    }
    memcpy(path, folder, n);
    memcpy(path + n, name, sizeof name);
    const int file = mkstemp(path), fault = errno;
    if (file >= 0)
        (void)unlink(path);
    free(path);
    errno = fault;
    return file;
}
