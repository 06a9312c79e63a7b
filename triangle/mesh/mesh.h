/* The mesh: flat index arrays that every stage of the triangulator works on.
 *
 * A triangle is 32 bytes: three corners counter-clockwise, three links, a region, a life. Link e lies opposite corner
 * e.
 *   link >= 0   code 4 * t + f: the neighbour is triangle t, and its edge f is the same edge seen from the other side;
 *   link <  0   ~s: the edge is subsegment s, whose record names the triangle on either side.
 * INVARIANT (links): for every live triangle t and edge e, either link(link(t, e)) == (t, e), or the subsegment behind
 * the link has (t, e) on the side that its direction says. Every edge of the outer boundary is a subsegment. So a
 * search that must not cross constrained edges stops at a sign bit, and loads nothing for it; unconstrained triangles
 * pay nothing for constraints, markers and parents.
 *
 * TRI_BEYOND is the link out of a part of a mesh. A search that meets it says so, and is repeated once there is more.
 *
 * Vertices are x, y pairs; attributes, markers and parents lie apart, since only new vertices touch them. Corners are
 * ids below 2^28, triangles below 2^29 (4 * t + e is a non-negative int32_t). */
#ifndef TRIANGLE_MESH_MESH_H
#define TRIANGLE_MESH_MESH_H

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "triangle/base/executor.h"
#include "triangle/base/ids.h"
#include "triangle/base/status.h"
#include "triangle/geometry/shape.h"
#include "triangle/mesh/pslg.h"

enum {
    TRI_NONE = -1,        /* no triangle on this side of a subsegment; no vertex; no parent */
    TRI_BEYOND = INT32_MIN /* a link, or a side of a subsegment, to a triangle in another address space: see above */
};

enum tri_vertex_kind { /* values of tri_mesh.on below 0 */
    TRI_VERTEX_INPUT = -1, /* a point of the input, or a crossing of two of its segments */
    TRI_VERTEX_FREE = -2,  /* made by refinement in the interior of a region */
    TRI_VERTEX_ACUTE = -3, /* as TRI_VERTEX_INPUT, and two subsegments meet there at less than 60 degrees */
    TRI_VERTEX_NONE = -4   /* no vertex: an id that is free (only until par_number) */
    /* >= 0: made by refinement, on the parent with this id */
};

struct tri_triangle {
    tri_vertex_id v[3];   /* corners, counter-clockwise; v[0] == TRI_NONE: the number is free */
    tri_link n[3];        /* links, see above */
    tri_region_id region;
    uint32_t life;        /* counts the lives of this number: by it a queue entry tells whether it is still this one */
};

struct tri_subsegment {
    tri_vertex_id v[2];   /* from, to */
    tri_halfedge side[2]; /* left of v[0] -> v[1], and right of it; TRI_NONE where there is no triangle */
    int32_t marker;       /* marker of the input segment, 0 where it has none */
    tri_parent_id parent; /* TRI_NONE only in a record that is free (see par_number) */
};

/* A segment: the parent of the subsegments that refinement splits it into. Splitting, shells and small input angles
 * refer to it. */
struct tri_parent {
    tri_vertex_id v[2];
    int32_t segment; /* the input segment that it is a part of, the first of several; TRI_NONE: of the hull alone */
    bool odd;        /* after tri_constrain: an odd number of input segments run along it */
    bool reversed;   /* its subsegments run against its input segment, until the mesh is finished */
    struct tri_point guard; /* with the ends, a triangle outside that is the parent's own, see split.c; NaN: all is; the
                               first end: of a mesh that was read */
};

/* Which parents end at each vertex that there was when they were listed (triangle/mesh/parents.h). Those at vertex v
 * are parent[start[v] .. start[v + 1]); where they are many, in order of direction. */
struct tri_incidence {
    tri_parent_id *parent; /* [2 * n_parents] */
    int32_t *start;        /* [n_vertices + 2], the last for filling */
    int32_t n_vertices;    /* 0: not listed yet */
};

/* Where refinement leaves a bad triangle as it is (triangle/size/feature_size.h). */
struct tri_limits {
    double finest2;     /* square of the shortest edge that coordinates of this size can carry */
    double shortest2;   /* the same where rounding reaches further: what is nearer than its root is no feature */
    double dearest_gap; /* narrow spaces between parents that would cost more points than this are not filled */
    double gap_points;  /* about so many points those that are filled take */
};

struct tri_region {
    double attribute;
    double max_area; /* <= 0: none */
};

/* The arrays that grow with refinement. */
enum tri_array {
    TRI_XY, TRI_ON, TRI_MARKERS, TRI_FEATURE, TRI_LENGTH, TRI_ATTRIBUTES, TRI_TRIANGLES, TRI_SUBS, TRI_ARRAYS
};

/* Where these arrays are, if not in memory from malloc. */
struct tri_storage {
    /* Gives the array room for at least so many bytes, and keeps what is in it. Returns where it begins, at a page;
     * NULL: there is no room. */
    void *(*reserve)(void *user, enum tri_array array, size_t bytes);
    /* Copies so many bytes to the beginning of the array, of which no more than a little is in memory at a time. False:
     * there is no room. */
    bool (*fill)(void *user, enum tri_array array, const void *from, size_t bytes);
    /* Returns so many bytes for a work array that grows with the mesh, until extra_free; NULL: there is no room, and
     * errno says why. */
    void *(*extra)(void *user, size_t bytes);
    void (*extra_free)(void *user, void *extra);
    void *user;
    /* Of what has been read or written of the extras no more than a little needs to be in memory any longer; by any
     * thread. NULL: the storage sees to that by itself. */
    void (*let_go)(const void *user);
};

struct tri_mesh;
struct tri_surface;

/* A bound on the memory that these arrays take. */
struct tri_bound {
    /* Asked before they grow: may they take so many bytes? */
    bool (*allows)(void *user, const struct tri_mesh *mesh, size_t bytes);
    /* Called if not: moves them to a storage (tri_mesh_move), or returns the error of the call that wanted more. */
    enum tri_status (*leave)(void *user, struct tri_mesh *mesh, struct tri_error *error);
    void *user;
};

struct tri_mesh {
    struct tri_point *xy;     /* [n_vertices] */
    int32_t *on;              /* [n_vertices] kind or parent, see tri_vertex_kind */
    int32_t *vertex_markers;  /* [n_vertices] */
    double *feature;          /* [n_vertices] size of the features around, once refinement has begun (feature_size.h):
                                 what each new vertex inherits, and takes along wherever it goes */
    double *length;           /* [n_vertices] of edges that is asked for there, in the units of the mesh (quality.h);
                                 below 0: of a vertex that was made for a coarser mesh. NULL: none is asked for */
    double *attributes;       /* [n_vertices][n_attributes]; those of new vertices are set last */
    struct tri_surface *surface; /* where they come from (surface.h); NULL: no attributes, or nothing refined yet */
    int32_t n_attributes;
    bool has_lengths;         /* length is kept */
    int32_t n_vertices, vertex_capacity;
    int32_t n_input;          /* the first n_input vertices are the caller's points, in the caller's order .. */
    int32_t *origin;          /* [n_input] .. unless this is set: the caller's index of each (triangle/cdt/spatial.h) */
    int32_t *twin;            /* [n_input] first (by the caller) of the points here; NULL: no duplicates */

    struct tri_triangle *tri; /* [n_triangles], aligned to a cache line; some may be free (v[0] == TRI_NONE) */
    int32_t n_triangles, triangle_capacity;

    struct tri_subsegment *sub; /* [n_subs] */
    int32_t n_subs, sub_capacity;
    struct tri_parent *parents; /* [n_parents] */
    int32_t n_parents, parent_capacity;
    /* What refinement has to know of the input (triangle/size/feature_size.h): found once, asked by every call on this
     * mesh, and true as long as its parents are. */
    struct tri_incidence incidence; /* parents at each vertex of the input */
    struct tri_limits limits;

    struct tri_region *regions; /* [n_regions] regions[0] is "no region": attribute 0, no bound */
    int32_t n_regions;
    double *columns;          /* [n_regions][n_columns] attributes of the triangles in a region, where the mesh was made
                                 from triangles that had some; else NULL, and n_columns is 0 */
    int32_t n_columns;

    double unit;              /* a power of two: the caller's coordinates are xy * unit */

    const struct tri_storage *storage; /* borrowed; NULL: malloc */
    const struct tri_bound *bound;     /* asked before they grow there; borrowed; NULL: nobody */
    const struct tri_stop *stop; /* whoever works on the mesh asks it whether to go on; borrowed; NULL: nobody */
};

static inline tri_halfedge tri_code(tri_triangle_id t, int e) { return t << 2 | e; }
static inline tri_triangle_id tri_of(tri_halfedge code) { return code >> 2; }
static inline int tri_edge(tri_halfedge code) { return code & 3; }

static inline bool tri_is_live(const struct tri_triangle *t) { return t->v[0] >= 0; }

static inline struct tri_point tri_point_between(struct tri_point a, struct tri_point b, double fraction)
{
    struct tri_point p = {tri_round_coordinate(a.x + fraction * (b.x - a.x)),
                          tri_round_coordinate(a.y + fraction * (b.y - a.y))};
    return p;
}

/* The attributes of the triangles in a region: n_columns of them, or one where that is 0. */
static inline const double *tri_region_attributes(const struct tri_mesh *mesh, tri_region_id region)
{
    return mesh->columns ? mesh->columns + (size_t)region * (size_t)mesh->n_columns : &mesh->regions[region].attribute;
}

/* A vertex in the caller's coordinates. */
static inline void tri_mesh_place(const struct tri_mesh *mesh, tri_vertex_id v, double at[2])
{
    at[0] = mesh->xy[v].x * mesh->unit;
    at[1] = mesh->xy[v].y * mesh->unit;
}

/* A place given in the caller's coordinates, in the mesh's. A vertex is in range then; any other place may be out of
 * it, or even infinite: tri_is_in_range has to be asked before a predicate sees it. */
static inline struct tri_point tri_to_units(const struct tri_mesh *mesh, double x, double y)
{
    struct tri_point p = {tri_round_coordinate(x / mesh->unit), tri_round_coordinate(y / mesh->unit)};
    return p;
}

/* Makes an empty mesh; regions[0] exists. Frees everything and zeroes the struct. */
enum tri_status tri_mesh_init(struct tri_mesh *mesh, struct tri_error *error);
void tri_mesh_free(struct tri_mesh *mesh);

/* Memory for something as large as the mesh, where the mesh is. NULL: there is none. */
void *tri_mesh_extra(const struct tri_mesh *mesh, size_t bytes);
void tri_mesh_extra_free(const struct tri_mesh *mesh, void *extra);

/* Bytes in use of the arrays that grow with refinement. */
size_t tri_mesh_bytes_used(const struct tri_mesh *mesh);

/* Bytes of these arrays for a triangle, to the order: two triangles have one vertex. An attribute takes 8 bytes, and
 * half of that again when vertices are moved. */
static inline double tri_mesh_bytes_each(int32_t n_attributes)
{
    const double vertex = sizeof(struct tri_point) + 2 * sizeof(int32_t) + sizeof(double) + 12.0 * n_attributes;
    return sizeof(struct tri_triangle) + vertex / 2;
}

/* The arrays that grow with refinement. Move: to a storage, which the mesh borrows from then on. Copy: *copy has
 * another such mesh's, in memory from malloc, and nothing else. Swap: two meshes change theirs, and the counts of them.
 * Drop: there are none any more, nor points of the input. TRI_NO_MEMORY: the mesh is as before, *copy has nothing. */
enum tri_status tri_mesh_move(struct tri_mesh *mesh, const struct tri_storage *storage, struct tri_error *error);
enum tri_status tri_mesh_copy(struct tri_mesh *copy, const struct tri_mesh *mesh, struct tri_error *error);
void tri_mesh_swap(struct tri_mesh *a, struct tri_mesh *b);
void tri_mesh_drop(struct tri_mesh *mesh);

/* Room for at least so many more items; amortised O(1) an item. Pointers into the arrays are stale afterwards. */
enum tri_status tri_mesh_reserve_vertices(struct tri_mesh *mesh, int32_t more, struct tri_error *error);
enum tri_status tri_mesh_reserve_triangles(struct tri_mesh *mesh, int32_t more, struct tri_error *error);
enum tri_status tri_mesh_reserve_subs(struct tri_mesh *mesh, int32_t more, struct tri_error *error);

/* From here on the mesh has `length`, or no longer. What is in it is the caller's to set. */
enum tri_status tri_mesh_have_lengths(struct tri_mesh *mesh, bool has, struct tri_error *error);

/* Takes over points, attributes and markers of the PSLG as vertices 0 .. n_points - 1, and chooses mesh->unit so that
 * all coordinates lie in the range of the exact predicates; what is smaller than 2^-216 units is rounded to multiples
 * of 2^-268. So the caller's coordinates of every vertex that there will be are exact: no rounding folds a mesh. But
 * where the largest one is subnormal: TRI_BAD_INPUT. */
enum tri_status tri_mesh_take_points(struct tri_mesh *mesh, const struct tri_pslg *pslg,
                                     const struct tri_executor *executor, struct tri_error *error);

/* Appends a subsegment between two vertices and a parent for it; the caller links its sides. Room must have been
 * reserved. */
tri_sub_id tri_mesh_add_sub(struct tri_mesh *mesh, tri_vertex_id from, tri_vertex_id to, int32_t marker,
                            int32_t segment);

/* The link of an edge as its triangle holds it. */
static inline tri_link *tri_link_at(const struct tri_mesh *mesh, tri_halfedge code)
{
    return &mesh->tri[tri_of(code)].n[tri_edge(code)];
}

/* The corner opposite an edge. */
static inline tri_vertex_id tri_apex(const struct tri_mesh *mesh, tri_halfedge code)
{
    return mesh->tri[tri_of(code)].v[tri_edge(code)];
}

/* Is there a triangle on one side of the subsegment only? */
static inline bool tri_is_boundary(const struct tri_subsegment *s)
{
    return s->side[0] == TRI_NONE || s->side[1] == TRI_NONE;
}

/* Which side of a subsegment's record belongs to the triangle that sees it as from -> to (counter-clockwise)? */
static inline int tri_side(const struct tri_subsegment *s, tri_vertex_id from) { return s->v[0] == from ? 0 : 1; }

/* Its record from the other end. */
static inline void tri_turn_sub(struct tri_subsegment *s)
{
    *s = (struct tri_subsegment){{s->v[1], s->v[0]}, {s->side[1], s->side[0]}, s->marker, s->parent};
}

/* The same edge as its other triangle sees it, subsegment or not; TRI_NONE at the boundary. */
static inline tri_halfedge tri_across(const struct tri_mesh *mesh, tri_halfedge code)
{
    const struct tri_triangle *t = &mesh->tri[tri_of(code)];
    tri_link link = t->n[tri_edge(code)];
    if (link >= 0)
        return link;
    const struct tri_subsegment *s = &mesh->sub[~link];
    return s->side[1 - tri_side(s, t->v[tri_next[tri_edge(code)]])];
}

/* Lets the triangle or subsegment behind `outer` know that its neighbour across that edge is now `code`. `from` is the
 * corner at which the edge starts, counter-clockwise in the triangle of `code`. */
static inline void tri_relink(struct tri_mesh *mesh, tri_link outer, tri_vertex_id from, tri_halfedge code)
{
    if (outer >= 0)
        mesh->tri[outer >> 2].n[outer & 3] = code;
    else
        mesh->sub[~outer].side[tri_side(&mesh->sub[~outer], from)] = code;
}

/* Bytes of the largest thing that a vertex has. */
static inline size_t tri_vertex_size(const struct tri_mesh *mesh)
{
    size_t attributes = (size_t)mesh->n_attributes * sizeof *mesh->attributes;
    return attributes > sizeof *mesh->xy ? attributes : sizeof *mesh->xy;
}

/* Which corner of t is v? It is one. */
static inline int tri_corner_of(const struct tri_triangle *t, tri_vertex_id v)
{
    assert(t->v[0] == v || t->v[1] == v || t->v[2] == v);
    return t->v[0] == v ? 0 : t->v[1] == v ? 1 : 2;
}

/* Vertex first + i becomes what vertex from[i] was, for all i < n, where from[] names vertices first and above.
 * Moves what the vertices have; whoever refers to them is the caller's to rename. scratch: n * tri_vertex_size
 * bytes. O(n). */
void tri_mesh_gather_vertices(struct tri_mesh *mesh, tri_vertex_id first, const tri_vertex_id *from, int32_t n,
                              void *scratch, const struct tri_executor *executor);

/* Fills the gaps that free numbers leave with triangles from the end. O(triangles). */
void tri_mesh_compact(struct tri_mesh *mesh);

/* Checks the invariants of the links; what it finds first is told in *error. O(triangles). For asserts and tests. */
enum tri_status tri_mesh_validate(const struct tri_mesh *mesh, struct tri_error *error);

/* For asserts where a stage ends: are counts within capacities and, in a mesh so small that it takes no time, the
 * invariants of the links kept? */
bool tri_mesh_is_sound(const struct tri_mesh *mesh);

#endif
