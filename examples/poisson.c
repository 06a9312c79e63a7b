/* poisson: an example of ptriangle/mpi.h. The ranks of an MPI mesh the unit square, pass their parts to PETSc without
 * ghosts, and solve
 *
 *     - div grad u = 2 pi^2 sin(pi x) sin(pi y),  u = 0 on the boundary,
 *
 * by linear finite elements.
 *
 * PETSc needs exactly the data that a sink receives: owned points in the order of their global numbers, and own cells
 * with the global numbers of their corners, which other ranks may own.
 *
 * Usage: mpirun -n N poisson [MAX_AREA [PETSC_OPTION...]]. Exit code 0: u is as close to sin(pi x) sin(pi y) as
 * elements of this size come. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <petscdmplex.h>
#include <petscds.h>
#include <petscsf.h>
#include <petscsnes.h>

#include "ptriangle/mpi.h"

static const PetscReal PI = 3.14159265358979323846;

/* --- the mesh, from tiles */

/* The part of the mesh on this rank. */
struct part {
    PetscInt n_points, n_cells;
    PetscReal (*points)[2];
    PetscInt (*corners)[3]; /* global numbers */
};

static enum tri_status begin(void *user, const struct tri_stream *stream, struct tri_error *error)
{
    struct part *part = user;
    int p = stream->rank;
    (void)error;
    free(part->points);
    free(part->corners);
    *part = (struct part){
        .points = malloc((size_t)(stream->first_vertex[p + 1] - stream->first_vertex[p] + 1) * sizeof *part->points),
        .corners = malloc((size_t)(stream->first_triangle[p + 1] - stream->first_triangle[p] + 1) *
                          sizeof *part->corners)};
    return part->points && part->corners ? TRI_OK : TRI_NO_MEMORY;
}

static enum tri_status take(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    struct part *part = user;
    (void)error;
    for (int32_t i = 0; i < tile->n_vertices; i++, part->n_points++)
        for (int k = 0; k < 2; k++)
            part->points[part->n_points][k] = tile->points[i][k];
    for (int32_t i = 0; i < tile->n_triangles; i++, part->n_cells++)
        for (int k = 0; k < 3; k++)
            part->corners[part->n_cells][k] = (PetscInt)tile->corners[i][k];
    return TRI_OK;
}

/* Collective. */
static enum tri_status mesh_square(struct part *part, double max_area, struct tri_error *error)
{
    const double points[8] = {0, 0, 1, 0, 1, 1, 0, 1};
    const int32_t segments[8] = {0, 1, 1, 2, 2, 3, 3, 0};
    const struct tri_sink sink = {.user = part, .begin = begin, .take = take};
    struct tri_figure square = tri_no_figure();
    struct tri_settings settings = tri_no_settings();
    square.points = tri_reals_of(points, 4, 2);
    square.segments = tri_ints_of(segments, 4, 2);
    settings.min_angle = 30;
    settings.max_area = max_area;
    return par_stream_on(PETSC_COMM_WORLD, &square, &settings, &sink, NULL, error);
}

static PetscErrorCode hand_over(const struct part *part, DM *dm)
{
    PetscFunctionBeginUser;
    PetscCall(DMPlexCreateFromCellListParallelPetsc(PETSC_COMM_WORLD, 2, part->n_cells, part->n_points, PETSC_DETERMINE,
                                                    3, PETSC_TRUE, &part->corners[0][0], 2, &part->points[0][0], NULL,
                                                    NULL, dm));
    PetscFunctionReturn(0);
}

/* --- the equation: functions of a place, as PETSc's finite elements call them */

static PetscErrorCode solution(PetscInt dim, PetscReal t, const PetscReal x[], PetscInt n, PetscScalar *u, void *user)
{
    (void)dim, (void)t, (void)n, (void)user;
    u[0] = PetscSinReal(PI * x[0]) * PetscSinReal(PI * x[1]);
    return 0;
}

static PetscErrorCode zero(PetscInt dim, PetscReal t, const PetscReal x[], PetscInt n, PetscScalar *u, void *user)
{
    (void)dim, (void)t, (void)x, (void)n, (void)user;
    u[0] = 0;
    return 0;
}

static void load(PetscInt dim, PetscInt n, PetscInt n_aux, const PetscInt off[], const PetscInt off_x[],
                 const PetscScalar u[], const PetscScalar u_t[], const PetscScalar u_x[], const PetscInt aux_off[],
                 const PetscInt aux_off_x[], const PetscScalar a[], const PetscScalar a_t[], const PetscScalar a_x[],
                 PetscReal t, const PetscReal x[], PetscInt n_constants, const PetscScalar constants[], PetscScalar f[])
{
    (void)dim, (void)n, (void)n_aux, (void)off, (void)off_x, (void)u, (void)u_t, (void)u_x, (void)aux_off;
    (void)aux_off_x, (void)a, (void)a_t, (void)a_x, (void)t, (void)n_constants, (void)constants;
    f[0] = -2 * PI * PI * PetscSinReal(PI * x[0]) * PetscSinReal(PI * x[1]);
}

static void flux(PetscInt dim, PetscInt n, PetscInt n_aux, const PetscInt off[], const PetscInt off_x[],
                 const PetscScalar u[], const PetscScalar u_t[], const PetscScalar u_x[], const PetscInt aux_off[],
                 const PetscInt aux_off_x[], const PetscScalar a[], const PetscScalar a_t[], const PetscScalar a_x[],
                 PetscReal t, const PetscReal x[], PetscInt n_constants, const PetscScalar constants[], PetscScalar f[])
{
    (void)n, (void)n_aux, (void)off, (void)off_x, (void)u, (void)u_t, (void)aux_off;
    (void)aux_off_x, (void)a, (void)a_t, (void)a_x, (void)t, (void)x, (void)n_constants, (void)constants;
    for (PetscInt k = 0; k < dim; k++)
        f[k] = u_x[k];
}

static void flux_by_gradient(PetscInt dim, PetscInt n, PetscInt n_aux, const PetscInt off[], const PetscInt off_x[],
                             const PetscScalar u[], const PetscScalar u_t[], const PetscScalar u_x[],
                             const PetscInt aux_off[], const PetscInt aux_off_x[], const PetscScalar a[],
                             const PetscScalar a_t[], const PetscScalar a_x[], PetscReal t, PetscReal shift,
                             const PetscReal x[], PetscInt n_constants, const PetscScalar constants[], PetscScalar g[])
{
    (void)n, (void)n_aux, (void)off, (void)off_x, (void)u, (void)u_t, (void)u_x, (void)aux_off, (void)aux_off_x;
    (void)a, (void)a_t, (void)a_x, (void)t, (void)shift, (void)x, (void)n_constants, (void)constants;
    for (PetscInt k = 0; k < dim; k++)
        g[k * dim + k] = 1;
}

/* Finds the edges that belong to one cell on this rank and to no cell of other ranks, and their ends. */
static PetscErrorCode mark_boundary(DM dm, DMLabel label)
{
    PetscSF shared;
    PetscInt n_roots, n_leaves, first, end;
    const PetscInt *leaves, *degree = NULL;
    PetscFunctionBeginUser;
    PetscCall(DMGetPointSF(dm, &shared));
    PetscCall(PetscSFGetGraph(shared, &n_roots, &n_leaves, &leaves, NULL));
    if (n_roots >= 0) {
        PetscCall(PetscSFComputeDegreeBegin(shared, &degree));
        PetscCall(PetscSFComputeDegreeEnd(shared, &degree));
    }
    PetscCall(DMPlexGetHeightStratum(dm, 1, &first, &end));
    for (PetscInt edge = first; edge < end; edge++) {
        PetscInt n_cells, place = -1;
        PetscCall(DMPlexGetSupportSize(dm, edge, &n_cells));
        if (n_roots >= 0)
            PetscCall(PetscFindInt(edge, n_leaves, leaves, &place));
        if (n_cells == 1 && place < 0 && !(degree && degree[edge] > 0))
            PetscCall(DMLabelSetValue(label, edge, 1));
    }
    PetscCall(DMPlexLabelComplete(dm, label));
    PetscFunctionReturn(0);
}

static PetscErrorCode state_problem(DM dm)
{
    const PetscInt one = 1;
    PetscFE element;
    PetscDS ds;
    DMLabel boundary;
    PetscFunctionBeginUser;
    PetscCall(PetscFECreateLagrange(PETSC_COMM_WORLD, 2, 1, PETSC_TRUE, 1, PETSC_DETERMINE, &element));
    PetscCall(DMSetField(dm, 0, NULL, (PetscObject)element));
    PetscCall(PetscFEDestroy(&element));
    PetscCall(DMCreateDS(dm));
    PetscCall(DMGetDS(dm, &ds));
    PetscCall(PetscDSSetResidual(ds, 0, load, flux));
    PetscCall(PetscDSSetJacobian(ds, 0, 0, NULL, NULL, NULL, flux_by_gradient));
    PetscCall(DMCreateLabel(dm, "boundary"));
    PetscCall(DMGetLabel(dm, "boundary", &boundary));
    PetscCall(mark_boundary(dm, boundary));
    PetscCall(DMAddBoundary(dm, DM_BC_ESSENTIAL, "wall", boundary, 1, &one, 0, 0, NULL, (void (*)(void))zero, NULL,
                            NULL, NULL));
    PetscCall(DMPlexSetSNESLocalFEM(dm, NULL, NULL, NULL));
    PetscFunctionReturn(0);
}

/* *distance: distance of u from the solution, in the L2 norm. */
static PetscErrorCode solve(DM dm, PetscReal *distance, PetscInt *n_unknowns)
{
    PetscSimplePointFunc functions[1] = {solution};
    SNES snes;
    Vec u;
    PetscFunctionBeginUser;
    PetscCall(state_problem(dm));
    PetscCall(SNESCreate(PETSC_COMM_WORLD, &snes));
    PetscCall(SNESSetDM(snes, dm));
    PetscCall(SNESSetType(snes, SNESKSPONLY)); /* the problem is linear */
    PetscCall(SNESSetFromOptions(snes));
    PetscCall(DMCreateGlobalVector(dm, &u));
    PetscCall(VecGetSize(u, n_unknowns));
    PetscCall(SNESSolve(snes, NULL, u));
    PetscCall(DMComputeL2Diff(dm, 0, functions, NULL, u, distance));
    PetscCall(VecDestroy(&u));
    PetscCall(SNESDestroy(&snes));
    PetscFunctionReturn(0);
}

/* --- the program */

static PetscErrorCode run(double max_area, PetscBool *right)
{
    struct part part = {0};
    struct tri_error error = {0};
    PetscReal distance;
    PetscInt n_unknowns;
    PetscMPIInt n_ranks;
    DM dm;
    PetscFunctionBeginUser;
    *right = PETSC_FALSE;
    if (mesh_square(&part, max_area, &error) != TRI_OK) {
        PetscCall(PetscPrintf(PETSC_COMM_WORLD, "poisson: %s\n", error.text));
        PetscFunctionReturn(0);
    }
    PetscCall(hand_over(&part, &dm));
    free(part.points);
    free(part.corners);
    PetscCall(solve(dm, &distance, &n_unknowns));
    PetscCall(DMDestroy(&dm));
    PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &n_ranks));
    *right = distance < 3 * max_area ? PETSC_TRUE : PETSC_FALSE; /* error ~ squared edge length */
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%d ranks, %" PetscInt_FMT " unknowns, %.3e from the solution: %s\n",
                          (int)n_ranks, n_unknowns, (double)distance, *right ? "good" : "BAD"));
    PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
    double max_area = argc > 1 ? atof(argv[1]) : 0;
    PetscBool right;
    PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
    PetscCall(run(max_area > 0 ? max_area : 2e-5, &right));
    PetscCall(PetscFinalize());
    return right ? 0 : 1;
}
