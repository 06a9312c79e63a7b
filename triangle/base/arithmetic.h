/* Compile-time checks that the compiler rounds each operation on doubles to a double, once, as the source states.
 *
 * FLT_EVAL_METHOD 0 and 1 do this. (Method 1 computes float operations in double, which changes no operation on
 * doubles.) Method 2, the registers of the x87, keeps more bits than a double has. The -ffast-math options reorder
 * sums, divide by multiplying, and assume that there are no infinities. Contraction cannot be detected here: compile
 * with -ffp-contract=off. */
#ifndef TRIANGLE_BASE_ARITHMETIC_H
#define TRIANGLE_BASE_ARITHMETIC_H

#include <float.h>

#if defined __FAST_MATH__ || defined __ASSOCIATIVE_MATH__ || defined __RECIPROCAL_MATH__ || \
    (defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__)
#error "exact arithmetic cannot be had with -ffast-math or a part of it: compile with -fno-fast-math"
#endif

#ifdef __clang__
#pragma STDC FP_CONTRACT OFF /* gcc ignores this pragma, but -std=c11 disables contraction there */
#endif

_Static_assert(FLT_EVAL_METHOD == 0 || FLT_EVAL_METHOD == 1,
               "doubles must be rounded to double after each operation: on i386 compile with -msse2 -mfpmath=sse");
_Static_assert(FLT_RADIX == 2 && DBL_MANT_DIG == 53 && DBL_MIN_EXP == -1021, "double must be the 64-bit IEEE type");

#endif
