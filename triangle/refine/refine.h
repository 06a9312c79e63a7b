/* Quality refinement: the one loop that inserts points until no triangle is bad.
 *
 * Its callers: the whole mesh (no gate, no fence), a coarser pre-refinement, one block of cells of a schedule (gate =
 * is the new point in a cell that is active now?, fence = what may be touched). A bad triangle that the gate refuses,
 * or whose cavity reaches beyond the fence, stays as it is and is counted; whoever calls again later finds it again.
 *
 * THEOREM (serialisation). A call with a fence changes only triangles whose three corners lie in the fence's half-open
 * box, and the link across their border. Calls with disjoint boxes may run at the same time on views of one mesh: the
 * result is that of running them one after the other, in any order. */
#ifndef TRIANGLE_REFINE_REFINE_H
#define TRIANGLE_REFINE_REFINE_H

#include "triangle/base/executor.h"
#include "triangle/mesh/fence.h"
#include "triangle/mesh/mesh.h"
#include "triangle/mesh/owners.h"
#include "triangle/tunables.h"

/* Non-zero: the triangle a, b, c (counter-clockwise) must be refined. Called for triangles that satisfy all other size
 * bounds, by par_refine also for others (sched/schedule/schedule.h). */
typedef int tri_unsuitable(void *user, const double a[2], const double b[2], const double c[2], double area);

/* May the bad triangle whose new point would be p (its circumcentre or off-centre) be refined now? */
typedef bool tri_gate(void *user, const double p[2]);

/* Told of each triangle that is deferred: the gate or the fence left it as it is. Its number may live another life
 * before the call ends. */
typedef void tri_deferred(void *user, tri_triangle_id triangle);

/* Makes room for at least 2 triangles, 1 vertex and 1 subsegment more in a mesh that is a view of shared arrays: moves
 * its counts and capacities to an unused range. TRI_NO_ROOM: not now. */
typedef enum tri_status tri_more_room(void *user, struct tri_mesh *mesh, struct tri_error *error);

/* Who works on a part of a mesh (TRI_BEYOND). changed: these triangles have just been made. beyond: the call returns
 * TRI_NO_ROOM, since what lies behind an edge has to be known, and edge[] are its ends. */
struct tri_part {
    void (*changed)(void *user, const tri_triangle_id *triangle, int32_t n);
    void (*beyond)(void *user, const tri_vertex_id edge[2]);
    void *user;
};

struct tri_refine_options {
    double min_angle;      /* degrees; 0: no bound on angles; above 38 as 38 */
    double max_area;       /* <= 0: none */
    bool region_areas;     /* mesh->regions[t.region].max_area applies too */
    double area_scale;     /* > 0: all area bounds are multiplied by this, for pre-refinement, and the size test is
                              asked about triangles that are smaller by this; 0: as they are */
    bool conforming;       /* -D: no vertex inside the diametral circle of a subsegment */
    int protect;           /* 1: boundary subsegments are not split (-Y); 2: no subsegment is (-YY) */
    int64_t max_steiner;   /* < 0: no limit on the points inserted */
    tri_unsuitable *unsuitable;
    void *unsuitable_user;
    tri_unsuitable *urgent; /* not NULL: of the bad triangles only those that this says yes to are refined, at their
                               circumcentres: for pre-refinement */
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
    tri_more_room *more_room; /* NULL: the mesh's arrays grow */
    void *more_room_user;
    const struct tri_part *part; /* NULL: all of the mesh is here */
    void (*told)(void *user, int64_t triangles); /* how many triangles there are, every so often; NULL: nobody */
    void *told_user;
};

/* Is there any bound on sizes? */
static inline bool tri_has_sizes(const struct tri_refine_options *options)
{
    return options->max_area > 0 || options->region_areas || options->unsuitable;
}

static inline double tri_area_scale(const struct tri_refine_options *options)
{
    return options->area_scale > 0 ? options->area_scale : 1;
}

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

struct tri_refine_options tri_refine_defaults(void);

/* Refines until every bad triangle is given up or deferred. On TRI_NO_MEMORY, TRI_TOO_LARGE or TRI_STOPPED
 * (mesh->stop) the mesh is valid and as far as it got; after the last, once mesh->stop is NULL, another call goes on.
 * TRI_TOO_LARGE comes before anything is done where area bounds ask for more than a mesh holds (tri_refine_check; not
 * asked within a fence, and of a part).
 * Terminates for any PSLG and any bound. Amortised O(1) a point in practice. */
enum tri_status tri_refine(struct tri_mesh *mesh, const struct tri_refine_options *options,
                           struct tri_refine_report *report, struct tri_error *error);

/* The same in pieces, for callers whose more_room may say TRI_NO_ROOM: run returns it with everything in order, and
 * goes on where it was when called again, as if there had been no pause. Meanwhile the mesh's pointers may change, and
 * a part of a mesh may grow. The mesh, the options and the report are borrowed, until the refiner is freed, which may
 * be NULL. */
struct tri_refiner;
enum tri_status tri_refiner_new(struct tri_refiner **refiner, struct tri_mesh *mesh,
                                const struct tri_refine_options *options, struct tri_refine_report *report,
                                struct tri_error *error);
enum tri_status tri_refiner_run(struct tri_refiner *refiner, struct tri_error *error);
void tri_refiner_free(struct tri_refiner *refiner);

#endif
