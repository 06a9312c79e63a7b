/* Runs a case and judges what comes out of it.
 *
 * What the judges let pass, and why:
 *   - angles below the bound that the checker explains by a small angle of the input; beside gaps too dear to fill, and
 *     where vertices ran away, as many as the mesher counts. The latter, outside narrow spaces: none up to 20.7 degrees
 *     (Ruppert 1995 promises them), 20 up to 25, which theory promises for another order of insertion (Chew 1993,
 *     Shewchuk 2002), and above, where nothing is proved, 2% of the triangles more; a third of them where their
 *     points would have cost too much (credit.h);
 *   - angles and circles at the resolution of coordinates, told one by one: a flat triangle, a subsegment beside one
 *     (judge_bounds.c); and ten angles around each flat triangle, from behind which their points would be seen;
 *   - areas: none, but of triangles thinner than that resolution, and with -Y;
 *   - the number of triangles: 2.5 times that at 34 degrees for any bound above, which is proved (refine.c), 5 times
 *     with sizes or -D, which is measured; up to 34, 20 times that at 28 and 3,000
 *     (credit.h, and as much again for what theory promises then); by the schedule, see judge_schedule_size;
 *   - the number of triangles of a mesh that is refined once more with the same bounds, up to 28 degrees and without
 *     -Y: 1.2 times as many, with -D twice, and 1,000; where vertices ran away, or spaces are filled that were left,
 *     once more than that, see judge_amount_again;
 *   - meshes of more than 300,000 points that their figures do ask for: these are made with that limit.
 * A case that inserts more than its figure can ask for is endless, however long that takes; the limit on time is for
 * those that go on without a point. */
#ifndef TESTS_TORTURE_JUDGE_H
#define TESTS_TORTURE_JUDGE_H

#include "tests/torture/case.h"

/* Written as the case runs, so that a reader in another process can tell how far a crash came. */
struct verdict {
    char stage[48];   /* what was going on last */
    char fault[48];   /* the first fault's kind; "": none */
    char detail[320]; /* its first instance, in words */
    int64_t triangles;
    bool done;
};

/* Runs the case; the verdict holds the first fault, if any. */
void judge_case(const struct torture_case *c, struct verdict *verdict);

/* Is the kind of fault one of these names, which have commas between them? NULL: no. */
bool judge_names(const char *names, const char *fault);

/* --- for the files judge_*.c */

/* A mesh and all that is known of it. */
struct outcome {
    const struct torture_case *of;
    struct tri_switches switches;
    struct tri_options options;
    struct tri_mesh mesh;
    struct tri_report report;
};

#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
void judge_fault(struct verdict *verdict, const char *fault, const char *format, ...);

/* What was carved and which regions spread where, against a naive twin. */
void judge_carving(const struct outcome *outcome, struct verdict *verdict);

/* A mesh that is not conforming Delaunay although that was asked for, with so many faults of a kind (enum
 * tri_check_kind). */
void judge_conforming(const struct outcome *outcome, int kind, int64_t faults, struct verdict *verdict);

/* Angles and areas that miss their bounds without a reason, points that a switch forbids. */
void judge_bounds(const struct outcome *outcome, const struct tri_check_report *report, struct verdict *verdict);

#endif
