/* Coordinates of any size, in the range of the predicates: what is very large or very small as a whole is multiplied by
 * a power of two, and what is below 2^-216 then counts as 0, in the mesh as in the input. The multiplication is exact
 * otherwise, and changes no judgement but those on areas, which quality.c scales back. */
#include <math.h>

#include "triangle/check/internal.h"

static bool are_exact(const double *values, int64_t n)
{
    for (int64_t i = 0; i < n; i++) {
        if (!tri_is_exact_coordinate(values[i]))
            return false;
    }
    return true;
}

/* 0 for coordinates of ordinary size, and where one is not finite; else the exponent that brings the largest to 1. */
static int choose_exponent(const struct tri_check_mesh *m)
{
    double largest = 0;
    for (size_t i = 0; i < 2 * (size_t)m->n_points; i++) {
        if (!isfinite(m->points[i]))
            return 0;
        largest = fmax(largest, fabs(m->points[i]));
    }
    return largest == 0 || (largest >= 0x1p-100 && largest <= 0x1p199) ? 0 : -ilogb(largest);
}

static double *scale(const double *values, int64_t n, int exponent)
{
    double *scaled = tri_check_array(n, sizeof *scaled);
    for (int64_t i = 0; scaled != NULL && i < n; i++)
        scaled[i] = tri_round_coordinate(ldexp(values[i], exponent));
    return scaled;
}

/* Their points only. */
static double *scale_regions(const struct tri_pslg *input, int exponent)
{
    double *scaled = scale(input->regions, 4 * (int64_t)input->n_regions, exponent);
    for (size_t k = 0; scaled != NULL && k < (size_t)input->n_regions; k++) {
        scaled[4 * k + 2] = input->regions[4 * k + 2];
        scaled[4 * k + 3] = input->regions[4 * k + 3];
    }
    return scaled;
}

enum tri_status tri_check_scale(struct checker *c)
{
    const struct tri_pslg *input = c->input;
    if (are_exact(c->mesh->points, 2 * (int64_t)c->mesh->n_points) &&
        (input == NULL || are_exact(input->points, 2 * (int64_t)input->n_points)))
        return TRI_OK;
    c->exponent = choose_exponent(c->mesh);
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
    c->scaled[3] = scale_regions(c->input, c->exponent);
    if (c->scaled[1] == NULL || c->scaled[2] == NULL || c->scaled[3] == NULL)
        return TRI_NO_MEMORY;
    c->scaled_input = *c->input;
    c->scaled_input.points = c->scaled[1];
    c->scaled_input.holes = c->scaled[2];
    c->scaled_input.regions = c->scaled[3];
    c->input = &c->scaled_input;
    return TRI_OK;
}
