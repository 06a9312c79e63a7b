/* A naive check of the order that the headers guarantee for a mesh numbered by tiles. */
#ifndef TESTS_TILE_ORDER_H
#define TESTS_TILE_ORDER_H

#include "sched/schedule/partition.h"

/* Fails the test if any item is out of order. The first n_kept vertices may be anywhere. */
void assert_in_order(const struct tri_mesh *mesh, const struct par_partition *partition, int32_t n_kept);

#endif
