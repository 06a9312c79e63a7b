/* Lines about a finished mesh. Labels and columns of the blocks are those of Triangle, since scripts parse them. */
#include "drivers/mesh/summary.h"

#include <inttypes.h>
#include <stdio.h>

#include "triangle/refine/census.h"

/* --- what went otherwise */

void summary_segments(const struct console *console, const struct tri_constrain_report *report)
{
    if (report->crossings > 0)
        console_say(console, "Segments cross: %" PRId32 " vertices were made where they do.\n", report->crossings);
    if (report->bent > 0)
        console_warn(console, "segments were led through a vertex that lies nearly on them %" PRId32 " times.\n",
                     report->bent);
}

void summary_holes(const struct console *console, const struct tri_report *report)
{
    if (report->carve.between > 0)
        console_warn(console, "hole points on segments, which empty nothing: %" PRId32 ".\n", report->carve.between);
}

void summary_notes(const struct console *console, const struct tri_notes *notes)
{
    if (notes->skipped[0] && !console->quiet)
        console_remark(console, "warning: %s\n", notes->skipped);
    if (notes->empty[0])
        console_remark(console, "warning: %s\n", notes->empty);
}

void summary_duplicates(const struct console *console, const int32_t *twin, const struct tri_pslg *pslg)
{
    int64_t n = 0;
    for (int32_t v = 0; twin && v < pslg->n_points; v++)
        if (twin[v] != v && n++ < CONSOLE_SERIES_LINES)
            console_warn(console, "duplicate vertex at (%.12g, %.12g) ignored.\n", pslg->points[2 * (size_t)v],
                         pslg->points[2 * (size_t)v + 1]);
    console_series_end(console, n, "duplicate vertices ignored");
}

static const char *reason_of(enum tri_excuse excuse, const struct tri_quality *options,
                             const struct tri_refine_report *report)
{
    switch (excuse) {
    case TRI_EXCUSE_INPUT_ANGLE: return "at small angles of the input";
    case TRI_EXCUSE_NARROW_GAP: return "between segments too near to each other";
    case TRI_EXCUSE_PROTECTED:
        return options->protect > 1 ? "for segments that -YY protects" : "for the boundary that -Y protects";
    case TRI_EXCUSE_LIMIT: return report->hit_limit ? "for the limit of -S" : "where vertices ran away";
    case TRI_EXCUSE_PRECISION: return "at features too fine for the coordinates";
    default: return "for other reasons";
    }
}

static int64_t sum_of(const int64_t count[TRI_EXCUSES])
{
    int64_t sum = 0;
    for (int k = 0; k < TRI_EXCUSES; k++)
        sum += count[k];
    return sum;
}

/* The rest of a line: how many for each reason. Nothing where there are none. */
static void say_reasons(const struct console *console, const int64_t count[TRI_EXCUSES],
                        const struct tri_quality *options, const struct tri_refine_report *report)
{
    const char *comma = "";
    for (int k = 0; k < TRI_EXCUSES; k++) {
        if (count[k] == 0)
            continue;
        console_say(console, "%s %" PRId64 " %s", comma, count[k], reason_of((enum tri_excuse)k, options, report));
        comma = ",";
    }
    if (*comma)
        console_say(console, ".\n");
}

void summary_bounds(const struct console *console, const struct tri_mesh *mesh,
                    const struct tri_quality *options, const struct tri_refine_report *report,
                    const struct tri_executor *executor, int64_t remain[TRI_EXCUSES])
{
    if (options->conforming) {
        int64_t count[TRI_EXCUSES];
        tri_count_encroached(mesh, options, report, count);
        int64_t n = sum_of(count);
        if (n > 0)
            console_say(console, "%" PRId64 " subsegment%s a vertex in the diametral circle:", n,
                        n == 1 ? " keeps" : "s keep");
        say_reasons(console, count, options, report);
    }
    tri_count_bad(mesh, options, report, executor, remain);
    summary_remaining(console, remain, options, report);
}

void summary_remaining(const struct console *console, const int64_t count[TRI_EXCUSES],
                       const struct tri_quality *options, const struct tri_refine_report *report)
{
    int64_t n = sum_of(count);
    if (n == 0)
        console_say(console, "All triangles keep the bounds%s.\n", options->conforming ? " on angles and sizes" : "");
    else
        console_say(console, "%" PRId64 " triangle%s below the bounds:", n, n == 1 ? " stays" : "s stay");
    say_reasons(console, count, options, report);
}

/* --- Statistics */

void summary_counts(const struct console *console, const struct tri_switches *switches, const struct tri_pslg *pslg,
                    int32_t n_input_triangles, const struct tri_counts *counts)
{
    console_say(console, "\nStatistics:\n\n  Input vertices: %" PRId32 "\n", pslg->n_points);
    if (switches->mesh)
        console_say(console, "  Input triangles: %" PRId32 "\n", n_input_triangles);
    if (switches->segments)
        console_say(console, "  Input segments: %" PRId32 "\n", pslg->n_segments);
    if (switches->segments && !switches->mesh)
        console_say(console, "  Input holes: %" PRId32 "\n", pslg->n_holes);
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
        printf("  %6.6g - %-10.6g:%10" PRId64 "    | %6.6g - %-11s:%10" PRId64 "\n",
                       tri_aspect_limits[k], tri_aspect_limits[k + 1], shapes->aspects[k], tri_aspect_limits[k + ROWS],
                       beyond, shapes->aspects[k + ROWS]);
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
        printf("    %3d - %3d degrees:%10" PRId64 "    |    %3d - %3d degrees:%10" PRId64 "\n",
                       10 * k, 10 * k + 10, shapes->angles[k], 10 * (k + ROWS), 10 * (k + ROWS) + 10,
                       shapes->angles[k + ROWS]);
    printf("\n");
}

static int64_t bytes_of(const struct tri_mesh *mesh)
{
    int64_t a_vertex = (int64_t)sizeof *mesh->xy + 8 + 8 * (int64_t)mesh->n_attributes;
    return mesh->vertex_capacity * a_vertex + (int64_t)mesh->triangle_capacity * (int64_t)sizeof *mesh->tri +
           (int64_t)mesh->sub_capacity * (int64_t)sizeof *mesh->sub +
           (int64_t)mesh->parent_capacity * (int64_t)sizeof *mesh->parents;
}

void summary_shapes(const struct tri_mesh *mesh, const struct tri_report *report, const struct tri_executor *executor)
{
    struct tri_shapes shapes;
    tri_measure_shapes(&shapes, mesh, executor);
    printf("Mesh quality statistics:\n\n");
    printf("  Smallest area: %16.5g   |  Largest area: %16.5g\n", shapes.smallest_area,
                   shapes.largest_area);
    printf("  Shortest edge: %16.5g   |  Longest edge: %16.5g\n", shapes.shortest_edge,
                   shapes.longest_edge);
    printf("  Shortest altitude: %12.5g   |  Largest aspect ratio: %8.5g\n\n",
                   shapes.shortest_altitude, shapes.largest_aspect);
    print_aspects(&shapes);
    print_angles(&shapes);
    printf("Memory allocation statistics:\n\n  Maximum number of vertices: %" PRId32 "\n",
                   mesh->n_vertices);
    printf("  Maximum number of triangles: %" PRId32 "\n", mesh->n_triangles);
    printf("  Maximum number of subsegments: %" PRId32 "\n", mesh->n_subs);
    printf("  Approximate heap memory use (bytes): %" PRId64 "\n\n", bytes_of(mesh));
    printf("Algorithmic statistics:\n\n  Vertices at crossings of segments: %" PRId32 "\n",
                   report->constrain.crossings);
    printf("  Vertices put on segments: %" PRId64 "\n", report->quality.inserted_on_segments);
    printf("  Vertices put into triangles: %" PRId64 "\n\n", report->quality.inserted_free);
}
