/* Writes the report: one object, built with jansson from the counts of the run and the schedule.
 *
 * A library call that runs out of memory returns NULL, which the enclosing calls pass on. It is checked once, at the
 * end. */
#include "drivers/mesh/report_json.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drivers/interrupt.h"
#include "triangle/base/system.h"
#include "triangle/text/write.h"

/* JSON has no infinity and no NaN; null replaces them. */
static json_t *real(double value) { return isfinite(value) ? json_real(value) : json_null(); }

static json_t *whole(int64_t value) { return json_integer((json_int_t)value); }

/* Appends an item to the list; NULL: no memory. */
static json_t *appended(json_t *list, json_t *item)
{
    if (json_array_append_new(list, item) == 0)
        return list;
    json_decref(list);
    return NULL;
}

/* --- stages */

/* The stage "quality" ends with the merged mesh; numbering is separate. */
static json_t *stages_of(const struct run *run, const struct par_report *schedule)
{
    const double *s = run->time.stage, number = schedule ? schedule->seconds_number : 0;
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "read", real(s[RUN_READ]), "delaunay",
                     real(s[RUN_DELAUNAY]), "segments", real(s[RUN_SEGMENTS]), "holes", real(s[RUN_HOLES]), "quality",
                     real(s[RUN_QUALITY] - number), "number", real(number), "write", real(s[RUN_WRITE]), "total",
                     real(run->time.total));
}

static json_t *command_of(const struct arguments *arguments)
{
    json_t *words = json_array();
    for (int i = 0; i < arguments->argc; i++) /* arguments need not be UTF-8 */
        if (json_array_append_new(words, json_string(arguments->argv[i])))
            json_array_append_new(words, json_null());
    return words;
}

/* --- the schedule */

static json_t *reals_of(const double *values, int n)
{
    json_t *list = json_array();
    for (int i = 0; i < n; i++)
        list = appended(list, real(values[i]));
    return list;
}

static json_t *parts_of(const struct par_report *r)
{
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "total", real(r->seconds_total),
                     "prerefine", real(r->seconds_prerefine), "partition", real(r->seconds_partition), "find",
                     real(r->seconds_find), "worklist", real(r->seconds_deal), "room", real(r->seconds_room), "refine",
                     real(r->seconds_refine), "merge", real(r->seconds_merge), "last", real(r->seconds_last), "number",
                     real(r->seconds_number), "phases", reals_of(r->phase_seconds, PAR_PHASES), "shared",
                     reals_of(r->seconds_shared, PAR_SHARINGS));
}

static json_t *blocks_of(const struct par_report *r)
{
    json_t *blocks = json_array();
    for (int32_t i = 0; i < r->n_blocks; i++) {
        const struct par_block_report *b = &r->blocks[i];
        blocks = appended(blocks, json_pack("{s:i, s:i, s:i, s:i, s:o, s:o, s:o, s:o}", "schedule", (int)b->schedule,
                                            "round", (int)b->round, "phase", (int)b->phase, "block", (int)b->block,
                                            "worklist", whole(b->worklist), "inserted", whole(b->inserted),
                                            "deferred", whole(b->deferred), "seconds", real(b->seconds)));
    }
    return blocks;
}

/* Returns the share of the schedule in the time from the Delaunay triangulation to the merged mesh; 0: one sequential
 * call did the work. */
static json_t *percent(const struct par_report *r, double seconds)
{
    double merged = r->seconds_total - r->seconds_number;
    return real(r->levels == 0 || !(merged > 0) || seconds < 0 ? 0 : 100 * seconds / merged);
}

static json_t *by_reason(const int64_t count[TRI_EXCUSES])
{
    return json_pack("{s:o, s:o, s:o, s:o, s:o}", "input_angle", whole(count[TRI_EXCUSE_INPUT_ANGLE]), "narrow_gap",
                     whole(count[TRI_EXCUSE_NARROW_GAP]), "protected", whole(count[TRI_EXCUSE_PROTECTED]), "limit",
                     whole(count[TRI_EXCUSE_LIMIT]), "precision", whole(count[TRI_EXCUSE_PRECISION]));
}

static const char *const way_names[] = {[PAR_IN_MEMORY] = "in memory", [PAR_SWEPT] = "swept", [PAR_PARKED] = "parked"};

static json_t *schedule_of(const struct par_report *r)
{
    const double merged = r->seconds_total - r->seconds_number;
    json_t *inserted = json_pack("{s:o, s:o}", "free", whole(r->total.inserted_free), "on_segments",
                                 whole(r->total.inserted_on_segments));
    return json_pack("{s:i, s:i, s:i, s:i, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o,"
                     " s:s, s:i, s:o, s:o, s:o, s:o, s:o, s:o, s:o}",
                     "levels", r->levels, "rounds", r->rounds, "columns", (int)r->columns, "rows", (int)r->rows,
                     "prerefined", whole(r->prerefined), "inserted", inserted, "deferred", whole(r->deferred),
                     "left_over", whole(r->left_over), "refused", by_reason(r->total.given_up), "pauses",
                     whole(r->pauses), "radius_lemma7", real(r->radius_lemma7), "radius_theory",
                     real(r->radius_theory), "radius_measured", real(r->radius_measured), "way", way_names[r->way],
                     "schedule", (int)r->schedule, "most_live_triangles", whole(r->most_live), "parked_bytes",
                     whole(r->parked), "below_bounds", r->remain_known ? by_reason(r->remain) : json_null(),
                     "seconds", parts_of(r), "overhead_percent",
                     percent(r, merged - r->seconds_prerefine - r->seconds_refine), "numbering_percent",
                     percent(r, r->seconds_number), "blocks", blocks_of(r));
}

/* --- the mesh */

static json_t *histogram_of(const int64_t *count, int n)
{
    json_t *list = json_array();
    for (int i = 0; i < n; i++)
        list = appended(list, whole(count[i]));
    return list;
}

/* If the mesh has gone, only its counts are known, and all other values are null. */
static struct tri_shapes shapes_of(const struct run *run)
{
    struct tri_shapes shapes = {.smallest_area = NAN, .largest_area = NAN, .total_area = NAN, .shortest_edge = NAN,
                                .longest_edge = NAN, .smallest_angle = NAN, .largest_angle = NAN};
    if (!run->plan.swept)
        tri_measure_shapes(&shapes, &run->mesh, run->settings.executor);
    return shapes;
}

static json_t *mesh_of(const struct run *run)
{
    const struct tri_counts *c = &run->counts;
    const struct tri_quality *bounds = &run->options.quality;
    const struct tri_shapes shapes = shapes_of(run);
    double mean = c->triangles > 0 ? shapes.total_area / (double)c->triangles : 0;
    json_t *over = run->options.refine && bounds->max_area > 0 ? real(mean / bounds->max_area) : json_null();
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "vertices",
                     whole(c->vertices), "triangles", whole(c->triangles), "edges", whole(c->edges), "subsegments",
                     whole(c->subsegments), "smallest_angle", real(shapes.smallest_angle), "largest_angle",
                     real(shapes.largest_angle), "smallest_area", real(shapes.smallest_area), "largest_area",
                     real(shapes.largest_area), "mean_area", real(mean), "mean_area_over_bound", over, "shortest_edge",
                     real(shapes.shortest_edge), "longest_edge", real(shapes.longest_edge), "angles_by_ten_degrees",
                     run->plan.swept ? json_null() : histogram_of(shapes.angles, TRI_ANGLE_BINS));
}

/* --- ranks */

static const char *const move_names[] = {
    [PAR_MOVE_BORDERS] = "borders", [PAR_MOVE_BACK] = "back",   [PAR_MOVE_LEFT_OVER] = "left_over",
    [PAR_MOVE_NUMBERS] = "numbers", [PAR_MOVE_TILES] = "tiles", [PAR_MOVE_INPUT] = "input",
};

static json_t *moves_of(const int64_t *number)
{
    json_t *moves = json_object();
    for (int k = 0; k < PAR_MOVES; k++)
        if (json_object_set_new(moves, move_names[k], whole(number[k]))) {
            json_decref(moves);
            return NULL;
        }
    return moves;
}

static json_t *rank_of(const int64_t *number)
{
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "threads", whole(number[RANK_THREADS]),
                     "peak_memory_bytes", whole(number[RANK_PEAK_MEMORY]), "processor_seconds",
                     real(1e-9 * (double)number[RANK_NS_PROCESSOR]), "block_seconds",
                     real(1e-9 * (double)number[RANK_NS_BLOCKS]), "waiting_seconds",
                     real(1e-9 * (double)number[RANK_NS_WAITING]), "moving_seconds",
                     real(1e-9 * (double)number[RANK_NS_MOVING]), "bytes", moves_of(number + RANK_BYTES), "messages",
                     moves_of(number + RANK_MESSAGES));
}

/* Returns one object per rank; null: there is a single process. */
static json_t *ranks_of(const struct rank_report *report)
{
    if (report->n_ranks == 0)
        return json_null();
    json_t *ranks = json_array();
    for (int p = 0; p < report->n_ranks; p++)
        ranks = appended(ranks, rank_of(report->number[p]));
    return ranks;
}

/* --- lengths */

static json_t *source_of(const struct size_source *source)
{
    const struct tri_size_field *f = &source->field;
    if (source->path)
        return json_pack("{s:o?}", "file", json_string(source->path)); /* a name need not be UTF-8 */
    if (f->kind == TRI_SIZE_NUMBER)
        return json_pack("{s:o}", "length", real(f->length));
    return json_pack("{s:o, s:i, s:o}", "length", real(f->length), "marker", (int)f->marker, "growth",
                     f->growth >= 0 ? real(f->growth) : json_null());
}

static json_t *given(double value) { return value > 0 ? real(value) : json_null(); }

/* Returns the lengths; null: there are none. */
static json_t *sizes_of(const struct size_options *options)
{
    json_t *sources = json_array();
    if (!size_options_any(options)) {
        json_decref(sources);
        return json_null();
    }
    for (int i = 0; i < options->n; i++)
        sources = appended(sources, source_of(&options->source[i]));
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o}", "sources", sources, "gradation", given(options->gradation),
                     "min_size", given(options->min_size), "max_size", given(options->max_size), "elements_across",
                     given(options->elements_across), "per_circle", given(options->per_circle));
}

/* --- the whole report */

/* Returns the placement of new vertices: lattice, front, or neither. */
static const char *placement_of(const struct tri_quality *q)
{
    return tri_wants_lattice(q) || tri_lattice_length(q) > 0 ? "lattice" : q->lengths && q->front ? "front" : "classic";
}

static json_t *report_of(const struct run *run, const struct par_report *schedule, const struct rank_report *ranks)
{
    int64_t memory = tri_memory_peak(); /* measured before the report needs memory */
    const struct tri_quality *q = &run->options.quality;
    json_t *bounds = json_pack("{s:o, s:o}", "min_angle", q->min_angle > 0 ? real(q->min_angle) : json_null(),
                               "max_area", q->max_area > 0 ? real(q->max_area) : json_null());
    return json_pack("{s:s, s:s, s:o, s:s?, s:i, s:o, s:o, s:o, s:s, s:o, s:o, s:o, s:o}", "program",
                     run->console.program, "version", PTRIANGLE_VERSION, "command", command_of(run->arguments),
                     "stopped", run->stopped, "threads", run->settings.threads, "peak_memory_bytes", whole(memory),
                     "bounds", bounds, "sizes", sizes_of(&run->arguments->sizes), "placement", placement_of(q),
                     "seconds", stages_of(run, schedule), "mesh", mesh_of(run), "ranks", ranks_of(ranks), "schedule",
                     schedule ? schedule_of(schedule) : json_null());
}

enum tri_status report_check(struct tri_error *error)
{
    (void)error;
    return TRI_OK;
}

static enum tri_status write_text(const struct run *run, const char *text)
{
    struct tri_output *output;
    if (long_options_report_is_printed(run->settings.options)) {
        puts(text);
        return TRI_OK; /* the caller checks that all output was written */
    }
    enum tri_status status = interrupt_open(run->outputs, run->settings.options->report, &output, run->error);
    status = status ? status : tri_output_write(output, text, strlen(text), run->error);
    return status ? status : tri_output_write(output, "\n", 1, run->error);
}

enum tri_status report_write(const struct run *run, const struct par_report *schedule, const struct rank_report *ranks)
{
    json_t *report = report_of(run, schedule, ranks);
    char *text = report ? json_dumps(report, JSON_INDENT(1) | JSON_REAL_PRECISION(9)) : NULL;
    enum tri_status status = text ? write_text(run, text)
                                  : tri_fail(run->error, TRI_NO_MEMORY, run->settings.options->report, 0,
                                             "out of memory for the report");
    free(text);
    json_decref(report);
    return status;
}
