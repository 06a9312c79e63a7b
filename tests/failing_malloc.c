/* A library for LD_PRELOAD: one call of malloc, calloc, realloc or aligned_alloc fails, or that call and all later
 * ones. It works with any program. It can also make writes of the program fail.
 *
 *   PTRIANGLE_FAIL_AT=K     the K-th call fails, counted from 1
 *   PTRIANGLE_FAIL_AFTER=1  all later calls fail as well
 *   PTRIANGLE_FAIL_KILL=1   the process is killed instead
 *   PTRIANGLE_FAIL_OWN=1    counts only calls of the program itself, not those of libraries
 *   PTRIANGLE_FAIL_WRITE=K  the K-th call of pwrite and all later ones report a full disk
 *   PTRIANGLE_COUNT=FILE    receives the number of calls when the program ends
 *
 * Calls of the dynamic linker and of the OpenMP library are not counted. If an allocation of OpenMP fails, it prints a
 * line and ends the program, which cannot be prevented (sched/schedule/threads.h). */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <limits.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

void *__libc_malloc(size_t bytes);
void *__libc_calloc(size_t n, size_t bytes);
void *__libc_realloc(void *block, size_t bytes);
void *__libc_memalign(size_t alignment, size_t bytes);
ssize_t __pwrite64(int file, const void *data, size_t n, off64_t place);

static atomic_long calls, writes;
static long fail_at = LONG_MAX, fail_write = LONG_MAX;
static bool fail_after, own, kills;
static atomic_bool begun;

__attribute__((constructor)) static void begin(void)
{
    const char *at = getenv("PTRIANGLE_FAIL_AT"), *after = getenv("PTRIANGLE_FAIL_AFTER");
    const char *write = getenv("PTRIANGLE_FAIL_WRITE");
    fail_at = at ? atol(at) : LONG_MAX;
    fail_write = write ? atol(write) : LONG_MAX;
    fail_after = after && *after == '1';
    own = getenv("PTRIANGLE_FAIL_OWN");
    kills = getenv("PTRIANGLE_FAIL_KILL");
    begun = true;
}

__attribute__((destructor)) static void end(void)
{
    const char *name = getenv("PTRIANGLE_COUNT");
    long n = calls;
    begun = false;
    FILE *file = name ? fopen(name, "w") : NULL;
    if (file) {
        fprintf(file, "%ld\n", n);
        fclose(file);
    }
}

/* The address lies in the executable, or in the module that contains all code except the start (drivers/start.c). */
static bool is_of_the_program(const char *file) { return !strstr(file, ".so") || strstr(file, "ptriangle.so"); }

static bool counts(const void *caller)
{
    Dl_info info;
    if (!begun || !dladdr(caller, &info))
        return false;
    const char *file = info.dli_fname;
    if (own)
        return is_of_the_program(file);
    return !strstr(file, "libgomp") && !strstr(file, "ld-linux") && !strstr(file, "ld-musl");
}

static bool must_fail(const void *caller)
{
    if (!counts(caller))
        return false;
    long call = ++calls;
    bool fails = fail_after ? call >= fail_at : call == fail_at;
    if (fails && kills)
        raise(SIGKILL);
    if (fails)
        errno = ENOMEM;
    return fails;
}

void *malloc(size_t bytes) { return must_fail(__builtin_return_address(0)) ? NULL : __libc_malloc(bytes); }

void *calloc(size_t n, size_t bytes)
{
    return must_fail(__builtin_return_address(0)) ? NULL : __libc_calloc(n, bytes);
}

void *realloc(void *block, size_t bytes)
{
    return must_fail(__builtin_return_address(0)) ? NULL : __libc_realloc(block, bytes);
}

void *aligned_alloc(size_t alignment, size_t bytes)
{
    return must_fail(__builtin_return_address(0)) ? NULL : __libc_memalign(alignment, bytes);
}

int posix_memalign(void **block, size_t alignment, size_t bytes)
{
    *block = must_fail(__builtin_return_address(0)) ? NULL : __libc_memalign(alignment, bytes);
    return *block ? 0 : ENOMEM;
}

static ssize_t write_or_fail(const void *caller, int file, const void *data, size_t n, off64_t place)
{
    Dl_info info;
    if (!dladdr(caller, &info) || !is_of_the_program(info.dli_fname) || ++writes < fail_write)
        return __pwrite64(file, data, n, place);
    errno = ENOSPC;
    return -1;
}

ssize_t pwrite(int file, const void *data, size_t n, off_t place)
{
    return write_or_fail(__builtin_return_address(0), file, data, n, place);
}

ssize_t pwrite64(int file, const void *data, size_t n, off64_t place)
{
    return write_or_fail(__builtin_return_address(0), file, data, n, place);
}
