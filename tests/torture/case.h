/* A case: a figure, and what is asked of the mesher. */
#ifndef TESTS_TORTURE_CASE_H
#define TESTS_TORTURE_CASE_H

#include <stdio.h>

#include "tests/torture/families.h"
#include "triangle/dropin/switches.h"

struct torture_case {
    uint64_t seed;
    const char *family;    /* or the name of a file */
    struct figure figure;
    char switches[128];    /* as on the command line, without dash */
    int32_t block;         /* 0: sequential refinement; else the schedule, with so many triangles in a cell, on 1 and on
                              3 threads */
    bool again;            /* the mesh is refined once more, as -r does, to half the area */
    bool with_size_test;   /* the switch u: no edge longer than a share of the distance from a corner */
};

/* What may be drawn. */
struct torture_range {
    const struct family **families; /* [n_families] */
    int32_t n_families;
    bool only_triangulate; /* -p and -pc alone */
};

/* The same seed and range give the same case. */
struct torture_case case_draw(uint64_t seed, const struct torture_range *range);
void case_free(struct torture_case *c);

/* Do its switches ask for points? */
bool case_is_refined(const struct torture_case *c);

/* How to run it with the programs; [n] characters. */
void case_command(const struct torture_case *c, const char *file, char *text, size_t n);

/* Writes the figure as a .poly file, headed by comments. */
bool case_write(const struct torture_case *c, const char *path, const char *fault);

/* Reads a figure from a .poly or .node file; false: it cannot be read, told on standard error. */
bool case_read(struct torture_case *c, const char *path);

#endif
