#define _DEFAULT_SOURCE /* realpath */

#include "triangle/text/joined.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/vfs.h>
#endif

#include "triangle/base/at_place.h"
#include "triangle/text/text.h"

static bool put(char *at, size_t room, const char *text)
{
    const size_t n = text ? strlen(text) + 1 : room + 1;
    if (n <= room)
        memcpy(at, text, n);
    return n <= room;
}

static bool put_host(char at[TRI_TICKET_HOST])
{
    struct utsname names;
    return uname(&names) == 0 && put(at, TRI_TICKET_HOST, names.nodename);
}

/* Do rows that meet in a page of this file keep apart, if it was opened on that machine? */
static bool keeps_apart(int file, const char *host)
{
    char here[TRI_TICKET_HOST];
    if (put_host(here) && strcmp(here, host) == 0)
        return true;
#ifdef __linux__
    enum { NFS = 0x6969, SMB = 0x517b };
    const uint32_t CIFS = 0xff534d42, SMB2 = 0xfe534d42;
    struct statfs system;
    if (fstatfs(file, &system) != 0)
        return false;
    const uint32_t type = (uint32_t)system.f_type;
    return type != NFS && type != SMB && type != CIFS && type != SMB2;
#else
    (void)file;
    return false;
#endif
}

bool tri_ticket_make(struct tri_ticket *ticket, struct tri_output *output)
{
    enum { MOST = 1 << 16 };
    struct timespec now;
    struct stat status;
    char *temporary = output->temporary ? realpath(output->temporary, NULL) : NULL;
    bool made = put(ticket->temporary, TRI_TICKET_PATH, temporary) &&
                put(ticket->path, TRI_TICKET_PATH, output->path) &&
                put_host(ticket->host) && clock_gettime(CLOCK_REALTIME, &now) == 0;
    free(temporary);
    ticket->length = made ? 1 + (uint64_t)(now.tv_nsec / 16 + getpid()) % MOST : 0;
    made = made && ftruncate(output->file, (off_t)ticket->length) == 0 && fstat(output->file, &status) == 0;
    ticket->inode = made ? (uint64_t)status.st_ino : 0;
    if (!made)
        ticket->path[0] = 0;
    return made;
}

bool tri_output_join(struct tri_output *output, struct tri_ticket *ticket, const struct tri_stop *stop)
{
    struct stat status;
    *output = (struct tri_output){.path = ticket->path, .temporary = ticket->temporary, .direct = -1, .stop = stop};
    output->file = open(ticket->temporary, O_WRONLY | O_CLOEXEC | O_NOFOLLOW);
    if (output->file < 0)
        return false;
    if (fstat(output->file, &status) == 0 && (uint64_t)status.st_ino == ticket->inode &&
        (uint64_t)status.st_size == ticket->length && keeps_apart(output->file, ticket->host))
        return true;
    close(output->file);
    output->file = -1;
    return false;
}

enum tri_status tri_output_leave(struct tri_output *output, bool on_disk, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    if (output->file < 0)
        return TRI_OK;
    if (on_disk)
        status = tri_output_sync(output, error);
    const int result = close(output->file);
    output->file = -1;
    if (status || result == 0 || errno == EINTR)
        return status;
    return tri_fail_system(error, TRI_CANNOT_WRITE, output->path, "cannot write", errno);
}

enum tri_status tri_output_copy(const struct tri_output *from, struct tri_output *to, uint64_t place, uint64_t n,
                                struct tri_error *error)
{
    enum { PIECE = 1 << 20 };
    int result = 0;
    char *buffer = malloc(PIECE);
    if (!buffer)
        return tri_fail(error, TRI_NO_MEMORY, to->path, 0, "no memory to write the file");
    for (uint64_t done = 0; done < n && !result; done += PIECE) {
        const size_t piece = n - done < PIECE ? (size_t)(n - done) : PIECE;
        if (!tri_read_again(from->file, buffer, piece, done)) {
            const int reason = errno;
            free(buffer);
            return tri_fail_system(error, TRI_CANNOT_WRITE, from->path, "cannot read again", reason);
        }
        result = tri_output_write_at(to, place + done, buffer, piece);
    }
    free(buffer);
    return tri_output_conclude(to, result, error);
}
