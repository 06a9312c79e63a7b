/* Fuzz target: the readers of text files. The first byte selects format and options, the second the length of chunks.
 * The rest is the file, or two files separated by a zero byte. For any content the reader returns, and its result does
 * not depend on the division into chunks. */
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#include "tests/fuzz/bytes.h"
#include "triangle/text/read.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum format { NODE, POLY, POLY_AND_NODE, ELE, AREA, FORMATS };

struct reading {
    enum tri_status status;
    struct tri_error error;
    struct tri_pslg pslg;
    struct tri_elements elements;
    int32_t base;
    bool points_in_poly;
};

/* A file in memory, and its name. */
static int file_of(const uint8_t *data, size_t size, char name[32])
{
    int file = memfd_create("fuzz", 0);
    if (file < 0 || write(file, data, size) != (ssize_t)size)
        abort();
    snprintf(name, 32, "/proc/self/fd/%d", file);
    return file;
}

static void record_warning(void *user, const char *file, int64_t line, const char *text)
{
    *(size_t *)user += strlen(file) + strlen(text) + (size_t)line;
}

static struct reading read_as(enum format format, const char *first, const char *second,
                              const struct tri_read_options *options)
{
    struct reading r = {.status = TRI_OK};
    if (format == NODE)
        r.status = tri_read_node(first, options, &r.pslg, &r.base, &r.error);
    else if (format == POLY || format == POLY_AND_NODE)
        r.status = tri_read_poly(first, format == POLY ? NULL : second, options, &r.pslg, &r.base, &r.points_in_poly,
                                 &r.error);
    else
        r.status = tri_read_ele(first, options, 1, 100, &r.elements, &r.error);
    if (format == AREA && !r.status)
        r.status = tri_read_area(second, options, 1, &r.elements, &r.error);
    return r;
}

static void require(bool condition, const char *what)
{
    if (condition)
        return;
    fprintf(stderr, "fuzz_read: %s\n", what);
    abort();
}

static bool same(const void *a, const void *b, int32_t n, size_t item)
{
    require((a == NULL) == (b == NULL), "an array is there only sometimes");
    return !a || n == 0 || memcmp(a, b, (size_t)n * item) == 0;
}

static void compare(const struct reading *a, const struct reading *b)
{
    const struct tri_pslg *p = &a->pslg, *q = &b->pslg;
    require(a->status == b->status, "the status depends on chunks");
    require(a->error.line == b->error.line && strcmp(a->error.text, b->error.text) == 0, "so does the error");
    require(p->n_points == q->n_points && p->n_segments == q->n_segments && p->n_holes == q->n_holes &&
                p->n_regions == q->n_regions && a->elements.n == b->elements.n,
            "so do counts");
    require(same(p->points, q->points, p->n_points, 2 * sizeof(double)) &&
                same(p->segments, q->segments, p->n_segments, 2 * sizeof(int32_t)) &&
                same(p->holes, q->holes, p->n_holes, 2 * sizeof(double)) &&
                same(p->regions, q->regions, p->n_regions, 4 * sizeof(double)) &&
                same(a->elements.corners, b->elements.corners, a->elements.n, 3 * sizeof(int32_t)),
            "so do numbers");
}

/* Checks the promises that the headers make about content that was read. */
static void judge(const struct reading *r)
{
    const struct tri_pslg *p = &r->pslg;
    if (r->status) {
        require(r->error.text[0] != 0, "an error without words");
        require(!p->points && !p->segments && p->n_points == 0 && !r->elements.areas, "a failure leaves something");
        return;
    }
    require(r->base == 0 || r->base == 1, "the base is neither 0 nor 1");
    for (size_t i = 0; i < 2 * (size_t)p->n_points; i++)
        require(isfinite(p->points[i]), "a coordinate is not finite");
    for (size_t i = 0; i < 3 * (size_t)r->elements.n; i++)
        require(r->elements.corners[i] >= 0 && r->elements.corners[i] < 100, "a corner is no vertex");
}

static void free_reading(struct reading *r)
{
    tri_pslg_free(&r->pslg);
    tri_elements_free(&r->elements);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct bytes b = {data, data + size};
    uint8_t choice = bytes_one(&b), chunk = bytes_one(&b);
    const uint8_t *cut = b.at < b.end ? memchr(b.at, 0, (size_t)(b.end - b.at)) : NULL;
    size_t first_size = (size_t)((cut ? cut : b.end) - b.at);
    char first[32], second[32];
    size_t heard = 0;
    int files[2] = {file_of(b.at, first_size, first),
                    file_of(cut ? cut + 1 : b.end, cut ? (size_t)(b.end - cut - 1) : 0, second)};
    struct tri_read_options options = {.default_base = choice >> 3 & 1, .want_regions = choice >> 4 & 1,
                                       .refining = choice >> 5 & 1, .warn = record_warning, .warn_user = &heard};
    enum format format = (enum format)((choice & 7) % FORMATS);
    struct reading whole = read_as(format, first, second, &options);
    options.chunk_bytes = chunk + 1u;
    struct reading cut_up = read_as(format, first, second, &options);
    close(files[0]);
    close(files[1]);
    compare(&whole, &cut_up);
    judge(&whole);
    free_reading(&whole);
    free_reading(&cut_up);
    return 0;
}
