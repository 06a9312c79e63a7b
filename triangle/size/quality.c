/* Computes bounds and wanted sizes, and judges triangles by them. */
#include "triangle/size/quality.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>

#include "triangle/geometry/shape.h"
#include "triangle/tunables.h"

struct tri_quality tri_quality_defaults(void) { return (struct tri_quality){.max_steiner = -1}; }

double tri_worked_angle(const struct tri_quality *quality)
{
    return fmin(quality->min_angle, quality->conforming ? TRI_CONFORMING_ANGLE : TRI_USUAL_ANGLE);
}

bool tri_allows_front(const struct tri_quality *quality) { return tri_worked_angle(quality) <= TRI_LATTICE_ANGLE; }

bool tri_wants_lattice(const struct tri_quality *quality)
{
    return quality->lattice && tri_has_sizes(quality) && !tri_sizes_vary(quality) &&
           tri_allows_front(quality);
}

double tri_lattice_length(const struct tri_quality *q)
{
    const bool is_alone = q->lengths && !(q->max_area > 0) && !q->region_areas && !tri_asks_caller(q);
    return is_alone && q->lattice && q->front && tri_allows_front(q) ? tri_lengths_uniform(q->lengths) : 0;
}

double tri_mean_over_bound(const struct tri_quality *quality)
{
    return tri_wants_lattice(quality) ? TRI_LATTICE_MEAN : TRI_MEAN_OVER_BOUND;
}

double tri_most_over_bound(const struct tri_quality *quality)
{
    return tri_wants_lattice(quality) ? 1 : TRI_MOST_OVER_BOUND;
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
        /* Even without an angle bound, points keep away from subsegments as for 20 degrees, to avoid flat triangles. */
        bounds.lens_cos2 = conforming ? 0 : 0.58682408883346604; /* cos^2 of 40 degrees */
        return bounds;
    }
    double cosine = tri_cos_degrees(min_angle < 60 ? min_angle : 60), twice = 2 * cosine * cosine - 1;
    bounds.sin2 = 1 - cosine * cosine;
    if (!conforming)
        bounds.lens_cos2 = twice > 0 ? twice * twice : 0;
    /* The off-centre that sees its edge under exactly the angle bound lies at height 0.5 * sqrt(..) (Üngör 2004).
     * The factor TRI_OFF_CENTRE places it 0.2% lower, so that rounding cannot make the new triangle bad. */
    bounds.off_centre = TRI_OFF_CENTRE * sqrt((1 + cosine) / (1 - cosine));
    return bounds;
}

struct tri_bounds tri_bounds_of(const struct tri_quality *quality, double min_angle)
{
    struct tri_bounds bounds = tri_bounds_for(min_angle, quality->conforming);
    if (tri_wants_lattice(quality) || tri_lattice_length(quality) > 0)
        bounds.sin2 *= 1 - TRI_LATTICE_ROUNDING;
    return bounds;
}

/* --- sizes */

/* The value that means no bound. */
static const double ANY_LENGTH = 1e100;

/* Converts an area bound of the caller to twice the area in the mesh's units. The unit is a power of two whose
 * square may exceed the range of doubles. */
static double to_area2(const struct tri_asked *a, double bound)
{
    return 2 * (bound * tri_area_scale(a->quality) / a->mesh->unit / a->mesh->unit);
}

struct tri_asked tri_asked_of(const struct tri_mesh *mesh, const struct tri_quality *quality)
{
    struct tri_asked a = {mesh, quality, HUGE_VAL, sqrt(tri_area_scale(quality))};
    if (quality->max_area > 0)
        a.area2 = to_area2(&a, quality->max_area);
    return a;
}

double tri_area2_in_region(const struct tri_asked *a, tri_region_id region)
{
    double own = a->mesh->regions[region].max_area;
    return own > 0 ? tri_lesser(to_area2(a, own), a->area2) : a->area2;
}

/* Is the triangle larger than the lengths at p allow? A length that is not above 0 is ignored, because no mesh could
 * satisfy it. Computed in the mesh's units, because squares in the caller's units may exceed the range of doubles. */
static bool is_above_length(const struct tri_asked *asked, const struct tri_point p[4], double area)
{
    const struct tri_quality *q = asked->quality;
    const double unit = asked->mesh->unit;
    for (int k = 3; k >= 0; k--) {
        const double at[2] = {p[k].x * unit, p[k].y * unit}, length = q->edge_length(q->edge_length_user, at) / unit;
        if (length > 0 && area > TRI_EQUILATERAL * length * length)
            return true;
    }
    return false;
}

/* Does the size test reject the triangle shrunk about a point to 1 / scale of its area? */
static bool test_refuses(const struct tri_asked *asked, const struct tri_point corner[3], struct tri_point about,
                         double scale)
{
    const double unit = asked->mesh->unit, factor = 1 / sqrt(scale);
    struct tri_point whole[3];
    double p[3][2];
    for (int k = 0; k < 3; k++) {
        whole[k] = (struct tri_point){corner[k].x * unit, corner[k].y * unit};
        p[k][0] = scale == 1 ? whole[k].x : (about.x + factor * (corner[k].x - about.x)) * unit;
        p[k][1] = scale == 1 ? whole[k].y : (about.y + factor * (corner[k].y - about.y)) * unit;
    }
    const double area = tri_area_of(whole[0], whole[1], whole[2]) / scale;
    return asked->quality->unsuitable(asked->quality->unsuitable_user, p[0], p[1], p[2], area) != 0;
}

bool tri_is_refused(const struct tri_asked *asked, struct tri_point a, struct tri_point b, struct tri_point c)
{
    const struct tri_point place[4] = {a, b, c, {(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3}}; /* the corners and,
                                                                                                    last, the
                                                                                                    centroid */
    const double scale = tri_area_scale(asked->quality);
    assert(scale > 0 && tri_asks_caller(asked->quality));
    if (asked->quality->edge_length && is_above_length(asked, place, tri_area_of(a, b, c) / scale))
        return true;
    return asked->quality->unsuitable && test_refuses(asked, place, place[3], scale);
}

bool tri_is_unsuitable(const struct tri_asked *asked, const tri_vertex_id v[3])
{
    const struct tri_point *xy = asked->mesh->xy;
    return tri_is_refused(asked, xy[v[0]], xy[v[1]], xy[v[2]]);
}

bool tri_is_too_large(const struct tri_asked *asked, const struct tri_triangle *t, const struct tri_shape *shape)
{
    return shape->area2 > tri_area2_bound(asked, t->region) ||
           (asked->quality->lengths &&
            tri_is_too_long(asked, t->v, shape->l[0], shape->l[1], shape->l[2], shape->area2)) ||
           (tri_asks_caller(asked->quality) && tri_is_unsuitable(asked, t->v));
}

static double probe(const struct tri_asked *asked, const struct tri_point triangle[3], struct tri_point at)
{
    enum { DEEPEST = 16 };
    const double area = tri_area_of(triangle[0], triangle[1], triangle[2]);
    double scale = tri_area_scale(asked->quality);
    for (int k = 0; k <= DEEPEST; k++, scale *= 4)
        if (!test_refuses(asked, triangle, at, scale))
            return k > 0 ? 1 / sqrt(scale) * sqrt(2 * area / TRI_EQUILATERAL) : ANY_LENGTH;
    return ANY_LENGTH;
}

double tri_asked_length(const struct tri_asked *asked, const struct tri_point triangle[3], struct tri_point at)
{
    const struct tri_quality *quality = asked->quality;
    const double unit = asked->mesh->unit;
    double length = ANY_LENGTH;
    if (quality->lengths)
        length = tri_lesser(length, tri_lengths_at(quality->lengths, at) / sqrt(TRI_MEAN_OVER_BOUND));
    if (quality->edge_length) {
        const double p[2] = {at.x * unit, at.y * unit}, here = quality->edge_length(quality->edge_length_user, p);
        length = here > 0 ? tri_lesser(length, here / unit) : length;
    }
    if (quality->unsuitable)
        length = tri_lesser(length, probe(asked, triangle, at));
    return length < ANY_LENGTH ? asked->coarser * length : length;
}

struct asking {
    const struct tri_mesh *mesh; /* lengths go into mesh->length */
    const struct tri_lengths *lengths; /* borrowed */
};

static void ask_share(void *context, size_t share)
{
    const struct asking *asking = context;
    const struct tri_range range = tri_share(share, asking->mesh->n_vertices);
    for (tri_vertex_id v = range.first; v < range.last; v++)
        asking->mesh->length[v] = tri_lengths_at(asking->lengths, asking->mesh->xy[v]);
}

enum tri_status tri_ask_lengths(struct tri_mesh *mesh, const struct tri_lengths *lengths,
                                const struct tri_executor *executor, struct tri_error *error)
{
    struct asking asking = {mesh, lengths};
    enum tri_status status = tri_mesh_have_lengths(mesh, lengths, error);
    if (!status && lengths)
        tri_execute(executor, tri_shares(mesh->n_vertices), ask_share, &asking);
    return status;
}

/* --- judging triangles */

struct tri_criterion tri_criterion_for(const struct tri_mesh *mesh, const struct tri_quality *quality)
{
    return (struct tri_criterion){tri_asked_of(mesh, quality), tri_bounds_of(quality, quality->min_angle)};
}

enum tri_badness tri_judge(const struct tri_criterion *c, const struct tri_triangle *t, const struct tri_shape *shape)
{
    double product = tri_longer_product(shape->l[0], shape->l[1], shape->l[2]);
    if (shape->area2 * shape->area2 < c->bounds.sin2 * product)
        return TRI_BAD_ANGLE;
    return tri_is_too_large(&c->asked, t, shape) ? TRI_BAD_SIZE : TRI_GOOD;
}

bool tri_is_protected(const struct tri_quality *quality, const struct tri_subsegment *s)
{
    return quality->protect >= 2 || (quality->protect == 1 && tri_is_boundary(s));
}

bool tri_is_flat(const struct tri_mesh *mesh, const struct tri_shape *shape)
{
    return shape->area2 * shape->area2 < mesh->limits.shortest2 * tri_longest2(shape);
}
