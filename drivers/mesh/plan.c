/* Decides whether the machine can make the requested mesh, and how.
 *
 * RULE. If a sure estimate exceeds the limits, the run is refused; if a likely estimate does, there is a warning. Area
 * bounds give a sure number of triangles, angle bounds a likely one. A likely estimate also refuses the run in two
 * cases: against a bound that somebody has set (--memory, or a limit of the process), and against the capacity of a
 * mesh if areas decide, because the mesh would fail there after all the work. A mesh that fits stays in memory, which
 * is faster. */
#include "drivers/mesh/plan.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "triangle/base/size_text.h"
#include "triangle/base/system.h"

/* Factors by which a mesh in memory may exceed its estimate: in general; with a strict bound; and, in addition, with
 * angles above 31 degrees, or with empty diametral circles, which are hardest to estimate. Less than WORTH_A_LOOK bytes
 * are not checked. */
static const double MARGIN = 1.15, STRICT_MARGIN = 1.5, STEEP_MARGIN = 2.5, CONFORMING_MARGIN = 4, WORTH_A_LOOK = 2e7;

/* Areas decide if the mesh has hardly more triangles than they require; usually 1.14 times as many. Up to this share of
 * the capacity a mesh surely fits, since blocks leave some places unused. */
static const double AREAS_DECIDE = 1.3, SURELY_ONE_MESH = 0.8;

/* Measured: bytes of the process; of text that is being written while the input is triangulated, per point and at most;
 * and the sure share of the bytes for triangulating. */
static const double PROCESS_BYTES = 1.2e7, TEXT_BYTES = 60, MOST_TEXT = 6e6, SURE_SHARE = 0.7;

/* Measured: bytes that are allocated for writing files, used or not. */
static const double BUFFER_BYTES = 3e7;

/* Returns true if there is a strict bound: --memory, or a limit of the process (ulimit -v) beyond which allocations
 * fail. */
static bool is_strict(const struct run *run)
{
    return run->settings.options->memory > 0 || tri_memory_nearest_limit() != TRI_LIMIT_SYSTEM;
}

/* Limits of a process count all allocations, including unused parts of stacks and buffers. */
static double system_memory_left(const struct run *run)
{
    const bool counts_all = tri_memory_nearest_limit() != TRI_LIMIT_SYSTEM;
    const double untouched = counts_all ? tri_memory_of_stacks(run->settings.threads) + BUFFER_BYTES : 0;
    return fmax(tri_memory_left() - untouched, 0);
}

double plan_memory_left(const struct run *run)
{
    double allowed = run->settings.options->memory, left = system_memory_left(run);
    return allowed > 0 ? fmin(left, fmax(allowed - tri_memory_used(NULL), 0)) : left;
}

/* --- the input */

/* The arrays read from a text need at most about as much memory as the text, which is freed before the next is read. */
enum tri_status plan_check_files(const struct run *run, const struct file_names *files)
{
    struct tri_file_facts facts;
    double size = 0;
    for (int i = 0; i < files->n; i++)
        size += tri_path_get_facts(files->name[i], &facts) ? (double)facts.size : 0;
    if (size < WORTH_A_LOOK && !is_strict(run))
        return TRI_OK;
    const double left = plan_memory_left(run);
    if (size > left)
        return tri_fail(run->error, TRI_NO_MEMORY, NULL, 0,
                        "the input has %s of text, which is read into memory; %s are left", tri_size_text(size).text,
                        tri_size_text(left).text);
    return TRI_OK;
}

/* Returns the memory for writing HDF5 if the mesh is not refined, in addition to the mesh itself; otherwise 0. */
static double unrefined_streams(const struct run *run)
{
    const double triangles = run->input.elements.n > 0 ? run->input.elements.n : 2.0 * run->input.pslg.n_points;
    return run->options.refine ? 0 : estimate_streams(run, triangles);
}

/* Returns the peak memory, with the input that has been read. After its construction, the mesh takes half of `made`. */
static double input_bytes(const struct run *run)
{
    const struct run_input *input = &run->input;
    const double made = tri_generate_bytes(&input->pslg, &input->elements, run->options.refine) +
                        fmin(TEXT_BYTES * input->pslg.n_points, MOST_TEXT);
    return PROCESS_BYTES + fmax(made, made / 2 + unrefined_streams(run));
}

enum tri_status plan_check_input(const struct run *run)
{
    const double needed = input_bytes(run);
    if (needed < WORTH_A_LOOK && !is_strict(run))
        return TRI_OK;
    const double all = tri_memory_used(NULL) + plan_memory_left(run);
    if ((is_strict(run) ? needed : SURE_SHARE * needed) > all)
        return tri_fail(run->error, TRI_NO_MEMORY, NULL, 0,
                        "to triangulate the input, %s points and %s segments,%s takes about %s of memory; there are %s",
                        tri_count_text(run->input.pslg.n_points).text, tri_count_text(run->input.pslg.n_segments).text,
                        unrefined_streams(run) > 0 ? " and write it as HDF5," : "",
                        tri_size_text(needed).text, tri_size_text(all).text);
    if (needed > all)
        console_warn(&run->console, "to triangulate the input may take about %s of memory; there are %s.\n",
                     tri_size_text(needed).text, tri_size_text(all).text);
    return TRI_OK;
}

/* --- features that need the whole mesh */

static const char *by_switches(const struct tri_switches *s)
{
    const struct {
        bool given;
        const char *name;
    } asks[] = {
        {s->edges, "-e (edges)"},           {s->voronoi, "-v (Voronoi diagram)"},
        {s->neighbors, "-n (neighbours)"},  {s->off, "-g (.off)"},
        {s->second_order, "-o2"},           {s->jettison, "-j"},
        {s->check, "-C (self check)"},      {s->verbosity > 0, "-V (shapes)"},
    };
    for (size_t i = 0; i < sizeof asks / sizeof *asks; i++)
        if (asks[i].given)
            return asks[i].name;
    return NULL;
}

static const char *by_options(const struct long_options *o)
{
    return o->blocks ? "--blocks" : o->by_block ? "--numbering blocks" : o->write_partial ? "--write-partial" : NULL;
}

/* Returns the feature that needs the whole mesh in memory, such as "-n (neighbours)"; "": the program itself; NULL:
 * none, the mesh can be swept. */
static const char *obstacle_of(const struct run *run)
{
    if (run->settings.threads == 0)
        return "";
    if (!run->options.refine)
        return "no bounds";
    if (run->report.loose > 0)
        return "segments that are no edges of the mesh";
    const char *by_option = by_options(run->settings.options);
    return by_option ? by_option : by_switches(&run->arguments->switches);
}

/* --- refusals and warnings */

static enum tri_status fail_too_many(const struct run *run, const struct needs *n, bool sure, const char *why)
{
    return tri_fail(run->error, TRI_TOO_LARGE, NULL, 0,
                    "the %sbounds ask for %s %s triangles, and a mesh holds %s%s%s", sure ? "area " : "",
                    sure ? "at least" : "about", tri_count_text(n->triangles).text,
                    tri_count_text(TRI_MAX_TRIANGLES).text,
                    *why ? " where it must be there as a whole, as for " : "", why);
}

/* why: the reason why all triangles must be in memory. */
static enum tri_status check_number(const struct run *run, const struct estimate *e, const char *why)
{
    const double most = TRI_MAX_TRIANGLES, likely = e->likely.triangles, least = e->least.triangles;
    if (least > most)
        return fail_too_many(run, &e->least, true, why);
    if (likely > most && likely <= AREAS_DECIDE * least)
        return fail_too_many(run, &e->likely, false, why);
    if (likely > most)
        console_warn(&run->console, "the bounds may ask for more triangles than the %s that a mesh holds.\n",
                     tri_count_text(most).text);
    return TRI_OK;
}

/* Suggests a sufficient --memory, if that is the limit. */
static void suggest(const struct run *run, double needed, char *text, size_t size)
{
    *text = 0;
    if (run->settings.options->memory > 0 && needed <= system_memory_left(run))
        snprintf(text, size, "; --memory %.0fM would do", ceil(1e-6 * (tri_memory_used(NULL) + needed)) + 1);
}

static enum tri_status fail_memory(const struct run *run, const struct needs *n, bool sure, double needed, double left,
                                   const char *obstacle)
{
    char would_do[64];
    suggest(run, needed, would_do, sizeof would_do);
    return tri_fail(run->error, TRI_NO_MEMORY, NULL, 0,
                    "the %sbounds ask for %s %s triangles, which take %s of memory; %s are left%s%s%s",
                    sure ? "area " : "", sure ? "at least" : "about", tri_count_text(n->triangles).text,
                    tri_size_text(needed).text, tri_size_text(left).text, would_do,
                    *obstacle ? "; less would do but for " : "", obstacle);
}

/* least, likely: bytes of memory. If the likely estimate refuses, it is used for the message, so that a user who sets
 * the suggested value is not refused again. */
static enum tri_status check_memory(const struct run *run, const struct estimate *e, double least, double likely,
                                    double left, const char *obstacle)
{
    if (is_strict(run) && likely > left && likely >= least)
        return fail_memory(run, &e->likely, false, likely, left, obstacle);
    if (least > left)
        return fail_memory(run, &e->least, true, least, left, obstacle);
    if (likely > left)
        console_warn(&run->console, "the bounds may take about %s of memory; %s are left.\n",
                     tri_size_text(likely).text, tri_size_text(left).text);
    return TRI_OK;
}

static enum tri_status check_whole(const struct run *run, const struct estimate *e, double left, const char *obstacle)
{
    obstacle = obstacle ? obstacle : "";
    enum tri_status status = check_number(run, e, obstacle);
    if (status)
        return status;
    if (run->plan.filed)
        return check_memory(run, e, e->least.filed, e->likely.filed, left, "");
    return check_memory(run, e, e->least.whole, e->likely.whole, left, obstacle);
}

/* A mesh that is handed out, but cannot be swept, is kept as a whole, in memory or not. */
static enum tri_status check_stream(const struct run *run, const struct estimate *e, double left)
{
    const char *why = run->settings.n_ranks > 0 ? "-S" : "bounds above 31 degrees and -S";
    enum tri_status status = e->sweeps ? TRI_OK : check_number(run, e, why);
    if (status)
        return status;
    return check_memory(run, e, e->least.floor, e->likely.floor, left, "");
}

/* --- disks */

enum { DISK_PLACES = 3 };

/* Data that a run writes into one place. */
struct disk_place {
    const char *what; /* name in messages, such as "its files" */
    const char *path; /* a folder, or an existing or future file */
    double bytes;     /* bytes needed there */
};

static bool look_at(const struct disk_place *place, struct tri_file_facts *facts)
{
    char folder[TRI_PATH];
    tri_path_folder(place->path, folder);
    return tri_path_get_facts(folder, facts);
}

static bool are_on_one_disk(const struct disk_place *a, const struct disk_place *b)
{
    struct tri_file_facts one, other;
    return a == b || (look_at(a, &one) && look_at(b, &other) && one.device == other.device);
}

/* Returns the first place on a disk that has less space left than all places on it need; NULL: none. *needed receives
 * that number. */
static const struct disk_place *too_small(const struct disk_place places[DISK_PLACES], double *needed)
{
    for (int i = 0; i < DISK_PLACES; i++) {
        *needed = 0;
        for (int k = 0; places[i].bytes > 0 && k < DISK_PLACES; k++)
            *needed += places[k].bytes > 0 && are_on_one_disk(&places[i], &places[k]) ? places[k].bytes : 0;
        if (*needed > 0 && *needed > tri_disk_left(places[i].path))
            return &places[i];
    }
    return NULL;
}

static void list_places(struct disk_place places[DISK_PLACES], const struct run *run, const struct needs *n,
                        double left)
{
    const struct long_options *limits = run->settings.options;
    const char *first = limits->n_streams > 0                 ? limits->streams[0]
                        : long_options_exports_alone(limits) ? limits->exports[0]
                                                             : run->arguments->output;
    places[0] = (struct disk_place){"the files", first, n->files};
    const double whole = run->plan.filed && n->whole > left ? n->filed_away : 0;
    places[1] = (struct disk_place){"what does not fit in memory", limits->scratch,
                                    run->plan.swept ? (n->held > left ? n->away : 0) + n->kept : whole};
    const double states = run->plan.swept ? n->checkpoint : n->states;
    const char *state = long_options_state(limits);
    places[2] = (struct disk_place){"the checkpoint", state, state ? states : 0};
}

static double sum_of(const struct disk_place places[DISK_PLACES])
{
    return places[0].bytes + places[1].bytes + places[2].bytes;
}

static enum tri_status check_disk(const struct run *run, const struct estimate *e, double memory)
{
    struct disk_place sure[DISK_PLACES], likely[DISK_PLACES];
    double needed;
    list_places(sure, run, &e->least, memory);
    list_places(likely, run, &e->likely, memory);
    const struct disk_place *place = sum_of(sure) > WORTH_A_LOOK ? too_small(sure, &needed) : NULL;
    if (place)
        return tri_fail(run->error, TRI_CANNOT_WRITE, place->path, 0,
                        "the bounds ask for at least %s triangles; %s and what else comes onto that disk take %s, "
                        "and %s are left there", tri_count_text(e->least.triangles).text, place->what,
                        tri_size_text(needed).text, tri_size_text(tri_disk_left(place->path)).text);
    place = sum_of(likely) > WORTH_A_LOOK ? too_small(likely, &needed) : NULL;
    if (place)
        console_warn(&run->console, "%s: %s and what else comes onto that disk may take about %s; %s are left.\n",
                     place->path, place->what, tri_size_text(needed).text,
                     tri_size_text(tri_disk_left(place->path)).text);
    return TRI_OK;
}

/* Checks that a folder can be written before the work, because it may be needed only hours later. */
static enum tri_status check_scratch(const struct run *run)
{
    const char *folder = run->settings.options->scratch;
    if (!tri_path_allows(folder, TRI_ACCEPTS_FILES))
        return tri_fail(run->error, TRI_CANNOT_WRITE, folder, 0, "cannot park a mesh in this directory: %s",
                        strerror(errno));
    return TRI_OK;
}

/* --- all together */

static double margin_of(const struct run *run)
{
    const struct tri_quality *quality = &run->options.quality;
    if (!is_strict(run))
        return MARGIN;
    return quality->conforming ? CONFORMING_MARGIN : quality->min_angle > TRI_EASY_ANGLE ? STEEP_MARGIN : STRICT_MARGIN;
}

static bool fits(const struct run *run, const struct estimate *e, double left)
{
    const double margin = e->sweeps || estimate_can_park(run, e->likely.held) ? margin_of(run) : 1;
    const double share = e->sweeps ? SURELY_ONE_MESH : 1;
    return fmax(e->likely.triangles, e->least.triangles) <= share * TRI_MAX_TRIANGLES &&
           margin * e->likely.whole <= left;
}

static void say_parking(const struct run *run, double bytes)
{
    console_say(&run->console, "Parking: what does not fit in memory goes to %s, about %s.\n",
                run->settings.options->scratch, tri_size_text(bytes).text);
}

static void say_way(const struct run *run, const struct estimate *e, double left)
{
    const struct needs *n = &e->likely;
    char whole[64] = "are too many for a mesh in memory";
    if (n->triangles <= TRI_MAX_TRIANGLES)
        snprintf(whole, sizeof whole, "would take %s of memory", tri_size_text(n->whole).text);
    if (e->sweeps && run->settings.n_ranks > 0)
        console_say(&run->console, "Sharing: about %s triangles among %d tasks, up to %s of memory each.\n",
                    tri_count_text(n->triangles).text, run->settings.n_ranks, tri_size_text(n->held).text);
    else if (run->settings.n_ranks > 1)
        console_say(&run->console, "Each of %d tasks makes all of the mesh: -S is not shared.\n",
                    run->settings.n_ranks);
    else if (e->sweeps)
        console_say(&run->console, "Sweeping: about %s triangles %s, a few columns of them %s.\n",
                    tri_count_text(n->triangles).text, whole, tri_size_text(n->held).text);
    if (n->held > left)
        say_parking(run, n->away);
}

/* For a mesh that is kept as a whole, with --memory as a bound for its part in memory. With several tasks one of them
 * makes all of it, and there is no estimate for its needs. */
static bool may_lie_in_files(const struct run *run, const struct estimate *e)
{
    const struct run_settings *settings = &run->settings;
    return settings->threads > 0 && settings->n_ranks == 0 && settings->options->memory > 0 && run->options.refine &&
           estimate_can_park(run, e->likely.whole);
}

/* For a small mesh the output buffers may exceed the mesh. */
static bool takes_less_whole(const struct run *run, const struct estimate *e, double left)
{
    return may_lie_in_files(run, e) && e->likely.floor > left && e->likely.filed <= left;
}

enum tri_status plan_make(struct run_plan *plan, const struct run *run, const struct estimate *e)
{
    bool look = fmax(e->likely.whole, e->least.whole) > WORTH_A_LOOK || is_strict(run);
    double left = look ? plan_memory_left(run) : HUGE_VAL;
    const char *obstacle = obstacle_of(run);
    bool stream = run->settings.always_sweep || (!fits(run, e, left) && !takes_less_whole(run, e, left));
    *plan = (struct run_plan){.swept = stream && !obstacle, .memory = tri_memory_used(NULL) + left,
                              .triangles = e->likely.triangles};
    plan->filed = !plan->swept && may_lie_in_files(run, e);
    enum tri_status status = plan->swept ? check_stream(run, e, left) : check_whole(run, e, left, obstacle);
    if (!status && (plan->swept || (plan->filed && (stream || e->likely.whole > left))))
        status = check_scratch(run);
    status = status ? status : check_disk(run, e, left);
    if (!status && plan->swept)
        say_way(run, e, left);
    else if (!status && plan->filed && e->likely.whole > left)
        say_parking(run, e->likely.filed_away);
    return status;
}

static void print_seconds(double seconds, int threads)
{
    if (seconds < 0.01)
        printf("  Time: under 0.01 s");
    else
        printf("  Time: %.2g s", seconds);
    printf(" on %d thread%s\n", threads, threads > 1 ? "s" : "");
}

/* there: `left`, or the whole capacity. */
static void print_bytes(const char *what, double needed, double there, const char *left)
{
    printf("  %s: %s", what, tri_size_text(needed).text);
    if (there < HUGE_VAL)
        printf(" (%s %s)", tri_size_text(there).text, left);
    putchar('\n');
}

static const char *way_of(const struct run *run, const struct estimate *e)
{
    if (run->settings.n_ranks > 0 && e->sweeps)
        return "shared by all tasks";
    if (run->plan.swept && e->sweeps)
        return "swept, a few columns in memory at a time";
    return run->plan.swept || run->plan.filed ? "all in memory, or in files as far as it does not fit"
                                              : "all in memory";
}

void plan_print(const struct run *run, const struct estimate *e)
{
    int threads = run->settings.threads > 1 ? run->settings.threads : 1;
    const struct needs *n = &e->likely;
    struct disk_place places[DISK_PLACES];
    const double left = plan_memory_left(run), most = run->plan.swept ? n->held : n->whole;
    const double floor = run->plan.swept ? n->floor : run->plan.filed ? n->filed : n->whole;
    const double more = fmin(most, fmax(left, floor));
    list_places(places, run, n, left);
    printf("\nEstimate:\n\n");
    printf("  Triangles: %s\n", tri_count_text(n->triangles).text);
    printf("  Vertices: %s\n", tri_count_text(e->vertices).text);
    if (run->options.refine)
        printf("  Way: %s\n", way_of(run, e));
    const double used = tri_memory_used(NULL);
    print_bytes("Memory", fmax(used + more, input_bytes(run)), used + left, "in all");
    print_bytes("Disk", n->files, tri_disk_left(places[0].path), "left");
    if (places[1].bytes > 0)
        print_bytes("Disk for what does not fit in memory", places[1].bytes, tri_disk_left(places[1].path), "left");
    if (places[2].bytes > 0)
        print_bytes("Disk for the checkpoint", places[2].bytes, tri_disk_left(places[2].path), "left");
    print_seconds(e->seconds, threads);
}
