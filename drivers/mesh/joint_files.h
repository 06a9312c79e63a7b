/* Files that all ranks write together, each the rows that it owns: a sink on each rank, and on rank 0 the files, opened
 * there and committed there. They are byte for byte those of one process. Nothing of them moves between ranks.
 *
 * WHO WRITES WHAT WHERE. Before the first tile all know how many vertices, triangles and segments each rank owns.
 *   HDF5  Rank 0 lays the file out, and tells all where each array lies (triangle/hdf5/rows.h); a row's place follows
 *         from its number. At the end rank 0 adds what describes the arrays.
 *   text  Lines have different lengths: each rank keeps its own in a file of its scratch folder, until all have told
 *         how many bytes they have; then it copies them behind those of the ranks before it. The first line, whose
 *         numbers are known, and what follows the last rows are rank 0's.
 * What a rank has to write it writes through a descriptor of its own, by the temporary name that rank 0 has given the
 * file. Where not all ranks see that file (triangle/text/output.h), none of them writes: then, as for formats that need
 * the whole mesh, tiles go to rank 0 (sched/ranks/relay.h). */
#ifndef DRIVERS_MESH_JOINT_FILES_H
#define DRIVERS_MESH_JOINT_FILES_H

#include "drivers/mesh/orphans.h"
#include "ptriangle/tiles.h"
#include "sched/ranks/carrier.h"
#include "triangle/hdf5/h5_write.h"
#include "triangle/text/output.h"
#include "triangle/text/stream.h"

enum { JOINT_TEXTS = 3, JOINT_H5 = 4, JOINT_FILES = JOINT_TEXTS + JOINT_H5 };

struct joint_h5 {                 /* an HDF5 file: the first three on rank 0 alone, the rest on all ranks */
    struct tri_h5_writer *writer; /* NULL: there is no such file, or this is not rank 0 */
    struct tri_sink sink;         /* of the writer */
    struct tri_output *output;    /* of the writer */
    struct tri_h5_layout layout;  /* where rows belong; ours, except that rank 0 refers to the writer's */
    struct tri_h5_part *part;     /* writes this rank's rows; NULL: not begun, or no such file */
};

struct joint_files {
    /* Asked for. */
    struct par_carrier *carrier;          /* between the ranks */
    const char *scratch;                  /* the folder of spools */
    bool no_sync;                         /* files get their names without a look at the disk */
    const struct tri_stop *stop;          /* of what other ranks than the first one write; NULL: never asked */
    struct tri_text_options text_options; /* its three outputs on rank 0 alone */
    struct tri_sink text;                 /* rank 0: that of these files; all NULL: there are none */
    struct joint_h5 h5[JOINT_H5];         /* those that there are come first */
    struct orphans orphans;               /* which HDF5 files leave out */
    /* Found. */
    bool together;                        /* all ranks write */
    struct tri_ticket *ticket;            /* [JOINT_FILES] texts, then HDF5 files; an empty path: no such file */
    struct tri_output file[JOINT_FILES];  /* where others than rank 0 have joined in */
    struct tri_output spool[JOINT_TEXTS]; /* their lines, until all know where these belong */
    struct tri_text_stream *stream;       /* into these; NULL: not begun, or rank 0 */
    struct tri_sink to_spool;             /* of the stream */
    int32_t n_attributes;                 /* of a point */
    int64_t total[3];                     /* vertices, triangles, segments of all ranks, once the sink has begun */
    int64_t n_input;                      /* points before refinement, without orphans; counted on rank 0, else 0 */
    double bounds[4];                     /* least x, least y, greatest x, greatest y of this rank's points */
};

/* Collective, on files just opened: finds out whether all ranks can write them. wanted, of rank 0: they shall. The
 * agreement includes the status. To be closed in any case. */
enum tri_status joint_files_open(struct joint_files *joint, bool wanted, enum tri_status status,
                                 struct tri_error *error);

/* On each rank, where all write together. */
struct tri_sink joint_files_sink(struct joint_files *joint);

/* Collective: an agreement on the status. */
enum tri_status joint_files_close(struct joint_files *joint, enum tri_status status, struct tri_error *error);

#endif
