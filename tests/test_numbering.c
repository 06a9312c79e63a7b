/* Numbering a mesh gives the same bytes for every permutation of its vertices and triangles. */
#include "allocations.h"
#include "full.h"
#include "support.h"
#include "sched/tiles/numbering.h"
#include "tile_order.h"

/* Regions, crossing segments, and attributes that identify the position of a vertex. The mesh is so fine that the work
   is divided into shares. */
static struct tri_mesh refined(uint64_t seed, double max_area)
{
    struct tri_pslg pslg = support_tangle(SUPPORT_RANDOM, 60, 20, seed);
    struct tri_options options = support_quality(25, max_area);
    support_add_attributes(&pslg);
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    for (int32_t t = 0; t < mesh.n_triangles; t++) /* a region by position, to recognise each triangle */
        mesh.tri[t].region =
            mesh.xy[mesh.tri[t].v[0]].x + mesh.xy[mesh.tri[t].v[1]].x + mesh.xy[mesh.tri[t].v[2]].x > 1;
    tri_pslg_free(&pslg);
    return mesh;
}

/* A random injection of n items into n + n / 8 entries from `first` on. */
static int32_t *scatter(int32_t n, int32_t first, int32_t *places, struct support_random *random)
{
    *places = n + n / 8;
    int32_t *to = malloc(((size_t)*places + 1) * sizeof *to);
    assert_non_null(to);
    for (int32_t i = 0; i < *places; i++)
        to[i] = first + i;
    for (int32_t i = *places - 1; i > 0; i--) {
        int32_t k = support_below(random, i + 1), swap = to[i];
        to[i] = to[k];
        to[k] = swap;
    }
    return to;
}

/* The same mesh with permuted numbers, except for the first vertices, and with free entries between them. */
static struct tri_mesh scrambled(const struct tri_mesh *from, int32_t hubs, struct support_random *random)
{
    struct tri_mesh to;
    int32_t vertices, triangles, subs;
    int32_t *vertex = scatter(from->n_vertices - hubs, hubs, &vertices, random);
    int32_t *triangle = scatter(from->n_triangles, 0, &triangles, random);
    int32_t *sub = scatter(from->n_subs, 0, &subs, random);
    int32_t *turn = malloc((size_t)from->n_triangles * sizeof *turn);
    assert_non_null(turn);
    assert_int_equal(tri_mesh_init(&to, NULL), TRI_OK);
    to.n_attributes = from->n_attributes;
    assert_int_equal(tri_mesh_reserve_vertices(&to, hubs + vertices, NULL), TRI_OK);
    assert_int_equal(tri_mesh_reserve_triangles(&to, triangles, NULL), TRI_OK);
    assert_int_equal(tri_mesh_reserve_subs(&to, subs > from->n_parents ? subs : from->n_parents, NULL), TRI_OK);
    to.n_vertices = hubs + vertices;
    to.n_triangles = triangles;
    to.n_subs = subs;
    to.incidence.n_vertices = from->incidence.n_vertices;
    to.n_input = from->n_input;
    to.n_parents = from->n_parents;
    memcpy(to.parents, from->parents, (size_t)from->n_parents * sizeof *to.parents);
    for (int32_t v = 0; v < to.n_vertices; v++) {
        to.xy[v] = (struct tri_point){NAN, NAN};
        to.on[v] = TRI_VERTEX_NONE;
    }
    for (int32_t s = 0; s < subs; s++)
        to.sub[s] = (struct tri_subsegment){{TRI_NONE, TRI_NONE}, {TRI_NONE, TRI_NONE}, 0, TRI_NONE};
    for (int32_t t = 0; t < triangles; t++)
        to.tri[t] = (struct tri_triangle){{TRI_NONE, 7, 7}, {7, 7, 7}, 7, 7};
    for (int32_t t = 0; t < from->n_triangles; t++)
        turn[t] = support_below(random, 3);
#define VERTEX(v) ((v) < hubs ? (v) : vertex[(v) - hubs])
#define CODE(c) tri_code(triangle[tri_of(c)], (tri_edge(c) + turn[tri_of(c)]) % 3)
    for (int32_t v = 0; v < from->n_vertices; v++) {
        to.xy[VERTEX(v)] = from->xy[v];
        to.on[VERTEX(v)] = from->on[v];
        to.vertex_markers[VERTEX(v)] = from->vertex_markers[v];
        memcpy(to.attributes + 2 * VERTEX(v), from->attributes + 2 * v, 2 * sizeof *to.attributes);
    }
    for (int32_t t = 0; t < from->n_triangles; t++) {
        const struct tri_triangle *old = &from->tri[t];
        struct tri_triangle *fresh = &to.tri[triangle[t]];
        for (int k = 0; k < 3; k++) {
            fresh->v[(k + turn[t]) % 3] = VERTEX(old->v[k]);
            fresh->n[(k + turn[t]) % 3] = old->n[k] >= 0 ? CODE(old->n[k]) : ~sub[~old->n[k]];
        }
        fresh->region = old->region;
        fresh->generation = (uint32_t)support_bits(random);
    }
    for (int32_t s = 0; s < from->n_subs; s++) {
        const struct tri_subsegment *old = &from->sub[s];
        to.sub[sub[s]] = (struct tri_subsegment){{VERTEX(old->v[0]), VERTEX(old->v[1])},
                                                 {old->side[0] == TRI_NONE ? TRI_NONE : CODE(old->side[0]),
                                                  old->side[1] == TRI_NONE ? TRI_NONE : CODE(old->side[1])},
                                                 old->marker,
                                                 old->parent};
    }
#undef VERTEX
#undef CODE
    assert_int_equal(tri_mesh_validate(&to, NULL), TRI_OK);
    free(vertex);
    free(triangle);
    free(sub);
    free(turn);
    return to;
}

/* Blocks of about a hundred triangles. */
static struct par_partition partition_of(const struct tri_mesh *mesh)
{
    struct par_partition partition;
    const struct tri_quality none = tri_quality_defaults();
    assert_int_equal(par_partition_make(&partition, mesh, &none, mesh->n_triangles, 50, NULL, NULL), TRI_OK);
    return partition;
}

/* After the vertices at which parents end. */
static enum tri_status number(struct tri_mesh *mesh, const struct par_partition *partition)
{
    return par_number(mesh, partition, mesh->incidence.n_vertices, NULL, NULL);
}

/* Blocks of this numbering's own. */
static void number_and_judge(struct tri_mesh *mesh)
{
    struct par_partition partition = partition_of(mesh);
    assert_int_equal(number(mesh, &partition), TRI_OK);
    assert_in_order(mesh, &partition, mesh->incidence.n_vertices);
    par_partition_free(&partition);
}

static void assert_is_whole(const struct tri_mesh *mesh)
{
    struct tri_error error = {0};
    if (tri_mesh_validate(mesh, &error) != TRI_OK)
        fail_msg("%s", error.text);
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        const int32_t *v = mesh->tri[t].v;
        assert_int_equal(mesh->tri[t].region, mesh->xy[v[0]].x + mesh->xy[v[1]].x + mesh->xy[v[2]].x > 1);
    }
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        assert_true(support_has_its_attributes(mesh, v));
}

static void test_any_permutation_gives_the_same_numbering(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 12; seed += (uint64_t)every(5)) {
        struct support_random random = {seed};
        struct tri_mesh mesh = refined(seed, seed < 2 ? 1e-4 : 1e-3);
        struct support_places places = support_places(&mesh), after;
        int32_t n_kept = seed % 3 ? mesh.incidence.n_vertices : mesh.n_vertices / 2;
        struct tri_mesh other = scrambled(&mesh, n_kept, &random);
        assert_true(mesh.n_vertices > mesh.incidence.n_vertices && mesh.incidence.n_vertices > mesh.n_input);
        struct par_partition partition = partition_of(&mesh);
        assert_true(par_blocks(&partition) > 25);
        assert_int_equal(par_number(&mesh, &partition, n_kept, seed % 2 ? &support_backwards : NULL, NULL), TRI_OK);
        assert_int_equal(par_number(&other, &partition, n_kept, seed % 2 ? NULL : &support_backwards, NULL), TRI_OK);
        support_assert_same_bytes(&mesh, &other);
        assert_in_order(&mesh, &partition, n_kept);
        assert_is_whole(&mesh);
        after = support_places(&mesh);
        assert_true(support_same_places(&places, &after));
        assert_int_equal(par_number(&mesh, &partition, n_kept, NULL, NULL), TRI_OK); /* nothing to do */
        support_assert_same_bytes(&mesh, &other);
        par_partition_free(&partition);
        support_places_free(&places);
        support_places_free(&after);
        tri_mesh_free(&mesh);
        tri_mesh_free(&other);
    }
}

/* Refinement may continue after numbering. A mesh to which nothing was added can also be numbered. */
static void test_numbering_works_before_and_after_refinement(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_square(1, 200, 3);
    struct tri_options options = support_quality(25, 1e-3);
    struct tri_check_options check = {.min_angle = 25, .max_area = 1e-3, .delaunay = TRI_CHECK_CONSTRAINED};
    struct tri_refine_report report;
    options.refine = false;
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    number_and_judge(&mesh);
    assert_int_equal(mesh.n_vertices, 204);
    for (int round = 0; round < 2; round++) {
        assert_int_equal(tri_refine(&mesh, &options.quality, &report, NULL), TRI_OK);
        number_and_judge(&mesh);
        support_judge(&mesh, &pslg, &check, false, NULL);
        options.quality.max_area = check.max_area = 3e-4;
    }
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* A vertex shared by thousands of triangles: sorting takes linear time and is correct. */
static void test_large_fan_is_sorted_in_linear_time(void **state)
{
    (void)state;
    enum { N = 20000 };
    struct tri_pslg pslg = support_pslg(N + 1, N, 0, 0);
    struct tri_options options = support_quality(0, 0);
    options.refine = false;
    for (int i = 0; i < N; i++)
        support_add_point(&pslg, cos(i * (2 * acos(-1) / N)), sin(i * (2 * acos(-1) / N)));
    for (int i = 0; i < N; i++)
        support_add_segment(&pslg, i, (i + 1) % N);
    support_add_point(&pslg, 0, 0);
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    number_and_judge(&mesh);
    assert_int_equal(mesh.tri[mesh.n_triangles / 2].v[0], N);
    assert_int_equal(tri_mesh_validate(&mesh, NULL), TRI_OK);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

static void test_without_memory_nothing_changes(void **state)
{
    (void)state;
    struct support_random random = {9};
    struct tri_mesh mesh = refined(9, 1e-3), other = scrambled(&mesh, mesh.incidence.n_vertices, &random);
    struct par_partition partition = partition_of(&mesh);
    assert_int_equal(number(&mesh, &partition), TRI_OK);
    long long held = support_held;
    for (int call = 1;; call++) {
        struct support_places before = support_places(&other);
        support_calls = 0;
        support_fail_at = call;
        enum tri_status status = number(&other, &partition);
        support_fail_at = INT64_MAX;
        struct support_places after = support_places(&other);
        assert_true(support_same_places(&before, &after));
        support_places_free(&before);
        support_places_free(&after);
        assert_int_equal(support_held, held);
        if (!status) {
            assert_true(call > 1);
            break;
        }
        assert_int_equal(status, TRI_NO_MEMORY);
        assert_int_equal(tri_mesh_validate(&other, NULL), TRI_OK);
    }
    support_assert_same_bytes(&mesh, &other);
    par_partition_free(&partition);
    tri_mesh_free(&mesh);
    tri_mesh_free(&other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_any_permutation_gives_the_same_numbering),
        cmocka_unit_test(test_numbering_works_before_and_after_refinement),
        cmocka_unit_test(test_large_fan_is_sorted_in_linear_time),
        cmocka_unit_test(test_without_memory_nothing_changes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
