#include "drivers/mesh/size_options.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drivers/mesh/geojson.h"
#include "drivers/words.h"
#include "triangle/api/simplify.h"
#include "triangle/text/decimal.h"
#include "triangle/text/names.h"

static const double USUAL_GRADATION = 0.2; /* struct tri_sizes */

enum id { SIZE, SIZE_NEAR, GRADATION, MIN_SIZE, MAX_SIZE, ELEMENTS_ACROSS, PER_CIRCLE, MIN_EDGE, REGION_POLYGONS,
          PLACEMENT, OPTIMISE };

static const struct kind {
    const char *name;
    enum id id;
    const char *wanted; /* requirement for a value, for errors */
} kinds[] = {
    {"size", SIZE, "neither a length above 0 nor a file of lengths (" TRI_SIZE_SUFFIXES ")"},
    {"size-near", SIZE_NEAR, "not MARKER:LENGTH or MARKER:LENGTH,GROWTH"},
    {"gradation", GRADATION, "not a number above 0, or inf"},
    {"min-size", MIN_SIZE, "not a length above 0"},
    {"max-size", MAX_SIZE, "not a length above 0"},
    {"elements-across", ELEMENTS_ACROSS, "not a number from 0.1 to 1000"},
    {"per-circle", PER_CIRCLE, "not a number from 3 to 100000"},
    {"min-edge", MIN_EDGE, "not a length above 0"},
    {"region-polygons", REGION_POLYGONS, "no name of a file"},
    {"placement", PLACEMENT, "neither front, lattice nor classic"},
    {"optimise", OPTIMISE, "not a whole number from 0 to 1000"},
};

static const struct kind *find_kind(const char *word)
{
    for (size_t i = 0; strncmp(word, "--", 2) == 0 && i < sizeof kinds / sizeof *kinds; i++) {
        const size_t n = strlen(kinds[i].name);
        if (strncmp(word + 2, kinds[i].name, n) == 0 && (word[2 + n] == 0 || word[2 + n] == '='))
            return &kinds[i];
    }
    return NULL;
}

/* --- values; functions return false if the text is invalid */

static bool read_length(const char *text, double *length)
{
    return words_take_real(text, "", NULL, DBL_TRUE_MIN, DBL_MAX, length);
}

/* Reads four numbers separated by commas. extent: receives them. */
static bool read_extent(const char *text, double extent[4])
{
    const char *const end = text + strlen(text);
    for (int k = 0; k < 4; k++) {
        const char *behind = tri_scan_real(text, end, &extent[k]);
        if (behind == text || *behind != (k < 3 ? ',' : 0) || !isfinite(extent[k]))
            return false;
        text = behind + 1;
    }
    return true;
}

/* Reads a file name with a known suffix. For an array, @ and its extent follow. */
static bool take_file(struct size_source *source, const char *text)
{
    const char *at = strrchr(text, '@');
    source->path = tri_joined(text, "");
    if (!source->path || tri_size_file_is_known(source->path))
        return true;
    if (!at)
        return false;
    source->path[at - text] = 0;
    source->has_extent = read_extent(at + 1, source->extent);
    return source->has_extent && tri_name_ends(source->path, ".npy");
}

static bool take_size(struct size_source *source, const char *text)
{
    double number;
    const char *const end = text + strlen(text);
    if (tri_scan_real(text, end, &number) != end || end == text)
        return take_file(source, text);
    source->field.kind = TRI_SIZE_NUMBER;
    return read_length(text, &source->field.length);
}

static bool take_near(struct size_source *source, const char *text)
{
    struct tri_size_field *field = &source->field;
    const char *const end = text + strlen(text);
    int64_t marker;
    const char *at = tri_scan_integer(text, end, &marker);
    if (at == text || *at != ':' || marker < INT32_MIN || marker > INT32_MAX)
        return false;
    *field = (struct tri_size_field){.kind = TRI_SIZE_NEAR, .marker = (int32_t)marker, .growth = -1};
    const char *length = at + 1;
    at = tri_scan_real(length, end, &field->length);
    if (at == length || !(field->length > 0 && isfinite(field->length)))
        return false;
    return *at == 0 || (*at == ',' && words_take_real(at + 1, "", NULL, 0, DBL_MAX, &field->growth));
}

static bool take_source(struct size_options *options, enum id id, const char *text)
{
    struct size_source *source = &options->source[options->n++];
    *source = (struct size_source){.given = text};
    return id == SIZE ? take_size(source, text) : take_near(source, text);
}

static bool take_placement(struct tri_switches *switches, const char *text)
{
    static const char *const names[] = {[TRI_PLACEMENT_LATTICE] = "lattice", [TRI_PLACEMENT_CLASSIC] = "classic",
                                        [TRI_PLACEMENT_FRONT] = "front"};
    for (int k = 0; k < (int)(sizeof names / sizeof *names); k++)
        if (strcmp(text, names[k]) == 0) {
            switches->placement = (enum tri_placement)k;
            return true;
        }
    return false;
}

static bool take_passes(struct tri_switches *switches, const char *text)
{
    int64_t passes;
    const char *const end = text + strlen(text);
    if (end == text || tri_scan_integer(text, end, &passes) != end || passes < 0 || passes > 1000)
        return false;
    switches->passes = (int)passes;
    return true;
}

static bool take_value(struct size_options *options, struct tri_switches *switches, enum id id, const char *text)
{
    switch (id) {
    case SIZE:
    case SIZE_NEAR: return take_source(options, id, text);
    case GRADATION: return words_take_real(text, "", NULL, DBL_TRUE_MIN, HUGE_VAL, &options->gradation);
    case MIN_SIZE: return read_length(text, &options->min_size);
    case MAX_SIZE: return read_length(text, &options->max_size);
    case ELEMENTS_ACROSS: return words_take_real(text, "", NULL, 0.1, 1000, &options->elements_across);
    case PER_CIRCLE: return words_take_real(text, "", NULL, 3, 1e5, &options->per_circle);
    case MIN_EDGE: return read_length(text, &options->min_edge);
    case REGION_POLYGONS: options->region_polygons = text; return *text != 0;
    case PLACEMENT: return take_placement(switches, text);
    case OPTIMISE: return take_passes(switches, text);
    default: return false;
    }
}

bool size_options_take(struct size_options *options, struct tri_switches *switches, int argc, char *const *argv,
                       int *at, struct tri_error *error)
{
    const struct kind *kind = find_kind(argv[*at]);
    if (!kind || (!switches && kind->id >= PLACEMENT))
        return false;
    const char *equals = argv[*at] + 2 + strlen(kind->name);
    const char *value = *equals ? equals + 1 : *at + 1 < argc ? argv[++*at] : NULL;
    if (!value)
        tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--%s needs a value", kind->name);
    else if (kind->id <= SIZE_NEAR && options->n == SIZE_OPTIONS_MOST)
        tri_fail(error, TRI_BAD_INPUT, NULL, 0, "no more than %d times --size and --size-near", SIZE_OPTIONS_MOST);
    else if (!take_value(options, switches, kind->id, value))
        tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--%s: \"%.80s\" is %s", kind->name, value, kind->wanted);
    else if (options->n > 0 && kind->id == SIZE && options->source[options->n - 1].field.kind == 0 &&
             !options->source[options->n - 1].path)
        tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for file names");
    return true;
}

enum tri_status size_options_end(const struct size_options *options, struct tri_switches *switches,
                                 struct tri_error *error)
{
    const bool any = size_options_any(options);
    if (!any && (options->gradation > 0 || options->min_size > 0))
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--%s limits lengths that nothing asks for: --size, --size-near,"
                        " --max-size, --elements-across or --per-circle does",
                        options->gradation > 0 ? "gradation" : "min-size");
    if (options->max_size > 0 && options->min_size > options->max_size)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--min-size %g is above --max-size %g", options->min_size,
                        options->max_size);
    if (!switches)
        return TRI_OK;
    if (switches->passes > 0 &&
        (switches->area || switches->area_lists || switches->conforming || switches->max_steiner >= 0))
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--optimise moves vertices, and cannot keep -a, -D or -S");
    if (any && !switches->angle)
        tri_switches_add(switches, "q");
    if (any && switches->passes < 0)
        switches->passes = 1;
    return TRI_OK;
}

void size_options_free(struct size_options *options)
{
    for (int i = 0; i < options->n; i++)
        free(options->source[i].path);
    options->n = 0;
}

/* --- as text */

struct line {
    char *at;
    size_t left; /* bytes, with the final 0 */
};

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static void add(struct line *line, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const int n = vsnprintf(line->at, line->left, format, arguments);
    va_end(arguments);
    const size_t used = n < 0 ? 0 : (size_t)n < line->left ? (size_t)n : line->left - 1;
    line->at += used;
    line->left -= used;
}

void size_options_print(const struct size_options *options, char text[SIZE_OPTIONS_TEXT])
{
    struct line line = {text, SIZE_OPTIONS_TEXT};
    *text = 0;
    for (int i = 0; i < options->n; i++) {
        const struct size_source *source = &options->source[i];
        const struct tri_size_field *f = &source->field;
        add(&line, i ? ", " : "");
        if (source->path)
            add(&line, "%.80s", source->path);
        else
            add(&line, "%g", f->length);
        if (f->kind == TRI_SIZE_NEAR)
            add(&line, " at segments with marker %ld", (long)f->marker);
        if (f->kind == TRI_SIZE_NEAR && f->growth >= 0)
            add(&line, " growing by %g", f->growth);
    }
    const char *between = options->n > 0 ? ", " : "";
    if (options->elements_across > 0) {
        add(&line, "%s%g across channels", between, options->elements_across);
        between = ", ";
    }
    if (options->per_circle > 0)
        add(&line, "%s%g around a circle", between, options->per_circle);
    if (options->min_size > 0)
        add(&line, "; at least %g", options->min_size);
    if (options->max_size > 0)
        add(&line, "%sat most %g", line.at > text ? "; " : "", options->max_size);
    add(&line, "; gradation %g", options->gradation > 0 ? options->gradation : USUAL_GRADATION);
}

void size_options_name(const struct size_options *options, const char *sentence, char text[SIZE_OPTIONS_TEXT])
{
    int64_t k = -1;
    const char *const end = sentence + strlen(sentence);
    const char *at = strncmp(sentence, "sizes[", 6) == 0 ? tri_scan_integer(sentence + 6, end, &k) : sentence;
    const bool is_source = k >= 0 && k < options->n && *at == ']';
    const struct size_source *source = is_source ? &options->source[k] : NULL;
    if (source)
        snprintf(text, SIZE_OPTIONS_TEXT, "--size%s %.200s%s", source->field.kind == TRI_SIZE_NEAR ? "-near" : "",
                 source->given, at + 1);
    else
        snprintf(text, SIZE_OPTIONS_TEXT, "%s", sentence);
}

/* --- the input */

enum tri_status size_options_divide(const struct size_options *options, struct tri_pslg *pslg,
                                    const struct tri_options *how, char text[CHANGED_TEXT], struct tri_error *error)
{
    struct tri_polygons polygons = {0};
    const int32_t points = pslg->n_points;
    *text = 0;
    enum tri_status status = options->region_polygons ? geojson_read(&polygons, options->region_polygons, error)
                                                      : TRI_OK;
    if (!status && polygons.n_points > 0)
        status = tri_divide_by_polygons(pslg, &polygons, how, error);
    if (options->region_polygons)
        snprintf(text, CHANGED_TEXT, "Regions by the polygons of %ld features: %ld points more, %ld segments, %ld"
                 " region points", (long)polygons.n_features, (long)(pslg->n_points - points), (long)pslg->n_segments,
                 (long)pslg->n_regions);
    tri_polygons_free(&polygons);
    return status;
}

enum tri_status size_options_simplify(const struct size_options *options, struct tri_pslg *pslg,
                                      const struct tri_executor *executor, const struct tri_stop *stop,
                                      char text[CHANGED_TEXT], struct tri_error *error)
{
    *text = 0;
    if (!(options->min_edge > 0))
        return TRI_OK;
    struct tri_simplify_report r;
    const int32_t points = pslg->n_points;
    const enum tri_status status = tri_simplify(pslg, options->min_edge, executor, stop, &r, error);
    snprintf(text, CHANGED_TEXT, "Simplified by --min-edge %g: %ld of %ld points are gone, with %ld islands, "
             "%ld holes, %ld regions; %ld short segments remain", options->min_edge,
             (long)(r.corners + r.island_points), (long)points, (long)r.islands, (long)r.holes, (long)r.regions,
             (long)r.shorter);
    return status;
}

/* --- the fields */

enum tri_status size_fields_read(struct size_fields *fields, const struct size_options *options,
                                 const struct tri_executor *executor, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    for (int i = 0; !status && i < options->n; i++) {
        const struct size_source *source = &options->source[i];
        if (source->path)
            status = tri_size_file_read(&fields->file[i], source->path, source->has_extent ? source->extent : NULL,
                                        executor, error);
        fields->field[i] = source->path ? fields->file[i].field : source->field;
    }
    return status;
}

enum tri_status size_fields_make(struct size_fields *fields, const struct size_options *options, bool region_areas,
                                 const struct tri_mesh *mesh, const struct tri_executor *executor,
                                 struct tri_error *error)
{
    const struct tri_sizes sizes = {.fields = fields->field, .n = options->n, .gradation = options->gradation,
                                    .min_size = options->min_size, .max_size = options->max_size,
                                    .elements_across = options->elements_across, .per_circle = options->per_circle,
                                    .region_areas = region_areas};
    struct tri_error own = {0};
    char text[SIZE_OPTIONS_TEXT];
    const enum tri_status status = tri_lengths_new(&fields->lengths, &sizes, mesh, executor, &own);
    if (!status)
        return status;
    size_options_name(options, own.text, text);
    return tri_fail(error, status, own.file[0] ? own.file : NULL, own.line, "%s", text);
}

void size_fields_free(struct size_fields *fields)
{
    for (int i = 0; i < SIZE_OPTIONS_MOST; i++)
        tri_size_file_free(&fields->file[i]);
    tri_lengths_free(fields->lengths);
    fields->lengths = NULL;
}
