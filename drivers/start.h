/* Start of the programs that may need MPI or HDF5.
 *
 * These libraries load about forty shared libraries, which takes several times as long as making a small mesh. So a
 * program is built twice from the same objects. The executable has stand-ins for both (drivers/mesh/launch_alone.c,
 * triangle/hdf5/none.c). A module has both. The executable loads and calls the module if the program is one of several
 * tasks, or if an argument names an HDF5 file; from then on only the module runs. If modules cannot be loaded
 * (cmake/programs.cmake), the executable contains everything. */
#ifndef DRIVERS_START_H
#define DRIVERS_START_H

#include <stdbool.h>

/* The main function of the program, exported by the module. */
__attribute__((visibility("default"))) int program_main(int argc, char **argv);

/* Version of the program. A module of another version is rejected. */
__attribute__((visibility("default"))) extern const char program_version[];

/* Exit code if the module cannot be loaded. */
extern const int program_trouble;

/* Returns how many tasks a launcher (mpirun, srun) has started; without a launcher 1. *task: number of this task, from
 * 0. */
int tasks_started(int *task);

#endif
