/* Measures par_stream_on: resources that each rank uses, and data sent. Each rank counts its tiles and discards them.
 * Usage: mpirun -n N ranks FILE.poly MIN_ANGLE MAX_AREA [THREADS_A_RANK] */
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>

#include <ptriangle/files.h>
#include <ptriangle/mpi.h>

struct counts {
    int64_t points, triangles;
};

static enum tri_status count_tile(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    struct counts *counts = user;
    (void)error;
    counts->points += tile->n_vertices;
    counts->triangles += tile->n_triangles;
    return TRI_OK;
}

enum { SECONDS, SYSTEM, FAULTS, WAITS, MEGABYTES, MEASURES };

static double seconds_of(struct timeval time) { return (double)time.tv_sec + 1e-6 * (double)time.tv_usec; }

/* Resources that this process has used so far: processor time, its system part, page faults, waits, peak memory. */
static void read_usage(double taken[MEASURES])
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    taken[SYSTEM] = seconds_of(usage.ru_stime);
    taken[SECONDS] = seconds_of(usage.ru_utime) + taken[SYSTEM];
    taken[FAULTS] = (double)usage.ru_minflt;
    taken[WAITS] = (double)usage.ru_nvcsw;
    taken[MEGABYTES] = (double)usage.ru_maxrss / 1024;
}

/* Prints sums and maxima over the ranks, on rank 0. */
static void print(int rank, int n_ranks, double wall, const double mine[MEASURES], const struct counts *counts,
                  const struct par_exchanges *moved)
{
    double most[MEASURES], sum[MEASURES];
    int64_t number[2 + PAR_EXCHANGES] = {counts->triangles}, total[2 + PAR_EXCHANGES];
    for (int k = 0; k < PAR_EXCHANGES; k++) {
        number[1] += moved->messages[k];
        number[2 + k] = moved->bytes[k];
    }
    MPI_Reduce(mine, most, MEASURES, MPI_DOUBLE, MPI_MAX, 0, MPI_COMM_WORLD);
    MPI_Reduce(mine, sum, MEASURES, MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
    MPI_Reduce(number, total, 2 + PAR_EXCHANGES, MPI_INT64_T, MPI_SUM, 0, MPI_COMM_WORLD);
    if (rank > 0)
        return;
    printf("%d ranks, %lld triangles, wall %.2f s, processor time %.2f s (system %.2f s, %.0f page faults, "
           "%.0f waits), most of a rank %.2f s, most memory of a rank %.0f MB, %lld messages, bytes a triangle",
           n_ranks, (long long)total[0], wall, sum[SECONDS], sum[SYSTEM], sum[FAULTS], sum[WAITS], most[SECONDS],
           most[MEGABYTES], (long long)total[1]);
    for (int k = 0; k < PAR_EXCHANGES; k++)
        printf(" %.3f", (double)total[2 + k] / (double)total[0]);
    printf("\n");
}

static int measure(int rank, char **argv, int threads)
{
    struct tri_figure figure = tri_no_figure();
    struct tri_settings settings = tri_no_settings();
    struct tri_error error = {0};
    struct counts counts = {0, 0};
    struct par_exchanges moved;
    const struct tri_sink sink = {&counts, NULL, count_tile, NULL};
    double before[MEASURES], taken[MEASURES];
    int n_ranks;
    MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
    enum tri_status status = tri_file_read(argv[1], &figure, &error);
    settings.min_angle = atof(argv[2]);
    settings.max_area = atof(argv[3]);
    settings.threads = threads;
    MPI_Barrier(MPI_COMM_WORLD);
    read_usage(before);
    double began = MPI_Wtime();
    if (!status)
        status = par_stream_on(MPI_COMM_WORLD, &figure, &settings, &sink, &moved, &error);
    double wall = MPI_Wtime() - began;
    read_usage(taken);
    for (int k = 0; k < MEGABYTES; k++)
        taken[k] -= before[k];
    if (!status)
        print(rank, n_ranks, wall, taken, &counts, &moved);
    else if (rank == 0)
        fprintf(stderr, "%s\n", error.text);
    tri_file_free(&figure);
    return status != TRI_OK;
}

int main(int argc, char **argv)
{
    int rank, code = 2, provided;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    if (argc == 4 || argc == 5)
        code = measure(rank, argv, argc == 5 ? atoi(argv[4]) : 1);
    MPI_Finalize();
    return code;
}
