/* Basic checks of a PSLG, made before any other use. */
#include "triangle/mesh/pslg.h"

#include <math.h>
#include <stdlib.h>

enum { MOST_RECORDS = 1 << 28 }; /* of each kind: four times this number still fits an int32_t index */

static enum tri_status check_count(const char *what, int32_t n, const void *array, struct tri_error *error)
{
    if (n < 0 || (n > 0 && !array))
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "the number of %s is %d, without an array", what, (int)n);
    if (n > MOST_RECORDS)
        return tri_fail(error, TRI_TOO_LARGE, NULL, 0, "%d %s are more than one mesh can hold", (int)n, what);
    return TRI_OK;
}

static enum tri_status check_finite(const char *what, int32_t n, const double *values, int width,
                                    struct tri_error *error)
{
    for (int32_t i = 0; i < n; i++) {
        const double *at = values + (size_t)i * (size_t)width;
        if (!isfinite(at[0]) || !isfinite(at[1]))
            return tri_fail(error, TRI_BAD_INPUT, NULL, 0,
                            "%s %d (counted from 0) has a coordinate that is not finite", what, (int)i);
    }
    return TRI_OK;
}

enum tri_status tri_pslg_check_values(const struct tri_pslg *pslg, struct tri_error *error)
{
    enum tri_status status = check_count("vertices", pslg->n_points, pslg->points, error);
    status = status ? status : check_count("attributes of a vertex", pslg->n_attributes, pslg->attributes, error);
    status = status ? status : check_count("segments", pslg->n_segments, pslg->segments, error);
    status = status ? status : check_count("holes", pslg->n_holes, pslg->holes, error);
    status = status ? status : check_count("regions", pslg->n_regions, pslg->regions, error);
    status = status ? status : check_finite("vertex", pslg->n_points, pslg->points, 2, error);
    status = status ? status : check_finite("hole", pslg->n_holes, pslg->holes, 2, error);
    return status ? status : check_finite("region", pslg->n_regions, pslg->regions, 4, error);
}

enum tri_status tri_pslg_check(const struct tri_pslg *pslg, struct tri_error *error)
{
    if (pslg->n_points < 3)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "at least three vertices are needed, there are %d",
                        (int)pslg->n_points);
    return tri_pslg_check_values(pslg, error);
}

bool tri_pslg_is_one_place(const struct tri_pslg *pslg)
{
    const double *points = pslg->points;
    for (int32_t i = 1; i < pslg->n_points; i++)
        if (points[2 * (size_t)i] != points[0] || points[2 * (size_t)i + 1] != points[1])
            return false;
    return pslg->n_points >= 3;
}

void tri_pslg_free(struct tri_pslg *pslg)
{
    free(pslg->points);
    free(pslg->attributes);
    free(pslg->markers);
    free(pslg->segments);
    free(pslg->segment_markers);
    free(pslg->holes);
    free(pslg->regions);
    *pslg = (struct tri_pslg){0};
}

void tri_elements_free(struct tri_elements *elements)
{
    free(elements->corners);
    free(elements->attributes);
    free(elements->areas);
    free(elements->extra);
    *elements = (struct tri_elements){0};
}
