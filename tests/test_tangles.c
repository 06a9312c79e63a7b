/* Meshes of thousands of tangles (see tangles.h), all of them checked: triangulated with hull, carved, and refined.
   TANGLES: number of tangles per family. */
#include "full.h"
#include "tangles.h"
#include "triangle/cdt/crossing.h"

static struct tri_options triangulated(void)
{
    struct tri_options options = tri_defaults();
    options.use_segments = true;
    return options;
}

/* The number of new points is limited, since rounding creates arbitrarily small features. */
static struct tri_options refined(double min_angle, bool conforming)
{
    struct tri_options options = support_quality(min_angle, 0);
    options.quality.conforming = conforming;
    options.quality.max_steiner = 2000;
    return options;
}

static void expect_good(int family, uint64_t seed, struct tri_options options)
{
    struct tri_pslg pslg = tangles_make(family, seed);
    struct tri_check_options asked = {.max_bad = INT64_MAX, .ignore_holes = true};
    struct tri_check_report judgement;
    struct tri_report report;
    struct tri_error error = {0};
    struct tri_mesh mesh;
    char text[SUPPORT_TEXT];
    if (tri_generate(&mesh, &pslg, &options, &report, &error) != TRI_OK)
        fail_msg("%s, seed %d: %s", tangles_name(family), (int)seed, error.text);
    asked.border = options.keep_hull ? TRI_CHECK_BORDER_HULL : TRI_CHECK_BORDER_SEGMENTS;
    asked.convex = options.keep_hull && !options.refine && !mesh.twin;
    if (mesh.n_triangles > 0 && !support_passes(&mesh, &pslg, &asked, false, &judgement, text))
        fail_msg("%s, seed %d: %s", tangles_name(family), (int)seed, text);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

static void expect_all_good(struct tri_options options, int n)
{
    for (int family = 0; family < tangles_families(); family++)
        for (int seed = 0; seed < n; seed++)
            expect_good(family, (uint64_t)seed, options);
}

static void test_tangles_with_hull_are_triangulated(void **state)
{
    (void)state;
    struct tri_options options = triangulated();
    options.keep_hull = true;
    expect_all_good(options, TANGLES / every(4));
}

static void test_carved_tangles_are_triangulated(void **state)
{
    (void)state;
    expect_all_good(triangulated(), TANGLES / every(4));
}

static void test_tangles_are_refined(void **state)
{
    (void)state;
    expect_all_good(refined(20, false), TANGLES / every(4) / 6);
    expect_all_good(refined(30, true), TANGLES / every(4) / 6);
}

/* Each crossing is computed from the input segments, so errors do not accumulate along a segment with hundreds of
   crossings. */
static void test_crossings_do_not_drift(void **state)
{
    (void)state;
    int32_t crossings = 0;
    for (uint64_t seed = 0; seed < 20; seed++) {
        struct tri_constrain_report report;
        struct tri_pslg pslg = tangles_make(tangles_families() - 1, seed);
        struct tri_mesh mesh = support_constrained(&pslg, &report);
        for (int32_t s = 0; report.bent == 0 && s < mesh.n_subs; s++) {
            struct tri_point p = mesh.xy[mesh.sub[s].v[1]];
            if (mesh.parents[mesh.sub[s].parent].segment != 0)
                continue;
            assert_true(tri_line_distance(mesh.xy[0], mesh.xy[1], p) <= tri_resolution(p));
            crossings++;
        }
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
    assert_true(crossings > 500);
}

/* Does the subsegment leave a slit of zero width beside a vertex that lies on its segment up to rounding? */
static bool has_slit(const struct tri_mesh *mesh, const struct tri_pslg *pslg, const struct tri_subsegment *s, int side)
{
    int32_t segment = mesh->parents[s->parent].segment;
    if (segment == TRI_NONE || s->side[side] == TRI_NONE)
        return false;
    struct tri_point a = mesh->xy[s->v[0]], b = mesh->xy[s->v[1]], q = mesh->xy[tri_apex(mesh, s->side[side])];
    struct tri_point from = mesh->xy[pslg->segments[2 * segment]], to = mesh->xy[pslg->segments[2 * segment + 1]];
    double x = b.x - a.x, y = b.y - a.y, length = sqrt(x * x + y * y), resolution = tri_resolution(q);
    double foot = (x * (q.x - a.x) + y * (q.y - a.y)) / length;
    return tri_line_distance(a, b, q) <= 0.5 * resolution && fmin(foot, length - foot) > 0.5 * resolution &&
           tri_line_distance(from, to, q) <= 3 * fmax(tri_resolution(from), tri_resolution(to));
}

/* If a vertex lies on a segment up to rounding, the face there is closed: an edge runs through the vertex. */
static void expect_no_slits(int family, uint64_t seed)
{
    struct tri_constrain_report report;
    struct tri_pslg pslg = tangles_make(family, seed);
    struct tri_mesh mesh = support_constrained(&pslg, &report);
    for (int32_t s = 0; s < mesh.n_subs; s++)
        for (int side = 0; side < 2; side++)
            if (has_slit(&mesh, &pslg, &mesh.sub[s], side))
                fail_msg("%s, seed %d: subsegment %d-%d passes vertex %d within rounding", tangles_name(family),
                         (int)seed, (int)mesh.sub[s].v[0], (int)mesh.sub[s].v[1],
                         (int)tri_apex(&mesh, mesh.sub[s].side[side]));
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

static void test_no_slits(void **state)
{
    (void)state;
    for (int family = 0; family < tangles_families(); family++)
        for (uint64_t seed = 0; seed < (uint64_t)(TANGLES / every(4)); seed++)
            expect_no_slits(family, seed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tangles_with_hull_are_triangulated),
        cmocka_unit_test(test_carved_tangles_are_triangulated),
        cmocka_unit_test(test_tangles_are_refined),
        cmocka_unit_test(test_no_slits),
        cmocka_unit_test(test_crossings_do_not_drift),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
