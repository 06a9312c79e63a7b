/* Files that all ranks write together. Each rank has a sink and writes the rows that it owns. Rank 0 opens and commits
 * the files. They have the same bytes as those of one process. No rows move between ranks.
 *
 * PLACES. Before the first tile all ranks know how many vertices, triangles and segments each rank owns.
 *   HDF5  Rank 0 lays out the file, and sends the place of each array to all (triangle/hdf5/rows.h). The place of a row
 *         follows from its number. At the end rank 0 adds the description of the arrays.
 *   text  Lines have different lengths. Each rank keeps its lines in a file of its scratch folder until all ranks have
 *         exchanged their numbers of bytes. Then it copies them after those of the ranks before it. Rank 0 writes the
 *         first line, whose numbers are known, and the lines after the last row.
 * Each rank opens the file by the temporary name that rank 0 has chosen, and writes through its own descriptor. If not
 * all ranks see that file (triangle/text/output.h), tiles go to rank 0 (sched/ranks/relay.h), and only rank 0 writes.
 * The same holds for formats that need the whole mesh. */
#ifndef DRIVERS_MESH_JOINT_FILES_H
#define DRIVERS_MESH_JOINT_FILES_H

#include "drivers/mesh/orphans.h"
#include "ptriangle/tiles.h"
#include "sched/ranks/carrier.h"
#include "triangle/hdf5/h5_write.h"
#include "triangle/text/output.h"
#include "triangle/text/stream.h"

enum { JOINT_TEXTS = 3, JOINT_H5 = 4, JOINT_FILES = JOINT_TEXTS + JOINT_H5 };

struct joint_h5 {                 /* an HDF5 file: the first three members on rank 0 only, the others on all ranks */
    struct tri_h5_writer *writer; /* NULL: there is no such file, or this is not rank 0 */
    struct tri_sink sink;         /* sink of the writer */
    struct tri_output *output;    /* output of the writer */
    struct tri_h5_layout layout;  /* place of rows in the file; owned here, except that on rank 0 it refers to the
                                     writer's */
    struct tri_h5_part *part;     /* writes the rows of this rank; NULL: not begun, or no such file */
};

struct joint_files {
    /* Set by the caller. */
    struct par_carrier *carrier;          /* connection between the ranks */
    const char *scratch;                  /* folder for temporary files */
    bool no_sync;                         /* files get their names before they are on the disk */
    const struct tri_stop *stop;          /* stops the writes of ranks other than 0; NULL: no stop */
    struct tri_text_options text_options; /* its three outputs are set on rank 0 only */
    struct tri_sink text;                 /* sink for text files on rank 0; all NULL: there are none */
    struct joint_h5 h5[JOINT_H5];         /* existing files come first */
    struct orphans orphans;               /* points that HDF5 files leave out */
    /* Results. */
    bool together;                        /* all ranks write */
    struct tri_ticket *ticket;            /* [JOINT_FILES] text files, then HDF5 files; an empty path: no such file */
    struct tri_output file[JOINT_FILES];  /* the files as opened by ranks other than 0 */
    struct tri_output spool[JOINT_TEXTS]; /* lines of this rank, until their place in the file is known */
    struct tri_text_stream *stream;       /* writes into the spools; NULL: not begun, or rank 0 */
    struct tri_sink to_spool;             /* sink of the stream */
    int32_t n_attributes;                 /* number of attributes of a point */
    int64_t total[3];                     /* vertices, triangles, segments of all ranks; valid after the sink has
                                             begun */
    int64_t n_input;                      /* points before refinement, without orphans; on rank 0, otherwise 0 */
    double bounds[4];                     /* least x, least y, greatest x, greatest y of this rank's points */
};

/* Finds out whether all ranks can write the files that were just opened. Collective. wanted, on rank 0: all ranks shall
 * write. The ranks also agree on the status. joint_files_close must be called in any case. */
enum tri_status joint_files_open(struct joint_files *joint, bool wanted, enum tri_status status,
                                 struct tri_error *error);

/* Returns the sink of each rank, if all ranks write together. */
struct tri_sink joint_files_sink(struct joint_files *joint);

/* Completes the files. Collective: the ranks agree on the status. */
enum tri_status joint_files_close(struct joint_files *joint, enum tri_status status, struct tri_error *error);

#endif
