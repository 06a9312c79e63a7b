/* How long edges shall be, place by place: the least of several sources, limited in their gradients, and frozen. Any
 * thread may ask; the same place has the same length on every machine. */
#ifndef TRIANGLE_SIZE_LENGTHS_H
#define TRIANGLE_SIZE_LENGTHS_H

#include "triangle/base/executor.h"
#include "triangle/base/status.h"
#include "triangle/mesh/mesh.h"

struct tri_lengths;

/* What is asked for, as the members of tri_settings with these names. Borrowed. */
struct tri_sizes {
    const struct tri_size_field *fields; /* [n] */
    int64_t n;
    double gradation;          /* 0: 0.2; infinite: no limit */
    double min_size, max_size; /* 0: none */
    double elements_across;    /* so many lengths between walls that face each other; 0: any */
    double per_circle;         /* so many lengths around a circle of the curvature of segments; 0: any */
    bool region_areas;         /* bounds of mesh->regions[] count outside these too, as lengths */
};

/* Can these be asked for at all? TRI_BAD_INPUT, TRI_TOO_LARGE: what is wrong with which field. */
enum tri_status tri_sizes_check(const struct tri_sizes *sizes, struct tri_error *error);

/* Is there anything that asks for lengths, rather than limits them? */
static inline bool tri_sizes_any(const struct tri_sizes *s)
{
    return s->n > 0 || s->max_size > 0 || s->elements_across > 0 || s->per_circle > 0;
}

/* *lengths is the caller's, until tri_lengths_free; NULL where nothing is asked for. The mesh has the subsegments that
 * NEAR means; it is not looked at afterwards. TRI_BAD_INPUT, TRI_NO_MEMORY, TRI_STOPPED. */
enum tri_status tri_lengths_new(struct tri_lengths **lengths, const struct tri_sizes *sizes,
                                const struct tri_mesh *mesh, const struct tri_executor *executor,
                                struct tri_error *error);

/* NULL is fine. */
void tri_lengths_free(struct tri_lengths *lengths);

/* The length at a place, both in the units of the mesh; above 0, infinity where nothing is asked for. */
double tri_lengths_at(const struct tri_lengths *lengths, struct tri_point p);

/* If the same length is asked for everywhere: that; else 0. */
double tri_lengths_uniform(const struct tri_lengths *lengths);

/* What a user should know: a field that ends before the mesh does. "": nothing. */
const char *tri_lengths_note(const struct tri_lengths *lengths);

/* For checkpoints: another field has another number, as good as surely. O(what is kept). */
uint64_t tri_lengths_hash(const struct tri_lengths *lengths);

#endif
