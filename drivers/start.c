#define _POSIX_C_SOURCE 200809L /* stat, dlopen: this is the only file that loads a module */
#include "drivers/start.h"

#ifndef PTRIANGLE_MODULE

#include "triangle/base/system.h"

int main(int argc, char **given)
{
    char **argv = tri_arguments(argc, given);
    return program_main(argc, argv);
}

#else /* path of the module, relative to the folder of the executable (PTRIANGLE_MODULE_FOLDER) */

#include <dlfcn.h>
#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "triangle/base/system.h"
#include "triangle/text/names.h"

static bool needs_module(int argc, char **argv)
{
    int task;
    bool needed = tasks_started(&task) > 1;
    for (int i = 1; i < argc; i++)
        needed = needed || tri_name_h5(argv[i]) > 0;
    return needed;
}

/* Makes the path of a file relative to the folder of the executable, after links to the executable are resolved.
 * Returns false if the system does not provide the location. */
static bool place_of(char path[TRI_PATH], const char *name)
{
    if (!tri_program_path(path) || strlen(path) + strlen(name) + 1 > TRI_PATH)
        return false;
    strcpy(strrchr(path, '/') + 1, name);
    return true;
}

static int complain(const char *path, const char *why)
{
    fprintf(stderr, "%s: the module for MPI and HDF5 cannot be loaded: %s: %s\n", PTRIANGLE_NAME, path, why);
    return program_trouble;
}

static int complain_of_version(const char *path, const char *version)
{
    fprintf(stderr, "%s %s: %s is that of version %s: programs and lib/ptriangle must be of one build\n",
            PTRIANGLE_NAME, program_version, path, version);
    return program_trouble;
}

/* Returns true if the file or folder belongs to the administrator, to the owner of the program or to this user; path
 * receives its path. Otherwise returns false, and errno says why (EPERM: another owner). The reason: a user may link a
 * program into a folder of their own, with a module of their own beside it. If another user starts the program there,
 * it must not run that module. */
static bool is_trusted(const char *name, char path[TRI_PATH])
{
    struct stat program, at;
    if (!place_of(path, name) || stat("/proc/self/exe", &program) != 0 || stat(path, &at) != 0)
        return false;
    errno = EPERM;
    return at.st_uid == 0 || at.st_uid == program.st_uid || at.st_uid == geteuid();
}

/* Loads with global symbols, because parts of an MPI look for symbols of others. The module is never unloaded, because
 * its libraries leave threads and handlers behind. */
static int run_module(int argc, char **argv)
{
    char path[TRI_PATH];
    if (!place_of(path, PTRIANGLE_MODULE))
        return complain("/proc/self/exe", "does not tell where this program is");
    if (!is_trusted(".", path) || !is_trusted(PTRIANGLE_MODULE_FOLDER, path) ||
        !is_trusted(PTRIANGLE_MODULE_FOLDER "/..", path) || !is_trusted(PTRIANGLE_MODULE, path))
        return complain(path, errno == EPERM ? "belongs neither to root nor to the program's owner nor to you"
                                             : strerror(errno));
    void *module = dlopen(path, RTLD_NOW | RTLD_GLOBAL);
    const char *version = module ? dlsym(module, "program_version") : NULL;
    if (version && strcmp(version, program_version) != 0)
        return complain_of_version(path, version);
    int (*begin)(int, char **) = NULL;
    if (version)
        *(void **)&begin = dlsym(module, "program_main");
    return begin ? begin(argc, argv) : complain(path, dlerror());
}

int main(int argc, char **given)
{
    char **argv = tri_arguments(argc, given);
    return needs_module(argc, argv) ? run_module(argc, argv) : program_main(argc, argv);
}

#endif
