/* Groups and attributes. */
#include "triangle/hdf5/items.h"

#include <string.h>

bool tri_h5_add_group(struct tri_h5_file *file, const char *path)
{
    hid_t creation = tri_h5_no_times(H5P_GROUP_CREATE);
    if (creation < 0)
        return false;
    hid_t group = H5Gcreate2(file->id, path, H5P_DEFAULT, creation, H5P_DEFAULT);
    H5Pclose(creation);
    return group >= 0 && H5Gclose(group) >= 0;
}

/* type: in the file; memory: of the data. */
static bool add(struct tri_h5_file *file, const char *path, const char *name, hid_t type, hid_t memory, int n,
                const void *data)
{
    const hsize_t size = (hsize_t)n;
    hid_t space = n > 0 ? H5Screate_simple(1, &size, NULL) : H5Screate(H5S_SCALAR), attribute = -1;
    if (space < 0)
        return false;
    attribute = H5Acreate_by_name(file->id, path, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    bool done = attribute >= 0 && H5Awrite(attribute, memory, data) >= 0;
    H5Sclose(space);
    return attribute >= 0 && H5Aclose(attribute) >= 0 && done;
}

bool tri_h5_add_integers(struct tri_h5_file *file, const char *path, const char *name, int n, const int64_t *values)
{
    return add(file, path, name, H5T_STD_I64LE, H5T_NATIVE_INT64, n, values);
}

bool tri_h5_add_reals(struct tri_h5_file *file, const char *path, const char *name, int n, const double *values)
{
    return add(file, path, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, n, values);
}

bool tri_h5_add_text(struct tri_h5_file *file, const char *path, const char *name, const char *text)
{
    hid_t type = H5Tcopy(H5T_C_S1);
    bool done = type >= 0 && H5Tset_size(type, strlen(text) + 1) >= 0 && add(file, path, name, type, type, 0, text);
    return type >= 0 && H5Tclose(type) >= 0 && done;
}
