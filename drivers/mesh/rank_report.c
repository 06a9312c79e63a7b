#include "drivers/mesh/rank_report.h"

#include <stdlib.h>

#include "triangle/base/system.h"


static int64_t nanoseconds(double seconds) { return (int64_t)(1e9 * seconds); }

static double block_seconds(const struct par_report *schedule)
{
    double sum = 0;
    for (int32_t i = 0; i < schedule->n_blocks; i++)
        sum += schedule->blocks[i].seconds;
    return sum;
}

enum tri_status rank_report_gather(struct rank_report *report, struct par_carrier *carrier,
                                   const struct par_report *schedule, enum tri_status status, struct tri_error *error)
{
    int64_t mine[RANK_NUMBERS] = {[RANK_THREADS] = schedule->threads,
                                  [RANK_PEAK_MEMORY] = tri_memory_peak(),
                                  [RANK_NS_PROCESSOR] = nanoseconds(tri_process_seconds()),
                                  [RANK_NS_BLOCKS] = nanoseconds(block_seconds(schedule)),
                                  [RANK_NS_WAITING] = nanoseconds(carrier->seconds_waiting),
                                  [RANK_NS_MOVING] = nanoseconds(carrier->seconds_moving)};
    for (int k = 0; k < PAR_MOVES; k++) {
        mine[RANK_BYTES + k] = carrier->traffic[k].bytes;
        mine[RANK_MESSAGES + k] = carrier->traffic[k].messages;
    }
    report->number = malloc((size_t)carrier->n_ranks * sizeof *report->number);
    if (!status && !report->number)
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the report of all ranks");
    status = par_gather(carrier, mine, RANK_NUMBERS, report->number ? report->number[0] : NULL, status, error);
    report->n_ranks = status ? 0 : carrier->n_ranks;
    return status;
}
