/* The only interface to the operating system: files, folders, maps, memory, time, threads, the terminal, interrupts.
 *
 * No other file uses a function or a header of an operating system (tests/house_rules.sh). system_posix.c implements
 * this header for POSIX, system_windows.c and system_windows_threads.c implement it for Windows. system.c has the
 * functions that both share. The second half, for programs only, is in system_posix_process.c and
 * system_windows_process.c.
 *
 * ERRORS. A function that fails returns false, NULL, -1 or TRI_NO_FILE and sets errno to a code of the C library. A
 * comment that names EINTR says that an interrupt ends the call with this error. All other functions continue after an
 * interrupt.
 * NAMES of files have '/' between folders. On Windows they are UTF-8, and '\' and "C:" are accepted as well.
 * MEMORY. Results of type char * are allocated with malloc. */
#ifndef TRIANGLE_BASE_SYSTEM_H
#define TRIANGLE_BASE_SYSTEM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { TRI_PATH = 4096 }; /* bytes of a buffer for a path */

/* --- files */

typedef intptr_t tri_file; /* an open file or folder, not inherited by other programs; must be closed */
#define TRI_NO_FILE ((tri_file)-1)

enum tri_opening {
    TRI_OPEN_READ,   /* to read; for a pipe, waits until a writer opens it; EINTR */
    TRI_OPEN_NO_WAIT,   /* to read, without waiting */
    TRI_OPEN_DEVICE, /* to write to a device or pipe, which has no offsets; waits until a reader opens it; EINTR */
    TRI_OPEN_WRITE_SHARED,   /* to write a file that other processes write as well; does not follow links */
    TRI_OPEN_NEW     /* to read and write a new file; EEXIST if a file or link has this name */
};
tri_file tri_file_open(const char *path, enum tri_opening opening);

/* Creates an empty file without a name in the folder, to read and write. It disappears when the last process closes it
 * or dies. On file systems without nameless files, a killed process may leave an empty file ptriangle-XXXXXX. On
 * Windows the name is visible until the file is closed. */
tri_file tri_scratch_file(const char *folder);

/* Accepts TRI_NO_FILE. Returns false if the file system reports only now that there was no space for the data. */
bool tri_file_close(tri_file file);

enum tri_file_kind { TRI_REGULAR, TRI_FOLDER, TRI_OTHER_FILE };

struct tri_file_facts {
    enum tri_file_kind kind;
    uint64_t size;         /* in bytes */
    uint64_t device, node; /* two files are the same if both are equal */
    unsigned names;        /* number of names (hard links) */
    unsigned permissions;  /* passed to tri_file_set_permissions */
};

/* Return the facts of a file. tri_path_get_facts follows all links. */
bool tri_path_get_facts(const char *path, struct tri_file_facts *facts);
bool tri_file_get_facts(tri_file file, struct tri_file_facts *facts);

/* Gives `file` the permissions of the file described by `as`. */
bool tri_file_set_permissions(tri_file file, const struct tri_file_facts *as);

/* Reads n bytes at offset `place` and returns the number of bytes read. It is less than n only at the end of the
 * file. */
int64_t tri_read_at(tri_file file, void *at, size_t n, uint64_t place);

/* Reads n bytes that are known to be in the file; EIO if the file is shorter. tri_write_at writes n bytes. */
bool tri_read_back(tri_file file, void *at, size_t n, uint64_t place);
bool tri_write_at(tri_file file, const void *at, size_t n, uint64_t place);

/* Reads up to n bytes that follow, from a pipe or device, or from a file that is read from its start. Returns their
 * number, 0 at the end. EINTR. */
int64_t tri_read_next(tri_file file, void *at, size_t n);

/* Write as many bytes as the system accepts in one call, at offset `place` or after the previous bytes, and return
 * their number. EINTR. */
int64_t tri_write_some(tri_file file, const void *at, size_t n, uint64_t place);
int64_t tri_write_next(tri_file file, const void *at, size_t n);

/* Truncates or extends the file to `size` bytes. New bytes are zero. */
bool tri_file_set_size(tri_file file, uint64_t size);

/* Returns after the written data, or for a folder its list of names, is on the disk. Returns true if the system has no
 * such operation. */
bool tri_file_sync(tri_file file);

/* Hints: the first function makes the system start writing n bytes (0: all) to the disk, the second waits for it. */
void tri_file_start_sync(tri_file file, uint64_t place, uint64_t n);
void tri_file_finish_sync(tri_file file, uint64_t place, uint64_t n);

/* Opens the same file again, to be written without the system's cache. Then sizes, offsets and addresses must be
 * multiples of TRI_PAGE_BYTES. Returns TRI_NO_FILE if the system does not support this. Closing either file releases
 * the lock of the file. */
enum { TRI_PAGE_BYTES = 4096 };
tri_file tri_file_direct(tri_file file);

/* Allocates a buffer for such a file; call free() afterwards. NULL: no memory. */
void *tri_page_alloc(size_t bytes);

/* Asynchronous writing. tri_async_start returns NULL if the system cannot do it; otherwise the bytes must stay
 * unchanged until tri_async_wait. tri_async_wait frees the handle and returns the number of bytes written. */
struct tri_async *tri_async_start(tri_file file, const void *at, size_t n, uint64_t place);
size_t tri_async_wait(struct tri_async *behind);

/* Locks the whole file against other processes. The lock ends when this process closes the file, through any handle, or
 * dies. */
enum tri_lock { TRI_LOCKED, TRI_LOCKED_BY_ANOTHER, TRI_NO_LOCKS };
enum tri_lock tri_file_lock(tri_file file);

/* Returns true if two processes may write different bytes of one page of this file, when the other process opened the
 * file on `host`. Network file systems may lose such bytes. */
bool tri_file_allows_shared_pages(tri_file file, const char *host);

/* --- names of files */

enum tri_access { TRI_THERE, TRI_READABLE, TRI_WRITABLE, TRI_ACCEPTS_FILES };
bool tri_path_allows(const char *path, enum tri_access access);

/* May be called by interrupt handlers. */
bool tri_path_remove(const char *path);

/* Replaces the file at the new name, if there is one, in a single step. */
bool tri_path_rename(const char *from, const char *to);

/* Gives the file a second name. */
bool tri_path_link(const char *path, const char *second);

/* Returns the path with all symbolic links resolved; the file need not exist. EPERM: a link belongs to another user who
 * is neither the administrator nor the owner of the folder. Other errors: ENAMETOOLONG, ELOOP. */
char *tri_path_resolve(const char *path);

/* Returns the absolute path of an existing file. */
char *tri_path_from_root(const char *path);

/* Returns the length of the folder part of a path, including the last '/'; 0 if the path has no folder part. */
size_t tri_path_folder_length(const char *path);

/* Stores the folder itself if path is a folder. Otherwise stores the folder of the file, which need not exist. */
void tri_path_folder(const char *path, char folder[TRI_PATH]);

/* --- folders */

bool tri_folder_make(const char *path);
bool tri_folder_remove(const char *path); /* the folder must be empty */

/* Opens the folder at this path, which may be a link. If `own` is set, a folder of another user is an error (EPERM). */
tri_file tri_folder_open(const char *path, bool own);

/* Access to files through an open folder. Then other processes cannot redirect it by changing the folder's path or by
 * adding links. Names hold no slash. No link is followed, and files that are not regular or belong to another user are
 * not opened (EPERM). */
enum tri_folder_opening {
    TRI_FOLDER_READ,
    TRI_FOLDER_CHANGE, /* to read and write */
    TRI_FOLDER_EXTEND  /* the same, and creates the file if it does not exist; EPERM also if the file has a second
                        * name */
};
tri_file tri_folder_file(tri_file folder, const char *name, enum tri_folder_opening opening);

/* Creates an empty file to write, after removing any file of that name from the folder. tri_folder_commit gives the new
 * file its name once it is complete and on the disk. If the process dies before, no file is left. File systems without
 * nameless files (NFS) give it the name at once. */
tri_file tri_folder_create(tri_file folder, const char *name);
bool tri_folder_commit(tri_file folder, const char *name, tri_file file);

bool tri_folder_has(tri_file folder, const char *name);
bool tri_folder_unlink(tri_file folder, const char *name);
bool tri_folder_rename(tri_file folder, const char *from, const char *to);

/* Calls each(user, name) for every name in the folder until one call returns false. Returns false if the folder cannot
 * be listed. */
bool tri_folder_list(tri_file folder, bool (*each)(void *user, const char *name), void *user);

/* --- mapped files */

/* Reserves disk space for the file's bytes from `from` up to `size`. Returns 0 or an errno: EFBIG beyond a limit. */
int tri_file_reserve(tri_file file, uint64_t from, uint64_t size);

/* Maps the first `size` bytes of the file, to read and write; NULL and errno on failure. */
void *tri_file_map(tri_file file, size_t size);
void tri_file_unmap(void *at, size_t size);
void tri_file_release_pages(void *at, size_t size); /* the pages may leave memory; the bytes stay in the file */

/* An array in a scratch file that is mapped into memory, so that it may be larger than memory. */
struct tri_mapped_file {
    tri_file file; /* TRI_NO_FILE: not created yet */
    size_t size;   /* bytes reserved or written on the disk */
    void *at;      /* mapping of the whole file; NULL: not mapped */
};

/* Reserves disk space up to `size` bytes, more than the current size, and maps all of it. Creates the file in the
 * folder on the first call. A full disk or a limit is reported here instead of raising a signal when the array is
 * written. Returns 0 or an errno. After an error the old mapping stays. */
int tri_mapped_file_extend(struct tri_mapped_file *f, const char *folder, size_t size);

/* Appends n bytes. The file must not be mapped. */
bool tri_mapped_file_append(struct tri_mapped_file *f, const char *folder, const void *bytes, size_t n);

/* Maps the bytes written so far, if there are any and they are not mapped yet. */
bool tri_mapped_file_map(struct tri_mapped_file *f);

/* Lets the system remove the pages from memory; the bytes stay in the file. Does nothing without a mapping. */
void tri_mapped_file_release_pages(const struct tri_mapped_file *f);

/* Unmaps and closes the file, which deletes it. Keeps errno. */
void tri_mapped_file_close(struct tri_mapped_file *f);

/* --- memory and disk, in bytes */

/* tri_memory_left returns how much more memory the process may use: the least amount left under the limits of the
 * machine (including swap), of the process, and of its control groups. Limits that cannot be read are ignored.
 * HUGE_VAL: no limit can be read. tri_memory_total returns the same with nothing in use. */
double tri_memory_left(void);
double tri_memory_total(void);

/* Which of these limits would be reached first. Beyond the limits of a process, memory allocation fails at once. Mapped
 * files count as address space. */
enum tri_memory_nearest_limit { TRI_LIMIT_SYSTEM, TRI_LIMIT_DATA, TRI_LIMIT_ADDRESS_SPACE };
enum tri_memory_nearest_limit tri_memory_nearest_limit(void);

/* Memory that the process uses now; 0: unknown. *of_files (unless NULL): the part of it that holds pages of files,
 * including libraries. */
double tri_memory_used(double *of_files);
int64_t tri_memory_peak(void); /* maximum so far; 0: unknown */

/* Returns freed memory to the system. */
void tri_memory_trim(void);

/* If the process has memory limits, makes all threads share one heap from now on, because a heap for each thread would
 * take 64 MB of address space. Call this before threads allocate memory. */
void tri_memory_share_heap(void);

/* Stack memory of `threads` threads, used or not, without that of threads that already run. */
double tri_memory_of_stacks(int threads);

/* Free space on the file system that holds this file or folder; HUGE_VAL: unknown. */
double tri_disk_left(const char *path);

/* The folder for scratch files: TMPDIR, otherwise /tmp, or on Windows the folder from GetTempPath. */
const char *tri_scratch_folder(void);

/* --- time; no decision about a mesh may depend on it */

double tri_seconds(void);         /* wall clock */
double tri_thread_seconds(void);  /* processor time of this thread */
double tri_process_seconds(void); /* processor time of all threads of this process */

/* Sleeps. Returns false if an interrupt came first. */
bool tri_pause(double seconds);

/* --- threads, for sched/ only */

int tri_processors(void); /* number that this process may use, at least 1 */

/* Starts a thread that blocks all interrupts except those that its own faults raise, so that other threads handle them.
 * Returns NULL if no thread can be started. */
struct tri_thread *tri_thread_start(void *(*run)(void *user), void *user);
void tri_thread_join(struct tri_thread *thread); /* waits for the end of the thread and frees it */

/* A mutex with a condition variable. */
struct tri_monitor *tri_monitor_new(void); /* NULL: no memory */
void tri_monitor_free(struct tri_monitor *monitor); /* accepts NULL */
void tri_monitor_enter(struct tri_monitor *monitor);
void tri_monitor_leave(struct tri_monitor *monitor);
void tri_monitor_wait(struct tri_monitor *monitor);   /* in the lock: unlocks, waits to be woken, locks again */
void tri_monitor_wake(struct tri_monitor *monitor);   /* wakes all waiting threads */

/* --- functions of the program */

#ifdef __APPLE__
void (*tri_find_function(const char *name))(void); /* by its name; NULL: the program has none */
#endif

/* --- processes and hosts */

long tri_process(void); /* id of this process */
bool tri_process_is_gone(long process); /* true if no process of this host has this id, as far as can be determined */
bool tri_host_name(char *name, size_t room); /* a name that is too long is cut; false: unknown */

/* ------ The functions below are in system_posix_process.c or system_windows_process.c, for drivers/ only. */

/* Returns the arguments of main() in UTF-8, or unchanged if there is no memory. */
char **tri_arguments(int argc, char **argv);

/* The quotation mark for shell words that hold other characters than letters. */
const char *tri_word_quote(void);

/* Stores the path of the program's executable, with links resolved. */
bool tri_program_path(char path[TRI_PATH]);

/* --- the terminal */

/* Opens an empty device for each standard stream that is closed, so that no file gets its number. */
void tri_standard_open(void);
bool tri_standard_is_same_file(void);          /* true if output and error lead to the same file or terminal */
bool tri_standard_is_terminal(void);     /* of standard error */
bool tri_standard_reader_is_gone(void);  /* true if the reader of the pipe at standard output has closed it */
tri_file tri_standard_error_reopen(void); /* opens standard error a second time; TRI_NO_FILE if it is closed */

/* --- interrupts: requests to end the program, and crashes */

/* Handlers may be called at any time and on any thread. Of the functions here they may call only tri_path_remove,
 * tri_print_unbuffered and tri_alarm. */
struct tri_interrupts {
    void (*asked)(int number); /* the program should end; number > 0: the signal that requests it, below 128 */
    void (*time_is_up)(void);  /* the time set by tri_alarm is over */
    void (*crashed)(void);     /* the program ends when this returns */
};

/* Installs the handlers for all interrupts that would end the program, except those that the parent process made it
 * ignore. A file that is too large, or a standard output whose reader has closed it, become write errors. Returns false
 * if there is no alarm. Call this once. */
bool tri_interrupts_catch(const struct tri_interrupts *handlers);
const char *tri_interrupt_name(int number); /* such as "SIGTERM"; NULL: unknown number */
void tri_alarm(double seconds); /* calls time_is_up after this time; a later call replaces an earlier one */
void tri_print_unbuffered(const char *text); /* writes to standard error without buffers */

#endif
