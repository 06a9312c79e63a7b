/* A naive implementation of carving. The whole hull is triangulated and nothing removed. Then the outside, holes and
 * regions are flooded, one triangle at a time. Each point is located by a search over all triangles. */
#include <stdio.h>

#include "tests/torture/judge.h"

enum { GONE = -1 };

struct flood {
    struct tri_mesh mesh;
    int32_t *mark;  /* [n_triangles] region, or GONE */
    int32_t *stack; /* [n_triangles] */
    bool doubtful;  /* true: a point lies on an edge, so either side is acceptable */
};

static bool is_segment(const struct tri_mesh *mesh, int32_t t, int e)
{
    int32_t link = mesh->tri[t].n[e];
    return link < 0 && mesh->parents[mesh->sub[~link].parent].segment != TRI_NONE;
}

/* Marks all triangles that can be reached from this one without crossing a segment. */
static void spread(struct flood *f, int32_t from, int32_t mark)
{
    int32_t n = 0;
    if (f->mark[from] == mark || f->mark[from] == GONE)
        return;
    f->mark[from] = mark;
    f->stack[n++] = from;
    while (n > 0) {
        int32_t t = f->stack[--n];
        for (int e = 0; e < 3; e++) {
            int32_t code = is_segment(&f->mesh, t, e) ? TRI_NONE : tri_across(&f->mesh, tri_code(t, e));
            if (code == TRI_NONE || f->mark[tri_of(code)] == mark || f->mark[tri_of(code)] == GONE)
                continue;
            f->mark[tri_of(code)] = mark;
            f->stack[n++] = tri_of(code);
        }
    }
}

/* The triangle that contains the point strictly inside, or TRI_NONE. */
static int32_t locate(struct flood *f, const double at[2])
{
    const struct tri_mesh *m = &f->mesh;
    struct tri_point p = {at[0] / m->unit, at[1] / m->unit};
    double limit = 0;
    for (int32_t v = 0; v < m->n_vertices; v++)
        limit = fmax(limit, fmax(fabs(m->xy[v].x), fabs(m->xy[v].y)));
    if (!(fabs(p.x) <= limit && fabs(p.y) <= limit))
        return TRI_NONE;
    p = (struct tri_point){tri_round_coordinate(p.x), tri_round_coordinate(p.y)};
    for (int32_t t = 0; t < m->n_triangles; t++) {
        const int32_t *v = m->tri[t].v;
        double a = tri_orient2d(m->xy[v[0]], m->xy[v[1]], p), b = tri_orient2d(m->xy[v[1]], m->xy[v[2]], p),
               c = tri_orient2d(m->xy[v[2]], m->xy[v[0]], p);
        if (a > 0 && b > 0 && c > 0)
            return t;
        if (a >= 0 && b >= 0 && c >= 0)
            f->doubtful = true;
    }
    return TRI_NONE;
}

static void flood_all(struct flood *f, const struct outcome *o)
{
    const struct tri_pslg *pslg = &o->of->figure.pslg;
    for (int32_t t = 0; t < f->mesh.n_triangles && !o->switches.keep_hull; t++)
        for (int e = 0; e < 3; e++)
            if (!is_segment(&f->mesh, t, e) && tri_across(&f->mesh, tri_code(t, e)) == TRI_NONE)
                spread(f, t, GONE);
    for (int32_t i = 0; i < pslg->n_holes && !o->switches.ignore_holes; i++) {
        int32_t t = locate(f, pslg->holes + 2 * (size_t)i);
        if (t != TRI_NONE)
            spread(f, t, GONE);
    }
    for (int32_t i = 0; i < pslg->n_regions && o->options.spread_regions; i++) {
        int32_t t = locate(f, pslg->regions + 4 * (size_t)i);
        if (t != TRI_NONE)
            spread(f, t, i + 1);
    }
}

static double area_of(const struct tri_mesh *mesh, int32_t t)
{
    const struct tri_point *a = &mesh->xy[mesh->tri[t].v[0]], *b = &mesh->xy[mesh->tri[t].v[1]],
                           *c = &mesh->xy[mesh->tri[t].v[2]];
    return ((b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x)) / 2;
}

/* The area that vertices on subsegments may add or remove because they are rounded. */
static double rounding(const struct tri_mesh *mesh)
{
    double largest = 0, length = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        largest = fmax(largest, fmax(fabs(mesh->xy[v].x), fabs(mesh->xy[v].y)));
    for (int32_t s = 0; s < mesh->n_subs; s++) {
        struct tri_point a = mesh->xy[mesh->sub[s].v[0]], b = mesh->xy[mesh->sub[s].v[1]];
        length += fabs(a.x - b.x) + fabs(a.y - b.y);
    }
    return TRI_CHECK_ULPS * 0x1p-52 * largest * length;
}

/* Areas of the regions in both meshes. */
static void compare(const struct flood *f, const struct outcome *o, double *areas, struct verdict *verdict)
{
    const struct tri_mesh *mesh = &o->mesh;
    int32_t left = 0;
    double whole = 0, tolerance = rounding(mesh);
    for (int32_t t = 0; t < f->mesh.n_triangles; t++) {
        double area = area_of(&f->mesh, t);
        left += f->mark[t] != GONE;
        whole += fabs(area); /* the computed area of a flat triangle may be negative */
        if (f->mark[t] != GONE)
            areas[f->mark[t]] += area;
    }
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        areas[mesh->tri[t].region] -= area_of(mesh, t);
    if (!o->options.refine && left != mesh->n_triangles)
        judge_fault(verdict, "carving", "%d triangles, by naive carving %d", (int)mesh->n_triangles, (int)left);
    for (int32_t r = 0; r < mesh->n_regions; r++)
        if (fabs(areas[r]) > 1e-9 * whole + tolerance)
            judge_fault(verdict, "carving", "region %d lacks %.3g of the hull's area", (int)r, areas[r] / whole);
}

void judge_carving(const struct outcome *o, struct verdict *verdict)
{
    struct flood f = {0};
    struct tri_report report;
    struct tri_error error = {0};
    struct tri_options options = o->options;
    options.refine = options.spread_regions = false;
    options.keep_hull = options.ignore_holes = true;
    if (!o->switches.segments || tri_generate(&f.mesh, &o->of->figure.pslg, &options, &report, &error) != TRI_OK)
        return;
    f.mark = calloc((size_t)f.mesh.n_triangles + 1, sizeof *f.mark);
    f.stack = calloc((size_t)f.mesh.n_triangles + 1, sizeof *f.stack);
    double *areas = calloc((size_t)o->mesh.n_regions + (size_t)o->of->figure.pslg.n_regions + 1, sizeof *areas);
    assert_true(f.mark && f.stack && areas);
    flood_all(&f, o);
    if (!f.doubtful)
        compare(&f, o, areas, verdict);
    free(areas);
    free(f.mark);
    free(f.stack);
    tri_mesh_free(&f.mesh);
}
