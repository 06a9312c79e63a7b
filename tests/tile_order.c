/* Neighbours in the arrays are compared by keys. Positions along a curve are sorted by the sort that has its own
   test. */
#include "tile_order.h"

#include "support.h"
#include "triangle/geometry/hilbert.h"

static int64_t tile_of(const struct tri_mesh *mesh, const struct par_partition *partition, const int32_t *v, int n)
{
    int64_t last = -1;
    for (int k = 0; k < n; k++) {
        int32_t tile = par_block_at(partition, 0, mesh->xy[v[k]]);
        last = tile > last ? tile : last;
    }
    return last;
}

static void assert_before(const int64_t a[3], const int64_t b[3])
{
    int k = 0;
    while (k < 2 && a[k] == b[k])
        k++;
    assert_true(a[k] < b[k]);
}

/* Vertices first .. end - 1 belong to one tile. */
static void assert_along_a_curve(const struct tri_mesh *mesh, int32_t first, int32_t end)
{
    size_t n = (size_t)(end - first);
    int32_t *order = malloc((n + 1) * sizeof *order);
    uint64_t *scratch = malloc((2 * n + 1) * sizeof *scratch);
    assert_true(order && scratch);
    for (size_t i = 0; i < n; i++) /* reversed, so that the sort has work to do */
        order[i] = end - 1 - (int32_t)i;
    tri_hilbert_order_coarse(mesh->xy, order, (int32_t)n, scratch);
    for (size_t i = 0; i < n; i++)
        assert_int_equal(order[i], first + (int32_t)i);
    free(order);
    free(scratch);
}

static void assert_vertices_in_order(const struct tri_mesh *mesh, const struct par_partition *p, int32_t n_kept)
{
    for (int32_t first = n_kept, end; first < mesh->n_vertices; first = end) {
        int64_t tile = tile_of(mesh, p, &first, 1);
        for (end = first + 1; end < mesh->n_vertices && tile_of(mesh, p, &end, 1) == tile;)
            end++;
        assert_true(end == mesh->n_vertices || tile_of(mesh, p, &end, 1) > tile);
        assert_along_a_curve(mesh, first, end);
    }
}

void assert_in_order(const struct tri_mesh *mesh, const struct par_partition *partition, int32_t n_kept)
{
    int64_t before[3] = {-1, -1, -1};
    assert_vertices_in_order(mesh, partition, n_kept);
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        const int32_t *v = mesh->tri[t].v;
        const int64_t key[3] = {tile_of(mesh, partition, v, 3), v[0], v[1]};
        assert_true(v[0] > v[1] && v[0] > v[2]);
        assert_before(before, key);
        memcpy(before, key, sizeof before);
    }
    before[0] = -1;
    for (int32_t s = 0; s < mesh->n_subs; s++) {
        const struct tri_subsegment *sub = &mesh->sub[s];
        const int64_t key[3] = {tile_of(mesh, partition, sub->v, 2), sub->parent, sub->v[0]};
        assert_before(before, key);
        memcpy(before, key, sizeof before);
    }
}
