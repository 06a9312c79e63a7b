/* A client of the installed package. It reads a .poly file of the unit square, meshes it, writes the mesh, reads it
 * again and checks it. Then it checks two valid triangles and two folded ones. It uses both libraries and, through the
 * reader, the C++ runtime.
 * Usage: client square.poly */
#include <stdio.h>
#include <stdlib.h>

#include "ptriangle/check.h"
#include "ptriangle/files.h"

static int is_valid(const struct tri_figure *mesh, const struct tri_figure *input, double max_area)
{
    struct tri_demands demands = tri_no_demands();
    struct tri_verdict verdict;
    demands.max_area = max_area;
    demands.min_angle = 30;
    return tri_check_figure(mesh, input, &demands, &verdict, NULL) == TRI_OK && verdict.n_faults == 0;
}

static int check_two_triangles(const struct tri_figure *square)
{
    static const int32_t good[6] = {0, 1, 2, 0, 2, 3}, folded[6] = {0, 1, 2, 0, 1, 3};
    struct tri_figure mesh = tri_no_figure();
    mesh.points = square->points;
    mesh.triangles = tri_ints_of(good, 2, 3);
    int right = is_valid(&mesh, square, 0.5);
    mesh.triangles = tri_ints_of(folded, 2, 3);
    return right && !is_valid(&mesh, square, 0.5);
}

static int meshes(const struct tri_figure *square)
{
    struct tri_settings settings = tri_no_settings();
    struct tri_figure made = tri_no_figure(), read = tri_no_figure();
    struct tri_mesh *mesh = NULL;
    settings.min_angle = 30;
    settings.max_area = 0.01;
    if (tri_mesh_new(&mesh, square, &settings, NULL) != TRI_OK)
        return 0;
    tri_mesh_figure(mesh, &made);
    int right = tri_file_write("client_mesh", &made, 1, NULL) == TRI_OK &&
                tri_file_read("client_mesh.ele", &read, NULL) == TRI_OK && read.triangles.n == made.triangles.n &&
                read.segments.n == made.segments.n && is_valid(&read, square, 0.01) && !is_valid(&read, square, 0.001);
    tri_file_free(&read);
    tri_mesh_delete(mesh);
    return right;
}

int main(int argc, char **argv)
{
    struct tri_figure square = tri_no_figure();
    struct tri_error error;
    if (argc != 2 || tri_file_read(argv[1], &square, &error) != TRI_OK) {
        fprintf(stderr, "client: %s\n", argc == 2 ? error.text : "one argument is needed, a .poly file");
        return EXIT_FAILURE;
    }
    int right = square.points.n == 4 && check_two_triangles(&square) && meshes(&square);
    printf("client: %d points, %d segments: %s\n", (int)square.points.n, (int)square.segments.n,
           right ? "ok" : "wrong");
    tri_file_free(&square);
    return right ? EXIT_SUCCESS : EXIT_FAILURE;
}
