/* Reads JIGSAW's .msh format, which shares only its suffix with Gmsh's: sections of KEY = numbers, followed by rows of
 * numbers separated by semicolons.
 *
 * For a mesh, POINT, TRIA3 and VALUE are read; for a grid, COORD and VALUE. Other sections are skipped. Points count
 * from 0. Values of a grid run along y first. A grid whose coordinates are evenly spaced, within a thousandth of a
 * step, is a raster; any other becomes a mesh with two triangles per cell. */
#include <math.h>
#include <stdlib.h>

#include "triangle/text/size_file.h"

static const double EVEN = 1e-3;

struct jigsaw {
    struct tri_words *words;
    bool is_grid;
    int64_t n_values;
    double *values;   /* [n_values] */
    int64_t n[2];     /* number of coordinates along x and y */
    double *coord[2]; /* [n[k]] increasing */
};

static bool begin_array(struct jigsaw *j, double **array, int64_t n)
{
    if (*array)
        return TRI_WORDS_FAIL(j->words, "a section occurs twice");
    *array = malloc(((size_t)n + 1) * sizeof **array);
    return *array || tri_reading_no_memory(&j->words->to);
}

static bool read_coordinates(struct jigsaw *j, double *to, int64_t n)
{
    for (int64_t i = 0; i < n; i++)
        if (!tri_words_real(j->words, "a coordinate", true, &to[i]))
            return false;
    return true;
}

/* Coordinates are followed by a group number. */
static bool read_points(struct jigsaw *j)
{
    struct tri_words *w = j->words;
    struct tri_pslg *mesh = w->to.mesh;
    int64_t n, group;
    if (!tri_words_count(w, "the number of points", 6, &n))
        return false;
    if (!begin_array(j, &mesh->points, 2 * n))
        return false;
    mesh->n_points = (int32_t)n;
    for (int64_t i = 0; i < n; i++)
        if (!read_coordinates(j, mesh->points + 2 * i, 2) ||
            !tri_words_whole(w, "the group of a point", INT64_MIN, INT64_MAX, &group))
            return false;
    return true;
}

static bool read_triangles(struct jigsaw *j)
{
    struct tri_words *w = j->words;
    int64_t n, corner;
    if (!tri_words_count(w, "the number of triangles", 8, &n))
        return false;
    if (w->to.elements->corners)
        return TRI_WORDS_FAIL(w, "a section occurs twice");
    if (!tri_reading_triangles(&w->to, n, 3))
        return false;
    for (int64_t i = 0; i < 4 * n; i++) {
        if (!tri_words_whole(w, "a corner", i % 4 < 3 ? 0 : INT32_MIN, INT32_MAX, &corner))
            return false;
        if (i % 4 < 3)
            w->to.elements->corners[i / 4 * 3 + i % 4] = (int32_t)corner;
    }
    return true;
}

static bool read_values(struct jigsaw *j)
{
    int64_t one;
    if (!tri_words_count(j->words, "the number of values", 2, &j->n_values) ||
        !tri_words_whole(j->words, "the number of values at a place", 1, 1, &one) ||
        !begin_array(j, &j->values, j->n_values))
        return false;
    for (int64_t i = 0; i < j->n_values; i++)
        if (!tri_words_length(j->words, &j->values[i]))
            return false;
    return true;
}

static bool read_axis(struct jigsaw *j)
{
    int64_t axis, n;
    if (!tri_words_whole(j->words, "the axis of coordinates", 1, 2, &axis) ||
        !tri_words_count(j->words, "the number of coordinates", 2, &n))
        return false;
    if (!begin_array(j, &j->coord[axis - 1], n) || !read_coordinates(j, j->coord[axis - 1], n))
        return false;
    j->n[axis - 1] = n;
    for (int64_t i = 1; i < n; i++)
        if (!(j->coord[axis - 1][i] > j->coord[axis - 1][i - 1]))
            return TRI_WORDS_FAIL(j->words, "coordinates do not increase");
    return true;
}

static bool read_head(struct jigsaw *j)
{
    struct tri_words *w = j->words;
    int64_t version;
    if (!tri_words_next(w) || !tri_words_is(w, "mshid"))
        return TRI_WORDS_FAIL(w, "not a .msh file of Gmsh ($MeshFormat) or of JIGSAW (mshid)");
    if (!tri_words_whole(w, "mshid", 1, 3, &version))
        return false;
    j->is_grid = tri_words_next(w) && tri_words_is(w, "euclidean-grid");
    return j->is_grid || tri_words_is(w, "euclidean-mesh") ||
           TRI_WORDS_FAIL(w, "neither euclidean-mesh nor euclidean-grid");
}

/* Skips a section. It has one line per item, except "radii", which is a single row. */
static bool skip_section(struct jigsaw *j)
{
    const bool is_row = tri_words_is(j->words, "radii");
    int64_t n = 0;
    if (!is_row && !tri_words_count(j->words, "the number of rows", 1, &n))
        return false;
    tri_words_skip_lines(j->words, n);
    return true;
}

static bool read_section(struct jigsaw *j)
{
    struct tri_words *w = j->words;
    int64_t two;
    if (tri_words_is(w, "ndims"))
        return tri_words_whole(w, "ndims", 2, 2, &two);
    if (tri_words_is(w, "point"))
        return read_points(j);
    if (tri_words_is(w, "tria3"))
        return read_triangles(j);
    if (tri_words_is(w, "value"))
        return read_values(j);
    return tri_words_is(w, "coord") ? read_axis(j) : skip_section(j);
}

/* --- conversion to a size field */

static bool is_even(const double *coord, int64_t n)
{
    const double step = n > 1 ? (coord[n - 1] - coord[0]) / (double)(n - 1) : 1;
    for (int64_t i = 0; i < n; i++)
        if (fabs(coord[i] - (coord[0] + (double)i * step)) > EVEN * step)
            return false;
    return isfinite(step);
}

static bool make_raster(struct jigsaw *j, struct tri_size_file *file)
{
    if (!tri_size_raster_begin(j->words, file, j->n[1], j->n[0]))
        return false;
    for (int k = 0; k < 2; k++) {
        file->field.origin[k] = j->coord[k][0];
        file->field.step[k] = j->n[k] > 1 ? (j->coord[k][j->n[k] - 1] - j->coord[k][0]) / (double)(j->n[k] - 1) : 1;
    }
    for (int64_t i = 0; i < j->n_values; i++)
        file->values[i % j->n[1] * j->n[0] + i / j->n[1]] = j->values[i];
    return true;
}

/* Points are numbered like the values. */
static bool make_mesh_of_grid(struct jigsaw *j)
{
    struct tri_reading *to = &j->words->to;
    const int64_t nx = j->n[0], ny = j->n[1], cells = (nx - 1) * (ny - 1);
    if (!begin_array(j, &to->mesh->points, 2 * nx * ny) || !tri_reading_triangles(to, 2 * cells, 3))
        return false;
    to->mesh->n_points = (int32_t)(nx * ny);
    for (int64_t i = 0; i < nx * ny; i++) {
        to->mesh->points[2 * i] = j->coord[0][i / ny];
        to->mesh->points[2 * i + 1] = j->coord[1][i % ny];
    }
    for (int64_t i = 0; i < cells; i++) {
        const int32_t low = (int32_t)(i / (ny - 1) * ny + i % (ny - 1)), right = low + (int32_t)ny;
        const int32_t corners[] = {low, right, right + 1, low, right + 1, low + 1};
        for (int k = 0; k < 6; k++)
            to->elements->corners[6 * i + k] = corners[k];
    }
    return true;
}

static bool make_field(struct jigsaw *j, struct tri_size_file *file)
{
    struct tri_words *w = j->words;
    if (j->is_grid && (j->n[0] == 0 || j->n[1] == 0))
        return TRI_WORDS_FAIL(w, "a grid needs COORD along x and along y");
    const int64_t expected = j->is_grid ? j->n[0] * j->n[1] : w->to.mesh->n_points;
    if (!j->values || j->n_values != expected || expected == 0)
        return TRI_WORDS_FAIL(w, "the number of values is %lld, the number of places %lld", (long long)j->n_values,
                              (long long)expected);
    if (j->is_grid && is_even(j->coord[0], j->n[0]) && is_even(j->coord[1], j->n[1]))
        return make_raster(j, file);
    if (j->is_grid && (w->to.mesh->points || w->to.elements->corners))
        return TRI_WORDS_FAIL(w, "a grid must not have points or triangles");
    if (j->is_grid && !make_mesh_of_grid(j))
        return false;
    w->to.mesh->attributes = j->values;
    w->to.mesh->n_attributes = 1;
    j->values = NULL;
    return true;
}

bool tri_size_read_jigsaw(struct tri_words *words, struct tri_size_file *file)
{
    struct jigsaw j = {.words = words};
    words->blanks = ";=";
    words->comment = "#";
    bool good = read_head(&j);
    while (good && tri_words_next(words))
        good = read_section(&j);
    good = good && make_field(&j, file);
    free(j.values);
    free(j.coord[0]);
    free(j.coord[1]);
    return good;
}
