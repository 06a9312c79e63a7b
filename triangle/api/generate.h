/* Mesh generation from a planar straight line graph (PSLG).
 *
 * There is no global state, printing or exit: calls on different meshes may run at the same time. tri_generate makes
 * a mesh, triangle/mesh/mesh.h gives access to it, tri_refine refines it further as often as wanted (wholly, or
 * where a gate allows: triangle/refine/refine.h), and tri_mesh_free frees it.
 *
 * Coordinates in a mesh are those of the caller divided by mesh.unit, a power of two. It is 1 for all inputs of
 * ordinary size. tri_mesh_place returns a vertex in the caller's coordinates. Gates, size functions and size tests
 * receive the caller's coordinates. */
#ifndef TRIANGLE_API_GENERATE_H
#define TRIANGLE_API_GENERATE_H

#include "triangle/base/status.h"
#include "triangle/cdt/carve.h"
#include "triangle/cdt/constrain.h"
#include "triangle/cdt/reconstruct.h"
#include "triangle/cdt/spatial.h"
#include "triangle/mesh/mesh.h"
#include "triangle/mesh/pslg.h"
#include "triangle/refine/refine.h"

/* The stages, in order. With tri_options.elements, REBUILD replaces the first three. QUALITY is always announced,
 * and the mesh then does not meet any bound yet. */
enum tri_stage {
    TRI_STAGE_DELAUNAY,
    TRI_STAGE_SEGMENTS,
    TRI_STAGE_HOLES,
    TRI_STAGE_REBUILD,
    TRI_STAGE_QUALITY,
    TRI_STAGE_DONE
};

/* Refines the mesh like tri_refine, or streams it to its receiver and frees it. */
typedef enum tri_status tri_refine_call(void *user, struct tri_mesh *mesh, const struct tri_quality *quality,
                                        struct tri_refine_report *report, struct tri_error *error);

struct tri_options {
    bool use_segments;  /* true (-p): use the segments and holes of the PSLG; false: use only its points */
    bool keep_hull;     /* true (-c): keep the whole convex hull */
    bool ignore_holes;  /* true (-O): do not carve holes */
    bool even_odd;      /* true: the even-odd rule decides which areas are inside, see tri_carve */
    int32_t n_open;     /* number of segments without effect on domain and regions (tri_carve_options); 0: none */
    bool spread_regions; /* true (-A, or -a without a number): assign regions to triangles */
    bool refine;        /* true: run the quality stage, with the options below */
    struct tri_quality quality;   /* bounds of the quality stage */
    tri_refine_call *refine_call; /* called instead of tri_refine; NULL: tri_refine */
    void *refine_user;            /* passed to refine_call */
    const struct tri_elements *elements; /* -r: existing mesh to rebuild; use_segments and refine are then options of
                                            tri_reconstruct; NULL: make a new mesh from the points */
    bool *is_edge;       /* with elements: as in struct tri_reconstruct_options */
    int32_t base;        /* 0 or 1: first number in the caller's numbering, for messages */
    const struct tri_executor *executor; /* runs tasks in parallel; NULL: one after another */
    const struct tri_stop *stop;         /* polled for a stop request here and, as mesh->stop, later; NULL: never
                                            stopped */
    void (*stage)(void *user, enum tri_stage begins); /* called when a stage begins; NULL: not called */
    void *stage_user;                                 /* passed to stage */
};

/* Returns the measured peak memory of tri_generate before refinement, in bytes, including the input. */
double tri_generate_bytes(const struct tri_pslg *pslg, const struct tri_elements *elements, bool refine);

struct tri_report {
    int32_t duplicates; /* points at the position of a point with a lower index; 0 with elements */
    struct tri_carve_report carve; /* of carving holes and concavities */
    struct tri_notes notes; /* warnings about probable mistakes in the input */
    int32_t loose;      /* with elements: segments that are no edges of the mesh, see struct tri_reconstruct_options */
    struct tri_constrain_report constrain; /* of inserting segments */
    struct tri_refine_report quality;      /* of refinement */
};

struct tri_options tri_defaults(void);

/* Makes *mesh from the PSLG, which is only read. On failure *mesh is empty, with one exception: if refinement ran
 * out of memory (TRI_NO_MEMORY, TRI_TOO_LARGE) or was stopped (TRI_STOPPED), *mesh is valid but only partly refined.
 * TRI_BAD_INPUT: see tri_pslg_check and tri_reconstruct. */
enum tri_status tri_generate(struct tri_mesh *mesh, const struct tri_pslg *pslg, const struct tri_options *options,
                             struct tri_report *report, struct tri_error *error);

#endif
