/* The stages of a run, as in the programs. Each result is checked. */
#include "tests/torture/judge.h"

#include "sched/schedule/schedule.h"
#include "sched/schedule/threads.h"
#include "triangle/refine/place.h"
#include "triangle/cdt/reconstruct.h"

void judge_fault(struct verdict *verdict, const char *fault, const char *format, ...)
{
    if (verdict->fault[0])
        return;
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(verdict->detail, sizeof verdict->detail, format, arguments);
    va_end(arguments);
    snprintf(verdict->fault, sizeof verdict->fault, "%s", fault);
}

bool judge_names(const char *names, const char *fault)
{
    for (size_t n = strlen(fault); names; names = strchr(names, ',') ? strchr(names, ',') + 1 : NULL)
        if (strncmp(names, fault, n) == 0 && (names[n] == ',' || names[n] == 0))
            return true;
    return false;
}

static void enter(struct verdict *verdict, const char *stage)
{
    snprintf(verdict->stage, sizeof verdict->stage, "%s", stage);
}

/* --- making a mesh */

/* Size test: no edge is longer than a fifth of its distance from the figure's corner, or a hundredth of the figure. */
struct size_test {
    double corner[2], least2;
};

static int is_unsuitable(void *user, const double a[2], const double b[2], const double c[2], double area)
{
    const struct size_test *test = user;
    const double *p[3] = {a, b, c};
    double dx = a[0] - test->corner[0], dy = a[1] - test->corner[1];
    double limit = fmax((dx * dx + dy * dy) / 25, test->least2);
    (void)area;
    for (int k = 0; k < 3; k++) {
        double x = p[k][0] - p[(k + 1) % 3][0], y = p[k][1] - p[(k + 1) % 3][1];
        if (x * x + y * y > limit)
            return 1;
    }
    return 0;
}

static void add_size_test(struct tri_options *options, struct size_test *test, const struct tri_pslg *pslg)
{
    struct figure_bounds b = figure_bounds(pslg);
    double size = fmax(b.high[0] - b.low[0], b.high[1] - b.low[1]);
    *test = (struct size_test){{b.low[0], b.low[1]}, size * size / 1e4};
    options->quality.unsuitable = is_unsuitable;
    options->quality.unsuitable_user = test;
}

static enum tri_status refine(struct outcome *o, int threads, struct tri_error *error)
{
    struct par_options how = par_defaults();
    struct par_report schedule;
    if (o->of->block == 0)
        return tri_refine(&o->mesh, &o->options.quality, &o->report.quality, error);
    how.threads = threads;
    how.cell_triangles = o->of->block > 0 ? o->of->block : 0;
    how.size_test_in_parallel = true;
    enum tri_status status = par_refine(&o->mesh, &o->options.quality, &how, &schedule, error);
    o->report.quality = schedule.total;
    par_report_free(&schedule);
    return status;
}

/* The outcome to fill, and the number of threads to use. */
struct making {
    struct outcome *outcome;
    int threads;
};

static enum tri_status refine_call(void *user, struct tri_mesh *mesh, const struct tri_quality *options,
                                   struct tri_refine_report *report, struct tri_error *error)
{
    const struct making *making = user;
    (void)mesh, (void)options, (void)report; /* the results are in the outcome */
    return refine(making->outcome, making->threads, error);
}

static enum tri_status generate(struct outcome *o, const struct tri_pslg *pslg, int threads, struct tri_error *error)
{
    struct making making = {o, threads};
    struct tri_options options = o->options;
    options.refine_call = refine_call;
    options.refine_user = &making;
    enum tri_status status = tri_generate(&o->mesh, pslg, &options, &o->report, error);
    if (!status)
        tri_mesh_compact(&o->mesh);
    return status;
}

/* --- checking a mesh */

/* The input as stored in a mesh: coordinates below 2^-216 of the largest count as 0. The caller frees the points. */
static struct tri_pslg kept_input(const struct outcome *o, const struct tri_pslg *pslg)
{
    struct tri_pslg input = *pslg;
    size_t n = 2 * (size_t)pslg->n_points;
    input.points = malloc(n * sizeof *input.points + 1);
    assert_non_null(input.points);
    for (size_t i = 0; i < n; i++)
        input.points[i] = tri_round_coordinate(pslg->points[i] / o->mesh.unit) * o->mesh.unit;
    if (!o->switches.segments)
        input.n_segments = input.n_holes = 0;
    return input;
}

static bool is_conforming_fault(int kind) { return kind == TRI_CHECK_LOCAL_DELAUNAY || kind == TRI_CHECK_ENCROACHMENT; }

static void judge_mesh(const struct outcome *o, const struct tri_pslg *pslg, bool refined, struct verdict *verdict)
{
    struct tri_error error = {0};
    struct tri_check_report report;
    struct tri_check_options ask = {.min_angle = o->options.refine ? o->options.quality.min_angle : 0,
                                    .max_bad = INT64_MAX,
                                    .convex = o->switches.keep_hull && pslg->n_holes == 0 && !o->options.refine,
                                    .border = refined                   ? TRI_CHECK_BORDER_ANY
                                              : o->switches.keep_hull ? TRI_CHECK_BORDER_HULL
                                                                        : TRI_CHECK_BORDER_SEGMENTS,
                                    .ignore_holes = o->switches.ignore_holes || refined,
                                    .ignore_lost = refined,
                                    .base = 1};
    bool conforming = o->options.refine && o->options.quality.conforming && o->options.quality.max_steiner < 0;
    ask.delaunay = conforming && o->switches.protect == 0 ? TRI_CHECK_CONFORMING : TRI_CHECK_CONSTRAINED;
    verdict->triangles = o->mesh.n_triangles;
    if (tri_mesh_validate(&o->mesh, &error) != TRI_OK)
        judge_fault(verdict, "links", "%s", error.text);
    struct support_copy copy = support_copy(&o->mesh);
    struct tri_pslg input = kept_input(o, pslg);
    if (check_both_ways(&copy.mesh, &input, &ask, &report, &error) != TRI_OK)
        judge_fault(verdict, "checker", "%s", error.text);
    for (int kind = 0; kind < TRI_N_CHECKS && !verdict->fault[0]; kind++) {
        const struct tri_check_item *item = &report.item[kind];
        if (item->state != TRI_CHECK_FAILED)
            continue;
        if (ask.delaunay == TRI_CHECK_CONFORMING && is_conforming_fault(kind))
            judge_conforming(o, kind, item->count, verdict);
        else
            judge_fault(verdict, tri_check_name(kind), "%lld, first: %s", (long long)item->count, item->text);
    }
    free(input.points);
    support_copy_free(&copy);
    if (!verdict->fault[0])
        judge_bounds(o, &report, verdict);
}

static bool same_bytes(const void *a, const void *b, int32_t n, size_t item)
{
    return n == 0 || memcmp(a, b, (size_t)n * item) == 0;
}

static bool same_triangles(const struct tri_mesh *a, const struct tri_mesh *b)
{
    for (int32_t t = 0; t < a->n_triangles; t++) {
        const struct tri_triangle *p = &a->tri[t], *q = &b->tri[t];
        if (!same_bytes(p->v, q->v, 3, sizeof *p->v) || !same_bytes(p->n, q->n, 3, sizeof *p->n) ||
            p->region != q->region)
            return false;
    }
    return true;
}

static bool same_meshes(const struct tri_mesh *a, const struct tri_mesh *b)
{
    return a->n_vertices == b->n_vertices && a->n_triangles == b->n_triangles && a->n_subs == b->n_subs &&
           same_bytes(a->xy, b->xy, a->n_vertices, sizeof *a->xy) &&
           same_bytes(a->on, b->on, a->n_vertices, sizeof *a->on) &&
           same_bytes(a->vertex_markers, b->vertex_markers, a->n_vertices, sizeof *a->vertex_markers) &&
           (a->n_attributes == 0 || same_bytes(a->attributes, b->attributes, a->n_vertices,
                                               (size_t)a->n_attributes * sizeof *a->attributes)) &&
           same_bytes(a->sub, b->sub, a->n_subs, sizeof *a->sub) && same_triangles(a, b);
}

/* The first mesh, made by three threads. */
static void judge_threads(const struct outcome *first, const struct tri_pslg *pslg, struct verdict *verdict)
{
    struct tri_error error = {0};
    struct outcome o = {.of = first->of, .switches = first->switches, .options = first->options};
    enter(verdict, "meshing on 3 threads");
    if (generate(&o, pslg, 3, &error))
        judge_fault(verdict, "threads", "on 3 threads: %s", error.text);
    else if (!same_meshes(&first->mesh, &o.mesh))
        judge_fault(verdict, "threads", "%d triangles on 1 thread, another mesh of %d on 3",
                    (int)first->mesh.n_triangles, (int)o.mesh.n_triangles);
    tri_mesh_free(&o.mesh);
}

/* Only the points: in one leaf by one thread, and in tiny leaves by three. */
static void judge_points(const struct torture_case *c, struct verdict *verdict)
{
    struct par_team team = {.threads = 3};
    const struct tri_executor executor = par_executor(&team);
    enter(verdict, "triangulating points");
    struct tri_mesh whole = support_delaunay(&c->figure.pslg, c->figure.pslg.n_points + 1, NULL);
    struct tri_mesh parts = support_delaunay(&c->figure.pslg, 1 + c->figure.pslg.n_points % 40, &executor);
    par_team_end(&team);
    if (!same_meshes(&whole, &parts))
        judge_fault(verdict, "points", "%d triangles in one leaf, another triangulation of %d in many",
                    (int)whole.n_triangles, (int)parts.n_triangles);
    tri_mesh_free(&whole);
    tri_mesh_free(&parts);
}

/* --- number of triangles */

static int32_t triangles_of(const struct torture_case *as, const struct outcome *first, const struct tri_pslg *pslg,
                            struct verdict *verdict)
{
    struct tri_error error = {0};
    struct outcome o = {.of = as, .switches = first->switches, .options = first->options};
    if (generate(&o, pslg, 1, &error))
        judge_fault(verdict, "error", "schedule size: %s", error.text);
    int32_t n = o.mesh.n_triangles;
    tri_mesh_free(&o.mesh);
    return n;
}

/* The mesh is a run-away if it has more than this multiple of the triangles of a reference mesh. For angles, the limit
 * allows edges of a sixth of the surrounding features (README). */
enum { RUN_AWAY = 36, TIMES = 4, FEW = 3000 };

/* The schedule's mesh follows the rules of one call, in a different order. */
static void judge_schedule_size(const struct outcome *first, const struct tri_pslg *pslg, struct verdict *verdict)
{
    struct torture_case sequential = *first->of;
    sequential.block = 0;
    enter(verdict, "meshing sequentially");
    int32_t one_call = triangles_of(&sequential, first, pslg, verdict);
    if (first->mesh.n_triangles > (double)TIMES * one_call)
        judge_fault(verdict, "schedule size", "%d triangles, sequentially %d", (int)first->mesh.n_triangles,
                    (int)one_call);
}

/* Compared with a mesh at the angle for which the theory has a guarantee. */
static void judge_amount(const struct outcome *first, const struct tri_pslg *pslg, struct verdict *verdict)
{
    const struct tri_quality *asked = &first->options.quality;
    struct outcome less = *first;
    const double angle = asked->min_angle;
    if (first->mesh.n_triangles < FEW || angle <= PROMISED || first->switches.protect > 0)
        return; /* if segments must not change, the theory guarantees nothing */
    enter(verdict, "meshing at a smaller angle");
    less.options.quality.min_angle = PROMISED;
    int32_t n = triangles_of(first->of, &less, pslg, verdict);
    if (first->mesh.n_triangles > (double)RUN_AWAY * n + FEW)
        judge_fault(verdict, "too many", "%d triangles at %g degrees, %d at %d", (int)first->mesh.n_triangles, angle,
                    (int)n, PROMISED);
}

/* --- termination */

/* An upper bound on the points that a figure can request, as counted by the finished mesh. See judge_end. */
static double most_points(const struct outcome *o, const struct tri_pslg *pslg)
{
    const double PER_VERTEX = 1000, PER_GAP_POINT = 40, SIZED_GAP_POINT = 60, SIZES = 200000;
    const double PER_WALL = 4000, WALLS = 1800000;
    const struct tri_quality *asked = &o->options.quality;
    bool refuses_walls = o->switches.protect > 0 && asked->unsuitable;
    return SIZES + PER_VERTEX * o->mesh.n_input +
           (refuses_walls ? fmin(PER_WALL * pslg->n_segments, WALLS) : 0) +
           (tri_has_sizes(asked) ? SIZED_GAP_POINT : PER_GAP_POINT) * o->mesh.limits.gap_points;
}

/* Is this many points enough for a sequential call? */
static bool is_enough_points(struct outcome *first, const struct tri_pslg *pslg, int64_t points, double *asked,
                     struct verdict *verdict)
{
    struct tri_error error = {0};
    struct torture_case sequential = *first->of;
    struct outcome o = {.of = &sequential, .switches = first->switches, .options = first->options};
    sequential.block = 0;
    o.options.quality.max_steiner = points;
    if (generate(&o, pslg, 1, &error))
        judge_fault(verdict, "error", "%s", error.text);
    bool enough = !o.report.quality.hit_limit;
    *asked = most_points(&o, pslg);
    tri_mesh_free(&o.mesh);
    return enough;
}

/* A case is endless if its mesh has more points than its figure can request. These points come from its narrow spaces,
 * its features, and its sizes (see draw_sizes). For each narrow space that the mesher counts, at most 20 points were
 * seen at 30 degrees, 40 at 34, and half as many again with sizes. Features differ by at most twelve orders of
 * magnitude. Beside a wall that must not be split, a size test refuses all triangles, down to those about 4,096 times
 * as long as high. At most 800 points were seen for one side of such a triangle, at 34 degrees. If a figure requests
 * more than AFFORDABLE points but is not endless, it is meshed with that limit. */
static void judge_end(struct outcome *first, const struct tri_pslg *pslg, struct verdict *verdict)
{
    enum { AFFORDABLE = 300000 };
    double asked;
    enter(verdict, "seeing whether it ends");
    if (is_enough_points(first, pslg, AFFORDABLE, &asked, verdict))
        return;
    if (asked <= AFFORDABLE || !is_enough_points(first, pslg, (int64_t)asked, &asked, verdict))
        judge_fault(verdict, "endless", "more than %.0f points", fmax(asked, AFFORDABLE));
    first->options.quality.max_steiner = AFFORDABLE;
}

/* --- the second step: the mesh as input */

static struct tri_pslg pslg_of(const struct tri_mesh *mesh, const struct support_copy *copy)
{
    return (struct tri_pslg){.n_points = mesh->n_vertices,
                             .points = copy->points,
                             .markers = mesh->vertex_markers,
                             .n_segments = mesh->n_subs,
                             .segments = copy->segments,
                             .segment_markers = copy->markers};
}

/* The first mesh, ready to be refined again. */
static enum tri_status rebuild(const struct outcome *first, struct outcome *o, struct support_copy *copy,
                               struct tri_pslg *pslg, struct tri_error *error)
{
    *copy = support_copy(&first->mesh);
    *pslg = pslg_of(&first->mesh, copy);
    struct tri_elements elements = {
        .n = first->mesh.n_triangles, .corners = copy->triangles, .n_nodes = 3, .areas = copy->max_areas};
    struct tri_reconstruct_options how = {.use_segments = true, .refine = true, .base = 1};
    *o = (struct outcome){.of = first->of, .switches = first->switches, .options = first->options};
    return tri_reconstruct(&o->mesh, pslg, &elements, &how, error);
}

/* Refines a mesh once more with the same bounds. */
static bool refine_with_same_bounds(const struct outcome *before, struct outcome *after, struct verdict *verdict)
{
    struct tri_error error = {0};
    struct support_copy copy;
    struct tri_pslg pslg;
    enum tri_status status = rebuild(before, after, &copy, &pslg, &error);
    status = status ? status : refine(after, 1, &error);
    if (status)
        judge_fault(verdict, "error", "for nothing: %s", error.text);
    else
        tri_mesh_compact(&after->mesh);
    support_copy_free(&copy);
    return !status;
}

/* Refining again with the same bounds adds a few triangles where points accumulated or spaces were left unfilled. */
static void judge_amount_again(const struct outcome *first, struct verdict *verdict)
{
    struct outcome second = {0};
    enter(verdict, "refining for nothing");
    if (refine_with_same_bounds(first, &second, verdict) &&
        second.mesh.n_triangles > (double)TIMES * first->mesh.n_triangles)
        judge_fault(verdict, "again", "%d triangles, and %d when they are refined once more",
                    (int)first->mesh.n_triangles, (int)second.mesh.n_triangles);
    tri_mesh_free(&second.mesh);
}

static void judge_again(const struct outcome *first, struct verdict *verdict)
{
    struct tri_error error = {0};
    struct outcome o;
    struct support_copy copy;
    struct tri_pslg pslg;
    enter(verdict, "rebuilding");
    enum tri_status status = rebuild(first, &o, &copy, &pslg, &error);
    o.options.quality.max_area /= 2;
    o.options.quality.region_areas = true;
    /* Short edges that result from a bound above the default are features of the mesh, so a second refinement would
       continue. */
    if (o.options.quality.min_angle > tri_worked_angle(&o.options.quality))
        o.options.quality.min_angle = 30;
    enter(verdict, "refining again");
    status = status ? status : refine(&o, 1, &error);
    if (!status)
        tri_mesh_compact(&o.mesh);
    enter(verdict, "judging again");
    if (status)
        judge_fault(verdict, "error", "again: %s", error.text);
    else
        judge_mesh(&o, &pslg, true, verdict);
    tri_mesh_free(&o.mesh);
    support_copy_free(&copy);
}

/* --- the whole case */

static void judge_first(struct outcome *o, const struct tri_pslg *pslg, struct verdict *verdict)
{
    struct tri_error error = {0};
    enter(verdict, "meshing");
    if (generate(o, pslg, 1, &error)) {
        judge_fault(verdict, "error", "%s", error.text);
        return;
    }
    enter(verdict, "judging");
    judge_mesh(o, pslg, false, verdict);
    enter(verdict, "carving again");
    if (!verdict->fault[0])
        judge_carving(o, verdict);
}

void judge_case(const struct torture_case *c, struct verdict *verdict)
{
    const struct tri_pslg *pslg = &c->figure.pslg;
    struct outcome o = {.of = c, .switches = tri_switches_none()};
    struct size_test test;
    tri_switches_add(&o.switches, c->switches);
    o.options = tri_switches_options(&o.switches);
    if (o.switches.user_test)
        add_size_test(&o.options, &test, pslg);
    judge_points(c, verdict);
    if (!verdict->fault[0] && !tri_pslg_is_one_place(pslg) && o.options.refine && o.options.quality.max_steiner < 0)
        judge_end(&o, pslg, verdict);
    if (!verdict->fault[0] && !tri_pslg_is_one_place(pslg))
        judge_first(&o, pslg, verdict);
    if (!verdict->fault[0] && o.options.refine && o.options.quality.max_steiner < 0)
        judge_amount(&o, pslg, verdict);
    if (!verdict->fault[0] && o.mesh.n_triangles > 0 && o.options.refine && c->block > 0)
        judge_threads(&o, pslg, verdict);
    if (!verdict->fault[0] && o.options.refine && o.options.quality.max_steiner < 0 && c->block > 0 &&
        o.options.quality.min_angle <= tri_worked_angle(&o.options.quality))
        judge_schedule_size(&o, pslg, verdict);
    if (!verdict->fault[0] && o.mesh.n_triangles > 0 && o.options.refine && c->again &&
        o.options.quality.max_steiner < 0 && o.options.quality.min_angle <= PROMISED &&
        o.switches.protect == 0)
        judge_amount_again(&o, verdict);
    if (!verdict->fault[0] && o.mesh.n_triangles > 0 && o.options.refine && c->again)
        judge_again(&o, verdict);
    enter(verdict, "freeing");
    tri_mesh_free(&o.mesh);
    verdict->done = true;
}
