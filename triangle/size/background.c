/* Lengths at the vertices of a background mesh, linear in its triangles.
 *
 * The triangles compete for each point by their distance from it (candidates.h). Inside a triangle the distance is
 * 0; outside all triangles, the nearest point of the nearest triangle counts. So triangles may overlap, leave gaps,
 * be flat, and have either orientation. Gradients are limited along the edges (spread.c). */
#include "triangle/size/sources.h"

#include "triangle/base/hash.h"
#include "triangle/base/heap_sort.h"

/* In cells with sides up to SMALL * h, the chosen triangle may be TOLERANCE * h farther away than the nearest one. */
static const double SMALL = 0.5, TOLERANCE = 0.01;

/* The nearest point found so far. */
struct nearest {
    double distance2; /* squared distance from the query; infinite: none yet */
    double length;    /* length at that point */
    struct tri_point away; /* vector from the query to that point */
};

static void ask_edge(const struct tri_background *b, int32_t from, int32_t to, struct tri_point p, struct nearest *near)
{
    const struct tri_point a = b->at[from], along = {b->at[to].x - a.x, b->at[to].y - a.y};
    const double l2 = along.x * along.x + along.y * along.y;
    const double dot = (p.x - a.x) * along.x + (p.y - a.y) * along.y;
    const double t = dot > 0 ? tri_lesser(dot / l2, 1) : 0; /* l2 is above 0 if dot is */
    const struct tri_point away = {a.x + t * along.x - p.x, a.y + t * along.y - p.y};
    const double d2 = away.x * away.x + away.y * away.y;
    if (d2 < near->distance2)
        *near = (struct nearest){d2, (1 - t) * b->length[from] + t * b->length[to], away};
}

static double twice_area(struct tri_point a, struct tri_point b, struct tri_point c)
{
    return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
}

/* Updates *near if a point of the triangle is nearer. */
static void ask_triangle(const struct tri_background *b, int32_t t, struct tri_point p, struct nearest *near)
{
    const int32_t *v = b->corner + 3 * (size_t)t;
    const double w0 = twice_area(p, b->at[v[1]], b->at[v[2]]), w1 = twice_area(p, b->at[v[2]], b->at[v[0]]);
    const double w2 = twice_area(p, b->at[v[0]], b->at[v[1]]), sum = w0 + w1 + w2;
    if (w0 >= 0 && w1 >= 0 && w2 >= 0 && sum > 0) {
        const double length = (w0 * b->length[v[0]] + w1 * b->length[v[1]] + w2 * b->length[v[2]]) / sum;
        *near = (struct nearest){0, length, {0, 0}};
        return;
    }
    for (int k = 0; k < 3; k++)
        ask_edge(b, v[k], v[tri_next[k]], p, near);
}

static struct tri_key key(const void *user, int32_t triangle, struct tri_point p)
{
    struct nearest near = {.distance2 = HUGE_VAL};
    ask_triangle(user, triangle, p, &near);
    return tri_key_of_distance(0, 1, near.away);
}

static double allowed(const void *user, int32_t winner, double distance, double side)
{
    const struct tri_background *b = user;
    const int32_t *v = b->corner + 3 * (size_t)winner;
    const double least = tri_lesser(tri_lesser(b->length[v[0]], b->length[v[1]]), b->length[v[2]]);
    (void)distance;
    return side <= SMALL * least ? TOLERANCE * least : 0;
}

/* Drops triangles that data cannot reach, and makes the others counter-clockwise. */
static void settle_triangles(struct tri_background *b)
{
    int32_t n = 0;
    for (int32_t t = 0; t < b->n_triangles; t++) {
        const int32_t *v = b->corner + 3 * (size_t)t;
        const bool is_turned = twice_area(b->at[v[0]], b->at[v[1]], b->at[v[2]]) < 0;
        const int32_t turned[3] = {v[0], v[is_turned ? 2 : 1], v[is_turned ? 1 : 2]};
        if (b->length[v[0]] > 0 && b->length[v[1]] > 0 && b->length[v[2]] > 0)
            memcpy(b->corner + 3 * (size_t)n++, turned, sizeof turned);
    }
    b->n_triangles = n;
}

static bool copy_field(struct tri_background *b, const struct tri_size_field *f, const struct tri_size_frame *frame)
{
    const double unit = frame->mesh->unit;
    b->n = (int32_t)f->points.n;
    b->n_triangles = f->triangles.n > 0 ? (int32_t)f->triangles.n : b->n;
    b->at = malloc((size_t)b->n * sizeof *b->at);
    b->length = malloc((size_t)b->n * sizeof *b->length);
    b->corner = malloc(3 * (size_t)b->n_triangles * sizeof *b->corner);
    if (!b->at || !b->length || !b->corner)
        return false;
    for (int64_t v = 0; v < b->n; v++) {
        const double *p = f->points.at + v * f->points.stride;
        b->at[v] = (struct tri_point){p[0] / unit, p[1] / unit};
        b->length[v] = tri_size_of(frame, f->values.at[v * f->values.stride]);
    }
    for (int64_t t = 0; t < b->n_triangles; t++)
        for (int k = 0; k < 3; k++) /* points without triangles become flat triangles */
            b->corner[3 * t + k] = f->triangles.n > 0 ? f->triangles.at[t * f->triangles.stride + k] : (int32_t)t;
    return true;
}

static bool is_before(const void *background, int32_t v, int32_t w)
{
    const struct tri_background *b = background;
    const int order = tri_compare_places(b->at[v], b->at[w]);
    return order < 0 || (order == 0 && v < w);
}

/* Merges points at the same position into one corner with the smallest length. Some formats do not share points
 * between triangles, and lengths must propagate between them. Returns false if memory ran out. */
static bool merge_coincident(struct tri_background *b)
{
    int32_t *order = malloc(2 * (size_t)b->n * sizeof *order), *first = order + b->n;
    for (int32_t i = 0; order && i < b->n; i++)
        order[i] = i;
    if (order)
        tri_heap_sort(order, b->n, is_before, b);
    for (int32_t i = 0; order && i < b->n; i++) {
        const int32_t v = order[i], before = i > 0 ? first[order[i - 1]] : v;
        first[v] = tri_compare_places(b->at[before], b->at[v]) == 0 ? before : v;
        double *least = &b->length[first[v]];
        *least = *least > 0 && !(b->length[v] > 0 && b->length[v] < *least) ? *least : b->length[v];
    }
    for (int64_t k = 0; order && k < 3 * (int64_t)b->n_triangles; k++)
        b->corner[k] = first[b->corner[k]];
    const bool memory = order != NULL;
    free(order);
    return memory;
}

/* Clears the lengths of vertices that belong to no triangle. Returns false if memory ran out. */
static bool clear_unused(struct tri_background *b)
{
    bool *used = calloc((size_t)b->n, sizeof *used);
    for (int64_t k = 0; used && k < 3 * (int64_t)b->n_triangles; k++)
        used[b->corner[k]] = true;
    for (int32_t v = 0; used && v < b->n; v++)
        b->length[v] = used[v] ? b->length[v] : 0;
    const bool memory = used != NULL;
    free(used);
    return memory;
}

enum tri_status tri_background_make(struct tri_background *background, const struct tri_size_field *field,
                                    const struct tri_size_frame *frame, struct tri_error *error)
{
    struct tri_background *b = background;
    const struct tri_stop *stop = frame->mesh->stop;
    const struct tri_contest contest = {key, allowed, b};
    bool has_data;
    *b = (struct tri_background){0};
    enum tri_status status = copy_field(b, field, frame) && clear_unused(b) && merge_coincident(b)
                                 ? TRI_OK
                                 : tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for sizes");
    const struct tri_spreading cells = {b->at, b->n, b->corner, b->n_triangles, 3};
    if (!status)
        status = tri_spread_lengths(&cells, b->length, frame->gradation, &has_data, stop, error);
    if (!status && !has_data)
        status = tri_fail(error, TRI_BAD_INPUT, NULL, 0, "no vertex of a triangle has a length above 0");
    if (!status) {
        settle_triangles(b);
        status = tri_candidates_make(&b->candidates, &contest, b->n_triangles, frame, error);
    }
    if (status)
        tri_background_clear(b);
    return status;
}

double tri_background_at(const struct tri_background *b, struct tri_point p)
{
    int32_t n;
    const int32_t *list = tri_candidates_at(&b->candidates, p, &n);
    struct nearest near = {.distance2 = HUGE_VAL};
    for (int32_t i = 0; i < n && near.distance2 > 0; i++)
        ask_triangle(b, list[i], p, &near);
    return near.length;
}

uint64_t tri_background_hash(const struct tri_background *b, uint64_t hash)
{
    hash = tri_hash(hash, b->at, (size_t)b->n * sizeof *b->at);
    hash = tri_hash(hash, b->length, (size_t)b->n * sizeof *b->length);
    return tri_hash(hash, b->corner, 3 * (size_t)b->n_triangles * sizeof *b->corner);
}

void tri_background_clear(struct tri_background *b)
{
    free(b->at);
    free(b->length);
    free(b->corner);
    tri_candidates_clear(&b->candidates);
    *b = (struct tri_background){0};
}
