/* Graham's list scheduling of measured seconds. */
#include "drivers/mesh/prediction.h"

#include <stdlib.h>

static int32_t end_of_phase(const struct par_block_report *blocks, int32_t n_blocks, int32_t first)
{
    int32_t end = first + 1;
    while (end < n_blocks && blocks[end].schedule == blocks[first].schedule &&
           blocks[end].round == blocks[first].round && blocks[end].phase == blocks[first].phase)
        end++;
    return end;
}

static int largest_first(const void *left, const void *right)
{
    const double *a = left, *b = right;
    return (*a < *b) - (*a > *b);
}

double prediction_makespan(double *seconds, int32_t n, double *load, int threads)
{
    double longest = 0;
    qsort(seconds, (size_t)n, sizeof *seconds, largest_first);
    for (int k = 0; k < threads; k++)
        load[k] = 0;
    for (int32_t i = 0; i < n; i++) {
        int free_first = 0;
        for (int k = 1; k < threads; k++)
            free_first = load[k] < load[free_first] ? k : free_first;
        load[free_first] += seconds[i];
        longest = load[free_first] > longest ? load[free_first] : longest;
    }
    return longest;
}

double prediction_refine(const struct par_block_report *blocks, int32_t n_blocks, int first_round, int threads)
{
    double *seconds = malloc(((size_t)n_blocks + 1) * sizeof *seconds), *load = malloc((size_t)threads * sizeof *load);
    double sum = seconds && load ? 0 : -1;
    for (int32_t first = 0, end; sum >= 0 && first < n_blocks; first = end) {
        end = end_of_phase(blocks, n_blocks, first);
        for (int32_t i = first; i < end; i++)
            seconds[i - first] = blocks[i].seconds;
        if (blocks[first].round >= first_round)
            sum += prediction_makespan(seconds, end - first, load, threads);
    }
    free(seconds);
    free(load);
    return sum;
}

double prediction_sequential(const struct par_report *report)
{
    double rest = report->seconds_total - report->seconds_refine - report->seconds_number;
    for (int k = 0; k < PAR_SHARINGS; k++)
        rest -= report->seconds_shared[k];
    return rest > 0 ? rest : 0;
}

double prediction_shared(const struct par_report *report, int threads)
{
    double sum = 0;
    for (int k = 0; k < PAR_SHARINGS; k++) {
        int shares = 1 << k, had = report->threads < shares ? report->threads : shares;
        sum += report->seconds_shared[k] * had / (threads < shares ? threads : shares);
    }
    return sum;
}

double prediction_number(const struct par_report *report, int threads)
{
    int had = report->threads < TRI_MOST_SHARES ? report->threads : TRI_MOST_SHARES;
    int have = threads < TRI_MOST_SHARES ? threads : TRI_MOST_SHARES;
    return report->seconds_number * had / have;
}

static double percent(const struct par_report *report, double seconds)
{
    double merged = report->seconds_total - report->seconds_number;
    return report->levels == 0 || !(merged > 0) || seconds < 0 ? 0 : 100 * seconds / merged;
}

double prediction_overhead(const struct par_report *report)
{
    return percent(report, report->seconds_total - report->seconds_number - report->seconds_prerefine -
                               report->seconds_refine);
}

double prediction_numbering(const struct par_report *report) { return percent(report, report->seconds_number); }
