/* Runs that are stopped at any time, or whose sink rejects tiles, and are resumed. The mesh must equal that of a run
 * without interruption, whether it is swept or stays whole, in memory or parked. Also files with damage at any byte. */
#include "full.h"
#include "support.h"

#include <errno.h>
#include <stdatomic.h>
#include <stdio.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "allocations.h"
#include "sched/schedule/schedule.h"
#include "sched/checkpoint/state.h"
#include "sched/tunables.h"
#include "triangle/base/hash.h"
#include "triangle/base/system.h"
#include "trials.h"

static const char DIRECTORY[] = "state";

/* A hash over everything that is handed out, and the tile at which to fail. */
struct taker {
    uint64_t hash;      /* of the bytes handed out so far */
    int64_t n, fail_at; /* number of tiles; the tile to reject, -1: none */
    int32_t n_attributes;
};

static enum tri_status begin(void *user, const struct tri_stream *stream, struct tri_error *error)
{
    struct taker *t = user;
    (void)error;
    t->n = 0;
    t->n_attributes = stream->n_attributes;
    t->hash = tri_hash(0, stream->regions, (size_t)(stream->n_regions * stream->n_columns) * sizeof *stream->regions);
    return TRI_OK;
}

static enum tri_status take(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    struct taker *t = user;
    size_t v = (size_t)tile->n_vertices, k = (size_t)tile->n_triangles, s = (size_t)tile->n_segments;
    if (t->n++ == t->fail_at)
        return tri_fail(error, TRI_CANNOT_WRITE, "out", 0, "no more");
    t->hash = tri_hash(t->hash, &tile->first_vertex, sizeof tile->first_vertex);
    t->hash = tri_hash(t->hash, tile->points, v * sizeof *tile->points);
    t->hash = tri_hash(t->hash, tile->point_markers, v * sizeof *tile->point_markers);
    t->hash = tri_hash(t->hash, tile->attributes, (size_t)t->n_attributes * v * sizeof *tile->attributes);
    t->hash = tri_hash(t->hash, tile->corners, k * sizeof *tile->corners);
    t->hash = tri_hash(t->hash, tile->regions, k * sizeof *tile->regions);
    t->hash = tri_hash(t->hash, tile->ends, s * sizeof *tile->ends);
    t->hash = tri_hash(t->hash, tile->segment_markers, s * sizeof *tile->segment_markers);
    return TRI_OK;
}

static enum tri_status end(void *user, struct tri_error *error)
{
    (void)user, (void)error;
    return TRI_OK;
}

static struct tri_pslg figure(int32_t points)
{
    struct tri_pslg pslg = support_square(1, points, 5);
    support_add_attributes(&pslg);
    return pslg;
}

struct run {
    struct taker taker;
    const struct tri_stop *stop;       /* NULL: never stops */
    struct par_checkpoint *checkpoint; /* NULL: none */
    int threads;
    double max_area;
    bool lattice; /* points are placed on a lattice */
    struct tri_error error;
    int64_t n_inserted;
};

static enum tri_status refine(struct run *r, int32_t points)
{
    struct tri_pslg pslg = figure(points);
    struct tri_options coarse = support_quality(0, 0), fine = support_quality(20, r->max_area);
    struct tri_report made;
    coarse.refine = false;
    fine.quality.lattice = r->lattice;
    struct tri_mesh mesh = support_generate(&pslg, &coarse, &made);
    struct tri_sink sink = {&r->taker, begin, take, end};
    struct par_options options = par_defaults();
    struct par_report report;
    options.threads = r->threads;
    options.cell_triangles = 500;
    options.sweep = true;
    options.sink = &sink;
    options.checkpoint = r->checkpoint;
    mesh.stop = r->stop;
    enum tri_status status = par_refine(&mesh, &fine.quality, &options, &report, &r->error);
    assert_true(status || report.way == PAR_SWEPT);
    r->n_inserted = report.total.inserted_free;
    par_report_free(&report);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
    return status;
}

enum { POINTS = 50 };
static const double AREA = 3e-5;

static struct run run_of(struct par_checkpoint *checkpoint)
{
    return (struct run){.taker = {.fail_at = -1}, .threads = 2, .max_area = AREA, .checkpoint = checkpoint};
}

static uint64_t whole(int64_t *tiles)
{
    struct run r = run_of(NULL);
    assert_int_equal(refine(&r, POINTS), TRI_OK);
    *tiles = r.taker.n;
    return r.taker.hash;
}

static void open_it(struct par_checkpoint *c, bool resume)
{
    assert_int_equal(par_checkpoint_open(c, DIRECTORY, resume, 7, NULL), TRI_OK);
    c->seconds = 1e9;
}

static void remove_all(void)
{
    support_remove_directory(DIRECTORY);
}

/* Requests a stop after this many tiles. */
struct tile_limit {
    const struct taker *taker;
    int64_t tiles; /* number of tiles after which to stop */
};

static bool is_over(void *user)
{
    const struct tile_limit *p = user;
    return p->taker->n >= p->tiles;
}

/* Each run hands out a few more tiles than the previous one. The first hands out none. */
static void test_stopped_at_any_time(void **state)
{
    (void)state;
    int64_t tiles, kept = 0;
    uint64_t wanted = whole(&tiles);
    enum tri_status status = TRI_STOPPED;
    int rounds = 0, grown = 0;
    remove_all();
    for (; status == TRI_STOPPED && rounds < 100; rounds++) {
        struct par_checkpoint c;
        open_it(&c, rounds > 0);
        assert_int_equal(par_checkpoint_has_state(&c), kept > 0);
        struct run r = run_of(&c);
        const struct tile_limit tile_limit = {&r.taker, 4 * rounds};
        const struct tri_stop stop = {is_over, (void *)&tile_limit};
        r.threads = rounds % 3 + 1;
        r.stop = &stop;
        status = refine(&r, POINTS);
        assert_true(c.manifest.triangles >= kept);
        grown += c.manifest.triangles > kept;
        kept = c.manifest.triangles;
        if (!status)
            assert_true(r.taker.hash == wanted && r.taker.n == tiles);
        par_checkpoint_close(&c, status == TRI_OK);
    }
    print_message("  %lld tiles in %d runs\n", (long long)tiles, rounds);
    assert_int_equal(status, TRI_OK);
    assert_true(grown >= 3);
    assert_int_not_equal(access(DIRECTORY, F_OK), 0);
}

/* The sink may fail at any tile. Finished work is kept. */
static void test_a_failing_sink_loses_no_finished_work(void **state)
{
    (void)state;
    int64_t tiles;
    uint64_t wanted = whole(&tiles);
    for (int64_t at = 1; at < tiles; at += every(3) * tiles / 7) {
        struct par_checkpoint c;
        remove_all();
        open_it(&c, false);
        struct run r = run_of(&c);
        r.taker.fail_at = at;
        assert_int_equal(refine(&r, POINTS), TRI_CANNOT_WRITE);
        assert_string_equal(r.error.text, "no more");
        assert_true(par_checkpoint_has_state(&c) && c.saved == 1);
        par_checkpoint_close(&c, false);
        open_it(&c, true);
        r = run_of(&c);
        assert_int_equal(refine(&r, POINTS), TRI_OK);
        assert_true(r.taker.hash == wanted);
        par_checkpoint_close(&c, true);
    }
}

/* Makes a run that writes a state and is then stopped. */
static void leave_state(void)
{
    struct par_checkpoint c;
    remove_all();
    open_it(&c, false);
    struct run r = run_of(&c);
    r.taker.fail_at = 14;
    assert_int_equal(refine(&r, POINTS), TRI_CANNOT_WRITE);
    par_checkpoint_close(&c, false);
}

static void test_other_runs_are_refused(void **state)
{
    (void)state;
    struct par_checkpoint c, second;
    struct tri_error error;
    leave_state();
    assert_int_equal(par_checkpoint_open(&c, DIRECTORY, false, 7, &error), TRI_BAD_INPUT);
    assert_int_equal(par_checkpoint_open(&c, DIRECTORY, true, 8, &error), TRI_BAD_INPUT);
    assert_int_equal(par_checkpoint_open(&c, "nowhere", true, 7, &error), TRI_BAD_INPUT);
    open_it(&c, true);
    struct run r = run_of(&c);
    assert_int_equal(refine(&r, POINTS + 1), TRI_BAD_INPUT);
    r = run_of(&c);
    r.max_area = 1.0001 * AREA;
    assert_int_equal(refine(&r, POINTS), TRI_BAD_INPUT);
    assert_non_null(strstr(r.error.text, "of another run"));
    r = run_of(&c);
    r.lattice = true;
    assert_int_equal(refine(&r, POINTS), TRI_BAD_INPUT);
    assert_non_null(strstr(r.error.text, "of another run"));
    par_checkpoint_close(&c, true);
    open_it(&c, false);
    par_checkpoint_close(&c, false);
    assert_int_equal(par_checkpoint_open(&second, DIRECTORY, true, 7, &error), TRI_OK); /* without a state */
    assert_false(par_checkpoint_has_state(&second));
    par_checkpoint_close(&second, true);
}

static void make_file(const char *name, const char *text)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s", DIRECTORY, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static long length_of_file(const char *name)
{
    char path[512];
    struct stat about;
    snprintf(path, sizeof path, "%s/%s", DIRECTORY, name);
    assert_int_equal(stat(path, &about), 0);
    return (long)about.st_size;
}

static bool has_file(const char *name)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s", DIRECTORY, name);
    return access(path, F_OK) == 0;
}

/* Without a manifest, no file with these names belongs to a run. */
static void test_files_of_others_are_refused(void **state)
{
    (void)state;
    static const char *const names[] = {"tiles", "state-0", "state-1", "piece-0-0", "piece-1-12", "manifest-new"};
    remove_all();
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        struct par_checkpoint c;
        struct tri_error error;
        assert_int_equal(mkdir(DIRECTORY, 0777), 0);
        make_file(names[i], "precious");
        assert_int_equal(par_checkpoint_open(&c, DIRECTORY, false, 7, &error), TRI_BAD_INPUT);
        assert_non_null(strstr(error.text, names[i]));
        assert_int_equal(length_of_file(names[i]), 8);
        assert_false(has_file("manifest"));
        remove_all();
    }
}

/* With a manifest, only files with exactly these names do. The directory belongs to its creator. */
static void test_files_of_others_stay(void **state)
{
    (void)state;
    static const char *const others[] = {"piece-3.poly", "piece-notes.txt", "piece-2-1", "piece-0-", "piece-0-1x",
                                         "piece-1", "state-2", "tiles.txt"};
    enum { N = sizeof others / sizeof *others };
    struct par_checkpoint c;
    remove_all();
    assert_int_equal(mkdir(DIRECTORY, 0777), 0);
    for (int i = 0; i < N; i++)
        make_file(others[i], "precious");
    make_file("manifest-new", ""); /* left by a run that was killed immediately */
    open_it(&c, false);
    make_file("piece-0-1", "");
    make_file("piece-1-12", "");
    make_file("state-1", "");
    par_checkpoint_close(&c, true);
    for (int i = 0; i < N; i++)
        assert_true(has_file(others[i]));
    static const char *const own[] = {"manifest", "manifest-new", "tiles", "state-1", "piece-0-1", "piece-1-12"};
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        assert_false(has_file(own[i]));
    remove_all();
    assert_int_equal(mkdir(DIRECTORY, 0777), 0); /* not made by a run, so it stays although it is empty */
    open_it(&c, false);
    par_checkpoint_close(&c, true);
    assert_int_equal(rmdir(DIRECTORY), 0);
}

/* A user who can write to the folder may add links. No file behind a link is written, removed or read. */
static void test_links_are_not_followed(void **state)
{
    (void)state;
    static const char *const names[] = {"manifest-new", "state-0", "state-1", "piece-0-0"};
    struct par_checkpoint c;
    struct whole_files {
        const char *name, *other;
    } files[] = {{"state/manifest", "state/kept"}, {"state/tiles", "state/kept"}};
    remove_all();
    FILE *file = fopen("victim", "w");
    assert_non_null(file);
    fputs("precious", file);
    fclose(file);
    open_it(&c, false);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char path[512];
        snprintf(path, sizeof path, "%s/%s", DIRECTORY, names[i]);
        assert_int_equal(i % 2 ? symlink("../victim", path) : link("victim", path), 0);
    }
    c.seconds = 0; /* makes the run write both states */
    struct run r = run_of(&c);
    r.taker.fail_at = 14;
    assert_int_equal(refine(&r, POINTS), TRI_CANNOT_WRITE);
    assert_true(c.saved > 1);
    char path[PAR_CHECKPOINT_PATH];
    int piece = par_checkpoint_piece(path, DIRECTORY, 0, 0, true);
    assert_true(piece >= 0 && write(piece, "x", 1) == 1);
    close(piece);
    par_checkpoint_close(&c, false);
    assert_int_equal(length_of_file("../victim"), 8);
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        assert_int_equal(rename(files[i].name, files[i].other), 0);
        assert_int_equal(symlink("kept", files[i].name), 0);
        assert_int_not_equal(par_checkpoint_open(&c, DIRECTORY, true, 7, NULL), TRI_OK);
        assert_int_equal(unlink(files[i].name), 0);
        assert_int_equal(rename(files[i].other, files[i].name), 0);
    }
    assert_int_equal(link("state/tiles", "state/kept"), 0); /* opening this file would truncate it */
    assert_int_not_equal(par_checkpoint_open(&c, DIRECTORY, true, 7, NULL), TRI_OK);
    assert_int_equal(unlink("state/kept"), 0);
    assert_int_equal(unlink("state/manifest-new") == 0 || errno == ENOENT, true);
    assert_int_equal(mkfifo("state/manifest-new", 0777), 0); /* opening this pipe would wait for its other end */
    open_it(&c, true);
    par_checkpoint_close(&c, true);
    assert_int_equal(unlink("victim"), 0);
}

/* Needs root, because only root can change the owner of a folder. */
static void test_folders_of_others_are_refused(void **state)
{
    (void)state;
    struct par_checkpoint c;
    struct tri_error error;
    if (geteuid() != 0)
        return;
    leave_state();
    assert_int_equal(chown(DIRECTORY, 1234, 1234), 0);
    for (int resume = 0; resume < 2; resume++) {
        assert_int_equal(par_checkpoint_open(&c, DIRECTORY, resume == 1, 7, &error), TRI_BAD_INPUT);
        assert_non_null(strstr(error.text, "belongs to another user"));
    }
    remove_all();
}

/* Flips a bit of a file. A second call restores it. */
static void flip(const char *name, long at)
{
    FILE *file = fopen(name, "r+b");
    assert_non_null(file);
    fseek(file, at, SEEK_SET);
    int byte = fgetc(file);
    fseek(file, at, SEEK_SET);
    fputc(byte ^ 1, file);
    fclose(file);
}

static long length_of(const char *name)
{
    FILE *file = fopen(name, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    long n = ftell(file);
    fclose(file);
    return n;
}

/* Resumes the run and returns its status. */
static enum tri_status resume_run(void)
{
    struct par_checkpoint c;
    enum tri_status status = par_checkpoint_open(&c, DIRECTORY, true, 7, NULL);
    if (status)
        return status;
    struct run r = run_of(&c);
    status = refine(&r, POINTS);
    par_checkpoint_close(&c, false);
    return status;
}

static void test_damage_is_found(void **state)
{
    (void)state;
    static const char *const names[] = {"state/manifest", "state/state-0", "state/tiles"};
    leave_state();
    for (int k = 0; k < 3; k++) {
        long n = length_of(names[k]);
        for (long at = 0; at < n; at += every(3) * (n < 100 ? 3 : n / 7)) {
            flip(names[k], at);
            assert_int_equal(resume_run(), TRI_BAD_INPUT);
            flip(names[k], at);
        }
    }
    for (int k = 0; k < 3; k++) { /* the file is too short */
        leave_state();
        assert_int_equal(truncate(names[k], length_of(names[k]) / 2), 0);
        assert_int_equal(resume_run(), TRI_BAD_INPUT);
    }
    remove_all();
}

/* --- meshes that stay whole */

/* How a trial is refined. */
struct way {
    struct trial trial;
    bool has_sink, by_block; /* the mesh goes to a sink; as in par_options */
    int64_t memory, max_steiner;
    enum par_way expected; /* of a run without interruption */
    int32_t tight_room;    /* as in par_options */
};

static const struct way ways[] = {
    {{"letter.poly", 30, 6000, 300, false, false, 0}, false, true, 0, -1, PAR_IN_MEMORY, 0},
    {{"section.poly", 28, 8000, 300, false, true, 0}, true, false, 0, -1, PAR_IN_MEMORY, 0},
    {{"naca2412_box.poly", 32, 6000, 256, false, false, 0}, true, false, 1000, -1, PAR_PARKED, 0}, /* two schedules */
    {{"cracked_plate.poly", 28, 6000, 256, false, false, 1}, true, false, 1000, -1, PAR_PARKED, 0}, /* swept at first */
    {{"section.poly", 35, 6000, 300, true, true, 0}, false, false, 0, -1, PAR_IN_MEMORY, 0}, /* no schedule at 35 */
    {{"letter.poly", 33, 18000, 1000, false, false, 0}, false, false, 0, -1, PAR_IN_MEMORY, 400}, /* blocks wait */
    {{"letter.poly", 20, 6000, 300, false, false, 0}, true, false, 0, 1500, PAR_IN_MEMORY, 0}, /* no schedule */
    {{"letter.poly", 30, 20000, 500, false, false, 0}, true, false, 1000, -1, PAR_SWEPT, 0},
    {{"section.poly", 25, 9000, 1000, false, true, 0}, true, false, 1000, -1, PAR_SWEPT, 400}, /* blocks wait */
    {{"section.poly", 25, -9000, 500, false, true, 0}, true, false, 1000, -1, PAR_SWEPT, 0},
    {{"letter.poly", 25, -9000, 300, false, false, 0}, false, false, 0, -1, PAR_IN_MEMORY, 0},
};

enum { N_WAYS = sizeof ways / sizeof *ways };

/* A run that stops after max_reported phases have been reported, or after is_asked has been called max_asked times. */
struct whole_run {
    const struct way *way;
    struct par_checkpoint *checkpoint;
    int64_t memory; /* bound in bytes; 0: none */
    int threads;
    atomic_int told, asked;    /* reported phases; calls of is_asked, by all threads */
    int max_reported, max_asked; /* limits of both; max_asked 0: no limit */
    struct taker taker;
    uint64_t hash;     /* of the whole mesh */
    int64_t triangles; /* used if there is no sink */
    enum par_way was;  /* how the mesh was made */
    struct tri_error error;
};

static void count_phases(void *user, const struct par_place *place)
{
    struct whole_run *r = user;
    r->told += place->done == 0;
}

static bool time_is_up; /* set when the checkpoint reports the time limit */

static bool is_limit_reached(void *user)
{
    struct whole_run *r = user;
    return time_is_up || r->told >= r->max_reported || (r->max_asked > 0 && ++r->asked > r->max_asked);
}

static uint64_t hash_of_mesh(const struct tri_mesh *m)
{
    const size_t v = (size_t)m->n_vertices;
    uint64_t hash = tri_hash(0, m->xy, v * sizeof *m->xy);
    hash = tri_hash(hash, m->vertex_markers, v * sizeof *m->vertex_markers);
    hash = tri_hash(hash, m->attributes, v * (size_t)m->n_attributes * sizeof *m->attributes);
    for (int32_t t = 0; t < m->n_triangles; t++)
        hash = tri_hash(hash, m->tri[t].v, sizeof m->tri[t].v);
    for (int32_t s = 0; s < m->n_subs; s++)
        hash = tri_hash(hash, m->sub[s].v, sizeof m->sub[s].v);
    return hash;
}

static enum tri_status refine_whole(struct whole_run *r)
{
    struct start start = trials_start_of(&r->way->trial);
    struct tri_mesh mesh = trials_coarse_mesh(&start);
    const struct tri_sink sink = {&r->taker, begin, take, end};
    const struct tri_stop stop = {is_limit_reached, r};
    struct par_options options = {.threads = r->threads, .cell_triangles = r->way->trial.block, .memory = r->memory,
                                  .by_block = r->way->by_block, .tight_room = r->way->tight_room,
                                  .sink = r->way->has_sink ? &sink : NULL,
                                  .scratch = ".", .progress = count_phases, .progress_user = r,
                                  .checkpoint = r->checkpoint};
    struct par_report report;
    start.options.quality.max_steiner = r->way->max_steiner;
    mesh.stop = &stop;
    enum tri_status status = par_refine(&mesh, &start.options.quality, &options, &report, &r->error);
    r->was = report.way;
    r->hash = r->way->has_sink ? r->taker.hash : status ? 0 : hash_of_mesh(&mesh);
    r->triangles = r->way->has_sink ? 0 : mesh.n_triangles;
    par_report_free(&report);
    tri_mesh_free(&mesh);
    trials_free(&start);
    return status;
}

static struct whole_run whole_run_of(const struct way *way, struct par_checkpoint *checkpoint)
{
    return (struct whole_run){.way = way, .checkpoint = checkpoint, .memory = way->memory, .threads = 2,
                              .max_reported = INT32_MAX, .taker = {.fail_at = -1}};
}

/* Stops and resumes the run many times, in a phase or between two phases, each time with another number of threads, and
 * with the mesh in memory or in files. A resumed run that stops in its first phase has made no progress. */
static void resume_until_done(const struct way *way, const struct whole_run *wanted)
{
    enum tri_status status = TRI_STOPPED;
    int rounds = 0, with_state = 0;
    remove_all();
    for (; status == TRI_STOPPED && rounds < 100; rounds++) {
        struct par_checkpoint c;
        open_it(&c, rounds > 0);
        struct whole_run r = whole_run_of(way, &c);
        with_state += par_checkpoint_has_state(&c);
        const bool makes_coarse = c.manifest.kind == PAR_SWEPT_STATE; /* making the coarse mesh again is reported */
        r.max_reported = par_checkpoint_has_state(&c) ? rounds % 3 + makes_coarse : rounds + 1;
        r.threads = rounds % 3 + 1;
        if (c.manifest.kind == PAR_WHOLE_STATE && way->has_sink)
            r.memory = rounds % 2 * 1000;
        status = refine_whole(&r);
        if (!status)
            assert_true(r.hash == wanted->hash && r.taker.n == wanted->taker.n);
        par_checkpoint_close(&c, status == TRI_OK);
    }
    print_message("  %s: %d runs, %d of them from a state\n", way->trial.file, rounds, with_state);
    assert_int_equal(status, TRI_OK);
    assert_true(with_state >= (way->max_steiner < 0 ? 4 : 0));
}

static void test_whole_meshes_resume(void **state)
{
    (void)state;
    for (int i = 0; i < N_WAYS; i += every(2)) {
        struct whole_run wanted = whole_run_of(&ways[i], NULL);
        assert_int_equal(refine_whole(&wanted), TRI_OK);
        assert_int_equal(wanted.was, ways[i].expected);
        resume_until_done(&ways[i], &wanted);
    }
}

/* Stops again and again during phases, and during or after the sequential call of a run without schedule. */
static void test_sequential_calls_resume(void **state)
{
    (void)state;
    for (int i = 0; i < N_WAYS; i++) {
        enum tri_status status = TRI_STOPPED;
        struct whole_run wanted = whole_run_of(&ways[i], NULL);
        assert_int_equal(refine_whole(&wanted), TRI_OK);
        int rounds = 0, with_state = 0;
        remove_all();
        for (; status == TRI_STOPPED && rounds < 1000; rounds++) {
            struct par_checkpoint c;
            open_it(&c, rounds > 0);
            struct whole_run r = whole_run_of(&ways[i], &c);
            with_state += par_checkpoint_has_state(&c);
            r.max_asked = 3 + rounds;
            r.threads = rounds % 3 + 1;
            status = refine_whole(&r);
            if (status == TRI_STOPPED && c.saved > 0 && !ways[i].has_sink)
                assert_int_equal(c.manifest.triangles, r.triangles);
            if (!status)
                assert_true(r.hash == wanted.hash && r.taker.n == wanted.taker.n);
            par_checkpoint_close(&c, status == TRI_OK);
        }
        print_message("  %s: %d runs, %d of them from a state\n", ways[i].trial.file, rounds, with_state);
        assert_int_equal(status, TRI_OK);
        assert_true(with_state > 0);
    }
}

/* Stops a run during a phase while this allocation fails; *calls: number of allocations. A run that resumes from what
 * was kept, possibly nothing, makes the same mesh. */
static enum tri_status stop_short_of_memory(const struct way *way, const struct whole_run *wanted, int64_t fail_at,
                                            int64_t *calls)
{
    struct par_checkpoint c;
    remove_all();
    open_it(&c, false);
    struct whole_run r = whole_run_of(way, &c);
    r.threads = 1;
    r.max_asked = 9;
    support_calls = 0;
    support_fail_at = fail_at;
    const enum tri_status status = refine_whole(&r);
    support_fail_at = INT64_MAX;
    *calls = support_calls;
    par_checkpoint_close(&c, false);
    open_it(&c, true);
    r = whole_run_of(way, &c);
    assert_int_equal(refine_whole(&r), TRI_OK);
    assert_true(r.hash == wanted->hash);
    par_checkpoint_close(&c, true);
    return status;
}

/* Each of the last allocations fails in turn, including those for stopping. The run must report it. */
static void test_a_stop_without_memory_is_reported(void **state)
{
    (void)state;
    static const struct way way = {{"letter.poly", 30, 4000, 200, false, false, 0},
                                   false, false, 0, -1, PAR_IN_MEMORY, 0};
    enum { LAST = 20 };
    int64_t all, calls;
    struct whole_run wanted = whole_run_of(&way, NULL);
    assert_int_equal(refine_whole(&wanted), TRI_OK);
    assert_int_equal(stop_short_of_memory(&way, &wanted, INT64_MAX, &all), TRI_STOPPED);
    for (int k = 0; k < LAST; k += every(5))
        assert_int_equal(stop_short_of_memory(&way, &wanted, all - k, &calls), TRI_NO_MEMORY);
}

/* A state after each step does not change the mesh. If the sink rejects the last tile, the whole mesh can be handed out
 * again. */
static void test_a_finished_mesh_is_kept(void **state)
{
    (void)state;
    for (int i = 0; i < N_WAYS; i += every(2)) {
        if (!ways[i].has_sink)
            continue;
        struct whole_run wanted = whole_run_of(&ways[i], NULL);
        assert_int_equal(refine_whole(&wanted), TRI_OK);
        struct par_checkpoint c;
        remove_all();
        open_it(&c, false);
        c.seconds = 0;
        struct whole_run r = whole_run_of(&ways[i], &c);
        r.taker.fail_at = wanted.taker.n - 1;
        assert_int_equal(refine_whole(&r), TRI_CANNOT_WRITE);
        assert_string_equal(r.error.text, "no more");
        const bool swept = wanted.was == PAR_SWEPT;
        assert_true(par_checkpoint_has_state(&c) &&
                    c.manifest.kind == (swept ? PAR_SWEPT_STATE : PAR_WHOLE_STATE));
        par_checkpoint_close(&c, false);
        open_it(&c, true);
        r = whole_run_of(&ways[i], &c);
        assert_int_equal(refine_whole(&r), TRI_OK);
        assert_true(r.hash == wanted.hash && (swept || r.told == 0));
        par_checkpoint_close(&c, true);
    }
}

/* The state of a sweep cannot resume a mesh that must stay whole. */
static void test_a_sweep_does_not_resume_as_a_whole_mesh(void **state)
{
    (void)state;
    struct way way = {{"letter.poly", 30, 20000, 500, false, false, 0}, true, false, 0, -1, PAR_IN_MEMORY, 0};
    struct par_checkpoint c;
    remove_all();
    open_it(&c, false);
    struct whole_run r = whole_run_of(&way, &c);
    r.memory = 1000;
    r.taker.fail_at = 5;
    assert_int_equal(refine_whole(&r), TRI_CANNOT_WRITE);
    assert_int_equal(c.manifest.kind, PAR_SWEPT_STATE);
    par_checkpoint_close(&c, false);
    open_it(&c, true);
    way.has_sink = false;
    r = whole_run_of(&way, &c);
    assert_int_equal(refine_whole(&r), TRI_BAD_INPUT);
    assert_non_null(strstr(r.error.text, "of a sweep"));
    par_checkpoint_close(&c, true);
}

/* How long before a time limit the last state begins, given the duration of the previous one. */
static void test_the_last_state_begins_in_time(void **state)
{
    (void)state;
    struct par_checkpoint c = par_checkpoint_closed(DIRECTORY);
    c.seconds = 600;
    assert_false(par_state_is_due(&c, 599, 1e6));
    assert_true(par_state_is_due(&c, 601, 1e6));
    c.limit = 100;
    assert_false(par_state_is_due(&c, 0.9, 1e6)); /* the first state measures the speed of the disk */
    assert_true(par_state_is_due(&c, 1.1, 1e6));
    assert_false(par_state_is_last(&c, 99, 1e6));
    c.last = c.saved = 1;
    c.cost = c.writing = 0.01; /* a state that takes no longer than any small file measures nothing */
    c.size = 100;
    assert_false(par_state_is_due(&c, 1.9, 1e6) || par_state_is_last(&c, 99, 1e6));
    assert_true(par_state_is_due(&c, 2.1, 1e6));
    c.last = c.saved = 0;
    c.cost = c.writing = 0;
    c.manifest.state_bytes = 1; /* resumed: first, the new state must exceed the old one */
    assert_false(par_state_is_due(&c, 49, 1e6));
    assert_true(par_state_is_due(&c, 51, 1e6));
    c.last = c.saved = 12;
    c.cost = c.writing = 2;
    c.size = 1e6;
    assert_false(par_state_is_due(&c, 95.9, 1e6));
    assert_true(par_state_is_due(&c, 96.1, 1e6) && par_state_is_last(&c, 96.1, 1e6));
    assert_false(par_state_is_last(&c, 87.9, 3e6));
    assert_true(par_state_is_last(&c, 88.1, 3e6));
    c.writing = 0.5; /* the rest of the time is spent on data that does not grow */
    assert_false(par_state_is_last(&c, 93.9, 3e6));
    assert_true(par_state_is_last(&c, 94.1, 3e6));
    assert_true(par_state_is_last(&c, 96.1, 1)); /* the estimate does not assume a faster write than the last one */
    c.limit = 0;
    assert_false(par_state_is_last(&c, 1e9, 1e6));
}

/* Simulates a run with its own clock: `rate` triangles a second, `each` seconds on the disk for a triangle, and a last
 * state that takes `slower` times as long. Returns the time when the run stops; *kept: number of triangles in the
 * state. */
static double simulate_run(double limit, double rate, double each, double slower, double *kept)
{
    struct par_checkpoint c = par_checkpoint_closed(DIRECTORY);
    double now = 0, triangles = 0;
    c.seconds = 600;
    c.limit = limit;
    for (bool is_over = false; !is_over; now += 0.1, triangles += 0.1 * rate) {
        const bool is_last = now >= limit || par_state_is_last(&c, now, triangles);
        if (!is_last && (!par_state_is_due(&c, now, triangles) || now - c.last < PAR_STATE_REST * c.cost))
            continue;
        c.cost = c.writing = each * triangles * (is_last ? slower : 1);
        c.size = *kept = triangles;
        c.last = now += c.cost;
        c.saved++;
        is_over = is_last || par_state_is_last(&c, now, triangles);
    }
    return now;
}

/* Disks from 10 MB/s to 1 GB/s, at 80 bytes a triangle. */
static void test_the_last_state_is_whole_before_the_limit(void **state)
{
    (void)state;
    for (double limit = 5; limit < 8000; limit *= 3)
        for (double speed = 1e7; speed <= 1e9; speed *= 4)
            for (double rate = 1e5; rate <= 4e6; rate *= 6)
                for (double slower = 1; slower < 2; slower += 0.4) {
                    double kept = 0;
                    const double end = simulate_run(limit, rate, 80 / speed, slower, &kept);
                    assert_true(kept > 0 && end <= limit + 2); /* the program allows 3 seconds */
                    assert_true(end >= limit / 4);
                }
}

static void note_time(void) { time_is_up = true; }

/* If the limit has passed when the run begins, the first state is the last. */
static void test_a_limit_ends_the_run_with_a_state(void **state)
{
    (void)state;
    for (int i = 0; i < N_WAYS; i++) {
        struct whole_run wanted = whole_run_of(&ways[i], NULL);
        assert_int_equal(refine_whole(&wanted), TRI_OK);
        struct par_checkpoint c;
        remove_all();
        open_it(&c, false);
        c.limit = tri_seconds();
        c.time_up = note_time;
        struct whole_run r = whole_run_of(&ways[i], &c);
        assert_int_equal(refine_whole(&r), TRI_STOPPED);
        assert_true(time_is_up && c.saved == 1 && par_checkpoint_has_state(&c));
        time_is_up = false;
        par_checkpoint_close(&c, false);
        open_it(&c, true);
        r = whole_run_of(&ways[i], &c);
        assert_int_equal(refine_whole(&r), TRI_OK);
        assert_true(r.hash == wanted.hash);
        par_checkpoint_close(&c, true);
    }
}

/* A state that does not fit on the disk leaves no file there. */
static void test_a_failed_state_leaves_nothing(void **state)
{
    (void)state;
    const struct rlimit limit = {1 << 16, RLIM_INFINITY};
    struct rlimit before;
    struct par_checkpoint c;
    remove_all();
    open_it(&c, false);
    c.seconds = 0;
    struct whole_run r = whole_run_of(&ways[0], &c);
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
    const enum tri_status status = refine_whole(&r);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    assert_int_equal(status, TRI_CANNOT_WRITE);
    assert_false(par_checkpoint_has_state(&c));
    assert_false(has_file("state-0") || has_file("state-1"));
    par_checkpoint_close(&c, true);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_last_state_begins_in_time),
        cmocka_unit_test(test_the_last_state_is_whole_before_the_limit),
        cmocka_unit_test(test_a_limit_ends_the_run_with_a_state),
        cmocka_unit_test(test_a_failed_state_leaves_nothing),
        cmocka_unit_test(test_stopped_at_any_time),
        cmocka_unit_test(test_a_failing_sink_loses_no_finished_work),
        cmocka_unit_test(test_other_runs_are_refused),
        cmocka_unit_test(test_files_of_others_are_refused),
        cmocka_unit_test(test_files_of_others_stay),
        cmocka_unit_test(test_links_are_not_followed),
        cmocka_unit_test(test_folders_of_others_are_refused),
        cmocka_unit_test(test_damage_is_found),
        cmocka_unit_test(test_whole_meshes_resume),
        cmocka_unit_test(test_sequential_calls_resume),
        cmocka_unit_test(test_a_stop_without_memory_is_reported),
        cmocka_unit_test(test_a_finished_mesh_is_kept),
        cmocka_unit_test(test_a_sweep_does_not_resume_as_a_whole_mesh),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
