#include "tests/array_grid.h"

static void point(const void *user, int64_t i, struct tri_grid_point *point)
{
    const struct array_grid *a = user;
    *point = (struct tri_grid_point){{a->points[2 * i], a->points[2 * i + 1]}, a->markers ? a->markers[i] : 0};
}

static double attribute(const void *user, int64_t i, int32_t k)
{
    const struct array_grid *a = user;
    return a->attributes[i * a->grid.n_attributes + k];
}

static void triangle(const void *user, int64_t i, int64_t nodes[6])
{
    const struct array_grid *a = user;
    for (int k = 0; k < a->grid.n_nodes; k++)
        nodes[k] = a->nodes[i * a->grid.n_nodes + k];
}

static double column(const void *user, int64_t i, int32_t k)
{
    const struct array_grid *a = user;
    return a->columns[i * a->grid.n_columns + k];
}

static void neighbors(const void *user, int64_t i, int64_t neighbors[3])
{
    const struct array_grid *a = user;
    for (int k = 0; k < 3; k++)
        neighbors[k] = a->neighbors[3 * i + k];
}

static void segment(const void *user, int64_t i, struct tri_grid_edge *segment)
{
    const struct array_grid *a = user;
    *segment = (struct tri_grid_edge){{a->segments[2 * i], a->segments[2 * i + 1]},
                                      a->segment_markers ? a->segment_markers[i] : 0, {0}};
}

static void edge(const void *user, int64_t i, struct tri_grid_edge *edge)
{
    const struct array_grid *a = user;
    *edge = (struct tri_grid_edge){{a->ends[2 * i], a->ends[2 * i + 1]}, a->markers ? a->markers[i] : 0, {0}};
    for (int k = 0; a->directions && k < 2; k++)
        edge->direction[k] = a->directions[2 * i + k];
}

const struct tri_grid *array_grid(struct array_grid *arrays)
{
    struct tri_grid *grid = &arrays->grid;
    grid->user = arrays;
    grid->point = point;
    grid->attribute = attribute;
    grid->triangle = triangle;
    grid->column = column;
    grid->neighbors = neighbors;
    grid->segment = segment;
    grid->edge = edge;
    return grid;
}

struct array_grid array_grid_of_points(int32_t base, int64_t n, const double *points)
{
    return (struct array_grid){.points = points, .grid = {.base = base, .n_points = n}};
}
