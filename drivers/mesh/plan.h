/* Decides before refinement how a run is carried out, from its needs and the available memory. The mesh is in memory;
 * or, with --memory, partly in files; or it is swept: only a few columns are in memory, and files are written during
 * refinement. */
#ifndef DRIVERS_MESH_PLAN_H
#define DRIVERS_MESH_PLAN_H

#include "drivers/mesh/needs.h"

/* Returns the bytes of memory that the process may still use, limited by the system and by --memory. */
double plan_memory_left(const struct run *run);

/* Checks that these text files of one input fit into memory. A name without a file needs nothing. TRI_NO_MEMORY, with
 * figures. */
enum tri_status plan_check_files(const struct run *run, const struct file_names *files);

/* Checks that the input can be triangulated, which always happens in memory. TRI_NO_MEMORY if it certainly cannot, or
 * if a requested bound (--memory) would probably be exceeded; otherwise at most a warning. */
enum tri_status plan_check_input(const struct run *run);

/* Decides, and prints a line if the mesh is swept or lies in files. If memory or disk is certainly too small, returns
 * TRI_TOO_LARGE, TRI_NO_MEMORY or TRI_CANNOT_WRITE, with required and available sizes. If it is probably too small,
 * prints a warning. */
enum tri_status plan_make(struct run_plan *plan, const struct run *run, const struct estimate *estimate);

/* Prints the plan for a dry run. */
void plan_print(const struct run *run, const struct estimate *estimate);

#endif
