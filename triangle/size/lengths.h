/* Wanted edge lengths as a function of position: the minimum of several sources, limited in their gradients, and
 * constant once made. Any thread may call it; the same position has the same length on every machine. */
#ifndef TRIANGLE_SIZE_LENGTHS_H
#define TRIANGLE_SIZE_LENGTHS_H

#include "triangle/base/executor.h"
#include "triangle/base/status.h"
#include "triangle/mesh/mesh.h"

struct tri_lengths;

/* The request, with the members of tri_settings of the same names. Borrowed. */
struct tri_sizes {
    const struct tri_size_field *fields; /* [n] */
    int64_t n;                           /* number of fields */
    double gradation;          /* largest slope of h; 0: 0.2; infinite: no limit */
    double min_size, max_size; /* bounds on h; 0: none */
    double elements_across;    /* number of edges between facing walls; 0: no requirement */
    double per_circle;         /* number of edges around a full circle with the curvature of the segments; 0: no
                                  requirement */
    bool region_areas;         /* true: area bounds of mesh->regions[] also limit lengths outside their region */
};

/* Validates the request. Returns TRI_BAD_INPUT or TRI_TOO_LARGE with a message that names the field. */
enum tri_status tri_sizes_check(const struct tri_sizes *sizes, struct tri_error *error);

/* Does the request contain a source of lengths, not only limits? */
static inline bool tri_sizes_any(const struct tri_sizes *s)
{
    return s->n > 0 || s->max_size > 0 || s->elements_across > 0 || s->per_circle > 0;
}

/* Makes the lengths. The caller owns *lengths and frees it with tri_lengths_free; it is NULL if nothing is
 * requested. The mesh must contain the subsegments that fields of kind NEAR refer to; it is not used afterwards.
 * Returns TRI_OK, TRI_BAD_INPUT, TRI_TOO_LARGE, TRI_NO_MEMORY or TRI_STOPPED. */
enum tri_status tri_lengths_new(struct tri_lengths **lengths, const struct tri_sizes *sizes,
                                const struct tri_mesh *mesh, const struct tri_executor *executor,
                                struct tri_error *error);

/* Accepts NULL. */
void tri_lengths_free(struct tri_lengths *lengths);

/* Returns the length at p, which is above 0, or infinity if there is no limit. p and the result are in units of the
 * mesh. */
double tri_lengths_at(const struct tri_lengths *lengths, struct tri_point p);

/* Returns the length if it is the same everywhere; otherwise 0. */
double tri_lengths_uniform(const struct tri_lengths *lengths);

/* Returns a warning for the user, for example that a field does not cover the mesh; "" if there is none. */
const char *tri_lengths_note(const struct tri_lengths *lengths);

/* Returns a hash for checkpoints, which detects different lengths. O(size of the stored data). */
uint64_t tri_lengths_hash(const struct tri_lengths *lengths);

#endif
