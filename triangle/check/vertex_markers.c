/* Markers of vertices in use.
 *
 * An input point keeps its own unless that is 0. Any other vertex has the marker of a subsegment at it, or of an input
 * segment through it (of which nothing may be left there, where it was carved, and whose marker another one's may
 * precede), or 1 on the boundary; 0 only if it lies inside and on no subsegment with a marker. Which of several is the
 * mesher's choice; a crossing, and what is made on a segment, may keep the 0 of one of its segments inside the mesh.
 *
 * Subsegments tell nearly always. Where they do not, all input segments are tried, for MOST_TRIALS vertices. */
#include <stdlib.h>

#include "triangle/check/internal.h"

enum { MOST_TRIALS = 1000 };

struct markers {
    struct checker *c;
    int32_t *own;         /* [n_points] marker of the input point at the vertex that has one, else 0 */
    uint8_t *from_input;  /* [n_points] is there an input point? */
    uint8_t *is_boundary; /* [n_points] */
    int32_t n_trials;
};

static void list_own(struct markers *m)
{
    const struct checker *c = m->c;
    for (int32_t i = c->input->n_points - 1; i >= 0; i--) { /* of several at one place the first one counts */
        int32_t v = c->twin[i];
        if (v < 0)
            continue;
        m->from_input[v] = 1;
        m->own[v] = c->input->markers != NULL ? c->input->markers[i] : 0;
    }
    for (int32_t h = 0; h < c->n_half_edges; h++) {
        if (c->link[h] < 0)
            m->is_boundary[check_org(c, h)] = m->is_boundary[check_dest(c, h)] = 1;
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

/* Does an input segment with this marker pass the vertex? Unknown counts as yes. */
static bool is_on_any(struct markers *m, int32_t v, int32_t marker)
{
    const struct tri_pslg *input = m->c->input;
    if (input->segment_markers == NULL)
        return false;
    if (m->n_trials++ >= MOST_TRIALS)
        return true;
    for (int32_t id = 0; id < input->n_segments; id++) {
        if (input->segment_markers[id] == marker && is_on(m->c, id, check_point(m->c, v)))
            return true;
    }
    return false;
}

static bool may_be_zero(const struct markers *m, int32_t v)
{
    const struct checker *c = m->c;
    int32_t n_zero = 0, n = c->fan_first[v + 1] - c->fan_first[v];
    for (int32_t i = c->fan_first[v]; i < c->fan_first[v + 1]; i++)
        n_zero += c->mesh->segment_markers[c->fan[i] >> 1] == 0;
    return !m->is_boundary[v] && (n_zero == n || (n_zero > 0 && !m->from_input[v]));
}

static bool is_right(struct markers *m, int32_t v)
{
    const struct checker *c = m->c;
    int32_t marker = c->mesh->point_markers[v];
    if (m->own[v] != 0)
        return marker == m->own[v];
    if (marker == 0)
        return may_be_zero(m, v);
    for (int32_t i = c->fan_first[v]; i < c->fan_first[v + 1]; i++)
        if (c->mesh->segment_markers[c->fan[i] >> 1] == marker)
            return true;
    return (marker == 1 && m->is_boundary[v]) || is_on_any(m, v, marker);
}

static void check_all(struct markers *m)
{
    struct checker *c = m->c;
    list_own(m);
    tri_check_begin(c, TRI_CHECK_VERTEX_MARKERS);
    for (int32_t v = 0; v < c->mesh->n_points; v++) {
        if (!check_is_used(c, v) || is_right(m, v))
            continue;
        tri_check_fault(c, TRI_CHECK_VERTEX_MARKERS, "vertex %ld has marker %ld, which no segment there has",
                        check_number(c, v), (long)c->mesh->point_markers[v]);
    }
}

enum tri_status tri_check_vertex_markers(struct checker *c)
{
    if (c->input == NULL || c->mesh->point_markers == NULL || c->mesh->segment_markers == NULL)
        return TRI_OK;
    struct markers m = {.c = c};
    int32_t n = c->mesh->n_points;
    m.own = tri_check_zeros(n, sizeof *m.own);
    m.from_input = tri_check_zeros(n, 1);
    m.is_boundary = tri_check_zeros(n, 1);
    bool room = m.own && m.from_input && m.is_boundary;
    if (room)
        check_all(&m);
    free(m.own);
    free(m.from_input);
    free(m.is_boundary);
    return room ? TRI_OK : TRI_NO_MEMORY;
}
