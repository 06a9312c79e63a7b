/* Files in a folder of one's own, by a descriptor of it: what others do with its name meanwhile, or put into it, leads
 * nowhere else. No link is followed, nothing but a file of the folder's owner is read or added to, and what is written
 * anew is a new file. Names hold no slash. All return -1 or false where errno says why. */
#ifndef SCHED_CHECKPOINT_FOLDER_H
#define SCHED_CHECKPOINT_FOLDER_H

#include <stdbool.h>

/* A descriptor of the folder at this path, which may be a link to it. EPERM: it is another user's. */
int par_folder_open(const char *path);

/* A file that is there, to read. */
int par_folder_read(int folder, const char *name);

/* A new and empty file, to write; a file of that name is removed from the folder. par_folder_end gives the new one the
 * name once it is complete and on the disk: if the process dies before, nothing is left. Systems without files that
 * have no name (NFS) give it the name at once. */
int par_folder_create(int folder, const char *name);
bool par_folder_end(int folder, const char *name, int file);

/* A file to read and to add to, made unless it is there. */
int par_folder_extend(int folder, const char *name);

/* What has got names in the folder, or lost them, is so after the machine has died, too. */
bool par_folder_sync(int folder);

#endif
