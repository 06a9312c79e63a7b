/* Lists the arrays of a tile, packs them, and fills them. */
#include "sched/tiles/tile_arrays.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "sched/tunables.h"
#include "triangle/mesh/surface.h"

void par_tile_arrays(const struct tri_tile *tile, int32_t n_attributes, struct par_array array[PAR_TILE_ARRAYS])
{
    const size_t v = (size_t)tile->n_vertices, t = (size_t)tile->n_triangles, s = (size_t)tile->n_segments;
    array[0] = (struct par_array){tile->points, v * sizeof *tile->points};
    array[1] = (struct par_array){tile->point_markers, v * sizeof *tile->point_markers};
    array[2] = (struct par_array){tile->attributes, v * (size_t)n_attributes * sizeof *tile->attributes};
    array[PAR_TILE_CORNERS] = (struct par_array){tile->corners, t * sizeof *tile->corners};
    array[4] = (struct par_array){tile->regions, t * sizeof *tile->regions};
    array[PAR_TILE_ENDS] = (struct par_array){tile->ends, s * sizeof *tile->ends};
    array[6] = (struct par_array){tile->segment_markers, s * sizeof *tile->segment_markers};
}

void par_tile_point_at(struct tri_tile *tile, const struct par_array array[PAR_TILE_ARRAYS])
{
    tile->points = (const double(*)[2])array[0].at;
    tile->point_markers = array[1].at;
    tile->attributes = array[2].at;
    tile->corners = (const int64_t(*)[3])array[PAR_TILE_CORNERS].at;
    tile->regions = array[4].at;
    tile->ends = (const int64_t(*)[2])array[PAR_TILE_ENDS].at;
    tile->segment_markers = array[6].at;
}

size_t par_tile_bytes(const struct tri_tile *tile, int32_t n_attributes)
{
    struct par_array array[PAR_TILE_ARRAYS];
    size_t n = par_padded(sizeof *tile);
    par_tile_arrays(tile, n_attributes, array);
    for (int k = 0; k < PAR_TILE_ARRAYS; k++)
        n += par_padded(array[k].bytes);
    return n;
}

/* Copies n bytes and pads them with zeros. Returns the end. */
static char *append(char *to, const void *bytes, size_t n)
{
    if (n > 0)
        memcpy(to, bytes, n);
    memset(to + n, 0, par_padded(n) - n);
    return to + par_padded(n);
}

void par_tile_pack(char *to, const struct tri_tile *tile, int32_t n_attributes)
{
    struct par_array array[PAR_TILE_ARRAYS];
    par_tile_arrays(tile, n_attributes, array);
    to = append(to, tile, sizeof *tile);
    for (int k = 0; k < PAR_TILE_ARRAYS; k++)
        to = append(to, array[k].at, array[k].bytes);
}

size_t par_tile_unpack(const char *bytes, size_t n, int32_t n_attributes, struct tri_tile *tile)
{
    struct par_array array[PAR_TILE_ARRAYS];
    size_t at = par_padded(sizeof *tile);
    if (n < at)
        return 0;
    memcpy(tile, bytes, sizeof *tile);
    if (tile->n_vertices < 0 || tile->n_triangles < 0 || tile->n_segments < 0)
        return 0;
    par_tile_arrays(tile, n_attributes, array);
    for (int k = 0; k < PAR_TILE_ARRAYS; k++) {
        if (n - at < par_padded(array[k].bytes))
            return 0;
        array[k].at = bytes + at;
        at += par_padded(array[k].bytes);
    }
    par_tile_point_at(tile, array);
    return at;
}

/* --- memory of one tile */

/* Returns *at as an array of n items of the given size, and advances *at. */
static void *array(char **at, int32_t n, size_t item)
{
    void *here = *at;
    *at += (size_t)n * item;
    return here;
}

static void point_at_copy(struct tri_tile *tile, const struct par_tile_copy *copy)
{
    tile->points = (const double(*)[2])copy->points;
    tile->point_markers = copy->point_markers;
    tile->attributes = copy->attributes;
    tile->corners = (const int64_t(*)[3])copy->corners;
    tile->regions = copy->regions;
    tile->ends = (const int64_t(*)[2])copy->ends;
    tile->segment_markers = copy->segment_markers;
}

/* Arrays of 8-byte numbers come first, so that all are aligned. */
bool par_tile_copy_reserve(struct par_tile_copy *copy, const struct tri_mesh *mesh, struct tri_tile *tile)
{
    const int32_t v = tile->n_vertices, t = tile->n_triangles, s = tile->n_segments;
    const size_t size = par_tile_bytes(tile, mesh->n_attributes);
    if (!copy->block || size > copy->size) {
        free(copy->block);
        copy->size = size + size / 16; /* the next tile is about as large */
        copy->block = malloc(copy->size + 1);
    }
    if (!copy->block)
        return false;
    char *at = copy->block;
    copy->points = array(&at, v, sizeof *copy->points);
    copy->attributes = array(&at, v, (size_t)mesh->n_attributes * sizeof *copy->attributes);
    copy->corners = array(&at, t, sizeof *copy->corners);
    copy->ends = array(&at, s, sizeof *copy->ends);
    copy->point_markers = array(&at, v, sizeof *copy->point_markers);
    copy->regions = array(&at, t, sizeof *copy->regions);
    copy->segment_markers = array(&at, s, sizeof *copy->segment_markers);
    point_at_copy(tile, copy);
    return true;
}

void par_tile_copy_free(struct par_tile_copy *copy)
{
    free(copy->block);
    *copy = (struct par_tile_copy){0};
}

void par_tile_copy_vertex(const struct par_tile_copy *copy, const struct tri_mesh *mesh, tri_vertex_id v, int32_t to)
{
    size_t n = (size_t)mesh->n_attributes;
    tri_mesh_place(mesh, v, copy->points[to]);
    copy->point_markers[to] = mesh->vertex_markers[v];
    if (n > 0)
        memcpy(copy->attributes + (size_t)to * n, mesh->attributes + (size_t)v * n, n * sizeof *copy->attributes);
}

/* --- Triangles start at their corner with the largest number, mostly a new vertex of the tile. The triangles that
 * start at such a vertex are its fan. A fan has two triangles on average. A counting sort assigns triangles to fans,
 * and each fan is sorted by the second corner. Triangles in no fan come first, since their first corners have lower
 * numbers. */

/* --- final triangles */

/* The record of a final triangle. It overwrites the struct tri_triangle. */
struct final {
    int64_t corner[3]; /* numbers of the corners, the largest first */
    int32_t region, unused; /* region: as in struct tri_triangle */
};

_Static_assert(sizeof(struct final) == sizeof(struct tri_triangle) &&
                   offsetof(struct final, region) == offsetof(struct tri_triangle, region),
               "a struct final overwrites a struct tri_triangle");

/* Returns a corner of a final triangle, read directly from the record. A copy on the stack would stall the processor,
 * because it would be written and read in pieces of different sizes. */
static inline int64_t final_corner(const struct tri_triangle *triangle, int k)
{
    int64_t corner;
    memcpy(&corner, (const char *)triangle + offsetof(struct final, corner) + (size_t)k * sizeof corner, sizeof corner);
    return corner;
}

/* Sets a corner of a final triangle. */
static inline void put_corner(struct tri_triangle *triangle, int k, int64_t number)
{
    memcpy((char *)triangle + offsetof(struct final, corner) + (size_t)k * sizeof number, &number, sizeof number);
}

/* Returns yes ? a : b, without a branch, which could not be predicted. */
static inline int64_t choose(bool yes, int64_t a, int64_t b) { return b ^ ((a ^ b) & -(int64_t)yes); }

/* The note is 2 * i + b. i is the index in the tile of the vertex at which the triangle starts, and b is 1 if a corner
 * is one of the caller's points. TRI_NONE: the vertex belongs to an earlier tile, or is a kept one. */
int32_t par_final_make(struct tri_triangle *triangle, const int64_t number[3], int64_t first, int64_t n_input)
{
    const int64_t a = number[0], b = number[1], c = number[2];
    const bool from_b = b > a, from_c = c > choose(from_b, b, a);
    const int64_t start = choose(from_c, c, choose(from_b, b, a));
    put_corner(triangle, 0, start);
    put_corner(triangle, 1, choose(from_c, a, choose(from_b, c, b)));
    put_corner(triangle, 2, choose(from_c, b, choose(from_b, a, c)));
    const bool has_input = (a < n_input) | (b < n_input) | (c < n_input);
    return start >= first ? (int32_t)(2 * (start - first)) + has_input : TRI_NONE;
}

/* Compares by the first corner, then by the second. */
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

/* Copies a struct final, at any address, to index `at` of the tile. */
static inline void put(const struct par_tile_copy *copy, int32_t at, const void *final)
{
    memcpy(copy->corners[at], (const char *)final + offsetof(struct final, corner), sizeof *copy->corners);
    memcpy(&copy->regions[at], (const char *)final + offsetof(struct final, region), sizeof *copy->regions);
}

/* Returns the triangle at index `at` of the tile. */
static struct final get(const struct par_tile_copy *copy, int32_t at)
{
    struct final final = {.region = copy->regions[at]};
    memcpy(final.corner, copy->corners[at], sizeof final.corner);
    return final;
}

/* Sorts n triangles of the tile by their first and second corners. False: no memory. */
static bool sort_many(const struct par_tile_copy *copy, int32_t first, int32_t n)
{
    struct final few[PAR_FEW_IN_FAN], *item = n > PAR_FEW_IN_FAN ? malloc((size_t)n * sizeof *item) : few;
    if (!item)
        return false;
    for (int32_t i = 0; i < n; i++)
        item[i] = get(copy, first + i);
    qsort(item, (size_t)n, sizeof *item, compare_finals);
    for (int32_t i = 0; i < n; i++)
        put(copy, first + i, &item[i]);
    if (n > PAR_FEW_IN_FAN)
        free(item);
    return true;
}

/* Converts n vertex numbers to the caller's numbers. */
static void show_numbers(int64_t *number, size_t n, const struct tri_mesh *mesh)
{
    for (size_t i = 0; mesh->origin && i < n; i++)
        number[i] = par_shown(mesh, number[i]);
}

/* The triangles of a tile, assigned to fans. A slot is an index of the tile's array of triangles. Within a fan,
 * triangles are not sorted yet. */
struct fans {
    const struct tri_tile *tile; /* the tile */
    struct tri_triangle *tri; /* triangles of the mesh */
    const int32_t *triangles, *notes; /* [n_triangles] as in struct par_tile_ids */
    int32_t *slot;            /* [n_triangles] the triangle in each slot */
    int32_t *end;             /* [n_vertices] slot after the last of each fan; in fill_slots: the next free slot */
    int32_t others;           /* number of triangles that are in no fan; they have the first slots */
    bool *has_input;          /* [n_vertices] a corner in the fan is one of the caller's points */
};

/* Returns the 8-byte words that the arrays of struct fans take. */
static int64_t fans_words(const struct tri_tile *tile)
{
    return (tile->n_triangles * INT64_C(4) + tile->n_vertices * INT64_C(5)) / 8 + 1;
}

/* Returns *at as an array of n numbers, and advances *at. */
static int32_t *fan_words(int32_t **at, int32_t n)
{
    int32_t *words = *at;
    *at += n;
    return words;
}

/* Computes the first slot of each fan. */
static void count_fans(struct fans *f)
{
    const int32_t n = f->tile->n_vertices;
    memset(f->end, 0, (size_t)n * (sizeof *f->end + sizeof *f->has_input)); /* has_input follows end */
    for (int32_t i = 0; i < f->tile->n_triangles; i++) {
        const int32_t own = f->notes[i] >> 1; /* TRI_NONE stays TRI_NONE */
        assert(TRI_NONE <= own && own < n);
        if (own == TRI_NONE) {
            f->others++;
            continue;
        }
        f->end[own]++;
        if (f->notes[i] & 1)
            f->has_input[own] = true;
    }
    for (int32_t v = 0, sum = f->others; v < n; v++) {
        int32_t count = f->end[v];
        f->end[v] = sum;
        sum += count;
    }
}

/* Returns the first slot of a fan. The slots have been filled. */
static int32_t begin_of(const struct fans *f, int32_t v) { return v > 0 ? f->end[v - 1] : f->others; }

/* Assigns each triangle to the next free slot of its fan. */
static void fill_slots(const struct fans *f)
{
    int32_t other = 0;
    for (int32_t i = 0; i < f->tile->n_triangles; i++)
        f->slot[f->notes[i] != TRI_NONE ? f->end[f->notes[i] >> 1]++ : other++] = f->triangles[i];
}

/* Copies a fan of up to four triangles to the tile, sorted by the second corner, without a branch that depends on the
 * corners. Always writes four triangles. Those beyond the fan are overwritten by the next fan. */
static inline void put_four(const struct fans *f, const struct par_tile_copy *copy, int32_t first, int32_t n)
{
    const struct tri_triangle *t[4];
    int64_t key[4];
    for (int k = 0; k < 4; k++) {
        t[k] = &f->tri[f->slot[first + k]];
        key[k] = choose(k < n, final_corner(t[k], 1), INT64_MAX);
    }
    for (int k = 0; k < 4; k++) {
        int32_t rank = 0;
        for (int i = 0; i < 4; i++)
            rank += i < k ? key[i] <= key[k] : key[i] < key[k];
        put(copy, first + rank, t[k]);
    }
}

/* Copies n triangles to the tile and sorts them. False: no memory. */
static bool put_many(const struct fans *f, const struct par_tile_copy *copy, int32_t first, int32_t n)
{
    for (int32_t i = first; i < first + n; i++)
        put(copy, i, &f->tri[f->slot[i]]);
    return sort_many(copy, first, n);
}

/* Copies the fans of vertices first to end - 1 to the tile. Prefetches later triangles, which are scattered in memory.
 * False: no memory. */
static bool put_fans(const struct fans *f, const struct par_tile_copy *copy, const struct tri_mesh *mesh, int32_t first,
                     int32_t end)
{
    const int32_t n = f->tile->n_triangles;
    bool memory = true;
    for (int32_t v = first, begin = begin_of(f, v); memory && v < end; begin = f->end[v++]) {
        const int32_t count = f->end[v] - begin;
        for (int k = 0; begin + PAR_HANDED_AHEAD < n && k < 3; k++)
            __builtin_prefetch(&f->tri[f->slot[begin + PAR_HANDED_AHEAD - k]]);
        if (count <= 4 && begin + 4 <= n)
            put_four(f, copy, begin, count);
        else
            memory = put_many(f, copy, begin, count);
        if (f->has_input[v])
            show_numbers(copy->corners[begin], 3 * (size_t)count, mesh);
    }
    return memory;
}

/* Frees the ids of the triangles in slots first to end - 1. */
static void free_triangles(const struct fans *f, int32_t first, int32_t end)
{
    for (int32_t i = first; i < end; i++)
        f->tri[f->slot[i]].v[0] = TRI_NONE;
}

/* Copies all triangles to the tile and frees their ids. Works on a few fans at a time, so that the triangles are still
 * in the cache when they are freed. False: no memory. */
static bool put_all(const struct fans *f, const struct par_tile_copy *copy, const struct tri_mesh *mesh)
{
    const int32_t n = f->tile->n_vertices;
    bool memory = put_many(f, copy, 0, f->others);
    show_numbers(copy->corners[0], 3 * (size_t)f->others, mesh);
    free_triangles(f, 0, f->others);
    for (int32_t first = 0, end; memory && first < n; first = end) {
        end = n - first > PAR_FANS_AT_ONCE ? first + PAR_FANS_AT_ONCE : n;
        memory = put_fans(f, copy, mesh, first, end);
        free_triangles(f, begin_of(f, first), begin_of(f, end));
    }
    return memory;
}

/* Copies the triangles to the tile, in the order of their numbers. False: no memory. */
static bool fill_triangles(const struct par_tile_job *job, const struct tri_mesh *mesh, const struct par_tile_ids *ids)
{
    const struct tri_tile *tile = &job->tile;
    int32_t *at = (int32_t *)(void *)job->scratch;
    struct fans fans = {.tile = tile, .tri = mesh->tri, .triangles = ids->triangles, .notes = ids->notes,
                        .slot = fan_words(&at, tile->n_triangles), .end = fan_words(&at, tile->n_vertices),
                        .has_input = (bool *)at};
    count_fans(&fans);
    fill_slots(&fans);
    return put_all(&fans, &job->copy, mesh);
}

/* --- subsegments */

/* A subsegment to be sorted. */
struct numbered_sub {
    int64_t end[2];         /* numbers of its ends */
    int32_t marker, parent; /* as in struct tri_subsegment */
};

static int compare_subs(const void *left, const void *right)
{
    const struct numbered_sub *a = left, *b = right;
    if (a->parent != b->parent)
        return a->parent < b->parent ? -1 : 1;
    return (a->end[0] > b->end[0]) - (a->end[0] < b->end[0]);
}

/* Sorts the subsegments by parent and start, and copies them to the tile. False: no memory. */
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
        for (int k = 0; k < 2; k++)
            job->copy.ends[i][k ^ mesh->parents[item[i].parent].reversed] = item[i].end[k];
        job->copy.segment_markers[i] = item[i].marker;
    }
    bool memory = item;
    if (memory)
        show_numbers((int64_t *)job->copy.ends, 2 * (size_t)n, mesh);
    free(item);
    return memory;
}

/* --- filling a tile */

bool par_tile_fill(struct par_tile_job *job, const struct tri_mesh *mesh, const int64_t *number,
                   const struct par_tile_ids *ids)
{
    const int32_t *vertices = ids->vertices;
    struct tri_tile *tile = &job->tile;
    if (!par_tile_job_reserve(job, fans_words(tile)) || !par_tile_copy_reserve(&job->copy, mesh, tile))
        return false;
    tri_surface_set(mesh, vertices, tile->n_vertices);
    for (int32_t i = 0; i < tile->n_vertices; i++) {
        if (i + PAR_HANDED_AHEAD < tile->n_vertices) {
            __builtin_prefetch(&mesh->xy[vertices[i + PAR_HANDED_AHEAD]]);
            __builtin_prefetch(&mesh->vertex_markers[vertices[i + PAR_HANDED_AHEAD]]);
        }
        par_tile_copy_vertex(&job->copy, mesh, vertices[i], i);
    }
    return fill_triangles(job, mesh, ids) && fill_subs(job, mesh, number, ids->subs);
}
