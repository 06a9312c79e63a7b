/* Runs the checker in memory and in parts. */
#include "both_ways.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static void assert_same_reports(const struct tri_check_report *a, const struct tri_check_report *b)
{
    for (int k = 0; k < TRI_N_CHECKS; k++) {
        const struct tri_check_item *p = &a->item[k], *q = &b->item[k];
        if (p->state != q->state || p->count != q->count || strcmp(p->text, q->text) != 0)
            fail_msg("%s: as a whole %d, %lld, \"%s\", in parts %d, %lld, \"%s\"",
                     tri_check_name((enum tri_check_kind)k), (int)p->state, (long long)p->count, p->text,
                     (int)q->state, (long long)q->count, q->text);
    }
    size_t rest = sizeof *a - offsetof(struct tri_check_report, n_used_points);
    assert_memory_equal(&a->n_used_points, &b->n_used_points, rest);
}

enum tri_status check_both_ways(const struct tri_check_mesh *mesh, const struct tri_pslg *input,
                              const struct tri_check_options *options, struct tri_check_report *report,
                              struct tri_error *error)
{
    enum { SMALL = 500 }; /* maximum number of triangles, since the comparison is slow */
    enum tri_status status = tri_check(mesh, input, options, report, error);
    struct tri_check_source source = tri_check_source_of(mesh);
    struct tri_check_report again;
    source.memory = 1;
    if (status == TRI_OK && mesh->n_triangles <= SMALL) {
        assert_int_equal(tri_check_from(&source, input, options, &again, error), TRI_OK);
        if (report->item[TRI_CHECK_EDGES].state == TRI_CHECK_FAILED) /* parts may report another kind */
            assert_false(tri_check_passed(&again));
        else
            assert_same_reports(report, &again);
    }
    return status;
}
