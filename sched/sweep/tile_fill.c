/* Triangles start at their corner with the largest number, mostly a vertex of the tile's own. Those that start at one
 * are its fan, of two triangles on average: they find their places by counting, and are sorted by the next corner
 * within. The others come before them, since their first corners have lower numbers. */
#include "sched/sweep/tile_fill.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum { FEW = 24 }; /* are sorted by insertion */

/* --- final triangles */

struct final {
    int64_t corner[3];
    int32_t region, row;
};

_Static_assert(sizeof(struct final) == sizeof(struct tri_triangle), "one takes the place of the other");

static struct final final_of(const struct tri_triangle *triangle)
{
    struct final final;
    memcpy(&final, triangle, sizeof final);
    return final;
}

/* Without a branch, which could not be predicted. */
static inline int64_t choose(bool yes, int64_t a, int64_t b) { return b ^ ((a ^ b) & -(int64_t)yes); }

void par_final_make(struct tri_triangle *triangle, const int64_t number[3], int32_t row)
{
    const int64_t a = number[0], b = number[1], c = number[2];
    bool from_b = b > a, from_c = c > choose(from_b, b, a);
    const struct final final = {{choose(from_c, c, choose(from_b, b, a)), choose(from_c, a, choose(from_b, c, b)),
                                 choose(from_c, b, choose(from_b, a, c))},
                                triangle->region, row};
    memcpy(triangle, &final, sizeof final);
}

int32_t par_final_row(const struct tri_triangle *triangle)
{
    int32_t row;
    memcpy(&row, (const char *)triangle + offsetof(struct final, row), sizeof row);
    return row;
}

static int compare_finals(const void *left, const void *right)
{
    const struct final *a = left, *b = right;
    int k = a->corner[0] == b->corner[0];
    return (a->corner[k] > b->corner[k]) - (a->corner[k] < b->corner[k]);
}

/* --- the job */

bool par_tile_job_reserve(struct par_tile_job *job, int64_t n)
{
    if (job->scratch && n <= job->n_scratch)
        return true;
    free(job->scratch);
    job->scratch = malloc((size_t)(n + n / 16 + 1) * sizeof *job->scratch);
    job->n_scratch = job->scratch ? n + n / 16 : 0;
    return job->scratch;
}

void par_tile_job_free(struct par_tile_job *job)
{
    par_tile_copy_free(&job->copy);
    free(job->scratch);
    job->scratch = NULL;
}

/* --- triangles */

static void put(const struct par_tile_copy *copy, int32_t at, const struct final *final)
{
    memcpy(copy->corners[at], final->corner, sizeof final->corner);
    copy->regions[at] = final->region;
}

static struct final get(const struct par_tile_copy *copy, int32_t at)
{
    struct final final = {.region = copy->regions[at]};
    memcpy(final.corner, copy->corners[at], sizeof final.corner);
    return final;
}

static void insert_few(struct final *item, int32_t n)
{
    for (int32_t i = 1; i < n; i++) {
        const struct final moving = item[i];
        int32_t at = i;
        for (; at > 0 && compare_finals(&item[at - 1], &moving) > 0; at--)
            item[at] = item[at - 1];
        item[at] = moving;
    }
}

/* Triangles of one fan, or of none. */
static bool sort_many(const struct par_tile_copy *copy, int32_t first, int32_t n)
{
    struct final few[FEW], *item = n > FEW ? malloc((size_t)n * sizeof *item) : few;
    if (!item)
        return false;
    for (int32_t i = 0; i < n; i++)
        item[i] = get(copy, first + i);
    if (n > FEW)
        qsort(item, (size_t)n, sizeof *item, compare_finals);
    else
        insert_few(item, n);
    for (int32_t i = 0; i < n; i++)
        put(copy, first + i, &item[i]);
    if (n > FEW)
        free(item);
    return true;
}

/* A fan of up to four, by the second corner, without a branch that depends on it. What follows stays where it is. */
static void sort_four(const struct par_tile_copy *copy, int32_t first, int32_t n)
{
    struct final item[4];
    int64_t key[4];
    for (int k = 0; k < 4; k++) {
        item[k] = get(copy, first + k);
        key[k] = choose(k < n, item[k].corner[1], INT64_MAX);
    }
    for (int k = 0; k < 4; k++) {
        int32_t rank = 0;
        for (int i = 0; i < 4; i++)
            rank += i < k ? key[i] <= key[k] : key[i] < key[k];
        put(copy, first + rank, &item[k]);
    }
}

static uint64_t own_place(const struct tri_tile *tile, const struct final *final)
{
    return (uint64_t)(final->corner[0] - tile->first_vertex);
}

/* Where each fan begins; and how many triangles come before all of them. */
static int32_t count_fans(const struct tri_tile *tile, const struct tri_mesh *mesh, const int32_t *triangles,
                          int32_t *begin)
{
    int32_t others = 0;
    memset(begin, 0, (size_t)tile->n_vertices * sizeof *begin);
    for (int32_t i = 0; i < tile->n_triangles; i++) {
        const struct final final = final_of(&mesh->tri[triangles[i]]);
        uint64_t own = own_place(tile, &final);
        if (own < (uint64_t)tile->n_vertices)
            begin[own]++;
        else
            others++;
    }
    for (int32_t v = 0, sum = others; v < tile->n_vertices; v++) {
        int32_t count = begin[v];
        begin[v] = sum;
        sum += count;
    }
    return others;
}

/* at: where the next triangle of each fan goes. */
static void fill_fans(const struct par_tile_job *job, const struct tri_mesh *mesh, const int32_t *triangles,
                      int32_t *at)
{
    const struct tri_tile *tile = &job->tile;
    int32_t other = 0;
    for (int32_t i = 0; i < tile->n_triangles; i++) {
        struct tri_triangle *t = &mesh->tri[triangles[i]];
        const struct final final = final_of(t);
        uint64_t own = own_place(tile, &final);
        put(&job->copy, own < (uint64_t)tile->n_vertices ? at[own]++ : other++, &final);
        t->v[0] = TRI_NONE;
    }
}

static bool sort_fans(const struct par_tile_job *job, int32_t begin, const int32_t *end)
{
    const struct tri_tile *tile = &job->tile;
    bool memory = sort_many(&job->copy, 0, begin);
    for (int32_t v = 0; memory && v < tile->n_vertices; begin = end[v++]) {
        int32_t n = end[v] - begin;
        if (n <= 4 && begin + 4 <= tile->n_triangles)
            sort_four(&job->copy, begin, n);
        else
            memory = sort_many(&job->copy, begin, n);
    }
    return memory;
}

/* The numbers that the caller knows. */
static void show_numbers(int64_t *number, size_t n, const struct tri_mesh *mesh)
{
    for (size_t i = 0; mesh->origin && i < n; i++)
        number[i] = par_shown(mesh, number[i]);
}

static bool fill_triangles(const struct par_tile_job *job, const struct tri_mesh *mesh, const int32_t *triangles)
{
    int32_t *end = (int32_t *)(void *)job->scratch;
    int32_t others = count_fans(&job->tile, mesh, triangles, end);
    fill_fans(job, mesh, triangles, end);
    bool memory = sort_fans(job, others, end);
    show_numbers((int64_t *)job->copy.corners, 3 * (size_t)job->tile.n_triangles, mesh);
    return memory;
}

/* --- subsegments */

struct numbered_sub {
    int64_t end[2];
    int32_t marker, parent;
};

static int compare_subs(const void *left, const void *right)
{
    const struct numbered_sub *a = left, *b = right;
    if (a->parent != b->parent)
        return a->parent < b->parent ? -1 : 1;
    return (a->end[0] > b->end[0]) - (a->end[0] < b->end[0]);
}

static bool fill_subs(const struct par_tile_job *job, const struct tri_mesh *mesh, const int64_t *number,
                      const int32_t *subs)
{
    int32_t n = job->tile.n_segments;
    struct numbered_sub *item = malloc(((size_t)n + 1) * sizeof *item);
    for (int32_t i = 0; item && i < n; i++) {
        const struct tri_subsegment *s = &mesh->sub[subs[i]];
        item[i] = (struct numbered_sub){{number[s->v[0]], number[s->v[1]]}, s->marker, s->parent};
    }
    if (item && n > 1)
        qsort(item, (size_t)n, sizeof *item, compare_subs);
    for (int32_t i = 0; item && i < n; i++) {
        memcpy(job->copy.ends[i], item[i].end, sizeof item[i].end);
        job->copy.segment_markers[i] = item[i].marker;
    }
    bool memory = item;
    if (memory)
        show_numbers((int64_t *)job->copy.ends, 2 * (size_t)n, mesh);
    free(item);
    return memory;
}

/* --- all */

bool par_tile_fill(struct par_tile_job *job, const struct tri_mesh *mesh, const int64_t *number,
                   const int32_t *vertices, const int32_t *triangles, const int32_t *subs)
{
    struct tri_tile *tile = &job->tile;
    if (!par_tile_job_reserve(job, tile->n_vertices / 2 + 1) ||
        !par_tile_copy_reserve(&job->copy, mesh, tile->n_vertices, tile->n_triangles, tile->n_segments))
        return false;
    par_tile_copy_show(&job->copy, tile);
    for (int32_t i = 0; i < tile->n_vertices; i++)
        par_tile_copy_vertex(&job->copy, mesh, vertices[i], i);
    return fill_triangles(job, mesh, triangles) && fill_subs(job, mesh, number, subs);
}
