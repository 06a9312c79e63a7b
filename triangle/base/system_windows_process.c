/* Functions for programs only: memory limits, the terminal, interrupts. */
#define WIN32_LEAN_AND_MEAN
#define _WIN32_WINNT 0x0A00
#include <windows.h>
/* must follow windows.h */
#include <psapi.h>
#include <shellapi.h>

#include "triangle/base/system.h"

#include <errno.h>
#include <fcntl.h>
#include <io.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool to_utf8(const wchar_t *wide, char path[TRI_PATH])
{
    return WideCharToMultiByte(CP_UTF8, 0, wide, -1, path, TRI_PATH, NULL, NULL) > 0;
}

/* --- memory and disk */

/* Returns the memory limit of the job that contains this process; HUGE_VAL: no limit. */
static double job_limit(void)
{
    JOBOBJECT_EXTENDED_LIMIT_INFORMATION job;
    if (!QueryInformationJobObject(NULL, JobObjectExtendedLimitInformation, &job, sizeof job, NULL))
        return HUGE_VAL;
    const DWORD flags = job.BasicLimitInformation.LimitFlags;
    return fmin(flags & JOB_OBJECT_LIMIT_PROCESS_MEMORY ? (double)job.ProcessMemoryLimit : HUGE_VAL,
                flags & JOB_OBJECT_LIMIT_JOB_MEMORY ? (double)job.JobMemoryLimit : HUGE_VAL);
}

/* Physical memory and page file. Windows commits both when a process allocates memory. */
double tri_memory_left(void)
{
    MEMORYSTATUSEX memory = {.dwLength = sizeof memory};
    const double machine = GlobalMemoryStatusEx(&memory) ? (double)memory.ullAvailPageFile : HUGE_VAL;
    return fmin(machine, fmax(job_limit() - tri_memory_used(NULL), 0));
}

double tri_memory_total(void)
{
    MEMORYSTATUSEX memory = {.dwLength = sizeof memory};
    return fmin(GlobalMemoryStatusEx(&memory) ? (double)memory.ullTotalPhys : HUGE_VAL, job_limit());
}

enum tri_memory_nearest_limit tri_memory_nearest_limit(void) { return TRI_LIMIT_SYSTEM; }

int64_t tri_memory_peak(void)
{
    PROCESS_MEMORY_COUNTERS memory = {.cb = sizeof memory};
    return GetProcessMemoryInfo(GetCurrentProcess(), &memory, sizeof memory) ? (int64_t)memory.PeakWorkingSetSize : 0;
}

void tri_memory_share_heap(void) {}

double tri_memory_of_stacks(int threads) /* untouched stack pages cost nothing */
{
    (void)threads;
    return 0;
}

double tri_disk_left(const char *path)
{
    char folder[TRI_PATH];
    wchar_t wide[TRI_PATH];
    ULARGE_INTEGER left;
    tri_path_folder(path, folder);
    return MultiByteToWideChar(CP_UTF8, 0, folder, -1, wide, TRI_PATH) > 0 &&
                   GetDiskFreeSpaceExW(wide, &left, NULL, NULL)
               ? (double)left.QuadPart
               : HUGE_VAL;
}

/* TMPDIR, or the user's own folder if it is not set. */
const char *tri_scratch_folder(void)
{
    static char own[TRI_PATH];
    wchar_t wide[MAX_PATH + 2];
    const char *folder = getenv("TMPDIR");
    if (folder && *folder)
        return folder;
    return GetTempPathW(MAX_PATH + 2, wide) > 0 && to_utf8(wide, own) ? own : ".";
}

/* --- the program */

int _dowildcard = 0; /* for mingw: do not expand asterisks in arguments */

char **tri_arguments(int argc, char **argv)
{
    int n = 0;
    wchar_t **wide = CommandLineToArgvW(GetCommandLineW(), &n);
    char **all = wide && n == argc ? calloc((size_t)n + 1, sizeof *all) : NULL;
    for (int i = 0; all && i < n; i++) {
        const int room = WideCharToMultiByte(CP_UTF8, 0, wide[i], -1, NULL, 0, NULL, NULL);
        all[i] = malloc((size_t)room + 1);
        if (!all[i])
            return argv;
        WideCharToMultiByte(CP_UTF8, 0, wide[i], -1, all[i], room, NULL, NULL);
    }
    LocalFree(wide);
    return all ? all : argv;
}

const char *tri_word_quote(void) { return "\""; } /* the quotation mark of both shells; file names cannot contain it */

bool tri_program_path(char path[TRI_PATH])
{
    wchar_t wide[TRI_PATH];
    const DWORD n = GetModuleFileNameW(NULL, wide, TRI_PATH);
    return n > 0 && n < TRI_PATH && to_utf8(wide, path);
}

/* --- the terminal */

static UINT page_before; /* the console's code page; 0: it was UTF-8 */

static void restore_page(void) { (void)SetConsoleOutputCP(page_before); }

/* Disables translation of line ends, and shows names in UTF-8. */
void tri_standard_open(void)
{
    static const DWORD handles[] = {STD_INPUT_HANDLE, STD_OUTPUT_HANDLE, STD_ERROR_HANDLE};
    for (int i = 0; i < 3; i++) {
        const HANDLE given = GetStdHandle(handles[i]);
        if (!given || given == INVALID_HANDLE_VALUE)
            (void)SetStdHandle(handles[i], CreateFileW(L"NUL", GENERIC_READ | GENERIC_WRITE,
                                                       FILE_SHARE_READ | FILE_SHARE_WRITE, NULL, OPEN_EXISTING, 0,
                                                       NULL));
        (void)_setmode(i, _O_BINARY);
    }
    page_before = GetConsoleOutputCP() == CP_UTF8 ? 0 : GetConsoleOutputCP();
    if (page_before && SetConsoleOutputCP(CP_UTF8))
        (void)atexit(restore_page);
}

bool tri_standard_is_same_file(void)
{
    const HANDLE output = GetStdHandle(STD_OUTPUT_HANDLE), error = GetStdHandle(STD_ERROR_HANDLE);
    const DWORD type = GetFileType(output);
    struct tri_file_facts of_output, of_error;
    if (type != GetFileType(error) || !tri_file_get_facts((tri_file)output, &of_output) ||
        !tri_file_get_facts((tri_file)error, &of_error))
        return false;
    if (type == FILE_TYPE_DISK)
        return of_output.device == of_error.device && of_output.node == of_error.node;
    BOOL(WINAPI *compare)(HANDLE a, HANDLE b) = NULL; /* works for pipes and consoles; exists since Windows 10 */
    const FARPROC found = GetProcAddress(GetModuleHandleA("kernelbase"), "CompareObjectHandles");
    memcpy(&compare, &found, sizeof compare);
    return (tri_standard_is_terminal() && _isatty(1)) || output == error || (compare && compare(output, error));
}

bool tri_standard_is_terminal(void)
{
    DWORD mode;
    return GetConsoleMode(GetStdHandle(STD_ERROR_HANDLE), &mode);
}

bool tri_standard_reader_is_gone(void)
{
    DWORD n;
    const HANDLE output = GetStdHandle(STD_OUTPUT_HANDLE);
    return GetFileType(output) == FILE_TYPE_PIPE && !WriteFile(output, "", 0, &n, NULL) &&
           (GetLastError() == ERROR_NO_DATA || GetLastError() == ERROR_BROKEN_PIPE);
}

tri_file tri_standard_error_reopen(void)
{
    HANDLE again;
    const HANDLE self = GetCurrentProcess();
    return DuplicateHandle(self, GetStdHandle(STD_ERROR_HANDLE), self, &again, 0, FALSE, DUPLICATE_SAME_ACCESS)
               ? (tri_file)again
               : TRI_NO_FILE;
}

void tri_print_unbuffered(const char *text)
{
    DWORD n;
    (void)WriteFile(GetStdHandle(STD_ERROR_HANDLE), text, (DWORD)strlen(text), &n, NULL);
}

/* --- interrupts: the console and the timer call them in threads of their own */

static struct tri_interrupts handlers; /* set before the first interrupt can arrive */
static PTP_TIMER timer;

static const struct kind {
    DWORD event;
    int number; /* of the corresponding POSIX signal */
    const char *name;
} ends[] = {
    {CTRL_C_EVENT, 2, "Ctrl-C"},
    {CTRL_BREAK_EVENT, 3, "Ctrl-Break"},
    {CTRL_CLOSE_EVENT, 1, "the end of its window"},
    {CTRL_LOGOFF_EVENT, 1, "the end of its window"},
    {CTRL_SHUTDOWN_EVENT, 15, "the end of the system"},
};

enum { N_ENDS = sizeof ends / sizeof *ends };

const char *tri_interrupt_name(int number)
{
    for (int i = 0; i < N_ENDS; i++)
        if (ends[i].number == number)
            return ends[i].name;
    return NULL;
}

void tri_alarm(double seconds)
{
    const ULARGE_INTEGER from_now = {.QuadPart = (ULONGLONG) - (LONGLONG)(1e7 * seconds)};
    FILETIME due = {.dwLowDateTime = from_now.LowPart, .dwHighDateTime = from_now.HighPart};
    SetThreadpoolTimer(timer, &due, 0, 0);
}

static void CALLBACK on_alarm(PTP_CALLBACK_INSTANCE instance, void *user, PTP_TIMER which)
{
    (void)instance, (void)user, (void)which;
    handlers.time_is_up();
}

/* Windows ends the process when this handler returns, or after five seconds, unless a key caused the event. */
static BOOL WINAPI on_console(DWORD event)
{
    for (int i = 0; i < N_ENDS; i++)
        if (ends[i].event == event)
            handlers.asked(ends[i].number);
    if (event != CTRL_C_EVENT && event != CTRL_BREAK_EVENT)
        Sleep(INFINITE);
    return TRUE;
}

static LONG WINAPI on_fault(EXCEPTION_POINTERS *fault)
{
    (void)fault;
    handlers.crashed();
    return EXCEPTION_CONTINUE_SEARCH;
}

static void on_abort(int number)
{
    handlers.crashed();
    signal(number, SIG_DFL);
    raise(number);
}

bool tri_interrupts_catch(const struct tri_interrupts *to)
{
    handlers = *to;
    timer = CreateThreadpoolTimer(on_alarm, NULL, NULL);
    (void)SetConsoleCtrlHandler(on_console, TRUE);
    (void)SetUnhandledExceptionFilter(on_fault);
    (void)SetErrorMode(SEM_FAILCRITICALERRORS); /* an empty drive is an error, without a dialog */
    signal(SIGABRT, on_abort);
    return timer != NULL;
}
