/* Writing output files: tables and layouts.
 *
 * Why a table is written as it is: rows are formatted in chunks that fit a second-level cache, a wave of chunks at a
 * time; while one wave is formatted, the previous one is written by one more task of the same run. So the order of the
 * bytes is fixed, nobody waits for the disk, and memory is bounded. */
#include "triangle/text/write.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/text/decimal.h"
#include "triangle/text/text.h"

enum {
    CHUNK_BYTES = 1 << 18,
    WAVE_CHUNKS = 64 /* at a time, where there is an executor */
};

_Static_assert((int)TRI_ROW_SLACK >= (int)TRI_REAL_ROOM, "a row may end with a real");

static char *put(char *at, const char *text, size_t length)
{
    memcpy(at, text, length);
    return at + length;
}

/* --- tables */

/* Chunks that are formatted together, and then written together. */
struct wave {
    size_t n;
    char *buffers; /* [WAVE_CHUNKS][buffer_bytes] */
    size_t lengths[WAVE_CHUNKS];
};

struct table {
    struct tri_output *output;
    char *(*format_row)(void *user, size_t i, char *at);
    void *user;
    size_t n_rows, max_row_bytes;
    size_t chunk_rows, buffer_bytes;
    size_t begin; /* first row of the wave that is formatted */
    struct wave *formatted, *written;
    enum tri_status status; /* of writing */
    struct tri_error *error;
};

static void format_chunk(struct table *table, size_t chunk)
{
    char *const buffer = table->formatted->buffers + chunk * table->buffer_bytes, *at = buffer;
    const size_t begin = table->begin + chunk * table->chunk_rows, left = table->n_rows - begin;
    const size_t n = left < table->chunk_rows ? left : table->chunk_rows;
    for (size_t i = begin; i < begin + n; i++) {
        char *const end = table->format_row(table->user, i, at);
        assert((size_t)(end - at) <= table->max_row_bytes);
        at = end;
    }
    table->formatted->lengths[chunk] = (size_t)(at - buffer);
}

static void write_wave(struct table *table)
{
    const struct wave *const wave = table->written;
    for (size_t i = 0; i < wave->n && table->status == TRI_OK; i++)
        table->status =
            tri_output_write(table->output, wave->buffers + i * table->buffer_bytes, wave->lengths[i], table->error);
}

static void table_task(void *context, size_t i)
{
    struct table *const table = context;
    if (i == 0)
        write_wave(table);
    else
        format_chunk(table, i - 1);
}

static void swap_waves(struct table *table)
{
    struct wave *const formatted = table->formatted;
    table->formatted = table->written;
    table->written = formatted;
}

static void run_table(struct table *table, size_t wave_chunks, const struct tri_executor *executor)
{
    while (table->begin < table->n_rows && table->status == TRI_OK) {
        const size_t chunks_left = (table->n_rows - table->begin - 1) / table->chunk_rows + 1;
        const size_t n = chunks_left < wave_chunks ? chunks_left : wave_chunks;
        table->formatted->n = n;
        tri_execute(executor, n + 1, table_task, table);
        table->begin += n == chunks_left ? table->n_rows - table->begin : n * table->chunk_rows;
        swap_waves(table);
    }
    write_wave(table);
}

enum tri_status tri_write_table(struct tri_output *output, size_t n_rows, size_t max_row_bytes,
                                char *(*format_row)(void *user, size_t i, char *at), void *user,
                                const struct tri_executor *executor, struct tri_error *error)
{
    assert(max_row_bytes > 0);
    if (n_rows == 0)
        return TRI_OK;
    const size_t chunk_rows = max_row_bytes < CHUNK_BYTES ? CHUNK_BYTES / max_row_bytes : 1;
    const size_t buffer_bytes = chunk_rows * max_row_bytes + TRI_ROW_SLACK;
    const size_t all_chunks = (n_rows - 1) / chunk_rows + 1, most = executor ? WAVE_CHUNKS : 1;
    const size_t wave_chunks = all_chunks < most ? all_chunks : most;
    const int n_waves = all_chunks > wave_chunks ? 2 : 1;
    char *const buffers = malloc((size_t)n_waves * wave_chunks * buffer_bytes);
    if (!buffers)
        return tri_fail(error, TRI_NO_MEMORY, output->path, 0, "no memory to write a table");
    struct wave waves[2] = {{.buffers = buffers}, {.buffers = buffers}};
    if (n_waves == 2)
        waves[1].buffers += wave_chunks * buffer_bytes;
    struct table table = {output, format_row, user, n_rows, max_row_bytes, chunk_rows, buffer_bytes, 0, &waves[0],
                          &waves[1], TRI_OK, error};
    run_table(&table, wave_chunks, executor);
    free(buffers);
    return table.status;
}

enum tri_status tri_write_counts(struct tri_output *output, const int64_t *counts, int n, struct tri_error *error)
{
    enum { MAX_COUNTS = 8 };
    assert(n >= 1 && n <= MAX_COUNTS);
    char line[MAX_COUNTS * (TRI_INTEGER_CHARS + 2)], *at = line;
    for (int i = 0; i < n; i++)
        at = tri_print_integer(i ? put(at, "  ", 2) : at, counts[i], 0);
    at = put(at, "\n", 1);
    return tri_output_write(output, line, (size_t)(at - line), error);
}

/* A word with a line break in it must not become a record of the file. */
static char *put_word(char *at, const char *word)
{
    *at++ = ' ';
    for (; *word; word++)
        *at++ = *word == '\n' || *word == '\r' ? ' ' : *word;
    return at;
}

enum tri_status tri_write_comment(struct tri_output *output, int argc, char *const *argv, struct tri_error *error)
{
    static const char begin[] = "# Generated by";
    size_t size = sizeof begin + 1;
    for (int i = 0; i < argc; i++)
        size += strlen(argv[i]) + 1;
    char *const line = malloc(size);
    if (!line)
        return tri_fail(error, TRI_NO_MEMORY, output->path, 0, "no memory to write a comment");
    char *at = put(line, begin, sizeof begin - 1);
    for (int i = 0; i < argc; i++)
        at = put_word(at, argv[i]);
    at = put(at, "\n", 1);
    const enum tri_status status = tri_output_write(output, line, (size_t)(at - line), error);
    free(line);
    return status;
}

/* --- rows: the number first, four wide; then what is special to each */

static char *put_real(char *at, const char *blanks, size_t n_blanks, double value)
{
    return tri_print_real(put(at, blanks, n_blanks), value);
}

static char *put_attributes(char *at, const double *attributes, int32_t n)
{
    for (int32_t i = 0; i < n; i++)
        at = put_real(at, "  ", 2, attributes[i]);
    return at;
}

/* -1 means nothing in every base. */
static int64_t shown(int32_t index, int32_t base) { return index < 0 ? index : (int64_t)index + base; }

char *tri_row_node(char *at, int64_t number, const double xy[2], const double *attributes, int32_t n_attributes,
                   const int32_t *marker)
{
    at = tri_print_integer(at, number, 4);
    at = put_real(at, "    ", 4, xy[0]);
    at = put_real(at, "  ", 2, xy[1]);
    at = put_attributes(at, attributes, n_attributes);
    if (marker)
        at = tri_print_integer(put(at, "    ", 4), *marker, 0);
    return put(at, "\n", 1);
}

char *tri_row_ele(char *at, int64_t number, int32_t base, const int32_t *nodes, int n_nodes, const double *attributes,
                  int32_t n_attributes)
{
    at = put(tri_print_integer(at, number, 4), "  ", 2);
    for (int i = 0; i < n_nodes; i++)
        at = tri_print_integer(put(at, "  ", 2), (int64_t)nodes[i] + base, 4);
    at = put_attributes(at, attributes, n_attributes);
    return put(at, "\n", 1);
}

char *tri_row_segment(char *at, int64_t number, int32_t base, const int32_t ends[2], const int32_t *marker)
{
    at = put(tri_print_integer(at, number, 4), "    ", 4);
    at = put(tri_print_integer(at, (int64_t)ends[0] + base, 4), "  ", 2);
    at = tri_print_integer(at, (int64_t)ends[1] + base, 4);
    if (marker)
        at = tri_print_integer(put(at, "    ", 4), *marker, 4);
    return put(at, "\n", 1);
}

char *tri_row_edge(char *at, int64_t number, int32_t base, const int32_t ends[2], const int32_t *marker)
{
    at = put(tri_print_integer(at, number, 4), "   ", 3);
    at = put(tri_print_integer(at, (int64_t)ends[0] + base, 0), "  ", 2);
    at = tri_print_integer(at, (int64_t)ends[1] + base, 0);
    if (marker)
        at = tri_print_integer(put(at, "  ", 2), *marker, 0);
    return put(at, "\n", 1);
}

char *tri_row_neigh(char *at, int64_t number, int32_t base, const int32_t neighbors[3])
{
    at = put(tri_print_integer(at, number, 4), "    ", 4);
    at = put(tri_print_integer(at, shown(neighbors[0], base), 0), "  ", 2);
    at = put(tri_print_integer(at, shown(neighbors[1], base), 0), "  ", 2);
    at = tri_print_integer(at, shown(neighbors[2], base), 0);
    return put(at, "\n", 1);
}

char *tri_row_v_edge(char *at, int64_t number, int32_t base, const int32_t ends[2], const double *direction)
{
    at = put(tri_print_integer(at, number, 4), "   ", 3);
    at = put(tri_print_integer(at, (int64_t)ends[0] + base, 0), "  ", 2);
    at = tri_print_integer(at, shown(ends[1], base), 0);
    if (ends[1] < 0) {
        at = put_real(at, "   ", 3, direction[0]);
        at = put_real(at, "  ", 2, direction[1]);
    }
    return put(at, "\n", 1);
}

/* --- layouts: a header and a table of arrays */

/* What the callbacks below print from; each uses what its format has. */
struct arrays {
    int32_t base;
    int n_nodes;
    int32_t n_attributes;
    const double *reals;      /* [n][2], of regions [n][4] */
    const double *attributes; /* [n][n_attributes] */
    const int32_t *indices;   /* [n][2], [n][3] or [n][n_nodes] */
    const int32_t *markers;   /* [n], or NULL */
};

static const double *attributes_of(const struct arrays *arrays, size_t i)
{
    return arrays->n_attributes ? arrays->attributes + i * (size_t)arrays->n_attributes : NULL;
}

static const int32_t *marker_of(const struct arrays *arrays, size_t i)
{
    return arrays->markers ? &arrays->markers[i] : NULL;
}

static int64_t number_of(const struct arrays *arrays, size_t i) { return (int64_t)i + arrays->base; }

static enum tri_status write_rows(struct tri_output *output, const struct tri_layout *layout, size_t n,
                                  size_t max_row_bytes, char *(*format_row)(void *, size_t, char *),
                                  struct arrays *arrays, struct tri_error *error)
{
    return tri_write_table(output, n, max_row_bytes, format_row, arrays, layout->executor, error);
}

static char *format_node(void *user, size_t i, char *at)
{
    const struct arrays *const a = user;
    return tri_row_node(at, number_of(a, i), &a->reals[2 * i], attributes_of(a, i), a->n_attributes, marker_of(a, i));
}

enum tri_status tri_write_node(struct tri_output *output, const struct tri_layout *layout, size_t n,
                               const double *points, int32_t n_attributes, const double *attributes,
                               const int32_t *markers, struct tri_error *error)
{
    struct arrays arrays = {.base = layout->base, .n_attributes = n_attributes, .reals = points,
                            .attributes = attributes, .markers = markers};
    const enum tri_status status =
        tri_write_counts(output, (int64_t[]){(int64_t)n, 2, n_attributes, markers ? 1 : 0}, 4, error);
    if (status != TRI_OK)
        return status;
    return write_rows(output, layout, n, tri_row_node_bytes(n_attributes), format_node, &arrays, error);
}

static char *format_ele(void *user, size_t i, char *at)
{
    const struct arrays *const a = user;
    return tri_row_ele(at, number_of(a, i), a->base, &a->indices[i * (size_t)a->n_nodes], a->n_nodes,
                       attributes_of(a, i), a->n_attributes);
}

enum tri_status tri_write_ele(struct tri_output *output, const struct tri_layout *layout, size_t n, int n_nodes,
                              const int32_t *nodes, int32_t n_attributes, const double *attributes,
                              struct tri_error *error)
{
    struct arrays arrays = {.base = layout->base, .n_nodes = n_nodes, .n_attributes = n_attributes,
                            .attributes = attributes, .indices = nodes};
    const enum tri_status status =
        tri_write_counts(output, (int64_t[]){(int64_t)n, n_nodes, n_attributes}, 3, error);
    if (status != TRI_OK)
        return status;
    return write_rows(output, layout, n, tri_row_ele_bytes(n_nodes, n_attributes), format_ele, &arrays, error);
}

/* Where segments have no markers but the column is asked for, all are 0. */
static const int32_t no_marker = 0;

static char *format_segment(void *user, size_t i, char *at)
{
    const struct arrays *const a = user;
    const int32_t *const marker = a->markers == &no_marker ? &no_marker : marker_of(a, i);
    return tri_row_segment(at, number_of(a, i), a->base, &a->indices[2 * i], marker);
}

static enum tri_status write_segments(struct tri_output *output, const struct tri_layout *layout,
                                      const struct tri_pslg *pslg, bool with_markers, struct tri_error *error)
{
    struct arrays arrays = {.base = layout->base, .indices = pslg->segments};
    if (with_markers)
        arrays.markers = pslg->segment_markers ? pslg->segment_markers : &no_marker;
    const enum tri_status status =
        tri_write_counts(output, (int64_t[]){pslg->n_segments, with_markers}, 2, error);
    if (status != TRI_OK)
        return status;
    return write_rows(output, layout, (size_t)pslg->n_segments, TRI_ROW_SEGMENT_BYTES, format_segment, &arrays, error);
}

/* Holes and regions: n_nodes reals in each row. */
static char *format_site(void *user, size_t i, char *at)
{
    const struct arrays *const a = user;
    const double *const reals = &a->reals[i * (size_t)a->n_nodes];
    at = tri_print_integer(at, number_of(a, i), 4);
    at = put_real(at, "   ", 3, reals[0]);
    at = put_attributes(at, reals + 1, a->n_nodes - 1);
    return put(at, "\n", 1);
}

static enum tri_status write_sites(struct tri_output *output, const struct tri_layout *layout, int32_t n, int n_reals,
                                   const double *reals, struct tri_error *error)
{
    struct arrays arrays = {.base = layout->base, .n_nodes = n_reals, .reals = reals};
    const enum tri_status status = tri_write_counts(output, (int64_t[]){n}, 1, error);
    if (status != TRI_OK)
        return status;
    return write_rows(output, layout, (size_t)n, tri_row_node_bytes(n_reals), format_site, &arrays, error);
}

enum tri_status tri_write_poly(struct tri_output *output, const struct tri_layout *layout, const struct tri_pslg *pslg,
                               bool with_markers, struct tri_error *error)
{
    enum tri_status status = tri_write_counts(output, (int64_t[]){0, 2, pslg->n_attributes, with_markers}, 4, error);
    if (status == TRI_OK)
        status = write_segments(output, layout, pslg, with_markers, error);
    if (status == TRI_OK)
        status = write_sites(output, layout, pslg->n_holes, 2, pslg->holes, error);
    if (status == TRI_OK && pslg->n_regions > 0)
        status = write_sites(output, layout, pslg->n_regions, 4, pslg->regions, error);
    return status;
}

static char *format_edge(void *user, size_t i, char *at)
{
    const struct arrays *const a = user;
    return tri_row_edge(at, number_of(a, i), a->base, &a->indices[2 * i], marker_of(a, i));
}

enum tri_status tri_write_edge(struct tri_output *output, const struct tri_layout *layout, size_t n,
                               const int32_t *ends, const int32_t *markers, struct tri_error *error)
{
    struct arrays arrays = {.base = layout->base, .indices = ends, .markers = markers};
    const enum tri_status status = tri_write_counts(output, (int64_t[]){(int64_t)n, markers ? 1 : 0}, 2, error);
    if (status != TRI_OK)
        return status;
    return write_rows(output, layout, n, TRI_ROW_EDGE_BYTES, format_edge, &arrays, error);
}

static char *format_neigh(void *user, size_t i, char *at)
{
    const struct arrays *const a = user;
    return tri_row_neigh(at, number_of(a, i), a->base, &a->indices[3 * i]);
}

enum tri_status tri_write_neigh(struct tri_output *output, const struct tri_layout *layout, size_t n,
                                const int32_t *neighbors, struct tri_error *error)
{
    struct arrays arrays = {.base = layout->base, .indices = neighbors};
    const enum tri_status status = tri_write_counts(output, (int64_t[]){(int64_t)n, 3}, 2, error);
    if (status != TRI_OK)
        return status;
    return write_rows(output, layout, n, TRI_ROW_NEIGH_BYTES, format_neigh, &arrays, error);
}

static char *format_v_edge(void *user, size_t i, char *at)
{
    const struct arrays *const a = user;
    return tri_row_v_edge(at, number_of(a, i), a->base, &a->indices[2 * i], a->reals ? &a->reals[2 * i] : NULL);
}

enum tri_status tri_write_v_edge(struct tri_output *output, const struct tri_layout *layout, size_t n,
                                 const int32_t *ends, const double *directions, struct tri_error *error)
{
    struct arrays arrays = {.base = layout->base, .reals = directions, .indices = ends};
    const enum tri_status status = tri_write_counts(output, (int64_t[]){(int64_t)n, 0}, 2, error);
    if (status != TRI_OK)
        return status;
    return write_rows(output, layout, n, TRI_ROW_V_EDGE_BYTES, format_v_edge, &arrays, error);
}

/* z is 0. */
static char *format_off_vertex(void *user, size_t i, char *at)
{
    const struct arrays *const a = user;
    at = put_real(at, " ", 1, a->reals[2 * i]);
    at = put_real(at, "  ", 2, a->reals[2 * i + 1]);
    return put(at, "  0\n", 4);
}

static char *format_off_face(void *user, size_t i, char *at)
{
    const struct arrays *const a = user;
    const int32_t *const nodes = &a->indices[i * (size_t)a->n_nodes];
    at = tri_print_integer(put(at, " 3   ", 5), nodes[0], 4);
    at = tri_print_integer(put(at, "  ", 2), nodes[1], 4);
    at = tri_print_integer(put(at, "  ", 2), nodes[2], 4);
    return put(at, "\n", 1);
}

enum tri_status tri_write_off_header(struct tri_output *output, size_t n_points, size_t n_faces, size_t n_edges,
                                     struct tri_error *error)
{
    char line[3 * (TRI_INTEGER_CHARS + 1) + 4], *at = put(line, "OFF\n", 4);
    at = tri_print_integer(at, (int64_t)n_points, 0);
    at = tri_print_integer(put(at, " ", 1), (int64_t)n_faces, 0);
    at = tri_print_integer(put(at, " ", 1), (int64_t)n_edges, 0);
    at = put(at, "\n", 1);
    return tri_output_write(output, line, (size_t)(at - line), error);
}

enum tri_status tri_write_off(struct tri_output *output, const struct tri_layout *layout, size_t n_points,
                              const double *points, size_t n_triangles, int n_nodes, const int32_t *nodes,
                              size_t n_edges, struct tri_error *error)
{
    struct arrays arrays = {.n_nodes = n_nodes, .reals = points, .indices = nodes};
    enum tri_status status = tri_write_off_header(output, n_points, n_triangles, n_edges, error);
    if (status == TRI_OK)
        status = write_rows(output, layout, n_points, tri_row_node_bytes(0), format_off_vertex, &arrays, error);
    if (status == TRI_OK)
        status = write_rows(output, layout, n_triangles, tri_row_ele_bytes(3, 0), format_off_face, &arrays, error);
    return status;
}
