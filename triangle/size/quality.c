/* Bounds. */
#include "triangle/size/quality.h"

#include <math.h>
#include <stdio.h>

#include "triangle/geometry/shape.h"
#include "triangle/tunables.h"

struct tri_quality tri_quality_defaults(void) { return (struct tri_quality){.max_steiner = -1}; }

double tri_worked_angle(const struct tri_quality *quality)
{
    return fmin(quality->min_angle, quality->conforming ? TRI_CONFORMING_ANGLE : TRI_USUAL_ANGLE);
}

bool tri_note_lowered_angle(const struct tri_quality *quality, char note[TRI_ANGLE_NOTE])
{
    const double worked = tri_worked_angle(quality);
    if (quality->min_angle > worked)
        snprintf(note, TRI_ANGLE_NOTE, "an angle bound of %g degrees is above %g: triangles are made for %g",
                 quality->min_angle, worked, worked);
    return quality->min_angle > worked;
}

struct tri_bounds tri_bounds_for(double min_angle, bool conforming)
{
    struct tri_bounds bounds = {0, 0, 0};
    if (!(min_angle > 0)) {
        /* No bound: still keep away from subsegments, as for 20 degrees, or triangles come out flat. */
        bounds.lens_cos2 = conforming ? 0 : 0.58682408883346604; /* cos^2 of 40 degrees */
        return bounds;
    }
    double cosine = tri_cos_degrees(min_angle < 60 ? min_angle : 60), twice = 2 * cosine * cosine - 1;
    bounds.sin2 = 1 - cosine * cosine;
    if (!conforming)
        bounds.lens_cos2 = twice > 0 ? twice * twice : 0;
    /* The off-centre that sees its edge under exactly the angle bound lies at 0.5 of this (Üngör 2004); 0.2% nearer,
     * rounding cannot make the new triangle bad. */
    bounds.off_centre = TRI_OFF_CENTRE * sqrt((1 + cosine) / (1 - cosine));
    return bounds;
}
