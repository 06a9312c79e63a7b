/* Output files that appear together, when all are complete, or not at all.
 *
 * A file is written under a temporary name in its final folder, ".tri-<host>-<process>-<number>.tmp", and is locked
 * while its process works on it. If a process is killed, the next run that writes to the same folder removes its
 * temporary files. A file counts as left behind if this host made it, no process with its number exists, and no process
 * holds the lock. The kernel drops a lock when its process dies, in any container. So no file in use is removed, even
 * if folders are shared between hosts, or process numbers occur twice. (Between the last close and the rename, for
 * microseconds, only the process number protects the file. If it were removed then, the run would fail and leave
 * everything unchanged.) Without file locks nothing is removed.
 *
 * Errors of all functions: TRI_CANNOT_WRITE, TRI_NO_MEMORY; tri_output_write also TRI_STOPPED. */
#ifndef TRIANGLE_TEXT_OUTPUT_H
#define TRIANGLE_TEXT_OUTPUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "triangle/base/status.h"
#include "triangle/base/system.h"

enum { TRI_MAX_OUTPUTS = 544 };

/* Identity of a file: the inode of an existing file; for a new file, the inode of its folder, together with its
 * name. */
struct tri_output_place {
    bool known;  /* false: a device or pipe, which may be used twice */
    bool exists; /* the file exists */
    uint64_t device, node; /* file system and inode */
};

struct tri_output {
    char *path;      /* final name: the caller's path with symbolic links resolved */
    struct tri_output_place place; /* identity of the file to be written */
    char *temporary; /* temporary name; NULL: a device or pipe, written directly */
    char *old;       /* during the renames: second name of the file to be replaced; NULL: none */
    bool replaces;   /* a file of that name existed */
    bool renamed;    /* it has its final name */
    tri_file file;   /* TRI_NO_FILE: closed */
    tri_file direct; /* the same file, bypassing the system's cache; TRI_NO_FILE: not opened */
    bool no_direct;  /* the file cannot be opened that way */
    uint64_t size;   /* bytes written or reserved */
    bool failed;     /* a write has failed */
    const struct tri_stop *stop; /* that of the set */
};

/* Files that are written together. INVARIANT: until commit no final name has changed; after commit or abort no
 * temporary file is left and the set is empty. (Devices and pipes are exceptions.) */
struct tri_output_set {
    int n;                       /* number of outputs */
    struct tri_output outputs[TRI_MAX_OUTPUTS];
    int next_name;               /* number in the next temporary name; lower ones have been tried */
    bool waits;                  /* commit syncs the folders, since the files have been synced */
    bool trial;                  /* only test whether all can be opened: leave devices and pipes alone */
    const struct tri_stop *stop; /* polled by tri_output_write; borrowed; NULL: never stop */
};

/* Makes an empty set. The caller may then set `trial` and `stop`. */
void tri_outputs_begin(struct tri_output_set *set);

/* Creates a temporary file in the folder of `path`, with a name that no other process or thread uses. Sets *output to
 * it; it belongs to the set. An existing file is replaced at commit and its permissions are kept; symbolic links to it
 * stay valid. Folders, files without write permission and a second output for the same file are rejected here, before
 * any work is done. */
enum tri_status tri_output_open(struct tri_output_set *set, const char *path, struct tri_output **output,
                                struct tri_error *error);

/* Discards everything written so far. Only for files, which have offsets. TRI_CANNOT_WRITE. */
enum tri_status tri_output_restart(struct tri_output *output, struct tri_error *error);

/* Appends bytes. */
enum tri_status tri_output_write(struct tri_output *output, const char *data, size_t size, struct tri_error *error);

/* Can several threads write pieces at given offsets? A file has offsets, a device or pipe does not. */
static inline bool tri_output_has_offsets(const struct tri_output *output) { return output->temporary != NULL; }

/* Reserves the next `size` bytes and returns their offset. The caller must write them. */
uint64_t tri_output_reserve(struct tri_output *output, size_t size);

enum { TRI_OUTPUT_STOPPED = -1 };

/* Writes bytes at a reserved offset; from any thread. Returns 0, or an errno value or TRI_OUTPUT_STOPPED, which
 * tri_output_conclude turns into an error. */
int tri_output_write_at(const struct tri_output *output, uint64_t place, const char *data, size_t size);
enum tri_status tri_output_conclude(struct tri_output *output, int result, struct tri_error *error);

/* Returns a descriptor of a file with offsets that bypasses the system's cache, if possible. Memory, sizes and offsets
 * must then be aligned (tri_file_direct). The output owns it. */
tri_file tri_output_direct(struct tri_output *output);

/* Moves all bytes from offset `from` on by `by`: forwards, or backwards over preceding bytes if by < 0. Only for files
 * with offsets. The caller must write the bytes of the gap. */
enum tri_status tri_output_shift(struct tri_output *output, uint64_t from, int64_t by, struct tri_error *error);

enum { TRI_SYNC_BYTES = 1 << 23 };

/* Makes sure that all files, once complete, are on the disk, and that their names will be when commit returns. So after
 * a power failure at any time, a name refers to the old file or to the complete new one. Files of less than
 * TRI_SYNC_BYTES bytes in total would take longer to sync than to make. Their writing is started but not waited for, as
 * ext4 does when a file replaces another. Also TRI_STOPPED. */
enum tri_status tri_outputs_sync(struct tri_output_set *set, struct tri_error *error);

/* Closes all files, then renames all. If a file could not be written, closed or renamed, all names are restored. (If
 * the file system has no hard links, files renamed before the failure stay.) */
enum tri_status tri_outputs_commit(struct tri_output_set *set, struct tri_error *error);

/* Closes and removes all files that have not been committed. */
void tri_outputs_abort(struct tri_output_set *set);

/* Do two paths name the same regular file, through links of any kind? If neither exists: would they, assuming that
 * neither is a symbolic link? */
bool tri_is_same_file(const char *a, const char *b);

/* --- an output written by several processes, maybe on several machines, each at its own offsets
 *
 * One process opens the output, and commits or aborts it; the others join by a ticket. The same name may refer to a
 * different file on another machine. So a ticket holds the inode number, and the file has a distinctive length while
 * tickets are out. This check reads no data: a system that caches pages might later write them back with old contents.
 * On systems that write back whole pages (NFS, SMB), rows that share a page must not be written by two machines, so
 * only processes on the machine that opened the file can join. */

enum { TRI_TICKET_PATH = 1024, TRI_TICKET_HOST = 256 };

struct tri_ticket {
    char path[TRI_TICKET_PATH];      /* name of the file in errors; empty: no ticket */
    char temporary[TRI_TICKET_PATH]; /* absolute path of the temporary file */
    char host[TRI_TICKET_HOST];      /* the machine that opened it */
    uint64_t inode, length;          /* inode and length by which the others recognise the file */
};

/* Makes a ticket before anything is written. After all processes have joined, call tri_output_restart. Returns false if
 * no ticket is possible. */
bool tri_ticket_make(struct tri_ticket *ticket, struct tri_output *output);

/* Opens the output of a ticket. Returns false if the file is not visible here or not writable, or if this machine could
 * overwrite rows of others. The output borrows the ticket, and is written by tri_output_write_at only. Call
 * tri_output_leave at the end; the output belongs to no set. */
bool tri_output_join(struct tri_output *output, struct tri_ticket *ticket, const struct tri_stop *stop);

/* Closes the output, if it is open, so that others see the written data; on_disk: syncs it first. */
enum tri_status tri_output_leave(struct tri_output *output, bool on_disk, struct tri_error *error);

/* Copies the first n bytes of one output, which has offsets, to another one at offset `place`. */
enum tri_status tri_output_copy(const struct tri_output *from, struct tri_output *to, uint64_t place, uint64_t n,
                                struct tri_error *error);

#endif
