/* A client of the installed package: reads a .poly file of the unit square and has a mesh of two triangles judged, one
 * that is right and one that is folded. It touches both libraries, and through the reader the C++ runtime.
 * Usage: client square.poly */
#include <stdio.h>

#include "triangle/check/check.h"
#include "triangle/text/read.h"

static int passes(const struct tri_pslg *square, const int32_t (*corners)[3])
{
    const struct tri_check_mesh mesh = {
        .n_points = square->n_points, .points = square->points, .n_triangles = 2, .triangles = corners[0]};
    const struct tri_check_options options = {.min_angle = 45, .max_area = 0.5, .max_bad = -1};
    struct tri_check_report report;
    return tri_check(&mesh, square, &options, &report, NULL) == TRI_OK && tri_check_passed(&report);
}

int main(int argc, char **argv)
{
    static const int32_t good[2][3] = {{0, 1, 2}, {0, 2, 3}}, folded[2][3] = {{0, 1, 2}, {0, 1, 3}};
    struct tri_pslg square;
    struct tri_error error;
    struct tri_read_options options = {.default_base = 1};
    int32_t base;
    bool points_in_poly;
    if (argc != 2 || tri_read_poly(argv[1], NULL, &options, &square, &base, &points_in_poly, &error) != TRI_OK) {
        fprintf(stderr, "client: %s\n", argc == 2 ? error.text : "one argument is needed, a .poly file");
        return 1;
    }
    int right = square.n_points == 4 && passes(&square, good) && !passes(&square, folded);
    printf("client: %d points, %d segments: %s\n", (int)square.n_points, (int)square.n_segments,
           right ? "ok" : "wrong");
    tri_pslg_free(&square);
    return right ? 0 : 1;
}
