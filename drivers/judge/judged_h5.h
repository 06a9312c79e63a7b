/* An HDF5 file of a mesh on trial, as slices. */
#ifndef DRIVERS_JUDGE_JUDGED_H5_H
#define DRIVERS_JUDGE_JUDGED_H5_H

#include "triangle/check/check.h"

struct judged_h5;

/* Errors: as triangle/hdf5/h5_read.h. *h5 is NULL then. */
enum tri_status judged_h5_open(struct judged_h5 **h5, const char *path, struct tri_error *error);
void judged_h5_close(struct judged_h5 *h5); /* NULL is fine */

struct tri_check_source judged_h5_source(struct judged_h5 *h5);

#endif
