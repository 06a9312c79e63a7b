/* Counts triangles at each pixel. If a triangle covers the centre of a pixel, it adds the number of such triangles that
 * fit into the pixel, so that few triangles give an even picture. Triangles much smaller than a pixel are counted at
 * their centroid. */
#include <math.h>

#include "drivers/plot/plot.h"

static const double SMALL = 0.125; /* area in pixels */

static void add(struct plot_density *d, double column, double row, double share)
{
    if (column >= 0 && column < d->width && row >= 0 && row < d->height)
        d->count[(size_t)row * (size_t)d->width + (size_t)column] += share;
}

/* Finds where a horizontal line crosses the triangle; from > to: nowhere. */
static void cut(double corner[3][2], double y, double *from, double *to)
{
    *from = INFINITY;
    *to = -INFINITY;
    for (int k = 0; k < 3; k++) {
        const double *a = corner[k], *b = corner[(k + 1) % 3];
        if ((a[1] <= y) == (b[1] <= y))
            continue;
        const double x = a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
        *from = fmin(*from, x);
        *to = fmax(*to, x);
    }
}

static void spread(struct plot_density *d, double corner[3][2], double share)
{
    const double low = fmin(fmin(corner[0][1], corner[1][1]), corner[2][1]);
    const double high = fmax(fmax(corner[0][1], corner[1][1]), corner[2][1]);
    const int end = (int)fmax(fmin(ceil(high - 0.5), d->height), 0);
    for (int row = (int)fmin(fmax(ceil(low - 0.5), 0), d->height); row < end; row++) {
        double from, to;
        cut(corner, row + 0.5, &from, &to);
        const int last = (int)fmax(fmin(ceil(to - 0.5), d->width), 0);
        for (int column = (int)fmin(fmax(ceil(from - 0.5), 0), d->width); column < last; column++)
            add(d, column, row, share);
    }
}

void plot_density_add(struct plot_density *d, const double *const at[3])
{
    double corner[3][2], x = 0, y = 0;
    for (int k = 0; k < 3; k++) {
        corner[k][0] = (at[k][0] - d->box.x0) / (d->box.x1 - d->box.x0) * d->width;
        corner[k][1] = (d->box.y1 - at[k][1]) / (d->box.y1 - d->box.y0) * d->height;
        x += corner[k][0] / 3;
        y += corner[k][1] / 3;
    }
    const double area = fabs((corner[1][0] - corner[0][0]) * (corner[2][1] - corner[0][1]) -
                             (corner[1][1] - corner[0][1]) * (corner[2][0] - corner[0][0])) / 2;
    if (area > SMALL && isfinite(area))
        spread(d, corner, 1 / area);
    else
        add(d, x, y, 1);
}
