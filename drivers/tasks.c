/* Reads the environment variables that launchers set. */
#include "drivers/start.h"

#include <limits.h>
#include <stddef.h>
#include <stdlib.h>

/* Returns the whole number in the variable, or -1 if there is none or it cannot be a number of tasks. */
static int number_of(const char *name)
{
    const char *text = getenv(name);
    char *end = NULL;
    const long long number = text ? strtoll(text, &end, 10) : -1;
    return end && end != text && *end == '\0' && number >= 0 && number <= INT_MAX ? (int)number : -1;
}

/* The variables of OpenMPI, of MPICH and related libraries, and of a step of SLURM. */
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
