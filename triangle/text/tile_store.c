/* One file for each kind of array, to which tiles are appended, and which is mapped at the end.
 *
 * INVARIANT: no more is in memory of the files than the rows that have been asked for since pages were let go, which
 * happens whenever somebody asks for a row whose number is a multiple of TRI_GRID_ROUNDS: for writers go through all
 * rows of a kind, once and about in their order. Where they do not, or go through extras alone, they say when. */
#include "triangle/text/tile_store.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/system.h"
#include "triangle/text/stream.h"

enum kind { POINTS, POINT_MARKERS, ATTRIBUTES, CORNERS, REGIONS, ENDS, SEGMENT_MARKERS, KINDS };
enum { EXTRAS = 8, SHEETS = KINDS + EXTRAS };

struct tri_tile_store {
    const char *folder;
    struct tri_mapped_file sheet[SHEETS]; /* kinds, then extras */
    struct tri_storage storage; /* gives the extras */
    struct tri_tile_grid all;   /* what has been taken, as one tile */
};

/* --- files */

static enum tri_status cannot_write(const struct tri_tile_store *s, struct tri_error *error)
{
    return tri_fail(error, TRI_CANNOT_WRITE, s->folder, 0, "cannot keep the mesh there until it can be written: %s",
                    strerror(errno));
}

static bool append(struct tri_tile_store *s, enum kind kind, const void *bytes, size_t n)
{
    return tri_mapped_file_append(&s->sheet[kind], s->folder, bytes, n);
}

/* --- room beside the arrays */

static void *extra(void *user, size_t bytes)
{
    struct tri_tile_store *s = user;
    for (int k = KINDS; k < SHEETS; k++)
        if (s->sheet[k].file == TRI_NO_FILE) {
            const int fault = tri_mapped_file_extend(&s->sheet[k], s->folder, bytes + 1);
            void *at = s->sheet[k].at;
            if (fault)
                tri_mapped_file_close(&s->sheet[k]);
            errno = fault;
            return at;
        }
    errno = EMFILE;
    return NULL;
}

static void extra_free(void *user, void *extra)
{
    struct tri_tile_store *s = user;
    for (int k = KINDS; extra && k < SHEETS; k++)
        if (s->sheet[k].at == extra)
            tri_mapped_file_close(&s->sheet[k]);
}

static void let_go(const void *user)
{
    const struct tri_tile_store *s = user;
    for (int k = 0; k < SHEETS; k++)
        tri_mapped_file_release_pages(&s->sheet[k]);
}

/* --- the sink */

static enum tri_status begin(void *user, const struct tri_stream *stream, struct tri_error *error)
{
    struct tri_tile_store *s = user;
    for (int k = 0; k < SHEETS; k++)
        tri_mapped_file_close(&s->sheet[k]);
    return tri_tile_grid_begin(&s->all, stream, false, error);
}

static enum tri_status take(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    struct tri_tile_store *s = user;
    struct tri_grid *all = &s->all.grid;
    const size_t v = (size_t)tile->n_vertices, t = (size_t)tile->n_triangles, g = (size_t)tile->n_segments,
                 attributes = (size_t)all->n_attributes;
    bool done = append(s, POINTS, tile->points, v * sizeof *tile->points);
    done = done && append(s, POINT_MARKERS, tile->point_markers, v * sizeof *tile->point_markers);
    done = done && append(s, ATTRIBUTES, tile->attributes, v * attributes * sizeof *tile->attributes);
    done = done && append(s, CORNERS, tile->corners, t * sizeof *tile->corners);
    done = done && append(s, REGIONS, tile->regions, t * sizeof *tile->regions);
    done = done && append(s, ENDS, tile->ends, g * sizeof *tile->ends);
    done = done && append(s, SEGMENT_MARKERS, tile->segment_markers, g * sizeof *tile->segment_markers);
    all->n_points += tile->n_vertices;
    all->n_triangles += tile->n_triangles;
    all->n_segments += tile->n_segments;
    return done ? TRI_OK : cannot_write(s, error);
}

enum tri_status tri_tile_store_grid(struct tri_tile_store *s, bool markers, struct tri_grid *grid,
                                    struct tri_error *error)
{
    for (int k = 0; k < KINDS; k++)
        if (!tri_mapped_file_map(&s->sheet[k]))
            return cannot_write(s, error);
    s->all.tile = (struct tri_tile){.points = s->sheet[POINTS].at, .point_markers = s->sheet[POINT_MARKERS].at,
                                    .attributes = s->sheet[ATTRIBUTES].at, .corners = s->sheet[CORNERS].at,
                                    .regions = s->sheet[REGIONS].at, .ends = s->sheet[ENDS].at,
                                    .segment_markers = s->sheet[SEGMENT_MARKERS].at};
    s->all.grid.has_markers = markers;
    s->all.grid.storage = &s->storage;
    *grid = s->all.grid;
    return TRI_OK;
}

/* --- the store */

enum tri_status tri_tile_store_new(struct tri_tile_store **store, const char *folder, struct tri_sink *sink,
                                   struct tri_error *error)
{
    struct tri_tile_store *s = calloc(1, sizeof *s);
    *store = s;
    if (!s)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "no memory to write files");
    s->folder = folder;
    s->storage = (struct tri_storage){.extra = extra, .extra_free = extra_free, .user = s, .let_go = let_go};
    for (int k = 0; k < SHEETS; k++)
        s->sheet[k].file = TRI_NO_FILE;
    *sink = (struct tri_sink){s, begin, take, NULL};
    return TRI_OK;
}

void tri_tile_store_free(struct tri_tile_store *s)
{
    if (!s)
        return;
    for (int k = 0; k < SHEETS; k++)
        tri_mapped_file_close(&s->sheet[k]);
    free(s->all.columns);
    free(s);
}
