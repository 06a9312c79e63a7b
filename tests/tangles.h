/* Small inputs in which much meets within rounding, by the thousand: what coordinates hardly tell apart. A family is a
 * way to make them; every seed gives another, with random markers on some segments. */
#ifndef TESTS_TANGLES_H
#define TESTS_TANGLES_H

#include "support.h"

/* The last family has hundreds of segments that cross the first one. */
int tangles_families(void);
const char *tangles_name(int family);

/* Square roots aside made by + - * / alone: the same on every machine. Equal points occur. */
struct tri_pslg tangles_make(int family, uint64_t seed);

#endif
