/* Reading .node, .poly, .ele and .area files: every lexical rule and every error is a row of a table. Each row is read
   with chunks of several sizes, down to one byte, and with tasks in reverse order. The result must be the same. */
#include "triangle/text/read.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "full.h"

#define LENGTH(array) (sizeof(array) / sizeof *(array))

static char directory[64], node_path[80], poly_path[80], ele_path[80], area_path[80];

static int set_up(void **state)
{
    (void)state;
    strcpy(directory, "/tmp/test_read_XXXXXX");
    if (!mkdtemp(directory))
        return -1;
    snprintf(node_path, sizeof node_path, "%s/a.node", directory);
    snprintf(poly_path, sizeof poly_path, "%s/a.poly", directory);
    snprintf(ele_path, sizeof ele_path, "%s/a.ele", directory);
    snprintf(area_path, sizeof area_path, "%s/a.area", directory);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    unlink(node_path);
    unlink(poly_path);
    unlink(ele_path);
    unlink(area_path);
    return rmdir(directory);
}

/* The old file is unlinked first: some file systems flush a file whose bytes are replaced, which would take longer than
   the rest of the test. */
static void write_bytes(const char *path, const char *bytes, size_t n)
{
    unlink(path);
    FILE *const file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, n, file), n);
    assert_int_equal(fclose(file), 0);
}

static void write_text(const char *path, const char *text) { write_bytes(path, text, strlen(text)); }

static void run_backwards(void *self, size_t n_tasks, void (*task)(void *context, size_t index), void *context)
{
    (void)self;
    while (n_tasks > 0)
        task(context, --n_tasks);
}

static const struct tri_executor backwards = {run_backwards, NULL};

/* The content that was read, as text. */
struct dump {
    char text[4096];
    size_t length;
};

static void add(struct dump *dump, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const int n = vsnprintf(dump->text + dump->length, sizeof dump->text - dump->length, format, arguments);
    va_end(arguments);
    dump->length += (size_t)n;
    assert_true(dump->length < sizeof dump->text);
}

static void add_reals(struct dump *dump, const char *name, const double *values, size_t n)
{
    if (values)
        add(dump, "%s", name);
    for (size_t i = 0; values && i < n; i++)
        add(dump, "%s%.17g", i ? " " : "", values[i]);
}

static void add_integers(struct dump *dump, const char *name, const int32_t *values, size_t n)
{
    if (values)
        add(dump, "%s", name);
    for (size_t i = 0; values && i < n; i++)
        add(dump, "%s%ld", i ? " " : "", (long)values[i]);
}

static void add_pslg(struct dump *dump, const struct tri_pslg *p)
{
    add_reals(dump, "p:", p->points, 2 * (size_t)p->n_points);
    add_reals(dump, "|a:", p->attributes, (size_t)p->n_points * (size_t)p->n_attributes);
    add_integers(dump, "|m:", p->markers, (size_t)p->n_points);
    add_integers(dump, "|s:", p->segments, 2 * (size_t)p->n_segments);
    add_integers(dump, "|sm:", p->segment_markers, (size_t)p->n_segments);
    add_reals(dump, "|h:", p->holes, 2 * (size_t)p->n_holes);
    add_reals(dump, "|r:", p->regions, 4 * (size_t)p->n_regions);
}

static void add_warning(void *user, const char *file, int64_t line, const char *text)
{
    assert_non_null(strrchr(file, '/'));
    add(user, "|w%ld:%s", (long)line, text);
}

/* Reading with other chunks or another executor must give the same result. */
static const struct tri_read_options varieties[] = {
    {.default_base = 1},
    {.default_base = 1, .chunk_bytes = 1},
    {.default_base = 1, .chunk_bytes = 2, .executor = &backwards},
    {.default_base = 1, .chunk_bytes = 7, .executor = &backwards},
    {.default_base = 1, .chunk_bytes = 16},
    {.default_base = 1, .chunk_bytes = 64, .executor = &backwards},
};

enum kind { NODE, POLY, POLY_WITH_REGIONS, POLY_REFINING, ELE, AREA };

/* Reads the file of that kind. dump becomes the result, or the error as "status line text". */
static void read_kind(enum kind kind, struct tri_read_options options, struct dump *dump)
{
    struct tri_pslg pslg = {0};
    struct tri_elements elements = {.n = kind == AREA ? 3 : 0};
    int32_t base = -1;
    bool points_in_poly = false;
    struct tri_error error = {.status = TRI_OK};
    enum tri_status status;
    *dump = (struct dump){.length = 0};
    options.want_regions = kind == POLY_WITH_REGIONS;
    options.refining = kind == POLY_REFINING;
    options.warn = add_warning;
    struct dump warnings = {.length = 0};
    options.warn_user = &warnings;
    if (kind == NODE)
        status = tri_read_node(node_path, &options, &pslg, &base, &error);
    else if (kind == ELE)
        status = tri_read_ele(ele_path, &options, 1, 4, &elements, &error);
    else if (kind == AREA)
        status = tri_read_area(area_path, &options, 1, &elements, &error);
    else
        status = tri_read_poly(poly_path, node_path, &options, &pslg, &base, &points_in_poly, &error);
    assert_int_equal(status, error.status);
    if (status != TRI_OK) {
        add(dump, "%d %ld %s", (int)status, (long)error.line, error.text);
        assert_null(pslg.points || pslg.segments || pslg.markers || elements.corners || elements.areas ? "not empty"
                                                                                                       : NULL);
        assert_non_null(strrchr(error.file, '/'));
        return;
    }
    if (kind <= POLY_REFINING)
        add(dump, "%d%s ", (int)base, kind != NODE && !points_in_poly ? "n" : "");
    add_pslg(dump, &pslg);
    if (kind == ELE)
        add(dump, "%d ", (int)elements.n_nodes);
    add_integers(dump, "t:", elements.corners, 3 * (size_t)elements.n);
    add_reals(dump, "|a:", elements.attributes, (size_t)elements.n * (size_t)elements.n_attributes);
    add_integers(dump, "|x:", elements.extra, (size_t)elements.n * (size_t)(elements.n_nodes - 3));
    add_reals(dump, "b:", elements.areas, 3);
    add(dump, "%s", warnings.text);
    tri_pslg_free(&pslg);
    tri_elements_free(&elements);
}

struct example {
    const char *text;
    const char *expected; /* the beginning of the dump or, for errors, of "status line text" */
};

static const char *path_of(enum kind kind)
{
    return kind == NODE ? node_path : kind == ELE ? ele_path : kind == AREA ? area_path : poly_path;
}

static void check_file(enum kind kind, const char *what, const char *expected)
{
    struct dump dump;
    for (size_t i = 0; i < LENGTH(varieties); i++) {
        read_kind(kind, varieties[i], &dump);
        const size_t n = dump.text[0] > '1' && dump.text[1] == ' ' ? strlen(expected) : sizeof dump.text;
        if (strncmp(dump.text, expected, n) != 0)
            fail_msg("variety %zu of\n%s\nread as\n%s\nexpected\n%s", i, what, dump.text, expected);
    }
}

static void check_examples(enum kind kind, const struct example *examples, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        write_text(path_of(kind), examples[i].text);
        check_file(kind, examples[i].text, examples[i].expected);
    }
}

#define CHECK_EXAMPLES(kind, examples) check_examples(kind, examples, LENGTH(examples))

/* --- rules that affect the meaning */

static void node_lexical_rules(void **state)
{
    (void)state;
    static const struct example examples[] = {
        {"3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n", "1 p:0 0 1 0 0 1"},
        {"3 2 0 0\n1 0 0\n2 1 0\n3 0 1", "1 p:0 0 1 0 0 1"},
        {"3\n1 0 0\n2 1 0\n3 0 1\n", "1 p:0 0 1 0 0 1"},
        {"3 2\r\n1 0 0\r\n2 1 0\r\n3 0 1\r\n", "1 p:0 0 1 0 0 1"},
        {"\xEF\xBB\xBF" "3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n", "1 p:0 0 1 0 0 1"},
        {"# head 4 5\n\n  \t \n3 2 0 0 # 3\nwords only\n1 0 0#7\n#\n2 1 0\n3 0 1\n4 9 9\n", "1 p:0 0 1 0 0 1"},
        {"abc 3: 2 0 0\nv 1: (0 , 0)\n2 = 1 ; 0\n[3 0 / 1 ]\n", "1 p:0 0 1 0 0 1"},
        {"3\n1 0,9 0 5\n2 1x9 0\n3 0 1abc7 8\n", "1 p:0 0 1 0 0 1"},
        {"3\n1\t0\t0\n2\t\t1  0\n3 0 +1\n", "1 p:0 0 1 0 0 1"},
        {"3\n1 1e2 -1.5E-1\n2 .5 5.\n3 1d0 0x10\n", "1 p:100 -0.14999999999999999 0.5 5 1 16"},
        {"3\n1 1e-400 -1e-400\n2 010 0\n3 0 0\n", "1 p:0 -0 10 0 0 0"},
        {"0x3 2.9 0.5\n1 0 0\n2 1 0\n3 0 1\n", "1 p:0 0 1 0 0 1"},
        {"3 2 2 1\n1 0 0 5 6 7\n2 1 0 8\n3 0 1\n", "1 p:0 0 1 0 0 1|a:5 6 8 0 0 0|m:7 0 0"},
        {"3 2 0 1\n1 0 0 -3\n2 1 0 4294967297\n3 0 1 2147483648 9\n", "1 p:0 0 1 0 0 1|m:-3 1 -2147483648"},
        {"3 2 0 5\n1 0 0 4\n2 1 0 3.9\n3 0 1 0x1F\n", "1 p:0 0 1 0 0 1|m:4 3 31"},
    };
    CHECK_EXAMPLES(NODE, examples);
}

/* The number of the first record determines the base. The numbers of all other records are ignored. */
static void node_base(void **state)
{
    (void)state;
    static const struct example examples[] = {
        {"3\n0 0 0\n1 1 0\n2 0 1\n", "0 p:0 0 1 0 0 1"},   {"3\n1 0 0\n1 1 0\n1 0 1\n", "1 p:0 0 1 0 0 1"},
        {"3\n5 0 0\n0 1 0\n0 0 1\n", "1 p:0 0 1 0 0 1"},   {"3\n-1 0 0\n0 1 0\n0 0 1\n", "1 p:0 0 1 0 0 1"},
        {"3\n0x0 0 0\n0 1 0\n0 0 1\n", "0 p:0 0 1 0 0 1"}, {"3\n- 0 0\n0 1 0\n0 0 1\n", "1 p:0 0 1 0 0 1"},
    };
    CHECK_EXAMPLES(NODE, examples);
    struct tri_pslg pslg;
    int32_t base;
    write_text(node_path, "3\n5 0 0\n6 1 0\n7 0 1\n");
    const struct tri_read_options from_zero = {.default_base = 0};
    assert_int_equal(tri_read_node(node_path, &from_zero, &pslg, &base, NULL), TRI_OK);
    assert_int_equal(base, 0);
    tri_pslg_free(&pslg);
}

#define THREE "3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n"
#define POINTS "p:0 0 1 0 0 1"

static void poly_sections(void **state)
{
    (void)state;
    static const struct example examples[] = {
        {THREE "2 1\n1 1 2 5\n2 2 3\n1\n1 .5 .25\n", "1 " POINTS "|s:0 1 1 2|sm:5 0|h:0.5 0.25"},
        {THREE "2\n1 1 2 5\n2 2 3\n0\n", "1 " POINTS "|s:0 1 1 2"},
        {THREE "0 0\n0\n", "1 " POINTS},
        {"3\n0 0 0\n1 1 0\n2 0 1\n1\n0 1 2\n0\n", "0 " POINTS "|s:1 2"},
        {THREE "0 0\n0\nregions are not looked at: -7\n", "1 " POINTS},
    };
    CHECK_EXAMPLES(POLY, examples);
    static const struct example with_regions[] = {
        {THREE "0\n0\n2\n1 .5 .25 7 .1\n2 0 0 3\n", "1 " POINTS "|r:0.5 0.25 7 0.10000000000000001 0 0 3 3"},
        {THREE "0\n0\n0\n", "1 " POINTS},
        {THREE "0\n0\n1\n1 0 0 -1 -1\n", "1 " POINTS "|r:0 0 -1 -1"},
    };
    CHECK_EXAMPLES(POLY_WITH_REGIONS, with_regions);
}

static void poly_takes_points_from_node(void **state)
{
    (void)state;
    static const struct example examples[] = {
        {"0 2 0 1\n1 0\n0 1 2\n0\n", "0n " POINTS "|s:1 2"},
        {"0\n1 0\n0 1 2\n0\n", "0n " POINTS "|s:1 2"},
        {"0 9 9 9\n0\n0\n", "0n " POINTS},
    };
    write_text(node_path, "3\n0 0 0\n1 1 0\n2 0 1\n");
    CHECK_EXAMPLES(POLY, examples);
    unlink(node_path);
    check_file(POLY, "no .node file", "4 0 cannot open");
    struct tri_pslg pslg;
    int32_t base;
    bool points_in_poly;
    assert_int_equal(tri_read_poly(poly_path, NULL, &varieties[0], &pslg, &base, &points_in_poly, NULL), TRI_BAD_INPUT);
}

static void poly_warns_of_segments(void **state)
{
    (void)state;
    static const struct example examples[] = {
        {THREE "3\n1 1 4\n\n2 0 1\n# no\n3 2 2\n0\n",
         "1 " POINTS "|s:0 3 -1 0 1 1|w6:segment 1 is ignored: its second endpoint is not the number of a vertex"
         "|w8:segment 2 is ignored: its first endpoint is not the number of a vertex"
         "|w10:segment 3 is ignored: its endpoints are the same vertex"},
        {"3\n0 0 0\n1 0 0\n2 0 1\n1\n0 0 1\n0\n",
         "0 p:0 0 0 0 0 1|s:0 1|w6:segment 0 is ignored: its endpoints are at the same place"},
        {THREE "1\n1 99999999999999 -99999999999999\n0\n",
         "1 " POINTS "|s:2147483647 -2147483648|w6:segment 1 is ignored: its first endpoint is not the number of a "
         "vertex"},
    };
    CHECK_EXAMPLES(POLY, examples);
}

static void ele_and_area(void **state)
{
    (void)state;
    static const struct example elements[] = {
        {"2 3 0\n1 1 2 3\n2 2 4 3\n", "3 t:0 1 2 1 3 2"},
        {"2\n1 1 2 3 9 9\n2 2 4 3\n", "3 t:0 1 2 1 3 2"},
        {"2 6 1\n1 1 2 3 4 5 6 7.5\n2 2 4 3 1 1 1\n", "6 t:0 1 2 1 3 2|a:7.5 0|x:3 -1 -1 0 0 0"},
        {"1 4 1\n1 1 2 3\n", "4 t:0 1 2|a:0|x:-1"},
        {"1 5 1\n1 1 2 3 -- 4 8\n", "5 t:0 1 2|a:8|x:-1 3"},
        {"1 2000000000 0\n1 1 2 3 4\n", "2000000000 t:0 1 2"},
        {"1 3 2\n1 1 2 3 -1 1e10\n", "3 t:0 1 2|a:-1 10000000000"},
        {"0 3 0\n", "3 "},
    };
    CHECK_EXAMPLES(ELE, elements);
    static const struct example areas[] = {
        {"3\n1 .5\n2 -1\n3\n", "b:0.5 -1 0"},
    };
    CHECK_EXAMPLES(AREA, areas);
}

/* --- errors: 3 is TRI_BAD_INPUT, 4 is TRI_CANNOT_READ */

static void node_errors(void **state)
{
    (void)state;
    static const struct example examples[] = {
        {"", "3 1 unexpected end of file: the number of vertices is missing"},
        {"\n# nothing\n\n", "3 3 unexpected end of file"},
        {"2 2 0 0\n1 0 0\n2 1 0\n", "3 1 there are only 2 vertices"},
        {"0\n", "3 1 there are only 0 vertices"},
        {"-3\n1 0 0\n", "3 1 the number of vertices is negative"},
        {"-\n1 0 0\n", "3 1 the number of vertices is not a number"},
        {"3 3 0 0\n1 0 0\n2 1 0\n3 0 1\n", "3 1 the vertices have 3 coordinates"},
        {"3 - 0 0\n1 0 0\n2 1 0\n3 0 1\n", "3 1 field 2 of the header"},
        {"3 2 -1 0\n1 0 0\n2 1 0\n3 0 1\n", "3 1 the number of attributes is negative"},
        {"3 2 1000 0\n1 0 0\n2 1 0\n3 0 1\n", "3 1 1000 attributes are announced, more than the file can hold"},
        {"3 2 99999999999 0\n1 0 0\n2 1 0\n3 0 1\n", "3 1 99999999999 attributes are announced"},
        {"4 2 0 0\n1 0 0\n2 1 0\n3 0 1\n# end\n", "3 1 unexpected end of file: 4 vertices are announced, but only 3"},
        {"2000000000 2 0 0\n1 0 0\n2 1 0\n3 0 1\n", "3 1 unexpected end of file"},
        {"99999999999999999999999\n1 0 0\n", "3 1 unexpected end of file"},
        {"3\n1 0 0\n2 1\n3 0 1\n", "3 3 vertex 2 has no y coordinate"},
        {"3\n0 0 0\n1\n2\n", "3 3 vertex 1 has no x coordinate"},
        {"3\n1 0 0\n2 1 nan\n3 0 1\n", "3 3 vertex 2 has a y coordinate that is not a finite number"},
        {"3\n1 0 0\n2 NaN 2 7\n3 0 1\n", "3 3 vertex 2 has an x coordinate that is not a finite number"},
        {"3\n1 0 0\n2 nan(12) 7\n3 0 1\n", "3 3 vertex 2 has an x coordinate that is not a finite number"},
        {"3\n1 0 0\n2 1 inf\n3 0 1\n", "3 3 vertex 2 has a y coordinate that is not a finite number"},
        {"3\n1 0 0\n2 1 Infinity\n3 0 1\n", "3 3 vertex 2 has a y coordinate that is not a finite number"},
        {"3\n1 0 0\n2 1 -inf\n3 0 1\n", "3 3 vertex 2 has a y coordinate that is not a finite number"},
        {"3\n1 0 0\n2 1 -nan\n3 0 1\n", "3 3 vertex 2 has a y coordinate that is not a finite number"},
        {"3\n1 0 0\n2 1 1e400\n3 0 1\n", "3 3 vertex 2 has a y coordinate that is not a finite number"},
        {"3\n1 0 0\n2 1 -\n3 0 1\n", "3 3 vertex 2 has a y coordinate that is not a finite number"},
        {"3\n1 0 0\n2 1 #0\n3 0 1\n", "3 3 vertex 2 has no y coordinate"},
        {"3 2 1\n1 0 0 1\n2 1 0 nan\n3 0 1 2\n", "3 3 vertex 2 has an attribute that is not a finite number"},
        {"3 2 0 1\n1 0 0 1\n2 1 0 -\n3 0 1 2\n", "3 3 vertex 2 has a marker that is not a number"},
        {"5\n1 0 0\n2 1 0\n3\n4 1\n5 nan\n", "3 4 vertex 3 has no x coordinate"},
    };
    CHECK_EXAMPLES(NODE, examples);
}

static void poly_errors(void **state)
{
    (void)state;
    static const struct example examples[] = {
        {THREE, "3 4 unexpected end of file: the number of segments is missing"},
        {THREE "1 0\n1 1 2\n", "3 6 unexpected end of file: the number of holes is missing"},
        {THREE "2 0\n1 1 2\n", "3 5 unexpected end of file: 2 segments are announced, but only 1 records follow"},
        {THREE "1 0\n1 1\n0\n", "3 6 segment 1 has no second endpoint"},
        {THREE "1 0\n1\n0\n", "3 6 segment 1 has no endpoints"},
        {THREE "1 0\n1 1 .\n0\n", "3 6 segment 1 has an endpoint that is not a number"},
        {THREE "-1 0\n0\n", "3 5 the number of segments is negative"},
        {THREE "0 0\n1\n1 0\n", "3 7 hole 1 has no y coordinate"},
        {THREE "0 0\n1\n", "3 6 unexpected end of file: 1 holes are announced"},
        {"2\n1 0 0\n2 1 0\n0\n0\n", "3 1 there are only 2 vertices"},
        {"-1\n0\n0\n", "3 1 the number of vertices is negative"},
    };
    CHECK_EXAMPLES(POLY, examples);
    static const struct example with_regions[] = {
        {THREE "0\n0\n", "3 6 unexpected end of file: the number of regions is missing"},
        {THREE "0\n0\n1\n1 0 0\n", "3 8 region 1 has neither attribute nor area bound"},
        {THREE "0\n0\n1\n1 0\n", "3 8 region 1 has no y coordinate"},
        {THREE "0\n0\n1\n1 0 0 1 nan\n", "3 8 region 1 has an area bound that is not a finite number"},
    };
    CHECK_EXAMPLES(POLY_WITH_REGIONS, with_regions);
    static const struct example refining[] = {
        {THREE "2\n1 1 2\n2 1 4\n0\n", "3 7 segment 2 has an endpoint that is not the number of a vertex"},
    };
    CHECK_EXAMPLES(POLY_REFINING, refining);
}

static void ele_and_area_errors(void **state)
{
    (void)state;
    static const struct example elements[] = {
        {"1 2 0\n1 1 2\n", "3 1 the triangles have 2 nodes"},
        {"1 3 0\n1 1 2\n", "3 2 triangle 1 has fewer than three corners"},
        {"2 3 0\n1 1 2 3\n2 1 2 5\n", "3 3 triangle 2 has a corner that is not the number of a vertex"},
        {"1 3 0\n1 0 2 3\n", "3 2 triangle 1 has a corner that is not the number of a vertex"},
        {"1 3 0\n1 1 2 4294967297\n", "3 2 triangle 1 has a corner that is not the number of a vertex"},
        {"1 3 -1\n1 1 2 3\n", "3 1 the number of attributes is negative"},
        {"9 3 0\n1 1 2 3\n", "3 1 unexpected end of file"},
    };
    CHECK_EXAMPLES(ELE, elements);
    static const struct example areas[] = {
        {"2\n1 .5\n2 -1\n", "3 1 there are 2 area bounds, but 3 triangles"},
        {"3\n1 .5\n2 -1\n", "3 1 unexpected end of file"},
        {"3\n1 .5\n2 inf\n3\n", "3 3 area bound 2 is not a finite number"},
    };
    CHECK_EXAMPLES(AREA, areas);
}

static void missing_and_unreadable_files_are_refused(void **state)
{
    (void)state;
    unlink(node_path);
    check_file(NODE, "no file", "4 0 cannot open: ");
    assert_int_equal(mkdir(node_path, 0700), 0);
    check_file(NODE, "a directory", "4 0 cannot read: this is a directory");
    assert_int_equal(rmdir(node_path), 0);
    assert_int_equal(symlink("/dev/null", node_path), 0);
    check_file(NODE, "/dev/null", "3 1 unexpected end of file");
    unlink(node_path);
}

/* The size of a pipe is unknown. */
static void reads_from_a_pipe(void **state)
{
    (void)state;
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    const char text[] = THREE;
    assert_int_equal(write(ends[1], text, sizeof text - 1), sizeof text - 1);
    close(ends[1]);
    char path[32];
    snprintf(path, sizeof path, "/dev/fd/%d", ends[0]);
    if (access(path, R_OK) != 0)
        skip();
    struct tri_pslg pslg;
    int32_t base;
    assert_int_equal(tri_read_node(path, &varieties[0], &pslg, &base, NULL), TRI_OK);
    assert_int_equal(pslg.n_points, 3);
    tri_pslg_free(&pslg);
    close(ends[0]);
}

/* A NUL byte would end the number before it, so that UTF-16 text would be read as different numbers. */
static void nul_bytes_are_refused(void **state)
{
    (void)state;
    static const char text[] = "3 2 0 0\n1 0 0\n2 1\0002 0\n3 0 1\n";
    FILE *const file = fopen(node_path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, sizeof text - 1, file), sizeof text - 1);
    assert_int_equal(fclose(file), 0);
    struct tri_pslg pslg;
    struct tri_error error;
    int32_t base;
    assert_int_equal(tri_read_node(node_path, &varieties[0], &pslg, &base, &error), TRI_BAD_INPUT);
    assert_int_equal(error.line, 3);
    assert_null(pslg.points);
}

/* The length of a line is unlimited: this one is far longer than a chunk and than any buffer. */
static void long_line(void **state)
{
    (void)state;
    const size_t filler = 1 << 20 >> (is_full() ? 0 : 3);
    char *const text = malloc(filler + 100);
    assert_non_null(text);
    char *at = text + sprintf(text, "3 2 0 0\n1 0 ");
    memset(at, ' ', filler);
    at += filler;
    strcpy(at, "7\n2 1 0\n3 0 1\n");
    write_text(node_path, text);
    free(text);
    check_file(NODE, "a long line", "1 p:0 7 1 0 0 1");
}

/* Many records over many chunks. The table begins and ends inside chunks. */
static void large_file_in_chunks(void **state)
{
    (void)state;
    enum { N = 20000 };
    FILE *const file = fopen(poly_path, "w");
    assert_non_null(file);
    fprintf(file, "%d 2 1 1\n", N);
    for (int i = 0; i < N; i++)
        fprintf(file, "%s%d %.17g %.17g %d %d\n", i % 97 ? "" : "# comment\n\n", i, i / 7.0, -i / 3.0, i % 5, i % 3);
    fprintf(file, "%d 1\n", N - 1);
    for (int i = 0; i < N - 1; i++)
        fprintf(file, "%d %d %d %d\n", i, i, i + 1, i % 11);
    fprintf(file, "1\n0 .5 .5\n");
    fclose(file);
    for (size_t chunk = 50; chunk <= 500000; chunk *= 10) {
        const struct tri_read_options options = {.chunk_bytes = chunk, .executor = &backwards};
        struct tri_pslg pslg;
        int32_t base;
        bool points_in_poly;
        assert_int_equal(tri_read_poly(poly_path, NULL, &options, &pslg, &base, &points_in_poly, NULL), TRI_OK);
        for (int i = 0; i < N; i++) {
            assert_true(pslg.points[2 * i] == i / 7.0 && pslg.points[2 * i + 1] == -i / 3.0);
            assert_true(pslg.attributes[i] == i % 5 && pslg.markers[i] == i % 3);
        }
        for (int i = 0; i < N - 1; i++)
            assert_true(pslg.segments[2 * i] == i && pslg.segments[2 * i + 1] == i + 1 &&
                        pslg.segment_markers[i] == i % 11);
        assert_true(pslg.n_holes == 1 && pslg.holes[0] == .5);
        tri_pslg_free(&pslg);
    }
}

/* --- arbitrary bytes give a result or an error, the same for all chunks */

static uint32_t random_number(void)
{
    static uint32_t state = 2463534242u;
    state ^= state << 13;
    state ^= state >> 17;
    state ^= state << 5;
    return state;
}

static void mutate(char *bytes, size_t n)
{
    static const char alphabet[] = "0123456789+-.eExXnaif# \t\n\n\r\0,";
    const uint32_t n_changes = 1 + random_number() % 4;
    for (uint32_t i = 0; i < n_changes; i++)
        bytes[random_number() % n] =
            random_number() % 4 ? alphabet[random_number() % (sizeof alphabet - 1)] : (char)random_number();
}

static void mutated_bytes_are_harmless(void **state)
{
    (void)state;
    static const char seed[] = "4 2 1 1\n1 0 0 1.5 2\n2 1 0 2.5 1\n3 0 1 3.5\n4 1 1\n# c\n2 1\n1 1 2 3\n2 2 9 4\n"
                               "1\n1 .5 .5\n1\n1 0.25 1e-1 3 .5\n";
    write_text(node_path, "3\n0 0 0\n1 1 0\n2 0 1\n");
    for (int i = 0; i < 500; i++) {
        char bytes[sizeof seed];
        memcpy(bytes, seed, sizeof seed);
        mutate(bytes, sizeof seed - 1);
        const size_t n = random_number() % 4 ? sizeof seed - 1 : random_number() % sizeof seed;
        write_bytes(poly_path, bytes, n);
        struct dump first, other;
        read_kind(POLY_WITH_REGIONS, varieties[0], &first);
        read_kind(POLY_WITH_REGIONS, varieties[1 + random_number() % (LENGTH(varieties) - 1)], &other);
        assert_string_equal(first.text, other.text);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(node_lexical_rules),
        cmocka_unit_test(node_base),
        cmocka_unit_test(poly_sections),
        cmocka_unit_test(poly_takes_points_from_node),
        cmocka_unit_test(poly_warns_of_segments),
        cmocka_unit_test(ele_and_area),
        cmocka_unit_test(node_errors),
        cmocka_unit_test(poly_errors),
        cmocka_unit_test(ele_and_area_errors),
        cmocka_unit_test(missing_and_unreadable_files_are_refused),
        cmocka_unit_test(reads_from_a_pipe),
        cmocka_unit_test(nul_bytes_are_refused),
        cmocka_unit_test(long_line),
        cmocka_unit_test(large_file_in_chunks),
        cmocka_unit_test(mutated_bytes_are_harmless),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
