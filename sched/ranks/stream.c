/* From arrays to tiles, on all ranks at once. */
#include "sched/ranks/stream.h"

#include "sched/schedule.h"
#include "sched/threads.h"
#include "triangle/api/mesh.h"

struct streaming {
    struct par_carrier *carrier;
    const struct tri_sink *sink;
};

static enum tri_status refine(const struct tri_api_way *way, struct tri_mesh *mesh,
                              const struct tri_refine_options *quality, const struct tri_settings *settings,
                              struct tri_refine_report *report, struct tri_error *error)
{
    const struct streaming *streaming = way->user;
    struct par_options how = par_defaults();
    struct par_report schedule;
    how.threads = settings->threads > 0 ? settings->threads : 0;
    how.size_test_in_parallel = settings->callbacks_in_parallel;
    how.sink = streaming->sink;
    how.figure = way->figure;
    how.region_column = way->has_attributes;
    how.carrier = streaming->carrier;
    enum tri_status status = par_refine(mesh, quality, &how, &schedule, error);
    *report = schedule.total;
    par_report_free(&schedule);
    return status;
}

enum tri_status par_stream_over(struct par_carrier *carrier, const struct tri_figure *figure,
                                const struct tri_settings *settings, const struct tri_sink *sink,
                                struct tri_error *error)
{
    struct streaming streaming = {carrier, sink};
    struct tri_settings own;
    enum tri_status status = tri_api_settings_take(&own, settings, error);
    if (!status) {
        int threads = par_threads(own.threads, false);
        const struct tri_executor executor = par_executor(&threads);
        const struct tri_api_way way = {.refine = refine, .executor = &executor, .user = &streaming};
        status = tri_api_mesh_stream(figure, &own, &way, error);
    }
    return par_agree(carrier, status, error);
}
