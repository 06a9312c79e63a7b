/* The stages in their order, and the lines that are printed between them. */
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

static struct tri_output_set outputs; /* its temporary names are published to the handlers (interrupt.c) */

/* Ends a stage; the next one begins. */
static void end_stage(struct run *r, enum run_stage stage)
{
    double time = tri_seconds();
    r->seconds[stage] += time - r->mark;
    r->mark = time;
}

static void say_milliseconds(const struct run *r, const char *what, double seconds)
{
    console_say(&r->console, "%s milliseconds:  %.0f\n", what, floor(1000 * seconds));
}

/* --- arguments */

static void warn_of_switch(void *user, const char *text, bool misread)
{
    const struct run *r = user;
    if (misread) /* which cannot have been meant */
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
    return status;
}

/* --- input */

static void warn_of_input(void *user, const char *file, long line, const char *text)
{
    struct run *r = user;
    if (r->input_warnings++ < CONSOLE_SERIES_LINES)
        console_warn(&r->console, "%s:%ld: %s.\n", file, line, text);
}

static enum tri_status read_pslg(struct run *r, const struct tri_read_options *options)
{
    const struct tri_names *names = &r->names;
    const struct tri_format *format = r->arguments->format;
    if (format) {
        console_say(&r->console, "Opening %s.\n", r->arguments->file);
        r->base = options->default_base;
        return format->read(r->arguments->file, &r->pslg, &r->elements, options->executor, r->error);
    }
    if (!r->arguments->switches.segments) {
        console_say(&r->console, "Opening %s.\n", names->node);
        return tri_read_node(names->node, options, &r->pslg, &r->base, r->error);
    }
    console_say(&r->console, "Opening %s.\n", names->poly);
    enum tri_status status = tri_read_poly(names->poly, names->node, options, &r->pslg, &r->base, &r->points_in_poly,
                                           r->error);
    if (!status && !r->points_in_poly)
        console_say(&r->console, "Opening %s.\n", names->node);
    return status;
}

/* The triangles of a mesh that is to be refined, and their area bounds. */
static enum tri_status read_mesh(struct run *r, const struct tri_read_options *options)
{
    const struct tri_names *names = &r->names;
    enum tri_status status = TRI_OK;
    if (!r->arguments->format) {
        console_say(&r->console, "Opening %s.\n", names->ele);
        status = tri_read_ele(names->ele, options, r->base, r->pslg.n_points, &r->elements, r->error);
    }
    if (status || !r->arguments->switches.area_lists)
        return status;
    console_say(&r->console, "Opening %s.\n", names->area);
    return tri_read_area(names->area, options, r->base, &r->elements, r->error);
}

/* Where the file that was named is there, but not of a kind that is read, the error says which kinds are. */
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
                 " files, and meshes in " TRI_FORMAT_SUFFIXES "; docs/formats.md, \"From maps\", makes a .poly of"
                 " GeoJSON, shapefiles and others)");
}

/* Once the .poly has been read it is known whether the .node is, too. */
static struct file_names files_read(const struct run *r)
{
    const struct tri_switches *s = &r->arguments->switches;
    const bool is_own = !r->arguments->format;
    struct file_names read = {0};
    if (!is_own)
        read.name[read.n++] = r->arguments->file;
    if (is_own && s->segments)
        read.name[read.n++] = r->names.poly;
    if (is_own && !r->points_in_poly)
        read.name[read.n++] = r->names.node;
    if (is_own && s->mesh)
        read.name[read.n++] = r->names.ele;
    if (s->mesh && s->area_lists)
        read.name[read.n++] = r->names.area;
    return read;
}

static enum tri_status read_input(struct run *r)
{
    const struct tri_switches *s = &r->arguments->switches;
    struct tri_read_options options = {.default_base = s->from_zero ? 0 : 1,
                                       .want_regions = tri_switches_use_regions(s),
                                       .may_be_empty = s->mesh,
                                       .refining = s->mesh,
                                       .executor = r->hooks->executor,
                                       .stop = interrupt_stop(),
                                       .warn = warn_of_input,
                                       .warn_user = r};
    const struct file_names files = files_read(r);
    enum tri_status status = plan_check_files(r, &files);
    status = status ? status : read_pslg(r, &options);
    if (!status && s->mesh)
        status = read_mesh(r, &options);
    console_series_end(&r->console, r->input_warnings, "of this kind");
    if (status)
        add_hint(r);
    return status;
}

/* Of several ranks one reads. */
static enum tri_status get_input(struct run *r)
{
    const struct run_hooks *hooks = r->hooks;
    interrupt_stage("reading");
    enum tri_status status = hooks->written_elsewhere ? TRI_OK : read_input(r);
    if (hooks->share)
        status = hooks->share(hooks->user, r, status);
    else if (!status)
        status = plan_check_input(r);
    end_stage(r, RUN_READ);
    return status;
}

/* --- mesh */

static void say_carving(const struct run *r)
{
    const struct tri_switches *s = &r->arguments->switches;
    const struct tri_pslg *pslg = &r->pslg;
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

/* There is a mesh. */
static void say_built(struct run *r)
{
    const struct tri_switches *s = &r->arguments->switches;
    end_stage(r, s->mesh ? RUN_DELAUNAY : RUN_HOLES);
    if (s->mesh) {
        say_milliseconds(r, "Mesh reconstruction", r->seconds[RUN_DELAUNAY]);
        warn_of_loose(r);
    } else if (s->segments) {
        say_milliseconds(r, "Hole", r->seconds[RUN_HOLES]);
    }
}

/* Called when a stage begins: the lines that end the one before, then those of the new one. */
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
        say_milliseconds(r, "Delaunay", r->seconds[RUN_DELAUNAY]);
        interrupt_stage("recovering segments");
        if (s->segments)
            console_say(&r->console, "Recovering segments.\n");
        break;
    case TRI_STAGE_HOLES:
        interrupt_stage(s->segments ? "removing holes" : "preparing the mesh");
        end_stage(r, RUN_SEGMENTS);
        if (s->segments || s->keep_hull)
            say_milliseconds(r, "Segment", r->seconds[RUN_SEGMENTS]);
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

/* A stop that nobody has noticed counts as one up to here, unless the mesh is finished, and not kept elsewhere. */
static enum tri_status notice_stop(struct run *r, enum tri_status status)
{
    if (r->built && long_options_state(r->hooks->options))
        return status;
    return !status && tri_stop_is_asked(interrupt_stop()) ? tri_fail_stopped(r->error) : status;
}

/* Refuses what cannot be before it costs time. */
static enum tri_status look_ahead(struct run *r)
{
    struct estimate estimate = estimate_make(r, false);
    return plan_make(&r->plan, r, &estimate);
}

/* Files of a mesh that is there are written though somebody asks for the end, as long as there is time. */
static void begin_outputs(const struct run *r)
{
    interrupt_begin(&outputs);
    if (r->hooks->options->write_partial || long_options_state(r->hooks->options))
        outputs.stop = interrupt_end();
}

/* What will be told of the input, though its vertices will be gone then. */
static enum tri_status keep_twins(struct run *r, const struct tri_mesh *mesh)
{
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

/* Finds the vertices of no triangle, by the caller's numbers, while the mesh is small. No number of it is free. */
static enum tri_status find_unused(struct run *r, const struct tri_mesh *mesh)
{
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

static enum tri_status refine(void *user, struct tri_mesh *mesh, const struct tri_quality *quality,
                              struct tri_refine_report *report, struct tri_error *error)
{
    struct run *r = user;
    const struct run_hooks *hooks = r->hooks;
    enum tri_status status = hooks->options->dry_run ? TRI_OK : look_ahead(r);
    if (status || hooks->options->dry_run)
        return status;
    console_say(&r->console, "Adding vertices until the bounds are kept.\n");
    interrupt_stage("refining");
    interrupt_reached(mesh->n_triangles, " triangles");
    if (r->plan.swept && !hooks->written_elsewhere)
        begin_outputs(r);
    status = find_unused(r, mesh);
    if (!status && r->plan.swept)
        status = keep_twins(r, mesh);
    if (!status)
        status = hooks->refine ? hooks->refine(hooks->user, r, mesh, quality, report)
                               : tri_refine(mesh, quality, report, error);
    status = notice_stop(r, status);
    if (status && r->plan.swept && !hooks->written_elsewhere)
        interrupt_drop(&outputs);
    return status;
}

/* The mesh, refined or, in a dry run, as it is before. */
static enum tri_status generate(struct run *r)
{
    const struct tri_switches *s = &r->arguments->switches;
    struct tri_options options = r->options;
    if (!s->mesh && tri_pslg_is_one_place(&r->pslg))
        return tri_fail(r->error, TRI_BAD_INPUT, r->arguments->file, 0, "all vertices are at the same place");
    r->is_edge = s->mesh ? malloc(((size_t)r->pslg.n_segments + 1) * sizeof *r->is_edge) : NULL;
    if (s->mesh && !r->is_edge)
        return tri_fail(r->error, TRI_NO_MEMORY, NULL, 0, "out of memory for %d segments", (int)r->pslg.n_segments);
    options.refine_call = refine;
    options.refine_user = options.stage_user = r;
    options.stage = follow_stage;
    options.executor = r->hooks->executor;
    options.stop = interrupt_stop();
    options.elements = s->mesh ? &r->elements : NULL;
    options.is_edge = r->is_edge;
    options.base = r->arguments->format ? r->arguments->format->base : r->base;
    enum tri_status status = tri_generate(&r->mesh, &r->pslg, &options, &r->report, r->error);
    if (r->built) /* not the input's fault */
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
    say_milliseconds(r, r->plan.swept ? "Quality and output" : "Quality", r->seconds[RUN_QUALITY]);
    if (r->report.notes.empty[0])
        return; /* no triangle keeps anything */
    if (report->hit_limit && r->options.quality.conforming)
        console_warn(&r->console, "the limit of -S was reached before the mesh was conforming.\n");
    summary_bounds(r);
}

/* --- a run that is stopped */

/* Triangles below the bounds, where counting them takes no time to speak of; else -1. */
static int64_t count_bad(const struct run *r)
{
    enum { SOON_COUNTED = 1 << 22 };
    int64_t count[TRI_EXCUSES], sum = 0;
    if (!r->options.refine || r->plan.swept || r->mesh.n_triangles > SOON_COUNTED)
        return -1;
    tri_count_bad(&r->mesh, &r->options.quality, &r->report.quality, r->hooks->executor, count);
    for (int k = 0; k < TRI_EXCUSES; k++)
        sum += count[k];
    return sum;
}

/* What there is of the mesh, as far as this process knows: on several ranks each has a part. */
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

/* By what, when, where, how far; and what is kept. */
static void tell_of_stop(struct run *r, bool partial)
{
    struct tri_error line = {.status = TRI_STOPPED};
    char far[160] = "";
    tell_how_far(r, far, sizeof far);
    tri_fail(&line, TRI_STOPPED, NULL, 0, "stopped by %s after %.1f s while %s%s; %s", interrupt_cause(),
             tri_seconds() - r->begin, interrupt_stage_now(), far,
             partial ? "the mesh so far is written" : interrupt_written());
    if (!partial)
        interrupt_tell();
    console_error(&r->console, &line);
    interrupt_tell_kept();
    if (!partial)
        interrupt_told();
}

/* After a stop: is there a mesh, and is it wanted? Then on with it. */
static enum tri_status keep_partial(struct run *r, enum tri_status status)
{
    if (status != TRI_STOPPED || !r->built || !r->hooks->options->write_partial)
        return status;
    tell_of_stop(r, true);
    r->stopped = interrupt_cause();
    r->mesh.stop = NULL;
    interrupt_go_on();
    return TRI_OK;
}

/* --- output */

static enum tri_status make_room(struct run *r, double bytes)
{
    const struct run_hooks *hooks = r->hooks;
    return hooks->make_room ? hooks->make_room(hooks->user, r, bytes) : TRI_OK;
}

/* Lists beside the mesh (topology.h): 4 bytes an edge, of which there are 3 for 2 triangles, and 12 a triangle for the
 * nodes amid them; 8 a vertex where those without triangles are left out. */
static double list_bytes(const struct run *r)
{
    const struct tri_switches *s = &r->arguments->switches;
    const bool leaves_out = mesh_files_grid(r, r->hooks->options->n_exports > 0).jettison;
    const bool edges = s->edges || s->voronoi || s->off;
    return ((s->second_order ? 18 : edges ? 6 : 0) + (leaves_out ? 4 : 0)) * (double)r->mesh.n_triangles;
}

static enum tri_status write_mesh(struct run *r)
{
    if (r->arguments->switches.second_order)
        console_say(&r->console, "Adding nodes amid edges.\n");
    console_say(&r->console, "\n");
    r->mark = tri_seconds();
    const double waiting = fmin(MESH_FILES_BYTES, MESH_FILES_ROW_BYTES * (double)r->mesh.n_triangles);
    enum tri_status status = make_room(r, waiting + list_bytes(r));
    status = status ? status : mesh_files_write(r);
    end_stage(r, RUN_WRITE);
    if (status)
        return status;
    console_say(&r->console, "\n");
    say_milliseconds(r, "Output", r->seconds[RUN_WRITE]);
    return TRI_OK;
}

/* -C. The judge keeps to what is left of a bound; pages of a mesh that lies in files take some of that, too. */
static enum tri_status check(struct run *r)
{
    const double OF_FILES = 0.75;
    enum tri_status status = make_room(r, self_check_least_bytes(&r->mesh));
    const double left = r->mesh.storage ? OF_FILES * plan_memory_left(r) : plan_memory_left(r);
    return status ? status : self_check(r, r->hooks->options->memory > 0 ? fmax(left, 1) : 0);
}

static enum tri_status tell(struct run *r)
{
    const struct tri_switches *s = &r->arguments->switches;
    enum tri_status status = TRI_OK;
    if (!r->plan.swept && r->unused.n >= 0)
        tri_count_refined(&r->counts, &r->mesh, r->unused.n);
    else if (!r->plan.swept)
        status = tri_count_mesh(&r->counts, &r->mesh, r->hooks->executor, r->error);
    if (!r->plan.swept)
        r->unused.n = r->mesh.n_vertices - r->counts.vertices;
    r->total_seconds = tri_seconds() - r->begin;
    if (status)
        return status;
    say_milliseconds(r, "Total running", r->total_seconds);
    r->counts.interior += r->report.loose; /* as Triangle counts */
    r->counts.subsegments += r->report.loose;
    summary_counts(r);
    if (s->verbosity > 0)
        summary_shapes(r);
    return s->check ? check(r) : TRI_OK;
}

static enum tri_status write_all(struct run *r)
{
    const struct run_hooks *hooks = r->hooks;
    enum tri_status status = r->plan.swept ? TRI_OK : write_mesh(r);
    status = status ? status : tell(r);
    if (!status && hooks->write)
        status = hooks->write(hooks->user, r);
    return status ? status : console_flush(r->error);
}

/* One word for all ranks. */
static enum tri_status agree(struct run *r, enum tri_status status)
{
    const struct run_hooks *hooks = r->hooks;
    return hooks->agree ? hooks->agree(hooks->user, status, r->error) : status;
}

/* Whatever can fail comes before the commit, what is printed included, and what others do. */
static enum tri_status write_output(struct run *r)
{
    if (r->hooks->written_elsewhere)
        return agree(r, TRI_OK);
    interrupt_stage("writing");
    if (!r->plan.swept)
        begin_outputs(r);
    enum tri_status status = agree(r, write_all(r));
    if (!status)
        return interrupt_commit(&outputs, !r->hooks->options->no_sync, r->error);
    interrupt_drop(&outputs);
    return status;
}

/* --- all together */

static enum tri_status make_mesh(struct run *r)
{
    enum tri_status status = keep_partial(r, generate(r));
    end_stage(r, RUN_QUALITY);
    if (status)
        return status;
    tell_of_quality(r);
    summary_input(r); /* when the vertices have the numbers of the input again */
    return TRI_OK;
}

/* A dry run ends here, and says where the true one would be refused. */
static enum tri_status print_estimate(struct run *r)
{
    enum tri_status status = generate(r);
    if (status)
        return status;
    summary_notes(r);
    struct estimate estimate = estimate_make(r, true);
    if (r->options.refine)
        status = plan_make(&r->plan, r, &estimate);
    plan_print(r, &estimate);
    return status;
}

static enum tri_status run_stages(struct run *r)
{
    enum tri_status status = check_switches(r);
    const char *input = r->arguments->input;
    status = status ? status : tri_names_make(&r->names, input, strlen(input), r->error);
    status = status ? status : get_input(r);
    if (status)
        return status;
    if (r->hooks->options->dry_run)
        return print_estimate(r);
    const struct file_names read = files_read(r);
    status = r->hooks->written_elsewhere ? TRI_OK : mesh_files_check(r, &read);
    status = status ? status : make_mesh(r);
    return status ? status : write_output(r);
}

/* Seconds that ending may take. A batch system kills 30 seconds after it has asked. */
static double patience_of(const struct run_hooks *hooks)
{
    static const double KEEPING = 3, KEEPING_ON_RANKS = 25;
    if (hooks->options->write_partial || hooks->written_elsewhere) /* the first task says why all end */
        return HUGE_VAL;
    return !long_options_state(hooks->options) ? 0 : hooks->n_ranks > 1 ? KEEPING_ON_RANKS : KEEPING;
}

static enum tri_status run_file(struct run *r)
{
    const struct long_options *limits = r->hooks->options;
    r->begin = r->mark = tri_seconds();
    tri_memory_share_heap();
    if (!interrupt_start(r->hooks->program, limits->time_limit, patience_of(r->hooks)))
        return tri_fail(r->error, TRI_NO_MEMORY, NULL, 0, "the system has no timer left");
    enum tri_status status = run_stages(r);
    if (status)
        status = agree(r, status);
    if (status == TRI_STOPPED)
        tell_of_stop(r, false);
    else if (status)
        console_error(&r->console, r->error);
    return status;
}

static void free_run(struct run *r)
{
    tri_mesh_free(&r->mesh);
    tri_pslg_free(&r->pslg);
    tri_elements_free(&r->elements);
    free(r->is_edge);
    free(r->twin);
    free(r->unused.kept);
    tri_names_free(&r->names);
}

int run_arguments(const struct arguments *arguments, const struct run_hooks *hooks)
{
    const struct tri_switches *s = &arguments->switches;
    struct tri_error error = {0};
    struct run r = {.hooks = hooks, .arguments = arguments, .options = tri_switches_options(s), .unused.n = -1,
                    .outputs = &outputs, .console = {hooks->program, s->quiet, s->verbosity}, .error = &error};
    enum tri_status status = TRI_OK;
    if (s->help)
        help_full(hooks->program, "on one core", NULL); /* another program has taken this word itself */
    else if (!arguments->file)
        help_usage(hooks->program);
    else
        status = run_file(&r);
    free_run(&r);
    if (interrupt_code() != 0 && (status == TRI_STOPPED || (!status && r.stopped)))
        return interrupt_code();
    return console_close(&r.console) && !status ? EXIT_SUCCESS : EXIT_FAILURE;
}
