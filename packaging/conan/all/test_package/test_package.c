#include <ptriangle/par.h>
#include <stdio.h>

int main(void)
{
    const double xy[] = {0, 0, 1, 0, 0, 1};
    struct tri_figure figure = tri_no_figure();
    struct tri_settings settings = tri_no_settings();
    struct tri_mesh *mesh;
    struct tri_error error;
    figure.points = tri_reals_of(xy, 3, 2);
    settings.min_angle = 30;
    settings.max_area = 0.01;
    if (par_mesh_new(&mesh, &figure, &settings, &error) != TRI_OK)
        return 1;
    printf("ptriangle %s: %lld triangles\n", tri_version(), (long long)tri_mesh_triangles(mesh).n);
    tri_mesh_delete(mesh);
    return 0;
}
