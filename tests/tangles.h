/* Small inputs with thousands of features that meet within rounding error, so that coordinates hardly separate them. A
 * family is a way to make such inputs. Each seed gives another input, with random markers on some segments. */
#ifndef TESTS_TANGLES_H
#define TESTS_TANGLES_H

#include "support.h"

/* Number of families. Inputs of the last one have hundreds of segments that cross the first segment. */
int tangles_families(void);
const char *tangles_name(int family);

/* Uses only + - * / and square roots, so that the input is the same on every machine. May contain equal points. */
struct tri_pslg tangles_make(int family, uint64_t seed);

#endif
