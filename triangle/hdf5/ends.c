/* Writes an array with known contents by compressing it piece by piece.
 *
 * HDF5's filters for this array are shuffle, which stores byte 0 of all numbers of a chunk first, then byte 1 and so
 * on, as eight planes; and deflate, a zlib stream. In HDF5 this takes 20 ns per cell, a quarter of the time in which a
 * cell is made. But most planes repeat. A chunk of 2^16 triangles begins with a multiple of 3 * 2^16, so its planes 0
 * and 1 are the same in all chunks, and most others consist of one value. Flushed deflate streams can be concatenated,
 * and their checksums combined (RFC 1950, 1951; zlib). So a plane that equals that of the previous chunk is compressed
 * only once. Chunks that extend beyond the triangles are written by HDF5. */
#include "triangle/hdf5/views.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "triangle/text/binary.h"

enum { ROWS = 1 << 16, PLANES = 8, PLANE_ROOM = 1 << 14, STREAM_ROOM = PLANES * PLANE_ROOM + 8, LEVEL = 1 };

/* A compressed plane. */
struct plane {
    int value;                 /* value of all bytes; < 0: they differ */
    bool known;
    size_t n;
    uLong check;
    unsigned char bytes[PLANE_ROOM];
};

struct ends {
    struct tri_h5_file *file;
    const char *path;
    int64_t triangles, n;      /* number of triangles; number of elements of the array */
    hid_t dataset, space;
    char *numbers;             /* [ROWS][8] */
    unsigned char *stream;     /* [STREAM_ROOM] */
    struct plane planes[PLANES];
    z_stream z;
    struct tri_error *error;
};

static int64_t end_of(const struct ends *e, int64_t i)
{
    return i <= e->triangles ? 3 * i : 3 * e->triangles + 2 * (i - e->triangles);
}

/* --- chunks of triangles only */

/* Compresses a plane of the chunk that begins with number b. Returns false if it does not fit, which cannot happen. */
static bool deflate_plane(struct ends *e, struct plane *plane, int64_t b, int p)
{
    unsigned char *bytes = (unsigned char *)e->numbers;
    for (int64_t i = 0; i < ROWS; i++)
        bytes[i] = (unsigned char)((b + 3 * i) >> (8 * p));
    e->z.next_in = bytes;
    e->z.avail_in = ROWS;
    e->z.next_out = plane->bytes;
    e->z.avail_out = PLANE_ROOM;
    if (deflateReset(&e->z) != Z_OK || deflate(&e->z, Z_FULL_FLUSH) != Z_OK || e->z.avail_out == 0)
        return false;
    plane->n = PLANE_ROOM - e->z.avail_out;
    plane->check = adler32(adler32(0, NULL, 0), bytes, ROWS);
    plane->known = true;
    return true;
}

/* Compresses plane p again if it has changed. */
static bool update_plane(struct ends *e, int64_t b, int p)
{
    struct plane *plane = &e->planes[p];
    const int64_t first = b >> (8 * p), last = (b + 3 * (ROWS - 1)) >> (8 * p);
    const int value = first == last ? (int)(first & 255) : -1;
    if (plane->known && plane->value == value && (value >= 0 || p < 2))
        return true;
    plane->value = value;
    return deflate_plane(e, plane, b, p);
}

/* Makes the stream of the chunk that begins with cell i. Returns its length; 0: failure. */
static size_t make_stream(struct ends *e, int64_t i)
{
    unsigned char *at = e->stream;
    uLong check = adler32(0, NULL, 0);
    *at++ = 0x78; /* head of a zlib stream */
    *at++ = 0x01;
    for (int p = 0; p < PLANES; p++) {
        const struct plane *plane = &e->planes[p];
        if (!update_plane(e, 3 * i, p))
            return 0;
        memcpy(at, plane->bytes, plane->n);
        at += plane->n;
        check = adler32_combine(check, plane->check, ROWS);
    }
    *at++ = 0x03; /* final empty block */
    *at++ = 0x00;
    for (int k = 3; k >= 0; k--)
        *at++ = (unsigned char)(check >> (8 * k));
    return (size_t)(at - e->stream);
}

static enum tri_status write_stream(struct ends *e, int64_t i)
{
    const hsize_t place = (hsize_t)i;
    const size_t n = make_stream(e, i);
    if (n == 0)
        return tri_fail(e->error, TRI_INTERNAL, e->file->output->path, 0, "cannot deflate %s", e->path);
    if (H5Dwrite_chunk(e->dataset, H5P_DEFAULT, 0, &place, n, e->stream) < 0)
        return tri_h5_fail(e->file, e->path, e->error);
    return TRI_OK;
}

/* --- other chunks */

static enum tri_status write_numbers(struct ends *e, int64_t first)
{
    const int64_t left = e->n - first;
    const hsize_t place = (hsize_t)first, size = (hsize_t)(left < ROWS ? left : ROWS);
    char *at = e->numbers;
    for (int64_t i = first; i < first + (int64_t)size; i++)
        at = tri_put_i64(at, end_of(e, i));
    hid_t memory = H5Screate_simple(1, &size, NULL);
    bool done = memory >= 0 && H5Sselect_hyperslab(e->space, H5S_SELECT_SET, &place, NULL, &size, NULL) >= 0 &&
                H5Dwrite(e->dataset, H5T_STD_I64LE, memory, e->space, H5P_DEFAULT, e->numbers) >= 0;
    tri_h5_close_id(H5Sclose, memory);
    return done ? TRI_OK : tri_h5_fail(e->file, e->path, e->error);
}

/* --- the dataset */

static hid_t create(const struct ends *e)
{
    const hsize_t n = (hsize_t)e->n, chunk = n < ROWS ? n : ROWS;
    hid_t creation = tri_h5_no_times(H5P_DATASET_CREATE);
    const bool deflated = creation >= 0 && H5Pset_chunk(creation, 1, &chunk) >= 0 && H5Pset_shuffle(creation) >= 0 &&
                          H5Pset_deflate(creation, LEVEL) >= 0;
    hid_t dataset = tri_h5_new_dataset(e->file, e->path, H5T_STD_I64LE, 1, &n, NULL, creation);
    if (deflated || dataset < 0)
        return dataset;
    H5Dclose(dataset);
    return -1;
}

static enum tri_status write_all(struct ends *e)
{
    enum tri_status status = TRI_OK;
    e->dataset = create(e);
    e->space = e->dataset >= 0 ? H5Dget_space(e->dataset) : -1;
    if (e->dataset < 0 || e->space < 0)
        return tri_h5_fail(e->file, e->path, e->error);
    for (int64_t i = 0; i < e->n && !status; i += ROWS)
        status = i + ROWS <= e->triangles ? write_stream(e, i) : write_numbers(e, i);
    return status;
}

enum tri_status tri_h5_write_ends(struct tri_h5_file *file, const char *path, int64_t triangles, int64_t segments,
                                  struct tri_error *error)
{
    struct ends *e = calloc(1, sizeof *e);
    enum tri_status status = TRI_OK;
    if (!e)
        return tri_fail(error, TRI_NO_MEMORY, file->output->path, 0, "no memory to write %s", path);
    *e = (struct ends){.file = file, .path = path, .triangles = triangles, .n = triangles + segments + 1, .dataset = -1,
                       .space = -1, .numbers = malloc(8 * ROWS), .stream = malloc(STREAM_ROOM), .error = error};
    const bool ready = deflateInit2(&e->z, LEVEL, Z_DEFLATED, -MAX_WBITS, MAX_MEM_LEVEL, Z_DEFAULT_STRATEGY) == Z_OK;
    if (!ready || !e->numbers || !e->stream)
        status = tri_fail(error, TRI_NO_MEMORY, file->output->path, 0, "no memory to write %s", path);
    status = status ? status : write_all(e);
    if (ready)
        deflateEnd(&e->z);
    tri_h5_close_id(H5Dclose, e->dataset);
    tri_h5_close_id(H5Sclose, e->space);
    free(e->numbers);
    free(e->stream);
    free(e);
    return status;
}
