/* A smaller case that fails in the same way. */
#ifndef TESTS_TORTURE_MINIMISE_H
#define TESTS_TORTURE_MINIMISE_H

#include "tests/torture/case.h"

typedef bool case_fails(void *user, const struct torture_case *c);

/* Takes away segments, holes, regions, points, switches and digits, as long as the case fails and no more than so many
 * trials have been made. Changes *c. */
void minimise(struct torture_case *c, case_fails *fails, void *user, int32_t trials);

#endif
