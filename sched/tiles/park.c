/* One file for each array, mapped as far as it has disk space.
 *
 * INVARIANT: arrays in memory take, with all else that the process has there, no more than the bound when they begin to
 * grow. All else is the most that has been seen beside the arrays in use since memory was last trimmed, and a part of
 * the bound for what is to come before they grow again. */
#define _DEFAULT_SOURCE /* malloc_trim */

#include "sched/tiles/park.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "sched/schedule/threads.h"
#include "sched/tunables.h"
#include "triangle/base/at_place.h"
#include "triangle/base/mapped_file.h"
#include "triangle/base/size_text.h"

enum { EXTRAS = 12, SHEETS = TRI_ARRAYS + EXTRAS };

struct par_park {
    const char *folder;         /* NULL: what does not fit is an error */
    double memory, others;      /* the bound; the most seen in memory beside the arrays, since it was trimmed */
    double files;               /* bytes of pages of files to begin with: libraries */
    struct tri_mapped_file sheet[SHEETS]; /* arrays, then extras; changed under the lock */
    struct tri_storage storage;
    struct tri_bound bound;
    size_t most, wanted;        /* bytes of disk; with those of the reservation that failed */
    int fault;                  /* errno of that; 0: none */
    pthread_mutex_t lock;
    const struct tri_stop *outer; /* the mesh's own */
    struct tri_stop stop;
    struct tri_executor inner;
    pthread_t watch;
    bool watched;
    atomic_bool away, over;     /* arrays are in files; the watch ends */
};

/* --- what is in memory */

struct resident {
    double all, files; /* bytes; the second: pages of files, libraries among them */
};

/* More than any bound where the system does not tell. */
static struct resident resident(void)
{
    char text[128];
    unsigned long long all, files;
    const double page = (double)sysconf(_SC_PAGESIZE);
    int file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
    ssize_t n = file >= 0 ? read(file, text, sizeof text - 1) : 0;
    if (file >= 0)
        close(file);
    text[n > 0 ? n : 0] = 0;
    if (sscanf(text, "%*u %llu %llu", &all, &files) != 2)
        return (struct resident){INFINITY, 0};
    return (struct resident){(double)all * page, (double)files * page};
}

static void look_at_others(struct par_park *park, const struct tri_mesh *mesh)
{
    const double others = resident().all - (mesh->storage ? 0 : (double)tri_mesh_bytes_used(mesh));
    park->others = others > park->others ? others : park->others;
}

static bool allows(void *user, const struct tri_mesh *mesh, size_t bytes)
{
    struct par_park *park = user;
    look_at_others(park, mesh);
    return (double)bytes + park->others + fmax(PAR_TO_COME * park->memory, PAR_TO_COME_BYTES) <= park->memory;
}

/* --- files */

static int64_t bytes_now(const struct par_park *park)
{
    int64_t sum = 0;
    for (int k = 0; k < SHEETS; k++)
        sum += (int64_t)park->sheet[k].size;
    return sum;
}

static void *reserve_sheet(struct par_park *park, struct tri_mapped_file *sheet, size_t bytes)
{
    const size_t wanted = (bytes + PAR_PARK_GROWTH - 1) / PAR_PARK_GROWTH * PAR_PARK_GROWTH;
    pthread_mutex_lock(&park->lock);
    const int fault = wanted > sheet->size ? tri_mapped_file_extend(sheet, park->folder, wanted) : 0;
    const size_t now = (size_t)bytes_now(park);
    park->most = now > park->most ? now : park->most;
    pthread_mutex_unlock(&park->lock);
    if (!fault)
        return sheet->at;
    park->fault = fault;
    park->wanted = now + (wanted - sheet->size);
    return NULL;
}

static void drop_sheet(struct par_park *park, struct tri_mapped_file *sheet)
{
    pthread_mutex_lock(&park->lock);
    tri_mapped_file_close(sheet);
    pthread_mutex_unlock(&park->lock);
}

/* --- the storage */

static void *reserve(void *user, enum tri_array array, size_t bytes)
{
    struct par_park *park = user;
    return reserve_sheet(park, &park->sheet[array], bytes + 1);
}

static bool fill(void *user, enum tri_array array, const void *from, size_t bytes)
{
    struct par_park *park = user;
    if (tri_write_at(park->sheet[array].file, from, bytes, 0))
        return true;
    park->fault = errno ? errno : EIO;
    park->wanted = (size_t)bytes_now(park);
    return false;
}

static void *extra(void *user, size_t bytes)
{
    struct par_park *park = user;
    for (int k = TRI_ARRAYS; k < SHEETS; k++)
        if (!park->sheet[k].at) {
            void *at = reserve_sheet(park, &park->sheet[k], bytes + 1);
            if (!at) {
                drop_sheet(park, &park->sheet[k]);
                errno = park->fault;
            }
            return at;
        }
    errno = EMFILE;
    return NULL;
}

static void extra_free(void *user, void *extra)
{
    struct par_park *park = user;
    for (int k = TRI_ARRAYS; extra && k < SHEETS; k++)
        if (park->sheet[k].at == extra)
            drop_sheet(park, &park->sheet[k]);
}

int64_t par_park_bytes(const struct par_park *park) { return (int64_t)park->most; }

enum tri_status par_park_status(const struct par_park *park, enum tri_status status, struct tri_error *error)
{
    if (status != TRI_NO_MEMORY || !park || !park->fault || park->fault == ENOMEM)
        return status;
    return tri_fail(error, TRI_CANNOT_WRITE, park->folder, 0,
                    "cannot park %s there of a mesh that does not fit in memory: %s",
                    tri_size_text((double)park->wanted).text, strerror(park->fault));
}

/* --- what leaves memory again */

static void unmap_pages(struct par_park *park)
{
    pthread_mutex_lock(&park->lock);
    for (int k = 0; k < SHEETS; k++)
        tri_mapped_file_release_pages(&park->sheet[k]);
    pthread_mutex_unlock(&park->lock);
}

static void look(struct par_park *park)
{
    if (!atomic_load_explicit(&park->away, memory_order_relaxed))
        return;
    const struct resident now = resident();
    const double ours = now.files - park->files, left = park->memory - (now.all - ours);
    if (ours > PAR_TOUCHED * (left > 0 ? left : 0))
        unmap_pages(park);
}

/* Whoever works on the mesh asks now and then whether to go on, and looks on that occasion. */
static bool is_asked(void *user)
{
    struct par_park *park = user;
    look(park);
    return tri_stop_is_asked(park->outer);
}

struct looking {
    struct par_park *park;
    void (*task)(void *context, size_t index);
    void *context;
};

static void look_and_do(void *context, size_t index)
{
    const struct looking *l = context;
    look(l->park);
    l->task(l->context, index);
}

static void run_looking(void *self, size_t n_tasks, void (*task)(void *context, size_t index), void *context)
{
    struct par_park *park = self;
    struct looking l = {park, task, context};
    tri_execute(&park->inner, n_tasks, look_and_do, &l);
}

struct tri_executor par_park_executor(struct par_park *park, struct tri_executor inner)
{
    park->inner = inner;
    return (struct tri_executor){run_looking, park};
}

/* For work that does not look itself. */
static void *watch(void *user)
{
    struct par_park *park = user;
    const struct timespec pause = {0, PAR_LOOK_NANOSECONDS};
    while (!atomic_load(&park->over)) {
        look(park);
        nanosleep(&pause, NULL);
    }
    return NULL;
}

/* --- the move */

/* Memory that was freed goes back to the system. */
static void trim(void)
{
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

static enum tri_status leave(void *user, struct tri_mesh *mesh, struct tri_error *error)
{
    struct par_park *park = user;
    assert(!mesh->storage);
    if (!park->folder && isinf(park->others))
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0,
                        "the system does not tell how much memory is in use: a bound of %s cannot be kept",
                        tri_size_text(park->memory).text);
    if (!park->folder)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0,
                        "the mesh, %s triangles so far, outgrows the %s of memory that are allowed",
                        tri_count_text(mesh->n_triangles).text, tri_size_text(park->memory).text);
    for (int k = 0; k < TRI_ARRAYS; k++) /* of a mesh that was dropped */
        drop_sheet(park, &park->sheet[k]);
    enum tri_status status = tri_mesh_move(mesh, &park->storage, error);
    trim();
    atomic_store(&park->away, true);
    park->watched = park->watched || (!status && par_thread_start(&park->watch, watch, park));
    if (!status && !park->watched)
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "no thread can be made to watch over memory");
    return par_park_status(park, status, error);
}

enum tri_status par_park_expect(struct par_park *park, struct tri_mesh *mesh, size_t bytes, struct tri_error *error)
{
    const size_t all = tri_mesh_bytes_used(mesh) + bytes;
    if (!park || mesh->storage || allows(park, mesh, all))
        return TRI_OK;
    trim(); /* what was used for the same before, and is free now, is not counted twice */
    park->others = 0;
    return allows(park, mesh, all) ? TRI_OK : leave(park, mesh, error);
}

/* --- beginning and end */

enum tri_status par_park_open(struct par_park **park, struct tri_mesh *mesh, const char *folder, int64_t memory,
                              struct tri_error *error)
{
    struct par_park *p = calloc(1, sizeof *p);
    *park = NULL;
    if (!p || pthread_mutex_init(&p->lock, NULL) != 0) {
        free(p);
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for a mesh that may be parked");
    }
    p->folder = folder;
    p->memory = (double)memory;
    p->files = resident().files;
    p->storage = (struct tri_storage){
        .reserve = reserve, .fill = fill, .extra = extra, .extra_free = extra_free, .user = p};
    p->bound = (struct tri_bound){allows, leave, p};
    for (int k = 0; k < SHEETS; k++)
        p->sheet[k].file = -1;
    p->outer = mesh->stop;
    p->stop = (struct tri_stop){is_asked, p};
    mesh->stop = &p->stop;
    mesh->bound = &p->bound;
    *park = p;
    return TRI_OK;
}

void par_park_close(struct par_park *park, struct tri_mesh *mesh)
{
    if (!park)
        return;
    if (mesh && mesh->storage == &park->storage)
        tri_mesh_drop(mesh);
    if (mesh) {
        mesh->bound = NULL;
        mesh->stop = park->outer;
    }
    atomic_store(&park->over, true);
    if (park->watched)
        pthread_join(park->watch, NULL);
    for (int k = 0; k < SHEETS; k++)
        drop_sheet(park, &park->sheet[k]);
    pthread_mutex_destroy(&park->lock);
    free(park);
}
