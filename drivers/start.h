/* Where the programs begin that may need MPI or HDF5.
 *
 * These come with some forty shared libraries, which take several times as long to load as a small mesh to make. So a
 * program is built twice, of the same objects: as the executable, which has stand-ins instead
 * (drivers/mesh/launch_alone.c, triangle/hdf5/none.c), and as a module with both, which the executable loads and calls
 * where it is one of several tasks or a word names an HDF5 file. From then on the executable does nothing of its own.
 * Where modules cannot be loaded (cmake/programs.cmake) the executable has all itself. */
#ifndef DRIVERS_START_H
#define DRIVERS_START_H

#include <stdbool.h>

/* The program: its main(), which the module lets out. */
__attribute__((visibility("default"))) int program_main(int argc, char **argv);

/* Of which version it is: a module of another one is refused. */
__attribute__((visibility("default"))) extern const char program_version[];

/* Its exit code where the module cannot be loaded. */
extern const int program_trouble;

/* How many tasks a launcher (mpirun, srun) has started, of which this is number *task, from 0; without a launcher 1. */
int tasks_started(int *task);

#endif
