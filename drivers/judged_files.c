/* The files of a mesh on trial. */
#include "drivers/judged_files.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "triangle/executor.h"
#include "triangle/text/read.h"
#include "triangle/text/text.h"

/* One task for each thread of OpenMP; without it one after another. */
static void run_tasks(void *self, size_t n, void (*task)(void *context, size_t i), void *context)
{
    (void)self;
#pragma omp parallel for schedule(dynamic)
    for (size_t i = 0; i < n; i++)
        task(context, i);
}

static const struct tri_executor all_cores = {run_tasks, NULL};

/* Stem + suffix, malloc'ed. */
static char *with_suffix(const char *stem, const char *suffix)
{
    size_t n = strlen(stem) + strlen(suffix) + 1;
    char *path = malloc(n);
    if (path != NULL)
        (void)snprintf(path, n, "%s%s", stem, suffix);
    return path;
}

/* Cuts one of the suffixes off. */
bool judged_cut_suffix(char *path, const char *suffix)
{
    size_t n = strlen(path), m = strlen(suffix);
    if (n <= m || strcmp(path + n - m, suffix) != 0)
        return false;
    path[n - m] = '\0';
    return true;
}

struct neighbor_rows {
    int32_t *neighbors;
    int32_t base;
};

static const char *read_neighbor_row(void *user, size_t i, struct tri_fields *fields)
{
    struct neighbor_rows *rows = user;
    int64_t value;
    if (tri_fields_integer(fields, &value) != TRI_FIELD_GOOD)
        return "has no number";
    for (size_t k = 0; k < 3; k++) {
        if (tri_fields_integer(fields, &value) != TRI_FIELD_GOOD)
            return "lacks a neighbor";
        if (value < -1 || value > INT32_MAX)
            return "has a neighbor that is no triangle";
        rows->neighbors[3 * i + k] = value < 0 ? -1 : (int32_t)value - rows->base;
    }
    return NULL;
}

static enum tri_status parse_neighbors(struct judged_files *f, const struct tri_text *text, struct tri_error *error)
{
    struct tri_cursor cursor = tri_cursor_begin(text);
    struct tri_fields fields;
    int64_t n = 0;
    if (!tri_cursor_next(&cursor, &fields) || tri_fields_integer(&fields, &n) != TRI_FIELD_GOOD || n < 0 ||
        tri_cursor_remaining(&cursor) < (size_t)n)
        return tri_fail(error, TRI_BAD_INPUT, text->name, 1, "the number of triangles is not that of the records");
    f->stale_neighbors = n != f->elements.n; /* left there by an earlier run */
    if (f->stale_neighbors)
        return TRI_OK;
    f->neighbors = malloc(3 * ((size_t)n + 1) * sizeof *f->neighbors);
    if (f->neighbors == NULL)
        return tri_fail(error, TRI_NO_MEMORY, "", 0, "out of memory");
    struct neighbor_rows rows = {f->neighbors, f->base};
    struct tri_table table = {"triangle", (size_t)n, f->base, read_neighbor_row, &rows};
    return tri_cursor_table(&cursor, &table, &all_cores, error);
}

static enum tri_status read_neighbors(struct judged_files *f, const char *path, struct tri_error *error)
{
    struct tri_text text = {0};
    enum tri_status status = tri_text_load(&text, path, 0, &all_cores, NULL, error);
    if (status == TRI_OK)
        status = parse_neighbors(f, &text, error);
    tri_text_free(&text);
    return status;
}

enum tri_status judged_read_mesh(struct judged_files *f, const char *base, struct tri_error *error)
{
    struct tri_read_options options = {.default_base = 1, .may_be_empty = true, .executor = &all_cores};
    char *node = with_suffix(base, ".node"), *ele = with_suffix(base, ".ele");
    char *poly = with_suffix(base, ".poly"), *neigh = with_suffix(base, ".neigh");
    enum tri_status status = TRI_OK;
    if (node == NULL || ele == NULL || poly == NULL || neigh == NULL) {
        status = tri_fail(error, TRI_NO_MEMORY, "", 0, "out of memory");
    } else {
        bool points_in_poly;
        f->has_poly = access(poly, F_OK) == 0;
        status = f->has_poly ? tri_read_poly(poly, node, &options, &f->mesh, &f->base, &points_in_poly, error)
                             : tri_read_node(node, &options, &f->mesh, &f->base, error);
    }
    if (status == TRI_OK)
        status = tri_read_ele(ele, &options, f->base, f->mesh.n_points, &f->elements, error);
    if (status == TRI_OK && access(neigh, F_OK) == 0)
        status = read_neighbors(f, neigh, error);
    free(node);
    free(ele);
    free(poly);
    free(neigh);
    return status;
}

enum tri_status judged_read_input(struct judged_files *f, const char *path, struct tri_error *error)
{
    struct tri_read_options options = {.default_base = f->base, .executor = &all_cores,
                                       .regions_if_any = f->elements.n_attributes > 0};
    int32_t base;
    bool points_in_poly;
    char *stem = with_suffix(path, "");
    if (stem == NULL)
        return tri_fail(error, TRI_NO_MEMORY, "", 0, "out of memory");
    if (judged_cut_suffix(stem, ".node")) {
        free(stem);
        return tri_read_node(path, &options, &f->input, &base, error);
    }
    (void)judged_cut_suffix(stem, ".poly");
    char *node = with_suffix(stem, ".node");
    free(stem);
    enum tri_status status = tri_read_poly(path, node, &options, &f->input, &base, &points_in_poly, error);
    free(node);
    return status;
}

void judged_files_free(struct judged_files *f)
{
    tri_pslg_free(&f->mesh);
    tri_elements_free(&f->elements);
    free(f->neighbors);
    tri_pslg_free(&f->input);
}
