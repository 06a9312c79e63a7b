/* RULE. What is sure refuses, what is likely warns: areas ask for so many triangles beyond doubt, angles for about so
 * many. A mesh that fits stays in memory, which is quicker. */
#define _DEFAULT_SOURCE /* access */

#include "drivers/plan.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "drivers/resources.h"

/* A mesh in memory may take so much more than expected; less than the other is not worth looking for. */
static const double MARGIN = 1.15, WORTH_A_LOOK = 1e8;

double plan_memory_left(const struct run *run)
{
    double allowed = run->hooks->limits.memory, left = resources_memory();
    return allowed > 0 ? fmin(left, fmax(allowed - resources_memory_used(), 0)) : left;
}

/* --- what asks for the whole mesh */

static const char *by_switches(const struct tri_switches *s)
{
    const struct {
        bool given;
        const char *name;
    } asks[] = {
        {s->edges, "-e (edges)"},           {s->voronoi, "-v (Voronoi diagram)"},
        {s->neighbors, "-n (neighbours)"},  {s->off, "-g (.off)"},
        {s->second_order, "-o2"},           {s->jettison, "-j"},
        {s->check, "-C (self check)"},      {s->max_steiner >= 0, "-S"},
        {s->verbosity > 0, "-V (shapes)"},
    };
    for (size_t i = 0; i < sizeof asks / sizeof *asks; i++)
        if (asks[i].given)
            return asks[i].name;
    return NULL;
}

const char *plan_obstacle(const struct run *run)
{
    const struct run_hooks *hooks = run->hooks;
    if (!hooks->swept_memory)
        return "";
    if (!run->options.refine)
        return "no bounds";
    if (run->n_loose > 0)
        return "segments that are no edges of the mesh";
    if (hooks->whole_mesh)
        return hooks->whole_mesh;
    return by_switches(&run->arguments->switches);
}

/* --- refusals and warnings */

static double millions(double triangles) { return fmin(1e-6 * triangles, 1e9); }

static enum tri_status fail_too_many(const struct estimate *e, const char *obstacle, struct tri_error *error)
{
    return tri_fail(error, TRI_TOO_LARGE, NULL, 0,
                    "the area bounds ask for at least %.0f million triangles, and a mesh holds %d million%s%s",
                    millions(e->least), TRI_MAX_TRIANGLES / 1000000,
                    *obstacle ? " where it must be in memory as a whole, as for " : "", obstacle);
}

static enum tri_status fail_memory(const struct estimate *e, double needed, double left, const char *obstacle,
                                   struct tri_error *error)
{
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0,
                    "the area bounds ask for at least %.3g million triangles, which take %.3g GB of memory; %.3g GB "
                    "are left%s%s", millions(e->least), 1e-9 * needed, 1e-9 * left,
                    *obstacle ? "; less would do but for " : "", obstacle);
}

static void warn_of_memory(const struct console *console, double needed, double left)
{
    if (needed > left)
        console_warn(console, "the bounds may take about %.3g GB of memory; %.3g GB are left.\n", 1e-9 * needed,
                     1e-9 * left);
}

static enum tri_status check_memory(const struct estimate *e, double left, const char *obstacle,
                                    const struct console *console, struct tri_error *error)
{
    if (e->least > TRI_MAX_TRIANGLES)
        return fail_too_many(e, obstacle, error);
    if (e->least_more > left)
        return fail_memory(e, e->least_more, left, obstacle, error);
    if (e->triangles > TRI_MAX_TRIANGLES)
        console_warn(console, "the bounds may ask for more triangles than the %d million that a mesh holds.\n",
                     TRI_MAX_TRIANGLES / 1000000);
    else
        warn_of_memory(console, e->more, left);
    return TRI_OK;
}

static enum tri_status check_sweep(const struct estimate *e, double left, const struct console *console,
                                   struct tri_error *error)
{
    if (e->least_swept > left)
        return fail_memory(e, e->least_swept, left, "", error);
    warn_of_memory(console, e->swept, left);
    return TRI_OK;
}

static enum tri_status check_disk(const struct run *run, const struct estimate *e, const struct console *console,
                                  struct tri_error *error)
{
    const char *output = run->arguments->output;
    double left = fmax(e->disk, e->least_disk) > WORTH_A_LOOK ? resources_disk(output) : HUGE_VAL;
    if (e->least_disk > left)
        return tri_fail(error, TRI_CANNOT_WRITE, output, 0,
                        "the area bounds ask for at least %.3g million triangles, whose files take %.3g GB; %.3g GB "
                        "are left on that disk", millions(e->least), 1e-9 * e->least_disk, 1e-9 * left);
    if (e->disk > left)
        console_warn(console, "the files may take about %.3g GB; %.3g GB are left on that disk.\n", 1e-9 * e->disk,
                     1e-9 * left);
    return TRI_OK;
}

/* A folder that was asked for is tried before the work, which may take hours until it is needed. */
static enum tri_status check_scratch(const char *folder, struct tri_error *error)
{
    if (folder && access(folder, W_OK | X_OK) != 0)
        return tri_fail(error, TRI_CANNOT_WRITE, folder, 0, "cannot park a mesh in this directory: %s",
                        strerror(errno));
    return TRI_OK;
}

/* --- all together */

static bool fits(const struct estimate *e, double left)
{
    return e->triangles <= TRI_MAX_TRIANGLES && e->least <= TRI_MAX_TRIANGLES && MARGIN * e->more <= left;
}

static void say_sweep(const struct console *console, const struct estimate *e)
{
    char whole[64] = "are too many for a mesh in memory";
    if (e->triangles <= TRI_MAX_TRIANGLES)
        snprintf(whole, sizeof whole, "would take %.3g GB of memory", 1e-9 * e->more);
    console_say(console, "Sweeping: about %.3g million triangles %s, a few columns of them %.3g GB.\n",
                millions(e->triangles), whole, 1e-9 * e->swept);
}

enum tri_status plan_make(struct run_plan *plan, const struct run *run, const struct estimate *e,
                          const struct console *console, struct tri_error *error)
{
    bool look = fmax(e->more, e->least_more) > WORTH_A_LOOK || run->hooks->limits.memory > 0;
    double left = look ? plan_memory_left(run) : HUGE_VAL;
    const char *obstacle = plan_obstacle(run);
    bool sweep = run->hooks->always_sweep || !fits(e, left);
    *plan = (struct run_plan){sweep && !obstacle, resources_memory_used() + left, e->triangles};
    enum tri_status status =
        plan->swept ? check_sweep(e, left, console, error) : check_memory(e, left, obstacle, console, error);
    status = status ? status : check_disk(run, e, console, error);
    if (!status && plan->swept)
        status = check_scratch(run->hooks->limits.scratch, error);
    if (!status && plan->swept)
        say_sweep(console, e);
    return status;
}

static void print_bytes(const char *what, double needed, double left)
{
    printf("  %s: %.0f MB", what, ceil(1e-6 * needed));
    if (left < HUGE_VAL)
        printf(" (%.0f MB left)", floor(1e-6 * left));
    putchar('\n');
}

void plan_print(const struct run *run, const struct estimate *e)
{
    int threads = run->hooks->threads > 1 ? run->hooks->threads : 1;
    double left = plan_memory_left(run), more = run->plan.swept ? e->swept : e->more;
    printf("\nEstimate:\n\n  Triangles: %.3g million\n  Vertices: %.3g million\n", 1e-6 * e->triangles,
           1e-6 * e->vertices);
    if (run->options.refine)
        printf("  Way: %s\n", run->plan.swept ? "swept, a few columns in memory at a time" : "all in memory");
    print_bytes("Memory", resources_memory_used() + more, left);
    print_bytes("Disk", e->disk, resources_disk(run->arguments->output));
    printf("  Time: %.2g s on %d thread%s\n", e->seconds, threads, threads > 1 ? "s" : "");
}
