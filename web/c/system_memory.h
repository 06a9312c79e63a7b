/* Files in memory, for a host without a file system. */
#ifndef WEB_SYSTEM_MEMORY_H
#define WEB_SYSTEM_MEMORY_H

#include <stddef.h>

/* Makes a file of `size` bytes, which the caller fills; replaces one of that name. NULL: no memory, or 16 files. */
void *tri_memory_file(const char *name, size_t size);

/* The bytes of a file, valid until it is written or removed. NULL: there is none. */
const void *tri_memory_file_bytes(const char *name, size_t *size);

#endif
