/* trianglecheck: checks a mesh in files, made by any program. triangle/check/check.h does the checking; this file
 * handles arguments, files and printing. Exit code 0: no fault, 1: faults, 2: wrong usage or unreadable files. */
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drivers/judge/judged_files.h"
#include "drivers/judge/judged_sizes.h"
#include "drivers/start.h"
#include "drivers/words.h"
#include "sched/schedule/threads.h"
#include "triangle/base/size_text.h"
#include "triangle/base/system.h"
#include "triangle/check/check.h"
#include "triangle/text/decimal.h"
#include "triangle/text/names.h"

enum { FAULTS = 1, TROUBLE = 2, WORTH_THREADS = 1 << 15 };

static const char usage[] = "Usage: " PTRIANGLE_NAME " [options] BASE\n";

static const char help[] = /* cmake/help.awk turns it into a manual page */
    "\n"
    "Checks the mesh in BASE.node and BASE.ele; also BASE.poly (subsegments) and BASE.neigh if they exist. BASE can\n"
    "also be the name of one file that ptriangle has written: .h5, .vtkhdf, .vtu, .msh, .2dm, .14 or .grd. The last\n"
    "three contain only the boundary. For them subsegments and regions are not compared, and circles only with -D.\n"
    "Vertices in no triangle cause a warning, not a fault. In triangles with six nodes each edge must have one node\n"
    "at its midpoint. This node has the marker of the edge's subsegment and the mean of the attributes at both ends.\n"
    "\n"
    "  -p, --poly FILE      compare with the input of the mesh, a .poly or .node file. Its vertices must come first,\n"
    "                       unmoved, and none may be lost. Its segments must be chains of subsegments, except\n"
    "                       outside the mesh or within rounding error of its boundary. Its hole points must lie\n"
    "                       outside. Its vertices keep their attributes, if the mesh has any; attributes of new\n"
    "                       vertices lie in the range of the input's\n"
    "  -q, --min-angle Q    angle bound in degrees. A smaller angle is a fault unless a small input angle explains\n"
    "                       it. It does if the triangle, or one next to it, touches a vertex where two subsegments\n"
    "                       meet at less than 60 degrees, or if the triangle has corners on both subsegments\n"
    "      --small-input-angle X  limit for small input angles, instead of 60 degrees\n"
    "  -b, --max-bad N      allow up to N triangles below the angle bound, instead of looking for reasons\n"
    "  -a, --max-area A     area bound\n"
    "  -D, --conforming     all triangles must be Delaunay, and diametral circles of subsegments empty (default:\n"
    "                       constrained Delaunay)\n"
    "      --no-delaunay    do not check circles\n"
    "  -c, --convex         the mesh must fill the convex hull of the vertices, within 16 units in the last place of\n"
    "                       the largest coordinate, because vertices on edges of the hull are rounded\n"
    "      --keep-hull      the mesh was made with -c: it may end at the convex hull of the vertices, not only at\n"
    "                       segments\n"
    "  -j, --jettisoned     unused input vertices were left out: find input vertices by their coordinates\n"
    "      --keep-holes     hole points were ignored\n"
    "      --any-holes      faces may be empty without a hole point: another rule selected the holes\n"
    "  -r, --refined        the mesh was made by refining a mesh: hole points were ignored, unused vertices inside\n"
    "                       are no fault, and the mesh may end anywhere\n"
    "      --no-markers     do not compare the markers of subsegments and vertices\n"
    "      --no-regions     do not compare the attributes of triangles with the input's regions\n"
    "      --size, --size-near, --gradation, --min-size, --max-size, --elements-across, --per-circle, --min-edge\n"
    "                       the options of ptriangle that the mesh was made with, and --poly. The report then has\n"
    "                       the share of edges that are 0.7 to 1.4 times as long as the length at their midpoint,\n"
    "                       the triangles divided by the number that the lengths request, and the mean quality: 4\n"
    "                       sqrt(3) area / sum of squared edges. Area bounds of regions do not change lengths here.\n"
    "                       This takes 16 bytes of memory per vertex and 48 per triangle, beyond --memory.\n"
    "                       With --min-edge the mesh is compared with the simplified input\n"
    "      --region-polygons FILE.geojson  compare with the input divided by these polygons. The input may also be a\n"
    "                       .geojson file\n"
    "      --min-fitting S  a smaller share of such edges (0.95) is a fault\n";

static const char more_help[] =
    "      --threads N      use at most N threads (default: OMP_NUM_THREADS, otherwise all cores). The result is the\n"
    "                       same\n"
    "      --memory SIZE    memory to use: 500M, 4G (K, M, G, T: powers of 1000), or 60% of the free memory\n"
    "                       (default: 80%). A larger mesh is checked part by part, with the same result. The\n"
    "                       boundary, segments and input, and a byte for each vertex, always stay in memory. If\n"
    "                       these do not fit, the program reports an error\n"
    "      --scratch DIR    folder for data that do not fit into memory (default: TMPDIR, otherwise /tmp): the\n"
    "                       numbers of text files, 20 bytes per vertex and 24 per triangle, more with attributes,\n"
    "                       neighbours or six nodes\n"
    "      --json           print the report as JSON instead of lines\n"
    "      --quiet          print faults only\n"
    "      --version, --help  print name and version; print this help\n"
    "\n"
    "Exit code: 0 for no fault, 1 for faults, 2 for wrong usage or unreadable files (including vertex numbers in\n"
    "BASE.ele that do not exist). Printed numbers count from 0 or 1, as the files do.\n";

struct settings {
    const char *base; /* base name, or name of one file */
    bool is_base;     /* a suffix was removed */
    const char *input;
    struct tri_check_options check;
    bool ignore_markers, ignore_regions, json, quiet;
    int64_t threads; /* 0: not given */
    double memory, memory_share; /* bytes, or a share of the free memory; 0: not given */
    const char *scratch;         /* folder; NULL: not given */
    struct size_options sizes; /* the wanted lengths, and --min-edge */
    double min_fitting; /* share of edges; 0: not given */
};

struct verdict {
    struct tri_check_report report; /* of the mesh itself */
    struct judged_sizes sizes; /* n_edges is 0: not measured */
};

/* --- checking */

/* Returns the bytes that the process may use: the requested number, or a share of the free memory. */
static double memory_to_use(const struct settings *s)
{
    enum { USUAL_PERCENT = 80 };
    if (s->memory > 0)
        return s->memory;
    return tri_memory_left() * (s->memory_share > 0 ? s->memory_share : USUAL_PERCENT / 100.0);
}

/* Bytes for the program itself: code, stacks, reserves of allocators. */
static const double TO_COME = 4e6;

/* Checks that the data that stay in memory leave room for the parts and for the program itself. */
static enum tri_status check_memory(const struct judged_files *f, const struct tri_pslg *input, struct tri_error *error)
{
    const double needed = tri_check_bound(&f->source, tri_check_least_bytes(&f->source, input));
    if (f->source.memory <= 0 || needed <= f->source.memory)
        return TRI_OK;
    return tri_fail(error, TRI_NO_MEMORY, "", 0,
                    "to judge %s vertices and %s subsegments, and what they are compared with, takes about %s of "
                    "memory; %s may be used", tri_count_text((double)f->source.n_points).text,
                    tri_count_text((double)f->source.n_segments).text, tri_size_text(needed).text,
                    tri_size_text(f->source.memory).text);
}

static enum tri_status judge(const struct settings *s, struct judged_files *f, const struct tri_executor *executor,
                             int threads, struct tri_check_report *report, struct tri_error *error)
{
    unsigned ignored = 0;
    if (s->ignore_markers)
        ignored |= 1u << TRI_CHECK_POINT_MARKERS | 1u << TRI_CHECK_SEGMENT_MARKERS;
    if (s->ignore_regions)
        ignored |= 1u << TRI_CHECK_ATTRIBUTES;
    f->source.given &= ~ignored;
    struct tri_check_options options = s->check;
    options.base = f->base;
    options.renumbered = options.renumbered || f->for_solvers;
    if (f->boundary_alone && options.delaunay == TRI_CHECK_CONSTRAINED)
        options.delaunay = TRI_CHECK_NOT_DELAUNAY; /* it is not known which edges inside are segments */
    if (f->source.n_triangles >= WORTH_THREADS) {
        options.executor = executor;
        options.n_threads = threads;
    }
    const struct tri_pslg *input = s->input != NULL ? &f->input : NULL;
    f->source.beside = tri_memory_used(NULL) + TO_COME;
    enum tri_status status = check_memory(f, input, error);
    return status != TRI_OK ? status : tri_check_from(&f->source, input, &options, report, error);
}

/* --- the report as lines or JSON */

/* Returns true if the lengths were measured and too few edges fit. */
static bool fails_sizes(const struct settings *s, const struct judged_sizes *sizes)
{
    return sizes->n_edges > 0 && judged_sizes_fitting(sizes) < s->min_fitting;
}

static bool passes(const struct settings *s, const struct verdict *v)
{
    return tri_check_passed(&v->report) && !fails_sizes(s, &v->sizes);
}

static void print_sizes(const struct settings *s, const struct judged_sizes *sizes)
{
    if (fails_sizes(s, sizes))
        printf("FAIL  lengths: %" PRId64 " of %" PRId64 " edges are not %g to %g times as long as wanted\n",
               sizes->n_edges - sizes->n_fitting, sizes->n_edges, JUDGED_SHORTEST, JUDGED_LONGEST);
    else if (!s->quiet && sizes->n_edges > 0 && s->min_fitting > 0)
        puts("ok    lengths");
    if (!s->quiet && sizes->note[0])
        printf("warn  %s\n", sizes->note);
}

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

static void print_summary(const struct settings *s, const struct judged_files *f, const struct tri_check_report *r)
{
    printf("vertices %" PRId64 " (%" PRId64 " used), triangles %" PRId64 ", edges %" PRId64 ", boundary edges %" PRId64
           ", subsegments %" PRId64 "\n",
           f->n_nodes, r->n_used_points, f->source.n_triangles, r->n_edges, r->n_boundary_edges, f->source.n_segments);
    if (f->source.n_triangles == 0)
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

/* Returns the number of unused points, which make the matrix of a solver singular; 0 without triangles. */
static int64_t unused_points(const struct judged_files *f, const struct tri_check_report *r)
{
    return r->n_used_points > 0 ? f->source.n_points - r->n_used_points : 0;
}

static void print_lines(const struct settings *s, const struct judged_files *f, const struct verdict *v)
{
    const struct tri_check_report *r = &v->report;
    print_items(r, s->quiet);
    print_sizes(s, &v->sizes);
    if (!s->quiet) {
        if (unused_points(f, r) > 0)
            printf("warn  vertices in no triangle: %" PRId64 " (-j of ptriangle leaves them out)\n",
                   unused_points(f, r));
        print_summary(s, f, r);
        if (v->sizes.n_edges > 0)
            printf("lengths: %.4f of the edges fit, %.4f times the wanted number of triangles, mean quality %.4f\n",
                   judged_sizes_fitting(&v->sizes), v->sizes.number, v->sizes.quality);
        puts(passes(s, v) ? "no fault" : "FAULTS");
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

/* JSON has no infinity. */
static void print_json_real(const char *key, double value)
{
    printf(isfinite(value) ? ", \"%s\": %.17g" : ", \"%s\": null", key, value);
}

static void print_json(const struct settings *s, const struct judged_files *f, const struct verdict *v)
{
    const struct tri_check_report *r = &v->report;
    static const char *const states[] = {"skipped", "ok", "failed"};
    printf("{\"passed\": %s, \"base\": ", passes(s, v) ? "true" : "false");
    print_json_string(s->base);
    printf(", \"vertices\": %" PRId64 ", \"used_vertices\": %" PRId64 ", \"unused_vertices\": %" PRId64
           ", \"triangles\": %" PRId64 ", \"edges\": %" PRId64 ", \"boundary_edges\": %" PRId64
           ", \"subsegments\": %" PRId64,
           f->n_nodes, r->n_used_points, unused_points(f, r), f->source.n_triangles, r->n_edges,
           r->n_boundary_edges, f->source.n_segments);
    print_json_real("smallest_angle", r->smallest_angle);
    print_json_real("largest_angle", r->largest_angle);
    print_json_real("smallest_area", r->smallest_area);
    print_json_real("largest_area", r->largest_area);
    print_json_real("total_area", r->total_area);
    if (v->sizes.n_edges > 0) {
        print_json_real("fitting", judged_sizes_fitting(&v->sizes));
        if (s->min_fitting > 0)
            print_json_real("min_fitting", s->min_fitting);
        print_json_real("triangles_per_wanted", v->sizes.number);
        print_json_real("mean_quality", v->sizes.quality);
    }
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

enum long_option {
    NO_DELAUNAY = 256,
    SMALL_INPUT_ANGLE,
    KEEP_HOLES,
    ANY_HOLES,
    KEEP_HULL,
    NO_MARKERS,
    NO_REGIONS,
    THREADS,
    MEMORY,
    SCRATCH,
    MIN_FITTING,
    JSON,
    QUIET,
    VERSION,
    HELP
};

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
    {"any-holes", no_argument, NULL, ANY_HOLES},
    {"keep-hull", no_argument, NULL, KEEP_HULL},
    {"threads", required_argument, NULL, THREADS},
    {"refined", no_argument, NULL, 'r'},
    {"small-input-angle", required_argument, NULL, SMALL_INPUT_ANGLE},
    {"no-markers", no_argument, NULL, NO_MARKERS},
    {"no-regions", no_argument, NULL, NO_REGIONS},
    {"memory", required_argument, NULL, MEMORY},
    {"scratch", required_argument, NULL, SCRATCH},
    {"min-fitting", required_argument, NULL, MIN_FITTING},
    {"json", no_argument, NULL, JSON},
    {"quiet", no_argument, NULL, QUIET},
    {"version", no_argument, NULL, VERSION},
    {"help", no_argument, NULL, HELP},
    {NULL, 0, NULL, 0},
};

/* Reads a whole number >= 0. */
static bool take_count(const char *text, int64_t *value)
{
    const char *end = text + strlen(text);
    return end != text && tri_scan_integer(text, end, value) == end && *value >= 0;
}

static bool take_real(const char *text, double *value)
{
    return words_take_real(text, "", NULL, 0, DBL_MAX, value);
}

/* Applies an option without value. Returns false if there is no such option. */
static bool apply_flag(struct settings *s, int option)
{
    switch (option) {
    case 'D': s->check.delaunay = TRI_CHECK_CONFORMING; break;
    case NO_DELAUNAY: s->check.delaunay = TRI_CHECK_NOT_DELAUNAY; break;
    case 'c': s->check.convex = true; break;
    case 'j': s->check.renumbered = true; break;
    case KEEP_HOLES: s->check.ignore_holes = true; break;
    case ANY_HOLES: s->check.any_holes = true; break;
    case KEEP_HULL: s->check.border = TRI_CHECK_BORDER_HULL; break;
    case NO_MARKERS: s->ignore_markers = true; break;
    case NO_REGIONS: s->ignore_regions = true; break;
    case JSON: s->json = true; break;
    case QUIET: s->quiet = true; break;
    case 'r':
        s->check.ignore_holes = s->check.ignore_lost = true;
        s->check.border = TRI_CHECK_BORDER_ANY;
        break;
    default: return false;
    }
    return true;
}

/* Applies one option. Returns false if the option or its value is invalid. */
static bool apply(void *settings, int option)
{
    struct settings *s = settings;
    switch (option) {
    case 'p': s->input = optarg; return true;
    case 'q': return take_real(optarg, &s->check.min_angle);
    case 'b': return take_count(optarg, &s->check.max_bad);
    case 'a': return take_real(optarg, &s->check.max_area);
    case SMALL_INPUT_ANGLE: return take_real(optarg, &s->check.small_input_angle);
    case MIN_FITTING: return words_take_real(optarg, "", NULL, 0, 1, &s->min_fitting);
    case THREADS: return take_count(optarg, &s->threads) && s->threads > 0;
    case MEMORY: return words_take_size(optarg, 1, &s->memory, &s->memory_share);
    case SCRATCH: s->scratch = optarg; return true;
    default: return apply_flag(s, option);
    }
}

/* Removes the size options from the arguments. Returns the number of arguments that remain; 0: *error is set. */
static int take_sizes(int argc, char **argv, struct size_options *sizes, struct tri_error *error)
{
    int n = 0;
    bool ended = false; /* by -- */
    for (int i = 0; i < argc; i++) {
        ended = ended || strcmp(argv[i], "--") == 0;
        if (ended || !size_options_take(sizes, NULL, argc, argv, &i, error))
            argv[n++] = argv[i];
        if (error->status)
            return 0;
    }
    argv[n] = NULL;
    return size_options_end(sizes, NULL, error) ? 0 : n;
}

/* Returns 0 to go on, < 0 if the program is done, > 0: the exit code. */
static int parse_arguments(int argc, char **argv, struct settings *s)
{
    static const struct program_words words = {PTRIANGLE_NAME, PTRIANGLE_NAME " " PTRIANGLE_VERSION "\n", usage, help,
                                              "-:p:q:b:a:Dcjr", long_options, VERSION, HELP, apply, more_help};
    char *mesh = NULL;
    struct tri_error error = {0};
    argc = take_sizes(argc, argv, &s->sizes, &error);
    if (argc == 0) {
        one_line_error(stderr, PTRIANGLE_NAME ": ", &error);
        return TROUBLE;
    }
    enum words_end end = words_take_all(&words, argc, argv, s, &mesh);
    if (end != WORDS_TAKEN)
        return end == WORDS_ANSWERED ? -1 : TROUBLE;
    s->is_base = judged_cut_text_suffix(mesh);
    s->base = mesh;
    const bool measures = size_options_any(&s->sizes);
    if (s->input && tri_name_ends(s->input, ".geojson")) {
        if (s->sizes.region_polygons) {
            fputs(PTRIANGLE_NAME ": --region-polygons is for inputs other than .geojson\n", stderr);
            return TROUBLE;
        }
        s->sizes.region_polygons = s->input;
    }
    const bool changes = s->sizes.min_edge > 0 || s->sizes.region_polygons;
    if (((measures || changes) && !s->input) || (s->min_fitting > 0 && !measures)) {
        fputs(!s->input ? PTRIANGLE_NAME ": lengths, --min-edge and --region-polygons need the input of the"
                                          " mesh: --poly\n"
                       : PTRIANGLE_NAME ": --min-fitting needs --size or another source of lengths\n", stderr);
        return TROUBLE;
    }
    return 0;
}

static int run(const struct settings *s, struct par_team *team, struct judged_files *f)
{
    struct tri_error error = {0};
    struct verdict verdict = {0};
    const int threads = team->threads;
    const struct tri_executor executor = par_executor(team);
    const char *scratch = s->scratch != NULL ? s->scratch : tri_scratch_folder();
    struct judged_request ask = {.base = s->base, .is_base = s->is_base, .input = s->input, .memory = memory_to_use(s),
                             .scratch = scratch, .executor = &executor};
    enum tri_status status = judged_read(f, &ask, &error);
    if (f->stale_neighbors) {
        fputs(PTRIANGLE_NAME ": ", stderr);
        one_line_put(stderr, s->base);
        fputs(".neigh is of another mesh than .ele, by their numbers of triangles: it is not judged\n", stderr);
    }
    struct tri_options how = tri_defaults();
    char changes[CHANGED_TEXT] = "";
    how.keep_hull = s->check.border == TRI_CHECK_BORDER_HULL;
    how.ignore_holes = s->check.ignore_holes;
    how.even_odd = s->check.any_holes;
    how.executor = &executor;
    if (status == TRI_OK && s->input)
        status = size_options_divide(&s->sizes, &f->input, &how, changes, &error);
    if (status == TRI_OK && s->input)
        status = size_options_simplify(&s->sizes, &f->input, &executor, NULL, changes, &error);
    if (status == TRI_OK && changes[0] && !s->json && !s->quiet)
        printf("input: %s\n", changes);
    if (status == TRI_OK)
        status = judge(s, f, &executor, threads, &verdict.report, &error);
    if (status == TRI_OK && size_options_any(&s->sizes) && verdict.report.item[TRI_CHECK_ARRAYS].state == TRI_CHECK_OK)
        status = judged_sizes_measure(&verdict.sizes, &s->sizes, f, &s->check, &executor, &error);
    if (status != TRI_OK) {
        one_line_error(stderr, PTRIANGLE_NAME ": ", &error);
        return TROUBLE;
    }
    (s->json ? print_json : print_lines)(s, f, &verdict);
    if (fflush(stdout) == 0 && !ferror(stdout))
        return passes(s, &verdict) ? EXIT_SUCCESS : FAULTS;
    fputs(PTRIANGLE_NAME ": cannot write to standard output\n", stderr);
    return TROUBLE;
}

const int program_trouble = TROUBLE;
const char program_version[] = PTRIANGLE_VERSION;

int program_main(int argc, char **argv)
{
    struct settings settings = {.check = {.max_bad = -1}};
    struct judged_files files = {0};
    int code = parse_arguments(argc, argv, &settings);
    if (code != 0) {
        size_options_free(&settings.sizes);
        return code < 0 ? EXIT_SUCCESS : code;
    }
    const int most = PAR_MOST_THREADS;
    struct par_team team = {.threads = par_threads(settings.threads < most ? (int)settings.threads : most, false)};
    code = run(&settings, &team, &files);
    par_team_end(&team);
    judged_files_free(&files);
    size_options_free(&settings.sizes);
    return code;
}
