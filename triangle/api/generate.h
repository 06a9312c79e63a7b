/* From a planar straight line graph to a mesh: the stages in their order.
 *
 * No global state, no printing, no exit: calls on different meshes may run at the same time. A mesh is made by
 * tri_generate, looked at through triangle/mesh/mesh.h, refined further (wholly, or where a gate allows:
 * triangle/refine/refine.h) by tri_refine as often as wanted, and freed by tri_mesh_free.
 *
 * Coordinates in a mesh are those of the caller divided by mesh.unit, a power of two that is 1 for all inputs of
 * ordinary size; tri_mesh_place gives a vertex in the caller's coordinates. Gates, size functions and size tests get
 * the caller's coordinates. */
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

/* In their order; with tri_options.elements REBUILD stands in place of the first three. QUALITY begins in any case,
 * with a mesh that keeps no bounds yet. */
enum tri_stage {
    TRI_STAGE_DELAUNAY,
    TRI_STAGE_SEGMENTS,
    TRI_STAGE_HOLES,
    TRI_STAGE_REBUILD,
    TRI_STAGE_QUALITY,
    TRI_STAGE_DONE
};

/* Refines as tri_refine does; or hands the mesh out, and frees it. */
typedef enum tri_status tri_refine_call(void *user, struct tri_mesh *mesh, const struct tri_quality *quality,
                                        struct tri_refine_report *report, struct tri_error *error);

struct tri_options {
    bool use_segments;  /* the segments and holes of the PSLG are part of the input (-p); else its points alone */
    bool keep_hull;     /* the convex hull stays whole (-c) */
    bool ignore_holes;  /* (-O) */
    bool even_odd;      /* segments tell what is inside, see tri_carve */
    bool spread_regions; /* triangles learn the region they are in (-A, or -a without number) */
    bool refine;        /* the quality stage runs, with the options below */
    struct tri_quality quality;
    tri_refine_call *refine_call; /* does so in place of tri_refine; NULL: tri_refine */
    void *refine_user;
    const struct tri_elements *elements; /* a mesh that is there (-r): it is rebuilt, and use_segments and refine are
                                            those of tri_reconstruct; NULL: one is made from the points */
    bool *is_edge;       /* with elements: as in struct tri_reconstruct_options */
    int32_t base;        /* 0 or 1: from which the caller counts, for words */
    const struct tri_executor *executor; /* for what is done in pieces; NULL: one after another */
    const struct tri_stop *stop;         /* asked whether to go on, here and, by mesh->stop, later; NULL: nobody */
    void (*stage)(void *user, enum tri_stage begins); /* told when a stage begins; NULL: nobody */
    void *stage_user;
};

/* Bytes of memory at the peak of tri_generate before it refines, the input included. Measured. */
double tri_generate_bytes(const struct tri_pslg *pslg, const struct tri_elements *elements, bool refine);

struct tri_report {
    int32_t duplicates; /* points that have a twin of lower index; 0 with elements */
    struct tri_carve_report carve;
    struct tri_notes notes; /* what of the input was hardly meant so */
    int32_t loose;      /* with elements: segments that are no edges of them, see struct tri_reconstruct_options */
    struct tri_constrain_report constrain;
    struct tri_refine_report quality;
};

struct tri_options tri_defaults(void);

/* Makes *mesh from the PSLG. On failure *mesh is empty, except that what refinement had done when it ran out of memory
 * (TRI_NO_MEMORY, TRI_TOO_LARGE) or was stopped (TRI_STOPPED) is a valid mesh. TRI_BAD_INPUT: see tri_pslg_check and
 * tri_reconstruct. The PSLG is only read. */
enum tri_status tri_generate(struct tri_mesh *mesh, const struct tri_pslg *pslg, const struct tri_options *options,
                             struct tri_report *report, struct tri_error *error);

#endif
