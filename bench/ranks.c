/* Measures par_stream_on: what each rank takes, and what moves. Each rank counts its tiles and lets them go.
 * Usage: mpirun -n N ranks FILE.poly MIN_ANGLE MAX_AREA [THREADS_A_RANK] */
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>

#include <ptriangle/files.h>
#include <ptriangle/mpi.h>

struct counts {
    int64_t points, triangles;
};

static enum tri_status take(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    struct counts *counts = user;
    (void)error;
    counts->points += tile->n_vertices;
    counts->triangles += tile->n_triangles;
    return TRI_OK;
}

static double processor_seconds(long *kilobytes)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    *kilobytes = usage.ru_maxrss;
    return (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
           1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

/* Sums and largest values over the ranks, by rank 0. */
static void print(int rank, int n_ranks, double wall, double seconds, double user, long kilobytes,
                  const struct counts *counts, const struct par_exchanges *moved)
{
    double mine[3] = {seconds, user, (double)kilobytes}, most[3], sum[3];
    int64_t number[2 + PAR_EXCHANGES] = {counts->triangles}, total[2 + PAR_EXCHANGES];
    for (int k = 0; k < PAR_EXCHANGES; k++) {
        number[1] += moved->messages[k];
        number[2 + k] = moved->bytes[k];
    }
    MPI_Reduce(mine, most, 3, MPI_DOUBLE, MPI_MAX, 0, MPI_COMM_WORLD);
    MPI_Reduce(mine, sum, 3, MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
    MPI_Reduce(number, total, 2 + PAR_EXCHANGES, MPI_INT64_T, MPI_SUM, 0, MPI_COMM_WORLD);
    if (rank > 0)
        return;
    printf("%d ranks, %lld triangles, wall %.2f s, processor time %.2f s, most of a rank %.2f s, most memory of a rank "
           "%.0f MB, %lld messages, bytes a triangle",
           n_ranks, (long long)total[0], wall, sum[0], most[0], most[2] / 1024, (long long)total[1]);
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
    const struct tri_sink sink = {&counts, NULL, take, NULL};
    int n_ranks;
    long kilobytes;
    MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
    enum tri_status status = tri_file_read(argv[1], &figure, &error);
    settings.min_angle = atof(argv[2]);
    settings.max_area = atof(argv[3]);
    settings.threads = threads;
    MPI_Barrier(MPI_COMM_WORLD);
    double began = MPI_Wtime(), before = processor_seconds(&kilobytes);
    if (!status)
        status = par_stream_on(MPI_COMM_WORLD, &figure, &settings, &sink, &moved, &error);
    double wall = MPI_Wtime() - began, seconds = processor_seconds(&kilobytes) - before;
    if (!status)
        print(rank, n_ranks, wall, seconds, seconds, kilobytes, &counts, &moved);
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
