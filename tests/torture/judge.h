/* Runs a case and checks the result.
 *
 * The checks follow the promises of the README:
 *   - the mesh is valid by the checker, and the same on 1 and 3 threads;
 *   - no area exceeds its bound, except in triangles thinner than the resolution of coordinates;
 *   - angles below the bound are counted. Few occur except beside small input angles, in narrow spaces, at the
 *     resolution of coordinates, and with -Y. With -D, vertices in circles are counted and lie on subsegments up to
 *     rounding;
 *   - no run-away: at most 36 times the triangles at 28 degrees, 4 times those of one call in a schedule, 4 times as
 *     many when a mesh is refined again, plus a constant.
 * Meshes whose figures request more than 300,000 points are made with that limit. A case that inserts more points than
 * its figure can request is endless, regardless of its time. The time limit applies to cases that continue without
 * inserting points. */
#ifndef TESTS_TORTURE_JUDGE_H
#define TESTS_TORTURE_JUDGE_H

#include "tests/torture/case.h"

/* Written while the case runs, so that another process can read where a crash happened. */
struct verdict {
    char stage[48];   /* current stage */
    char fault[48];   /* kind of the first fault; "": no fault */
    char detail[320]; /* description of its first instance */
    int64_t triangles;
    bool done;
};

/* Runs the case. The verdict holds the first fault, if any. */
void judge_case(const struct torture_case *c, struct verdict *verdict);

/* Is the kind of fault in this list of names, separated by commas? NULL: an empty list. */
bool judge_names(const char *names, const char *fault);

/* --- shared by the files judge*.c */

enum { PROMISED = 28 }; /* in degrees: up to this bound refinement ends by the theory, except where segments meet at
                           small angles */

/* A mesh and everything known about it. */
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

/* Compares carving and the spreading of regions with a naive implementation. */
void judge_carving(const struct outcome *outcome, struct verdict *verdict);

/* Checks a mesh that is not conforming Delaunay although that was requested, with the number of faults of each kind
 * (enum tri_check_kind). */
void judge_conforming(const struct outcome *outcome, int kind, int64_t faults, struct verdict *verdict);

/* Reports angles and areas that violate their bounds without a reason, and points that a switch forbids. */
void judge_bounds(const struct outcome *outcome, const struct tri_check_report *report, struct verdict *verdict);

#endif
