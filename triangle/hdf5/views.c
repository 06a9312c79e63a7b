/* Virtual datasets and hard links. After a failed call of HDF5 all further calls do nothing; tri_h5_write_views reports
 * the error. */
#include "triangle/hdf5/views.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VTK_LINE = 3, VTK_TRIANGLE = 5 };

static const char LINE_TYPES[] = "/VTKHDF/LineTypes";

struct views {
    struct tri_h5_file *file;
    const struct tri_h5_array *arrays; /* by kind */
    bool failed;
    enum tri_status status; /* error that has been reported already */
    struct tri_error *error;
};

static hid_t checked(struct views *v, hid_t id)
{
    v->failed = v->failed || id < 0;
    return id;
}

/* --- groups, links, attributes, by paths */

static void add_group(struct views *v, const char *path)
{
    v->failed = v->failed || !tri_h5_add_group(v->file, path);
}

static void add_link(struct views *v, const struct tri_h5_array *array, const char *path)
{
    if (!v->failed && array->file)
        checked(v, H5Lcreate_hard(v->file->id, array->name, v->file->id, path, H5P_DEFAULT, H5P_DEFAULT));
}

static void add_integers(struct views *v, const char *path, const char *name, int n, const int64_t *values)
{
    v->failed = v->failed || !tri_h5_add_integers(v->file, path, name, n, values);
}

/* --- virtual datasets */

struct part { /* a whole dataset that is mapped to a box of the view */
    const char *source;
    int source_rank;
    hsize_t source_size[2], first[2], size[2];
};

/* Selects a box in an array of the given size; < 0: an error. */
static hid_t box_in(int rank, const hsize_t size[2], const hsize_t first[2], const hsize_t box[2])
{
    hid_t space = H5Screate_simple(rank, size, NULL);
    if (space >= 0 && H5Sselect_hyperslab(space, H5S_SELECT_SET, first, NULL, box, NULL) >= 0)
        return space;
    tri_h5_close_id(H5Sclose, space);
    return -1;
}

static void add_part(struct views *v, hid_t creation, int rank, const hsize_t size[2], const struct part *part)
{
    if (v->failed || part->source_size[0] == 0)
        return;
    hid_t box = checked(v, box_in(rank, size, part->first, part->size));
    hid_t source = checked(v, H5Screate_simple(part->source_rank, part->source_size, NULL));
    if (!v->failed)
        checked(v, H5Pset_virtual(creation, box, ".", part->source, source));
    tri_h5_close_id(H5Sclose, source);
    tri_h5_close_id(H5Sclose, box);
}

/* Adds a dataset that is composed of other datasets; the rest has the fill value. */
static void add_view(struct views *v, const char *path, hid_t type, int rank, const hsize_t size[2], int fill,
                     const struct part *parts, int n)
{
    if (v->failed)
        return;
    hid_t creation = checked(v, tri_h5_no_times(H5P_DATASET_CREATE));
    if (!v->failed)
        checked(v, H5Pset_fill_value(creation, H5T_NATIVE_INT, &fill));
    for (int i = 0; i < n; i++)
        add_part(v, creation, rank, size, &parts[i]);
    tri_h5_close_id(H5Dclose, checked(v, tri_h5_new_dataset(v->file, path, type, rank, size, NULL, creation)));
}

/* --- VTK */

/* Adds an array with one number. */
static void add_count(struct views *v, const char *path, int64_t count)
{
    if (v->failed)
        return;
    hid_t creation = tri_h5_no_times(H5P_DATASET_CREATE);
    hid_t dataset = tri_h5_new_dataset(v->file, path, H5T_STD_I64LE, 1, &(hsize_t){1}, NULL, creation);
    if (checked(v, dataset) >= 0)
        checked(v, H5Dwrite(dataset, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &count));
    tri_h5_close_id(H5Dclose, dataset);
}

static void add_vtk_cells(struct views *v)
{
    const hsize_t m = (hsize_t)v->arrays[TRI_H5_OF_TRIANGLES].n, s = (hsize_t)v->arrays[TRI_H5_OF_SEGMENTS].n;
    const hid_t type = tri_h5_type_id(v->arrays[TRI_H5_OF_TRIANGLES].plan->type);
    const struct part nodes[2] = {{"/" TRI_H5_TRIANGLES, 2, {m, 3}, {0, 0}, {3 * m, 0}},
                                  {"/" TRI_H5_SEGMENTS, 2, {s, 2}, {3 * m, 0}, {2 * s, 0}}};
    const struct part lines = {LINE_TYPES, 1, {s, 0}, {m, 0}, {s, 0}};
    add_view(v, "/VTKHDF/Connectivity", type, 1, (hsize_t[2]){3 * m + 2 * s, 0}, 0, nodes, 2);
    if (!v->failed)
        v->status = tri_h5_write_ends(v->file, "/VTKHDF/Offsets", (int64_t)m, (int64_t)s, v->error);
    v->failed = v->failed || v->status;
    add_view(v, LINE_TYPES, H5T_STD_U8LE, 1, (hsize_t[2]){s, 0}, VTK_LINE, NULL, 0);
    add_view(v, "/VTKHDF/Types", H5T_STD_U8LE, 1, (hsize_t[2]){m + s, 0}, VTK_TRIANGLE, &lines, 1);
    add_count(v, "/VTKHDF/NumberOfCells", (int64_t)(m + s));
    add_count(v, "/VTKHDF/NumberOfConnectivityIds", (int64_t)(3 * m + 2 * s));
}

static void add_vtk_data(struct views *v)
{
    const struct tri_h5_array *a = v->arrays, *of_cells = &a[TRI_H5_OF_TRIANGLE_ATTRIBUTES];
    const hsize_t m = (hsize_t)a[TRI_H5_OF_TRIANGLES].n, s = (hsize_t)a[TRI_H5_OF_SEGMENTS].n;
    const hsize_t k = of_cells->file ? (hsize_t)of_cells->plan->width : 0;
    const struct part markers = {"/" TRI_H5_SEGMENT_MARKERS, 1, {s, 0}, {m, 0}, {s, 0}};
    const struct part attributes = {"/" TRI_H5_TRIANGLE_ATTRIBUTES, 2, {m, k}, {0, 0}, {m, k}};
    add_group(v, "/VTKHDF/PointData");
    add_link(v, &a[TRI_H5_OF_POINT_MARKERS], "/VTKHDF/PointData/marker");
    add_link(v, &a[TRI_H5_OF_POINT_ATTRIBUTES], "/VTKHDF/PointData/attributes");
    add_group(v, "/VTKHDF/CellData");
    if (a[TRI_H5_OF_SEGMENT_MARKERS].file)
        add_view(v, "/VTKHDF/CellData/marker", H5T_STD_I32LE, 1, (hsize_t[2]){m + s, 0}, 0, &markers, 1);
    if (of_cells->file)
        add_view(v, "/VTKHDF/CellData/attributes", tri_h5_type_id(of_cells->plan->type), 2, (hsize_t[2]){m + s, k}, 0,
                 &attributes, 1);
}

static void add_vtk(struct views *v)
{
    const hsize_t n = (hsize_t)v->arrays[TRI_H5_OF_POINTS].n;
    const struct part places = {"/" TRI_H5_POINTS, 2, {n, 2}, {0, 0}, {n, 2}};
    add_group(v, "/VTKHDF");
    add_integers(v, "/VTKHDF", "Version", 2, (int64_t[2]){2, 0});
    v->failed = v->failed || !tri_h5_add_text(v->file, "/VTKHDF", "Type", "UnstructuredGrid");
    add_count(v, "/VTKHDF/NumberOfPoints", (int64_t)n);
    add_view(v, "/VTKHDF/Points", H5T_IEEE_F64LE, 2, (hsize_t[2]){n, 3}, 0, &places, 1);
    add_vtk_cells(v);
    add_vtk_data(v);
}

/* --- PETSc; older versions read the dimension and number of corners of cells */

static void add_petsc(struct views *v)
{
    add_group(v, "/geometry");
    add_link(v, &v->arrays[TRI_H5_OF_POINTS], "/geometry/vertices");
    add_group(v, "/viz");
    add_group(v, "/viz/topology");
    add_link(v, &v->arrays[TRI_H5_OF_TRIANGLES], "/viz/topology/cells");
    add_integers(v, "/viz/topology/cells", "cell_dim", 0, &(int64_t){2});
    add_integers(v, "/viz/topology/cells", "cell_corners", 0, &(int64_t){3});
}

enum tri_status tri_h5_write_views(struct tri_h5_file *file, const struct tri_h5_array arrays[TRI_H5_KINDS],
                                   struct tri_error *error)
{
    struct views v = {.file = file, .arrays = arrays, .error = error};
    add_vtk(&v);
    add_petsc(&v);
    if (v.status)
        return v.status;
    return v.failed ? tri_h5_fail(file, "the views for other programs", error) : TRI_OK;
}

/* --- XDMF: one grid, its topology, its geometry, and its attributes */

struct xdmf {
    struct tri_output *output;
    char *name; /* name of the HDF5 file, escaped for XML */
    enum tri_status status;
    struct tri_error *error;
};

static void put_words(struct xdmf *text, const char *words)
{
    text->status = text->status ? text->status : tri_output_write(text->output, words, strlen(words), text->error);
}

/* Replaces characters that are special in XML. From malloc; NULL: out of memory. */
static char *escaped(const char *name)
{
    enum { LONGEST = 6 };
    char *text = malloc(LONGEST * strlen(name) + 1), *at = text;
    for (; text && *name; name++) {
        const char *word = *name == '&' ? "&amp;" : *name == '<' ? "&lt;" : *name == '>' ? "&gt;" : NULL;
        if (word)
            at += sprintf(at, "%s", word);
        else
            *at++ = *name;
    }
    if (text)
        *at = 0;
    return text;
}

static void put_item(struct xdmf *text, const struct tri_h5_array *array)
{
    char words[200], width[20] = "";
    if (!array->is_list)
        snprintf(width, sizeof width, " %" PRId32, array->plan->width);
    snprintf(words, sizeof words, "<DataItem Dimensions=\"%" PRId64 "%s\" NumberType=\"%s\" Precision=\"%d\" "
             "Format=\"HDF\">", array->n, width, array->plan->type == TRI_H5_FLOAT64 ? "Float" : "Int",
             array->plan->type == TRI_H5_INT32 ? 4 : 8);
    put_words(text, words);
    put_words(text, text->name);
    put_words(text, ":/");
    put_words(text, array->name);
    put_words(text, "</DataItem>");
}

static void put_attribute(struct xdmf *text, const struct tri_h5_array *array, const char *name, const char *center)
{
    char words[200];
    if (!array->file)
        return;
    snprintf(words, sizeof words, "<Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"%s\">\n", name,
             array->plan->width == 1 ? "Scalar" : "Matrix", center);
    put_words(text, words);
    put_item(text, array);
    put_words(text, "\n</Attribute>\n");
}

static void put_grid(struct xdmf *text, const struct tri_h5_array *triangles, const struct tri_h5_array *points)
{
    char words[300];
    snprintf(words, sizeof words,
             "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n<Grid Name=\"mesh\" GridType=\"Uniform\">\n"
             "<Topology TopologyType=\"Triangle\" NumberOfElements=\"%" PRId64 "\" NodesPerElement=\"3\">\n",
             triangles->n);
    put_words(text, words);
    put_item(text, triangles);
    put_words(text, "\n</Topology>\n<Geometry GeometryType=\"XY\">\n");
    put_item(text, points);
    put_words(text, "\n</Geometry>\n");
}

enum tri_status tri_h5_write_xdmf(struct tri_output *output, const char *name,
                                  const struct tri_h5_array arrays[TRI_H5_KINDS], struct tri_error *error)
{
    struct xdmf text = {output, escaped(name), TRI_OK, error};
    if (!text.name)
        return tri_fail(error, TRI_NO_MEMORY, output->path, 0, "out of memory for file names");
    put_grid(&text, &arrays[TRI_H5_OF_TRIANGLES], &arrays[TRI_H5_OF_POINTS]);
    put_attribute(&text, &arrays[TRI_H5_OF_TRIANGLE_ATTRIBUTES], "attributes", "Cell");
    put_attribute(&text, &arrays[TRI_H5_OF_POINT_MARKERS], "marker", "Node");
    put_attribute(&text, &arrays[TRI_H5_OF_POINT_ATTRIBUTES], "point_attributes", "Node");
    put_words(&text, "</Grid>\n</Domain>\n</Xdmf>\n");
    free(text.name);
    return text.status;
}
