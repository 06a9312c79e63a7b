/* The functions of ptriangle/par.h, and the part of ptriangle/mpi.h that does not need MPI: they run the parallel
 * schedule for the common functions in triangle/api/. */
#include "ptriangle/par.h"

#include "sched/ranks/carrier.h"
#include "sched/schedule/schedule.h"
#include "sched/schedule/threads.h"
#include "triangle/api/opaque_mesh.h"

/* A progress callback of the schedule: passes the number of triangles on to the hook of the library call. */
static void pass_progress(void *user, const struct par_place *place)
{
    const struct tri_refine_hooks *hooks = user;
    hooks->told(hooks->told_user, place->triangles);
}

/* The refine member of struct tri_api_way: calls par_refine with the options that way->user points to. The size test,
 * the figure and the region column are set from settings and way. */
static enum tri_status refine(const struct tri_api_way *way, struct tri_mesh *mesh, const struct tri_quality *quality,
                              const struct tri_refine_hooks *hooks, const struct tri_settings *settings,
                              struct tri_refine_report *report, struct tri_error *error)
{
    struct par_options how = *(const struct par_options *)way->user;
    struct par_report schedule;
    how.size_test_in_parallel = settings->callbacks_in_parallel;
    how.figure = way->figure;
    how.region_column = way->has_attributes;
    how.hooks = hooks;
    how.progress = hooks->told ? pass_progress : NULL;
    how.progress_user = (void *)hooks; /* pass_progress only reads them */
    enum tri_status status = par_refine(mesh, quality, &how, &schedule, error);
    *report = schedule.total;
    par_report_free(&schedule);
    return status;
}

/* The common part of a call of the functions below. */
struct call {
    struct tri_settings settings; /* a checked copy of the caller's settings */
    struct par_team team;         /* its threads, during the call */
    struct tri_executor executor; /* runs tasks on the team */
    struct par_options how;       /* options of the schedule */
    struct tri_api_way way;       /* by which triangle/api/ calls the schedule */
};

/* Checks the settings and sets up the team and the options; end_call ends the team. */
static enum tri_status begin_call(struct call *call, const struct tri_settings *settings, struct tri_error *error)
{
    enum tri_status status = tri_api_settings_take(&call->settings, settings, error);
    if (status)
        return status;
    call->team = (struct par_team){.threads = par_threads(call->settings.threads, false)};
    call->executor = par_executor(&call->team);
    call->how = par_defaults();
    call->how.team = &call->team;
    call->way = (struct tri_api_way){.refine = refine, .executor = &call->executor, .user = &call->how};
    return TRI_OK;
}

/* Ends the team's threads; returns status. */
static enum tri_status end_call(struct call *call, enum tri_status status)
{
    par_team_end(&call->team);
    return status;
}

enum tri_status par_mesh_new(struct tri_mesh **mesh, const struct tri_figure *figure,
                             const struct tri_settings *settings, struct tri_error *error)
{
    struct call call;
    enum tri_status status = begin_call(&call, settings, error);
    *mesh = NULL;
    if (status)
        return status;
    call.how.by_block = call.settings.numbered_by_block;
    return end_call(&call, tri_api_mesh_new(mesh, figure, &call.settings, &call.way, error));
}

enum tri_status par_mesh_refine(struct tri_mesh *mesh, const struct tri_settings *settings, struct tri_error *error)
{
    struct call call;
    enum tri_status status = begin_call(&call, settings, error);
    if (status)
        return status;
    call.how.by_block = call.settings.numbered_by_block;
    return end_call(&call, tri_api_mesh_refine(mesh, &call.settings, &call.way, error));
}

enum tri_status par_mesh_stream(const struct tri_figure *figure, const struct tri_settings *settings, int64_t memory,
                                const char *scratch, const struct tri_sink *sink, struct tri_error *error)
{
    struct call call;
    if (memory < 0 || !sink || !sink->take)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "a stream needs a sink with a take function, and memory >= 0");
    enum tri_status status = begin_call(&call, settings, error);
    if (status)
        return status;
    call.how.memory = memory;
    call.how.scratch = scratch;
    call.how.sink = sink;
    return end_call(&call, tri_api_mesh_stream(figure, &call.settings, &call.way, error));
}

enum tri_status par_stream_over(struct par_carrier *carrier, const struct tri_figure *figure,
                                const struct tri_settings *settings, const struct tri_sink *sink,
                                struct tri_error *error)
{
    struct call call;
    enum tri_status status = begin_call(&call, settings, error);
    if (!status && !(sink && sink->take))
        status = tri_fail(error, TRI_BAD_INPUT, NULL, 0, "a stream needs a sink with a take function");
    if (!status) {
        call.how.carrier = carrier;
        call.how.sink = sink;
        status = end_call(&call, tri_api_mesh_stream(figure, &call.settings, &call.way, error));
    }
    /* All ranks get the same status, also if only one of them failed. */
    return par_agree(carrier, status, error);
}
