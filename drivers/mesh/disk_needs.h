/* Is there room on disk for all that a run puts there: its files, what does not fit in memory, checkpoints? */
#ifndef DRIVERS_MESH_DISK_NEEDS_H
#define DRIVERS_MESH_DISK_NEEDS_H

#include "triangle/base/status.h"

enum { DISK_PLACES = 3 };

struct disk_place {
    const char *what; /* "its files" */
    const char *path; /* a folder, or a file that is there or will be */
    double bytes;     /* that will be needed there */
};

/* Bytes left where the place is; +oo: not known. */
double disk_left(const struct disk_place *place);

/* The first place on a disk that has less left than all places on it need; NULL: none. *needed receives that. */
const struct disk_place *disk_too_small(const struct disk_place places[DISK_PLACES], double *needed);

#endif
