/* The slow path of the predicates, for cases in which rounding could matter; the cheapest tests come first.
 *
 * In-circle: 1. Do two of the points mirror the other two (as in every rectangle of a grid)? Then they are cocircular.
 * 2. Are the differences of coordinates small integers, up to a power of two? Then most products are exact in doubles.
 * 3. Is doubled precision sufficient, by its error bound? 4. Expansions, which are exact. Orientation: 1. Are the
 * differences exact? Then two exact products are compared. 2. and 3. as 3. and 4. above.
 *
 * A vector is the exact difference of two points: each coordinate is a pair. INVARIANT: |tail| <= u |head|, u =
 * 2^-53. */
#include "triangle/geometry/predicates.h"

#include "triangle/geometry/expansion.h"

/* Error bounds of doubled precision, see doubled_minor and doubled_term; the slack covers terms in u^3. */
#define DOUBLED_MINOR_BOUND    0x1p-102 /* 15 u^2 rounded up to 16 u^2 */
#define DOUBLED_INCIRCLE_BOUND 0x1p-99  /* 100 u^2 rounded up to 128 u^2 */

struct vector {
    struct tri_pair x, y;
};

static struct vector difference(struct tri_point a, struct tri_point b)
{
    return (struct vector){tri_two_difference(a.x, b.x), tri_two_difference(a.y, b.y)};
}

static bool is_double(const struct vector *v)
{
    return v->x.tail == 0 && v->y.tail == 0;
}

/* Returns p.x q.y - p.y q.x with an error of at most 15 u^2 *size, where *size is |p.x q.y| + |p.y q.x| (rounded). The
 * tail is at most 4u *size. A product has a relative error of 8 u^2: 1 for the omitted product of tails, 1 each for the
 * two products of head and tail, 2 for their sum, 3 for the sum with the product's own tail. The last two sums have
 * errors of 3 and 4 u^2 *size. */
static struct tri_pair doubled_minor(const struct vector *p, const struct vector *q, double *size)
{
    struct tri_pair left = tri_two_product(p->x.head, q->y.head), right = tri_two_product(p->y.head, q->x.head);
    double left_tail = left.tail + (p->x.head * q->y.tail + p->x.tail * q->y.head);
    double right_tail = right.tail + (p->y.head * q->x.tail + p->y.tail * q->x.head);
    struct tri_pair minor = tri_two_difference(left.head, right.head);
    minor.tail += left_tail - right_tail;
    *size = fabs(left.head) + fabs(right.head);
    return minor;
}

/* Returns p.x^2 + p.y^2 with a relative error of at most 13 u^2: 6 for a square (1 omitted, 2 for the product, 3 for
 * its sum), 3 and 4 for the last two sums. The tail is at most 4u of the head. */
static struct tri_pair doubled_lift(const struct vector *p)
{
    struct tri_pair x = tri_two_product(p->x.head, p->x.head), y = tri_two_product(p->y.head, p->y.head);
    struct tri_pair lift = tri_two_sum(x.head, y.head);
    lift.tail += (x.tail + 2 * p->x.head * p->x.tail) + (y.tail + 2 * p->y.head * p->y.tail);
    return lift;
}

/* Returns |p|^2 (q x r) with an error of at most 69 u^2 of its size: 13 and 15 from the factors, 16 for the omitted
 * product of tails, 4 and 4 for the products of head and tail, 8 and 9 for their sums. The tail is at most 9u of the
 * size, which is added to *size. */
static struct tri_pair doubled_term(const struct vector *p, const struct vector *q, const struct vector *r,
                                    double *size)
{
    double minor_size;
    struct tri_pair minor = doubled_minor(q, r, &minor_size), lift = doubled_lift(p);
    struct tri_pair term = tri_two_product(lift.head, minor.head);
    term.tail += lift.head * minor.tail + lift.tail * minor.head;
    *size += lift.head * minor_size;
    return term;
}

/* Returns the determinant if its sign is certain, otherwise 0. Error: 69 u^2 of the terms, 9 + 9 + 2 + 11 for the sums
 * of tails. */
static double doubled_incircle(const struct vector *a, const struct vector *b, const struct vector *c)
{
    double size = 0;
    struct tri_pair s = doubled_term(a, b, c, &size), t = doubled_term(b, c, a, &size);
    struct tri_pair r = doubled_term(c, a, b, &size);
    struct tri_pair two = tri_two_sum(s.head, t.head), three = tri_two_sum(two.head, r.head);
    double det = three.head + ((two.tail + three.tail) + ((s.tail + t.tail) + r.tail));
    return fabs(det) > DOUBLED_INCIRCLE_BOUND * size ? det : 0;
}

static int exact_product(struct tri_pair p, struct tri_pair q, double h[8])
{
    double e[2], f[2];
    int m = tri_expansion_of_pair(p, e), n = tri_expansion_of_pair(q, f);
    return tri_expansion_product(m, e, n, f, h);
}

static int exact_minor(const struct vector *p, const struct vector *q, double h[16])
{
    double left[8], right[8], sum[16];
    struct tri_pair minus_py = {-p->y.head, -p->y.tail};
    int m = exact_product(p->x, q->y, left), n = exact_product(minus_py, q->x, right);
    return tri_expansion_compress(tri_expansion_sum(m, left, n, right, sum), sum, h);
}

static int exact_lift(const struct vector *p, double h[16])
{
    double x[8], y[8], sum[16];
    int m = exact_product(p->x, p->x, x), n = exact_product(p->y, p->y, y);
    return tri_expansion_compress(tri_expansion_sum(m, x, n, y, sum), sum, h);
}

static int exact_term(const struct vector *p, const struct vector *q, const struct vector *r, double h[512])
{
    double lift[16], minor[16];
    int m = exact_lift(p, lift), n = exact_minor(q, r, minor);
    return tri_expansion_product(m, lift, n, minor, h);
}

static double exact_incircle(const struct vector *a, const struct vector *b, const struct vector *c)
{
    double s[512], t[512], two[1024], three[1536];
    int m = exact_term(a, b, c, s), n = exact_term(b, c, a, t);
    int k = tri_expansion_sum(m, s, n, t, two);
    m = exact_term(c, a, b, s);
    k = tri_expansion_sum(k, two, m, s, three);
    return tri_expansion_value(k, three);
}

/* Returns p.x q.y - p.y q.x for vectors whose coordinates are doubles. Rounding is monotonic, so the products compare
 * like their heads or, if these are equal, like their tails. */
static double exact_minor_of_doubles(const struct vector *p, const struct vector *q)
{
    struct tri_pair left = tri_two_product(p->x.head, q->y.head), right = tri_two_product(p->y.head, q->x.head);
    return left.head != right.head ? left.head - right.head : left.tail - right.tail;
}

static double sign_of_minor(const struct vector *p, const struct vector *q)
{
    if (is_double(p) && is_double(q)) {
        return exact_minor_of_doubles(p, q);
    }
    double size, h[16];
    struct tri_pair minor = doubled_minor(p, q, &size);
    double det = minor.head + minor.tail;
    if (fabs(det) > DOUBLED_MINOR_BOUND * size) {
        return det;
    }
    return tri_expansion_value(exact_minor(p, q, h), h);
}

double tri_orient2d_near(struct tri_point a, struct tri_point b, struct tri_point c)
{
    assert(tri_is_exact_point(a) && tri_is_exact_point(b) && tri_is_exact_point(c));
    struct vector p = difference(a, c), q = difference(b, c);
    return sign_of_minor(&p, &q);
}

double tri_turn_near(struct tri_point a, struct tri_point b, struct tri_point c, struct tri_point d)
{
    struct vector p = difference(b, a), q = difference(d, c);
    return sign_of_minor(&p, &q);
}

/* p . q is the minor of p and q rotated left. */
double tri_dot_near(struct tri_point a, struct tri_point b, struct tri_point c)
{
    assert(tri_is_exact_point(a) && tri_is_exact_point(b) && tri_is_exact_point(c));
    struct vector p = difference(a, c), q = difference(b, c);
    struct vector turned = {{-q.y.head, -q.y.tail}, q.x};
    return sign_of_minor(&p, &turned);
}

/* Uses doubled precision if its error, 2^-102 of size, is below 2^-80 of the result. */
struct tri_pair tri_orient2d_pair(struct tri_point a, struct tri_point b, struct tri_point c)
{
    struct vector p = difference(a, c), q = difference(b, c);
    double size, h[16];
    struct tri_pair minor = doubled_minor(&p, &q, &size);
    if (fabs(minor.head) > 0x1p-22 * size) {
        return tri_fast_two_sum(minor.head, minor.tail);
    }
    int n = exact_minor(&p, &q, h);
    return (struct tri_pair){n > 0 ? h[n - 1] : 0, n > 1 ? h[n - 2] : 0};
}

static bool same_sum(double a, double b, double c, double d)
{
    struct tri_pair s = tri_two_sum(a, b), t = tri_two_sum(c, d);
    return s.head == t.head && s.tail == t.tail;
}

/* Does a reflection across an axis-parallel line exchange a with b, and c with d? */
static bool mirror_pairs(struct tri_point a, struct tri_point b, struct tri_point c, struct tri_point d)
{
    return (a.y == b.y && c.y == d.y && same_sum(a.x, b.x, c.x, d.x)) ||
           (a.x == b.x && c.x == d.x && same_sum(a.y, b.y, c.y, d.y));
}

/* Do all coordinates of the three vectors fit into 25 bits, in units of a common power of two? Adding 2^28 times the
 * largest coordinate, m, rounds to multiples of a unit h with m <= 2^25 h, for both binades that the sum may fall
 * into. */
static bool fit_25_bits(const struct vector *a, const struct vector *b, const struct vector *c)
{
    double m = fmax(fmax(fmax(fabs(a->x.head), fabs(a->y.head)), fmax(fabs(b->x.head), fabs(b->y.head))),
                    fmax(fabs(c->x.head), fabs(c->y.head)));
    double big = 0x1p28 * m;
    return (a->x.head + big) - big == a->x.head && (a->y.head + big) - big == a->y.head &&
           (b->x.head + big) - big == b->x.head && (b->y.head + big) - big == b->y.head &&
           (c->x.head + big) - big == c->x.head && (c->y.head + big) - big == c->y.head;
}

static struct tri_pair small_term(const struct vector *p, const struct vector *q, const struct vector *r)
{
    double lift = p->x.head * p->x.head + p->y.head * p->y.head;
    double minor = q->x.head * r->y.head - q->y.head * r->x.head;
    return tri_two_product(lift, minor);
}

/* For vectors that fit_25_bits. In these units lifts and minors are integers of at most 2^51, hence exact; heads are
 * below 2^104, and the five tails are integers of at most 2^48 (of a product) or 2^50 (of a sum), so their sum is
 * exact. */
static double small_incircle(const struct vector *a, const struct vector *b, const struct vector *c)
{
    struct tri_pair s = small_term(a, b, c), t = small_term(b, c, a), r = small_term(c, a, b);
    struct tri_pair two = tri_two_sum(s.head, t.head), three = tri_two_sum(two.head, r.head);
    return three.head + ((two.tail + three.tail) + ((s.tail + t.tail) + r.tail));
}

double tri_incircle_near(struct tri_point a, struct tri_point b, struct tri_point c, struct tri_point d)
{
    assert(tri_is_exact_point(a) && tri_is_exact_point(b) && tri_is_exact_point(c) && tri_is_exact_point(d));
    if (mirror_pairs(a, b, c, d) || mirror_pairs(a, c, b, d) || mirror_pairs(a, d, b, c)) {
        return 0;
    }
    struct vector p = difference(a, d), q = difference(b, d), r = difference(c, d);
    if (is_double(&p) && is_double(&q) && is_double(&r) && fit_25_bits(&p, &q, &r)) {
        return small_incircle(&p, &q, &r);
    }
    double det = doubled_incircle(&p, &q, &r);
    return det != 0 ? det : exact_incircle(&p, &q, &r);
}

static bool is_larger(struct tri_point a, struct tri_point b)
{
    return a.x > b.x || (a.x == b.x && a.y > b.y);
}

/* Raising a point on the paraboloid changes the determinant by the orientation of the other three points, with the sign
 * of exchanging that point with d. No three of four distinct cocircular points are collinear, because a lifted line is
 * a parabola, whose plane is vertical. So the largest point alone decides, and the infinitesimals of the others do not
 * matter. */
static bool is_inside_by_ties(struct tri_point a, struct tri_point b, struct tri_point c, struct tri_point d)
{
    bool a_over_b = is_larger(a, b), c_over_d = is_larger(c, d);
    bool a_first = a_over_b && (c_over_d ? is_larger(a, c) : is_larger(a, d));
    bool b_first = !a_over_b && (c_over_d ? is_larger(b, c) : is_larger(b, d));
    if (a_first) {
        return tri_orient2d(d, b, c) > 0;
    }
    if (b_first) {
        return tri_orient2d(a, d, c) > 0;
    }
    return c_over_d ? tri_orient2d(a, b, d) > 0 : tri_orient2d(a, b, c) < 0;
}

bool tri_in_circle_near(struct tri_point a, struct tri_point b, struct tri_point c, struct tri_point d)
{
    double det = tri_incircle_near(a, b, c, d);
    return det != 0 ? det > 0 : is_inside_by_ties(a, b, c, d);
}
