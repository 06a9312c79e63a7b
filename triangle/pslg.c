/* What every PSLG must fulfil before anything else looks at it. */
#include "triangle/pslg.h"

#include <math.h>
#include <stdlib.h>

#include "triangle/mesh.h"

enum tri_status tri_pslg_check(const struct tri_pslg *pslg, struct tri_error *error)
{
    if (pslg->n_points < 3)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "at least three vertices are needed, there are %d",
                        (int)pslg->n_points);
    if (pslg->n_points > TRI_MAX_VERTICES)
        return tri_fail(error, TRI_TOO_LARGE, NULL, 0, "%d vertices are more than one mesh can hold",
                        (int)pslg->n_points);
    for (int32_t i = 0; i < pslg->n_points; i++)
        if (!isfinite(pslg->points[2 * i]) || !isfinite(pslg->points[2 * i + 1]))
            return tri_fail(error, TRI_BAD_INPUT, NULL, 0,
                            "vertex %d (counted from 0) has a coordinate that is not finite", (int)i);
    return TRI_OK;
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
