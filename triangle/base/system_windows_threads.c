/* Windows: memory, time, processes and threads. */
#define WIN32_LEAN_AND_MEAN
#define _WIN32_WINNT 0x0A00
#include <windows.h>
/* must follow windows.h */
#include <psapi.h>

#include "triangle/base/system.h"

#include <malloc.h>
#include <process.h>
#include <stdio.h>
#include <stdlib.h>

/* --- memory */

/* Memory beyond the private memory of the process belongs to files: this is a lower bound. */
double tri_memory_used(double *of_files)
{
    PROCESS_MEMORY_COUNTERS_EX memory = {.cb = sizeof memory};
    const bool known = GetProcessMemoryInfo(GetCurrentProcess(), (PROCESS_MEMORY_COUNTERS *)&memory, sizeof memory);
    const double all = known ? (double)memory.WorkingSetSize : 0, own = known ? (double)memory.PrivateUsage : 0;
    if (of_files)
        *of_files = all > own ? all - own : 0;
    return all;
}

void tri_memory_trim(void) { (void)_heapmin(); }

/* --- time */

static double seconds_of(FILETIME t) { return 1e-7 * (double)((uint64_t)t.dwHighDateTime << 32 | t.dwLowDateTime); }

double tri_seconds(void)
{
    LARGE_INTEGER now, rate;
    QueryPerformanceCounter(&now);
    QueryPerformanceFrequency(&rate);
    return (double)now.QuadPart / (double)rate.QuadPart;
}

double tri_thread_seconds(void)
{
    FILETIME made, ended, kernel = {0}, user = {0};
    (void)GetThreadTimes(GetCurrentThread(), &made, &ended, &kernel, &user);
    return seconds_of(kernel) + seconds_of(user);
}

double tri_process_seconds(void)
{
    FILETIME made, ended, kernel = {0}, user = {0};
    (void)GetProcessTimes(GetCurrentProcess(), &made, &ended, &kernel, &user);
    return seconds_of(kernel) + seconds_of(user);
}

bool tri_pause(double seconds)
{
    Sleep((DWORD)(1000 * seconds + 0.999));
    return true;
}

/* --- processes and hosts */

long tri_process(void) { return (long)GetCurrentProcessId(); }

bool tri_process_is_gone(long process)
{
    const HANDLE it = OpenProcess(SYNCHRONIZE, FALSE, (DWORD)process);
    if (!it)
        return GetLastError() == ERROR_INVALID_PARAMETER; /* any other error: the process belongs to another user */
    const bool gone = WaitForSingleObject(it, 0) == WAIT_OBJECT_0;
    CloseHandle(it);
    return gone;
}

bool tri_host_name(char *name, size_t room)
{
    enum { WIDE = 256 };
    wchar_t wide[WIDE];
    char whole[TRI_PATH];
    DWORD n = WIDE;
    name[0] = 0;
    if (!GetComputerNameExW(ComputerNameDnsHostname, wide, &n) ||
        WideCharToMultiByte(CP_UTF8, 0, wide, -1, whole, sizeof whole, NULL, NULL) <= 0)
        return false;
    snprintf(name, room, "%s", whole);
    return true;
}

/* argument of run */

int tri_processors(void)
{
    DWORD_PTR own, all;
    int n = 0;
    if (!GetProcessAffinityMask(GetCurrentProcess(), &own, &all))
        return 1;
    for (; own; own &= own - 1)
        n++;
    return n > 0 ? n : 1;
}

struct tri_thread {
    HANDLE thread;
    void *(*run)(void *user);
    void *user; /* its argument */
};

static unsigned __stdcall begin_thread(void *it)
{
    const struct tri_thread *thread = it;
    (void)thread->run(thread->user);
    return 0;
}

struct tri_thread *tri_thread_start(void *(*run)(void *user), void *user)
{
    enum { STACK = 8 << 20 }; /* bytes of address space, as on Linux */
    struct tri_thread *thread = malloc(sizeof *thread);
    if (!thread)
        return NULL;
    *thread = (struct tri_thread){.run = run, .user = user};
    thread->thread = (HANDLE)_beginthreadex(NULL, STACK, begin_thread, thread, STACK_SIZE_PARAM_IS_A_RESERVATION, NULL);
    if (thread->thread)
        return thread;
    free(thread);
    return NULL;
}

void tri_thread_join(struct tri_thread *thread)
{
    WaitForSingleObject(thread->thread, INFINITE);
    CloseHandle(thread->thread);
    free(thread);
}

struct tri_monitor {
    SRWLOCK lock;
    CONDITION_VARIABLE changed;
};

struct tri_monitor *tri_monitor_new(void)
{
    struct tri_monitor *monitor = malloc(sizeof *monitor);
    if (monitor)
        *monitor = (struct tri_monitor){SRWLOCK_INIT, CONDITION_VARIABLE_INIT};
    return monitor;
}

void tri_monitor_free(struct tri_monitor *monitor) { free(monitor); }
void tri_monitor_enter(struct tri_monitor *monitor) { AcquireSRWLockExclusive(&monitor->lock); }
void tri_monitor_leave(struct tri_monitor *monitor) { ReleaseSRWLockExclusive(&monitor->lock); }

void tri_monitor_wait(struct tri_monitor *monitor)
{
    (void)SleepConditionVariableSRW(&monitor->changed, &monitor->lock, INFINITE, 0);
}

void tri_monitor_wake(struct tri_monitor *monitor) { WakeAllConditionVariable(&monitor->changed); }
