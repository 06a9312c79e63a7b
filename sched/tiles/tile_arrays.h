/* The arrays of a tile: as a list for code that copies, sends or stores them all alike, and how they are filled. */
#ifndef SCHED_TILES_TILE_ARRAYS_H
#define SCHED_TILES_TILE_ARRAYS_H

#include <stddef.h>

#include "ptriangle/tiles.h"
#include "triangle/mesh/mesh.h"

/* Indices of the two arrays of vertex numbers (corners of triangles, ends of segments), and the number of arrays. */
enum { PAR_TILE_CORNERS = 3, PAR_TILE_ENDS = 5, PAR_TILE_ARRAYS = 7 };

struct par_array {
    const void *at; /* first byte */
    size_t bytes;   /* size */
};

/* Lists the arrays of a tile in the order of struct tri_tile. */
void par_tile_arrays(const struct tri_tile *tile, int32_t n_attributes, struct par_array array[PAR_TILE_ARRAYS]);

/* Sets the pointers of a tile to these arrays. */
void par_tile_point_at(struct tri_tile *tile, const struct par_array array[PAR_TILE_ARRAYS]);

/* Rounds a size up to a multiple of eight bytes. Packed arrays are padded to this size, so that all are aligned. */
static inline size_t par_padded(size_t n) { return (n + 7) / 8 * 8; }

/* --- a tile as bytes: its struct, then its arrays */

/* Returns the size of a packed tile. */
size_t par_tile_bytes(const struct tri_tile *tile, int32_t n_attributes);

/* Packs a tile. `to` has room for par_tile_bytes bytes. */
void par_tile_pack(char *to, const struct tri_tile *tile, int32_t n_attributes);

/* Sets *tile to a packed tile, whose arrays stay in `bytes`: at most n bytes, aligned as by malloc. Returns the size of
 * the packed tile; 0: the bytes are not a valid tile. */
size_t par_tile_unpack(const char *bytes, size_t n, int32_t n_attributes, struct tri_tile *tile);

/* --- the memory of a tile's arrays, in the caller's coordinates and numbers */

struct par_tile_copy {
    double (*points)[2], *attributes;                   /* arrays of struct tri_tile, by the same names */
    int32_t *point_markers, *regions, *segment_markers; /* likewise */
    int64_t (*corners)[3], (*ends)[2];                  /* likewise */
    void *block;                                        /* [size] the memory of all these arrays; NULL: none yet */
    size_t size;                                        /* bytes of `block` */
};

/* Allocates arrays for the numbers of vertices, triangles and segments in *tile, and points *tile to them. The previous
 * contents are lost. *copy is all 0 before the first call. Call par_tile_copy_free in any case. False: no memory. */
bool par_tile_copy_reserve(struct par_tile_copy *copy, const struct tri_mesh *mesh, struct tri_tile *tile);
void par_tile_copy_free(struct par_tile_copy *copy);

/* Copies vertex v of the mesh to index `to` of the tile. */
void par_tile_copy_vertex(const struct par_tile_copy *copy, const struct tri_mesh *mesh, tri_vertex_id v, int32_t to);

/* Returns the number by which a vertex is handed out. `number` counts the caller's points in the order of the mesh, and
 * is the one to use in comparisons. The result counts the caller's points in the caller's order. */
static inline int64_t par_shown(const struct tri_mesh *mesh, int64_t number)
{
    return mesh->origin && number < mesh->n_input ? mesh->origin[number] : number;
}

/* --- filling the arrays of a tile: its vertices, triangles and subsegments in the order of their numbers */

/* A tile that is being filled. Its memory is reused for the next tile. */
struct par_tile_job {
    struct tri_tile tile;      /* the tile; its pointers point into `copy` */
    struct par_tile_copy copy; /* memory of the tile's arrays */
    uint64_t *scratch;         /* [n_scratch] working memory; NULL: none yet */
    int64_t n_scratch;         /* words in `scratch` */
};

/* Reserves n words of scratch. False: no memory. */
bool par_tile_job_reserve(struct par_tile_job *job, int64_t n);
void par_tile_job_free(struct par_tile_job *job);

/* Overwrites the record of a final triangle with the data to be handed out: the numbers of its corners, the largest
 * first, and its region. The triangle stays live. number: of its corners. first: the number of the first vertex in its
 * tile. n_input: of the mesh. Returns the triangle's note for par_tile_fill. Notes are read in sequence, which avoids
 * another access to triangles that are scattered in memory. */
int32_t par_final_make(struct tri_triangle *triangle, const int64_t number[3], int64_t first, int64_t n_input);

/* The ids of a tile. The lengths of the lists are in struct tri_tile. */
struct par_tile_ids {
    const int32_t *vertices;  /* in the order of their numbers */
    const int32_t *triangles; /* in any order, each converted by par_final_make */
    const int32_t *notes;     /* the note of each triangle */
    const int32_t *subs;      /* subsegments, in any order */
};

/* Fills the arrays of job->tile, whose first numbers and counts are set. Afterwards the ids of the triangles are free.
 * number: of each vertex of the mesh. False: no memory. */
bool par_tile_fill(struct par_tile_job *job, const struct tri_mesh *mesh, const int64_t *number,
                   const struct par_tile_ids *ids);

#endif
