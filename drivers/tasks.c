/* What launchers tell a program, and how its threads wait. */
#include "drivers/start.h"

#include <limits.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/system.h"

/* A whole number that the variable holds; -1: none, or one that no count of tasks is. */
static int number_of(const char *name)
{
    const char *text = getenv(name);
    char *end = NULL;
    const long long number = text ? strtoll(text, &end, 10) : -1;
    return end && end != text && *end == '\0' && number >= 0 && number <= INT_MAX ? (int)number : -1;
}

/* The variables of OpenMPI, of MPICH and its kin, of a step of SLURM. */
static const char *const sizes[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"};
static const char *const ranks[] = {"OMPI_COMM_WORLD_RANK", "PMI_RANK", "SLURM_PROCID"};

int tasks_started(int *task)
{
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        if (number_of(sizes[i]) > 1) {
            *task = number_of(ranks[i]) > 0 ? number_of(ranks[i]) : 0;
            return number_of(sizes[i]);
        }
    *task = 0;
    return 1;
}

/* The variables by which OpenMP, GCC's library and LLVM's are told how threads wait. */
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
    return strcmp(path + tri_path_folder_length(path), argv0 + tri_path_folder_length(argv0)) == 0;
}

/* Does every second processor have other work? */
static bool is_machine_busy(void)
{
    long running, processors;
    return tri_work(&running, &processors) && running > (processors + 1) / 2;
}

/* The variable that is set here tells the new program that it is the second start. The descriptors by which a launcher
 * is reached stay open, and there are no others: main() has opened nothing yet. */
void tasks_wait_idly(char **argv)
{
    char path[TRI_PATH];
    int task;
    if (is_way_told() || (tasks_started(&task) == 1 && !is_machine_busy()))
        return;
    if (tri_own_path(path) && argv[0] && is_program(path, argv[0]))
        tri_start_again(path, argv, "OMP_WAIT_POLICY", "passive");
}
