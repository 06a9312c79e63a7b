/* What exactness asks of the compiler: each operation on doubles is rounded to a double, once, as it is written.
 *
 * FLT_EVAL_METHOD 0 and 1 are that (1 carries out operations on float as double, which changes none on double); 2, the
 * registers of the x87, keeps more bits than a double has. Options of the family of -ffast-math reorder sums, divide by
 * multiplying, and take infinities for impossible. Contraction cannot be seen from here: -ffp-contract=off. */
#ifndef TRIANGLE_BASE_ARITHMETIC_H
#define TRIANGLE_BASE_ARITHMETIC_H

#include <float.h>

#if defined __FAST_MATH__ || defined __ASSOCIATIVE_MATH__ || defined __RECIPROCAL_MATH__ || \
    (defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__)
#error "exact arithmetic cannot be had with -ffast-math or a part of it: compile with -fno-fast-math"
#endif

#ifdef __clang__
#pragma STDC FP_CONTRACT OFF /* gcc does not know the pragma; -std=c11 switches contraction off there */
#endif

_Static_assert(FLT_EVAL_METHOD == 0 || FLT_EVAL_METHOD == 1,
               "doubles must be rounded to double after each operation: on i386 compile with -msse2 -mfpmath=sse");
_Static_assert(FLT_RADIX == 2 && DBL_MANT_DIG == 53 && DBL_MIN_EXP == -1021, "double must be the 64-bit IEEE type");

#endif
