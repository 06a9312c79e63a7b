/* What the system has left for this process. */
#ifndef DRIVERS_RESOURCES_H
#define DRIVERS_RESOURCES_H

#include <stdbool.h>
#include <stdint.h>

/* Bytes of memory that may be used on top of what is: the least that is left under the limits of the machine
 * (/proc/meminfo, swap included), of the process (RLIMIT_AS, RLIMIT_DATA) and of its control groups, versions 1 and 2,
 * up to the root. What of these cannot be read limits nothing; HUGE_VAL: nothing could be. */
double resources_memory(void);

/* What ends first of these. Beyond the limits of a process a request for memory fails at once; mapped files count as
 * address space, too. */
enum resources_end { RESOURCES_SYSTEM, RESOURCES_DATA, RESOURCES_ADDRESS_SPACE };
enum resources_end resources_memory_end(void);

/* Where the process has limits all threads share one heap from now on: one for each would take 64 MB of address space.
 * To be called before they allocate. */
void resources_save_address_space(void);

/* Bytes for the stacks of so many threads, touched or not, less those that are there. */
double resources_stacks(int threads);

/* Bytes of memory that the machine, the process's limits and its control groups, the least of them, give to begin with;
 * HUGE_VAL: not known. */
double resources_memory_total(void);

/* Bytes of memory that it uses now, as far as they are in memory; 0: not known. */
double resources_memory_used(void);

/* The most that it has had there; 0: not known. */
int64_t resources_memory_peak(void);

/* Seconds of processors that all its threads have taken. */
double resources_processor_seconds(void);

enum { RESOURCES_PATH = 4096 };

/* The folder itself, or that of a file which is there or will be. */
void resources_folder(const char *path, char folder[RESOURCES_PATH]);

/* Bytes free on the file system that holds this folder; HUGE_VAL: not known. */
double resources_disk(const char *path);

/* The folder for scratch files: TMPDIR, otherwise /tmp. */
const char *resources_scratch(void);

/* From the command line, a number, and maybe a letter that stands for a factor; the product is from low to high. False:
 * it is none, and nothing has changed. */
bool resources_take_real(const char *text, const char *letters, const double *factor, double low, double high,
                         double *value);

/* Bytes, at least so many: 500M; or a share: 60%. The other one becomes 0. */
bool resources_take_size(const char *text, double least, double *bytes, double *share);

#endif
