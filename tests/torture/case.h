/* A case: a figure, and the options for meshing it. */
#ifndef TESTS_TORTURE_CASE_H
#define TESTS_TORTURE_CASE_H

#include <stdio.h>

#include "tests/torture/families.h"
#include "triangle/dropin/switches.h"

struct torture_case {
    uint64_t seed;
    const char *family;    /* name of the family, or of the input file */
    struct figure figure;
    char switches[128];    /* as on the command line, without a dash */
    int32_t block;         /* 0: sequential; otherwise triangles per cell of the schedule, on 1 and on 3 threads */
    bool again;            /* true: the mesh is refined once more, like -r, with half the area bound */
    bool with_size_test;   /* true: switch u; no edge is longer than a fraction of the distance from a corner */
};

/* The range from which cases are drawn. */
struct torture_range {
    const struct family **families; /* [n_families] */
    int32_t n_families;
    bool only_triangulate; /* true: only -p and -pc */
};

/* Draws a case. The same seed and range give the same case. */
struct torture_case case_draw(uint64_t seed, const struct torture_range *range);
void case_free(struct torture_case *c);

/* Do the case's switches request refinement? */
bool case_is_refined(const struct torture_case *c);

/* Writes the command that runs the case with the programs; [n] characters. */
void case_command(const struct torture_case *c, const char *file, char *text, size_t n);

/* Writes the figure as a .poly file, headed by comments. */
bool case_write(const struct torture_case *c, const char *path, const char *fault);

/* Reads a figure from a .poly or .node file. Returns false if it cannot be read, after printing the reason to standard
   error. */
bool case_read(struct torture_case *c, const char *path);

#endif
