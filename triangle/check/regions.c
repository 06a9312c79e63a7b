/* Attributes of triangles: the same on both sides of every edge that is no subsegment. So all triangles of a face have
 * one, and what it should be is asked of the sweep (overlap.c). */
#include "triangle/check/internal.h"

static bool differs(const struct checker *c, int32_t h)
{
    return h < c->link[h] && !check_is_constrained(c, h) &&
           check_attribute(c, h / 3) != check_attribute(c, c->link[h] / 3);
}

static void tell(struct checker *c, int32_t h)
{
    int32_t t = h / 3, u = c->link[h] / 3;
    tri_check_fault(c, TRI_CHECK_REGIONS, "triangles %ld and %ld have attributes %.17g and %.17g, no segment between",
                    check_number(c, t), check_number(c, u), check_attribute(c, t), check_attribute(c, u));
}

enum tri_status tri_check_regions(struct checker *c)
{
    const struct tri_check_mesh *m = c->mesh;
    enum tri_status status = TRI_OK;
    if (c->input == NULL || m->attributes == NULL || m->segments == NULL || c->input->n_regions == 0 ||
        c->options->border == TRI_CHECK_BORDER_ANY)
        return TRI_OK;
    tri_check_each(c, TRI_CHECK_REGIONS, c->n_half_edges, differs, tell);
    for (int32_t k = 0; k < c->input->n_regions && status == TRI_OK; k++) {
        const double *r = c->input->regions + 4 * (size_t)k;
        status = tri_check_ask(c, (struct tri_point){r[0], r[1]}, TRI_CHECK_REGIONS, k, c->tolerance);
    }
    return status;
}
