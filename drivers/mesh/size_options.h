/* Options of both programs for the length of edges and the placement of new vertices, and the size fields that they
 * define. */
#ifndef DRIVERS_MESH_SIZE_OPTIONS_H
#define DRIVERS_MESH_SIZE_OPTIONS_H

#include "triangle/api/generate.h"
#include "triangle/dropin/switches.h"
#include "triangle/size/lengths.h"
#include "triangle/text/size_file.h"

enum { SIZE_OPTIONS_MOST = 8 };

/* One option --size or --size-near. */
struct size_source {
    const char *given;  /* value of the option, borrowed from argv */
    char *path;         /* file name, malloc'ed; NULL: a number, or --size-near */
    bool has_extent;
    double extent[4];   /* extent of an array (tri_size_file_read), if has_extent */
    struct tri_size_field field; /* the field, if it is a number or --size-near */
};

struct size_options {
    int n;
    struct size_source source[SIZE_OPTIONS_MOST]; /* [n] in the order of the arguments */
    double gradation, min_size, max_size;         /* as in struct tri_sizes; 0: not given */
    double elements_across, per_circle;           /* likewise; 0: not given */
    double min_edge; /* shorter details of the input are removed (triangle/api/simplify.h); 0: not given */
    const char *region_polygons; /* GeoJSON file, borrowed from argv; NULL: not given */
};

/* Reads the option in argument *at, like long_options_take. Returns false if it is another argument. Sets *error if the
 * value is invalid. switches: receives --placement and --optimise; NULL: these are other arguments. */
bool size_options_take(struct size_options *options, struct tri_switches *switches, int argc, char *const *argv,
                       int *at, struct tri_error *error);

/* Completes the options after all arguments. Lengths set -q and --optimise 1, unless these are given, or switches is
 * NULL. TRI_BAD_INPUT: limits without lengths, or limits that exclude each other; --optimise with bounds that it cannot
 * keep. */
enum tri_status size_options_end(const struct size_options *options, struct tri_switches *switches,
                                 struct tri_error *error);
void size_options_free(struct size_options *options);

/* Returns true if lengths are requested. */
static inline bool size_options_any(const struct size_options *options)
{
    return options->n > 0 || options->max_size > 0 || options->elements_across > 0 || options->per_circle > 0;
}

/* Writes the options as one line. */
enum { SIZE_OPTIONS_TEXT = 1024 };
void size_options_print(const struct size_options *options, char text[SIZE_OPTIONS_TEXT]);

/* Replaces "sizes[2]" (counted from 0) at the begin of a message of lengths.h by the option that the user wrote. */
void size_options_name(const struct size_options *options, const char *sentence, char text[SIZE_OPTIONS_TEXT]);

/* --- the input, after the files have been read */

enum { CHANGED_TEXT = 320 };

/* Divides the input by the polygons of a file, if it is given, and writes one sentence about the changes. Otherwise the
 * text is "". Errors: as for geojson_read and tri_divide_by_polygons. */
enum tri_status size_options_divide(const struct size_options *options, struct tri_pslg *pslg,
                                    const struct tri_options *how, char text[CHANGED_TEXT], struct tri_error *error);

/* Removes details below min_edge, if it is given, and writes one sentence about the changes. Otherwise the text is
 * "". Errors: as for tri_simplify. */
enum tri_status size_options_simplify(const struct size_options *options, struct tri_pslg *pslg,
                                      const struct tri_executor *executor, const struct tri_stop *stop,
                                      char text[CHANGED_TEXT], struct tri_error *error);

/* --- the fields, after the files have been read */

struct size_fields {
    struct tri_size_file file[SIZE_OPTIONS_MOST];   /* files of sources with a path */
    struct tri_size_field field[SIZE_OPTIONS_MOST]; /* fields of all sources */
    struct tri_lengths *lengths;                    /* NULL: not made, or not requested */
};

/* Reads the files. size_fields_free must be called in any case. */
enum tri_status size_fields_read(struct size_fields *fields, const struct size_options *options,
                                 const struct tri_executor *executor, struct tri_error *error);

/* Makes the lengths for a mesh. region_areas: area bounds of regions also limit lengths outside the region. */
enum tri_status size_fields_make(struct size_fields *fields, const struct size_options *options, bool region_areas,
                                 const struct tri_mesh *mesh, const struct tri_executor *executor,
                                 struct tri_error *error);

void size_fields_free(struct size_fields *fields);

#endif
