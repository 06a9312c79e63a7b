/* Markers of used vertices. Attributes of vertices follow below.
 *
 * An input point keeps its marker unless that is 0. Any other vertex has the marker of a subsegment that ends at it,
 * or of an input segment through it, or 1 on the boundary. (Nothing of that input segment may be left if it was
 * carved, and another segment's marker may have taken precedence.) A vertex has 0 only if it lies inside and on no
 * subsegment with a marker. If several markers are possible, the mesher may choose. Inside the mesh, a crossing or a
 * vertex created on a segment may keep the 0 of one of its segments.
 *
 * Subsegments nearly always decide. If they do not, all input segments are tried, for at most MOST_TRIALS vertices. */
#include <math.h>
#include <stdlib.h>

#include "triangle/check/internal.h"

enum { MOST_TRIALS = 1000 };

struct markers {
    struct checker *c;
    int32_t *own;        /* [n_frame] marker of the input point at the vertex, 0: none */
    uint8_t *from_input; /* [n_frame] 1: there is an input point at the vertex */
    int32_t n_trials;    /* searches among all input segments so far */
    int32_t at;          /* index of the next frame vertex */
    enum tri_status status; /* status of reading points */
};

static void list_own(struct markers *m)
{
    const struct checker *c = m->c;
    for (int32_t i = c->input->n_points - 1; i >= 0; i--) { /* if several points coincide, the first one counts */
        int32_t v = c->twin[i];
        if (v < 0)
            continue;
        m->from_input[v] = 1;
        m->own[v] = c->input->markers != NULL ? c->input->markers[i] : 0;
    }
}

static bool is_on(const struct checker *c, int32_t id, struct tri_point p)
{
    const int32_t *ends = c->input->segments + 2 * (size_t)id;
    int32_t n = c->input->n_points;
    if (ends[0] < 0 || ends[0] >= n || ends[1] < 0 || ends[1] >= n)
        return false;
    const double *a = c->input->points + 2 * (size_t)ends[0], *b = c->input->points + 2 * (size_t)ends[1];
    double x = b[0] - a[0], y = b[1] - a[1], length = sqrt(x * x + y * y), margin = c->tolerance * length;
    double along = (p.x - a[0]) * x + (p.y - a[1]) * y;
    return fabs((p.x - a[0]) * y - (p.y - a[1]) * x) <= margin && along >= -margin && along <= length * length + margin;
}

/* Does an input segment with this marker pass through p? Returns true if that is unknown. */
static bool is_on_any(struct markers *m, struct tri_point p, int32_t marker)
{
    const struct tri_pslg *input = m->c->input;
    if (input->segment_markers == NULL)
        return false;
    if (m->n_trials++ >= MOST_TRIALS)
        return true;
    for (int32_t id = 0; id < input->n_segments; id++) {
        if (input->segment_markers[id] == marker && is_on(m->c, id, p))
            return true;
    }
    return false;
}

static bool may_be_zero(const struct markers *m, int32_t v, bool boundary)
{
    const struct checker *c = m->c;
    int32_t n_zero = 0, n = c->fan_first[v + 1] - c->fan_first[v];
    for (int32_t i = c->fan_first[v]; i < c->fan_first[v + 1]; i++)
        n_zero += c->segment_markers[c->fan[i] >> 1] == 0;
    return !boundary && (n_zero == n || (n_zero > 0 && !m->from_input[v]));
}

/* Is the marker of frame vertex v correct? */
static bool is_right(struct markers *m, int32_t v, int32_t marker)
{
    const struct checker *c = m->c;
    bool boundary = (c->state[c->vertex[v]] & CHECK_BOUNDARY) != 0;
    if (m->own[v] != 0)
        return marker == m->own[v];
    if (marker == 0)
        return may_be_zero(m, v, boundary);
    for (int32_t i = c->fan_first[v]; i < c->fan_first[v + 1]; i++)
        if (c->segment_markers[c->fan[i] >> 1] == marker)
            return true;
    return (marker == 1 && boundary) || is_on_any(m, check_point(c, v), marker);
}

/* Checks a vertex of the mesh. Vertices come in ascending order, like those of the frame. A vertex outside the frame
 * is not on a subsegment, not on the boundary and not an input point. */
static void check_one(struct markers *m, int64_t v, int32_t marker)
{
    struct checker *c = m->c;
    double place[2];
    while (m->at < c->n_frame && c->vertex[m->at] < v)
        m->at++;
    bool right = marker == 0;
    if (m->at < c->n_frame && c->vertex[m->at] == v) {
        right = is_right(m, m->at, marker);
    } else if (!right) {
        m->status = tri_check_read(c, TRI_CHECK_POINTS, v, 1, place);
        right = m->status != TRI_OK || is_on_any(m, (struct tri_point){place[0], place[1]}, marker);
    }
    if (!right)
        tri_check_fault(c, TRI_CHECK_VERTEX_MARKERS, "vertex %ld has marker %ld, which no segment there has",
                        check_number(c, v), (long)marker);
}

static void check_some(void *markers, int64_t first, int64_t n, const void *given)
{
    struct markers *m = markers;
    for (int64_t i = 0; i < n && m->status == TRI_OK; i++) {
        if (check_is_used(m->c, first + i))
            check_one(m, first + i, ((const int32_t *)given)[i]);
    }
}

static enum tri_status check_all(struct markers *m)
{
    list_own(m);
    tri_check_begin(m->c, TRI_CHECK_VERTEX_MARKERS);
    enum tri_status status = tri_check_each_slice(m->c, TRI_CHECK_POINT_MARKERS, m->c->n_points, sizeof(int32_t),
                                                  check_some, m);
    return status != TRI_OK ? status : m->status;
}

enum tri_status tri_check_vertex_markers(struct checker *c)
{
    if (c->input == NULL || !check_is_given(c, TRI_CHECK_POINT_MARKERS) ||
        !check_is_given(c, TRI_CHECK_SEGMENT_MARKERS))
        return TRI_OK;
    struct markers m = {.c = c};
    m.own = tri_check_zeros(c->n_frame, sizeof *m.own);
    m.from_input = tri_check_zeros(c->n_frame, 1);
    enum tri_status status = m.own != NULL && m.from_input != NULL ? check_all(&m) : TRI_NO_MEMORY;
    free(m.own);
    free(m.from_input);
    return status;
}

/* Attributes of vertices. Input vertices must keep theirs. Attributes of other vertices lie on a surface over the
 * triangulation of the input, which is not rebuilt here. So they are only compared with the range of the input's
 * attributes.
 *
 * The rounding error of interpolation grows as triangles become thinner, hence the tolerance. */

static const double TOLERANCE = 1e-6; /* as a fraction of the attribute's range in the input */

struct range {
    double low, high;                 /* limits including the tolerance */
};

struct judging {
    struct checker *c;
    struct range *range; /* [attributes] range of each attribute in the input */
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
