/* The work of a triangle has two parts: triangles that an area bound asks for inside it, and triangles that an angle
 * bound asks for, to grade from the shortest edge to the longest. Samples of the first part are taken from small pieces
 * of large triangles, so that the work lies where it will be; the second part lies at the shortest edge. */
#include "triangle/size/estimate.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/size/asked.h"
#include "triangle/size/gap.h"
#include "triangle/size/hopeless.h"
#include "triangle/tunables.h"

enum { DEEPEST_CUT = 12, SURVEY = 1 << 17 };

/* More than anybody will have, and no infinity: bounds may ask for any number. */
static const double MOST_WORK = 1e15;

struct corners {
    struct tri_point a, b, c;
};

/* What work is estimated from. */
struct estimator {
    const struct tri_mesh *mesh;
    const struct tri_quality *quality;
    double large; /* a size test is probed in pieces no larger than this */
    struct tri_asked asked;
};

/* Triangles that the bounds ask for on one unit of area in this region; 0 without bound. */
static double density(const struct estimator *e, tri_region_id region)
{
    return 2 / (TRI_MEAN_OVER_BOUND * tri_area2_bound(&e->asked, region));
}

/* Triangles that the caller's size test asks for in this one, by probing: it is asked about the triangle shrunk to a
 * quarter, a sixteenth and so on of its area, until it says yes; 0 where it does at once, and also where it never does,
 * since then it is no test of size. */
static double probe_size(const struct estimator *e, const struct corners *t)
{
    enum { DEEPEST_PROBE = 16 };
    double scale = tri_area_scale(e->quality), pieces = 1;
    for (int k = 0; k <= DEEPEST_PROBE; k++, pieces *= 4)
        if (!tri_is_refused(&e->asked, t->a, t->b, t->c, scale * pieces))
            return k > 0 ? pieces : 0;
    return 0;
}

static struct tri_point middle(struct tri_point a, struct tri_point b)
{
    return (struct tri_point){0.5 * (a.x + b.x), 0.5 * (a.y + b.y)};
}

/* A triangle in four. */
static void quarter(const struct corners *t, struct corners part[4])
{
    struct tri_point ab = middle(t->a, t->b), bc = middle(t->b, t->c), ca = middle(t->c, t->a);
    part[0] = (struct corners){t->a, ab, ca};
    part[1] = (struct corners){ab, t->b, bc};
    part[2] = (struct corners){ca, bc, t->c};
    part[3] = (struct corners){ab, bc, ca};
}

static double area_of(const struct corners *t)
{
    double bx = t->b.x - t->a.x, by = t->b.y - t->a.y, cx = t->c.x - t->a.x, cy = t->c.y - t->a.y;
    return 0.5 * (bx * cy - by * cx);
}

/* The same where sizes vary inside: in a large triangle, or where a probe says many, its quarters are probed. */
static double size_work(const struct estimator *e, const struct corners *t, int depth)
{
    enum { MANY = 1024 };
    double work = probe_size(e, t), sum = 0;
    if (depth == 0 || (work <= MANY && area_of(t) <= e->large))
        return work;
    struct corners part[4];
    quarter(t, part);
    for (int i = 0; i < 4; i++)
        sum += size_work(e, &part[i], depth - 1);
    return work <= MANY ? fmax(work, sum) : sum;
}

/* Triangles that areas and size test ask for in a piece of a triangle of this region. */
static double work_inside(const struct estimator *e, tri_region_id region, const struct corners *t)
{
    double work = area_of(t) * density(e, region);
    if (tri_asks_caller(e->quality))
        work = fmax(work, size_work(e, t, DEEPEST_CUT));
    return work < MOST_WORK ? work : MOST_WORK;
}

static struct corners corners_of(const struct tri_mesh *mesh, tri_triangle_id t)
{
    const tri_vertex_id *v = mesh->tri[t].v;
    return (struct corners){mesh->xy[v[0]], mesh->xy[v[1]], mesh->xy[v[2]]};
}

static double area_work(const struct estimator *e, tri_triangle_id t)
{
    struct corners corners = corners_of(e->mesh, t);
    return tri_has_sizes(e->quality) ? work_inside(e, e->mesh->tri[t].region, &corners) : 0;
}

/* Triangles that an angle bound makes of one. Sizes grow by a factor from row to row, so that an octave between the
 * shortest edge and the longest takes a number of triangles that the bound alone decides; a narrow space between
 * segments takes as many as it is times longer than wide, and the triangle bridges as much of it as it is long. A
 * hopeless triangle stays one. */
static double angle_work(const struct tri_mesh *mesh, const struct tri_quality *quality, tri_triangle_id t)
{
    struct tri_shape shape = tri_shape_of(mesh->xy, mesh->tri[t].v);
    double longest2 = tri_longest2(&shape);
    double octaves = 0.5 * tri_rough_log2(longest2 / shape.l[shape.shortest]);
    double gap = tri_gap_cost(mesh, t, &shape), angle = fmin(quality->min_angle, TRI_USUAL_ANGLE);
    if (tri_is_hopeless(mesh, t, &shape))
        return 1;
    gap = fmin(gap, sqrt(longest2 / shape.l[shape.shortest]));
    double work = angle > 0 ? TRI_ROWS / (TRI_NO_ROWS - angle) * (octaves + 2 * gap) : 0;
    return work < 1 ? 1 : work < MOST_WORK ? work : MOST_WORK;
}

double tri_work_of(const struct tri_mesh *mesh, const struct tri_quality *quality, tri_triangle_id t)
{
    const struct estimator here = {mesh, quality, HUGE_VAL, tri_asked_of(mesh, quality)};
    return tri_is_live(&mesh->tri[t]) ? area_work(&here, t) + TRI_BAD_WORK * angle_work(mesh, quality, t) : 0;
}

/* Of a large mesh the angle's work is taken from every n-th triangle; triangles lie along a curve, so that is fair. */
static int32_t survey_step(const struct tri_mesh *mesh) { return mesh->n_triangles / SURVEY + 1; }

static struct estimator estimator_for(const struct tri_mesh *mesh, const struct tri_quality *quality)
{
    enum { PIECES = 1 << 14 }; /* of the whole mesh */
    struct estimator e = {mesh, quality, HUGE_VAL, tri_asked_of(mesh, quality)};
    double all = 0;
    for (tri_triangle_id t = 0; tri_asks_caller(quality) && t < mesh->n_triangles; t++)
        if (tri_is_live(&mesh->tri[t])) {
            struct corners corners = corners_of(mesh, t);
            all += area_of(&corners);
        }
    if (tri_asks_caller(quality))
        e.large = all / PIECES;
    return e;
}

/* What each n-th triangle adds to the work, by area or by angle. */
struct works {
    const struct estimator *e;
    double (*of)(const struct estimator *e, tri_triangle_id t);
    int32_t step, n; /* triangle step * i, i < n */
    double *known;   /* [n] each, looked up by all threads; NULL: to be asked for */
    double sum[TRI_MOST_SHARES]; /* of each share */
};

static double area_of_live(const struct estimator *e, tri_triangle_id t)
{
    return tri_is_live(&e->mesh->tri[t]) ? area_work(e, t) : 0;
}

static double angle_of_live(const struct estimator *e, tri_triangle_id t)
{
    return tri_is_live(&e->mesh->tri[t]) ? angle_work(e->mesh, e->quality, t) : 0;
}

/* What areas ask for in a triangle that meets its bound already: likely, since new vertices come near, but not sure. */
static double unsure_of_live(const struct estimator *e, tri_triangle_id t)
{
    const struct tri_triangle *triangle = &e->mesh->tri[t];
    if (!tri_is_live(triangle))
        return 0;
    double area2 = tri_shape_of(e->mesh->xy, triangle->v).area2;
    return area2 <= tri_area2_bound(&e->asked, triangle->region) ? 0.5 * area2 * density(e, triangle->region) : 0;
}

static struct works unsure_works(const struct estimator *e)
{
    return (struct works){.e = e, .of = unsure_of_live, .step = 1, .n = e->mesh->n_triangles};
}

static struct works area_works(const struct estimator *e)
{
    return (struct works){.e = e, .of = area_of_live, .step = 1, .n = e->mesh->n_triangles};
}

static struct works angle_works(const struct estimator *e)
{
    int32_t step = survey_step(e->mesh);
    return (struct works){.e = e, .of = angle_of_live, .step = step, .n = (e->mesh->n_triangles + step - 1) / step};
}

static inline double work_at(const struct works *w, int32_t i)
{
    return w->known ? w->known[i] : w->of(w->e, w->step * i);
}

static void sum_share(void *context, size_t share)
{
    struct works *w = context;
    struct tri_range range = tri_share(share, w->n);
    double sum = 0;
    for (int32_t i = range.first; i < range.last; i++)
        sum += w->step * work_at(w, i);
    w->sum[share] = sum;
}

/* A size test is the caller's: whether threads may ask it at once is not known here. */
static const struct tri_executor *executor_for(const struct works *w, const struct tri_executor *executor)
{
    return tri_asks_caller(w->e->quality) ? NULL : executor;
}

/* In shares that the mesh decides: the same for any number of threads. */
static double sum_of(struct works w, const struct tri_executor *executor)
{
    double sum = 0;
    tri_execute(executor_for(&w, executor), tri_shares(w.n), sum_share, &w);
    for (size_t share = 0; share < tri_shares(w.n); share++)
        sum += w.sum[share];
    return sum;
}

static void know_share(void *context, size_t share)
{
    const struct works *w = context;
    struct tri_range range = tri_share(share, w->n);
    for (int32_t i = range.first; i < range.last; i++)
        w->known[i] = w->of(w->e, w->step * i);
}

/* Where there is no memory each is asked for when it is needed. */
static void know_all(struct works *w, const struct tri_executor *executor)
{
    w->known = tri_shares(w->n) > 1 ? malloc((size_t)w->n * sizeof *w->known) : NULL;
    if (w->known)
        tri_execute(executor_for(w, executor), tri_shares(w->n), know_share, w);
}

double tri_estimate(const struct tri_mesh *mesh, const struct tri_quality *quality,
                    const struct tri_executor *executor, double *sure)
{
    const struct estimator e = estimator_for(mesh, quality);
    double areas = tri_has_sizes(quality) ? sum_of(area_works(&e), executor) : 0;
    *sure = mesh->n_triangles + (areas > 0 ? fmax(areas - sum_of(unsure_works(&e), executor), 0) : 0);
    return areas + sum_of(angle_works(&e), executor);
}

bool tri_sizes_come_first(const struct tri_mesh *mesh, const struct tri_quality *quality,
                          const struct tri_executor *executor)
{
    if (fmin(quality->min_angle, TRI_USUAL_ANGLE) <= TRI_EASY_ANGLE || !tri_has_sizes(quality))
        return false;
    if (tri_asks_caller(quality))
        return true;
    const struct estimator e = estimator_for(mesh, quality);
    return sum_of(area_works(&e), executor) > TRI_SIZES_FIRST * sum_of(angle_works(&e), executor);
}

/* Who is given the samples. */
struct receiver {
    tri_take_work *take;
    void *user;
};

/* Samples a triangle's work, cut into four as long as a piece holds more than `grain`; depth bounds the recursion. */
static bool sample_triangle(const struct receiver *to, const struct estimator *e, tri_region_id region,
                            const struct corners *t, double work, double grain, int depth)
{
    if (work <= grain || depth == 0) {
        struct tri_point q = {(t->a.x + t->b.x + t->c.x) / 3, (t->a.y + t->b.y + t->c.y) / 3};
        return to->take(to->user, q, work);
    }
    struct corners part[4];
    quarter(t, part);
    for (int i = 0; i < 4; i++) {
        double inside = tri_asks_caller(e->quality) ? work_inside(e, region, &part[i]) : work / 4;
        if (!sample_triangle(to, e, region, &part[i], inside, grain, depth - 1))
            return false;
    }
    return true;
}

/* Small pieces of work are gathered until they are worth a sample. */
static bool sample_angles(const struct receiver *to, const struct works *angles, double grain)
{
    const struct tri_mesh *mesh = angles->e->mesh;
    double waiting = 0;
    for (int32_t i = 0; i < angles->n; i++) {
        const tri_vertex_id *v = mesh->tri[angles->step * i].v;
        waiting += angles->step * work_at(angles, i);
        if (waiting < grain || v[0] == TRI_NONE)
            continue;
        int k = tri_shape_of(mesh->xy, v).shortest;
        if (!to->take(to->user, middle(mesh->xy[v[tri_next[k]]], mesh->xy[v[tri_prev[k]]]), waiting))
            return false;
        waiting = 0;
    }
    return true;
}

static bool sample_areas(const struct receiver *to, const struct works *areas, double grain)
{
    const struct tri_mesh *mesh = areas->e->mesh;
    double waiting = 0;
    for (tri_triangle_id t = 0; t < mesh->n_triangles; t++) {
        double work = work_at(areas, t);
        waiting += work < grain ? work : 0;
        if (work < grain && waiting < grain)
            continue;
        struct corners corners = corners_of(mesh, t);
        if (!sample_triangle(to, areas->e, mesh->tri[t].region, &corners, work < grain ? waiting : work,
                             work < grain ? waiting : grain, DEEPEST_CUT))
            return false;
        waiting = work < grain ? 0 : waiting;
    }
    return true;
}

bool tri_sample_work(const struct tri_mesh *mesh, const struct tri_quality *quality, double grain,
                     const struct tri_executor *executor, tri_take_work *take, void *user)
{
    const struct receiver to = {take, user};
    const struct estimator e = estimator_for(mesh, quality);
    assert(take && grain >= 0);
    struct works angles = angle_works(&e), areas = area_works(&e);
    know_all(&angles, executor);
    bool taken = sample_angles(&to, &angles, grain);
    free(angles.known);
    if (!taken || !tri_has_sizes(quality))
        return taken;
    know_all(&areas, executor);
    taken = sample_areas(&to, &areas, grain);
    free(areas.known);
    return taken;
}
