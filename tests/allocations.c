/* The functions that --wrap substitutes for the allocator. */
#include "allocations.h"

#include <errno.h>
#include <stdbool.h>
#include <stddef.h>

void *__real_malloc(size_t bytes);
void *__real_calloc(size_t n, size_t bytes);
void *__real_realloc(void *block, size_t bytes);
int __real_posix_memalign(void **block, size_t alignment, size_t bytes);
void __real_free(void *block);
void *__wrap_malloc(size_t bytes);
void *__wrap_calloc(size_t n, size_t bytes);
void *__wrap_realloc(void *block, size_t bytes);
int __wrap_posix_memalign(void **block, size_t alignment, size_t bytes);
void __wrap_free(void *block);

atomic_llong support_calls, support_fail_at = INT64_MAX, support_held;
atomic_bool support_fail_ever_after;

static bool must_fail(void)
{
    long long call = atomic_fetch_add(&support_calls, 1) + 1;
    bool fails = support_fail_ever_after ? call >= support_fail_at : call == support_fail_at;
    if (fails)
        errno = ENOMEM;
    return fails;
}

void *__wrap_malloc(size_t bytes)
{
    void *block = must_fail() ? NULL : __real_malloc(bytes);
    support_held += block != NULL;
    return block;
}

void *__wrap_calloc(size_t n, size_t bytes)
{
    void *block = must_fail() ? NULL : __real_calloc(n, bytes);
    support_held += block != NULL;
    return block;
}

void *__wrap_realloc(void *block, size_t bytes)
{
    void *fresh = must_fail() ? NULL : __real_realloc(block, bytes);
    support_held += fresh != NULL && block == NULL;
    return fresh;
}

int __wrap_posix_memalign(void **block, size_t alignment, size_t bytes)
{
    int fault = must_fail() ? ENOMEM : __real_posix_memalign(block, alignment, bytes);
    support_held += fault == 0;
    return fault;
}

void __wrap_free(void *block)
{
    support_held -= block != NULL;
    __real_free(block);
}
