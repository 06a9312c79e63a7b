/* Units are powers of 1000, as for disks and in most tools. */
#include "triangle/base/size_text.h"

#include <stdio.h>

/* Values beyond the last unit become "over 1000" of it, because bounds of the user may ask for any number. */
static struct tri_size_text text_in_units(double value, const char *const *unit, int n)
{
    struct tri_size_text text;
    int k = 0;
    for (; value >= 999.5 && k + 1 < n; k++)
        value *= 1e-3;
    if (value < 999.5)
        snprintf(text.text, sizeof text.text, "%.3g%s", value, unit[k]);
    else
        snprintf(text.text, sizeof text.text, "over 1000%s", unit[k]);
    return text;
}

struct tri_size_text tri_size_text(double bytes)
{
    static const char *const units[] = {" B", " kB", " MB", " GB", " TB", " PB", " EB"};
    return text_in_units(bytes, units, sizeof units / sizeof *units);
}

struct tri_size_text tri_count_text(double n)
{
    static const char *const units[] = {"", " thousand", " million", " billion", " trillion"};
    struct tri_size_text count;
    if (n >= 9999.5)
        return text_in_units(n, units, sizeof units / sizeof *units);
    snprintf(count.text, sizeof count.text, "%.0f", n);
    return count;
}
