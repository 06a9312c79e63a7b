#include "drivers/start.h"

#include "drivers/tasks.h"

#ifndef PTRIANGLE_MODULE

int main(int argc, char **argv)
{
    tasks_wait_idly(argv);
    return program_main(argc, argv);
}

#else /* its path from the folder of the executable */

#include <dlfcn.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "triangle/text/names.h"

static bool needs_module(int argc, char **argv)
{
    int task;
    bool needed = tasks_started(&task) > 1;
    for (int i = 1; i < argc; i++)
        needed = needed || tri_name_ends(argv[i], ".h5");
    return needed;
}

/* Beside the executable itself, by whatever links it was found; false: the system does not tell where that is. */
static bool module_path(char *path, size_t size)
{
    const ssize_t n = readlink("/proc/self/exe", path, size);
    if (n <= 0 || (size_t)n + sizeof "/" PTRIANGLE_MODULE > size)
        return false;
    path[n] = '\0';
    strcpy(strrchr(path, '/') + 1, PTRIANGLE_MODULE);
    return true;
}

/* Its symbols are for all, since an MPI loads parts of its own that look for those of others. It stays: what it brings
 * along leaves threads and handlers behind. */
static int run_module(int argc, char **argv)
{
    char path[4096];
    const bool found = module_path(path, sizeof path);
    void *module = found ? dlopen(path, RTLD_NOW | RTLD_GLOBAL) : NULL;
    int (*begin)(int, char **) = NULL;
    if (module)
        *(void **)&begin = dlsym(module, "program_main");
    if (begin)
        return begin(argc, argv);
    fprintf(stderr, "%s: the module for MPI and HDF5 cannot be loaded: %s\n", PTRIANGLE_NAME,
            found ? dlerror() : "/proc/self/exe does not tell where this program is");
    return program_trouble;
}

int main(int argc, char **argv)
{
    tasks_wait_idly(argv);
    return needs_module(argc, argv) ? run_module(argc, argv) : program_main(argc, argv);
}

#endif
