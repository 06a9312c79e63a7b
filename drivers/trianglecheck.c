/* trianglecheck: judges a mesh from its files, whoever made it. All judgement is triangle/check/check.h's; here are
 * arguments, files and lines of text. Exit code 0: no fault, 1: faults, 2: wrong usage or unreadable files. */
#include <errno.h>
#include <getopt.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "triangle/check/check.h"
#include "triangle/pslg.h"
#include "triangle/text/read.h"
#include "triangle/text/text.h"

enum { FAULTS = 1, TROUBLE = 2 };

static const char usage[] = "Usage: " PTRIANGLE_NAME " [options] BASE\n";

static const char help[] = /* in the form that cmake/help.awk makes a manual page of */
    "\n"
    "Checks the mesh in BASE.node and BASE.ele; also BASE.poly (subsegments) and BASE.neigh where they exist.\n"
    "\n"
    "  -p, --poly FILE      compare with the input that the mesh was made from, a .poly or .node file: its\n"
    "                       vertices come first and unmoved, its segments are chains of subsegments except where\n"
    "                       carved, its hole points lie outside, no vertex is lost\n"
    "  -q, --min-angle Q    angle bound in degrees; smaller angles are faults unless a small input angle explains\n"
    "                       them: the triangle touches a vertex where two subsegments meet at less than 60\n"
    "                       degrees (or a triangle next to it does), or has corners on both of them\n"
    "      --small-input-angle X  what is small there, instead of 60\n"
    "  -b, --max-bad N      instead: up to N triangles may be below the angle bound, for whatever reason\n"
    "  -a, --max-area A     area bound\n"
    "  -D, --conforming     all triangles truly Delaunay, diametral circles of subsegments empty (default:\n"
    "                       constrained)\n"
    "      --no-delaunay    no check of circles\n"
    "  -c, --convex         the mesh fills the convex hull of the vertices\n"
    "  -j, --jettisoned     unused input vertices were dropped: know input vertices by their coordinates\n"
    "      --keep-holes     hole points were ignored\n"
    "  -r, --refined        made by refining a mesh: hole points were ignored, unused vertices inside are no fault\n"
    "      --no-markers     do not compare the markers of subsegments\n"
    "      --json           report in JSON on standard output, instead of lines\n"
    "      --quiet          print faults only\n"
    "      --version, --help  name and version; this help\n"
    "\n"
    "Exit code: 0 no fault, 1 faults, 2 wrong usage or unreadable files (vertex numbers in BASE.ele that do not\n"
    "exist are found on reading). Numbers printed count as the files do.\n";

struct settings {
    const char *base; /* name without suffix */
    const char *input;
    struct tri_check_options check;
    bool ignore_markers, json, quiet;
};

struct files {
    struct tri_pslg mesh; /* points and subsegments */
    struct tri_elements elements;
    int32_t *neighbors;
    struct tri_pslg input;
    bool has_poly;
    int32_t base;
};

static int fail(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fputs(PTRIANGLE_NAME ": ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
    return TROUBLE;
}

static int fail_with(const struct tri_error *e)
{
    if (e->file[0] == '\0')
        return fail("%s", e->text);
    return e->line > 0 ? fail("%s:%ld: %s", e->file, e->line, e->text) : fail("%s: %s", e->file, e->text);
}

/* Stem + suffix, malloc'ed. */
static char *with_suffix(const char *stem, const char *suffix)
{
    size_t n = strlen(stem) + strlen(suffix) + 1;
    char *path = malloc(n);
    if (path != NULL)
        (void)snprintf(path, n, "%s%s", stem, suffix);
    return path;
}

/* Cuts one of the suffixes off. */
static bool cut_suffix(char *path, const char *suffix)
{
    size_t n = strlen(path), m = strlen(suffix);
    if (n <= m || strcmp(path + n - m, suffix) != 0)
        return false;
    path[n - m] = '\0';
    return true;
}

/* --- reading */

struct neighbor_rows {
    int32_t *neighbors;
    int32_t base;
};

static const char *read_neighbor_row(void *user, size_t i, struct tri_fields *fields)
{
    struct neighbor_rows *rows = user;
    int64_t value;
    if (tri_fields_integer(fields, &value) != TRI_FIELD_GOOD)
        return "has no number";
    for (size_t k = 0; k < 3; k++) {
        if (tri_fields_integer(fields, &value) != TRI_FIELD_GOOD)
            return "lacks a neighbor";
        if (value < -1 || value > INT32_MAX)
            return "has a neighbor that is no triangle";
        rows->neighbors[3 * i + k] = value < 0 ? -1 : (int32_t)value - rows->base;
    }
    return NULL;
}

static enum tri_status parse_neighbors(struct files *f, const struct tri_text *text, struct tri_error *error)
{
    struct tri_cursor cursor = tri_cursor_begin(text);
    struct tri_fields fields;
    int64_t n = 0;
    if (!tri_cursor_next(&cursor, &fields) || tri_fields_integer(&fields, &n) != TRI_FIELD_GOOD || n != f->elements.n ||
        tri_cursor_remaining(&cursor) < (size_t)n) {
        return tri_fail(error, TRI_BAD_INPUT, text->name, 1, "the number of triangles is not that of the .ele file");
    }
    f->neighbors = malloc(3 * ((size_t)n + 1) * sizeof *f->neighbors);
    if (f->neighbors == NULL)
        return tri_fail(error, TRI_NO_MEMORY, "", 0, "out of memory");
    struct neighbor_rows rows = {f->neighbors, f->base};
    struct tri_table table = {"triangle", (size_t)n, f->base, read_neighbor_row, &rows};
    return tri_cursor_table(&cursor, &table, NULL, error);
}

static enum tri_status read_neighbors(struct files *f, const char *path, struct tri_error *error)
{
    struct tri_text text = {0};
    enum tri_status status = tri_text_load(&text, path, 0, NULL, NULL, error);
    if (status == TRI_OK)
        status = parse_neighbors(f, &text, error);
    tri_text_free(&text);
    return status;
}

static enum tri_status read_mesh(struct files *f, const char *base, struct tri_error *error)
{
    struct tri_read_options options = {.default_base = 1};
    char *node = with_suffix(base, ".node"), *ele = with_suffix(base, ".ele");
    char *poly = with_suffix(base, ".poly"), *neigh = with_suffix(base, ".neigh");
    enum tri_status status = TRI_OK;
    if (node == NULL || ele == NULL || poly == NULL || neigh == NULL) {
        status = tri_fail(error, TRI_NO_MEMORY, "", 0, "out of memory");
    } else {
        bool points_in_poly;
        f->has_poly = access(poly, F_OK) == 0;
        status = f->has_poly ? tri_read_poly(poly, node, &options, &f->mesh, &f->base, &points_in_poly, error)
                             : tri_read_node(node, &options, &f->mesh, &f->base, error);
    }
    if (status == TRI_OK)
        status = tri_read_ele(ele, &options, f->base, f->mesh.n_points, &f->elements, error);
    if (status == TRI_OK && access(neigh, F_OK) == 0)
        status = read_neighbors(f, neigh, error);
    free(node);
    free(ele);
    free(poly);
    free(neigh);
    return status;
}

static enum tri_status read_input(struct files *f, const char *path, struct tri_error *error)
{
    struct tri_read_options options = {.default_base = f->base};
    int32_t base;
    bool points_in_poly;
    char *stem = with_suffix(path, "");
    if (stem == NULL)
        return tri_fail(error, TRI_NO_MEMORY, "", 0, "out of memory");
    if (cut_suffix(stem, ".node")) {
        free(stem);
        return tri_read_node(path, &options, &f->input, &base, error);
    }
    (void)cut_suffix(stem, ".poly");
    char *node = with_suffix(stem, ".node");
    free(stem);
    enum tri_status status = tri_read_poly(path, node, &options, &f->input, &base, &points_in_poly, error);
    free(node);
    return status;
}

/* --- judging */

/* Points that can be corners: those behind them are the nodes amid edges of six-node triangles, which are made last. */
static int32_t count_corner_points(const struct files *f)
{
    if (f->elements.n_nodes <= 3)
        return f->mesh.n_points;
    int32_t n = f->input.n_points < f->mesh.n_points ? f->input.n_points : f->mesh.n_points;
    for (size_t i = 0; i < 3 * (size_t)f->elements.n; i++) {
        if (f->elements.corners[i] >= n)
            n = f->elements.corners[i] + 1;
    }
    return n;
}

static enum tri_status judge(const struct settings *s, const struct files *f, struct tri_check_report *report,
                             struct tri_error *error)
{
    static const int32_t none[2] = {0, 0};
    struct tri_check_mesh mesh = {
        .n_points = count_corner_points(f),
        .points = f->mesh.points,
        .n_triangles = f->elements.n,
        .triangles = f->elements.corners != NULL ? f->elements.corners : none,
        .neighbors = f->neighbors,
    };
    if (f->has_poly) {
        mesh.n_segments = f->mesh.n_segments;
        mesh.segments = f->mesh.segments != NULL ? f->mesh.segments : none;
        mesh.segment_markers = s->ignore_markers ? NULL : f->mesh.segment_markers;
    }
    struct tri_check_options options = s->check;
    options.base = f->base;
    return tri_check(&mesh, s->input != NULL ? &f->input : NULL, &options, report, error);
}

/* --- telling */

static void print_items(const struct tri_check_report *r, bool quiet)
{
    for (int k = 0; k < TRI_N_CHECKS; k++) {
        const struct tri_check_item *item = &r->item[k];
        const char *name = tri_check_name((enum tri_check_kind)k);
        if (item->state == TRI_CHECK_FAILED) {
            printf("FAIL  %s: %" PRId64 ", first: %s\n", name, item->count, item->text);
        } else if (!quiet) {
            printf("%s  %s\n", item->state == TRI_CHECK_OK ? "ok  " : "-   ", name);
        }
    }
}

static void print_summary(const struct settings *s, const struct files *f, const struct tri_check_report *r)
{
    printf("vertices %ld (%" PRId64 " used), triangles %ld, edges %" PRId64 ", boundary edges %" PRId64
           ", subsegments %ld\n",
           (long)f->mesh.n_points, r->n_used_points, (long)f->elements.n, r->n_edges, r->n_boundary_edges,
           (long)f->mesh.n_segments);
    if (f->elements.n == 0)
        return;
    printf("angles: smallest %.10g (triangle %" PRId64 "), largest %.10g (triangle %" PRId64 ")\n", r->smallest_angle,
           r->smallest_angle_at + f->base, r->largest_angle, r->largest_angle_at + f->base);
    printf("areas: smallest %.10g (triangle %" PRId64 "), largest %.10g (triangle %" PRId64 "), total %.17g\n",
           r->smallest_area, r->smallest_area_at + f->base, r->largest_area, r->largest_area_at + f->base,
           r->total_area);
    if (s->check.min_angle <= 0)
        return;
    printf("angles below %g: %" PRId64, s->check.min_angle, r->n_small);
    if (r->n_small == 0) {
        puts("");
    } else if (r->n_small == r->n_small_explained) {
        puts(", all at small input angles");
    } else {
        printf(", %" PRId64 " of them at small input angles\n", r->n_small_explained);
    }
}

static void print_lines(const struct settings *s, const struct files *f, const struct tri_check_report *r)
{
    print_items(r, s->quiet);
    if (!s->quiet) {
        print_summary(s, f, r);
        puts(tri_check_passed(r) ? "no fault" : "FAULTS");
    }
}

static void print_json_string(const char *text)
{
    putchar('"');
    for (; *text != '\0'; text++) {
        if (*text == '"' || *text == '\\')
            putchar('\\');
        if ((unsigned char)*text >= ' ')
            putchar(*text);
    }
    putchar('"');
}

/* JSON has no infinities. */
static void print_json_real(const char *key, double value)
{
    printf(isfinite(value) ? ", \"%s\": %.17g" : ", \"%s\": null", key, value);
}

static void print_json(const struct settings *s, const struct files *f, const struct tri_check_report *r)
{
    static const char *const states[] = {"skipped", "ok", "failed"};
    printf("{\"passed\": %s, \"base\": ", tri_check_passed(r) ? "true" : "false");
    print_json_string(s->base);
    printf(", \"vertices\": %ld, \"used_vertices\": %" PRId64 ", \"triangles\": %ld, \"edges\": %" PRId64
           ", \"boundary_edges\": %" PRId64 ", \"subsegments\": %ld",
           (long)f->mesh.n_points, r->n_used_points, (long)f->elements.n, r->n_edges, r->n_boundary_edges,
           (long)f->mesh.n_segments);
    print_json_real("smallest_angle", r->smallest_angle);
    print_json_real("largest_angle", r->largest_angle);
    print_json_real("smallest_area", r->smallest_area);
    print_json_real("largest_area", r->largest_area);
    print_json_real("total_area", r->total_area);
    printf(", \"below_min_angle\": %" PRId64 ", \"below_min_angle_explained\": %" PRId64 ", \"checks\": [", r->n_small,
           r->n_small_explained);
    for (int k = 0; k < TRI_N_CHECKS; k++) {
        printf("%s{\"name\": \"%s\", \"state\": \"%s\", \"count\": %" PRId64 ", \"first\": ", k > 0 ? ", " : "",
               tri_check_name((enum tri_check_kind)k), states[r->item[k].state], r->item[k].count);
        print_json_string(r->item[k].text);
        putchar('}');
    }
    puts("]}");
}

/* --- arguments */

enum long_option { NO_DELAUNAY = 256, SMALL_INPUT_ANGLE, KEEP_HOLES, NO_MARKERS, JSON, QUIET, VERSION, HELP };

static const struct option long_options[] = {
    {"poly", required_argument, NULL, 'p'},
    {"min-angle", required_argument, NULL, 'q'},
    {"max-bad", required_argument, NULL, 'b'},
    {"max-area", required_argument, NULL, 'a'},
    {"conforming", no_argument, NULL, 'D'},
    {"no-delaunay", no_argument, NULL, NO_DELAUNAY},
    {"convex", no_argument, NULL, 'c'},
    {"jettisoned", no_argument, NULL, 'j'},
    {"keep-holes", no_argument, NULL, KEEP_HOLES},
    {"refined", no_argument, NULL, 'r'},
    {"small-input-angle", required_argument, NULL, SMALL_INPUT_ANGLE},
    {"no-markers", no_argument, NULL, NO_MARKERS},
    {"json", no_argument, NULL, JSON},
    {"quiet", no_argument, NULL, QUIET},
    {"version", no_argument, NULL, VERSION},
    {"help", no_argument, NULL, HELP},
    {NULL, 0, NULL, 0},
};

static bool parse_real(const char *text, double *value)
{
    char *end;
    *value = strtod(text, &end);
    return end != text && *end == '\0' && isfinite(*value) && *value >= 0;
}

static bool parse_count(const char *text, int64_t *value)
{
    char *end;
    errno = 0;
    *value = strtoll(text, &end, 10);
    return end != text && *end == '\0' && errno == 0 && *value >= 0;
}

/* Applies one option; false: not an option, or no value for it. */
static bool apply(struct settings *s, int option)
{
    switch (option) {
    case 'p':
        s->input = optarg;
        return true;
    case 'q':
        return parse_real(optarg, &s->check.min_angle);
    case 'b':
        return parse_count(optarg, &s->check.max_bad);
    case 'a':
        return parse_real(optarg, &s->check.max_area);
    case SMALL_INPUT_ANGLE:
        return parse_real(optarg, &s->check.small_input_angle);
    case 'D':
        s->check.delaunay = TRI_CHECK_CONFORMING;
        return true;
    case NO_DELAUNAY:
        s->check.delaunay = TRI_CHECK_NOT_DELAUNAY;
        return true;
    case 'c':
        s->check.convex = true;
        return true;
    case 'j':
        s->check.renumbered = true;
        return true;
    case KEEP_HOLES:
        s->check.ignore_holes = true;
        return true;
    case 'r':
        s->check.ignore_holes = s->check.ignore_lost = true;
        return true;
    case NO_MARKERS:
        s->ignore_markers = true;
        return true;
    case JSON:
        s->json = true;
        return true;
    case QUIET:
        s->quiet = true;
        return true;
    default:
        return false;
    }
}

/* 0: go on; < 0: done, with success; > 0: exit code. */
static int parse_arguments(int argc, char **argv, struct settings *s)
{
    int option;
    while ((option = getopt_long(argc, argv, "p:q:b:a:Dcjr", long_options, NULL)) != -1) {
        if (option == HELP || option == VERSION) {
            fputs(option == HELP ? usage : PTRIANGLE_NAME " " PTRIANGLE_VERSION "\n", stdout);
            fputs(option == HELP ? help : "", stdout);
            return -1;
        }
        if (option == '?') {
            fputs(usage, stderr);
            return TROUBLE;
        }
        if (!apply(s, option))
            return fail("not a value for this option: %s", optarg);
    }
    if (optind + 1 != argc) {
        fputs(usage, stderr);
        return TROUBLE;
    }
    (void)(cut_suffix(argv[optind], ".node") || cut_suffix(argv[optind], ".ele"));
    s->base = argv[optind];
    return 0;
}

static int run(const struct settings *s, struct files *f)
{
    struct tri_error error = {0};
    struct tri_check_report report;
    enum tri_status status = read_mesh(f, s->base, &error);
    if (status == TRI_OK && s->input != NULL)
        status = read_input(f, s->input, &error);
    if (status == TRI_OK)
        status = judge(s, f, &report, &error);
    if (status != TRI_OK)
        return fail_with(&error);
    (s->json ? print_json : print_lines)(s, f, &report);
    if (fflush(stdout) != 0 || ferror(stdout))
        return fail("cannot write to standard output");
    return tri_check_passed(&report) ? EXIT_SUCCESS : FAULTS;
}

int main(int argc, char **argv)
{
    struct settings settings = {.check = {.max_bad = -1}};
    struct files files = {0};
    int code = parse_arguments(argc, argv, &settings);
    if (code != 0)
        return code < 0 ? EXIT_SUCCESS : code;
    code = run(&settings, &files);
    tri_pslg_free(&files.mesh);
    tri_elements_free(&files.elements);
    free(files.neighbors);
    tri_pslg_free(&files.input);
    return code;
}
