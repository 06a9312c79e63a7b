/* Compares one phase with its definition: the blocks of the phase, one after the other, refined by the sequential loop
   on the whole mesh. */
#include "full.h"
#include "support.h"

#include "sched/schedule/phase.h"
#include "sched/schedule/prerefine.h"
#include "sched/schedule/threads.h"
#include "triangle/size/estimate.h"
#include "triangle/refine/place.h"

struct trial {
    const char *file; /* name of the input file; NULL: random points in a square */
    double angle, max_area, block;
    bool conforming;
};

static const struct trial trials[] = {
    {NULL, 30, 4e-4, 300, false}, {NULL, 25, 1e-3, 100, true},         {"letter.poly", 30, 0.01, 500, false},
    {"gear.poly", 28, 0.2, 300, false},  {"section.poly", 25, 0.3, 200, true}, {"koch_lake.poly", 30, 0, 400, false},
};

enum { N_TRIALS = sizeof trials / sizeof *trials };

static struct tri_mesh start_of(const struct trial *trial, struct tri_quality *quality)
{
    struct tri_pslg pslg = {0};
    struct tri_options options = support_quality(20, 8 * trial->max_area); /* eight times the area: about half of the
                                                                              refinement */
    if (!trial->file)
        pslg = support_square(1, 300, 9);
    else if (!support_read(trial->file, &pslg))
        fail_msg("cannot read %s", trial->file);
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    tri_pslg_free(&pslg);
    *quality = tri_quality_defaults();
    quality->min_angle = trial->angle;
    quality->max_area = trial->max_area;
    quality->conforming = trial->conforming;
    return mesh;
}

static struct par_partition cut(const struct tri_mesh *mesh, const struct tri_quality *quality, double block)
{
    struct par_partition partition;
    assert_int_equal(par_partition_make(&partition, mesh, quality,
                                        support_estimate(mesh, quality), block, NULL, NULL), TRI_OK);
    assert_true(partition.n_columns > 2 && partition.n_rows > 2);
    return partition;
}

static struct par_ids bad_triangles(const struct tri_mesh *mesh, const struct tri_quality *quality)
{
    struct par_ids triangles = {malloc(((size_t)mesh->n_triangles + 1) * sizeof(int32_t)), 0,
                                     mesh->n_triangles + 1};
    assert_non_null(triangles.item);
    triangles.n = tri_find_work(mesh, quality, 0, mesh->n_triangles, triangles.item);
    return triangles;
}

static bool is_in(void *user, const double p[2])
{
    const struct tri_fence *f = user;
    return p[0] >= f->x_min && p[0] < f->x_max && p[1] >= f->y_min && p[1] < f->y_max;
}

/* The reference: refines block after block, forwards or backwards, on the mesh itself. Returns the number of inserted
   points. */
static int64_t run_one_by_one(struct tri_mesh *mesh, const struct tri_quality *quality,
                              const struct par_partition *p, int phase, bool backwards)
{
    struct par_ids worklist = bad_triangles(mesh, quality);
    int32_t n = par_blocks(p), *block_of = malloc(((size_t)worklist.n + 1) * sizeof *block_of);
    int32_t *mine = malloc(((size_t)worklist.n + 1) * sizeof *mine);
    int64_t inserted = 0;
    assert_true(block_of && mine && worklist.n > 0);
    for (int32_t i = 0; i < worklist.n; i++)
        block_of[i] = par_block_at(p, phase, mesh->xy[mesh->tri[worklist.item[i]].v[0]]);
    for (int32_t k = 0; k < n; k++) {
        int32_t block = backwards ? n - 1 - k : k;
        struct tri_fence fence = par_fence(p, block / p->n_rows, block % p->n_rows);
        struct tri_refine_hooks hooks = {.gate = is_in, .gate_user = &fence, .fence = &fence, .worklist = mine};
        struct tri_refine_report report;
        for (int32_t i = 0; i < worklist.n; i++)
            if (block_of[i] == block)
                mine[hooks.n_worklist++] = worklist.item[i];
        if (hooks.n_worklist > 0)
            assert_int_equal(tri_refine_with(mesh, quality, &hooks, &report, NULL), TRI_OK);
        if (hooks.n_worklist > 0)
            inserted += report.inserted_free + report.inserted_on_segments;
    }
    free(block_of);
    free(mine);
    free(worklist.item);
    return inserted;
}

/* Returns the block whose fence contains all three corners in this phase; TRI_NONE: no block. */
static int32_t block_of_triangle(const struct par_partition *p, int phase, const struct tri_mesh *mesh,
                                 const int32_t v[3])
{
    int32_t block = par_block_at(p, phase, mesh->xy[v[0]]);
    for (int k = 1; k < 3; k++)
        if (par_block_at(p, phase, mesh->xy[v[k]]) != block)
            return TRI_NONE;
    return block;
}

/* Changed triangles belonged to one block before and belong to the same block now. */
static void assert_changes_are_owned(const struct tri_mesh *mesh, const struct tri_triangle *old, int32_t n_old,
                                     const struct par_partition *p, int phase)
{
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        const struct tri_triangle *now = &mesh->tri[t];
        if (!tri_is_live(now) || (t < n_old && memcmp(old[t].v, now->v, sizeof now->v) == 0))
            continue;
        int32_t block = block_of_triangle(p, phase, mesh, now->v);
        assert_int_not_equal(block, TRI_NONE);
        if (t < n_old)
            assert_int_equal(block_of_triangle(p, phase, mesh, old[t].v), block);
    }
}

/* Is the triangle on the other side of a subsegment of this triangle listed? Of the two triangles beside an encroached
   subsegment, one in the list is enough. */
static bool is_listed_across(const struct tri_mesh *mesh, const bool *listed, int32_t t)
{
    for (int e = 0; e < 3; e++)
        for (int side = 0; mesh->tri[t].n[e] < 0 && side < 2; side++) {
            int32_t beside = mesh->sub[~mesh->tri[t].n[e]].side[side];
            if (beside != TRI_NONE && listed[tri_of(beside)])
                return true;
        }
    return false;
}

/* Every bad triangle is in the worklist for the following phases, except those that were given up permanently. */
static void assert_worklist_holds_all_that_is_bad(const struct tri_mesh *mesh, const struct tri_quality *quality,
                                                  const struct par_ids *worklist,
                                                  const struct tri_refine_report *report)
{
    struct par_ids bad = bad_triangles(mesh, quality);
    bool *listed = calloc((size_t)mesh->n_triangles + 1, sizeof *listed);
    int64_t missing = 0;
    assert_non_null(listed);
    for (int32_t i = 0; i < worklist->n; i++)
        listed[worklist->item[i]] = true;
    for (int32_t i = 0; i < bad.n; i++)
        missing += !listed[bad.item[i]] && !(quality->conforming && is_listed_across(mesh, listed, bad.item[i]));
    for (int k = 0; k < TRI_EXCUSES; k++)
        missing -= report->given_up[k];
    assert_true(missing <= 0);
    free(listed);
    free(bad.item);
}

/* Runs the phase itself, and checks the state before and after it. */
static int64_t run_phase(struct tri_mesh *mesh, const struct tri_quality *quality, const struct par_partition *p,
                         int phase, const struct par_options *options, int64_t *pauses)
{
    struct tri_error error = {0};
    struct par_report report = {0};
    struct par_team team = {.threads = options->threads};
    struct par_run run = {.asked = {quality, options, par_executor(&team), 0}, .place = {.phase = phase},
                          .mesh = mesh, .report = &report, .bounds = *quality};
    const struct par_turn turn = {.partition = p, .only = TRI_NONE};
    int32_t n_old = mesh->n_triangles;
    struct tri_triangle *old = malloc((size_t)n_old * sizeof *old);
    assert_non_null(old);
    memcpy(old, mesh->tri, (size_t)n_old * sizeof *old);
    run.worklist = bad_triangles(mesh, quality);
    if (par_phase(&run, &turn, &error) != TRI_OK)
        fail_msg("%s", error.text);
    par_room_mark(&run.spare, mesh, NULL); /* entries for triangles that were never used hold arbitrary bytes */
    assert_changes_are_owned(mesh, old, n_old, p, phase);
    assert_worklist_holds_all_that_is_bad(mesh, quality, &run.worklist, &report.total);
    *pauses += report.pauses;
    par_room_close(&run.spare, mesh, &run.asked.executor);
    par_team_end(&team);
    assert_int_equal(tri_mesh_validate(mesh, &error), TRI_OK);
    int64_t inserted = report.total.inserted_free + report.total.inserted_on_segments;
    for (int32_t i = 0; i < report.n_blocks; i++)
        assert_true(report.blocks[i].block >= 0 && report.blocks[i].block < par_blocks(p));
    par_report_free(&report);
    free(run.worklist.item);
    free(run.key.item);
    free(old);
    return inserted;
}

/* Serialisation: the mesh does not depend on threads, the order of blocks, or pauses for room. */
static void test_a_phase_equals_its_blocks_one_by_one(void **state)
{
    (void)state;
    static const struct par_options options[] = {{.threads = 1},
                                                 {.threads = 3, .shuffle = 5},
                                                 {.threads = 2, .tight_room = 20},
                                                 {.threads = 4, .tight_room = 1, .shuffle = 9}};
    int64_t pauses = 0;
    for (int i = 0; i < N_TRIALS; i += every(2))
        for (int phase = 0; phase < PAR_PHASES; phase++) {
            struct tri_quality quality;
            struct tri_mesh first = start_of(&trials[i], &quality), second = start_of(&trials[i], &quality);
            struct par_partition partition = cut(&first, &quality, trials[i].block);
            int64_t inserted = run_one_by_one(&first, &quality, &partition, phase, false);
            assert_true(inserted > 100);
            assert_int_equal(run_one_by_one(&second, &quality, &partition, phase, true), inserted);
            struct support_places forwards = support_places(&first), backwards = support_places(&second);
            assert_true(support_same_places(&forwards, &backwards));
            for (int k = 0; k < 4; k++) {
                struct tri_mesh mesh = start_of(&trials[i], &quality);
                assert_int_equal(run_phase(&mesh, &quality, &partition, phase, &options[k], &pauses), inserted);
                struct support_places places = support_places(&mesh);
                assert_true(support_same_places(&forwards, &places));
                support_places_free(&places);
                tri_mesh_free(&mesh);
            }
            support_places_free(&forwards);
            support_places_free(&backwards);
            par_partition_free(&partition);
            tri_mesh_free(&first);
            tri_mesh_free(&second);
        }
    assert_true(pauses > 1000);
}

/* Four phases leave few bad triangles, all of them in the worklist. Triangles that no longer exist are dropped from
   it. */
static void test_four_phases_leave_few_bad_triangles(void **state)
{
    (void)state;
    for (int i = 0; i < N_TRIALS; i++) {
        struct tri_quality quality;
        struct par_options options = {.threads = 2};
        struct par_team team = {.threads = options.threads};
        struct par_report report = {0};
        struct tri_mesh mesh = start_of(&trials[i], &quality);
        struct par_partition partition = cut(&mesh, &quality, trials[i].block);
        struct par_run phases = {.asked = {&quality, &options, par_executor(&team), 0}, .mesh = &mesh,
                                 .report = &report, .bounds = quality};
        const struct par_turn turn = {.partition = &partition, .only = TRI_NONE};
        phases.worklist = bad_triangles(&mesh, &quality);
        for (; phases.place.phase < PAR_PHASES; phases.place.phase++) {
            assert_int_equal(par_phase(&phases, &turn, NULL), TRI_OK);
            par_room_mark(&phases.spare, &mesh, NULL);
            assert_worklist_holds_all_that_is_bad(&mesh, &quality, &phases.worklist, &report.total);
        }
        print_message("  %-16s %d left of %lld inserted\n", trials[i].file ? trials[i].file : "square",
                      (int)phases.worklist.n, (long long)report.total.inserted_free);
        assert_true(phases.worklist.n < report.total.inserted_free / 4);
        par_room_close(&phases.spare, &mesh, &phases.asked.executor);
        par_team_end(&team);
        assert_int_equal(tri_mesh_validate(&mesh, NULL), TRI_OK);
        support_assert_cdt(&mesh, false);
        par_report_free(&report);
        free(phases.worklist.item);
        free(phases.key.item);
        par_partition_free(&partition);
        tri_mesh_free(&mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_phase_equals_its_blocks_one_by_one),
        cmocka_unit_test(test_four_phases_leave_few_bad_triangles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
