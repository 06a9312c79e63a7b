#include "triangle/text/size_file.h"

#include <stdlib.h>
#include <string.h>

#include "triangle/text/formats.h"
#include "triangle/text/names.h"
#include "triangle/text/read.h"

bool tri_size_file_is_known(const char *path)
{
    return tri_name_ends(path, ".asc") || tri_name_ends(path, ".npy") || tri_name_ends(path, ".node") ||
           tri_name_ends(path, ".pos") || tri_format_of(path);
}

/* Reads a text file; if the suffix is ambiguous, the content decides the format. */
static enum tri_status read_text(struct tri_size_file *file, struct tri_words *w)
{
    const char *path = w->to.path;
    w->to.status = tri_text_load(&w->text, path, 0, w->to.executor, NULL, w->to.error);
    if (w->to.status)
        return w->to.status;
    w->at = w->text.data;
    w->line = 1;
    w->blanks = "";
    if (tri_name_ends(path, ".asc"))
        (void)tri_size_read_asc(w, file);
    else if (tri_name_ends(path, ".pos"))
        (void)tri_size_read_pos(w);
    else if (tri_words_seek(w) && *w->at == '$')
        (void)tri_size_read_gmsh(w);
    else
        (void)tri_size_read_jigsaw(w, file);
    return w->to.status;
}

/* Is this one of Gmsh's binary files? Their second line shows it. */
static bool is_binary_msh(const char *path)
{
    static const char head[] = "$MeshFormat\n4.1 1";
    char bytes[sizeof head] = "";
    const tri_file file = tri_file_open(path, TRI_OPEN_NO_WAIT);
    const bool is = file != TRI_NO_FILE && tri_read_at(file, bytes, sizeof head - 1, 0) == (int64_t)sizeof head - 1 &&
                    memcmp(bytes, head, sizeof head - 1) == 0;
    if (file != TRI_NO_FILE)
        (void)tri_file_close(file);
    return is;
}

/* Reads the .node file, and the .ele file next to it. */
static enum tri_status read_node(struct tri_reading *to)
{
    const struct tri_read_options options = {.default_base = 1, .may_be_empty = true, .executor = to->executor};
    int32_t base;
    enum tri_status status = tri_read_node(to->path, &options, to->mesh, &base, to->error);
    char *ele = tri_name(to->path, strlen(to->path) - strlen(".node"), ".ele");
    if (!status && !ele)
        status = tri_fail(to->error, TRI_NO_MEMORY, NULL, 0, "out of memory for file names");
    status = status ? status : tri_read_ele(ele, &options, base, to->mesh->n_points, to->elements, to->error);
    free(ele);
    return status;
}

static enum tri_status read_with(struct tri_size_file *file, struct tri_words *w)
{
    struct tri_reading *to = &w->to;
    const struct tri_format *format = tri_format_of(to->path);
    if (tri_name_ends(to->path, ".node"))
        return read_node(to);
    if (tri_name_ends(to->path, ".msh") && is_binary_msh(to->path))
        return tri_read_msh_data(to->path, to->mesh, to->elements, to->executor, to->error);
    if (!format || tri_name_ends(to->path, ".msh"))
        return read_text(file, w);
    return format->read(to->path, to->mesh, to->elements, to->executor, to->error);
}

/* Moves the mesh into the file; the first attribute of each point is its edge length. */
static enum tri_status move_mesh(struct tri_size_file *file, struct tri_reading *to)
{
    struct tri_pslg *mesh = to->mesh;
    struct tri_elements *elements = to->elements;
    const int64_t n = mesh->n_points, width = mesh->n_attributes;
    if (n == 0 || width == 0)
        return tri_fail(to->error, TRI_BAD_INPUT, to->path, 0, "there is no length at any point");
    for (int64_t i = 0; i < 3 * (int64_t)elements->n; i++)
        if (elements->corners[i] < 0 || elements->corners[i] >= n)
            return tri_fail(to->error, TRI_BAD_INPUT, to->path, 0, "a triangle refers to point %ld of %ld",
                            (long)elements->corners[i], (long)n);
    for (int64_t i = 0; i < n; i++)
        mesh->attributes[i] = mesh->attributes[i * width];
    file->values = mesh->attributes;
    file->points = mesh->points;
    file->triangles = elements->corners;
    mesh->attributes = mesh->points = NULL;
    elements->corners = NULL;
    file->field = (struct tri_size_field){.kind = TRI_SIZE_MESH, .values = tri_reals_of(file->values, n, 1),
                                          .points = tri_reals_of(file->points, n, 2),
                                          .triangles = tri_ints_of(file->triangles, elements->n, 3)};
    return TRI_OK;
}

enum tri_status tri_size_file_read(struct tri_size_file *file, const char *path, const double extent[4],
                                   const struct tri_executor *executor, struct tri_error *error)
{
    struct tri_pslg mesh = {0};
    struct tri_elements elements = {0};
    struct tri_words words = {.to = {path, executor, &mesh, &elements, error, TRI_OK}};
    *file = (struct tri_size_file){0};
    if (tri_name_ends(path, ".npy"))
        return tri_size_read_npy(file, path, extent, error);
    enum tri_status status = read_with(file, &words);
    if (!status && file->field.kind != TRI_SIZE_RASTER)
        status = move_mesh(file, &words.to);
    tri_text_free(&words.text);
    tri_pslg_free(&mesh);
    tri_elements_free(&elements);
    return status;
}

void tri_size_file_free(struct tri_size_file *file)
{
    free(file->values);
    free(file->points);
    free(file->triangles);
    *file = (struct tri_size_file){0};
}
