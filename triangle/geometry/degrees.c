/* By power series: + - * / alone. */
#include "triangle/geometry/degrees.h"

#include <assert.h>

double tri_cos_degrees(double degrees)
{
    static const double radians = 0.017453292519943295769;
    assert(degrees >= 0 && degrees <= 180);
    if (degrees > 90)
        return -tri_cos_degrees(180 - degrees);
    double x = degrees * radians, x2 = x * x, term = 1, sum = 1;
    for (int k = 1; k <= 15; k++) {
        term = -term * x2 / ((2 * k - 1) * (2 * k));
        sum += term;
    }
    return sum;
}
