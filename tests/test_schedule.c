/* Compares the whole schedule with the sequential loop: the same bounds, nearly the same size, and the same mesh for
   any number of threads and any order of the blocks.
   Blocks are made small, so that small inputs have many of them. This program is linked with --wrap for malloc, calloc,
   realloc and free: see allocations.h. */
#include "allocations.h"
#include "full.h"
#include "support.h"

#include <pthread.h>
#include <stdatomic.h>
#include <sys/resource.h>

#include "sched/schedule/schedule.h"
#include "sched/tiles/numbering.h"
#include "sched/tiles/park.h"
#include "sched/tiles/tiles.h"
#include "tile_order.h"
#include "triangle/mesh/topology.h"
#include "trials.h"

/* Every test that compares meshes runs the first twelve. The rest are difficult inputs. */
static const struct trial trials[] = {
    {"letter.poly", 30, 20000, 500, false, false, 0},
    {"square_random1000.poly", 20, 20000, 700, false, false, 0},
    {"square_random1000.poly", 33, 0, 256, false, false, 0},
    {"section.poly", 28, 20000, 400, false, true, 0},
    {"gear.poly", 30, 10000, 256, false, false, 0},
    {"koch_lake.poly", 30, 0, 600, false, false, 0},
    {"coast/norway_sea.poly", 25, 0, 2000, false, false, 0},
    {"coast/borders.poly", 20, 30000, 1500, false, false, 0},
    {"coast/islands.poly", 34, 15000, 500, true, false, 0},
    {"perforated.poly", 30, 25000, 1000, true, false, 0},
    {"naca2412_box.poly", 32, 10000, 256, false, false, 0},
    {"cracked_plate.poly", 28, 15000, 400, false, false, 1},
    {"section.poly", 35, 20000, 500, true, true, 0},
    {"box_hole.poly", 0, 10000, 256, false, false, 0},
    {"nasty/crossing_random.poly", 25, 10000, 256, false, false, 0},
    {"nasty/dense_parallel.poly", 20, 5000, 256, false, false, 2},
    {"nasty/fan_1deg.poly", 25, 10000, 256, false, false, 0},
    {"nasty/spike.poly", 30, 10000, 256, false, false, 0},
    {"nasty/tiny_feature.poly", 30, 10000, 256, false, false, 0},
    {"nasty/nested_holes.poly", 30, 10000, 256, false, false, 0},
    {"nasty/aspect_1e8.poly", 20, 10000, 256, false, false, 0},
    {"nasty/needle_1e-9.poly", 20, 4000, 256, false, false, 0},
    {"nasty/slit_1e-9.poly", 20, 10000, 256, false, false, 0},
    {"nasty/huge_offset.poly", 20, 10000, 256, false, false, 0},
    {"nasty/huge_scale.poly", 30, 10000, 256, false, false, 0},
    {"nasty/cocircular_grid.node", 20, 40000, 700, false, false, 0},
    {"regress/ulps_apart.poly", 30, 8000, 256, false, false, 0},
    {"regress/needles.poly", 30, 8000, 256, true, false, 0},
};

enum { N_TRIALS = sizeof trials / sizeof *trials, N_USUAL = 12 };

static struct tri_mesh refine(const struct start *start, const struct par_options *options, struct par_report *report)
{
    struct tri_error error = {0};
    struct tri_mesh mesh = trials_coarse_mesh(start);
    if (par_refine(&mesh, &start->options.quality, options, report, &error) != TRI_OK)
        fail_msg("par_refine: %s", error.text);
    return mesh;
}

static struct par_options small_blocks(double block, int threads)
{
    struct par_options options = par_defaults();
    options.cell_triangles = block;
    options.threads = threads;
    return options;
}

static int64_t sum_bad(const struct tri_mesh *mesh, const struct tri_quality *quality,
                       const struct tri_refine_report *report)
{
    int64_t count[TRI_EXCUSES], sum = 0;
    tri_count_bad(mesh, quality, report, NULL, count);
    for (int k = 0; k < TRI_EXCUSES; k++)
        sum += count[k];
    return sum;
}

/* Area bounds are met regardless of angles, except in an unfinished mesh. */
static void judge(const struct start *start, const struct tri_mesh *mesh, int64_t max_bad)
{
    const struct tri_quality *quality = &start->options.quality;
    struct tri_check_options check = {.max_bad = max_bad, .min_angle = quality->min_angle, .ignore_lost = true};
    check.max_area = max_bad < INT64_MAX ? quality->max_area : 0;
    check.delaunay = quality->conforming ? TRI_CHECK_CONFORMING : TRI_CHECK_CONSTRAINED;
    support_judge(mesh, &start->pslg, &check, quality->region_areas && max_bad < INT64_MAX, NULL);
}

/* The mesh is valid. Its number of bad triangles is about that of the sequential loop. */
static void compare_with_sequential(const struct trial *trial, const struct start *start, const struct tri_mesh *mesh,
                                    const struct par_report *report)
{
    struct tri_report sequential;
    struct tri_mesh plain = support_generate(&start->pslg, &start->options, &sequential);
    int64_t bad = sum_bad(mesh, &start->options.quality, &report->total);
    int64_t plain_bad = sum_bad(&plain, &start->options.quality, &sequential.quality);
    print_message(
        "  %-28s %7d triangles, sequential %7d (%+.1f %%), bad %d / %d, blocks %d x %d, levels %d, rounds %d, "
        "deferred %lld, left over %lld\n",
        trial->file, (int)mesh->n_triangles, (int)plain.n_triangles,
        100.0 * mesh->n_triangles / plain.n_triangles - 100, (int)bad,
        (int)plain_bad, (int)report->columns, (int)report->rows, report->levels, report->rounds,
        (long long)report->deferred, (long long)report->left_over);
    judge(start, mesh, bad);
    bool beyond = start->options.quality.min_angle > 28; /* beyond this, the number of bad triangles depends on the
                                                            order */
    assert_true(bad <= plain_bad + plain_bad / 4 + 10 * (beyond || plain_bad > 0));
    assert_true(report->columns * report->rows >= 9);
    assert_true(mesh->n_triangles < 1.18 * plain.n_triangles);
    assert_int_equal(mesh->n_vertices, start->pslg.n_points + sequential.constrain.crossings +
                                           report->total.inserted_free + report->total.inserted_on_segments);
    tri_mesh_free(&plain);
}

static void test_bounds_and_size_are_those_of_the_sequential_loop(void **state)
{
    (void)state;
    for (int i = 0; i < N_TRIALS; i += every(6)) {
        struct start start = trials_start_of(&trials[i]);
        struct par_options options = small_blocks(trials[i].block, 2);
        struct par_report report;
        struct tri_mesh mesh = refine(&start, &options, &report);
        compare_with_sequential(&trials[i], &start, &mesh, &report);
        par_report_free(&report);
        tri_mesh_free(&mesh);
        tri_pslg_free(&start.pslg);
    }
}

/* The reports are equal except for the times. */
static void assert_same_report(const struct par_report *a, const struct par_report *b)
{
    assert_memory_equal(&a->total, &b->total, sizeof a->total);
    assert_int_equal(a->n_blocks, b->n_blocks);
    assert_int_equal(a->pauses, b->pauses);
    for (int32_t i = 0; i < a->n_blocks; i++) {
        assert_int_equal(a->blocks[i].block, b->blocks[i].block);
        assert_int_equal(a->blocks[i].worklist, b->blocks[i].worklist);
        assert_int_equal(a->blocks[i].inserted, b->blocks[i].inserted);
    }
}

static void test_any_number_of_threads_and_order_of_blocks_make_one_mesh(void **state)
{
    (void)state;
    static const struct {
        int threads;
        unsigned shuffle;
    } runs[] = {{3, 1}, {8, 0}, {2, 4711}};
    for (int i = 0; i < N_TRIALS; i += every(6)) {
        struct start start = trials_start_of(&trials[i]);
        struct par_options options = small_blocks(trials[i].block, 1);
        struct par_report first_report, report;
        print_message("  %s\n", trials[i].file);
        struct tri_mesh first = refine(&start, &options, &first_report), before = trials_coarse_mesh(&start);
        support_assert_on_surface(&before, &first);
        tri_mesh_free(&before);
        for (int k = 0; k < (i < N_USUAL ? 3 : 1); k++) {
            options.threads = runs[k].threads;
            options.shuffle = runs[k].shuffle;
            struct tri_mesh mesh = refine(&start, &options, &report);
            support_assert_same_bytes(&first, &mesh);
            assert_same_report(&first_report, &report);
            par_report_free(&report);
            tri_mesh_free(&mesh);
        }
        par_report_free(&first_report);
        tri_mesh_free(&first);
        tri_pslg_free(&start.pslg);
    }
}

/* If blocks number the mesh, the ids depend on the room from which a block took them. The positions do not depend on it
   if one schedule does all the work, since a second schedule begins in the order of the ids. The same mesh has the same
   numbers, unless blocks number it. */
static void test_room_changes_only_ids(void **state)
{
    (void)state;
    static const int32_t rooms[] = {1, 50};
    for (int i = 0; i < N_USUAL; i += every(4)) {
        struct start start = trials_start_of(&trials[i]);
        struct par_options options = small_blocks(trials[i].block, 2);
        struct par_report report, tight;
        struct tri_mesh mesh = refine(&start, &options, &report);
        struct support_places places = support_places(&mesh);
        struct tri_mesh coarse = trials_coarse_mesh(&start);
        int32_t n_kept = coarse.n_vertices;
        tri_mesh_free(&coarse);
        for (int k = 0; k < 2; k++) {
            options.tight_room = rooms[k];
            options.shuffle = (unsigned)k;
            options.by_block = k == 1;
            struct tri_mesh other = refine(&start, &options, &tight);
            struct support_places others = support_places(&other);
            bool same = support_same_places(&places, &others);
            assert_true(tight.pauses > 0);
            if (report.levels == 1 && trials[i].angle <= 30)
                assert_true(same);
            if (same && !options.by_block)
                support_assert_same_bytes(&mesh, &other);
            if (same && options.by_block && trials[i].angle <= TRI_EASY_ANGLE) {
                assert_int_equal(par_number(&other, &report.partition, n_kept, NULL, NULL), TRI_OK);
                support_assert_same_bytes(&mesh, &other);
            }
            print_message("  %-28s room %d: levels %d, left over %lld, %s\n", trials[i].file, (int)rooms[k],
                          report.levels, (long long)report.left_over, same ? "same" : "other");
            judge(&start, &other, sum_bad(&other, &start.options.quality, &tight.total));
            support_places_free(&others);
            par_report_free(&tight);
            tri_mesh_free(&other);
        }
        support_places_free(&places);
        par_report_free(&report);
        tri_mesh_free(&mesh);
        tri_pslg_free(&start.pslg);
    }
}

struct bytes {
    char *byte;
    size_t n, capacity;
};

/* All tiles that are handed out, one after the other. */
struct stream {
    struct bytes all, points, corners, ends;
    int64_t n, n_vertices, n_triangles, n_segments;
    int32_t n_attributes, n_begun, n_ended;
    int32_t n_kept; /* the stream arrives in tiles: number of vertices before refinement; 0: all tiles count as one */
};

static void append(struct bytes *b, const void *bytes, size_t n)
{
    if (b->n + n > b->capacity) {
        b->capacity = 2 * (b->n + n);
        b->byte = realloc(b->byte, b->capacity);
        assert_non_null(b->byte);
    }
    if (n > 0)
        memcpy(b->byte + b->n, bytes, n);
    b->n += n;
}

static void free_stream(struct stream *s)
{
    free(s->all.byte);
    free(s->points.byte);
    free(s->corners.byte);
    free(s->ends.byte);
}

static void assert_same_stream(const struct stream *a, const struct stream *b)
{
    assert_int_equal(a->n_triangles, b->n_triangles);
    assert_int_equal(a->all.n, b->all.n);
    assert_memory_equal(a->all.byte, b->all.byte, a->all.n);
}

static enum tri_status begin_stream(void *user, const struct tri_stream *told, struct tri_error *error)
{
    struct stream *s = user;
    (void)error;
    assert_true(s->n_ended == 0 && told->estimate > 0);
    free_stream(s); /* drops all tiles so far */
    *s = (struct stream){.n_begun = s->n_begun + 1, .n_kept = s->n_kept};
    append(&s->all, &told->estimate, sizeof told->estimate);
    s->n_attributes = told->n_attributes;
    append(&s->all, told->regions, (size_t)told->n_regions * (size_t)told->n_columns * sizeof *told->regions);
    return TRI_OK;
}

static enum tri_status take_tile(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    struct stream *s = user;
    (void)error;
    assert_true(s->n_begun > 0 && s->n_ended == 0 && tile->first_vertex == s->n_vertices &&
                tile->first_triangle == s->n_triangles && tile->first_segment == s->n_segments);
    assert_true((s->n++ == 0 || s->n_vertices < s->n_kept) == (tile->column == -1));
    s->n_vertices += tile->n_vertices;
    s->n_triangles += tile->n_triangles;
    s->n_segments += tile->n_segments;
    append(&s->all, &tile->column, sizeof tile->column);
    append(&s->all, &tile->row, sizeof tile->row);
    append(&s->all, tile->points, (size_t)tile->n_vertices * sizeof *tile->points);
    append(&s->all, tile->point_markers, (size_t)tile->n_vertices * sizeof *tile->point_markers);
    append(&s->all, tile->attributes, (size_t)(tile->n_vertices * s->n_attributes) * sizeof *tile->attributes);
    append(&s->all, tile->corners, (size_t)tile->n_triangles * sizeof *tile->corners);
    append(&s->all, tile->regions, (size_t)tile->n_triangles * sizeof *tile->regions);
    append(&s->all, tile->ends, (size_t)tile->n_segments * sizeof *tile->ends);
    append(&s->all, tile->segment_markers, (size_t)tile->n_segments * sizeof *tile->segment_markers);
    append(&s->points, tile->points, (size_t)tile->n_vertices * sizeof *tile->points);
    append(&s->corners, tile->corners, (size_t)tile->n_triangles * sizeof *tile->corners);
    append(&s->ends, tile->ends, (size_t)tile->n_segments * sizeof *tile->ends);
    return TRI_OK;
}

static enum tri_status end_stream(void *user, struct tri_error *error)
{
    (void)error;
    ((struct stream *)user)->n_ended++;
    return TRI_OK;
}

static enum tri_status refine_to(struct stream *stream, const struct start *start, const struct par_options *how,
                                 struct par_report *report, struct tri_mesh *mesh)
{
    struct par_options options = *how;
    *mesh = trials_coarse_mesh(start);
    *stream = (struct stream){0};
    const struct tri_sink sink = {stream, begin_stream, take_tile, end_stream};
    options.sink = &sink;
    options.figure = &start->pslg;
    options.region_column = true;
    enum tri_status status = par_refine(mesh, &start->options.quality, &options, report, NULL);
    assert_int_equal(stream->n_ended, status == TRI_OK);
    return status;
}

static const char *const ways[] = {"in memory", "swept", "parked"};

/* Column by column, on more threads, with other room: the tiles have the same bytes as those of a mesh in memory. If
   blocks leave bad triangles, or a second schedule follows, the mesh is parked. */
static void test_budgets_hand_out_the_same_tiles(void **state)
{
    (void)state;
    int n_ways[3] = {0}, begun_again = 0;
    for (int i = 0; i < N_TRIALS; i += every(6)) {
        struct start start = trials_start_of(&trials[i]);
        struct par_options options = small_blocks(trials[i].block, 2);
        struct par_report report, tight_report;
        struct tri_mesh mesh, tight;
        struct stream whole, parts;
        mesh = trials_coarse_mesh(&start);
        int32_t n_kept = mesh.n_vertices;
        tri_mesh_free(&mesh);
        assert_int_equal(refine_to(&whole, &start, &options, &report, &mesh), TRI_OK);
        assert_true(whole.n_triangles == mesh.n_triangles && whole.n_vertices == mesh.n_vertices &&
                    whole.n_segments == mesh.n_subs && report.way == PAR_IN_MEMORY);
        if (start.options.quality.min_angle <= TRI_EASY_ANGLE)
            assert_in_order(&mesh, &report.partition, n_kept);
        options.memory = 1000;
        options.scratch = ".";
        options.threads = 3;
        if (start.options.quality.min_angle <= TRI_EASY_ANGLE) /* a final sequential call begins in the order of ids */
            options.tight_room = 100;
        assert_int_equal(refine_to(&parts, &start, &options, &tight_report, &tight), TRI_OK);
        print_message("  %-28s %lld triangles, rounds %d, %s: %lld bytes on disk\n", trials[i].file,
                      (long long)whole.n_triangles, report.rounds, ways[tight_report.way],
                      (long long)tight_report.parked);
        assert_same_stream(&parts, &whole);
        assert_memory_equal(&tight_report.total, &report.total, sizeof report.total);
        assert_true(tight_report.parked > 0); /* nothing fits, including the state of a sweep */
        n_ways[tight_report.way]++;
        begun_again += parts.n_begun > 1;
        free_stream(&whole);
        free_stream(&parts);
        par_report_free(&report);
        par_report_free(&tight_report);
        tri_mesh_free(&mesh);
        tri_mesh_free(&tight);
        tri_pslg_free(&start.pslg);
    }
    assert_true(n_ways[PAR_SWEPT] >= 1 && n_ways[PAR_PARKED] >= 1);
    assert_true(!is_full() || (n_ways[PAR_SWEPT] >= 4 && n_ways[PAR_PARKED] >= 4 && begun_again >= 2));
}

/* A run that starts from the input, in which the caller's points have different numbers while the mesh is made. */
struct whole_run {
    const struct start *start;
    struct par_options options;
    struct stream stream;
    struct par_report report;
};

static enum tri_status refine_whole_run(void *user, struct tri_mesh *mesh, const struct tri_quality *quality,
                                        struct tri_refine_report *total, struct tri_error *error)
{
    struct whole_run *run = user;
    const struct tri_sink sink = {&run->stream, begin_stream, take_tile, end_stream};
    run->options.sink = &sink;
    run->options.figure = &run->start->pslg;
    enum tri_status status = par_refine(mesh, quality, &run->options, &run->report, error);
    *total = run->report.total;
    if (run->options.sweep) { /* the mesh has been dissolved */
        tri_mesh_free(mesh);
        return tri_mesh_init(mesh, error) ? TRI_NO_MEMORY : status;
    }
    return status;
}

static struct tri_mesh generate_whole_run(struct whole_run *run)
{
    struct tri_options options = run->start->options;
    options.use_segments = run->start->pslg.n_segments > 0;
    options.refine = true;
    options.refine_call = refine_whole_run;
    options.refine_user = run;
    return support_generate(&run->start->pslg, &options, NULL);
}

static void assert_stream_is(const struct stream *stream, const struct tri_mesh *mesh, const struct tri_pslg *pslg)
{
    const double(*points)[2] = (const double(*)[2])(void *)stream->points.byte;
    const int64_t(*corners)[3] = (const int64_t(*)[3])(void *)stream->corners.byte;
    const int64_t(*ends)[2] = (const int64_t(*)[2])(void *)stream->ends.byte;
    assert_true(stream->n_vertices == mesh->n_vertices && stream->n_triangles == mesh->n_triangles &&
                stream->n_segments == mesh->n_subs);
    assert_memory_equal(points, pslg->points, (size_t)mesh->n_input * sizeof *points);
    for (int32_t v = mesh->n_input; v < mesh->n_vertices; v++) {
        double at[2];
        tri_mesh_place(mesh, v, at);
        assert_memory_equal(points[v], at, sizeof at);
    }
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        for (int k = 0; k < 3; k++)
            assert_int_equal(corners[t][k], mesh->tri[t].v[k]);
    for (int32_t s = 0; s < mesh->n_subs; s++)
        for (int k = 0; k < 2; k++)
            assert_int_equal(ends[s][k], mesh->sub[s].v[k]);
}

static void assert_same_in_pieces(const struct stream *stream, struct tri_mesh *mesh, const struct tri_pslg *pslg)
{
    struct stream pieces = {.n_kept = mesh->n_input};
    const struct tri_sink sink = {&pieces, begin_stream, take_tile, end_stream};
    struct par_tiles tiles = {.mesh = mesh, .sink = &sink, .figure = pslg, .n_kept = mesh->n_input, .kept_at_once = 7};
    assert_int_equal(par_tiles_whole(&tiles, NULL), TRI_OK);
    assert_true(pieces.n_ended == 1 && pieces.n >= (mesh->n_input + 6) / 7 + 2);
    assert_memory_equal(pieces.points.byte, stream->points.byte, stream->points.n);
    assert_memory_equal(pieces.corners.byte, stream->corners.byte, stream->corners.n);
    assert_memory_equal(pieces.ends.byte, stream->ends.byte, stream->ends.n);
    free_stream(&pieces);
}

/* In memory, in a stream and in a sweep, also for one sequential call and with the numbers of the blocks. */
static void test_a_stream_has_the_numbers_of_the_mesh(void **state)
{
    (void)state;
    enum { SCHEDULE, SEQUENTIAL, BY_BLOCK, WAYS };
    for (int i = 0; i < N_USUAL; i += every(4))
        for (int way = 0; way < WAYS; way++) {
            struct start start = trials_start_of(&trials[i]);
            struct whole_run run = {.start = &start, .options = small_blocks(trials[i].block, 2)};
            run.options.cell_triangles = way == SEQUENTIAL ? 1e9 : run.options.cell_triangles;
            run.options.by_block = way == BY_BLOCK;
            struct tri_mesh mesh = generate_whole_run(&run);
            assert_true((run.report.levels == 0) == (way == SEQUENTIAL));
            assert_stream_is(&run.stream, &mesh, &start.pslg);
            assert_same_in_pieces(&run.stream, &mesh, &start.pslg);
            if (way == SCHEDULE && run.report.rounds == 1) {
                struct whole_run swept = {.start = &start, .options = small_blocks(trials[i].block, 3)};
                swept.options.sweep = true;
                struct tri_mesh nothing = generate_whole_run(&swept);
                assert_same_stream(&swept.stream, &run.stream);
                free_stream(&swept.stream);
                par_report_free(&swept.report);
                tri_mesh_free(&nothing);
            }
            free_stream(&run.stream);
            par_report_free(&run.report);
            tri_mesh_free(&mesh);
            tri_pslg_free(&start.pslg);
        }
}

static enum tri_status refine_parked(const struct start *start, const char *scratch, struct tri_error *error)
{
    struct par_options options = small_blocks(256, 2);
    struct par_report report;
    struct stream stream = {0};
    struct tri_mesh mesh = trials_coarse_mesh(start);
    const struct tri_sink sink = {&stream, begin_stream, take_tile, end_stream};
    options.sink = &sink;
    options.memory = 1000;
    options.scratch = scratch;
    enum tri_status status = par_refine(&mesh, &start->options.quality, &options, &report, error);
    assert_int_equal(stream.n_ended, status == TRI_OK);
    par_report_free(&report);
    tri_mesh_free(&mesh);
    free_stream(&stream);
    return status;
}

/* If a mesh cannot be parked, an error is returned, and no signal is raised. */
static void test_unusable_scratch_files_are_an_error(void **state)
{
    (void)state;
    struct start start = {support_square(1, 100, 5), support_quality(33, 1e-4)};
    struct rlimit before, limit;
    struct tri_error error = {0};
    assert_int_equal(refine_parked(&start, ".", &error), TRI_OK);
    assert_int_equal(refine_parked(&start, NULL, &error), TRI_TOO_LARGE);
    assert_int_equal(refine_parked(&start, "nowhere", &error), TRI_CANNOT_WRITE);
    assert_string_equal(error.file, "nowhere");
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    limit = before;
    limit.rlim_cur = 1 << 17; /* less than the size of an array's file */
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
    enum tri_status status = refine_parked(&start, ".", &error);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    assert_int_equal(status, TRI_CANNOT_WRITE);
    tri_pslg_free(&start.pslg);
}

static struct start square(int32_t points, double angle, double max_area)
{
    return (struct start){support_square(1, points, 5), support_quality(angle, max_area)};
}

static void assert_same_edges(const struct tri_mesh *a, const struct tri_mesh *b)
{
    struct tri_edge_list one, other;
    assert_int_equal(tri_edge_list_make(&one, a, true, NULL), TRI_OK);
    assert_int_equal(tri_edge_list_make(&other, b, true, NULL), TRI_OK);
    assert_int_equal(one.n, other.n);
    assert_memory_equal(one.codes, other.codes, (size_t)one.n * sizeof *one.codes);
    assert_memory_equal(one.number, other.number, 3 * (size_t)a->n_triangles * sizeof *one.number);
    tri_edge_list_free(&one);
    tri_edge_list_free(&other);
}

/* Without a sink, a mesh that exceeds the bound is still returned, in files if the caller keeps them. The result is the
   same, swept or not. */
static void test_a_mesh_above_the_bound_lies_in_files(void **state)
{
    (void)state;
    static const double angles[] = {20, 33, 35};
    for (int i = 0; i < 3; i++) {
        struct start start = square(100, angles[i], 4e-4);
        struct par_options options = small_blocks(256, 2);
        struct par_report report;
        struct par_park *park;
        struct tri_error error = {0};
        options.park = &park;
        struct tri_mesh whole = refine(&start, &options, &report);
        assert_null(park);
        par_report_free(&report);
        options.memory = 1000;
        options.scratch = ".";
        struct tri_mesh filed = refine(&start, &options, &report);
        assert_true(park && filed.storage && report.way == PAR_PARKED && report.parked > 0);
        par_report_free(&report);
        support_assert_same_bytes(&whole, &filed);
        assert_same_edges(&whole, &filed);
        judge(&start, &filed, INT64_MAX);
        tri_mesh_free(&filed);
        par_park_close(park, NULL);
        options.park = NULL;
        filed = trials_coarse_mesh(&start);
        assert_int_equal(par_refine(&filed, &start.options.quality, &options, &report, &error), TRI_NO_MEMORY);
        par_report_free(&report);
        tri_mesh_free(&filed);
        tri_mesh_free(&whole);
        tri_pslg_free(&start.pslg);
    }
}

/* Later tiles reuse the memory of tiles that have been handed out. */
static void test_a_sweep_holds_few_columns(void **state)
{
    (void)state;
    struct start start = {support_square(1, 100, 5), support_quality(20, 1e-5)};
    struct par_options options = small_blocks(500, 2);
    struct par_report report;
    struct tri_mesh mesh;
    struct stream stream;
    options.sweep = true;
    assert_int_equal(refine_to(&stream, &start, &options, &report, &mesh), TRI_OK);
    print_message("  %lld triangles through %lld\n", (long long)stream.n_triangles, (long long)report.most_live);
    assert_true(report.way == PAR_SWEPT && report.most_live < stream.n_triangles / 2);
    free_stream(&stream);
    par_report_free(&report);
    tri_mesh_free(&mesh);
    tri_pslg_free(&start.pslg);
}

/* Above 31 degrees sizes are met first. The next stage must not depend on the numbering. */
static void test_the_numbering_changes_only_ids(void **state)
{
    (void)state;
    static const double angles[] = {25, 33, 35};
    for (int i = 0; i < 3; i++) {
        struct start start = square(100, angles[i], 1e-4);
        struct par_options options = small_blocks(300, 2);
        struct par_report report[2];
        struct tri_mesh mesh[2];
        struct support_places places[2];
        for (int k = 0; k < 2; k++) {
            options.by_block = k;
            mesh[k] = refine(&start, &options, &report[k]);
            places[k] = support_places(&mesh[k]);
        }
        assert_true(report[0].levels > 0 && report[0].seconds_number > 0 && report[1].seconds_number == 0);
        assert_true(support_same_places(&places[0], &places[1]));
        if (angles[i] <= TRI_EASY_ANGLE) { /* otherwise the report's partition is that of the first schedule */
            assert_int_equal(par_number(&mesh[1], &report[1].partition, start.pslg.n_points, NULL, NULL), TRI_OK);
            support_assert_same_bytes(&mesh[0], &mesh[1]);
        }
        for (int k = 0; k < 2; k++) {
            support_places_free(&places[k]);
            par_report_free(&report[k]);
            tri_mesh_free(&mesh[k]);
        }
        tri_pslg_free(&start.pslg);
    }
}

static bool is_before(const struct par_block_report *a, const struct par_block_report *b)
{
    if (a->schedule != b->schedule)
        return a->schedule < b->schedule;
    if (a->round != b->round)
        return a->round < b->round;
    return a->phase != b->phase ? a->phase < b->phase : a->block < b->block;
}

/* Above 31 degrees the mesh is refined by two schedules. Messages about blocks name the schedule, and the rest of the
   report is that of the first. */
static void test_messages_name_the_schedule(void **state)
{
    (void)state;
    struct start start = square(100, 25, 1e-4);
    struct par_options options = small_blocks(300, 2);
    struct par_report one, two;
    struct tri_mesh mesh = refine(&start, &options, &one);
    tri_mesh_free(&mesh);
    start.options.quality.min_angle = 33;
    mesh = refine(&start, &options, &two);
    for (int32_t i = 1; i < two.n_blocks; i++)
        assert_true(is_before(&two.blocks[i - 1], &two.blocks[i]));
    assert_true(two.blocks[two.n_blocks - 1].schedule > one.blocks[one.n_blocks - 1].schedule);
    assert_true(one.columns == two.columns && one.rows == two.rows && one.prerefined == two.prerefined);
    par_report_free(&one);
    par_report_free(&two);
    tri_mesh_free(&mesh);
    tri_pslg_free(&start.pslg);
}

/* A triangle with several encroached walls beyond the fence of a small block is listed once. If it were listed once for
   each wall, the worklist would grow threefold in every phase. */
static void test_deferred_triangles_are_listed_once(void **state)
{
    (void)state;
    static const double place[][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-0.0029265, -0.0026616},
                                      {0.055498, -0.63862}, {7.4953e-07, -6.5255e-07}, {-0.12927, -0.25733},
                                      {-1.1001e-07, -6.5239e-08}};
    static const int32_t ends[][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {8, 7}, {6, 7}};
    struct par_report report;
    struct start start = {.pslg = support_pslg(9, 7, 0, 0), .options = support_quality(25, 0)};
    struct par_options options = small_blocks(60, 2);
    for (int i = 0; i < 9; i++)
        support_add_point(&start.pslg, place[i][0], place[i][1]);
    for (int i = 0; i < 7; i++)
        support_add_segment(&start.pslg, ends[i][0], ends[i][1]);
    start.options.quality.conforming = true;
    struct tri_mesh mesh = refine(&start, &options, &report);
    judge(&start, &mesh, sum_bad(&mesh, &start.options.quality, &report.total));
    assert_true(report.rounds > 0 && report.deferred < 20 * (int64_t)mesh.n_triangles);
    par_report_free(&report);
    tri_mesh_free(&mesh);
    tri_pslg_free(&start.pslg);
}

/* Cuts do not run along a gap that contains nearly all of the work, vertical or horizontal. */
static void test_a_long_gap_costs_no_triangles(void **state)
{
    (void)state;
    for (int turned = 0; turned < 2; turned++) {
        struct par_report report;
        struct start start = {.options = support_quality(32, 0)};
        struct par_options blocks = small_blocks(1000, 2), one_call = small_blocks(1e9, 1);
        assert_true(support_read("regress/long_gap.poly", &start.pslg));
        for (int32_t v = 0; turned && v < start.pslg.n_points; v++) {
            double *p = start.pslg.points + 2 * (size_t)v, x = p[0];
            p[0] = p[1];
            p[1] = x;
        }
        struct tri_mesh sequential = refine(&start, &one_call, &report);
        assert_int_equal(report.levels, 0);
        par_report_free(&report);
        struct tri_mesh mesh = refine(&start, &blocks, &report);
        print_message("  %d triangles, by the schedule %d\n", (int)sequential.n_triangles, (int)mesh.n_triangles);
        assert_true(report.levels > 0 && mesh.n_triangles < 1.1 * sequential.n_triangles);
        par_report_free(&report);
        tri_mesh_free(&sequential);
        tri_mesh_free(&mesh);
        tri_pslg_free(&start.pslg);
    }
}

/* A first call on trial gives up no triangle if the schedule continues after it. */
static void test_a_trial_call_gives_nothing_up(void **state)
{
    (void)state;
    struct start start = square(15000, 28, 0);
    const struct par_options options = small_blocks(4000, 2);
    struct par_report report;
    struct tri_mesh mesh = refine(&start, &options, &report);
    assert_true(report.levels > 0);
    assert_int_equal(sum_bad(&mesh, &start.options.quality, &report.total), 0);
    assert_int_equal(report.total.given_up[TRI_EXCUSE_LIMIT], 0);
    par_report_free(&report);
    tri_mesh_free(&mesh);
    tri_pslg_free(&start.pslg);
}

/* With blocks of the default size, the mesh is at most two per cent larger than the sequential one. */
static void test_default_blocks_cost_no_triangles(void **state)
{
    (void)state;
    static const double angles[] = {20, 33};
    for (int k = 0; k < 2; k += every(2)) {
        struct start start = square(1000, angles[k], 5e-6);
        struct par_options options = par_defaults();
        struct par_report report;
        options.threads = 2;
        struct tri_mesh mesh = refine(&start, &options, &report);
        struct tri_mesh plain = support_generate(&start.pslg, &start.options, NULL);
        print_message("  %d triangles, sequential %d (%+.2f %%), blocks %d x %d\n", (int)mesh.n_triangles,
                      (int)plain.n_triangles, 100.0 * mesh.n_triangles / plain.n_triangles - 100, (int)report.columns,
                      (int)report.rows);
        assert_true(report.columns * report.rows >= 9);
        assert_true(mesh.n_triangles < 1.02 * plain.n_triangles);
        assert_int_equal(sum_bad(&mesh, &start.options.quality, &report.total), 0);
        par_report_free(&report);
        tri_mesh_free(&plain);
        tri_mesh_free(&mesh);
        tri_pslg_free(&start.pslg);
    }
}

/* Small sizes along a line. */
static int is_unsuitable(void *user, const double a[2], const double b[2], const double c[2], double area)
{
    double x = (a[0] + b[0] + c[0]) / 3, y = (a[1] + b[1] + c[1]) / 3, away = fabs(y - x);
    atomic_fetch_add((atomic_llong *)user, 1);
    return area > 2e-6 + 2e-3 * away * away;
}

static void test_a_size_test_runs_in_parallel_only_where_allowed(void **state)
{
    (void)state;
    atomic_llong asked = 0;
    struct start start = square(50, 25, 2e-4);
    start.options.quality.unsuitable = is_unsuitable;
    start.options.quality.unsuitable_user = &asked;
    struct tri_mesh plain = support_generate(&start.pslg, &start.options, NULL), first = {0};
    for (int threads = 1; threads <= 3; threads++) {
        struct par_options options = small_blocks(256, threads);
        struct par_report report;
        struct tri_mesh mesh = refine(&start, &options, &report);
        assert_int_equal(report.n_blocks, 0);
        support_assert_same_bytes(&mesh, &plain);
        par_report_free(&report);
        tri_mesh_free(&mesh);
        options.size_test_in_parallel = true;
        mesh = refine(&start, &options, &report);
        assert_true(report.n_blocks > 9);
        assert_int_equal(sum_bad(&mesh, &start.options.quality, &report.total), 0);
        assert_true(mesh.n_triangles < 1.1 * plain.n_triangles);
        judge(&start, &mesh, 0);
        if (threads == 1) {
            first = mesh;
        } else {
            support_assert_same_bytes(&first, &mesh);
            tri_mesh_free(&mesh);
        }
        par_report_free(&report);
    }
    assert_true(asked > 1000);
    tri_mesh_free(&first);
    tri_mesh_free(&plain);
    tri_pslg_free(&start.pslg);
}

static bool open_gate(void *user, const double p[2])
{
    (void)user;
    return p[0] == p[0];
}

/* Options that the schedule does not support lead to one sequential call. */
static void test_limits_and_gates_lead_to_a_sequential_call(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        struct start start = square(20, 25, 1e-4);
        struct par_options options = small_blocks(256, 3);
        struct par_report report;
        start.options.quality.max_steiner = k ? -1 : 3000;
        const struct tri_refine_hooks hooks = {.gate = k ? open_gate : NULL};
        options.hooks = &hooks;
        struct tri_mesh mesh = refine(&start, &options, &report),
                        plain = support_generate(&start.pslg, &start.options, NULL);
        support_assert_same_bytes(&mesh, &plain);
        assert_int_equal(report.n_blocks, 0);
        assert_true(report.total.hit_limit == (k == 0));
        assert_true(k || report.total.inserted_free + report.total.inserted_on_segments <= 3000);
        par_report_free(&report);
        tri_mesh_free(&plain);
        tri_mesh_free(&mesh);
        tri_pslg_free(&start.pslg);
    }
}

/* -Y leaves the boundary unchanged, -YY all segments. */
static void test_protected_segments_stay_whole(void **state)
{
    (void)state;
    for (int protect = 1; protect <= 2; protect++) {
        struct trial trial = {"section.poly", 25, 20000, 400, false, true, protect};
        struct start start = trials_start_of(&trial);
        struct par_options options = small_blocks(trial.block, 2);
        struct par_report report;
        struct tri_mesh before = trials_coarse_mesh(&start), mesh = refine(&start, &options, &report);
        int32_t old_edge = 0, edge = 0;
        for (int32_t s = 0; s < before.n_subs; s++)
            old_edge += before.sub[s].side[0] == TRI_NONE || before.sub[s].side[1] == TRI_NONE;
        for (int32_t s = 0; s < mesh.n_subs; s++)
            edge += mesh.sub[s].side[0] == TRI_NONE || mesh.sub[s].side[1] == TRI_NONE;
        assert_int_equal(edge, old_edge);
        assert_true(protect == 2 ? mesh.n_subs == before.n_subs : mesh.n_subs > before.n_subs);
        assert_true(report.n_blocks > 9);
        par_report_free(&report);
        tri_mesh_free(&before);
        tri_mesh_free(&mesh);
        tri_pslg_free(&start.pslg);
    }
}

/* Coordinates times 2^k and areas times 4^k give the same numbers in the mesh, regardless of the internal unit. */
static void test_any_unit_makes_the_same_mesh(void **state)
{
    (void)state;
    static const int exponents[] = {300, -300, 1000, -1000};
    for (int angle_only = 0; angle_only < 2; angle_only++) {
        struct start start = square(angle_only ? 5000 : 50, 30, angle_only ? 0 : 1e-4);
        struct par_options options = small_blocks(500, 2);
        struct par_report report;
        struct tri_mesh plain = refine(&start, &options, &report);
        par_report_free(&report);
        for (int i = 0; i < 4; i++) {
            struct tri_error error = {0};
            if (!angle_only && abs(exponents[i]) > 300)
                continue; /* the area bound itself is not representable */
            struct start other = square(angle_only ? 5000 : 50, 30, 0);
            other.options.quality.max_area = ldexp(start.options.quality.max_area, 2 * exponents[i]);
            for (int32_t k = 0; k < 2 * other.pslg.n_points; k++)
                other.pslg.points[k] = ldexp(other.pslg.points[k], exponents[i]);
            struct tri_mesh mesh = trials_coarse_mesh(&other);
            if (par_refine(&mesh, &other.options.quality, &options, &report, &error) != TRI_OK)
                fail_msg("2^%d: %s", exponents[i], error.text);
            struct support_set a = support_triangles(&plain), b = support_triangles(&mesh);
            if (!support_same(&a, &b))
                fail_msg("2^%d: %d triangles, not %d", exponents[i], (int)b.n, (int)a.n);
            support_set_free(&a);
            support_set_free(&b);
            par_report_free(&report);
            tri_mesh_free(&mesh);
            tri_pslg_free(&other.pslg);
        }
        tri_mesh_free(&plain);
        tri_pslg_free(&start.pslg);
    }
}

/* No triangles, no points allowed, no bad triangles: every mesh is a valid start. */
static void test_small_and_empty_meshes_are_valid_starts(void **state)
{
    (void)state;
    static const char *const names[] = {"nasty/hole_eats_all.poly", "nasty/collinear.poly", "square.poly"};
    for (int i = 0; i < 3; i++) {
        struct trial trial = {names[i], 20, 0, 1, false, false, 0};
        struct start start = trials_start_of(&trial);
        struct par_options options = small_blocks(trial.block, 2);
        struct par_report report;
        struct tri_mesh mesh = refine(&start, &options, &report);
        judge(&start, &mesh, 0);
        struct tri_mesh again = refine(&start, &options, &report);
        support_assert_same_bytes(&mesh, &again);
        assert_int_equal(par_refine(&mesh, &start.options.quality, &options, &report, NULL), TRI_OK);
        assert_int_equal(report.total.inserted_free + report.total.inserted_on_segments, 0);
        assert_int_equal(mesh.n_triangles, again.n_triangles);
        par_report_free(&report);
        tri_mesh_free(&again);
        tri_mesh_free(&mesh);
        tri_pslg_free(&start.pslg);
    }
}

/* A second call with the same bounds finds nothing to do. One with finer bounds refines further. */
static void test_calls_can_follow_each_other(void **state)
{
    (void)state;
    struct start start = square(100, 30, 1e-3);
    struct par_options options = small_blocks(300, 2);
    struct par_report report;
    struct tri_error error = {0};
    struct tri_mesh mesh = refine(&start, &options, &report);
    par_report_free(&report);
    int32_t n = mesh.n_triangles;
    assert_int_equal(par_refine(&mesh, &start.options.quality, &options, &report, &error), TRI_OK);
    assert_int_equal(mesh.n_triangles, n);
    par_report_free(&report);
    start.options.quality.max_area = 1e-4;
    size_t bytes = (size_t)mesh.n_vertices * sizeof *mesh.xy;
    struct tri_point *xy = malloc(bytes);
    assert_non_null(xy);
    memcpy(xy, mesh.xy, bytes);
    assert_int_equal(par_refine(&mesh, &start.options.quality, &options, &report, &error), TRI_OK);
    assert_true(mesh.n_triangles > 5 * n && report.n_blocks > 9 && report.seconds_number > 0);
    assert_memory_equal(mesh.xy, xy, bytes); /* existing vertices keep their numbers */
    free(xy);
    judge(&start, &mesh, 0);
    par_report_free(&report);
    tri_mesh_free(&mesh);
    tri_pslg_free(&start.pslg);
}

struct told {
    pthread_t thread;
    struct par_place last;
    int n, within; /* number of phases that began, and of calls within them */
};

/* Positions are reported in ascending order. */
static void record_progress(void *user, const struct par_place *place)
{
    struct told *told = user;
    const struct par_place *last = &told->last;
    assert_true(pthread_equal(told->thread, pthread_self()));
    assert_true(place->phase >= 0 && place->phase <= PAR_NUMBERING && place->round >= 0);
    assert_true(place->triangles >= last->triangles);
    if (place->done > 0)
        assert_true(place->round == last->round && place->phase == last->phase && place->done > last->done &&
                    place->done <= 1);
    else if (place->phase > 0 && place->level == last->level && place->column == last->column)
        assert_true(place->round > last->round || place->phase > last->phase);
    else
        assert_true(place->phase == 0 || place->level < last->level || place->column > last->column);
    told->last = *place;
    *(place->done > 0 ? &told->within : &told->n) += 1;
}

static void test_progress_is_reported_on_the_calling_thread(void **state)
{
    (void)state;
    struct start start = square(100, 30, 1e-4);
    for (int threads = 1; threads <= 3; threads += 2) {
        struct told told = {.thread = pthread_self()};
        struct par_options options = small_blocks(300, threads);
        struct par_report report;
        options.progress = record_progress;
        options.progress_user = &told;
        struct tri_mesh mesh = refine(&start, &options, &report);
        assert_true(told.n >= 5 && told.last.triangles > 1000);
        assert_true(told.within > 9 || threads > 1); /* with several threads, the calling thread may have little to
                                                        do */
        par_report_free(&report);
        tri_mesh_free(&mesh);
    }
    tri_pslg_free(&start.pslg);
}

/* One caller among several: refines a trial of its own with its own threads. Asserts of cmocka may only run on the main
   thread, so a caller only records the result. */
struct caller {
    struct start start;
    struct par_options options;
    struct tri_mesh mesh;
    enum tri_status status;
};

static void *call(void *user)
{
    struct caller *caller = user;
    struct par_report report;
    caller->status = par_refine(&caller->mesh, &caller->start.options.quality, &caller->options, &report, NULL);
    par_report_free(&report);
    return NULL;
}

enum { CALLERS = 3 };

static void start_callers(struct caller caller[CALLERS])
{
    for (int i = 0; i < CALLERS; i++) {
        caller[i] = (struct caller){.start = trials_start_of(&trials[i]), .options = small_blocks(trials[i].block, 2)};
        caller[i].mesh = trials_coarse_mesh(&caller[i].start);
    }
}

static void end_callers(struct caller caller[CALLERS])
{
    for (int i = 0; i < CALLERS; i++) {
        struct par_report report;
        struct tri_mesh alone = refine(&caller[i].start, &caller[i].options, &report);
        assert_int_equal(caller[i].status, TRI_OK);
        support_assert_same_bytes(&alone, &caller[i].mesh);
        par_report_free(&report);
        tri_mesh_free(&alone);
        tri_mesh_free(&caller[i].mesh);
        tri_pslg_free(&caller[i].start.pslg);
    }
}

static void test_callers_on_threads_of_their_own(void **state)
{
    (void)state;
    struct caller caller[CALLERS];
    pthread_t thread[CALLERS];
    start_callers(caller);
    for (int i = 0; i < CALLERS; i++)
        assert_int_equal(pthread_create(&thread[i], NULL, call, &caller[i]), 0);
    for (int i = 0; i < CALLERS; i++)
        assert_int_equal(pthread_join(thread[i], NULL), 0);
    end_callers(caller);
}

#ifdef SUPPORT_WRAP
/* One run in which the k-th allocation fails, alone or with all later ones. Returns whether that allocation was
   reached. */
static bool fail_once(const struct start *start, const struct par_options *options, int64_t k, bool ever_after)
{
    struct tri_error error = {0}, fault = {0};
    struct par_report report;
    struct par_options how = *options;
    struct par_park *park = NULL;
    long long before = support_held;
    struct tri_mesh mesh = trials_coarse_mesh(start);
    how.park = how.memory > 0 ? &park : NULL;
    support_calls = 0;
    support_fail_ever_after = ever_after;
    support_fail_at = k;
    enum tri_status status = par_refine(&mesh, &start->options.quality, &how, &report, &error);
    bool failed = support_calls >= k;
    support_fail_at = INT64_MAX;
    if (status == TRI_OK) {
        assert_true(!failed || !ever_after);
    } else {
        assert_int_equal(status, TRI_NO_MEMORY);
        assert_int_equal(error.status, TRI_NO_MEMORY);
        assert_true(error.text[0] != 0);
    }
    if (tri_mesh_validate(&mesh, &fault) != TRI_OK)
        fail_msg("allocation %d%s: %s", (int)k, ever_after ? " and later" : "", fault.text);
    judge(start, &mesh, INT64_MAX); /* any number of bad triangles, but a valid mesh */
    par_report_free(&report);
    tri_mesh_free(&mesh);
    par_park_close(park, NULL);
    assert_int_equal(support_held, before);
    return failed;
}

static enum tri_status begin_nothing(void *user, const struct tri_stream *told, struct tri_error *error)
{
    (void)user, (void)told, (void)error;
    return TRI_OK;
}

static enum tri_status take_nothing(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    (void)user, (void)tile, (void)error;
    return TRI_OK;
}

/* If a run with a sink lacks memory anywhere, it returns an error and frees all its memory. */
static bool fail_streaming_once(const struct start *start, const struct par_options *options, int64_t k)
{
    struct par_report report;
    const struct tri_sink sink = {NULL, begin_nothing, take_nothing, NULL};
    struct par_options how = *options;
    long long before = support_held;
    struct tri_mesh mesh = trials_coarse_mesh(start);
    how.sink = &sink;
    support_calls = 0;
    support_fail_ever_after = false;
    support_fail_at = k;
    enum tri_status status = par_refine(&mesh, &start->options.quality, &how, &report, NULL);
    bool failed = support_calls >= k;
    support_fail_at = INT64_MAX;
    assert_true(status == TRI_OK || (failed && status == TRI_NO_MEMORY));
    par_report_free(&report);
    tri_mesh_free(&mesh);
    assert_int_equal(support_held, before);
    return failed;
}

static void test_every_allocation_may_fail_on_the_way_to_a_sink(void **state)
{
    (void)state;
    static const double angles[] = {20, 30, 33}; /* swept, one sequential call, parked */
    for (int i = 0; i < 3; i++) {
        struct start start = square(60, angles[i], i == 1 ? 0 : 4e-4);
        struct par_options options = small_blocks(256, 1);
        int64_t k = 1;
        options.memory = 1000;
        options.scratch = ".";
        while (fail_streaming_once(&start, &options, k))
            k += 1 + k * every(4) / 12; /* later allocations are more alike, so fewer are tried */
        assert_true(k > (i == 1 ? 10 : 30)); /* one sequential call makes few allocations */
        tri_pslg_free(&start.pslg);
    }
}

static void test_every_allocation_may_fail(void **state)
{
    (void)state;
    for (int run = 0; run < 5; run++) {
        struct start start = square(60, 25, 4e-4);
        struct par_options options = small_blocks(256, run < 2 ? 1 : 2);
        int64_t k = 1;
        options.tight_room = run % 2 ? 20 : 0;
        options.memory = run == 4 ? 1000 : 0; /* the mesh lies in files */
        options.scratch = ".";
        while (fail_once(&start, &options, k, run % 2))
            k += 1 + k / 24;
        assert_true(k > 100);
        tri_pslg_free(&start.pslg);
    }
}
#endif

int main(void)
{
    const struct CMUnitTest tests[] = {
#ifdef SUPPORT_WRAP
        cmocka_unit_test(test_every_allocation_may_fail),
        cmocka_unit_test(test_every_allocation_may_fail_on_the_way_to_a_sink),
#endif
        cmocka_unit_test(test_bounds_and_size_are_those_of_the_sequential_loop),
        cmocka_unit_test(test_any_number_of_threads_and_order_of_blocks_make_one_mesh),
        cmocka_unit_test(test_budgets_hand_out_the_same_tiles),
        cmocka_unit_test(test_a_stream_has_the_numbers_of_the_mesh),
        cmocka_unit_test(test_a_sweep_holds_few_columns),
        cmocka_unit_test(test_unusable_scratch_files_are_an_error),
        cmocka_unit_test(test_a_mesh_above_the_bound_lies_in_files),
        cmocka_unit_test(test_room_changes_only_ids),
        cmocka_unit_test(test_the_numbering_changes_only_ids),
        cmocka_unit_test(test_messages_name_the_schedule),
        cmocka_unit_test(test_deferred_triangles_are_listed_once),
        cmocka_unit_test(test_a_long_gap_costs_no_triangles),
        cmocka_unit_test(test_default_blocks_cost_no_triangles),
        cmocka_unit_test(test_a_size_test_runs_in_parallel_only_where_allowed),
        cmocka_unit_test(test_limits_and_gates_lead_to_a_sequential_call),
        cmocka_unit_test(test_protected_segments_stay_whole),
        cmocka_unit_test(test_any_unit_makes_the_same_mesh),
        cmocka_unit_test(test_small_and_empty_meshes_are_valid_starts),
        cmocka_unit_test(test_calls_can_follow_each_other),
        cmocka_unit_test(test_a_trial_call_gives_nothing_up),
        cmocka_unit_test(test_progress_is_reported_on_the_calling_thread),
        cmocka_unit_test(test_callers_on_threads_of_their_own),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
