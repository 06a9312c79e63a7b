/* meshplot: draws a mesh from its files as PNG or SVG. This file handles arguments and files; drivers/plot/plot.h
 * draws. Exit code 0: drawn, 1: files cannot be read, drawn or written, 2: wrong usage. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cairo-svg.h>

#include "drivers/interrupt.h"
#include "drivers/judge/judged_files.h"
#include "drivers/plot/plot.h"
#include "drivers/start.h"
#include "drivers/words.h"
#include "triangle/base/system.h"
#include "triangle/mesh/pslg.h"
#include "triangle/text/names.h"
#include "triangle/text/text.h"
#include "triangle/text/write.h"

enum { TROUBLE = 1, MISUSE = 2 };

static const char usage[] = "Usage: " PTRIANGLE_NAME " BASE -o FILE.png|FILE.svg [options]\n";

static const char help[] = /* cmake/help.awk turns it into a manual page */
    "\n"
    "Draws the mesh in BASE.node and BASE.ele, with the segments of BASE.poly if that file exists. Without BASE.ele\n"
    "it draws points and segments only. BASE can also be the name of one file that ptriangle has written: .h5,\n"
    ".vtkhdf, .vtu, .msh, .2dm, .14 or .grd. If the mesh is larger than the memory (.h5 and text files) or has more\n"
    "than 16.7 million triangles, only the part inside the window is drawn. If that part has more than 16.7 million\n"
    "triangles, the picture shows their density instead.\n"
    "\n"
    "  -o, --output FILE        FILE.png or FILE.svg\n"
    "  -c, --color quality|area|region|block|none|density\n"
    "                           quality (default): the smallest angle of each triangle; region: its first\n"
    "                           attribute; block: see --blocks; density: number of triangles per pixel, below 1\n"
    "                           if triangles are larger than pixels, for meshes of any size\n"
    "  -s, --size WIDTH         width of the picture in pixels, 64 to 12000 (default 1200)\n"
    "  -w, --window X0,Y0,X1,Y1  part of the mesh to show (default: all)\n"
    "  -m, --mark X0,Y0,X1,Y1  draw a red frame around this part\n"
    "  -e, --edges auto|on|off  auto (default): short edges fade\n"
    "      --segments on|off    draw segments (default on)\n"
    "      --legend on|off      draw a legend (default on)\n"
    "  -t, --title TEXT         print a line above the picture\n"
    "  -b, --blocks FILE        file with one line `block phase` for each triangle, in the order of BASE.ele; a\n"
    "                           negative phase means that the triangle is in no block\n"
    "      --version, --help    print name and version; print this help\n"
    "\n"
    "Exit code: 0 for success, 1 if a file cannot be read or written, 2 for wrong usage.\n";

enum colouring { BY_QUALITY, BY_REGION, BY_AREA, BY_BLOCK, BY_NOTHING, BY_DENSITY };

struct settings {
    const char *base, *output, *blocks;
    enum colouring colour;
    bool is_base; /* a suffix of `base` was removed */
    bool has_window;
    struct plot_style style; /* window and mark in the caller's coordinates */
};

struct files {
    struct tri_pslg mesh; /* points and subsegments */
    struct tri_elements elements;
    int32_t *block_phase; /* [elements.n][2] block and phase of each triangle, or NULL */
    struct plot_density density;
    int64_t all_points, all_triangles; /* of the whole mesh, if only a part was read */
};

/* --- reading */

static const char *read_block_row(void *user, size_t i, struct tri_fields *fields)
{
    int32_t *block_phase = user;
    for (size_t k = 0; k < 2; k++) {
        int64_t value;
        if (tri_fields_integer(fields, &value) != TRI_FIELD_GOOD)
            return k == 0 ? "has no block" : "has no phase";
        if (value < INT32_MIN || value > INT32_MAX)
            return "has a number that is too large";
        block_phase[2 * i + k] = (int32_t)value;
    }
    return NULL;
}

static enum tri_status parse_blocks(struct files *f, const struct tri_text *text, struct tri_error *error)
{
    struct tri_cursor cursor = tri_cursor_begin(text);
    const size_t n = (size_t)f->elements.n;
    if (tri_cursor_remaining(&cursor) != n) {
        return tri_fail(error, TRI_BAD_INPUT, text->name, 0, "%zu lines for %zu triangles",
                        tri_cursor_remaining(&cursor), n);
    }
    f->block_phase = malloc(2 * (n + 1) * sizeof *f->block_phase);
    if (f->block_phase == NULL)
        return tri_fail(error, TRI_NO_MEMORY, "", 0, "out of memory");
    const struct tri_table table = {"triangle", n, 1, read_block_row, f->block_phase};
    return tri_cursor_table(&cursor, &table, NULL, error);
}

static enum tri_status read_blocks(struct files *f, const char *path, struct tri_error *error)
{
    struct tri_text text = {0};
    enum tri_status status = tri_text_load(&text, path, 0, NULL, NULL, error);
    if (status == TRI_OK)
        status = parse_blocks(f, &text, error);
    tri_text_free(&text);
    return status;
}

/* --- coordinates */

/* Returns x * 2^-exponent. It takes two steps because 2^1074 is no double. */
static double scale_down(double x, int exponent)
{
    const int half = exponent / 2;
    return ldexp(ldexp(x, -half), -(exponent - half));
}

/* Scales the points to |x| <= 1, so that squares neither overflow nor vanish. Returns the exponent. */
static int normalise(struct tri_pslg *mesh)
{
    double largest = 0;
    int exponent = 0;
    for (size_t i = 0; i < 2 * (size_t)mesh->n_points; i++)
        largest = fmax(largest, fabs(mesh->points[i]));
    if (largest > 0)
        (void)frexp(largest, &exponent);
    for (size_t i = 0; i < 2 * (size_t)mesh->n_points; i++)
        mesh->points[i] = scale_down(mesh->points[i], exponent);
    return exponent;
}

static struct plot_box scale_box(struct plot_box box, int exponent)
{
    return (struct plot_box){scale_down(box.x0, exponent), scale_down(box.y0, exponent), scale_down(box.x1, exponent),
                             scale_down(box.y1, exponent)};
}

/* Returns the box around the drawing. */
static struct plot_box whole(const struct plot_mesh *mesh)
{
    struct plot_box box = plot_box_empty;
    for (size_t i = 0; i < 3 * (size_t)mesh->n_triangles; i++)
        plot_box_extend(&box, mesh->points + 2 * (size_t)mesh->corners[i]);
    for (int32_t v = 0; mesh->n_triangles == 0 && v < mesh->n_points; v++)
        plot_box_extend(&box, mesh->points + 2 * (size_t)v);
    return plot_box_widened(box);
}

/* --- meshes of any size */

static enum tri_status read_densities(struct settings *s, struct files *f, const struct tri_check_source *source,
                                      struct tri_error *error)
{
    f->density.box = s->style.window;
    plot_window_pixels(&s->style, &f->density.width, &f->density.height);
    return plot_part_count(source, &f->density, &f->mesh, error);
}

/* Reads the triangles inside the window. TRI_TOO_LARGE: there are too many to be drawn, and nothing is kept. */
static enum tri_status read_visible_triangles(const struct plot_box *window, struct files *f,
                                      const struct tri_check_source *source, bool all, struct tri_error *error)
{
    if (all && source->n_triangles > plot_most_triangles())
        return tri_fail(error, TRI_TOO_LARGE, "", 0, "blocks are drawn of meshes of up to %d triangles",
                        (int)plot_most_triangles());
    enum tri_status status = plot_part_take(source, window, &f->mesh, &f->elements, error);
    if (status == TRI_TOO_LARGE) {
        tri_pslg_free(&f->mesh);
        tri_elements_free(&f->elements);
    }
    return status;
}

static void warn_of_densities(struct settings *s)
{
    fprintf(stderr, PTRIANGLE_NAME ": there are more than %d triangles to show: a picture of densities; --window shows "
                                   "those of a part\n", (int)plot_most_triangles());
    s->colour = BY_DENSITY;
}

static enum tri_status read_visible_part(struct settings *s, struct files *f, const struct tri_check_source *source,
                                 struct tri_error *error)
{
    const bool all = !s->has_window || s->colour == BY_BLOCK;
    struct plot_box box = s->style.window;
    enum tri_status status = all ? plot_part_box(source, &box, error) : TRI_OK;
    f->all_points = source->n_points;
    f->all_triangles = source->n_triangles;
    if (status == TRI_OK && s->colour != BY_DENSITY)
        status = read_visible_triangles(&box, f, source, all, error);
    if (status == TRI_TOO_LARGE && s->colour != BY_BLOCK) {
        warn_of_densities(s);
        status = TRI_OK;
    }
    if (s->colour != BY_DENSITY)
        return status;
    s->style.window = box;
    s->has_window = true;
    return status != TRI_OK ? status : read_densities(s, f, source, error);
}

static enum tri_status read_mesh(struct settings *s, struct files *f, struct tri_error *error)
{
    const struct judged_request ask = {.base = s->base, .is_base = s->is_base, .may_lack_triangles = true,
                                   .memory = 0.8 * tri_memory_left(), .scratch = tri_scratch_folder()};
    struct judged_files judged = {0};
    enum tri_status status = judged_read(&judged, &ask, error);
    if (status == TRI_OK)
        status = read_visible_part(s, f, &judged.source, error);
    judged_files_free(&judged);
    return status;
}

/* --- drawing and writing */

static enum tri_status shade(const struct settings *s, const struct files *f, const struct plot_mesh *mesh,
                             struct plot_shading *shading, struct tri_error *error)
{
    if (s->colour == BY_DENSITY)
        return plot_shade_density(shading, &f->density, error);
    switch (mesh->n_triangles > 0 ? s->colour : BY_NOTHING) {
    case BY_QUALITY:
        return plot_shade_quality(shading, mesh, error);
    case BY_AREA:
        return plot_shade_area(shading, mesh, error);
    case BY_REGION:
        if (f->elements.n_attributes == 0)
            return tri_fail(error, TRI_BAD_INPUT, "", 0,
                            "%s has no attribute of triangles for the region (made without -A?)", s->base);
        return plot_shade_region(shading, mesh, f->elements.attributes, f->elements.n_attributes, error);
    case BY_BLOCK:
        return plot_shade_block(shading, mesh, f->block_phase, error);
    default:
        return plot_shade_plain(shading, mesh, error);
    }
}

static cairo_status_t write_bytes(void *output, const unsigned char *data, unsigned int size)
{
    return tri_output_write(output, (const char *)data, size, NULL) == TRI_OK ? CAIRO_STATUS_SUCCESS
                                                                             : CAIRO_STATUS_WRITE_ERROR;
}

static enum tri_status cairo_failure(cairo_status_t status, const char *path, struct tri_error *error)
{
    if (status == CAIRO_STATUS_SUCCESS)
        return TRI_OK;
    return tri_fail(error, status == CAIRO_STATUS_WRITE_ERROR ? TRI_CANNOT_WRITE : TRI_INTERNAL, path, 0, "cairo: %s",
                    cairo_status_to_string(status));
}

/* Draws into the open output. */
static enum tri_status draw(const struct settings *s, const struct plot_mesh *mesh, const struct plot_shading *shading,
                            struct tri_output *output, struct tri_error *error)
{
    const bool vector = tri_name_ends(s->output, ".svg");
    const double width = s->style.width, height = plot_height(&s->style, shading);
    cairo_surface_t *surface = vector ? cairo_svg_surface_create_for_stream(write_bytes, output, width, height)
                                      : cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)width, (int)height);
    if (vector)
        cairo_svg_surface_set_document_unit(surface, CAIRO_SVG_UNIT_PX);
    cairo_t *cr = cairo_create(surface);
    enum tri_status status = plot_draw(cr, vector, mesh, shading, &s->style, error);
    cairo_destroy(cr);
    if (status == TRI_OK && !vector)
        status = cairo_failure(cairo_surface_write_to_png_stream(surface, write_bytes, output), s->output, error);
    cairo_surface_finish(surface);
    if (status == TRI_OK)
        status = cairo_failure(cairo_surface_status(surface), s->output, error);
    cairo_surface_destroy(surface);
    return status;
}

static enum tri_status write_picture(const struct settings *s, const struct plot_mesh *mesh,
                                     const struct plot_shading *shading, struct tri_error *error)
{
    static struct tri_output_set set; /* handlers know its temporary names (interrupt.c) */
    struct tri_output *output;
    interrupt_stage("drawing");
    interrupt_begin(&set);
    enum tri_status status = interrupt_open(&set, s->output, &output, error);
    if (status == TRI_OK)
        status = draw(s, mesh, shading, output, error);
    if (status == TRI_OK)
        return interrupt_commit(&set, true, error);
    interrupt_drop(&set);
    return interrupt_code() == 0 ? status : tri_fail(error, TRI_STOPPED, "", 0, "stopped by %s; nothing was written",
                                                     interrupt_cause());
}

static enum tri_status plot(struct settings *s, struct files *f, struct tri_error *error)
{
    struct plot_shading shading = {0};
    enum tri_status status = read_mesh(s, f, error);
    if (status == TRI_OK && s->colour == BY_BLOCK)
        status = read_blocks(f, s->blocks, error);
    if (status != TRI_OK)
        return status;
    const struct plot_mesh mesh = {
        .exponent = normalise(&f->mesh),
        .n_points = f->mesh.n_points,
        .points = f->mesh.points,
        .n_triangles = f->elements.n,
        .corners = f->elements.corners,
        .n_segments = f->mesh.n_segments,
        .segments = f->mesh.segments,
        .all_points = f->all_points,
        .all_triangles = f->all_triangles,
    };
    s->style.window = s->has_window ? scale_box(s->style.window, mesh.exponent) : whole(&mesh);
    s->style.mark = scale_box(s->style.mark, mesh.exponent);
    if (!(s->style.window.x1 - s->style.window.x0 > 1e-100 && s->style.window.y1 - s->style.window.y0 > 1e-100))
        return tri_fail(error, TRI_BAD_INPUT, "", 0, "the part to show is too small to be drawn");
    status = shade(s, f, &mesh, &shading, error);
    if (status == TRI_OK)
        status = write_picture(s, &mesh, &shading, error);
    plot_shading_free(&shading);
    return status;
}

/* --- arguments */

enum long_option { SEGMENTS = 256, LEGEND, VERSION, HELP };

static const struct option long_options[] = {
    {"output", required_argument, NULL, 'o'},  {"color", required_argument, NULL, 'c'},
    {"size", required_argument, NULL, 's'},    {"window", required_argument, NULL, 'w'},
    {"mark", required_argument, NULL, 'm'},    {"edges", required_argument, NULL, 'e'},
    {"title", required_argument, NULL, 't'},   {"blocks", required_argument, NULL, 'b'},
    {"segments", required_argument, NULL, SEGMENTS}, {"legend", required_argument, NULL, LEGEND},
    {"version", no_argument, NULL, VERSION},   {"help", no_argument, NULL, HELP},
    {NULL, 0, NULL, 0},
};

/* Finds the index of text in a list of words separated by bars. */
static bool parse_word(const char *text, const char *words, int *value)
{
    const size_t n = strlen(text);
    for (*value = 0; *words != '\0'; ++*value) {
        const size_t length = strcspn(words, "|");
        if (length == n && memcmp(words, text, n) == 0)
            return true;
        words += words[length] == '|' ? length + 1 : length;
    }
    return false;
}

static bool parse_box(const char *text, struct plot_box *box)
{
    double *const value[4] = {&box->x0, &box->y0, &box->x1, &box->y1};
    for (int k = 0; k < 4; k++) {
        char *end;
        *value[k] = strtod(text, &end);
        if (end == text || *end != (k < 3 ? ',' : '\0') || !isfinite(*value[k]))
            return false;
        text = end + 1;
    }
    return box->x0 < box->x1 && box->y0 < box->y1;
}

/* Applies one option. Returns false if its value is invalid. */
static bool apply(void *settings, int option)
{
    struct settings *s = settings;
    int word = 0;
    bool known = true;
    switch (option) {
    case 'o': s->output = optarg; return tri_name_ends(optarg, ".png") || tri_name_ends(optarg, ".svg");
    case 's': return words_take_real(optarg, "", NULL, 64, 12000, &s->style.width);
    case 'w': return s->has_window = parse_box(optarg, &s->style.window);
    case 'm': return s->style.has_mark = parse_box(optarg, &s->style.mark);
    case 't': s->style.title = optarg; break;
    case 'b': s->blocks = optarg; break;
    case 'c':
        known = parse_word(optarg, "quality|region|area|block|none|density", &word);
        s->colour = (enum colouring)word;
        break;
    case 'e':
        known = parse_word(optarg, "auto|on|off", &word);
        s->style.edges = (enum plot_edges)word;
        break;
    case SEGMENTS:
        known = parse_word(optarg, "off|on", &word);
        s->style.segments = word == 1;
        break;
    case LEGEND:
        known = parse_word(optarg, "off|on", &word);
        s->style.legend = word == 1;
        break;
    default: return false;
    }
    return known;
}

/* Returns 0 to go on, < 0 if the program is done, > 0: the exit code. */
static int parse_arguments(int argc, char **argv, struct settings *s)
{
    static const struct program_words words = {PTRIANGLE_NAME, PTRIANGLE_NAME " " PTRIANGLE_VERSION "\n", usage, help,
                                              "-:o:c:s:w:m:e:t:b:", long_options, VERSION, HELP, apply, NULL};
    char *mesh = NULL;
    enum words_end end = words_take_all(&words, argc, argv, s, &mesh);
    if (end != WORDS_TAKEN)
        return end == WORDS_ANSWERED ? -1 : MISUSE;
    if (s->output == NULL) {
        fputs(usage, stderr);
        return MISUSE;
    }
    if (s->colour == BY_BLOCK && s->blocks == NULL) {
        fputs(PTRIANGLE_NAME ": --color block needs --blocks FILE\n", stderr);
        return MISUSE;
    }
    s->style.width = floor(s->style.width);
    s->is_base = judged_cut_text_suffix(mesh);
    s->base = mesh;
    return 0;
}

const int program_trouble = TROUBLE;
const char program_version[] = PTRIANGLE_VERSION;

int program_main(int argc, char **argv)
{
    struct settings settings = {.style = {.width = 1200, .segments = true, .legend = true}};
    struct files files = {0};
    struct tri_error error = {0};
    int code = parse_arguments(argc, argv, &settings);
    if (code != 0)
        return code < 0 ? EXIT_SUCCESS : code;
    interrupt_stage("reading");
    if (!interrupt_start(PTRIANGLE_NAME, 0, 0)) {
        fputs(PTRIANGLE_NAME ": the system does not take a handler for the end\n", stderr);
        return TROUBLE;
    }
    enum tri_status status = plot(&settings, &files, &error);
    if (status == TRI_STOPPED)
        interrupt_tell();
    if (status != TRI_OK)
        one_line_error(stderr, PTRIANGLE_NAME ": ", &error);
    if (status == TRI_STOPPED)
        interrupt_told();
    code = status == TRI_STOPPED ? interrupt_code() : status != TRI_OK ? TROUBLE : EXIT_SUCCESS;
    tri_pslg_free(&files.mesh);
    tri_elements_free(&files.elements);
    free(files.block_phase);
    free(files.density.count);
    return code;
}
