/* See the header. The code is deliberately simple, so that it can check more complicated code. */
#include "support.h"

#include <dirent.h>
#include <stdio.h>
#include <unistd.h>

#include "triangle/size/estimate.h"
#include "triangle/cdt/delaunay.h"
#include "triangle/text/read.h"

uint64_t support_bits(struct support_random *random)
{
    uint64_t z = random->state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

double support_unit(struct support_random *random) { return (double)(support_bits(random) >> 11) * 0x1p-53; }

int32_t support_below(struct support_random *random, int32_t n)
{
    return (int32_t)(support_bits(random) % (uint64_t)n);
}

static void *room_for(int32_t n, size_t item)
{
    void *block = calloc((size_t)n + 1, item);
    assert_non_null(block);
    return block;
}

struct tri_pslg support_pslg(int32_t points, int32_t segments, int32_t holes, int32_t regions)
{
    return (struct tri_pslg){.points = room_for(points, 2 * sizeof(double)),
                             .segments = room_for(segments, 2 * sizeof(int32_t)),
                             .holes = room_for(holes, 2 * sizeof(double)),
                             .regions = room_for(regions, 4 * sizeof(double))};
}

int32_t support_add_point(struct tri_pslg *pslg, double x, double y)
{
    int32_t v = pslg->n_points++;
    pslg->points[2 * v] = x;
    pslg->points[2 * v + 1] = y;
    return v;
}

void support_add_segment(struct tri_pslg *pslg, int32_t a, int32_t b)
{
    int32_t s = pslg->n_segments++;
    pslg->segments[2 * s] = a;
    pslg->segments[2 * s + 1] = b;
}

static void make_point(enum support_kind kind, int32_t i, struct support_random *random, double at[2])
{
    static const int ring[12][2] = {{25, 0}, {24, 7}, {20, 15}, {15, 20}, {7, 24}, {0, 25},
                                    {-7, 24}, {-15, 20}, {-20, 15}, {-24, 7}, {-25, 0}, {-24, -7}};
    double x = support_unit(random), y = support_unit(random);
    if (kind == SUPPORT_LATTICE) {
        x = floor(6 * x);
        y = floor(6 * y);
    } else if (kind == SUPPORT_RING) {
        double scale = ldexp(1, -(i / 24 % 40));
        int flip = i / 12 % 2 ? -1 : 1;
        x = flip * scale * ring[i % 12][0];
        y = flip * scale * ring[i % 12][1];
    } else if (kind == SUPPORT_LINE) {
        x = floor(64 * x);
        y = i % 7 == 6 ? floor(200 * y) : 3 * x;
    } else if (kind == SUPPORT_NEAR_LINE) {
        y = 0.3 * x + 0.1;
    } else if (kind == SUPPORT_CLUSTER) {
        double scale = ldexp(1, -support_below(random, 40));
        x *= scale;
        y *= scale;
    }
    at[0] = x;
    at[1] = y;
}

static double attribute_at(int k, struct tri_point p) { return k ? p.x - 3 * p.y : 2 * p.x + p.y; }

void support_add_attributes(struct tri_pslg *pslg)
{
    pslg->n_attributes = 2;
    pslg->attributes = malloc(2 * (size_t)pslg->n_points * sizeof *pslg->attributes);
    assert_non_null(pslg->attributes);
    for (int32_t i = 0; i < 2 * pslg->n_points; i++)
        pslg->attributes[i] =
            attribute_at(i % 2, (struct tri_point){pslg->points[i / 2 * 2], pslg->points[i / 2 * 2 + 1]});
}

void support_add_heights(struct tri_pslg *pslg, int32_t n, uint64_t seed)
{
    struct support_random random = {seed};
    free(pslg->attributes);
    pslg->n_attributes = n;
    pslg->attributes = malloc(((size_t)n * (size_t)pslg->n_points + 1) * sizeof *pslg->attributes);
    assert_non_null(pslg->attributes);
    for (int32_t i = 0; i < n * pslg->n_points; i++)
        pslg->attributes[i] = support_unit(&random);
}

/* Computes how far p is inside each edge, as a share of the height over that edge. Negative: outside. */
static long double compute_inside(const struct tri_point corner[3], struct tri_point p, long double weight[3])
{
    long double least = HUGE_VALL, sum = 0;
    for (int e = 0; e < 3; e++) {
        const struct tri_point a = corner[tri_next[e]], b = corner[tri_prev[e]];
        weight[e] = ((long double)b.x - a.x) * ((long double)p.y - a.y) -
                    ((long double)b.y - a.y) * ((long double)p.x - a.x);
        sum += weight[e];
    }
    for (int e = 0; e < 3; e++) {
        weight[e] /= sum;
        least = weight[e] < least ? weight[e] : least;
    }
    return least;
}

/* A mesh that was read may have several triangles with different values at a vertex on a crack. Any of their values is
 * accepted. */
static bool is_on_surface(const struct tri_mesh *before, struct tri_point p, const double *value)
{
    const int32_t n = before->n_attributes;
    const long double rounding = 0x1p-46L * tri_larger(fabs(p.x), fabs(p.y)); /* rounding of p beside a segment */
    for (int32_t t = 0; t < before->n_triangles; t++) {
        const int32_t *v = before->tri[t].v;
        const struct tri_point corner[3] = {before->xy[v[0]], before->xy[v[1]], before->xy[v[2]]};
        long double weight[3];
        bool good = compute_inside(corner, p, weight) > -1e-9L - rounding;
        for (int32_t k = 0; good && k < n; k++) {
            const double *a = before->attributes;
            const long double is = weight[0] * a[n * v[0] + k] + weight[1] * a[n * v[1] + k] +
                                   weight[2] * a[n * v[2] + k];
            good = fabsl(is - value[k]) <= 1e-8L + rounding;
        }
        if (good)
            return true;
    }
    return false;
}

void support_assert_on_surface(const struct tri_mesh *before, const struct tri_mesh *mesh)
{
    const int32_t n = mesh->n_attributes, first = before->n_vertices;
    const int32_t step = 1 + (int32_t)(((int64_t)mesh->n_vertices - first) * before->n_triangles / 10000000);
    for (int32_t v = first; v < mesh->n_vertices; v += step)
        if (!is_on_surface(before, mesh->xy[v], mesh->attributes + (size_t)n * (size_t)v))
            fail_msg("vertex %d at (%.17g, %.17g) lies off the surface of the input", v, mesh->xy[v].x, mesh->xy[v].y);
}

bool support_has_its_attributes(const struct tri_mesh *mesh, int32_t v)
{
    const double *has = mesh->attributes + 2 * v;
    return fabs(has[0] - attribute_at(0, mesh->xy[v])) < 1e-9 && fabs(has[1] - attribute_at(1, mesh->xy[v])) < 1e-9;
}

struct tri_pslg support_points(enum support_kind kind, int32_t n, uint64_t seed)
{
    struct support_random random = {seed * SUPPORT_KINDS + kind};
    struct tri_pslg pslg = support_pslg(n, 0, 0, 0);
    for (int32_t i = 0; i < n; i++) {
        double at[2];
        make_point(kind, i, &random, at);
        support_add_point(&pslg, at[0], at[1]);
    }
    return pslg;
}

struct tri_pslg support_polygon(int32_t n, uint64_t seed)
{
    struct support_random random = {seed};
    struct tri_pslg pslg = support_pslg(n, n, n, n);
    for (int32_t i = 0; i < n; i++) {
        double angle = 6.28318530717958648 * i / n, radius = 0.3 + support_unit(&random);
        support_add_point(&pslg, radius * cos(angle), radius * sin(angle));
    }
    for (int32_t i = 0; i < n; i++)
        support_add_segment(&pslg, i, (i + 1) % n);
    return pslg;
}

static void add_square(struct tri_pslg *pslg, double low, double high)
{
    int32_t first = pslg->n_points;
    support_add_point(pslg, low, low);
    support_add_point(pslg, high, low);
    support_add_point(pslg, high, high);
    support_add_point(pslg, low, high);
    for (int k = 0; k < 4; k++)
        support_add_segment(pslg, first + k, first + (k + 1) % 4);
}

struct tri_pslg support_square(double side, int32_t n, uint64_t seed)
{
    struct support_random random = {seed};
    struct tri_pslg pslg = support_pslg(n + 4, 4, n, n);
    add_square(&pslg, 0, side);
    for (int32_t i = 0; i < n; i++) {
        double x = side * support_unit(&random), y = side * support_unit(&random);
        support_add_point(&pslg, x, y);
    }
    return pslg;
}

struct tri_pslg support_tangle(enum support_kind kind, int32_t n, int32_t m, uint64_t seed)
{
    struct support_random random = {seed ^ 0x7a11};
    struct tri_pslg pslg = support_pslg(n + 4, m + 4, n, n), points = support_points(kind, n, seed);
    double size = 1;
    for (int32_t i = 0; i < 2 * n; i++)
        size = fabs(points.points[i]) > size ? fabs(points.points[i]) : size;
    add_square(&pslg, -2 * ceil(size), 2 * ceil(size));
    for (int32_t i = 0; i < n; i++)
        support_add_point(&pslg, points.points[2 * i], points.points[2 * i + 1]);
    for (int32_t k = 0; k < m; k++) {
        int32_t a = support_below(&random, n + 4), b = support_below(&random, n + 4);
        support_add_segment(&pslg, a, b);
    }
    tri_pslg_free(&points);
    return pslg;
}

static bool ends_in(const char *name, const char *end)
{
    size_t n = strlen(name), m = strlen(end);
    return n >= m && strcmp(name + n - m, end) == 0;
}

bool support_read(const char *name, struct tri_pslg *pslg)
{
    char path[1024];
    struct tri_read_options options = {.default_base = 1, .want_regions = true};
    struct tri_error error;
    int32_t base;
    bool in_poly;
    snprintf(path, sizeof path, "%s/%s", PTRIANGLE_DATA_DIR, name);
    if (ends_in(name, ".node"))
        return tri_read_node(path, &options, pslg, &base, &error) == TRI_OK;
    enum tri_status status = tri_read_poly(path, NULL, &options, pslg, &base, &in_poly, &error);
    if (status != TRI_OK) { /* most inputs have no file of regions */
        options.want_regions = false;
        status = tri_read_poly(path, NULL, &options, pslg, &base, &in_poly, &error);
    }
    if (status == TRI_OK && strstr(name, "subnormal")) {
        tri_pslg_free(pslg);
        return false;
    }
    return status == TRI_OK;
}

static int compare_names(const void *a, const void *b) { return strcmp(*(char *const *)a, *(char *const *)b); }

char **support_names(const char *folder)
{
    char path[1024];
    size_t n = 0;
    char **names = room_for(1000, sizeof *names);
    snprintf(path, sizeof path, "%s/%s", PTRIANGLE_DATA_DIR, folder);
    DIR *directory = opendir(path);
    assert_non_null(directory);
    for (struct dirent *entry; (entry = readdir(directory));) {
        if (!ends_in(entry->d_name, ".poly") && !ends_in(entry->d_name, ".node"))
            continue;
        size_t length = strlen(folder) + strlen(entry->d_name) + 2;
        assert_true(n < 1000);
        names[n] = room_for((int32_t)length, 1);
        snprintf(names[n++], length, "%s%s%s", folder, *folder ? "/" : "", entry->d_name);
    }
    closedir(directory);
    qsort(names, n, sizeof *names, compare_names);
    return names;
}

void support_free_names(char **names)
{
    for (char **name = names; *name; name++)
        free(*name);
    free(names);
}

struct support_copy support_copy(const struct tri_mesh *mesh)
{
    struct support_copy c = {.points = room_for(mesh->n_vertices, 2 * sizeof(double)),
                             .triangles = room_for(mesh->n_triangles, 3 * sizeof(int32_t)),
                             .neighbors = room_for(mesh->n_triangles, 3 * sizeof(int32_t)),
                             .segments = room_for(mesh->n_subs, 2 * sizeof(int32_t)),
                             .markers = room_for(mesh->n_subs, sizeof(int32_t)),
                             .attributes = room_for(mesh->n_triangles, sizeof(double)),
                             .max_areas = room_for(mesh->n_triangles, sizeof(double))};
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        tri_mesh_place(mesh, v, &c.points[2 * v]);
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        assert_true(tri_is_live(&mesh->tri[t])); /* the checker numbers the triangles of the mesh */
        for (int e = 0; e < 3; e++) {
            int32_t link = mesh->tri[t].n[e];
            if (link < 0) {
                const struct tri_subsegment *s = &mesh->sub[~link];
                link = s->side[1 - tri_side(s, mesh->tri[t].v[tri_next[e]])];
            }
            c.triangles[3 * t + e] = mesh->tri[t].v[e];
            c.neighbors[3 * t + e] = link == TRI_NONE ? -1 : tri_of(link);
        }
        c.max_areas[t] = mesh->regions[mesh->tri[t].region].max_area;
        c.attributes[t] = mesh->regions[mesh->tri[t].region].attribute;
    }
    for (int32_t s = 0; s < mesh->n_subs; s++) {
        c.segments[2 * s] = mesh->sub[s].v[0];
        c.segments[2 * s + 1] = mesh->sub[s].v[1];
        c.markers[s] = mesh->sub[s].marker;
    }
    bool spread = mesh->n_regions > 1 && mesh->n_columns == 0;
    c.mesh = (struct tri_check_mesh){.n_points = mesh->n_vertices, .points = c.points,
                                     .n_triangles = mesh->n_triangles, .triangles = c.triangles,
                                     .neighbors = c.neighbors, .n_segments = mesh->n_subs, .segments = c.segments,
                                     .segment_markers = c.markers, .point_markers = mesh->vertex_markers,
                                     .n_attributes = 1, .attributes = spread ? c.attributes : NULL};
    return c;
}

void support_copy_free(struct support_copy *copy)
{
    free(copy->points);
    free(copy->triangles);
    free(copy->neighbors);
    free(copy->segments);
    free(copy->markers);
    free(copy->max_areas);
    free(copy->attributes);
    *copy = (struct support_copy){0};
}

bool support_passes(const struct tri_mesh *mesh, const struct tri_pslg *pslg, const struct tri_check_options *options,
                    bool with_regions, struct tri_check_report *report, char text[SUPPORT_TEXT])
{
    struct tri_error error = {0};
    struct tri_check_options asked = *options;
    bool valid = tri_mesh_validate(mesh, &error) == TRI_OK;
    snprintf(text, SUPPORT_TEXT, "%s", error.text);
    if (!valid)
        return false;
    struct support_copy copy = support_copy(mesh);
    if (with_regions)
        asked.max_areas = copy.max_areas;
    assert_int_equal(check_both_ways(&copy.mesh, pslg, &asked, report, &error), TRI_OK);
    for (int kind = TRI_N_CHECKS - 1; kind >= 0; kind--) /* the message names the first kind with a fault */
        if (report->item[kind].state == TRI_CHECK_FAILED)
            snprintf(text, SUPPORT_TEXT, "%s (%lld times): %s", tri_check_name((enum tri_check_kind)kind),
                     (long long)report->item[kind].count, report->item[kind].text);
    support_copy_free(&copy);
    return tri_check_passed(report);
}

void support_judge(const struct tri_mesh *mesh, const struct tri_pslg *pslg, const struct tri_check_options *options,
                   bool with_regions, struct tri_check_report *report)
{
    struct tri_check_report own;
    char text[SUPPORT_TEXT];
    if (!support_passes(mesh, pslg, options, with_regions, report ? report : &own, text))
        fail_msg("%s", text);
}

void support_judge_hull(struct tri_mesh *mesh, const struct tri_pslg *pslg)
{
    struct tri_check_options options = {.max_bad = -1, .ignore_holes = true, .convex = !mesh->twin,
                                        .border = TRI_CHECK_BORDER_HULL};
    tri_mark_vertices(mesh);
    tri_mark_boundary(mesh);
    support_judge(mesh, pslg, &options, false, NULL);
}

struct tri_mesh support_generate(const struct tri_pslg *pslg, const struct tri_options *options,
                                 struct tri_report *report)
{
    struct tri_mesh mesh;
    struct tri_error error = {0};
    struct tri_report own;
    if (tri_generate(&mesh, pslg, options, report ? report : &own, &error) != TRI_OK)
        fail_msg("tri_generate: %s", error.text);
    assert_int_equal(tri_refine_prepare(&mesh, NULL, &error), TRI_OK);
    return mesh;
}

struct tri_mesh support_delaunay(const struct tri_pslg *pslg, int32_t leaf_size, const struct tri_executor *executor)
{
    struct tri_mesh mesh;
    struct tri_error error = {0};
    int32_t *rank;
    assert_int_equal(tri_mesh_init(&mesh, &error), TRI_OK);
    assert_int_equal(tri_mesh_take_points(&mesh, pslg, NULL, &error), TRI_OK);
    assert_int_equal(tri_sort_points(&mesh, &rank, executor, &error), TRI_OK);
    free(rank);
    if (leaf_size == 0 ? tri_delaunay(&mesh, executor, &error)
                       : tri_delaunay_in_leaves(&mesh, leaf_size, executor, &error))
        fail_msg("%s", error.text);
    if (tri_mesh_validate(&mesh, &error) != TRI_OK)
        fail_msg("%s", error.text);
    assert_int_equal(tri_restore_points(&mesh, executor, &error), TRI_OK);
    return mesh;
}

struct tri_mesh support_constrained(const struct tri_pslg *pslg, struct tri_constrain_report *report)
{
    struct tri_mesh mesh = support_delaunay(pslg, 0, NULL);
    struct tri_error error = {0};
    if (tri_constrain(&mesh, pslg, report, &error) != TRI_OK)
        fail_msg("tri_constrain: %s", error.text);
    if (tri_mesh_validate(&mesh, &error) != TRI_OK)
        fail_msg("%s", error.text);
    return mesh;
}

double support_estimate(const struct tri_mesh *mesh, const struct tri_quality *quality)
{
    double sure;
    return tri_estimate(mesh, quality, NULL, &sure);
}

struct tri_options support_quality(double min_angle, double max_area)
{
    struct tri_options options = tri_defaults();
    options.use_segments = true;
    options.refine = true;
    options.quality.min_angle = min_angle;
    options.quality.max_area = max_area;
    return options;
}

static int compare_triples(const void *left, const void *right)
{
    const int32_t *a = left, *b = right;
    for (int k = 0; k < 3; k++)
        if (a[k] != b[k])
            return a[k] < b[k] ? -1 : 1;
    return 0;
}

void support_sort(struct support_set *set)
{
    for (int32_t i = 0; i < set->n; i++) {
        int32_t *v = set->v[i];
        int first = v[0] < v[1] ? (v[0] < v[2] ? 0 : 2) : v[1] < v[2] ? 1 : 2;
        int32_t a = v[first], b = v[tri_next[first]], c = v[tri_prev[first]];
        v[0] = a, v[1] = b, v[2] = c;
    }
    if (set->n)
        qsort(set->v, (size_t)set->n, sizeof *set->v, compare_triples);
}

struct support_set support_triangles(const struct tri_mesh *mesh)
{
    struct support_set set = {0, room_for(mesh->n_triangles, sizeof *set.v)};
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        if (tri_is_live(&mesh->tri[t]))
            memcpy(set.v[set.n++], mesh->tri[t].v, sizeof *set.v);
    support_sort(&set);
    return set;
}

bool support_same(const struct support_set *a, const struct support_set *b)
{
    return a->n == b->n && (a->n == 0 || memcmp(a->v, b->v, (size_t)a->n * sizeof *a->v) == 0);
}

void support_set_free(struct support_set *set)
{
    free(set->v);
    *set = (struct support_set){0};
}

static int compare_places(const void *left, const void *right)
{
    const double *a = left, *b = right;
    for (int k = 0; k < 6; k++)
        if (a[k] != b[k])
            return a[k] < b[k] ? -1 : 1;
    return 0;
}

struct support_places support_places(const struct tri_mesh *mesh)
{
    struct support_places set = {0, room_for(mesh->n_triangles, sizeof *set.at)};
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        if (!tri_is_live(&mesh->tri[t]))
            continue;
        double at[3][2];
        int first = 0;
        for (int k = 0; k < 3; k++) {
            tri_mesh_place(mesh, mesh->tri[t].v[k], at[k]);
            if (at[k][0] < at[first][0] || (at[k][0] == at[first][0] && at[k][1] < at[first][1]))
                first = k;
        }
        for (int k = 0; k < 3; k++)
            memcpy(&set.at[set.n][2 * k], at[(first + k) % 3], sizeof at[0]);
        set.n++;
    }
    if (set.n)
        qsort(set.at, (size_t)set.n, sizeof *set.at, compare_places);
    return set;
}

bool support_same_places(const struct support_places *a, const struct support_places *b)
{
    if (a->n != b->n)
        return false;
    for (int32_t i = 0; i < a->n; i++)
        if (compare_places(a->at[i], b->at[i]) != 0)
            return false;
    return true;
}

bool support_has_place(const struct support_places *set, const double place[6])
{
    return set->n && bsearch(place, set->at, (size_t)set->n, sizeof *set->at, compare_places);
}

void support_places_free(struct support_places *set)
{
    free(set->at);
    *set = (struct support_places){0};
}

static int sign(double x) { return (x > 0) - (x < 0); }

static bool meets(struct tri_point p, struct tri_point q, struct tri_point a, struct tri_point b)
{
    int pa = sign(tri_orient2d(p, q, a)), pb = sign(tri_orient2d(p, q, b));
    int ap = sign(tri_orient2d(a, b, p)), aq = sign(tri_orient2d(a, b, q));
    if (pa == 0 && pb == 0) /* collinear: blocked if it lies in between */
        return ((a.x - p.x) * (a.x - q.x) + (a.y - p.y) * (a.y - q.y) <= 0) ||
               ((b.x - p.x) * (b.x - q.x) + (b.y - p.y) * (b.y - q.y) <= 0);
    return pa * pb <= 0 && ap * aq <= 0;
}

static bool same_place(struct tri_point p, struct tri_point q) { return p.x == q.x && p.y == q.y; }

/* A segment that starts at q hides q from p only if it runs towards p. */
static bool hides(struct tri_point p, struct tri_point q, struct tri_point a, struct tri_point b)
{
    if (!same_place(a, q) && !same_place(b, q))
        return meets(p, q, a, b);
    struct tri_point o = same_place(a, q) ? b : a;
    return tri_orient2d(p, q, o) == 0 && (o.x - q.x) * (p.x - q.x) + (o.y - q.y) * (p.y - q.y) > 0;
}

bool support_is_hidden(const struct tri_mesh *mesh, struct tri_point p, struct tri_point q, int32_t except)
{
    for (int32_t s = 0; s < mesh->n_subs; s++)
        if (s != except && hides(p, q, mesh->xy[mesh->sub[s].v[0]], mesh->xy[mesh->sub[s].v[1]]))
            return true;
    return false;
}

static void assert_sees_none(const struct tri_mesh *mesh, int32_t t)
{
    const int32_t *v = mesh->tri[t].v;
    struct tri_point a = mesh->xy[v[0]], b = mesh->xy[v[1]], c = mesh->xy[v[2]];
    struct tri_point inside = {(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3};
    if (tri_orient2d(a, b, inside) <= 0 || tri_orient2d(b, c, inside) <= 0 || tri_orient2d(c, a, inside) <= 0)
        return;
    for (int32_t q = 0; q < mesh->n_vertices; q++) {
        if (q == v[0] || q == v[1] || q == v[2] || (mesh->twin && q < mesh->n_input && mesh->twin[q] != q))
            continue;
        if (tri_in_circle(a, b, c, mesh->xy[q]) && !support_is_hidden(mesh, inside, mesh->xy[q], TRI_NONE))
            fail_msg("vertex %d lies in the circle of triangle %d and sees it", (int)q, (int)t);
    }
}

void support_assert_cdt(const struct tri_mesh *mesh, bool naive)
{
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        const struct tri_triangle *at = &mesh->tri[t];
        if (!tri_is_live(at))
            continue;
        if (tri_orient2d(mesh->xy[at->v[0]], mesh->xy[at->v[1]], mesh->xy[at->v[2]]) <= 0)
            fail_msg("triangle %d is not counter-clockwise", (int)t);
        for (int e = 0; e < 3; e++) {
            if (at->n[e] < 0)
                continue;
            int32_t apex = mesh->tri[tri_of(at->n[e])].v[tri_edge(at->n[e])];
            if (tri_in_circle(mesh->xy[at->v[0]], mesh->xy[at->v[1]], mesh->xy[at->v[2]], mesh->xy[apex]))
                fail_msg("edge %d of triangle %d is not Delaunay", e, (int)t);
        }
        if (naive)
            assert_sees_none(mesh, t);
    }
}

void support_assert_same_bytes(const struct tri_mesh *a, const struct tri_mesh *b)
{
    assert_int_equal(a->n_vertices, b->n_vertices);
    assert_int_equal(a->n_triangles, b->n_triangles);
    assert_int_equal(a->n_subs, b->n_subs);
    assert_int_equal(a->n_attributes, b->n_attributes);
    size_t n = (size_t)a->n_vertices;
    assert_memory_equal(a->xy, b->xy, n * sizeof *a->xy);
    assert_memory_equal(a->on, b->on, n * sizeof *a->on);
    assert_memory_equal(a->vertex_markers, b->vertex_markers, n * sizeof *a->vertex_markers);
    if (a->n_attributes > 0)
        assert_memory_equal(a->attributes, b->attributes, n * (size_t)a->n_attributes * sizeof *a->attributes);
    assert_memory_equal(a->sub, b->sub, (size_t)a->n_subs * sizeof *a->sub);
    for (int32_t t = 0; t < a->n_triangles; t++) {
        assert_memory_equal(a->tri[t].v, b->tri[t].v, sizeof a->tri[t].v);
        assert_memory_equal(a->tri[t].n, b->tri[t].n, sizeof a->tri[t].n);
        assert_int_equal(a->tri[t].region, b->tri[t].region);
    }
}

static void run_backwards(void *self, size_t n_tasks, void (*task)(void *context, size_t index), void *context)
{
    (void)self;
    while (n_tasks > 0)
        task(context, --n_tasks);
}

const struct tri_executor support_backwards = {run_backwards, NULL};

void support_remove_directory(const char *path)
{
    DIR *directory = opendir(path);
    for (const struct dirent *entry; directory && (entry = readdir(directory));) {
        char name[512];
        snprintf(name, sizeof name, "%s/%s", path, entry->d_name);
        unlink(name); /* except . and .. */
    }
    if (directory)
        closedir(directory);
    rmdir(path);
}
