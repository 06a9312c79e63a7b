/* A file with a second name is refused where it would be added to: that may be another's, which somebody has linked. */
#define _GNU_SOURCE /* O_TMPFILE */

#include "sched/checkpoint/folder.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

/* Closes a file that is not to be used. */
static int refuse(int file, int why)
{
    close(file);
    errno = why;
    return -1;
}

int par_folder_open(const char *path)
{
    struct stat folder;
    const int file = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (file < 0)
        return -1;
    if (fstat(file, &folder) != 0)
        return refuse(file, errno);
    return folder.st_uid == geteuid() ? file : refuse(file, EPERM);
}

/* most_names: of the file, in whatever folders. Nobody waits for the other end of a pipe. */
static int open_own(int folder, const char *name, int flags, nlink_t most_names)
{
    struct stat at_folder, at_file;
    const int file = openat(folder, name, flags | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
    if (file < 0)
        return -1;
    if (fstat(folder, &at_folder) != 0 || fstat(file, &at_file) != 0)
        return refuse(file, errno);
    const bool is_own = S_ISREG(at_file.st_mode) && at_file.st_uid == at_folder.st_uid;
    return is_own && at_file.st_nlink <= most_names ? file : refuse(file, EPERM);
}

int par_folder_read(int folder, const char *name) { return open_own(folder, name, O_RDONLY, (nlink_t)-1); }
int par_folder_extend(int folder, const char *name) { return open_own(folder, name, O_RDWR | O_CREAT, 1); }

int par_folder_create(int folder, const char *name)
{
    if (unlinkat(folder, name, 0) != 0 && errno != ENOENT)
        return -1;
#ifdef O_TMPFILE
    const int unnamed = access("/proc/self/fd", X_OK) == 0 ? openat(folder, ".", O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666)
                                                           : -1;
    if (unnamed >= 0)
        return unnamed;
#endif
    return openat(folder, name, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
}

bool par_folder_end(int folder, const char *name, int file)
{
    char path[64];
    struct stat at;
    snprintf(path, sizeof path, "/proc/self/fd/%d", file);
    return fsync(file) == 0 && fstat(file, &at) == 0 &&
           (at.st_nlink > 0 || linkat(AT_FDCWD, path, folder, name, AT_SYMLINK_FOLLOW) == 0);
}

bool par_folder_sync(int folder) { return fsync(folder) == 0 || errno == EINVAL; }
