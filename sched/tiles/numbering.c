/* New numbers of vertices, subsegments and triangles; then all move.
 *
 * THEOREM. Each order is total: new vertices lie at different places; of the triangles that start at a corner each has
 * another second corner, since an edge has one triangle on its left; of the subsegments of a parent, which all run its
 * way, each starts at another vertex. So nothing is left to how the mesh came about.
 *
 * All memory is asked for before anything moves. A page that is touched for the first time costs as much as sorting
 * what is in it: so memory serves several times, and who works on tiles has one room for all of them. */
#include "sched/tiles/numbering.h"

#include <stdlib.h>
#include <string.h>

#include "sched/tiles/renumber.h"
#include "triangle/base/radix.h"
#include "triangle/geometry/hilbert.h"

/* --- vertices */

static int32_t find_tile(struct par_locator *last, const struct par_partition *p, struct tri_point q)
{
    return par_tile_of_block(p, par_locate(last, p, 0, q));
}

static void count_vertices(void *context, size_t share)
{
    const struct par_numbering *n = context;
    const struct tri_mesh *mesh = n->mesh;
    struct tri_range range = par_deal_share(&n->vertices, share);
    int32_t *count = par_deal_at(&n->vertices, share);
    struct par_locator finder = PAR_LOST;
    for (int32_t i = range.first; i < range.last; i++) {
        tri_vertex_id v = n->n_kept + i;
        n->tile_of[v] = TRI_NONE;
        if (mesh->on[v] != TRI_VERTEX_NONE)
            count[n->tile_of[v] = find_tile(&finder, n->partition, mesh->xy[v])]++;
    }
}

static void deal_vertices(void *context, size_t share)
{
    const struct par_numbering *n = context;
    struct tri_range range = par_deal_share(&n->vertices, share);
    int32_t *at = par_deal_at(&n->vertices, share);
    for (tri_vertex_id v = n->n_kept + range.first; v < n->n_kept + range.last; v++)
        if (n->tile_of[v] != TRI_NONE)
            n->order[at[n->tile_of[v]]++] = v;
}

static void number_tile(const void *context, size_t tile, uint64_t *room)
{
    const struct par_numbering *n = context;
    int32_t first = n->vertices.start[tile], end = n->vertices.start[tile + 1];
    tri_hilbert_order_coarse(n->mesh->xy, n->order + first, end - first, room);
    for (int32_t i = first; i < end; i++)
        n->number[n->order[i]] = n->n_kept + i;
}

static void find_kept(void *context, size_t share)
{
    const struct par_numbering *n = context;
    struct tri_range range = tri_share(share, n->n_kept);
    struct par_locator finder = PAR_LOST;
    for (tri_vertex_id v = range.first; v < range.last; v++) {
        n->number[v] = v;
        n->kept_tile[v] = find_tile(&finder, n->partition, n->mesh->xy[v]);
    }
}

static void number_vertices(struct par_numbering *n)
{
    tri_execute(n->executor, tri_shares(n->n_kept), find_kept, n);
    tri_execute(n->executor, n->vertices.shares, count_vertices, n);
    n->n_new = par_deal_add_up(&n->vertices);
    tri_execute(n->executor, n->vertices.shares, deal_vertices, n);
    par_deal_work(&n->vertices, n->executor, n->scratch, number_tile, n);
}

/* --- subsegments */

static void rename_subs(struct par_numbering *n)
{
    struct tri_mesh *mesh = n->mesh;
    for (tri_sub_id s = 0; s < mesh->n_subs; s++)
        for (int k = 0; k < 2 && mesh->sub[s].v[k] != TRI_NONE; k++)
            mesh->sub[s].v[k] = n->number[mesh->sub[s].v[k]];
}

static void sort_subs(const struct par_numbering *n, int32_t limit)
{
    uint64_t *item = n->scratch;
    tri_radix_sort(item, item + n->mesh->n_subs, n->n_subs, VALUE_BITS, VALUE_BITS + tri_bits_of(limit), n->executor);
}

static int32_t tile_of_sub(const struct par_numbering *n, const struct tri_subsegment *s)
{
    int32_t a = tile_of_number(n, s->v[0]), b = tile_of_number(n, s->v[1]);
    return a > b ? a : b;
}

/* By start, then, since sorting keeps the order of equals, by parent, then by tile. */
static void number_subs(struct par_numbering *n)
{
    const struct tri_mesh *mesh = n->mesh;
    uint64_t *item = n->scratch;
    for (tri_sub_id s = 0; s < mesh->n_subs; s++)
        if (mesh->sub[s].v[0] != TRI_NONE)
            item[n->n_subs++] = item_of(mesh->sub[s].v[0], s);
    sort_subs(n, mesh->n_vertices);
    for (int32_t i = 0; i < n->n_subs; i++) {
        tri_parent_id parent = mesh->sub[value_of(item[i])].parent;
        assert(parent >= 0 && parent < mesh->n_parents);
        item[i] = item_of(parent, value_of(item[i]));
    }
    sort_subs(n, mesh->n_parents);
    for (int32_t i = 0; i < n->n_subs; i++)
        item[i] = item_of(tile_of_sub(n, &mesh->sub[value_of(item[i])]), value_of(item[i]));
    sort_subs(n, n->n_tiles);
    for (int32_t i = 0; i < n->n_subs; i++)
        n->sub_number[value_of(item[i])] = i;
}

static void move_subs(struct par_numbering *n)
{
    struct tri_mesh *mesh = n->mesh;
    for (tri_sub_id s = 0; s < mesh->n_subs; s++) {
        if (mesh->sub[s].v[0] == TRI_NONE)
            continue;
        struct tri_subsegment *to = &n->sub[n->sub_number[s]];
        *to = mesh->sub[s];
        for (int side = 0; side < 2; side++)
            if (to->side[side] != TRI_NONE)
                to->side[side] = new_code(n->place, to->side[side]);
    }
    if (n->n_subs > 0)
        memcpy(mesh->sub, n->sub, (size_t)n->n_subs * sizeof *n->sub);
}

/* --- all of it */

static size_t most_bytes(size_t a, size_t b) { return a < b ? b : a; }

static size_t scratch_bytes(const struct tri_mesh *mesh, size_t vertices)
{
    const size_t two_items = 2 * sizeof(uint64_t);
    const size_t for_vertices = vertices * most_bytes(tri_vertex_size(mesh), two_items);
    const size_t for_subs = (size_t)mesh->n_subs * two_items;
    const size_t aside = ((size_t)mesh->n_triangles / 2 + 1) * sizeof(struct tri_triangle);
    return most_bytes(most_bytes(for_vertices, for_subs), most_bytes(par_sort_triangles_scratch(mesh), aside));
}

static enum tri_status allocate(struct par_numbering *n, struct tri_error *error)
{
    const struct tri_mesh *mesh = n->mesh;
    size_t vertices = (size_t)(mesh->n_vertices - n->n_kept), subs = (size_t)mesh->n_subs;
    bool deals = par_deal_reserve(&n->vertices, mesh->n_vertices - n->n_kept, n->n_tiles);
    deals = par_deal_reserve(&n->triangles, mesh->n_triangles, n->n_tiles) && deals;
    n->kept_tile = malloc(((size_t)n->n_kept + 1) * sizeof *n->kept_tile);
    n->batch = par_move_batch(mesh->n_triangles);
    n->order = tri_mesh_extra(mesh, most_bytes((vertices + 1) * sizeof *n->order,
                                               (size_t)n->batch * sizeof *n->buffer));
    n->number = tri_mesh_extra(mesh, ((size_t)mesh->n_vertices + 1) * sizeof *n->number);
    n->sub_number = tri_mesh_extra(mesh, (subs + 1) * sizeof *n->sub_number);
    n->sub = tri_mesh_extra(mesh, (subs + 1) * sizeof *n->sub);
    n->place = tri_mesh_extra(mesh, ((size_t)mesh->n_triangles + 1) * sizeof *n->place);
    n->dealt = tri_mesh_extra(mesh, ((size_t)mesh->n_triangles + 1) * sizeof *n->dealt);
    n->scratch = tri_mesh_extra(mesh, scratch_bytes(mesh, vertices));
    if (deals && n->kept_tile && n->order && n->number && n->sub_number && n->sub && n->place && n->dealt && n->scratch)
        return TRI_OK;
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for numbering %d triangles", (int)mesh->n_triangles);
}

/* Cannot fail. */
static void renumber(struct par_numbering *n)
{
    struct tri_mesh *mesh = n->mesh;
    number_vertices(n);
    tri_mesh_gather_vertices(mesh, n->n_kept, n->order, n->n_new, n->scratch, n->executor);
    rename_subs(n);
    number_subs(n);
    par_sort_triangles(n);
    par_move_triangles(n);
    move_subs(n);
    mesh->n_triangles = n->n_tri;
    mesh->n_subs = n->n_subs;
    mesh->n_vertices = n->n_kept + n->n_new;
}

static void free_numbering(struct par_numbering *n)
{
    par_deal_free(&n->vertices);
    par_deal_free(&n->triangles);
    free(n->kept_tile);
    tri_mesh_extra_free(n->mesh, n->order);
    tri_mesh_extra_free(n->mesh, n->number);
    tri_mesh_extra_free(n->mesh, n->sub_number);
    tri_mesh_extra_free(n->mesh, n->sub);
    tri_mesh_extra_free(n->mesh, n->place);
    tri_mesh_extra_free(n->mesh, n->dealt);
    tri_mesh_extra_free(n->mesh, n->scratch);
}

enum tri_status par_number(struct tri_mesh *mesh, const struct par_partition *partition, int32_t n_kept,
                           const struct tri_executor *executor, struct tri_error *error)
{
    assert(mesh->incidence.n_vertices <= n_kept && n_kept <= mesh->n_vertices);
    struct par_numbering n = {.mesh = mesh, .partition = partition, .executor = executor, .n_kept = n_kept,
                          .n_tiles = par_tile_columns(partition) * par_tile_rows(partition)};
    enum tri_status status = tri_stop_is_asked(mesh->stop) ? tri_fail_stopped(error) : allocate(&n, error);
    if (!status)
        renumber(&n);
    assert(status || tri_mesh_is_sound(mesh));
    free_numbering(&n);
    return status;
}
