/* stream: an example of par_mesh_stream. Receives a mesh tile by tile while it is made, and keeps only sums. In the
 * same way a solver can use a mesh that is larger than the memory. No mesh file is written. Usage: stream FILE.poly
 * MIN_ANGLE MAX_AREA MEMORY SCRATCH      MEMORY in MB; prints the area of the mesh */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <ptriangle/files.h>
#include <ptriangle/par.h>

/* Corners of triangles may be points of earlier tiles, so these must be kept. Here all points are kept, and no
 * triangles. */
struct sums {
    double (*points)[2];
    int64_t n_points, capacity, n_triangles, n_tiles;
    double area;
};

/* Discards all earlier tiles, if there were any. */
static enum tri_status begin(void *user, const struct tri_stream *stream, struct tri_error *error)
{
    struct sums *s = user;
    (void)stream, (void)error;
    s->n_points = s->n_triangles = s->n_tiles = 0;
    s->area = 0;
    return TRI_OK;
}

static int keep(struct sums *s, const struct tri_tile *tile)
{
    int64_t n = s->n_points + tile->n_vertices;
    if (n > s->capacity) {
        double (*fresh)[2] = realloc(s->points, 2 * (size_t)n * sizeof *fresh);
        if (!fresh)
            return 0;
        s->points = fresh;
        s->capacity = 2 * n;
    }
    if (tile->n_vertices > 0)
        memcpy(s->points + s->n_points, tile->points, (size_t)tile->n_vertices * sizeof *s->points);
    s->n_points = n;
    return 1;
}

static enum tri_status take(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    struct sums *s = user;
    (void)error;
    if (!keep(s, tile))
        return TRI_NO_MEMORY;
    for (int32_t t = 0; t < tile->n_triangles; t++) {
        const double *a = s->points[tile->corners[t][0]], *b = s->points[tile->corners[t][1]],
                     *c = s->points[tile->corners[t][2]];
        s->area += 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
    }
    s->n_triangles += tile->n_triangles;
    s->n_tiles++;
    return TRI_OK;
}

int main(int argc, char **argv)
{
    struct tri_figure figure = tri_no_figure();
    struct tri_settings settings = tri_no_settings();
    struct tri_error error = {0};
    struct sums sums = {0};
    const struct tri_sink sink = {&sums, begin, take, NULL};
    if (argc != 6)
        return 2;
    settings.min_angle = atof(argv[2]);
    settings.max_area = atof(argv[3]);
    enum tri_status status = tri_file_read(argv[1], &figure, &error);
    if (!status)
        status = par_mesh_stream(&figure, &settings, (int64_t)(1e6 * atof(argv[4])), argv[5], &sink, &error);
    if (status)
        fprintf(stderr, "%s\n", error.text);
    else
        printf("%lld points, %lld triangles in %lld tiles, area %.12f\n", (long long)sums.n_points,
               (long long)sums.n_triangles, (long long)sums.n_tiles, sums.area);
    free(sums.points);
    tri_file_free(&figure);
    return status != TRI_OK;
}
