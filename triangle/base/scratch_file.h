/* Files that are scratch alone: they have no name, and go with whoever has them open, however that ends. */
#ifndef TRIANGLE_BASE_SCRATCH_FILE_H
#define TRIANGLE_BASE_SCRATCH_FILE_H

/* A new, empty file in the folder, open to read and to write. -1: none, and errno tells why. Where the file system
 * knows no files without a name, a process that is killed outright may leave an empty ptriangle-XXXXXX. */
int tri_scratch_file(const char *folder);

#endif
