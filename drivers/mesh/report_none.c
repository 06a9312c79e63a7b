/* Replaces report_json.c if the library jansson was missing during the build. */
#include "drivers/mesh/report_json.h"

enum tri_status report_check(struct tri_error *error)
{
    return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--report: this program was built without the library jansson");
}

enum tri_status report_write(const struct run *run, const struct par_report *schedule, const struct rank_report *ranks)
{
    (void)schedule, (void)ranks;
    return report_check(run->error);
}
