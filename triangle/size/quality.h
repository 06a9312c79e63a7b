/* What is asked of a mesh, in the form in which the inner loop compares it, and which triangles are bad.
 *
 * Nothing here changes the mesh. */
#ifndef TRIANGLE_SIZE_QUALITY_H
#define TRIANGLE_SIZE_QUALITY_H

#include <stdbool.h>
#include <stdint.h>

#include "triangle/geometry/shape.h"
#include "triangle/mesh/mesh.h"
#include "triangle/size/lengths.h"
#include "triangle/tunables.h"

/* Non-zero: the triangle a, b, c (counter-clockwise) must be refined. Called for triangles that satisfy all other size
 * bounds, by par_refine also for others (sched/schedule/schedule.h). */
typedef int tri_unsuitable(void *user, const double a[2], const double b[2], const double c[2], double area);

/* The size function h: how long edges shall be about a place, in the caller's units; infinity: as long as they like. */
typedef double tri_edge_length(void *user, const double at[2]);

struct tri_quality {
    double min_angle;      /* degrees; 0: no bound on angles; above 38 as 38,
                              if conforming above 36 as 36 */
    double max_area;       /* <= 0: none */
    bool region_areas;     /* mesh->regions[t.region].max_area applies too */
    tri_edge_length *edge_length; /* NULL: none. No triangle is larger than an equilateral one with the least length at
                                     its corners and centroid */
    void *edge_length_user;
    const struct tri_lengths *lengths; /* edges shall be about so long (lengths.h); borrowed; NULL: none */
    bool front;            /* points for lengths are placed over a front (front.h) */
    tri_unsuitable *unsuitable; /* a size test; NULL: none */
    void *unsuitable_user;
    double area_scale;     /* > 0: for pre-refinement, all areas may be larger by this factor; the size test is asked
                              about triangles of 1 / area_scale of the area; 0: as they are */
    bool lattice;          /* points lie in a lattice where a bound on areas allows (lattice.h), or a length */
    bool conforming;       /* -D: no vertex inside the diametral circle of a subsegment */
    int protect;           /* 1: boundary subsegments are not split (-Y); 2: no subsegment is (-YY) */
    int passes;            /* of smoothing at the end, which moves vertices (smooth.h); 0: none */
    int64_t max_steiner;   /* < 0: no limit on the points inserted */
};

/* Nothing is asked. */
struct tri_quality tri_quality_defaults(void);

/* Are sizes given by functions of the caller, which only some threads may call? */
static inline bool tri_asks_caller(const struct tri_quality *quality)
{
    return quality->edge_length || quality->unsuitable;
}

/* Are new points put into a lattice? The bound on angles must leave it standing: above 30 degrees it does not. */
bool tri_wants_lattice(const struct tri_quality *quality);

/* If sizes are one length everywhere, and new points are put into a lattice of it where there is room: that; else 0. */
double tri_lattice_length(const struct tri_quality *quality);

/* Are points placed over a front, if lengths are asked for? As in a lattice, each further point halves an angle of
 * about 60 degrees. So a bound above 30 degrees would undo the front, and take several times as many triangles. */
bool tri_allows_front(const struct tri_quality *quality);

/* Of the areas in a mesh over the bound on areas: the mean, and a share that no mesh has. */
double tri_mean_over_bound(const struct tri_quality *quality);
double tri_most_over_bound(const struct tri_quality *quality);

/* A larger bound on angles is treated as this one. */
double tri_worked_angle(const struct tri_quality *quality);

/* Writes into note that refinement works for a smaller angle than is asked for. False: it does not, and nothing is
 * written. */
enum { TRI_ANGLE_NOTE = 160 };
bool tri_note_lowered_angle(const struct tri_quality *quality, char note[TRI_ANGLE_NOTE]);

/* Do sizes depend on the place by functions, of the caller or frozen ones? */
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

/* An angle bound as it is compared. */
struct tri_bounds {
    double sin2;       /* square of the sine of the angle bound; 0: no angle bound */
    double lens_cos2;  /* a point that sees a subsegment under more than 180 - 2 * bound encroaches: dot < 0 and
                          dot^2 > lens_cos2 * product of squared lengths */
    double off_centre; /* height of an off-centre over its edge in units of the edge; 0: always circumcentres */
};

/* min_angle in degrees; above 60 as 60, which no mesh keeps; 0: no bound. conforming: the lens is the whole diametral
 * disk. */
struct tri_bounds tri_bounds_for(double min_angle, bool conforming);

/* The same for a stage of a call. In a lattice points halve angles of 60 degrees, and rounding must not make these
 * bad. */
struct tri_bounds tri_bounds_of(const struct tri_quality *quality, double min_angle);

/* --- the sizes that are asked for, at a place and of a triangle
 *
 * Who asks for what, of which mesh. Both are borrowed. */
struct tri_asked {
    const struct tri_mesh *mesh;
    const struct tri_quality *quality;
    double area2; /* twice the bound for all areas, in the mesh's units; infinity: none */
    double coarser; /* lengths count so many times: more than once on behalf of a coarser mesh */
};

struct tri_asked tri_asked_of(const struct tri_mesh *mesh, const struct tri_quality *quality);

/* The smaller of the bound for all areas and that of a region. */
double tri_area2_in_region(const struct tri_asked *asked, tri_region_id region);

/* Twice the largest area allowed in a region, in the mesh's units; infinity where there is no bound. */
static inline double tri_area2_bound(const struct tri_asked *asked, tri_region_id region)
{
    return asked->quality->region_areas ? tri_area2_in_region(asked, region) : asked->area2;
}

/* Do the caller's functions (tri_asks_caller) refuse a triangle of these corners, in the mesh's units? A
 * quality->area_scale above 1 asks on behalf of a coarser mesh: the size test sees the triangle shrunk about its
 * centroid, to 1 / area_scale of its area. */
bool tri_is_refused(const struct tri_asked *asked, struct tri_point a, struct tri_point b, struct tri_point c);

/* The same for a triangle with these corners. */
bool tri_is_unsuitable(const struct tri_asked *asked, const tri_vertex_id v[3]);

/* The longest edge that the caller's functions accept about a place in a triangle, in the mesh's units, at
 * quality->area_scale. The size test is asked about the triangle shrunk about the place, from the whole down to a
 * 65,536th of its lengths; an edge is that of an equilateral triangle of the same area, to a factor of 1.5. A test that
 * accepts the first, or refuses all, asks for nothing: 1e100. Edges that lengths ask for are met on the average: they
 * count as the longer ones that would be accepted where triangles of such a mean area are made. */
double tri_asked_length(const struct tri_asked *asked, const struct tri_point triangle[3], struct tri_point at);

/* --- lengths: h is asked for once for each vertex, and kept in mesh->length
 *
 * For all vertices that there are; refinement does it for those that it makes. Without lengths the mesh has none from
 * here on. O(vertices). */
enum tri_status tri_ask_lengths(struct tri_mesh *mesh, const struct tri_lengths *lengths,
                                const struct tri_executor *executor, struct tri_error *error);

/* h at a place, and at a vertex. */
static inline double tri_wanted_at(const struct tri_asked *asked, struct tri_point p)
{
    return tri_lengths_at(asked->quality->lengths, p) * asked->coarser;
}

static inline double tri_wanted_of(const struct tri_asked *asked, tri_vertex_id v)
{
    return fabs(asked->mesh->length[v]) * asked->coarser;
}

/* Is a triangle of these corners, squared edges and twice this area too large for the lengths? It is if its
 * circumradius is above TRI_FRONT_ACCEPT of the mean h of its corners. A thin one has a large circumcircle at any size:
 * that is the angle's affair, and of lengths only its longest edge counts. */
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

/* Does the triangle break a bound on areas or lengths, or do the caller's functions refuse it? */
bool tri_is_too_large(const struct tri_asked *asked, const struct tri_triangle *t, const struct tri_shape *shape);

/* --- which triangles are bad: the criterion that the refinement loop works for, and its census counts */

struct tri_criterion {
    struct tri_asked asked;
    struct tri_bounds bounds; /* for the angle that is worked for now, which may be below the one that is asked for */
};

enum tri_badness { TRI_GOOD, TRI_BAD_SIZE, TRI_BAD_ANGLE };

/* Both are borrowed. */
struct tri_criterion tri_criterion_for(const struct tri_mesh *mesh, const struct tri_quality *quality);

/* A bad angle counts before a bad size. */
enum tri_badness tri_judge(const struct tri_criterion *criterion, const struct tri_triangle *t,
                           const struct tri_shape *shape);

/* -Y, -YY: must the subsegment not be split? */
bool tri_is_protected(const struct tri_quality *quality, const struct tri_subsegment *s);

/* Lower than the shortest edge that coordinates can carry: splitting a subsegment beside it would chase the
 * rounding. */
bool tri_is_flat(const struct tri_mesh *mesh, const struct tri_shape *shape);

#endif
