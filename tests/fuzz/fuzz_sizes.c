/* Fuzz target: fields of lengths in files. The first byte selects the format, the rest is the file. For any content the
 * reader returns a field with valid indices, or one sentence. If the mesher accepts the field, each length is
 * positive. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "triangle/api/generate.h"
#include "triangle/size/lengths.h"
#include "triangle/text/size_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require(bool condition, const char *what)
{
    if (condition)
        return;
    fprintf(stderr, "fuzz_sizes: %s\n", what);
    abort();
}

static void write_file(const char *name, const uint8_t *data, size_t size)
{
    FILE *file = fopen(name, "wb");
    require(file && fwrite(data, 1, size, file) == size && fclose(file) == 0, "no file can be written");
}

/* The unit square. */
static const struct tri_mesh *mesh(void)
{
    static double corners[] = {0, 0, 1, 0, 1, 1, 0, 1};
    static struct tri_mesh made;
    static bool is_made;
    const struct tri_pslg square = {.n_points = 4, .points = corners};
    const struct tri_options options = tri_defaults();
    struct tri_report report;
    if (!is_made)
        require(tri_generate(&made, &square, &options, &report, NULL) == TRI_OK, "no square");
    is_made = true;
    return &made;
}

static void query_lengths(const struct tri_size_field *field)
{
    const struct tri_sizes sizes = {.fields = field, .n = 1};
    struct tri_lengths *lengths;
    struct tri_error error = {0};
    const enum tri_status status = tri_lengths_new(&lengths, &sizes, mesh(), NULL, &error);
    require(!status || error.text[0] != 0, "lengths are refused without words");
    for (int i = 0; !status && i < 25; i++)
        require(tri_lengths_at(lengths, (struct tri_point){0.25 * (i % 5), 0.25 * (i / 5)}) > 0,
                "a length is not above 0");
    tri_lengths_free(lengths);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const suffixes[] = {"asc", "npy", "msh", "pos"};
    static char folder[] = "/dev/shm/fuzz_sizes_XXXXXX";
    static bool is_there;
    static const double extent[] = {0, 0, 1, 1};
    char name[64];
    is_there = is_there || mkdtemp(folder);
    snprintf(name, sizeof name, "%s/field.%s", folder, suffixes[size > 0 ? data[0] % 4 : 0]);
    write_file(name, data + (size > 0), size - (size > 0));
    struct tri_size_file file;
    struct tri_error error = {0};
    if (tri_size_file_read(&file, name, extent, NULL, &error)) {
        require(error.text[0] != 0 && !strchr(error.text, '\n'), "an error without words, or of several lines");
    } else {
        const struct tri_size_field *f = &file.field;
        for (int64_t i = 0; i < 3 * f->triangles.n; i++)
            require(f->triangles.at[i] >= 0 && f->triangles.at[i] < f->points.n, "a corner is no point");
        for (int64_t i = 0; i < 2 * f->points.n; i++)
            require(isfinite(f->points.at[i]), "a coordinate is not finite");
        query_lengths(f);
    }
    tri_size_file_free(&file);
    (void)unlink(name);
    return 0;
}
