/* Coordinates of any size: multiplication by a power of two is exact as long as nothing becomes subnormal, and changes
 * no judgement but those on areas, which quality.c scales back. */
#include <math.h>

#include "triangle/check/internal.h"

/* Exponent that brings the largest coordinate to about 1; 0: there is no need, or none is finite. */
static int choose_exponent(const struct tri_check_mesh *m)
{
    double largest = 0;
    bool needed = false;
    for (size_t i = 0; i < 2 * (size_t)m->n_points; i++) {
        if (!isfinite(m->points[i]))
            return 0;
        needed = needed || !tri_is_exact_coordinate(m->points[i]);
        largest = fmax(largest, fabs(m->points[i]));
    }
    return needed ? -ilogb(largest) : 0;
}

static double *scale(const double *values, int64_t n, int exponent)
{
    double *scaled = tri_check_array(n, sizeof *scaled);
    for (int64_t i = 0; scaled != NULL && i < n; i++)
        scaled[i] = ldexp(values[i], exponent);
    return scaled;
}

enum tri_status tri_check_scale(struct checker *c)
{
    c->exponent = choose_exponent(c->mesh);
    if (c->exponent == 0)
        return TRI_OK;
    c->scaled[0] = scale(c->mesh->points, 2 * (int64_t)c->mesh->n_points, c->exponent);
    if (c->scaled[0] == NULL)
        return TRI_NO_MEMORY;
    c->scaled_mesh = *c->mesh;
    c->scaled_mesh.points = c->scaled[0];
    c->mesh = &c->scaled_mesh;
    if (c->input == NULL)
        return TRI_OK;
    c->scaled[1] = scale(c->input->points, 2 * (int64_t)c->input->n_points, c->exponent);
    c->scaled[2] = scale(c->input->holes, 2 * (int64_t)c->input->n_holes, c->exponent);
    if (c->scaled[1] == NULL || c->scaled[2] == NULL)
        return TRI_NO_MEMORY;
    c->scaled_input = *c->input;
    c->scaled_input.points = c->scaled[1];
    c->scaled_input.holes = c->scaled[2];
    c->input = &c->scaled_input;
    return TRI_OK;
}
