/* Half-edges in memory, or in files by a hash of their edge: all of one edge come into one file. */
#include "triangle/check/store.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/grow.h"
#include "triangle/base/system.h"

enum { MOST_BITS = 9, N_FILES = 1 << MOST_BITS, LEAST_ROOM = 256 };

struct file {
    tri_file kept; /* TRI_NO_FILE: not there yet */
    int64_t n;     /* half-edges in it */
};

struct check_store {
    struct check_opens here;
    int64_t most; /* to be in memory */
    int bits;     /* of the hash that chooses a file */
    struct file file[N_FILES];
};

enum tri_status tri_check_store_new(struct checker *c)
{
    c->store = calloc(1, sizeof *c->store);
    if (c->store == NULL)
        return TRI_NO_MEMORY;
    for (int k = 0; k < N_FILES; k++)
        c->store->file[k].kept = TRI_NO_FILE;
    c->store->most = INT64_MAX;
    if (c->source->memory <= 0)
        return TRI_OK;
    c->store->most = LEAST_ROOM + (int64_t)fmin(c->source->memory / 8 / sizeof(struct check_open), 0x1p40);
    /* Should all half-edges be spilled, a file is to fit, too. */
    double files = 3 * (double)c->n_triangles / (double)c->store->most;
    while (c->store->bits < MOST_BITS && (double)(1 << c->store->bits) < files)
        c->store->bits++;
    return TRI_OK;
}

void tri_check_store_free(struct check_store *s)
{
    for (int k = 0; s != NULL && k < N_FILES; k++)
        (void)tri_file_close(s->file[k].kept);
    if (s != NULL)
        free(s->here.at);
    free(s);
}

enum tri_status tri_check_append(struct check_opens *o, const struct check_open *e)
{
    if (!tri_grow_far(&o->at, &o->room, o->n + 1, sizeof *o->at))
        return TRI_NO_MEMORY;
    o->at[o->n++] = *e;
    return TRI_OK;
}

static int hash(const struct check_open *e)
{
    uint64_t low = (uint64_t)(e->from < e->to ? e->from : e->to), high = (uint64_t)(e->from < e->to ? e->to : e->from);
    uint64_t h = (low * 0x9e3779b97f4a7c15u ^ high) * 0xbf58476d1ce4e5b9u;
    return (int)(h >> (64 - MOST_BITS));
}

static int compare_hashes(const void *a, const void *b)
{
    return hash(a) - hash(b);
}

static int file_of(const struct check_store *s, const struct check_open *e)
{
    return hash(e) >> (MOST_BITS - s->bits);
}

static const char *folder_of(const struct checker *c)
{
    return c->source->scratch != NULL ? c->source->scratch : "/tmp";
}

static enum tri_status fail(struct checker *c)
{
    return tri_fail(c->error, TRI_CANNOT_WRITE, folder_of(c), 0, "cannot keep half-edges there: %s", strerror(errno));
}

static bool open_file(const struct checker *c, struct file *file)
{
    if (file->kept == TRI_NO_FILE)
        file->kept = tri_scratch_file(folder_of(c));
    return file->kept != TRI_NO_FILE;
}

/* All that is in memory goes to the files. */
static enum tri_status spill(struct checker *c)
{
    struct check_store *s = c->store;
    struct check_open *at = s->here.at;
    if (s->here.n > 1)
        qsort(at, (size_t)s->here.n, sizeof *at, compare_hashes);
    for (int64_t i = 0, j; i < s->here.n; i = j) {
        struct file *file = &s->file[file_of(s, &at[i])];
        for (j = i + 1; j < s->here.n && file_of(s, &at[j]) == file_of(s, &at[i]); j++) {
        }
        if (!open_file(c, file) ||
            !tri_write_at(file->kept, at + i, (size_t)(j - i) * sizeof *at, (uint64_t)file->n * sizeof *at))
            return fail(c);
        file->n += j - i;
    }
    s->here.n = 0;
    return TRI_OK;
}

enum tri_status tri_check_store_add(struct checker *c, struct check_open e)
{
    enum tri_status status = c->store->here.n >= c->store->most ? spill(c) : TRI_OK;
    return status == TRI_OK ? tri_check_append(&c->store->here, &e) : status;
}

static enum tri_status fetch(struct checker *c, struct file *file)
{
    struct check_opens *here = &c->store->here;
    if (file->n > here->room) {
        free(here->at);
        here->room = 0;
        here->at = tri_check_array(file->n, sizeof *here->at);
        if (here->at == NULL)
            return TRI_NO_MEMORY;
        here->room = file->n;
    }
    here->n = file->n;
    if (!tri_read_again(file->kept, here->at, (size_t)here->n * sizeof *here->at, 0))
        return tri_fail(c->error, TRI_CANNOT_READ, folder_of(c), 0, "cannot read what was kept there");
    (void)tri_file_close(file->kept);
    *file = (struct file){TRI_NO_FILE, 0};
    return TRI_OK;
}

enum tri_status tri_check_store_drain(struct checker *c, enum tri_status (*take)(struct checker *c,
                                                                                 struct check_open *at, int64_t n))
{
    struct check_store *s = c->store;
    bool spilled = false;
    for (int k = 0; k < N_FILES; k++)
        spilled = spilled || s->file[k].n > 0;
    enum tri_status status = spilled ? spill(c) : take(c, s->here.at, s->here.n);
    for (int k = 0; k < N_FILES && status == TRI_OK; k++) {
        if (s->file[k].n == 0)
            continue;
        status = fetch(c, &s->file[k]);
        status = status == TRI_OK ? take(c, s->here.at, s->here.n) : status;
    }
    free(s->here.at);
    s->here = (struct check_opens){0};
    return status;
}
