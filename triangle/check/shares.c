/* Parts: consecutive triangles and the vertices that are their corners.
 *
 * 1. The corners are read, and their vertices are marked in a bit set with one bit per vertex of the mesh.
 * 2. The local number of vertex v is the number of marked vertices before it, so the order of vertices is kept.
 * 3. Coordinates are read in windows of the mesh that contain marked vertices. */
#include <stdlib.h>
#include <string.h>

#include "triangle/check/internal.h"

enum {
    WINDOW = 1 << 10, /* words */
    SAMPLE = 1 << 14  /* triangles */
};

/* Buffers of a part, in addition to the caller's arrays. They are reused for the next part. */
struct check_room {
    int32_t *triangles;    /* [part_triangles][3] corners by local numbers */
    int64_t *vertex, *neighbors; /* as in struct check_part */
    double *points, *attributes, *window; /* as in struct check_part; coordinates of a window */
    int64_t point_room;    /* allocated number of vertices */
    int64_t first, last;   /* range of words of `marked` that may not be 0 */
    uint64_t *marked;      /* [n_points / 64 + 1] bit set of vertices */
    int32_t *before;       /* [n_points / 64 + 1] marked vertices before each word from first to last */
};

static int count_bits(uint64_t x)
{
    x -= x >> 1 & 0x5555555555555555u;
    x = (x & 0x3333333333333333u) + (x >> 2 & 0x3333333333333333u);
    return (int)(((x + (x >> 4)) & 0x0f0f0f0f0f0f0f0fu) * 0x0101010101010101u >> 56);
}

static int32_t number_of(const struct check_room *r, int64_t v)
{
    uint64_t below = ((uint64_t)1 << (v & 63)) - 1;
    return r->before[v >> 6] + count_bits(r->marked[v >> 6] & below);
}

int32_t tri_check_local(const struct checker *c, int64_t v)
{
    const struct check_room *r = c->part.room;
    return (r->marked[v >> 6] >> (v & 63) & 1) != 0 ? number_of(r, v) : -1;
}

/* Allocates the arrays that every part needs. */
static enum tri_status make_room(struct checker *c)
{
    struct check_part *p = &c->part;
    int64_t n = c->part_triangles;
    p->room = calloc(1, sizeof *p->room);
    p->entry = tri_check_array(3 * n, sizeof *p->entry);
    p->link = tri_check_array(3 * n, sizeof *p->link);
    p->constrained = tri_check_array(3 * n / 8 + 1, 1);
    if (p->room == NULL || p->entry == NULL || p->link == NULL || p->constrained == NULL)
        return TRI_NO_MEMORY;
    struct check_room *r = p->room;
    r->first = 1;
    r->triangles = tri_check_array(3 * n, sizeof *r->triangles);
    r->window = tri_check_array(64 * WINDOW, 2 * sizeof *r->window);
    r->marked = tri_check_zeros(c->n_points / 64 + 1, sizeof *r->marked);
    r->before = tri_check_array(c->n_points / 64 + 1, sizeof *r->before);
    if (check_is_given(c, TRI_CHECK_NEIGHBORS_GIVEN))
        r->neighbors = tri_check_array(3 * n, sizeof *r->neighbors);
    if (check_wants_regions(c))
        r->attributes = tri_check_array(n, sizeof *r->attributes);
    bool room = r->triangles && r->window && r->marked && r->before &&
                (r->neighbors || !check_is_given(c, TRI_CHECK_NEIGHBORS_GIVEN)) &&
                (r->attributes || !check_wants_regions(c));
    return room ? TRI_OK : TRI_NO_MEMORY;
}

void tri_check_release_part(struct checker *c)
{
    struct check_part *p = &c->part;
    free(p->entry_of);
    free(p->entry);
    free(p->link);
    free(p->constrained);
    if (p->room == NULL) {
        *p = (struct check_part){0};
        return;
    }
    void *arrays[] = {p->room->triangles, p->room->vertex, p->room->neighbors, p->room->points, p->room->attributes,
                      p->room->window, p->room->marked, p->room->before};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        free(arrays[i]);
    free(p->room);
    *p = (struct check_part){0};
}

static bool is_no_vertex(const struct checker *c, int64_t h)
{
    int64_t v = c->part.corners[h];
    return v < 0 || v >= c->n_points;
}

static bool judge_corners(struct checker *c)
{
    int64_t first, before = c->report->item[TRI_CHECK_ARRAYS].count;
    int64_t n_bad = tri_check_count(c, 3 * (int64_t)c->part.n_triangles, is_no_vertex, &first);
    if (n_bad == 0)
        return true;
    c->at = 3 * c->part.first + first;
    tri_check_fault(c, TRI_CHECK_ARRAYS, "triangle %ld has corner %ld, which is not a vertex",
                    check_part_triangle(c, (int32_t)(first / 3)), check_number(c, c->part.corners[first]));
    c->at = 0;
    c->report->item[TRI_CHECK_ARRAYS].count = before + n_bad;
    return false;
}

enum tri_status tri_check_sample(struct checker *c, double *vertices)
{
    int64_t n = c->n_triangles < SAMPLE ? c->n_triangles : SAMPLE;
    int64_t *corners = tri_check_array(3 * n, sizeof *corners);
    if (corners == NULL)
        return TRI_NO_MEMORY;
    enum tri_status status = tri_check_read(c, TRI_CHECK_CORNERS, (c->n_triangles - n) / 2, n, corners);
    *vertices = status == TRI_OK && n > 0 ? (double)tri_check_distinct(corners, 3 * n) / (double)n : 1;
    free(corners);
    return status;
}

/* Step 1. */
static void mark_corners(struct check_room *r, const int64_t *corners, int64_t n)
{
    if (r->first <= r->last)
        memset(r->marked + r->first, 0, (size_t)(r->last - r->first + 1) * sizeof *r->marked);
    r->first = INT64_MAX;
    r->last = -1;
    for (int64_t i = 0; i < n; i++) {
        int64_t word = corners[i] >> 6;
        r->marked[word] |= (uint64_t)1 << (corners[i] & 63);
        r->first = word < r->first ? word : r->first;
        r->last = word > r->last ? word : r->last;
    }
}

static void number_corners(void *checker, const struct check_share *share)
{
    const struct checker *c = checker;
    for (int64_t h = share->first; h < share->end; h++)
        c->part.room->triangles[h] = number_of(c->part.room, c->part.corners[h]);
}

/* Step 2. */
static enum tri_status number(struct checker *c)
{
    struct check_room *r = c->part.room;
    int64_t n = 0;
    for (int64_t word = r->first; word <= r->last; word++) {
        r->before[word] = (int32_t)n;
        n += count_bits(r->marked[word]);
    }
    if (n > r->point_room) {
        free(r->vertex);
        free(r->points);
        r->point_room = n + n / 16;
        r->vertex = tri_check_array(r->point_room, sizeof *r->vertex);
        r->points = tri_check_array(r->point_room, 2 * sizeof *r->points);
        if (r->vertex == NULL || r->points == NULL)
            return TRI_NO_MEMORY;
    }
    c->part.n_points = (int32_t)n;
    tri_check_in_shares(c, c->part.n_half_edges, number_corners, c);
    return TRI_OK;
}

/* Step 3 for the words w .. end - 1. */
static enum tri_status read_window(struct checker *c, int64_t w, int64_t end)
{
    struct check_room *r = c->part.room;
    while (w < end && r->marked[w] == 0)
        w++;
    while (end > w && r->marked[end - 1] == 0)
        end--;
    int64_t last = 64 * end < c->n_points ? 64 * end : c->n_points;
    enum tri_status status = w < end ? tri_check_read(c, TRI_CHECK_POINTS, 64 * w, last - 64 * w, r->window) : TRI_OK;
    for (int64_t word = w; word < end && status == TRI_OK; word++) {
        int32_t at = r->before[word];
        uint64_t bits = r->marked[word];
        for (int64_t v = 64 * word; bits != 0; v++, bits >>= 1) {
            if ((bits & 1) == 0)
                continue;
            c->state[v] |= CHECK_USED;
            r->vertex[at] = v;
            memcpy(r->points + 2 * (size_t)at++, r->window + 2 * (v - 64 * w), 2 * sizeof *r->points);
        }
    }
    return status;
}

static enum tri_status read_points(struct checker *c)
{
    const struct check_room *r = c->part.room;
    enum tri_status status = TRI_OK;
    for (int64_t w = r->first; w <= r->last && status == TRI_OK; w += WINDOW)
        status = read_window(c, w, r->last + 1 - w < WINDOW ? r->last + 1 : w + WINDOW);
    return status;
}

static enum tri_status read_part(struct checker *c, bool *good)
{
    struct check_part *p = &c->part;
    struct check_room *r = p->room;
    enum tri_status status = tri_check_read(c, TRI_CHECK_CORNERS, p->first, p->n_triangles, p->corners);
    if (status != TRI_OK || !(*good = judge_corners(c)) || !check_good(c, TRI_CHECK_ARRAYS))
        return status;
    mark_corners(r, p->corners, p->n_half_edges);
    status = number(c);
    if (status == TRI_OK)
        status = read_points(c);
    if (status == TRI_OK && r->neighbors != NULL)
        status = tri_check_read(c, TRI_CHECK_NEIGHBORS_GIVEN, p->first, p->n_triangles, r->neighbors);
    if (status == TRI_OK && r->attributes != NULL)
        status = tri_check_read(c, TRI_CHECK_ATTRIBUTES, p->first, p->n_triangles, r->attributes);
    p->triangles = r->triangles;
    p->points = r->points;
    p->vertex = r->vertex;
    p->neighbors = r->neighbors;
    p->attributes = r->attributes;
    return status;
}

enum tri_status tri_check_load(struct checker *c, int64_t first, bool *good)
{
    struct check_part *p = &c->part;
    *good = true;
    if (p->triangles != NULL && p->first == first)
        return TRI_OK; /* the part is already loaded */
    enum tri_status status = p->room == NULL ? make_room(c) : TRI_OK;
    if (status != TRI_OK)
        return status;
    int64_t left = c->n_triangles - first;
    p->first = first;
    p->n_triangles = (int32_t)(left < c->part_triangles ? left : c->part_triangles);
    p->n_half_edges = 3 * p->n_triangles;
    p->triangles = NULL;
    return read_part(c, good);
}
