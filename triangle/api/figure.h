/* Converts the structs of the public headers to those of the mesher. */
#ifndef TRIANGLE_API_FIGURE_H
#define TRIANGLE_API_FIGURE_H

#include "ptriangle/tri.h"
#include "triangle/mesh/pslg.h"

enum { TRI_API_MOST_COPIES = 12 };

/* A figure with 32-bit counts. Arrays without gaps are borrowed from the caller and only read; the others are
 * copies. */
struct tri_api_figure {
    struct tri_pslg pslg;         /* points, segments, holes and regions */
    struct tri_elements elements; /* n is 0 if the figure is no mesh */
    void *copies[TRI_API_MOST_COPIES]; /* [n_copies] arrays that are copies */
    int n_copies;                      /* number of copies */
};

/* Checks the shapes of all arrays and converts the figure. Returns TRI_OK, TRI_BAD_INPUT, TRI_TOO_LARGE or
 * TRI_NO_MEMORY. Free *taken in any case. O(size of the copies). */
enum tri_status tri_api_figure_take(struct tri_api_figure *taken, const struct tri_figure *figure,
                                    struct tri_error *error);
void tri_api_figure_free(struct tri_api_figure *taken);

/* Copies a struct that begins with its size into own[own_size]. Members that the caller's header does not have
 * become 0; NULL gives all zeros. Returns TRI_BAD_INPUT if the size is not set, or if a member unknown to this
 * library is not 0. */
enum tri_status tri_api_struct_take(void *own, size_t own_size, const void *given, const char *name,
                                    struct tri_error *error);

/* Copies a struct back to the caller: only the members that the caller's header has, according to `given->size`. */
enum tri_status tri_api_struct_give(void *given, const void *own, size_t own_size, const char *name,
                                    struct tri_error *error);

#endif
