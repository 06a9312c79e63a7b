/* Units of 1000, as disks and most tools count. */
#include "triangle/size_text.h"

#include <stdio.h>

struct tri_size_text tri_size_text(double bytes)
{
    static const char *const units[] = {"B", "kB", "MB", "GB", "TB", "PB"};
    struct tri_size_text size;
    double value = bytes;
    int unit = 0;
    for (; value >= 999.5 && unit < 5; unit++)
        value *= 1e-3;
    snprintf(size.text, sizeof size.text, "%.3g %s", value, units[unit]);
    return size;
}

struct tri_size_text tri_count_text(double n)
{
    struct tri_size_text count;
    if (n < 9999.5)
        snprintf(count.text, sizeof count.text, "%.0f", n);
    else if (n < 999.5e3)
        snprintf(count.text, sizeof count.text, "%.3g thousand", 1e-3 * n);
    else
        snprintf(count.text, sizeof count.text, "%.3g million", 1e-6 * n);
    return count;
}
