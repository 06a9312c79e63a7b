/* The stages in their order, and the lines printed between them. */
#include "drivers/mesh/stages.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drivers/interrupt.h"
#include "drivers/mesh/plan.h"
#include "drivers/mesh/summary.h"
#include "triangle/base/system.h"
#include "triangle/refine/census.h"

static struct tri_output_set outputs; /* handlers know its temporary names (interrupt.c) */

/* Ends a stage, and begins the next one. */
static void end_stage(struct run *r, enum run_stage stage)
{
    double time = tri_seconds();
    r->time.stage[stage] += time - r->time.mark;
    r->time.mark = time;
}

static void say_milliseconds(const struct run *r, const char *what, double seconds)
{
    console_say(&r->console, "%s milliseconds:  %.0f\n", what, floor(1000 * seconds));
}

/* --- arguments */

static void warn_of_switch(void *user, const char *text, bool misread)
{
    const struct run *r = user;
    if (misread) /* probably a mistake */
        console_remark(&r->console, "warning: %s\n", text);
    else
        console_warn(&r->console, "%s.\n", text);
}

static enum tri_status check_switches(struct run *r)
{
    const struct tri_switches *s = &r->arguments->switches;
    tri_switches_warn(s, warn_of_switch, r);
    enum tri_status status = tri_switches_check(s, r->error);
    if (!status && s->mesh && s->no_iteration)
        return tri_fail(r->error, TRI_BAD_INPUT, NULL, 0,
                        "-I cannot be used when refining (-r): it would overwrite the input");
    const struct size_options *sizes = &r->arguments->sizes;
    if (!status && (sizes->region_polygons || sizes->min_edge > 0) && (s->mesh || !s->segments))
        return tri_fail(r->error, TRI_BAD_INPUT, NULL, 0, "--%s segments: it needs -p, without -r",
                        sizes->region_polygons ? "region-polygons adds" : "min-edge simplifies");
    return status;
}

/* --- input */

static void warn_of_input(void *user, const char *file, int64_t line, const char *text)
{
    struct run *r = user;
    if (r->input.warnings++ < CONSOLE_SERIES_LINES)
        console_warn(&r->console, "%s:%" PRId64 ": %s.\n", file, line, text);
}

static enum tri_status read_pslg(struct run *r, const struct tri_read_options *options)
{
    const struct tri_names *names = &r->input.names;
    const struct tri_format *format = r->arguments->format;
    r->input.base = options->default_base;
    if (r->arguments->is_geojson)
        return TRI_OK;
    if (format) {
        console_say(&r->console, "Opening %s.\n", r->arguments->file);
        return format->read(r->arguments->file, &r->input.pslg, &r->input.elements, options->executor, r->error);
    }
    if (!r->arguments->switches.segments) {
        console_say(&r->console, "Opening %s.\n", names->node);
        return tri_read_node(names->node, options, &r->input.pslg, &r->input.base, r->error);
    }
    console_say(&r->console, "Opening %s.\n", names->poly);
    enum tri_status status = tri_read_poly(names->poly, names->node, options, &r->input.pslg, &r->input.base,
                                           &r->input.points_in_poly, r->error);
    if (!status && !r->input.points_in_poly)
        console_say(&r->console, "Opening %s.\n", names->node);
    return status;
}

/* Reads the triangles of a mesh to refine, and their area bounds. */
static enum tri_status read_mesh(struct run *r, const struct tri_read_options *options)
{
    const struct tri_names *names = &r->input.names;
    enum tri_status status = TRI_OK;
    if (!r->arguments->format) {
        console_say(&r->console, "Opening %s.\n", names->ele);
        status = tri_read_ele(names->ele, options, r->input.base, r->input.pslg.n_points, &r->input.elements,
                              r->error);
    }
    if (status || !r->arguments->switches.area_lists)
        return status;
    console_say(&r->console, "Opening %s.\n", names->area);
    return tri_read_area(names->area, options, r->input.base, &r->input.elements, r->error);
}

/* If the named file exists but is of no supported type, the error lists the supported types. */
static void add_hint(const struct run *r)
{
    const char *file = r->arguments->file;
    struct tri_error *error = r->error;
    bool is_another = error->status == TRI_CANNOT_READ && tri_path_allows(file, TRI_THERE) &&
                      strcmp(file, error->file) != 0;
    bool is_no_text = error->status == TRI_BAD_INPUT && strstr(error->text, "not a text file");
    size_t n = strlen(error->text);
    if (is_another || is_no_text)
        snprintf(error->text + n, sizeof error->text - n, " (what is read are Triangle's .node, .poly, .ele and .area"
                 " files, polygons in .geojson, and meshes in " TRI_FORMAT_SUFFIXES "; docs/formats.md, \"From maps\","
                 " makes a .poly of shapefiles and others)");
}

/* Only after the .poly file has been read is it known whether the .node file is needed. */
static struct file_names files_read(const struct run *r)
{
    const struct tri_switches *s = &r->arguments->switches;
    const bool is_own = !r->arguments->format && !r->arguments->is_geojson;
    struct file_names read = {0};
    if (r->arguments->sizes.region_polygons)
        read.name[read.n++] = r->arguments->sizes.region_polygons;
    if (r->arguments->format)
        read.name[read.n++] = r->arguments->file;
    if (is_own && s->segments)
        read.name[read.n++] = r->input.names.poly;
    if (is_own && !r->input.points_in_poly)
        read.name[read.n++] = r->input.names.node;
    if (is_own && s->mesh)
        read.name[read.n++] = r->input.names.ele;
    if (s->mesh && s->area_lists)
        read.name[read.n++] = r->input.names.area;
    for (int i = 0; i < r->arguments->sizes.n; i++)
        if (r->arguments->sizes.source[i].path)
            read.name[read.n++] = r->arguments->sizes.source[i].path;
    return read;
}

static enum tri_status read_input(struct run *r)
{
    const struct tri_switches *s = &r->arguments->switches;
    const bool polygons = r->arguments->sizes.region_polygons != NULL;
    struct tri_read_options options = {.default_base = s->from_zero ? 0 : 1,
                                       .want_regions = tri_switches_use_regions(s) && !polygons,
                                       .regions_if_any = tri_switches_use_regions(s) && polygons,
                                       .may_be_empty = s->mesh,
                                       .refining = s->mesh,
                                       .executor = r->settings.executor,
                                       .stop = interrupt_stop(),
                                       .warn = warn_of_input,
                                       .warn_user = r};
    const struct file_names files = files_read(r);
    enum tri_status status = plan_check_files(r, &files);
    status = status ? status : read_pslg(r, &options);
    if (!status && s->mesh)
        status = read_mesh(r, &options);
    console_series_end(&r->console, r->input.warnings, "of this kind");
    if (status)
        add_hint(r);
    return status;
}

/* Applies --region-polygons and --min-edge, and prints what they have changed; the latter also if quiet. */
static enum tri_status change_input(struct run *r)
{
    const struct size_options *options = &r->arguments->sizes;
    struct tri_options how = r->options;
    char text[CHANGED_TEXT];
    how.executor = r->settings.executor;
    how.stop = interrupt_stop();
    enum tri_status status = size_options_divide(options, &r->input.pslg, &how, text, r->error);
    if (!status && text[0])
        console_say(&r->console, "%s.\n", text);
    status = status ? status : size_options_simplify(options, &r->input.pslg, how.executor, how.stop, text, r->error);
    if (!status && text[0] && r->console.quiet)
        console_remark(&r->console, "%s.\n", text);
    else if (!status && text[0])
        console_say(&r->console, "%s.\n", text);
    return status;
}

enum tri_status run_read(struct run *r)
{
    interrupt_stage("reading");
    enum tri_status status = r->settings.written_elsewhere ? TRI_OK : read_input(r);
    if (!status && !r->settings.written_elsewhere)
        status = change_input(r);
    if (!status && !r->settings.written_elsewhere)
        status = size_fields_read(&r->sizes, &r->arguments->sizes, r->settings.executor, r->error);
    return status || r->settings.n_ranks > 0 ? status : plan_check_input(r);
}

/* --- mesh */

static void say_carving(const struct run *r)
{
    const struct tri_switches *s = &r->arguments->switches;
    const struct tri_pslg *pslg = &r->input.pslg;
    if (!s->segments)
        return;
    if (!s->keep_hull || (pslg->n_holes > 0 && !s->ignore_holes))
        console_say(&r->console, "Removing triangles outside and in holes.\n");
    if (r->options.spread_regions && pslg->n_regions > 0)
        console_say(&r->console, "Spreading %s%s%s of regions.\n", s->regions ? "attributes" : "",
                    s->regions && s->area_lists ? " and " : "", s->area_lists ? "area bounds" : "");
}

static void warn_of_loose(const struct run *r)
{
    const int32_t loose = r->report.loose;
    if (loose > 0)
        console_warn(&r->console, "%ld segments are no edges of the mesh. They are copied, but not kept by the mesh.\n",
                     (long)loose);
}

/* Marks the mesh as valid. */
static void say_built(struct run *r)
{
    const struct tri_switches *s = &r->arguments->switches;
    end_stage(r, s->mesh ? RUN_DELAUNAY : RUN_HOLES);
    if (s->mesh) {
        say_milliseconds(r, "Mesh reconstruction", r->time.stage[RUN_DELAUNAY]);
        warn_of_loose(r);
    } else if (s->segments) {
        say_milliseconds(r, "Hole", r->time.stage[RUN_HOLES]);
    }
}

/* Called when a stage begins. Prints the last lines of the previous stage, then the first lines of the new one. */
static void follow_stage(void *user, enum tri_stage begins)
{
    struct run *r = user;
    const struct tri_switches *s = &r->arguments->switches;
    switch (begins) {
    case TRI_STAGE_DELAUNAY:
        interrupt_stage("building the Delaunay triangulation");
        console_say(&r->console, "Building the Delaunay triangulation by incremental insertion.\n");
        break;
    case TRI_STAGE_SEGMENTS:
        end_stage(r, RUN_DELAUNAY);
        say_milliseconds(r, "Delaunay", r->time.stage[RUN_DELAUNAY]);
        interrupt_stage("recovering segments");
        if (s->segments)
            console_say(&r->console, "Recovering segments.\n");
        break;
    case TRI_STAGE_HOLES:
        interrupt_stage(s->segments ? "removing holes" : "preparing the mesh");
        end_stage(r, RUN_SEGMENTS);
        if (s->segments || s->keep_hull)
            say_milliseconds(r, "Segment", r->time.stage[RUN_SEGMENTS]);
        say_carving(r);
        break;
    case TRI_STAGE_REBUILD:
        interrupt_stage("rebuilding the mesh");
        console_say(&r->console, "Rebuilding the mesh from its triangles.\n");
        break;
    case TRI_STAGE_QUALITY:
        say_built(r);
        interrupt_stage("finishing the mesh"); /* unless it is refined */
        r->built = true;
        break;
    case TRI_STAGE_DONE:
        break;
    }
}

/* Returns TRI_STOPPED instead of TRI_OK if a stop was requested but not noticed. If the run keeps its state
 * (long_options_state), a finished mesh is written nevertheless. */
static enum tri_status notice_stop(struct run *r, enum tri_status status)
{
    if (r->built && long_options_state(r->settings.options))
        return status;
    return !status && tri_stop_is_asked(interrupt_stop()) ? tri_fail_stopped(r->error) : status;
}

/* Writes the files of a complete mesh in spite of a stop, as long as there is time. */
static void begin_outputs(const struct run *r)
{
    interrupt_begin(&outputs);
    if (r->settings.options->write_partial || long_options_state(r->settings.options))
        outputs.stop = interrupt_end();
}

/* Keeps data about the input for messages, because its vertices will be gone. */
static enum tri_status keep_twins(struct run *r)
{
    const struct tri_mesh *mesh = &r->mesh;
    const int32_t *origin = mesh->origin, n = mesh->n_input;
    if (!mesh->twin)
        return TRI_OK;
    r->twin = malloc(((size_t)n + 1) * sizeof *r->twin);
    if (!r->twin)
        return tri_fail(r->error, TRI_NO_MEMORY, NULL, 0, "out of memory for %d points", (int)n);
    for (int32_t v = 0; v < n; v++)
        r->twin[origin ? origin[v] : v] = origin ? origin[mesh->twin[v]] : mesh->twin[v];
    return TRI_OK;
}

enum tri_status run_find_unused(struct run *r)
{
    const struct tri_mesh *mesh = &r->mesh;
    const int32_t n = mesh->n_vertices;
    int32_t *kept = calloc((size_t)n + 2, sizeof *kept);
    if (!kept)
        return tri_fail(r->error, TRI_NO_MEMORY, NULL, 0, "out of memory for %d points", (int)n);
    for (tri_triangle_id t = 0; t < mesh->n_triangles; t++)
        for (int k = 0; k < 3; k++) {
            const tri_vertex_id v = mesh->tri[t].v[k];
            kept[(mesh->origin && v < mesh->n_input ? mesh->origin[v] : v) + 1] = 1;
        }
    for (int32_t v = 0; v < n; v++)
        kept[v + 1] += kept[v];
    r->unused = (struct orphans){n - kept[n], n, kept};
    return TRI_OK;
}

/* Makes the edge lengths, from the mesh before refinement. */
static enum tri_status make_lengths(struct run *r)
{
    const struct size_options *options = &r->arguments->sizes;
    char text[SIZE_OPTIONS_TEXT];
    if (!r->options.refine)
        return TRI_OK;
    const enum tri_status status = size_fields_make(&r->sizes, options, r->options.quality.region_areas, &r->mesh,
                                                    r->settings.executor, r->error);
    r->options.quality.lengths = r->sizes.lengths;
    if (!status && tri_lengths_note(r->sizes.lengths)[0]) {
        size_options_name(options, tri_lengths_note(r->sizes.lengths), text);
        console_warn(&r->console, "%s.\n", text);
    }
    return status;
}

enum tri_status run_refine_begin(struct run *r)
{
    enum tri_status status = make_lengths(r);
    if (status)
        return status;
    const struct estimate estimate = estimate_make(r, false);
    status = plan_make(&r->plan, r, &estimate);
    if (status)
        return status;
    console_say(&r->console, "Adding vertices until the bounds are kept.\n");
    interrupt_stage("refining");
    interrupt_reached(r->mesh.n_triangles, " triangles");
    if (r->plan.swept && !r->settings.written_elsewhere)
        begin_outputs(r);
    status = run_find_unused(r);
    if (!status && r->plan.swept)
        status = keep_twins(r);
    return status ? run_refine_end(r, status) : TRI_OK;
}

enum tri_status run_refine_end(struct run *r, enum tri_status status)
{
    status = notice_stop(r, status);
    if (status && r->plan.swept && !r->settings.written_elsewhere)
        interrupt_drop(&outputs);
    return status;
}

/* A dry run needs the mesh before refinement. */
static enum tri_status leave_unrefined(void *user, struct tri_mesh *mesh, const struct tri_quality *quality,
                                       struct tri_refine_report *report, struct tri_error *error)
{
    (void)user, (void)mesh, (void)quality, (void)report, (void)error;
    return TRI_OK;
}

/* Makes the mesh: refined, or in a dry run before refinement. */
static enum tri_status generate(struct run *r)
{
    const struct tri_switches *s = &r->arguments->switches;
    const int32_t n_segments = r->input.pslg.n_segments;
    struct tri_options options = r->options;
    end_stage(r, RUN_READ);
    if (!s->mesh && tri_pslg_is_one_place(&r->input.pslg))
        return tri_fail(r->error, TRI_BAD_INPUT, r->arguments->file, 0, "all vertices are at the same place");
    r->is_edge = s->mesh ? malloc(((size_t)n_segments + 1) * sizeof *r->is_edge) : NULL;
    if (s->mesh && !r->is_edge)
        return tri_fail(r->error, TRI_NO_MEMORY, NULL, 0, "out of memory for %d segments", (int)n_segments);
    options.refine_call = r->settings.options->dry_run ? leave_unrefined : options.refine_call;
    options.stage_user = r;
    options.stage = follow_stage;
    options.executor = r->settings.executor;
    options.stop = interrupt_stop();
    options.elements = s->mesh ? &r->input.elements : NULL;
    options.is_edge = r->is_edge;
    options.base = r->arguments->format ? r->arguments->format->base : r->input.base;
    enum tri_status status = tri_generate(&r->mesh, &r->input.pslg, &options, &r->report, r->error);
    if (r->built) /* the input is not at fault */
        return notice_stop(r, status);
    if (status == TRI_BAD_INPUT && s->mesh && !r->arguments->format)
        snprintf(r->error->file, sizeof r->error->file, "%s.ele", r->arguments->input);
    else if (status == TRI_BAD_INPUT)
        snprintf(r->error->file, sizeof r->error->file, "%s", r->arguments->file);
    return notice_stop(r, status);
}

static void tell_of_quality(struct run *r)
{
    const struct tri_refine_report *report = &r->report.quality;
    if (!r->options.refine)
        return;
    say_milliseconds(r, r->plan.swept ? "Quality and output" : "Quality", r->time.stage[RUN_QUALITY]);
    if (r->report.notes.empty[0])
        return; /* no triangle refers to it */
    if (report->hit_limit && r->options.quality.conforming)
        console_warn(&r->console, "the limit of -S was reached before the mesh was conforming.\n");
    summary_bounds(r);
}

/* --- a run that is stopped */

/* Returns the number of triangles that violate the bounds if counting is fast; otherwise -1. */
static int64_t count_bad(const struct run *r)
{
    enum { SOON_COUNTED = 1 << 22 };
    int64_t count[TRI_EXCUSES];
    if (!r->options.refine || r->plan.swept || r->mesh.n_triangles > SOON_COUNTED)
        return -1;
    tri_count_bad(&r->mesh, &r->options.quality, &r->report.quality, r->settings.executor, count);
    return summary_sum(count);
}

/* Returns the number of triangles known to this process; each rank has a part. */
static void tell_how_far(const struct run *r, char *far, size_t size)
{
    const int64_t bad = r->built ? count_bad(r) : -1;
    if (r->plan.swept) {
        const char *what;
        const int64_t reached = interrupt_reached_now(&what);
        if (reached > 0)
            snprintf(far, size, ": about %" PRId64 "%s", reached, what);
        return;
    }
    int length = r->built ? snprintf(far, size, ": %ld triangles", (long)r->mesh.n_triangles) : 0;
    if (bad >= 0)
        snprintf(far + length, size - (size_t)length, ", %" PRId64 " of them below the bounds", bad);
}

/* Reports the cause, the stage and the progress of a stop, and what is kept. */
static void tell_of_stop(struct run *r, bool partial)
{
    struct tri_error line = {.status = TRI_STOPPED};
    char far[160] = "";
    tell_how_far(r, far, sizeof far);
    tri_fail(&line, TRI_STOPPED, NULL, 0, "stopped by %s after %.1f s while %s%s; %s", interrupt_cause(),
             tri_seconds() - r->time.begin, interrupt_stage_now(), far,
             partial ? "the mesh so far is written" : interrupt_written());
    if (!partial)
        interrupt_tell();
    console_error(&r->console, &line);
    interrupt_print_kept();
    if (!partial)
        interrupt_told();
}

/* After a stop: goes on if there is a mesh, and it is requested. */
static enum tri_status keep_partial(struct run *r, enum tri_status status)
{
    if (status != TRI_STOPPED || !r->built || !r->settings.options->write_partial)
        return status;
    tell_of_stop(r, true);
    r->stopped = interrupt_cause();
    r->mesh.stop = NULL;
    interrupt_go_on();
    return TRI_OK;
}

/* --- output */

/* Bytes of rows being written, and of lists beside the mesh: edges, and vertices if unused ones are left out. */
double run_write_bytes(const struct run *r)
{
    const bool leaves_out = mesh_files_grid(r, r->settings.options->n_exports > 0).jettison;
    const double n = r->mesh.n_triangles, lists = estimate_edge_lists(r) + (leaves_out ? 0.5 * TRI_USED_BYTES : 0);
    return fmin(TRI_ROWS_BYTES, TRI_ROW_BYTES * n) + lists * n;
}

void run_write_begin(struct run *r)
{
    interrupt_stage("writing");
    if (r->plan.swept)
        return;
    begin_outputs(r);
    if (r->arguments->switches.second_order)
        console_say(&r->console, "Adding nodes amid edges.\n");
    console_say(&r->console, "\n");
    r->time.mark = tri_seconds();
}

enum tri_status run_write_mesh(struct run *r)
{
    if (r->plan.swept)
        return TRI_OK;
    const enum tri_status status = mesh_files_write(r);
    end_stage(r, RUN_WRITE);
    if (status)
        return status;
    console_say(&r->console, "\n");
    say_milliseconds(r, "Output", r->time.stage[RUN_WRITE]);
    return TRI_OK;
}

enum tri_status run_print_statistics(struct run *r)
{
    const struct tri_switches *s = &r->arguments->switches;
    enum tri_status status = TRI_OK;
    if (!r->plan.swept && r->unused.n >= 0)
        tri_count_refined(&r->counts, &r->mesh, r->unused.n);
    else if (!r->plan.swept)
        status = tri_count_mesh(&r->counts, &r->mesh, r->settings.executor, r->error);
    if (!r->plan.swept)
        r->unused.n = r->mesh.n_vertices - r->counts.vertices;
    r->time.total = tri_seconds() - r->time.begin;
    if (status)
        return status;
    say_milliseconds(r, "Total running", r->time.total);
    r->counts.interior += r->report.loose; /* counted as in Triangle */
    r->counts.subsegments += r->report.loose;
    summary_counts(r);
    if (s->verbosity > 0)
        summary_shapes(r);
    return TRI_OK;
}

enum tri_status run_commit(struct run *r, enum tri_status status)
{
    if (!status)
        return interrupt_commit(&outputs, !r->settings.options->no_sync, r->error);
    interrupt_drop(&outputs);
    return status;
}

/* --- all together */

/* A dry run: makes the mesh before refinement, and prints what the run would need. */
static enum tri_status make_dry(struct run *r)
{
    enum tri_status status = generate(r);
    if (status)
        return status;
    summary_notes(r);
    status = make_lengths(r);
    if (status)
        return status;
    const struct estimate estimate = estimate_make(r, true);
    if (r->options.refine)
        status = plan_make(&r->plan, r, &estimate);
    plan_print(r, &estimate);
    return status;
}

enum tri_status run_make(struct run *r)
{
    if (r->settings.options->dry_run)
        return make_dry(r);
    const struct file_names read = files_read(r);
    enum tri_status status = r->settings.written_elsewhere ? TRI_OK : mesh_files_check(r, &read);
    status = status ? status : keep_partial(r, generate(r));
    end_stage(r, RUN_QUALITY);
    if (status)
        return status;
    tell_of_quality(r);
    summary_input(r); /* after vertices have the numbers of the input again */
    return TRI_OK;
}

/* Seconds that ending may take. A batch system kills a program 30 seconds after the request. */
static double patience_of(const struct run_settings *settings)
{
    static const double KEEPING = 3, KEEPING_ON_RANKS = 25;
    if (settings->options->write_partial || settings->written_elsewhere) /* the first task reports why all end */
        return HUGE_VAL;
    return !long_options_state(settings->options) ? 0 : settings->n_ranks > 1 ? KEEPING_ON_RANKS : KEEPING;
}

struct run run_new(const char *program, const struct arguments *arguments, struct tri_error *error)
{
    const struct tri_switches *s = &arguments->switches;
    return (struct run){.arguments = arguments, .options = tri_switches_options(s), .unused.n = -1,
                        .outputs = &outputs, .console = {program, s->quiet, s->verbosity}, .error = error};
}

enum tri_status run_begin(struct run *r)
{
    const char *input = r->arguments->input;
    r->time.begin = r->time.mark = tri_seconds();
    tri_memory_share_heap();
    if (!interrupt_start(r->console.program, r->settings.options->time_limit, patience_of(&r->settings)))
        return tri_fail(r->error, TRI_NO_MEMORY, NULL, 0, "the system has no timer left");
    enum tri_status status = check_switches(r);
    return status ? status : tri_names_make(&r->input.names, input, strlen(input), r->error);
}

static void free_run(struct run *r)
{
    tri_mesh_free(&r->mesh);
    tri_pslg_free(&r->input.pslg);
    tri_elements_free(&r->input.elements);
    free(r->is_edge);
    free(r->twin);
    free(r->unused.kept);
    tri_names_free(&r->input.names);
    size_fields_free(&r->sizes);
}

int run_end(struct run *r, enum tri_status status)
{
    if (status == TRI_STOPPED)
        tell_of_stop(r, false);
    else if (status)
        console_error(&r->console, r->error);
    free_run(r);
    if (interrupt_code() != 0 && (status == TRI_STOPPED || (!status && r->stopped)))
        return interrupt_code();
    return console_close(&r->console) && !status ? EXIT_SUCCESS : EXIT_FAILURE;
}
