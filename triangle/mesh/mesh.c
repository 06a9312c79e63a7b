/* Storage of the mesh: growth, links, reordering, compaction, and validation.
 *
 * Arrays grow by half, or by less if memory is bounded. They grow in the mesh's storage or by realloc. For large arrays
 * the C library remaps pages instead of copying bytes, so the peak stays near the memory in use. The triangle array is
 * aligned to a cache line, so that no triangle straddles two lines. */
#include "triangle/mesh/mesh.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/grow.h"
#include "triangle/mesh/surface.h"

enum { LINE = 64 };

_Static_assert(sizeof(struct tri_triangle) == 32, "two triangles fill a cache line");

/* A pointer to the allocated block is stored just before the aligned array. */
static void *raw_of(void *aligned)
{
    void *raw = NULL;
    if (aligned)
        memcpy(&raw, (char *)aligned - sizeof raw, sizeof raw);
    return raw;
}

static void *grow_aligned(void *old, size_t used, size_t bytes)
{
    void *raw = raw_of(old);
    size_t offset = old ? (size_t)((char *)old - (char *)raw) : 0;
    char *block = realloc(raw, bytes + 2 * LINE);
    if (!block)
        return NULL;
    uintptr_t start = (uintptr_t)block + sizeof(void *) + LINE - 1;
    char *aligned = block + ((start & ~(uintptr_t)(LINE - 1)) - (uintptr_t)block);
    if (old && (size_t)(aligned - block) != offset)
        memmove(aligned, block + offset, used);
    void *self = block;
    memcpy(aligned - sizeof self, &self, sizeof self);
    return aligned;
}

/* Returns the new capacity for `need` items: half more than the current capacity or, if `tight`, a sixteenth more than
 * needed; at least 64. Returns 0 if `need` is above the limit. */
static int32_t next_capacity(int32_t capacity, int64_t need, int32_t limit, bool tight)
{
    if (need > limit)
        return 0;
    int64_t wanted = tight ? need + need / 16 : capacity + (int64_t)capacity / 2;
    wanted = wanted < need ? need : wanted;
    wanted = wanted < 64 ? 64 : wanted;
    return (int32_t)(wanted > limit ? limit : wanted);
}

/* One of the arrays that grow with refinement. */
struct array {
    void *at;
    size_t item; /* bytes per item */
    int32_t n, capacity;
};

static struct array array_of(const struct tri_mesh *m, enum tri_array which)
{
    size_t attributes = (size_t)m->n_attributes * sizeof *m->attributes;
    switch (which) {
    case TRI_XY: return (struct array){m->xy, sizeof *m->xy, m->n_vertices, m->vertex_capacity};
    case TRI_ON: return (struct array){m->on, sizeof *m->on, m->n_vertices, m->vertex_capacity};
    case TRI_MARKERS:
        return (struct array){m->vertex_markers, sizeof *m->vertex_markers, m->n_vertices, m->vertex_capacity};
    case TRI_FEATURE: return (struct array){m->feature, sizeof *m->feature, m->n_vertices, m->vertex_capacity};
    case TRI_LENGTH:
        return (struct array){m->length, m->has_lengths ? sizeof *m->length : 0, m->n_vertices, m->vertex_capacity};
    case TRI_ATTRIBUTES: return (struct array){m->attributes, attributes, m->n_vertices, m->vertex_capacity};
    case TRI_TRIANGLES: return (struct array){m->tri, sizeof *m->tri, m->n_triangles, m->triangle_capacity};
    default: return (struct array){m->sub, sizeof *m->sub, m->n_subs, m->sub_capacity};
    }
}

static void set_array(struct tri_mesh *m, enum tri_array which, void *at)
{
    switch (which) {
    case TRI_XY: m->xy = at; break;
    case TRI_ON: m->on = at; break;
    case TRI_MARKERS: m->vertex_markers = at; break;
    case TRI_FEATURE: m->feature = at; break;
    case TRI_LENGTH: m->length = at; break;
    case TRI_ATTRIBUTES: m->attributes = at; break;
    case TRI_TRIANGLES: m->tri = at; break;
    default: m->sub = at;
    }
}

static void *reserve(const struct tri_storage *storage, enum tri_array which, const struct array *a, int32_t capacity)
{
    size_t bytes = (size_t)capacity * a->item;
    if (storage)
        return storage->reserve(storage->user, which, bytes);
    return which == TRI_TRIANGLES ? grow_aligned(a->at, (size_t)a->n * a->item, bytes) : realloc(a->at, bytes);
}

static bool grow_array(struct tri_mesh *mesh, enum tri_array which, int32_t capacity)
{
    struct array a = array_of(mesh, which);
    void *fresh = a.item > 0 ? reserve(mesh->storage, which, &a, capacity) : NULL;
    if (fresh)
        set_array(mesh, which, fresh);
    return fresh || a.item == 0;
}

/* Returns the bytes allocated for the arrays that grow with refinement. */
static size_t bytes_reserved(const struct tri_mesh *mesh)
{
    size_t bytes = 0;
    for (enum tri_array which = TRI_XY; which < TRI_ARRAYS; which++)
        bytes += (size_t)array_of(mesh, which).capacity * array_of(mesh, which).item;
    return bytes;
}

size_t tri_mesh_bytes_used(const struct tri_mesh *mesh)
{
    size_t bytes = 0;
    for (enum tri_array which = TRI_XY; which < TRI_ARRAYS; which++)
        bytes += (size_t)array_of(mesh, which).n * array_of(mesh, which).item;
    return bytes;
}

static enum tri_status no_memory(struct tri_error *error, const char *what, int32_t count)
{
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for %d %s", (int)count, what);
}

static enum tri_status too_large(struct tri_error *error, const char *what)
{
    return tri_fail(error, TRI_TOO_LARGE, NULL, 0, "too many %s for one mesh", what);
}

enum tri_status tri_mesh_init(struct tri_mesh *mesh, struct tri_error *error)
{
    *mesh = (struct tri_mesh){0};
    mesh->regions = calloc(1, sizeof *mesh->regions);
    if (!mesh->regions)
        return no_memory(error, "regions", 1);
    mesh->n_regions = 1;
    mesh->unit = 1;
    return TRI_OK;
}

void *tri_mesh_extra(const struct tri_mesh *mesh, size_t bytes)
{
    return mesh->storage ? mesh->storage->extra(mesh->storage->user, bytes) : malloc(bytes);
}

void tri_mesh_extra_free(const struct tri_mesh *mesh, void *extra)
{
    if (mesh->storage)
        mesh->storage->extra_free(mesh->storage->user, extra);
    else
        free(extra);
}

void tri_mesh_drop(struct tri_mesh *mesh)
{
    for (enum tri_array which = TRI_XY; which < TRI_ARRAYS; which++) {
        void *at = array_of(mesh, which).at;
        if (!mesh->storage)
            free(which == TRI_TRIANGLES ? raw_of(at) : at);
        set_array(mesh, which, NULL);
    }
    mesh->storage = NULL;
    mesh->n_vertices = mesh->vertex_capacity = 0;
    mesh->n_triangles = mesh->triangle_capacity = 0;
    mesh->n_subs = mesh->sub_capacity = 0;
    free(mesh->origin);
    free(mesh->twin);
    mesh->origin = mesh->twin = NULL;
    mesh->n_input = 0;
}

void tri_mesh_free(struct tri_mesh *mesh)
{
    tri_mesh_drop(mesh);
    tri_surface_free(mesh->surface);
    free(mesh->parents);
    free(mesh->incidence.start);
    free(mesh->incidence.parent);
    free(mesh->regions);
    free(mesh->columns);
    *mesh = (struct tri_mesh){0};
}

/* Copies counts and capacities from one mesh to another. */
static void copy_counts(struct tri_mesh *to, const struct tri_mesh *from)
{
    to->n_vertices = from->n_vertices;
    to->vertex_capacity = from->vertex_capacity;
    to->n_triangles = from->n_triangles;
    to->triangle_capacity = from->triangle_capacity;
    to->n_subs = from->n_subs;
    to->sub_capacity = from->sub_capacity;
}

void tri_mesh_swap(struct tri_mesh *a, struct tri_mesh *b)
{
    const struct tri_mesh before = *a;
    for (enum tri_array which = TRI_XY; which < TRI_ARRAYS; which++) {
        set_array(a, which, array_of(b, which).at);
        set_array(b, which, array_of(&before, which).at);
    }
    a->storage = b->storage;
    b->storage = before.storage;
    copy_counts(a, b);
    copy_counts(b, &before);
}

static bool fill_array(struct tri_mesh *to, enum tri_array which, const void *from, size_t bytes)
{
    if (to->storage)
        return to->storage->fill(to->storage->user, which, from, bytes);
    memcpy(array_of(to, which).at, from, bytes);
    return true;
}

/* Copies the arrays of *from into the empty mesh *to, allocated in the given storage. */
static bool copy_arrays(struct tri_mesh *to, const struct tri_mesh *from, const struct tri_storage *storage)
{
    bool memory = true;
    *to = (struct tri_mesh){.n_attributes = from->n_attributes, .has_lengths = from->has_lengths, .storage = storage};
    for (enum tri_array which = TRI_XY; memory && which < TRI_ARRAYS; which++) {
        struct array a = array_of(from, which);
        memory = a.capacity == 0 || grow_array(to, which, a.capacity);
        if (memory && a.n > 0 && a.item > 0)
            memory = fill_array(to, which, a.at, (size_t)a.n * a.item);
    }
    if (memory)
        copy_counts(to, from);
    else
        tri_mesh_drop(to);
    return memory;
}

enum tri_status tri_mesh_copy(struct tri_mesh *copy, const struct tri_mesh *mesh, struct tri_error *error)
{
    return copy_arrays(copy, mesh, NULL) ? TRI_OK : no_memory(error, "triangles of a copy", mesh->n_triangles);
}

enum tri_status tri_mesh_move(struct tri_mesh *mesh, const struct tri_storage *storage, struct tri_error *error)
{
    struct tri_mesh there;
    if (!copy_arrays(&there, mesh, storage))
        return no_memory(error, "triangles of a second copy", mesh->n_triangles);
    tri_mesh_swap(mesh, &there);
    tri_mesh_drop(&there);
    return TRI_OK;
}

enum tri_status tri_mesh_have_lengths(struct tri_mesh *mesh, bool has, struct tri_error *error)
{
    if (!has && !mesh->storage)
        free(mesh->length);
    if (!has)
        mesh->length = NULL;
    mesh->has_lengths = has;
    if (!has || mesh->length || mesh->vertex_capacity == 0 || grow_array(mesh, TRI_LENGTH, mesh->vertex_capacity))
        return TRI_OK;
    mesh->has_lengths = false;
    return no_memory(error, "lengths", mesh->n_vertices);
}

/* Arrays that have the same number of items. */
struct group {
    enum tri_array first, last;
    int32_t *capacity;
    int32_t limit;
    const char *items;
};

/* If memory is bounded, first tries a smaller capacity before it moves the arrays to another storage. */
static enum tri_status choose_capacity(struct tri_mesh *mesh, const struct group *g, int64_t need, int32_t *capacity,
                                       struct tri_error *error)
{
    const struct tri_bound *bound = mesh->storage ? NULL : mesh->bound;
    size_t item = 0;
    for (enum tri_array which = g->first; which <= g->last; which++)
        item += array_of(mesh, which).item;
    const size_t others = bytes_reserved(mesh) - (size_t)*g->capacity * item;
    *capacity = next_capacity(*g->capacity, need, g->limit, mesh->storage);
    if (!*capacity)
        return too_large(error, g->items);
    if (!bound || bound->allows(bound->user, mesh, others + (size_t)*capacity * item))
        return TRI_OK;
    *capacity = next_capacity(*g->capacity, need, g->limit, true);
    if (bound->allows(bound->user, mesh, others + (size_t)*capacity * item))
        return TRI_OK;
    return bound->leave(bound->user, mesh, error);
}

static enum tri_status reserve_group(struct tri_mesh *mesh, const struct group *g, int64_t need,
                                     struct tri_error *error)
{
    int32_t capacity;
    if (need <= *g->capacity)
        return TRI_OK;
    enum tri_status status = choose_capacity(mesh, g, need, &capacity, error);
    for (enum tri_array which = g->first; !status && which <= g->last; which++)
        if (!grow_array(mesh, which, capacity))
            status = no_memory(error, g->items, capacity);
    if (!status)
        *g->capacity = capacity;
    return status;
}

enum tri_status tri_mesh_reserve_vertices(struct tri_mesh *mesh, int32_t more, struct tri_error *error)
{
    const struct group g = {TRI_XY, TRI_ATTRIBUTES, &mesh->vertex_capacity, TRI_MAX_VERTICES, "vertices"};
    assert(more >= 0);
    return reserve_group(mesh, &g, (int64_t)mesh->n_vertices + more, error);
}

enum tri_status tri_mesh_reserve_triangles(struct tri_mesh *mesh, int32_t more, struct tri_error *error)
{
    const struct group g = {TRI_TRIANGLES, TRI_TRIANGLES, &mesh->triangle_capacity, TRI_MAX_TRIANGLES, "triangles"};
    assert(more >= 0);
    return reserve_group(mesh, &g, (int64_t)mesh->n_triangles + more, error);
}

static enum tri_status reserve_parents(struct tri_mesh *mesh, int64_t need, struct tri_error *error)
{
    int32_t capacity = next_capacity(mesh->parent_capacity, need, TRI_MAX_TRIANGLES, false);
    if (!capacity)
        return too_large(error, "segments");
    if (!tri_resize(&mesh->parents, (size_t)capacity, sizeof *mesh->parents))
        return no_memory(error, "segments", capacity);
    mesh->parent_capacity = capacity;
    return TRI_OK;
}

enum tri_status tri_mesh_reserve_subs(struct tri_mesh *mesh, int32_t more, struct tri_error *error)
{
    const int64_t parents = (int64_t)mesh->n_parents + more;
    const struct group g = {TRI_SUBS, TRI_SUBS, &mesh->sub_capacity, TRI_MAX_TRIANGLES, "subsegments"};
    assert(more >= 0);
    enum tri_status status = reserve_group(mesh, &g, (int64_t)mesh->n_subs + more, error);
    return status || parents <= mesh->parent_capacity ? status : reserve_parents(mesh, parents, error);
}

/* Returns the largest absolute coordinate. */
static double largest_coordinate(const struct tri_pslg *pslg)
{
    double size = 0;
    for (int32_t i = 0; i < 2 * pslg->n_points; i++)
        size = fabs(pslg->points[i]) > size ? fabs(pslg->points[i]) : size;
    return size;
}

/* Returns 1 for coordinates of ordinary size. Otherwise returns a power of two that scales the largest coordinate to
 * about 1, subject to one limit: all coordinates of the mesh (triangle/geometry/point.h) must be doubles in the
 * caller's units as well. The former are multiples of 2^-268 units, the latter multiples of 2^-1074. */
static double choose_unit(double size)
{
    int exponent;
    if (size == 0 || (size >= 0x1p-100 && size <= TRI_LARGEST_COORDINATE / 2))
        return 1;
    frexp(size, &exponent);
    return ldexp(1, exponent > -805 ? exponent - 1 : -806); /* scales the largest coordinate into [1, 2) or below */
}

struct point_copy {
    struct tri_mesh *mesh;
    const struct tri_pslg *pslg;
};

static void copy_points_share(void *context, size_t share)
{
    const struct point_copy *point_copy = context;
    struct tri_mesh *mesh = point_copy->mesh;
    const struct tri_pslg *pslg = point_copy->pslg;
    struct tri_range range = tri_share(share, pslg->n_points);
    for (int32_t i = range.first; i < range.last; i++) {
        mesh->xy[i] = tri_to_units(mesh, pslg->points[2 * i], pslg->points[2 * i + 1]);
        assert(tri_is_in_range(mesh->xy[i]));
        mesh->on[i] = TRI_VERTEX_INPUT;
        mesh->vertex_markers[i] = pslg->markers ? pslg->markers[i] : 0;
        mesh->feature[i] = HUGE_VAL;
    }
}

enum tri_status tri_mesh_take_points(struct tri_mesh *mesh, const struct tri_pslg *pslg,
                                     const struct tri_executor *executor, struct tri_error *error)
{
    int32_t n = pslg->n_points, attributes = pslg->n_attributes;
    const double size = largest_coordinate(pslg);
    assert(mesh->n_vertices == 0);
    if (size > 0 && size < DBL_MIN)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0,
                        "no coordinate is larger than %.3g: below %.3g numbers lose their precision", size, DBL_MIN);
    mesh->n_attributes = attributes;
    enum tri_status status = tri_mesh_reserve_vertices(mesh, n, error);
    if (status)
        return status;
    mesh->unit = choose_unit(size);
    tri_execute(executor, tri_shares(n), copy_points_share, &(struct point_copy){mesh, pslg});
    if (n > 0 && attributes > 0)
        memcpy(mesh->attributes, pslg->attributes, (size_t)n * (size_t)attributes * sizeof *mesh->attributes);
    mesh->n_vertices = mesh->n_input = n;
    return TRI_OK;
}

tri_sub_id tri_mesh_add_sub(struct tri_mesh *mesh, tri_vertex_id from, tri_vertex_id to, int32_t marker,
                            int32_t segment)
{
    int32_t s = mesh->n_subs++, parent = mesh->n_parents++;
    assert(s < mesh->sub_capacity && parent < mesh->parent_capacity);
    mesh->parents[parent] = (struct tri_parent){{from, to}, segment, segment != TRI_NONE, false, {NAN, NAN}};
    mesh->sub[s] = (struct tri_subsegment){{from, to}, {TRI_NONE, TRI_NONE}, marker, parent};
    return s;
}

/* State while one array of items is reordered. */
struct gathering {
    char *array; /* where the first item goes */
    char *scratch;
    const char *origin; /* item 0 */
    size_t item;
    const tri_vertex_id *from;
    int32_t n;
};

/* Inlined for known sizes, so that each copy is a plain assignment instead of a call. */
static inline void gather_items(struct gathering g, struct tri_range range, size_t item)
{
    for (int32_t i = range.first; i < range.last; i++)
        memcpy(g.scratch + (size_t)i * item, g.origin + (size_t)g.from[i] * item, item);
}

static void gather_share(void *context, size_t share)
{
    const struct gathering *g = context;
    struct tri_range range = tri_share(share, g->n);
    switch (g->item) {
    case sizeof(int32_t): gather_items(*g, range, sizeof(int32_t)); break;
    case sizeof(double): gather_items(*g, range, sizeof(double)); break;
    case sizeof(struct tri_point): gather_items(*g, range, sizeof(struct tri_point)); break;
    default: gather_items(*g, range, g->item);
    }
}

static void copy_back_share(void *context, size_t share)
{
    const struct gathering *g = context;
    struct tri_range range = tri_share(share, g->n);
    size_t first = (size_t)range.first * g->item;
    memcpy(g->array + first, g->scratch + first, (size_t)(range.last - range.first) * g->item);
}

void tri_mesh_gather_vertices(struct tri_mesh *mesh, tri_vertex_id first, const tri_vertex_id *from, int32_t n,
                              void *scratch, const struct tri_executor *executor)
{
    void *array[] = {mesh->xy, mesh->on, mesh->vertex_markers, mesh->feature, mesh->length, mesh->attributes};
    const size_t item[] = {sizeof *mesh->xy, sizeof *mesh->on, sizeof *mesh->vertex_markers, sizeof *mesh->feature,
                           mesh->has_lengths ? sizeof *mesh->length : 0,
                           (size_t)mesh->n_attributes * sizeof *mesh->attributes};
    for (int k = 0; k < 6; k++) {
        if (n == 0 || item[k] == 0)
            continue;
        struct gathering g = {(char *)array[k] + (size_t)first * item[k], scratch, array[k], item[k], from, n};
        tri_execute(executor, tri_shares(n), gather_share, &g);
        tri_execute(executor, tri_shares(n), copy_back_share, &g);
    }
}

static void move_triangle(struct tri_mesh *mesh, tri_triangle_id from, tri_triangle_id to)
{
    struct tri_triangle *t = &mesh->tri[to];
    *t = mesh->tri[from];
    for (int e = 0; e < 3; e++)
        tri_relink(mesh, t->n[e], t->v[tri_next[e]], tri_code(to, e));
}

void tri_mesh_compact(struct tri_mesh *mesh)
{
    int32_t hole = 0, last = mesh->n_triangles - 1;
    for (;;) {
        while (hole <= last && tri_is_live(&mesh->tri[hole]))
            hole++;
        while (last > hole && !tri_is_live(&mesh->tri[last]))
            last--;
        if (hole >= last)
            break;
        move_triangle(mesh, last--, hole++);
    }
    mesh->n_triangles = hole;
}

static bool edge_is_mutual(const struct tri_mesh *mesh, tri_triangle_id t, int e)
{
    tri_link link = mesh->tri[t].n[e];
    tri_vertex_id from = mesh->tri[t].v[tri_next[e]], to = mesh->tri[t].v[tri_prev[e]];
    if (link >= 0) {
        if (tri_of(link) >= mesh->n_triangles || tri_edge(link) > 2)
            return false;
        const struct tri_triangle *other = &mesh->tri[tri_of(link)];
        int f = tri_edge(link);
        return other->n[f] == tri_code(t, e) && other->v[tri_next[f]] == to && other->v[tri_prev[f]] == from;
    }
    if (~link >= mesh->n_subs)
        return false;
    const struct tri_subsegment *s = &mesh->sub[~link];
    int side = tri_side(s, from);
    return s->v[side] == from && s->v[1 - side] == to && s->side[side] == tri_code(t, e);
}

static bool side_is_mutual(const struct tri_mesh *mesh, tri_sub_id s, int k)
{
    tri_halfedge code = mesh->sub[s].side[k];
    if (code == TRI_NONE)
        return true;
    if (code < 0 || tri_edge(code) > 2 || tri_of(code) >= mesh->n_triangles)
        return false;
    const struct tri_triangle *t = &mesh->tri[tri_of(code)];
    int e = tri_edge(code);
    return tri_is_live(t) && t->n[e] == ~s && t->v[tri_next[e]] == mesh->sub[s].v[k] &&
           t->v[tri_prev[e]] == mesh->sub[s].v[1 - k];
}

enum tri_status tri_mesh_validate(const struct tri_mesh *mesh, struct tri_error *error)
{
    for (tri_triangle_id t = 0; t < mesh->n_triangles; t++) {
        if (!tri_is_live(&mesh->tri[t]))
            continue;
        for (int e = 0; e < 3; e++) {
            if (mesh->tri[t].v[e] < 0 || mesh->tri[t].v[e] >= mesh->n_vertices)
                return tri_fail(error, TRI_INTERNAL, NULL, 0, "triangle %d has no corner %d", (int)t, e);
            if (!edge_is_mutual(mesh, t, e))
                return tri_fail(error, TRI_INTERNAL, NULL, 0, "edge %d of triangle %d is not mutual", e, (int)t);
        }
    }
    for (tri_sub_id s = 0; s < mesh->n_subs; s++)
        for (int k = 0; k < 2; k++)
            if (!side_is_mutual(mesh, s, k))
                return tri_fail(error, TRI_INTERNAL, NULL, 0, "side %d of subsegment %d is not mutual", k, (int)s);
    return TRI_OK;
}

bool tri_mesh_is_sound(const struct tri_mesh *mesh)
{
    enum { SMALL = 4096 };
    return 0 <= mesh->n_vertices && mesh->n_vertices <= mesh->vertex_capacity && mesh->n_input <= mesh->n_vertices &&
           0 <= mesh->n_triangles && mesh->n_triangles <= mesh->triangle_capacity && 0 <= mesh->n_subs &&
           mesh->n_subs <= mesh->sub_capacity && 0 <= mesh->n_parents && mesh->n_parents <= mesh->parent_capacity &&
           (mesh->n_triangles > SMALL || tri_mesh_validate(mesh, NULL) == TRI_OK);
}
