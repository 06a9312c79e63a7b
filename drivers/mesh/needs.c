/* Estimates from measured rates (docs/performance.md), and from the time per triangle on this machine, which is
 * measured here. */
#include "drivers/mesh/needs.h"

#include <math.h>

#include "drivers/mesh/summary.h"
#include "triangle/base/system.h"
#include "triangle/check/check.h"
#include "triangle/hdf5/h5_write.h"
#include "triangle/refine/smooth.h"
#include "triangle/size/estimate.h"

/* Measured: least bytes per triangle at the peak; bytes of one refinement loop beside the mesh; time of numbering
 * relative to refinement; number of triangles relative to the least number that area bounds require. */
static const double LEAST_BYTES = 44, LOOP_BYTES = 4, NUMBERING = 0.55, AREA_FACTOR = 1.14;
/* Bytes of text that one thread writes in a second, on a machine with the usual time per triangle. */
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
    triangles = fmax(triangles, by_area < TRI_MAX_TRIANGLES ? 0 : by_area); /* estimates may end at the capacity of a
                                                                               mesh */
    return quality->max_steiner < 0 ? triangles : fmin(triangles, now + 2 * (double)quality->max_steiner);
}

/* --- bytes */

static double digits(double number) { return number < 10 ? 1 : floor(log10(number)) + 1; }

/* Bytes of Triangle's files, except .poly. A coordinate has about 19 characters with blanks. */
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

/* Bytes of other formats: numbers are about as long in all of them. */
static double exports_of(const struct run *run, double vertices, double triangles)
{
    const struct tri_switches *s = &run->arguments->switches;
    double index = vertices > INT32_MAX ? 8 : 4, nodes = s->second_order ? 6 : 3;
    double row = vertices * (28 + 8 * run->mesh.n_attributes) + triangles * (nodes * index + 4);
    double marker = s->no_markers ? 0 : 4;
    double h5 = vertices * (16 + marker + 8 * run->mesh.n_attributes) + triangles * 3 * index; /* the other arrays
                                                                                                  are compressed */
    return run->settings.options->n_exports * row + run->settings.options->n_streams * h5;
}

static double disk_of(const struct run *run, double vertices, double triangles)
{
    double text = long_options_exports_alone(run->settings.options) ? 0 : text_of(run, vertices, triangles);
    return text + exports_of(run, vertices, triangles);
}

double estimate_edge_lists(const struct run *run)
{
    const struct tri_switches *s = &run->arguments->switches;
    const bool lists = s->second_order || s->edges || s->voronoi || s->off;
    return (lists ? TRI_EDGE_LIST_BYTES : 0) + (s->second_order ? TRI_EDGE_NUMBERS_BYTES : 0);
}

double estimate_bytes_each(const struct run *run)
{
    return tri_mesh_bytes_each(run->mesh.n_attributes) + (run->settings.threads > 0 ? 0 : LOOP_BYTES) +
           estimate_edge_lists(run);
}

/* Bytes that -C needs beside the mesh, or the least number if there is a bound. */
static double bytes_of_check(const struct run *run, double grown)
{
    if (!run->arguments->switches.check)
        return 0;
    if (run->settings.options->memory > 0)
        return grown + self_check_least_bytes(&run->mesh);
    return TRI_CHECK_BYTES * (grown + run->mesh.n_triangles) + TRI_CHECK_SUB_BYTES * (double)run->mesh.n_subs;
}

double estimate_streams(const struct run *run, double triangles)
{
    return run->settings.options->n_streams * tri_h5_writer_bytes(triangles);
}

double estimate_bytes_beside(const struct run *run, double grown)
{
    return fmax(bytes_of_check(run, grown), estimate_streams(run, run->mesh.n_triangles + grown));
}

/* --- seconds */

/* Returns the seconds for one triangle on one undisturbed thread. A small square is refined twice; the second time its
 * memory is already mapped. */
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

/* Returns the seconds of reading and triangulating, which are done. Processor time limits the result, because other
 * programs may have delayed it. */
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

/* Follows the rules of the schedule: above TRI_EASY_ANGLE there are two schedules, which ranks can share. A limit on
 * new points makes it one call. */
static bool is_swept(const struct run *run)
{
    const struct tri_quality *quality = &run->options.quality;
    return (run->settings.n_ranks > 0 || quality->min_angle <= TRI_EASY_ANGLE) && quality->max_steiner < 0 &&
           !tri_wants_smoothing(quality);
}

bool estimate_can_park(const struct run *run, double held)
{
    const bool bounded = run->settings.options->memory > 0;
    return tri_memory_nearest_limit() != TRI_LIMIT_ADDRESS_SPACE || (bounded && held <= tri_memory_left());
}

struct estimate estimate_make(const struct run *run, bool with_seconds)
{
    const struct tri_quality *quality = &run->options.quality;
    const double demand = run->options.refine ? tri_size_demand(&run->mesh, quality, run->settings.executor) : 0;
    const double now = run->mesh.n_triangles, triangles = triangles_of(run, demand), grown = fmax(triangles - now, 0);
    struct estimate e = {.sweeps = is_swept(run), .vertices = run->mesh.n_vertices + grown / 2};
    e.likely = (struct needs){.whole = grown * estimate_bytes_each(run)};
    if (run->settings.schedule_needs)
        run->settings.schedule_needs(run, e.sweeps, grown, demand, &e.likely);
    e.likely.triangles = triangles;
    e.likely.files = disk_of(run, e.vertices, triangles);
    if (demand > 0 && quality->max_steiner < 0) {
        e.least = (struct needs){.whole = demand * LEAST_BYTES};
        if (run->settings.schedule_needs)
            run->settings.schedule_needs(run, e.sweeps, demand, -1, &e.least);
        e.least.triangles = demand;
        e.least.files = disk_of(run, 0.5 * demand, demand);
    }
    e.seconds = with_seconds ? seconds_of(run, triangles, e.likely.files) : 0;
    return e;
}
