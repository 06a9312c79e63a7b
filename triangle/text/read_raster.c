/* Reads rasters of edge lengths: ESRI ASCII grids (.asc), whose values belong to cells, and NumPy arrays (.npy). */
#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/text/size_file.h"

bool tri_size_raster_begin(struct tri_words *words, struct tri_size_file *file, int64_t rows, int64_t columns)
{
    file->values = malloc(((size_t)rows * (size_t)columns + 1) * sizeof *file->values);
    file->field.kind = TRI_SIZE_RASTER;
    file->field.values = (struct tri_reals){file->values, rows, columns, columns};
    return file->values || tri_reading_no_memory(&words->to);
}

/* --- .asc */

enum head { COLUMNS, ROWS, X_CORNER, X_CENTER, Y_CORNER, Y_CENTER, CELL, DX, DY, NO_DATA, HEADS };

static const char *const head_names[HEADS] = {"ncols", "nrows", "xllcorner", "xllcenter", "yllcorner", "yllcenter",
                                              "cellsize", "dx", "dy", "nodata_value"};

struct asc {
    int64_t rows, columns;
    double value[HEADS]; /* values by enum head; those of the counts are unused */
    bool has[HEADS];
};

static enum head head_of(const struct tri_words *w)
{
    int head = 0;
    while (head < HEADS && !tri_words_is(w, head_names[head]))
        head++;
    return (enum head)head;
}

static bool read_entry(struct tri_words *w, struct asc *asc)
{
    const enum head head = head_of(w);
    if (head == HEADS)
        return TRI_WORDS_FAIL(w, "\"%.*s\" is not an entry of an ESRI ASCII grid",
                              (int)(w->length < 40 ? w->length : 40), w->word);
    if (asc->has[head])
        return TRI_WORDS_FAIL(w, "%s occurs twice", head_names[head]);
    asc->has[head] = true;
    if (head == COLUMNS || head == ROWS)
        return tri_words_whole(w, head_names[head], 1, INT32_MAX, head == ROWS ? &asc->rows : &asc->columns);
    return tri_words_real(w, head_names[head], head != NO_DATA, &asc->value[head]);
}

/* Is the next word an entry, and not a number, nan or inf? */
static bool is_head(const struct tri_words *w)
{
    const bool is_nan = (w->at[0] == 'n' || w->at[0] == 'N') && (w->at[1] == 'a' || w->at[1] == 'A');
    return isalpha((unsigned char)*w->at) && *w->at != 'i' && *w->at != 'I' && !is_nan;
}

/* Reads the entries, which precede the first number in any order. */
static bool read_entries(struct tri_words *w, struct asc *asc)
{
    while (tri_words_seek(w) && is_head(w))
        if (!tri_words_next(w) || !read_entry(w, asc))
            return false;
    for (int k = 0; k < 2 && !asc->has[CELL]; k++)
        if (!asc->has[DX + k])
            return TRI_WORDS_FAIL(w, "cellsize is missing");
    for (int k = 0; k < 2; k++) {
        const enum head corner = k ? Y_CORNER : X_CORNER, size = asc->has[DX + k] ? DX + (enum head)k : CELL;
        if (!asc->has[COLUMNS + k] || asc->has[corner] == asc->has[corner + 1])
            return TRI_WORDS_FAIL(w, "%s is missing or occurs twice",
                                  head_names[asc->has[COLUMNS + k] ? corner : COLUMNS + (enum head)k]);
        if (!(asc->value[size] > 0))
            return TRI_WORDS_FAIL(w, "%s is not above 0", head_names[size]);
    }
    return true;
}

bool tri_size_read_asc(struct tri_words *w, struct tri_size_file *file)
{
    struct asc asc = {.value = {[NO_DATA] = -9999}};
    if (!read_entries(w, &asc))
        return false;
    const int64_t left = w->text.data + w->text.size - w->at;
    if (asc.rows > left / 2 / asc.columns)
        return TRI_WORDS_FAIL(w, "%" PRId64 " rows of %" PRId64 " values are more than the file holds", asc.rows,
                              asc.columns);
    if (!tri_size_raster_begin(w, file, asc.rows, asc.columns))
        return false;
    for (int k = 0; k < 2; k++) {
        const enum head corner = k ? Y_CORNER : X_CORNER, size = asc.has[DX + k] ? DX + (enum head)k : CELL;
        file->field.step[k] = asc.value[size];
        file->field.origin[k] = asc.has[corner] ? asc.value[corner] + asc.value[size] / 2 : asc.value[corner + 1];
    }
    const double none = asc.value[NO_DATA];
    for (int64_t row = asc.rows - 1; row >= 0; row--) /* rows are stored from the top */
        for (int64_t i = 0; i < asc.columns; i++) {
            double *value = &file->values[row * asc.columns + i];
            if (!(isnan(none) ? tri_words_real(w, "a length", false, value) : tri_words_length(w, value)))
                return false;
            *value = *value == none || isnan(*value) ? 0 : *value;
        }
    return !tri_words_next(w) || TRI_WORDS_FAIL(w, "more values than %" PRId64 " rows of %" PRId64, asc.rows,
                                                asc.columns);
}

/* --- .npy */

struct npy {
    bool big_endian, by_columns;
    char kind;        /* 'f', 'i' or 'u': real, signed, unsigned */
    int bytes;        /* bytes per value */
    int64_t shape[2]; /* rows, columns */
};

enum { MOST_HEAD = 4096 };

/* Returns the text after 'key': in the dictionary; NULL: no such key. */
static const char *behind_key(const char *head, const char *key)
{
    const char *at = strstr(head, key);
    return at ? at + strlen(key) + strspn(at + strlen(key), " :") : NULL;
}

static bool parse_type(struct npy *npy, const char *at)
{
    if (!at || (*at != '\'' && *at != '"') || !at[1] || !strchr("<>=|", at[1]) || !at[2] || !strchr("fiu", at[2]) ||
        !at[3] || at[4] != *at)
        return false;
    npy->big_endian = at[1] == '>';
    npy->kind = at[2];
    npy->bytes = at[3] - '0';
    return npy->bytes == 4 || npy->bytes == 8 || (npy->kind != 'f' && (npy->bytes == 1 || npy->bytes == 2));
}

static bool parse_shape(struct npy *npy, const char *at)
{
    for (int k = 0; at && k < 2; k++) {
        at += strspn(at, k ? " ," : " (");
        const char *end = tri_scan_integer(at, at + strlen(at), &npy->shape[k]);
        at = end == at || npy->shape[k] < 1 || npy->shape[k] > INT32_MAX ? NULL : end;
    }
    return at && at[strspn(at, " ,")] == ')';
}

static enum tri_status read_npy_header(struct npy *npy, struct tri_bytes *bytes, const char *path,
                                     struct tri_error *error)
{
    char head[MOST_HEAD + 1] = "";
    const int64_t left = bytes->end - bytes->at;
    const int version = left >= 12 && memcmp(bytes->at, "\x93NUMPY", 6) == 0 ? bytes->at[6] : 0;
    if (version < 1 || version > 3)
        return tri_fail(error, TRI_BAD_INPUT, path, 0, "not a .npy file of version 1 to 3");
    const int64_t length = version == 1 ? (int64_t)(tri_get_u32(bytes->at + 8) & 0xffff) : tri_get_u32(bytes->at + 8);
    bytes->at += version == 1 ? 10 : 12;
    if (length > MOST_HEAD || length > bytes->end - bytes->at)
        return tri_fail(error, TRI_BAD_INPUT, path, 0, "the header of the .npy file is incomplete or too long");
    memcpy(head, bytes->at, (size_t)length);
    bytes->at += length;
    const char *order = behind_key(head, "fortran_order'");
    if (!parse_type(npy, behind_key(head, "descr'")) || !order)
        return tri_fail(error, TRI_BAD_INPUT, path, 0, "not an array of float32, float64 or whole numbers");
    npy->by_columns = *order == 'T';
    if (!parse_shape(npy, behind_key(head, "shape'")))
        return tri_fail(error, TRI_BAD_INPUT, path, 0, "not an array of two dimensions");
    return TRI_OK;
}

/* Assembles the bits of a value; signed integers are sign-extended to 64 bits. */
static double npy_value(const struct npy *npy, const char *at)
{
    uint64_t bits = 0;
    for (int k = 0; k < npy->bytes; k++)
        bits |= (uint64_t)(unsigned char)at[npy->big_endian ? npy->bytes - 1 - k : k] << (8 * k);
    if (npy->kind == 'u')
        return (double)bits;
    if (npy->kind == 'i') {
        const uint64_t sign = (uint64_t)1 << (8 * npy->bytes - 1);
        return bits & sign ? -(double)(sign - (bits & (sign - 1))) : (double)bits;
    }
    if (npy->bytes == 4) {
        const uint32_t half = (uint32_t)bits;
        float value;
        memcpy(&value, &half, sizeof value);
        return (double)value;
    }
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Sets origin and step from the positions of the first and the last value. The raster starts with its lowest row. */
static bool set_extent(struct tri_size_field *field, const double extent[4])
{
    const int64_t n[2] = {field->values.width, field->values.n};
    for (int k = 0; k < 2; k++) {
        const double length = fabs(extent[2 + k] - extent[k]);
        field->origin[k] = fmin(extent[k], extent[2 + k]);
        field->step[k] = n[k] > 1 ? length / (double)(n[k] - 1) : 1;
        if (!(field->step[k] > 0 && isfinite(length)))
            return false;
    }
    return true;
}

static enum tri_status read_npy(struct tri_size_file *file, struct tri_bytes *bytes, const char *path,
                                const double extent[4], struct tri_error *error)
{
    struct npy npy;
    const enum tri_status status = read_npy_header(&npy, bytes, path, error);
    if (status)
        return status;
    const int64_t rows = npy.shape[0], columns = npy.shape[1];
    if (!tri_bytes_has(bytes, (uint64_t)rows * (uint64_t)columns, (uint64_t)npy.bytes))
        return tri_fail(error, TRI_BAD_INPUT, path, 0, "%" PRId64 " rows of %" PRId64 " values are more than the file "
                        "holds", rows, columns);
    struct tri_words words = {.to = {.path = path, .error = error}};
    if (!tri_size_raster_begin(&words, file, rows, columns))
        return words.to.status;
    for (int64_t j = 0; j < rows; j++)
        for (int64_t i = 0; i < columns; i++) {
            const int64_t from = npy.by_columns ? i * rows + j : j * columns + i;
            const int64_t row = extent[1] > extent[3] ? rows - 1 - j : j;
            const int64_t column = extent[0] > extent[2] ? columns - 1 - i : i;
            const double value = npy_value(&npy, bytes->at + from * npy.bytes);
            file->values[row * columns + column] = isnan(value) ? 0 : value;
        }
    return set_extent(&file->field, extent) ? TRI_OK : tri_fail(error, TRI_BAD_INPUT, path, 0,
                                                           "the extent is empty or too large");
}

enum tri_status tri_size_read_npy(struct tri_size_file *file, const char *path, const double extent[4],
                                  struct tri_error *error)
{
    struct tri_bytes bytes;
    if (!extent)
        return tri_fail(error, TRI_BAD_INPUT, path, 0, "a .npy file needs an extent: FILE.npy@XMIN,YMIN,XMAX,YMAX, the "
                        "positions of its first and its last value");
    enum tri_status status = tri_bytes_load(&bytes, path, error);
    status = status ? status : read_npy(file, &bytes, path, extent, error);
    tri_bytes_free(&bytes);
    return status;
}
