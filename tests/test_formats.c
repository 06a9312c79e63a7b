/* Formats of other programs: bytes of small meshes, chains of the boundary, groups. tests/clients/run_formats.sh tests
 * what other programs read from them. */
#include "triangle/text/formats.h"

#include <errno.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "tests/array_grid.h"
#include "tests/msh_file.h"
#include "triangle/text/boundary.h"
#include "triangle/text/parts.h"

/* A square of 3 x 3 points without its upper right quarter, with two regions. Markers are 2 at the bottom, 0 on the
 * left, otherwise 1. Segment 6 is inside. */
static const double points[] = {0, 0, 1, 0, 2, 0, 0, 1, 1, 1, 2, 1, 0, 2, 1, 2};
static const double depths[] = {1, 2, 3, 4, 5, 6, 7, 8};
static const int32_t corners[] = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4, 3, 4, 7, 3, 7, 6};
static const int32_t across[] = {3, 1, -1, 4, -1, 0, -1, 3, -1, -1, 0, 2, -1, 5, 1, -1, -1, 4};
static const double regions[] = {7, 7, 3, 3, 0.5, 7};
static const int32_t segments[] = {0, 1, 1, 2, 2, 5, 5, 4, 4, 7, 7, 6, 1, 4, 6, 3, 3, 0};
static const int32_t segment_markers[] = {2, 2, 1, 1, 1, 1, 0, 0, 0};

static struct array_grid ell(void)
{
    return (struct array_grid){.points = points, .attributes = depths, .nodes = corners, .columns = regions,
                               .neighbors = across, .segments = segments, .segment_markers = segment_markers,
                               .grid = {.n_points = 8, .n_attributes = 1, .n_triangles = 6, .n_nodes = 3,
                                        .n_columns = 1, .n_segments = 9, .has_markers = true}};
}

/* Returns the bytes that a writer makes, allocated with malloc, followed by a 0. */
static char *bytes_of(tri_write_call *write, const struct tri_grid *grid, size_t *size)
{
    const char *name = "test_formats.out";
    struct tri_output_set set;
    struct tri_output *output;
    tri_outputs_begin(&set);
    assert_int_equal(tri_output_open(&set, name, &output, NULL), TRI_OK);
    assert_int_equal(write(output, grid, NULL, NULL), TRI_OK);
    assert_int_equal(tri_outputs_commit(&set, NULL), TRI_OK);
    FILE *file = fopen(name, "rb");
    char *bytes = malloc(1 << 16);
    assert_true(file && bytes);
    *size = fread(bytes, 1, (1 << 16) - 1, file);
    bytes[*size] = 0;
    fclose(file);
    unlink(name);
    return bytes;
}

static void assert_three_pieces(const struct tri_grid *grid)
{
    struct tri_boundary boundary;
    assert_int_equal(tri_boundary_make(&boundary, grid, NULL), TRI_OK);
    assert_int_equal(boundary.n_pieces, 3);
    static const int64_t nodes[] = {0, 1, 2, 2, 5, 4, 7, 6, 6, 3, 0};
    static const int64_t n[] = {3, 5, 3};
    static const int32_t markers[] = {2, 1, 0};
    assert_memory_equal(boundary.nodes, nodes, sizeof nodes);
    for (int p = 0; p < 3; p++) {
        assert_int_equal(boundary.pieces[p].n, n[p]);
        assert_int_equal(boundary.pieces[p].marker, markers[p]);
        assert_true(boundary.pieces[p].outer && !boundary.pieces[p].closed);
    }
    tri_boundary_free(&boundary);
}

static void test_boundary(void **state)
{
    (void)state;
    static const int32_t same[16];
    struct array_grid arrays = ell();
    struct tri_boundary boundary;
    assert_three_pieces(array_grid(&arrays)); /* the segments contain the boundary and one inner segment */
    arrays.segment_markers = same;            /* a single loop */
    assert_int_equal(tri_boundary_make(&boundary, array_grid(&arrays), NULL), TRI_OK);
    assert_int_equal(boundary.n_pieces, 1);
    assert_true(boundary.pieces[0].closed && boundary.pieces[0].n == 8);
    tri_boundary_free(&boundary);
}

static void test_groups(void **state)
{
    (void)state;
    struct array_grid arrays = ell();
    struct tri_grouping groups;
    assert_int_equal(tri_group(&groups, 6, tri_triangle_group, array_grid(&arrays), NULL), TRI_OK);
    static const int64_t order[] = {4, 2, 3, 0, 1, 5}, first[] = {0, 1, 3, 6};
    assert_int_equal(groups.n, 3);
    assert_true(groups.value[0] == 0.5 && groups.value[1] == 3 && groups.value[2] == 7);
    assert_memory_equal(groups.order, order, sizeof order);
    assert_memory_equal(groups.first, first, sizeof first);
    tri_grouping_free(&groups);
    assert_true(tri_group_tag(0.5) == 0 && tri_group_tag(0) == 0 && tri_group_tag(-3) == 0 && tri_group_tag(7) == 7);
    assert_true(tri_group_tag(2147483647.0) == INT32_MAX && tri_group_tag(2147483648.0) == 0);
}

static void *no_extra(void *user, size_t bytes)
{
    (void)user, (void)bytes;
    errno = EMFILE;
    return NULL;
}

/* Storage may fail for other reasons than memory, such as too many open files. The message gives the reason. */
static void test_storage_failures_are_reported(void **state)
{
    (void)state;
    struct array_grid arrays = ell();
    struct tri_grid grid = *array_grid(&arrays);
    const struct tri_storage storage = {.extra = no_extra};
    struct tri_grouping groups;
    struct tri_grouping whole = {.n = 0};
    struct tri_parts parts;
    struct tri_error error;
    grid.storage = &storage;
    assert_int_equal(tri_group(&groups, 6, tri_triangle_group, &grid, &error), TRI_NO_MEMORY);
    assert_non_null(strstr(error.text, strerror(EMFILE)));
    assert_int_equal(tri_parts_make(&parts, 2, &grid, &whole, &whole, &error), TRI_NO_MEMORY);
    assert_non_null(strstr(error.text, strerror(EMFILE)));
}

static double place(const struct tri_grid *grid, int64_t i)
{
    (void)grid;
    return (double)i;
}

static void test_too_many_groups_are_one(void **state)
{
    (void)state;
    struct tri_grouping groups;
    assert_int_equal(tri_group(&groups, TRI_MOST_GROUPS, place, &(struct tri_grid){0}, NULL), TRI_OK);
    assert_int_equal(groups.n, TRI_MOST_GROUPS);
    tri_grouping_free(&groups);
    assert_int_equal(tri_group(&groups, TRI_MOST_GROUPS + 1, place, &(struct tri_grid){0}, NULL), TRI_OK);
    assert_true(groups.n == 1 && groups.value[0] == 0 && groups.first[1] == TRI_MOST_GROUPS + 1 && !groups.order);
    tri_grouping_free(&groups);
}

static void test_texts(void **state)
{
    (void)state;
    struct array_grid arrays = ell();
    size_t size;
    char *sms = bytes_of(tri_write_2dm, array_grid(&arrays), &size);
    assert_string_equal(sms, "MESH2D\nNUM_MATERIALS_PER_ELEM 1\n"
                             "E3T 1 1 2 5 7\nE3T 2 1 5 4 7\nE3T 3 2 3 6 3\nE3T 4 2 6 5 3\nE3T 5 4 5 8 1\n"
                             "E3T 6 4 8 7 7\n"
                             "ND 1 0 0 1\nND 2 1 0 2\nND 3 2 0 3\nND 4 0 1 4\nND 5 1 1 5\nND 6 2 1 6\nND 7 0 2 7\n"
                             "ND 8 1 2 8\n"
                             "NS 1 2 -3 2\nNS 3 6 5 8 -7 1\nNS 7 4 -1 0\n");
    free(sms);
    char *adcirc = bytes_of(tri_write_14, array_grid(&arrays), &size);
    assert_string_equal(adcirc, "ptriangle\n 6 8\n"
                                " 1 0 0 1\n 2 1 0 2\n 3 2 0 3\n 4 0 1 4\n 5 1 1 5\n 6 2 1 6\n 7 0 2 7\n 8 1 2 8\n"
                                " 1 3 1 2 5\n 2 3 1 5 4\n 3 3 2 3 6\n 4 3 2 6 5\n 5 3 4 5 8\n 6 3 4 8 7\n"
                                " 1 = open boundaries\n 3 = nodes of them all\n 3 0\n 1\n 2\n 3\n"
                                " 2 = land boundaries\n 8 = nodes of them all\n"
                                " 5 0\n 3\n 6\n 5\n 8\n 7\n 3 0\n 7\n 4\n 1\n");
    free(adcirc);
}

static void test_sizes_of_binary_files(void **state)
{
    (void)state;
    struct array_grid arrays = ell();
    size_t size;
    char *vtu = bytes_of(tri_write_vtu, array_grid(&arrays), &size);
    const char *data = strstr(vtu, "<AppendedData encoding=\"raw\">\n_");
    assert_non_null(data);
    /* sizes; markers and depths; markers and regions of 15 cells; coordinates; 36 indices, 15 ends, 15 types */
    size_t n = 8 * 8 + 8 * 4 + 8 * 8 + 15 * 4 + 15 * 8 + 8 * 24 + 36 * 4 + 15 * 4 + 15;
    const char *end = strchr(data, '_') + 1 + n;
    assert_string_equal(end, "\n</AppendedData>\n</VTKFile>\n");
    free(vtu);
    char *msh = bytes_of(tri_write_msh, array_grid(&arrays), &size);
    static const char head[] = "$MeshFormat\n4.1 1 8\n\1\0\0\0\n$EndMeshFormat\n$PhysicalNames\n6\n1 3 \"marker_0\"\n"
                               "1 1 \"marker_1\"\n1 2 \"marker_2\"\n2 8 \"region_0.5\"\n2 3 \"region_3\"\n"
                               "2 7 \"region_7\"\n$EndPhysicalNames\n$Entities\n\0\0\0\0\0\0\0\0\3";
    assert_memory_equal(msh, head, sizeof head - 1);
    assert_memory_equal(msh + size - 16, "$EndElementData\n", 16);
    free(msh);
}

static int times_in(const int64_t *list, int64_t first, int64_t end, int64_t item)
{
    int n = 0;
    for (int64_t i = first; i < end; i++)
        n += list[i] == item;
    return n;
}

/* Returns true if the file of the part has the point exactly once. */
static bool has_point(const struct tri_parts *p, int part, int64_t point)
{
    int n = times_in(p->inner, p->first_inner[part], p->first_inner[part + 1], point);
    for (int64_t i = 0; i < p->n_interfaces; i++)
        for (int64_t k = p->first_shared[i]; k < p->first_shared[i + 1]; k++)
            n += tri_part_has_interface(p, part, i) && p->shared[k].point == point;
    assert_true(n <= 1);
    return n;
}

/* Asserts that each triangle and segment is in one part, and that a part has exactly the points of its items. */
static void assert_is_cut(const struct tri_grid *grid, int n)
{
    struct tri_grouping surfaces, curves;
    struct tri_parts p;
    int users[16] = {0};
    assert_int_equal(tri_group(&surfaces, grid->n_triangles, tri_triangle_group, grid, NULL), TRI_OK);
    assert_int_equal(tri_group(&curves, grid->n_segments, tri_segment_group, grid, NULL), TRI_OK);
    assert_int_equal(tri_parts_make(&p, n, grid, &surfaces, &curves, NULL), TRI_OK);
    assert_true(p.first_triangle[n] == grid->n_triangles && p.first_segment[n] == grid->n_segments);
    for (int64_t i = 0; i < grid->n_triangles; i++)
        assert_int_equal(times_in(p.triangle, 0, grid->n_triangles, i), 1);
    for (int64_t i = 0; i < grid->n_segments; i++)
        assert_int_equal(times_in(p.segment, 0, grid->n_segments, i), 1);
    for (int part = 0; part < n; part++) {
        bool used[16] = {false};
        const int64_t size = p.first_triangle[part + 1] - p.first_triangle[part];
        assert_true(size >= grid->n_triangles / n && size <= grid->n_triangles / n + 1);
        for (int64_t i = p.first_triangle[part]; i < p.first_triangle[part + 1]; i++) {
            int64_t nodes[6];
            grid->triangle(grid->user, tri_grouped(&surfaces, p.triangle[i]), nodes);
            for (int k = 0; k < 3; k++)
                used[nodes[k]] = true;
        }
        for (int64_t i = p.first_segment[part]; i < p.first_segment[part + 1]; i++) {
            struct tri_grid_edge segment;
            grid->segment(grid->user, tri_grouped(&curves, p.segment[i]), &segment);
            used[segment.ends[0]] = used[segment.ends[1]] = true;
        }
        for (int64_t i = 0; i < grid->n_points; i++) {
            users[i] += has_point(&p, part, i);
            assert_true(!used[i] || has_point(&p, part, i));
            assert_true(used[i] || !has_point(&p, part, i) || part == 0);
        }
    }
    for (int64_t k = 0; k < p.n_shared; k++)
        assert_true(users[p.shared[k].point] == p.shared[k].n && p.shared[k].n > 1);
    for (int64_t i = 0; i < grid->n_points; i++)
        assert_true(users[i] >= 1);
    tri_parts_free(&p);
    tri_grouping_free(&surfaces);
    tri_grouping_free(&curves);
}

static void test_parts(void **state)
{
    (void)state;
    struct array_grid arrays = ell();
    for (int n = 1; n <= 9; n++)
        assert_is_cut(array_grid(&arrays), n);
    /* segments that are no edges; point 8 is unused */
    static const int32_t loose[] = {0, 5, 0, 7, 2, 6, 6, 2, 6, 1, 5, 7, 1, 7, 8, 6, 8, 5};
    static const double more[] = {0, 0, 1, 0, 2, 0, 0, 1, 1, 1, 2, 1, 0, 2, 1, 2, 2, 2};
    arrays.points = more;
    arrays.segments = loose;
    arrays.grid.n_points = 9;
    for (int n = 1; n <= 9; n++)
        assert_is_cut(array_grid(&arrays), n);
    arrays.grid.n_triangles = arrays.grid.n_segments = 0;
    assert_is_cut(array_grid(&arrays), 2);
}

/* --- files of parts, read again and compared with the file of the whole mesh */

enum { COLUMNS = 9, ROWS = 7, SQUARES = (COLUMNS - 1) * (ROWS - 1), POINTS = COLUMNS * ROWS + 1 };

/* Squares of two triangles in three regions, with segments around them and down the middle, and an unused point. With
 * six nodes for a triangle, the middle nodes are arbitrary nearby points. */
struct lattice {
    double points[2 * POINTS], regions[2 * SQUARES];
    int32_t nodes[12 * SQUARES], segments[2 * (2 * COLUMNS + 3 * ROWS)], segment_markers[2 * COLUMNS + 3 * ROWS];
    int32_t n_segments;
};

static int32_t point_at(int column, int row) { return row * COLUMNS + column; }

static void add_segment(struct lattice *l, int32_t a, int32_t b, int32_t marker)
{
    l->segments[2 * l->n_segments] = a;
    l->segments[2 * l->n_segments + 1] = b;
    l->segment_markers[l->n_segments++] = marker;
}

static void add_segments(struct lattice *l)
{
    for (int i = 0; i + 1 < COLUMNS; i++) {
        add_segment(l, point_at(i, 0), point_at(i + 1, 0), 2);
        add_segment(l, point_at(i + 1, ROWS - 1), point_at(i, ROWS - 1), 0);
    }
    for (int j = 0; j + 1 < ROWS; j++) {
        add_segment(l, point_at(0, j + 1), point_at(0, j), 1);
        add_segment(l, point_at(COLUMNS - 1, j), point_at(COLUMNS - 1, j + 1), 1);
        add_segment(l, point_at(COLUMNS / 2, j), point_at(COLUMNS / 2, j + 1), 5);
    }
}

static void add_triangle(struct lattice *l, int i, int n_nodes, const int32_t corner[3])
{
    for (int k = 0; k < n_nodes; k++)
        l->nodes[n_nodes * i + k] = k < 3 ? corner[k] : corner[(k + 1) % 3];
}

static struct array_grid make_lattice(struct lattice *l, int n_nodes)
{
    *l = (struct lattice){.points = {[2 * POINTS - 2] = 20, [2 * POINTS - 1] = -3}};
    for (int i = 0; i < POINTS - 1; i++) {
        l->points[2 * i] = i % COLUMNS;
        l->points[2 * i + 1] = i / COLUMNS + 0.1 * (i % 3);
    }
    for (int s = 0; s < SQUARES; s++) {
        const int column = s % (COLUMNS - 1), row = s / (COLUMNS - 1);
        const int32_t a = point_at(column, row), b = a + 1, c = a + COLUMNS, d = c + 1;
        add_triangle(l, 2 * s, n_nodes, (int32_t[3]){a, b, d});
        add_triangle(l, 2 * s + 1, n_nodes, (int32_t[3]){a, d, c});
        l->regions[2 * s] = l->regions[2 * s + 1] = column < COLUMNS / 2 ? 3 : row < 2 ? 0.5 : 8;
    }
    add_segments(l);
    return (struct array_grid){.points = l->points, .nodes = l->nodes, .columns = l->regions, .segments = l->segments,
                               .segment_markers = l->segment_markers,
                               .grid = {.n_points = POINTS, .n_triangles = 2 * SQUARES, .n_nodes = n_nodes,
                                        .n_columns = 1, .n_segments = l->n_segments, .has_markers = true}};
}

static const char *part_name(int part)
{
    static char name[32];
    snprintf(name, sizeof name, "test_formats_%d.msh", part + 1);
    return name;
}

/* Writes and reads the file of the whole mesh and those of n parts. */
static void write_and_read(const struct tri_grid *grid, int n, struct msh_file *whole, struct msh_file *parts)
{
    static struct tri_output_set set;
    struct tri_output *output[MSH_MOST_PARTS + 1];
    tri_outputs_begin(&set);
    for (int i = 0; i <= n; i++)
        assert_int_equal(tri_output_open(&set, part_name(i), &output[i], NULL), TRI_OK);
    assert_int_equal(tri_write_msh_parts(output, n, grid, NULL, NULL), TRI_OK);
    assert_int_equal(tri_write_msh(output[n], grid, NULL, NULL), TRI_OK);
    assert_int_equal(tri_outputs_commit(&set, NULL), TRI_OK);
    for (int i = 0; i <= n; i++) {
        msh_read(i < n ? &parts[i] : whole, part_name(i));
        unlink(part_name(i));
    }
}

/* Finds a node by its tag; NULL: not in the file. */
static const struct msh_node *node_in(const struct msh_file *msh, int64_t tag)
{
    for (int64_t i = 0; i < msh->n_nodes; i++)
        if (msh->node[i].tag == tag)
            return &msh->node[i];
    return NULL;
}

/* Asserts that elements with the same tag have the same nodes, group and group tag in the part as in the whole, and
 * that their entity is a piece of the whole's entity. */
static void assert_same_elements(const struct msh_file *whole, const struct msh_file *msh, int part, int *times)
{
    for (int64_t i = 0; i < msh->n_elements; i++) {
        const struct msh_element *e = &msh->element[i];
        assert_true(e->tag >= 1 && e->tag <= whole->n_elements);
        const struct msh_element *same = &whole->element[e->tag - 1];
        assert_true(same->tag == e->tag && same->n_nodes == e->n_nodes);
        assert_memory_equal(same->nodes, e->nodes, sizeof e->nodes);
        assert_int_equal(e->entity->physical, same->entity->physical);
        assert_true(e->entity->parent == same->entity->tag && e->entity->parent_dimension == same->entity->dimension);
        assert_true(e->entity->n_parts == 1 && e->entity->part[0] == part + 1);
        for (int k = 0; k < e->n_nodes; k++)
            assert_non_null(node_in(msh, e->nodes[k]));
        times[e->tag]++;
    }
}

/* Asserts that a node has the same place as in the whole, is in a file at most once, and that its entity lists all
 * parts that have it. */
static void assert_same_node(const struct msh_node *node, int n, const struct msh_file *parts)
{
    int n_having = 0;
    for (int part = 0; part < n; part++) {
        const struct msh_node *same = node_in(&parts[part], node->tag);
        if (!same)
            continue;
        const int place = n_having++;
        int n_named = 0;
        assert_memory_equal(same->at, node->at, sizeof node->at);
        for (int64_t i = 0; i < parts[part].n_nodes; i++)
            n_named += parts[part].node[i].tag == node->tag;
        assert_int_equal(n_named, 1);
        assert_int_equal(same->entity->part[place], part + 1);
    }
    assert_true(n_having >= 1);
    for (int part = 0; part < n; part++)
        if (node_in(&parts[part], node->tag))
            assert_int_equal(node_in(&parts[part], node->tag)->entity->n_parts, n_having);
}

static void assert_parts_are_the_whole(const struct tri_grid *grid, int n)
{
    struct msh_file whole, parts[MSH_MOST_PARTS];
    int times[2 * SQUARES + 2 * COLUMNS + 3 * ROWS + 1] = {0};
    write_and_read(grid, n, &whole, parts);
    assert_true(whole.n_parts == 0 && whole.n_nodes == grid->n_points);
    assert_int_equal(whole.n_elements, grid->n_triangles + grid->n_segments);
    for (int part = 0; part < n; part++) {
        assert_int_equal(parts[part].n_parts, n);
        assert_same_elements(&whole, &parts[part], part, times);
        for (int64_t i = 0; i < parts[part].n_nodes; i++)
            assert_non_null(node_in(&whole, parts[part].node[i].tag));
    }
    for (int64_t i = 1; i <= whole.n_elements; i++)
        assert_int_equal(times[i], 1);
    for (int64_t i = 0; i < whole.n_nodes; i++)
        assert_same_node(&whole.node[i], n, parts);
    msh_free(&whole);
    for (int part = 0; part < n; part++)
        msh_free(&parts[part]);
}

static void test_parts_are_the_whole(void **state)
{
    (void)state;
    struct lattice lattice;
    for (int n_nodes = 3; n_nodes <= 6; n_nodes += 3) {
        struct array_grid arrays = make_lattice(&lattice, n_nodes);
        for (int n = 1; n <= MSH_MOST_PARTS; n = n < 8 ? n + 1 : 2 * n)
            assert_parts_are_the_whole(array_grid(&arrays), n);
    }
}

/* The cut is across the longer side. Points at equal places are ordered by number. */
static void test_where_parts_meet(void **state)
{
    (void)state;
    struct array_grid arrays = ell();
    const struct tri_grid *grid = array_grid(&arrays);
    struct tri_grouping surfaces, curves;
    struct tri_parts p;
    assert_int_equal(tri_group(&surfaces, 6, tri_triangle_group, grid, NULL), TRI_OK);
    assert_int_equal(tri_group(&curves, 9, tri_segment_group, grid, NULL), TRI_OK);
    assert_int_equal(tri_parts_make(&p, 2, grid, &surfaces, &curves, NULL), TRI_OK);
    bool lower[6] = {false};
    for (int64_t i = 0; i < p.first_triangle[1]; i++)
        lower[tri_grouped(&surfaces, p.triangle[i])] = true;
    assert_true(lower[1] && lower[5] && p.first_triangle[1] == 3); /* the two in the middle: 0 and 4 */
    assert_true(lower[0] != lower[4] && !lower[2] && !lower[3]);
    tri_parts_free(&p);
    tri_grouping_free(&surfaces);
    tri_grouping_free(&curves);
}

static void test_bytes_of_a_part(void **state)
{
    (void)state;
    struct array_grid arrays = ell();
    struct tri_output_set set;
    struct tri_output *output[2];
    const char *const name[] = {"test_formats_1.out", "test_formats_2.out"};
    tri_outputs_begin(&set);
    for (int i = 0; i < 2; i++)
        assert_int_equal(tri_output_open(&set, name[i], &output[i], NULL), TRI_OK);
    assert_int_equal(tri_write_msh_parts(output, 2, array_grid(&arrays), NULL, NULL), TRI_OK);
    assert_int_equal(tri_outputs_commit(&set, NULL), TRI_OK);
    for (int i = 0; i < 2; i++) {
        static char bytes[1 << 14];
        static const char section[] = "\n$EndEntities\n$PartitionedEntities\n\2\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0";
        FILE *file = fopen(name[i], "rb");
        assert_non_null(file);
        const size_t size = fread(bytes, 1, sizeof bytes, file);
        bool found = false;
        for (size_t k = 0; k + sizeof section < size; k++)
            found = found || memcmp(bytes + k, section, sizeof section - 1) == 0;
        assert_true(found);
        assert_memory_equal(bytes + size - 16, "$EndElementData\n", 16);
        fclose(file);
        unlink(name[i]);
    }
}

static void test_names(void **state)
{
    (void)state;
    assert_ptr_equal(tri_format_of("a.b/x.vtu")->write, tri_write_vtu);
    assert_ptr_equal(tri_format_of("fort.14")->write, tri_write_14);
    assert_ptr_equal(tri_format_of("X.MSH")->write, tri_write_msh); /* upper case is accepted */
    assert_ptr_equal(tri_format_of("x.Vtu")->write, tri_write_vtu);
    assert_null(tri_format_of("x.1"));
    assert_null(tri_format_of("vtu"));
    assert_null(tri_format_of(""));
}

/* Names that look like a format but are none are rejected. Names with version or run numbers are not. */
static void test_missing_formats(void **state)
{
    (void)state;
    static const char *const missing[] = {"x.shp", "a/b.c.VTK", "x.geojson", "grid.gr3", "x.h5", "run.1.fine", "a.x"};
    static const char *const fine[] = {"x.vtu", "fort.14", "run.1", "mesh.v2", "x", "", ".hidden", "a.shp/x", "x.",
                                       "a.shp/", "x.3a", "naca0012", "x.r2b"};
    for (size_t i = 0; i < sizeof missing / sizeof *missing; i++)
        assert_string_equal(tri_format_missing(missing[i]), strrchr(missing[i], '.'));
    for (size_t i = 0; i < sizeof fine / sizeof *fine; i++)
        assert_null(tri_format_missing(fine[i]));
    assert_int_equal(tri_format_base("run.1.node"), 5);
    assert_int_equal(tri_format_base("a.poly"), 1);
    assert_int_equal(tri_format_base("a.ele"), 1);
    assert_int_equal(tri_format_base("a.14"), 4);
    assert_int_equal(tri_format_base(".node"), 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_boundary),
        cmocka_unit_test(test_groups),
        cmocka_unit_test(test_storage_failures_are_reported),
        cmocka_unit_test(test_too_many_groups_are_one),
        cmocka_unit_test(test_texts),
        cmocka_unit_test(test_sizes_of_binary_files),
        cmocka_unit_test(test_parts),
        cmocka_unit_test(test_parts_are_the_whole),
        cmocka_unit_test(test_where_parts_meet),
        cmocka_unit_test(test_bytes_of_a_part),
        cmocka_unit_test(test_names),
        cmocka_unit_test(test_missing_formats),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
