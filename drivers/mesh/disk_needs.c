/* Places are on the same disk if their folders have the same device. */
#include "drivers/mesh/disk_needs.h"

#include <math.h>
#include <stdbool.h>
#include <sys/stat.h>

#include "drivers/resources.h"

double disk_left(const struct disk_place *place) { return resources_disk(place->path); }

static bool device_of(const struct disk_place *place, dev_t *device)
{
    char folder[RESOURCES_PATH];
    struct stat info;
    resources_folder(place->path, folder);
    bool known = stat(folder, &info) == 0;
    *device = known ? info.st_dev : 0;
    return known;
}

static bool are_on_one_disk(const struct disk_place *a, const struct disk_place *b)
{
    dev_t one, other;
    return a == b || (device_of(a, &one) && device_of(b, &other) && one == other);
}

const struct disk_place *disk_too_small(const struct disk_place places[DISK_PLACES], double *needed)
{
    for (int i = 0; i < DISK_PLACES; i++) {
        *needed = 0;
        for (int k = 0; places[i].bytes > 0 && k < DISK_PLACES; k++)
            *needed += places[k].bytes > 0 && are_on_one_disk(&places[i], &places[k]) ? places[k].bytes : 0;
        if (*needed > 0 && *needed > disk_left(&places[i]))
            return &places[i];
    }
    return NULL;
}
