/* A smaller case that fails in the same way. */
#ifndef TESTS_TORTURE_MINIMISE_H
#define TESTS_TORTURE_MINIMISE_H

#include "tests/torture/case.h"

typedef bool case_fails(void *user, const struct torture_case *c);

/* Removes segments, holes, regions, points, switches and digits while the case still fails, for at most the given
 * number of trials. Changes *c. */
void minimise(struct torture_case *c, case_fails *fails, void *user, int32_t trials);

#endif
