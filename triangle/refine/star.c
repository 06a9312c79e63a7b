#include "triangle/refine/star.h"

#include "triangle/geometry/predicates.h"
#include "triangle/tunables.h"

bool tri_star_find(const struct tri_smooth *r, tri_vertex_id v, int32_t block, struct tri_star *s, bool *is_here)
{
    const struct tri_mesh *mesh = r->mesh;
    const tri_triangle_id first = r->corner[v];
    *is_here = block < 0 || r->home[v] == block;
    s->n = 0;
    if (first == TRI_NONE || !*is_here)
        return false;
    tri_triangle_id t = first;
    do {
        const struct tri_triangle *at = &mesh->tri[t];
        const int k = tri_corner_of(at, v);
        const tri_vertex_id q = at->v[tri_next[k]];
        *is_here = block < 0 || r->home[q] == block;
        if (!*is_here)
            return false;
        const tri_link out = at->n[k], on = at->n[tri_next[k]];
        if (s->n == TRI_MOST_RIM || on < 0 || at->region != mesh->tri[first].region ||
            (out >= 0 && mesh->tri[tri_of(out)].region != at->region))
            return false;
        s->triangle[s->n] = t;
        s->id[s->n] = q;
        s->rim[s->n++] = mesh->xy[q];
        t = tri_of(on);
    } while (t != first);
    s->rim[s->n] = s->rim[0];
    return true;
}

bool tri_star_touch(const struct tri_star *s, struct tri_flips *flips)
{
    for (int i = 0; i < s->n; i++)
        if (!tri_flip_touch(flips, s->triangle[i]))
            return false;
    return true;
}

struct tri_worth tri_star_worth(const struct tri_smooth *r, const struct tri_star *s, struct tri_point x)
{
    const double TWO_ROOT_3 = 3.4641016151377544;
    struct tri_worth w = {0, 2, 0};
    for (int i = 0; i < s->n; i++) {
        const struct tri_point a = {s->rim[i].x - x.x, s->rim[i].y - x.y};
        const struct tri_point b = {s->rim[i + 1].x - x.x, s->rim[i + 1].y - x.y}, c = {b.x - a.x, b.y - a.y};
        const double area2 = a.x * b.y - a.y * b.x, la = a.x * a.x + a.y * a.y, lb = b.x * b.x + b.y * b.y;
        const double lc = c.x * c.x + c.y * c.y, q = TWO_ROOT_3 * area2 / (la + lb + lc);
        w.sum += 1 / q;
        w.least = tri_lesser(w.least, q);
        w.n_bad += area2 * area2 < r->sin2 * tri_longer_product(la, lb, lc);
    }
    return w;
}

/* Returns the weighted mean of the ideal apexes over the rim edges, for a vertex at x. */
static struct tri_point better_place(const struct tri_star *s, struct tri_point x)
{
    const double HALF_ROOT_3 = 0.8660254037844386;
    double sum_x = 0, sum_y = 0, sum = 0;
    for (int i = 0; i < s->n; i++) {
        const struct tri_point a = s->rim[i], e = {s->rim[i + 1].x - a.x, s->rim[i + 1].y - a.y};
        const double weight = 1 / (e.x * (x.y - a.y) - e.y * (x.x - a.x)); /* 1 / (l t) */
        struct tri_point apex = {a.x + 0.5 * e.x - HALF_ROOT_3 * e.y, a.y + 0.5 * e.y + HALF_ROOT_3 * e.x};
        const double dx = x.x - apex.x, dy = x.y - apex.y, shift = 0.5 * weight * (dx * dx + dy * dy);
        sum_x += weight * (apex.x + shift * e.y); /* gradient with respect to t: along the normal, away from the edge */
        sum_y += weight * (apex.y - shift * e.x);
        sum += weight;
    }
    return (struct tri_point){sum_x / sum, sum_y / sum};
}

static bool is_better(const struct tri_worth *now, const struct tri_worth *then, int allowed_bad)
{
    return then->least > TRI_SMOOTH_LEAST && then->sum < now->sum - TRI_SMOOTH_GAIN && then->n_bad <= allowed_bad &&
           (then->least >= now->least || then->least > TRI_SMOOTH_GOOD);
}

bool tri_star_find_place(const struct tri_smooth *r, const struct tri_star *s, int allowed_bad, struct tri_point *x)
{
    struct tri_worth now = tri_star_worth(r, s, *x);
    bool found = false, again = now.least <= TRI_SMOOTH_FINE;
    for (int round = 0; again && round < 2; round++) {
        const struct tri_point there = better_place(s, *x);
        again = false;
        for (double step = 1; !again && step > 0.2; step /= 2) {
            const struct tri_point p = tri_point_between(*x, there, step);
            const struct tri_worth then = tri_star_worth(r, s, p);
            again = is_better(&now, &then, allowed_bad);
            if (again) {
                *x = p;
                now = then;
                found = true;
            }
        }
    }
    return found;
}

bool tri_star_is_oriented(const struct tri_star *s, struct tri_point x)
{
    for (int i = 0; i < s->n; i++)
        if (tri_orient2d(x, s->rim[i], s->rim[i + 1]) <= 0)
            return false;
    return true;
}
