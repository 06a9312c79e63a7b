/* Who has granted what is remembered within fences alone: elsewhere vertices are counted at once. */
#include "triangle/credit.h"

#include <assert.h>

void tri_list_corners(struct tri_grantors *grantors, const struct tri_mesh *mesh, const tri_vertex_id corner[3],
                      bool asks)
{
    for (int k = 0; k < 3; k++) {
        const bool grants = !tri_is_on_credit(mesh, corner[k]);
        grantors->all += grants;
        grantors->asking += grants && asks;
    }
}

void tri_grant(struct tri_credit *credit, const struct tri_grantors *grantors)
{
    const int64_t twice = 2 * grantors->asking;
    credit->granted += TRI_CREDIT * (twice < grantors->all ? twice : grantors->all);
}

bool tri_meet_corners(struct tri_credit *credit, const struct tri_mesh *mesh, const tri_vertex_id corner[3])
{
    for (int k = 0; k < 3; k++) {
        struct tri_entry entry = {corner[k], 0};
        assert(corner[k] >= 0);
        if (tri_is_on_credit(mesh, corner[k]) || tri_entry_set_holds(&credit->met, entry))
            continue;
        if (!tri_entry_set_add(&credit->met, entry))
            return false;
        credit->granted += INT64_C(6) * TRI_CREDIT;
    }
    return true;
}

void tri_credit_free(struct tri_credit *credit)
{
    tri_entry_set_free(&credit->met);
    *credit = (struct tri_credit){0};
}
