/* The work of a triangle has two parts: the triangles needed for sizes inside it, and the rest, which is the
 * triangle itself and what the angle bound adds. Samples of the first part come from small pieces of large
 * triangles, so that each lies where its triangles will be. Samples of the rest lie at the shortest edge. */
#include "triangle/size/estimate.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/base/size_text.h"
#include "triangle/base/status.h"
#include "triangle/size/crowd.h"
#include "triangle/size/quality.h"
#include "triangle/tunables.h"

enum { DEEPEST_CUT = 12, FEW_WORKS = 512 }; /* the latter: triangles of a share that asks for lengths */

/* The limit on calls of the caller's functions, besides four per triangle; the factor by which sampling work may
 * exceed it. */
enum { MOST_ASKED = 1 << 20, SAMPLES_ASKED = 8 };

/* More than any mesh has, but finite, since bounds may ask for any number. */
static const double MOST_WORK = 1e15;

/* Limits the calls of the caller's functions. */
struct budget {
    int64_t left;  /* points that may still be evaluated before parts are no longer divided */
    uint32_t step; /* counter of tri_stop_is_due */
    bool stopped;  /* true: a stop was requested; the functions are no longer called */
};

static struct budget budget_for(const struct tri_mesh *mesh, int64_t most)
{
    return (struct budget){.left = 4 * (int64_t)mesh->n_triangles + most};
}

/* The data from which work is estimated. */
struct estimator {
    struct tri_asked asked; /* the wanted sizes */
    struct tri_crowd crowd; /* the angle bound */
    struct budget *budget;  /* limit on calls */
    bool at_least; /* true: only the certain part of the caller's sizes counts */
    double large; /* largest area of a piece for which the caller's functions are evaluated */
    double *known; /* [n_triangles] triangles needed for sizes in each; NULL: computed on request */
};

static struct tri_point middle(struct tri_point a, struct tri_point b)
{
    return (struct tri_point){0.5 * (a.x + b.x), 0.5 * (a.y + b.y)};
}

/* Computes piece i of a triangle divided into four. */
static void quarter(const struct tri_point p[3], int i, struct tri_point piece[3])
{
    for (int k = 0; k < 3; k++)
        piece[k] = i == 3 ? middle(p[tri_next[k]], p[tri_prev[k]]) : k == i ? p[i] : middle(p[i], p[k]);
}

static void corners_of(const struct tri_mesh *mesh, tri_triangle_id t, struct tri_point p[3])
{
    for (int k = 0; k < 3; k++)
        p[k] = mesh->xy[mesh->tri[t].v[k]];
}

/* The caller's sizes in a piece of a triangle, as a size h with 1 / h^2 triangles per unit of area. */
struct caller_piece {
    const struct tri_asked *asked; /* the wanted sizes */
    const struct tri_point *piece; /* [3] */
    struct budget *budget;         /* limit on calls */
};

/* Converts the edge length asked for at a point. */
static double size_of_length(double length)
{
    const double MEAN_SQUARE = TRI_EQUILATERAL * TRI_MEAN_OVER_BOUND; /* of an equilateral triangle */
    return sqrt(MEAN_SQUARE) * length;
}

static double caller_size_at(const void *user, struct tri_point q)
{
    const double ANY = 1e99;
    const struct caller_piece *caller_piece = user;
    struct budget *budget = caller_piece->budget;
    budget->stopped = budget->stopped || tri_stop_is_due(caller_piece->asked->mesh->stop, &budget->step);
    budget->left = budget->stopped ? 0 : budget->left - 1;
    return budget->stopped ? ANY : size_of_length(tri_asked_length(caller_piece->asked, caller_piece->piece, q));
}

/* Returns the number of triangles that the caller's functions need in a piece. corners: its vertices; NULL: it is part
 * of a triangle. */
static double caller_work_in(const struct estimator *e, const struct tri_point p[3], const tri_vertex_id *corners)
{
    double h[3];
    const bool known = corners && e->asked.mesh->has_lengths && !tri_asks_caller(e->asked.quality);
    for (int k = 0; known && k < 3; k++)
        h[k] = size_of_length(e->asked.coarser *
                              (fabs(e->asked.mesh->length[corners[k]]) / sqrt(TRI_MEAN_OVER_BOUND)));
    const struct caller_piece caller_piece = {&e->asked, p, e->budget};
    if (e->at_least && e->budget->left <= 0)
        return 0;
    const struct tri_integrand field = {caller_size_at, &caller_piece, 0, e->large, TRI_WISH_FEW, 2 * DEEPEST_CUT,
                                         &e->budget->left, e->at_least};
    return tri_integral(&field, p, known ? h : NULL);
}

/* Returns the number of triangles needed for sizes in a piece of a triangle of this region. corners: as above. */
static double asked_in(const struct estimator *e, tri_region_id region, const struct tri_point p[3],
                       const tri_vertex_id *corners)
{
    const double mean = tri_mean_over_bound(e->asked.quality);
    double work = tri_area_of(p[0], p[1], p[2]) * 2 / (mean * tri_area2_bound(&e->asked, region));
    if (tri_sizes_vary(e->asked.quality))
        work = fmax(work, caller_work_in(e, p, corners));
    return work < MOST_WORK ? work : MOST_WORK;
}

/* The same for a triangle; 0 if its number is free. */
static double asked_work(const struct estimator *e, tri_triangle_id t)
{
    struct tri_point p[3];
    if (e->known)
        return e->known[t];
    if (!tri_has_sizes(e->asked.quality) || !tri_is_live(&e->asked.mesh->tri[t]))
        return 0;
    corners_of(e->asked.mesh, t, p);
    return asked_in(e, e->asked.mesh->tri[t].region, p, e->asked.mesh->tri[t].v);
}

static double rest_work(const struct estimator *e, tri_triangle_id t)
{
    const double asked = asked_work(e, t);
    return tri_is_live(&e->asked.mesh->tri[t]) ? fmax(1 - asked, 0) + tri_crowd_work(&e->crowd, t, asked) : 0;
}

/* Returns the number of triangles that the angle bound alone would make of it. */
static double angle_work(const struct estimator *e, tri_triangle_id t)
{
    return tri_is_live(&e->asked.mesh->tri[t]) ? 1 + tri_crowd_work(&e->crowd, t, 0) : 0;
}

static struct estimator estimator_for(const struct tri_mesh *mesh, const struct tri_quality *quality,
                                      struct budget *budget)
{
    struct estimator e = {.asked = tri_asked_of(mesh, quality), .crowd = tri_crowd_for(mesh, quality),
                          .budget = budget, .large = HUGE_VAL};
    double all = 0;
    for (tri_triangle_id t = 0; tri_sizes_vary(quality) && t < mesh->n_triangles; t++)
        all += tri_is_live(&mesh->tri[t]) ? 0.5 * tri_shape_of(mesh->xy, mesh->tri[t].v).area2 : 0;
    if (tri_sizes_vary(quality))
        e.large = all / TRI_WISH_PIECES;
    return e;
}

double tri_work_of(const struct tri_mesh *mesh, const struct tri_quality *quality, tri_triangle_id t)
{
    struct budget budget = {.left = TRI_WISH_PIECES};
    const struct estimator here = {.asked = tri_asked_of(mesh, quality), .budget = &budget, .large = HUGE_VAL};
    if (!tri_is_live(&mesh->tri[t]))
        return 0;
    const struct tri_shape shape = tri_shape_of(mesh->xy, mesh->tri[t].v);
    const double octaves = 0.5 * tri_rough_log2(tri_longest2(&shape) / shape.l[shape.shortest]);
    return asked_work(&here, t) + TRI_BAD_WORK * (1 + octaves);
}

/* The work added by every step-th triangle. */
struct works {
    const struct estimator *e; /* the data */
    double (*of)(const struct estimator *e, tri_triangle_id t); /* returns the work of a triangle */
    int32_t step, n; /* triangles step * i for i < n */
    double *known;   /* [n] the work of each, computed by all threads; NULL: computed on request */
    double sum[TRI_MOST_SHARES];    /* [tri_shares(n)] the sum of each share */
    double urgent[TRI_MOST_SHARES]; /* [tri_shares(n)] the same for triangles that violate their bounds */
};

static struct works asked_works(const struct estimator *e)
{
    return (struct works){.e = e, .of = asked_work, .step = 1, .n = e->asked.mesh->n_triangles};
}

/* Triangles are sorted along a curve, so every step-th triangle is a representative sample. */
static struct works sampled_works(const struct estimator *e, double (*of)(const struct estimator *, tri_triangle_id))
{
    const int32_t n = e->asked.mesh->n_triangles;
    const int32_t step = n < 4 * TRI_FEWEST_SAMPLED ? 1 + n / TRI_FEWEST_SAMPLED : 4 + n / TRI_MOST_SAMPLED;
    return (struct works){.e = e, .of = of, .step = step, .n = (n + step - 1) / step};
}

static inline double work_at(const struct works *w, int32_t i)
{
    return w->known ? w->known[i] : w->of(w->e, w->step * i);
}

static void sum_share(void *context, size_t share)
{
    struct works *w = context;
    struct tri_range range = tri_share(share, w->n);
    const double mean = tri_mean_over_bound(w->e->asked.quality);
    double sum = 0, urgent = 0;
    for (int32_t i = range.first; i < range.last; i++) {
        const double work = work_at(w, i);
        sum += w->step * work;
        urgent += mean * work > 1 ? w->step * work : 0;
    }
    w->sum[share] = sum;
    w->urgent[share] = urgent;
}

/* Returns NULL if sizes must still be asked for: all shares use one budget, and the caller's functions may not be safe
 * to call from several threads. */
static const struct tri_executor *executor_for(const struct works *w, const struct tri_executor *executor)
{
    return tri_sizes_vary(w->e->asked.quality) && !w->e->known ? NULL : executor;
}

/* Sums over shares that depend on the mesh only, so the result does not depend on the number of threads. */
static double sum_of(struct works w, const struct tri_executor *executor, double *urgent)
{
    double sum = 0;
    tri_execute(executor_for(&w, executor), tri_shares(w.n), sum_share, &w);
    for (size_t share = 0; share < tri_shares(w.n); share++) {
        sum += w.sum[share];
        *urgent += w.urgent[share];
    }
    return sum;
}

/* Returns in how many shares the work of all triangles is computed. It depends on the mesh only. The caller's functions
 * have one share: they share one budget, and may not be safe to call from several threads. */
static size_t computing_shares(const struct works *w)
{
    const size_t shares = (size_t)w->n / FEW_WORKS + 1;
    if (tri_asks_caller(w->e->asked.quality))
        return 1;
    return shares < TRI_MOST_SHARES ? shares : TRI_MOST_SHARES;
}

/* If there are several shares, each has an equal part of the budget for itself. */
static void compute_share_works(void *context, size_t share)
{
    const struct works *w = context;
    const size_t shares = computing_shares(w);
    struct estimator e = *w->e;
    struct budget budget = *e.budget;
    const struct tri_range range = tri_share_of(share, shares, w->n);
    if (shares > 1) {
        budget.left /= (int64_t)shares;
        e.budget = &budget;
    }
    for (int32_t i = range.first; i < range.last; i++)
        w->known[i] = w->of(&e, w->step * i);
}

/* Computes the work of all triangles. The caller frees the result. NULL if memory ran out: each is then computed on
 * request. */
static double *compute_works(struct works w, const struct tri_executor *executor)
{
    w.known = malloc(((size_t)w.n + 1) * sizeof *w.known);
    if (w.known)
        tri_execute(executor, computing_shares(&w), compute_share_works, &w);
    return w.known;
}

/* Are there sizes, and an angle bound that is expensive to reach? */
static bool may_come_first(const struct tri_quality *quality)
{
    return tri_worked_angle(quality) > TRI_EASY_ANGLE && tri_has_sizes(quality);
}

/* Do sizes need far more triangles than angles? */
static bool outweighs_angles(const struct estimator *e, double asked, const struct tri_executor *executor)
{
    double ignored = 0;
    return asked > TRI_SIZES_FIRST * sum_of(sampled_works(e, angle_work), executor, &ignored);
}

bool tri_sizes_come_first(const struct tri_mesh *mesh, const struct tri_quality *quality,
                          const struct tri_executor *executor)
{
    double ignored = 0;
    if (!may_come_first(quality) || tri_sizes_vary(quality))
        return may_come_first(quality);
    const struct estimator e = estimator_for(mesh, quality, NULL);
    return outweighs_angles(&e, sum_of(asked_works(&e), executor, &ignored), executor);
}

/* If sizes come first, angles are fixed in a mesh that is already fine. This adds a share of triangles that depends
 * on TRI_AGAIN. */
double tri_estimate(const struct tri_mesh *mesh, const struct tri_quality *quality,
                    const struct tri_executor *executor, double *sure)
{
    const bool asks = tri_sizes_vary(quality);
    struct budget budget = budget_for(mesh, MOST_ASKED);
    struct estimator e = estimator_for(mesh, quality, &budget);
    double urgent = 0, ignored = 0, again = 0;
    e.known = asks ? compute_works(asked_works(&e), executor) : NULL;
    const double asked = tri_has_sizes(quality) ? sum_of(asked_works(&e), executor, &urgent) : 0;
    if (may_come_first(quality) && (asks || outweighs_angles(&e, asked, executor)))
        again = TRI_AGAIN / (TRI_NEVER_AGAIN - tri_worked_angle(quality));
    *sure = mesh->n_triangles + urgent;
    const double rest = sum_of(sampled_works(&e, rest_work), executor, &ignored);
    free(e.known);
    return (1 + again * again) * (asked + rest);
}

/* For functions a rough estimate suffices, so the pieces may be larger than in tri_estimate. */
double tri_size_demand(const struct tri_mesh *mesh, const struct tri_quality *quality,
                       const struct tri_executor *executor)
{
    const double ROUGH = 16;
    struct budget budget = {.left = MOST_ASKED};
    struct tri_quality known = *quality;
    double urgent = 0;
    known.unsuitable = NULL;
    if (!tri_has_sizes(&known))
        return 0;
    struct estimator e = estimator_for(mesh, &known, &budget);
    e.large *= ROUGH;
    e.at_least = true;
    e.known = tri_sizes_vary(&known) ? compute_works(asked_works(&e), executor) : NULL;
    sum_of(asked_works(&e), executor, &urgent);
    free(e.known);
    return tri_mean_over_bound(&known) / tri_most_over_bound(&known) * urgent;
}

enum tri_status tri_refine_check(const struct tri_mesh *mesh, const struct tri_quality *quality,
                                 const struct tri_executor *executor, struct tri_error *error)
{
    double triangles = quality->max_steiner < 0 ? tri_size_demand(mesh, quality, executor) : 0;
    if (triangles <= TRI_MAX_TRIANGLES)
        return TRI_OK;
    return tri_fail(error, TRI_TOO_LARGE, NULL, 0,
                    "the %s ask for at least %s triangles, and a mesh holds %s",
                    quality->edge_length || quality->lengths ? "sizes" : "area bounds",
                    tri_count_text(triangles).text, tri_count_text(TRI_MAX_TRIANGLES).text);
}

/* The receiver of the samples. */
struct receiver {
    tri_take_work *take; /* called for each sample */
    void *user;          /* passed to take */
};

/* Samples the work of a triangle, dividing it into four while a piece holds more than `grain`. depth: limit on the
 * recursion. */
static bool sample_triangle(const struct receiver *to, const struct estimator *e, tri_region_id region,
                            const struct tri_point p[3], double work, double grain, int depth)
{
    if (work <= grain || depth == 0) {
        struct tri_point q = {(p[0].x + p[1].x + p[2].x) / 3, (p[0].y + p[1].y + p[2].y) / 3};
        return to->take(to->user, q, work);
    }
    for (int i = 0; i < 4; i++) {
        struct tri_point piece[3];
        quarter(p, i, piece);
        const bool asks = tri_sizes_vary(e->asked.quality) && e->budget->left > 0;
        double inside = asks ? asked_in(e, region, piece, NULL) : work / 4;
        if (!sample_triangle(to, e, region, piece, inside, grain, depth - 1))
            return false;
    }
    return true;
}

/* Small amounts of work are accumulated until they are worth a sample. */
static bool sample_rest(const struct receiver *to, const struct works *rest, double grain)
{
    const struct tri_mesh *mesh = rest->e->asked.mesh;
    double waiting = 0;
    for (int32_t i = 0; i < rest->n; i++) {
        const tri_vertex_id *v = mesh->tri[rest->step * i].v;
        waiting += rest->step * work_at(rest, i);
        if (waiting < grain || v[0] == TRI_NONE)
            continue;
        int k = tri_shape_of(mesh->xy, v).shortest;
        if (!to->take(to->user, middle(mesh->xy[v[tri_next[k]]], mesh->xy[v[tri_prev[k]]]), waiting))
            return false;
        waiting = 0;
    }
    return true;
}

static bool sample_asked(const struct receiver *to, const struct estimator *e, double grain)
{
    const struct tri_mesh *mesh = e->asked.mesh;
    double waiting = 0;
    for (tri_triangle_id t = 0; t < mesh->n_triangles; t++) {
        double work = asked_work(e, t);
        waiting += work < grain ? work : 0;
        if (work == 0 || (work < grain && waiting < grain))
            continue;
        struct tri_point p[3];
        corners_of(mesh, t, p);
        if (!sample_triangle(to, e, mesh->tri[t].region, p, work < grain ? waiting : work,
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
    struct budget budget = budget_for(mesh, (int64_t)SAMPLES_ASKED * MOST_ASKED);
    struct estimator e = estimator_for(mesh, quality, &budget);
    assert(take && grain >= 0);
    e.known = tri_has_sizes(quality) ? compute_works(asked_works(&e), executor) : NULL;
    struct works rest = sampled_works(&e, rest_work);
    rest.known = compute_works(rest, executor);
    bool taken = sample_rest(&to, &rest, grain);
    if (taken && tri_has_sizes(quality))
        taken = sample_asked(&to, &e, grain);
    free(rest.known);
    free(e.known);
    return taken;
}
