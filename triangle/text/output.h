/* Output files that appear together, when all are complete, or not at all.
 *
 * A file is written under another name beside the place where it will be, ".tri-<host>-<process>-<number>.tmp", and
 * locked as long as its process works on it. What a process left behind that was killed outright is removed by the
 * next run that writes into the same directory: a file of that name is taken for left behind if this host made it, no
 * process of its number is in sight, and nobody holds the lock. The kernel drops a lock when its process dies, in
 * whatever container that ran; so no file that is still written goes, also where directories are shared between hosts,
 * or process numbers used twice. (From the last close to the new name, microseconds, the process's number alone
 * protects it; were it removed then, the run would end with an error and leave everything as it was.) Where there are
 * no locks nothing is removed.
 *
 * Errors of all functions: TRI_CANNOT_WRITE, TRI_NO_MEMORY; of tri_output_write also TRI_STOPPED. */
#ifndef TRIANGLE_TEXT_OUTPUT_H
#define TRIANGLE_TEXT_OUTPUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "triangle/base/status.h"
#include "triangle/base/system.h"

enum { TRI_MAX_OUTPUTS = 544 };

/* Which file it is: of one that exists its own node, of a new one its folder's, where its name tells it. */
struct tri_output_place {
    bool known;  /* false: a device or pipe, which may be written twice */
    bool exists;
    uint64_t device, node;
};

struct tri_output {
    char *path;      /* what the file will be called: the caller's path with symbolic links followed */
    struct tri_output_place place;
    char *temporary; /* what it is called until then; NULL: a device or pipe, written in place */
    char *old;       /* while files are renamed: a second name of the one that is replaced; NULL: none */
    bool replaces;   /* there was a file of that name */
    bool renamed;    /* it has its name */
    tri_file file;   /* TRI_NO_FILE: closed */
    tri_file direct; /* the same file, past the system's cache; TRI_NO_FILE: not opened */
    bool no_direct;  /* there can be none */
    uint64_t size;   /* bytes written or reserved */
    bool failed;     /* something could not be written */
    const struct tri_stop *stop; /* the set's */
};

/* Files that are written together. INVARIANT: until commit nothing has changed under any final name; after commit or
 * abort no temporary file is left and the set is empty. (Devices and pipes are the exception.) */
struct tri_output_set {
    int n;
    struct tri_output outputs[TRI_MAX_OUTPUTS];
    int next_name;               /* number in the next temporary name: those below have been tried */
    bool waits;                  /* for the disk, when names are given: the files have been synced */
    bool trial;                  /* to see whether all can be opened: devices and pipes are left alone */
    const struct tri_stop *stop; /* asked by tri_output_write; borrowed; NULL: nobody */
};

/* An empty set; trial and stop may then be set. */
void tri_outputs_begin(struct tri_output_set *set);

/* Creates a temporary file beside `path`, whose name no other process or thread has, and sets *output to it, which
 * belongs to the set. A file that exists is replaced at commit and keeps its permissions; a link to a file goes on
 * pointing to it. Directories, files without permission to write and a second output for the same file are refused
 * here, before any work is done. */
enum tri_status tri_output_open(struct tri_output_set *set, const char *path, struct tri_output **output,
                                struct tri_error *error);

/* Nothing has been written yet, again: for a file, which has places. TRI_CANNOT_WRITE. */
enum tri_status tri_output_restart(struct tri_output *output, struct tri_error *error);

/* Appends bytes. */
enum tri_status tri_output_write(struct tri_output *output, const char *data, size_t size, struct tri_error *error);

/* Appending in pieces, by several threads: a file has a place for each byte, a device or pipe has not. */
static inline bool tri_output_has_places(const struct tri_output *output) { return output->temporary != NULL; }

/* The place of the next `size` bytes, which are then to be written there. */
uint64_t tri_output_reserve(struct tri_output *output, size_t size);

enum { TRI_OUTPUT_STOPPED = -1 };

/* Writes bytes to a reserved place; by any thread. Returns 0, or what tri_output_conclude makes an error of: errno, or
 * TRI_OUTPUT_STOPPED. */
int tri_output_write_at(const struct tri_output *output, uint64_t place, const char *data, size_t size);
enum tri_status tri_output_conclude(struct tri_output *output, int result, struct tri_error *error);

/* A file that has places, past the system's cache where that can be: then memory, sizes and places must be aligned for
 * it (tri_file_direct). It is the output's. */
tri_file tri_output_direct(struct tri_output *output);

/* Moves all bytes from a place on by `by`, forwards or, where by < 0, backwards over those before it; for files that
 * have places. The bytes between are then to be written. */
enum tri_status tri_output_shift(struct tri_output *output, uint64_t from, int64_t by, struct tri_error *error);

enum { TRI_WAITED_FOR = 1 << 23 };

/* All files, once they are complete, are on the disk afterwards, and their names will be when commit returns: so
 * whenever the machine loses power, a name means the old file or all of the new one. Files of less than TRI_WAITED_FOR
 * bytes together take a disk longer than they take to be made: their writing is begun and not waited for, which is what
 * ext4 does itself when a file replaces another. Also TRI_STOPPED. */
enum tri_status tri_outputs_sync(struct tri_output_set *set, struct tri_error *error);

/* Closes all files, then renames all. If a file could not be written, closed or renamed, every name is as it was before
 * (where the file system knows second names of a file; else files renamed before the failure stay). */
enum tri_status tri_outputs_commit(struct tri_output_set *set, struct tri_error *error);

/* Closes and removes what is not committed. */
void tri_outputs_abort(struct tri_output_set *set);

/* Do two paths name one regular file, by links of any kind? Where neither exists: would they, if neither is a symbolic
 * link itself? */
bool tri_is_same_file(const char *a, const char *b);

/* --- an output that several processes write, maybe on several machines, each to places of its
 * own: one of them has opened it, and commits or aborts it; the others join in by a ticket.
 *
 * That a name means the same file elsewhere is not taken for granted: a ticket holds the file's number in its file
 * system, and the file is given a length that tells it from others as long as tickets are out. Nobody reads the file
 * for that: a system that keeps pages of it in mind might write them back later, with what it has read. Systems that
 * write back whole pages (NFS, SMB) do not keep rows apart that meet in a page and come from two machines: there only
 * processes of the machine that has opened the file join in. */

enum { TRI_TICKET_PATH = 1024, TRI_TICKET_HOST = 256 };

struct tri_ticket {
    char path[TRI_TICKET_PATH];      /* as errors name the file; empty: no ticket */
    char temporary[TRI_TICKET_PATH]; /* where it is now, from the root */
    char host[TRI_TICKET_HOST];      /* the machine that has opened it */
    uint64_t inode, length;
};

/* False: there can be none. Before anything is written; tri_output_restart ends it, once all have joined. */
bool tri_ticket_make(struct tri_ticket *ticket, struct tri_output *output);

/* False: the file is not seen from here, or may not be written, or what is written here might not keep apart. The
 * output borrows the ticket, and may be written to at places, by tri_output_write_at; to be left, not discarded. */
bool tri_output_join(struct tri_output *output, struct tri_ticket *ticket, const struct tri_stop *stop);

/* Closes it, if it is open, so that others see what has been written; on_disk: and it is safe there. */
enum tri_status tri_output_leave(struct tri_output *output, bool on_disk, struct tri_error *error);

/* Writes the first n bytes of one output, which has places, into another, from this place on. */
enum tri_status tri_output_copy(const struct tri_output *from, struct tri_output *to, uint64_t place, uint64_t n,
                                struct tri_error *error);

#endif
