/* A client of ptriangle-mpi, as a user would write one: each rank keeps its part. As a test, rank 0 then compares all
 * parts with the mesh of one process.
 * Usage: mpirun -n N ranks FILE.poly MIN_ANGLE MAX_AREA */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <ptriangle/files.h>
#include <ptriangle/mpi.h>
#include <ptriangle/par.h>

/* The part of one rank. */
struct part {
    int64_t first_point, first_triangle, n_points, n_triangles;
    double (*points)[2];
    int64_t (*triangles)[3];
    int64_t *owners; /* [n_ranks + 1] rank p owns points owners[p] to owners[p + 1] - 1 */
    int n_ranks;
};

static enum tri_status begin(void *user, const struct tri_stream *stream, struct tri_error *error)
{
    struct part *part = user;
    (void)error;
    part->n_ranks = stream->n_ranks;
    size_t n = (size_t)stream->n_ranks + 1;
    part->owners = malloc(n * sizeof *part->owners);
    if (!part->owners)
        return TRI_NO_MEMORY;
    memcpy(part->owners, stream->first_vertex, n * sizeof *part->owners);
    part->first_point = stream->first_vertex[stream->rank];
    part->first_triangle = stream->first_triangle[stream->rank];
    part->points = malloc((size_t)(stream->first_vertex[stream->rank + 1] - part->first_point + 1) *
                          sizeof *part->points);
    part->triangles = malloc((size_t)(stream->first_triangle[stream->rank + 1] - part->first_triangle + 1) *
                             sizeof *part->triangles);
    return part->points && part->triangles ? TRI_OK : TRI_NO_MEMORY;
}

static enum tri_status take(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    struct part *part = user;
    (void)error;
    if (tile->first_vertex != part->first_point + part->n_points)
        return TRI_INTERNAL;
    if (tile->n_vertices > 0)
        memcpy(part->points + part->n_points, tile->points, (size_t)tile->n_vertices * sizeof *part->points);
    if (tile->n_triangles > 0)
        memcpy(part->triangles + part->n_triangles, tile->corners, (size_t)tile->n_triangles * sizeof *part->triangles);
    part->n_points += tile->n_vertices;
    part->n_triangles += tile->n_triangles;
    return TRI_OK;
}

/* Number of differences between a part and the mesh of one process. */
static int64_t count_wrong(const struct part *part, const struct tri_mesh *mesh)
{
    struct tri_reals points = tri_mesh_points(mesh);
    struct tri_ints triangles = tri_mesh_triangles(mesh);
    int64_t wrong = par_rank_of(part->owners, part->n_ranks, -1) != -1 ||
                    par_rank_of(part->owners, part->n_ranks, part->owners[part->n_ranks]) != -1;
    for (int64_t i = 0; i < part->n_points; i++) {
        const double *point = points.at + (part->first_point + i) * points.stride;
        wrong += memcmp(part->points[i], point, sizeof part->points[i]) != 0;
    }
    for (int64_t i = 0; i < part->n_triangles; i++)
        for (int k = 0; k < 3; k++) {
            int64_t corner = part->triangles[i][k];
            int32_t owner = par_rank_of(part->owners, part->n_ranks, corner);
            wrong += corner != triangles.at[(part->first_triangle + i) * triangles.stride + k];
            wrong += owner < 0 || corner < part->owners[owner] || corner >= part->owners[owner + 1];
        }
    return wrong;
}

static int report(int rank, const char *what, const struct tri_error *error)
{
    if (rank == 0)
        fprintf(stderr, "%s: %s\n", what, error->text);
    return 1;
}

/* Each rank compares its own part. */
static int compare(int rank, const struct tri_figure *figure, const struct tri_settings *settings,
                   const struct part *part, const struct par_exchanges *exchanges)
{
    struct tri_mesh *mesh;
    struct tri_error error = {0};
    if (par_mesh_new(&mesh, figure, settings, &error) != TRI_OK)
        return report(rank, "one process", &error);
    int64_t mine[4] = {count_wrong(part, mesh), part->n_points, part->n_triangles, 0}, sum[4];
    for (int k = 0; k < PAR_EXCHANGES; k++)
        mine[3] += exchanges->bytes[k];
    MPI_Allreduce(mine, sum, 4, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
    int good = sum[0] == 0 && sum[1] == tri_mesh_points(mesh).n && sum[2] == tri_mesh_triangles(mesh).n;
    if (rank == 0)
        printf("%s: %lld points, %lld triangles on %d ranks, %lld differences, %.2f bytes sent a triangle\n",
               good ? "good" : "BAD", (long long)sum[1], (long long)sum[2], part->n_ranks, (long long)sum[0],
               (double)sum[3] / (double)sum[2]);
    tri_mesh_delete(mesh);
    return !good;
}

static int run(int rank, char **argv)
{
    struct tri_figure figure = tri_no_figure();
    struct tri_settings settings = tri_no_settings();
    struct tri_error error = {0};
    struct part part = {0};
    struct par_exchanges exchanges;
    const struct tri_sink sink = {&part, begin, take, NULL};
    if (tri_file_read(argv[1], &figure, &error) != TRI_OK)
        return report(rank, argv[1], &error);
    settings.min_angle = atof(argv[2]);
    settings.max_area = atof(argv[3]);
    settings.threads = 1;
    int code = 0;
    if (par_stream_on(MPI_COMM_WORLD, &figure, &settings, &sink, &exchanges, &error) != TRI_OK)
        code = report(rank, "ranks", &error);
    code = code ? code : compare(rank, &figure, &settings, &part, &exchanges);
    free(part.points);
    free(part.triangles);
    free(part.owners);
    tri_file_free(&figure);
    return code;
}

int main(int argc, char **argv)
{
    int rank, code = 2;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    if (argc == 4)
        code = run(rank, argv);
    MPI_Finalize();
    return code;
}
