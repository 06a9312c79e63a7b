/* Half-edges that wait for their other side. Private to the judge. */
#ifndef TRIANGLE_CHECK_STORE_H
#define TRIANGLE_CHECK_STORE_H

#include "triangle/check/internal.h"

/* As many as the bound allows are in memory, the rest in nameless files, by a hash of their edge. */
enum tri_status tri_check_store_new(struct checker *c);
void tri_check_store_free(struct check_store *store);

/* TRI_NO_MEMORY, TRI_CANNOT_WRITE. */
enum tri_status tri_check_store_add(struct checker *c, struct check_open e);

/* Calls take for all of each file, or all there are; what it is given it may sort. The store is empty then. */
enum tri_status tri_check_store_drain(struct checker *c, enum tri_status (*take)(struct checker *c,
                                                                                 struct check_open *at, int64_t n));

/* At the end of the array. */
enum tri_status tri_check_append(struct check_opens *opens, const struct check_open *e);

#endif
