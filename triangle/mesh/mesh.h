/* The mesh: flat arrays with indices, shared by all stages of the triangulator.
 *
 * A triangle is 32 bytes: three corners counter-clockwise, three links, a region, a generation.
 * Link e is opposite corner e:
 *   link >= 0   code 4 * t + f: the neighbour is triangle t, and its edge f is the same edge seen from the other side;
 *   link <  0   ~s: the edge is subsegment s, whose record holds the triangles on both sides.
 * INVARIANT (links): for every live triangle t and edge e, either link(link(t, e)) == (t, e), or the link is a
 * subsegment that stores (t, e) as the side matching its direction. Every edge of the outer boundary is a subsegment.
 * So a search that must not cross constrained edges stops at a sign bit without loading anything. TRI_BEYOND is the
 * link to a triangle that is not in this address space. A search that meets it reports this, and is repeated when more
 * of the mesh is available.
 *
 * Vertices are x, y pairs. Attributes, markers and parents are in separate arrays, which are accessed only for new
 * vertices. Vertex numbers are below 2^28, triangle numbers below 2^29 (4 * t + e is a non-negative int32_t). */
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
    TRI_BEYOND = INT32_MIN /* link, or side of a subsegment: the triangle is in another address space (see above) */
};

enum tri_vertex_kind { /* values of tri_mesh.on below 0 */
    TRI_VERTEX_INPUT = -1, /* a point of the input, or a crossing of two input segments */
    TRI_VERTEX_FREE = -2,  /* made by refinement in the interior of a region */
    TRI_VERTEX_ACUTE = -3, /* like TRI_VERTEX_INPUT, and two subsegments meet here at less than 60 degrees */
    TRI_VERTEX_NONE = -4   /* not a vertex: the number is free (only until par_number) */
    /* >= 0: made by refinement on the parent with this number */
};

struct tri_triangle {
    tri_vertex_id v[3];   /* corners, counter-clockwise; v[0] == TRI_NONE: the number is free */
    tri_link n[3];        /* links to neighbours and subsegments, see above */
    tri_region_id region; /* index in tri_mesh.regions */
    uint32_t generation;        /* incremented when the number is reused, so that queue entries can detect it */
};

struct tri_subsegment {
    tri_vertex_id v[2];   /* start, end */
    tri_halfedge side[2]; /* half-edges left and right of v[0] -> v[1]; TRI_NONE: no triangle */
    int32_t marker;       /* marker of the input segment, 0 if it has none */
    tri_parent_id parent; /* TRI_NONE only in a free record (see par_number) */
};

/* A segment: the parent of the subsegments into which refinement splits it. Splitting, shells and small input angles
 * refer to it. */
struct tri_parent {
    tri_vertex_id v[2]; /* its ends */
    int32_t segment; /* the first input segment that runs along it; TRI_NONE: an edge of the hull only */
    bool odd;        /* after tri_constrain: an odd number of input segments run along it */
    bool reversed;   /* until the mesh is finished: the subsegments run against the direction of the input segment */
    struct tri_point guard; /* third corner of a triangle outside the domain that is reserved for the parent (split.c);
                               NaN: the whole outside is; equal to an end: none is */
};

/* The parents that end at each vertex, for the vertices that existed when they were listed (triangle/mesh/parents.h).
 * Those at vertex v are parent[start[v] .. start[v + 1]). Long lists are sorted by direction. */
struct tri_incidence {
    tri_parent_id *parent; /* [2 * n_parents] */
    int32_t *start;        /* [n_vertices + 2], the last one for filling */
    int32_t n_vertices;    /* 0: not listed yet */
};

/* Limits at which refinement leaves a bad triangle unchanged (triangle/size/feature_size.h). */
struct tri_limits {
    double finest2;     /* squared length of the shortest edge that the coordinates can resolve */
    double shortest2;   /* like finest2, but with accumulated rounding: nearer vertices are not distinct features */
    double costliest_gap; /* a narrow gap between parents stays unfilled if it would take more points than this */
    double gap_points;  /* estimated number of points in the gaps that are filled */
};

struct tri_region {
    double attribute; /* attribute of its triangles */
    double max_area; /* <= 0: none */
};

/* The arrays that grow with refinement. */
enum tri_array {
    TRI_XY, TRI_ON, TRI_MARKERS, TRI_FEATURE, TRI_LENGTH, TRI_ATTRIBUTES, TRI_TRIANGLES, TRI_SUBS, TRI_ARRAYS
};

/* Storage for these arrays other than malloc. */
struct tri_storage {
    /* Makes room for at least `bytes` in the array and keeps its contents. Returns its page-aligned start, or NULL if
     * there is no room. */
    void *(*reserve)(void *user, enum tri_array array, size_t bytes);
    /* Copies `bytes` to the beginning of the array, keeping only a small part in memory at a time. Returns false if
     * there is no room. */
    bool (*fill)(void *user, enum tri_array array, const void *from, size_t bytes);
    /* Allocates `bytes` for a work array that grows with the mesh, to be freed by extra_free. Returns NULL and sets
     * errno if there is no room. */
    void *(*extra)(void *user, size_t bytes);
    void (*extra_free)(void *user, void *extra);
    void *user;
    /* Allows the storage to evict pages of work arrays that have been read or written. May be called by any thread.
     * NULL: the storage evicts pages by itself. */
    void (*evict_pages)(const void *user);
};

struct tri_mesh;
struct tri_surface;

/* A bound on the memory for these arrays. */
struct tri_bound {
    /* Returns whether the arrays may grow to `bytes`. */
    bool (*allows)(void *user, const struct tri_mesh *mesh, size_t bytes);
    /* Called if they may not: moves them to a storage (tri_mesh_move), or returns the error for the request. */
    enum tri_status (*leave)(void *user, struct tri_mesh *mesh, struct tri_error *error);
    void *user;
};

struct tri_mesh {
    struct tri_point *xy;     /* [n_vertices] */
    int32_t *on;              /* [n_vertices] kind, or parent if >= 0; see tri_vertex_kind */
    int32_t *vertex_markers;  /* [n_vertices] */
    double *feature;          /* [n_vertices] size of nearby features; set when refinement begins (feature_size.h) */
    double *length;           /* [n_vertices] edge length requested, mesh units; < 0: of a coarser mesh; NULL: none */
    double *attributes;       /* [n_vertices][n_attributes]; those of new vertices are set at the end */
    struct tri_surface *surface; /* attributes of new vertices (surface.h); NULL: no attributes, or not refined */
    int32_t n_attributes;
    bool has_lengths;         /* whether `length` is used */
    int32_t n_vertices, vertex_capacity;
    int32_t n_input;          /* number of input points, which come first, in input order unless `origin` is set */
    int32_t *origin;          /* [n_input] input index of each (triangle/cdt/spatial.h); NULL: input order */
    int32_t *twin;            /* [n_input] first vertex, in input order, at the same place; NULL: no duplicates */

    struct tri_triangle *tri; /* [n_triangles], aligned to a cache line; some may be free (v[0] == TRI_NONE) */
    int32_t n_triangles, triangle_capacity;

    struct tri_subsegment *sub; /* [n_subs] */
    int32_t n_subs, sub_capacity;
    struct tri_parent *parents; /* [n_parents] */
    int32_t n_parents, parent_capacity;
    /* Facts about the input that refinement needs (triangle/size/feature_size.h). Computed once, used by every call on
     * this mesh, and valid as long as the parents do not change. */
    struct tri_incidence incidence; /* parents at each vertex of the input */
    struct tri_limits limits;

    struct tri_region *regions; /* [n_regions] regions[0] is "no region": attribute 0, no bound */
    int32_t n_regions;
    double *columns;          /* [n_regions][n_columns] triangle attributes; NULL: mesh made without them */
    int32_t n_columns;

    double unit;              /* a power of two: the caller's coordinates are xy * unit */

    const struct tri_storage *storage; /* borrowed; NULL: malloc */
    const struct tri_bound *bound;     /* limits the growth of arrays from malloc; borrowed; NULL: no limit */
    const struct tri_stop *stop; /* polled by long loops over the mesh; borrowed; NULL: never stop */
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

/* Returns the attributes of the triangles in a region: n_columns of them, or one if n_columns is 0. */
static inline const double *tri_region_attributes(const struct tri_mesh *mesh, tri_region_id region)
{
    return mesh->columns ? mesh->columns + (size_t)region * (size_t)mesh->n_columns : &mesh->regions[region].attribute;
}

/* Returns the number that a vertex v < n_input has among the caller's points. */
static inline int32_t tri_point_of(const struct tri_mesh *mesh, tri_vertex_id v)
{
    return mesh->origin ? mesh->origin[v] : v;
}

/* Stores the coordinates of a vertex in the caller's units. */
static inline void tri_mesh_place(const struct tri_mesh *mesh, tri_vertex_id v, double at[2])
{
    at[0] = mesh->xy[v].x * mesh->unit;
    at[1] = mesh->xy[v].y * mesh->unit;
}

/* Converts a point from the caller's units to those of the mesh. Vertices are always within the range of the
 * predicates. Any other point may be out of range or infinite: check it with tri_is_in_range before passing it to a
 * predicate. */
static inline struct tri_point tri_to_units(const struct tri_mesh *mesh, double x, double y)
{
    struct tri_point p = {tri_round_coordinate(x / mesh->unit), tri_round_coordinate(y / mesh->unit)};
    return p;
}

/* tri_mesh_init makes an empty mesh with regions[0]. tri_mesh_free frees everything and zeroes the struct. */
enum tri_status tri_mesh_init(struct tri_mesh *mesh, struct tri_error *error);
void tri_mesh_free(struct tri_mesh *mesh);

/* Allocates a work array that grows with the mesh, in the mesh's storage. Returns NULL if out of memory. */
void *tri_mesh_extra(const struct tri_mesh *mesh, size_t bytes);
void tri_mesh_extra_free(const struct tri_mesh *mesh, void *extra);

/* Returns the bytes in use in the arrays that grow with refinement. */
size_t tri_mesh_bytes_used(const struct tri_mesh *mesh);

/* Approximate bytes of these arrays per triangle: two triangles have one vertex. Each attribute takes 8 bytes, and half
 * of that again when vertices are reordered. */
static inline double tri_mesh_bytes_each(int32_t n_attributes)
{
    const double vertex = sizeof(struct tri_point) + 2 * sizeof(int32_t) + sizeof(double) + 12.0 * n_attributes;
    return sizeof(struct tri_triangle) + vertex / 2;
}

/* These functions work on the arrays that grow with refinement. Move: moves them to a storage, which the mesh borrows
 * from then on. Copy: copies them, in memory from malloc, to *copy, which has nothing else. Swap: exchanges the arrays
 * and their counts between two meshes. Drop: frees them and forgets the input points. TRI_NO_MEMORY: the mesh is
 * unchanged and *copy is empty. */
enum tri_status tri_mesh_move(struct tri_mesh *mesh, const struct tri_storage *storage, struct tri_error *error);
enum tri_status tri_mesh_copy(struct tri_mesh *copy, const struct tri_mesh *mesh, struct tri_error *error);
void tri_mesh_swap(struct tri_mesh *a, struct tri_mesh *b);
void tri_mesh_drop(struct tri_mesh *mesh);

/* Reserves room for at least `more` items; amortised O(1) per item. Invalidates pointers into the arrays. */
enum tri_status tri_mesh_reserve_vertices(struct tri_mesh *mesh, int32_t more, struct tri_error *error);
enum tri_status tri_mesh_reserve_triangles(struct tri_mesh *mesh, int32_t more, struct tri_error *error);
enum tri_status tri_mesh_reserve_subs(struct tri_mesh *mesh, int32_t more, struct tri_error *error);

/* Adds or removes the array `length`. The caller sets its contents. */
enum tri_status tri_mesh_have_lengths(struct tri_mesh *mesh, bool has, struct tri_error *error);

/* Copies points, attributes and markers of the PSLG as vertices 0 .. n_points - 1, and chooses mesh->unit so that all
 * coordinates lie in the range of the exact predicates. Coordinates below 2^-216 units are rounded to multiples of
 * 2^-268. So all future vertices convert exactly to the caller's units, and no rounding inverts a triangle.
 * TRI_BAD_INPUT if the largest coordinate is subnormal. */
enum tri_status tri_mesh_take_points(struct tri_mesh *mesh, const struct tri_pslg *pslg,
                                     const struct tri_executor *executor, struct tri_error *error);

/* Appends a subsegment between two vertices, and a parent for it. The caller links its sides and has reserved room. */
tri_sub_id tri_mesh_add_sub(struct tri_mesh *mesh, tri_vertex_id from, tri_vertex_id to, int32_t marker,
                            int32_t segment);

/* Returns a pointer to the link of an edge in its triangle. */
static inline tri_link *tri_link_at(const struct tri_mesh *mesh, tri_halfedge code)
{
    return &mesh->tri[tri_of(code)].n[tri_edge(code)];
}

/* Returns the corner opposite an edge. */
static inline tri_vertex_id tri_apex(const struct tri_mesh *mesh, tri_halfedge code)
{
    return mesh->tri[tri_of(code)].v[tri_edge(code)];
}

/* Does the subsegment have a triangle on one side only? */
static inline bool tri_is_boundary(const struct tri_subsegment *s)
{
    return s->side[0] == TRI_NONE || s->side[1] == TRI_NONE;
}

/* Returns which side of the subsegment's record belongs to the triangle in which it runs from `from`,
 * counter-clockwise. */
static inline int tri_side(const struct tri_subsegment *s, tri_vertex_id from) { return s->v[0] == from ? 0 : 1; }

/* Reverses the direction of a subsegment's record. */
static inline void tri_turn_sub(struct tri_subsegment *s)
{
    *s = (struct tri_subsegment){{s->v[1], s->v[0]}, {s->side[1], s->side[0]}, s->marker, s->parent};
}

/* Returns the same edge as its other triangle sees it, across subsegments as well; TRI_NONE at the boundary. */
static inline tri_halfedge tri_across(const struct tri_mesh *mesh, tri_halfedge code)
{
    const struct tri_triangle *t = &mesh->tri[tri_of(code)];
    tri_link link = t->n[tri_edge(code)];
    if (link >= 0)
        return link;
    const struct tri_subsegment *s = &mesh->sub[~link];
    return s->side[1 - tri_side(s, t->v[tri_next[tri_edge(code)]])];
}

/* Stores `code` as the neighbour of the triangle or subsegment `outer`. `from` is the corner at which the edge starts,
 * counter-clockwise in the triangle of `code`. */
static inline void tri_relink(struct tri_mesh *mesh, tri_link outer, tri_vertex_id from, tri_halfedge code)
{
    if (outer >= 0)
        mesh->tri[outer >> 2].n[outer & 3] = code;
    else
        mesh->sub[~outer].side[tri_side(&mesh->sub[~outer], from)] = code;
}

/* Returns the size in bytes of the largest item stored per vertex. */
static inline size_t tri_vertex_size(const struct tri_mesh *mesh)
{
    size_t attributes = (size_t)mesh->n_attributes * sizeof *mesh->attributes;
    return attributes > sizeof *mesh->xy ? attributes : sizeof *mesh->xy;
}

/* Returns which corner of t is v; v must be a corner of t. */
static inline int tri_corner_of(const struct tri_triangle *t, tri_vertex_id v)
{
    assert(t->v[0] == v || t->v[1] == v || t->v[2] == v);
    return t->v[0] == v ? 0 : t->v[1] == v ? 1 : 2;
}

/* Reorders vertices: vertex first + i receives the data of vertex from[i], for all i < n. The numbers in from[] are
 * distinct and not below `first`. The caller updates all references to vertices. scratch: n * tri_vertex_size bytes.
 * O(n). */
void tri_mesh_gather_vertices(struct tri_mesh *mesh, tri_vertex_id first, const tri_vertex_id *from, int32_t n,
                              void *scratch, const struct tri_executor *executor);

/* Moves triangles from the end into free numbers, so that none is left. O(triangles). */
void tri_mesh_compact(struct tri_mesh *mesh);

/* Checks the invariants of the links and reports the first violation in *error. O(triangles). For asserts and tests. */
enum tri_status tri_mesh_validate(const struct tri_mesh *mesh, struct tri_error *error);

/* For asserts at the end of a stage. Checks that counts are within capacities and, in small meshes, the invariants of
 * the links. */
bool tri_mesh_is_sound(const struct tri_mesh *mesh);

#endif
