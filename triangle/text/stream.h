/* A stream of tiles as .node, .ele and .poly: byte for byte the files of the same mesh in memory.
 *
 * The first line of a table says how many rows it has, which is known at the end. Room is kept for a number of as many
 * digits as the stream's estimate lets expect; where it has more or fewer the rows are moved by that, once.
 *
 * On several ranks (a stream with n_ranks > 1) numbers are known from the beginning, and each rank has an output of its
 * own, in which its rows are; that of rank 0 begins with the first lines. Once the rows of the others stand behind its
 * own, its end adds what comes last; the others have none. */
#ifndef TRIANGLE_TEXT_STREAM_H
#define TRIANGLE_TEXT_STREAM_H

#include "ptriangle/tiles.h"
#include "triangle/mesh/grid.h"
#include "triangle/text/write.h"

/* A tile as a grid, of which layouts write the rows that it has. */
struct tri_tile_grid {
    struct tri_grid grid;  /* its user is this struct, which must not move; counts, base and storage are the caller's */
    struct tri_tile tile;  /* whose rows can be asked for, by the numbers that they have in the mesh */
    double *columns;       /* [regions][grid.n_columns] malloc'ed, to be freed; NULL: it has not begun */
};

/* A copy of the attributes of triangles in each region, malloc'ed; NULL: no memory. */
double *tri_copy_columns(const struct tri_stream *stream);

struct tri_text_options {
    struct tri_output *node, *ele, *poly; /* opened, the caller's, with places; NULL: not wanted */
    int32_t base;                         /* 0 or 1: what files count from */
    bool markers;                         /* they are written */
    const struct tri_pslg *figure;        /* its holes and regions go into .poly; NULL: none */
    int argc;                             /* the command line, for the comment at the end; 0: no comment */
    char *const *argv;
};

struct tri_text_stream;

/* *sink writes the files, anew where it is told of the beginning again. After its end they are complete, and their
 * owner commits them; after any failure, or where no end comes, he aborts them. What the options name outlives the
 * stream. TRI_NO_MEMORY, and of the sink what is said in triangle/text/output.h; TRI_CANNOT_WRITE also for a device or
 * pipe. */
enum tri_status tri_text_stream_new(struct tri_text_stream **stream, const struct tri_text_options *options,
                                    struct tri_sink *sink, struct tri_error *error);

/* NULL is fine. */
void tri_text_stream_free(struct tri_text_stream *stream);

/* --- tiles kept in files until all are there
 *
 * For formats that can only be written then: a sink, and afterwards the whole mesh as a grid, whose rows are read where
 * they lie. In memory are a few megabytes of it at a time.
 *
 * The files have no names: nothing is left of them, however the process ends. They take 20 bytes a point, and 8 for
 * each attribute, 28 a triangle and 20 a segment; and 8 a triangle while those of several regions are grouped; and 10 a
 * triangle, 12 a point and 12 a segment where a mesh is cut into parts. Altogether, for a triangle, and for parts: */
enum { TRI_TILE_STORE_BYTES = 46, TRI_TILE_STORE_PART_BYTES = 17 };

struct tri_tile_store;

/* The files will be in this folder; borrowed. The sink may be told of the beginning again: then what it has taken is
 * forgotten. TRI_NO_MEMORY; of the sink also TRI_CANNOT_WRITE. */
enum tri_status tri_tile_store_new(struct tri_tile_store **store, const char *folder, struct tri_sink *sink,
                                   struct tri_error *error);

/* What has been taken, once the sink was told of the end; as long as the store lives. Without neighbours and edges.
 * Rows may be asked for by any thread, and best in their order. TRI_CANNOT_WRITE. */
enum tri_status tri_tile_store_grid(struct tri_tile_store *store, bool markers, struct tri_grid *grid,
                                    struct tri_error *error);

/* NULL is fine. */
void tri_tile_store_free(struct tri_tile_store *store);

#endif
