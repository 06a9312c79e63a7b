/* Where the program's executable lies. */
#ifndef DRIVERS_OWN_PATH_H
#define DRIVERS_OWN_PATH_H

#include <stdbool.h>

enum { OWN_PATH = 4096 };

/* Its path, by whatever links it was found. False: the system does not tell. */
bool own_path(char path[OWN_PATH]);

#endif
