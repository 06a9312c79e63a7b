/* Prints lines about a finished mesh. Labels and columns are those of Triangle, because scripts parse them. */
#include "drivers/mesh/summary.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "triangle/check/check.h"
#include "triangle/refine/census.h"
#include "triangle/refine/split.h"

/* --- warnings */

static void warn_of_duplicates(const struct run *run)
{
    const int32_t *twin = run->plan.swept ? run->twin : run->mesh.twin;
    const double *points = run->input.pslg.points;
    int64_t n = 0;
    for (int32_t v = 0; twin && v < run->input.pslg.n_points; v++)
        if (twin[v] != v && n++ < CONSOLE_SERIES_LINES)
            console_warn(&run->console, "duplicate vertex at (%.12g, %.12g) ignored.\n", points[2 * (size_t)v],
                         points[2 * (size_t)v + 1]);
    console_series_end(&run->console, n, "duplicate vertices ignored");
}

void summary_notes(const struct run *run)
{
    const struct tri_notes *notes = &run->report.notes;
    if (notes->skipped[0] && !run->console.quiet)
        console_remark(&run->console, "warning: %s\n", notes->skipped);
    if (notes->empty[0])
        console_remark(&run->console, "warning: %s\n", notes->empty);
}

/* Warns of Voronoi vertices beyond a subsegment. They occur if its diametral circle contains the apex of the triangle.
 * Without segments the mesh ends at the convex hull, and no Voronoi vertex is reported beyond it. */
static void warn_of_voronoi(const struct run *run)
{
    const struct tri_mesh *mesh = &run->mesh;
    const struct tri_switches *s = &run->arguments->switches;
    int64_t n = 0;
    for (tri_sub_id i = 0; s->voronoi && (s->segments || s->mesh) && i < mesh->n_subs; i++)
        for (int side = 0; side < 2; side++)
            n += mesh->sub[i].side[side] != TRI_NONE &&
                 tri_is_in_diametral_disk(mesh, &mesh->sub[i], mesh->sub[i].side[side]);
    if (n > 0)
        console_warn(&run->console, "Voronoi vertices beyond a segment, perhaps nearer to other sites than their own:"
                     " %" PRId64 ". -D prevents that.\n", n);
}

void summary_input(const struct run *run)
{
    const struct console *console = &run->console;
    const struct tri_report *report = &run->report;
    warn_of_duplicates(run);
    if (report->constrain.crossings > 0)
        console_say(console, "Segments cross: %" PRId32 " vertices were made where they do.\n",
                    report->constrain.crossings);
    if (report->constrain.bent > 0)
        console_warn(console, "segments were led through a vertex that lies nearly on them %" PRId32 " times.\n",
                     report->constrain.bent);
    if (report->carve.between > 0)
        console_warn(console, "hole points on segments, which empty nothing: %" PRId32 ".\n", report->carve.between);
    summary_notes(run);
    warn_of_voronoi(run);
}

static const char *reason_of(const struct run *run, enum tri_excuse excuse)
{
    switch (excuse) {
    case TRI_EXCUSE_INPUT_ANGLE: return "at small angles of the input";
    case TRI_EXCUSE_NARROW_GAP: return "between segments too near to each other";
    case TRI_EXCUSE_PROTECTED:
        return run->options.quality.protect > 1 ? "for segments that -YY protects"
                                                : "for the boundary that -Y protects";
    case TRI_EXCUSE_LIMIT: return run->report.quality.hit_limit ? "for the limit of -S" : "where vertices ran away";
    case TRI_EXCUSE_PRECISION: return "at features too fine for the coordinates";
    default: return "for other reasons";
    }
}

int64_t summary_sum(const int64_t count[TRI_EXCUSES])
{
    int64_t sum = 0;
    for (int k = 0; k < TRI_EXCUSES; k++)
        sum += count[k];
    return sum;
}

/* Prints the rest of a line: the number for each reason, or nothing if there are none. */
static void say_reasons(const struct run *run, const int64_t count[TRI_EXCUSES])
{
    const char *comma = "";
    for (int k = 0; k < TRI_EXCUSES; k++) {
        if (count[k] == 0)
            continue;
        console_say(&run->console, "%s %" PRId64 " %s", comma, count[k], reason_of(run, (enum tri_excuse)k));
        comma = ",";
    }
    if (*comma)
        console_say(&run->console, ".\n");
}

static void say_encroached(const struct run *run)
{
    int64_t count[TRI_EXCUSES];
    tri_count_encroached(&run->mesh, &run->options.quality, &run->report.quality, count);
    const int64_t n = summary_sum(count);
    if (n > 0)
        console_say(&run->console, "%" PRId64 " subsegment%s a vertex in the diametral circle:", n,
                    n == 1 ? " keeps" : "s keep");
    say_reasons(run, count);
}

void summary_bounds(struct run *run)
{
    const struct console *console = &run->console;
    const struct tri_quality *quality = &run->options.quality;
    if (!console->quiet && !run->plan.swept) { /* one pass over all triangles */
        if (quality->conforming)
            say_encroached(run);
        tri_count_bad(&run->mesh, quality, &run->report.quality, run->settings.executor, run->remain);
        run->remain_known = true;
    }
    const int64_t n = run->remain_known ? summary_sum(run->remain) : -1;
    if (n == 0)
        console_say(console, "All triangles keep the bounds%s.\n", quality->conforming ? " on angles and sizes" : "");
    else if (n > 0)
        console_say(console, "%" PRId64 " triangle%s below the bounds:", n, n == 1 ? " stays" : "s stay");
    if (n > 0)
        say_reasons(run, run->remain);
}

/* --- Statistics */

/* Midpoints of edges that were read with -r are not written again. */
static void warn_of_unused(const struct run *run)
{
    const int64_t n = run->unused.n;
    if (n > 0 && run->counts.triangles > 0 && !run->arguments->switches.jettison && !run->input.elements.extra)
        console_warn(&run->console, "%" PRId64 " point%s in no triangle: %s.\n", n, n == 1 ? " is" : "s are",
                     long_options_exports_alone(run->settings.options) ? "left out" : "-j leaves them out");
}

void summary_counts(const struct run *run)
{
    const struct console *console = &run->console;
    const struct tri_switches *switches = &run->arguments->switches;
    const struct tri_counts *counts = &run->counts;
    warn_of_unused(run);
    console_say(console, "\nStatistics:\n\n  Input vertices: %" PRId32 "\n", run->input.pslg.n_points);
    if (switches->mesh)
        console_say(console, "  Input triangles: %" PRId32 "\n", run->input.elements.n);
    if (switches->segments)
        console_say(console, "  Input segments: %" PRId32 "\n", run->input.pslg.n_segments);
    if (switches->segments && !switches->mesh)
        console_say(console, "  Input holes: %" PRId32 "\n", run->input.pslg.n_holes);
    if (size_options_any(&run->arguments->sizes)) {
        char text[SIZE_OPTIONS_TEXT];
        size_options_print(&run->arguments->sizes, text);
        console_say(console, "  Sizes: %s\n", text);
    }
    int64_t nodes_amid = switches->second_order ? counts->edges : 0;
    console_say(console, "\n  Mesh vertices: %" PRId64 "\n", counts->vertices + nodes_amid);
    console_say(console, "  Mesh triangles: %" PRId64 "\n", counts->triangles);
    console_say(console, "  Mesh edges: %" PRId64 "\n", counts->edges);
    console_say(console, "  Mesh exterior boundary edges: %" PRId64 "\n", counts->exterior);
    if (switches->segments || switches->mesh) {
        console_say(console, "  Mesh interior boundary edges: %" PRId64 "\n", counts->interior);
        console_say(console, "  Mesh subsegments (constrained edges): %" PRId64 "\n", counts->subsegments);
    }
    console_say(console, "\n");
}

/* --- the blocks of -V */

static void print_aspects(const struct tri_shapes *shapes)
{
    enum { ROWS = TRI_ASPECT_BINS / 2 };
    printf("  Triangle aspect ratio histogram:\n");
    for (int k = 0; k < ROWS; k++) {
        char beyond[16] = "";
        if (k + ROWS + 1 < TRI_ASPECT_BINS)
            snprintf(beyond, sizeof beyond, "%.6g", tri_aspect_limits[k + ROWS + 1]);
        printf("  %6.6g - %-10.6g:%10" PRId64 "    | %6.6g - %-11s:%10" PRId64 "\n", tri_aspect_limits[k],
               tri_aspect_limits[k + 1], shapes->aspects[k], tri_aspect_limits[k + ROWS], beyond,
               shapes->aspects[k + ROWS]);
    }
    printf("  (Longest edge divided by shortest altitude)\n\n");
}

static void print_angles(const struct tri_shapes *shapes)
{
    enum { ROWS = TRI_ANGLE_BINS / 2 };
    printf("  Smallest angle: %15.5g   |  Largest angle: %15.5g\n\n", shapes->smallest_angle,
           shapes->largest_angle);
    printf("  Angle histogram:\n");
    for (int k = 0; k < ROWS; k++)
        printf("    %3d - %3d degrees:%10" PRId64 "    |    %3d - %3d degrees:%10" PRId64 "\n", 10 * k, 10 * k + 10,
               shapes->angles[k], 10 * (k + ROWS), 10 * (k + ROWS) + 10, shapes->angles[k + ROWS]);
    printf("\n");
}

static int64_t bytes_of(const struct tri_mesh *mesh)
{
    int64_t a_vertex = (int64_t)sizeof *mesh->xy + 8 + 8 * (int64_t)mesh->n_attributes;
    return mesh->vertex_capacity * a_vertex + (int64_t)mesh->triangle_capacity * (int64_t)sizeof *mesh->tri +
           (int64_t)mesh->sub_capacity * (int64_t)sizeof *mesh->sub +
           (int64_t)mesh->parent_capacity * (int64_t)sizeof *mesh->parents;
}

void summary_shapes(const struct run *run)
{
    const struct tri_mesh *mesh = &run->mesh;
    struct tri_shapes shapes;
    tri_measure_shapes(&shapes, mesh, run->settings.executor);
    printf("Mesh quality statistics:\n\n");
    printf("  Smallest area: %16.5g   |  Largest area: %16.5g\n", shapes.smallest_area, shapes.largest_area);
    printf("  Shortest edge: %16.5g   |  Longest edge: %16.5g\n", shapes.shortest_edge, shapes.longest_edge);
    printf("  Shortest altitude: %12.5g   |  Largest aspect ratio: %8.5g\n\n", shapes.shortest_altitude,
           shapes.largest_aspect);
    print_aspects(&shapes);
    print_angles(&shapes);
    printf("Memory allocation statistics:\n\n  Maximum number of vertices: %" PRId32 "\n", mesh->n_vertices);
    printf("  Maximum number of triangles: %" PRId32 "\n", mesh->n_triangles);
    printf("  Maximum number of subsegments: %" PRId32 "\n", mesh->n_subs);
    printf("  Approximate heap memory use (bytes): %" PRId64 "\n\n", bytes_of(mesh));
    printf("Algorithmic statistics:\n\n  Vertices at crossings of segments: %" PRId32 "\n",
           run->report.constrain.crossings);
    printf("  Vertices put on segments: %" PRId64 "\n", run->report.quality.inserted_on_segments);
    printf("  Vertices put into triangles: %" PRId64 "\n\n", run->report.quality.inserted_free);
}

/* --- The mesh in the form of the checker, the check, and its lines. */

static enum tri_status read_mesh(void *user, enum tri_check_array array, int64_t first, int64_t n, void *out,
                                 struct tri_error *error)
{
    const struct tri_mesh *mesh = user;
    double(*points)[2] = out;
    int64_t *number = out;
    (void)error;
    for (int64_t i = first; i < first + n; i++) {
        if (array == TRI_CHECK_POINTS) {
            points[i - first][0] = mesh->xy[i].x;
            points[i - first][1] = mesh->xy[i].y;
        }
        for (int k = 0; array == TRI_CHECK_CORNERS && k < 3; k++)
            *number++ = mesh->tri[i].v[k];
        for (int k = 0; array == TRI_CHECK_SEGMENT_ENDS && k < 2; k++)
            *number++ = mesh->sub[i].v[k];
    }
    return TRI_OK;
}

static struct tri_check_source source_of(const struct tri_mesh *mesh)
{
    return (struct tri_check_source){.n_points = mesh->n_vertices, .n_triangles = mesh->n_triangles,
                                     .n_segments = mesh->n_subs, .n_nodes = mesh->n_vertices,
                                     .given = 1u << TRI_CHECK_POINTS | 1u << TRI_CHECK_CORNERS |
                                              1u << TRI_CHECK_SEGMENT_ENDS,
                                     .read = read_mesh, .user = (void *)mesh};
}

/* Additional bytes, for parts of useful size. */
static const double PARTS = 4e6;

/* Returns the least memory bound that the checker accepts, in bytes. */
static double least_bytes(const struct tri_check_source *source)
{
    return tri_check_least_bytes(source, NULL) / TRI_CHECK_SHARE + PARTS;
}

double self_check_least_bytes(const struct tri_mesh *mesh)
{
    const struct tri_check_source source = source_of(mesh);
    return least_bytes(&source);
}

static void tell(const struct console *console, const struct tri_check_report *report, bool conforming)
{
    int64_t faults = 0;
    for (int k = 0; k < TRI_N_CHECKS; k++) {
        const struct tri_check_item *item = &report->item[k];
        if (item->state != TRI_CHECK_FAILED)
            continue;
        faults += item->count;
        console_say(console, "  !! !! %s: %" PRId64 ", first: %s\n", tri_check_name((enum tri_check_kind)k),
                    item->count, item->text);
    }
    if (faults > 0) {
        console_say(console, "  The mesh has %" PRId64 " faults.\n", faults);
        return;
    }
    console_say(console, "  Topology: consistent, every triangle counter-clockwise.\n");
    console_say(console, "  Delaunay property: %s.\n", conforming ? "conforming Delaunay" : "constrained Delaunay");
}

enum tri_status self_check(const struct run *run, double memory)
{
    const bool conforming = run->arguments->switches.conforming;
    struct tri_check_report report;
    const struct tri_check_options options = {
        .max_bad = INT64_MAX, .ignore_lost = true, .base = run->input.base,
        .delaunay = conforming ? TRI_CHECK_CONFORMING : TRI_CHECK_CONSTRAINED};
    struct tri_check_source source = source_of(&run->mesh);
    source.memory = memory > 0 ? fmax(memory, least_bytes(&source)) : 0;
    source.scratch = run->settings.options->scratch;
    console_say(&run->console, "Checking the mesh.\n");
    enum tri_status status = tri_check_from(&source, NULL, &options, &report, run->error);
    if (!status)
        tell(&run->console, &report, conforming);
    return status;
}
