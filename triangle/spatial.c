/* The two permutations of the caller's points.
 *
 * INVARIANT: origin is a permutation of 0 .. n_input - 1; rank is its inverse. Only input vertices move, so whatever
 * names a vertex at or above n_input stays as it is. */
#include "triangle/spatial.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/hilbert.h"
#include "triangle/small_angle.h"

/* Vertex arrays with the first n items in another order. */
struct reordered {
    struct tri_point *xy;
    int32_t *on, *markers;
    int32_t *twin; /* only where the mesh has it */
    double *attributes;
};

static void *array(int32_t n, size_t item) { return malloc(((size_t)n + 1) * item); }

static void free_reordered(struct reordered *r)
{
    free(r->xy);
    free(r->on);
    free(r->markers);
    free(r->twin);
    free(r->attributes);
    *r = (struct reordered){0};
}

static bool allocate(struct reordered *r, const struct tri_mesh *mesh)
{
    int32_t n = mesh->n_input;
    *r = (struct reordered){array(n, sizeof *r->xy), array(n, sizeof *r->on), array(n, sizeof *r->markers),
                            mesh->twin ? array(n, sizeof *r->twin) : NULL,
                            array(n, (size_t)mesh->n_attributes * sizeof *r->attributes + 1)};
    if (r->xy && r->on && r->markers && (r->twin || !mesh->twin) && r->attributes)
        return true;
    free_reordered(r);
    return false;
}

static enum tri_status no_memory(const struct tri_mesh *mesh, struct tri_error *error)
{
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for sorting %d points", (int)mesh->n_input);
}

static void copy_back(struct tri_mesh *mesh, const struct reordered *r)
{
    size_t n = (size_t)mesh->n_input;
    if (n == 0)
        return;
    memcpy(mesh->xy, r->xy, n * sizeof *r->xy);
    memcpy(mesh->on, r->on, n * sizeof *r->on);
    memcpy(mesh->vertex_markers, r->markers, n * sizeof *r->markers);
    if (mesh->n_attributes)
        memcpy(mesh->attributes, r->attributes, n * (size_t)mesh->n_attributes * sizeof *r->attributes);
}

static void move_vertex(const struct tri_mesh *mesh, const struct reordered *r, int32_t from, int32_t to)
{
    size_t width = (size_t)mesh->n_attributes;
    r->xy[to] = mesh->xy[from];
    r->on[to] = mesh->on[from];
    r->markers[to] = mesh->vertex_markers[from];
    if (width)
        memcpy(r->attributes + (size_t)to * width, mesh->attributes + (size_t)from * width,
               width * sizeof *r->attributes);
}

enum tri_status tri_sort_points(struct tri_mesh *mesh, int32_t **rank, const struct tri_executor *executor,
                                struct tri_error *error)
{
    int32_t n = mesh->n_input, *origin = array(n, sizeof *origin);
    struct reordered sorted = {0};
    assert(mesh->n_vertices == n && mesh->n_slots == 0 && !mesh->origin && !mesh->twin);
    *rank = array(n, sizeof **rank);
    enum tri_status status = TRI_OK;
    if (!origin || !*rank || !allocate(&sorted, mesh))
        status = no_memory(mesh, error);
    status = status ? status : tri_hilbert_order(mesh->xy, n, origin, executor, error);
    if (status) {
        free_reordered(&sorted);
        free(origin);
        free(*rank);
        *rank = NULL;
        return status;
    }
    for (int32_t v = 0; v < n; v++) {
        (*rank)[origin[v]] = v;
        move_vertex(mesh, &sorted, origin[v], v);
    }
    copy_back(mesh, &sorted);
    free_reordered(&sorted);
    mesh->origin = origin;
    return TRI_OK;
}

/* --- and back */

struct restoration {
    struct tri_mesh *mesh;
    const struct reordered *to;
};

static void restore_vertices(void *context, size_t share)
{
    const struct restoration *r = context;
    const struct tri_mesh *mesh = r->mesh;
    struct tri_range range = tri_share(share, mesh->n_input);
    for (int32_t v = range.first; v < range.last; v++) {
        move_vertex(mesh, r->to, v, mesh->origin[v]);
        if (mesh->twin)
            r->to->twin[mesh->origin[v]] = mesh->origin[mesh->twin[v]];
    }
}

static void restore_name(const struct tri_mesh *mesh, int32_t *v)
{
    if (*v >= 0 && *v < mesh->n_input)
        *v = mesh->origin[*v];
}

static void restore_corners(void *context, size_t share)
{
    const struct restoration *r = context;
    const struct tri_mesh *mesh = r->mesh;
    struct tri_range range = tri_share(share, mesh->n_slots);
    for (int32_t t = range.first; t < range.last; t++)
        for (int k = 0; k < 3; k++)
            restore_name(mesh, &mesh->tri[t].v[k]);
}

static void restore_ends(const struct tri_mesh *mesh)
{
    for (int32_t s = 0; s < mesh->n_subs; s++)
        for (int k = 0; k < 2; k++)
            restore_name(mesh, &mesh->sub[s].v[k]);
    for (int32_t p = 0; p < mesh->n_parents; p++)
        for (int k = 0; k < 2; k++)
            restore_name(mesh, &mesh->parents[p].v[k]);
}

enum tri_status tri_restore_points(struct tri_mesh *mesh, const struct tri_executor *executor,
                                   struct tri_error *error)
{
    struct reordered own;
    struct restoration r = {mesh, &own};
    if (!mesh->origin)
        return TRI_OK;
    if (!allocate(&own, mesh))
        return no_memory(mesh, error);
    tri_execute(executor, tri_shares(mesh->n_input), restore_vertices, &r);
    tri_execute(executor, tri_shares(mesh->n_slots), restore_corners, &r);
    restore_ends(mesh);
    copy_back(mesh, &own);
    if (mesh->twin)
        memcpy(mesh->twin, own.twin, (size_t)mesh->n_input * sizeof *mesh->twin);
    free_reordered(&own);
    free(mesh->origin);
    mesh->origin = NULL;
    if (mesh->n_hubs > 0)
        tri_fill_spokes(mesh);
    return TRI_OK;
}
