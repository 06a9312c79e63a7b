/* Reads formats of other programs again. The data that a format stores is restored, for a part of a mesh as well, and
   in any order that the file uses. Unsupported content is refused with one sentence. Reading a damaged file ends with
   an error or with a mesh whose indices are valid. */
#include <fcntl.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "tests/array_grid.h"
#include "tests/files.h"
#include "triangle/text/formats.h"

/* The square of tests/test_formats.c: 3 x 3 points without the upper right quarter. The last segment lies inside. The
   nodes at midpoints of edges follow the corners. */
static const double points[] = {0, 0, 1, 0, 2, 0, 0, 1, 1, 1, 2, 1, 0, 2, 1, 2, 0.5, 0.5, 1, 0.5, 0.5, 0, 0, 0.5,
                                0.5, 1, 1.5, 0.5, 2, 0.5, 1.5, 0, 1.5, 1, 0.5, 1.5, 1, 1.5, 0, 1.5, 0.5, 2};
static const double depths[] = {1, 2, 3, 4, 5, 6, 7, 8, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.1};
static const int32_t point_markers[] = {2, 2, 1, 0, 0, 1, -7, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
static const int32_t three[] = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4, 3, 4, 7, 3, 7, 6};
static const int32_t six[] = {0, 1, 4, 9, 8, 10, 0, 4, 3, 12, 11, 8, 1, 2, 5, 14, 13, 15,
                              1, 5, 4, 16, 9, 13, 3, 4, 7, 18, 17, 12, 3, 7, 6, 20, 19, 17};
static const double regions[] = {7, 7, 3, 3, 0.5, 7}, materials[] = {7, 7, 3, 3, 1, 7};
static const int32_t segments[] = {0, 1, 1, 2, 2, 5, 5, 4, 4, 7, 7, 6, 6, 3, 3, 0, 1, 4};
static const int32_t segment_markers[] = {2, 2, 1, 1, 1, 1, 0, 0, 5};
enum { INNER = 1, OUTER = 8 }; /* markers of segments */

static struct array_grid l_shape(int n_nodes)
{
    return (struct array_grid){.points = points, .attributes = depths, .markers = point_markers,
                               .nodes = n_nodes == 6 ? six : three, .columns = regions, .segments = segments,
                               .segment_markers = segment_markers,
                               .grid = {.n_points = n_nodes == 6 ? 21 : 8, .n_attributes = 1, .n_triangles = 6,
                                        .n_nodes = n_nodes, .n_columns = 1, .n_segments = OUTER + INNER,
                                        .has_markers = true}};
}

static const struct tri_grid *grid_of(struct array_grid *arrays)
{
    struct tri_grid *grid = (struct tri_grid *)(uintptr_t)array_grid(arrays);
    grid->neighbors = NULL;
    return grid;
}

static void write_file(const char *name, const char *bytes, size_t n)
{
    FILE *file = fopen(name, "wb");
    assert_true(file && fwrite(bytes, 1, n, file) == n && fclose(file) == 0);
}

static void write_grid(const char *name, const struct tri_grid *grid)
{
    struct tri_output_set set;
    struct tri_output *output;
    tri_outputs_begin(&set);
    assert_int_equal(tri_output_open(&set, name, &output, NULL), TRI_OK);
    assert_int_equal(tri_format_of(name)->write(output, grid, NULL, NULL), TRI_OK);
    assert_int_equal(tri_outputs_commit(&set, NULL), TRI_OK);
}

struct mesh {
    struct tri_pslg pslg;
    struct tri_elements elements;
};

static void free_mesh(struct mesh *mesh)
{
    tri_pslg_free(&mesh->pslg);
    tri_elements_free(&mesh->elements);
}

/* Empty if reading fails. */
static enum tri_status read_mesh(const char *name, struct mesh *mesh, struct tri_error *error)
{
    *mesh = (struct mesh){0};
    const enum tri_status status = tri_format_of(name)->read(name, &mesh->pslg, &mesh->elements, NULL, error);
    if (status)
        free_mesh(mesh);
    return status;
}

/* --- the same mesh in any order */

enum { MOST_LINES = 32, LINE_BYTES = 96 };

struct lines {
    int n;
    char text[MOST_LINES][LINE_BYTES];
};

static int compare_lines(const void *a, const void *b) { return strcmp(a, b); }

static void add_triangle(struct lines *l, const int32_t *corners, const int32_t *extra, double attribute)
{
    assert_true(l->n < MOST_LINES);
    int n = snprintf(l->text[l->n], LINE_BYTES, "t %d %d %d", corners[0], corners[1], corners[2]);
    if (extra)
        n += snprintf(l->text[l->n] + n, LINE_BYTES - (size_t)n, " %d %d %d", extra[0], extra[1], extra[2]);
    snprintf(l->text[l->n++] + n, LINE_BYTES - (size_t)n, " %g", attribute);
}

static void add_segment(struct lines *l, const int32_t *ends, int32_t marker)
{
    assert_true(l->n < MOST_LINES);
    snprintf(l->text[l->n++], LINE_BYTES, "s %d %d %d", ends[0], ends[1], marker);
}

static void sort_lines(struct lines *l) { qsort(l->text, (size_t)l->n, LINE_BYTES, compare_lines); }

static void take_lines(struct lines *l, const struct mesh *mesh)
{
    const struct tri_elements *e = &mesh->elements;
    memset(l, 0, sizeof *l);
    for (int32_t t = 0; t < e->n; t++)
        add_triangle(l, e->corners + 3 * t, e->extra ? e->extra + 3 * t : NULL, e->attributes ? e->attributes[t] : 0);
    for (int32_t s = 0; s < mesh->pslg.n_segments; s++)
        add_segment(l, mesh->pslg.segments + 2 * s, mesh->pslg.segment_markers ? mesh->pslg.segment_markers[s] : 0);
    sort_lines(l);
}

/* The data of the square that a format stores. */
struct kept {
    const char *name;
    int n_nodes;
    bool markers, inner;     /* markers of points; segments inside the domain */
    const double *attributes; /* attributes of triangles; NULL: none */
};

static void expect_lines(struct lines *l, const struct kept *kept)
{
    const bool adcirc = kept->attributes == NULL;
    memset(l, 0, sizeof *l);
    for (int t = 0; t < 6; t++)
        add_triangle(l, kept->n_nodes == 6 ? six + 6 * t : three + 3 * t, kept->n_nodes == 6 ? six + 6 * t + 3 : NULL,
                     adcirc ? 0 : kept->attributes[t]);
    for (int s = 0; s < OUTER + (kept->inner ? INNER : 0); s++)
        add_segment(l, segments + 2 * s, adcirc && segment_markers[s] != 2 ? 1 : segment_markers[s]);
    sort_lines(l);
}

static void compare_points(const struct mesh *mesh, const struct kept *kept)
{
    const int n = kept->n_nodes == 6 ? 21 : 8;
    assert_int_equal(mesh->pslg.n_points, n);
    assert_memory_equal(mesh->pslg.points, points, (size_t)n * 16);
    assert_int_equal(mesh->pslg.n_attributes, 1);
    assert_memory_equal(mesh->pslg.attributes, depths, (size_t)n * 8);
    assert_int_equal(mesh->pslg.markers != NULL, kept->markers);
    if (kept->markers)
        assert_memory_equal(mesh->pslg.markers, point_markers, (size_t)n * 4);
}

static const struct kept formats[] = {
    {"x.vtu", 3, true, true, regions},     {"x.vtu", 6, true, true, regions},     {"x.msh", 3, true, true, regions},
    {"x.msh", 6, true, true, regions},     {"x.2dm", 3, false, false, materials}, {"x.2dm", 6, false, false, materials},
    {"fort.14", 3, false, false, NULL},    {"x.grd", 3, false, false, NULL},
};
enum { FORMATS = sizeof formats / sizeof *formats };

static void test_written_meshes_are_read_back(void **state)
{
    (void)state;
    for (int i = 0; i < FORMATS; i++) {
        struct array_grid arrays = l_shape(formats[i].n_nodes);
        struct mesh mesh;
        struct lines found, wanted;
        write_grid(formats[i].name, grid_of(&arrays));
        assert_int_equal(read_mesh(formats[i].name, &mesh, NULL), TRI_OK);
        compare_points(&mesh, &formats[i]);
        assert_int_equal(mesh.elements.n_nodes, formats[i].n_nodes);
        take_lines(&found, &mesh);
        expect_lines(&wanted, &formats[i]);
        assert_int_equal(found.n, wanted.n);
        for (int k = 0; k < found.n; k++)
            assert_string_equal(found.text[k], wanted.text[k]);
        free_mesh(&mesh);
        unlink(formats[i].name);
    }
}

/* Points alone, and empty tables. */
static void test_points_alone_and_empty_tables_are_read(void **state)
{
    (void)state;
    static const char *const names[] = {"x.vtu", "x.msh", "x.2dm", "x.14"};
    for (int i = 0; i < 4; i++) {
        struct array_grid arrays = array_grid_of_points(0, 3, points);
        struct mesh mesh;
        arrays.grid.n_nodes = 3;
        write_grid(names[i], grid_of(&arrays));
        assert_int_equal(read_mesh(names[i], &mesh, NULL), TRI_OK);
        assert_int_equal(mesh.pslg.n_points, 3);
        assert_true(mesh.elements.n == 0 && mesh.pslg.n_segments == 0 && mesh.pslg.n_attributes == 0);
        assert_true(mesh.elements.n_attributes == 0 && !mesh.pslg.markers);
        free_mesh(&mesh);
        unlink(names[i]);
    }
}

static void test_parts_of_a_mesh_are_read(void **state)
{
    (void)state;
    static const char *const names[] = {"p_1.msh", "p_2.msh", "p_3.msh"};
    struct array_grid arrays = l_shape(3);
    struct tri_output_set set;
    struct tri_output *outputs[3];
    int triangles = 0, ends = 0;
    tri_outputs_begin(&set);
    for (int i = 0; i < 3; i++)
        assert_int_equal(tri_output_open(&set, names[i], &outputs[i], NULL), TRI_OK);
    assert_int_equal(tri_write_msh_parts(outputs, 3, grid_of(&arrays), NULL, NULL), TRI_OK);
    assert_int_equal(tri_outputs_commit(&set, NULL), TRI_OK);
    for (int i = 0; i < 3; i++) {
        struct mesh mesh;
        assert_int_equal(read_mesh(names[i], &mesh, NULL), TRI_OK);
        for (int32_t t = 0; t < mesh.elements.n; t++, triangles++) {
            const int32_t *v = mesh.elements.corners + 3 * t;
            const double *p = mesh.pslg.points, *a = p + 2 * v[0], *b = p + 2 * v[1], *c = p + 2 * v[2];
            assert_true((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) == 1);
        }
        ends += mesh.pslg.n_segments;
        free_mesh(&mesh);
        unlink(names[i]);
    }
    assert_int_equal(triangles, 6);
    assert_int_equal(ends, OUTER + INNER);
}

/* --- files written by other programs */

#define VTU_HEAD "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\"><UnstructuredGrid>" \
                 "<FieldData><DataArray type=\"Float64\" Name=\"T\" format=\"ascii\">1</DataArray></FieldData>" \
                 "<!-- <Piece> --><Piece NumberOfPoints='4' NumberOfCells=\"3\">\n"
#define VTU_POINTS "<Points><DataArray type=\"Float32\" Name=\"Points\" NumberOfComponents=\"3\" format=\"ascii\">\n" \
                   "0 0 0 1 0 0 1 1 0 0 1 0 <InformationKey name=\"L2\"></InformationKey></DataArray></Points>\n"
#define VTU_CELLS(nodes, types) "<Cells><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">" nodes \
    "</DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">2 5 8\n</DataArray>" \
    "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">" types "</DataArray></Cells>"
#define VTU_TAIL "</Piece></UnstructuredGrid></VTKFile>\n"
#define FORT_14 "grid 1\n2 4\n40 0 0 -1\n10 1 0 2\n30 1 1 0\n20 0 1 0\n1 3 40 10 30\n2 3 40 30 20\n1 = open\n2\n2\n" \
                "40\n10\n1 = land\n3\n3 1 = island\n10\n30\n20\n"

static void expect_square(const char *name, const char *text, int32_t n_segments)
{
    struct mesh mesh;
    struct tri_error error = {0};
    static const int32_t corners[] = {0, 1, 2, 0, 2, 3};
    static const double square[] = {0, 0, 1, 0, 1, 1, 0, 1};
    write_file(name, text, strlen(text));
    enum tri_status status = read_mesh(name, &mesh, &error);
    assert_string_equal(error.text, "");
    assert_int_equal(status, TRI_OK);
    assert_int_equal(mesh.pslg.n_points, 4);
    assert_memory_equal(mesh.pslg.points, square, sizeof square);
    assert_int_equal(mesh.elements.n, 2);
    assert_memory_equal(mesh.elements.corners, corners, sizeof corners);
    assert_int_equal(mesh.pslg.n_segments, n_segments);
    free_mesh(&mesh);
    unlink(name);
}

static void test_files_of_other_programs_are_read(void **state)
{
    (void)state;
    expect_square("x.vtu", VTU_HEAD VTU_POINTS VTU_CELLS("1 2  0 1 2  0 2 3", "3 5 5") VTU_TAIL, 1);
    expect_square("x.14", FORT_14, 4);
    expect_square("x.2dm", "MESH2D\r\nMESHNAME \"1\"\r\nND 7 0 0 0\r\nND 3 1 0 0\r\nND 5 1 1 0\r\nND 1 0 1 0\r\n"
                           "E3T 1 7 3 5 1\r\nE3T 2 7 5 1 1\r\nNS 7 3\r\nNS -5 2 name\r\nNS 5 -1 3\r\n", 3);
}

static void refuse(const char *name, const char *text, const char *words)
{
    struct mesh mesh;
    struct tri_error error = {0};
    write_file(name, text, strlen(text));
    assert_int_not_equal(read_mesh(name, &mesh, &error), TRI_OK);
    if (!strstr(error.text, words))
        assert_string_equal(error.text, words);
    assert_true(!mesh.pslg.points && !mesh.elements.corners && strcmp(error.file, name) == 0);
    unlink(name);
}

static void test_unsupported_content_is_refused(void **state)
{
    (void)state;
    struct mesh mesh;
    assert_int_equal(read_mesh("none.vtu", &mesh, NULL), TRI_CANNOT_READ);
    refuse("x.vtu", "4 2 0 0\n", "not a VTK file");
    refuse("x.vtu", "<VTKFile type=\"PolyData\">", "not an unstructured grid");
    refuse("x.vtu", "<VTKFile type=\"UnstructuredGrid\" compressor=\"vtkZLib\">", "compressed");
    refuse("x.vtu", VTU_HEAD VTU_POINTS VTU_TAIL, "the array connectivity is missing");
    refuse("x.vtu", VTU_HEAD VTU_POINTS VTU_CELLS("1 2 0 1 2 0 2 4", "3 5 5") VTU_TAIL,
           "a cell refers to point 4 of 4");
    refuse("x.vtu", VTU_HEAD VTU_POINTS VTU_CELLS("1 2 0 1 2 0 2", "3 5 5") VTU_TAIL, "does not have 8 finite numbers");
    refuse("x.vtu", VTU_HEAD VTU_POINTS VTU_CELLS("1 2 0 1 2 0 2 3", "3 5 9") VTU_TAIL, "cell 2 is of type 9");
    refuse("x.vtu", VTU_HEAD VTU_HEAD, "more than one piece");
    refuse("x.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", "not a binary file of version 4.1");
    refuse("x.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n", "not a binary file of version 4.1");
    refuse("x.msh", "solid\n", "not a .msh file");
    refuse("x.msh", "", "not a .msh file");
    refuse("x.2dm", "MESH2D\nND 1 0 0 0\nE4Q 1 1 1 1 1 1\n", "not a triangle");
    refuse("x.2dm", "MESH2D\nND 1 0 0 0\nND 1 0 1 0\n", "node 1 occurs twice");
    refuse("x.2dm", "MESH2D\nND 1 0 0 0\nE3T 1 1 1 2 1\n", "a node that is missing or does not exist");
    refuse("x.2dm", "MESH2D\nND 1 0 0 0\nNS 1 1 1\n", "a node string has no end");
    refuse("x.2dm", "4 2 0 0\n", "no mesh");
    refuse("x.14", "grid\n2 4\n1 0 0 0\n", "records follow");
    refuse("x.14", "grid\n1 1\n1 0 0 0\n1 4 1 1 1 1\n0\n0\n0\n0\n", "is not a triangle");
    refuse("x.14", "grid\n1 1\n1 0 nan 0\n1 3 1 1 1\n0\n0\n0\n0\n", "missing or not finite");
    refuse("x.14", "grid\n0 1\n1 0 0 0\n1\n2\n2\n1\n", "a node of a boundary is missing");
}

/* --- damage */

static void assert_sound(const struct mesh *mesh)
{
    const struct tri_pslg *p = &mesh->pslg;
    for (int64_t i = 0; i < 2 * (int64_t)p->n_points; i++)
        assert_true(isfinite(p->points[i]));
    for (int64_t i = 0; i < (int64_t)p->n_attributes * p->n_points; i++)
        assert_true(isfinite(p->attributes[i]));
    for (int64_t i = 0; i < 2 * (int64_t)p->n_segments; i++)
        assert_true(p->segments[i] >= 0 && p->segments[i] < p->n_points);
    for (int64_t i = 0; i < 3 * (int64_t)mesh->elements.n; i++)
        assert_true(mesh->elements.corners[i] >= 0 && mesh->elements.corners[i] < p->n_points);
    for (int64_t i = 0; mesh->elements.extra && i < 3 * (int64_t)mesh->elements.n; i++)
        assert_true(mesh->elements.extra[i] >= 0 && mesh->elements.extra[i] < p->n_points);
}

/* The file stays open, because some file systems flush a file that is closed after truncation. */
static void try_bytes(const char *name, int file, const char *bytes, size_t n)
{
    struct mesh mesh;
    struct tri_error error = {0};
    assert_true(ftruncate(file, (off_t)n) == 0 && pwrite(file, bytes, n, 0) == (ssize_t)n);
    const enum tri_status status = read_mesh(name, &mesh, &error);
    if (status) {
        assert_true(error.text[0] && !strchr(error.text, '\n') && status != TRI_INTERNAL);
        assert_true(!mesh.pslg.points && !mesh.elements.corners);
    } else {
        assert_sound(&mesh);
    }
    free_mesh(&mesh);
}

static void test_damaged_files_are_harmless(void **state)
{
    (void)state;
    static const char changes[] = {'\0', '\xff', '9', '-', '<', '\x7f'};
    for (int i = 0; i < FORMATS; i++) {
        const char *name = formats[i].name;
        struct array_grid arrays = l_shape(formats[i].n_nodes);
        size_t n;
        write_grid(name, grid_of(&arrays));
        char *bytes = file_bytes(name, &n);
        const int file = open(name, O_RDWR);
        assert_true(file >= 0);
        for (size_t length = 0; length < n; length += 1 + length / 64)
            try_bytes(name, file, bytes, length);
        for (size_t k = 0; k < n; k++) {
            const char old = bytes[k];
            bytes[k] = changes[k % sizeof changes];
            try_bytes(name, file, bytes, n);
            bytes[k] = (char)(old ^ 1 << k % 8);
            try_bytes(name, file, bytes, n);
            bytes[k] = old;
        }
        free(bytes);
        close(file);
        unlink(name);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_written_meshes_are_read_back),
        cmocka_unit_test(test_points_alone_and_empty_tables_are_read),
        cmocka_unit_test(test_parts_of_a_mesh_are_read),
        cmocka_unit_test(test_files_of_other_programs_are_read),
        cmocka_unit_test(test_unsupported_content_is_refused),
        cmocka_unit_test(test_damaged_files_are_harmless),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
