/* Runs a case and judges what comes out of it.
 *
 * What the judges hold to is what README promises:
 *   - a right mesh, by the checker, and the same on 1 and 3 threads;
 *   - no area above its bound, but of triangles thinner than coordinates resolve;
 *   - angles below the bound are counted, and few but beside small angles of the input, in narrow spaces, at the
 *     resolution of coordinates, and with -Y; -D: vertices in circles are counted, and lie on subsegments up to
 *     rounding;
 *   - no run-away: 36 times the triangles at 28 degrees, 4 times those of one call in a schedule, 4 times as many when
 *     a mesh is refined again, and some.
 * Meshes of more than 300,000 points that their figures do ask for are made with that limit.
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

/* --- for the files judge*.c */

enum { PROMISED = 28 }; /* in degrees: up to here theory promises an end, where no segments meet at small angles */

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
