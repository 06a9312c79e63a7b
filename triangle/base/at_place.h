/* Reading and writing at a place of a file, however often the system interrupts that. */
#ifndef TRIANGLE_BASE_AT_PLACE_H
#define TRIANGLE_BASE_AT_PLACE_H

#include <errno.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>
#include <unistd.h>

/* Reads n bytes; fewer only at the end of the file. Returns how many; -1 and errno: failure. */
static inline ssize_t tri_read_at(int file, void *at, size_t n, uint64_t place)
{
    size_t done = 0;
    while (done < n) {
        const ssize_t got = pread(file, (char *)at + done, n - done, (off_t)(place + done));
        if (got == 0)
            break;
        if (got < 0 && errno != EINTR)
            return -1;
        done += got > 0 ? (size_t)got : 0;
    }
    return (ssize_t)done;
}

/* Reads n bytes that have been written. False, and errno: they cannot be read. */
static inline bool tri_read_again(int file, void *at, size_t n, uint64_t place)
{
    const ssize_t got = tri_read_at(file, at, n, place);
    if (got >= 0 && (size_t)got < n)
        errno = EIO;
    return got >= 0 && (size_t)got == n;
}

/* Writes n bytes. False, and errno: they cannot be written. */
static inline bool tri_write_at(int file, const void *at, size_t n, uint64_t place)
{
    for (size_t done = 0; done < n;) {
        const ssize_t put = pwrite(file, (const char *)at + done, n - done, (off_t)(place + done));
        if (put < 0 && errno != EINTR)
            return false;
        done += put > 0 ? (size_t)put : 0;
    }
    return true;
}

#endif
