/* One grid: its topology, its geometry, and its attributes. */
#include "triangle/hdf5/views.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct text {
    struct tri_output *output;
    char *name; /* of the HDF5 file, as XML wants it */
    enum tri_status status;
    struct tri_error *error;
};

static void put(struct text *text, const char *words)
{
    text->status = text->status ? text->status : tri_output_write(text->output, words, strlen(words), text->error);
}

/* The characters that XML takes for its own. Malloc'ed; NULL: no memory. */
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

static void put_item(struct text *text, const struct tri_h5_array *array)
{
    char words[200], width[20] = "";
    if (!array->is_list)
        snprintf(width, sizeof width, " %" PRId32, array->laid->width);
    snprintf(words, sizeof words, "<DataItem Dimensions=\"%" PRId64 "%s\" NumberType=\"%s\" Precision=\"%d\" "
             "Format=\"HDF\">", array->n, width, array->laid->type == TRI_H5_FLOAT64 ? "Float" : "Int",
             array->laid->type == TRI_H5_INT32 ? 4 : 8);
    put(text, words);
    put(text, text->name);
    put(text, ":/");
    put(text, array->name);
    put(text, "</DataItem>");
}

static void put_attribute(struct text *text, const struct tri_h5_array *array, const char *name, const char *center)
{
    char words[200];
    if (!array->file)
        return;
    snprintf(words, sizeof words, "<Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"%s\">\n", name,
             array->laid->width == 1 ? "Scalar" : "Matrix", center);
    put(text, words);
    put_item(text, array);
    put(text, "\n</Attribute>\n");
}

static void put_grid(struct text *text, const struct tri_h5_array *triangles, const struct tri_h5_array *points)
{
    char words[300];
    snprintf(words, sizeof words,
             "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n<Grid Name=\"mesh\" GridType=\"Uniform\">\n"
             "<Topology TopologyType=\"Triangle\" NumberOfElements=\"%" PRId64 "\" NodesPerElement=\"3\">\n",
             triangles->n);
    put(text, words);
    put_item(text, triangles);
    put(text, "\n</Topology>\n<Geometry GeometryType=\"XY\">\n");
    put_item(text, points);
    put(text, "\n</Geometry>\n");
}

enum tri_status tri_h5_write_xdmf(struct tri_output *output, const char *name,
                                  const struct tri_h5_array arrays[TRI_H5_KINDS], struct tri_error *error)
{
    struct text text = {output, escaped(name), TRI_OK, error};
    if (!text.name)
        return tri_fail(error, TRI_NO_MEMORY, output->path, 0, "out of memory for file names");
    put_grid(&text, &arrays[TRI_H5_OF_TRIANGLES], &arrays[TRI_H5_OF_POINTS]);
    put_attribute(&text, &arrays[TRI_H5_OF_TRIANGLE_ATTRIBUTES], "attributes", "Cell");
    put_attribute(&text, &arrays[TRI_H5_OF_POINT_MARKERS], "marker", "Node");
    put_attribute(&text, &arrays[TRI_H5_OF_POINT_ATTRIBUTES], "point_attributes", "Node");
    put(&text, "</Grid>\n</Domain>\n</Xdmf>\n");
    free(text.name);
    return text.status;
}
