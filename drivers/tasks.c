#include "drivers/tasks.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static long number_of(const char *name)
{
    const char *text = getenv(name);
    return text ? strtol(text, NULL, 10) : -1;
}

/* OpenMPI, then MPICH and its kin, then a step of SLURM. */
static const char *const sizes[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"};
static const char *const ranks[] = {"OMPI_COMM_WORLD_RANK", "PMI_RANK", "SLURM_PROCID"};

int tasks_started(int *task)
{
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        if (number_of(sizes[i]) > 1) {
            *task = number_of(ranks[i]) > 0 ? (int)number_of(ranks[i]) : 0;
            return (int)number_of(sizes[i]);
        }
    *task = 0;
    return 1;
}

/* Of OpenMP, GCC's library and LLVM's. */
static const char *const ways_to_wait[] = {"OMP_WAIT_POLICY", "GOMP_SPINCOUNT", "KMP_BLOCKTIME"};

static bool is_way_told(void)
{
    for (size_t i = 0; i < sizeof ways_to_wait / sizeof *ways_to_wait; i++)
        if (getenv(ways_to_wait[i]))
            return true;
    return false;
}

/* Is this file the program that argv names, rather than a loader that was given it? */
static bool is_program(const char *path, const char *argv0)
{
    const char *file = strrchr(path, '/'), *name = strrchr(argv0, '/');
    return strcmp(file ? file + 1 : path, name ? name + 1 : argv0) == 0;
}

/* What is set tells the new start that it is one. The descriptors by which a launcher is reached stay open: whoever is
 * at main() has not yet opened any. */
void tasks_wait_idly(char **argv)
{
    char path[4096];
    int task;
    if (tasks_started(&task) == 1 || is_way_told())
        return;
    const ssize_t n = readlink("/proc/self/exe", path, sizeof path);
    if (n <= 0 || (size_t)n == sizeof path)
        return;
    path[n] = '\0';
    if (argv[0] && is_program(path, argv[0]) && setenv("OMP_WAIT_POLICY", "passive", 1) == 0)
        execv(path, argv);
}
