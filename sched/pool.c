/* Triangles are judged in chunks, one thread each, and gathered in the order of the chunks. */
#include "sched/pool.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

#include "sched/theory.h"

bool par_slots_add(struct par_slots *slots, int32_t slot)
{
    if (slots->n == slots->capacity) {
        if (slots->capacity > INT32_MAX / 2)
            return false;
        int32_t capacity = slots->capacity ? 2 * slots->capacity : 64;
        int32_t *fresh = realloc(slots->item, (size_t)capacity * sizeof *fresh);
        if (!fresh)
            return false;
        slots->item = fresh;
        slots->capacity = capacity;
    }
    slots->item[slots->n++] = slot;
    return true;
}

struct filling {
    struct tri_mesh *mesh;
    const struct tri_refine_options *quality;
    const struct par_slots *known; /* the pool as it was, where only triangles born since need be judged; or NULL */
    int32_t n_known;               /* slots there were then */
    int32_t *found;                /* [n_slots] */
};

static int32_t first_in_pool(const struct par_slots *pool, int32_t slot)
{
    int32_t low = 0, high = pool->n;
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (pool->item[middle] < slot)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* The bad ones among slots first .. last - 1; returns how many. All lives begin anew, so that who is born later can be
 * told from who was there. */
static int32_t find_bad(const struct filling *f, int32_t first, int32_t last)
{
    int32_t *found = f->found + first, n = 0;
    if (f->known) {
        int32_t next = first_in_pool(f->known, first);
        for (int32_t t = first; t < last; t++) {
            bool was_bad = next < f->known->n && f->known->item[next] == t;
            next += was_bad;
            if (t >= f->n_known || f->mesh->tri[t].state != 0)
                n += tri_find_work(f->mesh, f->quality, t, t + 1, found + n);
            else if (was_bad)
                found[n++] = t;
        }
    } else {
        n = tri_find_work(f->mesh, f->quality, first, last, found);
    }
    for (int32_t t = first; t < last; t++)
        f->mesh->tri[t].state = 0;
    return n;
}

static double largest_radius2(const struct tri_mesh *mesh, const int32_t *slot, int32_t n)
{
    double largest = 0;
    for (int32_t i = 0; i < n; i++) {
        const int32_t *v = mesh->tri[slot[i]].v;
        double r2 = par_radius2(mesh->xy[v[0]], mesh->xy[v[1]], mesh->xy[v[2]]);
        largest = r2 > largest ? r2 : largest;
    }
    return largest;
}

enum tri_status par_pool_fill(struct par_slots *pool, struct tri_mesh *mesh, const struct tri_refine_options *quality,
                              int32_t n_known, int threads, double *radius, struct tri_error *error)
{
    enum { CHUNK = 1 << 14 };
    int32_t n = mesh->n_slots, n_chunks = n / CHUNK + 1;
    int32_t *count = calloc((size_t)n_chunks, sizeof *count);
    double *radius2 = calloc((size_t)n_chunks, sizeof *radius2);
    struct filling f = {mesh, quality, n_known > 0 ? pool : NULL, n_known, malloc(((size_t)n + 1) * sizeof *f.found)};
    (void)threads; /* without OpenMP */
    if (!f.found || !count || !radius2) {
        free(f.found);
        free(count);
        free(radius2);
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for %d triangles", (int)n);
    }
#pragma omp parallel for num_threads(threads) schedule(dynamic, 1)
    for (int32_t chunk = 0; chunk < n_chunks; chunk++) {
        int32_t first = chunk * CHUNK, last = first + CHUNK < n ? first + CHUNK : n;
        count[chunk] = find_bad(&f, first, last);
        radius2[chunk] = largest_radius2(mesh, f.found + first, count[chunk]);
    }
    double largest2 = 0;
    int32_t filled = 0;
    for (int32_t chunk = 0; chunk < n_chunks; chunk++) {
        largest2 = radius2[chunk] > largest2 ? radius2[chunk] : largest2;
        for (int32_t i = 0; i < count[chunk]; i++)
            f.found[filled++] = f.found[chunk * CHUNK + i];
    }
    free(pool->item);
    *pool = (struct par_slots){f.found, filled, n + 1};
    *radius = sqrt(largest2);
    free(count);
    free(radius2);
    return TRI_OK;
}

bool par_pool_filter(const struct par_slots *pool, const struct tri_mesh *mesh, const struct tri_refine_options *bounds,
                     int threads, struct par_slots *found)
{
    (void)threads;
    *found = (struct par_slots){malloc(((size_t)pool->n + 1) * sizeof *found->item), 0, pool->n};
    if (!found->item)
        return false;
#pragma omp parallel for num_threads(threads) schedule(dynamic, 4096)
    for (int32_t i = 0; i < pool->n; i++)
        if (tri_find_work(mesh, bounds, pool->item[i], pool->item[i] + 1, &found->item[i]) == 0)
            found->item[i] = TRI_NONE;
    for (int32_t i = 0; i < pool->n; i++)
        if (found->item[i] != TRI_NONE)
            found->item[found->n++] = found->item[i];
    return true;
}
