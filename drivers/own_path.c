#include "drivers/own_path.h"

#include <unistd.h>

bool own_path(char path[OWN_PATH])
{
    const ssize_t n = readlink("/proc/self/exe", path, OWN_PATH);
    const bool whole = n > 0 && n < OWN_PATH;
    path[whole ? n : 0] = '\0';
    return whole;
}
