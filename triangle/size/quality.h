/* What is asked of a mesh, and an angle bound in the form in which the inner loop compares it. */
#ifndef TRIANGLE_SIZE_QUALITY_H
#define TRIANGLE_SIZE_QUALITY_H

#include <stdbool.h>
#include <stdint.h>

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
    tri_unsuitable *unsuitable; /* a size test; NULL: none */
    void *unsuitable_user;
    double area_scale;     /* > 0: for pre-refinement, all areas may be larger by this factor; the size test is asked
                              about triangles of 1 / area_scale of the area; 0: as they are */
    bool conforming;       /* -D: no vertex inside the diametral circle of a subsegment */
    int protect;           /* 1: boundary subsegments are not split (-Y); 2: no subsegment is (-YY) */
    int64_t max_steiner;   /* < 0: no limit on the points inserted */
};

/* Nothing is asked. */
struct tri_quality tri_quality_defaults(void);

/* Are sizes given by functions of the caller, which only some threads may call? */
static inline bool tri_asks_caller(const struct tri_quality *quality)
{
    return quality->edge_length || quality->unsuitable;
}

/* A larger bound on angles is treated as this one. */
double tri_worked_angle(const struct tri_quality *quality);

/* Writes into note that refinement works for a smaller angle than is asked for. False: it does not, and nothing is
 * written. */
enum { TRI_ANGLE_NOTE = 160 };
bool tri_note_lowered_angle(const struct tri_quality *quality, char note[TRI_ANGLE_NOTE]);

/* Is there any bound on sizes? */
static inline bool tri_has_sizes(const struct tri_quality *quality)
{
    return quality->max_area > 0 || quality->region_areas || tri_asks_caller(quality);
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

#endif
