/* Files that are written tile by tile: during refinement if the mesh is swept, otherwise after it. */
#ifndef DRIVERS_MESH_STREAMS_H
#define DRIVERS_MESH_STREAMS_H

#include <string.h>

#include "drivers/mesh/mesh_files.h"
#include "drivers/mesh/stages.h"
#include "ptriangle/tiles.h"
#include "triangle/hdf5/h5_write.h"
#include "triangle/text/formats.h"
#include "triangle/text/names.h"
#include "triangle/text/stream.h"

/* One HDF5 file and the text file beside it. */
struct stream {
    struct tri_h5_options options;
    struct tri_h5_writer *writer;
};

struct streams {
    int n;
    struct stream stream[LONG_OPTIONS_MOST_EXPORTS];
    struct tri_text_options text_options;
    struct tri_text_stream *text; /* .node, .ele and .poly; NULL: not written */
    int n_exports;
    struct export export[LONG_OPTIONS_MOST_EXPORTS]; /* other formats, written at the end */
    struct tri_tile_store *store;  /* tiles that wait for these formats; NULL: there are none */
    const struct run *run;
    int n_sinks;
    struct tri_sink sink[LONG_OPTIONS_MOST_EXPORTS + 2]; /* sinks of the HDF5 files, of the text files, and of the
                                                            store */
    int64_t taken[3]; /* vertices, triangles, segments received so far, with orphans */
    int32_t n_attributes; /* number of attributes of a point */
};

/* Returns the name of the text file beside the file of that name, malloc'ed; NULL: no memory. */
static inline char *stream_xdmf(const char *name) { return tri_name(name, tri_name_h5(name), ".xdmf"); }

/* Opens the HDF5 files of the run in run->outputs. If run->plan.swept, also opens Triangle's files, and the files of
 * formats that are written at the end. Data for the latter wait in the scratch folder. streams_close must be called in
 * any case, before the set is committed. */
enum tri_status streams_open(struct streams *streams, const struct run *run);
void streams_close(struct streams *streams);

/* Returns a sink that passes everything to all files. */
struct tri_sink streams_sink(struct streams *streams);

/* Passes the mesh of the run, which is finished and in memory, to streams_sink. run->unused must have been counted.
 * n_before: number of vertices before refinement. */
enum tri_status streams_hand_out(struct streams *streams, struct tri_mesh *mesh, int32_t n_before);

#endif
