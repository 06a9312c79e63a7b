/* A file that never had a name, where the system makes such; else one whose name nobody has, taken back before a signal
 * to this thread can end the process (but for SIGKILL). */
#define _GNU_SOURCE /* O_TMPFILE */
#include "triangle/base/scratch_file.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int make_nameless(char *path)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    const int file = mkstemp(path), fault = errno;
    if (file >= 0)
        (void)unlink(path);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    errno = fault;
    return file;
}

/* For any system and file system. */
static int make_and_unlink(const char *folder)
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
    const int file = make_nameless(path), fault = errno;
    free(path);
    errno = fault;
    return file;
}

int tri_scratch_file(const char *folder)
{
#ifdef O_TMPFILE
    const int file = open(folder, O_TMPFILE | O_RDWR | O_EXCL, S_IRUSR | S_IWUSR);
    if (file >= 0)
        return file;
#endif
    return make_and_unlink(folder);
}
