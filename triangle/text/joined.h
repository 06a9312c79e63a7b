/* An output (triangle/text/output.h) that several processes write, maybe on several machines, each to places of its
 * own: one of them has opened it, and commits or aborts it; the others join in by a ticket.
 *
 * That a name means the same file elsewhere is not taken for granted: a ticket holds the file's number in its file
 * system, and the file is given a length that tells it from others as long as tickets are out. Nobody reads the file
 * for that: a system that keeps pages of it in mind might write them back later, with what it has read. Systems that
 * write back whole pages (NFS, SMB) do not keep rows apart that meet in a page and come from two machines: there only
 * processes of the machine that has opened the file join in. */
#ifndef TRIANGLE_TEXT_JOINED_H
#define TRIANGLE_TEXT_JOINED_H

#include "triangle/text/output.h"

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
