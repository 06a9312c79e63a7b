/* The stages of a run, as the programs have them, each result before the judges. */
#include "tests/torture/judge.h"

#include "sched/schedule.h"
#include "sched/threads.h"
#include "triangle/quality.h"
#include "triangle/reconstruct.h"

/* In degrees: up to here theory promises an end (28.6, where no segments meet at small angles). */
static const double PROMISED = 28;

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

/* --- making */

/* Edges no longer than a fifth of the way to the corner of the figure, or than a hundredth of the figure. */
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

/* With how many threads to make what. */
struct making {
    struct outcome *outcome;
    int threads;
};

static enum tri_status refine_call(void *user, struct tri_mesh *mesh, const struct tri_refine_options *options,
                                   struct tri_refine_report *report, struct tri_error *error)
{
    const struct making *making = user;
    (void)mesh, (void)options, (void)report; /* those of the outcome */
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

/* --- judging */

/* The input as a mesh keeps it: coordinates smaller than 2^-216 of the largest count as 0. The points are the caller's
 * to free. */
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

/* The first mesh by three threads. */
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

/* The points alone: in one leaf by one thread, and in tiny ones by three. */
static void judge_points(const struct torture_case *c, struct verdict *verdict)
{
    int threads = 3;
    const struct tri_executor executor = par_executor(&threads);
    enter(verdict, "triangulating points");
    struct tri_mesh whole = support_delaunay(&c->figure.pslg, c->figure.pslg.n_points + 1, NULL);
    struct tri_mesh parts = support_delaunay(&c->figure.pslg, 1 + c->figure.pslg.n_points % 40, &executor);
    if (!same_meshes(&whole, &parts))
        judge_fault(verdict, "points", "%d triangles in one leaf, another triangulation of %d in many",
                    (int)whole.n_triangles, (int)parts.n_triangles);
    tri_mesh_free(&whole);
    tri_mesh_free(&parts);
}

/* --- how many triangles */

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

/* x and y of n places, so many numbers apart: mirrored at either axis, and exchanged, as the bits of `image` say. */
static double *mirrored(const double *place, int32_t n, size_t stride, int image)
{
    double *to = malloc((size_t)n * stride * sizeof *to + 1);
    assert_non_null(to);
    for (size_t i = 0; i < (size_t)n * stride; i++)
        to[i] = place[i];
    for (size_t i = 0; i < (size_t)n; i++) {
        const double x = image & 1 ? -place[i * stride] : place[i * stride];
        const double y = image & 2 ? -place[i * stride + 1] : place[i * stride + 1];
        to[i * stride] = image & 4 ? y : x;
        to[i * stride + 1] = image & 4 ? x : y;
    }
    return to;
}

/* The most triangles that one call makes of the figure and of its mirror images. All distances are the same in these,
 * bit by bit; only the order of work is another. Up to the angle that theory promises that hardly matters; above, a
 * mesh grows fine or does not as the order has it: parallel lines at 34 degrees (crossing_grid 13101813) take 375
 * triangles, and seven images 4,404 to 4,660. */
static int32_t most_of_images(const struct torture_case *sequential, const struct outcome *first,
                              const struct tri_pslg *pslg, struct verdict *verdict)
{
    int32_t most = 0;
    for (int image = 1; image < 8; image++) {
        struct tri_pslg mirror = *pslg;
        mirror.points = mirrored(pslg->points, pslg->n_points, 2, image);
        mirror.holes = mirrored(pslg->holes, pslg->n_holes, 2, image);
        mirror.regions = mirrored(pslg->regions, pslg->n_regions, 4, image);
        const int32_t n = triangles_of(sequential, first, &mirror, verdict);
        most = n > most ? n : most;
        free(mirror.points);
        free(mirror.holes);
        free(mirror.regions);
    }
    return most;
}

/* The schedule's mesh has about as many triangles as that of one sequential call. THEORY: both come of the same rules
 * in another order. Whatever the order, points keep a fixed share of the feature size from each other, and are as dense
 * as it and the areas ask (feature_size.c): both numbers lie between fixed multiples of one integral. Those of the
 * proof are too far apart to judge by, so the factors are measured, over all families and 3,000 cases with a schedule:
 * at most 1.11 in cells of the schedule's choice and 1.62 in tiny ones, which are all seam; above 32 degrees, where
 * small edges spread as the order has it, 1.33 and 2.04. The sides of a narrow space are halved until their parts are
 * about as long as it is wide, and order decides on the last halving: what such spaces take may be twice as much. Above
 * the angle that theory promises one call may be lucky, so its meshes of the mirror images count, too. Not
 * with a size test, which belongs to the figure as it is. */
static void judge_schedule_size(const struct outcome *first, const struct tri_pslg *pslg, struct verdict *verdict)
{
    bool spreads = first->options.quality.min_angle > 32;
    const double OWN_CELLS = spreads ? 1.4 : 1.2, TINY_CELLS = spreads ? 4 : 2;
    const double FEW = 100 + first->mesh.limits.gap_points;
    struct torture_case sequential = *first->of, by_itself = *first->of;
    sequential.block = 0;
    by_itself.block = -1;
    enter(verdict, "meshing sequentially");
    int32_t one_call = triangles_of(&sequential, first, pslg, verdict);
    enter(verdict, "meshing in the schedule's own cells");
    int32_t own = triangles_of(&by_itself, first, pslg, verdict);
    bool large = own > OWN_CELLS * one_call + FEW || first->mesh.n_triangles > TINY_CELLS * one_call + FEW;
    if (large && first->options.quality.min_angle > PROMISED && !first->switches.user_test) {
        int32_t most = most_of_images(&sequential, first, pslg, verdict);
        one_call = most > one_call ? most : one_call;
    }
    if (own > OWN_CELLS * one_call + FEW)
        judge_fault(verdict, "schedule size", "%d triangles, sequentially %d", (int)own, (int)one_call);
    if (first->mesh.n_triangles > TINY_CELLS * one_call + FEW)
        judge_fault(verdict, "schedule size", "%d triangles in tiny cells, sequentially %d",
                    (int)first->mesh.n_triangles, (int)one_call);
}

/* No mesh runs away: at most so many times the triangles at the angle that theory promises. */
static void judge_amount(const struct outcome *first, const struct tri_pslg *pslg, struct verdict *verdict)
{
    const struct tri_refine_options *asked = &first->options.quality;
    const double TIMES = 8;
    enum { FEW = 3000 };
    struct outcome less = *first;
    const double angle = asked->min_angle;
    if (first->mesh.n_triangles < FEW || angle <= PROMISED || first->switches.protect > 0)
        return; /* where segments must stay as they are theory promises nothing */
    enter(verdict, "meshing at a smaller angle");
    less.options.quality.min_angle = PROMISED;
    int32_t n = triangles_of(first->of, &less, pslg, verdict);
    if (first->mesh.n_triangles > TIMES * n + FEW)
        judge_fault(verdict, "too many", "%d triangles at %g degrees, %d at %g", (int)first->mesh.n_triangles, angle,
                    (int)n, PROMISED);
}

/* --- whether it ends */

/* So many points a figure can ask for at most, as the mesh that has been made counts them; see judge_end. */
static double most_points(const struct outcome *o, const struct tri_pslg *pslg)
{
    const double PER_VERTEX = 1000, PER_GAP_POINT = 40, SIZED_GAP_POINT = 60, SIZES = 200000;
    const double PER_WALL = 4000, WALLS = 1800000, ABOVE = 2;
    const struct tri_refine_options *asked = &o->options.quality;
    bool refuses_walls = o->switches.protect > 0 && asked->unsuitable;
    bool is_above = asked->min_angle > TRI_USUAL_ANGLE && tri_has_sizes(asked);
    return (is_above ? ABOVE : 1) * SIZES + PER_VERTEX * o->mesh.n_input +
           (refuses_walls ? fmin(PER_WALL * pslg->n_segments, WALLS) : 0) +
           (tri_has_sizes(asked) ? SIZED_GAP_POINT : PER_GAP_POINT) * o->mesh.limits.gap_points;
}

/* Is this many points enough for a sequential call? */
static bool suffices(struct outcome *first, const struct tri_pslg *pslg, int64_t points, double *asked,
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

/* A mesh that does not end is one with more points than its figure can ask for: those of its narrow spaces (the most
 * seen are 20 for each that the mesher counts on at 30 degrees, and 40 at 34, half as many again with sizes), of its
 * features, which differ by twelve orders of magnitude at most, and of its sizes, see draw_sizes; above the usual angle
 * these may be twice as many (249,000 points at 34 degrees were 460,000 at 37; judge_amount). Beside a wall that
 * must not be split a size test refuses all triangles, down to some 4,096 times as long as high: the most seen are 800
 * points for a side of one, at 34 degrees. One that asks for more than is AFFORDABLE to make over and over, but no more
 * than that, is judged as with a limit of so many points. */
static void judge_end(struct outcome *first, const struct tri_pslg *pslg, struct verdict *verdict)
{
    enum { AFFORDABLE = 300000 };
    double asked;
    enter(verdict, "seeing whether it ends");
    if (suffices(first, pslg, AFFORDABLE, &asked, verdict))
        return;
    if (asked <= AFFORDABLE || !suffices(first, pslg, (int64_t)asked, &asked, verdict))
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

/* The mesh of a first one, ready to be refined again. */
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
static bool refine_for_nothing(const struct outcome *before, struct outcome *after, struct verdict *verdict)
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

/* Are there more triangles than before, than rounding and the order of work explain, and than these? */
static bool has_grown(const struct outcome *before, const struct outcome *after, double asked)
{
    const double AGAIN = before->options.quality.conforming ? 2 : 1.2;
    enum { FEW = 1000 };
    return after->mesh.n_triangles > AGAIN * before->mesh.n_triangles + FEW + asked;
}

/* Are spaces filled that were left before? */
static bool fills_more(const struct outcome *before, const struct outcome *after)
{
    return after->mesh.limits.dearest_gap > before->mesh.limits.dearest_gap;
}

/* What triangles may ask for again that were given up where vertices ran away: see judge_amount_again. */
static double asked_again(const struct outcome *first)
{
    const double EACH = 4;
    struct tri_refine_options angles = first->options.quality;
    int64_t count[TRI_EXCUSES];
    angles.max_area = 0;
    angles.region_areas = false;
    angles.unsuitable = NULL;
    tri_count_bad(&first->mesh, &angles, &first->report.quality, NULL, count);
    return EACH * (double)count[TRI_EXCUSE_LIMIT] * (angles.conforming ? first->mesh.n_parents : 1);
}

/* A mesh that is refined again, with the same bounds, stays about as it is: what was given up is given up again
 * (chain.h). Above the angle that theory promises it does not: its points were on credit once, and each is a vertex
 * like any other then, that grants credit for more (credit.h). Nor where segments must stay as they are: the order
 * decides which points they hinder. Under -D it decides on circles in narrow spaces, too: 1.41 times as many is the
 * most that was seen.
 *
 * A narrow space that was left may be filled: what such spaces cost is reckoned with the triangles in them, which are
 * shorter in a mesh that is read (tri_choose_gaps). That is done once: the mesh that comes of it stays.
 *
 * Where vertices ran away more is asked for, once. An edge had run away because it was short for the sizes that its
 * ends had inherited, and these are written nowhere (feature_size.h): in a mesh that is read its neighbours are as near
 * as features. So the triangle is asked for again, and a few come of it: 2.6 seen. With -D the points are taken over by
 * subsegments of other parents that they are level with (disk.c): 162 triangles for each seen, among 23 parents. In the
 * mesh that comes of that these edges are features as they were when it was made: so it stays. */
static void judge_amount_again(const struct outcome *first, struct verdict *verdict)
{
    struct outcome second = {0}, third = {0};
    enter(verdict, "refining for nothing");
    if (refine_for_nothing(first, &second, verdict) && has_grown(first, &second, 0)) {
        if (!fills_more(first, &second) && has_grown(first, &second, asked_again(first)))
            judge_fault(verdict, "again", "%d triangles, and %d when they are refined once more",
                        (int)first->mesh.n_triangles, (int)second.mesh.n_triangles);
        else if (refine_for_nothing(&second, &third, verdict) && has_grown(&second, &third, 0))
            judge_fault(verdict, "again", "%d triangles, then %d, and %d when they are refined twice more",
                        (int)first->mesh.n_triangles, (int)second.mesh.n_triangles, (int)third.mesh.n_triangles);
    }
    tri_mesh_free(&second.mesh);
    tri_mesh_free(&third.mesh);
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
    /* Short edges that a bound above the usual one has left are features of the mesh: asked again it would go on. */
    if (o.options.quality.min_angle > TRI_USUAL_ANGLE)
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

/* --- all together */

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
        o.options.quality.min_angle <= TRI_USUAL_ANGLE)
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
