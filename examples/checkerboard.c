/* checkerboard: an example of a gate. Refines the cells of a checkerboard, first the black ones, then the white ones,
 * with tri_mesh_refine of ptriangle/tri.h.
 *
 * The gate is called for each bad triangle, with the point that would remove it. If it returns false, the triangle is
 * deferred, and the next call finds it again. So you can write your own schedule with the public header alone. The gate
 * decides where points are inserted, not which triangles change. A cavity may reach across the border of a cell by one
 * or two triangles, and a segment that a new point would encroach is split wherever it lies. To confine changes as
 * well, set a fence.
 *
 * Usage: checkerboard [CELLS [MAX_AREA]]. Exit code 0: at the end all triangles satisfy the bounds. */
#include <stdio.h>
#include <stdlib.h>

#include "ptriangle/tri.h"

enum colour { BLACK, WHITE };

/* A unit square of cells x cells. The gate allows points in cells of one colour. */
struct board {
    int cells;
    enum colour open;
};

static enum colour colour_at(const struct board *board, const double p[2])
{
    int column = (int)(p[0] * board->cells), row = (int)(p[1] * board->cells);
    return (column + row) % 2 ? WHITE : BLACK;
}

/* The gate. user: the board. */
static bool is_open(void *user, const double p[2])
{
    const struct board *board = user;
    return colour_at(board, p) == board->open;
}

/* The unit square as plain arrays. */
static enum tri_status make_square(struct tri_mesh **mesh, struct tri_error *error)
{
    const double points[8] = {0, 0, 1, 0, 1, 1, 0, 1};
    const int32_t segments[8] = {0, 1, 1, 2, 2, 3, 3, 0};
    struct tri_figure square = tri_no_figure();
    square.points = tri_reals_of(points, 4, 2);
    square.segments = tri_ints_of(segments, 4, 2);
    return tri_mesh_new(mesh, &square, NULL, error);
}

/* Counts triangles by the colour of the cell that contains their centroid. */
static void count_colours(const struct tri_mesh *mesh, const struct board *board, long count[2])
{
    struct tri_reals points = tri_mesh_points(mesh);
    struct tri_ints triangles = tri_mesh_triangles(mesh);
    count[BLACK] = count[WHITE] = 0;
    for (int64_t t = 0; t < triangles.n; t++) {
        const int32_t *corner = triangles.at + t * triangles.stride;
        double centroid[2] = {0, 0};
        for (int k = 0; k < 3; k++) {
            const double *p = points.at + corner[k] * points.stride;
            centroid[0] += p[0] / 3;
            centroid[1] += p[1] / 3;
        }
        count[colour_at(board, centroid)]++;
    }
}

/* Refines once and prints the result. *bad: number of triangles that still violate the bounds. */
static enum tri_status refine(const char *what, struct tri_mesh *mesh, const struct tri_settings *settings,
                              const struct board *board, int64_t *bad, struct tri_error *error)
{
    long count[2];
    enum tri_status status = tri_mesh_refine(mesh, settings, error);
    if (status)
        return status;
    *bad = tri_mesh_count_bad(mesh, settings, NULL, 0);
    count_colours(mesh, board, count);
    int64_t inserted = tri_mesh_count(mesh, TRI_COUNT_NEW_POINTS) +
                       tri_mesh_count(mesh, TRI_COUNT_NEW_POINTS_ON_SEGMENTS);
    printf("%-14s %8lld points inserted, %8lld times refused; ", what, (long long)inserted,
           (long long)tri_mesh_count(mesh, TRI_COUNT_GATED));
    printf("triangles: %8ld in black cells, %8ld in white, %8lld bad\n", count[BLACK], count[WHITE], (long long)*bad);
    return TRI_OK;
}

static enum tri_status play(struct tri_mesh *mesh, struct board *board, double max_area, int64_t *bad,
                            struct tri_error *error)
{
    struct tri_settings settings = tri_no_settings();
    settings.min_angle = 30;
    /* First makes a coarse mesh everywhere, because a triangle larger than a cell belongs to no cell. */
    settings.max_area = 0.1 / ((double)board->cells * board->cells);
    enum tri_status status = refine("coarse", mesh, &settings, board, bad, error);
    settings.max_area = max_area;
    settings.gate = is_open;
    settings.gate_user = board;
    board->open = BLACK;
    status = status ? status : refine("black cells", mesh, &settings, board, bad, error);
    board->open = WHITE;
    status = status ? status : refine("white cells", mesh, &settings, board, bad, error);
    settings.gate = NULL; /* black triangles that became bad while the white cells were refined */
    return status ? status : refine("without gate", mesh, &settings, board, bad, error);
}

int main(int argc, char **argv)
{
    struct board board = {argc > 1 ? atoi(argv[1]) : 8, BLACK};
    double max_area = argc > 2 ? atof(argv[2]) : 1e-5;
    struct tri_mesh *mesh = NULL;
    struct tri_error error;
    int64_t bad = 0;
    if (argc > 3 || board.cells < 1 || board.cells > 1000 || !(max_area > 0)) {
        fprintf(stderr, "Usage: checkerboard [CELLS [MAX_AREA]]\n");
        return 2;
    }
    enum tri_status status = make_square(&mesh, &error);
    status = status ? status : play(mesh, &board, max_area, &bad, &error);
    if (status)
        fprintf(stderr, "checkerboard: %s\n", error.text);
    tri_mesh_delete(mesh);
    return status || bad ? 1 : 0;
}
