/* Source of the rounds: Amenta, Choi & Rote 2003. */
#include "triangle/cdt/laying_order.h"

#include <stdlib.h>

#include "triangle/base/scatter.h"

enum { ROUNDS = 24 }; /* as many as make the first one small in any input */

int32_t tri_list_pieces(const struct tri_mesh *mesh, const struct tri_pslg *pslg, const tri_triangle_id *corner,
                        struct tri_piece *piece, int32_t *skipped)
{
    const int32_t *twin = mesh->twin, *markers = pslg->segment_markers;
    int32_t n = 0;
    for (int32_t k = 0; k < pslg->n_segments; k++) {
        tri_vertex_id a = pslg->segments[2 * k], b = pslg->segments[2 * k + 1];
        bool valid = a >= 0 && a < pslg->n_points && b >= 0 && b < pslg->n_points;
        if (valid && twin) {
            a = twin[a];
            b = twin[b];
        }
        if (!valid || a == b)
            ++*skipped;
        else if (corner[a] != TRI_NONE && corner[b] != TRI_NONE) /* else all points are on one line */
            piece[n++] = (struct tri_piece){a, b, {k, markers && markers[k] ? k : TRI_NONE, true}};
    }
    return n;
}

/* A round has about as many pieces as all before it. */
static int round_of(const struct tri_piece *piece)
{
    int round = ROUNDS - 1;
    for (uint32_t draw = tri_scatter((uint32_t)piece->course.first); round > 0 && draw % 2 == 0; draw /= 2)
        round--;
    return round;
}

bool tri_put_in_rounds(struct tri_piece **piece, int32_t n)
{
    int32_t at[ROUNDS + 1] = {0};
    struct tri_piece *sorted = malloc(((size_t)n + 1) * sizeof *sorted);
    if (!sorted)
        return false;
    for (int32_t i = 0; i < n; i++)
        at[round_of(&(*piece)[i]) + 1]++;
    for (int r = 0; r < ROUNDS; r++)
        at[r + 1] += at[r];
    for (int32_t i = 0; i < n; i++)
        sorted[at[round_of(&(*piece)[i])]++] = (*piece)[i];
    free(*piece);
    *piece = sorted;
    return true;
}
