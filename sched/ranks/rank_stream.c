/* From arrays to tiles, on all ranks at once. */
#include "sched/ranks/rank_stream.h"

#include "sched/schedule/library.h"
#include "sched/schedule/schedule.h"
#include "sched/schedule/threads.h"

enum tri_status par_stream_over(struct par_carrier *carrier, const struct tri_figure *figure,
                                const struct tri_settings *settings, const struct tri_sink *sink,
                                struct tri_error *error)
{
    struct par_options how = par_defaults();
    how.carrier = carrier;
    how.sink = sink;
    struct tri_settings own;
    enum tri_status status = tri_api_settings_take(&own, settings, error);
    if (!status && !(sink && sink->take))
        status = tri_fail(error, TRI_BAD_INPUT, NULL, 0, "a stream needs a sink that takes");
    if (!status) {
        int threads = par_threads(own.threads, false);
        const struct tri_executor executor = par_executor(&threads);
        const struct tri_api_way way = {.refine = par_refine_as, .executor = &executor, .user = &how};
        status = tri_api_mesh_stream(figure, &own, &way, error);
    }
    return par_agree(carrier, status, error);
}
