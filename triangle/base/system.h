/* The one door to the operating system: files, folders, maps, memory, time, threads, the terminal, interrupts.
 *
 * No other file names a function or a header of a system (tests/house_rules.sh). system_posix.c has the functions for
 * POSIX, system_windows.c and system_windows_threads.c have those for Windows. Those of the second half, which programs
 * alone use, are in system_posix_process.c and system_windows_process.c.
 *
 * ERRORS. A function that fails returns false, NULL, -1 or TRI_NO_FILE, and errno says why, by the codes of C's
 * library. EINTR: an interrupt came first; functions that do not name it go on instead.
 * NAMES of files hold '/' between folders; on Windows they are UTF-8, and '\' and "C:" are known, too. What a function
 * returns as char * is malloc'ed. */
#ifndef TRIANGLE_BASE_SYSTEM_H
#define TRIANGLE_BASE_SYSTEM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { TRI_PATH = 4096 }; /* bytes of a path that somebody has room for */

/* --- files */

typedef intptr_t tri_file; /* an open file or folder, which no other program inherits; to be closed */
#define TRI_NO_FILE ((tri_file)-1)

enum tri_opening {
    TRI_OPEN_READ,   /* a pipe is waited for until somebody writes it; EINTR */
    TRI_OPEN_LOOK,   /* to read; nothing is waited for */
    TRI_OPEN_DEVICE, /* to write what has no places: a device or pipe, until somebody reads it; EINTR */
    TRI_OPEN_JOIN,   /* to write what others write as well; no link is followed */
    TRI_OPEN_NEW     /* to read and write, made here: EEXIST where the name is taken, by a file or a link */
};
tri_file tri_file_open(const char *path, enum tri_opening opening);

/* A new, empty file in the folder without a name, to read and write: it goes with whoever has it open, however that
 * ends. Where the file system knows no such files, a process that is killed outright may leave an empty
 * ptriangle-XXXXXX; Windows shows the name until then. */
tri_file tri_scratch_file(const char *folder);

/* TRI_NO_FILE is fine. Some file systems report only here that what was written found no room: false. */
bool tri_file_close(tri_file file);

enum tri_file_kind { TRI_REGULAR, TRI_FOLDER, TRI_OTHER_FILE };

struct tri_file_facts {
    enum tri_file_kind kind;
    uint64_t size;         /* bytes */
    uint64_t device, node; /* both are equal: it is one file */
    unsigned names;        /* how many it has */
    unsigned permissions;  /* for tri_file_permit */
};

/* Of the file behind all links. */
bool tri_path_look(const char *path, struct tri_file_facts *facts);
bool tri_file_look(tri_file file, struct tri_file_facts *facts);

/* Gives the file the permissions of another one. */
bool tri_file_permit(tri_file file, const struct tri_file_facts *as);

/* Reads n bytes at a place; fewer only at the end of the file. How many. */
int64_t tri_read_at(tri_file file, void *at, size_t n, uint64_t place);

/* Reads n bytes that have been written. EIO: there are fewer. */
bool tri_read_again(tri_file file, void *at, size_t n, uint64_t place);
bool tri_write_at(tri_file file, const void *at, size_t n, uint64_t place);

/* The next bytes, up to n, of what has no places, or of a file from its begin on; 0: the end. EINTR. */
int64_t tri_read_next(tri_file file, void *at, size_t n);

/* Writes as much as the system takes at once: at a place, or next. EINTR. */
int64_t tri_write_some(tri_file file, const void *at, size_t n, uint64_t place);
int64_t tri_write_next(tri_file file, const void *at, size_t n);

/* The file has so many bytes afterwards: the first, or zeros behind all. */
bool tri_file_cut(tri_file file, uint64_t size);

/* What has been written is on the disk afterwards; of a folder, the names in it. True where nobody can ask for that. */
bool tri_file_sync(tri_file file);

/* Hints: the system begins to write n bytes (0: all) to the disk; these are there afterwards. */
void tri_file_send_off(tri_file file, uint64_t place, uint64_t n);
void tri_file_await(tri_file file, uint64_t place, uint64_t n);

/* The same file once more, to be written past the system's cache: sizes, places and memory are multiples of
 * TRI_PAGE_BYTES then. TRI_NO_FILE: there is no such way. Closing either drops the lock of the file. */
enum { TRI_PAGE_BYTES = 4096 };
tri_file tri_file_direct(tri_file file);

/* Memory for it, which free() takes. NULL: there is none. */
void *tri_page_alloc(size_t bytes);

/* Writing that goes on while its caller does: the bytes are lent until it is waited for. NULL: it cannot be had. The
 * second frees it, and returns how many bytes have been written. */
struct tri_behind *tri_behind_start(tri_file file, const void *at, size_t n, uint64_t place);
size_t tri_behind_wait(struct tri_behind *behind);

/* A lock of the whole file, against other processes. It goes when this one closes the file, by any opening of it, or
 * dies. */
enum tri_lock { TRI_LOCKED, TRI_LOCKED_BY_ANOTHER, TRI_NO_LOCKS };
enum tri_lock tri_file_lock(tri_file file);

/* Do bytes that two processes write into one page of this file keep apart, if the other one opened it on that host? */
bool tri_file_keeps_apart(tri_file file, const char *host);

/* --- names of files */

enum tri_access { TRI_THERE, TRI_READABLE, TRI_WRITABLE, TRI_TAKES_FILES };
bool tri_path_allows(const char *path, enum tri_access access);

/* May be called by handlers of interrupts. */
bool tri_path_remove(const char *path);

/* Whatever has the new name loses it, in one step. */
bool tri_path_rename(const char *from, const char *to);

/* A second name of the file. */
bool tri_path_link(const char *path, const char *second);

/* The path behind all symbolic links, existing or not. EPERM: one of them is of another user, who is neither the
 * administrator nor owns the folder; ENAMETOOLONG, ELOOP. */
char *tri_path_resolve(const char *path);

/* The path of a file that is there, from the root on. */
char *tri_path_from_root(const char *path);

/* Of the folder's part of a path, with the last '/'; 0: the working folder. */
size_t tri_path_folder_length(const char *path);

/* The folder itself, or that of a file which is there or will be. */
void tri_path_folder(const char *path, char folder[TRI_PATH]);

/* --- folders */

bool tri_folder_make(const char *path);
bool tri_folder_remove(const char *path); /* which is empty */

/* The folder at this path, which may be a link to it. own: EPERM, if it is another user's. */
tri_file tri_folder_open(const char *path, bool own);

/* By an open folder: what others do with its path meanwhile, or put into it, leads nowhere else. Names hold no slash;
 * no link is followed, and no file but a regular one of this user is opened: EPERM. */
enum tri_folder_opening {
    TRI_FOLDER_READ,
    TRI_FOLDER_CHANGE, /* to read and write */
    TRI_FOLDER_EXTEND  /* the same, made unless it is there; EPERM also where it has a second name */
};
tri_file tri_folder_file(tri_file folder, const char *name, enum tri_folder_opening opening);

/* A new, empty file to write; a file of that name is removed from the folder. tri_folder_end gives the new one the name
 * once it is complete and on the disk: if the process dies before, nothing is left. Systems without files that have no
 * name (NFS) give it the name at once. */
tri_file tri_folder_create(tri_file folder, const char *name);
bool tri_folder_end(tri_file folder, const char *name, tri_file file);

bool tri_folder_has(tri_file folder, const char *name);
bool tri_folder_drop(tri_file folder, const char *name);
bool tri_folder_rename(tri_file folder, const char *from, const char *to);

/* Calls for each name in it, until one call returns false. False: it cannot be listed. */
bool tri_folder_list(tri_file folder, bool (*each)(void *user, const char *name), void *user);

/* --- files in memory */

/* An array in a scratch file that is mapped into memory, so that it may be larger than memory. */
struct tri_mapped_file {
    tri_file file; /* TRI_NO_FILE: none yet */
    size_t size;   /* bytes of disk that are reserved or written */
    void *at;      /* mapping of all of them; NULL: not mapped */
};

/* Reserves disk space up to `size` bytes, which is more than now, and maps all of it; makes the file in the folder if
 * there is none. A full disk or a limit is an error here, not a signal when the array is written. Returns 0 or an
 * errno; then the old mapping stays. */
int tri_mapped_file_extend(struct tri_mapped_file *f, const char *folder, size_t size);

/* Writes n bytes behind the others; the file must not be mapped. */
bool tri_mapped_file_append(struct tri_mapped_file *f, const char *folder, const void *bytes, size_t n);

/* Maps what has been written, if anything has and it is not mapped. */
bool tri_mapped_file_map(struct tri_mapped_file *f);

/* Lets the system drop the pages from memory; the bytes stay. Nothing happens without a mapping. */
void tri_mapped_file_release_pages(const struct tri_mapped_file *f);

/* Unmaps and closes the file, which deletes it; errno stays. */
void tri_mapped_file_close(struct tri_mapped_file *f);

/* --- memory and disk: bytes */

/* Memory that may be used on top of what is: the least that is left under the limits of the machine, swap included, of
 * the process and of the groups that it is in. What of these cannot be read limits nothing; HUGE_VAL: nothing could
 * be. The second: what they give to begin with. */
double tri_memory_left(void);
double tri_memory_total(void);

/* What ends first of these. Beyond the limits of a process a request for memory fails at once; mapped files count as
 * address space, too. */
enum tri_memory_end { TRI_ENDS_SYSTEM, TRI_ENDS_DATA, TRI_ENDS_ADDRESS_SPACE };
enum tri_memory_end tri_memory_end(void);

/* What the process has in memory now; 0: not known. *of_files (unless NULL): pages of files in it, libraries, too. */
double tri_memory_used(double *of_files);
int64_t tri_memory_peak(void); /* the most so far; 0: not known */

/* Memory that was freed goes back to the system. */
void tri_memory_trim(void);

/* Where the process has limits all threads share one heap from now on: one for each would take 64 MB of address space.
 * To be called before they allocate. */
void tri_memory_share_heap(void);

/* For the stacks of so many threads, touched or not, less those that are there. */
double tri_memory_of_stacks(int threads);

/* Free on the file system that holds this file or folder; HUGE_VAL: not known. */
double tri_disk_left(const char *path);

/* The folder for scratch files: TMPDIR, otherwise /tmp, or on Windows what GetTempPath says. */
const char *tri_scratch_folder(void);

/* --- time: no decision about a mesh depends on it */

double tri_seconds(void);         /* on the clock */
double tri_thread_seconds(void);  /* of processor time that this thread has had: others at work do not count */
double tri_process_seconds(void); /* of processors that all threads have taken */

/* False: an interrupt has come before the time is over. */
bool tri_pause(double seconds);

/* --- threads, for sched/ alone */

int tri_processors(void); /* that this process may use; at least 1 */

/* Starts a thread that interrupts do not find, but for those that its own fault raises: they are for the others. NULL:
 * there are no more. */
struct tri_thread *tri_thread_start(void *(*run)(void *user), void *user);
void tri_thread_join(struct tri_thread *thread); /* waits for its end, and frees it */

/* A lock and a condition: what others wait for may have changed. */
struct tri_monitor *tri_monitor_new(void); /* NULL: no memory */
void tri_monitor_free(struct tri_monitor *monitor); /* NULL is fine */
void tri_monitor_enter(struct tri_monitor *monitor);
void tri_monitor_leave(struct tri_monitor *monitor);
void tri_monitor_wait(struct tri_monitor *monitor);   /* inside: leaves, waits until somebody wakes all, and enters */
void tri_monitor_wake(struct tri_monitor *monitor);   /* all that wait */

/* --- functions of the program */

#ifdef __APPLE__
void (*tri_find_function(const char *name))(void); /* by its name; NULL: the program has none */
#endif

/* --- processes and hosts */

long tri_process(void); /* the number of this one */
bool tri_process_is_gone(long process); /* on this host, as far as can be seen */
bool tri_host_name(char *name, size_t room); /* cut, if it is longer; false: not known */

/* ------ from here on in system_posix_process.c or system_windows_process.c, for drivers/ alone */

/* What main() was given, in UTF-8; no memory: as it was. */
char **tri_arguments(int argc, char **argv);

/* What the system's shells have around a word that is more than letters. */
const char *tri_word_quote(void);

/* The path of the program's executable, by whatever links it was found. */
bool tri_own_path(char path[TRI_PATH]);

/* --- the terminal */

/* A closed standard input, output or error becomes one that holds nothing: else a file would get its number. */
void tri_standard_open(void);
bool tri_standard_is_one(void);          /* output and error lead to one place */
bool tri_standard_is_terminal(void);     /* standard error */
bool tri_standard_reader_is_gone(void);  /* who read standard output through a pipe has closed it */
tri_file tri_standard_error_again(void); /* a second opening of it; TRI_NO_FILE where it is closed */

/* --- interrupts: what asks a program to end, or tells of its crash */

/* Handlers are called at any time, on any thread, amid anything: of functions here they call tri_path_remove, tri_say
 * and tri_alarm alone. */
struct tri_interrupts {
    void (*asked)(int number); /* somebody asks for the end; > 0: what has, below 128 */
    void (*time_is_up)(void);  /* since tri_alarm */
    void (*crashed)(void);     /* the program ends when this returns */
};

/* From now on handlers hear of all that would end the program, but for what its caller has it ignore. Too large a file,
 * and a reader of standard output that went away, are errors of writing. False: there is no alarm. To be called
 * once. */
bool tri_interrupts_catch(const struct tri_interrupts *handlers);
const char *tri_interrupt_name(int number); /* "SIGTERM"; NULL: none has this number */
void tri_alarm(double seconds); /* from now; the last one counts */
void tri_say(const char *text); /* on standard error, past all buffers */

#endif
