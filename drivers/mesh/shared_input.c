/* First the structs, whose pointers tell which arrays there are, then the arrays, each into memory of its own: no rank
 * has more than the input once. */
#include "drivers/mesh/shared_input.h"

#include <stdlib.h>

struct sharing {
    struct par_carrier *carrier;
    enum tri_status status;
    struct tri_error *error;
};

/* What is more than numbers is another rank's: never followed here. */
struct outline {
    struct tri_pslg pslg;
    struct tri_elements elements;
    int32_t base;
    bool points_in_poly;
};

static void spread(struct sharing *s, void *bytes, size_t n)
{
    s->status = par_spread(s->carrier, PAR_MOVE_INPUT, bytes, n, s->status, s->error);
}

/* An array of so many items, which rank 0 has, or has not. */
static void *array(struct sharing *s, void *own, bool exists, int64_t n, size_t item)
{
    size_t size = (size_t)n * item;
    void *bytes = own;
    if (!exists)
        return NULL;
    if (s->carrier->rank > 0 && !s->status) {
        bytes = malloc(size + 1);
        if (!bytes)
            s->status = tri_fail(s->error, TRI_NO_MEMORY, NULL, 0, "out of memory for the input");
    }
    spread(s, bytes, size);
    return bytes;
}

static void share_figure(struct sharing *s, struct tri_pslg *own, const struct tri_pslg *told)
{
    struct tri_pslg p = *told;
    p.points = array(s, own->points, told->points, 2 * (int64_t)p.n_points, sizeof *p.points);
    p.attributes = array(s, own->attributes, told->attributes, (int64_t)p.n_points * p.n_attributes,
                         sizeof *p.attributes);
    p.markers = array(s, own->markers, told->markers, p.n_points, sizeof *p.markers);
    p.segments = array(s, own->segments, told->segments, 2 * (int64_t)p.n_segments, sizeof *p.segments);
    p.segment_markers = array(s, own->segment_markers, told->segment_markers, p.n_segments,
                              sizeof *p.segment_markers);
    p.holes = array(s, own->holes, told->holes, 2 * (int64_t)p.n_holes, sizeof *p.holes);
    p.regions = array(s, own->regions, told->regions, 4 * (int64_t)p.n_regions, sizeof *p.regions);
    *own = p;
}

static void share_elements(struct sharing *s, struct tri_elements *own, const struct tri_elements *told)
{
    struct tri_elements e = *told;
    e.corners = array(s, own->corners, told->corners, 3 * (int64_t)e.n, sizeof *e.corners);
    e.attributes = array(s, own->attributes, told->attributes, (int64_t)e.n * e.n_attributes, sizeof *e.attributes);
    e.areas = array(s, own->areas, told->areas, e.n, sizeof *e.areas);
    e.extra = array(s, own->extra, told->extra, (int64_t)e.n * (e.n_nodes - 3), sizeof *e.extra);
    *own = e;
}

enum tri_status shared_input(struct par_carrier *carrier, struct run *run, enum tri_status status,
                             struct tri_error *error)
{
    struct sharing s = {carrier, status, error};
    struct outline told = {run->pslg, run->elements, run->base, run->points_in_poly};
    spread(&s, &told, sizeof told);
    if (s.status)
        return s.status;
    share_figure(&s, &run->pslg, &told.pslg);
    share_elements(&s, &run->elements, &told.elements);
    run->base = told.base;
    run->points_in_poly = told.points_in_poly;
    return par_agree(carrier, s.status, error);
}
