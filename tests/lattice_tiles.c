/* Items by number, and tiles of them. */
#include "tests/lattice_tiles.h"

#include <stdlib.h>

int64_t lattice_points(const struct lattice *l) { return (int64_t)l->side * l->side; }
int64_t lattice_triangles(const struct lattice *l) { return 2 * (int64_t)(l->side - 1) * (l->side - 1); }
int64_t lattice_segments(const struct lattice *l) { return (int64_t)l->side * (l->side - 1); }

void lattice_point(const struct lattice *l, int64_t i, double at[2])
{
    at[0] = (double)(i % l->side) / 3;
    at[1] = (double)(i / l->side) / 3;
}

int32_t lattice_point_marker(int64_t i) { return (int32_t)(i % 7 - 2); }
double lattice_attribute(int64_t i, int32_t k) { return (double)i / 7 + k; }
int32_t lattice_region(int64_t i) { return (int32_t)(i % LATTICE_REGIONS); }
int32_t lattice_segment_marker(int64_t i) { return (int32_t)(i % 5); }

double lattice_column(const struct lattice *l, int32_t region, int32_t k)
{
    return l->whole ? 10.0 * region - k : region + 0.25 * k + 0.5;
}

void lattice_corners(const struct lattice *l, int64_t i, int64_t corners[3])
{
    const int64_t square = i / 2, row = square / (l->side - 1), a = row * l->side + square % (l->side - 1);
    const int64_t b = a + 1, c = a + l->side, d = c + 1;
    corners[0] = i % 2 ? d : a;
    corners[1] = i % 2 ? c : b;
    corners[2] = i % 2 ? b : c;
}

void lattice_ends(const struct lattice *l, int64_t i, int64_t ends[2])
{
    ends[0] = i;
    ends[1] = i + l->side;
}

struct buffers {
    double (*points)[2], *attributes;
    int32_t *point_markers, *regions, *segment_markers;
    int64_t (*corners)[3], (*ends)[2];
};

static void fill_points(const struct lattice *l, struct buffers *b, const struct tri_tile *tile)
{
    for (int32_t i = 0; i < tile->n_vertices; i++) {
        lattice_point(l, tile->first_vertex + i, b->points[i]);
        b->point_markers[i] = lattice_point_marker(tile->first_vertex + i);
        for (int32_t k = 0; k < l->n_attributes; k++)
            b->attributes[i * l->n_attributes + k] = lattice_attribute(tile->first_vertex + i, k);
    }
}

static void fill_cells(const struct lattice *l, struct buffers *b, const struct tri_tile *tile)
{
    for (int32_t i = 0; i < tile->n_triangles; i++) {
        lattice_corners(l, tile->first_triangle + i, b->corners[i]);
        b->regions[i] = lattice_region(tile->first_triangle + i);
    }
    for (int32_t i = 0; i < tile->n_segments; i++) {
        lattice_ends(l, tile->first_segment + i, b->ends[i]);
        b->segment_markers[i] = lattice_segment_marker(tile->first_segment + i);
    }
}

enum { POINTS = 1, TRIANGLES = 2, SEGMENTS = 4 };

/* Sends n rows of points, or of the triangles below them, to the sink. The tile then begins after them. */
static enum tri_status hand_rows(const struct lattice *l, const struct tri_sink *sink, struct tri_tile *tile,
                                 struct buffers *b, int32_t n, int what, struct tri_error *error)
{
    const bool first = tile->first_vertex == 0;
    tile->column = first ? -1 : 1;
    tile->row = first ? -1 : tile->row + 2;
    tile->n_vertices = what & POINTS ? n * l->side : 0;
    tile->n_triangles = what & TRIANGLES ? 2 * n * (l->side - 1) : 0;
    tile->n_segments = what & SEGMENTS ? n * l->side : 0;
    fill_points(l, b, tile);
    fill_cells(l, b, tile);
    enum tri_status status = sink->take(sink->user, tile, error);
    tile->first_vertex += tile->n_vertices;
    tile->first_triangle += tile->n_triangles;
    tile->first_segment += tile->n_segments;
    return status;
}

static void free_buffers(struct buffers *b)
{
    free(b->points);
    free(b->attributes);
    free(b->point_markers);
    free(b->regions);
    free(b->segment_markers);
    free(b->corners);
    free(b->ends);
}

static struct buffers make_buffers(const struct lattice *l)
{
    const size_t rows = (size_t)l->rows_in_tile, n = rows * (size_t)l->side, m = 2 * n, s = n;
    return (struct buffers){malloc(n * 16), malloc(n * ((size_t)l->n_attributes + 1) * 8), malloc(n * 4),
                            malloc(m * 4), malloc(s * 4), malloc(m * 24), malloc(s * 16)};
}

static enum tri_status hand_tiles(const struct lattice *l, const struct tri_sink *sink, struct tri_error *error)
{
    struct buffers b = make_buffers(l);
    struct tri_tile tile = {.row = -1, .points = (const double (*)[2])b.points, .point_markers = b.point_markers,
                            .attributes = b.attributes, .corners = (const int64_t (*)[3])b.corners,
                            .regions = b.regions, .ends = (const int64_t (*)[2])b.ends,
                            .segment_markers = b.segment_markers};
    enum tri_status status = hand_rows(l, sink, &tile, &b, 1, POINTS, error);
    const int what[] = {l->one_by_one ? POINTS : POINTS | TRIANGLES | SEGMENTS, TRIANGLES, SEGMENTS};
    for (int k = 0; k < (l->one_by_one ? 3 : 1); k++)
        for (int32_t row = 1; row < l->side && !status; row += l->rows_in_tile) {
            const int32_t left = l->side - row;
            status = hand_rows(l, sink, &tile, &b, left < l->rows_in_tile ? left : l->rows_in_tile, what[k], error);
        }
    free_buffers(&b);
    return status;
}

enum tri_status lattice_hand_out(const struct lattice *l, const struct tri_sink *sink, struct tri_error *error)
{
    double *columns = malloc(LATTICE_REGIONS * ((size_t)l->n_columns + 1) * sizeof *columns);
    for (int32_t i = 0; i < LATTICE_REGIONS * l->n_columns; i++)
        columns[i] = lattice_column(l, i / l->n_columns, i % l->n_columns);
    const struct tri_stream stream = {.n_attributes = l->n_attributes, .n_columns = l->n_columns,
                                      .n_regions = LATTICE_REGIONS, .regions = columns,
                                      .estimate = (double)lattice_triangles(l), .n_ranks = 1};
    enum tri_status status = sink->begin ? sink->begin(sink->user, &stream, error) : TRI_OK;
    status = status ? status : hand_tiles(l, sink, error);
    free(columns);
    return status || !sink->end ? status : sink->end(sink->user, error);
}

/* --- as a grid */

static void point(const void *user, int64_t i, struct tri_grid_point *point)
{
    lattice_point(user, i, point->at);
    point->marker = lattice_point_marker(i);
}

static double attribute(const void *user, int64_t i, int32_t k)
{
    (void)user;
    return lattice_attribute(i, k);
}

static void triangle(const void *user, int64_t i, int64_t nodes[6]) { lattice_corners(user, i, nodes); }

static double column(const void *user, int64_t i, int32_t k) { return lattice_column(user, lattice_region(i), k); }

static void segment(const void *user, int64_t i, struct tri_grid_edge *segment)
{
    lattice_ends(user, i, segment->ends);
    segment->marker = lattice_segment_marker(i);
}

struct tri_grid lattice_grid(const struct lattice *l, bool markers)
{
    return (struct tri_grid){.user = l, .has_markers = markers, .n_points = lattice_points(l),
                             .n_triangles = lattice_triangles(l), .n_segments = lattice_segments(l),
                             .n_attributes = l->n_attributes, .n_columns = l->n_columns, .n_nodes = 3,
                             .point = point, .attribute = attribute, .triangle = triangle, .column = column,
                             .segment = segment};
}
