/* Rates that have been measured (docs/performance.md), and one that is measured here: how long this machine takes for a
 * triangle. */
#include "drivers/mesh/needs.h"

#include <math.h>

#include "drivers/mesh/summary.h"
#include "triangle/base/system.h"
#include "triangle/size/estimate.h"

/* Measured: bytes a triangle at the peak, at least and with one refinement loop; time of the numbering against that of
 * refining; triangles against the least number that area bounds ask for. */
static const double LEAST_BYTES = 44, LOOP_BYTES = 52, NUMBERING = 0.55, AREA_FACTOR = 1.14;
/* The schedule: bytes of a triangle and its half vertex; what numbers them at the end takes of each triangle, those
 * that are there already too, and of each subsegment (par_number_bytes); and places that blocks are given and leave
 * empty, a triangle that angles ask for: areas tell beforehand how many it will be. */
static const double SCHEDULE_BYTES = 48, NUMBERING_BYTES = 26, NUMBERING_SUB_BYTES = 28, EMPTY_PLACES = 0.25;
/* Measured, of a mesh that is handed out as it is made: bytes of buffers and libraries; for pages of files on their
 * way, a thread; for each root of (triangles * triangles in a cell), of all columns in memory, of those of the mesh
 * on disk with room to grow, of what numbers and hands them out, and of the state of a checkpoint, of which there are
 * two; and, for each triangle to come, of the coarse mesh and what is told of blocks. */
static const double BUFFERS = 3e7, PAGES = 3e7, COLUMNS_HELD = 260, COLUMNS_AWAY = 290, COLUMNS_WORK = 140,
                    COLUMNS_STATE = 520, SWEPT_BYTES = 1.3;
/* The same a triangle, of a mesh that stays as a whole; of two states of it; and of the tiles in a checkpoint. */
static const double PARKED_WORK = 6, PARKED_BYTES = 90, WHOLE_STATES = 120, TILES_BYTES = 26;
/* The same of the lists of edges that lie beside it (tri_edge_list_make). */
static const double LISTS_BYTES = 18;
/* And of tiles that wait until all are there (triangle/text/stream.h), and what cutting them into parts adds. The
 * boundary that a .14 wants then, a byte a vertex in memory, does not show at the peak (measured at 5 million
 * triangles). */
static const double KEPT_BYTES = 46, PART_BYTES = 17;
/* The same a triangle of a rank's own, which are so many times the average; of its share of a state, of which there are
 * two; for each root as above what numbers and hands out a column, where a rank has that much; of pieces of files that
 * pass through the first rank; and, for each triangle of all ranks, of the coarse mesh and what begins with it. */
static const double RANK_BYTES = 62, BUSIEST = 1.15, RANK_STATES = 32, RANK_COLUMN = 45, RANK_PIECES = 3.5e7,
                    RANK_COARSE = 0.1, RANK_WORK = 20;
/* Of HDF5 files to which a mesh that is there as a whole goes: at least, a triangle, and at the most. */
static const double LEAST_STREAMED = 2e7, STREAM_BYTES = 40, MOST_STREAMED = 6e7;
/* Text that one thread writes in a second where a triangle takes it the usual time. */
static const double TEXT_BYTES = 6.5e8, USUAL_SECONDS = 1.25e-7;

/* --- triangles */

static double triangles_of(const struct run *run, double demand)
{
    const struct tri_quality *quality = &run->options.quality;
    double now = run->mesh.n_triangles, by_area = AREA_FACTOR * demand + now, triangles = by_area, sure;
    if (!run->options.refine)
        return now;
    if (run->settings.threads > 0)
        triangles = tri_estimate(&run->mesh, quality, run->settings.executor, &sure);
    triangles = fmax(triangles, by_area < TRI_MAX_TRIANGLES ? 0 : by_area); /* estimates may end at what a mesh holds */
    return quality->max_steiner < 0 ? triangles : fmin(triangles, now + 2 * (double)quality->max_steiner);
}

/* --- bytes */

static double digits(double number) { return number < 10 ? 1 : floor(log10(number)) + 1; }

/* Of Triangle's files, but for .poly. A coordinate takes about 19 characters with its blanks. */
static double text_of(const struct run *run, double vertices, double triangles)
{
    const struct tri_switches *s = &run->arguments->switches;
    double v = digits(vertices) + 2, t = digits(triangles) + 4, edges = 1.5 * triangles, points = 2 * 19.5;
    double node = vertices * (v + 2 + points + 20 * run->mesh.n_attributes + 5 * !s->no_markers);
    double ele = triangles * (t + (s->second_order ? 6 : 3) * v);
    double bytes = (s->no_node ? 0 : node) + (s->no_ele ? 0 : ele);
    bytes += s->edges ? edges * (t + 2 * v + 5) : 0;
    bytes += s->neighbors ? triangles * (t + 3 * v) : 0;
    bytes += s->voronoi ? triangles * (t + points) + edges * (t + 2 * v) : 0;
    bytes += s->second_order && !s->no_node ? edges * (v + points) : 0;
    return s->off ? bytes + vertices * points + triangles * (3 * v + 5) : bytes;
}

/* In other formats: numbers are about as long in all of them. */
static double exports_of(const struct run *run, double vertices, double triangles)
{
    const struct tri_switches *s = &run->arguments->switches;
    double index = vertices > INT32_MAX ? 8 : 4, nodes = s->second_order ? 6 : 3;
    double row = vertices * (28 + 8 * run->mesh.n_attributes) + triangles * (nodes * index + 4);
    double marker = s->no_markers ? 0 : 4;
    double h5 = vertices * (16 + marker + 8 * run->mesh.n_attributes) + triangles * 3 * index; /* the rest deflates */
    return run->settings.options->n_exports * row + run->settings.options->n_streams * h5;
}

static double disk_of(const struct run *run, double vertices, double triangles)
{
    double text = long_options_exports_alone(run->settings.options) ? 0 : text_of(run, vertices, triangles);
    return text + exports_of(run, vertices, triangles);
}

/* Beside what refining takes: what the mesh has for other reasons, and lists of edges. */
static double bytes_a_triangle(const struct run *run)
{
    const struct tri_switches *s = &run->arguments->switches;
    bool lists = s->second_order || s->edges || s->voronoi || s->off;
    return (run->settings.threads > 0 ? SCHEDULE_BYTES : LOOP_BYTES) + 6 * run->mesh.n_attributes + (lists ? 6 : 0) +
           (s->second_order ? 12 : 0);
}

/* What -C takes beside the mesh; what it must where there is a bound. */
static double bytes_of_check(const struct run *run, double grown)
{
    if (!run->arguments->switches.check)
        return 0;
    if (run->settings.options->memory > 0)
        return grown + self_check_least_bytes(&run->mesh);
    return SELF_CHECK_BYTES * (grown + run->mesh.n_triangles) + SELF_CHECK_SUB_BYTES * (double)run->mesh.n_subs;
}

double estimate_streams(const struct run *run, double triangles)
{
    return run->settings.options->n_streams * fmin(LEAST_STREAMED + STREAM_BYTES * triangles, MOST_STREAMED);
}

/* What is done with a mesh that is finished, one after the other. */
static double bytes_beside(const struct run *run, double grown)
{
    return fmax(bytes_of_check(run, grown), estimate_streams(run, run->mesh.n_triangles + grown));
}

/* At the peak, of a mesh that grows by so many triangles, of which areas demand some. */
static double bytes_whole(const struct run *run, double grown, double demand)
{
    if (run->settings.threads == 0 || !run->options.refine)
        return grown * bytes_a_triangle(run);
    double places = grown + EMPTY_PLACES * fmax(grown - demand, 0);
    double refined = places * bytes_a_triangle(run) + (run->mesh.n_triangles + places) * NUMBERING_BYTES +
                     run->mesh.n_subs * NUMBERING_SUB_BYTES;
    return fmax(refined, grown * bytes_a_triangle(run) + bytes_beside(run, grown));
}

/* --- seconds */

/* Of one triangle, on one thread that nobody holds up: a small square is refined twice; the second time its memory is
 * there. */
static double seconds_a_triangle(void)
{
    double corners[] = {0, 0, 1, 0, 1, 1, 0, 1}, seconds = 0;
    struct tri_pslg square = {.n_points = 4, .points = corners};
    struct tri_options options = tri_defaults();
    options.quality.min_angle = 20;
    options.quality.max_area = 1e-4 / 3;
    for (int i = 0; i < 2; i++) {
        struct tri_mesh mesh;
        struct tri_report report;
        if (tri_generate(&mesh, &square, &options, &report, NULL) != TRI_OK)
            return USUAL_SECONDS;
        double began = tri_thread_seconds();
        tri_refine(&mesh, &options.quality, &report.quality, NULL);
        seconds = (tri_thread_seconds() - began) / (mesh.n_triangles + 1);
        tri_mesh_free(&mesh);
    }
    return seconds;
}

/* Reading, and the triangulation that is there already; no more than the processor has worked for it, since others may
 * have held it up. */
static double seconds_so_far(const struct run *run)
{
    double sum = 0;
    for (int stage = 0; stage < RUN_STAGES; stage++)
        sum += run->time.stage[stage];
    return fmin(sum, tri_process_seconds());
}

static double seconds_of(const struct run *run, double triangles, double disk)
{
    double one = seconds_a_triangle(), threads = fmax(run->settings.threads, 1);
    double work = run->options.refine ? triangles * one * (run->settings.threads > 0 ? 1 + NUMBERING : 1) : 0;
    double text = disk / TEXT_BYTES * (one / USUAL_SECONDS);
    return seconds_so_far(run) + (work + text) / threads;
}

/* --- all together */

/* The root that what a sweep holds grows with: so many triangles are in a column, to the order. Without cells the
 * mesh is one column. */
static double column_of(const struct run *run, double triangles)
{
    double (*cell_triangles)(double triangles) = run->settings.cell_triangles;
    return sqrt(triangles * (cell_triangles ? cell_triangles(triangles) : triangles));
}

/* As schedules go: above TRI_EASY_ANGLE there are two, which ranks can share; a limit on new points makes it one
 * call. */
static bool is_swept(const struct run *run)
{
    const struct tri_quality *quality = &run->options.quality;
    return (run->settings.n_ranks > 0 || quality->min_angle <= TRI_EASY_ANGLE) && quality->max_steiner < 0;
}

bool estimate_can_park(const struct run *run, double held)
{
    const bool bounded = run->settings.options->memory > 0;
    return tri_memory_end() != TRI_ENDS_ADDRESS_SPACE || (bounded && held <= tri_memory_left());
}

/* The least memory that does, where some of what is held could go to files. */
static double floor_of(const struct run *run, double held, double work)
{
    return estimate_can_park(run, held) ? fmin(held, BUFFERS + work) : held;
}

/* Of the rank that has most. */
static struct needs needs_of_rank(const struct run *run, double grown)
{
    const double own = fmin(BUSIEST * grown / run->settings.n_ranks, grown), column = column_of(run, grown);
    const double work = RANK_PIECES + fmin(RANK_COLUMN * column, RANK_WORK * own) + RANK_COARSE * grown;
    struct needs n = {.triangles = grown, .whole = own * RANK_BYTES};
    n.held = n.whole + BUFFERS;
    n.floor = floor_of(run, n.held, work + PAGES * fmax(run->settings.threads, 1));
    n.away = PARKED_BYTES * own;
    n.checkpoint = n.states = RANK_STATES * grown;
    return n;
}

/* whole: bytes where it is in memory as a whole. */
static struct needs needs_of(const struct run *run, double grown, double whole, bool sweeps)
{
    if (run->settings.n_ranks > 0 && sweeps)
        return needs_of_rank(run, grown);
    const struct long_options *o = run->settings.options;
    const double column = column_of(run, grown), pages = PAGES * fmax(run->settings.threads, 1);
    const double work = sweeps ? COLUMNS_WORK * column + SWEPT_BYTES * grown : PARKED_WORK * grown;
    struct needs n = {.triangles = grown, .whole = whole};
    n.held = sweeps ? BUFFERS + COLUMNS_HELD * column + SWEPT_BYTES * grown : n.whole;
    n.floor = floor_of(run, n.held, work + pages);
    n.away = sweeps ? COLUMNS_AWAY * column : PARKED_BYTES * grown;
    n.filed = floor_of(run, whole, PARKED_WORK * grown + pages + bytes_beside(run, grown));
    n.filed_away = (PARKED_BYTES + LISTS_BYTES) * grown;
    n.kept = o->n_exports > 0 ? (KEPT_BYTES + (o->n_parts > 0 ? PART_BYTES : 0)) * grown : 0;
    n.states = WHOLE_STATES * grown;
    n.checkpoint = sweeps ? TILES_BYTES * grown + COLUMNS_STATE * column : n.states;
    return n;
}

struct estimate estimate_make(const struct run *run, bool with_seconds)
{
    const struct tri_quality *quality = &run->options.quality;
    const double demand = run->options.refine ? tri_size_demand(&run->mesh, quality, run->settings.executor) : 0;
    const double now = run->mesh.n_triangles, triangles = triangles_of(run, demand), grown = fmax(triangles - now, 0);
    const bool sweeps = is_swept(run);
    struct estimate e = {.sweeps = sweeps, .vertices = run->mesh.n_vertices + grown / 2};
    e.likely = needs_of(run, grown, bytes_whole(run, grown, demand), sweeps);
    e.likely.triangles = triangles;
    e.likely.files = disk_of(run, e.vertices, triangles);
    if (demand > 0 && quality->max_steiner < 0) {
        e.least = needs_of(run, demand, demand * LEAST_BYTES, sweeps);
        e.least.files = disk_of(run, 0.5 * demand, demand);
    }
    e.seconds = with_seconds ? seconds_of(run, triangles, e.likely.files) : 0;
    return e;
}
