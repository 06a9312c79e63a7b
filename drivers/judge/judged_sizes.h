/* Compares the edges of a mesh with the lengths that size options request. */
#ifndef DRIVERS_JUDGE_JUDGED_SIZES_H
#define DRIVERS_JUDGE_JUDGED_SIZES_H

#include "drivers/judge/judged_files.h"
#include "drivers/mesh/size_options.h"

#define JUDGED_SHORTEST 0.7 /* an edge fits if its length divided by the wanted length lies between these */
#define JUDGED_LONGEST 1.4

struct judged_sizes {
    int64_t n_edges;   /* edges of the mesh */
    int64_t n_fitting; /* edges that fit. The wanted length is that at the edge's midpoint */
    double number;     /* triangles, divided by the integral of 1 / (sqrt(3)/4 h^2) over the mesh */
    double quality;    /* mean of 4 sqrt(3) area / sum of squared edges; 1: all triangles are equilateral */
    char note[SIZE_OPTIONS_TEXT]; /* warning for the user, as of tri_lengths_note; "": none */
};

/* Measures a mesh whose corners are vertices. The lengths follow from files->input, whose holes and hull are treated as
 * `check` says. Needs 16 bytes a vertex and 48 a triangle. TRI_BAD_INPUT: no triangles, or no length is requested in
 * this input; TRI_TOO_LARGE: 2^31 vertices or sides of triangles; errors of files, lengths and memory. */
enum tri_status judged_sizes_measure(struct judged_sizes *sizes, const struct size_options *options,
                                     const struct judged_files *files, const struct tri_check_options *check,
                                     const struct tri_executor *executor, struct tri_error *error);

/* Returns the share of edges that fit. */
static inline double judged_sizes_fitting(const struct judged_sizes *sizes)
{
    return (double)sizes->n_fitting / (double)sizes->n_edges;
}

#endif
