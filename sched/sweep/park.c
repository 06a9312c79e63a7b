/* One sparse file, mapped as a whole: each array has a part of it that holds the largest there can be. */
#define _DEFAULT_SOURCE /* madvise, MAP_NORESERVE */

#include "sched/sweep/park.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include "sched/threads.h"

/* MOST_EXTRA: bytes a triangle. */
enum { OTHERS = TRI_ARRAYS, PARTS, GRAIN = 1 << 21, MOST_EXTRA = 64, LOOK_NANOSECONDS = 5000000 };

struct part {
    size_t first, size, used; /* in the file; `used` bytes have disk space */
};

struct par_park {
    int file;
    char *at; /* the mapping */
    size_t size;
    struct part part[PARTS];
    size_t taken; /* of the part OTHERS */
    struct tri_storage storage;
    int64_t memory;
    int fault;    /* errno of the reservation that failed; 0: none */
    pthread_t watch;
    bool watched;
    atomic_bool over;
};

static size_t rounded(size_t bytes) { return (bytes + GRAIN - 1) / GRAIN * GRAIN; }

/* Disk space for so many bytes of a part, and a little ahead, so that it seldom grows. */
static void *reserve_part(struct par_park *park, struct part *part, size_t bytes)
{
    size_t wanted = rounded(bytes);
    if (wanted > part->size)
        return NULL;
    if (wanted > part->used) {
        int fault;
        do
            fault = posix_fallocate(park->file, (off_t)(part->first + part->used), (off_t)(wanted - part->used));
        while (fault == EINTR);
        if (fault) {
            park->fault = fault;
            return NULL;
        }
        part->used = wanted;
    }
    return park->at + part->first;
}

static void *reserve(void *user, enum tri_array array, size_t bytes)
{
    struct par_park *park = user;
    return reserve_part(park, &park->part[array], bytes);
}

static void *extra(void *user, size_t bytes)
{
    struct par_park *park = user;
    char *part = reserve_part(park, &park->part[OTHERS], park->taken + bytes);
    if (!part)
        return NULL;
    part += park->taken;
    park->taken += (bytes + 63) / 64 * 64;
    return part;
}

int64_t par_park_bytes(const struct par_park *park)
{
    size_t sum = 0;
    for (int k = 0; k < PARTS; k++)
        sum += park->part[k].used;
    return (int64_t)sum;
}

enum tri_status par_park_status(const struct par_park *park, enum tri_status status, struct tri_error *error)
{
    if (status != TRI_NO_MEMORY || !park || !park->fault)
        return status;
    return tri_fail(error, TRI_CANNOT_WRITE, NULL, 0, "cannot park %.1f GB of the mesh in the scratch directory: %s",
                    1e-9 * (double)par_park_bytes(park), strerror(park->fault));
}

/* --- what leaves memory */

/* Bytes of the process in memory; more than any bound where the system does not tell. */
static double resident(void)
{
    unsigned long long all, here = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    bool known = file && fscanf(file, "%llu %llu", &all, &here) == 2;
    if (file)
        fclose(file);
    return known ? (double)here * (double)sysconf(_SC_PAGESIZE) : INFINITY;
}

/* Looks often enough that what is touched between two looks is small. */
static void *watch(void *user)
{
    struct par_park *park = user;
    const struct timespec pause = {0, LOOK_NANOSECONDS};
    while (!atomic_load(&park->over)) {
        if (resident() > 0.75 * (double)park->memory)
            madvise(park->at, park->size, MADV_DONTNEED);
        nanosleep(&pause, NULL);
    }
    return NULL;
}

/* --- the file */

static void lay_out(struct par_park *park, const struct tri_mesh *mesh)
{
    const size_t vertices = TRI_MAX_VERTICES, triangles = TRI_MAX_TRIANGLES;
    const size_t size[PARTS] = {
        [TRI_XY] = vertices * sizeof *mesh->xy,
        [TRI_ON] = vertices * sizeof *mesh->on,
        [TRI_MARKERS] = vertices * sizeof *mesh->vertex_markers,
        [TRI_FEATURE] = vertices * sizeof *mesh->feature,
        [TRI_ATTRIBUTES] = vertices * (size_t)mesh->n_attributes * sizeof *mesh->attributes,
        [TRI_TRIANGLES] = triangles * sizeof *mesh->tri,
        [TRI_SUBS] = triangles * sizeof *mesh->sub,
        [OTHERS] = triangles * MOST_EXTRA,
    };
    for (int k = 0; k < PARTS; k++) {
        park->part[k] = (struct part){park->size, rounded(size[k]), 0};
        park->size += rounded(size[k]);
    }
}

/* A file without a name. */
static int open_file(const char *scratch)
{
    const char name[] = "/ptriangle-XXXXXX";
    char *path = malloc(strlen(scratch) + sizeof name);
    if (!path)
        return -1;
    strcpy(path, scratch);
    strcat(path, name);
    int file = mkstemp(path);
    if (file >= 0)
        unlink(path);
    free(path);
    return file;
}

/* Beyond a limit on files a signal would come. */
static bool is_allowed(size_t size)
{
    struct rlimit limit;
    return getrlimit(RLIMIT_FSIZE, &limit) || limit.rlim_cur == RLIM_INFINITY || size <= limit.rlim_cur;
}

static bool map_file(struct par_park *park)
{
    if (!is_allowed(park->size))
        errno = EFBIG;
    else if (ftruncate(park->file, (off_t)park->size) == 0) {
        void *at = mmap(NULL, park->size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_NORESERVE, park->file, 0);
        park->at = at == MAP_FAILED ? NULL : at;
    }
    return park->at;
}

static enum tri_status set_up(struct par_park *park, struct tri_mesh *mesh, const char *scratch,
                              struct tri_error *error)
{
    park->file = open_file(scratch);
    if (park->file < 0 || !map_file(park))
        return tri_fail(error, TRI_CANNOT_WRITE, scratch, 0, "cannot park a mesh in this directory: %s",
                        strerror(errno));
    park->storage = (struct tri_storage){reserve, extra, park};
    enum tri_status status = tri_mesh_move(mesh, &park->storage, error);
    park->watched = !status && par_thread_start(&park->watch, watch, park);
    if (!status && !park->watched)
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "no thread can be made to watch over memory");
    return par_park_status(park, status, error);
}

enum tri_status par_park_open(struct par_park **park, struct tri_mesh *mesh, const char *scratch, int64_t memory,
                              struct tri_error *error)
{
    struct par_park *p = calloc(1, sizeof *p);
    *park = NULL;
    if (!p)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for a parked mesh");
    p->file = -1;
    p->memory = memory;
    lay_out(p, mesh);
    enum tri_status status = set_up(p, mesh, scratch, error);
    if (status)
        par_park_close(p, mesh);
    else
        *park = p;
    return status;
}

void par_park_close(struct par_park *park, struct tri_mesh *mesh)
{
    if (!park)
        return;
    if (mesh->storage == &park->storage)
        tri_mesh_drop(mesh);
    atomic_store(&park->over, true);
    if (park->watched)
        pthread_join(park->watch, NULL);
    if (park->at)
        munmap(park->at, park->size);
    if (park->file >= 0)
        close(park->file);
    free(park);
}
