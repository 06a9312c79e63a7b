/* Lengths that grow with the distance from segments and points.
 *
 * Each segment has its own length and growth. So boundaries, regions and narrow gaps share one search: a contest
 * (candidates.h) whose key is h itself. */
#include "triangle/size/sources.h"

#include "triangle/base/hash.h"

/* In cells with sides up to SMALL * h, the result may exceed h by TOLERANCE * h. */
static const double SMALL = 0.5, TOLERANCE = 0.002;

bool tri_near_add(struct tri_near *near, struct tri_point a, struct tri_point b, double length, double growth)
{
    const struct tri_point along = {b.x - a.x, b.y - a.y};
    const double l2 = along.x * along.x + along.y * along.y;
    if (!tri_grow(&near->item, &near->capacity, near->n + 1, sizeof *near->item))
        return false;
    near->item[near->n++] = (struct tri_near_item){a, along, l2 > 0 ? 1 / l2 : 0, length, growth};
    return true;
}

/* Returns the vector from p to the nearest point of a segment. */
static inline struct tri_point away_from(const struct tri_near_item *s, struct tri_point p)
{
    const double x = p.x - s->from.x, y = p.y - s->from.y;
    const double t = tri_lesser(tri_larger((x * s->along.x + y * s->along.y) * s->inverse, 0), 1);
    return (struct tri_point){t * s->along.x - x, t * s->along.y - y};
}

static inline double length_at(const struct tri_near_item *s, struct tri_point p)
{
    const struct tri_point away = away_from(s, p);
    return s->length + s->growth * sqrt(away.x * away.x + away.y * away.y);
}

static struct tri_key key(const void *user, int32_t item, struct tri_point p)
{
    const struct tri_near_item *s = &((const struct tri_near *)user)->item[item];
    return tri_key_of_distance(s->length, s->growth, away_from(s, p));
}

static double allowed(const void *user, int32_t winner, double h, double side)
{
    (void)user;
    (void)winner;
    return side <= SMALL * h ? TOLERANCE * h : 0;
}

enum tri_status tri_near_settle(struct tri_near *near, const struct tri_size_frame *frame, struct tri_error *error)
{
    const struct tri_contest contest = {key, allowed, near};
    return near->n == 0 ? TRI_OK : tri_candidates_make(&near->candidates, &contest, near->n, frame, error);
}

double tri_near_at(const struct tri_near *near, struct tri_point p)
{
    int32_t n;
    const int32_t *list = tri_candidates_at(&near->candidates, p, &n);
    double h = length_at(&near->item[list[0]], p);
    for (int32_t i = 1; i < n; i++)
        h = tri_lesser(h, length_at(&near->item[list[i]], p));
    return h;
}

int32_t tri_near_winner(const struct tri_near *near, struct tri_point p, struct tri_point *away)
{
    int32_t n, winner = 0;
    const int32_t *list = tri_candidates_at(&near->candidates, p, &n);
    double least = HUGE_VAL;
    for (int32_t i = 0; i < n; i++) {
        const double h = length_at(&near->item[list[i]], p);
        winner = h < least ? list[i] : winner;
        least = tri_lesser(least, h);
    }
    *away = away_from(&near->item[winner], p);
    return winner;
}

uint64_t tri_near_hash(const struct tri_near *near, uint64_t hash)
{
    return tri_hash(hash, near->item, (size_t)near->n * sizeof *near->item);
}

void tri_near_clear(struct tri_near *near)
{
    free(near->item);
    tri_candidates_clear(&near->candidates);
    *near = (struct tri_near){0};
}
