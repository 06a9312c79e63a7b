/* A mesh as those see it who hand it out, to files or to a caller's arrays: how many of everything there are, and each
 * item by its number, counted from 0.
 *
 * Points are the vertices of the mesh that are handed out, in their order, then, for second-order triangles, the nodes
 * amid the edges. Nothing is copied: an item is worked out when it is asked for, by any thread, in any order. So
 * whoever has a mesh in another form can offer a grid of it, too. */
#ifndef TRIANGLE_MESH_GRID_H
#define TRIANGLE_MESH_GRID_H

#include "triangle/mesh/mesh.h"

struct tri_grid_point {
    double at[2]; /* the caller's coordinates */
    int32_t marker;
};

struct tri_grid_edge {
    int64_t ends[2];     /* ends[1] == -1: a ray */
    int32_t marker;
    double direction[2]; /* of a ray; else 0, 0 */
};

struct tri_grid {
    const void *user;
    int32_t base;         /* 0 or 1: what numbers count from where they are shown */
    bool has_markers;
    int64_t n_points, n_triangles, n_segments, n_edges;
    int32_t n_attributes; /* of a point */
    int32_t n_columns;    /* attributes of a triangle */
    int n_nodes;          /* of a triangle: 3, or 6: behind the corners the nodes amid the edges opposite to them */
    const struct tri_pslg *figure; /* holes and regions that go with it; NULL: none */
    const struct tri_storage *storage; /* whose extras take what grows with the mesh beside it; NULL: malloc */
    void (*point)(const void *user, int64_t i, struct tri_grid_point *point);
    double (*attribute)(const void *user, int64_t i, int32_t k);
    void (*triangle)(const void *user, int64_t i, int64_t nodes[6]);
    double (*column)(const void *user, int64_t i, int32_t k);
    void (*neighbors)(const void *user, int64_t i, int64_t neighbors[3]); /* opposite each corner; -1: none */
    void (*segment)(const void *user, int64_t i, struct tri_grid_edge *segment);
    void (*edge)(const void *user, int64_t i, struct tri_grid_edge *edge);
};

enum { TRI_GRID_ROUNDS = 1 << 15 };

/* What has been used of the mesh and of extras need not stay in memory: to be said every TRI_GRID_ROUNDS items where
 * the grid is not asked for each in order. pass: in round i of such a loop. */
static inline void tri_grid_let_go(const struct tri_grid *grid)
{
    if (grid->storage && grid->storage->let_go)
        grid->storage->let_go(grid->storage->user);
}

static inline void tri_grid_pass(const struct tri_grid *grid, int64_t i)
{
    if (i % TRI_GRID_ROUNDS == 0)
        tri_grid_let_go(grid);
}

/* What of a mesh is handed out. All borrowed, as long as the grid lives.
 *
 * Input points come from the PSLG, since they are handed out bit by bit as they came: in the mesh coordinates smaller
 * than 2^-216 units have been rounded (tri_mesh_take_points). All other points come from the mesh. The public arrays
 * (triangle/api/arrays.c) give all points as the mesh has them, for no input lies behind them; the two differ in such
 * tiny coordinates alone. */
struct tri_grid_options {
    const struct tri_mesh *mesh;         /* without free numbers */
    const struct tri_pslg *pslg;         /* the input: its points are handed out bit by bit as they came */
    const struct tri_elements *elements; /* the triangles that the mesh was rebuilt from; NULL: none */
    const bool *is_edge; /* [pslg->n_segments] those that are not become segments behind the mesh's; NULL: none */
    int32_t base;
    bool markers;
    bool regions;        /* without elements: the attribute of each triangle's region is a column */
    bool jettison;       /* vertices that are no corners are left out (see tri_kept_make) */
    bool second_order;
    bool edges;          /* edges will be asked for; their number is known in any case */
};

/* TRI_NO_MEMORY. O(vertices + triangles); what tri_kept_make and tri_edge_list_make need, where that is asked for. */
enum tri_status tri_grid_make(struct tri_grid *grid, const struct tri_grid_options *options, struct tri_error *error);
void tri_grid_free(struct tri_grid *grid);

/* The Voronoi diagram as a grid of points and edges, rays included, without markers: point t is the circumcentre of
 * triangle t, edge i is dual to edge i. Valid as long as `grid`, which was made with edges; not to be freed. */
struct tri_grid tri_grid_voronoi(const struct tri_grid *grid);

#endif
