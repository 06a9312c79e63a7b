/* How a run is carried out: with the whole mesh in memory, or, where --memory bounds that, in files as far as it does
 * not fit; or swept, with a few columns of it there at a time and files written meanwhile. Decided by what the run will
 * need and what there is, before it begins to refine. */
#ifndef DRIVERS_MESH_PLAN_H
#define DRIVERS_MESH_PLAN_H

#include "drivers/mesh/needs.h"

/* Bytes of memory that the process may still take: what is left of the system's and of --memory. */
double plan_memory_left(const struct run *run);

/* Can these files, the texts of one input, be read into memory? A name that is no file takes nothing. TRI_NO_MEMORY,
 * with figures. */
enum tri_status plan_check_files(const struct run *run, const struct file_names *files);

/* Can what has been read be triangulated, which takes place in memory whatever comes then? TRI_NO_MEMORY beyond doubt,
 * or where a bound that was asked for (--memory) would hardly be kept; else at most a warning. */
enum tri_status plan_check_input(const struct run *run);

/* Decides, and says a line where the mesh is swept, or lies in files. The run is to be refused, with what it needs and
 * what there is, where memory or disk cannot do beyond doubt: TRI_TOO_LARGE, TRI_NO_MEMORY, TRI_CANNOT_WRITE; where
 * they hardly can, there is a warning. */
enum tri_status plan_make(struct run_plan *plan, const struct run *run, const struct estimate *estimate);

/* For a dry run. */
void plan_print(const struct run *run, const struct estimate *estimate);

#endif
