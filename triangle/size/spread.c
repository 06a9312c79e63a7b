/* Propagates lengths and data over the nodes of cells: triangles, or leaves of a quadtree.
 *
 * As in raster.c, each node stores the node from which its value comes, so that distances are straight lines. Here
 * its neighbours are the nodes that share a cell with it. Passes go forwards and backwards over the cells until
 * nothing changes, and skip cells without changes. */
#include "triangle/size/sources.h"

/* The state of a propagation. */
struct pass {
    const struct tri_spreading *cells; /* the nodes and cells */
    const double *base;                /* [n] start values */
    double slope;                      /* slope of the propagation */
    double *least;                     /* [n] result */
    int32_t *from;                     /* [n] node that gives the result */
    unsigned char *changed; /* [n] bit 0: the node changed in this pass; bit 1: in the previous pass */
    bool any;               /* true: a node has changed in this pass */
};

/* Tries the source node of each changed corner for all other corners of the cell. */
static void propagate_in_cell(struct pass *p, const int32_t *corner)
{
    const struct tri_point *at = p->cells->at;
    for (int32_t a = 0; a < p->cells->corners; a++) {
        const int32_t from = p->from[corner[a]];
        if (!p->changed[corner[a]])
            continue;
        for (int32_t b = 0; b < p->cells->corners; b++) {
            const int32_t v = corner[b];
            if (p->from[v] == from || !(p->base[from] < p->least[v]))
                continue;
            const double least = p->base[from] + p->slope * sqrt(tri_distance2(at[from], at[v]));
            if (least < p->least[v]) {
                p->least[v] = least;
                p->from[v] = from;
                p->changed[v] |= 1;
                p->any = true;
            }
        }
    }
}

enum tri_status tri_spread(const struct tri_spreading *cells, const double *base, double slope, double *least,
                           int32_t *from, const struct tri_stop *stop, struct tri_error *error)
{
    struct pass p = {cells, base, slope, least, from, malloc((size_t)cells->n + 1), true};
    if (!p.changed)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for sizes");
    for (int32_t v = 0; v < cells->n; v++) {
        least[v] = base[v];
        from[v] = v;
        p.changed[v] = 2;
    }
    bool is_stopped = false;
    for (bool back = false; p.any && !is_stopped; back = !back) {
        p.any = false;
        for (int32_t c = 0; c < cells->n_cells; c++)
            propagate_in_cell(&p, cells->cell + (size_t)(back ? cells->n_cells - 1 - c : c) * (size_t)cells->corners);
        for (int32_t v = 0; v < cells->n; v++)
            p.changed[v] = (unsigned char)(p.changed[v] << 1 & 2);
        is_stopped = tri_stop_is_asked(stop);
    }
    free(p.changed);
    return is_stopped ? tri_fail_stopped(error) : TRI_OK;
}

static enum tri_status fill_gaps(const struct tri_spreading *cells, double *length, double *base, double *least,
                                 int32_t *from, const struct tri_stop *stop, struct tri_error *error)
{
    for (int32_t v = 0; v < cells->n; v++)
        base[v] = length[v] > 0 ? 0 : HUGE_VAL;
    const enum tri_status status = tri_spread(cells, base, 1, least, from, stop, error);
    for (int32_t v = 0; !status && v < cells->n; v++)
        if (!(length[v] > 0))
            length[v] = base[from[v]] == 0 ? length[from[v]] : 0; /* the source's own length is above 0 */
    return status;
}

static enum tri_status limit(const struct tri_spreading *cells, double *length, double *base, double *least,
                             int32_t *from, double gradation, const struct tri_stop *stop, struct tri_error *error)
{
    for (int32_t v = 0; v < cells->n; v++)
        base[v] = length[v] > 0 ? length[v] : HUGE_VAL;
    const enum tri_status status = tri_spread(cells, base, gradation, least, from, stop, error);
    for (int32_t v = 0; !status && v < cells->n; v++)
        length[v] = least[v] < HUGE_VAL ? least[v] : 0;
    return status;
}

enum tri_status tri_spread_lengths(const struct tri_spreading *cells, double *length, double gradation, bool *has_data,
                                   const struct tri_stop *stop, struct tri_error *error)
{
    int32_t gaps = 0;
    for (int32_t v = 0; v < cells->n; v++)
        gaps += !(length[v] > 0);
    *has_data = gaps < cells->n;
    if (!*has_data || (gaps == 0 && !(gradation < HUGE_VAL)))
        return TRI_OK;
    double *scratch = malloc(2 * (size_t)cells->n * sizeof *scratch), *least = scratch + cells->n;
    int32_t *from = malloc((size_t)cells->n * sizeof *from);
    enum tri_status status = scratch && from ? TRI_OK
                                             : tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for sizes");
    if (!status && gaps > 0)
        status = fill_gaps(cells, length, scratch, least, from, stop, error);
    if (!status && gradation < HUGE_VAL)
        status = limit(cells, length, scratch, least, from, gradation, stop, error);
    free(scratch);
    free(from);
    return status;
}
