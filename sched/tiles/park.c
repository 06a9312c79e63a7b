/* Each array has one file. The part of the file that has disk space is mapped.
 *
 * INVARIANT: arrays in memory grow only if their new size, the other memory of the process and a reserve together are
 * within the limit. The other memory is the largest amount that was measured since memory was last trimmed. The reserve
 * is for memory that the process needs until the arrays grow again. */
#include "sched/tiles/park.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "sched/tunables.h"
#include "triangle/base/size_text.h"
#include "triangle/base/system.h"

enum { EXTRAS = 12, SHEETS = TRI_ARRAYS + EXTRAS };

struct par_park {
    const char *folder;         /* folder for files; NULL: exceeding the limit is an error */
    double memory;              /* the limit in bytes */
    double others;              /* largest memory use besides the arrays since memory was last trimmed, in bytes */
    double files;               /* bytes of file pages in memory when the park was opened: libraries */
    struct tri_mapped_file sheet[SHEETS]; /* a file for each array, then for extras; protected by the monitor */
    struct tri_storage storage; /* allocates arrays in the files */
    struct tri_bound bound;     /* checks the limit before arrays in memory grow */
    size_t most;                /* largest size of all files so far, in bytes */
    size_t wanted;              /* size of all files that the failed reservation would have needed, in bytes */
    int fault;                  /* errno of the reservation or write that failed; 0: none */
    struct tri_monitor *monitor; /* protects `sheet` and `most` */
    const struct tri_stop *outer; /* the stop function that the mesh had before; NULL: none */
    struct tri_stop stop;       /* the stop function of the mesh while it may be parked: checks memory, asks `outer` */
    struct tri_executor inner;  /* runs the tasks of par_park_executor */
    struct tri_thread *watch;   /* thread that checks memory periodically; NULL: not started */
    atomic_bool is_moved, over;     /* the arrays are in files; the thread `watch` must end */
};

/* --- memory use */

/* Returns the memory in use in bytes; infinity if the system does not report it. */
static double resident(double *of_files)
{
    const double all = tri_memory_used(of_files);
    return all > 0 ? all : INFINITY;
}

/* Updates park->others. */
static void update_others(struct par_park *park, const struct tri_mesh *mesh)
{
    const double others = resident(NULL) - (mesh->storage ? 0 : (double)tri_mesh_bytes_used(mesh));
    park->others = others > park->others ? others : park->others;
}

/* Returns whether the arrays may have this many bytes in memory (struct tri_bound). */
static bool allows(void *user, const struct tri_mesh *mesh, size_t bytes)
{
    struct par_park *park = user;
    update_others(park, mesh);
    return (double)bytes + park->others + fmax(PAR_TO_COME * park->memory, PAR_TO_COME_BYTES) <= park->memory;
}

/* --- files */

/* Returns the size of all files. */
static int64_t bytes_now(const struct par_park *park)
{
    int64_t sum = 0;
    for (int k = 0; k < SHEETS; k++)
        sum += (int64_t)park->sheet[k].size;
    return sum;
}

/* Extends a file to hold `bytes` and returns its mapping. NULL: no disk space; park->fault has the reason. */
static void *reserve_sheet(struct par_park *park, struct tri_mapped_file *sheet, size_t bytes)
{
    const size_t wanted = (bytes + PAR_PARK_GROWTH - 1) / PAR_PARK_GROWTH * PAR_PARK_GROWTH;
    tri_monitor_enter(park->monitor);
    const int fault = wanted > sheet->size ? tri_mapped_file_extend(sheet, park->folder, wanted) : 0;
    const size_t now = (size_t)bytes_now(park);
    park->most = now > park->most ? now : park->most;
    tri_monitor_leave(park->monitor);
    if (!fault)
        return sheet->at;
    park->fault = fault;
    park->wanted = now + (wanted - sheet->size);
    return NULL;
}

/* Removes a file and its mapping. */
static void drop_sheet(struct par_park *park, struct tri_mapped_file *sheet)
{
    tri_monitor_enter(park->monitor);
    tri_mapped_file_close(sheet);
    tri_monitor_leave(park->monitor);
}

/* --- callbacks of struct tri_storage */

/* Extends the file of an array. */
static void *reserve(void *user, enum tri_array array, size_t bytes)
{
    struct par_park *park = user;
    return reserve_sheet(park, &park->sheet[array], bytes + 1);
}

/* Writes the contents of an array to its file. */
static bool fill(void *user, enum tri_array array, const void *from, size_t bytes)
{
    struct par_park *park = user;
    if (tri_write_at(park->sheet[array].file, from, bytes, 0))
        return true;
    park->fault = errno ? errno : EIO;
    park->wanted = (size_t)bytes_now(park);
    return false;
}

/* Returns memory in a file of its own, for other code that works on the mesh. NULL: errno has the reason. */
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
                    "cannot park a mesh that needs %s in this directory: %s",
                    tri_size_text((double)park->wanted).text, strerror(park->fault));
}

/* --- evicting pages */

/* Evicts all pages of the files. */
static void unmap_pages(struct par_park *park)
{
    tri_monitor_enter(park->monitor);
    for (int k = 0; k < SHEETS; k++)
        tri_mapped_file_release_pages(&park->sheet[k]);
    tri_monitor_leave(park->monitor);
}

/* Evicts all pages of the files if they fill too large a share of the memory that is left for them. */
static void evict_if_needed(struct par_park *park)
{
    if (!atomic_load_explicit(&park->is_moved, memory_order_relaxed))
        return;
    double files;
    const double all = resident(&files), ours = files - park->files, left = park->memory - (all - ours);
    if (ours > PAR_TOUCHED * (left > 0 ? left : 0))
        unmap_pages(park);
}

/* The mesh's stop function, which long loops over the mesh poll. Each call also checks memory. */
static bool is_asked(void *user)
{
    struct par_park *park = user;
    evict_if_needed(park);
    return tri_stop_is_asked(park->outer);
}

/* Tasks of an executor that checks memory before each task. */
struct evicting_tasks {
    struct par_park *park;                     /* whose memory is checked */
    void (*task)(void *context, size_t index); /* the task to run */
    void *context;                             /* passed to `task` */
};

/* A task of the executor: checks memory, then runs the caller's task. */
static void evict_and_run(void *context, size_t index)
{
    const struct evicting_tasks *l = context;
    evict_if_needed(l->park);
    l->task(l->context, index);
}

/* The run function of the executor. */
static void run_evicting(void *self, size_t n_tasks, void (*task)(void *context, size_t index), void *context)
{
    struct par_park *park = self;
    struct evicting_tasks l = {park, task, context};
    tri_execute(&park->inner, n_tasks, evict_and_run, &l);
}

struct tri_executor par_park_executor(struct par_park *park, struct tri_executor inner)
{
    park->inner = inner;
    return (struct tri_executor){run_evicting, park};
}

/* A thread that checks memory periodically, for loops that do not poll the stop function. */
static void *watch(void *user)
{
    struct par_park *park = user;
    while (!atomic_load(&park->over)) {
        evict_if_needed(park);
        (void)tri_pause(1e-9 * PAR_LOOK_NANOSECONDS);
    }
    return NULL;
}

/* --- moving arrays to files */

/* Called if the arrays exceed the limit. Moves them to files, or fails if there is no folder. */
static enum tri_status move_to_files(void *user, struct tri_mesh *mesh, struct tri_error *error)
{
    struct par_park *park = user;
    assert(!mesh->storage);
    if (!park->folder && isinf(park->others))
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0,
                        "the system does not report how much memory is in use, so the limit of %s cannot be kept",
                        tri_size_text(park->memory).text);
    if (!park->folder)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0,
                        "the mesh, with %s triangles so far, needs more than the allowed %s of memory",
                        tri_count_text(mesh->n_triangles).text, tri_size_text(park->memory).text);
    for (int k = 0; k < TRI_ARRAYS; k++) /* files of an earlier mesh that was dropped */
        drop_sheet(park, &park->sheet[k]);
    enum tri_status status = tri_mesh_move(mesh, &park->storage, error);
    tri_memory_trim();
    atomic_store(&park->is_moved, true);
    if (!status && !park->watch)
        park->watch = tri_thread_start(watch, park);
    if (!status && !park->watch)
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "cannot start the thread that checks memory use");
    return par_park_status(park, status, error);
}

enum tri_status par_park_expect(struct par_park *park, struct tri_mesh *mesh, size_t bytes, struct tri_error *error)
{
    const size_t all = tri_mesh_bytes_used(mesh) + bytes;
    if (!park || mesh->storage || allows(park, mesh, all))
        return TRI_OK;
    tri_memory_trim(); /* memory that was freed since must not count as in use */
    park->others = 0;
    return allows(park, mesh, all) ? TRI_OK : move_to_files(park, mesh, error);
}

/* --- opening and closing */

enum tri_status par_park_open(struct par_park **park, struct tri_mesh *mesh, const char *folder, int64_t memory,
                              struct tri_error *error)
{
    struct par_park *p = calloc(1, sizeof *p);
    *park = NULL;
    if (p)
        p->monitor = tri_monitor_new();
    if (!p || !p->monitor) {
        free(p);
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for a mesh that may be parked");
    }
    p->folder = folder;
    p->memory = (double)memory;
    (void)tri_memory_used(&p->files);
    p->storage = (struct tri_storage){
        .reserve = reserve, .fill = fill, .extra = extra, .extra_free = extra_free, .user = p};
    p->bound = (struct tri_bound){allows, move_to_files, p};
    for (int k = 0; k < SHEETS; k++)
        p->sheet[k].file = TRI_NO_FILE;
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
    if (park->watch)
        tri_thread_join(park->watch);
    for (int k = 0; k < SHEETS; k++)
        drop_sheet(park, &park->sheet[k]);
    tri_monitor_free(park->monitor);
    free(park);
}
