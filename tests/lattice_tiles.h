/* A lattice mesh that is handed out as tiles, for the tests of sinks. */
#ifndef TESTS_LATTICE_TILES_H
#define TESTS_LATTICE_TILES_H

#include "ptriangle/tiles.h"
#include "triangle/mesh/grid.h"

/* side * side points at integer coordinates; each square is cut into two triangles. The points of the lowest row count
 * as input vertices. A tile is one row of squares or a few rows. All values are computed from the item's number. */
struct lattice {
    int32_t side;          /* >= 2 */
    int32_t rows_in_tile;  /* >= 1 */
    int32_t n_attributes, n_columns;
    bool whole;            /* attributes of triangles are integers */
    bool one_by_one;       /* each tile has one kind of item: first points, then triangles, then segments */
};

enum { LATTICE_REGIONS = 3 };

int64_t lattice_points(const struct lattice *lattice);
int64_t lattice_triangles(const struct lattice *lattice);
int64_t lattice_segments(const struct lattice *lattice); /* the vertical sides of the squares */

void lattice_point(const struct lattice *lattice, int64_t i, double at[2]);
int32_t lattice_point_marker(int64_t i);
double lattice_attribute(int64_t i, int32_t k);
void lattice_corners(const struct lattice *lattice, int64_t i, int64_t corners[3]);
int32_t lattice_region(int64_t i);
double lattice_column(const struct lattice *lattice, int32_t region, int32_t k);
void lattice_ends(const struct lattice *lattice, int64_t i, int64_t ends[2]);
int32_t lattice_segment_marker(int64_t i);

/* The same mesh as a grid, valid as long as the lattice. Numbers start at 0. */
struct tri_grid lattice_grid(const struct lattice *lattice, bool markers);

/* Hands out everything until a call fails, and returns the status of the last call. */
enum tri_status lattice_hand_out(const struct lattice *lattice, const struct tri_sink *sink, struct tri_error *error);

#endif
