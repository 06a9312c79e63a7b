/* Replaces readers of other programs' meshes, which would make the module larger. */
#include "triangle/text/formats.h"

#define NO_READER(name)                                                                                      \
    enum tri_status name(const char *path, struct tri_pslg *mesh, struct tri_elements *elements,             \
                         const struct tri_executor *executor, struct tri_error *error)                       \
    {                                                                                                        \
        return (void)mesh, (void)elements, (void)executor,                                                   \
               tri_fail(error, TRI_CANNOT_READ, path, 0, "only .poly, .node and .ele files can be read here"); \
    }
NO_READER(tri_read_vtu)
NO_READER(tri_read_msh)
NO_READER(tri_read_2dm)
NO_READER(tri_read_14)
