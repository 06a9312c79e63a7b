/* The program as one of several tasks: which one prints, and how they end. */
#include "drivers/mesh/launch.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drivers/interrupt.h"
#include "drivers/start.h"

static void fall_silent(void)
{
    if (!freopen("/dev/null", "w", stdout) || !freopen("/dev/null", "w", stderr))
        _Exit(EXIT_FAILURE);
}

enum tri_status launch_join(struct launch *launch, struct tri_error *error)
{
    int task, tasks = tasks_started(&task);
    *launch = (struct launch){0};
    if (tasks == 1)
        return TRI_OK;
    launch->voice = tri_standard_error_reopen();
    if (task != 0)
        fall_silent();
    enum tri_status status = launch_ranks(launch, tasks, error);
    if (!status && task == 0 && launch->rank != 0) /* a launcher may use any numbers */
        fall_silent();
    return status;
}

/* A failed task reports its failure to all. */
static int agree_on_failure(struct launch *launch, int code, struct tri_error *error)
{
    if (code != EXIT_SUCCESS && !error->status)
        tri_fail(error, TRI_INTERNAL, NULL, 0, "task %d has failed", launch->rank);
    enum tri_status agreed = par_agree(launch->carrier, code == EXIT_SUCCESS ? TRI_OK : error->status, error);
    return code == EXIT_SUCCESS && agreed ? EXIT_FAILURE : code;
}

/* All tasks come here, regardless of earlier agreements, so a last agreement is possible. */
int launch_agree(struct launch *launch, int code, struct tri_error *error)
{
    enum { FIRST_STOP = 124 };
    struct par_carrier *carrier = launch->carrier;
    if (!carrier)
        return code;
    code = agree_on_failure(launch, code, error);
    const int64_t mine = code;
    bool told = !carrier->lost && carrier->gather(carrier->self, &mine, 1, carrier->of_each);
    for (int p = 0; told && p < carrier->n_ranks; p++)
        if (carrier->of_each[p] >= FIRST_STOP)
            return (int)carrier->of_each[p];
    return code;
}

static void say_loss(const struct launch *launch)
{
    char line[80];
    snprintf(line, sizeof line, "ptriangle: task %d cannot reach the others\n", launch->rank);
    (void)tri_write_next(launch->voice, line, strlen(line));
}

/* When a task aborts, the launcher kills the others, and task 0 may print nothing, or only that it was asked to end. If
 * task 0 has met the same loss, it has reported it, and this task waits until task 0 has ended all. In the same way
 * every task waits for tasks with lower numbers, up to LAST of them; a task that is ended meanwhile prints nothing.
 * After its message a task waits for the launcher to pass it on, because the launcher of MPICH drops output that it has
 * not read when a task ends. */
static void tell_loss(const struct launch *launch, bool told)
{
    enum { ENDING = 10, EACH = 20, LAST = 5, READING = 5 }; /* waiting time in tenths of a second, except LAST */
    const int before = (launch->rank < LAST ? launch->rank : LAST) - 1;
    if (launch->rank > 0 ? tri_pause((ENDING + EACH * before) / 10.0) : !told)
        say_loss(launch);
    (void)tri_pause(READING / 10.0);
}

int launch_leave(struct launch *launch, int code, struct tri_error *error)
{
    if (!launch->carrier)
        return code;
    const bool told = code != EXIT_SUCCESS;
    interrupt_told(); /* after a task exits with a failure, the launcher ends tasks that are still about to exit */
    code = agree_on_failure(launch, code, error);
    if (launch->carrier->lost)
        tell_loss(launch, told);
    launch_end(launch);
    return code;
}

/* --- First the structs are sent, whose pointers show which arrays exist. Then each array is sent into memory of its
 * own, so no rank has the input more than once. */

struct sharing {
    struct par_carrier *carrier;
    enum tri_status status;
    struct tri_error *error;
};

static void spread(struct sharing *s, void *bytes, size_t n)
{
    s->status = par_spread(s->carrier, PAR_MOVE_INPUT, bytes, n, s->status, s->error);
}

/* Sends an array of n items, which rank 0 may have or not. */
static void *array(struct sharing *s, void *own, bool exists, int64_t n, size_t item)
{
    size_t size = (size_t)n * item;
    void *bytes = own;
    if (!exists)
        return NULL;
    if (s->carrier->rank > 0 && !s->status) {
        bytes = malloc(size + 1);
        if (!bytes)
            s->status = tri_fail(s->error, TRI_NO_MEMORY, NULL, 0, "out of memory for the input");
    }
    spread(s, bytes, size);
    return bytes;
}

static void share_figure(struct sharing *s, struct tri_pslg *own, const struct tri_pslg *told)
{
    struct tri_pslg p = *told;
    p.points = array(s, own->points, told->points, 2 * (int64_t)p.n_points, sizeof *p.points);
    p.attributes = array(s, own->attributes, told->attributes, (int64_t)p.n_points * p.n_attributes,
                         sizeof *p.attributes);
    p.markers = array(s, own->markers, told->markers, p.n_points, sizeof *p.markers);
    p.segments = array(s, own->segments, told->segments, 2 * (int64_t)p.n_segments, sizeof *p.segments);
    p.segment_markers = array(s, own->segment_markers, told->segment_markers, p.n_segments,
                              sizeof *p.segment_markers);
    p.holes = array(s, own->holes, told->holes, 2 * (int64_t)p.n_holes, sizeof *p.holes);
    p.regions = array(s, own->regions, told->regions, 4 * (int64_t)p.n_regions, sizeof *p.regions);
    *own = p;
}

static void share_elements(struct sharing *s, struct tri_elements *own, const struct tri_elements *told)
{
    struct tri_elements e = *told;
    e.corners = array(s, own->corners, told->corners, 3 * (int64_t)e.n, sizeof *e.corners);
    e.attributes = array(s, own->attributes, told->attributes, (int64_t)e.n * e.n_attributes, sizeof *e.attributes);
    e.areas = array(s, own->areas, told->areas, e.n, sizeof *e.areas);
    e.extra = array(s, own->extra, told->extra, (int64_t)e.n * (e.n_nodes - 3), sizeof *e.extra);
    *own = e;
}

/* Sends fields of lengths. Fields that were not read from a file have no arrays. */
static void share_lengths(struct sharing *s, struct size_fields *own, const struct size_fields *told)
{
    for (int i = 0; i < SIZE_OPTIONS_MOST; i++) {
        const struct tri_size_file *mine = &own->file[i], *first = &told->file[i];
        const struct tri_size_field *f = &first->field;
        struct tri_size_file file = {.field = *f};
        file.values = array(s, mine->values, first->values, f->values.n * f->values.width, sizeof *file.values);
        file.points = array(s, mine->points, first->points, 2 * f->points.n, sizeof *file.points);
        file.triangles = array(s, mine->triangles, first->triangles, 3 * f->triangles.n, sizeof *file.triangles);
        file.field.values.at = file.values;
        file.field.points.at = file.points;
        file.field.triangles.at = file.triangles;
        own->file[i] = file;
        own->field[i] = first->values ? file.field : told->field[i];
    }
}

enum tri_status shared_input(struct par_carrier *carrier, struct run *run, enum tri_status status,
                             struct tri_error *error)
{
    struct sharing s = {carrier, status, error};
    struct run_input told = run->input; /* pointers of another rank; never followed here */
    struct size_fields sizes = run->sizes;
    spread(&s, &told, sizeof told);
    spread(&s, &sizes, sizeof sizes);
    if (s.status)
        return s.status;
    share_figure(&s, &run->input.pslg, &told.pslg);
    share_elements(&s, &run->input.elements, &told.elements);
    share_lengths(&s, &run->sizes, &sizes);
    run->input.base = told.base;
    run->input.points_in_poly = told.points_in_poly;
    return par_agree(carrier, s.status, error);
}

/* --- the report of all ranks */

static int64_t nanoseconds(double seconds) { return (int64_t)(1e9 * seconds); }

static double block_seconds(const struct par_report *schedule)
{
    double sum = 0;
    for (int32_t i = 0; i < schedule->n_blocks; i++)
        sum += schedule->blocks[i].seconds;
    return sum;
}

enum tri_status rank_report_gather(struct rank_report *report, struct par_carrier *carrier,
                                   const struct par_report *schedule, enum tri_status status, struct tri_error *error)
{
    int64_t mine[RANK_NUMBERS] = {[RANK_THREADS] = schedule->threads,
                                  [RANK_PEAK_MEMORY] = tri_memory_peak(),
                                  [RANK_NS_PROCESSOR] = nanoseconds(tri_process_seconds()),
                                  [RANK_NS_BLOCKS] = nanoseconds(block_seconds(schedule)),
                                  [RANK_NS_WAITING] = nanoseconds(carrier->seconds_waiting),
                                  [RANK_NS_MOVING] = nanoseconds(carrier->seconds_moving)};
    for (int k = 0; k < PAR_MOVES; k++) {
        mine[RANK_BYTES + k] = carrier->traffic[k].bytes;
        mine[RANK_MESSAGES + k] = carrier->traffic[k].messages;
    }
    report->number = malloc((size_t)carrier->n_ranks * sizeof *report->number);
    if (!status && !report->number)
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the report of all ranks");
    status = par_gather(carrier, mine, RANK_NUMBERS, report->number ? report->number[0] : NULL, status, error);
    report->n_ranks = status ? 0 : carrier->n_ranks;
    return status;
}
