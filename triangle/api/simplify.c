/* Points, then hole points, then region points are the items of one list, so that one grid finds them all. */
#include "triangle/api/simplify.h"

#include <stdlib.h>
#include <string.h>

#include "triangle/api/generate.h"
#include "triangle/geometry/predicates.h"

enum { MOST_PASSES = 20 };

static const double NEAR = 0.1; /* nearest distance of a new segment to other items, as a share of L */
static const double COS_SHARP = 0.8660254037844386; /* of 30 degrees */

/* A corner in the queue. The entry is outdated if the corner has another age. */
struct waiting {
    double area;    /* of the triangle of the corner and its neighbours */
    int32_t v, age; /* the corner, and its age when it was queued */
};

struct simplifying {
    struct tri_pslg *pslg; /* the input, which is changed */
    double least;         /* L, in units of the mesh */
    struct tri_point *at; /* [n_items] positions, likewise */
    int32_t n_items;      /* number of points, hole points and region points */
    bool *gone;           /* [n_items] the item is removed */
    bool *unused;         /* [n_segments] likewise for a segment, or it has no two ends */
    bool *is_free;        /* [n_points] the point may be removed, if its neighbours allow that */
    int32_t *age;         /* [n_points] changes of the point's neighbours */
    int32_t *first, *next; /* [n_points], [2 * n_segments] lists of the ends at each point; end 2 s + k is
                              segments[2 s + k]; -1: none */
    struct waiting *heap; /* [n_heap] smallest area first; at most 2 * n_points: a removal replaces one by two */
    int64_t n_heap;
    /* A grid of columns * rows cells: the items of cell c are item[start[c] .. start[c + 1]). */
    struct tri_point low; /* lower left corner */
    double cell;          /* width of a cell */
    int32_t columns, rows, *start, *item;
    struct tri_simplify_report report; /* counts so far */
};

static enum tri_status no_memory(struct tri_error *error)
{
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory to simplify segments");
}

/* --- chains */

static int32_t other_end(const struct simplifying *s, int32_t end) { return s->pslg->segments[end ^ 1]; }

static int32_t marker_of(const int32_t *markers, int32_t i) { return markers ? markers[i] : 0; }

/* Do exactly two segments end here, with usual markers? A removal changes this at no other point. */
static bool joins_two(const struct simplifying *s, int32_t v)
{
    const int32_t *markers = s->pslg->markers, *of_segments = s->pslg->segment_markers;
    const int32_t end = s->first[v], second = end < 0 ? -1 : s->next[end];
    if (second < 0 || s->next[second] >= 0 || marker_of(of_segments, end / 2) != marker_of(of_segments, second / 2))
        return false;
    const int32_t mine = marker_of(markers, v);
    return mine == 0 || mine == marker_of(of_segments, end / 2) ||
           (mine == marker_of(markers, other_end(s, end)) && mine == marker_of(markers, other_end(s, second)));
}

static bool are_joined(const struct simplifying *s, int32_t a, int32_t b)
{
    for (int32_t end = s->first[a]; end >= 0; end = s->next[end])
        if (other_end(s, end) == b)
            return true;
    return false;
}

static void make_chains(struct simplifying *s)
{
    const struct tri_pslg *p = s->pslg;
    for (int32_t v = 0; v < p->n_points; v++)
        s->first[v] = -1;
    for (int32_t i = 0; i < p->n_segments; i++) {
        const int32_t *v = &p->segments[2 * (size_t)i];
        s->unused[i] = v[0] < 0 || v[1] < 0 || v[0] >= p->n_points || v[1] >= p->n_points || v[0] == v[1];
        for (int k = 0; k < 2 && !s->unused[i]; k++) {
            s->next[2 * i + k] = s->first[v[k]];
            s->first[v[k]] = 2 * i + k;
        }
    }
}

/* Finds the points that may be removed. pieces: number of subsegments of each segment. Ends of segments that meet
 * others on the way stay. So do points on other segments, and at the place of another. */
static void find_free_points(struct simplifying *s, const struct tri_mesh *mesh, const int32_t *pieces)
{
    const struct tri_pslg *p = s->pslg;
    for (int32_t v = 0; v < p->n_points; v++)
        s->is_free[v] = joins_two(s, v);
    for (tri_sub_id i = 0; i < mesh->n_subs; i++) {
        const int32_t segment = mesh->parents[mesh->sub[i].parent].segment;
        for (int k = 0; k < 2 && segment >= 0 && pieces[segment] != 1; k++) {
            const tri_vertex_id v = mesh->sub[i].v[k];
            if (v < p->n_points)
                s->is_free[tri_point_of(mesh, v)] = false;
        }
    }
    for (int32_t v = 0; mesh->twin && v < p->n_points; v++) {
        const int32_t twin = mesh->twin[v];
        for (int k = 0; k < 2 && twin != v; k++)
            s->is_free[tri_point_of(mesh, k ? twin : v)] = false;
    }
}

/* Triangulates the whole hull: which segments meet others, and the unit of coordinates. */
static enum tri_status examine(struct simplifying *s, const struct tri_executor *executor, const struct tri_stop *stop,
                               struct tri_error *error)
{
    const struct tri_pslg *p = s->pslg;
    struct tri_options options = tri_defaults();
    options.use_segments = options.keep_hull = options.ignore_holes = true;
    options.executor = executor;
    options.stop = stop;
    struct tri_mesh mesh = {0};
    struct tri_report report;
    enum tri_status status = tri_generate(&mesh, p, &options, &report, error);
    int32_t *pieces = status ? NULL : calloc((size_t)p->n_segments + 1, sizeof *pieces);
    if (pieces) {
        for (tri_sub_id i = 0; i < mesh.n_subs; i++) {
            const int32_t segment = mesh.parents[mesh.sub[i].parent].segment;
            if (segment >= 0)
                pieces[segment]++;
        }
        find_free_points(s, &mesh, pieces);
        s->least /= mesh.unit;
        for (int32_t i = 0; i < s->n_items; i++) {
            const int32_t hole = i - p->n_points, region = hole - p->n_holes;
            const double *at = hole < 0 ? &p->points[2 * (size_t)i] : region < 0 ? &p->holes[2 * (size_t)hole]
                                                                                : &p->regions[4 * (size_t)region];
            s->at[i] = tri_to_units(&mesh, at[0], at[1]);
        }
    } else if (!status) {
        status = no_memory(error);
    }
    free(pieces);
    tri_mesh_free(&mesh);
    return status;
}

/* --- the grid */

static void extend(struct tri_point *low, struct tri_point *high, struct tri_point p)
{
    *low = (struct tri_point){tri_lesser(low->x, p.x), tri_lesser(low->y, p.y)};
    *high = (struct tri_point){tri_larger(high->x, p.x), tri_larger(high->y, p.y)};
}

/* Returns the column or row of a coordinate. */
static int32_t cell_of(const struct simplifying *s, double from_low, int32_t n)
{
    return (int32_t)tri_lesser(tri_larger(from_low / s->cell, 0), n - 1);
}

static int32_t cell_at(const struct simplifying *s, struct tri_point p)
{
    return cell_of(s, p.y - s->low.y, s->rows) * s->columns + cell_of(s, p.x - s->low.x, s->columns);
}

/* Sorts the points, and hole and region points that are not outside them all, into cells. Returns false if memory ran
 * out. */
static bool fill_grid(struct simplifying *s)
{
    const int32_t n = s->pslg->n_points;
    struct tri_point high = s->low = s->at[0];
    for (int32_t v = 1; v < n; v++)
        extend(&s->low, &high, s->at[v]);
    const double width = high.x - s->low.x, height = high.y - s->low.y;
    s->cell = tri_larger(sqrt(width * height / n), tri_larger(width, height) / n);
    s->columns = 1 + (int32_t)(width / s->cell);
    s->rows = 1 + (int32_t)(height / s->cell);
    const size_t cells = (size_t)s->columns * (size_t)s->rows;
    s->start = calloc(cells + 2, sizeof *s->start);
    if (!s->start)
        return false;
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t i = 0; i < s->n_items; i++) {
            const struct tri_point p = s->at[i];
            if (!(p.x >= s->low.x && p.x <= high.x && p.y >= s->low.y && p.y <= high.y))
                continue;
            int32_t *at = &s->start[cell_at(s, p) + 2 - pass];
            if (pass)
                s->item[*at] = i;
            ++*at;
        }
        for (size_t c = 0; c < cells && !pass; c++)
            s->start[c + 2] += s->start[c + 1];
    }
    return true;
}

/* Calls `test` for the remaining items in a box until it returns true. Returns whether it did. */
static bool any_in_box(struct simplifying *s, struct tri_point low, struct tri_point high,
                       bool (*test)(struct simplifying *s, const void *user, int32_t i), const void *user)
{
    const int32_t left = cell_of(s, low.x - s->low.x, s->columns), right = cell_of(s, high.x - s->low.x, s->columns);
    const int32_t top = cell_of(s, high.y - s->low.y, s->rows);
    for (int32_t row = cell_of(s, low.y - s->low.y, s->rows); row <= top; row++)
        for (int32_t k = s->start[row * s->columns + left]; k < s->start[row * s->columns + right + 1]; k++)
            if (!s->gone[s->item[k]] && test(s, user, s->item[k]))
                return true;
    return false;
}

/* --- corners */

/* Is item i in the closed triangle of corners, or does it come too near to its side from corner 0 to corner 2? */
static bool is_in_the_way(struct simplifying *s, const void *corners, int32_t i)
{
    const int32_t *v = corners;
    const struct tri_point a = s->at[v[0]], b = s->at[v[1]], c = s->at[v[2]], p = s->at[i];
    if (i == v[0] || i == v[1] || i == v[2])
        return false;
    const double ab = tri_orient2d(a, b, p), bc = tri_orient2d(b, c, p), ca = tri_orient2d(c, a, p);
    const bool is_flat = ab == 0 && bc == 0 && ca == 0; /* the corner is free, so p lies on none of its segments */
    if (!is_flat && ((ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0)))
        return true;
    const double near2 = tri_segment_distance2(a, c, p);
    return near2 < NEAR * NEAR * s->least * s->least &&
           near2 < 0.25 * tri_lesser(tri_segment_distance2(a, b, p), tri_segment_distance2(b, c, p));
}

/* Would the new segment make an angle below 30 degrees at one of its ends? v: the ends, with the corner between. */
static bool makes_sharp(const struct simplifying *s, const int32_t v[3])
{
    for (int k = 0; k < 3; k += 2)
        for (int32_t end = s->first[v[k]]; end >= 0; end = s->next[end]) {
            const struct tri_point a = s->at[v[k]], b = s->at[other_end(s, end)], c = s->at[v[2 - k]];
            const double dot = (b.x - a.x) * (c.x - a.x) + (b.y - a.y) * (c.y - a.y);
            if (other_end(s, end) != v[1] && dot > COS_SHARP * sqrt(tri_distance2(a, b) * tri_distance2(a, c)))
                return true;
        }
    return false;
}

/* Is the corner simple enough to be removed, apart from what lies nearby? Sets the corners of its triangle. */
static bool is_detail(const struct simplifying *s, int32_t b, int32_t v[3], double *area)
{
    if (s->gone[b] || !s->is_free[b])
        return false;
    v[0] = other_end(s, s->first[b]);
    v[1] = b;
    v[2] = other_end(s, s->next[s->first[b]]);
    const struct tri_point *at = s->at;
    *area = fabs(tri_area_of(at[v[0]], at[b], at[v[2]]));
    if (v[0] == v[2] || are_joined(s, v[0], v[2]))
        return false;
    const double least2 = s->least * s->least;
    const double shortest2 = tri_lesser(tri_distance2(at[v[0]], at[b]), tri_distance2(at[b], at[v[2]]));
    return *area < least2 / 2 || (shortest2 < least2 && !makes_sharp(s, v));
}

static bool is_before(const struct waiting *a, const struct waiting *b)
{
    return a->area < b->area || (a->area == b->area && a->v < b->v);
}

/* Queues the corner if it is a detail. */
static void queue_corner(struct simplifying *s, int32_t b)
{
    int32_t v[3];
    struct waiting w = {.v = b, .age = ++s->age[b]};
    if (!is_detail(s, b, v, &w.area))
        return;
    int64_t i = s->n_heap++;
    for (; i > 0 && is_before(&w, &s->heap[(i - 1) / 2]); i = (i - 1) / 2)
        s->heap[i] = s->heap[(i - 1) / 2];
    s->heap[i] = w;
}

static struct waiting next_corner(struct simplifying *s)
{
    const struct waiting top = s->heap[0], last = s->heap[--s->n_heap];
    int64_t i = 0;
    for (int64_t child; (child = 2 * i + 1) < s->n_heap; i = child) {
        child += child + 1 < s->n_heap && is_before(&s->heap[child + 1], &s->heap[child]);
        if (!is_before(&s->heap[child], &last))
            break;
        s->heap[i] = s->heap[child];
    }
    s->heap[i] = last;
    return top;
}

/* Extends the first segment at the corner to the second one's other end, and removes the second. */
static void remove_corner(struct simplifying *s, int32_t b)
{
    const int32_t kept = s->first[b], dropped = s->next[kept] ^ 1, c = s->pslg->segments[dropped];
    int32_t *link = &s->first[c];
    while (*link != dropped)
        link = &s->next[*link];
    s->pslg->segments[kept] = c;
    s->next[kept] = s->next[dropped];
    *link = kept;
    s->unused[dropped / 2] = true;
    s->gone[b] = true;
}

/* Removes corners until none remains that can be removed at once. */
static void remove_corners(struct simplifying *s)
{
    for (int32_t v = 0; v < s->pslg->n_points; v++)
        queue_corner(s, v);
    while (s->n_heap > 0) {
        const struct waiting w = next_corner(s);
        int32_t v[3];
        double area;
        if (w.age != s->age[w.v] || !is_detail(s, w.v, v, &area))
            continue;
        const double room = NEAR * s->least;
        struct tri_point low = s->at[w.v], high = low;
        extend(&low, &high, s->at[v[0]]);
        extend(&low, &high, s->at[v[2]]);
        low = (struct tri_point){low.x - room, low.y - room};
        high = (struct tri_point){high.x + room, high.y + room};
        if (any_in_box(s, low, high, is_in_the_way, v))
            continue;
        remove_corner(s, w.v);
        s->report.corners++;
        queue_corner(s, v[0]);
        queue_corner(s, v[2]);
    }
}

/* --- islands */

struct ring {
    int32_t *v;  /* [n] points of the chain, in order */
    int32_t n;
    int32_t *turn; /* [n_points] number of the last chain that contained the point; 0: none */
    int32_t number; /* of the current chain, counted from 1 */
    int32_t before; /* number of the last chain of the pass before */
};

/* Is the item inside the ring, by the number of segments to its right? */
static bool is_enclosed(const struct simplifying *s, const struct ring *ring, int32_t i)
{
    bool inside = false;
    const struct tri_point p = s->at[i];
    for (int32_t k = 0; k < ring->n; k++) {
        const struct tri_point a = s->at[ring->v[k]], b = s->at[ring->v[(k + 1) % ring->n]];
        if ((a.y > p.y) != (b.y > p.y) && (tri_orient2d(a, b, p) > 0) == (b.y > a.y))
            inside = !inside;
    }
    return inside;
}

static bool is_foreign_point(struct simplifying *s, const void *user, int32_t i)
{
    const struct ring *ring = user;
    return i < s->pslg->n_points && ring->turn[i] != ring->number && is_enclosed(s, ring, i);
}

/* Removes a hole or region point inside the ring; returns false, to go on. */
static bool remove_seed(struct simplifying *s, const void *user, int32_t i)
{
    const int32_t hole = i - s->pslg->n_points;
    if (hole < 0 || !is_enclosed(s, user, i))
        return false;
    s->gone[i] = true;
    *(hole < s->pslg->n_holes ? &s->report.holes : &s->report.regions) += 1;
    return false;
}

/* Follows the chain through v. Returns false if it is no closed chain of free points. */
static bool follow_ring(const struct simplifying *s, struct ring *ring, int32_t v)
{
    int32_t end = s->first[v];
    ring->n = 0;
    ring->number++;
    do {
        ring->v[ring->n++] = v;
        ring->turn[v] = ring->number;
        v = other_end(s, end);
        if (!s->is_free[v] || (ring->turn[v] > ring->before && ring->turn[v] != ring->number))
            return false;
        end = s->first[v] == (end ^ 1) ? s->next[s->first[v]] : s->first[v];
    } while (v != ring->v[0]);
    return true;
}

/* Removes the ring if it is small and nothing but hole and region points lies inside. */
static void remove_island(struct simplifying *s, const struct ring *ring)
{
    double area = 0;
    struct tri_point low = s->at[ring->v[0]], high = low;
    for (int32_t k = 1; k < ring->n; k++) {
        const struct tri_point p = s->at[ring->v[k]];
        extend(&low, &high, p);
        if (k > 1)
            area += tri_area_of(s->at[ring->v[0]], s->at[ring->v[k - 1]], p);
    }
    if (!(fabs(area) < s->least * s->least) || any_in_box(s, low, high, is_foreign_point, ring))
        return;
    any_in_box(s, low, high, remove_seed, ring);
    for (int32_t k = 0; k < ring->n; k++) {
        const int32_t v = ring->v[k];
        s->gone[v] = s->unused[s->first[v] / 2] = s->unused[s->next[s->first[v]] / 2] = true;
    }
    s->report.islands++;
    s->report.island_points += ring->n;
}

/* Removes small islands. Those around them follow in the next pass. */
static void remove_islands(struct simplifying *s, struct ring *ring)
{
    ring->before = ring->number;
    for (int32_t v = 0; v < s->pslg->n_points; v++)
        if (!s->gone[v] && s->is_free[v] && ring->turn[v] <= ring->before && follow_ring(s, ring, v))
            remove_island(s, ring);
}

/* --- the result */

/* Moves the rows that remain to the front, if there is an array. Returns their number. */
static int32_t keep_rows(void *rows, size_t size, const bool *gone, int32_t n)
{
    int32_t kept = 0;
    for (int32_t i = 0; i < n && rows; i++)
        if (!gone[i])
            memmove((char *)rows + size * (size_t)kept++, (char *)rows + size * (size_t)i, size);
    return kept;
}

/* Removes what is gone, and counts segments that are still shorter than L. `age` becomes the new numbers of points. */
static void compact(struct simplifying *s)
{
    struct tri_pslg *p = s->pslg;
    const int32_t n = p->n_points, n_holes = p->n_holes;
    for (int32_t v = 0, kept = 0; v < n; v++)
        s->age[v] = s->gone[v] ? -1 : kept++;
    for (int32_t i = 0; i < p->n_segments; i++) {
        int32_t *v = &p->segments[2 * (size_t)i];
        if (s->unused[i])
            continue;
        s->report.shorter += tri_distance2(s->at[v[0]], s->at[v[1]]) < s->least * s->least;
        v[0] = s->age[v[0]];
        v[1] = s->age[v[1]];
    }
    keep_rows(p->attributes, (size_t)p->n_attributes * sizeof *p->attributes, s->gone, n);
    keep_rows(p->markers, sizeof *p->markers, s->gone, n);
    keep_rows(p->segment_markers, sizeof *p->segment_markers, s->unused, p->n_segments);
    p->n_points = keep_rows(p->points, 2 * sizeof *p->points, s->gone, n);
    p->n_segments = keep_rows(p->segments, 2 * sizeof *p->segments, s->unused, p->n_segments);
    p->n_holes = keep_rows(p->holes, 2 * sizeof *p->holes, s->gone + n, n_holes);
    p->n_regions = keep_rows(p->regions, 4 * sizeof *p->regions, s->gone + n + n_holes, p->n_regions);
}

/* Removes islands and corners until nothing changes: a removed corner may have been in the way of others. */
static enum tri_status run_passes(struct simplifying *s, struct ring *ring, const struct tri_stop *stop,
                                  struct tri_error *error)
{
    int32_t before = -1;
    for (int pass = 0; pass < MOST_PASSES && s->report.corners + s->report.islands > before; pass++) {
        before = s->report.corners + s->report.islands;
        if (tri_stop_is_asked(stop))
            return tri_fail_stopped(error);
        remove_islands(s, ring);
        remove_corners(s);
    }
    return TRI_OK;
}

enum tri_status tri_simplify(struct tri_pslg *pslg, double min_edge, const struct tri_executor *executor,
                             const struct tri_stop *stop, struct tri_simplify_report *report, struct tri_error *error)
{
    *report = (struct tri_simplify_report){0};
    if (pslg->n_segments <= 0 || pslg->n_points <= 0)
        return TRI_OK;
    const size_t points = (size_t)pslg->n_points + 1, segments = (size_t)pslg->n_segments + 1;
    const size_t items = points + (size_t)pslg->n_holes + (size_t)pslg->n_regions;
    struct simplifying s = {.pslg = pslg, .least = min_edge, .n_items = (int32_t)(items - 1)};
    struct ring ring = {malloc(points * sizeof *ring.v), 0, calloc(points, sizeof *ring.turn), 0, 0};
    s.at = malloc(items * sizeof *s.at);
    s.gone = calloc(items, sizeof *s.gone);
    s.item = malloc(items * sizeof *s.item);
    s.unused = calloc(segments, sizeof *s.unused);
    s.next = malloc(2 * segments * sizeof *s.next);
    s.is_free = calloc(points, sizeof *s.is_free);
    s.age = calloc(points, sizeof *s.age);
    s.heap = malloc(2 * points * sizeof *s.heap);
    s.first = malloc(points * sizeof *s.first);
    enum tri_status status = TRI_OK;
    if (!ring.v || !ring.turn || !s.at || !s.gone || !s.item || !s.unused || !s.next || !s.is_free || !s.age ||
        !s.first || !s.heap)
        status = no_memory(error);
    if (!status) {
        make_chains(&s);
        status = examine(&s, executor, stop, error);
    }
    if (!status)
        status = fill_grid(&s) ? run_passes(&s, &ring, stop, error) : no_memory(error);
    if (!status)
        compact(&s);
    if (!status && pslg->n_segments == 0)
        status = tri_fail(error, TRI_BAD_INPUT, NULL, 0, "no segment remains after details below %g are removed",
                          min_edge);
    *report = s.report;
    void *const arrays[] = {ring.v, ring.turn, s.at, s.gone, s.item, s.unused, s.next, s.is_free, s.age, s.first,
                            s.heap, s.start};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        free(arrays[i]);
    return status;
}
