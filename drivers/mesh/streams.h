/* Files that are written tile by tile: while the mesh is made, where it is swept, else when it is there. */
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

/* One HDF5 file and the text beside it. */
struct stream {
    struct tri_h5_options options;
    struct tri_h5_writer *writer;
};

struct streams {
    int n;
    struct stream stream[LONG_OPTIONS_MOST_EXPORTS];
    struct tri_text_options text_options;
    struct tri_text_stream *text; /* .node, .ele and .poly; NULL: none of them */
    int n_exports;
    struct export export[LONG_OPTIONS_MOST_EXPORTS]; /* in other formats, at the end: */
    struct tri_tile_store *store;  /* NULL: none of them */
    const struct run *run;
    int n_sinks;
    struct tri_sink sink[LONG_OPTIONS_MOST_EXPORTS + 2]; /* of the HDF5 files, of the texts, of the store */
    int64_t taken[3]; /* vertices, triangles, segments so far, orphans included */
    int32_t n_attributes; /* of a point */
};

/* The name of the text beside a file of that name, malloc'ed; NULL: no memory. */
static inline char *stream_xdmf(const char *name) { return tri_name(name, tri_name_h5(name), ".xdmf"); }

/* Opens the HDF5 files of the run in run->outputs; where run->plan.swept, also those of Triangle's files that the run
 * asks for, and those in formats that are written when all of the mesh is there, which until then lies in files in the
 * scratch folder. To be closed in any case, before the set is committed. */
enum tri_status streams_open(struct streams *streams, const struct run *run);
void streams_close(struct streams *streams);

/* Hands everything to all of them. */
struct tri_sink streams_sink(struct streams *streams);

/* Hands the mesh of the run, which is finished and in memory, to streams_sink. run->unused has been counted; n_before
 * vertices were there before refinement. */
enum tri_status streams_hand_out(struct streams *streams, struct tri_mesh *mesh, int32_t n_before);

#endif
