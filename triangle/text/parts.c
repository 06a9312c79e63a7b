/* GROUPS. The different values are listed in order, then the items are sorted by counting, so that they keep their
 * order within a group.
 *
 * PARTS. A triangle is assigned by its centroid; for equal positions its number decides. The cut between parts below k
 * and parts from k on is stored as cut k. The part of a triangle is found by descending the tree of bisections. A
 * segment that is an edge could belong to the part of each of its triangles. If an end of the segment is used by one
 * part only, this is the part; otherwise the triangles with that edge are searched. */
#include "triangle/text/parts.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/grow.h"

/* --- groups */

/* Returns the first group whose value is not below `value`. */
static int place_of(const struct tri_grouping *g, double value)
{
    int low = 0, high = g->n;
    while (low < high) {
        int middle = (low + high) / 2;
        if (g->value[middle] < value)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Adds a value. Returns false if there are too many values, or if it is NaN. */
static bool count_value(struct tri_grouping *g, double value)
{
    int k = place_of(g, value);
    if (k == g->n || g->value[k] != value) {
        if (g->n == TRI_MOST_GROUPS || isnan(value))
            return false;
        memmove(&g->value[k + 1], &g->value[k], (size_t)(g->n - k) * sizeof *g->value);
        memmove(&g->first[k + 1], &g->first[k], (size_t)(g->n - k) * sizeof *g->first);
        g->value[k] = value;
        g->first[k] = 0;
        g->n++;
    }
    g->first[k]++;
    return true;
}

static void make_one(struct tri_grouping *g, int64_t n)
{
    g->n = 1;
    g->first[0] = 0;
    g->first[1] = n;
}

/* Converts numbers of items in n groups, first[n + 1], to the position of the first item in each. */
static void accumulate(int64_t *first, int n)
{
    int64_t before = 0;
    for (int k = 0; k <= n; k++) {
        const int64_t own = k < n ? first[k] : 0;
        first[k] = before;
        before += own;
    }
}

/* Allocates room for n items from a storage; NULL: from malloc. Returns NULL and sets errno if there is no room. */
static void *allocate_room(const struct tri_storage *storage, int64_t n, size_t bytes)
{
    const size_t all = (size_t)n * bytes;
    return storage ? storage->extra(storage->user, all) : malloc(all + 1);
}

static void free_room(const struct tri_storage *storage, void *room)
{
    if (room && storage)
        storage->extra_free(storage->user, room);
    else
        free(room);
}

enum tri_status tri_group(struct tri_grouping *g, int64_t n, double (*value)(const struct tri_grid *grid, int64_t i),
                          const struct tri_grid *grid, struct tri_error *error)
{
    int64_t i = 0, next[TRI_MOST_GROUPS];
    g->n = 0;
    g->order = NULL;
    while (i < n && count_value(g, value(grid, i)))
        i++;
    if (i < n || n == 0)
        g->value[0] = 0;
    if (i < n || g->n <= 1) {
        make_one(g, n);
        return TRI_OK;
    }
    accumulate(g->first, g->n);
    g->storage = grid->storage;
    g->order = allocate_room(g->storage, n, sizeof *g->order);
    if (!g->order)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "no room to group %lld items: %s", (long long)n,
                        strerror(errno));
    memcpy(next, g->first, (size_t)g->n * sizeof *next);
    for (i = 0; i < n; i++)
        g->order[next[place_of(g, value(grid, i))]++] = i;
    return TRI_OK;
}

void tri_grouping_free(struct tri_grouping *g)
{
    free_room(g->storage, g->order);
    g->order = NULL;
}

int32_t tri_group_tag(double value)
{
    return value >= 1 && value <= INT32_MAX && value == floor(value) ? (int32_t)value : 0;
}

double tri_triangle_group(const struct tri_grid *grid, int64_t i)
{
    return grid->n_columns > 0 ? grid->column(grid->user, i, 0) : 0;
}

double tri_segment_group(const struct tri_grid *grid, int64_t i)
{
    struct tri_grid_edge segment;
    if (!grid->has_markers)
        return 0;
    grid->segment(grid->user, i, &segment);
    return segment.marker;
}

enum { MOST_SAMPLES = 1 << 18 };

/* A point and a part that uses it. Part numbers count from 1 here, so that 0 can mean "none". */
struct use {
    int64_t point;
    int32_t part;
};

struct edge {
    int64_t ends[2]; /* ascending */
    int64_t segment;
};

/* Position of a triangle. */
struct site {
    double at[2];
    int64_t triangle;
};

/* Triangles before the site, along the axis, belong to the lower parts. */
struct cut {
    int axis; /* -1: all triangles do */
    struct site site;
};

struct work {
    struct tri_parts *parts;
    const struct tri_grid *grid;
    struct site *sample;
    struct cut cut[TRI_MOST_PARTS]; /* cut[k] separates parts below k from those from k on */
    int16_t *part;         /* [n_triangles] part of each triangle, from 1 */
    int32_t *user;         /* [n_points] 0: no part so far; k: part k; -k: several parts, the last one noted is k */
    int32_t *segment_part; /* [n_segments] 0: not assigned yet */
    struct use *use;       /* uses of points that belong to several parts */
    int64_t n_uses, room;
    struct edge *edge;     /* segments between shared points, sorted by their ends */
    size_t n_edges;
    bool no_memory;
};

/* --- bisection */

static int by_axis(int axis, const struct site *a, const struct site *b)
{
    for (int k = 0; k < 2; k++, axis = 1 - axis)
        if (a->at[axis] != b->at[axis])
            return a->at[axis] < b->at[axis] ? -1 : 1;
    return a->triangle < b->triangle ? -1 : a->triangle > b->triangle;
}

static int by_x(const void *a, const void *b) { return by_axis(0, a, b); }
static int by_y(const void *a, const void *b) { return by_axis(1, a, b); }

/* Adds a third of each coordinate, because the sum might overflow. */
static struct site site_of(const struct work *w, int64_t t)
{
    struct site site = {{0, 0}, t};
    int64_t nodes[6];
    w->grid->triangle(w->grid->user, t, nodes);
    for (int k = 0; k < 3; k++) {
        struct tri_grid_point point;
        w->grid->point(w->grid->user, nodes[k], &point);
        site.at[0] += point.at[0] / 3;
        site.at[1] += point.at[1] / 3;
    }
    return site;
}

/* Returns the axis along which the extent of the sites is larger. */
static int longer_axis(const struct site *site, int64_t n)
{
    double extent[2];
    for (int axis = 0; axis < 2; axis++) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (int64_t i = 0; i < n; i++) {
            low = fmin(low, site[i].at[axis]);
            high = fmax(high, site[i].at[axis]);
        }
        extent[axis] = high / 2 - low / 2;
    }
    return extent[1] > extent[0];
}

/* Divides n sites into parts first .. first + n_parts - 1. The depth of the recursion is the logarithm of n_parts. */
static void bisect(struct work *w, struct site *site, int64_t n, int first, int n_parts)
{
    const int lower = n_parts / 2;
    if (n_parts == 1)
        return;
    const int64_t n_lower = (n * lower + n_parts - 1) / n_parts;
    const int axis = longer_axis(site, n);
    if (n > 0)
        qsort(site, (size_t)n, sizeof *site, axis ? by_y : by_x);
    w->cut[first + lower] = n_lower < n ? (struct cut){axis, site[n_lower]} : (struct cut){.axis = -1};
    bisect(w, site, n_lower, first, lower);
    bisect(w, site + n_lower, n - n_lower, first + lower, n_parts - lower);
}

static bool cut_plane(struct work *w)
{
    const int64_t m = w->grid->n_triangles, step = (m - 1) / MOST_SAMPLES + 1;
    int64_t n = 0;
    w->sample = malloc((size_t)(m / step + 1) * sizeof *w->sample);
    if (!w->sample)
        return false;
    for (int64_t t = 0; t < m; t += step) {
        if (t % TRI_GRID_PERIOD < step)
            tri_grid_evict_pages(w->grid);
        w->sample[n++] = site_of(w, t);
    }
    bisect(w, w->sample, n, 0, w->parts->n);
    free(w->sample);
    return true;
}

static int part_at(const struct work *w, const struct site *site)
{
    int first = 0, n = w->parts->n;
    while (n > 1) {
        const int lower = n / 2;
        const struct cut *cut = &w->cut[first + lower];
        if (cut->axis < 0 || by_axis(cut->axis, site, &cut->site) < 0) {
            n = lower;
        } else {
            first += lower;
            n -= lower;
        }
    }
    return first;
}

/* --- parts of points */

static void add_use(struct work *w, int64_t point, int32_t part)
{
    if (tri_grow_far(&w->use, &w->room, w->n_uses + 1, sizeof *w->use))
        w->use[w->n_uses++] = (struct use){point, part};
    else
        w->no_memory = true;
}

static void note_use(struct work *w, int64_t point, int32_t part)
{
    const int32_t before = w->user[point];
    if (before == part || before == -part)
        return;
    if (before > 0)
        add_use(w, point, before);
    if (before != 0)
        add_use(w, point, part);
    w->user[point] = before == 0 ? part : -part;
}

static bool use_corners(struct work *w)
{
    int64_t nodes[6];
    for (int64_t t = 0; t < w->grid->n_triangles; t++) {
        const struct site site = site_of(w, t);
        w->part[t] = (int16_t)(part_at(w, &site) + 1);
        w->grid->triangle(w->grid->user, t, nodes);
        for (int k = 0; k < w->grid->n_nodes; k++)
            note_use(w, nodes[k], w->part[t]);
    }
    return !w->no_memory;
}

/* --- parts of segments */

static int by_ends(const void *left, const void *right)
{
    const struct edge *a = left, *b = right;
    for (int k = 0; k < 2; k++)
        if (a->ends[k] != b->ends[k])
            return a->ends[k] < b->ends[k] ? -1 : 1;
    return a->segment < b->segment ? -1 : a->segment > b->segment;
}

static struct edge edge_of(int64_t a, int64_t b, int64_t segment)
{
    return (struct edge){{a < b ? a : b, a < b ? b : a}, segment};
}

static bool is_between_shared(const struct work *w, const int64_t ends[2])
{
    return w->user[ends[0]] < 0 && w->user[ends[1]] < 0;
}

/* Assigns segments with an end in only one part to that part. */
static void assign_inner_segments(struct work *w)
{
    for (int64_t s = 0; s < w->grid->n_segments; s++) {
        struct tri_grid_edge segment;
        w->grid->segment(w->grid->user, s, &segment);
        const int32_t a = w->user[segment.ends[0]], b = w->user[segment.ends[1]];
        w->segment_part[s] = a > 0 ? a : b > 0 ? b : 0;
        w->n_edges += a < 0 && b < 0;
    }
}

static bool list_edges(struct work *w)
{
    size_t n = 0;
    w->edge = malloc(w->n_edges * sizeof *w->edge + 1);
    for (int64_t s = 0; w->edge && s < w->grid->n_segments; s++) {
        struct tri_grid_edge segment;
        w->grid->segment(w->grid->user, s, &segment);
        if (is_between_shared(w, segment.ends))
            w->edge[n++] = edge_of(segment.ends[0], segment.ends[1], s);
    }
    if (w->edge)
        qsort(w->edge, n, sizeof *w->edge, by_ends);
    return w->edge;
}

/* Assigns segments with these ends to a part, unless they have a lower one. */
static void assign_edge(struct work *w, const int64_t ends[2], int32_t part)
{
    const struct edge wanted = edge_of(ends[0], ends[1], 0);
    size_t low = 0, high = w->n_edges;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (by_ends(&w->edge[middle], &wanted) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    for (; low < w->n_edges && memcmp(w->edge[low].ends, wanted.ends, sizeof wanted.ends) == 0; low++)
        if (!(w->segment_part[w->edge[low].segment] > 0 && w->segment_part[w->edge[low].segment] < part))
            w->segment_part[w->edge[low].segment] = part;
}

static void assign_by_triangles(struct work *w)
{
    int64_t nodes[6];
    for (int64_t t = 0; w->n_edges > 0 && t < w->grid->n_triangles; t++) {
        w->grid->triangle(w->grid->user, t, nodes);
        for (int k = 0; k < 3; k++) {
            const int64_t ends[2] = {nodes[k], nodes[(k + 1) % 3]};
            if (is_between_shared(w, ends))
                assign_edge(w, ends, w->part[t]);
        }
    }
}

/* Assigns segments that are not edges to a part of an end. Then each part uses both ends of its segments. */
static void assign_loose(struct work *w)
{
    for (int64_t s = 0; s < w->grid->n_segments; s++) {
        struct tri_grid_edge segment;
        w->grid->segment(w->grid->user, s, &segment);
        const int32_t end = abs(w->user[segment.ends[0]]);
        w->segment_part[s] = w->segment_part[s] ? w->segment_part[s] : end ? end : 1;
        for (int k = 0; k < 2; k++)
            note_use(w, segment.ends[k], w->segment_part[s]);
    }
}

static bool assign_segments(struct work *w)
{
    assign_inner_segments(w);
    if (!list_edges(w))
        return false;
    assign_by_triangles(w);
    assign_loose(w);
    return true;
}

/* --- lists */

static int32_t part_of_triangle(const struct work *w, int64_t t) { return w->part[t]; }
static int32_t part_of_segment(const struct work *w, int64_t s) { return w->segment_part[s]; }

/* Points without triangles belong to the first part. Returns 0 for shared points. */
static int32_t part_of_point(const struct work *w, int64_t i)
{
    return w->user[i] == 0 ? 1 : w->user[i] > 0 ? w->user[i] : 0;
}

/* Lists items by part, each as its position in the grouping, ascending. part_of returns the part that lists an item, or
 * 0. */
static void list_by_part(const struct work *w, int64_t n, int32_t (*part_of)(const struct work *w, int64_t item),
                         const struct tri_grouping *groups, int64_t *list, int64_t *first)
{
    int64_t next[TRI_MOST_PARTS + 1];
    for (int64_t i = 0; i < n; i++) {
        const int32_t part = part_of(w, i);
        tri_grid_evict_periodically(w->grid, i);
        if (part > 0)
            first[part - 1]++;
    }
    accumulate(first, w->parts->n);
    memcpy(next, first, sizeof next);
    for (int64_t place = 0; place < n; place++) {
        const int32_t part = part_of(w, tri_grouped(groups, place));
        tri_grid_evict_periodically(w->grid, place);
        if (part > 0)
            list[next[part - 1]++] = place;
    }
}

/* --- shared points */

static int by_point(const void *left, const void *right)
{
    const struct use *a = left, *b = right;
    if (a->point != b->point)
        return a->point < b->point ? -1 : 1;
    return a->part < b->part ? -1 : a->part > b->part;
}

static int compare_parts(const struct tri_shared_point *a, const struct tri_shared_point *b)
{
    for (int32_t k = 0; k < a->n && k < b->n; k++)
        if (a->part[k] != b->part[k])
            return a->part[k] < b->part[k] ? -1 : 1;
    return a->n < b->n ? -1 : a->n > b->n;
}

static int by_parts(const void *left, const void *right)
{
    const struct tri_shared_point *a = left, *b = right;
    const int order = compare_parts(a, b);
    return order ? order : a->point < b->point ? -1 : a->point > b->point;
}

static void list_shared(struct work *w)
{
    struct tri_parts *p = w->parts;
    for (int64_t i = 0; i < w->n_uses; i++) {
        const struct use *use = &w->use[i];
        p->part_list[i] = use->part - 1;
        if (i == 0 || use->point != use[-1].point)
            p->shared[p->n_shared++] = (struct tri_shared_point){use->point, 0, &p->part_list[i]};
        p->shared[p->n_shared - 1].n++;
    }
    qsort(p->shared, (size_t)p->n_shared, sizeof *p->shared, by_parts);
    for (int64_t i = 0; i < p->n_shared; i++)
        if (i == 0 || compare_parts(&p->shared[i - 1], &p->shared[i]) != 0)
            p->first_shared[p->n_interfaces++] = i;
    p->first_shared[p->n_interfaces] = p->n_shared;
}

/* Sorts the uses and removes duplicates: a point may have been noted several times for a part. */
static void sort_uses(struct work *w)
{
    int64_t n = 0;
    if (w->n_uses > 0)
        qsort(w->use, (size_t)w->n_uses, sizeof *w->use, by_point);
    for (int64_t i = 0; i < w->n_uses; i++)
        if (n == 0 || by_point(&w->use[n - 1], &w->use[i]) != 0)
            w->use[n++] = w->use[i];
    w->n_uses = n;
}

static bool make_lists(struct work *w, const struct tri_grouping *surfaces, const struct tri_grouping *curves)
{
    struct tri_parts *p = w->parts;
    sort_uses(w);
    p->part_list = malloc((size_t)w->n_uses * sizeof *p->part_list + 1);
    p->shared = malloc((size_t)w->n_uses * sizeof *p->shared + 1);
    p->first_shared = malloc((size_t)(w->n_uses + 1) * sizeof *p->first_shared);
    if (w->no_memory || !p->part_list || !p->shared || !p->first_shared)
        return false;
    list_by_part(w, w->grid->n_points, part_of_point, &(struct tri_grouping){0}, p->inner, p->first_inner);
    list_by_part(w, w->grid->n_triangles, part_of_triangle, surfaces, p->triangle, p->first_triangle);
    list_by_part(w, w->grid->n_segments, part_of_segment, curves, p->segment, p->first_segment);
    list_shared(w);
    return true;
}

/* --- the whole division */

static enum tri_status allocate_lists(struct work *w, struct tri_error *error)
{
    const struct tri_grid *g = w->grid;
    struct tri_parts *p = w->parts;
    w->part = allocate_room(p->storage, g->n_triangles, sizeof *w->part);
    w->user = allocate_room(p->storage, g->n_points, sizeof *w->user);
    w->segment_part = allocate_room(p->storage, g->n_segments, sizeof *w->segment_part);
    p->triangle = allocate_room(p->storage, g->n_triangles, sizeof *p->triangle);
    p->inner = allocate_room(p->storage, g->n_points, sizeof *p->inner);
    p->segment = allocate_room(p->storage, g->n_segments, sizeof *p->segment);
    if (!w->part || !w->user || !w->segment_part || !p->triangle || !p->inner || !p->segment)
        return tri_fail_system(error, TRI_NO_MEMORY, NULL, "no room to cut a mesh into parts", errno);
    for (int64_t i = 0; i < g->n_points; i++) {
        tri_grid_evict_periodically(g, i);
        w->user[i] = 0;
    }
    return TRI_OK;
}

enum tri_status tri_parts_make(struct tri_parts *parts, int n, const struct tri_grid *grid,
                               const struct tri_grouping *surfaces, const struct tri_grouping *curves,
                               struct tri_error *error)
{
    assert(1 <= n && n <= TRI_MOST_PARTS);
    *parts = (struct tri_parts){.n = n, .storage = grid->storage};
    struct work w = {.parts = parts, .grid = grid};
    enum tri_status status = allocate_lists(&w, error);
    if (!status && !(cut_plane(&w) && use_corners(&w) && assign_segments(&w) && make_lists(&w, surfaces, curves)))
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory to cut a mesh into parts");
    free_room(parts->storage, w.part);
    free_room(parts->storage, w.user);
    free_room(parts->storage, w.segment_part);
    free(w.use);
    free(w.edge);
    return status;
}

void tri_parts_free(struct tri_parts *parts)
{
    free_room(parts->storage, parts->triangle);
    free_room(parts->storage, parts->inner);
    free_room(parts->storage, parts->segment);
    free(parts->shared);
    free(parts->part_list);
    free(parts->first_shared);
    *parts = (struct tri_parts){0};
}

bool tri_part_has_interface(const struct tri_parts *p, int part, int64_t interface)
{
    const struct tri_shared_point *point = &p->shared[p->first_shared[interface]];
    for (int32_t k = 0; k < point->n; k++)
        if (point->part[k] == part)
            return true;
    return false;
}
