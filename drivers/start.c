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

#include "triangle/text/names.h"

static bool needs_module(int argc, char **argv)
{
    int task;
    bool needed = tasks_started(&task) > 1;
    for (int i = 1; i < argc; i++)
        needed = needed || tri_name_h5(argv[i]) > 0;
    return needed;
}

/* Beside the executable itself, by whatever links it was found; false: the system does not tell where that is. */
static bool module_path(char path[OWN_PATH])
{
    if (!own_path(path) || strlen(path) + sizeof "/" PTRIANGLE_MODULE > OWN_PATH)
        return false;
    strcpy(strrchr(path, '/') + 1, PTRIANGLE_MODULE);
    return true;
}

static int complain(const char *what)
{
    fprintf(stderr, "%s: the module for MPI and HDF5 cannot be loaded: %s\n", PTRIANGLE_NAME, what);
    return program_trouble;
}

static int complain_of_version(const char *path, const char *version)
{
    fprintf(stderr, "%s %s: %s is that of version %s: programs and lib/ptriangle must be of one build\n",
            PTRIANGLE_NAME, program_version, path, version);
    return program_trouble;
}

/* Its symbols are for all, since an MPI loads parts of its own that look for those of others. It stays: what it brings
 * along leaves threads and handlers behind. */
static int run_module(int argc, char **argv)
{
    char path[OWN_PATH];
    if (!module_path(path))
        return complain("/proc/self/exe does not tell where this program is");
    void *module = dlopen(path, RTLD_NOW | RTLD_GLOBAL);
    const char *version = module ? dlsym(module, "program_version") : NULL;
    if (version && strcmp(version, program_version) != 0)
        return complain_of_version(path, version);
    int (*begin)(int, char **) = NULL;
    if (version)
        *(void **)&begin = dlsym(module, "program_main");
    return begin ? begin(argc, argv) : complain(dlerror());
}

int main(int argc, char **argv)
{
    tasks_wait_idly(argv);
    return needs_module(argc, argv) ? run_module(argc, argv) : program_main(argc, argv);
}

#endif
