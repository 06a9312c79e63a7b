/* Measures par_mesh_stream: a mesh within a memory bound, tile by tile. Each tile is judged and discarded.
 *
 * Each triangle is judged from its corners: they are counter-clockwise, and angles and area are within the bounds. Sums
 * judge the whole mesh. An edge that is no subsegment must occur once in each direction. If all segments are on the
 * boundary of the domain, the hashes of all edges, with a sign that depends on the direction, therefore have the same
 * sum as those of the subsegments. A difference is printed, but does not count as a fault.
 * Usage: stream FILE.poly MIN_ANGLE MAX_AREA BYTES THREADS [SCRATCH]; bytes 0: in memory */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

#include <ptriangle/files.h>
#include <ptriangle/par.h>

struct judge {
    double squared_cosine, max_area; /* the bounds: squared cosine of the angle, and area */
    int64_t points, triangles, segments; /* numbers of points, triangles and subsegments so far */
    int64_t faults;     /* number of triangles that break a rule or a bound */
    double area;        /* sum of the areas of the triangles */
    double (*kept)[2];  /* [n_kept] the points of the first tile */
    int64_t n_kept;     /* number of these points */
    double (*recent)[2]; /* [mask + 1] the last points; point i is at i & mask */
    int64_t mask;       /* number of recent points minus 1; the number is a power of two */
    uint64_t edges, ends; /* sums of hashes: of the edges of triangles, of the subsegments */
};

static enum tri_status begin(void *user, const struct tri_stream *stream, struct tri_error *error)
{
    struct judge *j = user;
    (void)error;
    free(j->kept);
    free(j->recent);
    *j = (struct judge){.squared_cosine = j->squared_cosine, .max_area = j->max_area, .mask = (1 << 16) - 1};
    /* Corners are at most one column back, and a column has about sqrt(65,536 n) points (docs/scaling.md). */
    while ((double)j->mask < 2.5 * sqrt(65536 * stream->estimate))
        j->mask = 2 * j->mask + 1;
    j->recent = malloc((size_t)(j->mask + 1) * sizeof *j->recent);
    return j->recent ? TRI_OK : TRI_NO_MEMORY;
}

/* Stores the points of a tile. */
static bool keep_points(struct judge *j, const struct tri_tile *tile)
{
    if (tile->column < 0) {
        double (*kept)[2] = realloc(j->kept, (size_t)(j->n_kept + tile->n_vertices + 1) * sizeof *kept);
        if (!kept)
            return false;
        j->kept = kept;
        for (int32_t i = 0; i < tile->n_vertices; i++)
            memcpy(j->kept[j->n_kept++], tile->points[i], sizeof *j->kept);
    }
    for (int32_t i = 0; i < tile->n_vertices; i++)
        memcpy(j->recent[(tile->first_vertex + i) & j->mask], tile->points[i], sizeof *j->recent);
    j->points = tile->first_vertex + tile->n_vertices;
    return true;
}

/* Returns a point, or NULL if it is not kept any more. */
static const double *point(const struct judge *j, int64_t number)
{
    if (number < j->n_kept)
        return j->kept[number];
    return number < j->points && number >= j->points - j->mask ? j->recent[number & j->mask] : NULL;
}

/* Returns a hash of an edge. That of the opposite direction has the opposite sign. */
static uint64_t hash(int64_t from, int64_t to)
{
    const uint64_t low = (uint64_t)(from < to ? from : to), high = (uint64_t)(from < to ? to : from);
    uint64_t h = low * 0x9e3779b97f4a7c15u + high;
    h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93u;
    h ^= h >> 29;
    return from < to ? h : 0 - h;
}

static double square_of_distance(const double *a, const double *b)
{
    return (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]);
}

/* Returns whether the triangle is counter-clockwise and within the bounds, and adds its area to *sum. */
static bool is_right(const struct judge *j, const double *a, const double *b, const double *c, double *sum)
{
    const double slack = 1e-9, area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
    double u = square_of_distance(a, b), v = square_of_distance(b, c), w = square_of_distance(c, a);
    *sum += area;
    if (v < u) { /* u becomes the shortest edge, opposite the smallest angle */
        const double t = u;
        u = v, v = t;
    }
    if (w < u) {
        const double t = u;
        u = w, w = t;
    }
    return area > 0 && area <= j->max_area * (1 + slack) &&
           (v + w - u) * (v + w - u) <= 4 * v * w * (j->squared_cosine + slack);
}

static enum tri_status judge_tile(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    struct judge *j = user;
    double area = 0;
    (void)error;
    if (!keep_points(j, tile))
        return TRI_NO_MEMORY;
    for (int32_t t = 0; t < tile->n_triangles; t++) {
        const int64_t *v = tile->corners[t];
        const double *a = point(j, v[0]), *b = point(j, v[1]), *c = point(j, v[2]);
        j->faults += !a || !b || !c || !is_right(j, a, b, c, &area);
        j->edges += hash(v[0], v[1]) + hash(v[1], v[2]) + hash(v[2], v[0]);
    }
    for (int32_t s = 0; s < tile->n_segments; s++)
        j->ends += hash(tile->ends[s][0], tile->ends[s][1]);
    j->area += area;
    j->triangles += tile->n_triangles;
    j->segments += tile->n_segments;
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
    struct judge judge = {0};
    const struct tri_sink sink = {&judge, begin, judge_tile, NULL};
    if (argc < 6)
        return 1;
    enum tri_status status = tri_file_read(argv[1], &figure, &error);
    settings.min_angle = atof(argv[2]);
    settings.max_area = atof(argv[3]);
    settings.threads = atoi(argv[5]);
    judge.squared_cosine = pow(cos(settings.min_angle * acos(-1) / 180), 2);
    judge.max_area = settings.max_area;
    double began = now();
    if (!status)
        status = par_mesh_stream(&figure, &settings, atoll(argv[4]), argc > 6 ? argv[6] : NULL, &sink, &error);
    double wall = now() - began;
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    if (status)
        fprintf(stderr, "%s\n", error.text);
    printf("%lld triangles, %lld points, %lld segments, %.2f s, %.2f s user, %.2f s system, %ld MB\n",
           (long long)judge.triangles, (long long)judge.points, (long long)judge.segments, wall,
           seconds_of(usage.ru_utime), seconds_of(usage.ru_stime), usage.ru_maxrss * 1024 / 1000000);
    printf("%lld faults, area %.12g, edges %s\n", (long long)judge.faults, judge.area,
           judge.edges == judge.ends ? "in pairs" : "not in pairs, or segments inside");
    free(judge.kept);
    free(judge.recent);
    tri_file_free(&figure);
    return status != TRI_OK || judge.faults > 0;
}
