/* The report: one object, built with jansson from what the run and the schedule have counted.
 *
 * A library call that runs out of memory gives NULL, which the calls around it pass on: it is looked for once, at the
 * end. */
#include "drivers/mesh/report_json.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drivers/interrupt.h"
#include "drivers/mesh/prediction.h"
#include "drivers/mesh/replay.h"
#include "drivers/resources.h"
#include "triangle/text/write.h"

/* JSON has no infinity and no NaN: null stands for them. */
static json_t *real(double value) { return isfinite(value) ? json_real(value) : json_null(); }

static json_t *whole(int64_t value) { return json_integer((json_int_t)value); }

/* --- stages */

/* Quality here ends with the merged mesh; numbering comes after it. */
static json_t *stages_of(const struct run *run, const struct par_report *schedule)
{
    const double *s = run->seconds, number = schedule ? schedule->seconds_number : 0;
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "read", real(s[RUN_READ]), "delaunay",
                     real(s[RUN_DELAUNAY]), "segments", real(s[RUN_SEGMENTS]), "holes", real(s[RUN_HOLES]), "quality",
                     real(s[RUN_QUALITY] - number), "number", real(number), "write", real(s[RUN_WRITE]), "total",
                     real(run->total_seconds));
}

static json_t *command_of(const struct arguments *arguments)
{
    json_t *words = json_array();
    for (int i = 0; i < arguments->argc; i++) /* words need not be UTF-8 */
        if (json_array_append_new(words, json_string(arguments->argv[i])))
            json_array_append_new(words, json_null());
    return words;
}

/* --- the schedule */

static json_t *parts_of(const struct par_report *r)
{
    json_t *phases = json_array();
    for (int phase = 0; phase < 4; phase++)
        json_array_append_new(phases, real(r->phase_seconds[phase]));
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "total", real(r->seconds_total),
                     "prerefine", real(r->seconds_prerefine), "partition", real(r->seconds_partition), "find",
                     real(r->seconds_find), "worklist", real(r->seconds_deal), "room", real(r->seconds_room), "refine",
                     real(r->seconds_refine), "merge", real(r->seconds_merge), "last", real(r->seconds_last), "number",
                     real(r->seconds_number), "phases", phases);
}

static json_t *blocks_of(const struct par_report *r)
{
    json_t *blocks = json_array();
    for (int32_t i = 0; i < r->n_blocks; i++) {
        const struct par_block_report *b = &r->blocks[i];
        json_t *block = json_pack("{s:i, s:i, s:i, s:i, s:o, s:o, s:o, s:o}", "schedule", (int)b->schedule,
                                  "round", (int)b->round, "phase", (int)b->phase, "block", (int)b->block,
                                  "worklist", whole(b->worklist), "inserted", whole(b->inserted),
                                  "deferred", whole(b->deferred), "seconds", real(b->seconds));
        if (json_array_append_new(blocks, block)) {
            json_decref(blocks);
            return NULL;
        }
    }
    return blocks;
}

static json_t *predictions_of(const struct par_report *r)
{
    json_t *list = json_array();
    double sequential = prediction_sequential(r);
    for (int threads = 1; threads <= 256; threads *= 2) {
        double refine = prediction_refine(r->blocks, r->n_blocks, 0, threads);
        double quality = sequential + refine + prediction_shared(r, threads);
        if (refine < 0)
            continue;
        json_array_append_new(list, json_pack("{s:i, s:o, s:o, s:o, s:o}", "threads", threads, "refine_seconds",
                                              real(refine), "quality_seconds", real(quality), "number_seconds",
                                              real(prediction_number(r, threads)),
                                              "sequential_share", real(quality > 0 ? sequential / quality : 1)));
    }
    return list;
}

static json_t *replay_of(const struct par_report *r, const struct replay_how *how, double triangles)
{
    struct replay s;
    if (!replay_on_ranks(r, how, &s))
        return json_null();
    return json_pack("{s:i, s:i, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "ranks", how->n_ranks,
                     "threads", how->threads, "triangles", whole((int64_t)triangles), "seconds", real(s.total),
                     "alone_seconds", real(s.alone), "refine_seconds", real(s.refine), "merge_seconds", real(s.merge),
                     "communication_seconds", real(s.communicate), "hand_out_seconds", real(s.hand_out),
                     "processor_seconds_of_busiest", real(s.processor), "bytes", real(s.bytes), "messages",
                     real(s.messages), "most_bytes_of_a_rank", real(s.most_bytes));
}

/* This mesh on ranks; about the largest of the paper's Table 2, and one as large a rank; and one of 10^10 on 4, 16 and
 * 64 nodes of 64 cores. */
static json_t *replays_of(const struct par_report *r, double triangles)
{
    enum { MOST_TIMES = 100 };
    static const struct {
        int ranks, threads;
        double triangles; /* 0: as many as there are */
    } rows[] = {{1, 1, 0},       {2, 1, 0},       {4, 1, 0},     {9, 1, 0},     {16, 1, 0},   {64, 1, 0},
                {121, 1, 8.7e8}, {1024, 1, 7.4e9}, {32, 8, 1e10}, {128, 8, 1e10}, {512, 8, 1e10}};
    json_t *list = json_array();
    double cells = ((double)r->columns - 1) * ((double)r->rows - 1);
    for (size_t i = 0; cells > 0 && i < sizeof rows / sizeof *rows; i++) {
        double times = fmax(1, round(sqrt(rows[i].triangles / triangles)));
        struct replay_how how = replay_usual(rows[i].ranks, rows[i].threads, (int)fmin(times, MOST_TIMES),
                                             triangles / cells);
        if (times <= MOST_TIMES)
            json_array_append_new(list, replay_of(r, &how, triangles * times * times));
    }
    return list;
}

static json_t *by_reason(const int64_t count[TRI_EXCUSES])
{
    return json_pack("{s:o, s:o, s:o, s:o, s:o}", "input_angle", whole(count[TRI_EXCUSE_INPUT_ANGLE]), "narrow_gap",
                     whole(count[TRI_EXCUSE_NARROW_GAP]), "protected", whole(count[TRI_EXCUSE_PROTECTED]), "limit",
                     whole(count[TRI_EXCUSE_LIMIT]), "precision", whole(count[TRI_EXCUSE_PRECISION]));
}

static const char *const way_names[] = {[PAR_IN_MEMORY] = "in memory", [PAR_SWEPT] = "swept", [PAR_PARKED] = "parked"};

static json_t *schedule_of(const struct par_report *r, double triangles)
{
    json_t *inserted = json_pack("{s:o, s:o}", "free", whole(r->total.inserted_free), "on_segments",
                                 whole(r->total.inserted_on_segments));
    json_t *counts =
        json_pack("{s:i, s:i, s:i, s:i, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "levels", r->levels, "rounds",
                  r->rounds, "columns", (int)r->columns, "rows", (int)r->rows, "prerefined", whole(r->prerefined),
                  "inserted", inserted, "deferred", whole(r->deferred), "left_over", whole(r->left_over), "refused",
                  by_reason(r->total.given_up), "pauses", whole(r->pauses), "radius_lemma7", real(r->radius_lemma7),
                  "radius_theory", real(r->radius_theory), "radius_measured", real(r->radius_measured));
    json_t *way = json_pack("{s:s, s:o, s:o, s:o}", "way", way_names[r->way], "most_live_triangles",
                            whole(r->most_live), "parked_bytes", whole(r->parked), "below_bounds",
                            r->remain_known ? by_reason(r->remain) : json_null());
    if (json_object_update(counts, way)) {
        json_decref(counts);
        counts = NULL;
    }
    json_decref(way);
    json_t *times =
        json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "seconds", parts_of(r), "overhead_percent",
                  real(prediction_overhead(r)), "numbering_percent", real(prediction_numbering(r)),
                  "later_rounds_seconds_estimate", real(prediction_refine(r->blocks, r->n_blocks, 1, r->threads)),
                  "prediction", predictions_of(r), "prediction_on_ranks", replays_of(r, triangles), "blocks",
                  blocks_of(r));
    if (json_object_update(counts, times)) {
        json_decref(counts);
        counts = NULL;
    }
    json_decref(times);
    return counts;
}

/* --- the mesh */

static json_t *histogram_of(const int64_t *count, int n)
{
    json_t *list = json_array();
    for (int i = 0; i < n; i++)
        json_array_append_new(list, whole(count[i]));
    return list;
}

/* Of a mesh that is gone nothing is known but counts: null stands for all else. */
static struct tri_shapes shapes_of(const struct run *run)
{
    struct tri_shapes shapes = {.smallest_area = NAN, .largest_area = NAN, .total_area = NAN, .shortest_edge = NAN,
                                .longest_edge = NAN, .smallest_angle = NAN, .largest_angle = NAN};
    if (!run->plan.swept)
        tri_measure_shapes(&shapes, &run->mesh, run->hooks->executor);
    return shapes;
}

static json_t *mesh_of(const struct run *run)
{
    const struct tri_counts *c = &run->counts;
    const struct tri_refine_options *bounds = &run->options.quality;
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

/* One object a rank; null: there is one process. */
static json_t *ranks_of(const struct rank_report *report)
{
    if (report->n_ranks == 0)
        return json_null();
    json_t *ranks = json_array();
    for (int p = 0; p < report->n_ranks; p++)
        if (json_array_append_new(ranks, rank_of(report->number[p]))) {
            json_decref(ranks);
            return NULL;
        }
    return ranks;
}

/* --- all of it */

static json_t *report_of(const struct run *run, const struct par_report *schedule, const struct rank_report *ranks,
                         int threads)
{
    int64_t memory = resources_memory_peak(); /* before the report needs some */
    const struct tri_refine_options *q = &run->options.quality;
    json_t *bounds = json_pack("{s:o, s:o}", "min_angle", q->min_angle > 0 ? real(q->min_angle) : json_null(),
                               "max_area", q->max_area > 0 ? real(q->max_area) : json_null());
    return json_pack("{s:s, s:s, s:o, s:s?, s:i, s:o, s:o, s:o, s:o, s:o, s:o}", "program", run->hooks->program,
                     "version", PTRIANGLE_VERSION, "command", command_of(run->arguments), "stopped", run->stopped,
                     "threads", threads, "peak_memory_bytes", whole(memory), "bounds", bounds, "seconds",
                     stages_of(run, schedule), "mesh", mesh_of(run), "ranks", ranks_of(ranks), "schedule",
                     schedule ? schedule_of(schedule, (double)run->counts.triangles) : json_null());
}

enum tri_status report_check(struct tri_error *error)
{
    (void)error;
    return TRI_OK;
}

static enum tri_status write_text(const char *path, struct tri_output_set *set, const char *text,
                                  struct tri_error *error)
{
    struct tri_output *output;
    if (report_is_printed(path)) {
        puts(text);
        return TRI_OK; /* the caller looks whether all that was printed is out */
    }
    enum tri_status status = interrupt_open(set, path, &output, error);
    status = status ? status : tri_output_write(output, text, strlen(text), error);
    return status ? status : tri_output_write(output, "\n", 1, error);
}

enum tri_status report_write(const char *path, struct tri_output_set *set, const struct run *run,
                             const struct par_report *schedule, const struct rank_report *ranks, int threads,
                             struct tri_error *error)
{
    json_t *report = report_of(run, schedule, ranks, threads);
    char *text = report ? json_dumps(report, JSON_INDENT(1) | JSON_REAL_PRECISION(9)) : NULL;
    enum tri_status status = text ? write_text(path, set, text, error)
                                  : tri_fail(error, TRI_NO_MEMORY, path, 0, "out of memory for the report");
    free(text);
    json_decref(report);
    return status;
}
