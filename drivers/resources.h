/* What the system has left for this process. */
#ifndef DRIVERS_RESOURCES_H
#define DRIVERS_RESOURCES_H

#include <stdint.h>

/* Bytes of memory that may be used on top of what is: the least that is left under the limits of the machine
 * (/proc/meminfo, swap included), of the process (RLIMIT_AS, RLIMIT_DATA) and of its control groups, versions 1 and 2,
 * up to the root. What of these cannot be read limits nothing; HUGE_VAL: nothing could be. */
double resources_memory(void);

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

#endif
