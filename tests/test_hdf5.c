/* HDF5 files: the data that is read equals the data written, with and without chunks, narrow and wide. The same tiles
 * give the same bytes. After a failure no file remains. */
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "tests/allocations.h"
#include "tests/files.h"
#include "tests/full.h"
#include "tests/lattice_tiles.h"
#include "triangle/hdf5/array.h"
#include "triangle/hdf5/h5_read.h"
#include "triangle/hdf5/h5_write.h"

static const struct lattice SMALL = {5, 1, 2, 2, false, false}, WHOLE = {6, 2, 0, 1, true, true},
                            PLAIN = {4, 3, 0, 0, true, false}, LARGE = {601, 37, 1, 1, true, false};

/* Writes the lattice to x.h5 and x.xdmf. */
static enum tri_status write_lattice(const struct lattice *lattice, bool markers, int64_t max_narrow,
                                     struct tri_error *error)
{
    struct tri_output_set set;
    struct tri_h5_options options = {.program = "test", .name = "x.h5", .markers = markers, .max_narrow = max_narrow};
    struct tri_h5_writer *writer = NULL;
    struct tri_sink sink;
    tri_outputs_begin(&set);
    enum tri_status status = tri_output_open(&set, "x.h5", &options.file, error);
    status = status ? status : tri_output_open(&set, "x.xdmf", &options.xdmf, error);
    status = status ? status : tri_h5_writer_new(&writer, &options, &sink, error);
    status = status ? status : lattice_hand_out(lattice, &sink, error);
    tri_h5_writer_free(writer);
    if (!status)
        return tri_outputs_commit(&set, error);
    tri_outputs_abort(&set);
    return status;
}

/* --- reading back */

static void compare_points(struct tri_h5 *h5, const struct lattice *l, bool markers, int64_t first, int64_t n)
{
    double(*at)[2] = malloc((size_t)n * sizeof *at), *attributes = malloc((size_t)n * 16), place[2];
    int32_t *marker = malloc((size_t)n * sizeof *marker);
    assert_int_equal(tri_h5_read(h5, TRI_H5_OF_POINTS, first, n, at, NULL), TRI_OK);
    assert_int_equal(tri_h5_read(h5, TRI_H5_OF_POINT_MARKERS, first, n, marker, NULL), TRI_OK);
    assert_int_equal(tri_h5_read(h5, TRI_H5_OF_POINT_ATTRIBUTES, first, n, attributes, NULL), TRI_OK);
    for (int64_t i = 0; i < n; i++) {
        lattice_point(l, first + i, place);
        assert_memory_equal(at[i], place, sizeof place);
        assert_int_equal(marker[i], markers ? lattice_point_marker(first + i) : 0);
        for (int32_t k = 0; k < l->n_attributes; k++)
            assert_true(attributes[i * l->n_attributes + k] == lattice_attribute(first + i, k));
    }
    free(at);
    free(attributes);
    free(marker);
}

static void compare_triangles(struct tri_h5 *h5, const struct lattice *l, int64_t first, int64_t n)
{
    int64_t(*corners)[3] = malloc((size_t)n * sizeof *corners), wanted[3];
    double *columns = malloc((size_t)n * 16);
    assert_int_equal(tri_h5_read(h5, TRI_H5_OF_TRIANGLES, first, n, corners, NULL), TRI_OK);
    assert_int_equal(tri_h5_read(h5, TRI_H5_OF_TRIANGLE_ATTRIBUTES, first, n, columns, NULL), TRI_OK);
    for (int64_t i = 0; i < n; i++) {
        lattice_corners(l, first + i, wanted);
        assert_memory_equal(corners[i], wanted, sizeof wanted);
        for (int32_t k = 0; k < l->n_columns; k++)
            assert_true(columns[i * l->n_columns + k] == lattice_column(l, lattice_region(first + i), k));
    }
    free(corners);
    free(columns);
}

static void compare_segments(struct tri_h5 *h5, const struct lattice *l, bool markers)
{
    const int64_t n = lattice_segments(l);
    int64_t(*ends)[2] = malloc((size_t)n * sizeof *ends), wanted[2];
    int32_t *marker = malloc((size_t)n * sizeof *marker);
    assert_int_equal(tri_h5_read(h5, TRI_H5_OF_SEGMENTS, 0, n, ends, NULL), TRI_OK);
    assert_int_equal(tri_h5_read(h5, TRI_H5_OF_SEGMENT_MARKERS, 0, n, marker, NULL), TRI_OK);
    for (int64_t i = 0; i < n; i++) {
        lattice_ends(l, i, wanted);
        assert_memory_equal(ends[i], wanted, sizeof wanted);
        assert_int_equal(marker[i], markers ? lattice_segment_marker(i) : 0);
    }
    free(ends);
    free(marker);
}

static void compare_counts(const struct tri_h5_counts *found, const struct lattice *l, bool markers)
{
    assert_int_equal(found->points, lattice_points(l));
    assert_int_equal(found->triangles, lattice_triangles(l));
    assert_int_equal(found->segments, lattice_segments(l));
    assert_int_equal(found->input_points, l->side);
    assert_int_equal(found->attributes, l->n_attributes);
    assert_int_equal(found->columns, l->n_columns);
    assert_int_equal(found->point_markers, markers);
    assert_int_equal(found->segment_markers, markers);
}

/* Opens x.h5, compares all of it in slices, and removes it. */
static void compare(const struct lattice *l, bool markers)
{
    struct tri_h5 *h5;
    struct tri_error error;
    const int64_t slice = 100003;
    assert_int_equal(tri_h5_open("x.h5", &h5, &error), TRI_OK);
    compare_counts(tri_h5_count(h5), l, markers);
    for (int64_t first = 0; first < lattice_points(l); first += slice)
        compare_points(h5, l, markers, first, lattice_points(l) - first < slice ? lattice_points(l) - first : slice);
    for (int64_t first = 0; first < lattice_triangles(l); first += slice)
        compare_triangles(h5, l, first, lattice_triangles(l) - first < slice ? lattice_triangles(l) - first : slice);
    compare_segments(h5, l, markers);
    assert_int_equal(tri_h5_read(h5, TRI_H5_OF_POINTS, lattice_points(l), 0, NULL, NULL), TRI_OK);
    tri_h5_free(h5);
}

static int remove_files(void **state)
{
    (void)state;
    remove("x.h5");
    remove("x.xdmf");
    remove("y");
    assert_int_equal(files_here(), 0);
    return 0;
}

static void test_data_read_equals_data_written(void **state)
{
    (void)state;
    const struct lattice *all[] = {&SMALL, &WHOLE, &PLAIN, &LARGE};
    for (int i = 0; i < 8; i += every(3)) {
        struct tri_error error;
        assert_int_equal(write_lattice(all[i / 2], i % 2, 0, &error), TRI_OK);
        compare(all[i / 2], i % 2);
    }
}

/* Numbers become wide before, in or after the first chunk, or at its end. */
static void test_wide_numbers(void **state)
{
    (void)state;
    const int64_t narrow[] = {1, 601, 50000, 131072, 262144, 300000, 601 * 601 - 1};
    struct tri_error error;
    for (size_t i = 0; i < sizeof narrow / sizeof *narrow; i += (size_t)every(3)) {
        assert_int_equal(write_lattice(&LARGE, true, narrow[i], &error), TRI_OK);
        compare(&LARGE, true);
    }
}

/* Cells end at any place, in all kinds of chunks. */
static void test_ends_of_cells(void **state)
{
    (void)state;
    const struct lattice *all[] = {&SMALL, &LARGE};
    for (int i = 0; i < 2; i++) {
        struct tri_error error;
        const int64_t m = lattice_triangles(all[i]), n = m + lattice_segments(all[i]) + 1;
        int64_t *ends = malloc((size_t)n * sizeof *ends);
        assert_int_equal(write_lattice(all[i], true, 0, &error), TRI_OK);
        hid_t file = H5Fopen("x.h5", H5F_ACC_RDONLY, H5P_DEFAULT);
        hid_t dataset = H5Dopen2(file, "/VTKHDF/Offsets", H5P_DEFAULT), space = H5Dget_space(dataset);
        assert_int_equal(H5Sget_simple_extent_npoints(space), n);
        assert_true(H5Dread(dataset, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, ends) >= 0);
        for (int64_t k = 0; k < n; k++)
            assert_true(ends[k] == (k <= m ? 3 * k : 3 * m + 2 * (k - m)));
        assert_true(i == 0 || H5Dget_storage_size(dataset) < (hsize_t)n / 8);
        H5Sclose(space);
        H5Dclose(dataset);
        H5Fclose(file);
        free(ends);
    }
}

static void test_small_files_are_small(void **state)
{
    (void)state;
    struct tri_error error;
    size_t n;
    assert_int_equal(write_lattice(&SMALL, true, 0, &error), TRI_OK);
    free(file_bytes("x.h5", &n));
    assert_true(n < 20000);
}

/* Any division into tiles gives the same bytes, also if numbers become wide meanwhile. */
static void test_same_mesh_same_bytes(void **state)
{
    (void)state;
    const int64_t narrow[] = {0, 100000, 262144};
    for (int i = 0; i < 9; i += every(4)) {
        struct lattice lattice = i / 3 ? LARGE : SMALL, other = lattice;
        struct tri_error error;
        size_t n, m;
        other.rows_in_tile = i / 3 == 1 ? 1 : 300;
        other.one_by_one = i / 3 == 2;
        assert_int_equal(write_lattice(&lattice, true, narrow[i % 3], &error), TRI_OK);
        char *first = file_bytes("x.h5", &n);
        assert_int_equal(write_lattice(&other, true, narrow[i % 3], &error), TRI_OK);
        char *second = file_bytes("x.h5", &m);
        assert_int_equal(n, m);
        assert_int_equal(memcmp(first, second, n), 0);
        free(first);
        free(second);
    }
}

/* Several writers write rows, taking turns by tile, to the offsets that the writer of the file returned. */
enum { PARTS = 3 };
struct parts {
    const struct lattice *lattice;
    struct tri_h5_options options;
    struct tri_h5_writer *writer;
    struct tri_sink whole;
    struct tri_h5_part *part[PARTS];
    int turn; /* the part that writes next */
    double bounds[4];
};

static enum tri_status begin_parts(void *user, const struct tri_stream *stream, struct tri_error *error)
{
    struct parts *p = user;
    const int64_t points[] = {0, 0, 5, lattice_points(p->lattice)},
                  triangles[] = {0, 0, 7, lattice_triangles(p->lattice)},
                  segments[] = {0, 0, 1, lattice_segments(p->lattice)};
    struct tri_stream on_ranks = *stream;
    on_ranks.n_ranks = PARTS;
    on_ranks.first_vertex = points;
    on_ranks.first_triangle = triangles;
    on_ranks.first_segment = segments;
    enum tri_status status = p->whole.begin(p->whole.user, &on_ranks, error);
    for (int i = 0; i < PARTS && !status; i++) {
        const struct tri_h5_layout *layout = tri_h5_writer_layout(p->writer);
        status = tri_h5_part_new(&p->part[i], layout, false, &on_ranks, p->options.file, error);
    }
    return status;
}

static enum tri_status take_part(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    struct parts *p = user;
    tri_h5_extend_bounds(p->bounds, tile);
    return tri_h5_part_take(p->part[p->turn++ % PARTS], tile, error);
}

static enum tri_status end_parts(void *user, struct tri_error *error)
{
    struct parts *p = user;
    enum tri_status status = TRI_OK;
    for (int i = 0; i < PARTS && !status; i++)
        status = tri_h5_part_end(p->part[i], error);
    tri_h5_writer_set_totals(p->writer, p->lattice->side, p->bounds);
    return status ? status : p->whole.end(p->whole.user, error);
}

static enum tri_status write_parts(const struct lattice *lattice, bool markers, int64_t max_narrow,
                                   struct tri_error *error)
{
    struct tri_output_set set;
    struct parts p = {.lattice = lattice, .bounds = {HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL},
                      .options = {.program = "test", .name = "x.h5", .markers = markers, .max_narrow = max_narrow}};
    const struct tri_sink sink = {&p, begin_parts, take_part, end_parts};
    tri_outputs_begin(&set);
    enum tri_status status = tri_output_open(&set, "x.h5", &p.options.file, error);
    status = status ? status : tri_output_open(&set, "x.xdmf", &p.options.xdmf, error);
    status = status ? status : tri_h5_writer_new(&p.writer, &p.options, &p.whole, error);
    status = status ? status : lattice_hand_out(lattice, &sink, error);
    tri_h5_writer_free(p.writer);
    for (int i = 0; i < PARTS; i++)
        tri_h5_part_free(p.part[i]);
    if (!status)
        return tri_outputs_commit(&set, error);
    tri_outputs_abort(&set);
    return status;
}

static void test_parts_make_the_same_bytes(void **state)
{
    (void)state;
    static const struct lattice larger = {1101, 37, 0, 0, false, false}; /* chunks already written become wide */
    const struct lattice *all[] = {&LARGE, &larger, &PLAIN, &LARGE, &SMALL, &larger, &WHOLE};
    const int64_t narrow[] = {0, 786432, 0, 262144, 3, 1100000, 0};
    for (int i = 0; i < 7; i += every(2)) {
        struct tri_error error;
        size_t n, m;
        assert_int_equal(write_lattice(all[i], i % 3 == 0, narrow[i], &error), TRI_OK);
        char *whole = file_bytes("x.h5", &n);
        assert_int_equal(write_parts(all[i], i % 3 == 0, narrow[i], &error), TRI_OK);
        char *parts = file_bytes("x.h5", &m);
        assert_int_equal(n, m);
        assert_int_equal(memcmp(whole, parts, n), 0);
        compare(all[i], i % 3 == 0);
        free(whole);
        free(parts);
    }
}

/* Works for any byte order of the machine, and for unaligned memory. */
static void test_rows_as_bytes(void **state)
{
    (void)state;
    double points[1][2] = {{1, -2.5}}, attribute = 1, columns[2] = {7, -0x01020304};
    int64_t corners[1][3] = {{1, 0x01020304, INT64_C(0x0102030405060708)}}, ends[1][2] = {{2, 0x0a0b0c0d}};
    int32_t marker = -2, region = 1;
    const struct tri_tile tile = {.n_vertices = 1, .n_triangles = 1, .n_segments = 1, .points = points,
                                  .point_markers = &marker, .attributes = &attribute, .corners = corners,
                                  .regions = &region, .ends = ends, .segment_markers = &marker};
    const struct tri_h5_rows rows = {&tile, columns, 1, 1};
    static const struct {
        enum tri_h5_kind kind;
        enum tri_h5_type type;
        size_t n;
        const char *bytes;
    } wanted[] = {
        {TRI_H5_OF_POINTS, TRI_H5_FLOAT64, 16, "\0\0\0\0\0\0\xf0\x3f\0\0\0\0\0\0\x04\xc0"},
        {TRI_H5_OF_POINT_MARKERS, TRI_H5_INT32, 4, "\xfe\xff\xff\xff"},
        {TRI_H5_OF_POINT_ATTRIBUTES, TRI_H5_FLOAT64, 8, "\0\0\0\0\0\0\xf0\x3f"},
        {TRI_H5_OF_TRIANGLES, TRI_H5_INT64, 24,
         "\x01\0\0\0\0\0\0\0\x04\x03\x02\x01\0\0\0\0\x08\x07\x06\x05\x04\x03\x02\x01"},
        {TRI_H5_OF_TRIANGLE_ATTRIBUTES, TRI_H5_INT32, 4, "\xfc\xfc\xfd\xfe"},
        {TRI_H5_OF_SEGMENTS, TRI_H5_INT32, 8, "\x02\0\0\0\x0d\x0c\x0b\x0a"},
        {TRI_H5_OF_SEGMENTS, TRI_H5_INT64, 16, "\x02\0\0\0\0\0\0\0\x0d\x0c\x0b\x0a\0\0\0\0"},
        {TRI_H5_OF_SEGMENT_MARKERS, TRI_H5_INT32, 4, "\xfe\xff\xff\xff"},
    };
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
        char room[32] = {0};
        tri_h5_put(&rows, wanted[i].kind, wanted[i].type, 0, 1, room + 1);
        assert_memory_equal(room + 1, wanted[i].bytes, wanted[i].n);
        assert_int_equal(room[0], 0);
        assert_int_equal(room[1 + wanted[i].n], 0);
    }
}

/* As many points as fit in one chunk, one less, and one more. The same for chunks of segments. */
static void test_sizes_around_a_chunk(void **state)
{
    (void)state;
    struct tri_error error;
    for (int32_t side = 511; side <= 513; side += every(2)) {
        const struct lattice lattice = {side, 100, 0, 1, true, side == 513};
        assert_int_equal(write_lattice(&lattice, true, 0, &error), TRI_OK);
        compare(&lattice, true);
    }
}

static void test_xdmf(void **state)
{
    (void)state;
    struct tri_error error;
    size_t n;
    assert_int_equal(write_lattice(&SMALL, true, 0, &error), TRI_OK);
    char *text = file_bytes("x.xdmf", &n);
    assert_non_null(strstr(text, "TopologyType=\"Triangle\" NumberOfElements=\"32\""));
    assert_non_null(strstr(text, "<DataItem Dimensions=\"25 2\" NumberType=\"Float\" Precision=\"8\" Format=\"HDF\">"
                                 "x.h5:/points</DataItem>"));
    free(text);
}

static herr_t has_no_time(hid_t object, const char *name, const H5O_info_t *info, void *user)
{
    (void)object, (void)name;
    ++*(int *)user;
    return info->atime == 0 && info->mtime == 0 && info->ctime == 0 && info->btime == 0 ? 0 : -1;
}

static void test_objects_have_no_time_stamps(void **state)
{
    (void)state;
    struct tri_error error;
    int n = 0;
    assert_int_equal(write_lattice(&SMALL, true, 0, &error), TRI_OK);
    hid_t file = H5Fopen("x.h5", H5F_ACC_RDONLY, H5P_DEFAULT);
    assert_true(H5Ovisit(file, H5_INDEX_NAME, H5_ITER_INC, has_no_time, &n) >= 0);
    H5Fclose(file);
    assert_true(n > 20);
}

/* --- failures */

/* The disk becomes full after a certain number of bytes, during any write. */
static void test_full_disk(void **state)
{
    (void)state;
    struct rlimit before, limit;
    struct tri_error error;
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    const rlim_t sizes[] = {0, 100, 3000, 1 << 20, 5 << 20, 9 << 20, 12 << 20, 17 << 20};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i += (size_t)every(3)) {
        limit = (struct rlimit){sizes[i], before.rlim_max};
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
        enum tri_status status = write_lattice(&LARGE, true, i % 2 ? 200000 : 0, &error);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
        assert_int_equal(status, TRI_CANNOT_WRITE);
        assert_non_null(strstr(error.text, "File too large"));
        assert_int_equal(files_here(), 0);
    }
}

/* Each of the library's own allocations fails in turn. */
static void test_no_memory(void **state)
{
    (void)state;
    struct tri_error error;
    enum tri_status status = TRI_NO_MEMORY;
    for (int64_t k = 1; status; k++) {
        atomic_store(&support_calls, 0);
        atomic_store(&support_fail_at, k);
        int64_t held = atomic_load(&support_held);
        status = write_lattice(&SMALL, true, 10, &error);
        atomic_store(&support_fail_at, INT64_MAX);
        assert_int_equal(atomic_load(&support_held), held);
        assert_true(status == TRI_OK || files_here() == 0);
        assert_true(k < 100);
    }
    compare(&SMALL, true);
}

static bool never(void *user)
{
    (void)user;
    return true;
}

static void test_stop(void **state)
{
    (void)state;
    const struct tri_stop stop = {never, NULL};
    struct tri_output_set set;
    struct tri_h5_options options = {.program = "test", .name = "x.h5", .markers = true};
    struct tri_h5_writer *writer;
    struct tri_sink sink;
    struct tri_error error;
    tri_outputs_begin(&set);
    set.stop = &stop;
    assert_int_equal(tri_output_open(&set, "x.h5", &options.file, &error), TRI_OK);
    assert_int_equal(tri_output_open(&set, "x.xdmf", &options.xdmf, &error), TRI_OK);
    assert_int_equal(tri_h5_writer_new(&writer, &options, &sink, &error), TRI_OK);
    assert_int_equal(lattice_hand_out(&LARGE, &sink, &error), TRI_STOPPED);
    tri_h5_writer_free(writer);
    tri_outputs_abort(&set);
    assert_int_equal(files_here(), 0);
}

/* --- files without a mesh */

static void write_words(const char *name, const char *words, size_t n)
{
    FILE *file = fopen(name, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(words, 1, n, file), n);
    fclose(file);
}

static void refuse(const char *path, enum tri_status wanted, const char *words)
{
    struct tri_h5 *h5;
    struct tri_error error;
    assert_int_equal(tri_h5_open(path, &h5, &error), wanted);
    assert_null(h5);
    assert_string_equal(error.file, path);
    assert_non_null(strstr(error.text, words));
}

static void test_files_without_a_mesh_are_refused(void **state)
{
    (void)state;
    struct tri_error error;
    size_t n;
    refuse("x.h5", TRI_CANNOT_READ, "No such file");
    write_words("y", "0 2 0 0\n", 8);
    refuse("y", TRI_CANNOT_READ, "not an HDF5 file");
    assert_int_equal(write_lattice(&SMALL, true, 0, &error), TRI_OK);
    char *bytes = file_bytes("x.h5", &n);
    write_words("y", bytes, n / 2);
    refuse("y", TRI_CANNOT_READ, "not an HDF5 file");
    free(bytes);
    hid_t file = H5Fopen("x.h5", H5F_ACC_RDWR, H5P_DEFAULT);
    H5Ldelete(file, "point_markers", H5P_DEFAULT);
    H5Lcreate_hard(file, "triangles", file, "point_markers", H5P_DEFAULT, H5P_DEFAULT);
    H5Fclose(file);
    refuse("x.h5", TRI_BAD_INPUT, "/point_markers has an unexpected type");
    file = H5Fopen("x.h5", H5F_ACC_RDWR, H5P_DEFAULT);
    H5Ldelete(file, "points", H5P_DEFAULT);
    H5Fclose(file);
    refuse("x.h5", TRI_BAD_INPUT, "no array /points");
}

/* Replaces /points in x.h5 by a data set made with HDF5. The file must then be rejected with these words. */
static void replace_points(void (*make)(hid_t file), const char *words)
{
    struct tri_error error;
    assert_int_equal(write_lattice(&SMALL, true, 0, &error), TRI_OK);
    hid_t file = H5Fopen("x.h5", H5F_ACC_RDWR, H5P_DEFAULT);
    H5Ldelete(file, "points", H5P_DEFAULT);
    make(file);
    H5Fclose(file);
    refuse("x.h5", TRI_BAD_INPUT, words);
    assert_int_equal(files_here(), 2);
}

/* Makes `size` rows without writing any. */
static void make_dataset(hid_t file, const char *name, hid_t creation, hid_t type, hsize_t rows, hsize_t width)
{
    const hsize_t size[2] = {rows, width}, most[2] = {H5S_UNLIMITED, width};
    hid_t space = H5Screate_simple(2, size, H5Pget_layout(creation) == H5D_CHUNKED ? most : NULL);
    hid_t dataset = H5Dcreate2(file, name, type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    assert_true(dataset >= 0);
    H5Dclose(dataset);
    H5Sclose(space);
    H5Pclose(creation);
}

static hsize_t small_rows(void) { return (hsize_t)lattice_points(&SMALL); }

static void make_external(hid_t file)
{
    hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_external(creation, "/etc/passwd", 0, 16 * small_rows());
    make_dataset(file, "points", creation, H5T_IEEE_F64LE, small_rows(), 2);
}

static void make_soft_link(hid_t file)
{
    make_dataset(file, "elsewhere", H5Pcreate(H5P_DATASET_CREATE), H5T_IEEE_F64LE, small_rows(), 2);
    H5Lcreate_soft("/elsewhere", file, "points", H5P_DEFAULT, H5P_DEFAULT);
}

static void make_external_link(hid_t file)
{
    H5Lcreate_external("y.h5", "/points", file, "points", H5P_DEFAULT, H5P_DEFAULT);
}

static void make_virtual(hid_t file)
{
    const hsize_t size[2] = {small_rows(), 2};
    hid_t creation = H5Pcreate(H5P_DATASET_CREATE), space = H5Screate_simple(2, size, NULL);
    H5Pset_virtual(creation, space, "y.h5", "/points", space);
    H5Sclose(space);
    make_dataset(file, "points", creation, H5T_IEEE_F64LE, small_rows(), 2);
}

static void make_compressed(hid_t file)
{
    const hsize_t chunk[2] = {8, 2};
    hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(creation, 2, chunk);
    H5Pset_deflate(creation, 1);
    make_dataset(file, "points", creation, H5T_IEEE_F64LE, small_rows(), 2);
}

static void make_chunks(hid_t file)
{
    const hsize_t chunk[2] = {8, 2};
    hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(creation, 2, chunk);
    make_dataset(file, "points", creation, H5T_IEEE_F64LE, small_rows(), 2);
}

static void make_piece(hid_t file)
{
    make_dataset(file, "points", H5Pcreate(H5P_DATASET_CREATE), H5T_IEEE_F64LE, small_rows(), 2);
}

static void make_floats(hid_t file)
{
    make_dataset(file, "points", H5Pcreate(H5P_DATASET_CREATE), H5T_IEEE_F32LE, small_rows(), 2);
}

static void test_unsupported_layouts_are_refused(void **state)
{
    (void)state;
    replace_points(make_external, "/points is stored in another file");
    replace_points(make_soft_link, "/points is a link");
    replace_points(make_external_link, "/points is a link");
    replace_points(make_virtual, "/points has virtual or compact storage");
    replace_points(make_compressed, "/points is compressed");
    replace_points(make_chunks, "/points is incomplete");
    replace_points(make_piece, "/points is incomplete");
    replace_points(make_floats, "/points has an unexpected type");
    assert_int_equal(mkfifo("y", 0600), 0);
    refuse("y", TRI_CANNOT_READ, "not a regular file");
}

/* A small file may claim to hold a large amount of data. */
static void test_impossible_row_counts_are_refused(void **state)
{
    (void)state;
    struct tri_error error;
    const hsize_t chunk[2] = {65536, 3};
    assert_int_equal(write_lattice(&SMALL, true, 0, &error), TRI_OK);
    hid_t file = H5Fopen("x.h5", H5F_ACC_RDWR, H5P_DEFAULT), creation = H5Pcreate(H5P_DATASET_CREATE);
    H5Ldelete(file, "triangles", H5P_DEFAULT);
    H5Pset_chunk(creation, 2, chunk);
    make_dataset(file, "triangles", creation, H5T_STD_I64LE, (hsize_t)1 << 40, 3);
    H5Fclose(file);
    refuse("x.h5", TRI_BAD_INPUT, "/triangles has more rows than a mesh with this number of points");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_data_read_equals_data_written, remove_files),
        cmocka_unit_test_teardown(test_wide_numbers, remove_files),
        cmocka_unit_test_teardown(test_ends_of_cells, remove_files),
        cmocka_unit_test_teardown(test_small_files_are_small, remove_files),
        cmocka_unit_test_teardown(test_same_mesh_same_bytes, remove_files),
        cmocka_unit_test_teardown(test_parts_make_the_same_bytes, remove_files),
        cmocka_unit_test(test_rows_as_bytes),
        cmocka_unit_test_teardown(test_sizes_around_a_chunk, remove_files),
        cmocka_unit_test_teardown(test_objects_have_no_time_stamps, remove_files),
        cmocka_unit_test_teardown(test_xdmf, remove_files),
        cmocka_unit_test_teardown(test_full_disk, remove_files),
        cmocka_unit_test_teardown(test_no_memory, remove_files),
        cmocka_unit_test_teardown(test_stop, remove_files),
        cmocka_unit_test_teardown(test_files_without_a_mesh_are_refused, remove_files),
        cmocka_unit_test_teardown(test_unsupported_layouts_are_refused, remove_files),
        cmocka_unit_test_teardown(test_impossible_row_counts_are_refused, remove_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
