/* The long options that both programs take: how long edges shall be, and where new vertices go; and the fields of
 * lengths that come of the first. */
#ifndef DRIVERS_MESH_SIZE_OPTIONS_H
#define DRIVERS_MESH_SIZE_OPTIONS_H

#include "triangle/dropin/switches.h"
#include "triangle/size/lengths.h"
#include "triangle/text/size_file.h"

enum { SIZE_OPTIONS_MOST = 8 };

/* One --size or --size-near. */
struct size_source {
    const char *given;  /* its value, a word of argv */
    char *path;         /* of a file, malloc'ed; NULL: a number, or NEAR */
    bool has_extent;
    double extent[4];   /* of an array (tri_size_file_read) */
    struct tri_size_field field; /* of a number, or NEAR */
};

struct size_options {
    int n;
    struct size_source source[SIZE_OPTIONS_MOST]; /* [n] in the order of the words */
    double gradation, min_size, max_size;         /* as in struct tri_sizes; 0: not given */
    double elements_across, per_circle;           /* likewise */
};

/* Takes the option in word *at, as long_options_take does; false: that is another word. *error is set if its value is
 * none. */
bool size_options_take(struct size_options *options, struct tri_switches *switches, int argc, char *const *argv,
                       int *at, struct tri_error *error);

/* Once all words have been taken: lengths set -q and --optimise 1, unless these have been given. TRI_BAD_INPUT: limits
 * of lengths that nothing asks for, or that exclude each other; --optimise beside bounds that it cannot keep. */
enum tri_status size_options_end(const struct size_options *options, struct tri_switches *switches,
                                 struct tri_error *error);
void size_options_free(struct size_options *options);

/* Are lengths asked for? */
static inline bool size_options_any(const struct size_options *options)
{
    return options->n > 0 || options->max_size > 0 || options->elements_across > 0 || options->per_circle > 0;
}

/* What is asked for, in a line. */
enum { SIZE_OPTIONS_TEXT = 1024 };
void size_options_print(const struct size_options *options, char text[SIZE_OPTIONS_TEXT]);

/* In a sentence of lengths.h a source is "sizes[2]", counted from 0: at its begin that becomes what the user wrote. */
void size_options_name(const struct size_options *options, const char *sentence, char text[SIZE_OPTIONS_TEXT]);

/* --- the fields, once the files have been read */

struct size_fields {
    struct tri_size_file file[SIZE_OPTIONS_MOST];   /* of sources with a path */
    struct tri_size_field field[SIZE_OPTIONS_MOST]; /* of all sources */
    struct tri_lengths *lengths;                    /* NULL: not made, or nothing is asked for */
};

/* Reads the files. To be freed in any case. */
enum tri_status size_fields_read(struct size_fields *fields, const struct size_options *options,
                                 const struct tri_executor *executor, struct tri_error *error);

/* Makes the lengths for a mesh. region_areas: the bounds of its regions limit them outside, too. */
enum tri_status size_fields_make(struct size_fields *fields, const struct size_options *options, bool region_areas,
                                 const struct tri_mesh *mesh, const struct tri_executor *executor,
                                 struct tri_error *error);

void size_fields_free(struct size_fields *fields);

#endif
