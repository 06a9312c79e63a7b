/* Meshes made from their triangles: round trips, faults, surfaces that are not planar meshes, flips, regions.
   This program is linked with --wrap for malloc, calloc, realloc and free: see allocations.h. */
#include <stdio.h>

#include "allocations.h"
#include "full.h"
#include "support.h"
#include "triangle/refine/census.h"
#include "triangle/cdt/crossing.h"
#include "triangle/cdt/reconstruct.h"
#include "triangle/mesh/topology.h"

enum { MOST = 64 };

/* A mesh as input: the points, segments and triangles that its .node, .poly and .ele files would contain. */
struct input {
    struct tri_pslg pslg;
    struct tri_elements elements;
};

static void free_input(struct input *input)
{
    tri_pslg_free(&input->pslg);
    tri_elements_free(&input->elements);
}

static struct input input_of(const struct tri_mesh *mesh)
{
    struct input in = {.pslg = support_pslg(mesh->n_vertices, mesh->n_subs + 8, 0, 0)};
    in.elements = (struct tri_elements){.n = mesh->n_triangles, .n_nodes = 3};
    in.elements.corners = malloc(((size_t)mesh->n_triangles + 1) * 3 * sizeof *in.elements.corners);
    in.pslg.markers = malloc(((size_t)mesh->n_vertices + 1) * sizeof *in.pslg.markers);
    in.pslg.segment_markers = calloc((size_t)mesh->n_subs + 8, sizeof *in.pslg.segment_markers);
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        double at[2];
        tri_mesh_place(mesh, v, at);
        support_add_point(&in.pslg, at[0], at[1]);
        in.pslg.markers[v] = mesh->vertex_markers[v];
    }
    for (int32_t s = 0; s < mesh->n_subs; s++) {
        support_add_segment(&in.pslg, mesh->sub[s].v[0], mesh->sub[s].v[1]);
        in.pslg.segment_markers[s] = mesh->sub[s].marker;
    }
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        memcpy(&in.elements.corners[3 * t], mesh->tri[t].v, sizeof mesh->tri[t].v);
    return in;
}

/* A fan of n - 1 triangles around point 0 at the origin. The other n points lie on a half circle, or nearly so. */
static struct input fan(int32_t n, double height)
{
    struct input in = {.pslg = support_pslg(n + 1, 8, 0, 0), .elements = {.n = n - 1, .n_nodes = 3}};
    in.elements.corners = malloc((size_t)n * 3 * sizeof *in.elements.corners);
    support_add_point(&in.pslg, 0, 0);
    for (int32_t i = 0; i < n; i++) {
        double x = 1 - 2.0 * i / (n - 1);
        support_add_point(&in.pslg, x, 1 + height * (1 - x * x));
    }
    for (int32_t t = 0; t < n - 1; t++)
        memcpy(&in.elements.corners[3 * t], (int32_t[]){0, t + 1, t + 2}, 3 * sizeof(int32_t));
    return in;
}

static struct tri_mesh rebuild(const struct input *in, const struct tri_reconstruct_options *options)
{
    struct tri_mesh mesh;
    struct tri_error error = {0};
    if (tri_reconstruct(&mesh, &in->pslg, &in->elements, options, &error) != TRI_OK ||
        tri_mesh_validate(&mesh, &error) != TRI_OK)
        fail_msg("%s", error.text);
    return mesh;
}

static void add_steiner(struct tri_mesh *mesh, double min_angle, double max_area)
{
    struct tri_quality options = tri_quality_defaults();
    struct tri_refine_report report;
    struct tri_error error = {0};
    options.min_angle = min_angle;
    options.max_area = max_area;
    options.region_areas = true;
    if (tri_refine(mesh, &options, &report, &error) != TRI_OK)
        fail_msg("%s", error.text);
    tri_mesh_compact(mesh);
}

/* Delaunay at every edge that is not a subsegment. Ties may be broken in any way. */
static void assert_delaunay(const struct tri_mesh *mesh)
{
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        for (int e = 0; tri_is_live(&mesh->tri[t]) && e < 3; e++) {
            const struct tri_triangle *at = &mesh->tri[t];
            if (at->n[e] < 0)
                continue;
            int32_t apex = mesh->tri[tri_of(at->n[e])].v[tri_edge(at->n[e])];
            assert_true(tri_incircle(mesh->xy[at->v[0]], mesh->xy[at->v[1]], mesh->xy[at->v[2]], mesh->xy[apex]) <= 0);
        }
}

/* --- round trips */

/* Makes each subsegment its own parent, or lets the subsegments of a split segment share a parent again. */
static void assert_parents(const struct tri_mesh *mesh, const struct tri_mesh *back, bool united)
{
    int32_t *parent = malloc((size_t)mesh->n_parents * sizeof *parent + 1);
    assert_non_null(parent);
    memset(parent, 0xff, (size_t)mesh->n_parents * sizeof *parent); /* TRI_NONE */
    for (int32_t s = 0; s < mesh->n_subs; s++) {
        const struct tri_parent *now = &back->parents[back->sub[s].parent];
        int32_t *first = &parent[mesh->sub[s].parent];
        *first = *first == TRI_NONE ? back->sub[s].parent : *first;
        assert_int_equal(back->sub[s].parent, united ? *first : s);
        assert_memory_equal(&now->guard, &back->xy[now->v[0]], sizeof(struct tri_point));
        for (int k = 0; k < 2; k++)
            assert_true(mesh->on[mesh->sub[s].v[k]] < 0 || !united || back->on[mesh->sub[s].v[k]] == *first);
    }
    assert_true(united ? back->n_parents <= mesh->n_parents : back->n_parents == mesh->n_subs);
    free(parent);
}

static void assert_same_mesh(const struct tri_mesh *mesh, const struct tri_mesh *back)
{
    assert_int_equal(back->n_triangles, mesh->n_triangles);
    assert_int_equal(back->n_subs, mesh->n_subs);
    assert_int_equal(back->n_vertices, mesh->n_vertices);
    assert_int_equal(back->n_input, mesh->n_vertices);
    assert_memory_equal(back->xy, mesh->xy, (size_t)mesh->n_vertices * sizeof *mesh->xy);
    assert_memory_equal(back->vertex_markers, mesh->vertex_markers, (size_t)mesh->n_vertices * sizeof(int32_t));
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        assert_memory_equal(back->tri[t].v, mesh->tri[t].v, sizeof mesh->tri[t].v);
        assert_memory_equal(back->tri[t].n, mesh->tri[t].n, sizeof mesh->tri[t].n);
        assert_int_equal(back->tri[t].region, 0);
    }
    for (int32_t s = 0; s < mesh->n_subs; s++) {
        int turned = back->sub[s].v[0] != mesh->sub[s].v[0]; /* subsegments get the direction of their parent */
        for (int k = 0; k < 2; k++) {
            assert_int_equal(back->sub[s].v[k], mesh->sub[s].v[k ^ turned]);
            assert_int_equal(back->sub[s].side[k], mesh->sub[s].side[k ^ turned]);
        }
        assert_int_equal(back->sub[s].marker, mesh->sub[s].marker);
    }
}

/* A mesh that is refined already is restored unchanged, whether or not refinement is requested. Further refinement is
   checked. */
static void round_trip(const struct tri_pslg *pslg, double angle, double area)
{
    struct tri_options options = support_quality(angle, area);
    struct tri_report report;
    struct tri_mesh mesh = support_generate(pslg, &options, &report);
    struct input in = input_of(&mesh);
    for (int refine = 0; refine < 2; refine++) {
        struct tri_mesh back = rebuild(&in, &(struct tri_reconstruct_options){.use_segments = true, .refine = refine});
        assert_same_mesh(&mesh, &back);
        assert_parents(&mesh, &back, refine);
        if (refine) {
            struct tri_check_options check = {.max_area = area / 4, .max_bad = INT64_MAX, .ignore_lost = true};
            add_steiner(&back, angle, area / 4);
            support_judge(&back, &in.pslg, &check, false, NULL);
            assert_true(back.n_triangles > mesh.n_triangles);
        }
        tri_mesh_free(&back);
    }
    free_input(&in);
    tri_mesh_free(&mesh);
}

static void meshes_are_restored_from_their_triangles(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double area;
    } files[] = {{"letter.poly", 0.1}, {"box_hole.poly", 0.05}, {"section.poly", 0.5}, {"cracked_plate.poly", 0.01},
                 {"koch_lake.poly", 0.001}, {"base0.poly", 0.01}};
    for (size_t i = 0; i < sizeof files / sizeof *files; i += (size_t)every(3)) {
        struct tri_pslg pslg;
        assert_true(support_read(files[i].name, &pslg));
        round_trip(&pslg, 20, files[i].area);
        tri_pslg_free(&pslg);
    }
    for (uint64_t seed = 1; seed <= 8; seed += (uint64_t)every(5)) {
        struct tri_pslg pslg = support_tangle(seed % 2 ? SUPPORT_RANDOM : SUPPORT_LATTICE, 60, 12, seed);
        round_trip(&pslg, 0, 0.01);
        tri_pslg_free(&pslg);
    }
}

/* Without segments, only the boundary consists of subsegments, in the order of the triangles and with marker 1. */
static void boundary_becomes_subsegments(void **state)
{
    (void)state;
    struct tri_pslg pslg;
    struct tri_report report;
    assert_true(support_read("section.poly", &pslg));
    struct tri_options options = support_quality(20, 0);
    struct tri_mesh mesh = support_generate(&pslg, &options, &report);
    struct input in = input_of(&mesh);
    memset(in.pslg.markers, 0, (size_t)in.pslg.n_points * sizeof *in.pslg.markers);
    struct tri_mesh back = rebuild(&in, &(struct tri_reconstruct_options){.use_segments = false});
    int32_t before = -1, n_boundary = 0;
    for (int32_t s = 0; s < mesh.n_subs; s++)
        n_boundary += mesh.sub[s].side[0] == TRI_NONE || mesh.sub[s].side[1] == TRI_NONE;
    assert_true(n_boundary < mesh.n_subs);
    assert_int_equal(back.n_subs, n_boundary);
    for (int32_t s = 0; s < back.n_subs; s++) {
        assert_true(back.sub[s].side[0] > before && back.sub[s].side[1] == TRI_NONE && back.sub[s].marker == 1);
        assert_int_equal(back.parents[s].segment, TRI_NONE);
        assert_int_equal(back.vertex_markers[back.sub[s].v[0]], 1);
        before = back.sub[s].side[0];
    }
    tri_mesh_free(&back);
    tri_mesh_free(&mesh);
    free_input(&in);
    tri_pslg_free(&pslg);
}

/* --- a square in four triangles around its middle, point 4; point 5 is unused */

static const int32_t square_corners[12] = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};

static struct input square(void)
{
    struct input in = {.pslg = support_square(2, 0, 1), .elements = {.n = 4, .n_nodes = 3}};
    tri_pslg_free(&in.pslg);
    in.pslg = support_pslg(6, 8, 0, 0);
    static const double at[6][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 1}, {9, 9}};
    for (int i = 0; i < 6; i++)
        support_add_point(&in.pslg, at[i][0], at[i][1]);
    in.elements.corners = malloc((MOST + 4) * 3 * sizeof(int32_t));
    memcpy(in.elements.corners, square_corners, sizeof square_corners);
    in.pslg.segment_markers = calloc(8, sizeof *in.pslg.segment_markers);
    return in;
}

static void segment(struct input *in, int32_t a, int32_t b, int32_t marker)
{
    support_add_segment(&in->pslg, a, b);
    in->pslg.segment_markers[in->pslg.n_segments - 1] = marker;
}

static int32_t marker_of(const struct tri_mesh *mesh, int32_t a, int32_t b)
{
    for (int32_t s = 0; s < mesh->n_subs; s++)
        if ((mesh->sub[s].v[0] == a && mesh->sub[s].v[1] == b) || (mesh->sub[s].v[0] == b && mesh->sub[s].v[1] == a))
            return mesh->sub[s].marker;
    fail_msg("%d %d is no subsegment", (int)a, (int)b);
    return 0;
}

static void segments_that_are_edges(void **state)
{
    (void)state;
    struct input in = square();
    segment(&in, 0, 2, 5); /* crosses the middle */
    segment(&in, 4, 0, 0);
    segment(&in, 0, 4, -7);
    segment(&in, 4, 0, 8);
    segment(&in, 1, 0, 6);
    segment(&in, 3, 3, 1);
    segment(&in, 2, 5, 1);
    segment(&in, 99, 0, 1);
    in.pslg.markers = (int32_t *)calloc(6, sizeof(int32_t));
    in.pslg.markers[1] = 3;
    bool is_edge[8];
    int32_t loose;
    struct tri_reconstruct_options both = {.use_segments = true, .is_edge = is_edge, .loose = &loose};
    struct tri_mesh mesh = rebuild(&in, &both);
    static const bool expected[8] = {false, true, true, true, true, true, false, true}; /* 5, 7: possibly no edge */
    assert_memory_equal(is_edge, expected, sizeof expected);
    assert_int_equal(loose, 2);
    assert_int_equal(mesh.n_subs, 5);
    assert_int_equal(mesh.n_parents, 5);
    assert_memory_equal(mesh.sub[0].v, ((int32_t[]){4, 0}), sizeof mesh.sub[0].v);
    assert_memory_equal(mesh.sub[1].v, ((int32_t[]){1, 0}), sizeof mesh.sub[1].v);
    assert_int_equal(mesh.parents[0].segment, 1);
    assert_int_equal(mesh.parents[1].segment, 4);
    assert_int_equal(marker_of(&mesh, 0, 4), -7);
    assert_int_equal(marker_of(&mesh, 0, 1), 6);
    assert_int_equal(marker_of(&mesh, 1, 2), 1);
    static const int32_t markers[6] = {-7, 3, 1, 1, -7, 0};
    assert_memory_equal(mesh.vertex_markers, markers, sizeof markers);
    tri_mesh_free(&mesh);
    both.use_segments = false;
    mesh = rebuild(&in, &both);
    assert_int_equal(mesh.n_subs, 4);
    assert_int_equal(loose, 0);
    for (int k = 0; k < 8; k++)
        assert_false(is_edge[k]);
    tri_mesh_free(&mesh);
    free_input(&in);
}

static void clockwise_triangles_are_turned(void **state)
{
    (void)state;
    struct input in = square();
    memcpy(&in.elements.corners[3], (int32_t[]){1, 4, 2}, 3 * sizeof(int32_t));
    memcpy(&in.elements.corners[9], (int32_t[]){4, 0, 3}, 3 * sizeof(int32_t));
    struct tri_mesh mesh = rebuild(&in, &(struct tri_reconstruct_options){.use_segments = true});
    assert_int_equal(mesh.n_subs, 4);
    assert_memory_equal(mesh.tri[0].v, square_corners, sizeof mesh.tri[0].v);
    assert_memory_equal(mesh.tri[1].v, ((int32_t[]){1, 2, 4}), sizeof mesh.tri[1].v);
    assert_memory_equal(mesh.tri[3].v, ((int32_t[]){4, 3, 0}), sizeof mesh.tri[3].v);
    support_judge(&mesh, NULL, &(struct tri_check_options){.max_bad = INT64_MAX, .ignore_lost = true}, false, NULL);
    tri_mesh_free(&mesh);
    free_input(&in);
}

/* Nodes after the third that are not corners are removed. Other unused vertices are kept. */
static void unused_vertices_are_kept(void **state)
{
    (void)state;
    struct input in = square();
    struct tri_error error = {0};
    in.elements.n = 2; /* 0 1 4 and 1 2 4: vertices 3 and 5 are unused */
    in.elements.n_nodes = 5;
    in.elements.extra = malloc(4 * sizeof(int32_t));
    memcpy(in.elements.extra, (int32_t[]){2, 3, TRI_NONE, 77}, 4 * sizeof(int32_t));
    struct tri_mesh mesh = rebuild(&in, &(struct tri_reconstruct_options){.refine = true});
    add_steiner(&mesh, 0, 0.3);
    assert_true(mesh.n_vertices > 6);
    struct tri_used kept;
    assert_int_equal(tri_kept_make(&kept, &mesh, &in.elements, false, &error), TRI_OK);
    assert_int_equal(kept.n, mesh.n_vertices - 1);
    for (int32_t v = 0; v < mesh.n_vertices; v++) {
        assert_int_equal(kept.number[v], v < 3 ? v : v == 3 ? TRI_NONE : v - 1);
        assert_true(v == 3 || kept.vertex[kept.number[v]] == v);
    }
    tri_used_free(&kept);
    assert_int_equal(tri_kept_make(&kept, &mesh, &in.elements, true, &error), TRI_OK); /* only corners are kept */
    assert_int_equal(kept.n, mesh.n_vertices - 2);
    tri_used_free(&kept);
    free(in.elements.extra);
    in.elements.extra = NULL;
    assert_int_equal(tri_kept_make(&kept, &mesh, &in.elements, false, &error), TRI_OK);
    assert_null(kept.number);
    tri_used_free(&kept);
    tri_mesh_free(&mesh);
    free_input(&in);
}

/* --- faults */

static void faults_name_the_triangle(void **state)
{
    (void)state;
    static const struct {
        int32_t base;
        int32_t corners[6]; /* corners of triangles 4 and 5, which follow those of the square */
        const char *text;
    } examples[] = {
        {0, {0, 0, 1, 0, 1, 3}, "triangle 4 has two equal corners"},
        {1, {0, 0, 1, 0, 1, 3}, "triangle 5 has two equal corners"},
        {0, {0, 4, 2, 0, 1, 3}, "triangle 4 has no area"},
        {0, {5, 0, 4, 0, 1, 3}, "triangle 4 has no area"},
        {0, {0, 1, 6, 0, 1, 3}, "triangle 4 has a corner that is no vertex"},
        {0, {0, 1, -1, 0, 1, 3}, "triangle 4 has a corner that is no vertex"},
        {0, {2, 1, 5, 3, 2, 4}, "triangle 5 has an edge that two other triangles have, too"},
        {0, {2, 1, 5, 0, 3, 5}, "triangle 5 lies on the same side of an edge as another triangle"},
        {1, {2, 1, 5, 1, 2, 3}, "triangle 6 has an edge that two other triangles have, too"},
        {0, {2, 1, 5, 1, 2, 5}, "triangle 5 has an edge that two other triangles have, too"},
    };
    for (size_t i = 0; i < sizeof examples / sizeof *examples; i++) {
        struct input in = square();
        struct tri_mesh mesh;
        struct tri_error error = {0};
        struct tri_reconstruct_options options = {.base = examples[i].base};
        in.elements.n = 6;
        memcpy(&in.elements.corners[12], examples[i].corners, sizeof examples[i].corners);
        assert_int_equal(tri_reconstruct(&mesh, &in.pslg, &in.elements, &options, &error), TRI_BAD_INPUT);
        assert_string_equal(error.text, examples[i].text);
        assert_int_equal(mesh.n_triangles, 0);
        assert_null(mesh.xy);
        tri_mesh_free(&mesh);
        free_input(&in);
    }
}

static void inputs_without_triangles_are_handled(void **state)
{
    (void)state;
    struct input in = square();
    struct tri_mesh mesh;
    struct tri_error error = {0};
    in.elements.n = 0;
    mesh = rebuild(&in, &(struct tri_reconstruct_options){.use_segments = true, .refine = true});
    assert_int_equal(mesh.n_triangles, 0);
    assert_int_equal(mesh.n_subs, 0);
    add_steiner(&mesh, 20, 1);
    assert_int_equal(mesh.n_vertices, 6);
    tri_mesh_free(&mesh);
    in.elements.n = -1;
    struct tri_reconstruct_options options = {0};
    assert_int_equal(tri_reconstruct(&mesh, &in.pslg, &in.elements, &options, &error), TRI_BAD_INPUT);
    free(in.elements.corners);
    in.elements.corners = NULL;
    in.elements.n = 1;
    assert_int_equal(tri_reconstruct(&mesh, &in.pslg, &in.elements, &options, &error), TRI_BAD_INPUT);
    free_input(&in);
}

/* --- arbitrary triangles */

static struct tri_pslg few_points(struct support_random *random, int32_t n)
{
    struct tri_pslg pslg = support_pslg(n, 8, 0, 0);
    bool lattice = support_below(random, 2);
    for (int32_t i = 0; i < n; i++) {
        double x = lattice ? support_below(random, 4) : support_unit(random);
        support_add_point(&pslg, x, lattice ? support_below(random, 4) : support_unit(random));
    }
    for (int32_t k = 0; k < 8; k++)
        support_add_segment(&pslg, support_below(random, n), support_below(random, n));
    return pslg;
}

/* Triangles of any kind. To pass the first check, each must match the triangles before it. */
static void grow(struct input *in, struct support_random *random, int32_t wanted, double wild)
{
    struct tri_elements *elements = &in->elements;
    struct tri_reconstruct_options options = {0};
    for (int32_t tries = 0; tries < 20 * wanted && elements->n < wanted; tries++) {
        struct tri_mesh mesh;
        int32_t *v = &elements->corners[3 * (size_t)elements->n++];
        for (int k = 0; k < 3; k++)
            v[k] = support_below(random, in->pslg.n_points);
        if (support_unit(random) < wild)
            continue;
        if (tri_reconstruct(&mesh, &in->pslg, elements, &options, NULL) != TRI_OK)
            elements->n--;
        tri_mesh_free(&mesh);
    }
}

static void add_values(struct tri_elements *elements, struct support_random *random)
{
    int32_t columns = support_below(random, 4);
    elements->n_attributes = columns;
    elements->attributes = columns ? calloc((size_t)(elements->n * columns) + 1, sizeof(double)) : NULL;
    for (int32_t i = 0; i < elements->n * columns; i++)
        elements->attributes[i] = support_below(random, 2);
    elements->areas = support_below(random, 2) ? calloc((size_t)elements->n + 1, sizeof(double)) : NULL;
    for (int32_t t = 0; elements->areas && t < elements->n; t++)
        elements->areas[t] = support_below(random, 3) - 1 ? support_unit(random) : 0;
}

static void assert_counter_clockwise(const struct tri_mesh *mesh)
{
    struct tri_error error = {0};
    if (tri_mesh_validate(mesh, &error) != TRI_OK)
        fail_msg("%s", error.text);
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        const int32_t *v = mesh->tri[t].v;
        assert_true(mesh->tri[t].region >= 0 && mesh->tri[t].region < mesh->n_regions);
        assert_true(!tri_is_live(&mesh->tri[t]) || tri_orient2d(mesh->xy[v[0]], mesh->xy[v[1]], mesh->xy[v[2]]) > 0);
    }
}

/* Surfaces that overlap, wind several times around a vertex, or are connected only at corners are refined like any
   other, as far as possible. Triangles that form no surface are refused. */
static bool treat_garbage(struct support_random *random, double wild)
{
    struct input in = {.pslg = few_points(random, 4 + support_below(random, 12)), .elements = {.n_nodes = 3}};
    in.elements.corners = malloc(MOST * 3 * sizeof(int32_t));
    grow(&in, random, 1 + support_below(random, 24), wild);
    add_values(&in.elements, random);
    struct tri_reconstruct_options options = {.use_segments = support_below(random, 2), .refine = true};
    struct tri_error error = {0};
    struct tri_mesh mesh;
    enum tri_status status = tri_reconstruct(&mesh, &in.pslg, &in.elements, &options, &error);
    if (status) {
        assert_int_equal(status, TRI_BAD_INPUT);
        assert_non_null(strstr(error.text, "triangle "));
    } else {
        struct tri_quality quality = tri_quality_defaults();
        struct tri_refine_report report;
        quality.min_angle = 33 * support_unit(random);
        quality.max_area = 0.2 * support_unit(random);
        quality.region_areas = true;
        quality.conforming = support_below(random, 2);
        quality.protect = support_below(random, 3);
        quality.max_steiner = 300;
        assert_counter_clockwise(&mesh);
        assert_int_equal(tri_refine(&mesh, &quality, &report, &error), TRI_OK);
        assert_counter_clockwise(&mesh);
        assert_delaunay(&mesh);
    }
    tri_mesh_free(&mesh);
    free_input(&in);
    return status == TRI_OK;
}

static void arbitrary_triangles_are_refined_or_refused(void **state)
{
    (void)state;
    struct support_random random = {17};
    int32_t good = 0, runs = 1500 / every(5);
    for (int32_t i = 0; i < runs; i++)
        good += treat_garbage(&random, i % 4 == 0 ? 0.2 : 0);
    assert_true(good > runs / 2 && good < runs);
}

/* A sheet that winds twice around the origin: eight sectors over sixteen points, two at each place of the border. */
static void a_sheet_that_winds_twice_is_refined(void **state)
{
    (void)state;
    static const double at[8][2] = {{2, 0}, {1, 1}, {0, 2}, {-1, 1}, {-2, 0}, {-1, -1}, {0, -2}, {1, -1}};
    struct input in = {.pslg = support_pslg(17, 1, 0, 0), .elements = {.n = 16, .n_nodes = 3}};
    in.elements.corners = malloc(MOST * 3 * sizeof(int32_t));
    support_add_point(&in.pslg, 0, 0);
    for (int32_t i = 0; i < 16; i++) {
        support_add_point(&in.pslg, at[i % 8][0], at[i % 8][1]);
        memcpy(&in.elements.corners[3 * i], (int32_t[]){0, 1 + i, 1 + (i + 1) % 16}, 3 * sizeof(int32_t));
    }
    struct tri_mesh mesh = rebuild(&in, &(struct tri_reconstruct_options){.refine = true});
    assert_int_equal(mesh.n_subs, 16);
    add_steiner(&mesh, 30, 0.01);
    assert_counter_clockwise(&mesh);
    assert_delaunay(&mesh);
    double area = 0;
    for (int32_t t = 0; t < mesh.n_triangles; t++) {
        struct tri_point a = mesh.xy[mesh.tri[t].v[0]], b = mesh.xy[mesh.tri[t].v[1]], c = mesh.xy[mesh.tri[t].v[2]];
        area += 0.5 * ((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y));
    }
    assert_true(fabs(area - 16) < 1e-9);
    tri_mesh_free(&mesh);
    free_input(&in);
}

/* --- flips */

static void triangles_are_flipped_before_refinement(void **state)
{
    (void)state;
    struct input in = fan(200, 0.75);
    struct tri_mesh mesh = rebuild(&in, &(struct tri_reconstruct_options){.refine = false});
    for (int32_t t = 0; t < mesh.n_triangles; t++)
        assert_memory_equal(mesh.tri[t].v, &in.elements.corners[3 * t], sizeof mesh.tri[t].v);
    tri_mesh_free(&mesh);
    mesh = rebuild(&in, &(struct tri_reconstruct_options){.refine = true});
    assert_delaunay(&mesh);
    struct support_set after = support_triangles(&mesh), before = {in.elements.n, calloc(200, sizeof *before.v)};
    memcpy(before.v, in.elements.corners, (size_t)in.elements.n * sizeof *before.v);
    support_sort(&before);
    assert_false(support_same(&before, &after));
    support_set_free(&before);
    support_set_free(&after);
    add_steiner(&mesh, 25, 0.01);
    struct tri_check_options check = {.min_angle = 25, .max_area = 0.01, .max_bad = 20};
    support_judge(&mesh, NULL, &check, false, NULL);
    tri_mesh_free(&mesh);
    free_input(&in);
}

/* Both diagonals of each grid cell are Delaunay, so none is flipped. */
static void ties_stay(void **state)
{
    (void)state;
    enum { N = 9 };
    struct support_random random = {3};
    struct input in = {.pslg = support_pslg(N * N, 1, 0, 0), .elements = {.n_nodes = 3}};
    in.elements.corners = malloc(N * N * 6 * sizeof *in.elements.corners);
    for (int32_t i = 0; i < N * N; i++)
        support_add_point(&in.pslg, i % N, i / N);
    for (int32_t i = 0; i < N * N - N; i++) {
        int32_t right = i + 1, up = i + N, far = i + N + 1;
        int32_t rising[6] = {i, right, far, i, far, up}, falling[6] = {i, right, up, right, far, up};
        if (i % N == N - 1)
            continue;
        memcpy(&in.elements.corners[3 * in.elements.n], support_below(&random, 2) ? rising : falling, sizeof rising);
        in.elements.n += 2;
    }
    struct tri_mesh mesh = rebuild(&in, &(struct tri_reconstruct_options){.refine = true});
    for (int32_t t = 0; t < mesh.n_triangles; t++)
        assert_memory_equal(mesh.tri[t].v, &in.elements.corners[3 * t], sizeof mesh.tri[t].v);
    add_steiner(&mesh, 30, 0.1);
    assert_counter_clockwise(&mesh);
    assert_delaunay(&mesh);
    tri_mesh_free(&mesh);
    free_input(&in);
}

/* No step is quadratic in the degree of a vertex, even if every edge is a segment. */
static void vertex_of_high_degree(void **state)
{
    (void)state;
    enum { N = 200000 };
    struct input in = fan(N, 0.5);
    free(in.pslg.segments);
    in.pslg.segments = malloc(N * 2 * sizeof *in.pslg.segments);
    in.pslg.n_segments = N;
    for (int32_t k = 0; k < N; k++)
        memcpy(&in.pslg.segments[2 * k], (int32_t[]){0, k + 1}, 2 * sizeof(int32_t));
    struct tri_mesh mesh = rebuild(&in, &(struct tri_reconstruct_options){.use_segments = true, .refine = true});
    assert_int_equal(mesh.n_triangles, N - 1);
    assert_int_equal(mesh.n_subs, N + N - 1);
    tri_mesh_free(&mesh);
    free_input(&in);
}

/* --- attributes and areas */

static void values_become_regions(void **state)
{
    (void)state;
    struct input in = square();
    double attributes[12] = {1, 2, 3, 1, 2, 4, 1, 2, 3, 0, 0, 0}, areas[4] = {-1, 0, 7, 0};
    in.elements.n_attributes = 3;
    in.elements.attributes = malloc(sizeof attributes);
    memcpy(in.elements.attributes, attributes, sizeof attributes);
    struct tri_mesh mesh = rebuild(&in, &(struct tri_reconstruct_options){0});
    assert_int_equal(mesh.n_columns, 3);
    assert_int_equal(mesh.n_regions, 3);
    static const int32_t regions[4] = {1, 2, 1, 0};
    for (int32_t t = 0; t < 4; t++) {
        assert_int_equal(mesh.tri[t].region, regions[t]);
        assert_memory_equal(tri_region_attributes(&mesh, regions[t]), &attributes[3 * t], 3 * sizeof *attributes);
    }
    tri_mesh_free(&mesh);
    in.elements.areas = malloc(sizeof areas);
    memcpy(in.elements.areas, areas, sizeof areas);
    mesh = rebuild(&in, &(struct tri_reconstruct_options){0});
    assert_int_equal(mesh.n_regions, 4);
    for (int32_t t = 0; t < 4; t++) {
        assert_int_equal(mesh.tri[t].region, t == 3 ? 0 : t + 1);
        assert_true(mesh.regions[mesh.tri[t].region].max_area == (t == 2 ? 7 : 0));
        assert_memory_equal(tri_region_attributes(&mesh, mesh.tri[t].region), &attributes[3 * t], 3 * sizeof(double));
    }
    tri_mesh_free(&mesh);
    free_input(&in);
}

/* The input triangle that contains the centre of t. */
static int32_t original_of(const struct tri_mesh *old, const struct tri_mesh *mesh, int32_t t)
{
    const int32_t *v = mesh->tri[t].v;
    struct tri_point a = mesh->xy[v[0]], b = mesh->xy[v[1]], c = mesh->xy[v[2]];
    struct tri_point q = {(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3};
    for (int32_t o = 0; o < old->n_triangles; o++) {
        const int32_t *w = old->tri[o].v;
        if (tri_orient2d(old->xy[w[0]], old->xy[w[1]], q) >= 0 && tri_orient2d(old->xy[w[1]], old->xy[w[2]], q) >= 0 &&
            tri_orient2d(old->xy[w[2]], old->xy[w[0]], q) >= 0)
            return o;
    }
    fail_msg("triangle %d lies nowhere", (int)t);
    return 0;
}

/* Flips do not move values, regardless of how many flips follow at one place. */
static void values_stay_when_edges_are_flipped(void **state)
{
    (void)state;
    int32_t moved = 0;
    for (int32_t n = 5; n < 400; n = 2 * n + 1) {
        struct input in = fan(n, 0.75);
        in.elements.areas = malloc((size_t)in.elements.n * sizeof(double));
        for (int32_t t = 0; t < in.elements.n; t++)
            in.elements.areas[t] = t + 1;
        struct tri_mesh old = rebuild(&in, &(struct tri_reconstruct_options){0});
        struct tri_mesh mesh = rebuild(&in, &(struct tri_reconstruct_options){.refine = true});
        for (int32_t t = 0; t < mesh.n_triangles; t++) {
            const int32_t original = original_of(&old, &mesh, t);
            assert_true(mesh.regions[mesh.tri[t].region].max_area == original + 1);
            moved += original != t;
        }
        tri_mesh_free(&old);
        tri_mesh_free(&mesh);
        free_input(&in);
    }
    assert_true(moved > 0);
}

/* A sliver that already meets its bound does not limit the triangles beside it. */
static void bound_of_a_sliver_does_not_spread(void **state)
{
    (void)state;
    struct input in = {.pslg = support_pslg(4, 0, 0, 0), .elements = {.n = 2, .n_nodes = 3}};
    in.elements.corners = malloc(6 * sizeof *in.elements.corners);
    in.elements.areas = malloc(2 * sizeof *in.elements.areas);
    memcpy(in.elements.corners, (int32_t[]){0, 1, 2, 0, 3, 1}, 6 * sizeof *in.elements.corners);
    memcpy(in.elements.areas, (double[]){1e-10, -1}, 2 * sizeof *in.elements.areas);
    support_add_point(&in.pslg, 0, 0);
    support_add_point(&in.pslg, 1, 0);
    support_add_point(&in.pslg, 0.5, 1e-9);
    support_add_point(&in.pslg, 0.5, -1);
    struct tri_mesh mesh = rebuild(&in, &(struct tri_reconstruct_options){.refine = true});
    add_steiner(&mesh, 0, 0);
    assert_int_equal(mesh.n_triangles, 2);
    tri_mesh_free(&mesh);
    free_input(&in);
}

/* If segments separate them, the values at a place do not change. */
static void values_do_not_cross_segments(void **state)
{
    (void)state;
    struct tri_pslg pslg;
    struct tri_report report;
    assert_true(support_read("section.poly", &pslg));
    struct tri_options options = support_quality(20, 0);
    options.spread_regions = true;
    struct tri_mesh old = support_generate(&pslg, &options, &report);
    struct input in = input_of(&old);
    in.elements.n_attributes = 1;
    in.elements.attributes = malloc((size_t)old.n_triangles * sizeof(double));
    in.elements.areas = malloc((size_t)old.n_triangles * sizeof(double));
    for (int32_t t = 0; t < old.n_triangles; t++) {
        in.elements.attributes[t] = old.regions[old.tri[t].region].attribute;
        in.elements.areas[t] = in.elements.attributes[t] > 4 ? 0.5 : -1;
    }
    struct tri_mesh mesh = rebuild(&in, &(struct tri_reconstruct_options){.use_segments = true, .refine = true});
    assert_true(mesh.n_regions <= old.n_regions);
    add_steiner(&mesh, 25, 0);
    assert_true(mesh.n_triangles > old.n_triangles);
    for (int32_t t = 0; t < mesh.n_triangles; t++)
        assert_true(tri_region_attributes(&mesh, mesh.tri[t].region)[0] ==
                    in.elements.attributes[original_of(&old, &mesh, t)]);
    struct tri_check_options check = {.min_angle = 25, .max_bad = -1, .ignore_lost = true, .ignore_holes = true};
    support_judge(&mesh, &in.pslg, &check, true, NULL);
    tri_mesh_free(&mesh);
    tri_mesh_free(&old);
    free_input(&in);
    tri_pslg_free(&pslg);
}

/* If nothing separates them, each value comes from a nearby triangle and keeps its bound. */
static void values_come_from_a_nearby_triangle(void **state)
{
    (void)state;
    struct input in = square();
    in.elements.n_attributes = 2;
    in.elements.attributes = malloc(8 * sizeof(double));
    in.elements.areas = malloc(4 * sizeof(double));
    for (int32_t t = 0; t < 4; t++) {
        in.elements.attributes[2 * t] = t;
        in.elements.attributes[2 * t + 1] = 10 * t;
        in.elements.areas[t] = 0.01 * (t + 1);
    }
    struct tri_mesh mesh = rebuild(&in, &(struct tri_reconstruct_options){.refine = true});
    add_steiner(&mesh, 20, 0);
    double share[4] = {0};
    for (int32_t t = 0; t < mesh.n_triangles; t++) {
        const double *values = tri_region_attributes(&mesh, mesh.tri[t].region);
        int k = (int)values[0];
        assert_true(values[0] == k && values[1] == 10 * k);
        assert_true(mesh.regions[mesh.tri[t].region].max_area == 0.01 * (k + 1));
        share[k] += 0.5 * tri_orient2d(mesh.xy[mesh.tri[t].v[0]], mesh.xy[mesh.tri[t].v[1]], mesh.xy[mesh.tri[t].v[2]]);
    }
    for (int k = 0; k < 4; k++)
        assert_true(share[k] > 0.3 && share[k] < 1.7); /* about 1 each, apart from ragged borders */
    support_judge(&mesh, NULL, &(struct tri_check_options){.min_angle = 20, .ignore_lost = true}, true, NULL);
    tri_mesh_free(&mesh);
    free_input(&in);
}

/* --- memory */

static void fails_cleanly_without_memory(void **state)
{
    (void)state;
#ifndef SUPPORT_WRAP
    skip();
#endif
    struct input in = fan(40, 0.75);
    support_add_segment(&in.pslg, 0, 7);
    struct support_random random = {5};
    add_values(&in.elements, &random);
    struct tri_reconstruct_options options = {.use_segments = true, .refine = true};
    enum tri_status status = TRI_NO_MEMORY;
    int64_t k = 1, held = support_held;
    for (; status != TRI_OK; k++) {
        struct tri_mesh mesh;
        struct tri_error error = {0};
        support_calls = 0;
        support_fail_at = k;
        status = tri_reconstruct(&mesh, &in.pslg, &in.elements, &options, &error);
        support_fail_at = INT64_MAX;
        assert_true(status == TRI_OK || (status == TRI_NO_MEMORY && error.text[0] && !mesh.xy));
        tri_mesh_free(&mesh);
        assert_int_equal(support_held, held);
    }
    assert_true(k > 15);
    free_input(&in);
}

/* --- work in shares */

/* So many triangles that they are read and matched in several shares. Numbers are unrelated to positions. */
static struct input many_triangles(void)
{
    struct tri_pslg pslg = support_points(SUPPORT_RANDOM, 40000, 3);
    struct tri_mesh mesh = support_delaunay(&pslg, 0, NULL);
    struct input in = input_of(&mesh);
    assert_true(tri_shares(in.elements.n) >= 3);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
    return in;
}

/* With flips as well. */
static void shares_do_not_change_the_mesh(void **state)
{
    (void)state;
    struct input in = many_triangles();
    for (int32_t k = 0; k < 2; k++) {
        struct tri_reconstruct_options options = {.use_segments = true, .refine = k};
        struct tri_mesh one = rebuild(&in, &options);
        options.executor = &support_backwards;
        struct tri_mesh shares = rebuild(&in, &options);
        support_assert_same_bytes(&one, &shares);
        for (int32_t v = 0; v < one.n_vertices; v++)
            assert_true(one.feature[v] == shares.feature[v]);
        tri_mesh_free(&one);
        tri_mesh_free(&shares);
        for (int32_t v = 0; v < in.pslg.n_points; v += 500) /* no longer Delaunay, though still a triangulation */
            in.pslg.points[2 * v] += 1e-4;
    }
    free_input(&in);
}

/* The reported fault is that of the first triangle, for any order in which shares are processed. */
static void the_first_fault_is_reported_for_any_order_of_shares(void **state)
{
    (void)state;
    struct input in = many_triangles();
    struct tri_reconstruct_options options = {.executor = &support_backwards};
    struct tri_mesh mesh;
    struct tri_error error = {0};
    int32_t *corners = in.elements.corners, last = in.elements.n - 1;
    memcpy(&corners[3 * last], &corners[3 * 7], 3 * sizeof *corners);
    assert_int_equal(tri_reconstruct(&mesh, &in.pslg, &in.elements, &options, &error), TRI_BAD_INPUT);
    char text[64];
    snprintf(text, sizeof text, "triangle %d ", (int)last);
    assert_ptr_equal(strstr(error.text, text), error.text);
    corners[3 * (last - 1)] = corners[3 * 50000] = corners[3 * 40000] = -1;
    assert_int_equal(tri_reconstruct(&mesh, &in.pslg, &in.elements, &options, &error), TRI_BAD_INPUT);
    assert_string_equal(error.text, "triangle 40000 has a corner that is no vertex");
    free_input(&in);
}

/* The bound cannot be met, so the mesh has the angles of the default bound. Refining a mesh that meets its bound adds
   nothing. */
static void a_mesh_that_keeps_its_bound_is_not_refined_again(void **state)
{
    (void)state;
    struct tri_pslg pslg;
    assert_true(support_read("naca2412_box.poly", &pslg));
    struct tri_options usual = support_quality(TRI_USUAL_ANGLE, 0), above = support_quality(45, 0);
    struct tri_options kept = support_quality(36, 0);
    struct tri_mesh at_usual = support_generate(&pslg, &usual, NULL), at_above = support_generate(&pslg, &above, NULL);
    support_assert_same_bytes(&at_usual, &at_above);
    struct tri_mesh mesh = support_generate(&pslg, &kept, NULL);
    struct input in = input_of(&mesh);
    struct tri_mesh back = rebuild(&in, &(struct tri_reconstruct_options){.use_segments = true, .refine = true});
    struct tri_refine_report report;
    assert_int_equal(tri_refine(&back, &kept.quality, &report, NULL), TRI_OK);
    assert_int_equal(back.n_triangles, mesh.n_triangles);
    tri_mesh_free(&back);
    free_input(&in);
    tri_mesh_free(&mesh);
    tri_mesh_free(&at_above);
    tri_mesh_free(&at_usual);
    tri_pslg_free(&pslg);
}

/* Two arcs of many short sides, separated by a space too narrow to fill. At the corners the angle between two pieces
   exceeds rounding, while that between the sides does not. The surroundings of these pieces are cheap to refine. */
static void narrow_spaces_stay_unfilled(void **state)
{
    (void)state;
    enum { N = 34 };
    struct tri_pslg pslg = support_pslg(2 * N, 2 * N, 0, 0);
    for (int i = 0; i < 2 * N; i++) {
        double x = (i < N ? i : 2 * N - i) / (double)N;
        support_add_point(&pslg, x, (i < N ? -4e-9 : 4e-9) * x * (1 - x));
        support_add_segment(&pslg, i, (i + 1) % (2 * N));
    }
    struct tri_options options = support_quality(28, 0);
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    assert_in_range(mesh.n_triangles, 2 * N - 2, 2000);
    struct input in = input_of(&mesh);
    struct tri_mesh back = rebuild(&in, &(struct tri_reconstruct_options){.use_segments = true, .refine = true});
    assert_int_equal(back.n_parents, 2 * N);
    struct tri_refine_report report;
    assert_int_equal(tri_refine(&back, &options.quality, &report, NULL), TRI_OK);
    assert_in_range(back.n_triangles, mesh.n_triangles, 1.2 * mesh.n_triangles); /* without the rule: 45 times */
    tri_mesh_free(&back);
    free_input(&in);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* The maximum distance of the ends of subsegments from their parent's line, in resolutions of the parent's larger
   end. */
static double max_distance_from_parents(const struct tri_mesh *mesh)
{
    double most = 0;
    for (int32_t i = 0; i < 2 * mesh->n_subs; i++) {
        const struct tri_subsegment *s = &mesh->sub[i / 2];
        struct tri_point a = mesh->xy[mesh->parents[s->parent].v[0]], b = mesh->xy[mesh->parents[s->parent].v[1]];
        double off = tri_line_distance(a, b, mesh->xy[s->v[i % 2]]);
        most = fmax(most, off / fmax(tri_resolution(a), tri_resolution(b)));
    }
    return most;
}

/* Boundaries far higher than wide, read again. Vertices may leave the domain that was read only by units of the finer
   coordinate. Units of the larger coordinate would leave no position for a split. The chains of the first input
   follow their lines. The second has corners about five units inside, and still its pieces are recognised as chains. */
static void boundaries_that_are_read_can_be_split(void **state)
{
    (void)state;
    static const struct {
        const char *file;
        double angle, area, most; /* most: maximum distance from the line in resolutions */
    } cases[] = {{"regress/high_kite.poly", 37, 312819811.76, 0.1},
                 {"regress/bent_strip.poly", 0, 0, TRI_CHAIN_ASTRAY}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct tri_pslg pslg;
        struct tri_refine_report report;
        int64_t count[TRI_EXCUSES];
        assert_true(support_read(cases[i].file, &pslg));
        struct tri_options first = support_quality(cases[i].angle, cases[i].area), then = support_quality(20, 0);
        first.quality.conforming = then.quality.conforming = true;
        struct tri_mesh mesh = support_generate(&pslg, &first, NULL);
        struct input in = input_of(&mesh);
        struct tri_mesh back = rebuild(&in, &(struct tri_reconstruct_options){.use_segments = true, .refine = true});
        assert_int_equal(tri_refine(&back, &then.quality, &report, NULL), TRI_OK);
        tri_count_encroached(&back, &then.quality, &report, count);
        for (int k = 0; k < TRI_EXCUSES; k++)
            assert_int_equal(count[k], 0);
        assert_true(max_distance_from_parents(&back) <= cases[i].most);
        tri_mesh_free(&back);
        free_input(&in);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shares_do_not_change_the_mesh),
        cmocka_unit_test(boundaries_that_are_read_can_be_split),
        cmocka_unit_test(a_mesh_that_keeps_its_bound_is_not_refined_again),
        cmocka_unit_test(narrow_spaces_stay_unfilled),
        cmocka_unit_test(the_first_fault_is_reported_for_any_order_of_shares),
        cmocka_unit_test(meshes_are_restored_from_their_triangles),
        cmocka_unit_test(boundary_becomes_subsegments),
        cmocka_unit_test(segments_that_are_edges),
        cmocka_unit_test(clockwise_triangles_are_turned),
        cmocka_unit_test(unused_vertices_are_kept),
        cmocka_unit_test(faults_name_the_triangle),
        cmocka_unit_test(inputs_without_triangles_are_handled),
        cmocka_unit_test(arbitrary_triangles_are_refined_or_refused),
        cmocka_unit_test(a_sheet_that_winds_twice_is_refined),
        cmocka_unit_test(triangles_are_flipped_before_refinement),
        cmocka_unit_test(ties_stay),
        cmocka_unit_test(vertex_of_high_degree),
        cmocka_unit_test(values_become_regions),
        cmocka_unit_test(values_stay_when_edges_are_flipped),
        cmocka_unit_test(bound_of_a_sliver_does_not_spread),
        cmocka_unit_test(values_do_not_cross_segments),
        cmocka_unit_test(values_come_from_a_nearby_triangle),
        cmocka_unit_test(fails_cleanly_without_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
