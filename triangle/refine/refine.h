/* Delaunay refinement: inserts points until no triangle violates the bounds.
 *
 * One loop serves three kinds of calls: the whole mesh (no gate, no fence), a coarse pre-refinement, and one block
 * of cells of a parallel schedule. The schedule in `sched/` gives each block a fence, which bounds the triangles
 * that the call may change. A gate makes the same decision from the position of the new point; it is for other
 * schedules. If the gate refuses a bad triangle, or its cavity reaches beyond the fence, the triangle is deferred:
 * it stays as it is and is counted. A later call finds it again.
 *
 * THEOREM (serialisation). A call with a fence changes only triangles whose three corners lie in the fence's
 * half-open box, and the links across the border of these triangles. Calls with disjoint boxes may run at the same
 * time on views of one mesh. The result equals that of running them one after the other, in any order. */
#ifndef TRIANGLE_REFINE_REFINE_H
#define TRIANGLE_REFINE_REFINE_H

#include "triangle/base/executor.h"
#include "triangle/mesh/fence.h"
#include "triangle/mesh/mesh.h"
#include "triangle/size/feature_size.h"
#include "triangle/size/quality.h"

/* May a bad triangle be refined now? p: its proposed new point (circumcentre or off-centre). */
typedef bool tri_gate(void *user, const double p[2]);

/* Called for each triangle that is deferred because of the gate or the fence. Later in the call the triangle may be
 * deleted and its number reused. */
typedef void tri_deferred(void *user, tri_triangle_id triangle);

/* Makes room for the given number of points in a mesh that is a view of shared arrays. Moves the view's counts and
 * capacities to an unused range that has room for at least one point, and guarantees that later calls for one point
 * each find room for the rest. A point adds at most one vertex, two triangles and one subsegment. If `points` is
 * above 1, only the first point may add a subsegment. Returns TRI_NO_ROOM if there is no room now. */
typedef enum tri_status tri_more_room(void *user, struct tri_mesh *mesh, int32_t points, struct tri_error *error);

/* Callbacks of a caller that holds only part of a mesh (TRI_BEYOND).
 * - changed: these triangles have just been created.
 * - beyond: the neighbour of the edge with ends edge[0] and edge[1] is needed but is not in this part. The call then
 *   returns TRI_NO_ROOM. */
struct tri_part {
    void (*changed)(void *user, const tri_triangle_id *triangle, int32_t n);
    void (*beyond)(void *user, const tri_vertex_id edge[2]);
    void *user; /* passed to both */
};

/* Should the bad triangle with corners v be refined? Bad triangles for which this returns false are treated as good. */
typedef bool tri_urgent(void *user, const struct tri_point *xy, const tri_vertex_id v[3]);

/* Called for each vertex of a coarse mesh that was erased, with the two triangles that were deleted. */
typedef void tri_erased(void *user, tri_vertex_id v, const tri_triangle_id triangle[2]);

/* Connects a call to its surroundings. If all members are zero, the call has the whole mesh to itself. */
struct tri_refine_hooks {
    tri_urgent *urgent;    /* selects triangles for pre-refinement at circumcentres; NULL: all */
    void *urgent_user;     /* passed to urgent */
    tri_gate *gate;        /* NULL: no gate, every bad triangle may be refined */
    void *gate_user;       /* passed to gate */
    const struct tri_fence *fence; /* NULL: no fence, the whole mesh may change */
    const struct tri_owners *owners; /* debug builds assert with it that calls with disjoint fences change different
                                        triangles; NULL: no check */
    const tri_triangle_id *worklist; /* [n_worklist] triangles to judge first; NULL: all. New triangles are always
                                        judged */
    int32_t n_worklist;     /* triangles in worklist */
    tri_deferred *deferred; /* called for each deferred triangle; NULL: not called */
    void *deferred_user;    /* passed to deferred */
    tri_deferred *given_up; /* called for each triangle given up, which may vanish later; NULL: not called */
    void *given_up_user;    /* passed to given_up */
    tri_erased *erased;     /* called for each erased vertex; NULL: no vertex is erased (front.c) */
    void *erased_user;      /* passed to erased */
    tri_more_room *more_room; /* NULL: the mesh's arrays grow as needed */
    void *more_room_user;     /* passed to more_room */
    const struct tri_part *part; /* NULL: the call has the whole mesh, not a part */
    void (*told)(void *user, int64_t triangles); /* progress: called periodically with the number of triangles; NULL:
                                                    no */
    void *told_user;                             /* passed to told */
};

enum tri_excuse { /* the reason why a triangle is still bad */
    TRI_EXCUSE_INPUT_ANGLE, /* touches a small angle between input segments, or lies across from its vertex */
    TRI_EXCUSE_NARROW_GAP,  /* lies in a narrow gap between two segments, and filling the gap would need too many
                               points */
    TRI_EXCUSE_PROTECTED,   /* -Y or -YY forbids to split a segment here */
    TRI_EXCUSE_LIMIT,       /* -S is reached, or the angle bound would need points without end here
                               (feature_size.h) */
    TRI_EXCUSE_PRECISION,   /* features are closer together than coordinates can resolve */
    TRI_EXCUSE_DEFERRED,    /* deferred because of the gate or the fence */
    TRI_EXCUSES
};

struct tri_refine_report {
    int64_t inserted_free, inserted_on_segments; /* new vertices off and on segments */
    int64_t gated, fenced;            /* triangles deferred by the gate; by the fence, which their cavity crosses */
    int64_t given_up[TRI_EXCUSES];    /* bad triangles given up during the call, by reason; some vanish later */
    bool hit_limit;                   /* true: the limit max_steiner ended the call */
};

/* Refines until every bad triangle is fixed, given up or deferred. After TRI_NO_MEMORY, TRI_TOO_LARGE or TRI_STOPPED
 * (mesh->stop) the mesh is valid but only partly refined. After TRI_STOPPED, set mesh->stop to NULL and call again
 * to continue. TRI_TOO_LARGE is returned before the mesh is changed, if area bounds or a length function need more
 * triangles than a mesh can hold (tri_refine_check). Calls with a fence and calls for a part of a mesh skip this
 * check.
 *
 * Terminates for any PSLG and any bound. In practice the time per point is amortised O(1). tri_refine and
 * tri_refine_whole end with smoothing (smooth.h) and set attributes; tri_refine_with does neither. tri_refine has no
 * hooks. */
enum tri_status tri_refine(struct tri_mesh *mesh, const struct tri_quality *quality, struct tri_refine_report *report,
                           struct tri_error *error);
enum tri_status tri_refine_whole(struct tri_mesh *mesh, const struct tri_quality *quality,
                                 const struct tri_refine_hooks *hooks, struct tri_refine_report *report,
                                 struct tri_error *error);
enum tri_status tri_refine_with(struct tri_mesh *mesh, const struct tri_quality *quality,
                                const struct tri_refine_hooks *hooks, struct tri_refine_report *report,
                                struct tri_error *error);

/* The same in steps, for callers whose more_room may return TRI_NO_ROOM. tri_refiner_run then returns TRI_NO_ROOM
 * with a valid mesh, and continues when it is called again, with the same result as without the pause. During a
 * pause the mesh's pointers may change, and a part of a mesh may grow. All arguments are borrowed until
 * tri_refiner_free, which accepts NULL. */
struct tri_refiner;
enum tri_status tri_refiner_new(struct tri_refiner **refiner, struct tri_mesh *mesh,
                                const struct tri_quality *quality, const struct tri_refine_hooks *hooks,
                                struct tri_refine_report *report, struct tri_error *error);
enum tri_status tri_refiner_run(struct tri_refiner *refiner, struct tri_error *error);
void tri_refiner_free(struct tri_refiner *refiner);

#endif
