/* What callers of the public headers give, as the mesher takes it. */
#ifndef TRIANGLE_API_FIGURE_H
#define TRIANGLE_API_FIGURE_H

#include "ptriangle/tri.h"
#include "triangle/mesh/pslg.h"

enum { TRI_API_MOST_COPIES = 12 };

/* A figure with 32-bit counts. Arrays without gaps are the caller's own, and only read; others are copies. */
struct tri_api_figure {
    struct tri_pslg pslg;
    struct tri_elements elements; /* n is 0: the figure is no mesh */
    void *copies[TRI_API_MOST_COPIES];
    int n_copies;
};

/* Checks the shapes of all arrays. TRI_BAD_INPUT, TRI_TOO_LARGE, TRI_NO_MEMORY. To be freed in any case. O(copies). */
enum tri_status tri_api_figure_take(struct tri_api_figure *taken, const struct tri_figure *figure,
                                    struct tri_error *error);
void tri_api_figure_free(struct tri_api_figure *taken);

/* A struct that begins with its size, as this library knows it: own[own_size] receives what there is of it, else 0.
 * TRI_BAD_INPUT: the size is not set, or what a newer header has is not 0. NULL is all 0. */
enum tri_status tri_api_struct_take(void *own, size_t own_size, const void *given, const char *name,
                                    struct tri_error *error);

/* The same on the way out: as much as the caller's header has, which is `given->size`. */
enum tri_status tri_api_struct_give(void *given, const void *own, size_t own_size, const char *name,
                                    struct tri_error *error);

#endif
