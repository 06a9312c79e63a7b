/* Ranges of the shared arrays. */
#include "sched/room.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/grow.h"

enum { LEAST_RANGE = 64 };

/* What one insertion takes at most. */
static const int32_t one_insertion[PAR_KINDS] = {[PAR_VERTICES] = 1, [PAR_TRIANGLES] = 2, [PAR_SUBS] = 1};

static enum tri_status no_memory(struct tri_error *error)
{
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the ranges of a block");
}

bool par_ranges_reserve(struct par_ranges *ranges, int32_t need)
{
    return tri_grow(&ranges->item, &ranges->capacity, need, sizeof *ranges->item);
}

/* How many items of a kind there are in a mesh, and how many there can be. */
struct counts {
    int32_t *used, *capacity;
};

static struct counts counts_of(struct tri_mesh *mesh, enum par_kind kind)
{
    switch (kind) {
    case PAR_VERTICES: return (struct counts){&mesh->n_vertices, &mesh->vertex_capacity};
    case PAR_TRIANGLES: return (struct counts){&mesh->n_triangles, &mesh->triangle_capacity};
    default: return (struct counts){&mesh->n_subs, &mesh->sub_capacity};
    }
}

/* The room's current range of a kind; NULL: it has none. */
static struct par_range *current_of(struct par_room *room, enum par_kind kind)
{
    struct par_ranges *ranges = &room->ranges[kind];
    return room->current[kind] < ranges->n ? &ranges->item[room->current[kind]] : NULL;
}

/* Shows a view the current range of a kind. */
static void enter(struct par_room *room, struct tri_mesh *view, enum par_kind kind)
{
    const struct par_range *range = current_of(room, kind);
    struct counts counts = counts_of(view, kind);
    assert(!range || (0 <= range->next && range->next <= range->end));
    *counts.used = range ? range->next : 0;
    *counts.capacity = range ? range->end : 0;
}

static void leave(struct par_room *room, struct tri_mesh *view, enum par_kind kind)
{
    struct par_range *range = current_of(room, kind);
    struct counts counts = counts_of(view, kind);
    if (!range)
        return;
    assert(range->next <= *counts.used && *counts.used <= range->end && *counts.capacity == range->end);
    range->next = *counts.used;
}

enum tri_status par_more_room(void *user, struct tri_mesh *view, struct tri_error *error)
{
    struct par_room *room = user;
    for (enum par_kind kind = PAR_VERTICES; kind < PAR_KINDS; kind++) {
        const struct counts counts = counts_of(view, kind);
        assert(*counts.used <= *counts.capacity);
        while (*counts.capacity - *counts.used < one_insertion[kind]) {
            leave(room, view, kind);
            if (room->current[kind] + 1 >= room->ranges[kind].n)
                return tri_fail(error, TRI_NO_ROOM, NULL, 0, "the block's room is full");
            room->current[kind]++;
            enter(room, view, kind);
        }
    }
    return TRI_OK;
}

void par_room_enter(struct par_room *room, struct tri_mesh *view, const struct tri_mesh *shared)
{
    *view = *shared;
    for (enum par_kind kind = PAR_VERTICES; kind < PAR_KINDS; kind++)
        enter(room, view, kind);
}

void par_room_leave(struct par_room *room, struct tri_mesh *view)
{
    for (enum par_kind kind = PAR_VERTICES; kind < PAR_KINDS; kind++)
        leave(room, view, kind);
}

/* Room in both lists for one more range in a block's hands: to take it now, and to give it back later. */
static bool reserve_deal(struct par_ranges *to, struct par_ranges *spare)
{
    return par_ranges_reserve(to, to->n + 1) && par_ranges_reserve(spare, spare->n + spare->dealt + 1);
}

static void deal(struct par_ranges *to, struct par_ranges *spare, struct par_range range)
{
    assert(to->n < to->capacity && range.next < range.end);
    to->item[to->n++] = range;
    spare->dealt++;
}

static enum tri_status reserve(struct tri_mesh *shared, enum par_kind kind, int32_t more, struct tri_error *error)
{
    switch (kind) {
    case PAR_VERTICES: return tri_mesh_reserve_vertices(shared, more, error);
    case PAR_TRIANGLES: return tri_mesh_reserve_triangles(shared, more, error);
    default: return tri_mesh_reserve_subs(shared, more, error);
    }
}

/* Nothing is taken or counted before there is room for it in the lists: no range is ever lost. */
static enum tri_status extend(struct par_room *room, struct par_room *spare, struct tri_mesh *shared,
                              enum par_kind kind, int32_t need, struct tri_error *error)
{
    struct par_ranges *to = &room->ranges[kind], *from = &spare->ranges[kind];
    while (need > 0 && from->n > 0) {
        if (!reserve_deal(to, from))
            return no_memory(error);
        struct par_range range = from->item[--from->n];
        need -= range.end - range.next;
        deal(to, from, range);
    }
    if (need <= 0)
        return TRI_OK;
    need = need < LEAST_RANGE ? LEAST_RANGE : need;
    if (!reserve_deal(to, from))
        return no_memory(error);
    enum tri_status status = reserve(shared, kind, need, error);
    if (status)
        return status;
    int32_t *used = counts_of(shared, kind).used;
    deal(to, from, (struct par_range){*used, *used + need});
    *used += need;
    return TRI_OK;
}

/* Unused items in the hands of a block, in ranges where an insertion fits. */
static int32_t left_of(const struct par_room *room, enum par_kind kind)
{
    int32_t left = 0;
    for (int32_t i = room->current[kind]; i < room->ranges[kind].n; i++) {
        int32_t here = room->ranges[kind].item[i].end - room->ranges[kind].item[i].next;
        left += here >= one_insertion[kind] ? here : 0;
    }
    return left;
}

/* Of this kind, what comes with so many triangles. */
static int64_t wanted_of(enum par_kind kind, int64_t triangles)
{
    switch (kind) {
    case PAR_VERTICES: return triangles / 2 + triangles / 64 + 16;
    case PAR_TRIANGLES: return triangles;
    default: return triangles / 16 + 64;
    }
}

enum tri_status par_room_extend(struct par_room *room, struct par_room *spare, struct tri_mesh *shared,
                                int32_t triangles, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    for (enum par_kind kind = PAR_VERTICES; !status && kind < PAR_KINDS; kind++)
        status = extend(room, spare, shared, kind, (int32_t)wanted_of(kind, triangles) - left_of(room, kind), error);
    return status;
}

enum tri_status par_room_reserve(const struct par_room *spare, struct tri_mesh *shared, int64_t triangles,
                                 struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    if (shared->bound || shared->storage)
        return TRI_OK;
    for (enum par_kind kind = PAR_VERTICES; !status && kind < PAR_KINDS; kind++) {
        int64_t need = wanted_of(kind, triangles);
        for (int32_t i = 0; i < spare->ranges[kind].n; i++)
            need -= spare->ranges[kind].item[i].end - spare->ranges[kind].item[i].next;
        if (need > 0)
            status = reserve(shared, kind, need < INT32_MAX ? (int32_t)need : INT32_MAX, error);
    }
    return status;
}

void par_room_return(struct par_room *room, struct par_room *spare)
{
    for (enum par_kind kind = PAR_VERTICES; kind < PAR_KINDS; kind++) {
        struct par_ranges *from = &room->ranges[kind], *to = &spare->ranges[kind];
        for (int32_t i = 0; i < from->n; i++) {
            to->dealt--;
            if (from->item[i].next < from->item[i].end)
                to->item[to->n++] = from->item[i];
        }
        assert(to->n + to->dealt <= to->capacity);
    }
    par_room_free(room);
}

void par_room_free(struct par_room *room)
{
    for (enum par_kind kind = PAR_VERTICES; kind < PAR_KINDS; kind++)
        free(room->ranges[kind].item);
    *room = (struct par_room){0};
}

void par_room_mark_sub(struct tri_mesh *mesh, int32_t s)
{
    mesh->sub[s] = (struct tri_subsegment){{TRI_NONE, TRI_NONE}, {TRI_NONE, TRI_NONE}, 0, TRI_NONE};
}

static void mark_free(struct tri_mesh *mesh, enum par_kind kind, int32_t at)
{
    switch (kind) {
    case PAR_VERTICES:
        mesh->on[at] = TRI_VERTEX_NONE;
        return;
    case PAR_TRIANGLES:
        mesh->tri[at].v[0] = TRI_NONE;
        return;
    default:
        par_room_mark_sub(mesh, at);
    }
}

/* Gaps of one kind. */
struct marking {
    const struct par_ranges *gaps;
    struct tri_mesh *mesh;
    enum par_kind kind;
};

static void mark_gap(void *context, size_t gap)
{
    const struct marking *m = context;
    for (int32_t at = m->gaps->item[gap].next; at < m->gaps->item[gap].end; at++)
        mark_free(m->mesh, m->kind, at);
}

void par_room_mark(const struct par_room *spare, struct tri_mesh *shared, const struct tri_executor *executor)
{
    for (enum par_kind kind = PAR_VERTICES; kind < PAR_KINDS; kind++) {
        struct marking marking = {&spare->ranges[kind], shared, kind};
        tri_execute(executor, (size_t)spare->ranges[kind].n, mark_gap, &marking);
    }
}

static int by_start(const void *left, const void *right)
{
    const struct par_range *a = left, *b = right;
    return (a->next > b->next) - (a->next < b->next);
}

/* Gaps sorted by place; the walk over holes from below and items from above. */
struct closing {
    struct par_ranges *gaps;
    int32_t low, high;   /* gaps low .. high - 1 are not dealt with */
    int32_t last;        /* items above this one are gone */
};

static struct closing closing_of(struct par_ranges *gaps, int32_t count)
{
    if (gaps->n)
        qsort(gaps->item, (size_t)gaps->n, sizeof *gaps->item, by_start);
    return (struct closing){gaps, 0, gaps->n, count - 1};
}

/* The next hole to fill and the item to fill it with; false at the end, when last + 1 is the new count. */
static bool next_move(struct closing *c, int32_t *hole, int32_t *item)
{
    for (;;) {
        while (c->high > c->low && c->gaps->item[c->high - 1].end == c->last + 1) /* a gap at the end vanishes */
            c->last = c->gaps->item[--c->high].next - 1;
        if (c->low == c->high)
            return false;
        struct par_range *gap = &c->gaps->item[c->low];
        if (gap->next == gap->end) {
            c->low++;
            continue;
        }
        *hole = gap->next++;
        *item = c->last--;
        assert(*hole < *item);
        return true;
    }
}

static void close_triangles(struct par_ranges *gaps, struct tri_mesh *mesh)
{
    struct closing c = closing_of(gaps, mesh->n_triangles);
    int32_t hole, item;
    while (next_move(&c, &hole, &item)) {
        struct tri_triangle *t = &mesh->tri[hole];
        *t = mesh->tri[item];
        for (int e = 0; e < 3; e++)
            tri_relink(mesh, t->n[e], t->v[tri_next[e]], tri_code(hole, e));
    }
    mesh->n_triangles = c.last + 1;
}

static void close_subs(struct par_ranges *gaps, struct tri_mesh *mesh)
{
    struct closing c = closing_of(gaps, mesh->n_subs);
    int32_t hole, item;
    while (next_move(&c, &hole, &item)) {
        struct tri_subsegment *s = &mesh->sub[hole];
        *s = mesh->sub[item];
        for (int side = 0; side < 2; side++)
            if (s->side[side] != TRI_NONE)
                mesh->tri[tri_of(s->side[side])].n[tri_edge(s->side[side])] = ~hole;
    }
    mesh->n_subs = c.last + 1;
}

static void move_vertex(struct tri_mesh *mesh, int32_t from, int32_t to)
{
    size_t n = (size_t)mesh->n_attributes;
    mesh->xy[to] = mesh->xy[from];
    mesh->on[to] = mesh->on[from];
    mesh->vertex_markers[to] = mesh->vertex_markers[from];
    mesh->feature[to] = mesh->feature[from];
    if (n)
        memcpy(mesh->attributes + (size_t)to * n, mesh->attributes + (size_t)from * n, n * sizeof *mesh->attributes);
}

/* The number that a vertex has now which has moved away from here, until all corners have learnt it. It is kept in the
 * memory of the place left behind, since closing must not fail for want of memory. */
static int32_t *forwarding_at(const struct tri_mesh *mesh, int32_t v, int32_t kept)
{
    (void)kept;
    assert(v >= kept);
    return &mesh->vertex_markers[v];
}

/* Corners that have moved: of vertices that lay at `kept` or above. */
struct renaming {
    const struct tri_mesh *mesh;
    int32_t kept;
};

static void rename_corners(void *context, size_t share)
{
    const struct renaming *r = context;
    const struct tri_range range = tri_share(share, r->mesh->n_triangles);
    for (int32_t t = range.first; t < range.last; t++)
        for (int k = 0; k < 3; k++)
            if (r->mesh->tri[t].v[k] >= r->kept)
                r->mesh->tri[t].v[k] = *forwarding_at(r->mesh, r->mesh->tri[t].v[k], r->kept);
}

/* Moves vertices into gaps. */
static void close_vertices(struct par_ranges *gaps, struct tri_mesh *mesh, const struct tri_executor *executor)
{
    struct closing c = closing_of(gaps, mesh->n_vertices);
    int32_t hole, item;
    while (next_move(&c, &hole, &item)) {
        move_vertex(mesh, item, hole);
        *forwarding_at(mesh, item, c.last + 1) = hole;
    }
    int32_t kept = c.last + 1;
    struct renaming renaming = {mesh, kept};
    tri_execute(executor, tri_shares(mesh->n_triangles), rename_corners, &renaming);
    for (int32_t s = 0; s < mesh->n_subs; s++)
        for (int k = 0; k < 2; k++)
            if (mesh->sub[s].v[k] >= kept)
                mesh->sub[s].v[k] = *forwarding_at(mesh, mesh->sub[s].v[k], kept);
    mesh->n_vertices = kept;
}

void par_room_close(struct par_room *spare, struct tri_mesh *shared, const struct tri_executor *executor)
{
    close_triangles(&spare->ranges[PAR_TRIANGLES], shared);
    close_subs(&spare->ranges[PAR_SUBS], shared);
    close_vertices(&spare->ranges[PAR_VERTICES], shared, executor);
    par_room_free(spare);
}
