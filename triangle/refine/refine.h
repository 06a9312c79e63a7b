/* Quality refinement: the one loop that inserts points until no triangle is bad.
 *
 * Its callers: the whole mesh (no gate, no fence), a coarser pre-refinement, one block of cells of a schedule. `sched/`
 * gives each block a fence, which bounds what the call may touch, and sets no gate: that is the same test for other
 * schedules, by the place of the new point. A bad triangle that the gate refuses, or whose cavity reaches beyond the
 * fence, stays as it is and is counted; a later call finds it again.
 *
 * THEOREM (serialisation). A call with a fence changes only triangles whose three corners lie in the fence's half-open
 * box, and the link across their border. Calls with disjoint boxes may run at the same time on views of one mesh: the
 * result is that of running them one after the other, in any order. */
#ifndef TRIANGLE_REFINE_REFINE_H
#define TRIANGLE_REFINE_REFINE_H

#include "triangle/base/executor.h"
#include "triangle/mesh/fence.h"
#include "triangle/mesh/mesh.h"
#include "triangle/size/feature_size.h"
#include "triangle/size/quality.h"

/* May the bad triangle whose new point would be p (its circumcentre or off-centre) be refined now? */
typedef bool tri_gate(void *user, const double p[2]);

/* Told of each triangle that is deferred: the gate or the fence left it as it is. Its number may live another life
 * before the call ends. */
typedef void tri_deferred(void *user, tri_triangle_id triangle);

/* Makes room for so many points in a mesh that is a view of shared arrays: moves its counts and capacities to an unused
 * range that has room for one, and sees to it that calls for one point each will find room for the others. A point
 * takes a vertex, two triangles and a subsegment at most; of many, only the first may take a subsegment. TRI_NO_ROOM:
 * not now. */
typedef enum tri_status tri_more_room(void *user, struct tri_mesh *mesh, int32_t points, struct tri_error *error);

/* Callbacks of a caller that holds only part of a mesh (TRI_BEYOND). changed: these triangles have just been made.
 * beyond: the call returns TRI_NO_ROOM, since what lies behind an edge has to be known, and edge[] are its ends. */
struct tri_part {
    void (*changed)(void *user, const tri_triangle_id *triangle, int32_t n);
    void (*beyond)(void *user, const tri_vertex_id edge[2]);
    void *user;
};

/* Of the bad triangles only those with corners v that this says yes to are refined. */
typedef bool tri_urgent(void *user, const struct tri_point *xy, const tri_vertex_id v[3]);

/* Told of each vertex of a coarser mesh that was erased, and of the two triangles that are no more. */
typedef void tri_erased(void *user, tri_vertex_id v, const tri_triangle_id triangle[2]);

/* How a call is tied to what is around it. All zero: it has the whole mesh to itself. */
struct tri_refine_hooks {
    tri_urgent *urgent;    /* for pre-refinement, at circumcentres; NULL: all are urgent */
    void *urgent_user;
    tri_gate *gate;        /* NULL: every bad triangle */
    void *gate_user;
    const struct tri_fence *fence; /* NULL: the whole mesh */
    const struct tri_owners *owners; /* for asserts in debug builds that calls with disjoint fences change different
                                        triangles; NULL: none */
    const tri_triangle_id *worklist; /* [n_worklist] looked at first; NULL: all. The loop looks at all it makes, too */
    int32_t n_worklist;
    tri_deferred *deferred; /* NULL: nobody */
    void *deferred_user;
    tri_deferred *given_up; /* told of each triangle that is given up; it may be gone later. NULL: nobody */
    void *given_up_user;
    tri_erased *erased;     /* NULL: vertices of a coarser mesh stay (front.c) */
    void *erased_user;
    tri_more_room *more_room; /* NULL: the mesh's arrays grow */
    void *more_room_user;
    const struct tri_part *part; /* NULL: all of the mesh is here */
    void (*told)(void *user, int64_t triangles); /* how many triangles there are, every so often; NULL: nobody */
    void *told_user;
};

enum tri_excuse { /* why a triangle is still bad */
    TRI_EXCUSE_INPUT_ANGLE, /* at, or across from, a small angle between input segments */
    TRI_EXCUSE_NARROW_GAP,  /* between two segments so near to each other that filling the space would cost too much */
    TRI_EXCUSE_PROTECTED,   /* -Y or -YY */
    TRI_EXCUSE_LIMIT,       /* -S, or points for angles that would run away (feature_size.h) */
    TRI_EXCUSE_PRECISION,   /* features nearer to each other than coordinates can resolve */
    TRI_EXCUSE_DEFERRED,    /* gate or fence */
    TRI_EXCUSES
};

struct tri_refine_report {
    int64_t inserted_free, inserted_on_segments;
    int64_t gated, fenced;            /* triangles deferred: by the gate; since a cavity reached beyond the fence */
    int64_t given_up[TRI_EXCUSES];    /* bad triangles given up during the call, by reason; some vanish later */
    bool hit_limit;                   /* max_steiner stopped the call */
};

/* Refines until every bad triangle is given up or deferred. On TRI_NO_MEMORY, TRI_TOO_LARGE or TRI_STOPPED
 * (mesh->stop) the mesh is valid and as far as it got; after the last, once mesh->stop is NULL, another call goes on.
 * TRI_TOO_LARGE comes before anything is done if area bounds, or lengths that are a function, ask for more than a mesh
 * holds (tri_refine_check; not within a fence, nor of a part).
 * Terminates for any PSLG and any bound. Amortised O(1) a point in practice. tri_refine and tri_refine_whole, which
 * has hooks, end with smoothing (smooth.h) and set attributes; tri_refine_with does neither. */
enum tri_status tri_refine(struct tri_mesh *mesh, const struct tri_quality *quality, struct tri_refine_report *report,
                           struct tri_error *error);
enum tri_status tri_refine_whole(struct tri_mesh *mesh, const struct tri_quality *quality,
                                 const struct tri_refine_hooks *hooks, struct tri_refine_report *report,
                                 struct tri_error *error);
enum tri_status tri_refine_with(struct tri_mesh *mesh, const struct tri_quality *quality,
                                const struct tri_refine_hooks *hooks, struct tri_refine_report *report,
                                struct tri_error *error);

/* The same in pieces, for callers whose more_room may say TRI_NO_ROOM: run returns it with everything in order, and
 * goes on where it was when called again, as if there had been no pause. Meanwhile the mesh's pointers may change, and
 * a part of a mesh may grow. All are borrowed, until the refiner is freed, which may be NULL. */
struct tri_refiner;
enum tri_status tri_refiner_new(struct tri_refiner **refiner, struct tri_mesh *mesh,
                                const struct tri_quality *quality, const struct tri_refine_hooks *hooks,
                                struct tri_refine_report *report, struct tri_error *error);
enum tri_status tri_refiner_run(struct tri_refiner *refiner, struct tri_error *error);
void tri_refiner_free(struct tri_refiner *refiner);

#endif
