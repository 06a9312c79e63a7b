/* The functions of ptriangle/par.h. */
#include "ptriangle/par.h"

#include "sched/mesh.h"
#include "sched/schedule.h"
#include "sched/threads.h"

enum tri_status par_refine_as(const struct tri_api_way *way, struct tri_mesh *mesh,
                              const struct tri_refine_options *quality, const struct tri_settings *settings,
                              struct tri_refine_report *report, struct tri_error *error)
{
    struct par_options how = *(const struct par_options *)way->user;
    struct par_report schedule;
    how.threads = settings->threads > 0 ? settings->threads : 0;
    how.size_test_in_parallel = settings->callbacks_in_parallel;
    how.figure = way->figure;
    how.region_column = way->has_attributes;
    enum tri_status status = par_refine(mesh, quality, &how, &schedule, error);
    *report = schedule.total;
    par_report_free(&schedule);
    return status;
}

enum tri_status par_mesh_new(struct tri_mesh **mesh, const struct tri_figure *figure,
                             const struct tri_settings *settings, struct tri_error *error)
{
    struct tri_settings own;
    *mesh = NULL;
    enum tri_status status = tri_api_settings_take(&own, settings, error);
    if (status)
        return status;
    int threads = par_threads(own.threads, false);
    const struct tri_executor executor = par_executor(&threads);
    struct par_options how = par_defaults();
    how.by_block = own.numbered_by_block;
    const struct tri_api_way way = {.refine = par_refine_as, .executor = &executor, .user = &how};
    return tri_api_mesh_new(mesh, figure, &own, &way, error);
}

enum tri_status par_mesh_refine(struct tri_mesh *mesh, const struct tri_settings *settings, struct tri_error *error)
{
    struct tri_settings own;
    enum tri_status status = tri_api_settings_take(&own, settings, error);
    if (status)
        return status;
    int threads = par_threads(own.threads, false);
    const struct tri_executor executor = par_executor(&threads);
    struct par_options how = par_defaults();
    how.by_block = own.numbered_by_block;
    const struct tri_api_way way = {.refine = par_refine_as, .executor = &executor, .user = &how};
    return tri_api_mesh_refine(mesh, &own, &way, error);
}

enum tri_status par_mesh_stream(const struct tri_figure *figure, const struct tri_settings *settings, int64_t memory,
                                const char *scratch, const struct tri_sink *sink, struct tri_error *error)
{
    struct tri_settings own;
    if (memory < 0 || !sink || !sink->take)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "a stream needs a sink that takes, and a bound on memory >= 0");
    enum tri_status status = tri_api_settings_take(&own, settings, error);
    if (status)
        return status;
    int threads = par_threads(own.threads, false);
    const struct tri_executor executor = par_executor(&threads);
    struct par_options how = par_defaults();
    how.memory = memory;
    how.scratch = scratch;
    how.sink = sink;
    const struct tri_api_way way = {.refine = par_refine_as, .executor = &executor, .user = &how};
    return tri_api_mesh_stream(figure, &own, &way, error);
}
