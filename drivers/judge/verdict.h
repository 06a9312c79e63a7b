/* What a report says, in lines or in JSON, on standard output. */
#ifndef DRIVERS_JUDGE_VERDICT_H
#define DRIVERS_JUDGE_VERDICT_H

#include "drivers/judge/judged_files.h"
#include "triangle/check/check.h"

struct verdict_style {
    const char *base;  /* name of the mesh */
    double min_angle;  /* the bound; 0: none */
    bool quiet;        /* faults only; of lines */
};

void verdict_print_lines(const struct verdict_style *style, const struct judged_files *files,
                         const struct tri_check_report *report);
void verdict_print_json(const struct verdict_style *style, const struct judged_files *files,
                        const struct tri_check_report *report);

#endif
