/* Writes a stream of tiles as .node, .ele and .poly files, byte for byte as for the same mesh in memory.
 *
 * The first line of a table holds its number of rows, which is known at the end only. Room is reserved for as many
 * digits as the stream's estimate has. If the actual number has more or fewer, the rows are moved once.
 *
 * With several ranks (a stream with n_ranks > 1) the numbers are known from the beginning, and each rank writes its own
 * rows to its own output. The output of rank 0 starts with the first lines. The caller appends the rows of the other
 * ranks to it; the end of rank 0's sink then adds the rest of the files. The other sinks have no end. */
#ifndef TRIANGLE_TEXT_STREAM_H
#define TRIANGLE_TEXT_STREAM_H

#include "ptriangle/tiles.h"
#include "triangle/mesh/grid.h"
#include "triangle/text/write.h"

/* A tile as a grid, from which layouts write the rows of the tile. */
struct tri_tile_grid {
    struct tri_grid grid;  /* its user is this struct, which must not move; the caller sets counts, base and storage */
    struct tri_tile tile;  /* the current tile; rows are selected by their index in the whole mesh */
    double *columns;       /* [regions][grid.n_columns] from malloc; NULL: not initialised */
};

/* Returns a copy of the triangle attributes of each region, from malloc; NULL: out of memory. */
double *tri_copy_columns(const struct tri_stream *stream);

struct tri_text_options {
    struct tri_output *node, *ele, *poly; /* open files with offsets, owned by the caller; NULL: not requested */
    int32_t base;                         /* first number in files: 0 or 1 */
    bool markers;                         /* write markers */
    const struct tri_pslg *figure;        /* holes and regions for .poly; NULL: none */
    int argc;                             /* command line for the final comment; 0: no comment */
    char *const *argv;                    /* [argc] its words */
};

struct tri_text_stream;

/* Makes a sink that writes the files; if the stream begins again, the files are written again from the start. After the
 * end of the stream the files are complete and the caller commits them. After a failure, or without an end, the caller
 * aborts them. All objects in the options must outlive the stream. TRI_NO_MEMORY; the sink also returns the errors of
 * triangle/text/output.h; TRI_CANNOT_WRITE also for a device or pipe. */
enum tri_status tri_text_stream_new(struct tri_text_stream **stream, const struct tri_text_options *options,
                                    struct tri_sink *sink, struct tri_error *error);

/* NULL is allowed. */
void tri_text_stream_free(struct tri_text_stream *stream);

/* --- tiles stored in temporary files until all have arrived
 *
 * For formats that need the whole mesh: a sink that stores the tiles, and afterwards a grid of the whole mesh, whose
 * rows are read from the files. Only a few megabytes are in memory at a time.
 *
 * The files have no names, so nothing is left of them, however the process ends. They take 20 bytes per point plus 8
 * for each attribute, 28 per triangle and 20 per segment. Grouping several regions takes 8 bytes per triangle more.
 * Dividing the mesh into parts takes 10 bytes per triangle, 12 per point and 12 per segment more. In total, per
 * triangle, and for parts in addition: */
enum { TRI_TILE_STORE_BYTES = 46, TRI_TILE_STORE_PART_BYTES = 17 };

struct tri_tile_store;

/* Makes a store whose files are in this folder (borrowed). If the stream begins again, the stored tiles are discarded.
 * TRI_NO_MEMORY; the sink also TRI_CANNOT_WRITE. */
enum tri_status tri_tile_store_new(struct tri_tile_store **store, const char *folder, struct tri_sink *sink,
                                   struct tri_error *error);

/* Returns the stored mesh as a grid, after the end of the stream; valid as long as the store. It has no neighbours and
 * edges. Rows may be requested by any thread, preferably in order. TRI_CANNOT_WRITE. */
enum tri_status tri_tile_store_grid(struct tri_tile_store *store, bool markers, struct tri_grid *grid,
                                    struct tri_error *error);

/* NULL is allowed. */
void tri_tile_store_free(struct tri_tile_store *store);

#endif
