/* A client in C++: triangulate() with a size test found by the linker, and the library below it, on a square. */
#include <cstdio>
#include <cstdlib>

#define EXTERNAL_TEST
extern "C" int triunsuitable(double *origin, double *destination, double *apex, double area);
#include "triangle.h"
#include <ptriangle/tri.h>

static int asked;

extern "C" int triunsuitable(double *, double *, double *, double area)
{
    asked++;
    return area > 0.01;
}

static int by_structs()
{
    double points[] = {0, 0, 1, 0, 1, 1, 0, 1};
    triangulateio in = triangulateio(), out = triangulateio();
    char switches[] = "quzQ";
    in.pointlist = points;
    in.numberofpoints = 4;
    if (triangulate(switches, &in, &out, nullptr) != TRIANGULATE_OK)
        return 0;
    trifree(out.pointlist);
    trifree(out.pointmarkerlist);
    trifree(out.trianglelist);
    return out.numberoftriangles;
}

static int by_mesh()
{
    const double points[] = {0, 0, 1, 0, 1, 1, 0, 1};
    tri_figure square = tri_no_figure();
    square.points = tri_reals_of(points, 4, 2);
    tri_settings settings = tri_no_settings();
    settings.max_area = 0.01;
    tri_mesh *mesh = nullptr;
    tri_error error;
    if (tri_mesh_new(&mesh, &square, &settings, &error) != TRI_OK)
        return 0;
    const tri_ints triangles = tri_mesh_triangles(mesh);
    tri_mesh_delete(mesh);
    return static_cast<int>(triangles.n);
}

int main()
{
    const int a = by_structs(), b = by_mesh();
    std::printf("client: %d and %d triangles, %d times asked\n", a, b, asked);
    return a >= 100 && b >= 100 && asked > a ? EXIT_SUCCESS : EXIT_FAILURE;
}
