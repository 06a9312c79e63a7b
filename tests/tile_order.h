/* What the headers promise of the order of a mesh that has been numbered by tiles, asked naively. */
#ifndef TESTS_TILE_ORDER_H
#define TESTS_TILE_ORDER_H

#include "sched/schedule/partition.h"

/* Fails the test where anything is out of order. The first n_kept vertices may lie anywhere. */
void assert_in_order(const struct tri_mesh *mesh, const struct par_partition *partition, int32_t n_kept);

#endif
