/* Arrays in scratch files that are mapped into memory, so that they may be larger than memory. */
#ifndef TRIANGLE_BASE_MAPPED_FILE_H
#define TRIANGLE_BASE_MAPPED_FILE_H

#include <stdbool.h>
#include <stddef.h>

struct tri_mapped_file {
    int file;    /* descriptor; -1: no file yet */
    size_t size; /* bytes of disk that are reserved or written */
    void *at;    /* mapping of all of them; NULL: not mapped */
};

/* Reserves disk space up to `size` bytes, which is more than now, and maps all of it; makes the file in the folder if
 * there is none. A full disk or RLIMIT_FSIZE is an error here, not a signal when the array is written. Returns 0 or an
 * errno; then the old mapping stays. */
int tri_mapped_file_extend(struct tri_mapped_file *f, const char *folder, size_t size);

/* Writes n bytes behind the others; the file must not be mapped. False, with errno: not written. */
bool tri_mapped_file_append(struct tri_mapped_file *f, const char *folder, const void *bytes, size_t n);

/* Maps what has been written, if anything has and it is not mapped. False, with errno: it cannot be mapped. */
bool tri_mapped_file_map(struct tri_mapped_file *f);

/* Lets the system drop the pages from memory; the bytes stay. Nothing happens without a mapping. */
void tri_mapped_file_release_pages(const struct tri_mapped_file *f);

/* Unmaps and closes the file, which deletes it; errno stays. */
void tri_mapped_file_close(struct tri_mapped_file *f);

#endif
