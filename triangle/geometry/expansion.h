/* Exact arithmetic with unevaluated sums of doubles.
 *
 * A pair is the exact result of one sum or product: head is the rounded result, tail the rounding error. An expansion
 * is an array of n nonzero components in order of increasing magnitude whose bits do not overlap; its value is their
 * exact sum, and 0 is n == 0. INVARIANT: the last component is larger than the sum of all others. So it has the sign of
 * the value, and approximates it.
 *
 * No fma is used: products are split as by Dekker, so results are the same on every machine. Requirements: IEEE double
 * arithmetic (triangle/base/arithmetic.h) without flushing of subnormals, rounding to nearest even, and operands for
 * which no bit is lost to overflow or underflow (predicates.h shows why).
 *
 * Source: J. R. Shewchuk, Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates, Discrete &
 * Computational Geometry 18 (1997), section 2; theorem numbers below refer to that paper. */
#ifndef TRIANGLE_GEOMETRY_EXPANSION_H
#define TRIANGLE_GEOMETRY_EXPANSION_H

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "triangle/base/arithmetic.h"

enum { TRI_EXPANSION_FACTOR = 16 }; /* maximum length of the factors of tri_expansion_product */

struct tri_pair {
    double head, tail;
};

/* Returns a + b; requires |a| >= |b|, or that both are 0 (theorem 6). */
static inline struct tri_pair tri_fast_two_sum(double a, double b)
{
    double head = a + b;
    return (struct tri_pair){head, b - (head - a)};
}

/* Returns a + b (theorem 7). */
static inline struct tri_pair tri_two_sum(double a, double b)
{
    double head = a + b, b_part = head - a, a_part = head - b_part;
    return (struct tri_pair){head, (a - a_part) + (b - b_part)};
}

static inline struct tri_pair tri_two_difference(double a, double b)
{
    return tri_two_sum(a, -b);
}

/* Splits a into a sum of two numbers of at most 26 bits each, so that products of such halves are exact (theorem
 * 17). */
static inline struct tri_pair tri_split(double a)
{
    double c = 0x8000001p0 * a, head = c - (c - a);
    return (struct tri_pair){head, a - head};
}

/* Returns a * b (theorem 18). */
static inline struct tri_pair tri_two_product(double a, double b)
{
    double head = a * b;
    struct tri_pair p = tri_split(a), q = tri_split(b);
    double rest = ((head - p.head * q.head) - p.tail * q.head) - p.head * q.tail;
    return (struct tri_pair){head, p.tail * q.tail - rest};
}

/* Necessary for the invariant, and cheap enough for an assertion. */
static inline bool tri_expansion_is_increasing(int n, const double *e)
{
    for (int i = 0; i < n; i++) {
        if (e[i] == 0 || (i > 0 && fabs(e[i]) <= fabs(e[i - 1]))) {
            return false;
        }
    }
    return true;
}

/* Returns the rounded value, with the exact sign. */
static inline double tri_expansion_value(int n, const double *e)
{
    return n > 0 ? e[n - 1] : 0;
}

/* Converts p to an expansion of at most two components. */
static inline int tri_expansion_of_pair(struct tri_pair p, double e[2])
{
    int n = 0;
    if (p.tail != 0) {
        e[n++] = p.tail;
    }
    if (p.head != 0) {
        e[n++] = p.head;
    }
    return n;
}

/* Computes h[m + n] = e[m] + f[n] and returns the length of h (theorem 13: e, f and h are strongly nonoverlapping, as
 * every nonadjacent expansion is). h must not overlap e or f in memory. O(m + n). */
static inline int tri_expansion_sum(int m, const double *e, int n, const double *f, double *h)
{
    int i = 0, j = 0, k = 0;
    double sum = 0;
    while (i < m || j < n) {
        bool take_e = j == n || (i < m && fabs(e[i]) < fabs(f[j]));
        struct tri_pair s = tri_two_sum(sum, take_e ? e[i++] : f[j++]);
        if (s.tail != 0) {
            h[k++] = s.tail;
        }
        sum = s.head;
    }
    if (sum != 0) {
        h[k++] = sum;
    }
    assert(tri_expansion_is_increasing(k, h));
    return k;
}

/* Computes h[2 * m] = b * e[m] and returns the length of h (theorem 19: h is nonadjacent if e is). b != 0. O(m). */
static inline int tri_expansion_scale(int m, const double *e, double b, double *h)
{
    int k = 0;
    double sum = 0;
    assert(b != 0);
    for (int i = 0; i < m; i++) {
        struct tri_pair p = tri_two_product(e[i], b);
        struct tri_pair low = tri_two_sum(sum, p.tail), high = tri_fast_two_sum(p.head, low.head);
        if (low.tail != 0) {
            h[k++] = low.tail;
        }
        if (high.tail != 0) {
            h[k++] = high.tail;
        }
        sum = high.head;
    }
    if (sum != 0) {
        h[k++] = sum;
    }
    assert(tri_expansion_is_increasing(k, h));
    return k;
}

/* Computes h[m] = e[m] with as few components as possible, nonadjacent, and returns the length of h (theorem 23). 0 <=
 * m <= TRI_EXPANSION_FACTOR; h may be e. O(m). */
static inline int tri_expansion_compress(int m, const double *e, double *h)
{
    double packed[TRI_EXPANSION_FACTOR], rest = tri_expansion_value(m, e);
    int bottom = m, k = 0;
    assert(m <= TRI_EXPANSION_FACTOR);
    for (int i = m - 2; i >= 0; i--) {
        struct tri_pair s = tri_fast_two_sum(rest, e[i]);
        if (s.tail != 0) {
            packed[--bottom] = s.head;
        }
        rest = s.tail != 0 ? s.tail : s.head;
    }
    for (int i = bottom; i < m; i++) {
        struct tri_pair s = tri_fast_two_sum(packed[i], rest);
        if (s.tail != 0) {
            h[k++] = s.tail;
        }
        rest = s.head;
    }
    if (rest != 0) {
        h[k++] = rest;
    }
    assert(tri_expansion_is_increasing(k, h));
    return k;
}

/* Computes h[2 * m * n] = e[m] * f[n] and returns the length of h, which is strongly nonoverlapping. e must be
 * nonadjacent: from a pair, or compressed. m, n <= TRI_EXPANSION_FACTOR. h must not overlap e or f in memory. O(m * n *
 * n). */
static inline int tri_expansion_product(int m, const double *e, int n, const double *f, double *h)
{
    double scaled[2 * TRI_EXPANSION_FACTOR], sum[2 * TRI_EXPANSION_FACTOR * TRI_EXPANSION_FACTOR];
    int k = 0;
    assert(m <= TRI_EXPANSION_FACTOR && n <= TRI_EXPANSION_FACTOR);
    for (int j = 0; j < n; j++) {
        int length = tri_expansion_scale(m, e, f[j], scaled);
        k = tri_expansion_sum(k, h, length, scaled, sum);
        memcpy(h, sum, (size_t)k * sizeof *h);
    }
    return k;
}

#endif
