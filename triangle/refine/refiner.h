/* The state of a refiner, private to triangle/refine/. refine.c is the loop, feed.c fills the queue, treat.c treats
 * one bad triangle; front.c and lattice_fill.c are stages of their own. */
#ifndef TRIANGLE_REFINE_REFINER_H
#define TRIANGLE_REFINE_REFINER_H

#include "triangle/mesh/cavity.h"
#include "triangle/refine/bad_queue.h"
#include "triangle/refine/front.h"
#include "triangle/refine/refine.h"
#include "triangle/size/quality.h"

enum tri_bound_stage { FRONT_STAGE, EASY_STAGE, USUAL_STAGE, LAST_STAGE };

enum tri_step { NOT_BEGUN, FIRST_PASS, ALL_ANGLES, FILLING, SECOND_PASS, DIVIDING, ERASING, ADVANCING };

struct tri_fill;
struct tri_lattice;

struct tri_refiner {
    struct tri_mesh *mesh; /* the mesh to refine; borrowed */
    const struct tri_quality *quality; /* the requested bounds; borrowed */
    const struct tri_refine_hooks *hooks; /* borrowed */
    struct tri_refine_report *report;     /* filled during the call; borrowed */
    struct tri_error error; /* error of the current call of tri_refiner_run */
    struct tri_criterion criterion;       /* the bounds of the current stage */
    int least_exponent; /* binary exponent of mesh->limits.shortest2 */
    struct tri_cavity cavity;             /* cavity of the last search */
    struct tri_bad_queue queue;           /* bad triangles, except in FRONT_STAGE */
    bool lattice;     /* true: place points on a lattice derived from the area bound, where possible */
    double edge;      /* above 0: place points on a lattice with this edge length; 0: no such lattice */
    struct tri_fill *fill; /* state of the current lattice fill (lattice_fill.c); NULL: none */
    struct tri_front front; /* triangles that wait in FRONT_STAGE */
    bool sized;       /* true: the current triangle is refined for its size, not for its angles */
    enum tri_step step;     /* progress within the stage */
    int limit;        /* queue buckets from this one on wait for the second pass */
    int32_t next_listed, n_worklist; /* next triangle of the worklist; its length */
    enum tri_bound_stage stage;      /* current stage */
    enum tri_excuse excuse; /* reason of the last outcome REFUSED */
    bool is_pending;     /* true: the treatment of `hand` was interrupted by a pause */
    struct tri_entry hand;  /* the triangle being treated */
    tri_sub_id *encroached; /* stack of subsegments to test for encroachment (conforming), or to divide (front.c) */
    int32_t n_encroached, encroached_capacity; /* entries of `encroached`; allocated */
    uint32_t step_of_stop; /* counter of tri_stop_is_due */
};

/* Judges a triangle. A bad angle takes precedence over a bad size. In FRONT_STAGE only sizes count. With
 * hooks->urgent, triangles that it rejects are good. */
static inline enum tri_badness tri_refiner_judge(const struct tri_refiner *r, const struct tri_triangle *t,
                                                 const struct tri_shape *shape)
{
    if (r->stage == FRONT_STAGE)
        return tri_is_too_large(&r->criterion.asked, t, shape) ? TRI_BAD_SIZE : TRI_GOOD;
    enum tri_badness badness = tri_judge(&r->criterion, t, shape);
    bool counts = !r->hooks->urgent || r->hooks->urgent(r->hooks->urgent_user, r->mesh->xy, t->v);
    return counts ? badness : TRI_GOOD;
}

/* Returns the length of the worklist. Without a worklist all triangles are listed. */
static inline int32_t tri_worklist_length(const struct tri_refiner *r)
{
    return r->hooks->worklist ? r->hooks->n_worklist : r->mesh->n_triangles;
}

/* Returns triangle i of the worklist. */
static inline tri_triangle_id tri_worklist_triangle(const struct tri_refiner *r, int32_t i)
{
    return r->hooks->worklist ? r->hooks->worklist[i] : i;
}

/* The outcome of treating a bad triangle. */
enum tri_outcome {
    DONE,     /* a point was inserted, or the triangle no longer exists */
    AGAIN,    /* a subsegment was split instead; the triangle may still exist */
    REFUSED,  /* this point cannot be inserted, for the reason in `excuse`; another point may be possible */
    GIVEN_UP, /* the triangle stays bad, and has been counted */
    DEFERRED, /* the gate or the fence forbids it; a later call treats the triangle */
    FAILED    /* out of memory, no room (pause), or the caller asked to stop */
};

/* --- feed.c. These functions return false if memory ran out. */

/* Queues the triangle for its angle. shortest: its shortest squared edge length. */
bool tri_push_angle(struct tri_refiner *r, tri_triangle_id triangle, double shortest);

/* Queues the triangle if its size (`sizes` true) or its angle (`sizes` false) is bad. */
bool tri_queue_triangle(struct tri_refiner *r, tri_triangle_id triangle, bool sizes);

/* Fills the cavity with a fan of triangles around v, and queues the bad ones. */
bool tri_fill_and_queue(struct tri_refiner *r, tri_vertex_id v);

/* Queues the bad triangles of the fan that has just filled the cavity. */
bool tri_queue_fan(struct tri_refiner *r);

/* For -D: push onto the stack of subsegments to test for encroachment. In this order: subsegment s, the subsegments
 * on the sides of a triangle, the walls of the cavity. */
bool tri_queue_subsegment(struct tri_refiner *r, tri_sub_id s);
bool tri_queue_beside(struct tri_refiner *r, tri_triangle_id triangle);
bool tri_queue_walls(struct tri_refiner *r);

/* --- front.c */

/* Prepares the front stage: divides segments, erases coarse vertices, lists the triangles that are too large.
 * Returns false on failure or if there is no room; call it again to resume. */
bool tri_front_begin(struct tri_refiner *r);

/* Sets r->hand to the next triangle. Returns false if none is waiting. */
bool tri_front_next(struct tri_refiner *r);

/* Queues new triangles that are too large, and neighbours that now lie on the front. Returns false if memory ran
 * out. */
bool tri_front_queue_fan(struct tri_refiner *r);

/* Returns the point to insert for a triangle that is too large. */
struct tri_point tri_front_place(const struct tri_refiner *r, tri_triangle_id triangle, const struct tri_shape *shape);

/* --- lattice_fill.c */

/* May this call fill parts of the mesh with lattice cells? */
bool tri_may_fill_lattice(const struct tri_refiner *r);

/* Replaces triangles of the worklist and of the queue that are too large by lattice cells. Returns false on failure
 * or if there is no room; call it again to resume. */
bool tri_fill_lattice(struct tri_refiner *r);
void tri_fill_free(struct tri_refiner *r);

/* --- treat.c */

/* Makes room for this many points. */
enum tri_status tri_make_room(struct tri_refiner *r, int32_t points);

/* Adds a vertex. There must be room for it. on: as tri_mesh.on. */
tri_vertex_id tri_add_vertex(struct tri_refiner *r, struct tri_point p, int32_t on, int32_t marker);

/* Requests the part of the mesh beyond an edge. When it has arrived, the caller's step is tried again. Returns
 * FAILED. */
enum tri_outcome tri_request_beyond(struct tri_refiner *r, const tri_vertex_id edge[2]);

/* Inserts the lattice point p, which lies in the triangle, or splits a subsegment that p encroaches (AGAIN).
 * REFUSED: p is too close to a vertex or a subsegment, or the fence forbids it. */
enum tri_outcome tri_insert_in_lattice(struct tri_refiner *r, tri_triangle_id triangle, struct tri_point p,
                                       const struct tri_lattice *lattice);

/* Splits a subsegment at this fraction of its length. If that is impossible, no triangle is counted as deferred or
 * given up. */
enum tri_outcome tri_divide_at(struct tri_refiner *r, tri_sub_id s, double fraction);

/* Treats one bad triangle until it is gone, given up or deferred. FAILED: the triangle has not changed. */
enum tri_outcome tri_treat(struct tri_refiner *r, struct tri_entry entry);

/* Splits the waiting subsegments until none of them has a vertex in its diametral circle. Returns false on failure
 * or a pause; r->error holds the reason, or TRI_OK if memory ran out. */
bool tri_split_encroached(struct tri_refiner *r);

/* Reports progress. Returns true if the run must stop. To be called between two insertions, when the mesh is valid. */
bool tri_refiner_must_stop(struct tri_refiner *r);

#endif
