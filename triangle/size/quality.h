/* Bounds on angles and sizes in the form that the inner loop compares, and the tests for bad triangles. Nothing here
 * changes the mesh. */
#ifndef TRIANGLE_SIZE_QUALITY_H
#define TRIANGLE_SIZE_QUALITY_H

#include <stdbool.h>
#include <stdint.h>

#include "triangle/geometry/shape.h"
#include "triangle/mesh/mesh.h"
#include "triangle/size/lengths.h"
#include "triangle/tunables.h"

/* Returns non-zero if the triangle a, b, c (counter-clockwise) must be refined. Called for triangles that satisfy
 * all other size bounds; par_refine also calls it for others (sched/schedule/schedule.h). */
typedef int tri_unsuitable(void *user, const double a[2], const double b[2], const double c[2], double area);

/* The size function h: returns the wanted edge length at a point, in the caller's units; infinity: no limit. */
typedef double tri_edge_length(void *user, const double at[2]);

struct tri_quality {
    double min_angle;      /* degrees; 0: no angle bound; values above 38 (conforming: above 36) are treated as 38
                              (36) */
    double max_area;       /* largest area; <= 0: no bound */
    bool region_areas;     /* true: mesh->regions[t.region].max_area applies as well */
    tri_edge_length *edge_length; /* NULL: none. No triangle may be larger than the equilateral triangle whose edge
                                     is the smallest length at its corners and centroid */
    void *edge_length_user;            /* passed to edge_length */
    const struct tri_lengths *lengths; /* wanted edge lengths (lengths.h); borrowed; NULL: none */
    bool front;            /* true: new points for lengths are placed by an advancing front (front.h) */
    tri_unsuitable *unsuitable; /* the caller's size test; NULL: none */
    void *unsuitable_user;      /* passed to unsuitable */
    double area_scale;     /* for pre-refinement: areas may be larger by this factor, and the size test sees
                              triangles with 1 / area_scale of the area; 0: unused */
    bool lattice;          /* true: if an area bound or a length allows it, points are placed on a lattice
                              (lattice.h) */
    bool conforming;       /* true (-D): no vertex inside the diametral circle of a subsegment */
    int protect;           /* 1: boundary subsegments are not split (-Y); 2: no subsegment is split (-YY); 0: all may
                              be split */
    int passes;            /* smoothing passes at the end, which move vertices (smooth.h); 0: no smoothing */
    int64_t max_steiner;   /* limit on inserted points; < 0: no limit */
};

/* Returns settings without any bound. */
struct tri_quality tri_quality_defaults(void);

/* Do sizes depend on functions of the caller? These may be called on some threads only. */
static inline bool tri_asks_caller(const struct tri_quality *quality)
{
    return quality->edge_length || quality->unsuitable;
}

/* Are new points placed on a lattice? Only with angle bounds up to 30 degrees, since a larger bound would destroy
 * the lattice. */
bool tri_wants_lattice(const struct tri_quality *quality);

/* Returns the edge length of the lattice if a single length is wanted everywhere and points are placed on a lattice;
 * otherwise 0. */
double tri_lattice_length(const struct tri_quality *quality);

/* May lengths be met by an advancing front? As in a lattice, each additional point halves an angle of about 60
 * degrees. So an angle bound above 30 degrees would destroy the front and need several times as many triangles. */
bool tri_allows_front(const struct tri_quality *quality);

/* Return ratios of triangle area to the area bound: the mean over a mesh, and a ratio that no mesh reaches on
 * average. */
double tri_mean_over_bound(const struct tri_quality *quality);
double tri_most_over_bound(const struct tri_quality *quality);

/* Returns the angle bound that refinement uses: min_angle, or the supported maximum if that is smaller. */
double tri_worked_angle(const struct tri_quality *quality);

/* Writes a note that refinement uses a smaller angle than requested. Returns false, without writing, if it does not. */
enum { TRI_ANGLE_NOTE = 160 };
bool tri_note_lowered_angle(const struct tri_quality *quality, char note[TRI_ANGLE_NOTE]);

/* Do sizes vary with position, through functions of the caller or through lengths? */
static inline bool tri_sizes_vary(const struct tri_quality *quality)
{
    return quality->lengths || tri_asks_caller(quality);
}

/* Is there any bound on sizes? */
static inline bool tri_has_sizes(const struct tri_quality *quality)
{
    return quality->max_area > 0 || quality->region_areas || tri_sizes_vary(quality);
}

static inline double tri_area_scale(const struct tri_quality *quality)
{
    return quality->area_scale > 0 ? quality->area_scale : 1;
}

/* An angle bound in the form that is compared. */
struct tri_bounds {
    double sin2;       /* squared sine of the angle bound; 0: no bound */
    double lens_cos2;  /* a point that sees a subsegment under an angle above 180 - 2 * bound encroaches it: dot < 0
                          and dot^2 > lens_cos2 * product of squared lengths */
    double off_centre; /* height of an off-centre over its edge, in units of that edge; 0: always use circumcentres */
};

/* min_angle in degrees; 0: no bound. Values above 60, which no mesh satisfies, are treated as 60. conforming: the
 * lens is the whole diametral disk. */
struct tri_bounds tri_bounds_for(double min_angle, bool conforming);

/* The same for one stage of a call. In a lattice, points halve angles of 60 degrees, and the bound is lowered so
 * that rounding does not make the halves bad. */
struct tri_bounds tri_bounds_of(const struct tri_quality *quality, double min_angle);

/* --- the wanted sizes, at a point and for a triangle
 *
 * The wanted sizes of a mesh. Pointers are borrowed. */
struct tri_asked {
    const struct tri_mesh *mesh; /* borrowed */
    const struct tri_quality *quality; /* borrowed */
    double area2; /* twice the general area bound, in the mesh's units; infinity: none */
    double coarser; /* factor applied to lengths; above 1 for a coarse mesh */
};

struct tri_asked tri_asked_of(const struct tri_mesh *mesh, const struct tri_quality *quality);

/* Returns twice the smaller of the general area bound and that of a region. */
double tri_area2_in_region(const struct tri_asked *asked, tri_region_id region);

/* Returns twice the largest area allowed in a region, in the mesh's units; infinity if there is no bound. */
static inline double tri_area2_bound(const struct tri_asked *asked, tri_region_id region)
{
    return asked->quality->region_areas ? tri_area2_in_region(asked, region) : asked->area2;
}

/* Do the caller's functions (tri_asks_caller) reject a triangle with these corners, in the mesh's units? If
 * quality->area_scale is above 1 (coarse mesh), the size test sees the triangle shrunk about its centroid to 1 /
 * area_scale of its area. */
bool tri_is_refused(const struct tri_asked *asked, struct tri_point a, struct tri_point b, struct tri_point c);

/* The same for a triangle with the vertices v. */
bool tri_is_unsuitable(const struct tri_asked *asked, const tri_vertex_id v[3]);

/* Returns the longest edge that the caller's functions accept at a point of a triangle, in the mesh's units, for
 * quality->area_scale. The size test is called for the triangle shrunk about the point, at scales from 1 to
 * 1/65,536. The result is the edge of an equilateral triangle of the same area, accurate to a factor of 1.5. If the
 * test accepts the whole triangle or rejects all scales, the result is 1e100 (no limit). Wanted lengths
 * (quality->lengths) are met on average, so they count as the length bound that gives triangles of that mean area. */
double tri_asked_length(const struct tri_asked *asked, const struct tri_point triangle[3], struct tri_point at);

/* --- lengths: h is computed once for each vertex and stored in mesh->length
 *
 * Computes the lengths of all existing vertices; refinement does the same for vertices that it adds. lengths NULL:
 * removes the lengths from the mesh. O(vertices). */
enum tri_status tri_ask_lengths(struct tri_mesh *mesh, const struct tri_lengths *lengths,
                                const struct tri_executor *executor, struct tri_error *error);

/* Return the wanted length h at a point, and at a vertex. */
static inline double tri_wanted_at(const struct tri_asked *asked, struct tri_point p)
{
    return tri_lengths_at(asked->quality->lengths, p) * asked->coarser;
}

static inline double tri_wanted_of(const struct tri_asked *asked, tri_vertex_id v)
{
    return fabs(asked->mesh->length[v]) * asked->coarser;
}

/* Is a triangle too large for the wanted lengths? v: corners; a, b, c: squared edge lengths; area2: twice the area.
 * It is if its circumradius exceeds TRI_FRONT_ACCEPT times the mean h of its corners. A thin triangle has a large
 * circumcircle regardless of its size, which is left to the angle bound. For thin triangles only the longest edge is
 * compared. */
static inline bool tri_is_too_long(const struct tri_asked *asked, const tri_vertex_id v[3], double a, double b,
                                   double c, double area2)
{
    const double h = (tri_wanted_of(asked, v[0]) + tri_wanted_of(asked, v[1]) + tri_wanted_of(asked, v[2])) / 3;
    const double most = 2 * TRI_FRONT_ACCEPT * h * area2, longest = TRI_FRONT_LONGEST * h;
    if (a * b * c <= most * most)
        return false;
    return area2 * area2 >= TRI_FRONT_THIN * tri_longer_product(a, b, c) ||
           tri_larger(a, tri_larger(b, c)) > longest * longest;
}

/* Does the triangle violate an area or length bound, or do the caller's functions reject it? */
bool tri_is_too_large(const struct tri_asked *asked, const struct tri_triangle *t, const struct tri_shape *shape);

/* --- bad triangles: the criterion of the refinement loop and of the census */

struct tri_criterion {
    struct tri_asked asked;   /* the wanted sizes */
    struct tri_bounds bounds; /* the current angle bound, which may be below the requested one */
};

enum tri_badness { TRI_GOOD, TRI_BAD_SIZE, TRI_BAD_ANGLE };

/* Pointers are borrowed. */
struct tri_criterion tri_criterion_for(const struct tri_mesh *mesh, const struct tri_quality *quality);

/* Returns whether and why a triangle is bad. A bad angle takes precedence over a bad size. */
enum tri_badness tri_judge(const struct tri_criterion *criterion, const struct tri_triangle *t,
                           const struct tri_shape *shape);

/* Do -Y or -YY forbid splitting the subsegment? */
bool tri_is_protected(const struct tri_quality *quality, const struct tri_subsegment *s);

/* Is the triangle's height below the shortest edge that coordinates resolve? Then splitting a subsegment beside it
 * would only react to rounding errors. */
bool tri_is_flat(const struct tri_mesh *mesh, const struct tri_shape *shape);

#endif
