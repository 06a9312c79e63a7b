/* Attributes of vertices: those of the input keep theirs. Those of others lie on a surface over the triangulation of
 * the input, which is not made here: so they are judged by the range of the input's alone.
 *
 * Interpolation rounds, the more the thinner the triangle is: hence the tolerance. */
#include <math.h>
#include <stdlib.h>

#include "triangle/check/internal.h"

static const double TOLERANCE = 1e-6; /* of the range of an attribute in the input */

struct range {
    double low, high;
};

struct judging {
    struct checker *c;
    struct range *range; /* [attributes] */
};

static void find_ranges(const struct tri_pslg *input, struct range *range)
{
    const size_t n = (size_t)input->n_attributes;
    for (size_t k = 0; k < n; k++)
        range[k] = (struct range){HUGE_VAL, -HUGE_VAL};
    for (size_t i = 0; i < (size_t)input->n_points; i++)
        for (size_t k = 0; k < n; k++) {
            range[k].low = fmin(range[k].low, input->attributes[n * i + k]);
            range[k].high = fmax(range[k].high, input->attributes[n * i + k]);
        }
    for (size_t k = 0; k < n; k++) {
        double more = TOLERANCE * (range[k].high - range[k].low);
        range[k].low -= more;
        range[k].high += more;
    }
}

static void judge_vertex(struct checker *c, int64_t v, const double *value, const struct range *range)
{
    const struct tri_pslg *input = c->input;
    const size_t n = (size_t)input->n_attributes;
    const bool is_input = v < input->n_points && !c->options->renumbered;
    for (size_t k = 0; k < n; k++) {
        if (is_input && value[k] != input->attributes[n * (size_t)v + k])
            tri_check_fault(c, TRI_CHECK_VERTEX_ATTRIBUTES,
                            "attribute %zu of vertex %ld is %.17g; the input's is %.17g", k, check_number(c, v),
                            value[k], input->attributes[n * (size_t)v + k]);
        else if (!(value[k] >= range[k].low && value[k] <= range[k].high))
            tri_check_fault(c, TRI_CHECK_VERTEX_ATTRIBUTES,
                            "attribute %zu of vertex %ld is %.17g; the input's are from %.17g to %.17g", k,
                            check_number(c, v), value[k], range[k].low, range[k].high);
    }
}

static void judge_vertices(void *judging, int64_t first, int64_t n, const void *values)
{
    const struct judging *j = judging;
    for (int64_t i = 0; i < n; i++)
        judge_vertex(j->c, first + i, (const double *)values + i * j->c->input->n_attributes, j->range);
}

enum tri_status tri_check_attributes(struct checker *c)
{
    if (!check_is_given(c, TRI_CHECK_POINT_ATTRIBUTES) || c->input == NULL)
        return TRI_OK;
    tri_check_begin(c, TRI_CHECK_VERTEX_ATTRIBUTES);
    if (c->source->n_point_attributes != c->input->n_attributes) {
        tri_check_fault(c, TRI_CHECK_VERTEX_ATTRIBUTES, "vertices have %ld attributes; those of the input have %ld",
                        (long)c->source->n_point_attributes, (long)c->input->n_attributes);
        return TRI_OK;
    }
    const int64_t n = c->input->n_attributes;
    struct judging j = {c, tri_check_array(n, sizeof *j.range)};
    if (j.range == NULL)
        return TRI_NO_MEMORY;
    find_ranges(c->input, j.range);
    enum tri_status status = tri_check_each_slice(c, TRI_CHECK_POINT_ATTRIBUTES, c->n_points,
                                                  (size_t)n * sizeof(double), judge_vertices, &j);
    free(j.range);
    return status;
}
