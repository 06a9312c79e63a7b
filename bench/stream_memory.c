/* Measures par_mesh_stream: a mesh within a memory bound, tile by tile. Each tile is counted, read and discarded.
 * Usage: stream FILE.poly MIN_ANGLE MAX_AREA BYTES [THREADS [SCRATCH]]; bytes 0: in memory */
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <time.h>

#include <ptriangle/files.h>
#include <ptriangle/par.h>

struct counts {
    int64_t points, triangles, segments;
    double estimate;
};

static enum tri_status begin(void *user, const struct tri_stream *stream, struct tri_error *error)
{
    (void)error;
    *(struct counts *)user = (struct counts){.estimate = stream->estimate};
    return TRI_OK;
}

static enum tri_status count_tile(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    struct counts *counts = user;
    (void)error;
    counts->points += tile->n_vertices;
    counts->triangles += tile->n_triangles;
    counts->segments += tile->n_segments;
    return TRI_OK;
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double seconds_of(struct timeval t) { return (double)t.tv_sec + 1e-6 * (double)t.tv_usec; }

int main(int argc, char **argv)
{
    struct tri_figure figure = tri_no_figure();
    struct tri_settings settings = tri_no_settings();
    struct tri_error error = {0};
    struct counts counts = {0};
    const struct tri_sink sink = {&counts, begin, count_tile, NULL};
    if (argc < 5)
        return 1;
    enum tri_status status = tri_file_read(argv[1], &figure, &error);
    settings.min_angle = atof(argv[2]);
    settings.max_area = atof(argv[3]);
    settings.threads = argc > 5 ? atoi(argv[5]) : 0;
    double began = now();
    if (!status)
        status = par_mesh_stream(&figure, &settings, atoll(argv[4]), argc > 6 ? argv[6] : NULL, &sink, &error);
    double wall = now() - began;
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    if (status)
        fprintf(stderr, "%s\n", error.text);
    printf("%lld triangles, %lld points, %lld segments, %.2f s, %.2f s user, %.2f s system, %ld MB\n",
           (long long)counts.triangles, (long long)counts.points, (long long)counts.segments, wall,
           seconds_of(usage.ru_utime), seconds_of(usage.ru_stime), usage.ru_maxrss * 1024 / 1000000);
    tri_file_free(&figure);
    return status != TRI_OK;
}
