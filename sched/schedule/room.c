/* Ranges of indices in the shared arrays: how they are dealt to blocks, used, returned, and finally closed. */
#include "sched/schedule/room.h"

#include <assert.h>
#include <stdlib.h>

#include "sched/tunables.h"
#include "triangle/base/grow.h"

/* The largest number of items of each kind that one insertion needs. */
static const int32_t one_insertion[PAR_KINDS] = {[PAR_VERTICES] = 1, [PAR_TRIANGLES] = 2, [PAR_SUBS] = 1};

static enum tri_status no_memory(struct tri_error *error)
{
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the ranges of a block");
}

bool par_ranges_reserve(struct par_ranges *ranges, int32_t need)
{
    return tri_grow(&ranges->item, &ranges->capacity, need, sizeof *ranges->item);
}

int64_t par_ranges_unused(const struct par_ranges *ranges)
{
    int64_t n = 0;
    for (int32_t i = 0; i < ranges->n; i++)
        n += ranges->item[i].end - ranges->item[i].next;
    return n;
}

/* Pointers to a mesh's count and capacity of one kind. */
struct counts {
    int32_t *used, *capacity; /* members of the mesh */
};

/* Returns pointers to the mesh's count and capacity of a kind. */
static struct counts counts_of(struct tri_mesh *mesh, enum par_kind kind)
{
    switch (kind) {
    case PAR_VERTICES: return (struct counts){&mesh->n_vertices, &mesh->vertex_capacity};
    case PAR_TRIANGLES: return (struct counts){&mesh->n_triangles, &mesh->triangle_capacity};
    default: return (struct counts){&mesh->n_subs, &mesh->sub_capacity};
    }
}

/* Returns the room's current range of a kind; NULL: it has none. */
static struct par_range *current_of(struct par_room *room, enum par_kind kind)
{
    struct par_ranges *ranges = &room->ranges[kind];
    return room->current[kind] < ranges->n ? &ranges->item[room->current[kind]] : NULL;
}

/* Sets count and capacity of the view to the bounds of the room's current range; to 0 if there is none. */
static void begin_range(struct par_view *view, enum par_kind kind)
{
    const struct par_range *range = current_of(&view->room, kind);
    struct counts counts = counts_of(&view->mesh, kind);
    assert(!range || (0 <= range->next && range->next <= range->end));
    *counts.used = range ? range->next : 0;
    *counts.capacity = range ? range->end : 0;
}

/* Writes the view's count back to the room's current range. */
static void end_range(struct par_view *view, enum par_kind kind)
{
    struct par_range *range = current_of(&view->room, kind);
    struct counts counts = counts_of(&view->mesh, kind);
    if (!range)
        return;
    assert(range->next <= *counts.used && *counts.used <= range->end && *counts.capacity == range->end);
    range->next = *counts.used;
}

/* Returns whether the room suffices for this many points. At most one of the points needs a subsegment. */
static bool has_room(const struct par_room *room, int32_t points)
{
    return par_room_left(room, PAR_VERTICES) >= points && par_room_left(room, PAR_TRIANGLES) / 2 >= points;
}

/* The loop asks for room for one point before an insertion, or for several that must go in without a pause. If several
 * do not fit, view->points keeps the number, so that the next extension is large enough. For one point, full ranges are
 * passed over, kind by kind. */
enum tri_status par_view_more_room(void *user, struct tri_mesh *mesh, int32_t points, struct tri_error *error)
{
    struct par_view *view = user;
    assert(mesh == &view->mesh);
    for (enum par_kind kind = PAR_VERTICES; points > 1 && kind < PAR_KINDS; kind++)
        end_range(view, kind);
    /* Several points: check whether all of them fit into the block's ranges. */
    view->points = points > 1 && !has_room(&view->room, points) ? points : 0;
    if (view->points > 0)
        return tri_fail(error, TRI_NO_ROOM, NULL, 0, "the block's room is full");
    for (enum par_kind kind = PAR_VERTICES; kind < PAR_KINDS; kind++) {
        const struct counts counts = counts_of(mesh, kind);
        assert(*counts.used <= *counts.capacity);
        /* One point: move on to the first range that has room for it. */
        while (*counts.capacity - *counts.used < one_insertion[kind]) {
            end_range(view, kind);
            if (view->room.current[kind] + 1 >= view->room.ranges[kind].n)
                return tri_fail(error, TRI_NO_ROOM, NULL, 0, "the block's room is full");
            view->room.current[kind]++;
            begin_range(view, kind);
        }
    }
    return TRI_OK;
}

void par_view_begin(struct par_view *view, const struct tri_mesh *shared)
{
    view->mesh = *shared;
    for (enum par_kind kind = PAR_VERTICES; kind < PAR_KINDS; kind++)
        begin_range(view, kind);
}

void par_view_end(struct par_view *view)
{
    for (enum par_kind kind = PAR_VERTICES; kind < PAR_KINDS; kind++)
        end_range(view, kind);
}

/* Reserves space for one more range in both lists: in `to`, to receive it now, and in `spare`, to return it later. Thus
 * returning a range never needs memory. */
static bool reserve_deal(struct par_ranges *to, struct par_ranges *spare)
{
    return par_ranges_reserve(to, to->n + 1) && par_ranges_reserve(spare, spare->n + spare->dealt + 1);
}

/* Returns the number of items of a range that insertions can use. */
static int32_t usable(struct par_range range, enum par_kind kind)
{
    const int32_t n = range.end - range.next;
    return n - n % one_insertion[kind];
}

/* Appends a range to a block's list; `spare` counts it as dealt. */
static void deal_range(struct par_ranges *to, struct par_ranges *spare, struct par_range range)
{
    assert(to->n < to->capacity && range.next < range.end);
    to->item[to->n++] = range;
    spare->dealt++;
}

/* Grows the shared arrays of one kind by at least `more` free places. */
static enum tri_status reserve_items(struct tri_mesh *shared, enum par_kind kind, int32_t more, struct tri_error *error)
{
    switch (kind) {
    case PAR_VERTICES: return tri_mesh_reserve_vertices(shared, more, error);
    case PAR_TRIANGLES: return tri_mesh_reserve_triangles(shared, more, error);
    default: return tri_mesh_reserve_subs(shared, more, error);
    }
}

/* Extends the ranges of one kind by `need` usable items.
 *
 * A range too short for an insertion (a single triangle) is dealt like any other, but does not count; the view passes
 * over it, and it returns with the others. Keeping such ranges apart would need a second list of free places, which
 * marking and closing gaps would have to search as well.
 *
 * Nothing is removed from `spare` or counted before the lists have space for it, so no range is ever lost. */
static enum tri_status extend_kind(struct par_room *room, struct par_room *spare, struct tri_mesh *shared,
                                   enum par_kind kind, int32_t need, struct tri_error *error)
{
    struct par_ranges *to = &room->ranges[kind], *from = &spare->ranges[kind];
    while (need > 0 && from->n > 0) {
        if (!reserve_deal(to, from))
            return no_memory(error);
        struct par_range *last = &from->item[from->n - 1], range = *last;
        const int32_t wanted = (need < PAR_LEAST_RANGE ? PAR_LEAST_RANGE : need) + 1; /* one may be left over */
        if (range.end - range.next < wanted + PAR_LEAST_RANGE)
            from->n--;
        else
            last->next = range.end = range.next + wanted; /* the rest stays spare */
        need -= usable(range, kind);
        deal_range(to, from, range);
    }
    if (need <= 0)
        return TRI_OK;
    /* Spare ranges do not suffice: take the rest from the end of the array, which grows. */
    need = need < PAR_LEAST_RANGE ? PAR_LEAST_RANGE : need;
    if (!reserve_deal(to, from))
        return no_memory(error);
    enum tri_status status = reserve_items(shared, kind, need, error);
    if (status)
        return status;
    int32_t *used = counts_of(shared, kind).used;
    deal_range(to, from, (struct par_range){*used, *used + need});
    *used += need;
    return TRI_OK;
}

int32_t par_room_left(const struct par_room *room, enum par_kind kind)
{
    int32_t left = 0;
    for (int32_t i = room->current[kind]; i < room->ranges[kind].n; i++)
        left += usable(room->ranges[kind].item[i], kind);
    return left;
}

/* Returns the number of items of a kind that an expected number of triangles needs. on_segments: share of the points
 * that lie on segments. */
static int64_t items_for(enum par_kind kind, int64_t triangles, double on_segments)
{
    switch (kind) {
    case PAR_VERTICES: return triangles / 2 + triangles / 64 + 16;
    case PAR_TRIANGLES: return triangles;
    default: return (int64_t)(0.5 * on_segments * (double)triangles) + 64;
    }
}

/* Returns the expected share of points on segments: that of the block's points so far, but at least
 * PAR_LEAST_ON_SEGMENTS. */
static double on_segments(const struct par_room *room)
{
    return room->on_segments > PAR_LEAST_ON_SEGMENTS ? room->on_segments : PAR_LEAST_ON_SEGMENTS;
}

enum tri_status par_room_extend(struct par_room *room, struct par_room *spare, struct tri_mesh *shared,
                                int32_t triangles, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    for (enum par_kind kind = PAR_VERTICES; !status && kind < PAR_KINDS; kind++)
        status = extend_kind(room, spare, shared, kind,
                             (int32_t)items_for(kind, triangles, on_segments(room)) - par_room_left(room, kind), error);
    return status;
}

void par_room_reserve(const struct par_room *spare, struct tri_mesh *shared, int64_t triangles)
{
    enum tri_status status = TRI_OK;
    /* If memory is bounded, growing ahead of need would waste it. */
    if (shared->bound || shared->storage)
        return;
    for (enum par_kind kind = PAR_VERTICES; !status && kind < PAR_KINDS; kind++) {
        int64_t need = items_for(kind, triangles, PAR_LEAST_ON_SEGMENTS);
        need -= par_ranges_unused(&spare->ranges[kind]);
        if (need > 0)
            status = reserve_items(shared, kind, need < INT32_MAX ? (int32_t)need : INT32_MAX, NULL);
    }
}

void par_room_return(struct par_room *room, struct par_room *spare)
{
    for (enum par_kind kind = PAR_VERTICES; kind < PAR_KINDS; kind++) {
        struct par_ranges *from = &room->ranges[kind], *to = &spare->ranges[kind];
        for (int32_t i = 0; i < from->n; i++) {
            to->dealt--;
            /* reserve_deal has reserved space for this range. */
            if (from->item[i].next < from->item[i].end)
                to->item[to->n++] = from->item[i];
        }
        assert(to->n + to->dealt <= to->capacity);
    }
    par_room_free(room);
}

bool par_room_release(struct par_room *spare, enum par_kind kind, int32_t id)
{
    return par_ranges_add(&spare->ranges[kind], id);
}

void par_room_free(struct par_room *room)
{
    for (enum par_kind kind = PAR_VERTICES; kind < PAR_KINDS; kind++)
        free(room->ranges[kind].item);
    *room = (struct par_room){0};
}

void par_room_mark_sub(struct tri_mesh *mesh, tri_sub_id s)
{
    mesh->sub[s] = (struct tri_subsegment){{TRI_NONE, TRI_NONE}, {TRI_NONE, TRI_NONE}, 0, TRI_NONE};
}

/* Marks one place of an array as free. */
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

/* Marking the gaps of one kind: the common data of its tasks. */
struct marking {
    const struct par_ranges *gaps; /* the gaps */
    struct tri_mesh *mesh;         /* the shared arrays */
    enum par_kind kind;            /* of the items */
};

/* A task: marks the places of one share of the gaps. */
static void mark_share(void *context, size_t share)
{
    const struct marking *m = context;
    const struct tri_range range = tri_share_of(share, TRI_MOST_SHARES, m->gaps->n);
    for (int32_t gap = range.first; gap < range.last; gap++)
        for (int32_t at = m->gaps->item[gap].next; at < m->gaps->item[gap].end; at++)
            mark_free(m->mesh, m->kind, at);
}

void par_room_mark(const struct par_room *spare, struct tri_mesh *shared, const struct tri_executor *executor)
{
    for (enum par_kind kind = PAR_VERTICES; kind < PAR_KINDS; kind++) {
        struct marking marking = {&spare->ranges[kind], shared, kind};
        tri_execute(executor, TRI_MOST_SHARES, mark_share, &marking);
    }
}

/* --- closing gaps: items above the new end of an array move to the gaps below it */

/* Orders ranges by their first index. */
static int by_start(const void *left, const void *right)
{
    const struct par_range *a = left, *b = right;
    return (a->next > b->next) - (a->next < b->next);
}

/* Calls move for each item above the new end of an array. Items are taken from the old end downwards, and put into the
 * free places from the lowest upwards. Returns the new end. */
static int32_t move_items(struct par_ranges *gaps, int32_t count, struct tri_mesh *mesh,
                          void (*move)(struct tri_mesh *mesh, int32_t from, int32_t to))
{
    const int32_t kept = count - (int32_t)par_ranges_unused(gaps);
    struct par_range *into = gaps->item;
    if (gaps->n > 0)
        qsort(gaps->item, (size_t)gaps->n, sizeof *gaps->item, by_start);
    /* From the last gap downwards: move the items between this gap and the one above it, or the end. */
    for (int32_t gap = gaps->n, end = count; end > kept; end = gaps->item[gap].next) {
        gap--;
        assert(gaps->item[gap].end <= end);
        int32_t first = gaps->item[gap].end > kept ? gaps->item[gap].end : kept;
        for (int32_t item = end - 1; item >= first; item--) {
            while (into->next == into->end)
                into++;
            assert(into->next < kept);
            move(mesh, item, into->next++);
        }
    }
    return kept;
}

/* Moves a triangle, and updates the links of its neighbours. */
static void move_triangle(struct tri_mesh *mesh, tri_triangle_id from, tri_triangle_id to)
{
    struct tri_triangle *t = &mesh->tri[to];
    *t = mesh->tri[from];
    assert(tri_is_live(t));
    for (int e = 0; e < 3; e++)
        tri_relink(mesh, t->n[e], t->v[tri_next[e]], tri_code(to, e));
}

/* Moves a subsegment, and updates the links of the triangles on both sides. */
static void move_sub(struct tri_mesh *mesh, tri_sub_id from, tri_sub_id to)
{
    struct tri_subsegment *s = &mesh->sub[to];
    *s = mesh->sub[from];
    for (int side = 0; side < 2; side++)
        if (s->side[side] != TRI_NONE)
            *tri_link_at(mesh, s->side[side]) = ~to;
}

/* Moves a vertex, and stores its new id in `on` at its old place, where rename_corners looks it up. */
static void move_vertex(struct tri_mesh *mesh, tri_vertex_id from, tri_vertex_id to)
{
    mesh->xy[to] = mesh->xy[from];
    mesh->on[to] = mesh->on[from];
    mesh->vertex_markers[to] = mesh->vertex_markers[from];
    mesh->feature[to] = mesh->feature[from];
    if (mesh->has_lengths)
        mesh->length[to] = mesh->length[from];
    mesh->on[from] = to;
}

/* A task: replaces the ids of moved vertices in the triangles of one share. */
static void rename_corners(void *context, size_t share)
{
    const struct tri_mesh *mesh = context;
    const struct tri_range range = tri_share(share, mesh->n_triangles);
    for (tri_triangle_id t = range.first; t < range.last; t++)
        for (int k = 0; k < 3; k++)
            if (mesh->tri[t].v[k] >= mesh->n_vertices)
                mesh->tri[t].v[k] = mesh->on[mesh->tri[t].v[k]];
}

/* Closes the gaps among vertices, then updates the corners of triangles and the ends of subsegments. */
static void close_vertices(struct par_ranges *gaps, struct tri_mesh *mesh, const struct tri_executor *executor)
{
    mesh->n_vertices = move_items(gaps, mesh->n_vertices, mesh, move_vertex);
    tri_execute(executor, tri_shares(mesh->n_triangles), rename_corners, mesh);
    for (tri_sub_id s = 0; s < mesh->n_subs; s++)
        for (int k = 0; k < 2; k++)
            if (mesh->sub[s].v[k] >= mesh->n_vertices)
                mesh->sub[s].v[k] = mesh->on[mesh->sub[s].v[k]];
}

void par_room_close(struct par_room *spare, struct tri_mesh *shared, const struct tri_executor *executor)
{
    /* Triangles and subsegments first: moving them updates links only. Moving vertices then updates the corners of
     * both. */
    shared->n_triangles = move_items(&spare->ranges[PAR_TRIANGLES], shared->n_triangles, shared, move_triangle);
    shared->n_subs = move_items(&spare->ranges[PAR_SUBS], shared->n_subs, shared, move_sub);
    close_vertices(&spare->ranges[PAR_VERTICES], shared, executor);
    par_room_free(spare);
}
