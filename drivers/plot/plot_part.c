/* Points are read through a cache of blocks. If numbers are local, as in meshes of ptriangle, each block is read once
 * or twice. A mesh of up to 16 million points fits into the cache. */
#include "drivers/plot/plot.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/grow.h"

enum {
    BLOCK_BITS = 12, /* points in a block */
    BLOCK = 1 << BLOCK_BITS,
    MOST_BLOCKS = 1 << 12,
    SLICE = 1 << 16 /* triangles or segments */
};

int32_t plot_most_triangles(void)
{
#ifdef PTRIANGLE_TESTS
    const char *text = getenv("PTRIANGLE_TEST_TRIANGLES");
    if (text != NULL)
        return (int32_t)strtol(text, NULL, 10);
#endif
    return 1 << 24;
}

struct cache {
    const struct tri_check_source *source;
    struct tri_error *error;
    enum tri_status status;    /* status of the first block that could not be read */
    int64_t n_slots, *block;   /* [n_slots] number of the block in each slot, -1: none */
    double (*points)[BLOCK][2];
};

struct list {
    int64_t n, room, *at;
};

struct part {
    struct cache cache;
    struct plot_box window;
    struct list corners, ends; /* numbers of points, three or two for each item */
    double *attributes;        /* one attribute for each triangle */
    int64_t attribute_room;
    struct plot_density *density;
};

/* --- points */

static enum tri_status cache_begin(struct cache *k, const struct tri_check_source *source, struct tri_error *error)
{
    int64_t n = (source->n_points >> BLOCK_BITS) + 1;
    *k = (struct cache){.source = source, .error = error, .n_slots = n < MOST_BLOCKS ? n : MOST_BLOCKS};
    k->block = malloc((size_t)k->n_slots * sizeof *k->block);
    k->points = malloc((size_t)k->n_slots * sizeof *k->points);
    for (int64_t i = 0; k->block != NULL && i < k->n_slots; i++)
        k->block[i] = -1;
    return k->block != NULL && k->points != NULL ? TRI_OK : plot_no_memory(error);
}

static void cache_end(struct cache *k)
{
    free(k->block);
    free(k->points);
}

/* Returns the position of point v. A point that does not exist, or cannot be read, has no position. */
static const double *place_of(struct cache *k, int64_t v)
{
    static const double nowhere[2] = {NAN, NAN};
    if (v < 0 || v >= k->source->n_points || k->status != TRI_OK)
        return nowhere;
    const int64_t block = v >> BLOCK_BITS, slot = block % k->n_slots, first = block << BLOCK_BITS;
    if (k->block[slot] != block) {
        int64_t left = k->source->n_points - first;
        k->block[slot] = block;
        k->status = k->source->read(k->source->user, TRI_CHECK_POINTS, first, left < BLOCK ? left : BLOCK,
                                    k->points[slot], k->error);
    }
    return k->status == TRI_OK ? k->points[slot][v - first] : nowhere;
}

enum tri_status plot_part_box(const struct tri_check_source *source, struct plot_box *box, struct tri_error *error)
{
    double(*points)[2] = malloc(SLICE * sizeof *points);
    enum tri_status status = points != NULL ? TRI_OK : plot_no_memory(error);
    *box = plot_box_empty;
    for (int64_t i = 0; i < source->n_points && !status; i += SLICE) {
        int64_t n = source->n_points - i < SLICE ? source->n_points - i : SLICE;
        status = source->read(source->user, TRI_CHECK_POINTS, i, n, points, error);
        for (int64_t k = 0; k < n && !status; k++)
            plot_box_extend(box, points[k]);
    }
    free(points);
    *box = plot_box_widened(*box);
    return status;
}

/* --- visible parts */

/* Returns true if the box around n points overlaps the window. */
static bool shows(struct part *p, const int64_t *v, int n)
{
    struct plot_box box = plot_box_empty;
    for (int k = 0; k < n; k++)
        plot_box_extend(&box, place_of(&p->cache, v[k]));
    return plot_boxes_meet(&box, &p->window);
}

static enum tri_status add(struct list *list, const int64_t *v, int n, struct tri_error *error)
{
    if (!tri_grow_far(&list->at, &list->room, list->n + n, sizeof *list->at))
        return plot_no_memory(error);
    memcpy(list->at + list->n, v, (size_t)n * sizeof *v);
    list->n += n;
    return TRI_OK;
}

static enum tri_status add_attribute(struct part *p, double value, struct tri_error *error)
{
    int64_t n = p->corners.n / 3; /* including this one */
    if (!tri_grow_far(&p->attributes, &p->attribute_room, n, sizeof *p->attributes))
        return plot_no_memory(error);
    p->attributes[n - 1] = value;
    return TRI_OK;
}

static enum tri_status take_triangle(struct part *p, const int64_t *v, const double *attribute, struct tri_error *error)
{
    if (!shows(p, v, 3))
        return TRI_OK;
    if (p->corners.n / 3 >= plot_most_triangles())
        return tri_fail(error, TRI_TOO_LARGE, "", 0, "there are more than %d triangles to draw",
                        (int)plot_most_triangles());
    enum tri_status status = add(&p->corners, v, 3, error);
    return !status && attribute != NULL ? add_attribute(p, *attribute, error) : status;
}

static void count_triangle(struct part *p, const int64_t *v)
{
    double corner[3][2];
    const double *at[3];
    for (int k = 0; k < 3; k++) /* a later point may evict it from the cache */
        at[k] = memcpy(corner[k], place_of(&p->cache, v[k]), sizeof corner[k]);
    plot_density_add(p->density, at);
}

static enum tri_status each_triangle(struct part *p, int64_t *corners, double *attributes, struct tri_error *error)
{
    const struct tri_check_source *source = p->cache.source;
    enum tri_status status = TRI_OK;
    for (int64_t t = 0; t < source->n_triangles && !status; t += SLICE) {
        int64_t n = source->n_triangles - t < SLICE ? source->n_triangles - t : SLICE;
        status = source->read(source->user, TRI_CHECK_CORNERS, t, n, corners, error);
        if (!status && attributes != NULL)
            status = source->read(source->user, TRI_CHECK_ATTRIBUTES, t, n, attributes, error);
        for (int64_t i = 0; i < n && !status; i++) {
            if (p->density != NULL)
                count_triangle(p, corners + 3 * i);
            else
                status = take_triangle(p, corners + 3 * i, attributes != NULL ? attributes + i : NULL, error);
        }
        status = status ? status : p->cache.status;
    }
    return status;
}

static enum tri_status each_segment(struct part *p, int64_t *ends, struct tri_error *error)
{
    const struct tri_check_source *source = p->cache.source;
    enum tri_status status = TRI_OK;
    for (int64_t s = 0; s < source->n_segments && !status; s += SLICE) {
        int64_t n = source->n_segments - s < SLICE ? source->n_segments - s : SLICE;
        status = source->read(source->user, TRI_CHECK_SEGMENT_ENDS, s, n, ends, error);
        for (int64_t i = 0; i < n && !status; i++)
            status = shows(p, ends + 2 * i, 2) ? add(&p->ends, ends + 2 * i, 2, error) : TRI_OK;
        status = status ? status : p->cache.status;
    }
    return status;
}

/* --- renumbering of the collected points */

static int compare_numbers(const void *a, const void *b)
{
    int64_t p = *(const int64_t *)a, q = *(const int64_t *)b;
    return (p > q) - (p < q);
}

int64_t plot_distinct(int64_t *number, int64_t n)
{
    int64_t kept = 0;
    qsort(number, (size_t)n, sizeof *number, compare_numbers);
    for (int64_t i = 0; i < n; i++)
        if (i == 0 || number[i] != number[i - 1])
            number[kept++] = number[i];
    return kept;
}

static void translate(const struct list *list, const int64_t *vertex, int64_t n, int32_t *out)
{
    for (int64_t i = 0; i < list->n; i++) {
        const int64_t *found = bsearch(&list->at[i], vertex, (size_t)n, sizeof *vertex, compare_numbers);
        out[i] = (int32_t)(found - vertex);
    }
}

static enum tri_status number(struct part *p, struct tri_pslg *mesh, struct tri_elements *elements,
                              struct tri_error *error)
{
    const bool points_alone = p->cache.source->n_triangles == 0;
    int64_t n = points_alone ? p->cache.source->n_points : p->corners.n + p->ends.n;
    int64_t *vertex = malloc((size_t)(n + 1) * sizeof *vertex);
    mesh->segments = malloc((size_t)(p->ends.n + 1) * sizeof *mesh->segments);
    elements->corners = malloc((size_t)(p->corners.n + 1) * sizeof *elements->corners);
    mesh->points = malloc((size_t)(2 * n + 1) * sizeof *mesh->points);
    enum tri_status status =
        vertex && mesh->segments && elements->corners && mesh->points ? TRI_OK : plot_no_memory(error);
    for (int64_t i = 0; i < n && !status; i++)
        vertex[i] = points_alone ? i : i < p->corners.n ? p->corners.at[i] : p->ends.at[i - p->corners.n];
    n = status ? 0 : plot_distinct(vertex, n);
    for (int64_t i = 0; i < n; i++)
        memcpy(mesh->points + 2 * i, place_of(&p->cache, vertex[i]), 2 * sizeof *mesh->points);
    if (!status) {
        translate(&p->corners, vertex, n, elements->corners);
        translate(&p->ends, vertex, n, mesh->segments);
        mesh->n_points = (int32_t)n;
        mesh->n_segments = (int32_t)(p->ends.n / 2);
        elements->n = (int32_t)(p->corners.n / 3);
    }
    free(vertex);
    return status ? status : p->cache.status;
}

static enum tri_status gather(struct part *p, bool attributes, struct tri_error *error)
{
    int64_t *corners = malloc(3 * SLICE * sizeof *corners);
    double *values = attributes ? malloc(SLICE * sizeof *values) : NULL;
    enum tri_status status = corners && (values || !attributes) ? TRI_OK : plot_no_memory(error);
    if (!status)
        status = each_triangle(p, corners, values, error);
    if (!status)
        status = each_segment(p, corners, error);
    free(corners);
    free(values);
    return status;
}

static enum tri_status run(struct part *p, const struct tri_check_source *source, struct tri_pslg *mesh,
                           struct tri_elements *elements, struct tri_error *error)
{
    bool attributes = p->density == NULL && (source->given >> TRI_CHECK_ATTRIBUTES & 1) != 0;
    enum tri_status status = cache_begin(&p->cache, source, error);
    if (!status)
        status = gather(p, attributes, error);
    if (!status)
        status = number(p, mesh, elements, error);
    elements->attributes = p->attributes;
    elements->n_attributes = attributes ? 1 : 0;
    cache_end(&p->cache);
    free(p->corners.at);
    free(p->ends.at);
    return status;
}

enum tri_status plot_part_take(const struct tri_check_source *source, const struct plot_box *window,
                               struct tri_pslg *mesh, struct tri_elements *elements, struct tri_error *error)
{
    struct part p = {.window = *window};
    return run(&p, source, mesh, elements, error);
}

enum tri_status plot_part_count(const struct tri_check_source *source, struct plot_density *density,
                                struct tri_pslg *mesh, struct tri_error *error)
{
    struct part p = {.window = density->box, .density = density};
    struct tri_elements none = {0};
    density->count = calloc((size_t)density->width * (size_t)density->height, sizeof *density->count);
    enum tri_status status = density->count != NULL ? run(&p, source, mesh, &none, error) : plot_no_memory(error);
    tri_elements_free(&none);
    return status;
}
