/* POSIX 2008, with extensions of Linux where available: files without a name, /proc, writing without the cache. */
#define _GNU_SOURCE /* O_TMPFILE, O_DIRECT, mkostemp, sync_file_range, madvise, malloc_trim, CPU_COUNT */
#include "triangle/base/system.h"

#include <aio.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#ifdef __linux__
#include <sys/vfs.h>
#endif
#ifdef __APPLE__
#include <dlfcn.h>
#include <mach/mach.h>

/* Darwin reserves space request the end of a file. Returns 0, or an errno, as POSIX does. */
static int posix_fallocate(int file, off_t place, off_t n)
{
    fstore_t space = {.fst_flags = F_ALLOCATEALL, .fst_posmode = F_PEOFPOSMODE, .fst_length = n};
    if (fcntl(file, F_PREALLOCATE, &space) != 0 && errno != ENOTSUP)
        return errno;
    return ftruncate(file, place + n) == 0 ? 0 : errno;
}
#endif

#ifndef O_DIRECT
#define O_DIRECT 0 /* not available on this system */
#endif
#ifndef SYNC_FILE_RANGE_WRITE
#define SYNC_FILE_RANGE_WRITE 0
#define SYNC_FILE_RANGE_WAIT_AFTER 0
#define sync_file_range(file, place, bytes, how) 0
#endif

/* --- files */

tri_file tri_file_open(const char *path, enum tri_opening opening)
{
    static const int flags[] = {
        [TRI_OPEN_READ] = O_RDONLY, [TRI_OPEN_NO_WAIT] = O_RDONLY | O_NONBLOCK, [TRI_OPEN_DEVICE] = O_WRONLY | O_NOCTTY,
        [TRI_OPEN_WRITE_SHARED] = O_WRONLY | O_NOFOLLOW, [TRI_OPEN_NEW] = O_RDWR | O_CREAT | O_EXCL};
    return open(path, flags[opening] | O_CLOEXEC, 0666); /* the permissions are reduced by the process's umask */
}

bool tri_file_close(tri_file file)
{
    return file == TRI_NO_FILE || close((int)file) == 0 || errno == EINTR; /* after EINTR it is closed, too */
}

/* Closes a file that must not be used and sets errno to `why`. */
static tri_file close_with_error(int file, int why)
{
    close(file);
    errno = why;
    return TRI_NO_FILE;
}

static bool facts_of(bool known, const struct stat *at, struct tri_file_facts *facts)
{
    if (known)
        *facts = (struct tri_file_facts){.size = (uint64_t)at->st_size, .device = (uint64_t)at->st_dev,
                                         .node = (uint64_t)at->st_ino, .names = (unsigned)at->st_nlink,
                                         .permissions = at->st_mode & 0777u,
                                         .kind = S_ISREG(at->st_mode)   ? TRI_REGULAR
                                                 : S_ISDIR(at->st_mode) ? TRI_FOLDER
                                                                        : TRI_OTHER_FILE};
    return known;
}

bool tri_path_get_facts(const char *path, struct tri_file_facts *facts)
{
    struct stat at;
    return facts_of(stat(path, &at) == 0, &at, facts);
}

bool tri_file_get_facts(tri_file file, struct tri_file_facts *facts)
{
    struct stat at;
    return facts_of(fstat((int)file, &at) == 0, &at, facts);
}

bool tri_file_set_permissions(tri_file file, const struct tri_file_facts *as)
{
    return fchmod((int)file, (mode_t)as->permissions) == 0;
}

/* --- reading and writing */

int64_t tri_read_at(tri_file file, void *at, size_t n, uint64_t place)
{
    size_t done = 0;
    while (done < n) {
        const ssize_t got = pread((int)file, (char *)at + done, n - done, (off_t)(place + done));
        if (got == 0)
            break;
        if (got < 0 && errno != EINTR)
            return -1;
        done += got > 0 ? (size_t)got : 0;
    }
    return (int64_t)done;
}

bool tri_write_at(tri_file file, const void *at, size_t n, uint64_t place)
{
    for (size_t done = 0; done < n;) {
        const ssize_t put = pwrite((int)file, (const char *)at + done, n - done, (off_t)(place + done));
        if (put < 0 && errno != EINTR)
            return false;
        done += put > 0 ? (size_t)put : 0;
    }
    return true;
}

int64_t tri_read_next(tri_file file, void *at, size_t n) { return read((int)file, at, n); }

int64_t tri_write_some(tri_file file, const void *at, size_t n, uint64_t place)
{
    return pwrite((int)file, at, n, (off_t)place);
}

int64_t tri_write_next(tri_file file, const void *at, size_t n) { return write((int)file, at, n); }

bool tri_file_set_size(tri_file file, uint64_t size) { return ftruncate((int)file, (off_t)size) == 0; }

bool tri_file_sync(tri_file file)
{
    int result;
#ifdef F_FULLFSYNC /* Darwin: its fsync() leaves data in the cache of the disk */
    if (fcntl((int)file, F_FULLFSYNC) == 0)
        return true;
#endif
    do
        result = fsync((int)file);
    while (result != 0 && errno == EINTR);
    return result == 0 || errno == EINVAL || errno == EROFS;
}

void tri_file_start_sync(tri_file file, uint64_t place, uint64_t n)
{
    (void)file, (void)place, (void)n;
    (void)sync_file_range((int)file, (off_t)place, (off_t)n, SYNC_FILE_RANGE_WRITE);
}

void tri_file_finish_sync(tri_file file, uint64_t place, uint64_t n)
{
    (void)file, (void)place, (void)n;
    (void)sync_file_range((int)file, (off_t)place, (off_t)n, SYNC_FILE_RANGE_WRITE | SYNC_FILE_RANGE_WAIT_AFTER);
}

tri_file tri_file_direct(tri_file file)
{
    char name[64];
    snprintf(name, sizeof name, "/proc/self/fd/%d", (int)file);
    return O_DIRECT ? open(name, O_WRONLY | O_DIRECT | O_CLOEXEC) : TRI_NO_FILE;
}

void *tri_page_alloc(size_t bytes)
{
    void *pages = NULL;
    return posix_memalign(&pages, TRI_PAGE_BYTES, bytes) == 0 ? pages : NULL;
}

struct tri_async {
    struct aiocb control;
};

struct tri_async *tri_async_start(tri_file file, const void *at, size_t n, uint64_t place)
{
    struct tri_async *request = calloc(1, sizeof *request);
    if (!request)
        return NULL;
    request->control.aio_fildes = (int)file;
    request->control.aio_offset = (off_t)place;
    request->control.aio_buf = (void *)at; /* is only read */
    request->control.aio_nbytes = n;
    request->control.aio_sigevent.sigev_notify = SIGEV_NONE;
    if (aio_write(&request->control) == 0)
        return request;
    free(request);
    return NULL;
}

size_t tri_async_wait(struct tri_async *request)
{
    const struct aiocb *const control = &request->control;
    while (aio_error(control) == EINPROGRESS)
        (void)aio_suspend(&control, 1, NULL);
    const int fault = aio_error(control);
    const ssize_t written = aio_return(&request->control);
    free(request);
    return fault == 0 && written > 0 ? (size_t)written : 0;
}

enum tri_lock tri_file_lock(tri_file file)
{
    struct flock whole = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    if (fcntl((int)file, F_SETLK, &whole) == 0)
        return TRI_LOCKED;
    return errno == EACCES || errno == EAGAIN ? TRI_LOCKED_BY_ANOTHER : TRI_NO_LOCKS;
}

bool tri_file_allows_shared_pages(tri_file file, const char *host)
{
    char here[TRI_PATH];
    if (tri_host_name(here, sizeof here) && strcmp(here, host) == 0)
        return true;
#ifdef __linux__
    enum { NFS = 0x6969, SMB = 0x517b };
    const uint32_t CIFS = 0xff534d42, SMB2 = 0xfe534d42;
    struct statfs system;
    if (fstatfs((int)file, &system) != 0)
        return false;
    const uint32_t type = (uint32_t)system.f_type;
    return type != NFS && type != SMB && type != CIFS && type != SMB2;
#else
    (void)file;
    return false;
#endif
}

/* --- scratch files */

/* Removes the name of a new file. Signals to this thread are blocked meanwhile, so that only SIGKILL can leave the
 * file. */
static tri_file make_nameless(char *path)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    const int file = mkostemp(path, O_CLOEXEC), fault = errno;
    if (file >= 0)
        (void)unlink(path);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    errno = fault;
    return file;
}

/* Returns the first n bytes of a path, followed by a name; NULL: no memory. */
static char *join_path(const char *path, size_t n, const char *name)
{
    const size_t length = strlen(name) + 1;
    char *both = malloc(n + length);
    if (!both)
        errno = ENOMEM;
    if (!both)
        return NULL;
    memcpy(both, path, n);
    memcpy(both + n, name, length);
    return both;
}

tri_file tri_scratch_file(const char *folder)
{
#ifdef O_TMPFILE
    const int file = open(folder, O_TMPFILE | O_RDWR | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
    if (file >= 0)
        return file;
#endif
    char *path = join_path(folder, strlen(folder), "/ptriangle-XXXXXX"); /* works on any file system */
    const tri_file made = path ? make_nameless(path) : TRI_NO_FILE;
    const int fault = errno;
    free(path);
    errno = fault;
    return made;
}

/* --- names of files */

bool tri_path_allows(const char *path, enum tri_access allowed)
{
    static const int modes[] = {
        [TRI_THERE] = F_OK, [TRI_READABLE] = R_OK, [TRI_WRITABLE] = W_OK, [TRI_ACCEPTS_FILES] = W_OK | X_OK};
    return access(path, modes[allowed]) == 0;
}

bool tri_path_remove(const char *path) { return unlink(path) == 0; }
bool tri_path_rename(const char *from, const char *to) { return rename(from, to) == 0; }
bool tri_path_link(const char *path, const char *second) { return link(path, second) == 0; }
char *tri_path_from_root(const char *path) { return realpath(path, NULL); }

size_t tri_path_folder_length(const char *path)
{
    const char *const slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

static bool stat_directory(const char *path, struct stat *status)
{
    char name[TRI_PATH];
    const size_t length = tri_path_folder_length(path);
    if (length + 2 > sizeof name)
        return false;
    memcpy(name, path, length);
    strcpy(name + length, ".");
    return stat(name, status) == 0;
}

/* Returns true if the link belongs to this user, the administrator or the owner of the folder. A link of another user
 * might lead to a file that only this user can write. */
static bool is_trusted_link(const char *path)
{
    struct stat at, directory;
    return lstat(path, &at) == 0 && stat_directory(path, &directory) &&
           (at.st_uid == geteuid() || at.st_uid == 0 || at.st_uid == directory.st_uid);
}

/* Returns the target of the symbolic link at path. NULL and errno: no link (EINVAL, ENOENT), or another error. */
static char *follow_link(const char *path)
{
    char target[TRI_PATH];
    const ssize_t length = readlink(path, target, sizeof target);
    if (length < 0)
        return NULL;
    const bool trusted = is_trusted_link(path);
    if (!trusted || (size_t)length == sizeof target) {
        errno = trusted ? ENAMETOOLONG : EPERM;
        return NULL;
    }
    target[length] = 0;
    return join_path(path, target[0] == '/' ? 0 : tri_path_folder_length(path), target);
}

char *tri_path_resolve(const char *path)
{
    enum { MOST_LINKS = 40 };
    char *resolved = join_path(path, 0, path);
    for (int i = 0; resolved && i < MOST_LINKS; i++) {
        char *const next = follow_link(resolved);
        if (!next && (errno == EINVAL || errno == ENOENT))
            return resolved;
        const int reason = errno;
        free(resolved);
        errno = reason;
        resolved = next;
    }
    if (resolved)
        errno = ELOOP;
    free(resolved);
    return NULL;
}

/* --- folders */

bool tri_folder_make(const char *path) { return mkdir(path, 0777) == 0; }
bool tri_folder_remove(const char *path) { return rmdir(path) == 0; }

tri_file tri_folder_open(const char *path, bool own)
{
    struct stat folder;
    const int file = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (file < 0 || !own)
        return file;
    if (fstat(file, &folder) != 0)
        return close_with_error(file, errno);
    return folder.st_uid == geteuid() ? file : close_with_error(file, EPERM);
}

tri_file tri_folder_file(tri_file folder, const char *name, enum tri_folder_opening opening)
{
    static const int flags[] = {
        [TRI_FOLDER_READ] = O_RDONLY, [TRI_FOLDER_CHANGE] = O_RDWR, [TRI_FOLDER_EXTEND] = O_RDWR | O_CREAT};
    struct stat at;
    const int file = openat((int)folder, name, flags[opening] | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
    if (file < 0)
        return TRI_NO_FILE;
    if (fstat(file, &at) != 0)
        return close_with_error(file, errno);
    const bool alone = opening != TRI_FOLDER_EXTEND || at.st_nlink <= 1; /* another user may have made a link */
    return S_ISREG(at.st_mode) && at.st_uid == geteuid() && alone ? file : close_with_error(file, EPERM);
}

tri_file tri_folder_create(tri_file folder, const char *name)
{
    if (!tri_folder_unlink(folder, name) && errno != ENOENT)
        return TRI_NO_FILE;
#ifdef O_TMPFILE
    if (access("/proc/self/fd", X_OK) == 0) { /* tri_folder_commit names the file through this path */
        const int unnamed = openat((int)folder, ".", O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666);
        if (unnamed >= 0)
            return unnamed;
    }
#endif
    return openat((int)folder, name, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
}

bool tri_folder_commit(tri_file folder, const char *name, tri_file file)
{
    char path[64];
    struct stat at;
    snprintf(path, sizeof path, "/proc/self/fd/%d", (int)file);
    return tri_file_sync(file) && fstat((int)file, &at) == 0 &&
           (at.st_nlink > 0 || linkat(AT_FDCWD, path, (int)folder, name, AT_SYMLINK_FOLLOW) == 0);
}

bool tri_folder_has(tri_file folder, const char *name) { return faccessat((int)folder, name, F_OK, 0) == 0; }
bool tri_folder_unlink(tri_file folder, const char *name) { return unlinkat((int)folder, name, 0) == 0; }

bool tri_folder_rename(tri_file folder, const char *from, const char *to)
{
    return renameat((int)folder, from, (int)folder, to) == 0;
}

bool tri_folder_list(tri_file folder, bool (*each)(void *user, const char *name), void *user)
{
    const int again = openat((int)folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC); /* closedir() closes this copy */
    DIR *list = again >= 0 ? fdopendir(again) : NULL;
    if (!list && again >= 0)
        (void)close_with_error(again, errno);
    if (!list)
        return false;
    for (const struct dirent *entry; (entry = readdir(list)) && each(user, entry->d_name);)
        ;
    closedir(list);
    return true;
}

/* --- mapped files */

/* Checks the size limit first, because a file beyond the limit would raise a signal. */
int tri_file_reserve(tri_file file, uint64_t from, uint64_t size)
{
    struct rlimit limit;
    int fault;
    if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY && size > limit.rlim_cur)
        return EFBIG;
    do
        fault = posix_fallocate((int)file, (off_t)from, (off_t)(size - from));
    while (fault == EINTR);
    return fault;
}

void *tri_file_map(tri_file file, size_t size)
{
    void *at = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_SHARED, (int)file, 0);
    return at != MAP_FAILED ? at : NULL;
}

void tri_file_unmap(void *at, size_t size) { munmap(at, size); }
void tri_file_release_pages(void *at, size_t size) { madvise(at, size, MADV_DONTNEED); }

/* --- memory */

#ifdef __APPLE__
double tri_memory_used(double *of_files)
{
    mach_task_basic_info_data_t task;
    mach_msg_type_number_t n = MACH_TASK_BASIC_INFO_COUNT;
    if (of_files)
        *of_files = 0;
    return task_info(mach_task_self(), MACH_TASK_BASIC_INFO, (task_info_t)&task, &n) == KERN_SUCCESS
               ? (double)task.resident_size
               : 0;
}
#else
double tri_memory_used(double *of_files)
{
    char text[128];
    unsigned long long all, files;
    const double page = (double)sysconf(_SC_PAGESIZE);
    const tri_file file = tri_file_open("/proc/self/statm", TRI_OPEN_READ);
    const int64_t n = file != TRI_NO_FILE ? tri_read_next(file, text, sizeof text - 1) : 0;
    (void)tri_file_close(file);
    text[n > 0 ? n : 0] = 0;
    const bool known = sscanf(text, "%*u %llu %llu", &all, &files) == 2;
    if (of_files)
        *of_files = known ? (double)files * page : 0;
    return known ? (double)all * page : 0;
}
#endif

void tri_memory_trim(void)
{
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

/* --- time */

static double seconds_by(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double tri_seconds(void) { return seconds_by(CLOCK_MONOTONIC); }
double tri_thread_seconds(void) { return seconds_by(CLOCK_THREAD_CPUTIME_ID); }
double tri_process_seconds(void) { return seconds_by(CLOCK_PROCESS_CPUTIME_ID); }

bool tri_pause(double seconds)
{
    struct timespec time = {.tv_sec = (time_t)seconds};
    time.tv_nsec = (long)(1e9 * (seconds - (double)time.tv_sec));
    return nanosleep(&time, NULL) == 0;
}

#ifdef __APPLE__
void (*tri_find_function(const char *name))(void)
{
    void *const found = dlsym(RTLD_DEFAULT, name);
    void (*function)(void);
    memcpy(&function, &found, sizeof function);
    return function;
}
#endif

/* --- processes and hosts */

long tri_process(void) { return (long)getpid(); }
bool tri_process_is_gone(long process) { return kill((pid_t)process, 0) != 0 && errno == ESRCH; }

bool tri_host_name(char *name, size_t room)
{
    memset(name, 0, room);
    return gethostname(name, room - 1) == 0 || name[0]; /* a longer name is cut, with or without an error */
}

/* --- threads */

int tri_processors(void)
{
#ifdef __linux__
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) == 0)
        return CPU_COUNT(&set);
#endif
    const long n = sysconf(_SC_NPROCESSORS_ONLN);
    return n > 0 ? (int)n : 1;
}

struct tri_thread {
    pthread_t thread;
};

struct tri_thread *tri_thread_start(void *(*run)(void *user), void *user)
{
    static const int own[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS, SIGTRAP, SIGPROF};
    sigset_t others, before;
    struct tri_thread *thread = malloc(sizeof *thread);
    if (!thread)
        return NULL;
    sigfillset(&others);
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        sigdelset(&others, own[i]);
    pthread_sigmask(SIG_SETMASK, &others, &before);
    const bool started = pthread_create(&thread->thread, NULL, run, user) == 0;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (started)
        return thread;
    free(thread);
    return NULL;
}

void tri_thread_join(struct tri_thread *thread)
{
    pthread_join(thread->thread, NULL);
    free(thread);
}

struct tri_monitor {
    pthread_mutex_t lock;
    pthread_cond_t changed;
};

struct tri_monitor *tri_monitor_new(void)
{
    struct tri_monitor *monitor = malloc(sizeof *monitor);
    if (monitor && pthread_mutex_init(&monitor->lock, NULL) == 0) {
        if (pthread_cond_init(&monitor->changed, NULL) == 0)
            return monitor;
        pthread_mutex_destroy(&monitor->lock);
    }
    free(monitor);
    return NULL;
}

void tri_monitor_free(struct tri_monitor *monitor)
{
    if (!monitor)
        return;
    pthread_cond_destroy(&monitor->changed);
    pthread_mutex_destroy(&monitor->lock);
    free(monitor);
}

void tri_monitor_enter(struct tri_monitor *monitor) { pthread_mutex_lock(&monitor->lock); }
void tri_monitor_leave(struct tri_monitor *monitor) { pthread_mutex_unlock(&monitor->lock); }
void tri_monitor_wait(struct tri_monitor *monitor) { pthread_cond_wait(&monitor->changed, &monitor->lock); }
void tri_monitor_wake(struct tri_monitor *monitor) { pthread_cond_broadcast(&monitor->changed); }
