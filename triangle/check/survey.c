/* Brings coordinates into the range of the predicates. If coordinates are very large or very small as a whole, the
 * mesh and the input are multiplied by a power of two, and results below 2^-216 are rounded. Otherwise the
 * multiplication is exact. It affects areas only, which bounds.c scales back. */
#include <stdlib.h>

#include "triangle/check/internal.h"

struct survey {
    bool exact, finite; /* all coordinates are in range; are finite */
    double largest;     /* largest absolute coordinate */
};

static bool are_exact(const double *values, int64_t n)
{
    for (int64_t i = 0; i < n; i++) {
        if (!tri_is_exact_coordinate(values[i]))
            return false;
    }
    return true;
}

/* The survey so far, the current values, and the results of the shares. */
struct looking {
    const struct checker *c;
    struct survey all; /* of the slices so far */
    const double *values; /* current slice */
    struct survey share[CHECK_MOST_SHARES]; /* of each share of the slice */
};

static const struct survey nothing = {true, true, 0};

static void look_at_share(void *user, const struct check_share *share)
{
    struct looking *l = user;
    struct survey s = nothing;
    for (int64_t i = share->first; i < share->end; i++) {
        s.exact = s.exact && tri_is_exact_coordinate(l->values[i]);
        s.finite = s.finite && isfinite(l->values[i]);
        s.largest = fmax(s.largest, fabs(l->values[i]));
    }
    l->share[share->number] = s;
}

static void look(void *looking, int64_t first, int64_t n, const void *points)
{
    struct looking *l = looking;
    (void)first;
    l->values = points;
    for (int i = 0; i < CHECK_MOST_SHARES; i++)
        l->share[i] = nothing;
    tri_check_in_shares(l->c, 2 * n, look_at_share, l);
    for (int i = 0; i < CHECK_MOST_SHARES; i++) {
        l->all.exact = l->all.exact && l->share[i].exact;
        l->all.finite = l->all.finite && l->share[i].finite;
        l->all.largest = fmax(l->all.largest, l->share[i].largest);
    }
}

static void judge(void *checker, int64_t first, int64_t n, const void *points)
{
    struct checker *c = checker;
    for (int64_t i = 0; i < n; i++) {
        const double *p = (const double *)points + 2 * i;
        if (tri_is_exact_point((struct tri_point){p[0], p[1]}))
            continue;
        c->at = 3 * c->n_triangles + first + i; /* keys of corners come first */
        tri_check_fault(c, TRI_CHECK_ARRAYS, "vertex %ld at (%.17g, %.17g) is beyond the range of exact arithmetic",
                        check_number(c, first + i), check_given(c, p[0]), check_given(c, p[1]));
    }
    c->at = 0;
}

/* With a larger exponent, multiples of the smallest double would be outside the range of coordinates
 * (triangle/geometry/point.h). */
enum { MOST = 1074 - 268 };

/* Returns 0 if coordinates have ordinary size or one is not finite. Otherwise returns the exponent that scales the
 * largest coordinate to 1, as far as possible. */
static int choose_exponent(const struct survey *s)
{
    double largest = s->largest;
    if (!s->finite || largest == 0 || (largest >= 0x1p-100 && largest <= 0x1p199))
        return 0;
    return -ilogb(largest) < MOST ? -ilogb(largest) : MOST;
}

static double *scale(const double *values, int64_t n, int exponent)
{
    double *scaled = tri_check_array(n, sizeof *scaled);
    for (int64_t i = 0; scaled != NULL && i < n; i++)
        scaled[i] = tri_round_coordinate(ldexp(values[i], exponent));
    return scaled;
}

/* Scales the points of the regions only. */
static double *scale_regions(const struct tri_pslg *input, int exponent)
{
    double *scaled = scale(input->regions, 4 * (int64_t)input->n_regions, exponent);
    for (size_t k = 0; scaled != NULL && k < (size_t)input->n_regions; k++) {
        scaled[4 * k + 2] = input->regions[4 * k + 2];
        scaled[4 * k + 3] = input->regions[4 * k + 3];
    }
    return scaled;
}

static enum tri_status scale_input(struct checker *c)
{
    if (c->input == NULL)
        return TRI_OK;
    c->scaled[0] = scale(c->input->points, 2 * (int64_t)c->input->n_points, c->exponent);
    c->scaled[1] = scale(c->input->holes, 2 * (int64_t)c->input->n_holes, c->exponent);
    c->scaled[2] = scale_regions(c->input, c->exponent);
    if (c->scaled[0] == NULL || c->scaled[1] == NULL || c->scaled[2] == NULL)
        return TRI_NO_MEMORY;
    c->scaled_input = *c->input;
    c->scaled_input.points = c->scaled[0];
    c->scaled_input.holes = c->scaled[1];
    c->scaled_input.regions = c->scaled[2];
    c->input = &c->scaled_input;
    return TRI_OK;
}

enum tri_status tri_check_survey(struct checker *c)
{
    const size_t bytes = 2 * sizeof(double);
    struct looking l = {.c = c, .all = nothing};
    tri_check_begin(c, TRI_CHECK_ARRAYS);
    enum tri_status status = tri_check_each_slice(c, TRI_CHECK_POINTS, c->n_points, bytes, look, &l);
    if (status != TRI_OK)
        return status;
    if (!l.all.exact || (c->input != NULL && !are_exact(c->input->points, 2 * (int64_t)c->input->n_points))) {
        c->exponent = choose_exponent(&l.all);
        c->rounded = true;
        status = scale_input(c); /* the mesh is scaled when it is read */
        status = status ? status : tri_check_each_slice(c, TRI_CHECK_POINTS, c->n_points, bytes, judge, c);
    }
    c->tolerance = TRI_CHECK_ULPS * 0x1p-52 * ldexp(l.all.largest, c->exponent);
    return status;
}
