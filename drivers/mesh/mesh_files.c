/* The list of output files and the order in which they are written. */
#include "drivers/mesh/mesh_files.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drivers/interrupt.h"
#include "drivers/mesh/stages.h"
#include "drivers/mesh/streams.h"
#include "triangle/text/names.h"

enum plan { NOT_ASKED, SUPPRESSED, WRITTEN };

/* --- the table of files, in the order in which they are written */

enum { NODE, ELE, POLY, OFF, EDGE, V_NODE, V_EDGE, NEIGH, N_KINDS };

static const struct kind {
    const char *suffix, *article;
    tri_write_call *write;
    bool of_voronoi; /* the .v.* files describe the Voronoi diagram */
} kinds[N_KINDS] = {
    {".node", "a", tri_write_node, false},   {".ele", "an", tri_write_ele, false},
    {".poly", "a", tri_write_poly, false},   {".off", "an", tri_write_off, false},
    {".edge", "an", tri_write_edge, false},  {".v.node", "a", tri_write_node, true},
    {".v.edge", "a", tri_write_v_edge, true}, {".neigh", "a", tri_write_neigh, false},
};

static enum plan asked(bool by_switch, bool suppressed)
{
    return !by_switch ? NOT_ASKED : suppressed ? SUPPRESSED : WRITTEN;
}

/* Prints no line about missing files if only other formats are written. */
static enum plan plan_of(const struct run *run, int kind)
{
    const struct tri_switches *s = &run->arguments->switches;
    const bool any = !long_options_exports_alone(run->settings.options);
    switch (kind) {
    case NODE: return asked(any, s->no_node || (s->no_iteration && !run->input.points_in_poly));
    case ELE: return asked(any, s->no_ele);
    case POLY: return asked(any && tri_switches_show_segments(s), s->no_poly || s->no_iteration);
    case OFF: return asked(any && s->off, false);
    case EDGE: return asked(any && s->edges, false);
    case NEIGH: return asked(any && s->neighbors, false);
    default: return asked(any && s->voronoi, false);
    }
}

bool mesh_files_has(const struct run *run, const char *suffix)
{
    for (int k = 0; k < N_KINDS; k++)
        if (strcmp(kinds[k].suffix, suffix) == 0)
            return plan_of(run, k) == WRITTEN;
    return false;
}

/* --- names of files in other formats */

/* Returns the number of files, and the name of one, malloc'ed: "mesh.msh", or "mesh_1.msh" and so on as in Gmsh. NULL:
 * no memory. */
static int files_of(const struct export *export) { return export->n_parts > 0 ? export->n_parts : 1; }

static char *name_of(const struct export *export, const char *name, int file)
{
    const size_t room = strlen(name) + 16;
    const int stem = (int)(strlen(name) - strlen(export->format->suffix));
    char *text = malloc(room);
    if (text && export->n_parts == 0)
        snprintf(text, room, "%s", name);
    else if (text)
        snprintf(text, room, "%.*s_%d%s", stem, name, file + 1, name + stem);
    return text;
}

/* --- all together */

/* Adds a file to a trial set. */
static enum tri_status try_file(struct tri_output_set *set, const char *path, const struct file_names *read,
                                struct tri_error *error)
{
    struct tri_output *output;
    for (int i = 0; i < read->n; i++)
        if (tri_is_same_file(path, read->name[i]))
            return tri_fail(error, TRI_CANNOT_WRITE, path, 0, "would be overwritten, a file of the input");
    return interrupt_open(set, path, &output, error);
}

/* name: malloc'ed, freed here; NULL: no memory. */
static enum tri_status try_name(struct tri_output_set *set, char *name, const struct file_names *read,
                                struct tri_error *error)
{
    enum tri_status status = name ? try_file(set, name, read, error)
                                  : tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for file names");
    free(name);
    return status;
}

static enum tri_status try_export(struct tri_output_set *set, const struct long_options *o, const char *path,
                                  const struct file_names *read, struct tri_error *error)
{
    const struct export export = export_of(path, o->n_parts);
    enum tri_status status = TRI_OK;
    for (int i = 0; i < files_of(&export) && !status; i++)
        status = try_name(set, name_of(&export, path, i), read, error);
    return status;
}

static enum tri_status try_all(struct tri_output_set *set, const struct run *run, const struct file_names *read,
                               struct tri_error *error)
{
    const struct long_options *o = run->settings.options;
    enum tri_status status = TRI_OK;
    for (int k = 0; k < N_KINDS && !status; k++)
        if (plan_of(run, k) == WRITTEN)
            status = try_name(set, tri_joined(run->arguments->output, kinds[k].suffix), read, error);
    for (int i = 0; i < o->n_exports && !status; i++)
        status = try_export(set, o, o->exports[i], read, error);
    for (int i = 0; i < o->n_streams && !status; i++) {
        status = try_file(set, o->streams[i], read, error);
        status = status ? status : try_name(set, stream_xdmf(o->streams[i]), read, error);
    }
    if (!status && o->report && !long_options_report_is_printed(o))
        status = try_file(set, o->report, read, error);
    return status || !o->blocks ? status : try_file(set, o->blocks, read, error);
}

enum tri_status mesh_files_check(const struct run *run, const struct file_names *read)
{
    static struct tri_output_set set; /* static because it is large, and because handlers know its names until
                                         interrupt_drop */
    interrupt_begin(&set);
    set.trial = true;
    enum tri_status status = try_all(&set, run, read, run->error);
    interrupt_drop(&set);
    return status;
}

static enum tri_status write_file(const struct run *run, const struct tri_grid *grid, const struct kind *kind)
{
    const struct arguments *arguments = run->arguments;
    char *path = tri_joined(arguments->output, kind->suffix);
    if (!path)
        return tri_fail(run->error, TRI_NO_MEMORY, NULL, 0, "out of memory for file names");
    console_say(&run->console, "Writing %s.\n", path);
    struct tri_output *output;
    const struct tri_grid voronoi = tri_grid_voronoi(grid);
    enum tri_status status = interrupt_open(run->outputs, path, &output, run->error);
    free(path);
    if (!status)
        status = kind->write(output, kind->of_voronoi ? &voronoi : grid, run->settings.executor, run->error);
    return status ? status : tri_write_comment(output, arguments->argc, arguments->argv, run->error);
}

/* Writes in the format of another program, which may have no comments. */
static enum tri_status write_export(const struct run *run, const struct tri_grid *grid, const char *path)
{
    struct export export = export_of(path, run->settings.options->n_parts);
    char *first = name_of(&export, path, 0), *last = name_of(&export, path, files_of(&export) - 1);
    if (first && last)
        console_say(&run->console, "Writing %s%s%s.\n", first, export.n_parts > 1 ? " to " : "",
                    export.n_parts > 1 ? last : "");
    free(first);
    free(last);
    enum tri_status status = export_open(&export, path, run->outputs, run->error);
    return status ? status : export_write(&export, grid, run->settings.executor, run->error);
}

static enum tri_status write_own(const struct run *run, const struct tri_grid *grid)
{
    enum tri_status status = TRI_OK;
    for (int k = 0; k < N_KINDS && !status; k++) {
        enum plan plan = plan_of(run, k);
        if (plan == SUPPRESSED)
            console_say(&run->console, "NOT writing %s %s file.\n", kinds[k].article, kinds[k].suffix);
        status = plan == WRITTEN ? write_file(run, grid, &kinds[k]) : TRI_OK;
    }
    return status;
}

static enum tri_status write_exports(const struct run *run, const struct tri_grid *grid)
{
    const struct long_options *o = run->settings.options;
    enum tri_status status = TRI_OK;
    for (int i = 0; i < o->n_exports && !status; i++)
        status = write_export(run, grid, o->exports[i]);
    return status;
}

struct tri_grid_options mesh_files_grid(const struct run *run, bool for_solvers)
{
    const struct tri_switches *s = &run->arguments->switches;
    struct tri_grid_options options = tri_switches_grid(s, &run->mesh, &run->input.pslg, &run->input.elements);
    options.is_edge = s->segments ? run->is_edge : NULL;
    options.base = run->input.base;
    options.jettison = options.jettison || (for_solvers && run->unused.n != 0);
    return options;
}

/* Writes Triangle's files, exports, or both from one grid. With exports, unused points are left out. */
static enum tri_status write_from_grid(const struct run *run, bool own, bool exports)
{
    const struct tri_grid_options options = mesh_files_grid(run, exports);
    struct tri_grid grid;
    enum tri_status status = tri_grid_make(&grid, &options, run->error);
    status = status || !own ? status : write_own(run, &grid);
    status = status || !exports ? status : write_exports(run, &grid);
    tri_grid_free(&grid);
    return status;
}

enum tri_status mesh_files_write(const struct run *run)
{
    const bool exports = run->settings.options->n_exports > 0;
    if (!exports || run->unused.n == 0)
        return write_from_grid(run, true, exports);
    enum tri_status status = write_from_grid(run, true, false);
    return status ? status : write_from_grid(run, false, true);
}

/* --- other formats */

struct export export_of(const char *name, int n_parts)
{
    const struct tri_format *format = tri_format_of(name);
    return (struct export){.format = format, .n_parts = format->write_parts ? n_parts : 0};
}

enum tri_status mesh_files_open(struct tri_output_set *set, char *name, struct tri_output **output,
                                struct tri_error *error)
{
    enum tri_status status = name ? interrupt_open(set, name, output, error)
                                  : tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for file names");
    free(name);
    return status;
}

enum tri_status export_open(struct export *export, const char *name, struct tri_output_set *set,
                            struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    for (int i = 0; i < files_of(export) && !status; i++)
        status = mesh_files_open(set, name_of(export, name, i), &export->output[i], error);
    return status;
}

enum tri_status export_write(const struct export *export, const struct tri_grid *grid,
                             const struct tri_executor *executor, struct tri_error *error)
{
    if (export->n_parts > 0)
        return export->format->write_parts(export->output, export->n_parts, grid, executor, error);
    return export->format->write(export->output[0], grid, executor, error);
}
