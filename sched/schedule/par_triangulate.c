/* triangulate() of libptriangle.a: like that of libtriangle.a, but it refines on several threads.
 *
 * This file defines the same functions as triangle/dropin/triangulate.c, and no others. */
#include "triangle/dropin/triangle.h"

#include "sched/schedule/schedule.h"
#include "sched/schedule/threads.h"
#include "triangle/dropin/call.h"

/* Refines the mesh by the parallel schedule. user: the caller's struct triangulate_options, or NULL. */
static enum tri_status refine(void *user, struct tri_mesh *mesh, const struct tri_quality *quality,
                              struct tri_refine_report *report, struct tri_error *error)
{
    const struct triangulate_options *options = user;
    struct par_options how = par_defaults();
    struct par_report schedule;
    how.threads = options->threads > 0 ? options->threads : 0;
    how.size_test_in_parallel = options->unsuitable_in_parallel != 0;
    enum tri_status status = par_refine(mesh, quality, &how, &schedule, error);
    *report = schedule.total;
    par_report_free(&schedule);
    return status;
}

/* Makes the call with a team that exists only during it. aloud: prints one line if the call fails. */
static int run(const char *switches, const struct triangulateio *in, struct triangulateio *out,
               struct triangulateio *vorout, const struct triangulate_options *options, bool aloud)
{
    struct par_team team = {.threads = par_threads(options ? options->threads : 0, false)};
    const struct tri_executor executor = par_executor(&team);
    const int code = tri_io_triangulate(switches, in, out, vorout, options, aloud, refine, &executor);
    par_team_end(&team);
    return code;
}

int triangulate_with(const char *switches, const struct triangulateio *in, struct triangulateio *out,
                     struct triangulateio *vorout, const struct triangulate_options *options)
{
    return run(switches, in, out, vorout, options, false);
}

int triangulate(const char *switches, struct triangulateio *in, struct triangulateio *out,
                struct triangulateio *vorout)
{
    return run(switches, in, out, vorout, NULL, true);
}
