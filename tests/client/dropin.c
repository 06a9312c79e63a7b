/* A client of Triangle's C interface, written as for Triangle's own header and library. Four points and a region are
 * triangulated, then refined. Both meshes and the Voronoi diagram are printed.
 * Usage: dropin [switches]: prints only the size of the mesh of the four points with these switches. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef SINGLE
#define REAL float
#else
#define REAL double
#endif
#define VOID void
#define ANSI_DECLARATORS
#include "triangle.h"

static void print_reals(const char *name, const REAL *list, int n, int width)
{
    for (int i = 0; list && i < n; i++) {
        printf("%s %d:", name, i);
        for (int k = 0; k < width; k++)
            printf(" %.6g", list[i * width + k]);
        printf("\n");
    }
}

static void print_ints(const char *name, const int *list, int n, int width)
{
    for (int i = 0; list && i < n; i++) {
        printf("%s %d:", name, i);
        for (int k = 0; k < width; k++)
            printf(" %d", list[i * width + k]);
        printf("\n");
    }
}

static void print_mesh(const struct triangulateio *io)
{
    print_reals("point", io->pointlist, io->numberofpoints, 2);
    print_reals("attribute", io->pointattributelist, io->numberofpoints, io->numberofpointattributes);
    print_ints("marker", io->pointmarkerlist, io->numberofpoints, 1);
    print_ints("triangle", io->trianglelist, io->numberoftriangles, io->numberofcorners);
    print_reals("triangle attribute", io->triangleattributelist, io->numberoftriangles, io->numberoftriangleattributes);
    print_ints("neighbors", io->neighborlist, io->numberoftriangles, 3);
    print_ints("segment", io->segmentlist, io->numberofsegments, 2);
    print_ints("segment marker", io->segmentmarkerlist, io->numberofsegments, 1);
    print_ints("edge", io->edgelist, io->numberofedges, 2);
    print_ints("edge marker", io->edgemarkerlist, io->numberofedges, 1);
}

static void free_all(struct triangulateio *io)
{
    trifree((VOID *)io->pointlist);
    trifree((VOID *)io->pointattributelist);
    trifree((VOID *)io->pointmarkerlist);
    trifree((VOID *)io->trianglelist);
    trifree((VOID *)io->triangleattributelist);
    trifree((VOID *)io->neighborlist);
    trifree((VOID *)io->segmentlist);
    trifree((VOID *)io->segmentmarkerlist);
    free(io->edgelist);
    free(io->edgemarkerlist);
    free(io->normlist);
}

int main(int argc, char **argv)
{
    static REAL points[] = {0, 0, 1, 0, 1, 10, 0, 10}, attributes[] = {0, 1, 11, 10}, region[] = {0.5, 5, 7, 0.1};
    static int markers[] = {0, 2, 0, 0};
    struct triangulateio in, mid, out, vor;
    memset(&in, 0, sizeof in);
    memset(&mid, 0, sizeof mid);
    memset(&out, 0, sizeof out);
    memset(&vor, 0, sizeof vor);
    in.pointlist = points;
    in.pointattributelist = attributes;
    in.pointmarkerlist = markers;
    in.numberofpoints = 4;
    in.numberofpointattributes = 1;
    in.regionlist = region;
    in.numberofregions = 1;

    if (argc > 1) {
        triangulate(argv[1], &in, &out, NULL);
        printf("%d points, %d triangles\n", out.numberofpoints, out.numberoftriangles);
        free_all(&out);
        return 0;
    }
    triangulate("pczAevn", &in, &mid, &vor);
    printf("first mesh\n");
    print_mesh(&mid);
    printf("Voronoi diagram\n");
    print_reals("point", vor.pointlist, vor.numberofpoints, 2);
    print_ints("edge", vor.edgelist, vor.numberofedges, 2);
    print_reals("direction", vor.normlist, vor.numberofedges, 2);

    mid.trianglearealist = malloc((size_t)mid.numberoftriangles * sizeof(REAL));
    for (int i = 0; i < mid.numberoftriangles; i++)
        mid.trianglearealist[i] = i == 0 ? 3 : 1;
    triangulate("prazBP", &mid, &out, NULL);
    printf("refined mesh\n");
    print_mesh(&out);
    int right = mid.numberoftriangles == 2 && mid.holelist == NULL && mid.regionlist == region &&
                out.numberoftriangles >= 7 && out.numberoftriangleattributes == 1 && out.segmentlist == NULL;
    free(mid.trianglearealist);
    free_all(&mid);
    free_all(&out);
    free_all(&vor);
    return right ? 0 : 1;
}
