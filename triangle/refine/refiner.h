/* The state of a refiner, private to its three files: refine.c is the loop, feed.c fills its queue, treat.c treats one
 * bad triangle. */
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
    struct tri_mesh *mesh;
    const struct tri_quality *quality;
    const struct tri_refine_hooks *hooks;
    struct tri_refine_report *report;
    struct tri_error error; /* of the run that is on */
    struct tri_criterion criterion;
    int least_exponent; /* of mesh->limits.shortest2 */
    struct tri_cavity cavity;
    struct tri_bad_queue queue;
    bool lattice;     /* points lie in a lattice where they can, by the bound on areas, .. */
    double edge;      /* .. or, above 0, in one with edges of this length */
    struct tri_fill *fill; /* cells of the lattice at work (lattice_fill.c); NULL: none */
    struct tri_front front; /* what waits in FRONT_STAGE */
    bool sized;       /* the triangle in hand asks for a point because of sizes, not of angles */
    enum tri_step step;
    int limit;        /* buckets from here on wait for the second pass */
    int32_t next_listed, n_worklist;
    enum tri_bound_stage stage;
    enum tri_excuse excuse; /* of the last refusal */
    bool in_hand;     /* `hand` was being treated when there was no room */
    struct tri_entry hand;
    tri_sub_id *encroached; /* stack of subsegments to test for encroachment (conforming), or to divide (front.c) */
    int32_t n_encroached, encroached_capacity;
    uint32_t step_of_stop; /* see tri_stop_is_due */
};

/* A bad angle counts before a bad size, in FRONT_STAGE not at all; what is not urgent (tri_refine_hooks) is good. */
static inline enum tri_badness tri_refiner_judge(const struct tri_refiner *r, const struct tri_triangle *t,
                                                 const struct tri_shape *shape)
{
    if (r->stage == FRONT_STAGE)
        return tri_is_too_large(&r->criterion.asked, t, shape) ? TRI_BAD_SIZE : TRI_GOOD;
    enum tri_badness badness = tri_judge(&r->criterion, t, shape);
    bool counts = !r->hooks->urgent || r->hooks->urgent(r->hooks->urgent_user, r->mesh->xy, t->v);
    return counts ? badness : TRI_GOOD;
}

/* How many triangles the worklist has; without one it is all of the mesh. */
static inline int32_t tri_count_listed(const struct tri_refiner *r)
{
    return r->hooks->worklist ? r->hooks->n_worklist : r->mesh->n_triangles;
}

/* Triangle i of the worklist. */
static inline tri_triangle_id tri_listed(const struct tri_refiner *r, int32_t i)
{
    return r->hooks->worklist ? r->hooks->worklist[i] : i;
}

/* How the treatment of a bad triangle ended. */
enum tri_outcome {
    DONE,     /* a point was inserted, or the triangle is gone */
    AGAIN,    /* a subsegment was split instead, and the triangle may still stand */
    REFUSED,  /* this point cannot be had, for the reason in `excuse`; perhaps another one can */
    GIVEN_UP, /* it stays, and has been counted */
    DEFERRED, /* the gate or the fence stands before it: somebody else's */
    FAILED    /* no memory, no room, or somebody asks for the end */
};

/* --- feed.c. False: no memory. */

/* Queues the triangle, whose shortest edge squared this is, for its angle. */
bool tri_push_angle(struct tri_refiner *r, tri_triangle_id triangle, double shortest);

/* Queues the triangle if it is bad, by its size or by its angle. */
bool tri_feed_triangle(struct tri_refiner *r, tri_triangle_id triangle, bool sizes);

/* Fills the cavity with the fan of vertex v, and queues what is bad among its triangles. */
bool tri_fill_and_feed(struct tri_refiner *r, tri_vertex_id v);

/* Queues what is bad among the new triangles, once a cavity has been filled. */
bool tri_feed_fan(struct tri_refiner *r);

/* For -D: to be tested for encroachment. A subsegment; those beside a triangle; the walls of the cavity. */
bool tri_feed_subsegment(struct tri_refiner *r, tri_sub_id s);
bool tri_feed_beside(struct tri_refiner *r, tri_triangle_id triangle);
bool tri_feed_walls(struct tri_refiner *r);

/* --- front.c */

/* Makes ready what the stage works off. Resumable: false means that something failed, or that there was no room. */
bool tri_front_begin(struct tri_refiner *r);

/* Takes the next triangle into the hand; false: none waits. */
bool tri_front_next(struct tri_refiner *r);

/* Queues what is too large, or on the front, among the new triangles and beside them. False: no memory. */
bool tri_front_feed(struct tri_refiner *r);

/* The point of a triangle that is too large. */
struct tri_point tri_front_place(const struct tri_refiner *r, tri_triangle_id triangle, const struct tri_shape *shape);

/* --- lattice_fill.c */

/* May the call make cells of a lattice? */
bool tri_wants_cells(const struct tri_refiner *r);

/* Makes cells of the lattice in the triangles of the worklist and of the queue that are too large. Resumable: false
 * means that something failed, or that there was no room. */
bool tri_fill_lattice(struct tri_refiner *r);
void tri_fill_free(struct tri_refiner *r);

/* --- treat.c */

/* Makes room for so many points. */
enum tri_status tri_make_room(struct tri_refiner *r, int32_t points);

/* Adds a vertex, for which there is room. on: as tri_mesh.on. */
tri_vertex_id tri_add_vertex(struct tri_refiner *r, struct tri_point p, int32_t on, int32_t marker);

/* Asks for what lies beyond an edge; the same is tried again when it is there. Returns FAILED. */
enum tri_outcome tri_wait_for(struct tri_refiner *r, const tri_vertex_id edge[2]);

/* Inserts p, a lattice point in a triangle, or splits a subsegment that it encroaches (AGAIN). REFUSED: something is
 * too near to it, or the fence. */
enum tri_outcome tri_insert_in_lattice(struct tri_refiner *r, tri_triangle_id triangle, struct tri_point p,
                                       const struct tri_lattice *lattice);

/* Splits a subsegment there, and tells nobody where that cannot be. */
enum tri_outcome tri_divide_at(struct tri_refiner *r, tri_sub_id s, double fraction);

/* Treats one bad triangle until it is gone, given up or deferred. FAILED: it is as it was. */
enum tri_outcome tri_treat(struct tri_refiner *r, struct tri_entry entry);

/* Splits subsegments until no vertex lies in the circle of one that waits. False: r->error says why not, or no
 * memory. */
bool tri_split_encroached(struct tri_refiner *r);

/* Reports progress; true if the run must stop. Between two points the mesh is in order. */
bool tri_refiner_must_stop(struct tri_refiner *r);

#endif
