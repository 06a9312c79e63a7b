/* Lengths that follow from the shape of the input: area bounds of regions, curves, channels.
 *
 * CURVES. The circle through three consecutive vertices gives their Menger curvature (K. Menger, Untersuchungen über
 * allgemeine Metrik, Mathematische Annalen 103, 1930).
 *
 * CHANNELS. The width at a wall is the diameter of the largest ball that touches the wall there and contains no
 * wall: local thickness (Hildebrand & Rüegsegger, Journal of Microscopy 185, 1997). The ball is found by shrinking:
 * while it contains a point of a wall, it is replaced by the ball that touches that point as well (Ma, Bae & Choi,
 * The Visual Computer 28, 2012). Once it touches a wall across, it must not shrink further into a corner or into the
 * roughness of its own wall. So it stops when the next point lies beside it (Peters & Ledoux, Computers &
 * Geosciences 90, 2016). Walls that are near along the boundary do not count as across. */
#include "triangle/size/sources.h"

static const double USUAL_GROWTH = 0.2; /* the growth if there is no limit */

static double growth_of(const struct tri_size_frame *frame)
{
    return frame->gradation < HUGE_VAL ? frame->gradation : USUAL_GROWTH;
}

static enum tri_status no_memory(struct tri_error *error)
{
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for sizes");
}

/* --- regions */

/* Returns the area bound of the triangle's region; infinite if it has none. */
static double area_in(const struct tri_mesh *mesh, tri_triangle_id t)
{
    const double area = mesh->regions[mesh->tri[t].region].max_area;
    return area > 0 ? area : HUGE_VAL;
}

enum tri_status tri_near_regions(struct tri_near *near, const struct tri_size_frame *frame, struct tri_error *error)
{
    const struct tri_mesh *mesh = frame->mesh;
    for (tri_triangle_id t = 0; t < mesh->n_triangles; t++)
        for (int e = 0; e < 3 && tri_is_live(&mesh->tri[t]); e++) {
            const tri_halfedge across = tri_across(mesh, tri_code(t, e));
            const double area = area_in(mesh, t);
            if (across < 0 || !(area < area_in(mesh, tri_of(across))))
                continue;
            const tri_vertex_id *v = mesh->tri[t].v;
            const double length = sqrt(area / TRI_EQUILATERAL) / mesh->unit;
            if (!tri_near_add(near, mesh->xy[v[tri_next[e]]], mesh->xy[v[tri_prev[e]]], length, growth_of(frame)))
                return no_memory(error);
        }
    return TRI_OK;
}

/* --- curves */

/* Returns the wanted length at b; infinite if the curve is straight or has a corner there. */
static double length_by_circle(struct tri_point a, struct tri_point b, struct tri_point c, double n)
{
    const double TWICE_PI = 6.283185307179586, CORNER = 0.5; /* cosine of 60 degrees */
    const double ux = b.x - a.x, uy = b.y - a.y, vx = c.x - b.x, vy = c.y - b.y;
    const double u = sqrt(ux * ux + uy * uy), v = sqrt(vx * vx + vy * vy), w = sqrt(tri_distance2(a, c));
    const double cross = fabs(ux * vy - uy * vx);
    return cross > 0 && ux * vx + uy * vy >= CORNER * u * v ? TWICE_PI * (u * v * w / (2 * cross)) / n : HUGE_VAL;
}

/* Returns for each vertex its two neighbours on the curve through it, or TRI_NONE twice if there is not exactly one
 * such curve. */
static tri_vertex_id (*chains_of(const struct tri_mesh *mesh))[2]
{
    tri_vertex_id(*chain)[2] = malloc(((size_t)mesh->n_vertices + 1) * sizeof *chain);
    int32_t *count = calloc((size_t)mesh->n_vertices + 1, sizeof *count);
    for (tri_parent_id s = 0; chain && count && s < mesh->n_parents; s++)
        for (int k = 0; k < 2; k++) {
            const tri_vertex_id v = mesh->parents[s].v[k];
            chain[v][count[v] & 1] = mesh->parents[s].v[1 - k];
            count[v]++;
        }
    for (tri_vertex_id v = 0; chain && count && v < mesh->n_vertices; v++)
        if (count[v] != 2)
            chain[v][0] = chain[v][1] = TRI_NONE;
    if (!count) {
        free(chain);
        return NULL;
    }
    free(count);
    return chain;
}

enum tri_status tri_near_curves(struct tri_near *near, const struct tri_size_frame *frame, double n,
                                struct tri_error *error)
{
    const struct tri_mesh *mesh = frame->mesh;
    const struct tri_point *xy = mesh->xy;
    tri_vertex_id(*chain)[2] = chains_of(mesh);
    enum tri_status status = chain ? TRI_OK : no_memory(error);
    for (tri_vertex_id v = 0; !status && v < mesh->n_vertices; v++) {
        if (chain[v][0] == TRI_NONE)
            continue;
        const double length = length_by_circle(xy[chain[v][0]], xy[v], xy[chain[v][1]], n);
        if (length < tri_size_cap(frame) && !tri_near_add(near, xy[v], xy[v], length, growth_of(frame)))
            status = no_memory(error);
    }
    free(chain);
    return status;
}

/* --- channels */

/* A wall whose distance along the boundary is at most FAR times the straight distance counts as the same, rough
 * wall. */
static const double FAR = 1.5;

enum { MOST_SHRINKINGS = 40, DEEPEST = 12, MOST_UNSEEN = 2 };

/* The position of a wall in its chain of walls. */
struct along {
    int32_t chain; /* number of the chain */
    double place; /* of its first end, along the chain */
    double sign;  /* 1: the wall runs along the chain; -1: against it */
};

struct channels {
    const struct tri_size_frame *frame; /* data common to all sources */
    struct tri_near walls; /* segments with length 0 and growth 1, for distances */
    tri_sub_id *sub;       /* [walls.n] subsegment of each wall */
    struct along *along;   /* [walls.n] position in its chain */
    double *around;        /* [walls.n] length of each closed chain; infinite for open ones */
    struct tri_near *near; /* receives the lengths */
    double n;              /* wanted number of edges across */
    uint32_t steps;        /* counter of tri_stop_is_due */
    enum tri_status status; /* first failure */
};

/* Is the subsegment on the boundary, or between two regions? */
static bool is_wall(const struct tri_mesh *mesh, const struct tri_subsegment *s)
{
    return tri_is_boundary(s) || mesh->tri[tri_of(s->side[0])].region != mesh->tri[tri_of(s->side[1])].region;
}

/* Returns the wall that continues wall `at` at its end v, or -1 if there is none or more than one. */
static int32_t wall_behind(const int32_t (*wall)[3], int32_t at, tri_vertex_id v)
{
    return wall[v][2] != 2 ? -1 : wall[v][0] == at ? wall[v][1] : wall[v][0];
}

/* Walks along the chain of a wall, starting from its end v, and sets the positions of all walls in it. */
static void follow(struct channels *c, const int32_t (*wall)[3], int32_t first, tri_vertex_id v, int32_t chain)
{
    const struct tri_subsegment *sub = c->frame->mesh->sub;
    double place = 0;
    int32_t at = first;
    do {
        const tri_vertex_id *ends = sub[c->sub[at]].v;
        const tri_vertex_id other = ends[0] == v ? ends[1] : ends[0];
        const double l = sqrt(tri_distance2(c->frame->mesh->xy[ends[0]], c->frame->mesh->xy[ends[1]]));
        c->along[at] = (struct along){chain, ends[0] == v ? place : place + l, ends[0] == v ? 1 : -1};
        place += l;
        v = other;
        at = wall_behind(wall, at, v);
    } while (at >= 0 && at != first);
    c->around[chain] = at == first ? place : HUGE_VAL;
}

/* Assigns all walls to chains. Returns false if memory ran out. */
static bool find_chains(struct channels *c)
{
    const struct tri_mesh *mesh = c->frame->mesh;
    int32_t(*wall)[3] = calloc((size_t)mesh->n_vertices + 1, sizeof *wall); /* two walls at each vertex, and the
                                                                               number of walls */
    for (int32_t k = 0; wall && k < c->walls.n; k++)
        for (int end = 0; end < 2; end++) {
            int32_t *at = wall[mesh->sub[c->sub[k]].v[end]];
            at[at[2]++ & 1] = k;
            c->along[k].chain = -1;
        }
    int32_t chains = 0;
    for (int closed = 0; wall && closed < 2; closed++) /* open chains from their ends first */
        for (int32_t k = 0; k < c->walls.n; k++)
            for (int end = 0; end < 2; end++) {
                const tri_vertex_id v = mesh->sub[c->sub[k]].v[end];
                if (c->along[k].chain < 0 && (closed || wall_behind((const int32_t(*)[3])wall, k, v) < 0))
                    follow(c, (const int32_t(*)[3])wall, k, v, chains++);
            }
    free(wall);
    return wall;
}

/* Are the subsegments on the same segment, or on two with a common end? */
static bool share_segment(const struct tri_mesh *mesh, tri_sub_id a, tri_sub_id b)
{
    const tri_vertex_id *v = mesh->parents[mesh->sub[a].parent].v, *w = mesh->parents[mesh->sub[b].parent].v;
    return v[0] == w[0] || v[0] == w[1] || v[1] == w[0] || v[1] == w[1];
}

/* Returns the distance along the chain between points on two walls. at_a, at_b: distance of each point from its
 * wall's first end. */
static double chain_distance(const struct channels *c, int32_t a, double at_a, int32_t b, double at_b)
{
    const struct along *p = &c->along[a], *q = &c->along[b];
    const double way = fabs(p->place + p->sign * at_a - q->place - q->sign * at_b);
    return p->chain == q->chain ? tri_lesser(way, c->around[p->chain] - way) : HUGE_VAL;
}

/* Returns the radius of the ball that touches the wall at x and another wall across from it, as seen from its
 * centre; infinite if there is none. normal: inward unit normal at x. */
static double shrink(const struct channels *c, int32_t wall, struct tri_point x, struct tri_point normal)
{
    const double ACROSS = -0.5, BESIDE = 0.5; /* cosines of 120 and 60 degrees */
    const double at_x = sqrt(tri_distance2(c->walls.item[wall].from, x));
    double radius = tri_size_cap(c->frame) / 8, found = HUGE_VAL;
    for (int k = 0; k < MOST_SHRINKINGS; k++) {
        const struct tri_point centre = {x.x + radius * normal.x, x.y + radius * normal.y};
        struct tri_point away;
        const int32_t other = tri_near_winner(&c->walls, centre, &away);
        const struct tri_point place = {centre.x + away.x, centre.y + away.y}, q = {place.x - x.x, place.y - x.y};
        const double ahead = q.x * normal.x + q.y * normal.y, l2 = q.x * q.x + q.y * q.y;
        const double next = ahead > 0 ? l2 / (2 * ahead) : HUGE_VAL;
        const double at_q = sqrt(tri_distance2(c->walls.item[other].from, place));
        if (!(next < 0.999 * radius) || (found < HUGE_VAL && next - ahead > BESIDE * next))
            break;
        radius = next;
        if (next - ahead <= ACROSS * next && !share_segment(c->frame->mesh, c->sub[wall], c->sub[other]) &&
            chain_distance(c, wall, at_x, other, at_q) > FAR * sqrt(l2))
            found = next;
        else if (next > found / 2) /* the found ball was only a step towards a corner */
            found = HUGE_VAL;
    }
    return found;
}

/* Adds lengths in front of a piece of a wall: from the ball at its middle and, if the piece is long compared with
 * the ball, from balls at its halves. If nothing is across from the middle, the halves are still tried. unseen:
 * number of successive pieces without a ball. */
static void measure(struct channels *c, int32_t wall, struct tri_point a, struct tri_point b, struct tri_point normal,
                    int depth, int unseen)
{
    const struct tri_point x = {(a.x + b.x) / 2, (a.y + b.y) / 2};
    const double radius = shrink(c, wall, x, normal);
    const struct tri_point centre = {x.x + radius * normal.x, x.y + radius * normal.y};
    if (tri_stop_is_due(c->frame->mesh->stop, &c->steps))
        c->status = TRI_STOPPED;
    if (radius < HUGE_VAL && !tri_near_add(c->near, x, centre, 2 * radius / c->n, growth_of(c->frame)))
        c->status = TRI_NO_MEMORY;
    if (!c->status && (radius < HUGE_VAL ? depth < DEEPEST && tri_distance2(a, b) > radius * radius
                                         : unseen < MOST_UNSEEN)) {
        unseen = radius < HUGE_VAL ? 0 : unseen + 1;
        measure(c, wall, a, x, normal, depth + 1, unseen);
        measure(c, wall, x, b, normal, depth + 1, unseen);
    }
}

static void measure_sides(struct channels *c, int32_t wall)
{
    const struct tri_subsegment *sub = &c->frame->mesh->sub[c->sub[wall]];
    const struct tri_point a = c->frame->mesh->xy[sub->v[0]], b = c->frame->mesh->xy[sub->v[1]];
    const double l = sqrt(tri_distance2(a, b));
    for (int side = 0; side < 2; side++) { /* the left side first */
        const double turn = (side ? -1 : 1) / l;
        if (sub->side[side] != TRI_NONE)
            measure(c, wall, a, b, (struct tri_point){(a.y - b.y) * turn, (b.x - a.x) * turn}, 0, 0);
    }
}

enum tri_status tri_near_channels(struct tri_near *near, const struct tri_size_frame *frame, double n,
                                  struct tri_error *error)
{
    const struct tri_mesh *mesh = frame->mesh;
    struct channels c = {.frame = frame, .near = near, .n = n};
    const size_t most = (size_t)mesh->n_subs + 1;
    c.sub = malloc(most * sizeof *c.sub);
    c.along = malloc(most * sizeof *c.along);
    c.around = malloc(most * sizeof *c.around);
    c.status = c.sub && c.along && c.around ? TRI_OK : TRI_NO_MEMORY;
    for (tri_sub_id s = 0; !c.status && s < mesh->n_subs; s++) {
        const tri_vertex_id *v = mesh->sub[s].v;
        if (!is_wall(mesh, &mesh->sub[s]))
            continue;
        c.sub[c.walls.n] = s;
        if (!tri_near_add(&c.walls, mesh->xy[v[0]], mesh->xy[v[1]], 0, 1))
            c.status = TRI_NO_MEMORY;
    }
    if (!c.status)
        c.status = find_chains(&c) ? tri_near_settle(&c.walls, frame, NULL) : TRI_NO_MEMORY;
    for (int32_t k = 0; !c.status && k < c.walls.n; k++)
        measure_sides(&c, k);
    tri_near_clear(&c.walls);
    free(c.sub);
    free(c.along);
    free(c.around);
    return c.status == TRI_STOPPED ? tri_fail_stopped(error) : c.status ? no_memory(error) : TRI_OK;
}
