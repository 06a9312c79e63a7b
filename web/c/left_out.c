/* Replaces what the page and the package cannot reach, and readers of other programs' meshes: they would make the
 * module a tenth larger. What is missing fails with an error that says so. */
#include "triangle/cdt/reconstruct.h"
#include "triangle/size/sources.h"
#include "triangle/text/formats.h"

#define NO_READER(name)                                                                                      \
    enum tri_status name(const char *path, struct tri_pslg *mesh, struct tri_elements *elements,             \
                         const struct tri_executor *executor, struct tri_error *error)                       \
    {                                                                                                        \
        return (void)mesh, (void)elements, (void)executor,                                                   \
               tri_fail(error, TRI_CANNOT_READ, path, 0, "only .poly and .node files can be read here");     \
    }
NO_READER(tri_read_vtu)
NO_READER(tri_read_msh)
NO_READER(tri_read_2dm)
NO_READER(tri_read_14)

/* Sizes are numbers, everywhere or near segments. */
#define NO_SIZES(type)                                                                                            \
    enum tri_status type##_make(struct type *source, const struct tri_size_field *field,                          \
                                const struct tri_size_frame *frame, struct tri_error *error)                      \
    {                                                                                                             \
        return (void)source, (void)field, (void)frame,                                                            \
               tri_fail(error, TRI_BAD_INPUT, NULL, 0, "sizes of this kind are left out here");                   \
    }                                                                                                             \
    double type##_at(const struct type *source, struct tri_point p) { return (void)source, (void)p, HUGE_VAL; }   \
    uint64_t type##_hash(const struct type *source, uint64_t hash) { return (void)source, hash; }                 \
    void type##_clear(struct type *source) { (void)source; }
NO_SIZES(tri_raster)
NO_SIZES(tri_sampled)
NO_SIZES(tri_background)

enum tri_status tri_reconstruct(struct tri_mesh *mesh, const struct tri_pslg *pslg, const struct tri_elements *elements,
                                const struct tri_reconstruct_options *options, struct tri_error *error)
{
    return (void)mesh, (void)pslg, (void)elements, (void)options,
           tri_fail(error, TRI_BAD_INPUT, NULL, 0, "a mesh cannot be refined here");
}

/* Takes the place of tri_write_msh_parts in the table of formats. */
tri_write_parts_call tri_no_parts;
enum tri_status tri_no_parts(struct tri_output *const *outputs, int n, const struct tri_grid *grid,
                             const struct tri_executor *executor, struct tri_error *error)
{
    return (void)outputs, (void)n, (void)grid, (void)executor,
           tri_fail(error, TRI_BAD_INPUT, NULL, 0, "parts are left out here");
}
