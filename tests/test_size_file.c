/* Fields of lengths in files. The same field gives the same lengths in every format. Damaged content is refused with
   one sentence that names the line. Reading any damaged file ends with an error or with a field whose indices are
   valid. */
#include "triangle/text/size_file.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/files.h"

/* The field h = 1 + x / 2 + y / 4 at x = 0, 2, 4 and y = -1, 0. Bilinear and linear interpolation give the same
   values. */
enum { COLUMNS = 3, ROWS = 2, NODES = 6 };
static const double extent[] = {0, -1, 4, 0};

static double length_at(double x, double y) { return 1 + x / 2 + y / 4; }

/* x varies fastest. */
static const double nodes[NODES][2] = {{0, -1}, {2, -1}, {4, -1}, {0, 0}, {2, 0}, {4, 0}};

static void write_text(const char *name, const char *text)
{
    FILE *file = fopen(name, "wb");
    assert_true(file && fputs(text, file) >= 0 && fclose(file) == 0);
}

static void write_npy(const char *name, const char *type, bool by_columns, int version)
{
    char head[128];
    const int length = snprintf(head, sizeof head, "{'descr': '%s', 'fortran_order': %s, 'shape': (%d, %d), }   \n",
                                type, by_columns ? "True" : "False", ROWS, COLUMNS);
    FILE *file = fopen(name, "wb");
    assert_non_null(file);
    fwrite("\x93NUMPY", 1, 6, file);
    fputc(version, file);
    fputc(0, file);
    for (int k = 0; k < (version == 1 ? 2 : 4); k++)
        fputc(length >> (8 * k) & 255, file);
    fwrite(head, 1, (size_t)length, file);
    const int bytes = type[2] - '0';
    for (int i = 0; i < NODES; i++) {
        const int row = by_columns ? i % ROWS : i / COLUMNS, column = by_columns ? i / ROWS : i % COLUMNS;
        const double value = length_at(2 * column, row - 1);
        const float half = (float)value;
        const int64_t whole = (int64_t)(4 * value);
        char raw[8];
        memcpy(raw, type[1] != 'f' ? (const void *)&whole : bytes == 4 ? (const void *)&half : &value, (size_t)bytes);
        for (int k = 0; k < bytes; k++) /* the tests run only on little-endian machines, as does reading */
            fputc(raw[type[0] == '>' ? bytes - 1 - k : k], file);
    }
    assert_int_equal(fclose(file), 0);
}

static struct tri_size_file read_good(const char *name, const double *where)
{
    struct tri_size_file file;
    struct tri_error error = {0};
    const enum tri_status status = tri_size_file_read(&file, name, where, NULL, &error);
    if (status)
        fail_msg("%s:%ld: %s", error.file, (long)error.line, error.text);
    return file;
}

/* The raster equals that field times a factor. */
static void check_raster(const char *name, const double *where, double factor)
{
    struct tri_size_file file = read_good(name, where);
    const struct tri_size_field *f = &file.field;
    assert_true(f->kind == TRI_SIZE_RASTER && f->values.n == ROWS && f->values.width == COLUMNS);
    assert_true(f->origin[0] == 0 && f->origin[1] == -1 && f->step[0] == 2 && f->step[1] == 1);
    for (int i = 0; i < NODES; i++)
        assert_true(f->values.at[i] == factor * length_at(nodes[i][0], nodes[i][1]));
    tri_size_file_free(&file);
}

/* The corners of each triangle have their lengths, and the number of triangles is right. */
static void check_mesh(const char *name, int64_t n)
{
    struct tri_size_file file = read_good(name, NULL);
    const struct tri_size_field *f = &file.field;
    double area = 0;
    assert_true(f->kind == TRI_SIZE_MESH && f->triangles.n == n && f->values.n == f->points.n);
    for (int64_t i = 0; i < f->points.n; i++)
        assert_true(f->values.at[i] == length_at(f->points.at[2 * i], f->points.at[2 * i + 1]));
    for (int64_t t = 0; t < n; t++) {
        const double *a = f->points.at + 2 * f->triangles.at[3 * t], *b = f->points.at + 2 * f->triangles.at[3 * t + 1];
        const double *c = f->points.at + 2 * f->triangles.at[3 * t + 2];
        area += fabs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
    }
    assert_true(area == (n > 0 ? 4 : 0)); /* area of the whole field */
    tri_size_file_free(&file);
}

static void test_rasters_give_the_lengths_of_the_field(void **state)
{
    static const char *const types[] = {"<f8", ">f8", "<f4", ">f4", "<i4", ">i8", "|u1", "<u2", "|i1"};
    (void)state;
    write_text("cell.asc", "ncols 3\nNROWS 2\nxllcenter 0\nyllcenter -1\ndx 2\ndy 1\n1 2 3\n.75 1.75 2.75\n");
    check_raster("cell.asc", NULL, 1);
    write_text("cell.asc", "NCOLS 3 NROWS 2\r\nxllcorner -1 yllcorner -1.5\r\ndx 2 dy 1\r\n"
                           "nodata_value -1\r\n1 2\r\n3 .75 1.75 2.75");
    check_raster("cell.asc", NULL, 1);
    for (size_t k = 0; k < sizeof types / sizeof *types; k++)
        for (int version = 1; version <= 3; version++) {
            write_npy("field.npy", types[k], version % 2, version);
            check_raster("field.npy", extent, types[k][1] == 'f' ? 1 : 4);
        }
    write_text("grid.msh", "# a comment\nMSHID = 3; euclidean-grid\nNDIMS = 2\n"
                           "COORD = 1; 3\n0\n2\n4\nCOORD = 2; 2\n-1\n0\n"
                           "SLOPE = 1; 1\n7\nVALUE = 6; 1\n.75\n1\n1.75\n2\n2.75\n3\n");
    check_raster("grid.msh", NULL, 1);
}

/* Places without data have no lengths. An array whose extent runs downwards is flipped. */
static void test_places_without_data_have_no_lengths(void **state)
{
    (void)state;
    write_text("cell.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nnodata_value 7\n7 2\n3 inf\n");
    struct tri_size_file file = read_good("cell.asc", NULL);
    assert_true(file.values[0] == 3 && file.values[1] == HUGE_VAL && file.values[2] == 0 && file.values[3] == 2);
    tri_size_file_free(&file);
    write_text("cell.asc", "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\nnodata_value nan\nnan 2\n");
    file = read_good("cell.asc", NULL);
    assert_true(file.values[0] == 0 && file.values[1] == 2);
    tri_size_file_free(&file);
    write_npy("field.npy", "<f8", false, 1);
    file = read_good("field.npy", (double[]){4, 0, 0, -1});
    assert_true(file.field.origin[0] == 0 && file.field.origin[1] == -1);
    for (int i = 0; i < NODES; i++)
        assert_true(file.values[i] == length_at(nodes[NODES - 1 - i][0], nodes[NODES - 1 - i][1]));
    tri_size_file_free(&file);
}

static const char msh2[] =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 1 \"sea $Nodes\"\n$EndPhysicalNames\n"
    "$Nodes\n6\n11 0 -1 0\n12 2 -1 0\n13 4 -1 0\n24 0 0 0\n25 2 0 0\n26 4 0 0\n$EndNodes\n"
    "$Elements\n6\n1 15 2 0 1 11\n2 1 2 0 1 11 12\n3 2 2 0 1 11 12 25\n4 2 2 0 1 11 25 24\n5 2 2 0 1 12 13 26\n"
    "6 2 2 0 1 12 26 25\n$EndElements\n$NodeData\n1\n\"a vector\"\n1\n0.0\n3\n0\n3\n0\n$EndNodeData\n"
    "$NodeData\n1\n\"my lengths\"\n1\n0.0\n3\n0\n1\n6\n11 .75\n12 1.75\n13 2.75\n24 1\n25 2\n26 3\n$EndNodeData\n";
static const char msh4[] =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 1 0\n1 0 -1 0 4 0 0 0 0\n$EndEntities\n"
    "$Nodes\n2 6 1 6\n1 1 0 3\n1\n2\n3\n0 -1 0\n2 -1 0\n4 -1 0\n2 1 0 3\n4\n5\n6\n0 0 0\n2 0 0\n4 0 0\n$EndNodes\n"
    "$Elements\n2 5 1 5\n1 1 1 1\n1 1 2\n2 1 2 4\n2 1 2 5\n3 1 5 4\n4 2 3 6\n5 2 6 5\n$EndElements\n"
    "$NodeData\n1\n\"h\"\n0\n3\n0\n1\n6\n1 .75\n2 1.75\n3 2.75\n4 1\n5 2\n6 3\n$EndNodeData\n";
static const char jigsaw[] =
    "mshid=3;euclidean-mesh\nndims=2\npoint=6\n0;-1;0\n2;-1;0\n4;-1;0\n0;0;0\n2;0;0\n4;0;0\nedge2=1\n0;1;0\n"
    "value=6;1\n.75\n1.75\n2.75\n1\n2\n3\ntria3=4\n0;1;4;0\n0;4;3;0\n1;2;5;0\n1;5;4;0\n";
static const char view[] =
    "View \"h { \\ of x\" {\nSP(4,0,0){3};\nSL(0,0,0,2,0,0){1,2};\n// a comment\n"
    "ST(0,-1,0, 2,-1,0, 2,0,0){.75,1.75,2};\nST(0,-1,0,2,0,0,0,0,0){.75,2,1,9,9,9};\n"
    "SP(4,0,0){3};SL(0,0,0,2,0,0){1,2};ST(2,-1,0,4,-1,0,4,0,0){1.75,2.75,3};\nST(2,-1,0,4,0,0,2,0,0){1.75,3,2};\n};\n";

static void test_background_meshes_give_the_lengths_of_the_field(void **state)
{
    (void)state;
    write_text("mesh.node", "6 2 2 0\n1 0 -1 .75 9\n2 2 -1 1.75 9\n3 4 -1 2.75 9\n4 0 0 1 9\n5 2 0 2 9\n6 4 0 3 9\n");
    write_text("mesh.ele", "4 3 0\n1 1 2 5\n2 1 5 4\n3 2 3 6\n4 2 6 5\n");
    check_mesh("mesh.node", 4);
    write_text("mesh.msh", msh2);
    check_mesh("mesh.msh", 4);
    write_text("mesh.msh", msh4);
    check_mesh("mesh.msh", 4);
    write_text("mesh.msh", jigsaw);
    check_mesh("mesh.msh", 4);
    write_text("mesh.pos", view);
    check_mesh("mesh.pos", 4);
    write_text("mesh.pos", "View \"\" { SP(0,-1,0){.75}; SP(4,0,0){3}; };\n");
    check_mesh("mesh.pos", 0);
    write_text("grid.msh", "mshid=3;euclidean-grid\ncoord=1;3\n0\n1\n4\ncoord=2;2\n-1\n0\nvalue=6;1\n"
                           ".75\n1\n1.25\n1.5\n2.75\n3\n"); /* spacing is not uniform */
    check_mesh("grid.msh", 4);
}

/* A binary mesh of Gmsh whose data have an arbitrary name. */
static void test_binary_msh_is_read(void **state)
{
    static const char head[] = "$MeshFormat\n4.1 1 8\n\1\0\0\0\n$EndMeshFormat\n$Nodes\n";
    static const char data[] = "\n$EndElements\n$NodeData\n1\n\"anything\"\n1\n0\n3\n0\n1\n3\n";
    const int64_t node_heads[] = {1, 3, 1, 3}, tags[] = {1, 2, 3}, element[] = {1, 1, 2, 3};
    const int32_t block[] = {2, 1, 0}, element_block[] = {2, 1, 2};
    const int64_t three = 3, one = 1, element_heads[] = {1, 1, 1, 1};
    const double places[] = {0, -1, 0, 4, -1, 0, 0, 1, 0};
    (void)state;
    FILE *file = fopen("binary.msh", "wb");
    assert_non_null(file);
    fwrite(head, 1, sizeof head - 1, file);
    fwrite(node_heads, 8, 4, file);
    fwrite(block, 4, 3, file);
    fwrite(&three, 8, 1, file);
    fwrite(tags, 8, 3, file);
    fwrite(places, 8, 9, file);
    fputs("\n$EndNodes\n$Elements\n", file);
    fwrite(element_heads, 8, 4, file);
    fwrite(element_block, 4, 3, file);
    fwrite(&one, 8, 1, file);
    fwrite(element, 8, 4, file);
    fwrite(data, 1, sizeof data - 1, file);
    for (int32_t i = 1; i <= 3; i++) {
        const double value = length_at(places[3 * i - 3], places[3 * i - 2]);
        fwrite(&i, 4, 1, file);
        fwrite(&value, 8, 1, file);
    }
    fputs("\n$EndNodeData\n", file);
    assert_int_equal(fclose(file), 0);
    check_mesh("binary.msh", 1);
}

/* --- invalid content */

static void check_refused(const char *name, const char *text, long line, const char *words)
{
    struct tri_size_file file;
    struct tri_error error = {0};
    if (text)
        write_text(name, text);
    assert_int_equal(tri_size_file_read(&file, name, NULL, NULL, &error), TRI_BAD_INPUT);
    if (!strstr(error.text, words) || error.line != line || strcmp(error.file, name) != 0)
        fail_msg("%s:%ld: %s, not line %ld: %s", error.file, (long)error.line, error.text, line, words);
    tri_size_file_free(&file);
}

static void test_invalid_files_are_refused(void **state)
{
    (void)state;
    check_refused("a.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1.25 2\n3\n", 8,
                  "ends before a length");
    check_refused("a.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 x\n", 7,
                  "\"x\" is not a number");
    check_refused("a.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 nan\n", 7, "not a number");
    check_refused("a.asc", "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3\n", 7, "more values than");
    check_refused("a.asc", "ncols 2\nnrows 2000000000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1\n", 6,
                  "more than the file");
    check_refused("a.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 0\n1\n", 6, "cellsize is not above 0");
    check_refused("a.asc", "ncols 2\nnrows 2\nxllcorner 0\ncellsize 1\n1\n", 5, "yllcorner is missing");
    check_refused("a.asc", "ncols 2.5\n", 1, "not an integer");
    check_refused("a.asc", "ncols 2\nncols 2\n", 2, "occurs twice");
    check_refused("a.asc", "hello\n", 1, "not an entry of an ESRI");
    check_refused("a.asc", "", 2, "cellsize is missing");
    check_refused("a.npy", "\x93NUMPY", 0, "FILE.npy@XMIN");
    check_refused("a.msh", "hello\n", 1, "not a .msh file");
    check_refused("a.msh", "$MeshFormat\n4.0 0 8\n", 2, "version 4 ");
    check_refused("a.msh", "$MeshFormat\n2.2 1 8\n", 2, "version 2.2, binary");
    check_refused("a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n2000000000\n", 5, "more than the file holds");
    check_refused("a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0\n", 7, "ends before a coordinate");
    check_refused("a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0\n$EndNodes\n", 0, "no length");
    check_refused("a.msh", "mshid=3;euclidean-sphere\n", 1, "neither euclidean-mesh");
    check_refused("a.msh", "mshid=3;euclidean-mesh\nndims=2\npoint=1\n0;0;0\nvalue=2;1\n1\n2\n", 8,
                  "the number of values is 2, the number of places 1");
    check_refused("a.msh", "mshid=3;euclidean-mesh\npoint=1\n0;0;0\nvalue=1;1\n1\ntria3=1\n0;0;5;0\n", 0,
                  "refers to point 5");
    check_refused("a.msh", "mshid=3;euclidean-grid\ncoord=1;2\n1\n1\n", 4, "do not increase");
    check_refused("a.pos", "View \"h\" { ST(0,0,0,1,0,0,0,1,0){1,2}; };\n", 1, "\",\" is missing");
    check_refused("a.pos", "View \"h\" {\nSQ(0){1};\n};\n", 2, "not a scalar triangle");
    check_refused("a.pos", "View \"h\" {\nSP(0,0,0){1};\n", 3, "\"}\" is missing");
    check_refused("a.pos", "View \"h\" {\nSP(0,0,nan){1};\n};", 2, "not finite");
    write_text("a.ele", "0 3 0\n");
    check_refused("a.node", "3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n", 0, "no length at any point");
}

static void test_invalid_arrays_are_refused(void **state)
{
    static const char *const types[] = {"<f2", "<c8", "|O8", "<f8"};
    (void)state;
    for (int k = 0; k < 4; k++) {
        struct tri_size_file file;
        struct tri_error error = {0};
        write_npy("a.npy", types[k], false, k == 3 ? 4 : 1);
        assert_int_equal(tri_size_file_read(&file, "a.npy", extent, NULL, &error), TRI_BAD_INPUT);
        assert_non_null(strstr(error.text, k == 3 ? "version" : "not an array of float32"));
        tri_size_file_free(&file);
    }
}

/* --- damage: files are truncated, and each byte is replaced */

static void check_any(const char *name)
{
    struct tri_size_file file;
    struct tri_error error = {0};
    if (tri_size_file_read(&file, name, extent, NULL, &error))
        assert_true(error.text[0] != 0 && !strchr(error.text, '\n'));
    else
        for (int64_t i = 0; i < 3 * file.field.triangles.n; i++)
            assert_in_range(file.triangles[i], 0, file.field.points.n - 1);
    tri_size_file_free(&file);
}

static void damage(const char *name)
{
    static const char others[] = "9-;";
    size_t n;
    char *bytes = file_bytes(name, &n), copy[32];
    snprintf(copy, sizeof copy, "damaged%s", strchr(name, '.'));
    for (size_t i = 0; i < n; i += 2)
        for (size_t k = 0; k < sizeof others; k++) {
            const char was = bytes[i];
            FILE *file = fopen(copy, "wb");
            assert_non_null(file);
            bytes[i] = others[k]; /* the last round truncates the file */
            fwrite(bytes, 1, others[k] ? n : i, file);
            fclose(file);
            check_any(copy);
            bytes[i] = was;
        }
    free(bytes);
}

static void test_damaged_files_are_harmless(void **state)
{
    (void)state;
    write_text("whole.asc", "ncols 3\nNROWS 2\nxllcenter 0\nyllcenter -1\ndx 2\ndy 1\n1 2 3\n.75 1.75 2.75\n");
    damage("whole.asc");
    write_npy("whole.npy", "<f8", false, 1);
    damage("whole.npy");
    write_text("whole.msh", msh2);
    damage("whole.msh");
    write_text("whole.msh", msh4);
    damage("whole.msh");
    write_text("whole.msh", jigsaw);
    damage("whole.msh");
    write_text("whole.pos", view);
    damage("whole.pos");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rasters_give_the_lengths_of_the_field),
        cmocka_unit_test(test_places_without_data_have_no_lengths),
        cmocka_unit_test(test_background_meshes_give_the_lengths_of_the_field),
        cmocka_unit_test(test_binary_msh_is_read),
        cmocka_unit_test(test_invalid_files_are_refused),
        cmocka_unit_test(test_invalid_arrays_are_refused),
        cmocka_unit_test(test_damaged_files_are_harmless),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
