/* Measures the time of a call of triangulate(), ours or that of another library: the same input repeatedly. A shared
 * library, for bench/peers/small_calls.py. */
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "triangle.h"

typedef void triangulate_function(char *, struct triangulateio *, struct triangulateio *, struct triangulateio *);

static void ours(char *switches, struct triangulateio *in, struct triangulateio *out, struct triangulateio *voronoi)
{
    triangulate(switches, in, out, voronoi);
}

static double processor_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void free_all(struct triangulateio *io)
{
    free(io->pointlist);
    free(io->pointattributelist);
    free(io->pointmarkerlist);
    free(io->trianglelist);
    free(io->triangleattributelist);
    free(io->segmentlist);
    free(io->segmentmarkerlist);
}

/* Processor seconds of one call including freeing its output, averaged over calls for the given seconds. *n_triangles
 * receives the number of triangles. other: triangulate() of another library; NULL: ours. */
double seconds_of_call(triangulate_function *other, const char *switches, struct triangulateio *in, double seconds,
                       int *n_triangles)
{
    triangulate_function *function = other ? other : ours;
    const double start = processor_seconds();
    double now = start;
    long n = 0;
    for (; now - start < seconds; n++, now = processor_seconds()) {
        struct triangulateio out, voronoi;
        char copy[64]; /* Triangle requires a writable string */
        memset(&out, 0, sizeof out);
        memset(&voronoi, 0, sizeof voronoi);
        strncpy(copy, switches, sizeof copy - 1);
        copy[sizeof copy - 1] = '\0';
        function(copy, in, &out, &voronoi);
        *n_triangles = out.numberoftriangles;
        free_all(&out);
    }
    return (now - start) / (double)n;
}
