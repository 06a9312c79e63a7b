/* Sorts the input points along a Hilbert curve, and restores their order.
 *
 * INVARIANT: origin is a permutation of 0 .. n_input - 1, and place is its inverse. Only input vertices move, so
 * references to vertices at or above n_input stay unchanged. */
#include "triangle/cdt/spatial.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/geometry/hilbert.h"
#include "triangle/mesh/parents.h"

static void *allocate_array(int32_t n, size_t item) { return malloc(((size_t)n + 1) * item); }

/* Allocates scratch memory for sorting points (16 bytes each) and for moving them. */
static void *scratch_for(const struct tri_mesh *mesh)
{
    _Static_assert(sizeof(struct tri_point) >= 2 * sizeof(uint64_t), "room to sort and to move");
    return allocate_array(mesh->n_input, tri_vertex_size(mesh));
}

static enum tri_status no_memory(const struct tri_mesh *mesh, struct tri_error *error)
{
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for sorting %d points", (int)mesh->n_input);
}

/* Returns the inverse of a permutation, from malloc; NULL: out of memory. */
static int32_t *inverse_of(const int32_t *order, int32_t n)
{
    int32_t *place = allocate_array(n, sizeof *place);
    for (tri_vertex_id v = 0; place && v < n; v++)
        place[order[v]] = v;
    return place;
}

enum tri_status tri_sort_points(struct tri_mesh *mesh, int32_t **place, const struct tri_executor *executor,
                                struct tri_error *error)
{
    int32_t n = mesh->n_input, *origin = allocate_array(n, sizeof *origin);
    void *scratch = scratch_for(mesh);
    assert(mesh->n_vertices == n && mesh->n_triangles == 0 && !mesh->origin && !mesh->twin);
    if (origin && scratch) {
        for (tri_vertex_id v = 0; v < n; v++)
            origin[v] = v;
        tri_hilbert_order(mesh->xy, origin, n, scratch, executor);
    }
    *place = origin && scratch ? inverse_of(origin, n) : NULL;
    if (*place) {
        tri_mesh_gather_vertices(mesh, 0, origin, n, scratch, executor);
        mesh->origin = origin;
    } else {
        free(origin);
    }
    free(scratch);
    return *place ? TRI_OK : no_memory(mesh, error);
}

/* --- restoring the order */

static inline unsigned is_callers(const struct tri_mesh *mesh, tri_vertex_id v)
{
    return (uint32_t)v < (uint32_t)mesh->n_input;
}

/* Returns the input number of v. Loads mesh->origin in all cases, so that no branch is needed. */
static inline tri_vertex_id restored_number(const struct tri_mesh *mesh, tri_vertex_id v)
{
    tri_vertex_id name = mesh->origin[is_callers(mesh, v) ? v : 0];
    return is_callers(mesh, v) ? name : v;
}

/* Tests the three corners together: if every third vertex is an input vertex, single tests would be unpredictable
 * branches. */
static void restore_corners(void *context, size_t share)
{
    const struct tri_mesh *mesh = context;
    struct tri_range range = tri_share(share, mesh->n_triangles);
    for (tri_triangle_id t = range.first; t < range.last; t++) {
        tri_vertex_id *v = mesh->tri[t].v;
        if (!(is_callers(mesh, v[0]) | is_callers(mesh, v[1]) | is_callers(mesh, v[2])))
            continue;
        for (int k = 0; k < 3; k++)
            v[k] = restored_number(mesh, v[k]);
    }
}

static void restore_ends(const struct tri_mesh *mesh)
{
    for (tri_sub_id s = 0; s < mesh->n_subs; s++)
        for (int k = 0; k < 2; k++)
            mesh->sub[s].v[k] = restored_number(mesh, mesh->sub[s].v[k]);
    for (int32_t p = 0; p < mesh->n_parents; p++)
        for (int k = 0; k < 2; k++)
            mesh->parents[p].v[k] = restored_number(mesh, mesh->parents[p].v[k]);
}

/* Converts twins to input numbers: twin[input index] = input index of the first point at the same place. */
static void restore_twins(struct tri_mesh *mesh, int32_t *twin)
{
    for (tri_vertex_id v = 0; v < mesh->n_input; v++)
        twin[mesh->origin[v]] = mesh->origin[mesh->twin[v]];
    free(mesh->twin);
    mesh->twin = twin;
}

enum tri_status tri_restore_points(struct tri_mesh *mesh, const struct tri_executor *executor,
                                   struct tri_error *error)
{
    int32_t n = mesh->n_input;
    if (!mesh->origin)
        return TRI_OK;
    int32_t *place = inverse_of(mesh->origin, n), *twin = mesh->twin ? allocate_array(n, sizeof *twin) : NULL;
    void *scratch = scratch_for(mesh);
    if (!place || !scratch || (mesh->twin && !twin)) {
        free(place);
        free(twin);
        free(scratch);
        return no_memory(mesh, error);
    }
    tri_mesh_gather_vertices(mesh, 0, place, n, scratch, executor);
    free(place);
    free(scratch);
    if (twin)
        restore_twins(mesh, twin);
    tri_execute(executor, tri_shares(mesh->n_triangles), restore_corners, mesh);
    restore_ends(mesh);
    free(mesh->origin);
    mesh->origin = NULL;
    if (mesh->incidence.n_vertices > 0)
        tri_incidence_fill(mesh);
    return TRI_OK;
}
